//! How the positive split should share stiffness between single bonds and the nonlocal strain: a
//! small search over k₀⟨n⟩ ∝ 1 + r (n·f)⁴ along the fibre f.
//!
//! ```text
//! cargo run --release --example split_direction [-- --short | --full]
//! ```
//! Plies of the papers, 2D, m = 3, Gaussian influence, exact β, fibres at 0° and 30°. Every r has the
//! same stiffness and is stable; they differ in how short waves travel and in the time step. Printed
//! per ply: rms error of the phase speeds at wavelengths of 8 to 20 spacings over all directions, the
//! stable time step and the softest wave, relative to r = 0; and for the best r. Then the path of a
//! crack: a plate of HTA/6376 with a centre crack is pulled as in `cfrp_centre_crack`, by Tsai–Hill
//! on the nonlocal strain with bridging fibres. Pictures go to `out/split_direction/`.

use peridynamics::damage::crack_path::{fit_line, without_ends};
use peridynamics::io::LinePlot;
use peridynamics::models::elasticity::catalogue::{
    GLASS_EPOXY, GRAPHITE_EPOXY, GRAPHITE_FABRIC_CARBON, HTA_6376, HTA_6376_DENSITY,
    HTA_6376_STRENGTHS,
};
use peridynamics::prelude::*;
use peridynamics::study::{Effort, Outcome, conclude, damage, draw_damage};
use std::f64::consts::{PI, TAU};

const FOLDER: &str = "out/split_direction";
const DENSITY: f64 = 1e3;

struct Waves {
    error: f64,
    time_step: f64,
    softest: f64,
}

fn waves(ply: &Lamina, degrees: f64, r: f64, samples: usize) -> Outcome<Waves> {
    let angle = degrees.to_radians();
    let stiffness = Stiffness::<2>::lamina(ply)?.rotated(angle);
    let split = PositiveSplit::plane(&stiffness, DENSITY, InfluenceFunction::Gaussian)?
        .with_fibre([angle.cos(), angle.sin()], r)?;
    let material = Ordinary::linearised(split);
    let symbol = Symbol::of(&material, 1.0, Horizon::Cells(3.0), Quadrature::Exact)?;
    let (mut sum, mut count) = (0.0, 0.0);
    for k in 0..36 {
        let phi = PI * f64::from(k) / 36.0;
        let direction = SVector::from([phi.cos(), phi.sin()]);
        let classical = stiffness.waves(&direction, DENSITY)?;
        for wavelength in [8.0, 12.0, 20.0] {
            let speeds = symbol.phase_speeds(&direction, TAU / wavelength)?;
            for (got, exact) in speeds.iter().zip(classical.iter().rev()) {
                sum += (got / exact.speed - 1.0).powi(2);
                count += 1.0;
            }
        }
    }
    let extremes = symbol.extremes(samples);
    Ok(Waves {
        error: f64::sqrt(sum / count),
        time_step: extremes.critical_time_step(),
        softest: extremes.softest.eigenvalue / extremes.stiffest.eigenvalue,
    })
}

