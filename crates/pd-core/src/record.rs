//! Fixed-size groups of scalars, and node arrays of them as planes (structure of arrays).
//!
//! A node state may be a scalar, a vector, a matrix, a pair of those or nothing. Stored as one
//! plane per scalar, eight consecutive nodes are eight consecutive numbers, which is what lets
//! plain scalar material code vectorise over nodes.

use crate::Real;
use crate::planes::Planes;
use nalgebra::SMatrix;

/// Number of consecutive nodes that a lattice kernel handles together.
pub const LANES: usize = 8;

/// A fixed number of scalars that can be stored as planes: `T`, `()`, vectors, matrices, pairs.
pub trait Record<T: Real>: Copy + Send + Sync + 'static {
    /// Number of scalars.
    const LEN: usize;
    /// One plane per scalar, borrowed for writing.
    type PlanesMut<'a>: Send;
    /// [`LANES`] records as planes, for running sums.
    type Lanes: Copy;

    /// All scalars zero.
    fn zero() -> Self;
    /// [`LANES`] zero records.
    fn lanes() -> Self::Lanes;
    /// Record `lane` of a running sum.
    fn get(lanes: &Self::Lanes, lane: usize) -> Self;
    /// Overwrites record `lane` of a running sum.
    fn put(self, lanes: &mut Self::Lanes, lane: usize);
    /// `a` where `on`, else `b`: a blend, not a branch.
    fn select(on: bool, a: Self, b: Self) -> Self;
    /// Splits `data` (planes of length `stride`, one after the other) into planes.
    fn planes_mut(data: &mut [T], stride: usize) -> Self::PlanesMut<'_>;
    /// Splits every plane at `mid`.
    fn split<'a>(
        planes: Self::PlanesMut<'a>,
        mid: usize,
    ) -> (Self::PlanesMut<'a>, Self::PlanesMut<'a>);
    /// Node `lane` of a block whose planes from `first` on hold this record.
    fn lane(block: &Planes<'_, T>, first: usize, lane: usize) -> Self;
    /// Node `i` of the planes.
    fn load(data: &[T], stride: usize, i: usize) -> Self;
    /// Node `i` of writable planes.
    fn read(planes: &Self::PlanesMut<'_>, i: usize) -> Self;
    /// Writes node `i`.
    fn write(self, planes: &mut Self::PlanesMut<'_>, i: usize);
}

impl<T: Real> Record<T> for T {
    const LEN: usize = 1;
    type PlanesMut<'a> = &'a mut [T];
    type Lanes = [T; LANES];

    #[inline(always)]
    fn zero() -> Self {
        T::zero()
    }
    #[inline(always)]
    fn lanes() -> [T; LANES] {
        [T::zero(); LANES]
    }
    #[inline(always)]
    fn get(lanes: &[T; LANES], lane: usize) -> T {
        lanes[lane]
    }
    #[inline(always)]
    fn put(self, lanes: &mut [T; LANES], lane: usize) {
        lanes[lane] = self;
    }
    #[inline(always)]
    fn select(on: bool, a: T, b: T) -> T {
        if on { a } else { b }
    }
    #[inline(always)]
    fn planes_mut(data: &mut [T], stride: usize) -> &mut [T] {
        &mut data[..stride]
    }
    #[inline(always)]
    fn split<'a>(
        planes: Self::PlanesMut<'a>,
        mid: usize,
    ) -> (Self::PlanesMut<'a>, Self::PlanesMut<'a>) {
        planes.split_at_mut(mid)
    }
    #[inline(always)]
    fn lane(block: &Planes<'_, T>, first: usize, lane: usize) -> T {
        block.plane(first)[lane]
    }
    #[inline(always)]
    fn load(data: &[T], _stride: usize, i: usize) -> T {
        data[i]
    }
    #[inline(always)]
    fn read(planes: &&mut [T], i: usize) -> T {
        planes[i]
    }
    #[inline(always)]
    fn write(self, planes: &mut &mut [T], i: usize) {
        planes[i] = self;
    }
}

impl<T: Real> Record<T> for () {
    const LEN: usize = 0;
    type PlanesMut<'a> = ();
    type Lanes = ();

    #[inline(always)]
    fn zero() -> Self {}
    #[inline(always)]
    fn lanes() {}
    #[inline(always)]
    fn get((): &(), _: usize) {}
    #[inline(always)]
    fn put(self, (): &mut (), _: usize) {}
    #[inline(always)]
    fn select(_: bool, (): (), (): ()) {}
    #[inline(always)]
    fn planes_mut(_: &mut [T], _: usize) -> Self::PlanesMut<'_> {}
    #[inline(always)]
    fn split<'a>(_: Self::PlanesMut<'a>, _: usize) -> (Self::PlanesMut<'a>, Self::PlanesMut<'a>) {
        ((), ())
    }
    #[inline(always)]
    fn lane(_: &Planes<'_, T>, _: usize, _: usize) -> Self {}
    #[inline(always)]
    fn load(_: &[T], _: usize, _: usize) -> Self {}
    #[inline(always)]
    fn read((): &(), _: usize) -> Self {}
    #[inline(always)]
    fn write(self, (): &mut (), _: usize) {}
}

impl<T: Real, const R: usize, const C: usize> Record<T> for SMatrix<T, R, C> {
    const LEN: usize = R * C;
    type PlanesMut<'a> = [[&'a mut [T]; R]; C];
    type Lanes = [[[T; LANES]; R]; C];

    #[inline(always)]
    fn zero() -> Self {
        Self::zeros()
    }
    #[inline(always)]
    fn lanes() -> Self::Lanes {
        [[[T::zero(); LANES]; R]; C]
    }
    #[inline(always)]
    fn get(lanes: &Self::Lanes, lane: usize) -> Self {
        Self::from_fn(|r, c| lanes[c][r][lane])
    }
    #[inline(always)]
    fn put(self, lanes: &mut Self::Lanes, lane: usize) {
        for c in 0..C {
            for r in 0..R {
                lanes[c][r][lane] = self[(r, c)];
            }
        }
    }
    #[inline(always)]
    fn select(on: bool, a: Self, b: Self) -> Self {
        Self::from_fn(|r, c| if on { a[(r, c)] } else { b[(r, c)] })
    }
    #[inline(always)]
    fn planes_mut(data: &mut [T], stride: usize) -> Self::PlanesMut<'_> {
        let mut rest = data;
        std::array::from_fn(|_| {
            std::array::from_fn(|_| {
                let (plane, tail) = std::mem::take(&mut rest).split_at_mut(stride);
                rest = tail;
                plane
            })
        })
    }
    #[inline(always)]
    fn split<'a>(
        planes: Self::PlanesMut<'a>,
        mid: usize,
    ) -> (Self::PlanesMut<'a>, Self::PlanesMut<'a>) {
        let mut high = std::array::from_fn(|_| std::array::from_fn(|_| Default::default()));
        let mut columns = high.iter_mut();
        let low = planes.map(|column| {
            let mut rows = columns.next().into_iter().flatten();
            column.map(|plane| {
                let (low, tail) = plane.split_at_mut(mid);
                if let Some(slot) = rows.next() {
                    *slot = tail;
                }
                low
            })
        });
        (low, high)
    }
    #[inline(always)]
    fn lane(block: &Planes<'_, T>, first: usize, lane: usize) -> Self {
        Self::from_fn(|r, c| block.plane(first + c * R + r)[lane])
    }
    #[inline(always)]
    fn load(data: &[T], stride: usize, i: usize) -> Self {
        Self::from_fn(|r, c| data[(c * R + r) * stride + i])
    }
    #[inline(always)]
    fn read(planes: &Self::PlanesMut<'_>, i: usize) -> Self {
        Self::from_fn(|r, c| planes[c][r][i])
    }
    #[inline(always)]
    fn write(self, planes: &mut Self::PlanesMut<'_>, i: usize) {
        for (column, values) in planes.iter_mut().zip(self.column_iter()) {
            for (plane, value) in column.iter_mut().zip(values.iter()) {
                plane[i] = *value;
            }
        }
    }
}

