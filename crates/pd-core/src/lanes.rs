//! N nodes at once, a lane each: what the loops of lattices and clouds do with a bond at every lane, and
//! with the sums of the lanes at their end.

use crate::Real;
use crate::bond::Bond;
use crate::family::{BondKernel, Pair};
use crate::field::Inputs;
use crate::record::Record;

/// What N nodes gather: the sums of a kernel, the least and the largest t. Passed by value, for sums
/// behind a reference are not kept in registers while nodes go through their bonds.
pub(crate) struct Gathered<T, S: Record<T>, const N: usize>
where
    T: Real,
{
    pub sums: S::Lanes<N>,
    pub low: [T; N],
    pub high: [T; N],
}

impl<T: Real, S: Record<T>, const N: usize> Clone for Gathered<T, S, N> {
    #[inline(always)]
    fn clone(&self) -> Self {
        *self
    }
}
impl<T: Real, S: Record<T>, const N: usize> Copy for Gathered<T, S, N> {}

impl<T: Real, S: Record<T>, const N: usize> Gathered<T, S, N> {
    #[inline(always)]
    pub fn nothing() -> Self {
        let zeros = [T::zero(); N];
        Self { sums: S::lanes::<N>(), low: zeros, high: zeros }
    }
    /// Makes `lane` that of `before` with a bond added, if `on`.
    #[inline(always)]
    pub fn add<const D: usize, Kn: BondKernel<T, D, Sum = S>>(
        &mut self,
        before: &Self,
        (lane, on): (usize, bool),
        kernel: &Kn,
        bond: &Bond<T, D>,
        pair: Pair<'_, T, Kn::Const>,
        nodes: [&Kn::Node; 2],
    ) {
        let old = S::get::<N>(&before.sums, lane);
        let mut sum = old;
        kernel.add(&mut sum, bond, pair, nodes);
        S::select(on, sum, old).put::<N>(&mut self.sums, lane);
        if Kn::TRACK {
            let (t, low, high) = (bond.square_strain(), before.low[lane], before.high[lane]);
            self.high[lane] = if on & (t > high) { t } else { high };
            if Kn::STRETCH {
                self.low[lane] = if on & (t < low) { t } else { low };
            }
        }
    }
}

/// Turns the sums of the nodes from `start` on into results; writes those whose bit of `mask` is set to
/// `out`, which begins at the node `first`.
#[inline(always)]
pub(crate) fn close<T, const D: usize, Kn, I, J, const N: usize>(
    kernel: &Kn,
    sums: &<Kn::Sum as Record<T>>::Lanes<N>,
    (nodes, owns): (&I::Block<N>, &J::Block<N>),
    out: &mut <Kn::Out as Record<T>>::PlanesMut<'_>,
    (start, first): (usize, usize),
    mask: u32,
) where
    T: Real,
    Kn: BondKernel<T, D>,
    I: Inputs<T, Value = Kn::Node>,
    J: Inputs<T, Value = Kn::Own>,
{
    // A copy, so that the sums themselves are only read as whole vectors and stay in registers.
    let mut finished = <Kn::Sum as Record<T>>::lanes::<N>();
    for l in 0..N {
        <Kn::Sum as Record<T>>::get::<N>(sums, l).put::<N>(&mut finished, l);
    }
    let before = <Kn::Out as Record<T>>::read_lanes::<N>(out, start - first);
    let mut closed = <Kn::Out as Record<T>>::lanes::<N>();
    for l in 0..N {
        let previous = <Kn::Out as Record<T>>::get::<N>(&before, l);
        let sum = <Kn::Sum as Record<T>>::get::<N>(&finished, l);
        let (node, own) = (I::lane::<N>(nodes, l), J::lane::<N>(owns, l));
        kernel.close(&sum, &node, &own, previous).put::<N>(&mut closed, l);
    }
    <Kn::Out as Record<T>>::write_lanes::<N>(&closed, out, start - first, mask);
}
