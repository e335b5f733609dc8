//! What an observer sees: its cadence, energies, reactions, the crack's tip, the margin; and that
//! it can end a run.
use crate::common;
use peridynamics::core::run::kinetic_energy;
use peridynamics::observe::{
    FieldOutput, Progress, Table, snapshot, snapshot_with_energy, snapshot_with_stress,
};
use peridynamics::prelude::*;
use std::cell::RefCell;
use std::io::Write;
use std::path::PathBuf;
use std::rc::Rc;

const DX: f64 = 1e-3;
const GAUSS: InfluenceFunction = InfluenceFunction::Gaussian;

fn folder(name: &str) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("peridynamics_{name}_{}", std::process::id()));
    let _ = std::fs::remove_dir_all(&folder);
    folder
}

type Plate<P> = Body<f64, 2, Lattice<f64, 2>, Ordinary<Pmb>, P>;

fn grid() -> Grid<2> {
    Grid::new(&Cuboid::centred([30.0 * DX, 20.0 * DX]).expect("box"), DX).expect("grid")
}

fn plate<P: DamagePolicy<f64, 2, Ordinary<Pmb>>>(policy: P) -> Plate<P> {
    let third = Isotropic::from_young_poisson(7e10, 1.0 / 3.0).expect("moduli");
    let pmb = Pmb::plane(&third, PlaneMode::PlaneStress, 2700.0, GAUSS).expect("material");
    let family = Lattice::new(&grid(), Horizon::Cells(3.0), Quadrature::None).expect("family");
    Body::new(family, Ordinary::new(pmb), policy).expect("body")
}

/// Grips at top and bottom that part at ±`speed`.
fn pull(speed: f64) -> (Loads, [NodeSet; 2]) {
    let (low, high) = (grid().select(|x| x[1] < -8.0 * DX), grid().select(|x| x[1] > 8.0 * DX));
    let loads = Loads::new().velocity(&low, 1, -speed).velocity(&high, 1, speed);
    (loads, [low, high])
}

fn stretch(critical: f64) -> Breaking<CriticalStretch, 2> {
    Breaking::new(CriticalStretch::new(critical).expect("criterion"))
}

#[test]
fn cadence_and_early_stop() {
    let mut body = plate(NoDamage);
    let (often, seldom) = (RefCell::new(Vec::new()), RefCell::new(Vec::new()));
    let mut run = Run::new(&mut body, Loads::new(), TimeStep::Safety(0.5)).expect("run");
    run.observe(3, |view: &View<'_, Plate<NoDamage>>| {
        assert!((view.time - view.step as f64 * view.dt).abs() < 1e-9 * view.dt);
        assert!(view.energies.is_none());
        often.borrow_mut().push(view.step);
        Ok(Flow::Continue)
    });
    run.observe(10, |view: &View<'_, Plate<NoDamage>>| {
        seldom.borrow_mut().push(view.step);
        Ok(if view.step >= 20 { Flow::Stop } else { Flow::Continue })
    });
    let end = 1000.0 * run.dt();
    run.until(end).expect("run");
    assert_eq!(run.steps(), 20, "the run ends early");
    drop(run);
    assert_eq!(often.into_inner(), [0, 3, 6, 9, 12, 15, 18]);
    assert_eq!(seldom.into_inner(), [0, 10, 20]);
}

#[test]
fn an_observer_may_fail_or_stop_before_the_first_step() {
    let mut body = plate(NoDamage);
    let mut run = Run::new(&mut body, Loads::new(), TimeStep::Safety(0.5)).expect("run");
    run.observe(1, |view: &View<'_, Plate<NoDamage>>| match view.step {
        0..5 => Ok(Flow::Continue),
        _ => Err(Error::Other("disk full".to_owned())),
    });
    let error = run.until(1.0).expect_err("ends");
    assert_eq!((error.to_string().as_str(), run.steps()), ("disk full", 5));
    drop(run);
    let mut run = Run::new(&mut body, Loads::new(), TimeStep::Safety(0.5)).expect("run");
    run.observe(1, |_: &View<'_, Plate<NoDamage>>| Ok(Flow::Stop));
    run.until(1.0).expect("run");
    assert_eq!(run.steps(), 0);
}

