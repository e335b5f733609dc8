//! Bad input gives a typed error that names the value, the node and what to do.
use crate::common;
use peridynamics::prelude::*;

fn family(m: f64) -> Lattice<f64, 2> {
    let grid = Grid::new(&Cuboid::centred([10.0, 10.0]).expect("box"), 1.0).expect("grid");
    Lattice::new(&grid, Horizon::Cells(m), Quadrature::None).expect("family")
}

fn material() -> Correspondence<LinearElastic<2>> {
    Correspondence::new(LinearElastic(common::ply()), 1e3, InfluenceFunction::Linear).expect("m")
}

#[test]
fn a_crack_through_nodes() {
    let crack = Segment::new([-3.0, 0.5], [2.0, 0.5]).expect("crack");
    let error = Body::new(family(3.0), material(), Precracked::by(crack)).err().expect("refused");
    assert!(matches!(error, Error::CrackThroughNode { .. }), "{error}");
    assert!(error.to_string().contains("shift the crack by"), "{error}");
}

#[test]
fn a_singular_shape_tensor() {
    let policy = ShapePolicy { rule: IllConditioned::Refuse, limit: 1e6 };
    let refused = Body::new(family(1.0), material().with_shape_policy(policy), NoDamage).err();
    let error = refused.expect("m = 1 with the linear influence function is singular");
    assert!(matches!(error, Error::SingularShapeTensor { node: 0, .. }), "{error}");
}

#[test]
fn an_empty_family() {
    let points = Points::new(vec![[0.0, 0.0].into(), [9.0, 0.0].into()], vec![1.0, 1.0]);
    let cloud = Cloud::<f64, 2>::new(&points.expect("p"), Horizon::Metres(2.0), Quadrature::None);
    let error = Body::new(cloud.expect("family"), material(), NoDamage).err().expect("refused");
    assert!(matches!(error, Error::EmptyFamily { node: 0, .. }), "{error}");
}

#[test]
fn unphysical_constants() {
    let ply = Lamina { e1: 1e9, e2: 4e9, g12: 1e9, nu12: 0.6 };
    let error = Stiffness::<2>::lamina(&ply).expect_err("refused").to_string();
    assert!(error.contains("ν12 is 0.6") && error.contains("√(E1/E2) = 0.5"), "{error}");
    let error = Isotropic::from_young_poisson(1e9, 0.5).expect_err("refused").to_string();
    assert!(error.contains("0.5"), "{error}");
    let moduli = Isotropic::from_young_poisson(1e9, 0.3).expect("moduli");
    let refused = Pmb::solid(&moduli, 1e3, InfluenceFunction::Constant).err();
    assert!(refused.expect("ν is not 1/4").to_string().contains("0.3"));
}

#[test]
fn loads_that_make_no_sense() {
    let mut body = Body::new(family(3.0), material(), NoDamage).expect("body");
    let grid = body.family().grid().clone();
    let edge = grid.select(|x| x[0] > 4.0);
    let twice = Loads::new().displacement(&edge, 0, 0.0).velocity(&edge, 0, 1.0);
    let error = Run::new(&mut body, twice, TimeStep::Safety(0.5)).err().expect("refused");
    assert!(matches!(error, Error::ConflictingConditions { axis: 0, .. }), "{error}");
    let late = Loads::new().velocity(&edge, 0, |t: f64| if t > 1e-3 { f64::NAN } else { 0.0 });
    let mut run = Run::new(&mut body, late, TimeStep::Safety(0.5)).expect("run");
    let error = run.until(1.0).expect_err("ends");
    assert!(matches!(error, Error::During { .. }), "{error}");
    assert!(error.to_string().contains("prescribed velocity [m/s] is NaN"), "{error}");
}

/// A law of constant stiffness, which may be nothing or NaN.
struct Springs(f64);

impl<T: Real, const D: usize> BondLaw<T, D> for Springs {
    type Const = T;
    fn density(&self) -> f64 {
        1e3
    }
    fn bond_const(&self, xi: &SVector<f64, D>, _: Scale) -> T {
        T::of(xi.norm())
    }
    fn force(&self, bond: &Bond<T, D>, length: &T) -> T {
        T::of(self.0) * bond.extension(*length)
    }
}

#[test]
fn a_body_without_a_time_step() {
    let run = |stiffness: f64, rule: TimeStep| {
        let springs = BondBased(Springs(stiffness));
        let mut body = Body::<f64, 2, _, _, _>::new(family(3.0), springs, NoDamage).expect("body");
        Run::new(&mut body, Loads::new(), rule).map(|run| run.dt())
    };
    let error = run(f64::NAN, TimeStep::Safety(0.5)).expect_err("refused");
    assert!(error.to_string().contains("force density of a small displacement"), "{error}");
    assert!(run(f64::NAN, TimeStep::Fixed(1e-6)).is_err());
    let error = run(0.0, TimeStep::Safety(0.5)).expect_err("refused");
    assert!(error.to_string().contains("critical time step [s] is inf"), "{error}");
    assert_eq!(run(0.0, TimeStep::Fixed(1e-6)), Ok(1e-6));
    // A spring that pushes when it is pulled.
    let error = run(-1e9, TimeStep::Safety(0.5)).expect_err("refused");
    assert!(matches!(error, Error::UnstableBody { .. }), "{error}");
}
