//! Undamped natural modes of the structure with its contacts removed or stuck: with Ω²K₁ and gyroscopic forces at a
//! fixed speed, with those of the own frequency where the speed is tied to that. Aerodynamic forces are left out, and so is
//! the loss of a complex symmetric stiffness.

use crate::contact::Role;
use crate::error::{Result, Status, check_memory, fail, try_extend, try_push, try_vec};
use crate::interrupt::{Interrupt, Phase};
use crate::linalg::dense::eigen::{self, Pairs};
use crate::linalg::exact_sums::quadratic::{QUADRATIC_ROUNDING, form, quadratic, terms};
use crate::linalg::iterative::lanczos;
use crate::linalg::iterative::refined_modes::dense;
use crate::linalg::sparse_storage::definite::resists_all_motion;
use crate::linalg::sparse_storage::held_rows::MovingRows;
use crate::linalg::sparse_storage::sparse::Csc;
use crate::model::Model;
use crate::model::matrices::structure::MatrixKind;
use crate::model::matrices::wave::Wave;
use crate::model::natural_modes::all_undamped::{EIGEN_COPIES, all_undamped};
use crate::model::natural_modes::quadratic_problem::Quadratic;
use crate::model::natural_modes::static_tangents::StaticTangents;
use num_complex::Complex64;
use std::borrow::Cow;

/// State of the contacts in a linear analysis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ContactState<'a> {
    /// Contacts without force.
    Free,
    /// Contacts as linear springs with their stiffness at small motion.
    Stuck,
    /// Contacts as linear springs with their tangent stiffness at a static motion.
    #[doc(hidden)]
    AboutStatic(&'a StaticTangents),
}

/// Natural modes in ascending order of frequency.
#[derive(Clone, Debug)]
pub struct LinearModes {
    /// Natural angular frequencies; near zero for rigid-body modes. For a motion that grows, minus its rate of
    /// growth: −√(−λ) for an eigenvalue λ = ω² below zero, where the stiffness is negative.
    pub omega: Vec<f64>,
    /// Mass-normalised shapes (φᴴ M φ = 1 over one sector), one after the other, `ndof` numbers each.
    pub shapes: Vec<Complex64>,
}

/// Degrees of freedom up to which all modes are found by dense algebra. Its rounding is relative to the highest
/// frequency, which on finer meshes is too inaccurate for the lowest frequencies.
/// Kind: tuned; measured on: not recorded.
pub(crate) const ALL_MODES_UP_TO: usize = 100;

/// Degrees of freedom for each mode that is requested, below which dense algebra is used as well.
/// Kind: tuned; measured on: not recorded.
const FEW_FOR_EACH: usize = 4;

/// Rigid-body modes of a body in space.
/// Kind: fixed.
pub(crate) const RIGID_MODES: usize = 6;

/// Largest ω² of a rigid motion, relative to that of the stiffest degree of freedom alone.
/// Kind: rounding.
const RIGID: f64 = 1e-10;

/// 1/ω² relative to the largest, below which a motion has no inertia.
/// Kind: rounding.
const LINEAR_MODES_MASSLESS: f64 = 1e-13;

/// Real part of an eigenvalue, relative to its modulus, beyond which an undamped motion grows.
/// Kind: rounding.
const LINEAR_MODES_GROWS: f64 = 1e-6;

const CONTEXT: &str = "the natural modes";

/// K and M of a wave, checked to be Hermitian.
pub(crate) struct Pencil {
    pub stiffness: Csc,
    /// Matrix of the inertia, with the terms of a speed that is tied to the frequency.
    pub mass: Csc,
    /// Mass matrix M, where the inertia has more terms; else `None`.
    weight: Option<Csc>,
    /// Gyroscopic matrix ΩG at a fixed speed; `None` without.
    gyroscopic: Option<Csc>,
}

/// Computes modes as [`Model::lowest_modes`], and the caller may stop it.
pub(crate) fn lowest_modes_with(
    model: &Model,
    diameter: i64,
    contacts: ContactState<'_>,
    count: usize,
    interrupt: &Interrupt<'_>,
) -> Result<LinearModes> {
    model.check_matrices(true)?;
    if count == 0 {
        return fail!(Argument, "count = 0, needs at least 1");
    }
    interrupt.phase(Phase::Setup, 0.0)?;
    let (of, is_mirrored) = computed_sense(model, diameter)?;
    let pencil = model.pencil(Wave::Diameter(of), contacts)?;
    interrupt.phase(Phase::Modes, 0.0)?;
    expanded(model, pencil.lowest(count, interrupt)?.turned(is_mirrored), diameter)
}

