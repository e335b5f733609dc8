//! Bond-associated correspondence: what its gradient, energy and stress are.
use crate::common;
use peridynamics::prelude::*;

fn body<const D: usize, const V: usize>(
    grid: &Grid<D>,
    stiffness: &Stiffness<D>,
    influence: InfluenceFunction,
) -> Body<f64, D, Lattice<f64, D>, BondAssociated<D, V>, NoDamage> {
    let family = Lattice::new(grid, Horizon::Cells(2.3), Quadrature::None).expect("family");
    let material = BondAssociated::new(stiffness, 1e3, influence).expect("material");
    Body::new(family, material, NoDamage).expect("body")
}

/// W is the mean over the bonds, weighted by ω|ξ|²βV, of C's energy of the bond's own gradient
/// H + z⊗n/|ξ|: computed here bond by bond.
fn energy_is_the_mean_over_bonds<const D: usize, const V: usize>(
    grid: &Grid<D>,
    stiffness: &Stiffness<D>,
) {
    let influence = InfluenceFunction::Gaussian;
    let mut body = body::<D, V>(grid, stiffness, influence);
    body.set_displacement(|x| common::wavy(x, 1.0, 1e-2));
    body.evaluate().expect("forces");
    let energies = body.energy_densities();
    for node in [0, body.nodes() / 3, body.nodes() - 1] {
        let mut bonds = Vec::new();
        body.neighbours(node, |n| bonds.push(n));
        let weighted = |n: &peridynamics::core::family::Neighbour<D>| {
            influence.weight(n.xi.norm() / 2.3) * n.volume
        };
        let eta = |n: &peridynamics::core::family::Neighbour<D>| {
            body.displacement(n.node) - body.displacement(node)
        };
        let (mut k, mut s) = (SMatrix::<f64, D, D>::zeros(), SMatrix::<f64, D, D>::zeros());
        for n in &bonds {
            k += n.xi * n.xi.transpose() * weighted(n);
            s += eta(n) * n.xi.transpose() * weighted(n);
        }
        let h = s * k.try_inverse().expect("shape tensor");
        let (mut energy, mut m) = (0.0, 0.0);
        for n in &bonds {
            let own = h + (eta(n) - h * n.xi) * n.xi.transpose() / n.xi.norm_squared();
            let strain = (own + own.transpose()) * 0.5;
            energy += weighted(n) * n.xi.norm_squared() * stiffness.energy(&strain);
            m += weighted(n) * n.xi.norm_squared();
        }
        let error = (energies[node] / (energy / m) - 1.0).abs();
        assert!(error < 1e-10, "{D}D node {node}: {error:e}");
    }
}

#[test]
fn energy_is_that_of_the_bonds_own_gradients() {
    energy_is_the_mean_over_bonds::<2, 3>(&common::ring(1.0), &common::ply());
    energy_is_the_mean_over_bonds::<3, 6>(&common::block(1.0), &common::solid());
}

#[test]
fn homogeneous_strain_has_the_stress_of_the_stiffness_everywhere() {
    let mut body = body::<2, 3>(&common::ring(1e-3), &common::ply(), InfluenceFunction::Linear);
    let strain = SMatrix::<f64, 2, 2>::new(1e-3, 4e-4, 4e-4, -5e-4);
    body.set_displacement(|x| strain * x);
    body.evaluate().expect("forces");
    let exact = common::ply().contract(&strain);
    for i in 0..body.nodes() {
        assert!((body.stress(i) - exact).norm() < 1e-11 * exact.norm(), "node {i}");
    }
}

/// Angular momentum for small strains: a small rotation gives no force, and forces have no moment.
#[test]
fn forces_have_no_moment() {
    let mut body = body::<2, 3>(&common::ring(1.0), &common::ply(), InfluenceFunction::Gaussian);
    body.set_displacement(|x| [-1e-3 * x[1], 1e-3 * x[0]].into());
    body.evaluate().expect("forces");
    let turned = (0..body.nodes()).map(|i| body.force_density(i).norm()).fold(0.0, f64::max);
    body.set_displacement(|x| common::wavy(x, 1.0, 1e-3));
    body.evaluate().expect("forces");
    let (mut moment, mut size) = (0.0, 0.0);
    for i in 0..body.nodes() {
        let (x, f) = (body.position(i), body.force_density(i));
        moment += x[0] * f[1] - x[1] * f[0];
        size += x.norm() * f.norm();
    }
    assert!(turned < 1e-12 * size, "{turned:e} of {size:e}");
    assert!(moment.abs() < 1e-12 * size, "{moment:e} of {size:e}");
}

