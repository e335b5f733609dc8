//! Families of a point cloud, with one horizon or one per node.
//!
//! With one horizon per node the row of node i lists H_i ∪ H'_i, the family and the dual family
//! (Zhao, dual horizon): f_i = Σ_{H_i} T_i V_j − Σ_{H'_i} T_j V_j. β V is 0 where a neighbour is
//! in one of the two only.
//!
//! Nodes lie in blocks of sixteen, as they are numbered. A node's bonds are sorted by ξ, so that
//! bonds of one shape at several nodes of a block come together: such a batch is computed at
//! once, a bond to a lane, like an offset of a lattice. Blocks whose nodes share few shapes are
//! computed bond by bond.

use crate::bond::{Arithmetic, Bond, Member, Scale};
use crate::dispatch::{Vectorised, dispatch};
use crate::family::{BondKernel, BondTest, Family, Horizon, Neighbour, Pair, Tally, Visit};
use crate::field::{Field, Inputs, Planes};
use crate::lanes::{Gathered, close};
use crate::parallel::{map_pieces, sweep_pieces};
use crate::points::Points;
use crate::quadrature::Quadrature;
use crate::record::{LANES, Record};
use crate::search::neighbours;
use crate::{Error, Real, Result};
use nalgebra::SVector;
use rayon::prelude::*;
use std::cmp::Ordering;
use std::ops::Range;
use std::sync::atomic::{AtomicBool, AtomicU8, Ordering::Relaxed};

/// Consecutive nodes whose bonds are sorted together.
const BLOCK: usize = 2 * LANES;

/// Nodes that one task works on: fixed, so that nothing depends on the number of threads.
const CHUNK: usize = 64 * BLOCK;

/// A neighbour within rounding of a whole number of units away is that number away, so that a
/// lattice given as points has exactly the bonds of the lattice.
const SNAP: f64 = 8.0 * f64::EPSILON;

/// What a bond is besides its nodes. Bonds of the same shape share one where there are few, as in
/// clouds that are a lattice or lattices of a few spacings.
#[derive(Debug, Clone, Copy, PartialEq)]
struct BondShape<T, const D: usize> {
    xi: SVector<T, D>,
    /// 1/|ξ|².
    inverse_square: T,
    /// β_ij V_j and β_ji V_j: what weighs T_i and T_j in the force density of node i.
    volumes: [T; 2],
    /// Horizons of i and j.
    horizons: [T; 2],
}

/// Families of a point cloud (see the module's head).
#[derive(Debug, Clone)]
pub struct Cloud<T, const D: usize> {
    points: Points<D>,
    unit: f64,
    /// One entry, or one per node.
    horizons: Vec<f64>,
    /// Where the batches of every block begin, and what they list; one entry more than blocks.
    blocks: Vec<Start>,
    batches: Vec<Batch>,
    /// Far ends of the bonds whose batch does not tell them.
    listed: Vec<u32>,
    /// Shapes of the bonds listed; empty if every bond has its own.
    kind: Vec<u16>,
    shapes: Vec<BondShape<T, D>>,
    /// Nodes of one bond of each shape; empty if every bond has its own.
    samples: Vec<[u32; 2]>,
}

/// A place in the batches and in what they list.
#[derive(Debug, Clone, Copy, Default)]
struct Start {
    batch: usize,
    listed: usize,
}

/// Up to [`BLOCK`] bonds of a block: of one shape, one at each node of some; or of one node.
#[derive(Debug, Clone, Copy)]
struct Batch {
    /// The far end at the block's first node, if it is one further at each node; else [`LISTED`].
    far: u32,
    /// The shape of the bonds; or [`ROW`] and which node of the block they belong to.
    kind: u16,
    /// Which bonds there are: a bit per node of the block, or the lowest ones for one node.
    there: u16,
}

/// The far ends of a batch are in the list.
const LISTED: u32 = u32::MAX;
/// The bonds of a batch belong to one node, and shapes are in the list too.
const ROW: u16 = 1 << 15;
/// A block has batches of one shape if they hold this many bonds on average: fewer lanes take more
/// time than so many bonds one by one.
const WORTHWHILE: usize = 8;

/// A bond of a node.
struct Entry {
    /// The batch it is in, and its bit there.
    batch: usize,
    bit: u32,
    far: usize,
    /// Where its shape is.
    shape: usize,
}

impl Batch {
    fn is_row(self) -> bool {
        self.kind & ROW != 0
    }
    /// Entries of the list.
    #[inline(always)]
    fn listed(self) -> usize {
        if self.far == LISTED { self.there.count_ones() as usize } else { 0 }
    }
    /// The bonds of a node of the block, of a batch that has some.
    #[inline(always)]
    fn of(self, lane: usize) -> u16 {
        if self.is_row() { self.there } else { self.there & 1 << lane }
    }
}

/// Constants per shape of a bond: as the row's node sees it and, with one horizon per node, as its
/// neighbour does.
#[derive(Debug, Clone)]
pub struct RowTable<K> {
    own: Vec<K>,
    mate: Option<Vec<K>>,
}

/// One bit per directed bond, those of a batch in two bytes, in blocks where bonds can break or are cut.
#[derive(Debug)]
pub struct CloudBits {
    /// Where those of every block begin; one entry more than blocks.
    begins: Vec<u32>,
    bytes: Vec<u8>,
    /// Per node: 1 if it lost a bond since the marks were cleared.
    marks: Vec<AtomicU8>,
}

impl CloudBits {
    fn range(&self, block: usize) -> Range<usize> {
        self.begins[block] as usize..self.begins[block + 1] as usize
    }
}

/// The bits of a block that has some.
#[derive(Clone, Copy)]
struct BlockBits<'a> {
    bytes: &'a [u8],
    /// The block's first batch.
    first: usize,
}

impl BlockBits<'_> {
    #[inline(always)]
    fn batch(self, batch: usize) -> u16 {
        let at = 2 * (batch - self.first);
        u16::from_le_bytes([self.bytes[at], self.bytes[at + 1]])
    }
}

fn snapped(x: f64, size: f64) -> f64 {
    // Adding 1.5·2⁵² leaves no digit after the point: `f64::round` is a call on plain x86-64.
    const SHIFT: f64 = 1.5 * (1_u64 << 52) as f64;
    let whole = if x.abs() < 0.25 * SHIFT { (x + SHIFT) - SHIFT } else { x };
    if (x - whole).abs() <= SNAP * size.max(1.0) { whole } else { x }
}

