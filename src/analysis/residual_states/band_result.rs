//! Options and results of the band of a response.

use crate::analysis::residual_states::held_sliders::BandOf;
use crate::results::Branch;

/// Options of a band.
#[derive(Clone, Copy, Debug)]
pub struct BandOptions<'a> {
    /// The result that is bounded.
    pub of: BandOf,
    /// Contacts whose residual force is free; none: all that are.
    pub contacts: &'a [usize],
    /// Starts of the search with several free sliders, at least 1: the state of the branch, then others within the limits.
    pub starts: usize,
}

impl Default for BandOptions<'_> {
    fn default() -> Self {
        Self {
            of: BandOf::Amplitude,
            contacts: &[],
            starts: 3,
        }
    }
}

/// An end of a band.
#[derive(Debug)]
pub struct BandEnd {
    /// The result.
    pub value: f64,
    /// Its angular frequency.
    pub omega: f64,
    /// The amplitude there.
    pub amplitude: f64,
    /// Places of the free sliders, in the order of [`Band::sliders`].
    pub places: Vec<f64>,
    /// Contacts that are at the limit of their friction.
    pub at_limit: Vec<usize>,
    /// Relative gain that the linearised problem still foretells within a tenth of the distances over which the sliders can be
    /// dragged; 0 with one slider, NaN for a motion that was found without a free slider.
    pub gain: f64,
    /// Relative change of the result by the last doubling of the harmonics, which bounds its error by those left out; NaN where it
    /// is unknown: with fixed harmonics, and where more of them would be too many.
    pub error: f64,
    /// The solution, as a branch of one point on the model with [`Model::set_slider`](crate::model::Model::set_slider) of these places.
    pub branch: Option<Branch>,
}

/// A state on the way from one limit to the other, with one free slider.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BandState {
    /// Place of the slider.
    pub place: f64,
    /// The result.
    pub value: f64,
    /// Its derivative by the place.
    pub derivative: f64,
    /// Its angular frequency.
    pub omega: f64,
}

/// A band.
#[derive(Debug)]
pub struct Band {
    /// Free sliders as (contact, direction); none: the response has no band. Those of the point, then those that stick at an end.
    pub sliders: Vec<(usize, usize)>,
    /// The least result found.
    pub lower: BandEnd,
    /// The largest result found.
    pub upper: BandEnd,
    /// With one free slider at the point the states from one of its limits to the other.
    pub states: Vec<BandState>,
    /// Whether one slider was followed to both of its limits, or every search of several ended at an extremum. False where every
    /// contact is linear at the point and some stick: states far from it were sampled.
    pub is_complete: bool,
    /// Solutions that were computed.
    pub solved: usize,
}
