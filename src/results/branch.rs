//! The result of an analysis: points along a branch, its peaks and folds, solutions asked for, and
//! what was removed from the problem.

use crate::condense::Reduction;
use crate::error::{Error, Result, Status, fail, try_extend, try_push, try_vec};
use num_complex::Complex64;

pub use crate::results::point_resolution::Resolution;
pub(crate) use crate::results::recovery::Recovery;

/// A solution beside the curve: a peak, a fold, or one at a parameter value asked for.
#[derive(Clone, Copy, Debug)]
pub struct Special {
    /// Number of the point; it continues the numbering of the curve.
    pub point: usize,
    /// Angular frequency.
    pub omega: f64,
    /// Amplitude of the response degree of freedom.
    pub amplitude: f64,
}

/// A branch of solutions.
///
/// Points 0 .. [`Self::points`] form the curve in the order in which it was followed. Peaks,
/// folds and the solutions asked for have the numbers after that.
#[derive(Debug)]
pub struct Branch {
    pub(super) levels: Vec<Resolution>,
    /// Where each stored point lies.
    pub(super) places: Vec<Place>,
    pub(super) reduction: Reduction,
    pub(super) harmonics: usize,
    pub(super) estimates: usize,
    pub(super) response_dof: usize,
    pub(super) status: Status,
    pub(super) reason: Option<Error>,
    pub(super) curve: usize,
    pub(super) omega: Vec<f64>,
    pub(super) amplitude: Vec<f64>,
    pub(super) residual: Vec<f64>,
    pub(super) iterations: Vec<f64>,
    pub(super) harmonics_used: Vec<f64>,
    pub(super) slip_fraction: Vec<f64>,
    pub(super) sampling_error: Vec<f64>,
    pub(super) error_estimate: Vec<f64>,
    pub(super) damping_error_estimate: Vec<f64>,
    pub(super) motion: Vec<f64>,
    pub(super) response: Vec<Complex64>,
    pub(super) peaks: Vec<Special>,
    pub(super) folds: Vec<Special>,
    pub(super) at: Vec<Vec<Special>>,
    pub(super) mode: Option<crate::results::mode_branch::ModeData>,
}

/// Where a stored point lies: its level, and the begin of its motion and of its response.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    pub(super) level: usize,
    pub(super) motion: usize,
    pub(super) response: usize,
}

/// Numbers that belong to one point.
#[derive(Clone, Copy, Debug)]
pub struct Record<'a> {
    /// The harmonics that it was solved with.
    pub level: &'a Resolution,
    /// Angular frequency.
    pub omega: f64,
    /// Packed relative motions, in the solver's units.
    pub motion: &'a [f64],
    /// Complex fundamental of the response degree of freedom, in the solver's units.
    pub amplitude: Complex64,
    /// Carried harmonics of the response degree of freedom, in the solver's units.
    pub response: &'a [Complex64],
    /// Relative residual.
    pub residual: f64,
    /// Newton iterations.
    pub iterations: usize,
    /// Share of the period that each law slips.
    pub slip_fractions: &'a [f64],
    /// How much sampling matters, 0 where all laws are exact.
    pub sampling_error: f64,
    /// Estimated relative error of the response amplitude, or of a mode's frequency, and error of its damping
    /// ratio; NaN where they are unknown.
    pub errors: (f64, f64),
}

