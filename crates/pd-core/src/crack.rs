//! Pre-cracks: surfaces that cut every bond crossing them.

use crate::{Error, Result};
use nalgebra::{SVector, Vector2, Vector3};

/// A crack surface: a line in 2D, a piece of a plane in 3D, or one of your own.
///
/// It cuts the bonds whose inside crosses it, rim included. What is closer than 1e-9 bond lengths
/// touches, and what touches is cut: symmetric cracks on symmetric grids cut symmetric bonds, and
/// none slips through where two cracks meet. A node on the crack would be on neither side of it;
/// [`check_clear`] refuses that.
pub trait CrackSurface<const D: usize>: Send + Sync {
    /// True if the bond between `a` and `b` (metres, in either order) is cut.
    fn cuts(&self, a: &SVector<f64, D>, b: &SVector<f64, D>) -> bool;
    /// Distance of a point from the crack in metres.
    fn distance(&self, x: &SVector<f64, D>) -> f64;
    /// Unit normal.
    fn normal(&self) -> SVector<f64, D>;
}

/// What is closer than this share of a bond's length (of a polygon's size, of Δx) touches.
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
    /// [`Error::InvalidValue`] unless its length is finite and positive.
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

impl CrackSurface<2> for Segment {
    fn cuts(&self, a: &Vector2<f64>, b: &Vector2<f64>) -> bool {
        let touch = TOUCH * (b - a).norm();
        match pierce(&self.a, &self.normal(), a, b, touch) {
            Meeting::Apart => false,
            Meeting::At(x) => self.distance(&x) <= touch,
            Meeting::Along => segments_meet([a, b], [&self.a, &self.b], touch),
        }
    }
    fn distance(&self, x: &Vector2<f64>) -> f64 {
        distance_to_segment(x, &self.a, &self.b)
    }
    fn normal(&self) -> Vector2<f64> {
        let t = (self.b - self.a).normalize();
        Vector2::new(-t.y, t.x)
    }
}

/// A plane crack with a polygonal outline in 3D, convex or not.
#[derive(Debug, Clone, PartialEq)]
pub struct Polygon {
    vertices: Vec<Vector3<f64>>,
    normal: Vector3<f64>,
    axes: [Vector3<f64>; 2],
    /// Vertices in the plane's own coordinates.
    outline: Vec<Vector2<f64>>,
}

impl Polygon {
    /// With these vertices in order, in metres.
    ///
    /// # Errors
    /// [`Error::InvalidValue`] for fewer than 3 vertices, one that is not finite or no area;
    /// [`Error::NotPlanar`] for one out of the plane of the others; [`Error::EdgesMeet`] for an
    /// outline that crosses, touches or doubles back on itself.
    pub fn new(vertices: &[[f64; 3]]) -> Result<Self> {
        let count = vertices.len();
        Error::check(count >= 3, "number of vertices of a crack", count as f64, "at least 3")?;
        for &c in vertices.iter().flatten() {
            Error::check(c.is_finite(), "coordinate of a crack's vertex [m]", c, "finite")?;
        }
        let vertices: Vec<Vector3<f64>> = vertices.iter().map(|&v| v.into()).collect();
        let from_first: Vec<_> = vertices.iter().map(|v| v - vertices[0]).collect();
        let size = from_first.iter().map(|r| r.norm()).fold(0.0, f64::max);
        let near = TOUCH * size;
        let area: Vector3<f64> = ring(&from_first).map(|(p, q)| p.cross(q) / 2.0).sum();
        let enough = area.norm() > near * size;
        Error::check(enough, "area of a crack [m²]", area.norm(), "positive")?;
        let normal = area.normalize();
        for (vertex, r) in from_first.iter().enumerate() {
            let distance = normal.dot(r).abs();
            if distance > near {
                return Err(Error::NotPlanar { vertex, distance, tolerance: near });
            }
        }
        // Any direction in the plane will do; that of the largest vertex is never zero.
        let far = from_first.iter().max_by(|p, q| p.norm().total_cmp(&q.norm()));
        let far = far.copied().unwrap_or_default();
        let first = (far - normal * normal.dot(&far)).normalize();
        let axes = [first, normal.cross(&first)];
        let outline: Vec<_> = from_first.iter().map(|r| in_axes(&axes, r)).collect();
        check_simple(&outline, near)?;
        Ok(Self { vertices, normal, axes, outline })
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
        in_axes(&self.axes, &(x - self.vertices[0]))
    }
}

impl CrackSurface<3> for Polygon {
    fn cuts(&self, a: &Vector3<f64>, b: &Vector3<f64>) -> bool {
        let touch = TOUCH * (b - a).norm();
        match pierce(&self.vertices[0], &self.normal, a, b, touch) {
            Meeting::Apart => false,
            Meeting::At(x) => self.distance(&x) <= touch,
            Meeting::Along => {
                let (a, b) = (self.in_plane(a), self.in_plane(b));
                surrounds(&self.outline, &a)
                    || ring(&self.outline).any(|(p, q)| segments_meet([&a, &b], [p, q], touch))
            }
        }
    }
    fn distance(&self, x: &Vector3<f64>) -> f64 {
        if surrounds(&self.outline, &self.in_plane(x)) {
            return self.normal.dot(&(x - self.vertices[0])).abs();
        }
        let edges = ring(&self.vertices).map(|(p, q)| distance_to_segment(x, p, q));
        edges.fold(f64::INFINITY, f64::min)
    }
    fn normal(&self) -> Vector3<f64> {
        self.normal
    }
}

