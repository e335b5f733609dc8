//! A crack that runs through a strip dissipates the fracture energy put in, for every criterion
//! that is calibrated by it; and as printed, Willberg's ¼ makes it twice that.
use peridynamics::prelude::*;

const RHO: f64 = 1e3;

/// Runs a crack through a strip whose edges are pulled apart; dissipated energy per area of new
/// crack.
fn cost<M: StrainEnergy<f64, 2>, C: DamageCriterion<f64, 2, M>>(
    material: M,
    criterion: impl Fn(&CrackPlane<2>) -> C,
    (m, expected): (f64, f64),
) -> f64 {
    let (length, height, notch) = (70.0, 24.0, 22.0);
    let grid = Grid::new(&Cuboid::centred([length, height]).expect("box"), 1.0).expect("grid");
    let family = Lattice::<f64, 2>::new(&grid, Horizon::Cells(m), Quadrature::None).expect("f");
    let plane = CrackPlane::lattice(&family, [0.0, 1.0]).expect("plane");
    let [top, bottom] =
        [1.0, -1.0].map(|side| grid.select(move |x| side * x[1] > 0.5 * height - 3.0));
    let left = -0.5 * length;
    let crack = Segment::new([left - 1.0, 0.0], [left + notch, 0.0]).expect("crack");
    let policy = Breaking::new(criterion(&plane).sparing(&top.union(&bottom))).precracked(crack);
    let mut body = Body::new(family, material, policy).expect("body");
    let still = |loads: Loads, nodes: &NodeSet| loads.displacement(nodes, 0, 0.0);
    // Smoothly to nine tenths of the strain at which a long crack starts, ½E'ε²H = G, then slowly
    // on, so that the crack runs at what it needs.
    let free = height - 6.0;
    let onset = (2.0 * expected / (1.1e3 * free)).sqrt() * 0.5 * free;
    let ramp = move |t: f64| {
        let r = (t / 200.0).min(1.0);
        onset * (0.9 * r * r * (3.0 - 2.0 * r) + 4e-4 * t)
    };
    let loads = still(still(Loads::new(), &top), &bottom).displacement(&top, 1, ramp).displacement(
        &bottom,
        1,
        move |t: f64| -ramp(t),
    );
    let start: Vec<f64> = (0..body.nodes()).map(|i| body.damage(i)).collect();
    let mut run = Run::new(&mut body, loads, TimeStep::Safety(0.7)).expect("run").with_energies();
    let tip = left + notch;
    let open = 0.85 * plane.face_damage();
    let cracks = |body: &Body<f64, 2, _, M, _>| {
        let gained = (0..body.nodes()).map(|i| (i, body.position(i), body.damage(i) - start[i]));
        CrackPath::above(open, 1.0, gained)
    };
    // Between 12 and 36 cells of growth, where the crack is steady.
    let mut marks = Vec::new();
    while marks.len() < 2 && run.time() < 4000.0 {
        run.steps_more(5).expect("steps");
        // A bond may bridge the crack and part its component: take the farthest node of all.
        let reached = cracks(run.body()).nodes().iter().map(|n| n.position[0]).fold(tip, f64::max);
        let now = reached - tip;
        if now > [12.0, 36.0][marks.len()] {
            marks.push((now, run.energies().expect("energies").dissipated));
        }
    }
    assert_eq!(marks.len(), 2, "the crack did not run: {marks:?}");
    (marks[1].1 - marks[0].1) / (marks[1].0 - marks[0].0)
}

#[test]
fn what_is_put_in_is_dissipated() {
    let g = FractureEnergy::new(0.01).expect("G");
    let omega = InfluenceFunction::Constant;
    let third = Isotropic::from_young_poisson(1e3, 1.0 / 3.0).expect("moduli");
    let mode = PlaneMode::PlaneStress;
    let pmb = || Ordinary::new(Pmb::plane(&third, mode, RHO, omega).expect("model"));
    let model = BondModel::pmb(third.plane_bulk(mode), omega).expect("model");
    let stretch =
        |plane: &CrackPlane<2>| CriticalStretch::from_energy(g, &model, plane).expect("s");
    let opening = |plane: &CrackPlane<2>| CrackOpening::from_energy(g, &model, plane).expect("Δ");
    let energy = |plane: &CrackPlane<2>| BondEnergy::from_energy(g, plane).expect("w");
    let printed = |plane: &CrackPlane<2>| energy(plane).with_printed_quarter();
    let quarter = Isotropic::from_young_poisson(1e3, 0.25).expect("moduli");
    let lps = || Ordinary::new(LinearSolid::plane(&quarter, mode, RHO, omega).expect("model"));
    let (once, twice) = (g.value(), 2.0 * g.value());
    let costs = [
        (cost(pmb(), stretch, (3.0, once)), once, "stretch"),
        (cost(pmb(), opening, (3.0, once)), once, "opening"),
        (cost(pmb(), energy, (4.0, once)), once, "energy, m = 4"),
        (cost(pmb(), printed, (3.0, twice)), twice, "printed ¼"),
        (cost(lps(), energy, (3.0, once)), once, "energy, LPS"),
    ];
    for (cost, expected, what) in costs {
        let ratio = cost / expected;
        println!("{what}: {ratio:.3} of what was put in");
        assert!((0.9..1.2).contains(&ratio), "{what}: {ratio}");
    }
}
