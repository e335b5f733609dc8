//! Work in fixed pieces on all threads. What runs in a piece is handed over as a function object, so
//! that the machinery of threads is compiled once and not for every kernel of every material.

use crate::Real;
use crate::family::Tally;
use crate::record::Record;
use rayon::prelude::*;
use std::ops::Range;
use std::sync::{Mutex, PoisonError};

/// Numbers that one task works on where each costs little.
const CHUNK: usize = 8192;

/// Halves a range of sites, at multiples of `grain`, until its pieces have at most `most`, and the
/// planes of `out` along with it; returns the largest of what `work` says of the pieces.
pub(crate) fn sweep_pieces<T: Real, R: Record<T>>(
    sites: Range<usize>,
    (most, grain): (usize, usize),
    out: R::PlanesMut<'_>,
    work: &(dyn Fn(Range<usize>, R::PlanesMut<'_>) -> T + Sync),
) -> T {
    if sites.len() <= most {
        return work(sites, out);
    }
    let mid = (sites.len() / 2).next_multiple_of(grain);
    let (low, high) = R::split(out, mid);
    let (a, b) = (sites.start..sites.start + mid, sites.start + mid..sites.end);
    let (a, b) = rayon::join(
        || sweep_pieces::<T, R>(a, (most, grain), low, work),
        || sweep_pieces::<T, R>(b, (most, grain), high, work),
    );
    if b > a { b } else { a }
}

/// Runs `work` on pieces of `0..len` with `most` members each.
pub(crate) fn for_pieces(len: usize, most: usize, work: &(dyn Fn(Range<usize>) + Sync)) {
    let piece = |c: usize| c * most..len.min((c + 1) * most);
    (0..len.div_ceil(most)).into_par_iter().for_each(|c| work(piece(c)));
}

/// What `work` makes of the pieces of `0..len` with `most` members each, in their order.
pub(crate) fn map_pieces<X: Send>(
    len: usize,
    most: usize,
    work: &(dyn Fn(Range<usize>) -> X + Sync),
) -> impl Iterator<Item = X> + use<X> {
    let made: Vec<Mutex<Option<X>>> = (0..len.div_ceil(most)).map(|_| Mutex::new(None)).collect();
    for_pieces(len, most, &|piece| {
        let slot = &made[piece.start / most];
        let value = work(piece);
        *slot.lock().unwrap_or_else(PoisonError::into_inner) = Some(value);
    });
    made.into_iter().filter_map(|slot| slot.into_inner().unwrap_or_else(PoisonError::into_inner))
}

/// Runs `work` on pieces of `most` bytes, with their number; merges what it tells.
pub(crate) fn break_pieces(
    bytes: &mut [u8],
    most: usize,
    work: &(dyn Fn(usize, &mut [u8]) -> Tally + Sync),
) -> Tally {
    let pieces = bytes.par_chunks_mut(most).enumerate();
    pieces.map(|(piece, bytes)| work(piece, bytes)).reduce(Tally::default, Tally::merge)
}

/// y += a x.
pub(crate) fn axpy<T: Real>(y: &mut [T], a: T, x: &[T]) {
    zip_pieces(y, x, &|y, x| y.iter_mut().zip(x).for_each(|(y, x)| *y += a * *x));
}

/// Runs `work` on pieces of two arrays of the same length.
pub(crate) fn zip_pieces<T: Real>(y: &mut [T], x: &[T], work: &(dyn Fn(&mut [T], &[T]) + Sync)) {
    y.par_chunks_mut(CHUNK).zip(x.par_chunks(CHUNK)).for_each(|(y, x)| work(y, x));
}

/// y += a w x, for planes of as many numbers as there are weights w.
pub(crate) fn axpy_weighted<T: Real>(y: &mut [T], a: T, w: &[T], x: &[T]) {
    for (y, x) in y.chunks_mut(w.len()).zip(x.chunks(w.len())) {
        let parts = y.par_chunks_mut(CHUNK).zip(x.par_chunks(CHUNK));
        parts.zip(w.par_chunks(CHUNK)).for_each(|((y, x), w)| {
            for ((y, x), w) in y.iter_mut().zip(x).zip(w) {
                *y += a * *w * *x;
            }
        });
    }
}

/// Σ g(i) in fixed chunks, so that the sum does not depend on the number of threads.
pub(crate) fn sum_in_order(len: usize, g: impl Fn(usize) -> f64 + Sync) -> f64 {
    map_pieces(len, CHUNK, &|piece| piece.map(&g).sum::<f64>()).sum()
}
