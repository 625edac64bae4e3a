//! Options and results of the band of a response.

use crate::analysis::residual_states::held_sliders::BandOf;
use crate::results::Branch;

/// Options of a band.
#[derive(Clone, Copy, Debug)]
pub struct BandOptions<'a> {
    /// Result whose least and largest values are sought.
    pub of: BandOf,
    /// Contacts whose residual force is free; empty: all possible ones.
    pub contacts: &'a [usize],
    /// Number of starts of the search with several free sliders, at least 1: the state of the branch, then others
    /// within the limits.
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
    /// The bounded result at this end.
    pub value: f64,
    /// Angular frequency at this end.
    pub omega: f64,
    /// Amplitude of the response at this end.
    pub amplitude: f64,
    /// Places of the free sliders, in the order of [`Band::sliders`].
    pub places: Vec<f64>,
    /// Contacts that are at the limit of their friction.
    pub at_limit: Vec<usize>,
    /// Relative gain that the linearised problem still foretells within a tenth of the distances over which the sliders can be
    /// dragged; 0 with one slider, NaN for a motion that was found without a free slider.
    pub gain: f64,
    /// Relative change of the result by the last doubling of the harmonics, which bounds the error of the omitted
    /// ones. NaN where it is unknown: with fixed harmonics, and where more of them would be too many.
    pub error: f64,
    /// The solution, as a branch of one point on the model whose sliders have these places; see
    /// [`Model::set_slider`](crate::model::Model::set_slider).
    pub branch: Option<Branch>,
}

/// A state between the limits of a single free slider.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BandState {
    /// Place of the slider.
    pub place: f64,
    /// The bounded result in this state.
    pub value: f64,
    /// Derivative of the result by the place of the slider.
    pub derivative: f64,
    /// Angular frequency of this state.
    pub omega: f64,
}

/// Band of a response over the places of its free sliders.
#[derive(Debug)]
pub struct Band {
    /// Free sliders as (contact, direction): those of the point, then those that stick at an end. Empty: the response
    /// has no band.
    pub sliders: Vec<(usize, usize)>,
    /// The least result found.
    pub lower: BandEnd,
    /// The largest result found.
    pub upper: BandEnd,
    /// With one free slider at the point, the states from one of its limits to the other; else empty.
    pub states: Vec<BandState>,
    /// Whether one slider was followed to both of its limits, or every search of several ended at an extremum. False where every
    /// contact is linear at the point and some stick: states far from it were sampled.
    pub is_complete: bool,
    /// Number of solutions that were computed.
    pub solved: usize,
}
