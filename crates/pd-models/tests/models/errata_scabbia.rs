//! Errata of Scabbia, Zaccariotto & Galvanetto 2024 (`docs/errata.md`): the corrected forms hold,
//! the printed ones do not.

use super::averages;

use approx::assert_relative_eq;
use averages::{circle, sphere};
use nalgebra::{Matrix3, Vector2, Vector3};
use pd_core::InfluenceFunction;
use pd_models::elasticity::catalogue::{
    GLASS_EPOXY, GRAPHITE_FABRIC_CARBON, GRAPHITE_FABRIC_CARBON_SOLID, pps_carbon,
};
use pd_models::{Isotropic, Orthotropic, PlaneMode, PolynomialMicromoduli, Stiffness};

const INFLUENCE: InfluenceFunction = InfluenceFunction::Gaussian;

/// The composite of Table 1 with its fibres at 20°, in the plane.
fn composite() -> Stiffness<2> {
    Stiffness::<2>::lamina(&GRAPHITE_FABRIC_CARBON).unwrap().rotated(20_f64.to_radians())
}

/// The stiffness that bonds of micromodulus k alone have under homogeneous strain: the average of
/// k n_i n_j n_k n_l. The other part, λ, adds only to pairs of shear components.
fn bond_stiffness(k: impl Fn(&Vector2<f64>) -> f64, index: [usize; 4]) -> f64 {
    circle(|n| k(n) * index.iter().map(|&i| n[i]).product::<f64>())
}

const PLANE: [[usize; 4]; 5] =
    [[0, 0, 0, 0], [1, 1, 1, 1], [0, 0, 1, 1], [0, 0, 0, 1], [1, 1, 0, 1]];

/// (30a–e): k gives back every component that λ does not touch.
#[test]
fn eq30_plane_micromoduli_return_the_stiffness() {
    let c = composite();
    let model = PolynomialMicromoduli::plane(&c, 1.0, INFLUENCE).unwrap();
    for index @ [i, j, k, l] in PLANE {
        let got = bond_stiffness(|n| model.micromodulus(n), index);
        assert_relative_eq!(got, c.c(i, j, k, l), epsilon = 1e-12 * c.voigt().amax());
    }
}

/// (30c): without its C_xxxx term the worst component is wrong by 39 % of the largest one.
#[test]
fn eq30c_without_its_lost_term_is_wrong() {
    let c = composite();
    let model = PolynomialMicromoduli::plane(&c, 1.0, INFLUENCE).unwrap();
    let lost = -10.0 * c.c(0, 0, 0, 0);
    let printed = |n: &Vector2<f64>| model.micromodulus(n) - lost * (n.x * n.y).powi(2);
    let error =
        PLANE.map(|index @ [i, j, k, l]| (bond_stiffness(printed, index) - c.c(i, j, k, l)).abs());
    let worst = error.into_iter().fold(0.0, f64::max) / c.voigt().amax();
    assert_relative_eq!(worst, 0.39, epsilon = 0.005);
}

/// (B.2): the coefficients of k_xxxx, k_xxyy, k_yyyy and of k_xxxy, k_yyxy.
#[test]
fn eq_b2_coefficients() {
    let average = |x: i32, y: i32| 128.0 * circle(|n| n.x.powi(x) * n.y.powi(y));
    let line = |x: i32, y: i32, monomials: &[(i32, i32)]| -> Vec<f64> {
        monomials.iter().map(|&(p, q)| average(x + p, y + q).round()).collect()
    };
    let even = [(4, 0), (2, 2), (0, 4)];
    assert_eq!(line(2, 2, &even), [5.0, 3.0, 5.0], "C_xxyy");
    assert_eq!(line(0, 4, &even), [3.0, 5.0, 35.0], "C_yyyy");
    assert_eq!(line(3, 1, &[(3, 1), (1, 3)]), [5.0, 3.0], "C_xxxy");
}

/// (34a–o), (C.2): the same in space, for solids turned away from their axes.
#[test]
fn eq34_solid_micromoduli_return_the_stiffness() {
    let turn = nalgebra::Rotation3::from_euler_angles(0.3, -0.7, 1.1);
    let fabric = Stiffness::<3>::orthotropic(&GRAPHITE_FABRIC_CARBON_SOLID).unwrap();
    for solid in [fabric, pps_carbon().unwrap()] {
        let c = solid.rotated(&turn);
        let model = PolynomialMicromoduli::solid(&c, 1.0, INFLUENCE).unwrap();
        let scale = c.voigt().amax();
        for i in 0..3 {
            for a in 0..3 {
                for b in a..3 {
                    let got = sphere(|n: &Vector3<f64>| {
                        model.micromodulus(n) * n[i] * n[i] * n[a] * n[b]
                    });
                    assert_relative_eq!(got, c.c(i, i, a, b), epsilon = 1e-12 * scale);
                }
            }
        }
    }
}

