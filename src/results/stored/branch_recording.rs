//! Storing the points of a branch.

use crate::condense::blocks::reduction;
use crate::condense::{Condensed, Reduction, Resolution};
use crate::error::{Error, Result, Status, try_push};
use crate::model::Model;
use crate::options::{Response, SolverOptions};
use crate::results::stored::branch::{Branch, Family};
use crate::results::stored::branch_parts::{Place, PointErrors, PointStability, PointTable, Run, SpecialLists};
use crate::results::stored::freedom_of_points::FreedomOfPoints;
use crate::results::stored::mode_branch::ModeData;
use crate::results::stored::origin::Origin;
use crate::results::stored::parameter_branch::ParameterData;
use crate::results::stored::special::Special;
use crate::results::verdicts::verdict::{Bifurcation, BifurcationKind, Located, Verdict};
use crate::results::watched::response_series::{ResponseSeries, SeenWithError};
use crate::results::{Descent, Searched};
use num_complex::Complex64;
use std::sync::Arc;

/// With the first point there is room for so many, if their motions are not more numbers than this.
/// Kind: tuned; measured on: not recorded.
const FIRST_ROOM: (usize, usize) = (32, 4096);

/// Data of one point to be stored.
#[derive(Clone, Copy, Debug)]
pub struct Record<'a> {
    /// Resolution with which the point was solved.
    pub resolution: &'a Resolution,
    /// Angular frequency of the point.
    pub omega: f64,
    /// Packed relative motions, in the solver's units.
    pub motion: &'a [f64],
    /// Complex fundamental of the response degree of freedom, in the solver's units.
    pub amplitude: Complex64,
    /// Carried harmonics of the response degree of freedom, in the solver's units.
    pub response: &'a [Complex64],
    /// Relative residual of the point.
    pub residual: f64,
    /// Number of Newton iterations of the point.
    pub iterations: usize,
    /// Share of the period that each law slips.
    pub slip_fractions: &'a [f64],
    /// Estimated error by sampling, 0 where all laws are exact.
    pub sampling_error: f64,
    /// Estimated relative error of the response amplitude, or of the frequency of a mode, and the error of its
    /// damping ratio; NaN if unknown.
    pub errors: (f64, f64),
    /// Values of the requested responses, in the solver's units, with their errors; empty without such.
    pub seen: &'a [SeenWithError],
}

/// List in which a special point is stored.
#[derive(Clone, Copy, Debug)]
pub(crate) enum SpecialKind {
    Peak,
    /// A peak of the further response with this index.
    PeakOf(usize),
    /// One side of a kink of the response with this index; the other side follows or comes before.
    KinkOf(usize),
    Fold,
    At(usize),
    /// A bifurcation other than a fold, with the numbers of unstable directions before and after it.
    Bifurcation(BifurcationKind, [Option<usize>; 2]),
    /// A limit cycle, with the derivative of the damping ratio by log₁₀ of the amplitude.
    LimitCycle {
        slope: f64,
    },
}

impl SpecialKind {
    pub fn is_fold(self) -> bool {
        matches!(self, Self::Fold | Self::Bifurcation(BifurcationKind::Fold, _))
    }

    /// Index of the response whose peak or kink this is; `None` for other points.
    pub fn response(self) -> Option<usize> {
        match self {
            Self::PeakOf(response) | Self::KinkOf(response) => Some(response),
            _ => None,
        }
    }
}

impl Branch {
    /// An empty branch of a condensed model, whose points have the harmonics up to `harmonics`, or up to the
    /// highest that one of them carries.
    ///
    /// # Errors
    /// `OutOfMemory`.
    #[doc(hidden)]
    pub fn new(resolution: &Resolution, reduction: Reduction, harmonics: usize, response_dof: usize) -> Result<Self> {
        let mut resolutions = Vec::new();
        try_push(&mut resolutions, resolution.clone(), "the branch")?;
        Ok(Self {
            run: Run {
                reduction,
                harmonics,
                estimates: 0,
                response_dof,
                status: Status::Ok,
                reason: None,
                together: false,
                tells_stability: false,
            },
            resolutions,
            curve: 0,
            table: PointTable::default(),
            errors: PointErrors::default(),
            stability: PointStability::default(),
            special: SpecialLists::default(),
            responses: Vec::new(),
            freedom: None,
            mode: None,
            parameter: None,
            family: Family::default(),
        })
    }

