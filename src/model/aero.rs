//! Aerodynamic influence: forces on a sector that follow the motion of this and other sectors.
//!
//! On the right-hand side f_s = Σ_k c_k x_{s+k}, or the same with the velocities. In the wave in which sector s + 1 lags
//! by 2πd/N they are f = A(d) x with A(d) = Σ_k c_k e^{−2πikd/N}, per velocity iωh A(d) x in harmonic h, which belongs to
//! d = h·EO mod N (Crawley 1988, AGARD-AG-298, chapter 19; Hanamura, Tanaka & Yamaguchi 1980,
//! doi:10.1299/jsme1958.23.880).

use crate::byte_stream::{ByteReader, ByteWriter};
use crate::error::{Result, fail, try_copy, try_push, try_vec};
use crate::linalg::sparse::Csc;
use crate::model::Model;
use crate::model::structure::Structure;
use num_complex::Complex64;
use std::sync::Arc;

const CONTEXT: &str = "the aerodynamic influence";

/// Motion that aerodynamic forces follow.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AeroForm {
    /// Displacements: a force per displacement.
    Displacement = 0,
    /// Velocities: a force per velocity.
    Velocity = 1,
}

/// Number of forms.
pub(super) const FORMS: usize = 2;

/// Influence coefficients as they were given, checked.
#[derive(Clone, Debug)]
pub struct AeroInfluence {
    dofs: Vec<usize>,
    offsets: Vec<i64>,
    coefficients: Vec<Complex64>,
}

/// A coefficient.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AeroEntry {
    /// Degree of freedom of the force.
    pub force: usize,
    /// Degree of freedom of the motion.
    pub motion: usize,
    /// Sector of the motion, counted from that of the force.
    pub offset: i64,
    /// Force per motion.
    pub coefficient: Complex64,
}

impl AeroInfluence {
    fn new(structure: &Structure, dofs: &[usize], offsets: &[i64], coefficients: &[Complex64]) -> Result<Option<Self>> {
        if structure.sectors() == 1 {
            return fail!(
                Unsupported,
                "aerodynamic influence: a plain structure has no other sectors; use a cyclic model, or the stiffness and \
                 damping matrices"
            );
        }
        let ndof = structure.degrees().given();
        for (i, &dof) in dofs.iter().enumerate() {
            if dof >= ndof {
                return fail!(
                    Index,
                    "aerodynamic influence: dofs[{i}] = {dof}, needs 0 .. {}",
                    ndof - 1
                );
            }
        }
        let sectors = structure.sectors() as i64;
        once("dofs", "degree of freedom", dofs, |&dof| dof)?;
        once("offsets", "sector", offsets, |k| k.rem_euclid(sectors))?;
        let n = dofs.len();
        let needed = n.checked_mul(n).and_then(|square| square.checked_mul(offsets.len()));
        if needed != Some(coefficients.len()) {
            return fail!(
                Dimension,
                "aerodynamic influence: {} coefficients, needs {} offsets x {n} x {n} degrees of freedom",
                coefficients.len(),
                offsets.len()
            );
        }
        if let Some(at) = coefficients.iter().position(|c| !c.re.is_finite() || !c.im.is_finite()) {
            return fail!(
                NotFinite,
                "aerodynamic influence: coefficients[{at}] = {}, needs finite numbers",
                coefficients[at]
            );
        }
        if coefficients.is_empty() {
            return Ok(None);
        }
        Ok(Some(Self {
            dofs: try_copy(dofs, CONTEXT)?,
            offsets: try_copy(offsets, CONTEXT)?,
            coefficients: try_copy(coefficients, CONTEXT)?,
        }))
    }

    /// The coefficients, those of one offset after another, row after row.
    #[must_use]
    pub fn entries(&self) -> impl ExactSizeIterator<Item = AeroEntry> + '_ {
        let n = self.dofs.len();
        self.coefficients
            .iter()
            .enumerate()
            .map(move |(at, &coefficient)| AeroEntry {
                force: self.dofs[at / n % n],
                motion: self.dofs[at % n],
                offset: self.offsets[at / (n * n)],
                coefficient,
            })
    }

    pub(super) fn is_real(&self) -> bool {
        self.coefficients.iter().all(|c| c.im == 0.0)
    }

    /// Calls `take` with (offset of the sector, row, column, coefficient) over the independent degrees of freedom.
    fn visit(
        &self,
        structure: &Structure,
        mut take: impl FnMut(i64, usize, usize, Complex64) -> Result<()>,
    ) -> Result<()> {
        let (degrees, sectors) = (structure.degrees(), structure.sectors() as i64);
        for entry in self.entries().filter(|e| e.coefficient != Complex64::ZERO) {
            let (row_sector, rows) = degrees.image(entry.force);
            for (p, a) in rows {
                let (column_sector, columns) = degrees.image(entry.motion);
                for (q, b) in columns {
                    let offset = entry.offset.rem_euclid(sectors) + column_sector - row_sector;
                    take(offset, p, q, entry.coefficient * (a * b))?;
                }
            }
        }
        Ok(())
    }

    fn save_to(&self, out: &mut ByteWriter<'_>) {
        out.count(self.dofs.len());
        for &dof in &self.dofs {
            out.count(dof);
        }
        out.count(self.offsets.len());
        for &offset in &self.offsets {
            out.i64(offset);
        }
        for c in &self.coefficients {
            out.f64(c.re);
            out.f64(c.im);
        }
    }

    fn load_from(structure: &Structure, input: &mut ByteReader<'_>) -> Result<Option<Self>> {
        let mut dofs = Vec::new();
        for _ in 0..input.entries(8)? {
            try_push(&mut dofs, input.count()?, CONTEXT)?;
        }
        let mut offsets = Vec::new();
        for _ in 0..input.entries(8)? {
            try_push(&mut offsets, input.i64()?, CONTEXT)?;
        }
        let count = dofs.len().saturating_mul(dofs.len()).saturating_mul(offsets.len());
        if count > input.left() / 16 {
            return Err(input.damaged("coefficients of the aerodynamic influence are missing"));
        }
        let mut coefficients = try_vec(count, Complex64::ZERO, CONTEXT)?;
        for c in &mut coefficients {
            *c = Complex64::new(input.finite()?, input.finite()?);
        }
        Self::new(structure, &dofs, &offsets, &coefficients)
    }
}

