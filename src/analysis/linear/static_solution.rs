//! The static state of a model under constant forces and preload, from which a nonlinear mode starts.

use crate::aft::{Evaluation, Evaluator};
use crate::condense::Condensed;
use crate::condense::by_factors::flexibility::Workspace;
use crate::condense::by_factors::near_rigid_motion;
use crate::contact::{Contact, Form, Role};
use crate::continuation::Settings;
use crate::continuation::initial_point;
use crate::continuation::step_control::StepControl;
use crate::error::{Error, Result, Status, fail, try_vec};
use crate::fourier::HarmonicSet;
use crate::harmonics::allow_point;
use crate::interrupt::{Interrupt, Phase};
use crate::linalg::norm;
use crate::model::Model;
use crate::model::excitation::Force;
use crate::model::matrices::speed::Speed;
use crate::model::matrices::structure::MatrixKind;
use crate::model::natural_modes::static_tangents::StaticTangents;
use crate::options::SolverOptions;
use crate::problem::harmonic_balance::HarmonicBalance;
use crate::problem::static_force::static_force;
use crate::problem::static_state::StaticState;
use crate::problem::{Problem, Residual};
use num_complex::Complex64;

const CONTEXT: &str = "the static state";

/// Why a nonlinear mode is refused whose static state changes with the frequency.
pub(crate) const NEEDS_SPEED: &str = "a nonlinear mode about it needs one speed";

/// Tolerance of the residual: an error of the static state is one of every amplitude.
/// Kind: rounding.
const STATIC_SOLUTION_TOLERANCE: f64 = 1e-13;

/// Residual at zero, relative to the motion under the forces with linear contacts, at which zero is the solution.
/// Kind: rounding.
const BALANCED: f64 = 1e-12;

/// Angular frequency that laws are told; nothing moves, so that none has an effect.
/// Kind: fixed.
const OMEGA: f64 = 1.0;

/// The static state of a model; zero motion if nothing loads it. `needs_speed` names the analysis that needs one
/// speed, for the error.
///
/// # Errors
/// `Unsupported` where the state depends on a speed that follows the frequency; `NoConvergence` or `Singular` if there is no
/// equilibrium; those of callbacks; `OutOfMemory`; `StoppedByCaller`.
pub(crate) fn static_state(
    model: &Model,
    solver: &SolverOptions,
    needs_speed: &str,
    interrupt: &Interrupt<'_>,
) -> Result<StaticState> {
    let degrees = model.structure().degrees();
    let constant = |f: &Force| f.harmonic == 0 && f.value.re != 0.0 && !degrees.is_fixed(f.dof);
    let loaded = model.excitation().forces().iter().any(constant) || model.contacts().iter().any(Contact::is_preloaded);
    if !loaded && !needs_evaluation(model)? {
        return Ok(StaticState::default());
    }
    // Gyroscopic forces need a velocity, which a static state has not.
    let follows = matches!(model.speed(), Speed::PerOmega(p) if p != 0.0)
        && (model.structure().has(MatrixKind::StiffnessSpeed2)
            || !model.speed_loads().is_empty()
            || model.excitation().has_centrifugal());
    let refused = || -> Result<StaticState> {
        fail!(
            Unsupported,
            "the speed follows the frequency, and with stiffness_speed2 or the loads of contacts the static state does: \
             {needs_speed}; set a fixed speed"
        )
    };
    if loaded && follows {
        return refused();
    }
    let condensed = Condensed::for_static(model, solver, interrupt)?;
    allow_point(solver.memory_limit, &condensed, 0, solver.samples)?;
    if condensed.coordinates() == 0
        || (!loaded && static_force(&condensed, OMEGA, solver.samples, interrupt)?.is_none())
    {
        return Ok(StaticState::default());
    }
    if follows {
        return refused();
    }
    interrupt.phase(Phase::FirstPoint, 0.0)?;
    solve(model, &condensed, solver, interrupt)
}

/// The static motion of the independent degrees of freedom under constant forces, for a structure whose contacts are
/// springs or none, from linear equations. Zeros where a law must be evaluated: [`static_state`] has the motion then.
///
/// # Errors
/// `Singular` where the structure does not hold the forces; `OutOfMemory`; `StoppedByCaller`.
pub(crate) fn linear_static_motion(
    model: &Model,
    solver: &SolverOptions,
    interrupt: &Interrupt<'_>,
) -> Result<Vec<f64>> {
    let mut motion = try_vec(model.structure().degrees().independent(), 0.0, CONTEXT)?;
    if !model.excitation().forces().iter().any(|f| f.harmonic == 0) {
        return Ok(motion);
    }
    let condensed = Condensed::for_static(model, solver, interrupt)?;
    if condensed.coordinates() > 0 {
        return Ok(motion);
    }
    let mut x = try_vec(condensed.ndof(), Complex64::ZERO, CONTEXT)?;
    let mut workspace = Workspace::new(&condensed, None)?;
    workspace
        .recover(&condensed, 0, OMEGA, &[], &mut x, interrupt)
        .map_err(|e| explained(e, solver))?;
    for (to, x) in motion.iter_mut().zip(&x) {
        *to = x.re * condensed.length();
    }
    Ok(motion)
}

