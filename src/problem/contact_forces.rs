//! The contact forces of all relative coordinates at one packed motion, with their Jacobians, for every problem with
//! contacts.

mod coupling;
mod ranges;
pub(crate) mod single_matrix;

use crate::aft::{Evaluation, Evaluator};
use crate::condense::{Condensed, LoadedLaw};
use crate::error::{Result, try_copy, try_push, try_vec};
use crate::fourier::HarmonicSet;
use crate::interrupt::Interrupt;
use crate::linalg::libraries::Arch;
use crate::linalg::norm;
use crate::problem::contact_jacobian::Blocks;
use crate::problem::static_state::StaticState;
use num_complex::Complex64;

/// Forces f of all laws, summed per relative coordinate, at the motion evaluated last.
pub struct ContactForces<'a> {
    arch: Arch,
    condensed: &'a Condensed,
    interrupt: &'a Interrupt<'a>,
    evaluator: Box<Evaluator>,
    /// A second evaluator of the laws with another number of samples, if some law is sampled.
    other: Option<Box<Evaluator>>,
    static_part: StaticPart,
    memory: ForceMemory,
    result: ForceResult,
    told: ContactStates,
}

/// Static motions and forces of contacts, and how much of them is there.
pub struct StaticPart {
    /// Scale factor s: every law f(y) is replaced by s·f(y/s).
    factor: f64,
    /// Factor σ on the motion: every law f(y) is replaced by f(σ y), whose stiffness is σ times as large.
    stiffening: f64,
    /// Static motion per coordinate, and packed static forces, from which motions and forces are counted; empty if
    /// these are zero.
    rest: Vec<f64>,
    rest_force: Vec<f64>,
    /// Tangent stiffness of the laws at the static motion, law after law and row-major.
    tangents: Vec<f64>,
    /// Weight α of the laws in α f + (1 − α) T y, where T are their tangents; `None`: the laws alone.
    share: Option<f64>,
}

/// Memory of an evaluation.
pub struct ForceMemory {
    /// Scaled motions y/s of all coordinates; and the motions of one law.
    scaled: Vec<f64>,
    gathered: Vec<f64>,
    /// Force of one law, for the check of its samples.
    checked: Vec<f64>,
    /// Per number of directions (1, 2, …), memory for the evaluation of a law, where such laws exist.
    found: Vec<Option<Evaluation>>,
}

/// Forces of the point evaluated last, and their derivatives.
pub struct ForceResult {
    /// Packed forces summed per coordinate.
    force: Vec<f64>,
    offset: Vec<f64>,
    by_omega: Vec<f64>,
    jacobians: Blocks,
}

/// States of contacts at the point evaluated last.
pub struct ContactStates {
    /// Whether all laws stick.
    all_stuck: bool,
    /// Whether the forces of all laws are affine functions of the motion.
    all_linear: bool,
    /// Per coordinate, whether all its laws stick or, along their normal, are closed, so that ∂f/∂y is their constant
    /// stiffness.
    linear: Vec<bool>,
    /// Per coordinate, whether all its laws stick and none acts along its normal, where a static load may act.
    inactive: Vec<bool>,
    slip_fractions: Vec<f64>,
    open_fractions: Vec<f64>,
    /// Per law, whether it presses at the static motion.
    presses: Vec<bool>,
    /// Per coordinate, the rounding error of the force of near-rigid contacts.
    rounding: Vec<f64>,
}

