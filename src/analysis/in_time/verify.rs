//! Comparison of a point of a forced response with integration in time.
//!
//! The integration starts from the motion of the point and finds a steady state of its own, so that the difference
//! is the error of harmonic balance: harmonics above H, and contact forces in them. All norms are root mean squares
//! over the period and the degrees of freedom, ‖x‖² = |X₀|² + ½ Σₕ |Xₕ|², so that parts of a distance add up by
//! their squares.

use crate::analysis::in_time::record_peak::{over, peak};
use crate::analysis::in_time::time_response::TimeResponse;
use crate::analysis::in_time::verified_responses::{VerifiedResponse, verified};
use crate::error::{Result, Status, fail, try_vec};
use crate::hooks::{Hooks, LogLevel};
use crate::interrupt::Interrupt;
use crate::model::Model;
use crate::options::{SteadyMethod, TimeOptions, VerifyOptions};
use crate::results::Branch;
use crate::time_integration::solve_disturbed;
use num_complex::Complex64;
use std::f64::consts::TAU;

/// Distance of a point from the periodic motion that integration in time finds from it.
#[derive(Clone, Debug)]
pub struct Verification {
    /// `Ok`, or `StoppedByCaller`: then all numbers compare with a period that is not steady, or are NaN if no period
    /// was recorded.
    pub status: Status,
    /// Whether the point counts as the same solution.
    ///
    /// The criterion is that [`Self::distance`] is at most [`VerifyOptions::same_within`]. If it is larger, the
    /// integration reached another solution, or the point has too few harmonics; a point with more harmonics shows
    /// which.
    pub same: bool,
    /// Whether periods were marched.
    ///
    /// This is so if Newton's method did not converge from the point, and always with
    /// [`crate::options::SteadyMethod::Marching`]. Marching leaves an unstable solution.
    pub marched: bool,
    /// The harmonic h in which the response is compared: the lowest above the mean in which the point moves.
    pub harmonic: usize,
    /// Coefficient X_h of the response degree of freedom in time.
    pub response: Complex64,
    /// |X_h of the point − X_h in time| / |X_h in time|: the error that the error estimate of a point approximates.
    pub response_error: f64,
    /// Distance of the harmonics 0 ..= H of all degrees of freedom over the motion in time.
    pub motion_error: f64,
    /// Share of the motion in time that lies above H, as a root mean square.
    pub above: f64,
    /// Distance of the whole motions over the motion in time: distance² = `motion_error`² + above².
    pub distance: f64,
    /// Contribution of each harmonic 0 ..= H to `motion_error`; their squares sum to its square.
    pub harmonic_errors: Vec<f64>,
    /// The responses that were requested for the branch, in time.
    pub responses: Vec<VerifiedResponse>,
    /// Largest displacement of the response degree of freedom over the period in time.
    pub peak: f64,
    /// Difference between the largest displacements of the point and of the motion in time, relative to the latter.
    pub peak_error: f64,
    /// Largest change over a period of the motion in time, relative to its largest displacement and velocity: the
    /// integration has errors of this size.
    pub residual: f64,
    /// Number of periods that were integrated.
    pub periods: usize,
    /// Number of changes of the contacts between stick, slip, open and closed in one period.
    pub events: usize,
    /// Number of degrees of freedom of one sector.
    pub ndof: usize,
    /// Coefficients 0 ..= H of all degrees of freedom in time, harmonic by harmonic.
    pub harmonics: Vec<Complex64>,
}

impl Verification {
    /// Index and error of the response with the largest error; `None` where the branch has no requested responses.
    #[must_use]
    pub fn worst_response(&self) -> Option<(usize, f64)> {
        let errors = self.responses.iter().map(|of| of.error).enumerate();
        errors.max_by(|a, b| a.1.total_cmp(&b.1))
    }
}

