//! Displacements and tractions act on the faces of a body, not somewhere inside its boundary layers:
//! bars and plates whose solution is known, with conditions on faces and on layers.
use crate::common;
use peridynamics::prelude::*;

/// A bar of bonds, t = c s: E = 2c Σ |ξ|V over one half of a family, all in units of Δx.
#[derive(Clone, Copy)]
struct Spring(f64);

impl<T: Real, const D: usize> BondLaw<T, D> for Spring {
    type Const = T;
    fn density(&self) -> f64 {
        1e3
    }
    fn bond_const(&self, xi: &SVector<f64, D>, _: Scale) -> T {
        T::of(xi.norm())
    }
    fn force(&self, bond: &Bond<T, D>, length: &T) -> T {
        T::of(self.0) * bond.extension(*length) / *length
    }
}

/// How conditions act.
#[derive(Clone, Copy, PartialEq)]
enum At {
    Face,
    Layer,
}

const M: usize = 3;
const YOUNG: f64 = 2e9;
const STRESS: f64 = 1e5;
/// Body force along the bar in N/m³.
const WEIGHT: f64 = 3e4;

/// A bar of length 1 with `cells` cells, clamped at 0, pulled at 1 and drawn by its weight: the
/// largest error over the largest displacement of u = (σx + b(x − x²/2))/E.
fn bar(cells: usize, at: At, weight: f64) -> f64 {
    let dx = 1.0 / cells as f64;
    let layer = M as f64 * dx;
    let grid = Grid::new(&Cuboid::new([-layer], [1.0]).expect("bar"), dx).expect("grid");
    let family = Lattice::<f64, 1>::new(&grid, Horizon::Cells(M as f64), Quadrature::None);
    let material = BondBased(Spring(YOUNG / (M * (M + 1)) as f64));
    let mut body = Body::new(family.expect("family"), material, NoDamage).expect("body");
    let [clamp, pulled] = [grid.select(|x| x[0] < 0.0), grid.select(|x| x[0] > 1.0 - layer)];
    let [left, right] = [0.0, 1.0].map(|x| Face::new([x], [2.0 * x - 1.0]).expect("face"));
    let loads = Loads::new().body_force(&grid.select(|x| x[0] > 0.0), 0, weight);
    let loads = match at {
        At::Face => loads.displacement_at(&left, &clamp, 0, 0.0).traction(
            &right,
            &grid.select(|x| x[0] > 0.0),
            0,
            STRESS,
        ),
        At::Layer => loads.displacement(&clamp, 0, 0.0).body_force(&pulled, 0, STRESS / layer),
    };
    let solver = Statics::new().with_tolerance(1e-11).expect("tolerance");
    solver.solve(&mut body, loads).expect("solved");
    let exact = |x: f64| (STRESS * x + weight * (x - 0.5 * x * x)) / YOUNG;
    let inside = (0..grid.len()).filter(|&i| grid.position(i)[0] > 0.0);
    let off = inside.map(|i| (body.displacement(i)[0] - exact(grid.position(i)[0])).abs());
    off.fold(0.0, f64::max) / exact(1.0)
}

/// A homogeneous stress is exact to the last node.
#[test]
fn a_pulled_bar_is_exact() {
    let (face, layer) = (bar(40, At::Face, 0.0), bar(40, At::Layer, 0.0));
    assert!(face < 1e-9, "{face:e}");
    assert!(layer > 0.01, "nothing gained: {layer:e}");
}

/// Where the strain varies layers err with δ, faces with δ².
#[test]
fn a_hanging_bar_converges_with_the_square() {
    let order = |at: At| (bar(40, at, WEIGHT) / bar(80, at, WEIGHT)).log2();
    let (face, layer) = (order(At::Face), order(At::Layer));
    assert!(face > 1.8 && layer < 1.2, "orders {face}, {layer}");
    let (face, layer) = (bar(40, At::Face, WEIGHT), bar(40, At::Layer, WEIGHT));
    assert!(face < 0.1 * layer, "{face:e}, {layer:e}");
}

