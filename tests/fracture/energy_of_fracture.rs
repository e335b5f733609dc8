//! Energy balance while a body breaks: what the supports put in is kinetic, strain and dissipated
//! energy, within 1 % at every look of a whole run, for every criterion and kind of material.
use crate::common;
use common::*;
use peridynamics::prelude::*;

/// Pulls a notched body apart along y at `speed` until it is in two; returns broken bonds and the
/// largest imbalance over the work put in.
fn pull<T, const D: usize, M, C, I>(
    (material, criterion, integrator): (M, C, I),
    family: Lattice<T, D>,
    (speed, end, safety): (f64, f64, f64),
) -> (usize, f64)
where
    T: Real,
    M: StrainEnergy<T, D>,
    C: DamageCriterion<T, D, M>,
    I: Integrator<T, D>,
{
    let grid = family.grid().clone();
    let half = grid.position(grid.len() - 1)[1] + 0.5;
    let top = grid.select(|x| x[1] > half - 2.0);
    let bottom = grid.select(|x| x[1] < -half + 2.0);
    let policy = Breaking::new(criterion.sparing(&top.union(&bottom)));
    let mut body = Body::new(family, material, policy).expect("body");
    body.set_velocity(|x| SVector::from_fn(|d, _| if d == 1 { speed * x[1] / half } else { 0.0 }));
    let loads = Loads::new().velocity(&top, 1, speed).velocity(&bottom, 1, -speed);
    let mut run = Run::with_integrator(&mut body, loads, TimeStep::Safety(safety), integrator)
        .expect("run")
        .with_energies();
    let start = run.energies().expect("energies").kinetic;
    let (mut worst, mut most) = (0.0_f64, 0.0_f64);
    let mut dissipated = 0.0;
    while run.time() < end {
        run.steps_more(5).expect("steps");
        let e = run.energies().expect("energies");
        // A correspondence node that loses a bond reads its strain from the others: its energy may
        // rise.
        let never_back = e.dissipated >= dissipated * (1.0 - 1e-3);
        assert!(M::FOLLOWS_DAMAGE || never_back, "{e:?} after {dissipated:e}");
        dissipated = e.dissipated;
        most = most.max(e.external + start);
        worst = worst.max((e.external + start - e.kinetic - e.strain - e.dissipated).abs());
    }
    assert!(dissipated > 0.02 * most, "{dissipated:e} of {most:e}");
    (run.body().broken_bonds(), worst / most)
}

fn bar<T: Real, const D: usize>(size: [f64; D]) -> Lattice<T, D> {
    let grid = Grid::new(&Cuboid::centred(size).expect("box"), 1.0).expect("grid");
    Lattice::new(&grid, Horizon::Cells(2.5), Quadrature::None).expect("family")
}

const RHO_ONE: f64 = 1e3;

macro_rules! balanced {
    ($t:ty, $d:literal, $size:expr, $material:expr, $criterion:expr, $integrator:expr, $load:expr) => {{
        let (broken, worst) =
            pull::<$t, $d, _, _, _>(($material, $criterion, $integrator), bar($size), $load);
        println!("{}: {broken} bonds broke, imbalance {worst:.1e}", stringify!($criterion));
        assert!(broken > 20, "{} bonds", broken);
        assert!(worst < 0.01, "imbalance {worst}");
    }};
}

/// A wave crosses the bar in about 20 s (c = 1 m/s, 1 m spacing).
fn moduli(nu: f64) -> Isotropic {
    Isotropic::from_young_poisson(1e3, nu).expect("moduli")
}

