//! What accuracy costs: a scene with a reference, swept over any knobs.
//!
//! A [`Study`] names the knobs and their values (the first one is the base), takes full grids and
//! one knob at a time from the base, and runs a scene at every point: a closure from a [`Point`] to
//! a [`Record`] with the error against the reference. What comes back, a [`Trade`], gives the
//! [front](Trade::front) of points that none beats in both error and cost, what each
//! [turn](Turn) of a knob does, and [words](Trade::words) on which to turn first.
//!
//! ```
//! use peridynamics::trade::{Cost, Record, Study};
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let study = Study::new("midpoint rule")
//!     .knob("cells", [8.0, 4.0, 16.0, 32.0])
//!     .knob("rule", ["left", "middle"])
//!     .grid(&["cells", "rule"])?;
//! # let path = std::env::temp_dir().join(format!("pd_doc_trade_{}.csv", std::process::id()));
//! let trade = study.run(&path, |point| {
//!     let n = point.number("cells")?;
//!     let shift = if point.name("rule")? == "left" { 0.0 } else { 0.5 };
//!     let sum: f64 = (0..n as usize).map(|i| ((i as f64 + shift) / n).exp() / n).sum();
//!     Ok(Record::new((sum / (1_f64.exp() - 1.0) - 1.0).abs()))
//! })?;
//! assert_eq!(trade.rows().len(), 8);
//! println!("{}", trade.words(Cost::Time));
//! # std::fs::remove_file(path)?;
//! # Ok(())
//! # }
//! ```
//! Every finished point is a line of a CSV file, on the disk before the next one starts; a study
//! that was stopped goes on there. After a change of the scene's code the file is to be removed.

use pd_core::{Body, DamagePolicy, Family, Material, Real};
use pd_io::{Ledger, LinePlot};
use std::fmt::{self, Write as _};
use std::path::Path;
use std::time::Instant;

/// Ratios of errors within this of one are no change.
const SAME_ERROR: f64 = 0.05;
/// As much for costs: times of one run differ by 10 % on a shared machine.
const SAME_COST: f64 = 0.15;

/// Result of this module.
pub type Result<X, E = Error> = std::result::Result<X, E>;

/// Error of a study.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// There is no knob, or no figure, of this name.
    #[error("there is no {what} '{name}' in this study; there are {known:?}")]
    Unknown {
        /// "knob" or "figure".
        what: &'static str,
        /// The name asked for.
        name: String,
        /// The names there are.
        known: Vec<String>,
    },
    /// A number was asked for where the knob has a name, or the other way round.
    #[error("the knob '{knob}' is at '{value}', which is not a {wanted}")]
    Kind {
        /// The knob.
        knob: String,
        /// Its value.
        value: String,
        /// "number" or "name".
        wanted: &'static str,
    },
    /// Two knobs have one name, or a knob has no value, or one twice.
    #[error("the knob '{knob}' {problem}")]
    Knob {
        /// The knob.
        knob: String,
        /// What is wrong, and what to do.
        problem: &'static str,
    },
    /// A number in the file cannot be read.
    #[error("{file}: '{cell}' is no number in the row of {point}: remove the line")]
    Cell {
        /// The file.
        file: String,
        /// The cell.
        cell: String,
        /// The point.
        point: String,
    },
    /// No point of a study came to a result.
    #[error("no point of '{scene}' came to a result: {first}")]
    NothingRan {
        /// The scene.
        scene: String,
        /// Why the first one did not.
        first: String,
    },
    /// The file is another study's, or cannot be written.
    #[error(transparent)]
    File(#[from] pd_io::Error),
}

/// What a knob stands at.
#[derive(Debug, Clone, PartialEq)]
pub enum Value {
    /// A number.
    Number(f64),
    /// A name.
    Name(String),
}

impl From<f64> for Value {
    fn from(number: f64) -> Self {
        Self::Number(number)
    }
}
impl From<&str> for Value {
    fn from(name: &str) -> Self {
        Self::Name(name.to_owned())
    }
}
impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(x) if *x != 0.0 && !(1e-3..1e6).contains(&x.abs()) => write!(f, "{x:e}"),
            Self::Number(x) => write!(f, "{x}"),
            Self::Name(name) => f.write_str(name),
        }
    }
}

