//! Tuned modes of a wheel as a basis of its mistuned ones: x = V p with VᵀMV = I and VᵀKV = diag λ, and the matrices VᵀdK_sV of
//! the sectors (component mode mistuning: Lim, Bladh, Castanier & Pierre 2007, doi:10.2514/1.13172).
//!
//! Waves of d and N − d have the same modes: their real and imaginary parts are motions of the wheel, which is never assembled.

use crate::error::{Result, fail, try_push, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::sparse_storage::sparse::Csc;
use crate::model::Model;
use crate::model::matrices::sector_matrices::Entries;
use crate::model::matrices::structure::MatrixKind;
use crate::model::matrices::wave::Wave;
use crate::model::natural_modes::linear_modes::ContactState;
use crate::model::wheels::mistuning::Mistuning;
use num_complex::Complex64;

const CONTEXT: &str = "the tuned modes of a wheel";

/// Length of a part of a standing wave, relative to the wave, below which it is rounding or a motion that is there already.
/// Kind: rounding.
const PART_IS_ROUNDING: f64 = 1e-6;

/// A mode of a wave as one or two motions of the wheel: the part of scale · e^{−2πi·d·s/N} φ in sector s.
struct Motion {
    square: f64,
    diameter: i64,
    is_imaginary: bool,
    scale: f64,
    shape: Vec<Complex64>,
}

/// Modes of all nodal diameters of a tuned wheel.
pub(crate) struct TunedFamily<'a> {
    sector: &'a Model,
    motions: Vec<Motion>,
}

/// Matrices of a mistuning pattern over the modes of the tuned wheel.
pub(crate) struct ReducedMistuning {
    /// Whether the pattern changes the mass; else the stiffness.
    pub of_mass: bool,
    /// A column-major square matrix for each sector, one after the other.
    pub matrices: Vec<f64>,
}

impl<'a> TunedFamily<'a> {
    /// Computes the `families` lowest modes of each nodal diameter.
    ///
    /// # Errors
    /// `Unsupported` for a plain model and for waves whose senses differ; those of [`Model::lowest_modes`].
    pub fn new(
        sector: &'a Model,
        contacts: ContactState<'_>,
        families: usize,
        interrupt: &Interrupt<'_>,
    ) -> Result<Self> {
        let structure = sector.structure();
        let sectors = structure.sectors();
        if sectors == 1 {
            return fail!(Unsupported, "a plain structure, needs the sector of a wheel");
        }
        if !sector.has_equal_senses() {
            return fail!(
                Unsupported,
                "gyroscopic forces or complex matrices, by which waves of both senses have other modes"
            );
        }
        let mut motions = Vec::new();
        for d in 0..=sectors / 2 {
            interrupt.check()?;
            let pencil = sector.pencil(Wave::Diameter(d as i64), contacts)?;
            let modes = pencil.lowest(families, interrupt)?;
            let is_standing = d == 0 || 2 * d == sectors;
            let first = motions.len();
            for (&omega, shape) in modes.omega.iter().zip(modes.shapes.chunks_exact(structure.ndof())) {
                let square = omega * omega.abs();
                if is_standing {
                    push_standing(&mut motions, first, shape, (square, d as i64, sectors), pencil.weight())?;
                } else {
                    for is_imaginary in [false, true] {
                        let motion = Motion {
                            square,
                            diameter: d as i64,
                            is_imaginary,
                            scale: (2.0 / sectors as f64).sqrt(),
                            shape: crate::error::try_copy(shape, CONTEXT)?,
                        };
                        try_push(&mut motions, motion, CONTEXT)?;
                    }
                }
            }
        }
        Ok(Self { sector, motions })
    }

    /// Number of modes of the basis.
    pub fn len(&self) -> usize {
        self.motions.len()
    }

