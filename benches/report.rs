//! One table of what a step costs: model × layout × precision × dimension.
//!
//! `cargo bench --bench report` prints it and writes `docs/performance.md`; words after `--` pick
//! the lines that contain all of them and write nothing (`-- LPS 3D f64`).

use peridynamics::prelude::*;
use std::hint::black_box;
use std::time::Instant;

const M: f64 = 3.015;
const RHO: f64 = 1000.0;
/// Cells along an edge of the timed bodies.
const EDGE2: usize = 256;
const EDGE3: usize = 48;

/// One line of the table.
struct Line {
    name: String,
    /// Median and shortest time of a step (states, bond test, forces) in seconds.
    median: f64,
    best: f64,
    nodes: f64,
    directed: f64,
    bytes: f64,
    /// Wanted ns per directed bond.
    target: Option<f64>,
}

impl Line {
    fn per_bond(&self, seconds: f64) -> f64 {
        1e9 * seconds / self.directed
    }
    fn print(&self) {
        let target = self.target.map_or(String::from("–"), |t| format!("{t:.2}"));
        println!(
            "| {} | {:.2} | {:.2} | {target} | {:.2} | {:.2} | {:.0} | {:.2} |",
            self.name,
            self.per_bond(self.median),
            self.per_bond(self.best),
            1e-6 * self.nodes / self.median,
            1e-6 * self.directed / self.median,
            self.bytes / self.nodes,
            self.bytes / self.directed * 2.0,
        );
    }
}

struct Report {
    words: Vec<String>,
    lines: Vec<Line>,
}

impl Report {
    fn wants(&self, name: &str) -> bool {
        self.words.iter().all(|word| name.contains(word.as_str()))
    }
    fn measure<T, const D: usize, F, M, P>(
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
        let name = format!("{name}, {D}D, {}", T::NAME);
        if !self.wants(&name) {
            return;
        }
        let mut body = body().expect("body");
        body.set_displacement(|x| {
            SVector::from_fn(|d, _| 1e-4 * ((0.1 + 0.05 * d as f64) * x.sum()).sin())
        });
        let mut step = || black_box(&mut body).evaluate_and_break(1, &mut ()).expect("step");
        step();
        let clock = Instant::now();
        let mut times = Vec::new();
        while times.len() < 5 || (clock.elapsed().as_secs_f64() < 0.7 && times.len() < 40) {
            let start = Instant::now();
            step();
            times.push(start.elapsed().as_secs_f64());
        }
        times.sort_by(f64::total_cmp);
        let line = Line {
            name,
            median: times[times.len() / 2],
            best: times[0],
            nodes: body.nodes() as f64,
            directed: 2.0 * body.family().bonds() as f64,
            bytes: body.memory().total() as f64,
            target: (target > 0.0).then_some(if T::NAME == "f64" { target } else { 0.55 * target }),
        };
        line.print();
        self.lines.push(line);
    }
}

fn grid<const D: usize>(cells: usize) -> Grid<D> {
    Grid::lattice(SVector::zeros(), SVector::repeat(1.0), [cells; D]).expect("grid")
}

fn lattice<T: Real, const D: usize>(grid: &Grid<D>) -> Lattice<T, D> {
    Lattice::new(grid, Horizon::Cells(M), Quadrature::None).expect("family")
}

fn cloud<T: Real, const D: usize>(grid: &Grid<D>) -> Cloud<T, D> {
    Cloud::new(&Points::from_grid(grid), Horizon::Cells(M), Quadrature::None).expect("family")
}

/// A criterion that is tested in every step and breaks nothing.
fn stretch<const D: usize>() -> Breaking<CriticalStretch, D> {
    Breaking::new(CriticalStretch::new(1.0).expect("criterion"))
}

fn models<T: Real>(report: &mut Report) {
    let (flat, deep) = (grid::<2>(EDGE2), grid::<3>(EDGE3));
    let third = Isotropic::from_young_poisson(1e9, 1.0 / 3.0).expect("moduli");
    let quarter = Isotropic::from_young_poisson(1e9, 0.25).expect("moduli");
    let (mode, omega) = (PlaneMode::PlaneStress, InfluenceFunction::Constant);
    let plane = Stiffness::<2>::isotropic(&third, mode).expect("stiffness");
    let solid = Stiffness::<3>::isotropic(&quarter).expect("stiffness");
    macro_rules! both {
        ($name:literal, $model2:expr, $model3:expr, $lattice:literal, $cloud:literal) => {{
            let name = concat!($name, ", lattice");
            report.measure(name, $lattice, || Body::new(lattice::<T, 2>(&flat), $model2, stretch()));
            report.measure(name, $lattice, || Body::new(lattice::<T, 3>(&deep), $model3, stretch()));
            let name = concat!($name, ", cloud");
            report.measure(name, $cloud, || Body::new(cloud::<T, 3>(&deep), $model3, stretch()));
        }};
    }
    both!(
        "PMB",
        Ordinary::new(Pmb::plane(&third, mode, RHO, omega).expect("model")),
        Ordinary::new(Pmb::solid(&quarter, RHO, omega).expect("model")),
        0.9,
        3.5
    );
    both!(
        "LPS",
        Ordinary::new(LinearSolid::plane(&third, mode, RHO, omega).expect("model")),
        Ordinary::new(LinearSolid::solid(&quarter, RHO, omega).expect("model")),
        1.6,
        7.0
    );
    both!(
        "OSB polynomial",
        Ordinary::new(PolynomialMicromoduli::plane(&plane, RHO, omega).expect("model")),
        Ordinary::new(PolynomialMicromoduli::solid(&solid, RHO, omega).expect("model")),
        2.5,
        10.0
    );
    both!(
        "OSB positive split",
        Ordinary::new(PositiveSplit::plane(&plane, RHO, omega).expect("model")),
        Ordinary::new(PositiveSplit::solid(&solid, RHO, omega).expect("model")),
        2.5,
        10.0
    );
    both!(
        "NOSB with Wan control",
        Correspondence::new(LinearElastic(plane), RHO, InfluenceFunction::Linear)
            .expect("model")
            .with_control(WanControl::new(&plane, 1.0).expect("control")),
        Correspondence::new(LinearElastic(solid), RHO, InfluenceFunction::Linear)
            .expect("model")
            .with_control(WanControl::new(&solid, 1.0).expect("control")),
        2.6,
        9.0
    );
    let pmb = || Ordinary::linearised(Pmb::solid(&quarter, RHO, omega).expect("model"));
    report.measure("PMB linearised, no damage, lattice", 0.6, || {
        Body::new(lattice::<T, 3>(&deep), pmb(), NoDamage)
    });
    let lps = || Ordinary::linearised(LinearSolid::solid(&quarter, RHO, omega).expect("model"));
    report.measure("LPS linearised, no damage, lattice", 1.1, || {
        Body::new(lattice::<T, 3>(&deep), lps(), NoDamage)
    });
}

fn main() {
    let words: Vec<String> = std::env::args().skip(1).filter(|a| !a.starts_with("--")).collect();
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("pool");
    println!("| model | ns/bond | best | target | Mnode-steps/s | Mbond-steps/s | B/node | B/bond |");
    println!("| --- | --- | --- | --- | --- | --- | --- | --- |");
    pool.install(|| {
        let mut report = Report { words, lines: Vec::new() };
        models::<f64>(&mut report);
        models::<f32>(&mut report);
    });
}
