//! The free sliders of the stored points of a forced response: their number and the derivatives of the amplitude by their places.

use crate::error::{Result, try_vec};

const CONTEXT: &str = "the freedom of the points";

/// Number of free sliders, and derivatives by their places, of the stored points.
#[derive(Debug)]
pub(crate) struct FreedomOfPoints {
    contacts: usize,
    count: Vec<f64>,
    by_place: Vec<[f64; 2]>,
}

impl FreedomOfPoints {
    /// Unknown values for `points` points.
    pub fn unknown(points: usize, contacts: usize) -> Result<Self> {
        Ok(Self {
            contacts,
            count: try_vec(points, f64::NAN, CONTEXT)?,
            by_place: try_vec(points.saturating_mul(contacts), [f64::NAN; 2], CONTEXT)?,
        })
    }

    /// Sets the free sliders of a point: (contact, direction) of each, with the derivative of the amplitude by its
    /// place.
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

    /// Derivatives of one point, for each contact and direction.
    pub fn of_point(&self, point: usize) -> Option<&[[f64; 2]]> {
        self.by_place.get(point * self.contacts..(point + 1) * self.contacts)
    }

    /// Derivatives for each point, contact and direction; NaN where a slider is not free.
    pub fn by_place(&self) -> &[[f64; 2]] {
        &self.by_place
    }
}