/// A ply under uniaxial stress, u = s₁₁x, s₁₂y + s₁₆x: pulled on a face and held on the other
/// along x alone. The largest error over the largest displacement.
fn plate<M: Material<f64, 2>>(material: M, at: At, quadrature: Quadrature) -> f64 {
    let (dx, m) = (1e-3, 3.0);
    let [length, height] = [24.0 * dx, 12.0 * dx];
    let layer = 2.0 * m * dx;
    let grid = Grid::new(&Cuboid::new([-layer, 0.0], [length, height]).expect("box"), dx);
    let grid = grid.expect("grid");
    let family = Lattice::<f64, 2>::new(&grid, Horizon::Cells(m), quadrature);
    let mut body = Body::new(family.expect("family"), material, NoDamage).expect("body");
    let clamp = grid.select(|x| x[0] < 0.0);
    let pin = grid.nearest(&[0.0, 0.0].into());
    let pin = NodeSet::from_nodes([pin], grid.len()).expect("pin");
    let left = Face::new([0.0, 0.0], [-1.0, 0.0]).expect("face");
    let right = Face::new([length, 0.0], [1.0, 0.0]).expect("face");
    let inside = grid.select(|x| x[0] > 0.0);
    let loads = Loads::new().displacement(&pin, 1, 0.0);
    let loads = match at {
        At::Face => loads.displacement_at(&left, &clamp, 0, 0.0).traction(
            &right,
            &inside,
            0,
            STRESS * height,
        ),
        At::Layer => {
            let pulled = grid.select(|x| x[0] > length - m * dx);
            loads.displacement(&clamp, 0, 0.0).body_force(&pulled, 0, STRESS / (m * dx))
        }
    };
    Statics::new()
        .with_tolerance(1e-9)
        .expect("tolerance")
        .solve(&mut body, loads)
        .expect("solved");
    let compliance = common::ply().voigt().try_inverse().expect("compliance") * STRESS;
    let exact = |x: &SVector<f64, 2>| {
        let y = compliance[(1, 0)] * x[1] + compliance[(2, 0)] * x[0];
        SVector::from([compliance[(0, 0)] * x[0], y])
    };
    let apart = |i: usize| body.displacement(i) - exact(&grid.position(i));
    let shift = apart(pin.iter().next().expect("pin"))[1];
    let off = inside.iter().map(|i| (apart(i) - SVector::from([0.0, shift])).norm());
    off.fold(0.0, f64::max) / exact(&[length, height].into()).norm()
}

#[test]
fn a_pulled_ply_is_exact_but_for_its_free_edges() {
    let split = || PositiveSplit::plane(&common::ply(), 1e3, common::OMEGA).expect("material");
    let of = |at| plate(Ordinary::linearised(split()), at, Quadrature::Exact);
    let (face, layer) = (of(At::Face), of(At::Layer));
    assert!(face < 0.25 * layer, "{face:e}, {layer:e}");
}

fn ply(grid: &Grid<2>) -> Body<f64, 2, Lattice<f64, 2>, Ordinary<PositiveSplit<2, 3>>, NoDamage> {
    let family = Lattice::new(grid, Horizon::Cells(2.0), Quadrature::None).expect("family");
    let model = PositiveSplit::plane(&common::ply(), 1e3, common::OMEGA).expect("material");
    Body::new(family, Ordinary::new(model), NoDamage).expect("body")
}

/// In a run the layer follows its image at every step, and a face through nodes moves them as asked.
#[test]
fn a_moving_face() {
    fn check(face: f64, integrator: impl peridynamics::core::Integrator<f64, 2>) {
        let grid = Grid::new(&Cuboid::new([-4.0, 0.0], [10.0, 6.0]).expect("box"), 1.0);
        let grid = grid.expect("grid");
        let layer = grid.select(|x| x[0] < face + 0.1);
        let u = |t: f64| 1e-3 * (2e3 * t).sin();
        let at = Face::new([face, 0.0], [-1.0, 0.0]).expect("face");
        let loads = Loads::new().displacement_at(&at, &layer, 1, u);
        let mut body = ply(&grid);
        let rule = TimeStep::Safety(0.5);
        let mut run = Run::with_integrator(&mut body, loads, rule, integrator).expect("run");
        let mut most = 0.0_f64;
        for _ in 0..50 {
            run.steps_more(1).expect("step");
            for node in layer.iter() {
                let image = grid.nearest(&at.image(&grid.position(node)));
                let [own, other] = [node, image].map(|i| run.body().displacement(i)[1]);
                let mean = 0.5 * (own + other);
                assert!((mean - u(run.time())).abs() < 1e-15, "{mean:e}, {:e}", u(run.time()));
                most = most.max((own - other).abs());
            }
        }
        assert!(most > 1e-5, "the body has not moved: {most:e}");
    }
    check(0.0, VelocityVerlet::new());
    check(0.0, SymplecticEuler);
    check(0.5, VelocityVerlet::new());
}

