//! Families of a point cloud: compressed rows of neighbours, one horizon or one per node.
//!
//! With one horizon per node the row of node i lists H_i ∪ H'_i, the family and the dual family
//! (Zhao, dual horizon): f_i = Σ_{H_i} T_i V_j − Σ_{H'_i} T_j V_j. β V is 0 where a neighbour is
//! in one of the two only.

use crate::bond::{Bond, Member, Scale};
use crate::family::{BondKernel, BondTest, Family, Horizon, Neighbour, Pair, Tally, Visit};
use crate::field::{Field, Inputs};
use crate::points::Points;
use crate::quadrature::Quadrature;
use crate::record::Record;
use crate::search::neighbours;
use crate::{Error, Real, Result};
use nalgebra::SVector;
use rayon::prelude::*;
use std::ops::Range;
use std::sync::atomic::{AtomicU8, Ordering::Relaxed};

/// Nodes that one task works on: fixed, so that nothing depends on the number of threads.
const CHUNK: usize = 256;

/// A neighbour within rounding of a whole number of units away is that number away, so that a
/// lattice given as points has exactly the bonds of the lattice.
const SNAP: f64 = 8.0 * f64::EPSILON;

#[derive(Debug, Clone, Copy)]
struct Entry<T, const D: usize> {
    xi: SVector<T, D>,
    /// β_ij V_j and β_ji V_j: what weighs T_i and T_j in the force density of node i.
    volumes: [T; 2],
    neighbour: u32,
}

/// Families of a point cloud (see the module's head).
#[derive(Debug, Clone)]
pub struct Cloud<T, const D: usize> {
    points: Points<D>,
    unit: f64,
    /// One entry, or one per node.
    horizons: Vec<f64>,
    quadrature: Quadrature,
    start: Vec<usize>,
    entries: Vec<Entry<T, D>>,
}

