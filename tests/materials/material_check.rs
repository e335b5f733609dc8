//! `check_material` passes every built-in material, and each broken one fails in the property that
//! is broken and in no other.
use crate::common;
use peridynamics::check::{Conditions, Outcome, Property, Report, check_elastic, check_material};
use peridynamics::check::{Place, Rotations};
use peridynamics::models::elasticity::catalogue::GLASS_EPOXY;
use peridynamics::prelude::*;

fn broken<const D: usize>(report: &Report<D>) -> Vec<Property> {
    let mut properties: Vec<Property> = report.failures().map(|f| f.property).collect();
    properties.dedup();
    properties
}

#[test]
fn built_in_materials_are_sound() {
    macro_rules! check {
        ($material:expr, $grid:expr, $d:literal) => {{
            // The check brings bodies of its own.
            let (material, _) = ($material, &$grid);
            let name = std::any::type_name_of_val(&material);
            let report = check_elastic(&material, &Conditions::<$d>::default());
            println!("{name}\n{report}");
            // The ply's are those of carbon, which amplify waves (physics: unstable micromoduli).
            if name.contains("Polynomial") {
                assert_eq!(broken(&report), [Property::Stability], "{name}");
            } else {
                report.assert();
            }
        }};
    }
    crate::for_every_material!(check, 1e-3);
    let glass = Stiffness::<2>::lamina(&GLASS_EPOXY).expect("ply").rotated(0.7);
    let model = PolynomialMicromoduli::plane(&glass, common::RHO, common::OMEGA).expect("material");
    check_elastic(&Ordinary::new(model), &Conditions::<2>::default()).assert();
}

const C: f64 = 1e9;

/// A linear spring, by the factors that break it.
#[derive(Clone, Copy)]
struct Spring {
    modulus: f64,
    /// The energy it claims over the one it has.
    energy: f64,
    /// Pulls harder along +x than along −x, in second order.
    one_sided: bool,
    /// Pulls along ξ, not along Y.
    along_reference: bool,
    /// Takes the change of length from η·n, not from |Y|.
    small_stretch: bool,
}

const SOUND: Spring = Spring {
    modulus: C,
    energy: 1.0,
    one_sided: false,
    along_reference: false,
    small_stretch: false,
};

