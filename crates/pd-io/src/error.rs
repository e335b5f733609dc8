//! What can go wrong with output.

use std::path::{Path, PathBuf};

/// Result of every fallible call of this crate.
pub type Result<X, E = Error> = std::result::Result<X, E>;

/// Error of `pd-io`.
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
    /// A PNG could not be encoded.
    #[error("cannot encode {}: {source}", path.display())]
    Png {
        /// The file.
        path: PathBuf,
        /// The cause.
        source: png::EncodingError,
    },
    /// A field has not one value per node.
    #[error("field '{field}' has {given} values for {nodes} nodes")]
    Length {
        /// The field.
        field: String,
        /// Values given.
        given: usize,
        /// Nodes.
        nodes: usize,
    },
    /// A value is NaN or infinite.
    #[error("field '{field}' is {value} at node (or column) {node}: nothing was written")]
    NotFinite {
        /// The field.
        field: String,
        /// The node or column.
        node: usize,
        /// The value.
        value: f64,
    },
    /// There is nothing to draw.
    #[error("'{0}' has nothing to draw")]
    Empty(String),
}

impl Error {
    pub(crate) fn file(path: &Path, source: std::io::Error) -> Self {
        Self::File { path: path.to_owned(), source }
    }
}

/// Refuses the first value that is not finite.
pub(crate) fn finite<'a>(
    field: &str,
    values: impl IntoIterator<Item = &'a f64>,
    per_node: usize,
) -> Result<()> {
    for (i, &value) in values.into_iter().enumerate() {
        if !value.is_finite() {
            return Err(Error::NotFinite { field: field.to_owned(), node: i / per_node, value });
        }
    }
    Ok(())
}

/// Writes a file beside its place and renames it: it is there whole or not at all.
pub(crate) fn write_whole(path: &Path, bytes: &[u8]) -> Result<()> {
    if let Some(folder) = path.parent().filter(|f| !f.as_os_str().is_empty()) {
        std::fs::create_dir_all(folder).map_err(|e| Error::file(folder, e))?;
    }
    let mut beside = path.as_os_str().to_owned();
    beside.push(".part");
    let beside = PathBuf::from(beside);
    let written = std::fs::write(&beside, bytes).and_then(|()| std::fs::rename(&beside, path));
    written.map_err(|e| {
        // A half-written part is of no use; that removing it may fail too changes nothing.
        let _ = std::fs::remove_file(&beside);
        Error::file(path, e)
    })
}
