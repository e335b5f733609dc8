//! Willberg, Wiedemann and Rädel 2019, section 5C: a plate with a hole is pulled until it breaks,
//! by a critical stretch and by a critical bond energy.
//!
//! ```text
//! cargo run --release --example willberg_hole [-- --short | --full]
//! ```
//! 50 × 50 × 0.5 mm, hole of 10 mm, E = 192 GPa (the paper prints MPa), ν = 0.33, ρ = 8000 kg/m³,
//! u_y = ±0.27541 m/s · t in layers of 1.5 mm at top and bottom, m = 3.03. s_c = 0.02, which is
//! G_IC = 144 kN/m at this horizon by the paper's Eq. 5-4 (a formula of solids: in the plane a
//! crack of this stretch costs 86 kN/m); the printed 287 kN/m belongs to twice the horizon. Pictures and the table go to `out/willberg_hole/`.

use peridynamics::damage::bond_energy::Uniform;
use peridynamics::damage::crack_path::{fit_line, path, symmetry_error};
use peridynamics::prelude::*;
use peridynamics::study::{Effort, conclude, damage, draw_damage};

type Place = SVector<f64, 2>;

const MM: f64 = 1e-3;
const FOLDER: &str = "out/willberg_hole";
const SIZE: f64 = 50.0 * MM;
const HOLE: f64 = 5.0 * MM;
const SPEED: f64 = 0.27541;
const STRETCH: f64 = 0.02;
/// G_IC in J/m² of that stretch by Eq. 5-4 at δ = 1.515 mm.
const ENERGY: f64 = 144.2e3;

fn other(error: impl std::fmt::Display) -> Error {
    Error::Other(error.to_string())
}

