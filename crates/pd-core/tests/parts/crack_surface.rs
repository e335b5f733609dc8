//! Cracks cut what crosses or touches them and nothing else; what is no crack is refused.

use approx::assert_relative_eq;
use nalgebra::{Vector2, Vector3};
use pd_core::crack::{Polygon, Segment};
use pd_core::region::Cuboid;
use pd_core::{CrackSurface, Error, Grid};

/// A crack between node rows with its tip midway between columns: bonds through the very tip are
/// cut on both sides alike, though rounding puts some above and some below it.
#[test]
fn symmetric_about_the_tip() {
    for dx in [1.0, 0.1, 1e-3 / 3.0] {
        let body = Cuboid::new([0.0, 0.0], [10.0 * dx, 10.0 * dx]).unwrap();
        let grid = Grid::new(&body, dx).unwrap();
        let crack = Segment::new([0.0, 5.0 * dx], [5.0 * dx, 5.0 * dx]).unwrap();
        let cuts = |a, b| {
            let place = |cell| grid.position(grid.node(cell).unwrap());
            crack.cuts(&place(a), &place(b))
        };
        let mut through_tip = 0;
        for (a, b) in (0..10_000).map(|n| ([n % 10, n / 10 % 10], [n / 100 % 10, n / 1000])) {
            // twice the coordinate, from the tip, where the bond meets y = 5: exact in integers
            let (up_a, up_b) = (2 * a[1] as i64 - 9, 2 * b[1] as i64 - 9);
            let (right_a, right_b) = (2 * a[0] as i64 - 9, 2 * b[0] as i64 - 9);
            let opposite = up_a.signum() != up_b.signum();
            let meets = (right_a * up_b - right_b * up_a) * (up_b - up_a).signum();
            assert_eq!(cuts(a, b), opposite && meets <= 0, "{a:?}-{b:?}");
            through_tip += usize::from(opposite && meets == 0);
        }
        assert!(through_tip > 50);
    }
}

#[test]
fn along_the_line_of_a_segment() {
    let crack = Segment::new([1.0, 1.0], [2.0, 2.0]).unwrap();
    let at = |s: f64| Vector2::new(s, s);
    assert!(crack.cuts(&at(0.0), &at(3.0)));
    assert!(!crack.cuts(&at(0.0), &at(0.9)));
    assert!(!crack.cuts(&at(2.1), &at(3.0)));
    assert!(crack.cuts(&at(1.2), &at(1.7)));
    // ends on the line but beyond the tip
    assert!(!crack.cuts(&at(0.5), &Vector2::new(0.0, 5.0)));
}

/// Neither a long crack reaches further nor a short one less.
#[test]
fn touching_is_relative_to_the_bond() {
    let bond = |x: f64| (Vector2::new(x, -0.5), Vector2::new(x, 0.5));
    for length in [1e-4, 1.0, 1e4] {
        let crack = Segment::new([-length, 0.0], [0.0, 0.0]).unwrap();
        for (beyond, cut) in [(0.9e-9, true), (1.1e-9, false)] {
            let (a, b) = bond(beyond);
            assert_eq!(crack.cuts(&a, &b), cut, "{length} {beyond}");
        }
    }
}

#[test]
fn distance_of_a_segment() {
    let crack = Segment::new([0.0, 0.0], [0.0, 2.0]).unwrap();
    assert_eq!(crack.distance(&Vector2::new(-0.5, 1.3)), 0.5);
    assert_eq!(crack.distance(&Vector2::new(3.0, 6.0)), 5.0);
    assert_eq!(crack.normal(), Vector2::new(-1.0, 0.0));
}

/// An L: the square [0, 2]² without its upper right quarter, at z = 1.
fn angle() -> Polygon {
    let corners = [(0.0, 0.0), (2.0, 0.0), (2.0, 1.0), (1.0, 1.0), (1.0, 2.0), (0.0, 2.0)];
    Polygon::new(&corners.map(|(x, y)| [x, y, 1.0])).unwrap()
}

