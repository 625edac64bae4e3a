//! Damped natural modes of the linear structure: eigenvalues λ of λ²M + λ(C + ΩG) + K + Ω²K₁ + iD in the upper half
//! plane, with the sense in which their frequencies change with the speed.

use crate::analysis::linear::linear_contacts::LinearContacts;
use crate::error::{Result, fail, try_extend, try_push, try_vec};
use crate::hooks::{Hooks, LogLevel};
use crate::interrupt::{Interrupt, Phase};
use crate::linalg::sparse_storage::sparse::{Csc, Form};
use crate::model::Model;
use crate::model::matrices::modal_directions::split_damping;
use crate::model::matrices::speed::Speed;
use crate::model::matrices::structure::MatrixKind;
use crate::model::matrices::wave::Wave;
use crate::model::natural_modes::damped_mode::SHIFT_OFFSET;
use crate::model::natural_modes::linear_modes::ContactState;
use crate::model::natural_modes::quadratic_problem::Quadratic;
use crate::model::natural_modes::shifted_factors::ShiftedFactors;
use num_complex::Complex64;

/// Relative distance of two eigenvalues that count as one.
/// Kind: rounding.
const DAMPED_MODES_EQUAL: f64 = 1e-7;

/// Change of the frequency with the speed, over the size of its terms, that is rounding.
/// Kind: rounding.
const NO_CHANGE: f64 = 1e-9;

/// Change of the frequency with the speed, over the largest of a degree of freedom alone, that is rounding.
/// Kind: rounding.
const UNTOUCHED: f64 = 1e-10;

/// Difference of two matrices, relative to their largest entry, that is rounding.
/// Kind: rounding.
const EQUAL_MATRICES: f64 = 4e-15;

/// Damping ratio below which a mode grows; above it is rounding.
/// Kind: rounding.
pub(crate) const GROWS: f64 = -1e-12;

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
    /// Number of modes found.
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

