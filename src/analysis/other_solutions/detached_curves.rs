//! Curves of a forced response without connection to the branch, near the resonances that nonlinear modes predict.
//!
//! Along a mode the force F(a) that resonates at the amplitude a may fall and rise again. The amplitudes with F(a) = F beyond the
//! first are resonances of other curves (Hill, Neild & Cammarano 2016, doi:10.1016/j.jsv.2016.05.030); each is a start, from
//! where its curve is followed until it closes or leaves the range. A minimum of F(a) is the force at which a curve is born, the
//! maximum below it the one at which it merges with the curve beneath.

use crate::analysis::forced::forced_curve::alone;
use crate::analysis::forced::inside_start::Inside;
use crate::analysis::modes::nonlinear_mode::nonlinear_mode;
use crate::analysis::other_solutions::branch_switching::{Found, Tree};
use crate::analysis::synthesis::{ForceExtremum, Motions, with_motions};
use crate::continuation::ONE_SOLUTION;
use crate::error::{Error, Result, Status, try_push};
use crate::hooks::{Hooks, LogLevel};
use crate::interrupt::Interrupt;
use crate::model::Model;
use crate::model::natural_modes::linear_modes::{ContactState, LinearModes};
use crate::options::{Content, Flexibility, ForcedOptions, ModeChoice, ModeOptions, SolverOptions, SynthesisOptions};
use crate::results::{Branch, Descent, Recovery};
use core::cell::Cell;
use num_complex::Complex64;

const CONTEXT: &str = "the detached curves";

/// Most linear modes whose nonlinear ones are followed.
/// Kind: cap.
const DETACHED_CURVES_MOST_MODES: usize = 16;

/// Frequencies of these modes, as factors of the ends of the range: contacts soften or stiffen the structure.
/// Kind: tuned; measured on: not recorded.
const FREQUENCIES: (f64, f64) = (0.5, 2.0);

/// Range of the modal amplitude, in log₁₀ about the largest one of the branch in the motion of the mode.
/// Kind: tuned; measured on: not recorded.
const DETACHED_CURVES_AMPLITUDES: (f64, f64) = (2.0, 2.0);

/// Harmonics of the modes, which are starts alone, and most of their points.
/// Kind: tuned; measured on: not recorded.
const HARMONICS: usize = 5;
/// Most points of such a mode.
/// Kind: cap.
const DETACHED_CURVES_MOST_POINTS: usize = 2_000;

