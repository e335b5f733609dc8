//! A step allocates nothing: on lattices and in clouds, with and without damage, with loads, and
//! with observers that are not due. One test, as the counter is one for the whole program.
//!
//! The only `unsafe` of the tests: counting what the program allocates means being its allocator,
//! and that trait is unsafe to implement. It forwards to the system's and adds one to a counter.
#![allow(unsafe_code)]
mod common;
use peridynamics::prelude::*;
use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

static ALLOCATIONS: AtomicUsize = AtomicUsize::new(0);

struct Counting;

// SAFETY: every call is passed on unchanged to the system's allocator.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        ALLOCATIONS.fetch_add(1, Relaxed);
        unsafe { System.alloc(layout) }
    }
    unsafe fn dealloc(&self, at: *mut u8, layout: Layout) {
        unsafe { System.dealloc(at, layout) }
    }
    unsafe fn realloc(&self, at: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        ALLOCATIONS.fetch_add(1, Relaxed);
        unsafe { System.realloc(at, layout, size) }
    }
}

#[global_allocator]
static COUNTING: Counting = Counting;

/// Allocations of 100 steps of a loaded run after 40 to warm up, and bonds broken meanwhile.
fn allocations<F, M, P, I>(mut body: Body<f64, 2, F, M, P>, pull: f64, integrator: I) -> [usize; 2]
where
    F: Family<f64, 2>,
    M: Material<f64, 2>,
    P: DamagePolicy<f64, 2, M>,
    I: peridynamics::core::Integrator<f64, 2>,
{
    body.set_velocity(|x| [0.0, pull * x[1]].into());
    let places: Vec<_> = (0..body.nodes()).map(|i| body.position(i)[1]).collect();
    let set = |inside: &dyn Fn(f64) -> bool| {
        NodeSet::from_nodes((0..places.len()).filter(|&i| inside(places[i])), places.len())
            .expect("nodes")
    };
    let (low, high) = (set(&|y| y < -0.013), set(&|y| y > 0.013));
    let middle = set(&|y| y.abs() < 0.003);
    let loads = Loads::new()
        .displacement(&low, 1, move |t: f64| -0.014 * pull * t)
        .velocity(&high, 1, 0.014 * pull)
        .body_force(&middle, 0, |t: f64| 1e3 * t);
    let rule = TimeStep::Safety(0.3);
    let mut run = Run::with_integrator(&mut body, loads, rule, integrator).expect("run");
    run.observe(1_000_000, |_: &View<'_, _>| Ok(Flow::Continue));
    run.steps_more(40).expect("steps");
    let (before, broken) = (ALLOCATIONS.load(Relaxed), run.body().broken_bonds());
    run.steps_more(100).expect("steps");
    [ALLOCATIONS.load(Relaxed) - before, run.body().broken_bonds() - broken]
}

#[test]
fn a_step_allocates_nothing() {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).use_current_thread();
    pool.build().expect("pool").install(|| {
        let grid = Grid::new(&Cuboid::centred([0.03, 0.03]).expect("box"), 1e-3).expect("grid");
        let lattice =
            || Lattice::<f64, 2>::new(&grid, Horizon::Cells(3.0), Quadrature::None).expect("f");
        let points = Points::from_grid(&grid);
        let cloud =
            || Cloud::<f64, 2>::new(&points, Horizon::Cells(3.0), Quadrature::None).expect("f");
        let third = Isotropic::from_young_poisson(7e10, 1.0 / 3.0).expect("moduli");
        let stress = PlaneMode::PlaneStress;
        let pmb = || Ordinary::new(Pmb::plane(&third, stress, 1e3, common::OMEGA).expect("m"));
        let lps =
            || Ordinary::new(LinearSolid::plane(&third, stress, 1e3, common::OMEGA).expect("m"));
        let split =
            || Ordinary::new(PositiveSplit::plane(&common::ply(), 1e3, common::OMEGA).expect("m"));
        let nosb = || {
            Correspondence::new(LinearElastic(common::ply()), 1e3, InfluenceFunction::Linear)
                .expect("m")
                .with_control(SillingControl::new(4e9, 0.5).expect("control"))
        };
        let crack = || Segment::new([-0.005, 0.0], [0.005, 0.0]).expect("crack");
        let stretch =
            || Breaking::new(CriticalStretch::new(2e-3).expect("criterion")).precracked(crack());
        let strengths = Strengths { along: 1670e6, across: 60e6, shear: 70e6 };
        let hill = || {
            Breaking::new(TsaiHill::new(&strengths, 0.6).expect("criterion")).precracked(crack())
        };
        macro_rules! check {
            ($($material:ident with $policy:expr, $breaks:literal;)*) => {$({
                let body = || Body::new(lattice(), $material(), $policy).expect("body");
                let in_cloud = || Body::new(cloud(), $material(), $policy).expect("body");
                let pull = if $breaks { 500.0 } else { 1.0 };
                for (what, [count, broken]) in [
                    ("lattice", allocations(body(), pull, VelocityVerlet::new())),
                    ("lattice, Euler", allocations(body(), pull, SymplecticEuler)),
                    ("cloud", allocations(in_cloud(), pull, VelocityVerlet::new())),
                ] {
                    let name = concat!(stringify!($material), " with ", stringify!($policy));
                    println!("{name}, {what}: {count} allocations, {broken} bonds broken");
                    assert_eq!(broken > 0, $breaks, "{name}, {what}: {broken} bonds broken");
                    assert_eq!(count, 0, "{name}, {what}");
                }
            })*};
        }
        check! {
            pmb with NoDamage, false;
            lps with NoDamage, false;
            split with NoDamage, false;
            nosb with NoDamage, false;
            lps with Precracked::by(crack()), false;
            lps with stretch(), false;
            nosb with hill(), false;
            pmb with stretch(), true;
            lps with stretch(), true;
            nosb with stretch(), true;
            nosb with hill(), true;
        }
    });
}
