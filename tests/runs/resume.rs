//! A run that is stopped and goes on from its state is the same, to the last bit, as one that was
//! never stopped: motion, forces, bonds, node fields, step, energies.
use crate::common;
use peridynamics::prelude::*;

/// Everything that can be seen of a body, as bits.
fn bits<T, const D: usize, F, M, P>(body: &Body<T, D, F, M, P>) -> Vec<u64>
where
    T: Real,
    F: Family<T, D>,
    M: Material<T, D>,
    P: DamagePolicy<T, D, M>,
{
    let mut seen = vec![body.broken_bonds() as u64, body.worst_index().to_bits()];
    for node in 0..body.nodes() {
        for field in [body.displacement(node), body.velocity(node), body.force_density(node)] {
            seen.extend(field.iter().map(|x| x.to_bits()));
        }
        body.neighbours(node, |n| seen.push(n.intact.into()));
    }
    seen
}

/// Runs bodies made by `body` for `steps` steps: one at a go, and one that is given up and built
/// anew after each `stop` steps. `start` makes the run.
fn same_with_and_without_stops<B: Dynamics<f64, 2>, I: Integrator<f64, 2>>(
    body: impl Fn() -> B,
    start: impl for<'a> Fn(&'a mut B) -> Run<'a, f64, 2, B, I>,
    (steps, stop): (usize, usize),
    advance: impl Fn(&mut Run<'_, f64, 2, B, I>, usize),
    see: impl Fn(&B) -> Vec<u64>,
) -> B {
    let mut whole = body();
    let mut run = start(&mut whole);
    advance(&mut run, steps);
    let (dt, time, energies) = (run.dt(), run.time(), run.energies());
    drop(run);

    let mut state: Vec<u8> = Vec::new();
    for from in (0..steps).step_by(stop) {
        let mut part = body();
        let kept = std::cell::RefCell::new(Vec::new());
        {
            let mut run = start(&mut part);
            if from > 0 {
                run.resume(&state).expect("resumes");
            }
            run.keep(1, |offered| {
                let mut bytes = Vec::new();
                offered.write(&mut bytes).expect("memory");
                *kept.borrow_mut() = bytes;
                Ok("memory".to_owned())
            });
            advance(&mut run, stop.min(steps - from));
            if from + stop >= steps {
                assert_eq!(run.steps(), steps);
                assert_eq!((run.dt(), run.time()), (dt, time));
                assert_eq!(run.energies(), energies);
            }
        }
        if from + stop >= steps {
            assert!(see(&part) == see(&whole), "not the same bits after stops");
        }
        state = kept.into_inner();
    }
    whole
}

fn steps<B: Dynamics<f64, 2>, I: Integrator<f64, 2>>(run: &mut Run<'_, f64, 2, B, I>, n: usize) {
    run.steps_more(n).expect("steps");
}

fn grid() -> Grid<2> {
    Grid::new(&Cuboid::centred([0.03, 0.04]).expect("box"), 1e-3).expect("grid")
}

/// Constants that follow damage, a graded step (Safety), energies; long enough for the critical
/// step to be looked at again (500 steps).
#[test]
fn correspondence_that_breaks() {
    let body = || {
        let family = Lattice::<f64, 2>::new(&grid(), Horizon::Cells(3.0), Quadrature::None);
        let law = LinearElastic(common::ply());
        let material = Correspondence::new(law, 1586.0, InfluenceFunction::Linear)
            .expect("material")
            .with_control(SillingControl::new(4e9, 0.3).expect("control"));
        let strengths = Strengths { along: 1670e6, across: 60e6, shear: 70e6 };
        let policy = Breaking::new(TsaiHill::new(&strengths, 0.6).expect("criterion"))
            .precracked(Segment::new([-0.005, 0.0], [0.005, 0.0]).expect("crack"));
        let mut body = Body::new(family.expect("family"), material, policy).expect("body");
        body.set_velocity(|x| [0.0, 2000.0 * x[1]].into());
        body
    };
    let body = same_with_and_without_stops(
        body,
        |body| {
            let top = grid().select(|x| x[1] > 0.019);
            let loads = Loads::new().velocity(&top, 1, |t: f64| 30.0 + 1e5 * t);
            Run::new(body, loads, TimeStep::Safety(0.3)).expect("run").with_energies()
        },
        (620, 190),
        steps,
        bits,
    );
    assert!(body.broken_bonds() > 50, "the run must break bonds: {}", body.broken_bonds());
}

