//! What a scene does not need is not there.
use peridynamics::core::family::Neighbour;
use peridynamics::prelude::*;
use std::collections::HashSet;

#[test]
fn a_scene_holds_only_what_it_needs() {
    let grid = Grid::new(&Cuboid::centred([0.064, 0.064]).expect("box"), 1e-3).expect("grid");
    let family = Lattice::<f64, 2>::new(&grid, Horizon::Cells(3.0), Quadrature::None);
    let family = family.expect("family");
    let moduli = Isotropic::from_young_poisson(7e10, 1.0 / 3.0).expect("moduli");
    let mode = PlaneMode::PlaneStress;
    let pmb = || Pmb::plane(&moduli, mode, 1e3, InfluenceFunction::Constant).expect("material");
    let whole = Body::new(family.clone(), Ordinary::new(pmb()), NoDamage).expect("body").memory();
    assert_eq!(whole.bond_bits, 0);
    assert_eq!(whole.criterion, 0);
    assert_eq!(whole.node_constants, 0);
    assert_eq!(whole.node_states, 0);
    assert_eq!(whole.density, 0);

    let stretch = CriticalStretch::new(0.01).expect("criterion");
    let breaking = Body::new(family.clone(), Ordinary::new(pmb()), Breaking::new(stretch));
    let memory = breaking.expect("body").memory();
    assert_eq!(memory.criterion, 0);
    let sites = Family::<f64, 2>::sites(&family);
    // 64 + 3 sites a row, padded to 72, a block before the first, and up to a page.
    assert!(sites <= 72 * 64 + 32 + 4096 / 8, "{sites} sites");
    // One bit per site and offset of the half table, and per eight sites two bytes of marks and eight
    // that tell where the bits are.
    let half = family.offsets() / 2;
    assert!(memory.bond_bits <= sites * half / 8 + sites / 4 + sites, "{}", memory.bond_bits);

    let bits = Body::new(family, Ordinary::new(pmb()), Precracked::default()).expect("body");
    assert!(bits.memory().bond_bits > 0);
}

/// Bits of damage per undirected bond, and bytes of the family and of bond constants.
fn sizes<T: Real, F: Family<T, 3>>(family: F) -> (f64, usize, usize) {
    let moduli = Isotropic::from_young_poisson(7e10, 0.2).expect("moduli");
    let solid = LinearSolid::solid(&moduli, 1e3, InfluenceFunction::Constant).expect("material");
    let bonds = family.bonds() as f64;
    let stretch = Breaking::new(CriticalStretch::new(0.01).expect("criterion"));
    let body = Body::new(family, Ordinary::new(solid), stretch).expect("body");
    let memory = body.memory();
    (8.0 * memory.bond_bits as f64 / bonds, memory.family, memory.bond_constants)
}

fn cube(n: f64) -> Grid<3> {
    Grid::new(&Cuboid::centred([n; 3]).expect("box"), 1.0).expect("grid")
}

/// A lattice holds one table of offsets, whatever its size, and one bit per site and offset of half
/// the table: one per undirected bond of the bulk. Sites that pad rows and bonds missing at the
/// surface have bits too: little in a large body. Marks of nodes that lost a bond are two bits a
/// site.
#[test]
fn a_lattice_holds_one_table_and_a_bit_per_bond() {
    fn check<T: Real>(scalar: usize, row: usize) {
        let lattice =
            |n: f64| Lattice::<T, 3>::new(&cube(n), Horizon::Cells(3.015), Quadrature::None);
        let (small, large) = (lattice(16.0).expect("family"), lattice(48.0).expect("family"));
        let offsets = large.offsets();
        assert_eq!(offsets, 122);
        let (_, _, of_small) = sizes(small);
        let sites = Family::<T, 3>::sites(&large);
        let bonds = Family::<T, 3>::bonds(&large);
        let (bits, _, of_large) = sizes(large);
        println!("{}: {bits:.3} bits per bond, {of_large} bytes of constants", T::NAME);
        // |ξ|, 1/|ξ|, ω|ξ|, and what θ and e are multiplied by, per offset.
        assert_eq!(of_small, of_large);
        assert_eq!(of_large, offsets * 5 * scalar);
        let most = sites * (offsets / 2 + 10);
        assert!(bits * bonds as f64 <= most as f64 + 64.0, "{bits}");
        // Rows of 48 + 3 sites are padded to whole registers, node arrays to a place in a page; 3
        // rows part the planes.
        assert!(sites <= row * 51 * 48 + 32 + 4096 / scalar, "{sites} sites");
    }
    check::<f64>(8, 56);
    check::<f32>(4, 64);
}

