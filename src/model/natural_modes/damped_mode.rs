//! The linear mode, with stuck contacts, of a damped structure that artificial damping keeps periodic.
//!
//! Real ω and D and a complex shape x solve (K + iωC − ω²(1 + 2iD) M) x = 0, or (K − 2iD Kₛ + iωC − ω² M) x = 0
//! with Kₛ the structure's own stiffness; structural damping is a part of K. One complex equation determines the two real unknowns. The method is
//! inverse iteration on a problem that is nonlinear in its eigenvalue (Neumaier 1985, doi:10.1137/0722055).

use crate::error::{Result, fail, try_copy, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::exact_sums::quadratic::quadratic;
use crate::linalg::factors::factor::Factor;
use crate::linalg::sparse_storage::sparse::{Csc, Form};
use crate::model::Model;
use crate::model::matrices::cyclic::Tied;
use crate::model::matrices::structure::MatrixKind;
use crate::model::matrices::wave::Wave;
use crate::model::natural_modes::linear_modes::ContactState;
use crate::model::natural_modes::mode_selection::SelectedMode;
use crate::options::DampingForm;
use num_complex::Complex64;
use std::borrow::Cow;

/// A mode of the damped structure.
#[derive(Clone, Debug)]
pub struct DampedMode {
    /// Angular frequency ω, rad per time unit.
    pub omega: f64,
    /// Damping ratio D of the artificial damping: positive where the damping of the structure dissipates energy.
    pub damping: f64,
    /// Shape with xᴴ M x = 1 over one sector, in phase with the undamped one.
    pub shape: Vec<Complex64>,
}

/// Relative distance of a shift from the frequency, or from another eigenvalue. Each step of an inverse iteration gains the digits of
/// this distance; with a shift at the eigenvalue itself the factors would be singular.
/// Kind: tuned; measured on: not recorded.
pub(crate) const SHIFT_OFFSET: f64 = 1e-8;

/// The same for repeated frequencies. A closer shift would mix modes that differ by rounding only, and lose the
/// mixture of the initial mode.
/// Kind: tuned; measured on: not recorded.
const OFFSET_REPEATED: f64 = 1e-5;

/// Largest number of steps.
/// Kind: cap.
const DAMPED_MODE_MAX_STEPS: usize = 30;

/// Largest residual by rounding, relative to its terms.
/// Kind: rounding.
const DAMPED_MODE_ROUNDING: f64 = 1e-12;

/// The same, relative to the inertia, for a mixture of modes whose frequencies are nearly equal.
/// Kind: rounding.
const NEARLY_EQUAL: f64 = 3e-8;

/// Largest strain energy of the structure itself, relative to that of the mode, that counts as rounding.
/// Kind: rounding.
const DAMPED_MODE_NO_STRAIN: f64 = 1e-12;

const CONTEXT: &str = "the damped mode";

fn no_artificial_damping<T>() -> Result<T> {
    fail!(
        Singular,
        "artificial damping of the stiffness type does not act on the mode: its stiffness is in springs and contacts; use the mass type"
    )
}

/// Continues a mode as [`Model::damped_mode`], with contacts stuck or linearised about a static state, and the caller
/// may stop it.
#[doc(hidden)]
pub(crate) fn damped_mode_with(
    model: &Model,
    start: &SelectedMode,
    contacts: ContactState<'_>,
    form: DampingForm,
    interrupt: &Interrupt<'_>,
) -> Result<DampedMode> {
    interrupt.check()?;
    if let Cow::Owned(separate) = model.with_separate_loss()? {
        return separate.damped_mode_with(start, contacts, form, interrupt);
    }
    let n = model.structure().ndof();
    if start.shape.len() != n {
        return fail!(
            Dimension,
            "the start mode has {} entries, needs ndof = {n}",
            start.shape.len()
        );
    }
    let structure = model.structure();
    let stuck = model.stiffness_at_small_motion(Wave::Harmonic(1), contacts)?;
    let structural = structure.wave_matrix(MatrixKind::Structural, 1)?;
    let problem = Damped {
        form,
        stiffness: Csc::sum(
            n,
            &[
                (Complex64::ONE, &stuck, Form::Plain),
                (Complex64::I, &structural, Form::Plain),
            ],
        )?,
        own: structure.wave_matrix(MatrixKind::Stiffness, 1)?,
        damping: structure.wave_matrix(MatrixKind::Damping, 1)?,
        mass: structure.wave_matrix(MatrixKind::Mass, 1)?,
        tied: structure.tied_to_frequency(Wave::Harmonic(1))?,
    };
    let undamped = DampedMode {
        omega: start.omega,
        damping: 0.0,
        shape: try_copy(&start.shape, CONTEXT)?,
    };
    // The undamped mode is one without aerodynamic forces.
    let conservative = !structure.has_aero_stiffness()
        && problem.stiffness.worst_hermitian_pair().2 <= 1e-10 * problem.stiffness.max_abs();
    if conservative && problem.damping.max_abs() == 0.0 {
        // Linear damping does not need the artificial damping here, but friction will.
        let strain = quadratic(&problem.own, &undamped.shape);
        if form == DampingForm::Stiffness && strain.abs() <= DAMPED_MODE_NO_STRAIN * undamped.omega * undamped.omega {
            return no_artificial_damping();
        }
        return Ok(undamped);
    }
    if start.multiplicity > 1 {
        let mode = problem.follow(&undamped, OFFSET_REPEATED, interrupt)?;
        if problem.residual(&mode, true)? {
            return Ok(mode);
        }
    }
    let mode = problem.follow(&undamped, SHIFT_OFFSET, interrupt)?;
    if problem.residual(&mode, false)? {
        return Ok(mode);
    }
    fail!(
        NoConvergence,
        "the damped linear mode was not reached from mode {} at omega = {}; is the structure damped beyond vibration?",
        start.index,
        start.omega
    )
}

/// Matrices of the structure in the fundamental.
struct Damped {
    form: DampingForm,
    stiffness: Csc,
    own: Csc,
    damping: Csc,
    mass: Csc,
    /// Matrices p²K₁ and pG of a speed that is tied to the frequency; `None` otherwise.
    tied: Option<Tied>,
}

impl Damped {
    /// Factors by which K, Kₛ, C and M enter A(ω, D).
    fn factors(&self, omega: f64, d: f64) -> [Complex64; 4] {
        let i = Complex64::I;
        let (own, inertia) = match self.form {
            DampingForm::Mass => (Complex64::ZERO, 1.0 + 2.0 * i * d),
            DampingForm::Stiffness => (-2.0 * i * d, Complex64::ONE),
        };
        [Complex64::ONE, own, i * omega, -omega * omega * inertia]
    }

    fn terms(&self) -> [&Csc; 4] {
        [&self.stiffness, &self.own, &self.damping, &self.mass]
    }

    fn matrix(&self, omega: f64, d: f64) -> Result<Csc> {
        let mut terms = Vec::with_capacity(6);
        terms.extend(self.sum(omega, d).map(|(factor, a)| (factor, a, Form::Plain)));
        Csc::sum(self.mass.rows, &terms)
    }

    /// Terms of A(ω, D) as a sum: factors and matrices.
    fn sum(&self, omega: f64, d: f64) -> impl Iterator<Item = (Complex64, &Csc)> {
        let square = omega * omega;
        let tied = self.tied.iter().flat_map(move |tied| {
            [
                (square.into(), &tied.stiffness),
                (Complex64::new(0.0, square), &tied.gyroscopic),
            ]
        });
        self.factors(omega, d).into_iter().zip(self.terms()).chain(tied)
    }

    /// Products A x, ∂A/∂ω x and ∂A/∂D x, one after the other.
    fn columns(&self, mode: &DampedMode) -> Result<Vec<Complex64>> {
        let (n, x, i) = (self.mass.rows, &mode.shape, Complex64::I);
        let (omega, d) = (mode.omega, mode.damping);
        let mut columns = try_vec(3 * n, Complex64::ZERO, CONTEXT)?;
        let (residual, derivatives) = columns.split_at_mut(n);
        for (factor, a) in self.sum(omega, d) {
            a.multiply_add(factor, x, residual);
        }
        let (by_omega, by_damping) = derivatives.split_at_mut(n);
        self.damping.multiply_add(i, x, by_omega);
        if let Some(tied) = &self.tied {
            tied.stiffness.multiply_add((2.0 * omega).into(), x, by_omega);
            tied.gyroscopic.multiply_add(2.0 * omega * i, x, by_omega);
        }
        match self.form {
            DampingForm::Mass => {
                self.mass.multiply_add(-2.0 * omega * (1.0 + 2.0 * i * d), x, by_omega);
                self.mass.multiply_add(-2.0 * i * omega * omega, x, by_damping);
            }
            DampingForm::Stiffness => {
                self.mass.multiply_add((-2.0 * omega).into(), x, by_omega);
                self.own.multiply_add(-2.0 * i, x, by_damping);
            }
        }
        Ok(columns)
    }

    /// Newton's method on A(ω, D) x = 0, vᴴ x = 1 with v = M φ, with the factors at a shift nearby: x changes by
    /// A⁻¹(A x + dω ∂A/∂ω x + dD ∂A/∂D x), and v is orthogonal to this change.
    fn follow(&self, start: &DampedMode, offset: f64, interrupt: &Interrupt<'_>) -> Result<DampedMode> {
        let n = self.mass.rows;
        let mut mode = DampedMode {
            shape: try_copy(&start.shape, CONTEXT)?,
            ..*start
        };
        let v = self.mass.times(&start.shape, CONTEXT)?;
        let project = |z: &[Complex64]| -> Complex64 { v.iter().zip(z).map(|(v, z)| v.conj() * z).sum() };
        let mut factor = Factor::new(&self.matrix(mode.omega, 0.0)?, 3)?;
        let mut last = f64::INFINITY;
        for _ in 0..DAMPED_MODE_MAX_STEPS {
            interrupt.check()?;
            factor.factor(&self.matrix(mode.omega * (1.0 + offset), mode.damping)?, interrupt)?;
            let mut z = self.columns(&mode)?;
            factor.solve(&mut z, false, interrupt)?;
            let (y, z) = z.split_at(n);
            let (by_omega, by_damping) = z.split_at(n);
            let (r, a, b) = (project(y), project(by_omega), project(by_damping));
            let determinant = a.re * b.im - a.im * b.re;
            if determinant.abs() <= 1e-12 * a.norm() * b.norm() {
                return no_artificial_damping();
            }
            let d_omega = (r.im * b.re - r.re * b.im) / determinant;
            let d_damping = (r.re * a.im - r.im * a.re) / determinant;
            let (mut change, mut size) = (0.0_f64, 0.0_f64);
            for (((x, y), p), q) in mode.shape.iter_mut().zip(y).zip(by_omega).zip(by_damping) {
                let dx = y + d_omega * p + d_damping * q;
                *x -= dx;
                change = change.max(dx.norm());
                size = size.max(x.norm());
            }
            mode.omega += d_omega;
            mode.damping += d_damping;
            if !(mode.omega > 0.0 && mode.omega.is_finite() && size.is_finite()) {
                return fail!(
                    NoConvergence,
                    "the damped linear mode was not reached: omega became {}",
                    mode.omega
                );
            }
            let change = change / size + d_omega.abs() / mode.omega + d_damping.abs();
            // The iteration ends at the level of rounding, or where the steps stop decreasing above it.
            if change <= 2e-15 || (change < 1e-9 && change > 0.5 * last) {
                break;
            }
            last = change;
        }
        let norm = quadratic(&self.mass, &mode.shape).sqrt();
        for x in &mut mode.shape {
            *x /= norm;
        }
        Ok(mode)
    }

    /// Whether A x = 0 up to rounding, or up to the difference of frequencies that count as equal.
    fn residual(&self, mode: &DampedMode, repeated: bool) -> Result<bool> {
        let n = self.mass.rows;
        let mut sum = try_vec(n, Complex64::ZERO, CONTEXT)?;
        let mut sizes = try_vec(n, 0.0_f64, CONTEXT)?;
        let mut inertia = try_vec(n, Complex64::ZERO, CONTEXT)?;
        for (factor, a) in self.sum(mode.omega, mode.damping) {
            a.multiply_add(factor, &mode.shape, &mut sum);
            for (j, x) in mode.shape.iter().enumerate() {
                for (i, v) in a.column(j) {
                    sizes[i] += (factor * v * x).norm();
                }
            }
        }
        self.mass
            .multiply_add((mode.omega * mode.omega).into(), &mode.shape, &mut inertia);
        let largest = |z: &[Complex64]| z.iter().fold(0.0_f64, |m, z| m.max(z.norm()));
        let mut allowed = DAMPED_MODE_ROUNDING * sizes.iter().fold(0.0_f64, |m, &s| m.max(s));
        if repeated {
            allowed = allowed.max(NEARLY_EQUAL * largest(&inertia));
        }
        Ok(largest(&sum) <= allowed)
    }
}
