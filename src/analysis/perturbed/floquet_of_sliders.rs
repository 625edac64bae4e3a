//! Stability of a motion of many contacts of friction under constant loads, on modes of the stuck structure and sliders.
//!
//! Degrees of freedom of the contacts are no states, which makes blocks of dozens of contacts in each sector as small as
//! their modes and the sliders that move.

use crate::analysis::perturbed::perturbed_motion::{Found, Motion, ODD};
use crate::contact::forms::law::{LawInTime, TimePart};
use crate::contact::forms::time_piece::Mode;
use crate::contact::{Contact, Role};
use crate::error::{Result, fail, try_copy, try_extend, try_push, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::dense::fallible_matrix::{filled, zero_vector};
use crate::linalg::libraries::DVector;
use crate::model::Model;
use crate::model::few_motions::on_modes::forces_of_harmonics;
use crate::model::matrices::structure::Structure;
use crate::model::natural_modes::contact_modes::{ContactModes, ForceOfWave};
use crate::options::FloquetOptions;
use crate::results::{Floquet, Multiplier};
use crate::stability::{
    Closure, Counts, ModalRing, Orbit, RingForce, SliderMap, SliderMotion, SliderState, Sliders, classified, closures,
    orbit, scale_of_sliders,
};
use crate::time_integration::{Number, SLIDER_POINTS_PER_WAVE};
use num_complex::Complex64;
use std::f64::consts::{SQRT_2, TAU};

const CONTEXT: &str = "the contacts on modes";

/// Modes of the stuck structure for all nodal diameters, and the sliders.
pub(crate) struct SliderModes {
    sliders: Sliders,
    modes: Vec<Option<ContactModes>>,
    requested: usize,
}

/// The active contacts as sliders; `None` unless all are sliders under constant loads.
fn sliders_of(model: &Model) -> Result<Option<(Vec<&Contact>, Sliders)>> {
    let mut sliders = Sliders {
        stiffness: Vec::new(),
        play: Vec::new(),
        start: Vec::new(),
    };
    let mut contacts = Vec::new();
    for contact in model.contacts().iter().filter(|c| c.role() == Role::Active) {
        let Ok(LawInTime {
            stiffness: 0.0,
            first: 0,
            part: TimePart::Events(law),
        }) = contact.in_time()
        else {
            return Ok(None);
        };
        let Some(slider) = law.slider().filter(|_| contact.directions() == 1) else {
            return Ok(None);
        };
        let stiffness = law.piece(Mode::Stick, [0.0; 2], 0.0).memory;
        let limit = law.piece(Mode::Slip(1.0), [0.0; 2], 0.0).force[0];
        try_push(&mut sliders.stiffness, stiffness, CONTEXT)?;
        try_push(&mut sliders.play, limit / stiffness, CONTEXT)?;
        try_push(&mut sliders.start, slider.start(), CONTEXT)?;
        try_push(&mut contacts, contact, CONTEXT)?;
    }
    Ok(Some((contacts, sliders)))
}

/// Whether the contacts of a model allow equations on modes and sliders.
pub(crate) fn are_sliders(model: &Model) -> Result<bool> {
    let structure = model.structure();
    let Some((contacts, _)) = sliders_of(model)? else {
        return Ok(false);
    };
    Ok(!contacts.is_empty() && structure.has_conjugate_waves() && !structure.has_aero_stiffness())
}

impl SliderModes {
    /// Prepares at most `modes` modes of each nodal diameter that is a multiple of `step`.
    ///
    /// # Errors
    /// As [`ContactModes::new`].
    pub fn new(model: &Model, step: usize, modes: usize, interrupt: &Interrupt<'_>) -> Result<Self> {
        let Some((contacts, sliders)) = sliders_of(model)? else {
            return fail!(Internal, "contacts that are no sliders");
        };
        let structure = model.structure();
        let forces = forces_of_harmonics(model)?;
        let mut all = Vec::new();
        for diameter in 0..=structure.sectors() / 2 {
            if diameter % step != 0 {
                try_push(&mut all, None, CONTEXT)?;
                continue;
            }
            let mut own = Vec::new();
            for (harmonic, force) in &forces {
                let (of, backward) = structure.wave_of(*harmonic);
                if of == diameter {
                    let mut force = try_copy(force, CONTEXT)?;
                    conjugate(&mut force, backward);
                    let force = ForceOfWave {
                        harmonic: *harmonic,
                        backward,
                        values: force,
                    };
                    try_push(&mut own, force, CONTEXT)?;
                }
            }
            let seen = ContactModes::new(model, diameter, (&contacts, &own), modes, interrupt)?;
            try_push(&mut all, Some(seen), CONTEXT)?;
        }
        Ok(Self {
            sliders,
            modes: all,
            requested: modes,
        })
    }

    /// Number of modes available for every diameter.
    pub fn modes(&self) -> usize {
        self.modes.iter().flatten().map(ContactModes::modes).min().unwrap_or(0)
    }

    /// Whether these modes are at least as many as given, or all that the structure has.
    pub fn suffices(&self, modes: usize) -> bool {
        self.requested == modes || (self.modes() < self.requested && self.modes() <= modes)
    }

    /// Largest number of modes of one diameter below an angular frequency.
    pub fn modes_below(&self, omega: f64) -> usize {
        let below = |seen: &ContactModes| seen.omega.iter().filter(|&&x| x < omega).count();
        self.modes.iter().flatten().map(below).max().unwrap_or(0)
    }
}

fn conjugate(values: &mut [Complex64], conjugated: bool) {
    if conjugated {
        for z in values {
            *z = z.conj();
        }
    }
}

/// Floquet multipliers of a motion on a number of modes; `StoppedByCaller` is an error.
pub(crate) fn perturbed_sliders(
    model: &Model,
    seen: &SliderModes,
    modes: usize,
    motion: &Motion<'_>,
    options: &FloquetOptions,
    interrupt: &Interrupt<'_>,
) -> Result<Found> {
    let structure = model.structure();
    let harmonics = independent(structure, motion.harmonics)?;
    let odd = is_odd(model, &harmonics)?;
    let blocks = closures(structure, options.waves, odd)?;
    let Some(own) = blocks.iter().find(|closure| closure.has_wave) else {
        return fail!(Internal, "no block of the wave");
    };
    let ring = ModalRing::<f64>::new(structure, *own, (&seen.modes, modes), &seen.sliders, interrupt)?;
    let lapses = structure.repeating_sectors();
    let forces = forces_on(structure, &ring, seen, interrupt)?;
    let in_time = SliderMotion::new(&ring, &seen.sliders, (motion.omega, lapses), forces, interrupt)?;
    let start = state_of_motion(structure, &ring, seen, motion.omega, &harmonics, interrupt)?;
    let found = orbit(
        &in_time,
        structure,
        start.try_clone()?,
        options.tolerance,
        options.refine,
        interrupt,
    )?;
    let Some(orbit) = found else {
        return fail!(
            NoConvergence,
            "shooting did not converge from the point: it has too few harmonics; solve it with more, or set refine to false"
        );
    };
    let mut all = Vec::new();
    for closure in &blocks {
        let apart = structure.sectors() / closure.sectors;
        let found = if closure.has_wave {
            multipliers(structure, &ring, &orbit, lapses, &in_time, interrupt)?
        } else if (2 * closure.index).is_multiple_of(apart) {
            let ring = ModalRing::<f64>::new(structure, *closure, (&seen.modes, modes), &seen.sliders, interrupt)?;
            multipliers(structure, &ring, &orbit, lapses, &in_time, interrupt)?
        } else {
            let block = (&seen.modes[..], modes);
            let ring = ModalRing::<Complex64>::new(structure, *closure, block, &seen.sliders, interrupt)?;
            multipliers(structure, &ring, &orbit, lapses, &in_time, interrupt)?
        };
        try_extend(&mut all, &found, CONTEXT)?;
    }
    let grazing = orbit.path.grazing.map(|(e, event)| (e / ring.closure.sectors, event));
    let mut stability = Floquet::of(all, grazing);
    stability.omega = motion.omega;
    stability.residual = if options.refine { orbit.residual } else { f64::NAN };
    stability.modes = modes;
    let shift = distance(&start, &orbit.state, motion.omega);
    stability.orbit_change = shift;
    Ok(Found {
        stability,
        shift,
        difference: None,
    })
}

/// Floquet multipliers of one block of perturbations.
fn multipliers<T: Number>(
    structure: &Structure,
    ring: &ModalRing<T>,
    orbit: &Orbit,
    lapses: usize,
    motion: &SliderMotion<'_>,
    interrupt: &Interrupt<'_>,
) -> Result<Vec<Multiplier>> {
    let closure: &Closure = &ring.closure;
    let map = SliderMap::new(ring, &orbit.path, &orbit.moves, interrupt)?;
    let factor = |turns: usize| T::of(closure.factor(structure, turns));
    let matrix = map.matrix((motion.omega, scale_of_sliders(motion)), factor, interrupt)?;
    let passed = structure.sectors_per_part() * lapses / closure.sectors;
    let turn = closure.factor(structure, passed).conj();
    let counts = Counts {
        stuck: ring.all() - map.moving.len(),
        rigid: 0,
        trivial: 0,
        moving: map.moving.len(),
    };
    let matrix = filled(map.states(), map.states(), CONTEXT, |i, j| matrix[(i, j)].complex())?;
    classified(matrix, &counts, lapses, turn, closure.has_conjugate, interrupt)
}

/// Harmonics of the independent degrees of freedom, from those of all of the caller's.
fn independent(structure: &Structure, harmonics: &[Complex64]) -> Result<Vec<Vec<Complex64>>> {
    let degrees = structure.degrees();
    let mut found = Vec::new();
    for all in harmonics.chunks_exact(degrees.given()) {
        let mut x = try_vec(degrees.independent(), Complex64::ZERO, CONTEXT)?;
        degrees.restrict(all, &mut x);
        try_push(&mut found, x, CONTEXT)?;
    }
    Ok(found)
}

/// Whether sectors half a wave apart move opposite to each other.
fn is_odd(model: &Model, harmonics: &[Vec<Complex64>]) -> Result<bool> {
    let forces = model.excitation().forces();
    if !model.structure().repeating_sectors().is_multiple_of(2) || forces.iter().any(|f| f.harmonic.is_multiple_of(2)) {
        return Ok(false);
    }
    for contact in model.contacts() {
        if !contact.law(1.0)?.is_odd() {
            return Ok(false);
        }
    }
    let size = |h: usize| harmonics[h].iter().fold(0.0_f64, |m, z| m.max(z.norm()));
    let largest = (0..harmonics.len()).map(size).fold(0.0_f64, f64::max);
    Ok((0..harmonics.len()).step_by(2).all(|h| size(h) <= ODD * largest))
}

/// Amplitudes on the coordinates of a ring from amplitudes on the modes of a harmonic: φᴴF, or φᴴF̄ where its wave
/// travels backward. With x_s = Re(X e^{−iδs} e^{ihωt}) the wave δ has the coordinate √m/2 φᴴMX e^{ihωt}, and the
/// wave of the other sense its conjugate.
fn on_ring(ring: &ModalRing<f64>, diameter: usize, backward: bool, modal: &[Complex64]) -> Result<Vec<Complex64>> {
    let mut found = try_vec(ring.order(), Complex64::ZERO, CONTEXT)?;
    let sectors = (ring.closure.sectors as f64).sqrt();
    for wave in ring.waves.iter().filter(|wave| wave.diameter == diameter) {
        for (k, &c) in modal.iter().take(ring.modes).enumerate() {
            if !wave.is_pair {
                found[wave.place + k] = sectors * c;
                continue;
            }
            let share = sectors / SQRT_2;
            let (re, im) = if backward {
                (c.conj(), Complex64::I * c.conj())
            } else {
                (c, -Complex64::I * c)
            };
            found[wave.place + k] = share * re;
            found[wave.place + ring.modes + k] = share * im;
        }
    }
    Ok(found)
}

/// The forces of the model on the modal coordinates, and on the relative motions that the modes leave out.
fn forces_on(
    structure: &Structure,
    ring: &ModalRing<f64>,
    seen: &SliderModes,
    interrupt: &Interrupt<'_>,
) -> Result<Vec<RingForce>> {
    let m = ring.closure.sectors;
    let mut found = Vec::new();
    for (diameter, own) in seen.modes.iter().enumerate() {
        let Some(own) = own else { continue };
        for force in &own.forces {
            interrupt.check_before((ring.contacts * (ring.modes + m)) as u64)?;
            let modal = on_ring(ring, diameter, force.backward, &force.modal)?;
            let mut relative = try_vec(ring.all(), Complex64::ZERO, CONTEXT)?;
            for c in 0..ring.contacts {
                let mut rest = force.static_motion[c];
                for k in 0..ring.modes {
                    rest -= own.rows[(c, k)] * force.modal[k] / own.omega[k].powi(2);
                }
                let rest = if force.backward { rest.conj() } else { rest };
                for s in 0..m {
                    relative[c * m + s] = rest * structure.phase(force.harmonic, s as i64);
                }
            }
            let force = RingForce {
                harmonic: force.harmonic,
                modal,
                relative,
            };
            try_push(&mut found, force, CONTEXT)?;
        }
    }
    Ok(found)
}

/// The state at time 0 of a motion given by its harmonics. Each slider has the place that it reaches after two
/// periods from its unloaded place.
fn state_of_motion(
    structure: &Structure,
    ring: &ModalRing<f64>,
    seen: &SliderModes,
    omega: f64,
    harmonics: &[Vec<Complex64>],
    interrupt: &Interrupt<'_>,
) -> Result<SliderState> {
    let order = ring.order();
    let m = ring.closure.sectors;
    let mut state = SliderState {
        q: zero_vector(order, CONTEXT)?,
        v: zero_vector(order, CONTEXT)?,
        w: zero_vector(ring.all(), CONTEXT)?,
    };
    let mut relative = Vec::new();
    for (h, x) in harmonics.iter().enumerate() {
        let (diameter, backward) = structure.wave_of(h);
        let Some(own) = &seen.modes[diameter] else {
            return fail!(Internal, "no modes of nodal diameter {diameter}");
        };
        interrupt.check_before(((ring.modes + ring.contacts) * x.len()) as u64)?;
        let mut x = try_copy(x, CONTEXT)?;
        conjugate(&mut x, backward);
        let amplitudes = on_ring(ring, diameter, backward, &own.coordinates(&x, ring.modes)?)?;
        for (i, z) in amplitudes.iter().enumerate() {
            state.q[i] += z.re;
            state.v[i] -= h as f64 * omega * z.im;
        }
        let mut r = own.relative(&x)?;
        conjugate(&mut r, backward);
        try_push(&mut relative, r, CONTEXT)?;
    }
    let times = SLIDER_POINTS_PER_WAVE * harmonics.len();
    let mut motion = try_vec(times, 0.0, CONTEXT)?;
    for c in 0..ring.contacts {
        for s in 0..m {
            let at = |time: usize| -> f64 {
                let of = |(h, r): (usize, &Vec<Complex64>)| {
                    let turn = Complex64::cis(TAU * ((h * time) % times) as f64 / times as f64);
                    let value = if h == 0 {
                        r[c].re.into()
                    } else {
                        r[c] * structure.phase(h, s as i64)
                    };
                    (value * turn).re
                };
                relative.iter().enumerate().map(of).sum()
            };
            for (time, x) in motion.iter_mut().enumerate() {
                interrupt.check_before((40 * harmonics.len()) as u64)?;
                *x = at(time);
            }
            let (mut place, play) = (seen.sliders.start[c], seen.sliders.play[c]);
            for x in motion.iter().cycle().take(2 * times + 1) {
                place = place.max(x - play).min(x + play);
            }
            state.w[c * m + s] = place;
        }
    }
    Ok(state)
}

/// Distance of the motions of two states, relative to the first.
fn distance(a: &SliderState, b: &SliderState, omega: f64) -> f64 {
    let apart = |a: &DVector<f64>, b: &DVector<f64>| -> f64 { a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum() };
    let gap = apart(&a.q, &b.q) + apart(&a.v, &b.v) / omega.powi(2);
    let size = a.q.norm_squared() + a.v.norm_squared() / omega.powi(2);
    if gap == 0.0 { 0.0 } else { (gap / size).sqrt() }
}

#[cfg(test)]
#[path = "floquet_of_sliders_tests.rs"]
mod tests;
