//! Stiffness from constants: inverse compliance, the errata of the printed closed forms, action
//! on strains, plane stress and plane strain.

use super::common::random;

use approx::assert_relative_eq;
use nalgebra::{Matrix3, Matrix6, SMatrix, Vector3, Vector6};
use pd_models::elasticity::catalogue::{
    GLASS_EPOXY, GRAPHITE_EPOXY, GRAPHITE_FABRIC_CARBON, GRAPHITE_FABRIC_CARBON_SOLID, HTA_6376,
    hattori_inclusion, pps_carbon, steel,
};
use pd_models::elasticity::voigt::{strain_to_voigt, stress_to_voigt};
use pd_models::{Isotropic, Lamina, Orthotropic, PlaneMode, Stiffness, TransverselyIsotropic};
use proptest::prelude::*;

fn ply_compliance(ply: &Lamina) -> Matrix3<f64> {
    let Lamina { e1, e2, g12, nu12 } = *ply;
    Matrix3::new(1.0 / e1, -nu12 / e1, 0.0, -nu12 / e1, 1.0 / e2, 0.0, 0.0, 0.0, 1.0 / g12)
}

fn solid_compliance(m: &Orthotropic) -> Matrix6<f64> {
    let shear = [1.0 / m.g23, 1.0 / m.g13, 1.0 / m.g12];
    let mut s = Matrix6::from_diagonal(&Vector6::new(
        1.0 / m.e1,
        1.0 / m.e2,
        1.0 / m.e3,
        shear[0],
        shear[1],
        shear[2],
    ));
    for (i, j, value) in [(0, 1, m.nu12 / m.e1), (0, 2, m.nu13 / m.e1), (1, 2, m.nu23 / m.e2)] {
        s[(i, j)] = -value;
        s[(j, i)] = -value;
    }
    s
}

#[test]
fn plies_invert_their_compliance() {
    for ply in [HTA_6376, GRAPHITE_EPOXY, GRAPHITE_FABRIC_CARBON, GLASS_EPOXY] {
        let product = Stiffness::<2>::lamina(&ply).unwrap().voigt() * ply_compliance(&ply);
        assert_relative_eq!(product, Matrix3::identity(), epsilon = 1e-14);
    }
}

#[test]
fn solids_invert_their_compliance() {
    let solid = GRAPHITE_FABRIC_CARBON_SOLID;
    let product = Stiffness::<3>::orthotropic(&solid).unwrap().voigt() * solid_compliance(&solid);
    assert_relative_eq!(product, Matrix6::identity(), epsilon = 1e-14);
}

proptest! {
    /// The closed form of the library against a numeric inverse, wherever it is admissible.
    #[test]
    fn orthotropic_is_the_inverse_compliance(
        e in proptest::array::uniform3(1e8..1e12_f64),
        g in proptest::array::uniform3(1e8..1e12_f64),
        r in proptest::array::uniform3(-0.55..0.55_f64),
    ) {
        let nu = |i: usize, j: usize, r: f64| r * (e[i] / e[j]).sqrt();
        let solid = Orthotropic {
            e1: e[0], e2: e[1], e3: e[2],
            nu12: nu(0, 1, r[0]), nu13: nu(0, 2, r[1]), nu23: nu(1, 2, r[2]),
            g12: g[2], g13: g[1], g23: g[0],
        };
        // |r| ≤ 0.55: 1 − a² − b² − c² − 2abc may be negative, and then it is refused.
        let determinant = 1.0 - r.iter().map(|r| r * r).sum::<f64>() - 2.0 * r[0] * r[1] * r[2];
        let stiffness = Stiffness::<3>::orthotropic(&solid);
        prop_assume!(determinant.abs() > 1e-6);
        prop_assert_eq!(stiffness.is_ok(), determinant > 0.0);
        if let Ok(stiffness) = stiffness {
            let exact = solid_compliance(&solid).try_inverse().unwrap();
            let scale = exact.diagonal().map(f64::sqrt);
            let error = (stiffness.voigt() - exact).component_div(&(scale * scale.transpose()));
            prop_assert!(error.amax() < 1e-9, "{error}");
        }
    }
}

