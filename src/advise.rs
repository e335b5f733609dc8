//! Before a run: which spacing, horizon, precision and calibration meet a target error at the least
//! time, and what the run will take.
//!
//! The error is that of the phase speed of the shortest wave that matters, in the worst direction: the
//! [`Symbol`] gives ω of the lattice exactly, velocity Verlet turns it into ω' with
//! sin(ω'Δt/2) = ωΔt/2, and the classical speed c is Christoffel's, so that it is |ω'/(c|k|) − 1|,
//! largest over directions and polarisations. For a static feature take its size as the wavelength.
//! A wave that travels N wavelengths is off by 2πN times that error in phase.
//!
//! The cost is timed on this machine, with the threads at hand, on a small body of the same material,
//! horizon and precision; its critical time step (free surfaces and all) sets the number of steps,
//! and the sizes of its arrays the memory.
//!
//! ```no_run
//! use peridynamics::advise::Advisor;
//! use peridynamics::models::elasticity::catalogue::GLASS_EPOXY;
//! use peridynamics::prelude::*;
//! # fn main() -> std::result::Result<(), Box<dyn std::error::Error>> {
//! let (ply, density) = (Stiffness::<2>::lamina(&GLASS_EPOXY)?, 1800.0);
//! let omega = InfluenceFunction::Gaussian;
//! let plate = Cuboid::centred([0.05, 0.03])?;
//! let split = Ordinary::linearised(PositiveSplit::plane(&ply, density, omega)?);
//! let wan = Correspondence::new(LinearElastic(ply), density, omega)?
//!     .with_control(WanControl::new(&ply, 1.0)?);
//! let mut advisor = Advisor::new(&plate, (&ply, density), 10e-3, 10e-6, 0.05)?;
//! advisor.consider("positive split", &split)?;
//! advisor.consider("correspondence with Wan's control", &wan)?;
//! let advice = advisor.advise()?;
//! println!("{advice}");
//! let grid = Grid::new(&plate, advice.spacing)?;
//! let family = Lattice::<f64, 2>::new(&grid, Horizon::Cells(advice.m), advice.quadrature)?;
//! # let _ = family;
//! # Ok(())
//! # }
//! ```

use nalgebra::SVector;
use pd_core::body::Memory;
use pd_core::region::Shape;
use pd_core::symbol::Stability;
use pd_core::time_step::spectrum;
use pd_core::{
    Body, Family, Grid, Horizon, Lattice, Loads, Material, NoDamage, Quadrature, Real, Run, Symbol,
    TimeStep,
};
use pd_models::Stiffness;
use std::f64::consts::{PI, TAU};
use std::fmt;
use std::time::Instant;

/// Share of the body's critical time step.
pub const SAFETY: f64 = 0.8;
/// Horizons δ/Δx that are tried.
const HORIZONS: [f64; 4] = [2.0, 3.0, 4.0, 5.0];
/// Spacings per wavelength that are tried: from the fewest on, each finer by the factor.
const CELLS: (f64, f64, f64) = (4.0, 1.03, 400.0);
/// Rounding may grow with the steps to this share of the target error.
const ROUNDING: f64 = 0.1;
/// How a body is timed: its nodes at most, steps at once, and how often.
#[derive(Clone, Copy)]
struct Timing {
    nodes: f64,
    steps: usize,
    times: usize,
}
/// To rank candidates.
const RANKED: Timing = Timing { nodes: 1e4, steps: 5, times: 2 };
/// The best one is timed in bodies of this many bytes, which caches do not hold, but for no more than
/// so many seconds (choosing the time step takes up to 160 evaluations), with the guard that a run
/// has every 20 steps.
const BEST: (f64, f64, Timing) = (5e7, 4.0, Timing { nodes: 1e4, steps: 20, times: 5 });

/// Result of this module.
pub type Result<X, E = Error> = std::result::Result<X, E>;

