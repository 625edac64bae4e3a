//! Certificate of a structure on a basis: the estimated relative error of its motion under a unit force at each contact,
//! at the excitation and at the response, in the energy norm of A = K + σM.
//!
//! The residual b − Z V q has the norm ρ in A⁻¹, see [`crate::linalg::iterative::block_krylov`]. Motions that the basis lacks answer it
//! about statically, which gives ρ/‖q‖. A motion that the basis holds to a share of about ρ/‖q‖ answers it as near its
//! resonance as it is, which adds ‖Z⁻¹‖ (ρ/‖q‖)² with the inverse on the basis: near a resonance a small residual is an
//! error that is 1/(2ζ) times larger.
//!
//! A basis of samples has no residual at their frequencies. They lie beside those that are checked, which are then more: all resonances, and
//! the ends of equal intervals.
//!
//! Rounding enters in two ways, both measured when the basis is made. Solutions with the factor of A leave the basis by a share
//! ε_s, so that images of the basis are not quite in it: ‖Z q‖, ‖s M V q‖ and so on times ε_s belong to the residual. Products
//! of soft motions with A lose digits in the stiff ones; what is left of that, ε_p, is an error of the matrix on the basis, and
//! an error (1 + ‖Z⁻¹‖) ε_p of the motion, which no larger basis makes smaller.

use crate::condense::HarmonicBlock;
use crate::error::{Result, Status, try_copy, try_push, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::dense::complex_products::{multiply, multiply_adjoint};
use crate::linalg::dense::hermitian;
use crate::linalg::factors::lu::Lu;
use crate::linalg::iterative::block_krylov::SparseVector;
use crate::model::few_motions::reduced_wave::{ReducedView, Remainder, WaveDamping};
use crate::options::Range;
use num_complex::Complex64;

const CONTEXT: &str = "the certificate of the flexibility";

/// Largest number of resonances that are checked.
/// Kind: cap.
const RESONANCES: usize = 6;

/// Intervals of a range at whose ends a basis of samples is checked beside its resonances.
/// Kind: tuned; measured on: chains of 700 to 3,000 masses with gyroscopic forces or dashpots, where the error at 300 frequencies was
/// up to five times the one at those that are checked.
const CHECKED: usize = 16;

/// Step between the places of samples next to a frequency, modulo 1: multiples of the golden section lie apart.
/// Kind: fixed.
const PLACES_OF_SAMPLES: f64 = 0.618_033_988_749_894_8;

/// Steps of the power iteration for ‖Z⁻¹‖, whose size alone matters.
/// Kind: tuned; measured on: not recorded.
const STEPS: usize = 4;

/// Largest estimated errors over a sweep.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Certificate {
    /// Error by motions that the basis lacks.
    pub basis: f64,
    /// Error by motions that the basis lacks and by rounding.
    pub total: f64,
    /// Frequency next to that of the larger error, where a sample has what the basis lacks most.
    pub sample: f64,
}

impl Certificate {
    /// The larger value of each error; one that is not a number counts as infinite.
    pub fn max(self, other: Self) -> Self {
        let larger = |a: f64, b: f64| {
            if a.is_nan() || b.is_nan() {
                f64::INFINITY
            } else {
                a.max(b)
            }
        };
        Self {
            basis: larger(self.basis, other.basis),
            total: larger(self.total, other.total),
            sample: if other.basis > self.basis {
                other.sample
            } else {
                self.sample
            },
        }
    }

    /// Infinite errors, before anything is known.
    const UNKNOWN: Self = Self {
        basis: f64::INFINITY,
        total: f64::INFINITY,
        sample: 0.0,
    };
}

