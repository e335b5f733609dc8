//! The acoustic tensor of each bond controls zero-energy modes; what it costs.

use super::common;

use common::{DENSITY, KERNELS, plies, symbol};
use pd_core::symbol::Stability;
use pd_core::{InfluenceFunction, Quadrature, Symbol};
use pd_models::{BondAssociated, Correspondence, LinearElastic, WanControl};
use std::f64::consts::PI;

#[test]
fn no_wave_is_free_and_the_time_step_is_longer_than_with_wan_control() {
    for (name, degrees, c) in plies() {
        for (m, influence) in KERNELS {
            let material = BondAssociated::<2, 3>::new(&c, DENSITY, influence).unwrap();
            let own: Symbol<2> = symbol(&material, m, Quadrature::None);
            let own = own.extremes(40);
            let Stability::Stable(softest) = own.stability() else {
                panic!("{name} {degrees}° m = {m}: {}", own.stability())
            };
            let slowest = c.waves(&softest.wave, DENSITY).unwrap().last().unwrap().speed;
            let lifted = softest.eigenvalue / (slowest * softest.wave.norm()).powi(2);
            // Not as low as the bare material, whose zone corners cost nothing.
            assert!(lifted > 0.5, "{name} {degrees}° m = {m}: {lifted}");
            let wan = Correspondence::new(LinearElastic(c), DENSITY, influence)
                .unwrap()
                .with_control(WanControl::new(&c, 1.0).unwrap());
            let wan: Symbol<2> = symbol(&wan, m, Quadrature::None);
            let ratio = own.stiffest.eigenvalue / wan.max_frequency().powi(2);
            assert!((0.2..0.9).contains(&ratio), "{name} {degrees}° m = {m}: {ratio}");
        }
    }
}

#[test]
fn strength_zero_is_correspondence_without_control() {
    let (_, _, c) = plies().remove(0);
    let influence = InfluenceFunction::Linear;
    let bare = Correspondence::new(LinearElastic(c), DENSITY, influence).unwrap();
    let own = BondAssociated::<2, 3>::new(&c, DENSITY, influence).unwrap();
    let own = own.with_strength(0.0).unwrap();
    let wave = nalgebra::Vector2::new(0.7 * PI, -0.3 * PI) / common::DX;
    let a: Symbol<2> = symbol(&bare, 3.0, Quadrature::None);
    let b: Symbol<2> = symbol(&own, 3.0, Quadrature::None);
    let (a, b) = (a.stiffness(&wave), b.stiffness(&wave));
    assert!((a - b).norm() < 1e-12 * a.norm(), "{a} {b}");
}
