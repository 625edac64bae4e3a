//! The mean over the sectors of a whole wheel of Newton's matrix, each sector in its own time: what a wheel of equal sectors would
//! have, wave by wave.
//!
//! Sector s + 1 of a tuned wheel moves as sector s but for λ_h = e^{−2πi h EO/N} in harmonic h, y_s = Λˢ ỹ_s. In these ỹ the mean
//! Jacobian of the contacts minus κ is one matrix A of a sector, and the mean flexibility of harmonic h from a sector to the d-th
//! after it is
//!
//! > g_d = 1/N Σ_s λ^{−d} G_{s+d, s},
//!
//! so that wave p has the block B_p = I + (Σ_d g_d e^{−2πi pd/N}) A, in which the real and the imaginary part of g_d act on pairs of
//! real numbers.

use crate::condense::Condensed;
use crate::error::{Result, try_push, try_vec};
use crate::linalg::dot;
use crate::linalg::newton::linear_system::Ring;
use crate::problem::contact_forces::ContactForces;
use core::f64::consts::TAU;
use num_complex::Complex64;

const CONTEXT: &str = "the waves of a wheel";

/// The sectors of a wheel, with memory for the means of Newton's matrix over them.
pub(super) struct RingBlocks {
    sectors: usize,
    /// Coordinates of a sector, and length of a packed signal.
    coordinates: usize,
    m: usize,
    /// Phase factor λ of each carried harmonic, and of each vibrating one.
    lags: Vec<Complex64>,
    pairs: Vec<Complex64>,
    /// Mean Jacobian A; and per coordinate the mean of the terms added to the diagonal of its mean motion.
    jacobian: Vec<f64>,
    floors: Vec<f64>,
    /// Mean flexibility g_d: harmonic after harmonic, distance after distance, force after force.
    flexibility: Vec<Complex64>,
    /// Memory: one block ∂f/∂y of a contact.
    block: Vec<f64>,
    /// Share of the contact Jacobians in which sectors differ from A; `None` where A does not belong to the motion
    /// evaluated last.
    unlikeness: Option<f64>,
}

