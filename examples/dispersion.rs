//! Dispersion of plane waves in every model against the classical wave speeds (Christoffel).
//!
//! ```text
//! cargo run --release --example dispersion [-- --short | --full]
//! ```
//! Graphite–epoxy (a stable and an unstable calibration of it), correspondence with and without
//! control, isotropic models, 2D, m = 3, exact β; waves along 0°, 30°, 45° and 90° from the fibre. For
//! each the phase speed of a long wave against the classical one, and the deviation at a wavelength
//! of ten spacings. The symbol is also held against a run in time: a standing wave in a bar. Pictures
//! of ω(k) go to `out/dispersion/`; a wave that grows ends its curve.

use peridynamics::io::LinePlot;
use peridynamics::models::elasticity::catalogue::{
    GRAPHITE_EPOXY, GRAPHITE_EPOXY_DENSITY as DENSITY, steel,
};
use peridynamics::prelude::*;
use peridynamics::study::{Effort, Outcome, conclude};
use std::f64::consts::{PI, TAU};

const FOLDER: &str = "out/dispersion";
const OMEGA: InfluenceFunction = InfluenceFunction::Gaussian;
const DX: f64 = 1e-3;
const M: f64 = 3.0;

/// What a model's waves are worth.
struct Deviation {
    /// Largest relative error of a long wave's speed.
    long: f64,
    /// The same at a wavelength of ten spacings.
    ten: f64,
    stable: &'static str,
}

fn study<Ma: Material<f64, 2>>(
    name: &str,
    material: &Ma,
    stiffness: &Stiffness<2>,
    points: usize,
) -> Outcome<Deviation> {
    let symbol = Symbol::of(material, DX, Horizon::Cells(M), Quadrature::Exact)?;
    let (mut long, mut ten) = (0.0_f64, 0.0_f64);
    for degrees in [0.0, 30.0, 45.0, 90.0_f64] {
        let direction = SVector::from([degrees.to_radians().cos(), degrees.to_radians().sin()]);
        let waves = stiffness.waves(&direction, DENSITY)?;
        // The symbol's modes come slowest first, the classical ones fastest first.
        let classical = [waves[1].speed, waves[0].speed];
        for (wavelength, worst) in [(1e4, &mut long), (10.0, &mut ten)] {
            let speeds = symbol.phase_speeds(&direction, TAU / (wavelength * DX))?;
            for (got, exact) in speeds.iter().zip(&classical) {
                let error = if got.is_nan() { 1.0 } else { (got / exact - 1.0).abs() };
                *worst = worst.max(error);
            }
        }
        let curves = symbol.dispersion(&direction, points)?;
        let branch = |b: usize| -> Vec<(f64, f64)> {
            let rising = curves.iter().take_while(|(_, omega)| omega[b].is_finite());
            rising.map(|(k, omega)| (k * DX, omega[b] * 1e-6)).collect()
        };
        let line = |speed: f64| -> Vec<(f64, f64)> {
            curves.iter().map(|(k, _)| (k * DX, speed * k * 1e-6)).collect()
        };
        let mut plot = LinePlot::new(
            &format!("{name}, waves at {degrees}°"),
            "k times spacing",
            "frequency [rad/µs]",
        )
        .line("classical, slow", &line(classical[0]))
        .line("classical, fast", &line(classical[1]));
        for (b, title) in [(0, "slow"), (1, "fast")] {
            let points = branch(b);
            if !points.is_empty() {
                plot = plot.line(title, &points);
            }
        }
        let file = name.replace([' ', ',', '–'], "_");
        plot.write(format!("{FOLDER}/{file}_{degrees}.png"))?;
    }
    let stable = match symbol.stability() {
        Stability::Stable(_) => "stable",
        Stability::ZeroEnergy(_) => "zero-energy modes",
        Stability::Unstable(_) => "unstable",
    };
    Ok(Deviation { long, ten, stable })
}

