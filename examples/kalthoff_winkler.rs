//! Kalthoff and Winkler's experiment in 3D: a steel plate with two notches is hit between them, and
//! a crack leaves each notch at about 68°. Not in the papers; the field expects it.
//!
//! ```text
//! cargo run --release --example kalthoff_winkler [-- --short | --full]
//! ```
//! Plate 100 × 200 × 9 mm of 18Ni1900 (E = 190 GPa, ρ = 8000 kg/m³, G₀ = 22.2 kJ/m²; bond-based,
//! ν = ¼), notches of 50 mm, 50 mm apart, hit at 32 m/s by a projectile of the same impedance, so
//! that the edge between the notches moves at 16 m/s. Pictures and the table go to
//! `out/kalthoff_winkler/`.

use peridynamics::damage::crack_path::{fit_line, symmetry_error, without_ends};
use peridynamics::prelude::*;
use peridynamics::study::{Effort, conclude, damage, draw_damage};

type Place = SVector<f64, 3>;

const MM: f64 = 1e-3;
const FOLDER: &str = "out/kalthoff_winkler";
const LENGTH: f64 = 100.0 * MM;
const HEIGHT: f64 = 200.0 * MM;
const THICKNESS: f64 = 9.0 * MM;
const NOTCH: f64 = 50.0 * MM;
const SPEED: f64 = 16.0;
const ENERGY: f64 = 22.2e3;

fn other(error: impl std::fmt::Display) -> Error {
    Error::Other(error.to_string())
}

fn main() -> Result<()> {
    let effort = Effort::from_arguments();
    let dx = effort.choose(2.5, 1.0, 0.75) * MM;
    let moduli = Isotropic::from_young_poisson(190e9, 0.25).map_err(other)?;
    let omega = InfluenceFunction::Constant;
    let steel = Pmb::solid(&moduli, 8000.0, omega).map_err(other)?;
    // Impact on x = 0, notches at y = ±25 mm up to x = 50 mm.
    let corner = [0.0, -0.5 * HEIGHT, -0.5 * THICKNESS];
    let grid = Grid::new(&Cuboid::new(corner, [LENGTH, 0.5 * HEIGHT, 0.5 * THICKNESS])?, dx)?;
    let family = Lattice::<f64, 3>::new(&grid, Horizon::Cells(3.015), Quadrature::None)?;
    let model = BondModel::pmb(moduli.bulk(), omega)?;
    let plane = CrackPlane::lattice(&family, [0.0, 1.0, 0.0])?;
    let stretch = CriticalStretch::from_energy(FractureEnergy::new(ENERGY)?, &model, &plane)?;
    // Between two rows of nodes.
    let rows = (25.0 * MM / dx).round();
    let even = (HEIGHT / dx).round() as i64 % 2 == 0;
    let level = if even { rows * dx } else { (rows - 0.5) * dx };
    let hit = grid.select(|x| x[0] < 3.0 * dx && x[1].abs() < level);
    let cut = |y: f64| {
        let edge = [-dx, y, -THICKNESS];
        Polygon::parallelogram(edge, [NOTCH + dx, 0.0, 0.0], [0.0, 0.0, 2.0 * THICKNESS])
    };
    let policy =
        Breaking::new(stretch.sparing(&hit)).precracked(cut(level)?).precracked(cut(-level)?);
    let mut body = Body::new(family, Ordinary::new(steel), policy)?;
    println!("{} nodes, {} bonds", body.nodes(), body.family().bonds());
    let start = damage(&body);

    let tips = [Place::new(NOTCH, level, 0.0), Place::new(NOTCH, -level, 0.0)];
    let outward = [Place::new(0.3, 0.9, 0.0), Place::new(0.3, -0.9, 0.0)];
    let mut run =
        Run::new(&mut body, Loads::new().velocity(&hit, 0, SPEED), TimeStep::Safety(0.8))?;
    let mut started = None;
    let mut track = TipTrack::new();
    while run.time() < 95e-6 {
        run.steps_more(20)?;
        let cracks = CrackPath::of(run.body(), &start);
        let tip = cracks.tip(&tips[0], &outward[0]);
        track.add(run.time(), tip);
        if started.is_none() && (tip - tips[0]).norm() > 3.0 * dx {
            started = Some(run.time());
        }
        if tip[1] > 0.5 * HEIGHT - 6.0 * dx {
            break;
        }
    }
    let end = run.time();
    drop(run);
    let title = format!("Kalthoff-Winkler, mid-plane, {:.0} us", end * 1e6);
    let middle = |x: &Place| x[2].abs() < 0.75 * dx;
    draw_damage(&body, (1.0, [0, 1]), middle, &title, format!("{FOLDER}/middle.png"))?;
    let face = |x: &Place| x[2] > 0.5 * THICKNESS - dx;
    draw_damage(
        &body,
        (1.0, [0, 1]),
        face,
        "Kalthoff-Winkler, face",
        format!("{FOLDER}/face.png"),
    )?;

    let command = effort.command("kalthoff_winkler");
    let mut table = Measures::new("Kalthoff–Winkler in 3D", &command);
    let cracks = CrackPath::of(&body, &start);
    // The thickness is no rim.
    let wide = 10.0 * THICKNESS;
    let (low, high) =
        (Place::new(0.0, -0.5 * HEIGHT, -wide), Place::new(LENGTH, 0.5 * HEIGHT, wide));
    for (tip, what) in tips.iter().zip(["upper", "lower"]) {
        let side = tip[1].signum();
        let own = without_ends(&cracks.at_tip(tip), tip, (&low, &high), dx);
        let own: Vec<_> = own.into_iter().filter(|n| side * n.position[1] > level).collect();
        let line = fit_line(&own);
        let angle = line.map_or(f64::NAN, |line| line.angle.to_degrees().abs());
        let length = line.map_or(0.0, |line| line.length);
        table.hard_near(&format!("{what} crack from the notch [°]"), angle, 68.0, 5.0);
        table.hard_least(&format!("{what} crack [mm]"), length / MM, 20.0);
    }
    let nodes: Vec<_> =
        (0..body.nodes()).map(|i| (body.position(i), body.damage(i) - start[i])).collect();
    let error = symmetry_error(&nodes, (Mirror::Y, &Place::zeros()), dx);
    table.hard_most("mirror error about y", error, 0.05);
    let shear = (moduli.shear() / 8000.0).sqrt();
    let speed = started.and_then(|t| track.speed(t + 5e-6, end)).unwrap_or(f64::NAN);
    table.hard_most("crack speed against the Rayleigh speed", speed / (0.92 * shear), 1.0);
    println!("starts at {started:?} s, {speed:.0} m/s on the mean");
    conclude(&table, effort, FOLDER, &["crack speed"])
}