/// Bits of a cloud, one horizon per node, a body force, symplectic Euler, a fixed step.
#[test]
fn cloud_that_breaks() {
    let points = Points::from_grid(&grid());
    let body = || {
        let horizons: Vec<f64> = (0..points.len())
            .map(|i| if grid().position(i)[0] < 0.0 { 2.2e-3 } else { 3e-3 })
            .collect();
        let family = Cloud::<f64, 2>::graded(&points, &horizons, Quadrature::None).expect("family");
        let glass = Isotropic::from_young_poisson(70e9, 0.3).expect("moduli");
        let solid =
            LinearSolid::plane(&glass, PlaneMode::PlaneStress, 2500.0, InfluenceFunction::Linear);
        let criterion = CriticalStretch::new(2e-3).expect("criterion");
        let material = Ordinary::new(solid.expect("material"));
        let mut body = Body::new(family, material, Breaking::new(criterion)).expect("body");
        body.set_velocity(|x| [1000.0 * x[0], 0.0].into());
        body
    };
    let body = same_with_and_without_stops(
        body,
        |body| {
            let all = grid().select(|_| true);
            let loads = Loads::new().body_force(&all, 1, |t: f64| 1e9 * (1e6 * t).sin());
            let rule = TimeStep::Fixed(3e-8);
            Run::with_integrator(body, loads, rule, SymplecticEuler).expect("run")
        },
        (90, 31),
        steps,
        bits,
    );
    assert!(body.broken_bonds() > 50, "the run must break bonds: {}", body.broken_bonds());
}

/// Load steps of a relaxation, which remembers its motion and its largest load.
#[test]
fn relaxation_by_load_steps() {
    let body = || {
        let family = Lattice::<f64, 2>::new(&grid(), Horizon::Cells(3.0), Quadrature::None);
        let glass = Isotropic::from_young_poisson(70e9, 1.0 / 3.0).expect("moduli");
        let law = Pmb::plane(&glass, PlaneMode::PlaneStress, 2500.0, InfluenceFunction::Constant);
        let criterion = CriticalStretch::new(1e-3).expect("criterion");
        let policy = Breaking::new(criterion)
            .precracked(Segment::new([-0.02, 0.0], [0.0, 0.0]).expect("crack"));
        let material = Ordinary::new(law.expect("law"));
        Body::new(family.expect("family"), material, policy).expect("body")
    };
    let advance = |run: &mut Run<'_, f64, 2, _, DynamicRelaxation<f64, 2>>, n: usize| {
        for _ in 0..n {
            let next = run.time() + 1.0;
            run.relax(next, 1e-3, 20_000).expect("relaxes");
        }
    };
    let body = same_with_and_without_stops(
        body,
        |body| {
            let (low, high) = (grid().select(|x| x[1] < -0.017), grid().select(|x| x[1] > 0.017));
            let loads = Loads::new().clamp::<2>(&low).displacement(&high, 0, 0.0);
            let loads = loads.displacement(&high, 1, |t: f64| 4e-6 * t);
            let rule = TimeStep::Safety(0.9);
            Run::with_integrator(body, loads, rule, DynamicRelaxation::new()).expect("run")
        },
        (6, 2),
        advance,
        bits,
    );
    assert!(body.broken_bonds() > 0, "the run must break bonds");
}
