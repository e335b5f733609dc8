//! The symbol of a user's own material: a chain of springs, whose dispersion is known, and
//! materials that are no elastic bulk lattice.

use nalgebra::SVector;
use pd_core::bond::{Bond, End, Neighbourhood, Scale};
use pd_core::symbol::Stability;
use pd_core::{Error, Horizon, Material, Quadrature, Symbol};
use std::f64::consts::PI;

const DENSITY: f64 = 2700.0;
const DX: f64 = 0.01;

/// T = a η + b ξ |η|², with a in Pa/Δx², and what can spoil it.
#[derive(Clone, Copy)]
struct Springs {
    a: f64,
    b: f64,
    /// Skews T: no energy (in 2D).
    skew: f64,
    /// Force on the end with the smaller x only.
    ghost: f64,
    /// Growth of a from node to node.
    growth: f64,
}

const PLAIN: Springs = Springs { a: 7e9, b: 0.0, skew: 0.0, ghost: 0.0, growth: 0.0 };

impl<const D: usize> Material<f64, D> for Springs {
    type BondConst = ();
    /// Factor of the force.
    type NodeConst = f64;
    type FamilyConst = ();
    type FamilySum = ();
    type NodeState = ();

    fn density(&self, _: usize) -> f64 {
        DENSITY
    }
    fn bond_const(&self, _: &SVector<f64, D>, _: Scale) {}
    fn node_const(&self, family: &Neighbourhood<'_, (), D>) -> Result<(f64, ()), Error> {
        Ok((1.0 + self.growth * family.node as f64, ()))
    }
    fn force_state(&self, bond: &Bond<f64, D>, end: End<'_, f64, (), f64, ()>) -> SVector<f64, D> {
        let mut t = bond.eta * self.a + bond.xi * (self.b * bond.eta.norm_squared());
        t[0] += self.skew * bond.eta[D - 1];
        t * *end.node
    }
    fn pair_force(
        &self,
        bond: &Bond<f64, D>,
        ends: [End<'_, f64, (), f64, ()>; 2],
    ) -> SVector<f64, D> {
        let both = self.force_state(bond, ends[0]) * ends[0].volume
            - self.force_state(&bond.reversed(), ends[1]) * ends[1].volume;
        let ghost = if bond.xi[0] > 0.0 { self.ghost } else { 0.0 };
        both + bond.eta * (ghost * *ends[0].node)
    }
}

fn chain(springs: &Springs) -> Symbol<1> {
    Symbol::of(springs, DX, Horizon::Cells(1.0), Quadrature::None).unwrap()
}

#[test]
fn nearest_neighbour_chain() {
    // Both neighbours pull with 2a η, so ρω² = 8a/Δx² sin²(kΔx/2).
    let symbol = chain(&Springs { b: 1e9, ..PLAIN });
    let peak = (8.0 * PLAIN.a / DENSITY).sqrt() / DX;
    let zone = symbol.dispersion(&SVector::from([-3.0]), 10).unwrap();
    assert_eq!(zone.len(), 10);
    for (i, (k, [omega])) in zone.into_iter().enumerate() {
        assert!((k * DX - PI * (i + 1) as f64 / 10.0).abs() < 1e-12);
        let exact = peak * (0.5 * k * DX).sin();
        assert!((omega / exact - 1.0).abs() < 1e-10, "{omega} {exact}");
    }
    let [speed] = symbol.phase_speeds(&SVector::from([1.0]), 1e-6 / DX).unwrap();
    assert!((speed / (0.5 * peak * DX) - 1.0).abs() < 1e-10);
    assert!((symbol.max_frequency() / peak - 1.0).abs() < 1e-10);
    assert!((symbol.critical_time_step() * peak / 2.0 - 1.0).abs() < 1e-10);
    let stability = symbol.stability();
    assert!(matches!(stability, Stability::Stable(_)), "{stability}");
    assert!(stability.to_string().starts_with("stable: the softest wave k = ["));
}

#[test]
fn a_negative_spring_grows_fastest_at_the_zone_boundary() {
    let symbol = chain(&Springs { a: -7e9, ..PLAIN });
    let Stability::Unstable(mode) = symbol.extremes(7).stability() else { panic!() };
    let rate = (8.0 * 7e9 / DENSITY).sqrt() / DX;
    assert!((mode.growth_rate() / rate - 1.0).abs() < 1e-10);
    assert!((mode.wave[0].abs() * DX - PI).abs() < 1e-9);
    assert!(mode.frequency().is_nan());
    assert!(matches!(symbol.require_stable(), Err(Error::UnstableMaterial { .. })));
}

fn plane(springs: &Springs) -> Result<Symbol<2>, Error> {
    Symbol::of(springs, DX, Horizon::Cells(2.0), Quadrature::Exact)
}

#[test]
fn what_is_no_elastic_bulk_lattice_is_refused() {
    plane(&PLAIN).unwrap();
    let rule_of = |springs: Springs| match plane(&springs) {
        Err(Error::ForceConstants { rule, relative }) => {
            assert!(relative > 1e-4, "{relative}");
            rule
        }
        other => panic!("{other:?}"),
    };
    let spoilt = [
        Springs { skew: 1e9, ..PLAIN },
        Springs { ghost: 1e9, ..PLAIN },
        Springs { growth: 0.01, ..PLAIN },
    ];
    for springs in spoilt {
        let rule = rule_of(springs);
        assert!(rule.contains("an energy must be behind"), "{rule}");
    }
    let rule = rule_of(Springs { ghost: 1e9, growth: 0.01, ..PLAIN });
    assert!(rule.contains("must be opposite"), "{rule}");
    let nan = plane(&Springs { a: f64::NAN, ..PLAIN });
    assert!(matches!(nan, Err(Error::ForceConstants { .. })), "{nan:?}");
}

#[test]
fn nonsense_is_refused() {
    for dx in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let symbol = Symbol::<2>::of(&PLAIN, dx, Horizon::Cells(2.0), Quadrature::Exact);
        assert!(matches!(symbol, Err(Error::InvalidValue { .. })), "{dx}: {symbol:?}");
    }
    for m in [0.0, 0.5, f64::NAN, 1e300] {
        let symbol = Symbol::<2>::of(&PLAIN, DX, Horizon::Cells(m), Quadrature::None);
        assert!(matches!(symbol, Err(Error::InvalidValue { .. })), "{m}: {symbol:?}");
    }
    let symbol = plane(&PLAIN).unwrap();
    assert!(symbol.phase_speeds(&SVector::zeros(), 1.0).is_err());
    assert!(symbol.phase_speeds(&SVector::from([1.0, 0.0]), 0.0).is_err());
    assert!(symbol.dispersion(&SVector::zeros(), 3).is_err());
    assert!(symbol.eigen(&SVector::from([f64::NAN, 0.0]))[0].eigenvalue.is_nan());
    assert_eq!(symbol.eigen(&SVector::zeros())[1].eigenvalue, 0.0);
}
