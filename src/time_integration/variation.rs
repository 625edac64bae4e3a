//! Variational equations along a lapse: an observer receives the intervals between events with their tangents, and at
//! the end of each motion of a slider the rule by which its place follows from the motion.
//!
//! Perturbations need not have the symmetry of the motion itself. The observer knows theirs; the integration reports
//! the tangents of the motion only.

use crate::contact::forms::time_piece::{Grazing, TimePiece};
use crate::error::Result;
use crate::time_integration::gauss::GaussTables;
use crate::time_integration::smooth_laws::Smooth;

/// An observer that carries perturbations of the motion.
pub(crate) trait Variation {
    /// Carries the perturbations over an interval in which no contact changes.
    ///
    /// # Errors
    /// `StoppedByCaller`; `Singular` of an implicit step.
    fn advance(&mut self, interval: &Interval<'_>) -> Result<()>;

    /// Receives, at the end of a motion of an element's slider, the rule δw = δx + share·δy by which its place
    /// follows.
    ///
    /// # Errors
    /// As [`Self::advance`].
    fn couple(&mut self, element: usize, share: f64) -> Result<()>;

    /// Ends the lapse: no further interval follows.
    ///
    /// # Errors
    /// As [`Self::advance`].
    fn end(&mut self) -> Result<()>;

    /// Receives that the motion of an element touches an event without passing it: derivatives differ on both sides.
    fn graze(&mut self, element: usize, grazing: Grazing);
}

/// An interval in which no contact changes.
pub(crate) struct Interval<'a> {
    /// Tangents of the contacts with events.
    pub pieces: &'a [TimePiece],
    /// Length of the interval in time.
    pub length: f64,
    /// The implicit step at whose beginning the interval lies, where a law is smooth; else `None`.
    pub collocation: Option<Collocation<'a>>,
}

/// An implicit step of the motion, for its perturbations.
pub(crate) struct Collocation<'a> {
    /// Nodes and weights of the collocation.
    pub tables: &'a GaussTables,
    /// Tangents of the smooth laws at the nodes.
    pub smooth: &'a Smooth,
    /// Length of the whole step.
    pub step: f64,
    /// Share of the step that the interval covers.
    pub theta: f64,
}