/// Compares a stored point of a forced response with the periodic motion that [`time_response`](crate::time_response) finds from
/// it, at the point's frequency. `model` is the one that the branch was computed with. The point is not changed.
///
/// Where several motions coexist the integration may end in another one than that of the point: then `same` is
/// false, `distance` is the distance of the two, and `marched` shows whether Newton's method failed.
///
/// # Errors
/// `Index` for an unknown point, `Argument` for another model than that of the branch, `Unsupported` for a point of a
/// nonlinear mode; bad options (see [`VerifyOptions::check`]), and the errors of
/// [`time_response`](crate::time_response).
///
/// # Example
/// ```
/// # use hbvib::{Contact, ForcedOptions, MatrixKind, MatrixView, Model, SolverOptions, forced_response};
/// use hbvib::{Hooks, VerifyOptions, verify};
///
/// # let mut model = Model::new(1)?;
/// # model.set_matrix(MatrixKind::Mass, &MatrixView::dense(1, &[1.0]))?;
/// # model.set_matrix(MatrixKind::Stiffness, &MatrixView::dense(1, &[1.0]))?;
/// # model.set_rayleigh(0.0, 0.02)?;
/// # model.add_contact(&Contact::jenkins(0, None, 1.0, 0.3, 1.0))?;
/// # model.add_force(0, 1, 0.2.into())?;
/// let range = ForcedOptions { omega_start: 0.8, omega_stop: 1.6, ..ForcedOptions::default() };
/// let branch = forced_response(&model, &SolverOptions::default(), &range, &mut Hooks::default())?;
/// let peak = branch.peaks()[0].point;
/// let found = verify(&model, &branch, peak, &VerifyOptions::default(), &mut Hooks::default())?;
/// assert!(found.same && found.response_error < 1e-3); // the tolerance of the branch
/// # Ok::<(), hbvib::Error>(())
/// ```
pub fn verify(
    model: &Model,
    branch: &Branch,
    point: usize,
    options: &VerifyOptions,
    hooks: &mut Hooks<'_>,
) -> Result<Verification> {
    options.check()?;
    if branch.mode().is_some() {
        return fail!(
            Unsupported,
            "the branch is a nonlinear mode: no force drives it, so that there is no forced motion in time to compare with; take a point of a forced response"
        );
    }
    branch.check_model(model)?;
    let Some(omega) = branch.omega_at(point) else {
        return fail!(
            Index,
            "point = {point}, needs 0 .. {} (points and special points)",
            branch.stored()
        );
    };
    let (highest, ndof) = (branch.harmonics(), branch.ndof());
    let len = (highest + 1).saturating_mul(ndof);
    let mut x = try_vec(len, Complex64::ZERO, "the harmonics of the point")?;
    let interrupt = hooks.interrupt();
    let recovered = branch.harmonics_at_with(point, &mut x, &interrupt);
    let options_in_time = TimeOptions {
        omega,
        method: options.method,
        harmonics: highest,
        samples: times(highest),
        tolerance: options.tolerance,
        max_periods: options.max_periods,
        start: Some(&x),
    };
    let time = match recovered {
        Ok(()) => {
            options_in_time.check(model.ndof())?;
            model.check_matrices(false)?;
            // Marching from the point itself would keep an unstable motion whose symmetry it has.
            let disturbance = match options.method {
                SteadyMethod::Marching => DISTURBANCE
                    .max(MORE_THAN_STEADY * options.tolerance)
                    .min(MOST_DISTURBED),
                SteadyMethod::Shooting => 0.0,
            };
            solve_disturbed(model, &options_in_time, disturbance, hooks)?
        }
        Err(e) if e.status == Status::StoppedByCaller => TimeResponse::stopped(model, &options_in_time)?,
        Err(e) => return Err(e),
    };
    let (of, same_within) = ((model, branch, point), options.same_within);
    let found = match compare(&x, time, omega, of, same_within, &interrupt) {
        Err(e) if e.status == Status::StoppedByCaller => {
            let time = TimeResponse::stopped(model, &options_in_time)?;
            compare(&x, time, omega, of, same_within, &Interrupt::none())?
        }
        outcome => outcome?,
    };
    if !found.same && found.status == Status::Ok {
        hooks.log(
            LogLevel::Warn,
            "the motion found in time is far from the point: another solution, or too few harmonics",
        );
    }
    Ok(found)
}

/// Disturbance of a start that is marched, relative to the motion: at least this, and so much more than the change over a period
/// that counts as steady.
/// Kind: tuned; measured on: not recorded.
const DISTURBANCE: f64 = 1e-6;
const MORE_THAN_STEADY: f64 = 1e3;
const MOST_DISTURBED: f64 = 1e-3;

/// Smallest number of times of a period at which motions are compared.
/// Kind: tuned; measured on: not recorded.
const FEWEST_TIMES: usize = 1024;

/// Times per period of the highest harmonic.
/// Kind: tuned; measured on: not recorded.
const VERIFY_TIMES_PER_WAVE: usize = 16;

/// Number of times at which motions with H harmonics are compared.
fn times(highest: usize) -> usize {
    (VERIFY_TIMES_PER_WAVE * (highest + 1))
        .next_power_of_two()
        .max(FEWEST_TIMES)
}

