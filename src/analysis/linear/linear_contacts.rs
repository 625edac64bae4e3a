//! Contacts of a linear analysis: without force, as springs at small motion, or as springs about the static state under
//! constant forces and preload.

use crate::analysis::linear::static_solution::static_state;
use crate::error::Result;
use crate::interrupt::Interrupt;
use crate::model::Model;
use crate::model::natural_modes::linear_modes::{ContactState, LinearModes};
use crate::options::SolverOptions;
use crate::problem::static_state::StaticState;

/// State of the contacts in a linear analysis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LinearContacts {
    /// Contacts without force.
    Free,
    /// Contacts as linear springs with their stiffness at small motion.
    Stuck,
    /// Contacts as linear springs with their tangent stiffness at the static state; as `Stuck` where nothing loads
    /// the model.
    Static,
}

/// State of the contacts, with the static motion that it needs.
pub(crate) struct PreparedContacts {
    contacts: LinearContacts,
    rest: StaticState,
}

impl LinearContacts {
    /// Finds the static state, where the contacts are linearised about it.
    ///
    /// # Errors
    /// `NoConvergence` or `Singular` if there is no equilibrium; those of callbacks; `OutOfMemory`; `StoppedByCaller`.
    pub(crate) fn prepared(self, model: &Model, interrupt: &Interrupt<'_>) -> Result<PreparedContacts> {
        let rest = match self {
            Self::Static => static_state(
                model,
                &SolverOptions::default(),
                "linear modes about it belong to one speed",
                interrupt,
            )?,
            Self::Free | Self::Stuck => StaticState::default(),
        };
        Ok(PreparedContacts { contacts: self, rest })
    }
}

impl PreparedContacts {
    pub fn state(&self) -> ContactState<'_> {
        match self.contacts {
            LinearContacts::Free => ContactState::Free,
            LinearContacts::Static if self.rest.is_loaded() => ContactState::AboutStatic(&self.rest.tangents),
            LinearContacts::Stuck | LinearContacts::Static => ContactState::Stuck,
        }
    }
}

/// The `count` lowest undamped modes of a signed nodal diameter; see [`Model::lowest_modes_with`].
///
/// # Errors
/// As [`Model::lowest_modes_with`]; `NoConvergence` or `Singular` without an equilibrium.
pub fn linear_modes(
    model: &Model,
    diameter: i64,
    contacts: LinearContacts,
    count: usize,
    interrupt: &Interrupt<'_>,
) -> Result<LinearModes> {
    let contacts = contacts.prepared(model, interrupt)?;
    model.lowest_modes_with(diameter, contacts.state(), count, interrupt)
}
