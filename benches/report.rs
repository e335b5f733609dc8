//! One table of what a step costs: model × layout × precision × dimension; then scaling to two
//! threads, cost against the number of nodes and the horizon, and setup.
//!
//! `cargo bench --bench report` prints it and writes `docs/performance.md`; words after `--` pick
//! the lines of the first table that contain all of them and write nothing (`-- LPS 3D f64`).

#[path = "scenes.rs"]
mod scenes;
use pd_testkit::clock::{machine, median};
use peridynamics::core::dispatch::{Vectorised, dispatch};
use peridynamics::prelude::*;
use scenes::{M, RHO, cloud, grid, lattice, stretch, wave};
use std::fmt::Write;
use std::hint::black_box;
use std::process::Command;
use std::time::Instant;

/// Cells along an edge of the timed bodies.
const EDGE2: usize = 256;
const EDGE3: usize = 64;
/// The same where instructions are counted.
const SMALL2: usize = 96;
const SMALL3: usize = 24;

/// 96 independent fused multiply-adds, as often as asked.
struct MultiplyAdd;

impl Vectorised<(&mut [[f64; 8]; 12], usize)> for MultiplyAdd {
    type Output = ();
    #[inline(always)]
    fn run(&self, (x, times): (&mut [[f64; 8]; 12], usize), _: bool) {
        let mut sums = *x;
        for _ in 0..times {
            for sum in &mut sums {
                for l in 0..8 {
                    sum[l] = sum[l].mul_add(0.999, 1e-3);
                }
            }
        }
        *x = sums;
    }
}

/// FMA in GFLOP/s of one core, f64.
fn fma_peak() -> f64 {
    let (mut x, times) = ([[1.0; 8]; 12], 20_000);
    let seconds = median(5, || dispatch(&MultiplyAdd, (black_box(&mut x), times)));
    2e-9 * (96 * times) as f64 / seconds
}

/// Bandwidth of a = b + s c in GB/s of one core, over 3 × 64 MB.
fn triad() -> f64 {
    let n = 8 << 20;
    let (mut a, b, c) = (vec![0.0; n], vec![1.0; n], vec![2.0; n]);
    let seconds = median(5, || {
        let (b, c) = (black_box(&b), black_box(&c));
        for i in 0..n {
            a[i] = b[i] + 3.0 * c[i];
        }
        black_box(&mut a);
    });
    24e-9 * n as f64 / seconds
}

/// Runs steps of one scene in small and prints its directed bonds: what [`instructions`] counts.
struct Counted {
    name: String,
    steps: usize,
}

impl scenes::Visit for Counted {
    fn scene<T, const D: usize, F, M, P>(
        &mut self,
        name: &str,
        _: f64,
        body: impl FnOnce() -> Result<Body<T, D, F, M, P>>,
    ) where
        T: Real,
        F: Family<T, D>,
        M: Material<T, D>,
        P: DamagePolicy<T, D, M>,
    {
        if format!("{name}, {}", T::NAME) == self.name {
            let mut body = body().expect("body");
            wave(&mut body);
            for _ in 0..self.steps {
                body.evaluate_and_break(1, &mut ()).expect("step");
            }
            println!("{}", 2 * body.family().bonds());
        }
    }
}

const COUNTED: &str = "PD_COUNTED";

/// Instructions per directed bond and step, counted by valgrind, which offers AVX2 and no more: a
/// program of two steps over that of one. None without valgrind.
///
/// By hand and not with gungraun: its benchmarks are functions with a name, these are generic.
fn instructions(name: &str) -> Option<f64> {
    let run = |steps: usize| {
        let output = Command::new("valgrind")
            .args(["--tool=cachegrind", "--cache-sim=no", "--cachegrind-out-file=/dev/null"])
            .arg(std::env::current_exe().ok()?)
            .env(COUNTED, format!("{steps} {name}"))
            .output()
            .ok()?;
        let told = String::from_utf8_lossy(&output.stderr);
        let count = told.lines().find_map(|line| line.split_once("refs:"))?.1;
        let count: f64 = count.replace(',', "").trim().parse().ok()?;
        let bonds: f64 = String::from_utf8_lossy(&output.stdout).trim().parse().ok()?;
        Some((count, bonds))
    };
    let ((one, bonds), (two, _)) = (run(1)?, run(2)?);
    Some((two - one) / bonds)
}