impl<'a> ContactForces<'a> {
    /// The laws of a condensed model; `samples` = 0 locates events exactly where the law has them.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(condensed: &'a Condensed, samples: usize, interrupt: &'a Interrupt<'a>) -> Result<Self> {
        let mut forces = Self::unchecked(condensed, samples, interrupt)?;
        let laws = || condensed.laws().iter().map(|assembled| &*assembled.law);
        if laws().any(|law| forces.evaluator.samples(law)) {
            forces.other = Some(Box::new(Evaluator::otherwise(
                condensed.set(),
                (samples, condensed.refinement()),
                laws(),
            )?));
        }
        Ok(forces)
    }

    /// The laws of a condensed model as `new` makes them, without memory for [`Self::sampling_error`].
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn unchecked(condensed: &'a Condensed, samples: usize, interrupt: &'a Interrupt<'a>) -> Result<Self> {
        Self::with(condensed, samples, false, interrupt)
    }

    /// The laws as [`Self::unchecked`] makes them, for forces without Jacobians, which saves most of an evaluation
    /// with many harmonics.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn forces_alone(condensed: &'a Condensed, samples: usize, interrupt: &'a Interrupt<'a>) -> Result<Self> {
        Self::with(condensed, samples, true, interrupt)
    }

    fn with(condensed: &'a Condensed, samples: usize, alone: bool, interrupt: &'a Interrupt<'a>) -> Result<Self> {
        const CONTEXT: &str = "the contact forces";
        // A linear problem has no contact to evaluate, and its harmonics need not be equidistant.
        let linear = condensed.coordinates() == 0;
        let set = if linear { &HarmonicSet::all(0)? } else { condensed.set() };
        let m = set.packed_len();
        let size = condensed.coordinates().saturating_mul(m);
        let laws = || condensed.laws().iter().map(|assembled| &*assembled.law);
        let most = laws().map(crate::contact::Law::directions).max().unwrap_or(0);
        let mut found = Vec::new();
        for d in 1..=most {
            let used = laws().any(|law| law.directions() == d);
            let memory = match (used, alone) {
                (false, _) => None,
                (_, false) => Some(Evaluation::new(set, d)?),
                (_, true) => Some(Evaluation::force_alone(set, d)?),
            };
            try_push(&mut found, memory, CONTEXT)?;
        }
        let samples = if linear { 0 } else { samples };
        let sampling = (samples, condensed.refinement());
        let evaluator = Box::new(if alone {
            Evaluator::force_alone(set, sampling, laws())?
        } else {
            Evaluator::refined(set, sampling, laws())?
        });
        Ok(Self {
            arch: Arch::new(),
            condensed,
            interrupt,
            evaluator,
            other: None,
            static_part: StaticPart {
                factor: 1.0,
                stiffening: 1.0,
                rest: Vec::new(),
                rest_force: Vec::new(),
                tangents: Vec::new(),
                share: None,
            },
            memory: ForceMemory {
                scaled: try_vec(size, 0.0, CONTEXT)?,
                gathered: try_vec(most.saturating_mul(m), 0.0, CONTEXT)?,
                checked: try_vec(most.saturating_mul(m), 0.0, CONTEXT)?,
                found,
            },
            result: ForceResult {
                force: try_vec(size, 0.0, CONTEXT)?,
                offset: try_vec(size, 0.0, CONTEXT)?,
                by_omega: try_vec(size, 0.0, CONTEXT)?,
                jacobians: Blocks::new(condensed, if alone { 0 } else { m })?,
            },
            told: ContactStates {
                all_stuck: false,
                all_linear: false,
                linear: try_vec(condensed.coordinates(), false, CONTEXT)?,
                inactive: try_vec(condensed.coordinates(), false, CONTEXT)?,
                slip_fractions: try_vec(condensed.laws().len(), 0.0, CONTEXT)?,
                open_fractions: try_vec(condensed.laws().len(), 0.0, CONTEXT)?,
                presses: Vec::new(),
                rounding: try_vec(condensed.coordinates(), 0.0, CONTEXT)?,
            },
        })
    }

    /// The interrupt of the call.
    #[must_use]
    #[inline]
    pub fn interrupt(&self) -> &'a Interrupt<'a> {
        self.interrupt
    }

    /// Scales every law f to s·f(y/s): its force at a motion reduced by `factor` = s. A large factor selects the laws
    /// linearised at small motion (infinite: exactly linear springs); 1 selects the laws themselves; between them
    /// runs the homotopy that finds a first point.
    pub fn set_scale(&mut self, factor: f64) {
        self.static_part.factor = factor;
    }

    /// Makes the stiffness of all laws `factor` times as large, at the loads and slip limits that they have.
    pub fn set_stiffening(&mut self, factor: f64) {
        self.static_part.stiffening = factor;
    }

    /// Counts motions and forces from a static state, in the unit of the condensed model, whose laws are evaluated at
    /// `omega`: a law f becomes s·(f(y₀ + y/s) − f(y₀)).
    ///
    /// # Errors
    /// `OutOfMemory`; those of callbacks; `StoppedByCaller`.
    pub fn set_rest(&mut self, state: &StaticState, omega: f64) -> Result<()> {
        const CONTEXT: &str = "the static state";
        let still = try_vec(self.result.force.len(), 0.0, CONTEXT)?;
        self.static_part.rest_force = try_vec(self.result.force.len(), 0.0, CONTEXT)?;
        self.static_part.rest = try_copy(&state.motion, CONTEXT)?;
        for assembled in self.condensed.laws() {
            let d = assembled.law.directions();
            for k in 0..d * d {
                let stiffness = state.tangents.stiffness(assembled.contact, k / d, k % d);
                try_push(&mut self.static_part.tangents, stiffness.unwrap_or(0.0), CONTEXT)?;
            }
        }
        self.set_scale(1.0);
        self.evaluate(&still, omega)?;
        self.static_part.rest_force.copy_from_slice(&self.result.force);
        for open in &self.told.open_fractions {
            try_push(&mut self.told.presses, *open == 0.0, CONTEXT)?;
        }
        Ok(())
    }

    /// Replaces all laws f by α f + (1 − α) T y with their tangents T at the static motion, `share` = α; `None`: the
    /// laws themselves. [`Self::d_ln_scale`] is then the derivative by α.
    pub fn set_share(&mut self, share: Option<f64>) {
        self.static_part.share = share;
    }

    /// Evaluates all laws at packed motions, coordinate after coordinate, and an angular frequency.
    ///
    /// # Errors
    /// Those of callbacks; `StoppedByCaller`.
    pub fn evaluate(&mut self, motion: &[f64], omega: f64) -> Result<()> {
        let set = self.condensed.set();
        let m = set.packed_len();
        for sum in [
            &mut self.result.force,
            &mut self.result.offset,
            &mut self.result.by_omega,
        ] {
            sum.fill(0.0);
        }
        self.result.jacobians.clear();
        self.told.all_stuck = true;
        self.told.all_linear = true;
        self.told.linear.fill(true);
        self.told.inactive.fill(true);
        self.told.rounding.fill(0.0);
        let s = self.static_part.factor;
        // Forces that scale with the motion; at rest they follow from the Jacobians.
        let unit = if s.is_infinite() { 0.0 } else { s };
        let reduced = s / self.static_part.stiffening;
        for (scaled, y) in self.memory.scaled.iter_mut().zip(motion) {
            *scaled = y / reduced;
        }
        for (scaled, rest) in self.memory.scaled.iter_mut().step_by(m).zip(&self.static_part.rest) {
            *scaled += rest;
        }
        let mut blocks = 0;
        let mut prepared = usize::MAX;
        for (k, assembled) in self.condensed.laws().iter().enumerate() {
            self.interrupt.check()?;
            let at = &assembled.coordinates;
            self.interrupt.count((at.len() * m).pow(2) as u64);
            let Some(found) = self.memory.found.get_mut(at.len() - 1).and_then(Option::as_mut) else {
                continue;
            };
            let here = assembled.at(omega);
            let y = gather_scaled(at, m, here.of_motion, &self.memory.scaled, &mut self.memory.gathered);
            if at.len() == 1 && (prepared != at[0] || here.of_motion.is_some()) {
                self.evaluator.prepare(set, y, self.interrupt)?;
                prepared = if here.of_motion.is_none() { at[0] } else { usize::MAX };
            }
            self.evaluator
                .evaluate(here.law, set, y, omega, found, self.interrupt)
                .map_err(|e| e.at(format_args!("contact {}", assembled.contact)))?;
            if !here.is_plain {
                apply_load(&here, found);
            }
            self.told.slip_fractions[k] = found.slip_fraction;
            self.told.open_fractions[k] = found.open_fraction;
            blocks = self.result.jacobians.add(blocks, at.len(), &mut found.jacobian);
            self.told.all_stuck &= found.stuck;
            let closed = 1.0 - found.open_fraction;
            let stuck = (closed - found.slip_fraction).max(0.0);
            // Slip under a load that varies has the rounding of the load.
            let lost = |c: usize| match self.condensed.rounding(c) {
                0.0 => 0.0,
                rounding => rounding * norm(&motion[c * m..(c + 1) * m]),
            };
            let of_load = match assembled.normal.and_then(|i| at.get(i)) {
                Some(&c) => closed * lost(c),
                None => 0.0,
            };
            self.told.all_linear &= found.linear;
            for (i, &c) in at.iter().enumerate() {
                let normal = assembled.normal == Some(i);
                let of_spring = stuck * lost(c);
                self.told.rounding[c] = self.told.rounding[c].max(of_spring + of_load);
                self.told.linear[c] &= if normal {
                    found.open_fraction == 0.0
                } else {
                    found.stuck
                };
                self.told.inactive[c] &= found.stuck && !normal;
                let (here, law) = (c * m..(c + 1) * m, i * m..(i + 1) * m);
                add(&mut self.result.force[here.clone()], &found.force[law.clone()], unit);
                add(&mut self.result.offset[here.clone()], &found.offset[law.clone()], unit);
                add(&mut self.result.by_omega[here], &found.by_omega[law], unit);
            }
        }
        self.stiffen();
        if !self.static_part.rest.is_empty() {
            self.count_from_rest(unit);
        }
        if let Some(share) = self.static_part.share {
            self.mix_with_tangents(share, motion);
        }
        if s.is_infinite() {
            self.linearise(motion);
        }
        Ok(())
    }

    /// Turns the derivatives by σ y, with the factor of [`Self::set_stiffening`], into those by y.
    fn stiffen(&mut self) {
        if self.static_part.stiffening.to_bits() == 1.0_f64.to_bits() {
            return;
        }
        self.result.jacobians.scale(self.static_part.stiffening);
        // No contact has its own stiffness.
        self.told.all_stuck = false;
        self.told.linear.fill(false);
        self.told.inactive.fill(false);
    }

    /// Subtracts the static forces. With F and J at Y, the derivative by ln s of s·(F − F₀) is s·(F − J Y) + s·(J Y₀
    /// − F₀).
    fn count_from_rest(&mut self, unit: f64) {
        let m = self.condensed.set().packed_len();
        for (c, rest) in self.static_part.rest.iter().enumerate() {
            let here = c * m..(c + 1) * m;
            let of_rest = &self.static_part.rest_force[here.clone()];
            add(&mut self.result.force[here.clone()], of_rest, -unit);
            add(&mut self.result.offset[here.clone()], of_rest, -unit);
            for (by, block) in self.result.jacobians.of_force(c) {
                add(
                    &mut self.result.offset[here.clone()],
                    &block[..m],
                    unit * self.static_part.rest[by],
                );
            }
            let size = norm(of_rest) + self.condensed.stiffness(c) * rest.abs();
            self.told.rounding[c] += f64::EPSILON * unit * size;
        }
    }

    fn mix_with_tangents(&mut self, share: f64, motion: &[f64]) {
        let m = self.condensed.set().packed_len();
        self.result.jacobians.scale(share);
        for x in &mut self.result.by_omega {
            *x *= share;
        }
        self.result.offset.copy_from_slice(&self.result.force);
        for x in &mut self.result.force {
            *x *= share;
        }
        let mut tangents = self.static_part.tangents.as_slice();
        let mut blocks = 0;
        for assembled in self.condensed.laws() {
            let at = &assembled.coordinates;
            let (own, others) = tangents.split_at(at.len() * at.len());
            tangents = others;
            blocks = self
                .result
                .jacobians
                .add_springs(blocks, at.len(), |k| (1.0 - share) * own[k]);
            for (k, &stiffness) in own.iter().enumerate() {
                let (force, by) = (at[k / at.len()], at[k % at.len()]);
                let (here, y) = (force * m..(force + 1) * m, &motion[by * m..(by + 1) * m]);
                add(&mut self.result.force[here.clone()], y, (1.0 - share) * stiffness);
                add(&mut self.result.offset[here], y, -stiffness);
            }
        }
    }

    /// Sets the forces of the laws linearised at small motion.
    fn linearise(&mut self, motion: &[f64]) {
        let m = self.condensed.set().packed_len();
        self.result.offset.fill(0.0);
        self.result.by_omega.fill(0.0);
        for (c, force) in self.result.force.chunks_exact_mut(m).enumerate() {
            force.fill(0.0);
            for (by, block) in self.result.jacobians.of_force(c) {
                for (column, y) in block.chunks_exact(m).zip(&motion[by * m..]) {
                    add(force, column, *y);
                }
            }
        }
    }

    /// Share of the period that each law slips.
    #[must_use]
    pub fn slip_fractions(&self) -> &[f64] {
        &self.told.slip_fractions
    }

    /// Least and largest share of the period in which a law slips or is open.
    #[must_use]
    pub fn free_shares(&self) -> (f64, f64) {
        let shares = self.told.slip_fractions.iter().zip(&self.told.open_fractions);
        shares.fold((1.0, 0.0), |(least, largest): (f64, f64), (slip, open)| {
            (least.min(slip + open), largest.max(slip + open))
        })
    }

    /// Share of the period that each law is open which presses at the static motion.
    pub fn lifted_shares(&self) -> impl Iterator<Item = f64> {
        let laws = self.told.open_fractions.iter().zip(&self.told.presses);
        laws.filter(|(_, presses)| **presses).map(|(open, _)| *open)
    }

    /// Whether every law sticks, or is open, at the motion evaluated last.
    #[must_use]
    pub fn all_stuck(&self) -> bool {
        self.told.all_stuck
    }

    /// Whether the force of every law is an affine function of the motion near the one evaluated last.
    #[must_use]
    pub fn all_linear(&self) -> bool {
        self.told.all_linear
    }

    /// w = f − κ y of a coordinate in the i-th carried harmonic.
    #[must_use]
    #[inline]
    pub fn minus_reference(&self, motion: &[f64], coordinate: usize, i: usize) -> Complex64 {
        let kappa = self.condensed.kappa(coordinate, i);
        self.part(&self.result.force, coordinate, i) - kappa * self.part(motion, coordinate, i)
    }

    /// Rounding of the force of a coordinate if its contacts are near-rigid, or if it counts from a static one,
    /// otherwise 0. In a stick phase the force is kt times a difference of motions that are known to their own
    /// rounding.
    #[must_use]
    #[inline]
    pub fn rounding(&self, coordinate: usize) -> f64 {
        self.told.rounding[coordinate]
    }

    /// Packed motions evaluated last, over the scale.
    #[must_use]
    pub fn motion(&self) -> &[f64] {
        &self.memory.scaled
    }

    /// Packed forces, coordinate after coordinate.
    #[must_use]
    #[inline]
    pub fn forces(&self) -> &[f64] {
        &self.result.force
    }

    /// ∂f/∂ln s of a coordinate in the i-th carried harmonic, where s is the factor of
    /// [`Self::set_scale`]: for any law with force F and Jacobian J it is s·(F − J Y) at Y = y/s.
    #[must_use]
    #[inline]
    pub fn d_ln_scale(&self, coordinate: usize, i: usize) -> Complex64 {
        self.part(&self.result.offset, coordinate, i)
    }

    /// ∂f/∂ln σ of a coordinate in the i-th carried harmonic, with the factor of [`Self::set_stiffening`]: J Y.
    #[must_use]
    pub fn d_ln_stiffening(&self, coordinate: usize, i: usize) -> Complex64 {
        self.part(&self.result.force, coordinate, i) - self.part(&self.result.offset, coordinate, i)
    }

    /// ∂f/∂ω, packed, coordinate after coordinate.
    #[must_use]
    #[inline]
    pub fn all_by_omega(&self) -> &[f64] {
        &self.result.by_omega
    }

    /// ∂f/∂ω of a coordinate in the i-th carried harmonic.
    #[must_use]
    #[inline]
    pub fn by_omega(&self, coordinate: usize, i: usize) -> Complex64 {
        self.part(&self.result.by_omega, coordinate, i)
    }

    #[inline]
    fn part(&self, packed: &[f64], coordinate: usize, i: usize) -> Complex64 {
        let set = self.condensed.set();
        set.get_at(packed, coordinate * set.packed_len(), i)
    }

    /// Whether all laws state the motion below which they are (nearly) linear.
    #[must_use]
    pub fn have_known_linear_range(&self) -> bool {
        let mut laws = self.condensed.laws().iter();
        laws.all(|assembled| assembled.law.has_known_linear_range())
    }
}

