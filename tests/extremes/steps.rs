//! 0.99 of the critical step is stable, 1.05 of it is detected: every material. `tests/materials/energy.rs`
//! has the drift of the energy over 10⁵ steps for both integrators.
use super::*;

/// A small motion of all wave lengths.
fn shake<const D: usize>(body: &mut dyn Specimen<D>) {
    for node in 0..body.nodes() {
        let v = SVector::from_fn(|d, _| 1e-6 * C * pd_testkit::generate::noise(1, D * node + d));
        body.displace(node, &SVector::zeros());
        body.set_in_motion(node, &v);
    }
}

/// Stable for `steps` steps at 0.99 of the critical step, and detected at 1.05 of it.
fn at_the_limit<const D: usize>(list: Vec<Named<D>>, steps: usize) {
    for (name, mut body) in all(list) {
        shake(&mut *body);
        let before = body.kinetic_energy();
        let dt = match body.run(Loads::new(), TimeStep::Safety(0.99), steps) {
            Ok(dt) => dt,
            Err(error) => {
                let known = matches!(error, Error::UnstableBody { .. });
                assert!(known && name.contains("polynomial"), "{name}: {error}");
                continue;
            }
        };
        // The kinetic energy of a mode at the limit is not more than that it starts with.
        let after = body.kinetic_energy() / before;
        assert!(body.is_finite() && after < 1.5, "{name}: kinetic energy grew to {after}");
        shake(&mut *body);
        let refused = body.run(Loads::new(), TimeStep::Fixed(1.05 / 0.99 * dt), 1).err();
        assert!(matches!(refused, Some(Error::UnstableTimeStep { .. })), "{name}: {refused:?}");
        shake(&mut *body);
        let rule = TimeStep::Unchecked(1.05 / 0.99 * dt);
        let ended = body.run(Loads::new(), rule, 20_000).err();
        let found = match &ended {
            Some(Error::During { source, .. }) => matches!(**source, Error::Inverted { .. }),
            Some(Error::BlowUp { .. } | Error::NotFinite { .. }) => true,
            _ => false,
        };
        assert!(found, "{name}: {ended:?}");
    }
}

#[test]
fn at_the_critical_step() {
    at_the_limit(plate().specimens::<f64>(), 2000);
    at_the_limit(block().specimens::<f64>(), 500);
}

/// `cargo test --release --test extremes -- --ignored million`
#[test]
#[ignore = "minutes"]
fn at_the_critical_step_for_a_million_steps() {
    at_the_limit(plate().specimens::<f64>(), 1_000_000);
}

/// Total energy at 0.9 of the critical step, from means over 1000 steps at both ends.
fn drift(steps: usize) -> f64 {
    let moduli = Isotropic::from_young_poisson(70e9, 0.3).expect("moduli");
    let mode = PlaneMode::PlaneStress;
    let model = LinearSolid::plane(&moduli, mode, 2500.0, InfluenceFunction::Gaussian).expect("m");
    let points = cloud([5, 5], DX, 0.0, 1.0, 0).expect("points");
    let family = Cloud::<f64, 2>::new(&points, Horizon::Cells(2.0), Quadrature::None);
    let mut body =
        Body::new(family.expect("family"), Ordinary::new(model), NoDamage).expect("body");
    body.set_velocity(|x| wavy(x, 1e-3 * C));
    let run = Run::new(&mut body, Loads::new(), TimeStep::Safety(0.9)).expect("run");
    let mut run = run.with_energies();
    let mut mean = |then: usize| {
        let mut sum = 0.0;
        for _ in 0..1000 {
            run.steps_more(1).expect("step");
            let e = run.energies().expect("energies");
            sum += e.kinetic + e.strain;
        }
        run.steps_more(then).expect("steps");
        sum
    };
    let start = mean(steps);
    mean(0) / start - 1.0
}

#[test]
fn energy_stays() {
    let drift = drift(50_000);
    println!("drift {drift:.1e}");
    assert!(drift.abs() < 1e-2, "{drift:e}");
}

/// `cargo test --release --test extremes -- --ignored million --nocapture`
#[test]
#[ignore = "minutes"]
fn energy_stays_for_a_million_steps() {
    let drift = drift(1_000_000);
    println!("drift {drift:.1e}");
    assert!(drift.abs() < 1e-2, "{drift:e}");
}
