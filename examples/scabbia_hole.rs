//! A pulled anisotropic plate with a hole (Scabbia §6.4), against finite elements.
//!
//! ```text
//! cargo run --release --example scabbia_hole [-- --short | --full]
//! ```
//! Glass–epoxy, fibres at −25°, 0.4 × 0.2 m, hole of radius 50 mm; u_x = 0 on the left edge, 0.1 mm
//! on the right, u_y = 0 in the lower left corner. The paper: Δx = 1 mm, m = 5, fictitious layers as
//! thick as the horizon at both ends, 72 140 nodes in the plate; difference by Eq. 51 below 3 %.
//!
//! Conditions on the edges themselves (`Loads::displacement_at`) and as the paper, where the lowest
//! row of the left layer holds u_y. Where exactly u_y is held moves the whole plate, so that the
//! difference is also given without its mean in y.
//!
//! `--short` takes Δx = 5 mm, `--full` adds the polynomial micromoduli with surface correction.
//! Pictures go to `out/scabbia_hole/`.

use pd_testkit::fem::{self, Displacements};
use peridynamics::io::{ColourMap, FieldMap, LinePlot};
use peridynamics::models::elasticity::catalogue::GLASS_EPOXY;
use peridynamics::models::{OnFamily, ScalarState};
use peridynamics::prelude::*;
use peridynamics::study::{Effort, Outcome, conclude, watch};
use std::time::Instant;

const FOLDER: &str = "out/scabbia_hole";
const LENGTH: f64 = 0.4;
const HEIGHT: f64 = 0.2;
const CENTRE: [f64; 2] = [0.2, 0.1];
const RADIUS: f64 = 0.05;
const PULL: f64 = 1e-4;
const M: f64 = 5.0;
/// Deformed shapes are drawn magnified by this, as in the paper.
const SCALE: f64 = 50.0;

struct Solution {
    grid: Grid<2>,
    u: Vec<SVector<f64, 2>>,
    /// Force in x in N per metre of thickness that the right layer exerts.
    force: f64,
    plate_nodes: usize,
}

/// Where the conditions act.
#[derive(Clone, Copy, PartialEq)]
enum Conditions {
    /// On the edges of the plate.
    Faces,
    /// In fictitious layers, as in the paper.
    Layers,
}

fn solve<S: ScalarState<f64, 2>>(
    name: &'static str,
    model: S,
    dx: f64,
    conditions: Conditions,
) -> Outcome<(&'static str, Solution)> {
    let layer = M * dx * if conditions == Conditions::Faces { 2.0 } else { 1.0 };
    let grid = Grid::new(&Cuboid::new([-layer, 0.0], [LENGTH + layer, HEIGHT])?, dx)?;
    let centre = SVector::from(CENTRE);
    let grid = grid.retain(|x| (x - centre).norm() >= RADIUS)?;
    let family = Lattice::<f64, 2>::new(&grid, Horizon::Cells(M), Quadrature::Exact)?;
    let mut body = Body::new(family, Ordinary::linearised(model), NoDamage)?;
    let (left, right) = (grid.select(|x| x[0] < 0.0), grid.select(|x| x[0] > LENGTH));
    let loads = match conditions {
        Conditions::Faces => {
            let corner = grid.select(|x| (-dx..0.0).contains(&x[0]) && x[1] < dx);
            let [start, end] =
                [(0.0, -1.0), (LENGTH, 1.0)].map(|(x, normal)| Face::new([x, 0.0], [normal, 0.0]));
            let (start, end) = (start?, end?);
            Loads::new()
                .displacement_at(&start, &left, 0, 0.0)
                .displacement_at(&end, &right, 0, PULL)
                .displacement_at(&start, &corner, 1, 0.0)
        }
        Conditions::Layers => {
            let pin = grid.select(|x| x[0] < 0.0 && x[1] < dx);
            Loads::new()
                .displacement(&left, 0, 0.0)
                .displacement(&right, 0, PULL)
                .displacement(&pin, 1, 0.0)
        }
    };
    let start = Instant::now();
    let solved =
        Statics::new().with_tolerance(1e-6)?.solve_watched(&mut body, loads, watch(name))?;
    let (nodes, seconds) = (body.nodes(), start.elapsed().as_secs_f64());
    println!("{name}: {nodes} nodes, {} iterations, {seconds:.1} s", solved.iterations);
    let solution = Solution {
        force: peridynamics::core::run::reaction(&body, &right)[0],
        u: (0..body.nodes()).map(|i| body.displacement(i)).collect(),
        plate_nodes: body.nodes() - left.len() - right.len(),
        grid,
    };
    Ok((name, solution))
}

