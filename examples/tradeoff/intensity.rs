//! Dynamic stress intensity of an edge crack (Hattori §6.1) against finite elements.

use super::{Scene, influence, quadrature};
use pd_testkit::clock::seconds;
use pd_testkit::dsif::errors;
use pd_testkit::hattori61::EdgeCrack;
use peridynamics::models::NoControl;
use peridynamics::models::elasticity::catalogue::GRAPHITE_EPOXY_DENSITY as DENSITY;
use peridynamics::prelude::*;
use peridynamics::study::{Effort, Outcome};
use peridynamics::trade::{Point, Record};

pub fn scene(effort: Effort) -> Outcome<Scene> {
    let cells = effort.choose(
        vec![40.0, 60.0],
        vec![140.0, 60.0, 100.0, 200.0],
        vec![200.0, 60.0, 100.0, 140.0, 300.0, 400.0],
    );
    let study = Study::new(&format!("stress intensity, {effort:?}"))
        .knob("particles along the edge", cells)
        .knob("m", [3.0, 2.0, 4.0])
        .knob("influence", ["linear", "Gaussian", "constant"])
        .knob("β", ["none", "exact", "ramp"])
        .knob("control", ["none", "Silling", "Wan"])
        .knob("strength of the control", [0.3, 0.1, 1.0])
        .knob("precision", ["f64", "f32"])
        .knob("kinematics", ["linear", "finite"])
        .knob("safety", [0.9, 0.5, 0.2])
        .knob("integrator", ["Verlet", "symplectic Euler"])
        .figure("error of K_II")
        .resolution(0.01)
        .clock(seconds)
        .one_at_a_time()?
        .grid(&["particles along the edge", "m"])?
        .grid(&["control", "strength of the control"])?;
    let about = "Correspondence, graphite–epoxy at 30°, an edge crack in a plate that is torn open. The \
                 error is that of K_I(t) over 100 µs (Hattori Eq. 38), read from the opening 5 mm \
                 behind the tip as for the finite elements.";
    let plate = EdgeCrack::new(30.0)?;
    let run = Box::new(move |point: &Point| -> Outcome<Record> {
        let policy = ShapePolicy { rule: IllConditioned::Refuse, limit: 1e6 };
        let (omega, ply, g) =
            (influence(point)?, plate.stiffness, point.number("strength of the control")?);
        let bare =
            Correspondence::new(LinearElastic(ply), DENSITY, omega)?.with_shape_policy(policy);
        let parts = (point.name("control")?, point.name("precision")?, point.name("kinematics")?);
        match parts {
            ("none", "f64", "linear") => go::<f64, _>(&plate, point, bare.with_control(NoControl)),
            ("none", "f32", "linear") => go::<f32, _>(&plate, point, bare.with_control(NoControl)),
            ("none", "f64", "finite") => {
                let law = Correspondence::new(SaintVenantKirchhoff(ply), DENSITY, omega)?;
                go::<f64, _>(&plate, point, law.with_shape_policy(policy))
            }
            ("Silling", "f64", "linear") => {
                go::<f64, _>(&plate, point, bare.with_control(SillingControl::new(10e9, g)?))
            }
            ("Wan", "f64", "linear") => {
                go::<f64, _>(&plate, point, bare.with_control(WanControl::new(&ply, g)?))
            }
            other => Err(format!("no body for {other:?}").into()),
        }
    });
    Ok(Scene { name: "intensity", about, study, run })
}

fn go<T: Real, M: Material<T, 2>>(
    plate: &EdgeCrack,
    point: &Point,
    material: M,
) -> Outcome<Record> {
    let cells = point.number("particles along the edge")? as usize;
    let family = (point.number("m")?, quadrature(point)?);
    let mut body = plate.body::<T, _>(cells, family, material)?;
    let rule = TimeStep::Safety(point.number("safety")?);
    let history = match point.name("integrator")? {
        "Verlet" => plate.history(&mut body, rule, VelocityVerlet::new())?,
        _ => plate.history(&mut body, rule, SymplecticEuler)?,
    };
    let (first, second) = errors(&history.k[1], &plate.fem[1]);
    Ok(Record::new(first).of(&body, history.steps).with("error of K_II", second))
}
