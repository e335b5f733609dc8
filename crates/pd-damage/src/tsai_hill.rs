//! Tsai–Hill (Hattori Eqs. 26–29): a quadratic criterion on the stress in the fibre's frame.

use nalgebra::{SMatrix, SVector, Vector3};
use pd_core::damage::{DamageCriterion, TestedBond};
use pd_core::{Error, Real, Result, StressState};

/// Strengths of a ply in Pa.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Strengths {
    /// Along the fibre, σ_Lu.
    pub along: f64,
    /// Across the fibre, σ_Tu.
    pub across: f64,
    /// In shear, τ_LTu.
    pub shear: f64,
}

/// Strengths of a transversely isotropic solid in Pa; the shear strength in the isotropic plane
/// follows from the others, 1/S_TT² = 4/σ_Tu² − 1/σ_Lu².
pub type Strengths3 = Strengths;

/// What the sign of a normal stress means.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Signs {
    /// Compression breaks as tension does (Eq. 26 as printed).
    #[default]
    Equal,
    /// Compressive normal stresses do not count.
    TensionOnly,
    /// Compressive strengths of their own in Pa.
    Compression {
        /// Along the fibre.
        along: f64,
        /// Across the fibre.
        across: f64,
    },
}

/// 1/strength², by sign of the stress.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Limit {
    tension: f64,
    compression: f64,
}

impl Limit {
    #[inline(always)]
    fn of<T: Real>(&self, stress: T) -> T {
        if stress >= T::zero() { T::of(self.tension) } else { T::of(self.compression) }
    }
}

/// The three limits 1/strength².
#[derive(Debug, Clone, Copy, PartialEq)]
struct Limits {
    along: Limit,
    across: Limit,
    shear: f64,
}

impl Limits {
    fn new(strengths: &Strengths, signs: Signs) -> Result<Self> {
        let square = |what: &'static str, value: f64| -> Result<f64> {
            Ok(Error::positive(what, value)?.powi(-2))
        };
        let along = square("strength along the fibre σ_Lu [Pa]", strengths.along)?;
        let across = square("strength across the fibre σ_Tu [Pa]", strengths.across)?;
        let (c_along, c_across) = match signs {
            Signs::Equal => (along, across),
            Signs::TensionOnly => (0.0, 0.0),
            Signs::Compression { along, across } => (
                square("compressive strength along the fibre [Pa]", along)?,
                square("compressive strength across the fibre [Pa]", across)?,
            ),
        };
        Ok(Self {
            along: Limit { tension: along, compression: c_along },
            across: Limit { tension: across, compression: c_across },
            shear: square("shear strength τ_LTu [Pa]", strengths.shear)?,
        })
    }
}

/// sin²ψ₀ of [`TsaiHill::with_bridging_fibres`], ψ₀ = 30°: every fibre has bonds of a square lattice
/// well within that.
const BRIDGING: f64 = 0.25;

/// What the matrix part of the criterion weighs for a bond at the angle ψ to the fibre, from
/// cos²ψ: min(1, sin²ψ/sin²ψ₀) where fibres bridge, else 1.
#[inline(always)]
fn matrix_share<T: Real>(bridging: bool, cos2: T) -> T {
    let share = (T::one() - cos2) * T::of(1.0 / BRIDGING);
    if bridging && share < T::one() { share } else { T::one() }
}

/// Tsai–Hill in 2D: with the mean stress of the two ends of the bond in the fibre's frame
/// ([`StressState::bond_stress`]: that of the nodes unless the material tells its bonds apart),
/// (σ_L/σ_Lu)² + (σ_T/σ_Tu)² − σ_Lσ_T/σ_Lu² + (τ/τ_u)² > 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TsaiHill {
    limits: Limits,
    cos: f64,
    sin: f64,
    bridging: bool,
}

