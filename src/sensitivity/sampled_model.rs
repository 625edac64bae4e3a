//! The equations at whose solution results are differentiated.

use crate::condense::Condensed;
use crate::results::Branch;

/// A condensed model, and the number of samples a period at which its contact forces are evaluated.
#[derive(Clone, Copy)]
pub(crate) struct SampledModel<'a> {
    pub condensed: &'a Condensed,
    pub samples: usize,
}

impl<'a> SampledModel<'a> {
    /// The equations of a stored point.
    pub fn at(branch: &'a Branch, point: usize) -> Self {
        Self {
            condensed: branch.condensed_at(point),
            samples: branch.samples_at(point),
        }
    }
}
