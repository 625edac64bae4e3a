//! The freedom of the points of a branch, as far as it was requested.

use crate::error::Status;
use crate::results::Branch;
use crate::results::stored::freedom_of_points::FreedomOfPoints;

impl Branch {
    /// Whether the free sliders of the points were requested.
    #[must_use]
    pub fn tells_freedom(&self) -> bool {
        self.freedom.is_some()
    }

    /// Number of free sliders at each point of the curve, as [`crate::freedom()`] lists them; NaN where it is
    /// unknown. Empty without the solver option `freedom`.
    #[must_use]
    pub fn free_sliders(&self) -> &[f64] {
        let all = self.freedom.as_ref().map_or(&[][..], |freedom| freedom.count());
        &all[..self.points().min(all.len())]
    }

    /// Derivatives of the amplitude of a stored point by the places of sliders at a fixed frequency, along t1 and t2 of each contact;
    /// NaN where a slider is not free. `None` for an unknown point, and without the solver option `freedom`.
    #[must_use]
    pub fn d_amplitude_by_place_at(&self, point: usize) -> Option<&[[f64; 2]]> {
        self.freedom.as_ref()?.of_point(point)
    }

    /// Stores the freedom of all points; `stopped` if the caller stopped its computation.
    pub(crate) fn set_freedom(&mut self, freedom: Box<FreedomOfPoints>, stopped: bool) {
        self.freedom = Some(freedom);
        if stopped && self.run.status == Status::Ok {
            self.run.status = Status::StoppedByCaller;
        }
    }
}
