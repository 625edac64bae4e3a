//! Extended periodic motion concept (EPMC): a nonlinear mode as a [`Problem`], in which an artificial negative
//! damping balances the losses of the structure and its contacts (Krack 2015,
//! doi:10.1016/j.compstruc.2015.03.008).
//!
//! M ẍ + (C − 2DωM) ẋ + K x + f(x) = 0, or −ζK ẋ with D = ζω/2. With x = a·x̂ the unknowns are the packed relative
//! motions ŷ, the frequency ω and the damping ratio D; the parameter is log₁₀ a. The amplitude enters a law by
//! scaling alone, f̂(ŷ) = f(a ŷ)/a, the law scaled by s = 1/a; hence ∂f̂/∂log₁₀a = −ln 10·∂f̂/∂ln s.
//!
//! > R = ŷ_h − W x̂_h,  x̂_h = −Z_h(ω, D)⁻¹ Wᴴ (f̂_h − κ ŷ_h),
//! > L²·x̂₁ᴴ B x̂₁ − 1,  Im x̂₁[reference]/scale
//!
//! with B = M, or rᴴr where a contact measures the amplitude.

mod functional;
mod mode_products;

use crate::condense::Condensed;
use crate::condense::by_factors::dynamic_stiffness::DampedFrequency;
use crate::condense::by_modes::mode_flexibility::ModeFlexibility;
use crate::contact::forms::onset::Onset;
use crate::error::{Result, boxed, fail, try_push, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::newton::linear_system::{Jacobian, MatrixFree};
use crate::linalg::{inner, norm};
use crate::model::matrices::spring::{Row, along};
use crate::problem::contact_forces::ContactForces;
use crate::problem::homotopy::{AlongPath, Path, PathHomotopy};
use crate::problem::parametric_problem::{Homotopy, InitialGuess, Problem, Residual, put};
use crate::problem::residual_scale::{MEAN_SHARE, Squares};
use crate::problem::static_state::StaticState;
use num_complex::Complex64;
use std::f64::consts::LN_10;

/// Change of ln ω that has the same weight as a change of the motions by their size.
/// Kind: tuned; measured on: not recorded.
pub(crate) const OMEGA_UNIT: f64 = 0.05;

/// Change of D that has the same weight.
/// Kind: tuned; measured on: not recorded.
const DAMPING_UNIT: f64 = 2e-3;

/// Distance below the onset of slip, in log₁₀, at which contacts stick despite round-off.
/// Kind: rounding.
const ONSET_ROUNDING: f64 = 1e-9;

/// Share of the structure's largest motion that counts as size of the residual. A relative motion is known only to
/// the round-off of the motions from which it is computed, which may be thousands of times larger: a tolerance of
/// 1e-10 then requires no more than 1e-12 of them.
/// Kind: tuned; measured on: not recorded.
const OF_MOTION: f64 = 1e-2;

/// Frequency relative to the linear mode's below which a motion is no vibration. Where a structure softens until its
/// stiffness vanishes, the frequency falls towards zero at a constant amplitude; inertia, and with it D, is then lost
/// in the round-off of the stiffness.
/// Kind: tuned; measured on: not recorded.
const VANISHED: f64 = 1e-5;

/// Residual of the linear mode, relative to its size, at which it is a reliable initial guess.
/// Kind: tuned; measured on: not recorded.
const NEARLY: f64 = 1e-3;

/// Steps of log₁₀ of the amplitude towards smaller ones in which such an amplitude is sought.
/// Kind: tuned; measured on: not recorded.
const NEARLY_STEP: f64 = 0.5;
/// Most such steps.
/// Kind: cap.
const NEARLY_STEPS: u8 = 40;

/// Normalisation of a mode: its amplitude and phase.
#[derive(Clone, Debug)]
pub struct Gauge {
    /// The relative motion whose fundamental is the amplitude; `None`: the modal amplitude (x₁ᴴ M x₁)^½.
    pub contact: Option<Row>,
    /// Degree of freedom whose fundamental is real.
    pub reference_dof: usize,
}

/// The linear mode from which a nonlinear one starts, at amplitude 1.
#[derive(Clone, Debug)]
pub struct LinearMode {
    /// Angular frequency of the linear mode.
    pub omega: f64,
    /// Damping ratio of the linear mode.
    pub damping: f64,
    /// Fundamental of all degrees of freedom, in the caller's units.
    pub shape: Vec<Complex64>,
    /// The static state about which the mode vibrates.
    pub rest: StaticState,
}

/// A nonlinear mode of a condensed model as equations over its amplitude.
pub struct Epmc<'a> {
    condensed: &'a Condensed,
    forces: Box<ContactForces<'a>>,
    structure: Box<ModeFlexibility>,
    gauge: &'a Gauge,
    linear: &'a LinearMode,
    memory: ModeMemory,
    derivatives: ModeDerivatives,
    products: Box<mode_products::ModeProducts>,
    /// Unknowns that the caller gave for the first point; `None` without a guess.
    guess: Option<Vec<f64>>,
    /// Whether several linear modes share the frequency of this one.
    is_repeated: bool,
}

