//! Tangent stiffness of the contacts at a static motion of the structure.

use crate::error::{Error, Result, try_copy};

/// Tangent stiffness of each contact that may slip or open, at a static motion; in the caller's units.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StaticTangents {
    /// Per contact the tangent stiffness over its directions, a square matrix, row-major; empty for linear contacts.
    of_contacts: Vec<Vec<f64>>,
}

impl StaticTangents {
    /// Empty tangents for `contacts` contacts.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(contacts: usize) -> Result<Self> {
        let mut of_contacts = Vec::new();
        of_contacts
            .try_reserve_exact(contacts)
            .map_err(|_| Error::out_of_memory("the tangents of the contacts"))?;
        of_contacts.resize_with(contacts, Vec::new);
        Ok(Self { of_contacts })
    }

    /// A copy that returns an error if memory is short.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn try_clone(&self) -> Result<Self> {
        let mut copy = Self::new(self.of_contacts.len())?;
        for (contact, tangent) in self.of_contacts.iter().enumerate() {
            copy.set(contact, tangent)?;
        }
        Ok(copy)
    }

    /// The symmetric part of each tangent, without forces that have no potential.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn symmetric(&self) -> Result<Self> {
        let mut part = self.try_clone()?;
        for (own, tangent) in part.of_contacts.iter_mut().zip(&self.of_contacts) {
            let directions = tangent.len().isqrt();
            for (i, t) in own.iter_mut().enumerate() {
                *t = 0.5 * (*t + tangent[i % directions * directions + i / directions]);
            }
        }
        Ok(part)
    }

    /// Sets the tangent of a contact, row-major.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn set(&mut self, contact: usize, tangent: &[f64]) -> Result<()> {
        if let Some(own) = self.of_contacts.get_mut(contact) {
            *own = try_copy(tangent, "the tangents of the contacts")?;
        }
        Ok(())
    }

    /// Stiffness of the force along direction k by the motion along direction l; `None` for a linear contact.
    #[must_use]
    pub fn stiffness(&self, contact: usize, k: usize, l: usize) -> Option<f64> {
        let tangent = self.of_contacts.get(contact)?;
        let directions = tangent.len().isqrt();
        tangent.get(k * directions + l).copied()
    }
}
