//! Several materials in a body, of one type and of two: at every node the forces of a brute-force
//! sum in which each end of a bond has the force state of its own material.
use crate::common;
use peridynamics::models::Mixed;
use peridynamics::prelude::*;

/// T⟨ξ⟩βV of a node of a body of one material, times the unit of forces.
fn force_state<const D: usize, F: Family<f64, D>, M: Material<f64, D>>(
    body: &Body<f64, D, F, M, NoDamage>,
    node: usize,
    n: &peridynamics::core::Neighbour<D>,
) -> SVector<f64, D> {
    let unit = body.family().unit();
    let eta = (body.displacement(n.node) - body.displacement(node)) / unit;
    let bond = Bond::new(n.xi, eta);
    let constants = body.material().bond_const(&n.xi, body.family().scale(node));
    let (c, s) = (body.constants(node), body.state(node));
    let end = End { bond: &constants, node: &c, state: &s, volume: n.volume };
    body.material().force_state(&bond, end) * (n.volume / unit)
}

/// Compares `mixed` with bodies of its two materials in the same displacement.
fn compare<const D: usize, F, A, B, M>(grid: &Grid<D>, family: F, a: A, b: B, mixed: M)
where
    F: Family<f64, D> + Clone,
    A: StrainEnergy<f64, D>,
    B: StrainEnergy<f64, D>,
    M: StrainEnergy<f64, D>,
{
    let dx = grid.spacing()[0];
    let u = |x: &SVector<f64, D>| common::wavy(x, dx, 1e-2 * dx);
    macro_rules! body {
        ($material:expr) => {{
            let mut body = Body::new(family.clone(), $material, NoDamage).expect("body");
            body.set_displacement(u);
            body.evaluate().expect("forces");
            body
        }};
    }
    let (a, b, mixed) = (body!(a), body!(b), body!(mixed));
    let (energy_a, energy_b, energy) =
        (a.energy_densities(), b.energy_densities(), mixed.energy_densities());
    let own = |node: usize, n: &peridynamics::core::Neighbour<D>| {
        if is_second(&grid.position(node)) {
            force_state(&b, node, n)
        } else {
            force_state(&a, node, n)
        }
    };
    let size = (0..grid.len()).map(|i| mixed.force_density(i).norm()).fold(0.0, f64::max);
    let mut seconds = 0;
    for node in 0..grid.len() {
        let mut sum = SVector::<f64, D>::zeros();
        mixed.neighbours(node, |n| {
            let back = peridynamics::core::Neighbour { node, xi: -n.xi, ..n };
            sum += own(node, &n) - own(n.node, &back);
        });
        let difference = (mixed.force_density(node) - sum).norm();
        assert!(difference < 1e-12 * size, "node {node}: {:e}", difference / size);
        let of_second = is_second(&grid.position(node));
        seconds += usize::from(of_second);
        let exact = if of_second { energy_b[node] } else { energy_a[node] };
        assert!((energy[node] - exact).abs() <= 1e-12 * exact.abs(), "energy of node {node}");
    }
    assert!(seconds > 10 && grid.len() - seconds > 10, "{seconds} of {}", grid.len());
}

/// Nodes of the second material: beyond a plane aslant.
fn is_second<const D: usize>(x: &SVector<f64, D>) -> bool {
    x[0] + 0.3 * x[D - 1] > 0.0
}

/// On a lattice and in a cloud.
macro_rules! on_both {
    ($grid:expr, $d:literal, $a:expr, $b:expr, $mixed:expr) => {{
        let grid = $grid;
        let tags: Vec<bool> = grid.positions().map(|x| is_second(&x)).collect();
        let (m, beta) = (Horizon::Cells(2.3), Quadrature::None);
        let lattice = Lattice::<f64, $d>::new(&grid, m, beta).expect("family");
        compare(&grid, lattice, $a, $b, $mixed(&tags));
        let cloud = Cloud::<f64, $d>::new(&Points::from_grid(&grid), m, beta).expect("family");
        compare(&grid, cloud, $a, $b, $mixed(&tags));
    }};
}

fn region(tags: &[bool]) -> Vec<u8> {
    tags.iter().map(|&tag| u8::from(tag)).collect()
}

const GAUSS: InfluenceFunction = InfluenceFunction::Gaussian;

fn moduli(young: f64, poisson: f64) -> Isotropic {
    Isotropic::from_young_poisson(young, poisson).expect("moduli")
}

#[test]
fn one_type_in_the_plane_and_in_space() {
    let solid = |young| LinearSolid::solid(&moduli(young, 0.3), 2e3, GAUSS).expect("material");
    let pair = || (Ordinary::new(solid(7e10)), Ordinary::new(solid(2e11)));
    on_both!(common::block(1e-3), 3, pair().0, pair().1, |tags: &[bool]| {
        Regions::new([pair().0, pair().1], region(tags)).expect("regions")
    });
    let finite = |angle| SaintVenantKirchhoff(common::solid().rotated_about_z(angle));
    let nosb = |angle| Correspondence::new(finite(angle), 2e3, GAUSS).expect("material");
    on_both!(common::block(1e-3), 3, nosb(0.0), nosb(1.0), |tags: &[bool]| {
        Regions::new([nosb(0.0), nosb(1.0)], region(tags)).expect("regions")
    });
    let split = |angle| {
        let model = PositiveSplit::plane(&common::ply().rotated(angle), 2e3, GAUSS);
        Ordinary::new(model.expect("material"))
    };
    on_both!(common::ring(1e-3), 2, split(0.0), split(1.0), |tags: &[bool]| {
        Regions::new([split(0.0), split(1.0)], region(tags)).expect("regions")
    });
}

