//! The dynamic stiffness Z_κ of one harmonic at a time, factorised.
//!
//! Z_κ = K + Wᴴ κ W − h²ω²M + ihωC + iD, with a speed Ω = pω also + ω² p²K₁ + ihω² pG, and in a nonlinear mode of damping ratio D the artificial
//! damping −2DωM ẋ (mass type) or −ζK ẋ with D = ζω/2 (stiffness type), which adds −2ihDω²M or
//! −2ihDK. Damping of few modes is a term of low rank beside the factors, see [`crate::linalg::factors::low_rank_term`].

use crate::condense::tuned_wheel::tuned_factors::TunedFactors;
use crate::condense::tuned_wheel::tuned_plan::TUNED_TERMS;
use crate::condense::{Artificial, Condensed, HarmonicBlock};
use crate::error::{Error, Result, Status, boxed, fail, try_push, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::exact_sums::quadratic::{self, ComplexSum};
use crate::linalg::factors::factor::Factor;
use crate::linalg::factors::low_rank_term::{LowRankTerm, Sides, add_term_product};
use crate::linalg::factors::slender_lu::SlenderLu;
use crate::linalg::iterative::block_krylov::SparseVector;
use crate::linalg::sparse_storage::sparse::Csc;
use num_complex::Complex64;
use std::sync::Arc;

/// Angular frequency and artificial damping ratio at which a dynamic stiffness is made; the latter is 0 of a forced response.
#[derive(Clone, Copy, Debug)]
pub struct DampedFrequency {
    pub omega: f64,
    pub damping: f64,
}

impl DampedFrequency {
    pub fn new(omega: f64, damping: f64) -> Self {
        Self { omega, damping }
    }
}

/// Variable of a derivative of Z_κ.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Variable {
    Omega,
    Damping,
}

/// Memory for the factorisation of Z_κ, one harmonic at a time.
pub struct DynamicStiffness {
    /// Factors of Z_κ on all degrees of freedom, made when they are first needed.
    plain: Option<Plain>,
    /// Factors of a wheel that is tuned but for terms of low rank; and the (harmonic, frequency, damping) for which
    /// they were made.
    tuned: Option<Box<TunedFactors>>,
    tuned_at: Option<(usize, Complex64, f64)>,
    columns: usize,
    /// Largest entry of the matrix that was factorised.
    largest: f64,
    /// Residual b − Z x, and memory for its exact sum.
    remainder: Vec<Complex64>,
    sums: Vec<ComplexSum>,
    part: Vec<ComplexSum>,
}

/// Factors of Z_κ on all degrees of freedom.
struct Plain {
    factor: Factor,
    /// Z_κ on each pattern of entries; and for each harmonic the index of its pattern.
    z: Vec<Csc>,
    patterns: Vec<usize>,
    /// Damping of few modes beside the factors, if some harmonic has such, and that of the current factors with the index of their pattern.
    modal: Option<Box<LowRankTerm>>,
    current: (usize, Option<Arc<Vec<SparseVector>>>),
}

impl Plain {
    fn new(condensed: &Condensed, columns: usize) -> Result<Self> {
        let (mut z, mut patterns) = (Vec::<Csc>::new(), Vec::new());
        for block in condensed.blocks() {
            let of_block = |z: &Csc| {
                z.col_ptr == block.matrices.reference.col_ptr && z.row_idx == block.matrices.reference.row_idx
            };
            let known = z.iter().position(of_block);
            try_push(&mut patterns, known.unwrap_or(z.len()), CONTEXT)?;
            if known.is_none() {
                try_push(&mut z, block.matrices.reference.try_clone()?, CONTEXT)?;
            }
        }
        let Some(first) = condensed.blocks().first() else {
            return fail!(Internal, "no harmonic is carried");
        };
        let modal = condensed
            .blocks()
            .iter()
            .filter_map(|block| block.matrices.modal.as_ref());
        let most = modal.map(|directions| directions.len()).max();
        let modal = most.map(|most| boxed(|| LowRankTerm::new(condensed.ndof(), most)));
        Ok(Self {
            factor: Factor::new(&first.matrices.reference, columns)?,
            z,
            patterns,
            modal: modal.transpose()?,
            current: (0, None),
        })
    }

