//! The pattern of a mistuned wheel from its measured modes, with its covariance.

use crate::analysis::linear::linear_contacts::LinearContacts;
use crate::error::{Result, fail, try_push, try_vec};
use crate::interrupt::{Interrupt, Phase};
use crate::linalg::factors::lu::Lu;
use crate::model::Model;
use crate::model::few_motions::tuned_family::TunedFamily;
use crate::model::wheels::mistuning::{BladeProperty, Mistuning};
use crate::studies::condition_noise::lower_factor;
use crate::studies::mode_adjustment::{Observed, Reduced};
use num_complex::Complex64;

const CONTEXT: &str = "the identification of a pattern";

/// Steps of an identification at most. Kind: cap; 24 blades whose frequencies lie closer than their deviations take 20 to 60, others 8.
const MOST_IDENTIFICATION_STEPS: usize = 200;

/// Change of the pattern, relative to its standard deviation or absolute, at which an identification ends. Kind: rounding.
const IDENTIFIED_TO_SIGMA: f64 = 1e-6;
const IDENTIFIED_TO: f64 = 1e-13;

/// Excess of χ² over its mean, in its standard deviations, that noise does not explain. Kind: fixed; of noise, one of ten
/// thousand is beyond 4.
const CONTRADICTION: f64 = 4.0;

/// Measured modes of a wheel, with their standard deviations.
#[derive(Clone, Copy, Debug)]
pub struct MeasuredModes<'a> {
    /// Degrees of freedom of a sector that were measured on every sector.
    pub points: &'a [usize],
    /// Angular frequencies of the measured modes.
    pub omega: &'a [f64],
    /// Standard deviations of the angular frequencies.
    pub sigma_omega: &'a [f64],
    /// Shapes of any scale and phase: mode after mode, sector after sector, point after point.
    pub shapes: &'a [Complex64],
    /// Standard deviation of the real and of the imaginary part of each shape's numbers, in the scale of the shape.
    pub sigma_shape: &'a [f64],
}

/// A pattern of mistuning that was found from measured modes.
#[derive(Clone, Debug)]
pub struct IdentifiedPattern {
    /// Deviation δ of each sector.
    pub delta: Vec<f64>,
    /// Covariance of the δ, N × N numbers.
    pub covariance: Vec<f64>,
    /// Sum of squares of the residuals over their standard deviations.
    pub chi2: f64,
    /// Degrees of freedom of `chi2`: number of data minus number of unknowns.
    pub degrees: usize,
    /// Number of steps that were needed.
    pub steps: usize,
}

/// Finds the most likely pattern of a mistuned wheel from measured modes, and its covariance. Both frequencies and
/// shapes have noise. `families` tuned modes of each nodal diameter are the basis of the modes: the families that
/// were measured, and some more.
///
/// # Errors
/// `Unsupported` for a plain model, gyroscopic forces, complex matrices, and other quantities than stiffness, frequency and mass;
/// `Dimension`, `NotFinite`, `Argument` or `Index` for data that do not fit; `Singular` where they do not tell the pattern;
/// `NoConvergence`; those of linear modes; `StoppedByCaller`.
pub fn wheel_identify(
    cyclic: &Model,
    what: &Mistuning<'_>,
    measured: &MeasuredModes<'_>,
    (contacts, families): (LinearContacts, usize),
    interrupt: &Interrupt<'_>,
) -> Result<IdentifiedPattern> {
    check(cyclic, measured, families)?;
    let prepared = contacts.prepared(cyclic, interrupt)?;
    let family = TunedFamily::new(cyclic, prepared.state(), families, interrupt)?;
    let (m, sectors) = (family.len(), cyclic.structure().sectors());
    let points = sectors * measured.points.len();
    let unit = measured.omega.iter().sum::<f64>() / measured.omega.len() as f64;
    let mut reduced = of_family(&family, what, measured.points, unit, interrupt)?;
    let mut modes = Vec::new();
    for (k, shape) in measured.shapes.chunks_exact(points).enumerate() {
        let (shape, size) = real_shape(shape, measured.points.len(), k)?;
        let frequency = (measured.omega[k] / unit, measured.sigma_omega[k] / unit);
        let mut mode = Observed::new(frequency, (shape, measured.sigma_shape[k] / size), &reduced)?;
        mode.start(&reduced, interrupt)?;
        try_push(&mut modes, mode, CONTEXT)?;
    }
    let mut lu = Lu::new(2 * m + 1, sectors.max(m) + 1)?;
    let (mut knows_errors, mut last) = (false, Last::default());
    let mut delta = try_vec(sectors, 0.0, CONTEXT)?;
    for step in 1..=MOST_IDENTIFICATION_STEPS {
        interrupt.part(Phase::Modes, step, MOST_IDENTIFICATION_STEPS)?;
        let pattern = reduced.of_pattern(&delta)?;
        let mut normal = try_vec(sectors * sectors, 0.0, CONTEXT)?;
        let mut right = try_vec(sectors, 0.0, CONTEXT)?;
        let mut chi2 = 0.0;
        for mode in &mut modes {
            interrupt.check_before((8 * m * m * m) as u64)?;
            chi2 += mode.add_normal(&reduced, &pattern, &mut lu, (&mut normal, &mut right), interrupt)?;
        }
        let covariance = inverse(&normal, sectors, interrupt)?;
        let mut change = try_vec(sectors, 0.0, CONTEXT)?;
        for (column, right) in covariance.chunks_exact(sectors).zip(&right) {
            for (change, c) in change.iter_mut().zip(column) {
                *change -= c * right;
            }
        }
        for mode in &mut modes {
            mode.follow(&change, &reduced);
        }
        chi2 += change.iter().zip(&right).map(|(a, b)| a * b).sum::<f64>();
        last = Last {
            chi2,
            ..Last::default()
        };
        let mut is_there = true;
        for (s, (delta, change)) in delta.iter_mut().zip(&change).enumerate() {
            *delta += change;
            let sigma = covariance[sectors * s + s].sqrt();
            is_there &= change.abs() <= (IDENTIFIED_TO_SIGMA * sigma).max(IDENTIFIED_TO);
            if change.abs() > last.deviations * sigma {
                (last.sector, last.deviations) = (s, change.abs() / sigma);
            }
        }
        if is_there && !knows_errors {
            // The noise of the data is no longer that of the conditions.
            knows_errors = true;
            let pattern = reduced.of_pattern(&delta)?;
            let lower = lower_factor(&covariance, sectors)?;
            let parts = reduced.of_parts(&lower)?;
            for mode in &mut modes {
                interrupt.check_before((4 * (sectors + 4) * m * m * m) as u64)?;
                mode.know_errors(&reduced, &pattern, (&parts, &lower), &mut lu, interrupt)?;
            }
        } else if is_there {
            reduced.matrices.clear();
            let found = IdentifiedPattern {
                delta,
                covariance,
                chi2: chi2.max(0.0),
                degrees: (points * modes.len()).saturating_sub(sectors),
                steps: step,
            };
            return in_quantity(found, what);
        }
    }
    last.refused((points * modes.len()).saturating_sub(sectors))
}

