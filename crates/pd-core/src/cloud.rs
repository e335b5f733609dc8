//! Families of a point cloud: compressed rows of neighbours, one horizon or one per node.
//!
//! With one horizon per node the row of node i lists H_i ∪ H'_i, the family and the dual family
//! (Zhao, dual horizon): f_i = Σ_{H_i} T_i V_j − Σ_{H'_i} T_j V_j. β V is 0 where a neighbour is
//! in one of the two only.

use crate::bond::{Arithmetic, Bond, Member, Scale};
use crate::family::{BondKernel, BondTest, Family, Horizon, Neighbour, Pair, Tally, Visit};
use crate::field::{Field, Inputs};
use crate::parallel::{map_pieces, sweep_pieces};
use crate::points::Points;
use crate::quadrature::Quadrature;
use crate::record::Record;
use crate::search::neighbours;
use crate::{Error, Real, Result};
use multiversion::multiversion;
use multiversion::target::target_cfg_f;
use nalgebra::SVector;
use rayon::prelude::*;
use std::ops::Range;
use std::sync::atomic::{AtomicU8, Ordering::Relaxed};

/// Nodes that one task works on: fixed, so that nothing depends on the number of threads.
const CHUNK: usize = 1024;

/// A neighbour within rounding of a whole number of units away is that number away, so that a
/// lattice given as points has exactly the bonds of the lattice.
const SNAP: f64 = 8.0 * f64::EPSILON;

/// What a bond is besides its nodes. Bonds of the same shape share one where there are few: in a
/// cloud that is a lattice, or lattices of a few spacings, a bond costs six bytes.
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
    quadrature: Quadrature,
    /// Row i is `neighbour[start[i]..start[i + 1]]`, ascending.
    start: Vec<usize>,
    neighbour: Vec<u32>,
    /// The shape of every bond; empty if every bond has its own.
    kind: Vec<u16>,
    shapes: Vec<BondShape<T, D>>,
    /// Nodes of one bond of each shape; empty if every bond has its own.
    samples: Vec<[u32; 2]>,
}

/// Constants per shape of a bond: as the row's node sees it and, with one horizon per node, as its
/// neighbour does.
#[derive(Debug, Clone)]
pub struct RowTable<K> {
    own: Vec<K>,
    mate: Option<Vec<K>>,
}

/// One bit per directed bond, every row starting a byte.
#[derive(Debug)]
pub struct CloudBits {
    bytes: Vec<u8>,
    row: Vec<usize>,
    marks: Vec<AtomicU8>,
}

