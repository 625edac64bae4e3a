//! The model of a branch as it was when the branch was solved.

use crate::model::saved::fingerprint::Fingerprint;

/// The model of a branch, and whether its wave is that of the branch.
#[derive(Clone, Copy, Debug)]
pub struct Origin {
    pub(crate) model: Fingerprint,
    pub(crate) on_wave: bool,
}