    /// The branch of a run that the caller stopped before its model was condensed: it has no point, and nothing is
    /// known of the reduction.
    pub(crate) fn stopped(model: &Model, options: &SolverOptions) -> Result<Self> {
        let condensed = Condensed::without_harmonics(model)?;
        let reduction = Reduction {
            harmonics_carried: 0,
            mean_carried: false,
            even_removed: false,
            ..reduction::reduction_with(&condensed, model, options, 0)
        };
        let resolution = Resolution {
            condensed: Arc::new(condensed),
            samples: options.samples,
        };
        let harmonics = if options.tolerance > 0.0 { 0 } else { options.harmonics };
        let mut branch = Self::new(&resolution, reduction, harmonics, options.response_dof.unwrap_or(0))?;
        branch.run.status = Status::StoppedByCaller;
        branch.run.tells_stability = options.stability.is_some();
        Ok(branch)
    }

    pub(crate) fn set_mode(&mut self, data: ModeData) {
        self.mode = Some(data);
    }

    /// Stores a point and returns its index.
    ///
    /// # Errors
    /// `OutOfMemory`; the branch then ends before this point.
    #[doc(hidden)]
    pub fn push(&mut self, record: &Record<'_>) -> Result<usize> {
        const CONTEXT: &str = "the points of the branch";
        let contacts = self.contacts();
        let resolution = self.resolution_of(record.resolution)?;
        let place = Place {
            resolution,
            motion: self.table.motion.len(),
            response: self.table.response.len(),
        };
        let points = if self.table.places.is_empty() {
            (FIRST_ROOM.1 / record.motion.len().max(1)).clamp(1, FIRST_ROOM.0)
        } else {
            1
        };
        self.table
            .places
            .try_reserve(points)
            .map_err(|_| Error::out_of_memory(CONTEXT))?;
        self.table
            .slip_fraction
            .try_reserve(points * contacts)
            .map_err(|_| Error::out_of_memory(CONTEXT))?;
        for v in [
            &mut self.table.amplitude,
            &mut self.table.residual,
            &mut self.table.iterations,
            &mut self.table.harmonics_used,
            &mut self.errors.sampling,
            &mut self.errors.truncation,
            &mut self.errors.damping,
        ] {
            v.try_reserve(points).map_err(|_| Error::out_of_memory(CONTEXT))?;
        }
        self.table
            .response
            .try_reserve(points * record.response.len())
            .map_err(|_| Error::out_of_memory(CONTEXT))?;
        self.table
            .motion
            .try_reserve(points * record.motion.len())
            .map_err(|_| Error::out_of_memory(CONTEXT))?;
        self.table.motion.extend_from_slice(record.motion);
        let length = record.resolution.condensed.length();
        for (response, seen) in self.responses.iter_mut().zip(record.seen) {
            let mut seen = *seen;
            if response.is_observed() {
                seen.seen.reading.value = record.amplitude.norm();
            }
            response.push(&seen, length)?;
        }
        // The frequency is stored last: its length is the number of points.
        try_push(&mut self.table.omega, record.omega, CONTEXT)?;
        self.table.places.push(place);
        let condensed = &*record.resolution.condensed;
        let leading = self.responses.first().zip(record.seen.first());
        let amplitude = match leading.filter(|(response, _)| !response.is_observed()) {
            Some((_, seen)) => seen.seen.reading.value,
            None => record.amplitude.norm(),
        };
        self.table.amplitude.push(amplitude * length);
        self.table.response.extend(record.response.iter().map(|x| x * length));
        self.table.residual.push(record.residual);
        self.errors.sampling.push(record.sampling_error);
        self.errors.truncation.push(record.errors.0);
        self.errors.damping.push(record.errors.1);
        self.table.iterations.push(record.iterations as f64);
        let highest = condensed.set().numbers().last().copied().unwrap_or(0);
        self.run.harmonics = self.run.harmonics.max(highest);
        self.table.harmonics_used.push(highest as f64);
        let at = self.table.slip_fraction.len();
        self.table.slip_fraction.resize(at + contacts, 0.0);
        for (assembled, &share) in condensed.laws().iter().zip(record.slip_fractions) {
            self.table.slip_fraction[at + assembled.contact] = share;
        }
        Ok(self.table.omega.len() - 1)
    }

