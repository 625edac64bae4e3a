//! Damped natural modes of the linear structure: eigenvalues λ of λ²M + λ(C + ΩG) + K + Ω²K₁ + iD in the upper half
//! plane, with the sense in which their frequencies change with the speed.

use crate::analysis::linear_contacts::LinearContacts;
use crate::error::{Result, fail, try_extend, try_push, try_vec};
use crate::hooks::{Hooks, LogLevel};
use crate::interrupt::{Interrupt, Phase};
use crate::linalg::factor::Factor;
use crate::linalg::sparse::{Csc, Form};
use crate::model::Model;
use crate::model::quadratic_modes::Quadratic;
use crate::model::speed::Speed;
use crate::model::spring_stiffness::Wave;
use crate::model::structure::MatrixKind;
use num_complex::Complex64;

/// Relative distance of two eigenvalues that count as one.
const EQUAL: f64 = 1e-7;

/// Change of the frequency with the speed, over the size of its terms, that is rounding.
const NO_CHANGE: f64 = 1e-9;

/// Relative distance of the shift from an eigenvalue.
const OFFSET: f64 = 1e-8;

/// Damping ratio below which a mode grows; above it is rounding.
pub(super) const GROWS: f64 = -1e-12;

const CONTEXT: &str = "the damped modes";

/// Damped modes in the order of rising frequency.
#[derive(Clone, Debug, Default)]
pub struct DampedModes {
    /// λ with Im λ > 0; motions that do not oscillate are not counted unless they grow: these have Im λ = 0 and Re λ > 0, and
    /// come first.
    pub eigenvalue: Vec<Complex64>,
    /// Shapes with φᴴ M φ = 1 over one sector, one after the other, ndof each.
    pub shapes: Vec<Complex64>,
    /// +1: the frequency rises with the speed at fixed K₁ (forward whirl), −1: it falls (backward), 0: neither, or
    /// undefined because modes share the frequency.
    pub direction: Vec<i64>,
}

impl DampedModes {
    /// Number of modes.
    #[must_use]
    pub fn count(&self) -> usize {
        self.eigenvalue.len()
    }

    /// Damped angular frequency Im λ of the k-th mode.
    #[must_use]
    pub fn omega(&self, k: usize) -> f64 {
        self.eigenvalue[k].im
    }

    /// Damping ratio −Re λ/|λ| of the k-th mode; negative: the motion grows.
    #[must_use]
    pub fn damping_ratio(&self, k: usize) -> f64 {
        -self.eigenvalue[k].re / self.eigenvalue[k].norm()
    }
}

/// The `count` lowest damped modes of nodal diameter `diameter`, fewer if fewer motions oscillate. A mode that grows
/// is told to the log.
///
/// # Errors
/// `Argument` for a diameter or count out of range and for a speed that is tied to the frequency; those of the
/// matrices and eigensolvers; `NoConvergence` or `Singular` without a static state; `StoppedByCaller`.
pub fn damped_modes(
    model: &Model,
    diameter: usize,
    contacts: LinearContacts,
    count: usize,
    hooks: &mut Hooks<'_>,
) -> Result<DampedModes> {
    let interrupt = hooks.interrupt();
    interrupt.phase(Phase::Modes, 0.0)?;
    let found = at_present_speed(model, diameter, contacts, count, &interrupt)?;
    for k in 0..found.count() {
        if found.damping_ratio(k) < GROWS {
            let text = format!(
                "mode {k} at angular frequency {} has the damping ratio {:.3e}: its motion grows",
                found.omega(k),
                found.damping_ratio(k)
            );
            hooks.log(LogLevel::Warn, &text);
        }
    }
    Ok(found)
}

