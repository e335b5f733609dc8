//! A body spins freely through 100 turns with finite kinematics: angular momentum stays to 10⁻¹⁰, the
//! energy and the shape stay.
use super::*;

/// Rim speed over the wave speed: strains of its square.
const RIM: f64 = 0.05;

/// Σ m (y × v) in the plane xy.
fn angular_momentum<const D: usize>(body: &dyn Specimen<D>) -> f64 {
    (0..body.nodes())
        .map(|i| {
            let (y, v) = (body.position(i) + body.displacement(i), body.velocity(i));
            body.mass(i) * (y[0] * v[1] - y[1] * v[0])
        })
        .sum()
}

/// Spins a body about its middle for `turns` turns.
fn spin<const D: usize>(name: &str, body: &mut dyn Specimen<D>, turns: f64) {
    let n = body.nodes();
    let middle = (0..n).map(|i| body.position(i)).sum::<SVector<f64, D>>() / n as f64;
    let radius = (0..n).map(|i| (body.position(i) - middle).norm()).fold(0.0, f64::max);
    let rate = RIM * C / radius;
    let turning = |x: &SVector<f64, D>| {
        let r = x - middle;
        let mut v = SVector::<f64, D>::zeros();
        (v[0], v[1]) = (-rate * r[1], rate * r[0]);
        v
    };
    body.launch(&turning);
    let before = angular_momentum(body);
    let time = turns * std::f64::consts::TAU / rate;
    // The critical step is that at rest; stretched by turning the body is as stiff but for ε.
    let dt = body.run(Loads::new(), TimeStep::Safety(0.9), 1).expect("step");
    body.run(Loads::new(), TimeStep::Fixed(dt), (time / dt) as usize - 1).expect("run");
    let off = angular_momentum(body) / before - 1.0;
    println!("{name}, {D}D: {} steps, angular momentum off by {off:.1e}", (time / dt) as usize);
    assert!(off.abs() < 1e-10, "{name}: {off:e}");
    // Every node is as far from the middle as it was, but for strains of about (RIM · 4)²: shear waves
    // of the ply are four times as slow. (Correspondence without control drifts in its zero-energy
    // modes, at no cost.)
    let controlled = !["Saint-Venant-Kirchhoff", "neo-Hookean"].contains(&name);
    for i in 0..n {
        let x = body.position(i) - middle;
        let stretch = (x + body.displacement(i)).norm() / x.norm();
        assert!(!controlled || (stretch - 1.0).abs() < 0.2, "{name}, node {i}: {stretch}");
    }
    let energy = body.kinetic_energy() + body.strain_energy();
    let wanted = 0.5 * before * rate;
    assert!((energy / wanted - 1.0).abs() < 1e-3, "{name}: energy {}", energy / wanted);
}

const FINITE: [&str; 7] = [
    "bonds",
    "bonds on their family",
    "linear solid",
    "Madenci-Oterkus",
    "positive split",
    "Saint-Venant-Kirchhoff",
    "neo-Hookean",
];

/// Spins a plate of every material in `names`.
fn plates_turn(names: &[&str], turns: f64) {
    let points = cloud([5, 4], DX, 0.0, 1.0, 0).expect("points");
    let recipe = Recipe { points, horizon: 2.0 * DX, ..plate() };
    for (name, mut body) in all(recipe.specimens::<f64>()) {
        if names.contains(&name) {
            spin(name, &mut *body, turns);
        }
    }
}

/// Spins a block of every finite material.
fn blocks_turn(turns: f64) {
    for (name, mut body) in all(block().specimens::<f64>()) {
        if FINITE.contains(&name) {
            spin(name, &mut *body, turns);
        }
    }
}

#[test]
fn a_hundred_turns() {
    plates_turn(&["linear solid", "Saint-Venant-Kirchhoff"], 100.0);
}

#[test]
fn every_finite_material_turns() {
    plates_turn(&FINITE, 2.0);
    blocks_turn(1.0);
}

/// `cargo test --release --test extremes -- --ignored every_finite_material --nocapture`
#[test]
#[ignore = "minutes"]
fn every_finite_material_turns_a_hundred_times() {
    plates_turn(&FINITE, 100.0);
    blocks_turn(100.0);
}
