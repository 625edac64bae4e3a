//! Motion of the structure in one harmonic under contact forces alone, with its derivatives for Newton's method: by
//! the contact forces (the flexibility), by frequency and by damping ratio.
//!
//! x = −Z⁻¹ Wᴴ w, ∂x/∂w = −Z⁻¹ Wᴴ, ∂x/∂ω = −Z⁻¹ Z_ω x, ∂x/∂D = −Z⁻¹ Z_D x: sums over the modes of the wave where it has such, else by
//! factorisation.

use crate::condense::by_factors::dynamic_stiffness::{DampedFrequency, DynamicStiffness, Variable, add_slope_product};
use crate::condense::by_modes::modal_rows::ModalRows;
use crate::condense::by_modes::mode_sums::{GaugeProducts, ModeSums, SumWork};
use crate::condense::by_modes::sum_terms::Source;
use crate::condense::{Artificial, Condensed};
use crate::error::{Result, Status, boxed, try_push, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::inner;
use crate::model::matrices::sector_motion::MOTION_TERMS;
use num_complex::Complex64;
use std::sync::Arc;

/// Motion x of one harmonic and its derivatives.
pub struct ModeFlexibility {
    coordinates: usize,
    reference_dof: usize,
    /// Per harmonic the sums over modes, where they are used, with the index of its wave.
    sums: Vec<Option<(ModeSums, usize)>>,
    /// Per wave, whether its sums agreed with a factorisation.
    agree: Vec<bool>,
    work: Option<SumWork>,
    /// Solution by factorisation, made when it is first needed.
    direct: Option<Box<Direct>>,
    x: Vec<Complex64>,
    /// W Z⁻¹ Wᴴ, column after column.
    value: Vec<Complex64>,
    /// Relative motions of the contacts: of x, ∂x/∂ω and ∂x/∂D.
    relative: Vec<Complex64>,
    gauge: GaugeProducts,
    /// Index of the harmonic solved last by sums; `None` if it was by factorisation.
    by_sums: Option<usize>,
}

/// Solution of one harmonic by factorisation.
struct Direct {
    dynamic: DynamicStiffness,
    /// Z⁻¹ Wᴴ, column after column.
    columns: Vec<Complex64>,
    x: Vec<Complex64>,
    /// ∂x/∂ω and ∂x/∂D, on all degrees of freedom.
    rates: [Vec<Complex64>; 2],
    load: Vec<Complex64>,
}

/// Largest relative deviation of sums from a solution by factorisation, and over the error of that solution.
/// Kind: rounding.
const DEVIATION: f64 = 1e-11;
/// Largest deviation of sums over the error of the solution by factorisation.
/// Kind: tuned; measured on: not recorded.
pub(crate) const BEYOND_ITS_ERROR: f64 = 10.0;

/// Relative distance from an undamped resonance that moves no contact at which a motion is that at the resonance, but for rounding.
/// Kind: rounding.
const BESIDE: f64 = 64.0 * f64::EPSILON;

const CONTEXT: &str = "the flexibility of a mode";

impl ModeFlexibility {
    /// Memory for a condensed model whose normalisation reads the independent degree of freedom `reference_dof`.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(condensed: &Condensed, reference_dof: usize) -> Result<Self> {
        let (n, coordinates) = (condensed.ndof(), condensed.coordinates());
        let zeros = |len| try_vec(len, Complex64::ZERO, CONTEXT);
        let (mut sums, mut agree, mut waves) = (Vec::new(), Vec::new(), Vec::<Arc<ModalRows>>::new());
        for (i, block) in condensed.blocks().iter().enumerate() {
            let of_harmonic = match &block.source {
                Some(source @ Source::Modes(_)) if !matches!(block.matrices.artificial, Artificial::None) => {
                    let known = waves.iter().position(|rows| rows.are_of(block, source));
                    let wave = known.unwrap_or(waves.len());
                    if known.is_none() {
                        let mut row = [None; MOTION_TERMS];
                        row[0] = Some((reference_dof, Complex64::ONE));
                        let row = block.row(&row)?;
                        let springs =
                            ModeSums::damps_springs(&block.matrices.artificial) || source.is_damped_by_stiffness();
                        let rows = ModalRows::with_rows((condensed, i), &row, source.clone(), springs)?;
                        try_push(&mut waves, Arc::new(rows), CONTEXT)?;
                        try_push(&mut agree, false, CONTEXT)?;
                    }
                    ModeSums::new((condensed, i), Arc::clone(&waves[wave]))?.map(|sums| (sums, wave))
                }
                _ => None,
            };
            try_push(&mut sums, of_harmonic, CONTEXT)?;
        }
        Ok(Self {
            coordinates,
            reference_dof,
            sums,
            agree,
            work: None,
            direct: None,
            x: zeros(n)?,
            value: zeros(coordinates.saturating_mul(coordinates))?,
            relative: zeros(3 * coordinates)?,
            gauge: GaugeProducts {
                of_columns: try_vec(coordinates, [Complex64::ZERO; 2], CONTEXT)?,
                ..GaugeProducts::default()
            },
            by_sums: None,
        })
    }

    /// Solves for the i-th carried harmonic at frequency `omega` and damping ratio `damping` under
    /// w = f − κ y.
    ///
    /// # Errors
    /// `Singular` naming the harmonic, at an undamped resonance that moves no contact; `OutOfMemory`; `StoppedByCaller`.
    pub fn solve(
        &mut self,
        condensed: &Condensed,
        i: usize,
        at: DampedFrequency,
        w: &[Complex64],
        interrupt: &Interrupt<'_>,
    ) -> Result<()> {
        self.by_sums = None;
        if let Some((sums, wave)) = &self.sums[i] {
            let work = match self.work.take() {
                Some(work) if sums.fits(&work) => work,
                _ => sums.work()?,
            };
            let work = self.work.insert(work);
            if sums.solve(work, at, w, (&mut self.x, &mut self.relative), interrupt)? {
                let outputs = self.coordinates + 1;
                let columns = work.table().chunks_exact(outputs);
                for (to, from) in self.value.chunks_exact_mut(self.coordinates.max(1)).zip(columns) {
                    to.copy_from_slice(&from[..outputs - 1]);
                }
                let wave = *wave;
                if self.agree[wave] || self.agrees((condensed, i), at, w, interrupt)? {
                    self.agree[wave] = true;
                    self.by_sums = Some(i);
                    return Ok(());
                }
                for sums in &mut self.sums {
                    if sums.as_ref().is_some_and(|(_, of)| *of == wave) {
                        *sums = None;
                    }
                }
            }
        }
        let direct = made(&mut self.direct, condensed)?;
        direct.solve((condensed, i), at, w, interrupt)?;
        self.x.copy_from_slice(&direct.x);
        direct.read((condensed, i), &mut self.value, &mut self.relative);
        Ok(())
    }

    /// Whether the solution by sums equals the one by factorisation, as far as the latter has digits.
    fn agrees(
        &mut self,
        (condensed, i): (&Condensed, usize),
        at: DampedFrequency,
        w: &[Complex64],
        interrupt: &Interrupt<'_>,
    ) -> Result<bool> {
        let direct = made(&mut self.direct, condensed)?;
        direct.solve((condensed, i), at, w, interrupt)?;
        let coordinates = self.coordinates;
        let zeros = |len| try_vec(len, Complex64::ZERO, CONTEXT);
        let (mut value, mut relative) = (zeros(self.value.len())?, zeros(self.relative.len())?);
        direct.read((condensed, i), &mut value, &mut relative);
        let parts = |of: &[Complex64], k: usize| of[k * coordinates..(k + 1) * coordinates].to_vec();
        for k in 0..3 {
            let (by_sums, plain) = (parts(&self.relative, k), parts(&relative, k));
            if off(&by_sums, &plain) > DEVIATION {
                direct.refine((condensed, i), at, k, interrupt)?;
                direct.read((condensed, i), &mut value, &mut relative);
                let refined = parts(&relative, k);
                if off(&by_sums, &refined) > DEVIATION.max(BEYOND_ITS_ERROR * off(&plain, &refined)) {
                    return Ok(false);
                }
            }
        }
        let deviation = |c: usize| off(&parts(&self.value, c), &parts(&value, c));
        let Some(worst) = (0..coordinates).max_by(|a, b| deviation(*a).total_cmp(&deviation(*b))) else {
            return Ok(true);
        };
        if deviation(worst) > DEVIATION {
            let plain = parts(&value, worst);
            direct.refine_column((condensed, i), at, worst, interrupt)?;
            direct.read((condensed, i), &mut value, &mut relative);
            let (by_sums, refined) = (parts(&self.value, worst), parts(&value, worst));
            return Ok(off(&by_sums, &refined) <= DEVIATION.max(BEYOND_ITS_ERROR * off(&plain, &refined)));
        }
        Ok(true)
    }

    /// Computes the products of the normalisation with the solution of the fundamental, which was solved last;
    /// `weighted` is B x.
    pub fn fix_gauge(&mut self, weighted: &[Complex64]) {
        if let (Some(i), Some(work)) = (self.by_sums, &mut self.work)
            && let Some((sums, _)) = &self.sums[i]
        {
            sums.gauge(work, weighted, &mut self.gauge);
            return;
        }
        let Some(direct) = &self.direct else { return };
        let dof = self.reference_dof;
        let columns = direct.columns.chunks_exact(weighted.len());
        for (out, column) in self.gauge.of_columns.iter_mut().zip(columns) {
            *out = [inner(weighted, column), column[dof]];
        }
        for (out, rate) in self.gauge.of_rates.iter_mut().zip(&direct.rates) {
            *out = [inner(weighted, rate), rate[dof]];
        }
    }

    /// (B x)ᴴ Z⁻¹ Wᴴ of one contact, and the motion of the reference degree of freedom under a unit force of it.
    pub fn gauge_of_column(&self, coordinate: usize) -> [Complex64; 2] {
        self.gauge.of_columns[coordinate]
    }

    /// (B x)ᴴ ∂x, and ∂x of the reference degree of freedom: by frequency, then by damping ratio.
    pub fn gauge_of_rates(&self) -> [[Complex64; 2]; 2] {
        self.gauge.of_rates
    }

    /// Relative motions of the contacts: of x, ∂x/∂ω and ∂x/∂D.
    pub fn relative(&self, row: usize) -> [Complex64; 3] {
        [0, 1, 2].map(|k| self.relative[k * self.coordinates + row])
    }

    /// Relative motions W Z⁻¹ Wᴴ of the contacts under a unit force on each, column after column.
    pub fn value(&self) -> &[Complex64] {
        &self.value
    }

    /// Motion x of the harmonic solved last: on all degrees of freedom, or in the modes where [`Self::is_of_modes`].
    pub fn x(&self) -> &[Complex64] {
        &self.x
    }

    /// Whether the motion of the harmonic solved last is given in the modes of its wave.
    pub fn is_of_modes(&self) -> bool {
        let sums = self.by_sums.and_then(|i| self.sums[i].as_ref());
        sums.is_some_and(|(sums, _)| !sums.is_fundamental())
    }

    /// The largest motion of the harmonic solved last, or a bound of it.
    #[must_use]
    pub fn largest(&self) -> f64 {
        if let Some((sums, _)) = self.by_sums.and_then(|i| self.sums[i].as_ref())
            && !sums.is_fundamental()
        {
            return sums.bound(&self.x);
        }
        self.x.iter().fold(0.0_f64, |m, z| m.max(z.norm_sqr())).sqrt()
    }

    /// Turns a motion of the i-th carried harmonic in the modes of its wave into one of all degrees of freedom.
    pub fn expand(&self, i: usize, of_modes: &[Complex64], x: &mut [Complex64], memory: &mut [Complex64]) {
        if let Some((sums, _)) = &self.sums[i] {
            sums.expand(of_modes, x, memory);
        }
    }
}

