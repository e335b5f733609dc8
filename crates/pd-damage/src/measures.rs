//! A table of measures: what an example was to reach, what it got, and whether that is enough.

use pd_core::{Error, Result};
use std::fmt;
use std::path::Path;

/// What hangs on a measure.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Demand {
    /// Must hold.
    Hard,
    /// Is reported, and flagged if outside.
    Soft,
}

#[derive(Debug, Clone, PartialEq)]
struct Row {
    measure: String,
    reference: String,
    got: String,
    /// What hangs on it and whether it holds; nothing for a figure that is only told.
    verdict: Option<(Demand, bool)>,
}

/// Measures of one run: printed as `measure | reference | got | pass`, and written as Markdown for
/// `docs/validation.md`.
///
/// ```
/// use pd_damage::Measures;
/// let mut measures = Measures::new("plate", "cargo run --release --example plate");
/// measures.hard_near("line angle [°]", 44.1, 45.0, 3.0).soft_most("mirror error", 0.07, 0.05);
/// measures.soft_near("angle of the second crack [°]", f64::NAN, 45.0, 3.0);
/// measures.compared("force [N]", 103.0, 100.0);
/// assert!(measures.passed());
/// assert!(measures.to_string().contains("line angle [°] (HARD) | 45 ± 3 | 44.10 | yes"));
/// assert!(measures.to_string().contains("mirror error (SOFT) | ≤ 0.05 | 0.07000 | no"));
/// assert!(measures.to_string().contains("second crack [°] (SOFT) | 45 ± 3 | none | no"));
/// assert!(measures.to_string().contains("force [N] | 100.0 | 103.0 (+3.0 %) | –"));
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Measures {
    title: String,
    command: String,
    rows: Vec<Row>,
}

/// Four digits that count; NaN is what found nothing to measure.
fn digits(x: f64) -> String {
    let size = x.abs();
    if x.is_nan() {
        "none".to_owned()
    } else if x == 0.0 {
        "0".to_owned()
    } else if !(1e-4..1e5).contains(&size) {
        format!("{x:.3e}")
    } else {
        let decimals = (3 - size.log10().floor() as i32).clamp(0, 7) as usize;
        format!("{x:.decimals$}")
    }
}

/// A bound without the noise of its last digits.
fn bound(x: f64) -> String {
    let clean: f64 = format!("{x:.5e}").parse().unwrap_or(x);
    if clean == 0.0 || clean.abs() >= 1e-3 { format!("{clean}") } else { format!("{clean:e}") }
}

