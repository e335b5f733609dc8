//! A damage criterion of your own: a layered rock whose bonds across the layers break at a smaller
//! stretch than bonds along them, so that a crack leaves its line.
//!
//! `cargo run --release --example custom_criterion`

use peridynamics::prelude::*;

/// Critical stretch along and across layers with this normal.
struct Layered {
    normal: SVector<f64, 2>,
    along: f64,
    across: f64,
}

impl<T: Real, M: Material<T, 2>> DamageCriterion<T, 2, M> for Layered {
    type NodeConst = ();
    type NodeValue = ();

    /// s/s_c with s_c² = s_along² sin² + s_across² cos² of the angle to the layers' normal.
    fn index(&self, tested: &TestedBond<'_, T, 2, M, (), ()>) -> T {
        let xi = tested.bond.xi;
        let length = xi.dot(&xi).sqrt();
        let stretch = tested.bond.extension(length) / length;
        let cos = xi.dot(&self.normal.map(T::of)) / length;
        let (a, c) = (T::of(self.along * self.along), T::of(self.across * self.across));
        stretch / (a + (c - a) * cos * cos).sqrt()
    }
}

fn main() -> std::result::Result<(), Box<dyn std::error::Error>> {
    let (size, dx, speed) = (0.1, 1e-3, 1.0);
    let grid = Grid::new(&Cuboid::centred([size, size])?, dx)?;
    let moduli = Isotropic::from_young_poisson(30e9, 1.0 / 3.0)?;
    let mode = PlaneMode::PlaneStress;
    let rock = Pmb::plane(&moduli, mode, 2500.0, InfluenceFunction::Constant)?;
    let tilt = 30_f64.to_radians();
    let layered = Layered { normal: [-tilt.sin(), tilt.cos()].into(), along: 2e-3, across: 4e-4 };
    let top = grid.select(|x| x[1] > 0.5 * size - 3.0 * dx);
    let bottom = grid.select(|x| x[1] < -0.5 * size + 3.0 * dx);
    let policy = Breaking::new(layered.sparing(&top.union(&bottom)))
        .precracked(Segment::new([-0.01, 0.0], [0.01, 0.0])?);
    let family = Lattice::<f64, 2>::new(&grid, Horizon::Cells(3.0), Quadrature::LinearRamp)?;
    let mut body = Body::new(family, Ordinary::new(rock), policy)?;

    // The plate starts with the speed of its ends, so that no wave comes from the grips.
    body.set_velocity(|x| [0.0, 2.0 * speed * x[1] / size].into());
    let start: Vec<f64> = (0..body.nodes()).map(|i| body.damage(i)).collect();
    let loads = Loads::new().velocity(&top, 1, speed).velocity(&bottom, 1, -speed);
    let mut run = Run::new(&mut body, loads, TimeStep::Safety(0.7))?;
    run.observe(20, |view: &View<'_, _>| {
        let body: &Body<f64, 2, _, _, _> = view.body;
        let (broken, worst) = (body.broken_bonds(), body.worst_index());
        println!("t = {:6.2} µs: {broken:5} bonds broken, worst index {worst:.2}", view.time * 1e6);
        Ok(if broken > 600 { Flow::Stop } else { Flow::Continue })
    });
    run.until(80e-6)?;

    let body = run.body();
    let gained = (0..body.nodes()).map(|i| (i, body.position(i), body.damage(i) - start[i]));
    let path = CrackPath::new(dx, gained);
    let tip = SVector::<f64, 2>::new(0.01, 0.0);
    match peridynamics::damage::crack_path::fit_line(&path.at_tip(&tip)) {
        Some(line) => println!(
            "crack of {:.1} mm at {:.0}° (layers at {:.0}°)",
            line.length * 1e3,
            line.angle.to_degrees(),
            tilt.to_degrees()
        ),
        None => println!("no crack grew; the worst index is {:.2}", body.worst_index()),
    }
    Ok(())
}