/// Memory of an evaluation.
pub struct ModeMemory {
    /// Shape x̂ in all carried harmonics at the point last evaluated; and per harmonic, whether it is stored in the
    /// modes of the wave.
    x: Vec<Complex64>,
    of_modes: Vec<bool>,
    /// Memory for one harmonic of the shape, and of a product with it.
    harmonic: [Vec<Complex64>; 2],
    weighted: Vec<Complex64>,
    w: Vec<Complex64>,
    /// Memory: a packed signal for a column of the Jacobian.
    change: Vec<f64>,
}

/// Flexibility and derivatives of the equations at the point evaluated last.
pub struct ModeDerivatives {
    /// Flexibility G of each harmonic, column after column.
    tables: Vec<Vec<Complex64>>,
    /// Flexibility G in the layout of [`ContactForces::couple_all`].
    flexibility: Vec<Complex64>,
    /// Columns of the Jacobian that belong to the unknowns of ω and D, and the parts of its last two rows that belong
    /// to contact forces: amplitude and phase per force.
    by_omega: Vec<f64>,
    by_damping: Vec<f64>,
    gauge_rows: Vec<[Complex64; 2]>,
}

impl<'a> Epmc<'a> {
    /// A problem on `condensed`, made by [`Condensed::for_mode`].
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(
        condensed: &'a Condensed,
        gauge: &'a Gauge,
        linear: &'a LinearMode,
        samples: usize,
        interrupt: &'a Interrupt<'a>,
    ) -> Result<Self> {
        const CONTEXT: &str = "the nonlinear mode";
        let n = condensed.ndof();
        let unknowns = condensed.coordinates().saturating_mul(condensed.set().packed_len()) + 2;
        let mut forces = Box::new(ContactForces::new(condensed, samples, interrupt)?);
        if linear.rest.is_loaded() {
            let rest = linear.rest.in_units(condensed.length())?;
            forces.set_rest(&rest, linear.omega)?;
        }
        let mut tables = Vec::new();
        for _ in condensed.blocks() {
            let table = try_vec(condensed.coordinates().saturating_pow(2), Complex64::ZERO, CONTEXT)?;
            try_push(&mut tables, table, CONTEXT)?;
        }
        Ok(Self {
            condensed,
            forces,
            structure: boxed(|| ModeFlexibility::new(condensed, gauge.reference_dof))?,
            gauge,
            linear,
            memory: ModeMemory {
                x: try_vec(n.saturating_mul(condensed.blocks().len()), Complex64::ZERO, CONTEXT)?,
                of_modes: try_vec(condensed.blocks().len(), false, CONTEXT)?,
                harmonic: [
                    try_vec(n, Complex64::ZERO, CONTEXT)?,
                    try_vec(n, Complex64::ZERO, CONTEXT)?,
                ],
                weighted: try_vec(n, Complex64::ZERO, CONTEXT)?,
                w: try_vec(condensed.coordinates(), Complex64::ZERO, CONTEXT)?,
                change: try_vec(condensed.set().packed_len(), 0.0, CONTEXT)?,
            },
            derivatives: ModeDerivatives {
                tables,
                flexibility: try_vec(
                    condensed
                        .coordinates()
                        .saturating_pow(2)
                        .saturating_mul(condensed.blocks().len()),
                    Complex64::ZERO,
                    CONTEXT,
                )?,
                by_omega: try_vec(unknowns, 0.0, CONTEXT)?,
                by_damping: try_vec(unknowns, 0.0, CONTEXT)?,
                gauge_rows: try_vec(condensed.coordinates(), [Complex64::ZERO; 2], CONTEXT)?,
            },
            products: boxed(|| Ok(mode_products::ModeProducts::default()))?,
            guess: None,
            is_repeated: false,
        })
    }