#[test]
fn in_the_plane() {
    let size = [8.0, 24.0];
    let load = (0.01, 100.0, 0.4);
    let lps = || {
        let mode = PlaneMode::PlaneStrain;
        Ordinary::new(LinearSolid::plane(&moduli(0.3), mode, RHO_ONE, OMEGA).expect("m"))
    };
    let plane = CrackPlane::lattice(&bar::<f64, 2>(size), [0.0, 1.0]).expect("plane");
    let bulk = moduli(0.3).plane_bulk(PlaneMode::PlaneStrain);
    let model = BondModel::linear_solid(bulk, moduli(0.3).shear(), OMEGA).expect("model");
    let g = FractureEnergy::new(0.3).expect("G");
    let verlet = || VelocityVerlet::new();
    let stretch = || CriticalStretch::from_energy(g, &model, &plane).expect("s");
    let opening = CrackOpening::from_energy(g, &model, &plane).expect("Δ");
    let energy = BondEnergy::from_energy(g, &plane).expect("w");
    let modes = ModeEnergies::from_energies(g, None, g, &plane).expect("modes");
    balanced!(f64, 2, size, lps(), stretch(), verlet(), load);
    balanced!(f32, 2, size, lps(), stretch(), VelocityVerlet::new(), load);
    // Velocities lag by half a step: kinetic energy is first order in Δt.
    balanced!(f64, 2, size, lps(), stretch(), SymplecticEuler, (0.01, 50.0, 0.1));
    let either = energy.tension_only().or(opening);
    balanced!(f64, 2, size, lps(), either, verlet(), load);
    balanced!(f64, 2, size, lps(), PowerLaw::new(modes), verlet(), load);
    balanced!(f64, 2, size, lps(), Separated::new(modes), verlet(), load);

    // Correspondence: constants of the nodes follow the damage.
    let stiffness = {
        let (m, nu) = (moduli(0.3), 0.3);
        let ply = Lamina { e1: m.young(), e2: m.young(), g12: m.shear(), nu12: nu };
        Stiffness::<2>::lamina(&ply).expect("stiffness")
    };
    let correspondence = || {
        Correspondence::new(LinearElastic(stiffness), RHO_ONE, OMEGA)
            .expect("m")
            .with_control(SillingControl::new(1e3, 0.3).expect("c"))
            .with_shape_policy(ShapePolicy { rule: IllConditioned::Detach, limit: 10.0 })
    };
    let strengths = Strengths { along: 15.0, across: 15.0, shear: 10.0 };
    let tsai_hill = TsaiHill::new(&strengths, 0.3).expect("criterion");
    // Nodes that keep few bonds are stiff; the step is that of the whole body.
    balanced!(f64, 2, size, correspondence(), tsai_hill, verlet(), (0.01, 100.0, 0.2));
    let strained = || {
        let lps = LinearSolid::plane(&moduli(0.3), PlaneMode::PlaneStress, RHO_ONE, OMEGA);
        Ordinary::new(Strained::<_, 2, 3>::plane(lps.expect("m"), &stiffness, OMEGA))
    };
    balanced!(f64, 2, size, strained(), tsai_hill, verlet(), load);
    let third = moduli(1.0 / 3.0);
    let pmb =
        || Ordinary::new(Pmb::plane(&third, PlaneMode::PlaneStress, RHO_ONE, OMEGA).expect("m"));
    balanced!(f64, 2, size, pmb(), energy, verlet(), load);
}

#[test]
fn in_space() {
    let size = [5.0, 16.0, 5.0];
    let load = (0.01, 60.0, 0.4);
    let lps = || Ordinary::new(LinearSolid::solid(&moduli(0.3), RHO_ONE, OMEGA).expect("model"));
    let plane = CrackPlane::lattice(&bar::<f64, 3>(size), [0.0, 1.0, 0.0]).expect("plane");
    let g = FractureEnergy::new(0.3).expect("G");
    let modes = ModeEnergies::from_energies(g, Some(g), g, &plane).expect("modes");
    let energy = BondEnergy::from_energy(g, &plane).expect("w");
    balanced!(f64, 3, size, lps(), energy, VelocityVerlet::new(), load);
    balanced!(f32, 3, size, lps(), energy, VelocityVerlet::new(), load);
    balanced!(f64, 3, size, lps(), Separated::new(modes), VelocityVerlet::new(), load);
    let strengths = Strengths { along: 15.0, across: 15.0, shear: 10.0 };
    let material = || {
        let law = NeoHookean::new(&moduli(0.3));
        Correspondence::new(law, RHO_ONE, OMEGA)
            .expect("m")
            .with_control(SillingControl::new(1e3, 0.3).expect("c"))
            .with_shape_policy(ShapePolicy { rule: IllConditioned::Detach, limit: 10.0 })
    };
    let tsai_hill = TsaiHill3::new(&strengths, [0.0, 0.0, 1.0]).expect("criterion");
    balanced!(f64, 3, size, material(), tsai_hill, VelocityVerlet::new(), (0.01, 60.0, 0.2));
}
