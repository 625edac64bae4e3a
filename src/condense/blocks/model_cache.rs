//! The cache of condensed models: one slot per number of harmonics, filled when it is first asked for. The solver and
//! the error estimate have their own numbers of harmonics and the same cache.

use crate::condense::blocks::resolution::Resolution;
use crate::error::{Result, try_push, try_room};
use std::cell::OnceCell;

const CONTEXT: &str = "the condensed models";

/// Ratio of neighbouring numbers of harmonics in extended problems.
/// Kind: tuned; measured on: not recorded.
const EXTENDED_RATIO: f64 = 1.1;

/// Lowest number of harmonics of an extended problem from which the ratio counts.
/// Kind: tuned; measured on: not recorded.
const EXTENDED_FIRST: usize = 10;

/// Slots above the first ones; nothing is affordable beyond the last.
/// Kind: cap.
const EXTENDED_SLOTS: i32 = 90;

/// Condensed models by their highest harmonic, rising.
pub struct ModelCache {
    slots: Vec<(usize, OnceCell<Resolution>)>,
}

impl ModelCache {
    /// Empty slots for rising numbers of harmonics.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(numbers: impl Iterator<Item = usize>) -> Result<Self> {
        let mut slots = try_room(numbers.size_hint().0, CONTEXT)?;
        for number in numbers {
            try_push(&mut slots, (number, OnceCell::new()), CONTEXT)?;
        }
        Ok(Self { slots })
    }

    /// Slots for extended problems, so close that an estimate carries few harmonics more than it needs.
    pub fn for_estimates() -> Result<Self> {
        let geometric = (0..EXTENDED_SLOTS).map(|k| (EXTENDED_FIRST as f64 * EXTENDED_RATIO.powi(k)) as usize);
        Self::new((0..EXTENDED_FIRST).chain(geometric))
    }

    /// Numbers of harmonics of the slots, rising.
    pub fn numbers(&self) -> impl DoubleEndedIterator<Item = usize> + ExactSizeIterator + '_ {
        self.slots.iter().map(|slot| slot.0)
    }

    /// Index of the first slot with at least `highest` harmonics; the number of slots where there is none.
    pub fn slot_with(&self, highest: usize) -> usize {
        self.slots.partition_point(|slot| slot.0 < highest)
    }

    /// Number of slots, filled or not.
    pub fn slots(&self) -> usize {
        self.slots.len()
    }

    /// Highest harmonic of the models in a slot.
    pub fn highest(&self, slot: usize) -> usize {
        self.slots[slot].0
    }

    /// Any model that is in the cache; `None` if all slots are empty.
    pub fn any(&self) -> Option<&Resolution> {
        self.slots.iter().find_map(|slot| slot.1.get())
    }

    /// The model of the slot for harmonics up to `highest`, if it was made.
    pub fn made(&self, highest: usize) -> Option<&Resolution> {
        self.slots.get(self.slot_with(highest))?.1.get()
    }

    /// The model with the most harmonics among the filled slots below a given one.
    pub fn below(&self, slot: usize) -> Option<&Resolution> {
        self.slots[..slot].iter().rev().find_map(|slot| slot.1.get())
    }

    /// The model of a slot, made with its number of harmonics when it is first asked for.
    ///
    /// # Errors
    /// Those of `make`.
    pub fn model(&self, slot: usize, make: impl FnOnce(usize) -> Result<Resolution>) -> Result<&Resolution> {
        let (number, cell) = &self.slots[slot];
        if let Some(model) = cell.get() {
            return Ok(model);
        }
        let model = make(*number)?;
        Ok(cell.get_or_init(|| model))
    }
}

#[cfg(test)]
mod tests {
    use super::ModelCache;

    #[test]
    fn every_number_has_a_slot_with_little_more() {
        let cache = ModelCache::for_estimates().unwrap();
        for h in 1..30_000 {
            let number = cache.highest(cache.slot_with(h));
            assert!(number >= h && number as f64 <= 1.11 * h as f64, "{h}: {number}");
        }
        assert_eq!(cache.slot_with(usize::MAX), cache.slots());
    }
}
