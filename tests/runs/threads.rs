//! A breaking run is bitwise the same for 1, 2, 3, 5 and 8 threads, and no bond heals.
use crate::common;
use peridynamics::prelude::*;

fn run<F: Family<f64, 2>>(family: F, threads: usize) -> (Vec<SVector<f64, 2>>, usize) {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("pool");
    pool.install(|| {
        let law = LinearElastic(common::ply());
        let material = Correspondence::new(law, 1586.0, InfluenceFunction::Linear)
            .expect("material")
            .with_control(SillingControl::new(4e9, 0.3).expect("control"));
        let strengths = Strengths { along: 1670e6, across: 60e6, shear: 70e6 };
        let policy = Breaking::new(TsaiHill::new(&strengths, 0.6).expect("criterion"))
            .precracked(Segment::new([-0.01, 0.0], [0.01, 0.0]).expect("crack"));
        let mut body = Body::new(family, material, policy).expect("body");
        body.set_velocity(|x| [0.0, 2000.0 * x[1]].into());
        let mut broken = vec![vec![false; 0]; body.nodes()];
        let mut run = Run::new(&mut body, Loads::new(), TimeStep::Safety(0.3)).expect("run");
        run.observe(5, |view: &View<'_, _>| {
            let body: &Body<f64, 2, F, _, _> = view.body;
            for (node, known) in broken.iter_mut().enumerate() {
                let mut now = Vec::new();
                body.neighbours(node, |n| now.push(!n.intact));
                assert!(known.iter().zip(&now).all(|(before, now)| !before || *now), "healed");
                *known = now;
            }
            Ok(Flow::Continue)
        });
        run.steps_more(250).expect("steps");
        let body = run.body();
        let ends = (0..body.nodes()).map(|i| body.displacement(i)).collect();
        for node in 0..body.nodes() {
            body.neighbours(node, |there| {
                let mut back = None;
                body.neighbours(there.node, |n| {
                    if n.node == node {
                        back = Some(n.intact);
                    }
                });
                assert_eq!(back, Some(there.intact), "both directions break together");
            });
        }
        (ends, body.broken_bonds())
    })
}

#[test]
fn same_bits_for_every_thread_count() {
    let grid = Grid::new(&Cuboid::centred([0.05, 0.06]).expect("box"), 1e-3).expect("grid");
    let lattice = || Lattice::new(&grid, Horizon::Cells(3.0), Quadrature::None).expect("family");
    let points = Points::from_grid(&grid);
    let cloud = || Cloud::new(&points, Horizon::Cells(3.0), Quadrature::None).expect("family");
    let (reference, broken) = run(lattice(), 1);
    assert!(broken > 50, "the run must break bonds: {broken}");
    for threads in [2, 3, 5, 8] {
        assert!(run(lattice(), threads) == (reference.clone(), broken), "lattice, {threads}");
    }
    for threads in [1, 3] {
        assert!(run(cloud(), threads) == (reference.clone(), broken), "cloud, {threads}");
    }
}

/// Two nodes without neighbours, the last of the first half and the first of the second: another
/// thread comes to the second long before the first is reached. The error is about the first.
#[test]
fn same_error_for_every_thread_count() {
    let (half, dx) = (3000, 1e-3);
    let far = |i: usize| if i == half - 1 || i == half { 1e3 * i as f64 } else { 0.0 };
    let place = |i: usize| [(i % 60) as f64 * dx, (i / 60) as f64 * dx + far(i)].into();
    let positions = (0..2 * half).map(place).collect();
    let points = Points::new(positions, vec![dx * dx; 2 * half]).expect("points");
    for threads in [1, 2, 3, 5, 8].repeat(4) {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("pool");
        let error = pool.install(|| {
            let family = Cloud::<f64, 2>::new(&points, Horizon::Cells(3.0), Quadrature::None);
            let law = LinearElastic(common::ply());
            let material = Correspondence::new(law, 1586.0, InfluenceFunction::Linear);
            let body = Body::new(family.expect("family"), material.expect("material"), NoDamage);
            body.err().expect("refused")
        });
        let Error::EmptyFamily { node, .. } = error else { panic!("{error}") };
        assert_eq!(node, half - 1, "{threads} threads");
    }
}
