//! What the condensation removed from the problem.

use crate::condense::Condensed;
use crate::error::Result;
use crate::model::Model;
use crate::options::SolverOptions;

/// What the condensation removed from the problem, for the user to see.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Reduction {
    /// Sectors of the wheel; all but one are removed.
    pub sectors: usize,
    /// Degrees of freedom of one sector.
    pub degrees_of_freedom: usize,
    /// Relative coordinates that remain of them.
    pub coordinates: usize,
    /// Contacts in the model.
    pub contacts: usize,
    /// Contacts that became linear springs (infinite slip limit, no cubic term).
    pub never_slipping: usize,
    /// Contacts without force (no stiffness, or no slip limit).
    pub inert: usize,
    /// Highest harmonic number of which the points tell: that asked for or, where a tolerance decided, the highest
    /// that one of them carries.
    pub harmonics_asked: usize,
    /// Harmonics carried, where most are.
    pub harmonics_carried: usize,
    /// Whether the mean is carried.
    pub mean_carried: bool,
    /// Whether the even harmonics were left out because law and forcing are odd.
    pub even_removed: bool,
    /// Real unknowns of the nonlinear problem, where there are most.
    pub unknowns: usize,
    /// Rigid-body modes of the mean motion that contacts alone hold; 0 where the mean is not carried.
    pub held_by_contacts: usize,
}

impl Condensed {
    /// What was removed.
    ///
    /// # Errors
    /// Those of [`Model::rigid_modes`].
    pub fn reduction(&self, model: &Model, options: &SolverOptions) -> Result<Reduction> {
        let held_by_contacts = if self.set.has_mean() && self.coordinates() > 0 {
            model.rigid_modes(0)?
        } else {
            0
        };
        Ok(Reduction {
            sectors: model.structure().sectors(),
            degrees_of_freedom: self.ndof,
            coordinates: self.coordinates(),
            contacts: self.contacts(),
            never_slipping: self.contact_classes.never_slipping.len(),
            inert: self.contact_classes.inert(),
            harmonics_asked: options.harmonics,
            harmonics_carried: self.set.numbers().len(),
            mean_carried: self.set.has_mean(),
            even_removed: self.set.is_odd(),
            unknowns: self.unknowns(),
            held_by_contacts,
        })
    }
}