/// What came in but is neither there nor dissipated, and what was dissipated, of a run that breaks
/// many bonds.
fn gap(safety: f64) -> [f64; 2] {
    let crack = Segment::new([-5.2 * DX, 0.0], [5.2 * DX, 0.0]).expect("crack");
    let mut body = plate(stretch(5e-3).precracked(crack));
    // Without the shock of grips that start at once.
    body.set_velocity(|x| [0.0, 10.0 * x[1] / (8.5 * DX)].into());
    let (loads, _) = pull(10.0);
    let middle = grid().select(|x| x[1].abs() < 3.0 * DX);
    let loads = loads.body_force(&middle, 0, |t: f64| 1e14 * t);
    let (last, start) = (RefCell::new(Energies::default()), RefCell::new(None));
    let rule = TimeStep::Safety(safety);
    let mut run = Run::new(&mut body, loads, rule).expect("run").with_energies();
    run.observe(20, |view: &View<'_, Plate<_>>| {
        let e = view.energies.expect("energies");
        assert!((e.kinetic - kinetic_energy(view.body)).abs() <= 1e-12 * e.kinetic);
        assert!((e.strain - view.body.strain_energy()).abs() <= 1e-12 * e.strain);
        start.borrow_mut().get_or_insert(e.kinetic);
        *last.borrow_mut() = e;
        Ok(Flow::Continue)
    });
    run.until(20e-6).expect("run");
    let broken = run.body().broken_bonds();
    drop(run);
    let (e, start) = (last.into_inner(), start.into_inner().expect("energies"));
    let gap = start + e.external - (e.kinetic + e.strain + e.dissipated);
    println!("{broken} bonds broken, {gap:.3e} J lost of {start:.3e} J at the start: {e:?}");
    assert!(broken > 100 && e.dissipated > 0.05 * (start + e.external));
    [gap, e.dissipated]
}

/// Energy is accounted for: what is lost is of second order in the time step, although a bond breaks
/// at the end of a step and its force is then gone for the second half of the kick.
#[test]
fn energies_balance() {
    let [coarse, dissipated] = gap(0.2);
    assert!(coarse.abs() < 0.1 * dissipated, "{coarse:e} of {dissipated:e}");
    let [fine, dissipated] = gap(0.02);
    assert!(fine.abs() < 0.01 * dissipated, "{fine:e} of {dissipated:e}");
    assert!(fine.abs() < 0.04 * coarse.abs(), "{fine:e} {coarse:e}");
}

/// Newton: the impulse of the grips' reactions is the momentum that the free nodes gain (exactly
/// that of the trapezoids that velocity Verlet sums).
#[test]
fn reactions() {
    let mut body = plate(NoDamage);
    let (low, high) = (grid().select(|x| x[1] < -8.0 * DX), grid().select(|x| x[1] > 8.0 * DX));
    let loads = Loads::new().clamp::<2>(&low).velocity(&high, 1, 20.0).displacement(&high, 0, 0.0);
    let free: Vec<usize> =
        (0..body.nodes()).filter(|&i| !low.contains(i) && !high.contains(i)).collect();
    let (impulse, momentum) = (RefCell::new(SVector::<f64, 2>::zeros()), RefCell::new(Vec::new()));
    let before = RefCell::new(None);
    let mut run = Run::new(&mut body, loads, TimeStep::Safety(0.5)).expect("run");
    run.observe(1, |view: &View<'_, Plate<NoDamage>>| {
        let now = reaction(view.body, &low) + reaction(view.body, &high);
        if let Some(before) = before.borrow_mut().replace(now) {
            *impulse.borrow_mut() += (before + now) * (0.5 * view.dt);
        }
        let sum: SVector<f64, 2> =
            free.iter().map(|&i| view.body.velocity(i) * view.body.mass(i)).sum();
        momentum.borrow_mut().push(sum);
        Ok(Flow::Continue)
    });
    run.steps_more(60).expect("steps");
    // The upper grip pulls up, the lower one holds down.
    assert!(reaction(run.body(), &high)[1] > 0.0 && reaction(run.body(), &low)[1] < 0.0);
    drop(run);
    let (impulse, last) = (impulse.into_inner(), *momentum.borrow().last().expect("momentum"));
    assert!((impulse - last).norm() < 1e-10 * last.norm(), "{impulse} {last}");
}

#[test]
fn the_crack_tip_is_where_the_crack_ends() {
    let cut = |from: f64, to: f64| Segment::new([from * DX, 0.0], [to * DX, 0.0]).expect("crack");
    let mut body = plate(Precracked::by(cut(-4.7, 0.3)));
    let tip = CrackTip::new(&body, [0.3 * DX, 0.0]).expect("tip");
    assert_eq!(tip.growth(&body), 0.0);
    for end in [6.2, 10.2] {
        body.cut(&cut(0.3, end)).expect("cut");
        let found = tip.position(&body);
        assert!((found[0] - end * DX).abs() < 1.01 * DX && found[1].abs() < DX, "{end}: {found}");
        assert!((tip.growth(&body) - (end - 0.3) * DX).abs() < 1.1 * DX);
    }
    // A crack elsewhere is not its growth.
    let mut body = plate(Precracked::by(cut(-12.7, -8.3)));
    let tip = CrackTip::new(&body, [-8.3 * DX, 0.0]).expect("tip");
    body.cut(&cut(2.3, 10.2)).expect("cut");
    assert_eq!(tip.growth(&body), 0.0);
    assert!(CrackTip::new(&body, [f64::NAN, 0.0]).is_err());
}

