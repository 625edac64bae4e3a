//! Further responses at a solved point: gauges Σ w x of the whole motion, with their derivatives along a direction.
//!
//! The motion of a harmonic and its change along (dy, dω) follow from one factorisation each,
//!
//! > x = Z_κ⁻¹ (F − Wᴴ w),  dx = Z_κ⁻¹ (∂F/∂ω dω − Wᴴ dw − ∂Z_κ/∂ω x dω),  w = f − κ y,
//!
//! whatever the number of gauges. They are read at solved points alone: Newton's iterations do not know them.

use crate::condense::Condensed;
use crate::condense::by_factors::flexibility::Workspace;
use crate::condense::by_factors::near_rigid_motion;
use crate::error::{Result, try_extend, try_push, try_vec};
use crate::fourier::{Reader, Reading};
use crate::interrupt::Interrupt;
use crate::model::few_motions::reduced_wave::MotionRow;
use crate::options::{Measure, Response};
use crate::problem::contact_forces::ContactForces;
use num_complex::Complex64;

const CONTEXT: &str = "the responses";

/// One response (a gauge) on a condensed model.
pub struct Gauge {
    measure: Measure,
    order: i32,
    /// Per carried harmonic, the rows of its degrees of freedom, each times its weight and the phase factor of its
    /// sector.
    rows: Vec<Vec<(Complex64, MotionRow)>>,
}

impl Gauge {
    /// The gauge of a response; a response without degrees of freedom reads the `default` one.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(condensed: &Condensed, response: &Response<'_>, default: usize) -> Result<Self> {
        let mut rows = Vec::new();
        for (i, block) in condensed.blocks().iter().enumerate() {
            let turn = block.next.powu(u32::try_from(response.sector).unwrap_or(u32::MAX));
            let mut of_harmonic = Vec::new();
            let only = [default];
            let dofs = if response.dofs.is_empty() { &only } else { response.dofs };
            for (k, dof) in dofs.iter().enumerate() {
                let weight = response.weights.get(k).copied().unwrap_or(1.0);
                try_push(
                    &mut of_harmonic,
                    (turn * weight, condensed.motion_row(i, *dof)?),
                    CONTEXT,
                )?;
            }
            try_push(&mut rows, of_harmonic, CONTEXT)?;
        }
        Ok(Self {
            measure: response.measure,
            order: response.component.order(),
            rows,
        })
    }

    /// Whether the measure depends on a carried harmonic.
    pub fn reads(&self, condensed: &Condensed, i: usize) -> bool {
        let set = condensed.set();
        match self.measure {
            Measure::Fundamental => i == set.watched(),
            Measure::Harmonic(number) => set.numbers()[i] == number,
            Measure::Peak | Measure::Rms | Measure::Range => true,
        }
    }

    /// Weighted sum Σ w x in the i-th harmonic.
    pub fn along(&self, i: usize, x: &[Complex64]) -> Complex64 {
        self.rows[i].iter().map(|(weight, row)| weight * row.along(x)).sum()
    }

    /// Factor (ihω)ᵏ of the k-th derivative by time, and its derivative by ω.
    #[must_use]
    pub fn factor(&self, number: usize, omega: f64) -> (Complex64, Complex64) {
        if self.order == 0 {
            return (Complex64::ONE, Complex64::ZERO);
        }
        let by = Complex64::new(0.0, number as f64);
        let of_omega = (by * omega).powi(self.order - 1) * by;
        (of_omega * omega, of_omega * f64::from(self.order))
    }
}

/// Value of a gauge at a point, in the unit of the condensed model.
#[derive(Clone, Copy, Debug)]
pub struct Seen {
    /// Value, complex amplitude and kind of the response.
    pub reading: Reading,
    /// Derivative of the value along the direction.
    pub slope: f64,
    /// Derivative of the complex amplitude along the direction; NaN where the measure has none.
    pub complex_slope: Complex64,
    /// Times ωt at which the extremes occur, for a range first that of the largest value, and their changes along the
    /// direction; NaN where the measure has none.
    pub instants: [f64; 2],
    pub instant_rates: [f64; 2],
}

impl Seen {
    /// Amplitude and derivative as a problem observes them: complex where the measure is complex.
    pub fn observed(&self) -> (Complex64, Complex64) {
        if self.reading.complex.re.is_nan() {
            (self.reading.value.into(), self.slope.into())
        } else {
            (self.reading.complex, self.complex_slope)
        }
    }
}

/// The gauges of a run on one condensed model.
pub struct Gauges<'a> {
    condensed: &'a Condensed,
    all: Vec<Gauge>,
    forces: ContactForces<'a>,
    workspace: Workspace,
    reader: Reader,
    /// Packed signals of the gauges, and their changes.
    signals: Vec<f64>,
    changes: Vec<f64>,
    motion: GaugeMotion,
    /// The point and the direction that were read last, and the harmonics whose signals are known there.
    last: Vec<f64>,
    known: Vec<bool>,
}

