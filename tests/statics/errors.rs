//! Static problems without a solution say so, with what is wrong and where.
use crate::common;
use peridynamics::prelude::*;

type Plate<M, P> = Body<f64, 2, Lattice<f64, 2>, M, P>;

fn grid() -> Grid<2> {
    Grid::new(&Cuboid::centred([20e-3, 16e-3]).expect("box"), 1e-3).expect("grid")
}

fn plate<P>(policy: P) -> Plate<Ordinary<PositiveSplit<2, 3>, peridynamics::models::Linearised>, P>
where
    P: for<'a> DamagePolicy<
            f64,
            2,
            Ordinary<PositiveSplit<2, 3>, peridynamics::models::Linearised>,
        >,
{
    let family = Lattice::new(&grid(), Horizon::Cells(2.0), Quadrature::None).expect("family");
    let model = PositiveSplit::plane(&common::ply(), 1e3, common::OMEGA).expect("material");
    Body::new(family, Ordinary::linearised(model), policy).expect("body")
}

fn refusal(loads: Loads) -> Error {
    Statics::new().solve(&mut plate(NoDamage), loads).expect_err("refused")
}

#[test]
fn rigid_motions_left_free() {
    let left = grid().select(|x| x[0] < -9e-3);
    let right = grid().select(|x| x[0] > 9e-3);
    let error = refusal(Loads::new().body_force(&right, 0, 1e6));
    assert!(matches!(error, Error::FreeRigidMotion { node: 0, nodes: 320, .. }), "{error}");
    let error = refusal(Loads::new().displacement(&left, 0, 0.0)).to_string();
    assert!(error.contains("translation along y"), "{error}");
    let corner = NodeSet::from_nodes([0], 320).expect("set");
    let error = refusal(Loads::new().clamp::<2>(&corner)).to_string();
    assert!(error.contains("rotation") || error.contains("translation"), "{error}");
    // One more component holds it.
    let loads = Loads::new().displacement(&left, 0, 0.0).displacement(&corner, 1, 0.0);
    Statics::new().solve(&mut plate(NoDamage), loads).expect("held");
}

#[test]
fn a_piece_cut_off() {
    let crack = Segment::new([0.0, -9e-3], [0.0, 9e-3]).expect("crack");
    let left = grid().select(|x| x[0] < -9e-3);
    let mut body = plate(Precracked::by(crack));
    let error = Statics::new().solve(&mut body, Loads::new().clamp::<2>(&left)).expect_err("free");
    assert!(matches!(error, Error::FreeRigidMotion { node: 10, nodes: 160, .. }), "{error}");
}

#[test]
fn an_unstable_material() {
    let ply = peridynamics::models::elasticity::catalogue::GRAPHITE_EPOXY;
    let stiffness = Stiffness::<2>::lamina(&ply).expect("ply");
    let model = PolynomialMicromoduli::plane(&stiffness, 1e3, common::OMEGA).expect("material");
    let material = Ordinary::linearised(model);
    let symbol = Symbol::of(&material, 1e-3, Horizon::Cells(3.0), Quadrature::Exact);
    let symbol = symbol.expect("symbol");
    assert!(matches!(symbol.stability(), Stability::Unstable(_)));
    let family =
        Lattice::<f64, 2>::new(&grid(), Horizon::Cells(3.0), Quadrature::Exact).expect("family");
    let mut body = Body::new(family, material, NoDamage).expect("body");
    body.set_displacement(|x| x * 1e-3);
    let left = grid().select(|x| x[0] < -9e-3);
    let load = grid().select(|x| x[0] > 8e-3 && x[1] > 0.0);
    let loads = Loads::new().clamp::<2>(&left).body_force(&load, 0, 1e9);
    let error = Statics::new().solve(&mut body, loads).expect_err("indefinite");
    assert!(error.to_string().contains("Symbol::of"), "{error}");
    let Error::IndefiniteOperator { curvature, wave, .. } = error else { panic!("{error}") };
    assert!(curvature < 0.0);
    // The wave it names is one that the infinite lattice amplifies.
    let wave = SVector::<f64, 2>::from_column_slice(&wave);
    let softest = symbol.eigen(&wave).map(|mode| mode.eigenvalue).into_iter().fold(1.0, f64::min);
    assert!(softest < 0.0, "{wave}: {softest}");
    let x = grid().position(7);
    assert!((body.displacement(7) - x * 1e-3).norm() < 1e-12, "the body keeps its displacements");
}

#[test]
fn an_unstable_material_between_faces() {
    use pd_testkit::scabbia63::{Conditions, Plate};
    let ply = peridynamics::models::elasticity::catalogue::GLASS_EPOXY;
    let stiffness = Stiffness::<2>::lamina(&ply).expect("ply").rotated(40_f64.to_radians());
    let plate = Plate {
        dx: 10e-3,
        m: 2.0,
        quadrature: Quadrature::Exact,
        conditions: Conditions::Faces,
        tolerance: 1e-6,
    };
    let omega = InfluenceFunction::Gaussian;
    let polynomial = PolynomialMicromoduli::plane(&stiffness, 1e3, omega).expect("material");
    let solved = plate.solve::<f64, _>(Ordinary::linearised(polynomial), |_| {});
    let Some(Error::IndefiniteOperator { curvature, wave, .. }) = solved.err() else {
        panic!("an equilibrium that is not stable is refused")
    };
    assert!(curvature < 0.0 && wave.iter().any(|k| *k != 0.0), "{curvature} {wave:?}");
    let split = PositiveSplit::plane(&stiffness, 1e3, omega).expect("material");
    plate.solve::<f64, _>(Ordinary::linearised(split), |_| {}).expect("a stable one is solved");
}

#[test]
fn too_few_iterations_and_velocities() {
    let left = grid().select(|x| x[0] < -9e-3);
    let right = grid().select(|x| x[0] > 9e-3);
    let loads = || Loads::new().clamp::<2>(&left).body_force(&right, 0, 1e9);
    let error = Statics::new().with_iterations(3).solve(&mut plate(NoDamage), loads());
    let error = error.expect_err("not converged");
    let Error::NotConverged { iterations: 3, residual, .. } = error else { panic!("{error}") };
    assert!(residual > 1e-6 && residual.is_finite());
    let error = refusal(loads().velocity(&right, 1, 1.0));
    assert!(error.to_string().contains("prescribed velocity"), "{error}");
    assert!(Statics::new().with_tolerance(0.0).is_err());
}

#[test]
fn supports_carry_the_load() {
    let left = grid().select(|x| x[0] < -9e-3);
    let right = grid().select(|x| x[0] > 9e-3);
    let loads = Loads::new().clamp::<2>(&left).body_force(&right, 0, 1e9);
    let mut body = plate(NoDamage);
    let mut seen = 0;
    let solved = Statics::new().solve_watched(&mut body, loads, |p| seen = p.iteration);
    assert_eq!(solved.expect("solved").iterations, seen);
    let total = 1e9 * right.len() as f64 * 1e-6;
    let force = peridynamics::core::run::reaction(&body, &left);
    assert!((force[0] + total).abs() < 1e-6 * total && force[1].abs() < 1e-6 * total, "{force}");
}