/// Edges of the cube that stands for the cell of a node of this volume.
fn cell<const D: usize>(volume: f64) -> SVector<f64, D> {
    SVector::repeat(if volume == 1.0 { 1.0 } else { volume.powf(1.0 / D as f64) })
}

impl<T: Real, const D: usize> Cloud<T, D> {
    /// Families of a cloud with one horizon.
    ///
    /// # Errors
    /// [`Error::InvalidValue`] for a horizon that is not positive.
    pub fn new(points: &Points<D>, horizon: Horizon, quadrature: Quadrature) -> Result<Self> {
        let delta = horizon.in_units(points.spacing())?;
        Self::build(points, vec![delta], quadrature)
    }

    /// Families of a cloud with the horizon δ_i of every node in metres (dual horizon).
    ///
    /// # Errors
    /// [`Error::InvalidValue`] for a horizon that is not positive, or not one per node.
    pub fn graded(points: &Points<D>, horizons: &[f64], quadrature: Quadrature) -> Result<Self> {
        Error::check(
            horizons.len() == points.len(),
            "number of horizons",
            horizons.len() as f64,
            "the number of nodes",
        )?;
        let unit = points.spacing();
        let deltas: Result<Vec<f64>> =
            horizons.iter().map(|&d| Horizon::Metres(d).in_units(unit)).collect();
        Self::build(points, deltas?, quadrature)
    }

    fn build(points: &Points<D>, horizons: Vec<f64>, quadrature: Quadrature) -> Result<Self> {
        let unit = points.spacing();
        let n = points.len();
        let mut cloud = Self {
            points: points.clone(),
            unit,
            horizons,
            blocks: vec![Start::default()],
            batches: Vec::new(),
            listed: Vec::new(),
            kind: Vec::new(),
            shapes: Vec::new(),
            samples: Vec::new(),
        };
        let scaled: Vec<SVector<f64, D>> = (0..n).map(|i| points.position(i) / unit).collect();
        // Asked for at every bond, computed once per node.
        let volumes: Vec<f64> = (0..n).map(|i| cloud.unit_volume(i)).collect();
        let cells: Vec<SVector<f64, D>> = volumes.iter().map(|&v| cell(v)).collect();
        let horizons = cloud.horizons.clone();
        let horizon = |i: usize| horizons[if horizons.len() == 1 { 0 } else { i }];
        let rows = neighbours(&scaled, |i| quadrature.reach(&cells[i], horizon(i)).max(horizon(i)));
        // Coordinates carry the rounding of the whole cloud's extent, not of their own size.
        let extent = scaled.iter().map(SVector::amax).fold(0.0, f64::max);
        let xi = |i: usize, j: usize| (scaled[j] - scaled[i]).map(|x| snapped(x, extent));
        let beta =
            |i: usize, j: usize, xi: &SVector<f64, D>| quadrature.weight(xi, &cells[j], horizon(i));
        let shape = |i: usize, j: usize| {
            let xi = xi(i, j);
            let own = beta(i, j, &xi);
            // Both ends see a bond alike if their cells and horizons are the same.
            let alike = volumes[i] == volumes[j] && horizon(i) == horizon(j);
            let mate = if alike { own } else { beta(j, i, &-xi) };
            BondShape {
                xi: xi.map(T::of),
                inverse_square: T::of(1.0 / xi.norm_squared()),
                volumes: [own * volumes[j], mate * volumes[j]].map(T::of),
                horizons: [horizon(i), horizon(j)].map(T::of),
            }
        };
        let many = AtomicBool::new(false);
        let build = |share: bool| -> Vec<Bundle<T, D>> {
            let bundle = |chunk: usize| {
                let mut bundle = Bundle::new(n.next_multiple_of(BLOCK));
                for block in (chunk * CHUNK..n.min((chunk + 1) * CHUNK)).step_by(BLOCK) {
                    if share && many.load(Relaxed) {
                        break;
                    }
                    let nodes = block..n.min(block + BLOCK);
                    bundle.add_block(nodes, share, |i| rows.row(i), shape);
                    if bundle.kinds.full {
                        many.store(true, Relaxed);
                    }
                }
                bundle
            };
            (0..n.div_ceil(CHUNK)).into_par_iter().map(bundle).collect()
        };
        let mut chunks = build(true);
        let mut kinds = Kinds::default();
        let mut global = Vec::new();
        for chunk in &chunks {
            let samples = chunk.kinds.shapes.iter().zip(&chunk.kinds.samples);
            global.push(samples.map(|(s, nodes)| kinds.find(s, *nodes)).collect::<Vec<u16>>());
        }
        let share = !kinds.full && !many.load(Relaxed);
        if !share {
            // Too many shapes to share.
            chunks = build(false);
        }
        drop(rows);
        let total = |of: &dyn Fn(&Bundle<T, D>) -> usize| chunks.iter().map(of).sum();
        let mut blocks = Vec::with_capacity(n.div_ceil(BLOCK) + 1);
        let mut batches: Vec<Batch> = Vec::with_capacity(total(&|c| c.batches.len()));
        let mut listed: Vec<u32> = Vec::with_capacity(total(&|c| c.listed.len()));
        let mut kind = Vec::with_capacity(total(&|c| c.kind.len()));
        for (chunk, bundle) in chunks.into_iter().enumerate() {
            let (batch, list) = (batches.len(), listed.len());
            let starts = bundle.starts.iter();
            blocks
                .extend(starts.map(|s| Start { batch: batch + s.batch, listed: list + s.listed }));
            listed.extend_from_slice(&bundle.listed);
            if share {
                let global = |k: u16| global[chunk][usize::from(k)];
                kind.extend(bundle.kind.iter().map(|&k| global(k)));
                batches.extend(
                    bundle.batches.iter().map(|b| {
                        if b.is_row() { *b } else { Batch { kind: global(b.kind), ..*b } }
                    }),
                );
            } else {
                batches.extend_from_slice(&bundle.batches);
            }
        }
        blocks.push(Start { batch: batches.len(), listed: listed.len() });
        (cloud.blocks, cloud.batches, cloud.listed, cloud.kind) = (blocks, batches, listed, kind);
        if share {
            (cloud.shapes, cloud.samples) = (kinds.shapes, kinds.samples);
        } else {
            cloud.shapes = cloud.for_every_bond(&|i, bond| shape(i, bond.far));
        }
        cloud.shapes.shrink_to_fit();
        cloud.samples.shrink_to_fit();
        Ok(cloud)
    }

