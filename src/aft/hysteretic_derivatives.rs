//! Derivatives of marched states and of the Fourier sums of their force by the harmonics of the motion and by the
//! circular frequency ω of the period; see [`crate::aft::hysteretic`].

use crate::aft::evaluation::Evaluation;
use crate::aft::periodic_state::ReturnMap;
use crate::contact::march::{March, StuckState};
use crate::error::{Result, try_vec};
use crate::fourier::HarmonicSet;
use crate::interrupt::Interrupt;
use std::f64::consts::TAU;

/// Number of samples whose outer products are added at a time.
const BATCH: usize = 4;

/// The motion at the samples, with the tables from which it follows.
pub(super) struct Signals {
    pub samples: usize,
    pub directions: usize,
    /// Packed length m of one signal.
    length: usize,
    /// bⱼ, samples × m.
    basis: Vec<f64>,
    /// dbⱼ/dτ, samples × m; empty without velocities.
    rate: Vec<f64>,
    /// Motion, samples × d.
    pub u: Vec<f64>,
    /// Velocity, samples × d; empty if it is not used.
    pub v: Vec<f64>,
}

impl Signals {
    pub fn new(set: &HarmonicSet, directions: usize, with_velocity: bool, samples: usize) -> Result<Self> {
        let memory = |size: usize| try_vec(size, 0.0, "a march over samples");
        let m = set.packed_len();
        let mean = usize::from(set.has_mean());
        let mut basis = memory(samples.saturating_mul(m))?;
        let mut rate = memory(if with_velocity { basis.len() } else { 0 })?;
        for (j, row) in basis.chunks_exact_mut(m.max(1)).enumerate() {
            row[..mean].fill(1.0);
            for k in 0..set.oscillating() {
                // The angle is reduced exactly.
                let turns = (set.reduced(k) * j) % samples;
                let (sin, cos) = (TAU * turns as f64 / samples as f64).sin_cos();
                let at = mean + 2 * k;
                row[at] = cos;
                row[at + 1] = -sin;
                if with_velocity {
                    let p = set.reduced(k) as f64;
                    rate[j * m + at] = -p * sin;
                    rate[j * m + at + 1] = -p * cos;
                }
            }
        }
        let u = memory(samples.saturating_mul(directions))?;
        let v = memory(if with_velocity { u.len() } else { 0 })?;
        Ok(Self {
            samples,
            directions,
            length: m,
            basis,
            rate,
            u,
            v,
        })
    }

    /// Samples a packed motion and its velocity.
    pub fn fill(&mut self, omega: f64, motion: &[f64]) {
        let m = self.length;
        let value = |row: &[f64], signal: &[f64]| row.iter().zip(signal).map(|(b, x)| b * x).sum::<f64>();
        for j in 0..self.samples {
            for (k, signal) in motion.chunks_exact(m.max(1)).enumerate() {
                let at = j * self.directions + k;
                self.u[at] = value(self.basis(j), signal);
                if !self.rate.is_empty() {
                    self.v[at] = omega * value(self.rate(j), signal);
                }
            }
        }
    }

    fn basis(&self, j: usize) -> &[f64] {
        &self.basis[j * self.length..(j + 1) * self.length]
    }

    fn rate(&self, j: usize) -> &[f64] {
        &self.rate[j * self.length..(j + 1) * self.length]
    }

    /// Adds the derivatives of by_u·u + by_v·v at sample j, for rows of derivatives by the d motions, to those of one
    /// value by (X, ω).
    fn add(&self, j: usize, omega: f64, by_u: &[f64], by_v: &[f64], row: &mut [f64]) {
        let m = self.length;
        for (k, factor) in by_u.iter().enumerate() {
            axpy(*factor, self.basis(j), &mut row[k * m..(k + 1) * m]);
        }
        if self.rate.is_empty() {
            return;
        }
        for (k, factor) in by_v.iter().enumerate() {
            axpy(factor * omega, self.rate(j), &mut row[k * m..(k + 1) * m]);
            row[self.directions * m] += factor * self.v[j * self.directions + k] / omega;
        }
    }
}

