//! Quadrature weights β: the fraction of a neighbour's cell that lies inside the horizon.

use crate::gauss;
use crate::search::TOLERANCE;
use nalgebra::SVector;

/// How the cells that the surface of the horizon cuts are counted: β in
/// f_i = Σ_j μ (T_i⟨ξ⟩ − T_j⟨−ξ⟩) β_ij V_j.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Quadrature {
    /// β = 1 for |ξ| ≤ δ, else 0.
    None,
    /// β = clamp((δ + Δx/2 − |ξ|)/Δx, 0, 1) for |ξ| ≤ δ, else 0 (as in LAMMPS).
    LinearRamp,
    /// The same ramp, continued to 0 at |ξ| = δ + Δx/2.
    ExtendedRamp,
    /// The exact fraction of the neighbour's cell inside the disc or ball (Scabbia et al. 2024,
    /// ref. 86). A neighbour whose centre lies outside the horizon can count.
    #[default]
    Exact,
}

/// A smaller exact fraction is rounding, of a cell that only touches the horizon: no bond is made.
const SMALLEST_FRACTION: f64 = 1e-14;

impl Quadrature {
    /// β of a neighbour at ξ = `xi` whose box-shaped cell has the edges `cell`, for the horizon
    /// δ = `horizon`: all in metres, edges and horizon positive. Zero means no bond.
    ///
    /// The ramps take as Δx the edge of the cell along the bond, |(ξ_k Δx_k)|/|ξ|. The exact
    /// fraction depends on |ξ_k| alone and not on the order of the axes, to the last bit: compute
    /// it once per class of cubic symmetry where speed matters.
    pub fn weight<const D: usize>(
        &self,
        xi: &SVector<f64, D>,
        cell: &SVector<f64, D>,
        horizon: f64,
    ) -> f64 {
        let length = xi.norm();
        let inside = length <= horizon * (1.0 + TOLERANCE);
        let ramp = || {
            let edge =
                if length > 0.0 { xi.component_mul(cell).norm() / length } else { cell.max() };
            ((horizon + 0.5 * edge - length) / edge).clamp(0.0, 1.0)
        };
        match self {
            Self::None => f64::from(u8::from(inside)),
            Self::LinearRamp if !inside => 0.0,
            Self::LinearRamp | Self::ExtendedRamp => ramp(),
            Self::Exact => exact(xi, cell, horizon),
        }
    }

    /// The distance in metres beyond which no neighbour counts: δ, δ plus half the longest edge, or δ
    /// plus half the diagonal of the cell.
    pub fn reach<const D: usize>(&self, cell: &SVector<f64, D>, horizon: f64) -> f64 {
        match self {
            Self::None | Self::LinearRamp => horizon,
            Self::ExtendedRamp => horizon + 0.5 * cell.max(),
            Self::Exact => horizon + 0.5 * cell.norm(),
        }
    }
}

fn exact<const D: usize>(xi: &SVector<f64, D>, cell: &SVector<f64, D>, radius: f64) -> f64 {
    let mut axes: [(f64, f64); D] = std::array::from_fn(|k| (xi[k].abs(), cell[k]));
    axes.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let low = axes.map(|(x, edge)| x - 0.5 * edge);
    let high = axes.map(|(x, edge)| x + 0.5 * edge);
    if norm(&high) <= radius {
        return 1.0;
    }
    // A box across a coordinate plane is cut there and its parts are mirrored into x ≥ 0.
    let volume: f64 = (0..1_usize << D)
        .filter(|part| (0..D).all(|k| part >> k & 1 == 0 || low[k] < 0.0))
        .map(|part| {
            let mirrored = |k: usize| part >> k & 1 == 1;
            let from: [f64; D] = std::array::from_fn(|k| low[k].max(0.0));
            let to: [f64; D] = std::array::from_fn(|k| if mirrored(k) { -low[k] } else { high[k] });
            ball_and_box(&from, &to, radius)
        })
        .sum();
    let fraction = volume / axes.iter().map(|(_, edge)| edge).product::<f64>();
    if fraction < SMALLEST_FRACTION { 0.0 } else { fraction.min(1.0) }
}

/// Volume of the box `low`..`high` in x ≥ 0 inside the ball about the origin.
fn ball_and_box(low: &[f64], high: &[f64], radius: f64) -> f64 {
    if norm(low) >= radius {
        return 0.0;
    }
    if norm(high) <= radius {
        return low.iter().zip(high).map(|(a, b)| b - a).product();
    }
    match (low, high) {
        ([a], [_]) => radius - a,
        ([x, y], [x1, y1]) => disc_and_rectangle([*x, *y], [*x1, *y1], radius),
        ([low @ .., a], [high @ .., b]) => slices(low, high, *a, *b, radius),
        _ => 0.0,
    }
}

/// The other leg of the right triangle with hypotenuse `radius`.
fn leg(radius: f64, x: f64) -> f64 {
    ((radius - x) * (radius + x)).max(0.0).sqrt()
}

fn norm(x: &[f64]) -> f64 {
    x.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// Area of a rectangle that the circle crosses: the full columns, the trapezium under the chord of
/// the arc from (xa, ya) to (xb, yb), and the circular segment above the chord.
fn disc_and_rectangle([x0, y0]: [f64; 2], [x1, y1]: [f64; 2], radius: f64) -> f64 {
    let (at_top, at_bottom) = (leg(radius, y1), leg(radius, y0));
    let (xa, ya) = if at_top > x0 { (at_top, y1) } else { (x0, leg(radius, x0)) };
    let (xb, yb) = if at_bottom < x1 { (at_bottom, y0) } else { (x1, leg(radius, x1)) };
    let angle = 2.0 * ((xb - xa).hypot(ya - yb) / (2.0 * radius)).asin();
    let segment = 0.5 * radius * radius * (angle - angle.sin());
    (xa - x0) * (y1 - y0) + 0.5 * (xb - xa) * ((ya - y0) + (yb - y0)) + segment
}

/// Integral over the last axis, from `a` to `b`, of the slice of the ball in the box of the others.
fn slices(low: &[f64], high: &[f64], a: f64, b: f64, radius: f64) -> f64 {
    let b = b.min(leg(radius, norm(low)));
    // The slice is smooth except where its circle passes a corner of the box.
    let corners = (0..1_usize << low.len()).map(|corner| {
        let square = |k: usize| (if corner >> k & 1 == 1 { high[k] } else { low[k] }).powi(2);
        leg(radius, (0..low.len()).map(square).sum::<f64>().sqrt())
    });
    let mut kinks: Vec<f64> = corners.filter(|z| (a..b).contains(z)).chain([a, b]).collect();
    kinks.sort_unstable_by(f64::total_cmp);
    let part = |ends: &[f64]| {
        let (middle, half) = (0.5 * (ends[0] + ends[1]), 0.5 * (ends[1] - ends[0]));
        // z = middle − half cos φ makes the square roots at the ends smooth.
        gauss::integrate(0.0, std::f64::consts::PI, |phi| {
            let z = middle - half * phi.cos();
            half * phi.sin() * ball_and_box(low, high, leg(radius, z))
        })
    };
    kinks.windows(2).filter(|ends| ends[0] < ends[1]).map(part).sum()
}