impl CloudBits {
    #[inline(always)]
    fn intact(&self, node: usize, at: usize) -> bool {
        self.bytes[self.row[node] + at / 8] >> (at % 8) & 1 == 1
    }
    fn lose(&mut self, node: usize, at: usize) {
        self.bytes[self.row[node] + at / 8] &= !(1 << (at % 8));
        *self.marks[node].get_mut() = 1;
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
            quadrature,
            start: Vec::new(),
            neighbour: Vec::new(),
            kind: Vec::new(),
            shapes: Vec::new(),
            samples: Vec::new(),
        };
        let scaled: Vec<SVector<f64, D>> = (0..n).map(|i| points.position(i) / unit).collect();
        // Asked for at every bond, computed once per node.
        let volumes: Vec<f64> = (0..n).map(|i| cloud.unit_volume(i)).collect();
        let cells: Vec<SVector<f64, D>> = volumes.iter().map(|&v| cell(v)).collect();
        let rows = neighbours(&scaled, |i| {
            cloud.quadrature.reach(&cells[i], cloud.horizon(i)).max(cloud.horizon(i))
        });
        // Coordinates carry the rounding of the whole cloud's extent, not of their own size.
        let extent = scaled.iter().map(SVector::amax).fold(0.0, f64::max);
        let xi = |i: usize, j: usize| (scaled[j] - scaled[i]).map(|x| snapped(x, extent));
        let beta = |i: usize, j: usize, xi: &SVector<f64, D>| {
            cloud.quadrature.weight(xi, &cells[j], cloud.horizon(i))
        };
        let shape = |i: usize, j: usize| {
            let xi = xi(i, j);
            let own = beta(i, j, &xi);
            // Both ends see a bond alike if their cells and horizons are the same.
            let alike = volumes[i] == volumes[j] && cloud.horizon(i) == cloud.horizon(j);
            let mate = if alike { own } else { beta(j, i, &-xi) };
            BondShape {
                xi: xi.map(T::of),
                inverse_square: T::of(1.0 / xi.norm_squared()),
                volumes: [own * volumes[j], mate * volumes[j]].map(T::of),
                horizons: [cloud.horizon(i), cloud.horizon(j)].map(T::of),
            }
        };
        let chunks: Vec<Bundle<T, D>> = (0..n.div_ceil(CHUNK))
            .into_par_iter()
            .map(|chunk| {
                let mut bundle = Bundle::default();
                for i in chunk * CHUNK..n.min((chunk + 1) * CHUNK) {
                    bundle.add_row(i, rows.row(i), |j| shape(i, j));
                }
                bundle
            })
            .collect();
        drop(rows);
        let mut start = Vec::with_capacity(n + 1);
        start.push(0);
        let total = chunks.iter().map(|c| c.neighbour.len()).sum();
        let (mut neighbour, mut kind) = (Vec::with_capacity(total), Vec::with_capacity(total));
        let mut kinds = Kinds::default();
        for chunk in &chunks {
            let mut known = start.last().copied().unwrap_or(0);
            for count in &chunk.counts {
                known += *count as usize;
                start.push(known);
            }
            neighbour.extend_from_slice(&chunk.neighbour);
            let samples = chunk.kinds.shapes.iter().zip(&chunk.kinds.samples);
            let global: Vec<u16> = samples.map(|(s, nodes)| kinds.find(s, *nodes)).collect();
            kinds.full |= chunk.kinds.full;
            if !kinds.full {
                kind.extend(chunk.kind.iter().map(|&k| global[usize::from(k)]));
            }
        }
        if kinds.full {
            // Too many shapes to share.
            let row = |i: usize| neighbour[start[i]..start[i + 1]].par_iter().with_min_len(256);
            let own = (0..n).into_par_iter().flat_map(|i| row(i).map(move |&j| (i, j as usize)));
            let shapes = own.map(|(i, j)| shape(i, j)).collect();
            (cloud.shapes, kind) = (shapes, Vec::new());
        } else {
            (cloud.shapes, cloud.samples) = (kinds.shapes, kinds.samples);
        }
        cloud.shapes.shrink_to_fit();
        cloud.samples.shrink_to_fit();
        kind.shrink_to_fit();
        (cloud.start, cloud.neighbour, cloud.kind) = (start, neighbour, kind);
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
    /// Neighbours of a node, ascending.
    fn row(&self, node: usize) -> &[u32] {
        &self.neighbour[self.start[node]..self.start[node + 1]]
    }
    /// Where the shape of bond `at` is.
    #[inline(always)]
    fn shape(&self, at: usize) -> usize {
        if self.kind.is_empty() { at } else { usize::from(self.kind[at]) }
    }
    /// Neighbours and shapes of the bonds of a node, with their places.
    fn bonds_of(&self, node: usize) -> impl Iterator<Item = (usize, usize, &BondShape<T, D>)> {
        (self.start[node]..self.start[node + 1])
            .map(|at| (at, self.neighbour[at] as usize, &self.shapes[self.shape(at)]))
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

/// Rows of some consecutive nodes, before they are put together.
struct Bundle<T, const D: usize> {
    counts: Vec<u32>,
    neighbour: Vec<u32>,
    kind: Vec<u16>,
    kinds: Kinds<T, D>,
}

impl<T: Real, const D: usize> Default for Bundle<T, D> {
    fn default() -> Self {
        Self {
            counts: Vec::new(),
            neighbour: Vec::new(),
            kind: Vec::new(),
            kinds: Kinds::default(),
        }
    }
}

impl<T: Real, const D: usize> Bundle<T, D> {
    fn add_row(&mut self, node: usize, row: &[u32], shape: impl Fn(usize) -> BondShape<T, D>) {
        let before = self.neighbour.len();
        for &j in row {
            let shape = shape(j as usize);
            if shape.volumes.iter().any(|v| *v > T::zero()) {
                self.neighbour.push(j);
                if !self.kinds.full {
                    self.kind.push(self.kinds.find(&shape, [node as u32, j]));
                }
            }
        }
        self.counts.push((self.neighbour.len() - before) as u32);
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

// Tests and debug builds compile one version less: each costs a third of their time.
#[cfg_attr(
    not(debug_assertions),
    multiversion(targets(
        "x86_64+avx512f+avx512bw+avx512cd+avx512dq+avx512vl+fma",
        "x86_64+avx2+fma"
    ))
)]
#[cfg_attr(debug_assertions, multiversion(targets("x86_64+avx2+fma")))]
fn sweep_chunk<T, const D: usize, Kn, I, J>(
    job: &Job<'_, T, D, Kn, I, J>,
    nodes: Range<usize>,
    mut out: <Kn::Out as Record<T>>::PlanesMut<'_>,
) -> T
where
    T: Real,
    Kn: BondKernel<T, D>,
    I: Inputs<T, Value = Kn::Node>,
    J: Inputs<T, Value = Kn::Own>,
{
    let fused = cfg!(target_arch = "aarch64") || target_cfg_f!(target_feature = "fma");
    let limit = T::of(Bond::<T, D>::SMALL);
    let first = nodes.start;
    let mut largest = T::zero();
    for node in nodes {
        if job.marked && job.bits.is_some_and(|b| b.marks[node].load(Relaxed) == 0) {
            continue;
        }
        // Taken for small bonds first, like the blocks of a lattice.
        let small = Arithmetic { small: Kn::STRETCH, fused };
        let (mut sum, low, mut high) = job.fold(node, small);
        if Kn::STRETCH && !(low >= -limit && high <= limit) {
            (sum, _, high) = job.fold(node, Arithmetic { small: false, fused });
        }
        largest = if high > largest { high } else { largest };
        let previous = <Kn::Out as Record<T>>::read(&out, node - first);
        let (own, constants) = (job.input.load(node), job.own.load(node));
        job.kernel.close(&sum, &own, &constants, previous).write(&mut out, node - first);
    }
    largest
}

impl<T, const D: usize, Kn, I, J> Job<'_, T, D, Kn, I, J>
where
    T: Real,
    Kn: BondKernel<T, D>,
    I: Inputs<T, Value = Kn::Node>,
    J: Inputs<T, Value = Kn::Own>,
{
    /// The sum of a node's bonds, with the range of t.
    #[inline(always)]
    fn fold(&self, node: usize, arithmetic: Arithmetic) -> (Kn::Sum, T, T) {
        let own = self.input.load(node);
        let u = self.u.get(node);
        let mut sum = <Kn::Sum as Record<T>>::zero();
        let (mut low, mut high) = (T::zero(), T::zero());
        let begin = self.cloud.start[node];
        for (at, &j) in self.cloud.row(node).iter().enumerate() {
            if self.bits.is_some_and(|bits| !bits.intact(node, at)) {
                continue;
            }
            let place = self.cloud.shape(begin + at);
            let shape = &self.cloud.shapes[place];
            // A block of one node: no bounds to check for each of its planes.
            let far = self.u.block::<1>(j as usize);
            let eta = SVector::from_fn(|d, _| far.plane(d)[0]) - u;
            let other = I::lane::<1>(&self.input.block::<1>(j as usize), 0);
            let bond = Bond::of_kernel(shape.xi, eta, shape.inverse_square, arithmetic);
            let pair = Pair { constants: self.table.ends(place), volumes: shape.volumes };
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
        self.points.len()
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
        self.neighbour.len() / 2
    }
    fn bytes(&self) -> usize {
        self.points.bytes()
            + self.start.capacity() * size_of::<usize>()
            + self.neighbour.capacity() * size_of::<u32>()
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
            if self.kind.is_empty() {
                let bonds = |i| self.bonds_of(i).map(move |(_, j, shape)| of(shape, [i, j], end));
                let rows = |nodes: Range<usize>| nodes.flat_map(bonds).collect::<Vec<K>>();
                map_pieces(self.nodes(), CHUNK, &rows).flatten().collect()
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

    fn intact(&self, _breakable: &(dyn Fn(usize) -> bool + Sync)) -> CloudBits {
        let mut row = Vec::with_capacity(self.nodes() + 1);
        let mut total = 0;
        for node in 0..self.nodes() {
            row.push(total);
            total += self.row(node).len().div_ceil(8);
        }
        row.push(total);
        let marks = (0..self.nodes()).map(|_| AtomicU8::new(0)).collect();
        CloudBits { bytes: vec![0xff; total], row, marks }
    }
    fn bits_bytes(bits: &CloudBits) -> usize {
        bits.bytes.capacity() + bits.row.capacity() * size_of::<usize>() + bits.marks.capacity()
    }
    fn cut(&self, bits: &mut CloudBits, cuts: &(dyn Fn(usize, usize) -> bool + Sync)) -> usize {
        let mut count = 0;
        for node in 0..self.nodes() {
            for (at, &other) in self.row(node).iter().enumerate() {
                let other = other as usize;
                if bits.intact(node, at) && cuts(node.min(other), node.max(other)) {
                    bits.lose(node, at);
                    count += usize::from(node < other);
                }
            }
        }
        count
    }
    fn isolate(&self, bits: &mut CloudBits, node: usize) -> usize {
        let mut count = 0;
        for (at, &other) in self.row(node).iter().enumerate() {
            let other = other as usize;
            let back = self.row(other).binary_search(&(node as u32));
            if bits.intact(node, at) {
                count += 1;
                bits.lose(node, at);
                back.iter().for_each(|&back| bits.lose(other, back));
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
        let CloudBits { bytes, row, marks } = bits;
        let marks = marks.iter().map(|x| AtomicU8::new(x.load(Relaxed))).collect();
        CloudBits { bytes: bytes.clone(), row: row.clone(), marks }
    }
    fn copy_marks(bits: &mut CloudBits, other: &CloudBits) {
        for (mark, from) in bits.marks.iter_mut().zip(&other.marks) {
            *mark.get_mut() = from.load(Relaxed);
        }
    }
    fn bits_as_bytes(bits: &CloudBits) -> Vec<u8> {
        bits.bytes.clone()
    }
    fn bits_from_bytes(&self, bytes: &[u8]) -> Option<CloudBits> {
        let mut bits = self.intact(&|_| true);
        if bits.bytes.len() != bytes.len() {
            return None;
        }
        bits.bytes.copy_from_slice(bytes);
        // A bond is broken for both of its ends.
        let agree = (0..self.nodes()).into_par_iter().all(|node| {
            self.row(node).iter().enumerate().all(|(at, &other)| {
                let back = self.row(other as usize).binary_search(&(node as u32));
                back.is_ok_and(|back| bits.intact(other as usize, back) == bits.intact(node, at))
            })
        });
        agree.then_some(bits)
    }
    fn neighbours(
        &self,
        node: usize,
        bits: Option<&CloudBits>,
        visit: &mut dyn FnMut(Neighbour<D>),
    ) {
        for (at, other, shape) in self.bonds_of(node) {
            visit(Neighbour {
                node: other,
                xi: shape.xi64(),
                volume: shape.volumes[0].to_f64(),
                intact: bits.is_none_or(|bits| bits.intact(node, at - self.start[node])),
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
        for (at, _, shape) in self.bonds_of(node) {
            let intact = bits.is_none_or(|bits| bits.intact(node, at - self.start[node]));
            if intact && shape.volumes[0] > T::zero() {
                let volume = shape.volumes[0].to_f64();
                into.push(Member { xi: shape.xi64(), volume, bond: table.own[self.shape(at)] });
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
        sweep_pieces::<T, Kn::Out>(0..self.nodes(), (CHUNK, 1), out.planes_mut(), &|nodes, out| {
            sweep_chunk(&job, nodes, out)
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
        // Both rows of a bond evaluate it from its lower to its higher node: the same numbers,
        // so the same verdict, and every task writes its own rows only.
        let arithmetic = Arithmetic { small: false, fused: fuses() };
        let one_node = |node: usize, bytes: &mut [u8], mark: &mut AtomicU8| {
            let mut tally = Tally::default();
            let own = (input.load(node), u.get(node));
            let begin = self.start[node];
            for (at, j, shape) in self.bonds_of(node) {
                let (at, place) = (at - begin, self.shape(at));
                let byte = &mut bytes[at / 8];
                if *byte >> (at % 8) & 1 == 0 {
                    continue;
                }
                let other = (input.load(j), u.get(j));
                let constants = table.ends(place);
                let eta = other.1 - own.1;
                let bond = Bond::of_kernel(shape.xi, eta, shape.inverse_square, arithmetic);
                let seen = shape.volumes.map(|v| if v > T::zero() { T::one() } else { T::zero() });
                let index = if node < j {
                    let pair = Pair { constants, volumes: seen };
                    test.index(&bond, pair, [&own.0, &other.0])
                } else {
                    let ([a, b], [v, w]) = (constants, seen);
                    let pair = Pair { constants: [b, a], volumes: [w, v] };
                    test.index(&bond.reversed(), pair, [&other.0, &own.0])
                };
                tally.worst = tally.worst.max(index.to_f64());
                if index > T::one() {
                    *byte &= !(1 << (at % 8));
                    *mark.get_mut() = 1;
                    tally.broken += usize::from(node < j);
                }
            }
            tally
        };
        let CloudBits { bytes, row, marks } = bits;
        break_range(&one_node, 0, row, bytes, marks)
    }
}

#[cfg_attr(
    not(debug_assertions),
    multiversion(targets(
        "x86_64+avx512f+avx512bw+avx512cd+avx512dq+avx512vl+fma",
        "x86_64+avx2+fma"
    ))
)]
#[cfg_attr(debug_assertions, multiversion(targets("x86_64+avx2+fma")))]
fn fuses() -> bool {
    cfg!(target_arch = "aarch64") || target_cfg_f!(target_feature = "fma")
}

/// Halves the rows until they are one chunk; their bytes and marks are split along.
fn break_range(
    one_node: &(dyn Fn(usize, &mut [u8], &mut AtomicU8) -> Tally + Sync),
    first: usize,
    row: &[usize],
    bytes: &mut [u8],
    marks: &mut [AtomicU8],
) -> Tally {
    if marks.len() > CHUNK {
        let mid = marks.len() / 2;
        let (low, high) = bytes.split_at_mut(row[mid] - row[0]);
        let (low_marks, high_marks) = marks.split_at_mut(mid);
        let (a, b) = rayon::join(
            || break_range(one_node, first, &row[..=mid], low, low_marks),
            || break_range(one_node, first + mid, &row[mid..], high, high_marks),
        );
        return a.merge(b);
    }
    marks.iter_mut().enumerate().fold(Tally::default(), |tally, (n, mark)| {
        let range = row[n] - row[0]..row[n + 1] - row[0];
        tally.merge(one_node(first + n, &mut bytes[range], mark))
    })
}
