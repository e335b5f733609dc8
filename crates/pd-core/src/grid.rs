//! Uniform grids with inactive cells, and sets of nodes.

use crate::region::{Shape, holds};
use crate::{Error, Result};
use nalgebra::SVector;
use std::collections::BTreeMap;

/// No node in this cell.
const NONE: u32 = u32::MAX;

/// A uniform grid of cells; nodes sit at the centres of its active cells, in lexicographic order
/// with x fastest. In 2D volumes are areas (per unit thickness).
///
/// A centre within 1e-9 Δx of a [`Shape`]'s boundary is in the shape, on the outer edge as on the
/// edge of a hole, however its coordinates are rounded. Predicates are taken at their word.
#[derive(Debug, Clone)]
pub struct Grid<const D: usize> {
    /// Centre of the first cell.
    origin: SVector<f64, D>,
    spacing: SVector<f64, D>,
    cells: [usize; D],
    /// Cell of each node; empty if every cell is active.
    cell_of: Vec<u32>,
    /// Node of each cell; empty if every cell is active.
    node_of: Vec<u32>,
    /// Material region of each node; empty if all are 0.
    regions: Vec<u8>,
}

impl<const D: usize> Grid<D> {
    /// Cells of edge Δx = `spacing` (metres) from the lowest corner of the shape on; those whose
    /// centre is in the shape are active.
    ///
    /// # Errors
    /// [`Error::InvalidValue`] for a spacing that is not positive, bounds that are not finite or
    /// more than 2³² cells; [`Error::EmptyGrid`] if no centre is in the shape.
    pub fn new(shape: &(impl Shape<D> + ?Sized), spacing: f64) -> Result<Self> {
        Self::with_spacing(shape, [spacing; D])
    }

    /// As [`Grid::new`], with the edge of a cell along each axis.
    ///
    /// # Errors
    /// As [`Grid::new`].
    pub fn with_spacing(shape: &(impl Shape<D> + ?Sized), spacing: [f64; D]) -> Result<Self> {
        let (low, high) = shape.bounds();
        let mut cells = [0; D];
        for d in 0..D {
            Error::positive("spacing Δx [m]", spacing[d])?;
            let extent = Error::positive("extent of the shape [m]", high[d] - low[d])?;
            cells[d] = ((extent / spacing[d]).round() as usize).max(1);
        }
        let spacing = SVector::from(spacing);
        Self::lattice(low + spacing * 0.5, spacing, cells)?.retain(|x| holds(shape, x, &spacing))
    }

    /// A full box of cells from the centre of the first cell.
    ///
    /// # Errors
    /// [`Error::InvalidValue`] as [`Grid::new`].
    pub fn lattice(
        origin: SVector<f64, D>,
        spacing: SVector<f64, D>,
        cells: [usize; D],
    ) -> Result<Self> {
        for d in 0..D {
            Error::positive("spacing Δx [m]", spacing[d])?;
            Error::check(origin[d].is_finite(), "origin of a grid [m]", origin[d], "finite")?;
        }
        let total = cells.iter().map(|&n| n as f64).product::<f64>();
        let ok = total >= 1.0 && total < f64::from(NONE);
        Error::check(ok, "number of cells", total, "between 1 and 2^32; use a coarser grid")?;
        Ok(Self {
            origin,
            spacing,
            cells,
            cell_of: Vec::new(),
            node_of: Vec::new(),
            regions: Vec::new(),
        })
    }

    /// The same grid without the nodes for which `keep` does not hold.
    ///
    /// # Errors
    /// [`Error::EmptyGrid`] if none is left.
    pub fn retain(self, keep: impl Fn(&SVector<f64, D>) -> bool) -> Result<Self> {
        let kept: Vec<usize> = (0..self.len()).filter(|&i| keep(&self.position(i))).collect();
        if kept.is_empty() {
            return Err(Error::EmptyGrid { spacing: self.spacing.iter().copied().collect() });
        }
        if kept.len() == self.len() {
            return Ok(self);
        }
        let regions = if self.regions.is_empty() {
            Vec::new()
        } else {
            kept.iter().map(|&i| self.regions[i]).collect()
        };
        let mut node_of = vec![NONE; self.cells.iter().product()];
        let mut cell_of = Vec::with_capacity(kept.len());
        for (node, &old) in kept.iter().enumerate() {
            let cell = self.cell_index(old);
            node_of[cell] = node as u32;
            cell_of.push(cell as u32);
        }
        Ok(Self { cell_of, node_of, regions, ..self })
    }

    /// Gives the nodes in `shape` to material region `region` (0 elsewhere): inclusions. Later
    /// marks override earlier ones.
    ///
    /// # Errors
    /// [`Error::EmptySet`] if no node is in the shape.
    pub fn mark(mut self, region: u8, shape: &(impl Shape<D> + ?Sized)) -> Result<Self> {
        let inside = self.select_in(shape).non_empty(&format!("region {region}"))?;
        if self.regions.is_empty() {
            self.regions = vec![0; self.len()];
        }
        for node in inside.iter() {
            self.regions[node] = region;
        }
        Ok(self)
    }

