//! Stability along a branch: fields of the curve, bifurcations, and the stretches between them.

use crate::error::{Result, try_push};
use crate::results::stored::branch::Branch;
use crate::results::verdicts::verdict::{Bifurcation, BifurcationKind, Located, Stretch, Verdict};

impl Branch {
    /// The bifurcations in the order of the branch: its folds and, with the solver option `stability`, those where a
    /// multiplier passes the unit circle. The branch of a nonlinear mode has the branch points of its curve, where they were sought.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn bifurcations(&self) -> Result<Vec<Bifurcation>> {
        let mut found = Vec::new();
        if self.mode.is_some() {
            // A nonlinear mode has no multipliers: its branch points are those of its equations, and its folds turn in amplitude.
            let located = self.special.bifurcations.iter().map(|located| located.bifurcation);
            for bifurcation in located.filter(|found| found.kind == BifurcationKind::BranchPoint) {
                try_push(&mut found, bifurcation, "the bifurcations")?;
            }
            return Ok(found);
        }
        for located in &self.special.bifurcations {
            let mut bifurcation = located.bifurcation;
            match bifurcation.kind {
                BifurcationKind::Fold if bifurcation.unstable == [None; 2] => {
                    bifurcation.unstable = self.unstable_around(located.after);
                    if let Some(other) = self.beside(located, BifurcationKind::BranchPoint)
                        && changes_nothing(bifurcation.unstable)
                    {
                        bifurcation.unstable = other.unstable;
                    }
                }
                // Harmonics are truncated: the fold and the multiplier 1 that belongs to it may lie on both sides of a
                // point of the curve.
                BifurcationKind::BranchPoint => {
                    if let Some(fold) = self.beside(located, BifurcationKind::Fold)
                        && changes_nothing(self.unstable_around(fold.after))
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

    /// Removes the bifurcations at these points from the list.
    pub(crate) fn leave_bifurcations(&mut self, points: &[usize]) {
        self.special
            .bifurcations
            .retain(|located| !points.contains(&located.bifurcation.point));
    }

    /// A bifurcation of the given kind that is at most one point of the curve away.
    fn beside(&self, from: &Located, kind: BifurcationKind) -> Option<Beside> {
        let near = |other: &&Located| other.bifurcation.kind == kind && other.after.abs_diff(from.after) <= 1;
        let found = self.special.bifurcations.iter().find(near)?;
        Some(Beside {
            after: found.after,
            unstable: found.bifurcation.unstable,
        })
    }

    /// Numbers of unstable directions of the points of the curve before and after the first `after` ones.
    fn unstable_around(&self, after: usize) -> [Option<usize>; 2] {
        let at = |point: Option<usize>| -> Option<usize> {
            let number = *self.stability.unstable_directions.get(point?)?;
            // Small whole numbers.
            number.is_finite().then_some(number as usize)
        };
        [at(after.checked_sub(1)), at(Some(after))]
    }

    /// The curve for a plot, in stretches of constant stability that meet at bifurcations, or at a point of the
    /// curve. Without stability there is one stretch.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn stretches(&self) -> Result<Vec<Stretch>> {
        const CONTEXT: &str = "the stretches of the curve";
        let bifurcations = self.bifurcations()?;
        let is_unstable = |point: usize| self.stability.unstable_directions.get(point).is_some_and(|n| *n > 0.0);
        let mut found: Vec<Stretch> = Vec::new();
        for (i, point) in self
            .omega()
            .iter()
            .copied()
            .zip(self.amplitude().iter().copied())
            .enumerate()
        {
            match found.last_mut() {
                Some(last) if last.unstable == is_unstable(i) => try_push(&mut last.points, point, CONTEXT)?,
                last => {
                    let mut next = Vec::new();
                    if let Some(last) = last {
                        let located = self.special.bifurcations.iter().filter(|l| l.after == i);
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

    /// Whether stability was requested.
    #[must_use]
    pub fn tells_stability(&self) -> bool {
        self.run.tells_stability
    }

    /// Notes that stability was requested.
    pub(crate) fn tell_stability(&mut self) {
        self.run.tells_stability = true;
    }

    /// Largest modulus of the ordinary Floquet multipliers at each point of the curve; NaN where it is not known.
    /// Empty without the solver option `stability`.
    #[must_use]
    pub fn floquet_radius(&self) -> &[f64] {
        &self.stability.floquet_radius[..self.points().min(self.stability.floquet_radius.len())]
    }

    /// Number of ordinary Floquet multipliers outside the unit circle at each point of the curve, as
    /// [`Self::floquet_radius`].
    #[must_use]
    pub fn unstable_directions(&self) -> &[f64] {
        &self.stability.unstable_directions[..self.points().min(self.stability.unstable_directions.len())]
    }

    /// Stores the stability of the next point of the curve.
    pub(crate) fn push_verdict(&mut self, verdict: &Verdict) -> Result<()> {
        const CONTEXT: &str = "the stability of the points";
        let count = verdict.unstable.map_or(f64::NAN, |count| count as f64);
        try_push(&mut self.stability.floquet_radius, verdict.radius, CONTEXT)?;
        try_push(&mut self.stability.unstable_directions, count, CONTEXT)
    }
}

struct Beside {
    after: usize,
    unstable: [Option<usize>; 2],
}

fn changes_nothing([before, after]: [Option<usize>; 2]) -> bool {
    before == after
}
