//! The smallest kick that leads from a stable motion to another one.
//!
//! A kick is an impulse at one degree of freedom. Between two stable motions lies an unstable one with one unstable direction, a saddle. Motions
//! on one side of its stable surface return, those on the other side do not. To first order that surface is w·(z − z_saddle) = 0
//! with the left eigenvector w of the period map of the saddle, so that the impulse −w·(z − z_saddle)/(w·d) leads to it, with the change d of
//! the state by a unit impulse. The impulse itself is then bracketed by integration in time.

use crate::analysis::perturbed::kicked_motion::{Kicked, Side};
use crate::error::{Result, Status, fail, try_push};
use crate::hooks::{Hooks, LogLevel};
use crate::interrupt::Interrupt;
use crate::model::Model;
use crate::results::{Branch, Recovery};
use num_complex::Complex64;
use std::f64::consts::TAU;

const CONTEXT: &str = "the smallest kick";

/// Difference of the frequencies of the two points, relative to them, up to which they are one.
/// Kind: rounding.
const SAME_FREQUENCY: f64 = 1e-9;

/// Distance of the bracket, relative to the impulse.
/// Kind: tuned; measured on: not recorded.
const SMALLEST_KICK_BRACKET: f64 = 1e-3;

/// Factors of the first estimate at which a kick that leads across is sought.
/// Kind: tuned; measured on: not recorded.
const FACTORS: [f64; 8] = [0.7, 0.9, 1.05, 1.2, 1.5, 2.0, 3.0, 5.0];

/// Smaller share of the smallest known impulse at which other phases are examined, so that they are worth a search.
/// Kind: tuned; measured on: not recorded.
const SMALLER: f64 = 0.995;

/// Halvings of the distance of phases around the best one.
/// Kind: tuned; measured on: not recorded.
const REFINEMENTS: usize = 4;

/// The smallest kick that was found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Kick {
    /// `Ok` or `StoppedByCaller`; then the numbers are those found so far, or NaN.
    pub status: Status,
    /// Smallest impulse found that leads to another motion, with its sign; NaN where none was found.
    pub impulse: f64,
    /// Impulse at the same phase from which the motion returned.
    pub returning: f64,
    /// Phase ωt of the forces, in 0 .. 2π, at which the impulse acts.
    pub phase: f64,
    /// Smallest impulse to first order, from the left eigenvector of the saddle.
    pub estimate: f64,
    /// Phase ωt of the forces at which the impulse `estimate` acts.
    pub estimate_phase: f64,
    /// Velocity of the degree of freedom that the impulse causes.
    pub velocity: f64,
    /// Multiplier of the saddle in its unstable direction.
    pub multiplier: f64,
    /// Whether integration in time with a tight tolerance confirmed both ends: the kick leads to another motion, and the returning one
    /// back. Where it is false the estimate is all that is known.
    pub verified: bool,
}

/// The smallest kick so far.
#[derive(Clone, Copy)]
struct Best {
    phase: f64,
    impulse: f64,
    returning: f64,
}

/// Searches for the smallest impulse at the degree of freedom `dof` that leads from a stable point of a forced response to another
/// motion, at `phases` times of a period and around the best of them. `saddle` is an unstable point at the same frequency, with one
/// unstable direction: of the same branch, or of another one of the same model. Smaller kicks at other times, or in other directions, may
/// exist.
///
/// # Errors
/// `Index`, `Argument` for points of other models or frequencies, for a stable saddle or an unstable point; `Unsupported` for cyclic
/// models, nonlinear modes, and what `time_response` does not support; `NoConvergence` if shooting does not converge from a point.
pub fn smallest_kick(
    model: &Model,
    (branch, point): (&Branch, usize),
    (saddle_branch, saddle): (&Branch, usize),
    (dof, phases): (usize, usize),
    hooks: &mut Hooks<'_>,
) -> Result<Kick> {
    if phases == 0 || phases > 10_000 {
        return fail!(Argument, "phases = {phases}, needs 1 .. 10000");
    }
    if dof >= model.ndof() {
        return fail!(Index, "dof = {dof}, needs 0 .. {}", model.ndof());
    }
    if model.structure().sectors() > 1 {
        return fail!(
            Unsupported,
            "no kick leaves a wave: sectors that repeat each other around the wheel move periodically; take the whole wheel as a plain model \
             (hbvib_wheel_new), and a saddle of it with one unstable direction"
        );
    }
    let interrupt = hooks.interrupt();
    let lower = harmonics(model, branch, point, "point", &interrupt)?;
    let between = harmonics(model, saddle_branch, saddle, "saddle", &interrupt)?;
    if (lower.0 / between.0 - 1.0).abs() > SAME_FREQUENCY {
        return fail!(
            Argument,
            "the points have the frequencies {} and {}, needs one: request it with `at`",
            lower.0,
            between.0
        );
    }
    model.check_matrices(false)?;
    let mut kick = Kick {
        status: Status::Ok,
        impulse: f64::NAN,
        returning: f64::NAN,
        phase: f64::NAN,
        estimate: f64::NAN,
        estimate_phase: f64::NAN,
        velocity: f64::NAN,
        multiplier: f64::NAN,
        verified: false,
    };
    let mut search = KickSearch {
        model,
        omega: lower.0,
        lower: &lower.1,
        between: &between.1,
        dof,
        interrupt: &interrupt,
        best: None,
        mobility: f64::NAN,
    };
    match search.run(phases, &mut kick, hooks) {
        Err(e) if e.status == Status::StoppedByCaller => kick.status = e.status,
        found => found?,
    }
    if let Some(best) = search.best {
        (kick.impulse, kick.returning, kick.phase) = (best.impulse, best.returning, best.phase);
        kick.velocity = best.impulse * search.mobility;
    }
    Ok(kick)
}

