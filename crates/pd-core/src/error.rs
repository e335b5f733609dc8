//! What can go wrong, with the numbers that say why.

/// Result of every fallible call of this crate.
pub type Result<X, E = Error> = std::result::Result<X, E>;

/// Error of `pd-core`. Every variant names the value or the node and what to do.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A number is outside its admissible range.
    #[error("{what} is {value}, but must be {need}")]
    InvalidValue {
        /// The quantity, with its symbol.
        what: &'static str,
        /// The value given.
        value: f64,
        /// The admissible range.
        need: &'static str,
    },
    /// A number belonging to a node is outside its admissible range.
    #[error("{what} of node {node} is {value}, but must be {need}")]
    InvalidNodeValue {
        /// The node.
        node: usize,
        /// The quantity, with its symbol.
        what: &'static str,
        /// The value given.
        value: f64,
        /// The admissible range.
        need: &'static str,
    },
    /// No cell centre lies in the shape.
    #[error("no cell centre lies in the shape with a spacing of {spacing:?} m: use a finer one")]
    EmptyGrid {
        /// Edges of a cell in metres.
        spacing: Vec<f64>,
    },
    /// A node set selects nothing.
    #[error("node set '{name}' has no nodes: compare its place with the positions of the nodes")]
    EmptySet {
        /// Name of the set.
        name: String,
    },
    /// There is no node set of this name.
    #[error("there is no node set '{name}'; there are {known:?}")]
    UnknownSet {
        /// The name asked for.
        name: String,
        /// The names there are.
        known: Vec<String>,
    },
    /// Two nodes are at the same place.
    #[error("nodes {} and {} are both at {position:?} m: remove one", nodes[0], nodes[1])]
    CoincidentNodes {
        /// The nodes.
        nodes: [usize; 2],
        /// Where, in metres.
        position: Vec<f64>,
    },
    /// The vertices of a crack polygon are not in one plane.
    #[error(
        "vertex {vertex} of the crack is {distance:e} m off its mean plane (at most {tolerance:e} \
         m): use several plane polygons"
    )]
    NotPlanar {
        /// The vertex, from 0.
        vertex: usize,
        /// Its distance from the plane, in metres.
        distance: f64,
        /// The largest distance accepted, in metres.
        tolerance: f64,
    },
    /// The outline of a crack polygon crosses or touches itself.
    #[error("edges {} and {} of the crack polygon meet: use several simple polygons", edges[0], edges[1])]
    EdgesMeet {
        /// The edges, by the number of their first vertex.
        edges: [usize; 2],
    },
    /// A crack passes through a node.
    #[error(
        "the crack passes through node {node} at {position:?} m, so its side would be chance: shift \
         the crack by {shift:?} m to pass between nodes"
    )]
    CrackThroughNode {
        /// The node.
        node: usize,
        /// Its position in metres.
        position: Vec<f64>,
        /// The shift along its normal that keeps the crack furthest from all nodes, in metres.
        shift: Vec<f64>,
    },
    /// A node has no neighbour within its horizon.
    #[error(
        "node {node} at {position:?} m has no neighbour within its horizon of {horizon:e} m: \
         enlarge the horizon, refine around it, or remove the node"
    )]
    EmptyFamily {
        /// The node.
        node: usize,
        /// Its reference position in metres.
        position: Vec<f64>,
        /// Its horizon in metres.
        horizon: f64,
    },
    /// The shape tensor of a node cannot be inverted.
    #[error(
        "the shape tensor of node {node} has condition number {condition:e} (limit {limit:e}) with \
         {neighbours} weighted neighbours: its bonds do not span the space. Use a larger horizon \
         (the linear influence function gives bonds of length δ no weight, so m = 1 is singular), \
         or the policy that detaches such nodes or inverts only the well-conditioned directions"
    )]
    SingularShapeTensor {
        /// The node.
        node: usize,
        /// Its condition number (infinite if singular).
        condition: f64,
        /// The largest one accepted.
        limit: f64,
        /// Neighbours with weight.
        neighbours: usize,
    },
    /// A node's deformation gradient has a determinant that is not positive.
    #[error(
        "the deformation of node {node} is inverted: J = det F = {det:e}. Take a smaller time step, \
         a slower load or a criterion that breaks bonds earlier"
    )]
    Inverted {
        /// The node.
        node: usize,
        /// J.
        det: f64,
    },
    /// A component of a node is prescribed twice.
    #[error("component {axis} of node {node} is prescribed by two conditions: keep one of them")]
    ConflictingConditions {
        /// The node.
        node: usize,
        /// The component.
        axis: usize,
    },
    /// A node of a boundary layer has no mirror image inside the body.
    #[error(
        "node {node} of a boundary layer has no mirror image of its own in the body (it would be at \
         {image:?} m): put the face between two rows of nodes or on one, and make the body at \
         least as thick behind it as the layer"
    )]
    NoImage {
        /// The node.
        node: usize,
        /// Its mirror image, in metres.
        image: Vec<f64>,
    },
    /// A time step above the body's critical one.
    #[error(
        "time step {dt:e} s is above the critical step {critical:e} s of this body: the run would \
         blow up. Use TimeStep::Safety, a smaller step, or TimeStep::Unchecked if you mean it"
    )]
    UnstableTimeStep {
        /// The step asked for, in seconds.
        dt: f64,
        /// The critical step, in seconds.
        critical: f64,
    },
    /// The force constants of a material are not those of an elastic bulk lattice.
    #[error("the force constants break {rule} (by {relative:e} of the largest one)")]
    ForceConstants {
        /// The rule, and what it asks of the material.
        rule: &'static str,
        /// The violation, relative to the largest force constant.
        relative: f64,
    },
    /// A material amplifies plane waves on its lattice.
    #[error(
        "this material amplifies the plane wave k = {wave:?} 1/m with growth rate {growth_rate:e} \
         1/s (ω² = {eigenvalue:e} 1/s²): a run would blow up at any time step. Use a calibration \
         that is stable for this stiffness, or another horizon or influence function"
    )]
    UnstableMaterial {
        /// ω² in 1/s².
        eigenvalue: f64,
        /// Wave vector k in 1/m.
        wave: Vec<f64>,
        /// √(−ω²) in 1/s.
        growth_rate: f64,
    },
    /// A body with a motion that grows at any time step.
    #[error(
        "this body has a negative ω² = {eigenvalue:e} 1/s²: a motion like the plane wave k = \
         {wave:?} 1/m grows at a rate of {growth_rate:e} 1/s or more, so a run would blow up at any \
         time step. Use a calibration that is stable for this stiffness (`PositiveSplit` is for \
         all), or another horizon or influence function; `Symbol::stability` tells whether the \
         infinite lattice has it too. TimeStep::Unchecked runs the body as it is"
    )]
    UnstableBody {
        /// An upper bound of the smallest ω² in 1/s².
        eigenvalue: f64,
        /// Wave vector k in 1/m that the motion has most of.
        wave: Vec<f64>,
        /// √(−ω²) in 1/s.
        growth_rate: f64,
    },
    /// A displacement or velocity is NaN or infinite.
    #[error(
        "displacement or velocity of node {node} is not finite at step {step}, t = {time:e} s: the \
         run is unstable (time step, material) or a load is not finite"
    )]
    NotFinite {
        /// The node.
        node: usize,
        /// Steps taken.
        step: usize,
        /// Time in seconds.
        time: f64,
    },
    /// A node moves by more than its horizon in one step.
    #[error(
        "node {node} moves by more than a horizon in one step ({speed:e} m/s at step {step}, \
         t = {time:e} s): the run blows up; take a smaller time step or check the material's symbol"
    )]
    BlowUp {
        /// The node.
        node: usize,
        /// Steps taken.
        step: usize,
        /// Time in seconds.
        time: f64,
        /// Speed of the node in m/s.
        speed: f64,
    },
    /// A static problem whose operator is not positive definite.
    #[error(
        "the static operator is not positive definite: the direction of iteration {iteration}, \
         largest at node {node}, has the curvature pᵀKp/pᵀp = {curvature:e} Pa/m²; the body's softest \
         motion is most like the wave k = {wave:?} 1/m. Either the material amplifies that wave \
         (`Symbol::of(…).stability()` tells; the positive split amplifies none), or it has zero-energy modes (add a control), or a part hangs by too few \
         bonds"
    )]
    IndefiniteOperator {
        /// pᵀKp/pᵀp in Pa/m²: zero or negative.
        curvature: f64,
        /// The node where p is largest.
        node: usize,
        /// Wave vector in 1/m that the body's softest motion has most of.
        wave: Vec<f64>,
        /// Iterations done.
        iteration: usize,
    },
    /// A static problem with a part that can move without deforming.
    #[error(
        "the part of {nodes} nodes around node {node} is free for a {motion}: prescribe enough \
         displacements to hold it"
    )]
    FreeRigidMotion {
        /// A node of the part.
        node: usize,
        /// Nodes connected by bonds with it.
        nodes: usize,
        /// The free motion.
        motion: String,
    },
    /// The residual is small but says nothing about the displacements.
    #[error(
        "the static solver reached a relative residual of {residual:e}, but with a smallest \
         eigenvalue of {softest:e} of the preconditioned operator the displacements may be off by \
         {error:.1} of themselves in the norm of energy: ask for a smaller tolerance, use f64, or \
         look for parts that are barely held"
    )]
    IllConditioned {
        /// The estimate of ‖u − u*‖/‖u‖ in the norm of energy.
        error: f64,
        /// ‖r‖/‖r₀‖.
        residual: f64,
        /// λ.
        softest: f64,
    },
    /// The iteration ended before the residual was small enough.
    #[error(
        "the static solver stopped at a relative residual of {residual:e} (asked for \
         {tolerance:e}) after {iterations} iterations: allow more, ask for less accuracy (rounding \
         limits single precision to about 1e-4), or look for parts that are barely held"
    )]
    NotConverged {
        /// ‖r‖/‖r₀‖.
        residual: f64,
        /// The value asked for.
        tolerance: f64,
        /// Iterations done.
        iterations: usize,
    },
    /// Another error, with the step and time at which it happened.
    #[error("at step {step}, t = {time:e} s: {source}")]
    During {
        /// Number of the step.
        step: usize,
        /// Time in seconds.
        time: f64,
        /// What happened.
        source: Box<Error>,
    },
    /// A relaxation has not come to rest.
    #[error(
        "after {steps} steps of relaxation the forces out of balance are {residual:e} of the loads \
         (asked for: {tolerance:e}): allow more steps, or a body that falls apart has no equilibrium"
    )]
    NotRelaxed {
        /// Steps taken.
        steps: usize,
        /// Forces out of balance over the loads.
        residual: f64,
        /// The ratio asked for.
        tolerance: f64,
    },
    /// Bonds of a body without damage cannot be cut.
    #[error(
        "this body holds no bond bits (NoDamage): make it with Precracked or Breaking to cut bonds"
    )]
    NoBits,
    /// A run was asked to stop before its end.
    #[error(
        "interrupted after step {step}, t = {time:e} s{}",
        kept.as_ref().map_or_else(
            || ": the state was not kept".to_owned(),
            |place| format!(": the state is in {place}, from which Checkpoint::resume goes on")
        )
    )]
    Interrupted {
        /// Steps taken.
        step: usize,
        /// Time in seconds.
        time: f64,
        /// Where the state is kept, if it is.
        kept: Option<String>,
    },
    /// A kept state is not one of this scene.
    #[error(
        "the state does not fit this run: its part '{part}' {reason}. Build body, loads and run as \
         they were when it was kept"
    )]
    State {
        /// The part.
        part: &'static str,
        /// What does not fit.
        reason: String,
    },
    /// An observer or output failed.
    #[error("{0}")]
    Other(String),
}

impl Error {
    /// `value` if `ok`, else [`Error::InvalidValue`].
    pub fn check(ok: bool, what: &'static str, value: f64, need: &'static str) -> Result<f64> {
        if ok { Ok(value) } else { Err(Self::InvalidValue { what, value, need }) }
    }

    /// This error, located in a run.
    pub(crate) fn at(self, step: usize, time: f64) -> Self {
        Self::During { step, time, source: Box::new(self) }
    }

    /// `value` if it is finite and positive.
    ///
    /// # Errors
    /// [`Error::InvalidValue`] otherwise.
    pub fn positive(what: &'static str, value: f64) -> Result<f64> {
        Self::check(value.is_finite() && value > 0.0, what, value, "finite and positive")
    }
}