/// Error of an advisor.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// No candidate meets the target.
    #[error(
        "no choice has a speed error of {target} at a wavelength of {wavelength:e} m: {}. Ask for a \
         larger error, or consider another calibration or influence function",
        reasons.join("; ")
    )]
    NoChoice {
        /// The error asked for.
        target: f64,
        /// The wavelength in metres.
        wavelength: f64,
        /// Why each candidate fails.
        reasons: Vec<String>,
    },
    /// No material was [considered](Advisor::consider).
    #[error("no material to choose from: consider at least one")]
    NothingConsidered,
    /// A number is not admissible, or a body or run refuses.
    #[error(transparent)]
    Core(#[from] pd_core::Error),
    /// The stiffness or density has no waves.
    #[error(transparent)]
    Model(#[from] pd_models::Error),
}

/// Kind of floating-point numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Precision {
    /// `f32`.
    Single,
    /// `f64`.
    Double,
}

impl fmt::Display for Precision {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(if *self == Self::Single { "f32" } else { "f64" })
    }
}

/// What to run, and what it will take.
#[derive(Debug, Clone, PartialEq)]
pub struct Advice<const D: usize> {
    /// Name of the material considered.
    pub material: String,
    /// Δx in metres.
    pub spacing: f64,
    /// δ/Δx.
    pub m: f64,
    /// Weights β.
    pub quadrature: Quadrature,
    /// Kind of numbers.
    pub precision: Precision,
    /// Δt in seconds that [`TimeStep::Safety`]\([`SAFETY`]) is expected to give.
    pub time_step: f64,
    /// Error of the phase speed.
    pub error: f64,
    /// Direction in which it is largest.
    pub direction: SVector<f64, D>,
    /// The wave in which it is largest, from 0 for the fastest.
    pub branch: usize,
    /// Nodes.
    pub nodes: usize,
    /// Time steps.
    pub steps: usize,
    /// Bytes of the body.
    pub bytes: usize,
    /// Wall time in seconds: making the body, choosing its time step, and the steps.
    pub seconds: f64,
    /// What else was looked at, best first, one line each.
    pub others: Vec<String>,
}

impl<const D: usize> fmt::Display for Advice<D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { material, spacing, m, precision, time_step, nodes, steps, .. } = self;
        writeln!(f, "{material}, Δx = {:.3} mm, m = {m}, {precision}", spacing * 1e3)?;
        writeln!(
            f,
            "  error of the wave's speed {:.2} %, largest along {:.2?}",
            100.0 * self.error,
            self.direction.as_slice()
        )?;
        writeln!(
            f,
            "  {nodes} nodes, {:.1} MB; {steps} steps of {time_step:.2e} s (safety {SAFETY}); {}",
            self.bytes as f64 * 1e-6,
            duration(self.seconds)
        )?;
        self.others.iter().try_for_each(|other| writeln!(f, "  instead: {other}"))
    }
}

/// Seconds, minutes or hours.
fn duration(seconds: f64) -> String {
    match seconds {
        s if s < 120.0 => format!("{s:.1} s"),
        s if s < 7200.0 => format!("{:.0} min", s / 60.0),
        s => format!("{:.1} h", s / 3600.0),
    }
}

/// What a small body tells of a large one.
#[derive(Clone, Copy)]
struct Sample {
    nodes: usize,
    sites: usize,
    memory: Memory,
    /// Δt over Δx in s/m.
    step_per_spacing: f64,
    /// Seconds to make the body and choose its step, and of a step, per node.
    set_up: f64,
    step: f64,
}

type Timer<'a, const D: usize> =
    Box<dyn Fn(&Grid<D>, f64, Precision, Timing) -> Result<Sample> + 'a>;

/// A material at a horizon, as fine as the target asks for.
#[derive(Clone)]
struct Candidate<const D: usize> {
    material: usize,
    m: f64,
    spacing: f64,
    precision: Precision,
    error: f64,
    direction: SVector<f64, D>,
    branch: usize,
}

/// Looks for the cheapest discretisation that meets a target error.
pub struct Advisor<'a, const D: usize> {
    shape: &'a dyn Shape<D>,
    stiffness: Stiffness<D>,
    density: f64,
    wavelength: f64,
    duration: f64,
    error: f64,
    quadrature: Quadrature,
    materials: Vec<(String, Timer<'a, D>)>,
    candidates: Vec<Candidate<D>>,
    refused: Vec<String>,
}

