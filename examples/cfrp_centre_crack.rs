use pd_core as _;
use peridynamics::prelude::*;
fn main() -> std::result::Result<(), Box<dyn std::error::Error>> {
    let args: Vec<String> = std::env::args().collect();
    let theta_deg: f64 = args.get(1).map_or(45.0, |a| a.parse().unwrap());
    let nx: usize = args.get(2).map_or(150, |a| a.parse().unwrap());
    let g: f64 = args.get(3).map_or(0.0, |a| a.parse().unwrap());
    let m: f64 = args.get(4).map_or(3.0, |a| a.parse().unwrap());
    let (w, h2, a) = (0.125, 0.25, 0.0125);
    let dx = w / nx as f64;
    let theta = theta_deg.to_radians();
    let plate = Cuboid::centred([w, h2])?;
    let grid = Grid::new(&plate, dx)?;
    let ply = pd_models::elasticity::catalogue::HTA_6376;
    let stiffness = Stiffness::<2>::lamina(&ply)?.rotated(theta);
    let material =
        Correspondence::new(LinearElastic(stiffness), 1586.0, InfluenceFunction::Linear)?
            .with_control(WanControl::new(&stiffness, g)?)
            .with_shape_policy(ShapePolicy {
                rule: IllConditioned::Detach,
                limit: args.get(6).map_or(1e6, |a| a.parse().unwrap()),
            });
    let strengths = Strengths { along: 1670e6, across: 60e6, shear: 70e6 };
    let policy = Breaking::new(TsaiHill::new(&strengths, theta)?)
        .precracked(Segment::new([-a, 0.0], [a, 0.0])?);
    let family = Lattice::<f64, 2>::new(&grid, Horizon::Cells(m), Quadrature::None)?;
    let mut body = Body::new(family, material, policy)?;
    body.set_velocity(|x| SVector::<f64, 2>::new(0.0, 50.0 * x[1] / h2));
    let start: Vec<f64> = (0..body.nodes()).map(|i| body.damage(i)).collect();
    let t0 = std::time::Instant::now();
    let mut run = Run::new(
        &mut body,
        Loads::new(),
        TimeStep::Safety(args.get(5).map_or(0.8, |a| a.parse().unwrap())),
    )?;
    println!("dt {:e} setup {:?} {:?}", run.dt(), t0.elapsed(), run.spectrum());
    let t0 = std::time::Instant::now();
    for k in 1..=12 {
        run.until(k as f64 * 4e-6)?;
        let b = run.body();
        let path =
            CrackPath::new(dx, (0..b.nodes()).map(|i| (i, b.position(i), b.damage(i) - start[i])));
        for s in [-1.0, 1.0] {
            let tip = SVector::<f64, 2>::new(s * a, 0.0);
            let nodes: Vec<_> = path
                .at_tip(&tip)
                .into_iter()
                .filter(|n| {
                    (n.position - tip).norm() > 3.0 * dx
                        && n.position[0].abs() < w / 2.0 - 5.0 * dx
                        && n.position[1].abs() < h2 / 2.0 - 5.0 * dx
                })
                .collect();
            let fit = pd_damage::crack_path::fit_line(&nodes);
            println!(
                "t {:.1} us step {} broken {} growth {:.2} mm fit {:?}",
                run.time() * 1e6,
                run.steps(),
                b.broken_bonds(),
                path.growth(&tip) * 1e3,
                fit.map(|f| (f.angle.to_degrees(), f.length * 1e3, f.scatter / dx, f.nodes))
            );
        }
    }
    println!("{:?}", t0.elapsed());
    Ok(())
}
