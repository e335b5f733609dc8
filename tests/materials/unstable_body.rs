//! A run refuses a body with motions that grow at any time step, and names ω² and the wave; it
//! refuses no other.
use crate::common;
use peridynamics::models::elasticity::catalogue::{GLASS_EPOXY, HTA_6376};
use peridynamics::prelude::*;

const DX: f64 = 1e-3;
const GAUSS: InfluenceFunction = InfluenceFunction::Gaussian;

fn polynomial(
    ply: &Lamina,
    degrees: f64,
) -> Ordinary<PolynomialMicromoduli<2, 1>, peridynamics::models::Linearised> {
    let c = Stiffness::<2>::lamina(ply).expect("ply").rotated(degrees.to_radians());
    Ordinary::linearised(PolynomialMicromoduli::plane(&c, 1586.0, GAUSS).expect("material"))
}

fn plate<T: Real, M: Material<T, 2>>(
    material: M,
    m: f64,
) -> Body<T, 2, Lattice<T, 2>, M, NoDamage> {
    let grid = Grid::new(&Cuboid::centred([40.0 * DX, 40.0 * DX]).expect("box"), DX).expect("grid");
    let family = Lattice::new(&grid, Horizon::Cells(m), Quadrature::None).expect("family");
    Body::new(family, material, NoDamage).expect("body")
}

fn refusal<T: Real, const D: usize, B: Dynamics<T, D>>(body: &mut B) -> Option<Error> {
    Run::new(body, Loads::new(), TimeStep::Safety(0.5)).err()
}

/// The error's ω² and wave are about those of the infinite lattice.
fn like_the_symbol<const D: usize>(error: Option<Error>, symbol: &Symbol<D>) {
    let Some(Error::UnstableBody { eigenvalue, wave, growth_rate }) = error else {
        panic!("{error:?}")
    };
    let extremes = symbol.extremes(if D == 3 { 24 } else { 120 });
    let (softest, largest) = (extremes.softest, extremes.stiffest.eigenvalue);
    println!(
        "ω² = {eigenvalue:.3e}, wave {wave:.0?}; lattice {:.3e}, {:.0?}",
        softest.eigenvalue,
        softest.wave.as_slice()
    );
    assert!(eigenvalue < -1e-3 * largest);
    assert!((growth_rate.powi(2) + eigenvalue).abs() < 1e-9 * largest);
    // Of the same size, and a wave that the symbol amplifies too.
    assert!(eigenvalue > 2.5 * softest.eigenvalue, "{eigenvalue:e}");
    let own = symbol.eigen(&SVector::from_column_slice(&wave))[0].eigenvalue;
    assert!(own < 0.3 * softest.eigenvalue, "{own:e} {:e}", softest.eigenvalue);
}

#[test]
fn polynomial_micromoduli_of_carbon_are_refused() {
    for degrees in [0.0, 45.0] {
        let material = polynomial(&HTA_6376, degrees);
        let horizon = Horizon::Cells(3.0);
        let symbol = Symbol::of(&material, DX, horizon, Quadrature::None).expect("symbol");
        like_the_symbol(refusal(&mut plate::<f64, _>(&material, 3.0)), &symbol);
        like_the_symbol(refusal(&mut plate::<f32, _>(&material, 3.0)), &symbol);
    }
}

#[test]
fn in_space_too() {
    let model = PolynomialMicromoduli::solid(&common::solid(), 1586.0, GAUSS).expect("material");
    let material = Ordinary::linearised(model);
    let horizon = Horizon::Cells(3.0);
    let symbol = Symbol::of(&material, DX, horizon, Quadrature::None).expect("symbol");
    let grid = Grid::new(&Cuboid::centred([14.0 * DX; 3]).expect("box"), DX).expect("grid");
    let family = Lattice::<f64, 3>::new(&grid, horizon, Quadrature::None).expect("family");
    like_the_symbol(refusal(&mut Body::new(family, &material, NoDamage).expect("body")), &symbol);
}

#[test]
fn who_asks_for_it_gets_it() {
    let mut body = plate::<f64, _>(polynomial(&HTA_6376, 0.0), 3.0);
    let Some(Error::UnstableBody { growth_rate, .. }) = refusal(&mut body) else { panic!() };
    body.set_velocity(|x| common::wavy(x, DX, 1e-6));
    let dt = 1e-8;
    let mut run = Run::new(&mut body, Loads::new(), TimeStep::Unchecked(dt)).expect("run");
    let size = |body: &dyn Fn(usize) -> SVector<f64, 2>| {
        (0..1600).map(|i| body(i).norm_squared()).sum::<f64>().sqrt()
    };
    let steps = (15.0 / (growth_rate * dt)) as usize;
    run.steps_more(steps).expect("steps");
    let early = size(&|i| run.body().displacement(i));
    run.steps_more(steps / 5).expect("steps");
    let rate = (size(&|i| run.body().displacement(i)) / early).ln() / (steps / 5) as f64 / dt;
    // The body's fastest motion grows at this rate or faster.
    println!("grows at {rate:.3e} 1/s, named {growth_rate:.3e}");
    assert!(rate > 0.97 * growth_rate && rate < 1.3 * growth_rate, "{rate:e} {growth_rate:e}");
}

#[test]
fn stable_bodies_pass() {
    let pass = |error: Option<Error>| assert!(error.is_none(), "{error:?}");
    pass(refusal(&mut plate::<f64, _>(polynomial(&GLASS_EPOXY, 40.0), 5.0)));
    pass(refusal(&mut plate::<f32, _>(polynomial(&GLASS_EPOXY, 40.0), 5.0)));
    // Zero-energy modes are no growth, in single precision either.
    let law = LinearElastic(common::ply());
    let bare = Correspondence::new(law, 1586.0, InfluenceFunction::Linear).expect("material");
    pass(refusal(&mut plate::<f64, _>(&bare, 3.0)));
    pass(refusal(&mut plate::<f32, _>(&bare, 3.0)));
    let split = PositiveSplit::plane(&common::ply(), 1586.0, GAUSS).expect("material");
    let split = Ordinary::new(split);
    pass(refusal(&mut plate::<f64, _>(&split, 3.0)));
    pass(refusal(&mut plate::<f32, _>(&split, 3.0)));
}
