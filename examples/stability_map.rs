//! Where the anisotropic calibrations are stable: the smallest eigenvalue of the lattice symbol.
//!
//! ```text
//! cargo run --release --example stability_map [-- --short | --full]
//! ```
//! Plies of the papers × fibre angle × m × influence function (2D plane stress, exact β, linearised):
//! the smallest ρω² over the Brillouin zone outside long waves, in GPa/Δx², and its share of the
//! largest one. Negative: that plane wave grows exponentially in a run and makes statics indefinite.
//! Compared with the figures of an independent code (β = 1); one picture per m goes to
//! `out/stability_map/`, a table of all cases to `out/stability_map/map.csv`.

use peridynamics::core::symbol::Extremes;
use peridynamics::io::{ColourMap, FieldMap, LinePlot};
use peridynamics::models::ScalarState;
use peridynamics::models::elasticity::catalogue::{
    GLASS_EPOXY, GRAPHITE_EPOXY, GRAPHITE_FABRIC_CARBON, HTA_6376,
};
use peridynamics::prelude::*;
use peridynamics::study::{Effort, Outcome, conclude};
use std::fmt::Write as _;

const FOLDER: &str = "out/stability_map";
const MATERIALS: [(&str, Lamina); 4] = [
    ("graphite fabric", GRAPHITE_FABRIC_CARBON),
    ("graphite-epoxy", GRAPHITE_EPOXY),
    ("HTA/6376", HTA_6376),
    ("glass-epoxy", GLASS_EPOXY),
];
const INFLUENCES: [(&str, InfluenceFunction); 3] = [
    ("constant", InfluenceFunction::Constant),
    ("Gaussian", InfluenceFunction::Gaussian),
    ("linear", InfluenceFunction::Linear),
];
const DENSITY: f64 = 1e3;

fn extremes(
    model: impl ScalarState<f64, 2>,
    m: f64,
    beta: Quadrature,
    samples: usize,
) -> Outcome<Extremes<2>> {
    let material = Ordinary::linearised(model);
    let symbol = Symbol::of(&material, 1.0, Horizon::Cells(m), beta)?;
    Ok(symbol.extremes(samples))
}

/// Both calibrations: (polynomial, positive split).
fn both(
    ply: &Lamina,
    degrees: f64,
    m: f64,
    influence: InfluenceFunction,
    beta: Quadrature,
    samples: usize,
) -> Outcome<[Extremes<2>; 2]> {
    let c = Stiffness::<2>::lamina(ply)?.rotated(degrees.to_radians());
    Ok([
        extremes(PolynomialMicromoduli::plane(&c, DENSITY, influence)?, m, beta, samples)?,
        extremes(PositiveSplit::plane(&c, DENSITY, influence)?, m, beta, samples)?,
    ])
}

/// ρω² of the softest wave in GPa/Δx², and its share of the stiffest.
fn softest(e: &Extremes<2>) -> (f64, f64) {
    let value = e.softest.eigenvalue;
    (value * DENSITY / 1e9, value / e.stiffest.eigenvalue)
}

