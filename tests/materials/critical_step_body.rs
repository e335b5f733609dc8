//! The critical step is that of the body: free surfaces and a crack lower it, against figures from
//! an independent code that assembled the stiffness. A plate of 12 × 12 nodes of steel, Δx = 1 mm,
//! plane stress, β = 1, with an edge crack to its middle whose bonds have left the families;
//! correspondence with the linear, LPS with the constant influence function.
use peridynamics::core::time_step::{Spectrum, spectrum};
use peridynamics::models::elasticity::catalogue::{STEEL_Q345_DENSITY as RHO, steel};
use peridynamics::prelude::*;

const DX: f64 = 1e-3;
const STRESS: PlaneMode = PlaneMode::PlaneStress;

fn body<M: Material<f64, 2>>(
    material: M,
    m: f64,
) -> Body<f64, 2, Lattice<f64, 2>, M, Precracked<2>> {
    let grid = Grid::new(&Cuboid::centred([12.0 * DX, 12.0 * DX]).expect("box"), DX).expect("grid");
    let family = Lattice::new(&grid, Horizon::Cells(m), Quadrature::None).expect("family");
    let crack = Segment::new([-7.0 * DX, 0.0], [0.0, 0.0]).expect("crack");
    Body::new(family, material, Precracked::by(crack).leaving_family()).expect("body")
}

/// Critical steps of the bulk and of the body.
fn steps<M: Material<f64, 2>>(material: M, m: f64) -> [f64; 2] {
    let bulk = Symbol::of(&material, DX, Horizon::Cells(m), Quadrature::None).expect("symbol");
    let mut body = body(&material, m);
    let Spectrum { residual, .. } = spectrum::<f64, 2, _>(&mut body).expect("spectrum");
    assert!(residual < 1e-3, "{residual}");
    let run = Run::new(&mut body, Loads::new(), TimeStep::Safety(1.0)).expect("run");
    [bulk.critical_time_step(), run.dt()]
}

fn correspondence() -> Correspondence<LinearElastic<2>> {
    let c = Stiffness::<2>::isotropic(&steel().expect("steel"), STRESS).expect("stiffness");
    Correspondence::new(LinearElastic(c), RHO, InfluenceFunction::Linear).expect("material")
}

fn solid() -> Ordinary<LinearSolid> {
    let one = InfluenceFunction::Constant;
    Ordinary::new(LinearSolid::plane(&steel().expect("steel"), STRESS, RHO, one).expect("m"))
}

#[test]
fn surfaces_and_a_crack_lower_it() {
    for (name, [bulk, body], reference) in [
        ("NOSB m = 3", steps(correspondence(), 3.0), [6.23e-7, 3.81e-7]),
        ("NOSB m = 2", steps(correspondence(), 2.0), [3.73e-7, 2.26e-7]),
        ("LPS m = 3", steps(solid(), 3.0), [3.94e-7, 3.58e-7]),
    ] {
        println!("{name}: bulk {bulk:.4e} s, body {body:.4e} s, reference {reference:?}");
        // Three digits are given; the body's own errs by 0.05 % (to the safe side).
        assert!((bulk / reference[0] - 1.0).abs() < 2e-3, "{name}: bulk {bulk:e}");
        assert!((body / reference[1] - 1.0).abs() < 3e-3, "{name}: body {body:e}");
    }
}

/// The bulk's step is refused for the body, and blows up where it is not checked.
#[test]
fn the_bulk_step_is_too_large() {
    let material = correspondence();
    let horizon = Horizon::Cells(3.0);
    let symbol = Symbol::of(&material, DX, horizon, Quadrature::None).expect("symbol");
    let bulk = 0.95 * symbol.critical_time_step();
    let mut body = body(&material, 3.0);
    let refused = Run::new(&mut body, Loads::new(), TimeStep::Fixed(bulk)).err();
    assert!(matches!(refused, Some(Error::UnstableTimeStep { .. })), "{refused:?}");
    body.set_velocity(|x| [1e-3 * x[1] / DX, 0.0].into());
    let mut run = Run::new(&mut body, Loads::new(), TimeStep::Unchecked(bulk)).expect("run");
    let ended = run.steps_more(2000).err();
    assert!(matches!(ended, Some(Error::BlowUp { .. } | Error::NotFinite { .. })), "{ended:?}");
}
