//! What becomes of shape tensors that cannot be inverted, or hardly: families of no bond, of one,
//! on a line, in a plane, almost so. Each policy gives the right inverse or a typed error.

use approx::assert_relative_eq;
use nalgebra::{Rotation2, Rotation3, SMatrix, SVector, Vector3};
use pd_core::shape::{IllConditioned, ShapePolicy, shape_tensor};
use pd_core::{Error, Member, Neighbourhood, Scale};
use proptest::prelude::*;

const REFUSE: ShapePolicy = ShapePolicy { rule: IllConditioned::Refuse, limit: 1e6 };
const DETACH: ShapePolicy = ShapePolicy { rule: IllConditioned::Detach, limit: 1e6 };
const PSEUDO: ShapePolicy = ShapePolicy { rule: IllConditioned::PseudoInverse, limit: 1e6 };
const NODE: usize = 7;

/// K of bonds with weight ω and volume V each.
fn tensor<const D: usize>(bonds: &[(SVector<f64, D>, f64, f64)]) -> SMatrix<f64, D, D> {
    let member = |&(xi, bond, volume): &_| Member { xi, volume, bond };
    let members: Vec<_> = bonds.iter().map(member).collect();
    let scale = Scale { horizon: 3.0, unit: 1e-3 };
    shape_tensor(&Neighbourhood { node: NODE, scale, members: &members }, |&omega| omega)
}

/// The condition number that the error of [`IllConditioned::Refuse`] gives.
fn refused<const D: usize>(policy: ShapePolicy, k: &SMatrix<f64, D, D>) -> f64 {
    match policy.invert(k, NODE, 5) {
        Err(Error::SingularShapeTensor { node: NODE, condition, limit, neighbours: 5 }) => {
            assert_eq!(limit, policy.limit);
            condition
        }
        other => panic!("not refused: {other:?}"),
    }
}

/// The four conditions of Moore and Penrose, which only one B meets, relative to K and B.
fn assert_pseudo_inverse<const D: usize>(
    k: &SMatrix<f64, D, D>,
    b: &SMatrix<f64, D, D>,
    tolerance: f64,
) {
    assert!(b.iter().all(|x| x.is_finite()), "{b}");
    let (kb, bk) = (k * b, b * k);
    assert!((kb * k - k).amax() <= tolerance * k.amax(), "KBK = K: {k}{b}");
    assert!((bk * b - b).amax() <= tolerance * b.amax(), "BKB = B: {k}{b}");
    assert!((kb - kb.transpose()).amax() <= tolerance, "KB is symmetric: {kb}");
    assert!((bk - bk.transpose()).amax() <= tolerance, "BK is symmetric: {bk}");
}

/// K = R diag(values) Rᵀ from a pair of bonds along each axis, of length √(value/2).
fn of_values<const D: usize>(values: [f64; D], turn: &SMatrix<f64, D, D>) -> SMatrix<f64, D, D> {
    let pair = |a: usize| {
        let xi: SVector<f64, D> = turn.column(a) * (values[a] / 2.0).sqrt();
        [(xi, 1.0, 1.0), (-xi, 1.0, 1.0)]
    };
    tensor(&(0..D).flat_map(pair).collect::<Vec<_>>())
}

fn turn2(angle: f64) -> SMatrix<f64, 2, 2> {
    Rotation2::new(angle).into_inner()
}

fn turn3([a, b, c]: [f64; 3]) -> SMatrix<f64, 3, 3> {
    Rotation3::from_euler_angles(a, b, c).into_inner()
}

#[test]
fn no_bond_or_none_with_weight() {
    fn check<const D: usize>() {
        let xi = SVector::<f64, D>::repeat(0.5);
        for bonds in [vec![], vec![(xi, 0.0, 1.0), (-xi, 0.0, 1.0)]] {
            let k = tensor(&bonds);
            assert_eq!(refused(REFUSE, &k), f64::INFINITY);
            for policy in [DETACH, PSEUDO] {
                assert_eq!(policy.invert(&k, NODE, 0), Ok(SMatrix::zeros()));
            }
        }
    }
    check::<2>();
    check::<3>();
}

