//! The body's own time step beside the estimates of books.
use peridynamics::core::time_step::classical;
use peridynamics::models::elasticity::catalogue::{GRAPHITE_EPOXY, HTA_6376};
use peridynamics::prelude::*;

const DX: f64 = 1e-3;
const RHO: f64 = 1586.0;
const NONE: Quadrature = Quadrature::None;

fn estimates<M: Material<f64, 2>>(material: &M, m: f64, c: &Stiffness<2>) -> TimeStepEstimates {
    let grid = Grid::new(&Cuboid::centred([20.0 * DX, 20.0 * DX]).expect("box"), DX).expect("grid");
    let family = Lattice::<f64, 2>::new(&grid, Horizon::Cells(m), NONE).expect("family");
    let mut body = Body::new(family, material, NoDamage).expect("body");
    let symbol = Symbol::of(material, DX, Horizon::Cells(m), NONE).expect("symbol");
    let speed = c.max_wave_speed(RHO).expect("speed");
    let found = TimeStepEstimates::new(&mut body, &symbol, speed).expect("estimates");
    println!("{found}");
    assert!(found.gershgorin <= found.bulk * (1.0 + 1e-12), "a bound");
    assert!((found.courant - m * DX / speed).abs() < 1e-12 * found.courant);
    assert!((found.hattori - 0.01 * found.courant).abs() < 1e-12 * found.courant);
    found
}

#[test]
fn bond_based() {
    let third = Isotropic::from_young_poisson(7e10, 1.0 / 3.0).expect("moduli");
    let stress = PlaneMode::PlaneStress;
    let pmb = Pmb::plane(&third, stress, RHO, InfluenceFunction::Constant).expect("material");
    let c = Stiffness::<2>::isotropic(&third, stress).expect("stiffness");
    let m = 4.0;
    let found = estimates(&Ordinary::new(pmb.clone()), m, &c);
    // Σ c V/|ξ| over the family, by hand.
    let mut sum = 0.0;
    for (i, j) in (-4_i32..=4).flat_map(|i| (-4_i32..=4).map(move |j| (i, j))) {
        let square = f64::from(i * i + j * j);
        if square > 0.0 && square <= m * m {
            sum += pmb.micromodulus(m * DX) * DX * DX / (square.sqrt() * DX);
        }
    }
    let exact = classical::silling_askari(RHO, sum);
    assert!((found.silling_askari / exact - 1.0).abs() < 1e-6, "{} {exact}", found.silling_askari);
    // "The exact limit is 1.7 times the Silling–Askari estimate for PMB at m = 4."
    let ratio = found.bulk / found.silling_askari;
    assert!((ratio - 1.7).abs() < 0.05, "{ratio}");
    // δ/c is too long a step for it.
    assert!(found.courant > 1.3 * found.bulk && found.courant > 1.3 * found.body);
}

/// "The exact limit is 30 to 110 times Hattori's step for his materials."
#[test]
fn correspondence() {
    let mut ratios = Vec::new();
    for ply in [GRAPHITE_EPOXY, HTA_6376] {
        for (m, degrees) in [(2.0, 0.0), (3.0, 0.0), (3.0, 45.0)] {
            let c = Stiffness::<2>::lamina(&ply).expect("ply").rotated(f64::to_radians(degrees));
            let law = LinearElastic(c);
            let material = Correspondence::new(law, RHO, InfluenceFunction::Linear).expect("m");
            let found = estimates(&material, m, &c);
            // His c_p is √(C22/ρ), which is not the fastest wave (errata 000-15).
            let own = (c.voigt()[(1, 1)] / RHO).sqrt();
            ratios.push(found.bulk / classical::hattori(m * DX, own));
            assert!(found.bulk > 90.0 * found.hattori);
            assert!(found.body < 0.9 * found.bulk, "free surfaces lower it");
            let text = found.to_string();
            assert!(text.contains("this body, 2/ω_max") && text.lines().count() == 7, "{text}");
        }
    }
    println!("bulk over Hattori's: {ratios:.1?}");
    assert!(ratios.iter().all(|r| (25.0..115.0).contains(r)), "{ratios:?}");
}

#[test]
fn nonsense_is_refused() {
    let third = Isotropic::from_young_poisson(7e10, 1.0 / 3.0).expect("moduli");
    let stress = PlaneMode::PlaneStress;
    let pmb = Pmb::plane(&third, stress, RHO, InfluenceFunction::Constant).expect("material");
    let material = Ordinary::new(pmb);
    let grid = Grid::new(&Cuboid::centred([9.0 * DX, 9.0 * DX]).expect("box"), DX).expect("grid");
    let family = Lattice::<f64, 2>::new(&grid, Horizon::Cells(2.0), NONE).expect("family");
    let symbol = Symbol::of(&material, DX, Horizon::Cells(2.0), NONE).expect("symbol");
    let mut body = Body::new(family, material, NoDamage).expect("body");
    for speed in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let refused = TimeStepEstimates::new(&mut body, &symbol, speed).err();
        assert!(matches!(refused, Some(Error::InvalidValue { .. })), "{speed}: {refused:?}");
    }
}
