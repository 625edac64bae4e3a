//! Margins of sliders that stick through the period against their limits, with their derivatives by the places of all sliders.
//!
//! The margin of a contact is the least of μN(τ) − |f(τ)| over the period. In one direction both μN − f and μN + f are smooth, and
//! each of their minima is a condition; in a plane each minimum of μN − |f| is one. By the envelope theorem the derivative of a
//! minimum is that at its time.

use crate::analysis::residual_states::stuck_contacts::StuckSlider;
use crate::condense::Condensed;
use crate::contact::forms::constants::Constant;
use crate::error::{Error, Result, try_push, try_vec};
use crate::fourier::{HarmonicSet, TurningPoints, jet};
use crate::interrupt::Interrupt;
use crate::model::Model;
use crate::roots::least;
use std::f64::consts::TAU;

const CONTEXT: &str = "the margins of sliders";

/// Times per wave of the highest harmonic at which a margin in a plane is sampled.
/// Kind: tuned; measured on: not recorded.
const SLIP_MARGINS_TIMES_PER_WAVE: usize = 16;

/// Width, over the step of the samples, at which a minimum between two times is found.
/// Kind: rounding.
const SECTION_WIDTH: f64 = 1e-12;

/// A condition margin ≥ 0 that a sticking contact must meet.
#[derive(Clone, Debug)]
pub(crate) struct Margin {
    /// Index of the contact in the model.
    pub contact: usize,
    /// The margin, in the caller's unit of forces.
    pub value: f64,
    /// Derivatives of the margin by the places of the sliders.
    pub gradient: Vec<f64>,
    /// Mean of the friction limit μN over the period.
    pub limit: f64,
}

impl Margin {
    /// Size of the friction limit, kept above zero where the limit vanishes.
    pub fn size(&self) -> f64 {
        self.limit.abs().max(f64::MIN_POSITIVE)
    }

    /// The margin divided by the size of its friction limit.
    pub fn share(&self) -> f64 {
        self.value / self.size()
    }
}

/// A solution with held sliders.
#[derive(Clone, Copy)]
pub(crate) struct Held<'a> {
    /// The model at the frequency of the solution, with the true friction coefficients.
    pub model: &'a Model,
    pub condensed: &'a Condensed,
    /// Packed motion in the solver's units.
    pub motion: &'a [f64],
    /// The sliders at their places; those of one contact follow each other.
    pub sliders: &'a [StuckSlider],
    /// Derivatives of the motions by the places.
    pub by_place: &'a [Vec<f64>],
}

/// Tangential force and friction limit of a contact over the period.
struct Signals<'a> {
    set: &'a HarmonicSet,
    /// Packed forces along the directions.
    force: [Vec<f64>; 2],
    /// Packed friction limit μN.
    limit: Vec<f64>,
}

impl Signals<'_> {
    fn margin(&self, tau: f64) -> f64 {
        let [f, g] = [0, 1].map(|k| jet(self.set, &self.force[k], tau).x);
        jet(self.set, &self.limit, tau).x - f.hypot(g)
    }
}

