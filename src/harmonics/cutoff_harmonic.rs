//! Cut-off harmonic: largest h with ‖kt^½ G_h kt^½‖ ≥ ½, where the structure is compliant against the contact
//! stiffness; G_h is the flexibility of the structure without its contacts. A contact whose force follows the velocity, as regularised
//! friction, has the stiffness hω ∂f/∂v.
//!
//! Beyond it inertia keeps both sides of a contact at rest, and an extended harmonic hardly acts back on itself or on
//! others. Above the highest natural frequency G falls with frequency, so that bisection brackets the cut-off; below,
//! the harmonics are checked one by one from above. On large structures, whose highest natural frequency depends on
//! the mesh, they are checked in geometric steps.

use crate::condense::Condensed;
use crate::condense::by_factors::flexibility::Workspace;
use crate::error::{Result, Status, try_vec};
use crate::harmonics::carried_harmonics::{block_of, carried_from, carried_to};
use crate::harmonics::estimate::CONTEXT;
use crate::harmonics::resonant_harmonics::{COMPLIANT, ResonantHarmonics, Sought};
use crate::interrupt::Interrupt;
use crate::linalg::dense::eigen;
use crate::linalg::factors::lu::Lu;
use crate::linalg::inner;
use crate::linalg::iterative::refined_modes::dense;
use num_complex::Complex64;
use std::sync::Arc;

/// Degrees of freedom up to which a factorisation costs about as much as a sum over modes, so that every harmonic may be checked, and levels
/// of harmonics need no modes.
/// Kind: tuned; measured on: not recorded.
pub(super) const SMALL_STRUCTURE: usize = 32;

/// Harmonics up to which a model carries all waves: those of a thousand sectors. The memory of a wheel of more sectors
/// than any machine has must not follow from their number.
/// Kind: cap.
const MOST_WAVES: usize = 2048;

/// Ratio of neighbouring harmonics that are checked in a large structure.
/// Kind: tuned; measured on: not recorded.
const CUTOFF_HARMONIC_RATIO: f64 = 1.25;

/// Relative distance within which the cut-off harmonic of a large structure is found.
/// Kind: tuned; measured on: not recorded.
const FINE: f64 = 0.03;

/// Relative change of frequency up to which a cut-off, as a frequency, is reused where harmonics are different waves.
/// Kind: tuned; measured on: not recorded.
const CUTOFF_HARMONIC_NEAR: f64 = 0.01;

/// Iterations for the norm of a matrix.
/// Kind: cap.
const NORM_ITERATIONS: usize = 8;

/// Highest harmonic up to which a model has at most this many unknowns.
pub(crate) fn affordable(condensed: &Condensed, unknowns: usize) -> usize {
    let set = condensed.set();
    let each = unknowns / condensed.coordinates().max(1);
    let pairs = each.saturating_sub(usize::from(set.has_mean())) / 2;
    set.base() * (1 + pairs.saturating_sub(1) * set.stride()) * usize::from(pairs > 0)
}

/// Number of harmonics that a condensed model must carry so that the waves of all higher harmonics are among its own.
pub(super) fn all_waves(condensed: &Condensed) -> usize {
    if condensed.ndof() > SMALL_STRUCTURE {
        return 0;
    }
    let all = 2 * condensed.in_step() * condensed.set().base();
    if all > MOST_WAVES { 0 } else { all }
}

/// Finds the cut-off harmonic of a model at one frequency after the other.
pub(super) struct CutoffHarmonic {
    condensed: Arc<Condensed>,
    workspace: Workspace,
    /// Highest natural frequency of the structure without its contacts, where it is known.
    highest: Option<f64>,
    /// Modes of a small structure, or those by which the flexibility of a larger one is a sum.
    resonant: ResonantHarmonics,
    /// Last cut-off found: as a frequency, the angular frequency of the point, and the harmonic from which the search
    /// began.
    found: Option<(f64, f64, usize)>,
    /// Last search that found the structure compliant up to its highest harmonic, with numbers as in `found`.
    beyond: Option<(f64, f64, usize)>,
    matrix: Vec<Complex64>,
    vectors: [Vec<Complex64>; 2],
    lu: Lu<Complex64>,
}

