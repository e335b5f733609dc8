//! A million unknowns in 3D: time and memory of the static solver.
//! `cargo test --release --test statics large -- --ignored --nocapture`
use crate::common;
use peridynamics::prelude::*;
use std::time::Instant;

/// Peak memory of this process in bytes, where the system tells it.
fn peak() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM"))?;
    Some(line.split_whitespace().nth(1)?.parse::<f64>().ok()? * 1024.0)
}

#[test]
#[ignore = "some minutes"]
fn a_million_unknowns() {
    let cells = 70.0;
    let grid = Grid::new(&Cuboid::centred([cells; 3]).expect("box"), 1.0).expect("grid");
    let family = Lattice::<f64, 3>::new(&grid, Horizon::Cells(3.0), Quadrature::Exact);
    let model = PositiveSplit::solid(&common::solid(), 1e3, common::OMEGA).expect("material");
    let material = Ordinary::linearised(model);
    let start = Instant::now();
    let mut body = Body::new(family.expect("family"), material, NoDamage).expect("body");
    println!("{} nodes, set up in {:.1} s", body.nodes(), start.elapsed().as_secs_f64());
    let (left, right) = (grid.select(|x| x[0] < -32.0), grid.select(|x| x[0] > 32.0));
    let loads = Loads::new().clamp::<3>(&left).body_force(&right, 1, 1e6);
    let start = Instant::now();
    let solver = Statics::new().with_tolerance(1e-6).expect("tolerance");
    let solved = solver.solve(&mut body, loads).expect("solved");
    let seconds = start.elapsed().as_secs_f64();
    println!("{} unknowns: {solved:?}, {seconds:.1} s", 3 * body.nodes());
    let force = peridynamics::core::run::reaction(&body, &left)[1];
    let total = 1e6 * right.len() as f64;
    assert!((force + total).abs() < 1e-4 * total, "{force:e} against {total:e}");
    let bytes = peak().unwrap_or(f64::NAN);
    println!(
        "peak memory {:.2} GB, body {:.2} GB",
        bytes / 1e9,
        body.memory().total() as f64 / 1e9
    );
    assert!(bytes.is_nan() || bytes < 4e9);
}
