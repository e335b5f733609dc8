//! The exact lattice symbol of a material: dispersion, stability and ω_max of the infinite body.
//!
//! A bulk lattice turns a plane wave p exp(i(k·x − ωt)) into one: ω² and p are eigenvalue and
//! eigenvector of the dynamical matrix D(k) = (1/ρ) Σ_x K(x) cos(k·x), with the force constants
//! K_ab(x) = −∂f_a(x)/∂u_b(0). They are found by displacing one node of a patch, so any material
//! has a symbol, one of your own too. A negative ω² is a plane wave that grows exponentially in a
//! dynamic run and makes the static operator indefinite.

use crate::body::{Body, Dynamics};
use crate::damage::NoDamage;
use crate::family::{Family, Horizon};
use crate::grid::Grid;
use crate::lattice::Lattice;
use crate::material::Material;
use crate::parallel::map_pieces;
use crate::quadrature::Quadrature;
use crate::{Error, Result};
use nalgebra::{Matrix3, SMatrix, SVector};
use std::f64::consts::PI;
use std::fmt;
use std::ops::Range;

/// Probing displacement in units of Δx: the central difference errs by its square, a material
/// that adds u to numbers of order one by rounding over it.
const AMPLITUDE: f64 = 1e-6;
/// Violation of the rules of [`Symbol::of`] accepted, relative to the largest force constant.
const TOLERANCE: f64 = 1e-7;
/// Local minima of the samples that are searched further, lowest first.
const STARTS: usize = 16;
/// Longest pattern search.
const MOVES: usize = 200;
/// An eigenvalue within this fraction of the largest one is zero.
const ZERO: f64 = 1e-9;

/// The lattice symbol of a material.
#[derive(Debug, Clone)]
pub struct Symbol<const D: usize> {
    /// x in metres and −4 K(x) in Pa/m² of one of each pair ±x, so that
    /// ρ D(k) = Σ −4 K(x) sin²(k·x/2): free of cancellation for long waves.
    constants: Vec<(SVector<f64, D>, SMatrix<f64, D, D>)>,
    spacing: SVector<f64, D>,
    density: f64,
    uneven: f64,
}

/// A plane wave that the lattice carries.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mode<const D: usize> {
    /// Wave vector k in 1/m.
    pub wave: SVector<f64, D>,
    /// ω² in 1/s²; negative for a wave that grows.
    pub eigenvalue: f64,
    /// Unit polarisation p.
    pub polarisation: SVector<f64, D>,
}

impl<const D: usize> Mode<D> {
    /// Angular frequency ω in rad/s; NaN for a wave that grows.
    pub fn frequency(&self) -> f64 {
        self.eigenvalue.sqrt()
    }
    /// Rate √(−ω²) in 1/s at which the wave grows; 0 for one that does not.
    pub fn growth_rate(&self) -> f64 {
        (-self.eigenvalue).max(0.0).sqrt()
    }
}

/// Softest and stiffest wave of the Brillouin zone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Extremes<const D: usize> {
    /// The wave of the smallest ω².
    pub softest: Mode<D>,
    /// The wave of the largest ω².
    pub stiffest: Mode<D>,
}

impl<const D: usize> Extremes<D> {
    /// Critical time step 2/ω_max of the explicit schemes in seconds, for the bulk: free surfaces
    /// and cracks lower it (see [`time_step`](crate::time_step)).
    pub fn critical_time_step(&self) -> f64 {
        2.0 / self.stiffest.frequency()
    }
    /// Whether every wave keeps its amplitude; ω² within 10⁻⁹ of the largest one counts as zero.
    pub fn stability(&self) -> Stability<D> {
        let zero = ZERO * self.stiffest.eigenvalue.abs();
        match self.softest {
            softest if softest.eigenvalue < -zero => Stability::Unstable(softest),
            softest if softest.eigenvalue <= zero => Stability::ZeroEnergy(softest),
            softest => Stability::Stable(softest),
        }
    }
}

/// What becomes of the plane waves of a material on its lattice.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Stability<const D: usize> {
    /// Every wave keeps its amplitude; the softest one.
    Stable(Mode<D>),
    /// A short wave costs no energy: correspondence materials without control.
    ZeroEnergy(Mode<D>),
    /// A wave grows exponentially; the one that grows fastest.
    Unstable(Mode<D>),
}