impl TsaiHill {
    /// With the fibre at `angle` (radians) counter-clockwise from x.
    ///
    /// # Errors
    /// [`Error::InvalidValue`] for a strength that is not positive or an angle that is not finite.
    pub fn new(strengths: &Strengths, angle: f64) -> Result<Self> {
        Self::with_signs(strengths, angle, Signs::Equal)
    }
    /// As [`new`](Self::new), with a rule for compression.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn with_signs(strengths: &Strengths, angle: f64, signs: Signs) -> Result<Self> {
        Error::check(angle.is_finite(), "fibre angle [rad]", angle, "finite")?;
        let (sin, cos) = angle.sin_cos();
        Ok(Self { limits: Limits::new(strengths, signs)?, cos, sin, bridging: false })
    }
    /// Matrix failure spares the bonds along the fibre: the terms of σ_T and τ weigh
    /// min(1, sin²ψ/sin²ψ₀), ψ₀ = 30°, for a bond at the angle ψ to the fibre. A matrix crack
    /// runs between fibres and severs what crosses it. As printed (the default) it severs the
    /// fibres too, so that a crack may run on straight through them.
    #[must_use]
    pub fn with_bridging_fibres(mut self) -> Self {
        self.bridging = true;
        self
    }
    /// (σ_L, σ_T, τ_LT) of a stress (Eqs. 28, 29).
    #[inline(always)]
    pub fn in_fibre_frame<T: Real>(&self, s: &SMatrix<T, 2, 2>) -> (T, T, T) {
        let (c, n) = (T::of(self.cos), T::of(self.sin));
        let two = T::of(2.0);
        let along = s[(0, 0)] * c * c + s[(1, 1)] * n * n + two * s[(0, 1)] * c * n;
        let across = s[(0, 0)] * n * n + s[(1, 1)] * c * c - two * s[(0, 1)] * c * n;
        let shear = (s[(1, 1)] - s[(0, 0)]) * c * n + s[(0, 1)] * (c * c - n * n);
        (along, across, shear)
    }
    /// The left side of Eq. 26.
    #[inline(always)]
    pub fn value<T: Real>(&self, stress: &SMatrix<T, 2, 2>) -> T {
        let (fibre, matrix) = self.parts(stress);
        fibre + matrix
    }
    /// The terms with σ_L and those of the matrix, (σ_T/σ_Tu)² + (τ/τ_u)².
    #[inline(always)]
    pub fn parts<T: Real>(&self, stress: &SMatrix<T, 2, 2>) -> (T, T) {
        let (l, t, tau) = self.in_fibre_frame(stress);
        let (wl, wt) = (self.limits.along.of(l), self.limits.across.of(t));
        (l * l * wl - l * t * wl, t * t * wt + tau * tau * T::of(self.limits.shear))
    }
}

/// Mean of the stresses that the two ends of a bond see.
#[inline(always)]
fn bond_stress<T: Real, const D: usize, M: StressState<T, D>>(
    tested: &TestedBond<'_, T, D, M, (), SMatrix<T, D, D>>,
) -> SMatrix<T, D, D> {
    let [near, far] = tested.ends;
    let [a, b] = tested.values;
    (tested.material.bond_stress(tested.bond, near, a)
        + tested.material.bond_stress(&tested.bond.reversed(), far, b))
        * T::of(0.5)
}

impl<T: Real, M: StressState<T, 2>> DamageCriterion<T, 2, M> for TsaiHill {
    type NodeConst = ();
    type NodeValue = SMatrix<T, 2, 2>;

    #[inline(always)]
    fn node_value(&self, material: &M, c: &M::NodeConst, s: &M::NodeState) -> SMatrix<T, 2, 2> {
        material.stress(c, s)
    }
    #[inline(always)]
    fn index(&self, tested: &TestedBond<'_, T, 2, M, (), SMatrix<T, 2, 2>>) -> T {
        let (fibre, matrix) = self.parts(&bond_stress(tested));
        let xi = tested.bond.xi;
        let along = xi[0] * T::of(self.cos) + xi[1] * T::of(self.sin);
        fibre + matrix * matrix_share(self.bridging, along * along / xi.dot(&xi))
    }
}

