//! Influence coefficients: forces on a sector that follow the motion of this and other sectors.
//!
//! On the right-hand side f_s = Σ_k c_k x_{s+k}, or the same with the velocities. In the wave in which sector s + 1 lags
//! by 2πd/N they are f = A(d) x with A(d) = Σ_k c_k e^{−2πikd/N}, per velocity iωh A(d) x in harmonic h, which belongs to
//! d = h·EO mod N (Crawley & Hall, Optimization and mechanisms of mistuning in cascades, Journal of Engineering for Gas
//! Turbines and Power 107, 1985, 418 to 426; Choi, Gottfried & Fleeter, doi:10.2514/1.38636).

use crate::byte_stream::{ByteReader, ByteWriter};
use crate::error::{Result, fail, try_copy, try_push, try_vec};
use crate::model::matrices::degree_map::DegreeMap;
use num_complex::Complex64;

pub(crate) const CONTEXT: &str = "the aerodynamic influence";

/// Motion that aerodynamic forces follow.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AeroForm {
    /// Displacements: a force per displacement.
    Displacement = 0,
    /// Velocities: a force per velocity.
    Velocity = 1,
}

/// Number of forms.
/// Kind: fixed.
pub(crate) const FORMS: usize = 2;

/// Influence coefficients as the caller gave them, after checks.
#[derive(Clone, Debug)]
pub struct AeroInfluence {
    dofs: Vec<usize>,
    offsets: Vec<i64>,
    coefficients: Vec<Complex64>,
}

/// One influence coefficient.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AeroEntry {
    /// Degree of freedom of the force.
    pub force: usize,
    /// Degree of freedom of the motion.
    pub motion: usize,
    /// Sector of the motion, counted from the sector of the force.
    pub offset: i64,
    /// Coefficient: force per displacement or velocity.
    pub coefficient: Complex64,
}

impl AeroInfluence {
    /// Checked coefficients; `None` where there are none.
    pub(crate) fn new(
        (degrees, sectors): (&DegreeMap, usize),
        dofs: &[usize],
        offsets: &[i64],
        coefficients: &[Complex64],
    ) -> Result<Option<Self>> {
        if sectors == 1 {
            return fail!(
                Unsupported,
                "aerodynamic influence: a plain structure has no other sectors; use a cyclic model, or the stiffness and \
                 damping matrices"
            );
        }
        let ndof = degrees.given();
        for (i, &dof) in dofs.iter().enumerate() {
            if dof >= ndof {
                return fail!(
                    Index,
                    "aerodynamic influence: dofs[{i}] = {dof}, needs 0 .. {}",
                    ndof - 1
                );
            }
        }
        if let Some((k, offset)) = offsets
            .iter()
            .enumerate()
            .find(|(_, k)| k.unsigned_abs() >= sectors as u64)
        {
            return fail!(
                Argument,
                "aerodynamic influence: offsets[{k}] = {offset}, needs -{} .. {} on {sectors} sectors",
                sectors - 1,
                sectors - 1
            );
        }
        let sectors = sectors as i64;
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

    /// The coefficients, offset after offset, row after row.
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

    pub(crate) fn is_real(&self) -> bool {
        self.coefficients.iter().all(|c| c.im == 0.0)
    }

    /// Calls `take` with (offset of the sector, row, column, coefficient) over the independent degrees of freedom.
    pub(crate) fn visit(
        &self,
        (degrees, sectors): (&DegreeMap, usize),
        mut take: impl FnMut(i64, usize, usize, Complex64) -> Result<()>,
    ) -> Result<()> {
        let sectors = sectors as i64;
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

    pub(crate) fn save_to(&self, out: &mut ByteWriter<'_>) {
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

    pub(crate) fn load_from(wheel: (&DegreeMap, usize), input: &mut ByteReader<'_>) -> Result<Option<Self>> {
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
        Self::new(wheel, &dofs, &offsets, &coefficients)
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
