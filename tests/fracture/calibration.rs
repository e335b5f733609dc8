//! Critical values against independent closed forms and sums (`tests/data/pd/constants.json`).

use pd_testkit::oracle::Case;
use peridynamics::prelude::*;
use serde_json::Value;

fn close(got: f64, reference: &Value, tolerance: f64, what: &str) {
    let reference = reference.as_f64().unwrap_or_else(|| panic!("no {what}"));
    assert!((got / reference - 1.0).abs() < tolerance, "{what}: {got:e}, reference {reference:e}");
}

const INFLUENCES: [(&str, InfluenceFunction); 4] = [
    ("unit", InfluenceFunction::Constant),
    ("linear", InfluenceFunction::Linear),
    ("gauss", InfluenceFunction::Gaussian),
    ("inverse", InfluenceFunction::Inverse),
];

fn moduli(young: f64, nu: f64) -> Isotropic {
    Isotropic::from_young_poisson(young, nu).expect("moduli")
}

/// s_c and w_C of the continuum for one dimension and mode.
fn continuum<const D: usize>(mode: &str, bulk: impl Fn(&Isotropic) -> f64) {
    let case = Case::read("constants");
    let (young, delta, h) = (case.number("E"), case.number("delta"), case.number("h"));
    let energy = FractureEnergy::new(case.number("G0")).expect("G");
    let plane = CrackPlane::<D>::continuum(delta).expect("plane");
    let reference = &case.json["modes"][mode];
    let stretch = |model: &BondModel| {
        CriticalStretch::from_energy(energy, model, &plane).expect("s_c").stretch()
    };

    let pmb = moduli(young, reference["pmb"]["nu"].as_f64().expect("nu"));
    for (name, omega) in [("unit", INFLUENCES[0].1), ("conical", INFLUENCES[1].1)] {
        let model = BondModel::pmb(bulk(&pmb), omega).expect("model");
        close(stretch(&model), &reference["pmb"][name]["s_c"], 1e-12, name);
    }
    for nu in ["0.1", "0.2", "0.3"] {
        let own = &reference["lps"][format!("nu={nu}")];
        let m = moduli(young, nu.parse().expect("nu"));
        for (name, omega) in INFLUENCES {
            let model = BondModel::linear_solid(bulk(&m), m.shear(), omega).expect("model");
            close(stretch(&model), &own["s_c_crossing"][name]["s_c"], 1e-8, name);
        }
        let model = BondModel::madenci_oterkus(bulk(&m), m.shear()).expect("model");
        close(stretch(&model), &own["s_c_mo_exact_mean_square"], 1e-8, "Madenci–Oterkus");
        let printed = if D == 2 {
            CriticalStretch::willberg_plane(energy, bulk(&m), m.shear(), delta)
        } else {
            CriticalStretch::willberg_solid(energy, bulk(&m), m.shear(), delta)
        };
        let printed = printed.expect("s_c").stretch();
        close(printed, &own["s_c_madenci_oterkus"], 1e-12, "Willberg 5-4");
    }
    // Bodies are per unit thickness in 2D.
    let thickness = if D == 2 { h } else { 1.0 };
    let uniform = BondEnergy::from_energy(energy, &plane).expect("w_C").critical();
    close(uniform / thickness, &reference["w_C"]["uniform"], 1e-12, "w_C");
    for (name, omega) in INFLUENCES {
        let w0 = BondEnergy::weighted(energy, &plane, omega).expect("w0").critical();
        close(w0 / thickness, &reference["w_C"][format!("w0_{name}")], 1e-12, name);
    }
}

#[test]
fn of_the_continuum() {
    continuum::<2>("plane_stress", |m| m.plane_bulk(PlaneMode::PlaneStress));
    continuum::<2>("plane_strain", |m| m.plane_bulk(PlaneMode::PlaneStrain));
    continuum::<3>("3d", Isotropic::bulk);
}

/// Critical openings: for PMB with ω = 1, Δ_cr² = G₀δ/(3K) in 3D and 2G₀/(hcδ²) in 2D
/// (errata 001-8), and for cracks the formulas of Zhao's paper.
#[test]
fn openings() {
    let (g, delta, bulk) = (100.0, 3e-3, 4e10);
    let energy = FractureEnergy::new(g).expect("G");
    let model = BondModel::pmb(bulk, InfluenceFunction::Constant).expect("model");
    let solid = CrackPlane::<3>::continuum(delta).expect("plane");
    let opening = CrackOpening::from_energy(energy, &model, &solid).expect("Δ").opening();
    let exact: f64 = g * delta / (3.0 * bulk);
    assert!((opening / exact.sqrt() - 1.0).abs() < 1e-12);
    let plate = CrackPlane::<2>::continuum(delta).expect("plane");
    let c = 12.0 * bulk / (std::f64::consts::PI * delta.powi(3));
    let opening = CrackOpening::from_energy(energy, &model, &plate).expect("Δ").opening();
    assert!((opening / (2.0 * g / (c * delta * delta)).sqrt() - 1.0).abs() < 1e-12);

    let cases = Case::read("damage_bonds");
    for case in cases.json["cod_critical_values"].as_array().expect("cases") {
        let get = |key: &str| case[key].as_f64().expect("number");
        let (sigma, tau, a, young) = (get("sigma"), get("tau"), get("a"), get("E"));
        let printed = CrackOpening::as_printed(sigma, tau, a, young).expect("Δ").opening();
        close(printed, &case["delta_eq19_printed"], 1e-12, "Eq. 19");
        let centre = CrackOpening::at_centre(sigma, tau, a, young).expect("Δ").opening();
        close(centre, &case["delta_eq19_vector"], 1e-12, "Eq. 19 with components");
        let tip = CrackOpening::dugdale(sigma, a, young, get("sigma_Y")).expect("Δ").opening();
        close(tip, &case["delta_tip_bcs_dugdale_mode_I"], 1e-12, "Dugdale");
    }
}

