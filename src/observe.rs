//! Ready-made observers: a progress bar, a CSV history of anything, ParaView series.
//!
//! A closure is an observer too; these are the ones most runs want. Columns of a [`Table`] that
//! most histories have:
//!
//! | what | column |
//! |---|---|
//! | energies | `\|view\| view.energies.map_or(f64::NAN, \|e\| e.strain)`, after `run.with_energies()` |
//! | reaction force | `\|view\| reaction(view.body, &grip)[1]` |
//! | crack tip | `\|view\| tip.position(view.body)[0]` with a [`CrackTip`](pd_damage::CrackTip) |
//! | damage | `\|view\| view.body.broken_bonds() as f64` |
//! | margin | `\|view\| view.body.worst_index()`; [`Margin`] says it in words |
//!
//! A closure that returns [`Flow::Stop`] ends the run early.

use nalgebra::{SMatrix, SVector};
use pd_core::body::{Body, Dynamics};
use pd_core::damage::DamagePolicy;
use pd_core::family::Family;
use pd_core::material::{Material, StrainEnergy, StressState};
use pd_core::run::{Flow, Margin, Observer, View};
use pd_core::{Error, Real, Result};
use pd_io::{History, Series, Snapshot};
use std::io::Write;
use std::path::Path;
use std::time::Instant;

fn output(error: pd_io::Error) -> Error {
    Error::Other(error.to_string())
}

/// A progress line on standard error: share done, step, time, broken bonds, time left. When the
/// run is over it closes with the margin: "plate: no bond broke; the worst reached 0.83".
///
/// Written by hand: one line that is overwritten needs no terminal library.
pub struct Progress {
    label: String,
    out: Box<dyn Write>,
    /// When the first line was shown, and the share done then: 0 unless the run was resumed.
    start: Option<(Instant, f64)>,
    margin: Option<Margin>,
}

impl Progress {
    /// With a label.
    pub fn new(label: &str) -> Self {
        Self::to(std::io::stderr(), label)
    }
    /// Into a writer: a log, a test.
    pub fn to(out: impl Write + 'static, label: &str) -> Self {
        Self { label: label.to_owned(), out: Box::new(out), start: None, margin: None }
    }

    fn show<T: Real, const D: usize, B: Dynamics<T, D>>(&mut self, view: &View<'_, B>) -> Flow {
        let done = if view.end > 0.0 { (view.time / view.end).min(1.0) } else { 1.0 };
        let (start, before) = *self.start.get_or_insert_with(|| (Instant::now(), done));
        let elapsed = start.elapsed().as_secs_f64();
        let left = if done > before { elapsed * (1.0 - done) / (done - before) } else { 0.0 };
        let filled = (done * 24.0) as usize;
        let bar = format!("{}{}", "#".repeat(filled), ".".repeat(24 - filled));
        let (label, percent, step, time) = (&self.label, 100.0 * done, view.step, view.time);
        self.margin = view.body.can_break().then(|| Margin::of(view.body));
        let damage = self.margin.map_or(String::new(), |margin| format!(", {margin}"));
        // A progress line that cannot be shown is no reason to end a run.
        let _ = write!(
            self.out,
            "\r{label} [{bar}] {percent:3.0} %  step {step}, t = {time:.3e} s{damage}, {left:.0} s \
             left   "
        );
        let _ = self.out.flush();
        Flow::Continue
    }
}

/// The run is over, at its end or before: the line is closed.
impl Drop for Progress {
    fn drop(&mut self) {
        if self.start.is_some() {
            let closing = self.margin.map(|margin| format!("{}: {margin}\n", self.label));
            let _ = write!(self.out, "\n{}", closing.unwrap_or_default());
        }
    }
}

impl<T, const D: usize, F, M, P> Observer<Body<T, D, F, M, P>> for Progress
where
    T: Real,
    F: Family<T, D>,
    M: Material<T, D>,
    P: DamagePolicy<T, D, M>,
{
    fn observe(&mut self, view: &View<'_, Body<T, D, F, M, P>>) -> Result<Flow> {
        Ok(self.show(view))
    }
}

type Column<'a, B> = Box<dyn Fn(&View<'_, B>) -> f64 + 'a>;

/// A CSV history: the time and columns of your choice.
///
/// ```text
/// Table::create("out/history.csv")?
///     .column("reaction [N]", |view| reaction(view.body, &grip)[1])
///     .column("kinetic [J]", |view| kinetic_energy(view.body))
/// ```
pub struct Table<'a, B> {
    path: std::path::PathBuf,
    history: Option<History>,
    columns: Vec<(String, Column<'a, B>)>,
    /// Time up to which rows of an earlier run stay.
    last: Option<f64>,
}

