//! A plane wave in a carbon ply against Christoffel's.

use super::{Scene, influence, quadrature};
use pd_testkit::clock::seconds;
use pd_testkit::plane_wave::PlaneWave;
use peridynamics::models::elasticity::catalogue::{
    GRAPHITE_EPOXY, GRAPHITE_EPOXY_DENSITY as DENSITY,
};
use peridynamics::prelude::*;
use peridynamics::study::{Effort, Outcome};
use peridynamics::trade::{Point, Record};

const LENGTH: f64 = 16e-3;

pub fn scene(effort: Effort) -> Outcome<Scene> {
    let cells = effort.choose(
        vec![16.0, 24.0],
        vec![32.0, 16.0, 24.0, 48.0, 64.0],
        vec![32.0, 16.0, 24.0, 48.0, 64.0, 96.0],
    );
    let study = Study::new(&format!("plane wave, {effort:?}"))
        .knob("λ/Δx", cells)
        .knob("m", [3.0, 2.0, 4.0, 5.0])
        .knob("influence", ["Gaussian", "constant", "linear"])
        .knob("β", ["exact", "none", "ramp"])
        .knob("calibration", ["split", "polynomial", "correspondence, Wan"])
        .knob("precision", ["f64", "f32"])
        .knob("kinematics", ["linear", "finite"])
        .knob("safety", [0.8, 0.4, 0.2, 0.95])
        .knob("integrator", ["Verlet", "symplectic Euler"])
        .figure("error of u")
        .clock(seconds)
        .one_at_a_time()?
        .grid(&["λ/Δx", "m"])?;
    let ply = Stiffness::<2>::lamina(&GRAPHITE_EPOXY)?;
    let (sine, cosine) = 30_f64.to_radians().sin_cos();
    let direction = SVector::from([cosine, sine]);
    let wave =
        PlaneWave::new((&ply, DENSITY), (direction, 0), LENGTH, effort.choose(1.0, 2.0, 2.0))?;
    let about = "The faster plane wave at 30° from the fibres of graphite–epoxy after two periods, \
                 in the middle of a plate so large that nothing from its edges arrives. The error is \
                 that of its speed; that of u is the root of the mean square over the wave's.";
    let run = Box::new(move |point: &Point| -> Outcome<Record> {
        let omega = influence(point)?;
        let split = PositiveSplit::plane(&ply, DENSITY, omega)?;
        let parts =
            (point.name("calibration")?, point.name("precision")?, point.name("kinematics")?);
        match parts {
            ("split", "f64", "linear") => go::<f64, _>(&wave, point, Ordinary::linearised(split)),
            ("split", "f32", "linear") => go::<f32, _>(&wave, point, Ordinary::linearised(split)),
            ("split", "f64", "finite") => go::<f64, _>(&wave, point, Ordinary::new(split)),
            ("polynomial", "f64", "linear") => {
                let polynomial = PolynomialMicromoduli::plane(&ply, DENSITY, omega)?;
                go::<f64, _>(&wave, point, Ordinary::linearised(polynomial))
            }
            ("correspondence, Wan", "f64", "linear") => {
                let bare = Correspondence::new(LinearElastic(ply), DENSITY, omega)?;
                go::<f64, _>(&wave, point, bare.with_control(WanControl::new(&ply, 1.0)?))
            }
            other => Err(format!("no body for {other:?}").into()),
        }
    });
    Ok(Scene { name: "wave", about, study, run })
}

fn go<T: Real, M: Material<T, 2>>(
    wave: &PlaneWave<2>,
    point: &Point,
    material: M,
) -> Outcome<Record> {
    let grid = Grid::new(&wave.shape()?, LENGTH / point.number("λ/Δx")?)?;
    let horizon = Horizon::Cells(point.number("m")?);
    let family = Lattice::<T, 2>::new(&grid, horizon, quadrature(point)?)?;
    let mut body = Body::new(family, material, NoDamage)?;
    wave.start(&mut body);
    let rule = TimeStep::Safety(point.number("safety")?);
    let (steps, time) = match point.name("integrator")? {
        "Verlet" => run(&mut body, rule, VelocityVerlet::new(), wave.time)?,
        _ => run(&mut body, rule, SymplecticEuler, wave.time)?,
    };
    let misfit = wave.misfit(&body, time);
    let record = Record::new(misfit.speed.abs()).of(&body, steps);
    Ok(record.with("error of u", misfit.displacement))
}

fn run<T: Real, B: Dynamics<T, 2>>(
    body: &mut B,
    rule: TimeStep,
    integrator: impl Integrator<T, 2>,
    end: f64,
) -> Outcome<(usize, f64)> {
    let mut run = Run::with_integrator(body, Loads::new(), rule, integrator)?;
    run.until(end)?;
    Ok((run.steps(), run.time()))
}