/// Constants per directed bond: as the row's node sees it and, with one horizon per node, as its
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
    let whole = x.round();
    if (x - whole).abs() <= SNAP * size.max(1.0) { whole } else { x }
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
            entries: Vec::new(),
        };
        let scaled: Vec<SVector<f64, D>> = (0..n).map(|i| points.position(i) / unit).collect();
        let rows = neighbours(&scaled, |i| {
            cloud.quadrature.reach(&cloud.cell(i), cloud.horizon(i)).max(cloud.horizon(i))
        });
        // Coordinates carry the rounding of the whole cloud's extent, not of their own size.
        let extent = scaled.iter().map(SVector::amax).fold(0.0, f64::max);
        let xi = |i: usize, j: usize| (scaled[j] - scaled[i]).map(|x| snapped(x, extent));
        let beta = |i: usize, j: usize, xi: &SVector<f64, D>| {
            cloud.quadrature.weight(xi, &cloud.cell(j), cloud.horizon(i))
        };
        let lists: Vec<Vec<Entry<T, D>>> = (0..n)
            .into_par_iter()
            .map(|i| {
                let mut row = Vec::new();
                for &j in &rows.neighbour[rows.start[i]..rows.start[i + 1]] {
                    let xi = xi(i, j as usize);
                    let j = j as usize;
                    let volume = cloud.unit_volume(j);
                    let volumes = [beta(i, j, &xi) * volume, beta(j, i, &-xi) * volume];
                    if volumes[0] > 0.0 || volumes[1] > 0.0 {
                        let (xi, volumes) = (xi.map(T::of), volumes.map(T::of));
                        row.push(Entry { xi, volumes, neighbour: j as u32 });
                    }
                }
                row
            })
            .collect();
        let mut start = Vec::with_capacity(n + 1);
        start.push(0);
        let mut total = 0;
        for list in &lists {
            total += list.len();
            start.push(total);
        }
        cloud.entries = Vec::with_capacity(total);
        lists.iter().for_each(|list| cloud.entries.extend_from_slice(list));
        cloud.start = start;
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
    /// Edges of the cube that stands for a node's cell.
    fn cell(&self, node: usize) -> SVector<f64, D> {
        let volume = self.unit_volume(node);
        let edge = if volume == 1.0 { 1.0 } else { volume.powf(1.0 / D as f64) };
        SVector::repeat(edge)
    }
    fn row(&self, node: usize) -> &[Entry<T, D>] {
        &self.entries[self.start[node]..self.start[node + 1]]
    }
    fn xi64(entry: &Entry<T, D>) -> SVector<f64, D> {
        entry.xi.map(Real::to_f64)
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

fn sweep_range<T, const D: usize, Kn, I, J>(
    job: &Job<'_, T, D, Kn, I, J>,
    nodes: Range<usize>,
    mut out: <Kn::Out as Record<T>>::PlanesMut<'_>,
) where
    T: Real,
    Kn: BondKernel<T, D>,
    I: Inputs<T, Value = Kn::Node>,
    J: Inputs<T, Value = Kn::Own>,
{
    if nodes.len() > CHUNK {
        let mid = nodes.len() / 2;
        let (low, high) = <Kn::Out as Record<T>>::split(out, mid);
        let (a, b) = (nodes.start..nodes.start + mid, nodes.start + mid..nodes.end);
        rayon::join(|| sweep_range(job, a, low), || sweep_range(job, b, high));
        return;
    }
    let first = nodes.start;
    for node in nodes {
        if job.marked && job.bits.is_some_and(|b| b.marks[node].load(Relaxed) == 0) {
            continue;
        }
        let own = job.input.load(node);
        let u = job.u.get(node);
        let mut sum = <Kn::Sum as Record<T>>::zero();
        let begin = job.cloud.start[node];
        for (at, entry) in job.cloud.row(node).iter().enumerate() {
            if job.bits.is_some_and(|bits| !bits.intact(node, at)) {
                continue;
            }
            let j = entry.neighbour as usize;
            let bond = Bond { xi: entry.xi, eta: job.u.get(j) - u };
            let pair = Pair { constants: job.table.ends(begin + at), volumes: entry.volumes };
            job.kernel.add(&mut sum, &bond, pair, [&own, &job.input.load(j)]);
        }
        let previous = <Kn::Out as Record<T>>::read(&out, node - first);
        job.kernel.close(&sum, &own, &job.own.load(node), previous).write(&mut out, node - first);
    }
}

impl<K> RowTable<K> {
    #[inline(always)]
    fn ends(&self, at: usize) -> [&K; 2] {
        let own = &self.own[at];
        [own, self.mate.as_ref().map_or(own, |mate| &mate[at])]
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
        self.entries.len() / 2
    }
    fn bytes(&self) -> usize {
        self.points.bytes()
            + self.start.capacity() * size_of::<usize>()
            + self.entries.capacity() * size_of::<Entry<T, D>>()
            + self.horizons.capacity() * size_of::<f64>()
    }

    fn per_bond<K: Copy + Send + Sync>(
        &self,
        constant: &(dyn Fn(&SVector<f64, D>, Scale) -> K + Sync),
    ) -> RowTable<K> {
        // An end whose horizon the bond exceeds carries no volume; it takes the other end's
        // constants so that no influence function is asked beyond its support.
        let table = |end: usize| -> Vec<K> {
            (0..self.nodes())
                .into_par_iter()
                .flat_map_iter(|node| {
                    self.row(node).iter().map(move |entry| {
                        let ends = [node, entry.neighbour as usize];
                        let seen = if entry.volumes[end] > T::zero() { end } else { 1 - end };
                        constant(&Self::xi64(entry), self.scale(ends[seen]))
                    })
                })
                .collect()
        };
        RowTable { own: table(0), mate: (self.horizons.len() > 1).then(|| table(1)) }
    }
    fn per_bond_bytes<K: Copy + Send + Sync>(table: &RowTable<K>) -> usize {
        (table.own.capacity() + table.mate.as_ref().map_or(0, Vec::capacity)) * size_of::<K>()
    }

    fn intact(&self) -> CloudBits {
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
            for (at, entry) in self.row(node).iter().enumerate() {
                let other = entry.neighbour as usize;
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
        for (at, entry) in self.row(node).iter().enumerate() {
            let other = entry.neighbour as usize;
            let back = self.row(other).binary_search_by_key(&(node as u32), |e| e.neighbour);
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
    fn neighbours(
        &self,
        node: usize,
        bits: Option<&CloudBits>,
        visit: &mut dyn FnMut(Neighbour<D>),
    ) {
        for (at, entry) in self.row(node).iter().enumerate() {
            visit(Neighbour {
                node: entry.neighbour as usize,
                xi: Self::xi64(entry),
                volume: entry.volumes[0].to_f64(),
                intact: bits.is_none_or(|bits| bits.intact(node, at)),
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
        let own = &table.own[self.start[node]..self.start[node + 1]];
        for (at, (entry, &bond)) in self.row(node).iter().zip(own).enumerate() {
            let intact = bits.is_none_or(|bits| bits.intact(node, at));
            if intact && entry.volumes[0] > T::zero() {
                let volume = entry.volumes[0].to_f64();
                into.push(Member { xi: Self::xi64(entry), volume, bond });
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
    ) where
        Kn: BondKernel<T, D>,
        I: Inputs<T, Value = Kn::Node>,
        J: Inputs<T, Value = Kn::Own>,
    {
        let marked = visit == Visit::Marked;
        let job = Job { cloud: self, kernel, table, bits, marked, u, input, own };
        sweep_range(&job, 0..self.nodes(), out.planes_mut());
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
        let one_node = |node: usize, bytes: &mut [u8], mark: &mut AtomicU8| {
            let mut tally = Tally::default();
            let own = (input.load(node), u.get(node));
            let begin = self.start[node];
            for (at, entry) in self.row(node).iter().enumerate() {
                let byte = &mut bytes[at / 8];
                if *byte >> (at % 8) & 1 == 0 {
                    continue;
                }
                let j = entry.neighbour as usize;
                let other = (input.load(j), u.get(j));
                let constants = table.ends(begin + at);
                let bond = Bond { xi: entry.xi, eta: other.1 - own.1 };
                let seen = entry.volumes.map(|v| if v > T::zero() { T::one() } else { T::zero() });
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

/// Halves the rows until they are one chunk; their bytes and marks are split along.
fn break_range(
    one_node: &(impl Fn(usize, &mut [u8], &mut AtomicU8) -> Tally + Sync),
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