impl Direct {
    fn new(condensed: &Condensed) -> Result<Self> {
        let (n, coordinates) = (condensed.ndof(), condensed.coordinates());
        let zeros = |len| try_vec(len, Complex64::ZERO, CONTEXT);
        Ok(Self {
            dynamic: DynamicStiffness::new(condensed, coordinates.max(1))?,
            columns: zeros(n.saturating_mul(coordinates))?,
            x: zeros(n)?,
            rates: [zeros(n)?, zeros(n)?],
            load: zeros(n)?,
        })
    }

    fn solve(
        &mut self,
        (condensed, i): (&Condensed, usize),
        DampedFrequency { omega, damping }: DampedFrequency,
        w: &[Complex64],
        interrupt: &Interrupt<'_>,
    ) -> Result<()> {
        let n = self.x.len();
        let rows = &condensed.blocks()[i].motions.rows;
        match self.dynamic.factor(condensed, i, omega.into(), damping, interrupt) {
            // A body that moves no contact may have the frequency of the mode: at rest it is beside that, too.
            Err(e) if e.status == Status::Singular => {
                let beside = omega * (1.0 + BESIDE);
                self.dynamic.factor(condensed, i, beside.into(), damping, interrupt)?;
            }
            factored => factored?,
        }
        self.columns.fill(Complex64::ZERO);
        for (column, row) in self.columns.chunks_exact_mut(n).zip(rows) {
            for &(p, a) in row.terms() {
                column[p] += a.conj();
            }
        }
        self.dynamic
            .solve(condensed, i, omega, &mut self.columns, false, interrupt)?;
        self.x.fill(Complex64::ZERO);
        for (column, w) in self.columns.chunks_exact(n).zip(w) {
            for (x, z) in self.x.iter_mut().zip(column) {
                *x -= z * w;
            }
        }
        // On stiff structures Newton's method would not get below the rounding of an unrefined solution.
        self.load.fill(Complex64::ZERO);
        for (row, w) in rows.iter().zip(w) {
            for &(p, a) in row.terms() {
                self.load[p] -= a.conj() * w;
            }
        }
        self.dynamic.refine(
            condensed,
            i,
            DampedFrequency { omega, damping },
            &self.load,
            &mut self.x,
            interrupt,
        )?;
        for (rate, by) in self.rates.iter_mut().zip([Variable::Omega, Variable::Damping]) {
            rate.fill(Complex64::ZERO);
            add_slope_product(condensed, i, (omega.into(), damping), by, false, &self.x, rate);
            self.dynamic.solve(condensed, i, omega, rate, false, interrupt)?;
            for z in rate.iter_mut() {
                *z = -*z;
            }
        }
        Ok(())
    }