impl<const D: usize> fmt::Display for Stability<D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (Self::Stable(mode) | Self::ZeroEnergy(mode) | Self::Unstable(mode)) = self;
        let (wave, value) = (mode.wave.as_slice(), mode.eigenvalue);
        match self {
            Self::Stable(_) => {
                write!(f, "stable: the softest wave k = {wave:?} 1/m has ω² = {value:e} 1/s²")
            }
            Self::ZeroEnergy(_) => {
                write!(f, "zero-energy mode: the wave k = {wave:?} 1/m costs no energy")
            }
            Self::Unstable(_) => write!(
                f,
                "unstable: this material amplifies the plane wave k = {wave:?} 1/m with growth \
                 rate {:e} 1/s (ω² = {value:e} 1/s²)",
                mode.growth_rate()
            ),
        }
    }
}

impl<const D: usize> Symbol<D> {
    /// The symbol of a material on a square or cubic lattice with Δx = `spacing` in metres.
    ///
    /// The material is probed about its reference configuration in small displacements; it must
    /// be the same at every node (of [`Regions`] of materials take one by one).
    ///
    /// [`Regions`]: crate::grid::Grid::regions
    ///
    /// # Errors
    /// What [`Lattice::new`], [`Body::new`] and the material refuse, and [`Error::ForceConstants`]
    /// for forces that do not balance (Σ K(x) = 0) or do not derive from an energy that is alike at
    /// all nodes and for ±ξ (K(x) = K(−x) = K(x)ᵀ).
    pub fn of<M: Material<f64, D>>(
        material: &M,
        spacing: f64,
        horizon: Horizon,
        quadrature: Quadrature,
    ) -> Result<Self> {
        Self::with_spacing(material, [spacing; D], horizon, quadrature)
    }

    /// As [`of`](Self::of), with the spacing along each axis.
    ///
    /// # Errors
    /// As [`of`](Self::of).
    pub fn with_spacing<M: Material<f64, D>>(
        material: &M,
        spacing: [f64; D],
        horizon: Horizon,
        quadrature: Quadrature,
    ) -> Result<Self> {
        let spacing = SVector::from(spacing);
        let unit = Error::positive("spacing Δx [m]", spacing[0])?;
        let reach = quadrature.reach(&(spacing / unit), horizon.in_units(unit)?) * unit;
        // Forces reach twice as far as bonds, and the nodes on the way need whole families.
        let far: [usize; D] =
            std::array::from_fn(|d| (2.0 * (reach / spacing[d] * (1.0 + 1e-9)).floor()) as usize);
        let cells = far.map(|n| n.saturating_mul(2).saturating_add(1));
        let grid = Grid::lattice(
            -spacing.component_mul(&SVector::from(far.map(|n| n as f64))),
            spacing,
            cells,
        )?;
        let lattice = Lattice::new(&grid, horizon, quadrature)?;
        let mut body = Body::new(lattice, material, NoDamage)?;
        // Lexicographic order: x and −x are as far from the two ends.
        let centre = grid.len() / 2;
        let k = probe(&mut body, centre)?;
        let uneven = check(&k)?;

        let to_si = -4.0 / (unit * unit);
        let constants = (centre + 1..grid.len())
            .map(|node| {
                let mean = k[node]
                    + k[node].transpose()
                    + k[2 * centre - node]
                    + k[2 * centre - node].transpose();
                (grid.position(node), mean * (0.25 * to_si))
            })
            .filter(|(_, k)| k.amax() > 0.0)
            .collect();
        Ok(Self { constants, spacing, density: material.density(centre), uneven })
    }

    /// ρ D(k) in Pa/m² for a wave vector k in 1/m.
    pub fn stiffness(&self, wave: &SVector<f64, D>) -> SMatrix<f64, D, D> {
        self.constants.iter().fold(SMatrix::zeros(), |sum, (x, k)| {
            let s = (0.5 * wave.dot(x)).sin();
            sum + k * (s * s)
        })
    }

    /// The dynamical matrix D(k) in 1/s² for a wave vector k in 1/m.
    pub fn matrix(&self, wave: &SVector<f64, D>) -> SMatrix<f64, D, D> {
        self.stiffness(wave) / self.density
    }

