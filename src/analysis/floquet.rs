//! Floquet multipliers of a stored point, by the variational equations along the motion in time.

use crate::analysis::verify::check_model;
use crate::contact::time_piece::Grazing;
use crate::error::{Error, Result, Status, fail, try_extend};
use crate::hooks::{Hooks, LogLevel};
use crate::interrupt::Interrupt;
use crate::model::Model;
use crate::options::{FloquetOptions, TimeOptions};
use crate::results::{Branch, Multiplier, MultiplierClass, Recovery, UNIT};
use crate::stability::{Blocks, Closure, Known, closures, multipliers_of};
use crate::time_integration::{EventLoop, HarmonicAnalysis, Observers, Search, State, System, state_of};
use num_complex::Complex64;

/// Largest |D| of a point of a nonlinear mode that counts as a limit cycle.
const LIMIT_CYCLE: f64 = 1e-7;

/// Largest difference of opposite sectors, relative to the motion, of a motion that is odd.
const ODD: f64 = 1e-9;

/// Stability of a periodic motion.
#[derive(Clone, Debug)]
pub struct Floquet {
    /// `Ok` or `StoppedByCaller`; then there are no multipliers.
    pub status: Status,
    /// Multipliers of one period by falling modulus. All ordinary ones are NaN where the motion touches an event.
    pub multipliers: Vec<Multiplier>,
    /// Largest modulus of the ordinary ones; NaN where the motion touches an event.
    pub radius: f64,
    /// Number of ordinary multipliers outside the unit circle.
    pub unstable: usize,
    /// Number of multipliers that are 1 by construction, the trivial one of an autonomous motion not among them.
    pub neutral: usize,
    /// Angular frequency of the motion, that of the point unless no force drives it.
    pub omega: f64,
    /// Distance of the motion from that of the point, relative to it, in the harmonics 0 .. H of the branch; 0 without
    /// shooting.
    pub orbit_change: f64,
    /// Largest change of the motion over a period, relative to the largest displacement and velocity.
    pub residual: f64,
    /// The contact that touches an event, and the event: derivatives differ on its two sides.
    pub grazing: Option<(usize, Grazing)>,
}

/// Computes the Floquet multipliers of a stored point: the factors by which small perturbations of its motion grow in
/// one period. `model` is the one that the branch was computed with. The point is not changed.
///
/// The monodromy matrix is exact: the variational equations are integrated along the exact path from event to event,
/// and sliders that slip pass on what they remember of the motion. All laws that [`time_response`](crate::time_response)
/// supports are supported. A point of a nonlinear mode must be a limit cycle, damping ratio zero.
///
/// # Errors
/// `Index` for an unknown point, `Argument` for another model than that of the branch or bad options, `Unsupported`
/// for a point of a mode that is no limit cycle, and for what `time_response` does not support; `NoConvergence` if
/// shooting does not converge from the point; `NoBoundedSolution`, `Callback`, `OutOfMemory`.
pub fn floquet(
    model: &Model,
    branch: &Branch,
    point: usize,
    options: &FloquetOptions,
    hooks: &mut Hooks<'_>,
) -> Result<Floquet> {
    options.check()?;
    branch.check_one_model()?;
    check_model(model, branch)?;
    model.check_matrices(false)?;
    let Some(omega) = branch.omega_at(point) else {
        return fail!(
            Index,
            "point = {point}, needs 0 .. {} (points and special points)",
            branch.stored()
        );
    };
    if let Some(mode) = branch.mode_at(point)
        && mode.damping_ratio.abs() > LIMIT_CYCLE
    {
        return fail!(
            Unsupported,
            "point = {point} of a nonlinear mode has the damping ratio {:.3e}: only artificial damping keeps its motion periodic; take a point where it is zero, a limit cycle",
            mode.damping_ratio
        );
    }
    let interrupt = hooks.interrupt();
    let mut found = || -> Result<Floquet> {
        let harmonics = Recovery::at(branch, point, &interrupt)?.all(branch.harmonics())?;
        let motion = Motion {
            omega,
            harmonics: &harmonics,
            autonomous: branch.mode().is_some(),
            compared: true,
        };
        Ok(floquet_of(model, &motion, options, hooks, &interrupt)?.stability)
    };
    match found() {
        Err(e) if e.status == Status::StoppedByCaller => Ok(Floquet::stopped(omega)),
        outcome => outcome,
    }
}

impl Floquet {
    fn stopped(omega: f64) -> Self {
        Self {
            status: Status::StoppedByCaller,
            multipliers: Vec::new(),
            radius: f64::NAN,
            unstable: 0,
            neutral: 0,
            omega,
            orbit_change: f64::NAN,
            residual: f64::INFINITY,
            grazing: None,
        }
    }

    /// The multipliers sorted, with the numbers that follow from them.
    fn of(mut multipliers: Vec<Multiplier>, grazing: Option<(usize, Grazing)>) -> Self {
        if grazing.is_some() {
            for m in multipliers.iter_mut().filter(|m| m.class == MultiplierClass::Ordinary) {
                m.value = Complex64::new(f64::NAN, f64::NAN);
            }
        }
        multipliers.sort_by(|a, b| b.value.norm().total_cmp(&a.value.norm()));
        let ordinary = || multipliers.iter().filter(|m| m.class == MultiplierClass::Ordinary);
        let neutral =
            |m: &&Multiplier| matches!(m.class, MultiplierClass::NeutralStuck | MultiplierClass::NeutralRigid);
        let radius = ordinary().fold(0.0_f64, |r, m| r.max(m.value.norm()));
        Self {
            status: Status::Ok,
            radius: if grazing.is_some() { f64::NAN } else { radius },
            unstable: ordinary().filter(|m| m.value.norm() > UNIT).count(),
            neutral: multipliers.iter().filter(neutral).count(),
            multipliers,
            omega: 0.0,
            orbit_change: 0.0,
            residual: 0.0,
            grazing,
        }
    }
}

