//! stub
use nalgebra::SVector;
pub trait CrackSurface<const D: usize>: Send + Sync { fn cuts(&self, a: &SVector<f64, D>, b: &SVector<f64, D>) -> bool; }
pub fn check_clear<const D: usize>(_: &dyn CrackSurface<D>, _: impl Iterator<Item = SVector<f64, D>>, _: f64) -> crate::Result<()> { Ok(()) }