/// Memory of motions and of their changes, relative and of the structure.
pub struct GaugeMotion {
    w: Vec<Complex64>,
    dw: Vec<Complex64>,
    x: Vec<Complex64>,
    dx: Vec<Complex64>,
}

impl<'a> Gauges<'a> {
    /// The gauges of `responses` on a condensed model; a response without degrees of freedom reads the `default` one.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(
        condensed: &'a Condensed,
        (responses, default): (&[Response<'_>], usize),
        samples: usize,
        interrupt: &'a Interrupt<'a>,
    ) -> Result<Self> {
        let mut gauges = Vec::new();
        for response in responses {
            try_push(&mut gauges, Gauge::new(condensed, response, default)?, CONTEXT)?;
        }
        let set = condensed.set();
        let numbers = gauges.len().saturating_mul(set.packed_len());
        let vector = |n| try_vec(n, Complex64::ZERO, CONTEXT);
        Ok(Self {
            condensed,
            all: gauges,
            forces: ContactForces::unchecked(condensed, samples, interrupt)?,
            workspace: Workspace::new(condensed, None)?,
            reader: Reader::new(set)?,
            signals: try_vec(numbers, 0.0, CONTEXT)?,
            changes: try_vec(numbers, 0.0, CONTEXT)?,
            motion: GaugeMotion {
                w: vector(condensed.coordinates())?,
                dw: vector(condensed.coordinates())?,
                x: vector(condensed.ndof())?,
                dx: vector(condensed.ndof())?,
            },
            last: Vec::new(),
            known: try_vec(set.numbers().len(), false, CONTEXT)?,
        })
    }

    /// Reads gauge number `one`, or all of them, at `v` = (u, ω) along a direction of as many numbers. Either way the
    /// signals of all gauges are then known in the harmonics that were read: a peak is found by one gauge, and
    /// recorded with all.
    ///
    /// # Errors
    /// `Singular` at an undamped resonance; those of callbacks; `OutOfMemory`; `StoppedByCaller`.
    pub fn read(&mut self, v: &[f64], direction: &[f64], one: Option<usize>, seen: &mut Vec<Seen>) -> Result<()> {
        let (u, omega) = v.split_at(v.len() - 1);
        let (condensed, omega) = (self.condensed, omega[0]);
        let (along, d_omega) = (&direction[..u.len()], direction[u.len()]);
        let interrupt = self.forces.interrupt();
        let set = condensed.set();
        let m = set.packed_len();
        if !self.last.iter().eq(v.iter().chain(direction)) {
            self.known.fill(false);
            self.signals.fill(0.0);
            self.changes.fill(0.0);
            self.last.clear();
            try_extend(&mut self.last, v, CONTEXT)?;
            try_extend(&mut self.last, direction, CONTEXT)?;
        }
        let mut evaluated = false;
        let wanted = |r: usize| one.is_none_or(|one| one == r);
        for (i, &number) in set.numbers().iter().enumerate() {
            let mut gauges = self.all.iter().enumerate();
            if self.known[i] || !gauges.any(|(r, gauge)| wanted(r) && gauge.reads(condensed, i)) {
                continue;
            }
            if !evaluated {
                self.forces.evaluate(u, omega)?;
                evaluated = true;
            }
            for (c, (w, dw)) in self.motion.w.iter_mut().zip(&mut self.motion.dw).enumerate() {
                *w = self.forces.minus_reference(u, c, i);
                *dw = self.forces.along(along, c, i) + self.forces.by_omega(c, i) * d_omega;
            }
            let (x, dx) = (&mut self.motion.x, &mut self.motion.dx);
            let at = (i, omega);
            self.workspace
                .recover(condensed, i, omega, &self.motion.w, x, interrupt)?;
            self.workspace
                .recover_along(condensed, at, (&self.motion.dw, d_omega), x, dx, interrupt)?;
            for (c, y) in self.motion.w.iter_mut().enumerate() {
                *y = set.get_at(u, c * m, i);
            }
            near_rigid_motion::correct(&mut self.workspace, condensed, at, &self.motion.w, x, interrupt)?;
            for (r, gauge) in self.all.iter().enumerate() {
                let (factor, d_factor) = gauge.factor(number, omega);
                let (value, change) = (gauge.along(i, x), gauge.along(i, dx));
                let signal = r * m..(r + 1) * m;
                set.set(&mut self.signals[signal.clone()], i, factor * value);
                let change = factor * change + d_factor * value * d_omega;
                set.set(&mut self.changes[signal], i, change);
            }
            self.known[i] = true;
        }
        seen.clear();
        for (r, gauge) in self.all.iter().enumerate() {
            if !wanted(r) {
                continue;
            }
            let (signal, change) = (&self.signals[r * m..(r + 1) * m], &self.changes[r * m..(r + 1) * m]);
            let mut reading = self.reader.read(set, gauge.measure, signal, interrupt)?;
            reading.instant /= set.base().max(1) as f64;
            let number = match gauge.measure {
                Measure::Harmonic(number) => set.numbers().binary_search(&number).ok(),
                Measure::Fundamental => Some(set.watched()),
                Measure::Peak | Measure::Rms | Measure::Range => None,
            };
            let (instants, instant_rates) = self.reader.instants(set, signal, change);
            let of_seen = Seen {
                instants,
                instant_rates,
                reading,
                slope: self.reader.along(set, change),
                complex_slope: number.map_or(Complex64::ZERO, |i| set.get(change, i)),
            };
            try_push(seen, of_seen, CONTEXT)?;
        }
        Ok(())
    }

    /// A gauge at `v` = (u, ω) with the derivatives of its measure by the motion and by ω at a fixed motion.
    ///
    /// # Errors
    /// As [`Self::read`].
    pub fn derivatives(&mut self, v: &[f64], r: usize) -> Result<Derivatives> {
        let mut seen = Vec::new();
        let zero = try_vec(v.len(), 0.0, CONTEXT)?;
        self.read(v, &zero, Some(r), &mut seen)?;
        let (condensed, omega) = (self.condensed, v[v.len() - 1]);
        let (set, n) = (condensed.set(), condensed.ndof());
        let m = set.packed_len();
        let mut by_motion = try_vec(n.saturating_mul(set.numbers().len()), Complex64::ZERO, CONTEXT)?;
        let mut by_omega = 0.0;
        let gauge = &self.all[r];
        for (i, (&number, c)) in set.numbers().iter().zip(self.reader.weights()).enumerate() {
            let (factor, d_factor) = gauge.factor(number, omega);
            if factor == Complex64::ZERO {
                continue;
            }
            let value = set.get(&self.signals[r * m..(r + 1) * m], i) / factor;
            by_omega += (c.conj() * d_factor * value).re;
            for (weight, row) in &gauge.rows[i] {
                for &(p, a) in row.terms() {
                    by_motion[i * n + p] += (weight * a * factor).conj() * c;
                }
            }
        }
        Ok(Derivatives {
            value: seen.first().map_or(f64::NAN, |seen| seen.reading.value),
            by_motion,
            by_omega,
        })
    }
}

impl Gauges<'_> {
    /// Index among the carried harmonics of the one that a gauge measures; `None` where it is not carried.
    pub fn harmonic(&self, r: usize) -> Option<usize> {
        let set = self.condensed.set();
        match self.all[r].measure {
            Measure::Harmonic(number) => set.numbers().binary_search(&number).ok(),
            _ => Some(set.watched()),
        }
    }