/// Hoop stress in Pa at the angle θ on the hole: C : the strain fitted by least squares to the
/// displacements of the nodes nearer than `window` to the edge point, taken at that point.
fn hoop(solution: &Solution, stiffness: &Stiffness<2>, degrees: f64, window: f64) -> f64 {
    let (sine, cosine) = degrees.to_radians().sin_cos();
    let edge = SVector::from(CENTRE) + SVector::from([cosine, sine]) * RADIUS;
    let near = solution.grid.select(|x| (x - edge).norm() < window);
    // u = u₀ + H (x − edge) + quadratic terms, which a strain that falls off the edge needs.
    let row = |x: SVector<f64, 2>| {
        let d = (x - edge) / window;
        SVector::<f64, 6>::from([1.0, d.x, d.y, d.x * d.x, d.x * d.y, d.y * d.y])
    };
    let (mut normal, mut right) = (SMatrix::<f64, 6, 6>::zeros(), SMatrix::<f64, 6, 2>::zeros());
    for node in near.iter() {
        let r = row(solution.grid.position(node));
        normal += r * r.transpose();
        right += r * solution.u[node].transpose();
    }
    let fit = normal.try_inverse().map_or(SMatrix::zeros(), |inverse| inverse * right);
    let h = SMatrix::<f64, 2, 2>::from_fn(|i, j| fit[(1 + j, i)] / window);
    let stress = stiffness.contract(&((h + h.transpose()) * 0.5));
    let t = SVector::from([-sine, cosine]);
    t.dot(&(stress * t))
}

fn main() -> Outcome {
    let effort = Effort::from_arguments();
    let dx = effort.choose(5e-3, 1e-3, 1e-3);
    let at_paper = dx == 1e-3;
    let fem = Displacements::read("scabbia64", ["ux", "uy"]);
    let stiffness = Stiffness::<2>::lamina(&GLASS_EPOXY)?.rotated(-25_f64.to_radians());
    let polynomial = PolynomialMicromoduli::plane(&stiffness, 1e3, InfluenceFunction::Gaussian)?;
    let split = PositiveSplit::plane(&stiffness, 1e3, InfluenceFunction::Gaussian)?;
    println!("Δx = {} mm, m = {M}", dx * 1e3);
    let (faces, layers) = (Conditions::Faces, Conditions::Layers);
    let mut runs = vec![
        solve("paper", polynomial.clone(), dx, layers)?,
        solve("polynomial", polynomial.clone(), dx, faces)?,
        solve("positive split", split.clone(), dx, faces)?,
    ];
    if effort != Effort::Default {
        let corrected = OnFamily::new(polynomial, &stiffness);
        runs.push(solve("polynomial, corrected", corrected, dx, faces)?);
        runs.push(solve("positive split, layers", split, dx, layers)?);
    }

    let reference = fem::table("scabbia64_hoop");
    let (angles, hoop_fem) = (&reference["theta_deg"], &reference["hoop_FEM_Pa(n=48)"]);
    let largest = hoop_fem.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let line = |values: &[f64]| -> Vec<(f64, f64)> {
        angles.iter().zip(values).map(|(a, s)| (*a, s / 1e6)).collect()
    };
    let mut plot = LinePlot::new("hoop stress on the hole", "angle from x [°]", "stress [MPa]")
        .line("finite elements", &line(hoop_fem));
    let mut table =
        Measures::new("Pulled plate with a hole (Scabbia §6.4)", &effort.command("scabbia_hole"));
    for (name, solution) in &runs {
        let what = |what: &str| format!("{name}: {what}");
        if at_paper {
            table.hard_near(&what("nodes in the plate"), solution.plate_nodes as f64, 72140.0, 0.0);
        }
        let limit = if at_paper { 0.03 } else { 0.15 };
        let raw = fem.differences(&solution.grid, |i| solution.u[i]);
        let worst = |d: &[f64]| d.iter().copied().fold(0.0, f64::max);
        let at = |x: &SVector<f64, 2>| fem::interpolate(&solution.grid, |i| solution.u[i], x);
        let offset = fem.points.iter().zip(&fem.u).map(|(x, u)| at(x).y - u.y).sum::<f64>()
            / fem.points.len() as f64;
        let shift = SVector::from([0.0, offset]);
        let shifted = fem.differences(&solution.grid, |i| solution.u[i] - shift);
        table.hard_most(&what("difference (Eq. 51)"), worst(&raw), limit);
        table.told(&what("without the mean of u_y"), worst(&shifted));
        table.told(&what("mean difference"), raw.iter().sum::<f64>() / raw.len() as f64);
        table.compared(&what("force [N/mm]"), solution.force * 1e-3, 646.203);
        let stress: Vec<f64> =
            angles.iter().map(|&a| hoop(solution, &stiffness, a, 4.0 * dx)).collect();
        let peak = stress.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        table.compared(&what("largest hoop stress [MPa]"), peak / 1e6, largest / 1e6);
        plot = plot.line(name, &line(&stress));

        let file = name.replace([' ', ','], "_");
        FieldMap::new(&fem.points, 5e-3, &shifted)
            .title(&format!("{name}: difference (Eq. 51), mean of u_y removed"))
            .range(0.0, limit)
            .colours(ColourMap::Damage)
            .write(format!("{FOLDER}/{file}_difference.png"))?;
        let inside: Vec<usize> = (0..solution.grid.len())
            .filter(|&i| (0.0..LENGTH).contains(&solution.grid.position(i)[0]))
            .collect();
        let places: Vec<_> =
            inside.iter().map(|&i| solution.grid.position(i) + SCALE * solution.u[i]).collect();
        let size: Vec<f64> = inside.iter().map(|&i| solution.u[i].norm()).collect();
        FieldMap::new(&places, 1.15 * dx, &size)
            .title(&format!("{name}: |u| [m] (u x 50)"))
            .write(format!("{FOLDER}/{file}.png"))?;
    }
    plot.write(format!("{FOLDER}/hoop.png"))?;
    Ok(conclude(&table, effort, FOLDER, &[])?)
}
