//! A surface correction for ordinary materials.

use crate::elasticity::Stiffness;
use crate::kinematics::BondLength;
use crate::ordinary::ScalarState;
use nalgebra::SVector;
use pd_core::bond::{Bond, Neighbourhood, Scale};
use pd_core::record::Record;
use pd_core::{Real, Result as CoreResult};

/// An ordinary model whose nodes are weighed by their own families: W of each node times
///
/// g = (C_i : C)/(C_i : C_i),
///
/// C_i being the stiffness that the node's family really has under homogeneous strain and C the
/// material's. Where bonds are missing at a surface, or the quadrature errs, g C_i is the nearest to
/// C of all multiples of C_i. One number per node, and forces still derive from an energy; the shape
/// of C_i stays, which only the [positive split](crate::PositiveSplit) repairs.
#[derive(Debug, Clone)]
pub struct OnFamily<S, const D: usize> {
    model: S,
    stiffness: Stiffness<D>,
}

impl<S, const D: usize> OnFamily<S, D> {
    /// The model of a material with the stiffness C.
    pub fn new(model: S, stiffness: &Stiffness<D>) -> Self {
        Self { model, stiffness: *stiffness }
    }
    /// g of a family whose node has these constants.
    fn weight<T: Real>(
        &self,
        family: &Neighbourhood<'_, (BondLength<T>, S::BondConst), D>,
        (constants, of_family): &(S::NodeConst, S::FamilyConst),
    ) -> f64
    where
        S: ScalarState<T, D>,
    {
        let bond = |xi: &SVector<f64, D>| Bond::new(xi.map(T::of), SVector::zeros());
        let (mut mixed, mut own) = (0.0, 0.0);
        for k in 0..D {
            for l in 0..D {
                // Strain ½(e_k e_l + e_l e_k): e = n_k n_l |ξ|, whose stress is C_i…kl.
                let extension = |xi: &SVector<f64, D>| xi[k] * xi[l] / xi.norm();
                let mut sum = S::FamilySum::zero();
                for m in family.members {
                    let e = T::of(extension(&m.xi));
                    self.model.add(&mut sum, &bond(&m.xi), e, &m.bond.1, T::of(m.volume));
                }
                let state = self.model.close(&sum, constants, of_family);
                for i in 0..D {
                    for j in 0..D {
                        let stress = family.sum(|m| {
                            let e = T::of(extension(&m.xi));
                            let (k, bond) = (&m.bond.1, bond(&m.xi));
                            let t = self.model.scalar_force(&bond, e, k, constants, &state);
                            t.to_f64() * m.xi[i] * m.xi[j] / m.xi.norm()
                        });
                        mixed += stress * self.stiffness.c(i, j, k, l);
                        own += stress * stress;
                    }
                }
            }
        }
        if own > 0.0 { mixed / own } else { 1.0 }
    }
}

impl<T: Real, const D: usize, S: ScalarState<T, D>> ScalarState<T, D> for OnFamily<S, D> {
    type BondConst = S::BondConst;
    /// g and the constants of the model.
    type NodeConst = (T, S::NodeConst);
    type FamilyConst = S::FamilyConst;
    type FamilySum = S::FamilySum;
    type NodeState = S::NodeState;

    fn density(&self, node: usize) -> f64 {
        self.model.density(node)
    }
    fn bond_const(&self, xi: &SVector<f64, D>, scale: Scale) -> S::BondConst {
        self.model.bond_const(xi, scale)
    }
    fn node_const(
        &self,
        family: &Neighbourhood<'_, (BondLength<T>, S::BondConst), D>,
    ) -> CoreResult<((T, S::NodeConst), S::FamilyConst)> {
        let constants = self.model.node_const(family)?;
        let g = self.weight(family, &constants);
        pd_core::Error::check(g > 0.0, "surface correction g of a node", g, "positive")?;
        Ok(((T::of(g), constants.0), constants.1))
    }
    #[inline(always)]
    fn add(&self, sum: &mut S::FamilySum, bond: &Bond<T, D>, e: T, k: &S::BondConst, volume: T) {
        self.model.add(sum, bond, e, k, volume);
    }
    #[inline(always)]
    fn close(
        &self,
        sum: &S::FamilySum,
        constants: &(T, S::NodeConst),
        family: &S::FamilyConst,
    ) -> S::NodeState {
        self.model.close(sum, &constants.1, family)
    }
    #[inline(always)]
    fn line(
        &self,
        bond: &Bond<T, D>,
        weight: T,
        k: &S::BondConst,
        (g, constants): &(T, S::NodeConst),
        state: &S::NodeState,
    ) -> (Option<T>, T) {
        let (a, b) = self.model.line(bond, weight, k, constants, state);
        (a.map(|a| *g * a), *g * b)
    }
}
