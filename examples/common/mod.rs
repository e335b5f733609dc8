//! What the examples of this folder share: printing.
#![allow(dead_code)]

use peridynamics::core::statics::Progress;
pub use peridynamics::study::Effort;
use std::io::Write as _;

/// Result of an example.
pub type Outcome<X = ()> = std::result::Result<X, Box<dyn std::error::Error>>;

/// Prints the head of a table of measures.
pub fn head() {
    println!("measure | reference | got | pass");
}

/// Prints `name | ≤ limit | got | pass`.
pub fn at_most(name: &str, limit: f64, got: f64) {
    println!("{name} | ≤ {limit:.3e} | {got:.3e} | {}", got <= limit);
}

/// Prints `name | reference ± tolerance | got | pass`.
pub fn close_to(name: &str, reference: f64, tolerance: f64, got: f64) {
    let pass = (got - reference).abs() <= tolerance;
    println!("{name} | {reference:.4e} ± {tolerance:.1e} | {got:.4e} | {pass}");
}

/// Prints a figure that is reported, not judged.
pub fn reported(name: &str, got: f64) {
    println!("{name} | – | {got:.3e} | –");
}

/// Prints a figure beside its reference, not judged, with the relative difference.
pub fn compared(name: &str, reference: f64, got: f64) {
    println!(
        "{name} | {reference:.4e} | {got:.4e} ({:+.1} %) | –",
        100.0 * (got / reference - 1.0)
    );
}

/// A progress line for a static solution.
pub fn watch(label: &str) -> impl FnMut(Progress) + '_ {
    move |p| {
        if p.iteration % 50 == 0 {
            let _ = write!(
                std::io::stderr(),
                "\r{label}: iteration {}, residual {:.1e}    ",
                p.iteration,
                p.residual
            );
        }
    }
}

/// Ends a progress line.
pub fn done() {
    let _ = writeln!(std::io::stderr());
}
