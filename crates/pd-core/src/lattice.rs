//! Families on a uniform lattice: one table of offsets serves every node.
//!
//! Sites lie in rows along x; rows and planes are parted by as many empty sites as the horizon
//! reaches, so that one distance leads to a neighbour from every node.
//! The loop takes a register of consecutive sites at a time ([`Real::WIDTH`]) and runs through the
//! offsets inside, so that scalar material code becomes vector code. Where a neighbour is missing
//! (padding, holes, outlines, broken bonds) its lane is masked; blocks with nothing missing skip
//! the masks. A block first takes every bond for a small one ([`Bond::SMALL`]) and is summed again
//! if it met one that is not.

use crate::bond::{Arithmetic, Bond, Member, Scale};
use crate::dispatch::{Vectorised, dispatch};
use crate::family::{BondKernel, BondTest, Family, Horizon, Neighbour, Pair, Tally, Visit};
use crate::field::{Field, Inputs, Planes};
use crate::grid::Grid;
use crate::lanes::{Gathered, close};
use crate::parallel::{break_pieces, sweep_pieces};
use crate::quadrature::Quadrature;
use crate::record::{LANES, Record};
use crate::{Error, Real, Result};
use nalgebra::SVector;
use rayon::prelude::*;
use std::ops::Range;
use std::sync::atomic::{AtomicBool, AtomicU8, Ordering::Relaxed};

/// Blocks that one task works on: fixed, so that nothing depends on the number of threads.
const CHUNK: usize = 64;

/// Bytes after which the first-level cache begins anew, and where in them each next plane begins:
/// a whole number of lines, about (3 − √5)/2 of them, whose multiples are spread evenly.
const PAGE: usize = 4096;
const PLANE_IN_PAGE: usize = 26 * 64;

/// The row of a block that holds no bits, as all its bonds are intact.
const WHOLE: u32 = u32::MAX;
/// The row of zeros of all blocks without nodes.
const EMPTY: u32 = 0;

/// Most sites that a kernel takes together.
const WIDEST: usize = 2 * LANES;
/// Sites before the first node, one block: a neighbour before the arrays is then before every lane of
/// a block, so all of them are masked, and what stands in for it is never used.
const LEAD: usize = WIDEST;

/// One entry of the offset table: what kernels read at every offset of every block.
#[derive(Debug, Clone, Copy)]
struct Offset<T, const D: usize> {
    /// Distance in the node arrays.
    site: isize,
    xi: SVector<T, D>,
    /// 2ξ.
    twice: SVector<T, D>,
    /// 1/|ξ|².
    inverse_square: T,
    /// β V in Δx^D.
    volume: T,
}

/// The same offset for setup and reports.
#[derive(Debug, Clone, Copy)]
struct Step<const D: usize> {
    cell: [isize; D],
    xi: SVector<f64, D>,
    /// β V in Δx^D.
    volume: f64,
}

impl<T: Real, const D: usize> Offset<T, D> {
    #[inline(always)]
    fn bond(&self, eta: SVector<T, D>, arithmetic: Arithmetic) -> Bond<T, D> {
        Bond::of_table((self.xi, self.twice), eta, self.inverse_square, arithmetic)
    }
}

/// A uniform lattice with one offset table (see the module's head).
#[derive(Debug, Clone)]
pub struct Lattice<T, const D: usize> {
    grid: Grid<D>,
    scale: Scale,
    /// Ascending, so the second half points to higher nodes.
    offsets: Vec<Offset<T, D>>,
    /// One for each offset.
    steps: Vec<Step<D>>,
    node_site: Vec<u32>,
    sites: usize,
    strides: [usize; D],
    /// One bit per site: is there a node?
    present: Vec<u8>,
    /// Per block: is every neighbour of every lane there?
    interior: Vec<bool>,
    bonds: usize,
}

/// Where the nodes of a box of cells lie in the arrays.
struct Layout<const D: usize> {
    /// Cells that bonds span along each axis.
    reaches: [usize; D],
    strides: [usize; D],
    sites: usize,
}

/// One bit per undirected bond, those of eight consecutive nodes and one offset in a byte. Blocks
/// whose bonds can all neither break nor are cut hold none.
#[derive(Debug)]
pub struct LatticeBits {
    /// Per block: its row, or [`WHOLE`].
    rows: Vec<u32>,
    /// Per row: its block; of [`EMPTY`] the first one, which has no nodes.
    blocks: Vec<u32>,
    /// `bytes[row * half + h]`, offset `half + h`.
    bytes: Vec<u8>,
    half: usize,
    /// Per block: did one of its nodes lose a bond?
    cut: Vec<AtomicBool>,
    /// Per block: the lanes that lost a bond since the marks were cleared.
    marks: Vec<AtomicU8>,
}