/// Bonds along n with Σ ωVr² = s: K = s n⊗n, whose pseudo-inverse is n⊗n/s.
fn check_line<const D: usize>(n: SVector<f64, D>, bonds: &[(f64, f64, f64)]) {
    let n = n.normalize();
    let along: Vec<_> = bonds.iter().map(|&(r, omega, volume)| (n * r, omega, volume)).collect();
    let k = tensor(&along);
    let condition = refused(REFUSE, &k);
    assert!(condition > 1e14, "{condition:e}");
    assert_eq!(DETACH.invert(&k, NODE, bonds.len()), Ok(SMatrix::zeros()));
    let b = PSEUDO.invert(&k, NODE, bonds.len()).unwrap();
    let s: f64 = bonds.iter().map(|&(r, omega, volume)| omega * volume * r * r).sum();
    assert!((b * s - n * n.transpose()).amax() < 1e-13, "{b}");
}

/// Along the axes too, where K has exact zeros.
#[test]
fn on_an_axis() {
    for bonds in [vec![(1.0, 1.0, 1.0)], vec![(1.0, 0.7, 1.0), (-2.0, 0.3, 0.5)]] {
        for axis in 0..3 {
            check_line(SVector::<f64, 3>::ith(axis, 1.0), &bonds);
        }
        for axis in 0..2 {
            check_line(SVector::<f64, 2>::ith(axis, -1.0), &bonds);
        }
    }
}

/// Without a limit too, a direction that no bond has is not divided by.
#[test]
fn without_a_limit() {
    let k = tensor(&[(SVector::<f64, 2>::new(2.0, 0.0), 1.0, 1.0)]);
    let policy = |rule| ShapePolicy { rule, limit: f64::INFINITY };
    let error = policy(IllConditioned::Refuse).invert(&k, NODE, 1);
    assert!(matches!(error, Err(Error::SingularShapeTensor { node: NODE, .. })), "{error:?}");
    assert_eq!(policy(IllConditioned::Detach).invert(&k, NODE, 1), Ok(SMatrix::zeros()));
    let b = policy(IllConditioned::PseudoInverse).invert(&k, NODE, 1).unwrap();
    assert_eq!(b, SMatrix::<f64, 2, 2>::new(0.25, 0.0, 0.0, 0.0));
}

/// Bonds in a plane: the plane's inverse, nothing across.
fn check_plane(turn: [f64; 3], bonds: &[(f64, f64)]) {
    let turn = turn3(turn);
    let lift = |&(x, y): &(f64, f64)| (turn * Vector3::new(x, y, 0.0), 0.8, 1.0);
    let k = tensor(&bonds.iter().map(lift).collect::<Vec<_>>());
    let condition = refused(REFUSE, &k);
    assert!(condition > 1e13, "{condition:e}");
    assert_eq!(DETACH.invert(&k, NODE, bonds.len()), Ok(SMatrix::zeros()));
    let b = PSEUDO.invert(&k, NODE, bonds.len()).unwrap();
    let in_plane: Vec<_> =
        bonds.iter().map(|&(x, y)| (SVector::<f64, 2>::new(x, y), 0.8, 1.0)).collect();
    let inverse = tensor(&in_plane).try_inverse().unwrap();
    let back = turn.transpose() * b * turn;
    let inside = back.fixed_view::<2, 2>(0, 0).into_owned();
    assert!((inside - inverse).amax() < 1e-11 * inverse.amax(), "{back}{inverse}");
    assert!(back.column(2).amax() < 1e-11 * inverse.amax(), "{back}");
}

