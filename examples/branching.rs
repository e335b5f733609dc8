//! A crack branches in soda-lime glass: a plate of 100 × 40 mm with a notch of 50 mm, pulled apart
//! by a sudden 12 MPa (Ha and Bobaru 2010). Not in the papers; the field expects it.
//!
//! ```text
//! cargo run --release --example branching [-- --short | --full]
//! ```
//! E = 72 GPa, ρ = 2440 kg/m³, G₀ = 135 J/m², bond-based (ν = 1/3, plane stress), δ = 1 mm. The
//! crack starts, branches once and never outruns the Rayleigh wave. Pictures, the tip's way and
//! the table go to `out/branching/`.

use peridynamics::damage::crack_path::{branches, symmetry_error};
use peridynamics::io::History;
use peridynamics::prelude::*;
use peridynamics::study::{Effort, conclude, damage, draw_damage};

type Place = SVector<f64, 2>;

const MM: f64 = 1e-3;
const FOLDER: &str = "out/branching";
const LENGTH: f64 = 100.0 * MM;
const HEIGHT: f64 = 40.0 * MM;
const STRESS: f64 = 12e6;
const YOUNG: f64 = 72e9;
const DENSITY: f64 = 2440.0;
const ENERGY: f64 = 135.0;

fn other(error: impl std::fmt::Display) -> Error {
    Error::Other(error.to_string())
}

fn main() -> Result<()> {
    let effort = Effort::from_arguments();
    let m = effort.choose(2.0, 4.0, 8.0);
    let dx = MM / m;
    let nu = 1.0 / 3.0;
    let moduli = Isotropic::from_young_poisson(YOUNG, nu).map_err(other)?;
    let mode = PlaneMode::PlaneStress;
    let omega = InfluenceFunction::Constant;
    let glass = Pmb::plane(&moduli, mode, DENSITY, omega).map_err(other)?;
    let grid = Grid::new(&Cuboid::centred([LENGTH, HEIGHT])?, dx)?;
    let family = Lattice::<f64, 2>::new(&grid, Horizon::Cells(m), Quadrature::None)?;
    let model = BondModel::pmb(moduli.plane_bulk(mode), omega)?;
    let plane = CrackPlane::lattice(&family, [0.0, 1.0])?;
    let stretch = CriticalStretch::from_energy(FractureEnergy::new(ENERGY)?, &model, &plane)?;
    // Sudden tractions of a wave would break the loaded rows.
    let [top, bottom] =
        [1.0, -1.0].map(|side| grid.select(move |x| side * x[1] > 0.5 * HEIGHT - dx));
    let margin = grid.select(|x| x[1].abs() > 0.5 * HEIGHT - 1.5 * MM);
    let notch = Segment::new([-0.5 * LENGTH - dx, 0.0], [0.0, 0.0])?;
    let policy = Breaking::new(stretch.sparing(&margin)).precracked(notch);
    let mut body = Body::new(family, Ordinary::new(glass), policy)?;
    let start = damage(&body);
    let loads = Loads::new().body_force(&top, 1, STRESS / dx).body_force(&bottom, 1, -STRESS / dx);
    println!("{} nodes, s_c = {:.3e}", body.nodes(), stretch.stretch());

    let (origin, ahead) = (Place::zeros(), Place::new(1.0, 0.0));
    let mut track = TipTrack::new();
    let mut history = History::create(format!("{FOLDER}/tip.csv"), &["time [s]", "x [m]", "y [m]"])
        .map_err(other)?;
    let mut run = Run::new(&mut body, loads, TimeStep::Safety(0.8))?.with_energies();
    let mut branched = None;
    let mut arrived = false;
    while run.time() < 60e-6 && !arrived {
        run.steps_more(10)?;
        let cracks = CrackPath::of(run.body(), &start);
        let tip = cracks.tip(&origin, &ahead);
        track.add(run.time(), tip);
        history.row(&[run.time(), tip[0], tip[1]]).map_err(other)?;
        let own = cracks.at_tip(&origin);
        if branched.is_none() && branches(&own, tip[0] - 3.0 * MM, dx) == 2 {
            branched = Some((run.time(), tip[0] - 3.0 * MM));
            let title = format!("branching, {:.1} us", run.time() * 1e6);
            draw_damage(
                run.body(),
                (20.0, [0, 1]),
                |_| true,
                &title,
                format!("{FOLDER}/branch.png"),
            )?;
        }
        arrived = tip[0] > 0.5 * LENGTH - 2.0 * MM;
    }
    let energies = run.energies().ok_or_else(|| other("no energies"))?;
    let end = run.time();
    drop(run);
    draw_damage(&body, (20.0, [0, 1]), |_| true, "branching, end", format!("{FOLDER}/end.png"))?;

    let command = effort.command("branching");
    let mut table = Measures::new("Crack branching in soda-lime glass under 12 MPa", &command);
    let cracks = CrackPath::of(&body, &start);
    let own = cracks.at_tip(&origin);
    table.hard("the crack crosses the plate", arrived);
    let most = (5..45).map(|x| branches(&own, f64::from(x) * MM, dx)).max().unwrap_or(0);
    table.hard_least("branches", most as f64, 2.0);
    let (time, place) = branched.unwrap_or((f64::NAN, f64::NAN));
    println!(
        "branches at {:.1} µs, {:.1} mm from the left edge",
        time * 1e6,
        (place + 0.5 * LENGTH) / MM
    );
    table.soft_near(
        "place of branching from the left [mm]",
        (place + 0.5 * LENGTH) / MM,
        68.0,
        6.0,
    );
    // c_R ≈ (0.862 + 1.14 ν)/(1 + ν) c_s (Viktorov's form of the Rayleigh speed).
    let shear = (moduli.shear() / DENSITY).sqrt();
    let rayleigh = (0.862 + 1.14 * nu) / (1.0 + nu) * shear;
    let window = 4e-6;
    let fastest = (0..60)
        .filter_map(|k| track.speed(f64::from(k) * 1e-6, f64::from(k) * 1e-6 + window))
        .fold(0.0, f64::max);
    table.hard_most("fastest tip over 4 µs against the Rayleigh speed", fastest / rayleigh, 1.0);
    println!("fastest {fastest:.0} m/s, Rayleigh {rayleigh:.0} m/s, across at {:.1} µs", end * 1e6);
    let nodes: Vec<_> =
        (0..body.nodes()).map(|i| (body.position(i), body.damage(i) - start[i])).collect();
    let error = symmetry_error(&nodes, (Mirror::Y, &Place::zeros()), dx);
    table.hard_most("mirror error about y", error, 0.05);
    let Energies { kinetic, strain, external, dissipated } = energies;
    let off = (external - kinetic - strain - dissipated).abs() / external;
    table.hard_most("energy out of balance", off, 0.01);
    conclude(&table, effort, FOLDER, &["crosses the plate", "branches"])
}