/// The largest estimated error of a harmonic over a sweep: at its ends, its middle, and the resonances within it. The
/// search stops at the first frequency where the error exceeds `enough`, and appends the residuals there to
/// `residuals`, see [`residual`].
pub(crate) fn certificate(
    (block, view): (&HarmonicBlock, &ReducedView),
    loss_factor: f64,
    inputs: &[SparseVector],
    (sweep, enough): (Range, f64),
    residuals: &mut Vec<Complex64>,
    interrupt: &Interrupt<'_>,
) -> Result<Certificate> {
    let order = view.pencil().order();
    let n = block.matrices.reference.rows;
    if order == 0 {
        return Ok(Certificate::UNKNOWN);
    }
    let mut forces = try_vec(inputs.len() * n, Complex64::ZERO, CONTEXT)?;
    for (to, input) in forces.chunks_exact_mut(n).zip(inputs) {
        let mut dense = view.coordinates(input)?;
        to[..order].swap_with_slice(&mut dense[..order]);
    }
    let mut frequencies = Vec::new();
    for frequency in sweep.of_harmonic(block.number).into_iter().rev() {
        if !frequencies.contains(&frequency) {
            try_push(&mut frequencies, frequency, CONTEXT)?;
        }
    }
    // Residuals vanish at the frequencies of samples, so that many others are checked.
    let is_sampled = is_sampled(view);
    let [low, _, high] = sweep.of_harmonic(block.number);
    let spacing = (high - low) / CHECKED as f64;
    if is_sampled && spacing > 0.0 {
        for k in (1..CHECKED).filter(|&k| 2 * k != CHECKED) {
            try_push(&mut frequencies, low + k as f64 * spacing, CONTEXT)?;
        }
    }
    let mut lacks_resonances = !sweep.is_single() && block.number > 0;
    let mut lu = Lu::new(n, inputs.len().max(1))?;
    let mut worst = Certificate::default();
    let remainder = &view.pencil().remainder;
    let (solutions, products) = (remainder.solutions, remainder.products);
    let mut q = try_copy(&forces, CONTEXT)?;
    let mut next = 0;
    while let Some(&nu) = frequencies.get(next) {
        next += 1;
        let i_nu = Complex64::new(0.0, nu);
        let matrix = lu.matrix();
        for (at, z) in matrix.iter_mut().enumerate() {
            *z = block.matrices.reference.values[at] + i_nu * block.matrices.damping[at]
                - nu * nu * block.matrices.mass[at];
        }
        match lu.factor(interrupt) {
            Ok(()) => {}
            Err(e) if e.status == Status::Singular => return Ok(Certificate::UNKNOWN),
            Err(e) => return Err(e),
        }
        q.copy_from_slice(&forces);
        lu.solve_columns(&mut q, false, interrupt)?;
        let inverse = inverse_norm(&mut lu, n, interrupt)?;
        residuals.clear();
        for q in q.chunks_exact(n) {
            let size = q[..order].iter().map(Complex64::norm_sqr).sum::<f64>().sqrt();
            if size == 0.0 {
                continue;
            }
            let residual = residual(view, (nu, loss_factor), &q[..order])?;
            let share = norm(&residual, remainder) / size;
            if enough.is_finite() {
                for z in residual {
                    try_push(residuals, z / size, CONTEXT)?;
                }
            }
            let basis = share + inverse * share * share;
            let whole = share + solutions * images(view, (nu, loss_factor), &q[..order])? / size;
            let total = whole + inverse * whole * whole + (1.0 + inverse) * products;
            let sample = if block.number > 0 {
                (nu + spacing * beside(order)).abs()
            } else {
                (0.5 + beside(order)) * sweep.low()
            };
            // The wave that travels the other way is the conjugate one at −ν.
            let sample = if view.conjugated { -sample } else { sample };
            worst = worst.max(Certificate { basis, total, sample });
        }
        if worst.basis > enough && !is_sampled {
            return Ok(worst);
        }
        if core::mem::take(&mut lacks_resonances) {
            resonances(block, view, sweep, &mut frequencies, interrupt)?;
        }
    }
    residuals.clear();
    Ok(worst)
}

/// Whether the basis consists of samples, the rests of all whose images are known: a certificate of all its frequencies tells the next one.
pub(crate) fn is_sampled(view: &ReducedView) -> bool {
    matches!(view.pencil().damping, WaveDamping::General(_, None)) && view.pencil().remainder.last == 0
}

/// A number between −1/2 and 1/2, another one for each order of a basis.
fn beside(order: usize) -> f64 {
    (order as f64 * PLACES_OF_SAMPLES).fract() - 0.5
}

