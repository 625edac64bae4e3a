//! The numbers of a nonlinear mode that a branch holds.

use crate::results::Branch;
use crate::results::stored::mode_branch::{ModeData, ModeField, ModeInfo, ModePoint};

impl Branch {
    /// Linear mode from which the nonlinear mode starts; `None` for a forced response.
    #[must_use]
    pub fn mode(&self) -> Option<&ModeInfo> {
        self.mode.as_ref().map(|m| &m.info)
    }

    /// A field of the mode at each point of the curve; `None` for a forced response.
    #[must_use]
    pub fn mode_field(&self, field: ModeField) -> Option<&[f64]> {
        self.mode.as_ref().map(|m| &m.field(field)[..self.points()])
    }

    /// The mode's numbers at a stored point, special ones included.
    #[must_use]
    pub fn mode_at(&self, point: usize) -> Option<ModePoint> {
        self.mode.as_ref().and_then(|m| m.point(point))
    }

    /// Damping ratio at a stored point; 0 for a forced response.
    pub(crate) fn damping_at(&self, point: usize) -> f64 {
        self.mode_at(point).map_or(0.0, |p| p.damping_ratio)
    }

    pub(crate) fn mode_data(&self) -> Option<&ModeData> {
        self.mode.as_ref()
    }

    pub(crate) fn mode_data_mut(&mut self) -> Option<&mut ModeData> {
        self.mode.as_mut()
    }
}
