//! Fixed-size groups of scalars: what a node carries.
//!
//! A node state may be a scalar, a vector, a matrix, a pair of those or nothing. Stored as one
//! plane per scalar ([`Field`](crate::field::Field)), eight consecutive nodes are eight consecutive
//! numbers, which is what lets plain scalar material code vectorise over nodes.

use crate::Real;
use crate::field::Planes;
use nalgebra::SMatrix;

/// Number of consecutive nodes whose bits share a byte. A lattice kernel handles this many together
/// or, where the scalar is short, twice as many.
pub const LANES: usize = 8;

/// A fixed number of scalars that can be stored as planes: `T`, `()`, vectors, matrices, pairs.
pub trait Record<T: Real>: Copy + Send + Sync + 'static {
    /// Number of scalars.
    const LEN: usize;
    /// One plane per scalar, borrowed for writing.
    type PlanesMut<'a>: Send;
    /// N records as planes, for running sums.
    type Lanes<const N: usize>: Copy;

    /// All scalars zero.
    fn zero() -> Self;
    /// N zero records.
    fn lanes<const N: usize>() -> Self::Lanes<N>;
    /// Record `lane` of a running sum.
    fn get<const N: usize>(lanes: &Self::Lanes<N>, lane: usize) -> Self;
    /// Overwrites record `lane` of a running sum.
    fn put<const N: usize>(self, lanes: &mut Self::Lanes<N>, lane: usize);
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
    fn lane<const N: usize>(block: &Planes<'_, T, N>, first: usize, lane: usize) -> Self;
    /// Node `i` of the planes.
    fn load(data: &[T], stride: usize, i: usize) -> Self;
    /// Node `i` of writable planes.
    fn read(planes: &Self::PlanesMut<'_>, i: usize) -> Self;
    /// Writes node `i`.
    fn write(self, planes: &mut Self::PlanesMut<'_>, i: usize);
    /// Nodes `i .. i + N` of writable planes.
    fn read_lanes<const N: usize>(planes: &Self::PlanesMut<'_>, i: usize) -> Self::Lanes<N>;
    /// Writes those of the nodes `i .. i + N` whose bit of `mask` is set.
    fn write_lanes<const N: usize>(
        lanes: &Self::Lanes<N>,
        planes: &mut Self::PlanesMut<'_>,
        i: usize,
        mask: u32,
    );
}

impl<T: Real> Record<T> for T {
    const LEN: usize = 1;
    type PlanesMut<'a> = &'a mut [T];
    type Lanes<const N: usize> = [T; N];

    #[inline(always)]
    fn zero() -> Self {
        T::zero()
    }
    #[inline(always)]
    fn lanes<const N: usize>() -> [T; N] {
        [T::zero(); N]
    }
    #[inline(always)]
    fn get<const N: usize>(lanes: &[T; N], lane: usize) -> T {
        lanes[lane]
    }
    #[inline(always)]
    fn put<const N: usize>(self, lanes: &mut [T; N], lane: usize) {
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
    fn lane<const N: usize>(block: &Planes<'_, T, N>, first: usize, lane: usize) -> T {
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
    #[inline(always)]
    fn read_lanes<const N: usize>(planes: &&mut [T], i: usize) -> [T; N] {
        let slots = &planes[i..i + N];
        let mut lanes = [T::zero(); N];
        lanes.copy_from_slice(slots);
        lanes
    }
    #[inline(always)]
    fn write_lanes<const N: usize>(lanes: &[T; N], planes: &mut &mut [T], i: usize, mask: u32) {
        let slots = &mut planes[i..i + N];
        for l in 0..N {
            slots[l] = if mask >> l & 1 == 1 { lanes[l] } else { slots[l] };
        }
    }
}

impl<T: Real> Record<T> for () {
    const LEN: usize = 0;
    type PlanesMut<'a> = ();
    type Lanes<const N: usize> = ();

    #[inline(always)]
    fn zero() -> Self {}
    #[inline(always)]
    fn lanes<const N: usize>() {}
    #[inline(always)]
    fn get<const N: usize>((): &(), _: usize) {}
    #[inline(always)]
    fn put<const N: usize>(self, (): &mut (), _: usize) {}
    #[inline(always)]
    fn select(_: bool, (): (), (): ()) {}
    #[inline(always)]
    fn planes_mut(_: &mut [T], _: usize) -> Self::PlanesMut<'_> {}
    #[inline(always)]
    fn split<'a>(_: Self::PlanesMut<'a>, _: usize) -> (Self::PlanesMut<'a>, Self::PlanesMut<'a>) {
        ((), ())
    }
    #[inline(always)]
    fn lane<const N: usize>(_: &Planes<'_, T, N>, _: usize, _: usize) -> Self {}
    #[inline(always)]
    fn load(_: &[T], _: usize, _: usize) -> Self {}
    #[inline(always)]
    fn read((): &(), _: usize) -> Self {}
    #[inline(always)]
    fn write(self, (): &mut (), _: usize) {}
    #[inline(always)]
    fn read_lanes<const N: usize>((): &(), _: usize) {}
    #[inline(always)]
    fn write_lanes<const N: usize>((): &(), (): &mut (), _: usize, _: u32) {}
}

/// The matrix of the entries `entry(row, column)`. Always inlined: of large matrices
/// [`from_fn`](nalgebra::Matrix::from_fn) is not, and a call keeps a loop over nodes from being
/// vectorised. For small ones that is what vectorises best.
#[inline(always)]
fn matrix<T: Real, const R: usize, const C: usize>(
    entry: impl Fn(usize, usize) -> T,
) -> SMatrix<T, R, C> {
    let mut matrix = SMatrix::<T, R, C>::zeros();
    for c in 0..C {
        for r in 0..R {
            matrix[(r, c)] = entry(r, c);
        }
    }
    matrix
}

impl<T: Real, const R: usize, const C: usize> Record<T> for SMatrix<T, R, C> {
    const LEN: usize = R * C;
    type PlanesMut<'a> = [[&'a mut [T]; R]; C];
    type Lanes<const N: usize> = [[[T; N]; R]; C];

    #[inline(always)]
    fn zero() -> Self {
        Self::zeros()
    }
    #[inline(always)]
    fn lanes<const N: usize>() -> Self::Lanes<N> {
        [[[T::zero(); N]; R]; C]
    }
    #[inline(always)]
    fn get<const N: usize>(lanes: &Self::Lanes<N>, lane: usize) -> Self {
        Self::from_fn(|r, c| lanes[c][r][lane])
    }
    #[inline(always)]
    fn put<const N: usize>(self, lanes: &mut Self::Lanes<N>, lane: usize) {
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
    fn lane<const N: usize>(block: &Planes<'_, T, N>, first: usize, lane: usize) -> Self {
        let entry = |r, c| block.plane(first + c * R + r)[lane];
        if R * C > 9 { matrix(entry) } else { Self::from_fn(entry) }
    }
    #[inline(always)]
    fn load(data: &[T], stride: usize, i: usize) -> Self {
        matrix(|r, c| data[(c * R + r) * stride + i])
    }
    #[inline(always)]
    fn read(planes: &Self::PlanesMut<'_>, i: usize) -> Self {
        matrix(|r, c| planes[c][r][i])
    }
    #[inline(always)]
    fn write(self, planes: &mut Self::PlanesMut<'_>, i: usize) {
        for (column, values) in planes.iter_mut().zip(self.column_iter()) {
            for (plane, value) in column.iter_mut().zip(values.iter()) {
                plane[i] = *value;
            }
        }
    }
    #[inline(always)]
    fn read_lanes<const N: usize>(planes: &Self::PlanesMut<'_>, i: usize) -> Self::Lanes<N> {
        let mut lanes = Self::lanes::<N>();
        for c in 0..C {
            for r in 0..R {
                lanes[c][r] = T::read_lanes::<N>(&planes[c][r], i);
            }
        }
        lanes
    }
    #[inline(always)]
    fn write_lanes<const N: usize>(
        lanes: &Self::Lanes<N>,
        planes: &mut Self::PlanesMut<'_>,
        i: usize,
        mask: u32,
    ) {
        for c in 0..C {
            for r in 0..R {
                T::write_lanes::<N>(&lanes[c][r], &mut planes[c][r], i, mask);
            }
        }
    }
}

impl<T: Real, A: Record<T>, B: Record<T>> Record<T> for (A, B) {
    const LEN: usize = A::LEN + B::LEN;
    type PlanesMut<'a> = (A::PlanesMut<'a>, B::PlanesMut<'a>);
    type Lanes<const N: usize> = (A::Lanes<N>, B::Lanes<N>);

    #[inline(always)]
    fn zero() -> Self {
        (A::zero(), B::zero())
    }
    #[inline(always)]
    fn lanes<const N: usize>() -> Self::Lanes<N> {
        (A::lanes::<N>(), B::lanes::<N>())
    }
    #[inline(always)]
    fn get<const N: usize>(lanes: &Self::Lanes<N>, lane: usize) -> Self {
        (A::get::<N>(&lanes.0, lane), B::get::<N>(&lanes.1, lane))
    }
    #[inline(always)]
    fn put<const N: usize>(self, lanes: &mut Self::Lanes<N>, lane: usize) {
        self.0.put::<N>(&mut lanes.0, lane);
        self.1.put::<N>(&mut lanes.1, lane);
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
    fn lane<const N: usize>(block: &Planes<'_, T, N>, first: usize, lane: usize) -> Self {
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
    #[inline(always)]
    fn read_lanes<const N: usize>(planes: &Self::PlanesMut<'_>, i: usize) -> Self::Lanes<N> {
        (A::read_lanes::<N>(&planes.0, i), B::read_lanes::<N>(&planes.1, i))
    }
    #[inline(always)]
    fn write_lanes<const N: usize>(
        lanes: &Self::Lanes<N>,
        planes: &mut Self::PlanesMut<'_>,
        i: usize,
        mask: u32,
    ) {
        A::write_lanes::<N>(&lanes.0, &mut planes.0, i, mask);
        B::write_lanes::<N>(&lanes.1, &mut planes.1, i, mask);
    }
}