impl Branch {
    /// An empty branch of a condensed model, whose points tell of the harmonics up to `harmonics`, or up to the
    /// highest that one of them carries.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(level: &Resolution, reduction: Reduction, harmonics: usize, response_dof: usize) -> Result<Self> {
        let mut levels = Vec::new();
        try_push(&mut levels, level.clone(), "the branch")?;
        Ok(Self {
            levels,
            places: Vec::new(),
            reduction,
            harmonics,
            estimates: 0,
            response_dof,
            status: Status::Ok,
            reason: None,
            curve: 0,
            omega: Vec::new(),
            amplitude: Vec::new(),
            residual: Vec::new(),
            iterations: Vec::new(),
            harmonics_used: Vec::new(),
            slip_fraction: Vec::new(),
            sampling_error: Vec::new(),
            error_estimate: Vec::new(),
            damping_error_estimate: Vec::new(),
            motion: Vec::new(),
            response: Vec::new(),
            peaks: Vec::new(),
            folds: Vec::new(),
            at: Vec::new(),
            mode: None,
        })
    }

    pub(crate) fn set_mode(&mut self, data: crate::results::mode_branch::ModeData) {
        self.mode = Some(data);
    }

    /// Stores a point and returns its number.
    ///
    /// # Errors
    /// `OutOfMemory`; the branch then ends before this point.
    pub fn push(&mut self, record: &Record<'_>) -> Result<usize> {
        const CONTEXT: &str = "the points of the branch";
        let contacts = self.contacts();
        let level = self.level_of(record.level)?;
        let place = Place {
            level,
            motion: self.motion.len(),
            response: self.response.len(),
        };
        self.places.try_reserve(1).map_err(|_| Error::out_of_memory(CONTEXT))?;
        self.slip_fraction
            .try_reserve(contacts)
            .map_err(|_| Error::out_of_memory(CONTEXT))?;
        for v in [
            &mut self.amplitude,
            &mut self.residual,
            &mut self.iterations,
            &mut self.harmonics_used,
            &mut self.sampling_error,
            &mut self.error_estimate,
            &mut self.damping_error_estimate,
        ] {
            v.try_reserve(1).map_err(|_| Error::out_of_memory(CONTEXT))?;
        }
        self.response
            .try_reserve(record.response.len())
            .map_err(|_| Error::out_of_memory(CONTEXT))?;
        try_extend(&mut self.motion, record.motion, CONTEXT)?;
        // The frequency goes last: it counts the points.
        try_push(&mut self.omega, record.omega, CONTEXT)?;
        self.places.push(place);
        let condensed = &*record.level.condensed;
        let length = condensed.length();
        self.amplitude.push(record.amplitude.norm() * length);
        self.response.extend(record.response.iter().map(|x| x * length));
        self.residual.push(record.residual);
        self.sampling_error.push(record.sampling_error);
        self.error_estimate.push(record.errors.0);
        self.damping_error_estimate.push(record.errors.1);
        self.iterations.push(record.iterations as f64);
        let highest = condensed.set().numbers().last().copied().unwrap_or(0);
        self.harmonics = self.harmonics.max(highest);
        self.harmonics_used.push(highest as f64);
        let at = self.slip_fraction.len();
        self.slip_fraction.resize(at + contacts, 0.0);
        for (assembled, &share) in condensed.laws().iter().zip(record.slip_fractions) {
            self.slip_fraction[at + assembled.contact] = share;
        }
        Ok(self.omega.len() - 1)
    }

    /// Appends a point to the curve, which must be done before any special point is stored.
    pub(crate) fn push_curve(&mut self, record: &Record<'_>) -> Result<()> {
        self.push(record)?;
        self.curve = self.omega.len();
        Ok(())
    }

    pub(crate) fn push_special(&mut self, kind: SpecialKind, record: &Record<'_>) -> Result<()> {
        let point = self.push(record)?;
        let special = Special {
            point,
            omega: record.omega,
            amplitude: self.amplitude[point],
        };
        let list = match kind {
            SpecialKind::Peak => &mut self.peaks,
            SpecialKind::Fold => &mut self.folds,
            SpecialKind::At(i) => {
                while self.at.len() <= i {
                    try_push(&mut self.at, Vec::new(), "the solutions asked for")?;
                }
                &mut self.at[i]
            }
        };
        try_push(list, special, "the special points")
    }

    pub(crate) fn set_reduction(&mut self, reduction: Reduction) {
        self.reduction = Reduction {
            harmonics_asked: self.harmonics,
            ..reduction
        };
    }

    /// `stalled` says whether round-off stopped some point above the tolerance of the residual, `missed` whether the
    /// error of some point misses that which chooses the harmonics.
    pub(crate) fn set_ending(&mut self, status: Status, reason: Option<Error>, (stalled, missed): (bool, bool)) {
        self.status = match status {
            Status::Ok if missed => Status::StoppedMaxHarmonics,
            Status::Ok if stalled => Status::StoppedStalled,
            status => status,
        };
        self.reason = reason;
    }

    /// [`Status::Ok`] when the whole range was covered, else why the branch ends early.
    #[must_use]
    pub fn status(&self) -> Status {
        self.status
    }

    /// What ended the branch early, where the status alone does not say it: the failure of a callback, or a frequency
    /// at which there is no bounded solution.
    #[must_use]
    pub fn reason(&self) -> Option<&Error> {
        self.reason.as_ref()
    }

    /// Number of points on the curve.
    #[must_use]
    pub fn points(&self) -> usize {
        self.curve
    }

    /// Number of stored points, the special ones included.
    #[must_use]
    pub fn stored(&self) -> usize {
        self.omega.len()
    }

    /// Angular frequency of each point on the curve.
    #[must_use]
    pub fn omega(&self) -> &[f64] {
        &self.omega[..self.curve]
    }

    /// Angular frequency of one stored point, the special ones included.
    #[must_use]
    pub fn omega_at(&self, point: usize) -> Option<f64> {
        self.omega.get(point).copied()
    }

    /// Amplitude |X| of the response degree of freedom (fundamental, peak) at each point.
    #[must_use]
    pub fn amplitude(&self) -> &[f64] {
        &self.amplitude[..self.curve]
    }

    /// Relative residual of each point.
    #[must_use]
    pub fn residual(&self) -> &[f64] {
        &self.residual[..self.curve]
    }

    /// Newton iterations of each point.
    #[must_use]
    pub fn newton_iterations(&self) -> &[f64] {
        &self.iterations[..self.curve]
    }

    /// Highest harmonic number carried at each point.
    #[must_use]
    pub fn harmonics_used(&self) -> &[f64] {
        &self.harmonics_used[..self.curve]
    }

    /// Share of the period that each contact slips: points × contacts, a point after the other.
    /// Time that it is open is not slip: 0 is a contact that sticks or opens, and what springs,
    /// unilateral ones among them, laws without states and contacts without force report.
    #[must_use]
    pub fn slip_fraction(&self) -> &[f64] {
        &self.slip_fraction[..self.curve * self.contacts()]
    }

    /// Slip shares of one stored point, the special ones included.
    #[must_use]
    pub fn slip_fraction_at(&self, point: usize) -> Option<&[f64]> {
        let contacts = self.contacts();
        (point < self.stored()).then(|| &self.slip_fraction[point * contacts..(point + 1) * contacts])
    }

    /// Maxima of the amplitude, in a nonlinear mode of the damping ratio, refined on the solution.
    #[must_use]
    pub fn peaks(&self) -> &[Special] {
        &self.peaks
    }

    /// Turning points in frequency, in a nonlinear mode in amplitude, refined on the solution.
    #[must_use]
    pub fn folds(&self) -> &[Special] {
        &self.folds
    }

    /// Every solution found at the i-th frequency (in a nonlinear mode: amplitude) asked for.
    #[must_use]
    pub fn at(&self, i: usize) -> &[Special] {
        self.at.get(i).map_or(&[], Vec::as_slice)
    }

    /// Number of contacts in the model.
    #[must_use]
    pub fn contacts(&self) -> usize {
        self.levels[0].condensed.contacts()
    }

    /// Degrees of freedom (of one sector).
    #[must_use]
    pub fn ndof(&self) -> usize {
        self.levels[0].condensed.ndof()
    }

    /// Highest harmonic number H of which the points tell: the one that was asked for, or, where a tolerance
    /// decided, the highest that a stored point carries.
    #[must_use]
    pub fn harmonics(&self) -> usize {
        self.harmonics
    }

    /// Harmonic numbers that are carried at a stored point; all others are zero.
    #[must_use]
    pub fn carried_at(&self, point: usize) -> Option<&[usize]> {
        Some(self.condensed_at(point)?.set().numbers())
    }

    /// The degree of freedom whose amplitude was followed.
    #[must_use]
    pub fn response_dof(&self) -> usize {
        self.response_dof
    }

    /// What was removed from the problem.
    #[must_use]
    pub fn reduction(&self) -> &Reduction {
        &self.reduction
    }

    /// Harmonics of the response degree of freedom at a stored point, one per number in
    /// [`Self::carried_at`]; they are at hand without recovering the whole structure.
    #[must_use]
    pub fn response_at(&self, point: usize) -> Option<&[Complex64]> {
        let place = self.places.get(point)?;
        let carried = self.carried_at(point)?.len();
        self.response.get(place.response..place.response + carried)
    }

    /// Harmonics 0 ..= H of all degrees of freedom at a stored point: (H + 1) × ndof, harmonic by
    /// harmonic, in the caller's unit of length.
    ///
    /// # Errors
    /// `Index` for an unknown point, `Dimension` for a buffer of another length, `OutOfMemory`.
    pub fn harmonics_at(&self, point: usize, x: &mut [Complex64]) -> Result<()> {
        let carried = self.carried_of(point)?;
        let n = self.ndof();
        let needed = (self.harmonics + 1) * n;
        if x.len() != needed {
            return fail!(
                Dimension,
                "x has {} complex entries, needs (harmonics+1)*ndof = {needed}",
                x.len()
            );
        }
        let mut found = try_vec(needed, Complex64::ZERO, "the harmonics")?;
        let mut recovery = Recovery::at(self, point)?;
        for (i, &h) in carried.iter().enumerate() {
            recovery.harmonic(i, &mut found[h * n..(h + 1) * n])?;
        }
        x.copy_from_slice(&found);
        Ok(())
    }
}

/// Which list a special point belongs to.
#[derive(Clone, Copy, Debug)]
pub(crate) enum SpecialKind {
    Peak,
    Fold,
    At(usize),
}

impl SpecialKind {
    pub fn is_fold(self) -> bool {
        matches!(self, Self::Fold)
    }
}
