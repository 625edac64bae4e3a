//! The motions that the differences of a wheel's sectors feel, wave by wave.
//!
//! With the scale S of stiffness, products Δ̃g = S^−½ Δ S^−½ g of the differences with random vectors are transformed over the sectors,
//! and their parts in wave p are made orthonormal columns b̃_p until new ones add nothing. Then Δ = F b D bᴴ Fᴴ with b = S^½ b̃ and
//! D = cᴴ Fᴴ Δ F c, c = S^−½ b̃.

use crate::condense::tuned_wheel::tuned_ring::Random;
use crate::error::{Result, try_push, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::sparse_storage::sparse::Csc;
use crate::linalg::{inner, remove};
use core::f64::consts::TAU;
use num_complex::Complex64;

const CONTEXT: &str = "the tuned wheel";

/// Part of a product beyond the basis, over the largest one, that is rounding.
/// Kind: rounding.
const FELT: f64 = 1e-12;

/// Random vectors in a row that add nothing until the basis is complete.
/// Kind: tuned; measured on: not recorded.
const CONVINCED: usize = 2;

/// Unknowns of all low-rank terms up to which these take less time than factors of the wheel.
/// Kind: cap; their matrix is full.
const MOST_TUNED_TERMS: usize = 1_500;

/// Orthonormal motions of each wave, as many in each.
#[derive(Debug)]
pub struct TunedBasis {
    /// Number of sectors N; then degrees of freedom of a sector, and motions of each wave.
    pub sectors: usize,
    pub order: usize,
    pub rank: usize,
    /// Motions b and c, wave after wave, column after column.
    pub motions: Vec<Complex64>,
    dual: Vec<Complex64>,
    /// Roots e^(−2πi k/N), k = 0 .. N − 1.
    roots: Vec<Complex64>,
}

impl TunedBasis {
    /// The motions on which the `differing` matrices of all sectors act; `None` where they are too many.
    ///
    /// # Errors
    /// `OutOfMemory`; `StoppedByCaller`.
    pub fn new(differing: &[Csc], sectors: usize, scale: &[f64], interrupt: &Interrupt<'_>) -> Result<Option<Self>> {
        let order = scale.len();
        let mut roots = try_vec(sectors, Complex64::ONE, CONTEXT)?;
        for (k, root) in roots.iter_mut().enumerate() {
            *root = Complex64::cis(-TAU * k as f64 / sectors as f64);
        }
        let mut found: Vec<Vec<Complex64>> = Vec::new();
        for _ in 0..=sectors / 2 {
            try_push(&mut found, Vec::new(), CONTEXT)?;
        }
        for a in differing.iter().filter(|a| !a.values.is_empty()) {
            let mut random = Random::default();
            let mut without_gain = 0;
            while without_gain < CONVINCED {
                interrupt.check_before((a.values.len() + sectors * sectors * order) as u64)?;
                let (parts, size) = random_product(a, scale, &mut random)?;
                if !size.is_finite() {
                    return Ok(None);
                }
                without_gain += 1;
                for part in parts {
                    if add_waves((&part, FELT * size), &roots, (order, &mut found))? {
                        without_gain = 0;
                    }
                }
                let rank = found.iter().map(|q| q.len() / order).max().unwrap_or(0);
                if rank * sectors > MOST_TUNED_TERMS || rank >= order {
                    return Ok(None);
                }
            }
        }
        let rank = found.iter().map(|q| q.len() / order).max().unwrap_or(0);
        let mut motions = try_vec(sectors * rank * order, Complex64::ZERO, CONTEXT)?;
        let mut dual = try_vec(motions.len(), Complex64::ZERO, CONTEXT)?;
        for p in 0..sectors {
            let q = &found[p.min(sectors - p)];
            for (k, q) in q.iter().enumerate() {
                let q = if 2 * p > sectors { q.conj() } else { *q };
                let (at, root) = (p * rank * order + k, scale[k % order].sqrt());
                (motions[at], dual[at]) = (q * root, q / root);
            }
        }
        Ok(Some(Self {
            sectors,
            order,
            rank,
            motions,
            dual,
            roots,
        }))
    }

    /// Motions b of wave p, column after column.
    pub fn of_wave(&self, p: usize) -> &[Complex64] {
        &self.motions[p * self.rank * self.order..][..self.rank * self.order]
    }

    /// D of a matrix of all sectors: its projection on the motions.
    pub fn of(&self, a: &Csc, interrupt: &Interrupt<'_>) -> Result<Vec<Complex64>> {
        let (sectors, n, r) = (self.sectors, self.order, self.rank);
        let all = sectors * r;
        let mut d = try_vec(all * all, Complex64::ZERO, CONTEXT)?;
        if a.values.is_empty() || r == 0 {
            return Ok(d);
        }
        let unit = 1.0 / (sectors as f64).sqrt();
        let mut x = try_vec(sectors * n, Few::default(), CONTEXT)?;
        let mut y = try_vec(sectors * n, Few::default(), CONTEXT)?;
        let mut wave = try_vec(n, Few::default(), CONTEXT)?;
        for (few, d) in d.chunks_mut(FEW * all).enumerate() {
            interrupt.check_before((FEW * (a.values.len() + sectors * sectors * n)) as u64)?;
            for (column, k) in (few * FEW..).take(d.len() / all).zip(0..) {
                let (q, c) = (column / r, &self.dual[column * n..(column + 1) * n]);
                for (s, x) in x.chunks_exact_mut(n).enumerate() {
                    let root = self.roots[q * s % sectors].conj() * unit;
                    for (x, c) in x.iter_mut().zip(c) {
                        x[k] = root * c;
                    }
                }
            }
            multiply_few(a, &x, &mut y);
            for p in 0..sectors {
                wave.fill(Few::default());
                for (s, y) in y.chunks_exact(n).enumerate() {
                    let root = self.roots[p * s % sectors] * unit;
                    for (wave, y) in wave.iter_mut().zip(y) {
                        add_multiple(wave, root, y);
                    }
                }
                for (row, c) in (p * r..).zip(self.dual[p * r * n..(p + 1) * r * n].chunks_exact(n)) {
                    let mut sum = Few::default();
                    for (c, wave) in c.iter().zip(&wave) {
                        add_multiple(&mut sum, c.conj(), wave);
                    }
                    for (d, sum) in d.chunks_exact_mut(all).zip(&sum) {
                        d[row] = *sum;
                    }
                }
            }
        }
        Ok(d)
    }
}

/// Columns that pass through a matrix together: its entries come from memory once for all of them.
/// Kind: block.
const FEW: usize = 8;

/// One row of a block of columns.
type Few = [Complex64; FEW];

/// sum ← sum + factor x, for one row of a block of columns.
fn add_multiple(sum: &mut Few, factor: Complex64, x: &Few) {
    for (sum, x) in sum.iter_mut().zip(x) {
        *sum += factor * x;
    }
}

/// Y ← A X, for a block of columns.
fn multiply_few(a: &Csc, x: &[Few], y: &mut [Few]) {
    y.fill(Few::default());
    for (j, x) in x.iter().enumerate() {
        for (i, v) in a.column(j) {
            add_multiple(&mut y[i], v, x);
        }
    }
}

/// The real and the imaginary part of S^−½ Δ S^−½ g with a random g, and the size of both: the smaller one may be rounding.
fn random_product(a: &Csc, scale: &[f64], random: &mut Random) -> Result<(Vec<Vec<f64>>, f64)> {
    let n = scale.len();
    let mut x = try_vec(a.rows, Complex64::ZERO, CONTEXT)?;
    for (k, x) in x.iter_mut().enumerate() {
        *x = (random.next() / scale[k % n].sqrt()).into();
    }
    let mut y = try_vec(a.rows, Complex64::ZERO, CONTEXT)?;
    a.multiply_add(Complex64::ONE, &x, &mut y);
    let mut parts = Vec::new();
    let takes: [fn(&Complex64) -> f64; 2] = [|z| z.re, |z| z.im];
    for take in takes {
        let mut part = try_vec(a.rows, 0.0, CONTEXT)?;
        for (k, (part, y)) in part.iter_mut().zip(&y).enumerate() {
            *part = take(y) / scale[k % n].sqrt();
        }
        try_push(&mut parts, part, CONTEXT)?;
    }
    let size = parts.iter().flatten().map(|x| x * x).sum::<f64>().sqrt();
    Ok((parts, size))
}

/// Adds the parts of a motion in each wave to the columns of that wave, unless they are combinations of these up to
/// rounding; returns whether one was added.
fn add_waves(
    (motion, rounding): (&[f64], f64),
    roots: &[Complex64],
    (n, found): (usize, &mut [Vec<Complex64>]),
) -> Result<bool> {
    let norm = |x: &[Complex64]| x.iter().map(Complex64::norm_sqr).sum::<f64>().sqrt();
    let mut gains = false;
    for (p, q) in found.iter_mut().enumerate() {
        let mut wave = try_vec(n, Complex64::ZERO, CONTEXT)?;
        for (s, motion) in motion.chunks_exact(n).enumerate() {
            let root = roots[p * s % roots.len()];
            for (wave, x) in wave.iter_mut().zip(motion) {
                *wave += root * x;
            }
        }
        // Twice is enough; a third time where little is left.
        for _ in 0..3 {
            for q in q.chunks_exact(n) {
                let part = inner(q, &wave);
                remove(&mut wave, q, part);
            }
        }
        let rest = norm(&wave);
        if rest <= rounding || rest.is_nan() {
            continue;
        }
        gains = true;
        for _ in 0..2 {
            let rest = norm(&wave);
            for x in &mut wave {
                *x /= rest;
            }
            for q in q.chunks_exact(n) {
                let part = inner(q, &wave);
                remove(&mut wave, q, part);
            }
        }
        let rest = norm(&wave);
        for x in wave {
            try_push(q, x / rest, CONTEXT)?;
        }
    }
    Ok(gains)
}