    /// Factors a matrix that was filled in, of the block with that index, with the factor `c` of its damping.
    fn factor(&mut self, block: &HarmonicBlock, i: usize, c: Complex64, interrupt: &Interrupt<'_>) -> Result<()> {
        let at = self.patterns[i];
        self.current = (at, None);
        let factored = self.factor.factor(&self.z[at], interrupt);
        let (Some(directions), Some(modal)) = (&block.matrices.modal, &mut self.modal) else {
            return factored;
        };
        factored?;
        if c == Complex64::ZERO {
            return Ok(());
        }
        let mut sides = Sides {
            factor: &mut self.factor,
            matrix: &self.z[at],
            directions: &directions[..],
        };
        modal.renew(c, &mut sides, interrupt)?;
        self.current.1 = Some(Arc::clone(directions));
        Ok(())
    }

    /// Solves Z X = B (or Zᵀ X = B) in place.
    fn solve(&mut self, b: &mut [Complex64], transposed: bool, interrupt: &Interrupt<'_>) -> Result<()> {
        let (Some(directions), Some(modal)) = (&self.current.1, &mut self.modal) else {
            return self.factor.solve(b, transposed, interrupt);
        };
        let mut sides = Sides {
            factor: &mut self.factor,
            matrix: &self.z[self.current.0],
            directions: &directions[..],
        };
        modal.solve(&mut sides, b, transposed, interrupt)
    }
}

const CONTEXT: &str = "the dynamic stiffness";

/// Relative error of the relative motions above which a residual summed with its rounding errors is worth its cost.
/// Kind: rounding.
const NOISE: f64 = 1e-12;

/// Product of the largest stiffness and motion under a load of 1 beyond which a plain solution loses so many digits that Newton's method
/// sees their noise along a branch: a penalty of 1e6 times the structure.
/// Kind: tuned; measured on: not recorded.
const STIFF_FOR_FACTORS: f64 = 1e5;

/// Product beyond which it may have fewer than twelve digits.
/// Kind: rounding.
const STIFF_FOR_DIGITS: f64 = NOISE / f64::EPSILON;

/// Entries of the matrix, over all columns, up to which twelve digits are worth such residuals: those of a chain of 3,000 masses would
/// take longer than all else along its sweep.
/// Kind: tuned; measured on: not recorded.
const QUICK_TO_REFINE: usize = 2_000;

/// Entries of the matrix, over all columns, up to which residuals with their rounding errors take no longer than the factors.
/// Kind: tuned; measured on: not recorded.
const CHEAP_TO_REFINE: usize = 20_000;

/// Largest number of such residuals: each leaves the error of the last times that of a plain solution.
/// Kind: cap.
const EXACT: usize = 6;

