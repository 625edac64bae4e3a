//! Residual and Jacobian at a point of the caller, and a law on a prescribed motion: for callers with a
//! continuation of their own, and for tests. The problem is neither reduced nor condensed.

use crate::aft::{Evaluation, Evaluator};
use crate::at_a_point::evaluation_need::{allow_law, allow_residual};
use crate::at_a_point::residual_numbering::Numbering;
use crate::contact::{self, Contact};
use crate::error::{Result, fail, try_push, try_vec};
use crate::fourier::HarmonicSet;
use crate::interrupt::{Interrupt, Phase};
use crate::linalg::sparse_storage::sparse::{Csc, Form};
use crate::model::Model;
use crate::model::matrices::spring::{Row, along};
use crate::model::matrices::structure::MatrixKind;
use crate::model::matrices::wave::Wave;
use crate::options::SolverOptions;
use num_complex::Complex64;

/// Residual R_h = Z_h x_h + Wᴴ f_h − F_h of harmonic balance with harmonics 0 ..= H of all degrees
/// of freedom, with its Jacobian and frequency derivative.
///
/// `x` and `r` are (H + 1) × ndof, harmonic by harmonic. `jacobian`, if given, is real, column-major, of order
/// 2(H + 1)·ndof over the pairs (Re, Im); `d_omega` is ∂R/∂ω. The imaginary part of the mean is no unknown: its
/// rows read Im x₀ = 0.
///
/// # Errors
/// `Dimension` and `NotFinite`, naming the array; those of the model's matrices.
pub fn forced_residual(
    model: &Model,
    solver: &SolverOptions,
    omega: f64,
    x: &[Complex64],
    r: &mut [Complex64],
    jacobian: Option<&mut [f64]>,
    d_omega: Option<&mut [Complex64]>,
) -> Result<()> {
    forced_residual_with(model, solver, omega, x, (r, jacobian, d_omega), &Interrupt::none())
}

pub use crate::at_a_point::residual_numbering::ResidualArrays;

/// Residual as [`forced_residual`], and the caller may stop it: the arrays are then untouched or NaN.
///
/// # Errors
/// As [`forced_residual`]; `StoppedByCaller`.
pub fn forced_residual_with(
    model: &Model,
    solver: &SolverOptions,
    omega: f64,
    x: &[Complex64],
    (r, jacobian, d_omega): ResidualArrays<'_>,
    interrupt: &Interrupt<'_>,
) -> Result<()> {
    solver.fixed().check()?;
    if !omega.is_finite() || omega < 0.0 {
        return fail!(Argument, "omega = {omega}, needs a finite angular frequency >= 0");
    }
    let n = model.ndof();
    let highest = solver.harmonics;
    let size = (highest + 1).saturating_mul(n);
    let order = size.saturating_mul(2);
    check_len("x", x.len(), size)?;
    check_len("r", r.len(), size)?;
    if let Some(j) = &jacobian {
        check_len("jac", j.len(), order.saturating_mul(order))?;
    }
    if let Some(d) = &d_omega {
        check_len("d_omega", d.len(), size)?;
    }
    if let Some(i) = x.iter().position(|z| !z.is_finite()) {
        return fail!(NotFinite, "x[{i}] is not finite");
    }
    for force in model.excitation().forces() {
        if force.harmonic > highest && force.value != Complex64::ZERO {
            return fail!(
                Argument,
                "a force acts in harmonic {}, but harmonics = {highest}",
                force.harmonic
            );
        }
    }
    allow_residual(model, solver)?;
    // All steps that can fail come before the arrays of the caller are changed.
    let numbering = Numbering::new(model, highest, jacobian.is_some(), d_omega.is_some())?;
    if let Some(numbering) = numbering {
        return numbering.residual(model, x, (r, jacobian, d_omega), |x, arrays| {
            forced_residual_of_independent(model, solver, omega, x, arrays, interrupt)
        });
    }
    forced_residual_of_independent(model, solver, omega, x, (r, jacobian, d_omega), interrupt)
}

