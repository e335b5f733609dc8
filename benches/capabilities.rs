//! What each capability costs, off and on: time per node and step, bytes per node and per bond.
//!
//! `cargo bench --bench capabilities` prints the table and writes `docs/capabilities.md`. Off and on are
//! timed in turns, so that both see the same machine; the first row is one body twice and shows what
//! is noise. `tests/materials/no_overhead.rs` asserts the sizes.

use pd_testkit::clock::{machine, seconds};
use peridynamics::prelude::*;
use std::hint::black_box;

const M: f64 = 3.015;
const RHO: f64 = 1000.0;
/// Cells along an edge.
const EDGE: usize = 32;
/// Turns of off and on, and the least seconds of each.
const TURNS: usize = 9;
const LEAST: f64 = 0.04;

/// A body and what is done with it in a step.
struct Case {
    name: String,
    step: Box<dyn FnMut()>,
    nodes: f64,
    /// Bytes of all arrays, and of those per bond: constants, bits and rows.
    bytes: f64,
    bond_bytes: f64,
    bonds: f64,
}

fn case_with<T, F, M, P>(
    name: &str,
    mut body: Body<T, 3, F, M, P>,
    mut also: impl FnMut(&Body<T, 3, F, M, P>) + 'static,
) -> Case
where
    T: Real,
    F: Family<T, 3> + 'static,
    F::Bits: 'static,
    F::PerBond<M::BondConst>: 'static,
    M: Material<T, 3> + 'static,
    P: DamagePolicy<T, 3, M> + 'static,
{
    body.set_displacement(|x| {
        SVector::from_fn(|d, _| 1e-4 * ((0.1 + 0.05 * d as f64) * x.sum()).sin())
    });
    let (nodes, bonds, memory) = (body.nodes() as f64, body.family().bonds() as f64, body.memory());
    let mut count = 0;
    let step = move || {
        count += 1;
        body.evaluate_and_break(count, &mut ()).expect("step");
        also(black_box(&body));
    };
    Case {
        name: name.to_owned(),
        step: Box::new(step),
        nodes,
        bytes: memory.total() as f64,
        bond_bytes: (memory.bond_bits + memory.bond_constants) as f64,
        bonds,
    }
}

fn case<T, F, M, P>(name: &str, body: peridynamics::core::Result<Body<T, 3, F, M, P>>) -> Case
where
    T: Real,
    F: Family<T, 3> + 'static,
    F::Bits: 'static,
    F::PerBond<M::BondConst>: 'static,
    M: Material<T, 3> + 'static,
    P: DamagePolicy<T, 3, M> + 'static,
{
    case_with(name, body.expect("body"), |_| ())
}

/// Seconds of a step, over at least [`LEAST`].
fn once(case: &mut Case) -> f64 {
    let (start, mut count) = (seconds(), 0);
    while seconds() - start < LEAST {
        (case.step)();
        count += 1;
    }
    (seconds() - start) / f64::from(count)
}

/// One line of the table.
fn row(capability: &str, mut off: Case, mut on: Case) -> String {
    once(&mut off);
    once(&mut on);
    let mut times: Vec<[f64; 2]> = (0..TURNS).map(|_| [once(&mut off), once(&mut on)]).collect();
    let mut median = |pick: fn(&[f64; 2]) -> f64| {
        times.sort_by(|a, b| pick(a).total_cmp(&pick(b)));
        pick(&times[TURNS / 2])
    };
    let ratio = median(|t| t[1] / t[0]);
    let (a, b) = (median(|t| t[0]), median(|t| t[1]));
    format!(
        "| {capability} | {} | {} | {:.0} | {:.0} | {ratio:.2} | {:.1} | {:.1} | {:.3} | {:.3} |\n",
        off.name,
        on.name,
        1e9 * a / off.nodes,
        1e9 * b / on.nodes,
        off.bytes / off.nodes,
        on.bytes / on.nodes,
        off.bond_bytes / off.bonds,
        on.bond_bytes / on.bonds,
    )
}

fn grid() -> Grid<3> {
    Grid::lattice(SVector::zeros(), SVector::repeat(1.0), [EDGE; 3]).expect("grid")
}
fn lattice<T: Real>(quadrature: Quadrature) -> Lattice<T, 3> {
    Lattice::new(&grid(), Horizon::Cells(M), quadrature).expect("family")
}
fn whole() -> Lattice<f64, 3> {
    lattice(Quadrature::None)
}

