//! Measures of a crack from the damage index: separated nodes, components at a tip, line angle,
//! mirror error.
//!
//! A flat, fully separated pair of faces reads about 0.41 in the first row of nodes at m = 3 and
//! 0.2 in the second, so nodes that lost 0.35 or more of their family lie on a crack.

use nalgebra::SVector;
use pd_core::body::Dynamics;
use pd_core::{Error, Real, Result};
use std::collections::HashMap;

/// Damage from which on a node counts as separated.
pub const SEPARATED: f64 = 0.35;

/// The separated nodes of a body, by connected components.
#[derive(Debug, Clone)]
pub struct CrackPath<const D: usize> {
    spacing: f64,
    nodes: Vec<Separated<D>>,
    /// Component of each node.
    component: Vec<usize>,
}

/// A separated node.
#[derive(Debug, Clone, Copy)]
pub struct Separated<const D: usize> {
    /// Index of the node.
    pub node: usize,
    /// Reference position in metres.
    pub position: SVector<f64, D>,
    /// Damage gained since the start.
    pub damage: f64,
}

/// A straight line fitted to nodes by total least squares.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LineFit {
    /// Angle from x in radians, in (−π/2, π/2].
    pub angle: f64,
    /// Extent along the line in metres.
    pub length: f64,
    /// Root mean square distance from the line in metres.
    pub scatter: f64,
    /// Nodes fitted.
    pub nodes: usize,
}

impl<const D: usize> CrackPath<D> {
    /// From positions and the damage each node has gained beyond its pre-crack.
    pub fn new(spacing: f64, nodes: impl Iterator<Item = (usize, SVector<f64, D>, f64)>) -> Self {
        let nodes: Vec<Separated<D>> = nodes
            .filter(|n| n.2 >= SEPARATED)
            .map(|(node, position, damage)| Separated { node, position, damage })
            .collect();
        let component = components(&nodes, 1.5 * spacing);
        Self { spacing, nodes, component }
    }
    /// Separated nodes.
    pub fn nodes(&self) -> &[Separated<D>] {
        &self.nodes
    }
    /// The nodes of the components that come within 3 Δx of `tip`.
    pub fn at_tip(&self, tip: &SVector<f64, D>) -> Vec<Separated<D>> {
        let near = |n: &Separated<D>| (n.position - tip).norm() <= 3.0 * self.spacing;
        let touched: Vec<usize> = self
            .nodes
            .iter()
            .zip(&self.component)
            .filter(|(n, _)| near(n))
            .map(|(_, &c)| c)
            .collect();
        self.nodes
            .iter()
            .zip(&self.component)
            .filter(|(_, c)| touched.contains(c))
            .map(|(n, _)| *n)
            .collect()
    }
    /// Farthest separated node of the components at `tip`, as distance from it in metres.
    pub fn growth(&self, tip: &SVector<f64, D>) -> f64 {
        self.at_tip(tip).iter().map(|n| (n.position - tip).norm()).fold(0.0, f64::max)
    }
}

/// Follows the tip of a crack that grows from a known place: a column for a history.
///
/// ```text
/// let tip = CrackTip::new(&body, [0.0125, 0.0])?;
/// Table::new("out/tip.csv").column("tip x [m]", |view| tip.position(view.body)[0])
/// ```
#[derive(Debug, Clone)]
pub struct CrackTip<const D: usize> {
    start: SVector<f64, D>,
    damage: Vec<f64>,
}

