//! A free block of n³ nodes at unit spacing set in smooth motion, 100 steps of velocity Verlet:
//! the problem of `block.lmp`, which `compare.sh` runs in LAMMPS.
//!
//! `cargo bench --bench peers -- MODEL n FIELD` (MODEL `pmb` or `lps`; FIELD what `block.lmp`
//! wrote) prints processor seconds of the time loop on one thread with damage and without, ns per
//! directed bond and step likewise, and the largest difference of the displacements from FIELD
//! relative to the largest displacement; without FIELD the times alone.

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

/// Seconds of the time loop, directed bonds and the displacements after it.
fn run<M, P>(n: usize, material: &M, damage: P) -> (f64, f64, Displacements)
where
    M: Material<f64, 3>,
    P: for<'a> DamagePolicy<f64, 3, &'a M>,
{
    let family = Lattice::new(&block(n), Horizon::Cells(HORIZON), Quadrature::None);
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
    let u = (0..body.nodes()).map(|i| body.displacement(i)).collect();
    (time, 2.0 * body.family().bonds() as f64, u)
}

/// Times and displacements with a critical stretch of 1, which nothing reaches, and without
/// damage; both must have the same bits.
fn times(n: usize, material: &impl Material<f64, 3>) -> ([f64; 2], f64, Displacements) {
    let damage = Breaking::new(CriticalStretch::new(1.0).expect("criterion"));
    let (with, bonds, u) = run(n, material, damage);
    let (without, _, bare) = run(n, material, NoDamage);
    assert!(u == bare, "a criterion that breaks nothing changed the displacements");
    ([with, without], bonds, u)
}

/// Largest difference from the field that LAMMPS wrote (x, u a line) over the largest
/// displacement.
fn difference(u: &Displacements, n: usize, path: &str) -> f64 {
    let text = std::fs::read_to_string(path).expect("a field to compare with");
    let grid = block(n);
    let (mut largest, mut apart, mut met) = (0.0_f64, 0.0_f64, vec![false; grid.len()]);
    // Nine lines of head: time, count, box, columns.
    for line in text.lines().skip(9) {
        let row: Vec<f64> =
            line.split_whitespace().map(|x| x.parse().expect("a number")).collect();
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
    apart / largest
}

fn main() {
    let words: Vec<String> = std::env::args().skip(1).filter(|a| !a.starts_with("--")).collect();
    let model = words.first().map_or("pmb", String::as_str);
    let n = words.get(1).map_or(20, |n| n.parse().expect("nodes along an edge"));
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("pool");
    let ([with, without], bonds, u) = pool.install(|| match model {
        "pmb" => {
            let pmb = Pmb::solid(&moduli(0.6 * BULK), 1.0, InfluenceFunction::Constant);
            times(n, &Ordinary::new(pmb.expect("material")))
        }
        "lps" => {
            let lps = LinearSolid::solid(&moduli(SHEAR), 1.0, InfluenceFunction::Inverse);
            times(n, &Ordinary::new(lps.expect("material")))
        }
        other => panic!("pmb or lps, not {other}"),
    });
    let per_bond = |seconds: f64| 1e9 * seconds / (bonds * STEPS as f64);
    print!("{with:.4} {without:.4} {:.3} {:.3}", per_bond(with), per_bond(without));
    match words.get(2) {
        Some(path) => println!(" {:.2e}", difference(&u, n, path)),
        None => println!(),
    }
}
