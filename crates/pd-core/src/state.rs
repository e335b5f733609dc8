//! The state of a run as bytes: what must be kept to go on later as if nothing had happened.
//!
//! A state is a list of named parts, all numbers in little-endian order. It holds what changes
//! during a run (motion, forces, states, bonds, counters), not the scene: to go on, the same program
//! builds the same body and run, and [`Run::resume`](crate::Run::resume) fills it. Parts of another
//! length (another grid, precision, material, criterion, integrator) are refused, and so are forces
//! that the scene at hand would not give.

use crate::field::Field;
use crate::record::Record;
use crate::{Error, Real, Result};
use std::io::{self, Write};

/// Bytes of numbers that are put together before they are written.
const BUFFER: usize = 1 << 16;

/// Writes the parts of a state one after the other.
pub struct StateWriter<'a> {
    out: &'a mut dyn Write,
}

impl<'a> StateWriter<'a> {
    /// Into `out`.
    pub fn new(out: &'a mut dyn Write) -> Self {
        Self { out }
    }
    fn head(&mut self, name: &str, length: usize) -> io::Result<()> {
        self.out.write_all(&[name.len() as u8])?;
        self.out.write_all(name.as_bytes())?;
        self.out.write_all(&(length as u64).to_le_bytes())
    }
    /// A part of bytes.
    ///
    /// # Errors
    /// What `out` reports.
    pub fn bytes(&mut self, name: &'static str, bytes: &[u8]) -> io::Result<()> {
        self.head(name, bytes.len())?;
        self.out.write_all(bytes)
    }
    /// A part of numbers, each with all its bits.
    ///
    /// # Errors
    /// What `out` reports.
    pub fn numbers<T: Real>(&mut self, name: &'static str, numbers: &[T]) -> io::Result<()> {
        self.head(name, size_of_val(numbers))?;
        let mut buffer = Vec::with_capacity(BUFFER);
        for chunk in numbers.chunks(BUFFER / size_of::<T>()) {
            buffer.clear();
            chunk.iter().for_each(|x| put(*x, &mut buffer));
            self.out.write_all(&buffer)?;
        }
        Ok(())
    }
    /// A part of counts.
    ///
    /// # Errors
    /// What `out` reports.
    pub fn counts(&mut self, name: &'static str, counts: &[usize]) -> io::Result<()> {
        let bytes: Vec<u8> = counts.iter().flat_map(|&n| (n as u64).to_le_bytes()).collect();
        self.bytes(name, &bytes)
    }
}

fn put<T: Real>(x: T, into: &mut Vec<u8>) {
    if size_of::<T>() == size_of::<f32>() {
        into.extend((x.to_f64() as f32).to_le_bytes());
    } else {
        into.extend(x.to_f64().to_le_bytes());
    }
}

/// Reads the parts of a state in the order in which they were written.
#[derive(Clone)]
pub struct StateReader<'a> {
    rest: &'a [u8],
}

impl<'a> StateReader<'a> {
    /// From the bytes of a whole state.
    pub fn new(bytes: &'a [u8]) -> Self {
        Self { rest: bytes }
    }
    fn take(&mut self, name: &'static str, length: usize) -> Result<&'a [u8]> {
        let (taken, rest) = self
            .rest
            .split_at_checked(length)
            .ok_or_else(|| unlike(name, "is cut short".to_owned()))?;
        self.rest = rest;
        Ok(taken)
    }
    /// The part `name`, which must be the next one.
    ///
    /// # Errors
    /// [`Error::State`] if it is not, or is cut short.
    pub fn bytes(&mut self, name: &'static str) -> Result<&'a [u8]> {
        let letters = usize::from(self.take(name, 1)?[0]);
        let found = self.take(name, letters)?;
        if found != name.as_bytes() {
            let found = String::from_utf8_lossy(found);
            return Err(unlike(name, format!("was expected, but '{found}' comes next")));
        }
        let mut length = [0; 8];
        length.copy_from_slice(self.take(name, 8)?);
        // A length that the machine cannot address is longer than what is left.
        let length = usize::try_from(u64::from_le_bytes(length)).unwrap_or(usize::MAX);
        self.take(name, length)
    }
    /// `count` finite numbers.
    ///
    /// # Errors
    /// [`Error::State`] for another part or another number of them, or one that is not finite.
    pub fn numbers<T: Real>(&mut self, name: &'static str, count: usize) -> Result<Vec<T>> {
        let bytes = self.bytes(name)?;
        if bytes.len() != count * size_of::<T>() {
            let (found, size) = (bytes.len(), count * size_of::<T>());
            return Err(unlike(name, format!("has {found} bytes, this scene's has {size}")));
        }
        let number = |chunk: &[u8]| match *chunk {
            [a, b, c, d] => f64::from(f32::from_le_bytes([a, b, c, d])),
            [a, b, c, d, e, f, g, h] => f64::from_le_bytes([a, b, c, d, e, f, g, h]),
            _ => f64::NAN,
        };
        let numbers: Vec<T> = bytes.chunks(size_of::<T>()).map(|c| T::of(number(c))).collect();
        match numbers.iter().find(|x| !x.is_finite()) {
            None => Ok(numbers),
            Some(x) => Err(unlike(name, format!("holds {x}, which no run writes"))),
        }
    }
    /// `N` counts.
    ///
    /// # Errors
    /// [`Error::State`] for another part or another number of them.
    pub fn counts<const N: usize>(&mut self, name: &'static str) -> Result<[usize; N]> {
        let bytes = self.bytes(name)?;
        if bytes.len() != 8 * N {
            return Err(unlike(name, format!("has {} bytes, expected {}", bytes.len(), 8 * N)));
        }
        let mut counts = [0; N];
        for (count, chunk) in counts.iter_mut().zip(bytes.chunks_exact(8)) {
            let mut number = [0; 8];
            number.copy_from_slice(chunk);
            *count = usize::try_from(u64::from_le_bytes(number))
                .map_err(|_| unlike(name, "holds a count beyond this machine's".to_owned()))?;
        }
        Ok(counts)
    }
    /// A node array like `like`.
    ///
    /// # Errors
    /// As [`numbers`](Self::numbers).
    pub(crate) fn field<T: Real, R: Record<T>>(
        &mut self,
        name: &'static str,
        like: &Field<T, R>,
    ) -> Result<Field<T, R>> {
        let numbers = self.numbers(name, like.as_slice().len())?;
        let mut field = Field::zeros(like.len());
        field.as_mut_slice().copy_from_slice(&numbers);
        Ok(field)
    }
    /// Nothing must be left.
    ///
    /// # Errors
    /// [`Error::State`] otherwise.
    pub fn finish(self) -> Result<()> {
        match self.rest.len() {
            0 => Ok(()),
            n => Err(unlike("end", format!("has {n} more bytes"))),
        }
    }
}

/// A state that does not fit.
pub(crate) fn unlike(part: &'static str, reason: String) -> Error {
    Error::State { part, reason }
}

/// A state that a run offers to whoever keeps it.
pub struct Kept<'a> {
    /// Steps taken.
    pub step: usize,
    /// Time t in seconds.
    pub time: f64,
    /// True if the run ends here because it was [asked to](crate::Run::stop_on).
    pub interrupted: bool,
    pub(crate) write: &'a dyn Fn(&mut dyn Write) -> io::Result<()>,
}

impl Kept<'_> {
    /// Writes the state.
    ///
    /// # Errors
    /// What `out` reports.
    pub fn write(&self, out: &mut dyn Write) -> io::Result<()> {
        (self.write)(out)
    }
}
