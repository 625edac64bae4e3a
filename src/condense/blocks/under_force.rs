//! A condensed mode under a force in its fundamental: the forced response with the same harmonics and contacts.

use crate::condense::Condensed;
use crate::condense::blocks::harmonic_block::{
    Artificial, BlockLoad, BlockMatrices, BlockMotions, HarmonicBlock, TiedValues,
};
use crate::error::{Result, try_copy, try_push};
use crate::linalg::sparse_storage::sparse::{Csc, Form};
use num_complex::Complex64;
use std::sync::Arc;

const CONTEXT: &str = "the matrices per harmonic";

/// The structure of a mode under the force `force` in the fundamental, in the caller's unit, without artificial
/// damping. To the damping of harmonic h are added `damping(h)` and `by_mass` times the mass matrix.
///
/// # Errors
/// Those of `damping`; `OutOfMemory`.
pub(crate) fn under_force(
    condensed: &Condensed,
    force: &[Complex64],
    damping: impl Fn(usize) -> Result<Option<Csc>>,
    by_mass: f64,
) -> Result<Condensed> {
    let mut blocks = Vec::new();
    for block in &condensed.blocks {
        let mut forced = block.with_damping(damping(block.number)?.as_ref(), by_mass)?;
        if block.number == 1 {
            for (to, f) in forced.load.force.iter_mut().zip(force) {
                *to = f / condensed.length;
            }
        }
        try_push(&mut blocks, forced, CONTEXT)?;
    }
    condensed.with_blocks(condensed.set.try_clone()?, blocks)
}

impl HarmonicBlock {
    /// A copy of the block with added damping and without the artificial damping of the mode.
    fn with_damping(&self, added: Option<&Csc>, by_mass: f64) -> Result<Self> {
        let n = self.matrices.reference.rows;
        let mut terms = Vec::new();
        try_push(
            &mut terms,
            (Complex64::ONE, &*self.matrices.reference, Form::Plain),
            CONTEXT,
        )?;
        if let Some(added) = added {
            // A zero factor adds the pattern alone.
            try_push(&mut terms, (Complex64::ZERO, added, Form::Plain), CONTEXT)?;
        }
        let reference = Csc::sum(n, &terms)?;
        let aligned = |values: &[Complex64]| -> Result<Vec<Complex64>> {
            let mut own = self.matrices.reference.try_clone()?;
            own.values.copy_from_slice(values);
            own.aligned(&reference)
        };
        let structural = self
            .matrices
            .structural
            .as_ref()
            .map(|values| aligned(values).map(Arc::new));
        let mass = aligned(&self.matrices.mass)?;
        let mut damping = aligned(&self.matrices.damping)?;
        for (c, m) in damping.iter_mut().zip(&mass) {
            *c += by_mass * m;
        }
        if let Some(added) = added {
            for (c, more) in damping.iter_mut().zip(added.aligned(&reference)?) {
                *c += more;
            }
        }
        Ok(Self {
            number: self.number,
            next: self.next,
            matrices: BlockMatrices {
                stiffness: Arc::new(aligned(&self.matrices.stiffness)?),
                structural: structural.transpose()?,
                damping: Arc::new(damping),
                modal: self.matrices.modal.clone(),
                mass: Arc::new(mass),
                artificial: Artificial::None,
                tied: match &self.matrices.tied {
                    Some(tied) => Some(TiedValues {
                        stiffness: aligned(&tied.stiffness)?,
                        gyroscopic: aligned(&tied.gyroscopic)?,
                    }),
                    None => None,
                },
                reference: Arc::new(reference),
            },
            source: None,
            without_source: self.without_source,
            load: BlockLoad {
                force: try_copy(&self.load.force, CONTEXT)?,
                unbalance: None,
            },
            motions: BlockMotions {
                rows: self.motions.rows.clone(),
                structural_rows: try_copy(&self.motions.structural_rows, CONTEXT)?,
                linear_rows: self.motions.linear_rows.clone(),
                springs: try_copy(&self.motions.springs, CONTEXT)?,
            },
            view: self.view.clone(),
        })
    }
}
