//! A stored point of a branch with the model that it belongs to: arguments 1 to 3 of functions that take one.

use super::handles::{KeptBranch, Reading, read};
use super::indices::index;
use super::model::hbvib_model;
use super::solve::hbvib_branch;
use crate::error::{Error, Result, Status};
use crate::model::Model;
use crate::results::Branch;

/// The model, the branch and the number of the point.
pub(super) struct StoredPoint {
    pub(super) model: Reading<Model>,
    kept: Reading<KeptBranch>,
    pub(super) number: usize,
}

impl StoredPoint {
    /// Reads the three arguments.
    pub(super) fn read(model: *const hbvib_model, branch: *const hbvib_branch, point: i64) -> Result<Self> {
        let model = read::<Model>(model, 1)?;
        let kept = read::<KeptBranch>(branch, 2)?;
        let number = index(point, kept.branch.stored(), 3, "point")?;
        Ok(Self { model, kept, number })
    }

    /// The branch.
    pub(super) fn branch(&self) -> &Branch {
        &self.kept.branch
    }

    /// Names the argument that is the reason of an error: the model where it is another one, and the one with the number
    /// `of_mode` where a point of a nonlinear mode is not supported.
    pub(super) fn blame(&self, e: Error, of_mode: i32) -> Error {
        match e.status {
            Status::Unsupported if self.branch().mode().is_some() => e.in_argument(of_mode),
            Status::Argument => e.in_argument(1),
            _ => e,
        }
    }
}
