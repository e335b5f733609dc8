//! Hattori, Trevelyan and Coombs 2018, section 6.4: two plies with a weak interface come apart, the
//! crack in the interface (d = 0) or 5 mm below it.
//!
//! ```text
//! cargo run --release --example hattori_delamination [-- --short | --full]
//! ```
//! 150 × 37.5 mm, fibres at 0° below (I) and 45° above (II), crack of 30 mm from the left, m = 3;
//! v_y = 25 y/h m/s on the left half only, y from mid-height (the paper leaves both origins open).
//! Tsai–Hill with strengths of I, II and of the interface. The left interface reaches its strength
//! all along at 4.4 µs, material I at 5.5 µs. Pictures and the table go to
//! `out/hattori_delamination/`.

use peridynamics::models::elasticity::catalogue;
use peridynamics::prelude::*;
use peridynamics::study::{Effort, conclude, damage, draw_damage};

type Place = SVector<f64, 2>;

const MM: f64 = 1e-3;
const FOLDER: &str = "out/hattori_delamination";
const LENGTH: f64 = 150.0 * MM;
const HEIGHT: f64 = 37.5 * MM;
const CRACK: f64 = 30.0 * MM;
const SPEED: f64 = 25.0;
/// How long a plate is watched, in seconds.
const END: f64 = 14e-6;

fn other(error: impl std::fmt::Display) -> Error {
    Error::Other(error.to_string())
}

/// A broken bond when it was first seen.
struct Broken {
    place: Place,
    joining: bool,
    lower: bool,
}

