//! Willberg's criteria on parts of a bond's energy break later than the one on the whole, by
//! definition: over a family the parts sum to the whole, in a bond they do not (errata 002-12).
//!
//! Under a uniaxial strain ε in plane strain the bond along it has θ = ε, e = ε|ξ|, and with
//! q = ω|ξ|²ε²/m the energies κ q (volume), 2G q (shear) and (2κ + 4G) q (whole): the whole is twice
//! the sum of its parts.
use peridynamics::damage::PowerLaw;
use peridynamics::damage::bond_energy::Uniform;
use peridynamics::models::elasticity::catalogue;
use peridynamics::prelude::*;

/// The largest index away from the surfaces under the strain ε_yy = 10⁻⁶.
fn index<C>(criterion: C) -> f64
where
    C: DamageCriterion<f64, 2, Ordinary<LinearSolid>> + Clone,
{
    let grid = Grid::new(&Cuboid::centred([15.0, 15.0]).expect("box"), 1.0).expect("grid");
    let family = Lattice::<f64, 2>::new(&grid, Horizon::Cells(3.0), Quadrature::None).expect("f");
    let rim = grid.select(|x| x.amax() > 4.0);
    let resin = catalogue::willberg_resin().expect("resin");
    let constant = InfluenceFunction::Constant;
    let solid = LinearSolid::plane(&resin, PlaneMode::PlaneStrain, 1e3, constant).expect("solid");
    let policy = Breaking::new(criterion.sparing(&rim));
    let mut body = Body::new(family, Ordinary::new(solid), policy).expect("body");
    body.set_displacement(|x| [0.0, 1e-6 * x[1]].into());
    body.evaluate_and_break(0, &mut ()).expect("forces");
    body.worst_index()
}

#[test]
fn parts_of_a_bond_energy_break_later_than_the_whole() {
    let resin = catalogue::willberg_resin().expect("resin");
    let (kappa, shear) = (resin.plane_bulk(PlaneMode::PlaneStrain), resin.shear());
    let critical = 1e6;
    let modes = ModeEnergies::new(critical, None, critical).expect("modes");
    let whole = index(BondEnergy::<Uniform>::new(critical).expect("energy"));
    let power = index(PowerLaw::new(modes));
    let separated = index(Separated::new(modes));
    let near = |got: f64, exact: f64| {
        assert!((got / exact - 1.0).abs() < 1e-4, "{got} {exact}");
    };
    let parts = [kappa, 2.0 * shear];
    near(separated / whole, parts[0].max(parts[1]) / (2.0 * kappa + 4.0 * shear));
    near(power.sqrt() / whole, parts[0].hypot(parts[1]) / (2.0 * kappa + 4.0 * shear));
    // Energies go with the square of the load: later by this factor.
    let later = [(whole / power.sqrt()).sqrt(), (whole / separated).sqrt()];
    println!("load over that of Foster's: power law {:.2}, separated {:.2}", later[0], later[1]);
    assert!(later[0] > 1.41 && later[1] > later[0]);
}
