//! Peaks of all blades of a wheel, and their amplification against the tuned wheel.

use crate::analysis::forced_response::forced_response;
use crate::error::{Error, Result, Status, fail, try_push};
use crate::hooks::Hooks;
use crate::model::Model;
use crate::model::wheels::sector_digest::SectorUse;
use crate::options::Range;
use crate::options::{ForcedOptions, Response, SolverOptions};
use crate::results::{Branch, ResponseSeries, Special};
use crate::studies::range_ends::at_ends;
use core::fmt::Display;

const CONTEXT: &str = "the peaks of a wheel";

/// Highest peak of one blade.
#[derive(Clone, Copy, Debug)]
pub struct BladePeak {
    /// Value of the response at the peak; NaN where the response has no peak within the range.
    pub amplitude: f64,
    /// Angular frequency of the peak.
    pub omega: f64,
    /// Estimated relative error of the peak; NaN without a tolerance, which requests it.
    pub error: f64,
    /// Index of the peak among the stored points of the branch.
    pub point: Option<usize>,
    /// The larger value of the response at the two ends of the curve, and its angular frequency.
    pub end: (f64, f64),
}

impl BladePeak {
    const NONE: Self = Self {
        amplitude: f64::NAN,
        omega: f64::NAN,
        error: f64::NAN,
        point: None,
        end: (f64::NAN, f64::NAN),
    };

    /// Whether the response is larger at an end of the curve than at each peak, so that the highest peak lies beyond
    /// the range.
    #[must_use]
    pub fn is_beyond(&self) -> bool {
        self.end.0 > if self.amplitude.is_nan() { 0.0 } else { self.amplitude }
    }

    /// The highest peak of a response.
    fn of(branch: &Branch, series: &ResponseSeries) -> Self {
        let end = at_ends(branch, series);
        let highest = |a: &&Special, b: &&Special| a.amplitude.total_cmp(&b.amplitude);
        let Some(peak) = series.peaks().iter().max_by(highest) else {
            return Self { end, ..Self::NONE };
        };
        Self {
            amplitude: peak.amplitude,
            omega: peak.omega,
            error: series.errors().get(peak.point).copied().unwrap_or(f64::NAN),
            point: Some(peak.point),
            end,
        }
    }
}

/// Peaks of all blades of a wheel.
#[derive(Debug)]
pub struct WheelPeaks {
    /// Peaks of the blades, in the order of the sectors.
    pub blades: Vec<BladePeak>,
    /// Index of the blade with the highest peak; `None` without any peak.
    pub largest: Option<usize>,
    /// Peak of the tuned wheel.
    pub tuned: BladePeak,
    /// The response of the wheel, whose response number s belongs to blade s.
    pub branch: Branch,
    /// First and last angular frequency that were requested.
    pub range: Range,
}

impl WheelPeaks {
    /// Amplification factor: highest peak of the blades over that of the tuned wheel; NaN without one of them, or
    /// where one lies beyond an end of the range.
    #[must_use]
    pub fn amplification(&self) -> f64 {
        if self.beyond().is_some() || self.tuned.is_beyond() {
            return f64::NAN;
        }
        self.largest
            .map_or(f64::NAN, |blade| self.blades[blade].amplitude / self.tuned.amplitude)
    }

    /// Blade with the largest response at an end of the range, if this exceeds the highest peak of all blades: the
    /// highest peak of the wheel lies beyond the range.
    #[must_use]
    pub fn beyond(&self) -> Option<usize> {
        let with_end = (0..self.blades.len()).filter(|&i| self.blades[i].end.0 > 0.0);
        let blade = with_end.max_by(|&i, &j| self.blades[i].end.0.total_cmp(&self.blades[j].end.0))?;
        let highest = self.largest.map_or(0.0, |largest| self.blades[largest].amplitude);
        (self.blades[blade].end.0 > highest).then_some(blade)
    }

