//! Changes of a model by parameters: of forces, constants of contacts, and matrices.

use crate::contact::force_derivative::Constant;
use crate::error::{Result, fail};
use crate::linalg::matrix_view::MatrixView;
use crate::linalg::sparse::{Csc, Form};
use crate::model::Model;
use crate::model::sector_matrices;
use crate::model::structure::{MatrixKind, Structure};
use num_complex::Complex64;

impl Model {
    /// Multiplies all forces, those of unbalances included.
    pub(crate) fn scale_forces(&mut self, factor: f64) {
        self.excitation_mut().scale(factor);
    }

    /// Sets a constant of a contact, for a normal load that of rest.
    ///
    /// # Errors
    /// `Index`; `Unsupported` for a constant that the law does not have; those of
    /// [`Contact::check_constants`](crate::contact::Contact::check_constants).
    pub(crate) fn set_constant(&mut self, id: usize, constant: Constant, value: f64) -> Result<()> {
        if constant == Constant::Preload {
            let loads = self.speed_loads().iter();
            let per_speed2 = loads
                .filter(|load| load.contact == id)
                .map(|load| load.per_speed2)
                .sum();
            return self.set_preload_at_speed(id, value, per_speed2);
        }
        let count = self.contacts().len();
        let Some(contact) = self.contact_mut(id) else {
            return fail!(Index, "contact id = {id}, but the model has {count} contacts");
        };
        if contact.by_constant(constant).is_none() {
            return fail!(
                Unsupported,
                "{} of contact {id}, but that is a {}, which has none",
                constant.name(),
                contact.law_name()
            );
        }
        let mut changed = contact.clone();
        match constant {
            Constant::Preload => changed.preload = value,
            Constant::Mu => changed.mu = value,
            Constant::Kt => changed.kt = value,
            Constant::Kn => changed.kn = value,
            Constant::Gap => changed.gap = value,
        }
        changed.check_constants()?;
        *contact = changed;
        if constant == Constant::Gap {
            for load in self.speed_loads_mut().iter_mut().filter(|load| load.contact == id) {
                load.gap = value;
            }
        }
        self.apply_speed();
        Ok(())
    }

    /// Adds a multiple of a direction to the mass, damping or stiffness matrix, in a cyclic model to the block of the
    /// sector itself.
    ///
    /// # Errors
    /// Those of [`MatrixView::copy_in`]; `Argument` for a matrix that was given per nodal diameter.
    pub(crate) fn add_direction(&mut self, which: MatrixKind, direction: &MatrixView<'_>, factor: f64) -> Result<()> {
        self.changed_structure().add_direction(which, direction, factor)
    }

    /// Multiplies the whole mass, damping or stiffness matrix, Rayleigh and modal damping included.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub(crate) fn scale_matrix(&mut self, which: MatrixKind, factor: f64) -> Result<()> {
        self.changed_structure().scale_matrix(which, factor)
    }
}

impl Structure {
    fn add_direction(&mut self, which: MatrixKind, direction: &MatrixView<'_>, factor: f64) -> Result<()> {
        let given = direction.copy_in("direction", self.degrees().given())?;
        if !self.blocks[which as usize].diameters.is_empty() {
            return fail!(
                Argument,
                "{} was given per nodal diameter: a direction changes the block of a sector",
                which.name()
            );
        }
        let degrees = self.degrees().clone();
        let n = degrees.independent();
        let added = if degrees.faces().is_some() {
            let blocks = sector_matrices::blocks(&degrees, &given, direction.part.symmetry())?;
            [blocks.own, blocks.next, blocks.previous]
        } else {
            [Some(sector_matrices::of_independent(&degrees, given)?), None, None]
        };
        let blocks = self.blocks_mut(which)?;
        let transposed = match (&blocks.next, &blocks.previous) {
            // The coupling to the previous sector no longer follows from the next one.
            (Some(next), None) if added[2].is_some() => Some(Csc::sum(n, &[(Complex64::ONE, next, Form::Transposed)])?),
            _ => None,
        };
        if transposed.is_some() {
            blocks.previous = transposed;
        }
        for (to, added) in [&mut blocks.own, &mut blocks.next, &mut blocks.previous]
            .into_iter()
            .zip(&added)
        {
            let Some(added) = added else { continue };
            let sum = match &*to {
                Some(old) => Csc::sum(
                    n,
                    &[(Complex64::ONE, old, Form::Plain), (factor.into(), added, Form::Plain)],
                )?,
                None => Csc::sum(n, &[(factor.into(), added, Form::Plain)])?,
            };
            *to = Some(sum);
        }
        Ok(())
    }

    fn scale_matrix(&mut self, which: MatrixKind, factor: f64) -> Result<()> {
        let blocks = self.blocks_mut(which)?;
        let own = [&mut blocks.own, &mut blocks.next, &mut blocks.previous];
        let given = own.into_iter().chain(&mut blocks.diameters).flatten();
        for value in given.flat_map(|a| &mut a.values) {
            *value *= factor;
        }
        if which == MatrixKind::Damping {
            self.rayleigh.0 *= factor;
            self.rayleigh.1 *= factor;
            for value in self.modal_damping.iter_mut().flatten().flat_map(|a| &mut a.values) {
                *value *= factor;
            }
        }
        Ok(())
    }
}
