//! What a call says when its result was written.

use crate::error::{Error, Status};
use crate::results::Branch;

/// What a call that wrote its result tells: a status, and why the result is a part only, where the
/// status alone does not say it.
pub(super) struct Told {
    pub status: Status,
    pub reason: Option<Error>,
}

impl From<Status> for Told {
    fn from(status: Status) -> Self {
        Self { status, reason: None }
    }
}

impl From<&Branch> for Told {
    fn from(branch: &Branch) -> Self {
        Self {
            status: branch.status(),
            reason: branch.reason().copied(),
        }
    }
}
