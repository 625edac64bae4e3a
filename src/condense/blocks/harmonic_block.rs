//! One harmonic of the condensed model: the matrices on one pattern, and the rows of the contacts.

use crate::condense::blocks::contact_classes::ContactClasses;
use crate::condense::blocks::flexibility_way::FlexibilityWay;
use crate::condense::by_modes::sum_terms::Source;
use crate::error::{Result, try_copy, try_push, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::factors::factor::is_dense;
use crate::linalg::iterative::block_krylov::SparseVector;
use crate::linalg::sparse_storage::sparse::{Csc, Form};
use crate::model::Model;
use crate::model::few_motions::reduced_wave::{MotionRow, ReducedView};
use crate::model::matrices::modal_directions::split_damping;
use crate::model::matrices::sector_motion::MOTION_TERMS;
use crate::model::matrices::spring::Row;
use crate::model::matrices::structure::MatrixKind;
use crate::model::matrices::wave::Wave;
use num_complex::Complex64;
use std::sync::Arc;

/// Matrix of the artificial damping of a nonlinear mode; see [`crate::condense::by_factors::dynamic_stiffness`].
#[derive(Clone, Debug)]
pub enum Artificial {
    /// No artificial damping, as in a forced response.
    None,
    /// The mass matrix M of the harmonic.
    Mass,
    /// The stiffness matrix K of the structure itself, at the entries of the pattern.
    Stiffness(Vec<Complex64>),
}

/// Values of a matrix at the entries of a pattern, which the harmonics of one wave share.
pub type Values = Arc<Vec<Complex64>>;

/// Matrices, forces and contact rows of one harmonic.
#[derive(Clone, Debug)]
pub struct HarmonicBlock {
    /// Index h of the harmonic; 0 is the mean.
    pub number: usize,
    /// Motion of the next sector over that of this sector: the phase factor of the wave.
    pub next: Complex64,
    pub matrices: BlockMatrices,
    /// Modes or poles of the wave along a sweep, where the flexibility is a sum over them.
    pub source: Option<Source>,
    /// Why the block has no modes or poles, where `source` is `None`.
    pub without_source: FlexibilityWay,
    pub load: BlockLoad,
    pub motions: BlockMotions,
    /// The basis on which the matrices are; `None`: they are on the independent degrees of freedom.
    pub view: Option<ReducedView>,
}

/// Matrices of the structure in a harmonic, as values on one pattern.
#[derive(Clone, Debug)]
pub struct BlockMatrices {
    /// K_h with springs, contacts that never slip, structural damping iD_h, and Wᴴ κ W; its pattern holds C and M too. Harmonics
    /// of one wave with one κ share it.
    pub reference: Arc<Csc>,
    /// K_h with springs and contacts that never slip, without iD_h and Wᴴ κ W, at the entries of the pattern.
    pub stiffness: Values,
    /// D_h of the structural damping iD_h, ηK_h included, at the entries of the pattern; `None` without such damping.
    pub structural: Option<Values>,
    /// Damping C_h at the entries of the pattern, without that of `modal`.
    pub damping: Values,
    /// Columns of L of the damping L Lᴴ of few modes beside it; `None` without, or where it is part of the matrix.
    pub modal: Option<Arc<Vec<SparseVector>>>,
    /// Mass M_h at the entries of the pattern.
    pub mass: Values,
    /// Matrix of the artificial damping of a nonlinear mode.
    pub artificial: Artificial,
    /// Terms of a speed that is tied to the frequency; `None` without.
    pub tied: Option<TiedValues>,
}

/// Forces of a harmonic.
#[derive(Clone, Debug)]
pub struct BlockLoad {
    /// F_h in units of the length scale.
    pub force: Vec<Complex64>,
    /// Amplitudes over ω² of the forces that grow with ω², in units of the length scale; `None` without such forces.
    pub unbalance: Option<Vec<Complex64>>,
}

/// Relative motions, as rows of the structure.
#[derive(Clone, Debug)]
pub struct BlockMotions {
    /// Rows of W, one per relative coordinate.
    pub rows: Vec<MotionRow>,
    /// Rows of W over the independent degrees of freedom.
    pub structural_rows: Vec<Row>,
    /// Rows of the relative motions of linear contacts, which have no relative coordinate.
    pub linear_rows: Vec<MotionRow>,
    /// Linear springs of a structure on a basis: row of force and row of motion over the independent degrees of
    /// freedom, and stiffness.
    pub springs: Vec<(Row, Row, f64)>,
}

/// p²K₁ and pG at the entries of the pattern, for Z_h = … + ω² p²K₁ + ihω² pG.
#[derive(Clone, Debug)]
pub struct TiedValues {
    /// p²K₁, stiffness that grows with the square of a tied speed Ω = pω, over ω².
    pub stiffness: Vec<Complex64>,
    /// pG, gyroscopic matrix of a tied speed Ω = pω, over ω.
    pub gyroscopic: Vec<Complex64>,
}

impl HarmonicBlock {
    /// How the flexibility of this harmonic is made, as far as it is known before a sweep.
    pub fn flexibility_way(&self) -> FlexibilityWay {
        match &self.source {
            Some(Source::Modes(_)) => FlexibilityWay::Modes,
            Some(Source::Poles(_)) => FlexibilityWay::Poles,
            None => self.without_source,
        }
    }

    /// Rewrites a row over the independent degrees of freedom as one over the coordinates of the block.
    pub fn row(&self, row: &Row) -> Result<MotionRow> {
        match &self.view {
            Some(view) => view.row(row),
            None => MotionRow::new(row),
        }
    }

    /// K_h of the structure itself, without any spring and without the loss in a complex stiffness, at the entries of the pattern.
    pub fn own_stiffness(&self, model: &Model) -> Result<Vec<Complex64>> {
        let Some(view) = &self.view else {
            let structure = model.structure();
            let own = structure.elastic(structure.wave_matrix(MatrixKind::Stiffness, self.number)?)?;
            return own.aligned(&self.matrices.reference);
        };
        let n = self.matrices.reference.rows;
        let mut own = try_vec(
            self.matrices.reference.values.len(),
            Complex64::ZERO,
            "the matrices per harmonic",
        )?;
        for k in 0..n {
            own[k * n + k] = view.pencil().stiffness(k).into();
        }
        Ok(own)
    }

    /// Whether a force acts at any frequency.
    pub fn has_force(&self) -> bool {
        let unbalance = self.load.unbalance.iter().flatten();
        self.load.force.iter().chain(unbalance).any(|f| *f != Complex64::ZERO)
    }

    /// F_h at an angular frequency.
    pub fn force_at(&self, omega: f64, force: &mut [Complex64]) {
        force.copy_from_slice(&self.load.force);
        for (f, u) in force.iter_mut().zip(self.load.unbalance.iter().flatten()) {
            *f += u * (omega * omega);
        }
    }

    /// y ← M x with the mass matrix of the block.
    pub fn multiply_mass(&self, x: &[Complex64], y: &mut [Complex64]) {
        y.fill(Complex64::ZERO);
        let pattern = &self.matrices.reference;
        for (j, x) in x.iter().enumerate() {
            for at in pattern.col_ptr[j]..pattern.col_ptr[j + 1] {
                y[pattern.row_idx[at]] += self.matrices.mass[at] * x;
            }
        }
    }
}

/// A block whose matrices harmonic `number` shares: the harmonics of one wave differ in the reference stiffness alone, and those
/// of the wave that travels the other way have the conjugate matrices.
pub(crate) fn of_same_wave<'b>(
    model: &Model,
    number: usize,
    blocks: &(impl Iterator<Item = &'b HarmonicBlock> + Clone),
) -> Option<(&'b HarmonicBlock, Form)> {
    let structure = model.structure();
    // The mean has no structural damping and no imaginary parts. Structural and gyroscopic matrices may be complex.
    let conjugates = !structure.has_structural_matrix() && !structure.is_rotating();
    let (key, backward) = structure.wave_key(number);
    let form_of = |block: &HarmonicBlock| {
        let (known, other) = structure.wave_key(block.number);
        let form = if other == backward {
            Form::Plain
        } else {
            Form::Conjugated
        };
        let is_shared = known == key && block.number > 0 && number > 0 && (form == Form::Plain || conjugates);
        is_shared.then_some(form)
    };
    let sharing = || blocks.clone().filter_map(|block| Some((block, form_of(block)?)));
    // Values of the same direction are not copied.
    let same = sharing().find(|(_, form)| *form == Form::Plain);
    same.or_else(|| sharing().next())
}

/// Makes the block of harmonic `number` from a block of the same wave; see [`of_same_wave`]. `kappa` is the reference
/// stiffness of a coordinate in a harmonic.
pub(crate) fn shared_block(
    model: &Model,
    number: usize,
    (known, form): (&HarmonicBlock, Form),
    (contact_classes, representatives): (&ContactClasses, &[(usize, usize)]),
    kappa: impl Fn(usize, usize) -> Complex64,
) -> Result<HarmonicBlock> {
    let copy = |values: &[Complex64]| -> Result<Vec<Complex64>> {
        let mut copy = try_copy(values, "the matrices per harmonic")?;
        if form == Form::Conjugated {
            for v in &mut copy {
                *v = v.conj();
            }
        }
        Ok(copy)
    };
    let share = |values: &Values| -> Result<Values> {
        if form == Form::Plain {
            return Ok(Arc::clone(values));
        }
        copy(values).map(Arc::new)
    };
    let rows = rows_of(model, representatives, number)?;
    let stiffness = share(&known.matrices.stiffness)?;
    let structural = known.matrices.structural.as_ref().map(share).transpose()?;
    let has_same_kappa = (0..rows.len()).all(|c| kappa(c, number) == kappa(c, known.number));
    let reference = if form == Form::Plain && has_same_kappa {
        Arc::clone(&known.matrices.reference)
    } else {
        let mut reference = known.matrices.reference.try_clone()?;
        reference.values.copy_from_slice(&stiffness);
        for (v, d) in reference
            .values
            .iter_mut()
            .zip(structural.iter().flat_map(|values| values.iter()))
        {
            *v += Complex64::I * d;
        }
        for (c, row) in rows.iter().enumerate() {
            for &(q, b) in row.iter().flatten() {
                for &(p, a) in row.iter().flatten() {
                    reference.add_stored(p, q, a.conj() * kappa(c, number) * b);
                }
            }
        }
        Arc::new(reference)
    };
    let modal = match (&known.matrices.modal, form) {
        (Some(known), Form::Conjugated) => Some(Arc::new(conjugated(known)?)),
        (known, _) => known.clone(),
    };
    let tied = known.matrices.tied.as_ref().map(|tied| {
        Ok(TiedValues {
            stiffness: copy(&tied.stiffness)?,
            gyroscopic: copy(&tied.gyroscopic)?,
        })
    });
    let matrices = Matrices {
        damping: share(&known.matrices.damping)?,
        modal,
        mass: share(&known.matrices.mass)?,
        tied: tied.transpose()?,
        stiffness,
        structural,
        reference,
    };
    matrices.into_block(model, number, contact_classes, rows)
}

/// The conjugate ones of some vectors.
fn conjugated(vectors: &[SparseVector]) -> Result<Vec<SparseVector>> {
    let mut found = Vec::new();
    for vector in vectors {
        let mut copy = try_copy(vector, "the matrices per harmonic")?;
        for (_, z) in &mut copy {
            *z = z.conj();
        }
        try_push(&mut found, copy, "the matrices per harmonic")?;
    }
    Ok(found)
}

/// The matrices of a block; see [`HarmonicBlock`].
struct Matrices {
    stiffness: Values,
    structural: Option<Values>,
    damping: Values,
    modal: Option<Arc<Vec<SparseVector>>>,
    mass: Values,
    tied: Option<TiedValues>,
    reference: Arc<Csc>,
}

impl Matrices {
    /// A block with the rows of its coordinates, without force, artificial damping and modes.
    fn into_block(
        self,
        model: &Model,
        number: usize,
        contact_classes: &ContactClasses,
        rows: Vec<Row>,
    ) -> Result<HarmonicBlock> {
        let structure = model.structure();
        Ok(HarmonicBlock {
            number,
            next: structure.phase(number, 1),
            matrices: BlockMatrices {
                reference: self.reference,
                stiffness: self.stiffness,
                structural: self.structural,
                damping: self.damping,
                modal: self.modal,
                mass: self.mass,
                artificial: Artificial::None,
                tied: self.tied,
            },
            source: None,
            without_source: FlexibilityWay::SingleFrequency,
            load: BlockLoad {
                force: try_vec(structure.ndof(), Complex64::ZERO, "the forces")?,
                unbalance: None,
            },
            motions: BlockMotions {
                rows: over_dofs(&rows)?,
                structural_rows: rows,
                linear_rows: over_dofs(&rows_of(model, &contact_classes.linear, number)?)?,
                springs: Vec::new(),
            },
            view: None,
        })
    }
}

/// Rows of W of some (contact, direction) pairs.
fn rows_of(model: &Model, contacts: &[(usize, usize)], number: usize) -> Result<Vec<Row>> {
    let mut rows = try_vec(contacts.len(), [None; MOTION_TERMS], "the contacts")?;
    for (r, &(i, k)) in rows.iter_mut().zip(contacts) {
        *r = model.structure().contact_row(&model.contacts()[i], k, number);
    }
    Ok(rows)
}

/// The block of harmonic `number`, with contacts that never slip as springs, one row for each of the (contact,
/// direction) pairs that represent the coordinates, and their reference stiffness. It has no force and no
/// artificial damping yet.
pub(crate) fn harmonic_block(
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
    let rows = rows_of(model, representatives, number)?;
    interrupt.check()?;
    // Beside a full stiffness the damping of modes is full without loss.
    let split = if !structure.has_modal_damping() || is_dense(&stiffness)? {
        None
    } else {
        split_damping(structure, Wave::Harmonic(number), interrupt)?
    };
    let (damping, modal) = match split {
        Some((rest, modal)) => (rest, (!modal.is_empty()).then(|| Arc::new(modal))),
        None => (structure.wave_matrix(MatrixKind::Damping, number)?, None),
    };
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
    let tied = tied.map(|tied| {
        Ok(TiedValues {
            stiffness: tied.stiffness.aligned(&reference)?,
            gyroscopic: tied.gyroscopic.aligned(&reference)?,
        })
    });
    let aligned = |matrix: &Csc| matrix.aligned(&reference).map(Arc::new);
    let structural = (!structural.is_empty()).then(|| aligned(&structural));
    let matrices = Matrices {
        stiffness: aligned(&stiffness)?,
        structural: structural.transpose()?,
        damping: aligned(&damping)?,
        modal,
        mass: aligned(&mass)?,
        tied: tied.transpose()?,
        reference: Arc::new(reference),
    };
    matrices.into_block(model, number, contact_classes, rows)
}

/// Rewrites rows of relative motions for matrices on all degrees of freedom.
fn over_dofs(rows: &[Row]) -> Result<Vec<MotionRow>> {
    let mut found = Vec::new();
    for row in rows {
        try_push(&mut found, MotionRow::new(row)?, "the contacts")?;
    }
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::condense::test_chains::{DAMPED, chain};
    use crate::linalg::sparse_storage::matrix_view::MatrixView;

    fn close(a: &[Complex64], b: &[Complex64]) -> bool {
        let size = b.iter().fold(0.0_f64, |m, b| m.max(b.norm()));
        a.len() == b.len() && a.iter().zip(b).all(|(a, b)| (a - b).norm() <= 1e-15 * size)
    }

    /// Blocks of all harmonics up to 40, each made from the matrices, and how many others share theirs.
    fn check(model: &Model, expected: usize) {
        let interrupt = Interrupt::none();
        let classes = ContactClasses::new(model).unwrap();
        let representatives = [(0, 0), (1, 0), (2, 0)];
        let contacts = (&classes, &representatives[..]);
        let mut blocks = Vec::new();
        let mut shared = 0;
        for number in 0..=40 {
            // κ is equal in groups of 15 harmonics.
            let kappa = |c: usize, number: usize| Complex64::new(1.0 + c as f64, 0.1 * (number / 15) as f64);
            let made = harmonic_block(model, number, contacts, |c| kappa(c, number), &interrupt).unwrap();
            if let Some(known) = of_same_wave(model, number, &blocks.iter()) {
                let block = shared_block(model, number, known, contacts, kappa).unwrap();
                assert_eq!(block.matrices.reference.row_idx, made.matrices.reference.row_idx);
                assert!(
                    close(&block.matrices.reference.values, &made.matrices.reference.values),
                    "{number}"
                );
                for (a, b) in [
                    (&block.matrices.stiffness, &made.matrices.stiffness),
                    (&block.matrices.damping, &made.matrices.damping),
                    (&block.matrices.mass, &made.matrices.mass),
                ] {
                    assert!(close(a, b), "{number}");
                }
                assert_eq!(block.matrices.structural.is_some(), made.matrices.structural.is_some());
                for (a, b) in block.matrices.structural.iter().zip(&made.matrices.structural) {
                    assert!(close(a, b), "{number}");
                }
                shared += 1;
            }
            blocks.push(made);
        }
        assert_eq!(shared, expected);
    }

    #[test]
    fn shared_matrices_are_those_of_the_harmonic() {
        for sectors in [1, 9, 12] {
            for (damping, loss_factor) in DAMPED {
                let mut model = chain(sectors, damping);
                model.set_loss_factor(loss_factor).unwrap();
                // With engine order 2 waves of 0 to 4 or to 3 pairs of diameters; the mean is by itself.
                let waves = match sectors {
                    9 => 5,
                    12 => 4,
                    _ => 1,
                };
                check(&model, 40 - waves);
            }
        }
        // The damping of one sense is not the conjugate of the other's.
        let mut complex = chain(9, (0.0, 1e-3));
        let mut damping = [Complex64::ZERO; 81];
        damping[0] = Complex64::I;
        complex
            .set_coupling(MatrixKind::Damping, &MatrixView::dense_complex(9, &damping))
            .unwrap();
        check(&complex, 40 - 9);
    }
}
