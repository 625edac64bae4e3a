//! Resonances of Z_κ near a range of frequency: the complex ω at which Z_κ(ω) is singular.
//!
//! The iteration starts from the undamped modes of K + Wᴴ Re(κ) W; two-sided inverse iteration then includes
//! damping and the complex reference stiffness: p ← p − yᴴ Z x / (yᴴ Z′ x) with x ← Z⁻¹Z′x, y ← Z⁻ᴴZ′ᴴy (Ruhe 1973,
//! Algorithms for the nonlinear eigenvalue problem, doi:10.1137/0710059).

use crate::condense::flexibility::Workspace;
use crate::condense::{Condensed, HarmonicBlock};
use crate::error::{Result, Status, try_copy, try_push};
use crate::interrupt::Interrupt;
use crate::linalg::eigen::Pairs;
use crate::linalg::held_rows::MovingRows;
use crate::linalg::lanczos;
use crate::linalg::sparse::{Csc, Form};
use num_complex::Complex64;

/// Numbers of modes considered, more where the fewer end below what is needed; a range beyond them is treated without poles.
const MODES: [usize; 2] = [6, 24];

/// Largest number of iterations; convergence is cubic.
const MAX_ITERATIONS: usize = 8;

/// Relative change of a pole that counts as converged.
const TOLERANCE: f64 = 1e-12;

/// Undamped modes of waves, by the motion of the next sector over that of one.
#[derive(Default)]
pub struct KnownModes(Vec<(Complex64, Pairs)>);

impl KnownModes {
    /// Modes of a wave, or of the one that travels the other way, whose modes are the conjugates, up to one above `highest`
    /// where there are not too many; whether they are conjugates.
    fn find(&self, next: Complex64, highest: f64) -> Option<(&Pairs, bool)> {
        let suffices = |modes: &Pairs| modes.values.len() >= MODES[1] || ends_above(modes, highest);
        let (at, modes) = self
            .0
            .iter()
            .find(|(at, modes)| (*at == next || at.conj() == next) && suffices(modes))?;
        Some((modes, *at != next))
    }
}

/// The resonances of the i-th carried harmonic within `range` and one width of it on either side. Where some cannot
/// be found the list is shorter, which affects the speed only.
///
/// # Errors
/// `OutOfMemory`; `StoppedByCaller`.
pub fn near(
    condensed: &Condensed,
    workspace: &mut Workspace,
    i: usize,
    range: (f64, f64),
    known: &mut KnownModes,
    interrupt: &Interrupt<'_>,
) -> Result<Vec<Complex64>> {
    let block = &condensed.blocks()[i];
    let mut found = Vec::new();
    let h = block.number as f64;
    let n = condensed.ndof();
    if block.number == 0 || MODES[1] > n / 2 {
        return Ok(found);
    }
    let (low, high) = (range.0.min(range.1), range.0.max(range.1));
    let width = high - low;
    let mut add = |omega: f64, shape: Vec<Complex64>| -> Result<()> {
        let pole = refine(condensed, workspace, i, (omega.into(), shape), interrupt)?;
        if let Some(p) = pole.filter(|p| p.re > low - 2.0 * width && p.re < high + 2.0 * width) {
            let known = found.iter().any(|q: &Complex64| (q - p).norm() <= 1e-6 * p.norm());
            if !known {
                try_push(&mut found, p, "the resonances")?;
            }
        }
        Ok(())
    };
    let is_near = |omega: f64| omega >= low - width && omega <= high + width;
    if let Some(modes) = &block.modes {
        for (omega, shape) in modes.frequencies().filter(|(nu, _)| is_near(nu / h)) {
            add(omega / h, try_copy(shape, "the resonances")?)?;
        }
        return Ok(found);
    }
    let highest = h * (high + width);
    // Each basis has its own coordinates.
    let mut of_basis = KnownModes::default();
    let known = if block.view.is_some() { &mut of_basis } else { known };
    if known.find(block.next, highest).is_none() {
        let Some(modes) = lowest_modes(block, highest, interrupt)? else {
            return Ok(found);
        };
        try_push(&mut known.0, (block.next, modes), "the resonances")?;
    }
    let Some((modes, conjugated)) = known.find(block.next, highest) else {
        return Ok(found);
    };
    for (mode, lambda) in modes.values.iter().enumerate() {
        let omega = lambda.max(0.0).sqrt() / h;
        if is_near(omega) {
            let column = modes.vectors.column(mode);
            add(
                omega,
                column.iter().map(|z| if conjugated { z.conj() } else { *z }).collect(),
            )?;
        }
    }
    Ok(found)
}

