//! Infinite anisotropic plates with a crack or a circular hole under remote stress, in closed form.
//!
//! With the Stroh roots p_k, matrices A and B of the material and z_k = x + p_k y, the disturbance of
//! the uniform field is u = Re[A ⟨f(z_k)⟩ q]. Not for isotropic materials, whose A and B are singular:
//! make one modulus differ by a thousandth.

use nalgebra::{Complex, Matrix2, SMatrix, SVector, Vector2};
use pd_core::region::Cuboid;
use pd_core::statics::Solved;
use pd_core::{
    Body, DamagePolicy, Grid, Horizon, Lattice, Loads, Material, NodeSet, Quadrature, Real, Result,
    Statics,
};
use pd_models::{Stiffness, Stroh};

/// A plate with its remote stress.
pub struct InfinitePlate {
    stiffness: Stiffness<2>,
    stroh: Stroh,
    stress: Matrix2<f64>,
}

impl InfinitePlate {
    /// Under the remote stress σ (a symmetric tensor, Pa).
    ///
    /// # Panics
    /// Never for a valid stiffness.
    pub fn new(stiffness: &Stiffness<2>, stress: Matrix2<f64>) -> Self {
        let stroh = Stroh::new(stiffness, 0.0).expect("a finite direction");
        Self { stiffness: *stiffness, stroh, stress }
    }
    /// The uniform part of the displacement, ε x.
    fn uniform(&self, x: &Vector2<f64>) -> Vector2<f64> {
        let s = self.stiffness.voigt().try_inverse().expect("positive definite");
        let e = s * SVector::from([self.stress[(0, 0)], self.stress[(1, 1)], self.stress[(0, 1)]]);
        SMatrix::from([[e[0], 0.5 * e[2]], [0.5 * e[2], e[1]]]) * x
    }
    fn disturbance(
        &self,
        x: &Vector2<f64>,
        f: impl Fn(Complex<f64>, Complex<f64>) -> Complex<f64>,
        load: Vector2<Complex<f64>>,
    ) -> Vector2<f64> {
        let q = self.stroh.b().try_inverse().expect("distinct roots") * load;
        let [p0, p1] = self.stroh.roots();
        let at = |p: Complex<f64>| f(Complex::from(x.x) + p * x.y, p);
        (self.stroh.a() * Vector2::new(at(p0) * q[0], at(p1) * q[1])).map(|u| u.re)
    }
    /// Displacement at `x` beside a crack −a < x < a on y = 0, free of traction: f = √(z²−a²) − z,
    /// B q = (σ_xy, σ_yy).
    pub fn crack(&self, a: f64, x: &Vector2<f64>) -> Vector2<f64> {
        let root = |z: Complex<f64>, _| ((z - a).sqrt() * (z + a).sqrt()) - z;
        let load = Vector2::new(self.stress[(0, 1)], self.stress[(1, 1)]).map(Complex::from);
        self.uniform(x) + self.disturbance(x, root, load)
    }
    /// Displacement at `x` outside a hole of radius r about the origin, free of traction: f = 1/ζ
    /// with z = ½ r [(1 − ip) ζ + (1 + ip)/ζ], which is |ζ| = 1 on the hole;
    /// B q = r (iσ_xx − σ_xy, iσ_xy − σ_yy).
    pub fn hole(&self, r: f64, x: &Vector2<f64>) -> Vector2<f64> {
        let i = Complex::i();
        let inverse = |z: Complex<f64>, p: Complex<f64>| {
            let root = (z * z - (p * p + 1.0) * r * r).sqrt();
            let zeta: [Complex<f64>; 2] = [z + root, z - root].map(|s| s / ((-i * p + 1.0) * r));
            let outer = if zeta[0].norm() >= zeta[1].norm() { zeta[0] } else { zeta[1] };
            outer.inv()
        };
        let s = &self.stress;
        let load =
            Vector2::new(i * s[(0, 0)] - s[(0, 1)], i * s[(0, 1)] - s[(1, 1)]) * Complex::from(r);
        self.uniform(x) + self.disturbance(x, inverse, load)
    }
}