impl<T: Real, const D: usize> Lattice<T, D> {
    /// Families of the active cells of `grid`: all offsets with a positive weight β.
    ///
    /// # Errors
    /// [`Error::InvalidValue`] for a horizon that is not positive or reaches no neighbour, or a
    /// lattice with more sites than 32 bits count.
    pub fn new(grid: &Grid<D>, horizon: Horizon, quadrature: Quadrature) -> Result<Self> {
        let unit = grid.spacing()[0];
        let delta = horizon.in_units(unit)?;
        let cell = grid.spacing() / unit;
        let cell_volume: f64 = cell.iter().product();
        let cells = grid.cells();
        let Layout { reaches, strides, sites } = Self::layout(cells, &cell, delta, quadrature);
        Error::check(
            sites < u32::MAX as usize,
            "number of lattice sites",
            sites as f64,
            "below 2^32; use a coarser lattice",
        )?;

        let (mut offsets, mut steps) = (Vec::new(), Vec::new());
        let span: [usize; D] = reaches.map(|r| 2 * r + 1);
        for index in 0..span.iter().product() {
            let mut rest = index;
            let step: [isize; D] = std::array::from_fn(|d| {
                let i = rest % span[d];
                rest /= span[d];
                i as isize - reaches[d] as isize
            });
            if step.iter().all(|&s| s == 0) {
                continue;
            }
            let xi = SVector::from_fn(|d, _| step[d] as f64 * cell[d]);
            let beta = quadrature.weight(&xi, &cell, delta);
            if beta > 0.0 {
                let volume = beta * cell_volume;
                offsets.push(Offset {
                    site: (0..D).map(|d| step[d] * strides[d] as isize).sum(),
                    xi: xi.map(T::of),
                    twice: (2.0 * xi).map(T::of),
                    inverse_square: T::of(1.0 / xi.norm_squared()),
                    volume: T::of(volume),
                });
                steps.push(Step { cell: step, xi, volume });
            }
        }
        Error::check(
            !offsets.is_empty(),
            "horizon ratio m = δ/Δx",
            delta,
            "large enough to reach a neighbour (m ≥ 1)",
        )?;

        let blocks = sites / LANES;
        let mut lattice = Self {
            grid: grid.clone(),
            scale: Scale { horizon: delta, unit },
            offsets,
            steps,
            node_site: Vec::with_capacity(grid.len()),
            sites,
            strides,
            present: vec![0; blocks + 1],
            interior: Vec::new(),
            bonds: 0,
        };
        for node in 0..grid.len() {
            let site = lattice.site_of_cell(&grid.cell(node));
            lattice.node_site.push(site as u32);
            lattice.present[site / LANES] |= 1 << (site % LANES);
        }
        let half = lattice.half();
        let counts: Vec<(bool, usize)> = (0..blocks)
            .into_par_iter()
            .map(|block| {
                let mask = lattice.present[block];
                if mask == 0 {
                    return (false, 0);
                }
                let there = |o| mask & lattice.present_beyond::<LANES>(block * LANES, o) as u8;
                let bonds = (half..2 * half).map(|o| there(o).count_ones() as usize).sum();
                (mask == 0xff && (0..2 * half).all(|o| there(o) == 0xff), bonds)
            })
            .collect();
        lattice.bonds = counts.iter().map(|c| c.1).sum();
        lattice.interior = counts.into_iter().map(|c| c.0).collect();
        Ok(lattice)
    }

    fn layout(
        cells: [usize; D],
        cell: &SVector<f64, D>,
        delta: f64,
        quadrature: Quadrature,
    ) -> Layout<D> {
        let reach = quadrature.reach(cell, delta);
        let reaches: [usize; D] =
            std::array::from_fn(|d| (reach / cell[d] * (1.0 + 1e-9)).floor() as usize);
        let mut strides = [1; D];
        for d in 1..D {
            let row = strides[d - 1] * (cells[d - 1] + reaches[d - 1]);
            strides[d] = if d == 1 { row.next_multiple_of(T::WIDTH) } else { row };
        }
        let inner: usize = (0..D).map(|d| strides[d] * (cells[d] - 1)).sum::<usize>() + 1;
        // One block behind the last node: a block that starts at any node must be there whole, for it
        // would be read from further on the left otherwise.
        let sites = (LEAD + inner + WIDEST).next_multiple_of(WIDEST);
        // Padded so that the planes of the node arrays begin all over a page: numbers at the same
        // place of many pages, as those of one node would be, push each other out of the cache.
        let page = PAGE / size_of::<T>();
        let sites = sites + (page + PLANE_IN_PAGE / size_of::<T>() - sites % page) % page;
        Layout { reaches, strides, sites }
    }
    /// Number of sites of a lattice over a box of so many cells with equal edges, for δ = `m` Δx:
    /// what its node arrays will hold, before there is one.
    pub fn sites_of(cells: [usize; D], m: f64, quadrature: Quadrature) -> usize {
        Self::layout(cells, &SVector::repeat(1.0), m, quadrature).sites
    }

