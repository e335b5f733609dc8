//! A state that is cut short, changed, or of another scene is refused with the part that does not
//! fit; no bytes whatever make a program panic.
use peridynamics::prelude::*;
use proptest::prelude::*;

type Plate<T> = Body<T, 2, Lattice<T, 2>, Ordinary<LinearSolid>, Breaking<CriticalStretch, 2>>;

/// A plate of `width` nodes and Young's modulus `young` that breaks.
fn plate<T: Real>(width: f64, young: f64) -> Plate<T> {
    let dx = 1e-3;
    let grid =
        Grid::new(&Cuboid::centred([width * dx, 12.0 * dx]).expect("box"), dx).expect("grid");
    let moduli = Isotropic::from_young_poisson(young, 0.3).expect("moduli");
    let linear = InfluenceFunction::Linear;
    let solid = LinearSolid::plane(&moduli, PlaneMode::PlaneStress, 2500.0, linear).expect("solid");
    let family = Lattice::new(&grid, Horizon::Cells(2.2), Quadrature::None).expect("family");
    let criterion = CriticalStretch::new(2e-3).expect("criterion");
    let mut body = Body::new(family, Ordinary::new(solid), Breaking::new(criterion)).expect("body");
    body.set_velocity(|x| [5000.0 * x[0], 0.0].into());
    body
}

const DT: TimeStep = TimeStep::Fixed(5e-8);

fn state() -> Vec<u8> {
    let mut body = plate::<f64>(10.0, 70e9);
    let kept = std::cell::RefCell::new(Vec::new());
    let mut run = Run::new(&mut body, Loads::new(), DT).expect("run");
    run.keep(40, |state| {
        state.write(&mut *kept.borrow_mut()).expect("memory");
        Ok("memory".to_owned())
    });
    run.steps_more(40).expect("steps");
    assert!(run.body().broken_bonds() > 10, "the run must break bonds");
    drop(run);
    kept.into_inner()
}

/// The error of going on from `state`.
fn refused<T: Real>(mut body: Plate<T>, rule: TimeStep, loads: Loads, state: &[u8]) -> String {
    let mut run = Run::new(&mut body, loads, rule).expect("run");
    let error = run.resume(state).expect_err("another scene");
    assert!(matches!(error, Error::State { .. }), "{error:?}");
    error.to_string()
}

#[test]
fn another_scene() {
    let state = state();
    let plain = || plate::<f64>(10.0, 70e9);
    Run::new(&mut plain(), Loads::new(), DT).expect("run").resume(&state).expect("the same scene");
    let none = Loads::new;
    let says = |error: String, part: &str| assert!(error.contains(part), "{error}");
    says(refused(plate::<f64>(11.0, 70e9), DT, none(), &state), "'body' has 120 nodes");
    says(refused(plate::<f32>(10.0, 70e9), DT, none(), &state), "the body here 120 nodes");
    says(refused(plate::<f64>(10.0, 71e9), DT, none(), &state), "'forces' are not those");
    says(refused(plain(), TimeStep::Fixed(4e-8), none(), &state), "'clock' has Δt = 5e-8 s");
    let body = plain();
    let every = NodeSet::from_nodes(0..body.nodes(), body.nodes()).expect("set");
    let pull = none().body_force(&every, 1, 1e10);
    says(refused(body, DT, pull, &state), "'forces' are not those");
    let mut body = plain();
    let mut run = Run::new(&mut body, none(), DT).expect("run").with_energies();
    says(run.resume(&state).expect_err("no energies").to_string(), "'energies' are not in it");
}

#[test]
fn cut_short_anywhere() {
    let state = state();
    let mut body = plate::<f64>(10.0, 70e9);
    let before: Vec<_> = (0..body.nodes()).map(|i| body.velocity(i)).collect();
    let mut run = Run::new(&mut body, Loads::new(), DT).expect("run");
    for length in 0..state.len() {
        let error = run.resume(&state[..length]).expect_err("cut short");
        assert!(matches!(error, Error::State { .. }), "{length}: {error:?}");
    }
    drop(run);
    assert!((0..body.nodes()).all(|i| body.velocity(i) == before[i]), "the body is as before");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]
    /// Some bytes are changed: an error, or a state that differs in the last bits of its numbers.
    #[test]
    fn changed_anywhere(changes in proptest::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..8)) {
        thread_local!(static STATE: Vec<u8> = state());
        let mut bytes = STATE.with(Clone::clone);
        for (at, value) in changes {
            let at = at.index(bytes.len());
            bytes[at] = value;
        }
        let mut body = plate::<f64>(10.0, 70e9);
        let mut run = Run::new(&mut body, Loads::new(), DT).expect("run");
        if let Err(error) = run.resume(&bytes) {
            prop_assert!(matches!(error, Error::State { .. } | Error::Inverted { .. }), "{error:?}");
        }
    }
}