/// Last step of an identification that does not converge.
#[derive(Default)]
struct Last {
    chi2: f64,
    /// Sector whose δ changes most, in standard deviations.
    sector: usize,
    deviations: f64,
}

impl Last {
    /// The reason why the pattern still changes: residuals that noise does not explain, or data that fit several patterns.
    fn refused<T>(&self, degrees: usize) -> Result<T> {
        let Self {
            chi2,
            sector,
            deviations,
        } = self;
        let reason = if *chi2 > degrees as f64 + CONTRADICTION * (2.0 * degrees as f64).sqrt() {
            "the data contradict the model, their deviations are too small, or too few families are its basis"
        } else {
            "noise explains the data, but they fit several patterns: frequencies lie closer than their deviations, or the modes are too \
             few; give more modes or points, or more exact ones"
        };
        fail!(
            NoConvergence,
            "delta[{sector}] still changes by {deviations:.2e} of its standard deviation after {MOST_IDENTIFICATION_STEPS} steps, with \
             chi2 = {chi2:.1} of {degrees} degrees of freedom: {reason}"
        )
    }
}

fn check(cyclic: &Model, measured: &MeasuredModes<'_>, families: usize) -> Result<()> {
    let (n, sectors, modes) = (cyclic.ndof(), cyclic.structure().sectors(), measured.omega.len());
    if modes == 0 || measured.points.is_empty() {
        return fail!(
            Dimension,
            "{modes} modes at {} points of a sector, needs at least one of each",
            measured.points.len()
        );
    }
    if families == 0 || families > n {
        return fail!(Argument, "families = {families}, needs 1 .. {n}");
    }
    if let Some((k, dof)) = measured.points.iter().enumerate().find(|(_, dof)| **dof >= n) {
        return fail!(Index, "points[{k}] = {dof}, needs 0 .. {}", n - 1);
    }
    let numbers = modes * sectors * measured.points.len();
    if measured.shapes.len() != numbers || measured.sigma_omega.len() != modes || measured.sigma_shape.len() != modes {
        return fail!(
            Dimension,
            "{} numbers of shapes, {} and {} standard deviations, needs {numbers}, {modes} and {modes}",
            measured.shapes.len(),
            measured.sigma_omega.len(),
            measured.sigma_shape.len()
        );
    }
    let positive = [
        ("omega", measured.omega),
        ("sigma_omega", measured.sigma_omega),
        ("sigma_shape", measured.sigma_shape),
    ];
    for (name, values) in positive {
        if let Some(k) = values.iter().position(|v| !(v.is_finite() && *v > 0.0)) {
            return fail!(Argument, "{name}[{k}] = {}, needs a finite number above 0", values[k]);
        }
    }
    if let Some(k) = measured.shapes.iter().position(|z| !z.is_finite()) {
        return fail!(NotFinite, "shapes[{k}] = {}, needs finite numbers", measured.shapes[k]);
    }
    Ok(())
}

