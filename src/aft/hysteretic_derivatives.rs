//! Derivatives of marched states and of the Fourier sums of their force by the harmonics of the motion and by the
//! circular frequency ω of the period; see [`crate::aft::hysteretic`].

use crate::aft::evaluation::Evaluation;
use crate::aft::periodic_state::ReturnMap;
use crate::contact::forms::march::March;
use crate::error::{Result, try_vec};
use crate::fourier::HarmonicSet;
use crate::interrupt::Interrupt;
use crate::linalg::{add_outer_products, transposed_products};
use std::f64::consts::TAU;

/// Number of samples whose outer products are added at a time.
/// Kind: block.
const BATCH: usize = 32;

/// The motion at the samples, with the tables from which it is computed.
pub(super) struct Signals {
    pub samples: usize,
    pub directions: usize,
    /// Packed length m of one signal.
    length: usize,
    /// Values bⱼ of the Fourier basis, samples × m.
    basis: Vec<f64>,
    /// Slopes dbⱼ/dτ of the Fourier basis, samples × m; empty without velocities.
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
        let mut turn = try_vec(samples, (0.0, 0.0), "a march over samples")?;
        for (j, z) in turn.iter_mut().enumerate() {
            *z = (TAU * j as f64 / samples as f64).sin_cos();
        }
        for (j, row) in basis.chunks_exact_mut(m.max(1)).enumerate() {
            row[..mean].fill(1.0);
            for k in 0..set.oscillating() {
                // The angle is reduced exactly.
                let (sin, cos) = turn[(set.reduced(k) * j) % samples];
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
        transposed_products(motion, self.directions, &self.basis, &mut self.u);
        if !self.rate.is_empty() {
            transposed_products(motion, self.directions, &self.rate, &mut self.v);
            self.v.iter_mut().for_each(|v| *v *= omega);
        }
    }

    /// Adds the Fourier sums of the force to `out`, without their weights.
    pub fn add_forces(&self, march: &March, out: &mut Evaluation) {
        let (d, m) = (self.directions, self.length);
        add_outer_products(
            (&self.basis, m),
            (&march.f[..self.samples * d], d, d),
            self.samples,
            &mut out.force[..d * m],
        );
    }

    fn basis(&self, j: usize) -> &[f64] {
        &self.basis[j * self.length..(j + 1) * self.length]
    }

    fn rate(&self, j: usize) -> &[f64] {
        &self.rate[j * self.length..(j + 1) * self.length]
    }

    /// Adds the derivative of by_u·u + by_v·v at sample j by (X, ω) to `row`; `by_u` and `by_v` are derivatives by
    /// the d motions and velocities.
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

/// y ← y + a x.
fn axpy(a: f64, x: &[f64], y: &mut [f64]) {
    if a != 0.0 {
        for (y, x) in y.iter_mut().zip(x) {
            *y += a * x;
        }
    }
}

/// Derivatives of states and forces by (X, ω) at a fixed start of the period, and by the states at that start.
///
/// The start depends on (X, ω) too, in a way that is known after the march only; its share of all sums follows from the
/// derivatives by the start. Rows have d·m + 1 numbers for (X, ω), and s for the start.
pub(super) struct Sensitivity {
    states: usize,
    /// Number d of directions.
    directions: usize,
    /// Length d·m + 1 of a row of derivatives by (X, ω).
    width: usize,
    /// Derivatives of the states at the start of the period by (X, ω), in rows of d·m + 1.
    start: Vec<f64>,
    /// Derivatives of the states at the start of the previous march.
    before: Vec<f64>,
    /// Derivatives of the states at the current sample; and at the next one.
    now: Vec<f64>,
    next: Vec<f64>,
    /// Derivatives of the forces at the samples of a batch.
    force: Vec<f64>,
    /// Fourier sums of the derivatives of the force, without weights, signal after signal.
    sums: Vec<f64>,
    column: Vec<f64>,
}

impl Sensitivity {
    pub fn new(directions: usize, states: usize, length: usize) -> Result<Self> {
        let width = directions.saturating_mul(length).saturating_add(1);
        let memory = |n: usize| try_vec(n, 0.0, "a march over samples");
        let start = || memory(states.saturating_mul(width));
        let row = width.saturating_add(states);
        let rows = |n: usize| memory(n.saturating_mul(row));
        let (force, mut sums) = (
            rows(directions.saturating_mul(BATCH))?,
            rows(directions.saturating_mul(length))?,
        );
        // The first product of a thread asks for memory; those of an iteration must not.
        let (basis, columns) = (memory(BATCH.saturating_mul(length))?, directions.saturating_mul(row));
        add_outer_products((&basis, length), (&force, columns, columns), BATCH, &mut sums);
        Ok(Self {
            states,
            directions,
            width,
            start: start()?,
            before: start()?,
            now: rows(states)?,
            next: rows(states)?,
            force,
            sums,
            column: memory(states)?,
        })
    }

    /// Length of a row of derivatives.
    fn row(&self) -> usize {
        self.width + self.states
    }

    /// Sets the derivatives of the start after a straight load from zero to the last sample, which is the first step
    /// of `march`.
    pub fn load(&mut self, march: &March, signals: &Signals, omega: f64) {
        self.start.fill(0.0);
        let (d, last) = (signals.directions, signals.samples - 1);
        for (a, row) in self.start.chunks_exact_mut(self.width).enumerate() {
            let block = a * d..(a + 1) * d;
            signals.add(last, omega, &march.dz.u[block.clone()], &march.dz.v[block], row);
            row[self.width - 1] += march.dz.omega[a];
        }
    }

    /// Sets the derivatives of the start that returns, from those of the march followed last; see
    /// [`crate::aft::periodic_state`].
    pub fn periodic(&mut self, map: &ReturnMap) {
        std::mem::swap(&mut self.start, &mut self.before);
        let row = self.row();
        for column in 0..self.width {
            map.start_column((&self.now, row), (&self.before, self.width), column, &mut self.column);
            for (start, value) in self.start.chunks_exact_mut(self.width).zip(&self.column) {
                start[column] = *value;
            }
        }
    }

    /// Takes the derivatives at the end of the last march as those of the next start.
    pub fn onward(&mut self) {
        std::mem::swap(&mut self.start, &mut self.before);
        let (row, width) = (self.row(), self.width);
        for (start, end) in self.start.chunks_exact_mut(width).zip(self.now.chunks_exact(row)) {
            start.copy_from_slice(&end[..width]);
            for (factor, before) in end[width..].iter().zip(self.before.chunks_exact(width)) {
                axpy(*factor, before, start);
            }
        }
    }

    /// Follows the states through the period, and with `sums` adds up the Fourier sums of the derivatives of the
    /// force.
    pub fn pass(
        &mut self,
        march: &March,
        signals: &Signals,
        omega: f64,
        sums: bool,
        interrupt: &Interrupt<'_>,
    ) -> Result<()> {
        let (d, s, n, width, row) = (signals.directions, self.states, signals.samples, self.width, self.row());
        self.now.fill(0.0);
        self.now[width..].iter_mut().step_by(row + 1).for_each(|x| *x = 1.0);
        if sums {
            self.sums.fill(0.0);
        }
        for j in 0..n {
            if j % BATCH == 0 {
                interrupt.check_before((BATCH * row * (s * s + self.directions * signals.length)) as u64)?;
            }
            let before = if j == 0 { n - 1 } else { j - 1 };
            for a in 0..s {
                let to = &mut self.next[a * row..(a + 1) * row];
                to.fill(0.0);
                let steps = &march.dz.z[(j * s + a) * s..(j * s + a + 1) * s];
                for (factor, state) in steps.iter().zip(self.now.chunks_exact(row)) {
                    axpy(*factor, state, to);
                }
                let block = (j * s + a) * d..(j * s + a + 1) * d;
                let from = (&march.dz.u_before[block.clone()], &march.dz.v_before[block.clone()]);
                signals.add(before, omega, from.0, from.1, &mut to[..width]);
                signals.add(
                    j,
                    omega,
                    &march.dz.u[block.clone()],
                    &march.dz.v[block],
                    &mut to[..width],
                );
                to[width - 1] += march.dz.omega[j * s + a];
            }
            std::mem::swap(&mut self.now, &mut self.next);
            if sums {
                self.force_at(march, signals, omega, j);
                if (j + 1) % BATCH == 0 || j + 1 == n {
                    let batch = j - j % BATCH..j + 1;
                    let columns = self.directions * row;
                    add_outer_products(
                        (
                            &signals.basis[batch.start * signals.length..batch.end * signals.length],
                            signals.length,
                        ),
                        (&self.force[..batch.len() * columns], columns, columns),
                        batch.len(),
                        &mut self.sums,
                    );
                }
            }
        }
        Ok(())
    }

    /// Computes the derivatives of the force at sample j.
    fn force_at(&mut self, march: &March, signals: &Signals, omega: f64, j: usize) {
        let (d, s, row) = (signals.directions, self.states, self.row());
        let slot = j % BATCH;
        for i in 0..self.directions {
            let to = &mut self.force[(slot * self.directions + i) * row..(slot * self.directions + i + 1) * row];
            to.fill(0.0);
            let by_state = &march.df_dz[(j * d + i) * s..(j * d + i + 1) * s];
            for (factor, state) in by_state.iter().zip(self.now.chunks_exact(row)) {
                axpy(*factor, state, to);
            }
            let block = (j * d + i) * d..(j * d + i + 1) * d;
            let to = &mut to[..self.width];
            signals.add(j, omega, &march.df_du[block.clone()], &march.df_dv[block], to);
        }
    }

    /// Adds the Fourier sums of the derivatives of the force, the effect of the start included, to `out`, without
    /// their weights.
    pub fn add_to(&mut self, signals: &Signals, out: &mut Evaluation) {
        let (d, m, row, width) = (signals.directions, signals.length, self.row(), self.width);
        for i in 0..self.directions {
            let sums = &mut self.sums[i * row * m..(i + 1) * row * m];
            let (fixed, by_start) = sums.split_at_mut(width * m);
            for (start, by_start) in self.start.chunks_exact(width).zip(by_start.chunks_exact(m.max(1))) {
                for (sum, factor) in fixed.chunks_exact_mut(m.max(1)).zip(start) {
                    axpy(*factor, by_start, sum);
                }
            }
            for (column, sum) in fixed.chunks_exact(m.max(1)).enumerate() {
                let to = match out.jacobian.get_mut(column * d * m..(column + 1) * d * m) {
                    Some(to) => to,
                    None => &mut out.by_omega,
                };
                axpy(1.0, sum, &mut to[i * m..(i + 1) * m]);
            }
        }
    }
}