/// y += a x
fn axpy(a: f64, x: &[f64], y: &mut [f64]) {
    if a != 0.0 {
        for (y, x) in y.iter_mut().zip(x) {
            *y += a * x;
        }
    }
}

/// Derivatives of states and forces by (X, ω), in rows of d·m + 1.
pub(super) struct Sensitivity {
    states: usize,
    /// Number of directions whose forces are differentiated: the first ones.
    forces: usize,
    width: usize,
    /// Derivatives of the states at the start of the period.
    start: Vec<f64>,
    /// Derivatives of the start of the previous march.
    before: Vec<f64>,
    /// Derivatives of the states at the current sample, and at the next.
    now: Vec<f64>,
    next: Vec<f64>,
    /// Derivatives of the forces at the samples of a batch.
    force: Vec<f64>,
    column: Vec<f64>,
}

impl Sensitivity {
    pub fn new(directions: usize, states: usize, forces: usize, length: usize) -> Result<Self> {
        let width = directions.saturating_mul(length).saturating_add(1);
        let rows = |n: usize| try_vec(n.saturating_mul(width), 0.0, "a march over samples");
        Ok(Self {
            states,
            forces,
            width,
            start: rows(states)?,
            before: rows(states)?,
            now: rows(states)?,
            next: rows(states)?,
            force: rows(directions.saturating_mul(BATCH))?,
            column: try_vec(states, 0.0, "a march over samples")?,
        })
    }

    /// Sets the start after a load from rest to the last sample, whose step is the first of `march`.
    pub fn load(&mut self, march: &March, signals: &Signals, omega: f64) {
        self.start.fill(0.0);
        let (d, last) = (signals.directions, signals.samples - 1);
        for (a, row) in self.start.chunks_exact_mut(self.width).enumerate() {
            let block = a * d..(a + 1) * d;
            signals.add(last, omega, &march.dz_du[block.clone()], &march.dz_dv[block], row);
            row[self.width - 1] += march.dz_domega[a];
        }
    }

    /// Sets the start of a law that sticks.
    pub fn stuck(&mut self, stuck: &StuckState, signals: &Signals, omega: f64) {
        self.start.fill(0.0);
        let d = signals.directions;
        for j in 0..signals.samples {
            for (a, row) in self.start.chunks_exact_mut(self.width).enumerate() {
                let by_u = &stuck.dz_du[(j * self.states + a) * d..][..d];
                signals.add(j, omega, by_u, &[], row);
            }
        }
    }

    /// Sets the start that returns, from that of the march; see [`crate::aft::periodic_state`].
    pub fn periodic(
        &mut self,
        map: &ReturnMap,
        march: &March,
        (signals, omega): (&Signals, f64),
        interrupt: &Interrupt<'_>,
    ) -> Result<()> {
        std::mem::swap(&mut self.start, &mut self.before);
        self.start.fill(0.0);
        self.pass(march, (signals, omega), None, interrupt)?;
        for column in 0..self.width {
            map.start_column(&self.now, &self.before, self.width, column, &mut self.column);
            for (row, value) in self.start.chunks_exact_mut(self.width).zip(&self.column) {
                row[column] = *value;
            }
        }
        Ok(())
    }

    /// Sets the end of the march as the next start.
    pub fn onward(&mut self, march: &March, of_motion: (&Signals, f64), interrupt: &Interrupt<'_>) -> Result<()> {
        self.pass(march, of_motion, None, interrupt)?;
        self.start.copy_from_slice(&self.now);
        Ok(())
    }

