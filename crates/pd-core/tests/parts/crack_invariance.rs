//! What a crack cuts depends neither on the bond's direction nor on the frame.

use nalgebra::{Rotation2, Rotation3, Vector2, Vector3};
use pd_core::CrackSurface;
use pd_core::crack::{Polygon, Segment};
use proptest::prelude::*;

fn plane() -> impl Strategy<Value = Vector2<f64>> {
    prop::array::uniform2(-1.0..1.0).prop_map(Vector2::from)
}

fn space() -> impl Strategy<Value = Vector3<f64>> {
    prop::array::uniform3(-1.0..1.0).prop_map(Vector3::from)
}

/// Places on a coarse lattice, so that touching and parallel cases are common.
fn lattice() -> impl Strategy<Value = Vector3<f64>> {
    prop::array::uniform3(-2..3i32).prop_map(|x| Vector3::from(x.map(|x| 0.3 * f64::from(x))))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn segment(
        c in plane(),
        d in plane(),
        a in plane(),
        b in plane(),
        by in plane(),
        turn in 0.0..6.3,
    ) {
        prop_assume!((d - c).norm() > 0.01);
        let crack = Segment::new(c.into(), d.into()).unwrap();
        let cut = crack.cuts(&a, &b);
        prop_assert_eq!(crack.cuts(&b, &a), cut);
        prop_assert_eq!(Segment::new(d.into(), c.into()).unwrap().cuts(&a, &b), cut);
        let turn = Rotation2::new(turn);
        let moved = |x| turn * x + by;
        let crack = Segment::new((moved(c)).into(), (moved(d)).into()).unwrap();
        prop_assert_eq!(crack.cuts(&moved(a), &moved(b)), cut);
        // where bond and crack are exchanged, crossing is the same
        prop_assert_eq!(Segment::new(a.into(), b.into()).unwrap().cuts(&c, &d), cut);
    }

    #[test]
    fn polygon(
        o in space(),
        e in space(),
        f in space(),
        a in space(),
        b in space(),
        by in space(),
        turn in space(),
    ) {
        prop_assume!(e.cross(&f).norm() > 0.01);
        let cut = check_moved([o, e, f], [a, b], by, turn)?;
        // the crossing with its plane, solved for instead
        let solved = nalgebra::Matrix3::from_columns(&[e, f, a - b]).lu().solve(&(a - o));
        let inside = solved.is_some_and(|s| s.iter().all(|s| (0.0..=1.0).contains(s)));
        prop_assert_eq!(cut, inside);
    }

    #[test]
    fn polygon_touched(
        o in lattice(),
        e in lattice(),
        f in lattice(),
        a in lattice(),
        b in lattice(),
        by in space(),
        turn in space(),
    ) {
        prop_assume!(e.cross(&f).norm() > 0.01);
        let crack = Polygon::parallelogram(o.into(), e.into(), f.into()).unwrap();
        prop_assume!(crack.distance(&a) > 1e-6 && crack.distance(&b) > 1e-6);
        check_moved([o, e, f], [a, b], by, turn)?;
    }
}

fn check_moved(
    [o, e, f]: [Vector3<f64>; 3],
    [a, b]: [Vector3<f64>; 2],
    by: Vector3<f64>,
    turn: Vector3<f64>,
) -> Result<bool, TestCaseError> {
    let crack = Polygon::parallelogram(o.into(), e.into(), f.into()).unwrap();
    let cut = crack.cuts(&a, &b);
    prop_assert_eq!(crack.cuts(&b, &a), cut);
    prop_assert_eq!(
        Polygon::parallelogram(o.into(), f.into(), e.into()).unwrap().cuts(&a, &b),
        cut
    );
    prop_assert_eq!(
        Polygon::parallelogram((o + e).into(), f.into(), (-e).into()).unwrap().cuts(&a, &b),
        cut
    );
    let turn = Rotation3::new(turn * 3.0);
    let moved = |x| turn * x + by;
    let there =
        Polygon::parallelogram((moved(o)).into(), (turn * e).into(), (turn * f).into()).unwrap();
    prop_assert_eq!(there.cuts(&moved(a), &moved(b)), cut);
    Ok(cut)
}
