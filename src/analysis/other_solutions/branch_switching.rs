//! Branches that branch off from a forced response: of the double period, of broken symmetry, and those of simple branch
//! points.
//!
//! Each bifurcation at which a motion with one frequency branches off is the start of a child, see
//! [`crate::analysis::forced::inside_start`]. Where the period doubles, the child is a response of the same model at half the
//! frequency, whose odd harmonics are those that its parent does not have. Where the symmetry breaks these are the even ones
//! and the mean. Children have children of their own, down to a bounded depth.

use crate::analysis::forced::forced_curve::{forced_from_inside, forced_harmonics, misses_fundamental};
use crate::analysis::forced::inside_start::Inside;
use crate::analysis::forced::start_net::OWN_SHARE;
use crate::error::{Result, Status, try_push, try_vec};
use crate::fourier::gcd;
use crate::hooks::{Hooks, LogLevel};
use crate::interrupt::Interrupt;
use crate::model::Model;
use crate::options::{Content, ForcedOptions, Measure, Response, SolverOptions};
use crate::results::{Bifurcation, BifurcationKind, Branch, Descent, Recovery, Searched};
use crate::tracing::inner_ends::Dropped;
use core::cell::Cell;
use num_complex::Complex64;

const CONTEXT: &str = "the branches that branch off";

/// Distance of a bifurcation to the end of a known child, over the range, at which that child ends there.
/// Kind: tuned; measured on: not recorded.
const BRANCH_SWITCHING_SAME: f64 = 2e-2;

/// Place of a branch in the tree.
pub(crate) struct Place<'p> {
    /// Number of periods of the forces in one period of the branch.
    pub periods: usize,
    /// The harmonics that the parent does not have.
    pub dropped: Option<Dropped>,
    /// The parent, with its own place; `None` for the root.
    pub above: Option<(&'p Branch, &'p Place<'p>)>,
}

impl Place<'_> {
    /// Place of a branch without a parent.
    pub fn root() -> Self {
        Self {
            periods: 1,
            dropped: None,
            above: None,
        }
    }
}

/// Outcome of the search for a curve.
#[allow(clippy::large_enum_variant)]
pub(crate) enum Found {
    /// A new curve; and the harmonics that it has but the branch that it leaves has not.
    Curve(Branch, Option<Dropped>),
    /// The curve is known already.
    Known,
    /// No curve was found.
    Nothing,
}

/// A tree of branches to which children are added.
pub(crate) struct Tree<'a> {
    pub model: &'a Model,
    pub solver: &'a SolverOptions,
    pub range: &'a ForcedOptions<'a>,
    /// Number of branches that may still be added.
    pub left: usize,
    /// Lowest harmonic of the requested response.
    pub base: usize,
    pub searched: Searched,
}