/// Tsai–Hill in 3D for a transversely isotropic solid with the fibre along f: with σ_L = f·σ·f,
/// the shear stresses τ_L across f and the stresses in the plane normal to f,
/// σ_L²/σ_Lu² − σ_L(σ_2 + σ_3)/σ_Lu² + (σ_2² + σ_3²)/σ_Tu² + (1/σ_Lu² − 2/σ_Tu²)σ_2σ_3
/// + τ_23²/S_TT² + |τ_L|²/τ_LTu² > 1, unchanged by any rotation about f.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TsaiHill3 {
    limits: Limits,
    fibre: Vector3<f64>,
    bridging: bool,
}

impl TsaiHill3 {
    /// With the fibre along `fibre` (any length).
    ///
    /// # Errors
    /// [`Error::InvalidValue`] for a strength or a fibre vector that is not positive.
    pub fn new(strengths: &Strengths3, fibre: [f64; 3]) -> Result<Self> {
        Self::with_signs(strengths, fibre, Signs::Equal)
    }
    /// As [`new`](Self::new), with a rule for compression (across the fibre it goes by the sign of
    /// the mean stress across).
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn with_signs(strengths: &Strengths3, fibre: [f64; 3], signs: Signs) -> Result<Self> {
        let fibre = Vector3::from(fibre);
        Error::positive("length of the fibre vector", fibre.norm())?;
        let limits = Limits::new(strengths, signs)?;
        Ok(Self { limits, fibre: fibre.normalize(), bridging: false })
    }
    /// As [`TsaiHill::with_bridging_fibres`].
    #[must_use]
    pub fn with_bridging_fibres(mut self) -> Self {
        self.bridging = true;
        self
    }
    /// The left side of the criterion.
    #[inline(always)]
    pub fn value<T: Real>(&self, stress: &SMatrix<T, 3, 3>) -> T {
        let (fibre, matrix) = self.parts(stress);
        fibre + matrix
    }
    /// The terms with σ_L and those of the matrix.
    #[inline(always)]
    pub fn parts<T: Real>(&self, s: &SMatrix<T, 3, 3>) -> (T, T) {
        let f: SVector<T, 3> = self.fibre.map(T::of);
        let traction =
            SVector::<T, 3>::from_fn(|i, _| s[(i, 0)] * f[0] + s[(i, 1)] * f[1] + s[(i, 2)] * f[2]);
        let along = traction.dot(&f);
        let shear2 = traction.dot(&traction) - along * along;
        // Invariants of the stress in the plane normal to f: σ2 + σ3 and σ2² + σ3² + 2τ23².
        let across = s.trace() - along;
        let squares = s.component_mul(s).sum() - T::of(2.0) * shear2 - along * along;
        // σ2σ3 − τ23² = ½((σ2 + σ3)² − squares); the plane's part is
        // squares/Y² + (1/X² − 2/Y²)(σ2σ3 − τ23²), as 1/S_TT² = 4/Y² − 1/X².
        let product = (across * across - squares) * T::of(0.5);
        let (wl, wt) = (self.limits.along.of(along), self.limits.across.of(across));
        let own = T::of(self.limits.along.tension);
        let coupling = if wt > T::zero() { own - wt - wt } else { T::zero() };
        (
            along * along * wl - along * across * wl,
            squares * wt + coupling * product + shear2 * T::of(self.limits.shear),
        )
    }
}

impl<T: Real, M: StressState<T, 3>> DamageCriterion<T, 3, M> for TsaiHill3 {
    type NodeConst = ();
    type NodeValue = SMatrix<T, 3, 3>;

    #[inline(always)]
    fn node_value(&self, material: &M, c: &M::NodeConst, s: &M::NodeState) -> SMatrix<T, 3, 3> {
        material.stress(c, s)
    }
    #[inline(always)]
    fn index(&self, tested: &TestedBond<'_, T, 3, M, (), SMatrix<T, 3, 3>>) -> T {
        let (fibre, matrix) = self.parts(&bond_stress(tested));
        let xi = tested.bond.xi;
        let along = xi.dot(&self.fibre.map(T::of));
        fibre + matrix * matrix_share(self.bridging, along * along / xi.dot(&xi))
    }
}
