//! Fixed-radius neighbour search in point clouds by cell lists.

use crate::parallel::map_pieces;
use nalgebra::SVector;
use rayon::prelude::*;
use std::sync::atomic::{AtomicU32, Ordering::Relaxed};

/// Relative slack of every comparison with a horizon, so that lattice points exactly at the horizon
/// count whatever the rounding of their coordinates.
pub const TOLERANCE: f64 = 1e-9;

/// Cells whose points' neighbours one task finds.
const CELLS: usize = 64;

/// Compressed rows: the neighbours of every point, ascending.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Rows {
    /// Row i is `neighbour[start[i]..start[i + 1]]`; one entry more than there are points.
    pub start: Vec<usize>,
    /// The neighbours, row after row.
    pub neighbour: Vec<u32>,
}

impl Rows {
    /// The neighbours of point `i`, ascending.
    pub fn row(&self, i: usize) -> &[u32] {
        &self.neighbour[self.start[i]..self.start[i + 1]]
    }
}

/// Every j ≠ i with |x_j − x_i| ≤ max(r_i, r_j), up to [`TOLERANCE`], for every point i: its family
/// and its dual family (Zhao et al. 2017, refs. 55–56), so that the relation is symmetric.
///
/// `positions` and `radius` are in metres; at most 2³² points. A point that is not finite has no
/// neighbours, and a point whose radius is not positive is found but finds none. The rows do not
/// depend on the number of threads. Memory does not depend on the extent of the cloud, time is
/// proportional to the number of neighbours where the radii follow the spacing of the points, for
/// coordinates up to 10¹² radii.
pub fn neighbours<const D: usize>(
    positions: &[SVector<f64, D>],
    radius: impl Fn(usize) -> f64 + Sync,
) -> Rows {
    let levels = levels(positions, radius);
    let counts = zeros(positions.len());
    let mut found: Vec<Vec<Vec<u32>>> =
        (0..levels.len()).map(|k| families(&levels, k, &counts)).collect();
    let counts: Vec<u32> = counts.into_iter().map(AtomicU32::into_inner).collect();
    let mut start = vec![0; positions.len() + 1];
    for (i, count) in counts.iter().enumerate() {
        start[i + 1] = start[i] + *count as usize;
    }
    // Each slot is written once. Atomics let the threads follow the cells and write rows wherever
    // these lie.
    let slots = zeros(start[positions.len()]);
    for (level, found) in levels.iter().zip(&mut found) {
        found.par_iter_mut().enumerate().for_each(|(cell, families)| {
            let mut rest = &mut std::mem::take(families)[..];
            for p in level.own.points_of(cell) {
                let i = p.index as usize;
                let (family, after) = rest.split_at_mut(counts[i] as usize);
                family.sort_unstable();
                slots[start[i]..].iter().zip(family).for_each(|(slot, j)| slot.store(*j, Relaxed));
                rest = after;
            }
        });
    }
    Rows { start, neighbour: slots.into_iter().map(AtomicU32::into_inner).collect() }
}

fn zeros(count: usize) -> Vec<AtomicU32> {
    vec![0; count].into_iter().map(AtomicU32::new).collect()
}

/// Points whose radii lie within a factor of two.
///
/// A pair is found in the cells of the coarser of its two points: from a coarse point one would
/// visit vast numbers of fine cells, and a coarse cell holds too many fine points.
struct Level<const D: usize> {
    own: CellList<D>,
    /// The points of all finer levels, in cells of the size of this one.
    finer: CellList<D>,
}

/// The levels from fine to coarse.
fn levels<const D: usize>(
    positions: &[SVector<f64, D>],
    radius: impl Fn(usize) -> f64 + Sync,
) -> Vec<Level<D>> {
    let point = |(i, x): (usize, &SVector<f64, D>)| {
        let radius = radius(i).max(0.0);
        // No square is below −1: such a point finds none.
        let limit = if radius > 0.0 { (radius * (1.0 + TOLERANCE)).powi(2) } else { -1.0 };
        let finite = x.iter().all(|x| x.is_finite());
        finite.then_some((radius, Point { x: *x, limit, index: i as u32 }))
    };
    let mut points: Vec<_> = positions.par_iter().enumerate().filter_map(point).collect();
    points.par_sort_by(|a, b| a.0.total_cmp(&b.0));
    let (radii, points): (Vec<f64>, Vec<Point<D>>) = points.into_iter().unzip();
    let mut levels = Vec::new();
    let mut end = radii.len();
    while end > 0 && radii[end - 1] > 0.0 {
        let reach = radii[end - 1];
        // Points that find none have no level of their own.
        let begin = radii[..end].partition_point(|&r| r < 0.5 * reach);
        let begin = if radii[..begin].last() > Some(&0.0) { begin } else { 0 };
        levels.push(Level {
            own: CellList::new(&points[begin..end], reach),
            finer: CellList::new(&points[..begin], reach),
        });
        end = begin;
    }
    levels.reverse();
    levels
}

