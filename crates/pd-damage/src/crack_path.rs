//! Measures of a crack from the damage index: separated nodes, components at a tip, path, line,
//! branches, mirror error, tip and its speed.
//!
//! A flat, fully separated pair of faces reads about 0.41 in the first row of nodes at m = 3 and
//! 0.2 in the second, so nodes that lost 0.35 or more of their family lie on a crack. Other
//! horizons read otherwise ([`CrackPlane::face_damage`](crate::CrackPlane::face_damage)): give 0.85
//! of what an open face has there.

use nalgebra::SVector;
use pd_core::body::Dynamics;
use pd_core::{Error, Real, Result};
use std::collections::{BTreeMap, HashMap, HashSet};

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
        Self::above(SEPARATED, spacing, nodes)
    }
    /// The same with another damage from which on a node counts as separated.
    pub fn above(
        threshold: f64,
        spacing: f64,
        nodes: impl Iterator<Item = (usize, SVector<f64, D>, f64)>,
    ) -> Self {
        let nodes: Vec<Separated<D>> = nodes
            .filter(|n| n.2 >= threshold)
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
    /// The separated nodes of `body` now, beyond the damage `start` it began with.
    pub fn of<T: Real>(body: &impl Dynamics<T, D>, start: &[f64]) -> Self {
        let nodes = (0..body.nodes()).map(|i| (i, body.position(i), body.damage(i) - start[i]));
        Self::new(body.unit(), nodes)
    }
    /// The spacing of the nodes in metres.
    pub fn spacing(&self) -> f64 {
        self.spacing
    }
    /// The nodes of the largest component, none if nothing is separated.
    pub fn largest(&self) -> Vec<Separated<D>> {
        let mut sizes: BTreeMap<usize, usize> = BTreeMap::new();
        self.component.iter().for_each(|c| *sizes.entry(*c).or_default() += 1);
        // The first of equals, whatever the order of the map.
        let best = sizes.iter().fold(None, |best: Option<(usize, usize)>, (&c, &n)| match best {
            Some((_, most)) if most >= n => best,
            _ => Some((c, n)),
        });
        let of = |c: usize| self.nodes.iter().zip(&self.component).filter(move |n| *n.1 == c);
        best.map_or(Vec::new(), |(c, _)| of(c).map(|n| *n.0).collect())
    }
    /// True if one component comes within 3 Δx of both places: the cracks have joined.
    pub fn joins(&self, a: &SVector<f64, D>, b: &SVector<f64, D>) -> bool {
        let at_b: HashSet<usize> = self.at_tip(b).iter().map(|n| n.node).collect();
        self.at_tip(a).iter().any(|n| at_b.contains(&n.node))
    }
    /// The crack's tip: the separated node of the components at `start` that is farthest along
    /// `direction`; `start` itself before anything has grown.
    pub fn tip(&self, start: &SVector<f64, D>, direction: &SVector<f64, D>) -> SVector<f64, D> {
        let reached = |x: &SVector<f64, D>| (x - start).dot(direction);
        let farther = |best: SVector<f64, D>, n: &Separated<D>| {
            if reached(&n.position) > reached(&best) { n.position } else { best }
        };
        self.at_tip(start).iter().fold(*start, farther)
    }
    /// Separated nodes of both over separated nodes of either: 1 for the same cracks, also if
    /// there is none.
    pub fn jaccard(&self, other: &Self) -> f64 {
        let set = |path: &Self| path.nodes.iter().map(|n| n.node).collect::<HashSet<_>>();
        let (a, b) = (set(self), set(other));
        let either = a.union(&b).count();
        if either == 0 { 1.0 } else { a.intersection(&b).count() as f64 / either as f64 }
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

/// The path y_c(x) of a crack: the mean of y, weighted by damage, of nodes in bins of 2 Δx along
/// x; (x, y) of each bin that has a node, ascending. The other axes are averaged over.
pub fn path<const D: usize>(nodes: &[Separated<D>], spacing: f64) -> Vec<(f64, f64)> {
    let mut bins: BTreeMap<i64, (f64, f64)> = BTreeMap::new();
    let width = 2.0 * spacing;
    for n in nodes {
        let bin = bins.entry((n.position[0] / width).floor() as i64).or_default();
        bin.0 += n.damage;
        bin.1 += n.damage * n.position[1];
    }
    bins.into_iter().map(|(k, (weight, sum))| ((k as f64 + 0.5) * width, sum / weight)).collect()
}

/// The y of a path at `x`, between its bins and constant beyond them; none for an empty path.
pub fn path_at(path: &[(f64, f64)], x: f64) -> Option<f64> {
    let (first, last) = (path.first()?, path.last()?);
    let k = path.partition_point(|p| p.0 < x);
    if k == 0 {
        return Some(first.1);
    }
    if k == path.len() {
        return Some(last.1);
    }
    let ((x0, y0), (x1, y1)) = (path[k - 1], path[k]);
    Some(y0 + (y1 - y0) * (x - x0) / (x1 - x0))
}

/// Slope of a path between two x, in degrees from x, by least squares; none for fewer than two
/// bins.
pub fn inclination(path: &[(f64, f64)], from: f64, to: f64) -> Option<f64> {
    let (low, high) = (from.min(to), from.max(to));
    let within: Vec<_> = path.iter().filter(|p| (low..=high).contains(&p.0)).collect();
    let n = within.len() as f64;
    let mean = within.iter().fold((0.0, 0.0), |m, p| (m.0 + p.0 / n, m.1 + p.1 / n));
    let (mut xx, mut xy) = (0.0, 0.0);
    for p in within {
        xx += (p.0 - mean.0).powi(2);
        xy += (p.0 - mean.0) * (p.1 - mean.1);
    }
    (xx > 0.0).then(|| (xy / xx).atan().to_degrees())
}

/// What to leave out of a line fit: the tip's neighbourhood (r < 3 Δx) and the rim of a body whose
/// outline is the box from `low` to `high` (5 Δx).
pub fn without_ends<const D: usize>(
    nodes: &[Separated<D>],
    tip: &SVector<f64, D>,
    (low, high): (&SVector<f64, D>, &SVector<f64, D>),
    spacing: f64,
) -> Vec<Separated<D>> {
    let rim = 5.0 * spacing;
    let inside = |x: &SVector<f64, D>| (0..D).all(|d| x[d] > low[d] + rim && x[d] < high[d] - rim);
    let far = |x: &SVector<f64, D>| (x - tip).norm() >= 3.0 * spacing;
    nodes.iter().filter(|n| inside(&n.position) && far(&n.position)).copied().collect()
}

/// Number of branches that a crack has at `x`: groups of separated nodes within Δx of it that lie
/// more than 3 Δx apart in y.
pub fn branches<const D: usize>(nodes: &[Separated<D>], x: f64, spacing: f64) -> usize {
    let near = |n: &&Separated<D>| (n.position[0] - x).abs() <= spacing;
    let mut heights: Vec<f64> = nodes.iter().filter(near).map(|n| n.position[1]).collect();
    heights.sort_by(f64::total_cmp);
    let gaps = heights.windows(2).filter(|w| w[1] - w[0] > 3.0 * spacing).count();
    if heights.is_empty() { 0 } else { gaps + 1 }
}

/// A symmetry of a body about its centre.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mirror {
    /// x ↦ −x: about the line x = 0.
    X,
    /// y ↦ −y: about the line y = 0.
    Y,
    /// Both: about the centre.
    Point,
}

/// Mean |D − D_mirrored| / mean D over all nodes, for a body of nodes that is symmetric about
/// `centre`; a node without a mirror image counts in full.
pub fn symmetry_error<const D: usize>(
    nodes: &[(SVector<f64, D>, f64)],
    (mirror, centre): (Mirror, &SVector<f64, D>),
    spacing: f64,
) -> f64 {
    let key = |x: &SVector<f64, D>| -> [i64; D] {
        // Twice as fine as the nodes: rounding cannot part an image from its node.
        std::array::from_fn(|d| (2.0 * (x[d] - centre[d]) / spacing).round() as i64)
    };
    let at: HashMap<[i64; D], f64> = nodes.iter().map(|(x, damage)| (key(x), *damage)).collect();
    let (mut total, mut difference) = (0.0, 0.0);
    for (x, damage) in nodes {
        let mut image = key(x);
        if mirror != Mirror::Y {
            image[0] = -image[0];
        }
        if mirror != Mirror::X {
            image[1] = -image[1];
        }
        total += damage;
        difference += at.get(&image).map_or(*damage, |other| (damage - other).abs());
    }
    if total > 0.0 { difference / total } else { 0.0 }
}

/// Places of a crack's tip through time.
#[derive(Debug, Clone, Default)]
pub struct TipTrack<const D: usize> {
    places: Vec<(f64, SVector<f64, D>)>,
}

impl<const D: usize> TipTrack<D> {
    /// Nothing seen yet.
    pub fn new() -> Self {
        Self { places: Vec::new() }
    }
    /// The tip at time t in seconds, in metres.
    pub fn add(&mut self, time: f64, tip: SVector<f64, D>) {
        self.places.push((time, tip));
    }
    /// (t, tip) in the order they came.
    pub fn places(&self) -> &[(f64, SVector<f64, D>)] {
        &self.places
    }
    /// First time at which the tip was farther than `distance` from where it started.
    pub fn time_of(&self, distance: f64) -> Option<f64> {
        let start = self.places.first()?.1;
        self.places.iter().find(|p| (p.1 - start).norm() > distance).map(|p| p.0)
    }
    /// Speed of the tip in m/s between two times, by least squares of the way over
    /// time: single steps of the tip are as long as Δx and say nothing. None for fewer than three
    /// places.
    pub fn speed(&self, from: f64, to: f64) -> Option<f64> {
        let mut way = 0.0;
        let mut points = Vec::new();
        for (k, (time, place)) in self.places.iter().enumerate() {
            way += if k > 0 { (place - self.places[k - 1].1).norm() } else { 0.0 };
            if (from..=to).contains(time) {
                points.push((*time, way));
            }
        }
        let n = points.len() as f64;
        let mean = points.iter().fold((0.0, 0.0), |m, p| (m.0 + p.0 / n, m.1 + p.1 / n));
        let (mut tt, mut ts) = (0.0, 0.0);
        for (t, s) in &points {
            tt += (t - mean.0).powi(2);
            ts += (t - mean.0) * (s - mean.1);
        }
        (points.len() >= 3 && tt > 0.0).then(|| ts / tt)
    }
}

/// Mean |D − D_mirrored| / mean D over all nodes; `mirrored` gives the node at the mirror image.
pub fn mirror_error(damage: &[f64], mirrored: impl Fn(usize) -> usize) -> f64 {
    let total: f64 = damage.iter().sum();
    let difference: f64 =
        damage.iter().enumerate().map(|(i, d)| (d - damage[mirrored(i)]).abs()).sum();
    if total > 0.0 { difference / total } else { 0.0 }
}
