//! Products with the matrices of perturbations between two events, several perturbations at a time.
//!
//! Between events M δẍ + C δẋ + K δx + Rᴴ(S R δx − kt δw) = 0 has constant coefficients: K + Rᴴ S R is assembled once for the
//! interval, and rows are divided by the mass where that is diagonal. Complex numbers are carried as two real ones, the real parts
//! of all degrees of freedom before the imaginary ones: an entry that is real, as most are, then costs two products and not four.

#![allow(clippy::inline_always, reason = "compiled for the instructions of the caller")]

use crate::contact::forms::time_piece::TimePiece;
use crate::error::{Result, try_copy, try_push, try_vec};
use crate::linalg::libraries::{Arch, Simd, WithSimd};
use crate::time_integration::variational_equations::{
    Number, Numbers, VARIATIONAL_EQUATIONS_LANES, VariationalElement, VariationalEquations,
};
use num_complex::Complex64;

const CONTEXT: &str = "a step of perturbations";

/// A real sparse matrix, row by row.
struct Rows {
    starts: Vec<usize>,
    entries: Vec<(usize, f64)>,
}

impl Rows {
    /// The sum of the given entries (row, column, value).
    fn new(order: usize, mut entries: Vec<(usize, usize, f64)>) -> Result<Self> {
        entries.sort_unstable_by_key(|&(row, column, _)| (row, column));
        let mut found = Self {
            starts: try_vec(order + 1, 0, CONTEXT)?,
            entries: Vec::new(),
        };
        let mut before = None;
        for (row, column, value) in entries {
            if before.replace((row, column)) == Some((row, column))
                && let Some((_, sum)) = found.entries.last_mut()
            {
                *sum += value;
                continue;
            }
            try_push(&mut found.entries, (column, value), CONTEXT)?;
            found.starts[row + 1] = found.entries.len();
        }
        for i in 0..order {
            found.starts[i + 1] = found.starts[i + 1].max(found.starts[i]);
        }
        Ok(found)
    }

    fn row(&self, i: usize) -> &[(usize, f64)] {
        &self.entries[self.starts[i]..self.starts[i + 1]]
    }

    /// Adds to an entry of the pattern.
    fn add(&mut self, row: usize, column: usize, value: f64) {
        let entries = &mut self.entries[self.starts[row]..self.starts[row + 1]];
        if let Ok(at) = entries.binary_search_by_key(&column, |entry| entry.0) {
            entries[at].1 += value;
        }
    }

    fn scale(&mut self, factors: &[f64]) {
        for (i, factor) in factors.iter().enumerate() {
            for (_, value) in &mut self.entries[self.starts[i]..self.starts[i + 1]] {
                *value *= factor;
            }
        }
    }
}

/// The matrices of an interval between events, in real numbers.
pub(super) struct Products {
    arch: Arch,
    /// Number of degrees of freedom; and real numbers for each.
    n: usize,
    parts: usize,
    /// Stiffness K of the structure alone: positions of its entries in the pattern, and values.
    base: Vec<(usize, f64)>,
    stiffness: Rows,
    damping: Rows,
    /// Factors 1/mᵢᵢ of a diagonal mass, with which all rows are multiplied; `None` for another mass.
    inverse: Option<Vec<f64>>,
    /// Forces by the places of the sliders, as (degree of freedom, slider, coefficient).
    memory: Vec<(usize, usize, f64)>,
}