/// Where the eigenvalues lie against the limit decides which directions have an inverse.
fn check_spectrum<const D: usize>(values: [f64; D], turn: &SMatrix<f64, D, D>, limit: f64) {
    let largest = values.iter().copied().fold(0.0, f64::max);
    let smallest = values.iter().copied().fold(f64::INFINITY, f64::min);
    let condition = largest / smallest;
    let k = of_values(values, turn);
    let policy = |rule| ShapePolicy { rule, limit };
    let rules = [IllConditioned::Refuse, IllConditioned::Detach, IllConditioned::PseudoInverse];
    let of = |kept: &dyn Fn(f64) -> bool| {
        (0..D).filter(|&a| kept(values[a])).fold(SMatrix::zeros(), |sum, a| {
            let axis: SVector<f64, D> = turn.column(a).into_owned();
            sum + axis * axis.transpose() / values[a]
        })
    };
    // An inverse loses as many digits as the condition number has.
    if condition < limit {
        let inverse: SMatrix<f64, D, D> = of(&|_| true);
        for rule in rules {
            let b = policy(rule).invert(&k, NODE, 5).unwrap();
            let error = (b - inverse).amax() / inverse.amax();
            assert!(error < 1e-14 * condition, "{values:?} {limit:e}: {error:e}");
        }
        return;
    }
    let told = refused(policy(rules[0]), &k);
    assert!((told / condition - 1.0).abs() < 1e-14 * condition, "{told:e} for {condition:e}");
    assert_eq!(policy(rules[1]).invert(&k, NODE, 5), Ok(SMatrix::zeros()));
    let b = policy(rules[2]).invert(&k, NODE, 5).unwrap();
    let kept = |value: f64| value * limit > largest;
    let inverse: SMatrix<f64, D, D> = of(&kept);
    let worst = largest / values.iter().copied().filter(|&v| kept(v)).fold(largest, f64::min);
    let error = (b - inverse).amax() / inverse.amax();
    assert!(error < 1e-14 * worst.max(10.0), "{values:?} {limit:e}: {error:e}");
}

/// Condition numbers 1e3 to 1e12 against limits between them.
#[test]
fn almost_singular() {
    for power in 3..=12 {
        let small = 10_f64.powi(-power);
        for limit in [3e3, 3e6, 3e9] {
            for angle in [0.0, 0.4, 1.1, 2.0] {
                check_spectrum([1.7, 1.7 * small], &turn2(angle), limit);
                let turn = turn3([angle, -0.3 * angle, 1.9 * angle]);
                check_spectrum([1.0, 1.0, small], &turn, limit);
                check_spectrum([small, 2.0, small], &turn, limit);
                check_spectrum([small, 10_f64.powf(-0.45 * f64::from(power)), 1.0], &turn, limit);
            }
        }
    }
}

/// Families of the usual lattices stay far below the default limit.
#[test]
fn a_full_lattice_is_well_conditioned() {
    let reach = -3..=3;
    let places = reach.clone().flat_map(|i| reach.clone().map(move |j| [i, j].map(f64::from)));
    let all: Vec<_> = places
        .map(SVector::<f64, 2>::from)
        .filter(|xi| xi.norm() > 0.0 && xi.norm() <= 3.0)
        .map(|xi| (xi, 1.0 - xi.norm() / 3.0, 1.0))
        .collect();
    // By symmetry K = k 1; half of the family, as at a free edge, is still fine.
    let k = tensor(&all);
    assert_relative_eq!(k, SMatrix::<f64, 2, 2>::identity() * k[(0, 0)], epsilon = 1e-13);
    let half: Vec<_> = all.iter().copied().filter(|(xi, ..)| xi.y >= 0.0).collect();
    for k in [k, tensor(&half)] {
        let b = ShapePolicy { rule: IllConditioned::Refuse, limit: 100.0 }.invert(&k, NODE, 24);
        assert_pseudo_inverse(&k, &b.unwrap(), 1e-14);
    }
}

