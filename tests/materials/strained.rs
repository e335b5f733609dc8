//! Ordinary materials with a stress: exact under homogeneous strain, the forces untouched, and
//! Tsai–Hill works with them.
use crate::common;
use common::*;
use peridynamics::prelude::*;

fn isotropic(moduli: &Isotropic) -> Stiffness<2> {
    let (young, nu) = (moduli.young(), moduli.poisson());
    let lamina = Lamina { e1: young, e2: young, g12: moduli.shear(), nu12: nu };
    Stiffness::<2>::lamina(&lamina).expect("stiffness")
}

/// Stress at every node of a homogeneous small strain, and the forces of the bare model.
macro_rules! check {
    ($t:ty, $bare:expr, $strained:expr, $stiffness:expr, $grid:expr, $d:literal) => {{
        let family =
            || Lattice::<$t, $d>::new(&$grid, Horizon::Cells(2.5), Quadrature::Exact).expect("f");
        let mut with = Body::new(family(), Ordinary::linearised($strained), NoDamage).expect("b");
        let mut bare = Body::new(family(), Ordinary::linearised($bare), NoDamage).expect("b");
        let h = SMatrix::<f64, $d, $d>::from_fn(|i, j| 1e-3 * (1.0 + i as f64 - 0.4 * j as f64));
        with.set_displacement(|x| h * x);
        with.evaluate().expect("forces");
        let strain = (h + h.transpose()) * 0.5;
        let exact = $stiffness.contract(&strain);
        for node in 0..with.nodes() {
            let error = (with.stress(node) - exact).norm() / exact.norm();
            assert!(error < 300.0 * <$t>::EPSILON as f64, "node {node}: {error:e}");
        }
        with.set_displacement(|x| wavy(x, 1.0, 1e-3));
        bare.set_displacement(|x| wavy(x, 1.0, 1e-3));
        with.evaluate().expect("forces");
        bare.evaluate().expect("forces");
        assert!(bare.force_density(0).norm() > 0.0);
        for node in 0..with.nodes() {
            assert_eq!(with.force_density(node), bare.force_density(node));
        }
    }};
}

#[test]
fn stress_of_a_homogeneous_strain() {
    let moduli = Isotropic::from_young_poisson(7e10, 0.3).expect("moduli");
    let plane = isotropic(&moduli);
    let lps = || LinearSolid::plane(&moduli, PlaneMode::PlaneStress, RHO, OMEGA).expect("model");
    check!(f64, lps(), Strained::<_, 2, 3>::plane(lps(), &plane, OMEGA), plane, ring(1.0), 2);
    check!(f32, lps(), Strained::<_, 2, 3>::plane(lps(), &plane, OMEGA), plane, ring(1.0), 2);
    let split = || PositiveSplit::plane(&ply(), RHO, OMEGA).expect("model");
    check!(f64, split(), Strained::<_, 2, 3>::plane(split(), &ply(), OMEGA), ply(), ring(1.0), 2);
    let poly = || PolynomialMicromoduli::solid(&solid(), RHO, OMEGA).expect("model");
    let with = || Strained::<_, 3, 6>::solid(poly(), &solid(), OMEGA);
    check!(f64, poly(), with(), solid(), block(1.0), 3);
    check!(f32, poly(), with(), solid(), block(1.0), 3);
}

/// A bar of a linear solid pulled along x breaks by Tsai–Hill when its stress reaches the strength.
#[test]
fn tsai_hill_with_a_linear_solid() {
    let moduli = Isotropic::from_young_poisson(7e10, 0.25).expect("moduli");
    let stiffness = isotropic(&moduli);
    let lps = LinearSolid::plane(&moduli, PlaneMode::PlaneStress, RHO, OMEGA).expect("model");
    let material = Ordinary::new(Strained::<_, 2, 3>::plane(lps, &stiffness, OMEGA));
    let strengths = Strengths { along: 100e6, across: 100e6, shear: 58e6 };
    let grid = Grid::new(&Cuboid::centred([20.0, 8.0]).expect("box"), 1.0).expect("grid");
    let family = Lattice::<f64, 2>::new(&grid, Horizon::Cells(3.0), Quadrature::None).expect("f");
    let policy = Breaking::new(TsaiHill::new(&strengths, 0.0).expect("criterion"));
    let mut body = Body::new(family, material, policy).expect("body");
    for (stress, breaks) in [(99e6, false), (101e6, true)] {
        // Uniaxial stress: ε_x = σ/E, ε_y = −νσ/E.
        let strain = stress / moduli.young();
        body.set_displacement(|x| [strain * x[0], -0.25 * strain * x[1]].into());
        body.evaluate_and_break(1, &mut ()).expect("step");
        assert_eq!(body.broken_bonds() > 0, breaks, "at {stress:e} Pa");
    }
}

/// Two regions and their interface with criteria of two kinds: each bond breaks by its own.
#[test]
fn criteria_of_two_kinds_per_region_and_interface() {
    let moduli = Isotropic::from_young_poisson(7e10, 0.25).expect("moduli");
    let stiffness = isotropic(&moduli);
    let lps = LinearSolid::plane(&moduli, PlaneMode::PlaneStress, RHO, OMEGA).expect("model");
    let material = Ordinary::new(Strained::<_, 2, 3>::plane(lps, &stiffness, OMEGA));
    let grid = Grid::new(&Cuboid::centred([20.0, 8.0]).expect("box"), 1.0).expect("grid");
    let region: Vec<u8> = (0..grid.len()).map(|i| u8::from(grid.position(i)[0] > 0.0)).collect();
    let strengths = |s: f64| Strengths { along: s, across: s, shear: s };
    let stress = |s: f64| Either::Second(TsaiHill::new(&strengths(s), 0.0).expect("criterion"));
    let stretch = |s: f64| Either::First(CriticalStretch::new(s).expect("criterion"));
    // What breaks at a uniform strain of 1e-3 (about 70 MPa): the cell of the table below 70 MPa
    // or 1e-3.
    for (weak, table) in [
        ((0, 0), [[stretch(9e-4), stress(1e9)], [stress(1e9), stress(1e9)]]),
        ((0, 1), [[stretch(2e-3), stress(5e7)], [stress(5e7), stress(1e9)]]),
        ((1, 1), [[stretch(2e-3), stress(1e9)], [stress(1e9), stress(5e7)]]),
    ] {
        let family = Lattice::<f64, 2>::new(&grid, Horizon::Cells(3.0), Quadrature::None);
        let criterion = Interfaces::new(table, region.clone()).expect("criterion");
        let policy = Breaking::new(criterion);
        let mut body = Body::new(family.expect("family"), &material, policy).expect("body");
        body.set_displacement(|x| [1e-3 * x[0], 0.0].into());
        body.evaluate_and_break(1, &mut ()).expect("step");
        let mut broken = [[0, 0], [0, 0]];
        for node in 0..body.nodes() {
            body.neighbours(node, |n| {
                let (a, b) = (usize::from(region[node]), usize::from(region[n.node]));
                broken[a.min(b)][a.max(b)] += usize::from(!n.intact);
            });
        }
        for (a, b) in [(0, 0), (0, 1), (1, 1)] {
            assert_eq!(broken[a][b] > 0, (a, b) == weak, "{broken:?}, weak {weak:?}");
        }
    }
}
