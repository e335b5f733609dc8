//! Isotropic moduli: relations between them, and what is refused.

use approx::assert_relative_eq;
use pd_models::{Isotropic, PlaneMode};
use proptest::prelude::*;

fn message<X: std::fmt::Debug>(result: pd_models::Result<X>) -> String {
    result.unwrap_err().to_string()
}

#[test]
fn steel_by_every_pair() {
    // E = 200 GPa, ν = 1/4: K = 400/3, G = 80, λ = 80 GPa.
    let (k, g) = (400e9 / 3.0, 80e9);
    for steel in [
        Isotropic::from_young_poisson(200e9, 0.25),
        Isotropic::from_bulk_shear(k, g),
        Isotropic::from_lame(80e9, 80e9),
    ] {
        let steel = steel.unwrap();
        assert_relative_eq!(steel.young(), 200e9, max_relative = 1e-15);
        assert_relative_eq!(steel.poisson(), 0.25, max_relative = 1e-15);
        assert_relative_eq!(steel.bulk(), k, max_relative = 1e-15);
        assert_relative_eq!(steel.shear(), g, max_relative = 1e-15);
        assert_relative_eq!(steel.lame(), 80e9, max_relative = 1e-15);
        let stress = steel.plane_bulk(PlaneMode::PlaneStress);
        assert_relative_eq!(stress, 400e9 / 3.0, max_relative = 1e-15);
        assert_relative_eq!(steel.plane_bulk(PlaneMode::PlaneStrain), 160e9, max_relative = 1e-15);
    }
}

/// The pair given comes back bit for bit, however close to incompressible.
#[test]
fn the_given_pair_is_kept() {
    let rubber = Isotropic::from_bulk_shear(2.1e9, 0.3).unwrap();
    assert_eq!((rubber.bulk(), rubber.shear()), (2.1e9, 0.3));
    let rubber = Isotropic::from_young_poisson(1e6, 0.4999).unwrap();
    assert_eq!((rubber.young(), rubber.poisson()), (1e6, 0.4999));
}

proptest! {
    #[test]
    fn pairs_agree(young in 1e-3..1e13_f64, nu in -0.999..0.4999_f64) {
        let a = Isotropic::from_young_poisson(young, nu).unwrap();
        let b = Isotropic::from_bulk_shear(a.bulk(), a.shear()).unwrap();
        prop_assert!((b.young() / young - 1.0).abs() < 1e-14);
        prop_assert!((b.poisson() - nu).abs() < 1e-14);
        // κ by its textbook forms.
        let strain = young / (2.0 * (1.0 + nu) * (1.0 - 2.0 * nu));
        let stress = young / (2.0 * (1.0 - nu));
        prop_assert!((a.plane_bulk(PlaneMode::PlaneStrain) / strain - 1.0).abs() < 1e-13);
        prop_assert!((a.plane_bulk(PlaneMode::PlaneStress) / stress - 1.0).abs() < 1e-14);
    }
}

#[test]
fn inadmissible_moduli_are_named_with_their_range() {
    for nu in [0.5, -1.0, 0.7, -3.0, f64::NAN, f64::INFINITY] {
        let text = message(Isotropic::from_young_poisson(1e9, nu));
        assert!(text.contains("Poisson's ratio ν"), "{text}");
        assert!(text.contains(&nu.to_string()) && text.contains("between −1 and 1/2"), "{text}");
    }
    for young in [0.0, -2e9, f64::NAN, f64::INFINITY] {
        let text = message(Isotropic::from_young_poisson(young, 0.3));
        assert!(text.contains("Young's modulus E [Pa]"), "{text}");
        assert!(text.contains(&young.to_string()) && text.contains("positive"), "{text}");
    }
    assert!(message(Isotropic::from_bulk_shear(-1.0, 1.0)).contains("bulk modulus K [Pa] is -1"));
    assert!(message(Isotropic::from_bulk_shear(1.0, 0.0)).contains("shear modulus G [Pa] is 0"));
    // λ = −μ has K = −μ/3.
    assert!(message(Isotropic::from_lame(-3.0, 3.0)).contains("bulk modulus K [Pa] is -1"));
    // A liquid: ν is ½ to rounding.
    assert!(message(Isotropic::from_bulk_shear(1e9, 1e-12)).contains("Poisson's ratio ν is 0.5"));
}
