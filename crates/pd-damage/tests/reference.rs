//! Criteria on single bonds against independent codes (`tests/data/pd/damage_bonds.json`).

use nalgebra::{Matrix2, Matrix3, Rotation3, SVector, Vector3};
use pd_core::{Bond, DamageCriterion, End, Material, Scale, TestedBond};
use pd_damage::{CriticalStretch, Strengths, TsaiHill, TsaiHill3};
use serde_json::Value;

fn reference() -> Value {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/data/pd/damage_bonds.json");
    serde_json::from_str(&std::fs::read_to_string(path).expect("data")).expect("JSON")
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().expect("list").iter().filter_map(Value::as_f64).collect()
}

/// A material without anything: stretch needs none of it.
struct Nothing;
impl Material<f64, 3> for Nothing {
    type BondConst = ();
    type NodeConst = ();
    type FamilyConst = ();
    type FamilySum = ();
    type NodeState = ();
    fn density(&self, _: usize) -> f64 {
        1.0
    }
    fn bond_const(&self, _: &SVector<f64, 3>, _: Scale) {}
    fn force_state(&self, _: &Bond<f64, 3>, _: End<'_, f64, (), (), ()>) -> SVector<f64, 3> {
        SVector::zeros()
    }
}

#[test]
fn critical_stretch() {
    let reference = reference();
    let cases = reference["stretch_and_cod"].as_array().expect("cases");
    let mut broken = 0;
    for case in cases {
        let vector = |key: &str| {
            let given = numbers(&case[key]);
            SVector::<f64, 3>::from_fn(|d, _| given.get(d).copied().unwrap_or(0.0))
        };
        let bond = Bond::new(vector("xi"), vector("u_j") - vector("u_i"));
        let criterion = CriticalStretch::new(case["s_c"].as_f64().expect("s_c")).expect("s_c");
        let end = End { bond: &(), node: &(), state: &(), volume: 1.0 };
        let tested = TestedBond {
            material: &Nothing,
            bond: &bond,
            ends: [end, end],
            constants: [&(), &()],
            values: [&(), &()],
            unit: 1.0,
        };
        let index = criterion.index(&tested);
        assert_eq!(index > 1.0, case["stretch_broken"] == 1, "{case}");
        // The index is (λ² − 1)/(λ_c² − 1) with λ = 1 + s.
        let (s, sc) = (case["s"].as_f64().expect("s"), criterion.stretch());
        let exact = s * (2.0 + s) / (sc * (2.0 + sc));
        assert!((index - exact).abs() < 1e-9 * exact.abs().max(1.0), "{index} {exact}");
        broken += usize::from(index > 1.0);
    }
    assert!(broken > 0 && broken < cases.len());
}

#[test]
fn tsai_hill() {
    let reference = reference();
    for case in reference["tsai_hill"].as_array().expect("cases") {
        let get = |key: &str| case[key].as_f64().expect("number");
        let strengths =
            Strengths { along: get("sigma_Lu"), across: get("sigma_Tu"), shear: get("tau_LTu") };
        let criterion = TsaiHill::new(&strengths, get("theta_rad")).expect("criterion");
        let stress = |key: &str| {
            let s = numbers(&case[key]);
            Matrix2::new(s[0], s[2], s[2], s[1])
        };
        let mean = (stress("sigma_i_xx_yy_xy") + stress("sigma_j_xx_yy_xy")) * 0.5;
        let value = criterion.value(&mean);
        assert!((value / get("value") - 1.0).abs() < 1e-12, "{value} {case}");
        assert_eq!(value > 1.0, case["broken"] == 1);
        let single = f64::from(criterion.value(&mean.map(|s| s as f32)));
        assert!((single / get("value") - 1.0).abs() < 1e-4, "{single} {case}");
        // The 3D form agrees in the plane.
        let solid =
            TsaiHill3::new(&strengths, [get("theta_rad").cos(), get("theta_rad").sin(), 0.0]);
        let flat = Matrix3::new(
            mean[(0, 0)],
            mean[(0, 1)],
            0.0,
            mean[(0, 1)],
            mean[(1, 1)],
            0.0,
            0.0,
            0.0,
            0.0,
        );
        let value3 = solid.expect("criterion").value(&flat);
        assert!((value3 / value - 1.0).abs() < 1e-9, "{value3} {value}");
    }
}

/// The 3D form is unchanged by any rotation about the fibre.
#[test]
fn tsai_hill_in_space_is_transversely_isotropic() {
    let strengths = Strengths { along: 1670e6, across: 60e6, shear: 70e6 };
    let fibre = Vector3::new(1.0, 2.0, -0.5);
    let criterion = TsaiHill3::new(&strengths, fibre.into()).expect("criterion");
    let s = Matrix3::new(3.0, 1.0, -2.0, 1.0, 5.0, 0.7, -2.0, 0.7, -4.0) * 1e7;
    let value = criterion.value(&s);
    for k in 1..6 {
        let axis = nalgebra::Unit::new_normalize(fibre);
        let r = Rotation3::from_axis_angle(&axis, f64::from(k)).into_inner();
        let turned = criterion.value(&(r * s * r.transpose()));
        assert!((turned / value - 1.0).abs() < 1e-10, "{turned} {value}");
    }
    // Against the formula in the fibre's own axes.
    let along_x = TsaiHill3::new(&strengths, [1.0, 0.0, 0.0]).expect("criterion");
    let (x2, y2, t2) = (1670e6_f64.powi(2), 60e6_f64.powi(2), 70e6_f64.powi(2));
    let (l, s2, s3) = (s[(0, 0)], s[(1, 1)], s[(2, 2)]);
    let (t12, t13, t23) = (s[(0, 1)], s[(0, 2)], s[(1, 2)]);
    let exact = l * l / x2 - l * (s2 + s3) / x2
        + (s2 * s2 + s3 * s3) / y2
        + (1.0 / x2 - 2.0 / y2) * s2 * s3
        + t23 * t23 * (4.0 / y2 - 1.0 / x2)
        + (t12 * t12 + t13 * t13) / t2;
    assert!((along_x.value(&s) / exact - 1.0).abs() < 1e-12);
}
