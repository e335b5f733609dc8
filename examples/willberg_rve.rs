//! Willberg, Wiedemann and Rädel 2019, section 6: fibres in resin under transverse tension, by
//! three criteria on bond energies, which must agree.
//!
//! ```text
//! cargo run --release --example willberg_rve [-- --short | --full] [SEED]
//! ```
//! A square of 25 mm in plane strain with fibres of 6.744 mm placed at random (the paper does not
//! list them; none overlap, the seed decides), layers of fibre stiffness at top and bottom,
//! Δx = 0.5 mm, m = 4. The paper's Table 8 gives critical energies of 0.4·10⁻³ N/m and labels that
//! do not fit its text; taken here as G_C of the resin: tension and compression 400 J/m², shear
//! 380 J/m² (N/mm, as is usual for resins; with 10⁻³ N/m it would fail before the first wave has
//! crossed it). Bonds inside fibres do not break. Pictures and the table go to `out/willberg_rve/`.

use peridynamics::damage::PowerLaw;
use peridynamics::damage::bond_energy::Uniform;
use peridynamics::damage::crack_path::fit_line;
use peridynamics::models::elasticity::catalogue;
use peridynamics::prelude::*;
use peridynamics::study::{Effort, conclude, damage, draw_damage};

type Place = SVector<f64, 2>;

const MM: f64 = 1e-3;
const FOLDER: &str = "out/willberg_rve";
const SIZE: f64 = 25.0 * MM;
const LAYER: f64 = 1.5 * MM;
const RADIUS: f64 = 3.372 * MM;
/// Smallest gap between fibres.
const GAP: f64 = 0.75 * MM;
const FIBRES: usize = 8;
const SPEED: f64 = 0.213;
/// Fracture energy of weak interfaces over that of the resin.
const WEAK: f64 = 0.5;
/// A critical energy that is never met.
const NEVER: f64 = 1e30;

fn other(error: impl std::fmt::Display) -> Error {
    Error::Other(error.to_string())
}

