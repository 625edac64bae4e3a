//! One harmonic of the condensed model: the matrices on one pattern, and the rows of the contacts.

use crate::condense::contact_classes::ContactClasses;
use crate::condense::wave_modes::WaveModes;
use crate::error::{Result, try_push, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::sparse::{Csc, Form};
use crate::model::Model;
use crate::model::reduced_wave::{MotionRow, ReducedView};
use crate::model::spring::Row;
use crate::model::spring_stiffness::Wave;
use crate::model::structure::MatrixKind;
use num_complex::Complex64;
use std::sync::Arc;

/// Matrix of the artificial damping of a nonlinear mode; see [`crate::condense::dynamic_stiffness`].
#[derive(Clone, Debug)]
pub enum Artificial {
    /// No artificial damping, as in a forced response.
    None,
    /// The mass matrix M of the harmonic.
    Mass,
    /// The stiffness matrix K of the structure itself, at the entries of the pattern.
    Stiffness(Vec<Complex64>),
}

/// Matrices, forces and contact rows of one harmonic.
#[derive(Clone, Debug)]
pub struct HarmonicBlock {
    /// Harmonic number h.
    pub number: usize,
    /// Motion of the next sector over that of this one.
    pub next: Complex64,
    /// K_h with springs, contacts that never slip, structural damping iD_h, and Wᴴ κ W; its pattern holds C and M too.
    pub reference: Csc,
    /// K_h with springs and contacts that never slip, without iD_h and Wᴴ κ W, at the entries of the pattern.
    pub stiffness: Vec<Complex64>,
    /// D_h of the structural damping iD_h, ηK_h included, at the entries of the pattern; `None` without such damping.
    pub structural: Option<Vec<Complex64>>,
    /// C_h at the entries of the pattern.
    pub damping: Vec<Complex64>,
    /// M_h at the entries of the pattern.
    pub mass: Vec<Complex64>,
    /// The artificial damping.
    pub artificial: Artificial,
    /// Modes of the wave along a sweep of a small structure, where the flexibility is a sum over them.
    pub modes: Option<Arc<WaveModes>>,
    /// F_h in units of the length scale.
    pub force: Vec<Complex64>,
    /// Amplitudes of the forces that grow with ω², over ω², likewise; `None` without such forces.
    pub unbalance: Option<Vec<Complex64>>,
    /// Terms of a speed that is tied to the frequency; `None` without.
    pub tied: Option<TiedValues>,
    /// Rows of W, one per relative coordinate.
    pub rows: Vec<MotionRow>,
    /// The same over the independent degrees of freedom.
    pub structural_rows: Vec<Row>,
    /// Rows of the relative motions of linear contacts, which are no coordinates.
    pub linear_rows: Vec<MotionRow>,
    /// On a basis, the linear springs: rows of force and motion over the independent degrees of freedom, stiffness.
    pub springs: Vec<(Row, Row, f64)>,
    /// The basis on which the matrices are; `None`: they are on the independent degrees of freedom.
    pub view: Option<ReducedView>,
}

/// p²K₁ and pG at the entries of the pattern, for Z_h = … + ω² p²K₁ + ihω² pG.
#[derive(Clone, Debug)]
pub struct TiedValues {
    /// p²K₁
    pub stiffness: Vec<Complex64>,
    /// pG
    pub gyroscopic: Vec<Complex64>,
}

impl HarmonicBlock {
    /// A row over the independent degrees of freedom as one over the coordinates.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn row(&self, row: &Row) -> Result<MotionRow> {
        match &self.view {
            Some(view) => view.row(row),
            None => MotionRow::new(row),
        }
    }

    /// K_h of the structure itself, without any spring, at the entries of the pattern.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn own_stiffness(&self, model: &Model) -> Result<Vec<Complex64>> {
        let Some(view) = &self.view else {
            let structure = model.structure().wave_matrix(MatrixKind::Stiffness, self.number)?;
            return structure.aligned(&self.reference);
        };
        let n = self.reference.rows;
        let mut own = try_vec(
            self.reference.values.len(),
            Complex64::ZERO,
            "the matrices per harmonic",
        )?;
        for k in 0..n {
            own[k * n + k] = view.pencil().stiffness(k).into();
        }
        Ok(own)
    }

    /// Whether a force acts at any frequency.
    #[must_use]
    pub fn has_force(&self) -> bool {
        let unbalance = self.unbalance.iter().flatten();
        self.force.iter().chain(unbalance).any(|f| *f != Complex64::ZERO)
    }

    /// F_h at an angular frequency.
    pub fn force_at(&self, omega: f64, force: &mut [Complex64]) {
        force.copy_from_slice(&self.force);
        for (f, u) in force.iter_mut().zip(self.unbalance.iter().flatten()) {
            *f += u * (omega * omega);
        }
    }

    /// y = M x
    pub fn multiply_mass(&self, x: &[Complex64], y: &mut [Complex64]) {
        y.fill(Complex64::ZERO);
        let pattern = &self.reference;
        for (j, x) in x.iter().enumerate() {
            for at in pattern.col_ptr[j]..pattern.col_ptr[j + 1] {
                y[pattern.row_idx[at]] += self.mass[at] * x;
            }
        }
    }
}