    /// The points this cloud was made from.
    pub fn points(&self) -> &Points<D> {
        &self.points
    }

    fn horizon(&self, node: usize) -> f64 {
        if self.horizons.len() == 1 { self.horizons[0] } else { self.horizons[node] }
    }
    fn unit_volume(&self, node: usize) -> f64 {
        let volume = self.points.volume(node) / self.unit.powi(D as i32);
        snapped(volume, volume)
    }
    /// Where the batches with bonds of each node of a block begin and end.
    #[inline(always)]
    fn spans(&self, block: usize) -> [[Start; 2]; BLOCK] {
        let [begin, end] = [self.blocks[block], self.blocks[block + 1]];
        let mut spans = [[begin, end]; BLOCK];
        if self.is_rows(block) {
            spans = [[begin; 2]; BLOCK];
            let mut at = begin;
            while at.batch < end.batch {
                let batch = self.batches[at.batch];
                let span = &mut spans[usize::from(batch.kind & !ROW)];
                if span[0].batch == span[1].batch {
                    span[0] = at;
                }
                at = Start { batch: at.batch + 1, listed: at.listed + batch.listed() };
                span[1] = at;
            }
        }
        spans
    }
    /// Whether the batches of a block belong to one node each.
    #[inline(always)]
    fn is_rows(&self, block: usize) -> bool {
        let first = self.blocks[block].batch;
        first == self.blocks[block + 1].batch || self.batches[first].is_row()
    }
    /// The bonds of node `lane` of a block in their order; the intact ones if bits are given.
    #[inline(always)]
    fn walk<'a>(
        &'a self,
        [begin, end]: [Start; 2],
        lane: usize,
        bits: Option<BlockBits<'a>>,
    ) -> Walk<'a, T, D> {
        let before = Start { batch: begin.batch.wrapping_sub(1), ..begin };
        let none = Batch { far: 0, kind: 0, there: 0 };
        Walk { cloud: self, bits, lane, at: before, end: end.batch, batch: none, rest: 0 }
    }
    /// The bonds of a node in their order; the intact ones if bits are given.
    fn bonds_with<'a>(&'a self, bits: Option<&'a CloudBits>, node: usize) -> Walk<'a, T, D> {
        let (block, lane) = (node / BLOCK, node % BLOCK);
        self.walk(self.spans(block)[lane], lane, self.block_bits(bits, block))
    }
    /// The bonds of a node in their order.
    fn bonds_of(&self, node: usize) -> Walk<'_, T, D> {
        self.bonds_with(None, node)
    }
    /// `value` of every node and each of its bonds, where every bond has its own shape: in the
    /// order of the shapes.
    fn for_every_bond<X: Send>(&self, value: &(dyn Fn(usize, Entry) -> X + Sync)) -> Vec<X> {
        let rows = |nodes: Range<usize>| -> Vec<X> {
            nodes.flat_map(|i| self.bonds_of(i).map(move |bond| value(i, bond))).collect()
        };
        let mut values = Vec::with_capacity(self.listed.len());
        map_pieces(self.points.len(), CHUNK, &rows).for_each(|piece| values.extend(piece));
        values
    }
    /// The bond from `node` to `far`.
    fn find(&self, node: usize, far: usize) -> Option<Entry> {
        self.bonds_of(node).find(|bond| bond.far == far)
    }
    /// The bits of a block; none if all its bonds are intact.
    #[inline(always)]
    fn block_bits<'a>(&self, bits: Option<&'a CloudBits>, block: usize) -> Option<BlockBits<'a>> {
        let bits = bits?;
        let range = bits.range(block);
        let held = !range.is_empty();
        held.then(|| BlockBits { bytes: &bits.bytes[range], first: self.blocks[block].batch })
    }
    fn is_intact(&self, bits: Option<&CloudBits>, node: usize, bond: &Entry) -> bool {
        let bits = self.block_bits(bits, node / BLOCK);
        bits.is_none_or(|bits| bits.batch(bond.batch) >> bond.bit & 1 == 1)
    }
    /// No bits: every bond is intact.
    fn no_bits(&self) -> CloudBits {
        let marks = (0..self.nodes()).map(|_| AtomicU8::new(0)).collect();
        CloudBits { begins: vec![0; self.blocks.len()], bytes: Vec::new(), marks }
    }
    /// Gives bits to blocks that have none.
    fn hold(&self, bits: &mut CloudBits, blocks: &dyn Fn(usize) -> bool) {
        let count = self.blocks.len() - 1;
        let (mut begins, mut bytes) = (Vec::with_capacity(count + 1), Vec::new());
        begins.push(0);
        for block in 0..count {
            let range = bits.range(block);
            if range.is_empty() && blocks(block) {
                let [begin, end] = [self.blocks[block].batch, self.blocks[block + 1].batch];
                let batches = &self.batches[begin..end];
                bytes.extend(batches.iter().flat_map(|batch| batch.there.to_le_bytes()));
            } else {
                bytes.extend_from_slice(&bits.bytes[range]);
            }
            begins.push(bytes.len() as u32);
        }
        bytes.shrink_to_fit();
        (bits.begins, bits.bytes) = (begins, bytes);
    }
    /// Breaks a bond for one of its ends.
    fn lose(&self, bits: &mut CloudBits, node: usize, bond: &Entry) {
        let own = node / BLOCK;
        if bits.range(own).is_empty() {
            self.hold(bits, &|block| block == own);
        }
        let first = self.blocks[own].batch;
        let byte = 2 * (bond.batch - first) + bond.bit as usize / 8;
        let begin = bits.range(own).start;
        bits.bytes[begin + byte] &= !(1 << (bond.bit % 8));
        *bits.marks[node].get_mut() = 1;
    }
}

/// The bonds of a node.
struct Walk<'a, T, const D: usize> {
    cloud: &'a Cloud<T, D>,
    bits: Option<BlockBits<'a>>,
    /// The node's place in its block.
    lane: usize,
    at: Start,
    end: usize,
    batch: Batch,
    /// Bonds of the batch that are yet to come.
    rest: u16,
}

