//! Models condensed to more harmonics, kept for the estimates that follow.

use crate::condense::Condensed;
use crate::error::{Result, try_push};
use crate::error_estimate::estimate::CONTEXT;
use std::cell::OnceCell;

/// Ratio of neighbouring numbers of harmonics.
const RATIO: f64 = 1.1;

/// Lowest number from which the ratio counts.
const FIRST: usize = 10;

/// Slots above the first ones; beyond the last nothing is affordable.
const SLOTS: i32 = 90;

/// One slot per number of harmonics that a model is extended to.
pub struct ExtendedModels {
    slots: Vec<(usize, OnceCell<Condensed>)>,
}

impl ExtendedModels {
    /// Empty slots.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new() -> Result<Self> {
        let mut slots = Vec::new();
        let geometric = (0..SLOTS).map(|k| (FIRST as f64 * RATIO.powi(k)) as usize);
        for number in (0..FIRST).chain(geometric) {
            try_push(&mut slots, (number, OnceCell::new()), CONTEXT)?;
        }
        Ok(Self { slots })
    }

    /// The slot for all harmonics up to one; none beyond the last.
    pub(super) fn slot(&self, highest: usize) -> Option<usize> {
        let slot = self.slots.partition_point(|s| s.0 < highest);
        (slot < self.slots.len()).then_some(slot)
    }

    /// The model of a slot, made at the first time.
    pub(super) fn model(&self, slot: usize, make: impl FnOnce(usize) -> Result<Condensed>) -> Result<&Condensed> {
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
    use super::ExtendedModels;

    #[test]
    fn every_number_has_a_slot_with_little_more() {
        let extended_models = ExtendedModels::new().unwrap();
        for h in 1..30_000 {
            let number = extended_models.slots[extended_models.slot(h).unwrap()].0;
            assert!(number >= h && number as f64 <= 1.11 * h as f64, "{h}: {number}");
        }
        assert!(extended_models.slot(usize::MAX).is_none());
    }
}