/// Copies the packed motions of one law, direction after direction.
fn gather<'m>(at: &[usize], m: usize, motion: &'m [f64], gathered: &'m mut [f64]) -> &'m [f64] {
    if let [c] = at[..] {
        return &motion[c * m..(c + 1) * m];
    }
    for (y, &c) in gathered.chunks_exact_mut(m).zip(at) {
        y.copy_from_slice(&motion[c * m..(c + 1) * m]);
    }
    &gathered[..at.len() * m]
}

/// Copies the packed motions of one law, divided by the factor by which motion scales with its load.
fn gather_scaled<'m>(
    at: &[usize],
    m: usize,
    factor: Option<f64>,
    motion: &'m [f64],
    gathered: &'m mut [f64],
) -> &'m [f64] {
    let Some(factor) = factor else {
        return gather(at, m, motion, gathered);
    };
    for (to, &c) in gathered.chunks_exact_mut(m).zip(at) {
        for (to, y) in to.iter_mut().zip(&motion[c * m..(c + 1) * m]) {
            *to = y / factor;
        }
    }
    &gathered[..at.len() * m]
}

/// Turns the evaluation of a law at its reference load into that at the load of the current frequency.
fn apply_load(here: &LoadedLaw<'_>, found: &mut Evaluation) {
    for (i, by_omega) in found.by_omega.iter_mut().enumerate() {
        // By the load, at a motion that does not change.
        let by_load = if here.of_motion.is_some() {
            found.offset[i]
        } else {
            found.force[i]
        };
        *by_omega = here.factor * *by_omega + here.slope * by_load;
    }
    for value in found.force.iter_mut().chain(&mut found.offset) {
        *value *= here.factor;
    }
    if here.of_motion.is_none() {
        for value in &mut found.jacobian {
            *value *= here.factor;
        }
    }
}

/// sum ← sum + factor·term, number by number.
fn add(sum: &mut [f64], term: &[f64], factor: f64) {
    for (s, t) in sum.iter_mut().zip(term) {
        *s += factor * t;
    }
}
