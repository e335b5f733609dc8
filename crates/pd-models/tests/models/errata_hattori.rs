//! Errata of Hattori, Trevelyan & Coombs 2018 (`docs/errata.md`): the corrected forms hold, the
//! printed ones do not.

use approx::assert_relative_eq;
use nalgebra::{Matrix2, Vector2};
use pd_core::shape::{IllConditioned, ShapePolicy};
use pd_core::{Influence, InfluenceFunction};
use pd_models::correspondence::{Constitutive, Hyperelastic};
use pd_models::elasticity::catalogue::{GRAPHITE_EPOXY, GRAPHITE_EPOXY_DENSITY, hattori_inclusion};
use pd_models::{SaintVenantKirchhoff, Stiffness};

fn ply() -> Stiffness<2> {
    Stiffness::<2>::lamina(&GRAPHITE_EPOXY).unwrap()
}

/// A large displacement gradient with rotation and shear.
fn gradient() -> Matrix2<f64> {
    Matrix2::new(0.12, 0.30, -0.18, -0.07)
}

/// (3): P:Ḟ = J σ:d for every rate, so P = J σ F⁻ᵀ.
#[test]
fn eq3_first_piola_kirchhoff_is_conjugate_to_the_rate() {
    let law = SaintVenantKirchhoff(ply());
    let (h, rate) = (gradient(), Matrix2::new(0.3, -1.1, 0.7, 0.4));
    let f = h + Matrix2::identity();
    let (p, sigma): (Matrix2<f64>, Matrix2<f64>) = (law.stress(&h), law.cauchy(&h));
    let power = p.component_mul(&rate).sum();
    let velocity_gradient = rate * f.try_inverse().unwrap();
    let spatial = f.determinant() * sigma.component_mul(&velocity_gradient).sum();
    assert_relative_eq!(power, spatial, max_relative = 1e-12);
    assert_relative_eq!(sigma, sigma.transpose(), max_relative = 1e-12);
    assert_relative_eq!(
        p,
        f.determinant() * sigma * f.try_inverse().unwrap().transpose(),
        max_relative = 1e-12
    );
    let printed = f.determinant() * sigma;
    assert!((printed.component_mul(&rate).sum() / spatial - 1.0).abs() > 0.05);
}

/// (22): P_iJ = ∂W/∂F_iJ, first index spatial, without a transpose.
#[test]
fn eq22_stress_is_the_energy_gradient() {
    let law = SaintVenantKirchhoff(ply());
    let (h, step) = (gradient(), 1e-6);
    let p: Matrix2<f64> = law.stress(&h);
    let energy = |i: usize, j: usize, by: f64| {
        let mut moved = h;
        moved[(i, j)] += by;
        law.energy(&moved)
    };
    let slope = Matrix2::from_fn(|i, j| (energy(i, j, step) - energy(i, j, -step)) / (2.0 * step));
    assert!((slope - p).amax() < 1e-7 * p.amax());
    assert!((slope - p.transpose()).amax() > 0.05 * p.amax());
}

/// (23): T = ω P B ξ gives ∫ T ⊗ Y = P Fᵀ, which is symmetric: no couple. Pᵀ leaves one.
#[test]
fn eq23_without_a_transpose_no_couple() {
    let f = gradient() + Matrix2::identity();
    let p: Matrix2<f64> = SaintVenantKirchhoff(ply()).stress(&gradient());
    let couple = |p: Matrix2<f64>| {
        let moment = p * f.transpose();
        (moment[(0, 1)] - moment[(1, 0)]).abs() / moment.amax()
    };
    assert!(couple(p) < 1e-14);
    assert!(couple(p.transpose()) > 0.05);
}

