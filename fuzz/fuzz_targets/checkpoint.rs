//! Any bytes as a checkpoint file, and as the state inside of one: refused or taken, never a panic,
//! and what is taken can run on without numbers that are not finite being written.
#![no_main]

use libfuzzer_sys::fuzz_target;
use peridynamics::io::checkpoint::state_in;
use peridynamics::prelude::*;

fn body() -> Body<f32, 2, Lattice<f32, 2>, Ordinary<Pmb>, Breaking<CriticalStretch, 2>> {
    let grid = Grid::new(&Cuboid::centred([5e-3, 4e-3]).expect("box"), 1e-3).expect("grid");
    let moduli = Isotropic::from_young_poisson(70e9, 1.0 / 3.0).expect("moduli");
    let linear = InfluenceFunction::Linear;
    let law = Pmb::plane(&moduli, PlaneMode::PlaneStress, 2500.0, linear).expect("law");
    let family = Lattice::new(&grid, Horizon::Cells(1.5), Quadrature::None).expect("family");
    let criterion = CriticalStretch::new(1e-3).expect("criterion");
    Body::new(family, Ordinary::new(law), Breaking::new(criterion)).expect("body")
}

fuzz_target!(|bytes: &[u8]| {
    let state = state_in(bytes).map_or(bytes, |place| &bytes[place]);
    let mut body = body();
    let mut run = Run::new(&mut body, Loads::new(), TimeStep::Unchecked(1e-8)).expect("run");
    if run.resume(state).is_ok() {
        run.keep(1, |kept| {
            let mut out = Vec::new();
            kept.write(&mut out).expect("memory");
            Ok(String::new())
        });
        let _ = run.steps_more(20);
    }
});