    /// The D waves of wave vector k in 1/m, smallest ω² first. NaN for a k that is not finite.
    pub fn eigen(&self, wave: &SVector<f64, D>) -> [Mode<D>; D] {
        let matrix = self.matrix(wave);
        let norm = matrix.norm();
        // The iteration does not end on NaN, and a wave without stiffness needs none.
        if norm.is_nan() || norm == 0.0 || norm.is_infinite() {
            return std::array::from_fn(|a| Mode {
                wave: *wave,
                eigenvalue: norm,
                polarisation: SVector::from_fn(|d, _| if d == a { 1.0 } else { 0.0 }),
            });
        }
        // One fixed size serves every dimension: unused axes get the largest eigenvalues.
        let embedded = Matrix3::from_fn(|i, j| match (i < D && j < D, i == j) {
            (true, _) => matrix[(i, j)] / norm,
            (false, true) => 2.0,
            (false, false) => 0.0,
        });
        let eigen = embedded.symmetric_eigen();
        let mut order = [0, 1, 2];
        order.sort_by(|&a, &b| eigen.eigenvalues[a].total_cmp(&eigen.eigenvalues[b]));
        std::array::from_fn(|a| Mode {
            wave: *wave,
            eigenvalue: eigen.eigenvalues[order[a]] * norm,
            polarisation: SVector::from_fn(|d, _| eigen.eigenvectors[(d, order[a])]),
        })
    }

    /// Phase speeds ω/|k| in m/s of the waves along `direction` with wave number |k| in 1/m,
    /// slowest first; NaN for a wave that grows. They tend to the speeds of the classical
    /// continuum for |k| → 0.
    ///
    /// # Errors
    /// [`Error::InvalidValue`] for a direction of no length or a wave number that is not positive.
    pub fn phase_speeds(&self, direction: &SVector<f64, D>, wave_number: f64) -> Result<[f64; D]> {
        let wave_number = Error::positive("wave number |k| [1/m]", wave_number)?;
        let wave = unit_vector(direction)? * wave_number;
        Ok(self.eigen(&wave).map(|mode| mode.frequency() / wave_number))
    }

    /// Dispersion along `direction`: (|k| in 1/m, ω in rad/s, lowest first) at `n` wave numbers up
    /// to the boundary of the Brillouin zone; NaN for a wave that grows.
    ///
    /// # Errors
    /// [`Error::InvalidValue`] for a direction of no length.
    pub fn dispersion(
        &self,
        direction: &SVector<f64, D>,
        n: usize,
    ) -> Result<Vec<(f64, [f64; D])>> {
        let direction = unit_vector(direction)?;
        let boundary = PI / direction.component_mul(&self.spacing).amax();
        let at = |i: usize| {
            let wave_number = boundary * i as f64 / n as f64;
            (wave_number, self.eigen(&(direction * wave_number)).map(|mode| mode.frequency()))
        };
        Ok((1..=n).map(at).collect())
    }

    /// Softest and stiffest wave of the Brillouin zone: `samples` wave vectors per axis (made
    /// even, so that zone faces and corners are among them), and a pattern search from the best
    /// samples that are softer (stiffer) than those beside them.
    ///
    /// Near k = 0 every ω² goes to 0 like |k|², so the softest wave is sought outside the ball
    /// |k|Δx < 2π/`samples`: in a material without weak short waves it is the longest one there.
    pub fn extremes(&self, samples: usize) -> Extremes<D> {
        let zone = Zone { samples: samples.max(4).next_multiple_of(2) };
        let total = zone.samples.pow(D as u32);
        // D(−k) = D(k): half of the zone is enough.
        let ends = |i: usize| {
            (i <= zone.mirror::<D>(i)).then(|| {
                let modes = self.eigen(&self.wave(&zone.phases(i)));
                [modes[0].eigenvalue, -modes[D - 1].eigenvalue]
            })
        };
        let row = |piece: Range<usize>| piece.map(ends).collect::<Vec<Option<[f64; 2]>>>();
        let half: Vec<_> = map_pieces(total, zone.samples, &row).flatten().collect();
        let value = |i: usize, end: usize| {
            half[i].or(half[zone.mirror::<D>(i)]).map_or(f64::INFINITY, |values| values[end])
        };
        let [softest, stiffest] = [0, 1].map(|end| {
            let objective = |phases: &SVector<f64, D>| {
                if end == 0 && zone.is_long(phases) {
                    return f64::INFINITY;
                }
                let modes = self.eigen(&self.wave(phases));
                if end == 0 { modes[0].eigenvalue } else { -modes[D - 1].eigenvalue }
            };
            let sampled = |i: usize| {
                if end == 0 && i == 0 { f64::INFINITY } else { value(i, end) }
            };
            let mut starts: Vec<usize> = (0..total)
                .filter(|&i| half[i].is_some() && sampled(i).is_finite())
                .filter(|&i| zone.beside::<D>(i).all(|j| sampled(i) <= sampled(j)))
                .collect();
            starts.sort_by(|&a, &b| sampled(a).total_cmp(&sampled(b)));
            starts.truncate(STARTS);
            let down = |i: usize| descend(&objective, zone.phases(starts[i]), zone.step());
            let (_, phases) = map_pieces(starts.len(), 1, &|piece| down(piece.start))
                .min_by(|a, b| a.0.total_cmp(&b.0))
                .unwrap_or((0.0, SVector::zeros()));
            self.eigen(&self.wave(&phases.map(fold)))[if end == 0 { 0 } else { D - 1 }]
        });
        Extremes { softest, stiffest }
    }

