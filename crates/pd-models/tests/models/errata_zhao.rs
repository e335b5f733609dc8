//! Errata of Zhao, Tang & Xue 2017 (`docs/errata.md`).

use approx::assert_relative_eq;
use std::f64::consts::{FRAC_PI_2, PI};

/// Crack tip opening of Dugdale and of Bilby, Cottrell & Swinden at r = σ/σ_Y, in units of a σ_Y/E.
fn bcs(r: f64) -> f64 {
    8.0 / PI * (1.0 / (FRAC_PI_2 * r).cos()).ln()
}

/// (19): 4σa/E, the opening at the crack's centre, exceeds the tip opening most at small loads.
#[test]
fn eq19_is_not_the_tip_opening() {
    for (r, ratio) in [(0.1, 12.7), (0.5, 2.27), (0.8, 1.07)] {
        assert_relative_eq!(4.0 * r / bcs(r), ratio, max_relative = 5e-3);
    }
}

/// The tip opening tends to K²/(Eσ_Y) = G/σ_Y at small loads, with K² = σ²πa.
#[test]
fn tip_opening_at_small_loads() {
    let r = 1e-3;
    assert_relative_eq!(bcs(r), PI * r * r, max_relative = 1e-5);
}
