//! Plane waves travel at the speed of the lattice symbol, in space and time, near the corner of
//! the Brillouin zone too.
//!
//! A body is finite, but what its surface does needs time: a force reaches two horizons (bonds,
//! and the states at their ends), so after n steps a node knows nothing that was farther than 2nm
//! cells. In a body wider than that the middle moves exactly as in the infinite lattice, and the
//! only tolerance left is rounding.
use crate::common;
use peridynamics::models::elasticity::catalogue::{GLASS_EPOXY, HTA_6376, steel};
use peridynamics::models::{Linearised, ScalarState};
use peridynamics::prelude::*;

const DX: f64 = 1e-3;
/// Amplitude of the waves in metres.
const SIZE: f64 = 1e-7 * DX;

/// A wave u = p cos(k·x − ωt) is let go in a body of linear material; its phase and amplitude in
/// the middle are those of the symbol's wave, with the frequency of velocity Verlet,
/// sin(ω'Δt/2) = ωΔt/2. `phases` are k Δx.
fn travels<const D: usize, M: Material<f64, D>>(
    name: &str,
    material: &M,
    (m, steps): (f64, usize),
    phases: &[[f64; D]],
    tolerance: f64,
) {
    let horizon = Horizon::Cells(m);
    let symbol = Symbol::of(material, DX, horizon, Quadrature::None).expect("symbol");
    // Two horizons a step, and a patch of 3^D nodes to read the phase from.
    let half = 2 * m.floor() as usize * steps + 1;
    let spacing = SVector::repeat(DX);
    let grid = Grid::lattice(-spacing * half as f64, spacing, [2 * half + 1; D]).expect("grid");
    let family = Lattice::<f64, D>::new(&grid, horizon, Quadrature::None).expect("family");
    let mut body = Body::new(family, material, NoDamage).expect("body");
    let patch: Vec<usize> = grid.select(|x| x.amax() < 1.5 * DX).iter().collect();
    assert_eq!(patch.len(), 3_usize.pow(D as u32));
    let (mut worst, mut waves) = ((0.0_f64, 0.0_f64), 0);
    for (phase, share) in phases.iter().flat_map(|phase| [(phase, 0.9), (phase, 0.05)]) {
        let dt = share * symbol.critical_time_step();
        let wave = SVector::from(*phase) / DX;
        for mode in symbol.eigen(&wave) {
            // Zero-energy modes of correspondence without control do not travel.
            let omega = mode.frequency();
            if omega < 1e-3 * 2.0 / dt {
                continue;
            }
            waves += 1;
            let turn = 2.0 * (0.5 * omega * dt).asin();
            let p = mode.polarisation * SIZE;
            body.set_displacement(|x| p * wave.dot(x).cos());
            body.set_velocity(|x| p * (wave.dot(x).sin() * turn.sin() / dt));
            let mut run = Run::new(&mut body, Loads::new(), TimeStep::Unchecked(dt)).expect("run");
            // Phase and amplitude of u·p in the patch, by least squares.
            let mut travelled = 0.0;
            for step in 1..=steps {
                run.steps_more(1).expect("step");
                let (mut a, mut b) = (SMatrix::<f64, 2, 2>::zeros(), SVector::<f64, 2>::zeros());
                for &i in &patch {
                    let (s, c) = wave.dot(&grid.position(i)).sin_cos();
                    let row = SVector::<f64, 2>::new(c, s);
                    a += row * row.transpose();
                    b += row * (run.body().displacement(i).dot(&mode.polarisation) / SIZE);
                }
                let fit = a.try_inverse().expect("the patch tells cos from sin") * b;
                let exact = turn * step as f64;
                let jump = (fit[1].atan2(fit[0]) - exact + std::f64::consts::PI)
                    .rem_euclid(2.0 * std::f64::consts::PI)
                    - std::f64::consts::PI;
                travelled = exact + jump;
                worst.1 = worst.1.max((fit.norm() - 1.0).abs());
            }
            let time = dt * steps as f64;
            let speed = travelled / (wave.norm() * time);
            let discrete = turn / (wave.norm() * dt);
            worst.0 = worst.0.max((speed / discrete - 1.0).abs());
            // Short steps: the symbol itself, up to what Verlet is early, (ωΔt)²/24.
            let (ahead, square) = (speed * wave.norm() / omega - 1.0, (omega * dt).powi(2));
            assert!(
                share > 0.1 || (ahead - square / 24.0).abs() < 0.005 * square / 24.0 + tolerance,
                "{name}: {ahead:e} ahead of the symbol, (ωΔt)² = {square}"
            );
        }
    }
    println!(
        "{name}: {waves} waves, speed within {:.0e}, amplitude within {:.0e}",
        worst.0, worst.1
    );
    assert!(waves >= D * (phases.len() - 1), "{name}: only {waves} waves travel");
    assert!(worst.0 < tolerance && worst.1 < tolerance, "{name}: {worst:?}");
}