/// Beyond displacement, velocity and force, a bond-based lattice body with damage holds at most 40
/// bytes a node and one bit an undirected bond, its padding included.
#[test]
fn a_damaged_lattice_is_motion_and_bits() {
    let family = Lattice::<f64, 3>::new(&cube(48.0), Horizon::Cells(3.015), Quadrature::None);
    let moduli = Isotropic::from_young_poisson(7e10, 0.25).expect("moduli");
    let pmb = Pmb::solid(&moduli, 1e3, InfluenceFunction::Constant).expect("material");
    let stretch = Breaking::new(CriticalStretch::new(0.01).expect("criterion"));
    let body = Body::<f64, 3, _, _, _>::new(family.expect("family"), Ordinary::new(pmb), stretch);
    let body = body.expect("body");
    let (nodes, bonds) = (body.nodes() as f64, body.family().bonds() as f64);
    let rest = body.memory().total() as f64 - 3.0 * 3.0 * 8.0 * nodes - bonds / 8.0;
    println!("{:.1} bytes a node beyond motion and a bit a bond", rest / nodes);
    assert!(rest <= 40.0 * nodes, "{} bytes a node", rest / nodes);
}

/// A cloud that is a lattice holds batches of sixteen nodes' bonds, which share their shape and tell
/// their far ends by one number; where rows of nodes end, the far ends of a batch are listed.
#[test]
fn a_cloud_holds_batches() {
    fn check<T: Real>(scalar: usize) {
        let edge = 16;
        let points = Points::from_grid(&cube(edge as f64));
        let cloud = Cloud::<T, 3>::new(&points, Horizon::Cells(3.015), Quadrature::None);
        let cloud = cloud.expect("family");
        let (nodes, directed) = (points.len(), 2 * Family::<T, 3>::bonds(&cloud));
        let (bits, family, constants) = sizes(cloud);
        println!(
            "{}: {bits:.3} bits per bond, {:.2} bytes a directed bond",
            T::NAME,
            family as f64 / directed as f64
        );
        // A row of the cube is a block. Along y and z a shape is there for all of it or none.
        let blocks = edge * edge;
        let batches = 122 * blocks;
        // 122 shapes of ξ, 1/|ξ|², two volumes and two horizons, and a sample of each.
        let shapes = 122 * (8 * scalar + 8);
        // Where blocks start, position and volume of every node.
        let exact = 8 * batches + 16 * (blocks + 1) + nodes * (3 * 8 + 8) + shapes;
        assert!(family <= exact + 256, "{family} bytes, {exact} needed");
        assert_eq!(constants, 122 * 5 * scalar);
        // Two bytes a batch, where those of a block are, and a byte to mark each node.
        let most = 8 * (2 * batches + 4 * (blocks + 1) + nodes);
        assert!(bits <= (most + 64) as f64 / (0.5 * directed as f64), "{bits}");
    }
    check::<f64>(8);
    check::<f32>(4);
}

