//! E1/E2 to 10⁶, ν to 0.4999 and −0.9, stiffnesses of condition 10¹⁰.
use super::*;
use pd_testkit::generate::{plane_stiffnesses, solid_stiffnesses};
use proptest::prelude::*;

/// A body held at one end and pulled at the other.
struct Pulled {
    /// Twice the energy over the work of the supports, less 1 (Clapeyron).
    of_supports: f64,
    /// Twice the energy over the work of all forces, less 1.
    of_forces: f64,
    /// What `of_supports` may be by what the solver says of its error: the difference of the works is
    /// r·u over the free nodes, and r·u ≤ ‖u − u*‖ ‖u_free‖ in the norm of energy.
    told: f64,
}

fn pull<const D: usize>(points: &Points<D>, body: &mut dyn Specimen<D>) -> Result<Pulled> {
    let [left, right] = ends(points);
    // So little that no law sees the second order, times a condition of 10¹⁰; what is stored are
    // displacements, not places, so nothing is lost.
    let pull = 1e-14 * body.unit();
    let loads = Loads::new().clamp::<D>(&left).displacement(&right, 0, pull);
    let statics = Statics::new().with_tolerance(1e-10)?;
    let solved = body.solve(&statics, loads)?;
    assert!(body.is_finite());
    let work = |i: usize| -body.force_density(i) * body.volume(i);
    let supports: f64 = right.iter().map(|i| work(i)[0] * pull).sum();
    let all: f64 = (0..body.nodes()).map(|i| work(i).dot(&body.displacement(i))).sum();
    assert!(supports > 0.0 && all > 0.0);
    let energy = body.strain_energy();
    for node in right.iter() {
        let mut u = body.displacement(node);
        u[0] = 0.0;
        body.displace(node, &u);
    }
    body.evaluate()?;
    Ok(Pulled {
        of_supports: 2.0 * energy / supports - 1.0,
        of_forces: 2.0 * energy / all - 1.0,
        told: solved.error.expect("symmetric") * (body.strain_energy() / energy).sqrt(),
    })
}

/// All specimens give the right energy, or a typed error: returns how many gave an error.
fn pulled<const D: usize>(what: &str, points: &Points<D>, list: Vec<Named<D>>) -> usize {
    let mut refused = 0;
    for (name, mut body) in existing(list) {
        match pull(points, &mut *body) {
            Ok(Pulled { of_supports, of_forces, told }) => {
                assert!(of_forces.abs() < 1e-4, "{what}, {name}: energy off by {of_forces:e}");
                // The stiffness of laws that are not linear comes from differences.
                let rounding = if body.is_linear() { 1e-6 } else { 1e-2 };
                println!("{what}, {name}: off by {of_supports:.1e}, told {told:.1e}");
                let ok = of_supports.abs() < told + rounding;
                assert!(ok, "{what}, {name}: off by {of_supports:e}, told {told:e}");
            }
            Err(error) => {
                println!("{what}, {name}: {error}");
                let known = matches!(
                    error,
                    Error::NotConverged { .. }
                        | Error::IndefiniteOperator { .. }
                        | Error::IllConditioned { .. }
                );
                assert!(known, "{what}, {name}: {error}");
                refused += 1;
            }
        }
    }
    refused
}

#[test]
fn moduli_a_million_apart() {
    for ratio in [1e2, 1e4, 1e6] {
        let mut recipe = plate();
        let ply = Lamina { e1: 1e11, e2: 1e11 / ratio, g12: 5e9, nu12: 0.3 };
        recipe.stiffness = Stiffness::<2>::lamina(&ply).expect("ply").rotated(0.4);
        let what = format!("E1/E2 = {ratio:e}");
        // The polynomial micromoduli are not definite for such plies; all others are solved.
        assert_eq!(pulled(&what, &recipe.points, recipe.specimens::<f64>()), 1);
        let mut recipe = block();
        let solid =
            TransverselyIsotropic { e1: 1e11, e2: 1e11 / ratio, g12: 5e9, nu12: 0.3, nu23: 0.4 };
        let solid = Stiffness::<3>::transversely_isotropic(&solid).expect("solid");
        recipe.stiffness = solid.rotated_about_z(0.4);
        assert_eq!(pulled(&what, &recipe.points, recipe.specimens::<f64>()), 1);
    }
}

#[test]
fn nearly_incompressible_and_auxetic() {
    for nu in [-0.9, -0.5, 0.0, 0.49, 0.4999] {
        let moduli = Isotropic::from_young_poisson(1e9, nu).expect("moduli");
        let what = format!("ν = {nu}");
        let (mut flat, mut deep) = (plate(), block());
        (flat.moduli, deep.moduli) = (moduli, moduli);
        let refused = pulled(&what, &flat.points, flat.specimens::<f64>())
            + pulled(&what, &deep.points, deep.specimens::<f64>());
        println!("{what}: {refused} refused");
        assert!(refused <= 3, "{what}: {refused}");
    }
}

/// Materials with exactly the stiffness C: W = ½ε:C:ε at every node, along the softest strain too.
fn exact_energy<const D: usize>(
    stiffness: &Stiffness<D>,
    strain: &SMatrix<f64, D, D>,
    list: Vec<Named<D>>,
    limit: f64,
) {
    let wanted = stiffness.energy(strain);
    for (name, mut body) in all(list) {
        if EXACT.contains(&name) {
            body.deform(&|x| strain * x);
            body.evaluate().expect("forces");
            for (node, energy) in body.energy_densities().into_iter().enumerate() {
                let off = energy / wanted - 1.0;
                assert!(off.abs() < limit, "{name}, node {node}: energy off by {off:e}");
            }
        }
    }
}

/// The strain of the smallest eigenvalue, as small as finite kinematics need it.
fn softest_2(c: &Stiffness<2>) -> SMatrix<f64, 2, 2> {
    let eigen = c.voigt().symmetric_eigen();
    let v = eigen.eigenvectors.column(eigen.eigenvalues.imin()).into_owned() * 1e-14;
    SMatrix::<f64, 2, 2>::new(v[0], 0.5 * v[2], 0.5 * v[2], v[1])
}

proptest! {
    #![proptest_config(cases(6))]

    #[test]
    fn any_stiffness_of_condition_1e10(c in plane_stiffnesses(1e11, 1e10)) {
        let recipe = Recipe { stiffness: c, ..plate() };
        pulled("condition 1e10", &recipe.points, recipe.specimens::<f64>());
        // ½ε:C:ε is itself a difference that leaves six digits.
        exact_energy(&c, &softest_2(&c), recipe.specimens::<f64>(), 1e-3);
    }

    #[test]
    fn any_stiffness_in_space(c in solid_stiffnesses(1e11, 1e6)) {
        let recipe = Recipe { stiffness: c, ..block() };
        pulled("condition 1e6", &recipe.points, recipe.specimens::<f64>());
        let strain = SMatrix::<f64, 3, 3>::new(1.0, 0.2, -0.3, 0.2, -0.4, 0.1, -0.3, 0.1, 0.6) * 1e-14;
        exact_energy(&c, &strain, recipe.specimens::<f64>(), 1e-9);
    }
}