impl Tree<'_> {
    /// Adds the children of a branch, and their children, down to `depth`.
    ///
    /// # Errors
    /// `OutOfMemory`; those of callbacks. A child that is not found is none.
    pub fn grow(&mut self, parent: &mut Branch, at: &Place<'_>, depth: usize, hooks: &mut Hooks<'_>) -> Result<()> {
        leave_own_starts(parent, at, &hooks.interrupt())?;
        // Bifurcations at which a known child came back.
        let mut taken = Vec::new();
        for (number, bifurcation) in parent.bifurcations()?.into_iter().enumerate() {
            let factor = match bifurcation.kind {
                BifurcationKind::PeriodDoubling => 2,
                BifurcationKind::BranchPoint => 1,
                BifurcationKind::Fold | BifurcationKind::NeimarkSacker => continue,
            };
            if taken.contains(&number) {
                continue;
            }
            if depth == 0 || self.left == 0 {
                self.searched.left += 1;
                continue;
            }
            self.searched.bifurcations += 1;
            for sense in [1.0, -1.0] {
                if self.left == 0 {
                    break;
                }
                let way = (at.periods * factor, factor, sense);
                let (mut child, dropped) = match self.child(parent, &bifurcation, at, way, hooks)? {
                    Found::Curve(child, dropped) => (child, dropped),
                    Found::Known => break,
                    Found::Nothing => {
                        self.searched.lost += 1;
                        break;
                    }
                };
                self.left -= 1;
                let came_back = child.descent().map_or(f64::NAN, |descent| descent.merges_at);
                let other = self.end_of(parent, number, &bifurcation, came_back * factor as f64, at)?;
                child.set_descent(Descent {
                    bifurcation: Some(number),
                    kind: Some(bifurcation.kind),
                    periods: factor,
                    // The bifurcation is more exact than the place between two points of the child.
                    merges_at: other.map_or(came_back, |(_, omega)| omega / factor as f64),
                    ..Descent::default()
                });
                if let Some((other, _)) = other {
                    try_push(&mut taken, other, CONTEXT)?;
                }
                if child.status() == Status::StoppedByCaller {
                    self.left = 0;
                    parent.push_child(child)?;
                    return Ok(());
                }
                // Beyond a broken symmetry lies the mirror image.
                let is_whole = dropped.is_some() || child.status() == Status::StoppedClosed;
                let place = Place {
                    periods: at.periods * factor,
                    dropped,
                    above: Some((parent, at)),
                };
                let grown = self.grow(&mut child, &place, depth.saturating_sub(1), hooks);
                parent.push_child(child)?;
                grown?;
                if is_whole {
                    break;
                }
            }
        }
        Ok(())
    }

    /// Adds a detached curve, with its children down to `depth`. `periods` is the number of periods of the branch in
    /// one period of the curve.
    ///
    /// # Errors
    /// As [`Self::grow`]; what was found before is added all the same.
    pub fn add(
        &mut self,
        branch: &mut Branch,
        mut found: Branch,
        (periods, depth): (usize, usize),
        hooks: &mut Hooks<'_>,
    ) -> Result<()> {
        let mut grown = Ok(());
        if found.status() == Status::StoppedByCaller {
            self.left = 0;
        } else {
            let root = Place::root();
            let place = Place {
                periods,
                above: (periods == 1).then_some((&*branch, &root)),
                dropped: None,
            };
            grown = self.grow(&mut found, &place, depth, hooks);
        }
        branch.push_child(found)?;
        grown
    }

    /// The bifurcation of the parent at which a child ends that came back at a frequency, by its index, and the
    /// frequency of this bifurcation.
    fn end_of(
        &self,
        parent: &Branch,
        own: usize,
        from: &Bifurcation,
        omega: f64,
        at: &Place<'_>,
    ) -> Result<Option<(usize, f64)>> {
        if omega.is_nan() {
            return Ok(None);
        }
        let width = (self.range.omega_stop - self.range.omega_start).abs() / at.periods as f64;
        let all = parent.bifurcations()?;
        let others = all.iter().enumerate().filter(|(i, b)| *i != own && b.kind == from.kind);
        let distance = |b: &Bifurcation| (b.omega - omega).abs();
        let nearest = others.min_by(|(_, a), (_, b)| distance(a).total_cmp(&distance(b)));
        Ok(nearest
            .filter(|(_, b)| distance(b) <= BRANCH_SWITCHING_SAME * width)
            .map(|(i, b)| (i, b.omega)))
    }

    /// The child that branches off at a bifurcation.
    fn child(
        &self,
        parent: &Branch,
        from: &Bifurcation,
        at: &Place<'_>,
        (periods, factor, sense): (usize, usize, f64),
        hooks: &mut Hooks<'_>,
    ) -> Result<Found> {
        let model = match self.model.with_longer_period(periods) {
            Ok(model) => model,
            Err(e) if e.status == Status::Unsupported || e.status == Status::Argument => {
                hooks.log(LogLevel::Warn, e.message());
                return Ok(Found::Nothing);
            }
            Err(e) => return Err(e),
        };
        let interrupt = hooks.interrupt();
        let carried = parent.carried_at(from.point).unwrap_or(&[]);
        let (base, highest) = (carried.iter().fold(0, |a, b| gcd(a, *b)), carried.last().copied());
        let ndof = model.ndof();
        let highest = highest.unwrap_or(0);
        let own = Recovery::at(parent, from.point, &interrupt)?.all(highest)?;
        let mut guess = try_vec((highest * factor + 1) * ndof, Complex64::ZERO, CONTEXT)?;
        for (h, row) in own.chunks_exact(ndof).enumerate() {
            guess[h * factor * ndof..(h * factor + 1) * ndof].copy_from_slice(row);
        }
        let mut known = Vec::new();
        // Branches of the same period: siblings, and where the period remains the parent and those above.
        for sibling in parent.children().iter().filter(|sibling| sibling.periods() == factor) {
            try_push(&mut known, sibling, CONTEXT)?;
        }
        if factor == 1 {
            try_push(&mut known, parent, CONTEXT)?;
            let mut above = at.above;
            while let Some((branch, place)) = above.filter(|(_, place)| place.periods == at.periods) {
                try_push(&mut known, branch, CONTEXT)?;
                above = place.above;
            }
        }
        let inside = Inside {
            omega: from.omega / factor as f64,
            content: Content { base, even: true },
            leaves: Some(sense),
            known: &known,
            periods,
            entry: Cell::default(),
            net: None,
            deflation: None,
        };
        self.at_period(&model, &inside, &guess, (periods, parent.response_dof()), hooks)
    }

    /// A curve that is entered inside the range, on the model with a longer period.
    pub fn at_period(
        &self,
        model: &Model,
        inside: &Inside<'_>,
        guess: &[Complex64],
        (periods, response_dof): (usize, usize),
        hooks: &mut Hooks<'_>,
    ) -> Result<Found> {
        let scale = 1.0 / periods as f64;
        let mut at = Vec::new();
        for omega in self.range.at {
            try_push(&mut at, omega * scale, CONTEXT)?;
        }
        let mut responses = Vec::new();
        for response in self.range.responses {
            let measure = match response.measure {
                Measure::Fundamental => Measure::Harmonic(self.base * periods),
                Measure::Harmonic(h) => Measure::Harmonic(h.saturating_mul(periods)),
                other => other,
            };
            try_push(&mut responses, Response { measure, ..*response }, CONTEXT)?;
        }
        let forced = forced_harmonics(self.model)?;
        if responses.is_empty() && misses_fundamental(&forced_harmonics(model)?) && !misses_fundamental(&forced) {
            let measure = Measure::Harmonic(self.base * periods);
            try_push(
                &mut responses,
                Response {
                    measure,
                    ..Response::default()
                },
                CONTEXT,
            )?;
        }
        let solver = SolverOptions {
            harmonics: self.solver.harmonics.saturating_mul(periods),
            max_harmonics: self.solver.max_harmonics.saturating_mul(periods),
            response_dof: Some(response_dof),
            ..*self.solver
        };
        let range = ForcedOptions {
            omega_start: self.range.omega_start * scale,
            omega_stop: self.range.omega_stop * scale,
            at: &at,
            guess: Some(guess),
            responses: &responses,
            together: self.range.together,
            ..ForcedOptions::default()
        };
        match forced_from_inside(model, &solver, &range, inside, hooks) {
            Ok(None) => Ok(Found::Known),
            Ok(Some((branch, _))) if branch.points() == 0 => Ok(Found::Nothing),
            Ok(Some((branch, dropped))) => Ok(Found::Curve(branch, dropped)),
            Err(e)
                if matches!(
                    e.status,
                    Status::NoConvergence | Status::Singular | Status::NoBoundedSolution
                ) =>
            {
                hooks.log(LogLevel::Warn, e.message());
                Ok(Found::Nothing)
            }
            Err(e) => Err(e),
        }
    }
}

