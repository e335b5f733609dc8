//! Field output: ParaView files, PNG maps and charts, CSV histories; checkpoints.
//!
//! Everything works on plain slices. Files appear whole: they are written beside their place and
//! renamed, and values that are not finite are refused, so that a run never writes NaN and never
//! loses what it has written. Checks are made when a file is written: errors name it.
mod axis;
mod canvas;
pub mod checkpoint;
pub mod csv;
pub mod error;
pub mod map;
pub mod plot;
pub mod polar;
pub mod vtk;

pub use csv::{History, Ledger};
pub use error::{Error, Result};
pub use map::{ColourMap, FieldMap};
pub use plot::LinePlot;
pub use polar::PolarPlot;
pub use vtk::{Series, Snapshot};
