//! Bodies that several property tests share.
#![allow(dead_code)]

use peridynamics::prelude::*;

/// A disc with a hole: outlines that are no boxes.
pub fn ring(dx: f64) -> Grid<2> {
    let shape = Disc::new([0.0, 0.0], 9.3 * dx).expect("disc");
    let hole = Disc::new([2.0 * dx, 0.0], 2.6 * dx).expect("hole");
    Grid::new(&shape.without(hole), dx).expect("grid")
}

/// A block with a cylindrical hole.
pub fn block(dx: f64) -> Grid<3> {
    let shape = Cuboid::centred([9.0 * dx, 7.0 * dx, 8.0 * dx]).expect("box");
    let hole = Cylinder::new([0.0, 0.0, -5.0 * dx], [0.0, 0.0, 5.0 * dx], 1.6 * dx).expect("hole");
    Grid::new(&shape.without(hole), dx).expect("grid")
}

pub fn ply() -> Stiffness<2> {
    let ply = Lamina { e1: 136e9, e2: 8.75e9, g12: 5.5e9, nu12: 0.3 };
    Stiffness::<2>::lamina(&ply).expect("ply").rotated(0.6)
}

pub fn solid() -> Stiffness<3> {
    let solid = TransverselyIsotropic { e1: 136e9, e2: 8.75e9, g12: 5.5e9, nu12: 0.3, nu23: 0.4 };
    Stiffness::<3>::transversely_isotropic(&solid).expect("solid").rotated_about_z(0.6)
}

/// A smooth displacement field of about `size`.
pub fn wavy<const D: usize>(x: &SVector<f64, D>, dx: f64, size: f64) -> SVector<f64, D> {
    SVector::from_fn(|d, _| {
        let phase: f64 = (0..D).map(|k| (0.3 + 0.2 * (k + d) as f64) * x[k] / dx).sum();
        size * (phase + d as f64).sin()
    })
}

pub const RHO: f64 = 1586.0;
pub const OMEGA: InfluenceFunction = InfluenceFunction::Gaussian;

/// Calls `$check!(material, grid)` for every material in 2D and 3D.
#[macro_export]
macro_rules! for_every_material {
    ($check:ident, $dx:expr) => {{
        use peridynamics::prelude::*;
        use $crate::common::*;
        let third = Isotropic::from_young_poisson(7e10, 1.0 / 3.0).expect("moduli");
        let quarter = Isotropic::from_young_poisson(7e10, 0.25).expect("moduli");
        let stress = PlaneMode::PlaneStress;
        let (flat, deep) = (ring($dx), block($dx));
        let _ = (&flat, &deep); // not every check needs a body
        $check!(Ordinary::new(Pmb::plane(&third, stress, RHO, OMEGA).expect("m")), flat, 2);
        $check!(Ordinary::new(Pmb::solid(&quarter, RHO, OMEGA).expect("m")), deep, 3);
        let on_family = || Pmb::solid(&quarter, RHO, OMEGA).expect("m").on_family();
        $check!(Ordinary::new(on_family()), deep, 3);
        $check!(Ordinary::new(LinearSolid::plane(&third, stress, RHO, OMEGA).expect("m")), flat, 2);
        $check!(Ordinary::linearised(LinearSolid::solid(&third, RHO, OMEGA).expect("m")), deep, 3);
        $check!(Ordinary::new(MadenciOterkus::plane(&third, stress, RHO).expect("m")), flat, 2);
        let polynomial = || PolynomialMicromoduli::plane(&ply(), RHO, OMEGA).expect("m");
        $check!(Ordinary::new(polynomial()), flat, 2);
        let polynomial = || PolynomialMicromoduli::solid(&solid(), RHO, OMEGA).expect("m");
        $check!(Ordinary::new(polynomial()), deep, 3);
        $check!(Ordinary::new(PositiveSplit::plane(&ply(), RHO, OMEGA).expect("m")), flat, 2);
        $check!(Ordinary::new(PositiveSplit::solid(&solid(), RHO, OMEGA).expect("m")), deep, 3);
        let small = || Correspondence::new(LinearElastic(ply()), RHO, OMEGA).expect("m");
        $check!(small(), flat, 2);
        $check!(small().with_control(WanControl::new(&ply(), 1.0).expect("c")), flat, 2);
        $check!(small().with_control(SillingControl::new(1e10, 1.0).expect("c")), flat, 2);
        $check!(BondAssociated::<2, 3>::new(&ply(), RHO, OMEGA).expect("m"), flat, 2);
        $check!(BondAssociated::<3, 6>::new(&solid(), RHO, OMEGA).expect("m"), deep, 3);
        let finite = || SaintVenantKirchhoff(solid());
        $check!(Correspondence::new(finite(), RHO, OMEGA).expect("m"), deep, 3);
        $check!(Correspondence::new(NeoHookean::new(&third), RHO, OMEGA).expect("m"), deep, 3);
    }};
}

/// V K of a body about its reference configuration, column by column from differences of forces:
/// dense, in N/m per unit of u in Δx, rows and columns D·node + axis.
pub fn dense_stiffness<T, const D: usize, B>(body: &mut B) -> nalgebra::DMatrix<f64>
where
    T: Real,
    B: Dynamics<T, D>,
{
    let n = D * body.nodes();
    let step = T::EPSILON.cbrt();
    let mut k = nalgebra::DMatrix::zeros(n, n);
    for column in 0..n {
        let site = body.site(column / D);
        for sign in [1.0, -1.0] {
            let mut u = SVector::zeros();
            u[column % D] = T::of(sign * step);
            body.u_mut().set(site, u);
            body.evaluate().expect("forces");
            for node in 0..body.nodes() {
                let f = body.force().get(body.site(node)).map(Real::to_f64);
                for axis in 0..D {
                    k[(D * node + axis, column)] -=
                        sign * f[axis] * body.volume(node) / (2.0 * step);
                }
            }
        }
        body.u_mut().set(site, SVector::zeros());
    }
    k
}
