//! Bodies from 1 nm to 100 km, densities from 10⁻³ to 10⁵ kg/m³, in `f32` and `f64`: the same
//! numbers in units of Δx, the wave speed and the modulus.
use super::*;
use pd_testkit::specimen::CRITERIA;

/// u/Δx of every node, and broken bonds; or the error.
type Numbers = std::result::Result<(Vec<f64>, usize), String>;

/// What a body does, in its own units.
fn pulled<const D: usize>(points: &Points<D>, body: &mut dyn Specimen<D>) -> Numbers {
    let [left, right] = ends(points);
    let unit = body.unit();
    let loads = Loads::new().clamp::<D>(&left).displacement(&right, 0, 1e-3 * unit);
    body.solve(&Statics::new(), loads).map_err(kind)?;
    Ok((numbers(body), 0))
}

/// Torn apart by its own motion.
fn torn<const D: usize>(speed: f64, body: &mut dyn Specimen<D>) -> Numbers {
    let unit = body.unit();
    body.deform(&|_| SVector::zeros());
    body.launch(&|x| {
        let mut v = wavy(&(x * (DX / unit)), 0.02 * speed);
        v[0] += 0.05 * speed * x[0] / unit;
        v
    });
    body.run(Loads::new(), TimeStep::Unchecked(0.08 * unit / speed), 40).map_err(kind)?;
    Ok((numbers(body), body.broken_bonds()))
}

fn numbers<const D: usize>(body: &dyn Specimen<D>) -> Vec<f64> {
    assert!(body.is_finite());
    let unit = body.unit();
    (0..body.nodes()).flat_map(|i| Vec::from((body.displacement(i) / unit).as_slice())).collect()
}

/// The error without its numbers.
fn kind(error: Error) -> String {
    let text = format!("{error:?}");
    text.split(['{', ' ', '(']).next().unwrap_or_default().to_owned()
}

/// Both outcomes of every specimen.
fn outcomes<const D: usize>(
    recipe: &Recipe<D>,
    list: Vec<Named<D>>,
) -> Vec<(&'static str, [Numbers; 2])> {
    let speed = (recipe.moduli.young() / recipe.density).sqrt();
    let both = |(name, mut body): (&'static str, Box<dyn Specimen<D>>)| {
        let still = pulled(&recipe.points, &mut *body);
        (name, [still, torn(speed, &mut *body)])
    };
    all(list).into_iter().map(both).collect()
}

fn scaled<const D: usize>(recipe: &Recipe<D>, length: f64, density: f64) -> Recipe<D> {
    let cells = std::array::from_fn(|d| if D == 2 { [8, 6][d] } else { [5, 4, 4][d] });
    let unit = length / cells[0] as f64;
    Recipe {
        points: cloud(cells, unit, 0.0, 1.0, 0).expect("points"),
        horizon: recipe.horizon / DX * unit,
        density,
        ..recipe.clone()
    }
}

/// Largest difference relative to the largest number.
fn difference(a: &[f64], b: &[f64]) -> f64 {
    let size = a.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) / size
}

fn alike<const D: usize>(
    recipe: &Recipe<D>,
    specimens: fn(&Recipe<D>) -> Vec<Named<D>>,
    limit: f64,
) -> usize {
    let by = recipe.tear.by;
    let base = scaled(recipe, 1.0, 2500.0);
    let base = outcomes(&base, specimens(&base));
    let (mut broken, mut worst) = (0, [0.0_f64; 2]);
    for (length, density) in [(1e-9, 1e5), (1e-9, 1e-3), (1e5, 1e-3), (1e5, 1e5), (3e-2, 7e3)] {
        let recipe = scaled(recipe, length, density);
        let found = outcomes(&recipe, specimens(&recipe));
        for ((name, a), (_, b)) in base.iter().zip(&found) {
            for (k, what) in ["statics", "run"].into_iter().enumerate() {
                let place = format!("{by:?}, {name}, {what}, L = {length:e}, ρ = {density:e}");
                match (&a[k], &b[k]) {
                    (Ok((a, lost)), Ok((b, lost_too))) => {
                        assert_eq!(lost, lost_too, "{place}");
                        let off = difference(a, b);
                        worst[k] = worst[k].max(off);
                        assert!(off <= limit, "{place}: {off:e}");
                        broken += lost;
                    }
                    (a, b) => assert_eq!(a, b, "{place}"),
                }
            }
        }
    }
    println!("{D}D, {by:?}: statics to {:.1e}, runs to {:.1e}", worst[0], worst[1]);
    broken
}

fn every_criterion<const D: usize>(
    recipe: &Recipe<D>,
    specimens: fn(&Recipe<D>) -> Vec<Named<D>>,
    limit: f64,
) {
    for by in CRITERIA {
        let recipe = Recipe { tear: Tear { by, at: 0.05 }, ..recipe.clone() };
        assert!(alike(&recipe, specimens, limit) > 0, "{by:?}: nothing broke");
    }
}

#[test]
fn in_double_precision() {
    every_criterion(&plate(), Recipe::<2>::specimens::<f64>, 1e-12);
    every_criterion(&block(), Recipe::<3>::specimens::<f64>, 1e-12);
}

#[test]
fn in_single_precision() {
    every_criterion(&plate(), Recipe::<2>::specimens::<f32>, 1e-5);
    every_criterion(&block(), Recipe::<3>::specimens::<f32>, 1e-5);
}
