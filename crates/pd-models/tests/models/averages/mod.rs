//! Averages over directions, exact for the polynomials that occur (degree 8 at most).
#![allow(dead_code)]

use nalgebra::{Vector2, Vector3};
use std::f64::consts::TAU;

/// Average of f over the unit circle: 16 equal angles are exact to degree 15.
pub fn circle(f: impl Fn(&Vector2<f64>) -> f64) -> f64 {
    let angle = |i: usize| TAU * i as f64 / 16.0;
    (0..16).map(|i| f(&Vector2::new(angle(i).cos(), angle(i).sin()))).sum::<f64>() / 16.0
}

/// Average of f over the unit sphere: 16 equal angles, 5 Gauss–Legendre points along z (degree 9).
pub fn sphere(f: impl Fn(&Vector3<f64>) -> f64) -> f64 {
    let root = |sign: f64| (5.0 + sign * 2.0 * (10.0_f64 / 7.0).sqrt()).sqrt() / 3.0;
    let weight = |sign: f64| (322.0 + sign * 13.0 * 70.0_f64.sqrt()) / 900.0;
    let (inner, outer) = ((root(-1.0), weight(1.0)), (root(1.0), weight(-1.0)));
    let points = [(0.0, 128.0 / 225.0), inner, (-inner.0, inner.1), outer, (-outer.0, outer.1)];
    let ring = |z: f64| {
        let r = (1.0 - z * z).sqrt();
        circle(|n| f(&Vector3::new(r * n.x, r * n.y, z)))
    };
    points.iter().map(|&(z, w)| 0.5 * w * ring(z)).sum()
}