impl<T: Real, const D: usize> Material<T, D> for Spring {
    /// |ξ|.
    type BondConst = T;
    type NodeConst = ();
    type FamilyConst = ();
    type FamilySum = ();
    type NodeState = ();
    fn density(&self, _: usize) -> f64 {
        1000.0
    }
    fn bond_const(&self, xi: &SVector<f64, D>, _: Scale) -> T {
        T::of(xi.norm())
    }
    fn force_state(&self, bond: &Bond<T, D>, end: End<'_, T, T, (), ()>) -> SVector<T, D> {
        let (e, m) = bond.extension_and_direction(*end.bond);
        let n = bond.xi / *end.bond;
        let e = if self.small_stretch { bond.eta.dot(&n) } else { e };
        let s = e / *end.bond;
        let lean = if self.one_sided { T::one() + s * n[0] } else { T::one() };
        (if self.along_reference { n } else { m }) * (T::of(self.modulus) * s * lean)
    }
    fn pair_force(&self, bond: &Bond<T, D>, ends: [End<'_, T, T, (), ()>; 2]) -> SVector<T, D> {
        self.force_state(bond, ends[0]) * (ends[0].volume + ends[1].volume)
    }
}

impl<T: Real, const D: usize> StrainEnergy<T, D> for Spring {
    fn bond_energy(&self, bond: &Bond<T, D>, end: End<'_, T, T, (), ()>) -> T {
        let e = bond.extension(*end.bond);
        T::of(0.5 * self.energy * self.modulus) * e * e / *end.bond
    }
}

fn of_spring(spring: Spring) -> Vec<Property> {
    let flat = check_material(&spring, &Conditions::<2>::default());
    let deep = Conditions::<3> { horizon: Horizon::Cells(2.0), ..Conditions::default() };
    let deep = check_material(&spring, &deep);
    println!("{flat}\n{deep}");
    assert_eq!(broken(&flat), broken(&deep));
    broken(&flat)
}

#[test]
fn a_force_that_is_not_odd_breaks_momentum() {
    assert_eq!(of_spring(SOUND), []);
    assert_eq!(of_spring(Spring { one_sided: true, ..SOUND }), [Property::Momentum]);
}

#[test]
fn a_negative_modulus_breaks_stability() {
    assert_eq!(of_spring(Spring { modulus: -C, ..SOUND }), [Property::Stability]);
    let report = check_material(&Spring { modulus: -C, ..SOUND }, &Conditions::<2>::default());
    let wave = report.failures().next().map(|f| f.outcome.clone());
    let Some(Outcome::Fails { place: Place::Wave(k), .. }) = wave else { panic!("{wave:?}") };
    assert!(k.norm() > 0.1 / 1e-3, "{k}");
}

#[test]
fn a_stretch_that_rotations_change_breaks_objectivity() {
    assert_eq!(of_spring(Spring { small_stretch: true, ..SOUND }), [Property::Objectivity]);
    // Along ξ it also has a moment about the deformed places.
    let spring = Spring { along_reference: true, ..SOUND };
    assert_eq!(of_spring(spring), [Property::Momentum, Property::Objectivity]);
    // Both together are linear: right for who claims small rotations only.
    let spring = Spring { along_reference: true, small_stretch: true, ..SOUND };
    let small = Conditions { rotations: Rotations::Small, ..Conditions::<2>::default() };
    check_material(&spring, &small).assert();
}

#[test]
fn an_energy_of_another_force_breaks_energy() {
    let of_energy = |energy| {
        let report = check_elastic(&Spring { energy, ..SOUND }, &Conditions::<2>::default());
        println!("{report}");
        broken(&report)
    };
    assert_eq!(of_energy(1.0), []);
    assert_eq!(of_energy(1.0 + 1e-5), [Property::Energy]);
    assert_eq!(of_energy(f64::NAN), [Property::Energy]);
}

/// A spring and a pressure p = a Σ e|ζ|³βV: no energy has it, as the weight of e in p is not that
/// of p in the force.
struct Pressed {
    weight: i32,
}

impl Material<f64, 2> for Pressed {
    type BondConst = f64;
    type NodeConst = ();
    type FamilyConst = ();
    type FamilySum = f64;
    type NodeState = f64;
    fn density(&self, _: usize) -> f64 {
        1000.0
    }
    fn bond_const(&self, xi: &SVector<f64, 2>, _: Scale) -> f64 {
        xi.norm()
    }
    fn add_bond(&self, sum: &mut f64, bond: &Bond<f64, 2>, end: End<'_, f64, f64, (), ()>) {
        *sum += bond.extension(*end.bond) * end.bond.powi(self.weight) * end.volume;
    }
    fn node_state(&self, sum: &f64, (): &(), (): &(), _: &f64) -> f64 {
        1e-3 * C * sum
    }
    fn force_state(&self, bond: &Bond<f64, 2>, end: End<'_, f64, f64, (), f64>) -> SVector<f64, 2> {
        let (e, m) = bond.extension_and_direction(*end.bond);
        m * (C * e / *end.bond + *end.state)
    }
}

#[test]
fn weights_that_do_not_match_break_symmetry() {
    let of_weight = |weight| {
        let report = check_material(&Pressed { weight }, &Conditions::<2>::default());
        println!("{report}");
        broken(&report)
    };
    assert_eq!(of_weight(0), []);
    assert_eq!(of_weight(3), [Property::Symmetry]);
}

#[test]
fn what_cannot_be_tested_is_refused_with_the_reason() {
    let policy = ShapePolicy { rule: IllConditioned::Refuse, limit: 1e6 };
    let law = LinearElastic(common::ply());
    let material = Correspondence::new(law, common::RHO, InfluenceFunction::Linear).expect("m");
    let near = Conditions { horizon: Horizon::Cells(1.0), ..Conditions::<2>::default() };
    let report = check_elastic(&material.with_shape_policy(policy), &near);
    let refused = report.failures().all(|f| matches!(f.outcome, Outcome::Refused(_)));
    assert!(!report.holds() && refused, "{report}");
    assert!(report.to_string().contains("shape tensor of node"), "{report}");
}
