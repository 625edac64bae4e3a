//! The contact forces of all relative coordinates at one packed motion, with their Jacobians: what
//! every problem with contacts needs of the laws.

use super::blocks::Blocks;
use crate::aft::{Evaluation, Evaluator};
use crate::condense::Condensed;
use crate::contact::law::Range;
use crate::error::{Result, try_push, try_vec};
use crate::harmonics::HarmonicSet;
use num_complex::Complex64;

/// Added to the diagonal of the means in Newton's matrix, not in the residual. A slipping contact
/// does not resist a mean motion; where nothing else does, as for a ring free to turn, the mean is
/// indeterminate and the matrix singular. With the floor it stays where it started.
const MEAN_FLOOR: f64 = 1e-8;

/// Forces f of all laws, summed per relative coordinate, at the motion evaluated last.
pub struct ContactForces<'a> {
    condensed: &'a Condensed,
    evaluator: Evaluator,
    /// The same with other samples, where some law is sampled.
    other: Option<Evaluator>,
    /// s, where every law is seen as s·f(y/s).
    factor: f64,
    /// y/s of all coordinates, and of those of one law.
    scaled: Vec<f64>,
    gathered: Vec<f64>,
    /// Force of one law.
    checked: Vec<f64>,
    /// Memory for laws of 1, 2, … directions, where there are such.
    found: Vec<Option<Evaluation>>,
    /// Packed sums per coordinate.
    force: Vec<f64>,
    offset: Vec<f64>,
    by_omega: Vec<f64>,
    jacobians: Blocks,
    /// Whether all laws stick.
    all_stuck: bool,
    /// Per coordinate whether ∂f/∂y is that of laws which all stick, or along their normal are closed.
    linear: Vec<bool>,
    /// Per coordinate whether all its laws stick and none acts along its normal, where a load rests.
    silent: Vec<bool>,
    slip_fractions: Vec<f64>,
}