    /// The grid this lattice was made from.
    pub fn grid(&self) -> &Grid<D> {
        &self.grid
    }
    /// Number of entries of the offset table: neighbours of a node in the bulk.
    pub fn offsets(&self) -> usize {
        self.offsets.len()
    }

    /// The family of a node in the bulk: ξ in units of Δx and βV in Δx^D.
    pub fn stencil(&self) -> impl Iterator<Item = (SVector<f64, D>, f64)> + '_ {
        self.steps.iter().map(|step| (step.xi, step.volume))
    }

    fn half(&self) -> usize {
        self.offsets.len() / 2
    }
    fn site_of_cell(&self, cell: &[usize; D]) -> usize {
        LEAD + (0..D).map(|d| cell[d] * self.strides[d]).sum::<usize>()
    }
    fn cell_of_site(&self, site: usize) -> [usize; D] {
        let mut rest = site - LEAD;
        let mut cell = [0; D];
        for d in (0..D).rev() {
            cell[d] = rest / self.strides[d];
            rest %= self.strides[d];
        }
        cell
    }
    /// On which of the N sites from `start` on there is a node.
    #[inline(always)]
    fn present_from<const N: usize>(&self, start: usize) -> u32 {
        self.window::<N>(|block| self.present.get(block).copied().unwrap_or(0), start)
    }
    /// Beyond which of the N sites from `start` on there is a node along an offset.
    #[inline(always)]
    fn present_beyond<const N: usize>(&self, start: usize, offset: usize) -> u32 {
        self.beyond::<N>(&self.present, start, offset)
    }
    /// The bits of `mask`, one per site, beyond the N sites from `start` on along an offset.
    #[inline(always)]
    fn beyond<const N: usize>(&self, mask: &[u8], start: usize, offset: usize) -> u32 {
        let from = start.wrapping_add_signed(self.offsets[offset].site);
        self.window::<N>(|block| mask.get(block).copied().unwrap_or(0), from)
    }
    fn node_at(&self, cell: [isize; D]) -> Option<usize> {
        let cells = self.grid.cells();
        let inside = (0..D).all(|d| (0..cells[d] as isize).contains(&cell[d]));
        if inside { self.grid.node(cell.map(|c| c as usize)) } else { None }
    }
    /// Where the bit of the bond from `site` along `offset` is: block, half offset and lane.
    #[inline(always)]
    fn bit_of(&self, site: usize, offset: usize) -> (usize, usize, usize) {
        let half = self.half();
        let (owner, h) = if offset >= half {
            (site, offset - half)
        } else {
            (site.wrapping_add_signed(self.offsets[offset].site), half - 1 - offset)
        };
        (owner / LANES, h, owner % LANES)
    }
    /// Clears the bit of a bond and marks its ends; true if it was intact.
    fn lose(&self, bits: &mut LatticeBits, site: usize, offset: usize) -> bool {
        let (block, h, lane) = self.bit_of(site, offset);
        let intact = self.own_byte(bits, block, h) >> lane & 1 == 1;
        if intact {
            let row = self.row_of(bits, block);
            bits.bytes[row * bits.half + h] &= !(1 << lane);
            for s in [site, site.wrapping_add_signed(self.offsets[offset].site)] {
                bits.cut[s / LANES].store(true, Relaxed);
                bits.marks[s / LANES].fetch_or(1 << (s % LANES), Relaxed);
            }
        }
        intact
    }
    /// The row of a block, which gets one if it has none.
    fn row_of(&self, bits: &mut LatticeBits, block: usize) -> usize {
        if bits.rows[block] == WHOLE {
            bits.rows[block] = bits.blocks.len() as u32;
            bits.blocks.push(block as u32);
            bits.bytes.extend((0..bits.half).map(|h| self.whole_byte(block, h)));
        }
        bits.rows[block] as usize
    }
    /// The bonds of a block along the offset `half + h` where all are intact. Not inlined: kernels
    /// read the bits of blocks at cracks, few of which hold none.
    #[inline(never)]
    fn whole_byte(&self, block: usize, h: usize) -> u8 {
        let beyond = self.present_beyond::<LANES>(block * LANES, self.half() + h);
        self.present.get(block).map_or(0, |present| present & beyond as u8)
    }
    #[inline(always)]
    fn own_byte(&self, bits: &LatticeBits, block: usize, h: usize) -> u8 {
        match bits.rows.get(block) {
            Some(&row) if row != WHOLE => bits.bytes[row as usize * bits.half + h],
            _ => self.whole_byte(block, h),
        }
    }
    /// No bits: every bond is intact.
    fn no_bits(&self) -> LatticeBits {
        let (blocks, half) = (self.sites / LANES, self.half());
        let row = |&present: &u8| if present == 0 { EMPTY } else { WHOLE };
        LatticeBits {
            rows: self.present[..blocks].iter().map(row).collect(),
            blocks: vec![0],
            bytes: vec![0; half],
            half,
            cut: (0..blocks).map(|_| AtomicBool::new(false)).collect(),
            marks: (0..blocks).map(|_| AtomicU8::new(0)).collect(),
        }
    }
    /// Which of the N nodes from `start` on have an intact bond along an offset.
    #[inline(always)]
    fn intact_beyond<const N: usize>(
        &self,
        bits: &LatticeBits,
        start: usize,
        offset: usize,
    ) -> u32 {
        let half = bits.half;
        let (h, from) = if offset >= half {
            (offset - half, start)
        } else {
            (half - 1 - offset, start.wrapping_add_signed(self.offsets[offset].site))
        };
        self.window::<N>(|block| self.own_byte(bits, block, h), from)
    }
    /// The bits of N sites from `from` on, where `byte` has those of a block. No node lies before or
    /// behind the arrays.
    #[inline(always)]
    fn window<const N: usize>(&self, byte: impl Fn(usize) -> u8, from: usize) -> u32 {
        // A window that begins before the arrays ends before the first node: see `LEAD`.
        if from >= self.sites {
            return 0;
        }
        let mut word = 0;
        for part in 0..N / LANES + 1 {
            word |= u32::from(byte(from / LANES + part)) << (part * LANES);
        }
        word >> (from % LANES) & ((1 << N) - 1)
    }
}

