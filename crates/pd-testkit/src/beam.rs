//! A double cantilever beam in 3D (Willberg §5A): 20 mm high, with a crack of 5 mm, pulled open at
//! its left end by the first three columns of nodes of each arm. What the supports do in work, less
//! what unloading gives back, over the grown area must be the fracture energy put in.

use nalgebra::SVector;
use pd_core::crack::Polygon;
use pd_core::region::Cuboid;
use pd_core::run::reaction;
use pd_core::{
    Body, Breaking, Dynamics, Energies, Error, Grid, Horizon, Lattice, Loads, NodeSet, Quadrature,
    Real, Result, Run, StrainEnergy,
};
use pd_damage::combine::Sparing;
use pd_damage::{BondEnergy, CrackPath, CrackPlane, CriterionExt};

/// One millimetre in metres.
pub const MM: f64 = 1e-3;
/// Height of the beam in metres.
pub const HEIGHT: f64 = 20.0 * MM;
/// Length of the crack in metres.
pub const CRACK: f64 = 5.0 * MM;

/// The discretised beam.
#[derive(Debug, Clone, Copy)]
pub struct Beam {
    /// Length in metres.
    pub length: f64,
    /// Width in metres.
    pub width: f64,
    /// Spacing in metres.
    pub dx: f64,
    /// Horizon over spacing.
    pub m: f64,
    /// Weights of the cells that the horizon cuts.
    pub quadrature: Quadrature,
}

/// A beam that breaks by Foster's criterion, except at its arms.
pub type Opened<T, M> = Body<T, 3, Lattice<T, 3>, M, Breaking<Sparing<BondEnergy>, 3>>;

/// One look at the beam: opening of one arm, growth of the crack (both in metres), force of each
/// arm in N, energies.
#[derive(Debug, Clone, Copy)]
pub struct Look {
    /// Displacement of one arm in metres.
    pub u: f64,
    /// Growth of the crack in metres.
    pub growth: f64,
    /// Force of the upper and lower arm in N.
    pub force: [f64; 2],
    /// Energies of the run.
    pub energies: Energies,
}

impl Look {
    /// Work of both arms less what unloading gives back, over the grown area, in J/m².
    pub fn energy_release_rate(&self, width: f64) -> f64 {
        self.given() / (width * self.growth)
    }
    fn given(&self) -> f64 {
        self.energies.external - self.energies.strain - self.energies.kinetic
    }
}

impl Beam {
    /// The families.
    ///
    /// # Errors
    /// What the grid or lattice refuses.
    pub fn family<T: Real>(&self) -> Result<Lattice<T, 3>> {
        let corner = [0.0, -0.5 * HEIGHT, -0.5 * self.width];
        let shape = Cuboid::new(corner, [self.length, 0.5 * HEIGHT, 0.5 * self.width])?;
        Lattice::new(&Grid::new(&shape, self.dx)?, Horizon::Cells(self.m), self.quadrature)
    }
    /// The upper and the lower arm: the first three columns of nodes.
    pub fn arms(&self, grid: &Grid<3>) -> [NodeSet; 2] {
        let inner = 3.0 * self.dx;
        [1.0, -1.0].map(|side| grid.select(move |x| x[0] < inner && side * x[1] > 0.0))
    }
    /// The notched body whose bonds are tested every so many steps. Bonds cut by the notch leave the
    /// families.
    ///
    /// # Errors
    /// What the body refuses.
    pub fn body<T: Real, M: StrainEnergy<T, 3>>(
        &self,
        family: Lattice<T, 3>,
        material: M,
        criterion: BondEnergy,
        every: usize,
    ) -> Result<Opened<T, M>> {
        let [up, down] = self.arms(family.grid());
        let edge = [-MM, 0.0, -self.width];
        let across = [0.0, 0.0, 2.0 * self.width];
        let notch = Polygon::parallelogram(edge, [CRACK + MM, 0.0, 0.0], across)?;
        let breaking = Breaking::new(criterion.sparing(&up.union(&down))).every(every)?;
        Body::new(family, material, breaking.precracked(notch).leaving_family())
    }
    /// Arms that move apart at this speed in m/s.
    pub fn pulled(&self, grid: &Grid<3>, speed: f64) -> Loads {
        let [up, down] = self.arms(grid);
        Loads::new().velocity(&up, 1, speed).velocity(&down, 1, -speed)
    }
    /// The nodes that are separated, by the damage of an open face on this lattice.
    pub fn cracks<T: Real>(
        body: &impl Dynamics<T, 3>,
        start: &[f64],
        separated: f64,
    ) -> CrackPath<3> {
        let gained = (0..body.nodes()).map(|i| (i, body.position(i), body.damage(i) - start[i]));
        CrackPath::above(separated, body.unit(), gained)
    }
    /// Goes on, with a look every 10 steps, until the crack has grown by `growth` or an arm has moved
    /// by 40 µm. `start` is the damage of the notched body, `separated` that of an open face.
    ///
    /// # Errors
    /// What the run refuses; [`Error::Other`] for a run without energies.
    pub fn open<T: Real, M: StrainEnergy<T, 3>>(
        &self,
        run: &mut Run<'_, T, 3, Opened<T, M>>,
        speed: f64,
        growth: f64,
        (start, separated): (&[f64], f64),
    ) -> Result<Vec<Look>> {
        let [up, down] = self.arms(run.body().family().grid());
        let (tip, ahead) = (SVector::from([CRACK, 0.0, 0.0]), SVector::from([1.0, 0.0, 0.0]));
        let mut looks: Vec<Look> = Vec::new();
        let grown = |looks: &[Look]| looks.last().map_or(0.0, |look| look.growth);
        while grown(&looks) < growth && speed * run.time() < 40e-6 {
            run.steps_more(10)?;
            let front = Self::cracks(run.body(), start, separated).tip(&tip, &ahead)[0];
            // A separated node at x stands for its cell up to x + Δx/2.
            let growth = if front > CRACK { front + 0.5 * self.dx - CRACK } else { 0.0 };
            looks.push(Look {
                u: speed * run.time(),
                growth,
                force: [reaction(run.body(), &up)[1], reaction(run.body(), &down)[1]],
                energies: run.energies().ok_or_else(|| Error::Other("no energies".into()))?,
            });
        }
        Ok(looks)
    }
    /// The same as a slope by least squares over the looks within a range of growth, which leaves out
    /// how a crack starts and averages over its jumps from node to node.
    pub fn energy_release_rate(looks: &[Look], growth: [f64; 2], width: f64) -> f64 {
        let inside = |look: &&Look| growth[0] <= look.growth && look.growth <= growth[1];
        let points = || looks.iter().filter(inside).map(|look| (look.growth, look.given()));
        let n = points().count() as f64;
        let (x, y) = points().fold((0.0, 0.0), |s, p| (s.0 + p.0 / n, s.1 + p.1 / n));
        let along: f64 = points().map(|p| (p.0 - x) * (p.1 - y)).sum();
        along / points().map(|p| (p.0 - x).powi(2)).sum::<f64>() / width
    }
    /// The damage of an open face that counts as separated.
    pub fn separated(plane: &CrackPlane<3>) -> f64 {
        0.85 * plane.face_damage()
    }
}