#[derive(Debug, Clone)]
struct Knob {
    name: String,
    values: Vec<Value>,
}

/// A point of a sweep: a value for every knob.
#[derive(Debug, Clone, PartialEq)]
pub struct Point {
    values: Vec<(String, Value)>,
}

impl Point {
    /// What a knob stands at.
    ///
    /// # Errors
    /// [`Error::Unknown`].
    pub fn value(&self, knob: &str) -> Result<&Value> {
        self.values.iter().find(|(name, _)| name == knob).map(|(_, value)| value).ok_or_else(|| {
            let known = self.values.iter().map(|(name, _)| name.clone()).collect();
            Error::Unknown { what: "knob", name: knob.to_owned(), known }
        })
    }
    /// The number a knob stands at.
    ///
    /// # Errors
    /// [`Error::Unknown`], [`Error::Kind`].
    pub fn number(&self, knob: &str) -> Result<f64> {
        match self.value(knob)? {
            Value::Number(x) => Ok(*x),
            Value::Name(name) => Err(kind(knob, name, "number")),
        }
    }
    /// The name a knob stands at.
    ///
    /// # Errors
    /// [`Error::Unknown`], [`Error::Kind`].
    pub fn name(&self, knob: &str) -> Result<&str> {
        match self.value(knob)? {
            Value::Name(name) => Ok(name),
            Value::Number(x) => Err(kind(knob, &x.to_string(), "name")),
        }
    }
}

fn kind(knob: &str, value: &str, wanted: &'static str) -> Error {
    Error::Kind { knob: knob.to_owned(), value: value.to_owned(), wanted }
}

impl fmt::Display for Point {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let parts: Vec<String> = self.values.iter().map(|(k, v)| format!("{k} = {v}")).collect();
        f.write_str(&parts.join(", "))
    }
}

/// What a scene found at a point.
#[derive(Debug, Clone, PartialEq)]
pub struct Record {
    error: f64,
    nodes: usize,
    steps: usize,
    bytes: usize,
    figures: Vec<(String, f64)>,
}

impl Record {
    /// The error against the reference, and nothing else yet.
    pub fn new(error: f64) -> Self {
        Self { error, nodes: 0, steps: 0, bytes: 0, figures: Vec::new() }
    }
    /// With the nodes and bytes of the body, and how often its forces were evaluated: time steps,
    /// or iterations of a solver.
    pub fn of<T, const D: usize, F, M, P>(
        mut self,
        body: &Body<T, D, F, M, P>,
        steps: usize,
    ) -> Self
    where
        T: Real,
        F: Family<T, D>,
        M: Material<T, D>,
        P: DamagePolicy<T, D, M>,
    {
        (self.nodes, self.steps, self.bytes) = (body.nodes(), steps, body.memory().total());
        self
    }
    /// With a figure announced by [`Study::figure`].
    pub fn with(mut self, name: &str, value: f64) -> Self {
        self.figures.push((name.to_owned(), value));
        self
    }
}

/// What a point cost and how wrong it was.
#[derive(Debug, Clone, PartialEq)]
pub struct Measured {
    /// Error against the reference.
    pub error: f64,
    /// Time of the scene in seconds, set-up included.
    pub seconds: f64,
    /// Nodes.
    pub nodes: usize,
    /// Evaluations of the forces.
    pub steps: usize,
    /// Bytes of the body.
    pub bytes: usize,
    /// Further figures, in the study's order (NaN where the scene gave none).
    pub figures: Vec<f64>,
}

/// A cost that accuracy is traded for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Cost {
    /// Seconds.
    Time,
    /// Bytes of the body.
    Memory,
    /// Nodes times steps.
    NodeSteps,
}

