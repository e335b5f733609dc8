//! Runs that are stopped and go on: nothing is lost.
//!
//! ```no_run
//! use peridynamics::checkpoint::Checkpoint;
//! # use peridynamics::prelude::*;
//! # fn go_on(run: &mut Run<'_, f64, 2, Body<f64, 2, Lattice<f64, 2>, Ordinary<Pmb>, NoDamage>>)
//! # -> peridynamics::core::Result<()> {
//! let checkpoint = Checkpoint::new("out/plate.state");
//! checkpoint.resume(run)?; // if there is one
//! checkpoint.keep(run, 1000)?; // every 1000 steps, and on Ctrl-C
//! run.until(50e-6)?;
//! # Ok(())
//! # }
//! ```
//! The scene itself is not kept: the same program builds it again. Histories and series go on with
//! [`Table::resume`](crate::observe::Table::resume) and
//! [`FieldOutput::resume`](crate::observe::FieldOutput::resume).

use pd_core::body::Dynamics;
use pd_core::integrator::Integrator;
use pd_core::run::Run;
use pd_core::{Error, Real, Result};
use std::path::{Path, PathBuf};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};

/// Where a run keeps its state.
#[derive(Debug, Clone)]
pub struct Checkpoint {
    path: PathBuf,
}

impl Checkpoint {
    /// In this file.
    pub fn new(path: impl AsRef<Path>) -> Self {
        Self { path: path.as_ref().to_owned() }
    }
    /// The file.
    pub fn path(&self) -> &Path {
        &self.path
    }
    /// Goes on from the state in the file, to the last bit as if the run had never stopped; without
    /// a file the run is left at its start. Returns the time in seconds that it goes on from.
    ///
    /// # Errors
    /// [`Error::Other`] for a file that cannot be read, is no checkpoint, cut short or changed;
    /// [`Error::State`] for the checkpoint of another scene.
    pub fn resume<T, const D: usize, B, I>(
        &self,
        run: &mut Run<'_, T, D, B, I>,
    ) -> Result<Option<f64>>
    where
        T: Real,
        B: Dynamics<T, D>,
        I: Integrator<T, D>,
    {
        if !self.path.exists() {
            return Ok(None);
        }
        let state = pd_io::checkpoint::read(&self.path).map_err(|e| Error::Other(e.to_string()))?;
        run.resume(&state)?;
        Ok(Some(run.time()))
    }
    /// Writes the state every `every` steps. Ctrl-C ends the run after its step with the state
    /// written and [`Error::Interrupted`]; a second Ctrl-C ends the program at once.
    ///
    /// # Errors
    /// [`Error::Other`] if Ctrl-C cannot be caught. The run ends with [`Error::Other`] if the file
    /// cannot be written (a full disk): the checkpoint before is intact.
    pub fn keep<T, const D: usize, B, I>(
        &self,
        run: &mut Run<'_, T, D, B, I>,
        every: usize,
    ) -> Result<()>
    where
        T: Real,
        B: Dynamics<T, D>,
        I: Integrator<T, D>,
    {
        let path = self.path.clone();
        run.keep(every, move |state| {
            let write = |out: &mut dyn std::io::Write| state.write(out);
            pd_io::checkpoint::write(&path, &write).map_err(|e| Error::Other(e.to_string()))?;
            Ok(path.display().to_string())
        });
        run.stop_on(interrupted()?);
        Ok(())
    }
    /// Removes the file: the run is over.
    ///
    /// # Errors
    /// [`Error::Other`] if it is there and cannot be removed.
    pub fn remove(&self) -> Result<()> {
        match std::fs::remove_file(&self.path) {
            Err(error) if error.kind() != std::io::ErrorKind::NotFound => {
                Err(Error::Other(format!("cannot remove {}: {error}", self.path.display())))
            }
            _ => Ok(()),
        }
    }
}

/// A flag that Ctrl-C sets; a second Ctrl-C ends the program. Give it to
/// [`Run::stop_on`].
///
/// # Errors
/// [`Error::Other`] if the program catches Ctrl-C already.
pub fn interrupted() -> Result<&'static AtomicBool> {
    static FLAG: AtomicBool = AtomicBool::new(false);
    static CAUGHT: OnceLock<std::result::Result<(), String>> = OnceLock::new();
    let catch = || {
        let stop = || {
            if FLAG.swap(true, Ordering::Relaxed) {
                std::process::exit(130);
            }
        };
        ctrlc::set_handler(stop).map_err(|e| format!("cannot catch Ctrl-C: {e}"))
    };
    CAUGHT.get_or_init(catch).clone().map_err(Error::Other)?;
    Ok(&FLAG)
}
