//! m-, δ- and δm-convergence of the anisotropic models to the local solution, in statics.
//!
//! ```text
//! cargo run --release --example convergence [-- --short | --full]
//! ```
//! A smooth displacement, one wave across the body, is prescribed in a collar of two horizons around
//! a 0.1 m square of glass–epoxy with fibres at 40°; inside act the body forces −div C:ε that a
//! classical solid needs for it. Error: largest difference over the largest displacement. The
//! pictures of error over spacing go to `out/convergence/`.
//!
//! `--short` stops early in each series, `--full` goes a step further and adds 3D.

use peridynamics::core::convergence::{
    Measured, Resolution, Row, Study, delta_convergence, delta_m_convergence, m_convergence,
};
use peridynamics::io::LinePlot;
use peridynamics::models::elasticity::catalogue::{GLASS_EPOXY, pps_carbon};
use peridynamics::prelude::*;
use peridynamics::study::{Effort, Outcome, conclude};
use std::f64::consts::TAU;

const FOLDER: &str = "out/convergence";
const EDGE: f64 = 0.1;
const OMEGA: InfluenceFunction = InfluenceFunction::Gaussian;

/// u = a sin(k·x), with one wave across the edge along the first axis and half of one along the
/// others.
struct Wave<const D: usize> {
    k: SVector<f64, D>,
    a: SVector<f64, D>,
}

impl<const D: usize> Wave<D> {
    fn new() -> Self {
        let waves = SVector::<f64, D>::from_fn(|d, _| [1.0, 0.5, -0.5][d]);
        let a = SVector::from_fn(|d, _| [1e-5, -0.6e-5, 0.4e-5][d]);
        Self { k: waves * (TAU / EDGE), a }
    }
    fn u(&self, x: &SVector<f64, D>) -> SVector<f64, D> {
        self.a * self.k.dot(x).sin()
    }
    /// −C_ijkl ∂_j ∂_l u_k = C_ijkl k_j k_l u_k.
    fn force(&self, c: &Stiffness<D>, x: &SVector<f64, D>) -> SVector<f64, D> {
        let u = self.u(x);
        SVector::from_fn(|i, _| {
            let mut sum = 0.0;
            for j in 0..D {
                for k in 0..D {
                    for l in 0..D {
                        sum += c.c(i, j, k, l) * self.k[j] * self.k[l] * u[k];
                    }
                }
            }
            sum
        })
    }
}

fn measure<const D: usize, M: Material<f64, D>>(
    material: M,
    stiffness: &Stiffness<D>,
    resolution: Resolution,
) -> Outcome<Measured> {
    let (wave, dx) = (Wave::<D>::new(), resolution.spacing);
    let inside = (EDGE / dx).round();
    // Forces reach two horizons and the corner of a cell.
    let collar = 2.0 * (resolution.ratio + 1.0).ceil();
    let grid = Grid::new(&Cuboid::centred([(inside + 2.0 * collar) * dx; D])?, dx)?;
    let horizon = Horizon::Cells(resolution.ratio);
    let family = Lattice::<f64, D>::new(&grid, horizon, Quadrature::Exact)?;
    let mut body = Body::new(family, material, NoDamage)?;
    let mut loads = Loads::new();
    let edge = 0.5 * inside * dx;
    let mut nodes = 0;
    for node in 0..grid.len() {
        let x = grid.position(node);
        let one = NodeSet::from_nodes([node], grid.len())?;
        let held = x.iter().any(|x| x.abs() > edge);
        nodes += usize::from(!held);
        let value = if held { wave.u(&x) } else { wave.force(stiffness, &x) };
        for axis in 0..D {
            loads = if held {
                loads.displacement(&one, axis, value[axis])
            } else {
                loads.body_force(&one, axis, value[axis])
            };
        }
    }
    Statics::new().solve(&mut body, loads)?;
    let apart = (0..grid.len()).map(|i| (body.displacement(i) - wave.u(&grid.position(i))).norm());
    Ok(Measured { error: apart.fold(0.0, f64::max) / wave.a.norm(), nodes })
}

