//! A short run of a study is a test: a HARD measure that misses ends it with an error, unless it is
//! known to; a run of another size only reports.
use peridynamics::prelude::*;
use peridynamics::study::{Effort, conclude};

#[test]
fn a_miss_is_an_error_unless_known() {
    let folder = concat!(env!("CARGO_TARGET_TMPDIR"), "/short_runs_fail");
    let mut table = Measures::new("plate", &Effort::Short.command("plate"));
    table.hard_most("angle at the left", 7.0, 5.0).soft_most("time", 2.0, 1.0);
    table.hard_least("growth", f64::NAN, 1.0);
    let error = conclude(&table, Effort::Short, folder, &["angle"]).expect_err("growth misses");
    assert!(error.to_string().contains("growth") && !error.to_string().contains("angle"));
    conclude(&table, Effort::Short, folder, &["angle", "growth"]).expect("both are known");
    conclude(&table, Effort::Default, folder, &[]).expect("reported only");
    let read = |file: &str| std::fs::read_to_string(format!("{folder}/{file}")).expect(file);
    assert!(read("measures_short.md").contains("--example plate -- --short`"));
    assert_eq!(read("measures.md"), read("measures_short.md"));
}
