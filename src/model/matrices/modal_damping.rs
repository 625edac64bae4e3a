//! Damping ratios of natural modes as a damping matrix: C = Σ 2 ζ_r ω_r (M φ_r)(M φ_r)ᴴ with φ_rᴴ M φ_r = 1, for each
//! nodal diameter. Motions outside these modes are not damped (Wilson & Penzien 1972, doi:10.1002/eqe.4290010305).

use crate::error::{Error, Result, Status, fail, try_push, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::sparse_storage::kept_matrix::KeptMatrix;
use crate::linalg::sparse_storage::sparse::Csc;
use crate::model::Model;
use crate::model::matrices::speed::Speed;
use crate::model::matrices::wave::Wave;
use crate::model::natural_modes::linear_modes::ContactState;
use num_complex::Complex64;

/// Degrees of freedom up to which the matrix, which has no zero entries, is affordable.
/// Kind: cap.
const MODAL_DAMPING_MOST: usize = 2000;

/// Entries of the matrix below this share of those on the diagonal of their row and column are rounding.
/// Kind: rounding.
const MODAL_DAMPING_ROUNDING: f64 = 1e-16;

const CONTEXT: &str = "the modal damping";

/// Sets modal damping as `set_modal_damping` does, and the caller may stop it.
pub(crate) fn set_modal_damping_with(model: &mut Model, ratios: &[f64], interrupt: &Interrupt<'_>) -> Result<()> {
    for (r, &ratio) in ratios.iter().enumerate() {
        if !ratio.is_finite() {
            return fail!(NotFinite, "ratios[{r}] = {ratio}, needs a finite number >= 0");
        }
        if ratio < 0.0 {
            return fail!(
                Argument,
                "ratios[{r}] = {ratio}, needs a number >= 0: positive dissipates"
            );
        }
    }
    let mut matrices = Vec::new();
    if !ratios.is_empty() {
        let n = model.structure().ndof();
        if n > MODAL_DAMPING_MOST {
            return fail!(
                Unsupported,
                "modal damping of {n} degrees of freedom: its matrix is full, and needs at most {MODAL_DAMPING_MOST}; use \
                 Rayleigh damping, a loss factor or a reduced model"
            );
        }
        model.check_matrices(true)?;
        // The modes at rest.
        let mut standing = model.try_clone()?;
        standing.structure_mut().speed = Speed::Fixed(0.0);
        let sectors = model.structure().sectors();
        let own_sense = |residue: &usize| model.structure().has_own_sense(*residue);
        let last = (sectors / 2 + 1..sectors).rfind(own_sense).unwrap_or(sectors / 2);
        for residue in 0..=if last > sectors / 2 { sectors - 1 } else { last } {
            // The matrix of such a wave is the conjugate of that of the other sense.
            if residue > sectors / 2 && !own_sense(&residue) {
                try_push(&mut matrices, None, CONTEXT)?;
                continue;
            }
            let matrix = match modal_damping_matrix(&standing, residue as i64, ratios, interrupt) {
                // A diameter whose matrices were not given has no modes.
                Err(e) if e.status == Status::Argument && !model.structure().has_diameter(residue) => None,
                matrix => Some(matrix.map_err(|e| at_diameter(e, model, residue))?),
            };
            try_push(&mut matrices, matrix, CONTEXT)?;
        }
    }
    model.structure_mut().modal_damping = matrices;
    Ok(())
}

fn modal_damping_matrix(model: &Model, diameter: i64, ratios: &[f64], interrupt: &Interrupt<'_>) -> Result<KeptMatrix> {
    let pencil = model.pencil(Wave::Diameter(diameter), ContactState::Free)?;
    let modes = pencil.lowest(ratios.len(), interrupt)?;
    let found = modes.omega.len();
    if found < ratios.len() {
        return fail!(
            Argument,
            "ratios[{found}] = {} has no mode: the structure has {found}",
            ratios[found]
        );
    }
    if let Some(r) = (0..found).find(|&r| modes.omega[r] < 0.0) {
        return fail!(
            Argument,
            "ratios[{r}] = {} belongs to a motion that grows, as {:e} per time unit: its stiffness is negative",
            ratios[r],
            -modes.omega[r]
        );
    }
    let n = pencil.mass.rows;
    let is_real = [&pencil.mass, &pencil.stiffness]
        .iter()
        .all(|a| a.values.iter().all(|v| v.im == 0.0));
    let mut entries: Vec<(usize, usize, Complex64)> = Vec::new();
    entries
        .try_reserve_exact(n * n)
        .map_err(|_| Error::out_of_memory(CONTEXT))?;
    entries.extend((0..n * n).map(|k| (k % n, k / n, Complex64::ZERO)));
    for ((ratio, omega), shape) in ratios.iter().zip(&modes.omega).zip(modes.shapes.chunks_exact(n)) {
        interrupt.check()?;
        let inertia = pencil.mass.times(shape, CONTEXT)?;
        let factor = 2.0 * ratio * omega;
        for (i, j, v) in &mut entries {
            *v += factor * inertia[*i] * inertia[*j].conj();
        }
    }
    let mut own = try_vec(n, 0.0, CONTEXT)?;
    for (own, (.., v)) in own.iter_mut().zip(entries.iter().step_by(n + 1)) {
        *own = v.re.sqrt();
    }
    if is_real {
        for (.., v) in &mut entries {
            v.im = 0.0;
        }
    }
    entries.retain(|(i, j, v)| v.norm() > MODAL_DAMPING_ROUNDING * own[*i] * own[*j]);
    KeptMatrix::new(Csc::from_triplets(n, n, entries)?)
}

fn at_diameter(e: Error, model: &Model, residue: usize) -> Error {
    if model.structure().sectors() == 1 {
        return e;
    }
    let diameter = model.structure().signed_diameter(residue as i64);
    e.at(format_args!("nodal diameter {diameter}"))
}