impl Cost {
    fn of(self, measured: &Measured) -> f64 {
        match self {
            Self::Time => measured.seconds,
            Self::Memory => measured.bytes as f64,
            Self::NodeSteps => measured.nodes as f64 * measured.steps as f64,
        }
    }
    fn label(self) -> &'static str {
        match self {
            Self::Time => "time [s]",
            Self::Memory => "memory [bytes]",
            Self::NodeSteps => "node-steps",
        }
    }
    fn word(self) -> &'static str {
        match self {
            Self::Time => "time",
            Self::Memory => "memory",
            Self::NodeSteps => "work",
        }
    }
}

/// A sweep of knobs over a scene.
pub struct Study {
    scene: String,
    knobs: Vec<Knob>,
    figures: Vec<String>,
    /// Indices of the values of every knob, without repetition; the base comes first.
    points: Vec<Vec<usize>>,
    clock: Box<dyn Fn() -> f64>,
    resolution: f64,
}

impl Study {
    /// Of a scene; its name tells the file of one study from that of another.
    pub fn new(scene: &str) -> Self {
        let start = Instant::now();
        Self {
            scene: scene.to_owned(),
            knobs: Vec::new(),
            figures: Vec::new(),
            points: Vec::new(),
            clock: Box::new(move || start.elapsed().as_secs_f64()),
            resolution: 0.0,
        }
    }
    /// Adds a knob with its values, the base first. All knobs come before the sweeps.
    pub fn knob<V: Into<Value>>(mut self, name: &str, values: impl IntoIterator<Item = V>) -> Self {
        let values = values.into_iter().map(Into::into).collect();
        self.knobs.push(Knob { name: name.to_owned(), values });
        self
    }
    /// Announces a figure that the scene records beside the error.
    pub fn figure(mut self, name: &str) -> Self {
        self.figures.push(name.to_owned());
        self
    }
    /// How well the reference itself is known: smaller errors are chance, such as two faults that
    /// cancel, and count as this large on fronts and in turns.
    pub fn resolution(mut self, error: f64) -> Self {
        self.resolution = error;
        self
    }
    /// Measures time by another clock, in seconds: a thread's own processor time where a machine
    /// is shared.
    pub fn clock(mut self, clock: impl Fn() -> f64 + 'static) -> Self {
        self.clock = Box::new(clock);
        self
    }
    /// Adds all combinations of the values of these knobs, the others at their base.
    ///
    /// # Errors
    /// [`Error::Unknown`], [`Error::Knob`].
    pub fn grid(mut self, knobs: &[&str]) -> Result<Self> {
        self.check()?;
        let mut points = vec![vec![0; self.knobs.len()]];
        for name in knobs {
            let place = self.knobs.iter().position(|knob| knob.name == *name);
            let place = place.ok_or_else(|| Error::Unknown {
                what: "knob",
                name: (*name).to_owned(),
                known: self.knobs.iter().map(|knob| knob.name.clone()).collect(),
            })?;
            let turned = |(point, value): (&Vec<usize>, usize)| {
                let mut point = point.clone();
                point[place] = value;
                point
            };
            let values = self.knobs[place].values.len();
            points =
                points.iter().flat_map(|p| (0..values).map(move |v| (p, v))).map(turned).collect();
        }
        self.add(points);
        Ok(self)
    }
    /// Adds the base and, from there, every value of every knob alone.
    ///
    /// # Errors
    /// [`Error::Knob`].
    pub fn one_at_a_time(mut self) -> Result<Self> {
        self.check()?;
        let base = vec![0; self.knobs.len()];
        let mut points = vec![base.clone()];
        for (place, knob) in self.knobs.iter().enumerate() {
            points.extend((1..knob.values.len()).map(|value| {
                let mut point = base.clone();
                point[place] = value;
                point
            }));
        }
        self.add(points);
        Ok(self)
    }
    fn add(&mut self, points: Vec<Vec<usize>>) {
        for point in points {
            if !self.points.contains(&point) {
                self.points.push(point);
            }
        }
    }
    fn check(&self) -> Result<()> {
        for (i, knob) in self.knobs.iter().enumerate() {
            let fault = |problem| Err(Error::Knob { knob: knob.name.clone(), problem });
            if self.knobs[..i].iter().any(|other| other.name == knob.name) {
                return fault("is there twice: give each knob its own name");
            }
            if knob.values.is_empty() {
                return fault("has no value: give at least the base");
            }
            let told: Vec<String> = knob.values.iter().map(ToString::to_string).collect();
            if (1..told.len()).any(|v| told[..v].contains(&told[v])) {
                return fault("has a value twice: remove one");
            }
        }
        Ok(())
    }
    fn point(&self, indices: &[usize]) -> Point {
        let values = self.knobs.iter().zip(indices);
        Point { values: values.map(|(k, &i)| (k.name.clone(), k.values[i].clone())).collect() }
    }

