//! Infinite anisotropic plates with a crack or a circular hole under remote stress, in closed form.
//!
//! With the Stroh roots p_k, matrices A and B of the material and z_k = x + p_k y, the disturbance of
//! the uniform field is u = Re[A ⟨f(z_k)⟩ q]. Not for isotropic materials, whose A and B are singular:
//! make one modulus differ by a thousandth.

use nalgebra::{Complex, Matrix2, SMatrix, SVector, Vector2};
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
