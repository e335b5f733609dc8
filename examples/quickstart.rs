//! An elastic wave in a bar against d'Alembert: a Gaussian pulse of displacement splits in two
//! halves that run apart at c = √(E/ρ) (ν = 0). The positive split has the right energy at surface
//! nodes too, so a thin bar is no problem for it.
//!
//! `cargo run --release --example quickstart`

use peridynamics::io::LinePlot;
use peridynamics::prelude::*;

fn main() -> std::result::Result<(), Box<dyn std::error::Error>> {
    let (length, dx, density) = (1.0, 1.0 / 400.0, 1000.0);
    let grid = Grid::new(&Cuboid::centred([length, 12.0 * dx])?, dx)?;
    let moduli = Isotropic::from_young_poisson(1e9, 0.0)?;
    let stiffness = Stiffness::<2>::isotropic(&moduli, PlaneMode::PlaneStrain)?;
    let solid = PositiveSplit::plane(&stiffness, density, InfluenceFunction::Gaussian)?;
    let family = Lattice::<f64, 2>::new(&grid, Horizon::Cells(3.0), Quadrature::Exact)?;
    let mut body = Body::new(family, Ordinary::linearised(solid), NoDamage)?;

    let pulse = |x: f64| 1e-4 * (-(x / 0.05).powi(2)).exp();
    body.set_displacement(|x| [pulse(x[0]), 0.0].into());
    let c = (moduli.young() / density).sqrt();
    let mut run = Run::new(&mut body, Loads::new(), TimeStep::Safety(0.9))?;
    run.until(0.3 * length / c)?;

    let (travelled, row) = (c * run.time(), grid.cells()[1] / 2);
    let (mut wave, mut exact, mut error) = (Vec::new(), Vec::new(), 0.0_f64);
    for node in (0..grid.cells()[0]).filter_map(|i| grid.node([i, row])) {
        let (x, u) = (grid.position(node)[0], run.body().displacement(node)[0]);
        let dalembert = 0.5 * (pulse(x - travelled) + pulse(x + travelled));
        error = error.max((u - dalembert).abs() / 1e-4);
        wave.push((x, u));
        exact.push((x, dalembert));
    }
    println!("{} nodes, {} steps of {:.2e} s", grid.len(), run.steps(), run.dt());
    println!("largest difference to d'Alembert: {:.2} % of the pulse", 100.0 * error);
    LinePlot::new("Wave in a bar", "x [m]", "u [m]")
        .line("d'Alembert", &exact)
        .line("peridynamics", &wave)
        .write("out/quickstart/wave.png")?;
    println!("out/quickstart/wave.png");
    Ok(())
}
