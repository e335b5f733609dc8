//! The time loop: loads, steps, guards and observers.

use crate::body::{Body, Dissipated, Dissipation, Dynamics};
use crate::damage::DamagePolicy;
use crate::family::Family;
use crate::integrator::{Clock, Integrator, VelocityVerlet};
use crate::loads::{Bound, Loads};
use crate::material::StrainEnergy;
use crate::relaxation::{DynamicRelaxation, Relaxed};
use crate::state::{Kept, StateReader, StateWriter, unlike};
use crate::time_step::{Spectrum, require_stable, spectrum};
use crate::{Error, Real, Result};
use std::fmt;
use std::io::Write;
use std::marker::PhantomData;
use std::sync::atomic::{AtomicBool, Ordering};

/// How the time step is chosen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum TimeStep {
    /// This fraction of the body's critical step; lowered when damage lowers that.
    Safety(f64),
    /// Δt in seconds; refused above the body's critical step.
    Fixed(f64),
    /// Δt in seconds, whatever the critical step is, of an unstable body too.
    Unchecked(f64),
}

/// Steps between looks at the critical step while bonds break.
const REFRESH: usize = 500;
/// Steps between guards against NaN and blow-up.
const GUARD: usize = 20;

/// What an observer decides.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Flow {
    /// Go on.
    Continue,
    /// End the run after this step.
    Stop,
}

/// Energies of a run in J (per metre of thickness in 2D unless the body has one).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Energies {
    /// ½ Σ ρ V v².
    pub kinetic: f64,
    /// Σ W V.
    pub strain: f64,
    /// Work of body forces and supports since the start.
    pub external: f64,
    /// Strain energy lost when bonds broke.
    pub dissipated: f64,
}

/// How near a body came to breaking, for the last line of a program: "no bond broke; the worst
/// reached 0.83", or how many broke.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Margin {
    /// Undirected bonds broken since the start.
    pub broken: usize,
    /// The largest failure index met: value / critical value.
    pub worst: f64,
}

impl Margin {
    /// Of a body so far.
    pub fn of<T: Real, const D: usize>(body: &impl Dynamics<T, D>) -> Self {
        Self { broken: body.broken_bonds(), worst: body.worst_index() }
    }
}

impl fmt::Display for Margin {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.broken {
            0 => write!(f, "no bond broke; the worst reached {:.2}", self.worst),
            1 => write!(f, "1 bond broke; the worst reached {:.2}", self.worst),
            n => write!(f, "{n} bonds broke; the worst reached {:.2}", self.worst),
        }
    }
}

impl Energies {
    /// Kinetic energy over kinetic and strain energy: below about 0.01 a run is quasi-static.
    pub fn kinetic_share(&self) -> f64 {
        let sum = self.kinetic + self.strain;
        if sum > 0.0 { self.kinetic / sum } else { 0.0 }
    }
}

/// What an observer sees.
pub struct View<'a, B> {
    /// The body.
    pub body: &'a B,
    /// Steps taken.
    pub step: usize,
    /// Time t in seconds.
    pub time: f64,
    /// Time step Δt in seconds.
    pub dt: f64,
    /// When the run will end, in seconds.
    pub end: f64,
    /// Energies, if the run [accounts for them](Run::with_energies).
    pub energies: Option<Energies>,
}

/// Looks at a run every n steps; may stop it.
pub trait Observer<B> {
    /// Called with the state after a step (and before the first).
    ///
    /// # Errors
    /// Whatever ends the run.
    fn observe(&mut self, view: &View<'_, B>) -> Result<Flow>;
}

impl<B, F: FnMut(&View<'_, B>) -> Result<Flow>> Observer<B> for F {
    fn observe(&mut self, view: &View<'_, B>) -> Result<Flow> {
        self(view)
    }
}

/// Accounts for energies; only built for materials that have one.
struct Account<'a, B> {
    strain_energy: fn(&B) -> f64,
    dissipated: Box<dyn Dissipated<B> + 'a>,
    external: f64,
    power: f64,
    support_kinetic: f64,
}

/// Keeps a state and says where.
type Keeper<'a> = Box<dyn FnMut(&Kept<'_>) -> Result<String> + 'a>;

