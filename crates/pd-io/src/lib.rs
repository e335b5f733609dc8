//! Field output: ParaView files, PNG maps and charts, CSV histories.
//!
//! Everything works on plain slices. Files appear whole: they are written beside their place and
//! renamed, and values that are not finite are refused, so that a run never writes NaN and never
//! loses what it has written.
mod canvas;
pub mod csv;
pub mod error;
pub mod map;
pub mod plot;
pub mod vtk;

pub use csv::History;
pub use error::{Error, Result};
pub use map::{ColourMap, FieldMap};
pub use plot::LinePlot;
pub use vtk::{Series, Snapshot};