/// Frequency of a wave in a run over the symbol's: u_x ∝ cos kx at rest is a standing wave, whose
/// quarter period is read at the centre of a plate so large that nothing from its outline arrives.
fn standing_wave(stiffness: &Stiffness<2>, cells: usize) -> Outcome<f64> {
    let split = PositiveSplit::plane(stiffness, DENSITY, OMEGA)?;
    let material = Ordinary::linearised(split);
    let k = TAU / (cells as f64 * DX);
    let direction = SVector::from([1.0, 0.0]);
    let symbol = Symbol::of(&material, DX, Horizon::Cells(M), Quadrature::Exact)?;
    let omega = symbol.eigen(&(direction * k))[1].frequency();
    let reach = stiffness.max_wave_speed(DENSITY)? * 0.5 * PI / omega;
    let edge = 2.0 * (reach + 6.0 * M * DX);
    let grid = Grid::new(&Cuboid::centred([edge; 2])?, DX)?;
    let family = Lattice::<f64, 2>::new(&grid, Horizon::Cells(M), Quadrature::Exact)?;
    let mut body = Body::new(family, material, NoDamage)?;
    let centre = grid.nearest(&SVector::zeros());
    let phase = k * grid.position(centre)[0];
    body.set_displacement(|x| direction * (1e-6 * (k * x[0] - phase).cos()));
    let start = body.displacement(centre)[0];
    let mut zero = None;
    let mut before = (0.0, start);
    let mut run = Run::new(&mut body, Loads::new(), TimeStep::Safety(0.02))?;
    run.observe(1, |view: &View<'_, Body<_, 2, _, _, _>>| {
        let now = (view.time, view.body.displacement(centre)[0]);
        if now.1 <= 0.0 {
            let part = before.1 / (before.1 - now.1);
            zero = Some(before.0 + part * (now.0 - before.0));
            return Ok(Flow::Stop);
        }
        before = now;
        Ok(Flow::Continue)
    });
    run.until(PI / omega)?;
    drop(run);
    // cos ωt vanishes first at a quarter of a period.
    let quarter = zero.ok_or("the wave did not swing")?;
    Ok(0.5 * PI / quarter / omega)
}

fn main() -> Outcome {
    let effort = Effort::from_arguments();
    let points = effort.choose(20, 80, 200);
    let ply = Stiffness::<2>::lamina(&GRAPHITE_EPOXY)?;
    let moduli = steel()?;
    let third = Isotropic::from_young_poisson(moduli.young(), 1.0 / 3.0)?;
    let mode = PlaneMode::PlaneStress;
    let (plate, own) =
        (Stiffness::<2>::isotropic(&moduli, mode)?, Stiffness::<2>::isotropic(&third, mode)?);
    let correspondence = Correspondence::new(LinearElastic(ply), DENSITY, OMEGA)?;
    let controlled = correspondence.clone().with_control(WanControl::new(&ply, 1.0)?);
    let split = Ordinary::new(PositiveSplit::plane(&ply, DENSITY, OMEGA)?);
    let polynomial = Ordinary::new(PolynomialMicromoduli::plane(&ply, DENSITY, OMEGA)?);
    let lps = Ordinary::new(LinearSolid::plane(&moduli, mode, DENSITY, OMEGA)?);
    let pmb = Pmb::plane(&third, mode, DENSITY, OMEGA)?;
    let rows = [
        ("positive split", study("positive split", &split, &ply, points)?, 1e-6),
        ("polynomial", study("polynomial", &polynomial, &ply, points)?, f64::INFINITY),
        ("correspondence", study("correspondence", &correspondence, &ply, points)?, 1e-6),
        ("Wan control", study("Wan control", &controlled, &ply, points)?, 1e-5),
        ("linear solid", study("linear solid", &lps, &plate, points)?, 0.02),
        ("PMB", study("PMB", &Ordinary::new(pmb.clone()), &own, points)?, 0.06),
        (
            "PMB on family",
            study("PMB on family", &Ordinary::new(pmb.on_family()), &own, points)?,
            0.06,
        ),
    ];
    let title = "Dispersion against Christoffel";
    let mut table = Measures::new(title, &effort.command("dispersion"));
    for (name, Deviation { long, ten, stable }, limit) in &rows {
        let what = format!("{name}: speed of long waves, error");
        if limit.is_finite() {
            table.hard_most(&what, *long, *limit);
        } else {
            table.told(&what, *long);
        }
        let ten = format!("{:.0} %; {stable}", ten * 1e2);
        table.told_in_words(&format!("{name}: at ten spacings"), "–", &ten);
    }
    for cells in effort.choose(vec![12], vec![12, 24], vec![8, 12, 24, 48]) {
        let ratio = standing_wave(&ply, cells)?;
        let name = format!("a run against the symbol, wavelength of {cells} spacings");
        table.hard_most(&name, (ratio - 1.0).abs(), 1e-3);
    }
    Ok(conclude(&table, effort, FOLDER, &[])?)
}
