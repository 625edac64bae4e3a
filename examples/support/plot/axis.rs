//! Ranges, ticks and tick labels of the axes of a chart.

/// Widest span of an automatic logarithmic axis, in decades.
const MAX_DECADES: f64 = 12.0;

/// One axis of a chart.
pub(super) struct Axis {
    log: bool,
    /// Ends of the axis, as common logarithms if the axis is logarithmic.
    ends: (f64, f64),
    /// Values that have a label, with that label.
    pub(super) ticks: Vec<(f64, String)>,
    /// Values that have a faint grid line only.
    pub(super) minor: Vec<f64>,
}

impl Axis {
    /// An axis over `range`, or over the finite `values` and a margin of `pad` times their span.
    pub(super) fn new(
        values: impl Iterator<Item = f64>,
        range: Option<(f64, f64)>,
        log: bool,
        pad: f64,
    ) -> Result<Self, &'static str> {
        let scale = |v: f64| if log { v.log10() } else { v };
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        if let Some(ends) = range {
            (low, high) = (scale(ends.0), scale(ends.1));
        } else {
            for value in values.map(scale).filter(|v| v.is_finite()) {
                (low, high) = (low.min(value), high.max(value));
            }
            if log {
                low = low.max(high - MAX_DECADES);
            }
            let small = if log { 0.1 } else { 1e-9 * low.abs().max(high.abs()) };
            let margin = if high - low > small {
                pad * (high - low)
            } else if log {
                0.5
            } else if high == 0.0 {
                1.0
            } else {
                0.05 * high.abs()
            };
            (low, high) = (low - margin, high + margin);
        }
        if !(low.is_finite() && high.is_finite() && low < high) {
            return Err("an axis has no values or an empty range");
        }
        Ok(Self {
            log,
            ends: (low, high),
            ticks: Vec::new(),
            minor: Vec::new(),
        })
    }

    /// The position of a value along the axis; 0 and 1 are the ends.
    pub(super) fn position(&self, value: f64) -> f64 {
        let scaled = if self.log { value.log10() } else { value };
        (scaled - self.ends.0) / (self.ends.1 - self.ends.0)
    }

    /// Chooses about `count` ticks at most.
    pub(super) fn set_ticks(&mut self, count: u32) {
        (self.ticks, self.minor) = (Vec::new(), Vec::new());
        if self.log {
            self.set_log_ticks(count);
        }
        if self.ticks.len() < 3 {
            let unscale = |v: f64| if self.log { 10_f64.powf(v) } else { v };
            self.ticks = linear_ticks(unscale(self.ends.0), unscale(self.ends.1), count);
        }
    }

    #[allow(clippy::cast_possible_truncation)]
    fn set_log_ticks(&mut self, count: u32) {
        let (first, last) = (self.ends.0.floor() as i32, self.ends.1.ceil() as i32);
        let span = self.ends.1 - self.ends.0;
        let stride = (span / f64::from(count)).ceil().max(1.0) as i32;
        let labelled: &[u8] = if span < 0.3 * f64::from(count) {
            &[1, 2, 5]
        } else {
            &[1]
        };
        let plain = self.ends.0 > -2.1 && self.ends.1 < 4.1;
        let label = |digit: u8, exponent: i32| match usize::try_from(-exponent) {
            _ if !plain => format!("{digit}e{exponent}"),
            Ok(decimals) => format!("{:.decimals$}", f64::from(digit) * 10_f64.powi(exponent)),
            Err(_) => format!("{}", f64::from(digit) * 10_f64.powi(exponent)),
        };
        for exponent in first..=last {
            for digit in 1..10 {
                let value = f64::from(digit) * 10_f64.powi(exponent);
                if !(-1e-9..1.0 + 1e-9).contains(&self.position(value)) {
                    continue;
                }
                if exponent.rem_euclid(stride) == 0 && labelled.contains(&digit) {
                    self.ticks.push((value, label(digit, exponent)));
                } else if digit == 1 || (stride == 1 && span < 7.5) {
                    self.minor.push(value);
                }
            }
        }
    }
}

/// Multiples of 1, 2 or 5 times a power of ten, at most `count` steps apart in all.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
fn linear_ticks(low: f64, high: f64, count: u32) -> Vec<(f64, String)> {
    let raw = (high - low) / f64::from(count);
    let power = raw.log10().floor();
    let unit = 10_f64.powf(power);
    let step = [1.0, 2.0, 5.0, 10.0].map(|m| m * unit);
    let step = step.into_iter().find(|s| *s >= raw * (1.0 - 1e-9)).unwrap_or(raw);
    let exponent = (step.log10() + 1e-9).floor();
    let largest = low.abs().max(high.abs());
    let plain = (1e-3..1e6).contains(&largest);
    let label = |value: f64| {
        if plain {
            format!("{value:.*}", (-exponent).max(0.0) as usize)
        } else if value == 0.0 {
            "0".to_owned()
        } else {
            let digits = (value.abs().log10() + 1e-9).floor() - exponent;
            format!("{value:.*e}", digits.max(0.0) as usize)
        }
    };
    let tolerance = 1e-6;
    let first = (low / step - tolerance).ceil();
    let steps = (high / step + tolerance).floor() - first;
    // Adding zero turns a negative zero into a positive one.
    let values = (0..=steps as u32).map(|i| (first + f64::from(i)) * step + 0.0);
    values.map(|v| (v, label(v))).collect()
}
