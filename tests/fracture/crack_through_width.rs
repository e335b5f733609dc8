//! The bonds that cross a crack in a body of finite width, counted one by one, are those that
//! `CrackPlane::through_width` says.
use peridynamics::prelude::*;

#[test]
fn crossing_bonds_of_a_narrow_beam() {
    for (m, width) in [(2.015, 4.0), (3.015, 6.0), (3.015, 2.0)] {
        let (length, height) = (24.0, 10.0);
        let grid = Grid::new(&Cuboid::centred([length, height, width]).expect("box"), 1.0);
        let family =
            Lattice::<f64, 3>::new(&grid.expect("grid"), Horizon::Cells(m), Quadrature::None);
        let family = family.expect("family");
        let normal = [0.0, 1.0, 0.0];
        let plane = CrackPlane::through_width(&family, normal, (2, width)).expect("plane");
        let whole = CrackPlane::lattice(&family, normal).expect("plane");
        let moduli = Isotropic::from_young_poisson(1.0, 0.25).expect("moduli");
        let model = Pmb::solid(&moduli, 1.0, InfluenceFunction::Constant).expect("model");
        let body = Body::new(family, Ordinary::new(model), NoDamage).expect("body");
        // Bonds from the two middle columns of nodes along x to the other side of y = 0.
        let mut found = 0.0;
        for node in (0..body.nodes()).filter(|&i| body.position(i)[0].abs() < 1.0) {
            let x = body.position(node);
            body.neighbours(node, |n| {
                let y = body.position(n.node);
                if x[1] < 0.0 && y[1] > 0.0 {
                    found += (y - x).norm();
                }
            });
        }
        let per_area = found / (2.0 * width);
        let got = plane.crossing(|length| length);
        assert!((got / per_area - 1.0).abs() < 1e-12, "m = {m}, B = {width}: {got} {per_area}");
        assert!(got < 0.95 * whole.crossing(|length| length));
    }
    let grid = Grid::new(&Cuboid::centred([5.0; 3]).expect("box"), 1.0).expect("grid");
    let family = Lattice::<f64, 3>::new(&grid, Horizon::Cells(2.0), Quadrature::None).expect("f");
    let refused = |axis, width| {
        CrackPlane::through_width(&family, [0.0, 1.0, 0.0], (axis, width)).expect_err("refused")
    };
    assert!(refused(3, 1.0).to_string().contains("axis"));
    assert!(refused(2, 0.0).to_string().contains("width"));
}
