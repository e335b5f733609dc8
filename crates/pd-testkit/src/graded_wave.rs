//! A pulse crosses a plate from fine to coarse nodes. In the classical plate nothing comes back.

use nalgebra::{SMatrix, SVector};
use pd_core::bond::{Bond, End, Neighbourhood, Scale};
use pd_core::region::Cuboid;
use pd_core::run::{Run, TimeStep};
use pd_core::{
    Body, DamagePolicy, Dynamics, Family, Grid, Loads, Material, NoDamage, Points, Real, Result,
};

/// The plate: coarse spacing 1 m, fine ¼ m for x < 0, and a pulse u_x = exp(−(x−x₀)²/(2w²)) that
/// runs to the right. It ends before anything from the edges reaches its middle line.
#[derive(Debug, Clone, Copy)]
pub struct Plate {
    /// Width w of the pulse in m. Its spectrum is exp(−k²w²/2): wave lengths below 2πw hold little.
    pub width: f64,
    /// Length in m of a part with the spacing ½ m between fine and coarse.
    pub between: f64,
}

/// Edges of the coarse and of the fine cells in m.
pub const COARSE: f64 = 1.0;
/// See [`COARSE`].
pub const FINE: f64 = 0.25;

/// What came of the pulse, whose height was 1.
#[derive(Debug, Clone)]
pub struct Crossing {
    /// Largest |u_x| that came back to x < −δ.
    pub reflected: f64,
    /// Largest u_x beyond.
    pub transmitted: f64,
    /// (x, u_x) along the middle of the plate at the end.
    pub profile: Vec<(f64, f64)>,
}

impl Plate {
    fn start(&self) -> f64 {
        -4.0 * self.width
    }
    /// Way of the pulse until it and what it left behind are 7 w apart.
    fn way(&self) -> f64 {
        7.5 * self.width
    }
    /// Nodes in squares: ¼ m, then ½ m over `between`, then 1 m.
    ///
    /// # Errors
    /// A plate without nodes.
    pub fn points(&self) -> Result<Points<2>> {
        Points::refined(&self.coarse()?, |x| {
            if x[0] < 0.0 {
                FINE
            } else if x[0] < self.between {
                2.0 * FINE
            } else {
                COARSE
            }
        })
    }
    /// The same plate with fine nodes everywhere.
    ///
    /// # Errors
    /// As [`points`](Self::points).
    pub fn uniform(&self) -> Result<Points<2>> {
        Points::refined(&self.coarse()?, |_| FINE)
    }
    /// Coarse cells with an edge of cells on x = 0.
    fn coarse(&self) -> Result<Grid<2>> {
        let (low, high) = ((8.5 * self.width).ceil(), (8.0 * self.width).ceil());
        let half = (self.way() + 3.0 * COARSE).ceil();
        Grid::new(&Cuboid::new([-low, -half], [high, half])?, COARSE)
    }
    /// Sends the pulse at the speed `speed` of long waves (m/s) through a body made of these points.
    ///
    /// # Errors
    /// A run that does not stay finite.
    pub fn send<F, M>(
        &self,
        body: &mut Body<f64, 2, F, M, NoDamage>,
        speed: f64,
    ) -> Result<Crossing>
    where
        F: Family<f64, 2>,
        M: Material<f64, 2>,
    {
        let (start, w) = (self.start(), self.width);
        let pulse = move |x: f64| (-(x - start).powi(2) / (2.0 * w * w)).exp();
        // u = f(x − ct) has v = −c f′. Small against Δx, so that all is linear.
        let small = 1e-6;
        body.set_displacement(|x| [small * pulse(x[0]), 0.0].into());
        body.set_velocity(|x| [small * pulse(x[0]) * speed * (x[0] - start) / (w * w), 0.0].into());
        let dt = TimeStep::Unchecked(0.5 * FINE / speed);
        let mut run = Run::new(body, Loads::new(), dt)?;
        run.until(self.way() / speed)?;
        drop(run);
        let middle = (0..body.nodes()).filter(|&i| body.position(i)[1].abs() < COARSE);
        let mut profile: Vec<(f64, f64)> =
            middle.map(|i| (body.position(i)[0], body.displacement(i)[0] / small)).collect();
        profile.sort_by(|a, b| a.partial_cmp(b).expect("finite"));
        let largest = |from: f64, to: f64| {
            let within = profile.iter().filter(|p| (from..to).contains(&p.0));
            within.map(|p| p.1.abs()).fold(0.0, f64::max)
        };
        Ok(Crossing {
            reflected: largest(-6.5 * w, -3.0 * COARSE),
            transmitted: largest(0.0, 8.0 * w),
            profile,
        })
    }
}

