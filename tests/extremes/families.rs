//! Families that are almost singular, collinear, of one bond, or empty; nodes that lose every bond
//! in mid-run. `crates/pd-core/tests/parts/shape_conditioning.rs` has the shape tensors alone.
use super::*;
use pd_testkit::specimen::{CRITERIA, Criterion};
use peridynamics::models::Error as ModelError;

fn cloud_of(places: &[[f64; 2]]) -> Points<2> {
    let positions = places.iter().map(|&[x, y]| SVector::from([x * DX, y * DX])).collect();
    let points = Points::new(positions, vec![DX * DX; places.len()]).expect("points");
    points.with_spacing(DX).expect("spacing")
}

/// Refused with a reason, or finite and in balance when strained, turned and run.
fn right_or_refused(what: &str, points: Points<2>) -> usize {
    let recipe = Recipe { points, ..plate() };
    let mut refused = 0;
    for Named { name, body } in recipe.specimens::<f64>() {
        let mut body = match body {
            Ok(body) => body,
            Err(error) => {
                println!("{what}, {name}: {error}");
                refused += 1;
                continue;
            }
        };
        for size in [1e-4, 1e-2] {
            body.deform(&|x| x * size + wavy(x, 0.1 * size * DX));
            match body.evaluate() {
                Ok(()) => {
                    let off = body.unbalanced();
                    assert!(body.is_finite() && off < 1e-12, "{what}, {name}: {off:e}");
                    let energy = body.strain_energy();
                    assert!(energy >= 0.0 || name.contains("polynomial"), "{name}: {energy:e}");
                }
                Err(error) => assert!(matches!(error, Error::Inverted { .. }), "{error}"),
            }
        }
        body.deform(&|_| SVector::zeros());
        body.launch(&|x| wavy(x, 1e-3 * C));
        match body.run(Loads::new(), TimeStep::Safety(0.5), 200) {
            Ok(_) => assert!(body.is_finite(), "{what}, {name}"),
            Err(error) => {
                println!("{what}, {name}: {error}");
                let energy_free = matches!(error, Error::InvalidValue { .. });
                let indefinite = matches!(error, Error::UnstableBody { .. });
                assert!(energy_free || indefinite, "{what}, {name}: {error}");
            }
        }
    }
    refused
}

#[test]
fn collinear() {
    let line: Vec<[f64; 2]> = (0..12).map(|i| [f64::from(i), 0.0]).collect();
    right_or_refused("a line", cloud_of(&line));
    let slope: Vec<[f64; 2]> = (0..12).map(|i| [0.6 * f64::from(i), 0.8 * f64::from(i)]).collect();
    right_or_refused("a slope", cloud_of(&slope));
}

#[test]
fn almost_collinear() {
    for off in [1e-2, 1e-4, 1e-8, 1e-15] {
        let line: Vec<[f64; 2]> =
            (0..12).map(|i| [f64::from(i), if i % 3 == 1 { off } else { 0.0 }]).collect();
        right_or_refused(&format!("a line within {off:e} Δx"), cloud_of(&line));
    }
}

#[test]
fn one_bond() {
    right_or_refused("a pair", cloud_of(&[[0.0, 0.0], [1.0, 0.3]]));
    // A square of nodes, and one that hangs by a single bond.
    let mut square: Vec<[f64; 2]> = (0..16).map(|i| [f64::from(i % 4), f64::from(i / 4)]).collect();
    square.push([5.4, 0.1]);
    right_or_refused("a tail", cloud_of(&square));
}

#[test]
fn no_bond() {
    let mut square: Vec<[f64; 2]> = (0..16).map(|i| [f64::from(i % 4), f64::from(i / 4)]).collect();
    square.push([9.0, 0.0]);
    let recipe = Recipe { points: cloud_of(&square), ..plate() };
    for Named { name, body } in recipe.specimens::<f64>() {
        let error = body.err();
        let empty = ModelError::Core(Error::EmptyFamily {
            node: 16,
            position: vec![9.0 * DX, 0.0],
            horizon: 2.5 * DX,
        });
        assert_eq!(error, Some(empty), "{name}");
    }
}

/// A corner is shot off: it loses every bond and then flies as it is, the rest goes on.
#[test]
fn nodes_that_lose_every_bond() {
    for by in CRITERIA {
        let recipe = Recipe { tear: Tear { by, at: 0.02 }, ..plate() };
        for (name, mut body) in all(recipe.specimens::<f64>()) {
            body.set_in_motion(0, &[-0.3 * C, -0.2 * C].into());
            let momentum = |body: &dyn Specimen<2>| -> SVector<f64, 2> {
                (0..body.nodes()).map(|i| body.velocity(i) * body.mass(i)).sum()
            };
            let before = momentum(&*body);
            let rule = TimeStep::Fixed(0.05 * DX / C);
            match body.run(Loads::new(), rule, 300) {
                Ok(_) => {}
                Err(error) => {
                    println!("{by:?}, {name}: {error}");
                    assert!(
                        matches!(error, Error::During { .. } | Error::UnstableBody { .. }),
                        "{by:?}, {name}: {error}"
                    );
                    continue;
                }
            }
            assert!(body.is_finite(), "{by:?}, {name}");
            let lost = (momentum(&*body) - before).norm() / before.norm();
            assert!(lost < 1e-11, "{by:?}, {name}: {lost:e}");
            if matches!(by, Criterion::Stretch | Criterion::Opening) {
                assert!(body.damage(0) == 1.0 && body.damage(47) < 1.0, "{by:?}, {name}");
                let flight = body.velocity(0);
                body.run(Loads::new(), rule, 10).expect("flight");
                assert_eq!(body.velocity(0), flight, "{by:?}, {name}");
            }
        }
    }
}
