//! What accuracy costs, in five scenes with references: which knob to turn first.
//!
//! ```text
//! cargo run --release --example tradeoff [-- --short | --full] [SCENE …]
//! ```
//! A plane wave in a carbon ply (Christoffel), the anisotropic plate of Scabbia §6.3 (finite
//! elements), a hole (Lekhnitskii), a dynamic stress intensity factor (Hattori §6.1, finite elements)
//! and the energy that opening a beam costs (Willberg §5A). Each is swept over one knob at a time
//! from a base and over the full grid of spacing and horizon.
//!
//! Usual: some minutes, writes `docs/tradeoff.md`; `--short` and names of scenes (wave, plate, hole,
//! intensity, beam) write nothing there. Every point is kept in `out/tradeoff/EFFORT/SCENE.csv` as
//! soon as it is done, and a stopped study goes on from there: remove the files after a change of the
//! code. Plots go beside them.
mod beam;
mod hole;
mod intensity;
mod plate;
mod wave;

use pd_testkit::clock::{machine, seconds};
use peridynamics::prelude::*;
use peridynamics::study::{Effort, Outcome};
use peridynamics::trade::{Point, Record, Trade, Worth};
use std::fmt::Write as _;

/// A scene of this program: its study, and what runs it at a point.
struct Scene {
    /// Of files and arguments.
    name: &'static str,
    /// What it is and what its error is, for the document.
    about: &'static str,
    study: Study,
    run: Box<dyn FnMut(&Point) -> Outcome<Record>>,
}

/// The influence function of a point.
fn influence(point: &Point) -> Outcome<InfluenceFunction> {
    Ok(match point.name("influence")? {
        "constant" => InfluenceFunction::Constant,
        "linear" => InfluenceFunction::Linear,
        "Gaussian" => InfluenceFunction::Gaussian,
        other => return Err(format!("no influence function '{other}'").into()),
    })
}

/// The weights β of a point.
fn quadrature(point: &Point) -> Outcome<Quadrature> {
    Ok(match point.name("β")? {
        "none" => Quadrature::None,
        "ramp" => Quadrature::LinearRamp,
        "exact" => Quadrature::Exact,
        other => return Err(format!("no weights '{other}'").into()),
    })
}

/// The best turns of a scene, as a row of the summary.
fn summary(name: &str, trade: &Trade) -> String {
    let turns = trade.turns(Cost::Time);
    let best = |worth: Worth, key: fn(&peridynamics::trade::Turn) -> f64| {
        let of_kind = turns.iter().filter(|turn| turn.worth() == worth);
        let best = of_kind.min_by(|a, b| key(a).total_cmp(&key(b)));
        best.map_or("–".to_owned(), ToString::to_string)
    };
    let free = best(Worth::Free, |turn| turn.error * turn.cost);
    let buy = best(Worth::Buys, |turn| -turn.sensitivity());
    let saving = best(Worth::Saves, |turn| turn.sensitivity());
    format!("| {name} | {free} | {buy} | {saving} |\n")
}

fn section(scene: &Scene, trade: &Trade) -> String {
    let base = &trade.rows()[0].point;
    let mut text = format!("\n## {}\n\n{}\n\nBase: {base}.\n\n", title(scene.name), scene.about);
    let count = trade.rows().len();
    // Writing to a string cannot fail.
    let _ = writeln!(text, "{}", trade.words(Cost::Time));
    let _ = writeln!(
        text,
        "Points that none of the {count} beats in both error and time:\n\n{}\nIn both error and \
         memory:\n\n{}",
        trade.front_table(Cost::Time),
        trade.front_table(Cost::Memory)
    );
    text
}

fn title(name: &str) -> String {
    let mut letters = name.chars();
    letters.next().map_or(String::new(), |first| first.to_uppercase().chain(letters).collect())
}

const HOW_TO_READ: &str = "\
Errors are relative. Time is processor time of one thread, set-up included; changes of the error within \
5 % and of the time within 15 % count as none (one run twice differs by up to 10 % on a shared \
machine). A turn changes one knob of the base and nothing else. \"Costs nothing\" is better in one \
of error and time and no worse in the other. A buy takes error for time: with error ∝ time^−p, half the \
error costs 2^(1/p) times the time. A saving gives error for time. What holds at one base need not \
hold at another: the tables of the fronts come from all points, the full grid of spacing and horizon \
among them.";

fn main() -> Outcome {
    let effort = Effort::from_arguments();
    let wanted: Vec<String> = std::env::args().skip(1).filter(|a| !a.starts_with("--")).collect();
    let folder = format!("out/tradeoff/{}", effort.choose("short", "default", "full"));
    let makers = [wave::scene, plate::scene, hole::scene, intensity::scene, beam::scene];
    let (mut rows, mut sections) = (String::new(), String::new());
    // One thread does all the work, so that its processor time is the cost.
    rayon::ThreadPoolBuilder::new().num_threads(1).use_current_thread().build_global()?;
    for maker in makers {
        let mut scene = maker(effort)?;
        if !wanted.is_empty() && !wanted.iter().any(|name| name == scene.name) {
            continue;
        }
        let path = format!("{folder}/{}.csv", scene.name);
        let trade = scene.study.run(path, |point| {
            let start = seconds();
            let record = (scene.run)(point);
            println!("{}: {point}: {:.1} s", scene.name, seconds() - start);
            record
        })?;
        trade.plot(Cost::Time, format!("{folder}/{}_time.png", scene.name))?;
        trade.plot(Cost::Memory, format!("{folder}/{}_memory.png", scene.name))?;
        rows += &summary(scene.name, &trade);
        let text = section(&scene, &trade);
        println!("{text}");
        sections += &text;
    }
    if effort != Effort::Short && wanted.is_empty() {
        let argument = effort.choose("", "", " -- --full");
        let text = format!(
            "# What accuracy costs\n\nWritten by `cargo run --release --example \
             tradeoff{argument}` on {}.\n\n{HOW_TO_READ}\n\n| scene | costs nothing | best buy | \
             best saving |\n| --- | --- | --- | --- |\n{rows}{sections}",
            machine()
        );
        std::fs::write(concat!(env!("CARGO_MANIFEST_DIR"), "/docs/tradeoff.md"), text)?;
    }
    Ok(())
}