    /// The complex amplitude of the i-th carried harmonic, whose motion is x.
    #[must_use]
    pub fn amplitude(&self, r: usize, (i, omega): (usize, f64), x: &[Complex64]) -> Complex64 {
        let gauge = &self.all[r];
        gauge.factor(self.condensed.set().numbers()[i], omega).0 * gauge.along(i, x)
    }

    /// Derivatives of a part of the amplitude X along `turn`, Re(turn* X): of the real part for turn = 1, of the
    /// imaginary part for i.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn part(
        &self,
        r: usize,
        (i, omega): (usize, f64),
        (turn, amplitude): (Complex64, Complex64),
    ) -> Result<Derivatives> {
        let (set, n) = (self.condensed.set(), self.condensed.ndof());
        let mut found = Derivatives {
            value: (turn.conj() * amplitude).re,
            by_motion: try_vec(n.saturating_mul(set.numbers().len()), Complex64::ZERO, CONTEXT)?,
            by_omega: 0.0,
        };
        let gauge = &self.all[r];
        let (factor, d_factor) = gauge.factor(set.numbers()[i], omega);
        if factor != Complex64::ZERO {
            found.by_omega = (turn.conj() * d_factor * amplitude / factor).re;
            for (weight, row) in &gauge.rows[i] {
                for &(p, a) in row.terms() {
                    found.by_motion[i * n + p] += (weight * a * factor).conj() * turn;
                }
            }
        }
        Ok(found)
    }
}

/// The derivatives of a measure m, dm = Σ Re(gₕᴴ dxₕ) + (∂m/∂ω) dω.
pub struct Derivatives {
    /// The measure m.
    pub value: f64,
    /// gₕ over the coordinates of the condensed model, for each carried harmonic.
    pub by_motion: Vec<Complex64>,
    /// ∂m/∂ω at a fixed motion: nonzero for velocities and accelerations alone.
    pub by_omega: f64,
}
