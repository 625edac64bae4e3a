//! Solutions with the matrix of a wheel by factors of the waves of the tuned wheel and a correction of low rank.
//!
//! With Z = F (Z⁰ + b D bᴴ) Fᴴ of [`TunedPlan`], F the transform over the sectors and G⁰ the inverse of Z⁰ = diag Z_p,
//!
//! > Z⁻¹ = F (G⁰ − G⁰ b (I + D bᴴG⁰b)⁻¹ D bᴴ G⁰) Fᴴ.
//!
//! G⁰ takes one factorisation of the order of a sector for each wave p = 0 .. N/2, whose transposes serve the waves that travel the
//! other way. The matrix in the middle has N times the rank of a sector's differences.

use crate::condense::tuned_wheel::tuned_plan::{TUNED_TERMS, TunedPlan};
use crate::error::{Result, try_copy, try_push, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::dense::complex_products::multiply;
use crate::linalg::factors::factor::Factor;
use crate::linalg::factors::lu::Lu;
use crate::linalg::inner;
use core::f64::consts::TAU;
use num_complex::Complex64;
use std::sync::Arc;

const CONTEXT: &str = "the factors of a tuned wheel";

/// Right sides that are transformed at a time.
/// Kind: block.
const RIGHT_SIDES: usize = 8;

/// Factors of the tuned wheel and of its correction, for one harmonic at a time.
pub struct TunedFactors {
    pub(crate) plan: Arc<TunedPlan>,
    /// Factors of the matrices Z_p of waves p = 0 to N/2.
    waves: Vec<Factor>,
    /// Z_p⁻¹ b for all waves.
    pub(crate) flexible: Vec<Complex64>,
    /// Middle matrix D of the low-rank differences.
    differences: Vec<Complex64>,
    /// Factors of I + D bᴴG⁰b.
    middle: Option<Lu<Complex64>>,
    /// Roots e^(−2πi k/N), k = 0 .. N − 1.
    roots: Vec<Complex64>,
    /// Right-hand sides transformed to waves.
    spectrum: Vec<Complex64>,
    columns: usize,
}

impl TunedFactors {
    /// Memory for the matrices of a plan, and for `columns` right-hand sides at a time.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(plan: &Arc<TunedPlan>, columns: usize) -> Result<Self> {
        let (sectors, n, r) = (plan.basis.sectors, plan.basis.order, plan.basis.rank);
        let mut roots = try_vec(sectors, Complex64::ONE, CONTEXT)?;
        for (k, root) in roots.iter_mut().enumerate() {
            *root = Complex64::cis(-TAU * k as f64 / sectors as f64);
        }
        Ok(Self {
            plan: Arc::clone(plan),
            waves: Vec::new(),
            flexible: try_vec(sectors * n * r, Complex64::ZERO, CONTEXT)?,
            differences: try_vec((sectors * r).saturating_mul(sectors * r), Complex64::ZERO, CONTEXT)?,
            middle: if r == 0 {
                None
            } else {
                Some(Lu::new(sectors * r, columns)?)
            },
            roots,
            spectrum: Vec::new(),
            columns,
        })
    }

    /// Factors the matrix of the i-th block: the sum of its terms, each times its factor. Returns the largest entry
    /// of the tuned wheel.
    ///
    /// # Errors
    /// `Singular` where the tuned wheel or the wheel is; `OutOfMemory`; `StoppedByCaller`.
    pub fn factor(&mut self, i: usize, factors: &[Complex64; TUNED_TERMS], interrupt: &Interrupt<'_>) -> Result<f64> {
        let plan = Arc::clone(&self.plan);
        let (sectors, ring) = (plan.basis.sectors, plan.ring(i));
        let means = plan.means(i, factors)?;
        let largest = means.iter().fold(0.0_f64, |m, z| m.max(z.norm()));
        let mut wave = ring.wave()?;
        for p in 0..=sectors / 2 {
            interrupt.check_before(means.len() as u64)?;
            ring.fill_wave(&means, (p, &self.roots), &mut wave);
            if self.waves.len() == p {
                try_push(&mut self.waves, Factor::new(&wave, self.columns)?, CONTEXT)?;
            }
            self.waves[p].factor(&wave, interrupt)?;
        }
        if plan.basis.rank > 0 {
            plan.differences(i, factors, &mut self.differences);
            self.factor_middle(interrupt)?;
        }
        Ok(largest)
    }

    /// Computes Z_p⁻¹ b for all waves, and factors I + D bᴴG⁰b.
    fn factor_middle(&mut self, interrupt: &Interrupt<'_>) -> Result<()> {
        let plan = Arc::clone(&self.plan);
        let (n, r) = (plan.basis.order, plan.basis.rank);
        let all = plan.basis.sectors * r;
        let mut flexible = core::mem::take(&mut self.flexible);
        flexible.copy_from_slice(&plan.basis.motions);
        let mut of_wave = try_vec(r * r, Complex64::ZERO, CONTEXT)?;
        let mut solved = Ok(());
        for (p, columns) in flexible.chunks_exact_mut(n * r).enumerate() {
            solved = solved.and_then(|()| self.solve_wave(p, columns, interrupt));
            self.along_basis(p, columns, &mut of_wave);
            if let Some(middle) = &mut self.middle {
                let to = &mut middle.matrix()[p * r * all..(p + 1) * r * all];
                multiply(&self.differences[p * r * all..(p + 1) * r * all], &of_wave, to, all);
            }
        }
        self.flexible = flexible;
        solved?;
        let Some(middle) = &mut self.middle else { return Ok(()) };
        for diagonal in middle.matrix().iter_mut().step_by(all + 1) {
            *diagonal += Complex64::ONE;
        }
        middle.factor(interrupt)
    }

    /// x̂ ← Z_p⁻¹ x̂ for columns x̂ of wave p.
    pub(crate) fn solve_wave(&mut self, p: usize, columns: &mut [Complex64], interrupt: &Interrupt<'_>) -> Result<()> {
        let sectors = self.plan.basis.sectors;
        let (of, transposed) = if 2 * p <= sectors {
            (p, false)
        } else {
            (sectors - p, true)
        };
        if columns.is_empty() {
            return Ok(());
        }
        self.waves[of].solve(columns, transposed, interrupt)
    }

    /// Products bᴴ x̂ for columns x̂ of wave p.
    pub(crate) fn along_basis(&self, p: usize, columns: &[Complex64], products: &mut [Complex64]) {
        let (n, r) = (self.plan.basis.order, self.plan.basis.rank);
        for (column, products) in columns.chunks_exact(n).zip(products.chunks_exact_mut(r.max(1))) {
            for (product, b) in products.iter_mut().zip(self.plan.basis.of_wave(p).chunks_exact(n)) {
                *product = inner(b, column);
            }
        }
    }

    /// Transform from waves to sectors, 1/N Σ_p x_p e^(2πi pd/N), for groups of `length` numbers.
    pub(crate) fn over_sectors(&self, of_waves: &[Complex64], length: usize) -> Result<Vec<Complex64>> {
        let sectors = self.plan.basis.sectors;
        let mut found = try_vec(of_waves.len(), Complex64::ZERO, CONTEXT)?;
        if length == 0 {
            return Ok(found);
        }
        for (d, found) in found.chunks_exact_mut(length).enumerate() {
            for (p, x) in of_waves.chunks_exact(length).enumerate() {
                let root = self.roots[p * d % sectors].conj() / sectors as f64;
                for (found, x) in found.iter_mut().zip(x) {
                    *found += root * x;
                }
            }
        }
        Ok(found)
    }

    /// Transform from sectors to waves, Σ_s x_s e^(−2πi ps/N), for groups of `length` numbers.
    pub(crate) fn over_waves(&self, of_sectors: &[Complex64], length: usize) -> Result<Vec<Complex64>> {
        let sectors = self.plan.basis.sectors;
        let mut found = try_vec(of_sectors.len(), Complex64::ZERO, CONTEXT)?;
        if length == 0 {
            return Ok(found);
        }
        for (p, found) in found.chunks_exact_mut(length).enumerate() {
            for (s, x) in of_sectors.chunks_exact(length).enumerate() {
                let root = self.roots[p * s % sectors];
                for (found, x) in found.iter_mut().zip(x) {
                    *found += root * x;
                }
            }
        }
        Ok(found)
    }

    /// The root e^(−2πi k/N).
    pub(crate) fn root(&self, k: usize) -> Complex64 {
        self.roots[k % self.plan.basis.sectors]
    }

    /// v ← (I + D bᴴG⁰b)⁻¹ D v for columns of N · rank numbers.
    pub(crate) fn correct(&mut self, v: &mut [Complex64], interrupt: &Interrupt<'_>) -> Result<()> {
        let Some(middle) = &mut self.middle else { return Ok(()) };
        let given = try_copy(v, CONTEXT)?;
        multiply(&self.differences, &given, v, middle.order());
        middle.solve_columns(v, false, interrupt)
    }

    /// Solves Z X = B in place for the columns of `b`. Since Z is symmetric, this also solves with its transpose.
    ///
    /// # Errors
    /// `Singular` when the solution is not finite; `OutOfMemory`; `StoppedByCaller`.
    pub fn solve(&mut self, b: &mut [Complex64], interrupt: &Interrupt<'_>) -> Result<()> {
        let (sectors, n) = (self.plan.basis.sectors, self.plan.basis.order);
        for columns in b.chunks_mut(RIGHT_SIDES * sectors * n) {
            self.solve_few(columns, interrupt)?;
        }
        Ok(())
    }

    fn solve_few(&mut self, b: &mut [Complex64], interrupt: &Interrupt<'_>) -> Result<()> {
        let (sectors, n, r) = (self.plan.basis.sectors, self.plan.basis.order, self.plan.basis.rank);
        let count = b.len() / (sectors * n);
        let mut spectrum = core::mem::take(&mut self.spectrum);
        if spectrum.len() < b.len() {
            spectrum = try_vec(b.len(), Complex64::ZERO, CONTEXT)?;
        }
        let of_waves = &mut spectrum[..b.len()];
        of_waves.fill(Complex64::ZERO);
        let mut along = try_vec(count * sectors * r, Complex64::ZERO, CONTEXT)?;
        for (p, columns) in of_waves.chunks_exact_mut(n * count).enumerate() {
            for (wave, b) in columns.chunks_exact_mut(n).zip(b.chunks_exact(sectors * n)) {
                for (s, b) in b.chunks_exact(n).enumerate() {
                    let root = self.roots[p * s % sectors];
                    for (wave, b) in wave.iter_mut().zip(b) {
                        *wave += root * b;
                    }
                }
            }
            self.solve_wave(p, columns, interrupt)?;
            for (k, column) in columns.chunks_exact(n).enumerate() {
                self.along_basis(p, column, &mut along[(k * sectors + p) * r..][..r]);
            }
        }
        self.correct(&mut along, interrupt)?;
        self.subtract_basis(of_waves, &along);
        for (column, b) in b.chunks_exact_mut(sectors * n).enumerate() {
            for (s, b) in b.chunks_exact_mut(n).enumerate() {
                b.fill(Complex64::ZERO);
                for p in 0..sectors {
                    let root = self.roots[p * s % sectors].conj() / sectors as f64;
                    for (b, wave) in b.iter_mut().zip(&of_waves[(p * count + column) * n..][..n]) {
                        *b += root * wave;
                    }
                }
            }
        }
        self.spectrum = spectrum;
        Ok(())
    }

    /// Subtracts Z_p⁻¹ b v from columns of all waves; v is stored column after column.
    fn subtract_basis(&self, of_waves: &mut [Complex64], v: &[Complex64]) {
        let (sectors, n, r) = (self.plan.basis.sectors, self.plan.basis.order, self.plan.basis.rank);
        if r == 0 {
            return;
        }
        let count = of_waves.len() / (sectors * n);
        for (column, v) in v.chunks_exact(sectors * r).enumerate() {
            for (p, (v, flexible)) in v.chunks_exact(r).zip(self.flexible.chunks_exact(n * r)).enumerate() {
                let x = &mut of_waves[(p * count + column) * n..][..n];
                for (v, flexible) in v.iter().zip(flexible.chunks_exact(n)) {
                    for (x, g) in x.iter_mut().zip(flexible) {
                        *x -= g * v;
                    }
                }
            }
        }
    }
}
