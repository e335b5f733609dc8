//! Rigid translation gives no force; rotation gives none with finite kinematics.

#[test]
fn rigid_motion_gives_no_force() {
    macro_rules! check {
        ($material:expr, $grid:expr, $d:literal) => {{
            let family = Lattice::<f64, $d>::new(&$grid, Horizon::Cells(3.0), Quadrature::None);
            let mut body = Body::new(family.expect("family"), $material, NoDamage).expect("body");
            let mut largest = |u: &dyn Fn(&SVector<f64, $d>) -> SVector<f64, $d>| {
                body.set_displacement(u);
                body.evaluate().expect("forces");
                (0..body.nodes()).map(|i| body.force_density(i).norm()).fold(0.0, f64::max)
            };
            let scale = largest(&|x| x * 0.01);
            let moved = largest(&|_| SVector::repeat(0.7e-3));
            assert!(moved <= 1e-12 * scale, "translation: {:e}", moved / scale);
            let small_strain = std::any::type_name_of_val(&$material);
            let finite = !["Linearised", "LinearElastic", "BondAssociated"]
                .iter()
                .any(|name| small_strain.contains(name));
            let (sin, cos) = 1.0_f64.sin_cos();
            let turned = largest(&|x| {
                let mut u = SVector::zeros();
                u[0] = (cos - 1.0) * x[0] - sin * x[1];
                u[1] = sin * x[0] + (cos - 1.0) * x[1];
                u
            });
            assert!(!finite || turned <= 1e-11 * scale, "rotation: {:e}", turned / scale);
        }};
    }
    crate::for_every_material!(check, 1e-3);
}
