//! Random stiffnesses and tensors for property tests.
#![allow(dead_code)]

use nalgebra::{Matrix3, Matrix6, SMatrix};
use pd_models::Stiffness;
use proptest::array::uniform;
use proptest::prelude::*;

/// A general plane stiffness in Pa, all 6 constants, condition number up to some 1e4.
pub fn stiffness2() -> impl Strategy<Value = Stiffness<2>> {
    uniform::<_, 9>(-1.0..1.0_f64).prop_map(|a| {
        let a = Matrix3::from_row_slice(&a);
        Stiffness::<2>::from_voigt((a * a.transpose() + Matrix3::identity() * 1e-3) * 1e10).unwrap()
    })
}

/// A general stiffness of space in Pa, all 21 constants.
pub fn stiffness3() -> impl Strategy<Value = Stiffness<3>> {
    uniform::<_, 36>(-1.0..1.0_f64).prop_map(|a| {
        let a = Matrix6::from_row_slice(&a);
        Stiffness::<3>::from_voigt((a * a.transpose() + Matrix6::identity() * 1e-3) * 1e10).unwrap()
    })
}

/// A symmetric tensor with entries in (−1, 1).
pub fn symmetric<const D: usize>() -> impl Strategy<Value = SMatrix<f64, D, D>> {
    uniform::<_, 9>(-1.0..1.0_f64).prop_map(|a| SMatrix::from_fn(|i, j| a[3 * i.min(j) + i.max(j)]))
}
