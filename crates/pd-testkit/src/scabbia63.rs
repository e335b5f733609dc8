//! An anisotropic plate pulled on half an edge (Scabbia §6.3): glass–epoxy, fibres at 40°,
//! 0.3 × 0.2 m, clamped on the left in a fictitious layer, 10 MPa in x on the upper half of the right
//! edge.

use pd_core::region::Cuboid;
use pd_core::statics::{Progress, Solved};
use pd_core::{
    Body, Face, Grid, Horizon, Lattice, Loads, Material, NoDamage, NodeSet, Quadrature, Real,
    Result, Statics,
};

/// Length of the plate in metres.
pub const LENGTH: f64 = 0.3;
/// Height of the plate in metres.
pub const HEIGHT: f64 = 0.2;
/// Traction on half the right edge in Pa.
pub const PRESSURE: f64 = 10e6;

/// Where the conditions act.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Conditions {
    /// On the edges of the plate.
    Faces,
    /// As in the paper: zero displacements in a fictitious layer as thick as the horizon, and a body
    /// force in a layer of this thickness in metres.
    Layers(f64),
}

/// The discretisation of the plate.
#[derive(Debug, Clone, Copy)]
pub struct Plate {
    /// Spacing in metres.
    pub dx: f64,
    /// Horizon over spacing.
    pub m: f64,
    /// Weights of the cells that the horizon cuts.
    pub quadrature: Quadrature,
    /// Where the conditions act.
    pub conditions: Conditions,
    /// Of the solver.
    pub tolerance: f64,
}

/// The solved plate.
pub struct Solution<T: Real, M: Material<T, 2>> {
    /// The body, with its displacements.
    pub body: Body<T, 2, Lattice<T, 2>, M, NoDamage>,
    /// The clamped nodes.
    pub clamp: NodeSet,
    /// What the solver did.
    pub solved: Solved,
}

impl Plate {
    /// Solves it for a material.
    ///
    /// # Errors
    /// What the body or the solver refuses.
    pub fn solve<T: Real, M: Material<T, 2>>(
        &self,
        material: M,
        watch: impl FnMut(Progress),
    ) -> Result<Solution<T, M>> {
        let cells = self.m.ceil() * if self.conditions == Conditions::Faces { 2.0 } else { 1.0 };
        let corner = [-(cells * self.dx), 0.0];
        let grid = Grid::new(&Cuboid::new(corner, [LENGTH, HEIGHT])?, self.dx)?;
        let horizon = Horizon::Metres(self.m * self.dx);
        let family = Lattice::<T, 2>::new(&grid, horizon, self.quadrature)?;
        let mut body = Body::new(family, material, NoDamage)?;
        let clamp = grid.select(|x| x[0] < 0.0);
        let loads = match self.conditions {
            Conditions::Faces => {
                let left = Face::new([0.0, 0.0], [-1.0, 0.0])?;
                let right = Face::new([LENGTH, 0.0], [1.0, 0.0])?;
                let upper = grid.select(|x| x[1] > 0.5 * HEIGHT);
                (0..2)
                    .fold(Loads::new(), |l, axis| l.displacement_at(&left, &clamp, axis, 0.0))
                    .traction(&right, &upper, 0, PRESSURE * 0.5 * HEIGHT)
            }
            Conditions::Layers(depth) => {
                let loaded = grid.select(|x| x[0] > LENGTH - depth && x[1] > 0.5 * HEIGHT);
                // The same total force whatever the layer: pressure × edge over the layer's area.
                let area = loaded.len() as f64 * grid.cell_volume();
                let density = PRESSURE * 0.5 * HEIGHT / area;
                Loads::new().clamp::<2>(&clamp).body_force(&loaded, 0, density)
            }
        };
        let solver = Statics::new().with_tolerance(self.tolerance)?;
        let solved = solver.solve_watched(&mut body, loads, watch)?;
        Ok(Solution { body, clamp, solved })
    }
}
