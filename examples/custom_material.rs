//! A material of your own, at two levels: a bond law in 17 lines and a constitutive law in 13.
//!
//! `cargo run --release --example custom_material`

use peridynamics::check::{Conditions, Rotations, check_material};
use peridynamics::prelude::*;

/// A bond that hardens: t = c s (1 + b s²) with the stretch s = e/|ξ|.
struct Hardening {
    c: f64,
    b: f64,
}

impl<T: Real, const D: usize> BondLaw<T, D> for Hardening {
    /// |ξ|.
    type Const = T;
    fn density(&self) -> f64 {
        1000.0
    }
    fn bond_const(&self, xi: &SVector<f64, D>, _: Scale) -> T {
        T::of(xi.norm())
    }
    fn force(&self, bond: &Bond<T, D>, length: &T) -> T {
        let s = bond.extension(*length) / *length;
        T::of(self.c) * s * (T::one() + T::of(self.b) * s * s)
    }
}

/// A solid that is stiffer in compression than in tension: σ = E ε, twice that where tr ε < 0.
struct Bimodular {
    young: f64,
}

impl<T: Real, const D: usize> Constitutive<T, D> for Bimodular {
    fn stress(&self, h: &SMatrix<T, D, D>) -> SMatrix<T, D, D> {
        let strain = (h + h.transpose()) * T::of(0.5);
        let factor = if h.trace() < T::zero() { 2.0 } else { 1.0 };
        strain * T::of(self.young * factor)
    }
    fn cauchy(&self, h: &SMatrix<T, D, D>) -> SMatrix<T, D, D> {
        self.stress(h)
    }
}

fn main() -> std::result::Result<(), Box<dyn std::error::Error>> {
    // Is it a material at all? One line in a test: `check_material(…).assert()`.
    let hardening = BondBased(Hardening { c: 1e9, b: 100.0 });
    println!("hardening bonds\n{}", check_material(&hardening, &Conditions::<2>::default()));
    let law = Bimodular { young: 1e9 };
    let bimodular = Correspondence::new(law, 1000.0, InfluenceFunction::Linear)?;
    let small = Conditions { rotations: Rotations::Small, ..Conditions::<2>::default() };
    println!("bimodular solid\n{}", check_material(&bimodular, &small));

    let grid = Grid::new(&Cuboid::centred([0.02, 0.02])?, 1e-3)?;
    let family = Lattice::<f64, 2>::new(&grid, Horizon::Cells(3.0), Quadrature::LinearRamp)?;

    // The same law serves every family, precision and dimension.
    let mut spring = Body::new(family.clone(), hardening, NoDamage)?;
    let centre = grid.nearest(&SVector::zeros());
    println!("hardening bonds: force density near the edge of a stretched plate");
    for strain in [0.01, 0.05, 0.1] {
        spring.set_displacement(|x| x * strain);
        spring.evaluate()?;
        println!("  strain {strain:4.2}: {:9.3e} N/m³", spring.force_density(0).norm());
    }

    let mut plate = Body::new(family, bimodular, NoDamage)?;
    println!("bimodular solid: stress at the centre");
    for strain in [1e-3, -1e-3] {
        plate.set_displacement(|x| [x[0] * strain, 0.0].into());
        plate.evaluate()?;
        println!("  strain {strain:6.3}: {:9.3e} Pa", plate.stress(centre)[(0, 0)]);
    }

    // The critical step is that of small motion about rest; twice the stiffness on one side asks
    // for a margin.
    let mut run = Run::new(&mut plate, Loads::new(), TimeStep::Safety(0.5))?;
    run.steps_more(200)?;
    let top = (0..grid.len()).map(|i| run.body().velocity(i).norm()).fold(0.0, f64::max);
    println!("released: fastest node after {} steps at {top:.3} m/s", run.steps());
    Ok(())
}