/// The residual over the independent degrees of freedom.
fn forced_residual_of_independent(
    model: &Model,
    solver: &SolverOptions,
    omega: f64,
    x: &[Complex64],
    (r, mut jacobian, mut d_omega): ResidualArrays<'_>,
    interrupt: &Interrupt<'_>,
) -> Result<()> {
    let highest = solver.harmonics;
    let at_frequency = model.at_frequency(omega)?;
    let derivatives = jacobian.is_some() || d_omega.is_some();
    let contact = ContactTerms::new(model, &at_frequency, (solver, omega, derivatives), x, interrupt)?;
    let mut dynamic = Vec::new();
    for h in 0..=highest {
        interrupt.part(Phase::Setup, h, highest + 1)?;
        try_push(
            &mut dynamic,
            Dynamic::new(model, &at_frequency, h, omega)?,
            "the dynamic stiffness",
        )?;
    }

    let assembled = assemble(
        (model, &at_frequency, omega),
        &dynamic,
        &contact,
        x,
        (r, jacobian.as_deref_mut(), d_omega.as_deref_mut()),
        interrupt,
    );
    if assembled.is_err() {
        // No half of a residual is left.
        r.fill(Complex64::new(f64::NAN, f64::NAN));
        if let Some(j) = jacobian {
            j.fill(f64::NAN);
        }
        if let Some(d) = d_omega {
            d.fill(Complex64::new(f64::NAN, f64::NAN));
        }
    }
    assembled
}

/// Fills the arrays with the sum of the terms of structure, contacts and forces.
fn assemble(
    (model, at_frequency, omega): (&Model, &Model, f64),
    dynamic: &[Dynamic],
    contact: &ContactTerms,
    x: &[Complex64],
    (r, mut jacobian, mut d_omega): ResidualArrays<'_>,
    interrupt: &Interrupt<'_>,
) -> Result<()> {
    let n = model.structure().ndof();
    let order = 2 * x.len();
    r.fill(Complex64::ZERO);
    if let Some(d) = d_omega.as_deref_mut() {
        d.fill(Complex64::ZERO);
    }
    if let Some(j) = jacobian.as_deref_mut() {
        for column in j.chunks_exact_mut(order) {
            interrupt.check_before(order as u64)?;
            column.fill(0.0);
        }
    }
    for (h, dynamic) in dynamic.iter().enumerate() {
        interrupt.part(Phase::Results, h, x.len() / n)?;
        let range = h * n..(h + 1) * n;
        at_frequency.add_forces_to(h, -1.0, &mut r[range.clone()]);
        if let Some(d) = d_omega.as_deref_mut() {
            model.add_unbalance_to(h, -2.0 * omega, &mut d[range.clone()]);
        }
        dynamic
            .z
            .multiply_add(Complex64::ONE, &x[range.clone()], &mut r[range.clone()]);
        if let Some(d) = d_omega.as_deref_mut() {
            dynamic
                .slope
                .multiply_add(Complex64::ONE, &x[range.clone()], &mut d[range.clone()]);
        }
        if let Some(j) = jacobian.as_deref_mut() {
            for column in 0..n {
                interrupt.check()?;
                for (row, v) in dynamic.z.column(column) {
                    add_block(j, order, range.start + row, range.start + column, v, h == 0);
                }
            }
        }
        if h == 0 {
            for i in 0..n {
                r[i].im = x[i].im;
                if let Some(d) = d_omega.as_deref_mut() {
                    d[i].im = 0.0;
                }
                if let Some(j) = jacobian.as_deref_mut() {
                    j[(2 * i + 1) * order + 2 * i + 1] = 1.0;
                }
            }
        }
    }
    contact.add(n, r, jacobian, d_omega, interrupt)
}

fn check_len(name: &str, len: usize, needed: usize) -> Result<()> {
    if len == needed {
        return Ok(());
    }
    fail!(Dimension, "{name} has {len} entries, needs {needed}")
}

/// Adds the complex factor v to a real matrix as a 2 × 2 block; for the mean only its real row and column.
fn add_block(j: &mut [f64], order: usize, row: usize, column: usize, v: Complex64, mean: bool) {
    j[2 * column * order + 2 * row] += v.re;
    if !mean {
        j[2 * column * order + 2 * row + 1] += v.im;
        j[(2 * column + 1) * order + 2 * row] -= v.im;
        j[(2 * column + 1) * order + 2 * row + 1] += v.re;
    }
}

