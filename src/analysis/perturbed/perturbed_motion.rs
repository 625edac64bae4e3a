//! Perturbations of one periodic motion: shooting from a harmonic motion, and the Floquet multipliers of the motion found.

use crate::error::{Error, Result, Status, fail, try_extend, try_vec};
use crate::hooks::{Hooks, LogLevel};
use crate::interrupt::Interrupt;
use crate::model::Model;
use crate::model::few_motions::on_modes::OnModes;
use crate::model::matrices::structure::Structure;
use crate::options::{FloquetOptions, TimeOptions};
use crate::results::Floquet;
use crate::stability::{Blocks, Closure, Known, closures, multipliers_of};
use crate::time_integration::{EventLoop, HarmonicAnalysis, Observers, State, Steady, SteadySearch, System};
use crate::time_integration::{check_shooting, state_of, state_of_sector};
use num_complex::Complex64;

const CONTEXT: &str = "the motion in time";

/// Distance of the motion in time from its point, relative to it, above which it may be another motion.
/// Kind: tuned; measured on: not recorded.
pub(crate) const FAR: f64 = 0.2;

/// Distance of a motion in time from a point, over that of the begin of its search, up to which it is taken for the point's own.
/// Kind: tuned; measured on: 3,323 points of 420 random sweeps with stops, tables, cubic springs and friction: 2 leaves two wrong
/// verdicts that 1.2 does not.
const OWN_MOTION_WITHIN: f64 = 1.2;

/// Largest difference of opposite sectors, relative to the motion, of a motion that is odd.
/// Kind: rounding.
pub(crate) const ODD: f64 = 1e-9;

/// A periodic motion by its harmonics 0 … H in the caller's unit and numbering.
pub(crate) struct Motion<'a> {
    pub omega: f64,
    pub harmonics: &'a [Complex64],
    /// Whether the motion is free, without a force.
    pub autonomous: bool,
    /// Whether the motion in time is compared with these harmonics.
    pub compared: bool,
    /// The motion with more harmonics, as the start of shooting; `None`: from these.
    pub fine: Option<&'a [Complex64]>,
    /// Difference between the states in time and by harmonics at a neighbouring point, with which shooting begins
    /// where `fine` is `None`.
    pub difference: Option<&'a State>,
    /// Whether shooting ends at its tolerance and does not go on to round-off.
    pub quick: bool,
}

/// Stability of a motion.
pub(crate) struct Found {
    pub stability: Floquet,
    /// Distance between the initial states in time and by harmonics, relative to the latter.
    pub shift: f64,
    /// Difference between the initial states in time and by harmonics.
    pub difference: Option<State>,
}

/// A model whose motion is integrated, on all its degrees of freedom or on modes.
pub(crate) struct Subject<'a> {
    pub model: &'a Model,
    pub on_modes: Option<&'a OnModes>,
}

