//! Numbers of the harmonics that a set carries, and those beyond it that sets of its kind would.

use crate::condense::Condensed;
use crate::fourier::HarmonicSet;

/// Index of a carried harmonic on the wave of harmonic h, or on the nearest carried wave.
pub(super) fn block_of(condensed: &Condensed, h: usize) -> Option<usize> {
    let numbers = condensed.set().numbers();
    let period = condensed.in_step().max(1);
    let same = numbers.iter().position(|&k| k > 0 && k % period == h % period);
    same.or_else(|| numbers.iter().rposition(|&k| k > 0))
}

/// The least harmonic to which a point of a response that carries a set is extended: with twice its harmonics, and two more of
/// them at least. The change by the first that was left out may vanish by chance where that by the second does not.
pub(super) fn least_extension(set: &HarmonicSet) -> usize {
    let own = set.numbers().last().copied().unwrap_or(0);
    let second = own + 2 * set.base() * set.stride();
    carried_from(set, second.max(2 * own + 1))
}

/// The lowest harmonic not below h that sets like `set` carry.
pub(super) fn carried_from(set: &HarmonicSet, h: usize) -> usize {
    let (base, step) = (set.base(), set.base() * set.stride());
    base + h.saturating_sub(base).div_ceil(step) * step
}

/// The highest harmonic not above h that sets like `set` carry, at least the base.
pub(super) fn carried_to(set: &HarmonicSet, h: usize) -> usize {
    let (base, step) = (set.base(), set.base() * set.stride());
    base + h.saturating_sub(base) / step * step
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn carried_numbers_are_found_on_both_sides() {
        let set = HarmonicSet::excited(&[3], 15, true, true, false).unwrap();
        assert_eq!(
            (carried_from(&set, 1), carried_from(&set, 4), carried_from(&set, 9)),
            (3, 9, 9)
        );
        assert_eq!((carried_to(&set, 14), carried_to(&set, 15)), (9, 15));
    }
}
