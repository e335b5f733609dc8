//! Adaptive dynamic relaxation: closed forms of a bar and a plate, equilibrium after breaking, and
//! what it refuses.
use crate::common;
use common::*;
use peridynamics::prelude::*;

const YOUNG: f64 = 7e10;

fn block<T: Real, const D: usize>(size: [f64; D]) -> Lattice<T, D> {
    let grid = Grid::new(&Cuboid::centred(size).expect("box"), 1.0).expect("grid");
    Lattice::new(&grid, Horizon::Cells(2.5), Quadrature::Exact).expect("family")
}

/// A plate of the positive split (exact under homogeneous strain at every node) sheared on a frame
/// comes to the homogeneous state from rest; the same in 3D and f32.
fn homogeneous<T: Real, const D: usize, M: StrainEnergy<T, D>>(
    material: M,
    size: [f64; D],
) -> usize {
    let family = block::<T, D>(size);
    let grid = family.grid().clone();
    let half: Vec<f64> = size.iter().map(|s| 0.5 * s - 5.1).collect();
    let frame = grid.select(|x| (0..D).any(|d| x[d].abs() > half[d]));
    let h = SMatrix::<f64, D, D>::from_fn(|i, j| 1e-3 * (1.0 + i as f64 - 0.4 * j as f64));
    let mut loads = Loads::new();
    for node in frame.iter() {
        let x = grid.position(node);
        for d in 0..D {
            let u = (h * x)[d];
            let only: NodeSet = grid.select(|y| (y - x).norm() < 0.1);
            loads = loads.displacement(&only, d, u);
        }
    }
    let mut body = Body::new(family, material, NoDamage).expect("body");
    let mut run =
        Run::with_integrator(&mut body, loads, TimeStep::Safety(0.9), DynamicRelaxation::new())
            .expect("run");
    let tolerance = if T::EPSILON < 1e-10 { 1e-8 } else { 1e-5 };
    let relaxed = run.relax(1.0, tolerance, 3000).expect("equilibrium");
    assert!(relaxed.residual <= tolerance && relaxed.broken == 0);
    drop(run);
    let size = 1e-3 * grid.position(0).norm();
    for node in 0..grid.len() {
        let error = (body.displacement(node) - h * grid.position(node)).norm() / size;
        assert!(error < 200.0 * tolerance, "node {node}: {error:e}");
    }
    relaxed.steps
}

#[test]
fn homogeneous_strain() {
    let plate = || Ordinary::linearised(PositiveSplit::plane(&ply(), RHO, OMEGA).expect("m"));
    let steps = homogeneous::<f64, 2, _>(plate(), [24.0, 18.0]);
    println!("plate: {steps} steps");
    homogeneous::<f32, 2, _>(plate(), [24.0, 18.0]);
    let block = Ordinary::linearised(PositiveSplit::solid(&solid(), RHO, OMEGA).expect("m"));
    homogeneous::<f64, 3, _>(block, [14.0, 13.0, 13.0]);
}

fn bar(
    length: f64,
) -> Body<
    f64,
    2,
    Lattice<f64, 2>,
    Ordinary<PositiveSplit<2, 3>, peridynamics::models::Linearised>,
    NoDamage,
> {
    let moduli = Isotropic::from_young_poisson(YOUNG, 0.0).expect("moduli");
    let ply = Lamina { e1: YOUNG, e2: YOUNG, g12: moduli.shear(), nu12: 0.0 };
    let stiffness = Stiffness::<2>::lamina(&ply).expect("stiffness");
    let model = PositiveSplit::plane(&stiffness, RHO, OMEGA).expect("model");
    Body::new(block([length, 6.0]), Ordinary::linearised(model), NoDamage).expect("body")
}

