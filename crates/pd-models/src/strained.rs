//! A stress for ordinary materials, through the nonlocal strain of a node.

use crate::anisotropic::inverse_moment;
use crate::elasticity::Stiffness;
use crate::elasticity::voigt::{stress_from_voigt, voigt_direction};
use crate::kinematics::BondLength;
use crate::ordinary::{Ordinary, ScalarState, SplitState};
use nalgebra::{SMatrix, SVector};
use pd_core::bond::{Bond, Member, Neighbourhood, Scale};
use pd_core::influence::Influence;
use pd_core::material::{Material, StressState};
use pd_core::{Real, Result as CoreResult};
use std::sync::Arc;

/// Any [`ScalarState`] model with a stress at every node, for criteria such as Tsai–Hill:
///
/// σ = C : s with the nonlocal strain s = 𝓜⁻¹ Σ μ ω|ξ| e v βV, 𝓜 = Σ ω|ξ|² v vᵀ βV of the whole
/// family and v = (n_x², …, n_x n_y): exact under homogeneous strain at every node; where bonds are
/// broken the stress falls. The forces are the model's own, to the last bit; a node carries V more
/// numbers, V = D(D+1)/2.
///
/// Use it as `Ordinary::new(Strained::plane(model, &stiffness, influence))`.
#[derive(Clone)]
pub struct Strained<S, const D: usize, const V: usize> {
    model: S,
    stiffness: SMatrix<f64, V, V>,
    influence: Arc<dyn Influence>,
}

impl<S> Strained<S, 2, 3> {
    /// A plate with the plane stiffness C of the model.
    pub fn plane(model: S, stiffness: &Stiffness<2>, influence: impl Influence + 'static) -> Self {
        Self { model, stiffness: stiffness.voigt(), influence: Arc::new(influence) }
    }
}

impl<S> Strained<S, 3, 6> {
    /// A solid with the stiffness C of the model.
    pub fn solid(model: S, stiffness: &Stiffness<3>, influence: impl Influence + 'static) -> Self {
        Self { model, stiffness: stiffness.voigt(), influence: Arc::new(influence) }
    }
}

impl<T, S, const D: usize, const V: usize> ScalarState<T, D> for Strained<S, D, V>
where
    T: Real,
    S: ScalarState<T, D>,
{
    /// The model's own, and ω|ξ| v.
    type BondConst = (S::BondConst, SVector<T, V>);
    type NodeConst = S::NodeConst;
    /// The model's own, and C 𝓜⁻¹.
    type FamilyConst = (S::FamilyConst, SMatrix<T, V, V>);
    /// The model's own, and Σ μ ω|ξ| e v βV.
    type FamilySum = (S::FamilySum, SVector<T, V>);
    /// The model's own, and the stress by Voigt components.
    type NodeState = (S::NodeState, SVector<T, V>);

    fn density(&self, node: usize) -> f64 {
        self.model.density(node)
    }
    fn bond_const(&self, xi: &SVector<f64, D>, scale: Scale) -> Self::BondConst {
        let (length, n) = (xi.norm(), xi.normalize());
        let omega = self.influence.weight(length / scale.horizon);
        let v: SVector<f64, V> = voigt_direction(&n) * (omega * length);
        (self.model.bond_const(xi, scale), v.map(T::of))
    }
    fn node_const(
        &self,
        family: &Neighbourhood<'_, (BondLength<T>, Self::BondConst), D>,
    ) -> CoreResult<(S::NodeConst, Self::FamilyConst)> {
        let (mut m, mut moment) = (0.0, SMatrix::<f64, V, V>::zeros());
        let mut members = Vec::with_capacity(family.members.len());
        for member in family.members {
            let (length, (own, _)) = member.bond;
            members.push(Member { xi: member.xi, volume: member.volume, bond: (length, own) });
            let v: SVector<f64, V> = voigt_direction(&member.xi.normalize());
            let length = member.xi.norm();
            let omega = self.influence.weight(length / family.scale.horizon);
            let weight = omega * length * length * member.volume;
            m += weight;
            moment += v * v.transpose() * weight;
        }
        let own = Neighbourhood { node: family.node, scale: family.scale, members: &members };
        let (constants, of_family) = self.model.node_const(&own)?;
        let inverse = inverse_moment(&moment, m, family.node, family.members.len())?;
        Ok((constants, (of_family, (self.stiffness * inverse).map(T::of))))
    }
    #[inline(always)]
    fn add(
        &self,
        sum: &mut Self::FamilySum,
        bond: &Bond<T, D>,
        e: T,
        k: &Self::BondConst,
        volume: T,
    ) {
        self.model.add(&mut sum.0, bond, e, &k.0, volume);
        bond.add_scaled(&mut sum.1, e * volume, &k.1);
    }
    #[inline(always)]
    fn close(
        &self,
        sum: &Self::FamilySum,
        constants: &S::NodeConst,
        family: &Self::FamilyConst,
    ) -> Self::NodeState {
        (self.model.close(&sum.0, constants, &family.0), family.1 * sum.1)
    }
    #[inline(always)]
    fn line(
        &self,
        bond: &Bond<T, D>,
        weight: T,
        k: &Self::BondConst,
        constants: &S::NodeConst,
        state: &Self::NodeState,
    ) -> (Option<T>, T) {
        self.model.line(bond, weight, &k.0, constants, &state.0)
    }
}

impl<T, S, const D: usize, const V: usize> SplitState<T, D> for Strained<S, D, V>
where
    T: Real,
    S: SplitState<T, D>,
{
    #[inline(always)]
    fn energy_parts(
        &self,
        e: T,
        length: T,
        k: &Self::BondConst,
        constants: &S::NodeConst,
        state: &Self::NodeState,
    ) -> (T, T) {
        self.model.energy_parts(e, length, &k.0, constants, &state.0)
    }
}

impl<T, S, K, const D: usize, const V: usize> StressState<T, D> for Ordinary<Strained<S, D, V>, K>
where
    T: Real,
    S: ScalarState<T, D>,
    Self: Material<T, D, NodeState = (S::NodeState, SVector<T, V>)>,
{
    #[inline(always)]
    fn stress(&self, _: &Self::NodeConst, (_, stress): &Self::NodeState) -> SMatrix<T, D, D> {
        stress_from_voigt(stress)
    }
}
