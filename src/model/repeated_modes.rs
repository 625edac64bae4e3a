//! The shape of a mode whose frequency is repeated: any mixture of the modes of that frequency is
//! a mode, so a rule must choose, and the result tells which.

use crate::error::{Result, try_copy, try_push, try_vec};
use crate::linalg::quadratic::quadratic;
use crate::model::linear_modes::Pencil;
use num_complex::Complex64;
use std::f64::consts::FRAC_1_SQRT_2;

/// How the shape was chosen among the modes of one frequency.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Multiple {
    /// The frequency is simple: there was nothing to choose.
    Single,
    /// Two real modes φ₁, φ₂, M-orthonormal: (φ₁ + iφ₂)/√2, in which all equal parts of a rotational
    /// structure move alike. It does not depend on the basis but for its sense: that of the lower
    /// number is the one in which degrees of freedom of higher number lag,
    /// Im Σ_{i<j} φᵢ* φⱼ < 0, that of the upper number runs against it. Where this sum vanishes the
    /// sense is as it comes.
    TravellingWave,
    /// The mass-weighted projection of the given shape.
    Projected,
    /// The mode that was found first: more than two modes, or complex matrices. Another machine may
    /// find another one.
    First,
}

/// The mass-normalised shape of mode number `member` among those of one frequency (`shapes`, one
/// after the other); `projection`: parts of the given shape along them.
pub(super) fn resolve(
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
        turn(&mut shape);
    }
    if multiple == Multiple::Single && real {
        // A real mode but for rounding.
        for z in &mut shape {
            z.im = 0.0;
        }
    }
    let size = quadratic(&pencil.mass, &shape).sqrt();
    for z in &mut shape {
        *z /= size;
    }
    Ok((shape, multiple))
}

const CONTEXT: &str = "the start mode";

/// Makes the entry that moves most real and positive; of entries alike, the first.
fn turn(shape: &mut [Complex64]) {
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

/// (φ₁ ± iφ₂)/√2 of two modes of real matrices, in the sense in which later entries lag.
fn lagging_wave(pencil: &Pencil, shapes: &[Complex64]) -> Result<Vec<Complex64>> {
    let n = pencil.mass.rows;
    // The modes come with any phase, each and mixed: their real and imaginary parts span the space.
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
    let first = take_longest(pencil, &mut candidates);
    let weighted = pencil.mass.times(&first, CONTEXT)?;
    for _ in 0..2 {
        for x in &mut candidates {
            let part: f64 = x.iter().zip(&weighted).map(|(x, w)| x.re * w.re).sum();
            for (x, f) in x.iter_mut().zip(&first) {
                x.re -= part * f.re;
            }
        }
    }
    let second = take_longest(pencil, &mut candidates);
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

/// Takes out the vector of largest modal mass and normalises it.
fn take_longest(pencil: &Pencil, candidates: &mut Vec<Vec<Complex64>>) -> Vec<Complex64> {
    let (mut longest, mut square) = (0, 0.0);
    for (i, x) in candidates.iter().enumerate() {
        let s = quadratic(&pencil.mass, x);
        if s > square {
            (longest, square) = (i, s);
        }
    }
    let mut x = candidates.swap_remove(longest);
    for z in &mut x {
        *z /= square.sqrt();
    }
    x
}