/// A composite plate, 125 × 250 mm with a centre crack of 25 mm, by a split with bonds along the
/// fibre: angle between the crack and the fibres when it has grown 15 mm or the plate fails by itself,
/// in degrees, and growth in mm.
fn crack(degrees: f64, r: f64, across: f64) -> Outcome<(f64, f64)> {
    let (angle, size) = (degrees.to_radians(), [0.125, 0.25]);
    let (dx, half) = (size[0] / across, 0.0125);
    let stiffness = Stiffness::<2>::lamina(&HTA_6376)?.rotated(angle);
    let gaussian = InfluenceFunction::Gaussian;
    let split = PositiveSplit::plane(&stiffness, HTA_6376_DENSITY, gaussian)?
        .with_fibre([angle.cos(), angle.sin()], r)?;
    let material = Ordinary::linearised(Strained::plane(split, &stiffness, gaussian));
    let [along, cross, shear] = HTA_6376_STRENGTHS;
    let strengths = Strengths { along, across: cross, shear };
    let criterion = TsaiHill::new(&strengths, angle)?.with_bridging_fibres();
    let grid = Grid::new(&Cuboid::centred(size)?, dx)?;
    let family = Lattice::<f64, 2>::new(&grid, Horizon::Cells(3.0), Quadrature::Exact)?;
    let notch = Segment::new([-half, 0.0], [half, 0.0])?;
    let mut body = Body::new(family, material, Breaking::new(criterion).precracked(notch))?;
    body.set_velocity(|x| [0.0, 50.0 * x[1] / size[1]].into());
    let start = damage(&body);
    let tip = SVector::from([half, 0.0]);
    let mut run = Run::new(&mut body, Loads::new(), TimeStep::Safety(0.4))?;
    let mut path = CrackPath::of(run.body(), &start);
    // The undisturbed plate fails at 38.5 µs for fibres at 45°.
    while run.time() < 38.5e-6 && path.growth(&tip) < 0.015 {
        run.steps_more(2)?;
        path = CrackPath::of(run.body(), &start);
    }
    drop(run);
    let title = format!("r = {r}: damage");
    let file = format!("{FOLDER}/crack_{r}.png");
    draw_damage(&body, (5.0, [0, 1]), |_| true, &title, file)?;
    let corner = SVector::from(size) * 0.5;
    let nodes = without_ends(&path.at_tip(&tip), &tip, (&-corner, &corner), dx);
    let line = fit_line(&nodes).map_or(f64::NAN, |line| line.angle.to_degrees());
    let off = (line - degrees).rem_euclid(180.0);
    Ok((off.min(180.0 - off), path.growth(&tip) * 1e3))
}

fn main() -> Outcome {
    let effort = Effort::from_arguments();
    let samples = effort.choose(24, 48, 120);
    let ratios: Vec<f64> = effort.choose(
        vec![0.0, 4.0],
        vec![0.0, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0],
        vec![0.0, 0.5, 1.0, 2.0, 3.0, 4.0, 6.0, 8.0, 12.0, 16.0, 24.0, 32.0, 64.0],
    );
    let plies = [
        ("graphite fabric", GRAPHITE_FABRIC_CARBON),
        ("graphite-epoxy", GRAPHITE_EPOXY),
        ("HTA/6376", HTA_6376),
        ("glass-epoxy", GLASS_EPOXY),
    ];
    let mut errors = LinePlot::new("rms error of phase speeds", "r", "relative");
    let mut steps = LinePlot::new("time step over that at r = 0", "r", "ratio");
    let mut worst = f64::INFINITY;
    let title = "What bonds along the fibre buy the positive split";
    let mut table = Measures::new(title, &effort.command("split_direction"));
    for (name, ply) in &plies {
        for degrees in [0.0, 30.0] {
            let all = ratios.iter().map(|&r| waves(ply, degrees, r, samples));
            let all: Vec<Waves> = all.collect::<Outcome<_>>()?;
            let best = (0..all.len()).min_by(|&a, &b| all[a].error.total_cmp(&all[b].error));
            let best = best.unwrap_or(0);
            let step = all[best].time_step / all[0].time_step;
            table.told_in_words(
                &format!("{name}, {degrees}°: rms error of phase speeds at r = 0 and the best r"),
                "–",
                &format!(
                    "{:.1} %; r = {}: {:.1} %, time step {step:.2}",
                    all[0].error * 1e2,
                    ratios[best],
                    all[best].error * 1e2
                ),
            );
            worst = all.iter().map(|w| w.softest).fold(worst, f64::min);
            let label = format!("{name} {degrees}°");
            let curve = |value: &dyn Fn(&Waves) -> f64| -> Vec<(f64, f64)> {
                ratios.iter().copied().zip(all.iter().map(value)).collect()
            };
            errors = errors.line(&label, &curve(&|w| w.error));
            steps = steps.line(&label, &curve(&|w| w.time_step / all[0].time_step));
        }
    }
    table.hard_least("every r is stable: smallest share of the softest wave", worst, 0.0);
    for r in [0.0, 8.0, 32.0] {
        let (off, growth) = crack(45.0, r, effort.choose(50.0, 150.0, 300.0))?;
        let name = format!("crack in HTA/6376, fibres at 45°, r = {r}: off the fibres [°]");
        table.told_in_words(&name, "–", &format!("{off:.0}, {growth:.1} mm long"));
    }
    errors.write(format!("{FOLDER}/error.png"))?;
    steps.write(format!("{FOLDER}/time_step.png"))?;
    Ok(conclude(&table, effort, FOLDER, &[])?)
}