impl<T: Real, const D: usize> Iterator for Walk<'_, T, D> {
    type Item = Entry;
    #[inline(always)]
    fn next(&mut self) -> Option<Entry> {
        while self.rest == 0 {
            self.at.listed += self.batch.listed();
            self.at.batch = self.at.batch.wrapping_add(1);
            if self.at.batch == self.end {
                return None;
            }
            self.batch = self.cloud.batches[self.at.batch];
            self.rest = self.batch.of(self.lane);
            if let Some(bits) = self.bits {
                self.rest &= bits.batch(self.at.batch);
            }
        }
        let (batch, bit) = (self.batch, self.rest.trailing_zeros());
        self.rest &= self.rest - 1;
        let row = batch.is_row();
        let before = || batch.there & !(u16::MAX << bit);
        let place = || self.at.listed + if row { bit } else { before().count_ones() } as usize;
        let far = match batch.far {
            LISTED => self.cloud.listed[place()] as usize,
            far => far as usize + self.lane,
        };
        let shape = if !row {
            usize::from(batch.kind)
        } else if self.cloud.kind.is_empty() {
            place()
        } else {
            usize::from(self.cloud.kind[place()])
        };
        Some(Entry { batch: self.at.batch, bit, far, shape })
    }
}

impl<T: Real, const D: usize> BondShape<T, D> {
    fn xi64(&self) -> SVector<f64, D> {
        self.xi.map(Real::to_f64)
    }
}

/// Distinct shapes of bonds, in the order they were met.
struct Kinds<T, const D: usize> {
    shapes: Vec<BondShape<T, D>>,
    samples: Vec<[u32; 2]>,
    /// Places of shapes by their hash; the rest of the search is in `shapes` itself.
    slots: Vec<u16>,
    /// There are more than can be told apart.
    full: bool,
    /// The number found last, and the one found after each number: rows are much alike.
    last: u16,
    after: Vec<u16>,
}

/// More shapes than this are not shared.
const MOST_KINDS: usize = 1 << 14;

impl<T: Real, const D: usize> Default for Kinds<T, D> {
    fn default() -> Self {
        let slots = vec![u16::MAX; 4 * MOST_KINDS];
        let (shapes, samples, after) = (Vec::new(), Vec::new(), Vec::new());
        Self { shapes, samples, slots, full: false, last: 0, after }
    }
}

impl<T: Real, const D: usize> Kinds<T, D> {
    /// The number of a shape, a new one if it was not met before.
    fn find(&mut self, shape: &BondShape<T, D>, nodes: [u32; 2]) -> u16 {
        let guess = self.after.get(usize::from(self.last)).copied().unwrap_or(0);
        let kind = match self.shapes.get(usize::from(guess)) {
            Some(known) if known == shape => guess,
            _ => self.search(shape, nodes),
        };
        if let Some(after) = self.after.get_mut(usize::from(self.last)) {
            *after = kind;
        }
        self.last = kind;
        kind
    }
    /// As [`find`](Self::find), without a guess (open addressing).
    fn search(&mut self, shape: &BondShape<T, D>, nodes: [u32; 2]) -> u16 {
        let mut hash = 0_u64;
        let numbers = shape.xi.iter().chain(&shape.volumes).chain(&shape.horizons);
        for number in numbers {
            let bits = number.to_f64().to_bits();
            hash = (hash.rotate_left(5) ^ bits).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        }
        let mut slot = (hash >> 40) as usize % self.slots.len();
        while self.slots[slot] != u16::MAX {
            let kind = self.slots[slot];
            if self.shapes[usize::from(kind)] == *shape {
                return kind;
            }
            slot = (slot + 1) % self.slots.len();
        }
        if self.shapes.len() == MOST_KINDS {
            self.full = true;
            return 0;
        }
        let kind = self.shapes.len() as u16;
        self.slots[slot] = kind;
        self.shapes.push(*shape);
        self.samples.push(nodes);
        self.after.push(0);
        kind
    }
}

/// Batches of some consecutive blocks, before they are put together.
struct Bundle<T, const D: usize> {
    starts: Vec<Start>,
    batches: Vec<Batch>,
    listed: Vec<u32>,
    kind: Vec<u16>,
    kinds: Kinds<T, D>,
    /// Length of the node arrays.
    sites: usize,
}

/// A bond of a row, before it has a place.
type Loose<T, const D: usize> = (SVector<T, D>, u32, u16);

/// By ξ, the last component first: on a lattice the order of the neighbours.
fn by_xi<T: Real, const D: usize>(a: &Loose<T, D>, b: &Loose<T, D>) -> Ordering {
    let apart = (0..D).rev().find(|&d| a.0[d] != b.0[d]);
    apart.map_or(a.2.cmp(&b.2), |d| a.0[d].partial_cmp(&b.0[d]).unwrap_or(Ordering::Equal))
}

impl<T: Real, const D: usize> Bundle<T, D> {
    fn new(sites: usize) -> Self {
        Self {
            starts: Vec::new(),
            batches: Vec::new(),
            listed: Vec::new(),
            kind: Vec::new(),
            kinds: Kinds::default(),
            sites,
        }
    }
    fn add_block<'a>(
        &mut self,
        nodes: Range<usize>,
        share: bool,
        row: impl Fn(usize) -> &'a [u32],
        shape: impl Fn(usize, usize) -> BondShape<T, D>,
    ) {
        self.starts.push(Start { batch: self.batches.len(), listed: self.listed.len() });
        let first = nodes.start;
        let mut rows: [Vec<Loose<T, D>>; BLOCK] = std::array::from_fn(|_| Vec::new());
        for i in nodes {
            let loose = &mut rows[i - first];
            for &j in row(i) {
                let shape = shape(i, j as usize);
                if shape.volumes.iter().any(|v| *v > T::zero()) {
                    let find = share && !self.kinds.full;
                    let kind = if find { self.kinds.find(&shape, [i as u32, j]) } else { 0 };
                    loose.push((shape.xi, j, kind));
                }
            }
            loose.sort_by(by_xi);
        }
        if !share || !self.add_shared(&rows) {
            self.add_rows(&rows, share);
        }
    }
    /// Batches of one shape, if they are worth it.
    fn add_shared(&mut self, rows: &[Vec<Loose<T, D>>; BLOCK]) -> bool {
        let before = (self.batches.len(), self.listed.len());
        let most = rows.iter().map(Vec::len).sum::<usize>() / WORTHWHILE;
        let mut rest: [&[Loose<T, D>]; BLOCK] = std::array::from_fn(|lane| &rows[lane][..]);
        loop {
            let heads = rest.iter().filter_map(|row| row.first());
            let Some(&(_, _, kind)) =
                heads.reduce(|a, b| if a.2 == b.2 || by_xi(a, b).is_le() { a } else { b })
            else {
                return true;
            };
            if self.batches.len() - before.0 == most {
                self.batches.truncate(before.0);
                self.listed.truncate(before.1);
                self.kind.truncate(before.1);
                return false;
            }
            let (mut there, mut far) = (0, None);
            let list = self.listed.len();
            for (lane, row) in rest.iter_mut().enumerate() {
                if let Some(((_, j, _), tail)) =
                    row.split_first().filter(|(head, _)| head.2 == kind)
                {
                    *row = tail;
                    there |= 1 << lane;
                    self.listed.push(*j);
                    let start = i64::from(*j) - lane as i64;
                    far = if far.is_none_or(|far| far == start) { Some(start) } else { Some(-1) };
                }
            }
            // All lanes are read, those that are not there too.
            let inside = far.filter(|far| (0..=self.sites as i64 - BLOCK as i64).contains(far));
            if inside.is_some() {
                self.listed.truncate(list);
            }
            self.kind.resize(self.listed.len(), kind);
            self.batches.push(Batch { far: inside.map_or(LISTED, |far| far as u32), kind, there });
        }
    }
    fn add_rows(&mut self, rows: &[Vec<Loose<T, D>>; BLOCK], share: bool) {
        for (lane, row) in rows.iter().enumerate() {
            for piece in row.chunks(BLOCK) {
                self.listed.extend(piece.iter().map(|bond| bond.1));
                if share {
                    self.kind.extend(piece.iter().map(|bond| bond.2));
                }
                let there = u16::MAX >> (BLOCK - piece.len());
                self.batches.push(Batch { far: LISTED, kind: ROW | lane as u16, there });
            }
        }
    }
}

