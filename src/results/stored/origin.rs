//! The model of a branch as it was when the branch was solved.

use crate::model::saved::fingerprint::Fingerprint;

/// Fingerprint of the model of a branch; and whether the branch has the wave of the model.
#[derive(Clone, Copy, Debug)]
pub struct Origin {
    pub(crate) model: Fingerprint,
    pub(crate) on_wave: bool,
}
