//! Stiffness of a wave with springs and stuck contacts.

use crate::contact::Contact;
use crate::error::{Result, try_push};
use crate::linalg::sparse_storage::sparse::{Csc, Form};
use crate::model::Model;
use crate::model::matrices::spring::Row;
use crate::model::matrices::structure::MatrixKind;
use crate::model::matrices::wave::Wave;
use num_complex::Complex64;

/// A tie over the stiffness of the structure: natural frequencies are below those of tied sides by 10⁻⁸ or so, the rounding of K as large. Kind:
/// rounding.
const TIE: f64 = 1e8;

/// Springs of the model and `stuck` contacts in a wave.
#[doc(hidden)]
pub(crate) fn spring_rows<'c>(
    model: &Model,
    wave: Wave,
    stuck: impl Iterator<Item = &'c Contact>,
) -> Result<Vec<(Row, Row, f64)>> {
    let mut rows = Vec::new();
    each_spring(
        model,
        wave,
        stuck.map(|c| (c, c)),
        Contact::stiffness_at_small_motion,
        |force, motion, stiffness| try_push(&mut rows, (*force, *motion, stiffness), "the springs"),
    )?;
    Ok(rows)
}

/// Calls `take` for each spring of the model and for each of the given contacts' pairs of directions k and l.
/// `stiffness` returns the contact's stiffness between these directions, from the value that names the contact.
fn each_spring<'c, T: Copy>(
    model: &Model,
    wave: Wave,
    contacts: impl Iterator<Item = (T, &'c Contact)>,
    stiffness: impl Fn(T, usize, usize) -> f64,
    mut take: impl FnMut(&Row, &Row, f64) -> Result<()>,
) -> Result<()> {
    let structure = model.structure();
    let mut add = |force: &Row, motion: &Row, stiffness: f64| match stiffness {
        0.0 => Ok(()),
        f64::INFINITY => take(force, motion, tie(model, motion)),
        stiffness => take(force, motion, stiffness),
    };
    for s in model.springs() {
        let row = structure.row(&structure.spring_motion(s), wave);
        add(&row, &row, s.stiffness)?;
    }
    for (name, c) in contacts {
        let row = |k| structure.row(&structure.contact_motion(c, k), wave);
        for k in 0..c.directions() {
            for l in 0..c.directions() {
                add(&row(k), &row(l), stiffness(name, k, l))?;
            }
        }
    }
    Ok(())
}

/// Finite stiffness in place of an infinite one, as of a rigid slider that sticks: [`TIE`] times the stiffness of
/// the structure at its sides.
fn tie(model: &Model, motion: &Row) -> f64 {
    let own = |p| model.structure().wave_diagonal(MatrixKind::Stiffness, 0, p).norm();
    TIE * motion.iter().flatten().map(|(p, _)| own(*p)).fold(0.0, f64::max)
}

/// Stiffness K of a wave, with Ω²K₁ at a fixed speed, aerodynamic forces per displacement, the springs of the model,
/// and the `stuck` contacts as springs.
#[doc(hidden)]
pub(crate) fn sprung_stiffness<'c>(model: &Model, wave: Wave, stuck: impl Iterator<Item = &'c Contact>) -> Result<Csc> {
    model.stiffness_with(wave, stuck.map(|c| (c, c)), Contact::stiffness_at_small_motion)
}

/// Stiffness of a wave as `sprung_stiffness` has it, with the stiffness that a function has for each contact.
pub(crate) fn stiffness_with<'c, T: Copy>(
    model: &Model,
    wave: Wave,
    contacts: impl Iterator<Item = (T, &'c Contact)>,
    stiffness: impl Fn(T, usize, usize) -> f64,
) -> Result<Csc> {
    let structure = model.structure();
    let n = structure.ndof();
    let own = structure.acting_stiffness(wave)?;
    let mut entries = Vec::new();
    each_spring(model, wave, contacts, stiffness, |force, motion, stiffness| {
        for (p, x) in force.iter().flatten() {
            for (q, y) in motion.iter().flatten() {
                try_push(&mut entries, (*p, *q, x.conj() * y * stiffness), "the springs")?;
            }
        }
        Ok(())
    })?;
    if entries.is_empty() {
        return Ok(own);
    }
    let springs = Csc::from_triplets(n, n, entries)?;
    Csc::sum(
        n,
        &[
            (Complex64::ONE, &own, Form::Plain),
            (Complex64::ONE, &springs, Form::Plain),
        ],
    )
}