    /// The wave vector in 1/m of a phase per cell.
    fn wave(&self, phases: &SVector<f64, D>) -> SVector<f64, D> {
        phases.component_div(&self.spacing)
    }

    /// [`extremes`](Self::extremes) with 120 samples per axis in 2D and 24 in 3D.
    fn default_extremes(&self) -> Extremes<D> {
        self.extremes(if D == 3 { 24 } else { 120 })
    }

    /// ω_max in rad/s: the stiffest wave of [`extremes`](Self::extremes) with 120 samples per axis
    /// in 2D and 24 in 3D.
    pub fn max_frequency(&self) -> f64 {
        self.default_extremes().stiffest.frequency()
    }

    /// Critical time step 2/ω_max in seconds ([`Extremes::critical_time_step`]), sampled as
    /// [`max_frequency`](Self::max_frequency).
    pub fn critical_time_step(&self) -> f64 {
        self.default_extremes().critical_time_step()
    }

    /// Mass density ρ in kg/m³.
    pub fn density(&self) -> f64 {
        self.density
    }

    /// How far the force constants are from K(x) = K(−x) = K(x)ᵀ, relative to the largest one.
    pub fn asymmetry(&self) -> f64 {
        self.uneven
    }

    /// Σ |K(x)| in Pa/m² over the neighbours x of a node (spectral norms): how strongly it is tied
    /// to them. For a bond-based material Σ c V/|ξ|.
    pub fn stiffness_sum(&self) -> f64 {
        let norm = |k: &SMatrix<f64, D, D>| {
            let embedded = Matrix3::from_fn(|i, j| if i < D && j < D { k[(i, j)] } else { 0.0 });
            embedded.symmetric_eigenvalues().amax()
        };
        // −4 K(x) of one of each pair ±x.
        self.constants.iter().map(|(_, k)| 0.5 * norm(k)).sum()
    }

    /// 2/ω in seconds for Gershgorin's bound, ρω² ≤ max_a Σ_x Σ_b |K_ab(x)|: never above
    /// [`critical_time_step`](Self::critical_time_step).
    pub fn gershgorin_time_step(&self) -> f64 {
        let (own, others) = self.constants.iter().fold(
            (SMatrix::<f64, D, D>::zeros(), SMatrix::<f64, D, D>::zeros()),
            |(own, others), (_, k)| (own + k * 0.5, others + k.abs() * 0.5),
        );
        let rows = (own.abs() + others).column_sum();
        2.0 / (rows.max() / self.density).sqrt()
    }

    /// Whether every wave keeps its amplitude ([`Extremes::stability`]), sampled as
    /// [`max_frequency`](Self::max_frequency).
    pub fn stability(&self) -> Stability<D> {
        self.default_extremes().stability()
    }

    /// Refuses a material that amplifies a wave. One with zero-energy modes passes.
    ///
    /// # Errors
    /// [`Error::UnstableMaterial`].
    pub fn require_stable(&self) -> Result<()> {
        match self.stability() {
            Stability::Unstable(mode) => Err(Error::UnstableMaterial {
                eigenvalue: mode.eigenvalue,
                wave: mode.wave.iter().copied().collect(),
                growth_rate: mode.growth_rate(),
            }),
            Stability::Stable(_) | Stability::ZeroEnergy(_) => Ok(()),
        }
    }
}