/// Errata 004-9: Scabbia Eq. 44 prints 1 + ν12ν21 and gives 42.680 GPa for Table 2.
#[test]
fn erratum_004_9() {
    let c = Stiffness::<2>::lamina(&GLASS_EPOXY).unwrap();
    assert_relative_eq!(c.c(0, 0, 0, 0), 45.404e9, max_relative = 1e-5);
    // Hattori §6.1 by his Eq. 34 (errata 000-12).
    let c = Stiffness::<2>::lamina(&GRAPHITE_EPOXY).unwrap();
    for (value, gpa) in [
        (c.c(0, 0, 0, 0), 145.3178),
        (c.c(0, 0, 1, 1), 2.465786),
        (c.c(1, 1, 1, 1), 11.74184),
        (c.c(0, 1, 0, 1), 9.66),
    ] {
        assert_relative_eq!(value, gpa * 1e9, max_relative = 5e-7);
    }
}

/// Errata 004-10: right denominator and all of Eqs. 48; the printed one is 1.3 % off for Table 1.
#[test]
fn erratum_004_10() {
    let m = GRAPHITE_FABRIC_CARBON_SOLID;
    let (nu21, nu31, nu32) = (m.nu12 * m.e2 / m.e1, m.nu13 * m.e3 / m.e1, m.nu23 * m.e3 / m.e2);
    let minus = m.nu12 * nu21 + m.nu13 * nu31 + m.nu23 * nu32;
    let d = 1.0 - minus - 2.0 * nu21 * nu32 * m.nu13;
    let c = Stiffness::<3>::orthotropic(&m).unwrap();
    for (i, j, numerator) in [
        (0, 0, m.e1 * (1.0 - m.nu23 * nu32)),
        (1, 1, m.e2 * (1.0 - m.nu13 * nu31)),
        (2, 2, m.e3 * (1.0 - m.nu12 * nu21)),
        (0, 1, m.e2 * (m.nu12 + m.nu13 * nu32)),
        (0, 2, m.e3 * (m.nu13 + m.nu12 * m.nu23)),
        (1, 2, m.e3 * (m.nu23 + nu21 * m.nu13)),
    ] {
        assert_relative_eq!(c.c(i, i, j, j), numerator / d, max_relative = 1e-14);
    }
    let printed = 1.0 + minus + 2.0 * nu21 * nu31 * m.nu23;
    assert_relative_eq!(d / printed - 1.0, -0.013, epsilon = 1e-3);
}

#[test]
fn transverse_isotropy_is_isotropic_about_the_fibre() {
    let m = TransverselyIsotropic { e1: 136e9, e2: 8.75e9, g12: 5.5e9, nu12: 0.3, nu23: 0.45 };
    let c = Stiffness::<3>::transversely_isotropic(&m).unwrap();
    for degrees in [17.0_f64, 45.0, 90.0, 133.0] {
        let turn = nalgebra::Rotation3::from_axis_angle(&Vector3::x_axis(), degrees.to_radians());
        let (a, b) = (c.voigt(), c.rotated(&turn).voigt());
        assert_relative_eq!(a, b, epsilon = 1e-14 * m.e1);
    }
    // Pulled along the fibre: E1 and ν12; condensed to the plane it is the ply.
    let s = c.voigt().try_inverse().unwrap();
    assert_relative_eq!(1.0 / s[(0, 0)], m.e1, max_relative = 1e-13);
    assert_relative_eq!(-s[(1, 0)] / s[(0, 0)], m.nu12, max_relative = 1e-13);
    let ply = Stiffness::<2>::lamina(&Lamina { e1: m.e1, e2: m.e2, g12: m.g12, nu12: m.nu12 });
    let plane = c.plane(PlaneMode::PlaneStress).unwrap().voigt();
    assert_relative_eq!(plane, ply.unwrap().voigt(), epsilon = 1e-13 * m.e1);
}

