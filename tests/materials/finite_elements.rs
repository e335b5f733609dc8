//! The testkit's own finite elements meet the histories of an independent code: edge crack in a
//! plate with fibres at 30° (Hattori §6.1), read at two distances behind the tip.
use pd_testkit::fem::table;
use pd_testkit::quads::Quads;
use peridynamics::models::elasticity::catalogue::{GRAPHITE_EPOXY, GRAPHITE_EPOXY_DENSITY};
use peridynamics::prelude::*;

#[test]
fn opening_of_an_edge_crack() {
    let stiffness =
        Stiffness::<2>::lamina(&GRAPHITE_EPOXY).expect("ply").rotated(30_f64.to_radians());
    let reference = table("hattori61_30");
    let edge = 1e-3;
    let materials = [(stiffness, GRAPHITE_EPOXY_DENSITY)];
    let mut plate = Quads::new(([0.0, -0.05], [100, 100], edge), &materials, |_| Some(0), 0.05);
    for (v, x) in plate.v.iter_mut().zip(&plate.x) {
        v[1] = 250.0 * x[1];
    }
    let end = 60e-6;
    let steps = (end / (0.9 * plate.stable_step())).ceil();
    let times = &reference["t"];
    let (mut apart, mut whole, mut next) = ([0.0; 2], [0.0; 2], 1);
    for k in 1..=steps as usize {
        plate.step(end / steps);
        let t = end * k as f64 / steps;
        // The reference in steps of 1 µs, which is some ten steps here.
        while next < times.len() && times[next] <= t {
            for (r, name) in [(5e-3, "r5mm"), (2e-3, "r2mm")].into_iter().enumerate() {
                let columns = ["dux", "duy"].map(|u| reference[&format!("{u}_{}", name.1)][next]);
                let exact = SVector::<f64, 2>::from(columns);
                apart[r] += (plate.opening(0.05 - name.0) - exact).norm_squared();
                whole[r] += exact.norm_squared();
            }
            next += 1;
        }
    }
    assert!(next > 50, "only {next} times were compared");
    // Elements five times as large as those of the reference: 2 mm are two of them.
    let error: [f64; 2] = [0, 1].map(|r: usize| f64::sqrt(apart[r] / whole[r]));
    assert!(error[0] < 0.04 && error[1] < 0.09, "{error:?}");
}
