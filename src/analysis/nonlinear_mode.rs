//! A nonlinear mode over a range of amplitude: its frequency and damping from contacts that stick to
//! contacts that slide.

use super::follow::{Keeper, Task};
use crate::branch::mode::{ModeData, ModeInfo, ModePoint};
use crate::branch::{Branch, Record, SpecialKind};
use crate::condense::Condensed;
use crate::condense::modal::along;
use crate::continuation::start::{self, First};
use crate::continuation::step_control::StepControl;
use crate::continuation::{Point, Settings};
use crate::error::{Result, Status, fail, try_copy, try_push, try_vec};
use crate::hooks::{Hooks, LogLevel};
use crate::linalg::norm;
use crate::model::Model;
use crate::model::spring::relative_row;
use crate::options::{Amplitude, ModeOptions, SolverOptions};
use crate::postprocess::energy::{self, Balance};
use crate::problem::mode::{Gauge, LinearMode, Mode};
use crate::problem::{Linearisation, Problem};
use num_complex::Complex64;
use std::sync::Arc;

/// Motion that counts as none, relative to the largest of the mode.
const NODE: f64 = 1e-9;

/// First amplitude beyond the onset of slip that is solved for, relative to the onset. At the onset
/// itself the branch has a corner, and where modes share a frequency no solution is isolated.
const BEYOND_ONSET: f64 = 1.02;

/// Follows a nonlinear mode of `model` from `range.log10_start` to `range.log10_stop`.
///
/// The forces of the model play no part. A branch that ends early is returned with a positive
/// [`Branch::status`] and every point found. Its peaks are the points of largest damping ratio, its
/// folds those where the amplitude turns.
///
/// # Errors
/// Bad options and models ([`SolverOptions::check`], [`ModeOptions::check`],
/// [`Model::start_mode`]), `Argument` for a mode that moves no contact and for a reference degree of
/// freedom at a node of the mode, `Unsupported` for constant forces, `NoConvergence` when no first
/// point was found.
pub fn nonlinear_mode(
    model: &Model,
    solver: &SolverOptions,
    range: &ModeOptions<'_>,
    hooks: &mut Hooks<'_>,
) -> Result<Branch> {
    solver.check()?;
    let sectors = model.structure().sectors();
    range.check(model.ndof(), model.contacts().len(), sectors)?;
    if solver.harmonics == 0 {
        return fail!(Argument, "harmonics = 0, a nonlinear mode needs at least 1");
    }
    if let Some(dof) = solver.response_dof.filter(|&d| d >= model.ndof()) {
        return fail!(Index, "response_dof = {dof}, needs 0 .. {}", model.ndof() - 1);
    }
    let constant = |f: &&crate::model::excitation::Force| f.harmonic == 0 && f.value != Complex64::ZERO;
    if let Some(force) = model.excitation().forces().iter().find(constant) {
        return fail!(
            Unsupported,
            "a constant force of {} acts on dof {}; nonlinear modes under constant forces are not provided yet",
            force.value.re,
            force.dof
        );
    }
    match range.diameter {
        None => on_wave(model, solver, range, hooks),
        Some(diameter) => {
            let mut model = model.try_clone()?;
            model.set_wave(diameter as i64);
            on_wave(&model, solver, range, hooks)
        }
    }
}

