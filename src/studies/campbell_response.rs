//! Resonances of a Campbell diagram with their amplitudes: the steady peak of a nonlinear mode under its forces, damping there, and how
//! much of it a passage at an acceleration reaches.

use crate::error::{Result, fail, try_push};
use crate::interrupt::{Interrupt, Phase};
use crate::model::Model;
use crate::options::{CampbellResponseOptions, MissionOptions, SynthesisOptions};
use crate::results::Branch;
use crate::studies::mission::mission;
use crate::studies::run_up::loaded;

/// Half widths of a passage: bandwidths Dω and quick widths, the root of the rate, on each side of the resonance. Chosen, not measured:
/// a passage begins where the response is 1/30 of the peak, and ends behind the beat.
/// Kind: tuned; measured on: nothing, it is chosen.
const CAMPBELL_PASSAGE: f64 = 15.0;

/// Least frequency of a passage over that of its resonance.
/// Kind: cap.
const CAMPBELL_LOWEST: f64 = 0.2;

/// The highest resonance of a mode under one force.
#[derive(Clone, Copy, Debug)]
pub struct CampbellResonance {
    /// Speed of rotation at which the engine order meets the resonance. NaN, as are the other numbers, where the
    /// force finds no resonance.
    pub speed: f64,
    /// Angular frequency of the force.
    pub omega: f64,
    /// Steady amplitude of the mode's response degree of freedom, in the fundamental.
    pub amplitude: f64,
    /// Damping ratio at the steady amplitude.
    pub damping_ratio: f64,
    /// Largest amplitude of a passage at the acceleration; NaN without acceleration.
    pub passed: f64,
    /// Steady amplitude over the computed one, minus 1; NaN where it was not computed.
    pub error: f64,
}

impl CampbellResonance {
    /// Numbers where the force finds no resonance: NaN.
    const NONE: Self = Self {
        speed: f64::NAN,
        omega: f64::NAN,
        amplitude: f64::NAN,
        damping_ratio: f64::NAN,
        passed: f64::NAN,
        error: f64::NAN,
    };

    /// Ratio of the largest amplitude of the passage to the steady amplitude.
    #[must_use]
    pub fn factor(&self) -> f64 {
        self.passed / self.amplitude
    }
}

/// The highest resonance of a nonlinear mode where an engine order meets it, under each factor on the forces of the model.
///
/// A passage runs from the steady motion below the resonance to above it, or from above for a negative acceleration, by the slow flow
/// of [`mission`].
///
/// # Errors
/// Those of [`CampbellResponseOptions::check`], of [`synthesise`](crate::synthesise) and of [`mission`]: `Argument` where a passage leaves
/// the amplitudes of the mode; `StoppedByCaller`.
pub fn campbell_response(
    branch: &Branch,
    model: &Model,
    options: &CampbellResponseOptions<'_>,
    interrupt: &Interrupt<'_>,
) -> Result<Vec<CampbellResonance>> {
    options.check()?;
    if options.acceleration != 0.0 && model.excitation().has_unbalance() {
        return fail!(
            Unsupported,
            "an unbalance follows the frequency, which a passage changes"
        );
    }
    let mut all = Vec::new();
    for (i, &factor) in options.force_factors.iter().enumerate() {
        interrupt.part(Phase::Results, i, options.force_factors.len())?;
        let synthesis = SynthesisOptions {
            force_factor: factor * options.synthesis.force_factor,
            ..options.synthesis
        };
        let (_, highest) = loaded(branch, model, &synthesis, interrupt)?;
        let mut one = CampbellResonance::NONE;
        if let Some(peak) = highest {
            one = CampbellResonance {
                speed: peak.at.omega / options.engine_order,
                omega: peak.at.omega,
                amplitude: peak.at.response.norm(),
                damping_ratio: peak.at.damping_ratio,
                passed: f64::NAN,
                error: peak.validity.error,
            };
            if options.acceleration != 0.0 {
                one.passed = passed(branch, model, &one, options, synthesis, interrupt)?;
            }
        }
        try_push(&mut all, one, "the resonances of a Campbell diagram")?;
    }
    Ok(all)
}

/// The largest amplitude of a passage through a resonance.
fn passed(
    branch: &Branch,
    model: &Model,
    at: &CampbellResonance,
    options: &CampbellResponseOptions<'_>,
    synthesis: SynthesisOptions,
    interrupt: &Interrupt<'_>,
) -> Result<f64> {
    let order = options.engine_order;
    let rate = (order * options.acceleration).abs();
    let width = CAMPBELL_PASSAGE * (at.damping_ratio * at.omega + rate.sqrt());
    let (low, high) = ((at.omega - width).max(CAMPBELL_LOWEST * at.omega), at.omega + width);
    let speeds = if options.acceleration > 0.0 {
        [low / order, high / order]
    } else {
        [high / order, low / order]
    };
    let flight = MissionOptions {
        times: &[0.0, (high - low) / rate],
        speeds: &speeds,
        engine_order: order,
        dof: None,
        edges: &[],
        stresses: &[],
        woehler: None,
        synthesis,
    };
    let found = mission(branch, model, &flight, interrupt)?;
    let amplitudes = found.crossings.iter().map(|crossing| crossing.amplitude);
    Ok(amplitudes.fold(f64::NAN, f64::max))
}
