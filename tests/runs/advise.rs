//! What the advisor says before a run is what the run shows.
use crate::common;
use pd_testkit::plane_wave::PlaneWave;
use peridynamics::advise::{Error, Precision, SAFETY};
use peridynamics::models::Linearised;
use peridynamics::models::elasticity::catalogue::{
    GRAPHITE_EPOXY, GRAPHITE_EPOXY_DENSITY as DENSITY,
};
use peridynamics::prelude::*;
use std::time::Instant;

const GAUSS: InfluenceFunction = InfluenceFunction::Gaussian;
const LENGTH: f64 = 10e-3;

type Split = Ordinary<PositiveSplit<2, 3>, Linearised>;
type Wan = Correspondence<LinearElastic<2>, WanControl<2>>;

fn ply() -> Stiffness<2> {
    Stiffness::<2>::lamina(&GRAPHITE_EPOXY).expect("ply").rotated(0.4)
}
fn split() -> Split {
    Ordinary::linearised(PositiveSplit::plane(&ply(), DENSITY, GAUSS).expect("split"))
}
fn wan() -> Wan {
    let bare = Correspondence::new(LinearElastic(ply()), DENSITY, GAUSS).expect("law");
    bare.with_control(WanControl::new(&ply(), 1.0).expect("control"))
}
fn lattice<T: Real, const D: usize>(shape: &dyn Shape<D>, advice: &Advice<D>) -> Lattice<T, D> {
    let grid = Grid::new(shape, advice.spacing).expect("grid");
    Lattice::new(&grid, Horizon::Cells(advice.m), advice.quadrature).expect("family")
}

/// A wave in the direction in which the advisor says it errs most, in space and time.
#[test]
fn the_error_is_that_of_a_run() {
    fn check<M: Material<f64, 2> + Material<f32, 2>>(name: &str, material: &M, target: f64) {
        let plate = Cuboid::centred([2.0 * LENGTH; 2]).expect("plate");
        let mut advisor =
            Advisor::new(&plate, (&ply(), DENSITY), LENGTH, 1e-5, target).expect("advisor");
        advisor.consider(name, material).expect("material");
        let advice = advisor.advise().expect("advice");
        println!("{advice}");
        assert!(advice.error <= target && advice.error > 0.8 * target, "{}", advice.error);
        let course = (advice.direction, advice.branch);
        let wave = PlaneWave::new((&ply(), DENSITY), course, LENGTH, 1.0).expect("wave");
        let family = lattice::<f64, 2>(&wave.shape().expect("shape"), &advice);
        let mut body = Body::new(family, material, NoDamage).expect("body");
        wave.start(&mut body);
        let mut run = Run::new(&mut body, Loads::new(), TimeStep::Safety(SAFETY)).expect("run");
        assert!((run.dt() / advice.time_step - 1.0).abs() < 0.02, "{}", run.dt());
        run.until(wave.time).expect("run");
        let misfit = wave.misfit(run.body(), run.time());
        let ratio = misfit.speed.abs() / advice.error;
        println!("{name}: speed off by {:.4}, foreseen {:.4}", misfit.speed, advice.error);
        assert!((0.5..2.0).contains(&ratio), "{name}: {ratio}");
    }
    check("split", &split(), 0.04);
    check("split", &split(), 0.015);
    check("Wan", &wan(), 0.08);
}

#[test]
fn memory_and_steps_are_those_of_the_body() {
    fn held<T: Real, const D: usize, M: Material<T, D>>(
        shape: &dyn Shape<D>,
        advice: &Advice<D>,
        material: &M,
    ) {
        let mut body = Body::new(lattice::<T, D>(shape, advice), material, NoDamage).expect("body");
        assert_eq!(body.nodes(), advice.nodes);
        let bytes = body.memory().total() as f64 / advice.bytes as f64;
        let dt = Run::new(&mut body, Loads::new(), TimeStep::Safety(SAFETY)).expect("run").dt();
        println!("{}: memory × {bytes:.4}, step × {:.4}", T::NAME, dt / advice.time_step);
        assert!((bytes - 1.0).abs() < 0.05, "{bytes}");
        assert!((dt / advice.time_step - 1.0).abs() < 0.02, "{dt}");
    }
    let hole = Ball::new([5e-3, 0.0], 8e-3).expect("hole");
    let plate = Cuboid::centred([0.09, 0.05]).expect("plate").without(hole);
    // A long run must not lose the error to rounding: f64; a short one: f32.
    for (duration, precision) in [(1e-6, Precision::Single), (10.0, Precision::Double)] {
        let (split, wan) = (split(), wan());
        let mut advisor =
            Advisor::new(&plate, (&ply(), DENSITY), LENGTH, duration, 0.02).expect("advisor");
        advisor.consider("split", &split).expect("material");
        let advice = advisor.advise().expect("advice");
        assert_eq!(advice.precision, precision);
        assert_eq!(advice.material, "split");
        match precision {
            Precision::Single => held::<f32, 2, _>(&plate, &advice, &split),
            Precision::Double => held::<f64, 2, _>(&plate, &advice, &split),
        }
        advisor.consider("Wan", &wan).expect("material");
        let advice = advisor.advise().expect("advice");
        let other = if advice.material == "split" { "Wan" } else { "split" };
        assert!(advice.others.iter().any(|line| line.starts_with(other)), "{advice}");
    }
    let solid = common::solid();
    let beam = Cuboid::centred([0.1, 0.04, 0.03]).expect("beam");
    let material = Ordinary::linearised(PositiveSplit::solid(&solid, 1e3, GAUSS).expect("split"));
    let mut advisor = Advisor::new(&beam, (&solid, 1e3), 25e-3, 1e-6, 0.2).expect("advisor");
    advisor.consider("split", &material).expect("material");
    held::<f32, 3, _>(&beam, &advisor.advise().expect("advice"), &material);
}

