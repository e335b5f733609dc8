//! Dynamic stress intensity of an edge crack in an anisotropic plate (Hattori §6.1), with finite
//! elements as the reference: graphite–epoxy, 0.1 × 0.1 m, crack from the left edge to the centre,
//! v_y = 250 y/s at the start, free edges; K from the opening at one distance behind the tip by the
//! Stroh matrices (Eq. 33).

use crate::dsif::opening;
use crate::fem::table;
use nalgebra::SVector;
use pd_core::crack::Segment;
use pd_core::region::Cuboid;
use pd_core::{
    Body, Flow, Grid, Horizon, Integrator, Lattice, Loads, Material, Precracked, Quadrature, Real,
    Result, Run, TimeStep, View,
};
use pd_models::elasticity::catalogue::GRAPHITE_EPOXY;
use pd_models::{Intensity, Stiffness, Stroh};

/// Edge of the plate in metres.
pub const EDGE: f64 = 0.1;
/// Length of the crack in metres.
pub const CRACK: f64 = 0.05;
/// End of the run in seconds.
pub const END: f64 = 100e-6;
/// Distances behind the tip at which K is read, in metres.
pub const BEHIND: [f64; 2] = [2e-3, 5e-3];
/// v_y = g y in 1/s.
const GRADIENT: f64 = 250.0;

/// The plate with its crack.
pub type Cracked<T, M> = Body<T, 2, Lattice<T, 2>, M, Precracked<2>>;

/// The plate and what finite elements say of it.
pub struct EdgeCrack {
    /// Of the ply, turned to the fibre's angle.
    pub stiffness: Stiffness<2>,
    stroh: Stroh,
    /// Times of the finite elements in seconds.
    pub times: Vec<f64>,
    /// Stress intensity of the finite elements by the same one-point formula, per distance.
    pub fem: [Vec<Intensity>; 2],
}

/// A history of stress intensity at the times of the finite elements, per distance.
pub struct History {
    /// Stress intensity.
    pub k: [Vec<Intensity>; 2],
    /// Steps taken.
    pub steps: usize,
    /// Time step in seconds.
    pub dt: f64,
}

impl EdgeCrack {
    /// Fibres at an angle; the finite elements are those of 30°, whatever it is.
    ///
    /// # Errors
    /// None for a finite angle.
    pub fn new(degrees: f64) -> Result<Self, pd_models::Error> {
        let stiffness = Stiffness::<2>::lamina(&GRAPHITE_EPOXY)?.rotated(degrees.to_radians());
        let stroh = Stroh::new(&stiffness, 0.0)?;
        let table = table("hattori61_30");
        let times: Vec<f64> = table["t"].iter().copied().filter(|&t| t <= END * 1.0001).collect();
        let fem = [("r2mm", 0), ("r5mm", 1)].map(|(name, r)| {
            let columns = ["dux", "duy"].map(|u| &table[&format!("{u}_{name}")]);
            let at = |i: usize| SVector::from(columns.map(|column| column[i]));
            (0..times.len()).map(|i| stroh.intensity(BEHIND[r], &at(i))).collect()
        });
        Ok(Self { stiffness, stroh, times, fem })
    }

    /// The body at the start, of `cells` × `cells` nodes.
    ///
    /// # Errors
    /// What the body refuses.
    pub fn body<T: Real, M: Material<T, 2>>(
        &self,
        cells: usize,
        (m, quadrature): (f64, Quadrature),
        material: M,
    ) -> Result<Cracked<T, M>> {
        let dx = EDGE / cells as f64;
        let shape = Cuboid::new([0.0, -0.5 * EDGE], [EDGE, 0.5 * EDGE])?;
        let grid = Grid::new(&shape, dx)?;
        let family = Lattice::<T, 2>::new(&grid, Horizon::Cells(m), quadrature)?;
        let crack = Segment::new([-dx, 0.0], [CRACK, 0.0])?;
        let mut body = Body::new(family, material, Precracked::by(crack))?;
        body.set_velocity(|x| [0.0, GRADIENT * x[1]].into());
        Ok(body)
    }

    /// Runs the body to [`END`] and reads K.
    ///
    /// # Errors
    /// What the run refuses.
    pub fn history<T: Real, M: Material<T, 2>>(
        &self,
        body: &mut Cracked<T, M>,
        rule: TimeStep,
        integrator: impl Integrator<T, 2>,
    ) -> Result<History> {
        let mut samples: Vec<(f64, [SVector<f64, 2>; 2])> = Vec::new();
        let mut run = Run::with_integrator(body, Loads::new(), rule, integrator)?;
        run.observe(1, |view: &View<'_, Cracked<T, M>>| {
            samples.push((view.time, BEHIND.map(|r| behind(view.body, r))));
            Ok(Flow::Continue)
        });
        run.until(END)?;
        let (steps, dt) = (run.steps(), run.dt());
        drop(run);
        let k = [0, 1].map(|r| {
            let at = |t: f64| {
                let next = samples.partition_point(|s| s.0 < t).clamp(1, samples.len() - 1);
                let ((t0, u0), (t1, u1)) = (&samples[next - 1], &samples[next]);
                let part = ((t - t0) / (t1 - t0)).clamp(0.0, 1.0);
                self.stroh.intensity(BEHIND[r], &(u0[r] * (1.0 - part) + u1[r] * part))
            };
            self.times.iter().map(|&t| at(t)).collect()
        });
        Ok(History { k, steps, dt })
    }
}

/// Opening at the distance `r` in metres behind the tip.
fn behind<T: Real, M: Material<T, 2>>(body: &Cracked<T, M>, r: f64) -> SVector<f64, 2> {
    opening(body.family().grid(), |node| body.displacement(node), CRACK - r)
}
