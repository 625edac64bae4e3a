//! Low-rank term of a flexibility table from modes: damping of contacts and springs that the modes leave out.
//!
//! With T′ the table of the modes, B the relative motions of contacts and springs,
//! Z_κ = (1 + c) K_κ − (ν² − iνα) M − Bᴴ e B and e = ck − i Im κ, or e = −iν for the directions of other damping
//!
//! > T = T′ + T′_B e X,  X = (1 − G′ e)⁻¹ T′ᴮ,
//!
//! where T′_B are the columns and T′ᴮ the rows of B, and G′ is where they cross (Woodbury's identity). X are the rows of B in T
//! itself, so that the term is added to the row of the response alone. By the frequency
//!
//! > ∂T = ∂T′ + ∂T′_B e X + T′_B (∂e X + e ∂X),  ∂X = (1 − G′ e)⁻¹ (∂T′ᴮ + (∂G′ e + G′ ∂e) X).

use crate::condense::Condensed;
use crate::condense::by_factors::flexibility::Table;
use crate::condense::by_modes::sum_terms::{Factors, Frequency};
use crate::error::{Result, boxed, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::dense::{complex_columns, complex_products};
use crate::linalg::factors::lu::Lu;
use crate::model::few_motions::reduced_wave::MotionRow;
use num_complex::Complex64;

const CONTEXT: &str = "the flexibility from modes";

/// Table T′ from modes and its slope ∂T′, rows × rows: contacts, response, springs.
pub struct Plain<'a> {
    pub value: &'a [Complex64],
    pub slope: &'a [Complex64],
    pub rows: usize,
}

/// Stiffness per row of B for one harmonic: the reference stiffness of the coordinates, then that of the springs, and
/// 0 for directions of other damping; and Im κ per coordinate.
pub struct Coefficients {
    coordinates: usize,
    stiffness: Vec<f64>,
    imaginary: Vec<f64>,
    /// Index of the first row of B that is a direction of damping beside αM + βK.
    first_damper: usize,
    /// Whether the low-rank term is not 0: with damping by stiffness or beside αM + βK, or with imaginary κ.
    pub counts: bool,
}

impl Coefficients {
    /// The coefficients of the i-th carried harmonic with its springs and number of dampers; `damped`: stiffness
    /// damps the structure.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(
        condensed: &Condensed,
        i: usize,
        (springs, dampers): (&[(MotionRow, f64)], usize),
        damped: bool,
    ) -> Result<Self> {
        let coordinates = condensed.coordinates();
        let first_damper = coordinates + springs.len();
        let mut stiffness = try_vec(first_damper + dampers, 0.0, CONTEXT)?;
        let mut imaginary = try_vec(stiffness.len(), 0.0, CONTEXT)?;
        for (c, (k, im)) in stiffness.iter_mut().zip(&mut imaginary).take(coordinates).enumerate() {
            let kappa = condensed.kappa(c, i);
            (*k, *im) = (kappa.re, kappa.im);
        }
        for (k, (_, spring)) in stiffness[coordinates..].iter_mut().zip(springs) {
            *k = *spring;
        }
        Ok(Self {
            coordinates,
            counts: damped || dampers > 0 || imaginary.iter().any(|&im| im != 0.0),
            stiffness,
            imaginary,
            first_damper,
        })
    }

    /// Number of rows of B.
    pub fn len(&self) -> usize {
        self.stiffness.len()
    }

    /// Coefficient e for row `b` of B.
    pub fn entry(&self, b: usize, at: Factors) -> Complex64 {
        self.d_entry(b, at) - Complex64::I * self.imaginary[b]
    }

    /// Derivative ∂e for row `b` of B, at the derivatives of the factors.
    pub fn d_entry(&self, b: usize, slope: Factors) -> Complex64 {
        if b < self.first_damper {
            slope.c * self.stiffness[b]
        } else {
            -slope.i_nu
        }
    }

    /// The numbers of the rows of B in a column of T′.
    pub fn rows_of(&self, column: &[Complex64], to: &mut [Complex64]) {
        let (contacts, springs) = to.split_at_mut(self.coordinates);
        contacts.copy_from_slice(&column[..self.coordinates]);
        springs.copy_from_slice(&column[self.coordinates + 1..]);
    }

    /// Row of B number b in T′: the response lies between contacts and springs.
    pub fn row_of(&self, b: usize) -> usize {
        if b < self.coordinates { b } else { b + 1 }
    }
}

/// Work space of the low-rank term, used for one harmonic after the other.
pub struct LowRank {
    coordinates: usize,
    lu: Lu<Complex64>,
    /// X and e X, one column for each contact and for the excitation.
    inner: Vec<Complex64>,
    force: Vec<Complex64>,
    /// e, and the conjugate of the row of the response in T′_B.
    entries: Vec<Complex64>,
    response: Vec<Complex64>,
    /// Memory for the product of that row with the columns.
    turned: Vec<Complex64>,
    sums: Vec<Complex64>,
    /// Made when all slopes are first wanted.
    slopes: Option<Box<AllSlopes>>,
}