#[test]
fn the_crack_tip_in_space() {
    let grid = Grid::new(&Cuboid::centred([16.0 * DX, 6.0 * DX, 8.0 * DX]).expect("box"), DX);
    let family =
        Lattice::<f64, 3>::new(&grid.expect("grid"), Horizon::Cells(3.0), Quadrature::None);
    let quarter = Isotropic::from_young_poisson(7e10, 0.25).expect("moduli");
    let pmb = Ordinary::new(Pmb::solid(&quarter, 2700.0, GAUSS).expect("material"));
    let cut = |from: f64, to: f64| {
        let z = 9.0 * DX;
        Polygon::parallelogram(
            [from * DX, -z, 0.0],
            [(to - from) * DX, 0.0, 0.0],
            [0.0, 2.0 * z, 0.0],
        )
        .expect("crack")
    };
    let mut body =
        Body::new(family.expect("family"), pmb, Precracked::by(cut(-9.0, -2.7))).expect("b");
    let tip = CrackTip::new(&body, [-2.7 * DX, 0.0, 0.0]).expect("tip");
    body.cut(&cut(-2.7, 3.2)).expect("cut");
    let found = tip.position(&body);
    assert!((found[0] - 3.2 * DX).abs() < 1.01 * DX, "{found}");
}

/// A writer whose text the test keeps.
#[derive(Clone, Default)]
struct Log(Rc<RefCell<Vec<u8>>>);

impl Write for Log {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        self.0.borrow_mut().write(bytes)
    }
    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

/// What progress writes about a run with this critical stretch, and the margin after it.
fn progress(critical: f64) -> (String, Margin) {
    let log = Log::default();
    let mut body = plate(stretch(critical));
    let (loads, _) = pull(10.0);
    let mut run = Run::new(&mut body, loads, TimeStep::Safety(0.5)).expect("run");
    run.observe(10, Progress::to(log.clone(), "plate"));
    let end = 200.0 * run.dt();
    run.until(end).expect("run");
    drop(run);
    let text = String::from_utf8(log.0.borrow().clone()).expect("text");
    (text, Margin::of(&body))
}

#[test]
fn progress_and_the_margin() {
    let (text, margin) = progress(0.08);
    println!("{text}");
    assert_eq!(margin.broken, 0);
    assert!(margin.worst > 0.01 && margin.worst < 1.0, "{margin:?}");
    let line = format!("no bond broke; the worst reached {:.2}", margin.worst);
    assert_eq!(margin.to_string(), line);
    assert_eq!(text.matches('\r').count(), 21, "one line every ten steps, over itself");
    assert!(text.contains("plate [........................]   0 %  step 0, t = 0.000e0 s"));
    assert!(text.contains("[########################] 100 %  step 200"));
    assert!(text.ends_with(&format!("\nplate: {line}\n")), "{text}");

    let (text, margin) = progress(0.5 * 0.08 * margin.worst);
    assert!(margin.broken > 1 && margin.worst > 1.0, "{margin:?}");
    let closing = format!("{} bonds broke; the worst reached {:.2}\n", margin.broken, margin.worst);
    assert!(text.ends_with(&closing), "{text}");

    // A body that cannot break says nothing of it, and a run that ends early closes the line.
    let log = Log::default();
    let mut body = plate(NoDamage);
    let mut run = Run::new(&mut body, Loads::new(), TimeStep::Safety(0.5)).expect("run");
    run.observe(10, Progress::to(log.clone(), "bar"));
    run.observe(30, |view: &View<'_, Plate<NoDamage>>| {
        Ok(if view.step > 0 { Flow::Stop } else { Flow::Continue })
    });
    run.until(1.0).expect("run");
    drop(run);
    let text = String::from_utf8(log.0.borrow().clone()).expect("text");
    assert!(!text.contains("bond") && text.ends_with("left   \n"), "{text}");
}

#[test]
fn time_left_of_a_run_that_goes_on() {
    let log = Log::default();
    let mut body = plate(NoDamage);
    let mut run = Run::new(&mut body, Loads::new(), TimeStep::Safety(0.5)).expect("run");
    let end = 200.0 * run.dt();
    run.until(0.5 * end).expect("run");
    run.observe(1, |view: &View<'_, Plate<NoDamage>>| {
        let pause = if view.step == 115 { 300 } else { 0 };
        std::thread::sleep(std::time::Duration::from_millis(pause));
        Ok(Flow::Continue)
    });
    run.observe(10, Progress::to(log.clone(), "bar"));
    run.until(end).expect("run");
    drop(run);
    let text = String::from_utf8(log.0.borrow().clone()).expect("text");
    // The first line comes at step 110: from there a ninth of what was left took 0.3 s.
    let line = text.split('\r').find(|line| line.contains("step 120")).expect("line");
    let left = line.split(", ").last().and_then(|part| part.split(' ').next());
    let left: f64 = left.and_then(|number| number.parse().ok()).expect("seconds");
    assert!(left >= 2.0, "{line}");
}