/// Dynamic stiffness Z_h and its derivative ∂Z_h/∂ω.
struct Dynamic {
    z: Csc,
    slope: Csc,
}

impl Dynamic {
    /// Makes Z_h; `at` is the model at the frequency, whose damping contains ΩG and whose stiffness Ω²K₁.
    fn new(model: &Model, at: &Model, h: usize, omega: f64) -> Result<Self> {
        let structure = at.structure();
        let n = structure.ndof();
        let k = at.sprung_stiffness(Wave::Harmonic(h), core::iter::empty())?;
        let c = structure.wave_matrix(MatrixKind::Damping, h)?;
        let structural = structure.wave_matrix(MatrixKind::Structural, h)?;
        let m = structure.wave_matrix(MatrixKind::Mass, h)?;
        let tied = model.structure().tied_to_frequency(Wave::Harmonic(h))?;
        let h = h as f64;
        let hw = h * omega;
        let plain = Form::Plain;
        let mut slope = Vec::with_capacity(4);
        slope.extend([(Complex64::new(0.0, h), &c, plain), ((-2.0 * h * hw).into(), &m, plain)]);
        if let Some(tied) = &tied {
            slope.extend([
                ((2.0 * omega).into(), &tied.stiffness, plain),
                (Complex64::new(0.0, hw), &tied.gyroscopic, plain),
            ]);
        }
        Ok(Self {
            z: Csc::sum(
                n,
                &[
                    (Complex64::ONE, &k, plain),
                    (Complex64::new(0.0, hw), &c, plain),
                    (Complex64::I, &structural, plain),
                    ((-hw * hw).into(), &m, plain),
                ],
            )?,
            slope: Csc::sum(n, &slope)?,
        })
    }
}

/// Forces and Jacobians of all contacts at a motion.
struct ContactTerms {
    set: HarmonicSet,
    /// Per contact: rows of its directions, harmonic after harmonic; and evaluation of its law.
    terms: Vec<(Vec<Vec<Row>>, Evaluation)>,
}

impl ContactTerms {
    fn new(
        model: &Model,
        at: &Model,
        (solver, omega, derivatives): (&SolverOptions, f64, bool),
        x: &[Complex64],
        interrupt: &Interrupt<'_>,
    ) -> Result<Self> {
        const CONTEXT: &str = "the contacts";
        let n = model.structure().ndof();
        let set = HarmonicSet::all(solver.harmonics)?;
        let m = set.packed_len();
        let mut terms = Vec::new();
        for (number, contact) in at.contacts().iter().enumerate() {
            let directions = contact.directions();
            let mut packed = try_vec(m.saturating_mul(directions), 0.0, "a contact motion")?;
            let mut rows = Vec::new();
            for (k, packed) in packed.chunks_exact_mut(m).enumerate() {
                let motion = model.structure().contact_motion(contact, k);
                let mut own = Vec::new();
                for h in 0..=solver.harmonics {
                    let row = model.structure().row(&motion, Wave::Harmonic(h));
                    set.set(packed, h, along(&row, &x[h * n..(h + 1) * n]));
                    try_push(&mut own, row, CONTEXT)?;
                }
                try_push(&mut rows, own, CONTEXT)?;
            }
            let mut evaluation = evaluate(contact, derivatives, &set, (solver.samples, omega), &packed, interrupt)?;
            if let Some(growth) = model.growth_of_load(number, omega).filter(|_| derivatives) {
                // ∂f/∂ω = (∂f/∂ln N) ∂ln N/∂ω
                let by_load = if contact.load_scales_motion() {
                    &evaluation.offset
                } else {
                    &evaluation.force
                };
                for (by_omega, by_load) in evaluation.by_omega.iter_mut().zip(by_load) {
                    *by_omega += growth * by_load;
                }
            }
            try_push(&mut terms, (rows, evaluation), CONTEXT)?;
        }
        Ok(Self { set, terms })
    }

