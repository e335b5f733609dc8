//! Pre-cracks: surfaces that cut every bond crossing them.

use crate::{Error, Result};
use nalgebra::{SVector, Vector2, Vector3};

/// A crack surface: a line in 2D, a piece of a plane in 3D, or one of your own.
pub trait CrackSurface<const D: usize>: Send + Sync {
    /// True if the segment from `a` to `b` (metres) crosses the crack or touches its rim.
    fn cuts(&self, a: &SVector<f64, D>, b: &SVector<f64, D>) -> bool;
    /// Distance of a point from the crack in metres.
    fn distance(&self, x: &SVector<f64, D>) -> f64;
    /// Unit normal.
    fn normal(&self) -> SVector<f64, D>;
}

/// A bond that passes a tip or rim within this share of the crack's size touches it, and what
/// touches is cut: symmetric cracks on symmetric grids cut symmetric bonds.
const TOUCH: f64 = 1e-9;

/// A straight crack in 2D.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Segment {
    a: Vector2<f64>,
    b: Vector2<f64>,
}

impl Segment {
    /// Between two tips, in metres.
    ///
    /// # Errors
    /// [`Error::InvalidValue`] unless its length is positive.
    pub fn new(a: [f64; 2], b: [f64; 2]) -> Result<Self> {
        let (a, b) = (Vector2::from(a), Vector2::from(b));
        Error::positive("length of a crack [m]", (b - a).norm())?;
        Ok(Self { a, b })
    }
    /// The tips.
    pub fn tips(&self) -> [Vector2<f64>; 2] {
        [self.a, self.b]
    }
}

fn cross(a: &Vector2<f64>, b: &Vector2<f64>) -> f64 {
    a.x * b.y - a.y * b.x
}

/// True if the segments p–q and a–b have a point in common.
fn segments_meet(p: &Vector2<f64>, q: &Vector2<f64>, a: &Vector2<f64>, b: &Vector2<f64>) -> bool {
    let (u, w) = (q - p, b - a);
    let side = |o: &Vector2<f64>, along: &Vector2<f64>, x: &Vector2<f64>| cross(along, &(x - o));
    let (sa, sb) = (side(p, &u, a), side(p, &u, b));
    let (sp, sq) = (side(a, &w, p), side(a, &w, q));
    if sa == 0.0 && sb == 0.0 {
        // On one line: they meet if their projections overlap.
        let t = |x: &Vector2<f64>| (x - p).dot(&u);
        let (low, high) = (t(a).min(t(b)), t(a).max(t(b)));
        return high >= 0.0 && low <= u.norm_squared();
    }
    sa * sb <= 0.0 && sp * sq <= 0.0
}

impl CrackSurface<2> for Segment {
    fn cuts(&self, a: &Vector2<f64>, b: &Vector2<f64>) -> bool {
        let reach = (self.b - self.a) * TOUCH;
        segments_meet(a, b, &(self.a - reach), &(self.b + reach))
    }
    fn distance(&self, x: &Vector2<f64>) -> f64 {
        distance_to_segment(x, &self.a, &self.b)
    }
    fn normal(&self) -> Vector2<f64> {
        let t = (self.b - self.a).normalize();
        Vector2::new(-t.y, t.x)
    }
}

fn distance_to_segment(x: &Vector2<f64>, a: &Vector2<f64>, b: &Vector2<f64>) -> f64 {
    let along = b - a;
    let t = ((x - a).dot(&along) / along.norm_squared()).clamp(0.0, 1.0);
    (x - (a + along * t)).norm()
}

/// A plane crack with a polygonal outline in 3D, convex or not.
#[derive(Debug, Clone, PartialEq)]
pub struct Polygon {
    origin: Vector3<f64>,
    axes: [Vector3<f64>; 2],
    normal: Vector3<f64>,
    /// Vertices in the plane's own coordinates.
    vertices: Vec<Vector2<f64>>,
}