/// Refuses a list that names something twice.
fn once<T: Copy, K: Ord>(list: &str, thing: &str, values: &[T], key: impl Fn(&T) -> K) -> Result<()> {
    let mut places = Vec::new();
    for (i, value) in values.iter().enumerate() {
        try_push(&mut places, (key(value), i), CONTEXT)?;
    }
    places.sort_unstable();
    match places.windows(2).find(|pair| pair[0].0 == pair[1].0) {
        Some(pair) => fail!(
            Argument,
            "aerodynamic influence: {list}[{}] and {list}[{}] are the same {thing}, needs each once",
            pair[0].1,
            pair[1].1
        ),
        None => Ok(()),
    }
}

impl Model {
    /// Sets forces on a sector that follow the motion of its neighbours: with f on the right-hand side,
    /// f_i = Σ_k Σ_j c[k][i][j]·x_j of the sector at the distance `offsets[k]`, or of velocities. `coefficients` has a
    /// square matrix over `dofs` for each offset, row after row. A later call of the same form replaces an earlier one;
    /// empty lists remove it. Complex coefficients act on harmonics above 0; the mean has the real part, and time
    /// integration refuses them. [`Self::linear_modes`] leave the influence out.
    ///
    /// # Errors
    /// `Unsupported` for a plain structure; `Index`, `Argument`, `Dimension` or `NotFinite`, naming the entry.
    pub fn set_aero(
        &mut self,
        dofs: &[usize],
        coefficients: &[Complex64],
        offsets: &[i64],
        form: AeroForm,
    ) -> Result<()> {
        let given = AeroInfluence::new(self.structure(), dofs, offsets, coefficients)?;
        self.changed_structure().aero_mut()[form as usize] = given.map(Arc::new);
        Ok(())
    }

    /// The aerodynamic influence of a form; `None` without.
    #[must_use]
    pub fn aero(&self, form: AeroForm) -> Option<&AeroInfluence> {
        self.structure().aero()[form as usize].as_deref()
    }

    pub(super) fn save_aero(&self, out: &mut ByteWriter<'_>) {
        for influence in self.structure().aero() {
            out.bool(influence.is_some());
            if let Some(influence) = influence {
                influence.save_to(out);
            }
        }
    }

    pub(super) fn load_aero(&mut self, input: &mut ByteReader<'_>) -> Result<()> {
        for form in 0..FORMS {
            if input.bool()? {
                let loaded = AeroInfluence::load_from(self.structure(), input)?;
                self.structure_mut().aero_mut()[form] = loaded.map(Arc::new);
            }
        }
        Ok(())
    }
}

impl Structure {
    /// Whether aerodynamic forces act.
    #[must_use]
    pub fn has_aero(&self) -> bool {
        self.aero().iter().any(Option::is_some)
    }

    /// Whether aerodynamic forces per displacement act.
    #[must_use]
    pub fn has_aero_stiffness(&self) -> bool {
        self.aero()[AeroForm::Displacement as usize].is_some()
    }

    /// The matrix −A(d) of the influence on the left-hand side, for the residue d of a wave; `None` without influence.
    pub(super) fn aero_matrix(&self, form: AeroForm, residue: usize, real: bool) -> Result<Option<Csc>> {
        let Some(influence) = &self.aero()[form as usize] else {
            return Ok(None);
        };
        let mut entries = Vec::new();
        influence.visit(self, |offset, p, q, c| {
            try_push(&mut entries, (p, q, -c * self.wave_phase(residue, offset)), CONTEXT)
        })?;
        let mut matrix = Csc::from_triplets(self.ndof(), self.ndof(), entries)?;
        if real {
            for v in &mut matrix.values {
                v.im = 0.0;
            }
        }
        Ok(Some(matrix))
    }

    /// The influence between the sectors of [`Self::repeating_sectors`], on the left-hand side.
    ///
    /// # Errors
    /// `Unsupported` for complex coefficients.
    pub(super) fn aero_around(&self, form: AeroForm) -> Result<Option<Csc>> {
        let Some(influence) = &self.aero()[form as usize] else {
            return Ok(None);
        };
        if !influence.is_real() {
            return fail!(
                Unsupported,
                "the coefficients of the aerodynamic influence are complex, which means nothing in time: at the angular \
                 frequency omega, c' + i c'' is c' per displacement and c''/omega per velocity"
            );
        }
        let (ndof, sectors) = (self.ndof(), self.repeating_sectors());
        let mut entries = Vec::new();
        influence.visit(self, |offset, p, q, c| {
            for s in 0..sectors {
                let to = (s as i64 + offset).rem_euclid(sectors as i64) as usize;
                try_push(&mut entries, (s * ndof + p, to * ndof + q, -c), CONTEXT)?;
            }
            Ok(())
        })?;
        Ok(Some(Csc::from_triplets(ndof * sectors, ndof * sectors, entries)?))
    }
}
