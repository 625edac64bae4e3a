//! Stability along a branch: fields of the curve, bifurcations, and the stretches between them.

use crate::error::{Result, try_push};
use crate::results::stored::branch::Branch;
use crate::results::verdicts::verdict::{Bifurcation, BifurcationKind, Located, Stretch};

/// The bifurcations in the order of the branch.
pub(crate) fn bifurcations(branch: &Branch) -> Result<Vec<Bifurcation>> {
    let mut found = Vec::new();
    if branch.mode.is_some() {
        // A nonlinear mode has no multipliers: its branch points are those of its equations, and its folds turn in amplitude.
        let located = branch.special.bifurcations.iter().map(|located| located.bifurcation);
        for bifurcation in located.filter(|found| found.kind == BifurcationKind::BranchPoint) {
            try_push(&mut found, bifurcation, "the bifurcations")?;
        }
        return Ok(found);
    }
    for located in &branch.special.bifurcations {
        let mut bifurcation = located.bifurcation;
        match bifurcation.kind {
            BifurcationKind::Fold if bifurcation.unstable == [None; 2] => {
                bifurcation.unstable = unstable_around(branch, located.after);
                if let Some(other) = beside(branch, located, BifurcationKind::BranchPoint)
                    && changes_nothing(bifurcation.unstable)
                {
                    bifurcation.unstable = other.unstable;
                }
            }
            // Harmonics are truncated: the fold and the multiplier 1 that belongs to it may lie on both sides of a
            // point of the curve.
            BifurcationKind::BranchPoint => {
                if let Some(fold) = beside(branch, located, BifurcationKind::Fold)
                    && changes_nothing(unstable_around(branch, fold.after))
                {
                    continue;
                }
            }
            BifurcationKind::Fold | BifurcationKind::PeriodDoubling | BifurcationKind::NeimarkSacker => {}
        }
        try_push(&mut found, bifurcation, "the bifurcations")?;
    }
    Ok(found)
}

/// A bifurcation of the given kind that is at most one point of the curve away.
fn beside(branch: &Branch, from: &Located, kind: BifurcationKind) -> Option<Beside> {
    let near = |other: &&Located| other.bifurcation.kind == kind && other.after.abs_diff(from.after) <= 1;
    let found = branch.special.bifurcations.iter().find(near)?;
    Some(Beside {
        after: found.after,
        unstable: found.bifurcation.unstable,
    })
}

/// Numbers of unstable directions of the points of the curve before and after the first `after` ones.
fn unstable_around(branch: &Branch, after: usize) -> [Option<usize>; 2] {
    let at = |point: Option<usize>| -> Option<usize> {
        let number = *branch.stability.unstable_directions.get(point?)?;
        // Small whole numbers.
        number.is_finite().then_some(number as usize)
    };
    [at(after.checked_sub(1)), at(Some(after))]
}

/// The curve for a plot, in stretches of constant stability that meet at bifurcations, or at a point of the curve.
pub(crate) fn stretches(branch: &Branch) -> Result<Vec<Stretch>> {
    const CONTEXT: &str = "the stretches of the curve";
    let bifurcations = branch.bifurcations()?;
    let is_unstable = |point: usize| {
        branch
            .stability
            .unstable_directions
            .get(point)
            .is_some_and(|n| *n > 0.0)
    };
    let mut found: Vec<Stretch> = Vec::new();
    for (i, point) in branch
        .omega()
        .iter()
        .copied()
        .zip(branch.amplitude().iter().copied())
        .enumerate()
    {
        match found.last_mut() {
            Some(last) if last.unstable == is_unstable(i) => try_push(&mut last.points, point, CONTEXT)?,
            last => {
                let mut next = Vec::new();
                if let Some(last) = last {
                    let located = branch.special.bifurcations.iter().filter(|l| l.after == i);
                    let listed = located.filter_map(|l| {
                        let same = |b: &&Bifurcation| b.point == l.bifurcation.point;
                        bifurcations.iter().find(same)
                    });
                    let at = listed
                        .map(|b| (b.omega, b.amplitude))
                        .next()
                        .or(last.points.last().copied())
                        .unwrap_or(point);
                    try_push(&mut last.points, at, CONTEXT)?;
                    try_push(&mut next, at, CONTEXT)?;
                }
                try_push(&mut next, point, CONTEXT)?;
                let next = Stretch {
                    unstable: is_unstable(i),
                    points: next,
                };
                try_push(&mut found, next, CONTEXT)?;
            }
        }
    }
    Ok(found)
}

struct Beside {
    after: usize,
    unstable: [Option<usize>; 2],
}

fn changes_nothing([before, after]: [Option<usize>; 2]) -> bool {
    before == after
}
