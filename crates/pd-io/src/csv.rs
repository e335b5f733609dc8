//! CSV histories that survive a killed run.

use crate::error::{Error, Result, finite};
use std::fs::File;
use std::io::Write as _;
use std::path::{Path, PathBuf};

/// A table written row by row; every row is in the file when [`row`](Self::row) returns. Numbers
/// round-trip exactly.
#[derive(Debug)]
pub struct History {
    path: PathBuf,
    file: File,
    columns: Vec<String>,
}

impl History {
    /// A table with these column names (with units).
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn create(path: impl AsRef<Path>, columns: &[&str]) -> Result<Self> {
        let path = path.as_ref().to_owned();
        let open = || {
            if let Some(folder) = path.parent() {
                std::fs::create_dir_all(folder)?;
            }
            let mut file = File::create(&path)?;
            writeln!(file, "{}", columns.join(","))?;
            Ok(file)
        };
        let file = open().map_err(|e| Error::file(&path, e))?;
        Ok(Self { path, file, columns: columns.iter().map(|&c| c.to_owned()).collect() })
    }
    /// Adds a row.
    ///
    /// # Errors
    /// [`Error::Length`] for a wrong number of values, [`Error::NotFinite`] with the column,
    /// [`Error::File`].
    pub fn row(&mut self, values: &[f64]) -> Result<()> {
        let (given, nodes) = (values.len(), self.columns.len());
        if given != nodes {
            return Err(Error::Length { field: self.columns.join(","), given, nodes });
        }
        for (name, value) in self.columns.iter().zip(values) {
            finite(name, [value], 1)?;
        }
        let cells: Vec<String> = values.iter().map(|v| format!("{v:e}")).collect();
        let line = format!("{}\n", cells.join(","));
        self.file.write_all(line.as_bytes()).map_err(|e| Error::file(&self.path, e))
    }
}
