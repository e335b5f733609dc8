//! Hattori, Trevelyan and Coombs 2018, section 6.3: an edge crack grows in a composite plate with
//! a stiff inclusion above it and a hole below it, for fibres at 0°, 45° and 90° and two speeds.
//!
//! ```text
//! cargo run --release --example hattori_growth [-- --short | --full]
//! ```
//! Plate 20 × 40 mm of HTA/6376 (ρ = 1600 kg/m³), crack of 4 mm at mid-height of the left edge;
//! inclusion and hole of radius 4.5 mm, 8 mm above and below the centre; v_y = v y/(40 mm) with
//! v = 25 and 50 m/s. Tsai–Hill with strengths per material; the interface has those of the plate.
//! Bonds have gradients of their own and a matrix crack spares those along the fibres, as in
//! `cfrp_centre_crack`. The plate is strained uniformly and fails by itself at the times `BULK`: the
//! crack is read then, where it runs in the ply, inclusion and hole at 1.5 times that. Pictures and the table go to `out/hattori_growth/`.

use peridynamics::damage::crack_path::{fit_line, without_ends};
use peridynamics::models::elasticity::catalogue;
use peridynamics::prelude::*;
use peridynamics::study::{Effort, conclude, damage, draw_damage};

type Place = SVector<f64, 2>;
type Ply = BondAssociated<2, 3>;

const MM: f64 = 1e-3;
const FOLDER: &str = "out/hattori_growth";
const WIDTH: f64 = 20.0 * MM;
const HEIGHT: f64 = 40.0 * MM;
const TIP: f64 = -6.0 * MM;
const RADIUS: f64 = 4.5 * MM;
const SHIFT: f64 = 8.0 * MM;
/// Fibre angle in degrees, and time in seconds at which the undisturbed plate fails at v = 25 m/s
/// (half of it at 50).
const BULK: [(f64, f64); 3] = [(0.0, 10.9e-6), (45.0, 12.3e-6), (90.0, 17.3e-6)];

fn other(error: impl std::fmt::Display) -> Error {
    Error::Other(error.to_string())
}

