//! Harmonics of all degrees of freedom at a stored point.

use crate::error::{Result, fail};
use crate::interrupt::Interrupt;
use crate::results::{Branch, Recovery};
use num_complex::Complex64;

/// Harmonics as [`Branch::harmonics_at`], and the caller may stop it.
pub(crate) fn harmonics_at_with(
    branch: &Branch,
    point: usize,
    x: &mut [Complex64],
    interrupt: &Interrupt<'_>,
) -> Result<()> {
    branch.carried_of(point)?;
    let n = branch.ndof();
    let needed = (branch.run.harmonics + 1) * n;
    if x.len() != needed {
        return fail!(
            Dimension,
            "x has {} complex entries, needs (harmonics+1)*ndof = {needed}",
            x.len()
        );
    }
    let found = Recovery::at(branch, point, interrupt)?.all(branch.run.harmonics)?;
    x.copy_from_slice(&found);
    Ok(())
}
