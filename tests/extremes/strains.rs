//! Strains to 100 %, inversion, impact at the wave speed, loads that break every bond in one step.
use super::*;
use pd_testkit::specimen::CRITERIA;

/// −∂E/∂u of a node, by central differences.
fn gradient<const D: usize>(body: &mut dyn Specimen<D>, node: usize) -> Result<SVector<f64, D>> {
    let (u, step) = (body.displacement(node), 1e-5 * body.unit());
    let mut force = SVector::zeros();
    for axis in 0..D {
        for sign in [1.0, -1.0] {
            let mut moved = u;
            moved[axis] += sign * step;
            body.displace(node, &moved);
            body.evaluate()?;
            force[axis] -= sign * body.strain_energy() / (2.0 * step);
        }
    }
    body.displace(node, &u);
    body.evaluate()?;
    Ok(force)
}

/// Forces are those of the energy at this deformation; or the material refuses it.
fn right_at<const D: usize>(name: &str, body: &mut dyn Specimen<D>, f: &SMatrix<f64, D, D>) {
    let h = f - SMatrix::identity();
    body.deform(&|x| h * x + wavy(x, 0.02 * DX));
    if let Err(error) = body.evaluate() {
        let inverted = matches!(error, Error::Inverted { det, .. } if det <= 0.0);
        let finite = ["Saint-Venant-Kirchhoff", "neo-Hookean"].contains(&name);
        assert!(inverted && finite, "{name}, F = {f}: {error}");
        return;
    }
    assert!(body.is_finite(), "{name}, F = {f}");
    let n = body.nodes();
    let size = (0..n).map(|i| (body.force_density(i) * body.volume(i)).norm()).fold(0.0, f64::max);
    for node in [0, n / 2, n - 1] {
        let found = body.force_density(node) * body.volume(node);
        let off = (gradient(body, node).expect("near") - found).norm() / size;
        assert!(off < 1e-6, "{name}, F = {f}, node {node}: {off:e}");
    }
}

/// Stretched and compressed by 2, sheared by 1, and by all of it at once; F by rows.
const LARGE: [[[f64; 2]; 2]; 6] = [
    [[2.0, 0.0], [0.0, 1.0]],
    [[2.0, 0.0], [0.0, 2.0]],
    [[0.5, 0.0], [0.0, 0.5]],
    [[0.2, 0.0], [0.0, 1.0]],
    [[1.0, 1.0], [0.0, 1.0]],
    [[-0.3, 1.5], [-2.0, 0.4]],
];

#[test]
fn strains_of_a_hundred_per_cent() {
    for rows in LARGE {
        let flat = SMatrix::<f64, 2, 2>::from_fn(|i, j| rows[i][j]);
        for (name, mut body) in all(plate().specimens::<f64>()) {
            right_at(name, &mut *body, &flat);
        }
        let mut deep = SMatrix::<f64, 3, 3>::identity();
        deep.fixed_view_mut::<2, 2>(0, 0).copy_from(&flat);
        for (name, mut body) in all(block().specimens::<f64>()) {
            right_at(name, &mut *body, &deep);
        }
    }
}

#[test]
fn turned_inside_out() {
    let mirror = SMatrix::<f64, 2, 2>::new(-1.0, 0.0, 0.0, 1.0);
    let flat = SMatrix::<f64, 2, 2>::new(0.0, 0.0, 0.0, 1.0);
    for f in [mirror, flat, SMatrix::<f64, 2, 2>::zeros()] {
        for (name, mut body) in all(plate().specimens::<f64>()) {
            body.deform(&|x| (f - SMatrix::<f64, 2, 2>::identity()) * x);
            match body.evaluate() {
                Err(error) => {
                    assert!(matches!(error, Error::Inverted { .. }), "{name}: {error}");
                }
                Ok(()) if f == mirror => {
                    let off = body.unbalanced();
                    assert!(body.is_finite() && off < 1e-12, "{name}: {off:e}");
                }
                // A bond of no length has no direction: a run says so, or goes on.
                Ok(()) => match body.run(Loads::new(), TimeStep::Unchecked(0.01 * DX / C), 20) {
                    Ok(_) => assert!(body.is_finite(), "{name}"),
                    Err(error) => assert!(ends_of_runs(&error), "{name}: {error}"),
                },
            }
        }
    }
}

/// What ends a run whose numbers grow beyond meaning.
fn ends_of_runs(error: &Error) -> bool {
    match error {
        Error::During { source, .. } => ends_of_runs(source),
        Error::Inverted { .. } | Error::BlowUp { .. } | Error::NotFinite { .. } => true,
        _ => false,
    }
}

/// The halves of a body meet, or part, at the speed of waves.
#[test]
fn impact_at_the_wave_speed() {
    for by in CRITERIA {
        let recipe = Recipe { tear: Tear { by, at: 0.1 }, ..plate() };
        for speed in [-C, C] {
            for (name, mut body) in all(recipe.specimens::<f64>()) {
                body.launch(&|x| [if x[0] < 3.5 * DX { -speed } else { speed }, 0.0].into());
                let before = body.kinetic_energy();
                match body.run(Loads::new(), TimeStep::Unchecked(0.05 * DX / C), 400) {
                    Err(error) => assert!(ends_of_runs(&error), "{by:?}, {name}: {error}"),
                    Ok(_) => {
                        let energy = body.kinetic_energy() + body.strain_energy();
                        // Bonds take what they hold along; what breaks late in a step may be
                        // counted twice, but nothing is made of nothing.
                        let ok = body.is_finite() && energy < 1.2 * before;
                        assert!(ok, "{by:?}, {name}, {speed}: energy {}", energy / before);
                    }
                }
            }
        }
    }
}

/// Every bond goes in the first step; then every node flies alone.
#[test]
fn every_bond_in_one_step() {
    for by in CRITERIA {
        let recipe = Recipe { tear: Tear { by, at: 1e-3 }, ..plate() };
        for (name, mut body) in all(recipe.specimens::<f64>()) {
            let dt = 0.05 * DX / C;
            // All strains grow by a third in one step.
            body.launch(&|x| [x[0] / (3.0 * dt), 0.8 * x[1] / (3.0 * dt)].into());
            let rule = TimeStep::Unchecked(dt);
            body.run(Loads::new(), rule, 1).unwrap_or_else(|e| panic!("{by:?}, {name}: {e}"));
            let whole = (0..body.nodes()).filter(|&i| body.damage(i) < 1.0).count();
            assert!(whole == 0 && body.is_finite(), "{by:?}, {name}: {whole} nodes have bonds");
            assert_eq!(body.strain_energy(), 0.0, "{by:?}, {name}");
            let flight: Vec<_> = (0..body.nodes()).map(|i| body.velocity(i)).collect();
            body.run(Loads::new(), rule, 3).unwrap_or_else(|e| panic!("{by:?}, {name}: {e}"));
            let now: Vec<_> = (0..body.nodes()).map(|i| body.velocity(i)).collect();
            assert_eq!(flight, now, "{by:?}, {name}");
        }
    }
}