    /// The error `StoppedNoPeak` with its reason, if the highest peak of the wheel or of the tuned wheel lies beyond
    /// an end of the range.
    #[must_use]
    pub fn outside(&self) -> Option<Error> {
        let said = |of: &dyn Display, (amplitude, omega): (f64, f64)| {
            Error::new(
                Status::StoppedNoPeak,
                format_args!(
                    "{of} is at {amplitude:.6e} at omega = {omega}, an end of the range {} .. {}, above its peaks there: the highest peak \
                     lies beyond; widen the range",
                    self.range.start, self.range.stop
                ),
            )
        };
        match self.beyond() {
            Some(blade) => Some(said(&format_args!("blade {blade}"), self.blades[blade].end)),
            None if self.tuned.is_beyond() => Some(said(&"the tuned wheel", self.tuned.end)),
            None => None,
        }
    }
}

/// Follows the response of a wheel from [`Model::wheel`], mistuned or not, with the response `blade` of every sector watched, so that
/// a tolerance holds for each, and the tuned wheel as the wave of its sector `cyclic`. `blade` is a response of the sector; without
/// degrees of freedom it is the response degree of freedom of the solver, of the sector.
///
/// # Errors
/// `Dimension` or `Argument` for the wheel of another model, `Argument` for responses in `options`; those of [`forced_response`].
pub fn wheel_peaks(
    wheel: &Model,
    cyclic: &Model,
    blade: &Response<'_>,
    solver: &SolverOptions,
    options: &ForcedOptions<'_>,
    hooks: &mut Hooks<'_>,
) -> Result<WheelPeaks> {
    let (n, sectors) = (cyclic.ndof(), cyclic.structure().sectors());
    if wheel.structure().sectors() != 1 || sectors == 1 || wheel.ndof() != n * sectors {
        return fail!(
            Dimension,
            "a wheel of {} degrees of freedom and a model of {sectors} sectors with {n}, needs the wheel of that model",
            wheel.ndof()
        );
    }
    wheel.check_sector(cyclic, SectorUse::Tuned)?;
    if !options.responses.is_empty() || blade.sector != 0 {
        return fail!(
            Argument,
            "responses of the options, or a sector of the blade; needs none, they are those of the blades"
        );
    }
    let only = [solver.response_dof.unwrap_or(0)];
    let dofs = if blade.dofs.is_empty() { &only[..] } else { blade.dofs };
    if let Some(dof) = dofs.iter().find(|dof| **dof >= n) {
        return fail!(Index, "blade: dof = {dof}, needs 0 .. {}", n - 1);
    }
    let mut all = Vec::new();
    for s in 0..sectors {
        for dof in dofs {
            try_push(&mut all, s * n + dof, CONTEXT)?;
        }
    }
    let mut responses = Vec::new();
    for dofs in all.chunks_exact(dofs.len()) {
        try_push(&mut responses, Response { dofs, ..*blade }, CONTEXT)?;
    }
    let own = Response { dofs, ..*blade };
    let of_sector = ForcedOptions {
        responses: core::slice::from_ref(&own),
        guess: None,
        at: &[],
        branches: 0,
        branch_depth: 0,
        most_branches: 0,
        ..*options
    };
    let solver = SolverOptions {
        response_dof: None,
        ..*solver
    };
    let tuned = forced_response(cyclic, &solver, &of_sector, hooks)?;
    let of_wheel = ForcedOptions {
        responses: &responses,
        ..*options
    };
    let branch = forced_response(wheel, &solver, &of_wheel, hooks)?;
    let mut blades = Vec::new();
    for series in branch.responses() {
        try_push(&mut blades, BladePeak::of(&branch, series), CONTEXT)?;
    }
    let known = (0..blades.len()).filter(|&i| blades[i].point.is_some());
    Ok(WheelPeaks {
        largest: known.max_by(|&i, &j| blades[i].amplitude.total_cmp(&blades[j].amplitude)),
        tuned: tuned
            .responses()
            .first()
            .map_or(BladePeak::NONE, |series| BladePeak::of(&tuned, series)),
        range: Range::new(options.omega_start, options.omega_stop),
        blades,
        branch,
    })
}
