//! The backbone of a decay in which one mode is left: frequency and damping against amplitude, window after window.
//!
//! Lines through zero crossings and through logarithms of extremes (Londono, Neild & Cooper 2015, doi:10.1016/j.jsv.2014.12.019). Both are
//! means of two neighbours, which a mean of the signal does not move. The standard deviations are those of the residuals of these lines.
//! From the slopes, half a period π/w and −d, follow those of modes, ω₀ = (w² + d²)^½ and ζ = d/ω₀.

use crate::texts::outcome::Outcome;
use std::f64::consts::PI;

/// Least relative deviation of a frequency, and least deviation of a damping ratio, of a signal without noise.
const LEAST: f64 = 1e-9;

/// One window of a decay.
#[derive(Clone, Copy, Debug)]
pub struct Window {
    /// Amplitude of the displacement in the middle of the window.
    pub amplitude: f64,
    /// Natural angular frequency ω₀, as modes have it, and its standard deviation.
    pub omega: [f64; 2],
    /// Damping ratio ζ and its standard deviation.
    pub damping: [f64; 2],
}

/// A line through means of neighbours.
struct Fitted {
    slope: f64,
    deviation: f64,
    /// Height at 0.
    height: f64,
}

/// Windows of `cycles` periods of a signal at equal distances of time: a displacement (`order` 0), velocity (1) or acceleration (2).
///
/// # Errors
/// A sentence: arrays of different lengths, fewer than two cycles, an order above 2, times that do not rise, too short a signal.
pub fn windows(time: &[f64], signal: &[f64], (cycles, order): (usize, i32)) -> Outcome<Vec<Window>> {
    if time.len() != signal.len() || time.len() < 10 {
        return Err(format!(
            "time and signal have {} and {} numbers, need as many of both, 10 or more",
            time.len(),
            signal.len()
        ));
    }
    if cycles < 2 {
        return Err(format!("cycles = {cycles}, needs at least 2"));
    }
    if !(0..=2).contains(&order) {
        return Err(format!(
            "component = {order}, needs 0 (displacement), 1 (velocity) or 2 (acceleration)"
        ));
    }
    for (name, values) in [("time", time), ("signal", signal)] {
        if let Some(i) = values.iter().position(|x| !x.is_finite()) {
            return Err(format!("{name}[{i}] = {}, needs finite numbers", values[i]));
        }
    }
    let step = time[1] - time[0];
    let is_even = |pair: &[f64]| ((pair[1] - pair[0]) / step - 1.0).abs() < 1e-3;
    if step <= 0.0 || !time.windows(2).all(is_even) {
        return Err("time needs equal distances that rise".into());
    }
    let before: Vec<usize> = (0..signal.len() - 1)
        .filter(|&i| signal[i] * signal[i + 1] < 0.0)
        .collect();
    let cross = |i: usize| time[i] - signal[i] * step / (signal[i + 1] - signal[i]);
    let crossings: Vec<f64> = before.iter().map(|&i| cross(i)).collect();
    let extremes: Vec<(f64, f64)> = before
        .windows(2)
        .filter_map(|pair| extreme(signal, (pair[0] + 1, pair[1] + 1)))
        .map(|(at, size)| (time[0] + step * at, size))
        .collect();
    let half_sum = |a: f64, b: f64| 0.5 * (a + b);
    let crossings: Vec<f64> = crossings.windows(2).map(|p| half_sum(p[0], p[1])).collect();
    let sizes: Vec<(f64, f64)> = extremes
        .windows(2)
        .map(|p| (half_sum(p[0].0, p[1].0), half_sum(p[0].1, p[1].1)))
        .collect();
    let mut found = Vec::new();
    let mut begin = 0;
    while begin + 2 * cycles < crossings.len() {
        let own = &crossings[begin..=begin + 2 * cycles];
        begin += 2 * cycles;
        let half = line(&own.iter().enumerate().map(|(i, t)| (i as f64, *t)).collect::<Vec<_>>());
        let (first, last) = (own[0], own[own.len() - 1]);
        let middle = half_sum(first, last);
        let within: Vec<(f64, f64)> = sizes
            .iter()
            .filter(|(t, _)| *t > first && *t < last)
            .map(|(t, size)| (t - middle, size.ln()))
            .collect();
        if within.len() < 4 {
            continue;
        }
        let rate = line(&within);
        found.push(window(&half, &rate, order));
    }
    if found.is_empty() {
        return Err("the signal has too few zero crossings for a window: needs a longer one, or fewer cycles".into());
    }
    Ok(found)
}

