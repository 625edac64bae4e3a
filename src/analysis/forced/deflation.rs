//! Solutions of a forced response beside known ones, by deflation: Newton's method is led away from the solutions that are known at a
//! frequency.

use crate::analysis::forced::forced_discretised::ForcedDiscretised;
use crate::analysis::forced::known_curve::lies_on;
use crate::continuation::Point;
use crate::error::{Result, try_copy, try_push};
use crate::harmonics::discretised::Discretised;
use crate::interrupt::Interrupt;
use crate::results::Branch;

const CONTEXT: &str = "the deflation";

/// Factors of one harmonic of the known motion, from which deflated steps begin.
/// Kind: tuned; measured on: not recorded.
const DEFLATION_STARTS: [f64; 4] = [1.5, 3.0, 8.0, -2.0];

/// Most solutions that are left out at a place, from one start.
/// Kind: cap.
const DEFLATION_MOST_KNOWN: usize = 4;

/// Search for solutions away from known ones.
pub(crate) struct Deflation;

impl Deflation {
    /// The first solution on no known branch, at the frequency of a start near a known solution.
    ///
    /// # Errors
    /// Those of the problem.
    pub fn first_solution(
        response: &mut ForcedDiscretised<'_>,
        start: &Point,
        known: &[&Branch],
        periods: usize,
        interrupt: &Interrupt<'_>,
    ) -> Result<Option<Point>> {
        let Some(own) = response.solve_at(start, interrupt)? else {
            return Ok(None);
        };
        let mut left_out = Vec::new();
        try_push(&mut left_out, try_copy(own.unknowns(), CONTEXT)?, CONTEXT)?;
        let level = response.resolution();
        let set = response.levels().at(level)?.condensed.clone();
        let m = set.set().packed_len().max(1);
        for factor in DEFLATION_STARTS {
            // Each harmonic that carries the motion may be the one that resonates.
            for leading in 0..set.set().numbers().len() {
                let mut near = own.try_clone()?;
                let n = near.unknowns().len();
                for y in near.v[..n].chunks_exact_mut(m) {
                    let x = set.set().get(y, leading);
                    set.set().set(y, leading, x * factor);
                }
                if near.unknowns() == own.unknowns() {
                    continue;
                }
                if let Some(found) = Self::beside(response, &near, &mut left_out, known, periods, interrupt)? {
                    return Ok(Some(found));
                }
            }
        }
        Ok(None)
    }

    /// The first solution from a start that lies on no known branch. Known solutions that Newton's method finds are
    /// added to those left out.
    fn beside(
        response: &mut ForcedDiscretised<'_>,
        start: &Point,
        left_out: &mut Vec<Vec<f64>>,
        known: &[&Branch],
        periods: usize,
        interrupt: &Interrupt<'_>,
    ) -> Result<Option<Point>> {
        for _ in 0..DEFLATION_MOST_KNOWN {
            let Some(found) = response.solve_beside(start, left_out, interrupt)? else {
                return Ok(None);
            };
            let mut is_known = false;
            for branch in known {
                is_known |= lies_on(response, branch, &found, periods, interrupt)?;
            }
            if !is_known {
                return Ok(Some(found));
            }
            try_push(left_out, try_copy(found.unknowns(), CONTEXT)?, CONTEXT)?;
        }
        Ok(None)
    }
}
