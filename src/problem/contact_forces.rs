//! The contact forces of all relative coordinates at one packed motion, with their Jacobians: what
//! every problem with contacts needs of the laws.

use crate::aft::{Evaluation, Evaluator};
use crate::condense::Condensed;
use crate::contact::Law;
use crate::error::{Result, try_push, try_vec};
use crate::harmonics::HarmonicSet;
use num_complex::Complex64;

/// Added to the diagonal of the means in Newton's matrix, not in the residual. A slipping contact
/// does not resist a mean motion; where nothing else does, as for a ring free to turn, the mean is
/// indeterminate and the matrix singular. With the floor it stays where it started.
const MEAN_FLOOR: f64 = 1e-8;

/// Forces f of all laws, summed per relative coordinate, at the motion evaluated last.
pub struct ContactForces<'a> {
    condensed: &'a Condensed,
    evaluator: Evaluator,
    factor: f64,
    laws: Vec<Law>,
    law: Evaluation,
    /// Per coordinate: sums over its laws, and whether all of them stick.
    sums: Vec<Evaluation>,
    stuck: Vec<bool>,
    slip_fractions: Vec<f64>,
}

impl<'a> ContactForces<'a> {
    /// The laws of a condensed model; `samples` = 0 locates events exactly.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(condensed: &'a Condensed, samples: usize) -> Result<Self> {
        let set = condensed.set();
        let coordinates = condensed.coordinates();
        let mut sums = Vec::new();
        for _ in 0..coordinates {
            try_push(&mut sums, Evaluation::new(set, 1)?, "the contact forces")?;
        }
        let mut laws = Vec::new();
        for placed in condensed.laws() {
            try_push(&mut laws, placed.law, "the contacts")?;
        }
        // A linear problem has no contact to evaluate, and its harmonics need not be a comb.
        let linear = coordinates == 0;
        let comb = if linear { &HarmonicSet::all(0)? } else { set };
        Ok(Self {
            condensed,
            evaluator: Evaluator::new(comb, if linear { 0 } else { samples })?,
            factor: 1.0,
            slip_fractions: try_vec(laws.len(), 0.0, "the contacts")?,
            laws,
            law: Evaluation::new(comb, 1)?,
            sums,
            stuck: try_vec(coordinates, false, "the contacts")?,
        })
    }

    /// Sees every law at an amplitude `factor` times smaller; see [`Law::eased`].
    pub fn ease(&mut self, factor: f64) {
        if self.factor.to_bits() == factor.to_bits() {
            return;
        }
        self.factor = factor;
        for (law, placed) in self.laws.iter_mut().zip(self.condensed.laws()) {
            *law = placed.law.eased(factor);
        }
    }

    /// Evaluates all laws at packed motions, coordinate after coordinate.
    pub fn evaluate(&mut self, motion: &[f64]) {
        let set = self.condensed.set();
        let m = set.packed_len();
        for sum in &mut self.sums {
            sum.force.fill(0.0);
            sum.jacobian.fill(0.0);
            sum.offset.fill(0.0);
        }
        self.stuck.fill(true);
        let mut prepared = usize::MAX;
        for (k, placed) in self.condensed.laws().iter().enumerate() {
            let c = placed.coordinate;
            let packed = &motion[c * m..(c + 1) * m];
            if prepared != c {
                self.evaluator.prepare(set, packed);
                prepared = c;
            }
            self.evaluator.evaluate(&self.laws[k], set, packed, &mut self.law);
            self.slip_fractions[k] = self.law.slip_fraction;
            self.stuck[c] &= self.law.stuck;
            let sum = &mut self.sums[c];
            add(&mut sum.force, &self.law.force);
            add(&mut sum.jacobian, &self.law.jacobian);
            add(&mut sum.offset, &self.law.offset);
        }
    }

    /// Share of the period that each law slips.
    #[must_use]
    pub fn slip_fractions(&self) -> &[f64] {
        &self.slip_fractions
    }

    /// Whether every law is linear at the motion evaluated last.
    #[must_use]
    pub fn all_stuck(&self) -> bool {
        self.stuck.iter().all(|s| *s)
    }

    /// Whether a coordinate sticks and its reference stiffness is that of the stuck contact: then
    /// f = κ y, and nothing couples back.
    #[must_use]
    pub fn drops_out(&self, coordinate: usize) -> bool {
        self.stuck[coordinate] && self.condensed.may_drop_out(coordinate)
    }

    /// w = f − κ y of a coordinate in the i-th carried harmonic.
    #[must_use]
    pub fn minus_reference(&self, motion: &[f64], coordinate: usize, i: usize) -> Complex64 {
        let set = self.condensed.set();
        let m = set.packed_len();
        let y = set.get(&motion[coordinate * m..(coordinate + 1) * m], i);
        set.get(&self.sums[coordinate].force, i) - self.condensed.kappa(coordinate, i) * y
    }

    /// Packed force of a coordinate.
    #[must_use]
    pub fn force(&self, coordinate: usize) -> &[f64] {
        &self.sums[coordinate].force
    }

    /// ∂f/∂ln s of a coordinate in the i-th carried harmonic, where s is the factor of
    /// [`Self::ease`].
    #[must_use]
    pub fn by_ease(&self, coordinate: usize, i: usize) -> Complex64 {
        self.condensed.set().get(&self.sums[coordinate].offset, i)
    }

    /// Change of w in the i-th carried harmonic along a change of the motion.
    #[must_use]
    pub fn along(&self, direction: &[f64], coordinate: usize, i: usize) -> Complex64 {
        let set = self.condensed.set();
        let m = set.packed_len();
        let du = &direction[coordinate * m..(coordinate + 1) * m];
        let mut dw = -self.condensed.kappa(coordinate, i) * set.get(du, i);
        for (column, d) in self.sums[coordinate].jacobian.chunks_exact(m).zip(du) {
            dw += self.entry(column, i) * d;
        }
        dw
    }

    /// The i-th carried harmonic of a packed column of a Jacobian.
    fn entry(&self, column: &[f64], i: usize) -> Complex64 {
        self.condensed.set().get(column, i)
    }

    /// Adds g·(∂f/∂y − κ) of harmonic i to the rows of coordinate `row` and the columns of
    /// coordinate `column` of a Jacobian with `n` rows.
    pub fn couple(&self, i: usize, (row, column): (usize, usize), g: Complex64, jacobian: &mut [f64], n: usize) {
        let set = self.condensed.set();
        let m = set.packed_len();
        let at = set.offset(i);
        let mean = set.numbers()[i] == 0;
        let r = row * m + at;
        let gk = g * self.condensed.kappa(column, i);
        for q in 0..m {
            let j = &self.sums[column].jacobian[q * m..(q + 1) * m];
            let target = &mut jacobian[(column * m + q) * n..];
            if mean {
                target[r] += g.re * j[at];
            } else {
                let dz = g * Complex64::new(j[at], j[at + 1]);
                target[r] += dz.re;
                target[r + 1] += dz.im;
            }
        }
        let diagonal = (column * m + at) * n + r;
        jacobian[diagonal] -= gk.re;
        if mean && row == column {
            jacobian[diagonal] += MEAN_FLOOR;
        }
        if !mean {
            jacobian[diagonal + 1] -= gk.im;
            jacobian[diagonal + n] += gk.im;
            jacobian[diagonal + n + 1] -= gk.re;
        }
    }

    /// Adds Re(g·∂w/∂y) of harmonic i and coordinate `column` to one row of a Jacobian with `n`
    /// rows.
    pub fn couple_scalar(&self, i: usize, (row, column): (usize, usize), g: Complex64, jacobian: &mut [f64], n: usize) {
        let set = self.condensed.set();
        let m = set.packed_len();
        for q in 0..m {
            let j = &self.sums[column].jacobian[q * m..(q + 1) * m];
            jacobian[(column * m + q) * n + row] += (g * self.entry(j, i)).re;
        }
        let gk = g * self.condensed.kappa(column, i);
        let at = column * m + set.offset(i);
        jacobian[at * n + row] -= gk.re;
        if set.numbers()[i] != 0 {
            jacobian[(at + 1) * n + row] += gk.im;
        }
    }

    /// The factor of [`Self::ease`] from which on the given motion is (nearly) that of linear
    /// springs.
    pub fn sticking_factor(&mut self, motion: &[f64]) -> f64 {
        let set = self.condensed.set();
        let m = set.packed_len();
        let mut largest = 0.0_f64;
        for placed in self.condensed.laws() {
            let c = placed.coordinate;
            let motion = &motion[c * m..(c + 1) * m];
            self.evaluator.prepare(set, motion);
            let mean = if set.has_mean() { motion[0] } else { 0.0 };
            let (range, reference) = (self.evaluator.half_range(set), self.condensed.stiffness(c));
            largest = largest.max(placed.law.sticking_factor(range, mean, reference));
        }
        largest
    }
}

fn add(sum: &mut [f64], term: &[f64]) {
    for (s, t) in sum.iter_mut().zip(term) {
        *s += t;
    }
}