    /// Refines a derivative of the motion, by the frequency (`which` = 1) or the damping ratio (2), until only the
    /// rounding of the matrices is left.
    fn refine(
        &mut self,
        (condensed, i): (&Condensed, usize),
        at: DampedFrequency,
        which: usize,
        interrupt: &Interrupt<'_>,
    ) -> Result<()> {
        let Some(rate) = which.checked_sub(1).and_then(|k| self.rates.get_mut(k)) else {
            return Ok(());
        };
        let by = [Variable::Omega, Variable::Damping][which - 1];
        self.load.fill(Complex64::ZERO);
        add_slope_product(
            condensed,
            i,
            (at.omega.into(), at.damping),
            by,
            false,
            &self.x,
            &mut self.load,
        );
        for z in &mut self.load {
            *z = -*z;
        }
        self.dynamic.refine(condensed, i, at, &self.load, rate, interrupt)
    }

    /// Refines the column Z⁻¹ Wᴴ of a coordinate until only the rounding of the matrices is left.
    fn refine_column(
        &mut self,
        (condensed, i): (&Condensed, usize),
        at: DampedFrequency,
        coordinate: usize,
        interrupt: &Interrupt<'_>,
    ) -> Result<()> {
        self.load.fill(Complex64::ZERO);
        for &(p, a) in condensed.blocks()[i].motions.rows[coordinate].terms() {
            self.load[p] += a.conj();
        }
        let n = self.x.len();
        let column = &mut self.columns[coordinate * n..(coordinate + 1) * n];
        self.dynamic.refine(condensed, i, at, &self.load, column, interrupt)
    }

