//! Curves of a forced response without connection to the branch, by deflation: at points of the response Newton's method is led away
//! from the solutions that are known there. It needs neither a nonlinear mode nor a peak over the force, and shows those alone that its
//! starts lead to.

use crate::adaptivity::discretised::Discretised;
use crate::analysis::branch_switching::{Found, Place, Tree};
use crate::analysis::forced_discretised::ForcedDiscretised;
use crate::analysis::inside_start::Inside;
use crate::analysis::known_curve::lies_on;
use crate::continuation::Point;
use crate::error::{Result, Status, try_copy, try_push, try_vec};
use crate::hooks::Hooks;
use crate::interrupt::Interrupt;
use crate::options::Content;
use crate::results::{Branch, Descent, Recovery};
use core::cell::Cell;
use num_complex::Complex64;

const CONTEXT: &str = "the deflation";

/// Shares of the points of the response at which solutions are sought, beside its peaks, of which at most so many count.
const DEFLATION_PLACES: [f64; 5] = [0.1, 0.3, 0.5, 0.7, 0.9];
const DEFLATION_MOST_PEAKS: usize = 3;

/// Factors of the motion at a place, harmonics of half the highest and all, from which deflated steps begin.
const DEFLATION_STARTS: [f64; 4] = [1.5, 3.0, 8.0, -2.0];

/// Most solutions that are left out at a place, from one start.
const DEFLATION_MOST_KNOWN: usize = 4;

/// Solutions that are led away from the known ones.
pub(super) struct Deflation {
    /// Solutions that were found, known ones among them.
    pub solutions: Cell<usize>,
}

impl Deflation {
    /// The first solution at the frequency of the start, near which a known one lies, that lies on no known branch.
    ///
    /// # Errors
    /// Those of the problem.
    pub fn first_solution(
        &self,
        response: &mut ForcedDiscretised<'_>,
        start: &Point,
        (known, periods): (&[&Branch], usize),
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
                if let Some(found) = self.beside(response, (&near, &mut left_out), (known, periods), interrupt)? {
                    return Ok(Some(found));
                }
            }
        }
        Ok(None)
    }

    /// The first solution from a start that lies on no known branch; the known ones are left out as they are found.
    fn beside(
        &self,
        response: &mut ForcedDiscretised<'_>,
        (start, left_out): (&Point, &mut Vec<Vec<f64>>),
        (known, periods): (&[&Branch], usize),
        interrupt: &Interrupt<'_>,
    ) -> Result<Option<Point>> {
        for _ in 0..DEFLATION_MOST_KNOWN {
            let Some(found) = response.solve_beside(start, left_out, interrupt)? else {
                return Ok(None);
            };
            self.solutions.set(self.solutions.get() + 1);
            let mut is_known = false;
            for branch in known {
                is_known |= lies_on(response, branch, (&found, periods), interrupt)?;
            }
            if !is_known {
                return Ok(Some(found));
            }
            try_push(left_out, try_copy(found.unknowns(), CONTEXT)?, CONTEXT)?;
        }
        Ok(None)
    }
}

impl Tree<'_> {
    /// Adds the curves that deflation finds beside a branch, with their children down to `depth`.
    ///
    /// # Errors
    /// `OutOfMemory`; `StoppedByCaller`; those of callbacks.
    pub fn add_deflated(&mut self, branch: &mut Branch, depth: usize, hooks: &mut Hooks<'_>) -> Result<()> {
        let last = branch.points().saturating_sub(1);
        let mut places = Vec::new();
        for share in DEFLATION_PLACES {
            try_push(&mut places, (last as f64 * share) as usize, CONTEXT)?;
        }
        for peak in branch.peaks().iter().take(DEFLATION_MOST_PEAKS) {
            try_push(&mut places, peak.point, CONTEXT)?;
        }
        for point in places {
            let Some(omega) = branch.omega_at(point).filter(|_| self.left > 0) else {
                continue;
            };
            self.searched.deflations += 1;
            let Found::Curve(curve, _) = self.deflated(branch, (point, omega), hooks)? else {
                continue;
            };
            let mut found = self.whole(self.model, &curve, 1, hooks)?.unwrap_or(curve);
            if self.shares_an_end(&found, branch, &hooks.interrupt())? {
                continue;
            }
            self.left -= 1;
            self.searched.deflated += 1;
            found.set_descent(Descent::default());
            if found.status() != Status::StoppedByCaller {
                let root = Place::root();
                let place = Place {
                    above: Some((branch, &root)),
                    ..Place::root()
                };
                self.grow(&mut found, &place, depth, hooks)?;
            }
            branch.push_child(found)?;
        }
        Ok(())
    }

    /// The curve of a solution beside a point of the response.
    fn deflated(&self, branch: &Branch, (point, omega): (usize, f64), hooks: &mut Hooks<'_>) -> Result<Found> {
        let mut known = Vec::new();
        try_push(&mut known, branch, CONTEXT)?;
        for sibling in branch.children().iter().filter(|sibling| sibling.periods() == 1) {
            try_push(&mut known, sibling, CONTEXT)?;
        }
        let highest = branch.carried_at(point).and_then(|carried| carried.last().copied());
        let highest = highest.unwrap_or(1);
        let motion = Recovery::at(branch, point, &hooks.interrupt())?.all(highest)?;
        let mut guess = try_vec(motion.len(), Complex64::ZERO, CONTEXT)?;
        guess.copy_from_slice(&motion);
        let deflation = Deflation {
            solutions: Cell::default(),
        };
        let inside = Inside {
            omega,
            content: Content::of(&guess, &self.model.felt_by_contacts()?).0,
            leaves: None,
            known: &known,
            periods: 1,
            entry: Cell::default(),
            net: None,
            deflation: Some(&deflation),
        };
        self.at_period(self.model, (&inside, &guess), (1, branch.response_dof()), hooks)
    }
}
