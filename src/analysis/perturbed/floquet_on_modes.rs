//! Choice between the whole structure and modes of it, and the comparison of two numbers of modes.

use crate::analysis::perturbed::floquet_of_sliders::{SliderModes, are_sliders, perturbed_sliders};
use crate::analysis::perturbed::perturbed_motion::{Found, Motion, Subject, perturbed};
use crate::analysis::perturbed::two_numbers_of_modes::{agree, change, error_of_radius};
use crate::error::{Result, Status, fail, try_push};
use crate::hooks::{Hooks, LogLevel};
use crate::interrupt::Interrupt;
use crate::model::Model;
use crate::model::few_motions::on_modes::{OnModes, ShapesOfWaves, degrees_of_contacts};
use crate::model::matrices::speed::Speed;
use crate::model::matrices::structure::{MatrixKind, Structure};
use crate::model::matrices::wave::Wave;
use crate::model::natural_modes::linear_modes::ContactState;
use crate::options::{FloquetOptions, Waves};
use crate::results::Floquet;
use crate::stability::{Extent, fastest_motion};
use crate::time_integration::{refuse_massless, refuse_structural_damping};
use std::f64::consts::TAU;
use std::sync::Arc;

const CONTEXT: &str = "the models on modes";

/// Operations up to which the whole structure is carried, a few minutes of one core.
/// Kind: tuned; measured on: not recorded.
const ON_ALL: f64 = 1e11;

/// Smallest number of modes of a nodal diameter at which a search begins.
/// Kind: tuned; measured on: not recorded.
const FLOQUET_ON_MODES_FIRST: usize = 4;

/// Largest number of times that the modes are doubled for agreement.
/// Kind: cap.
const DOUBLINGS: usize = 4;

/// Frequency below which modes belong to the first ones, relative to that of the highest force.
/// Kind: tuned; measured on: not recorded.
const CUTOFF: f64 = 5.0;

/// Mode shapes and reduced models that the points of one branch share.
#[derive(Default)]
pub(crate) struct KeptModes {
    shapes: Option<Arc<ShapesOfWaves>>,
    small: Vec<(usize, OnModes)>,
    /// Number of modes at which the last comparison agreed.
    last: Option<usize>,
    /// Modes with the sliders of the contacts, one entry for each number of modes.
    sliders: Vec<SliderModes>,
    way: Option<Way>,
}

/// Coordinates on which a motion and its perturbations are integrated.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Way {
    /// All degrees of freedom of the structure.
    All,
    /// Degrees of freedom of the contacts, and modes.
    Shapes,
    /// Modes of the stuck structure, and sliders.
    Sliders,
}

impl KeptModes {
    /// Whether the motion is integrated on all degrees of freedom, by a count of operations.
    ///
    /// # Errors
    /// `OutOfMemory`; `Argument` for a nodal diameter that was not given.
    pub fn on_all_degrees(&mut self, model: &Model, omega: f64, options: &FloquetOptions) -> Result<bool> {
        Ok(self.way(model, omega, options)? == Way::All)
    }

    fn way(&mut self, model: &Model, omega: f64, options: &FloquetOptions) -> Result<Way> {
        if let Some(way) = self.way {
            return Ok(way);
        }
        let way = match options.modes {
            Some(0) => Way::All,
            modes => {
                let way = quickest(&*model.at_frequency(omega)?, omega, options.waves)?;
                if way == Way::All && modes.is_some() {
                    Way::Shapes
                } else {
                    way
                }
            }
        };
        self.way = Some(way);
        Ok(way)
    }

    /// The model reduced to a number of modes, or to all modes if there are fewer.
    fn on(&mut self, model: &Model, modes: usize, waves: Waves, interrupt: &Interrupt<'_>) -> Result<&OnModes> {
        let enough = self
            .shapes
            .as_ref()
            .is_some_and(|s| s.modes() >= modes || s.is_complete());
        let shapes = match &self.shapes {
            Some(shapes) if enough => Arc::clone(shapes),
            _ => {
                self.small.clear();
                Arc::new(ShapesOfWaves::new(
                    model,
                    step_of_waves(model, waves),
                    modes,
                    interrupt,
                )?)
            }
        };
        self.shapes = Some(Arc::clone(&shapes));
        let modes = modes.min(shapes.modes());
        let known = self.small.iter().position(|(count, _)| *count == modes);
        let at = known.unwrap_or(self.small.len());
        if known.is_none() {
            let small = OnModes::new(model, &shapes, modes, interrupt)?;
            try_push(&mut self.small, (modes, small), CONTEXT)?;
        }
        Ok(&self.small[at].1)
    }