fn main() -> Outcome {
    let effort = Effort::from_arguments();
    let samples = effort.choose(24, 60, 120);
    let step = effort.choose(45, 15, 5);
    let ratios: &[f64] = effort.choose(&[3.0], &[2.0, 3.0, 5.0], &[2.0, 3.0, 4.0, 5.0, 6.0]);
    let angles: Vec<f64> = (0..=90).step_by(step).map(f64::from).collect();

    let title = "When the polynomial micromoduli are stable";
    let mut table = Measures::new(title, &effort.command("stability_map"));
    // Figures of the independent code: (material, angle, m, influence, GPa/Δx²).
    for (material, degrees, m, influence, reference) in [
        (0, 0.0, 3.0, 1, -24.9),
        (0, 0.0, 3.0, 2, -42.6),
        (0, 0.0, 5.0, 1, -4.4),
        (0, 45.0, 3.0, 1, -2.8),
        (0, 45.0, 3.0, 2, -7.9),
        (1, 0.0, 3.0, 1, -19.5),
        (1, 0.0, 3.0, 2, -31.9),
        (2, 0.0, 3.0, 1, -17.9),
        (2, 45.0, 3.0, 2, -14.9),
    ] {
        let (name, ply) = &MATERIALS[material];
        let (title, influence) = INFLUENCES[influence];
        let [polynomial, _] = both(ply, degrees, m, influence, Quadrature::None, samples.max(60))?;
        let what = format!("{name}, {degrees}°, m = {m}, {title}, β = 1: softest ρω² [GPa/Δx²]");
        let tolerance = 0.06 + 0.005 * f64::abs(reference);
        table.hard_near(&what, softest(&polynomial).0, reference, tolerance);
    }

    let mut csv = String::from(
        "material,angle [deg],m,influence,polynomial [GPa/dx^2],share,split [GPa/dx^2],share,\
         time step ratio\n",
    );
    let (mut unstable, mut total, mut worst_split, mut longest) = (0, 0, f64::INFINITY, 0.0_f64);
    let mut glass = f64::INFINITY;
    for &m in ratios {
        let mut lines = LinePlot::new(
            &format!("softest over stiffest wave, m = {m}, Gaussian"),
            "fibre angle [°]",
            "share",
        );
        // One column per angle; rows: materials within influence functions, and both calibrations.
        let (mut cells, mut values) = (Vec::new(), Vec::new());
        for (row, (name, ply)) in MATERIALS.iter().enumerate() {
            for (block, (title, influence)) in INFLUENCES.iter().enumerate() {
                let mut curves = [Vec::new(), Vec::new()];
                for (column, &degrees) in angles.iter().enumerate() {
                    let pair = both(ply, degrees, m, *influence, Quadrature::Exact, samples)?;
                    let [polynomial, split] = [softest(&pair[0]), softest(&pair[1])];
                    total += 1;
                    unstable += usize::from(polynomial.1 < -1e-9);
                    worst_split = worst_split.min(split.1);
                    if row == 3 && m >= 3.0 {
                        glass = glass.min(polynomial.1);
                    }
                    let gain = (pair[0].stiffest.eigenvalue / pair[1].stiffest.eigenvalue).sqrt();
                    longest = longest.max(gain);
                    writeln!(
                        csv,
                        "{name},{degrees},{m},{title},{:.4e},{:.4e},{:.4e},{:.4e},{gain:.3}",
                        polynomial.0, polynomial.1, split.0, split.1
                    )?;
                    for (side, value) in [polynomial.1, split.1].into_iter().enumerate() {
                        let x = (column + side * (angles.len() + 1)) as f64;
                        let y = -((row + block * (MATERIALS.len() + 1)) as f64);
                        cells.push(SVector::from([x, y]));
                        values.push(value.clamp(-0.1, 0.1));
                        curves[side].push((degrees, value));
                    }
                }
                if block == 1 {
                    lines = lines.line(&format!("{name}, polynomial"), &curves[0]);
                    lines = lines.line(&format!("{name}, split"), &curves[1]);
                }
            }
        }
        lines.write(format!("{FOLDER}/softest_m{m}.png"))?;
        FieldMap::new(&cells, 1.0, &values)
            .title(&format!("m = {m}: polynomial | positive split"))
            .range(-0.1, 0.1)
            .colours(ColourMap::Diverging)
            .write(format!("{FOLDER}/map_m{m}.png"))?;
    }
    std::fs::write(format!("{FOLDER}/map.csv"), csv)?;
    println!("maps: angle to the right; down: constant, Gaussian, linear influence, in each the");
    println!("graphite fabric, graphite-epoxy, HTA/6376, glass-epoxy; share clipped at ±0.1");
    let cases = format!("{unstable} of {total}");
    table.told_in_words("cases in which the polynomial micromoduli are unstable", "–", &cases);
    let name = "glass–epoxy, m ≥ 3, polynomial: smallest share of the softest in the stiffest wave";
    table.hard_least(name, glass, 0.0);
    table.hard_least("positive split, all cases: smallest share", worst_split, 0.0);
    table.told("largest time step of the split over that of the polynomial", longest);
    Ok(conclude(&table, effort, FOLDER, &[])?)
}