#[test]
fn two_types_in_the_plane() {
    let third = moduli(7e10, 1.0 / 3.0);
    let bonds =
        || Ordinary::new(Pmb::plane(&third, PlaneMode::PlaneStress, 1e3, GAUSS).expect("m"));
    let law = || LinearElastic(common::ply());
    let control = || WanControl::new(&common::ply(), 0.5).expect("control");
    let nosb = || Correspondence::new(law(), 2e3, GAUSS).expect("m").with_control(control());
    on_both!(common::ring(1e-3), 2, bonds(), nosb(), |tags: &[bool]| {
        Mixed::new(bonds(), nosb(), tags.to_vec())
    });
}

#[test]
fn two_types_in_space() {
    let lps = || Ordinary::new(LinearSolid::solid(&moduli(7e10, 0.2), 1e3, GAUSS).expect("m"));
    let split = || Ordinary::new(PositiveSplit::solid(&common::solid(), 2e3, GAUSS).expect("m"));
    on_both!(common::block(1e-3), 3, lps(), split(), |tags: &[bool]| {
        Mixed::new(lps(), split(), tags.to_vec())
    });
    let nosb = || {
        let law = NeoHookean::new(&moduli(3e9, 0.4));
        Correspondence::new(law, 1e3, GAUSS).expect("m")
    };
    on_both!(common::block(1e-3), 3, nosb(), split(), |tags: &[bool]| {
        Mixed::new(nosb(), split(), tags.to_vec())
    });
    // More than two types nest.
    let all_first = |tags: &[bool]| Mixed::new(lps(), nosb(), vec![false; tags.len()]);
    on_both!(common::block(1e-3), 3, lps(), split(), |tags: &[bool]| {
        Mixed::new(all_first(tags), split(), tags.to_vec())
    });
}

/// Damage, detached nodes and faults are those of the node's own material.
#[test]
fn damage_and_faults_of_two_types() {
    let grid = common::ring(1e-3);
    let tags: Vec<bool> = grid.positions().map(|x| is_second(&x)).collect();
    let third = moduli(7e10, 1.0 / 3.0);
    let material = || {
        let pmb = Pmb::plane(&third, PlaneMode::PlaneStress, 1e3, GAUSS).expect("m");
        let law = NeoHookean::new(&third);
        let nosb = Correspondence::new(law, 1e3, GAUSS).expect("m");
        Mixed::new(Ordinary::new(pmb), nosb, tags.clone())
    };
    let family =
        || Lattice::<f64, 2>::new(&grid, Horizon::Cells(2.3), Quadrature::None).expect("f");
    // Without a crack no node is detached: the bonds of PMB nodes, which have no B, stay.
    let stretch = CriticalStretch::new(0.05).expect("criterion");
    let mut body = Body::new(family(), material(), Breaking::new(stretch)).expect("body");
    assert!((0..body.nodes()).all(|i| body.damage(i) == 0.0));
    body.set_velocity(|x| x * 2e4);
    let mut run = Run::new(&mut body, Loads::new(), TimeStep::Safety(0.3)).expect("run");
    run.steps_more(120).expect("steps");
    assert!(run.body().broken_bonds() > 0);
    // A mirror image of the neighbourhood: J < 0 at correspondence nodes only.
    for (wanted, of_second) in [(true, true), (false, false)] {
        let mut body = Body::new(family(), material(), NoDamage).expect("body");
        let side = if of_second { 1.0 } else { -1.0 };
        body.set_displacement(|x| {
            let far = side * (x[0] + 0.3 * x[1]) > 2.5e-3;
            if far { [-2.0 * x[0], 0.0].into() } else { SVector::zeros() }
        });
        let result = body.evaluate();
        match result {
            Err(Error::Inverted { node, det }) => assert!(wanted && tags[node] && det < 0.0),
            other => assert!(!wanted && other.is_ok(), "{other:?}"),
        }
    }
}

#[test]
fn a_list_for_another_body_is_refused() {
    let grid = common::ring(1e-3);
    let family = Lattice::<f64, 2>::new(&grid, Horizon::Cells(2.3), Quadrature::None).expect("f");
    let third = moduli(7e10, 1.0 / 3.0);
    let pmb = || Ordinary::new(Pmb::plane(&third, PlaneMode::PlaneStress, 1e3, GAUSS).expect("m"));
    let mixed = Mixed::new(pmb(), pmb(), vec![false; grid.len() - 1]);
    let refused = Body::new(family.clone(), mixed, NoDamage).err().expect("refused");
    assert!(matches!(refused, Error::InvalidValue { .. }), "{refused}");
    let short = Regions::new([pmb(), pmb()], vec![0; grid.len() - 1]).expect("regions");
    let refused = Body::new(family, short, NoDamage).err().expect("refused");
    assert!(matches!(refused, Error::InvalidValue { .. }), "{refused}");
    assert!(Regions::new([pmb(), pmb()], vec![2]).is_err());
}
