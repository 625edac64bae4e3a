//! The contacts of a model at the time of its condensation, classified by their treatment: active, linear springs,
//! without force.

use crate::contact::{Contact, Role};
use crate::error::{Result, try_push, try_room};
use crate::model::{Model, copy};
use std::sync::Arc;

/// The contacts of a model by treatment: active ones, linear springs (which have no relative coordinate), and
/// contacts without force.
#[derive(Clone, Debug, Default)]
pub struct ContactClasses {
    /// All contacts in the order of the model, shared by the condensed models of all resolutions.
    all: Arc<Vec<Contact>>,
    pub(crate) active: Vec<usize>,
    pub(crate) never_slipping: Vec<usize>,
    /// Directions of the linear contacts, as pairs (contact, direction).
    pub(crate) linear: Vec<(usize, usize)>,
    inert: usize,
}

impl ContactClasses {
    pub(crate) fn new(model: &Model) -> Result<Self> {
        const CONTEXT: &str = "the contacts";
        let mut contact_classes = Self::default();
        let mut all = try_room(model.contacts().len(), CONTEXT)?;
        for contact in model.contacts() {
            all.push(copy(contact)?);
        }
        contact_classes.all = Arc::new(all);
        for (i, contact) in model.contacts().iter().enumerate() {
            match contact.role() {
                Role::Active => try_push(&mut contact_classes.active, i, CONTEXT)?,
                Role::Spring => try_push(&mut contact_classes.never_slipping, i, CONTEXT)?,
                Role::Inert => contact_classes.inert += 1,
            }
            if contact.role() != Role::Active {
                for direction in 0..contact.directions() {
                    try_push(&mut contact_classes.linear, (i, direction), CONTEXT)?;
                }
            }
        }
        Ok(contact_classes)
    }

    /// All contacts of the model, in its order.
    #[must_use]
    pub fn contacts(&self) -> &[Contact] {
        &self.all
    }

    /// Number of contacts without force.
    pub fn inert(&self) -> usize {
        self.inert
    }

    /// Position of the first direction of a linear contact in [`crate::condense::HarmonicBlock::linear_rows`]; the
    /// others follow.
    pub fn linear(&self, contact: usize) -> Option<usize> {
        self.linear.binary_search(&(contact, 0)).ok()
    }
}