/// Everything a chunk of a sweep reads.
struct Job<'a, T, const D: usize, Kn: BondKernel<T, D>, I, J>
where
    T: Real,
{
    lattice: &'a Lattice<T, D>,
    kernel: &'a Kn,
    table: &'a [Kn::Const],
    bits: Option<&'a LatticeBits>,
    marked: bool,
    u: &'a Field<T, SVector<T, D>>,
    input: I,
    own: J,
}

#[inline(always)]
fn relative<T: Real, const D: usize, const N: usize>(
    near: &Planes<'_, T, N>,
    far: &Planes<'_, T, N>,
    lane: usize,
) -> SVector<T, D> {
    SVector::from_fn(|d, _| far.plane(d)[lane] - near.plane(d)[lane])
}

/// Adds the bonds along one offset of a block of nodes, where `there` holds if MASKED.
#[inline(always)]
fn add_lanes<'a, T, const D: usize, Kn, I, J, const N: usize, const MASKED: bool>(
    job: &Job<'a, T, D, Kn, I, J>,
    so_far: Gathered<T, Kn::Sum, N>,
    (offset, k): (&Offset<T, D>, &Kn::Const),
    there: u32,
    (start, near, own): (usize, &Planes<'a, T, N>, &I::Block<N>),
    arithmetic: Arithmetic,
) -> Gathered<T, Kn::Sum, N>
where
    T: Real,
    Kn: BondKernel<T, D>,
    I: Inputs<T, Value = Kn::Node>,
    J: Inputs<T, Value = Kn::Own>,
{
    let beyond = start.wrapping_add_signed(offset.site);
    let far: Planes<'_, T, N> = job.u.block(beyond);
    let other = job.input.block::<N>(beyond);
    let pair = Pair { constants: [k, k], volumes: [offset.volume; 2] };
    let mut gathered = Gathered::nothing();
    for l in 0..N {
        let on = !MASKED || there >> l & 1 == 1;
        let eta = relative(near, &far, l);
        let bond = offset.bond(eta, arithmetic);
        let nodes = [I::lane::<N>(own, l), I::lane::<N>(&other, l)];
        gathered.add(&so_far, (l, on), job.kernel, &bond, pair, [&nodes[0], &nodes[1]]);
    }
    gathered
}

