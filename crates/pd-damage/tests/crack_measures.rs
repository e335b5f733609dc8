//! Measures of cracks on damage fields drawn by hand, in 2D and 3D.

use nalgebra::SVector;
use pd_damage::crack_path::{
    CrackPath, Mirror, branches, fit_line, inclination, path, path_at, symmetry_error, without_ends,
};
use pd_damage::{Measures, TipTrack};

const DX: f64 = 0.5;

/// A plate of 40 × 40 nodes about the origin with a damage field.
fn plate(damage: impl Fn(f64, f64) -> f64) -> Vec<(SVector<f64, 2>, f64)> {
    let at = |i: i32| DX * (f64::from(i) - 19.5);
    let nodes = (0..1600).map(|k| SVector::<f64, 2>::new(at(k % 40), at(k / 40)));
    nodes.map(|x| (x, damage(x[0], x[1]))).collect()
}

fn crack(nodes: &[(SVector<f64, 2>, f64)]) -> CrackPath<2> {
    CrackPath::new(DX, nodes.iter().enumerate().map(|(i, n)| (i, n.0, n.1)))
}

/// Two rows of nodes on either side of y = y(x) for x from 0 on.
fn line(slope: f64) -> Vec<(SVector<f64, 2>, f64)> {
    plate(|x, y| {
        let off = (y - slope * x).abs() / (1.0 + slope * slope).sqrt();
        if x >= 0.0 && off < 0.75 * DX { 0.41 } else { 0.1 }
    })
}

#[test]
fn angle_path_and_tip_of_an_inclined_crack() {
    for degrees in [-50.0_f64, -20.0, 0.0, 30.0, 45.0] {
        let slope = degrees.to_radians().tan();
        let nodes = line(slope);
        let cracks = crack(&nodes);
        let origin = SVector::<f64, 2>::zeros();
        let own = cracks.at_tip(&origin);
        let corner = SVector::<f64, 2>::repeat(10.0);
        let fitted = without_ends(&own, &origin, (&-corner, &corner), DX);
        assert!(fitted.len() < own.len());
        let line = fit_line(&fitted).expect("line");
        assert!((line.angle.to_degrees() - degrees).abs() < 2.5, "{degrees}: {line:?}");
        let way = path(&own, DX);
        for &(x, y) in &way[..way.len() / 2] {
            assert!((y - slope * x).abs() < 1.5 * DX, "{degrees}: {y} at {x}");
        }
        let there = path_at(&way, 2.5).expect("path");
        assert!((there - 2.5 * slope).abs() < 1.5 * DX);
        let slope = inclination(&way, 0.0, 6.0).expect("slope");
        assert!((slope - degrees).abs() < 6.0, "{slope} {degrees}");
        let ahead = SVector::<f64, 2>::new(1.0, 0.0);
        let tip = cracks.tip(&origin, &ahead);
        assert!(tip[0] > 6.0 && (cracks.growth(&origin) - tip.norm()).abs() < 2.0 * DX);
        assert_eq!(branches(&own, 4.0, DX), 1);
    }
    assert_eq!(path_at(&[], 0.0), None);
    assert_eq!(inclination(&[(0.0, 0.0)], -1.0, 1.0), None);
}

#[test]
fn branches_and_joins() {
    // A trunk that splits at x = 0 and one that does not touch it.
    let nodes = plate(|x, y| {
        let fork = if x < 0.0 { y.abs() } else { (y.abs() - x).abs() };
        let other = if x < -2.0 { (y + 9.0).abs() } else { 9.0 };
        if fork < 0.75 * DX || other < 0.75 * DX { 0.5 } else { 0.0 }
    });
    let cracks = crack(&nodes);
    let [left, up, down] = [[-9.5, 0.0], [8.0, 8.0], [8.0, -7.0]].map(SVector::<f64, 2>::from);
    let trunk = cracks.at_tip(&left);
    assert_eq!(branches(&trunk, -5.0, DX), 1);
    assert_eq!(branches(&trunk, 5.0, DX), 2);
    assert_eq!(branches(&trunk, 50.0, DX), 0);
    assert!(cracks.joins(&left, &up) && cracks.joins(&up, &down));
    let below = SVector::<f64, 2>::new(-9.5, -9.0);
    assert!(!cracks.joins(&left, &below));
    assert_eq!(cracks.largest().len(), trunk.len());
    assert!(crack(&plate(|_, _| 0.3)).largest().is_empty());
}