impl<const D: usize> CrackTip<D> {
    /// The tip at `start` in metres of a body as it is now: what is damaged already is no growth.
    ///
    /// # Errors
    /// [`Error::InvalidValue`] for a place that is not finite.
    pub fn new<T: Real>(body: &impl Dynamics<T, D>, start: [f64; D]) -> Result<Self> {
        for x in start {
            Error::check(x.is_finite(), "place of the crack tip [m]", x, "finite")?;
        }
        let damage = (0..body.nodes()).map(|i| body.damage(i)).collect();
        Ok(Self { start: start.into(), damage })
    }
    /// Position in metres: the farthest node that has separated since the start and is connected to
    /// it, or where it started. Known to about Δx.
    pub fn position<T: Real>(&self, body: &impl Dynamics<T, D>) -> SVector<f64, D> {
        let gained = |i: usize| (i, body.position(i), body.damage(i) - self.damage[i]);
        let path = CrackPath::new(body.unit(), (0..body.nodes()).map(gained));
        let far = |x: &SVector<f64, D>| (x - self.start).norm();
        let grown = path.at_tip(&self.start);
        grown
            .iter()
            .map(|n| n.position)
            .fold(self.start, |a, b| if far(&b) > far(&a) { b } else { a })
    }
    /// How far the tip has moved in metres.
    pub fn growth<T: Real>(&self, body: &impl Dynamics<T, D>) -> f64 {
        (self.position(body) - self.start).norm()
    }
}

/// Connected components of nodes within `reach` of each other.
fn components<const D: usize>(nodes: &[Separated<D>], reach: f64) -> Vec<usize> {
    let cell = |x: &SVector<f64, D>| -> [i64; D] {
        std::array::from_fn(|d| (x[d] / reach).floor() as i64)
    };
    let mut cells: HashMap<[i64; D], Vec<usize>> = HashMap::new();
    for (i, n) in nodes.iter().enumerate() {
        cells.entry(cell(&n.position)).or_default().push(i);
    }
    let mut component = vec![usize::MAX; nodes.len()];
    let mut count = 0;
    for start in 0..nodes.len() {
        if component[start] != usize::MAX {
            continue;
        }
        let mut stack = vec![start];
        component[start] = count;
        while let Some(i) = stack.pop() {
            let home = cell(&nodes[i].position);
            for step in 0..3_usize.pow(D as u32) {
                let mut rest = step;
                let near: [i64; D] = std::array::from_fn(|d| {
                    let s = rest % 3;
                    rest /= 3;
                    home[d] + s as i64 - 1
                });
                for &j in cells.get(&near).into_iter().flatten() {
                    let close = (nodes[i].position - nodes[j].position).norm() <= reach;
                    if component[j] == usize::MAX && close {
                        component[j] = count;
                        stack.push(j);
                    }
                }
            }
        }
        count += 1;
    }
    component
}

/// Line through nodes in the xy plane by total least squares; none for fewer than two places.
pub fn fit_line<const D: usize>(nodes: &[Separated<D>]) -> Option<LineFit> {
    let n = nodes.len() as f64;
    let mean = nodes.iter().fold(SVector::<f64, D>::zeros(), |s, p| s + p.position) / n;
    let (mut xx, mut xy, mut yy) = (0.0, 0.0, 0.0);
    for p in nodes {
        let r = p.position - mean;
        xx += r[0] * r[0];
        xy += r[0] * r[1];
        yy += r[1] * r[1];
    }
    if nodes.len() < 2 || xx + yy == 0.0 {
        return None;
    }
    let angle = 0.5 * (2.0 * xy).atan2(xx - yy);
    let (sin, cos) = angle.sin_cos();
    let along =
        |p: &Separated<D>| (p.position[0] - mean[0]) * cos + (p.position[1] - mean[1]) * sin;
    let (low, high) = nodes
        .iter()
        .map(along)
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), t| (l.min(t), h.max(t)));
    let scatter = ((xx * sin * sin - 2.0 * xy * sin * cos + yy * cos * cos) / n).max(0.0).sqrt();
    Some(LineFit { angle, length: high - low, scatter, nodes: nodes.len() })
}

/// Mean |D − D_mirrored| / mean D over all nodes; `mirrored` gives the node at the mirror image.
pub fn mirror_error(damage: &[f64], mirrored: impl Fn(usize) -> usize) -> f64 {
    let total: f64 = damage.iter().sum();
    let difference: f64 =
        damage.iter().enumerate().map(|(i, d)| (d - damage[mirrored(i)]).abs()).sum();
    if total > 0.0 { difference / total } else { 0.0 }
}