    fn cell_index(&self, node: usize) -> usize {
        if self.cell_of.is_empty() { node } else { self.cell_of[node] as usize }
    }
    /// Number of nodes.
    pub fn len(&self) -> usize {
        if self.cell_of.is_empty() { self.cells.iter().product() } else { self.cell_of.len() }
    }
    /// A grid has at least one node.
    pub fn is_empty(&self) -> bool {
        false
    }
    /// Number of cells along each axis.
    pub fn cells(&self) -> [usize; D] {
        self.cells
    }
    /// Edges of a cell in metres.
    pub fn spacing(&self) -> &SVector<f64, D> {
        &self.spacing
    }
    /// Centre of the first cell in metres.
    pub fn origin(&self) -> &SVector<f64, D> {
        &self.origin
    }
    /// Volume of a cell in m^D.
    pub fn cell_volume(&self) -> f64 {
        self.spacing.iter().product()
    }
    /// Cell of a node.
    pub fn cell(&self, node: usize) -> [usize; D] {
        let mut rest = self.cell_index(node);
        std::array::from_fn(|d| {
            let i = rest % self.cells[d];
            rest /= self.cells[d];
            i
        })
    }
    /// Node of a cell, if the cell is active.
    pub fn node(&self, cell: [usize; D]) -> Option<usize> {
        if (0..D).any(|d| cell[d] >= self.cells[d]) {
            return None;
        }
        let index = (0..D).rev().fold(0, |index, d| index * self.cells[d] + cell[d]);
        match self.node_of.get(index) {
            None => Some(index),
            Some(&node) => (node != NONE).then_some(node as usize),
        }
    }
    /// Position of a node in metres.
    pub fn position(&self, node: usize) -> SVector<f64, D> {
        let cell = self.cell(node);
        SVector::from_fn(|d, _| self.origin[d] + cell[d] as f64 * self.spacing[d])
    }
    /// Positions of all nodes in metres.
    pub fn positions(&self) -> impl Iterator<Item = SVector<f64, D>> + Clone + '_ {
        (0..self.len()).map(|node| self.position(node))
    }
    /// The node nearest to a point.
    pub fn nearest(&self, x: &SVector<f64, D>) -> usize {
        let distance = |node: usize| (self.position(node) - x).norm_squared();
        (0..self.len()).min_by(|&a, &b| distance(a).total_cmp(&distance(b))).unwrap_or(0)
    }
    /// Material region of a node.
    pub fn region(&self, node: usize) -> u8 {
        self.regions.get(node).copied().unwrap_or(0)
    }
    /// Material regions of all nodes.
    pub fn regions(&self) -> Vec<u8> {
        (0..self.len()).map(|node| self.region(node)).collect()
    }
    /// The nodes for which a predicate holds.
    pub fn select(&self, inside: impl Fn(&SVector<f64, D>) -> bool) -> NodeSet {
        let chosen = (0..self.len()).filter(|&node| inside(&self.position(node)));
        NodeSet(chosen.map(|node| node as u32).collect())
    }
    /// The nodes in a shape, its boundary included.
    pub fn select_in(&self, shape: &(impl Shape<D> + ?Sized)) -> NodeSet {
        self.select(|x| holds(shape, x, &self.spacing))
    }
    /// Bytes held.
    pub fn bytes(&self) -> usize {
        4 * (self.cell_of.capacity() + self.node_of.capacity()) + self.regions.capacity()
    }
}

/// A set of nodes, ascending.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct NodeSet(Vec<u32>);

impl NodeSet {
    /// From node indices below `total`, in any order.
    ///
    /// # Errors
    /// [`Error::InvalidValue`] for an index out of range.
    pub fn from_nodes(nodes: impl IntoIterator<Item = usize>, total: usize) -> Result<Self> {
        let mut set = Vec::new();
        let total = total.min(NONE as usize);
        for node in nodes {
            Error::check(node < total, "node index", node as f64, "below the number of nodes")?;
            set.push(node as u32);
        }
        set.sort_unstable();
        set.dedup();
        Ok(Self(set))
    }
    /// The nodes in ascending order.
    pub fn iter(&self) -> impl Iterator<Item = usize> + '_ {
        self.0.iter().map(|&node| node as usize)
    }
    /// Number of nodes.
    pub fn len(&self) -> usize {
        self.0.len()
    }
    /// True if no node is in the set.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }
    /// True if the node is in the set.
    pub fn contains(&self, node: usize) -> bool {
        u32::try_from(node).is_ok_and(|node| self.0.binary_search(&node).is_ok())
    }
    /// Nodes in either set.
    pub fn union(&self, other: &Self) -> Self {
        let mut all = [&self.0[..], &other.0[..]].concat();
        all.sort_unstable();
        all.dedup();
        Self(all)
    }
    /// Nodes in this set, but not in the other.
    pub fn minus(&self, other: &Self) -> Self {
        Self(self.iter().filter(|&n| !other.contains(n)).map(|n| n as u32).collect())
    }
    /// This set, if it has nodes.
    ///
    /// # Errors
    /// [`Error::EmptySet`] with the name given.
    pub fn non_empty(self, name: &str) -> Result<Self> {
        if self.is_empty() { Err(Error::EmptySet { name: name.to_owned() }) } else { Ok(self) }
    }
}

/// Node sets by name.
#[derive(Debug, Clone, Default)]
pub struct NodeSets(BTreeMap<String, NodeSet>);

impl NodeSets {
    /// No sets.
    pub fn new() -> Self {
        Self::default()
    }
    /// Adds a set.
    ///
    /// # Errors
    /// [`Error::EmptySet`] for a set without nodes.
    pub fn insert(&mut self, name: &str, set: NodeSet) -> Result<()> {
        self.0.insert(name.to_owned(), set.non_empty(name)?);
        Ok(())
    }
    /// The set of this name.
    ///
    /// # Errors
    /// [`Error::UnknownSet`] with the names there are.
    pub fn get(&self, name: &str) -> Result<&NodeSet> {
        self.0.get(name).ok_or_else(|| Error::UnknownSet {
            name: name.to_owned(),
            known: self.0.keys().cloned().collect(),
        })
    }
}
