//! The contacts of a model as they were when it was condensed, sorted by what a solver makes of them.

use crate::contact::{Contact, Role};
use crate::error::{Result, try_push};
use crate::model::{Model, copy};

/// All contacts of a model. Those that are linear have no relative coordinate.
#[derive(Clone, Debug, Default)]
pub struct Roster {
    all: Vec<Contact>,
    pub(super) active: Vec<usize>,
    pub(super) never_slipping: Vec<usize>,
    /// The directions of the linear ones, as (contact, direction).
    pub(super) linear: Vec<(usize, usize)>,
    inert: usize,
}

impl Roster {
    pub(super) fn new(model: &Model) -> Result<Self> {
        const WHAT: &str = "the contacts";
        let mut roster = Self::default();
        for contact in model.contacts() {
            try_push(&mut roster.all, copy(contact)?, WHAT)?;
        }
        for (i, contact) in model.contacts().iter().enumerate() {
            match contact.role() {
                Role::Active => try_push(&mut roster.active, i, WHAT)?,
                Role::Spring => try_push(&mut roster.never_slipping, i, WHAT)?,
                Role::Inert => roster.inert += 1,
            }
            if contact.role() != Role::Active {
                for direction in 0..contact.directions() {
                    try_push(&mut roster.linear, (i, direction), WHAT)?;
                }
            }
        }
        Ok(roster)
    }

    /// All contacts, in the order of the model.
    #[must_use]
    pub fn contacts(&self) -> &[Contact] {
        &self.all
    }

    /// Number of contacts without force.
    #[must_use]
    pub fn inert(&self) -> usize {
        self.inert
    }

    /// Position of the first direction of a linear contact in [`super::HarmonicBlock::linear_rows`]; the
    /// others follow.
    #[must_use]
    pub fn linear(&self, contact: usize) -> Option<usize> {
        self.linear.binary_search(&(contact, 0)).ok()
    }
}
