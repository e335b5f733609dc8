//! A neo-Hookean body keeps its digits at small strains: energy and stress are those of linear
//! elasticity to the order of the strain, in `f32` too. (W and P were differences of numbers of order
//! one: in `f32` the energy was wrong by a fifth at a strain of 10⁻⁴, by 36 times itself at 10⁻⁵.)
use peridynamics::models::Hyperelastic;
use peridynamics::prelude::*;

fn small<T: Real, const D: usize>(size: f64, tolerance: f64) {
    let moduli = Isotropic::from_young_poisson(70e9, 0.3).expect("moduli");
    let law = NeoHookean::new(&moduli);
    let h = SMatrix::<f64, D, D>::from_fn(|i, j| size * (1.0 + (i * D + 2 * j) as f64 * 0.3));
    let strain = (h + h.transpose()) * 0.5;
    let stress = SMatrix::<f64, D, D>::identity() * (moduli.lame() * strain.trace())
        + strain * (2.0 * moduli.shear());
    let energy = 0.5 * stress.dot(&strain);
    let cast = h.map(T::of);
    let found = Constitutive::<T, D>::stress(&law, &cast).map(|x| x.to_f64());
    let off = (found - stress).norm() / stress.norm();
    assert!(off < tolerance, "{} {D}D, strain {size:e}: stress off by {off:e}", T::NAME);
    let off = Hyperelastic::<T, D>::energy(&law, &cast).to_f64() / energy - 1.0;
    assert!(off.abs() < tolerance, "{} {D}D, strain {size:e}: energy off by {off:e}", T::NAME);
}

#[test]
fn small_strains_keep_their_digits() {
    for size in [1e-3, 1e-5, 1e-8] {
        // Second order, and rounding.
        small::<f64, 2>(size, 20.0 * size + 1e-14);
        small::<f64, 3>(size, 20.0 * size + 1e-14);
        small::<f32, 2>(size, 20.0 * size + 1e-6);
        small::<f32, 3>(size, 20.0 * size + 1e-6);
    }
}

/// P = ∂W/∂F by differences, and W = 0 with P = 0 at rest; both sides of where the series ends.
#[test]
fn stress_is_the_gradient_of_the_energy() {
    let law = NeoHookean::new(&Isotropic::from_young_poisson(70e9, 0.3).expect("moduli"));
    for size in [0.0, 1e-3, 4e-3, 0.3, 1.0, -0.4] {
        let h = SMatrix::<f64, 3, 3>::from_fn(|i, j| {
            size * if i == j { 1.0 } else { 0.2 * (i as f64 - 0.5 * j as f64) }
        });
        let energy = |h: &SMatrix<f64, 3, 3>| Hyperelastic::<f64, 3>::energy(&law, h) / 70e9;
        let gradient = SMatrix::<f64, 3, 3>::from_fn(|i, j| {
            let moved = |step: f64| {
                let mut h = h;
                h[(i, j)] += step;
                energy(&h)
            };
            (moved(1e-5) - moved(-1e-5)) / 2e-5
        });
        let stress = Constitutive::<f64, 3>::stress(&law, &h) / 70e9;
        let off = (stress - gradient).norm() / (1e-3 + stress.norm());
        assert!(off < 1e-7, "{size}: {off:e}");
    }
}