/// The mode on the wave of the model's engine order.
fn on_wave(model: &Model, solver: &SolverOptions, range: &ModeOptions<'_>, hooks: &mut Hooks<'_>) -> Result<Branch> {
    let chosen = model.start_mode(range.choice)?;
    let damped = model.damped_mode(&chosen, range.damping_form)?;
    let mut linear = LinearMode {
        omega: damped.omega,
        damping: damped.damping,
        shape: damped.shape,
    };
    let gauge = gauge(model, range, &mut linear)?;
    let (condensed, motion) = Condensed::for_mode(model, solver, range.damping_form, &linear.shape)?;
    let condensed = Arc::new(condensed);
    let largest = linear.shape.iter().fold(0.0_f64, |m, z| m.max(z.norm()));
    if condensed.coordinates() == 0 || motion <= NODE * largest {
        return fail!(
            Argument,
            "mode {} (angular frequency {}) moves no contact that can slip: largest relative motion {motion} of {largest}; it is linear",
            chosen.index,
            chosen.omega
        );
    }
    let mut problem = Mode::new(&condensed, &gauge, &linear, solver.samples)?;
    let onset = problem.linear_up_to()?;
    // A smooth law is never linear, however small its force.
    let linear_up_to = if problem.is_linear_at(onset - 1e-9)? {
        onset
    } else {
        f64::NEG_INFINITY
    };
    let info = ModeInfo {
        index: chosen.index,
        omega: chosen.omega,
        multiplicity: chosen.multiplicity,
        multiple: chosen.multiple,
        reference_dof: gauge.reference_dof,
        amplitude: range.amplitude,
        linear_up_to,
        stuck: chosen.stuck,
        free: chosen.free,
    };
    let response = solver.response_dof.unwrap_or(gauge.reference_dof);
    let mut branch = Branch::new(
        Arc::clone(&condensed),
        condensed.reduction(model, solver),
        solver.samples,
        solver.harmonics,
        response,
    );
    branch.set_mode(ModeData::new(info, linear.clone(), gauge.clone(), problem.size()));
    let carried = condensed.blocks().len();
    let unknowns = problem.size();
    let mut points = Points {
        at: Linearisation::new(unknowns)?,
        specials: Vec::new(),
        motion: try_vec(unknowns - 2, 0.0, WHAT)?,
        forces: try_vec(unknowns - 2, 0.0, WHAT)?,
        response: try_vec(carried, Complex64::ZERO, WHAT)?,
        before: Vec::new(),
        weighted: try_vec(model.ndof(), Complex64::ZERO, WHAT)?,
        stalled: false,
        condensed: &condensed,
        linear: &linear,
        branch,
        problem,
    };
    let status = points.run(solver, range, linear_up_to, hooks)?;
    points.finish(status)
}

const WHAT: &str = "the nonlinear mode";

/// Chooses the phase's degree of freedom and gives the linear mode amplitude 1.
fn gauge(model: &Model, range: &ModeOptions<'_>, linear: &mut LinearMode) -> Result<Gauge> {
    let shape = &mut linear.shape;
    let mut most = 0;
    for (dof, z) in shape.iter().enumerate() {
        // The first of those that move alike, rounding or not.
        if z.norm() > (1.0 + 1e-9) * shape[most].norm() {
            most = dof;
        }
    }
    let largest = shape[most].norm();
    let reference_dof = range.reference_dof.unwrap_or(most);
    if shape[reference_dof].norm() <= NODE * largest {
        return fail!(
            Argument,
            "reference_dof = {reference_dof} is a node of the mode: it moves {} where dof {most} moves {largest}",
            shape[reference_dof].norm()
        );
    }
    let contact = match range.amplitude {
        Amplitude::Modal => None,
        Amplitude::Contact(id) => {
            let contact = &model.contacts()[id];
            let phase = model.structure().phase(1, contact.sector_offset);
            let row = relative_row(contact.dof_a, contact.dof_b, phase);
            let motion = along(&row, shape).norm();
            if motion <= NODE * largest {
                return fail!(
                    Argument,
                    "amplitude_contact = {id}: the mode does not move this contact: relative motion {motion} of {largest}"
                );
            }
            for z in shape.iter_mut() {
                *z /= motion;
            }
            Some(row)
        }
    };
    Ok(Gauge { contact, reference_dof })
}

/// Collects the points of one run.
struct Points<'a> {
    condensed: &'a Condensed,
    linear: &'a LinearMode,
    branch: Branch,
    problem: Mode<'a>,
    at: Linearisation,
    specials: Vec<Kept>,
    motion: Vec<f64>,
    forces: Vec<f64>,
    response: Vec<Complex64>,
    /// Fundamental of the point of the curve before.
    before: Vec<Complex64>,
    weighted: Vec<Complex64>,
    stalled: bool,
}

/// A special point until the curve is complete.
struct Kept {
    kind: SpecialKind,
    point: Point,
    motion: Vec<f64>,
    response: Vec<Complex64>,
    slip_fractions: Vec<f64>,
    mode: ModePoint,
}

