//! Critical energies of graded bodies: one fracture energy at every horizon, and bonds between nodes
//! of different horizons.
use peridynamics::damage::bond_energy::Uniform;
use peridynamics::prelude::*;

const CELLS: f64 = 3.0;
const ENERGY: f64 = 12.0;

type Solid = Ordinary<LinearSolid>;

fn solid(influence: InfluenceFunction) -> Solid {
    let moduli = Isotropic::from_young_poisson(70e9, 0.2).expect("moduli");
    let plane = LinearSolid::plane(&moduli, PlaneMode::PlaneStrain, 1e3, influence);
    Ordinary::new(plane.expect("material"))
}

fn energy(factor: f64) -> FractureEnergy {
    FractureEnergy::new(factor * ENERGY).expect("G_c")
}

/// What a lattice costs that is broken by each kind of criterion, calibrated on it.
fn plane(dx: f64) -> CrackPlane<2> {
    let grid = Grid::new(&Cuboid::centred([12.0 * dx; 2]).expect("box"), dx).expect("grid");
    let lattice = Lattice::<f64, 2>::new(&grid, Horizon::Cells(CELLS), Quadrature::None);
    CrackPlane::lattice(&lattice.expect("family"), [0.0, 1.0]).expect("plane")
}

fn modes(dx: f64) -> ModeEnergies {
    let compression = Some(energy(3.0));
    ModeEnergies::from_energies(energy(1.0), compression, energy(2.0), &plane(dx)).expect("modes")
}

fn foster(dx: f64) -> BondEnergy {
    BondEnergy::<Uniform>::from_energy(energy(1.0), &plane(dx)).expect("criterion")
}

fn fading(dx: f64) -> BondEnergy<InfluenceFunction> {
    BondEnergy::weighted(energy(1.0), &plane(dx), InfluenceFunction::Gaussian).expect("criterion")
}

/// The largest failure index of a body of one spacing in a strain that tears and one that presses.
fn worst<C: DamageCriterion<f64, 2, Solid> + Clone>(dx: f64, criterion: &C) -> [f64; 2] {
    [1e-4, -1e-4].map(|strain| {
        let grid = Grid::new(&Cuboid::centred([9.0 * dx, 7.0 * dx]).expect("box"), dx);
        let points = Points::from_grid(&grid.expect("grid"));
        let horizons = vec![CELLS * dx; points.len()];
        let cloud = Cloud::<f64, 2>::graded(&points, &horizons, Quadrature::None);
        let policy = Breaking::new(criterion.clone());
        let material = solid(InfluenceFunction::Linear);
        let mut body = Body::new(cloud.expect("family"), material, policy).expect("body");
        body.set_displacement(|x| {
            [strain * x[0], -0.4 * strain * x[1] + 0.7 * strain * x[0]].into()
        });
        let mut run = Run::new(&mut body, Loads::new(), TimeStep::Unchecked(1e-12)).expect("run");
        run.steps_more(1).expect("step");
        drop(run);
        body.worst_index()
    })
}

/// Calibrated once, a local criterion judges bodies of any horizon as one calibrated there does; one
/// that is not local errs by the cube of the horizon and more.
fn same_at_every_horizon<C, L>(own: impl Fn(f64) -> C, local: L)
where
    C: DamageCriterion<f64, 2, Solid> + Clone,
    L: DamageCriterion<f64, 2, Solid> + Clone,
{
    for dx in [0.5e-3, 1e-3, 4e-3] {
        let (here, there) = (worst(dx, &own(dx)), worst(dx, &local));
        for (a, b) in here.into_iter().zip(there) {
            assert!(a > 0.0 && (a / b - 1.0).abs() < 1e-9, "Δx = {dx}: {a:e}, {b:e}");
        }
    }
    let (fixed, there) = (worst(4e-3, &own(1e-3))[0], worst(4e-3, &local)[0]);
    assert!(there > 3.0 * fixed || there < fixed / 3.0, "the horizon does not matter: {fixed:e}");
}

#[test]
fn one_fracture_energy_at_every_horizon() {
    let horizon = CELLS * 1e-3;
    let local = foster(1e-3).at_horizon(horizon).expect("horizon");
    same_at_every_horizon(foster, local);
    let local = fading(1e-3).at_horizon(horizon).expect("horizon");
    same_at_every_horizon(fading, local);
    let (power, separated) = (PowerLaw::new(modes(1e-3)), Separated::new(modes(1e-3)));
    let local = power.at_horizon(horizon).expect("horizon");
    same_at_every_horizon(|dx| PowerLaw::new(modes(dx)), local);
    let local = PowerLaw::as_printed(modes(1e-3)).at_horizon(horizon).expect("horizon");
    same_at_every_horizon(|dx| PowerLaw::as_printed(modes(dx)), local);
    let local = separated.at_horizon(horizon).expect("horizon");
    same_at_every_horizon(|dx| Separated::new(modes(dx)), local);
    assert!(foster(1e-3).at_horizon(0.0).is_err());
}

/// A bond breaks at half the critical energy of every end that has it in its family.
#[test]
fn a_bond_breaks_by_the_ends_that_have_it() {
    let critical = 1e9;
    let local = BondEnergy::new(critical).expect("w_C").at_horizon(1.0).expect("horizon");
    let at = |horizon: f64| critical / horizon.powi(3);
    let cases = [
        ([4.0, 2.0], 0.5 * (at(4.0) + at(2.0))),
        ([4.0, 1.0], 0.5 * at(4.0)),
        ([1.0, 2.0], 0.5 * at(2.0)),
    ];
    for (horizons, critical) in cases {
        // The upper nodes only keep the families of short horizons from being empty.
        let places = [[0.0, 0.0], [1.5, 0.0], [0.0, 0.9], [1.5, 0.9]].map(SVector::from).to_vec();
        let points = Points::new(places, vec![1.0; 4]).expect("points");
        let horizons = [horizons[0], horizons[1], 0.95, 0.95];
        let own = lower_index(&points, &horizons, local);
        let fixed = lower_index(&points, &horizons, BondEnergy::new(critical).expect("w_C"));
        assert!((own / fixed - 1.0).abs() < 1e-9, "{horizons:?}: {own:e}, {fixed:e}");
    }
}

/// The failure index of the bond between the lower two of four nodes.
fn lower_index<C: DamageCriterion<f64, 2, Solid>>(
    points: &Points<2>,
    horizons: &[f64],
    criterion: C,
) -> f64 {
    let upper = NodeSet::from_nodes([2, 3], 4).expect("set");
    let cloud = Cloud::<f64, 2>::graded(points, horizons, Quadrature::None).expect("family");
    let policy = Breaking::new(criterion.sparing(&upper));
    let mut body = Body::new(cloud, solid(InfluenceFunction::Constant), policy).expect("body");
    body.set_displacement(|x| [x[0] * 1e-6, 0.0].into());
    let mut run = Run::new(&mut body, Loads::new(), TimeStep::Unchecked(1e-12)).expect("run");
    run.steps_more(1).expect("step");
    drop(run);
    assert!(body.worst_index() > 0.0);
    body.worst_index()
}
