//! The largest value of a record in time, and distances relative to a size.

/// Ratio of a distance to a size; 0 if both vanish.
pub(crate) fn over(distance: f64, size: f64) -> f64 {
    if distance == 0.0 { 0.0 } else { distance / size }
}

/// Largest modulus over a period of equidistant values, on the parabola through the largest and its neighbours.
pub(crate) fn peak(times: usize, value: impl Fn(usize) -> f64) -> f64 {
    let (mut best, mut top) = (0, 0.0);
    for i in 0..times {
        let x = value(i).abs();
        if x > top {
            (best, top) = (i, x);
        }
    }
    let sign = value(best).signum();
    let beside = |i: usize| sign * value(i % times);
    let (before, after) = (beside(best + times - 1), beside(best + 1));
    let bend = before - 2.0 * top + after;
    if bend < 0.0 {
        top -= (after - before).powi(2) / (8.0 * bend);
    }
    top
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    #[test]
    fn the_peak_of_a_wave_between_two_times_is_its_amplitude() {
        let step = TAU / 1024.0;
        for shift in [0.0, 0.3, 0.5, 0.9] {
            let wave = |i: usize| -2.0 * ((i as f64 + shift) * step).cos();
            // A distance of s steps from the nearest time leaves s²(1 − s²)·step⁴/8, largest for s = ½.
            let bound = 3.0 / 128.0 * step.powi(4);
            assert!((peak(1024, wave) / 2.0 - 1.0).abs() < 1.01 * bound, "{shift}");
        }
        assert!(peak(8, |_| 0.0).abs() < f64::MIN_POSITIVE);
    }

    #[test]
    fn nothing_is_no_distance_from_nothing() {
        assert!(over(0.0, 0.0).abs() < f64::MIN_POSITIVE);
        assert!(over(1.0, 0.0).is_infinite());
    }
}