    /// States that several linear modes share the frequency. Nonlinear modes may then lie in a continuum: bodies that
    /// nothing couples vibrate in any phase to each other.
    pub fn set_repeated(&mut self, is_repeated: bool) {
        self.is_repeated = is_repeated;
    }

    /// Gives the unknowns near which the first point is sought.
    pub fn set_guess(&mut self, guess: Vec<f64>) {
        self.guess = Some(guess);
    }

    /// Frequency and damping ratio from the unknowns.
    #[must_use]
    pub fn frequency_and_damping(linear: &LinearMode, u: &[f64]) -> DampedFrequency {
        let n = u.len();
        DampedFrequency {
            omega: linear.omega * (OMEGA_UNIT * u[n - 2]).exp(),
            damping: linear.damping + DAMPING_UNIT * u[n - 1],
        }
    }

    /// Sets the unknowns that represent frequency and damping ratio.
    pub fn set_frequency_and_damping(
        linear: &LinearMode,
        DampedFrequency { omega, damping }: DampedFrequency,
        u: &mut [f64],
    ) {
        let n = u.len();
        u[n - 2] = (omega / linear.omega).ln() / OMEGA_UNIT;
        u[n - 1] = (damping - linear.damping) / DAMPING_UNIT;
    }

    /// Change of the damping ratio that belongs to a change of the unknowns.
    #[must_use]
    pub fn damping_of_change(change: &[f64]) -> f64 {
        DAMPING_UNIT * change.last().copied().unwrap_or(0.0)
    }

    /// Relative change of the frequency that belongs to a small change of the unknowns.
    #[must_use]
    pub fn frequency_of_change(change: &[f64]) -> f64 {
        OMEGA_UNIT * change[change.len() - 2]
    }

    /// Shape x̂ of all degrees of freedom per unit of amplitude, harmonic after harmonic, at the point last
    /// evaluated, in the solver's units.
    pub fn shape(&mut self) -> &[Complex64] {
        let n = self.condensed.ndof();
        let [of_modes, memory] = &mut self.memory.harmonic;
        for (i, is_of_modes) in self.memory.of_modes.iter_mut().enumerate() {
            if core::mem::replace(is_of_modes, false) {
                let x = &mut self.memory.x[i * n..(i + 1) * n];
                of_modes.copy_from_slice(x);
                self.structure.expand(i, of_modes, x, memory);
            }
        }
        &self.memory.x
    }

    /// Fundamental of the shape x̂, all degrees of freedom, at the point last evaluated.
    #[must_use]
    pub fn fundamental(&self) -> &[Complex64] {
        let (i, n) = (self.condensed.set().fundamental(), self.condensed.ndof());
        &self.memory.x[i * n..(i + 1) * n]
    }

    /// Relative change of the forces with the number of samples; see [`ContactForces::sampling_error`].
    ///
    /// # Errors
    /// Those of callbacks that give up.
    pub fn sampling_error(&mut self, motion: &[f64], omega: f64) -> Result<f64> {
        self.forces.sampling_error(motion, omega)
    }

