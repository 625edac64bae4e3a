//! Forced responses from a nonlinear mode: near resonance the structure moves like one oscillator whose
//! frequency and damping follow the amplitude (single nonlinear mode theory: Krack, Panning-von
//! Scheidt & Wallaschek 2013, doi:10.1115/1.4024404).
//!
//! With a the modal amplitude and X₁ the fundamental of the mode, which moves like a φ,
//!
//! > |ω₀² − Ω² + 2iDω₀Ω| a² = |X₁ᴴ F|,
//! > Ω² = ω₀²(1 − 2D²) ± (|X₁ᴴF|²/a⁴ − 4D²ω₀⁴(1 − D²))^½:
//!
//! two frequencies at each amplitude, and the resonance where the root vanishes.

use crate::branch::mode::{ModeData, ModePoint};
use crate::branch::{Branch, Recovery};
use crate::continuation::events::Locator;
use crate::continuation::step_control::StepControl;
use crate::continuation::{Point, Settings};
use crate::error::{Result, fail, try_copy, try_push, try_vec};
use crate::linalg::sparse::Csc;
use crate::model::Model;
use crate::model::structure::MatrixKind;
use crate::options::SynthesisOptions;
use crate::postprocess::energy::balance;
use crate::problem::mode::Mode;
use crate::problem::{Linearisation, Problem};
use num_complex::Complex64;

/// A synthesised response at one frequency.
#[derive(Clone, Copy, Debug)]
pub struct SynthesisPoint {
    /// Angular frequency Ω of the force.
    pub omega: f64,
    /// Fundamental of the branch's response degree of freedom, with the phase against the force.
    pub response: Complex64,
    /// Modal amplitude.
    pub modal_amplitude: f64,
    /// Natural angular frequency ω₀ at this amplitude.
    pub natural_omega: f64,
    /// Damping ratio at this amplitude, with what the options add.
    pub damping_ratio: f64,
}

/// Where the synthesis may mislead.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Validity {
    /// Distance to the nearest other natural frequency of the wave, contacts anywhere between stuck
    /// and free, over the half-power bandwidth 2DΩ; infinite where no other mode is known.
    pub other_mode: f64,
    /// Share of the fundamental in the kinetic energy.
    pub fundamental_share: f64,
    /// Several modes share the frequency of the linear mode.
    pub repeated: bool,
    /// The branch passes this amplitude more than once.
    pub folded: bool,
}

/// Share of the kinetic energy outside of the fundamental above which a higher harmonic resonates.
const OUTSIDE: f64 = 0.01;

impl Validity {
    /// Another mode lies within the bandwidth of this one, or shares its frequency.
    #[must_use]
    pub fn another_mode(&self) -> bool {
        self.repeated || self.other_mode <= 1.0
    }

    /// The mode resonates with another one in a higher harmonic: more than 1 % of its kinetic energy
    /// lies there, or it has several forms at this amplitude.
    #[must_use]
    pub fn internal_resonance(&self) -> bool {
        self.folded || self.fundamental_share < 1.0 - OUTSIDE
    }
}

/// A synthesised resonance.
#[derive(Clone, Copy, Debug)]
pub struct SynthesisPeak {
    /// The response there.
    pub at: SynthesisPoint,
    /// log₁₀ of the amplitude as the branch measures it.
    pub log10_amplitude: f64,
    /// Whether amplitude rises with force here. Where it does not, the resonance bounds a detached
    /// response from below.
    pub rising: bool,
    /// Where this may mislead.
    pub validity: Validity,
}

/// A synthesised response.
#[derive(Clone, Debug)]
pub struct Synthesis {
    /// The response by rising amplitude on the lower flank, then by falling amplitude on the upper
    /// one, as far as the branch reaches.
    pub points: Vec<SynthesisPoint>,
    /// Resonances, refined on the mode's equations, in the order of the branch. None where the force
    /// is too small or too large for the amplitudes of the branch.
    pub peaks: Vec<SynthesisPeak>,
}

const WHAT: &str = "the synthesised response";

/// Relative accuracy of the amplitude of a resonance.
const WIDTH: f64 = 1e-12;