/// Frequency and damping ratio of modes from half a period and the rate of the amplitude's logarithm. Velocity and displacement of
/// x = exp((−d + iw) t) have the ratio ω₀.
fn window(half: &Fitted, rate: &Fitted, order: i32) -> Window {
    let turning = PI / half.slope;
    let of_turning = turning * half.deviation / half.slope;
    let omega = turning.hypot(rate.slope);
    let (cosine, zeta) = (turning / omega, -rate.slope / omega);
    let sigma = (cosine * of_turning).hypot(zeta * rate.deviation);
    let of_zeta = cosine / omega * (cosine * rate.deviation).hypot(zeta * of_turning);
    Window {
        amplitude: rate.height.exp() / omega.powi(order),
        omega: [omega, sigma.max(LEAST * omega)],
        damping: [zeta, of_zeta.max(LEAST)],
    }
}

/// Place, in samples, and size of the extreme between two crossings: that of a parabola through the samples around the largest one, a
/// sixth of half a period to both sides.
fn extreme(signal: &[f64], (a, b): (usize, usize)) -> Option<(f64, f64)> {
    let mut k = a;
    for i in a..b {
        if signal[i].abs() > signal[k].abs() {
            k = i;
        }
    }
    if k == 0 || k + 1 >= signal.len() {
        return None;
    }
    let reach = ((b - a) / 6).max(1);
    let samples = k.saturating_sub(reach)..(k + reach + 1).min(signal.len());
    // Least squares on 1, s and s², s in units of the reach.
    let (mut powers, mut of_size) = ([0.0; 5], [0.0; 3]);
    for i in samples {
        let s = (i as f64 - k as f64) / reach as f64;
        for (p, power) in powers.iter_mut().enumerate() {
            *power += s.powi(p as i32);
        }
        for (p, sum) in of_size.iter_mut().enumerate() {
            *sum += s.powi(p as i32) * signal[i].abs();
        }
    }
    let column = |p: usize| [powers[p], powers[p + 1], powers[p + 2]];
    let whole = determinant([column(0), column(1), column(2)]);
    let height = determinant([of_size, column(1), column(2)]) / whole;
    let rise = determinant([column(0), of_size, column(2)]) / whole;
    let bend = determinant([column(0), column(1), of_size]) / whole;
    let shift = if bend < 0.0 {
        (-0.5 * rise / bend).clamp(-1.0, 1.0)
    } else {
        0.0
    };
    Some((k as f64 + shift * reach as f64, height + (rise + bend * shift) * shift))
}

fn determinant([a, b, c]: [[f64; 3]; 3]) -> f64 {
    a[0] * (b[1] * c[2] - b[2] * c[1]) - b[0] * (a[1] * c[2] - a[2] * c[1]) + c[0] * (a[1] * b[2] - a[2] * b[1])
}

/// The line through means of two neighbours, which have an error in common with each other: the deviations are those of independent
/// numbers before, s, with s² tr((I − H) V) the expected sum of the squares that are left, V the covariance of the means over s².
fn line(points: &[(f64, f64)]) -> Fitted {
    let n = points.len();
    let middle = points.iter().map(|p| p.0).sum::<f64>() / n as f64;
    let mean = points.iter().map(|p| p.1).sum::<f64>() / n as f64;
    let spread: f64 = points.iter().map(|p| (p.0 - middle).powi(2)).sum();
    let weights: Vec<f64> = points.iter().map(|p| (p.0 - middle) / spread).collect();
    let slope: f64 = points.iter().zip(&weights).map(|(p, w)| w * p.1).sum();
    let left: f64 = points
        .iter()
        .map(|p| (p.1 - mean - slope * (p.0 - middle)).powi(2))
        .sum();
    // V has ½ on its diagonal and ¼ beside it.
    let beside: f64 = weights.windows(2).map(|w| w[0] * w[1]).sum();
    let squares: f64 = weights.iter().map(|w| w * w).sum();
    let of_slope = 0.5 * squares + 0.5 * beside;
    let of_mean = (0.5 * n as f64 + 0.5 * (n as f64 - 1.0)) / n as f64;
    let expected = 0.5 * n as f64 - of_mean - spread * of_slope;
    Fitted {
        slope,
        deviation: (left / expected * of_slope).sqrt(),
        height: mean - slope * middle,
    }
}
