//! Resonances of a structure on a basis, with its contacts stuck.

use crate::condense::Condensed;
use crate::contact::Role;
use crate::error::{Result, Status, try_copy, try_extend};
use crate::interrupt::Interrupt;
use crate::linalg::sparse_storage::sparse::Csc;
use crate::model::Model;
use crate::model::matrices::wave::Wave;
use crate::model::natural_modes::quadratic_problem::Quadratic;
use crate::model::natural_modes::resonances::{Resonance, damped_frequencies, gyroscopic_frequencies};
use crate::options::Range;
use num_complex::Complex64;

const CONTEXT: &str = "the resonances";

/// The resonances of all harmonics in which forces vibrate, see [`Model::forced_resonances`].
///
/// # Errors
/// As [`Model::forced_resonances`].
pub fn reduced_resonances(
    model: &Model,
    condensed: &Condensed,
    range: Range,
    interrupt: &Interrupt<'_>,
) -> Result<Option<Vec<Resonance>>> {
    let mut found = Vec::new();
    for block in condensed.blocks() {
        let excited = block.load.force.iter().any(|f| *f != Complex64::ZERO);
        let Some(view) = block.view.as_ref().filter(|_| block.number > 0 && excited) else {
            continue;
        };
        let n = block.matrices.reference.rows;
        let on_pattern = |values: Vec<Complex64>| -> Result<Csc> {
            Ok(Csc {
                rows: n,
                cols: n,
                col_ptr: try_copy(&block.matrices.reference.col_ptr, CONTEXT)?,
                row_idx: try_copy(&block.matrices.reference.row_idx, CONTEXT)?,
                values,
            })
        };
        let mut stiffness = block.own_stiffness(model)?;
        let stuck = model.contacts().iter().filter(|c| c.role() != Role::Inert);
        for (force, motion, k) in model.spring_rows(Wave::Harmonic(block.number), stuck)? {
            let (force, motion) = (view.row(&force)?, view.row(&motion)?);
            for &(j, y) in motion.terms() {
                for &(i, x) in force.terms() {
                    stiffness[j * n + i] += x.conj() * k * y;
                }
            }
        }
        if let Some(structural) = &block.matrices.structural {
            for (k, d) in stiffness.iter_mut().zip(structural.iter()) {
                *k += Complex64::I * d;
            }
        }
        let stiffness = on_pattern(stiffness)?;
        let mass = on_pattern(try_copy(&block.matrices.mass, CONTEXT)?)?;
        let damping = || on_pattern(try_copy(&block.matrices.damping, CONTEXT)?);
        let own = if model.structure().has_gyroscopic_modes(block.number)? {
            let problem = Quadratic {
                mass: &mass,
                damping: &damping()?,
                stiffness: &stiffness,
                modal: &[],
            };
            gyroscopic_frequencies(block.number, range, &problem, interrupt)
        } else {
            damped_frequencies(block.number, range, (&stiffness, &mass), damping, interrupt)
        };
        match own {
            Ok(Some(own)) => try_extend(&mut found, &own, CONTEXT)?,
            Err(e) if matches!(e.status, Status::OutOfMemory | Status::StoppedByCaller) => return Err(e),
            Ok(None) | Err(_) => return Ok(None),
        }
    }
    found.sort_by(|a, b| a.omega.total_cmp(&b.omega));
    Ok(Some(found))
}