fn rows() -> String {
    let moduli = Isotropic::from_young_poisson(1e9, 0.25).expect("moduli");
    let stiffness = Stiffness::<3>::isotropic(&moduli).expect("stiffness");
    let (constant, linear) = (InfluenceFunction::Constant, InfluenceFunction::Linear);
    let solid = || LinearSolid::solid(&moduli, RHO, constant).expect("model");
    let lps = || Ordinary::new(solid());
    let plain = || case("LPS", Body::new(whole(), lps(), NoDamage));
    let nosb = || Correspondence::new(LinearElastic(stiffness), RHO, linear).expect("model");
    let bare = || case("correspondence", Body::new(whole(), nosb(), NoDamage));
    let edge = EDGE as f64;
    let notch = || {
        let corner = [-1.0, 0.5 * edge - 0.5, -1.0];
        let across = [0.0, 0.0, 2.0 * edge];
        Polygon::parallelogram(corner, [0.3 * edge, 0.0, 0.0], across).expect("notch")
    };
    let stretch = || Breaking::new(CriticalStretch::new(1.0).expect("criterion"));
    let energy = || BondEnergy::new(1e9).expect("criterion");
    let half = grid().select(|x| x[0] < 0.5 * edge);
    let sparing = || Breaking::new(energy().sparing(&half));
    let points = Points::from_grid(&grid());
    let cloud = || Cloud::<f64, 3>::new(&points, Horizon::Metres(M), Quadrature::None);
    let graded = || Cloud::<f64, 3>::graded(&points, &vec![M; points.len()], Quadrature::None);
    let regions = || {
        let region = (0..points.len()).map(|node| u8::from(points.position(node)[0] > 0.5 * edge));
        Regions::new([lps(), lps()], region.collect()).expect("regions")
    };
    let mut text = String::new();
    let mut add = |capability: &str, off: Case, on: Case| {
        let row = row(capability, off, on);
        print!("{row}");
        text += &row;
    };
    add("nothing (noise)", plain(), plain());
    let single = LinearSolid::solid(&moduli, RHO, constant).expect("model");
    add(
        "single precision",
        plain(),
        case("f32", Body::new(lattice::<f32>(Quadrature::None), Ordinary::new(single), NoDamage)),
    );
    let small =
        || case("small strain", Body::new(whole(), Ordinary::linearised(solid()), NoDamage));
    add("finite strain, LPS", small(), plain());
    add("β", plain(), case("exact", Body::new(lattice::<f64>(Quadrature::Exact), lps(), NoDamage)));
    add("several materials", plain(), case("two regions", Body::new(whole(), regions(), NoDamage)));
    let cracked = || case("pre-crack only", Body::new(whole(), lps(), Precracked::by(notch())));
    add("pre-crack", plain(), cracked());
    add(
        "breaking, nothing does",
        cracked(),
        case("critical stretch", Body::new(whole(), lps(), stretch().precracked(notch()))),
    );
    let tested = || {
        case("bond energy", Body::new(whole(), lps(), Breaking::new(energy()).precracked(notch())))
    };
    add("breaking, nothing does", cracked(), tested());
    let seldom = Breaking::new(energy()).precracked(notch()).every(10).expect("cadence");
    add(
        "tested every step",
        case("bond energy, every 10th", Body::new(whole(), lps(), seldom)),
        tested(),
    );
    add(
        "nodes that cannot fail",
        tested(),
        case("half of it spared", Body::new(whole(), lps(), sparing().precracked(notch()))),
    );
    let body = Body::new(whole(), lps(), NoDamage).expect("body");
    let strain_energy = case_with("strain energy read every step", body, |body| {
        black_box(body.strain_energy());
    });
    add("energies", plain(), strain_energy);
    let body = Body::new(whole(), nosb(), NoDamage).expect("body");
    let stress = case_with("stress read every step", body, |body| {
        (0..body.nodes()).for_each(|node| {
            black_box(body.stress(node));
        });
    });
    add("stress output", bare(), stress);
    let silling = SillingControl::new(1e9, 0.3).expect("control");
    add(
        "zero-energy control",
        bare(),
        case("Silling", Body::new(whole(), nosb().with_control(silling), NoDamage)),
    );
    let wan = WanControl::new(&stiffness, 1.0).expect("control");
    add(
        "zero-energy control",
        bare(),
        case("Wan", Body::new(whole(), nosb().with_control(wan), NoDamage)),
    );
    let svk = Correspondence::new(SaintVenantKirchhoff(stiffness), RHO, linear).expect("model");
    add(
        "finite strain, correspondence",
        bare(),
        case("Saint-Venant–Kirchhoff", Body::new(whole(), svk, NoDamage)),
    );
    let uniform =
        || case("cloud, one horizon", Body::new(cloud().expect("cloud"), lps(), NoDamage));
    add("a lattice's order", plain(), uniform());
    add(
        "dual horizon",
        uniform(),
        case("a horizon per node", Body::new(graded().expect("cloud"), lps(), NoDamage)),
    );
    text
}

fn main() {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).use_current_thread().build_global();
    pool.expect("one thread");
    println!("| capability | off | on | ns | ns | ratio | bytes/node | | bytes/bond | |");
    let rows = rows();
    let text = format!(
        "# What capabilities cost\n\nWritten by `cargo bench --bench capabilities` on {}.\n\nA body of \
         {EDGE}³ nodes in 3D, m = {M}, f64 on a lattice unless it says otherwise; states, bond test and \
         forces of a step, processor time of one thread, medians of {TURNS} turns of off and on. Ratios \
         are medians of the ratios within a turn; the first row is one body twice. Bytes per bond are \
         constants and bits per undirected bond, a part of the bytes per node. What is off has no array \
         and no pass: `tests/materials/no_overhead.rs` asserts it to the byte. Bits are held, and bonds \
         tested, where bonds can break or are cut. Parts of a body ahead of a wave are computed like \
         others: numbers that are not zero run ahead of it by one or two horizons a step, so that what \
         could be left out without a change in any bit is gone after the first steps of a scene \
         (`cargo test --test runs front -- --nocapture`: 68 and 35 steps across 200 nodes).\n\n| capability | off | on | ns per \
         node-step, off | on | ratio | bytes per node, off | on | bytes per bond, off | on |\n| --- | \
         --- | --- | --- | --- | --- | --- | --- | --- | --- |\n{rows}",
        machine()
    );
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/capabilities.md");
    std::fs::write(path, text).expect("docs/capabilities.md");
}
