//! Energy stays over long runs; a step above the critical one is refused or detected.
use crate::common;
use peridynamics::prelude::*;

fn plate() -> Body<f64, 2, Lattice<f64, 2>, Ordinary<LinearSolid>, NoDamage> {
    let grid = Grid::new(&Cuboid::centred([6.0, 6.0]).expect("box"), 1.0).expect("grid");
    let moduli = Isotropic::from_young_poisson(1e9, 0.25).expect("moduli");
    let mode = PlaneMode::PlaneStrain;
    let model = LinearSolid::plane(&moduli, mode, 1e3, InfluenceFunction::Constant).expect("m");
    let family = Lattice::new(&grid, Horizon::Cells(2.0), Quadrature::None).expect("family");
    let mut body = Body::new(family, Ordinary::new(model), NoDamage).expect("body");
    body.set_velocity(|x| common::wavy(x, 1.0, 1e-2));
    body
}

/// Drift of the mean energy over 10⁵ steps at 0.9 of the critical step. Energy swings within a
/// period (in symplectic Euler, whose velocities lag, as much as ω Δt): means over many steps.
fn drift(integrator: impl peridynamics::core::Integrator<f64, 2>) -> f64 {
    let mut body = plate();
    let rule = TimeStep::Safety(0.9);
    let run = Run::with_integrator(&mut body, Loads::new(), rule, integrator).expect("run");
    let mut run = run.with_energies();
    const WINDOW: usize = 5000;
    let mut mean = |steps: usize| {
        let mut sum = 0.0;
        for _ in 0..WINDOW {
            run.steps_more(1).expect("step");
            let e = run.energies().expect("energies");
            sum += e.kinetic + e.strain;
        }
        run.steps_more(steps).expect("steps");
        sum / WINDOW as f64
    };
    let start = mean(100_000);
    mean(0) / start - 1.0
}

#[test]
fn energy_drifts_by_less_than_a_thousandth() {
    for (name, drift) in [
        ("velocity Verlet", drift(VelocityVerlet::new())),
        ("symplectic Euler", drift(SymplecticEuler)),
    ] {
        println!("{name}: {drift:.1e}");
        assert!(drift.abs() < 1e-3, "{name}: {drift:e}");
    }
}

#[test]
fn unstable_steps_are_refused_or_detected() {
    let mut body = plate();
    let critical = {
        let run = Run::new(&mut body, Loads::new(), TimeStep::Safety(1.0)).expect("run");
        run.dt()
    };
    let refused = Run::new(&mut body, Loads::new(), TimeStep::Fixed(1.05 * critical)).err();
    assert!(matches!(refused, Some(Error::UnstableTimeStep { .. })), "{refused:?}");
    let rule = TimeStep::Unchecked(1.05 * critical);
    let mut run = Run::new(&mut body, Loads::new(), rule).expect("run");
    let ended = run.steps_more(20_000).err();
    assert!(matches!(ended, Some(Error::BlowUp { .. })), "{ended:?}");
    let mut body = plate();
    let mut run = Run::new(&mut body, Loads::new(), TimeStep::Fixed(0.99 * critical)).expect("run");
    run.steps_more(20_000).expect("stable");
}