/// Residual of a motion q of the coordinates at ν = hω, as coefficients over the images that the basis lacks.
fn residual(view: &ReducedView, (nu, loss_factor): (f64, f64), q: &[Complex64]) -> Result<Vec<Complex64>> {
    let pencil = view.pencil();
    let (order, last) = (pencil.order(), pencil.remainder.last);
    let new = order - last;
    let turned = |z: Complex64| if view.conjugated { z.conj() } else { z };
    let mut end = try_vec(new, Complex64::ZERO, CONTEXT)?;
    for (column, &z) in pencil.rotation.chunks_exact(order).zip(q) {
        let z = turned(z);
        for (to, r) in end.iter_mut().zip(&column[last..]) {
            *to += r * z;
        }
    }
    // Z = (1 + iνβ + iη) A − s M + …, s = ν² − iνα + (1 + iνβ + iη) σ
    let i_eta = Complex64::new(0.0, loss_factor);
    let (mass, damping) = match pencil.damping {
        WaveDamping::Proportional(alpha, beta) | WaveDamping::General(_, Some((alpha, beta))) => {
            let i_nu = Complex64::new(0.0, nu);
            (
                nu * nu - i_nu * alpha + (1.0 + i_nu * beta + i_eta) * pencil.shift,
                None,
            )
        }
        WaveDamping::General(_, None) => (
            nu * nu + (1.0 + i_eta) * pencil.shift,
            Some(turned(Complex64::new(0.0, -nu))),
        ),
    };
    let mut v = Vec::new();
    for factor in [Some(turned(mass)), damping].into_iter().flatten() {
        for z in &end {
            try_push(&mut v, factor * z, CONTEXT)?;
        }
    }
    Ok(v)
}

/// Norm ρ of a residual.
fn norm(residual: &[Complex64], remainder: &Remainder) -> f64 {
    let mut sum = Complex64::ZERO;
    for (column, z) in remainder.gram.chunks_exact(residual.len().max(1)).zip(residual) {
        for (g, w) in column.iter().zip(residual) {
            sum += w.conj() * g * z;
        }
    }
    sum.re.max(0.0).sqrt()
}

/// Sum of the norms of the forces Z q and of the basis' images in them, which scales the rounding of solutions.
fn images(view: &ReducedView, (nu, loss_factor): (f64, f64), q: &[Complex64]) -> Result<f64> {
    let pencil = view.pencil();
    let size = |x: &[Complex64]| x.iter().map(Complex64::norm_sqr).sum::<f64>().sqrt();
    let mut moved = Vec::new();
    for (z, value) in q.iter().zip(&pencil.values) {
        try_push(&mut moved, z * value, CONTEXT)?;
    }
    let i_nu = Complex64::new(0.0, nu);
    let i_eta = Complex64::new(0.0, loss_factor);
    let (stiffness, mass, damping) = match pencil.damping {
        WaveDamping::Proportional(alpha, beta) => {
            let damped = 1.0 + i_nu * beta + i_eta;
            (
                damped.norm(),
                (nu * nu - i_nu * alpha + damped * pencil.shift).norm(),
                0.0,
            )
        }
        WaveDamping::General(..) => {
            let mut damped = try_vec(q.len(), Complex64::ZERO, CONTEXT)?;
            for (i, to) in damped.iter_mut().enumerate() {
                *to = q.iter().enumerate().map(|(j, z)| view.damping(i, j) * z).sum();
            }
            let lost = 1.0 + i_eta;
            (lost.norm(), (nu * nu + lost * pencil.shift).norm(), nu * size(&damped))
        }
    };
    // The forces are the difference of all of them.
    Ok(stiffness * size(q) + 2.0 * (mass * size(&moved) + damping))
}

/// ‖Z⁻¹‖ by power iteration on Z⁻¹Z⁻ᴴ.
fn inverse_norm(lu: &mut Lu<Complex64>, n: usize, interrupt: &Interrupt<'_>) -> Result<f64> {
    let mut x = try_vec(n, Complex64::ZERO, CONTEXT)?;
    for (k, x) in x.iter_mut().enumerate() {
        *x = Complex64::cis(1.7 * k as f64);
    }
    let mut norm = 0.0;
    for _ in 0..STEPS {
        let size = x.iter().map(Complex64::norm_sqr).sum::<f64>().sqrt();
        for x in &mut x {
            *x = (*x / size).conj();
        }
        // conj(Z⁻ᵀ conj(x)) = Z⁻ᴴ x
        lu.solve_columns(&mut x, true, interrupt)?;
        for x in &mut x {
            *x = x.conj();
        }
        norm = x.iter().map(Complex64::norm_sqr).sum::<f64>().sqrt();
        lu.solve_columns(&mut x, false, interrupt)?;
    }
    Ok(norm)
}