    /// Runs the scene at every point that the file does not hold yet. A point whose scene fails (a
    /// calibration that is not stable, a step too long) is recorded with the reason and does not
    /// stop the study; a point of the file that is not in the sweep is left alone.
    ///
    /// # Errors
    /// [`Error::File`] for a file of another study and one that cannot be written, [`Error::Cell`],
    /// [`Error::Unknown`] for a figure not announced, [`Error::NothingRan`].
    pub fn run(
        &self,
        path: impl AsRef<Path>,
        mut scene: impl FnMut(&Point) -> std::result::Result<Record, Box<dyn std::error::Error>>,
    ) -> Result<Trade> {
        let path = path.as_ref();
        let knobs = self.knobs.iter().map(|knob| knob.name.as_str());
        let measures = ["error", "time [s]", "nodes", "steps", "bytes"];
        let figures = self.figures.iter().map(String::as_str);
        let columns: Vec<&str> =
            knobs.chain(measures).chain(figures).chain(["refused because"]).collect();
        let (mut ledger, lines) = Ledger::open(path, &self.scene, &columns)?;
        let mut rows = Vec::new();
        for indices in &self.points {
            let point = self.point(indices);
            let key: Vec<String> = point.values.iter().map(|(_, v)| v.to_string()).collect();
            let outcome = match lines.iter().find(|line| line.starts_with(&key)) {
                Some(line) => self.read(path, &point, &line[key.len()..])?,
                None => {
                    let outcome = self.measure(&point, &mut scene)?;
                    ledger
                        .row(&key.into_iter().chain(self.written(&outcome)).collect::<Vec<_>>())?;
                    outcome
                }
            };
            let turned: Vec<usize> = (0..indices.len()).filter(|&k| indices[k] != 0).collect();
            rows.push(Row { point, outcome, turned });
        }
        let (scene, figures) = (self.scene.clone(), self.figures.clone());
        let trade = Trade { scene, figures, rows, resolution: self.resolution };
        if trade.measured().next().is_none() {
            let first = trade.rows.first().map_or("it has no point", |row| match &row.outcome {
                Ok(_) => "",
                Err(refusal) => refusal,
            });
            return Err(Error::NothingRan { scene: self.scene.clone(), first: first.to_owned() });
        }
        Ok(trade)
    }

    fn measure(
        &self,
        point: &Point,
        scene: &mut impl FnMut(&Point) -> std::result::Result<Record, Box<dyn std::error::Error>>,
    ) -> Result<std::result::Result<Measured, String>> {
        let start = (self.clock)();
        let record = scene(point);
        let seconds = (self.clock)() - start;
        let record = match record {
            Ok(record) if record.error.is_finite() => record,
            Ok(record) => return Ok(Err(format!("the error is {}", record.error))),
            // A knob or figure misspelt is a fault of the program, not of the point.
            Err(fault) => match fault.downcast::<Error>() {
                Ok(fault) => return Err(*fault),
                Err(refusal) => return Ok(Err(refusal.to_string().replace(['\n', '\r'], " "))),
            },
        };
        let mut figures = vec![f64::NAN; self.figures.len()];
        for (name, value) in record.figures {
            let place = self.figures.iter().position(|figure| *figure == name);
            let known = self.figures.clone();
            figures[place.ok_or(Error::Unknown { what: "figure", name, known })?] = value;
        }
        let Record { error, nodes, steps, bytes, .. } = record;
        Ok(Ok(Measured { error, seconds, nodes, steps, bytes, figures }))
    }