impl Products {
    /// The pattern of the equations, without an interval.
    pub fn new<T: Number>(equations: &VariationalEquations<T>) -> Result<Self> {
        let n = equations.order;
        let parts = if T::IS_COMPLEX { 2 } else { 1 };
        let (mut stiffness, mut damping) = (Vec::new(), Vec::new());
        for (matrix, entries) in [
            (&equations.stiffness, &mut stiffness),
            (&equations.damping, &mut damping),
        ] {
            for (r, c, z) in matrix.each() {
                each_part((n, n), parts, (r, c), z.complex(), |r, c, v| {
                    try_push(entries, (r, c, v), CONTEXT)
                })?;
            }
        }
        for element in &equations.elements {
            for &(r, a) in element.rows.iter().flatten().flatten() {
                for &(c, b) in element.rows.iter().flatten().flatten() {
                    let z = a.complex().conj() * b.complex();
                    each_part((n, n), parts, (r, c), z, |r, c, _| {
                        try_push(&mut stiffness, (r, c, 0.0), CONTEXT)
                    })?;
                }
            }
        }
        let inverse = match equations.inverse_mass() {
            Some(of_degree) => {
                let mut inverse = try_vec(parts * n, 0.0, CONTEXT)?;
                for of_part in inverse.chunks_exact_mut(n.max(1)) {
                    of_part.copy_from_slice(of_degree);
                }
                Some(inverse)
            }
            None => None,
        };
        let stiffness = Rows::new(parts * n, stiffness)?;
        let mut damping = Rows::new(parts * n, damping)?;
        if let Some(inverse) = &inverse {
            damping.scale(inverse);
        }
        Ok(Self {
            arch: Arch::new(),
            n,
            parts,
            base: try_copy(&stiffness.entries, CONTEXT)?,
            stiffness,
            damping,
            inverse,
            memory: Vec::new(),
        })
    }

    /// Number of real numbers of a motion of all degrees of freedom.
    pub fn order(&self) -> usize {
        self.parts * self.n
    }

    /// Sets the tangents of an interval; `sliders` is the number of sliders.
    pub fn set<T: Number>(
        &mut self,
        elements: &[VariationalElement<T>],
        pieces: &[TimePiece],
        sliders: usize,
    ) -> Result<()> {
        self.stiffness.entries.copy_from_slice(&self.base);
        self.memory.clear();
        let (n, parts) = (self.n, self.parts);
        for element in elements {
            let piece = &pieces[element.source];
            for (to, slopes) in element.rows.iter().zip(&piece.slope) {
                for (from, &slope) in element.rows.iter().zip(slopes) {
                    if slope == 0.0 {
                        continue;
                    }
                    for &(r, a) in to.iter().flatten() {
                        for &(c, b) in from.iter().flatten() {
                            let z = a.complex().conj() * b.complex() * slope;
                            let stiffness = &mut self.stiffness;
                            each_part((n, n), parts, (r, c), z, |r, c, v| {
                                stiffness.add(r, c, v);
                                Ok(())
                            })?;
                        }
                    }
                }
            }
            if let (Some(slider), Some(row), true) = (element.slider, element.rows.first(), piece.memory != 0.0) {
                for &(r, a) in row.iter().flatten() {
                    let z = a.complex().conj() * piece.memory;
                    each_part((n, sliders), parts, (r, slider), z, |r, slider, v| {
                        let scale = self.inverse.as_ref().map_or(1.0, |inverse| inverse[r]);
                        try_push(&mut self.memory, (r, slider, scale * v), CONTEXT)
                    })?;
                }
            }
        }
        if let Some(inverse) = &self.inverse {
            self.stiffness.scale(inverse);
        }
        Ok(())
    }

    /// new ← −(K + Rᴴ S R) this − factor·C next, divided by the mass where that is diagonal.
    pub fn multiply(&self, this: &[Numbers], (factor, next): (f64, &[Numbers]), new: &mut [Numbers]) {
        self.arch.dispatch(Multiply {
            products: self,
            this,
            next,
            factor,
            new,
        });
    }

    /// new ← new + the forces by the places of the sliders.
    pub fn add_memory(&self, sliders: &[Numbers], new: &mut [Numbers]) {
        for &(r, slider, c) in &self.memory {
            for (new, w) in new[r].iter_mut().zip(&sliders[slider]) {
                *new += c * w;
            }
        }
    }

