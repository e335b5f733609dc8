//! Rotation of the stiffness: material axes turned by +θ counter-clockwise.

use super::common::random;

use approx::assert_relative_eq;
use nalgebra::{Matrix2, Matrix3, Matrix6, Rotation2, Rotation3, Vector3};
use pd_models::elasticity::catalogue::{
    GLASS_EPOXY, GRAPHITE_EPOXY, GRAPHITE_FABRIC_CARBON, GRAPHITE_FABRIC_CARBON_SOLID, pps_carbon,
};
use pd_models::elasticity::voigt::stress_to_voigt;
use pd_models::{PlaneMode, Stiffness};
use proptest::prelude::*;
use std::f64::consts::FRAC_PI_2;

/// Stresses in fibre axes, Hattori Eq. 28.
fn hattori_28(theta: f64) -> Matrix3<f64> {
    let (s, c) = theta.sin_cos();
    Matrix3::new(
        c * c,
        s * s,
        2.0 * c * s,
        s * s,
        c * c,
        -2.0 * c * s,
        -c * s,
        c * s,
        c * c - s * s,
    )
}

proptest! {
    /// Stress of the turned ply, brought to fibre axes by Eq. 28, is that of the ply itself under
    /// the strain brought to fibre axes. With the printed Eqs. 35, 36 it is not (errata 000-14).
    #[test]
    fn agrees_with_the_stress_rotation(theta in -4.0..4.0_f64, e in random::symmetric::<2>()) {
        let ply = Stiffness::<2>::lamina(&GRAPHITE_EPOXY).unwrap();
        let turn = Rotation2::new(theta).into_inner();
        let fibre_stress = ply.contract(&(turn.transpose() * e * turn));
        let expected = stress_to_voigt::<f64, 2, 3>(&fibre_stress);
        let in_fibre_axes = |c: &Stiffness<2>| {
            hattori_28(theta) * stress_to_voigt::<f64, 2, 3>(&c.contract(&e))
        };
        let scale = 1e-13 * ply.voigt().amax();
        prop_assert!((in_fibre_axes(&ply.rotated(theta)) - expected).amax() < 4.0 * scale);
        let printed = in_fibre_axes(&ply.rotated(-theta));
        if (2.0 * theta).sin().abs() > 0.1 && e.norm() > 0.1 {
            prop_assert!((printed - expected).amax() > 1e6 * scale);
        }
    }

    #[test]
    fn turning_is_a_group(c in random::stiffness3(), a in -4.0..4.0_f64, b in -4.0..4.0_f64,
        axis in proptest::array::uniform3(-1.0..1.0_f64)) {
        let axis = Vector3::from(axis);
        prop_assume!(axis.norm() > 0.1);
        let turn = |angle| Rotation3::new(axis.normalize() * angle);
        let scale = 1e-13 * c.voigt().amax();
        let twice = c.rotated(&turn(a)).rotated(&turn(b));
        let once = c.rotated(&turn(a + b));
        prop_assert!((twice.voigt() - once.voigt()).amax() < 4.0 * scale);
        let back = c.rotated(&turn(a)).rotated(&turn(-a));
        prop_assert!((back.voigt() - c.voigt()).amax() < 4.0 * scale);
        // Exactly symmetric, and still positive definite.
        prop_assert_eq!(once.voigt(), once.voigt().transpose());
        prop_assert!(Stiffness::<3>::from_voigt(once.voigt()).is_ok());
    }

    /// σ(R ε Rᵀ) = R σ(ε) Rᵀ: the definition, in space, of every one of the 21 constants.
    #[test]
    fn the_turned_body_in_turned_strain(c in random::stiffness3(), e in random::symmetric::<3>(),
        r in proptest::array::uniform3(-3.0..3.0_f64)) {
        let turn = Rotation3::new(Vector3::from(r));
        let m = turn.matrix();
        let there = c.rotated(&turn).contract(&(m * e * m.transpose()));
        let here = m * c.contract(&e) * m.transpose();
        prop_assert!((there - here).amax() < 1e-13 * 9.0 * c.voigt().amax());
        prop_assert!((c.rotated(&turn).energy(&(m * e * m.transpose())) / c.energy(&e) - 1.0).abs() < 1e-9);
    }

    /// Reducing to the plane and turning about z exchange.
    #[test]
    fn plane_and_turn_commute(c in random::stiffness3(), phi in -4.0..4.0_f64) {
        for mode in [PlaneMode::PlaneStress, PlaneMode::PlaneStrain] {
            let a = c.rotated_about_z(phi).plane(mode).unwrap().voigt();
            let b = c.plane(mode).unwrap().rotated(phi).voigt();
            prop_assert!((a - b).amax() < 1e-9 * c.voigt().amax());
        }
    }
}