/// K(x) in Pa/Δx² at every node of the patch, x from the centre.
fn probe<const D: usize, M: Material<f64, D>>(
    body: &mut Body<f64, D, Lattice<f64, D>, &M, NoDamage>,
    centre: usize,
) -> Result<Vec<SMatrix<f64, D, D>>> {
    let mut k: Vec<SMatrix<f64, D, D>> = vec![SMatrix::zeros(); body.nodes()];
    let moved = body.family().site(centre);
    for b in 0..D {
        for sign in [1.0, -1.0] {
            let mut u = SVector::zeros();
            u[b] = sign * AMPLITUDE;
            body.u_mut().set(moved, u);
            body.evaluate()?;
            for (node, k) in k.iter_mut().enumerate() {
                let force = body.force().get(body.family().site(node));
                let column = k.column(b) - force * (sign / (2.0 * AMPLITUDE));
                k.set_column(b, &column);
            }
        }
        body.u_mut().set(moved, SVector::zeros());
    }
    Ok(k)
}

/// Balance of forces, and the symmetries of an elastic bulk lattice; how far they are from exact.
fn check<const D: usize>(k: &[SMatrix<f64, D, D>]) -> Result<f64> {
    let largest = k.iter().map(SMatrix::amax).fold(0.0, f64::max);
    let sum: SMatrix<f64, D, D> = k.iter().sum();
    let uneven = k
        .iter()
        .zip(k.iter().rev())
        .map(|(a, b)| (a - b).amax().max((a - a.transpose()).amax()))
        .fold(0.0, f64::max);
    for (rule, violation) in [
        ("Σ K(x) = 0: the pair forces of the two ends must be opposite", sum.amax()),
        ("K(x) = K(−x) = K(x)ᵀ: an energy must be behind, alike at all nodes and for ±ξ", uneven),
    ] {
        let relative = violation / largest;
        if relative.is_nan() || relative > TOLERANCE {
            return Err(Error::ForceConstants { rule, relative });
        }
    }
    Ok(uneven / largest)
}

fn unit_vector<const D: usize>(direction: &SVector<f64, D>) -> Result<SVector<f64, D>> {
    Ok(direction / Error::positive("length of the direction", direction.norm())?)
}

/// The samples of the Brillouin zone, as phases k_d Δx_d per cell.
struct Zone {
    samples: usize,
}

impl Zone {
    fn step(&self) -> f64 {
        2.0 * PI / self.samples as f64
    }
    /// Place of a sample along each axis; the zone's centre is at 0.
    fn places<const D: usize>(&self, index: usize) -> [usize; D] {
        std::array::from_fn(|d| index / self.samples.pow(d as u32) % self.samples)
    }
    fn index<const D: usize>(&self, places: [usize; D]) -> usize {
        places.iter().rev().fold(0, |index, place| index * self.samples + place % self.samples)
    }
    fn phases<const D: usize>(&self, index: usize) -> SVector<f64, D> {
        SVector::from(self.places(index).map(|i: usize| fold(self.step() * i as f64)))
    }
    /// The sample at −k.
    fn mirror<const D: usize>(&self, index: usize) -> usize {
        self.index(self.places::<D>(index).map(|i| self.samples - i))
    }
    /// The next samples along the axes; the zone is periodic.
    fn beside<const D: usize>(&self, index: usize) -> impl Iterator<Item = usize> {
        let places: [usize; D] = self.places(index);
        (0..2 * D).map(move |n| {
            let mut moved = places;
            moved[n / 2] += if n % 2 == 0 { 1 } else { self.samples - 1 };
            self.index(moved)
        })
    }
    /// True in the ball about the zone's centre that has no samples besides k = 0.
    fn is_long<const D: usize>(&self, phases: &SVector<f64, D>) -> bool {
        phases.map(fold).norm() < self.step() * (1.0 - 1e-9)
    }
}

/// The phase in [−π, π] that differs by a multiple of 2π.
fn fold(phase: f64) -> f64 {
    phase - 2.0 * PI * (phase / (2.0 * PI)).round()
}

/// Pattern search for a minimum: steps along the axes, halved until they gain nothing.
fn descend<const D: usize>(
    objective: &impl Fn(&SVector<f64, D>) -> f64,
    start: SVector<f64, D>,
    step: f64,
) -> (f64, SVector<f64, D>) {
    let mut best = (objective(&start), start);
    let mut length = 0.5 * step;
    for _ in 0..MOVES {
        if length < 1e-5 * step {
            break;
        }
        let moved = (0..2 * D)
            .map(|n| {
                let mut x = best.1;
                x[n / 2] += if n % 2 == 0 { length } else { -length };
                (objective(&x), x)
            })
            .fold(best, |a, b| if b.0 < a.0 { b } else { a });
        if moved.0 < best.0 {
            best = moved;
        } else {
            length *= 0.5;
        }
    }
    best
}