/// Whether the last of some modes lies above a frequency.
fn ends_above(modes: &Pairs, highest: f64) -> bool {
    modes.values.last().is_some_and(|last| last.max(0.0).sqrt() > highest)
}

/// The lowest modes, up to one above `highest` where there are not too many; `None` where they cannot be found.
fn lowest_modes(block: &HarmonicBlock, highest: f64, interrupt: &Interrupt<'_>) -> Result<Option<Pairs>> {
    let reference: &Csc = &block.reference;
    let n = reference.rows;
    let half = Complex64::new(0.5, 0.0);
    // (A + Aᴴ)/2, with Aᴴ as the conjugate of the transpose.
    let transposed = Csc::sum(n, &[(Complex64::ONE, reference, Form::Transposed)])?;
    let hermitian = Csc::sum(
        n,
        &[(half, reference, Form::Plain), (half, &transposed, Form::Conjugated)],
    )?;
    let mut mass = reference.try_clone()?;
    mass.values.copy_from_slice(&block.mass);
    let moving = MovingRows::of(&hermitian)?;
    let (hermitian, mass) = match &moving {
        Some(moving) => (moving.reduced(&hermitian)?, moving.reduced(&mass)?),
        None => (hermitian, mass),
    };
    for count in MODES {
        match lanczos::lowest(&hermitian, &mass, count, interrupt) {
            Ok(modes) => {
                if count == MODES[1] || ends_above(&modes, highest) {
                    return Ok(Some(match &moving {
                        Some(moving) => moving.expanded_pairs(modes)?,
                        None => modes,
                    }));
                }
            }
            Err(e) if matches!(e.status, Status::OutOfMemory | Status::StoppedByCaller) => return Err(e),
            Err(_) => return Ok(None),
        }
    }
    Ok(None)
}

/// Follows one resonance from its undamped mode.
fn refine(
    condensed: &Condensed,
    workspace: &mut Workspace,
    i: usize,
    (mut p, shape): (Complex64, Vec<Complex64>),
    interrupt: &Interrupt<'_>,
) -> Result<Option<Complex64>> {
    let mut left: Vec<Complex64> = shape.iter().map(Complex64::conj).collect();
    let mut right = shape;
    let mut last = f64::INFINITY;
    for _ in 0..MAX_ITERATIONS {
        // `left` holds conj(y), so that yᴴ A x is a product without conjugation.
        let step = workspace.resonance_step(condensed, i, p, &left, &right);
        if !step.is_finite() || step.norm() > 0.5 * p.norm() {
            return Ok(None);
        }
        p -= step;
        // Rounding limits the convergence to about the condition of the eigenvalue.
        if step.norm() <= TOLERANCE * p.norm() || (step.norm() < 1e-8 * p.norm() && step.norm() > 0.1 * last) {
            return Ok(Some(p));
        }
        last = step.norm();
        match workspace.inverse_step(condensed, i, p, &mut left, &mut right, interrupt) {
            Ok(()) => {}
            Err(e) if matches!(e.status, Status::OutOfMemory | Status::StoppedByCaller) => return Err(e),
            // The matrix is singular up to rounding: p is the resonance.
            Err(_) => return Ok(Some(p)),
        }
    }
    Ok(None)
}