/// A square cut out of the infinite plate, with the exact displacement prescribed in a collar of two
/// horizons and two cells outside.
#[derive(Debug, Clone, Copy)]
pub struct Square {
    /// Half the edge inside the collar, in metres.
    pub half: f64,
    /// Spacing in metres.
    pub dx: f64,
    /// Horizon over spacing.
    pub m: f64,
    /// Weights of the cells that the horizon cuts.
    pub quadrature: Quadrature,
}

/// The body of a [`Square`].
pub type Plate<T, M, P> = Body<T, 2, Lattice<T, 2>, M, P>;

impl Square {
    /// Solves the square without what `keep` drops, with `exact` prescribed outside.
    ///
    /// # Errors
    /// What the body or the solver refuses.
    pub fn solve<T: Real, M: Material<T, 2>, P: DamagePolicy<T, 2, M>>(
        &self,
        (material, policy): (M, P),
        statics: Statics,
        keep: impl Fn(&SVector<f64, 2>) -> bool,
        exact: impl Fn(&SVector<f64, 2>) -> SVector<f64, 2>,
    ) -> Result<(Plate<T, M, P>, Solved)> {
        let collar = 2.0 * (self.m + 1.0) * self.dx;
        let shape = Cuboid::centred([2.0 * (self.half + collar); 2])?;
        let grid = Grid::new(&shape, self.dx)?.retain(keep)?;
        let family = Lattice::<T, 2>::new(&grid, Horizon::Cells(self.m), self.quadrature)?;
        let mut body = Body::new(family, material, policy)?;
        let mut loads = Loads::new();
        for node in grid.select(|x| x.amax() > self.half).iter() {
            let one = NodeSet::from_nodes([node], grid.len())?;
            let u = exact(&grid.position(node));
            loads = loads.displacement(&one, 0, u[0]).displacement(&one, 1, u[1]);
        }
        let solved = statics.solve(&mut body, loads)?;
        Ok((body, solved))
    }
    /// Errors of the displacements inside over the largest displacement, and where.
    pub fn errors(
        &self,
        grid: &Grid<2>,
        u: impl Fn(usize) -> SVector<f64, 2>,
        exact: impl Fn(&SVector<f64, 2>) -> SVector<f64, 2>,
    ) -> Vec<(SVector<f64, 2>, f64)> {
        let size = grid.positions().map(|x| exact(&x).norm()).fold(0.0, f64::max);
        let apart =
            grid.positions().enumerate().map(|(i, x)| (x, (u(i) - exact(&x)).norm() / size));
        apart.filter(|(x, _)| x.amax() < self.half).collect()
    }
}

/// Hoop stress in Pa at an angle on a hole of this radius about the origin, by a quadratic fit to the
/// displacements within `window`.
pub fn hoop(
    (grid, u): (&Grid<2>, impl Fn(usize) -> SVector<f64, 2>),
    stiffness: &Stiffness<2>,
    radius: f64,
    degrees: f64,
    window: f64,
) -> f64 {
    let (sine, cosine) = degrees.to_radians().sin_cos();
    let edge = SVector::from([cosine, sine]) * radius;
    let (mut normal, mut right) = (SMatrix::<f64, 6, 6>::zeros(), SMatrix::<f64, 6, 2>::zeros());
    for node in grid.select(|x| (x - edge).norm() < window).iter() {
        let d = (grid.position(node) - edge) / window;
        let row = SVector::<f64, 6>::from([1.0, d.x, d.y, d.x * d.x, d.x * d.y, d.y * d.y]);
        normal += row * row.transpose();
        right += row * u(node).transpose();
    }
    let fit = normal.try_inverse().map_or(SMatrix::zeros(), |inverse| inverse * right);
    let h = SMatrix::<f64, 2, 2>::from_fn(|i, j| fit[(1 + j, i)] / window);
    let t = SVector::from([-sine, cosine]);
    t.dot(&(stiffness.contract(&((h + h.transpose()) * 0.5)) * t))
}