impl DynamicStiffness {
    /// Memory for a condensed model, solving up to `columns` right-hand sides at a time.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(condensed: &Condensed, columns: usize) -> Result<Self> {
        let n = condensed.ndof();
        let tuned = condensed.tuned().map(|plan| boxed(|| TunedFactors::new(plan, columns)));
        let tuned = tuned.transpose()?;
        Ok(Self {
            plain: match tuned {
                None => Some(Plain::new(condensed, columns)?),
                Some(_) => None,
            },
            tuned,
            tuned_at: None,
            columns,
            largest: 0.0,
            remainder: try_vec(n, Complex64::ZERO, CONTEXT)?,
            sums: try_vec(n, ComplexSum::default(), CONTEXT)?,
            part: try_vec(n, ComplexSum::default(), CONTEXT)?,
        })
    }

    /// Factors Z_κ of the i-th carried harmonic at a frequency, which may be complex, and a damping
    /// ratio.
    ///
    /// # Errors
    /// `Singular` naming the harmonic, at an undamped resonance that moves no contact; `StoppedByCaller`.
    pub fn factor(
        &mut self,
        condensed: &Condensed,
        i: usize,
        omega: Complex64,
        damping: f64,
        interrupt: &Interrupt<'_>,
    ) -> Result<()> {
        if self.tuned_at == Some((i, omega, damping)) {
            return Ok(());
        }
        self.tuned_at = None;
        let block = &condensed.blocks()[i];
        let sum = Combination::value(block, omega, damping);
        self.largest = 0.0;
        if let Some(tuned) = &mut self.tuned {
            match tuned.factor(i, &sum.factors(), interrupt) {
                // The tuned wheel may be singular where the wheel is not.
                Err(e) if e.status == Status::Singular => {}
                factored => {
                    self.largest = factored.map_err(|e| at_harmonic(e, block, omega.re))?;
                    self.tuned_at = Some((i, omega, damping));
                    return Ok(());
                }
            }
        }
        let known = match self.plain.take() {
            Some(known) => known,
            None => Plain::new(condensed, self.columns)?,
        };
        let plain = self.plain.insert(known);
        let z = &mut plain.z[plain.patterns[i]];
        for (at, z) in z.values.iter_mut().enumerate() {
            *z = sum.at(block, at);
            self.largest = self.largest.max(z.re.abs()).max(z.im.abs());
        }
        let factored = plain.factor(block, i, sum.damping, interrupt);
        factored.map_err(|e| at_harmonic(e, block, omega.re))
    }

    /// Factors of the whole wheel as a tuned one, if these are the current factors.
    pub(crate) fn tuned(&mut self) -> Option<&mut TunedFactors> {
        self.tuned.as_deref_mut().filter(|_| self.tuned_at.is_some())
    }

    /// The current factors, if they solve many right sides side by side.
    pub(crate) fn slender(&mut self) -> Option<&mut SlenderLu> {
        match &mut self.plain {
            Some(plain) if self.tuned_at.is_none() => plain.factor.slender(),
            _ => None,
        }
    }

    /// The term of low rank beside the current factors, with the parts of the matrix; `None` without one.
    pub(crate) fn term(&mut self) -> Option<(&mut LowRankTerm, Sides<'_>)> {
        let plain = self.plain.as_mut()?;
        let (Some(directions), Some(modal)) = (&plain.current.1, &mut plain.modal) else {
            return None;
        };
        let sides = Sides {
            factor: &mut plain.factor,
            matrix: &plain.z[plain.current.0],
            directions: &directions[..],
        };
        Some((modal, sides))
    }

    /// Solves with the current factors.
    fn solve_columns(&mut self, b: &mut [Complex64], transposed: bool, interrupt: &Interrupt<'_>) -> Result<()> {
        match (&mut self.tuned, &mut self.plain) {
            (Some(tuned), _) if self.tuned_at.is_some() => tuned.solve(b, interrupt),
            (_, Some(plain)) => plain.solve(b, transposed, interrupt),
            _ => fail!(Internal, "a dynamic stiffness was not factored"),
        }
    }

    /// Whether rounding of the i-th harmonic's solutions `columns`, under loads of about 1, matters and is cheap to remove.
    pub fn should_refine(&self, condensed: &Condensed, i: usize, columns: &[Complex64]) -> bool {
        let largest = || columns.iter().fold(0.0_f64, |m, z| m.max(z.re.abs()).max(z.im.abs()));
        self.loses_digits(condensed, i, columns.len() / condensed.ndof(), largest)
    }

    /// The same of so many solutions, by their `largest` real or imaginary part.
    pub(crate) fn loses_digits(
        &self,
        condensed: &Condensed,
        i: usize,
        count: usize,
        largest: impl Fn() -> f64,
    ) -> bool {
        let entries = condensed.blocks()[i].matrices.reference.values.len();
        let stiff = if entries * count <= QUICK_TO_REFINE {
            STIFF_FOR_DIGITS
        } else {
            STIFF_FOR_FACTORS
        };
        entries * count <= CHEAP_TO_REFINE && self.largest * largest() > stiff
    }

    /// Solves Z X = B (or Zᵀ X = B) in place. The current factors must belong to the i-th harmonic at `omega`.
    ///
    /// # Errors
    /// As [`Self::factor`].
    pub fn solve(
        &mut self,
        condensed: &Condensed,
        i: usize,
        omega: f64,
        b: &mut [Complex64],
        transposed: bool,
        interrupt: &Interrupt<'_>,
    ) -> Result<()> {
        self.solve_columns(b, transposed, interrupt)
            .map_err(|e| at_harmonic(e, &condensed.blocks()[i], omega))
    }

    /// Refines a solution x of Z x = b with the current factors, which belong to the i-th harmonic at (ω, D).
    ///
    /// Near a resonance of Z_κ the rounding of a plain solution is many times that of the relative motions that
    /// follow from it, and a mode is always near one. The change of the relative motions in the first step shows
    /// whether rounding of the residual itself matters.
    ///
    /// # Errors
    /// As [`Self::factor`].
    pub fn refine(
        &mut self,
        condensed: &Condensed,
        i: usize,
        at: DampedFrequency,
        b: &[Complex64],
        x: &mut [Complex64],
        interrupt: &Interrupt<'_>,
    ) -> Result<()> {
        let mut shrinkage = self.rounding_of_matrix(&condensed.blocks()[i], b, x);
        // Where that alone asks for exact residuals, the first of them does what a plain one would.
        if shrinkage <= NOISE {
            shrinkage = shrinkage.max(self.refinement((condensed, i), at, b, x, false, interrupt)?);
        }
        let (mut error, mut before) = (shrinkage, f64::INFINITY);
        let mut enough = NOISE;
        for _ in 0..EXACT {
            if error <= enough {
                break;
            }
            // The bound is below the digits that are asked for, once they take residuals of this kind.
            enough = 0.1 * NOISE;
            let change = self.refinement((condensed, i), at, b, x, true, interrupt)?;
            shrinkage = if before.is_finite() {
                // Without a change the ratio is none, and the error is zero.
                shrinkage.min(change / before)
            } else {
                shrinkage.max(change)
            };
            (error, before) = (shrinkage * change, change);
        }
        Ok(())
    }

    /// Relative change of a solution x of Z x = b by the rounding of Z, which its factors do not show: ε‖Z‖‖x‖/‖b‖; 0 where it is not to
    /// be removed. A mode is near a resonance of Z, where that is large in any structure.
    fn rounding_of_matrix(&self, block: &HarmonicBlock, b: &[Complex64], x: &[Complex64]) -> f64 {
        if block.matrices.reference.values.len() > QUICK_TO_REFINE
            || !matches!(block.matrices.artificial, Artificial::None)
        {
            return 0.0;
        }
        let load = largest(b);
        if load > 0.0 {
            f64::EPSILON * self.largest * largest(x) / load
        } else {
            0.0
        }
    }

    /// One step x += Z⁻¹(b − Z x); returns the relative change of the relative motions, without contacts that of all motions.
    fn refinement(
        &mut self,
        (condensed, i): (&Condensed, usize),
        at: DampedFrequency,
        b: &[Complex64],
        x: &mut [Complex64],
        exact: bool,
        interrupt: &Interrupt<'_>,
    ) -> Result<f64> {
        let block = &condensed.blocks()[i];
        let sum = Combination::value(block, at.omega.into(), at.damping);
        self.remainder.copy_from_slice(b);
        if exact {
            sum.exact_product(block, x, &mut self.sums, &mut self.part);
            for (remainder, sum) in self.remainder.iter_mut().zip(&mut self.sums) {
                *remainder = sum.subtracted_from(*remainder);
            }
        } else {
            let pattern = &block.matrices.reference;
            for (j, x) in x.iter().enumerate() {
                for at in pattern.col_ptr[j]..pattern.col_ptr[j + 1] {
                    self.remainder[pattern.row_idx[at]] -= sum.at(block, at) * x;
                }
            }
        }
        if let Some(directions) = &block.matrices.modal {
            add_term_product(directions, -sum.damping, false, x, &mut self.remainder);
        }
        let mut remainder = core::mem::take(&mut self.remainder);
        let solved = self.solve_columns(&mut remainder, false, interrupt);
        self.remainder = remainder;
        solved.map_err(|e| at_harmonic(e, block, at.omega))?;
        let mut change = (0.0_f64, 0.0_f64);
        for row in &block.motions.rows {
            change.0 = change.0.max(row.along(&self.remainder).norm());
            change.1 = change.1.max(row.along(x).norm());
        }
        if block.motions.rows.is_empty() {
            change = (largest(&self.remainder), largest(x));
        }
        for (x, d) in x.iter_mut().zip(&self.remainder) {
            *x += *d;
        }
        Ok(if change.0 == 0.0 { 0.0 } else { change.0 / change.1 })
    }
}