/// All undamped natural modes of the signed nodal diameter `diameter`, modulo N (0 for a plain structure).
pub(crate) fn linear_modes(model: &Model, diameter: i64, contacts: ContactState<'_>) -> Result<LinearModes> {
    model.check_matrices(true)?;
    let (of, is_mirrored) = computed_sense(model, diameter)?;
    let modes = model.pencil(Wave::Diameter(of), contacts)?.all(&Interrupt::none())?;
    expanded(model, modes.turned(is_mirrored), diameter)
}

/// The nodal diameter whose modes are computed, and whether their conjugates are requested: both senses have the same
/// modes where nothing distinguishes them.
fn computed_sense(model: &Model, diameter: i64) -> Result<(i64, bool)> {
    let structure = model.structure();
    structure.check_diameter(diameter)?;
    let signed = structure.signed_diameter(diameter);
    if signed < 0 && model.has_equal_senses() {
        return Ok((-signed, true));
    }
    Ok((signed, false))
}

/// Natural frequencies of harmonic `h`, ascending, 0 for motions that grow.
pub(crate) fn natural_frequencies(
    model: &Model,
    h: usize,
    contacts: ContactState<'_>,
    interrupt: &Interrupt<'_>,
) -> Result<Option<Vec<f64>>> {
    let found = model
        .pencil(Wave::Harmonic(h), contacts)
        .and_then(|pencil| pencil.all(interrupt));
    match found {
        Ok(mut modes) => {
            for omega in &mut modes.omega {
                *omega = omega.max(0.0);
            }
            Ok(Some(modes.omega))
        }
        Err(e) if matches!(e.status, Status::OutOfMemory | Status::StoppedByCaller) => Err(e),
        Err(_) => Ok(None),
    }
}

/// The modes with their shapes on all degrees of freedom of the caller.
fn expanded(model: &Model, modes: LinearModes, diameter: i64) -> Result<LinearModes> {
    let degrees = model.structure().degrees();
    if degrees.is_identity() {
        return Ok(modes);
    }
    let next = model.structure().wave_phase(diameter, 1);
    let (n, given) = (degrees.independent(), degrees.given());
    let mut shapes = try_vec(modes.omega.len().saturating_mul(given), Complex64::ZERO, CONTEXT)?;
    for (all, shape) in shapes.chunks_exact_mut(given).zip(modes.shapes.chunks_exact(n)) {
        degrees.expand(next, shape, all);
    }
    Ok(LinearModes { shapes, ..modes })
}

/// Number of motions of a nodal diameter that neither structure nor springs resist.
pub(crate) fn rigid_modes(model: &Model, diameter: i64, interrupt: &Interrupt<'_>) -> Result<usize> {
    interrupt.check()?;
    let pencil = match model.pencil(Wave::Diameter(diameter), ContactState::Free) {
        Err(e) if e.status == Status::NotHermitian => return Ok(0),
        pencil => pencil?,
    };
    if resists_all_motion(&pencil.stiffness, interrupt)? {
        return Ok(0);
    }
    // The stiffest degree of freedom alone sets the scale.
    let (k, m) = (&pencil.stiffness, &pencil.mass);
    let own = |j| (k.get(j, j).re, m.get(j, j).re);
    let moving = MovingRows::of(k)?;
    let moves = |j: &usize| moving.as_ref().is_none_or(|moving| moving.contains(*j));
    let heavy = (0..k.rows).filter(moves).map(own).filter(|&(_, mass)| mass > 0.0);
    let stiffest = heavy.fold(0.0_f64, |most, (stiffness, mass)| most.max(stiffness / mass));
    let modes = pencil.lowest(RIGID_MODES, interrupt)?;
    let small = |omega: &&f64| **omega < 0.0 || **omega * **omega <= RIGID * stiffest;
    Ok(modes.omega.iter().take_while(small).count())
}

/// K of a wave with the springs, and with the contacts removed or stuck.
#[doc(hidden)]
pub(crate) fn stiffness_at_small_motion(model: &Model, wave: Wave, contacts: ContactState<'_>) -> Result<Csc> {
    let acting = model
        .contacts()
        .iter()
        .enumerate()
        .filter(|(_, c)| c.role() != Role::Inert);
    match contacts {
        ContactState::Free => model.sprung_stiffness(wave, core::iter::empty()),
        ContactState::Stuck => model.sprung_stiffness(wave, acting.map(|(_, c)| c)),
        ContactState::AboutStatic(tangents) => {
            let stiffness = |id: usize, k, l| {
                let known = tangents.stiffness(id, k, l);
                known.unwrap_or_else(|| model.contacts()[id].stiffness_at_small_motion(k, l))
            };
            model.stiffness_with(wave, acting, stiffness)
        }
    }
}