fn grow(degrees: f64, speed: f64, bulk: f64, dx: f64, table: &mut Measures) -> Result<()> {
    let angle = degrees.to_radians();
    let hole = Disc::new([0.0, -SHIFT], RADIUS)?;
    let grid = Grid::new(&Cuboid::centred([WIDTH, HEIGHT])?.without(hole), dx)?;
    let from = |y: f64| move |x: &Place| (x - Place::new(0.0, y)).norm();
    let inside = |x: &Place| from(SHIFT)(x) < RADIUS;
    let region: Vec<u8> = (0..grid.len()).map(|i| u8::from(inside(&grid.position(i)))).collect();

    let ply = catalogue::HTA_6376;
    let plate = Stiffness::<2>::lamina(&ply).map_err(other)?.rotated(angle);
    let fibre = catalogue::hattori_inclusion().map_err(other)?;
    let bonds = |stiffness: &Stiffness<2>, density| {
        let policy = ShapePolicy { rule: IllConditioned::Detach, limit: 5.0 };
        let ply = Ply::new(stiffness, density, InfluenceFunction::Linear).map_err(other)?;
        Ok::<Ply, Error>(ply.with_shape_policy(policy))
    };
    let materials = [bonds(&plate, 1600.0)?, bonds(&fibre, catalogue::HATTORI_INCLUSION_DENSITY)?];
    let material = Regions::new(materials, region.clone()).map_err(other)?;
    let strengths = |along, across, shear| Strengths { along, across, shear };
    let bridged =
        |strengths, angle| TsaiHill::new(&strengths, angle).map(TsaiHill::with_bridging_fibres);
    let of_plate = bridged(strengths(1670e6, 60e6, 70e6), angle)?;
    let of_inclusion = bridged(strengths(2100e6, 120e6, 135e6), 0.0)?;
    let rules = [[of_plate, of_plate], [of_plate, of_inclusion]];
    let criterion = Interfaces::new(rules, region.clone())?;
    let crack = Segment::new([-0.5 * WIDTH - dx, 0.0], [TIP, 0.0])?;
    let family = Lattice::<f64, 2>::new(&grid, Horizon::Cells(3.0), Quadrature::None)?;
    let policy = Breaking::new(criterion).precracked(crack);
    let mut body = Body::new(family, material, policy)?;
    body.set_velocity(|x| [0.0, speed * x[1] / HEIGHT].into());
    let start = damage(&body);

    let label = format!("v{speed}_{degrees}");
    let mut run = Run::new(&mut body, Loads::new(), TimeStep::Safety(0.25))?;
    run.until(bulk)?;
    // The crack in the ply: cracks along the inclusion or at the hole that it met are others.
    let delta = 3.0 * dx;
    let in_ply = |x: &Place| from(SHIFT)(x).min(from(-SHIFT)(x)) > RADIUS + delta;
    let at_bulk = {
        let body = run.body();
        let nodes = (0..body.nodes()).map(|i| (i, body.position(i), body.damage(i) - start[i]));
        CrackPath::new(dx, nodes.filter(|(_, x, _)| in_ply(x)))
    };
    draw(run.body(), &label, bulk, "bulk")?;
    let late = 1.5 * bulk;
    run.until(late)?;
    drop(run);
    draw(&body, &label, late, "late")?;

    let name = |what: &str| format!("v = {speed}, {degrees}°: {what}");
    let tip = Place::new(TIP, 0.0);
    let corner = Place::new(0.5 * WIDTH, 0.5 * HEIGHT);
    let own = without_ends(&at_bulk.at_tip(&tip), &tip, (&-corner, &corner), dx);
    let (line, length) =
        fit_line(&own).map_or((f64::NAN, 0.0), |line| (line.angle.to_degrees(), line.length));
    let off = {
        let d = (line - degrees).rem_euclid(180.0);
        d.min(180.0 - d)
    };
    let most = if degrees == 90.0 { 10.0 } else { 5.0 };
    table.hard_most(&name("edge crack off the fibres [°]"), off, most);
    table.soft_least(&name("length of that line [mm]"), length / MM, 1.0);

    // Broken bonds by where they are.
    let (mut deep, mut joining) = (0, 0);
    let mut damaged = [false; 72];
    for node in 0..body.nodes() {
        let x = body.position(node);
        let core = from(SHIFT)(&x) < RADIUS - delta;
        body.neighbours(node, |n| {
            if n.intact || node > n.node {
                return;
            }
            deep += usize::from(core && from(SHIFT)(&body.position(n.node)) < RADIUS - delta);
            if region[node] != region[n.node] {
                joining += 1;
                let r = x - Place::new(0.0, SHIFT);
                let turn = r[1].atan2(r[0]) / (2.0 * std::f64::consts::PI) + 0.5;
                damaged[(72.0 * turn) as usize % 72] = true;
            }
        });
    }
    let share = damaged.iter().filter(|d| **d).count() as f64 / 72.0;
    let near_hole = |i: usize| from(-SHIFT)(&body.position(i)) < RADIUS + delta;
    let at_hole = (0..body.nodes()).filter(|&i| near_hole(i) && body.damage(i) > start[i]).count();
    println!(
        "{}: {deep} bonds broken in the inclusion, {joining} at its interface ({:.0} % of the \
         angles), {at_hole} damaged nodes at the hole",
        name("late"),
        100.0 * share
    );
    if speed == 25.0 {
        match degrees {
            0.0 => {
                table.hard_most(&name("bonds broken inside the inclusion"), deep as f64, 0.0);
                table.hard_least(&name("damaged nodes at the hole"), at_hole as f64, 1.0);
            }
            45.0 => {
                table.hard_least(&name("bonds broken at the interface"), joining as f64, 1.0);
            }
            _ => {
                table.hard_least(&name("share of the interface damaged"), share, 0.6);
            }
        }
    } else if degrees == 90.0 {
        table.hard_least(&name("bonds broken at the interface"), joining as f64, 1.0);
        table.hard_least(&name("damaged nodes at the hole"), at_hole as f64, 1.0);
        table.hard_least(&name("bonds broken inside the inclusion"), deep as f64, 1.0);
    }
    Ok(())
}

type Plate = Body<f64, 2, Lattice<f64, 2>, Regions<Ply, 2>, Breaking<Interfaces<TsaiHill, 2>, 2>>;

fn draw(body: &Plate, label: &str, time: f64, when: &str) -> Result<()> {
    let title = format!("{label}, {:.1} us", time * 1e6);
    draw_damage(body, (5.0, [0, 1]), |_| true, &title, format!("{FOLDER}/{label}_{when}.png"))
}

fn main() -> Result<()> {
    let effort = Effort::from_arguments();
    let across = effort.choose(40.0, 80.0, 300.0);
    let command = effort.command("hattori_growth");
    let mut table = Measures::new("Edge crack, inclusion and hole (Hattori §6.3)", &command);
    for speed in [25.0, 50.0] {
        for (degrees, bulk) in BULK {
            grow(degrees, speed, bulk * 25.0 / speed, WIDTH / across, &mut table)?;
        }
    }
    conclude(&table, effort, FOLDER, &["v = 25, 90°: edge crack"])
}