    fn written(&self, outcome: &std::result::Result<Measured, String>) -> Vec<String> {
        match outcome {
            Ok(m) => {
                let head = [format!("{:e}", m.error), format!("{:e}", m.seconds)];
                let counts = [m.nodes, m.steps, m.bytes].map(|count| count.to_string());
                let figures = m.figures.iter().map(|figure| format!("{figure:e}"));
                head.into_iter().chain(counts).chain(figures).chain([String::new()]).collect()
            }
            Err(refusal) => {
                let empty = vec![String::new(); 5 + self.figures.len()];
                empty.into_iter().chain([refusal.clone()]).collect()
            }
        }
    }
    fn read(
        &self,
        path: &Path,
        point: &Point,
        cells: &[String],
    ) -> Result<std::result::Result<Measured, String>> {
        let refusal = &cells[cells.len() - 1];
        if !refusal.is_empty() {
            return Ok(Err(refusal.clone()));
        }
        let number = |cell: &String| -> Result<f64> {
            let (file, point) = (path.display().to_string(), point.to_string());
            cell.parse().map_err(|_| Error::Cell { file, cell: cell.clone(), point })
        };
        let count = |cell| number(cell).map(|x| x as usize);
        Ok(Ok(Measured {
            error: number(&cells[0])?,
            seconds: number(&cells[1])?,
            nodes: count(&cells[2])?,
            steps: count(&cells[3])?,
            bytes: count(&cells[4])?,
            figures: cells[5..cells.len() - 1].iter().map(number).collect::<Result<_>>()?,
        }))
    }
}

/// A point and what came of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// The point.
    pub point: Point,
    /// What was measured, or why the scene refused.
    pub outcome: std::result::Result<Measured, String>,
    /// Knobs that are not at their base.
    turned: Vec<usize>,
}

/// The outcome of a study.
#[derive(Debug, Clone, PartialEq)]
pub struct Trade {
    scene: String,
    figures: Vec<String>,
    rows: Vec<Row>,
    resolution: f64,
}

/// What turning one knob from its base does: ratios to the base.
#[derive(Debug, Clone, PartialEq)]
pub struct Turn {
    /// The knob.
    pub knob: String,
    /// Its base.
    pub from: Value,
    /// Where it is turned to.
    pub to: Value,
    /// Error over that of the base.
    pub error: f64,
    /// Cost over that of the base.
    pub cost: f64,
}

/// What a turn is good for. Changes of the error within 5 % and of the cost within 15 % are none.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Worth {
    /// Better in one, in the other no worse.
    Free,
    /// Less error for more cost.
    Buys,
    /// Less cost for more error.
    Saves,
    /// Nothing changes.
    Idle,
    /// Worse in one, in the other no better.
    Loses,
}

impl Turn {
    /// What it is good for.
    pub fn worth(&self) -> Worth {
        let sign = |ratio: f64, same: f64| match ratio {
            r if r < 1.0 - same => -1,
            r if r > 1.0 + same => 1,
            _ => 0,
        };
        match (sign(self.error, SAME_ERROR), sign(self.cost, SAME_COST)) {
            (0, 0) => Worth::Idle,
            (-1 | 0, -1 | 0) => Worth::Free,
            (-1, 1) => Worth::Buys,
            (1, -1) => Worth::Saves,
            _ => Worth::Loses,
        }
    }
    /// The sensitivity p of error ∝ cost^−p between base and turn: large is a good buy, and small
    /// a good saving.
    pub fn sensitivity(&self) -> f64 {
        -self.error.ln() / self.cost.ln()
    }
}

impl fmt::Display for Turn {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { knob, from, to, error, cost } = self;
        write!(f, "{knob} from {from} to {to} (error × {}, cost × {})", ratio(*error), ratio(*cost))
    }
}

/// Whether this very row is among them (rows may hold NaN figures).
fn has(rows: &[&Row], row: &Row) -> bool {
    rows.iter().any(|other| std::ptr::eq(*other, row))
}

/// Two or three digits.
fn ratio(x: f64) -> String {
    match x {
        x if x >= 10.0 => format!("{x:.0}"),
        x if x >= 0.1 => format!("{x:.2}"),
        x => format!("{x:.1e}"),
    }
}