fn pull(depth: f64, dx: f64, table: &mut Measures) -> Result<()> {
    let grid = Grid::new(&Cuboid::centred([LENGTH, HEIGHT])?, dx)?;
    let region: Vec<u8> = (0..grid.len()).map(|i| u8::from(grid.position(i)[1] > 0.0)).collect();
    let below = catalogue::hattori_plate().map_err(other)?;
    let above = catalogue::hattori_inclusion().map_err(other)?.rotated(45_f64.to_radians());
    let bonds = |stiffness: &Stiffness<2>, density| {
        let policy = ShapePolicy { rule: IllConditioned::Detach, limit: 5.0 };
        let ply = BondAssociated::<2, 3>::new(stiffness, density, InfluenceFunction::Linear);
        Ok::<_, Error>(ply.map_err(other)?.with_shape_policy(policy))
    };
    let materials = [
        bonds(&below, catalogue::HATTORI_PLATE_DENSITY)?,
        bonds(&above, catalogue::HATTORI_INCLUSION_DENSITY)?,
    ];
    let material = Regions::new(materials, region.clone()).map_err(other)?;
    let strengths = |[along, across, shear]: [f64; 3]| Strengths { along, across, shear };
    let of_i =
        TsaiHill::new(&strengths(catalogue::HTA_6376_STRENGTHS), 0.0)?.with_bridging_fibres();
    let turned = 45_f64.to_radians();
    let of_ii = TsaiHill::new(&strengths(catalogue::HATTORI_INCLUSION_STRENGTHS), turned)?
        .with_bridging_fibres();
    let joint = TsaiHill::new(&strengths([1670e6, 48e6, 56e6]), 0.0)?;
    let criterion = Interfaces::new([[of_i, joint], [joint, of_ii]], region.clone())?;
    // Between two rows of nodes.
    let level = -(depth / dx).round() * dx;
    let left = -0.5 * LENGTH;
    let crack = Segment::new([left - dx, level], [left + CRACK, level])?;
    let family = Lattice::<f64, 2>::new(&grid, Horizon::Cells(3.0), Quadrature::None)?;
    let mut body = Body::new(family, material, Breaking::new(criterion).precracked(crack))?;
    body.set_velocity(|x| [0.0, if x[0] <= 0.0 { SPEED * x[1] / HEIGHT } else { 0.0 }].into());
    let start = damage(&body);
    let tip = Place::new(left + CRACK, level);

    let label = format!("d{}", depth / MM);
    let mut run = Run::new(&mut body, Loads::new(), TimeStep::Safety(0.25))?;
    let mut seen: Vec<Broken> = Vec::new();
    let (mut joint_at, mut tip_at) = (None, None);
    // Shares of bonds that join the plies: of the first 200 or so, and when the front is 20 mm on.
    let (mut first, mut share_at_20) = (f64::NAN, None);
    while run.time() < END {
        run.steps_more(5)?;
        let body = run.body();
        // Which bonds are broken now, by their lower node; the list only grows.
        let was = seen.len();
        seen.clear();
        for node in (0..body.nodes()).filter(|&i| body.damage(i) > start[i]) {
            let x = body.position(node);
            body.neighbours(node, |n| {
                let y = body.position(n.node);
                let cut = (x[1] > level) != (y[1] > level) && x[0].min(y[0]) < left + CRACK;
                if n.intact || n.node < node || cut {
                    return;
                }
                let joining = region[node] != region[n.node];
                let place = (x + y) * 0.5;
                seen.push(Broken { place, joining, lower: !joining && region[node] == 0 });
            });
        }
        if seen.len() == was {
            continue;
        }
        let time = run.time();
        let near_tip = |b: &&Broken| b.lower && (b.place - tip).norm() < 6.0 * dx;
        if joint_at.is_none() && seen.iter().any(|b| b.joining) {
            joint_at = Some(time);
        }
        if tip_at.is_none() && seen.iter().any(|b| near_tip(&b)) {
            tip_at = Some(time);
        }
        let joining = seen.iter().filter(|b| b.joining).count() as f64 / seen.len() as f64;
        if was < 200 {
            first = joining;
        }
        let front = CrackPath::of(body, &start).tip(&tip, &Place::new(1.0, 0.0));
        if share_at_20.is_none() && (front - tip)[0] > 20.0 * MM {
            share_at_20 = Some((time, joining));
            let title = format!("{label}, {:.1} us", time * 1e6);
            let file = format!("{FOLDER}/{label}_20mm.png");
            draw_damage(body, (15.0, [0, 1]), |_| true, &title, file)?;
        }
    }
    drop(run);
    let title = format!("{label}, {:.1} us", END * 1e6);
    draw_damage(&body, (15.0, [0, 1]), |_| true, &title, format!("{FOLDER}/{label}_end.png"))?;

    let name = |what: &str| format!("d = {} mm: {what}", depth / MM);
    let length = |mine: &dyn Fn(&&Broken) -> bool| {
        let ends = seen.iter().filter(mine).map(|b| b.place[0]);
        let (low, high) =
            ends.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)));
        (high - low).max(0.0) / MM
    };
    if depth == 0.0 {
        table.hard_least(&name("share of joining bonds among the first 200"), first, 0.95);
        let (time, share) = share_at_20.unwrap_or((f64::NAN, f64::NAN));
        println!("{label}: front 20 mm on at {:.2} µs", time * 1e6);
        table.hard_least(&name("share of joining bonds, front 20 mm on"), share, 0.8);
    } else {
        let order = joint_at.unwrap_or(f64::NAN) < tip_at.unwrap_or(f64::INFINITY);
        table.hard(&name("the interface breaks before the crack grows"), order);
        let delaminated = length(&|b| b.joining);
        let grown = length(&|b| {
            b.lower && (b.place[1] - level).abs() < 6.0 * dx && b.place[0] > tip[0] - dx
        });
        println!("{label}: {delaminated:.1} mm delaminated, crack grown by {grown:.1} mm");
        table.hard_least(&name("delaminated over growth of the crack"), delaminated - grown, 0.0);
        let upper = seen.iter().filter(|b| !b.joining && !b.lower);
        let high = upper.map(|b| b.place[1]).fold(0.0, f64::max);
        table.hard_most(&name("damage in II above the interface [mm]"), high / MM, 9.0 * dx / MM);
    }
    println!(
        "{label}: interface from {joint_at:?} s, crack from {tip_at:?} s, {} bonds",
        seen.len()
    );
    Ok(())
}

fn main() -> Result<()> {
    let effort = Effort::from_arguments();
    let dx = LENGTH / effort.choose(200.0, 400.0, 400.0);
    let command = effort.command("hattori_delamination");
    let mut table = Measures::new("Delamination (Hattori §6.4)", &command);
    pull(0.0, dx, &mut table)?;
    pull(5.0 * MM, dx, &mut table)?;
    conclude(&table, effort, FOLDER, &[])
}