/// The modes at the speed of the model.
pub(super) fn at_present_speed(
    model: &Model,
    diameter: usize,
    contacts: LinearContacts,
    count: usize,
    interrupt: &Interrupt<'_>,
) -> Result<DampedModes> {
    model.check_matrices(true)?;
    let structure = model.structure();
    let highest = structure.sectors() / 2;
    if diameter > highest {
        return fail!(
            Argument,
            "diameter = {diameter}, needs 0 .. {highest} for {} sectors",
            structure.sectors()
        );
    }
    if count == 0 {
        return fail!(Argument, "count = 0, needs at least 1");
    }
    if matches!(model.speed(), Speed::PerOmega(_)) {
        return fail!(
            Argument,
            "the speed is tied to the frequency, and a damped mode belongs to one speed: set a fixed speed"
        );
    }
    let wave = Wave::Diameter(diameter);
    let mass = structure.of_wave(MatrixKind::Mass, wave)?;
    let damping = structure.of_wave(MatrixKind::Damping, wave)?;
    let structural = structure.of_wave(MatrixKind::Structural, wave)?;
    let contacts = contacts.prepared(model, interrupt)?;
    let sprung = model.stiffness_at_small_motion(wave, contacts.state())?;
    let terms = [
        (Complex64::ONE, &sprung, Form::Plain),
        (Complex64::I, &structural, Form::Plain),
    ];
    let stiffness = Csc::sum(mass.rows, &terms)?;
    let problem = Quadratic {
        mass: &mass,
        damping: &damping,
        stiffness: &stiffness,
    };
    // One more shows whether the last shares its frequency.
    let mut pairs = problem.lowest(count.saturating_add(1), interrupt)?;
    let gyroscopic = structure.of_wave(MatrixKind::Gyroscopic, wave)?;
    let mut found = DampedModes::default();
    for (k, (eigenvalue, shape)) in pairs.iter().enumerate().take(count) {
        interrupt.check()?;
        let near = |other: &(Complex64, Vec<Complex64>)| (other.0 - eigenvalue).norm() <= EQUAL * eigenvalue.norm();
        let is_alone = !pairs.iter().enumerate().any(|(l, other)| l != k && near(other));
        let direction = if is_alone && !gyroscopic.is_empty() {
            direction(&problem, &gyroscopic, (*eigenvalue, shape), interrupt)?
        } else {
            0
        };
        try_push(&mut found.eigenvalue, *eigenvalue, CONTEXT)?;
        try_push(&mut found.direction, direction, CONTEXT)?;
    }
    pairs.truncate(count);
    let degrees = structure.degrees();
    let next = structure.wave_phase(diameter, 1);
    let mut all = try_vec(degrees.given(), Complex64::ZERO, CONTEXT)?;
    for (_, shape) in &pairs {
        degrees.expand(next, shape, &mut all);
        try_extend(&mut found.shapes, &all, CONTEXT)?;
    }
    Ok(found)
}

/// Sign of dω/dΩ at fixed K₁: dλ/dΩ = −λ yᴴGx / yᴴ(2λM + C)x with the left eigenvector y.
fn direction(
    problem: &Quadratic<'_>,
    gyroscopic: &Csc,
    (eigenvalue, x): (Complex64, &[Complex64]),
    interrupt: &Interrupt<'_>,
) -> Result<i64> {
    let shifted = problem.matrix(eigenvalue * (1.0 + OFFSET))?;
    let mut factor = Factor::new(&shifted, 1)?;
    factor.factor(&shifted, interrupt)?;
    // yᴴ A = 0 is Aᵀ conj(y) = 0.
    let mut left = problem.mass.times(x, CONTEXT)?;
    for z in &mut left {
        *z = z.conj();
    }
    for _ in 0..2 {
        factor.solve(&mut left, true, interrupt)?;
        let size = left.iter().fold(0.0_f64, |m, z| m.max(z.norm()));
        for z in &mut left {
            *z /= size;
        }
    }
    let product = |v: &[Complex64]| -> Complex64 { left.iter().zip(v).map(|(a, b)| a * b).sum() };
    let forces = gyroscopic.times(x, CONTEXT)?;
    let work = product(&forces);
    let size: f64 = left.iter().zip(&forces).map(|(a, b)| (a * b).norm()).sum();
    let change = -eigenvalue * work / product(&problem.slope_times(eigenvalue, x)?);
    Ok(
        if work.norm() <= NO_CHANGE * size || change.im.abs() <= NO_CHANGE * change.norm() {
            0
        } else if change.im > 0.0 {
            1
        } else {
            -1
        },
    )
}