/// Whether the static force of some law follows from its evaluation alone.
fn needs_evaluation(model: &Model) -> Result<bool> {
    for contact in model.contacts() {
        if contact.role() == Role::Active
            && matches!(contact.law(1.0)?.form(), Form::Memoryless(_) | Form::Hysteretic(_))
        {
            return Ok(true);
        }
    }
    Ok(false)
}

fn solve(
    model: &Model,
    condensed: &Condensed,
    solver: &SolverOptions,
    interrupt: &Interrupt<'_>,
) -> Result<StaticState> {
    let mut problem = HarmonicBalance::new(condensed, 0, OMEGA.into(), solver.samples, None, interrupt)?;
    let settings = Settings {
        start: OMEGA,
        end: OMEGA,
        tolerance: STATIC_SOLUTION_TOLERANCE,
        max_iterations: solver.max_newton,
        steps: StepControl::new(solver.step, solver.step_min, solver.step_max),
    };
    let n = condensed.unknowns();
    let mut at = Residual::new(n)?;
    let mut u = try_vec(n, 0.0, CONTEXT)?;
    problem.evaluate(&u, OMEGA, &mut at)?;
    // Constant forces may balance the preload at zero, to which no motion is small.
    if norm(&at.values) > BALANCED * at.scale {
        let first = initial_point::solve(&mut problem, &settings, interrupt).map_err(|e| explained(e, solver))?;
        u.copy_from_slice(first.point.unknowns());
        problem.evaluate(&u, OMEGA, &mut at)?;
    }
    let u = &u[..];
    let coordinates = condensed.coordinates();
    let mut w = try_vec(coordinates, Complex64::ZERO, CONTEXT)?;
    let mut x = try_vec(condensed.ndof(), Complex64::ZERO, CONTEXT)?;
    problem.contact_force(u, 0, &mut w);
    let mut workspace = Workspace::new(condensed, None)?;
    workspace.recover(condensed, 0, OMEGA, &w, &mut x, interrupt)?;
    for (y, u) in w.iter_mut().zip(u) {
        *y = (*u).into();
    }
    near_rigid_motion::correct(&mut workspace, condensed, (0, OMEGA), &w, &mut x, interrupt)?;
    let mut motion = try_vec(coordinates, 0.0, CONTEXT)?;
    for (y, u) in motion.iter_mut().zip(u) {
        *y = u * condensed.length();
    }
    let mut structure = try_vec(condensed.ndof(), 0.0, CONTEXT)?;
    for (to, x) in structure.iter_mut().zip(&x) {
        *to = x.re * condensed.length();
    }
    Ok(StaticState {
        motion,
        structure,
        tangents: tangents(model, condensed, u, solver.samples, interrupt)?,
    })
}

/// Tangent stiffness of each law at the static motion `rest`: the fundamental of the force per fundamental of the
/// motion, without its part in quadrature.
fn tangents(
    model: &Model,
    condensed: &Condensed,
    rest: &[f64],
    samples: usize,
    interrupt: &Interrupt<'_>,
) -> Result<StaticTangents> {
    let set = HarmonicSet::all(1)?;
    let m = set.packed_len();
    let laws = || condensed.laws().iter().map(|assembled| &*assembled.law);
    let mut evaluator = Evaluator::new(&set, samples, laws())?;
    let mut tangents = StaticTangents::new(model.contacts().len())?;
    for assembled in condensed.laws() {
        interrupt.check()?;
        let d = assembled.law.directions();
        let mut motion = try_vec(d * m, 0.0, CONTEXT)?;
        for (y, &c) in motion.iter_mut().step_by(m).zip(&assembled.coordinates) {
            *y = rest[c];
        }
        let mut found = Evaluation::new(&set, d)?;
        if d == 1 {
            evaluator.prepare(&set, &motion, interrupt)?;
        }
        evaluator
            .evaluate(&*assembled.law, &set, &motion, OMEGA, &mut found, interrupt)
            .map_err(|e| e.at(format_args!("contact {}", assembled.contact)))?;
        let by = |force: usize, motion: usize| found.jacobian[motion * d * m + force];
        let mut tangent = try_vec(d * d, 0.0, CONTEXT)?;
        for (i, t) in tangent.iter_mut().enumerate() {
            let (k, l) = (i / d * m, i % d * m);
            *t = 0.5 * (by(k + 1, l + 1) + by(k + 2, l + 2));
        }
        tangents.set(assembled.contact, &tangent)?;
    }
    Ok(tangents)
}

fn explained(e: Error, solver: &SolverOptions) -> Error {
    match e.status {
        Status::NoConvergence | Status::Singular => Error::new(
            e.status,
            format_args!(
                "no static state under constant forces and preload was found: structure and contacts may not hold them, \
                 or max_newton = {} is too few",
                solver.max_newton
            ),
        ),
        _ => e,
    }
}