impl CutoffHarmonic {
    /// Memory for a condensed model; `solved` is that of a point, whose modes or poles serve it.
    pub fn new(condensed: Arc<Condensed>, solved: &Condensed, interrupt: &Interrupt<'_>) -> Result<Self> {
        let coordinates = condensed.coordinates();
        let mut resonant = ResonantHarmonics::default();
        let highest = highest_frequency(&condensed, &mut resonant, interrupt)?;
        if condensed.ndof() > SMALL_STRUCTURE {
            for (i, block) in condensed.blocks().iter().enumerate() {
                let source = block_of(solved, block.number).and_then(|i| solved.blocks()[i].source.as_ref());
                // Harmonics of one wave look at the modes of the first one.
                let is_first = block_of(&condensed, block.number) == Some(i);
                resonant.add_source(&condensed, block, source.filter(|_| is_first))?;
            }
        }
        Ok(Self {
            workspace: Workspace::new(&condensed, None)?,
            highest,
            resonant,
            vectors: [
                try_vec(coordinates, Complex64::ZERO, CONTEXT)?,
                try_vec(coordinates, Complex64::ZERO, CONTEXT)?,
            ],
            found: None,
            beyond: None,
            matrix: try_vec(coordinates.saturating_mul(coordinates), Complex64::ZERO, CONTEXT)?,
            lu: Lu::new(coordinates, coordinates)?,
            condensed,
        })
    }

    /// The cut-off harmonic of those `sought` where it follows from the last one found, without a search and its upper bound; else
    /// `None`. At each frequency other harmonics are resonant.
    pub fn known(&self, omega: f64, sought: Sought) -> Option<usize> {
        let found = self.found.filter(|found| self.serves(*found, omega, sought.from));
        found.map(|(frequency, ..)| {
            let from = ((frequency / omega).round() as usize).max(sought.from);
            self.resonant.last(&self.condensed, omega, Sought { from, ..sought })
        })
    }

    /// The last harmonic of those `sought` in which the structure is compliant, at the angular frequency ω; the first of them
    /// where it is compliant in none.
    pub fn at(&mut self, omega: f64, sought: Sought, interrupt: &Interrupt<'_>) -> Result<usize> {
        if let Some(known) = self.known(omega, sought) {
            return Ok(known.clamp(sought.from, sought.most.max(sought.from)));
        }
        let from = self.searched(omega, sought.from, sought.most, interrupt)?;
        Ok(self.resonant.last(&self.condensed, omega, Sought { from, ..sought }))
    }

    /// The last compliant harmonic but for single ones in which a mode resonates.
    fn searched(&mut self, omega: f64, from: usize, most: usize, interrupt: &Interrupt<'_>) -> Result<usize> {
        let reaches = |(frequency, ..): (f64, f64, usize)| most as f64 * omega <= (1.0 + FINE) * frequency;
        if self
            .beyond
            .is_some_and(|found| reaches(found) && self.serves(found, omega, from))
        {
            return Ok(most.max(from));
        }
        let last = match self.highest {
            Some(highest) => self.check_each(omega, highest, (from, most), interrupt)?,
            None => self.check_some(omega, from, most, interrupt)?,
        };
        let found = Some((last as f64 * omega, omega, from));
        if last < most {
            self.found = found;
        } else {
            self.beyond = found;
        }
        Ok(last)
    }

    /// Whether a cut-off found at one frequency is valid at another one.
    fn serves(&self, (_, near, searched_from): (f64, f64, usize), omega: f64, from: usize) -> bool {
        // Where all harmonics are one wave, G depends on hω alone.
        let one_wave = self.condensed.in_step() <= 1;
        let width = if self.highest.is_some() {
            CUTOFF_HARMONIC_NEAR
        } else {
            FINE
        };
        from >= searched_from && (one_wave || (omega / near - 1.0).abs() <= width)
    }