fn main() -> Outcome {
    let effort = Effort::from_arguments();
    let stiffness = Stiffness::<2>::lamina(&GLASS_EPOXY)?.rotated(40_f64.to_radians());
    let polynomial = Ordinary::linearised(PolynomialMicromoduli::plane(&stiffness, 1e3, OMEGA)?);
    let split = Ordinary::linearised(PositiveSplit::plane(&stiffness, 1e3, OMEGA)?);
    let control = WanControl::new(&stiffness, 1.0)?;
    let law = LinearElastic(stiffness);
    let correspondence = Correspondence::new(law, 1e3, OMEGA)?.with_control(control);
    let run = |members: &[Resolution]| -> Outcome<[(&str, Study); 3]> {
        Ok([
            ("polynomial", Study::run(members, |r| measure(&polynomial, &stiffness, r))?),
            ("positive split", Study::run(members, |r| measure(&split, &stiffness, r))?),
            ("correspondence", Study::run(members, |r| measure(&correspondence, &stiffness, r))?),
        ])
    };
    let n = effort.choose(2, 3, 4);
    let spacings: Vec<f64> = [20.0, 40.0, 80.0, 160.0][..n].iter().map(|n| EDGE / n).collect();
    let delta = delta_convergence(3.0, &spacings)?;
    let m = m_convergence(EDGE / 10.0, &[3.0, 4.0, 5.0, 6.0, 8.0][..n + 1])?;
    let delta_m = delta_m_convergence(EDGE / 10.0, &[3.0, 4.0, 5.0, 6.0, 7.0][..n + 1], 1.0)?;
    let title = "Convergence to the local solution";
    let mut table = Measures::new(title, &effort.command("convergence"));
    for (name, members) in [
        ("δ-convergence (m = 3)", delta),
        ("m-convergence (δ = 10 mm)", m),
        ("δm-convergence", delta_m),
    ] {
        let studies = run(&members)?;
        let kind = name.split(' ').next().unwrap_or(name).replace('δ', "delta");
        let mut plot = LinePlot::new(&kind, "spacing [m]", "error").log_log();
        for (material, study) in &studies {
            println!("{name}, {material}\n{study}");
            let points = study.rows.iter().map(|r| (r.resolution.spacing, r.measured.error));
            plot = plot.line(material, &points.collect::<Vec<_>>());
            let errors: Vec<_> =
                study.rows.iter().map(|row| format!("{:.1e}", row.measured.error)).collect();
            table.told_in_words(&format!("{name}, {material}: errors"), "–", &errors.join("; "));
        }
        plot.write(format!("{FOLDER}/{kind}.png"))?;
        let [polynomial, split, correspondence] = studies.map(|(_, study)| study.rows);
        let order = |rows: &[Row]| rows.last().and_then(|row| row.order).unwrap_or(f64::NAN);
        let last = |rows: &[Row]| rows.last().map_or(f64::NAN, |row| row.measured.error);
        match kind.as_str() {
            // The quadrature keeps the polynomial's stiffness wrong by the same share.
            "delta-convergence" => {
                let tolerance = effort.choose(0.3, 0.15, 0.15);
                let name = |what: &str| format!("{name}: last order of {what}");
                table.hard_near(&name("the positive split"), order(&split), 2.0, tolerance);
                table.hard_near(&name("correspondence"), order(&correspondence), 2.0, tolerance);
                table.told(&name("the polynomial"), order(&polynomial));
            }
            "m-convergence" => {
                let name =
                    "m-convergence: the polynomial's error over the split's at the largest m";
                table.hard_most(name, last(&polynomial) / last(&split), 2.0);
            }
            _ => {
                let name = "δm-convergence: the polynomial's last error over its first";
                table.hard_most(name, last(&polynomial) / polynomial[0].measured.error, 0.5);
            }
        }
    }
    if effort == Effort::Full {
        let stiffness = pps_carbon()?.rotated_about_z(30_f64.to_radians());
        let split = Ordinary::linearised(PositiveSplit::solid(&stiffness, 1e3, OMEGA)?);
        let spacings = [EDGE / 10.0, EDGE / 20.0, EDGE / 40.0];
        let study =
            Study::run(&delta_convergence(2.0, &spacings)?, |r| measure(&split, &stiffness, r))?;
        println!("δ-convergence in 3D (m = 2), positive split\n{study}");
        let name = "δ-convergence in 3D (m = 2): order of the positive split";
        table.hard_near(name, study.order().unwrap_or(f64::NAN), 2.0, 0.3);
    }
    Ok(conclude(&table, effort, FOLDER, &[])?)
}
