//! The shape of a mode whose frequency is repeated: any mixture of the modes of that frequency is a mode, so that a
//! rule must choose one, and the result names the rule.

use crate::error::{Result, try_copy, try_push, try_vec};
use crate::linalg::exact_sums::quadratic::quadratic;
use crate::model::natural_modes::linear_modes::Pencil;
use num_complex::Complex64;
use std::f64::consts::FRAC_1_SQRT_2;

/// Rule that chose the shape among the modes of one frequency.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Multiple {
    /// The frequency is simple: no choice was necessary.
    Single,
    /// Two real modes φ₁, φ₂, M-orthonormal: (φ₁ + iφ₂)/√2, in which all equal parts of a rotational structure move
    /// alike. It does not depend on the basis except for its sense of travel: in the mode of the lower number
    /// degrees of freedom of higher number lag, Im Σ_{i<j} φᵢ* φⱼ < 0; the mode of the upper number travels against
    /// it. Where this sum vanishes the sense is arbitrary.
    TravellingWave,
    /// The mass-weighted projection of the given shape.
    Projected,
    /// The first mode that was found, for more than two modes, or complex matrices. Another machine may find a
    /// different one.
    First,
}

/// The mass-normalised shape of mode `member` among those of one frequency (`shapes`, one after the other), and the
/// rule that chose it; `projection`: components of the given shape along these modes.
pub(crate) fn resolve(
    pencil: &Pencil,
    shapes: &[Complex64],
    member: usize,
    projection: Option<Vec<Complex64>>,
) -> Result<(Vec<Complex64>, Multiple)> {
    let n = pencil.mass.rows;
    let count = shapes.len() / n;
    let real = [&pencil.stiffness, &pencil.mass]
        .iter()
        .all(|a| a.values.iter().all(|v| v.im == 0.0));
    let (mut shape, multiple) = match projection {
        Some(parts) if count > 1 => {
            let mut sum = try_vec(n, Complex64::ZERO, CONTEXT)?;
            for (mode, part) in shapes.chunks_exact(n).zip(parts) {
                for (s, z) in sum.iter_mut().zip(mode) {
                    *s += part * z;
                }
            }
            (sum, Multiple::Projected)
        }
        _ if count == 2 && real => {
            let mut wave = lagging_wave(pencil, shapes)?;
            if member > 0 {
                conjugate(&mut wave);
            }
            (wave, Multiple::TravellingWave)
        }
        _ if count > 1 => (
            try_copy(&shapes[member * n..(member + 1) * n], CONTEXT)?,
            Multiple::First,
        ),
        _ => (try_copy(shapes, CONTEXT)?, Multiple::Single),
    };
    if multiple != Multiple::Projected {
        make_largest_real(&mut shape);
    }
    if multiple == Multiple::Single && real {
        // A real mode up to rounding.
        for z in &mut shape {
            z.im = 0.0;
        }
    }
    let size = quadratic(pencil.weight(), &shape).sqrt();
    for z in &mut shape {
        *z /= size;
    }
    Ok((shape, multiple))
}

const CONTEXT: &str = "the start mode";

/// Turns a shape such that its largest entry, the first of several of equal size, is real and positive.
fn make_largest_real(shape: &mut [Complex64]) {
    let largest = shape.iter().fold(0.0_f64, |m, z| m.max(z.norm()));
    if let Some(&z) = shape.iter().find(|z| z.norm() >= (1.0 - 1e-6) * largest) {
        let back = z.conj() / z.norm();
        for x in shape {
            *x *= back;
        }
    }
}

fn conjugate(shape: &mut [Complex64]) {
    for z in shape {
        z.im = -z.im;
    }
}

/// Travelling wave (φ₁ ± iφ₂)/√2 of two modes of real matrices, in the sense of travel in which later entries lag.
fn lagging_wave(pencil: &Pencil, shapes: &[Complex64]) -> Result<Vec<Complex64>> {
    let n = pencil.mass.rows;
    // The modes have arbitrary phases and may be mixed: their real and imaginary parts span the space.
    let mut candidates = Vec::new();
    for mode in shapes.chunks_exact(n) {
        for part in [|z: &Complex64| z.re, |z: &Complex64| z.im] {
            let mut x = try_vec(n, Complex64::ZERO, CONTEXT)?;
            for (x, z) in x.iter_mut().zip(mode) {
                x.re = part(z);
            }
            try_push(&mut candidates, x, CONTEXT)?;
        }
    }
    let first = take_largest(pencil, &mut candidates);
    let weighted = pencil.mass.times(&first, CONTEXT)?;
    for _ in 0..2 {
        for x in &mut candidates {
            let part: f64 = x.iter().zip(&weighted).map(|(x, w)| x.re * w.re).sum();
            for (x, f) in x.iter_mut().zip(&first) {
                x.re -= part * f.re;
            }
        }
    }
    let second = take_largest(pencil, &mut candidates);
    let mut wave = first;
    for (w, s) in wave.iter_mut().zip(&second) {
        *w = Complex64::new(w.re, s.re) * FRAC_1_SQRT_2;
    }
    // Im Σ_{i<j} wᵢ* wⱼ by partial sums.
    let (mut before, mut lead) = (Complex64::ZERO, 0.0);
    for w in &wave {
        lead += (before.conj() * w).im;
        before += w;
    }
    if lead > 0.0 {
        conjugate(&mut wave);
    }
    Ok(wave)
}

/// Removes the vector of largest modal mass from the candidates and normalises it.
fn take_largest(pencil: &Pencil, candidates: &mut Vec<Vec<Complex64>>) -> Vec<Complex64> {
    let (mut largest_index, mut square) = (0, 0.0);
    for (i, x) in candidates.iter().enumerate() {
        let s = quadratic(&pencil.mass, x);
        if s > square {
            (largest_index, square) = (i, s);
        }
    }
    let mut x = candidates.swap_remove(largest_index);
    for z in &mut x {
        *z /= square.sqrt();
    }
    x
}