impl<T: Real, A: Record<T>, B: Record<T>> Record<T> for (A, B) {
    const LEN: usize = A::LEN + B::LEN;
    type PlanesMut<'a> = (A::PlanesMut<'a>, B::PlanesMut<'a>);
    type Lanes = (A::Lanes, B::Lanes);

    #[inline(always)]
    fn zero() -> Self {
        (A::zero(), B::zero())
    }
    #[inline(always)]
    fn lanes() -> Self::Lanes {
        (A::lanes(), B::lanes())
    }
    #[inline(always)]
    fn get(lanes: &Self::Lanes, lane: usize) -> Self {
        (A::get(&lanes.0, lane), B::get(&lanes.1, lane))
    }
    #[inline(always)]
    fn put(self, lanes: &mut Self::Lanes, lane: usize) {
        self.0.put(&mut lanes.0, lane);
        self.1.put(&mut lanes.1, lane);
    }
    #[inline(always)]
    fn select(on: bool, a: Self, b: Self) -> Self {
        (A::select(on, a.0, b.0), B::select(on, a.1, b.1))
    }
    #[inline(always)]
    fn planes_mut(data: &mut [T], stride: usize) -> Self::PlanesMut<'_> {
        let (a, b) = data.split_at_mut(A::LEN * stride);
        (A::planes_mut(a, stride), B::planes_mut(b, stride))
    }
    #[inline(always)]
    fn split<'a>(
        planes: Self::PlanesMut<'a>,
        mid: usize,
    ) -> (Self::PlanesMut<'a>, Self::PlanesMut<'a>) {
        let (a, b) = planes;
        let ((a0, a1), (b0, b1)) = (A::split(a, mid), B::split(b, mid));
        ((a0, b0), (a1, b1))
    }
    #[inline(always)]
    fn lane(block: &Planes<'_, T>, first: usize, lane: usize) -> Self {
        (A::lane(block, first, lane), B::lane(block, first + A::LEN, lane))
    }
    #[inline(always)]
    fn load(data: &[T], stride: usize, i: usize) -> Self {
        let (a, b) = data.split_at(A::LEN * stride);
        (A::load(a, stride, i), B::load(b, stride, i))
    }
    #[inline(always)]
    fn read(planes: &Self::PlanesMut<'_>, i: usize) -> Self {
        (A::read(&planes.0, i), B::read(&planes.1, i))
    }
    #[inline(always)]
    fn write(self, planes: &mut Self::PlanesMut<'_>, i: usize) {
        self.0.write(&mut planes.0, i);
        self.1.write(&mut planes.1, i);
    }
}

