//! A run that may be stopped at any moment and goes on as if nothing had happened: a glass plate
//! with an edge crack is pulled apart.
//!
//! ```text
//! cargo run --release --example checkpoint [-- --short]
//! ```
//! Press Ctrl-C while it runs (or kill it) and start it again: it goes on from its last checkpoint,
//! and pictures, history and ParaView series are those of a run that was never stopped. When it is
//! over it removes the checkpoint.

use peridynamics::checkpoint::Checkpoint;
use peridynamics::observe::{FieldOutput, Progress, Table, snapshot};
use peridynamics::prelude::*;
use peridynamics::study::{Effort, draw_damage};
use std::path::Path;

type Plate = Body<f64, 2, Lattice<f64, 2>, Ordinary<Pmb>, Breaking<CriticalStretch, 2>>;

fn main() -> std::result::Result<(), Box<dyn std::error::Error>> {
    let effort = Effort::from_arguments();
    let across = effort.choose(60.0, 400.0, 800.0);
    let (size, glass) = (0.1, Isotropic::from_young_poisson(65e9, 1.0 / 3.0)?);
    let grid = Grid::new(&Cuboid::centred([size, size])?, size / across)?;
    let constant = InfluenceFunction::Constant;
    let law = Pmb::plane(&glass, PlaneMode::PlaneStress, 2235.0, constant)?;
    let policy = Breaking::new(CriticalStretch::new(2e-3)?)
        .precracked(Segment::new([-0.51 * size, 0.0], [-0.25 * size, 0.0])?);
    let family = Lattice::<f64, 2>::new(&grid, Horizon::Cells(3.015), Quadrature::None)?;
    let mut body = Body::new(family, Ordinary::new(law), policy)?;
    let (low, high) = (-0.48 * size, 0.48 * size);
    let loads = Loads::new().velocity(&grid.select(|x| x[1] < low), 1, -0.5).velocity(
        &grid.select(|x| x[1] > high),
        1,
        2.0,
    );

    // A state is that of its own grid.
    let folder = effort.choose("out/checkpoint_short", "out/checkpoint", "out/checkpoint_full");
    let folder = Path::new(folder);
    let checkpoint = Checkpoint::new(folder.join("plate.state"));
    let mut run = Run::new(&mut body, loads, TimeStep::Safety(0.8))?;
    let last = checkpoint.resume(&mut run)?;
    match last {
        Some(time) => println!("going on from step {}, t = {time:e} s", run.steps()),
        None => println!("from the start; press Ctrl-C to stop, start again to go on"),
    }
    run.observe(20, Progress::new("plate"));
    run.observe(
        20,
        Table::new(folder.join("history.csv"))
            .resume(last)
            .column("broken bonds", |view: &View<'_, Plate>| view.body.broken_bonds() as f64)
            .column("kinetic energy [J/m]", |view| {
                peridynamics::core::run::kinetic_energy(view.body)
            }),
    );
    run.observe(200, FieldOutput::resume(folder, "plate", snapshot::<f64, 2, _, _, _>, last)?);
    checkpoint.keep(&mut run, 200)?;
    if let Err(error) = run.until(150e-6) {
        // In words: what happened, and from where a run goes on.
        return Err(error.to_string().into());
    }
    drop(run);
    checkpoint.remove()?;
    println!("{}; pictures and histories are in {}", Margin::of(&body), folder.display());
    draw_damage(&body, (1.0, [0, 1]), |_| true, "damage", folder.join("damage.png"))?;
    Ok(())
}
