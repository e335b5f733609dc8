//! f_i V_i = −∂E/∂u_i by central differences, for every material with an energy.
use crate::common;

#[test]
fn forces_derive_from_the_energy() {
    macro_rules! check {
        ($material:expr, $grid:expr, $d:literal) => {{
            let dx = 1.0;
            let family = Lattice::<f64, $d>::new(&$grid, Horizon::Cells(2.3), Quadrature::None);
            let mut body = Body::new(family.expect("family"), $material, NoDamage).expect("body");
            body.set_displacement(|x| common::wavy(x, dx, 1e-2));
            body.evaluate().expect("forces");
            let size = (0..body.nodes()).map(|i| body.force_density(i).norm()).fold(0.0, f64::max);
            for node in [0, body.nodes() / 2, body.nodes() - 3] {
                body.evaluate().expect("forces");
                let (force, u) = (body.force_density(node), body.displacement(node));
                for axis in 0..$d {
                    let h = 1e-5;
                    let mut energy = |step: f64| {
                        let mut moved = u;
                        moved[axis] += step;
                        body.set_displacement_of(node, &moved);
                        body.evaluate().expect("forces");
                        body.strain_energy()
                    };
                    let gradient = (energy(h) - energy(-h)) / (2.0 * h);
                    body.set_displacement_of(node, &u);
                    let difference = (force[axis] * body.volume(node) + gradient).abs();
                    assert!(difference < 1e-6 * size, "{:e}", difference / size);
                }
            }
        }};
    }
    crate::for_every_material!(check, 1.0);
}
