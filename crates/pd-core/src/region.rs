//! Shapes that a grid fills.

use crate::{Error, Result};
use nalgebra::SVector;

/// Distance, as a share of the spacing, within which a cell centre counts as on a boundary.
const ON_BOUNDARY: f64 = 1e-9;

/// A region of space. Combinators nest, `plate.without(hole).union(tab)`, and box, for many holes.
pub trait Shape<const D: usize>: Send + Sync {
    /// True if the point (metres) lies inside or on the boundary.
    fn contains(&self, x: &SVector<f64, D>) -> bool;
    /// Lowest and highest corner of a box that holds the shape, in metres.
    fn bounds(&self) -> (SVector<f64, D>, SVector<f64, D>);

    /// Points in this shape or the other.
    fn union<B: Shape<D>>(self, other: B) -> Union<Self, B>
    where
        Self: Sized,
    {
        Union(self, other)
    }
    /// Points in this shape, but not in `hole`.
    fn without<B: Shape<D>>(self, hole: B) -> Difference<Self, B>
    where
        Self: Sized,
    {
        Difference(self, hole)
    }
    /// Points in both shapes.
    fn intersection<B: Shape<D>>(self, other: B) -> Intersection<Self, B>
    where
        Self: Sized,
    {
        Intersection(self, other)
    }
}

impl<const D: usize, S: Shape<D> + ?Sized> Shape<D> for &S {
    fn contains(&self, x: &SVector<f64, D>) -> bool {
        (**self).contains(x)
    }
    fn bounds(&self) -> (SVector<f64, D>, SVector<f64, D>) {
        (**self).bounds()
    }
}

impl<const D: usize, S: Shape<D> + ?Sized> Shape<D> for Box<S> {
    fn contains(&self, x: &SVector<f64, D>) -> bool {
        (**self).contains(x)
    }
    fn bounds(&self) -> (SVector<f64, D>, SVector<f64, D>) {
        (**self).bounds()
    }
}

/// [`Shape::contains`] where rounding does not decide: a point is in if it, or a point displaced
/// from it by ±1e-9 Δx along any of the axes, is.
pub(crate) fn holds<const D: usize>(
    shape: &(impl Shape<D> + ?Sized),
    x: &SVector<f64, D>,
    spacing: &SVector<f64, D>,
) -> bool {
    (0..3usize.pow(D as u32)).any(|code| {
        let step = |axis| [0.0, 1.0, -1.0][code / 3usize.pow(axis as u32) % 3];
        let nudge = SVector::from_fn(|axis, _| step(axis) * ON_BOUNDARY * spacing[axis]);
        shape.contains(&(x + nudge))
    })
}

/// See [`Shape::union`].
#[derive(Debug, Clone, Copy)]
pub struct Union<A, B>(A, B);
/// See [`Shape::without`].
#[derive(Debug, Clone, Copy)]
pub struct Difference<A, B>(A, B);
/// See [`Shape::intersection`].
#[derive(Debug, Clone, Copy)]
pub struct Intersection<A, B>(A, B);

impl<const D: usize, A: Shape<D>, B: Shape<D>> Shape<D> for Union<A, B> {
    fn contains(&self, x: &SVector<f64, D>) -> bool {
        self.0.contains(x) || self.1.contains(x)
    }
    fn bounds(&self) -> (SVector<f64, D>, SVector<f64, D>) {
        let ((a, b), (c, d)) = (self.0.bounds(), self.1.bounds());
        (a.inf(&c), b.sup(&d))
    }
}
impl<const D: usize, A: Shape<D>, B: Shape<D>> Shape<D> for Difference<A, B> {
    fn contains(&self, x: &SVector<f64, D>) -> bool {
        self.0.contains(x) && !self.1.contains(x)
    }
    fn bounds(&self) -> (SVector<f64, D>, SVector<f64, D>) {
        self.0.bounds()
    }
}
impl<const D: usize, A: Shape<D>, B: Shape<D>> Shape<D> for Intersection<A, B> {
    fn contains(&self, x: &SVector<f64, D>) -> bool {
        self.0.contains(x) && self.1.contains(x)
    }
    fn bounds(&self) -> (SVector<f64, D>, SVector<f64, D>) {
        let ((a, b), (c, d)) = (self.0.bounds(), self.1.bounds());
        (a.sup(&c), b.inf(&d))
    }
}

/// A box with edges along the axes: a rectangle in 2D, a cuboid in 3D.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cuboid<const D: usize> {
    low: SVector<f64, D>,
    high: SVector<f64, D>,
}

