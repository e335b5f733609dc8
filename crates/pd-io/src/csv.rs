//! CSV histories that survive a killed run.

use crate::error::{Error, Result, one_per_node, write_whole};
use std::fs::{File, OpenOptions};
use std::io::{Read as _, Write as _};
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

/// A table of text that a killed program goes on with: every row is on the disk when
/// [`row`](Self::row) returns, and [`open`](Self::open) gives back the whole rows of before. A last
/// line that was cut is dropped.
#[derive(Debug)]
pub struct Ledger {
    path: PathBuf,
    file: File,
    columns: usize,
}

impl Ledger {
    /// Opens or creates the table of this title and these columns; returns its rows too.
    ///
    /// # Errors
    /// [`Error::Empty`] without a column, [`Error::Foreign`] for a file with another title or other
    /// columns (it stays as it is), [`Error::Malformed`] for a whole line of another length,
    /// [`Error::File`].
    pub fn open(
        path: impl AsRef<Path>,
        title: &str,
        columns: &[&str],
    ) -> Result<(Self, Vec<Vec<String>>)> {
        let path = path.as_ref().to_owned();
        if columns.is_empty() {
            return Err(Error::Empty { path, what: "column" });
        }
        let head = format!("# {}\n{}", in_one_line(title), head(columns));
        let open = || {
            if let Some(folder) = path.parent() {
                std::fs::create_dir_all(folder)?;
            }
            let options = OpenOptions::new().create(true).append(true).read(true).clone();
            let mut file = options.open(&path)?;
            let mut bytes = Vec::new();
            file.read_to_end(&mut bytes)?;
            Ok((file, bytes))
        };
        let (mut file, bytes) = open().map_err(|e| Error::file(&path, e))?;
        let text = String::from_utf8_lossy(&bytes);
        let mut whole = bytes.iter().rposition(|&b| b == b'\n').map_or(0, |last| last + 1);
        let mut rows = Vec::new();
        if text.starts_with(&head) {
            let kept = String::from_utf8_lossy(&bytes[..whole]);
            for (line, row) in kept.lines().enumerate().skip(2) {
                let cells = cells(row);
                if cells.len() != columns.len() {
                    let (given, wanted) = (cells.len(), columns.len());
                    return Err(Error::Malformed { path, line: line + 1, given, wanted });
                }
                rows.push(cells);
            }
        } else if head.starts_with(&*text) {
            whole = 0;
        } else {
            let found = text.lines().take(2).collect::<Vec<_>>().join(" / ");
            let wanted = head.trim_end().replace('\n', " / ");
            return Err(Error::Foreign { path, found, wanted });
        }
        let ready = file.set_len(whole as u64).and_then(|()| match whole {
            0 => file.write_all(head.as_bytes()),
            _ => Ok(()),
        });
        ready.map_err(|e| Error::file(&path, e))?;
        Ok((Self { path, file, columns: columns.len() }, rows))
    }
    /// Adds a row; line breaks in a cell become spaces.
    ///
    /// # Errors
    /// [`Error::Length`] for a wrong number of cells, [`Error::File`].
    pub fn row(&mut self, cells: &[String]) -> Result<()> {
        one_per_node(&self.path, "row", cells.len(), self.columns)?;
        let cells: Vec<String> = cells.iter().map(|cell| quoted(&in_one_line(cell))).collect();
        let line = format!("{}\n", cells.join(","));
        let write = self.file.write_all(line.as_bytes()).and_then(|()| self.file.sync_data());
        write.map_err(|e| Error::file(&self.path, e))
    }
}

fn in_one_line(text: &str) -> String {
    text.replace(['\n', '\r'], " ")
}

/// The cells of one line (RFC 4180, no line breaks in cells).
fn cells(line: &str) -> Vec<String> {
    let (mut cells, mut cell, mut inside) = (Vec::new(), String::new(), false);
    let mut letters = line.chars().peekable();
    while let Some(letter) = letters.next() {
        match letter {
            '"' if inside && letters.peek() == Some(&'"') => cell.extend(letters.next()),
            '"' => inside = !inside,
            ',' if !inside => cells.push(std::mem::take(&mut cell)),
            _ => cell.push(letter),
        }
    }
    cells.push(cell);
    cells
}
