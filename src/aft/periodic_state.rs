//! The initial states of a marched period that return after it.
//!
//! One march maps the states z at the start to those at the end, with the derivative P, the product of the
//! derivatives of the steps. Where a load erases memory, P shrinks, and Newton's step solves (I − P) δ = z_end − z.
//! Where nothing slips P = I: any state returns, and the marched one is kept. The general case has the projector Π
//! onto the part that P does not change, P Π = Π P = Π; then
//!
//! > (I − P + Π) δ = z_end − z
//!
//! is Newton's step outside it and one more march within it. The same matrix determines the derivative of the
//! periodic start: (I − P + Π) S = q + Π S_before with q the derivative of the march at a fixed start and S_before
//! that of the start marched from.

use crate::contact::forms::march::March;
use crate::error::{Result, Status, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::factors::lu::Lu;

/// Squarings in the search for Π; a part that decays by less than 1e-10 per period counts as kept.
/// Kind: cap.
const SQUARINGS: usize = 40;

/// Products of steps between two checks of the interrupt.
/// Kind: block.
const TOGETHER: usize = 16;

/// Largest size of Π that is no projection.
/// Kind: rounding.
const NOTHING: f64 = 1e-9;

/// Linearised map of the states over one period.
pub(super) struct ReturnMap {
    states: usize,
    /// Derivative P of the states at the end by those at the start, row-major.
    p: Vec<f64>,
    /// Projector Π onto the states that return unchanged, row-major.
    kept: Vec<f64>,
    scratch: Vec<f64>,
    /// LU factors of I − P + Π.
    factors: Lu<f64>,
    /// Whether Π is not zero.
    pub has_kept: bool,
    /// Whether I − P + Π could be factored.
    pub is_regular: bool,
}

impl ReturnMap {
    pub fn new(states: usize) -> Result<Self> {
        let memory = || try_vec(states.saturating_mul(states), 0.0, "a map over a period");
        Ok(Self {
            states,
            p: memory()?,
            kept: memory()?,
            scratch: memory()?,
            factors: Lu::new(states, 1)?,
            has_kept: false,
            is_regular: false,
        })
    }

    /// Forms P, Π and the factors from the steps of a march.
    pub fn form(&mut self, march: &March, samples: usize, interrupt: &Interrupt<'_>) -> Result<()> {
        let s = self.states;
        let of_product = 2 * (s * s * s) as u64;
        unit(s, &mut self.p);
        unit(s, &mut self.kept);
        for (j, step) in march.dz.z[..samples * s * s].chunks_exact((s * s).max(1)).enumerate() {
            if j % TOGETHER == 0 {
                interrupt.check_before(TOGETHER as u64 * of_product)?;
            }
            // Stick keeps all states.
            if step == self.kept {
                continue;
            }
            product(s, step, &self.p, &mut self.scratch);
            std::mem::swap(&mut self.p, &mut self.scratch);
        }
        interrupt.check_before(of_product)?;
        self.project();
        let matrix = self.factors.matrix();
        for row in 0..s {
            for column in 0..s {
                let unit = if row == column { 1.0 } else { 0.0 };
                matrix[column * s + row] = unit - self.p[row * s + column] + self.kept[row * s + column];
            }
        }
        let factored = self.factors.factor(interrupt);
        self.is_regular = factored.is_ok();
        match factored {
            Err(e) if e.status == Status::StoppedByCaller => Err(e),
            _ => Ok(()),
        }
    }

    /// Computes Π = lim ((I + P)/2)^(2ⁿ): the mean with I keeps an eigenvalue of 1 and damps all others on the unit
    /// circle, −1 among them.
    fn project(&mut self) {
        let s = self.states;
        unit(s, &mut self.kept);
        for (kept, p) in self.kept.iter_mut().zip(&self.p) {
            *kept = 0.5 * (*kept + p);
        }
        for _ in 0..SQUARINGS {
            product(s, &self.kept, &self.kept, &mut self.scratch);
            std::mem::swap(&mut self.kept, &mut self.scratch);
            let size = largest(&self.kept);
            let change = self
                .kept
                .iter()
                .zip(&self.scratch)
                .fold(0.0, |m: f64, (a, b)| m.max((a - b).abs()));
            // Further squaring of a projector would only amplify round-off.
            if size < NOTHING || size.is_nan() || size > NOTHING.recip() || change < 1e-13 * size {
                break;
            }
        }
        let size = largest(&self.kept);
        self.has_kept = size >= NOTHING && size <= NOTHING.recip();
        if !self.has_kept {
            self.kept.fill(0.0);
        }
    }

    /// b ← δ = (I − P + Π)⁻¹ b.
    pub fn solve(&self, b: &mut [f64]) {
        self.factors.solve(b);
    }

    /// Column `column` of S = (I − P + Π)⁻¹ (q + Π S_before), into `solved`; q and S_before are row-major with the length
    /// of their rows.
    pub fn start_column(
        &self,
        (q, of_q): (&[f64], usize),
        (before, of_before): (&[f64], usize),
        column: usize,
        solved: &mut [f64],
    ) {
        for (row, value) in solved.iter_mut().enumerate() {
            *value = q[row * of_q + column];
            for k in 0..self.states {
                *value += self.kept[row * self.states + k] * before[k * of_before + column];
            }
        }
        self.factors.solve(solved);
    }
}

/// Largest modulus of some values; NaN if any value is NaN.
pub(super) fn largest(values: &[f64]) -> f64 {
    values
        .iter()
        .fold(0.0, |m, x| if x.abs() > m || x.is_nan() { x.abs() } else { m })
}

fn unit(n: usize, a: &mut [f64]) {
    a.fill(0.0);
    a.iter_mut().step_by(n + 1).for_each(|x| *x = 1.0);
}

/// c ← a b for n × n matrices, row-major.
fn product(n: usize, a: &[f64], b: &[f64], c: &mut [f64]) {
    for (row, out) in a.chunks_exact(n.max(1)).zip(c.chunks_exact_mut(n.max(1))) {
        out.fill(0.0);
        for (factor, line) in row.iter().zip(b.chunks_exact(n)) {
            for (o, l) in out.iter_mut().zip(line) {
                *o += factor * l;
            }
        }
    }
}