/// Adds all bonds of a block of N nodes to zero sums.
#[inline(always)]
fn fold<'a, T, const D: usize, Kn, I, J, const N: usize>(
    job: &Job<'a, T, D, Kn, I, J>,
    full: bool,
    block: (usize, &Planes<'a, T, N>, &I::Block<N>),
    arithmetic: Arithmetic,
) -> Gathered<T, Kn::Sum, N>
where
    T: Real,
    Kn: BondKernel<T, D>,
    I: Inputs<T, Value = Kn::Node>,
    J: Inputs<T, Value = Kn::Own>,
{
    let mut gathered = Gathered::nothing();
    let offsets = job.lattice.offsets.iter().zip(job.table);
    if full {
        for entry in offsets {
            gathered =
                add_lanes::<T, D, Kn, I, J, N, false>(job, gathered, entry, 0, block, arithmetic);
        }
    } else {
        let nodes = job.lattice.present_from::<N>(block.0);
        let bits = job.cut::<N>(block.0);
        for (o, entry) in offsets.enumerate() {
            let there = match bits {
                Some(bits) => job.lattice.intact_beyond::<N>(bits, block.0, o),
                None => job.lattice.present_beyond::<N>(block.0, o),
            };
            let there = nodes & there;
            if there != 0 {
                gathered = add_lanes::<T, D, Kn, I, J, N, true>(
                    job, gathered, entry, there, block, arithmetic,
                );
            }
        }
    }
    gathered
}

impl<T: Real, const D: usize, Kn: BondKernel<T, D>, I, J> Job<'_, T, D, Kn, I, J> {
    /// The bits to look at for the N sites from `start` on: none if they lost no bond.
    #[inline(always)]
    fn cut<const N: usize>(&self, start: usize) -> Option<&LatticeBits> {
        let blocks = start / LANES..(start + N) / LANES;
        self.bits.filter(|bits| bits.cut[blocks].iter().any(|cut| cut.load(Relaxed)))
    }
    /// Whether all neighbours of the N nodes from `start` on are there and intact.
    #[inline(always)]
    fn full<const N: usize>(&self, start: usize) -> bool {
        let mut interior = self.lattice.interior[start / LANES..(start + N) / LANES].iter();
        interior.all(|&interior| interior) && self.cut::<N>(start).is_none()
    }
    /// The nodes among the N sites from `start` on, none if they are not to be visited.
    #[inline(always)]
    fn visited<const N: usize>(&self, start: usize) -> u32 {
        let blocks = start / LANES..(start + N) / LANES;
        if let (true, Some(bits)) = (self.marked, self.bits)
            && blocks.clone().all(|block| bits.marks[block].load(Relaxed) == 0)
        {
            return 0;
        }
        blocks.rev().fold(0, |mask, b| mask << LANES | u32::from(self.lattice.present[b]))
    }
}

/// The blocks of N nodes of a chunk; returns the largest t.
#[inline(always)]
fn sweep_blocks<T, const D: usize, Kn, I, J, const N: usize>(
    job: &Job<'_, T, D, Kn, I, J>,
    sites: Range<usize>,
    mut out: <Kn::Out as Record<T>>::PlanesMut<'_>,
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
    let mut largest = [T::zero(); N];
    for start in sites.step_by(N) {
        let mask = job.visited::<N>(start);
        if mask == 0 {
            continue;
        }
        let near: Planes<'_, T, N> = job.u.block(start);
        let own_block = job.input.block::<N>(start);
        // Only one loop is compiled for processors without fused instructions, which are old.
        let full = fused && job.full::<N>(start);
        let block = (start, &near, &own_block);
        let quick = Arithmetic { small: Kn::STRETCH && fused, fused };
        let mut gathered = fold::<T, D, Kn, I, J, N>(job, full, block, quick);
        if quick.small {
            let mut small = true;
            for l in 0..N {
                small &= (gathered.high[l] <= limit) & (gathered.low[l] >= -limit);
            }
            if !small {
                let exact = Arithmetic { small: false, fused };
                gathered = fold::<T, D, Kn, I, J, N>(job, false, block, exact);
            }
        }
        if Kn::TRACK {
            for l in 0..N {
                let high = gathered.high[l];
                largest[l] = if high > largest[l] { high } else { largest[l] };
            }
        }
        let blocks = (&own_block, &job.own.block::<N>(start));
        close::<T, D, Kn, I, J, N>(
            job.kernel,
            &gathered.sums,
            blocks,
            &mut out,
            (start, first),
            mask,
        );
    }
    largest.into_iter().fold(T::zero(), |a, b| if b > a { b } else { a })
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
        (sites, out): (Range<usize>, <Kn::Out as Record<T>>::PlanesMut<'o>),
        fused: bool,
    ) -> T {
        if T::WIDE {
            sweep_blocks::<T, D, Kn, I, J, WIDEST>(self, sites, out, fused)
        } else {
            sweep_blocks::<T, D, Kn, I, J, LANES>(self, sites, out, fused)
        }
    }
}

