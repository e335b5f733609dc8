//! The anisotropic plate of Scabbia §6.3 against finite elements.

use super::{Scene, influence, quadrature};
use pd_testkit::clock::seconds;
use pd_testkit::fem::Displacements;
use pd_testkit::scabbia63::{Conditions, Plate};
use peridynamics::models::OnFamily;
use peridynamics::models::elasticity::catalogue::GLASS_EPOXY;
use peridynamics::prelude::*;
use peridynamics::study::{Effort, Outcome};
use peridynamics::trade::{Point, Record};

pub fn scene(effort: Effort) -> Outcome<Scene> {
    let spacings = effort.choose(
        vec![10e-3, 5e-3],
        vec![2.5e-3, 10e-3, 5e-3, 1.25e-3],
        vec![2.5e-3, 10e-3, 5e-3, 1.25e-3, 1e-3],
    );
    let study = Study::new(&format!("Scabbia 6.3, {effort:?}"))
        .knob("Δx", spacings)
        .knob("m", [3.0, 2.0, 4.0, 5.0])
        .knob("influence", ["Gaussian", "constant", "linear"])
        .knob("β", ["exact", "none", "ramp"])
        .knob("calibration", ["split", "polynomial", "polynomial, surface corrected"])
        .knob("load", ["last row", "layer of the horizon"])
        .knob("precision", ["f64", "f32"])
        .knob("tolerance", [1e-3, 1e-2, 1e-4, 1e-6])
        .figure("mean difference")
        .resolution(0.002)
        .clock(seconds)
        .one_at_a_time()?
        .grid(&["Δx", "m"])?
        .grid(&["calibration", "m"])?;
    let about = "Statics: glass–epoxy at 40°, 0.3 × 0.2 m, clamped on the left, pulled on half its \
                 right edge. The error is the largest difference to finite elements (Scabbia Eq. 51). \
                 Steps are iterations of the solver.";
    let fem = Displacements::<2>::read("scabbia63", ["ux_edge", "uy_edge"]);
    let ply = Stiffness::<2>::lamina(&GLASS_EPOXY)?.rotated(40_f64.to_radians());
    let run = Box::new(move |point: &Point| -> Outcome<Record> {
        let omega = influence(point)?;
        let split = || PositiveSplit::plane(&ply, 1e3, omega).map(Ordinary::linearised);
        let polynomial = || PolynomialMicromoduli::plane(&ply, 1e3, omega);
        match (point.name("calibration")?, point.name("precision")?) {
            ("split", "f64") => go::<f64, _>(&fem, point, split()?),
            ("split", "f32") => go::<f32, _>(&fem, point, split()?),
            ("polynomial", "f64") => go::<f64, _>(&fem, point, Ordinary::linearised(polynomial()?)),
            ("polynomial, surface corrected", "f64") => {
                let corrected = OnFamily::new(polynomial()?, &ply);
                go::<f64, _>(&fem, point, Ordinary::linearised(corrected))
            }
            other => Err(format!("no body for {other:?}").into()),
        }
    });
    Ok(Scene { name: "plate", about, study, run })
}

fn go<T: Real, M: Material<T, 2>>(
    fem: &Displacements<2>,
    point: &Point,
    material: M,
) -> Outcome<Record> {
    let (dx, m) = (point.number("Δx")?, point.number("m")?);
    let depth = if point.name("load")? == "last row" { dx } else { m * dx };
    let (quadrature, tolerance) = (quadrature(point)?, point.number("tolerance")?);
    let plate = Plate { dx, m, quadrature, conditions: Conditions::Layers(depth), tolerance };
    let solution = plate.solve::<T, _>(material, |_| {})?;
    let body = &solution.body;
    let apart = fem.differences(body.family().grid(), |node| body.displacement(node));
    let worst = apart.iter().copied().fold(0.0, f64::max);
    let mean = apart.iter().sum::<f64>() / apart.len() as f64;
    Ok(Record::new(worst).of(body, solution.solved.iterations).with("mean difference", mean))
}