/// Largest modulus of the numbers of a vector.
fn largest(x: &[Complex64]) -> f64 {
    x.iter().map(Complex64::norm_sqr).fold(0.0, f64::max).sqrt()
}

/// Z_κ or one of its derivatives as a sum of the block's matrices.
#[derive(Clone, Copy)]
struct Combination {
    reference: f64,
    damping: Complex64,
    mass: Complex64,
    /// Factor of the stiffness matrix of the structure, for artificial damping of stiffness type.
    own: Complex64,
    /// Factors of p²K₁ and pG of a speed that is tied to the frequency.
    tied: [Complex64; 2],
}

impl Combination {
    /// Z_κ at an angular frequency and a damping ratio, as a sum of the block's matrices.
    fn value(block: &HarmonicBlock, omega: Complex64, damping: f64) -> Self {
        let hw = block.number as f64 * omega;
        let artificial = Self::slope(block, omega, damping, Variable::Damping);
        Self {
            reference: 1.0,
            damping: Complex64::I * hw,
            mass: damping * artificial.mass - hw * hw,
            own: damping * artificial.own,
            tied: [omega * omega, Complex64::I * hw * omega],
        }
    }

    /// ∂Z/∂ω or ∂Z/∂D, as a sum of the block's matrices.
    fn slope(block: &HarmonicBlock, omega: Complex64, damping: f64, by: Variable) -> Self {
        let h = block.number as f64;
        let ih = Complex64::I * h;
        let zero = Self {
            reference: 0.0,
            damping: Complex64::ZERO,
            mass: Complex64::ZERO,
            own: Complex64::ZERO,
            tied: [Complex64::ZERO; 2],
        };
        match (by, &block.matrices.artificial) {
            (Variable::Omega, artificial) => Self {
                damping: ih,
                mass: match artificial {
                    Artificial::Mass => -2.0 * (h + 2.0 * Complex64::I * damping) * h * omega,
                    Artificial::None | Artificial::Stiffness(_) => -2.0 * h * h * omega,
                },
                tied: [2.0 * omega, 2.0 * ih * omega],
                ..zero
            },
            (Variable::Damping, Artificial::None) => zero,
            (Variable::Damping, Artificial::Mass) => Self {
                mass: -2.0 * ih * omega * omega,
                ..zero
            },
            (Variable::Damping, Artificial::Stiffness(_)) => Self { own: -2.0 * ih, ..zero },
        }
    }