/// The forces of a traction have its resultant, whatever nodes carry them.
#[test]
fn resultants() {
    let grid = Grid::new(&Cuboid::new([0.0, 0.0], [12.0, 9.0]).expect("box"), 1.0).expect("grid");
    let face = Face::new([12.0, 0.0], [3.0, 0.0]).expect("face");
    for (low, axis) in [(0.0, 0), (0.0, 1), (4.0, 0), (4.0, 1)] {
        let part = grid.select(|x| x[1] > low);
        let mut body = ply(&grid);
        let loads = Loads::new().traction(&face, &part, axis, 7.0);
        Run::new(&mut body, loads, TimeStep::Safety(0.5)).expect("run");
        let total = peridynamics::core::run::reaction(&body, &grid.select(|_| true));
        assert!((total[axis] + 7.0).abs() < 1e-12, "{total}");
        let inside = grid.select(|x| x[0] < 12.0 - 2.0 * 2.0 || x[1] < low);
        assert!(inside.iter().all(|i| body.force_density(i).amax() == 0.0), "beyond its nodes");
    }
}

#[test]
fn layers_without_image_are_refused() {
    let grid = Grid::new(&Cuboid::new([-4.0, 0.0], [10.0, 6.0]).expect("box"), 1.0).expect("grid");
    let refusal = |loads: Loads| {
        Run::new(&mut ply(&grid), loads, TimeStep::Safety(0.5)).map(|_| ()).expect_err("refused")
    };
    let left = grid.select(|x| x[0] < 0.0);
    let at = |x: f64| Face::new([x, 0.0], [-1.0, 0.0]).expect("face");
    // Between the rows of nodes and their middles there is no image.
    let off = Loads::new().displacement_at(&at(0.2), &left, 0, 0.0);
    assert!(matches!(refusal(off), Error::NoImage { node: 0, .. }));
    // Images beyond the other end, and in the layer itself.
    let thick = grid.select(|x| x[0] < 6.0);
    let beyond = Loads::new().displacement_at(&at(6.0), &thick, 0, 0.0);
    assert!(matches!(refusal(beyond), Error::NoImage { node: 0, .. }));
    let itself = Loads::new().displacement_at(&at(0.0), &grid.select(|x| x[0] < 3.0), 0, 0.0);
    assert!(matches!(refusal(itself), Error::NoImage { node: 1, .. }));
    let twice = Loads::new().displacement_at(&at(0.0), &left, 0, 0.0).displacement(&left, 0, 0.0);
    assert_eq!(refusal(twice), Error::ConflictingConditions { node: 0, axis: 0 });
    // Nothing near the face, or not where the body ends.
    let far = grid.select(|x| x[0] > 8.0);
    let nobody = refusal(Loads::new().traction(&at(-4.0), &far, 0, 1.0)).to_string();
    assert!(nobody.contains("share of a homogeneous stress"), "{nobody}");
    let wrong = Face::new([10.0, 0.0, 0.0], [1.0, 0.0, 0.0]).expect("face");
    let wrong = refusal(Loads::new().traction(&wrong, &far, 0, 1.0)).to_string();
    assert!(wrong.contains("dimension of a face"), "{wrong}");
    assert!(Face::new([0.0, f64::NAN], [1.0, 0.0]).is_err());
    assert!(Face::new([0.0, 0.0], [0.0, 0.0]).is_err());
}
