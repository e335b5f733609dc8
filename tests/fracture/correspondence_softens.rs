//! Correspondence materials really part when their bonds break: no force is left between the
//! halves, whatever the policy, the control and the law.
use crate::common;
use common::*;
use peridynamics::prelude::*;

fn bar<T: Real, const D: usize>(size: [f64; D]) -> Lattice<T, D> {
    let grid = Grid::new(&Cuboid::centred(size).expect("box"), 1.0).expect("grid");
    Lattice::new(&grid, Horizon::Cells(3.0), Quadrature::None).expect("family")
}

const POLICIES: [IllConditioned; 2] = [IllConditioned::Detach, IllConditioned::PseudoInverse];

/// Halves of a cut bar moved apart feel nothing; the bar before the cut does.
macro_rules! halves_apart {
    ($t:ty, $d:literal, $material:expr, $size:expr, $crack:expr) => {
        for rule in POLICIES {
            let material = $material.with_shape_policy(ShapePolicy { rule, limit: 50.0 });
            let policy = Breaking::new(CriticalStretch::new(1e9).expect("never"));
            let mut body = Body::new(bar::<$t, $d>($size), material, policy).expect("body");
            let apart = |x: &SVector<f64, $d>| {
                SVector::<f64, $d>::from_fn(
                    |d, _| if x[1] > 0.0 { 0.02 + 0.01 * d as f64 } else { 0.0 },
                )
            };
            let largest = |body: &Body<$t, $d, _, _, _>| {
                (0..body.nodes()).map(|i| body.force_density(i).norm()).fold(0.0, f64::max)
            };
            body.set_displacement(apart);
            body.evaluate().expect("forces");
            let whole = largest(&body);
            let cut = body.cut(&$crack).expect("cut");
            assert!(cut > 0);
            body.evaluate().expect("forces");
            let parted = largest(&body);
            let rounding = 100.0 * <$t>::EPSILON as f64;
            assert!(parted <= rounding * whole, "{rule:?}: {parted:e} of {whole:e}");
        }
    };
}

#[test]
fn halves_of_a_cut_bar_feel_nothing() {
    let flat = Segment::new([-9.0, 0.0], [9.0, 0.0]).expect("crack");
    let deep = || Polygon::parallelogram([-9.0, 0.0, -9.0], [18.0, 0.0, 0.0], [0.0, 0.0, 18.0]);
    let omega = InfluenceFunction::Linear;
    let small = || Correspondence::new(LinearElastic(ply()), RHO, omega).expect("m");
    let wan = || small().with_control(WanControl::new(&ply(), 1.0).expect("c"));
    let silling = || small().with_control(SillingControl::new(1e10, 1.0).expect("c"));
    halves_apart!(f64, 2, small(), [7.0, 16.0], flat);
    halves_apart!(f32, 2, wan(), [7.0, 16.0], flat);
    halves_apart!(f64, 2, silling(), [7.0, 16.0], flat);
    let moduli = Isotropic::from_young_poisson(7e10, 0.3).expect("moduli");
    let finite = || Correspondence::new(NeoHookean::new(&moduli), RHO, omega).expect("m");
    halves_apart!(f64, 3, finite(), [5.0, 12.0, 5.0], deep().expect("crack"));
    let anisotropic = || Correspondence::new(SaintVenantKirchhoff(solid()), RHO, omega).expect("m");
    halves_apart!(f64, 3, anisotropic(), [5.0, 12.0, 5.0], deep().expect("crack"));
}

/// A bar is pulled until it breaks and on: its reaction rises to the strength, falls to nothing
/// and stays there while the halves go on moving apart.
#[test]
fn a_bar_pulled_apart_carries_nothing() {
    let (young, speed) = (1e3, 2e-3);
    let ply = Lamina { e1: young, e2: young, g12: 400.0, nu12: 0.25 };
    let stiffness = Stiffness::<2>::lamina(&ply).expect("stiffness");
    let material = Correspondence::new(LinearElastic(stiffness), 1e3, InfluenceFunction::Linear)
        .expect("material")
        .with_control(SillingControl::new(young, 0.3).expect("control"))
        .with_shape_policy(ShapePolicy { rule: IllConditioned::Detach, limit: 20.0 });
    let family = bar::<f64, 2>([8.0, 30.0]);
    let grid = family.grid().clone();
    let top = grid.select(|x| x[1] > 12.0);
    let bottom = grid.select(|x| x[1] < -12.0);
    // A row in the middle is weaker, so that the bar parts there.
    let weak = grid.select(|x| x[1].abs() < 1.0);
    let strong: NodeSet = grid.select(|x| x[1].abs() > 4.0);
    let criterion = CriticalStretch::new(0.02).expect("s").sparing(&strong);
    let mut body = Body::new(family, material, Breaking::new(criterion)).expect("body");
    body.set_velocity(|x| [0.0, speed * x[1] / 13.5].into());
    let loads = Loads::new().velocity(&top, 1, speed).velocity(&bottom, 1, -speed);
    let mut run = Run::new(&mut body, loads, TimeStep::Safety(0.2)).expect("run");
    let (mut curve, mut broke_at) = (Vec::new(), None);
    while run.time() < 1500.0 {
        run.steps_more(20).expect("steps");
        curve.push((run.time(), reaction(run.body(), &top)[1]));
        if run.body().broken_bonds() > 0 && broke_at.is_none() {
            broke_at = Some(run.time());
        }
    }
    let broke_at = broke_at.expect("a break");
    let body = run.body();
    assert!(weak.iter().all(|i| body.damage(i) > 0.3), "the bar is in one piece");
    let peak = curve.iter().map(|c| c.1).fold(0.0, f64::max);
    // 8 columns at about E s_c.
    assert!((peak / (8.0 * young * 0.02) - 1.0).abs() < 0.3, "{peak}");
    // Ringing halves swing about zero with a period of 52 s: the mean over many periods is what is
    // carried.
    let after: Vec<f64> = curve.iter().filter(|c| c.0 > broke_at + 150.0).map(|c| c.1).collect();
    let mean = after.iter().sum::<f64>() / after.len() as f64;
    assert!(after.len() > 100 && mean.abs() < 0.02 * peak, "{mean} of {peak}");
    // The halves have gone on by more than their elastic stretch.
    let gap = body.displacement(grid.nearest(&[0.5, 4.5].into()))[1]
        - body.displacement(grid.nearest(&[0.5, -4.5].into()))[1];
    assert!(gap > 3.0 * 0.02 * 27.0 * 0.5, "{gap}");
}
