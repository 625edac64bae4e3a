//! The forced response as a [`Problem`]: the unknowns are the packed relative motions of the contacts, the parameter
//! is the angular frequency ω, or in a homotopy that of its [`Path`].
//!
//! R = y − y_lin + G(f(y) − κ y), ∂R/∂y = I + G(J − κ), ∂R/∂ω = −∂y_lin + ∂G (f − κ y) + G ∂f/∂ω.

mod balance_problem;
mod contact_terms;

use crate::condense::Condensed;
use crate::condense::FlexibilityWay;
use crate::condense::by_modes::modal_table::ModalTable;
use crate::condense::frequency_cache::FrequencyCache;
use crate::error::{Result, boxed, try_vec};
use crate::fourier::HarmonicSet;
use crate::interrupt::Interrupt;
use crate::linalg::newton::linear_system::{Jacobian, MatrixFree};
use crate::options::Range;
use crate::options::Response;
use crate::problem::contact_base::ContactBase;
use crate::problem::contact_forces::ContactForces;
use crate::problem::contact_forces::single_matrix;
use crate::problem::gauges::{Gauges, Seen};
use crate::problem::homotopy::Path;
use crate::problem::parametric_problem::{Residual, put};
use crate::problem::residual_scale::Squares;
use crate::problem::ring_blocks::RingBlocks;
use crate::problem::single_balance::{self, SingleForce};
use crate::problem::static_force::static_force;
use num_complex::Complex64;

/// Harmonics between two checks of the interrupt.
/// Kind: block.
const HARMONIC_BALANCE_BETWEEN_CHECKS: usize = 16;

/// Largest share of the period in which a contact sticks, or does not, whose terms in Newton's matrix have a low rank.
/// Kind: tuned; measured on: one slider with 64 harmonics, whose terms are then up to a fourth of the unknowns.
const SHORT_PIECES: f64 = 0.16;

/// Coordinates from which the residual takes its products with columns as a whole.
/// Kind: tuned; measured on: a rod of 1,000 with 300 sliders.
const PRODUCTS_FROM: usize = 16;

/// The forced response of a condensed model.
pub struct HarmonicBalance<'a> {
    pub(super) condensed: &'a Condensed,
    /// Contact forces, in a box as other parts of problems are: calls that pass them by value then need little of a
    /// small stack.
    pub(super) forces: Box<ContactForces<'a>>,
    pub(super) tables: Box<FrequencyCache>,
    /// Index of the observed harmonic among the carried ones.
    observed: usize,
    given: Option<Vec<f64>>,
    /// Whether the static solution is not zero, because a contact is preloaded or a law has a static force.
    loaded_at_rest: bool,
    pub(super) memory: BalanceMemory,
    pub(super) products: ProductMemory,
    /// Further responses; and the values that the last reading of one found.
    gauges: Option<Box<Gauges<'a>>>,
    seen: Vec<Seen>,
}

/// Memory of an evaluation.
pub struct BalanceMemory {
    /// Memory: one number per coordinate, for a column of the Jacobian.
    pub(super) sum: Vec<Complex64>,
    /// Flexibility G in the layout of [`ContactForces::couple_all`].
    flexibility: Vec<Complex64>,
    /// Per harmonic, the derivatives of the motions by the frequency under constant forces, where tables lack slopes.
    along: Vec<Complex64>,
    /// Memory: one packed signal.
    pub(super) change: Vec<f64>,
}

/// Memory of products with the Jacobian. The part for systems that are solved by iteration is allocated by the first
/// product.
#[derive(Default)]
pub(super) struct ProductMemory {
    pub change: Vec<f64>,
    /// Memory: numbers of one harmonic, and their product.
    pub harmonic: [Vec<Complex64>; 2],
    pub column: Vec<f64>,
    /// Stored contact Jacobians, and the motions that none of them couples back.
    pub kept: Vec<f64>,
    pub silent: Vec<bool>,
    /// Means over the sectors, where the structure is a whole wheel.
    pub ring: Option<Box<RingBlocks>>,
    /// The matrix of what contacts do for most of the period, of other structures.
    pub base: Option<Box<ContactBase>>,
}