/// Most evaluations for one resonance.
const MAX_EVALUATIONS: usize = 60;

/// Synthesises the response to the forces of `model` in the fundamental from a nonlinear mode.
///
/// `model` is the one that the mode was computed from, or one with other forces or damping. Forces in
/// other harmonics play no part.
///
/// # Errors
/// `Unsupported` for a branch that is no mode; `Dimension` or `Argument` for a model of another size
/// or another wave, without forces in the fundamental, or options out of range.
pub fn synthesise(branch: &Branch, model: &Model, options: &SynthesisOptions) -> Result<Synthesis> {
    options.check()?;
    let Some(data) = branch.mode_data() else {
        return fail!(
            Unsupported,
            "the branch is a forced response; responses are synthesised from a nonlinear mode"
        );
    };
    check_model(branch, data, model)?;
    let mut force = try_vec(model.ndof(), Complex64::ZERO, WHAT)?;
    model.excitation().add_to(1, options.force_factor, &mut force);
    if force.iter().all(|f| *f == Complex64::ZERO) {
        return fail!(Argument, "the model has no force in the fundamental");
    }
    let damping = if options.model_damping {
        Some(model.structure().wave_matrix(MatrixKind::Damping, 1)?)
    } else {
        None
    };
    let load = Load {
        force,
        damping,
        ratio: options.damping_ratio,
        response_dof: branch.response_dof(),
    };
    let mut states = Vec::new();
    let mut recovery = Recovery::new(branch)?;
    let fundamental = branch.carried().iter().position(|&h| h == 1).unwrap_or(0);
    let mut x = try_vec(model.ndof(), Complex64::ZERO, WHAT)?;
    for point in 0..branch.points() {
        recovery.go_to(point);
        recovery.harmonic(fundamental, &mut x)?;
        let state = load.state(branch.omega()[point], data.point(point), &x)?;
        try_push(&mut states, state, WHAT)?;
    }
    let mut synthesis = Synthesis {
        points: flanks(&states)?,
        peaks: Vec::new(),
    };
    let mut refinement = Refinement::new(branch, data, &load)?;
    for k in 1..states.len() {
        let (a, b) = (states[k - 1].excess(), states[k].excess());
        if (a < 0.0) == (b < 0.0) {
            continue;
        }
        if let Some(state) = refinement.between(k - 1, a, b)? {
            let peak = SynthesisPeak {
                at: state.at_peak(),
                log10_amplitude: state.log10,
                rising: a < 0.0,
                validity: validity(branch, data, &state),
            };
            try_push(&mut synthesis.peaks, peak, WHAT)?;
        }
    }
    Ok(synthesis)
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
    let (given, own) = (model.structure().engine_order(), data.info.engine_order);
    if model.structure().fold(given) != model.structure().fold(own) {
        return fail!(
            Argument,
            "the forces of engine order {given} do not excite the mode, which is a wave of engine order {own}"
        );
    }
    Ok(())
}

/// What acts on the mode.
struct Load {
    force: Vec<Complex64>,
    damping: Option<Csc>,
    ratio: f64,
    response_dof: usize,
}

/// The mode at one amplitude, as the synthesis sees it.
#[derive(Clone, Copy, Debug)]
struct State {
    omega: f64,
    damping: f64,
    /// Square of the modal amplitude.
    square: f64,
    /// X₁ᴴ F
    work: Complex64,
    /// X₁ of the response degree of freedom.
    response: Complex64,
    log10: f64,
    fundamental_share: f64,
}

impl Load {
    fn state(&self, omega: f64, point: Option<&ModePoint>, x: &[Complex64]) -> Result<State> {
        let Some(point) = point else {
            return fail!(Internal, "a point of the mode has no numbers");
        };
        let square = point.modal_amplitude * point.modal_amplitude;
        let mut damping = point.damping_ratio + self.ratio;
        if let Some(c) = &self.damping {
            // xᴴ C x = 2Dω·xᴴ M x
            let mut form = 0.0;
            for (j, xj) in x.iter().enumerate() {
                for (i, v) in c.column(j) {
                    form += (x[i].conj() * v * xj).re;
                }
            }
            damping += 0.5 * form / (omega * square);
        }
        Ok(State {
            omega,
            damping,
            square,
            work: x.iter().zip(&self.force).map(|(x, f)| x.conj() * f).sum(),
            response: x[self.response_dof],
            log10: point.log10_amplitude,
            fundamental_share: point.fundamental_share,
        })
    }
}