    /// Appends a point to the curve, which must be done before any special point is stored.
    pub(crate) fn push_curve(&mut self, record: &Record<'_>) -> Result<()> {
        self.push(record)?;
        self.curve = self.table.omega.len();
        Ok(())
    }

    /// Stores a point of a result over a parameter: on the curve, an optimum by its number alone, or a requested one.
    pub(crate) fn push_followed(&mut self, kind: Option<SpecialKind>, record: &Record<'_>) -> Result<()> {
        match kind {
            None => self.push_curve(record),
            Some(SpecialKind::Peak) => self.push(record).map(|_| ()),
            Some(kind) => self.push_special(kind, self.points().saturating_sub(1), record),
        }
    }

    /// Stores a point beside the curve, which lies after the first `after` points of the curve.
    pub(crate) fn push_special(&mut self, kind: SpecialKind, after: usize, record: &Record<'_>) -> Result<()> {
        let point = self.push(record)?;
        let special = Special {
            point,
            omega: record.omega,
            amplitude: self.table.amplitude[point],
        };
        let list = match kind {
            SpecialKind::Peak => {
                if let Some(response) = self.responses.first_mut() {
                    response.push_peak(special)?;
                }
                &mut self.special.peaks
            }
            SpecialKind::PeakOf(response) => {
                let Some(of) = self.responses.get_mut(response) else {
                    return crate::error::fail!(Internal, "a peak of an unknown response");
                };
                let special = Special {
                    amplitude: of.values()[point],
                    ..special
                };
                of.push_peak(special)?;
                if response > 0 {
                    return Ok(());
                }
                &mut self.special.peaks
            }
            SpecialKind::KinkOf(response) => {
                let Some(of) = self.responses.get_mut(response) else {
                    return crate::error::fail!(Internal, "a kink of an unknown response");
                };
                let amplitude = of.values()[point];
                return of.push_kink(Special { amplitude, ..special });
            }
            SpecialKind::Fold => {
                self.push_bifurcation(BifurcationKind::Fold, [None; 2], after, special)?;
                &mut self.special.folds
            }
            SpecialKind::Bifurcation(kind, unstable) => {
                return self.push_bifurcation(kind, unstable, after, special);
            }
            SpecialKind::LimitCycle { slope } => {
                return try_push(&mut self.special.limit_cycles, (special, slope), "the limit cycles");
            }
            SpecialKind::At(i) => {
                while self.special.at.len() <= i {
                    try_push(&mut self.special.at, Vec::new(), "the requested solutions")?;
                }
                &mut self.special.at[i]
            }
        };
        try_push(list, special, "the special points")
    }

    fn push_bifurcation(
        &mut self,
        kind: BifurcationKind,
        unstable: [Option<usize>; 2],
        after: usize,
        special: Special,
    ) -> Result<()> {
        let bifurcation = Bifurcation {
            point: special.point,
            omega: special.omega,
            amplitude: special.amplitude,
            kind,
            unstable,
        };
        try_push(
            &mut self.special.bifurcations,
            Located { bifurcation, after },
            "the bifurcations",
        )
    }

    /// Completes the reduction by the parts that were removed from the problem with the most harmonics.
    pub(crate) fn complete_reduction(&mut self, model: &Model, options: &SolverOptions) {
        let largest = self
            .resolutions
            .iter()
            .max_by_key(|resolution| resolution.condensed.unknowns());
        if let Some(largest) = largest {
            let held = self.run.reduction.held_by_contacts;
            let reduction = reduction::reduction_with(&largest.condensed, model, options, held);
            self.set_reduction(reduction);
        }
    }

    pub(crate) fn set_reduction(&mut self, reduction: Reduction) {
        self.run.reduction = Reduction {
            harmonics_asked: self.run.harmonics,
            ..reduction
        };
    }

    /// Sets the status of the branch. `stalled`: round-off stopped some point above the tolerance of the residual;
    /// `missed`: the error of some point exceeds the tolerance that chooses the harmonics.
    pub(crate) fn set_ending(&mut self, status: Status, reason: Option<Error>, (stalled, missed): (bool, bool)) {
        self.run.status = match status {
            Status::Ok if missed => Status::StoppedMaxHarmonics,
            Status::Ok if stalled => Status::StoppedStalled,
            status => status,
        };
        self.run.reason = reason;
    }