impl Trade {
    /// All points, in the order of the sweep.
    pub fn rows(&self) -> &[Row] {
        &self.rows
    }
    /// A figure of a point by name.
    ///
    /// # Errors
    /// [`Error::Unknown`].
    pub fn figure(&self, measured: &Measured, name: &str) -> Result<f64> {
        let place = self.figures.iter().position(|figure| figure == name);
        let known = self.figures.clone();
        let fault = Error::Unknown { what: "figure", name: name.to_owned(), known };
        place.map(|place| measured.figures[place]).ok_or(fault)
    }
    fn measured(&self) -> impl Iterator<Item = (&Row, &Measured)> {
        self.rows.iter().filter_map(|row| row.outcome.as_ref().ok().map(|m| (row, m)))
    }

    /// The error, not below what the reference can tell.
    fn error(&self, measured: &Measured) -> f64 {
        measured.error.max(self.resolution)
    }

    /// The Pareto front, cheapest first: points that no other beats in cost or error without being
    /// worse in the other.
    pub fn front(&self, cost: Cost) -> Vec<(&Row, &Measured)> {
        let mut all: Vec<_> = self.measured().collect();
        all.sort_by(|a, b| {
            let by_cost = cost.of(a.1).total_cmp(&cost.of(b.1));
            by_cost.then(self.error(a.1).total_cmp(&self.error(b.1)))
        });
        let mut best = f64::INFINITY;
        all.retain(|(_, m)| {
            let better = self.error(m) < best;
            best = best.min(self.error(m));
            better
        });
        all
    }

    /// What every single turn from the base does, those of one knob together; refused ones are left
    /// out, and so are all if the base is refused.
    pub fn turns(&self, cost: Cost) -> Vec<Turn> {
        let Some((base, b)) = self.measured().find(|(row, _)| row.turned.is_empty()) else {
            return Vec::new();
        };
        let single = self.measured().filter(|(row, _)| row.turned.len() == 1);
        let mut turns: Vec<(usize, Turn)> = single
            .map(|(row, m)| {
                let knob = row.turned[0];
                let (name, to) = row.point.values[knob].clone();
                let from = base.point.values[knob].1.clone();
                let (error, cost) = (self.error(m) / self.error(b), cost.of(m) / cost.of(b));
                (knob, Turn { knob: name, from, to, error, cost })
            })
            .collect();
        turns.sort_by_key(|(knob, _)| *knob);
        turns.into_iter().map(|(_, turn)| turn).collect()
    }

    /// Which knob to turn first, in plain words, from the figures alone.
    pub fn words(&self, cost: Cost) -> String {
        let turns = self.turns(cost);
        let word = cost.word();
        let list = |worth: Worth, key: fn(&Turn) -> f64| -> Vec<&Turn> {
            let mut chosen: Vec<&Turn> = turns.iter().filter(|t| t.worth() == worth).collect();
            chosen.sort_by(|a, b| key(a).total_cmp(&key(b)));
            chosen
        };
        let say = |turn: &Turn| {
            let Turn { knob, from, to, error, cost } = turn;
            let (error, cost) = (ratio(*error), ratio(*cost));
            format!("{knob} from {from} to {to} (error × {error}, {word} × {cost})")
        };
        let join = |turns: &[&Turn]| turns.iter().map(|t| say(t)).collect::<Vec<_>>().join("; ");
        let mut text = String::new();
        let mut line = |head: String, turns: &[&Turn]| {
            if !turns.is_empty() {
                // Writing to a string cannot fail.
                let _ = writeln!(text, "- {head} {}.", join(turns));
            }
        };
        line("Turn first what costs nothing:".into(), &list(Worth::Free, |t| t.error * t.cost));
        let buys = list(Worth::Buys, |t| -t.sensitivity());
        if let Some(best) = buys.first() {
            let halving = 2_f64.powf(1.0 / best.sensitivity());
            let head = format!(
                "For less error, best buy first (with the first, half the error costs {} times the \
                 {word}):",
                ratio(halving)
            );
            line(head, &buys);
        }
        let saves = list(Worth::Saves, Turn::sensitivity);
        line(format!("For less {word}, best saving first:"), &saves);
        line(format!("Neither error nor {word} changes:"), &list(Worth::Idle, |_| 0.0));
        line(
            "Not worth it, more of one and no less of the other:".into(),
            &list(Worth::Loses, |t| t.error * t.cost),
        );
        for row in &self.rows {
            if let (Err(refusal), Some(&knob)) = (&row.outcome, row.turned.first())
                && row.turned.len() == 1
            {
                let (knob, value) = &row.point.values[knob];
                // The file holds what to do about it too.
                let why = refusal.split(": ").next().unwrap_or_default();
                let _ = writeln!(text, "- Refused: {knob} = {value}: {why}.");
            }
        }
        text
    }

