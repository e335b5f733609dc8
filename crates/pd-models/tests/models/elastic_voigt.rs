//! Voigt notation.

use super::common::random;

use nalgebra::{Matrix2, Matrix3, SMatrix, SVector, Vector2, Vector3, Vector6};
use pd_models::elasticity::voigt::{
    small_strain, strain_from_voigt, strain_to_voigt, stress_from_voigt, stress_to_voigt,
    voigt_components, voigt_direction,
};
use proptest::prelude::*;

#[test]
fn order_and_engineering_shears() {
    assert_eq!((voigt_components(2), voigt_components(3)), (3, 6));
    let e = Matrix2::new(1.0, 3.0, 3.0, 2.0);
    assert_eq!(strain_to_voigt::<f64, 2, 3>(&e), Vector3::new(1.0, 2.0, 6.0));
    assert_eq!(stress_to_voigt::<f64, 2, 3>(&e), Vector3::new(1.0, 2.0, 3.0));
    // xx 1, yy 2, zz 3, yz 4, xz 5, xy 6.
    let e = Matrix3::new(1.0, 6.0, 5.0, 6.0, 2.0, 4.0, 5.0, 4.0, 3.0);
    assert_eq!(stress_to_voigt::<f64, 3, 6>(&e), Vector6::new(1.0, 2.0, 3.0, 4.0, 5.0, 6.0));
    assert_eq!(strain_to_voigt::<f64, 3, 6>(&e), Vector6::new(1.0, 2.0, 3.0, 8.0, 10.0, 12.0));
    let n = Vector3::new(2.0, 3.0, 5.0);
    assert_eq!(voigt_direction::<f64, 3, 6>(&n), Vector6::new(4.0, 9.0, 25.0, 15.0, 10.0, 6.0));
    assert_eq!(voigt_direction::<f64, 2, 3>(&Vector2::new(2.0, 3.0)), Vector3::new(4.0, 9.0, 6.0));
}

#[test]
fn strain_of_a_gradient() {
    // Simple shear u_x = γ y has ε_xy = γ/2 and engineering shear γ; a rotation has none.
    let h = Matrix2::new(0.0_f32, 0.25, 0.0, 0.0);
    assert_eq!(small_strain(&h), Matrix2::new(0.0, 0.125, 0.125, 0.0));
    assert_eq!(strain_to_voigt::<f32, 2, 3>(&small_strain(&h))[2], 0.25);
    assert_eq!(small_strain(&Matrix2::new(0.0, -0.5, 0.5, 0.0)), Matrix2::zeros());
}

fn check<const D: usize, const V: usize>(
    e: SMatrix<f64, D, D>,
    s: SMatrix<f64, D, D>,
    n: [f64; 3],
) {
    let n = SVector::<f64, D>::from_fn(|d, _| n[d]);
    let (strain, stress) = (strain_to_voigt::<f64, D, V>(&e), stress_to_voigt::<f64, D, V>(&s));
    assert_eq!(strain_from_voigt::<f64, D, V>(&strain), e);
    assert_eq!(stress_from_voigt::<f64, D, V>(&stress), s);
    assert!((stress.dot(&strain) - s.dot(&e)).abs() < 1e-14);
    let v = voigt_direction::<f64, D, V>(&n);
    assert!((v.dot(&strain) - n.dot(&(e * n))).abs() < 1e-14);
}

proptest! {
    /// There and back; σ:ε and n·ε·n are the same in either notation.
    #[test]
    fn work_and_extension(
        e2 in random::symmetric::<2>(), s2 in random::symmetric::<2>(),
        e3 in random::symmetric::<3>(), s3 in random::symmetric::<3>(),
        n in proptest::array::uniform3(-1.0..1.0_f64),
    ) {
        check::<2, 3>(e2, s2, n);
        check::<3, 6>(e3, s3, n);
    }
}