    /// sums ← Z x without rounding between its terms: the matrices are multiplied one by one, since their sum is
    /// rounded again at each frequency.
    fn exact_product(&self, block: &HarmonicBlock, x: &[Complex64], sums: &mut [ComplexSum], part: &mut [ComplexSum]) {
        let own = match &block.matrices.artificial {
            Artificial::Stiffness(own) => Some((self.own, own)),
            Artificial::None | Artificial::Mass => None,
        };
        let tied = block.matrices.tied.as_ref();
        let terms = [
            Some((self.reference.into(), &block.matrices.reference.values)),
            Some((self.damping, &block.matrices.damping)),
            Some((self.mass, &block.matrices.mass)),
            own,
            tied.map(|tied| (self.tied[0], &tied.stiffness)),
            tied.map(|tied| (self.tied[1], &tied.gyroscopic)),
        ];
        sums.fill(ComplexSum::default());
        for (factor, values) in terms.into_iter().flatten() {
            part.fill(ComplexSum::default());
            quadratic::product(&block.matrices.reference, values, x, part);
            for (sum, part) in sums.iter_mut().zip(part.iter()) {
                sum.add_multiple(*part, factor);
            }
        }
    }

    /// The factors of the matrices, in the order of a [`crate::condense::tuned_wheel::tuned_plan::TunedPlan`].
    fn factors(&self) -> [Complex64; TUNED_TERMS] {
        [
            self.reference.into(),
            self.damping,
            self.mass,
            self.tied[0],
            self.tied[1],
            self.own,
        ]
    }