/// K and M of a wave, checked, without aerodynamic forces.
pub(crate) fn pencil(model: &Model, wave: Wave, contacts: ContactState<'_>) -> Result<Pencil> {
    if model.structure().has_aero_stiffness() {
        let mut in_vacuum = model.try_clone()?;
        *in_vacuum.structure_mut().aero_mut() = Default::default();
        return in_vacuum.pencil(wave, contacts);
    }
    if let Cow::Owned(separate) = model.with_separate_loss()? {
        return separate.pencil(wave, contacts);
    }
    let structure = model.structure();
    let mass = structure.of_wave(MatrixKind::Mass, wave)?;
    let stiffness = model.stiffness_at_small_motion(wave, contacts)?;
    for (name, a) in [("stiffness", &stiffness), ("mass", &mass)] {
        let (i, j, gap) = a.worst_hermitian_pair();
        if gap > 1e-10 * a.max_abs() {
            return fail!(
                NotHermitian,
                "natural modes need a Hermitian {name}, or a complex symmetric stiffness with loss, but {name}[{i},{j}] and its mirror \
                 differ by {gap:.3e}"
            );
        }
    }
    let (mass, weight) = match structure.tied_to_frequency(wave)? {
        Some(_) => (structure.inertia(wave)?, Some(mass)),
        None => (mass, None),
    };
    Ok(Pencil {
        stiffness,
        mass,
        weight,
        gyroscopic: structure.gyroscopic_at_speed(wave)?,
    })
}

/// Whether `count` modes of `n` degrees of freedom are computed by dense algebra, which finds all modes.
pub(crate) fn finds_all(n: usize, count: usize) -> bool {
    n <= ALL_MODES_UP_TO || count > n / FEW_FOR_EACH
}

impl Pencil {
    /// Mass matrix M, whatever else the inertia contains.
    pub fn weight(&self) -> &Csc {
        self.weight.as_ref().unwrap_or(&self.mass)
    }

    /// Removes gyroscopic forces.
    pub fn leave_out_gyroscopic(&mut self) {
        self.gyroscopic = None;
    }

    /// Whether `count` modes are computed by dense algebra, which finds all modes.
    pub fn finds_all(&self, count: usize) -> bool {
        finds_all(self.mass.rows, count)
    }

    /// The `count` lowest modes, or all if there are fewer.
    pub fn lowest(&self, count: usize, interrupt: &Interrupt<'_>) -> Result<LinearModes> {
        if let Some(moving) = MovingRows::of(&self.stiffness)? {
            let mut modes = self.reduced(&moving)?.lowest(count, interrupt)?;
            modes.shapes = moving.expanded(&modes.shapes)?;
            return Ok(modes);
        }
        if let Some(gyroscopic) = &self.gyroscopic {
            return self.gyroscopic_modes(gyroscopic, count, interrupt);
        }
        if self.finds_all(count) {
            let mut modes = self.all(interrupt)?;
            modes.omega.truncate(count);
            modes.shapes.truncate(modes.omega.len() * self.mass.rows);
            return Ok(modes);
        }
        let mut pairs = lanczos::lowest(&self.stiffness, &self.mass, count, interrupt)?;
        for (value, shape) in pairs.values.iter_mut().zip(pairs.vectors.column_iter()) {
            interrupt.check()?;
            *value = self.quotient(shape.as_slice());
        }
        if self.weight.is_some() {
            for mut shape in pairs.vectors.column_iter_mut() {
                shape /= Complex64::from(quadratic(self.weight(), shape.as_slice()).sqrt());
            }
        }
        self.modes(&pairs)
    }

    /// The pencil restricted to the rows that have stiffness or mass.
    fn reduced(&self, moving: &MovingRows) -> Result<Self> {
        let reduced = |a: &Option<Csc>| a.as_ref().map(|a| moving.reduced(a)).transpose();
        Ok(Self {
            stiffness: moving.reduced(&self.stiffness)?,
            mass: moving.reduced(&self.mass)?,
            weight: reduced(&self.weight)?,
            gyroscopic: reduced(&self.gyroscopic)?,
        })
    }

    /// Modes from eigenpairs; an eigenvalue below zero beyond rounding belongs to a motion that grows.
    fn modes(&self, pairs: &Pairs) -> Result<LinearModes> {
        let mut ranked = Vec::new();
        for (k, (&value, shape)) in pairs.values.iter().zip(pairs.vectors.column_iter()).enumerate() {
            let omega = if value < 0.0 {
                -self.growth(shape.as_slice())
            } else {
                value.sqrt()
            };
            try_push(&mut ranked, (omega, k), CONTEXT)?;
        }
        // Quotients of several rigid motions have the order of their rounding.
        ranked.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut modes = LinearModes {
            omega: Vec::new(),
            shapes: Vec::new(),
        };
        for (omega, k) in ranked {
            try_push(&mut modes.omega, omega, CONTEXT)?;
            try_extend(&mut modes.shapes, pairs.vectors.column(k).as_slice(), CONTEXT)?;
        }
        Ok(modes)
    }

