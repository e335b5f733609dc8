//! Explicit time integrators.

use crate::body::{BreakEvents, Dynamics};
use crate::family::Tally;
use crate::loads::Bound;
use crate::state::{StateReader, StateWriter};
use crate::{Real, Result};

/// One step of an explicit scheme.
pub trait Integrator<T: Real, const D: usize> {
    /// Advances `body` from `t` to `t + dt`; `step` counts from 1. Forces hold f(t) when it is
    /// called and f(t + dt) when it returns.
    ///
    /// # Errors
    /// What [`Dynamics::evaluate_and_break`] reports.
    fn step<B: Dynamics<T, D>>(
        &mut self,
        body: &mut B,
        loads: &Bound,
        clock: Clock,
        events: &mut dyn BreakEvents<B>,
    ) -> Result<Tally>;
    /// Writes what the scheme remembers from step to step; most remember nothing.
    ///
    /// # Errors
    /// What the writer reports.
    fn save(&self, state: &mut StateWriter<'_>) -> std::io::Result<()> {
        let _ = state;
        Ok(())
    }
    /// Takes back what [`save`](Self::save) wrote, for a body with `sites` sites.
    ///
    /// # Errors
    /// [`Error::State`](crate::Error::State) for the state of another scheme or body.
    fn restore(&mut self, state: &mut StateReader<'_>, sites: usize) -> Result<()> {
        let _ = (state, sites);
        Ok(())
    }
}

/// Where a run stands.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Clock {
    /// Number of the step that is taken, from 1.
    pub step: usize,
    /// Time t at the start of the step in seconds.
    pub time: f64,
    /// Time step Δt in seconds.
    pub dt: f64,
}

/// Velocity Verlet (Willberg): second order, symplectic.
///
/// v += ½Δt a; u += Δt v; a = f(u)/ρ; v += ½Δt a.
#[derive(Debug, Clone, Default)]
pub struct VelocityVerlet<T> {
    drift: Vec<Vec<T>>,
}

impl<T: Real> VelocityVerlet<T> {
    /// The scheme.
    pub fn new() -> Self {
        Self { drift: Vec::new() }
    }
}

impl<T: Real, const D: usize> Integrator<T, D> for VelocityVerlet<T> {
    fn step<B: Dynamics<T, D>>(
        &mut self,
        body: &mut B,
        loads: &Bound,
        clock: Clock,
        events: &mut dyn BreakEvents<B>,
    ) -> Result<Tally> {
        let Clock { step, time, dt } = clock;
        if self.drift.is_empty() {
            self.drift = loads.scratch();
        }
        body.kick(0.5 * dt);
        loads.hold(body, time, dt);
        loads.remember(body, &mut self.drift);
        body.drift(dt);
        loads.place(body, time + dt);
        let tally = body.evaluate_and_break(step, events)?;
        loads.add_forces(body, time + dt);
        body.kick(0.5 * dt);
        loads.finish(body, time + dt, &self.drift);
        Ok(tally)
    }
}

/// Symplectic Euler (Hattori Eqs. 31–32 with v(t+Δt) in 32: as printed, with v(t), the scheme is
/// unstable at every step). Velocities lag by half a step; first order in them.
///
/// v += Δt a; u += Δt v.
#[derive(Debug, Clone, Copy, Default)]
pub struct SymplecticEuler;

impl<T: Real, const D: usize> Integrator<T, D> for SymplecticEuler {
    fn step<B: Dynamics<T, D>>(
        &mut self,
        body: &mut B,
        loads: &Bound,
        clock: Clock,
        events: &mut dyn BreakEvents<B>,
    ) -> Result<Tally> {
        let Clock { step, time, dt } = clock;
        body.kick(dt);
        loads.hold(body, time, dt);
        body.drift(dt);
        loads.place(body, time + dt);
        let tally = body.evaluate_and_break(step, events)?;
        loads.add_forces(body, time + dt);
        Ok(tally)
    }
}
