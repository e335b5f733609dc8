//! stub
use nalgebra::SVector;
#[derive(Debug, Clone)]
pub struct Points<const D: usize> { p: Vec<SVector<f64, D>>, v: Vec<f64>, s: f64 }
impl<const D: usize> Points<D> {
    pub fn new(p: Vec<SVector<f64, D>>, v: Vec<f64>, s: f64) -> Self { Self { p, v, s } }
    pub fn len(&self) -> usize { self.p.len() }
    pub fn position(&self, i: usize) -> &SVector<f64, D> { &self.p[i] }
    pub fn volume(&self, i: usize) -> f64 { self.v[i] }
    pub fn spacing(&self) -> f64 { self.s }
    pub fn bytes(&self) -> usize { 0 }
}
