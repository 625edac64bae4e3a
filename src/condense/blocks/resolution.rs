//! The resolution of a point: the model condensed to a set of harmonics, and the samples of its sampled laws.

use crate::condense::blocks::condensed::Condensed;
use std::sync::Arc;

/// A model condensed to a set of harmonics.
#[derive(Clone, Debug)]
pub struct Resolution {
    /// The model condensed to the harmonics of this resolution.
    pub condensed: Arc<Condensed>,
    /// Samples per period of the sampled laws; 0: exact events.
    pub samples: usize,
}
