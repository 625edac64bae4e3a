//! The matrices of a wave that is reduced, checked, and the form of its damping.

use crate::condense::by_modes::few_directions::{FewDirections, few_directions};
use crate::condense::by_modes::wave_modes::proportional;
use crate::error::{Result, try_push};
use crate::interrupt::Interrupt;
use crate::linalg::iterative::block_krylov::SparseVector;
use crate::linalg::sparse_storage::sparse::{Columns, Csc, Form, Symmetry, aligned, worst_pair};
use crate::model::Model;
use crate::model::few_motions::reduced_wave::WaveKey;
use crate::model::matrices::modal_directions::split_damping;
use crate::model::matrices::structure::MatrixKind;
use crate::model::matrices::wave::Wave;
use crate::model::matrices::wave_matrix::WaveMatrix;
use num_complex::Complex64;

const CONTEXT: &str = "the damping of a wave";

/// Relative deviation from a Hermitian matrix that is rounding.
/// Kind: rounding.
const WAVE_MATRICES_HERMITIAN: f64 = 1e-10;

/// The matrices of a wave and the reason for which they are reduced.
pub(crate) struct WaveMatrices<'a> {
    pub model: &'a Model,
    pub number: usize,
    pub conjugated: bool,
    pub key: WaveKey,
    pub frequency: f64,
    /// Factors that the basis competes with; `None` where a basis is tried in any case.
    pub instead_of: Option<Factors>,
    pub memory_limit: usize,
    /// Loss factor of the stiffness in samples of the motion; `None` where complex factors of the wave are too large for samples.
    pub sampled_with: Option<f64>,
}

/// Size and use of the factors that a basis competes with.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Factors {
    /// Highest angular frequency at which the wave is needed.
    pub highest: f64,
    /// Number of carried harmonics that belong to the wave.
    pub harmonics: usize,
    /// Whether factors are needed along a range of frequencies.
    pub along_range: bool,
    /// Whether all modes or poles are possible, whose work the basis was compared with before.
    pub beside_modes: bool,
}

/// Assembled matrices of a wave: K, M and the damping.
pub(crate) struct Assembled<'a> {
    pub stiffness: WaveMatrix<'a>,
    pub mass: WaveMatrix<'a>,
    pub damping: Damping,
}

/// Damping, as αM + βK with few further directions, or as a matrix.
pub(crate) enum Damping {
    Proportional(f64, f64),
    /// αM + βK and few further directions.
    Few(FewDirections),
    General(Csc),
}

impl WaveMatrices<'_> {
    fn matrix(&self, kind: MatrixKind) -> Result<WaveMatrix<'_>> {
        self.model
            .structure()
            .matrix_of_wave(kind, self.number, self.conjugated)
    }

    /// Damping of the wave without that of few modes, and the directions of these.
    fn split_damping(&self, interrupt: &Interrupt<'_>) -> Result<(WaveMatrix<'_>, Vec<SparseVector>)> {
        let wave = Wave::Harmonic(self.number);
        let Some((mut rest, mut modal)) = split_damping(self.model.structure(), wave, interrupt)? else {
            return Ok((self.matrix(MatrixKind::Damping)?, Vec::new()));
        };
        if self.conjugated {
            let entries = modal.iter_mut().flatten().map(|(_, z)| z);
            for z in rest.values.iter_mut().chain(entries) {
                *z = z.conj();
            }
        }
        Ok((WaveMatrix::Made(rest), modal))
    }

    /// Assembles K, M and damping of the wave; `None` where stiffness or mass is not Hermitian.
    pub fn assembled(&self, interrupt: &Interrupt<'_>) -> Result<Option<Assembled<'_>>> {
        let structure = self.model.structure();
        let stiffness = match self.matrix(MatrixKind::Stiffness)? {
            // The loss of a complex stiffness is one factor, which the blocks know.
            WaveMatrix::Made(made) => WaveMatrix::Made(structure.elastic(made)?),
            kept @ WaveMatrix::Kept(_) => kept,
        };
        interrupt.check()?;
        let mass = self.matrix(MatrixKind::Mass)?;
        for a in [&stiffness, &mass] {
            interrupt.check()?;
            if worst_pair(a, Symmetry::Hermitian).2 > WAVE_MATRICES_HERMITIAN * a.max_abs() {
                return Ok(None);
            }
        }
        let damping =
            if structure.has(MatrixKind::Damping) || structure.has_modal_damping() || structure.is_gyroscopic() {
                let (c, modal) = self.split_damping(interrupt)?;
                let (none, n) = (Complex64::ZERO, c.columns());
                let terms = [&mass, &stiffness, &c].map(|a| (none, a, Form::Plain));
                let pattern = Csc::sum(n, &terms)?;
                let aligned = [
                    aligned(&mass, &pattern)?,
                    aligned(&stiffness, &pattern)?,
                    aligned(&c, &pattern)?,
                ];
                let aligned = [&aligned[0][..], &aligned[1], &aligned[2]];
                let proportional = proportional(aligned);
                let few = match proportional {
                    Some(proportional) => Some(FewDirections {
                        proportional,
                        directions: Vec::new(),
                        middle: None,
                    }),
                    None => few_directions(&pattern, aligned, structure.rayleigh, interrupt)?,
                };
                match (proportional, few) {
                    (Some((alpha, beta)), _) if modal.is_empty() => Damping::Proportional(alpha, beta),
                    (_, Some(mut few)) if modal.is_empty() || few.middle.is_none() => {
                        for direction in modal {
                            try_push(&mut few.directions, direction, CONTEXT)?;
                        }
                        Damping::Few(few)
                    }
                    _ if modal.is_empty() => Damping::General(c.into_csc()?),
                    _ => Damping::General(self.matrix(MatrixKind::Damping)?.into_csc()?),
                }
            } else {
                let (alpha, beta) = structure.rayleigh;
                Damping::Proportional(alpha, beta)
            };
        Ok(Some(Assembled {
            stiffness,
            mass,
            damping,
        }))
    }
}