/// The unit of length is the user's: K spans hundreds of orders of magnitude, its condition none.
#[test]
fn any_unit_of_length() {
    fn check<const D: usize>(values: [f64; D], turn: &SMatrix<f64, D, D>) {
        for power in (-120..=120).step_by(5) {
            let unit = 10_f64.powi(power);
            let k = of_values(values, turn) * unit;
            for policy in [REFUSE, DETACH, PSEUDO] {
                assert_pseudo_inverse(&k, &policy.invert(&k, NODE, 5).unwrap(), 1e-12);
            }
        }
    }
    check([1.0, 0.3], &turn2(0.6));
    check([1.0, 0.3, 0.1], &turn3([0.6, 0.2, -1.0]));
}

/// A tensor that is not finite, as with a weight that is not, is an error under every rule: the
/// node is not badly conditioned, its numbers are bad.
#[test]
fn not_finite() {
    for weight in [f64::INFINITY, f64::NAN] {
        let k = tensor(&[(SVector::<f64, 2>::new(1.0, 0.5), weight, 1.0)]);
        for policy in [REFUSE, DETACH, PSEUDO] {
            let error = policy.invert(&k, NODE, 1).unwrap_err();
            assert!(matches!(error, Error::InvalidNodeValue { node: NODE, .. }), "{error}");
        }
    }
}

fn direction<const D: usize>() -> impl Strategy<Value = SVector<f64, D>> {
    prop::array::uniform3(-1.0..1.0_f64)
        .prop_map(|x| SVector::<f64, D>::from_fn(|d, _| x[d]))
        .prop_filter("a direction", |n| n.norm() > 0.1)
}

/// Length along the line, weight, volume.
fn line() -> impl Strategy<Value = Vec<(f64, f64, f64)>> {
    let length = (0.5..3.0_f64, prop::bool::ANY).prop_map(|(r, back)| if back { -r } else { r });
    prop::collection::vec((length, 0.01..1.0_f64, 0.2..1.0_f64), 1..8)
}

proptest! {
    /// One bond, or several on a line, in any direction.
    #[test]
    fn on_a_line_in_the_plane(n in direction::<2>(), bonds in line()) {
        check_line(n, &bonds);
    }

    #[test]
    fn on_a_line_in_space(n in direction::<3>(), bonds in line()) {
        check_line(n, &bonds);
    }

    #[test]
    fn in_a_plane_in_space(
        turn in prop::array::uniform3(-3.0..3.0_f64),
        bonds in prop::collection::vec((-3.0..3.0_f64, -3.0..3.0_f64), 0..8),
    ) {
        // With these two the plane's own tensor is well conditioned.
        let bonds = [vec![(2.0, 0.3), (-0.4, 1.5)], bonds].concat();
        check_plane(turn, &bonds);
    }

    /// Any family at all: finite, symmetric, and the inverse whenever it is not refused.
    #[test]
    fn never_nan(
        bonds in prop::collection::vec((direction::<3>(), 0.0..1.0_f64), 0..6),
        flat in 0.0..1.0_f64,
        squash in 0..18_i32,
    ) {
        let squash = if flat < 0.3 { 0.0 } else { 10_f64.powi(-squash) };
        let squashed = bonds.iter().map(|(xi, w)| (Vector3::new(xi.x, xi.y, xi.z * squash), *w, 1.0));
        let k = tensor(&squashed.collect::<Vec<_>>());
        let [detach, pseudo] = [DETACH, PSEUDO].map(|policy| policy.invert(&k, NODE, 5).unwrap());
        for b in [detach, pseudo] {
            prop_assert!(b.iter().all(|x| x.is_finite()), "{}", b);
            prop_assert!((b - b.transpose()).amax() <= 1e-9 * b.amax());
        }
        match REFUSE.invert(&k, NODE, 5) {
            Ok(b) => {
                prop_assert!(b == detach && b == pseudo);
                prop_assert!((k * b - SMatrix::identity()).amax() < 1e-8);
            }
            Err(Error::SingularShapeTensor { condition, .. }) => {
                prop_assert!(condition > 1e6 && detach.amax() == 0.0);
            }
            Err(other) => prop_assert!(false, "{}", other),
        }
    }
}