impl Subject<'_> {
    fn structure(&self) -> &Structure {
        self.on_modes.map_or(self.model, |on_modes| &on_modes.model).structure()
    }

    /// The equations of motion under the forces of the model, unless no force drives the motion.
    fn system<'s>(&self, motion: &Motion<'_>, interrupt: &'s Interrupt<'s>) -> Result<System<'s>> {
        match self.on_modes {
            None if motion.autonomous => System::unforced(self.model, motion.omega, interrupt),
            None => System::new(self.model, motion.omega, interrupt),
            Some(on_modes) => {
                let mut system = System::unforced(&on_modes.model, motion.omega, interrupt)?;
                if !motion.autonomous {
                    for (harmonic, force) in on_modes.forces(&*self.model.at_frequency(motion.omega)?)? {
                        system.add_forces(on_modes.model.structure(), harmonic, &force)?;
                    }
                }
                Ok(system)
            }
        }
    }

    /// Whether forces and laws allow a motion in which sectors half a wave apart move opposite to each other.
    fn allows_halves(&self, system: &System<'_>) -> Result<bool> {
        if !system.wave.sectors.is_multiple_of(2) || system.loads.iter().any(|load| load.harmonic.is_multiple_of(2)) {
            return Ok(false);
        }
        for contact in self.on_modes.map_or(self.model, |on_modes| &on_modes.model).contacts() {
            if !contact.law(1.0)?.is_odd() {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// The state of the motion at time 0; on modes, the nearest state that these can represent.
    fn state(&self, system: &System<'_>, harmonics: &[Complex64]) -> Result<State> {
        let Some(on_modes) = self.on_modes else {
            return state_of(self.model, system, harmonics);
        };
        let degrees = self.model.structure().degrees();
        let (given, n) = (degrees.given(), degrees.independent());
        let mut independent = try_vec(harmonics.len() / given * n, Complex64::ZERO, CONTEXT)?;
        for (x, all) in independent.chunks_exact_mut(n).zip(harmonics.chunks_exact(given)) {
            degrees.restrict(all, x);
        }
        state_of_sector(&on_modes.model, system, &on_modes.coordinates(n, &independent)?)
    }

    /// The harmonics of all degrees of freedom.
    fn harmonics(&self, recorder: HarmonicAnalysis, system: &System<'_>) -> Result<Vec<Complex64>> {
        let Some(on_modes) = self.on_modes else {
            return recorder.of_all_degrees(system, self.model);
        };
        let structure = self.model.structure();
        let degrees = structure.degrees();
        let (given, n) = (degrees.given(), degrees.independent());
        let independent = on_modes.motion(n, &recorder.of_independent(system)?)?;
        let mut all = try_vec(independent.len() / n * given, Complex64::ZERO, CONTEXT)?;
        let rows = all.chunks_exact_mut(given).zip(independent.chunks_exact(n));
        for (h, (all, x)) in rows.enumerate() {
            degrees.expand(structure.phase(h, 1), x, all);
        }
        Ok(all)
    }
}

/// Floquet multipliers of a motion; `StoppedByCaller` is an error.
pub(crate) fn perturbed(
    subject: &Subject<'_>,
    motion: &Motion<'_>,
    options: &FloquetOptions,
    hooks: &mut Hooks<'_>,
    interrupt: &Interrupt<'_>,
) -> Result<Found> {
    if options.refine {
        // Half the sectors may do.
        let structure = subject.structure();
        check_shooting(structure.ndof() * structure.repeating_sectors().div_ceil(2))?;
    }
    let mut system = subject.system(motion, interrupt)?;
    let mut event_loop = EventLoop::new(&system, options.tolerance)?;
    let mut state = subject.state(&system, motion.harmonics)?;
    let (mut residual, mut shift, mut difference) = (f64::NAN, 0.0, None);
    if options.refine {
        let in_time = TimeOptions {
            omega: motion.omega,
            tolerance: options.tolerance,
            max_periods: options.max_periods,
            ..TimeOptions::default()
        };
        let start = state.try_clone()?;
        let found = steady_near(&mut system, &mut event_loop, subject, motion, &in_time, hooks, &start)?;
        let Some(steady) = found else {
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
        let mut moved = state.try_clone()?;
        moved.add(-1.0, &start);
        difference = Some(moved);
        hooks.log(LogLevel::Info, "the motion whose perturbations are integrated is found");
    }
    let odd = is_odd(&system, &state) && has_odd_laws(subject.model)?;
    let closures = closures(subject.structure(), options.waves, odd)?;
    let mut recorder = if options.refine && motion.compared {
        let highest = motion.harmonics.len() / subject.model.ndof() - 1;
        Some(HarmonicAnalysis::new(&system, highest, 0)?)
    } else {
        None
    };
    let mut stability = through_a_lapse(
        subject.structure(),
        &mut system,
        &mut event_loop,
        state,
        (&closures, motion.autonomous),
        recorder.as_mut(),
    )?;
    stability.omega = system.omega;
    stability.residual = residual;
    if let Some(recorder) = recorder {
        stability.orbit_change = distance(motion.harmonics, &subject.harmonics(recorder, &system)?);
    }
    Ok(Found {
        stability,
        shift,
        difference,
    })
}

/// The periodic motion that a point stands for, by shooting: from the motion with more harmonics or with the difference found at a
/// neighbouring point first, then from the harmonics as they are.
///
/// Beside a fold two motions are near a point, and the difference of a neighbour before the fold leads to the other one. A motion
/// further from the point than its begin was, by [`OWN_MOTION_WITHIN`], is compared with the one that the harmonics lead to: the
/// nearer one counts.
fn steady_near(
    system: &mut System<'_>,
    event_loop: &mut EventLoop,
    subject: &Subject<'_>,
    motion: &Motion<'_>,
    options: &TimeOptions<'_>,
    hooks: &mut Hooks<'_>,
    start: &State,
) -> Result<Option<Steady>> {
    let mut first = None;
    if let Some(begin) = nearest(subject, system, motion, start)? {
        let expected = start.distance(&begin, motion.omega);
        first = shoot((system, event_loop), subject, motion, (options, hooks), begin)?;
        if let Some(steady) = &first
            && (steady.status == Status::StoppedByCaller
                || start.distance(&steady.state, motion.omega) <= OWN_MOTION_WITHIN * expected)
        {
            return Ok(first);
        }
    }
    let second = shoot(
        (system, event_loop),
        subject,
        motion,
        (options, hooks),
        start.try_clone()?,
    )?;
    Ok(match (first, second) {
        (Some(first), Some(second)) => {
            let is_nearer = |a: &Steady, b: &Steady| {
                start.distance(&a.state, motion.omega) < start.distance(&b.state, motion.omega)
            };
            let keep = second.status != Status::StoppedByCaller && is_nearer(&first, &second);
            Some(if keep { first } else { second })
        }
        (first, second) => second.or(first),
    })
}

/// A state that is nearer to the motion in time than the state by its harmonics; `None` where none is known.
fn nearest(subject: &Subject<'_>, system: &System<'_>, motion: &Motion<'_>, start: &State) -> Result<Option<State>> {
    if let Some(fine) = motion.fine {
        return subject.state(system, fine).map(Some);
    }
    let Some(difference) = motion.difference.filter(|near| near.len() == start.len()) else {
        return Ok(None);
    };
    let mut begin = start.try_clone()?;
    begin.add(1.0, difference);
    Ok(Some(begin))
}

/// Shoots for a periodic motion from a state; in half the sectors only where the others move opposite to these.
fn shoot(
    (system, event_loop): (&mut System<'_>, &mut EventLoop),
    subject: &Subject<'_>,
    motion: &Motion<'_>,
    (options, hooks): (&TimeOptions<'_>, &mut Hooks<'_>),
    mut state: State,
) -> Result<Option<Steady>> {
    let halves = !motion.autonomous && subject.allows_halves(system)? && {
        let mut mirrored = state.try_clone()?;
        mirrored.unfold(&state.fold(system)?, system);
        state.distance(&mirrored, system.omega) <= ODD
    };
    if halves {
        let mut half = system.folded()?;
        let mut in_half = EventLoop::new(&half, options.tolerance)?;
        let start = state.fold(system)?;
        let mut search = SteadySearch::new(&mut half, &mut in_half, options, hooks, start)?;
        if motion.quick {
            search = search.quick();
        }
        let found = search.closest()?;
        return Ok(found.map(|mut steady| {
            state.unfold(&steady.state, system);
            steady.state = state;
            steady
        }));
    }
    let mut search = SteadySearch::new(system, event_loop, options, hooks, state)?;
    if motion.autonomous {
        search = search.free_frequency();
    }
    if motion.quick {
        search = search.quick();
    }
    search.closest()
}

/// Carries all perturbations through a lapse of the motion.
fn through_a_lapse(
    structure: &Structure,
    system: &mut System<'_>,
    event_loop: &mut EventLoop,
    mut state: State,
    (closures, autonomous): (&[Closure], bool),
    recorder: Option<&mut HarmonicAnalysis>,
) -> Result<Floquet> {
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
        largest: None,
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

/// Whether, in a state, sectors half a wave apart move opposite to each other.
fn is_odd(system: &System<'_>, state: &State) -> bool {
    if !system.wave.sectors.is_multiple_of(2) {
        return false;
    }
    let half = system.wave.sectors / 2;
    let opposite = |values: &[f64], block: usize| {
        let largest = values.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        let group = block * system.wave.sectors;
        values.chunks_exact(group).all(|ring| {
            let (first, second) = ring.split_at(half * block);
            first.iter().zip(second).all(|(a, b)| (a + b).abs() <= ODD * largest)
        })
    };
    opposite(&state.x, system.ndof) && opposite(&state.v, system.ndof) && opposite(&state.e, 1)
}

/// Whether forces change their sign with the motion: only then perturbations of opposite motions obey one equation. A stop is closed in
/// one of them and open in the other.
fn has_odd_laws(model: &Model) -> Result<bool> {
    for contact in model.contacts() {
        if !contact.law(1.0)?.is_odd() {
            return Ok(false);
        }
    }
    Ok(true)
}

/// Distance of two motions, relative to the first, both by their harmonics.
fn distance(x: &[Complex64], y: &[Complex64]) -> f64 {
    let gap: f64 = x.iter().zip(y).map(|(x, y)| (x - y).norm_sqr()).sum();
    let size: f64 = x.iter().map(Complex64::norm_sqr).sum();
    if gap == 0.0 { 0.0 } else { (gap / size).sqrt() }
}
