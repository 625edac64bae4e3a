//! Up to which harmonic the contacts feel the structure as something that gives: the last h with
//! ‖kt½ G_h kt½‖ ≥ 1/2, G_h the flexibility of the structure without its contacts.
//!
//! From there on inertia holds both sides of a contact, and a lifted harmonic hardly acts back on itself or on others.
//! Above the highest natural frequency G falls with frequency, so that the last h can be bracketed; below, the
//! harmonics are looked at one by one from above. On large structures, whose highest natural frequency is a matter of
//! the mesh, they are looked at in geometric steps.

use super::WHAT;
use crate::condense::Condensed;
use crate::condense::flexibility::Workspace;
use crate::error::{Result, try_vec};
use crate::harmonics::HarmonicSet;
use crate::linalg::eigen;
use crate::linalg::lu::Lu;
use nalgebra::DMatrix;
use num_complex::Complex64;

/// kt|G| from which on a harmonic counts.
const GIVES: f64 = 0.5;

/// Degrees of freedom up to which every harmonic may be looked at.
const SMALL_UP_TO: usize = 32;

/// Ratio of neighbouring harmonics that are looked at in a large structure.
const RATIO: f64 = 1.25;

/// Relative change of frequency up to which a reach, as a frequency, is taken over.
const NEAR: f64 = 0.01;

/// Iterations for the norm of a matrix.
const NORM_ITERATIONS: usize = 8;

/// Highest harmonic up to which a model has no more than so many unknowns.
pub(super) fn affordable(condensed: &Condensed, unknowns: usize) -> usize {
    let set = condensed.set();
    let each = unknowns / condensed.coordinates().max(1);
    let pairs = each.saturating_sub(usize::from(set.has_mean())) / 2;
    set.base() * (1 + pairs.saturating_sub(1) * set.stride()) * usize::from(pairs > 0)
}

/// Harmonics that a condensed model must carry so that the waves of all higher ones are among its own.
pub(super) fn all_waves(condensed: &Condensed) -> usize {
    if condensed.ndof() > SMALL_UP_TO {
        return 0;
    }
    let set = condensed.set();
    2 * condensed.in_step() * set.base()
}

/// Finds the reach of a model at one frequency after the other.
pub(super) struct Reach {
    condensed: Condensed,
    workspace: Workspace,
    /// Highest natural frequency of the structure without its contacts, where it is known.
    highest: Option<f64>,
    /// Frequency of the last reach, and the angular frequency that it was found at.
    found: Option<(f64, f64)>,
    matrix: Vec<Complex64>,
    lu: Lu<Complex64>,
}

impl Reach {
    /// Memory for a condensed model.
    pub fn new(condensed: Condensed) -> Result<Self> {
        let coordinates = condensed.coordinates();
        Ok(Self {
            workspace: Workspace::new(&condensed, None)?,
            highest: highest_frequency(&condensed)?,
            found: None,
            matrix: try_vec(coordinates.saturating_mul(coordinates), Complex64::ZERO, WHAT)?,
            lu: Lu::new(coordinates, coordinates)?,
            condensed,
        })
    }

    /// The last harmonic above `from` and up to `most` that gives, at the angular frequency ω; `from` where none
    /// does.
    pub fn at(&mut self, omega: f64, from: usize, most: usize) -> Result<usize> {
        if let Some((frequency, near)) = self.found
            && (omega / near - 1.0).abs() <= NEAR
        {
            return Ok(((frequency / omega).round() as usize).clamp(from, most.max(from)));
        }
        let last = match self.highest {
            Some(highest) => self.look_at_each(omega, highest, from, most)?,
            None => self.look_at_some(omega, from, most)?,
        };
        if last > from && last < most {
            self.found = Some((last as f64 * omega, omega));
        }
        Ok(last)
    }

    fn look_at_each(&mut self, omega: f64, highest: f64, from: usize, most: usize) -> Result<usize> {
        let set = self.condensed.set();
        let step = set.base() * set.stride();
        let most = carried_to(set, most);
        let mut above = carried_from(set, ((highest / omega) as usize + 1).max(from + 1));
        let mut below = from;
        while above < most && self.gives(omega, above)? {
            (below, above) = (above, carried_from(self.condensed.set(), 2 * above));
        }
        above = above.min(most);
        if below > from {
            // The flexibility falls: the last harmonic that gives lies between.
            while above > below + step {
                let middle = carried_from(self.condensed.set(), below.midpoint(above));
                let middle = middle.min(above - step);
                if self.gives(omega, middle)? {
                    below = middle;
                } else {
                    above = middle;
                }
            }
            return Ok(above);
        }
        let mut h = above;
        while h > from {
            if self.gives(omega, h)? {
                return Ok(h);
            }
            if h <= step {
                break;
            }
            h -= step;
        }
        Ok(from)
    }