impl State {
    /// What damping takes at resonance beyond what the force can give: 2D(1 − D²)^½ω₀²a² − |X₁ᴴF|.
    fn excess(&self) -> f64 {
        let d = self.damping;
        2.0 * d * (1.0 - d * d).max(0.0).sqrt() * self.omega * self.omega * self.square - self.work.norm()
    }

    /// Half the distance of the two Ω², where the force can hold the amplitude.
    fn spread(&self) -> Option<f64> {
        let (d, w2) = (self.damping, self.omega * self.omega);
        let b = self.work.norm() / self.square;
        let square = b * b - 4.0 * d * d * (1.0 - d * d) * w2 * w2;
        (square >= 0.0).then(|| square.sqrt())
    }

    fn at(&self, spread: f64) -> Option<SynthesisPoint> {
        let (d, w2) = (self.damping, self.omega * self.omega);
        let square = w2 * (1.0 - 2.0 * d * d) + spread;
        if square <= 0.0 {
            return None;
        }
        let omega = square.sqrt();
        // The oscillator turns X₁ into the phase in which the force does the work that is needed.
        let stiffness = Complex64::new(w2 - square, 2.0 * d * self.omega * omega);
        let phase = self.work / stiffness;
        let turn = if phase.norm() > 0.0 {
            phase / phase.norm()
        } else {
            Complex64::ONE
        };
        Some(SynthesisPoint {
            omega,
            response: self.response * turn,
            modal_amplitude: self.square.sqrt(),
            natural_omega: self.omega,
            damping_ratio: d,
        })
    }

    fn at_peak(&self) -> SynthesisPoint {
        self.at(0.0).unwrap_or(SynthesisPoint {
            omega: 0.0,
            response: self.response,
            modal_amplitude: self.square.sqrt(),
            natural_omega: self.omega,
            damping_ratio: self.damping,
        })
    }
}

/// Both flanks of the response.
fn flanks(states: &[State]) -> Result<Vec<SynthesisPoint>> {
    let mut points = Vec::new();
    let lower = states.iter().map(|s| s.spread().and_then(|r| s.at(-r)));
    let upper = states.iter().rev().map(|s| s.spread().and_then(|r| s.at(r)));
    for point in lower.chain(upper).flatten() {
        try_push(&mut points, point, WHAT)?;
    }
    Ok(points)
}

/// Solves the mode between two points of its branch.
struct Refinement<'a> {
    branch: &'a Branch,
    data: &'a ModeData,
    load: &'a Load,
    problem: Mode<'a>,
    locator: Locator,
    at: Linearisation,
    x: Vec<Complex64>,
}

impl<'a> Refinement<'a> {
    fn new(branch: &'a Branch, data: &'a ModeData, load: &'a Load) -> Result<Self> {
        let problem = Mode::new(branch.condensed(), &data.gauge, &data.linear, branch.samples())?;
        let n = problem.size();
        let settings = Settings {
            start: data.range.0,
            end: data.range.1,
            tolerance: 1e-10,
            max_iterations: 25,
            steps: StepControl::new(0.0, 0.0, 0.0),
        };
        Ok(Self {
            branch,
            data,
            load,
            at: Linearisation::new(n)?,
            locator: Locator::new(n, settings)?,
            x: try_vec(branch.ndof(), Complex64::ZERO, WHAT)?,
            problem,
        })
    }

