//! Static crack and hole in infinite anisotropic plates, against closed forms (Stroh, Lekhnitskii).
//!
//! ```text
//! cargo run --release --example static_closed_forms [-- --short | --full]
//! ```
//! A square cut out of the infinite plate, three crack lengths or four diameters wide, with the exact
//! displacement prescribed in a collar outside; positive split, m = 3. Read: displacements inside,
//! stress intensity by the opening (Hattori Eq. 33) and the stress around the hole.
//!
//! The opening of a body is that of a crack somewhat longer: Δu² is linear in x² as for the crack,
//! Δu = 2σ L⁻¹ √(a'² − x²), with a' > a. K from the slope of Δu² does not see that; K from one point
//! does. `--short` takes Δx = a/8, usually a/20, `--full` a/40. Pictures go to
//! `out/static_closed_forms/`.

use pd_testkit::fem;
use pd_testkit::infinite_plate::{InfinitePlate, Square, hoop};
use peridynamics::io::{ColourMap, FieldMap, LinePlot};
use peridynamics::models::elasticity::catalogue::{GLASS_EPOXY, GRAPHITE_EPOXY};
use peridynamics::prelude::*;
use peridynamics::study::{Effort, Outcome, conclude};
use std::f64::consts::PI;

const FOLDER: &str = "out/static_closed_forms";
const STRESS: f64 = 1e6;
/// Half length of the crack and radius of the hole in metres.
const A: f64 = 20e-3;
const M: f64 = 3.0;

/// A solved square: the grid, the displacements and their errors inside.
struct Solved {
    grid: Grid<2>,
    u: Vec<SVector<f64, 2>>,
    /// Largest error of a displacement inside over the largest disturbance.
    error: f64,
    errors: Vec<(SVector<f64, 2>, f64)>,
}

fn solve<P>(
    stiffness: &Stiffness<2>,
    policy: P,
    (dx, half): (f64, f64),
    keep: impl Fn(&SVector<f64, 2>) -> bool,
    exact: impl Fn(&SVector<f64, 2>) -> SVector<f64, 2>,
) -> Outcome<Solved>
where
    P: DamagePolicy<f64, 2, Ordinary<PositiveSplit<2, 3>, peridynamics::models::Linearised>>,
{
    let model = PositiveSplit::plane(stiffness, 1e3, InfluenceFunction::Gaussian)?;
    let square = Square { half, dx, m: M, quadrature: Quadrature::Exact };
    let parts = (Ordinary::linearised(model), policy);
    let (body, _) = square.solve::<f64, _, _>(parts, Statics::new(), keep, &exact)?;
    let grid = body.family().grid().clone();
    let u: Vec<_> = (0..grid.len()).map(|i| body.displacement(i)).collect();
    let errors = square.errors(&grid, |i| u[i], exact);
    let error = errors.iter().map(|e| e.1).fold(0.0, f64::max);
    Ok(Solved { grid, u, error, errors })
}

fn draw(name: &str, solved: &Solved, dx: f64) -> Outcome {
    let (places, values): (Vec<_>, Vec<_>) = solved.errors.iter().copied().unzip();
    FieldMap::new(&places, dx, &values)
        .title(&format!("{name}: error of u"))
        .colours(ColourMap::Damage)
        .write(format!("{FOLDER}/{}.png", name.replace(' ', "_").replace('°', "")))?;
    Ok(())
}

fn crack(
    (name, ply): (&str, &Lamina),
    degrees: f64,
    (dx, limit): (f64, f64),
    table: &mut Measures,
) -> Outcome {
    let stiffness = Stiffness::<2>::lamina(ply)?.rotated(degrees.to_radians());
    let plate = InfinitePlate::new(&stiffness, SMatrix::from([[0.0, 0.0], [0.0, STRESS]]));
    let stroh = Stroh::new(&stiffness, 0.0)?;
    let segment = Segment::new([-A, 0.0], [A, 0.0])?;
    let policy = Precracked::by(segment).leaving_family();
    let solved = solve(&stiffness, policy, (dx, 3.0 * A), |_| true, |x| plate.crack(A, x))?;
    let title = format!("crack {name} {degrees}°");
    let what = |what: &str| format!("{title}: {what}");
    table.told(&what("error of u inside, over its largest value"), solved.error);
    draw(&title, &solved, dx)?;

    // Opening between the rows next to the crack, as the opening stress it stands for:
    // L Δu / 2 = σ √(a'² − x²).
    let inverse = stroh.opening_compliance().try_inverse().ok_or("L")?;
    let cells = solved.grid.cells();
    let opening = |column: usize| {
        let node = |row: usize| solved.grid.node([column, row]).expect("a full grid");
        let (low, high) = (node(cells[1] / 2 - 1), node(cells[1] / 2));
        (solved.grid.position(high)[0], inverse * (solved.u[high] - solved.u[low]) * 0.5)
    };
    let inside: Vec<_> = (0..cells[0]).map(opening).filter(|(x, _)| x.abs() < 0.8 * A).collect();
    // Least squares of s₂² = σ² a'² − σ² x².
    let n = inside.len() as f64;
    let points = || inside.iter().map(|(x, s)| (x * x, s[1] * s[1]));
    let (mx, my) = (points().map(|p| p.0).sum::<f64>() / n, points().map(|p| p.1).sum::<f64>() / n);
    let slope = points().map(|p| (p.0 - mx) * (p.1 - my)).sum::<f64>()
        / points().map(|p| (p.0 - mx).powi(2)).sum::<f64>();
    let sigma = (-slope).sqrt();
    let longer = ((my / sigma.powi(2) + mx).sqrt() - A) / (M * dx);
    let name = what("K_I from the slope of Δu² over x², error");
    table.hard_most(&name, (sigma / STRESS - 1.0).abs(), limit);
    table.told(&what("it opens as if longer at each tip by, in horizons"), longer);
    let shear = inside.iter().map(|(_, s)| s[0].abs()).fold(0.0, f64::max) / (STRESS * A);
    table.hard_most(&what("K_II over K_I, should vanish"), shear, limit);
    let r = 0.25 * A;
    let near = (0..cells[0])
        .map(opening)
        .min_by(|p, q| (p.0 - (A - r)).abs().total_cmp(&(q.0 - (A - r)).abs()));
    let (x, s) = near.ok_or("no node")?;
    let k = stroh.intensity(A - x, &(stroh.opening_compliance() * s * 2.0));
    // The opening at r of the crack itself is not quite that of its first term.
    let exact = STRESS * ((A * A - x * x) / (2.0 * A * (A - x))).sqrt() * (PI * A).sqrt();
    table.told(&what("K_I from one point at r = a/4, error"), k.i / exact - 1.0);
    Ok(())
}