#[test]
fn polygon_need_not_be_convex() {
    let crack = angle();
    let through = |x: f64, y: f64| crack.cuts(&Vector3::new(x, y, 0.0), &Vector3::new(x, y, 2.0));
    for i in 0..50 {
        let (x, y) = (0.1 * (i % 7) as f64 - 0.15 + 0.3 * (i / 7) as f64, 0.05 + 0.04 * i as f64);
        let inside = (0.0..=2.0).contains(&x) && (0.0..=2.0).contains(&y) && (x <= 1.0 || y <= 1.0);
        assert_eq!(through(x, y), inside, "{x} {y}");
    }
    // touching edges and corners cuts, the inner corner too
    for (x, y) in [(0.0, 0.0), (2.0, 1.0), (1.0, 1.0), (1.0, 2.0), (0.5, 2.0), (1.0, 1.5)] {
        assert!(through(x, y), "{x} {y}");
    }
    assert!(!through(1.0 + 1e-6, 1.5));
    assert!(!crack.cuts(&Vector3::new(0.5, 0.5, 0.0), &Vector3::new(0.5, 0.5, 0.9)));
    assert_relative_eq!(crack.distance(&Vector3::new(0.5, 0.5, 4.0)), 3.0);
    assert_relative_eq!(crack.distance(&Vector3::new(1.5, 1.7, 1.0)), 0.5, max_relative = 1e-14);
    assert_relative_eq!(crack.distance(&Vector3::new(5.0, 0.5, 5.0)), 5.0);
    assert_eq!(crack.normal(), Vector3::z());
}

#[test]
fn in_the_plane_of_a_polygon() {
    let crack = angle();
    let at = |[x, y]: [f64; 2]| Vector3::new(x, y, 1.0);
    let cuts = |a, b| crack.cuts(&at(a), &at(b));
    assert!(cuts([-1.0, 0.5], [3.0, 0.6]));
    assert!(cuts([1.2, 1.8], [1.8, -0.5]));
    assert!(!cuts([1.2, 1.8], [1.8, 1.2]));
    assert!(!cuts([-0.1, 0.0], [-0.1, 2.0]));
    assert!(cuts([0.4, 0.4], [0.6, 0.7]));
    // along an edge, and through a corner only
    assert!(cuts([-1.0, 0.0], [3.0, 0.0]));
    assert!(cuts([-1.0, 1.0], [1.0, -1.0]));
}

/// Bonds through the common edge of two cracks do not slip between them.
#[test]
fn no_gap_between_adjoining_cracks() {
    let corner = |i: i32| Vector3::new(f64::from(i) / 3.0, 0.1 * f64::from(i), 0.7);
    let kink: Vec<_> = [(0, 1), (1, 2), (2, 3)]
        .map(|(i, j)| {
            let rise = Vector3::z() * if i == 1 { 0.3 } else { 0.1 };
            let (p, q) = (corner(i), corner(j));
            Polygon::parallelogram(p.into(), (q - p).into(), (rise - Vector3::y()).into()).unwrap()
        })
        .into();
    for i in 1..3 {
        for t in 0..40 {
            let x = corner(i) + Vector3::new(0.0, -1.0, 0.1) * (0.02 * f64::from(t) + 0.01);
            let bond = Vector3::new(0.1, 0.3 + 0.01 * f64::from(t), 1.0);
            assert!(kink.iter().any(|c| c.cuts(&(x - bond), &(x + bond))), "{i} {t}");
        }
    }
}

#[test]
fn refuses_what_is_no_crack() {
    let (o, x, y) = ([0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]);
    let (xx, xy) = ([2.0, 0.0, 0.0], [1.0, 1.0, 0.0]);
    assert!(Segment::new([1.0, 1.0], [1.0, 1.0]).is_err());
    assert!(Segment::new([1.0, f64::NAN], [0.0, 0.0]).is_err());
    let too_few = Polygon::new(&[o, x]).unwrap_err();
    assert!(matches!(too_few, Error::InvalidValue { value: 2.0, .. }));
    assert!(matches!(Polygon::new(&[o, x, xx]), Err(Error::InvalidValue { .. })));
    assert!(Polygon::parallelogram(o, [f64::INFINITY, 0.0, 0.0], y).is_err());
    let bent = Polygon::new(&[o, x, [1.0, 1.0, 0.1], y]).unwrap_err();
    assert!(matches!(bent, Error::NotPlanar { .. }), "{bent}");
    assert!(bent.to_string().contains("off its mean plane"), "{bent}");
    // bow tie with unequal lobes, doubled vertex, spike
    let bow = Polygon::new(&[o, [3.0, 0.0, 0.0], xy, [1.0, -1.0, 0.0]]).unwrap_err();
    assert_eq!(bow, Error::EdgesMeet { edges: [0, 2] });
    assert!(bow.to_string().starts_with("edges 0 and 2 of the crack polygon meet"), "{bow}");
    assert!(matches!(Polygon::new(&[o, x, x, xy, y]), Err(Error::EdgesMeet { .. })));
    assert!(matches!(Polygon::new(&[o, o, x, xy, y]), Err(Error::EdgesMeet { .. })));
    assert!(matches!(Polygon::new(&[o, xx, x, xy, y]), Err(Error::EdgesMeet { .. })));
}
