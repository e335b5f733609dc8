//! A force law that overflows on bonds broken long ago does not spoil its nodes.

use peridynamics::prelude::*;

/// t = c (exp(40 s) − 1): infinite in f64 for s > 18.
struct Exponential;

impl<T: Real, const D: usize> BondLaw<T, D> for Exponential {
    type Const = T;
    fn density(&self) -> f64 {
        1000.0
    }
    fn bond_const(&self, xi: &SVector<f64, D>, _: Scale) -> T {
        T::of(xi.norm())
    }
    fn force(&self, bond: &Bond<T, D>, length: &T) -> T {
        T::of(1e9) * ((T::of(40.0) * bond.extension(*length) / *length).exp() - T::one())
    }
}

#[test]
fn fragments_far_apart_stay_finite() {
    let grid = Grid::<2>::new(&Cuboid::centred([20.0, 10.0]).unwrap(), 1.0).unwrap();
    let family = Lattice::<f64, 2>::new(&grid, Horizon::Cells(3.0), Quadrature::None).unwrap();
    let crack = Segment::new([0.0, -6.0], [0.0, 6.0]).unwrap();
    let mut body = Body::new(family, BondBased(Exponential), Precracked::by(crack)).unwrap();
    // The halves are 1000 cells apart: every cut bond overflows.
    body.set_displacement(|x| {
        SVector::from([if x[0] > 0.0 { 1e3 } else { 0.0 } + 1e-3 * x[1], 0.0])
    });
    body.evaluate().unwrap();
    let cut = (0..body.nodes()).filter(|&i| body.damage(i) > 0.0).count();
    assert_eq!(cut, 60);
    let sheared = (0..body.nodes()).filter(|&i| body.force_density(i).norm() > 1.0).count();
    assert!(sheared > 0);
    assert!((0..body.nodes()).all(|i| body.force_density(i).iter().all(|f| f.is_finite())));
}
