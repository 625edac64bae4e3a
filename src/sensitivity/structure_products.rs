//! Products of the adjoint motion with derivatives of the structure: Re Σ_h Λ_hᴴ ∂Z_h/∂p x_h.
//!
//! Z_h = K − h²ω²M + ihωC + iηK (h > 0), with Rayleigh damping C = C₀ + αM + βK and, in a nonlinear mode, the artificial
//! damping −2ihDω²M or −2ihDK. Rayleigh damping and the loss factor follow the matrices, as they do in a model whose
//! matrices are set anew.

use crate::condense::{Artificial, Condensed};
use crate::error::{Result, fail, try_push, try_vec};
use crate::linalg::inner;
use crate::linalg::sparse_storage::matrix_view::MatrixView;
use crate::linalg::sparse_storage::sparse::Csc;
use crate::model::Model;
use crate::model::matrices::aero::AeroForm;
use crate::model::matrices::structure::MatrixKind;
use crate::model::matrices::wave::Wave;
use crate::sensitivity::adjoint::{Adjoint, CONTEXT};
use num_complex::Complex64;

/// Derivative of Z_h by a matrix: the factor of this matrix in the dynamic stiffness of the i-th carried harmonic.
fn factor(model: &Model, condensed: &Condensed, adjoint: &Adjoint, i: usize, which: MatrixKind) -> Complex64 {
    let block = &condensed.blocks()[i];
    let h = block.number as f64;
    let (hw, damping) = (h * adjoint.omega, adjoint.damping);
    let (alpha, beta) = model.structure().rayleigh;
    let rate = Complex64::new(0.0, hw);
    match which {
        MatrixKind::Mass => {
            let artificial = match block.matrices.artificial {
                Artificial::Mass => -2.0 * hw * adjoint.omega * damping,
                Artificial::None | Artificial::Stiffness(_) => 0.0,
            };
            Complex64::new(-hw * hw, artificial) + alpha * rate
        }
        MatrixKind::Stiffness => {
            let artificial = match block.matrices.artificial {
                Artificial::Stiffness(_) => -2.0 * h * damping,
                Artificial::None | Artificial::Mass => 0.0,
            };
            let loss = if block.number == 0 {
                0.0
            } else {
                model.structure().loss_factor()
            };
            Complex64::new(1.0, artificial + loss) + beta * rate
        }
        MatrixKind::Damping | MatrixKind::Gyroscopic => rate,
        MatrixKind::Structural => Complex64::I,
        MatrixKind::StiffnessSpeed2 => Complex64::ONE,
    }
}

/// Sum over the harmonics of the products with a matrix, whose sesquilinear form in the i-th carried harmonic is
/// `form`; the change of the normalisation of a mode included.
fn sum(
    model: &Model,
    condensed: &Condensed,
    adjoint: &Adjoint,
    which: MatrixKind,
    mut form: impl FnMut(usize, &[Complex64], &[Complex64]) -> Result<Complex64>,
) -> Result<f64> {
    let structure = model.structure();
    let elastic_alone = structure.rayleigh.1 != 0.0
        || structure.loss_factor() != 0.0
        || condensed
            .blocks()
            .iter()
            .any(|b| matches!(b.matrices.artificial, Artificial::Stiffness(_)));
    if which == MatrixKind::Stiffness && elastic_alone && structure.has_complex_stiffness() {
        return fail!(
            Unsupported,
            "derivatives by a complex symmetric stiffness are not provided beside a loss factor, Rayleigh damping of the \
             stiffness or artificial damping of the stiffness type: give its loss as structural matrix"
        );
    }
    let mut total = 0.0;
    for (i, block) in condensed.blocks().iter().enumerate() {
        let (x, field) = adjoint.harmonic(condensed, i);
        total += (factor(model, condensed, adjoint, i, which) * form(i, field, x)?).re;
        if which == MatrixKind::Mass && block.number == 1 && adjoint.normalisation != 0.0 {
            total -= adjoint.normalisation * form(i, x, x)?.re;
        }
    }
    Ok(total)
}

