//! Static solutions are bitwise the same for any number of threads, in f64 and f32.
use crate::common;
use peridynamics::prelude::*;

fn solve<T: Real>(threads: usize, tolerance: f64) -> (Vec<SVector<f64, 2>>, usize) {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("pool");
    pool.install(|| {
        let grid = Grid::new(&Cuboid::centred([0.1, 0.06]).expect("box"), 1e-3).expect("grid");
        let family = Lattice::<T, 2>::new(&grid, Horizon::Cells(3.0), Quadrature::Exact);
        let model = PositiveSplit::plane(&common::ply(), 1e3, common::OMEGA).expect("material");
        let crack = Segment::new([0.0, 0.0], [0.02, 0.0]).expect("crack");
        let material = Ordinary::linearised(model);
        let mut body =
            Body::new(family.expect("family"), material, Precracked::by(crack)).expect("body");
        let (left, right) = (grid.select(|x| x[0] < -0.045), grid.select(|x| x[0] > 0.045));
        let loads = Loads::new().clamp::<2>(&left).body_force(&right, 1, 1e9);
        let solver = Statics::new().with_tolerance(tolerance).expect("tolerance");
        let solved = solver.solve(&mut body, loads).expect("solved");
        assert!(solved.residual <= tolerance);
        ((0..body.nodes()).map(|i| body.displacement(i)).collect(), solved.iterations)
    })
}

#[test]
fn same_bits_for_every_thread_count() {
    let one = solve::<f64>(1, 1e-7);
    let single = solve::<f32>(1, 1e-3);
    for threads in [2, 3, 5, 8] {
        assert_eq!(solve::<f64>(threads, 1e-7), one, "{threads} threads");
    }
    assert_eq!(solve::<f32>(3, 1e-3), single, "3 threads, f32");
    let size = one.0.iter().map(|u| u.norm()).fold(0.0, f64::max);
    let apart = one.0.iter().zip(&single.0).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
    assert!(apart < 0.02 * size, "f32 differs by {:e}", apart / size);
}