/// What cracks between rows of nodes cost on the lattice over the energy put in.
fn on_the_lattice<const D: usize>(young: f64, nu: f64, bulk: f64) {
    let cases = Case::read("constants");
    let dx = 1e-3;
    let mut count = 0;
    for case in cases.json["lattice_G_over_G0"].as_array().expect("cases") {
        let m = case["mbar"].as_f64().expect("m");
        if case["dim"].as_u64() != Some(D as u64) || D == 3 && m > 4.5 {
            continue;
        }
        let quadrature = match case["beta"].as_str() {
            Some("one") => Quadrature::None,
            Some("hhb") => Quadrature::ExtendedRamp,
            _ => Quadrature::Exact,
        };
        let grid = Grid::new(&Cuboid::centred([2.0 * dx; D]).expect("box"), dx).expect("grid");
        let family = Lattice::<f64, D>::new(&grid, Horizon::Cells(m), quadrature).expect("lattice");
        let lattice = CrackPlane::lattice(&family, std::array::from_fn(|d| f64::from(d == 0)));
        let lattice = lattice.expect("plane");
        let continuum = CrackPlane::continuum(m * dx).expect("plane");
        let g = FractureEnergy::new(100.0).expect("G");
        let w = |plane| BondEnergy::from_energy(g, plane).expect("w_C").critical();
        close(w(&continuum) / w(&lattice), &case["uniform_w_C"], 1e-9, "w_C");
        for (name, omega) in [
            ("pmb_s_c_unit", InfluenceFunction::Constant),
            ("pmb_s_c_conical", InfluenceFunction::Linear),
        ] {
            let model = BondModel::pmb(bulk, omega).expect("model");
            let s = |plane| CriticalStretch::from_energy(g, &model, plane).expect("s").stretch();
            let ratio = s(&continuum) / s(&lattice);
            close(ratio * ratio, &case[name], 1e-9, name);
        }
        count += 1;
    }
    assert!(count >= 12, "{count} cases of {D}D, E = {young:e}, ν = {nu}");
}

#[test]
fn on_the_lattice_of_the_body() {
    on_the_lattice::<2>(7e10, 1.0 / 3.0, 5.25e10);
    on_the_lattice::<3>(7e10, 0.25, 7e10 / 1.5);
}

/// A finer lattice comes to the continuum, for every model, dimension and direction of the crack.
#[test]
fn fine_lattices_come_to_the_continuum() {
    let error = |m: f64, normal: [f64; 2], omega: InfluenceFunction| {
        let (dx, delta) = (1e-3 / m, 1e-3);
        let grid = Grid::new(&Cuboid::centred([2.0 * dx, 2.0 * dx]).expect("b"), dx).expect("grid");
        let cells = Horizon::Cells(m);
        let family = Lattice::<f64, 2>::new(&grid, cells, Quadrature::Exact).expect("lattice");
        let lattice = CrackPlane::lattice(&family, normal).expect("plane");
        let continuum = CrackPlane::<2>::continuum(delta).expect("plane");
        let models = [
            BondModel::pmb(5e10, omega).expect("model"),
            BondModel::pmb_on_family(5e10, omega).expect("model"),
            BondModel::linear_solid(5e10, 3e10, omega).expect("model"),
            BondModel::madenci_oterkus(5e10, 3e10).expect("model"),
        ];
        let cost = |model: &BondModel, plane| model.cost(plane, |x| 1e-3 * x);
        let of = |m: &BondModel| (cost(m, &lattice) / cost(m, &continuum) - 1.0).abs();
        models.iter().map(of).fold(0.0, f64::max)
    };
    for normal in [[1.0, 0.0], [1.0, 1.0], [2.0, -1.0]] {
        for omega in [InfluenceFunction::Constant, InfluenceFunction::Gaussian] {
            let (coarse, fine) = (error(4.0, normal, omega), error(24.0, normal, omega));
            assert!(coarse < 0.1, "{normal:?} {omega:?}: {coarse}");
            assert!(fine < 0.012, "{normal:?} {omega:?}: {fine}");
        }
    }
}

/// Toughness and strength give the same critical values through the fracture energy.
#[test]
fn toughness_and_strength() {
    let (young, nu, k) = (70e9, 0.3, 1e6);
    let toughness = FractureToughness::new(k).expect("K");
    assert_eq!(toughness.in_plane_stress(young).expect("G").value(), k * k / young);
    let strain = toughness.in_plane_strain(young, nu).expect("G").value();
    assert!((strain / (k * k * 0.91 / young) - 1.0).abs() < 1e-14);

    let strength = BondStrength::new(50e6).expect("strength");
    let m = moduli(young, nu);
    let model = BondModel::linear_solid(m.bulk(), m.shear(), InfluenceFunction::Gaussian);
    let model = model.expect("model");
    let plane = CrackPlane::<3>::continuum(2e-3).expect("plane");
    let energy = strength.fracture_energy(young, &model, &plane).expect("G");
    let direct = CriticalStretch::from_strength(strength, young).expect("s").stretch();
    let through = CriticalStretch::from_energy(energy, &model, &plane).expect("s").stretch();
    assert!((direct / through - 1.0).abs() < 1e-12);

    assert!(FractureEnergy::new(0.0).is_err());
    assert!(toughness.in_plane_strain(young, 0.7).is_err());
    assert!(CrackOpening::dugdale(4e8, 5e-3, young, 3e8).is_err());
    assert!(BondStrength::new(f64::NAN).is_err());
}
