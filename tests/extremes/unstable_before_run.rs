//! What grows or costs no energy is known before a run, for any stiffness, from the symbol.
//! `tests/materials/unstable_body.rs` has what a run says.
use super::*;
use pd_testkit::generate::plane_stiffnesses;
use peridynamics::check::{Conditions, Property, check_material};
use proptest::prelude::*;

fn stability(material: &impl Material<f64, 2>) -> Stability<2> {
    let symbol = Symbol::of(material, DX, Horizon::Cells(2.0), Quadrature::None);
    symbol.expect("symbol").extremes(32).stability()
}

proptest! {
    #![proptest_config(cases(8))]

    /// Of whatever stiffness: the positive split and controlled correspondence amplify no wave,
    /// correspondence alone has waves that cost nothing, and is not taken for unstable.
    #[test]
    fn models_that_never_amplify(c in plane_stiffnesses(1e11, 1e4)) {
        let omega = InfluenceFunction::Gaussian;
        let split = PositiveSplit::plane(&c, 1e3, omega).expect("material");
        let found = stability(&Ordinary::linearised(split));
        prop_assert!(matches!(found, Stability::Stable(_)), "{found}");
        let bare = Correspondence::new(LinearElastic(c), 1e3, omega).expect("material");
        let found = stability(&bare);
        prop_assert!(matches!(found, Stability::ZeroEnergy(_)), "{found}");
        let control = WanControl::new(&c, 1.0).expect("control");
        let found = stability(&bare.with_control(control));
        prop_assert!(matches!(found, Stability::Stable(_)), "{found}");
    }

    /// Where polynomial micromoduli are unstable, the symbol says so, and a wave that it names grows.
    #[test]
    fn polynomial_micromoduli_are_found_out(c in plane_stiffnesses(1e11, 30.0)) {
        let omega = InfluenceFunction::Gaussian;
        let model = PolynomialMicromoduli::plane(&c, 1e3, omega).expect("material");
        let negative = (0..180).any(|i| {
            let (sin, cos) = f64::from(i).to_radians().sin_cos();
            model.micromodulus(&[cos, sin].into()) < 0.0
        });
        let material = Ordinary::linearised(model);
        let symbol = Symbol::of(&material, DX, Horizon::Cells(3.0), Quadrature::None);
        let symbol = symbol.expect("symbol");
        match symbol.extremes(60).stability() {
            Stability::Unstable(mode) => {
                prop_assert!(negative, "all micromoduli are positive: {:?}", mode);
                prop_assert!(symbol.eigen(&mode.wave)[0].eigenvalue < 0.0);
                let refused = symbol.require_stable().err();
                let typed = matches!(refused, Some(Error::UnstableMaterial { .. }));
                prop_assert!(typed, "{:?}", refused);
                let report = check_material(&material, &Conditions::<2>::default());
                let failures: Vec<_> = report.failures().map(|f| f.property).collect();
                prop_assert_eq!(failures, [Property::Stability]);
            }
            found => println!("{found}; negative micromoduli: {negative}"),
        }
    }
}
