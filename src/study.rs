//! What studies share: how large a run is, its table of measures, and pictures of damage.

use nalgebra::SVector;
use pd_core::statics::Progress;
use pd_core::{Body, DamagePolicy, Error, Family, Material, Real, Result};
use pd_damage::Measures;
use pd_io::{ColourMap, FieldMap};
use std::io::Write as _;
use std::path::Path;

/// The result of a study, which may end by errors of several kinds.
pub type Outcome<X = ()> = std::result::Result<X, Box<dyn std::error::Error>>;

/// How much work a study takes, from its arguments: `--short` (seconds), nothing (about a minute
/// on two cores), `--full` (the resolution of the paper).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Effort {
    /// Seconds: does it run?
    Short,
    /// About a minute.
    Default,
    /// As long as it takes.
    Full,
}

impl Effort {
    /// From the program's arguments.
    pub fn from_arguments() -> Self {
        let given = |name: &str| std::env::args().any(|argument| argument == name);
        match (given("--short"), given("--full")) {
            (true, _) => Self::Short,
            (_, true) => Self::Full,
            _ => Self::Default,
        }
    }
    /// The command that runs an example with this effort.
    pub fn command(self, example: &str) -> String {
        let flag = self.choose(" -- --short", "", " -- --full");
        format!("cargo run --release --example {example}{flag}")
    }
    /// One of three values.
    pub fn choose<X>(self, short: X, default: X, full: X) -> X {
        match self {
            Self::Short => short,
            Self::Default => default,
            Self::Full => full,
        }
    }
}

/// Ends a study: prints its table and writes it to `folder`, as `measures.md`, or as
/// `measures_short.md` and `measures_full.md`. A short run is a test too: every HARD measure must hold
/// but those that are known to miss on its coarse body, by a part of their names.
///
/// # Errors
/// [`Error::Other`] if the table cannot be written, or with the measures that miss in a short run.
pub fn conclude(table: &Measures, effort: Effort, folder: &str, known: &[&str]) -> Result<()> {
    print!("{table}");
    let file = effort.choose("measures_short.md", "measures.md", "measures_full.md");
    table.write(format!("{folder}/{file}"))?;
    println!("pictures and {file} are in {folder}");
    let expected = |name: &&str| known.iter().any(|part| name.contains(part));
    let misses: Vec<&str> = table.misses().filter(|name| !expected(name)).collect();
    if effort == Effort::Short && !misses.is_empty() {
        return Err(Error::Other(format!("HARD measures miss: {}", misses.join("; "))));
    }
    Ok(())
}

/// A line on the terminal that tells how far a [static solution](pd_core::Statics::solve_watched)
/// is; it ends with the solution.
pub fn watch(label: &str) -> impl FnMut(Progress) + '_ {
    struct Line;
    impl Drop for Line {
        fn drop(&mut self) {
            let _ = writeln!(std::io::stderr());
        }
    }
    let line = Line;
    move |Progress { iteration, residual }| {
        let _ = &line;
        if iteration.is_multiple_of(50) {
            let _ = write!(
                std::io::stderr(),
                "\r{label}: iteration {iteration}, residual {residual:.1e}    "
            );
        }
    }
}

/// Damage index of every node.
pub fn damage<T, const D: usize, F, M, P>(body: &Body<T, D, F, M, P>) -> Vec<f64>
where
    T: Real,
    F: Family<T, D>,
    M: Material<T, D>,
    P: DamagePolicy<T, D, M>,
{
    (0..body.nodes()).map(|node| body.damage(node)).collect()
}

/// Draws the damage of the nodes that `shown` selects at their deformed places in the plane of
/// two axes, displacements enlarged by `scale`. Nodes without any bond left are not drawn: they
/// fly away. Nodes larger than the unit of length (of a graded cloud) are drawn as large as they are.
///
/// # Errors
/// [`Error::Other`] with the path if it cannot be written.
pub fn draw_damage<T, const D: usize, F, M, P>(
    body: &Body<T, D, F, M, P>,
    (scale, axes): (f64, [usize; 2]),
    shown: impl Fn(&SVector<f64, D>) -> bool,
    title: &str,
    path: impl AsRef<Path>,
) -> Result<()>
where
    T: Real,
    F: Family<T, D>,
    M: Material<T, D>,
    P: DamagePolicy<T, D, M>,
{
    let (mut places, mut damage) = (Vec::new(), Vec::new());
    for node in (0..body.nodes()).filter(|&node| shown(&body.position(node))) {
        let value = body.damage(node);
        if value < 1.0 {
            let x = body.position(node) + scale * body.displacement(node);
            let edge = body.family().volume(node).powf(1.0 / D as f64);
            let parts = (edge / body.family().unit()).round().max(1.0) as usize;
            let offset = |k: usize| ((k as f64 + 0.5) / parts as f64 - 0.5) * edge;
            for (k, l) in (0..parts * parts).map(|part| (part / parts, part % parts)) {
                places.push(SVector::<f64, 2>::new(x[axes[0]] + offset(k), x[axes[1]] + offset(l)));
                damage.push(value);
            }
        }
    }
    let path = path.as_ref();
    if let Some(folder) = path.parent() {
        let told = |e: std::io::Error| Error::Other(format!("{}: {e}", folder.display()));
        std::fs::create_dir_all(folder).map_err(told)?;
    }
    FieldMap::new(&places, 1.15 * body.family().unit(), &damage)
        .title(title)
        .range(0.0, 1.0)
        .colours(ColourMap::Damage)
        .size(700)
        .write(path)
        .map_err(|e| Error::Other(e.to_string()))
}
