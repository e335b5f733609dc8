//! A program killed at any moment leaves a checkpoint that loads; Ctrl-C ends its run after a step,
//! with the state written and a word on how to go on.
#![cfg(unix)]
use peridynamics::checkpoint::Checkpoint;
use peridynamics::prelude::*;
use std::os::unix::fs::MetadataExt;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant, SystemTime};

/// The program: a plate that swings for as long as it may, a checkpoint every step.
fn swing(path: &Path) -> Result<()> {
    let (mut body, rule) = (plate(), TimeStep::Fixed(1e-8));
    let mut run = Run::new(&mut body, Loads::new(), rule)?;
    let checkpoint = Checkpoint::new(path);
    checkpoint.resume(&mut run)?;
    checkpoint.keep(&mut run, 1)?;
    run.until(1.0)
}

fn plate() -> Body<f64, 2, Lattice<f64, 2>, Ordinary<Pmb>, NoDamage> {
    let grid = Grid::new(&Cuboid::centred([0.05, 0.05]).expect("box"), 1e-3).expect("grid");
    let moduli = Isotropic::from_young_poisson(70e9, 1.0 / 3.0).expect("moduli");
    let constant = InfluenceFunction::Constant;
    let law = Pmb::plane(&moduli, PlaneMode::PlaneStress, 2500.0, constant).expect("law");
    let family = Lattice::new(&grid, Horizon::Cells(3.0), Quadrature::None).expect("family");
    let mut body = Body::new(family, Ordinary::new(law), NoDamage).expect("body");
    body.set_velocity(|x| [x[0], 0.0].into());
    body
}

/// This test program again, as the program.
fn program(path: &Path) -> Child {
    Command::new(std::env::current_exe().expect("program"))
        .args(["--exact", "as_a_program", "--ignored", "--nocapture"])
        .env("PD_CHECKPOINT", path)
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .expect("starts")
}

#[test]
#[ignore = "the program that the other tests start"]
fn as_a_program() {
    let Some(path) = std::env::var_os("PD_CHECKPOINT") else { return };
    if let Err(error) = swing(Path::new(&path)) {
        eprintln!("ended: {error}");
    }
}

fn file(name: &str) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("pd-interrupted-{}-{name}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("folder");
    folder.join("swing.state")
}

/// Steps taken by the state in the file.
fn steps(path: &Path) -> usize {
    let mut body = plate();
    let mut run = Run::new(&mut body, Loads::new(), TimeStep::Fixed(1e-8)).expect("run");
    let time = Checkpoint::new(path).resume(&mut run).expect("a good checkpoint");
    assert!(time.is_some(), "there is a checkpoint");
    run.steps()
}

/// Which writing of the file it is: a checkpoint takes the place of the last one as a new file.
fn writing(path: &Path) -> Option<(u64, SystemTime)> {
    let file = std::fs::metadata(path).ok()?;
    Some((file.ino(), file.modified().ok()?))
}

/// Waits until the program writes a checkpoint after `last`.
fn wait_for(path: &Path, last: Option<(u64, SystemTime)>) {
    let start = Instant::now();
    while writing(path) == last {
        assert!(start.elapsed() < Duration::from_secs(60), "no checkpoint after a minute");
        std::thread::sleep(Duration::from_millis(1));
    }
}

#[test]
fn killed_at_any_moment() {
    let path = file("kill");
    let mut reached = 0;
    for moment in 0..12 {
        let last = writing(&path);
        let mut child = program(&path);
        wait_for(&path, last);
        // Ever sooner: one that began anew would not get as far as the one before.
        std::thread::sleep(Duration::from_millis(3 * (11 - moment)));
        child.kill().expect("killed");
        child.wait().expect("gone");
        let now = steps(&path);
        assert!(now > reached, "from step {reached} to {now}: each start goes on");
        reached = now;
    }
}

#[test]
fn ctrl_c() {
    let path = file("ctrl-c");
    let child = program(&path);
    wait_for(&path, None);
    let id = child.id().to_string();
    Command::new("kill").args(["-INT", &id]).status().expect("interrupts");
    let ended = child.wait_with_output().expect("ends");
    let said = String::from_utf8_lossy(&ended.stderr);
    let at = format!("interrupted after step {}", steps(&path));
    assert!(said.contains(&at) && said.contains(&path.display().to_string()), "{said}");
    assert!(said.contains("Checkpoint::resume"), "{said}");
}
