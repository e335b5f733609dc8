//! The extremes. Whatever is asked for, the outcome is a right answer or a typed error: never NaN, a
//! hang or a number that is silently wrong. One file per extreme; one program, so that the bodies of
//! every material (`pd_testkit::specimen`) are compiled once.
mod families;
mod horizons;
mod neo_hookean;
mod scales;
mod spinning_body;
mod steps;
mod stiffness;
mod strains;
mod unstable_before_run;

use pd_testkit::generate::cloud;
use pd_testkit::specimen::{Named, Recipe, Specimen, Tear};
use peridynamics::models::elasticity::catalogue::GLASS_EPOXY;
use peridynamics::prelude::*;
use proptest::test_runner::{Config as ProptestConfig, RngSeed};

const DX: f64 = 1e-3;
/// Speed of waves along the plates and blocks below, about, in m/s.
const C: f64 = 5300.0;

/// A plate of 8 × 6 nodes; materials of every kind are stable in it.
fn plate() -> Recipe<2> {
    Recipe {
        stiffness: Stiffness::<2>::lamina(&GLASS_EPOXY).expect("ply").rotated(0.4),
        moduli: Isotropic::from_young_poisson(70e9, 0.3).expect("moduli"),
        density: 2500.0,
        influence: InfluenceFunction::Gaussian,
        points: cloud([8, 6], DX, 0.0, 1.0, 0).expect("points"),
        horizon: 2.5 * DX,
        tear: Tear::NEVER,
    }
}

/// A block of 5 × 4 × 4 nodes.
fn block() -> Recipe<3> {
    let glass = TransverselyIsotropic { e1: 44e9, e2: 10.5e9, g12: 3.74e9, nu12: 0.36, nu23: 0.4 };
    Recipe {
        stiffness: Stiffness::<3>::transversely_isotropic(&glass).expect("solid"),
        moduli: Isotropic::from_young_poisson(70e9, 0.3).expect("moduli"),
        density: 2500.0,
        influence: InfluenceFunction::Gaussian,
        points: cloud([5, 4, 4], DX, 0.0, 1.0, 0).expect("points"),
        horizon: 2.0 * DX,
        tear: Tear::NEVER,
    }
}

/// A smooth displacement or velocity of this size per Δx.
fn wavy<const D: usize>(x: &SVector<f64, D>, size: f64) -> SVector<f64, D> {
    SVector::from_fn(|d, _| {
        let phase: f64 = (0..D).map(|k| (0.3 + 0.2 * (k + d) as f64) * x[k] / DX).sum();
        size * (phase + d as f64).sin()
    })
}

/// Nodes with the smallest and the largest x.
fn ends<const D: usize>(points: &Points<D>) -> [NodeSet; 2] {
    let x = |i: usize| points.position(i)[0];
    let n = points.len();
    let (low, high) = (0..n).fold((f64::MAX, f64::MIN), |(a, b), i| (a.min(x(i)), b.max(x(i))));
    let near = 0.4 * points.spacing();
    [low, high].map(|place| {
        NodeSet::from_nodes((0..n).filter(|&i| (x(i) - place).abs() < near), n).expect("set")
    })
}

/// The specimens that exist; the others were refused with an error that says something.
fn existing<const D: usize>(list: Vec<Named<D>>) -> Vec<(&'static str, Box<dyn Specimen<D>>)> {
    assert!(!list.is_empty());
    let exists = |Named { name, body }| match body {
        Ok(body) => Some((name, body)),
        Err(error) => {
            println!("{name}: {error}");
            None
        }
    };
    list.into_iter().filter_map(exists).collect()
}

/// All specimens, none of which may be refused.
fn all<const D: usize>(list: Vec<Named<D>>) -> Vec<(&'static str, Box<dyn Specimen<D>>)> {
    let count = list.len();
    let found = existing(list);
    assert_eq!(found.len(), count, "a material was refused");
    found
}

/// This many cases at random, the same in every run.
fn cases(cases: u32) -> ProptestConfig {
    let rng_seed = RngSeed::Fixed(17);
    ProptestConfig { cases, rng_seed, failure_persistence: None, ..ProptestConfig::default() }
}

/// Names of materials with exactly the stiffness C at every node.
const EXACT: [&str; 6] = [
    "positive split",
    "strained positive split",
    "correspondence",
    "correspondence, Wan",
    "correspondence, Silling",
    "bond-associated",
];
