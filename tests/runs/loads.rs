//! Loads do what they say: each kind, constant or a function of time, per component, on its own
//! nodes only, against solutions known by hand; and what makes no sense is refused.
use crate::common;
use peridynamics::prelude::*;

const DX: f64 = 1e-3;
const RHO: f64 = 1586.0;

fn grid<const D: usize>() -> Grid<D> {
    let edges: [f64; D] = std::array::from_fn(|d| if d == 0 { 12.0 * DX } else { 6.0 * DX });
    Grid::new(&Cuboid::centred(edges).expect("box"), DX).expect("grid")
}

/// Without stiffness: a body whose nodes move freely under their loads.
struct Dust;

impl<T: Real, const D: usize> BondLaw<T, D> for Dust {
    type Const = ();
    fn density(&self) -> f64 {
        RHO
    }
    fn bond_const(&self, _: &SVector<f64, D>, _: Scale) {}
    fn force(&self, _: &Bond<T, D>, (): &()) -> T {
        T::zero()
    }
}

fn dust<const D: usize>() -> Body<f64, D, Lattice<f64, D>, BondBased<Dust>, NoDamage> {
    let family = Lattice::new(&grid(), Horizon::Cells(2.0), Quadrature::None).expect("family");
    Body::new(family, BondBased(Dust), NoDamage).expect("body")
}

fn plate() -> Body<f64, 2, Lattice<f64, 2>, Ordinary<PositiveSplit<2, 3>>, NoDamage> {
    let family = Lattice::new(&grid(), Horizon::Cells(2.0), Quadrature::None).expect("family");
    let model = PositiveSplit::plane(&common::ply(), RHO, InfluenceFunction::Gaussian);
    Body::new(family, Ordinary::new(model.expect("material")), NoDamage).expect("body")
}

const DT: f64 = 1e-6;
const STEPS: usize = 50;

fn close(got: f64, exact: f64, size: f64, what: &str) {
    assert!((got - exact).abs() < 1e-12 * size, "{what}: {got:e}, {exact:e}");
}

/// Every component of every node in 2D and 3D: loaded nodes move as they must along `axis`, and
/// nothing else moves.
fn every_component<const D: usize>(
    what: &str,
    loads: impl Fn(&NodeSet, usize) -> Loads,
    exact: impl Fn(f64) -> [f64; 2],
    size: [f64; 2],
) {
    for axis in 0..D {
        let mut body = dust::<D>();
        let set = grid::<D>().select(|x| x[0] > 3.0 * DX);
        assert!(set.len() > 10 && set.len() < body.nodes() / 2);
        let mut run = Run::new(&mut body, loads(&set, axis), TimeStep::Unchecked(DT)).expect("run");
        run.steps_more(STEPS).expect("steps");
        let [u, v] = exact(run.time());
        for node in 0..run.body().nodes() {
            for d in 0..D {
                let moves = d == axis && set.contains(node);
                let [u, v] = if moves { [u, v] } else { [0.0, 0.0] };
                close(run.body().displacement(node)[d], u, size[0], what);
                close(run.body().velocity(node)[d], v, size[1], what);
            }
        }
    }
}

fn in_both_dimensions(
    what: &str,
    loads: impl Fn(&NodeSet, usize) -> Loads,
    exact: impl Fn(f64) -> [f64; 2],
    size: [f64; 2],
) {
    every_component::<2>(what, &loads, &exact, size);
    every_component::<3>(what, &loads, &exact, size);
}

/// Mean speed of the last step of a displacement, which is what a prescribed node is given.
fn last_speed(u: impl Fn(f64) -> f64, t: f64) -> f64 {
    (u(t) - u(t - DT)) / DT
}

#[test]
fn displacements() {
    // A constant one is there from the start.
    let constant = |set: &NodeSet, axis| Loads::new().displacement(set, axis, 2e-5);
    in_both_dimensions("constant u", constant, |_| [2e-5, 0.0], [2e-5, 2e-5 / DT]);
    let u = |t: f64| 1e-3 * (1e4 * t).sin();
    let moving = move |set: &NodeSet, axis| Loads::new().displacement(set, axis, u);
    in_both_dimensions("u(t)", moving, |t| [u(t), last_speed(u, t)], [1e-3, 1e-3 / DT]);
}

#[test]
fn velocities() {
    let constant = |set: &NodeSet, axis| Loads::new().velocity(set, axis, -3.0);
    in_both_dimensions("constant v", constant, |t| [-3.0 * t, -3.0], [1e-4, 3.0]);
    // Drifts take the middle of the step: exact for a linear v(t).
    let moving = |set: &NodeSet, axis| Loads::new().velocity(set, axis, |t: f64| 2e5 * t);
    in_both_dimensions("v(t)", moving, |t| [1e5 * t * t, 2e5 * t], [1e-3, 10.0]);
}

