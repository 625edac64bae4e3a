//! The harmonics that a point of a branch was solved with: those of all points, or more where a tolerance required
//! it.

use crate::condense::Condensed;
use std::sync::Arc;

/// A model condensed to a set of harmonics.
#[derive(Clone, Debug)]
pub struct Resolution {
    /// The condensed model.
    pub condensed: Arc<Condensed>,
    /// Samples per period of the sampled laws; 0: exact events.
    pub samples: usize,
}