    /// Index of a resolution, which is stored if it is new.
    pub(crate) fn resolution_of(&mut self, resolution: &Resolution) -> Result<usize> {
        let known = |kept: &Resolution| Arc::ptr_eq(&kept.condensed, &resolution.condensed);
        if let Some(found) = self.resolutions.iter().position(known) {
            return Ok(found);
        }
        try_push(&mut self.resolutions, resolution.clone(), "the branch")?;
        Ok(self.resolutions.len() - 1)
    }

    pub(crate) fn set_estimates(&mut self, estimates: usize) {
        self.run.estimates = estimates;
    }

    pub(crate) fn mode_data_mut(&mut self) -> Option<&mut ModeData> {
        self.mode.as_mut()
    }

    pub(crate) fn set_parameter_data(&mut self, data: ParameterData) {
        self.parameter = Some(data);
    }

    /// Stores the freedom of all points; `stopped` if the caller stopped its computation.
    pub(crate) fn set_freedom(&mut self, freedom: Box<FreedomOfPoints>, stopped: bool) {
        self.freedom = Some(freedom);
        if stopped && self.run.status == Status::Ok {
            self.run.status = Status::StoppedByCaller;
        }
    }

    pub(crate) fn set_searched(&mut self, searched: Searched) {
        self.family.searched = Some(searched);
    }

    /// The children of this branch, writable.
    pub(crate) fn children_mut(&mut self) -> &mut [Self] {
        &mut self.family.children
    }

    /// The children, taken out of the branch.
    pub(crate) fn take_children(&mut self) -> Vec<Self> {
        core::mem::take(&mut self.family.children)
    }

    pub(crate) fn set_descent(&mut self, descent: Descent) {
        self.family.descent = Some(descent);
    }

    pub(crate) fn push_child(&mut self, child: Self) -> Result<()> {
        try_push(&mut self.family.children, child, "the branches that branch off")
    }

    /// Notes the model of the branch; `on_wave`: the branch has the wave of the model.
    pub(crate) fn set_origin(&mut self, model: &Model, on_wave: bool) {
        self.family.origin = Some(Origin {
            model: model.fingerprint(),
            on_wave,
        });
    }

    /// Completes the fields of stability by NaN for points without it, including those beside the curve.
    pub(crate) fn complete_stability(&mut self) -> Result<()> {
        if !self.run.tells_stability {
            return Ok(());
        }
        let stored = self.table.omega.len();
        for numbers in [
            &mut self.stability.floquet_radius,
            &mut self.stability.unstable_directions,
        ] {
            numbers
                .try_reserve(stored.saturating_sub(numbers.len()))
                .map_err(|_| Error::out_of_memory("the stability of the points"))?;
            numbers.resize(stored, f64::NAN);
        }
        Ok(())
    }

    /// Removes the bifurcations at these points from the list.
    pub(crate) fn leave_bifurcations(&mut self, points: &[usize]) {
        self.special
            .bifurcations
            .retain(|located| !points.contains(&located.bifurcation.point));
    }

    /// Notes that stability was requested.
    pub(crate) fn tell_stability(&mut self) {
        self.run.tells_stability = true;
    }

    /// Stores the stability of the next point of the curve.
    pub(crate) fn push_verdict(&mut self, verdict: &Verdict) -> Result<()> {
        const CONTEXT: &str = "the stability of the points";
        let count = verdict.unstable.map_or(f64::NAN, |count| count as f64);
        try_push(&mut self.stability.floquet_radius, verdict.radius, CONTEXT)?;
        try_push(&mut self.stability.unstable_directions, count, CONTEXT)
    }

    /// Notes the responses before the first point; `observed`: the first one is the amplitude that the branch
    /// observes anyway.
    pub(crate) fn watch(&mut self, (responses, together): (&[Response<'_>], bool), observed: bool) -> Result<()> {
        self.run.together = together;
        for (i, response) in responses.iter().enumerate() {
            let series = ResponseSeries::new(response, self.run.response_dof, observed && i == 0)?;
            try_push(&mut self.responses, series, "the responses")?;
        }
        Ok(())
    }
}
