//! A nonlinear mode with the curves that its branch points lead to, and those beyond a tongue of internal resonance.
//!
//! The even harmonics and the mean of an odd model are carried along, so that a broken symmetry is a branch point, too. Each curve
//! has children of its own, down to a bounded depth, see [`crate::analysis::modes::mode_entry`].

use crate::analysis::forced::inside_start::Entry;
use crate::analysis::modes::mode_curve::alone;
use crate::analysis::modes::mode_discretised::VANISHING_FUNDAMENTAL;
use crate::analysis::modes::mode_entry::{EntryWay, ModeEntry};
use crate::error::{Result, Status, try_push};
use crate::hooks::{Hooks, LogLevel};
use crate::model::Model;
use crate::options::{ModeOptions, SolverOptions};
use crate::results::stored::mode_branch::ModeField;
use crate::results::{Bifurcation, Branch, Descent, Recovery, Searched};
use crate::tracing::inner_ends::Dropped;
use core::cell::Cell;

const CONTEXT: &str = "the further curves of a mode";

/// Distance of a branch point, in log₁₀ of the amplitude, at which a curve that came back ends in it.
/// Kind: tuned; measured on: not recorded.
const MODE_BRANCHES_SAME: f64 = 2e-2;

/// A branch with the branches that it descends from.
struct Above<'b> {
    branch: &'b Branch,
    above: Option<&'b Self>,
}

/// Outcome of the search for a further curve.
#[allow(clippy::large_enum_variant)]
enum Found {
    Curve(Branch, Option<Dropped>),
    Known,
    Nothing,
}

struct ModeTree<'a> {
    model: &'a Model,
    solver: &'a SolverOptions,
    range: &'a ModeOptions<'a>,
    left: usize,
    searched: Searched,
}

/// A nonlinear mode with its further curves.
///
/// # Errors
/// As [`crate::analysis::modes::nonlinear_mode()`].
#[inline(never)]
pub(crate) fn with_branches(
    model: &Model,
    solver: &SolverOptions,
    range: &ModeOptions<'_>,
    hooks: &mut Hooks<'_>,
) -> Result<Branch> {
    let mut branch = alone(model, solver, range, None, hooks)?;
    if branch.status() == Status::StoppedByCaller || branch.points() == 0 {
        return Ok(branch);
    }
    let (depth, left) = range.size_of_tree();
    let mut tree = ModeTree {
        model,
        solver,
        range,
        left,
        searched: Searched::default(),
    };
    match tree.grow(&mut branch, None, depth, hooks) {
        // Curves that were found before a stop are kept.
        Err(e) if e.status == Status::StoppedByCaller => branch.set_ending(e.status, None, (false, false)),
        grown => grown?,
    }
    if branch.was_stopped() {
        branch.set_ending(Status::StoppedByCaller, None, (false, false));
    }
    branch.set_searched(tree.searched);
    Ok(branch)
}

