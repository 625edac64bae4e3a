//! Harmonics that a guess has beyond those which forces and laws excite by themselves.

use num_complex::Complex64;

/// Size of a harmonic of a guess, over that of its largest one, from which it counts.
/// Kind: tuned; measured on: not recorded.
const COUNTS: f64 = 1e-6;

/// The harmonics of a periodic motion up to their common divisor and its symmetry.
///
/// A subharmonic motion under a force in harmonic 3 has the harmonics 1, 3, 5, …; one whose symmetry is broken has even
/// harmonics and a mean. Neither follows from forces and laws, so that a guess decides.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Content {
    /// Common divisor of the harmonics above zero; 0: there are no such harmonics.
    pub base: usize,
    /// Whether the mean or an even multiple of the divisor is among the harmonics.
    pub even: bool,
}

impl Content {
    /// The relevant harmonics of a guess (harmonic after harmonic, one number for each degree of freedom) and the
    /// highest one; `counts` marks the degrees of freedom whose motion has an effect. The mean counts by its real
    /// part.
    pub fn of(guess: &[Complex64], counts: &[bool]) -> (Self, usize) {
        let size = |(h, row): (usize, &[Complex64])| {
            let felt = row.iter().zip(counts).filter(|(_, counts)| **counts);
            let size = |z: &Complex64| if h == 0 { z.re.abs() } else { z.norm() };
            (h, felt.fold(0.0_f64, |most, (z, _)| most.max(size(z))))
        };
        let rows = || guess.chunks_exact(counts.len().max(1)).enumerate().map(size);
        let most = rows().fold(0.0_f64, |most, (_, size)| most.max(size));
        let counting = || rows().filter(|(_, size)| *size > COUNTS * most).map(|(h, _)| h);
        let base = counting().fold(0, gcd);
        let content = Self {
            base,
            even: counting().any(|h| h == 0 || (h / base.max(1)) % 2 == 0),
        };
        (content, counting().next_back().unwrap_or(0))
    }

    /// Numbers whose motions have these harmonics, and no more.
    pub fn numbers(self) -> impl Iterator<Item = usize> {
        let base = (self.base > 0).then_some(self.base);
        base.into_iter().chain(self.even.then_some(0))
    }
}

/// Greatest common divisor of two numbers.
pub(crate) fn gcd(a: usize, b: usize) -> usize {
    if b == 0 { a } else { gcd(b, a % b) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn harmonics_count_by_their_size_and_symmetry_by_their_numbers() {
        let of = |sizes: &[f64]| {
            // The second motion, and the imaginary part of the mean, have no effect.
            let row = |(h, x): (usize, &f64)| {
                let felt = if h == 0 {
                    Complex64::new(*x, 3.0)
                } else {
                    Complex64::new(0.0, *x)
                };
                [felt, Complex64::new(5.0, 5.0)]
            };
            let rows: Vec<Complex64> = sizes.iter().enumerate().flat_map(row).collect();
            let (content, highest) = Content::of(&rows, &[true, false]);
            (content.base, content.even, highest)
        };
        assert_eq!(of(&[0.0, 1.0, 0.0, 0.2]), (1, false, 3));
        assert_eq!(of(&[0.0, 1.0, 1e-3, 0.2, 1e-9]), (1, true, 3));
        assert_eq!(of(&[0.0, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0]), (3, false, 9));
        assert_eq!(of(&[0.5, 0.0, 0.0, 2.0]), (3, true, 3));
        assert_eq!(of(&[0.5]), (0, true, 0));
        assert_eq!(of(&[0.0, 0.0]), (0, false, 0));
        let numbers = |base, even| Content { base, even }.numbers().collect::<Vec<_>>();
        assert_eq!((numbers(2, true), numbers(3, false)), (vec![2, 0], vec![3]));
        assert!(numbers(0, false).is_empty());
    }
}