#[test]
fn components_are_read_row_by_row() {
    let c = Stiffness::<2>::from_components([20.0, 2.0, 3.0, 30.0, 5.0, 40.0]).unwrap();
    let matrix = Matrix3::new(20.0, 2.0, 3.0, 2.0, 30.0, 5.0, 3.0, 5.0, 40.0);
    assert_eq!(c.voigt(), matrix);
    assert_eq!(c.c(0, 0, 1, 0), 3.0);
    assert_eq!(c.c(0, 1, 1, 1), 5.0);

    let constants: [f64; 21] = std::array::from_fn(|n| n as f64 / 10.0);
    let mut upper = Matrix6::zeros();
    let mut next = constants.iter();
    for r in 0..6 {
        for s in r..6 {
            upper[(r, s)] = *next.next().unwrap();
        }
    }
    let mut matrix = upper + upper.transpose();
    let mut constants = constants;
    for (r, n) in [0, 6, 11, 15, 18, 20].into_iter().enumerate() {
        constants[n] += 20.0;
        matrix[(r, r)] = upper[(r, r)] + 20.0;
    }
    let c = Stiffness::<3>::from_components(constants).unwrap();
    assert_eq!(c.voigt(), matrix);
    assert_eq!(c, Stiffness::<3>::from_voigt(matrix).unwrap());
    assert_eq!(c.c(1, 2, 0, 2), matrix[(3, 4)]);
}

/// Names of the catalogue against the numbers of the papers, where the Voigt order matters.
#[test]
fn matrices_of_the_papers() {
    let pps = pps_carbon().unwrap();
    let gpa = |i, j, k, l| pps.c(i, j, k, l) / 1e9;
    assert_relative_eq!(gpa(1, 2, 1, 2), 2.78, max_relative = 1e-15);
    assert_relative_eq!(gpa(0, 2, 0, 2), 3.28, max_relative = 1e-15);
    assert_relative_eq!(gpa(0, 1, 0, 1), 5.8, max_relative = 1e-15);
    assert_relative_eq!(gpa(0, 0, 1, 1), 6.7, max_relative = 1e-15);
    assert_relative_eq!(gpa(0, 0, 2, 2), 6.4, max_relative = 1e-15);
    assert_relative_eq!(gpa(1, 1, 2, 2), 6.3, max_relative = 1e-15);
    // Errata 000-18: eigenvalues 1.94, 28.2, 235 GPa, ν12 = C12/C22 = 1.845.
    let c = hattori_inclusion().unwrap().voigt() / 1e9;
    let mut values: Vec<f64> = c.symmetric_eigenvalues().iter().copied().collect();
    values.sort_by(f64::total_cmp);
    for (value, expected) in values.into_iter().zip([1.94, 28.2, 235.06]) {
        assert_relative_eq!(value, expected, max_relative = 1e-3);
    }
    assert_relative_eq!(c[(0, 1)] / c[(1, 1)], 1.845, max_relative = 1e-12);
}