#[test]
fn body_forces() {
    // Velocity Verlet is exact for a constant force.
    let a = 4e8 / RHO;
    let constant = |set: &NodeSet, axis| Loads::new().body_force(set, axis, 4e8);
    in_both_dimensions("constant b", constant, |t| [0.5 * a * t * t, a * t], [1e-3, 20.0]);
    // For a linear one the velocity is exact, and u late by b'Δt²t/12ρ... : sums by hand.
    let rate = 1e13;
    let moving =
        move |set: &NodeSet, axis| Loads::new().body_force(set, axis, move |t: f64| rate * t);
    let exact = |t: f64| {
        let (n, a) = ((t / DT).round(), rate / RHO);
        [a * DT.powi(3) * (n * n * n - n) / 6.0, 0.5 * a * t * t]
    };
    in_both_dimensions("b(t)", moving, exact, [1e-3, 10.0]);
}

#[test]
fn forces_add_up_and_supports_win() {
    let mut body = dust::<2>();
    let set = grid::<2>().select(|x| x[0] > 3.0 * DX);
    let loads = Loads::new()
        .body_force(&set, 0, 1e8)
        .body_force(&set, 0, 3e8)
        .body_force(&set, 1, 4e8)
        .velocity(&set, 1, 1.0);
    let mut run = Run::new(&mut body, loads, TimeStep::Unchecked(DT)).expect("run");
    run.steps_more(STEPS).expect("steps");
    let (t, node) = (run.time(), set.iter().next().expect("node"));
    close(run.body().displacement(node)[0], 0.5 * 4e8 / RHO * t * t, 1e-3, "sum");
    close(run.body().displacement(node)[1], t, 1e-4, "support");
}

/// In an elastic body, with both integrators: held components are exact at every step, whatever
/// the body does; a clamp holds all of them.
#[test]
fn supports_of_an_elastic_body() {
    fn check(integrator: impl peridynamics::core::Integrator<f64, 2>) {
        let mut body = plate();
        let (left, right) =
            (grid::<2>().select(|x| x[0] < -4.0 * DX), grid::<2>().select(|x| x[0] > 4.0 * DX));
        let u = |t: f64| 1e-6 * (2e6 * t).sin();
        let loads = Loads::new().clamp::<2>(&left).displacement(&right, 0, u);
        let rule = TimeStep::Safety(0.5);
        let mut run = Run::with_integrator(&mut body, loads, rule, integrator).expect("run");
        let mut most = 0.0_f64;
        for _ in 0..100 {
            run.steps_more(1).expect("step");
            let body = run.body();
            for node in left.iter() {
                assert_eq!(body.displacement(node).amax(), 0.0);
                assert_eq!(body.velocity(node).amax(), 0.0);
            }
            for node in right.iter() {
                close(body.displacement(node)[0], u(run.time()), 1e-6, "held");
                most = most.max(body.displacement(node)[1].abs());
            }
        }
        // The free component of the held nodes is free.
        assert!(most > 1e-9, "{most:e}");
    }
    check(VelocityVerlet::new());
    check(SymplecticEuler);
}

/// A fictitious layer: nodes outside the body proper, all of them prescribed, give a boundary the
/// displacement it has in the continuum. Homogeneous strain then needs no force inside.
#[test]
fn fictitious_layers() {
    // The bond strains of a positive split need whole families: two horizons of layer.
    let strain = SMatrix::<f64, 2, 2>::new(1e-3, 4e-4, -2e-4, 5e-4);
    let unbalanced = |layer: f64| {
        let grid = Grid::new(&Cuboid::centred([16.0 * DX, 14.0 * DX]).expect("box"), DX);
        let grid = grid.expect("grid");
        let inside = move |x: &SVector<f64, 2>| {
            x[0].abs() < 8.0 * DX - layer && x[1].abs() < 7.0 * DX - layer
        };
        let family = Lattice::<f64, 2>::new(&grid, Horizon::Cells(2.0), Quadrature::None);
        let model = PositiveSplit::plane(&common::ply(), RHO, InfluenceFunction::Gaussian);
        let material = Ordinary::linearised(model.expect("material"));
        let mut body = Body::new(family.expect("family"), material, NoDamage).expect("body");
        body.set_displacement(|x| strain * x);
        let mut loads = Loads::new();
        for node in 0..grid.len() {
            let x = grid.position(node);
            if !inside(&x) {
                let set = NodeSet::from_nodes([node], grid.len()).expect("set");
                let u = strain * x;
                loads = loads.displacement(&set, 0, u[0]).displacement(&set, 1, u[1]);
            }
        }
        let mut run = Run::new(&mut body, loads, TimeStep::Safety(0.5)).expect("run");
        run.steps_more(50).expect("steps");
        let off = |i: usize| (run.body().displacement(i) - strain * grid.position(i)).norm();
        (0..grid.len()).map(off).fold(0.0, f64::max) / (1e-3 * 8.0 * DX)
    };
    let (with, without) = (unbalanced(4.0 * DX), unbalanced(0.0));
    assert!(with < 1e-12, "{with:e}");
    assert!(without > 1e-3, "a free surface moves: {without:e}");
}

