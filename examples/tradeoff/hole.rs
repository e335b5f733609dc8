//! The stress around a hole against Lekhnitskii's closed form.

use super::{Scene, influence, quadrature};
use pd_testkit::clock::seconds;
use pd_testkit::fem::table;
use pd_testkit::infinite_plate::{InfinitePlate, Square, hoop};
use peridynamics::models::OnFamily;
use peridynamics::models::elasticity::catalogue::GLASS_EPOXY;
use peridynamics::prelude::*;
use peridynamics::study::{Effort, Outcome};
use peridynamics::trade::{Point, Record};

/// Radius of the hole in metres.
const A: f64 = 20e-3;
/// Remote stress along the fibres in Pa.
const STRESS: f64 = 1e6;

struct Reference {
    ply: Stiffness<2>,
    plate: InfinitePlate,
    angles: Vec<f64>,
    hoop: Vec<f64>,
}

pub fn scene(effort: Effort) -> Outcome<Scene> {
    let cells = effort.choose(
        vec![6.0, 8.0],
        vec![16.0, 8.0, 12.0, 24.0],
        vec![24.0, 8.0, 12.0, 16.0, 32.0, 40.0],
    );
    let study = Study::new(&format!("hole, {effort:?}"))
        .knob("a/Δx", cells)
        .knob("m", [3.0, 2.0, 4.0, 5.0])
        .knob("influence", ["Gaussian", "constant", "linear"])
        .knob("β", ["exact", "none", "ramp"])
        .knob("calibration", ["split", "polynomial", "polynomial, surface corrected"])
        .knob("tolerance", [1e-4, 1e-2, 1e-3, 1e-6])
        .figure("error of the hoop stress")
        .clock(seconds)
        .one_at_a_time()?
        .grid(&["a/Δx", "m"])?;
    let about = "Statics: a hole of radius a in an infinite glass–epoxy plate pulled along its fibres. \
                 The error is the largest one of a displacement over the largest displacement; that of the \
                 hoop stress on the hole (root of mean squares over all angles) is read by a quadratic \
                 fit within four spacings of its staircase. Steps are iterations of the solver.";
    let ply = Stiffness::<2>::lamina(&GLASS_EPOXY)?;
    let plate = InfinitePlate::new(&ply, SMatrix::from([[STRESS, 0.0], [0.0, 0.0]]));
    let columns = table("lekhnitskii_hole");
    let (angles, hoop) = (columns["theta_deg"].clone(), columns["circle_phi0"].clone());
    let reference = Reference { ply, plate, angles, hoop };
    let run = Box::new(move |point: &Point| -> Outcome<Record> {
        let (omega, ply) = (influence(point)?, &reference.ply);
        let polynomial = || PolynomialMicromoduli::plane(ply, 1e3, omega);
        match point.name("calibration")? {
            "split" => {
                let split = PositiveSplit::plane(ply, 1e3, omega)?;
                go(&reference, point, Ordinary::linearised(split))
            }
            "polynomial" => go(&reference, point, Ordinary::linearised(polynomial()?)),
            _ => {
                let corrected = OnFamily::new(polynomial()?, ply);
                go(&reference, point, Ordinary::linearised(corrected))
            }
        }
    });
    Ok(Scene { name: "hole", about, study, run })
}

fn go<M: Material<f64, 2>>(reference: &Reference, point: &Point, material: M) -> Outcome<Record> {
    let Reference { ply, plate, angles, hoop: exact } = reference;
    let dx = A / point.number("a/Δx")?;
    let square =
        Square { half: 4.0 * A, dx, m: point.number("m")?, quadrature: quadrature(point)? };
    let statics = Statics::new().with_tolerance(point.number("tolerance")?)?;
    let hole = |x: &SVector<f64, 2>| plate.hole(A, x);
    let parts = (material, NoDamage);
    let (body, solved) = square.solve::<f64, _, _>(parts, statics, |x| x.norm() >= A, hole)?;
    let u = |node: usize| body.displacement(node);
    let grid = body.family().grid();
    let (mut apart, mut all) = (0.0, 0.0);
    for (&angle, exact) in angles.iter().zip(exact) {
        let got = hoop((grid, u), ply, A, angle, 4.0 * dx) / STRESS;
        apart += (got - exact).powi(2);
        all += exact * exact;
    }
    let of_u = square.errors(grid, u, hole).iter().map(|e| e.1).fold(0.0, f64::max);
    let record = Record::new(of_u).of(&body, solved.iterations);
    Ok(record.with("error of the hoop stress", (apart / all).sqrt()))
}
