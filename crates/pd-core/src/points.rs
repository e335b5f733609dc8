//! Point clouds: positions and volumes.

use crate::grid::{Grid, NodeSet};
use crate::{Error, Result};
use nalgebra::SVector;
use std::cmp::Ordering;

/// Nodes at given places with given volumes (areas in 2D, per unit thickness).
#[derive(Debug, Clone)]
pub struct Points<const D: usize> {
    positions: Vec<SVector<f64, D>>,
    volumes: Vec<f64>,
    spacing: f64,
}

impl<const D: usize> Points<D> {
    /// From positions in metres and volumes in m^D. The unit of length Δx is the D-th root of the
    /// median volume; see [`with_spacing`](Self::with_spacing).
    ///
    /// # Errors
    /// [`Error::InvalidValue`] for no nodes or lists of different length;
    /// [`Error::InvalidNodeValue`] for a coordinate that is not finite or a volume that is not
    /// finite and positive; [`Error::CoincidentNodes`] for two nodes at the same place.
    pub fn new(positions: Vec<SVector<f64, D>>, volumes: Vec<f64>) -> Result<Self> {
        let n = positions.len();
        Error::check(n > 0, "number of nodes", 0.0, "at least 1")?;
        Error::check(
            volumes.len() == n,
            "number of volumes",
            volumes.len() as f64,
            "the number of positions",
        )?;
        for (node, (x, &volume)) in positions.iter().zip(&volumes).enumerate() {
            let check = |ok: bool, what, value, need| {
                if ok { Ok(()) } else { Err(Error::InvalidNodeValue { node, what, value, need }) }
            };
            for &c in x {
                check(c.is_finite(), "coordinate [m]", c, "finite")?;
            }
            let positive = volume.is_finite() && volume > 0.0;
            check(positive, "volume V [m^D]", volume, "finite and positive")?;
        }
        let mut order: Vec<usize> = (0..n).collect();
        // Not `total_cmp`, which would part −0 from 0; there is no NaN left.
        order.sort_by(|&a, &b| {
            let (a, b) = (positions[a].as_slice(), positions[b].as_slice());
            a.partial_cmp(b).unwrap_or(Ordering::Equal)
        });
        if let Some(pair) = order.windows(2).find(|w| positions[w[0]] == positions[w[1]]) {
            return Err(Error::CoincidentNodes {
                nodes: [pair[0].min(pair[1]), pair[0].max(pair[1])],
                position: positions[pair[0]].iter().copied().collect(),
            });
        }
        let mut sorted = volumes.clone();
        sorted.sort_by(f64::total_cmp);
        let spacing = sorted[n / 2].powf(1.0 / D as f64);
        Ok(Self { positions, volumes, spacing })
    }
    /// The nodes of a grid.
    pub fn from_grid(grid: &Grid<D>) -> Self {
        Self {
            positions: grid.positions().collect(),
            volumes: vec![grid.cell_volume(); grid.len()],
            spacing: grid.spacing()[0],
        }
    }
    /// The cells of a grid, each halved along every axis until it is no wider than `spacing` allows at
    /// its centre, in metres: squares (cubes) of edges Δx, Δx/2, Δx/4, …, one node in each. The finest
    /// edge becomes the unit of length. [`edge`](Self::edge) gives what horizons are multiples of.
    /// Nodes are numbered in rows along x, which is what the kernels of a cloud are fastest at.
    ///
    /// # Errors
    /// [`Error::InvalidValue`] for a spacing that is not finite and positive.
    pub fn refined(grid: &Grid<D>, spacing: impl Fn(&SVector<f64, D>) -> f64) -> Result<Self> {
        let mut nodes = Vec::new();
        let mut finest = f64::INFINITY;
        // Cells yet to look at, with how often they were halved.
        let mut cells: Vec<_> = grid.positions().map(|x| (x, 0)).collect();
        while let Some((x, halved)) = cells.pop() {
            let edges = grid.spacing() * 0.5_f64.powi(halved);
            let wanted = Error::positive("spacing wanted of a cloud [m]", spacing(&x))?;
            // A wanted edge that is off by rounding is met.
            if edges.max() <= wanted * (1.0 + 1e-9) {
                nodes.push((x, edges.product()));
                finest = edges.max().min(finest);
                continue;
            }
            for part in 0..1_usize << D {
                let side = |d: usize| if part >> d & 1 == 1 { 0.25 } else { -0.25 };
                cells.push((SVector::from_fn(|d, _| x[d] + side(d) * edges[d]), halved + 1));
            }
        }
        let by_rows = |a: &SVector<f64, D>, b: &SVector<f64, D>| {
            let axes = (0..D).rev().map(|d| a[d].total_cmp(&b[d]));
            axes.fold(Ordering::Equal, Ordering::then)
        };
        nodes.sort_unstable_by(|(a, _), (b, _)| by_rows(a, b));
        let (positions, volumes) = nodes.into_iter().unzip();
        Self::new(positions, volumes)?.with_spacing(finest)
    }
    /// With this unit of length Δx in metres: horizon ratios refer to it.
    ///
    /// # Errors
    /// [`Error::InvalidValue`] unless positive.
    pub fn with_spacing(mut self, spacing: f64) -> Result<Self> {
        self.spacing = Error::positive("spacing Δx [m]", spacing)?;
        Ok(self)
    }
    /// Number of nodes.
    pub fn len(&self) -> usize {
        self.positions.len()
    }
    /// A cloud has at least one node.
    pub fn is_empty(&self) -> bool {
        false
    }
    /// Position of a node in metres.
    pub fn position(&self, node: usize) -> &SVector<f64, D> {
        &self.positions[node]
    }
    /// Volume of a node in m^D.
    pub fn volume(&self, node: usize) -> f64 {
        self.volumes[node]
    }
    /// Edge of the square (cube) of a node's volume in metres: its local spacing.
    pub fn edge(&self, node: usize) -> f64 {
        self.volumes[node].powf(1.0 / D as f64)
    }
    /// The unit of length Δx in metres.
    pub fn spacing(&self) -> f64 {
        self.spacing
    }
    /// The nodes for which a predicate holds.
    pub fn select(&self, inside: impl Fn(&SVector<f64, D>) -> bool) -> NodeSet {
        let chosen = (0..self.len()).filter(|&i| inside(&self.positions[i]));
        NodeSet::from_nodes(chosen, self.len()).unwrap_or_default()
    }
    /// Bytes held.
    pub fn bytes(&self) -> usize {
        self.positions.capacity() * size_of::<SVector<f64, D>>()
            + self.volumes.capacity() * size_of::<f64>()
    }
}