#[test]
fn histories_and_fields() {
    let folder = folder("observers");
    let mut body = plate(stretch(2e-3));
    let tip = CrackTip::new(&body, [0.0, 0.0]).expect("tip");
    let (loads, [_, high]) = pull(10.0);
    let mut run = Run::new(&mut body, loads, TimeStep::Safety(0.5)).expect("run").with_energies();
    run.observe(
        10,
        Table::new(folder.join("history.csv"))
            .column("strain [J]", |view: &View<'_, Plate<_>>| {
                view.energies.map_or(f64::NAN, |e| e.strain)
            })
            .column("reaction [N]", |view| reaction(view.body, &high)[1])
            .column("tip x [m]", |view| tip.position(view.body)[0])
            .column("broken bonds", |view| view.body.broken_bonds() as f64)
            .column("worst index", |view| view.body.worst_index()),
    );
    run.observe(
        25,
        FieldOutput::create(&folder, "plate", snapshot_with_energy::<f64, 2, _, _, _>)
            .expect("series"),
    );
    run.steps_more(100).expect("steps");
    drop(run);
    let text = std::fs::read_to_string(folder.join("history.csv")).expect("history");
    let rows: Vec<&str> = text.lines().collect();
    assert_eq!(rows.len(), 12);
    assert_eq!(rows[0], "time [s],strain [J],reaction [N],tip x [m],broken bonds,worst index");
    let last: Vec<f64> = rows[11].split(',').map(|x| x.parse().expect("number")).collect();
    assert!((last[1] - body.strain_energy()).abs() < 1e-9 * last[1]);
    assert_eq!(last[4] as usize, body.broken_bonds());
    let index = std::fs::read_to_string(folder.join("plate.pvd")).expect("index");
    assert_eq!(index.matches("<DataSet").count(), 5);
    for step in 0..5 {
        let file = std::fs::read(folder.join(format!("plate_{step:06}.vtu"))).expect("file");
        let text = String::from_utf8_lossy(&file);
        for field in ["displacement", "velocity", "damage", "strain energy density"] {
            assert!(text.contains(&format!("Name=\"{field}\"")), "{field}");
        }
        assert!(!text.contains("Name=\"stress\""), "a bond-based body has none");
    }
    std::fs::remove_dir_all(folder).expect("removed");
}

/// A body in space, with a field of your own beside stress and energy.
#[test]
fn fields_in_space() {
    type Block = Body<f64, 3, Cloud<f64, 3>, Correspondence<LinearElastic<3>>, NoDamage>;
    let folder = folder("observers_3d");
    let points = Points::from_grid(&common::block(DX));
    let family = Cloud::new(&points, Horizon::Cells(2.3), Quadrature::None).expect("family");
    let law = LinearElastic(common::solid());
    let material = Correspondence::new(law, 1586.0, GAUSS).expect("material");
    let mut body: Block = Body::new(family, material, NoDamage).expect("body");
    let strain = SMatrix::<f64, 3, 3>::from_fn(|i, j| 1e-4 * (1.0 + (i + j) as f64));
    body.set_displacement(|x| strain * x);
    let take = |body: &Block| {
        let speed: Vec<f64> = (0..body.nodes()).map(|i| body.velocity(i).norm()).collect();
        snapshot_with_stress(body)
            .scalar("strain energy density", &body.energy_densities())
            .scalar("speed", &speed)
    };
    snapshot(&body).write(folder.join("bare.vtu")).expect("written");
    let mut run = Run::new(&mut body, Loads::new(), TimeStep::Safety(0.5)).expect("run");
    run.observe(5, FieldOutput::create(&folder, "block", take).expect("series"));
    run.steps_more(10).expect("steps");
    drop(run);
    let file = std::fs::read(folder.join("block_000002.vtu")).expect("file");
    let text = String::from_utf8_lossy(&file);
    assert!(text.contains(&format!("NumberOfPoints=\"{}\"", body.nodes())));
    for field in ["displacement", "velocity", "damage", "stress", "strain energy density", "speed"]
    {
        assert!(text.contains(&format!("Name=\"{field}\"")), "{field}");
    }
    if std::env::var_os("KEEP").is_none() {
        std::fs::remove_dir_all(folder).expect("removed");
    } else {
        println!("{}", folder.display());
    }
}