impl<'a> HarmonicBalance<'a> {
    /// A problem on `condensed` for frequencies in `range`, observing degree of freedom `response` in its lowest
    /// carried harmonic above zero. `samples` = 0 locates events exactly; `given` is a packed initial guess.
    ///
    /// # Errors
    /// `OutOfMemory`; those of callbacks, whose force at zero motion is evaluated; `StoppedByCaller`.
    pub fn new(
        condensed: &'a Condensed,
        response: usize,
        range: Range,
        samples: usize,
        given: Option<Vec<f64>>,
        interrupt: &'a Interrupt<'a>,
    ) -> Result<Self> {
        const CONTEXT: &str = "the forced response";
        let set = condensed.set();
        let coordinates = condensed.coordinates();
        let of_harmonic = || try_vec(coordinates, Complex64::ZERO, CONTEXT);
        let flexibility = coordinates
            .saturating_mul(coordinates)
            .saturating_mul(set.numbers().len());
        let loaded_at_rest =
            condensed.is_preloaded() || static_force(condensed, range.start, samples, interrupt)?.is_some();
        Ok(Self {
            condensed,
            forces: Box::new(ContactForces::new(condensed, samples, interrupt)?),
            tables: boxed(|| FrequencyCache::new(condensed, response, range, interrupt))?,
            observed: set.watched(),
            given,
            loaded_at_rest,
            memory: BalanceMemory {
                sum: try_vec(condensed.coordinates(), Complex64::ZERO, CONTEXT)?,
                flexibility: try_vec(flexibility, Complex64::ZERO, CONTEXT)?,
                along: Vec::new(),
                change: try_vec(set.packed_len(), 0.0, CONTEXT)?,
            },
            products: ProductMemory {
                change: try_vec(condensed.unknowns(), 0.0, CONTEXT)?,
                harmonic: [of_harmonic()?, of_harmonic()?],
                ring: RingBlocks::new(condensed)?.map(Box::new),
                ..ProductMemory::default()
            },
            gauges: None,
            seen: Vec::new(),
        })
    }