impl<const D: usize> Cuboid<D> {
    /// From the lowest to the highest corner, in metres.
    ///
    /// # Errors
    /// [`Error::InvalidValue`] unless every edge is finite and positive.
    pub fn new(low: [f64; D], high: [f64; D]) -> Result<Self> {
        for d in 0..D {
            Error::positive("edge of a box [m]", high[d] - low[d])?;
        }
        Ok(Self { low: low.into(), high: high.into() })
    }
    /// Centred at the origin, with these edges in metres.
    ///
    /// # Errors
    /// As [`Cuboid::new`].
    pub fn centred(edges: [f64; D]) -> Result<Self> {
        Self::new(edges.map(|e| -0.5 * e), edges.map(|e| 0.5 * e))
    }
    /// Longer by `low` and `high` metres at the two ends of an axis: for fictitious layers.
    ///
    /// # Errors
    /// [`Error::InvalidValue`] for an axis the box does not have or an edge that vanishes.
    pub fn extended(&self, axis: usize, low: f64, high: f64) -> Result<Self> {
        Error::check(axis < D, "axis of a box", axis as f64, "below its dimension")?;
        let mut copy = *self;
        copy.low[axis] -= low;
        copy.high[axis] += high;
        Self::new(copy.low.into(), copy.high.into())
    }
}

impl<const D: usize> Shape<D> for Cuboid<D> {
    fn contains(&self, x: &SVector<f64, D>) -> bool {
        (0..D).all(|d| self.low[d] <= x[d] && x[d] <= self.high[d])
    }
    fn bounds(&self) -> (SVector<f64, D>, SVector<f64, D>) {
        (self.low, self.high)
    }
}

/// A disc in 2D, a ball in 3D.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ball<const D: usize> {
    centre: SVector<f64, D>,
    radius: f64,
}

/// A disc.
pub type Disc = Ball<2>;

impl<const D: usize> Ball<D> {
    /// Of this centre and radius, in metres.
    ///
    /// # Errors
    /// [`Error::InvalidValue`] unless the radius is positive and the centre finite.
    pub fn new(centre: [f64; D], radius: f64) -> Result<Self> {
        Error::positive("radius [m]", radius)?;
        for c in centre {
            Error::check(c.is_finite(), "centre of a ball [m]", c, "finite")?;
        }
        Ok(Self { centre: centre.into(), radius })
    }
}

impl<const D: usize> Shape<D> for Ball<D> {
    fn contains(&self, x: &SVector<f64, D>) -> bool {
        (x - self.centre).norm_squared() <= self.radius * self.radius
    }
    fn bounds(&self) -> (SVector<f64, D>, SVector<f64, D>) {
        let r = SVector::repeat(self.radius);
        (self.centre - r, self.centre + r)
    }
}

/// A circular cylinder between two points of its axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cylinder {
    start: SVector<f64, 3>,
    axis: SVector<f64, 3>,
    radius: f64,
}

impl Cylinder {
    /// Between the centres of its ends, in metres.
    ///
    /// # Errors
    /// [`Error::InvalidValue`] unless radius and length are positive.
    pub fn new(start: [f64; 3], end: [f64; 3], radius: f64) -> Result<Self> {
        let (start, end) = (SVector::from(start), SVector::from(end));
        Error::positive("length of a cylinder [m]", (end - start).norm())?;
        Error::positive("radius [m]", radius)?;
        Ok(Self { start, axis: end - start, radius })
    }
}

impl Shape<3> for Cylinder {
    fn contains(&self, x: &SVector<f64, 3>) -> bool {
        let r = x - self.start;
        let t = r.dot(&self.axis) / self.axis.norm_squared();
        (0.0..=1.0).contains(&t) && (r - self.axis * t).norm_squared() <= self.radius.powi(2)
    }
    fn bounds(&self) -> (SVector<f64, 3>, SVector<f64, 3>) {
        let n = self.axis.normalize();
        let r = n.map(|c| self.radius * (1.0 - c * c).max(0.0).sqrt());
        let end = self.start + self.axis;
        (self.start.inf(&end) - r, self.start.sup(&end) + r)
    }
}

/// The part of a box where a predicate holds: any shape of your own.
#[derive(Debug, Clone, Copy)]
pub struct Within<F, const D: usize> {
    bounds: Cuboid<D>,
    inside: F,
}

impl<F: Fn(&SVector<f64, D>) -> bool + Send + Sync, const D: usize> Within<F, D> {
    /// The points of `bounds` for which `inside` holds.
    pub fn new(bounds: Cuboid<D>, inside: F) -> Self {
        Self { bounds, inside }
    }
}

impl<F: Fn(&SVector<f64, D>) -> bool + Send + Sync, const D: usize> Shape<D> for Within<F, D> {
    fn contains(&self, x: &SVector<f64, D>) -> bool {
        self.bounds.contains(x) && (self.inside)(x)
    }
    fn bounds(&self) -> (SVector<f64, D>, SVector<f64, D>) {
        self.bounds.bounds()
    }
}