/// A periodic motion by its harmonics 0 … H in the caller's unit and numbering.
pub(super) struct Motion<'a> {
    pub omega: f64,
    pub harmonics: &'a [Complex64],
    /// Whether no force drives it.
    pub autonomous: bool,
    /// Whether the motion in time is compared with the harmonics.
    pub compared: bool,
}

/// Stability of a motion.
pub(super) struct Found {
    pub stability: Floquet,
    /// Distance of the initial state of the motion in time from that of the harmonics, relative to it.
    pub shift: f64,
}

/// The multipliers of a motion; `StoppedByCaller` is an error.
pub(super) fn floquet_of(
    model: &Model,
    motion: &Motion<'_>,
    options: &FloquetOptions,
    hooks: &mut Hooks<'_>,
    interrupt: &Interrupt<'_>,
) -> Result<Found> {
    let mut system = if motion.autonomous {
        System::unforced(model, motion.omega, interrupt)?
    } else {
        System::new(model, motion.omega, interrupt)?
    };
    let mut event_loop = EventLoop::new(&system, options.tolerance)?;
    let mut state = state_of(model, &system, motion.harmonics)?;
    let (mut residual, mut shift) = (f64::NAN, 0.0);
    if options.refine {
        let in_time = TimeOptions {
            omega: motion.omega,
            tolerance: options.tolerance,
            max_periods: options.max_periods,
            ..TimeOptions::default()
        };
        let start = state.try_clone()?;
        let mut search = Search::new(&mut system, &mut event_loop, &in_time, hooks, state)?;
        if motion.autonomous {
            search = search.free_frequency();
        }
        let Some(steady) = search.closest()? else {
            return fail!(
                NoConvergence,
                "shooting did not converge from the point: it has too few harmonics; solve it with more, or set refine to false"
            );
        };
        if steady.status == Status::StoppedByCaller {
            return Err(Error::new(
                steady.status,
                format_args!("the caller stopped the shooting"),
            ));
        }
        residual = steady.residual;
        state = steady.state;
        shift = start.distance(&state, system.omega);
        hooks.log(LogLevel::Info, "the motion whose perturbations are integrated is found");
    }
    let closures = closures(model.structure(), options.waves, is_odd(&system, &state))?;
    let mut recorder = if options.refine && motion.compared {
        let highest = motion.harmonics.len() / model.ndof() - 1;
        Some(HarmonicAnalysis::new(&system, highest, 0)?)
    } else {
        None
    };
    let mut stability = through_a_lapse(
        model,
        &mut system,
        &mut event_loop,
        state,
        (&closures, motion.autonomous),
        recorder.as_mut(),
    )?;
    stability.omega = system.omega;
    stability.residual = residual;
    if let Some(recorder) = recorder {
        stability.orbit_change = distance(motion.harmonics, &recorder.of_all_degrees(&system, model)?);
    }
    Ok(Found { stability, shift })
}

/// Carries all perturbations through a lapse of the motion.
fn through_a_lapse(
    model: &Model,
    system: &mut System<'_>,
    event_loop: &mut EventLoop,
    mut state: State,
    (closures, autonomous): (&[Closure], bool),
    recorder: Option<&mut HarmonicAnalysis>,
) -> Result<Floquet> {
    let structure = model.structure();
    let mut velocities = Vec::new();
    try_extend(&mut velocities, &state.v, "the rates of the motion")?;
    let rates = if autonomous {
        Some(event_loop.rates(system, &state)?)
    } else {
        None
    };
    let mut blocks = Blocks::new(structure, system, closures)?;
    event_loop.clear_moved();
    let observers = Observers {
        recorder,
        variation: Some(&mut blocks),
        ..Observers::default()
    };
    event_loop.run(system, &mut state, observers)?;
    let moved = |i: usize| {
        let family = system.elements[i].family;
        let same = system.elements.iter().zip(&event_loop.moved);
        same.into_iter().any(|(e, &moved)| moved && e.family == family)
    };
    let known = Known {
        moved: &moved,
        rates: rates.as_ref().map(|(a, w)| (&velocities[..], &a[..], &w[..])),
    };
    let mut all = Vec::new();
    for block in &blocks.list {
        try_extend(
            &mut all,
            &multipliers_of(structure, system, block, &known)?,
            "the Floquet multipliers",
        )?;
    }
    let grazing = blocks.grazing.map(|(i, event)| (system.elements[i].family, event));
    Ok(Floquet::of(all, grazing))
}

/// Whether sectors half a wave apart move opposite to each other.
fn is_odd(system: &System<'_>, state: &State) -> bool {
    if !system.sectors.is_multiple_of(2) {
        return false;
    }
    let half = system.sectors / 2;
    let opposite = |values: &[f64], block: usize| {
        let largest = values.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        let group = block * system.sectors;
        values.chunks_exact(group).all(|ring| {
            let (first, second) = ring.split_at(half * block);
            first.iter().zip(second).all(|(a, b)| (a + b).abs() <= ODD * largest)
        })
    };
    opposite(&state.x, system.ndof) && opposite(&state.v, system.ndof) && opposite(&state.e, 1)
}

/// Distance of two motions, relative to the first, both by their harmonics.
fn distance(x: &[Complex64], y: &[Complex64]) -> f64 {
    let gap: f64 = x.iter().zip(y).map(|(x, y)| (x - y).norm_sqr()).sum();
    let size: f64 = x.iter().map(Complex64::norm_sqr).sum();
    if gap == 0.0 { 0.0 } else { (gap / size).sqrt() }
}
