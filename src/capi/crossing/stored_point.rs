//! A stored point of a branch with the model that it belongs to: arguments 1 to 3 of functions that take one.

use crate::capi::crossing::handles::{KeptBranch, Reading, read};
use crate::capi::crossing::indices::index;
use crate::capi::solving::solve::hbvib_branch;
use crate::capi::structures::model::hbvib_model;
use crate::error::{Error, Result, Status};
use crate::model::Model;
use crate::results::Branch;

/// The model, the branch and the number of the point.
pub(crate) struct StoredPoint {
    pub(crate) model: Reading<Model>,
    kept: Reading<KeptBranch>,
    pub(crate) number: usize,
}

impl StoredPoint {
    /// Reads the three arguments.
    pub(crate) fn read(model: *const hbvib_model, branch: *const hbvib_branch, point: i64) -> Result<Self> {
        let model = read::<Model>(model, 1)?;
        let kept = read::<KeptBranch>(branch, 2)?;
        let number = index(point, kept.branch.stored(), 3, "point")?;
        Ok(Self { model, kept, number })
    }

    /// The branch.
    pub(crate) fn branch(&self) -> &Branch {
        &self.kept.branch
    }

    /// Names the argument that is the reason of an error: the model where it is another one, and the one with the number
    /// `of_mode` where a point of a nonlinear mode is not supported.
    pub(crate) fn blame(&self, e: Error, of_mode: i32) -> Error {
        match e.status {
            Status::Unsupported if self.branch().mode().is_some() => e.in_argument(of_mode),
            Status::Argument => e.in_argument(1),
            _ => e,
        }
    }
}
