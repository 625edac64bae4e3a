//! Forced responses from a nonlinear mode: near resonance the structure moves like one oscillator whose
//! frequency and damping follow the amplitude (single nonlinear mode theory: Krack, Panning-von
//! Scheidt & Wallaschek 2013, doi:10.1115/1.4024404).
//!
//! With a the modal amplitude and X₁ the fundamental of the mode, which moves like a φ,
//!
//! > |ω₀² − Ω² + 2iDω₀Ω| a² = |X₁ᴴ F|,
//! > Ω² = ω₀²(1 − 2D²) ± (|X₁ᴴF|²/a⁴ − 4D²ω₀⁴(1 − D²))^½:
//!
//! These are two frequencies at each amplitude; they meet at the resonance, where the root vanishes.

mod computed_peak;
mod force_extrema;
mod mode_motions;
mod oscillator;
mod resonance;

pub(crate) use crate::analysis::synthesis::mode_motions::{ForceExtremum, Motions};
pub use crate::analysis::synthesis::oscillator::SynthesisPoint;
pub(crate) use crate::analysis::synthesis::oscillator::{Load, State, form};
pub(crate) use crate::analysis::synthesis::resonance::Refinement;
use crate::error::{Result, fail, try_push, try_vec};
use crate::interrupt::{Interrupt, Phase};
use crate::linalg::sparse_storage::sparse::Csc;
use crate::model::Model;
use crate::model::matrices::structure::MatrixKind;
use crate::options::SynthesisOptions;
use crate::results::stored::mode_branch::ModeData;
use crate::results::{Branch, Recovery};
use num_complex::Complex64;

/// Validity of a synthesised resonance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Validity {
    /// Distance to the nearest other natural frequency of the wave, contacts anywhere between stuck
    /// and free, over the half-power bandwidth 2DΩ; infinite where no other mode is known.
    pub other_mode: f64,
    /// Share of the fundamental in the kinetic energy.
    pub fundamental_share: f64,
    /// True if several modes share the frequency of the linear mode.
    pub repeated: bool,
    /// True if the amplitude falls along the branch here, beyond a fold.
    pub turned: bool,
    /// Error of the synthesised amplitude against the computed resonance next to it, ratio minus 1, at the response
    /// degree of freedom and with the harmonics of the mode. NaN where no computed resonance was found, or none was
    /// sought.
    pub error: f64,
}

/// Error of the amplitude above which a resonance is inaccurate.
/// Kind: tuned; measured on: not recorded.
const INACCURATE: f64 = 0.01;

/// Share of the kinetic energy outside the fundamental above which a higher harmonic resonates.
/// Kind: tuned; measured on: not recorded.
const OUTSIDE: f64 = 0.01;

impl Validity {
    /// Whether another mode lies within the half-power bandwidth, or shares the frequency.
    #[must_use]
    pub fn another_mode(&self) -> bool {
        self.repeated || self.other_mode <= 1.0
    }

    /// Whether the amplitude is in error by more than 1 %, or its error is unknown.
    #[must_use]
    pub fn inaccurate(&self) -> bool {
        self.error.is_nan() || self.error.abs() >= INACCURATE
    }

    /// Whether the mode resonates with another one in a higher harmonic.
    ///
    /// This holds if more than 1 % of its kinetic energy lies in higher harmonics, or if its amplitude has turned.
    #[must_use]
    pub fn internal_resonance(&self) -> bool {
        self.turned || self.fundamental_share < 1.0 - OUTSIDE
    }
}

/// A synthesised resonance of the mode under the forces.
#[derive(Clone, Copy, Debug)]
pub struct SynthesisPeak {
    /// The response at the resonance.
    pub at: SynthesisPoint,
    /// log₁₀ of the amplitude as the branch measures it.
    pub log10_amplitude: f64,
    /// Whether the amplitude rises with the force at this resonance.
    ///
    /// If it does not, the resonance bounds a detached response from below.
    pub rising: bool,
    /// Validity of the resonance.
    pub validity: Validity,
}