    /// Squared angular frequencies of the modes; negative for motions that grow.
    pub fn squares(&self) -> impl Iterator<Item = f64> + '_ {
        self.motions.iter().map(|motion| motion.square)
    }

    /// Motion of an independent degree of freedom of the wheel in a mode.
    fn value(&self, dof: usize, motion: &Motion) -> f64 {
        let structure = self.sector.structure();
        let n = structure.ndof();
        let z = structure.wave_phase(motion.diameter, (dof / n) as i64) * motion.shape[dof % n];
        motion.scale * if motion.is_imaginary { z.im } else { z.re }
    }

    /// Motions of a degree of freedom in all sectors, in the caller's numbering: one row for each sector,
    /// column-major.
    ///
    /// # Errors
    /// `Argument` for a degree of freedom that does not move by itself.
    pub fn rows_of(&self, dof: usize) -> Result<Vec<f64>> {
        let structure = self.sector.structure();
        let Some(number) = structure.degrees().number(dof) else {
            return fail!(Argument, "degree of freedom {dof} of the sector is fixed");
        };
        let (n, sectors) = (structure.ndof(), structure.sectors());
        let mut rows = try_vec(sectors * self.len(), 0.0, CONTEXT)?;
        for (column, motion) in rows.chunks_exact_mut(sectors).zip(&self.motions) {
            for (s, row) in column.iter_mut().enumerate() {
                *row = self.value(number + s * n, motion);
            }
        }
        Ok(rows)
    }

    /// Matrices VᵀdK_sV, or VᵀdM_sV, of each sector for δ_s = 1; for a pattern of frequencies by the factor of the
    /// stiffness.
    ///
    /// # Errors
    /// `Unsupported` for another quantity; those of [`Model::mistune`].
    pub fn mistuning(&self, what: &Mistuning<'_>, interrupt: &Interrupt<'_>) -> Result<ReducedMistuning> {
        let structure = self.sector.structure();
        let (kind, entries) = match *what {
            Mistuning::Blade(property, dofs) => structure.of_blade(property, dofs)?,
            Mistuning::Matrix(kind, direction) => (kind, structure.of_direction(kind, direction)?),
            Mistuning::Preload(_) | Mistuning::Force => (MatrixKind::Damping, Vec::new()),
        };
        let of_mass = kind == MatrixKind::Mass;
        if !of_mass && kind != MatrixKind::Stiffness {
            return fail!(
                Unsupported,
                "modes without damping do not show it, nor loads and forces; needs stiffness, frequency or mass"
            );
        }
        let (m, sectors) = (self.len(), structure.sectors());
        let mut matrices = try_vec(sectors * m * m, 0.0, CONTEXT)?;
        for (s, a) in matrices.chunks_exact_mut(m * m).enumerate() {
            self.add_sector(a, s, &entries, interrupt)?;
        }
        Ok(ReducedMistuning { of_mass, matrices })
    }

    /// Adds VᵀEV to `a`, where E holds the entries of sector 0, moved to sector s.
    fn add_sector(&self, a: &mut [f64], s: usize, entries: &Entries, interrupt: &Interrupt<'_>) -> Result<()> {
        let structure = self.sector.structure();
        let (m, n) = (self.len(), structure.ndof());
        let all = n * structure.sectors();
        let mut rows = Vec::new();
        for &(i, j, _) in entries {
            try_push(&mut rows, i, CONTEXT)?;
            try_push(&mut rows, j, CONTEXT)?;
        }
        rows.sort_unstable();
        rows.dedup();
        let nr = rows.len();
        let mut v = try_vec(nr * m, 0.0, CONTEXT)?;
        for (column, motion) in v.chunks_exact_mut(nr.max(1)).zip(&self.motions) {
            for (v, row) in column.iter_mut().zip(&rows) {
                *v = self.value((row + s * n) % all, motion);
            }
        }
        let mut placed = Vec::new();
        for &(i, j, e) in entries {
            if let (Ok(i), Ok(j)) = (rows.binary_search(&i), rows.binary_search(&j)) {
                try_push(&mut placed, (i, j, e.re), CONTEXT)?;
            }
        }
        let mut product = try_vec(nr, 0.0, CONTEXT)?;
        for (j, (a, of_j)) in a.chunks_exact_mut(m).zip(v.chunks_exact(nr.max(1))).enumerate() {
            interrupt.check_before((2 * (placed.len() + nr * j)) as u64)?;
            product.fill(0.0);
            for &(row, column, e) in &placed {
                product[row] += e * of_j[column];
            }
            for (a, of_i) in a.iter_mut().zip(v.chunks_exact(nr.max(1))) {
                *a = of_i.iter().zip(&product).map(|(x, y)| x * y).sum();
            }
        }
        Ok(())
    }
}

/// Adds those parts of a standing wave's mode that are not in the list already. The phase of the mode is arbitrary,
/// as is the mixture of modes of one frequency, so that the real or the imaginary part may be rounding, or equal to a
/// former mode.
fn push_standing(
    motions: &mut Vec<Motion>,
    first: usize,
    shape: &[Complex64],
    (square, diameter, sectors): (f64, i64, usize),
    mass: &Csc,
) -> Result<()> {
    for is_imaginary in [false, true] {
        let mut part = try_vec(shape.len(), Complex64::ZERO, CONTEXT)?;
        for (part, z) in part.iter_mut().zip(shape) {
            *part = if is_imaginary { z.im } else { z.re }.into();
        }
        for _ in 0..2 {
            let heavy = mass.times(&part, CONTEXT)?;
            for motion in &motions[first..] {
                let share: f64 = motion.shape.iter().zip(&heavy).map(|(x, y)| x.re * y.re).sum();
                for (part, x) in part.iter_mut().zip(&motion.shape) {
                    *part -= share * x;
                }
            }
        }
        let heavy = mass.times(&part, CONTEXT)?;
        let length: f64 = part.iter().zip(&heavy).map(|(x, y)| x.re * y.re).sum();
        let length = length.max(0.0).sqrt();
        if length < PART_IS_ROUNDING {
            continue;
        }
        for part in &mut part {
            *part /= length;
        }
        let motion = Motion {
            square,
            diameter,
            is_imaginary: false,
            scale: (sectors as f64).sqrt().recip(),
            shape: part,
        };
        try_push(motions, motion, CONTEXT)?;
    }
    Ok(())
}
