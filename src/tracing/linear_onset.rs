//! The place between two parameter values at which a contact leaves its linear range.
//!
//! The share s of the linear range that a contact uses is known inside alone, and reaches 1 at the place. Its secant through the last two
//! values inside foresees the place; values right before and behind it close the bracket from both sides. Where the secant misleads,
//! as at the kink where another contact becomes the first, the bracket is halved.

use crate::tracing::linear_peaks::ROUNDING;

/// Share of the change of the foreseen place that counts as its error: secants converge faster.
/// Kind: tuned; measured on: responses of one mode, polynomials, shares with kinks and jumps.
const ONSET_ERROR: f64 = 0.1;

/// Multiple of that error up to which a place that is foreseen behind the end outside is sought right before this end.
/// Kind: tuned; measured on: responses of one mode, polynomials, shares with kinks and jumps.
const ONSET_NEAR: f64 = 4.0;

/// Places on the wrong side of the foreseen one, after which the bracket is halved.
/// Kind: cap.
const ONSET_SURPRISES: usize = 3;

/// The bracket of the place, with what its inside tells.
pub(super) struct Onset {
    /// The last two values inside, the later one last, with the shares of the linear range there.
    inside: [Option<(f64, f64)>; 2],
    outside: f64,
    /// The place as foreseen last, and how far from it the next value lies.
    foreseen: Option<f64>,
    error: f64,
    /// Whether the next value is to lie inside, and whether the last one did, so that the place is foreseen anew.
    inside_next: bool,
    is_new: bool,
    surprises: usize,
}

impl Onset {
    /// The bracket from a value inside with its share to one outside.
    pub fn new(inside: f64, share: f64, outside: f64) -> Self {
        Self {
            inside: [None, Some((inside, share))],
            outside,
            foreseen: None,
            error: f64::INFINITY,
            inside_next: true,
            is_new: true,
            surprises: 0,
        }
    }

    /// The next value to try, between both ends; `None` where these are neighbours.
    pub fn next(&mut self) -> Option<f64> {
        let [before, Some((inside, share))] = self.inside else {
            return None;
        };
        let width = self.outside - inside;
        if width.abs() <= ROUNDING * self.outside.abs() {
            return None;
        }
        let middle = inside + 0.5 * width;
        let known = before.filter(|&(_, s)| share.to_bits() != s.to_bits() && self.surprises < ONSET_SURPRISES);
        let Some((p, s)) = known else {
            return Some(middle);
        };
        let foreseen = inside + (1.0 - share) * (inside - p) / (share - s);
        if let Some(last) = self.foreseen.filter(|_| self.is_new) {
            let rounding = 0.4 * ROUNDING * self.outside.abs();
            self.error = (ONSET_ERROR * (foreseen - last).abs()).max(rounding);
        }
        (self.foreseen, self.is_new) = (Some(foreseen), false);
        let aside = self.error.min(0.25 * width.abs()).copysign(width);
        let is_between = |at: f64| (at - inside) * width > 0.0 && (self.outside - at) * width > 0.0;
        let tried = if is_between(foreseen) {
            foreseen + if self.inside_next { -aside } else { aside }
        } else if (foreseen - self.outside).abs() <= ONSET_NEAR * self.error {
            // A value right behind the place may be closer to it than it is foreseen.
            self.outside - aside
        } else {
            middle
        };
        Some(if is_between(tried) { tried } else { middle })
    }

    /// Takes a value that was tried, with its share, or without one where it lies outside.
    pub fn take(&mut self, at: f64, share: Option<f64>) {
        if let Some(share) = share {
            self.inside = [self.inside[1], Some((at, share))];
            (self.inside_next, self.is_new) = (false, true);
            return;
        }
        if self.inside_next && self.error.is_finite() {
            self.surprises += 1;
            self.error /= ONSET_ERROR;
        }
        (self.outside, self.inside_next) = (at, true);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Number of values until the place of `share` = 1 is found between two values.
    fn values_until_found(share: impl Fn(f64) -> f64, ends: [f64; 2], place: f64) -> usize {
        let mut onset = Onset::new(ends[0], share(ends[0]), ends[1]);
        let (mut inside, mut outside, mut count) = (ends[0], ends[1], 0);
        while let Some(at) = onset.next() {
            assert!(
                (at - inside) * (outside - at) > 0.0,
                "{at} is outside {inside}, {outside}"
            );
            let found = Some(share(at)).filter(|share| *share <= 1.0);
            match found {
                Some(_) => inside = at,
                None => outside = at,
            }
            onset.take(at, found);
            count += 1;
            assert!(count < 80, "{inside} {outside}");
        }
        let rounding = 2.0 * ROUNDING * place;
        assert!((inside - place).abs() <= rounding && (outside - place).abs() <= rounding);
        count
    }

    #[test]
    fn the_place_is_found_to_rounding_in_less_than_half_of_the_values_that_halving_takes() {
        // A resonance at 2 with a half width of 0.01, whose share is 1 at ω with (ω² − 4)² + (0.02 ω)² = 0.25.
        let share = |w: f64| 0.5 / ((w * w - 4.0).powi(2) + (0.02 * w).powi(2)).sqrt();
        for (from, to, sense) in [(1.7, 1.95, -1.0), (2.4, 2.05, 1.0)] {
            let b = 8.0 - 4e-4_f64;
            let place = (0.5 * (b + sense * (b * b - 4.0 * 15.75).sqrt())).sqrt();
            let count = values_until_found(share, [from, to], place);
            let halvings = ((to - from).abs() / (ROUNDING * place)).log2();
            assert!(2.0 * (count as f64) < halvings, "{count} {halvings}");
        }
    }

    #[test]
    fn a_kink_or_a_jump_of_the_share_costs_a_few_values_beside_halving() {
        let place = 0.3_f64;
        let kinked = |w: f64| {
            if w < 0.299 {
                0.5 + w
            } else {
                0.799 + (w - 0.299) * 201.0
            }
        };
        let jumps = |w: f64| if w <= place { 0.2 + w } else { 2.0 };
        let flat = |w: f64| if w <= place { 0.5 } else { 2.0 };
        let halvings = (1.0 / (ROUNDING * place)).log2();
        for share in [&kinked as &dyn Fn(f64) -> f64, &jumps, &flat] {
            let count = values_until_found(share, [0.0, 1.0], place);
            assert!((count as f64) < halvings + 5.0, "{count} {halvings}");
        }
    }
}
