//! Modes of one wave of the structure with its contacts stuck, by which the flexibility at any frequency is a sum.
//!
//! With M φ = μ K_κ φ, φᴴ K_κ φ = 1, and damping C = αM + βK and loss factor η of the structure alone,
//!
//! > Z_κ = (1 + c) K_κ − (ν² − iνα) M − c Bᴴ k B,  c = i(νβ + η),  ν = hω,
//!
//! where Bᴴ k B is the part of K_κ that belongs to no structure: springs, stuck contacts and κ. Without the last term
//! Z⁻¹ = Σ φ φᴴ/(1 + c − (ν² − iνα) μ); the term itself is of low rank, see [`crate::condense::modal_table`]. A complex κ
//! enters K_κ with its real part; its imaginary part adds to the low rank.

use crate::condense::{Artificial, Condensed, HarmonicBlock};
use crate::error::{Result, Status, try_extend, try_push};
use crate::interrupt::Interrupt;
use crate::linalg::eigen;
use crate::linalg::sparse::Csc;
use crate::model::Model;
use crate::model::reduced_wave::MotionRow;
use crate::model::spring_stiffness::Wave;
use nalgebra::DMatrix;
use num_complex::Complex64;
use std::sync::Arc;

/// Relative deviation of a damping matrix from αM + βK that is rounding.
const PROPORTIONAL: f64 = 1e-12;

/// Degrees of freedom up to which all modes are computed.
const MOST: usize = 600;

const CONTEXT: &str = "the modes of the structure";

/// The modes of one wave.
#[derive(Debug)]
pub struct WaveModes {
    /// K_κ and M, by which the wave is known again.
    reference: Csc,
    mass: Vec<Complex64>,
    /// μ
    pub(super) values: Vec<f64>,
    /// φ, column after column.
    pub(super) vectors: Vec<Complex64>,
    /// α and β
    pub(super) proportional: (f64, f64),
    /// η
    pub(super) loss_factor: f64,
    /// Rows of B beyond those of the relative coordinates, with their stiffness.
    pub(super) springs: Vec<(MotionRow, f64)>,
}

/// The waves met so far; `None` for one whose flexibility is no such sum.
#[derive(Default)]
pub struct WaveCache {
    waves: Vec<Arc<WaveModes>>,
    /// Whether a wave without such modes was met: there are no others then.
    refused: bool,
}

impl WaveCache {
    /// Number of waves with modes.
    #[cfg(test)]
    pub(super) fn count(&self) -> usize {
        self.waves.len()
    }

    /// Whether no wave has such modes.
    #[must_use]
    pub fn is_refused(&self) -> bool {
        self.refused
    }

    /// The modes of the i-th carried harmonic; `None` where the damping is not proportional, a
    /// structural matrix is given, the structure rotates or has an unbalance, it can move without the reference
    /// stiffness, or has too many degrees of freedom.
    ///
    /// # Errors
    /// `OutOfMemory`; `StoppedByCaller`.
    pub fn of(
        &mut self,
        model: &Model,
        condensed: &Condensed,
        i: usize,
        interrupt: &Interrupt<'_>,
    ) -> Result<Option<Arc<WaveModes>>> {
        let block = &condensed.blocks()[i];
        if self.refused || block.number == 0 {
            return Ok(None);
        }
        let reference = real_reference(condensed, i)?;
        let is_known = |known: &&Arc<WaveModes>| known.is_of(&reference, &block.mass);
        if let Some(known) = self.waves.iter().find(is_known) {
            return Ok(Some(Arc::clone(known)));
        }
        let Some(found) = WaveModes::new(model, condensed, (i, reference), interrupt)? else {
            self.refused = true;
            return Ok(None);
        };
        let found = Arc::new(found);
        try_push(&mut self.waves, Arc::clone(&found), CONTEXT)?;
        Ok(Some(found))
    }
}

impl WaveModes {
    fn new(
        model: &Model,
        condensed: &Condensed,
        (i, reference): (usize, Csc),
        interrupt: &Interrupt<'_>,
    ) -> Result<Option<Self>> {
        let block = &condensed.blocks()[i];
        let n = condensed.ndof();
        let other_terms = model.structure().has_structural_matrix()
            || model.structure().has_aero()
            || model.structure().is_rotating()
            || block.unbalance.is_some()
            || !matches!(block.artificial, Artificial::None);
        if n > MOST || other_terms {
            return Ok(None);
        }
        let own = block.own_stiffness(model)?;
        let Some(proportional) = proportional([&block.mass, &own, &block.damping]) else {
            return Ok(None);
        };
        let Some(springs) = springs(model, condensed, block)? else {
            return Ok(None);
        };
        interrupt.check()?;
        let pattern = &reference;
        let dense = |values: &[Complex64]| {
            let mut a = DMatrix::<Complex64>::zeros(n, n);
            for j in 0..n {
                for at in pattern.col_ptr[j]..pattern.col_ptr[j + 1] {
                    a[(pattern.row_idx[at], j)] = values[at];
                }
            }
            a
        };
        // The pencil turned round: the lowest modes, which matter most, are the most accurate.
        let stiffness = dense(&pattern.values);
        let pairs = match eigen::generalised(&dense(&block.mass), &stiffness, interrupt) {
            Ok(pairs) => pairs,
            Err(e) if matches!(e.status, Status::OutOfMemory | Status::StoppedByCaller) => return Err(e),
            Err(_) => return Ok(None),
        };
        if pairs.values.len() < n {
            return Ok(None);
        }
        let mut mass = Vec::new();
        try_extend(&mut mass, &block.mass, CONTEXT)?;
        let mut vectors = Vec::new();
        try_extend(&mut vectors, pairs.vectors.as_slice(), CONTEXT)?;
        Ok(Some(Self {
            reference,
            mass,
            values: pairs.values,
            vectors,
            proportional,
            loss_factor: model.structure().loss_factor(),
            springs,
        }))
    }

