//! The carried harmonics, the packing of their coefficients, and the sign convention.
//!
//! A real periodic signal is x(t) = Re Σₕ Xₕ e^{ihωt}. Its packed form is real: the mean X₀ if it is carried, then
//! (Re Xₕ, Im Xₕ) for each carried h > 0 in ascending order. With the base g of the set (the common divisor of the
//! carried harmonics) the signal has the period 2π/(gω); the reduced time τ = gωt and the reduced numbers p = h/g
//! describe it over one turn.

use crate::error::{Result, fail, try_copy, try_push};
use num_complex::Complex64;

/// The carried harmonics of a periodic solution.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct HarmonicSet {
    numbers: Vec<usize>,
    base: usize,
    stride: usize,
    /// Index, among the carried harmonics, of the one whose amplitude is reported as a response.
    watched: usize,
}

impl HarmonicSet {
    /// The harmonics that a force in the harmonics `forced` can excite, none above `highest`.
    ///
    /// Linear structures respond in the forced harmonics only. A nonlinear law spreads the motion over the
    /// multiples of their greatest common divisor g, and over its odd multiples only where law and forcing are odd
    /// (f(−x) = −f(x), so x(t + π/(gω)) = −x(t) is a solution). `keep_all` carries 0 … `highest` in any case.
    ///
    /// # Errors
    /// `Argument` when a forced harmonic lies above `highest`; `OutOfMemory`.
    pub fn excited(forced: &[usize], highest: usize, nonlinear: bool, odd_laws: bool, keep_all: bool) -> Result<Self> {
        if let Some(h) = forced.iter().find(|&&h| h > highest) {
            return fail!(
                Argument,
                "a force acts in harmonic {h}, but harmonics = {highest}; raise harmonics to {h}"
            );
        }
        let base = forced.iter().fold(0, |g, &h| gcd(g, h));
        let odd = odd_laws && forced.iter().all(|&h| base > 0 && (h / base) % 2 == 1);
        let mut numbers = Vec::new();
        let (base, stride) = if keep_all {
            (1, 1)
        } else {
            (base.max(1), if odd { 2 } else { 1 })
        };
        for h in 0..=highest {
            let carried = if keep_all {
                true
            } else if !nonlinear || forced.iter().all(|&h| h == 0) {
                forced.contains(&h)
            } else {
                h % base == 0 && (!odd || (h / base) % 2 == 1)
            };
            if carried {
                try_push(&mut numbers, h, "the list of harmonics")?;
            }
        }
        let watched = numbers.iter().copied().find(|&h| h > 0).unwrap_or(0);
        Ok(Self {
            numbers,
            base,
            stride,
            watched,
        })
    }

    /// The set of all harmonics 0 … `highest`.
    ///
    /// # Errors
    /// `OutOfMemory`.
    #[inline]
    pub fn all(highest: usize) -> Result<Self> {
        Self::excited(&[], highest, true, false, true)
    }

    /// A copy that returns an error if memory is short.
    ///
    /// # Errors
    /// `OutOfMemory`.
    #[inline]
    pub fn try_clone(&self) -> Result<Self> {
        Ok(Self {
            numbers: try_copy(&self.numbers, "the list of harmonics")?,
            ..*self
        })
    }

