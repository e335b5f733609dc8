//! What can go wrong with output: every error names the file.

use std::fs::File;
use std::io::Write as _;
use std::path::{Path, PathBuf};

/// Result of every fallible call of this crate.
pub type Result<X, E = Error> = std::result::Result<X, E>;

/// Error of `pd-io`. A "node" is the row of a table and the point of a curve.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The file system refused.
    #[error("cannot write {}: {source} (what was written before is intact)", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// The cause.
        source: std::io::Error,
    },
    /// The file system refused to read.
    #[error("cannot read {}: {source}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// The cause.
        source: std::io::Error,
    },
    /// A file that a run cannot go on from.
    #[error("cannot go on from {}: it {reason}", path.display())]
    Unfit {
        /// The file.
        path: PathBuf,
        /// Why not.
        reason: String,
    },
    /// A PNG could not be encoded.
    #[error("cannot encode {}: {source}", path.display())]
    Png {
        /// The file.
        path: PathBuf,
        /// The cause.
        source: png::EncodingError,
    },
    /// A field has not one value per node.
    #[error("{}: field '{field}' has {given} values for {nodes} nodes", path.display())]
    Length {
        /// The file.
        path: PathBuf,
        /// The field.
        field: String,
        /// Values given.
        given: usize,
        /// Nodes.
        nodes: usize,
    },
    /// A value is NaN or infinite.
    #[error("{}: field '{field}' is {value} at node {node}: nothing was written", path.display())]
    NotFinite {
        /// The file.
        path: PathBuf,
        /// The field.
        field: String,
        /// The node.
        node: usize,
        /// The value.
        value: f64,
    },
    /// A value has no place on the axis: not positive on a logarithmic one, a negative radius.
    #[error("{}: field '{field}' is {value} at node {node}: {needs}", path.display())]
    OffAxis {
        /// The file.
        path: PathBuf,
        /// The field.
        field: String,
        /// The node.
        node: usize,
        /// The value.
        value: f64,
        /// What the axis needs.
        needs: &'static str,
    },
    /// The edge of a cell is not a positive length.
    #[error("{}: cells of edge {cell}: give a positive length in metres", path.display())]
    Cell {
        /// The file.
        path: PathBuf,
        /// The edge.
        cell: f64,
    },
    /// The ends of a colour bar are not finite and increasing.
    #[error("{}: colours from {low} to {high}: give finite ends, low < high", path.display())]
    Range {
        /// The file.
        path: PathBuf,
        /// Low end.
        low: f64,
        /// High end.
        high: f64,
    },
    /// A name that the file cannot hold.
    #[error("{}: the name {name:?} {reason}", path.display())]
    Name {
        /// The file.
        path: PathBuf,
        /// The name.
        name: String,
        /// Why not, and what to do.
        reason: &'static str,
    },
    /// The times of a series do not increase.
    #[error("{}: a step at t = {time} s after one at {last} s: times must increase", path.display())]
    Time {
        /// The file.
        path: PathBuf,
        /// Time of the step, in seconds.
        time: f64,
        /// Time of the step before, in seconds.
        last: f64,
    },
    /// The file to go on with is not of this table.
    #[error(
        "{} is another table, not to be overwritten: it begins '{found}', not '{wanted}'; move it \
         away or give another path",
        path.display()
    )]
    Foreign {
        /// The file.
        path: PathBuf,
        /// Its first two lines.
        found: String,
        /// Those of the table asked for.
        wanted: String,
    },
    /// A whole line of a table has not one cell per column.
    #[error("{}, line {line}: {given} cells for {wanted} columns: remove the line", path.display())]
    Malformed {
        /// The file.
        path: PathBuf,
        /// The line, from 1.
        line: usize,
        /// Its cells.
        given: usize,
        /// The columns.
        wanted: usize,
    },
    /// There is nothing to write.
    #[error("{}: nothing to write: give at least one {what}", path.display())]
    Empty {
        /// The file.
        path: PathBuf,
        /// What is missing.
        what: &'static str,
    },
}

impl Error {
    pub(crate) fn file(path: &Path, source: std::io::Error) -> Self {
        Self::File { path: path.to_owned(), source }
    }
    pub(crate) fn unreadable(path: &Path, source: std::io::Error) -> Self {
        Self::Unreadable { path: path.to_owned(), source }
    }
    pub(crate) fn unfit(path: &Path, reason: String) -> Self {
        Self::Unfit { path: path.to_owned(), reason }
    }
}

/// Refuses the first value that is not finite.
pub(crate) fn finite<'a>(
    path: &Path,
    field: &str,
    values: impl IntoIterator<Item = &'a f64>,
    per_node: usize,
) -> Result<()> {
    match values.into_iter().enumerate().find(|(_, value)| !value.is_finite()) {
        None => Ok(()),
        Some((i, &value)) => Err(Error::NotFinite {
            path: path.to_owned(),
            field: field.to_owned(),
            node: i / per_node,
            value,
        }),
    }
}

/// Refuses a field that has not one value per node.
pub(crate) fn one_per_node(path: &Path, field: &str, given: usize, nodes: usize) -> Result<()> {
    if given == nodes {
        return Ok(());
    }
    Err(Error::Length { path: path.to_owned(), field: field.to_owned(), given, nodes })
}

/// Writes a file beside its place and renames it when it is on the disk: it is there whole or not
/// at all, and what was there before stays until then.
pub(crate) fn write_whole(path: &Path, bytes: &[u8]) -> Result<()> {
    write_whole_with(path, &|file| file.write_all(bytes))
}

/// As [`write_whole`], of what `fill` writes into the file.
pub(crate) fn write_whole_with(
    path: &Path,
    fill: &dyn Fn(&mut File) -> std::io::Result<()>,
) -> Result<()> {
    let folder = match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    std::fs::create_dir_all(folder).map_err(|e| Error::file(path, e))?;
    let mut beside = path.as_os_str().to_owned();
    beside.push(".part");
    let beside = PathBuf::from(beside);
    let write = || {
        let mut file = File::create(&beside)?;
        fill(&mut file)?;
        // Before the rename: else a power cut may leave the new name on an empty file.
        file.sync_all()?;
        std::fs::rename(&beside, path)
    };
    write().map_err(|e| {
        // A half-written part is of no use; that removing it may fail too changes nothing.
        let _ = std::fs::remove_file(&beside);
        Error::file(path, e)
    })?;
    // The file is whole already; not every platform can put a folder's entries on the disk.
    let _ = File::open(folder).and_then(|folder| folder.sync_all());
    Ok(())
}