impl ModeTree<'_> {
    /// Adds the children of a branch, and their children, down to `depth`. A child that is not found is left out.
    fn grow(
        &mut self,
        parent: &mut Branch,
        above: Option<&Above<'_>>,
        depth: usize,
        hooks: &mut Hooks<'_>,
    ) -> Result<()> {
        self.add_other_phase(parent, above, depth, hooks)?;
        for (number, bifurcation) in parent.bifurcations()?.into_iter().enumerate() {
            if !self.may_seek(depth) {
                continue;
            }
            for sense in [1.0, -1.0] {
                if self.left == 0 {
                    break;
                }
                let Some((v, tangent)) = parent.mode_data().and_then(|mode| mode.branch_point(number)) else {
                    break;
                };
                let way = EntryWay::BranchPoint { tangent, sense };
                let found = self.child(parent, (bifurcation.point, v, way), above, hooks)?;
                let (mut child, dropped) = match found {
                    Found::Curve(child, dropped) => (child, dropped),
                    Found::Known => continue,
                    Found::Nothing => {
                        self.searched.lost += 1;
                        continue;
                    }
                };
                child.set_descent(Descent {
                    bifurcation: Some(number),
                    kind: Some(bifurcation.kind),
                    merges_at: merges_at(parent, &child)?,
                    ..Descent::default()
                });
                // Beyond a broken symmetry lies the mirror image.
                let is_whole = dropped.is_some() || child.status() == Status::StoppedClosed;
                if !self.add(parent, child, above, depth, hooks)? {
                    return Ok(());
                }
                if is_whole {
                    break;
                }
            }
        }
        Ok(())
    }

    /// Counts a point from which a curve is sought; `false` where the tree is large enough.
    fn may_seek(&mut self, depth: usize) -> bool {
        let may = depth > 0 && self.left > 0;
        if may {
            self.searched.bifurcations += 1;
        } else {
            self.searched.left += 1;
        }
        may
    }

    /// Adds a child with its own children; `false` where the caller stopped the run.
    fn add(
        &mut self,
        parent: &mut Branch,
        mut child: Branch,
        above: Option<&Above<'_>>,
        depth: usize,
        hooks: &mut Hooks<'_>,
    ) -> Result<bool> {
        self.left -= 1;
        let goes_on = child.status() != Status::StoppedByCaller;
        let mut grown = Ok(());
        if goes_on {
            let place = Above { branch: parent, above };
            grown = self.grow(&mut child, Some(&place), depth.saturating_sub(1), hooks);
        } else {
            self.left = 0;
        }
        parent.push_child(child)?;
        grown?;
        Ok(goes_on)
    }

    /// Adds the curve beyond a tongue, where the fundamental of a branch vanishes at the start of the range.
    fn add_other_phase(
        &mut self,
        parent: &mut Branch,
        above: Option<&Above<'_>>,
        depth: usize,
        hooks: &mut Hooks<'_>,
    ) -> Result<()> {
        let Some(last) = parent.points().checked_sub(1).filter(|last| *last > 0) else {
            return Ok(());
        };
        let share = parent.mode_at(last).map_or(1.0, |point| point.fundamental_share);
        let Some((v, _)) = parent.mode_data().and_then(|mode| mode.state(last)) else {
            return Ok(());
        };
        let is_start = v.last().map(|p| p.to_bits()) == Some(self.range.log10_start.to_bits());
        if !is_start || share > VANISHING_FUNDAMENTAL {
            return Ok(());
        }
        let order = largest_harmonic(parent, last, hooks)?;
        if order < 2 || !self.may_seek(depth) {
            return Ok(());
        }
        let way = EntryWay::OtherPhase { order };
        match self.child(parent, (last, v, way), above, hooks)? {
            Found::Curve(mut child, _) => {
                child.set_descent(Descent {
                    internal_resonance: order,
                    ..Descent::default()
                });
                self.add(parent, child, above, depth, hooks)?;
            }
            Found::Known => {}
            Found::Nothing => self.searched.lost += 1,
        }
        Ok(())
    }

    /// The further curve to which a point of a branch leads.
    fn child(
        &self,
        parent: &Branch,
        (point, v, way): (usize, &[f64], EntryWay<'_>),
        above: Option<&Above<'_>>,
        hooks: &mut Hooks<'_>,
    ) -> Result<Found> {
        let mut known = Vec::new();
        try_push(&mut known, parent, CONTEXT)?;
        let mut next = above;
        while let Some(place) = next {
            try_push(&mut known, place.branch, CONTEXT)?;
            next = place.above;
        }
        // With all of their descendants: two ways may lead to one curve.
        let mut i = 0;
        while let Some(branch) = known.get(i).copied() {
            for child in branch.children() {
                try_push(&mut known, child, CONTEXT)?;
            }
            i += 1;
        }
        let entry = ModeEntry {
            from: parent.condensed_at(point),
            v,
            way,
            known: &known,
            outcome: Cell::default(),
        };
        let range = ModeOptions {
            guess: None,
            ..*self.range
        };
        match (
            alone(self.model, self.solver, &range, Some(&entry), hooks),
            entry.outcome.get(),
        ) {
            (Err(_), Entry::Known) => Ok(Found::Known),
            (Ok(branch), _) if branch.points() == 0 && branch.status() != Status::StoppedByCaller => Ok(Found::Nothing),
            (Ok(branch), Entry::Followed(dropped)) => Ok(Found::Curve(branch, dropped)),
            (Ok(branch), _) => Ok(Found::Curve(branch, None)),
            (Err(e), _) if matches!(e.status, Status::NoConvergence | Status::Singular) => {
                hooks.log(LogLevel::Warn, e.message());
                Ok(Found::Nothing)
            }
            (Err(e), _) => Err(e),
        }
    }
}

/// The harmonic with the largest motion at a point of a branch.
fn largest_harmonic(branch: &Branch, point: usize, hooks: &Hooks<'_>) -> Result<usize> {
    let highest = branch.carried_at(point).and_then(|carried| carried.last().copied());
    let x = Recovery::at(branch, point, &hooks.interrupt())?.all(highest.unwrap_or(1))?;
    let size = |row: &[_]| {
        row.iter()
            .fold(0.0_f64, |s, x: &num_complex::Complex64| s.hypot(x.norm()))
    };
    let rows = x.chunks_exact(branch.ndof().max(1)).map(size).enumerate().skip(1);
    Ok(rows.max_by(|(_, a), (_, b)| a.total_cmp(b)).map_or(0, |(h, _)| h))
}

/// Frequency at which a child came back to its parent; NaN where it did not. It is taken from the branch point, which
/// is more exact than the last point of the child.
fn merges_at(parent: &Branch, child: &Branch) -> Result<f64> {
    let merged = child.descent().map_or(f64::NAN, |descent| descent.merges_at);
    if merged.is_nan() {
        return Ok(merged);
    }
    let amplitude =
        |branch: &Branch, point: usize| branch.mode_data()?.field(ModeField::Log10Amplitude).get(point).copied();
    let distance = |b: &Bifurcation| amplitude(parent, b.point).map_or(f64::INFINITY, |p| (p - merged).abs());
    let all = parent.bifurcations()?;
    let nearest = all.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)));
    let last = child.omega().last().copied().unwrap_or(f64::NAN);
    Ok(nearest
        .filter(|b| distance(b) <= MODE_BRANCHES_SAME)
        .map_or(last, |b| b.omega))
}
