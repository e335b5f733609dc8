//! What a scene does not need is not there.
mod common;
use peridynamics::prelude::*;

#[test]
fn a_scene_holds_only_what_it_needs() {
    let grid = Grid::new(&Cuboid::centred([0.064, 0.064]).expect("box"), 1e-3).expect("grid");
    let family = Lattice::<f64, 2>::new(&grid, Horizon::Cells(3.0), Quadrature::None);
    let family = family.expect("family");
    let moduli = Isotropic::from_young_poisson(7e10, 1.0 / 3.0).expect("moduli");
    let mode = PlaneMode::PlaneStress;
    let pmb = || Pmb::plane(&moduli, mode, 1e3, InfluenceFunction::Constant).expect("material");
    let whole = Body::new(family.clone(), Ordinary::new(pmb()), NoDamage).expect("body").memory();
    assert_eq!(whole.bond_bits, 0);
    assert_eq!(whole.criterion, 0);
    assert_eq!(whole.node_constants, 0);
    assert_eq!(whole.node_states, 0);
    assert_eq!(whole.density, 0);

    let stretch = CriticalStretch::new(0.01).expect("criterion");
    let breaking = Body::new(family.clone(), Ordinary::new(pmb()), Breaking::new(stretch));
    let memory = breaking.expect("body").memory();
    assert_eq!(memory.criterion, 0);
    let sites = Family::<f64, 2>::sites(&family);
    // One bit per site and offset of the half table, and two bytes of marks per eight sites.
    let half = family.offsets() / 2;
    assert!(memory.bond_bits <= sites * half / 8 + sites / 4, "{}", memory.bond_bits);

    let bits = Body::new(family, Ordinary::new(pmb()), Precracked::default()).expect("body");
    assert!(bits.memory().bond_bits > 0);
}
