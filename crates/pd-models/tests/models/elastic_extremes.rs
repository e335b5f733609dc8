//! Extreme but admissible stiffnesses are taken; inadmissible ones are refused with the reason.

use approx::assert_relative_eq;
use nalgebra::{Matrix3, Matrix6};
use pd_models::elasticity::catalogue::{GRAPHITE_FABRIC_CARBON_SOLID, HTA_6376};
use pd_models::{
    Error, Isotropic, Lamina, Orthotropic, PlaneMode, Stiffness, TransverselyIsotropic,
};

fn refused<X: std::fmt::Debug>(result: pd_models::Result<X>, parts: &[&str]) {
    let text = result.unwrap_err().to_string();
    for part in parts {
        assert!(text.contains(part), "'{part}' is not in: {text}");
    }
    assert!(!text.contains('\n') && !text.contains('\\'), "{text}");
}

#[test]
fn moduli_a_million_apart() {
    for ratio in [1e2, 1e4, 1e6] {
        let ply = Lamina { e1: 1e11, e2: 1e11 / ratio, g12: 5e9, nu12: 0.3 };
        let c = Stiffness::<2>::lamina(&ply).unwrap();
        for degrees in [0.0_f64, 30.0, 45.0, 90.0] {
            let turned = c.rotated(degrees.to_radians());
            let values = turned.voigt().symmetric_eigenvalues();
            assert!(values.min() > 0.0, "E1/E2 = {ratio}, {degrees}°: {values}");
            Stiffness::<2>::from_voigt(turned.voigt()).unwrap();
        }
        // Across: E2 to the last digits, although E1 is a million times larger.
        let d = 1.0 - 0.09 / ratio;
        assert_relative_eq!(c.c(1, 1, 1, 1), ply.e2 / d, max_relative = 1e-15);

        let solid =
            TransverselyIsotropic { e1: 1e11, e2: 1e11 / ratio, g12: 5e9, nu12: 0.3, nu23: 0.4 };
        let c = Stiffness::<3>::transversely_isotropic(&solid).unwrap().rotated_about_z(0.5);
        Stiffness::<3>::from_voigt(c.voigt()).unwrap();
        c.plane(PlaneMode::PlaneStress).unwrap();
        c.plane(PlaneMode::PlaneStrain).unwrap();
    }
}

#[test]
fn nearly_incompressible_and_auxetic() {
    for nu in [-0.999, -0.9, 0.0, 0.49, 0.4999, 0.499999] {
        let moduli = Isotropic::from_young_poisson(1e6, nu).unwrap();
        let c = Stiffness::<3>::isotropic(&moduli).unwrap().voigt();
        // Shear: G; dilation: 3K.
        let normal = c.fixed_view::<3, 3>(0, 0).into_owned().symmetric_eigenvalues();
        let (small, large) = (2.0 * moduli.shear(), 3.0 * moduli.bulk());
        assert_relative_eq!(normal.min(), small.min(large), max_relative = 1e-8);
        assert_relative_eq!(normal.max(), small.max(large), max_relative = 1e-12);
        for mode in [PlaneMode::PlaneStress, PlaneMode::PlaneStrain] {
            Stiffness::<2>::isotropic(&moduli, mode).unwrap();
        }
    }
    // ½ to rounding: K/G is beyond double precision.
    let liquid = Isotropic::from_young_poisson(1e6, 0.5 - 1e-15).unwrap();
    refused(Stiffness::<3>::isotropic(&liquid), &["not symmetric positive definite"]);
}

#[test]
fn any_unit_of_stress() {
    for scale in [1e-100, 1e-9, 1.0, 1e100, 1e300] {
        let Lamina { e1, e2, g12, nu12 } = HTA_6376;
        let [e1, e2, g12] = [e1, e2, g12].map(|e| e / 1e11 * scale);
        let c = Stiffness::<2>::lamina(&Lamina { e1, e2, g12, nu12 }).unwrap();
        let d = 1.0 - 0.09 * 8.75 / 136.0;
        assert_relative_eq!(c.c(0, 0, 0, 0) / scale, 1.36 / d, max_relative = 1e-14);
    }
}

