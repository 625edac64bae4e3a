//! Craig-Bampton reduction: the motion of kept degrees of freedom, the static motion that follows them, and natural modes with these
//! fixed (R. R. Craig and M. C. C. Bampton, AIAA Journal 6 (1968), doi:10.2514/3.4741).

use crate::reduction::basis_motions::Motions;
use crate::reduction::entries::Entries;
use crate::reduction::pencil::{Modes, Pencil, TOGETHER, factored};
use crate::texts::outcome::Outcome;
use hbvib::Interrupt;
use hbvib_io::{Matrices, Matrix};
use num_complex::Complex64;
use std::f64::consts::TAU;

/// The interior, with the kept degrees of freedom fixed.
pub struct FixedInterface {
    inner: Pencil,
}

impl FixedInterface {
    /// The interior of a stiffness and a mass, and the columns of the kept degrees of freedom; rows that are fixed have no motion.
    ///
    /// # Errors
    /// A sentence: complex matrices, an interior that the kept degrees of freedom do not hold; those of the library.
    pub fn new(found: &Matrices, kept: &[usize], fixed: &[usize]) -> Outcome<(Self, Vec<Vec<f64>>)> {
        let inner = Pencil::without(kept.iter().chain(fixed), found)?;
        if inner.rows.is_empty() {
            return Err("all degrees of freedom are kept: there is nothing to reduce".into());
        }
        let stiffness = found.stiffness.as_ref().ok_or("needs stiffness and mass")?;
        let columns = constraint_modes(&inner, stiffness, kept)?;
        Ok((Self { inner }, columns))
    }

    /// The lowest modes with the kept degrees of freedom fixed.
    ///
    /// # Errors
    /// Those of the library.
    pub fn modes(&self, modes: Modes) -> Outcome<Motions> {
        let found = self.inner.lowest(modes);
        let (found, wanted) = found.map_err(|e| format!("modes with fixed interface: {e}"))?;
        let shapes = found.shapes.chunks_exact(self.inner.order());
        Ok(Motions {
            columns: shapes.take(wanted).map(|shape| self.inner.spread(shape)).collect(),
            hertz: found.omega.iter().take(wanted).map(|omega| omega / TAU).collect(),
            is_complete: matches!(modes, Modes::Count(count) if wanted < count || count >= self.inner.order()),
        })
    }
}

/// Static motion of the interior under unit motions of the kept degrees of freedom.
fn constraint_modes(inner: &Pencil, stiffness: &Matrix, kept: &[usize]) -> Outcome<Vec<Vec<f64>>> {
    let (n, stiffness) = (stiffness.rows, Entries::of("stiffness", stiffness)?);
    let held = |e: hbvib::Error| format!("the interior is not held by the kept degrees of freedom: {e}");
    let mut factor = factored(&inner.stiffness).map_err(held)?;
    let mut columns = Vec::with_capacity(kept.len());
    for some in kept.chunks(TOGETHER) {
        let mut load = Vec::with_capacity(some.len() * inner.order());
        for row in some {
            let mut unit = vec![0.0; n];
            unit[*row] = 1.0;
            let force = stiffness.times(&unit);
            load.extend(inner.rows.iter().map(|row| Complex64::from(-force[*row])));
        }
        factor.solve(&mut load, false, &Interrupt::none()).map_err(held)?;
        for (row, motion) in some.iter().zip(load.chunks_exact(inner.order())) {
            let mut column = inner.spread(motion);
            column[*row] = 1.0;
            columns.push(column);
        }
    }
    Ok(columns)
}
