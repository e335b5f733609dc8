//! A pulled bar of a monoclinic solid in 3D (Scabbia §6.5), against finite elements.
//!
//! ```text
//! cargo run --release --example scabbia_solid [-- --short | --full]
//! ```
//! PPS with carbon fibres turned by 30° about z, 0.6 × 0.15 × 0.12 m; clamped at x = 0, u_x = 1 mm
//! at x = 0.6 m with u_y and u_z free. The paper: Δx = 10 mm, m = 3, both in fictitious layers as
//! thick as the horizon, difference by Eq. 52 below 3 %. Here on the faces themselves
//! (`Loads::displacement_at`) and as the paper.
//!
//! `--short` takes Δx = 15 mm, `--full` adds Δx = 5 mm at m = 3 (δ-convergence). Pictures go to
//! `out/scabbia_solid/`.

use pd_testkit::fem::Displacements;
use peridynamics::io::{ColourMap, FieldMap};
use peridynamics::models::elasticity::catalogue::pps_carbon;
use peridynamics::models::{OnFamily, ScalarState};
use peridynamics::prelude::*;
use peridynamics::study::{Effort, Outcome, conclude, watch};
use std::time::Instant;

const FOLDER: &str = "out/scabbia_solid";
const SIZE: [f64; 3] = [0.6, 0.15, 0.12];
const PULL: f64 = 1e-3;
const M: f64 = 3.0;

struct Solution {
    grid: Grid<3>,
    u: Vec<SVector<f64, 3>>,
    force: f64,
}

/// Where the conditions act.
#[derive(Clone, Copy, PartialEq)]
enum Conditions {
    /// On the faces of the bar.
    Faces,
    /// In fictitious layers, as in the paper.
    Layers,
}