fn hole(
    (name, ply, column): (&str, &Lamina, &str),
    degrees: f64,
    (dx, limit): (f64, f64),
    table: &mut Measures,
) -> Outcome {
    let stiffness = Stiffness::<2>::lamina(ply)?.rotated(degrees.to_radians());
    let plate = InfinitePlate::new(&stiffness, SMatrix::from([[STRESS, 0.0], [0.0, 0.0]]));
    let keep = |x: &SVector<f64, 2>| x.norm() >= A;
    let solved = solve(&stiffness, NoDamage, (dx, 4.0 * A), keep, |x| plate.hole(A, x))?;
    let title = format!("hole {name} {degrees}°");
    let what = |what: &str| format!("{title}: {what}");
    table.hard_most(&what("error of u inside, over its largest value"), solved.error, limit);
    draw(&title, &solved, dx)?;
    let reference = fem::table("lekhnitskii_hole");
    let (angles, exact) = (&reference["theta_deg"], &reference[column]);
    let field = |i: usize| solved.u[i];
    let at = |angle: f64| hoop((&solved.grid, field), &stiffness, A, angle, 4.0 * dx);
    let got: Vec<f64> = angles.iter().map(|&angle| at(angle) / STRESS).collect();
    let largest = |values: &[f64]| values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let (peak, exact_peak) = (largest(&got), largest(exact));
    table.compared(&what("stress concentration"), peak, exact_peak);
    let rms = got.iter().zip(exact).map(|(a, b)| (a - b).powi(2)).sum::<f64>();
    let rms = (rms / exact.iter().map(|b| b * b).sum::<f64>()).sqrt();
    table.hard_most(&what("hoop stress, L2 error over all angles"), rms, 3.0 * limit);
    let line = |v: &[f64]| angles.iter().copied().zip(v.iter().copied()).collect::<Vec<_>>();
    LinePlot::new(&format!("hoop stress, {title}"), "angle from x [°]", "over remote stress")
        .line("closed form", &line(exact))
        .line("peridynamic", &line(&got))
        .write(format!("{FOLDER}/hoop_{}.png", title.replace(' ', "_").replace('°', "")))?;
    Ok(())
}

fn main() -> Outcome {
    let effort = Effort::from_arguments();
    let dx = A / effort.choose(8.0, 20.0, 40.0);
    let limit = effort.choose(0.15, 0.05, 0.03);
    // Isotropic to a thousandth: the closed form needs distinct roots.
    let steel = Lamina { e1: 200e9, e2: 200.2e9, g12: 200e9 / 2.6, nu12: 0.3 };
    println!("Δx = {} mm, m = {M}", dx * 1e3);
    let title = "Static crack and hole in infinite plates";
    let mut table = Measures::new(title, &effort.command("static_closed_forms"));
    let size = (dx, limit);
    crack(("isotropic", &steel), 0.0, size, &mut table)?;
    for degrees in
        effort.choose(vec![30.0], vec![0.0, 30.0, 90.0], vec![0.0, 30.0, 45.0, 60.0, 90.0])
    {
        crack(("graphite–epoxy", &GRAPHITE_EPOXY), degrees, size, &mut table)?;
    }
    hole(("isotropic", &steel, "circle_isotropic"), 0.0, size, &mut table)?;
    hole(("glass–epoxy", &GLASS_EPOXY, "circle_phi0"), 0.0, size, &mut table)?;
    hole(("glass–epoxy", &GLASS_EPOXY, "circle_phi-25"), -25.0, size, &mut table)?;
    Ok(conclude(&table, effort, FOLDER, &[])?)
}