/// How a bond meets the line (2D) or plane (3D) of a crack.
enum Meeting<const D: usize> {
    Apart,
    At(SVector<f64, D>),
    Along,
}

/// How the bond a–b meets the line or plane through `origin`, ends within `touch` counting as on
/// it. A bond that only ends there is apart from it.
fn pierce<const D: usize>(
    origin: &SVector<f64, D>,
    normal: &SVector<f64, D>,
    a: &SVector<f64, D>,
    b: &SVector<f64, D>,
    touch: f64,
) -> Meeting<D> {
    let (height_a, height_b) = (normal.dot(&(a - origin)), normal.dot(&(b - origin)));
    if height_a.abs() <= touch && height_b.abs() <= touch {
        return Meeting::Along;
    }
    if height_a.min(height_b) < -touch && height_a.max(height_b) > touch {
        // Exchanging a and b changes both signs and nothing else: no bond is cut one way only.
        return Meeting::At((a * height_b - b * height_a) / (height_b - height_a));
    }
    Meeting::Apart
}

fn distance_to_segment<const D: usize>(
    x: &SVector<f64, D>,
    a: &SVector<f64, D>,
    b: &SVector<f64, D>,
) -> f64 {
    let along = b - a;
    let t = ((x - a).dot(&along) / along.norm_squared()).clamp(0.0, 1.0);
    (x - (a + along * t)).norm()
}

/// True if two closed segments cross or come closer than `touch`.
fn segments_meet([a, b]: [&Vector2<f64>; 2], [p, q]: [&Vector2<f64>; 2], touch: f64) -> bool {
    let side = |x: &Vector2<f64>, y: &Vector2<f64>, z: &Vector2<f64>| (y - x).perp(&(z - x));
    let opposite = |u: f64, v: f64| u.min(v) < 0.0 && u.max(v) > 0.0;
    let cross = opposite(side(a, b, p), side(a, b, q)) && opposite(side(p, q, a), side(p, q, b));
    let ends = [(a, p, q), (b, p, q), (p, a, b), (q, a, b)];
    cross || ends.iter().any(|(x, s, e)| distance_to_segment(x, s, e) <= touch)
}

/// True if a point lies inside an outline: a ray from it crosses the outline an odd number of
/// times.
fn surrounds(outline: &[Vector2<f64>], x: &Vector2<f64>) -> bool {
    let crossed = |(p, q): &(&Vector2<f64>, &Vector2<f64>)| {
        (p.y > x.y) != (q.y > x.y) && x.x < p.x + (x.y - p.y) / (q.y - p.y) * (q.x - p.x)
    };
    ring(outline).filter(crossed).count() % 2 == 1
}

/// Refuses an outline whose edges meet elsewhere than at the vertex that neighbours share.
fn check_simple(outline: &[Vector2<f64>], near: f64) -> Result<()> {
    let edges: Vec<_> = ring(outline).collect();
    for (i, &(p, q)) in edges.iter().enumerate() {
        for (j, &(r, s)) in edges.iter().enumerate().skip(i + 1) {
            let meet = if j == i + 1 {
                distance_to_segment(p, r, s) <= near || distance_to_segment(s, p, q) <= near
            } else if j + 1 == i + edges.len() {
                distance_to_segment(q, r, s) <= near || distance_to_segment(r, p, q) <= near
            } else {
                segments_meet([p, q], [r, s], near)
            };
            if meet {
                return Err(Error::EdgesMeet { edges: [i, j] });
            }
        }
    }
    Ok(())
}

fn in_axes(axes: &[Vector3<f64>; 2], r: &Vector3<f64>) -> Vector2<f64> {
    Vector2::new(axes[0].dot(r), axes[1].dot(r))
}

/// Edges of a closed line: each vertex with the next.
fn ring<X>(vertices: &[X]) -> impl Iterator<Item = (&X, &X)> {
    vertices.iter().zip(vertices.iter().cycle().skip(1))
}

/// Refuses a crack that passes through a node: which side the node is on would be chance.
///
/// # Errors
/// [`Error::CrackThroughNode`] with the first such node (closer than 1e-9 `spacing`) and, of the
/// shifts by ½, ⅜, ¼ and ⅛ `spacing` along the normal, the one that keeps furthest from all nodes.
pub fn check_clear<const D: usize>(
    crack: &dyn CrackSurface<D>,
    positions: impl Iterator<Item = SVector<f64, D>> + Clone,
    spacing: f64,
) -> Result<()> {
    let mut nodes = positions.clone().enumerate();
    let Some((node, x)) = nodes.find(|(_, x)| crack.distance(x) < TOUCH * spacing) else {
        return Ok(());
    };
    let (mut best, mut most) = (SVector::zeros(), f64::NEG_INFINITY);
    for part in [0.5, 0.375, 0.25, 0.125] {
        let shift = crack.normal() * (part * spacing);
        let distances = positions.clone().map(|x| crack.distance(&(x - shift)));
        let clearance = distances.fold(f64::INFINITY, f64::min);
        // Rounding must not prefer one shift to an equally good larger one.
        if clearance > most + TOUCH * spacing {
            (best, most) = (shift, clearance);
        }
    }
    Err(Error::CrackThroughNode {
        node,
        position: x.as_slice().to_vec(),
        shift: best.as_slice().to_vec(),
    })
}
