//! A plane wave in the middle of a body so large that nothing from its outline arrives in time:
//! u = A p cos(k·x − ωt), with p and ω = c|k| of the classical continuum (Christoffel).

use nalgebra::{SMatrix, SVector};
use pd_core::region::Cuboid;
use pd_core::{Body, Dynamics, Family, Material, NoDamage, Real, Result};
use pd_models::{Stiffness, Wave};
use std::f64::consts::TAU;

/// A plane wave.
pub struct PlaneWave<const D: usize> {
    /// Wave vector k in 1/m.
    pub wave: SVector<f64, D>,
    /// Speed and polarisation.
    pub classical: Wave<D>,
    /// When it is looked at, in seconds.
    pub time: f64,
    /// The fastest wave of any direction, in m/s.
    fastest: f64,
}

/// How far a body's wave is from the classical one.
#[derive(Debug, Clone, Copy)]
pub struct Misfit {
    /// Root mean square of u − u_exact over that of u_exact, in the middle.
    pub displacement: f64,
    /// Relative error of the phase speed; negative for a wave that lags.
    pub speed: f64,
}

impl<const D: usize> PlaneWave<D> {
    /// A wave of this length along a direction, the fastest for `branch` 0, looked at after so many
    /// periods.
    ///
    /// # Errors
    /// What [`Stiffness::waves`] refuses.
    pub fn new(
        (stiffness, density): (&Stiffness<D>, f64),
        (direction, branch): (SVector<f64, D>, usize),
        wavelength: f64,
        periods: f64,
    ) -> Result<Self, pd_models::Error> {
        let classical = stiffness.waves(&direction, density)?[branch];
        let wave = direction.normalize() * (TAU / wavelength);
        let time = periods * wavelength / classical.speed;
        Ok(Self { wave, classical, time, fastest: stiffness.max_wave_speed(density)? })
    }
    fn wavelength(&self) -> f64 {
        TAU / self.wave.norm()
    }
    /// The body: half a wavelength around the middle plus the way of the fastest wave, with 10 % for
    /// what is faster on a lattice.
    ///
    /// # Errors
    /// None for a wave that exists.
    pub fn shape(&self) -> Result<Cuboid<D>> {
        Cuboid::centred([2.0 * (0.5 * self.wavelength() + 1.1 * self.fastest * self.time); D])
    }
    /// Lets the wave go with an amplitude of 10⁻⁶ Δx.
    pub fn start<T: Real, F: Family<T, D>, M: Material<T, D>>(
        &self,
        body: &mut Body<T, D, F, M, NoDamage>,
    ) {
        let p = self.classical.polarisation * self.amplitude(body.unit());
        let omega = self.classical.speed * self.wave.norm();
        body.set_displacement(|x| p * self.wave.dot(x).cos());
        body.set_velocity(|x| p * (omega * self.wave.dot(x).sin()));
    }
    fn amplitude(&self, unit: f64) -> f64 {
        1e-6 * unit
    }
    /// Compares the nodes within half a wavelength of the middle with the wave at time t.
    pub fn misfit<T: Real>(&self, body: &impl Dynamics<T, D>, t: f64) -> Misfit {
        let (size, radius) = (self.amplitude(body.unit()), 0.5 * self.wavelength());
        let phase = self.classical.speed * self.wave.norm() * t;
        let p = self.classical.polarisation;
        let (mut apart, mut all) = (0.0, 0.0);
        let (mut normal, mut right) = (SMatrix::<f64, 2, 2>::zeros(), SVector::<f64, 2>::zeros());
        for node in 0..body.nodes() {
            let x = body.position(node);
            if x.norm() > radius {
                continue;
            }
            let u = body.u().get(body.site(node)).map(Real::to_f64) * (body.unit() / size);
            let exact = p * (self.wave.dot(&x) - phase).cos();
            apart += (u - exact).norm_squared();
            all += exact.norm_squared();
            let (sine, cosine) = self.wave.dot(&x).sin_cos();
            let row = SVector::<f64, 2>::new(cosine, sine);
            normal += row * row.transpose();
            right += row * u.dot(&p);
        }
        // u·p ≈ a cos k·x + b sin k·x: its phase is atan2(b, a), whole turns apart.
        let fit = normal.try_inverse().map_or(SVector::zeros(), |inverse| inverse * right);
        let behind = (fit[1].atan2(fit[0]) - phase + 0.5 * TAU).rem_euclid(TAU) - 0.5 * TAU;
        Misfit { displacement: (apart / all).sqrt(), speed: behind / phase }
    }
}
