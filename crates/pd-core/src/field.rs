//! Node arrays of records, as planes (structure of arrays).
//!
//! The one place with `unsafe` code: eight consecutive nodes of every plane without bounds checks
//! that could fail. A kernel reads the planes of both ends of a bond at every offset of a lattice.
//! Checking each plane on its own costs more than the arithmetic of a material with many planes
//! (correspondence in 3D: 27 an end), and a check that can panic keeps loads alive that nobody
//! uses. So nodes and planes out of range are moved into it: wrong to ask for, but safe.
#![allow(unsafe_code)]

use crate::Real;
use crate::parallel::sweep_pieces;
use crate::record::Record;
use std::marker::PhantomData;

/// A node array of records: one plane of numbers per scalar of `R`, one after the other.
#[derive(Debug, Clone)]
pub struct Field<T, R> {
    /// Holds exactly `R::LEN · stride` numbers; never resized.
    data: Vec<T>,
    stride: usize,
    record: PhantomData<R>,
}

impl<T: Real, R: Record<T>> Field<T, R> {
    /// `len` zero records. A record of no scalars allocates nothing.
    pub fn zeros(len: usize) -> Self {
        Self { data: vec![T::zero(); R::LEN * len], stride: len, record: PhantomData }
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
        R::load(&self.data, self.len(), i)
    }
    /// Overwrites record `i`.
    #[inline(always)]
    pub fn set(&mut self, i: usize, value: R) {
        value.write(&mut self.planes_mut(), i);
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

/// N consecutive nodes of the planes of a field. Made by [`Inputs::block`] only.
#[derive(Debug, Clone, Copy)]
pub struct Planes<'a, T, const N: usize> {
    /// `count` planes of `stride` numbers.
    data: &'a [T],
    stride: usize,
    /// At most `stride − N`.
    start: usize,
    count: usize,
}

impl<'a, T, const N: usize> Planes<'a, T, N> {
    /// The nodes of plane `plane`, or of the last one if there is no such plane.
    ///
    /// # Panics
    /// If there are no planes.
    #[inline(always)]
    pub fn plane(&self, plane: usize) -> &'a [T; N] {
        assert!(self.count > 0);
        let at = plane.min(self.count - 1) * self.stride + self.start;
        // SAFETY: start + N ≤ stride, so at + N ≤ (count − 1)·stride + stride = data.len(), and
        // nothing overflows as data.len() does not. An array of T has the alignment of T.
        unsafe { &*self.data.as_ptr().add(at).cast::<[T; N]>() }
    }
}

/// What a kernel reads at a node: a field, a pair of inputs, or nothing.
pub trait Inputs<T: Real>: Copy + Send + Sync {
    /// The value at one node.
    type Value: Record<T>;
    /// N consecutive nodes.
    type Block<const N: usize>: Copy;
    /// The nodes `start .. start + N`.
    fn block<const N: usize>(&self, start: usize) -> Self::Block<N>;
    /// Node `lane` of a block.
    fn lane<const N: usize>(block: &Self::Block<N>, lane: usize) -> Self::Value;
    /// Node `i`.
    fn load(&self, i: usize) -> Self::Value;
}

impl<'a, T: Real, R: Record<T>> Inputs<T> for &'a Field<T, R> {
    type Value = R;
    type Block<const N: usize> = Planes<'a, T, N>;
    #[inline(always)]
    fn block<const N: usize>(&self, start: usize) -> Planes<'a, T, N> {
        assert!(self.stride >= N);
        let start = start.min(self.stride - N);
        Planes { data: &self.data, stride: self.stride, start, count: R::LEN }
    }
    #[inline(always)]
    fn lane<const N: usize>(block: &Planes<'a, T, N>, lane: usize) -> R {
        R::lane(block, 0, lane)
    }
    #[inline(always)]
    fn load(&self, i: usize) -> R {
        self.get(i)
    }
}

impl<T: Real> Inputs<T> for () {
    type Value = ();
    type Block<const N: usize> = ();
    #[inline(always)]
    fn block<const N: usize>(&self, _: usize) {}
    #[inline(always)]
    fn lane<const N: usize>((): &(), _: usize) {}
    #[inline(always)]
    fn load(&self, _: usize) {}
}

impl<T: Real, A: Inputs<T>, B: Inputs<T>> Inputs<T> for (A, B) {
    type Value = (A::Value, B::Value);
    type Block<const N: usize> = (A::Block<N>, B::Block<N>);
    #[inline(always)]
    fn block<const N: usize>(&self, start: usize) -> Self::Block<N> {
        (self.0.block::<N>(start), self.1.block::<N>(start))
    }
    #[inline(always)]
    fn lane<const N: usize>(block: &Self::Block<N>, lane: usize) -> Self::Value {
        (A::lane::<N>(&block.0, lane), B::lane::<N>(&block.1, lane))
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
    sweep_pieces::<T, R>(0..out.len(), (MAP_CHUNK, 1), out.planes_mut(), &|sites, mut out| {
        let first = sites.start;
        for site in sites {
            let previous = R::read(&out, site - first);
            f(input.load(site), previous).write(&mut out, site - first);
        }
        T::zero()
    });
}