impl Points<'_> {
    fn run(
        &mut self,
        solver: &SolverOptions,
        range: &ModeOptions<'_>,
        linear_up_to: f64,
        hooks: &mut Hooks<'_>,
    ) -> Result<Status> {
        let (start, end) = (range.log10_start, range.log10_stop);
        let from = if start <= linear_up_to {
            (linear_up_to + BEYOND_ONSET.log10()).min(end)
        } else {
            start
        };
        let settings = Settings {
            start: from,
            end,
            tolerance: solver.tol_residual,
            max_iterations: solver.max_newton,
            steps: StepControl::new(solver.step, solver.step_min, solver.step_max),
        };
        let task = Task {
            settings,
            range: (start, end),
            at: range.at,
            max_points: solver.max_points,
        };
        if start <= linear_up_to {
            if let Some(status) = self.linear_range(&task, linear_up_to.min(end), hooks)? {
                return Ok(status);
            }
            for (i, &p) in range.at.iter().enumerate() {
                if p <= linear_up_to {
                    let point = self.linear_point(p)?;
                    self.keep_special(SpecialKind::At(i), point)?;
                } else if p < from {
                    let at_it = Settings { start: p, ..settings };
                    match start::solve(&mut self.problem, &at_it, hooks.cancelled)? {
                        First::Found(point) => self.keep_special(SpecialKind::At(i), point)?,
                        First::Cancelled => return Ok(Status::StoppedByCaller),
                    }
                }
            }
            if end <= linear_up_to {
                return Ok(Status::Ok);
            }
            if self.branch.points() >= solver.max_points {
                return Ok(Status::StoppedMaxPoints);
            }
        }
        match start::solve(&mut self.problem, &settings, hooks.cancelled)? {
            First::Found(first) => {
                hooks.log(LogLevel::Info, "first point with slip or a nonlinear force solved");
                task.run(self, first, hooks)
            }
            First::Cancelled => Ok(Status::StoppedByCaller),
        }
    }

    /// Points from the start of the range to `end`, below which all contacts stick: nothing has to
    /// be solved there. They are as dense as the largest steps of the continuation.
    fn linear_range(&mut self, task: &Task<'_>, end: f64, hooks: &mut Hooks<'_>) -> Result<Option<Status>> {
        let (start, stop) = task.range;
        let spacing = task.settings.steps.largest() * (stop - start);
        let steps = ((end - start) / spacing).ceil().max(1.0);
        let count = if end > start { steps as usize + 1 } else { 1 };
        for k in 0..count {
            if self.branch.points() >= task.max_points {
                return Ok(Some(Status::StoppedMaxPoints));
            }
            let p = if k + 1 == count && count > 1 {
                end
            } else {
                start + (end - start) * (k as f64 / steps)
            };
            let point = self.linear_point(p)?;
            self.keep(&point)?;
            if task.report(self, hooks, &point) || hooks.cancelled.is_some_and(|f| f()) {
                return Ok(Some(Status::StoppedByCaller));
            }
        }
        Ok(None)
    }

    /// The linear mode as a point of the branch.
    fn linear_point(&mut self, p: f64) -> Result<Point> {
        let n = self.problem.size();
        let mut v = try_vec(n + 1, 0.0, WHAT)?;
        self.problem.linear_start(&mut v[..n]);
        v[n] = p;
        let mut tangent = try_vec(n + 1, 0.0, WHAT)?;
        tangent[n] = 1.0;
        self.problem.evaluate(&v[..n], p, &mut self.at)?;
        let (amplitude, slope) = self.problem.observe(&v[..n], &tangent);
        Ok(Point {
            v,
            tangent,
            amplitude,
            slope,
            residual: norm(&self.at.residual) / self.at.scale,
            iterations: 0,
            step: 0.0,
            stalled: false,
            positive: true,
        })
    }

    /// Evaluates the problem at a point, and what is stored of it.
    fn measure(&mut self, point: &Point) -> Result<ModePoint> {
        let n = point.unknowns().len();
        let (u, p) = (point.unknowns(), point.parameter());
        self.problem.evaluate(u, p, &mut self.at)?;
        let (omega, damping_ratio) = Mode::frequency_and_damping(self.linear, u);
        let a = 10f64.powf(p);
        for (m, u) in self.motion.iter_mut().zip(u) {
            *m = a * u;
        }
        let dofs = self.condensed.ndof();
        let dof = self.branch.response_dof();
        let x = self.problem.shape();
        for (r, x) in self.response.iter_mut().zip(x.chunks_exact(dofs)) {
            *r = a * x[dof];
        }
        let m = self.condensed.set().packed_len();
        for (c, f) in self.forces.chunks_exact_mut(m).enumerate() {
            f.copy_from_slice(self.problem.forces().force(c));
        }
        let unit = a * self.condensed.length();
        let balance: Balance = energy::balance(self.condensed, omega, x, &self.forces, &u[..n - 2]);
        let i = self.fundamental();
        let first = &x[i * dofs..(i + 1) * dofs];
        self.condensed.blocks()[i].multiply_mass(first, &mut self.weighted);
        let size = product(first, &self.weighted).re;
        let assurance = if self.before.is_empty() {
            1.0
        } else {
            let overlap = product(&self.before, &self.weighted).norm_sqr();
            self.condensed.blocks()[i].multiply_mass(&self.before, &mut self.weighted);
            overlap / (size * product(&self.before, &self.weighted).re)
        };
        Ok(ModePoint {
            log10_amplitude: p,
            modal_amplitude: unit * size.sqrt(),
            damping_ratio,
            energy: balance.twice_mean_kinetic * unit * unit,
            fundamental_share: 0.5 * omega * omega * size / balance.twice_mean_kinetic,
            friction_loss: balance.friction_loss * unit * unit,
            structural_loss: balance.structural_loss * unit * unit,
            assurance,
        })
    }

    fn fundamental(&self) -> usize {
        let numbers = self.condensed.set().numbers();
        numbers.iter().position(|&h| h == 1).unwrap_or(0)
    }

    /// Numbers the special points after the curve.
    fn finish(mut self, status: Status) -> Result<Branch> {
        let fundamental = self.fundamental();
        for kept in &self.specials {
            let record = record(
                self.linear,
                &kept.point,
                &kept.motion,
                &kept.response,
                &kept.slip_fractions,
                kept.response[fundamental],
            );
            self.branch.push_special(kept.kind, &record)?;
            if let Some(data) = self.branch.mode_data_mut() {
                data.push(kept.mode)?;
            }
        }
        let stalled = status == Status::Ok && self.stalled;
        self.branch
            .set_status(if stalled { Status::StoppedStalled } else { status });
        Ok(self.branch)
    }
}

