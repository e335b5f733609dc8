//! A free cube set in motion, 50 steps of velocity Verlet: three independent codes agree on the
//! displacements to 1e-15 (`tests/data/README.md`), and so must this one, to the rounding of its
//! polynomials (`docs/performance.md`).

use peridynamics::prelude::*;
use std::f64::consts::PI;

const CELLS: usize = 20;
const DX: f64 = 0.05;

fn cube() -> Grid<3> {
    let first = SVector::repeat(-0.5 + 0.5 * DX);
    Grid::lattice(first, SVector::repeat(DX), [CELLS; 3]).expect("grid")
}

/// Displacements after 50 steps, in steps of 0.01, of a material with ρ = 1.
fn moved<F: Family<f64, 3>>(family: F, material: impl Material<f64, 3>) -> Vec<SVector<f64, 3>> {
    let mut body = Body::new(family, material, NoDamage).expect("body");
    body.set_velocity(|x| {
        let wave = |a: usize, b: usize| (PI * x[a]).sin() * (PI * x[b]).cos();
        SVector::from([wave(0, 1), 0.5 * wave(1, 2), 0.25 * wave(2, 0)]) * 0.02
    });
    let mut run = Run::new(&mut body, Loads::new(), TimeStep::Fixed(0.01)).expect("run");
    run.steps_more(50).expect("steps");
    let body = run.body();
    (0..body.nodes()).map(|i| body.displacement(i)).collect()
}

fn lattice() -> Lattice<f64, 3> {
    Lattice::new(&cube(), Horizon::Cells(3.015), Quadrature::None).expect("family")
}

fn largest(u: &[SVector<f64, 3>]) -> f64 {
    u.iter().map(|u| u.norm()).fold(0.0, f64::max)
}

/// K = 1 with the Poisson ratio of the bond-based model.
fn pmb() -> Ordinary<Pmb> {
    let moduli = Isotropic::from_young_poisson(1.5, 0.25).expect("moduli");
    Ordinary::new(Pmb::solid(&moduli, 1.0, InfluenceFunction::Constant).expect("material"))
}

/// K = 1, G = 1/2.
fn lps(omega: impl Influence + 'static) -> Ordinary<LinearSolid> {
    let moduli = Isotropic::from_young_poisson(9.0 / 7.0, 2.0 / 7.0).expect("moduli");
    Ordinary::new(LinearSolid::solid(&moduli, 1.0, omega).expect("material"))
}

#[test]
fn largest_displacements() {
    let close = |u: Vec<SVector<f64, 3>>, expected: f64| {
        let got = largest(&u);
        assert!((got / expected - 1.0).abs() < 1e-10, "{got:e}, others have {expected:e}");
    };
    // Given with eleven digits.
    close(moved(lattice(), pmb()), 4.5584753216e-3);
    close(moved(lattice(), lps(InfluenceFunction::Constant)), 4.1765937941e-3);
    close(moved(lattice(), lps(|r: f64| 1.0 / r)), 4.0789550071e-3);
}

#[test]
fn field_of_the_bond_based_model() {
    let grid = cube();
    let points = Points::from_grid(&grid);
    let cloud = Cloud::new(&points, Horizon::Cells(3.015), Quadrature::None).expect("family");
    let u = moved(lattice(), pmb());
    assert!(moved(cloud, pmb()) == u, "lattice and cloud");
    let text = include_str!("../data/crosscode/pmb_n20_s50.csv");
    let mut rows = 0;
    for line in text.lines().skip(1) {
        let row: Vec<f64> = line.split(',').map(|x| x.parse().expect("number")).collect();
        let cell = std::array::from_fn(|d| ((row[d] + 0.5) / DX - 0.5).round() as usize);
        let node = grid.node(cell).expect("node");
        for d in 0..3 {
            let difference = (u[node][d] - row[3 + d]).abs() / largest(&u);
            // The file has 14 digits.
            assert!(difference < 1e-12, "node {node}: {} and {}", u[node][d], row[3 + d]);
        }
        rows += 1;
    }
    assert_eq!(rows, 400);
}
