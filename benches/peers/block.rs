//! A free block of n³ nodes at unit spacing set in smooth motion, 100 steps of velocity Verlet:
//! the problem of `block.lmp`, which `compare.sh` runs in LAMMPS.
//!
//! `cargo bench --bench peers -- MODEL n FIELD` (MODEL `pmb` or `lps`; FIELD what `block.lmp`
//! wrote) prints processor time of the time loop on one thread in ns per directed bond and step,
//! on a lattice with damage, without, and in a cloud with damage; then the largest difference of
//! the displacements from FIELD relative to the largest displacement. Without FIELD the times
//! alone.

use peridynamics::prelude::*;
use std::f64::consts::PI;
use std::time::Instant;

const HORIZON: f64 = 3.015;
const STEPS: usize = 100;
/// K; PMB takes G = 3K/5, its own.
const BULK: f64 = 1.0;
/// G of LPS; not 3K/5, where LPS would not depend on its dilatation.
const SHEAR: f64 = 0.5;

type Displacements = Vec<SVector<f64, 3>>;

/// Processor seconds of this thread (the wall clock where that is not told).
fn seconds() -> f64 {
    thread_local!(static START: Instant = Instant::now());
    let own = std::fs::read_to_string("/proc/thread-self/schedstat").ok();
    let own = own.and_then(|s| s.split(' ').next().and_then(|ns| ns.parse::<f64>().ok()));
    own.map_or_else(|| START.with(|start| start.elapsed().as_secs_f64()), |ns| 1e-9 * ns)
}

fn moduli(shear: f64) -> Isotropic {
    let sum = 3.0 * BULK + shear;
    let (young, poisson) = (9.0 * BULK * shear / sum, (1.5 * BULK - shear) / sum);
    Isotropic::from_young_poisson(young, poisson).expect("moduli")
}

fn block(n: usize) -> Grid<3> {
    let first = SVector::repeat(0.5 - 0.5 * n as f64);
    Grid::lattice(first, SVector::repeat(1.0), [n; 3]).expect("grid")
}

/// Seconds of the time loop per directed bond and step, and the displacements.
fn run<F, M, P>(family: Result<F>, n: usize, material: &M, damage: P) -> (f64, Displacements)
where
    F: Family<f64, 3>,
    M: Material<f64, 3>,
    P: for<'a> DamagePolicy<f64, 3, &'a M>,
{
    let mut body = Body::new(family.expect("family"), material, damage).expect("body");
    let edge = n as f64;
    body.set_velocity(|x| {
        let wave = |a: usize, b: usize| (PI * x[a] / edge).sin() * (PI * x[b] / edge).cos();
        SVector::from([0.003 * wave(0, 1), 0.0015 * wave(1, 2), 0.00075 * wave(2, 0)])
    });
    let mut run = Run::new(&mut body, Loads::new(), TimeStep::Fixed(0.2)).expect("run");
    let start = seconds();
    run.steps_more(STEPS).expect("steps");
    let time = seconds() - start;
    let body = run.body();
    assert_eq!(body.broken_bonds(), 0, "a bond broke");
    let per_bond = time / (2 * body.family().bonds() * STEPS) as f64;
    (per_bond, (0..body.nodes()).map(|i| body.displacement(i)).collect())
}

/// Times and displacements on a lattice with a critical stretch of 1, which nothing reaches, and
/// without damage, and in a cloud with damage; all three must have the same bits.
fn runs(n: usize, material: &impl Material<f64, 3>) -> ([f64; 3], Displacements) {
    let (grid, horizon) = (block(n), Horizon::Cells(HORIZON));
    let lattice = || Lattice::new(&grid, horizon, Quadrature::None);
    let damage = || Breaking::new(CriticalStretch::new(1.0).expect("criterion"));
    let (with, u) = run(lattice(), n, material, damage());
    let (without, bare) = run(lattice(), n, material, NoDamage);
    assert!(u == bare, "a criterion that breaks nothing changed the displacements");
    let points = Points::from_grid(&grid);
    let (cloud, other) = run(Cloud::new(&points, horizon, Quadrature::None), n, material, damage());
    assert!(u == other, "lattice and cloud differ");
    ([with, without, cloud], u)
}

/// Largest difference from the field that LAMMPS wrote (x, u a line) over the largest
/// displacement.
fn difference(u: &Displacements, n: usize, path: &str) -> f64 {
    let text = std::fs::read_to_string(path).expect("a field to compare with");
    let grid = block(n);
    let (mut largest, mut apart, mut met) = (0.0_f64, 0.0_f64, vec![false; grid.len()]);
    // Nine lines of head: time, count, box, columns.
    for line in text.lines().skip(9) {
        let row: Vec<f64> = line.split_whitespace().map(|x| x.parse().expect("a number")).collect();
        let theirs = SVector::from([row[3], row[4], row[5]]);
        let reference = SVector::from([row[0], row[1], row[2]]) - theirs;
        let cell = std::array::from_fn(|d| (reference[d] - grid.origin()[d]).round() as usize);
        let node = grid.node(cell).expect("a node of the block");
        assert!(!std::mem::replace(&mut met[node], true), "node {node} is there twice");
        largest = largest.max(theirs.norm());
        // Not `max`, which would drop a NaN.
        let off = (u[node] - theirs).norm();
        apart = if off <= apart { apart } else { off };
    }
    assert!(met.iter().all(|&met| met), "{path} does not hold every node");
    assert!((apart / largest).is_finite(), "{path} holds values that are not finite");
    apart / largest
}

fn main() {
    let words: Vec<String> = std::env::args().skip(1).filter(|a| !a.starts_with("--")).collect();
    let model = words.first().map_or("pmb", String::as_str);
    let n = words.get(1).map_or(20, |n| n.parse().expect("nodes along an edge"));
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("pool");
    let (times, u) = pool.install(|| match model {
        "pmb" => {
            let pmb = Pmb::solid(&moduli(0.6 * BULK), 1.0, InfluenceFunction::Constant);
            runs(n, &Ordinary::new(pmb.expect("material")))
        }
        "lps" => {
            let lps = LinearSolid::solid(&moduli(SHEAR), 1.0, InfluenceFunction::Inverse);
            runs(n, &Ordinary::new(lps.expect("material")))
        }
        other => panic!("pmb or lps, not {other}"),
    });
    for time in times {
        print!("{:.3} ", 1e9 * time);
    }
    match words.get(2) {
        Some(path) => println!("{:.2e}", difference(&u, n, path)),
        None => println!(),
    }
}
