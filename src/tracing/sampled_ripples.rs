//! Maxima that samples may have made. The forces of a smooth law that is evaluated at samples err with the motion, so that a slope has
//! ripples of the size of that error, each with a maximum. One that rises above the curve on either side by less than the error is no
//! peak that the response is known to have.

use crate::error::{Result, try_push};

const CONTEXT: &str = "the peaks of the branch";

/// Height of a ripple over the amplitude, whatever the error of the forces: these are a part of all forces.
/// Kind: tuned; measured on: regularised friction, bladed disks with few samples, laws of the caller.
const LARGEST_RIPPLE: f64 = 1e-2;

/// Error of sampling that is rounding: a point of the curve may then lie above its maximum by more.
/// Kind: rounding.
pub(crate) const EXACT_SAMPLES: f64 = 1e-9;

/// A maximum beside the curve, or a point of it.
#[derive(Clone, Copy)]
struct Height {
    amplitude: f64,
    /// Number of the maximum among those given.
    maximum: Option<usize>,
}

/// A maximum behind the first `after` points of the curve, with the relative error of its forces by sampling.
pub(crate) struct Maximum {
    pub after: usize,
    pub amplitude: f64,
    pub error: f64,
}

/// For each maximum, in the order along the curve, whether it is a ripple: on one side there is a higher maximum, or the curve ends above it
/// by the error, before it has fallen by the error. Points of the curve have ripples as well, so that one may lie above its maximum.
///
/// # Errors
/// `OutOfMemory`.
pub(crate) fn are_ripples(curve: &[f64], maxima: &[Maximum]) -> Result<Vec<bool>> {
    let mut found = Vec::new();
    if maxima.is_empty() {
        return Ok(found);
    }
    let mut line = Vec::new();
    let mut next = 0;
    for (point, &amplitude) in curve.iter().enumerate() {
        let height = Height {
            amplitude,
            maximum: None,
        };
        try_push(&mut line, height, CONTEXT)?;
        while let Some(found) = maxima.get(next).filter(|found| found.after <= point + 1) {
            let height = Height {
                amplitude: found.amplitude,
                maximum: Some(next),
            };
            try_push(&mut line, height, CONTEXT)?;
            next += 1;
        }
    }
    for (at, height) in line.iter().enumerate() {
        let Some(number) = height.maximum else { continue };
        let error = maxima[number].error.min(LARGEST_RIPPLE);
        let is_ripple = error > 0.0
            && (rises(line[..at].iter().rev(), *height, error) || rises(line[at + 1..].iter(), *height, error));
        try_push(&mut found, is_ripple, CONTEXT)?;
    }
    Ok(found)
}

/// Whether a line rises above a maximum before it has fallen, both by a relative error: to a higher maximum, or to where the line ends. A
/// summit whose own maximum was stepped over, as one of many narrow ones may be, leaves the highest of those found on it.
fn rises<'a>(line: impl Iterator<Item = &'a Height>, maximum: Height, error: f64) -> bool {
    let mut last = maximum.amplitude;
    for other in line {
        if other.amplitude < maximum.amplitude * (1.0 - error) {
            return false;
        }
        if other.maximum.is_some() && other.amplitude > maximum.amplitude {
            return true;
        }
        last = other.amplitude;
    }
    last > maximum.amplitude * (1.0 + error)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whether the maxima (points before, amplitude) on a curve are ripples for an error.
    fn ripples(curve: &[f64], maxima: &[(usize, f64)], error: f64) -> Vec<bool> {
        let maximum = |&(after, amplitude): &(usize, f64)| Maximum {
            after,
            amplitude,
            error,
        };
        are_ripples(curve, &maxima.iter().map(maximum).collect::<Vec<_>>()).unwrap()
    }

    #[test]
    fn ripples_on_a_slope_are_none_and_peaks_of_any_height_are_kept_where_nothing_is_sampled() {
        let slope: Vec<f64> = (0..20).map(|i| 1.0 + 0.01 * f64::from(i)).collect();
        // A ripple of 1e-4 on the slope; the top, of 0.5.
        let maxima = [(6, 1.0501), (13, 1.1201), (20, 1.5)];
        assert_eq!(ripples(&slope, &maxima, 1e-3), [true, true, false]);
        assert_eq!(ripples(&slope, &maxima, 0.0), [false; 3]);
        // Two summits with a saddle that is lower by 2e-3.
        let (saddle, two) = ([1.0, 1.1, 1.198, 1.1, 1.0], [(2, 1.2), (3, 1.2001)]);
        assert_eq!(ripples(&saddle, &two, 1e-3), [false, false]);
        assert_eq!(ripples(&saddle, &two, 1e-2), [true, false]);
        // A point of the curve that lies above the maximum by less than the error.
        assert_eq!(ripples(&[1.0, 1.1, 1.2005, 1.1, 1.0], &[(3, 1.2)], 1e-2), [false]);
        // A summit whose highest maximum was stepped over keeps the highest of those found; a slope that ends higher has none.
        let (summit, found) = ([1.0, 1.1, 1.18, 1.2, 1.18, 1.1, 1.0], [(2, 1.17), (5, 1.181)]);
        assert_eq!(ripples(&summit, &found, 1e-3), [true, false]);
        assert_eq!(ripples(&summit[..4], &found[..1], 1e-3), [true]);
    }
}