/// The block of harmonic `number`, with contacts that never slip as springs, one row for each of the (contact,
/// direction) pairs that represent the coordinates, and their reference stiffness. It has no force and no
/// artificial damping yet.
pub(super) fn harmonic_block(
    model: &Model,
    number: usize,
    (contact_classes, representatives): (&ContactClasses, &[(usize, usize)]),
    kappa: impl Fn(usize) -> Complex64,
    interrupt: &Interrupt<'_>,
) -> Result<HarmonicBlock> {
    let structure = model.structure();
    let n = structure.ndof();
    let stuck = contact_classes.never_slipping.iter().map(|&i| &model.contacts()[i]);
    let stiffness = model.sprung_stiffness(Wave::Harmonic(number), stuck)?;
    let rows_of = |contacts: &[(usize, usize)]| -> Result<Vec<Row>> {
        let mut rows = try_vec(contacts.len(), [None; 6], "the contacts")?;
        for (r, &(i, k)) in rows.iter_mut().zip(contacts) {
            *r = structure.contact_row(&model.contacts()[i], k, number);
        }
        Ok(rows)
    };
    let rows = rows_of(representatives)?;
    interrupt.check()?;
    let damping = structure.wave_matrix(MatrixKind::Damping, number)?;
    let structural = structure.wave_matrix(MatrixKind::Structural, number)?;
    interrupt.check()?;
    let mass = structure.wave_matrix(MatrixKind::Mass, number)?;
    let tied = structure.tied_to_frequency(Wave::Harmonic(number))?;
    let mut references = Vec::new();
    for (c, row) in rows.iter().enumerate() {
        for &(p, a) in row.iter().flatten() {
            for &(q, b) in row.iter().flatten() {
                try_push(&mut references, (p, q, a.conj() * kappa(c) * b), "the contacts")?;
            }
        }
    }
    let references = Csc::from_triplets(n, n, references)?;
    interrupt.check()?;
    // Zero factors add the pattern alone.
    let (one, zero) = (Complex64::ONE, Complex64::ZERO);
    let mut terms = Vec::with_capacity(7);
    terms.extend([
        (one, &stiffness, Form::Plain),
        (one, &references, Form::Plain),
        (Complex64::I, &structural, Form::Plain),
        (zero, &damping, Form::Plain),
        (zero, &mass, Form::Plain),
    ]);
    if let Some(tied) = &tied {
        terms.extend([
            (zero, &tied.stiffness, Form::Plain),
            (zero, &tied.gyroscopic, Form::Plain),
        ]);
    }
    let reference = Csc::sum(n, &terms)?;
    interrupt.check()?;
    Ok(HarmonicBlock {
        number,
        next: structure.phase(number, 1),
        damping: damping.aligned(&reference)?,
        mass: mass.aligned(&reference)?,
        tied: match &tied {
            Some(tied) => Some(TiedValues {
                stiffness: tied.stiffness.aligned(&reference)?,
                gyroscopic: tied.gyroscopic.aligned(&reference)?,
            }),
            None => None,
        },
        unbalance: None,
        stiffness: stiffness.aligned(&reference)?,
        structural: if structural.is_empty() {
            None
        } else {
            Some(structural.aligned(&reference)?)
        },
        reference,
        artificial: Artificial::None,
        modes: None,
        force: try_vec(n, Complex64::ZERO, "the forces")?,
        rows: over_dofs(&rows)?,
        structural_rows: rows,
        linear_rows: over_dofs(&rows_of(&contact_classes.linear)?)?,
        springs: Vec::new(),
        view: None,
    })
}

/// Rows as those of matrices on the degrees of freedom.
fn over_dofs(rows: &[Row]) -> Result<Vec<MotionRow>> {
    let mut found = Vec::new();
    for row in rows {
        try_push(&mut found, MotionRow::new(row)?, "the contacts")?;
    }
    Ok(found)
}