/// The neighbours of the points of level `k`, those of a cell one after the other, and their
/// number in `counts`. Following the cells keeps the points that are read in cache.
fn families<const D: usize>(levels: &[Level<D>], k: usize, counts: &[AtomicU32]) -> Vec<Vec<u32>> {
    let Level { own, finer } = &levels[k];
    let of_cell = |(near, family): &mut (Near<D>, Vec<u32>), cell: usize| {
        let points = own.points_of(cell);
        let (low, high) = points[1..]
            .iter()
            .fold((points[0].x, points[0].x), |(low, high), p| (low.inf(&p.x), high.sup(&p.x)));
        near.clear();
        for list in levels[k..].iter().map(|l| &l.own).chain([finer]) {
            list.around(&low, &high, |points| near.extend(points));
        }
        let mut found = Vec::new();
        for p in points {
            near.family(p, family);
            counts[p.index as usize].store(family.len() as u32, Relaxed);
            found.extend_from_slice(family);
        }
        found
    };
    map_pieces(own.cells.len(), CELLS, &|cells| {
        let mut scratch = Default::default();
        cells.map(|cell| of_cell(&mut scratch, cell)).collect::<Vec<_>>()
    })
    .flatten()
    .collect()
}

/// Candidates of one cell, component by component so that the distances vectorise.
struct Near<const D: usize> {
    x: [Vec<f64>; D],
    limit: Vec<f64>,
    index: Vec<u32>,
    /// |ξ|² of every candidate, for one point.
    square: Vec<f64>,
}

impl<const D: usize> Default for Near<D> {
    fn default() -> Self {
        Self {
            x: std::array::from_fn(|_| Vec::new()),
            limit: vec![],
            index: vec![],
            square: vec![],
        }
    }
}

impl<const D: usize> Near<D> {
    fn clear(&mut self) {
        self.x.iter_mut().for_each(Vec::clear);
        self.limit.clear();
        self.index.clear();
    }

    fn extend(&mut self, points: &[Point<D>]) {
        for k in 0..D {
            self.x[k].extend(points.iter().map(|p| p.x[k]));
        }
        self.limit.extend(points.iter().map(|p| p.limit));
        self.index.extend(points.iter().map(|p| p.index));
    }

    /// The indices of those that see `p` or are seen by it.
    fn family(&mut self, p: &Point<D>, family: &mut Vec<u32>) {
        self.square.clear();
        self.square.resize(self.limit.len(), 0.0);
        for k in 0..D {
            for (square, x) in self.square.iter_mut().zip(&self.x[k]) {
                *square += (x - p.x[k]).powi(2);
            }
        }
        family.resize(self.index.len(), 0);
        let mut count = 0;
        for ((square, limit), index) in self.square.iter().zip(&self.limit).zip(&self.index) {
            family[count] = *index;
            count += usize::from((*square <= limit.max(p.limit)) & (*index != p.index));
        }
        family.truncate(count);
    }
}

#[derive(Clone, Copy)]
struct Point<const D: usize> {
    x: SVector<f64, D>,
    /// Square of the largest distance at which it finds a neighbour.
    limit: f64,
    index: u32,
}

/// Points ordered by cell. Only occupied cells are stored.
struct CellList<const D: usize> {
    /// The largest distance at which a point of the list is a neighbour, and the edge of the cells.
    reach: f64,
    /// In lexicographic order: a run of cells along the last axis is contiguous.
    cells: Vec<[i64; D]>,
    /// Cell c holds `points[start[c]..start[c + 1]]`.
    start: Vec<usize>,
    points: Vec<Point<D>>,
}

impl<const D: usize> CellList<D> {
    fn new(points: &[Point<D>], reach: f64) -> Self {
        let mut keyed: Vec<_> = points.par_iter().map(|p| (cell_of(&p.x, reach), *p)).collect();
        keyed.par_sort_unstable_by_key(|(cell, p)| (*cell, p.index));
        let (mut cells, mut start) = (Vec::new(), Vec::new());
        for (k, (cell, _)) in keyed.iter().enumerate() {
            if cells.last() != Some(cell) {
                cells.push(*cell);
                start.push(k);
            }
        }
        start.push(keyed.len());
        Self { reach, cells, start, points: keyed.into_iter().map(|(_, p)| p).collect() }
    }

    fn points_of(&self, cell: usize) -> &[Point<D>] {
        &self.points[self.start[cell]..self.start[cell + 1]]
    }

    /// Calls `visit` with the points of all cells within reach of the box `low`..`high`.
    fn around(
        &self,
        low: &SVector<f64, D>,
        high: &SVector<f64, D>,
        mut visit: impl FnMut(&[Point<D>]),
    ) {
        // The slack covers the rounding of coordinates far from the origin.
        let reach = 1.001 * self.reach;
        let first = cell_of(&low.add_scalar(-reach), self.reach);
        let last = cell_of(&high.add_scalar(reach), self.reach);
        let mut from = first;
        loop {
            let mut to = from;
            to[D - 1] = last[D - 1];
            let begin = self.cells.partition_point(|c| *c < from);
            let count = self.cells[begin..].iter().take_while(|c| **c <= to).count();
            visit(&self.points[self.start[begin]..self.start[begin + count]]);
            // The next run: count up the axes before the last.
            let Some(axis) = (0..D - 1).rev().find(|&k| from[k] < last[k]) else { break };
            from[axis] += 1;
            from[axis + 1..].copy_from_slice(&first[axis + 1..]);
        }
    }
}

/// The cell of a point. All points further out than 2⁴⁰ edges share one: there f64 hardly resolves
/// a bond, and the few strays of a cloud still find each other.
fn cell_of<const D: usize>(x: &SVector<f64, D>, edge: f64) -> [i64; D] {
    const FAR: f64 = (1_u64 << 40) as f64;
    std::array::from_fn(|k| (x[k] / edge).floor().clamp(-FAR, FAR) as i64)
}
