//! Newton's matrix of a forced response by its contacts, J = D + G F with the flexibility G. Wheels have the identity D, but for the
//! floors of means, and F = ∂f/∂y − κ has a low rank where contacts slip for a part of the period; for other structures see
//! [`ContactBase`].

use crate::error::{Result, boxed, try_extend, try_push};
use crate::interrupt::Interrupt;
use crate::linalg::dense::complex_columns;
use crate::linalg::newton::linear_system::Forces;
use crate::problem::contact_base::ContactBase;
use crate::problem::harmonic_balance::HarmonicBalance;
use crate::problem::parametric_problem::put;

const CONTEXT: &str = "the rank of contacts";

impl Forces for HarmonicBalance<'_> {
    fn groups(&self) -> usize {
        self.condensed.coordinates()
    }

    fn unlikeness(&mut self) -> Result<f64> {
        self.forces.interrupt().check()?;
        let ring = self.products.ring.as_mut();
        Ok(ring.map_or(0.0, |ring| ring.unlikeness(self.condensed, &self.forces)))
    }

    fn begin(&mut self, interrupt: &Interrupt<'_>) -> Result<bool> {
        if self.products.ring.is_some() {
            return Ok(true);
        }
        let base = match &mut self.products.base {
            Some(base) => base,
            none => none.insert(boxed(|| ContactBase::new(self.condensed))?),
        };
        base.factor(self.condensed, &self.forces, self.tables.current(), interrupt)
    }

    fn rows(&mut self, force: usize, rows: &mut Vec<f64>, motions: &mut Vec<usize>) -> Result<f64> {
        self.forces.interrupt().check()?;
        rows.clear();
        if self.forces.is_eliminated(force) {
            return Ok(0.0);
        }
        let set = self.condensed.set();
        let m = set.packed_len();
        let mut stiffness = 0.0_f64;
        for (by, block) in self.forces.blocks_of_force(force) {
            let first = rows.len();
            try_extend(rows, block, CONTEXT)?;
            try_push(motions, by, CONTEXT)?;
            stiffness = block.iter().fold(stiffness, |m, x| m.max(x.abs()));
            if by != force {
                continue;
            }
            let own = &mut rows[first..];
            for (i, &number) in set.numbers().iter().enumerate() {
                let (at, kappa) = (set.offset(i), self.condensed.kappa(force, i));
                stiffness = stiffness.max(kappa.norm());
                let kappa = match &self.products.base {
                    Some(base) => base.of(self.condensed, force, i),
                    None => kappa,
                };
                own[at * m + at] -= kappa.re;
                if number > 0 {
                    own[at * m + at + 1] -= kappa.im;
                    own[(at + 1) * m + at] += kappa.im;
                    own[(at + 1) * m + at + 1] -= kappa.re;
                }
            }
        }
        Ok(stiffness)
    }

    fn response_of(&mut self, force: usize, w: &[f64], u: &mut [f64]) -> Result<()> {
        self.forces.interrupt().check()?;
        let set = self.condensed.set();
        if let Some(base) = &self.products.base {
            base.response_of(set, force, w, u);
            return Ok(());
        }
        let (m, coordinates) = (set.packed_len(), self.condensed.coordinates());
        u.fill(0.0);
        for (i, table) in self.tables.current().iter().enumerate() {
            let (at, mean, z) = (set.offset(i), set.numbers()[i] == 0, set.get(w, i));
            let column = &table.value[force * (coordinates + 1)..][..coordinates];
            for (u, g) in u.chunks_exact_mut(m).zip(column) {
                put(u, at, mean, g * z);
            }
        }
        self.divide(u);
        Ok(())
    }

    fn subtract_response(&mut self, w: &[f64], u: &mut [f64]) -> Result<()> {
        let set = self.condensed.set();
        if let Some(base) = &mut self.products.base {
            base.subtract_response(set, w, u);
            return Ok(());
        }
        let (m, coordinates) = (set.packed_len(), self.condensed.coordinates());
        let (sum, [z, memory]) = (&mut self.memory.sum[..], &mut self.products.harmonic);
        for (i, table) in self.tables.current().iter().enumerate() {
            let (at, mean) = (set.offset(i), set.numbers()[i] == 0);
            for (z, w) in z.iter_mut().zip(w.chunks_exact(m)) {
                *z = set.get(w, i);
            }
            complex_columns::multiply(&table.value, coordinates + 1, z, sum, memory);
            for (c, sum) in sum.iter().enumerate() {
                let response = if mean {
                    sum / (1.0 + self.forces.mean_floor(c))
                } else {
                    *sum
                };
                put(u, c * m + at, mean, -response);
            }
        }
        Ok(())
    }

    fn divide(&mut self, u: &mut [f64]) {
        let set = self.condensed.set();
        if let Some(base) = &mut self.products.base {
            return base.divide(set, u);
        }
        if set.has_mean() {
            for (c, mean) in u.iter_mut().step_by(set.packed_len()).enumerate() {
                *mean /= 1.0 + self.forces.mean_floor(c);
            }
        }
    }
}

#[cfg(test)]
#[path = "contact_rank_tests.rs"]
mod tests;
