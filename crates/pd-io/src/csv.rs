//! CSV histories that survive a killed run.

use crate::error::{Error, Result, one_per_node, write_whole};
use std::fs::{File, OpenOptions};
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
            file.write_all(head(columns).as_bytes())?;
            Ok(file)
        };
        let file = open().map_err(|e| Error::file(&path, e))?;
        Ok(Self { path, file, columns: columns.iter().map(|&c| c.to_owned()).collect(), rows: 0 })
    }
    /// Goes on with a table of these columns, the first of which is a time: rows up to the time
    /// `last` in seconds stay. Later ones, and a row that was cut short, go.
    ///
    /// # Errors
    /// [`Error::Unreadable`], [`Error::Unfit`] for a table of other columns, [`Error::File`].
    pub fn resume(path: impl AsRef<Path>, columns: &[&str], last: f64) -> Result<Self> {
        let path = path.as_ref().to_owned();
        let text = std::fs::read_to_string(&path).map_err(|e| Error::unreadable(&path, e))?;
        let head = head(columns);
        let Some(rows) = text.strip_prefix(&head) else {
            return Err(Error::unfit(&path, format!("has other columns than {}", head.trim_end())));
        };
        let whole = rows.split_inclusive('\n').filter(|row| row.ends_with('\n'));
        let time = |row: &str| row.split([',', '\n']).next().and_then(|t| t.parse::<f64>().ok());
        let kept: Vec<&str> =
            whole.take_while(|row| time(row).is_some_and(|t| t <= last)).collect();
        write_whole(&path, (head + &kept.concat()).as_bytes())?;
        let file = OpenOptions::new().append(true).open(&path);
        let file = file.map_err(|e| Error::file(&path, e))?;
        let columns = columns.iter().map(|&c| c.to_owned()).collect();
        Ok(Self { path, file, columns, rows: kept.len() })
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
        let whole = self.file.metadata().map(|data| data.len());
        if let Err(error) = self.file.write_all(line.as_bytes()) {
            // A part of a row is none; that it may stay on a broken disk changes nothing.
            let _ = whole.and_then(|length| self.file.set_len(length));
            return Err(Error::file(&self.path, error));
        }
        self.rows += 1;
        Ok(())
    }
}

/// The first line.
fn head(columns: &[&str]) -> String {
    let names: Vec<String> = columns.iter().map(|name| quoted(name)).collect();
    names.join(",") + "\n"
}

/// A name as RFC 4180 wants it.
fn quoted(name: &str) -> String {
    if name.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", name.replace('"', "\"\""))
    } else {
        name.to_owned()
    }
}
