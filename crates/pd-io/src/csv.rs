//! CSV histories that survive a killed run.

use crate::error::{Error, Result, one_per_node};
use std::fs::File;
use std::io::Write as _;
use std::path::{Path, PathBuf};

/// A table written row by row; every row is in the file when [`row`](Self::row) returns. Numbers
/// round-trip exactly; column names are quoted where they must be (RFC 4180).
#[derive(Debug)]
pub struct History {
    path: PathBuf,
    file: File,
    columns: Vec<String>,
    rows: usize,
}

impl History {
    /// A table with these column names (with units).
    ///
    /// # Errors
    /// [`Error::Empty`] without a column, [`Error::File`].
    pub fn create(path: impl AsRef<Path>, columns: &[&str]) -> Result<Self> {
        let path = path.as_ref().to_owned();
        if columns.is_empty() {
            return Err(Error::Empty { path, what: "column" });
        }
        let open = || {
            if let Some(folder) = path.parent() {
                std::fs::create_dir_all(folder)?;
            }
            let mut file = File::create(&path)?;
            let names: Vec<String> = columns.iter().map(|name| quoted(name)).collect();
            file.write_all(format!("{}\n", names.join(",")).as_bytes())?;
            Ok(file)
        };
        let file = open().map_err(|e| Error::file(&path, e))?;
        Ok(Self { path, file, columns: columns.iter().map(|&c| c.to_owned()).collect(), rows: 0 })
    }
    /// Adds a row.
    ///
    /// # Errors
    /// [`Error::Length`] for a wrong number of values, [`Error::NotFinite`] with the column and
    /// the row (counted from 0), [`Error::File`].
    pub fn row(&mut self, values: &[f64]) -> Result<()> {
        one_per_node(&self.path, &self.columns.join(","), values.len(), self.columns.len())?;
        if let Some((field, &value)) =
            self.columns.iter().zip(values).find(|(_, value)| !value.is_finite())
        {
            let (path, field) = (self.path.clone(), field.clone());
            return Err(Error::NotFinite { path, field, node: self.rows, value });
        }
        let cells: Vec<String> = values.iter().map(|v| format!("{v:e}")).collect();
        let line = format!("{}\n", cells.join(","));
        self.file.write_all(line.as_bytes()).map_err(|e| Error::file(&self.path, e))?;
        self.rows += 1;
        Ok(())
    }
}

/// A name as RFC 4180 wants it.
fn quoted(name: &str) -> String {
    if name.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", name.replace('"', "\"\""))
    } else {
        name.to_owned()
    }
}
