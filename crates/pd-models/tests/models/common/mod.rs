//! Shared by the tests of the symbol.
#![allow(dead_code)]

pub mod random;

use nalgebra::SVector;
use pd_core::{Horizon, InfluenceFunction, Material, Quadrature, Symbol};
use pd_models::elasticity::catalogue::{
    GLASS_EPOXY, GRAPHITE_EPOXY, GRAPHITE_FABRIC_CARBON, HTA_6376,
};
use pd_models::{Ordinary, PolynomialMicromoduli, PositiveSplit, Stiffness};
use std::f64::consts::PI;

pub const DENSITY: f64 = 1586.0;
pub const DX: f64 = 1e-3;

/// The plies of the table in the physics notes, with the fibre angles listed there.
pub fn plies() -> Vec<(&'static str, f64, Stiffness<2>)> {
    [
        ("graphite fabric–carbon", 0.0, GRAPHITE_FABRIC_CARBON),
        ("graphite fabric–carbon", 45.0, GRAPHITE_FABRIC_CARBON),
        ("graphite–epoxy", 0.0, GRAPHITE_EPOXY),
        ("HTA/6376", 0.0, HTA_6376),
        ("HTA/6376", 45.0, HTA_6376),
        ("glass–epoxy", 0.0, GLASS_EPOXY),
        ("glass–epoxy", 45.0, GLASS_EPOXY),
    ]
    .map(|(name, degrees, ply): (_, f64, _)| {
        let stiffness = Stiffness::<2>::lamina(&ply).unwrap().rotated(degrees.to_radians());
        (name, degrees, stiffness)
    })
    .to_vec()
}

/// The kernels of that table.
pub const KERNELS: [(f64, InfluenceFunction); 3] = [
    (3.0, InfluenceFunction::Gaussian),
    (3.0, InfluenceFunction::Linear),
    (5.0, InfluenceFunction::Gaussian),
];

pub fn symbol<const D: usize, M: Material<f64, D>>(
    material: &M,
    m: f64,
    quadrature: Quadrature,
) -> Symbol<D> {
    Symbol::of(material, DX, Horizon::Cells(m), quadrature).unwrap()
}

pub fn polynomial(c: &Stiffness<2>, m: f64, influence: InfluenceFunction) -> Symbol<2> {
    let model = PolynomialMicromoduli::plane(c, DENSITY, influence).unwrap();
    symbol(&Ordinary::new(model), m, Quadrature::None)
}

pub fn split(c: &Stiffness<2>, m: f64, influence: InfluenceFunction) -> Symbol<2> {
    let model = PositiveSplit::plane(c, DENSITY, influence).unwrap();
    symbol(&Ordinary::new(model), m, Quadrature::None)
}

/// Smallest and largest eigenvalue of ρ D(k) in Pa/Δx², and the share of negative ones, on the
/// grid of n + 1 points per axis over the half zone of non-negative last component; k = 0 is
/// left out of the smallest.
pub fn on_grid<const D: usize>(symbol: &Symbol<D>, n: usize) -> (f64, f64, f64) {
    let step = 2.0 * PI / n as f64;
    let along = |d: usize| if d == D - 1 { n / 2 + 1 } else { n + 1 };
    let total: usize = (0..D).map(along).product();
    let (mut smallest, mut largest, mut negative) = (f64::INFINITY, 0.0_f64, 0);
    for index in 0..total {
        let mut rest = index;
        let phases = SVector::<f64, D>::from_fn(|d, _| {
            let i = rest % along(d);
            rest /= along(d);
            let start = if d == D - 1 { 0.0 } else { (n / 2) as f64 };
            (i as f64 - start) * step
        });
        let modes = symbol.eigen(&(phases / DX));
        largest = largest.max(modes[D - 1].eigenvalue);
        if phases.norm() > 0.0 {
            smallest = smallest.min(modes[0].eigenvalue);
            negative += usize::from(modes[0].eigenvalue < 0.0);
        }
    }
    let scale = DENSITY * DX * DX;
    (smallest * scale, largest * scale, negative as f64 / (total - 1) as f64)
}