    /// Rate √(−φᴴKφ / φᴴMφ) at which a motion of negative stiffness grows; 0 where this is rounding.
    fn growth(&self, shape: &[Complex64]) -> f64 {
        let energy = quadratic(&self.stiffness, shape);
        if energy >= -QUADRATIC_ROUNDING * terms(&self.stiffness, shape) {
            return 0.0;
        }
        (-energy / quadratic(&self.mass, shape)).sqrt()
    }

    /// All modes, by dense algebra.
    fn all(&self, interrupt: &Interrupt<'_>) -> Result<LinearModes> {
        if let Some(moving) = MovingRows::of(&self.stiffness)? {
            let mut modes = self.reduced(&moving)?.all(interrupt)?;
            modes.shapes = moving.expanded(&modes.shapes)?;
            return Ok(modes);
        }
        let n = self.mass.rows;
        if let Some(gyroscopic) = &self.gyroscopic {
            return self.gyroscopic_modes(gyroscopic, n, interrupt);
        }
        let Some(weight) = &self.weight else {
            return self.modes(&all_undamped(&self.stiffness, &self.mass, interrupt)?);
        };
        // The eigensolver allocates through nalgebra, which aborts the process when memory is exhausted.
        check_memory::<Complex64>(n.saturating_mul(n).saturating_mul(EIGEN_COPIES), CONTEXT)?;
        let whole = |a: &Csc| dense(a, &a.values);
        // At a speed tied to the frequency the inertia may be negative: such a motion has no frequency. The pencil is
        // turned round, M φ = φ/ω² K, where K is positive definite.
        let pairs = match eigen::generalised(&whole(&self.mass)?, &whole(&self.stiffness)?, interrupt) {
            Err(e) if e.status == Status::NotPositiveDefinite => {
                return fail!(
                    NotPositiveDefinite,
                    "the stiffness is negative in some direction: at a speed that is tied to the frequency, natural modes need a \
                     positive one"
                );
            }
            pairs => pairs?,
        };
        let mut modes = LinearModes {
            omega: Vec::new(),
            shapes: Vec::new(),
        };
        let largest = pairs.values.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        for (value, shape) in pairs.values.iter().zip(pairs.vectors.column_iter()).rev() {
            if *value <= LINEAR_MODES_MASSLESS * largest {
                continue;
            }
            let norm = quadratic(weight, shape.as_slice()).sqrt();
            try_push(&mut modes.omega, value.sqrt().recip(), CONTEXT)?;
            for z in shape.iter() {
                try_push(&mut modes.shapes, z / norm, CONTEXT)?;
            }
        }
        Ok(modes)
    }

    /// Modes with gyroscopic forces: (K + iωΩG − ω²M) φ = 0.
    fn gyroscopic_modes(&self, gyroscopic: &Csc, count: usize, interrupt: &Interrupt<'_>) -> Result<LinearModes> {
        let problem = Quadratic {
            mass: &self.mass,
            damping: gyroscopic,
            stiffness: &self.stiffness,
            modal: &[],
        };
        let mut modes = LinearModes {
            omega: Vec::new(),
            shapes: Vec::new(),
        };
        let mut found = problem.lowest(count, interrupt)?;
        let signed = |z: &Complex64| {
            if z.re > LINEAR_MODES_GROWS * z.norm() {
                -z.re
            } else {
                z.im
            }
        };
        found.sort_by(|a, b| signed(&a.0).total_cmp(&signed(&b.0)));
        for (eigenvalue, shape) in found {
            try_push(&mut modes.omega, signed(&eigenvalue), CONTEXT)?;
            try_extend(&mut modes.shapes, &shape, CONTEXT)?;
        }
        Ok(modes)
    }

    /// Rayleigh quotient φᴴKφ / φᴴMφ. It is stationary at the eigenvector, and therefore far more accurate than the
    /// vector; only with it can a rigid motion of a stiff structure be distinguished from a slow one.
    pub fn quotient(&self, shape: &[Complex64]) -> f64 {
        let (k, m) = (quadratic(&self.stiffness, shape), quadratic(&self.mass, shape));
        let Some(gyroscopic) = &self.gyroscopic else {
            return k / m;
        };
        // k + ωg − ω²m = 0 with g = φᴴ iΩG φ
        let g = -form(gyroscopic, &gyroscopic.values, shape).im;
        ((g + (g * g + 4.0 * m * k).sqrt()) / (2.0 * m)).powi(2)
    }
}

impl LinearModes {
    /// The modes, with conjugate shapes if `conjugated`.
    fn turned(mut self, conjugated: bool) -> Self {
        if conjugated {
            for z in &mut self.shapes {
                *z = z.conj();
            }
        }
        self
    }
}