/// Matrices of the wheel over its tuned modes, with frequencies over `unit`.
fn of_family(
    family: &TunedFamily<'_>,
    what: &Mistuning<'_>,
    points: &[usize],
    unit: f64,
    interrupt: &Interrupt<'_>,
) -> Result<Reduced> {
    let mistuning = family.mistuning(what, interrupt)?;
    let m = family.len();
    let sectors = mistuning.matrices.len() / (m * m);
    let mut squares = try_vec(m, 0.0, CONTEXT)?;
    for (square, value) in squares.iter_mut().zip(family.squares()) {
        *square = value / (unit * unit);
    }
    let mut rows = try_vec(sectors * points.len() * m, 0.0, CONTEXT)?;
    for (k, &dof) in points.iter().enumerate() {
        for (j, column) in family.rows_of(dof)?.chunks_exact(sectors).enumerate() {
            for (s, v) in column.iter().enumerate() {
                rows[sectors * points.len() * j + points.len() * s + k] = *v;
            }
        }
    }
    // Numbers of size 1 at the measured points.
    let size = (rows.iter().map(|v| v * v).sum::<f64>() / m as f64).sqrt();
    if size == 0.0 {
        return fail!(Singular, "the measured points do not move in the tuned modes");
    }
    for v in &mut rows {
        *v /= size;
    }
    let mut matrices = mistuning.matrices;
    if !mistuning.of_mass {
        for v in &mut matrices {
            *v /= unit * unit;
        }
    }
    Ok(Reduced {
        modes: m,
        sectors,
        squares,
        of_mass: mistuning.of_mass,
        matrices,
        rows,
    })
}

/// A shape with the phase that makes its real part largest, scaled to length 1; and its former length. Modes without
/// gyroscopic forces and damping are real, so that the remaining imaginary part is noise.
fn real_shape(shape: &[Complex64], points: usize, k: usize) -> Result<(Vec<f64>, f64)> {
    let square: Complex64 = shape.iter().map(|z| z * z).sum();
    let size = shape.iter().map(Complex64::norm_sqr).sum::<f64>().sqrt();
    if size == 0.0 {
        return fail!(
            Argument,
            "the shape of mode {k} is zero at {points} points of each sector"
        );
    }
    let turn = Complex64::from_polar(size.recip(), -0.5 * square.arg());
    let mut real = try_vec(shape.len(), 0.0, CONTEXT)?;
    for (real, z) in real.iter_mut().zip(shape) {
        *real = (z * turn).re;
    }
    Ok((real, size))
}

fn inverse(normal: &[f64], n: usize, interrupt: &Interrupt<'_>) -> Result<Vec<f64>> {
    // Unknowns in units in which the diagonal is 1.
    let mut units = try_vec(n, 0.0, CONTEXT)?;
    for (s, unit) in units.iter_mut().enumerate() {
        *unit = normal[n * s + s].sqrt().recip();
    }
    let mut lu = Lu::new(n, n)?;
    let mut columns = try_vec(n * n, 0.0, CONTEXT)?;
    for j in 0..n {
        for i in 0..n {
            lu.matrix()[n * j + i] = normal[n * j + i] * units[i] * units[j];
        }
        columns[n * j + j] = 1.0;
    }
    let done = lu
        .factor(interrupt)
        .and_then(|()| lu.solve_columns(&mut columns, false, interrupt));
    // With variances beyond 1/epsilon of those of a blade that is known alone, nothing but rounding is left.
    let is_known =
        (0..n).all(|s| units[s].is_finite() && columns[n * s + s] > 0.0 && columns[n * s + s] < f64::EPSILON.recip());
    match done {
        Err(e) if e.status != crate::error::Status::Singular => return Err(e),
        Ok(()) if is_known => {}
        _ => {
            return fail!(
                Singular,
                "the measured modes do not tell the pattern: more modes or points are needed"
            );
        }
    }
    for j in 0..n {
        for i in 0..n {
            columns[n * j + i] *= units[i] * units[j];
        }
    }
    Ok(columns)
}

/// Turns factors on the stiffness into changes of frequency, (1 + δ)² = 1 + κ.
fn in_quantity(mut found: IdentifiedPattern, what: &Mistuning<'_>) -> Result<IdentifiedPattern> {
    if !matches!(what, Mistuning::Blade(BladeProperty::Frequency, _)) {
        return Ok(found);
    }
    let n = found.delta.len();
    if let Some(s) = found.delta.iter().position(|&x| x <= -1.0) {
        return fail!(
            NoConvergence,
            "the stiffness of blade {s} would be below zero: the data contradict the model"
        );
    }
    let mut slopes = try_vec(n, 0.0, CONTEXT)?;
    for (delta, slope) in found.delta.iter_mut().zip(&mut slopes) {
        let root = (1.0 + *delta).sqrt();
        (*delta, *slope) = (*delta / (1.0 + root), 0.5 / root);
    }
    for j in 0..n {
        for i in 0..n {
            found.covariance[n * j + i] *= slopes[i] * slopes[j];
        }
    }
    Ok(found)
}
