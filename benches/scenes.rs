//! The scenes that are timed: model × layout × dimension, and what is wanted of them.

use peridynamics::prelude::*;

/// Horizon in cells.
pub const M: f64 = 3.015;
/// Density in kg/m³.
pub const RHO: f64 = 1000.0;

/// What is done with every scene.
pub trait Visit {
    /// `target` is the wanted ns per directed bond and step, on a Xeon of 2.8 GHz.
    fn scene<T, const D: usize, F, M, P>(
        &mut self,
        name: &str,
        target: f64,
        body: impl FnOnce() -> Result<Body<T, D, F, M, P>>,
    ) where
        T: Real,
        F: Family<T, D>,
        M: Material<T, D>,
        P: DamagePolicy<T, D, M>;
}

/// Shows every scene with scalar T, squares and cubes of `edges` cells.
pub fn all<T: Real>([flat, deep]: [usize; 2], visit: &mut impl Visit) {
    let (flat, deep) = (grid::<2>(flat), grid::<3>(deep));
    let third = Isotropic::from_young_poisson(1e9, 1.0 / 3.0).expect("moduli");
    let quarter = Isotropic::from_young_poisson(1e9, 0.25).expect("moduli");
    let (mode, omega) = (PlaneMode::PlaneStress, InfluenceFunction::Constant);
    let plane = Stiffness::<2>::isotropic(&third, mode).expect("stiffness");
    let solid = Stiffness::<3>::isotropic(&quarter).expect("stiffness");
    // Targets are for f64; f32 is wanted at 0.55 of them.
    let share = if T::NAME == "f32" { 0.55 } else { 1.0 };
    macro_rules! both {
        ($name:literal, $model2:expr, $model3:expr, $lattice:literal, $cloud:literal) => {{
            let (name, target) = (|d| format!("{}, lattice, {d}D", $name), share * $lattice);
            visit.scene(&name(2), target, || Body::new(lattice::<T, 2>(&flat), $model2, stretch()));
            visit.scene(&name(3), target, || Body::new(lattice::<T, 3>(&deep), $model3, stretch()));
            let (name, target) = (concat!($name, ", cloud, 3D"), share * $cloud);
            visit.scene(name, target, || Body::new(cloud::<T, 3>(&deep), $model3, stretch()));
        }};
    }
    both!(
        "PMB",
        Ordinary::new(Pmb::plane(&third, mode, RHO, omega).expect("model")),
        Ordinary::new(Pmb::solid(&quarter, RHO, omega).expect("model")),
        0.9,
        3.5
    );
    both!(
        "LPS",
        Ordinary::new(LinearSolid::plane(&third, mode, RHO, omega).expect("model")),
        Ordinary::new(LinearSolid::solid(&quarter, RHO, omega).expect("model")),
        1.6,
        7.0
    );
    both!(
        "OSB polynomial",
        Ordinary::new(PolynomialMicromoduli::plane(&plane, RHO, omega).expect("model")),
        Ordinary::new(PolynomialMicromoduli::solid(&solid, RHO, omega).expect("model")),
        2.5,
        10.0
    );
    both!(
        "OSB positive split",
        Ordinary::new(PositiveSplit::plane(&plane, RHO, omega).expect("model")),
        Ordinary::new(PositiveSplit::solid(&solid, RHO, omega).expect("model")),
        2.5,
        10.0
    );
    both!(
        "NOSB with Wan control",
        Correspondence::new(LinearElastic(plane), RHO, InfluenceFunction::Linear)
            .expect("model")
            .with_control(WanControl::new(&plane, 1.0).expect("control")),
        Correspondence::new(LinearElastic(solid), RHO, InfluenceFunction::Linear)
            .expect("model")
            .with_control(WanControl::new(&solid, 1.0).expect("control")),
        2.6,
        9.0
    );
    let pmb = || Ordinary::linearised(Pmb::solid(&quarter, RHO, omega).expect("model"));
    visit.scene("PMB linearised, no damage, lattice, 3D", share * 0.6, || {
        Body::new(lattice::<T, 3>(&deep), pmb(), NoDamage)
    });
    let lps = || Ordinary::linearised(LinearSolid::solid(&quarter, RHO, omega).expect("model"));
    visit.scene("LPS linearised, no damage, lattice, 3D", share * 1.1, || {
        Body::new(lattice::<T, 3>(&deep), lps(), NoDamage)
    });
}

/// A smooth displacement, small against Δx = 1.
pub fn wave<T, const D: usize, F, M, P>(body: &mut Body<T, D, F, M, P>)
where
    T: Real,
    F: Family<T, D>,
    M: Material<T, D>,
    P: DamagePolicy<T, D, M>,
{
    body.set_displacement(|x| {
        SVector::from_fn(|d, _| 1e-4 * ((0.1 + 0.05 * d as f64) * x.sum()).sin())
    });
}

/// A square or cube of unit cells.
pub fn grid<const D: usize>(cells: usize) -> Grid<D> {
    Grid::lattice(SVector::zeros(), SVector::repeat(1.0), [cells; D]).expect("grid")
}

/// The lattice of a grid.
pub fn lattice<T: Real, const D: usize>(grid: &Grid<D>) -> Lattice<T, D> {
    Lattice::new(grid, Horizon::Cells(M), Quadrature::None).expect("family")
}

/// The cloud of the nodes of a grid.
pub fn cloud<T: Real, const D: usize>(grid: &Grid<D>) -> Cloud<T, D> {
    Cloud::new(&Points::from_grid(grid), Horizon::Cells(M), Quadrature::None).expect("family")
}

/// A criterion that is tested in every step and breaks nothing.
pub fn stretch<const D: usize>() -> Breaking<CriticalStretch, D> {
    Breaking::new(CriticalStretch::new(1.0).expect("criterion"))
}