    /// Reads the relative motions of the contacts from the motions on all degrees of freedom.
    fn read(&self, (condensed, i): (&Condensed, usize), value: &mut [Complex64], relative: &mut [Complex64]) {
        let rows = &condensed.blocks()[i].motions.rows;
        let motions = |to: &mut [Complex64], x: &[Complex64]| {
            for (to, row) in to.iter_mut().zip(rows) {
                *to = row.along(x);
            }
        };
        let columns = self.columns.chunks_exact(self.x.len());
        for (to, column) in value.chunks_exact_mut(rows.len().max(1)).zip(columns) {
            motions(to, column);
        }
        let of_motion = [&self.x, &self.rates[0], &self.rates[1]];
        for (to, x) in relative.chunks_exact_mut(rows.len().max(1)).zip(of_motion) {
            motions(to, x);
        }
    }
}

fn made<'a>(direct: &'a mut Option<Box<Direct>>, condensed: &Condensed) -> Result<&'a mut Direct> {
    let known = match direct.take() {
        Some(known) => known,
        None => boxed(|| Direct::new(condensed))?,
    };
    Ok(direct.insert(known))
}

/// Relative deviation of vector `a` from vector `b`.
fn off(a: &[Complex64], b: &[Complex64]) -> f64 {
    let off: f64 = a.iter().zip(b).map(|(a, b)| (a - b).norm_sqr()).sum();
    let size: f64 = b.iter().map(Complex64::norm_sqr).sum();
    if off == 0.0 { 0.0 } else { (off / size).sqrt() }
}

#[cfg(test)]
#[path = "mode_flexibility_tests.rs"]
mod tests;