    /// The set with the harmonics between those that are carried, where some are not, as of linear structures whose forces leave
    /// harmonics out: series count their harmonics by the stride.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn without_gaps(&self) -> Result<Option<Self>> {
        let step = self.base * self.stride;
        let highest = self.numbers.last().copied().unwrap_or(0);
        if self.oscillating() == highest.div_ceil(step) {
            return Ok(None);
        }
        let mut numbers = Vec::new();
        if self.has_mean() {
            try_push(&mut numbers, 0, "the list of harmonics")?;
        }
        for number in (self.base..=highest).step_by(step) {
            try_push(&mut numbers, number, "the list of harmonics")?;
        }
        Ok(Some(Self { numbers, ..*self }))
    }

    /// The carried harmonic numbers, ascending.
    #[must_use]
    #[inline]
    pub fn numbers(&self) -> &[usize] {
        &self.numbers
    }

    /// Index of the fundamental, harmonic 1, among the carried harmonics; 0 if it is not carried.
    #[must_use]
    #[inline]
    pub fn fundamental(&self) -> usize {
        self.numbers.iter().position(|&h| h == 1).unwrap_or(0)
    }

    /// Selects the harmonic whose amplitude is watched; if it is not carried, the lowest vibrating one is.
    #[inline]
    pub fn watch(&mut self, number: usize) {
        if self.numbers.contains(&number) {
            self.watched = number;
        }
    }

    /// Index of the watched harmonic among the carried ones.
    #[must_use]
    #[inline]
    pub fn watched(&self) -> usize {
        self.numbers.iter().position(|&h| h == self.watched).unwrap_or(0)
    }

    /// Common divisor g of the carried harmonics.
    #[must_use]
    #[inline]
    pub fn base(&self) -> usize {
        self.base
    }

    /// Distance between neighbouring reduced numbers: 2 if only odd multiples are carried, else 1.
    #[must_use]
    #[inline]
    pub fn stride(&self) -> usize {
        self.stride
    }

    /// Whether the mean is carried.
    #[must_use]
    #[inline]
    pub fn has_mean(&self) -> bool {
        self.numbers.first() == Some(&0)
    }

    /// Whether the signal repeats with opposite sign after half a turn of τ.
    #[must_use]
    #[inline]
    pub fn is_odd(&self) -> bool {
        self.stride == 2
    }

    /// Number of carried harmonics above zero.
    #[must_use]
    #[inline]
    pub fn oscillating(&self) -> usize {
        self.numbers.len() - usize::from(self.has_mean())
    }

    /// Reduced number of the k-th carried harmonic above zero, counted from 0, of a set without gaps: see [`Self::without_gaps`].
    #[must_use]
    #[inline]
    pub fn reduced(&self, k: usize) -> usize {
        1 + k * self.stride
    }

    /// Highest reduced number of the carried harmonics.
    #[must_use]
    #[inline]
    pub fn highest_reduced(&self) -> usize {
        match self.oscillating() {
            0 => 0,
            n => self.reduced(n - 1),
        }
    }

    /// Length of the packed form of one signal.
    #[must_use]
    #[inline]
    pub fn packed_len(&self) -> usize {
        self.numbers.len() + self.oscillating()
    }

    /// Position in the packed form of the i-th carried harmonic's real part.
    #[must_use]
    #[inline]
    pub fn offset(&self, i: usize) -> usize {
        if self.has_mean() {
            (2 * i).saturating_sub(1)
        } else {
            2 * i
        }
    }

    /// Coefficient of the i-th carried harmonic in a packed signal.
    #[must_use]
    #[inline]
    pub fn get(&self, packed: &[f64], i: usize) -> Complex64 {
        self.get_at(packed, 0, i)
    }

    /// Coefficient of the i-th carried harmonic in a packed signal that begins at index `first`.
    #[must_use]
    #[inline]
    pub fn get_at(&self, packed: &[f64], first: usize, i: usize) -> Complex64 {
        let mean = self.has_mean();
        if i == 0 && mean {
            return packed[first].into();
        }
        let at = first + 2 * i - usize::from(mean);
        Complex64::new(packed[at], packed[at + 1])
    }

    /// Sets the coefficient of the i-th carried harmonic; the mean takes the real part.
    #[inline]
    pub fn set(&self, packed: &mut [f64], i: usize, value: Complex64) {
        let at = self.offset(i);
        packed[at] = value.re;
        if self.numbers[i] != 0 {
            packed[at + 1] = value.im;
        }
    }

    /// Copies packed signals of the harmonics `from`, times a factor. Harmonics that `from` lacks become zero;
    /// those that this set lacks are dropped.
    #[inline]
    pub fn transfer(&self, from: &Self, signals: &[f64], factor: f64, into: &mut [f64]) {
        into.fill(0.0);
        let (m, m2) = (from.packed_len().max(1), self.packed_len().max(1));
        for (y, y2) in signals.chunks_exact(m).zip(into.chunks_exact_mut(m2)) {
            for (i, h) in from.numbers.iter().enumerate() {
                if let Ok(i2) = self.numbers.binary_search(h) {
                    self.set(y2, i2, factor * from.get(y, i));
                }
            }
        }
    }

    /// Upper bound of the velocity of a packed signal at an angular frequency.
    #[must_use]
    #[inline]
    pub fn speed(&self, packed: &[f64], omega: f64) -> f64 {
        let at = |i: usize| self.numbers[i] as f64 * self.get(packed, i).norm();
        omega * (0..self.numbers.len()).map(at).sum::<f64>()
    }

    /// Fills `row` with c(τ), the values of the packed basis: x(τ) = c(τ)·packed.
    #[inline]
    pub fn basis(&self, tau: f64, row: &mut [f64]) {
        let mut at = 0;
        if self.has_mean() {
            row[0] = 1.0;
            at = 1;
        }
        let mut turn = Complex64::cis(tau);
        let step = if self.stride == 2 { turn * turn } else { turn };
        for pair in row[at..].chunks_exact_mut(2) {
            pair[0] = turn.re;
            pair[1] = -turn.im;
            turn *= step;
        }
    }
}

