//! The one place with `unsafe` code: eight consecutive nodes of every plane of a field behind a
//! single bounds check.
//!
//! A kernel reads the planes of both ends of a bond at every offset of a lattice. Checking each
//! plane on its own costs more than the arithmetic of a material with many planes (positive split
//! in 3D: 43 planes an end). All planes have the same length, so one check of the range serves
//! all of them; the number of the plane is a constant at every use, so its bound folds away.
#![allow(unsafe_code)]

use crate::record::LANES;

/// [`LANES`] consecutive nodes of the planes of a field.
#[derive(Debug, Clone, Copy)]
pub struct Planes<'a, T> {
    /// `count` planes of `stride` numbers, one after the other.
    data: &'a [T],
    stride: usize,
    start: usize,
    count: usize,
}

impl<'a, T> Planes<'a, T> {
    /// The nodes `start .. start + LANES` of `data`, which holds `count` planes of `stride` numbers.
    ///
    /// # Panics
    /// If the nodes are not all there.
    #[inline(always)]
    pub fn new(data: &'a [T], stride: usize, start: usize, count: usize) -> Self {
        assert!(
            count == 0
                || data.len() == count * stride && start <= stride && LANES <= stride - start
        );
        Self { data, stride, start, count }
    }

    /// The nodes of plane `plane`, or of the last one if there is no such plane: a bound that
    /// cannot fail, so that loads nobody uses disappear.
    ///
    /// # Panics
    /// If there are no planes.
    #[inline(always)]
    pub fn plane(&self, plane: usize) -> &'a [T; LANES] {
        assert!(self.count > 0);
        let at = plane.min(self.count - 1) * self.stride + self.start;
        // SAFETY: at + LANES ≤ (count − 1)·stride + stride = data.len() by the assertions here and
        // in `new`, and nothing overflows as data.len() does not. An array of T has the alignment
        // of T.
        unsafe { &*self.data.as_ptr().add(at).cast::<[T; LANES]>() }
    }
}