    /// Adds Wᴴ f to the residual, Wᴴ (∂f/∂y) W to the Jacobian, and Wᴴ ∂f/∂ω to the derivative.
    fn add(
        &self,
        n: usize,
        r: &mut [Complex64],
        mut jacobian: Option<&mut [f64]>,
        mut d_omega: Option<&mut [Complex64]>,
        interrupt: &Interrupt<'_>,
    ) -> Result<()> {
        let order = 2 * r.len();
        let m = self.set.packed_len();
        for (rows, evaluation) in &self.terms {
            interrupt.check()?;
            for (k, own) in rows.iter().enumerate() {
                self.add_force(own, &evaluation.force[k * m..(k + 1) * m], n, r);
                if let Some(d) = d_omega.as_deref_mut() {
                    self.add_force(own, &evaluation.by_omega[k * m..(k + 1) * m], n, d);
                }
            }
            let Some(jacobian) = jacobian.as_deref_mut() else {
                continue;
            };
            for (k, force) in rows.iter().enumerate() {
                for (l, motion) in rows.iter().enumerate() {
                    let block = Block {
                        set: &self.set,
                        jacobian: &evaluation.jacobian,
                        order: m * rows.len(),
                        force: k * m,
                        motion: l * m,
                    };
                    interrupt.check()?;
                    block.add(force, motion, n, jacobian, order);
                }
            }
        }
        Ok(())
    }

    /// Adds the force rᴴ f of one direction to the residual.
    fn add_force(&self, rows: &[Row], packed: &[f64], n: usize, r: &mut [Complex64]) {
        for (h, row) in rows.iter().enumerate() {
            let f = self.set.get(packed, h);
            for &(p, a) in row.iter().flatten() {
                let term = a.conj() * f;
                r[h * n + p] += if h == 0 { term.re.into() } else { term };
            }
        }
    }
}

/// Derivative ∂f/∂y of one direction of force by one direction of motion, as a block within the Jacobian of a law.
struct Block<'a> {
    set: &'a HarmonicSet,
    jacobian: &'a [f64],
    order: usize,
    force: usize,
    motion: usize,
}

impl Block<'_> {
    /// Harmonic h of the force in one column of the block.
    fn get(&self, column: usize, h: usize) -> Complex64 {
        let begin = (self.motion + column) * self.order + self.force;
        self.set.get(&self.jacobian[begin..begin + self.set.packed_len()], h)
    }

    /// Adds rᴴ (∂f/∂y) r to a Jacobian of the given order.
    fn add(&self, force: &[Row], motion: &[Row], n: usize, jacobian: &mut [f64], order: usize) {
        for (h, row) in force.iter().enumerate() {
            for (k, column) in motion.iter().enumerate() {
                for &(p, a) in row.iter().flatten() {
                    for &(q, b) in column.iter().flatten() {
                        // dx = (1, i) gives dy = b·dx as a packed pair.
                        for part in 0..if k == 0 { 1 } else { 2 } {
                            let dy = if part == 0 { b } else { b * Complex64::I };
                            let at = self.set.offset(k);
                            let mut df = self.get(at, h) * dy.re;
                            if k > 0 {
                                df += self.get(at + 1, h) * dy.im;
                            }
                            let df = a.conj() * df;
                            let target = (2 * (k * n + q) + part) * order + 2 * (h * n + p);
                            jacobian[target] += df.re;
                            if h > 0 {
                                jacobian[target + 1] += df.im;
                            }
                        }
                    }
                }
            }
        }
    }
}

/// A law in the caller's units at packed motions, with its Jacobian or its force alone.
fn evaluate(
    contact: &Contact,
    jacobian: bool,
    set: &HarmonicSet,
    (samples, omega): (usize, f64),
    packed: &[f64],
    interrupt: &Interrupt<'_>,
) -> Result<Evaluation> {
    let law = contact.law(1.0)?;
    if omega == 0.0 && matches!(law.form(), contact::Form::Hysteretic(_)) {
        return fail!(
            Argument,
            "omega = 0, needs a number > 0 for a law with states, which takes steps in time"
        );
    }
    let once = core::iter::once(&*law);
    let (mut evaluation, mut evaluator) = if jacobian {
        let evaluation = Evaluation::interruptible(set, contact.directions(), interrupt)?;
        (evaluation, Evaluator::new(set, samples, once)?)
    } else {
        let evaluation = Evaluation::force_alone(set, contact.directions())?;
        (evaluation, Evaluator::force_alone(set, (samples, 1), once)?)
    };
    evaluator.prepare(set, &packed[..set.packed_len()], interrupt)?;
    evaluator.evaluate(&*law, set, packed, omega, &mut evaluation, interrupt)?;
    Ok(evaluation)
}