    /// A Markdown table of the points chosen: the knobs that differ among all points, error and
    /// costs, the figures, and on which front a point lies.
    pub fn table(&self, choose: impl Fn(&Row) -> bool) -> String {
        let fronts: Vec<(Cost, Vec<&Row>)> = [Cost::Time, Cost::Memory, Cost::NodeSteps]
            .map(|cost| (cost, self.front(cost).into_iter().map(|(row, _)| row).collect()))
            .into();
        let first = self.rows.first().map_or(&[][..], |row| &row.point.values);
        let varied: Vec<usize> = (0..first.len())
            .filter(|&k| self.rows.iter().any(|row| row.point.values[k].1 != first[k].1))
            .collect();
        let knobs = varied.iter().map(|&k| first[k].0.clone());
        let costs = ["error", "time [s]", "node-steps", "memory [MB]"].map(str::to_owned);
        let figures = self.figures.iter().cloned();
        let head: Vec<String> =
            knobs.chain(costs).chain(figures).chain(["front".to_owned()]).collect();
        let mut text = format!("| {} |\n|{}\n", head.join(" | "), " --- |".repeat(head.len()));
        let mut chosen: Vec<&Row> = self.rows.iter().filter(|row| choose(row)).collect();
        let time = |row: &Row| row.outcome.as_ref().map_or(f64::INFINITY, |m| m.seconds);
        chosen.sort_by(|a, b| time(a).total_cmp(&time(b)));
        for row in chosen {
            let mut cells: Vec<String> =
                varied.iter().map(|&k| row.point.values[k].1.to_string()).collect();
            match &row.outcome {
                Ok(m) => {
                    cells.push(format!("{:.3e}", m.error));
                    cells.push(format!("{:.3}", m.seconds));
                    cells.push(format!("{:.2e}", Cost::NodeSteps.of(m)));
                    cells.push(format!("{:.2}", m.bytes as f64 * 1e-6));
                    cells.extend(m.figures.iter().map(|figure| format!("{figure:.3e}")));
                    let on = fronts.iter().filter(|(_, front)| has(front, row));
                    cells.push(on.map(|(cost, _)| cost.word()).collect::<Vec<_>>().join(", "));
                }
                Err(_) => {
                    cells.extend(vec!["–".to_owned(); 4 + self.figures.len()]);
                    cells.push("refused".to_owned());
                }
            }
            let _ = writeln!(text, "| {} |", cells.join(" | "));
        }
        text
    }

    /// The table of the points on a front.
    pub fn front_table(&self, cost: Cost) -> String {
        let front: Vec<&Row> = self.front(cost).into_iter().map(|(row, _)| row).collect();
        self.table(|row| has(&front, row))
    }

    /// Draws error against cost, every point and the front, on logarithmic axes. Points without
    /// error or cost are left out.
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn plot(&self, cost: Cost, path: impl AsRef<Path>) -> Result<()> {
        let shown = |(_, m): &(&Row, &Measured)| m.error > 0.0 && cost.of(m) > 0.0;
        let place = |(_, m): (&Row, &Measured)| (cost.of(m), m.error);
        let all: Vec<_> = self.measured().filter(shown).map(place).collect();
        let front: Vec<_> = self.front(cost).into_iter().filter(shown).map(place).collect();
        LinePlot::new(&self.scene, cost.label(), "error")
            .dots("all points", &all)
            .line("front", &front)
            .log_log()
            .write(path)?;
        Ok(())
    }
}