impl Polygon {
    /// With these vertices in order, in metres.
    ///
    /// # Errors
    /// [`Error::InvalidValue`] for fewer than 3 vertices, no area, or vertices out of one plane.
    pub fn new(vertices: &[[f64; 3]]) -> Result<Self> {
        let count = vertices.len();
        Error::check(count >= 3, "number of vertices of a crack", count as f64, "at least 3")?;
        let points: Vec<Vector3<f64>> = vertices.iter().map(|&v| v.into()).collect();
        let origin = points[0];
        // Twice the area vector (Newell).
        let area: Vector3<f64> =
            (1..count - 1).map(|i| (points[i] - origin).cross(&(points[i + 1] - origin))).sum();
        let size = points.iter().map(|p| (p - origin).norm()).fold(0.0, f64::max);
        Error::positive("area of a crack [m²]", area.norm())?;
        let normal = area.normalize();
        for p in &points {
            let off = (p - origin).dot(&normal).abs();
            Error::check(off <= 1e-9 * size, "vertex out of the crack's plane by [m]", off, "0")?;
        }
        let first = (points[1] - origin).normalize();
        let axes = [first, normal.cross(&first)];
        let vertices = points
            .iter()
            .map(|p| Vector2::new((p - origin).dot(&axes[0]), (p - origin).dot(&axes[1])));
        Ok(Self { origin, axes, normal, vertices: vertices.collect() })
    }
    /// A parallelogram from a corner and two edges, in metres.
    ///
    /// # Errors
    /// As [`Polygon::new`].
    pub fn parallelogram(corner: [f64; 3], first: [f64; 3], second: [f64; 3]) -> Result<Self> {
        let add = |a: [f64; 3], b: [f64; 3]| std::array::from_fn(|d| a[d] + b[d]);
        let far = add(corner, first);
        Self::new(&[corner, far, add(far, second), add(corner, second)])
    }
    fn in_plane(&self, x: &Vector3<f64>) -> Vector2<f64> {
        let r = x - self.origin;
        Vector2::new(r.dot(&self.axes[0]), r.dot(&self.axes[1]))
    }
    fn edges(&self) -> impl Iterator<Item = (&Vector2<f64>, &Vector2<f64>)> {
        self.vertices.iter().zip(self.vertices.iter().cycle().skip(1))
    }
    /// True if a point of the plane lies inside (even–odd rule) or on the outline.
    fn covers(&self, p: &Vector2<f64>) -> bool {
        let mut inside = false;
        for (a, b) in self.edges() {
            let edge = b - a;
            if distance_to_segment(p, a, b) <= TOUCH * edge.norm() {
                return true;
            }
            if (a.y > p.y) != (b.y > p.y) && p.x < a.x + edge.x * (p.y - a.y) / edge.y {
                inside = !inside;
            }
        }
        inside
    }
}

impl CrackSurface<3> for Polygon {
    fn cuts(&self, a: &Vector3<f64>, b: &Vector3<f64>) -> bool {
        let height = |x: &Vector3<f64>| (x - self.origin).dot(&self.normal);
        let (ha, hb) = (height(a), height(b));
        if ha * hb > 0.0 {
            return false;
        }
        if ha == 0.0 && hb == 0.0 {
            let (p, q) = (self.in_plane(a), self.in_plane(b));
            return self.covers(&p) || self.edges().any(|(c, d)| segments_meet(&p, &q, c, d));
        }
        let t = ha / (ha - hb);
        self.covers(&self.in_plane(&(a + (b - a) * t)))
    }
    fn distance(&self, x: &Vector3<f64>) -> f64 {
        let p = self.in_plane(x);
        let height = (x - self.origin).dot(&self.normal);
        let beside = if self.covers(&p) {
            0.0
        } else {
            self.edges().map(|(a, b)| distance_to_segment(&p, a, b)).fold(f64::INFINITY, f64::min)
        };
        height.hypot(beside)
    }
    fn normal(&self) -> Vector3<f64> {
        self.normal
    }
}

/// Refuses a crack that passes through a node: which side the node is on would be chance.
///
/// # Errors
/// [`Error::CrackThroughNode`], with the shift that avoids it.
pub fn check_clear<const D: usize>(
    crack: &dyn CrackSurface<D>,
    positions: impl Iterator<Item = SVector<f64, D>>,
    spacing: f64,
) -> Result<()> {
    for (node, x) in positions.enumerate() {
        if crack.distance(&x) < 1e-9 * spacing {
            return Err(Error::CrackThroughNode {
                node,
                position: x.iter().copied().collect(),
                shift: (crack.normal() * (0.5 * spacing)).iter().copied().collect(),
            });
        }
    }
    Ok(())
}