/// Appends the natural frequencies within a sweep, computed with the real part of the reference stiffness.
fn resonances(
    block: &HarmonicBlock,
    view: &ReducedView,
    sweep: Range,
    frequencies: &mut Vec<f64>,
    interrupt: &Interrupt<'_>,
) -> Result<()> {
    let n = block.matrices.reference.rows;
    let shift = view.pencil().shift;
    // L Lᴴ = (K_κ + K_κᴴ)/2 + σM, and L⁻¹ M L⁻ᴴ has the eigenvalues 1/(λ + σ).
    let values = &block.matrices.reference.values;
    let mut l = try_vec(n * n, Complex64::ZERO, CONTEXT)?;
    for j in 0..n {
        for i in 0..n {
            l[j * n + i] =
                0.5 * (values[j * n + i] + values[i * n + j].conj()) + shift * block.matrices.mass[j * n + i];
        }
    }
    if !hermitian::cholesky(&mut l, n, interrupt)? {
        return Ok(());
    }
    let mut a = try_copy(&block.matrices.mass, CONTEXT)?;
    hermitian::solve_triangular(&l, n, false, &mut a, interrupt)?;
    hermitian::adjoint_in_place(&mut a, n);
    hermitian::solve_triangular(&l, n, false, &mut a, interrupt)?;
    let [low, _, high] = sweep.of_harmonic(block.number);
    let (found, shapes) = hermitian::eigen(&mut a, n, interrupt)?;
    let mut natural = try_vec(n, 0.0, CONTEXT)?;
    for (omega, mu) in natural.iter_mut().zip(found.iter().filter(|&&mu| mu > 0.0)) {
        *omega = (1.0 / mu - shift).max(0.0).sqrt();
    }
    if let Some(gyroscopic) = gyroscopic(block, &l, shift, &found, &shapes, interrupt)? {
        natural = gyroscopic;
    }
    let mut within = Vec::new();
    for omega in natural {
        if low < omega && omega < high {
            try_push(&mut within, omega, CONTEXT)?;
        }
    }
    let most = if is_sampled(view) { within.len() } else { RESONANCES };
    let step = within.len().div_ceil(most.max(1)).max(1);
    for &omega in within.iter().step_by(step) {
        try_push(frequencies, omega, CONTEXT)?;
    }
    Ok(())
}

/// Natural frequencies ν with gyroscopic forces, the skew-Hermitian part S of the damping; `None` without.
///
/// With K = L Lᴴ, the modes U of L⁻¹ M L⁻ᴴ = U diag(μ) Uᴴ and H = Uᴴ L⁻¹ iS L⁻ᴴ U, values θ = 1/ν of θ²w + θ H w − μ w = 0 are those of the
/// Hermitian matrix of the blocks −H, μ^½, μ^½ and 0.
fn gyroscopic(
    block: &HarmonicBlock,
    l: &[Complex64],
    shift: f64,
    values: &[f64],
    shapes: &[Complex64],
    interrupt: &Interrupt<'_>,
) -> Result<Option<Vec<f64>>> {
    let n = block.matrices.reference.rows;
    let damping = &block.matrices.damping;
    let mut h = try_vec(n * n, Complex64::ZERO, CONTEXT)?;
    let mut largest = 0.0_f64;
    for j in 0..n {
        for i in 0..n {
            let skew = 0.5 * (damping[j * n + i] - damping[i * n + j].conj());
            largest = largest.max(skew.norm());
            h[j * n + i] = Complex64::I * skew;
        }
    }
    if largest <= f64::EPSILON * damping.iter().fold(0.0_f64, |largest, z| largest.max(z.norm())) {
        return Ok(None);
    }
    for _ in 0..2 {
        hermitian::solve_triangular(l, n, false, &mut h, interrupt)?;
        hermitian::adjoint_in_place(&mut h, n);
    }
    let mut product = try_vec(n * n, Complex64::ZERO, CONTEXT)?;
    let mut whole = try_vec(4 * n * n, Complex64::ZERO, CONTEXT)?;
    interrupt.check_before((16 * n * n * n) as u64)?;
    multiply(&h, shapes, &mut product, n);
    multiply_adjoint(shapes, &product, &mut h, n);
    for (j, column) in whole.chunks_exact_mut(2 * n).enumerate() {
        if j < n {
            for (to, z) in column.iter_mut().zip(&h[j * n..(j + 1) * n]) {
                *to = -z;
            }
            column[n + j] = values[j].max(0.0).sqrt().into();
        } else {
            column[j - n] = values[j - n].max(0.0).sqrt().into();
        }
    }
    let (found, _) = hermitian::eigen(&mut whole, 2 * n, interrupt)?;
    let mut frequencies = Vec::new();
    for theta in found.into_iter().filter(|&theta| theta > 0.0) {
        try_push(
            &mut frequencies,
            (1.0 / (theta * theta) - shift).max(0.0).sqrt(),
            CONTEXT,
        )?;
    }
    Ok(Some(frequencies))
}
