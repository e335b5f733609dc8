//! The front of what moves at all in a run. Each evaluation of forces carries a push one horizon on, or
//! two where forces come from node states: many times as fast as waves, whose step is a part of the
//! spacing. Parts ahead of it could be left out without a change in any bit, but are gone after the
//! first few steps of a scene; parts ahead of the *wave* hold numbers too, if small ones.
use peridynamics::prelude::*;

/// So few that what goes ahead does not underflow.
const CELLS: usize = 200;

/// Columns that the push on the first column has reached after each step of a run, in `f64`.
fn reached<M: Material<f64, 2>>(material: M) -> Vec<usize> {
    let grid = Grid::new(&Cuboid::new([0.0; 2], [CELLS as f64, 6.0]).expect("bar"), 1.0);
    let grid = grid.expect("grid");
    let family = Lattice::<f64, 2>::new(&grid, Horizon::Cells(3.0), Quadrature::None);
    let mut body = Body::new(family.expect("family"), material, NoDamage).expect("body");
    let loads = Loads::new().velocity(&grid.select(|x| x[0] < 1.0), 0, 1e-3);
    let mut run = Run::new(&mut body, loads, TimeStep::Safety(0.8)).expect("run");
    let mut fronts = Vec::new();
    while fronts.last().is_none_or(|&front| front < CELLS) {
        run.steps_more(1).expect("step");
        let moves = |i: &usize| run.body().displacement(*i) != SVector::<f64, 2>::zeros();
        let farthest = (0..grid.len()).filter(moves).map(|i| grid.position(i)[0]);
        fronts.push(farthest.fold(0.0, f64::max).ceil() as usize);
    }
    fronts
}

#[test]
fn what_moves_runs_ahead_of_every_wave() {
    let [bonds, dilating] =
        [1.0 / 3.0, 0.2].map(|nu| Isotropic::from_young_poisson(7e10, nu).expect("moduli"));
    let (mode, omega) = (PlaneMode::PlaneStress, InfluenceFunction::Constant);
    let pmb = Pmb::plane(&bonds, mode, 2500.0, omega).expect("material");
    let solid = LinearSolid::plane(&dilating, mode, 2500.0, omega).expect("material");
    for (fronts, step) in [(reached(Ordinary::new(pmb)), 3), (reached(Ordinary::new(solid)), 6)] {
        let far = fronts.iter().position(|&front| front == CELLS).expect("arrives") + 1;
        println!("{far} steps across {CELLS} columns");
        assert!(far.abs_diff(CELLS / step) <= 2, "{far} steps: not {step} columns each");
    }
}