    /// Adds further `responses`, which are observed at solved points.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn watch(&mut self, responses: (&[Response<'_>], usize), samples: usize) -> Result<()> {
        let (condensed, interrupt) = (self.condensed, self.forces.interrupt());
        self.gauges = match responses.0 {
            [] => None,
            _ => Some(boxed(|| Gauges::new(condensed, responses, samples, interrupt))?),
        };
        Ok(())
    }

    /// Reads all further responses at `v` = (u, ω), with their derivatives along a direction.
    ///
    /// # Errors
    /// Those of [`Gauges::read`].
    pub fn see_all(&mut self, v: &[f64], direction: &[f64], seen: &mut Vec<Seen>) -> Result<()> {
        seen.clear();
        match &mut self.gauges {
            Some(gauges) => gauges.read(v, direction, None, seen),
            None => Ok(()),
        }
    }

    /// Makes the flexibility of the harmonics from the given modes. This is for fixed frequencies only.
    pub fn set_modes(&mut self, modal: Vec<Option<ModalTable>>) {
        self.tables.set_modes(modal);
    }

    /// How the flexibility is made along a sweep, and why in this way.
    #[must_use]
    pub fn flexibility_way(&self) -> FlexibilityWay {
        self.tables.flexibility_way()
    }

    /// Whether the flexibility is made from modes.
    #[must_use]
    pub fn has_modes(&self) -> bool {
        self.tables.has_modes()
    }

    /// Share of the period that each law slips, at the point last evaluated.
    #[must_use]
    pub fn slip_fractions(&self) -> &[f64] {
        self.forces.slip_fractions()
    }

    /// Relative change of the forces with the number of samples; see [`ContactForces::sampling_error`].
    ///
    /// # Errors
    /// Those of callbacks that give up.
    pub fn sampling_error(&mut self, u: &[f64], omega: f64) -> Result<f64> {
        self.forces.sampling_error(u, omega)
    }

    /// Largest share of its linear range that a contact uses, see [`ContactForces::linearisation_scale`].
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn linear_share(&mut self, u: &[f64], omega: f64) -> Result<f64> {
        self.forces.linearisation_scale(u, omega)
    }

    /// Residual at the frequency `omega` and its derivative by ω, or by the parameter p of a path.
    fn evaluate_at(&mut self, u: &[f64], omega: f64, path: Option<(Path, f64)>, out: &mut Residual) -> Result<()> {
        let scale = match path {
            Some((Path::ScaledLaws, p)) => p.exp(),
            Some((Path::GrowingLoad | Path::Stiffening | Path::FromTangents, _)) | None => 1.0,
        };
        if let Some((Path::Stiffening, p)) = path {
            self.forces.set_stiffening(p.exp());
        }
        self.forces.set_scale(scale);
        let interrupt = self.forces.interrupt();
        if let Some(ring) = &mut self.products.ring {
            ring.forget();
        }
        self.forces.evaluate(u, omega)?;
        // Where all contacts stick no force of theirs is left beside κ y.
        let acts = path.is_some() || (0..self.condensed.coordinates()).any(|c| !self.forces.is_inactive(c));
        self.tables.tabulate(self.condensed, (omega, acts), interrupt)?;
        if self.condensed.coordinates() == 1 && path.is_none() {
            self.balance_single(u, out);
            return Ok(());
        }
        self.balance(u, path, out)
    }

    /// Residual of a single relative motion with the contact forces at `u`.
    fn balance_single(&self, u: &[f64], out: &mut Residual) {
        let force = SingleForce {
            force: self.forces.forces(),
            by_omega: self.forces.all_by_omega(),
            is_inactive: self.forces.is_inactive(0),
            rounding: self.forces.rounding(0),
        };
        let of = (self.condensed.set(), self.tables.current());
        single_balance::balance(of, u, &force, |i| self.condensed.kappa(0, i), out);
    }

    /// Residual with the contact forces at `u`.
    pub(super) fn balance(&mut self, u: &[f64], path: Option<(Path, f64)>, out: &mut Residual) -> Result<()> {
        let lacks_slopes = path.is_none() && self.tables.lacks_slopes();
        if lacks_slopes {
            self.find_slopes_along(u)?;
        }
        let interrupt = self.forces.interrupt();
        let set = self.condensed.set();
        let m = set.packed_len();
        let coordinates = self.condensed.coordinates();
        let outputs = coordinates + 1;
        out.values.copy_from_slice(u);
        out.d_parameter.fill(0.0);
        let (mut linear, mut rounding) = (Squares::default(), 0.0_f64);
        // Estimates of errors have one frequency, and tables without slopes.
        let has_slopes = path.is_some() || !self.tables.has_modes();
        for (i, table) in self.tables.current().iter().enumerate() {
            if i.is_multiple_of(HARMONIC_BALANCE_BETWEEN_CHECKS) {
                interrupt.check()?;
            }
            let at = set.offset(i);
            let mean = set.numbers()[i] == 0;
            for row in 0..coordinates {
                let r = row * m + at;
                let y_lin = table.value[coordinates * outputs + row];
                let part = if mean { &mut linear.mean } else { &mut linear.vibration };
                *part += y_lin.norm_sqr();
                match path {
                    None => {
                        put(&mut out.values, r, mean, -y_lin);
                        if has_slopes {
                            let own = table.slope[coordinates * outputs + row];
                            let along = if lacks_slopes {
                                self.memory.along[i * outputs + row]
                            } else {
                                Complex64::ZERO
                            };
                            put(&mut out.d_parameter, r, mean, -(own + along));
                        }
                    }
                    Some((Path::GrowingLoad, p)) if !mean => {
                        put(&mut out.values, r, mean, -p * y_lin);
                        put(&mut out.d_parameter, r, mean, -y_lin);
                    }
                    Some(_) => put(&mut out.values, r, mean, -y_lin),
                }
            }
            if coordinates >= PRODUCTS_FROM {
                let memory = (&mut self.memory.sum[..], &mut self.products.harmonic);
                let of = (&*self.forces, &*self.tables, self.condensed);
                rounding += contact_terms::add_products(of, i, (u, path, has_slopes), memory, out);
                continue;
            }
            for column in 0..coordinates {
                if self.forces.is_inactive(column) {
                    continue;
                }
                let w = self.forces.minus_reference(u, column, i);
                let lost = self.forces.rounding(column);
                let by_parameter = match path {
                    None => self.forces.by_omega(column, i),
                    Some((Path::ScaledLaws, _)) => self.forces.d_ln_scale(column, i),
                    Some((Path::Stiffening, _)) => self.forces.d_ln_stiffening(column, i),
                    Some((Path::GrowingLoad | Path::FromTangents, _)) => Complex64::ZERO,
                };
                let rows = column * outputs..column * outputs + coordinates;
                let rows = table.value[rows.clone()].iter().zip(&table.slope[rows]);
                for (r, (g, slope)) in (at..).step_by(m).zip(rows) {
                    if lost > 0.0 {
                        rounding += lost * lost * g.norm_sqr();
                    }
                    put(&mut out.values, r, mean, g * w);
                    if !has_slopes {
                        continue;
                    }
                    let along = match path {
                        None => slope * w + g * by_parameter,
                        Some(_) => g * by_parameter,
                    };
                    put(&mut out.d_parameter, r, mean, along);
                }
            }
        }
        out.scale = Squares::of(set, u).size(linear);
        out.rounding = rounding.sqrt();
        Ok(())
    }

    /// Fills the slopes `along` for harmonics whose tables lack slopes, with the forces at `u`; the others become 0.
    fn find_slopes_along(&mut self, u: &[f64]) -> Result<()> {
        let (coordinates, harmonics) = (self.condensed.coordinates(), self.condensed.set().numbers().len());
        let outputs = coordinates + 1;
        if self.memory.along.is_empty() {
            self.memory.along = try_vec(outputs * harmonics, Complex64::ZERO, "the forced response")?;
        }
        self.memory.along.fill(Complex64::ZERO);
        let interrupt = self.forces.interrupt();
        for (i, along) in self.memory.along.chunks_exact_mut(outputs).enumerate() {
            for (c, w) in self.memory.sum.iter_mut().enumerate() {
                let is_active = !self.forces.is_inactive(c);
                *w = if is_active {
                    self.forces.minus_reference(u, c, i)
                } else {
                    Complex64::ZERO
                };
            }
            self.tables
                .slope_along(self.condensed, i, &self.memory.sum, along, interrupt)?;
        }
        Ok(())
    }

    /// The observed amplitude and its derivative along a direction, whose last number belongs to ω or to a path.
    fn observe_at(&self, u: &[f64], direction: &[f64], path: Option<Path>) -> (Complex64, Complex64) {
        let coordinates = self.condensed.coordinates();
        let outputs = coordinates + 1;
        let i = self.observed;
        let table = &self.tables.current()[i];
        let along_p = direction[u.len()];
        let rate = |z: Complex64| match path {
            None => z * along_p,
            Some(_) => Complex64::ZERO,
        };
        let excited = coordinates * outputs + coordinates;
        let mut z = table.value[excited];
        // Tables without slopes have that of the response along the motion, from the last residual.
        let along = self.tables.lacks_slopes_of_response(i);
        let mut dz = match path {
            None if along => rate(
                self.memory
                    .along
                    .get(i * outputs + coordinates)
                    .copied()
                    .unwrap_or_default(),
            ),
            _ => rate(table.slope[excited]),
        };
        for c in (0..coordinates).filter(|&c| !self.forces.is_inactive(c)) {
            let w = self.forces.minus_reference(u, c, i);
            let g = table.value[c * outputs + coordinates];
            let mut dw = self.forces.along(direction, c, i);
            dw += match path {
                None => self.forces.by_omega(c, i) * along_p,
                Some(Path::ScaledLaws) => self.forces.d_ln_scale(c, i) * along_p,
                Some(Path::Stiffening) => self.forces.d_ln_stiffening(c, i) * along_p,
                Some(Path::GrowingLoad | Path::FromTangents) => Complex64::ZERO,
            };
            z -= g * w;
            dz -= g * dw + rate(table.slope[c * outputs + coordinates]) * w;
        }
        (z, dz)
    }

    /// Index of the observed harmonic among the carried ones.
    #[must_use]
    pub fn observed(&self) -> usize {
        self.observed
    }

    /// The observed amplitude X at the point last evaluated, and in `gradient` the derivative of |X| by the unknowns.
    pub fn amplitude_gradient(&self, u: &[f64], gradient: &mut [f64]) -> Complex64 {
        let coordinates = self.condensed.coordinates();
        let outputs = coordinates + 1;
        let i = self.observed;
        let value = &self.tables.current()[i].value;
        let mut z = value[coordinates * outputs + coordinates];
        for c in 0..coordinates {
            z -= value[c * outputs + coordinates] * self.forces.minus_reference(u, c, i);
        }
        let turn = z.conj() / z.norm();
        gradient.fill(0.0);
        for c in 0..coordinates {
            let g = -turn * value[c * outputs + coordinates];
            self.forces.couple_scalar(i, (0, c), g, gradient, 1);
        }
        z
    }

    /// Contact force minus κ y in the i-th carried harmonic of each coordinate, at the point last evaluated.
    pub fn contact_force(&self, u: &[f64], i: usize, w: &mut [Complex64]) {
        for (c, w) in w.iter_mut().enumerate() {
            *w = self.forces.minus_reference(u, c, i);
        }
    }

    /// Number of unknowns: the packed relative motions.
    #[must_use]
    pub fn unknowns(&self) -> usize {
        self.condensed.unknowns()
    }

    /// The set of carried harmonics.
    #[must_use]
    pub fn set(&self) -> &'a HarmonicSet {
        self.condensed.set()
    }

    /// The contact forces at the point last evaluated.
    #[must_use]
    pub fn forces(&self) -> &ContactForces<'a> {
        &self.forces
    }
}

