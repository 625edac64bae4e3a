//! Stability of the points of a forced response while it is followed.

use crate::analysis::perturbed::floquet_on_modes::{KeptModes, floquet_of};
use crate::analysis::perturbed::perturbed_motion::{FAR, Motion};
use crate::condense::Resolution;
use crate::continuation::Point;
use crate::error::try_push;
use crate::error::{Result, Status};
use crate::hooks::Hooks;
use crate::interrupt::Interrupt;
use crate::model::Model;
use crate::model::matrices::speed::Speed;
use crate::options::{FloquetOptions, Waves};
use crate::results::{Floquet, MultiplierClass, Recovery, Verdict};
use crate::time_integration::{State, System};
use num_complex::Complex64;

/// Stability of the points of one branch.
pub(crate) struct BranchStability<'a> {
    model: &'a Model,
    options: FloquetOptions,
    /// Whether the motion is integrated on all degrees of freedom, not on modes.
    pub on_all_degrees: bool,
    /// Modes of a large structure, kept for the next point.
    modes: KeptModes,
    interrupt: &'a Interrupt<'a>,
    /// Difference between the state in time and the state by harmonics, at the point solved last.
    difference: Option<State>,
    /// Stability of the last two recorded points of the curve, the last one at the end.
    last: [Option<Verdict>; 2],
    /// Frequency of the last point, if all contacts were linear there; else `None`.
    linear: Option<f64>,
    /// Whether the stability of the last two points was handed to the search for bifurcations.
    taken: bool,
}

impl<'a> BranchStability<'a> {
    /// Prepares for the points of a model. Models that cannot be integrated in time are refused.
    pub fn new(model: &'a Model, waves: Waves, omega: f64, interrupt: &'a Interrupt<'a>) -> Result<Self> {
        let options = FloquetOptions {
            waves,
            ..FloquetOptions::default()
        };
        let mut modes = KeptModes::default();
        let on_all_degrees = modes.on_all_degrees(model, omega, &options)?;
        if on_all_degrees {
            System::new(model, omega, interrupt)?;
        }
        Ok(Self {
            on_all_degrees,
            model,
            options,
            modes,
            interrupt,
            difference: None,
            last: [None, None],
            linear: None,
            taken: true,
        })
    }

    /// Stability of the next point of the curve, at which every contact may be `linear`.
    pub fn along(
        &mut self,
        resolution: &Resolution,
        point: &Point,
        fine: Option<&[Complex64]>,
        linear: bool,
    ) -> Result<&Verdict> {
        let omega = point.parameter();
        let fixed = !matches!(self.model.speed(), Speed::PerOmega(_));
        let verdict = match (self.linear, &self.last[1]) {
            (Some(before), Some(last)) if linear && fixed => with_linear_contacts(last, before / omega)?,
            _ => self.solve(resolution, point, fine, true)?,
        };
        self.linear = (linear && verdict.unstable.is_some()).then_some(omega);
        self.last.rotate_left(1);
        self.taken = false;
        Ok(self.last[1].insert(verdict))
    }

    /// Stability of the last two points of the curve; only at the first call.
    pub fn take_last(&mut self) -> Option<(Verdict, Verdict)> {
        if core::mem::replace(&mut self.taken, true) {
            return None;
        }
        let [before, after] = &self.last;
        Some((before.clone()?, after.clone()?))
    }

    /// Stability of the motion of a solved point that need not lie on the curve; `fine` is its motion with more
    /// harmonics.
    pub fn at(&mut self, resolution: &Resolution, point: &Point, fine: Option<&[Complex64]>) -> Result<Verdict> {
        self.solve(resolution, point, fine, false)
    }

    /// Stability of the motion of a solved point. The multipliers belong to the motion in time that shooting finds
    /// near the point, to its tolerance or (not `quick`) to round-off; where it finds none, as near a fold, to the
    /// path of the point itself.
    fn solve(
        &mut self,
        resolution: &Resolution,
        point: &Point,
        fine: Option<&[Complex64]>,
        quick: bool,
    ) -> Result<Verdict> {
        let highest = resolution.condensed.set().numbers().last().copied().unwrap_or(0);
        let solution = (point.unknowns(), point.parameter(), 0.0);
        let harmonics = Recovery::of(resolution, solution, self.interrupt)?.all(highest)?;
        let near = self.difference.take();
        let motion = Motion {
            omega: point.parameter(),
            harmonics: &harmonics,
            autonomous: false,
            compared: false,
            fine,
            difference: near.as_ref(),
            quick,
        };
        for refine in [true, false] {
            let options = FloquetOptions { refine, ..self.options };
            let found = floquet_of(
                self.model,
                &motion,
                &options,
                &mut Hooks::default(),
                &mut self.modes,
                self.interrupt,
            );
            match found {
                Ok(found) if found.shift > FAR => {}
                Ok(found) => {
                    self.difference = found.difference;
                    return verdict(&found.stability, refine);
                }
                Err(e)
                    if matches!(
                        e.status,
                        Status::NoConvergence | Status::NoBoundedSolution | Status::Singular
                    ) => {}
                Err(e) => return Err(e),
            }
        }
        Ok(Verdict::unknown())
    }
}

fn verdict(stability: &Floquet, in_time: bool) -> Result<Verdict> {
    if stability.radius.is_nan() {
        return Ok(Verdict::unknown());
    }
    let mut multipliers = Vec::new();
    let all = stability.multipliers.iter();
    for m in all.filter(|m| m.class == MultiplierClass::Ordinary) {
        try_push(&mut multipliers, m.value, "the stability of a point")?;
    }
    Ok(Verdict {
        multipliers,
        radius: stability.radius,
        unstable: Some(stability.unstable),
        in_time,
    })
}

/// Stability at another frequency, with the contacts in the same linear state as at the last point: perturbations
/// grow by the same e^{λt}, over a period that is `periods` times as long.
fn with_linear_contacts(last: &Verdict, periods: f64) -> Result<Verdict> {
    let mut multipliers = Vec::new();
    for m in &last.multipliers {
        let size = m.norm();
        let scale = if size > 0.0 { size.powf(periods) / size } else { 0.0 };
        try_push(&mut multipliers, m * scale, "the stability of a point")?;
    }
    Ok(Verdict {
        multipliers,
        radius: last.radius.powf(periods),
        unstable: last.unstable,
        in_time: last.in_time,
    })
}
