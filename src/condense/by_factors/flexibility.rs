//! Dynamic flexibility of one harmonic by factorisation: response of the contacts and of the response degree of
//! freedom to contact forces and excitation, with its derivative by frequency.
//!
//! With outputs R (rows of W, then the response degree of freedom) and inputs B (Wᴴ, then F), the
//! table is H = R Z_κ⁻¹ B and ∂H/∂ω = −R Z_κ⁻¹ Z′ Z_κ⁻¹ B, Z′ = −2h²ωM + ihC.

use crate::condense::by_factors::dynamic_stiffness::{DampedFrequency, DynamicStiffness, Variable, add_slope_product};
use crate::condense::tuned_wheel::tuned_table::Outputs;
use crate::condense::{Condensed, HarmonicBlock};
use crate::error::{Result, boxed, try_copy, try_push, try_vec};
use crate::interrupt::Interrupt;
use crate::model::few_motions::reduced_wave::MotionRow;
use num_complex::Complex64;

pub(crate) const CONTEXT: &str = "the contact flexibility";

/// H and ∂H/∂ω of one harmonic: (coordinates + 1)² tables, column-major. Column j < coordinates is
/// the unit force of contact j, the last one the excitation; the last row is the response degree
/// of freedom.
#[derive(Clone, Debug)]
pub struct Table {
    /// H, the flexibility.
    pub value: Vec<Complex64>,
    /// ∂H/∂ω, its slope.
    pub slope: Vec<Complex64>,
}

impl Table {
    /// Zeroed tables for `coordinates` contacts, excitation and response.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(coordinates: usize) -> Result<Self> {
        Self::of_size((coordinates + 1).saturating_mul(coordinates + 1))
    }

    /// Zeroed tables of `size` entries each.
    pub(crate) fn of_size(size: usize) -> Result<Self> {
        Ok(Self {
            value: try_vec(size, Complex64::ZERO, CONTEXT)?,
            slope: try_vec(size, Complex64::ZERO, CONTEXT)?,
        })
    }
}

/// The derivatives by the frequency that a table is made with.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Slopes {
    /// No derivatives.
    None,
    /// Derivatives of the row of the response alone. The others number (coordinates)².
    OfResponse,
    /// Derivatives of the whole table.
    All,
}

/// Memory for the factorisation of Z_κ, one harmonic at a time.
pub struct Workspace {
    /// Dynamic stiffness with its factors, made when a factorisation first needs it; `None` where all tables are from
    /// modes.
    pub(crate) dynamic: Option<Box<DynamicStiffness>>,
    pub(crate) damping: f64,
    /// Per harmonic, the row that reads the response degree of freedom; empty without one.
    pub(crate) responses: Vec<MotionRow>,
    /// Z⁻¹ B, columns of `ndof` numbers.
    pub(crate) columns: Vec<Complex64>,
    /// Z⁻ᵀ Rᵀ, columns of `ndof` numbers.
    pub(crate) rows: Vec<Complex64>,
    /// Z′ Z⁻¹ B, some columns at a time.
    pub(crate) products: Vec<Complex64>,
    /// Entries of Z′, made when slopes are first requested.
    pub(crate) slope: Vec<Complex64>,
    pub(crate) load: Vec<Complex64>,
    /// Motion of all degrees of freedom and its change, made when they are first requested.
    pub(crate) motion: Vec<Complex64>,
    pub(crate) table: Table,
    /// Products of the response's change with the solutions side by side.
    pub(crate) along: Vec<Complex64>,
    /// Whether solutions side by side have lost digits, so that columns are kept and refined from then on.
    pub(crate) loses_digits: bool,
}