/// Force harmonics of one law on prescribed relative motions with harmonics 0 ..= `harmonics`, and their real
/// Jacobian over the pairs (Re, Im), column-major of order 2(H + 1)·d; `motion` and `force` are d × (H + 1),
/// direction after direction. `samples` = 0 locates events exactly if the law has events. `omega` affects laws that
/// depend on velocity. The imaginary part of the mean has no effect and no force.
///
/// # Errors
/// `Argument`, `Dimension` or `NotFinite`, naming the argument; those of callbacks.
pub fn contact_evaluate(
    contact: &Contact,
    harmonics: usize,
    samples: usize,
    omega: f64,
    motion: &[Complex64],
    force: &mut [Complex64],
    jacobian: Option<&mut [f64]>,
) -> Result<()> {
    let at = (harmonics, samples, omega);
    contact_evaluate_with(contact, at, motion, force, jacobian, &Interrupt::none())
}

/// Evaluates a law as [`contact_evaluate`], and the caller may stop it; arrays are then untouched.
///
/// # Errors
/// As [`contact_evaluate`]; `StoppedByCaller`.
pub fn contact_evaluate_with(
    contact: &Contact,
    (harmonics, samples, omega): (usize, usize, f64),
    motion: &[Complex64],
    force: &mut [Complex64],
    jacobian: Option<&mut [f64]>,
    interrupt: &Interrupt<'_>,
) -> Result<()> {
    contact.check_constants()?;
    SolverOptions {
        harmonics,
        samples,
        tolerance: 0.0,
        ..SolverOptions::default()
    }
    .check()?;
    if !omega.is_finite() || omega < 0.0 {
        return fail!(Argument, "omega = {omega}, needs a finite angular frequency >= 0");
    }
    let count = harmonics + 1;
    let directions = contact.directions();
    let size = count.saturating_mul(directions);
    check_len("motion", motion.len(), size)?;
    check_len("force", force.len(), size)?;
    if let Some(j) = &jacobian {
        check_len("jac", j.len(), (2 * size).saturating_mul(2 * size))?;
    }
    if let Some(i) = motion.iter().position(|z| !z.is_finite()) {
        return fail!(NotFinite, "motion[{i}] is not finite");
    }
    allow_law(contact, harmonics, samples, jacobian.is_some())?;
    let set = HarmonicSet::all(harmonics)?;
    let m = set.packed_len();
    let mut packed = try_vec(m * directions, 0.0, "a contact motion")?;
    for (packed, motion) in packed.chunks_exact_mut(m).zip(motion.chunks_exact(count)) {
        for (i, &z) in motion.iter().enumerate() {
            set.set(packed, i, z);
        }
    }
    let evaluation = evaluate(contact, jacobian.is_some(), &set, (samples, omega), &packed, interrupt)?;
    // From here on all of the arrays is written, or none.
    interrupt.check_before(evaluation.jacobian.len() as u64)?;
    for (force, packed) in force.chunks_exact_mut(count).zip(evaluation.force.chunks_exact(m)) {
        for (i, f) in force.iter_mut().enumerate() {
            *f = set.get(packed, i);
        }
    }
    if let Some(jacobian) = jacobian {
        jacobian.fill(0.0);
        // Packed position p of (harmonic, part) is pair position p + 1, but 0 for the mean.
        let pair = |p: usize| 2 * count * (p / m) + if p.is_multiple_of(m) { 0 } else { p % m + 1 };
        for (column, j) in evaluation.jacobian.chunks_exact(m * directions).enumerate() {
            for (row, j) in j.iter().enumerate() {
                jacobian[pair(column) * 2 * size + pair(row)] = *j;
            }
        }
    }
    Ok(())
}