    fn check_each(
        &mut self,
        omega: f64,
        highest: f64,
        (from, most): (usize, usize),
        interrupt: &Interrupt<'_>,
    ) -> Result<usize> {
        let set = self.condensed.set();
        let step = set.base() * set.stride();
        let most = carried_to(set, most);
        let mut above = carried_from(set, ((highest / omega) as usize + 1).max(from + 1));
        let mut below = from;
        while above < most && self.compliant(omega, above, interrupt)? {
            (below, above) = (above, carried_from(self.condensed.set(), 2 * above));
        }
        above = above.min(most);
        if below > from {
            // The flexibility falls: the last compliant harmonic lies between.
            while above > below + step {
                let middle = carried_from(self.condensed.set(), below.midpoint(above));
                let middle = middle.min(above - step);
                if self.compliant(omega, middle, interrupt)? {
                    below = middle;
                } else {
                    above = middle;
                }
            }
            return Ok(above);
        }
        let mut h = above;
        while h > from {
            if self.compliant(omega, h, interrupt)? {
                return Ok(h);
            }
            if h <= step {
                break;
            }
            h -= step;
        }
        Ok(from)
    }

    fn check_some(&mut self, omega: f64, from: usize, most: usize, interrupt: &Interrupt<'_>) -> Result<usize> {
        let mut h = most;
        let mut above = most;
        while h > from {
            if self.compliant(omega, h, interrupt)? {
                // Nearer to the last one, but not to a single harmonic: each costs a factorisation.
                while above - h > 1 + (FINE * h as f64) as usize {
                    let middle = h.midpoint(above);
                    if self.compliant(omega, middle, interrupt)? {
                        h = middle;
                    } else {
                        above = middle;
                    }
                }
                return Ok(above);
            }
            above = h;
            h = ((h as f64 / CUTOFF_HARMONIC_RATIO) as usize).min(h - 1);
        }
        Ok(from)
    }

    /// Whether the structure is compliant in harmonic h: ‖kt^½ G kt^½‖ ≥ ½.
    fn compliant(&mut self, omega: f64, h: usize, interrupt: &Interrupt<'_>) -> Result<bool> {
        interrupt.check()?;
        let condensed = &self.condensed;
        let Some(i) = block_of(condensed, h) else {
            return Ok(false);
        };
        // The matrices of a wave are the same for all its harmonics.
        let effective = omega * h as f64 / condensed.set().numbers()[i] as f64;
        let n = condensed.coordinates();
        let nu = omega * h as f64;
        let table = &self
            .workspace
            .evaluate(condensed, i, effective, false, interrupt)?
            .value;
        // G = (1 − G_κ κ)⁻¹ G_κ, both sides times kt^½.
        let a = self.lu.matrix();
        for c in 0..n {
            let stiffness = condensed.impedance(c, nu);
            let root = stiffness.sqrt();
            for r in 0..n {
                let g = table[c * (n + 1) + r] * condensed.impedance(r, nu).sqrt() * root;
                self.matrix[c * n + r] = g;
                let share = condensed.kappa(c, i) / stiffness.max(f64::MIN_POSITIVE);
                a[c * n + r] = Complex64::from(f64::from(u8::from(c == r))) - g * share;
            }
        }
        // The matrix is singular at a resonance of the structure without contacts.
        match self.lu.factor(interrupt) {
            Err(e) if e.status == Status::Singular => return Ok(true),
            factored => factored?,
        }
        self.lu.solve_columns(&mut self.matrix, false, interrupt)?;
        Ok(spectral_norm(&self.matrix, &mut self.vectors) >= COMPLIANT)
    }
}

/// Largest singular value of a column-major matrix by the power method on AᴴA: a lower bound, nearly always exact to
/// a few per cent.
fn spectral_norm(a: &[Complex64], [x, y]: &mut [Vec<Complex64>; 2]) -> f64 {
    let size = |v: &[Complex64]| v.iter().fold(0.0, |s, z| f64::hypot(s, z.norm()));
    let frobenius = size(a);
    let n = x.len();
    if n <= 1 || frobenius == 0.0 {
        return frobenius;
    }
    for (k, x) in x.iter_mut().enumerate() {
        *x = Complex64::new(1.0 + (k as f64).sin(), (0.7 * k as f64).cos());
    }
    let mut largest = 0.0;
    for _ in 0..NORM_ITERATIONS {
        let length = size(x);
        y.fill(Complex64::ZERO);
        for (column, x) in a.chunks_exact(n).zip(&*x) {
            for (y, a) in y.iter_mut().zip(column) {
                *y += a * x / length;
            }
        }
        for (x, column) in x.iter_mut().zip(a.chunks_exact(n)) {
            *x = inner(column, y);
        }
        largest = size(x).sqrt();
    }
    largest
}