/// (16): a bond as long as the horizon weighs nothing: 0, 8 and 24 active bonds for m = 1, 2, 3.
#[test]
fn eq16_active_bonds() {
    let active = |m: i32| {
        let places = (-m..=m).flat_map(|i| (-m..=m).map(move |j| f64::from(i * i + j * j).sqrt()));
        let weight = |r: f64| InfluenceFunction::Linear.weight(r / f64::from(m));
        places.filter(|&r| r > 0.0 && weight(r) > 0.0).count()
    };
    assert_eq!([1, 2, 3].map(active), [0, 8, 24]);
}

/// (19): every collinear family is singular, whatever its direction.
#[test]
fn eq19_any_collinear_family_is_singular() {
    let policy = ShapePolicy { rule: IllConditioned::Refuse, ..ShapePolicy::default() };
    for angle in [0.0, 0.3, 1.2] {
        let along = Vector2::new(f64::cos(angle), f64::sin(angle));
        assert!(policy.invert(&(along * along.transpose()), 0, 2).is_err());
    }
}

/// (32): with v(t) the map of an oscillator grows by √(1 + (ωΔt)²) a step at every Δt; with
/// v(t+Δt) it does not grow up to ωΔt = 2.
#[test]
fn eq32_printed_scheme_is_unstable() {
    for z in [1e-3, 0.1, 1.0, 1.9] {
        // (u, v Δt) after a step, z = ωΔt.
        let printed = Matrix2::new(1.0, 1.0, -z * z, 1.0);
        let right = Matrix2::new(1.0 - z * z, 1.0, -z * z, 1.0);
        let radius = |m: Matrix2<f64>| {
            m.complex_eigenvalues().iter().map(|x| x.re.hypot(x.im)).fold(0.0, f64::max)
        };
        assert_relative_eq!(radius(printed), 1.0_f64.hypot(z), max_relative = 1e-12);
        assert_relative_eq!(radius(right), 1.0, max_relative = 1e-12);
    }
}

/// (34) is plane stress with engineering shear.
#[test]
fn eq34_plane_stress() {
    let c = ply().voigt();
    for ((row, column), value) in
        [((0, 0), 145.3178e9), ((0, 1), 2.465786e9), ((1, 1), 11.74184e9), ((2, 2), 9.66e9)]
    {
        assert_relative_eq!(c[(row, column)], value, max_relative = 1e-6);
    }
}

/// (28), (35), (36): the fibre's stiffness lies along +θ, not −θ.
#[test]
fn eq35_fibre_at_plus_theta() {
    let theta = 0.5_f64;
    let c = ply().rotated(theta);
    let along = |angle: f64| {
        let n = Vector2::new(angle.cos(), angle.sin());
        (c.contract(&(n * n.transpose())) * n).dot(&n)
    };
    assert_relative_eq!(along(theta), ply().c(0, 0, 0, 0), max_relative = 1e-12);
    assert!(along(-theta) < 0.5 * along(theta));
}

/// §6: c_p = √(C22/ρ) is not the fastest wave unless the fibres lie along y.
#[test]
fn wave_speed() {
    for (degrees, factor) in [(0.0_f64, 3.52), (30.0, 2.47), (90.0, 1.0)] {
        let c = ply().rotated(degrees.to_radians());
        let printed = (c.c(1, 1, 1, 1) / GRAPHITE_EPOXY_DENSITY).sqrt();
        let fastest = c.max_wave_speed(GRAPHITE_EPOXY_DENSITY).unwrap();
        assert_relative_eq!(fastest / printed, factor, epsilon = 0.005);
    }
}

/// (40): usable, but ν12 = 1.845 and G12 = 14.5 E2.
#[test]
fn eq40_unusual_constants() {
    let compliance = hattori_inclusion().unwrap().voigt().try_inverse().unwrap();
    assert_relative_eq!(-compliance[(0, 1)] / compliance[(0, 0)], 1.845, max_relative = 1e-3);
    assert_relative_eq!(compliance[(1, 1)] / compliance[(2, 2)], 14.5, max_relative = 1e-2);
}