proptest! {
    #[test]
    fn stress_and_energy_follow_the_voigt_matrix(
        c2 in random::stiffness2(), e2 in random::symmetric::<2>(),
        c3 in random::stiffness3(), e3 in random::symmetric::<3>(),
    ) {
        let strain = strain_to_voigt::<f64, 2, 3>(&e2);
        let stress = c2.voigt() * strain;
        prop_assert!((stress_to_voigt::<f64, 2, 3>(&c2.contract(&e2)) - stress).amax() < 1e-4);
        prop_assert!((c2.energy(&e2) - 0.5 * stress.dot(&strain)).abs() < 1e-4);
        prop_assert!(c2.energy(&e2) > 0.0);

        let strain = strain_to_voigt::<f64, 3, 6>(&e3);
        let stress = c3.voigt() * strain;
        prop_assert!((stress_to_voigt::<f64, 3, 6>(&c3.contract(&e3)) - stress).amax() < 1e-4);
        prop_assert!((c3.energy(&e3) - 0.5 * stress.dot(&strain)).abs() < 1e-4);
        prop_assert!(c3.energy(&e3) > 0.0);
    }

    /// In single precision: to its own rounding.
    #[test]
    fn stress_in_single_precision(c in random::stiffness3(), e in random::symmetric::<3>()) {
        let single = c.contract(&e.map(|x| x as f32)).map(f64::from);
        prop_assert!((single - c.contract(&e)).amax() < 1e-6 * c.voigt().amax() * 9.0);
    }

    /// Plane strain: ε_zz = ε_yz = ε_xz = 0. Plane stress: those stresses are 0.
    #[test]
    fn plane_bodies_are_bodies_of_space(c in random::stiffness3(), e in random::symmetric::<2>()) {
        let strain = c.plane(PlaneMode::PlaneStrain).unwrap();
        let mut full = SMatrix::<f64, 3, 3>::zeros();
        full.fixed_view_mut::<2, 2>(0, 0).copy_from(&e);
        let in_plane = c.contract(&full).fixed_view::<2, 2>(0, 0).into_owned();
        prop_assert!((strain.contract(&e) - in_plane).amax() < 1e-4);

        let stress = c.plane(PlaneMode::PlaneStress).unwrap();
        let sigma = stress.contract(&e);
        let column = Vector6::new(sigma[(0, 0)], sigma[(1, 1)], 0.0, 0.0, 0.0, sigma[(0, 1)]);
        let solution = c.voigt().lu().solve(&column).unwrap();
        let plane = strain_to_voigt::<f64, 2, 3>(&e);
        let back = Vector3::new(solution[0], solution[1], solution[5]);
        prop_assert!((back - plane).amax() < 1e-6, "{back} {plane}");
        // Releasing the normal stress cannot make the body stiffer.
        prop_assert!(stress.energy(&e) <= strain.energy(&e) * (1.0 + 1e-12));
    }
}

#[test]
fn isotropic_bodies() {
    for (young, nu) in [(206.84e9, 0.29), (1.0, -0.9), (3e6, 0.4999), (70e9, 0.0)] {
        let moduli = Isotropic::from_young_poisson(young, nu).unwrap();
        let solid = Stiffness::<3>::isotropic(&moduli).unwrap();
        let strain = SMatrix::<f64, 3, 3>::new(1.0, 0.3, -0.2, 0.3, -2.0, 0.7, -0.2, 0.7, 0.4);
        let stress = SMatrix::<f64, 3, 3>::identity() * (moduli.lame() * strain.trace())
            + strain * (2.0 * moduli.shear());
        let scale = moduli.lame().abs() + moduli.shear();
        assert_relative_eq!(solid.contract(&strain), stress, epsilon = 1e-14 * scale);
        for mode in [PlaneMode::PlaneStress, PlaneMode::PlaneStrain] {
            let direct = Stiffness::<2>::isotropic(&moduli, mode).unwrap().voigt();
            let reduced = solid.plane(mode).unwrap().voigt();
            // Condensation subtracts numbers of the size of K.
            assert_relative_eq!(direct, reduced, epsilon = 1e-14 * solid.voigt().amax());
        }
    }
    // Plane stress: E/(1−ν²), ν E/(1−ν²), G.
    let steel = steel().unwrap();
    let c = Stiffness::<2>::isotropic(&steel, PlaneMode::PlaneStress).unwrap().voigt();
    let e = 206.84e9 / (1.0 - 0.29 * 0.29);
    let textbook = Matrix3::new(e, 0.29 * e, 0.0, 0.29 * e, e, 0.0, 0.0, 0.0, 206.84e9 / 2.58);
    assert_relative_eq!(c, textbook, epsilon = 1e-4);
}
