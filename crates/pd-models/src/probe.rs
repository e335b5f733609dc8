//! The elasticity tensor that a node of a body really has.

use crate::elasticity::voigt::{strain_from_voigt, stress_to_voigt};
use nalgebra::{SMatrix, SVector};
use pd_core::Real;
use pd_core::body::Body;
use pd_core::damage::DamagePolicy;
use pd_core::family::Family;
use pd_core::material::Material;

/// Stiffness of a node in Pa (Voigt: V = 3 in 2D, 6 in 3D) about the reference configuration, for
/// any material: the stress of its intact family
/// ([`Body::stress_under`]) under each homogeneous strain.
///
/// In the bulk it tells the error of the quadrature, at a surface or crack also what the missing
/// bonds do.
pub fn elasticity_tensor<T, const D: usize, const V: usize, F, M, P>(
    body: &Body<T, D, F, M, P>,
    node: usize,
) -> SMatrix<f64, V, V>
where
    T: Real,
    F: Family<T, D>,
    M: Material<T, D>,
    P: DamagePolicy<T, D, M>,
{
    // The best step of a central difference; it makes no difference to a linear material.
    let step = T::EPSILON.cbrt();
    let mut tensor = SMatrix::<f64, V, V>::zeros();
    for column in 0..V {
        let unit = SVector::<f64, V>::from_fn(|r, _| if r == column { 1.0 } else { 0.0 });
        let strain: SMatrix<f64, D, D> = strain_from_voigt(&unit);
        let stress = |h: f64| body.stress_under(node, &(strain * h));
        let difference = (stress(step) - stress(-step)) / (2.0 * step);
        tensor.set_column(column, &stress_to_voigt::<f64, D, V>(&difference));
    }
    tensor
}
