//! Explicit plane finite elements: square four-node elements, full integration, lumped masses,
//! central differences. An independent reference for bodies whose histories no table holds.

use nalgebra::{SMatrix, SVector};
use pd_models::Stiffness;

type Place = SVector<f64, 2>;

/// A plate of square elements, each of one material or missing, with a seam along y = 0.
pub struct Quads {
    edge: f64,
    /// Nodes by element, counter-clockwise, and its material.
    elements: Vec<([usize; 4], usize)>,
    /// By material.
    stiffness: Vec<SMatrix<f64, 8, 8>>,
    density: Vec<f64>,
    mass: Vec<f64>,
    /// Lower and upper node of the seam, by column.
    seam: Vec<[usize; 2]>,
    low: f64,
    /// Positions in metres.
    pub x: Vec<Place>,
    /// Displacements in metres.
    pub u: Vec<Place>,
    /// Velocities in m/s.
    pub v: Vec<Place>,
    force: Vec<Place>,
}

/// ∫ Bᵀ C B dA of a square element with unit thickness: 2 × 2 points are exact for a square. The
/// edge drops out.
fn element(stiffness: &Stiffness<2>) -> SMatrix<f64, 8, 8> {
    let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    let c = stiffness.voigt();
    let g = 1.0 / 3.0_f64.sqrt();
    let point = |[s, t]: [f64; 2]| {
        let mut b = SMatrix::<f64, 3, 8>::zeros();
        for (n, [a, d]) in corners.iter().enumerate() {
            let (x, y) = (0.25 * a * (1.0 + d * t * g), 0.25 * d * (1.0 + a * s * g));
            (b[(0, 2 * n)], b[(2, 2 * n + 1)]) = (x, x);
            (b[(1, 2 * n + 1)], b[(2, 2 * n)]) = (y, y);
        }
        b.transpose() * c * b
    };
    corners.map(point).iter().sum()
}

impl Quads {
    /// `counts` elements of edge `edge` from the corner `low` (a row of nodes must lie on y = 0).
    /// `material` gives the row of `materials` (stiffness, density in kg/m³) at an element's
    /// centre, or none for a hole; the seam runs from the left edge to x = `tip`.
    pub fn new(
        (low, counts, edge): ([f64; 2], [usize; 2], f64),
        materials: &[(Stiffness<2>, f64)],
        material: impl Fn(&Place) -> Option<usize>,
        tip: f64,
    ) -> Self {
        let [nx, ny] = counts;
        let origin = Place::from(low);
        let mut x: Vec<Place> = (0..(nx + 1) * (ny + 1))
            .map(|k| origin + Place::new((k % (nx + 1)) as f64, (k / (nx + 1)) as f64) * edge)
            .collect();
        let level = (-low[1] / edge).round() as usize;
        let split = (0..=nx).take_while(|&i| low[0] + i as f64 * edge < tip - 0.5 * edge);
        let mut seam = Vec::new();
        for i in split {
            let lower = level * (nx + 1) + i;
            seam.push([lower, x.len()]);
            x.push(x[lower]);
        }
        let mut elements = Vec::new();
        let mut mass = vec![0.0; x.len()];
        for (i, j) in (0..ny).flat_map(|j| (0..nx).map(move |i| (i, j))) {
            let centre = origin + Place::new(i as f64 + 0.5, j as f64 + 0.5) * edge;
            let Some(kind) = material(&centre) else { continue };
            let node = |i: usize, j: usize, upper: bool| match seam.get(i) {
                Some(pair) if upper && j == level => pair[1],
                _ => j * (nx + 1) + i,
            };
            let up = j == level;
            let nodes = [
                node(i, j, up),
                node(i + 1, j, up),
                node(i + 1, j + 1, false),
                node(i, j + 1, false),
            ];
            nodes.iter().for_each(|&n| mass[n] += 0.25 * materials[kind].1 * edge * edge);
            elements.push((nodes, kind));
        }
        let (stiffness, density) = materials.iter().map(|(c, rho)| (element(c), rho)).unzip();
        let still = vec![Place::zeros(); x.len()];
        let (u, v, force) = (still.clone(), still.clone(), still);
        Self { edge, elements, stiffness, density, mass, seam, low: low[0], x, u, v, force }
    }

    /// 2/ω of the stiffest element alone: no assembly of elements swings faster.
    pub fn stable_step(&self) -> f64 {
        let omega2 = self.stiffness.iter().zip(&self.density).map(|(k, density)| {
            k.symmetric_eigenvalues().max() / (0.25 * density * self.edge * self.edge)
        });
        2.0 / omega2.fold(0.0, f64::max).sqrt()
    }

    /// One step of central differences (velocity Verlet).
    pub fn step(&mut self, dt: f64) {
        for n in 0..self.x.len() {
            self.kick(n, 0.5 * dt);
            self.u[n] += self.v[n] * dt;
            self.force[n] = Place::zeros();
        }
        for (nodes, kind) in &self.elements {
            let own = SVector::<f64, 8>::from_fn(|k, _| self.u[nodes[k / 2]][k % 2]);
            let f = self.stiffness[*kind] * own;
            for (k, &n) in nodes.iter().enumerate() {
                self.force[n] -= Place::new(f[2 * k], f[2 * k + 1]);
            }
        }
        (0..self.x.len()).for_each(|n| self.kick(n, 0.5 * dt));
    }
    fn kick(&mut self, n: usize, dt: f64) {
        if self.mass[n] > 0.0 {
            self.v[n] += self.force[n] * (dt / self.mass[n]);
        }
    }

    /// u(upper face) − u(lower face) at x on the seam.
    pub fn opening(&self, x: f64) -> Place {
        let place = (x - self.low) / self.edge;
        let (low, part) = (place.floor() as usize, place - place.floor());
        let at = |column: usize| match self.seam.get(column) {
            Some([lower, upper]) => self.u[*upper] - self.u[*lower],
            None => Place::zeros(),
        };
        at(low) * (1.0 - part) + at(low + 1) * part
    }
}