/// A run of a body through time.
///
/// ```text
/// let mut run = Run::new(&mut body, loads, TimeStep::Safety(0.8))?;
/// run.observe(100, |view| …);
/// run.until(50e-6)?;
/// ```
pub struct Run<'a, T: Real, const D: usize, B, I = VelocityVerlet<T>> {
    body: &'a mut B,
    loads: Bound,
    integrator: I,
    rule: TimeStep,
    dt: f64,
    critical: Option<Spectrum>,
    broken_at_refresh: usize,
    time: f64,
    step: usize,
    observers: Vec<(usize, Box<dyn Observer<B> + 'a>)>,
    account: Option<Account<'a, B>>,
    keeper: Option<(usize, Keeper<'a>)>,
    stop: Option<&'a AtomicBool>,
    scalar: PhantomData<T>,
}

impl<'a, T: Real, const D: usize, B: Dynamics<T, D>> Run<'a, T, D, B> {
    /// A run with velocity Verlet.
    ///
    /// # Errors
    /// [`Error::UnstableTimeStep`] for a fixed step above the critical one,
    /// [`Error::UnstableBody`] for a body with motions that grow at any step (unless
    /// [`TimeStep::Unchecked`]), [`Error::InvalidValue`] for a step or safety that is not positive, and what binding the
    /// loads or evaluating forces reports.
    pub fn new(body: &'a mut B, loads: Loads, rule: TimeStep) -> Result<Self> {
        Self::with_integrator(body, loads, rule, VelocityVerlet::new())
    }
}

impl<'a, T: Real, const D: usize, B: Dynamics<T, D>, I: Integrator<T, D>> Run<'a, T, D, B, I> {
    /// A run with an integrator of choice.
    ///
    /// # Errors
    /// As [`Run::new`].
    pub fn with_integrator(
        body: &'a mut B,
        loads: Loads,
        rule: TimeStep,
        integrator: I,
    ) -> Result<Self> {
        let loads = loads.bind(body)?;
        let mut run = Self {
            body,
            loads,
            integrator,
            rule,
            dt: 0.0,
            critical: None,
            broken_at_refresh: 0,
            time: 0.0,
            step: 0,
            observers: Vec::new(),
            account: None,
            keeper: None,
            stop: None,
            scalar: PhantomData,
        };
        run.choose_time_step()?;
        run.loads.place(run.body, 0.0);
        run.body.evaluate()?;
        run.loads.add_forces(run.body, 0.0);
        Ok(run)
    }

    fn choose_time_step(&mut self) -> Result<()> {
        let (TimeStep::Safety(given) | TimeStep::Fixed(given) | TimeStep::Unchecked(given)) =
            self.rule;
        Error::positive("time step Δt [s] or its safety factor", given)?;
        if let TimeStep::Unchecked(dt) = self.rule {
            self.dt = dt;
            return Ok(());
        }
        let found = spectrum(self.body)?;
        if self.step == 0 {
            require_stable(self.body, &found)?;
        }
        let critical = found.critical_time_step();
        self.critical = Some(found);
        self.broken_at_refresh = self.body.broken_bonds();
        match self.rule {
            TimeStep::Safety(safety) => {
                Error::check(safety <= 1.0, "time step safety factor", safety, "at most 1")?;
                let need = "finite: without stiffness give TimeStep::Fixed";
                Error::check(critical.is_finite(), "critical time step [s]", critical, need)?;
                self.dt = safety * critical;
            }
            _ => {
                if given > critical {
                    return Err(Error::UnstableTimeStep { dt: given, critical });
                }
                self.dt = given;
            }
        }
        Ok(())
    }

    /// Calls `observer` before the first step and then every `every` steps.
    pub fn observe(&mut self, every: usize, observer: impl Observer<B> + 'a) -> &mut Self {
        self.observers.push((every.max(1), Box::new(observer)));
        self
    }
    /// Offers the state to `keeper` every `every` steps, after the observers, and when the run is
    /// [interrupted](Self::stop_on). The keeper says where it keeps it.
    pub fn keep(
        &mut self,
        every: usize,
        keeper: impl FnMut(&Kept<'_>) -> Result<String> + 'a,
    ) -> &mut Self {
        self.keeper = Some((every.max(1), Box::new(keeper)));
        self
    }
    /// Ends the run with [`Error::Interrupted`] after the step in which `flag` becomes true. The
    /// state is kept first if there is a [keeper](Self::keep).
    pub fn stop_on(&mut self, flag: &'a AtomicBool) -> &mut Self {
        self.stop = Some(flag);
        self
    }
    /// Goes on from a state that this scene's run wrote through [`keep`](Self::keep): what follows
    /// is the same to the last bit as without the interruption. Observers are not called for the
    /// step of the state, they were then.
    ///
    /// # Errors
    /// [`Error::State`] for bytes that are no whole state, the state of another scene (grid,
    /// precision, kind of material, criterion or integrator; the forces are computed anew and
    /// compared), or of a run with another fixed time step or without
    /// [energies](Self::with_energies). After an error the run must not be used.
    pub fn resume(&mut self, state: &[u8]) -> Result<()> {
        let mut state = StateReader::new(state);
        let [step, refreshed, accounts, known] = state.counts("run")?;
        let clock: Vec<f64> = state.numbers("clock", 2)?;
        let (time, dt) = (clock[0], clock[1]);
        if dt <= 0.0 {
            return Err(unlike("clock", format!("has Δt = {dt:e} s, which no run takes")));
        }
        if let TimeStep::Fixed(given) | TimeStep::Unchecked(given) = self.rule
            && given != dt
        {
            return Err(unlike("clock", format!("has Δt = {dt:e} s, this run's is {given:e} s")));
        }
        let spectrum: Vec<f64> = state.numbers("spectrum", known.min(3))?;
        let energies: Vec<f64> = state.numbers("energies", accounts.min(4))?;
        match (&mut self.account, &energies[..]) {
            (None, []) => {}
            (Some(account), &[external, power, support_kinetic, dissipated]) => {
                (account.external, account.power) = (external, power);
                account.support_kinetic = support_kinetic;
                account.dissipated.resume(dissipated);
            }
            (account, _) => {
                let (has, runs) = if account.is_none() { ("are", "not") } else { ("are not", "") };
                let reason = format!("{has} in it, but are {runs} accounted for by this run");
                return Err(unlike("energies", reason));
            }
        }
        self.integrator.restore(&mut state, self.body.u().len())?;
        let body = state.clone();
        self.body.restore(&mut state)?;
        state.finish()?;
        let kept = self.body.force().clone();
        self.body.evaluate()?;
        self.loads.add_forces(self.body, time);
        let largest = kept.as_slice().iter().fold(0.0, |m, x| x.to_f64().abs().max(m));
        let pairs = kept.as_slice().iter().zip(self.body.force().as_slice());
        let apart = pairs.fold(0.0, |m, (a, b)| (*a - *b).to_f64().abs().max(m));
        if apart > T::EPSILON.sqrt() * largest {
            let reason = format!(
                "are not those of this material and these loads: they differ by {:.1e} of the \
                 largest",
                apart / largest
            );
            return Err(unlike("forces", reason));
        }
        // A material may remember in its states how it came there.
        self.body.restore(&mut { body })?;
        if let &[largest, lowest, residual] = &spectrum[..] {
            self.critical = Some(Spectrum { largest, lowest, residual });
        }
        (self.step, self.time, self.dt, self.broken_at_refresh) = (step, time, dt, refreshed);
        Ok(())
    }
    /// Time step Δt in seconds.
    pub fn dt(&self) -> f64 {
        self.dt
    }
    /// Time t in seconds.
    pub fn time(&self) -> f64 {
        self.time
    }
    /// Steps taken.
    pub fn steps(&self) -> usize {
        self.step
    }
    /// The body.
    pub fn body(&self) -> &B {
        self.body
    }
    /// Spectrum the time step was chosen from (none for [`TimeStep::Unchecked`]).
    pub fn spectrum(&self) -> Option<Spectrum> {
        self.critical
    }
    /// Energies so far, if the run accounts for them.
    pub fn energies(&self) -> Option<Energies> {
        let account = self.account.as_ref()?;
        Some(Energies {
            kinetic: kinetic_energy(self.body),
            strain: (account.strain_energy)(self.body),
            external: account.external,
            dissipated: account.dissipated.total(),
        })
    }

    fn call_observers(&mut self, end: f64) -> Result<Flow> {
        let flow = self.show(end)?;
        let (step, time) = (self.step, self.time);
        let interrupted = self.stop.is_some_and(|flag| flag.load(Ordering::Relaxed));
        let due = |every: usize| interrupted || (step > 0 && step.is_multiple_of(every));
        let mut kept = None;
        if let Some((every, mut keeper)) = self.keeper.take() {
            if due(every) {
                self.guard()?;
                let write = |out: &mut dyn Write| self.save(out);
                kept = Some(keeper(&Kept { step, time, interrupted, write: &write })?);
            }
            self.keeper = Some((every, keeper));
        }
        if interrupted { Err(Error::Interrupted { step, time, kept }) } else { Ok(flow) }
    }

    /// Writes what [`resume`](Self::resume) reads.
    fn save(&self, out: &mut dyn Write) -> std::io::Result<()> {
        let spectrum = self.critical.map(|s| [s.largest, s.lowest, s.residual]);
        // A body without stiffness has no finite one; it is only for show.
        let spectrum = spectrum.filter(|values| values.iter().all(|x| x.is_finite()));
        let spectrum: &[f64] = spectrum.as_ref().map_or(&[], |values| values);
        let energies = self.account.as_ref().map(|account| {
            let Account { external, power, support_kinetic, dissipated, .. } = account;
            [*external, *power, *support_kinetic, dissipated.total()]
        });
        let energies: &[f64] = energies.as_ref().map_or(&[], |values| values);
        let counts = [self.step, self.broken_at_refresh, energies.len(), spectrum.len()];
        let mut state = StateWriter::new(out);
        state.counts("run", &counts)?;
        state.numbers("clock", &[self.time, self.dt])?;
        state.numbers("spectrum", spectrum)?;
        state.numbers("energies", energies)?;
        self.integrator.save(&mut state)?;
        self.body.save(&mut state)
    }

    /// Calls the observers that are due.
    fn show(&mut self, end: f64) -> Result<Flow> {
        let due = |every: usize| self.step.is_multiple_of(every);
        if !self.observers.iter().any(|(every, _)| due(*every)) {
            return Ok(Flow::Continue);
        }
        self.guard()?;
        let view = View {
            body: &*self.body,
            step: self.step,
            time: self.time,
            dt: self.dt,
            end,
            energies: self.energies(),
        };
        let mut flow = Flow::Continue;
        for (every, observer) in &mut self.observers {
            if self.step.is_multiple_of(*every) && observer.observe(&view)? == Flow::Stop {
                flow = Flow::Stop;
            }
        }
        Ok(flow)
    }

    /// Runs until time `end` in seconds (the last step may pass it by less than Δt).
    ///
    /// # Errors
    /// [`Error::NotFinite`] and [`Error::BlowUp`] with step, time and node; loads that are not finite
    /// at some time; [`Error::Interrupted`] if [asked to stop](Self::stop_on); what observers and the evaluation of forces report.
    pub fn until(&mut self, end: f64) -> Result<()> {
        Error::check(end.is_finite(), "end time [s]", end, "finite")?;
        if self.step == 0 && self.call_observers(end)? == Flow::Stop {
            return Ok(());
        }
        while self.time < end * (1.0 - 1e-12) {
            self.advance()?;
            if self.call_observers(end)? == Flow::Stop {
                break;
            }
        }
        Ok(())
    }

    /// Takes `steps` steps.
    ///
    /// # Errors
    /// As [`Run::until`].
    pub fn steps_more(&mut self, steps: usize) -> Result<()> {
        let end = self.time + steps as f64 * self.dt;
        if self.step == 0 && self.call_observers(end)? == Flow::Stop {
            return Ok(());
        }
        for _ in 0..steps {
            self.advance()?;
            if self.call_observers(end)? == Flow::Stop {
                break;
            }
        }
        Ok(())
    }

    fn advance(&mut self) -> Result<()> {
        self.step += 1;
        let clock = Clock { step: self.step, time: self.time, dt: self.dt };
        let located = |error: Error| error.at(clock.step, clock.time + clock.dt);
        self.loads.require_finite(clock.time, clock.dt).map_err(located)?;
        let tally = match &mut self.account {
            Some(account) => {
                account.dissipated.start(self.dt);
                self.integrator
                    .step(self.body, &self.loads, clock, &mut *account.dissipated)
                    .map_err(located)?
            }
            None => {
                self.integrator.step(self.body, &self.loads, clock, &mut ()).map_err(located)?
            }
        };
        self.time += self.dt;
        let _ = tally;
        if let Some(account) = &mut self.account {
            let power = self.loads.power(self.body, self.time);
            let inertia = self.loads.support_kinetic_energy(self.body);
            account.external +=
                0.5 * (account.power + power) * self.dt + (inertia - account.support_kinetic);
            account.power = power;
            account.support_kinetic = inertia;
        }
        if self.step.is_multiple_of(GUARD) {
            self.guard()?;
        }
        let broken = self.body.broken_bonds();
        if matches!(self.rule, TimeStep::Safety(_))
            && broken > self.broken_at_refresh
            && self.step.is_multiple_of(REFRESH)
        {
            let before = self.dt;
            self.choose_time_step()?;
            self.dt = self.dt.min(before);
        }
        Ok(())
    }

    /// Ends the run on values that are not finite, and on nodes that move by more than a horizon
    /// in one step.
    fn guard(&self) -> Result<()> {
        let horizon = self.body.horizon();
        for node in 0..self.body.nodes() {
            let site = self.body.site(node);
            let speed = self.body.v().get(site).map(Real::to_f64).norm();
            let moved = self.body.u().get(site).map(Real::to_f64).norm();
            let (step, time) = (self.step, self.time);
            if !(speed.is_finite() && moved.is_finite()) {
                return Err(Error::NotFinite { node, step, time });
            }
            if speed * self.dt > horizon {
                let speed = speed * self.body.unit();
                return Err(Error::BlowUp { node, step, time, speed });
            }
        }
        Ok(())
    }
}

impl<'a, T, const D: usize, F, M, P, I> Run<'a, T, D, Body<T, D, F, M, P>, I>
where
    T: Real,
    F: Family<T, D>,
    M: StrainEnergy<T, D>,
    P: DamagePolicy<T, D, M>,
    I: Integrator<T, D>,
{
    /// Accounts for kinetic, strain, external and dissipated energy from here on.
    pub fn with_energies(mut self) -> Self {
        self.account = Some(Account {
            strain_energy: |body| body.strain_energy(),
            dissipated: Box::new(Dissipation::default()),
            external: 0.0,
            power: self.loads.power(self.body, self.time),
            support_kinetic: self.loads.support_kinetic_energy(self.body),
        });
        self
    }
}

impl<T: Real, const D: usize, B: Dynamics<T, D>> Run<'_, T, D, B, DynamicRelaxation<T, D>> {
    /// Relaxes to equilibrium under the loads of time `time` and breaks bonds there until none
    /// breaks any more: one load step. Equilibrium is where the forces out of balance are at most
    /// `tolerance` times the largest loads so far (root of the sum of squares, reactions and body
    /// forces).
    ///
    /// Bonds are tested in equilibrium only, so that no overshoot of the relaxation breaks them.
    /// Observers are called once at the end; they count load steps by [`View::step`]. Energies are not
    /// accounted for.
    ///
    /// # Errors
    /// [`Error::NotRelaxed`] after `most` steps, [`Error::InvalidValue`] for a prescribed velocity
    /// (prescribe the displacement), and what the evaluation of forces and the observers report.
    pub fn relax(&mut self, time: f64, tolerance: f64, most: usize) -> Result<Relaxed> {
        Error::positive("tolerance of the residual", tolerance)?;
        let moving = self.loads.velocities();
        let need = "0 in a relaxation: prescribe displacements";
        Error::check(moving == 0, "number of prescribed velocities", moving as f64, need)?;
        let before = self.body.broken_bonds();
        if before > self.broken_at_refresh && matches!(self.rule, TimeStep::Safety(_)) {
            self.choose_time_step()?;
        }
        self.step += 1;
        self.time = time;
        self.integrator.restart(self.body);
        // The load step is placed first; forces of the first step are those of the new loads.
        self.loads.place(self.body, time);
        self.body.evaluate()?;
        self.loads.add_forces(self.body, time);
        for steps in 1..=most {
            let clock = Clock { step: steps, time: time - self.dt, dt: self.dt };
            let located = |error: Error| error.at(steps, time);
            self.integrator.advance(self.body, &self.loads, clock, None).map_err(located)?;
            let residual = self.integrator.residual(self.body, &self.loads, time);
            if !residual.is_finite() {
                self.guard()?;
            }
            if residual <= tolerance {
                let tally = self.body.evaluate_and_break(0, &mut ()).map_err(located)?;
                self.loads.add_forces(self.body, time);
                if tally.broken == 0 {
                    let broken = self.body.broken_bonds() - before;
                    self.call_observers(time)?;
                    return Ok(Relaxed { steps, residual, broken });
                }
                self.integrator.restart(self.body);
            }
        }
        let residual = self.integrator.residual(self.body, &self.loads, time);
        Err(Error::NotRelaxed { steps: most, residual, tolerance })
    }
}

/// ½ Σ ρ V v² in J.
pub fn kinetic_energy<T: Real, const D: usize>(body: &impl Dynamics<T, D>) -> f64 {
    let unit2 = body.unit().powi(2);
    let mut energy = 0.0;
    for node in 0..body.nodes() {
        let v = body.v().get(body.site(node)).map(Real::to_f64);
        energy += 0.5 * body.mass(node) * v.norm_squared() * unit2;
    }
    energy
}

/// Force in N that the supports of a node set must exert against the body, −Σ f V.
pub fn reaction<T: Real, const D: usize>(
    body: &impl Dynamics<T, D>,
    nodes: &crate::grid::NodeSet,
) -> nalgebra::SVector<f64, D> {
    nodes.iter().fold(nalgebra::SVector::zeros(), |sum, node| {
        let f = body.force().get(body.site(node)).map(Real::to_f64) / body.unit();
        sum - f * body.volume(node)
    })
}