/// Numbers in (0, 1) that a seed decides (splitmix64).
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut x = self.0;
        x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((x ^ (x >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// Centres of fibres that lie inside the square and keep the gap.
fn fibres(seed: u64) -> Result<Vec<Place>> {
    let mut random = Random(seed);
    for _ in 0..200 {
        let mut centres: Vec<Place> = Vec::new();
        for _ in 0..2000 {
            let free = SIZE - 2.0 * (RADIUS + GAP);
            let centre = Place::from_fn(|_, _| (random.next() - 0.5) * free);
            if centres.iter().all(|c| (c - centre).norm() > 2.0 * RADIUS + GAP) {
                centres.push(centre);
            }
            if centres.len() == FIBRES {
                return Ok(centres);
            }
        }
    }
    Err(other(format!("{FIBRES} fibres do not fit in 200 attempts: take another seed")))
}

/// What one criterion did.
struct Outcome {
    first: f64,
    /// Separated nodes at each look.
    looks: Vec<(f64, CrackPath<2>)>,
    early: Vec<Place>,
    inside: usize,
    layers: usize,
    /// Share of the broken bonds that join a fibre and resin.
    joining: f64,
}

fn pull<C>(
    label: &str,
    centres: &[Place],
    (dx, toughness): (f64, f64),
    rule: impl Fn(f64, &CrackPlane<2>) -> Result<C>,
    never: C,
) -> Result<Outcome>
where
    C: DamageCriterion<f64, 2, Regions<Ordinary<LinearSolid>, 2>> + Clone,
{
    let grid = Grid::new(&Cuboid::centred([SIZE, SIZE + 2.0 * LAYER])?, dx)?;
    let layer = |x: &Place| x[1].abs() > 0.5 * SIZE;
    let stiff = |x: &Place| layer(x) || centres.iter().any(|c| (x - c).norm() < RADIUS);
    let region: Vec<u8> = (0..grid.len()).map(|i| u8::from(stiff(&grid.position(i)))).collect();
    let omega = InfluenceFunction::Constant;
    let mode = PlaneMode::PlaneStrain;
    let solid = |moduli: &Isotropic, density: f64| {
        LinearSolid::plane(moduli, mode, density, omega).map(Ordinary::new).map_err(other)
    };
    let resin = catalogue::willberg_resin().map_err(other)?;
    let fibre = catalogue::willberg_fibre().map_err(other)?;
    let materials = [
        solid(&resin, catalogue::WILLBERG_RESIN_DENSITY)?,
        solid(&fibre, catalogue::WILLBERG_FIBRE_DENSITY)?,
    ];
    let material = Regions::new(materials, region.clone()).map_err(other)?;
    let family = Lattice::<f64, 2>::new(&grid, Horizon::Cells(4.0), Quadrature::None)?;
    let plane = CrackPlane::lattice(&family, [0.0, 1.0])?;
    let (own, interface) = (rule(1.0, &plane)?, rule(toughness, &plane)?);
    let table = [[own, interface.clone()], [interface, never]];
    let margin = grid.select(layer);
    let criterion = Interfaces::new(table, region.clone())?.sparing(&margin);
    let mut body = Body::new(family, material, Breaking::new(criterion))?;
    let half = 0.5 * SIZE;
    body.set_velocity(|x| [0.0, (SPEED * x[1] / half).clamp(-SPEED, SPEED)].into());
    let start = damage(&body);
    let [top, bottom] = [1.0, -1.0].map(|side| grid.select(move |x| side * x[1] > half));
    let loads = Loads::new().velocity(&top, 1, SPEED).velocity(&bottom, 1, -SPEED);
    let mut run = Run::new(&mut body, loads, TimeStep::Safety(0.7))?;
    let mut seen = Outcome {
        first: f64::NAN,
        looks: Vec::new(),
        early: Vec::new(),
        inside: 0,
        layers: 0,
        joining: 0.0,
    };
    let mut joining = 0;
    // Bonds that broke, in the order in which they were seen broken.
    let mut order: Vec<Place> = Vec::new();
    let mut known = std::collections::HashSet::new();
    let mut parted = false;
    while run.time() < 1.5e-3 && !parted {
        let before = run.body().broken_bonds();
        run.steps_more(20)?;
        let body = run.body();
        if body.broken_bonds() > before {
            for node in (0..body.nodes()).filter(|&i| body.damage(i) > start[i]) {
                let x = body.position(node);
                body.neighbours(node, |n| {
                    if !n.intact && node < n.node && known.insert((node, n.node)) {
                        let y = body.position(n.node);
                        order.push((x + y) * 0.5);
                        let within = centres
                            .iter()
                            .any(|c| (x - c).norm() < RADIUS && (y - c).norm() < RADIUS);
                        seen.inside += usize::from(within);
                        seen.layers += usize::from(layer(&x) || layer(&y));
                        joining += usize::from(stiff(&x) != stiff(&y));
                    }
                });
            }
            if seen.first.is_nan() {
                seen.first = run.time();
            }
        }
        let cracks = CrackPath::of(body, &start);
        let across = cracks.largest();
        let reach = |side: f64| across.iter().map(|n| side * n.position[0]).fold(-1.0, f64::max);
        parted = reach(1.0) > 0.45 * SIZE && reach(-1.0) > 0.45 * SIZE;
        seen.looks.push((run.time(), cracks));
    }
    let end = run.time();
    drop(run);
    let title = format!("{label}, {:.3} ms", end * 1e3);
    draw_damage(&body, (5.0, [0, 1]), |_| true, &title, format!("{FOLDER}/{label}.png"))?;
    let few = (order.len() / 100).max(10).min(order.len());
    seen.early = order[..few].to_vec();
    seen.joining = joining as f64 / order.len() as f64;
    println!(
        "{label}: first break at {:.4} ms, {} bonds, ends at {:.4} ms",
        seen.first * 1e3,
        order.len(),
        end * 1e3
    );
    Ok(seen)
}

fn judge(label: &str, seen: &Outcome, centres: &[Place], dx: f64, table: &mut Measures) {
    let name = |what: &str| format!("{label}: {what}");
    let horizon = 4.0 * dx;
    let nearest = |x: &Place| -> Place {
        let from = centres.iter().map(|c| x - c);
        from.fold(Place::repeat(1.0), |a, b| if b.norm() < a.norm() { b } else { a })
    };
    let off = seen.early.iter().map(|x| (nearest(x).norm() - RADIUS).abs()).fold(0.0, f64::max);
    table.hard_most(
        &name("first 1 % of broken bonds from a fibre's surface [mm]"),
        off / MM,
        horizon / MM,
    );
    let angle = |x: &Place| {
        let r = nearest(x);
        r[0].abs().atan2(r[1].abs()).to_degrees()
    };
    let widest = seen.early.iter().map(angle).fold(0.0, f64::max);
    table.hard_most(&name("their angle from the load at the fibre [°]"), widest, 40.0);
    table.hard_most(&name("broken bonds inside fibres"), seen.inside as f64, 0.0);
    table.hard_most(&name("broken bonds in the layers"), seen.layers as f64, 0.0);
    let Some((_, cracks)) = seen.looks.last() else { return };
    let largest = cracks.largest();
    let ends = largest.iter().map(|n| n.position[0]);
    let (low, high) = ends.fold((0.0_f64, 0.0_f64), |(l, h), x| (l.min(x), h.max(x)));
    table.hard_least(&name("width spanned by the largest crack"), (high - low) / SIZE, 0.9);
    let line = fit_line(&largest).map_or(f64::NAN, |line| line.angle.to_degrees());
    table.hard_near(&name("its line [°]"), line, 0.0, 20.0);
}

fn main() -> Result<()> {
    let effort = Effort::from_arguments();
    let seed = std::env::args().skip(1).find_map(|a| a.parse().ok()).unwrap_or(1);
    let dx = effort.choose(1.0, 0.5, 0.25) * MM;
    let centres = fibres(seed)?;
    let command = effort.command("willberg_rve");
    let mut table = Measures::new("Fibres in resin (Willberg §6)", &command);
    let energy = |value: f64| FractureEnergy::new(value);
    let modes = |share: f64, plane: &CrackPlane<2>| {
        let normal = energy(400.0 * share)?;
        ModeEnergies::from_energies(normal, Some(normal), energy(380.0 * share)?, plane)
    };
    let never = ModeEnergies::new(NEVER, None, NEVER)?;
    let bonds = |share: f64, plane: &CrackPlane<2>| {
        BondEnergy::<Uniform>::from_energy(energy(400.0 * share)?, plane)
    };
    let power_law = |share: f64, plane: &CrackPlane<2>| modes(share, plane).map(PowerLaw::new);
    let apart = |share: f64, plane: &CrackPlane<2>| modes(share, plane).map(Separated::new);
    let whole = BondEnergy::<Uniform>::new(NEVER)?;
    let equal = (dx, 1.0);
    let foster = pull("energy", &centres, equal, bonds, whole)?;
    let power = pull("power_law", &centres, equal, power_law, PowerLaw::new(never))?;
    let separated = pull("separated", &centres, equal, apart, Separated::new(never))?;
    let weak = pull("energy_weak_interfaces", &centres, (dx, WEAK), bonds, whole)?;
    for (label, seen) in [("energy", &foster), ("power law", &power), ("separated", &separated)] {
        judge(label, seen, &centres, dx, &mut table);
    }
    for (label, seen) in [("power law", &power), ("separated", &separated)] {
        let apart = (seen.first / foster.first - 1.0).abs();
        table.hard_most(&format!("first damage, {label} against energy"), apart, 0.1);
        // Equal load: the end of the run that ended first.
        let looks = foster.looks.len().min(seen.looks.len());
        let same =
            looks.checked_sub(1).map_or(f64::NAN, |k| foster.looks[k].1.jaccard(&seen.looks[k].1));
        table.hard_least(&format!("Jaccard index, {label} and energy, at equal load"), same, 0.7);
        let last = |o: &Outcome| o.looks.last().map(|l| l.1.clone());
        if let (Some(a), Some(b)) = (last(&foster), last(seen)) {
            println!("{label} and energy at failure: Jaccard index {:.3}", a.jaccard(&b));
        }
    }
    let name = |what: &str| format!("energy, interfaces of {WEAK} the toughness: {what}");
    table.hard_most(&name("first damage over that of equal ones"), weak.first / foster.first, 1.0);
    let more = weak.joining / foster.joining;
    table.hard_least(&name("share of broken bonds that join fibre and resin, likewise"), more, 1.0);
    table.told(&name("that share"), weak.joining);
    conclude(&table, effort, FOLDER, &["angle from the load", "first damage", "Jaccard index"])
}