/// What a capability adds to a body's arrays, and nothing else: each line is one capability off and
/// on, with the parts that may differ. Off and on are otherwise the same to the byte.
#[test]
fn a_capability_costs_its_own_arrays_alone() {
    type Parts = [usize; 8];
    const NAMES: [&str; 8] = [
        "family",
        "bond constants",
        "bond bits",
        "node constants",
        "node states",
        "criterion",
        "motion",
        "density",
    ];
    fn parts<F, M, P>(body: peridynamics::core::Result<Body<f64, 3, F, M, P>>) -> Parts
    where
        F: Family<f64, 3>,
        M: Material<f64, 3>,
        P: DamagePolicy<f64, 3, M>,
    {
        let m = body.expect("body").memory();
        let constants = [m.family, m.bond_constants, m.bond_bits, m.node_constants];
        let others = [m.node_states, m.criterion, m.motion, m.density];
        std::array::from_fn(|i| if i < 4 { constants[i] } else { others[i - 4] })
    }
    fn differ(name: &str, off: Parts, on: Parts, expected: &[(&str, usize)]) {
        for (i, part) in NAMES.iter().enumerate() {
            let more = expected.iter().find(|e| e.0 == *part).map_or(0, |e| e.1);
            assert_eq!(on[i], off[i] + more, "{name}: {part}");
        }
    }
    let moduli = Isotropic::from_young_poisson(7e10, 0.2).expect("moduli");
    let stiffness = Stiffness::<3>::isotropic(&moduli).expect("stiffness");
    let (constant, linear) = (InfluenceFunction::Constant, InfluenceFunction::Linear);
    let solid = || LinearSolid::solid(&moduli, 1e3, constant).expect("material");
    let lps = || Ordinary::new(solid());
    let grid = cube(16.0);
    let lattice = || {
        let horizon = Horizon::Cells(3.015);
        Lattice::<f64, 3>::new(&grid, horizon, Quadrature::None).expect("family")
    };
    let sites = Family::<f64, 3>::sites(&lattice());
    let plain = parts(Body::new(lattice(), lps(), NoDamage));
    let scalar = size_of::<f64>() * sites;
    assert_eq!(plain[3..6], [scalar, scalar, 0], "1/m, θ and no criterion");

    differ(
        "small strain",
        plain,
        parts(Body::new(lattice(), Ordinary::linearised(solid()), NoDamage)),
        &[],
    );
    let region = (0..grid.len()).map(|node| u8::from(grid.position(node)[0] > 0.0)).collect();
    // The region of a node is in the material, its constants double: one set per region and offset.
    let regions = Regions::new([lps(), lps()], region).expect("regions");
    let two = parts(Body::new(lattice(), regions, NoDamage));
    assert_eq!((two[0], two[2], two[5], two[6]), (plain[0], 0, 0, plain[6]));

    let notch = || {
        let edges = ([-9.0, 0.1, -9.0], [9.0, 0.0, 0.0], [0.0, 0.0, 18.0]);
        Polygon::parallelogram(edges.0, edges.1, edges.2).expect("notch")
    };
    let cracked = parts(Body::new(lattice(), lps(), Precracked::by(notch())));
    // Marks of every eight sites and where their bits are, as many bits as are needed, and those of
    // places without nodes once.
    let (blocks, half) = (sites / 8, lattice().offsets() / 2);
    let rows = |parts: &Parts| (parts[2] - 6 * blocks) as f64 / (half + 4) as f64 - 1.0;
    let held = |rows: HashSet<usize>| rows.len() as f64;
    let whole = Body::new(lattice(), lps(), Precracked::by(notch())).expect("body");
    let owners = |wanted: &dyn Fn(usize, &Neighbour<3>) -> bool| {
        let mut found = HashSet::new();
        for node in 0..grid.len() {
            whole.neighbours(node, |n| {
                if n.node > node && wanted(node, &n) {
                    found.insert(Family::<f64, 3>::site(whole.family(), node) / 8);
                }
            });
        }
        found
    };
    assert_eq!(rows(&cracked), held(owners(&|_, n| !n.intact)), "bits along the notch");
    differ("pre-crack", plain, cracked, &[("bond bits", cracked[2])]);
    let stretch = Breaking::new(CriticalStretch::new(0.01).expect("criterion"));
    let breaking = parts(Body::new(lattice(), lps(), stretch.precracked(notch())));
    assert_eq!(rows(&breaking), held(owners(&|_, _| true)), "bits of all bonds");
    differ("critical stretch", cracked, breaking, &[("bond bits", breaking[2] - cracked[2])]);
    let energy = || BondEnergy::new(1e9).expect("criterion");
    let foster = parts(Body::new(lattice(), lps(), Breaking::new(energy()).precracked(notch())));
    differ("bond energy", breaking, foster, &[]);
    let some = grid.select(|x| x[0] < 1.0);
    let spared = Breaking::new(energy().sparing(&some)).precracked(notch());
    let spared = parts(Body::new(lattice(), lps(), spared));
    let able = |i, n: &Neighbour<3>| !n.intact || !(some.contains(i) || some.contains(n.node));
    assert_eq!(rows(&spared), held(owners(&able)), "bits where bonds can break");
    assert!(rows(&cracked) < 0.4 * rows(&breaking) && rows(&spared) < 0.8 * rows(&breaking));
    let mut expected = foster;
    (expected[2], expected[5]) = (spared[2], foster[5] + scalar);
    assert_eq!(spared, expected, "nodes that cannot fail");
    // Either of two criteria: the nodes that both spare.
    let left = grid.select(|x| x[0] < 2.0);
    let either = energy().sparing(&some).or(energy().sparing(&left));
    let either = parts(Body::new(lattice(), lps(), Breaking::new(either).precracked(notch())));
    assert_eq!(either[2], spared[2], "nodes that neither criterion lets fail");

    // In a cloud too, by blocks of sixteen nodes: two bytes for every shape of a bond in the block.
    let points = Points::from_grid(&grid);
    let cloud = || Cloud::new(&points, Horizon::Metres(3.015), Quadrature::None).expect("cloud");
    let whole = Body::<f64, 3, _, _, _>::new(cloud(), lps(), Precracked::by(notch()));
    let whole = whole.expect("body");
    let held = |wanted: &dyn Fn(usize, &Neighbour<3>) -> bool| {
        let block = |block: usize| {
            let (mut shapes, mut needed) = (HashSet::new(), false);
            for node in 16 * block..16 * (block + 1) {
                whole.neighbours(node, |n| {
                    shapes.insert(n.xi.map(|x| x as i32));
                    needed |= wanted(node, &n);
                });
            }
            if needed { 2 * shapes.len() } else { 0 }
        };
        (0..points.len() / 16).map(block).sum::<usize>()
            + 4 * (points.len() / 16 + 1)
            + points.len()
    };
    let cracked = parts(Body::new(cloud(), lps(), Precracked::by(notch())));
    assert_eq!(cracked[2], held(&|_, n| !n.intact), "bits along the notch");
    let breaking = Breaking::new(energy()).precracked(notch());
    let breaking = parts(Body::new(cloud(), lps(), breaking));
    assert_eq!(breaking[2], held(&|_, _| true), "bits of all bonds");
    let low = grid.select(|x| x[1] < 1.0);
    let spared = Breaking::new(energy().sparing(&low)).precracked(notch());
    let spared = parts(Body::new(cloud(), lps(), spared));
    let able = |i, n: &Neighbour<3>| !n.intact || !(low.contains(i) || low.contains(n.node));
    assert_eq!(spared[2], held(&able), "bits where bonds can break");
    assert!(cracked[2] < breaking[2] / 2 && 10 * spared[2] < 9 * breaking[2]);

    let nosb = || Correspondence::new(LinearElastic(stiffness), 1e3, linear).expect("law");
    let bare = parts(Body::new(lattice(), nosb(), NoDamage));
    let law = SaintVenantKirchhoff(stiffness);
    let finite = Correspondence::new(law, 1e3, linear).expect("law");
    differ("finite strain", bare, parts(Body::new(lattice(), finite, NoDamage)), &[]);

    // One horizon per node, all alike, is one number per node: shapes of bonds are shared.
    let one = cloud();
    let each = vec![3.015; points.len()];
    let graded = Cloud::graded(&points, &each, Quadrature::None).expect("cloud");
    let one = parts(Body::new(one, lps(), NoDamage));
    let numbers = size_of::<f64>() * (points.len() - 1);
    let graded = parts(Body::new(graded, lps(), NoDamage));
    // Both ends of a bond have constants of their own, also where they are alike.
    differ("dual horizon", one, graded, &[("family", numbers), ("bond constants", one[1])]);
}