/// One line of the table.
struct Line {
    name: String,
    /// Median time of a step (states, bond test, forces) in seconds.
    median: f64,
    nodes: f64,
    directed: f64,
    bytes: f64,
    /// Wanted ns per directed bond.
    target: f64,
    /// Flops per directed bond (fused multiply-adds count two), where they were counted.
    flops: Option<f64>,
    /// See [`instructions`].
    instructions: Option<f64>,
}

/// Flops per directed bond in 3D, counted in the code: bond and t 12, its polynomial 18 (in f64), the
/// range of t 2; then what the model does with them.
fn flops(name: &str) -> Option<f64> {
    let model = name.split(',').next()?;
    let known = [
        ("PMB", 42.0),
        ("LPS", 86.0),
        ("OSB polynomial", 101.0),
        ("OSB positive split", 119.0),
        ("NOSB with Wan control", 79.0),
        ("PMB linearised", 18.0),
        ("LPS linearised", 38.0),
    ];
    known.iter().find(|(m, _)| *m == model && name.contains("3D")).map(|(_, flops)| *flops)
}

impl Line {
    fn per_bond(&self) -> f64 {
        1e9 * self.median / self.directed
    }
    fn row(&self, peak: f64, bandwidth: f64, wide: bool) -> String {
        // Single precision has twice the lanes.
        let peak = if wide { 2.0 * peak } else { peak };
        let share = self.flops.map(|f| 100.0 * f / self.per_bond() / peak);
        // Every array of the body is read or written about once per pass.
        let traffic = 100.0 * self.bytes / self.median * 1e-9 / bandwidth;
        format!(
            "| {} | {:.2} | {:.2} | {:.2} | {:.0} | {} | {traffic:.0} | {:.0} | {:.2} | {} |",
            self.name,
            self.per_bond(),
            self.target,
            1e-6 * self.nodes / self.median,
            1e-6 * self.directed / self.median,
            share.map_or(String::from("–"), |share| format!("{share:.0}")),
            self.bytes / self.nodes,
            self.bytes / self.directed * 2.0,
            self.instructions.map_or(String::from("–"), |count| format!("{count:.1}")),
        )
    }
}

struct Report {
    words: Vec<String>,
    text: String,
    peak: f64,
    bandwidth: f64,
}

impl Report {
    fn say(&mut self, line: &str) {
        println!("{line}");
        self.text.push_str(line);
        self.text.push('\n');
    }
    fn wants(&self, name: &str) -> bool {
        self.words.iter().all(|word| name.contains(word.as_str()))
    }
}

impl scenes::Visit for Report {
    fn scene<T, const D: usize, F, M, P>(
        &mut self,
        name: &str,
        target: f64,
        body: impl FnOnce() -> Result<Body<T, D, F, M, P>>,
    ) where
        T: Real,
        F: Family<T, D>,
        M: Material<T, D>,
        P: DamagePolicy<T, D, M>,
    {
        let name = format!("{name}, {}", T::NAME);
        if !self.wants(&name) {
            return;
        }
        let mut body = body().expect("body");
        wave(&mut body);
        let step = || {
            black_box(&mut body).evaluate_and_break(1, &mut ()).expect("step");
        };
        let median = median(7, step);
        let line = Line {
            flops: flops(&name),
            instructions: instructions(&name),
            name,
            median,
            nodes: body.nodes() as f64,
            directed: 2.0 * body.family().bonds() as f64,
            bytes: body.memory().total() as f64,
            target,
        };
        let row = line.row(self.peak, self.bandwidth, T::NAME == "f32");
        self.say(&row);
    }
}

fn lps(quarter: &Isotropic) -> Ordinary<LinearSolid> {
    let omega = InfluenceFunction::Constant;
    Ordinary::new(LinearSolid::solid(quarter, RHO, omega).expect("model"))
}