impl Keeper for Points<'_> {
    fn problem(&mut self) -> &mut dyn Problem {
        &mut self.problem
    }

    fn branch(&self) -> &Branch {
        &self.branch
    }

    fn keep(&mut self, point: &Point) -> Result<()> {
        let mode = self.measure(point)?;
        self.stalled |= point.stalled;
        if let Some(data) = self.branch.mode_data_mut() {
            data.push_state(&point.v, &point.tangent)?;
            data.push(mode)?;
        }
        let slip = self.problem.forces().slip_fractions();
        let i = self.fundamental();
        let amplitude = self.response[i];
        let record = record(self.linear, point, &self.motion, &self.response, slip, amplitude);
        self.branch.push_curve(&record)?;
        let dofs = self.condensed.ndof();
        self.before = try_copy(&self.problem.shape()[i * dofs..(i + 1) * dofs], WHAT)?;
        Ok(())
    }

    fn keep_special(&mut self, kind: SpecialKind, point: Point) -> Result<()> {
        let mode = self.measure(&point)?;
        let kept = Kept {
            kind,
            motion: try_copy(&self.motion, "the special points")?,
            response: try_copy(&self.response, "the special points")?,
            slip_fractions: try_copy(self.problem.forces().slip_fractions(), "the special points")?,
            mode,
            point,
        };
        try_push(&mut self.specials, kept, "the special points")
    }
}

fn record<'a>(
    linear: &LinearMode,
    point: &'a Point,
    motion: &'a [f64],
    response: &'a [Complex64],
    slip_fractions: &'a [f64],
    amplitude: Complex64,
) -> Record<'a> {
    Record {
        omega: Mode::frequency_and_damping(linear, point.unknowns()).0,
        motion,
        amplitude,
        response,
        residual: point.residual,
        iterations: point.iterations,
        slip_fractions,
    }
}

/// aᴴ b
fn product(a: &[Complex64], b: &[Complex64]) -> Complex64 {
    a.iter().zip(b).map(|(a, b)| a.conj() * b).sum()
}
