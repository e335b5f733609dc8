//! Cost of a step (states, bond test, forces) per directed bond, on one thread.
//!
//! `cargo bench --bench force` prints criterion's figures and a table beside the targets.

use criterion::Criterion;
use peridynamics::prelude::*;
use std::time::Instant;

const M: f64 = 3.015;
const RHO: f64 = 1000.0;

/// One line of the table: model, dimension, layout, scalar, measured, target (ns per directed
/// bond and step, from the project's wish list for a Xeon of 2.8 GHz; none where none was set).
struct Line {
    name: String,
    nanoseconds: f64,
    node_steps: f64,
    bytes: f64,
    target: Option<f64>,
}

fn measure<T, const D: usize, F, M, P>(
    criterion: &mut Criterion,
    lines: &mut Vec<Line>,
    name: &str,
    target: Option<f64>,
    body: Result<Body<T, D, F, M, P>>,
) where
    T: Real,
    F: Family<T, D>,
    M: Material<T, D>,
    P: DamagePolicy<T, D, M>,
{
    let mut body = body.expect("body");
    body.set_displacement(|x| {
        SVector::from_fn(|d, _| 1e-4 * ((0.1 + 0.05 * d as f64) * x.sum()).sin())
    });
    let mut step = || body.evaluate_and_break(1, &mut ()).expect("step");
    step();
    let mut times: Vec<f64> = (0..7)
        .map(|_| {
            let start = Instant::now();
            step();
            start.elapsed().as_secs_f64()
        })
        .collect();
    times.sort_by(f64::total_cmp);
    let name = format!("{name}, {D}D, {}", T::NAME);
    criterion.bench_function(&name, |b| b.iter(&mut step));
    let directed = 2.0 * body.family().bonds() as f64;
    lines.push(Line {
        name,
        nanoseconds: 1e9 * times[3] / directed,
        node_steps: body.nodes() as f64 / times[3],
        bytes: body.memory().total() as f64 / body.nodes() as f64,
        target,
    });
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

fn models<T: Real>(criterion: &mut Criterion, lines: &mut Vec<Line>) {
    let (flat, deep) = (grid::<2>(256), grid::<3>(40));
    let third = Isotropic::from_young_poisson(1e9, 1.0 / 3.0).expect("moduli");
    let quarter = Isotropic::from_young_poisson(1e9, 0.25).expect("moduli");
    let (mode, omega) = (PlaneMode::PlaneStress, InfluenceFunction::Constant);
    let plane = Stiffness::<2>::isotropic(&third, mode).expect("stiffness");
    let solid = Stiffness::<3>::isotropic(&quarter).expect("stiffness");
    // Targets are for f64; f32 is wanted at 0.55 of them.
    let factor = if T::NAME == "f64" { 1.0 } else { 0.55 };
    macro_rules! both {
        ($name:literal, $model2:expr, $model3:expr, $lattice:literal, $cloud:literal) => {{
            let (a, b) = (Some($lattice * factor), Some($cloud * factor));
            let body = Body::new(lattice::<T, 2>(&flat), $model2, stretch());
            measure(criterion, lines, concat!($name, ", lattice"), a, body);
            let body = Body::new(lattice::<T, 3>(&deep), $model3, stretch());
            measure(criterion, lines, concat!($name, ", lattice"), a, body);
            let body = Body::new(cloud::<T, 3>(&deep), $model3, stretch());
            measure(criterion, lines, concat!($name, ", cloud"), b, body);
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
    let whole = Pmb::solid(&quarter, RHO, omega).expect("model");
    let body = Body::new(lattice::<T, 3>(&deep), Ordinary::linearised(whole), NoDamage);
    measure(criterion, lines, "PMB linearised, no damage", Some(0.6 * factor), body);
    let whole = LinearSolid::solid(&quarter, RHO, omega).expect("model");
    let body = Body::new(lattice::<T, 3>(&deep), Ordinary::linearised(whole), NoDamage);
    measure(criterion, lines, "LPS linearised, no damage", Some(1.1 * factor), body);
}

fn main() {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("pool");
    pool.install(|| {
        let quick = std::time::Duration::from_millis(400);
        let mut criterion = Criterion::default()
            .sample_size(10)
            .warm_up_time(quick)
            .measurement_time(quick)
            .configure_from_args();
        let mut lines = Vec::new();
        models::<f64>(&mut criterion, &mut lines);
        models::<f32>(&mut criterion, &mut lines);
        println!("\nmodel | ns per directed bond | target | node-steps/s | bytes per node");
        for line in lines {
            let target = line.target.map_or(String::from("–"), |t| format!("{t:.2}"));
            println!(
                "{} | {:.2} | {target} | {:.2e} | {:.0}",
                line.name, line.nanoseconds, line.node_steps, line.bytes
            );
        }
    });
}
