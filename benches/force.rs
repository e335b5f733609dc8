//! Cost of a step (states, bond test, forces), on one thread, of the scenes of the report: with
//! criterion's statistics, to compare one version of the code with another.
//!
//! `cargo bench --bench force`; words after `--` pick scenes by a regular expression, as criterion
//! does. Elements are directed bonds.

#[path = "scenes.rs"]
mod scenes;
use criterion::{Criterion, Throughput};
use peridynamics::prelude::*;
use std::time::Duration;

struct Timed(Criterion);

impl scenes::Visit for Timed {
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
        let mut body = body().expect("body");
        scenes::wave(&mut body);
        let mut group = self.0.benchmark_group("step");
        group.throughput(Throughput::Elements(2 * body.family().bonds() as u64));
        group.bench_function(format!("{name}, {}", T::NAME), |b| {
            b.iter(|| body.evaluate_and_break(1, &mut ()).expect("step"));
        });
    }
}

fn main() {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("pool");
    pool.install(|| {
        let quick = Duration::from_millis(400);
        let criterion = Criterion::default().sample_size(10).warm_up_time(quick);
        let mut timed = Timed(criterion.measurement_time(quick).configure_from_args());
        scenes::all::<f64>([256, 40], &mut timed);
        scenes::all::<f32>([256, 40], &mut timed);
        timed.0.final_summary();
    });
}
