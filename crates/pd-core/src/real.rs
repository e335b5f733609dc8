//! The scalar of a simulation: `f32` or `f64`.

/// Scalar type of the hot arrays. Geometry and constants are computed in `f64` and cast once.
pub trait Real: nalgebra::RealField + Copy + Default {
    /// Name for reports: `"f32"` or `"f64"`.
    const NAME: &'static str;
    /// Rounding unit, ε.
    const EPSILON: f64;
    /// The nearest value of this type.
    fn of(x: f64) -> Self;
    /// The value in double precision (exact).
    fn to_f64(self) -> f64;
}

macro_rules! real {
    ($t:ty, $name:literal) => {
        impl Real for $t {
            const NAME: &'static str = $name;
            const EPSILON: f64 = <$t>::EPSILON as f64;
            #[inline(always)]
            fn of(x: f64) -> Self {
                x as $t
            }
            #[inline(always)]
            fn to_f64(self) -> f64 {
                f64::from(self)
            }
        }
    };
}
real!(f32, "f32");
real!(f64, "f64");