impl<'a, const D: usize> Advisor<'a, D> {
    /// For a body of this shape, stiffness and density (kg/m³), the shortest wavelength (m) that
    /// matters, a duration (s) and the largest error of that wave's speed (0.01 for 1 %). Cells that
    /// the horizon cuts count by their exact fraction.
    ///
    /// # Errors
    /// A number that is not positive, an error above a half.
    pub fn new(
        shape: &'a dyn Shape<D>,
        (stiffness, density): (&Stiffness<D>, f64),
        wavelength: f64,
        duration: f64,
        error: f64,
    ) -> Result<Self> {
        use pd_core::Error as Core;
        Core::positive("density ρ [kg/m³]", density)?;
        Core::positive("shortest wavelength [m]", wavelength)?;
        Core::positive("duration [s]", duration)?;
        Core::positive("target error", error)?;
        Core::check(error <= 0.5, "target error", error, "at most 0.5")?;
        Ok(Self {
            shape,
            stiffness: *stiffness,
            density,
            wavelength,
            duration,
            error,
            quadrature: Quadrature::Exact,
            materials: Vec::new(),
            candidates: Vec::new(),
            refused: Vec::new(),
        })
    }

    /// Takes a material (a calibration, a model) into consideration, at several horizons. It must have
    /// no length of its own: all of this crate's are so.
    ///
    /// # Errors
    /// What the symbol refuses ([`pd_core::Error::ForceConstants`]). A material that amplifies a wave
    /// at some horizon is no error, only no choice there.
    pub fn consider<M>(&mut self, name: &str, material: &'a M) -> Result<()>
    where
        M: Material<f64, D> + Material<f32, D>,
    {
        let index = self.materials.len();
        let quadrature = self.quadrature;
        let timer = move |grid: &Grid<D>, m, precision, timing| match precision {
            Precision::Single => sample::<f32, D, M>(material, grid, (m, quadrature), timing),
            Precision::Double => sample::<f64, D, M>(material, grid, (m, quadrature), timing),
        };
        self.materials.push((name.to_owned(), Box::new(timer)));
        for m in HORIZONS {
            // A lattice of spacing 1 m: only k Δx counts.
            let symbol = Symbol::of(material, 1.0, Horizon::Cells(m), self.quadrature)?;
            let extremes = symbol.extremes(if D == 3 { 16 } else { 60 });
            if matches!(extremes.stability(), Stability::Unstable(_)) {
                self.refused.push(format!("{name}, m = {m}: amplifies a wave"));
                continue;
            }
            // Free surfaces lower the critical step of a body below that of the lattice.
            let dt = SAFETY * self.critical_time_step(material, m)?;
            match self.coarsest(&symbol, dt)? {
                Ok((cells, (error, direction, branch))) => {
                    let spacing = self.wavelength / cells;
                    let steps = self.duration / (dt * spacing);
                    let single = f64::from(f32::EPSILON) * steps <= ROUNDING * self.error;
                    let precision = if single { Precision::Single } else { Precision::Double };
                    let material = index;
                    let found =
                        Candidate { material, m, spacing, precision, error, direction, branch };
                    self.candidates.push(found);
                }
                Err(best) => self.refused.push(format!(
                    "{name}, m = {m}: {:.2} % is the least at {} spacings per wavelength",
                    100.0 * best,
                    CELLS.2
                )),
            }
        }
        Ok(())
    }

    /// The critical time step in seconds of a small body of spacing 1 m.
    fn critical_time_step<M: Material<f64, D>>(&self, material: &M, m: f64) -> Result<f64> {
        let edge = (4.0 * m) as usize;
        let grid = Grid::lattice(SVector::zeros(), SVector::repeat(1.0), [edge; D])?;
        let family = Lattice::<f64, D>::new(&grid, Horizon::Cells(m), self.quadrature)?;
        let mut body = Body::new(family, material, NoDamage)?;
        Ok(spectrum(&mut body)?.critical_time_step())
    }

    /// The fewest spacings per wavelength from which on the error stays below the target, with that
    /// error and where it is largest; or else the error of the finest.
    #[allow(clippy::type_complexity)]
    fn coarsest(
        &self,
        symbol: &Symbol<D>,
        dt: f64,
    ) -> Result<std::result::Result<(f64, (f64, SVector<f64, D>, usize)), f64>> {
        let (fewest, finer, most) = CELLS;
        let count = ((most / fewest).ln() / finer.ln()).ceil() as i32;
        let mut found = Err(f64::INFINITY);
        // From fine to coarse: errors of space and time can cancel at a coarse spacing by chance.
        for i in (0..=count).rev() {
            let cells = fewest * finer.powi(i);
            let worst = self.speed_error(symbol, cells, dt)?;
            if worst.0 > self.error {
                return Ok(if found.is_err() { Err(worst.0) } else { found });
            }
            found = Ok((cells, worst));
        }
        Ok(found)
    }

    /// Largest |ω'/(c|k|) − 1| with `cells` spacings of 1 m per wavelength; direction and branch.
    fn speed_error(
        &self,
        symbol: &Symbol<D>,
        cells: f64,
        dt: f64,
    ) -> Result<(f64, SVector<f64, D>, usize)> {
        let k = TAU / cells;
        let mut worst = (0.0, SVector::zeros(), 0);
        for direction in directions::<D>() {
            let waves = self.stiffness.waves(&direction, self.density)?;
            // The symbol's waves come slowest first, the classical ones fastest first.
            for (branch, mode) in symbol.eigen(&(direction * k)).iter().rev().enumerate() {
                let turn = 2.0 * (0.5 * mode.frequency() * dt).min(1.0).asin();
                let error = (turn / (dt * k * waves[branch].speed) - 1.0).abs();
                let error = if error.is_nan() { 1.0 } else { error };
                if error > worst.0 {
                    worst = (error, direction, branch);
                }
            }
        }
        Ok(worst)
    }

    /// The cheapest choice in wall time.
    ///
    /// # Errors
    /// [`Error::NothingConsidered`], [`Error::NoChoice`], what the bodies refuse that are timed.
    pub fn advise(&self) -> Result<Advice<D>> {
        if self.materials.is_empty() {
            return Err(Error::NothingConsidered);
        }
        let mut ranked = Vec::new();
        let mut reasons = self.refused.clone();
        for candidate in &self.candidates {
            match self.predict(candidate, RANKED) {
                Ok(advice) => ranked.push((candidate, advice)),
                Err(Error::Core(error)) => {
                    let (name, why) = (&self.materials[candidate.material].0, error.to_string());
                    let why = why.split(": ").next().unwrap_or_default();
                    reasons.push(format!("{name}, m = {}: {why}", candidate.m));
                }
                Err(other) => return Err(other),
            }
        }
        ranked.sort_by(|a, b| a.1.seconds.total_cmp(&b.1.seconds));
        let Some((best, first)) = ranked.first() else {
            let (target, wavelength) = (self.error, self.wavelength);
            return Err(Error::NoChoice { target, wavelength, reasons });
        };
        let (bytes, seconds, timing) = BEST;
        let per_node = first.bytes as f64 / first.nodes as f64;
        let per_step = first.seconds / (first.nodes * (160 + first.steps)) as f64;
        let evaluations = (160 + timing.steps * timing.times) as f64;
        let nodes = (bytes / per_node).min(seconds / (evaluations * per_step)).max(timing.nodes);
        let mut advice = self.predict(best, Timing { nodes, ..timing })?;
        let line = |a: &Advice<D>| {
            format!(
                "{}, Δx = {:.3} mm, m = {}, {}: {:.1} MB, {}",
                a.material,
                a.spacing * 1e3,
                a.m,
                a.precision,
                a.bytes as f64 * 1e-6,
                duration(a.seconds)
            )
        };
        advice.others = ranked[1..].iter().map(|(_, other)| line(other)).chain(reasons).collect();
        Ok(advice)
    }

    fn predict(&self, candidate: &Candidate<D>, timing: Timing) -> Result<Advice<D>> {
        let Candidate { material, m, spacing, precision, error, direction, branch } = *candidate;
        let grid = Grid::new(self.shape, spacing)?;
        let (name, timer) = &self.materials[material];
        // A box with the edges of the body, the longest cut down to as many nodes as are timed.
        let mut cells = grid.cells();
        while cells.iter().product::<usize>() as f64 > timing.nodes {
            let longest = (0..D).max_by_key(|&d| cells[d]).unwrap_or(0);
            cells[longest] = cells[longest] * 9 / 10;
        }
        let small = Grid::lattice(SVector::zeros(), SVector::repeat(spacing), cells)?;
        let sample = timer(&small, m, precision, timing)?;
        let time_step = sample.step_per_spacing * spacing;
        let steps = (self.duration / time_step * (1.0 - 1e-12)).ceil();
        let nodes = grid.len();
        let seconds = nodes as f64 * (sample.set_up + steps * sample.step);
        let sites = match precision {
            Precision::Single => Lattice::<f32, D>::sites_of(grid.cells(), m, self.quadrature),
            Precision::Double => Lattice::<f64, D>::sites_of(grid.cells(), m, self.quadrature),
        };
        Ok(Advice {
            material: name.clone(),
            spacing,
            m,
            quadrature: self.quadrature,
            precision,
            time_step,
            error,
            direction,
            branch,
            nodes,
            steps: steps as usize,
            bytes: sample.bytes(nodes, sites, grid.bytes()),
            seconds,
            others: Vec::new(),
        })
    }
}

impl Sample {
    /// Bytes of a body of so many nodes and sites: node arrays grow with the sites, the family holds
    /// four bytes per node and two per eight sites beside its table of offsets and its grid.
    fn bytes(&self, nodes: usize, sites: usize, grid: usize) -> usize {
        let Memory { family, bond_constants, bond_bits, .. } = self.memory;
        let arrays = self.memory.total() - family - bond_constants - bond_bits;
        let offsets = family.saturating_sub(4 * self.nodes + self.sites / 4);
        let per_site = arrays as f64 / self.sites as f64;
        offsets + bond_constants + grid + 4 * nodes + sites / 4 + (per_site * sites as f64) as usize
    }
}

/// Makes and times a body.
fn sample<T: Real, const D: usize, M: Material<T, D>>(
    material: &M,
    grid: &Grid<D>,
    (m, quadrature): (f64, Quadrature),
    timing: Timing,
) -> Result<Sample> {
    let start = Instant::now();
    let family = Lattice::<T, D>::new(grid, Horizon::Cells(m), quadrature)?;
    let mut body = Body::new(family, material, NoDamage)?;
    let (nodes, sites, memory) = (body.nodes(), body.family().sites(), body.memory());
    let spacing = grid.spacing()[0];
    body.set_displacement(|x| SVector::from_fn(|d, _| 1e-6 * (x[d] / spacing).sin() * spacing));
    let mut run = Run::new(&mut body, Loads::new(), TimeStep::Safety(SAFETY))?;
    let set_up = start.elapsed().as_secs_f64() / nodes as f64;
    let step_per_spacing = run.dt() / spacing;
    // The first time warms up. Of the others the median: what else the machine does now, it will
    // do during the run too.
    let mut times = Vec::new();
    for _ in 0..timing.times {
        let start = Instant::now();
        run.steps_more(timing.steps)?;
        times.push(start.elapsed().as_secs_f64());
    }
    times[1..].sort_by(f64::total_cmp);
    let step = times[1 + (timing.times - 1) / 2] / (timing.steps * nodes) as f64;
    Ok(Sample { nodes, sites, memory, step_per_spacing, set_up, step })
}

/// Directions of half the circle or sphere, some degrees apart.
fn directions<const D: usize>() -> Vec<SVector<f64, D>> {
    const TURNS: usize = 24;
    let axis = |angle: f64| angle.sin_cos();
    if D == 2 {
        let at = |i: usize| axis(PI * i as f64 / TURNS as f64);
        return (0..TURNS).map(at).map(|(s, c)| SVector::from_fn(|d, _| [c, s][d])).collect();
    }
    let mut found = Vec::new();
    for i in 0..=TURNS / 4 {
        let (height, ring) = axis(0.5 * PI * i as f64 / (TURNS / 4) as f64);
        let around = if ring < 1e-9 { 1 } else { TURNS };
        for j in 0..around {
            let (s, c) = axis(TAU * j as f64 / TURNS as f64);
            found.push(SVector::from_fn(|d, _| [ring * c, ring * s, height][d]));
        }
    }
    found
}