/// (44): the plane-stress stiffness is the inverse of the compliance, C11 = E1/(1 − ν12ν21).
#[test]
fn eq44_inverse_of_the_compliance() {
    for (ply, effect) in [(GLASS_EPOXY, -0.060), (GRAPHITE_FABRIC_CARBON, -0.0005)] {
        let coupling = -ply.nu12 / ply.e1;
        let mut compliance =
            Matrix3::from_diagonal(&[1.0 / ply.e1, 1.0 / ply.e2, 1.0 / ply.g12].into());
        compliance[(0, 1)] = coupling;
        compliance[(1, 0)] = coupling;
        let c = Stiffness::<2>::lamina(&ply).unwrap().voigt();
        assert_relative_eq!(c * compliance, Matrix3::identity(), epsilon = 1e-12);
        let printed = ply.e1 / (1.0 + ply.nu12 * ply.nu12 * ply.e2 / ply.e1);
        assert_relative_eq!(printed / c[(0, 0)] - 1.0, effect, epsilon = 5e-4);
    }
    let c = Stiffness::<2>::lamina(&GLASS_EPOXY).unwrap();
    assert_relative_eq!(c.c(0, 0, 0, 0), 45.404e9, max_relative = 1e-5);
}

/// (48): the denominator of space has only minus signs and the product ν21 ν32 ν13.
#[test]
fn eq48_denominator() {
    let Orthotropic { e1, e2, e3, nu12, nu13, nu23, .. } = GRAPHITE_FABRIC_CARBON_SOLID;
    let (nu21, nu31, nu32) = (nu12 * e2 / e1, nu13 * e3 / e1, nu23 * e3 / e2);
    let pairs = nu12 * nu21 + nu13 * nu31 + nu23 * nu32;
    let right = 1.0 - pairs - 2.0 * nu21 * nu32 * nu13;
    let printed_product = 1.0 - pairs - 2.0 * nu21 * nu31 * nu23;
    let c11 = Stiffness::<3>::orthotropic(&GRAPHITE_FABRIC_CARBON_SOLID).unwrap().c(0, 0, 0, 0);
    let error = |denominator: f64| (e1 * (1.0 - nu23 * nu32) / denominator / c11 - 1.0).abs();
    assert!(error(right) < 1e-13);
    assert!(error(printed_product) > 1e-6, "{:e}", error(printed_product));
}

/// (49), (50d): C_zzxy = cs(C1133 − C2233), and the zeros of a solid turned about z.
#[test]
fn eq50d_sign() {
    let own = Stiffness::<3>::orthotropic(&GRAPHITE_FABRIC_CARBON_SOLID).unwrap();
    let phi = 0.4_f64;
    let c = own.rotated_about_z(phi);
    let right = phi.cos() * phi.sin() * (own.c(0, 0, 2, 2) - own.c(1, 1, 2, 2));
    let printed = phi.cos() * phi.sin() * (own.c(0, 0, 2, 2) + own.c(1, 1, 2, 2));
    let scale = own.voigt().amax();
    assert_relative_eq!(c.c(2, 2, 0, 1), right, epsilon = 1e-14 * scale);
    assert!((c.c(2, 2, 0, 1) - printed).abs() > 1e-3 * scale);
    assert_relative_eq!(c.c(1, 2, 0, 1), 0.0, epsilon = 1e-14 * scale);
}

/// §6.2: which components a turn by 90° exchanges.
#[test]
fn section_6_2_symmetries() {
    let own = Stiffness::<3>::orthotropic(&GRAPHITE_FABRIC_CARBON_SOLID).unwrap();
    let (phi, quarter, scale) = (0.4, std::f64::consts::FRAC_PI_2, own.voigt().amax());
    let (c, d) = (own.rotated_about_z(phi), own.rotated_about_z(phi + quarter));
    assert_relative_eq!(c.c(1, 1, 0, 1), -d.c(0, 0, 0, 1), epsilon = 1e-14 * scale);
    assert_relative_eq!(c.c(1, 2, 1, 2), d.c(0, 2, 0, 2), epsilon = 1e-14 * scale);
}

/// (16)–(19): the regular form has the same coefficient of θ as the printed one.
#[test]
fn eq16_to_19_regular_form() {
    for nu in [-0.3, 0.0, 0.2, 0.4] {
        let solid = Isotropic::from_young_poisson(1.0, nu).unwrap();
        let (bulk, g) = (solid.bulk(), solid.shear());
        let alpha = 8.0 * g;
        let extra = g * (nu + 1.0).powi(2) / (9.0 * (2.0 * nu - 1.0).powi(2));
        for (mode, c_theta, k) in [
            (PlaneMode::PlaneStress, 2.0 * (1.0 - 2.0 * nu) / (1.0 - nu), bulk + extra),
            (PlaneMode::PlaneStrain, 2.0, bulk + g / 9.0),
        ] {
            // Both multiply |ξ| Σ ω|ζ| e βV/m.
            let printed = c_theta.powi(2) * (k - 2.0 * alpha / (3.0 * c_theta) + alpha / 9.0);
            let regular = 4.0 * solid.plane_bulk(mode) - alpha;
            assert_relative_eq!(printed, regular, epsilon = 1e-12);
        }
    }
}