/// Frequency and harmonics of a point of a forced response.
fn harmonics(
    model: &Model,
    branch: &Branch,
    point: usize,
    name: &str,
    interrupt: &Interrupt<'_>,
) -> Result<(f64, Vec<Complex64>)> {
    branch.check_model(model)?;
    if branch.mode().is_some() {
        return fail!(
            Unsupported,
            "{name} is one of a nonlinear mode, needs one of a forced response"
        );
    }
    let Some(omega) = branch.omega_at(point) else {
        return fail!(Index, "{name} = {point}, needs 0 .. {}", branch.stored());
    };
    Ok((omega, Recovery::at(branch, point, interrupt)?.all(branch.harmonics())?))
}

/// Search for the smallest impulse over the phases of the forces.
struct KickSearch<'a> {
    model: &'a Model,
    omega: f64,
    lower: &'a [Complex64],
    between: &'a [Complex64],
    dof: usize,
    interrupt: &'a Interrupt<'a>,
    best: Option<Best>,
    /// Velocity of the kicked degree of freedom after a unit impulse.
    mobility: f64,
}

impl<'a> KickSearch<'a> {
    fn at(&self, phase: f64, hooks: &mut Hooks<'_>) -> Result<Kicked<'a>> {
        Kicked::new(
            (self.model, self.omega, self.dof),
            (self.lower, self.between),
            phase,
            hooks,
            self.interrupt,
        )
    }

    fn run(&mut self, phases: usize, kick: &mut Kick, hooks: &mut Hooks<'_>) -> Result<()> {
        let mut estimates = Vec::new();
        for i in 0..phases {
            let phase = TAU * i as f64 / phases as f64;
            let at = self.at(phase, hooks)?;
            (self.mobility, kick.multiplier) = (at.mobility(), at.multiplier());
            let estimate = at.estimate();
            if kick.estimate.is_nan() || estimate.abs() < kick.estimate.abs() {
                (kick.estimate, kick.estimate_phase) = (estimate, phase);
            }
            try_push(&mut estimates, (phase, estimate), CONTEXT)?;
        }
        // The most promising phase first, so that others need a look only.
        estimates.sort_by(|a, b| a.1.abs().total_cmp(&b.1.abs()));
        for &(phase, estimate) in &estimates {
            self.examine(phase, estimate, hooks)?;
        }
        let mut distance = TAU / phases as f64;
        for _ in 0..REFINEMENTS {
            distance *= 0.5;
            let Some(centre) = self.best.map(|best| best.phase) else {
                break;
            };
            for phase in [centre - distance, centre + distance] {
                let phase = phase.rem_euclid(TAU);
                let estimate = self.at(phase, hooks)?.estimate();
                self.examine(phase, estimate, hooks)?;
            }
        }
        if let Some(best) = self.best {
            let mut at = self.at(best.phase, hooks)?.tight()?;
            let sides = [at.side(best.impulse)?, at.side(best.returning)?];
            kick.verified = sides == [Side::Across, Side::Returns];
        }
        Ok(())
    }

    /// Brackets the smallest impulse of a phase, unless it is larger than the best one.
    fn examine(&mut self, phase: f64, estimate: f64, hooks: &mut Hooks<'_>) -> Result<()> {
        let mut at = self.at(phase, hooks)?;
        let unit = self.best.map_or(estimate.abs(), |best| best.impulse.abs());
        if !unit.is_finite() {
            return Ok(());
        }
        for sign in [estimate.signum(), -estimate.signum()] {
            let mut below = 0.0;
            let mut above = None;
            let trials: &[f64] = if self.best.is_some() { &[SMALLER] } else { &FACTORS };
            for factor in trials {
                let impulse = sign * factor * unit;
                if at.side(impulse)? == Side::Across {
                    above = Some(impulse);
                    break;
                }
                below = impulse;
            }
            let Some(mut above) = above else { continue };
            while (above - below).abs() > SMALLEST_KICK_BRACKET * above.abs() {
                let middle = 0.5 * (above + below);
                if at.side(middle)? == Side::Across {
                    above = middle;
                } else {
                    below = middle;
                }
            }
            if self.best.is_none_or(|best| above.abs() < best.impulse.abs()) {
                hooks.log(
                    LogLevel::Info,
                    &format!("an impulse of {above:.6e} at the phase {phase:.4} leads to another motion"),
                );
                self.best = Some(Best {
                    phase,
                    impulse: above,
                    returning: below,
                });
            }
            return Ok(());
        }
        Ok(())
    }
}