#[test]
fn a_matrix_that_is_not_positive_definite_is_refused_with_its_eigenvalue() {
    // Eigenvalues 1 ± 2 and 1.
    let c = Matrix3::new(1.0, 2.0, 0.0, 2.0, 1.0, 0.0, 0.0, 0.0, 1.0);
    match Stiffness::<2>::from_voigt(c * 1e9) {
        Err(Error::NotPositiveDefinite { eigenvalue, largest }) => {
            assert_relative_eq!(eigenvalue, -1e9, max_relative = 1e-12);
            assert_relative_eq!(largest, 3e9, max_relative = 1e-12);
        }
        other => panic!("{other:?}"),
    }
    let parts = ["not symmetric positive definite", "smallest eigenvalue is -", "Voigt order"];
    refused(Stiffness::<2>::from_voigt(c * 1e9), &parts);
    // All eigenvalues negative, none, and a negative shear modulus, counted twice as a tensor.
    for (factor, expected) in [(-1.0, -2.0), (0.0, 0.0)] {
        match Stiffness::<3>::from_voigt(Matrix6::identity() * factor) {
            Err(Error::NotPositiveDefinite { eigenvalue, .. }) => {
                assert_relative_eq!(eigenvalue, expected, max_relative = 1e-14);
            }
            other => panic!("{other:?}"),
        }
    }
    let shear = Stiffness::<2>::from_components([3.0, 1.0, 0.0, 3.0, 0.0, -1.0]);
    match shear {
        Err(Error::NotPositiveDefinite { eigenvalue, largest }) => {
            assert_relative_eq!(eigenvalue, -2.0, max_relative = 1e-14);
            assert_relative_eq!(largest, 4.0, max_relative = 1e-14);
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn asymmetric_and_infinite_matrices() {
    let mut c = Matrix6::identity() * 5e9;
    c[(1, 4)] = 1e9;
    refused(Stiffness::<3>::from_voigt(c), &["C[1][4] = 1e9", "0e0 across"]);
    // To 1e-12 of the largest entry.
    c[(4, 1)] = 1e9 + 4e-3;
    let accepted = Stiffness::<3>::from_voigt(c).unwrap().voigt();
    assert_eq!(accepted[(1, 4)], accepted[(4, 1)]);
    c[(4, 1)] = 1e9 + 6e-3;
    assert!(matches!(
        Stiffness::<3>::from_voigt(c),
        Err(Error::NotSymmetric { row: 1, column: 4, .. })
    ));
    for value in [f64::NAN, f64::INFINITY] {
        c[(2, 2)] = value;
        refused(Stiffness::<3>::from_voigt(c), &["entry of the stiffness", "finite"]);
    }
}

#[test]
fn plies_with_inadmissible_constants() {
    let ply = |change: fn(&mut Lamina)| {
        let mut ply = HTA_6376;
        change(&mut ply);
        Stiffness::<2>::lamina(&ply)
    };
    // √(136/8.75) = 3.942.
    assert!(ply(|p| p.nu12 = 3.94).is_ok() && ply(|p| p.nu12 = -3.94).is_ok());
    refused(ply(|p| p.nu12 = 3.95), &["ν12 is 3.95", "√(E1/E2) = 3.942"]);
    refused(ply(|p| p.nu12 = -4.0), &["ν12 is -4", "√(E1/E2) = 3.942"]);
    refused(ply(|p| p.nu12 = f64::NAN), &["ν12 is NaN"]);
    refused(ply(|p| p.e1 = 0.0), &["E1 [Pa] is 0", "positive"]);
    refused(ply(|p| p.e2 = -1.0), &["E2 [Pa] is -1"]);
    refused(ply(|p| p.g12 = f64::INFINITY), &["G12 [Pa] is inf"]);
}

#[test]
fn solids_with_inadmissible_constants() {
    let solid = |change: fn(&mut Orthotropic)| {
        let mut solid = GRAPHITE_FABRIC_CARBON_SOLID;
        change(&mut solid);
        Stiffness::<3>::orthotropic(&solid)
    };
    refused(solid(|s| s.nu12 = 2.3), &["ν12 is 2.3", "√(E1/E2) = 2.28"]);
    refused(solid(|s| s.nu13 = -6.0), &["ν13 is -6", "√(E1/E3) = 5.78"]);
    refused(solid(|s| s.nu23 = 2.6), &["ν23 is 2.6", "√(E2/E3) = 2.52"]);
    refused(solid(|s| s.g23 = 0.0), &["G23 [Pa] is 0"]);
    refused(solid(|s| s.e3 = -5.0), &["E3 [Pa] is -5"]);
    // ν = 0.6 in every plane of a cubic solid: each alone is below 1, but together 1 − 2ν < 0.
    let cubic = Orthotropic {
        e1: 1e9,
        e2: 1e9,
        e3: 1e9,
        nu12: 0.6,
        nu13: 0.6,
        nu23: 0.6,
        g12: 1e9,
        g13: 1e9,
        g23: 1e9,
    };
    match Stiffness::<3>::orthotropic(&cubic) {
        Err(Error::PoissonRatios { determinant }) => {
            // (1 + ν)² (1 − 2ν).
            assert_relative_eq!(determinant, 2.56 * -0.2, max_relative = 1e-14);
        }
        other => panic!("{other:?}"),
    }
    refused(Stiffness::<3>::orthotropic(&cubic), &["not together", "must be positive"]);

    let fibre = |nu12, nu23| {
        let solid = TransverselyIsotropic { e1: 136e9, e2: 8.75e9, g12: 5.5e9, nu12, nu23 };
        Stiffness::<3>::transversely_isotropic(&solid)
    };
    refused(fibre(0.3, -1.0), &["ν23 is -1"]);
    refused(fibre(0.3, 1.1), &["ν23 is 1.1"]);
    // 1 − ν23 − 2ν12ν21 > 0: ν23 < 1 − 2·0.09·8.75/136 = 0.98842.
    assert!(fibre(0.3, 0.9884).is_ok());
    refused(fibre(0.3, 0.9885), &["not together"]);
}
