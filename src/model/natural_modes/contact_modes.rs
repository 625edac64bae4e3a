//! Modes of the stuck structure of one nodal diameter as contacts and forces see them: the relative motions of the contacts
//! in each mode, and the static flexibility of all contacts together.
//!
//! Modes of the stuck structure alone know nothing of the vibrations that slipping contacts set free: where most of them slip, those of
//! a structure without contacts are as near. Half of the kept modes come from each, combined so that they diagonalise mass and
//! stiffness.
//!
//! A structure with sticking contacts under forces p of the contacts has the relative motions
//! r = Σ ψ ψᴴ p / (ωₖ² − ω²) over all modes, with ψ = R φ. Those above the kept ones answer like springs:
//! r ≈ Σ_kept + (R K⁻¹ Rᴴ − Σ_kept ψ ψᴴ / ωₖ²) p, as in mode acceleration; what that leaves out falls with
//! (ω / ω_cut)² (Géradin & Rixen, Mechanical Vibrations, 2015, §2.9).

use crate::contact::Contact;
use crate::error::{Result, check_memory, fail, try_copy, try_push, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::dense::eigen::EIGEN_SMALL_UP_TO;
use crate::linalg::dense::fallible_matrix::{filled, zeros};
use crate::linalg::dense::hermitian;
use crate::linalg::factors::shifted_inverse::Inverse;
use crate::linalg::libraries::{DMatrix, SymmetricEigen};
use crate::linalg::sparse_storage::definite::resists_all_motion;
use crate::linalg::sparse_storage::sparse::Csc;
use crate::linalg::{inner, remove};
use crate::model::Model;
use crate::model::matrices::structure::MatrixKind;
use crate::model::matrices::wave::Wave;
use crate::model::natural_modes::linear_modes::ContactState;
use num_complex::Complex64;

const CONTEXT: &str = "the modes of the contacts";

/// Norm of a shape without what shapes before it have in common with it, below which it is no new one.
/// Kind: rounding.
const CONTACT_MODES_DEPENDENT: f64 = 1e-6;

/// Iterations of the eigensolver, far above what converging cases need.
/// Kind: cap.
const CONTACT_MODES_ITERATIONS: usize = 100_000;

/// A force of one harmonic on all independent degrees of freedom.
pub(crate) struct ForceOfWave {
    pub harmonic: usize,
    /// Whether the wave of the force travels against the sense of the modes; its values are then conjugate.
    pub backward: bool,
    pub values: Vec<Complex64>,
}

/// A force as the modes and contacts see it.
pub(crate) struct SeenForce {
    pub harmonic: usize,
    /// Whether the wave of the force travels against the sense of the modes; all numbers then belong to the conjugate
    /// force.
    pub backward: bool,
    /// Modal force φᴴ F of each mode.
    pub modal: Vec<Complex64>,
    /// Static motion R K⁻¹ F of each contact under the force.
    pub static_motion: Vec<Complex64>,
}

/// Modes of one nodal diameter, as contacts and forces see them.
pub(crate) struct ContactModes {
    /// Natural angular frequencies, ascending.
    pub omega: Vec<f64>,
    /// Relative motions ψ = R φ, contact by mode.
    pub rows: DMatrix<Complex64>,
    /// Static flexibility R K⁻¹ Rᴴ of the stuck structure, contact by contact.
    pub flexibility: DMatrix<Complex64>,
    /// Modal damping matrix φᴴ C φ.
    pub damping: DMatrix<Complex64>,
    pub forces: Vec<SeenForce>,
    /// Rows R of the relative motions over the degrees of freedom, contact by contact.
    motions: Vec<Vec<(usize, Complex64)>>,
    /// Images M φ of the mass-normalised shapes, column after column.
    images: Vec<Complex64>,
    n: usize,
}

impl ContactModes {
    /// Computes `modes` modes of a nodal diameter 0 ..= N/2, for contacts of one direction each, and for forces.
    ///
    /// # Errors
    /// `Unsupported` where no stiffness resists some motion of the stuck structure; those of the eigensolvers;
    /// `OutOfMemory`; `StoppedByCaller`.
    pub fn new(
        model: &Model,
        diameter: usize,
        (contacts, forces): (&[&Contact], &[ForceOfWave]),
        modes: usize,
        interrupt: &Interrupt<'_>,
    ) -> Result<Self> {
        let structure = model.structure();
        let n = structure.ndof();
        let wave = Wave::Diameter(diameter as i64);
        let mut pencil = model.pencil(wave, ContactState::Stuck)?;
        pencil.leave_out_gyroscopic();
        if !resists_all_motion(&pencil.stiffness, interrupt)? {
            return fail!(
                Unsupported,
                "nothing holds the structure with sticking contacts in nodal diameter {diameter}"
            );
        }
        let mut released = model.pencil(wave, ContactState::Free)?;
        released.leave_out_gyroscopic();
        let is_real = pencil.stiffness.is_real() && pencil.mass.is_real();
        let both = [
            pencil.lowest(modes.min(n), interrupt)?,
            released.lowest((modes / 2).clamp(1, n), interrupt)?,
        ];
        let [stuck, free] = both.map(|found| found.shapes);
        let shapes = joined(&stuck, &free, modes.min(n), is_real, pencil.weight(), interrupt)?;
        let (omega, shapes) = ritz(&shapes, &pencil.stiffness, is_real, interrupt)?;
        let mut motions = Vec::new();
        for contact in contacts {
            interrupt.check()?;
            let row = structure.row(&structure.contact_motion(contact, 0), wave);
            let mut terms = Vec::new();
            for &term in row.iter().flatten() {
                try_push(&mut terms, term, CONTEXT)?;
            }
            try_push(&mut motions, terms, CONTEXT)?;
        }
        let (count, kept) = (contacts.len(), omega.len());
        let along = |motion: &[(usize, Complex64)], x: &[Complex64]| -> Complex64 {
            motion.iter().map(|&(dof, a)| a * x[dof]).sum()
        };
        let shape = |k: usize| &shapes[k * n..(k + 1) * n];
        let rows = filled(count, kept, CONTEXT, |c, k| along(&motions[c], shape(k)))?;
        let matrix = structure.diameter_matrix(MatrixKind::Damping, diameter as i64)?;
        let mut damping = zeros(kept, kept, CONTEXT)?;
        let mut images = Vec::new();
        for k in 0..kept {
            interrupt.check_before(((kept + 1) * n) as u64)?;
            let image = matrix.times(shape(k), CONTEXT)?;
            for i in 0..kept {
                damping[(i, k)] = inner(shape(i), &image);
            }
            for z in pencil.weight().times(shape(k), CONTEXT)? {
                try_push(&mut images, z, CONTEXT)?;
            }
        }
        let mut inverse = Inverse::new(&pencil.stiffness, (0.0, &pencil.mass), interrupt)?;
        let mut flexibility = zeros(count, count, CONTEXT)?;
        let mut x = try_vec(n, Complex64::ZERO, CONTEXT)?;
        for c in 0..count {
            x.fill(Complex64::ZERO);
            for &(dof, a) in &motions[c] {
                x[dof] += a.conj();
            }
            inverse.solve(&mut x, interrupt)?;
            for (i, motion) in motions.iter().enumerate() {
                flexibility[(i, c)] = along(motion, &x);
            }
        }
        let mut seen = Vec::new();
        for force in forces {
            let mut modal = Vec::new();
            for k in 0..kept {
                interrupt.check_before(n as u64)?;
                try_push(&mut modal, inner(shape(k), &force.values), CONTEXT)?;
            }
            x.copy_from_slice(&force.values);
            inverse.solve(&mut x, interrupt)?;
            let mut static_motion = Vec::new();
            for motion in &motions {
                try_push(&mut static_motion, along(motion, &x), CONTEXT)?;
            }
            let force = SeenForce {
                harmonic: force.harmonic,
                backward: force.backward,
                modal,
                static_motion,
            };
            try_push(&mut seen, force, CONTEXT)?;
        }
        Ok(Self {
            omega,
            rows,
            flexibility,
            damping,
            forces: seen,
            motions,
            images,
            n,
        })
    }

    /// Number of modes computed.
    pub fn modes(&self) -> usize {
        self.omega.len()
    }

    /// Modal coordinates φᴴ M x of a motion x, in the first `modes` modes.
    pub fn coordinates(&self, x: &[Complex64], modes: usize) -> Result<Vec<Complex64>> {
        let mut found = Vec::new();
        for image in self.images.chunks_exact(self.n).take(modes) {
            try_push(&mut found, inner(image, x), CONTEXT)?;
        }
        Ok(found)
    }

    /// Relative motion R x of each contact.
    pub fn relative(&self, x: &[Complex64]) -> Result<Vec<Complex64>> {
        let mut found = Vec::new();
        for motion in &self.motions {
            let r = motion.iter().map(|&(dof, a)| a * x[dof]).sum();
            try_push(&mut found, r, CONTEXT)?;
        }
        Ok(found)
    }
}

/// At most `count` shapes, orthonormal with the mass: half of them from modes with sticking contacts, half from modes
/// without contacts; further ones with sticking contacts replace those that are not independent. For a real structure
/// the shapes are real; an eigensolver may have turned its modes by any phase, and mixed them where frequencies are
/// equal.
fn joined(
    stuck: &[Complex64],
    free: &[Complex64],
    count: usize,
    is_real: bool,
    mass: &Csc,
    interrupt: &Interrupt<'_>,
) -> Result<Vec<Complex64>> {
    let n = mass.rows;
    let (first, further) = stuck.split_at((count.div_ceil(2) * n).min(stuck.len()));
    let all = [first, free, further]
        .into_iter()
        .flat_map(|shapes| shapes.chunks_exact(n));
    let parts: &[fn(Complex64) -> Complex64] = if is_real {
        &[|z| z.re.into(), |z| z.im.into()]
    } else {
        &[|z| z]
    };
    let mut found = Vec::new();
    for shape in all {
        for part in parts {
            if found.len() == count * n {
                return Ok(found);
            }
            interrupt.check_before((4 * (found.len() + n)) as u64)?;
            let mut x = try_copy(shape, CONTEXT)?;
            for z in &mut x {
                *z = part(*z);
            }
            for _ in 0..2 {
                let image = mass.times(&x, CONTEXT)?;
                for column in found.chunks_exact(n) {
                    remove(&mut x, column, inner(column, &image));
                }
            }
            let norm = inner(&x, &mass.times(&x, CONTEXT)?).re.max(0.0).sqrt();
            if norm <= CONTACT_MODES_DEPENDENT {
                continue;
            }
            for z in x {
                try_push(&mut found, z / norm, CONTEXT)?;
            }
        }
    }
    Ok(found)
}

/// Frequencies and shapes within the span of given shapes that diagonalise the stiffness, ascending (Rayleigh and Ritz). The
/// shapes are orthonormal with the mass, and so are the results.
fn ritz(
    shapes: &[Complex64],
    stiffness: &Csc,
    is_real: bool,
    interrupt: &Interrupt<'_>,
) -> Result<(Vec<f64>, Vec<Complex64>)> {
    let n = stiffness.rows;
    let count = shapes.len() / n;
    let shape = |k: usize| &shapes[k * n..(k + 1) * n];
    let mut projected = zeros(count, count, CONTEXT)?;
    for j in 0..count {
        interrupt.check_before(((count + 1) * n) as u64)?;
        let image = stiffness.times(shape(j), CONTEXT)?;
        for i in 0..count {
            projected[(i, j)] = inner(shape(i), &image);
        }
    }
    let (values, vectors) = eigenpairs(projected, is_real, interrupt)?;
    let mut order = Vec::new();
    for k in 0..count {
        try_push(&mut order, k, CONTEXT)?;
    }
    order.sort_by(|&a, &b| values[a].total_cmp(&values[b]));
    let mut omega = Vec::new();
    let mut found = try_vec(n * count, Complex64::ZERO, CONTEXT)?;
    for (to, &k) in found.chunks_exact_mut(n.max(1)).zip(&order) {
        interrupt.check_before((count * n) as u64)?;
        try_push(&mut omega, values[k].max(0.0).sqrt(), CONTEXT)?;
        for j in 0..count {
            remove(to, shape(j), -vectors[(j, k)]);
        }
    }
    Ok((omega, found))
}

/// Eigenvalues and orthonormal vectors of a Hermitian matrix, in any order; vectors of a real one are real.
fn eigenpairs(
    mut matrix: DMatrix<Complex64>,
    is_real: bool,
    interrupt: &Interrupt<'_>,
) -> Result<(Vec<f64>, DMatrix<Complex64>)> {
    let count = matrix.nrows();
    if count > EIGEN_SMALL_UP_TO {
        let (values, mut vectors) = hermitian::eigen(matrix.as_mut_slice(), count, interrupt)?;
        if is_real {
            // Reflections of real columns are real to the last bit: no phase is cut off.
            for z in &mut vectors {
                z.im = 0.0;
            }
        }
        return Ok((values, DMatrix::from_vec(count, count, vectors)));
    }
    interrupt.check_before((10 * count.pow(3)) as u64)?;
    check_memory::<Complex64>(4 * count * count, CONTEXT)?;
    let found = if is_real {
        SymmetricEigen::try_new(matrix.map(|z| z.re), f64::EPSILON, CONTACT_MODES_ITERATIONS)
            .map(|found| (found.eigenvalues, found.eigenvectors.map(Complex64::from)))
    } else {
        SymmetricEigen::try_new(matrix, f64::EPSILON, CONTACT_MODES_ITERATIONS)
            .map(|found| (found.eigenvalues, found.eigenvectors))
    };
    let Some((values, vectors)) = found else {
        return fail!(NoConvergence, "the modes of the stuck structure were not found");
    };
    Ok((try_copy(values.as_slice(), CONTEXT)?, vectors))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A cut-off imaginary part would be a phase that is lost.
    #[test]
    fn vectors_of_a_large_real_matrix_are_real() {
        let n = EIGEN_SMALL_UP_TO + 20;
        let entry = |i: usize, j: usize| {
            let own = if i == j { 3.0 * (i + 1) as f64 } else { 0.0 };
            Complex64::from(own + (((i * j) % 17 + i + j) as f64 * 0.7).sin())
        };
        let mut matrix = DMatrix::from_fn(n, n, entry);
        let (_, vectors) = hermitian::eigen(matrix.as_mut_slice(), n, &Interrupt::none()).unwrap();
        assert!(vectors.iter().all(|z| z.im == 0.0));
        let (values, vectors) = eigenpairs(DMatrix::from_fn(n, n, entry), true, &Interrupt::none()).unwrap();
        let matrix = DMatrix::from_fn(n, n, entry);
        for (k, value) in values.iter().enumerate() {
            let column = vectors.column(k);
            let rest = &matrix * column - column * Complex64::from(*value);
            assert!(rest.norm() < 1e-11, "{k}: {}", rest.norm());
        }
    }
}
