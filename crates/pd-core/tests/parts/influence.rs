//! Influence functions: values, moments, and the weighted volume they give.
use approx::assert_relative_eq;
use nalgebra::{SVector, Vector2};
use pd_core::influence::moment;
use pd_core::{Influence, InfluenceFunction, Quadrature};
use serde_json::Value;
use std::f64::consts::E;

use InfluenceFunction::{Constant, CubicSpline, Gaussian, Inverse, Linear};

#[test]
fn values_at_the_centre_inside_and_beyond_the_horizon() {
    let values = |ω: InfluenceFunction| [0.25, 0.5, 0.75, 1.0, 1.25].map(|r| ω.weight(r));
    assert_eq!(values(Constant), [1.0; 5]);
    assert_eq!(values(Linear), [0.75, 0.5, 0.25, 0.0, 0.0]);
    assert_eq!(values(CubicSpline), [0.71875, 0.25, 0.03125, 0.0, 0.0]);
    assert_eq!(values(Inverse), [4.0, 2.0, 4.0 / 3.0, 1.0, 0.8]);
    for (value, r) in values(Gaussian).into_iter().zip([0.25_f64, 0.5, 0.75, 1.0, 1.25]) {
        assert_relative_eq!(value.ln(), -r * r, max_relative = 1e-14);
    }
    for ω in [Constant, Linear, Gaussian, CubicSpline] {
        assert_eq!(ω.weight(0.0), 1.0);
    }
}

#[test]
fn the_spline_is_twice_continuously_differentiable() {
    let h = 1e-3;
    let curvature = |r: f64| {
        let w = |r| CubicSpline.weight(r);
        (w(r + h) - 2.0 * w(r) + w(r - h)) / (h * h)
    };
    for kink in [0.5, 1.0] {
        assert!((curvature(kink + h) - curvature(kink - h)).abs() < 0.1, "ω'' jumps at {kink}");
    }
}

#[test]
fn moments_have_their_closed_forms() {
    for k in 0..6 {
        let n = f64::from(k);
        assert_relative_eq!(moment(&Constant, k), 1.0 / (n + 1.0), max_relative = 1e-14);
        let linear = 1.0 / ((n + 1.0) * (n + 2.0));
        assert_relative_eq!(moment(&Linear, k), linear, max_relative = 1e-14);
        assert_relative_eq!(moment(&Inverse, k + 1), 1.0 / (n + 1.0), max_relative = 1e-14);
    }
    assert_relative_eq!(moment(&Gaussian, 1), (1.0 - 1.0 / E) / 2.0, max_relative = 1e-14);
    assert_relative_eq!(moment(&Gaussian, 3), (1.0 - 2.0 / E) / 2.0, max_relative = 1e-14);
    // The normalisations 4/3, 40/7π and 8/π of the spline in one, two and three dimensions.
    for (k, closed) in [(0, 3.0 / 8.0), (1, 7.0 / 80.0), (2, 1.0 / 32.0)] {
        assert_relative_eq!(moment(&CubicSpline, k), closed, max_relative = 1e-14);
    }
}

#[test]
fn a_closure_and_a_trait_object_are_influence_functions() {
    let power = 2;
    let own = move |r: f64| (1.0 - r).powi(power);
    assert_eq!(own.weight(0.5), 0.25);
    let all: [&dyn Influence; 2] = [&own, &Linear];
    let moments = all.map(|ω| moment(ω, 0));
    assert_relative_eq!(moments[0], 1.0 / 3.0, max_relative = 1e-14);
    assert_relative_eq!(moments[1], 0.5, max_relative = 1e-14);
}

/// m = Σ ω|ξ|²βV of a body whose neighbours partly lie outside the horizon: fixes ω there too.
#[test]
fn the_weighted_volume_agrees_with_an_independent_code() {
    let case: Value = serde_json::from_str(include_str!("../data/m_gauss_exact.json")).unwrap();
    let numbers = |v: &Value| v.as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect();
    let (volume, expected): (Vec<f64>, Vec<f64>) = (numbers(&case["V"]), numbers(&case["m"]));
    let (i, j, beta): (Vec<f64>, Vec<f64>, Vec<f64>) =
        (numbers(&case["bond_i"]), numbers(&case["bond_j"]), numbers(&case["bond_beta"]));
    let (dx, delta) = (case["dx"].as_f64().unwrap(), case["delta"].as_f64().unwrap());
    let x: Vec<Vector2<f64>> =
        case["x"].as_array().unwrap().iter().map(|x| SVector::from_vec(numbers(x))).collect();
    let mut bonds = 0;
    for a in 0..x.len() {
        let mut m = 0.0;
        for b in 0..x.len() {
            let xi = x[b] - x[a];
            let weight = Quadrature::Exact.weight(&xi, &Vector2::repeat(dx), delta);
            if a == b || weight == 0.0 {
                continue;
            }
            m += Gaussian.weight(xi.norm() / delta) * xi.norm_squared() * weight * volume[b];
            if a < b {
                assert_eq!((i[bonds] as usize, j[bonds] as usize), (a, b));
                assert_relative_eq!(weight, beta[bonds], epsilon = 1e-12);
                bonds += 1;
            }
        }
        assert_relative_eq!(m, expected[a], max_relative = 1e-12);
    }
    assert_eq!(bonds, i.len());
}