    /// Follows the states through the period from `start` to `now`, and adds the Fourier sums of the force and its
    /// derivatives, without their weights, to `out`.
    pub fn pass(
        &mut self,
        march: &March,
        (signals, omega): (&Signals, f64),
        mut out: Option<&mut Evaluation>,
        interrupt: &Interrupt<'_>,
    ) -> Result<()> {
        let (d, s, n) = (signals.directions, self.states, signals.samples);
        let of_batch =
            BATCH * self.width * (s * (s + 4) + if out.is_some() { self.forces * signals.length } else { 0 });
        self.now.copy_from_slice(&self.start);
        for j in 0..n {
            if j % BATCH == 0 {
                interrupt.check_before(2 * of_batch as u64)?;
            }
            let before = if j == 0 { n - 1 } else { j - 1 };
            for a in 0..s {
                let row = &mut self.next[a * self.width..(a + 1) * self.width];
                row.fill(0.0);
                let steps = &march.dz_dz[(j * s + a) * s..(j * s + a + 1) * s];
                for (factor, state) in steps.iter().zip(self.now.chunks_exact(self.width)) {
                    axpy(*factor, state, row);
                }
                let block = (j * s + a) * d..(j * s + a + 1) * d;
                let from = (&march.dz_du_before[block.clone()], &march.dz_dv_before[block.clone()]);
                signals.add(before, omega, from.0, from.1, row);
                signals.add(j, omega, &march.dz_du[block.clone()], &march.dz_dv[block], row);
                row[self.width - 1] += march.dz_domega[j * s + a];
            }
            std::mem::swap(&mut self.now, &mut self.next);
            if let Some(out) = &mut out {
                self.force_at(march, signals, omega, j);
                if (j + 1) % BATCH == 0 || j + 1 == n {
                    self.add_batch(march, signals, j - j % BATCH..j + 1, out);
                }
            }
        }
        Ok(())
    }

    /// Evaluates the derivatives of the force at sample j.
    fn force_at(&mut self, march: &March, signals: &Signals, omega: f64, j: usize) {
        let (d, s) = (signals.directions, self.states);
        let slot = j % BATCH;
        for i in 0..self.forces {
            let row = &mut self.force[(slot * d + i) * self.width..(slot * d + i + 1) * self.width];
            row.fill(0.0);
            let by_state = &march.df_dz[(j * d + i) * s..(j * d + i + 1) * s];
            for (factor, state) in by_state.iter().zip(self.now.chunks_exact(self.width)) {
                axpy(*factor, state, row);
            }
            let block = (j * d + i) * d..(j * d + i + 1) * d;
            signals.add(j, omega, &march.df_du[block.clone()], &march.df_dv[block], row);
        }
    }

    /// Adds f bᵀ and ∂f bᵀ of the samples of a batch.
    fn add_batch(&self, march: &March, signals: &Signals, batch: std::ops::Range<usize>, out: &mut Evaluation) {
        let (d, m) = (signals.directions, signals.length);
        let first = batch.start;
        let row = |slot: usize| signals.basis(if slot < batch.len() { first + slot } else { first });
        let rows: [&[f64]; BATCH] = std::array::from_fn(row);
        let add = |factors: [f64; BATCH], sums: &mut [f64]| {
            if factors.iter().all(|f| *f == 0.0) {
                return;
            }
            let [b0, b1, b2, b3] = rows;
            for ((((sum, b0), b1), b2), b3) in sums.iter_mut().zip(b0).zip(b1).zip(b2).zip(b3) {
                *sum += factors[0] * b0 + factors[1] * b1 + factors[2] * b2 + factors[3] * b3;
            }
        };
        let used = |slot: usize, value: f64| if slot < batch.len() { value } else { 0.0 };
        for i in 0..self.forces {
            let part = i * m..(i + 1) * m;
            let factor = |slot: usize| used(slot, march.f[(first + slot.min(batch.len() - 1)) * d + i]);
            add(std::array::from_fn(factor), &mut out.force[part.clone()]);
            for column in 0..self.width {
                let factor = |slot: usize| used(slot, self.force[(slot * d + i) * self.width + column]);
                let sums = match out.jacobian.get_mut(column * d * m..(column + 1) * d * m) {
                    Some(sums) => sums,
                    None => &mut out.by_omega,
                };
                add(std::array::from_fn(factor), &mut sums[part.clone()]);
            }
        }
    }
}