/// A node array of records: planes of `stride` numbers, one plane per scalar of `R`.
#[derive(Debug, Clone)]
pub struct Field<T, R> {
    data: Vec<T>,
    stride: usize,
    record: std::marker::PhantomData<R>,
}

impl<T: Real, R: Record<T>> Field<T, R> {
    /// `len` zero records. A record of no scalars allocates nothing.
    pub fn zeros(len: usize) -> Self {
        Self { data: vec![T::zero(); R::LEN * len], stride: len, record: std::marker::PhantomData }
    }
    /// Number of records.
    pub fn len(&self) -> usize {
        self.stride
    }
    /// True for a field of no records.
    pub fn is_empty(&self) -> bool {
        self.stride == 0
    }
    /// Record `i`.
    #[inline(always)]
    pub fn get(&self, i: usize) -> R {
        R::load(&self.data, self.stride, i)
    }
    /// Overwrites record `i`.
    #[inline(always)]
    pub fn set(&mut self, i: usize, value: R) {
        value.write(&mut R::planes_mut(&mut self.data, self.stride), i);
    }
    /// All scalars, plane after plane.
    pub fn as_slice(&self) -> &[T] {
        &self.data
    }
    /// All scalars, plane after plane.
    pub fn as_mut_slice(&mut self) -> &mut [T] {
        &mut self.data
    }
    /// Bytes held.
    pub fn bytes(&self) -> usize {
        self.data.capacity() * size_of::<T>()
    }
    /// Writable planes.
    pub(crate) fn planes_mut(&mut self) -> R::PlanesMut<'_> {
        R::planes_mut(&mut self.data, self.stride)
    }
}