/// A forced response synthesised from a nonlinear mode.
#[derive(Clone, Debug)]
pub struct Synthesis {
    /// The response in order of rising amplitude on the lower flank, then of falling amplitude on the upper one,
    /// over the amplitudes of the branch.
    pub points: Vec<SynthesisPoint>,
    /// Resonances, refined on the mode's equations, in the order of the branch. Empty if the force is too small or
    /// too large for the amplitudes of the branch.
    pub peaks: Vec<SynthesisPeak>,
}

const CONTEXT: &str = "the synthesised response";

/// Synthesises the response to the forces of `model` in the fundamental from a nonlinear mode.
///
/// `model` is the one that the mode was computed from, or one with other forces or damping. Forces in other
/// harmonics are ignored.
///
/// # Errors
/// `Unsupported` for a branch that is no mode; `Dimension` or `Argument` for a model of a different size or wave,
/// without forces in the fundamental, or options out of range.
pub fn synthesise(branch: &Branch, model: &Model, options: &SynthesisOptions) -> Result<Synthesis> {
    synthesise_with(branch, model, options, &Interrupt::none())
}

/// Synthesises a response as [`synthesise`], and the caller may stop it.
///
/// # Errors
/// As [`synthesise`]; `StoppedByCaller`.
pub fn synthesise_with(
    branch: &Branch,
    model: &Model,
    options: &SynthesisOptions,
    interrupt: &Interrupt<'_>,
) -> Result<Synthesis> {
    with_motions(branch, model, options, None, interrupt)
}

/// Synthesises a response as [`synthesise_with`]; also collects the motions at its resonances, if requested.
pub(crate) fn with_motions(
    branch: &Branch,
    model: &Model,
    options: &SynthesisOptions,
    mut motions: Option<&mut Motions>,
    interrupt: &Interrupt<'_>,
) -> Result<Synthesis> {
    let ndof = model.structure().ndof();
    let Some(load) = load_of(branch, model, options)? else {
        return Ok(Synthesis {
            points: Vec::new(),
            peaks: Vec::new(),
        });
    };
    let Some(data) = branch.mode_data() else {
        return fail!(Internal, "a mode without its data");
    };
    let mut states = Vec::new();
    let mut recovery = Recovery::at(branch, 0, interrupt)?;
    let mut x = try_vec(ndof, Complex64::ZERO, CONTEXT)?;
    for point in 0..branch.points() {
        interrupt.part(Phase::Results, point, branch.points())?;
        recovery.go_to(branch, point)?;
        recovery.coordinates(branch.condensed_at(point).set().fundamental(), &mut x)?;
        let Some(numbers) = data.point(point) else {
            return fail!(Internal, "point {point} of the mode has no numbers");
        };
        let state = load.state(branch.omega()[point], &numbers, &x);
        try_push(&mut states, state, CONTEXT)?;
    }
    let mut synthesis = Synthesis {
        points: flanks(&states)?,
        peaks: Vec::new(),
    };
    let mut refinement = Refinement::new(branch, data, &load, interrupt)?;
    for k in 1..states.len() {
        let (a, b) = (states[k - 1].excess(), states[k].excess());
        if (a < 0.0) == (b < 0.0) {
            continue;
        }
        if let Some(state) = refinement.between(k - 1, a, b)? {
            let backwards = states[k].log10 < states[k - 1].log10;
            let Some(at) = state.at_peak() else {
                continue;
            };
            let error = if options.compare {
                let damping = |h: usize| -> Result<Option<Csc>> {
                    Ok(if options.model_damping {
                        Some(model.structure().wave_matrix(MatrixKind::Damping, h)?)
                    } else {
                        None
                    })
                };
                computed_peak::error(&refinement.at_peak(&state, at.omega), &load, damping, interrupt)?
            } else {
                f64::NAN
            };
            let peak = SynthesisPeak {
                at,
                log10_amplitude: state.log10,
                rising: a < 0.0,
                validity: Validity {
                    error,
                    ..validity(data, &state, backwards)
                },
            };
            try_push(&mut synthesis.peaks, peak, CONTEXT)?;
            if let Some(motions) = &mut motions {
                motions.push(&refinement, &state, at.omega)?;
            }
        }
    }
    if let Some(motions) = motions {
        force_extrema::find(&mut refinement, &states, motions)?;
        motions
            .resonances
            .sort_by(|a, b| a.log10_amplitude.total_cmp(&b.log10_amplitude));
    }
    Ok(synthesis)
}

