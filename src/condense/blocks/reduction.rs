//! The parts of the problem that the condensation removed.

use crate::condense::{Condensed, FlexibilityWay, HarmonicBlock};
use crate::error::Result;
use crate::interrupt::Interrupt;
use crate::model::Model;
use crate::options::SolverOptions;

/// The parts of the problem that the condensation removed, for the user.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reduction {
    /// Number of sectors of the wheel; all but one are removed.
    pub sectors: usize,
    /// Degrees of freedom of one sector.
    pub degrees_of_freedom: usize,
    /// Relative coordinates that remain.
    pub coordinates: usize,
    /// Contacts in the model.
    pub contacts: usize,
    /// Contacts that became linear springs (infinite slip limit, no cubic term).
    pub never_slipping: usize,
    /// Contacts without force (no stiffness, or no slip limit).
    pub inert: usize,
    /// Highest harmonic of the points: the requested one or, where a tolerance chose, the highest that a point
    /// carries.
    pub harmonics_asked: usize,
    /// Number of carried harmonics, the largest over the points.
    pub harmonics_carried: usize,
    /// Whether the mean (harmonic 0) is carried.
    pub mean_carried: bool,
    /// Whether the even harmonics were removed because laws and force are odd.
    pub even_removed: bool,
    /// Number of real unknowns of the nonlinear problem, the largest over the points.
    pub unknowns: usize,
    /// Rigid-body modes of the mean motion that contacts alone hold; 0 where the mean is not carried.
    pub held_by_contacts: usize,
    /// Coordinates of each harmonic on its basis, the largest number over the points; 0 without a basis.
    pub basis: usize,
    /// Estimated relative error of the motion of the structure on a basis, the largest over the points; 0 without one.
    pub certificate: f64,
    /// Index of the harmonic whose amplitude is reported as the response.
    pub response_harmonic: usize,
    /// Whether the first point was found from the guess of the caller; `None` without a guess.
    pub guess_used: Option<bool>,
    /// How the flexibility of the contacts is made, and why in this way.
    pub flexibility_way: FlexibilityWay,
}

/// The parts of the problem that were removed.
///
/// # Errors
/// Those of [`Model::rigid_modes`]; `StoppedByCaller`.
pub(crate) fn reduction(
    condensed: &Condensed,
    model: &Model,
    options: &SolverOptions,
    interrupt: &Interrupt<'_>,
) -> Result<Reduction> {
    let held_by_contacts = if condensed.set.has_mean() && condensed.coordinates() > 0 {
        model.rigid_modes(0, interrupt)?
    } else {
        0
    };
    Ok(reduction_with(condensed, model, options, held_by_contacts))
}

/// How the flexibility of the lowest vibrating harmonic is made, as far as it is known before a sweep.
fn flexibility_way(condensed: &Condensed) -> FlexibilityWay {
    let vibrating = condensed.blocks.iter().find(|block| block.number > 0);
    vibrating.map_or(FlexibilityWay::SingleFrequency, HarmonicBlock::flexibility_way)
}

/// The parts of the problem that were removed, as `reduction` gives them, with a known number of rigid-body modes
/// that contacts alone hold.
#[must_use]
pub(crate) fn reduction_with(
    condensed: &Condensed,
    model: &Model,
    options: &SolverOptions,
    held_by_contacts: usize,
) -> Reduction {
    Reduction {
        sectors: model.structure().sectors(),
        degrees_of_freedom: condensed.degrees.given(),
        coordinates: condensed.coordinates(),
        contacts: condensed.contacts(),
        never_slipping: condensed.contacts.classes.never_slipping.len(),
        inert: condensed.contacts.classes.inert(),
        harmonics_asked: options.harmonics,
        harmonics_carried: condensed.set.numbers().len(),
        mean_carried: condensed.set.has_mean(),
        even_removed: condensed.set.is_odd(),
        unknowns: condensed.unknowns(),
        held_by_contacts,
        basis: if condensed.is_reduced() { condensed.ndof() } else { 0 },
        certificate: condensed.certificate(),
        response_harmonic: condensed
            .set
            .numbers()
            .get(condensed.set.watched())
            .copied()
            .unwrap_or(0),
        guess_used: None,
        flexibility_way: flexibility_way(condensed),
    }
}