/// Scabbia Eqs. 46a–f, and 50a–g with 50d as corrected (errata 004-11).
#[test]
fn scabbia_forms() {
    let own = Stiffness::<3>::orthotropic(&GRAPHITE_FABRIC_CARBON_SOLID).unwrap();
    for degrees in [-110.0_f64, -25.0, 0.0, 20.0, 45.0, 90.0, 163.0] {
        let phi = degrees.to_radians();
        let (s, c) = phi.sin_cos();
        let turned = own.rotated_about_z(phi);
        let k = |i: usize, j: usize| own.c(i - 1, i - 1, j - 1, j - 1);
        let (c11, c22, c12, c66) = (k(1, 1), k(2, 2), k(1, 2), own.c(0, 1, 0, 1));
        let (c44, c55) = (own.c(1, 2, 1, 2), own.c(0, 2, 0, 2));
        let (a, b) = (c11 - c12 - 2.0 * c66, c22 - c12 - 2.0 * c66);
        let mixed = 2.0 * c * c * s * s * (c12 + 2.0 * c66);
        let (c4, s4, c2s2) = (c.powi(4), s.powi(4), c * c * s * s);
        let (x, y, z) = (0, 1, 2);
        for (name, (i, j, k, l), expected) in [
            ("46a", (x, x, x, x), c4 * c11 + mixed + s4 * c22),
            ("46b", (y, y, y, y), c4 * c22 + mixed + s4 * c11),
            ("46c", (x, x, y, y), (c4 + s4) * c12 + c2s2 * (c11 + c22 - 4.0 * c66)),
            ("46d", (x, y, x, y), (c4 + s4) * c66 + c2s2 * (c11 + c22 - 2.0 * c12 - 2.0 * c66)),
            ("46e", (x, x, x, y), c.powi(3) * s * a - c * s.powi(3) * b),
            ("46f", (y, y, x, y), c * s.powi(3) * a - c.powi(3) * s * b),
            ("50a", (z, z, z, z), k_zz(&own)),
            ("50b", (x, x, z, z), c * c * k(1, 3) + s * s * k(2, 3)),
            ("50c", (y, y, z, z), c * c * k(2, 3) + s * s * k(1, 3)),
            ("50d corrected", (z, z, x, y), c * s * (k(1, 3) - k(2, 3))),
            ("50e", (x, z, x, z), c * c * c55 + s * s * c44),
            ("50f", (y, z, y, z), c * c * c44 + s * s * c55),
            ("50g", (x, z, y, z), c * s * (c55 - c44)),
            ("monoclinic", (x, x, y, z), 0.0),
            ("monoclinic", (z, z, x, z), 0.0),
            ("monoclinic", (x, y, x, z), 0.0),
        ] {
            let value = turned.c(i, j, k, l);
            assert!(
                (value - expected).abs() < 1e-15 * 4.0 * c11,
                "{name} at {degrees}°: {value:e}"
            );
        }
    }
}

fn k_zz(c: &Stiffness<3>) -> f64 {
    c.c(2, 2, 2, 2)
}