/// Everything a chunk of a test reads.
struct TestJob<'a, T, const D: usize, B: BondTest<T, D>, I>
where
    T: Real,
{
    lattice: &'a Lattice<T, D>,
    test: &'a B,
    table: &'a [B::Const],
    u: &'a Field<T, SVector<T, D>>,
    input: I,
    cut: &'a [AtomicBool],
    marks: &'a [AtomicU8],
}

impl<T, const D: usize, B, I> Vectorised<(&[u32], &mut [u8])> for TestJob<'_, T, D, B, I>
where
    T: Real,
    B: BondTest<T, D>,
    I: Inputs<T, Value = B::Node>,
{
    type Output = Tally;
    #[inline(always)]
    fn run(&self, (blocks, bytes): (&[u32], &mut [u8]), fused: bool) -> Tally {
        let arithmetic = Arithmetic { small: false, fused };
        let lattice = self.lattice;
        let half = lattice.half();
        let mut broken = 0;
        let mut worst = [T::zero(); LANES];
        // Kept in memory: the optimiser vectorises towards eight numbers stored side by side.
        let mut index = [T::zero(); LANES];
        let index = std::hint::black_box(&mut index);
        for (&block, bytes) in blocks.iter().zip(bytes.chunks_exact_mut(half)) {
            let block = block as usize;
            let start = block * LANES;
            let near: Planes<'_, T, LANES> = self.u.block(start);
            let own_block = self.input.block::<LANES>(start);
            let owned = lattice.offsets[half..].iter().zip(&self.table[half..]);
            for (byte, (offset, k)) in bytes.iter_mut().zip(owned) {
                if *byte == 0 {
                    continue;
                }
                let beyond = start.wrapping_add_signed(offset.site);
                let far = self.u.block(beyond);
                let other_block = self.input.block::<LANES>(beyond);
                let pair = Pair { constants: [k, k], volumes: [T::one(); 2] };
                // No closure, which may be compiled on its own, without this processor's instructions.
                let mut found = [T::zero(); LANES];
                for l in 0..LANES {
                    let eta = relative(&near, &far, l);
                    let bond = offset.bond(eta, arithmetic);
                    let own = I::lane::<LANES>(&own_block, l);
                    let other = I::lane::<LANES>(&other_block, l);
                    found[l] = self.test.index(&bond, pair, [&own, &other]);
                }
                *index = found;
                if *byte != 0xff {
                    for l in 0..LANES {
                        index[l] = if *byte >> l & 1 == 1 { index[l] } else { T::zero() };
                    }
                }
                let mut fail = false;
                for l in 0..LANES {
                    worst[l] = if index[l] > worst[l] { index[l] } else { worst[l] };
                    fail |= index[l] > T::one();
                }
                if fail {
                    let fails =
                        (0..LANES).fold(0_u8, |f, l| f | u8::from(index[l] > T::one()) << l);
                    *byte &= !fails;
                    broken += fails.count_ones() as usize;
                    self.cut[block].store(true, Relaxed);
                    self.marks[block].fetch_or(fails, Relaxed);
                    for l in (0..LANES).filter(|l| fails >> l & 1 == 1) {
                        let site = beyond + l;
                        self.cut[site / LANES].store(true, Relaxed);
                        self.marks[site / LANES].fetch_or(1 << (site % LANES), Relaxed);
                    }
                }
            }
        }
        let worst = worst.iter().fold(0.0_f64, |w, x| w.max(x.to_f64()));
        Tally { broken, worst }
    }
}

impl<T: Real, const D: usize> Family<T, D> for Lattice<T, D> {
    type PerBond<K: Copy + Send + Sync> = Vec<K>;
    type Bits = LatticeBits;