#[test]
fn where_nothing_fits_it_says_why() {
    let plate = Cuboid::centred([0.1, 0.1]).expect("plate");
    let advisor = |error| Advisor::new(&plate, (&ply(), DENSITY), LENGTH, 1e-5, error);
    assert!(matches!(advisor(0.01).expect("a").advise(), Err(Error::NothingConsidered)));
    assert!(matches!(
        advisor(-0.01),
        Err(Error::Core(peridynamics::core::Error::InvalidValue { .. }))
    ));
    // Polynomial micromoduli of a carbon ply amplify waves; no lattice is as fine as the second asks.
    let polynomial = PolynomialMicromoduli::plane(&ply(), DENSITY, GAUSS).expect("polynomial");
    let (polynomial, split) = (Ordinary::linearised(polynomial), split());
    let mut some = advisor(1e-7).expect("advisor");
    some.consider("polynomial", &polynomial).expect("material");
    some.consider("split", &split).expect("material");
    let told = some.advise().expect_err("no choice").to_string();
    println!("{told}");
    assert!(told.contains("polynomial, m = 3: amplifies a wave"), "{told}");
    assert!(told.contains("split, m = 2: ") && told.contains("is the least at 400"), "{told}");
    let mut one = advisor(0.05).expect("advisor");
    one.consider("polynomial", &polynomial).expect("material");
    one.consider("split", &split).expect("material");
    assert_eq!(one.advise().expect("advice").material, "split");
}

/// Needs a machine that does nothing else:
/// `cargo test --release --test runs advise -- --ignored --nocapture`.
#[test]
#[ignore = "measures time"]
fn wall_time_is_foreseen() {
    fn check<const D: usize, M: Material<f64, D> + Material<f32, D>>(
        name: &str,
        material: &M,
        (shape, stiffness, density): (&dyn Shape<D>, &Stiffness<D>, f64),
        (wavelength, duration, error): (f64, f64, f64),
    ) -> bool {
        let mut advisor = Advisor::new(shape, (stiffness, density), wavelength, duration, error)
            .expect("advisor");
        advisor.consider(name, material).expect("material");
        let start = Instant::now();
        let advice = advisor.advise().expect("advice");
        println!("{advice}  advised in {:.1} s", start.elapsed().as_secs_f64());
        let seconds = match advice.precision {
            Precision::Single => timed::<f32, D, M>(shape, &advice, material, duration),
            Precision::Double => timed::<f64, D, M>(shape, &advice, material, duration),
        };
        let ratio = seconds / advice.seconds;
        let near = (0.7..1.3).contains(&ratio);
        println!("{name}: {seconds:.2} s, foreseen {:.2} s, ratio {ratio:.2}", advice.seconds);
        near
    }
    fn timed<T: Real, const D: usize, M: Material<T, D>>(
        shape: &dyn Shape<D>,
        advice: &Advice<D>,
        material: &M,
        duration: f64,
    ) -> f64 {
        let start = Instant::now();
        let mut body = Body::new(lattice::<T, D>(shape, advice), material, NoDamage).expect("body");
        body.set_displacement(|x| x.map(|x| 1e-7 * (x / advice.spacing).sin() * advice.spacing));
        let mut run = Run::new(&mut body, Loads::new(), TimeStep::Safety(SAFETY)).expect("run");
        run.until(duration).expect("run");
        let steps = run.steps() as f64 / advice.steps as f64;
        assert!((steps - 1.0).abs() < 0.02, "{steps}");
        start.elapsed().as_secs_f64()
    }
    let plate = Cuboid::centred([0.3, 0.2]).expect("plate");
    let of_ply = (&plate as &dyn Shape<2>, &ply(), DENSITY);
    let mut near = vec![check("split", &split(), of_ply, (5e-3, 20e-6, 0.03))];
    near.push(check("Wan", &wan(), of_ply, (10e-3, 10e-6, 0.05)));
    let solid = common::solid();
    let block = Cuboid::centred([0.1, 0.08, 0.08]).expect("block");
    let material = Ordinary::linearised(PositiveSplit::solid(&solid, 1e3, GAUSS).expect("split"));
    let of_solid = (&block as &dyn Shape<3>, &solid, 1e3);
    near.push(check("split, 3D", &material, of_solid, (20e-3, 40e-6, 0.1)));
    assert!(near.iter().all(|&near| near), "within 30 %: {near:?}");
}