impl Held<'_> {
    /// The margins of all contacts with held sliders.
    pub fn margins(&self, interrupt: &Interrupt<'_>) -> Result<Vec<Margin>> {
        let mut margins = Vec::new();
        for of_contact in self.sliders.chunk_by(|a, b| a.contact == b.contact) {
            interrupt.check()?;
            self.of_contact(of_contact, &mut margins, interrupt)?;
        }
        Ok(margins)
    }

    fn packed(&self, coordinate: usize) -> &[f64] {
        let m = self.condensed.set().packed_len();
        &self.motion[coordinate * m..(coordinate + 1) * m]
    }

    /// Friction coefficient μ, normal stiffness kn and normal load n₀ of a contact; kn = 0 under a constant load.
    fn load(&self, slider: &StuckSlider) -> [f64; 3] {
        let contact = &self.model.contacts()[slider.contact];
        let [mu, kn, preload] =
            [Constant::Mu, Constant::Kn, Constant::Preload].map(|constant| contact.constant(constant));
        match slider.normal {
            Some(_) => [mu, kn, contact.load()],
            None => [mu, 0.0, preload],
        }
    }

    fn of_contact(&self, sliders: &[StuckSlider], margins: &mut Vec<Margin>, interrupt: &Interrupt<'_>) -> Result<()> {
        let set = self.condensed.set();
        let (m, length) = (set.packed_len(), self.condensed.length());
        let Some(first) = sliders.first() else { return Ok(()) };
        let [mu, kn, load] = self.load(first);
        let mut signals = Signals {
            set,
            force: [try_vec(m, 0.0, CONTEXT)?, try_vec(m, 0.0, CONTEXT)?],
            limit: try_vec(m, 0.0, CONTEXT)?,
        };
        for (k, slider) in sliders.iter().enumerate() {
            for (f, x) in signals.force[k].iter_mut().zip(self.packed(slider.coordinate)) {
                *f = slider.stiffness * length * x;
            }
            signals.force[k][0] -= slider.stiffness * slider.place;
        }
        if let Some(normal) = first.normal {
            for (n, y) in signals.limit.iter_mut().zip(self.packed(normal)) {
                *n = -mu * kn * length * y;
            }
        }
        signals.limit[0] += mu * load;
        let mean = signals.limit[0];
        let found = match sliders {
            [_] => in_line(&signals, interrupt)?,
            _ => in_plane(&signals, interrupt)?,
        };
        for (tau, direction, value) in found {
            let mut gradient = try_vec(self.by_place.len(), 0.0, CONTEXT)?;
            let at = |change: &[f64], c: usize| jet(set, &change[c * m..(c + 1) * m], tau).x;
            for (j, (g, change)) in gradient.iter_mut().zip(self.by_place).enumerate() {
                for (slider, e) in sliders.iter().zip(direction) {
                    let own = &self.sliders[j];
                    let is_own = own.contact == slider.contact && own.direction == slider.direction;
                    let stretch = at(change, slider.coordinate) - f64::from(u8::from(is_own));
                    *g -= e * slider.stiffness * stretch;
                }
                if let Some(normal) = first.normal {
                    *g -= mu * kn * at(change, normal);
                }
            }
            let margin = Margin {
                contact: first.contact,
                value,
                gradient,
                limit: mean,
            };
            try_push(margins, margin, CONTEXT)?;
        }
        Ok(())
    }
}

/// For a slider on a line, the minima of μN − f and of μN + f: time, direction of the force, and value.
fn in_line(signals: &Signals<'_>, interrupt: &Interrupt<'_>) -> Result<Vec<(f64, [f64; 2], f64)>> {
    let set = signals.set;
    let mut found = Vec::new();
    let mut search = TurningPoints::new(set)?;
    let mut signal = try_vec(set.packed_len(), 0.0, CONTEXT)?;
    for sign in [1.0, -1.0] {
        for ((s, n), f) in signal.iter_mut().zip(&signals.limit).zip(&signals.force[0]) {
            *s = n - sign * f;
        }
        let mut extrema = Vec::new();
        search.find(set, &signal, &mut extrema, interrupt)?;
        if extrema.is_empty() {
            try_push(&mut found, (0.0, [sign, 0.0], signal[0]), CONTEXT)?;
        }
        for e in extrema.iter().filter(|e| jet(set, &signal, e.tau).ddx >= 0.0) {
            try_push(&mut found, (e.tau, [sign, 0.0], e.x), CONTEXT)?;
        }
    }
    Ok(found)
}

/// For sliders in a plane, the minima of μN − |f|: time, direction of the force, and value.
fn in_plane(signals: &Signals<'_>, interrupt: &Interrupt<'_>) -> Result<Vec<(f64, [f64; 2], f64)>> {
    let set = signals.set;
    let times = SLIP_MARGINS_TIMES_PER_WAVE * (set.highest_reduced() + 1);
    interrupt.check_before((12 * times * set.packed_len()) as u64)?;
    let step = TAU / times as f64;
    let mut values = try_vec(times, 0.0, CONTEXT)?;
    for (i, value) in values.iter_mut().enumerate() {
        *value = signals.margin(step * i as f64);
    }
    let mut found = Vec::new();
    for (i, &value) in values.iter().enumerate() {
        let (before, after) = (values[(i + times - 1) % times], values[(i + 1) % times]);
        if value > before || value > after {
            continue;
        }
        let around = [step * (i as f64 - 1.0), step * (i as f64 + 1.0)];
        let tau = least(around, SECTION_WIDTH * step, |tau| Ok::<_, Error>(signals.margin(tau)))?;
        let force = [0, 1].map(|k| jet(set, &signals.force[k], tau).x);
        let size = force[0].hypot(force[1]);
        if size == 0.0 {
            continue;
        }
        try_push(&mut found, (tau, force.map(|f| f / size), signals.margin(tau)), CONTEXT)?;
    }
    Ok(found)
}
