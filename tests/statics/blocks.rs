//! The blocks of the preconditioner are the diagonal blocks of the dense operator, every material,
//! with a crack too.
use crate::common;
use common::dense_stiffness;
use peridynamics::prelude::*;

fn check_blocks<const D: usize, F: Family<f64, D>, M: Material<f64, D>>(
    family: F,
    material: M,
    name: &str,
) {
    let side = [0.3e-3; D];
    let crack = Halfway(SVector::from(side));
    let mut body = Body::new(family, material, Precracked::by(crack)).expect("body");
    let blocks = body.diagonal_blocks();
    let k = dense_stiffness(&mut body);
    let mut worst = 0.0_f64;
    for node in 0..body.nodes() {
        let own = k.fixed_view::<D, D>(D * node, D * node);
        let got = blocks.get(body.site(node)) * body.volume(node);
        worst = worst.max((got - own).amax() / k.amax());
    }
    assert!(worst < 1e-8, "{name}: {worst:e}");
}

/// A crack along the plane y = const from x = −∞ to a point.
struct Halfway<const D: usize>(SVector<f64, D>);
impl<const D: usize> CrackSurface<D> for Halfway<D> {
    fn cuts(&self, a: &SVector<f64, D>, b: &SVector<f64, D>) -> bool {
        let (ya, yb) = (a[1] - self.0[1], b[1] - self.0[1]);
        let x = a[0] + (b[0] - a[0]) * ya / (ya - yb);
        ya * yb < 0.0 && x < self.0[0]
    }
    fn distance(&self, x: &SVector<f64, D>) -> f64 {
        (x[1] - self.0[1]).abs()
    }
    fn normal(&self) -> SVector<f64, D> {
        SVector::from_fn(|d, _| if d == 1 { 1.0 } else { 0.0 })
    }
}

macro_rules! check {
    ($material:expr, $grid:ident, $d:literal) => {{
        let _ = &$grid;
        let edges: [f64; $d] = [7e-3, 6e-3, 4e-3][..$d].try_into().expect("edges");
        let grid = Grid::<$d>::new(&Cuboid::centred(edges).expect("box"), 1e-3).expect("grid");
        let lattice = Lattice::<f64, $d>::new(&grid, Horizon::Cells(2.0), Quadrature::Exact);
        check_blocks(lattice.expect("family"), $material, stringify!($material));
        // Jittered places and volumes, a horizon of its own for every node.
        let jitter = |i: usize| 1e-4 * ((i * i) as f64).sin();
        let positions: Vec<_> =
            grid.positions().enumerate().map(|(i, x)| x.add_scalar(jitter(i))).collect();
        let volumes = (0..grid.len()).map(|i| grid.cell_volume() * (1.0 + 1e3 * jitter(i)));
        let points = Points::new(positions, volumes.collect()).expect("points");
        let points = points.with_spacing(1e-3).expect("points");
        let horizons: Vec<f64> = (0..grid.len()).map(|i| 2.3e-3 + jitter(i)).collect();
        let cloud = Cloud::<f64, $d>::graded(&points, &horizons, Quadrature::None);
        check_blocks(cloud.expect("family"), $material, stringify!($material));
    }};
}

#[test]
fn blocks_of_every_material() {
    crate::for_every_material!(check, 1e-3);
}