/// Everything a chunk of a sweep reads.
struct Job<'a, T, const D: usize, Kn: BondKernel<T, D>, I, J>
where
    T: Real,
{
    cloud: &'a Cloud<T, D>,
    kernel: &'a Kn,
    table: &'a RowTable<Kn::Const>,
    bits: Option<&'a CloudBits>,
    marked: bool,
    u: &'a Field<T, SVector<T, D>>,
    input: I,
    own: J,
}

/// The largest t of the blocks of a chunk.
impl<'o, T, const D: usize, Kn, I, J>
    Vectorised<(Range<usize>, <Kn::Out as Record<T>>::PlanesMut<'o>)> for Job<'_, T, D, Kn, I, J>
where
    T: Real,
    Kn: BondKernel<T, D>,
    I: Inputs<T, Value = Kn::Node>,
    J: Inputs<T, Value = Kn::Own>,
{
    type Output = T;
    #[inline(always)]
    fn run(
        &self,
        (nodes, mut out): (Range<usize>, <Kn::Out as Record<T>>::PlanesMut<'o>),
        fused: bool,
    ) -> T {
        if T::WIDE {
            sweep_blocks::<T, D, Kn, I, J, BLOCK>(self, nodes, &mut out, fused)
        } else {
            sweep_blocks::<T, D, Kn, I, J, LANES>(self, nodes, &mut out, fused)
        }
    }
}

/// The blocks of a chunk, N nodes at once; returns the largest t.
#[inline(always)]
fn sweep_blocks<T, const D: usize, Kn, I, J, const N: usize>(
    job: &Job<'_, T, D, Kn, I, J>,
    sites: Range<usize>,
    out: &mut <Kn::Out as Record<T>>::PlanesMut<'_>,
    fused: bool,
) -> T
where
    T: Real,
    Kn: BondKernel<T, D>,
    I: Inputs<T, Value = Kn::Node>,
    J: Inputs<T, Value = Kn::Own>,
{
    let limit = T::of(Bond::<T, D>::SMALL);
    let first = sites.start;
    let mut largest = T::zero();
    for start in sites.step_by(BLOCK) {
        let block = start / BLOCK;
        // The nodes to sum for, then those to sum for bond by bond.
        let mut rest = job.visited(block);
        if rest == 0 {
            continue;
        }
        // As for lattices, one loop where nothing is fused.
        let rows = !fused || job.cloud.is_rows(block);
        if !rows {
            for part in (0..BLOCK).step_by(N) {
                let (done, high) = job.sweep_lanes::<N>(block, part, first, out, fused);
                rest &= !done;
                largest = if high > largest { high } else { largest };
            }
        }
        if rest == 0 {
            continue;
        }
        let spans = job.cloud.spans(block);
        for lane in (0..BLOCK).filter(|lane| rest >> lane & 1 == 1) {
            let node = start + lane;
            // Taken for small bonds first, like the blocks of a lattice.
            let mut arithmetic = Arithmetic { small: Kn::STRETCH && rows && fused, fused };
            let (sum, high) = loop {
                let (sum, low, high) = job.fold(node, spans[lane], arithmetic);
                if !arithmetic.small || (low >= -limit && high <= limit) {
                    break (sum, high);
                }
                arithmetic.small = false;
            };
            largest = if high > largest { high } else { largest };
            let previous = <Kn::Out as Record<T>>::read(out, node - first);
            let (own, constants) = (job.input.load(node), job.own.load(node));
            job.kernel.close(&sum, &own, &constants, previous).write(out, node - first);
        }
    }
    largest
}

/// The records of some nodes.
#[inline(always)]
fn gather<T: Real, I: Inputs<T>, const N: usize>(
    input: &I,
    nodes: &[u32; N],
) -> <I::Value as Record<T>>::Lanes<N> {
    let mut lanes = <I::Value as Record<T>>::lanes::<N>();
    for l in 0..N {
        // A block of one node: no bounds to check for each of its planes.
        I::lane::<1>(&input.block::<1>(nodes[l] as usize), 0).put::<N>(&mut lanes, l);
    }
    lanes
}

/// The records of consecutive nodes.
#[inline(always)]
fn consecutive<T: Real, I: Inputs<T>, const N: usize>(
    input: &I,
    start: usize,
) -> <I::Value as Record<T>>::Lanes<N> {
    let mut lanes = <I::Value as Record<T>>::lanes::<N>();
    let block = input.block::<N>(start);
    for l in 0..N {
        I::lane::<N>(&block, l).put::<N>(&mut lanes, l);
    }
    lanes
}

impl<T, const D: usize, Kn, I, J> Job<'_, T, D, Kn, I, J>
where
    T: Real,
    Kn: BondKernel<T, D>,
    I: Inputs<T, Value = Kn::Node>,
    J: Inputs<T, Value = Kn::Own>,
{
    /// The nodes of a block that are to be visited.
    #[inline(always)]
    fn visited(&self, block: usize) -> u32 {
        let nodes = block * BLOCK..self.cloud.points.len().min((block + 1) * BLOCK);
        match self.bits {
            Some(bits) if self.marked => nodes
                .rev()
                .fold(0, |mask, node| mask << 1 | u32::from(bits.marks[node].load(Relaxed) != 0)),
            _ => u32::MAX >> (u32::BITS as usize - nodes.len()),
        }
    }
    /// The nodes `part .. part + N` of a block, taking all bonds for small: writes the results of
    /// those for which that is so. Returns which these are, and their largest t.
    #[inline(always)]
    fn sweep_lanes<const N: usize>(
        &self,
        block: usize,
        part: usize,
        first: usize,
        out: &mut <Kn::Out as Record<T>>::PlanesMut<'_>,
        fused: bool,
    ) -> (u32, T) {
        let start = block * BLOCK + part;
        let limit = T::of(Bond::<T, D>::SMALL);
        let near: Planes<'_, T, N> = self.u.block(start);
        let own_block = self.input.block::<N>(start);
        let arithmetic = Arithmetic { small: Kn::STRETCH, fused };
        let Gathered { sums, low, high } =
            self.fold_lanes::<N>((block, part), (&near, &own_block), arithmetic);
        let mut done = 0;
        let mut largest = T::zero();
        for l in 0..N {
            let small = !Kn::STRETCH || (high[l] <= limit) & (low[l] >= -limit);
            let there = start + l < self.cloud.points.len();
            done |= u32::from(small & there) << l;
            largest = if small && high[l] > largest { high[l] } else { largest };
        }
        let blocks = (&own_block, &self.own.block::<N>(start));
        close::<T, D, Kn, I, J, N>(self.kernel, &sums, blocks, out, (start, first), done);
        (done << part, largest)
    }
    /// Adds the bonds of the nodes `part .. part + N` of a block to zero sums.
    #[inline(always)]
    fn fold_lanes<const N: usize>(
        &self,
        (block, part): (usize, usize),
        (near, own): (&Planes<'_, T, N>, &I::Block<N>),
        arithmetic: Arithmetic,
    ) -> Gathered<T, Kn::Sum, N> {
        let mut gathered = Gathered::nothing();
        let [begin, end] = [self.cloud.blocks[block], self.cloud.blocks[block + 1]];
        let lanes = u32::MAX >> (u32::BITS as usize - N);
        let bits = self.cloud.block_bits(self.bits, block);
        let mut list = begin.listed;
        for at in begin.batch..end.batch {
            let batch = self.cloud.batches[at];
            let there = bits.map_or(batch.there, |bits| bits.batch(at));
            let there = u32::from(there) >> part & lanes;
            let (u, other) = if batch.far == LISTED {
                let mut nodes = [0; N];
                let before = u32::from(batch.there) & !(u32::MAX << part);
                let mut place = list + before.count_ones() as usize;
                for l in 0..N {
                    let on = batch.there >> (part + l) & 1 == 1;
                    nodes[l] = if on { self.cloud.listed[place] } else { 0 };
                    place += usize::from(on);
                }
                (gather(&self.u, &nodes), gather(&self.input, &nodes))
            } else {
                let far = batch.far as usize + part;
                (consecutive(&self.u, far), consecutive(&self.input, far))
            };
            list += batch.listed();
            let place = usize::from(batch.kind);
            let shape = &self.cloud.shapes[place];
            let pair = Pair { constants: self.table.ends(place), volumes: shape.volumes };
            let mut with = Gathered::nothing();
            for l in 0..N {
                let on = there >> l & 1 == 1;
                let far = <SVector<T, D> as Record<T>>::get::<N>(&u, l);
                let eta = SVector::from_fn(|d, _| far[d] - near.plane(d)[l]);
                let bond = Bond::of_kernel(shape.xi, eta, shape.inverse_square, arithmetic);
                let nodes = [I::lane::<N>(own, l), <I::Value as Record<T>>::get::<N>(&other, l)];
                with.add(&gathered, (l, on), self.kernel, &bond, pair, [&nodes[0], &nodes[1]]);
            }
            gathered = with;
        }
        gathered
    }
    /// The sum of a node's bonds, one by one, with the range of t.
    #[inline(always)]
    fn fold(&self, node: usize, span: [Start; 2], arithmetic: Arithmetic) -> (Kn::Sum, T, T) {
        let own = self.input.load(node);
        let u = self.u.get(node);
        let mut sum = <Kn::Sum as Record<T>>::zero();
        let (mut low, mut high) = (T::zero(), T::zero());
        let bits = self.cloud.block_bits(self.bits, node / BLOCK);
        for at in self.cloud.walk(span, node % BLOCK, bits) {
            let shape = &self.cloud.shapes[at.shape];
            let far = self.u.block::<1>(at.far);
            let eta = SVector::from_fn(|d, _| far.plane(d)[0]) - u;
            let other = I::lane::<1>(&self.input.block::<1>(at.far), 0);
            let bond = Bond::of_kernel(shape.xi, eta, shape.inverse_square, arithmetic);
            let pair = Pair { constants: self.table.ends(at.shape), volumes: shape.volumes };
            self.kernel.add(&mut sum, &bond, pair, [&own, &other]);
            if Kn::TRACK {
                let t = bond.square_strain();
                high = if t > high { t } else { high };
                low = if t < low { t } else { low };
            }
        }
        (sum, low, high)
    }
}

impl<K> RowTable<K> {
    #[inline(always)]
    fn ends(&self, shape: usize) -> [&K; 2] {
        let own = &self.own[shape];
        [own, self.mate.as_ref().map_or(own, |mate| &mate[shape])]
    }
}

impl<T: Real, const D: usize> Family<T, D> for Cloud<T, D> {
    type PerBond<K: Copy + Send + Sync> = RowTable<K>;
    type Bits = CloudBits;

    fn nodes(&self) -> usize {
        self.points.len()
    }
    fn sites(&self) -> usize {
        self.points.len().next_multiple_of(BLOCK)
    }
    fn site(&self, node: usize) -> usize {
        node
    }
    fn position(&self, node: usize) -> SVector<f64, D> {
        *self.points.position(node)
    }
    fn volume(&self, node: usize) -> f64 {
        self.points.volume(node)
    }
    fn scale(&self, node: usize) -> Scale {
        Scale { horizon: self.horizon(node), unit: self.unit }
    }
    fn unit(&self) -> f64 {
        self.unit
    }
    fn bonds(&self) -> usize {
        self.batches.iter().map(|batch| batch.there.count_ones() as usize).sum::<usize>() / 2
    }
    fn bytes(&self) -> usize {
        self.points.bytes()
            + self.blocks.capacity() * size_of::<Start>()
            + self.batches.capacity() * size_of::<Batch>()
            + self.listed.capacity() * size_of::<u32>()
            + self.kind.capacity() * size_of::<u16>()
            + self.shapes.capacity() * size_of::<BondShape<T, D>>()
            + self.samples.capacity() * size_of::<[u32; 2]>()
            + self.horizons.capacity() * size_of::<f64>()
    }

    fn per_bond<K: Copy + Send + Sync>(
        &self,
        constant: &(dyn Fn(&SVector<f64, D>, Scale) -> K + Sync),
    ) -> RowTable<K> {
        // An end whose horizon the bond exceeds carries no volume; it takes the other end's
        // constants so that no influence function is asked beyond its support.
        let of = |shape: &BondShape<T, D>, nodes: [usize; 2], end: usize| {
            let seen = if shape.volumes[end] > T::zero() { end } else { 1 - end };
            constant(&shape.xi64(), self.scale(nodes[seen]))
        };
        let table = |end: usize| -> Vec<K> {
            if self.samples.is_empty() {
                self.for_every_bond(&|i, bond| of(&self.shapes[bond.shape], [i, bond.far], end))
            } else {
                let shapes = self.shapes.iter().zip(&self.samples);
                shapes.map(|(shape, nodes)| of(shape, nodes.map(|n| n as usize), end)).collect()
            }
        };
        RowTable { own: table(0), mate: (self.horizons.len() > 1).then(|| table(1)) }
    }
    fn per_bond_bytes<K: Copy + Send + Sync>(table: &RowTable<K>) -> usize {
        (table.own.capacity() + table.mate.as_ref().map_or(0, Vec::capacity)) * size_of::<K>()
    }

    fn intact(&self, breakable: &(dyn Fn(usize) -> bool + Sync)) -> CloudBits {
        let able: Vec<bool> = (0..self.nodes()).map(breakable).collect();
        let breaks = |node: usize| able[node] && self.bonds_of(node).any(|bond| able[bond.far]);
        let blocks = (0..self.blocks.len() - 1)
            .into_par_iter()
            .map(|block| (block * BLOCK..self.nodes().min((block + 1) * BLOCK)).any(breaks));
        let (blocks, mut bits) = (blocks.collect::<Vec<bool>>(), self.no_bits());
        self.hold(&mut bits, &|block| blocks[block]);
        bits
    }
    fn bits_bytes(bits: &CloudBits) -> usize {
        4 * bits.begins.capacity() + bits.bytes.capacity() + bits.marks.capacity()
    }
    fn cut(&self, bits: &mut CloudBits, cuts: &(dyn Fn(usize, usize) -> bool + Sync)) -> usize {
        let mut lost = Vec::new();
        let mut blocks = vec![false; self.blocks.len() - 1];
        for node in 0..self.nodes() {
            for bond in self.bonds_with(Some(bits), node) {
                if cuts(node.min(bond.far), node.max(bond.far)) {
                    blocks[node / BLOCK] = true;
                    lost.push((node, bond));
                }
            }
        }
        // At once for all: bits are laid out anew.
        self.hold(bits, &|block| blocks[block]);
        lost.iter().for_each(|(node, bond)| self.lose(bits, *node, bond));
        lost.iter().filter(|(node, bond)| *node < bond.far).count()
    }
    fn isolate(&self, bits: &mut CloudBits, node: usize) -> usize {
        let mut count = 0;
        for bond in self.bonds_of(node) {
            if self.is_intact(Some(bits), node, &bond) {
                count += 1;
                self.lose(bits, node, &bond);
                if let Some(back) = self.find(bond.far, node) {
                    self.lose(bits, bond.far, &back);
                }
            }
        }
        count
    }
    fn marked(&self, bits: &CloudBits, visit: &mut dyn FnMut(usize)) {
        (0..self.nodes()).filter(|&i| bits.marks[i].load(Relaxed) != 0).for_each(visit);
    }
    fn clear_marks(bits: &mut CloudBits) {
        for mark in &mut bits.marks {
            *mark.get_mut() = 0;
        }
    }
    fn copy_bits(bits: &CloudBits) -> CloudBits {
        let marks = bits.marks.iter().map(|x| AtomicU8::new(x.load(Relaxed))).collect();
        CloudBits { begins: bits.begins.clone(), bytes: bits.bytes.clone(), marks }
    }
    fn copy_marks(bits: &mut CloudBits, other: &CloudBits) {
        for (mark, from) in bits.marks.iter_mut().zip(&other.marks) {
            *mark.get_mut() = from.load(Relaxed);
        }
    }
    /// The bits of every block that has some, its number before them.
    fn bits_as_bytes(bits: &CloudBits) -> Vec<u8> {
        let mut bytes = Vec::new();
        for block in 0..bits.begins.len() - 1 {
            let range = bits.range(block);
            if !range.is_empty() {
                bytes.extend_from_slice(&(block as u32).to_le_bytes());
                bytes.extend_from_slice(&bits.bytes[range]);
            }
        }
        bytes
    }
    fn bits_from_bytes(&self, mut bytes: &[u8]) -> Option<CloudBits> {
        let mut blocks = vec![false; self.blocks.len() - 1];
        let (mut kept, mut next) = (Vec::new(), 0);
        while let Some((number, rest)) = bytes.split_first_chunk() {
            let block = u32::from_le_bytes(*number) as usize;
            // Blocks come once, in their order.
            if block < next || block >= blocks.len() {
                return None;
            }
            next = block + 1;
            blocks[block] = true;
            let batches = self.blocks[block + 1].batch - self.blocks[block].batch;
            let (own, rest) = rest.split_at_checked(2 * batches)?;
            kept.extend_from_slice(own);
            bytes = rest;
        }
        let mut bits = self.no_bits();
        self.hold(&mut bits, &|block| blocks[block]);
        let fits = bytes.is_empty()
            && bits.bytes.len() == kept.len()
            && bits.bytes.iter().zip(&kept).all(|(all, kept)| kept & !all == 0);
        if !fits {
            return None;
        }
        bits.bytes = kept;
        // A bond is broken for both of its ends.
        let bits = Some(bits);
        let intact = |node, bond: &_| self.is_intact(bits.as_ref(), node, bond);
        let agree = (0..self.nodes()).into_par_iter().all(|node| {
            self.bonds_of(node).all(|bond| {
                let back = || self.find(bond.far, node);
                intact(node, &bond) || back().is_some_and(|back| !intact(bond.far, &back))
            })
        });
        bits.filter(|_| agree)
    }
    fn neighbours(
        &self,
        node: usize,
        bits: Option<&CloudBits>,
        visit: &mut dyn FnMut(Neighbour<D>),
    ) {
        for bond in self.bonds_of(node) {
            let shape = &self.shapes[bond.shape];
            visit(Neighbour {
                node: bond.far,
                xi: shape.xi64(),
                volume: shape.volumes[0].to_f64(),
                intact: self.is_intact(bits, node, &bond),
            });
        }
    }
    fn members<K: Copy + Send + Sync>(
        &self,
        node: usize,
        table: &RowTable<K>,
        bits: Option<&CloudBits>,
        into: &mut Vec<Member<K, D>>,
    ) {
        into.clear();
        for bond in self.bonds_with(bits, node) {
            let shape = &self.shapes[bond.shape];
            if shape.volumes[0] > T::zero() {
                let volume = shape.volumes[0].to_f64();
                into.push(Member { xi: shape.xi64(), volume, bond: table.own[bond.shape] });
            }
        }
    }

    fn sweep<Kn, I, J>(
        &self,
        kernel: &Kn,
        table: &RowTable<Kn::Const>,
        bits: Option<&CloudBits>,
        visit: Visit,
        u: &Field<T, SVector<T, D>>,
        (input, own): (I, J),
        out: &mut Field<T, Kn::Out>,
    ) -> T
    where
        Kn: BondKernel<T, D>,
        I: Inputs<T, Value = Kn::Node>,
        J: Inputs<T, Value = Kn::Own>,
    {
        let marked = visit == Visit::Marked;
        let job = Job { cloud: self, kernel, table, bits, marked, u, input, own };
        let pieces = (CHUNK, BLOCK);
        sweep_pieces::<T, Kn::Out>(0..self.sites(), pieces, out.planes_mut(), &|sites, out| {
            dispatch(&job, (sites, out))
        })
    }

    fn break_bonds<B, I>(
        &self,
        test: &B,
        table: &RowTable<B::Const>,
        bits: &mut CloudBits,
        u: &Field<T, SVector<T, D>>,
        input: I,
    ) -> Tally
    where
        B: BondTest<T, D>,
        I: Inputs<T, Value = B::Node>,
    {
        let job = TestJob { cloud: self, test, table, u, input };
        let one_block = |block: usize, bytes: &mut [u8], marks: &mut [AtomicU8]| {
            dispatch(&job, (block, bytes, marks))
        };
        let CloudBits { begins, bytes, marks } = bits;
        break_range(&one_block, 0, begins, bytes, marks)
    }
}

/// Everything a block of a test reads.
struct TestJob<'a, T, const D: usize, B: BondTest<T, D>, I>
where
    T: Real,
{
    cloud: &'a Cloud<T, D>,
    test: &'a B,
    table: &'a RowTable<B::Const>,
    u: &'a Field<T, SVector<T, D>>,
    input: I,
}

/// Both rows of a bond evaluate it from its lower to its higher node: the same numbers, so the same
/// verdict, and every task writes its own rows only.
impl<T, const D: usize, B, I> Vectorised<(usize, &mut [u8], &mut [AtomicU8])>
    for TestJob<'_, T, D, B, I>
where
    T: Real,
    B: BondTest<T, D>,
    I: Inputs<T, Value = B::Node>,
{
    type Output = Tally;
    #[inline(always)]
    fn run(
        &self,
        (block, bytes, marks): (usize, &mut [u8], &mut [AtomicU8]),
        fused: bool,
    ) -> Tally {
        let arithmetic = Arithmetic { small: false, fused };
        let mut tally = Tally::default();
        let (begin, spans) = (self.cloud.blocks[block].batch, self.cloud.spans(block));
        for (lane, mark) in marks.iter_mut().enumerate() {
            let node = block * BLOCK + lane;
            let own = (self.input.load(node), self.u.get(node));
            for at in self.cloud.walk(spans[lane], lane, None) {
                let byte = &mut bytes[2 * (at.batch - begin) + at.bit as usize / 8];
                if *byte >> (at.bit % 8) & 1 == 0 {
                    continue;
                }
                let (j, shape) = (at.far, &self.cloud.shapes[at.shape]);
                let other = (self.input.load(j), self.u.get(j));
                let constants = self.table.ends(at.shape);
                let eta = other.1 - own.1;
                let bond = Bond::of_kernel(shape.xi, eta, shape.inverse_square, arithmetic);
                let seen = shape.volumes.map(|v| if v > T::zero() { T::one() } else { T::zero() });
                let index = if node < j {
                    let pair = Pair { constants, volumes: seen };
                    self.test.index(&bond, pair, [&own.0, &other.0])
                } else {
                    let ([a, b], [v, w]) = (constants, seen);
                    let pair = Pair { constants: [b, a], volumes: [w, v] };
                    self.test.index(&bond.reversed(), pair, [&other.0, &own.0])
                };
                tally.worst = tally.worst.max(index.to_f64());
                if index > T::one() {
                    *byte &= !(1 << (at.bit % 8));
                    *mark.get_mut() = 1;
                    tally.broken += usize::from(node < j);
                }
            }
        }
        tally
    }
}

/// Halves the blocks until they are one chunk; their bytes and marks are split along.
fn break_range(
    one_block: &(dyn Fn(usize, &mut [u8], &mut [AtomicU8]) -> Tally + Sync),
    first: usize,
    begins: &[u32],
    bytes: &mut [u8],
    marks: &mut [AtomicU8],
) -> Tally {
    let byte = |block: usize| (begins[block] - begins[0]) as usize;
    if marks.len() > CHUNK {
        let mid = (begins.len() - 1) / 2;
        let (low, high) = bytes.split_at_mut(byte(mid));
        let (low_marks, high_marks) = marks.split_at_mut(mid * BLOCK);
        let (a, b) = rayon::join(
            || break_range(one_block, first, &begins[..=mid], low, low_marks),
            || break_range(one_block, first + mid, &begins[mid..], high, high_marks),
        );
        return a.merge(b);
    }
    marks.chunks_mut(BLOCK).enumerate().fold(Tally::default(), |tally, (block, marks)| {
        let range = byte(block)..byte(block + 1);
        if range.is_empty() {
            return tally;
        }
        tally.merge(one_block(first + block, &mut bytes[range], marks))
    })
}