impl Jacobian for HarmonicBalance<'_> {
    fn size(&self) -> usize {
        self.unknowns()
    }

    /// ∂R/∂y = I + G (∂f/∂y − κ); a motion on which no force depends keeps the column of the identity.
    fn fill(&mut self, matrix: &mut [f64], active: &mut [bool]) -> Result<()> {
        let set = self.condensed.set();
        let (m, harmonics) = (set.packed_len(), set.numbers().len());
        let coordinates = self.condensed.coordinates();
        let n = active.len();
        self.forces.mark_active(active);
        let is_active = active.contains(&true);
        if is_active
            && single_matrix::fill_single(
                &self.forces,
                self.tables.current(),
                &mut self.memory.flexibility,
                matrix,
            )?
        {
            return Ok(());
        }
        if is_active {
            for (i, table) in self.tables.current().iter().enumerate() {
                let forces = table.value.chunks_exact(coordinates + 1).take(coordinates);
                for (force, column) in forces.enumerate() {
                    let first = force * coordinates * harmonics + i;
                    let to = self.memory.flexibility[first..].iter_mut().step_by(harmonics);
                    for (to, g) in to.zip(&column[..coordinates]) {
                        *to = *g;
                    }
                }
            }
        }
        matrix.fill(0.0);
        for diagonal in matrix.iter_mut().step_by(n + 1) {
            *diagonal = 1.0;
        }
        for (motion, columns) in matrix.chunks_exact_mut((m * n).max(1)).enumerate() {
            // All numbers of a motion are active or none.
            if active[motion * m] {
                self.forces
                    .couple_all(motion, &self.memory.flexibility, &mut self.memory.change, columns, n)?;
            }
        }
        Ok(())
    }

    fn near_diagonal(&mut self, diagonal: &mut [Complex64]) -> bool {
        if self.condensed.coordinates() != 1 || self.condensed.set().has_mean() {
            return false;
        }
        // Where the contact has no stiffness J = 1 − Gκ, and where it sticks all the time J = 1.
        let free = self.forces.free_shares();
        let is_free = free.0 >= 1.0 - SHORT_PIECES;
        if !is_free && (free.1 > SHORT_PIECES || !self.condensed.may_be_eliminated(0)) {
            return false;
        }
        for (i, (to, table)) in diagonal.iter_mut().zip(self.tables.current()).enumerate() {
            *to = Complex64::ONE;
            if is_free {
                *to -= table.value[0] * self.condensed.kappa(0, i);
            }
        }
        true
    }

    fn multiply_here(&mut self, d: &[f64], out: &mut [f64]) -> Result<bool> {
        // The matrices of sampled laws jump wherever an event passes a sample.
        if self.forces.is_sampled() {
            return Ok(false);
        }
        self.forces.interrupt().check()?;
        self.multiply_current(d, out);
        Ok(true)
    }

    fn matrix_free(&mut self) -> Option<&mut dyn MatrixFree> {
        Some(self)
    }
}

#[cfg(test)]
#[path = "harmonic_balance_tests.rs"]
mod tests;
