//! Poles of one wave of the structure under any damping, by which the flexibility at any frequency is a sum.
//!
//! The undamped modes of the Hermitian part A of K_κ, M φ = μ A φ, φᴴ M φ = 1, Ω = μ^(−1/2), make
//!
//! > Z_κ = s² + s C̃ + Ω² + Ẽ,  C̃ = Φᴴ C Φ,  Ẽ = Φᴴ (K_κ − A) Φ,  s = ihω,
//!
//! with Ẽ of structural damping and of what is not Hermitian. In energy coordinates z = (Ω p, s p) this is linear,
//!
//! > (s − A) z = (0, Φᴴ F),  A = [[0, Ω], [−Ω − Ẽ Ω⁻¹, −C̃]],
//!
//! skew but for damping, so that its poles are well conditioned (Tisseur & Meerbergen, SIAM Review 43, 2001,
//! doi:10.1137/S0036144500381988, §3). With A = X Λ X⁻¹ the flexibility is Σ x_j l_j/(s − λ_j). A Newton step on Z_κ makes each λ as
//! exact as its own size, where the QR iteration leaves an error of the size of the stiffest. Motions without mass follow
//! statically. A real κ is that of the reference stiffness; its imaginary part is of low rank, see [`crate::condense::by_modes::low_rank`].
//!
//! With a speed Ω = pω the matrices of ω² join M: M − p²K₁/h² − ipG/h.