    fn look_at_some(&mut self, omega: f64, from: usize, most: usize) -> Result<usize> {
        let mut h = most;
        let mut above = most;
        while h > from {
            if self.gives(omega, h)? {
                return Ok(above);
            }
            above = h;
            h = ((h as f64 / RATIO) as usize).min(h - 1);
        }
        Ok(from)
    }

    /// Whether ‖kt½ G kt½‖ ≥ 1/2 in harmonic h.
    fn gives(&mut self, omega: f64, h: usize) -> Result<bool> {
        let condensed = &self.condensed;
        let Some(i) = block_of(condensed, h) else {
            return Ok(false);
        };
        // The matrices of a wave are the same for all its harmonics.
        let seen = omega * h as f64 / condensed.set().numbers()[i] as f64;
        let n = condensed.coordinates();
        let table = &self.workspace.evaluate(condensed, i, seen, false)?.value;
        // G = (1 − G_κ κ)⁻¹ G_κ, both sides times kt½.
        let a = self.lu.matrix();
        for c in 0..n {
            let root = condensed.stiffness(c).sqrt();
            for r in 0..n {
                let g = table[c * (n + 1) + r] * condensed.stiffness(r).sqrt() * root;
                self.matrix[c * n + r] = g;
                let share = condensed.kappa(c, i) / condensed.stiffness(c).max(f64::MIN_POSITIVE);
                a[c * n + r] = Complex64::from(f64::from(u8::from(c == r))) - g * share;
            }
        }
        // Singular is the resonance of the free structure itself.
        if self.lu.factor().is_err() {
            return Ok(true);
        }
        self.lu.solve_columns(&mut self.matrix, false);
        Ok(spectral_norm(&self.matrix, n) >= GIVES)
    }
}

/// A carried harmonic on the same wave as h, or on the nearest carried one.
fn block_of(condensed: &Condensed, h: usize) -> Option<usize> {
    let numbers = condensed.set().numbers();
    let period = condensed.in_step().max(1);
    let same = numbers.iter().position(|&k| k > 0 && k % period == h % period);
    same.or_else(|| numbers.iter().rposition(|&k| k > 0))
}

/// Largest singular value of a matrix of order n, from below and nearly always to some per cent.
fn spectral_norm(a: &[Complex64], n: usize) -> f64 {
    let frobenius = a.iter().fold(0.0, |s, z| f64::hypot(s, z.norm()));
    if n == 1 || frobenius == 0.0 {
        return frobenius;
    }
    let product = |x: &DMatrix<Complex64>, a: &DMatrix<Complex64>| a.ad_mul(&(a * x));
    let a = DMatrix::from_column_slice(n, n, a);
    let start = |k: usize, _| Complex64::new(1.0 + (k as f64).sin(), (k as f64 * 0.7).cos());
    let mut x = DMatrix::from_fn(n, 1, start);
    let mut size = 0.0;
    for _ in 0..NORM_ITERATIONS {
        x.unscale_mut(x.norm());
        x = product(&x, &a);
        size = x.norm().sqrt();
    }
    size
}

/// Highest natural frequency over the waves of a small structure without its contacts; none where it is not known.
fn highest_frequency(condensed: &Condensed) -> Result<Option<f64>> {
    let n = condensed.ndof();
    if n > SMALL_UP_TO {
        return Ok(None);
    }
    let mut highest = 0.0_f64;
    for block in condensed.blocks().iter().take(2 * condensed.in_step() + 1) {
        let mut k = DMatrix::<Complex64>::zeros(n, n);
        let mut m = DMatrix::<Complex64>::zeros(n, n);
        let pattern = &block.reference;
        for j in 0..n {
            for at in pattern.col_ptr[j]..pattern.col_ptr[j + 1] {
                k[(pattern.row_idx[at], j)] = block.stiffness[at];
                m[(pattern.row_idx[at], j)] = block.mass[at];
            }
        }
        if (&k - k.adjoint()).norm() > 1e-9 * k.norm() {
            return Ok(None);
        }
        let Ok(pairs) = eigen::generalised(&k, &m) else {
            return Ok(None);
        };
        highest = pairs.values.iter().fold(highest, |w, x| w.max(x.max(0.0).sqrt()));
    }
    Ok(Some(highest))
}

/// The lowest harmonic number that is carried in sets like `set` and not below h.
pub(super) fn carried_from(set: &HarmonicSet, h: usize) -> usize {
    let (base, step) = (set.base(), set.base() * set.stride());
    base + h.saturating_sub(base).div_ceil(step) * step
}

/// The highest such number that is not above h, the base at least.
fn carried_to(set: &HarmonicSet, h: usize) -> usize {
    let (base, step) = (set.base(), set.base() * set.stride());
    base + h.saturating_sub(base) / step * step
}