    /// The modes and sliders with a number of modes, or with all modes if there are fewer.
    fn seen(&mut self, model: &Model, modes: usize, waves: Waves, interrupt: &Interrupt<'_>) -> Result<&SliderModes> {
        let known = self.sliders.iter().position(|seen| seen.suffices(modes));
        let at = known.unwrap_or(self.sliders.len());
        if known.is_none() {
            let seen = SliderModes::new(model, step_of_waves(model, waves), modes, interrupt)?;
            try_push(&mut self.sliders, seen, CONTEXT)?;
        }
        Ok(&self.sliders[at])
    }
}

/// Distance between the nodal diameters that perturbations can have.
fn step_of_waves(model: &Model, waves: Waves) -> usize {
    match waves {
        Waves::Wave => model.structure().sectors() / model.structure().repeating_sectors(),
        Waves::Wheel => 1,
    }
}

/// Floquet multipliers of a motion; `StoppedByCaller` is an error.
pub(crate) fn floquet_of(
    model: &Model,
    motion: &Motion<'_>,
    options: &FloquetOptions,
    hooks: &mut Hooks<'_>,
    kept: &mut KeptModes,
    interrupt: &Interrupt<'_>,
) -> Result<Found> {
    match on_quickest(model, motion, options, hooks, kept, interrupt) {
        // Nothing holds the structure with sticking contacts, or nothing but slipping ones.
        Err(e) if e.status == Status::Unsupported && kept.way == Some(Way::Sliders) => {
            kept.way = Some(Way::Shapes);
            on_quickest(model, motion, options, hooks, kept, interrupt)
        }
        found => found,
    }
}

/// Floquet multipliers of a motion, on the coordinates with the fewest operations.
fn on_quickest(
    model: &Model,
    motion: &Motion<'_>,
    options: &FloquetOptions,
    hooks: &mut Hooks<'_>,
    kept: &mut KeptModes,
    interrupt: &Interrupt<'_>,
) -> Result<Found> {
    let way = match kept.way(model, motion.omega, options)? {
        Way::Sliders if motion.autonomous => Way::Shapes,
        way => way,
    };
    if way == Way::All {
        return perturbed(&Subject { model, on_modes: None }, motion, options, hooks, interrupt);
    }
    let at_speed = &*model.at_frequency(motion.omega)?;
    refuse(at_speed, motion.omega, interrupt)?;
    if matches!(model.speed(), Speed::PerOmega(_)) {
        // The modes change with the frequency.
        (kept.shapes, kept.small, kept.sliders) = (None, Vec::new(), Vec::new());
    }
    let mut modes = match (options.modes, kept.last) {
        (Some(modes), _) => modes.div_ceil(2),
        (None, Some(last)) => last.div_ceil(2),
        (None, None) => first_number(at_speed, motion.omega, way, kept, options.waves, interrupt)?,
    };
    let mut few: Option<Found> = None;
    let mut refused = None;
    for _ in 0..=DOUBLINGS {
        let next = on_a_number(at_speed, motion, (options, way, modes), hooks, kept, interrupt);
        let mut many = match next {
            // A motion on too few modes may be far from the point.
            Err(e) if e.status == Status::NoConvergence && few.is_none() && options.modes.is_none() => {
                modes *= 2;
                refused = Some(e);
                continue;
            }
            next => next?,
        };
        if let Some(few) = &few {
            let (used, more) = (few.stability.modes, many.stability.modes);
            many.stability.modes_change = change(&few.stability, &many.stability);
            many.stability.radius_error = error_of_radius(&few.stability, &many.stability);
            // Where no more modes exist nothing is left out.
            if agree(&few.stability, &many.stability) || more == used {
                kept.last = Some(modes);
                return Ok(many);
            }
            if options.modes.is_some() {
                return fail!(
                    NoConvergence,
                    "the radius is {:.6} on {used} modes of each nodal diameter and {:.6} on {more}; use more of them, or all degrees of freedom (modes = 0)",
                    few.stability.radius,
                    many.stability.radius
                );
            }
        }
        few = Some(many);
        modes *= 2;
    }
    if let (None, Some(refused)) = (&few, refused) {
        return Err(refused);
    }
    fail!(
        NoConvergence,
        "the radius has not converged on {} modes of each nodal diameter; use all degrees of freedom (modes = 0)",
        few.map_or(0, |few| few.stability.modes)
    )
}

/// Floquet multipliers on a number of modes, or on all modes if there are fewer.
fn on_a_number(
    model: &Model,
    motion: &Motion<'_>,
    (options, way, modes): (&FloquetOptions, Way, usize),
    hooks: &mut Hooks<'_>,
    kept: &mut KeptModes,
    interrupt: &Interrupt<'_>,
) -> Result<Found> {
    if way == Way::Sliders {
        let seen = kept.seen(model, modes, options.waves, interrupt)?;
        let modes = modes.min(seen.modes());
        let found = perturbed_sliders(model, seen, modes, motion, options, interrupt)?;
        log_radius(hooks, &found.stability);
        return Ok(found);
    }
    let on_modes = kept.on(model, modes, options.waves, interrupt)?;
    let subject = Subject {
        model,
        on_modes: Some(on_modes),
    };
    let mut found = perturbed(&subject, motion, options, hooks, interrupt)?;
    found.stability.modes = on_modes.modes();
    log_radius(hooks, &found.stability);
    Ok(found)
}