/// Turned stiffnesses computed by an independent code (upper triangles, GPa; the numbers of the
/// reference cases `nosb_2d_hattori30`, `osb_aniso_2d_composite20`, `osb_aniso_2d_glassepoxy40`
/// and `osb_aniso_3d_composite20`).
#[test]
#[allow(clippy::excessive_precision)] // all the digits the other code printed
fn independent_values() {
    let ply = |ply, degrees: f64| {
        Stiffness::<2>::lamina(&ply).unwrap().rotated(degrees.to_radians()).voigt() / 1e9
    };
    let symmetric =
        |u: [f64; 6]| Matrix3::new(u[0], u[1], u[2], u[1], u[3], u[4], u[2], u[4], u[5]);
    let hattori = [
        90.6448059244672,
        23.74480185125131,
        41.20549223957201,
        23.856818369642155,
        16.63460165054539,
        30.939015443705025,
    ];
    assert_relative_eq!(ply(GRAPHITE_EPOXY, 30.0), symmetric(hattori), epsilon = 1e-13 * 100.0);
    let composite = [
        139.54787259613672,
        18.369119925741333,
        42.9697687956829,
        32.298055157473907,
        2.0268723326233711,
        26.55758466074141,
    ];
    assert_relative_eq!(
        ply(GRAPHITE_FABRIC_CARBON, 20.0),
        symmetric(composite),
        epsilon = 1e-13 * 100.0
    );
    let glass = [
        23.003955135582996,
        12.017778549395317,
        9.94225776480775,
        17.00108890260828,
        7.079715301525505,
        11.857142514948135,
    ];
    assert_relative_eq!(ply(GLASS_EPOXY, 40.0), symmetric(glass), epsilon = 1e-13 * 100.0);

    let solid = Stiffness::<3>::orthotropic(&GRAPHITE_FABRIC_CARBON_SOLID).unwrap();
    let solid = solid.rotated_about_z(20.0_f64.to_radians()).voigt() / 1e9;
    #[rustfmt::skip]
    let expected = Matrix6::new(
        139.86396776357138, 18.603220100167557, 1.2825569962641046, 0.0, 0.0, 43.004169779878784,
        18.603220100167557, 32.471429815843903, 0.949862090501822, 0.0, 0.0, 2.0523497116862907,
        1.2825569962641044, 0.949862090501822, 5.203978479063921, 0.0, 0.0, 0.13958208635984552,
        0.0, 0.0, 0.0, 3.8283982255557704, 1.6166108383616464, 0.0,
        0.0, 0.0, 0.0, 1.6166108383616464, 7.68160177444423, 0.0,
        43.00416977987879, 2.052349711686287, 0.13958208635984558, 0.0, 0.0, 26.561328557629326,
    );
    assert_relative_eq!(solid, expected, epsilon = 1e-13 * 100.0);
}

/// A quarter turn exchanges the axes, and the fibre at +30° is stiffest along +30°.
#[test]
fn sense_of_the_turn() {
    let ply = Stiffness::<2>::lamina(&GRAPHITE_EPOXY).unwrap();
    let quarter = ply.rotated(FRAC_PI_2);
    assert_relative_eq!(quarter.c(1, 1, 1, 1), ply.c(0, 0, 0, 0), max_relative = 1e-14);
    let turned = ply.rotated(30.0_f64.to_radians());
    let along = |degrees: f64| {
        let (s, c) = degrees.to_radians().sin_cos();
        turned.energy(&Matrix2::new(c * c, c * s, c * s, s * s))
    };
    assert_relative_eq!(2.0 * along(30.0), ply.c(0, 0, 0, 0), max_relative = 1e-14);
    assert!(along(30.0) > along(29.0) && along(30.0) > along(31.0));

    // In space: the axis e of the material comes to R e.
    let pps = pps_carbon().unwrap();
    let to_z = Rotation3::rotation_between(&Vector3::x(), &Vector3::z()).unwrap();
    assert_relative_eq!(pps.rotated(&to_z).c(2, 2, 2, 2), pps.c(0, 0, 0, 0), max_relative = 1e-14);
}
