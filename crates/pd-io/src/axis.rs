//! Axes: where a value lies between the ends, and labels that tell its neighbours apart.

/// Axis of a chart or colour bar, for any finite ends.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Axis {
    scale: Scale,
    /// Ends, as coordinates.
    low: f64,
    high: f64,
}

/// How a value becomes a coordinate.
#[derive(Debug, Clone, Copy)]
enum Scale {
    /// v · 10^power: the difference of two coordinates neither overflows nor vanishes.
    Linear { power: i32 },
    /// log₁₀ v.
    Log,
}

/// Power of ten that brings values up to `largest` where sums and quotients are safe.
pub(crate) fn safe_power(largest: f64) -> i32 {
    match largest {
        v if v > 1e280 => -30,
        v if v > 0.0 && v < 1e-280 => 200,
        _ => 0,
    }
}

/// Least and largest value.
pub(crate) fn extremes(values: impl Iterator<Item = f64>) -> (f64, f64) {
    values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)))
}

impl Axis {
    /// Between two values; equal ones become the middle.
    pub(crate) fn linear(low: f64, high: f64) -> Self {
        let scale = Scale::Linear { power: safe_power(low.abs().max(high.abs())) };
        let (low, high) = (scale.coordinate(low), scale.coordinate(high));
        let wider = if low == 0.0 { 1.0 } else { low.abs() };
        Self { scale, low, high }.apart(wider)
    }
    /// Logarithmic, between two positive values.
    pub(crate) fn log(low: f64, high: f64) -> Self {
        let scale = Scale::Log;
        Self { scale, low: scale.coordinate(low), high: scale.coordinate(high) }.apart(0.5)
    }
    fn apart(self, wider: f64) -> Self {
        if self.high > self.low { self } else { self.padded(wider, wider) }
    }
    fn padded(self, below: f64, above: f64) -> Self {
        Self { low: self.low - below, high: self.high + above, ..self }
    }
    /// With room beyond the ends, as shares of the length.
    pub(crate) fn with_room(self, below: f64, above: f64) -> Self {
        let length = self.high - self.low;
        self.padded(below * length, above * length)
    }
    /// Share of the axis below a value: 0 at the low end, 1 at the high end.
    pub(crate) fn place(&self, value: f64) -> f64 {
        (self.scale.coordinate(value) - self.low) / (self.high - self.low)
    }
    /// Five places, the ends among them, and their labels (only the ends of an axis so short that
    /// rounding leaves nothing between).
    pub(crate) fn quarters(&self) -> Vec<(f64, String)> {
        let value = |t: f64| self.low + t * (self.high - self.low);
        let five = [0.0, 0.25, 0.5, 0.75, 1.0];
        let apart = five.windows(2).all(|t| value(t[0]) < value(t[1]));
        let places = if apart { &five[..] } else { &[0.0, 1.0] };
        let values: Vec<f64> = places.iter().map(|&t| value(t)).collect();
        places.iter().copied().zip(self.scale.labels(&values)).collect()
    }
    /// About `count` round values: place and label.
    pub(crate) fn ticks(&self, count: usize) -> Vec<(f64, String)> {
        let ticks = match self.scale {
            Scale::Linear { .. } => {
                let values = round_values(self.low, self.high, count);
                let labels = self.scale.labels(&values);
                values.into_iter().zip(labels).collect()
            }
            Scale::Log if self.high.floor() > self.low.ceil() => {
                let (first, last) = (self.low.ceil() as i32, self.high.floor() as i32);
                let stride = (last - first) as usize / count + 1;
                (first..=last).step_by(stride).map(|d| (f64::from(d), format!("1e{d}"))).collect()
            }
            // Not two decades to label: round values between them.
            Scale::Log => Self::log_between_decades(self.low, self.high, count),
        };
        let place = |at: f64| (at - self.low) / (self.high - self.low);
        let ticks = ticks.into_iter().map(|(at, label)| (place(at), label));
        ticks.filter(|(place, _)| (-1e-9..=1.0 + 1e-9).contains(place)).collect()
    }
    fn log_between_decades(low: f64, high: f64, count: usize) -> Vec<(f64, String)> {
        // Powers of ten are taken near 1, where none overflows.
        let power = low.floor();
        let values = round_values(10_f64.powf(low - power), 10_f64.powf(high - power), count);
        let labels = Scale::Linear { power: -power as i32 }.labels(&values);
        values.iter().map(|v| v.log10() + power).zip(labels).collect()
    }
}

impl Scale {
    fn coordinate(self, value: f64) -> f64 {
        match self {
            Self::Linear { power } => value * 10_f64.powi(power),
            Self::Log => value.log10(),
        }
    }
    /// Labels of values at increasing coordinates of a linear axis, in as few digits as tell them
    /// to a fiftieth of the gap between neighbours.
    fn labels(self, at: &[f64]) -> Vec<String> {
        let power = match self {
            Self::Linear { power } => power,
            Self::Log => 0,
        };
        let gap = at.windows(2).map(|w| w[1] - w[0]).fold(f64::INFINITY, f64::min);
        let fits = |&digits: &usize| {
            at.iter().all(|&v| {
                let told: f64 = number(v, digits, 0).parse().unwrap_or(f64::NAN);
                (told - v).abs() <= 0.02 * gap
            })
        };
        let digits = (3..17).find(fits).unwrap_or(17);
        at.iter().map(|&v| number(v, digits, -power)).collect()
    }
}

/// v · 10^power in `digits` significant digits.
fn number(value: f64, digits: usize, power: i32) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    let trimmed = |text: &str| match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
        false => text.to_owned(),
    };
    let text = format!("{value:.0$e}", digits - 1);
    let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    let exponent = exponent.parse().unwrap_or(0) + power;
    if (-2..4).contains(&exponent) {
        let decimals = (digits as i32 - 1 - exponent).max(0) as usize;
        trimmed(&format!("{:.decimals$}", value * 10_f64.powi(power)))
    } else {
        format!("{}e{exponent}", trimmed(mantissa))
    }
}

/// Round numbers that divide a range into about `count` parts.
fn round_values(low: f64, high: f64, count: usize) -> Vec<f64> {
    let raw = (high - low) / count as f64;
    let power = 10_f64.powf(raw.log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0].into_iter().map(|s| s * power).find(|s| *s >= raw);
    let step = step.unwrap_or(raw);
    let first = (low / step - 1e-9).ceil() as i64;
    let last = (high / step + 1e-9).floor() as i64;
    let mut values: Vec<f64> = (first..=last).map(|k| k as f64 * step).collect();
    // Where the step is below the rounding of the values.
    values.dedup();
    values
}
