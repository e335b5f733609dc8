//! The scalar of a simulation: `f32` or `f64`.

/// Scalar type of the hot arrays. Geometry and constants are computed in `f64` and cast once.
pub trait Real: nalgebra::RealField + Copy + Default {
    /// Name for reports: `"f32"` or `"f64"`.
    const NAME: &'static str;
    /// Rounding unit, ε.
    const EPSILON: f64;
    /// Numbers in a vector register of 64 bytes: nodes that a lattice kernel handles together.
    const WIDTH: usize;
    /// True for 16 numbers, false for 8.
    const WIDE: bool = Self::WIDTH == 16;
    /// Coefficients, from the constant on, of the polynomials p and q with 1 − (1+t)^(−½) = t p(t)
    /// and (1+t)^½ − 1 = t q(t) for |t| ≤ [`Bond::SMALL`](crate::Bond::SMALL): they interpolate in
    /// the Chebyshev points of that range, of the lowest degree whose relative error (4·10⁻¹⁷ and
    /// 2·10⁻¹⁸ in `f64`, 1.3·10⁻⁹ and 7·10⁻⁹ in `f32`) stays below half a unit in the last place.
    const STRETCH: [&'static [Self]; 2];
    /// The nearest value of this type.
    fn of(x: f64) -> Self;
    /// The value in double precision (exact).
    fn to_f64(self) -> f64;
    /// a · b + c, rounded once. Fast only where the processor has it: see [`Bond::fma`].
    ///
    /// [`Bond::fma`]: crate::Bond::fma
    fn fused(a: Self, b: Self, c: Self) -> Self;
}

macro_rules! real {
    ($t:ty, $name:literal, $lanes:literal, $p:expr, $q:expr) => {
        impl Real for $t {
            const NAME: &'static str = $name;
            const EPSILON: f64 = <$t>::EPSILON as f64;
            const WIDTH: usize = $lanes;
            const STRETCH: [&'static [Self]; 2] = [&$p, &$q];
            #[inline(always)]
            fn of(x: f64) -> Self {
                x as $t
            }
            #[inline(always)]
            fn to_f64(self) -> f64 {
                f64::from(self)
            }
            #[inline(always)]
            fn fused(a: Self, b: Self, c: Self) -> Self {
                a.mul_add(b, c)
            }
        }
    };
}
real!(
    f32,
    "f32",
    16,
    [0.5, -0.374_999_94, 0.312_499_94, -0.273_713_1, 0.246_349_68],
    [0.5, -0.125, 0.062_526_71, -0.039_082_54]
);
real!(
    f64,
    "f64",
    8,
    [
        0.5,
        -0.374_999_999_999_994_34,
        0.312_499_999_999_994_6,
        -0.273_437_500_077_069_8,
        0.246_093_750_073_567_68,
        -0.225_585_653_441_383_45,
        0.209_472_385_099_637_42,
        -0.196_768_286_337_260_9,
        0.185_840_634_378_865_22,
    ],
    [
        0.5,
        -0.124_999_999_999_999_71,
        0.062_499_999_999_999_74,
        -0.039_062_500_004_054_94,
        0.027_343_750_003_502_126,
        -0.020_507_797_554_129_306,
        0.016_113_268_341_746_034,
        -0.013_112_440_000_025_37,
        0.010_927_651_958_395_687,
    ]
);