impl RingBlocks {
    /// Memory for a condensed model; `None` where it is no wheel, or the contacts of its sectors differ.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(condensed: &Condensed) -> Result<Option<Self>> {
        let Some((sectors, engine_order)) = condensed.wheel() else {
            return Ok(None);
        };
        let all = condensed.coordinates();
        if condensed.has_exchanges() || all == 0 || !all.is_multiple_of(sectors) || !are_alike(condensed, sectors) {
            return Ok(None);
        }
        let set = condensed.set();
        let (coordinates, m) = (all / sectors, set.packed_len());
        let (mut lags, mut pairs) = (Vec::new(), Vec::new());
        for &number in set.numbers() {
            let waves = (number as i128 * i128::from(engine_order)).rem_euclid(sectors as i128);
            let lag = Complex64::cis(-TAU * waves as f64 / sectors as f64);
            try_push(&mut lags, lag, CONTEXT)?;
            if number > 0 {
                try_push(&mut pairs, lag, CONTEXT)?;
            }
        }
        let order = coordinates * m;
        Ok(Some(Self {
            flexibility: try_vec(
                lags.len() * sectors * coordinates * coordinates,
                Complex64::ZERO,
                CONTEXT,
            )?,
            sectors,
            coordinates,
            m,
            lags,
            pairs,
            jacobian: try_vec(order.saturating_mul(order), 0.0, CONTEXT)?,
            floors: try_vec(coordinates, 0.0, CONTEXT)?,
            block: try_vec(m * m, 0.0, CONTEXT)?,
            unlikeness: None,
        }))
    }

    /// The sectors with the factors of their pairs.
    pub fn ring(&self) -> Ring<'_> {
        Ring {
            sectors: self.sectors,
            lags: &self.pairs,
        }
    }

    /// Computes the means at the motion where the forces were evaluated last; `flexibility` returns G of a harmonic,
    /// force after force at a distance of `stride`.
    pub fn average<'g>(
        &mut self,
        (condensed, forces): (&Condensed, &ContactForces<'_>),
        (flexibility, stride): (impl Fn(usize) -> &'g [Complex64], usize),
    ) {
        let (n, k) = (self.sectors, self.coordinates);
        self.unlikeness(condensed, forces);
        self.floors.fill(0.0);
        self.flexibility.fill(Complex64::ZERO);
        let share = 1.0 / n as f64;
        for c in (0..n * k).filter(|&c| !forces.is_eliminated(c)) {
            self.floors[c % k] += share * forces.mean_floor(c);
        }
        for (i, lag) in self.lags.iter().enumerate() {
            let table = flexibility(i);
            let of_harmonic = &mut self.flexibility[i * n * k * k..(i + 1) * n * k * k];
            for (d, mean) in of_harmonic.chunks_exact_mut(k * k).enumerate() {
                let turn = Complex64::cis(-lag.arg() * d as f64) * share;
                for s in 0..n {
                    let to = (s + d) % n * k;
                    for (j, mean) in mean.chunks_exact_mut(k).enumerate() {
                        let column = &table[(s * k + j) * stride + to..][..k];
                        for (mean, g) in mean.iter_mut().zip(column) {
                            *mean += turn * g;
                        }
                    }
                }
            }
        }
    }

    /// Marks the means as outdated: the forces are evaluated at another motion.
    pub fn forget(&mut self) {
        self.unlikeness = None;
    }

    /// Share, by the norm, in which the Jacobians of contacts minus κ differ between the sectors. A shift of time
    /// leaves squares unchanged, so that the squared differences sum to the squares of all minus those of the mean.
    pub fn unlikeness(&mut self, condensed: &Condensed, forces: &ContactForces<'_>) -> f64 {
        if let Some(known) = self.unlikeness {
            return known;
        }
        let (n, k) = (self.sectors, self.coordinates);
        self.jacobian.fill(0.0);
        let (share, mut squares) = (1.0 / n as f64, 0.0);
        for c in (0..n * k).filter(|&c| !forces.is_eliminated(c)) {
            squares += share * self.add_contact(condensed, forces, c, share);
        }
        let of_mean = dot(&self.jacobian, &self.jacobian);
        *self.unlikeness.insert((1.0 - of_mean / squares).max(0.0).sqrt())
    }

    /// Adds a share of the Jacobian of a coordinate minus κ, in the time of its sector; returns the sum of its squares.
    fn add_contact(&mut self, condensed: &Condensed, forces: &ContactForces<'_>, c: usize, share: f64) -> f64 {
        let (m, k, mut squares) = (self.m, self.coordinates, 0.0);
        let (s, j) = (c / k, c % k);
        let first = m % 2;
        for (by, block) in forces.blocks_of_force(c) {
            self.block.copy_from_slice(block);
            if by == c {
                for i in 0..self.lags.len() {
                    let (at, kappa) = (condensed.set().offset(i), condensed.kappa(c, i));
                    self.block[at * m + at] -= kappa.re;
                    if condensed.set().numbers()[i] > 0 {
                        self.block[(at + 1) * m + at + 1] -= kappa.re;
                        self.block[at * m + at + 1] -= kappa.im;
                        self.block[(at + 1) * m + at] += kappa.im;
                    }
                }
            }
            squares += dot(&self.block, &self.block);
            // Λ^{−s} J Λˢ: columns, then rows.
            for (i, lag) in self.pairs.iter().enumerate() {
                let turn = Complex64::cis(lag.arg() * s as f64);
                let at = first + 2 * i;
                let (a, b) = self.block[at * m..(at + 2) * m].split_at_mut(m);
                for (a, b) in a.iter_mut().zip(b) {
                    (*a, *b) = (*a * turn.re + *b * turn.im, *b * turn.re - *a * turn.im);
                }
            }
            for (i, lag) in self.pairs.iter().enumerate() {
                let turn = Complex64::cis(-lag.arg() * s as f64);
                let at = first + 2 * i;
                for column in self.block.chunks_exact_mut(m) {
                    let z = turn * Complex64::new(column[at], column[at + 1]);
                    (column[at], column[at + 1]) = (z.re, z.im);
                }
            }
            let (column, row) = (by % k * m, j * m);
            for (q, from) in self.block.chunks_exact(m).enumerate() {
                let to = &mut self.jacobian[(column + q) * k * m + row..][..m];
                for (to, x) in to.iter_mut().zip(from) {
                    *to += share * x;
                }
            }
        }
        squares
    }

    /// Fills in the mean matrix B_p of wave p, column-major.
    pub fn fill(&self, condensed: &Condensed, wave: usize, matrix: &mut [Complex64]) -> Result<()> {
        let (n, k, m) = (self.sectors, self.coordinates, self.m);
        let order = k * m;
        matrix.fill(Complex64::ZERO);
        for (r, diagonal) in matrix.iter_mut().step_by(order + 1).enumerate() {
            let is_mean = m % 2 == 1 && r % m == 0;
            *diagonal = Complex64::ONE + if is_mean { self.floors[r / m] } else { 0.0 };
        }
        // Transforms of the real and of the imaginary parts of g_d, force after force.
        let mut parts = try_vec(2 * k * k, Complex64::ZERO, CONTEXT)?;
        for i in 0..self.lags.len() {
            parts.fill(Complex64::ZERO);
            let (real, imaginary) = parts.split_at_mut(k * k);
            let of_harmonic = &self.flexibility[i * n * k * k..(i + 1) * n * k * k];
            for (d, mean) in of_harmonic.chunks_exact(k * k).enumerate() {
                let root = Complex64::cis(-TAU * (wave * d % n) as f64 / n as f64);
                for ((re, im), g) in real.iter_mut().zip(&mut *imaginary).zip(mean) {
                    *re += root * g.re;
                    *im += root * g.im;
                }
            }
            let at = condensed.set().offset(i);
            let is_mean = condensed.set().numbers()[i] == 0;
            for (to, from) in matrix.chunks_exact_mut(order).zip(self.jacobian.chunks_exact(order)) {
                for (force, w) in from.chunks_exact(m).enumerate() {
                    let (re, im) = (w[at], if is_mean { 0.0 } else { w[at + 1] });
                    if re == 0.0 && im == 0.0 {
                        continue;
                    }
                    let of_force = force * k..(force + 1) * k;
                    let coefficients = real[of_force.clone()].iter().zip(&imaginary[of_force]);
                    for (to, (a, b)) in to.chunks_exact_mut(m).zip(coefficients) {
                        to[at] += a * re - b * im;
                        if !is_mean {
                            to[at + 1] += b * re + a * im;
                        }
                    }
                }
            }
        }
        Ok(())
    }
}

/// Whether the contacts of each sector act on the coordinates of that sector alone, in the pattern of the first
/// sector.
fn are_alike(condensed: &Condensed, sectors: usize) -> bool {
    let (laws, k) = (condensed.laws(), condensed.coordinates() / sectors);
    if !laws.len().is_multiple_of(sectors) || !condensed.contacts().is_multiple_of(sectors) {
        return false;
    }
    let (of_sector, contacts) = (laws.len() / sectors, condensed.contacts() / sectors);
    laws.iter().enumerate().all(|(number, law)| {
        let (s, first) = (number / of_sector, &laws[number % of_sector]);
        law.contact == first.contact + s * contacts
            && law.coordinates.len() == first.coordinates.len()
            && law
                .coordinates
                .iter()
                .zip(&first.coordinates)
                .all(|(c, of_first)| *of_first < k && *c == of_first + s * k)
    })
}

#[cfg(test)]
#[path = "ring_blocks_tests.rs"]
mod tests;