    /// The state without excess between points k and k + 1, whose excesses are given, by the
    /// Illinois variant of regula falsi in log₁₀ a.
    fn between(&mut self, k: usize, first: f64, last: f64) -> Result<Option<State>> {
        let (Some(a), Some(b)) = (self.point(k)?, self.point(k + 1)?) else {
            return Ok(None);
        };
        let (mut low, mut high) = ((a.parameter(), first), (b.parameter(), last));
        let mut side = 0;
        let mut found = None;
        for _ in 0..MAX_EVALUATIONS {
            let p = (low.0 * high.1 - high.0 * low.1) / (high.1 - low.1);
            let p = if p.is_finite() { p } else { 0.5 * (low.0 + high.0) };
            let Some(state) = self.solve(&a, &b, p)? else { break };
            let f = state.excess();
            found = Some(state);
            if f == 0.0 || (high.0 - low.0).abs() <= WIDTH || f.abs() <= WIDTH * state.work.norm() {
                break;
            }
            if (f < 0.0) == (low.1 < 0.0) {
                low = (p, f);
                if side == -1 {
                    high.1 *= 0.5;
                }
                side = -1;
            } else {
                high = (p, f);
                if side == 1 {
                    low.1 *= 0.5;
                }
                side = 1;
            }
        }
        Ok(found)
    }

    /// A point of the curve as the continuation left it.
    fn point(&self, k: usize) -> Result<Option<Point>> {
        let Some((v, tangent)) = self.data.state(k) else {
            return Ok(None);
        };
        Ok(Some(Point {
            v: try_copy(v, WHAT)?,
            tangent: try_copy(tangent, WHAT)?,
            amplitude: Complex64::ZERO,
            slope: Complex64::ZERO,
            residual: 0.0,
            iterations: 0,
            step: 0.0,
            stalled: false,
            positive: true,
        }))
    }

    fn solve(&mut self, a: &Point, b: &Point, p: f64) -> Result<Option<State>> {
        let n = self.problem.size();
        let mut v = try_copy(&a.v, WHAT)?;
        if p <= self.data.info.linear_up_to {
            v[n] = p;
        } else if let Some(point) = self.locator.at_parameter(&mut self.problem, a, b, p)? {
            v = point.v;
        } else {
            return Ok(None);
        }
        self.problem.evaluate(&v[..n], p, &mut self.at)?;
        let (omega, damping_ratio) = Mode::frequency_and_damping(&self.data.linear, &v[..n]);
        let unit = 10f64.powf(p) * self.branch.condensed().length();
        let dofs = self.branch.ndof();
        let i = self.branch.carried().iter().position(|&h| h == 1).unwrap_or(0);
        let shape = &self.problem.shape()[i * dofs..(i + 1) * dofs];
        self.branch.condensed().blocks()[i].multiply_mass(shape, &mut self.x);
        let size: f64 = shape.iter().zip(&self.x).map(|(a, b)| (a.conj() * b).re).sum();
        let energy = balance(self.branch.condensed(), omega, self.problem.shape(), &[], &[]).twice_mean_kinetic;
        let point = ModePoint {
            log10_amplitude: p,
            modal_amplitude: unit * size.sqrt(),
            damping_ratio,
            fundamental_share: 0.5 * omega * omega * size / energy,
            ..ModePoint::default()
        };
        for (to, from) in self.x.iter_mut().zip(shape) {
            *to = from * unit;
        }
        self.load.state(omega, Some(&point), &self.x).map(Some)
    }
}

fn validity(branch: &Branch, data: &ModeData, state: &State) -> Validity {
    let info = &data.info;
    let omega = state.omega;
    let bandwidth = 2.0 * state.damping.abs() * omega;
    let mut distance = f64::INFINITY;
    for (j, &stuck) in info.stuck.iter().enumerate().filter(|(j, _)| *j != info.index) {
        // A mode of which nothing slips lies at its stuck frequency, else somewhere below.
        let free = info.free.get(j).copied().unwrap_or(stuck);
        let (low, high) = (stuck.min(free), stuck.max(free));
        distance = distance.min((low - omega).max(omega - high).max(0.0));
    }
    let folds = branch.folds().iter().filter_map(|f| branch.mode_at(f.point));
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for fold in folds {
        low = low.min(fold.log10_amplitude);
        high = high.max(fold.log10_amplitude);
    }
    Validity {
        other_mode: if distance == 0.0 { 0.0 } else { distance / bandwidth },
        fundamental_share: state.fundamental_share,
        repeated: info.multiplicity > 1,
        folded: low <= state.log10 && state.log10 <= high,
    }
}
