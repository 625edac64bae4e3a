//! The free sliders of the stored points of a forced response: their number and the derivatives of the amplitude by their places.

use crate::error::{Result, Status, try_vec};
use crate::results::Branch;

const CONTEXT: &str = "the freedom of the points";

/// Numbers of the stored points.
#[derive(Debug)]
pub(crate) struct FreedomOfPoints {
    contacts: usize,
    count: Vec<f64>,
    by_place: Vec<[f64; 2]>,
}

impl FreedomOfPoints {
    /// Those of so many points, as yet unknown.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn unknown(points: usize, contacts: usize) -> Result<Self> {
        Ok(Self {
            contacts,
            count: try_vec(points, f64::NAN, CONTEXT)?,
            by_place: try_vec(points.saturating_mul(contacts), [f64::NAN; 2], CONTEXT)?,
        })
    }

    /// Sets those of a point: (contact, direction) of each free slider with the derivative of the amplitude by its place.
    pub fn set(&mut self, point: usize, free: impl Iterator<Item = ((usize, usize), f64)>) {
        let mut count = 0;
        for ((contact, direction), derivative) in free {
            self.by_place[point * self.contacts + contact][direction] = derivative;
            count += 1;
        }
        self.count[point] = f64::from(count);
    }

    /// Number of free sliders of each point; NaN where it is unknown.
    pub fn count(&self) -> &[f64] {
        &self.count
    }

    /// Derivatives for each point, contact and direction; NaN where a slider is not free.
    pub fn by_place(&self) -> &[[f64; 2]] {
        &self.by_place
    }
}

impl Branch {
    /// Whether freedom was requested.
    #[must_use]
    pub fn tells_freedom(&self) -> bool {
        self.freedom.is_some()
    }

    /// Number of free sliders at each point of the curve, as [`crate::freedom()`] lists them; NaN where it is unknown, and none without
    /// the solver option `freedom`.
    #[must_use]
    pub fn free_sliders(&self) -> &[f64] {
        let all = self.freedom.as_ref().map_or(&[][..], |freedom| freedom.count());
        &all[..self.points().min(all.len())]
    }

    /// Derivatives of the amplitude of a stored point by the places of sliders at a fixed frequency, along t1 and t2 of each contact;
    /// NaN where a slider is not free. `None` for an unknown point, and without the solver option `freedom`.
    #[must_use]
    pub fn d_amplitude_by_place_at(&self, point: usize) -> Option<&[[f64; 2]]> {
        let freedom = self.freedom.as_ref()?;
        let n = freedom.contacts;
        freedom.by_place.get(point * n..(point + 1) * n)
    }

    /// Stores the freedom of all points; `stopped` if the caller stopped its computation.
    pub(crate) fn set_freedom(&mut self, freedom: Box<FreedomOfPoints>, stopped: bool) {
        self.freedom = Some(freedom);
        if stopped && self.status == Status::Ok {
            self.status = Status::StoppedByCaller;
        }
    }
}