/// Setup, memory and cost of 3D LPS with damage on a lattice, with two threads and one.
fn scaling(report: &mut Report) {
    let quarter = Isotropic::from_young_poisson(1e9, 0.25).expect("moduli");
    let pool = |n| rayon::ThreadPoolBuilder::new().num_threads(n).build().expect("pool");
    report.say("\n## Size, threads and setup (LPS with damage, lattice, 3D, f64)\n");
    report.say("Wall-clock times: medians of 5 steps; setup on two threads.\n");
    report.say("| nodes | ns per bond, 1 thread | 2 threads | ratio | setup s | bytes per node |");
    report.say("| --- | --- | --- | --- | --- | --- |");
    for edge in [22, 46, 100, 215] {
        let start = Instant::now();
        let mut body = pool(2).install(|| {
            Body::new(lattice::<f64, 3>(&grid(edge)), lps(&quarter), stretch()).expect("body")
        });
        let setup = start.elapsed().as_secs_f64();
        wave(&mut body);
        let bonds = 2.0 * body.family().bonds() as f64;
        let mut time = |threads: usize| {
            pool(threads).install(|| {
                let mut times: Vec<f64> = (0..6)
                    .map(|_| {
                        let start = Instant::now();
                        body.evaluate_and_break(1, &mut ()).expect("step");
                        start.elapsed().as_secs_f64()
                    })
                    .collect();
                times.sort_by(f64::total_cmp);
                1e9 * times[2] / bonds
            })
        };
        let (one, two) = (time(1), time(2));
        let (nodes, bytes) = (body.nodes(), body.memory().total() / body.nodes());
        let ratio = one / two;
        let row = format!("| {nodes} | {one:.2} | {two:.2} | {ratio:.2} | {setup:.2} | {bytes} |");
        report.say(&row);
    }
    report.say("\n## Horizon (LPS with damage, lattice, 3D, f64, 46³ nodes, one thread)\n");
    report.say("| m | bonds per node | ns per bond |\n| --- | --- | --- |");
    for m in [1.5, 2.015, 3.015, 4.015, 5.015] {
        let family = Lattice::new(&grid(46), Horizon::Cells(m), Quadrature::None).expect("family");
        let mut body =
            Body::<f64, 3, _, _, _>::new(family, lps(&quarter), stretch()).expect("body");
        wave(&mut body);
        let bonds = 2.0 * body.family().bonds() as f64;
        let per_node = bonds / body.nodes() as f64;
        let step = || {
            body.evaluate_and_break(1, &mut ()).expect("step");
        };
        let ns = pool(1).install(move || 1e9 * median(5, step) / bonds);
        report.say(&format!("| {m} | {per_node:.1} | {ns:.2} |"));
    }
    report.say("\n## Setup of a cloud (LPS with damage, 3D, f64, 100³ nodes, two threads)\n");
    let start = Instant::now();
    let body = pool(2).install(|| {
        Body::new(cloud::<f64, 3>(&grid(100)), lps(&quarter), stretch()).expect("body")
    });
    let setup = start.elapsed().as_secs_f64();
    let bytes = body.memory().total() / body.nodes();
    report.say(&format!("{setup:.2} s, {bytes} bytes per node."));
}

fn main() {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("pool");
    if let Ok(counted) = std::env::var(COUNTED) {
        let (steps, name) = counted.split_once(' ').expect("steps and a name");
        let mut scene = Counted { name: name.to_owned(), steps: steps.parse().expect("steps") };
        return pool.install(|| {
            scenes::all::<f64>([SMALL2, SMALL3], &mut scene);
            scenes::all::<f32>([SMALL2, SMALL3], &mut scene);
        });
    }
    let words: Vec<String> = std::env::args().skip(1).filter(|a| !a.starts_with("--")).collect();
    let all = words.is_empty();
    let mut report = Report { words, text: String::new(), peak: fma_peak(), bandwidth: triad() };
    let mut head = String::new();
    writeln!(
        head,
        "Written by `cargo bench --bench report` on {}. One core: {:.0} GFLOP/s of fused \
         multiply-add in f64, {:.1} GB/s of triad. Processor time of one thread: states, bond test \
         and forces of a step (2D {EDGE2}², 3D {EDGE3}³ nodes, m = {M}; nothing breaks). Flops are \
         counted in the source; traffic takes every array of the body once. Instructions are those \
         of AVX2 per directed bond, counted by valgrind (2D {SMALL2}², 3D {SMALL3}³ nodes).\n",
        machine(),
        report.peak,
        report.bandwidth,
    )
    .expect("text");
    report.say(&head);
    report.say(
        "| model | ns per directed bond | target | M node-steps/s | M bond-steps/s | % of FMA | \
         % of bandwidth | bytes per node | bytes per bond | instructions |",
    );
    report.say("| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |");
    pool.install(|| {
        scenes::all::<f64>([EDGE2, EDGE3], &mut report);
        scenes::all::<f32>([EDGE2, EDGE3], &mut report);
    });
    if all {
        scaling(&mut report);
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/performance.md");
        // What stands below the mark is written by hand.
        let mark = "## What bounds it";
        let old = std::fs::read_to_string(path).unwrap_or_default();
        let notes = old.find(mark).map_or("", |at| &old[at..]);
        let text = format!("# Performance\n\n{}\n{notes}", report.text);
        std::fs::write(path, text).expect("docs/performance.md");
    }
}
