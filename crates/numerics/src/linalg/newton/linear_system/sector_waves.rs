//! Factors of the part of a matrix that a wheel of equal sectors would have: a preconditioner of one with unequal sectors.
//!
//! The unknowns are the groups of one sector after another. Where a wave of the wheel moves sector s + 1 as sector s but for a
//! factor λ of modulus 1 in each pair of numbers, the unknowns y_s = Λˢ ỹ_s make the matrix of equal sectors circulant, and a
//! Fourier transform over the sectors,
//!
//! > ŷ_p = Σ_s ỹ_s e^{−2πi ps/N},  B_p ŷ_p = b̂_p,  p = 0 .. N/2,
//!
//! leaves a block B_p of the order of one sector for each wave p. Those of 0 and N/2 are real, the others complex, and those beyond
//! N/2 conjugate. The border of the matrix is eliminated with these factors.

#![allow(clippy::inline_always, reason = "compiled for the instructions of the caller")]

use crate::error::{Result, Status, try_push, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::factors::lu::Lu;
use crate::linalg::newton::linear_system::eliminated_border::EliminatedBorder;
use crate::linalg::newton::linear_system::{Border, MatrixFree, Ring};
use core::f64::consts::TAU;
use num_complex::Complex64;
use pulp::{Arch, Simd, WithSimd};

const CONTEXT: &str = "the linear system of a wheel";

/// Factors of the block of one wave.
enum Wave {
    Real(Lu<f64>),
    Complex(Lu<Complex64>),
    /// No factors, since the block is singular; the identity is used.
    Singular,
}

/// Factors of all waves of a wheel, with memory.
pub(super) struct RingFactors {
    sectors: usize,
    /// Length of a group, and number of unknowns of a sector.
    group: usize,
    order: usize,
    /// Roots e^{−2πi k/N}, k = 0 .. N − 1.
    roots: Vec<Complex64>,
    /// Factors Λˢ of each sector, pair after pair.
    turns: Vec<Complex64>,
    waves: Vec<Wave>,
    matrix: Vec<Complex64>,
    spectrum: Vec<Complex64>,
    local: Vec<f64>,
    border: EliminatedBorder,
}

impl RingFactors {
    /// Memory for `n` unknowns in groups of equal length.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(n: usize, group: usize, ring: Ring<'_>) -> Result<Self> {
        let order = n / ring.sectors.max(1);
        let mut turns = try_vec(ring.sectors * ring.lags.len(), Complex64::ONE, CONTEXT)?;
        for (i, lag) in ring.lags.iter().enumerate() {
            for s in 0..ring.sectors {
                turns[s * ring.lags.len() + i] = Complex64::cis(lag.arg() * s as f64);
            }
        }
        let mut roots = try_vec(ring.sectors, Complex64::ONE, CONTEXT)?;
        for (k, root) in roots.iter_mut().enumerate() {
            *root = Complex64::cis(-TAU * k as f64 / ring.sectors as f64);
        }
        let mut waves = Vec::new();
        for p in 0..=ring.sectors / 2 {
            let wave = if p == 0 || 2 * p == ring.sectors {
                Wave::Real(Lu::new(order, 1)?)
            } else {
                Wave::Complex(Lu::new(order, 1)?)
            };
            try_push(&mut waves, wave, CONTEXT)?;
        }
        Ok(Self {
            sectors: ring.sectors,
            group,
            order,
            roots,
            turns,
            matrix: try_vec(order.saturating_mul(order), Complex64::ZERO, CONTEXT)?,
            spectrum: try_vec(order * waves.len(), Complex64::ZERO, CONTEXT)?,
            waves,
            local: try_vec(order, 0.0, CONTEXT)?,
            border: EliminatedBorder::new(n)?,
        })
    }

    /// Factors the waves of a Jacobian.
    ///
    /// # Errors
    /// `OutOfMemory`; `StoppedByCaller`.
    pub fn factor(&mut self, operator: &mut dyn MatrixFree, interrupt: &Interrupt<'_>) -> Result<()> {
        for p in 0..self.waves.len() {
            interrupt.check()?;
            operator.fill_ring(p, &mut self.matrix)?;
            let mut wave = if p == 0 || 2 * p == self.sectors {
                Wave::Real(match core::mem::replace(&mut self.waves[p], Wave::Singular) {
                    Wave::Real(known) => known,
                    _ => Lu::new(self.order, 1)?,
                })
            } else {
                Wave::Complex(match core::mem::replace(&mut self.waves[p], Wave::Singular) {
                    Wave::Complex(known) => known,
                    _ => Lu::new(self.order, 1)?,
                })
            };
            let factored = match &mut wave {
                Wave::Real(lu) => {
                    for (to, from) in lu.matrix().iter_mut().zip(&self.matrix) {
                        *to = from.re;
                    }
                    lu.factor(interrupt)
                }
                Wave::Complex(lu) => {
                    lu.matrix().copy_from_slice(&self.matrix);
                    lu.factor(interrupt)
                }
                Wave::Singular => Ok(()),
            };
            self.waves[p] = match factored {
                Err(e) if e.status == Status::Singular => Wave::Singular,
                factored => factored.map(|()| wave)?,
            };
        }
        Ok(())
    }

    /// Takes over the border of the bordered matrix.
    pub fn set_border(&mut self, border: Border<'_>) {
        let mut column = self.border.column(border);
        self.solve_inner(&mut column);
        self.border.set(border, column);
    }

    /// v ← M⁻¹ v with M = [B s_u, r s_p; tᵀ].
    pub fn solve(&mut self, v: &mut [f64]) {
        let n = v.len() - 1;
        self.solve_inner(&mut v[..n]);
        self.border.solve(v);
    }

    /// Whether det M is positive. Complex waves come in conjugate pairs.
    pub fn is_positive(&self) -> bool {
        let real = self.waves.iter().filter(|wave| match wave {
            Wave::Real(lu) => !lu.is_positive(),
            Wave::Complex(_) | Wave::Singular => false,
        });
        real.count().is_multiple_of(2) == self.border.keeps_sign()
    }

    /// u ← B⁻¹ u.
    fn solve_inner(&mut self, u: &mut [f64]) {
        Arch::new().dispatch(Inner { factors: self, u });
    }
}