    fn nodes(&self) -> usize {
        self.grid.len()
    }
    fn sites(&self) -> usize {
        self.sites
    }
    fn site(&self, node: usize) -> usize {
        self.node_site[node] as usize
    }
    fn position(&self, node: usize) -> SVector<f64, D> {
        self.grid.position(node)
    }
    fn volume(&self, _node: usize) -> f64 {
        self.grid.cell_volume()
    }
    fn scale(&self, _node: usize) -> Scale {
        self.scale
    }
    fn unit(&self) -> f64 {
        self.scale.unit
    }
    fn bonds(&self) -> usize {
        self.bonds
    }
    fn bytes(&self) -> usize {
        self.node_site.capacity() * 4
            + self.present.capacity()
            + self.interior.capacity()
            + self.offsets.capacity() * size_of::<Offset<T, D>>()
            + self.steps.capacity() * size_of::<Step<D>>()
            + self.grid.bytes()
    }

    fn per_bond<K: Copy + Send + Sync>(
        &self,
        constant: &(dyn Fn(&SVector<f64, D>, Scale) -> K + Sync),
    ) -> Vec<K> {
        self.steps.iter().map(|step| constant(&step.xi, self.scale)).collect()
    }
    fn per_bond_bytes<K: Copy + Send + Sync>(table: &Vec<K>) -> usize {
        table.capacity() * size_of::<K>()
    }