fn log_radius(hooks: &mut Hooks<'_>, stability: &Floquet) {
    let (modes, radius) = (stability.modes, stability.radius);
    hooks.log(
        LogLevel::Info,
        &format!("on {modes} modes of each nodal diameter the radius is {radius:.6}"),
    );
}

/// Number of modes below a multiple of the frequency of the highest force.
fn first_number(
    model: &Model,
    omega: f64,
    way: Way,
    kept: &mut KeptModes,
    waves: Waves,
    interrupt: &Interrupt<'_>,
) -> Result<usize> {
    let highest = model
        .excitation()
        .forces()
        .iter()
        .map(|f| f.harmonic)
        .max()
        .unwrap_or(1);
    let cutoff = CUTOFF * omega * highest.max(1) as f64;
    let mut modes = FLOQUET_ON_MODES_FIRST;
    loop {
        let (below, is_complete) = if way == Way::Sliders {
            let seen = kept.seen(model, 2 * modes, waves, interrupt)?;
            (seen.modes_below(cutoff), seen.modes() < 2 * modes)
        } else {
            kept.on(model, 2 * modes, waves, interrupt)?;
            let Some(shapes) = &kept.shapes else { return Ok(modes) };
            (shapes.modes_below(cutoff), shapes.is_complete())
        };
        if below < 2 * modes || is_complete {
            return Ok(modes.max(below.min(2 * modes)));
        }
        modes *= 2;
    }
}

/// Refuses models that cannot be integrated in time, without setting up their equations.
fn refuse(model: &Model, omega: f64, interrupt: &Interrupt<'_>) -> Result<()> {
    let structure = model.structure();
    refuse_structural_damping(structure, omega)?;
    let highest = structure.sectors() / 2;
    for diameter in [0, highest] {
        let wave = Wave::Diameter(diameter as i64);
        refuse_massless(&structure.of_wave(MatrixKind::Mass, wave)?, structure.ndof())?;
        let is_own_mirror = (2 * diameter).is_multiple_of(structure.sectors());
        for which in [MatrixKind::Mass, MatrixKind::Damping, MatrixKind::Stiffness] {
            let is_real = || -> Result<bool> { Ok(structure.of_wave(which, wave)?.is_real()) };
            if is_own_mirror && !is_real()? {
                structure.unrolled(which, interrupt)?;
            }
        }
    }
    Ok(())
}

/// The coordinates with the fewest operations: all degrees of freedom if these take few, or fewer than modes; then
/// contacts' degrees of freedom with modes.
fn quickest(model: &Model, omega: f64, waves: Waves) -> Result<Way> {
    let structure = model.structure();
    let sectors = structure.repeating_sectors() as f64;
    let own = Wave::Harmonic(1);
    let stiffness = model.stiffness_at_small_motion(own, ContactState::Stuck)?;
    let mass = structure.of_wave(MatrixKind::Mass, own)?;
    let damping = structure.of_wave(MatrixKind::Damping, own)?;
    let whole = Extent {
        order: structure.ndof() as f64 * sectors,
        sliders: model.contacts().len() as f64 * sectors,
        entries: sectors * (stiffness.values.len() + mass.values.len() + damping.values.len()) as f64,
        fastest: fastest_motion(&stiffness, &mass) * TAU / omega / sectors,
        blocks: match waves {
            Waves::Wave => 1.0,
            Waves::Wheel => blocks_of_wheel(structure),
        },
    };
    if whole.operations() <= ON_ALL {
        return Ok(Way::All);
    }
    let order = (degrees_of_contacts(model)?.len() + 2 * FLOQUET_ON_MODES_FIRST) as f64 * sectors;
    let least = Extent {
        order,
        entries: 3.0 * order * order,
        ..whole
    };
    if least.operations() > ON_ALL && are_sliders(model)? {
        return Ok(Way::Sliders);
    }
    let whole_is_less = order >= whole.order || whole.operations() <= least.operations();
    Ok(if whole_is_less { Way::All } else { Way::Shapes })
}

/// Number of blocks into which the perturbations of a wheel split: even and odd ones, counting one of each conjugate
/// pair.
fn blocks_of_wheel(structure: &Structure) -> f64 {
    (structure.sectors() / structure.repeating_sectors() / 2 + 1) as f64
}