use crate::condense::blocks::harmonic_block::{Artificial, HarmonicBlock};
use crate::condense::by_modes::wave_poles::{Key, WavePoles};
use crate::condense::on_a_basis::basis_outlook::{MOST_POLE_WORK, are_all_poles_quicker};
use crate::condense::{Condensed, FlexibilityWay};
use crate::error::{Result, Status, try_copy, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::dense::complex_products::{self, multiply_adjoint};
use crate::linalg::dense::general_eigen;
use crate::linalg::factors::factor::is_dense;
use crate::linalg::factors::lu::Lu;
use crate::linalg::iterative::refined_modes::{self, dense};
use crate::linalg::libraries::DMatrix;
use crate::options::Range;
use num_complex::Complex64;
use std::sync::Arc;

const CONTEXT: &str = "the poles of the structure";

/// Work of a complex matrix over that of a real one.
/// Kind: tuned; measured on: not recorded.
const WORK_OF_COMPLEX: f64 = 3.0;

/// μ over the largest below which a motion has no mass.
/// Kind: rounding.
const MASSLESS_MOTION: f64 = 1e-14;

/// Force of damping on a motion, over the sum of its terms, that is rounding.
/// Kind: rounding.
const UNDAMPED: f64 = 1e-12;

/// Largest condition of a pole: sums lose as many digits.
/// Kind: tuned; measured on: not recorded.
const MOST_CONDITION: f64 = 1e4;

/// Largest relative change of a pole by its Newton step.
/// Kind: tuned; measured on: not recorded.
const MOST_CHANGE: f64 = 1e-6;

/// The poles of the i-th carried harmonic, or the reason why it has none; along a range, where that is known, factors may be quicker.
pub(crate) fn poles(
    condensed: &Condensed,
    i: usize,
    range: Option<Range>,
    interrupt: &Interrupt<'_>,
) -> Result<core::result::Result<WavePoles, FlexibilityWay>> {
    const UNSUITABLE: FlexibilityWay = FlexibilityWay::Unsuitable;
    let block = &condensed.blocks()[i];
    let is_forced = matches!(block.matrices.artificial, Artificial::None);
    if block.number == 0 || !is_forced {
        return Ok(Err(UNSUITABLE));
    }
    if let Some(reason) = factors_are_quicker(condensed, block, range, interrupt)? {
        return Ok(Err(reason));
    }
    let Some(wave) = Undamped::new(condensed, i, interrupt)? else {
        return Ok(Err(UNSUITABLE));
    };
    let key = Key {
        matrices: (
            Arc::clone(&block.matrices.reference),
            Arc::clone(&block.matrices.mass),
            Arc::clone(&block.matrices.damping),
        ),
        modal: block.matrices.modal.clone(),
        tied: block.matrices.tied.as_ref().map(|_| block.number),
    };
    Ok(wave.poles(key, interrupt)?.ok_or(UNSUITABLE))
}

/// Whether these poles belong to a block: same matrices and same harmonic, where that matters.
pub(crate) fn are_of(poles: &WavePoles, block: &HarmonicBlock) -> bool {
    let (reference, mass, damping) = &poles.key.matrices;
    let is_same = |a: &Arc<Vec<Complex64>>, b: &Arc<Vec<Complex64>>| Arc::ptr_eq(a, b) || a == b;
    let has_stiffness = Arc::ptr_eq(reference, &block.matrices.reference)
        || (reference.col_ptr == block.matrices.reference.col_ptr
            && reference.row_idx == block.matrices.reference.row_idx
            && reference.values == block.matrices.reference.values);
    poles.key.tied == block.matrices.tied.as_ref().map(|_| block.number)
        && has_stiffness
        && is_same(mass, &block.matrices.mass)
        && is_same(damping, &block.matrices.damping)
        && poles.key.modal == block.matrices.modal
}

/// Work of computing the poles of a wave: order³, times a factor for complex matrices.
fn work(condensed: &Condensed, block: &HarmonicBlock) -> f64 {
    let real = |values: &[Complex64]| values.iter().all(|z| z.im == 0.0);
    let directions = block.matrices.modal.iter().flat_map(|all| all.iter());
    let is_real = block.matrices.structural.is_none()
        && block.matrices.tied.is_none()
        && real(&block.matrices.stiffness)
        && real(&block.matrices.damping)
        && real(&block.matrices.mass)
        && directions.flatten().all(|(_, z)| z.im == 0.0);
    let order = 2.0 * condensed.ndof() as f64;
    order.powi(3) * if is_real { 1.0 } else { WORK_OF_COMPLEX }
}

/// The reason to take factors where the poles of a wave take more than a second or longer than the factorisations of
/// a sweep; else `None`.
fn factors_are_quicker(
    condensed: &Condensed,
    block: &HarmonicBlock,
    range: Option<Range>,
    interrupt: &Interrupt<'_>,
) -> Result<Option<FlexibilityWay>> {
    let work = work(condensed, block);
    if work > MOST_POLE_WORK {
        return Ok(Some(FlexibilityWay::Many));
    }
    if is_dense(&block.matrices.reference)? {
        return Ok(None);
    }
    // A wave serves all harmonics unless their speeds differ.
    let mut tables = condensed.tables_of_sweep(range, interrupt)?;
    if block.matrices.tied.is_some() {
        tables.harmonics = 1;
    }
    let are_quicker = are_all_poles_quicker(&block.matrices.reference, work, tables)?;
    Ok((!are_quicker).then_some(FlexibilityWay::Sparse))
}

/// One wave in the modes of its undamped part.
struct Undamped {
    n: usize,
    /// μ of the motions with mass; and the shapes φ of all motions, those without mass first.
    masses: Vec<f64>,
    shapes: Vec<Complex64>,
    /// Projected damping C̃ and Ẽ of the motions with mass, column after column.
    damping: Vec<Complex64>,
    rest: Vec<Complex64>,
}

impl Undamped {
    fn new(condensed: &Condensed, i: usize, interrupt: &Interrupt<'_>) -> Result<Option<Self>> {
        let (n, block) = (condensed.ndof(), &condensed.blocks()[i]);
        let pattern = &block.matrices.reference;
        let mut stiffness = condensed.stiffness_with_real_kappa(i)?;
        let structural = block.matrices.structural.iter().flat_map(|values| values.iter());
        for (v, d) in stiffness.values.iter_mut().zip(structural) {
            *v += Complex64::I * d;
        }
        let mass = inertia(block)?;
        let mut hermitian = stiffness.try_clone()?;
        for j in 0..n {
            for at in hermitian.col_ptr[j]..hermitian.col_ptr[j + 1] {
                let other = stiffness.get(j, hermitian.row_idx[at]).conj();
                hermitian.values[at] = 0.5 * (hermitian.values[at] + other);
            }
        }
        let mut rest = stiffness;
        for (rest, own) in rest.values.iter_mut().zip(&hermitian.values) {
            *rest -= own;
        }
        let rest = dense(pattern, &rest.values)?;
        let pairs = match refined_modes::modes(&hermitian, &mass, interrupt) {
            Ok(pairs) if pairs.values.len() == n => pairs,
            Err(e) if matches!(e.status, Status::OutOfMemory | Status::StoppedByCaller) => return Err(e),
            _ => return Ok(None),
        };
        let largest = pairs.values.last().copied().unwrap_or(0.0);
        if largest <= 0.0 || pairs.values[0] < -MASSLESS_MOTION * largest {
            return Ok(None);
        }
        let massless = pairs.values.partition_point(|&mu| mu <= MASSLESS_MOTION * largest);
        let masses = try_copy(&pairs.values[massless..], CONTEXT)?;
        let mut shapes: Vec<Complex64> = pairs.vectors.data.into();
        for (shape, mu) in shapes[massless * n..].chunks_exact_mut(n).zip(&masses) {
            let scale = mu.sqrt().recip();
            for z in shape {
                *z *= scale;
            }
        }
        let mut damping = dense(pattern, &block.matrices.damping)?;
        for direction in block.matrices.modal.iter().flat_map(|all| all.iter()) {
            for &(j, b) in direction {
                for &(i, a) in direction {
                    damping[(i, j)] += a * b.conj();
                }
            }
        }
        let heavy = &shapes[massless * n..];
        for matrix in [&damping, &rest] {
            // A motion without mass that is damped would have a pole of first order.
            if massless > 0 && is_damped(matrix, &shapes[..massless * n]) {
                return Ok(None);
            }
        }
        Ok(Some(Self {
            n,
            damping: projected(&damping, heavy, interrupt)?,
            rest: projected(&rest, heavy, interrupt)?,
            masses,
            shapes,
        }))
    }

    /// Computes the poles and their vectors; `None` where one is badly conditioned.
    fn poles(&self, key: Key, interrupt: &Interrupt<'_>) -> Result<Option<WavePoles>> {
        let m = self.masses.len();
        let order = 2 * m;
        let mut frequencies = try_copy(&self.masses, CONTEXT)?;
        for omega in &mut frequencies {
            *omega = omega.sqrt().recip();
        }
        let mut a = try_vec(order * order, Complex64::ZERO, CONTEXT)?;
        for (j, omega) in frequencies.iter().enumerate() {
            let (left, right) = (j * order, (m + j) * order);
            a[left + m + j] = (-omega).into();
            a[right + j] = (*omega).into();
            for i in 0..m {
                a[left + m + i] -= self.rest[j * m + i] / omega;
                a[right + m + i] = -self.damping[j * m + i];
            }
        }
        let found = match general_eigen::eigen(&a, order, interrupt) {
            Err(e) if e.status == Status::NoConvergence => return Ok(None),
            found => found?,
        };
        let Some(adjoints) = self.adjoints(&found.vectors, interrupt)? else {
            return Ok(None);
        };
        // p from the half of z in which it has more digits.
        let mut motions = try_vec(order * m, Complex64::ZERO, CONTEXT)?;
        for (to, (z, value)) in motions
            .chunks_exact_mut(m)
            .zip(found.vectors.chunks_exact(order).zip(&found.values))
        {
            for (k, to) in to.iter_mut().enumerate() {
                *to = if value.norm() > frequencies[k] {
                    z[m + k] / value
                } else {
                    z[k] / frequencies[k]
                };
            }
        }
        let Some(values) = self.refined((&found.values, &frequencies), &motions, &adjoints)? else {
            return Ok(None);
        };
        self.on_the_structure(key, (&values, &motions, &adjoints)).map(Some)
    }

    /// Second half of each row of X⁻¹, so that the sum over all poles is exact also where some are equal; `None`
    /// where one is badly conditioned.
    fn adjoints(&self, vectors: &[Complex64], interrupt: &Interrupt<'_>) -> Result<Option<Vec<Complex64>>> {
        let m = self.masses.len();
        let order = 2 * m;
        let mut lu = Lu::new(order, order)?;
        lu.matrix().copy_from_slice(vectors);
        match lu.factor(interrupt) {
            Err(e) if e.status == Status::Singular => return Ok(None),
            factored => factored?,
        }
        let mut inverse = try_vec(order * order, Complex64::ZERO, CONTEXT)?;
        for k in 0..order {
            inverse[k * order + k] = Complex64::ONE;
        }
        lu.solve_columns(&mut inverse, false, interrupt)?;
        let mut adjoints = try_vec(order * m, Complex64::ZERO, CONTEXT)?;
        for j in 0..order {
            let row = || (0..order).map(|k| inverse[k * order + j]);
            // The columns of X have size 1.
            let condition = row().map(|z| z.norm_sqr()).sum::<f64>();
            if condition > MOST_CONDITION * MOST_CONDITION || condition.is_nan() {
                return Ok(None);
            }
            for (to, z) in adjoints[j * m..].iter_mut().zip(row().skip(m)) {
                *to = z;
            }
        }
        Ok(Some(adjoints))
    }

    /// Poles after one Newton step, λ − l Z(λ) p/(l Z′(λ) p); `None` where a step is not small.
    fn refined(
        &self,
        (values, frequencies): (&[Complex64], &[f64]),
        motions: &[Complex64],
        adjoints: &[Complex64],
    ) -> Result<Option<Vec<Complex64>>> {
        let m = frequencies.len();
        let damped = times(&self.damping, motions, m)?;
        let rest = times(&self.rest, motions, m)?;
        let mut refined = try_vec(values.len(), Complex64::ZERO, CONTEXT)?;
        for (j, (to, value)) in refined.iter_mut().zip(values).enumerate() {
            let at = j * m..(j + 1) * m;
            let (mut residual, mut slope) = (Complex64::ZERO, Complex64::ZERO);
            for (k, omega) in at.zip(frequencies) {
                let (p, c) = (motions[k], damped[k]);
                // λ² + Ω² as a product keeps its digits near ±iΩ.
                let i_omega = Complex64::new(0.0, *omega);
                let inertia = (value - i_omega) * (value + i_omega) * p;
                residual += adjoints[k] * (inertia + value * c + rest[k]);
                slope += adjoints[k] * (2.0 * value * p + c);
            }
            let change = residual / slope;
            if change.norm() > MOST_CHANGE * value.norm() || change.is_nan() {
                return Ok(None);
            }
            *to = value - change;
        }
        Ok(Some(refined))
    }

    /// Poles with vectors over the degrees of freedom, ordered by 1/|λ|.
    fn on_the_structure(
        &self,
        key: Key,
        (values, motions, adjoints): (&[Complex64], &[Complex64], &[Complex64]),
    ) -> Result<WavePoles> {
        let (n, m) = (self.n, self.masses.len());
        let massless = n - m;
        let count = massless + values.len();
        let mut ranked = try_vec(values.len(), 0, CONTEXT)?;
        for (k, rank) in ranked.iter_mut().enumerate() {
            *rank = k;
        }
        ranked.sort_unstable_by(|&a, &b| values[b].norm().total_cmp(&values[a].norm()));
        let mut sorted = [
            try_vec(values.len() * m, Complex64::ZERO, CONTEXT)?,
            try_vec(values.len() * m, Complex64::ZERO, CONTEXT)?,
        ];
        let mut inverse = try_vec(count, Complex64::ZERO, CONTEXT)?;
        for (to, &j) in ranked.iter().enumerate() {
            let mu = values[j].inv();
            inverse[massless + to] = mu;
            for k in 0..m {
                sorted[0][to * m + k] = -mu * motions[j * m + k];
                sorted[1][to * m + k] = adjoints[j * m + k].conj();
            }
        }
        // With l over the modes, l Φᴴ F = (Φ l̄)ᴴ F.
        let heavy = &self.shapes[massless * n..];
        let [shapes, adjoints] = sorted.each_ref().map(|of| -> Result<Vec<Complex64>> {
            let mut all = try_vec(count * n, Complex64::ZERO, CONTEXT)?;
            all[..massless * n].copy_from_slice(&self.shapes[..massless * n]);
            complex_products::multiply(heavy, of, &mut all[massless * n..], n);
            Ok(all)
        });
        Ok(WavePoles {
            key,
            values: inverse,
            shapes: shapes?,
            adjoints: adjoints?,
        })
    }
}

/// Whether a matrix acts on some of the `motions`, beyond rounding.
fn is_damped(matrix: &DMatrix<Complex64>, motions: &[Complex64]) -> bool {
    let n = matrix.nrows();
    motions.chunks_exact(n).any(|x| {
        let (mut force, mut terms) = (0.0_f64, 0.0_f64);
        for row in matrix.row_iter() {
            let products = || row.iter().zip(x).map(|(a, x)| a * x);
            force = force.max(products().sum::<Complex64>().norm());
            terms = terms.max(products().map(Complex64::norm).sum());
        }
        force > UNDAMPED * terms
    })
}

/// Values of M plus the matrices of a tied speed that grow with ω².
fn inertia(block: &HarmonicBlock) -> Result<Vec<Complex64>> {
    let mut mass = try_copy(&block.matrices.mass, CONTEXT)?;
    if let Some(tied) = &block.matrices.tied {
        let h = block.number as f64;
        for ((m, k), g) in mass.iter_mut().zip(&tied.stiffness).zip(&tied.gyroscopic) {
            *m -= k / (h * h) + Complex64::I * g / h;
        }
    }
    Ok(mass)
}

/// Product A X for a square matrix A of order n.
fn times(a: &[Complex64], x: &[Complex64], n: usize) -> Result<Vec<Complex64>> {
    let mut product = try_vec(x.len(), Complex64::ZERO, CONTEXT)?;
    complex_products::multiply(a, x, &mut product, n);
    Ok(product)
}

/// Projected matrix Φᴴ A Φ, column after column.
fn projected(a: &DMatrix<Complex64>, shapes: &[Complex64], interrupt: &Interrupt<'_>) -> Result<Vec<Complex64>> {
    let n = a.nrows();
    let count = shapes.len() / n.max(1);
    let mut found = try_vec(count * count, Complex64::ZERO, CONTEXT)?;
    if a.iter().any(|z| *z != Complex64::ZERO) {
        interrupt.check()?;
        multiply_adjoint(shapes, &times(a.as_slice(), shapes, n)?, &mut found, n);
    }
    Ok(found)
}

#[cfg(test)]
#[path = "quadratic_poles_tests.rs"]
mod tests;