    /// The contact forces at the point last evaluated.
    #[must_use]
    pub fn forces(&self) -> &ContactForces<'a> {
        &self.forces
    }

    /// Fills in the unknowns of the linear mode.
    pub fn linear_start(&self, u: &mut [f64]) {
        let set = self.condensed.set();
        let m = set.packed_len();
        u.fill(0.0);
        let fundamental = self.condensed.set().fundamental();
        let rows = &self.condensed.blocks()[fundamental].motions.rows;
        let phase = self.linear.shape[self.gauge.reference_dof];
        let turn = phase.conj() / (phase.norm() * self.condensed.length());
        for (c, row) in rows.iter().enumerate() {
            let y = row.along(&self.linear.shape) * turn;
            set.set(&mut u[c * m..(c + 1) * m], fundamental, y);
        }
    }

    /// Amplitudes of the linear mode about the static state at which a contact slips, opens, or ceases to be linear.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn onset(&self) -> Result<Onset> {
        let mut u = try_vec(self.size(), 0.0, "the nonlinear mode")?;
        self.linear_start(&mut u);
        let set = self.condensed.set();
        let (m, fundamental) = (set.packed_len(), set.fundamental());
        let mut motion = Vec::new();
        for y in u[..u.len() - 2].chunks_exact(m) {
            try_push(&mut motion, set.get(y, fundamental), "the nonlinear mode")?;
        }
        self.forces.onset(&motion)
    }

    /// Finds the range of [`Self::linear_up_to`] about a loaded static state, where no law states its nearly linear
    /// range.
    fn linear_about_static(&mut self, first: f64) -> Result<(f64, f64)> {
        let exactly = self.onset()?.linear.log10();
        if exactly.is_finite() {
            // Contacts stick there despite round-off.
            return Ok((exactly - ONSET_ROUNDING, exactly - ONSET_ROUNDING));
        }
        let mut u = try_vec(self.size(), 0.0, "the nonlinear mode")?;
        self.linear_start(&mut u);
        let mut at = Residual::new(u.len())?;
        for step in 0..NEARLY_STEPS {
            let p = first - NEARLY_STEP * f64::from(step);
            self.evaluate(&u, p, &mut at)?;
            // Below, round-off of the static forces hides the vibration.
            if at.rounding > NEARLY * at.scale {
                break;
            }
            if norm(&at.values) <= NEARLY * at.scale {
                return Ok((f64::NEG_INFINITY, p));
            }
        }
        Ok((f64::NEG_INFINITY, f64::NEG_INFINITY))
    }

    /// log₁₀ of the amplitudes up to which all laws are linear, −∞ if one of them never is, and up to which they
    /// nearly are, so that the linear mode is a reliable initial guess. If a law does not state its linear range, the
    /// second follows from `first`, the log₁₀ of the first requested amplitude.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn linear_up_to(&mut self, first: f64) -> Result<(f64, f64)> {
        if self.linear.rest.is_loaded() {
            return self.linear_about_static(first);
        }
        let mut u = try_vec(self.size(), 0.0, "the nonlinear mode")?;
        self.linear_start(&mut u);
        let motion = &u[..u.len() - 2];
        let nearly = -self.forces.linearisation_scale(motion, self.linear.omega)?.log10();
        if !self.forces.have_known_linear_range() {
            return Ok((f64::NEG_INFINITY, first.min(0.0) + nearly));
        }
        self.forces.set_scale(10f64.powf(ONSET_ROUNDING - nearly));
        self.forces.evaluate(motion, self.linear.omega)?;
        let exactly = if self.forces.all_stuck() {
            nearly
        } else {
            f64::NEG_INFINITY
        };
        Ok((exactly, nearly))
    }

    /// Computes B x̂ of the fundamental, times L², for the normalisation.
    fn weigh(&mut self) {
        let i = self.condensed.set().fundamental();
        let x = self.structure.x();
        let length = self.condensed.length();
        self.memory.weighted.fill(Complex64::ZERO);
        if let Some(row) = &self.gauge.contact {
            let y = along(row, x);
            for &(p, a) in row.iter().flatten() {
                self.memory.weighted[p] += a.conj() * y;
            }
        } else {
            self.condensed.blocks()[i].multiply_mass(x, &mut self.memory.weighted);
        }
        for z in &mut self.memory.weighted {
            *z *= length * length;
        }
    }

    /// Evaluates amplitude and phase, the last two rows of the system, with their derivatives by all unknowns but the
    /// motions.
    fn fix_gauge(&mut self, rates: (f64, f64), by_parameter: f64, out: &mut Residual) {
        self.weigh();
        let n = out.values.len();
        let (amplitude, phase) = (n - 2, n - 1);
        let i = self.condensed.set().fundamental();
        let dof = self.gauge.reference_dof;
        let scale = self.phase_scale();
        let x = self.structure.x();
        out.values[amplitude] = inner(&self.memory.weighted, x).re - 1.0;
        out.values[phase] = scale * x[dof].im;
        self.structure.fix_gauge(&self.memory.weighted);
        for c in 0..self.condensed.coordinates() {
            let [product, moved] = self.structure.gauge_of_column(c);
            // x̂ changes by −column·dw; Im z = Re(−i z).
            let size = -2.0 * product;
            let turn = Complex64::I * scale * moved;
            self.derivatives.gauge_rows[c] = [size, turn];
            let d_scale = self.forces.d_ln_scale(c, i) * by_parameter;
            for (row, g) in [(amplitude, size), (phase, turn)] {
                out.d_parameter[row] += (g * d_scale).re;
                self.derivatives.by_omega[row] += rates.0 * (g * self.forces.by_omega(c, i)).re;
            }
        }
        let [of_omega, of_damping] = self.structure.gauge_of_rates();
        for (column, rate, [product, moved]) in [
            (&mut self.derivatives.by_omega, rates.0, of_omega),
            (&mut self.derivatives.by_damping, rates.1, of_damping),
        ] {
            column[amplitude] += 2.0 * rate * product.re;
            column[phase] += rate * scale * moved.im;
        }
    }

    /// Residual for laws scaled by s, and its derivative by a parameter p with ∂ln s/∂p = `by_parameter`.
    fn evaluate_scaled(&mut self, u: &[f64], s: f64, by_parameter: f64, out: &mut Residual) -> Result<()> {
        self.forces.set_scale(s);
        let n = u.len();
        let motion = &u[..n - 2];
        let damped = Self::frequency_and_damping(self.linear, u);
        let omega = damped.omega;
        if !(omega >= VANISHED * self.linear.omega && omega.is_finite()) {
            return fail!(Singular, "the angular frequency became {omega}: no vibration is left");
        }
        let rates = (OMEGA_UNIT * omega, DAMPING_UNIT);
        self.forces.evaluate(motion, omega)?;
        let set = self.condensed.set();
        let m = set.packed_len();
        let coordinates = self.condensed.coordinates();
        out.values[..n - 2].copy_from_slice(motion);
        out.d_parameter.fill(0.0);
        self.derivatives.by_omega.fill(0.0);
        self.derivatives.by_damping.fill(0.0);
        let dofs = self.condensed.ndof();
        let (mut largest, mut rounding) = (0.0_f64, 0.0_f64);
        for (i, block) in self.condensed.blocks().iter().enumerate() {
            let mean = block.number == 0;
            let at = set.offset(i);
            for (c, w) in self.memory.w.iter_mut().enumerate() {
                *w = self.forces.minus_reference(motion, c, i);
            }
            let interrupt = self.forces.interrupt();
            interrupt.check()?;
            self.structure
                .solve(self.condensed, i, damped, &self.memory.w, interrupt)?;
            self.memory.x[i * dofs..(i + 1) * dofs].copy_from_slice(self.structure.x());
            self.derivatives.tables[i].copy_from_slice(self.structure.value());
            let share = if mean { MEAN_SHARE } else { 1.0 };
            self.memory.of_modes[i] = self.structure.is_of_modes();
            largest = largest.max(share * self.structure.largest());
            for row in 0..coordinates {
                let position = row * m + at;
                let [x, by_omega, by_damping] = self.structure.relative(row);
                put(&mut out.values, position, mean, -x);
                put(&mut self.derivatives.by_omega, position, mean, -rates.0 * by_omega);
                put(&mut self.derivatives.by_damping, position, mean, -rates.1 * by_damping);
            }
            for c in 0..coordinates {
                let lost = self.forces.rounding(c);
                let d_scale = self.forces.d_ln_scale(c, i) * by_parameter;
                let by_omega = rates.0 * self.forces.by_omega(c, i);
                for (row, &g) in self.derivatives.tables[i][c * coordinates..(c + 1) * coordinates]
                    .iter()
                    .enumerate()
                {
                    let position = row * m + at;
                    rounding += lost * lost * g.norm_sqr();
                    put(&mut out.d_parameter, position, mean, g * d_scale);
                    put(&mut self.derivatives.by_omega, position, mean, g * by_omega);
                }
            }
            if block.number == 1 {
                self.fix_gauge(rates, by_parameter, out);
            }
        }
        // Each coordinate adds its round-off.
        out.scale =
            1.0 + Squares::of(set, motion).size(Squares::default()) + OF_MOTION * largest * (coordinates as f64).sqrt();
        out.rounding = rounding.sqrt();
        Ok(())
    }
}