#[test]
fn initial_fields() {
    let mut body = dust::<3>();
    let (u, v) = (
        |x: &SVector<f64, 3>| SVector::<f64, 3>::new(x[1], 2.0 * x[2], -x[0]) * 1e-3,
        |x: &SVector<f64, 3>| SVector::<f64, 3>::new(x[2], x[0], x[1]) * 1e3,
    );
    body.set_displacement(u);
    body.set_velocity(v);
    body.set_velocity_of(7, &SVector::zeros());
    body.set_displacement_of(8, &SVector::zeros());
    let mut run = Run::new(&mut body, Loads::new(), TimeStep::Unchecked(DT)).expect("run");
    run.steps_more(STEPS).expect("steps");
    for node in 0..run.body().nodes() {
        let x = run.body().position(node);
        let v = if node == 7 { SVector::zeros() } else { v(&x) };
        let u = if node == 8 { SVector::zeros() } else { u(&x) } + v * run.time();
        assert!((run.body().displacement(node) - u).norm() < 1e-12 * 1e-3, "node {node}");
        assert!((run.body().velocity(node) - v).norm() < 1e-12 * 10.0, "node {node}");
    }
}

/// What is refused when the run is made.
#[test]
fn nonsense_is_refused() {
    let mut body = plate();
    let set = grid::<2>().select(|x| x[0] > 4.0 * DX);
    let larger = Grid::new(&Cuboid::centred([30.0 * DX, 6.0 * DX]).expect("box"), DX).expect("g");
    let foreign = larger.select(|x| x[0] > 14.0 * DX);
    let mut refusal = |loads: Loads| {
        let refused = Run::new(&mut body, loads, TimeStep::Safety(0.5)).err();
        refused.expect("refused")
    };
    let value = |error: &Error, part: &str| {
        assert!(matches!(error, Error::InvalidValue { .. }), "{error}");
        assert!(error.to_string().contains(part), "{error}");
    };
    for loads in [
        Loads::new().displacement(&foreign, 0, 0.0),
        Loads::new().velocity(&foreign, 0, 0.0),
        Loads::new().body_force(&foreign, 0, 1.0),
    ] {
        value(&refusal(loads), "was the set made for another grid?");
    }
    value(&refusal(Loads::new().velocity(&set, 2, 0.0)), "axis of a load is 2");
    for bad in [f64::NAN, f64::INFINITY] {
        value(&refusal(Loads::new().displacement(&set, 0, bad)), "value of a load");
        value(&refusal(Loads::new().body_force(&set, 1, move |_: f64| bad)), "value of a load");
    }
    let twice = Loads::new().displacement(&set, 0, 0.0).velocity(&set, 0, 1.0);
    assert!(matches!(refusal(twice), Error::ConflictingConditions { axis: 0, .. }));
    let both = Loads::new().displacement(&set, 0, 0.0).velocity(&set, 1, 1.0);
    let mut body = plate();
    Run::new(&mut body, both, TimeStep::Safety(0.5)).expect("two components are no conflict");
}

/// A function that becomes NaN later ends the run at that step, whichever kind it is.
#[test]
fn a_function_that_turns_bad() {
    let set = grid::<2>().select(|x| x[0] > 4.0 * DX);
    let bad = |t: f64| if t > 30.5 * DT { f64::NAN } else { 0.0 };
    for (loads, what) in [
        (Loads::new().displacement(&set, 1, bad), "prescribed displacement [m] is NaN"),
        (Loads::new().velocity(&set, 1, bad), "prescribed velocity [m/s] is NaN"),
        (Loads::new().body_force(&set, 1, bad), "body force [N/m³] is NaN"),
    ] {
        let mut body = dust::<2>();
        let mut run = Run::new(&mut body, loads, TimeStep::Unchecked(DT)).expect("run");
        let error = run.steps_more(100).expect_err("ends");
        let text = error.to_string();
        let Error::During { step, time, source } = error else { panic!("{text}") };
        assert!(step == 31 && (time - 31.0 * DT).abs() < 1e-9 * DT, "{text}");
        assert!(matches!(*source, Error::InvalidValue { .. }) && text.contains(what), "{text}");
        // Nothing of it got into the body.
        drop(run);
        assert!((0..body.nodes()).all(|i| body.displacement(i).norm() == 0.0));
    }
}
