//! The energy that opening a beam costs (Willberg §5A) against the one put in.

use super::{Scene, influence, quadrature};
use pd_testkit::beam::{Beam, MM};
use pd_testkit::clock::seconds;
use peridynamics::models::elasticity::catalogue::willberg_beam;
use peridynamics::prelude::*;
use peridynamics::study::{Effort, Outcome, damage};
use peridynamics::trade::{Point, Record};

/// Fracture energy put in, in J/m².
const ENERGY: f64 = 12.0;
const DENSITY: f64 = 2000.0;

pub fn scene(effort: Effort) -> Outcome<Scene> {
    let spacings = effort.choose(vec![2.0, 1.0], vec![1.0, 2.0, 0.5], vec![0.5, 2.0, 1.0]);
    let growth = effort.choose(4.0, 6.0, 10.0) * MM;
    let study = Study::new(&format!("beam, {effort:?}"))
        .knob("Δx in mm", spacings)
        .knob(
            "m",
            effort.choose(vec![2.015, 3.015], vec![3.015, 2.015, 4.015], vec![3.015, 2.015, 4.015]),
        )
        .knob("influence", ["constant", "Gaussian", "linear"])
        .knob("β", ["none", "exact", "ramp"])
        .knob("calibration", ["LPS", "split"])
        .knob("w_C from", ["lattice and width", "lattice", "continuum"])
        .knob("bonds tested every", [1.0, 5.0, 20.0])
        .knob("precision", ["f64", "f32"])
        .knob("kinematics", ["finite", "linear"])
        .knob("safety", [0.5, 0.8, 0.2])
        .knob("speed in mm/s", [32.0, 64.0, 16.0])
        .figure("G [J/m²]")
        .figure("share of kinetic energy")
        .resolution(0.02)
        .clock(seconds)
        .one_at_a_time()?
        .grid(&["calibration", "m"])?;
    let about = "3D: a beam of 30 × 20 × 6 mm with a crack of 5 mm is pulled open; \
                 Foster's criterion. The error is that of the energy release rate while the crack \
                 grows from 2 to 6 mm (slope of the work of the supports, less what unloading gives \
                 back, over the area) against the 12 J/m² put in. Two faults of opposite sign can cancel: \
                 testing bonds seldom lets them overstretch and raises G. Look at G.";
    let run = Box::new(move |point: &Point| -> Outcome<Record> {
        let omega = influence(point)?;
        let moduli = willberg_beam()?;
        let lps = || LinearSolid::solid(&moduli, DENSITY, omega);
        let parts =
            (point.name("calibration")?, point.name("precision")?, point.name("kinematics")?);
        match parts {
            ("LPS", "f64", "finite") => go::<f64, _>(growth, point, Ordinary::new(lps()?)),
            ("LPS", "f32", "finite") => go::<f32, _>(growth, point, Ordinary::new(lps()?)),
            ("LPS", "f64", "linear") => go::<f64, _>(growth, point, Ordinary::linearised(lps()?)),
            ("split", "f64", "finite") => {
                let stiffness = Stiffness::<3>::isotropic(&moduli)?;
                let split = PositiveSplit::solid(&stiffness, DENSITY, omega)?;
                go::<f64, _>(growth, point, Ordinary::new(split))
            }
            other => Err(format!("no body for {other:?}").into()),
        }
    });
    Ok(Scene { name: "beam", about, study, run })
}

fn go<T: Real, M: StrainEnergy<T, 3>>(growth: f64, point: &Point, material: M) -> Outcome<Record> {
    let (dx, m) = (point.number("Δx in mm")? * MM, point.number("m")?);
    let (length, width) = (30.0 * MM, 6.0 * MM);
    let beam = Beam { length, width, dx, m, quadrature: quadrature(point)? };
    let family = beam.family::<T>()?;
    let grid = family.grid().clone();
    let normal = [0.0, 1.0, 0.0];
    let own = CrackPlane::through_width(&family, normal, (2, width))?;
    let separated = Beam::separated(&own);
    let plane = match point.name("w_C from")? {
        "lattice and width" => own,
        "lattice" => CrackPlane::lattice(&family, normal)?,
        _ => CrackPlane::continuum(m * dx)?,
    };
    let criterion = BondEnergy::from_energy(FractureEnergy::new(ENERGY)?, &plane)?;
    let every = point.number("bonds tested every")? as usize;
    let mut body = beam.body::<T, _>(family, material, criterion, every)?;
    let start = damage(&body);
    let speed = point.number("speed in mm/s")? * MM;
    let rule = TimeStep::Safety(point.number("safety")?);
    let mut run = Run::new(&mut body, beam.pulled(&grid, speed), rule)?.with_energies();
    let looks = beam.open(&mut run, speed, growth, (&start, separated))?;
    let steps = run.steps();
    drop(run);
    let last = looks.last().filter(|look| look.growth > growth - 1e-6 * MM);
    let last = last.ok_or("the crack did not grow")?;
    let rate = Beam::energy_release_rate(&looks, [2.0 * MM, growth], width);
    let error = (rate / ENERGY - 1.0).abs();
    let share = last.energies.kinetic_share();
    Ok(Record::new(error)
        .of(&body, steps)
        .with("G [J/m²]", rate)
        .with("share of kinetic energy", share))
}