impl Measures {
    /// An empty table; `command` is what prints it.
    pub fn new(title: &str, command: &str) -> Self {
        Self { title: title.to_owned(), command: command.to_owned(), rows: Vec::new() }
    }
    /// Any measure, in words.
    pub fn add(
        &mut self,
        demand: Demand,
        measure: &str,
        reference: &str,
        got: &str,
        pass: bool,
    ) -> &mut Self {
        self.row(measure, reference, got, Some((demand, pass)))
    }
    fn row(
        &mut self,
        measure: &str,
        reference: &str,
        got: &str,
        verdict: Option<(Demand, bool)>,
    ) -> &mut Self {
        let [measure, reference, got] = [measure, reference, got].map(|t| t.replace('|', "¦"));
        self.rows.push(Row { measure, reference, got, verdict });
        self
    }
    /// A figure that nothing hangs on.
    pub fn told(&mut self, measure: &str, got: f64) -> &mut Self {
        self.row(measure, "–", &digits(got), None)
    }
    /// The same in words, beside a reference.
    pub fn told_in_words(&mut self, measure: &str, reference: &str, got: &str) -> &mut Self {
        self.row(measure, reference, got, None)
    }
    /// A figure beside one it may be compared with, and by how much it is larger.
    pub fn compared(&mut self, measure: &str, got: f64, reference: f64) -> &mut Self {
        let more = 100.0 * (got - reference) / reference.abs();
        let more = if got.is_nan() { String::new() } else { format!(" ({more:+.1} %)") };
        let got = digits(got) + &more;
        self.row(measure, &digits(reference), &got, None)
    }
    /// A measure that must lie within `tolerance` of `reference`. NaN (nothing to measure) fails.
    pub fn hard_near(&mut self, measure: &str, got: f64, reference: f64, tol: f64) -> &mut Self {
        self.near(Demand::Hard, measure, got, reference, tol)
    }
    /// A measure that is to lie within `tolerance` of `reference`.
    pub fn soft_near(&mut self, measure: &str, got: f64, reference: f64, tol: f64) -> &mut Self {
        self.near(Demand::Soft, measure, got, reference, tol)
    }
    fn near(&mut self, demand: Demand, measure: &str, got: f64, at: f64, tol: f64) -> &mut Self {
        let pass = (got - at).abs() <= tol;
        self.add(demand, measure, &format!("{} ± {}", bound(at), bound(tol)), &digits(got), pass)
    }
    /// A measure that must be at most `most`.
    pub fn hard_most(&mut self, measure: &str, got: f64, most: f64) -> &mut Self {
        self.add(Demand::Hard, measure, &format!("≤ {}", bound(most)), &digits(got), got <= most)
    }
    /// A measure that is to be at most `most`.
    pub fn soft_most(&mut self, measure: &str, got: f64, most: f64) -> &mut Self {
        self.add(Demand::Soft, measure, &format!("≤ {}", bound(most)), &digits(got), got <= most)
    }
    /// A measure that must be at least `least`.
    pub fn hard_least(&mut self, measure: &str, got: f64, least: f64) -> &mut Self {
        self.add(Demand::Hard, measure, &format!("≥ {}", bound(least)), &digits(got), got >= least)
    }
    /// A measure that is to be at least `least`.
    pub fn soft_least(&mut self, measure: &str, got: f64, least: f64) -> &mut Self {
        self.add(Demand::Soft, measure, &format!("≥ {}", bound(least)), &digits(got), got >= least)
    }
    /// A statement that must hold.
    pub fn hard(&mut self, statement: &str, holds: bool) -> &mut Self {
        self.add(Demand::Hard, statement, "holds", if holds { "holds" } else { "fails" }, holds)
    }
    /// A statement that is to hold.
    pub fn soft(&mut self, statement: &str, holds: bool) -> &mut Self {
        self.add(Demand::Soft, statement, "holds", if holds { "holds" } else { "fails" }, holds)
    }
    /// True if every HARD measure holds.
    pub fn passed(&self) -> bool {
        self.misses().next().is_none()
    }
    /// Names of the HARD measures that do not hold.
    pub fn misses(&self) -> impl Iterator<Item = &str> {
        let missed = |row: &&Row| row.verdict == Some((Demand::Hard, false));
        self.rows.iter().filter(missed).map(|row| row.measure.as_str())
    }
    /// The measures of another table, after these.
    pub fn extend(&mut self, other: Self) -> &mut Self {
        self.rows.extend(other.rows);
        self
    }
    /// The table in Markdown, under a heading and the command.
    pub fn to_markdown(&self) -> String {
        let mut text = format!("## {}\n\n`{}`\n\n", self.title, self.command);
        text += "| measure | reference | got | pass |\n|---|---|---|---|\n";
        for row in &self.rows {
            let pass = row.pass("**no**");
            text += &format!("| {} | {} | {} | {pass} |\n", row.name(), row.reference, row.got);
        }
        text
    }
    /// Writes [`to_markdown`](Self::to_markdown) to a file, whose folder is made.
    ///
    /// # Errors
    /// [`Error::Other`] with the path if it cannot be written.
    pub fn write(&self, path: impl AsRef<Path>) -> Result<()> {
        let path = path.as_ref();
        let folder = path.parent().map_or(Ok(()), std::fs::create_dir_all);
        folder
            .and_then(|()| std::fs::write(path, self.to_markdown()))
            .map_err(|error| Error::Other(format!("{}: {error}", path.display())))
    }
}

impl Row {
    fn name(&self) -> String {
        match self.verdict {
            Some((Demand::Hard, _)) => format!("{} (HARD)", self.measure),
            Some((Demand::Soft, _)) => format!("{} (SOFT)", self.measure),
            None => self.measure.clone(),
        }
    }
    fn pass(&self, miss: &'static str) -> &'static str {
        self.verdict.map_or("–", |(_, pass)| if pass { "yes" } else { miss })
    }
}

impl fmt::Display for Measures {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}\nmeasure | reference | got | pass", self.title)?;
        for row in &self.rows {
            let pass = row.pass("no");
            writeln!(f, "{} | {} | {} | {pass}", row.name(), row.reference, row.got)?;
        }
        Ok(())
    }
}