/// Removes the bifurcations of a branch at which it leaves its parent, or comes back to it: at these points its
/// motions lose the harmonics that the parent does not have.
fn leave_own_starts(branch: &mut Branch, place: &Place<'_>, interrupt: &Interrupt<'_>) -> Result<()> {
    let Some(dropped) = place.dropped else {
        return Ok(());
    };
    let mut own = Vec::new();
    for at in branch.bifurcations()? {
        if at.kind == BifurcationKind::BranchPoint && is_without(branch, at.point, dropped, interrupt)? {
            try_push(&mut own, at.point, CONTEXT)?;
        }
    }
    branch.leave_bifurcations(&own);
    Ok(())
}

/// Whether the harmonics `dropped` nearly vanish in the motion of a point.
fn is_without(branch: &Branch, point: usize, dropped: Dropped, interrupt: &Interrupt<'_>) -> Result<bool> {
    let highest = branch.carried_at(point).and_then(|carried| carried.last().copied());
    let x = Recovery::at(branch, point, interrupt)?.all(highest.unwrap_or(0))?;
    let (mut own, mut all) = (0.0_f64, 0.0_f64);
    for (h, row) in x.chunks_exact(branch.ndof().max(1)).enumerate() {
        let size = row.iter().fold(0.0_f64, |size, x| size.hypot(x.norm()));
        all = all.hypot(size);
        if dropped.has(h) {
            own = own.hypot(size);
        }
    }
    Ok(own <= OWN_SHARE * all)
}