impl Workspace {
    /// Memory for a condensed model and its response degree of freedom.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(condensed: &Condensed, response: Option<usize>) -> Result<Self> {
        let n = condensed.ndof();
        let mut responses = Vec::new();
        for i in 0..condensed.blocks().len() {
            let row = response.map_or(Ok(MotionRow::default()), |dof| condensed.motion_row(i, dof));
            try_push(&mut responses, row?, CONTEXT)?;
        }
        Ok(Self {
            dynamic: None,
            damping: 0.0,
            responses,
            columns: Vec::new(),
            rows: Vec::new(),
            products: Vec::new(),
            slope: Vec::new(),
            load: try_vec(n, Complex64::ZERO, CONTEXT)?,
            motion: Vec::new(),
            table: Table::new(condensed.coordinates())?,
            along: Vec::new(),
            loses_digits: false,
        })
    }

    /// Sets the damping ratio of a nonlinear mode.
    pub fn set_damping(&mut self, damping: f64) {
        self.damping = damping;
    }

    /// Fills the columns Z⁻¹ B.
    fn solve_columns(&mut self, condensed: &Condensed, i: usize, omega: f64, interrupt: &Interrupt<'_>) -> Result<()> {
        let block = &condensed.blocks()[i];
        let size = condensed.ndof().saturating_mul(condensed.coordinates() + 1);
        if self.columns.len() != size {
            self.columns = Vec::new();
            self.columns = try_vec(size, Complex64::ZERO, CONTEXT)?;
        }
        for (k, column) in self.columns.chunks_exact_mut(condensed.ndof()).enumerate() {
            fill_load(block, k, omega, column);
        }
        made(&mut self.dynamic, condensed)?.solve(condensed, i, omega, &mut self.columns, false, interrupt)
    }

    /// Z⁻¹ Wᴴ of the i-th carried harmonic at `omega` with its current factors, column after column.
    ///
    /// # Errors
    /// As [`Self::evaluate`].
    pub(crate) fn contact_columns(
        &mut self,
        condensed: &Condensed,
        i: usize,
        omega: f64,
        interrupt: &Interrupt<'_>,
    ) -> Result<&[Complex64]> {
        self.solve_columns(condensed, i, omega, interrupt)?;
        Ok(&self.columns)
    }

    /// Evaluates H of the i-th carried harmonic at `omega`, and ∂H/∂ω if `slopes`.
    ///
    /// # Errors
    /// `Singular` naming the harmonic, at an undamped resonance that moves no contact; `StoppedByCaller`.
    pub fn evaluate(
        &mut self,
        condensed: &Condensed,
        i: usize,
        omega: f64,
        slopes: bool,
        interrupt: &Interrupt<'_>,
    ) -> Result<&Table> {
        let slopes = if slopes { Slopes::All } else { Slopes::None };
        self.tabulate_by_columns(condensed, (i, omega), slopes, interrupt)
    }

    /// The same with those slopes that are wanted. Columns of contacts are not kept where factors solve them side by side.
    ///
    /// # Errors
    /// As [`Self::evaluate`].
    pub(crate) fn tabulate(
        &mut self,
        condensed: &Condensed,
        (i, omega): (usize, f64),
        slopes: Slopes,
        interrupt: &Interrupt<'_>,
    ) -> Result<&Table> {
        made(&mut self.dynamic, condensed)?.factor(condensed, i, omega.into(), self.damping, interrupt)?;
        if slopes != Slopes::All && self.tabulate_side_by_side(condensed, (i, omega), slopes, interrupt)? {
            return Ok(&self.table);
        }
        self.tabulate_by_columns_with_factors(condensed, (i, omega), slopes, interrupt)
    }

    /// Exchanges the table that was made last for another one of the same size.
    pub(crate) fn exchange_table(&mut self, table: &mut Table) {
        core::mem::swap(&mut self.table, table);
    }

    /// Evaluates H and those slopes by columns that are kept, but for a wheel.
    fn tabulate_by_columns(
        &mut self,
        condensed: &Condensed,
        (i, omega): (usize, f64),
        slopes: Slopes,
        interrupt: &Interrupt<'_>,
    ) -> Result<&Table> {
        made(&mut self.dynamic, condensed)?.factor(condensed, i, omega.into(), self.damping, interrupt)?;
        self.tabulate_by_columns_with_factors(condensed, (i, omega), slopes, interrupt)
    }

    /// Tables by columns with the current factors.
    fn tabulate_by_columns_with_factors(
        &mut self,
        condensed: &Condensed,
        (i, omega): (usize, f64),
        slopes: Slopes,
        interrupt: &Interrupt<'_>,
    ) -> Result<&Table> {
        if slopes != Slopes::All && self.tabulate_wheel(condensed, (i, omega), interrupt)? {
            if slopes == Slopes::OfResponse {
                self.fill_adjoint_slopes(condensed, (i, omega), interrupt)?;
            } else {
                self.table.slope.fill(Complex64::ZERO);
            }
            return Ok(&self.table);
        }
        self.solve_columns(condensed, i, omega, interrupt)?;
        self.refine_columns((condensed, i, omega), interrupt)?;
        let block = &condensed.blocks()[i];
        let n = condensed.ndof();
        let outputs = condensed.coordinates() + 1;
        let rows = block.motions.rows.iter().chain(core::iter::once(&self.responses[i]));
        let tables = self.table.value.chunks_exact_mut(outputs);
        for (column, table) in self.columns.chunks_exact(n).zip(tables) {
            read(rows.clone(), column, table);
        }
        match slopes {
            Slopes::None => self.table.slope.fill(Complex64::ZERO),
            Slopes::OfResponse => self.fill_slopes_of_response(condensed, (i, omega), interrupt)?,
            Slopes::All => self.fill_all_slopes(condensed, (i, omega), interrupt)?,
        }
        Ok(&self.table)
    }

    /// Fills the table of a wheel from the factors of its waves, and keeps the column of the excitation alone.
    /// Returns `false` where the current factors are not those of waves, or the contacts of the sectors differ.
    fn tabulate_wheel(
        &mut self,
        condensed: &Condensed,
        (i, omega): (usize, f64),
        interrupt: &Interrupt<'_>,
    ) -> Result<bool> {
        let block = &condensed.blocks()[i];
        let Some(tuned) = made(&mut self.dynamic, condensed)?.tuned() else {
            return Ok(false);
        };
        block.force_at(omega, &mut self.load);
        let size = (tuned.plan.basis.sectors, tuned.plan.basis.order);
        let Some(outputs) = Outputs::new(block, size, &self.load, &self.responses[i]) else {
            return Ok(false);
        };
        if self.columns.len() != condensed.ndof() {
            self.columns = Vec::new();
            self.columns = try_vec(condensed.ndof(), Complex64::ZERO, CONTEXT)?;
        }
        let tabulated = tuned.tabulate(&outputs, (&mut self.table.value, &mut self.columns), interrupt);
        tabulated.map(|()| true)
    }

    /// Improves the columns Z⁻¹ B by refinement where a stiff penalty makes their rounding large.
    fn refine_columns(
        &mut self,
        (condensed, i, omega): (&Condensed, usize, f64),
        interrupt: &Interrupt<'_>,
    ) -> Result<()> {
        let dynamic = made(&mut self.dynamic, condensed)?;
        if !dynamic.should_refine(condensed, i, &self.columns) {
            return Ok(());
        }
        for (k, x) in self.columns.chunks_exact_mut(condensed.ndof()).enumerate() {
            fill_load(&condensed.blocks()[i], k, omega, &mut self.load);
            dynamic.refine(
                condensed,
                i,
                DampedFrequency::new(omega, self.damping),
                &self.load,
                x,
                interrupt,
            )?;
        }
        Ok(())
    }

    /// The k-th column of H and of its slope after [`Self::evaluate`], improved until only the rounding of the matrices is left; the
    /// slope where it is `wanted`.
    ///
    /// # Errors
    /// As [`Self::evaluate`].
    pub(crate) fn refined_column(
        &mut self,
        (condensed, i, k): (&Condensed, usize, usize),
        omega: f64,
        wanted: bool,
        interrupt: &Interrupt<'_>,
    ) -> Result<[Vec<Complex64>; 2]> {
        let block = &condensed.blocks()[i];
        let n = condensed.ndof();
        let rows = block.motions.rows.iter().chain(core::iter::once(&self.responses[i]));
        let outputs = || try_vec(condensed.coordinates() + 1, Complex64::ZERO, CONTEXT);
        let [mut value, mut slope] = [outputs()?, outputs()?];
        let dynamic = made(&mut self.dynamic, condensed)?;
        let at = DampedFrequency::new(omega, self.damping);
        let x = &mut self.columns[k * n..(k + 1) * n];
        fill_load(block, k, omega, &mut self.load);
        dynamic.refine(condensed, i, at, &self.load, x, interrupt)?;
        read(rows.clone(), x, &mut value);
        if wanted {
            self.load.fill(Complex64::ZERO);
            add_slope_product(
                condensed,
                i,
                (omega.into(), self.damping),
                Variable::Omega,
                false,
                x,
                &mut self.load,
            );
            for load in &mut self.load {
                *load = -*load;
            }
            if let Some(unbalance) = block.load.unbalance.as_ref().filter(|_| k == condensed.coordinates()) {
                for (load, u) in self.load.iter_mut().zip(unbalance) {
                    *load += 2.0 * omega * u;
                }
            }
            let mut change = try_copy(&self.load, CONTEXT)?;
            dynamic.solve(condensed, i, omega, &mut change, false, interrupt)?;
            dynamic.refine(condensed, i, at, &self.load, &mut change, interrupt)?;
            read(rows, &change, &mut slope);
        }
        Ok([value, slope])
    }

    /// Motion under the excitation, after [`Self::evaluate`].
    pub(crate) fn excited(&self) -> &[Complex64] {
        &self.columns[self.columns.len() - self.load.len()..]
    }

    /// Factors Z_κ of the i-th carried harmonic at `omega`, and replaces b by Z_κ⁻ᴴ b: the adjoint motion of a functional
    /// b of the motion.
    ///
    /// # Errors
    /// As [`Self::evaluate`].
    pub fn adjoint(
        &mut self,
        condensed: &Condensed,
        i: usize,
        omega: f64,
        b: &mut [Complex64],
        interrupt: &Interrupt<'_>,
    ) -> Result<()> {
        made(&mut self.dynamic, condensed)?.factor(condensed, i, omega.into(), self.damping, interrupt)?;
        self.adjoint_with_factors(condensed, i, omega, b, interrupt)
    }

    /// Replaces b by Z_κ⁻ᴴ b with the current factors, which must belong to the i-th harmonic at `omega`.
    ///
    /// # Errors
    /// As [`Self::evaluate`].
    pub fn adjoint_with_factors(
        &mut self,
        condensed: &Condensed,
        i: usize,
        omega: f64,
        b: &mut [Complex64],
        interrupt: &Interrupt<'_>,
    ) -> Result<()> {
        let dynamic = made(&mut self.dynamic, condensed)?;
        for z in b.iter_mut() {
            *z = z.conj();
        }
        dynamic.solve(condensed, i, omega, b, true, interrupt)?;
        for z in b.iter_mut() {
            *z = z.conj();
        }
        Ok(())
    }

    /// Factors Z_κ of the i-th carried harmonic at `omega`, and replaces b by Z_κ⁻¹ b: the motion under a load b.
    ///
    /// # Errors
    /// As [`Self::evaluate`].
    pub fn motion_under(
        &mut self,
        condensed: &Condensed,
        i: usize,
        omega: f64,
        b: &mut [Complex64],
        interrupt: &Interrupt<'_>,
    ) -> Result<()> {
        let dynamic = made(&mut self.dynamic, condensed)?;
        dynamic.factor(condensed, i, omega.into(), self.damping, interrupt)?;
        dynamic.solve(condensed, i, omega, b, false, interrupt)
    }

    /// y += ∂Z_κ/∂ω x in the i-th carried harmonic at `omega`.
    pub fn add_frequency_slope(
        &self,
        condensed: &Condensed,
        i: usize,
        omega: f64,
        x: &[Complex64],
        y: &mut [Complex64],
    ) {
        let at = (omega.into(), self.damping);
        add_slope_product(condensed, i, at, Variable::Omega, false, x, y);
    }

    /// Motion of all degrees of freedom in the i-th carried harmonic, x = Z_κ⁻¹(F − Wᴴ w), where
    /// `contact_force` holds w = f − κ y per coordinate.
    ///
    /// # Errors
    /// As [`Self::evaluate`].
    pub fn recover(
        &mut self,
        condensed: &Condensed,
        i: usize,
        omega: f64,
        contact_force: &[Complex64],
        x: &mut [Complex64],
        interrupt: &Interrupt<'_>,
    ) -> Result<()> {
        self.solve_under(condensed, (i, omega), contact_force, x, interrupt)?;
        made(&mut self.dynamic, condensed)?.refine(
            condensed,
            i,
            DampedFrequency::new(omega, self.damping),
            &self.load,
            x,
            interrupt,
        )
    }

    /// Motion of all degrees of freedom as in `recover`, but without refinement: with the digits that the
    /// factorisation has.
    pub(crate) fn solve_under(
        &mut self,
        condensed: &Condensed,
        (i, omega): (usize, f64),
        contact_force: &[Complex64],
        x: &mut [Complex64],
        interrupt: &Interrupt<'_>,
    ) -> Result<()> {
        let dynamic = made(&mut self.dynamic, condensed)?;
        dynamic.factor(condensed, i, omega.into(), self.damping, interrupt)?;
        let block = &condensed.blocks()[i];
        block.force_at(omega, &mut self.load);
        for (row, w) in block.motions.rows.iter().zip(contact_force) {
            for &(p, a) in row.terms() {
                self.load[p] -= a.conj() * w;
            }
        }
        x.copy_from_slice(&self.load);
        dynamic.solve(condensed, i, omega, x, false, interrupt)
    }

    /// The change of a motion x that was recovered last, dx = Z_κ⁻¹(∂F/∂ω dω − Wᴴ dw − ∂Z_κ/∂ω x dω), in the i-th carried
    /// harmonic at ω.
    ///
    /// # Errors
    /// As [`Self::evaluate`].
    pub fn recover_along(
        &mut self,
        condensed: &Condensed,
        (i, omega): (usize, f64),
        (dw, d_omega): (&[Complex64], f64),
        x: &[Complex64],
        dx: &mut [Complex64],
        interrupt: &Interrupt<'_>,
    ) -> Result<()> {
        let block = &condensed.blocks()[i];
        dx.fill(Complex64::ZERO);
        self.add_frequency_slope(condensed, i, omega, x, dx);
        for z in dx.iter_mut() {
            *z *= -d_omega;
        }
        for (z, u) in dx.iter_mut().zip(block.load.unbalance.iter().flatten()) {
            *z += 2.0 * omega * u * d_omega;
        }
        for (row, dw) in block.motions.rows.iter().zip(dw) {
            for &(p, a) in row.terms() {
                dx[p] -= a.conj() * dw;
            }
        }
        made(&mut self.dynamic, condensed)?.solve(condensed, i, omega, dx, false, interrupt)
    }
}

/// The dynamic stiffness with its factors, made here if it does not exist yet.
pub(crate) fn made<'a>(
    dynamic: &'a mut Option<Box<DynamicStiffness>>,
    condensed: &Condensed,
) -> Result<&'a mut DynamicStiffness> {
    let known = match dynamic.take() {
        Some(known) => known,
        None => boxed(|| DynamicStiffness::new(condensed, condensed.coordinates() + 1))?,
    };
    Ok(dynamic.insert(known))
}

/// The k-th column of B: the unit force of a contact, the last one the excitation at `omega`.
fn fill_load(block: &HarmonicBlock, k: usize, omega: f64, load: &mut [Complex64]) {
    let Some(row) = block.motions.rows.get(k) else {
        return block.force_at(omega, load);
    };
    load.fill(Complex64::ZERO);
    for &(p, a) in row.terms() {
        load[p] += a.conj();
    }
}

/// Fills a column of the table with R x, the motions that `rows` read from x.
pub(crate) fn read<'r>(rows: impl Iterator<Item = &'r MotionRow>, x: &[Complex64], table: &mut [Complex64]) {
    for (value, row) in table.iter_mut().zip(rows) {
        *value = row.along(x);
    }
}