type Named = (&'static str, f64, Solution);

fn solve<S: ScalarState<f64, 3>>(
    name: &'static str,
    model: S,
    dx: f64,
    conditions: Conditions,
) -> Outcome<Named> {
    let layer = M * dx * if conditions == Conditions::Faces { 2.0 } else { 1.0 };
    let [x, y, z] = SIZE;
    let grid = Grid::new(&Cuboid::new([-layer, 0.0, 0.0], [x + layer, y, z])?, dx)?;
    let family = Lattice::<f64, 3>::new(&grid, Horizon::Cells(M), Quadrature::Exact)?;
    let mut body = Body::new(family, Ordinary::linearised(model), NoDamage)?;
    let (left, right) = (grid.select(|p| p[0] < 0.0), grid.select(|p| p[0] > x));
    let loads = match conditions {
        Conditions::Faces => {
            let start = Face::new([0.0; 3], [-1.0, 0.0, 0.0])?;
            let end = Face::new(SIZE, [1.0, 0.0, 0.0])?;
            (0..3)
                .fold(Loads::new(), |l, axis| l.displacement_at(&start, &left, axis, 0.0))
                .displacement_at(&end, &right, 0, PULL)
        }
        Conditions::Layers => Loads::new().clamp::<3>(&left).displacement(&right, 0, PULL),
    };
    let start = Instant::now();
    // The paper asks for 1e-4 only; here the solver must not show in the differences.
    let solved =
        Statics::new().with_tolerance(1e-6)?.solve_watched(&mut body, loads, watch(name))?;
    let (nodes, seconds) = (body.nodes(), start.elapsed().as_secs_f64());
    println!("{name}: {nodes} nodes, {} iterations, {seconds:.1} s", solved.iterations);
    let solution = Solution {
        force: peridynamics::core::run::reaction(&body, &right)[0],
        u: (0..body.nodes()).map(|i| body.displacement(i)).collect(),
        grid,
    };
    Ok((name, dx, solution))
}

fn main() -> Outcome {
    let effort = Effort::from_arguments();
    let dx = effort.choose(15e-3, 10e-3, 10e-3);
    let fem = Displacements::read("scabbia65", ["ux_free", "uy_free", "uz_free"]);
    let stiffness = pps_carbon()?.rotated_about_z(30_f64.to_radians());
    let polynomial = PolynomialMicromoduli::solid(&stiffness, 1e3, InfluenceFunction::Gaussian)?;
    let split = PositiveSplit::solid(&stiffness, 1e3, InfluenceFunction::Gaussian)?;
    let corrected = OnFamily::new(polynomial.clone(), &stiffness);
    println!("Δx = {} mm, m = {M}", dx * 1e3);
    let (faces, layers) = (Conditions::Faces, Conditions::Layers);
    let mut runs = vec![
        solve("paper", polynomial.clone(), dx, layers)?,
        solve("polynomial", polynomial.clone(), dx, faces)?,
        solve("polynomial, corrected", corrected, dx, faces)?,
        solve("positive split, layers", split.clone(), dx, layers)?,
        solve("positive split", split.clone(), dx, faces)?,
    ];
    if effort == Effort::Full {
        runs.push(solve("polynomial, half spacing", polynomial, 5e-3, faces)?);
        runs.push(solve("positive split, half spacing", split, 5e-3, faces)?);
    }
    let mut table =
        Measures::new("Bar of a monoclinic solid (Scabbia §6.5)", &effort.command("scabbia_solid"));
    for (name, dx, solution) in &runs {
        let differences = fem.differences(&solution.grid, |i| solution.u[i]);
        let worst = differences.iter().copied().fold(0.0, f64::max);
        let limit = if effort == Effort::Short { 0.1 } else { 0.03 };
        let what = |what: &str| format!("{name}: {what}");
        table.hard_most(&what("difference (Eq. 52)"), worst, limit);
        let slice = |low: f64, high: f64| {
            let inside = fem.points.iter().zip(&differences);
            let inside = inside.filter(|(x, _)| (low..high).contains(&x[0]));
            inside.map(|(_, d)| *d).fold(0.0, f64::max)
        };
        table.told(&what("in the third at the clamp"), slice(0.0, 0.2));
        table.told(&what("in the middle third"), slice(0.2, 0.4));
        table.told(&what("in the third that is pulled"), slice(0.4, 0.6));
        table.told(&what("mean"), differences.iter().sum::<f64>() / differences.len() as f64);
        table.compared(&what("force [kN]"), solution.force / 1e3, 572.65);
        let end: Vec<usize> = (0..solution.grid.len())
            .filter(|&i| (0.6 - dx..0.6).contains(&solution.grid.position(i)[0]))
            .collect();
        let sideways = end.iter().map(|&i| solution.u[i].y).sum::<f64>() / end.len() as f64;
        table.compared(&what("mean u_y of the pulled end [mm]"), sideways * 1e3, -0.63364);

        let file = name.replace([' ', ','], "_");
        let front: Vec<usize> =
            (0..fem.points.len()).filter(|&i| fem.points[i][2] < 0.01).collect();
        let places: Vec<SVector<f64, 2>> = front.iter().map(|&i| fem.points[i].xy()).collect();
        let values: Vec<f64> = front.iter().map(|&i| differences[i]).collect();
        FieldMap::new(&places, 15e-3, &values)
            .title(&format!("{name}: difference (Eq. 52), face z = 0"))
            .range(0.0, limit)
            .colours(ColourMap::Damage)
            .write(format!("{FOLDER}/{file}_difference.png"))?;
        let face: Vec<usize> = (0..solution.grid.len())
            .filter(|&i| {
                let x = solution.grid.position(i);
                x[2] < *dx && (0.0..0.6).contains(&x[0])
            })
            .collect();
        let places: Vec<SVector<f64, 2>> = face
            .iter()
            .map(|&i| (solution.grid.position(i) + 100.0 * solution.u[i]).xy())
            .collect();
        let size: Vec<f64> = face.iter().map(|&i| solution.u[i].norm()).collect();
        FieldMap::new(&places, 1.25 * dx, &size)
            .title(&format!("{name}: |u| [m], face z = 0 (u x 100)"))
            .write(format!("{FOLDER}/{file}.png"))?;
    }
    Ok(conclude(&table, effort, FOLDER, &[])?)
}