/// The product with a direction over the caller's degrees of freedom.
///
/// # Errors
/// Those of [`MatrixView::copy_in`]; `OutOfMemory`.
pub(super) fn with_direction(
    model: &Model,
    condensed: &Condensed,
    adjoint: &Adjoint,
    which: MatrixKind,
    direction: &MatrixView<'_>,
) -> Result<f64> {
    let degrees = condensed.degrees();
    let given = degrees.given();
    let matrix = direction.copy_in("direction", given)?;
    let real = real_part(&matrix)?;
    let mut left = try_vec(given, Complex64::ZERO, CONTEXT)?;
    let mut right = try_vec(given, Complex64::ZERO, CONTEXT)?;
    sum(model, condensed, adjoint, which, |i, a, b| {
        let block = &condensed.blocks()[i];
        degrees.expand(block.next, a, &mut left);
        degrees.expand(block.next, b, &mut right);
        let matrix = if block.number == 0 { &real } else { &matrix };
        Ok(inner(&left, &matrix.times(&right, CONTEXT)?))
    })
}

/// Matrices of the waves that a factor multiplies, made once for all results and points of one model.
#[derive(Debug, Default)]
pub(crate) struct WaveMatrices {
    known: Vec<(MatrixKind, usize, Vec<Csc>)>,
}

impl WaveMatrices {
    /// The matrix of a harmonic; and those which the wave's matrix contains although they are no part of it.
    fn of(&mut self, model: &Model, which: MatrixKind, number: usize) -> Result<&[Csc]> {
        let position = self.known.iter().position(|(a, b, _)| (*a, *b) == (which, number));
        let position = if let Some(position) = position {
            position
        } else {
            let structure = model.structure();
            let mut made = Vec::new();
            try_push(&mut made, structure.wave_matrix(which, number)?, CONTEXT)?;
            if which == MatrixKind::Damping {
                let wave = Wave::Harmonic(number);
                let gyroscopic = structure.gyroscopic_at_speed(wave)?;
                let aero = structure.aero_of_wave(AeroForm::Velocity, wave)?;
                for part in [gyroscopic, aero].into_iter().flatten() {
                    try_push(&mut made, part, CONTEXT)?;
                }
            }
            try_push(&mut self.known, (which, number, made), CONTEXT)?;
            self.known.len() - 1
        };
        Ok(&self.known[position].2)
    }
}

/// The product with a whole matrix, as it is needed for a factor on it.
pub(super) fn with_whole(
    model: &Model,
    condensed: &Condensed,
    adjoint: &Adjoint,
    which: MatrixKind,
    matrices: &mut WaveMatrices,
) -> Result<f64> {
    sum(model, condensed, adjoint, which, |i, a, b| {
        let number = condensed.blocks()[i].number;
        let Some((matrix, others)) = matrices.of(model, which, number)?.split_first() else {
            return fail!(Internal, "a matrix is missing");
        };
        let mut product = matrix.times(b, CONTEXT)?;
        for other in others {
            other.multiply_add(-Complex64::ONE, b, &mut product);
        }
        Ok(inner(a, &product))
    })
}

/// The product with the derivative of the matrices by a fixed speed Ω: 2ΩK₁ + ihωG.
pub(super) fn with_speed(
    model: &Model,
    condensed: &Condensed,
    adjoint: &Adjoint,
    speed: f64,
    matrices: &mut WaveMatrices,
) -> Result<f64> {
    let mut total = 0.0;
    for (which, scale) in [
        (MatrixKind::StiffnessSpeed2, 2.0 * speed),
        (MatrixKind::Gyroscopic, 1.0),
    ] {
        if model.structure().has(which) && scale != 0.0 {
            total += scale * with_whole(model, condensed, adjoint, which, &mut *matrices)?;
        }
    }
    Ok(total)
}

fn real_part(matrix: &Csc) -> Result<Csc> {
    let mut real = matrix.try_clone()?;
    for v in &mut real.values {
        v.im = 0.0;
    }
    Ok(real)
}
