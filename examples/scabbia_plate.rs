//! An anisotropic plate pulled on half an edge (Scabbia §6.3), against finite elements.
//!
//! ```text
//! cargo run --release --example scabbia_plate [-- --short | --full]
//! ```
//! Glass–epoxy, fibres at 40°, 0.3 × 0.2 m, clamped on the left edge, 10 MPa in x on the upper half
//! of the right one. The paper: Δx = 1 mm, m = 5, a fictitious layer as thick as the horizon on the
//! left and a body force in such a layer on the right; difference by Eq. 51 below 1 %.
//!
//! Conditions on the edges themselves (`Loads::displacement_at`, `Loads::traction`) and as the
//! paper; both calibrations, with and without surface correction. `--short` takes Δx = 5 mm,
//! `--full` every combination. Pictures go to `out/scabbia_plate/`.

use pd_testkit::fem::Displacements;
use pd_testkit::scabbia63::{Conditions, HEIGHT, LENGTH, PRESSURE, Plate, Solution as Solution63};
use peridynamics::io::{ColourMap, FieldMap};
use peridynamics::models::elasticity::catalogue::GLASS_EPOXY;
use peridynamics::models::{OnFamily, ScalarState};
use peridynamics::prelude::*;
use peridynamics::study::{Effort, Outcome, conclude, watch};
use std::time::Instant;

const FOLDER: &str = "out/scabbia_plate";
/// Deformed shapes are drawn magnified by this, as in the paper.
const SCALE: f64 = 50.0;

/// The solved plate, on its grid.
struct Solution {
    grid: Grid<2>,
    u: Vec<SVector<f64, 2>>,
    reaction: f64,
}

fn solve<S: ScalarState<f64, 2>>(
    name: &'static str,
    model: S,
    (dx, m): (f64, f64),
    conditions: Conditions,
) -> Outcome<(&'static str, Solution)> {
    let start = Instant::now();
    let plate = Plate { dx, m, quadrature: Quadrature::Exact, conditions, tolerance: 1e-6 };
    let Solution63 { body, clamp, solved } =
        plate.solve::<f64, _>(Ordinary::linearised(model), watch(name))?;
    println!(
        "{name}: {} nodes, {} iterations, {:.1} s",
        body.nodes(),
        solved.iterations,
        start.elapsed().as_secs_f64()
    );
    let reaction = peridynamics::core::run::reaction(&body, &clamp)[0];
    let u = (0..body.nodes()).map(|i| body.displacement(i)).collect();
    Ok((name, Solution { grid: body.family().grid().clone(), u, reaction }))
}

fn draw(file: &str, title: &str, solution: &Solution, dx: f64) -> Outcome {
    let inside: Vec<usize> =
        (0..solution.grid.len()).filter(|&i| solution.grid.position(i)[0] > 0.0).collect();
    let places: Vec<_> =
        inside.iter().map(|&i| solution.grid.position(i) + SCALE * solution.u[i]).collect();
    let size: Vec<f64> = inside.iter().map(|&i| solution.u[i].norm()).collect();
    FieldMap::new(&places, 1.15 * dx, &size).title(title).write(format!("{FOLDER}/{file}"))?;
    Ok(())
}

fn main() -> Outcome {
    let effort = Effort::from_arguments();
    let (dx, m) = (effort.choose(5e-3, 1e-3, 1e-3), 5.0);
    let plate = (dx, m);
    let fem = Displacements::read("scabbia63", ["ux_edge", "uy_edge"]);
    let fem_layer = Displacements::read("scabbia63", ["ux_layer5mm", "uy_layer5mm"]);
    let stiffness = Stiffness::<2>::lamina(&GLASS_EPOXY)?.rotated(40_f64.to_radians());
    let polynomial = PolynomialMicromoduli::plane(&stiffness, 1e3, InfluenceFunction::Gaussian)?;
    let split = PositiveSplit::plane(&stiffness, 1e3, InfluenceFunction::Gaussian)?;
    println!("Δx = {} mm, m = {m}", dx * 1e3);

    let (faces, layers) = (Conditions::Faces, Conditions::Layers(m * dx));
    let corrected = OnFamily::new(polynomial.clone(), &stiffness);
    let mut runs = vec![
        solve("paper", polynomial.clone(), plate, layers)?,
        solve("polynomial", polynomial, plate, faces)?,
        solve("polynomial, corrected", corrected.clone(), plate, faces)?,
        solve("positive split, layers", split.clone(), plate, layers)?,
        solve("positive split", split.clone(), plate, faces)?,
    ];
    if effort == Effort::Full {
        let row = Conditions::Layers(dx);
        runs.push(solve("polynomial, corrected, layers", corrected, plate, layers)?);
        runs.push(solve("positive split, layers, load in one row", split, plate, row)?);
    }

    let at_paper = dx == 1e-3;
    let mut table = Measures::new(
        "Plate under traction on half an edge (Scabbia §6.3)",
        &effort.command("scabbia_plate"),
    );
    for (name, solution) in &runs {
        let edge = fem.differences(&solution.grid, |i| solution.u[i]);
        let layer = fem_layer.differences(&solution.grid, |i| solution.u[i]);
        let worst = |d: &[f64]| d.iter().copied().fold(0.0, f64::max);
        let limit = if at_paper { 0.01 } else { 0.1 };
        let what = |what: &str| format!("{name}: {what}");
        table.hard_most(&what("difference (Eq. 51) to load on the edge"), worst(&edge), limit);
        let far = fem.points.iter().zip(&edge).filter(|(x, _)| x[0] < LENGTH - 0.02);
        let far = far.map(|(_, d)| *d).fold(0.0, f64::max);
        table.told(&what("the same, 20 mm away from the loaded edge"), far);
        table.told(&what("mean difference"), edge.iter().sum::<f64>() / edge.len() as f64);
        table.told(&what("difference to load in the last 5 mm"), worst(&layer));
        let force = PRESSURE * 0.5 * HEIGHT;
        table.hard_near(&what("reaction [N/m]"), solution.reaction, -force, 1e-4 * force);
        let file = name.replace([' ', ','], "_");
        draw(&format!("{file}.png"), &format!("{name}: |u| [m] (u x 50)"), solution, dx)?;
        FieldMap::new(&fem.points, 5e-3, &edge)
            .title(&format!("{name}: difference (Eq. 51)"))
            .range(0.0, if at_paper { 0.02 } else { 0.1 })
            .colours(ColourMap::Damage)
            .write(format!("{FOLDER}/{file}_difference.png"))?;
    }
    let places: Vec<_> = fem.points.iter().zip(&fem.u).map(|(x, u)| x + SCALE * u).collect();
    let size: Vec<f64> = fem.u.iter().map(|u| u.norm()).collect();
    FieldMap::new(&places, 6e-3, &size)
        .title("finite elements: |u| [m] (u x 50)")
        .write(format!("{FOLDER}/fem.png"))?;
    Ok(conclude(&table, effort, FOLDER, &[])?)
}