impl<'a, B> Table<'a, B> {
    /// A table in this file.
    pub fn new(path: impl AsRef<Path>) -> Self {
        Self { path: path.as_ref().to_owned(), history: None, columns: Vec::new(), last: None }
    }
    /// Goes on with the table of a run that was stopped: rows up to the time `last` in seconds stay
    /// (none of them for `None`).
    pub fn resume(mut self, last: Option<f64>) -> Self {
        self.last = last;
        self
    }
    /// Adds a column.
    pub fn column(mut self, name: &str, value: impl Fn(&View<'_, B>) -> f64 + 'a) -> Self {
        self.columns.push((name.to_owned(), Box::new(value)));
        self
    }
}

impl<B> Observer<B> for Table<'_, B> {
    fn observe(&mut self, view: &View<'_, B>) -> Result<Flow> {
        let history = match &mut self.history {
            Some(history) => history,
            empty => {
                let names = self.columns.iter().map(|(name, _)| name.as_str());
                let names: Vec<&str> = std::iter::once("time [s]").chain(names).collect();
                let history = match self.last {
                    Some(last) => History::resume(&self.path, &names, last),
                    None => History::create(&self.path, &names),
                };
                empty.insert(history.map_err(output)?)
            }
        };
        let values = self.columns.iter().map(|(_, value)| value(view));
        let row: Vec<f64> = std::iter::once(view.time).chain(values).collect();
        history.row(&row).map_err(output)?;
        Ok(Flow::Continue)
    }
}

/// Displacement, velocity and damage of a body, ready to be written.
pub fn snapshot<T, const D: usize, F, M, P>(body: &Body<T, D, F, M, P>) -> Snapshot<D>
where
    T: Real,
    F: Family<T, D>,
    M: Material<T, D>,
    P: DamagePolicy<T, D, M>,
{
    let nodes = 0..body.nodes();
    let vectors = |of: &dyn Fn(usize) -> SVector<f64, D>| -> Vec<SVector<f64, D>> {
        nodes.clone().map(of).collect()
    };
    let damage: Vec<f64> = nodes.clone().map(|i| body.damage(i)).collect();
    Snapshot::new(&vectors(&|i| body.position(i)))
        .vector("displacement", &vectors(&|i| body.displacement(i)))
        .vector("velocity", &vectors(&|i| body.velocity(i)))
        .scalar("damage", &damage)
}

/// As [`snapshot`], with the Cauchy stress.
pub fn snapshot_with_stress<T, const D: usize, F, M, P>(body: &Body<T, D, F, M, P>) -> Snapshot<D>
where
    T: Real,
    F: Family<T, D>,
    M: StressState<T, D>,
    P: DamagePolicy<T, D, M>,
{
    let stress: Vec<SMatrix<f64, D, D>> = (0..body.nodes()).map(|i| body.stress(i)).collect();
    snapshot(body).tensor("stress", &stress)
}

/// As [`snapshot`], with the strain energy density.
pub fn snapshot_with_energy<T, const D: usize, F, M, P>(body: &Body<T, D, F, M, P>) -> Snapshot<D>
where
    T: Real,
    F: Family<T, D>,
    M: StrainEnergy<T, D>,
    P: DamagePolicy<T, D, M>,
{
    snapshot(body).scalar("strain energy density", &body.energy_densities())
}

/// Writes a snapshot into a ParaView series at every call.
pub struct FieldOutput<B, const D: usize> {
    series: Series,
    take: fn(&B) -> Snapshot<D>,
}

impl<B, const D: usize> FieldOutput<B, D> {
    /// A series `name.pvd` in `folder` of what `take` gives: [`snapshot`], [`snapshot_with_stress`],
    /// [`snapshot_with_energy`] or your own, `|body| snapshot(body).scalar("speed", …)`.
    ///
    /// # Errors
    /// A folder that cannot be written, a name that is empty or has a slash.
    pub fn create(
        folder: impl AsRef<Path>,
        name: &str,
        take: fn(&B) -> Snapshot<D>,
    ) -> Result<Self> {
        Ok(Self { series: Series::create(folder, name).map_err(output)?, take })
    }
    /// Goes on with the series of a run that was stopped: steps up to the time `last` in seconds
    /// stay (none of them for `None`).
    ///
    /// # Errors
    /// As [`create`](Self::create), and for a series that cannot be read.
    pub fn resume(
        folder: impl AsRef<Path>,
        name: &str,
        take: fn(&B) -> Snapshot<D>,
        last: Option<f64>,
    ) -> Result<Self> {
        match last {
            Some(last) => {
                Ok(Self { series: Series::resume(folder, name, last).map_err(output)?, take })
            }
            None => Self::create(folder, name, take),
        }
    }
}

impl<B, const D: usize> Observer<B> for FieldOutput<B, D> {
    fn observe(&mut self, view: &View<'_, B>) -> Result<Flow> {
        let snapshot = (self.take)(view.body);
        self.series.write(view.time, &snapshot).map_err(output)?;
        Ok(Flow::Continue)
    }
}