/// A bar (ν = 0) held at one end under its own weight b: u(x) = b(Lx − ½x²)/E; and the steps grow
/// with the length of the bar, not with its square.
#[test]
fn a_hanging_bar() {
    let weight = 1e3;
    let steps = [40.0, 80.0].map(|length| {
        let mut body = bar(length);
        let grid = body.family().grid().clone();
        let held = grid.select(|x| x[0] < -0.5 * length + 3.0);
        let all = grid.select(|_| true);
        let loads = Loads::new().clamp::<2>(&held).body_force(&all, 0, weight);
        let scheme = DynamicRelaxation::new();
        let mut run =
            Run::with_integrator(&mut body, loads, TimeStep::Safety(0.9), scheme).expect("run");
        let relaxed = run.relax(1.0, 1e-7, 20_000).expect("equilibrium");
        drop(run);
        // Held up to the third column: the free length starts half a cell beyond it, give or take
        // what the horizon smears.
        let free = length - 3.0;
        let end = body.displacement(grid.nearest(&[0.5 * length, 0.5].into()))[0];
        let exact = 0.5 * weight * free * free / YOUNG;
        assert!((end / exact - 1.0).abs() < 2.0 / free, "{end:e} {exact:e}");
        relaxed.steps
    });
    println!("{steps:?} steps");
    assert!(steps[1] < 3 * steps[0], "{steps:?}");
}

/// A notched strip pulled in load steps: below the critical load nothing breaks, beyond it the
/// strip parts and carries nothing.
#[test]
fn a_strip_parts_in_equilibrium() {
    let third = Isotropic::from_young_poisson(YOUNG, 1.0 / 3.0).expect("moduli");
    let pmb = Pmb::plane(&third, PlaneMode::PlaneStress, RHO, OMEGA).expect("model");
    let family = block::<f64, 2>([10.0, 30.0]);
    let grid = family.grid().clone();
    let top = grid.select(|x| x[1] > 12.0);
    let bottom = grid.select(|x| x[1] < -12.0);
    let criterion = CriticalStretch::new(1e-3).expect("s").sparing(&top.union(&bottom));
    let notch = Segment::new([-6.0, 0.0], [-2.0, 0.0]).expect("notch");
    let policy = Breaking::new(criterion).precracked(notch);
    let mut body = Body::new(family, Ordinary::new(pmb), policy).expect("body");
    let ramp = |t: f64| 1e-3 * t;
    let loads = Loads::new().clamp::<2>(&bottom).displacement(&top, 1, ramp);
    let scheme = DynamicRelaxation::new();
    let mut run =
        Run::with_integrator(&mut body, loads, TimeStep::Safety(0.8), scheme).expect("run");
    let (mut forces, mut first) = (Vec::new(), None);
    for step in 1..=30 {
        let relaxed = run.relax(f64::from(step), 1e-4, 20_000);
        let force = reaction(run.body(), &top)[1];
        forces.push(force);
        let relaxed = relaxed.expect("equilibrium");
        if relaxed.broken > 0 && first.is_none() {
            first = Some(forces.len() - 1);
        }
        if first.is_some_and(|k: usize| force < 5e-3 * forces[k - 1]) {
            break;
        }
    }
    drop(run);
    let peak = forces.iter().copied().fold(0.0, f64::max);
    let last = forces.last().copied().expect("steps");
    // Proportional up to the break, nothing after it.
    let slope = |k: usize| forces[k] / (k + 1) as f64;
    let first = first.expect("a break");
    assert!(first > 3 && (slope(first - 1) / slope(0) - 1.0).abs() < 1e-2, "{forces:?}");
    assert!(last.abs() < 5e-3 * peak, "{last:e} after {peak:e}");
    assert!((0..grid.len()).any(|i| body.damage(i) > 0.3));
}

#[test]
fn what_it_refuses() {
    let run = |loads: Loads, tolerance: f64, most: usize| {
        let mut body = bar(20.0);
        let scheme = DynamicRelaxation::new();
        let mut run = Run::with_integrator(&mut body, loads, TimeStep::Safety(0.9), scheme)?;
        run.relax(1.0, tolerance, most)
    };
    let grid = bar(20.0).family().grid().clone();
    let (all, end) = (grid.select(|_| true), grid.select(|x| x[0] < -7.0));
    let weight = || Loads::new().clamp::<2>(&end).body_force(&all, 0, 1e3);
    assert!(run(weight(), 1e-6, 5000).is_ok());
    let few = run(weight(), 1e-6, 3);
    assert!(matches!(few, Err(Error::NotRelaxed { steps: 3, .. })), "{few:?}");
    assert!(matches!(run(weight(), 0.0, 10), Err(Error::InvalidValue { .. })));
    let moving = run(Loads::new().velocity(&end, 0, 1.0), 1e-6, 10);
    assert!(matches!(moving, Err(Error::InvalidValue { .. })), "{moving:?}");
}