    #[inline]
    fn at(&self, block: &HarmonicBlock, at: usize) -> Complex64 {
        let mut z = self.reference * block.matrices.reference.values[at]
            + self.damping * block.matrices.damping[at]
            + self.mass * block.matrices.mass[at];
        if let Some(tied) = &block.matrices.tied {
            z += self.tied[0] * tied.stiffness[at] + self.tied[1] * tied.gyroscopic[at];
        }
        match &block.matrices.artificial {
            Artificial::Stiffness(own) => z + self.own * own[at],
            Artificial::None | Artificial::Mass => z,
        }
    }
}

/// y += ∂Z x or y += ∂Zᵀ x for the i-th carried harmonic.
#[allow(clippy::too_many_arguments)]
pub(crate) fn add_slope_product(
    condensed: &Condensed,
    i: usize,
    (omega, damping): (Complex64, f64),
    by: Variable,
    transposed: bool,
    x: &[Complex64],
    y: &mut [Complex64],
) {
    let block = &condensed.blocks()[i];
    let pattern = &block.matrices.reference;
    let sum = Combination::slope(block, omega, damping, by);
    for j in 0..x.len() {
        for at in pattern.col_ptr[j]..pattern.col_ptr[j + 1] {
            let k = pattern.row_idx[at];
            let (to, from) = if transposed { (j, k) } else { (k, j) };
            y[to] += sum.at(block, at) * x[from];
        }
    }
    if let Some(directions) = &block.matrices.modal {
        add_term_product(directions, sum.damping, transposed, x, y);
    }
}

/// Fills the entries of ∂Z/∂ω of a harmonic, in the order of its pattern, without the damping of few modes.
pub(crate) fn fill_slope(
    block: &HarmonicBlock,
    DampedFrequency { omega, damping }: DampedFrequency,
    entries: &mut [Complex64],
) {
    let sum = Combination::slope(block, omega.into(), damping, Variable::Omega);
    for (at, entry) in entries.iter_mut().enumerate() {
        *entry = sum.at(block, at);
    }
}

/// y ← ∂Z/∂ω x for its entries in the order of the pattern of a harmonic, and the damping of few modes.
pub(crate) fn multiply_slope(block: &HarmonicBlock, entries: &[Complex64], x: &[Complex64], y: &mut [Complex64]) {
    let pattern = &block.matrices.reference;
    y.fill(Complex64::ZERO);
    for (x, ends) in x.iter().zip(pattern.col_ptr.windows(2)) {
        let column = ends[0]..ends[1];
        for (entry, &row) in entries[column.clone()].iter().zip(&pattern.row_idx[column]) {
            y[row] += entry * x;
        }
    }
    if let Some(directions) = &block.matrices.modal {
        let c = Complex64::new(0.0, block.number as f64);
        add_term_product(directions, c, false, x, y);
    }
}

fn at_harmonic(e: Error, block: &HarmonicBlock, omega: f64) -> Error {
    e.at(format_args!("harmonic {} at angular frequency {omega}", block.number))
}
