//! Adaptive dynamic relaxation: static equilibrium by damped explicit steps.

use crate::body::{BreakEvents, Dynamics};
use crate::family::Tally;
use crate::field::Field;
use crate::integrator::{Clock, Integrator};
use crate::loads::Bound;
use crate::state::{StateReader, StateWriter};
use crate::{Real, Result};
use nalgebra::SVector;

/// Adaptive dynamic relaxation (Underwood; Kilic and Madenci 2010): central differences with mass
/// damping that is critical for the motion as it is.
///
/// v ← ((2 − cΔt) v + 2Δt f/ρ) / (2 + cΔt), u ← u + Δt v, with c = 2ω and the Rayleigh quotient of
/// the motion, ω² = −v·(f − f_previous) / (Δt v·ρv). Fast modes die first, then ω falls to that of
/// the slowest one, which is damped critically.
///
/// The mass is the body's own and Δt follows from its spectrum, 2/ω_max, which is what the row sums
/// of Gershgorin bound from above; time has no meaning but that of the loads. Use it with
/// [`Run::relax`](crate::run::Run::relax).
#[derive(Debug, Clone)]
pub struct DynamicRelaxation<T, const D: usize> {
    previous: Field<T, SVector<T, D>>,
    started: bool,
    /// The largest loads met, in N.
    largest: f64,
}

impl<T: Real, const D: usize> Default for DynamicRelaxation<T, D> {
    fn default() -> Self {
        Self { previous: Field::zeros(0), started: false, largest: 0.0 }
    }
}

impl<T: Real, const D: usize> DynamicRelaxation<T, D> {
    /// The scheme.
    pub fn new() -> Self {
        Self::default()
    }
    /// Forgets the motion so far: the next step starts from rest.
    pub(crate) fn restart(&mut self, body: &mut impl Dynamics<T, D>) {
        self.started = false;
        body.v_mut().as_mut_slice().fill(T::zero());
    }
    /// Force out of balance, as the root of the sum of squares of f V over the free components, over
    /// that of the loads (reactions of the supports and body forces), the largest so far: a body
    /// that has parted carries none.
    pub(crate) fn residual(&mut self, body: &impl Dynamics<T, D>, loads: &Bound, time: f64) -> f64 {
        let unit = body.unit();
        let square = |node: usize| {
            let f = body.force().get(body.site(node)).map(Real::to_f64) / unit;
            f.norm_squared() * body.volume(node).powi(2)
        };
        let all: f64 = (0..body.nodes()).map(square).sum();
        let (supports, forces) = loads.squares(body, time);
        self.largest = self.largest.max((supports + forces).sqrt());
        let free = (all - supports).max(0.0).sqrt();
        if free == 0.0 { 0.0 } else { free / self.largest.max(f64::MIN_POSITIVE) }
    }
    /// c Δt of the motion.
    fn damping(&self, body: &impl Dynamics<T, D>, dt: f64) -> f64 {
        let (v, f, before) = (body.v(), body.force(), &self.previous);
        // In units of Δx: v·(f_previous − f) and v·v/w with the inverse mass w.
        let at = |node: usize| {
            let site = body.site(node);
            let velocity = v.get(site).map(Real::to_f64);
            let change = (before.get(site) - f.get(site)).map(Real::to_f64);
            (velocity, change, body.inverse_mass(site).to_f64())
        };
        let nodes = body.nodes();
        let sum = |g: &dyn Fn(usize) -> f64| (0..nodes).map(g).sum::<f64>();
        let work = sum(&|node| {
            let (velocity, change, _) = at(node);
            velocity.dot(&change)
        });
        let mass = sum(&|node| {
            let (velocity, _, inverse) = at(node);
            velocity.norm_squared() / inverse
        });
        let square = work * dt / mass;
        // Beyond cΔt = 2 the velocity would change its sign.
        if square > 0.0 { (2.0 * square.sqrt()).min(1.9) } else { 0.0 }
    }
    /// One damped step; `breaks` decides whether bonds are tested.
    pub(crate) fn advance<B: Dynamics<T, D>>(
        &mut self,
        body: &mut B,
        loads: &Bound,
        clock: Clock,
        events: Option<&mut dyn BreakEvents<B>>,
    ) -> Result<Tally> {
        let Clock { step, time, dt } = clock;
        let (keep, kick) = if self.started {
            let c = self.damping(body, dt);
            ((2.0 - c) / (2.0 + c), 2.0 / (2.0 + c))
        } else {
            (0.0, 0.5)
        };
        self.started = true;
        let keep = T::of(keep);
        body.v_mut().as_mut_slice().iter_mut().for_each(|v| *v *= keep);
        body.kick(kick * dt);
        self.previous.clone_from(body.force());
        loads.hold(body, time, dt);
        body.drift(dt);
        loads.place(body, time + dt);
        let tally = match events {
            Some(events) => body.evaluate_and_break(step, events)?,
            None => {
                body.evaluate()?;
                Tally::default()
            }
        };
        loads.add_forces(body, time + dt);
        Ok(tally)
    }
}

impl<T: Real, const D: usize> Integrator<T, D> for DynamicRelaxation<T, D> {
    fn step<B: Dynamics<T, D>>(
        &mut self,
        body: &mut B,
        loads: &Bound,
        clock: Clock,
        events: &mut dyn BreakEvents<B>,
    ) -> Result<Tally> {
        self.advance(body, loads, clock, Some(events))
    }
    fn save(&self, state: &mut StateWriter<'_>) -> std::io::Result<()> {
        state.counts("relaxation", &[usize::from(self.started)])?;
        state.numbers("largest loads", &[self.largest])?;
        state.numbers("forces before", self.previous.as_slice())
    }
    fn restore(&mut self, state: &mut StateReader<'_>, sites: usize) -> Result<()> {
        let [started] = state.counts("relaxation")?;
        let largest: Vec<f64> = state.numbers("largest loads", 1)?;
        // Nothing is remembered before the first step.
        let sites = if started == 0 { 0 } else { sites };
        self.previous = state.field("forces before", &Field::zeros(sites))?;
        (self.started, self.largest) = (started != 0, largest[0]);
        Ok(())
    }
}

/// How a relaxation ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Relaxed {
    /// Steps taken.
    pub steps: usize,
    /// Force that is out of balance over the largest loads so far.
    pub residual: f64,
    /// Bonds broken on the way.
    pub broken: usize,
}
