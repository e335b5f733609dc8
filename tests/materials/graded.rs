//! Clouds whose spacing and horizon change: what the dual horizon keeps, and what it does not.
use pd_testkit::graded_wave::{COARSE, FINE, OneSided, Plate, ghost_force, unbalance};
use peridynamics::prelude::*;

const CELLS: f64 = 3.0;

fn dual_horizon<T: Real, const D: usize>(points: &Points<D>) -> Cloud<T, D> {
    let horizons: Vec<f64> = (0..points.len()).map(|i| CELLS * points.edge(i)).collect();
    Cloud::graded(points, &horizons, Quadrature::None).expect("family")
}

fn moduli(poisson: f64) -> Isotropic {
    Isotropic::from_young_poisson(1.0, poisson).expect("moduli")
}

fn plate_bonds() -> impl Material<f64, 2, NodeState = ()> {
    let (mode, omega) = (PlaneMode::PlaneStress, InfluenceFunction::Linear);
    Ordinary::new(Pmb::plane(&moduli(1.0 / 3.0), mode, 1.0, omega).expect("bonds").on_family())
}

/// A cube or square of edge 8: cells of ½ for x < 0, of 1 beyond.
fn halved<const D: usize>() -> Points<D> {
    let grid = Grid::new(&Cuboid::centred([8.0; D]).expect("cube"), 1.0).expect("grid");
    Points::refined(&grid, |x| if x[0] < 0.0 { 0.5 } else { 1.0 }).expect("points")
}

#[test]
fn momentum_is_kept_in_2d_and_3d() {
    fn wavy<const D: usize>(x: &SVector<f64, D>) -> SVector<f64, D> {
        SVector::from_fn(|d, _| 1e-3 * (0.7 * x[d] + 0.3 * x[(d + 1) % D]).sin())
    }
    macro_rules! residual {
        ($real:ty, $d:literal, $material:expr) => {{
            let cloud = dual_horizon::<$real, $d>(&halved());
            let mut body = Body::new(cloud, $material, NoDamage).expect("body");
            body.set_displacement(wavy);
            body.evaluate().expect("forces");
            unbalance(&body)
        }};
    }
    let (mode, omega) = (PlaneMode::PlaneStress, InfluenceFunction::Gaussian);
    let plate = || LinearSolid::plane(&moduli(0.2), mode, 1.0, omega).expect("plate");
    let solid = || LinearSolid::solid(&moduli(0.2), 1.0, omega).expect("solid");
    let pmb = || Pmb::solid(&moduli(0.25), 1.0, omega).expect("bonds").on_family();
    assert!(residual!(f64, 2, Ordinary::new(plate())) < 1e-14);
    assert!(residual!(f64, 3, Ordinary::new(solid())) < 1e-14);
    assert!(residual!(f64, 3, Ordinary::new(pmb())) < 1e-14);
    assert!(residual!(f32, 2, Ordinary::new(plate())) < 1e-6);
    assert!(residual!(f32, 3, Ordinary::new(solid())) < 1e-6);
    // Families that look one way only lose a good part of it.
    assert!(residual!(f64, 3, OneSided(Ordinary::new(pmb()))) > 1e-3);
}

/// A pulse of nine coarse horizons wave length passes from ¼ to 1.
#[test]
fn a_wave_crosses_the_transition() {
    let omega_cells = Horizon::Cells(CELLS);
    let symbol = Symbol::of(&plate_bonds(), FINE, omega_cells, Quadrature::None).expect("symbol");
    let speed = symbol.phase_speeds(&[1.0, 0.0].into(), 0.05).expect("speed")[1];
    let reflected = |between: f64, one_sided: bool| {
        let plate = Plate { width: 4.5, between };
        let cloud = dual_horizon(&plate.points().expect("points"));
        let crossing = if one_sided {
            let material = OneSided(plate_bonds());
            plate.send(&mut Body::new(cloud, material, NoDamage).expect("body"), speed)
        } else {
            plate.send(&mut Body::new(cloud, plate_bonds(), NoDamage).expect("body"), speed)
        };
        let crossing = crossing.expect("run");
        assert!((crossing.transmitted - 1.0).abs() < 0.02 || one_sided, "{}", crossing.transmitted);
        crossing.reflected
    };
    let steps = reflected(2.0, false);
    assert!(steps < 0.015, "2:1 twice reflects {steps}");
    let once = reflected(0.0, false);
    assert!(once < 0.02, "4:1 at once reflects {once}");
    let alone = reflected(0.0, true);
    assert!(alone > 0.2, "own families alone reflect {alone}, so the dual horizon buys nothing");
}