    fn intact(&self, breakable: &(dyn Fn(usize) -> bool + Sync)) -> LatticeBits {
        let mut bits = self.no_bits();
        let half = bits.half;
        let mut able = vec![0; self.present.len()];
        for (node, &site) in self.node_site.iter().enumerate() {
            able[site as usize / LANES] |= u8::from(breakable(node)) << (site as usize % LANES);
        }
        let breaks = |&block: &usize| {
            let own = able[block];
            own != 0
                && (half..2 * half)
                    .any(|o| own & self.beyond::<LANES>(&able, block * LANES, o) as u8 != 0)
        };
        let found: Vec<usize> = (0..self.sites / LANES).into_par_iter().filter(breaks).collect();
        bits.blocks.reserve_exact(found.len());
        for block in found {
            bits.rows[block] = bits.blocks.len() as u32;
            bits.blocks.push(block as u32);
        }
        bits.bytes = vec![0; bits.blocks.len() * half];
        bits.bytes.par_chunks_mut(half).zip(&bits.blocks).for_each(|(bytes, &block)| {
            for (h, byte) in bytes.iter_mut().enumerate() {
                *byte = self.whole_byte(block as usize, h);
            }
        });
        bits
    }
    fn bits_bytes(bits: &LatticeBits) -> usize {
        let LatticeBits { rows, blocks, bytes, cut, marks, .. } = bits;
        4 * (rows.capacity() + blocks.capacity())
            + bytes.capacity()
            + cut.capacity()
            + marks.capacity()
    }
    fn cut(&self, bits: &mut LatticeBits, cuts: &(dyn Fn(usize, usize) -> bool + Sync)) -> usize {
        let half = self.half();
        let mut count = 0;
        for node in 0..self.nodes() {
            let cell = self.grid.cell(node);
            for o in half..2 * half {
                let step = self.steps[o].cell;
                let to = std::array::from_fn(|d| cell[d] as isize + step[d]);
                if self.node_at(to).is_some_and(|other| cuts(node, other)) {
                    count += usize::from(self.lose(bits, self.site(node), o));
                }
            }
        }
        bits.blocks.shrink_to_fit();
        bits.bytes.shrink_to_fit();
        count
    }
    fn isolate(&self, bits: &mut LatticeBits, node: usize) -> usize {
        let (cell, site) = (self.grid.cell(node), self.site(node));
        let there = |step: &[isize; D]| {
            self.node_at(std::array::from_fn(|d| cell[d] as isize + step[d])).is_some()
        };
        (0..self.offsets.len())
            .filter(|&o| there(&self.steps[o].cell) && self.lose(bits, site, o))
            .count()
    }
    fn marked(&self, bits: &LatticeBits, visit: &mut dyn FnMut(usize)) {
        for (block, mark) in bits.marks.iter().enumerate() {
            let mark = mark.load(Relaxed);
            for lane in (0..LANES).filter(|lane| mark >> lane & 1 == 1) {
                let cell = self.cell_of_site(block * LANES + lane);
                if let Some(node) = self.grid.node(cell) {
                    visit(node);
                }
            }
        }
    }
    fn clear_marks(bits: &mut LatticeBits) {
        for mark in &mut bits.marks {
            *mark.get_mut() = 0;
        }
    }
    fn copy_bits(bits: &LatticeBits) -> LatticeBits {
        let LatticeBits { rows, blocks, bytes, half, cut, marks } = bits;
        LatticeBits {
            rows: rows.clone(),
            blocks: blocks.clone(),
            bytes: bytes.clone(),
            half: *half,
            cut: cut.iter().map(|cut| AtomicBool::new(cut.load(Relaxed))).collect(),
            marks: marks.iter().map(|mark| AtomicU8::new(mark.load(Relaxed))).collect(),
        }
    }
    fn copy_marks(bits: &mut LatticeBits, other: &LatticeBits) {
        for (mark, from) in bits.marks.iter_mut().zip(&other.marks) {
            *mark.get_mut() = from.load(Relaxed);
        }
    }
    /// Every row with its block before it.
    fn bits_as_bytes(bits: &LatticeBits) -> Vec<u8> {
        let mut bytes = Vec::with_capacity(bits.blocks.len() * (size_of::<u32>() + bits.half));
        for (block, row) in bits.blocks.iter().zip(bits.bytes.chunks_exact(bits.half)).skip(1) {
            bytes.extend_from_slice(&block.to_le_bytes());
            bytes.extend_from_slice(row);
        }
        bytes
    }
    fn bits_from_bytes(&self, bytes: &[u8]) -> Option<LatticeBits> {
        let mut bits = self.no_bits();
        let half = bits.half;
        let rows = bytes.chunks_exact(size_of::<u32>() + half);
        if !rows.remainder().is_empty() {
            return None;
        }
        for row in rows {
            let (block, kept) = row.split_first_chunk()?;
            let block = u32::from_le_bytes(*block) as usize;
            if block >= self.sites / LANES || bits.rows[block] != WHOLE {
                return None;
            }
            self.row_of(&mut bits, block);
            for (h, kept) in kept.iter().enumerate() {
                let all = self.whole_byte(block, h);
                if kept & !all != 0 {
                    return None;
                }
                for lane in (0..LANES).filter(|lane| (all & !kept) >> lane & 1 == 1) {
                    self.lose(&mut bits, block * LANES + lane, half + h);
                }
            }
        }
        Self::clear_marks(&mut bits);
        Some(bits)
    }
    fn neighbours(
        &self,
        node: usize,
        bits: Option<&LatticeBits>,
        visit: &mut dyn FnMut(Neighbour<D>),
    ) {
        let (cell, site) = (self.grid.cell(node), self.site(node));
        for (o, step) in self.steps.iter().enumerate() {
            let to = std::array::from_fn(|d| cell[d] as isize + step.cell[d]);
            if let Some(node) = self.node_at(to) {
                let intact = bits.is_none_or(|bits| {
                    let (block, h, lane) = self.bit_of(site, o);
                    self.own_byte(bits, block, h) >> lane & 1 == 1
                });
                visit(Neighbour { node, xi: step.xi, volume: step.volume, intact });
            }
        }
    }
    fn members<K: Copy + Send + Sync>(
        &self,
        node: usize,
        table: &Vec<K>,
        bits: Option<&LatticeBits>,
        into: &mut Vec<Member<K, D>>,
    ) {
        into.clear();
        let (block, lane) = (self.site(node) / LANES, self.site(node) % LANES);
        for (o, (step, &bond)) in self.steps.iter().zip(table).enumerate() {
            let start = block * LANES;
            let there = match bits {
                Some(bits) => self.intact_beyond::<LANES>(bits, start, o),
                None => self.present_beyond::<LANES>(start, o),
            };
            if there >> lane & 1 == 1 {
                into.push(Member { xi: step.xi, volume: step.volume, bond });
            }
        }
    }

    fn sweep<Kn, I, J>(
        &self,
        kernel: &Kn,
        table: &Vec<Kn::Const>,
        bits: Option<&LatticeBits>,
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
        let job = Job { lattice: self, kernel, table, bits, marked, u, input, own };
        let pieces = (CHUNK * LANES, WIDEST);
        sweep_pieces::<T, Kn::Out>(0..self.sites, pieces, out.planes_mut(), &|sites, out| {
            dispatch(&job, (sites, out))
        })
    }

    fn break_bonds<B, I>(
        &self,
        test: &B,
        table: &Vec<B::Const>,
        bits: &mut LatticeBits,
        u: &Field<T, SVector<T, D>>,
        input: I,
    ) -> Tally
    where
        B: BondTest<T, D>,
        I: Inputs<T, Value = B::Node>,
    {
        let (cut, marks) = (&bits.cut[..], &bits.marks[..]);
        let job = TestJob { lattice: self, test, table, u, input, cut, marks };
        let blocks = &bits.blocks[..];
        break_pieces(&mut bits.bytes, CHUNK * bits.half, &|chunk, bytes| {
            dispatch(&job, (&blocks[chunk * CHUNK..], bytes))
        })
    }
}
