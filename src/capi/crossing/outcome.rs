//! The outcome of a call that has written its result.

use crate::error::{Error, Status};
use crate::results::Branch;

/// A status, and the reason of a partial result if the status alone does not state it.
pub(crate) struct Outcome {
    pub status: Status,
    pub reason: Option<Error>,
}

impl From<Status> for Outcome {
    fn from(status: Status) -> Self {
        Self { status, reason: None }
    }
}

impl From<&Branch> for Outcome {
    fn from(branch: &Branch) -> Self {
        Self {
            status: branch.status(),
            reason: branch.reason().cloned(),
        }
    }
}