#[test]
fn symmetry_is_told_by_its_kind() {
    let zero = SVector::<f64, 2>::zeros();
    let error = |nodes: &[_], mirror| symmetry_error(nodes, (mirror, &zero), DX);
    let about_y = plate(|x, y| (x + y * y).exp().recip());
    assert!(error(&about_y, Mirror::Y) < 1e-12);
    assert!(error(&about_y, Mirror::X) > 0.1 && error(&about_y, Mirror::Point) > 0.1);
    let point = plate(|x, y| if x * y > 0.0 { 0.5 } else { 0.1 });
    assert!(error(&point, Mirror::Point) < 1e-12);
    assert!((error(&point, Mirror::X) - 4.0 / 3.0).abs() < 1e-12);
    // A crack on one side only has no image at all: |D − 0| + |0 − D| over D.
    let mut half = plate(|x, _| if x > 0.0 { 0.5 } else { 0.0 });
    assert!((error(&half, Mirror::X) - 2.0).abs() < 1e-12);
    half.retain(|n| n.0[0] > 0.0);
    assert!((error(&half, Mirror::X) - 1.0).abs() < 1e-12);
    assert_eq!(error(&plate(|_, _| 0.0), Mirror::X), 0.0);
}

#[test]
fn overlap_of_two_cracks() {
    let (a, b) = (crack(&line(0.0)), crack(&line(0.1)));
    let overlap = a.jaccard(&b);
    assert!(overlap > 0.1 && overlap < 0.9, "{overlap}");
    assert_eq!(a.jaccard(&a), 1.0);
    let none = crack(&plate(|_, _| 0.0));
    assert_eq!(a.jaccard(&none), 0.0);
    assert_eq!(none.jaccard(&none), 1.0);
}

#[test]
fn a_crack_in_space() {
    let at = |i: i32| f64::from(i) - 4.5;
    let nodes = (0..1000).map(|k| {
        let x = SVector::<f64, 3>::new(at(k % 10), at(k / 10 % 10), at(k / 100));
        let separated = x[1].abs() < 1.0 && x[0] < 2.0;
        (k as usize, x, if separated { 0.4 } else { 0.0 })
    });
    let cracks = CrackPath::new(1.0, nodes);
    assert_eq!(cracks.largest().len(), 2 * 10 * 7);
    let start = SVector::<f64, 3>::new(-4.5, 0.0, 0.0);
    let tip = cracks.tip(&start, &SVector::<f64, 3>::new(1.0, 0.0, 0.0));
    assert_eq!(tip[0], 1.5);
    assert!(path(cracks.nodes(), 1.0).iter().all(|p| p.1.abs() < 1e-12));
}

#[test]
fn speed_of_a_tip_that_jumps_by_cells() {
    let mut track = TipTrack::<2>::new();
    for k in 0..100 {
        let time = f64::from(k) * 0.1;
        // 3 m/s from t = 2 s on, seen in steps of Δx.
        let way = (3.0 * (time - 2.0).max(0.0) / DX).floor() * DX;
        track.add(time, SVector::<f64, 2>::new(0.6 * way, 0.8 * way));
    }
    let speed = track.speed(3.0, 9.0).expect("speed");
    assert!((speed - 3.0).abs() < 0.05, "{speed}");
    assert!(track.speed(0.0, 1.5).expect("speed").abs() < 1e-9);
    assert_eq!(track.speed(20.0, 30.0), None);
    let start = track.time_of(1.0).expect("time");
    assert!((start - 2.5).abs() < 0.11, "{start}");
    assert_eq!(track.time_of(1e3), None);
}

#[test]
fn measures_pass_and_fail() {
    let mut measures = Measures::new("title", "command");
    measures.hard_near("a", 1.0, 1.1, 0.2).hard_least("b", 3.0, 2.0).soft("c", false);
    assert!(measures.passed());
    assert!(measures.to_markdown().contains("| c (SOFT) | holds | fails | **no** |"));
    for fail in [
        Measures::hard_near(&mut measures.clone(), "d", f64::NAN, 0.0, 1.0),
        Measures::hard_most(&mut measures.clone(), "e", 2.0, 1.0),
        Measures::hard(&mut measures.clone(), "f", false),
    ] {
        assert!(!fail.passed());
    }
    let file = std::env::temp_dir().join(format!("measures-{}/table.md", std::process::id()));
    measures.write(&file).expect("written");
    assert_eq!(std::fs::read_to_string(&file).expect("read"), measures.to_markdown());
    std::fs::remove_dir_all(file.parent().expect("folder")).expect("removed");
}
