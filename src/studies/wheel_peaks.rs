//! Peaks of all blades of a wheel, and their amplification against the tuned wheel.

use crate::analysis::forced_response::forced_response;
use crate::error::{Result, fail, try_push};
use crate::hooks::Hooks;
use crate::model::Model;
use crate::options::{ForcedOptions, Response, SolverOptions};
use crate::results::{Branch, ResponseSeries, Special};

const CONTEXT: &str = "the peaks of a wheel";

/// Highest peak of a blade.
#[derive(Clone, Copy, Debug)]
pub struct BladePeak {
    /// The response; NaN where it has no peak within the range.
    pub amplitude: f64,
    /// Its angular frequency.
    pub omega: f64,
    /// Its estimated relative error; NaN where no tolerance asked for it.
    pub error: f64,
    /// Its number among the stored points of the branch.
    pub point: Option<usize>,
}

impl BladePeak {
    const NONE: Self = Self {
        amplitude: f64::NAN,
        omega: f64::NAN,
        error: f64::NAN,
        point: None,
    };

    /// The highest peak of a response.
    fn of(series: &ResponseSeries) -> Self {
        let highest = |a: &&Special, b: &&Special| a.amplitude.total_cmp(&b.amplitude);
        let Some(peak) = series.peaks().iter().max_by(highest) else {
            return Self::NONE;
        };
        Self {
            amplitude: peak.amplitude,
            omega: peak.omega,
            error: series.errors().get(peak.point).copied().unwrap_or(f64::NAN),
            point: Some(peak.point),
        }
    }
}

/// Peaks of all blades of a wheel.
#[derive(Debug)]
pub struct WheelPeaks {
    /// Peaks of the blades, in the order of the sectors.
    pub blades: Vec<BladePeak>,
    /// Blade with the highest one; `None` without any peak.
    pub largest: Option<usize>,
    /// Peak of the tuned wheel.
    pub tuned: BladePeak,
    /// The response of the wheel, whose response number s is that of blade s.
    pub branch: Branch,
}

impl WheelPeaks {
    /// Amplification factor: the highest peak over that of the tuned wheel; NaN without one of them.
    #[must_use]
    pub fn amplification(&self) -> f64 {
        self.largest
            .map_or(f64::NAN, |blade| self.blades[blade].amplitude / self.tuned.amplitude)
    }
}

/// Follows the response of a wheel from [`Model::wheel`], mistuned or not, with the response `blade` of every sector watched, so that
/// a tolerance holds for each, and the tuned wheel as the wave of its sector `cyclic`. `blade` is a response of the sector; without
/// degrees of freedom it is the response degree of freedom of the solver, of the sector.
///
/// # Errors
/// `Dimension` for the wheel of another model, `Argument` for responses in `options`; those of [`forced_response`].
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
        try_push(&mut blades, BladePeak::of(series), CONTEXT)?;
    }
    let known = (0..blades.len()).filter(|&i| blades[i].point.is_some());
    Ok(WheelPeaks {
        largest: known.max_by(|&i, &j| blades[i].amplitude.total_cmp(&blades[j].amplitude)),
        tuned: tuned.responses().first().map_or(BladePeak::NONE, BladePeak::of),
        blades,
        branch,
    })
}