/// Along an axis, aslant and along the diagonal, from long waves to nearly the zone's corner.
const PLANE: [[f64; 2]; 7] =
    [[0.3, 0.0], [1.5, 0.0], [2.9, 0.0], [0.4, 0.7], [-1.2, 2.3], [1.0, 1.0], [3.0, 3.0]];
const SPACE: [[f64; 3]; 4] = [[0.4, 0.0, 0.0], [0.5, -0.9, 1.3], [2.8, 0.0, 1.0], [3.0, 3.0, 3.0]];
const GAUSS: InfluenceFunction = InfluenceFunction::Gaussian;
const RHO: f64 = 1586.0;

fn linear<S>(model: S) -> Ordinary<S, Linearised>
where
    S: ScalarState<f64, 2>,
{
    Ordinary::linearised(model)
}

#[test]
fn bond_based() {
    let third = Isotropic::from_young_poisson(7e10, 1.0 / 3.0).expect("moduli");
    let pmb = || Pmb::plane(&third, PlaneMode::PlaneStress, RHO, InfluenceFunction::Constant);
    travels("PMB", &linear(pmb().expect("m")), (3.0, 9), &PLANE, 1e-12);
    // With finite kinematics the wave is linear up to its strain.
    travels("PMB, finite", &Ordinary::new(pmb().expect("m")), (3.0, 9), &PLANE, 1e-6);
}

#[test]
fn linear_solid() {
    let solid = LinearSolid::plane(&steel().expect("steel"), PlaneMode::PlaneStrain, RHO, GAUSS);
    travels("LPS", &linear(solid.expect("m")), (3.0, 9), &PLANE, 1e-12);
}

#[test]
fn polynomial_micromoduli() {
    let glass = Stiffness::<2>::lamina(&GLASS_EPOXY).expect("ply").rotated(0.5);
    let model = PolynomialMicromoduli::plane(&glass, RHO, GAUSS).expect("m");
    travels("polynomial, glass–epoxy", &linear(model), (3.0, 9), &PLANE, 1e-12);
}

#[test]
fn positive_split() {
    let carbon = Stiffness::<2>::lamina(&HTA_6376).expect("ply").rotated(0.5);
    let model = PositiveSplit::plane(&carbon, RHO, GAUSS).expect("m");
    travels("positive split, HTA/6376", &linear(model), (3.0, 9), &PLANE, 1e-12);
}

#[test]
fn correspondence() {
    let carbon = Stiffness::<2>::lamina(&HTA_6376).expect("ply").rotated(0.5);
    let bare = || Correspondence::new(LinearElastic(carbon), RHO, InfluenceFunction::Linear);
    travels("correspondence", &bare().expect("m"), (3.0, 9), &PLANE, 1e-12);
    let wan = bare().expect("m").with_control(WanControl::new(&carbon, 1.0).expect("control"));
    travels("correspondence, Wan", &wan, (3.0, 9), &PLANE, 1e-12);
}

#[test]
fn in_space() {
    let solid = LinearSolid::solid(&steel().expect("steel"), RHO, GAUSS).expect("m");
    travels("LPS 3D", &Ordinary::linearised(solid), (2.0, 5), &SPACE, 1e-12);
    let split = PositiveSplit::solid(&common::solid(), RHO, GAUSS).expect("m");
    travels("positive split 3D", &Ordinary::linearised(split), (2.0, 5), &SPACE, 1e-12);
}