/// Computes u ← B⁻¹ u, compiled for the vector instructions of the processor.
struct Inner<'a> {
    factors: &'a mut RingFactors,
    u: &'a mut [f64],
}

impl WithSimd for Inner<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _simd: S) {
        self.factors.by_waves(self.u);
    }
}

impl RingFactors {
    #[inline(always)]
    fn by_waves(&mut self, u: &mut [f64]) {
        let (n, order) = (self.sectors, self.order);
        self.spectrum.fill(Complex64::ZERO);
        for (s, of_sector) in u.chunks_exact(order).enumerate() {
            self.local.copy_from_slice(of_sector);
            turn(&mut self.local, self.group, &self.turns, s, n, true);
            for (p, sums) in self.spectrum.chunks_exact_mut(order).enumerate() {
                let root = self.roots[p * s % n];
                for (sum, x) in sums.iter_mut().zip(&self.local) {
                    *sum += root * x;
                }
            }
        }
        for (wave, b) in self.waves.iter().zip(self.spectrum.chunks_exact_mut(order)) {
            match wave {
                Wave::Real(lu) => {
                    // Real but for rounding.
                    for (x, b) in self.local.iter_mut().zip(&*b) {
                        *x = b.re;
                    }
                    lu.solve(&mut self.local);
                    for (b, x) in b.iter_mut().zip(&self.local) {
                        *b = Complex64::from(*x);
                    }
                }
                Wave::Complex(lu) => lu.solve(b),
                Wave::Singular => {}
            }
        }
        for (s, of_sector) in u.chunks_exact_mut(order).enumerate() {
            self.local.fill(0.0);
            for (p, waves) in self.spectrum.chunks_exact(order).enumerate() {
                // A complex wave stands for its conjugate, too.
                let share = if p == 0 || 2 * p == n { 1.0 } else { 2.0 } / n as f64;
                let root = self.roots[p * s % n].conj() * share;
                for (x, z) in self.local.iter_mut().zip(waves) {
                    *x += root.re * z.re - root.im * z.im;
                }
            }
            turn(&mut self.local, self.group, &self.turns, s, n, false);
            of_sector.copy_from_slice(&self.local);
        }
    }
}

/// Multiplies the pairs in the groups of sector s by Λˢ, or if `back` by its inverse.
fn turn(x: &mut [f64], group: usize, turns: &[Complex64], s: usize, sectors: usize, back: bool) {
    let pairs = turns.len() / sectors;
    let turns = &turns[s * pairs..(s + 1) * pairs];
    for group in x.chunks_exact_mut(group) {
        let first = group.len() % 2;
        for (pair, turn) in group[first..].chunks_exact_mut(2).zip(turns) {
            let turn = if back { turn.conj() } else { *turn };
            let z = turn * Complex64::new(pair[0], pair[1]);
            (pair[0], pair[1]) = (z.re, z.im);
        }
    }
}

#[cfg(test)]
#[path = "sector_waves_tests.rs"]
mod tests;