impl Jacobian for Epmc<'_> {
    fn has_continuum(&self) -> bool {
        self.is_repeated
    }

    fn size(&self) -> usize {
        self.condensed.coordinates() * self.condensed.set().packed_len() + 2
    }

    fn fill(&mut self, matrix: &mut [f64], active: &mut [bool]) -> Result<()> {
        let n = active.len();
        let set = self.condensed.set();
        let m = set.packed_len();
        let harmonics = set.numbers().len();
        for (i, table) in self.derivatives.tables.iter().enumerate() {
            for (to, g) in self.derivatives.flexibility[i..]
                .iter_mut()
                .step_by(harmonics)
                .zip(table)
            {
                *to = *g;
            }
        }
        active.fill(true);
        matrix.fill(0.0);
        for diagonal in matrix[..n * (n - 2)].iter_mut().step_by(n + 1) {
            *diagonal = 1.0;
        }
        for (motion, columns) in matrix[..n * (n - 2)].chunks_exact_mut((m * n).max(1)).enumerate() {
            self.forces.couple_all(
                motion,
                &self.derivatives.flexibility,
                &mut self.memory.change,
                columns,
                n,
            )?;
        }
        let fundamental = set.fundamental();
        for (c, rows) in self.derivatives.gauge_rows.iter().enumerate() {
            for (row, &g) in [n - 2, n - 1].into_iter().zip(rows) {
                self.forces.couple_scalar(fundamental, (row, c), g, matrix, n);
            }
        }
        matrix[(n - 2) * n..(n - 1) * n].copy_from_slice(&self.derivatives.by_omega);
        matrix[(n - 1) * n..].copy_from_slice(&self.derivatives.by_damping);
        Ok(())
    }

    fn matrix_free(&mut self) -> Option<&mut dyn MatrixFree> {
        Some(self)
    }
}