/// Forces and damping of `model` on the mode, after checks; `None` for a mode without points.
///
/// # Errors
/// As [`synthesise`].
pub(crate) fn load_of(branch: &Branch, model: &Model, options: &SynthesisOptions) -> Result<Option<Load>> {
    options.check()?;
    let Some(data) = branch.mode_data() else {
        return fail!(
            Unsupported,
            "the branch is a forced response; responses are synthesised from a nonlinear mode"
        );
    };
    branch.check_one_model()?;
    check_model(branch, data, model)?;
    let ndof = model.structure().ndof();
    let mut force = try_vec(ndof, Complex64::ZERO, CONTEXT)?;
    model.add_forces_to(1, options.force_factor, &mut force);
    let mut unbalance = try_vec(ndof, Complex64::ZERO, CONTEXT)?;
    model.add_unbalance_to(1, options.force_factor, &mut unbalance);
    if force.iter().chain(&unbalance).all(|f| *f == Complex64::ZERO) {
        return fail!(Argument, "the model has no force in the fundamental");
    }
    if branch.points() == 0 {
        return Ok(None);
    }
    let of_model = |kind| {
        let matrix = || model.structure().wave_matrix(kind, 1);
        options.model_damping.then(matrix).transpose()
    };
    let fundamental = branch.condensed_at(0);
    Ok(Some(Load {
        force,
        unbalance,
        damping: of_model(MatrixKind::Damping)?,
        structural: of_model(MatrixKind::Structural)?,
        ratio: options.damping_ratio,
        response: fundamental.motion_row(fundamental.set().fundamental(), branch.response_dof())?,
    }))
}

fn check_model(branch: &Branch, data: &ModeData, model: &Model) -> Result<()> {
    if model.ndof() != branch.ndof() || model.structure().sectors() != branch.reduction().sectors {
        return fail!(
            Dimension,
            "the model has {} degrees of freedom and {} sectors, the mode {} and {}",
            model.ndof(),
            model.structure().sectors(),
            branch.ndof(),
            branch.reduction().sectors
        );
    }
    if !model.structure().degrees().is_same(branch.condensed_at(0).degrees()) {
        return fail!(
            Argument,
            "other degrees of freedom of the model are fixed than those of the mode, or its faces are others"
        );
    }
    branch.check_model_of_synthesis(model)?;
    let (given, own) = (model.structure().engine_order(), data.info.engine_order);
    if model.structure().fold(given) != model.structure().fold(own) {
        return fail!(
            Argument,
            "the forces of engine order {given} do not excite the mode, which is a wave of engine order {own}"
        );
    }
    Ok(())
}

/// The response on both flanks of the resonance: rising amplitudes on the lower one, then falling ones on the upper
/// one.
fn flanks(states: &[State]) -> Result<Vec<SynthesisPoint>> {
    let mut points = Vec::new();
    let lower = states.iter().map(|s| s.spread().and_then(|r| s.at(-r)));
    let upper = states.iter().rev().map(|s| s.spread().and_then(|r| s.at(r)));
    for point in lower.chain(upper).flatten() {
        try_push(&mut points, point, CONTEXT)?;
    }
    Ok(points)
}

fn validity(data: &ModeData, state: &State, backwards: bool) -> Validity {
    let info = &data.info;
    let omega = state.omega;
    let bandwidth = 2.0 * state.damping.abs() * omega;
    let mut distance = f64::INFINITY;
    for (j, &stuck) in info.stuck.iter().enumerate().filter(|(j, _)| *j != info.index) {
        // A mode without slip has its stuck frequency, with slip a lower one.
        let free = info.free.get(j).copied().unwrap_or(stuck);
        let (low, high) = (stuck.min(free), stuck.max(free));
        distance = distance.min((low - omega).max(omega - high).max(0.0));
    }
    Validity {
        other_mode: if distance == 0.0 { 0.0 } else { distance / bandwidth },
        fundamental_share: state.fundamental_share,
        repeated: info.multiplicity > 1,
        turned: backwards,
        error: f64::NAN,
    }
}