/// A bond that stretches more than its ends' mean strain says has a stress of its own.
#[test]
fn tsai_hill_reads_the_stress_of_the_bond() {
    let grid = Grid::new(&Cuboid::centred([9.0, 9.0]).expect("box"), 1.0).expect("grid");
    let family =
        || Lattice::<f64, 2>::new(&grid, Horizon::Cells(2.3), Quadrature::None).expect("f");
    let strengths = Strengths { along: 1e12, across: 60e6, shear: 1e12 };
    let worst = |own: bool| {
        let rim = grid.select(|x| x.amax() > 1.5);
        let criterion = TsaiHill::new(&strengths, 0.0).expect("criterion").sparing(&rim);
        let policy = Breaking::new(criterion);
        let ply = Stiffness::<2>::lamina(&Lamina { e1: 136e9, e2: 8.75e9, g12: 5.5e9, nu12: 0.3 });
        let ply = ply.expect("ply");
        // Rows move apart by turns: the nodes see no mean strain, the bonds do.
        let zigzag = |x: &SVector<f64, 2>| {
            let row = x[1].round() as i64;
            SVector::<f64, 2>::new(0.0, if row % 2 == 0 { 1e-3 } else { -1e-3 })
        };
        macro_rules! run {
            ($material:expr) => {{
                let mut body = Body::new(family(), $material, policy).expect("body");
                body.set_displacement(zigzag);
                body.evaluate_and_break(0, &mut ()).expect("forces");
                body.worst_index()
            }};
        }
        if own {
            run!(BondAssociated::<2, 3>::new(&ply, 1e3, OMEGA).expect("material"))
        } else {
            run!(Correspondence::new(LinearElastic(ply), 1e3, OMEGA).expect("material"))
        }
    };
    const OMEGA: InfluenceFunction = InfluenceFunction::Linear;
    let (own, mean) = (worst(true), worst(false));
    // 2e-3 over Δx and E2/(1 − ν12ν21) = 8.8 GPa: about (17.6 MPa/60 MPa)².
    assert!((own - 0.0861).abs() < 1e-3, "{own}");
    assert!(mean < 1e-9 * own, "{mean} {own}");
}

/// A matrix crack spares the bonds along the fibre, which break by the stress along it.
#[test]
fn bridging_fibres_do_not_break_by_the_matrix() {
    let grid = Grid::new(&Cuboid::centred([9.0, 9.0]).expect("box"), 1.0).expect("grid");
    let ply = Stiffness::<2>::lamina(&Lamina { e1: 136e9, e2: 8.75e9, g12: 5.5e9, nu12: 0.3 });
    let strengths = Strengths { along: 1670e6, across: 60e6, shear: 70e6 };
    let left = |criterion: TsaiHill, strain: [f64; 2]| {
        let family = Lattice::<f64, 2>::new(&grid, Horizon::Cells(2.3), Quadrature::None);
        let law = LinearElastic(ply.clone().expect("ply"));
        // Fibres alone are a line of nodes: keep what they can carry.
        let shape = ShapePolicy { rule: IllConditioned::PseudoInverse, limit: 1e6 };
        let material = Correspondence::new(law, 1e3, InfluenceFunction::Linear).expect("m");
        let material = material.with_shape_policy(shape);
        let mut body =
            Body::new(family.expect("family"), material, Breaking::new(criterion)).expect("body");
        body.set_displacement(|x| [strain[0] * x[0], strain[1] * x[1]].into());
        body.evaluate_and_break(0, &mut ()).expect("forces");
        let (mut along, mut across) = (0, 0);
        body.neighbours(40, |n| {
            along += usize::from(n.intact && n.xi[1] == 0.0);
            across += usize::from(n.intact && n.xi[1] != 0.0);
        });
        (along, across)
    };
    let printed = TsaiHill::new(&strengths, 0.0).expect("criterion");
    let matrix = [-2e-4, 8e-3];
    assert_eq!(left(printed, matrix), (0, 0));
    assert_eq!(left(printed.with_bridging_fibres(), matrix), (4, 0));
    assert_eq!(left(printed.with_bridging_fibres(), [0.014, -0.004]), (0, 0));
}