impl Tree<'_> {
    /// Adds the detached curves beside a branch, with their children, down to `depth`.
    ///
    /// # Errors
    /// `OutOfMemory`; `StoppedByCaller`; those of callbacks.
    pub fn add_detached(&mut self, branch: &mut Branch, depth: usize, hooks: &mut Hooks<'_>) -> Result<()> {
        // A mode resonates with forces in harmonic 1.
        if !self.model.acting_forces().any(|force| force.harmonic == 1) {
            hooks.log(
                LogLevel::Info,
                "no force acts in harmonic 1: no detached curve is sought",
            );
            return Ok(());
        }
        let (low, high) = self.ends();
        let wave = self.model.structure().engine_order();
        let interrupt = hooks.interrupt();
        let count = DETACHED_CURVES_MOST_MODES.min(self.model.structure().degrees().independent());
        let modes = match self
            .model
            .lowest_modes_with(wave, ContactState::Stuck, count, &interrupt)
        {
            Ok(modes) => modes,
            Err(e) => return tolerate(e, hooks),
        };
        for (number, omega) in modes.omega.iter().enumerate() {
            if *omega < FREQUENCIES.0 * low || *omega > FREQUENCIES.1 * high || self.left == 0 {
                continue;
            }
            let Some(amplitude) = largest_amplitude(branch, &modes, number, hooks)? else {
                continue;
            };
            let range = (
                amplitude.log10() - DETACHED_CURVES_AMPLITUDES.0,
                amplitude.log10() + DETACHED_CURVES_AMPLITUDES.1,
            );
            self.searched.modes += 1;
            let least = if self.searched.amplitudes.0 > 0.0 {
                self.searched.amplitudes.0
            } else {
                f64::INFINITY
            };
            self.searched.amplitudes.0 = least.min(10f64.powf(range.0));
            self.searched.amplitudes.1 = self.searched.amplitudes.1.max(10f64.powf(range.1));
            match self.along_mode(number, range, hooks) {
                Ok(motions) => self.add_resonances(branch, number, &motions, depth, hooks)?,
                Err(e) => {
                    self.searched.incomplete_modes += 1;
                    tolerate(e, hooks)?;
                }
            }
        }
        Ok(())
    }

    /// Lowest and highest frequency of the range.
    pub fn ends(&self) -> (f64, f64) {
        let (a, b) = (self.range.omega_start, self.range.omega_stop);
        (a.min(b), a.max(b))
    }

    /// The motions at the resonances of a nonlinear mode under the force, and the extrema of the force along it.
    fn along_mode(&mut self, number: usize, (from, to): (f64, f64), hooks: &mut Hooks<'_>) -> Result<Motions> {
        let solver = SolverOptions {
            tolerance: 0.0,
            harmonics: self.solver.harmonics.clamp(1, HARMONICS),
            max_harmonics: SolverOptions::default().max_harmonics,
            samples: 0,
            max_points: self.solver.max_points.min(DETACHED_CURVES_MOST_POINTS),
            stability: None,
            flexibility: Flexibility::Automatic,
            estimate_error: false,
            step: 0.0,
            step_min: 0.0,
            step_max: 0.0,
            ..*self.solver
        };
        let range = ModeOptions {
            choice: ModeChoice::Index(number),
            log10_start: from,
            log10_stop: to,
            ..ModeOptions::default()
        };
        let mode = nonlinear_mode(self.model, &solver, &range, hooks)?;
        if mode.status() == Status::StoppedByCaller {
            return Err(Error::new(
                mode.status(),
                format_args!("the caller stopped the search for detached curves"),
            ));
        }
        if mode.status() != Status::Ok {
            self.searched.incomplete_modes += 1;
        }
        let options = SynthesisOptions {
            compare: false,
            ..SynthesisOptions::default()
        };
        let mut motions = Motions::default();
        with_motions(&mode, self.model, &options, Some(&mut motions), &hooks.interrupt())?;
        Ok(motions)
    }

    /// Follows the curves through the resonances of a mode, largest amplitudes first.
    fn add_resonances(
        &mut self,
        branch: &mut Branch,
        mode: usize,
        motions: &Motions,
        depth: usize,
        hooks: &mut Hooks<'_>,
    ) -> Result<()> {
        let (low, high) = self.ends();
        for resonance in motions.resonances.iter().rev() {
            if resonance.omega < low || resonance.omega > high || self.left == 0 {
                continue;
            }
            self.searched.resonances += 1;
            let mut found = match self.through(branch, (resonance.omega, &resonance.harmonics), hooks)? {
                Found::Curve(found, _) => found,
                Found::Known => continue,
                Found::Nothing => {
                    self.searched.lost_resonances += 1;
                    continue;
                }
            };
            self.left -= 1;
            let (born, merges) = forces(resonance.log10_amplitude, &motions.extrema);
            found.set_descent(Descent {
                mode: Some(mode),
                born_at_force: born,
                merges_at_force: merges,
                ..Descent::default()
            });
            self.add(branch, found, (1, depth), hooks)?;
        }
        Ok(())
    }

    /// The curve through a motion at a frequency, unless that curve is known.
    pub fn through(
        &self,
        branch: &Branch,
        (omega, guess): (f64, &[Complex64]),
        hooks: &mut Hooks<'_>,
    ) -> Result<Found> {
        let mut known = Vec::new();
        try_push(&mut known, branch, CONTEXT)?;
        for sibling in branch.children().iter().filter(|sibling| sibling.periods() == 1) {
            try_push(&mut known, sibling, CONTEXT)?;
        }
        let inside = Inside {
            omega,
            content: Content::of(guess, &self.model.felt_by_contacts()?).0,
            leaves: None,
            known: &known,
            periods: 1,
            entry: Cell::default(),
            net: None,
            deflation: None,
        };
        let found = self.at_period(self.model, &inside, guess, (1, branch.response_dof()), hooks)?;
        let Found::Curve(curve, dropped) = found else {
            return Ok(found);
        };
        let curve = self.whole(self.model, &curve, 1, hooks)?.unwrap_or(curve);
        for known in &known {
            if self.shares_an_end(&curve, known, &hooks.interrupt())? {
                return Ok(Found::Known);
            }
        }
        Ok(Found::Curve(curve, dropped))
    }

    /// Whether two curves leave the range with one motion, so that they are one curve.
    pub fn shares_an_end(&self, a: &Branch, b: &Branch, interrupt: &Interrupt<'_>) -> Result<bool> {
        let (low, high) = self.ends();
        let ends = |branch: &Branch| [0, branch.points().saturating_sub(1)];
        let bound = ONE_SOLUTION.max(2.0 * self.solver.tolerance);
        for i in ends(a) {
            let Some(omega) = a.omega().get(i).copied() else {
                continue;
            };
            if omega.to_bits() != low.to_bits() && omega.to_bits() != high.to_bits() {
                continue;
            }
            for j in ends(b) {
                if b.omega().get(j).is_none_or(|other| other.to_bits() != omega.to_bits()) {
                    continue;
                }
                let highest = |branch: &Branch, i| branch.carried_at(i).and_then(|carried| carried.last().copied());
                let highest = highest(a, i).max(highest(b, j)).unwrap_or(1);
                let (x, y) = (
                    Recovery::at(a, i, interrupt)?.all(highest)?,
                    Recovery::at(b, j, interrupt)?.all(highest)?,
                );
                let size = y.iter().fold(0.0_f64, |s, y| s.hypot(y.norm()));
                let gap = x.iter().zip(&y).fold(0.0_f64, |s, (x, y)| s.hypot((x - y).norm()));
                if gap <= bound * size {
                    return Ok(true);
                }
            }
        }
        Ok(false)
    }

    /// A curve that left the range, followed back from this end through its start to its other end; `None` where it
    /// did not leave the range.
    pub fn whole(
        &self,
        model: &Model,
        curve: &Branch,
        periods: usize,
        hooks: &mut Hooks<'_>,
    ) -> Result<Option<Branch>> {
        let scale = 1.0 / periods as f64;
        let (a, b) = (self.range.omega_start * scale, self.range.omega_stop * scale);
        let (low, high) = (a.min(b), a.max(b));
        let (Some(last), Some(end)) = (curve.points().checked_sub(1), curve.omega().last().copied()) else {
            return Ok(None);
        };
        let is_end = end.to_bits() == low.to_bits() || end.to_bits() == high.to_bits();
        if curve.status() != Status::Ok || !is_end {
            return Ok(None);
        }
        let mut at = Vec::new();
        for omega in self.range.at {
            try_push(&mut at, omega * scale, CONTEXT)?;
        }
        let highest = curve.carried_at(last).and_then(|carried| carried.last().copied());
        let guess = Recovery::at(curve, last, &hooks.interrupt())?.all(highest.unwrap_or(1))?;
        let range = ForcedOptions {
            omega_start: end,
            omega_stop: if end.to_bits() == low.to_bits() { high } else { low },
            guess: Some(&guess),
            at: &at,
            responses: if periods == 1 { self.range.responses } else { &[] },
            together: self.range.together,
            ..ForcedOptions::default()
        };
        let solver = SolverOptions {
            harmonics: self.solver.harmonics.saturating_mul(periods),
            max_harmonics: self.solver.max_harmonics.saturating_mul(periods),
            response_dof: Some(curve.response_dof()),
            ..*self.solver
        };
        match alone(model, &solver, &range, hooks) {
            Ok(whole) => Ok((whole.points() >= curve.points() / 2).then_some(whole)),
            Err(e) => tolerate(e, hooks).map(|()| None),
        }
    }
}

