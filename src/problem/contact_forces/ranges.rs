//! Properties of the laws at other motions and other samples: their linear ranges, and their sampling error.

use crate::contact::forms::linearisation::Range;
use crate::contact::forms::onset::Onset;
use crate::error::{Error, Result, try_push};
use crate::problem::contact_forces::{ContactForces, gather_scaled};
use num_complex::Complex64;

impl ContactForces<'_> {
    /// Relative change of the forces with the number of samples: ‖F_N − F_M‖/‖F_N‖ over the forces of all sampled
    /// laws, with M = N/2 (2N where N is too small to halve), at given motions and frequency; 0 if all laws are
    /// exact. It indicates the size of the error and is not a bound. NaN if a law fails at the other samples; this
    /// ends no branch.
    ///
    /// # Errors
    /// Those of callbacks that give up.
    pub fn sampling_error(&mut self, motion: &[f64], omega: f64) -> Result<f64> {
        match self.compare_samples(motion, omega) {
            Err(e) if e.recoverable => Ok(f64::NAN),
            compared => compared,
        }
    }

    fn compare_samples(&mut self, motion: &[f64], omega: f64) -> Result<f64> {
        let Some(other) = &mut self.other else { return Ok(0.0) };
        let set = self.condensed.set();
        let m = set.packed_len();
        let (mut difference, mut size) = (0.0, 0.0);
        for assembled in self.condensed.laws() {
            let here = assembled.at(omega);
            let (law, at) = (here.law, &assembled.coordinates);
            if !self.evaluator.samples(law) {
                continue;
            }
            self.interrupt.check()?;
            let Some(found) = self.memory.found.get_mut(at.len() - 1).and_then(Option::as_mut) else {
                continue;
            };
            let y = gather_scaled(at, m, here.of_motion, motion, &mut self.memory.gathered);
            if at.len() == 1 {
                self.evaluator.prepare(set, y, self.interrupt)?;
                other.prepare(set, y, self.interrupt)?;
            }
            let reported = |e: Error| e.at(format_args!("contact {}", assembled.contact));
            let interrupt = self.interrupt;
            let evaluated = self.evaluator.evaluate(law, set, y, omega, found, interrupt);
            evaluated.map_err(reported)?;
            let checked = &mut self.memory.checked[..found.force.len()];
            checked.copy_from_slice(&found.force);
            other.evaluate(law, set, y, omega, found, interrupt).map_err(reported)?;
            for (a, b) in checked.iter().zip(&found.force) {
                difference += here.factor * here.factor * (a - b) * (a - b);
                size += here.factor * here.factor * a * a;
            }
        }
        Ok(if size == 0.0 { 0.0 } else { f64::sqrt(difference / size) })
    }

    /// Factors of a vibration in the fundamental, one amplitude per coordinate, about the static motion at which a law
    /// slips, opens or ceases to be linear.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn onset(&self, motion: &[Complex64]) -> Result<Onset> {
        const CONTEXT: &str = "the contacts";
        let mut onset = Onset::NEVER;
        let (mut rest, mut own) = (Vec::new(), Vec::new());
        for assembled in self.condensed.laws() {
            rest.clear();
            own.clear();
            for &c in &assembled.coordinates {
                try_push(&mut rest, self.static_part.rest.get(c).copied().unwrap_or(0.0), CONTEXT)?;
                try_push(&mut own, motion[c], CONTEXT)?;
            }
            onset = onset.earliest(assembled.law.onset(&rest, &own));
        }
        Ok(onset)
    }

    /// The scale factor s of [`Self::set_scale`] from which on the forces at the given motion are linear, or nearly
    /// so.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn linearisation_scale(&mut self, motion: &[f64], omega: f64) -> Result<f64> {
        let set = self.condensed.set();
        let m = set.packed_len();
        let mut ranges = Vec::new();
        for y in motion.chunks_exact(m.max(1)) {
            self.evaluator.prepare(set, y, self.interrupt)?;
            let range = Range {
                half: self.evaluator.half_range(set),
                mean: if set.has_mean() { y[0] } else { 0.0 },
                speed: set.speed(y, omega),
            };
            try_push(&mut ranges, range, "the contacts")?;
        }
        let mut own = Vec::new();
        let mut largest = 0.0_f64;
        for assembled in self.condensed.laws() {
            own.clear();
            let here = assembled.at(omega);
            let mut reference = f64::INFINITY;
            for &c in &assembled.coordinates {
                let Range { half, mean, speed } = ranges[c];
                let of_motion = here.of_motion.unwrap_or(1.0);
                let range = Range {
                    half: half / of_motion,
                    mean: mean / of_motion,
                    speed: speed / of_motion,
                };
                try_push(&mut own, range, "the contacts")?;
                reference = reference.min(self.condensed.stiffness(c));
            }
            largest = largest.max(here.law.linearisation_scale(&own, reference));
        }
        Ok(largest)
    }
}