/// The `count` lowest damped modes of the signed nodal diameter `diameter`, modulo N (fewer if fewer motions
/// oscillate), for the wave in which sector s + 1 lags by 2π·diameter/N. With gyroscopic or aerodynamic forces, and
/// with unsymmetric or complex matrices, the wave of −`diameter` has other modes. The log reports a mode that grows.
///
/// # Errors
/// `Argument` for a diameter of a plain structure, a count of 0 and for a speed that is tied to the frequency; those of the
/// matrices and eigensolvers; `NoConvergence` or `Singular` without a static state; `StoppedByCaller`.
pub fn damped_modes(
    model: &Model,
    diameter: i64,
    contacts: LinearContacts,
    count: usize,
    hooks: &mut Hooks<'_>,
) -> Result<DampedModes> {
    let interrupt = hooks.interrupt();
    interrupt.phase(Phase::Modes, 0.0)?;
    check(model, diameter, count)?;
    let contacts = contacts.prepared(model, &interrupt)?;
    let found = of_wave(model, diameter, contacts.state(), count, &interrupt)?;
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

/// Checks the requested nodal diameter and number of modes.
pub(crate) fn check(model: &Model, diameter: i64, count: usize) -> Result<()> {
    model.check_matrices(true)?;
    model.structure().check_diameter(diameter)?;
    if count == 0 {
        return fail!(Argument, "count = 0, needs at least 1");
    }
    if matches!(model.speed(), Speed::PerOmega(_)) {
        return fail!(
            Argument,
            "the speed is tied to the frequency, and a damped mode belongs to one speed: set a fixed speed"
        );
    }
    Ok(())
}

/// The damped modes at the speed of the model, whose arguments have been checked.
pub(crate) fn of_wave(
    model: &Model,
    diameter: i64,
    contacts: ContactState<'_>,
    count: usize,
    interrupt: &Interrupt<'_>,
) -> Result<DampedModes> {
    let structure = model.structure();
    let wave = Wave::Diameter(diameter);
    let (damping, modal) = match split_damping(structure, wave, interrupt)? {
        Some(found) => found,
        None => (structure.of_wave(MatrixKind::Damping, wave)?, Vec::new()),
    };
    let matrices = WaveMatrices::new(model, wave, contacts, damping)?;
    let problem = Quadratic {
        mass: &matrices.mass,
        damping: &matrices.damping,
        stiffness: &matrices.stiffness,
        modal: &modal,
    };
    // One more shows whether the last shares its frequency.
    let mut pairs = problem.lowest(count.saturating_add(1), interrupt)?;
    let gyroscopic = structure.of_wave(MatrixKind::Gyroscopic, Wave::Diameter(diameter))?;
    let mut found = DampedModes::default();
    for (k, (eigenvalue, shape)) in pairs.iter().enumerate().take(count) {
        interrupt.check()?;
        let near = |other: &(Complex64, Vec<Complex64>)| {
            (other.0 - eigenvalue).norm() <= DAMPED_MODES_EQUAL * eigenvalue.norm()
        };
        let is_alone = !pairs.iter().enumerate().any(|(l, other)| l != k && near(other));
        let direction = if is_alone && !gyroscopic.is_empty() {
            direction(&problem, &gyroscopic, *eigenvalue, shape, interrupt)?
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

/// Whether the waves d and −d have equal eigenvalues: each matrix of one wave is the transpose of the matrix of the
/// other. The directions of their modes are then opposite.
pub(crate) fn has_equal_senses(model: &Model, diameter: i64, contacts: ContactState<'_>) -> Result<bool> {
    let of_diameter = |diameter: i64| {
        let wave = Wave::Diameter(diameter);
        let damping = model.structure().of_wave(MatrixKind::Damping, wave)?;
        WaveMatrices::new(model, wave, contacts, damping)
    };
    let (one, other) = (of_diameter(diameter)?, of_diameter(-diameter)?);
    let pairs = [
        (&one.mass, &other.mass),
        (&one.damping, &other.damping),
        (&one.stiffness, &other.stiffness),
    ];
    for (a, b) in pairs {
        let terms = [(Complex64::ONE, a, Form::Plain), ((-1.0).into(), b, Form::Transposed)];
        if Csc::sum(a.rows, &terms)?.max_abs() > EQUAL_MATRICES * a.max_abs() {
            return Ok(false);
        }
    }
    Ok(true)
}

/// Matrices M, C + ΩG, and K + Ω²K₁ + iD of a wave.
struct WaveMatrices {
    mass: Csc,
    damping: Csc,
    stiffness: Csc,
}

impl WaveMatrices {
    fn new(model: &Model, wave: Wave, contacts: ContactState<'_>, damping: Csc) -> Result<Self> {
        let structure = model.structure();
        let mass = structure.of_wave(MatrixKind::Mass, wave)?;
        let structural = structure.of_wave(MatrixKind::Structural, wave)?;
        let sprung = model.stiffness_at_small_motion(wave, contacts)?;
        let terms = [
            (Complex64::ONE, &sprung, Form::Plain),
            (Complex64::I, &structural, Form::Plain),
        ];
        Ok(Self {
            damping,
            stiffness: Csc::sum(mass.rows, &terms)?,
            mass,
        })
    }
}

/// Upper bound of the change of frequencies by the speed: the largest |Gᵢⱼ|/√(MᵢᵢMⱼⱼ).
fn largest_change(mass: &Csc, gyroscopic: &Csc) -> f64 {
    let mut largest = 0.0_f64;
    for j in 0..gyroscopic.cols {
        for (i, g) in gyroscopic.column(j) {
            let inertia = (mass.get(i, i).re * mass.get(j, j).re).max(0.0).sqrt();
            if inertia > 0.0 {
                largest = largest.max(g.norm() / inertia);
            }
        }
    }
    largest
}

/// Sign of dω/dΩ at fixed K₁: dλ/dΩ = −λ yᴴGx / yᴴ(2λM + C)x with the left eigenvector y.
fn direction(
    problem: &Quadratic<'_>,
    gyroscopic: &Csc,
    eigenvalue: Complex64,
    x: &[Complex64],
    interrupt: &Interrupt<'_>,
) -> Result<i64> {
    let mut factors = ShiftedFactors::new(problem, eigenvalue * (1.0 + SHIFT_OFFSET), 1, interrupt)?;
    // yᴴ A = 0 is Aᵀ conj(y) = 0.
    let mut left = problem.mass.times(x, CONTEXT)?;
    for z in &mut left {
        *z = z.conj();
    }
    for _ in 0..2 {
        factors.solve(&mut left, true, interrupt)?;
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
    // A mode that gyroscopic forces do not touch moves their degrees of freedom by rounding, which has a sense of its own.
    let is_rounding = work.norm() <= NO_CHANGE * size
        || change.im.abs() <= NO_CHANGE * change.norm()
        || change.im.abs() <= UNTOUCHED * largest_change(problem.mass, gyroscopic);
    Ok(if is_rounding {
        0
    } else if change.im > 0.0 {
        1
    } else {
        -1
    })
}
