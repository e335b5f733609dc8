//! Voigt notation: symmetric tensors as columns, order xx, yy, xy in 2D and xx, yy, zz, yz, xz, xy
//! in 3D, strains with engineering shears (γ = 2ε), so that energy is ½ σ·ε in either form.
//!
//! `V` is the number of components, 3 for D = 2 and 6 for D = 3; another one does not compile.

use nalgebra::{SMatrix, SVector};
use pd_core::Real;

/// Number of Voigt components: 3 in 2D, 6 in 3D.
pub const fn voigt_components(dimension: usize) -> usize {
    dimension * (dimension + 1) / 2
}

/// The axes i ≤ j of a Voigt component.
#[inline(always)]
pub(crate) const fn voigt_axes(dimension: usize, component: usize) -> (usize, usize) {
    match (dimension, component) {
        (_, r) if r < dimension => (r, r),
        (2, _) | (_, 5) => (0, 1),
        (_, 4) => (0, 2),
        _ => (1, 2),
    }
}

/// The Voigt component of a pair of axes, in either order.
#[inline(always)]
pub(crate) const fn voigt_index(dimension: usize, i: usize, j: usize) -> usize {
    if i == j {
        i
    } else if dimension == 2 {
        2
    } else {
        6 - i - j
    }
}

/// Column of values by Voigt component, given component and axes.
#[inline(always)]
fn column<T: Real, const D: usize, const V: usize>(
    value: impl Fn(usize, usize) -> T,
) -> SVector<T, V> {
    const { assert!(V == voigt_components(D), "V must be 3 in 2D and 6 in 3D") };
    SVector::from_fn(|r, _| {
        let (i, j) = voigt_axes(D, r);
        value(i, j)
    })
}

/// Symmetric tensor of values by Voigt component; `shear` is the factor off the diagonal.
#[inline(always)]
fn tensor<T: Real, const D: usize, const V: usize>(
    column: &SVector<T, V>,
    shear: T,
) -> SMatrix<T, D, D> {
    const { assert!(V == voigt_components(D), "V must be 3 in 2D and 6 in 3D") };
    SMatrix::from_fn(|i, j| {
        let value = column[voigt_index(D, i, j)];
        if i == j { value } else { shear * value }
    })
}

/// Small strain ε = ½(H + Hᵀ) of a displacement gradient H_ij = ∂u_i/∂x_j.
#[inline(always)]
pub fn small_strain<T: Real, const D: usize>(h: &SMatrix<T, D, D>) -> SMatrix<T, D, D> {
    (h + h.transpose()) * T::of(0.5)
}

/// Strain tensor to column, with engineering shears.
#[inline(always)]
pub fn strain_to_voigt<T: Real, const D: usize, const V: usize>(
    strain: &SMatrix<T, D, D>,
) -> SVector<T, V> {
    column::<T, D, V>(|i, j| if i == j { strain[(i, i)] } else { strain[(i, j)] + strain[(j, i)] })
}

/// Column with engineering shears to strain tensor.
#[inline(always)]
pub fn strain_from_voigt<T: Real, const D: usize, const V: usize>(
    strain: &SVector<T, V>,
) -> SMatrix<T, D, D> {
    tensor(strain, T::of(0.5))
}

/// Stress tensor to column.
#[inline(always)]
pub fn stress_to_voigt<T: Real, const D: usize, const V: usize>(
    stress: &SMatrix<T, D, D>,
) -> SVector<T, V> {
    column::<T, D, V>(|i, j| stress[(i, j)])
}

/// Column to stress tensor.
#[inline(always)]
pub fn stress_from_voigt<T: Real, const D: usize, const V: usize>(
    stress: &SVector<T, V>,
) -> SMatrix<T, D, D> {
    tensor(stress, T::one())
}

/// v⟨n⟩ = (n_x², n_y², n_x n_y) in 2D, (n_x², n_y², n_z², n_y n_z, n_x n_z, n_x n_y) in 3D: the
/// extension along n is n·ε·n = v·ε_voigt with engineering shears.
#[inline(always)]
pub fn voigt_direction<T: Real, const D: usize, const V: usize>(
    n: &SVector<T, D>,
) -> SVector<T, V> {
    column::<T, D, V>(|i, j| n[i] * n[j])
}