fn compare(
    x: &[Complex64],
    time: TimeResponse,
    omega: f64,
    (model, branch, point): (&Model, &Branch, usize),
    same_within: f64,
    interrupt: &Interrupt<'_>,
) -> Result<Verification> {
    const CONTEXT: &str = "the comparison with the motion in time";
    let (ndof, count) = (time.ndof, time.harmonics.len() / time.ndof);
    let mut errors = try_vec(count, 0.0, CONTEXT)?;
    let (mut square, mut gap) = (0.0, 0.0);
    let rows = x.chunks_exact(ndof).zip(time.harmonics.chunks_exact(ndof));
    for (h, (error, (x, y))) in errors.iter_mut().zip(rows).enumerate() {
        let weight = if h == 0 { 1.0 } else { 0.5 };
        let own: f64 = x.iter().zip(y).map(|(x, y)| (x - y).norm_sqr()).sum();
        *error = (weight * own).sqrt();
        gap += weight * own;
        square += weight * y.iter().map(Complex64::norm_sqr).sum::<f64>();
    }
    let series = Series::new(time.samples.len() / ndof)?;
    let part_above = series.part_above(&time, interrupt)?;
    let whole = (square + part_above * part_above).sqrt();
    for error in &mut errors {
        *error = over(*error, whole);
    }
    let moves = |h: &usize| x[h * ndof..(h + 1) * ndof].iter().any(|z| *z != Complex64::ZERO);
    let harmonic = (1..count).find(moves).unwrap_or(1.min(count - 1));
    let dof = branch.response_dof();
    let responses = verified((model, branch, point), omega, (&time, harmonic), interrupt)?;
    let at = harmonic * ndof + dof;
    let response = time.harmonics[at];
    let [own, peak] = series.peaks(x, &time, dof);
    let distance = over((gap + part_above * part_above).sqrt(), whole);
    Ok(Verification {
        status: time.status,
        same: distance <= same_within,
        marched: time.marched,
        harmonic,
        response,
        response_error: over((x[at] - response).norm(), response.norm()),
        motion_error: over(gap.sqrt(), whole),
        above: over(part_above, whole),
        distance,
        harmonic_errors: errors,
        responses,
        peak,
        peak_error: over((own - peak).abs(), peak),
        residual: time.residual,
        periods: time.periods,
        events: time.events,
        ndof,
        harmonics: time.harmonics,
    })
}

/// Values of Fourier series at equidistant times.
struct Series {
    /// Factors e^{iτ} at the times.
    turns: Vec<Complex64>,
}

impl Series {
    fn new(times: usize) -> Result<Self> {
        let mut turns = try_vec(times, Complex64::ONE, "the times of a period")?;
        for (i, turn) in turns.iter_mut().enumerate() {
            *turn = Complex64::cis(TAU * i as f64 / times as f64);
        }
        Ok(Self { turns })
    }

    /// Re Σ X_h e^{ihτ} of one degree of freedom at the i-th time.
    fn at(&self, x: &[Complex64], ndof: usize, dof: usize, i: usize) -> f64 {
        let coefficients = x.iter().skip(dof).step_by(ndof);
        let sum = coefficients.enumerate().map(|(h, x)| {
            // h·i stays far below 2⁶³: both are bounded by the options.
            let turn = self.turns[(h * i) % self.turns.len()];
            x.re * turn.re - x.im * turn.im
        });
        sum.sum()
    }

    /// Root mean square of the part of the motion in time above H. It is computed from the differences themselves,
    /// because a difference of squares would lose half the digits.
    fn part_above(&self, time: &TimeResponse, interrupt: &Interrupt<'_>) -> Result<f64> {
        if time.harmonics.iter().any(|x| x.is_nan()) {
            // No period was recorded.
            return Ok(f64::NAN);
        }
        let mut square = 0.0;
        for (i, samples) in time.samples.chunks_exact(time.ndof).enumerate() {
            interrupt.check_before(4 * time.harmonics.len() as u64)?;
            for (dof, x) in samples.iter().enumerate() {
                square += (x - self.at(&time.harmonics, time.ndof, dof, i)).powi(2);
            }
        }
        Ok((square / self.turns.len() as f64).sqrt())
    }

    /// Largest displacements of a degree of freedom over the period: of the point, and in time.
    fn peaks(&self, x: &[Complex64], time: &TimeResponse, dof: usize) -> [f64; 2] {
        let times = self.turns.len();
        [
            peak(times, |i| self.at(x, time.ndof, dof, i)),
            peak(times, |i| time.samples[i * time.ndof + dof]),
        ]
    }
}