fn pull<C>(
    dx: f64,
    label: &str,
    criterion: impl Fn(&CrackPlane<2>, &Isotropic) -> Result<C>,
    table: &mut Measures,
) -> Result<()>
where
    C: DamageCriterion<f64, 2, Ordinary<LinearSolid>>,
{
    let moduli = Isotropic::from_young_poisson(192e9, 0.33).map_err(other)?;
    let mode = PlaneMode::PlaneStress;
    let omega = InfluenceFunction::Constant;
    let lps = LinearSolid::plane(&moduli, mode, 8000.0, omega).map_err(other)?;
    let plate = Cuboid::centred([SIZE, SIZE])?.without(Disc::new([0.0, 0.0], HOLE)?);
    let grid = Grid::new(&plate, dx)?;
    let family = Lattice::<f64, 2>::new(&grid, Horizon::Cells(3.03), Quadrature::None)?;
    let horizon = 3.03 * dx;
    let layer = 0.5 * SIZE - 1.5 * MM;
    let (top, bottom) = (grid.select(|x| x[1] > layer), grid.select(|x| x[1] < -layer));
    let plane = CrackPlane::lattice(&family, [0.0, 1.0])?;
    let own = criterion(&plane, &moduli)?.sparing(&top.union(&bottom));
    let mut body = Body::new(family, Ordinary::new(lps), Breaking::new(own))?;
    // The plate starts with the speed of a uniform strain, so that no wave comes from the ends.
    body.set_velocity(|x| [0.0, (2.0 * SPEED * x[1] / SIZE).clamp(-SPEED, SPEED)].into());
    let start = damage(&body);

    let loads = Loads::new().velocity(&top, 1, SPEED).velocity(&bottom, 1, -SPEED);
    let mut run = Run::new(&mut body, loads, TimeStep::Safety(0.6))?;
    // When each side first lost a bond, and where.
    let mut first: [Option<(f64, Vec<Place>)>; 2] = [None, None];
    let mut apart = None;
    let (mut peak, mut drawn) = (0.0_f64, false);
    while run.time() < 1e-3 && apart.is_none() {
        let before = run.body().broken_bonds();
        run.steps_more(1)?;
        let body = run.body();
        peak = peak.max(reaction(body, &top)[1]);
        if body.broken_bonds() == before {
            continue;
        }
        for (side, first) in [-1.0, 1.0].into_iter().zip(&mut first) {
            if first.is_none() {
                let hurt = |i: &usize| body.damage(*i) > start[*i];
                let places = (0..body.nodes()).filter(hurt).map(|i| body.position(i));
                let own: Vec<Place> = places.filter(|x| side * x[0] > 0.0).collect();
                if !own.is_empty() {
                    *first = Some((run.time(), own));
                }
            }
        }
        let cracks = CrackPath::of(body, &start);
        let reached =
            |x: f64| cracks.nodes().iter().any(|n| x * n.position[0] > x * x - MM * x.abs());
        if !drawn && reached(12.0 * MM) {
            let title = format!("{label}, {:.3} ms", run.time() * 1e3);
            draw_damage(
                body,
                (1.0, [0, 1]),
                |_| true,
                &title,
                format!("{FOLDER}/{label}_half.png"),
            )?;
            drawn = true;
        }
        if reached(0.5 * SIZE) && reached(-0.5 * SIZE) {
            apart = Some(run.time());
        }
    }
    drop(run);
    draw_damage(&body, (1.0, [0, 1]), |_| true, label, format!("{FOLDER}/{label}.png"))?;

    let name = |what: &str| format!("{label}: {what}");
    let times = [&first[0], &first[1]].map(|f| f.as_ref().map_or(f64::NAN, |f| f.0));
    let farthest = |f: &Option<(f64, Vec<Place>)>, x: f64| {
        let pole = Place::new(x, 0.0);
        f.as_ref().map_or(f64::NAN, |f| f.1.iter().map(|p| (p - pole).norm()).fold(0.0, f64::max))
    };
    let off = farthest(&first[0], -HOLE).max(farthest(&first[1], HOLE));
    // Nodes at both ends of the first bonds: one of them within the horizon, as the bond is.
    table.hard_most(&name("first broken bonds from (±5, 0) [mm]"), off / MM, horizon / MM);
    table.hard_most(&name("sides apart in time"), (times[0] / times[1] - 1.0).abs(), 0.05);
    let cracks = CrackPath::of(&body, &start);
    for (side, what) in [(-1.0, "left"), (1.0, "right")] {
        let own: Vec<_> =
            cracks.nodes().iter().filter(|n| side * n.position[0] > 0.0).copied().collect();
        let angle = fit_line(&own).map_or(f64::NAN, |line| line.angle.to_degrees());
        table.hard_near(&name(&format!("{what} line [°]")), angle, 0.0, 5.0);
        let off = path(&own, dx).iter().map(|p| p.1.abs()).fold(f64::NAN, f64::max);
        table.hard_most(&name(&format!("{what} |y_c| [mm]")), off / MM, 1.0);
    }
    let nodes: Vec<_> =
        (0..body.nodes()).map(|i| (body.position(i), body.damage(i) - start[i])).collect();
    for (mirror, axis) in [(Mirror::X, "x"), (Mirror::Y, "y")] {
        let error = symmetry_error(&nodes, (mirror, &Place::zeros()), dx);
        table.hard_most(&name(&format!("mirror error about {axis}")), error, 0.05);
    }
    table.hard(&name("the plate is in two"), apart.is_some());
    // 0.58–0.75 ms: finite elements, by the edges' condition and the length of the bond.
    table.soft_near(&name("first break [ms]"), times[0] * 1e3, 0.665, 0.085);
    println!("{label}: largest force {:.4e} N, broken through at {apart:?} s", peak * 0.5 * MM);
    Ok(())
}

fn main() -> Result<()> {
    let effort = Effort::from_arguments();
    let dx = effort.choose(1.0, 0.5, 0.25) * MM;
    let command = effort.command("willberg_hole");
    let mut table = Measures::new("Plate with a hole (Willberg §5C)", &command);
    pull(dx, "stretch", |_, _| CriticalStretch::new(STRETCH), &mut table)?;
    let energy = |plane: &CrackPlane<2>, _: &Isotropic| {
        BondEnergy::<Uniform>::from_energy(FractureEnergy::new(ENERGY)?, plane)
    };
    pull(dx, "energy", energy, &mut table)?;
    conclude(&table, effort, FOLDER, &[])
}