/// Memory for the slopes of all rows.
struct AllSlopes {
    /// ∂X and ∂(e X), slopes by the frequency.
    inner: Vec<Complex64>,
    force: Vec<Complex64>,
    /// e X and ∂e X at all rows of T′ (zero in the row of the response), and products with them.
    forces: [Vec<Complex64>; 2],
    products: [Vec<Complex64>; 2],
}

impl AllSlopes {
    fn new(order: usize, columns: usize) -> Result<Self> {
        let narrow = || try_vec(order * columns, Complex64::ZERO, CONTEXT);
        let wide = || try_vec((order + 1) * columns, Complex64::ZERO, CONTEXT);
        Ok(Self {
            inner: narrow()?,
            force: narrow()?,
            forces: [wide()?, wide()?],
            products: [wide()?, wide()?],
        })
    }
}

impl LowRank {
    /// Work space for terms with `order` rows of B.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(coordinates: usize, order: usize) -> Result<Self> {
        let columns = || try_vec(order * (coordinates + 1), Complex64::ZERO, CONTEXT);
        Ok(Self {
            coordinates,
            lu: Lu::new(order, coordinates + 1)?,
            inner: columns()?,
            force: columns()?,
            entries: try_vec(order, Complex64::ZERO, CONTEXT)?,
            response: try_vec(order, Complex64::ZERO, CONTEXT)?,
            turned: try_vec(order, Complex64::ZERO, CONTEXT)?,
            sums: try_vec(coordinates + 1, Complex64::ZERO, CONTEXT)?,
            slopes: None,
        })
    }

    /// Number of rows of B.
    pub fn order(&self) -> usize {
        self.lu.order()
    }

    /// e X, column after column, after [`Self::add`].
    pub fn force(&self) -> &[Complex64] {
        &self.force
    }

    /// The entries of e, after [`Self::add`].
    pub fn entries(&self) -> &[Complex64] {
        &self.entries
    }

    /// X, column after column, after [`Self::add`].
    pub fn inner(&self) -> &[Complex64] {
        &self.inner
    }

    /// Replaces motions z of the rows of B by (1 − G′ e)⁻¹ z, after [`Self::add`].
    pub fn solve_rows(&self, z: &mut [Complex64]) {
        self.lu.solve(z);
    }

    /// Adds the low-rank term to a table that holds T′, and to the slope of the table if `slopes`.
    ///
    /// # Errors
    /// `Singular` where 1 − G′ e is; `StoppedByCaller`.
    pub fn add(
        &mut self,
        of: &Coefficients,
        plain: &Plain<'_>,
        (at, slopes): (Frequency, bool),
        table: &mut Table,
        interrupt: &Interrupt<'_>,
    ) -> Result<()> {
        if !of.counts || self.order() == 0 {
            return Ok(());
        }
        self.solve(of, plain, at, 0, interrupt)?;
        self.copy_rows(&self.inner, &mut table.value);
        self.add_response(Force::Own(0), &mut table.value);
        if slopes {
            let mut memory = match self.slopes.take() {
                Some(made) => made,
                None => boxed(|| AllSlopes::new(self.order(), self.coordinates + 1))?,
            };
            self.differentiate(of, plain, at, &mut memory, interrupt)?;
            self.copy_rows(&memory.inner, &mut table.slope);
            // ∂T′_B e X of the response is made with the others.
            let outputs = self.coordinates + 1;
            let made = memory.products[0].chunks_exact(plain.rows);
            for (to, product) in table.slope.chunks_exact_mut(outputs).zip(made) {
                to[self.coordinates] += product[self.coordinates];
            }
            self.add_response(Force::Of(&memory.force), &mut table.slope);
            self.slopes = Some(memory);
        }
        Ok(())
    }

    /// Adds the low-rank term to the column of the excitation alone, which holds that column of T′. Afterwards
    /// [`Self::force`] and [`Self::inner`] hold this column alone.
    ///
    /// # Errors
    /// As [`Self::add`].
    pub fn add_excited(
        &mut self,
        of: &Coefficients,
        plain: &Plain<'_>,
        at: Frequency,
        column: &mut [Complex64],
        interrupt: &Interrupt<'_>,
    ) -> Result<()> {
        if !of.counts || self.order() == 0 {
            return Ok(());
        }
        self.solve(of, plain, at, self.coordinates, interrupt)?;
        let from = self.coordinates * self.order();
        self.copy_rows(&self.inner[from..], column);
        self.add_response(Force::Own(from), column);
        Ok(())
    }

    /// Computes X and e X for the columns from `first` on.
    fn solve(
        &mut self,
        of: &Coefficients,
        plain: &Plain<'_>,
        at: Frequency,
        first: usize,
        interrupt: &Interrupt<'_>,
    ) -> Result<()> {
        let (order, rows) = (self.order(), plain.rows);
        let matrix = self.lu.matrix().chunks_exact_mut(order);
        for (q, to) in matrix.enumerate() {
            let e = -of.entry(q, at.at);
            of.rows_of(&plain.value[of.row_of(q) * rows..][..rows], to);
            for entry in to.iter_mut() {
                *entry *= e;
            }
            to[q] += 1.0;
        }
        self.lu.factor(interrupt)?;
        let columns = plain.value.chunks_exact(rows).take(self.coordinates + 1);
        for (from, to) in columns.zip(self.inner.chunks_exact_mut(order)).skip(first) {
            of.rows_of(from, to);
        }
        self.lu
            .solve_columns(&mut self.inner[first * order..], false, interrupt)?;
        for (b, (e, response)) in self.entries.iter_mut().zip(&mut self.response).enumerate() {
            *e = of.entry(b, at.at);
            *response = plain.value[of.row_of(b) * rows + self.coordinates].conj();
        }
        let columns = self.force.chunks_exact_mut(order).zip(self.inner.chunks_exact(order));
        for (force, x) in columns.skip(first) {
            for ((force, x), e) in force.iter_mut().zip(x).zip(&self.entries) {
                *force = e * x;
            }
        }
        Ok(())
    }

    /// Computes ∂X and ∂(e X), after [`Self::solve`].
    fn differentiate(
        &mut self,
        of: &Coefficients,
        plain: &Plain<'_>,
        at: Frequency,
        memory: &mut AllSlopes,
        interrupt: &Interrupt<'_>,
    ) -> Result<()> {
        let (order, rows) = (self.order(), plain.rows);
        let [forces, d_forces] = &mut memory.forces;
        let columns = self.force.chunks_exact(order).zip(self.inner.chunks_exact(order));
        let wide = forces.chunks_exact_mut(rows).zip(d_forces.chunks_exact_mut(rows));
        for ((force, x), (forces, d_forces)) in columns.zip(wide) {
            for (p, (force, x)) in force.iter().zip(x).enumerate() {
                forces[of.row_of(p)] = *force;
                d_forces[of.row_of(p)] = of.d_entry(p, at.slope) * x;
            }
        }
        let [by_slope, by_value] = &mut memory.products;
        for (table, forces, out) in [(plain.slope, &*forces, by_slope), (plain.value, &*d_forces, by_value)] {
            interrupt.check_before((2 * rows * forces.len()) as u64)?;
            complex_products::multiply(table, forces, out, rows);
        }
        let [by_slope, by_value] = &memory.products;
        for (k, sums) in memory.inner.chunks_exact_mut(order).enumerate() {
            for (p, sum) in sums.iter_mut().enumerate() {
                let at = k * rows + of.row_of(p);
                *sum = plain.slope[at] + by_slope[at] + by_value[at];
            }
        }
        self.lu.solve_columns(&mut memory.inner, false, interrupt)?;
        for k in 0..=self.coordinates {
            for p in 0..order {
                let x = self.inner[k * order + p];
                let d_x = memory.inner[k * order + p];
                memory.force[k * order + p] = of.entry(p, at.at) * d_x + of.d_entry(p, at.slope) * x;
            }
        }
        Ok(())
    }

    /// Copies the rows of the contacts from X, or from its slope, to the table.
    fn copy_rows(&self, x: &[Complex64], table: &mut [Complex64]) {
        let (order, outputs) = (self.order(), self.coordinates + 1);
        for (x, to) in x.chunks_exact(order).zip(table.chunks_exact_mut(outputs)) {
            to[..self.coordinates].copy_from_slice(&x[..self.coordinates]);
        }
    }

    /// Adds T′_B x to the row of the response.
    fn add_response(&mut self, from: Force<'_>, table: &mut [Complex64]) {
        let x = match from {
            Force::Own(at) => &self.force[at..],
            Force::Of(x) => x,
        };
        let (coordinates, columns) = (self.coordinates, table.len() / (self.coordinates + 1));
        let sums = &mut self.sums[..columns];
        complex_columns::multiply_adjoint(x, &self.response, &mut self.turned, sums);
        for (sum, to) in sums.iter().zip(table.chunks_exact_mut(coordinates + 1)) {
            to[coordinates] += sum.conj();
        }
    }
}

/// Columns x of [`LowRank::add_response`].
#[derive(Clone, Copy)]
enum Force<'x> {
    /// Those of e X from a number on.
    Own(usize),
    Of(&'x [Complex64]),
}