/// Largest |f_i| δ_i/E under the homogeneous displacement gradient H of size 1 (ghost force), over
/// the nodes that `inside` selects; E in Pa.
///
/// # Errors
/// A body that cannot be evaluated.
pub fn ghost_force<T, const D: usize, F, M, P>(
    body: &mut Body<T, D, F, M, P>,
    h: &SMatrix<f64, D, D>,
    young: f64,
    inside: impl Fn(&SVector<f64, D>) -> bool,
) -> Result<f64>
where
    T: Real,
    F: Family<T, D>,
    M: Material<T, D>,
    P: DamagePolicy<T, D, M>,
{
    let small = 1e-6;
    body.set_displacement(|x| h * x * small);
    body.evaluate()?;
    let nodes = (0..body.nodes()).filter(|&i| inside(&body.position(i)));
    let size = |i: usize| {
        let Scale { horizon, unit } = body.family().scale(i);
        body.force_density(i).norm() * horizon * unit / (young * small)
    };
    Ok(nodes.map(size).fold(0.0, f64::max))
}

/// |Σ f V|/Σ |f| V: 0 to rounding where momentum is kept.
pub fn unbalance<T, const D: usize, F, M, P>(body: &Body<T, D, F, M, P>) -> f64
where
    T: Real,
    F: Family<T, D>,
    M: Material<T, D>,
    P: DamagePolicy<T, D, M>,
{
    let forces = (0..body.nodes()).map(|i| body.force_density(i) * body.volume(i));
    let (sum, size) =
        forces.fold((SVector::<f64, D>::zeros(), 0.0), |(s, n), f| (s + f, n + f.norm()));
    sum.norm() / size
}

/// A bond-based material as codes without a dual horizon take it: every node counts its own family
/// only, f_i = Σ_{H_i} 2T_i V_j, and where horizons differ action is not reaction.
pub struct OneSided<M>(pub M);

impl<T, const D: usize, M> Material<T, D> for OneSided<M>
where
    T: Real,
    M: Material<T, D, NodeState = ()>,
{
    type BondConst = M::BondConst;
    type NodeConst = M::NodeConst;
    type FamilyConst = M::FamilyConst;
    type FamilySum = ();
    type NodeState = ();

    fn density(&self, node: usize) -> f64 {
        self.0.density(node)
    }
    fn bond_const(&self, xi: &SVector<f64, D>, scale: Scale) -> M::BondConst {
        self.0.bond_const(xi, scale)
    }
    fn node_const(
        &self,
        family: &Neighbourhood<'_, M::BondConst, D>,
    ) -> Result<(M::NodeConst, M::FamilyConst)> {
        self.0.node_const(family)
    }
    #[inline(always)]
    fn force_state(
        &self,
        bond: &Bond<T, D>,
        end: End<'_, T, M::BondConst, M::NodeConst, ()>,
    ) -> SVector<T, D> {
        self.0.force_state(bond, end)
    }
    #[inline(always)]
    fn pair_force(
        &self,
        bond: &Bond<T, D>,
        [near, _]: [End<'_, T, M::BondConst, M::NodeConst, ()>; 2],
    ) -> SVector<T, D> {
        self.0.force_state(bond, near) * (near.volume * T::of(2.0))
    }
}
