//! Checkpoint files: a state, whole or not at all.
//!
//! ```text
//! magic (8 bytes) · version (u32) · state · length of the state (u64) · CRC-32 of the state (u32)
//! ```
//! Numbers are little-endian. The file is written beside its place and renamed when it is on the
//! disk, so that a program killed at any moment leaves the last good one.

use crate::error::{Error, Result, write_whole_with};
use crc32fast::Hasher;
use std::io::{self, BufWriter, Write};
use std::path::Path;

/// The first bytes. The last two tell a file that was sent as text.
const MAGIC: &[u8; 8] = b"PDSTAT\r\n";
/// Version of the format.
const VERSION: u32 = 1;
const HEAD: usize = MAGIC.len() + 4;
const TAIL: usize = 8 + 4;

/// Passes on what is written, and sums it up.
struct Summed<'a> {
    out: &'a mut dyn Write,
    sum: Hasher,
    length: u64,
}

impl Write for Summed<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = self.out.write(bytes)?;
        self.sum.update(&bytes[..written]);
        self.length += written as u64;
        Ok(written)
    }
    fn flush(&mut self) -> io::Result<()> {
        self.out.flush()
    }
}

/// Writes the state that `state` writes into a checkpoint file; an older one stays until it is
/// whole.
///
/// # Errors
/// [`Error::File`].
pub fn write(
    path: impl AsRef<Path>,
    state: &dyn Fn(&mut dyn Write) -> io::Result<()>,
) -> Result<()> {
    write_whole_with(path.as_ref(), &|file| {
        let mut out = BufWriter::new(file);
        out.write_all(MAGIC)?;
        out.write_all(&VERSION.to_le_bytes())?;
        let mut summed = Summed { out: &mut out, sum: Hasher::new(), length: 0 };
        state(&mut summed)?;
        let (length, sum) = (summed.length, summed.sum.finalize());
        out.write_all(&length.to_le_bytes())?;
        out.write_all(&sum.to_le_bytes())?;
        out.flush()
    })
}

/// The state in a checkpoint file.
///
/// # Errors
/// [`Error::Unreadable`]; [`Error::Unfit`] for a file that is no checkpoint, of another version,
/// cut short or changed.
pub fn read(path: impl AsRef<Path>) -> Result<Vec<u8>> {
    let path = path.as_ref();
    let mut bytes = std::fs::read(path).map_err(|e| Error::unreadable(path, e))?;
    let state = state_in(&bytes).map_err(|reason| Error::unfit(path, reason))?;
    bytes.truncate(state.end);
    bytes.drain(..state.start);
    Ok(bytes)
}

/// Where in `file` the state is, or why there is none.
///
/// # Errors
/// The reason, to follow on "it".
pub fn state_in(file: &[u8]) -> Result<std::ops::Range<usize>, String> {
    if !file.starts_with(MAGIC) {
        return Err("is not a checkpoint of a run".to_owned());
    }
    let short = || format!("is cut short at {} bytes", file.len());
    let version = file[MAGIC.len()..].first_chunk::<4>().ok_or_else(short)?;
    let version = u32::from_le_bytes(*version);
    if version != VERSION {
        return Err(format!("is of version {version}, this program reads version {VERSION}"));
    }
    let (rest, sum) = file.split_last_chunk::<4>().ok_or_else(short)?;
    let (rest, length) = rest.split_last_chunk::<8>().ok_or_else(short)?;
    let state = file.get(HEAD..rest.len()).ok_or_else(short)?;
    if u64::from_le_bytes(*length) != state.len() as u64 {
        return Err(short());
    }
    if crc32fast::hash(state) != u32::from_le_bytes(*sum) {
        return Err("was changed after it was written: its checksum does not agree".to_owned());
    }
    Ok(HEAD..file.len() - TAIL)
}