/// Greatest common divisor, with gcd(0, h) = h.
#[must_use]
#[inline]
pub fn gcd(a: usize, b: usize) -> usize {
    if b == 0 { a } else { gcd(b, a % b) }
}

#[cfg(test)]
mod tests {
    use super::HarmonicSet;

    fn numbers(forced: &[usize], highest: usize, odd: bool) -> Vec<usize> {
        HarmonicSet::excited(forced, highest, true, odd, false)
            .unwrap()
            .numbers()
            .to_vec()
    }

    #[test]
    fn only_harmonics_that_force_and_law_excite_are_carried() {
        assert_eq!(numbers(&[1], 7, true), [1, 3, 5, 7]);
        assert_eq!(numbers(&[1], 4, false), [0, 1, 2, 3, 4]);
        assert_eq!(numbers(&[3], 15, true), [3, 9, 15]);
        assert_eq!(numbers(&[0, 1], 3, true), [0, 1, 2, 3]);
        assert_eq!(numbers(&[1, 2], 3, true), [0, 1, 2, 3]);
        assert_eq!(numbers(&[0], 9, true), [0]);
        assert_eq!(numbers(&[1, 3], 5, true), [1, 3, 5]);
        let linear = HarmonicSet::excited(&[1, 4], 9, false, true, false).unwrap();
        assert_eq!(linear.numbers(), [1, 4]);
        assert!(HarmonicSet::excited(&[5], 3, true, true, false).is_err());
    }

    #[test]
    fn harmonics_between_the_carried_ones_are_added_where_some_are_missing() {
        for (forced, whole) in [
            (&[1, 4][..], Some(vec![1, 2, 3, 4])),
            (&[3, 5], Some(vec![1, 3, 5])),
            (&[2, 10], Some(vec![2, 6, 10])),
            (&[0, 1, 3], Some(vec![0, 1, 2, 3])),
            (&[2, 3], Some(vec![1, 2, 3])),
            (&[1, 2], None),
            (&[0, 7], None),
            (&[2, 6], None),
            (&[0], None),
        ] {
            let set = HarmonicSet::excited(forced, 12, false, true, false).unwrap();
            let found = set.without_gaps().unwrap().map(|set| set.numbers().to_vec());
            assert_eq!(found, whole, "{forced:?}");
        }
    }
}