/// Highest natural frequency over the waves of a small structure without its contacts; `None` if it is not known.
/// The modes are added to `resonant`.
fn highest_frequency(
    condensed: &Condensed,
    resonant: &mut ResonantHarmonics,
    interrupt: &Interrupt<'_>,
) -> Result<Option<f64>> {
    let n = condensed.ndof();
    if n > SMALL_STRUCTURE {
        return Ok(None);
    }
    let mut highest = 0.0_f64;
    for block in condensed.blocks().iter().take(2 * condensed.in_step() + 1) {
        let pattern = &block.matrices.reference;
        let (k, m) = (
            dense(pattern, &block.matrices.stiffness)?,
            dense(pattern, &block.matrices.mass)?,
        );
        if (&k - k.adjoint()).norm() > 1e-9 * k.norm() {
            return Ok(None);
        }
        let pairs = match eigen::generalised(&k, &m, interrupt) {
            Err(e) if e.status == Status::StoppedByCaller => return Err(e),
            Err(_) => return Ok(None),
            Ok(pairs) => pairs,
        };
        highest = pairs.values.iter().fold(highest, |w, x| w.max(x.max(0.0).sqrt()));
        resonant.add_pairs(condensed, block, &pairs)?;
    }
    Ok(Some(highest))
}

#[cfg(test)]
mod tests {
    use super::{CutoffHarmonic, Sought, spectral_norm};
    use crate::condense::Condensed;
    use crate::contact::Contact;
    use crate::interrupt::Interrupt;
    use crate::linalg::sparse_storage::matrix_view::MatrixView;
    use crate::model::Model;
    use crate::model::matrices::structure::MatrixKind;
    use crate::options::SolverOptions;
    use num_complex::Complex64;
    use std::sync::Arc;

    #[test]
    fn the_norm_of_a_diagonal_matrix_is_its_largest_entry() {
        let values = [0.3, -1.7, 0.9];
        let a: Vec<Complex64> = (0..9)
            .map(|k| {
                if k % 4 == 0 {
                    Complex64::new(0.0, values[k / 4])
                } else {
                    Complex64::ZERO
                }
            })
            .collect();
        let memory = || vec![Complex64::ZERO; 3];
        assert!((spectral_norm(&a, &mut [memory(), memory()]) - 1.7).abs() < 1e-3);
    }

    /// |kt G| = kt/(m Ω² − k) = 1/2 beyond the resonance.
    #[test]
    fn a_mass_is_compliant_up_to_the_frequency_of_its_inertia() {
        for (mass, omega) in [(1.0, 0.5), (0.01, 0.7), (1e-4, 0.7)] {
            let (k, kt) = (1.0, 3.0);
            let mut model = Model::new(1).unwrap();
            for (kind, value) in [
                (MatrixKind::Mass, mass),
                (MatrixKind::Damping, 1e-9),
                (MatrixKind::Stiffness, k),
            ] {
                model.set_matrix(kind, &MatrixView::dense(1, &[value])).unwrap();
            }
            model.add_contact(&Contact::jenkins(0, None, kt, 0.5, 1.0)).unwrap();
            model.add_force(0, 1, 1.0.into()).unwrap();
            let condensed = Condensed::new(&model, &SolverOptions::default(), omega, &Interrupt::none()).unwrap();
            let condensed = Arc::new(condensed);
            let mut cutoff = CutoffHarmonic::new(Arc::clone(&condensed), &condensed, &Interrupt::none()).unwrap();
            let last = ((k + 2.0 * kt) / mass).sqrt() / omega;
            let found = {
                let sought = Sought {
                    own: 1,
                    from: 1,
                    most: 3001,
                };
                cutoff.at(omega, sought, &Interrupt::none())
            }
            .unwrap();
            assert!(
                found as f64 >= last - 2.0 && found as f64 <= last + 2.0,
                "{found} for {last}"
            );
            assert_eq!(found % 2, 1);
        }
    }
}
