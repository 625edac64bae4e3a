//! Tables of many contacts by factors that have few entries in a column, which solve for the unit forces of the contacts side by side and
//! read the table off at once: the motions of all degrees of freedom under each force are never stored.

use crate::condense::Condensed;
use crate::condense::by_factors::flexibility::{CONTEXT, Slopes, Workspace, made, read};
use crate::error::{Result, try_vec};
use crate::interrupt::Interrupt;
use num_complex::Complex64;

/// Coordinates from which their columns are solved side by side.
/// Kind: tuned; measured on: a rod of 1,000 with 300 sliders, a chain of 200 with 20, a rod of 2,000 with 10.
const SIDE_BY_SIDE_FROM: usize = 8;

impl Workspace {
    /// Whether the factors solve the columns of all contacts side by side. All slopes then take longer than the factors that those along
    /// one motion need.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub(crate) fn solves_side_by_side(&mut self, condensed: &Condensed) -> Result<bool> {
        let coordinates = condensed.coordinates();
        if coordinates < SIDE_BY_SIDE_FROM || self.loses_digits {
            return Ok(false);
        }
        Ok(made(&mut self.dynamic, condensed)?.slender().is_some())
    }

    /// Fills the table, but for slopes other than those of the response, with factors that solve many right sides side by side, and keeps
    /// the column of the excitation alone; `false` where the current factors are not such, or solutions lose digits that refined
    /// columns have, here or earlier.
    pub(crate) fn tabulate_side_by_side(
        &mut self,
        condensed: &Condensed,
        (i, omega): (usize, f64),
        slopes: Slopes,
        interrupt: &Interrupt<'_>,
    ) -> Result<bool> {
        let (n, coordinates) = (condensed.ndof(), condensed.coordinates());
        if !self.solves_side_by_side(condensed)? {
            return Ok(false);
        }
        self.table.slope.fill(Complex64::ZERO);
        let of_response = slopes == Slopes::OfResponse;
        if of_response {
            self.move_response(condensed, (i, omega), interrupt)?;
        }
        if self.columns.len() != n {
            self.columns = Vec::new();
            self.columns = try_vec(n, Complex64::ZERO, CONTEXT)?;
        }
        let block = &condensed.blocks()[i];
        block.force_at(omega, &mut self.columns);
        let dynamic = made(&mut self.dynamic, condensed)?;
        dynamic.solve(condensed, i, omega, &mut self.columns, false, interrupt)?;
        let response = &self.responses[i];
        let port = |c: usize| block.motions.rows.get(c).unwrap_or(response).terms().as_slice();
        let outputs = coordinates + 1;
        if self.along.len() != outputs {
            self.along = try_vec(outputs, Complex64::ZERO, CONTEXT)?;
        }
        let moved = if of_response { &self.products[..n] } else { &[] };
        if dynamic.term().is_some_and(|(term, _)| term.loses_digits()) {
            return Ok(false);
        }
        let Some(slender) = dynamic.slender() else {
            return Ok(false);
        };
        let largest = slender.flexibility(
            outputs,
            port,
            (&mut self.table.value, outputs),
            (moved, &mut self.along),
            interrupt,
        )?;
        if let Some((term, mut sides)) = dynamic.term() {
            term.add_to_flexibility(
                &mut sides,
                port,
                &mut self.table.value,
                moved,
                &mut self.along,
                interrupt,
            )?;
        }
        let excited = self
            .columns
            .iter()
            .fold(0.0_f64, |m, z| m.max(z.re.abs()).max(z.im.abs()));
        // Tables that are too large to be refined stay as they are.
        if dynamic.loses_digits(condensed, i, outputs, || largest.max(excited)) {
            self.loses_digits = true;
            return Ok(false);
        }
        let last = coordinates * outputs;
        read(
            block.motions.rows.iter().chain([&self.responses[i]]),
            &self.columns,
            &mut self.table.value[last..],
        );
        if of_response {
            let excited = moved.iter().zip(&self.columns).map(|(a, b)| a * b).sum::<Complex64>();
            self.along[coordinates] = excited;
            for (slope, along) in self
                .table
                .slope
                .iter_mut()
                .skip(coordinates)
                .step_by(outputs)
                .zip(&self.along)
            {
                *slope = -along;
            }
            self.add_slope_of_unbalance(block, omega);
        }
        Ok(true)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::condense::Reference;
    use crate::condense::test_chains::long_chain;
    use crate::options::SolverOptions;

    #[test]
    fn a_table_of_columns_side_by_side_is_that_of_columns_one_by_one() {
        for (n, contacts) in [(300, 40), (450, 20)] {
            let mut model = long_chain(n, contacts, (0.01, 1e-3));
            model.add_force(n - 2, 1, Complex64::new(0.7, -0.2)).unwrap();
            let options = SolverOptions {
                harmonics: 3,
                ..SolverOptions::default()
            };
            let interrupt = Interrupt::none();
            let condensed =
                Condensed::with_reference(&model, &options, 0.4, Some(Reference::Stuck), &interrupt).unwrap();
            let outputs = contacts + 1;
            let mut known = Workspace::new(&condensed, Some(7)).unwrap();
            let mut found = Workspace::new(&condensed, Some(7)).unwrap();
            for i in 0..condensed.blocks().len() {
                let at = (i, 0.4);
                let exact = known.evaluate(&condensed, i, at.1, true, &interrupt).unwrap().clone();
                found.tabulate(&condensed, at, Slopes::OfResponse, &interrupt).unwrap();
                // The columns of contacts are not kept.
                assert_eq!(found.columns.len(), n);
                let largest = exact.value.iter().map(|z| z.norm()).fold(0.0, f64::max);
                for (a, b) in found.table.value.iter().zip(&exact.value) {
                    assert!((a - b).norm() < 1e-13 * largest, "{n}, {i}: {a} {b}");
                }
                let slopes = |table: &[Complex64]| -> Vec<Complex64> {
                    table.iter().skip(contacts).step_by(outputs).copied().collect()
                };
                let (a, b) = (slopes(&found.table.slope), slopes(&exact.slope));
                let largest = b.iter().map(|z| z.norm()).fold(0.0, f64::max);
                for (a, b) in a.iter().zip(&b) {
                    assert!((a - b).norm() < 1e-11 * largest, "{n}, {i}: {a} {b}");
                }
            }
        }
    }
}