/// Momentum is kept, yet single nodes of the transition are pushed under homogeneous strain: the
/// families are not symmetric there. Their forces cancel over the transition.
#[test]
fn forces_under_homogeneous_strain_stay_in_the_transition() {
    let plate = Plate { width: 3.0, between: 2.0 };
    let cloud = dual_horizon(&plate.points().expect("points"));
    let mut body = Body::new(cloud, plate_bonds(), NoDamage).expect("body");
    let inner = |x: &SVector<f64, 2>| x[1].abs() < 10.0;
    // Families are uneven up to one coarse horizon away, and act one horizon farther.
    let right = 2.0 + 2.0 * CELLS * COARSE;
    let beside = |x: f64| (-10.0..-CELLS * COARSE).contains(&x) || (right..14.0).contains(&x);
    for h in [[[1.0, 0.0], [0.0, 0.0]], [[0.0, 0.0], [0.0, 1.0]], [[0.0, 0.5], [0.5, 0.0]]] {
        let h = SMatrix::<f64, 2, 2>::from(h);
        let quiet = ghost_force(&mut body, &h, 1.0, |x| inner(x) && beside(x[0]));
        // Geometrically exact kinematics: strains of 1e-6 leave 1e-6.
        let quiet = quiet.expect("forces");
        assert!(quiet < 1e-5, "{quiet}");
        let within = ghost_force(&mut body, &h, 1.0, |x| inner(x) && x[0].abs() < 10.0);
        let within = within.expect("forces");
        assert!(within > 0.01 && within < 1.0, "{within}");
        let nodes = (0..body.nodes()).filter(|&i| {
            let x = body.position(i);
            inner(&x) && x[0].abs() < 10.0
        });
        let forces = nodes.map(|i| body.force_density(i) * body.volume(i));
        let (sum, size) =
            forces.fold((SVector::<f64, 2>::zeros(), 0.0), |(s, n), f| (s + f, n + f.norm()));
        assert!(sum.norm() < 1e-5 * size, "{sum} of {size}");
    }
}

#[test]
fn a_local_stretch_has_the_fracture_energy_of_every_horizon() {
    let energy = FractureEnergy::new(10.0).expect("G_c");
    let own = |dx: f64, model: &BondModel| {
        let grid = Grid::new(&Cuboid::centred([12.0 * dx; 3]).expect("cube"), dx).expect("grid");
        let lattice = Lattice::<f64, 3>::new(&grid, Horizon::Cells(CELLS), Quadrature::None);
        let plane = CrackPlane::lattice(&lattice.expect("family"), [0.0, 0.0, 1.0]).expect("plane");
        CriticalStretch::from_energy(energy, model, &plane).expect("stretch")
    };
    let omega = InfluenceFunction::Linear;
    for model in [BondModel::pmb(40e9, omega), BondModel::linear_solid(40e9, 20e9, omega)] {
        let model = model.expect("model");
        let local = own(1e-3, &model).at_horizon(CELLS * 1e-3).expect("horizon");
        for dx in [0.5e-3, 1e-3, 4e-3] {
            let (here, there) = (own(dx, &model).stretch(), local.stretch(CELLS * dx));
            assert!((here / there - 1.0).abs() < 1e-12, "{here} {there}");
        }
    }
    assert!(CriticalStretch::new(0.01).expect("s_c").at_horizon(0.0).is_err());
}

/// A bond in both families breaks at the mean of both ends' t_c, one in a single family
/// at that end's.
#[test]
fn a_bond_breaks_by_the_ends_that_have_it() {
    let local = CriticalStretch::new(0.01).expect("s_c").at_horizon(1.0).expect("horizon");
    let t = |horizon: f64| (1.0 + local.stretch(horizon)).powi(2) - 1.0;
    let cases = [([4.0, 2.0], 0.5 * (t(4.0) + t(2.0))), ([4.0, 1.0], t(4.0)), ([1.0, 2.0], t(2.0))];
    for (horizons, critical) in cases {
        // The upper nodes only keep the families of short horizons from being empty.
        let places = [[0.0, 0.0], [1.5, 0.0], [0.0, 0.9], [1.5, 0.9]].map(SVector::from).to_vec();
        let points = Points::new(places, vec![1.0; 4]).expect("points");
        let horizons = [horizons[0], horizons[1], 0.95, 0.95];
        for (factor, broken) in [(0.999, 0), (1.001, 1)] {
            let cloud = Cloud::<f64, 2>::graded(&points, &horizons, Quadrature::None);
            let policy = Breaking::new(local);
            let mut body = Body::new(cloud.expect("family"), plate_bonds(), policy).expect("body");
            let stretch = (1.0 + factor * critical).sqrt() - 1.0;
            body.set_displacement(|x| [x[0] * stretch, 0.0].into());
            let mut run =
                Run::new(&mut body, Loads::new(), TimeStep::Unchecked(1e-9)).expect("run");
            run.steps_more(1).expect("step");
            drop(run);
            assert_eq!(body.broken_bonds(), broken, "{horizons:?} at {factor}");
        }
    }
}
