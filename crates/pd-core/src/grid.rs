//! stub
use nalgebra::SVector;
#[derive(Debug, Clone)]
pub struct Grid<const D: usize> { origin: SVector<f64, D>, spacing: SVector<f64, D>, cells: [usize; D] }
#[derive(Debug, Clone)]
pub struct NodeSet(pub Vec<u32>);
impl NodeSet { pub fn iter(&self)->impl Iterator<Item=usize>+'_ { self.0.iter().map(|&i| i as usize)} pub fn len(&self)->usize{self.0.len()} }
impl<const D: usize> Grid<D> {
    pub fn lattice(origin: SVector<f64, D>, spacing: SVector<f64, D>, cells: [usize; D]) -> Self { Self { origin, spacing, cells } }
    pub fn len(&self) -> usize { self.cells.iter().product() }
    pub fn cells(&self) -> [usize; D] { self.cells }
    pub fn spacing(&self) -> &SVector<f64, D> { &self.spacing }
    pub fn cell(&self, node: usize) -> [usize; D] { let mut r = node; std::array::from_fn(|d| { let i = r % self.cells[d]; r /= self.cells[d]; i }) }
    pub fn node(&self, c: [usize; D]) -> Option<usize> { let mut i = 0; for d in (0..D).rev() { i = i * self.cells[d] + c[d]; } Some(i) }
    pub fn position(&self, node: usize) -> SVector<f64, D> { let c = self.cell(node); SVector::from_fn(|d, _| self.origin[d] + c[d] as f64 * self.spacing[d]) }
    pub fn cell_volume(&self) -> f64 { self.spacing.iter().product() }
    pub fn bytes(&self) -> usize { 0 }
}