impl AlongPath for Epmc<'_> {
    /// Evaluates with the fixed parameter log₁₀ a; along the path of scaled laws s = e^p/a.
    fn evaluate_along(&mut self, path: Path, log10: f64, u: &[f64], p: f64, out: &mut Residual) -> Result<()> {
        let unit = 10f64.powf(-log10);
        if path == Path::FromTangents {
            self.forces.set_share(Some(p));
            let evaluated = self.evaluate_scaled(u, unit, 1.0, out);
            self.forces.set_share(None);
            return evaluated;
        }
        self.evaluate_scaled(u, unit * p.exp(), 1.0, out)
    }

    fn observe_along(&self, _path: Path, u: &[f64], direction: &[f64]) -> (Complex64, Complex64) {
        self.observe(u, direction)
    }
}

impl Problem for Epmc<'_> {
    fn has_kinks(&self) -> bool {
        self.forces.is_sampled()
    }

    fn evaluate(&mut self, u: &[f64], p: f64, out: &mut Residual) -> Result<()> {
        self.evaluate_scaled(u, 10f64.powf(-p), -LN_10, out)
    }

    /// Observes 1 + (D − D₀)/`DAMPING_UNIT`, D₀ being the damping ratio of the linear mode.
    fn observe(&self, u: &[f64], direction: &[f64]) -> (Complex64, Complex64) {
        let n = u.len();
        ((1.0 + u[n - 1]).into(), direction[n - 1].into())
    }

    fn initial_guess(&mut self, kind: InitialGuess, _p: f64, u: &mut [f64]) -> Result<bool> {
        match (kind, &self.guess) {
            (InitialGuess::Given, Some(guess)) => u.copy_from_slice(guess),
            (InitialGuess::Stuck, _) => self.linear_start(u),
            (InitialGuess::Given | InitialGuess::Reference, _) => return Ok(false),
        }
        Ok(true)
    }

    fn homotopy(&mut self, p: f64, u: &[f64]) -> Result<Option<Homotopy<'_>>> {
        if self.linear.rest.is_loaded() {
            let start = LN_10 * (p - self.linear_about_static(p)?.1);
            // A contact that only touches at rest is linear at no amplitude.
            let (ends, path) = if start > 0.0 && start.is_finite() {
                ((start, 0.0), Path::ScaledLaws)
            } else {
                ((0.0, 1.0), Path::FromTangents)
            };
            return Ok(Some(PathHomotopy::between(ends, self, path, p)));
        }
        let mut factor = self.forces.linearisation_scale(&u[..u.len() - 2], self.linear.omega)?;
        if self.forces.have_known_linear_range() {
            factor *= 10f64.powf(p);
        }
        let start = (1.01 * factor).ln();
        if !(start > 0.0 && start.is_finite()) {
            return Ok(None);
        }
        Ok(Some(PathHomotopy::between((start, 0.0), self, Path::ScaledLaws, p)))
    }
}