impl<'a> ContactForces<'a> {
    /// The laws of a condensed model; `samples` = 0 locates events exactly where the law has them.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(condensed: &'a Condensed, samples: usize) -> Result<Self> {
        let mut forces = Self::unchecked(condensed, samples)?;
        let laws = || condensed.laws().iter().map(|placed| &*placed.law);
        if laws().any(|law| forces.evaluator.samples(law)) {
            forces.other = Some(Evaluator::otherwise(condensed.set(), samples, laws())?);
        }
        Ok(forces)
    }

    /// The same without memory for [`Self::sampling_error`].
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn unchecked(condensed: &'a Condensed, samples: usize) -> Result<Self> {
        const WHAT: &str = "the contact forces";
        // A linear problem has no contact to evaluate, and its harmonics need not be a comb.
        let linear = condensed.coordinates() == 0;
        let set = if linear { &HarmonicSet::all(0)? } else { condensed.set() };
        let m = set.packed_len();
        let size = condensed.coordinates().saturating_mul(m);
        let laws = || condensed.laws().iter().map(|placed| &*placed.law);
        let most = laws().map(crate::contact::Law::directions).max().unwrap_or(0);
        let mut found = Vec::new();
        for d in 1..=most {
            let used = laws().any(|law| law.directions() == d);
            let memory = if used { Some(Evaluation::new(set, d)?) } else { None };
            try_push(&mut found, memory, WHAT)?;
        }
        let samples = if linear { 0 } else { samples };
        let evaluator = Evaluator::new(set, samples, laws())?;
        Ok(Self {
            condensed,
            evaluator,
            other: None,
            factor: 1.0,
            scaled: try_vec(size, 0.0, WHAT)?,
            gathered: try_vec(most.saturating_mul(m), 0.0, WHAT)?,
            checked: try_vec(most.saturating_mul(m), 0.0, WHAT)?,
            found,
            force: try_vec(size, 0.0, WHAT)?,
            offset: try_vec(size, 0.0, WHAT)?,
            by_omega: try_vec(size, 0.0, WHAT)?,
            jacobians: Blocks::new(condensed, m)?,
            all_stuck: false,
            linear: try_vec(condensed.coordinates(), false, WHAT)?,
            silent: try_vec(condensed.coordinates(), false, WHAT)?,
            slip_fractions: try_vec(condensed.laws().len(), 0.0, WHAT)?,
        })
    }

    /// Sees every law f at a motion `factor` times smaller, as s·f(y/s). A large factor gives the laws
    /// at rest, linear springs (infinite: exactly those); 1 gives the laws themselves; between them
    /// runs the homotopy that finds a first point.
    pub fn ease(&mut self, factor: f64) {
        self.factor = factor;
    }

    /// Evaluates all laws at packed motions, coordinate after coordinate, and an angular frequency.
    ///
    /// # Errors
    /// Those of callbacks.
    pub fn evaluate(&mut self, motion: &[f64], omega: f64) -> Result<()> {
        let set = self.condensed.set();
        let m = set.packed_len();
        for sum in [&mut self.force, &mut self.offset, &mut self.by_omega] {
            sum.fill(0.0);
        }
        self.jacobians.clear();
        self.all_stuck = true;
        self.linear.fill(true);
        self.silent.fill(true);
        let s = self.factor;
        // What scales with the motion; at rest it follows from the Jacobians.
        let unit = if s.is_infinite() { 0.0 } else { s };
        for (scaled, y) in self.scaled.iter_mut().zip(motion) {
            *scaled = y / s;
        }
        let mut blocks = 0;
        let mut prepared = usize::MAX;
        for (k, placed) in self.condensed.laws().iter().enumerate() {
            let at = &placed.coordinates;
            let Some(found) = self.found.get_mut(at.len() - 1).and_then(Option::as_mut) else {
                continue;
            };
            let y = gather(at, m, &self.scaled, &mut self.gathered);
            if at.len() == 1 && prepared != at[0] {
                self.evaluator.prepare(set, y);
                prepared = at[0];
            }
            self.evaluator
                .evaluate(&*placed.law, set, y, omega, found)
                .map_err(|e| e.at(format_args!("contact {}", placed.contact)))?;
            self.slip_fractions[k] = found.slip_fraction;
            blocks = self.jacobians.add(blocks, at.len(), &found.jacobian);
            self.all_stuck &= found.stuck;
            for (i, &c) in at.iter().enumerate() {
                let normal = placed.normal == Some(i);
                self.linear[c] &= if normal {
                    found.open_fraction == 0.0
                } else {
                    found.stuck
                };
                self.silent[c] &= found.stuck && !normal;
                let (here, law) = (c * m..(c + 1) * m, i * m..(i + 1) * m);
                add(&mut self.force[here.clone()], &found.force[law.clone()], unit);
                add(&mut self.offset[here.clone()], &found.offset[law.clone()], unit);
                add(&mut self.by_omega[here], &found.by_omega[law], unit);
            }
        }
        if s.is_infinite() {
            self.linearise(motion);
        }
        Ok(())
    }

    /// What sampling matters: ‖F_N − F_M‖/‖F_N‖ over the forces of all laws that are sampled, with M =
    /// N/2 (2N where N is too few to halve), at given motions and frequency. 0 where all laws are exact.
    /// It tells the size of the error and is no bound of it. NaN where a callback does not answer: a
    /// check ends no branch.
    pub fn sampling_error(&mut self, motion: &[f64], omega: f64) -> f64 {
        self.compare_samples(motion, omega).unwrap_or(f64::NAN)
    }

    fn compare_samples(&mut self, motion: &[f64], omega: f64) -> Result<f64> {
        let Some(other) = &mut self.other else { return Ok(0.0) };
        let set = self.condensed.set();
        let m = set.packed_len();
        let (mut difference, mut size) = (0.0, 0.0);
        for placed in self.condensed.laws() {
            let (law, at) = (&*placed.law, &placed.coordinates);
            if !self.evaluator.samples(law) {
                continue;
            }
            let Some(found) = self.found.get_mut(at.len() - 1).and_then(Option::as_mut) else {
                continue;
            };
            let y = gather(at, m, motion, &mut self.gathered);
            if at.len() == 1 {
                self.evaluator.prepare(set, y);
                other.prepare(set, y);
            }
            self.evaluator.evaluate(law, set, y, omega, found)?;
            let checked = &mut self.checked[..found.force.len()];
            checked.copy_from_slice(&found.force);
            other.evaluate(law, set, y, omega, found)?;
            for (a, b) in checked.iter().zip(&found.force) {
                difference += (a - b) * (a - b);
                size += a * a;
            }
        }
        Ok(if size == 0.0 { 0.0 } else { f64::sqrt(difference / size) })
    }

    /// The forces of the laws at rest, linear in the motion.
    fn linearise(&mut self, motion: &[f64]) {
        let m = self.condensed.set().packed_len();
        self.offset.fill(0.0);
        self.by_omega.fill(0.0);
        for (c, force) in self.force.chunks_exact_mut(m).enumerate() {
            force.fill(0.0);
            for (by, block) in self.jacobians.of_force(c) {
                for (column, y) in block.chunks_exact(m).zip(&motion[by * m..]) {
                    add(force, column, *y);
                }
            }
        }
    }

    /// Share of the period that each law slips.
    #[must_use]
    pub fn slip_fractions(&self) -> &[f64] {
        &self.slip_fractions
    }

    /// Whether every law is linear at the motion evaluated last.
    #[must_use]
    pub fn all_stuck(&self) -> bool {
        self.all_stuck
    }

    /// Whether a coordinate sticks, or along a normal is closed, and its reference stiffness is that of the
    /// contact: then ∂f/∂y = κ, and no change couples back.
    #[must_use]
    pub fn drops_out(&self, coordinate: usize) -> bool {
        self.linear[coordinate] && self.condensed.may_drop_out(coordinate)
    }

    /// Whether besides f = κ y, so that nothing at all couples back; a normal load at rest does.
    #[must_use]
    pub fn is_silent(&self, coordinate: usize) -> bool {
        self.silent[coordinate] && self.condensed.may_drop_out(coordinate)
    }

    /// Tells per unknown motion whether some force that does not drop out depends on it.
    pub fn mark_active(&self, active: &mut [bool]) {
        let m = self.condensed.set().packed_len();
        active.fill(false);
        for c in (0..self.condensed.coordinates()).filter(|&c| !self.drops_out(c)) {
            for (by, _) in self.jacobians.of_force(c) {
                active[by * m..(by + 1) * m].fill(true);
            }
        }
    }

    /// w = f − κ y of a coordinate in the i-th carried harmonic.
    #[must_use]
    pub fn minus_reference(&self, motion: &[f64], coordinate: usize, i: usize) -> Complex64 {
        let set = self.condensed.set();
        let m = set.packed_len();
        let y = set.get(&motion[coordinate * m..(coordinate + 1) * m], i);
        self.part(&self.force, coordinate, i) - self.condensed.kappa(coordinate, i) * y
    }

    /// Packed forces, coordinate after coordinate.
    #[must_use]
    pub fn forces(&self) -> &[f64] {
        &self.force
    }

    /// ∂f/∂ln s of a coordinate in the i-th carried harmonic, where s is the factor of
    /// [`Self::ease`]: for any law with force F and Jacobian J it is s·(F − J Y) at Y = y/s.
    #[must_use]
    pub fn by_ease(&self, coordinate: usize, i: usize) -> Complex64 {
        self.part(&self.offset, coordinate, i)
    }

    /// ∂f/∂ω of a coordinate in the i-th carried harmonic.
    #[must_use]
    pub fn by_omega(&self, coordinate: usize, i: usize) -> Complex64 {
        self.part(&self.by_omega, coordinate, i)
    }

    fn part(&self, packed: &[f64], coordinate: usize, i: usize) -> Complex64 {
        let set = self.condensed.set();
        let m = set.packed_len();
        set.get(&packed[coordinate * m..(coordinate + 1) * m], i)
    }

    /// Change of w in the i-th carried harmonic along a change of the motion.
    #[must_use]
    pub fn along(&self, direction: &[f64], coordinate: usize, i: usize) -> Complex64 {
        let set = self.condensed.set();
        let m = set.packed_len();
        let du = &direction[coordinate * m..(coordinate + 1) * m];
        let mut dw = -self.condensed.kappa(coordinate, i) * set.get(du, i);
        for (by, block) in self.jacobians.of_force(coordinate) {
            for (column, d) in block.chunks_exact(m).zip(&direction[by * m..]) {
                dw += set.get(column, i) * d;
            }
        }
        dw
    }

    /// Adds G (∂f/∂y − κ) in harmonic i to the column of a Jacobian that belongs to number `q` of the
    /// packed motion of coordinate `motion`. `flexibility` holds G of that harmonic, force after force at
    /// a distance of `stride`; `sum` has one number per coordinate.
    ///
    /// A column is written from top to bottom and the forces are summed before, because the Jacobian
    /// of many contacts is far larger than any cache.
    pub fn couple(
        &self,
        i: usize,
        (motion, q): (usize, usize),
        (flexibility, stride): (&[Complex64], usize),
        sum: &mut [Complex64],
        column: &mut [f64],
    ) {
        let set = self.condensed.set();
        let m = set.packed_len();
        let at = set.offset(i);
        let mean = set.numbers()[i] == 0;
        let mut any = false;
        for (force, block) in self.jacobians.of_motion(motion) {
            if self.drops_out(force) {
                continue;
            }
            let mut z = set.get(&block[q * m..(q + 1) * m], i);
            if force == motion && q == at {
                z -= self.condensed.kappa(force, i);
                if mean {
                    column[motion * m + at] += MEAN_FLOOR;
                }
            } else if force == motion && q == at + 1 && !mean {
                z -= self.condensed.kappa(force, i) * Complex64::I;
            }
            if z == Complex64::ZERO {
                continue;
            }
            if !any {
                sum.fill(Complex64::ZERO);
                any = true;
            }
            for (s, g) in sum.iter_mut().zip(&flexibility[force * stride..]) {
                *s += g * z;
            }
        }
        if !any {
            return;
        }
        if mean {
            for (x, s) in column[at..].iter_mut().step_by(m).zip(sum) {
                *x += s.re;
            }
        } else {
            for (x, s) in column[at..].chunks_mut(m).zip(sum) {
                x[0] += s.re;
                x[1] += s.im;
            }
        }
    }

    /// Adds Re(g·∂w/∂y) of the force of coordinate `force` in harmonic i to one row of a Jacobian with
    /// `n` rows.
    pub fn couple_scalar(&self, i: usize, (row, force): (usize, usize), g: Complex64, jacobian: &mut [f64], n: usize) {
        let set = self.condensed.set();
        let m = set.packed_len();
        for (by, block) in self.jacobians.of_force(force) {
            for (q, column) in block.chunks_exact(m).enumerate() {
                jacobian[(by * m + q) * n + row] += (g * set.get(column, i)).re;
            }
        }
        let gk = g * self.condensed.kappa(force, i);
        let at = force * m + set.offset(i);
        jacobian[at * n + row] -= gk.re;
        if set.numbers()[i] != 0 {
            jacobian[(at + 1) * n + row] += gk.im;
        }
    }

    /// Whether all laws know from which motion on they are (nearly) linear.
    #[must_use]
    pub fn know_their_linear_range(&self) -> bool {
        let mut laws = self.condensed.laws().iter();
        laws.all(|placed| placed.law.knows_its_linear_range())
    }

    /// The factor of [`Self::ease`] from which on the forces of the given motion are (nearly) linear.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn sticking_factor(&mut self, motion: &[f64], omega: f64) -> Result<f64> {
        let set = self.condensed.set();
        let m = set.packed_len();
        let mut ranges = Vec::new();
        for y in motion.chunks_exact(m.max(1)) {
            self.evaluator.prepare(set, y);
            let range = Range {
                half: self.evaluator.half_range(set),
                mean: if set.has_mean() { y[0] } else { 0.0 },
                speed: set.speed(y, omega),
            };
            try_push(&mut ranges, range, "the contacts")?;
        }
        let mut own = Vec::new();
        let mut largest = 0.0_f64;
        for placed in self.condensed.laws() {
            own.clear();
            let mut reference = f64::INFINITY;
            for &c in &placed.coordinates {
                try_push(&mut own, ranges[c], "the contacts")?;
                reference = reference.min(self.condensed.stiffness(c));
            }
            largest = largest.max(placed.law.sticking_factor(&own, reference));
        }
        Ok(largest)
    }
}

/// The packed motions of one law, direction after direction.
fn gather<'m>(at: &[usize], m: usize, motion: &'m [f64], gathered: &'m mut [f64]) -> &'m [f64] {
    if let [c] = at[..] {
        return &motion[c * m..(c + 1) * m];
    }
    for (y, &c) in gathered.chunks_exact_mut(m).zip(at) {
        y.copy_from_slice(&motion[c * m..(c + 1) * m]);
    }
    &gathered[..at.len() * m]
}

/// sum += factor·term
fn add(sum: &mut [f64], term: &[f64], factor: f64) {
    for (s, t) in sum.iter_mut().zip(term) {
        *s += factor * t;
    }
}