    /// Whether stiffness damps the wave, so that the part of K_κ that belongs to no structure counts.
    pub(super) fn is_damped_by_stiffness(&self) -> bool {
        self.proportional.1 != 0.0 || self.loss_factor != 0.0
    }

    /// Whether these are the modes of a wave with this K_κ and M.
    fn is_of(&self, reference: &Csc, mass: &[Complex64]) -> bool {
        self.reference.col_ptr == reference.col_ptr
            && self.reference.row_idx == reference.row_idx
            && self.reference.values == reference.values
            && self.mass == mass
    }
}

/// K_κ of the i-th carried harmonic without structural damping, with the real part of κ.
fn real_reference(condensed: &Condensed, i: usize) -> Result<Csc> {
    let block = &condensed.blocks()[i];
    let mut reference = block.reference.try_clone()?;
    reference.values.copy_from_slice(&block.stiffness);
    for (c, row) in block.rows.iter().enumerate() {
        let kappa = condensed.kappa(c, i).re;
        for &(q, b) in row.terms() {
            let column = reference.col_ptr[q]..reference.col_ptr[q + 1];
            for &(p, a) in row.terms() {
                let found = reference.row_idx[column.clone()].iter().position(|&row| row == p);
                if let Some(at) = found {
                    reference.values[column.start + at] += a.conj() * kappa * b;
                }
            }
        }
    }
    Ok(reference)
}

/// α and β of C = αM + βK, the matrices M, K and C on one pattern, by least squares; `None` where C is not of this form.
pub(super) fn proportional([m, k, c]: [&[Complex64]; 3]) -> Option<(f64, f64)> {
    let inner = |a: &[Complex64], b: &[Complex64]| a.iter().zip(b).map(|(a, b)| (a.conj() * b).re).sum::<f64>();
    let largest = |a: &[Complex64]| a.iter().fold(0.0_f64, |s, z| s.max(z.norm()));
    let (size_m, size_k, size_c) = (largest(m), largest(k), largest(c));
    if size_c == 0.0 {
        return Some((0.0, 0.0));
    }
    if size_m == 0.0 || size_k == 0.0 {
        return None;
    }
    // Stiffness alone is the usual form, and two nearly parallel matrices would lose digits.
    let candidates = [(0.0, inner(k, c) / inner(k, k)), (inner(m, c) / inner(m, m), 0.0), {
        let (mm, kk, mk) = (inner(m, m), inner(k, k), inner(m, k));
        let (mc, kc) = (inner(m, c), inner(k, c));
        let determinant = mm * kk - mk * mk;
        ((kk * mc - mk * kc) / determinant, (mm * kc - mk * mc) / determinant)
    }];
    candidates.into_iter().find(|&(alpha, beta)| {
        let off = |((m, k), c): ((&Complex64, &Complex64), &Complex64)| (c - alpha * m - beta * k).norm();
        m.iter().zip(k).zip(c).map(off).fold(0.0_f64, f64::max) <= PROPORTIONAL * size_c
    })
}

/// Rows of the linear springs and stuck contacts with their stiffness; `None` where one couples its directions.
fn springs(model: &Model, condensed: &Condensed, block: &HarmonicBlock) -> Result<Option<Vec<(MotionRow, f64)>>> {
    let (structure, number) = (model.structure(), block.number);
    let mut rows = Vec::new();
    for s in model.springs() {
        let row = block.row(&structure.row(&structure.spring_motion(s), Wave::Harmonic(number)))?;
        try_push(&mut rows, (row, s.stiffness), CONTEXT)?;
    }
    for &i in &condensed.contact_classes().never_slipping {
        let contact = &model.contacts()[i];
        for k in 0..contact.directions() {
            let couples = |&l: &usize| l != k && contact.stiffness_at_small_motion(k, l) != 0.0;
            if (0..contact.directions()).any(|l| couples(&l)) {
                return Ok(None);
            }
            let row = block.row(&structure.contact_row(contact, k, number))?;
            try_push(&mut rows, (row, contact.stiffness_at_small_motion(k, k)), CONTEXT)?;
        }
    }
    rows.retain(|(_, stiffness)| *stiffness != 0.0);
    Ok(Some(rows))
}