/// What a kernel reads at a node: a field, a pair of inputs, or nothing.
pub trait Inputs<T: Real>: Copy + Send + Sync {
    /// The value at one node.
    type Value: Copy;
    /// [`LANES`] consecutive nodes.
    type Block: Copy;
    /// The nodes `start .. start + LANES`.
    fn block(&self, start: usize) -> Self::Block;
    /// Node `lane` of a block.
    fn lane(block: &Self::Block, lane: usize) -> Self::Value;
    /// Node `i`.
    fn load(&self, i: usize) -> Self::Value;
}

impl<'a, T: Real, R: Record<T>> Inputs<T> for &'a Field<T, R> {
    type Value = R;
    type Block = Planes<'a, T>;
    #[inline(always)]
    fn block(&self, start: usize) -> Planes<'a, T> {
        Planes::new(&self.data, self.stride, start, R::LEN)
    }
    #[inline(always)]
    fn lane(block: &Planes<'a, T>, lane: usize) -> R {
        R::lane(block, 0, lane)
    }
    #[inline(always)]
    fn load(&self, i: usize) -> R {
        self.get(i)
    }
}

impl<T: Real> Inputs<T> for () {
    type Value = ();
    type Block = ();
    #[inline(always)]
    fn block(&self, _: usize) {}
    #[inline(always)]
    fn lane((): &(), _: usize) {}
    #[inline(always)]
    fn load(&self, _: usize) {}
}

impl<T: Real, A: Inputs<T>, B: Inputs<T>> Inputs<T> for (A, B) {
    type Value = (A::Value, B::Value);
    type Block = (A::Block, B::Block);
    #[inline(always)]
    fn block(&self, start: usize) -> Self::Block {
        (self.0.block(start), self.1.block(start))
    }
    #[inline(always)]
    fn lane(block: &Self::Block, lane: usize) -> Self::Value {
        (A::lane(&block.0, lane), B::lane(&block.1, lane))
    }
    #[inline(always)]
    fn load(&self, i: usize) -> Self::Value {
        (self.0.load(i), self.1.load(i))
    }
}

/// Sites that one task of [`map_sites`] works on.
const MAP_CHUNK: usize = 4096;

/// `out[i] = f(input[i], out[i])` at every site, in parallel.
pub(crate) fn map_sites<T: Real, I: Inputs<T>, R: Record<T>>(
    input: I,
    out: &mut Field<T, R>,
    f: impl Fn(I::Value, R) -> R + Sync,
) {
    fn range<T: Real, I: Inputs<T>, R: Record<T>>(
        input: I,
        sites: std::ops::Range<usize>,
        mut out: R::PlanesMut<'_>,
        f: &(impl Fn(I::Value, R) -> R + Sync),
    ) {
        if sites.len() > MAP_CHUNK {
            let mid = sites.len() / 2;
            let (low, high) = R::split(out, mid);
            let (a, b) = (sites.start..sites.start + mid, sites.start + mid..sites.end);
            rayon::join(|| range(input, a, low, f), || range(input, b, high, f));
        } else {
            let first = sites.start;
            for site in sites {
                let previous = R::read(&out, site - first);
                f(input.load(site), previous).write(&mut out, site - first);
            }
        }
    }
    let len = out.len();
    range(input, 0..len, out.planes_mut(), &f);
}