    /// new ← scale·new is the next term of x; then x ← x + new and v ← v + rate·new. Returns the largest |new| of
    /// each perturbation, which is infinite or NaN if a term is.
    pub fn add_term(
        &self,
        new: &mut [Numbers],
        x: &mut [Numbers],
        v: &mut [Numbers],
        scale: f64,
        rate: f64,
    ) -> Numbers {
        self.arch.dispatch(AddTerm { new, x, v, scale, rate })
    }
}

/// Visits the real entries that represent a complex one among n rows and m columns: z x = (re x_re − im x_im) + i (im
/// x_re + re x_im).
fn each_part(
    (n, m): (usize, usize),
    parts: usize,
    (r, c): (usize, usize),
    z: Complex64,
    mut visit: impl FnMut(usize, usize, f64) -> Result<()>,
) -> Result<()> {
    visit(r, c, z.re)?;
    if parts == 2 {
        visit(n + r, m + c, z.re)?;
        if z.im != 0.0 {
            visit(r, m + c, -z.im)?;
            visit(n + r, c, z.im)?;
        }
    }
    Ok(())
}

struct Multiply<'a> {
    products: &'a Products,
    this: &'a [Numbers],
    next: &'a [Numbers],
    factor: f64,
    new: &'a mut [Numbers],
}

impl WithSimd for Multiply<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _simd: S) {
        let Self {
            products,
            this,
            next,
            factor,
            new,
        } = self;
        for (i, new) in new.iter_mut().enumerate() {
            let mut sum = [0.0; VARIATIONAL_EQUATIONS_LANES];
            for &(j, a) in products.stiffness.row(i) {
                subtract(&mut sum, a, &this[j]);
            }
            for &(j, a) in products.damping.row(i) {
                subtract(&mut sum, factor * a, &next[j]);
            }
            *new = sum;
        }
    }
}

/// y ← y − a x.
#[inline(always)]
fn subtract(y: &mut Numbers, a: f64, x: &Numbers) {
    let mut k = 0;
    while k < VARIATIONAL_EQUATIONS_LANES {
        y[k] -= a * x[k];
        k += 1;
    }
}

struct AddTerm<'a> {
    new: &'a mut [Numbers],
    x: &'a mut [Numbers],
    v: &'a mut [Numbers],
    scale: f64,
    rate: f64,
}

impl WithSimd for AddTerm<'_> {
    type Output = Numbers;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Numbers {
        let Self { new, x, v, scale, rate } = self;
        let (scale, rate) = (simd.splat_f64s(scale), simd.splat_f64s(rate));
        let (mut largest, mut sum) = (
            [0.0_f64; VARIATIONAL_EQUATIONS_LANES],
            [0.0_f64; VARIATIONAL_EQUATIONS_LANES],
        );
        let (largest_lanes, _) = S::as_mut_simd_f64s(&mut largest);
        let (sum_lanes, _) = S::as_mut_simd_f64s(&mut sum);
        for ((new, x), v) in new.iter_mut().zip(x).zip(v) {
            let (new, _) = S::as_mut_simd_f64s(new);
            let (x, _) = S::as_mut_simd_f64s(x);
            let (v, _) = S::as_mut_simd_f64s(v);
            let sizes = largest_lanes.iter_mut().zip(sum_lanes.iter_mut());
            for (((new, x), v), (largest, sum)) in new.iter_mut().zip(x).zip(v).zip(sizes) {
                let term = simd.mul_f64s(scale, *new);
                *new = term;
                *x = simd.add_f64s(*x, term);
                *v = simd.add_f64s(*v, simd.mul_f64s(rate, term));
                let size = simd.abs_f64s(term);
                *largest = simd.max_f64s(*largest, size);
                *sum = simd.add_f64s(*sum, size);
            }
        }
        for (largest, sum) in largest.iter_mut().zip(sum) {
            if !sum.is_finite() {
                *largest = sum;
            }
        }
        largest
    }
}
