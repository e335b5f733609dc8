//! Loops compiled for several instruction sets, of which the processor's best is taken at run time, so
//! that users need no compiler flags.
//!
//! Own code because the libraries for it do not serve here: `multiversion` withholds AVX-512 from
//! processors before Ice Lake, on which these loops are faster with it too, and `pulp` brings in a
//! crate that nobody maintains.
#![allow(unsafe_code)]

/// A loop over a piece of the work.
pub trait Vectorised<Piece> {
    /// What it finds.
    type Output;
    /// Goes through `piece`; `fused` says, as a constant, that a · b + c is one instruction. To be
    /// `#[inline(always)]` with all it calls, and without closures around arithmetic: what is not
    /// inlined is compiled for the oldest processors, where a fused multiply-add is a call.
    fn run(&self, piece: Piece, fused: bool) -> Self::Output;
}

/// Runs `work` with the best instructions of this processor.
#[inline]
pub fn dispatch<Piece, W: Vectorised<Piece>>(work: &W, piece: Piece) -> W::Output {
    #[cfg(target_arch = "x86_64")]
    {
        #[target_feature(enable = "avx512f,avx512bw,avx512cd,avx512dq,avx512vl,avx2,fma")]
        fn avx512<Piece, W: Vectorised<Piece>>(work: &W, piece: Piece) -> W::Output {
            work.run(piece, true)
        }
        #[target_feature(enable = "avx2,fma")]
        fn avx2<Piece, W: Vectorised<Piece>>(work: &W, piece: Piece) -> W::Output {
            work.run(piece, true)
        }
        // Tests and debug builds compile one version less: each costs a third of their time.
        if cfg!(not(debug_assertions)) && has_avx512() {
            // SAFETY: the processor has these instructions.
            return unsafe { avx512(work, piece) };
        }
        if has_avx2() {
            // SAFETY: the processor has these instructions.
            return unsafe { avx2(work, piece) };
        }
    }
    work.run(piece, cfg!(target_arch = "aarch64"))
}

#[cfg(target_arch = "x86_64")]
fn has_avx2() -> bool {
    is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma")
}

#[cfg(target_arch = "x86_64")]
fn has_avx512() -> bool {
    has_avx2()
        && is_x86_feature_detected!("avx512f")
        && is_x86_feature_detected!("avx512bw")
        && is_x86_feature_detected!("avx512cd")
        && is_x86_feature_detected!("avx512dq")
        && is_x86_feature_detected!("avx512vl")
}