/// Largest amplitude of the branch at the degree of freedom that moves most in a linear mode; `None` where this
/// degree of freedom does not move.
fn largest_amplitude(branch: &Branch, modes: &LinearModes, number: usize, hooks: &Hooks<'_>) -> Result<Option<f64>> {
    let ndof = branch.ndof().max(1);
    let shape = modes.shapes.chunks_exact(ndof).nth(number).unwrap_or(&[]);
    let largest = shape
        .iter()
        .enumerate()
        .max_by(|(_, a), (_, b)| a.norm().total_cmp(&b.norm()));
    let Some((dof, shape)) = largest.filter(|(_, x)| x.norm() > 0.0) else {
        return Ok(None);
    };
    let interrupt = hooks.interrupt();
    let ends = [0, branch.points().saturating_sub(1)];
    let mut most = 0.0_f64;
    for point in branch.peaks().iter().map(|peak| peak.point).chain(ends) {
        let x = Recovery::at(branch, point, &interrupt)?.all(branch.harmonics().max(1))?;
        most = most.max(x[ndof + dof].norm() / shape.norm());
    }
    Ok((most > 0.0 && most.is_finite()).then_some(most))
}

/// Factors of the force at which the detached curve with a resonance is born, and at which it merges with the curve
/// beneath; NaN where the mode has no such extremum.
fn forces(resonance: f64, extrema: &[ForceExtremum]) -> (f64, f64) {
    let minima = || extrema.iter().filter(|extremum| !extremum.is_maximum);
    // The upper resonance lies above the minimum of the force, the lower one beneath.
    let below_is = extrema.iter().rfind(|extremum| extremum.log10_amplitude < resonance);
    let birth = match below_is {
        Some(extremum) if extremum.is_maximum => minima().find(|e| e.log10_amplitude > resonance),
        Some(extremum) => Some(extremum),
        None => None,
    };
    let Some(birth) = birth else {
        return (f64::NAN, f64::NAN);
    };
    let merging = extrema
        .iter()
        .rfind(|extremum| extremum.is_maximum && extremum.log10_amplitude < birth.log10_amplitude);
    (birth.factor, merging.map_or(f64::NAN, |merging| merging.factor))
}

/// Continues after a failed search, which must not cost a known branch: logs the error, or returns it where the run
/// must end.
pub(crate) fn tolerate(e: Error, hooks: &mut Hooks<'_>) -> Result<()> {
    match e.status {
        Status::StoppedByCaller | Status::OutOfMemory | Status::Callback => Err(e),
        _ => {
            hooks.log(LogLevel::Warn, e.message());
            Ok(())
        }
    }
}
