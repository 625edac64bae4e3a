//! The equations of perturbations between events, in real numbers where they are real:
//! M δẍ + C δẋ + K δx + Rᴴ(S R δx − kt δw) = 0 with the slopes S of the contacts.

use crate::error::{Result, Status, fail, try_push, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::factors::factor::Factor;
use crate::linalg::factors::lu::Scalar;
use crate::linalg::sparse_storage::sparse::Csc;
use crate::linalg::sparse_storage::triangle::Entry;
use crate::model::matrices::sector_motion::MOTION_TERMS;
use crate::time_integration::unrolled_structure::{OF_ONE_ELEMENT, Sparse, System};
use num_complex::Complex64;

const CONTEXT: &str = "the equations of perturbations";

/// Perturbations that are carried together.
/// Kind: block.
pub(crate) const VARIATIONAL_EQUATIONS_LANES: usize = 8;

/// A real number for each of the perturbations that are carried together.
pub(super) type Numbers = [f64; VARIATIONAL_EQUATIONS_LANES];

/// Type of numbers for perturbations, real or complex.
pub(crate) trait Number: Entry + Scalar {}

impl Number for f64 {}
impl Number for Complex64 {}

/// Row of a relative motion: pairs (degree of freedom, coefficient).
pub(crate) type VariationalRow<T> = [Option<(usize, T)>; MOTION_TERMS];

/// A contact in the equations of perturbations.
pub(crate) struct VariationalElement<T> {
    /// Index of the element in the structure in time.
    pub source: usize,
    /// Rows of the relative motions of the contact.
    pub rows: Vec<VariationalRow<T>>,
    /// Index of its slider among those that are carried; `None` without a slider.
    pub slider: Option<usize>,
    /// Whether the law of the contact has no events.
    pub smooth: bool,
}

/// The equations of perturbations: matrices M, C, K and contacts.
pub(crate) struct VariationalEquations<T> {
    pub(super) order: usize,
    pub(super) mass: Columns<T>,
    mass_factor: MassFactor,
    pub(super) damping: Columns<T>,
    pub(super) stiffness: Columns<T>,
    pub(super) elements: Vec<VariationalElement<T>>,
    /// Number of sliders that are carried.
    pub(super) sliders: usize,
}

/// A sparse matrix, column by column.
pub(super) struct Columns<T> {
    starts: Vec<usize>,
    entries: Vec<(usize, T)>,
}

/// Factors of the mass matrix.
enum MassFactor {
    /// Reciprocals 1/mᵢᵢ of a diagonal mass matrix.
    Diagonal(Vec<f64>),
    General {
        factor: Box<Factor>,
        buffer: Vec<Complex64>,
    },
}

impl<T: Number> Columns<T> {
    fn new(a: &Csc) -> Result<Self> {
        let mut starts = try_vec(a.cols + 1, 0, CONTEXT)?;
        let mut entries = Vec::new();
        for j in 0..a.cols {
            for (i, v) in a.column(j).filter(|(_, v)| *v != Complex64::ZERO) {
                try_push(&mut entries, (i, T::of(v)), CONTEXT)?;
            }
            starts[j + 1] = entries.len();
        }
        Ok(Self { starts, entries })
    }

    /// Entries of the matrix: (row, column, value).
    pub fn each(&self) -> impl Iterator<Item = (usize, usize, T)> {
        let columns = self.starts.windows(2).enumerate();
        columns.flat_map(|(j, ends)| self.entries[ends[0]..ends[1]].iter().map(move |&(i, v)| (i, j, v)))
    }

    fn len(&self) -> usize {
        self.entries.len()
    }
}

impl<T: Number> VariationalEquations<T> {
    /// The equations with the given matrices M, C and K.
    ///
    /// # Errors
    /// `OutOfMemory`, `StoppedByCaller`; `Unsupported` if the mass matrix is singular.
    pub fn new(
        [mass, damping, stiffness]: [&Csc; 3],
        elements: Vec<VariationalElement<T>>,
        sliders: usize,
        interrupt: &Interrupt<'_>,
    ) -> Result<Self> {
        Ok(Self {
            order: mass.cols,
            mass: Columns::new(mass)?,
            mass_factor: MassFactor::new(mass, interrupt)?,
            damping: Columns::new(damping)?,
            stiffness: Columns::new(stiffness)?,
            elements,
            sliders,
        })
    }

    /// Number of states of a perturbation: displacements, velocities and sliders.
    pub fn states(&self) -> usize {
        2 * self.order + self.sliders
    }

    pub(super) fn has_diagonal_mass(&self) -> bool {
        matches!(self.mass_factor, MassFactor::Diagonal(_))
    }

    /// Number of operations of one product with the matrices and elements.
    pub(super) fn operations(&self) -> u64 {
        let elements = OF_ONE_ELEMENT * self.elements.len();
        (VARIATIONAL_EQUATIONS_LANES * (self.stiffness.len() + self.damping.len() + self.order + elements)) as u64
    }

    /// Reciprocals 1/mᵢᵢ of a diagonal mass; `None` for another mass.
    pub(super) fn inverse_mass(&self) -> Option<&[f64]> {
        match &self.mass_factor {
            MassFactor::Diagonal(inverse) => Some(inverse),
            MassFactor::General { .. } => None,
        }
    }

    /// a ← M⁻¹ a for a mass that is not diagonal; real parts come before imaginary ones.
    pub(super) fn accelerate(&mut self, a: &mut [Numbers], interrupt: &Interrupt<'_>) -> Result<()> {
        let n = self.order;
        let MassFactor::General { factor, buffer } = &mut self.mass_factor else {
            return Ok(());
        };
        for i in 0..n {
            for k in 0..VARIATIONAL_EQUATIONS_LANES {
                let im = a.get(n + i).map_or(0.0, |a| a[k]);
                buffer[k * n + i] = Complex64::new(a[i][k], im);
            }
        }
        factor.solve(buffer, false, interrupt)?;
        for (i, a) in a.iter_mut().enumerate() {
            let (within, is_real) = (i % n, i < n);
            for (k, a) in a.iter_mut().enumerate() {
                let z = buffer[k * n + within];
                *a = if is_real { z.re } else { z.im };
            }
        }
        Ok(())
    }
}

impl VariationalEquations<f64> {
    /// The equations for perturbations of the structure in time; each element has the place of a slider.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn of_system(system: &System<'_>) -> Result<Self> {
        let mut elements = Vec::new();
        for (source, e) in system.elements.iter().enumerate() {
            let mut rows = Vec::new();
            for row in &e.rows {
                try_push(&mut rows, *row, CONTEXT)?;
            }
            let element = VariationalElement {
                source,
                rows,
                slider: Some(source),
                smooth: e.smooth().is_some(),
            };
            try_push(&mut elements, element, CONTEXT)?;
        }
        let sparse = |a: &Sparse| -> Result<Csc> {
            let mut entries = Vec::new();
            let mut failed = None;
            a.each(|i, j, v| {
                failed = failed
                    .take()
                    .or(try_push(&mut entries, (i, j, v.into()), CONTEXT).err());
            });
            match failed {
                Some(e) => Err(e),
                None => Csc::from_triplets(system.order(), system.order(), entries),
            }
        };
        let matrices = [
            sparse(&system.matrices.inertia)?,
            sparse(&system.matrices.damping)?,
            sparse(&system.matrices.stiffness)?,
        ];
        let [m, c, k] = &matrices;
        let count = elements.len();
        Self::new([m, c, k], elements, count, system.interrupt)
    }
}

impl MassFactor {
    fn new(mass: &Csc, interrupt: &Interrupt<'_>) -> Result<Self> {
        if (0..mass.cols).all(|j| mass.column(j).all(|(i, v)| i == j || v == Complex64::ZERO)) {
            // The structure in time has refused degrees of freedom without mass.
            let mut inverse = try_vec(mass.cols, 0.0, CONTEXT)?;
            for (i, d) in inverse.iter_mut().enumerate() {
                *d = 1.0 / mass.get(i, i).re;
            }
            return Ok(Self::Diagonal(inverse));
        }
        let mut factor = Box::new(Factor::new(mass, VARIATIONAL_EQUATIONS_LANES)?);
        match factor.factor(mass, interrupt) {
            Ok(()) => Ok(Self::General {
                factor,
                buffer: try_vec(
                    mass.cols.saturating_mul(VARIATIONAL_EQUATIONS_LANES),
                    Complex64::ZERO,
                    CONTEXT,
                )?,
            }),
            Err(e) if e.status == Status::Singular => fail!(
                Unsupported,
                "the mass matrix is singular: some motion in time has no differential equation; give it mass"
            ),
            Err(e) => Err(e),
        }
    }
}
