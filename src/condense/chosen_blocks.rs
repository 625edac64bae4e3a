//! The blocks of all carried harmonics: on bases, as those of a wheel that is tuned but for terms of low rank, or on all degrees of freedom.

use crate::condense::blocks::harmonic_block::{Artificial, HarmonicBlock, harmonic_block, of_same_wave, shared_block};
use crate::condense::blocks::memory_limit::{within_directly, within_matrices};
use crate::condense::by_modes::wave_cache::ALL_UP_TO;
use crate::condense::on_a_basis::basis_outlook::is_tuned_quicker;
use crate::condense::on_a_basis::wave_reduction::{Request, reduced_blocks};
use crate::condense::tuned_wheel::tuned_plan::TunedPlan;
use crate::error::{Result, try_push};
use crate::interrupt::{Interrupt, Phase};
use crate::model::matrices::structure::MatrixKind;
use crate::options::{DampingForm, Flexibility};
use num_complex::Complex64;
use std::sync::Arc;

/// Degrees of freedom of a wheel from which tables of the tuned one take less time than sums over all modes.
/// Kind: tuned; measured on: wheels of 24
/// sectors with 4 to 25 degrees of freedom and a contact each.
const TUNED_FROM: usize = 200;

/// The same up to which a single frequency takes factors of all sectors: their rounding is a tenth of that of the waves', which are not
/// ordered by their fill.
/// Kind: tuned; measured on: a wheel of 1,080, whose factors take 60 ms.
const FACTORED_AT_ONE_UP_TO: usize = 2_000;

/// The blocks, with the data of the chosen flexibility: basis, tuned wheel or all degrees of freedom.
pub(super) struct Chosen {
    pub blocks: Vec<HarmonicBlock>,
    /// Estimated relative error of the bases; 0 without bases.
    pub certificate: f64,
    pub tuned: Option<Arc<TunedPlan>>,
}

/// The blocks of all carried harmonics, with artificial damping if the problem is a nonlinear mode.
///
/// # Errors
/// `Unsupported` where a basis was requested for a structure without one; `OutOfMemory`; `StoppedByCaller`.
pub(super) fn chosen_blocks(
    request: &Request<'_>,
    mode: Option<DampingForm>,
    kappa: impl Fn(usize, usize) -> Complex64,
    interrupt: &Interrupt<'_>,
) -> Result<Chosen> {
    if mode.is_none() {
        if let Some((blocks, plan)) = tuned_blocks(request, &kappa, interrupt)? {
            return Ok(Chosen {
                blocks,
                certificate: 0.0,
                tuned: Some(plan),
            });
        }
        if let Some((blocks, certificate)) = reduced_blocks(request, &kappa, interrupt)? {
            return Ok(Chosen {
                blocks,
                certificate,
                tuned: None,
            });
        }
    }
    within_directly(request.options.memory_limit, request.model, request.numbers)?;
    Ok(Chosen {
        blocks: direct_blocks(request, mode, kappa, interrupt)?,
        certificate: 0.0,
        tuned: None,
    })
}

/// The blocks of a wheel that is tuned but for terms of low rank, where these take less time than factors or modes of
/// the whole wheel; else `None`.
fn tuned_blocks(
    request: &Request<'_>,
    kappa: impl Fn(usize, usize) -> Complex64,
    interrupt: &Interrupt<'_>,
) -> Result<Option<(Vec<HarmonicBlock>, Arc<TunedPlan>)>> {
    let structure = request.model.structure();
    let Some((sectors, _)) = structure.whole_wheel() else {
        return Ok(None);
    };
    if request.options.flexibility != Flexibility::Automatic || !may_be_tuned(request) {
        return Ok(None);
    }
    within_matrices(request.options.memory_limit, request.model, request.numbers)?;
    let blocks = direct_blocks(request, None, kappa, interrupt)?;
    let Some(plan) = TunedPlan::new(&blocks, sectors, interrupt)? else {
        return Ok(None);
    };
    let is_quicker = is_tuned_quicker(&plan, &blocks)?;
    Ok(is_quicker.then(|| (blocks, Arc::new(plan))))
}

/// Whether a wheel has so many degrees of freedom that sums over all its modes are impossible or slower. Estimates of
/// errors need many harmonics, and take the modes of small wheels. At a single frequency few factors are needed.
fn may_be_tuned(request: &Request<'_>) -> bool {
    let n = request.model.structure().ndof();
    if request.sweep.is_single() {
        return n > FACTORED_AT_ONE_UP_TO;
    }
    n > ALL_UP_TO || (n >= TUNED_FROM && request.options.tolerance == 0.0)
}

/// The blocks of all carried harmonics on all degrees of freedom, with artificial damping if the problem is a
/// nonlinear mode.
fn direct_blocks(
    request: &Request<'_>,
    mode: Option<DampingForm>,
    kappa: impl Fn(usize, usize) -> Complex64,
    interrupt: &Interrupt<'_>,
) -> Result<Vec<HarmonicBlock>> {
    let (model, numbers) = (request.model, request.numbers);
    let mut blocks = Vec::new();
    for (i, &number) in numbers.iter().enumerate() {
        interrupt.part(Phase::Condensation, i, numbers.len())?;
        let mut block = match of_same_wave(model, number, &blocks.iter()) {
            Some(known) => shared_block(model, number, known, request.contacts, &kappa)?,
            None => harmonic_block(model, number, request.contacts, |c| kappa(c, number), interrupt)?,
        };
        block.matrices.artificial = match mode {
            None => Artificial::None,
            Some(DampingForm::Mass) => Artificial::Mass,
            Some(DampingForm::Stiffness) => {
                let structure = model.structure().wave_matrix(MatrixKind::Stiffness, number)?;
                Artificial::Stiffness(structure.aligned(&block.matrices.reference)?)
            }
        };
        try_push(&mut blocks, block, "the matrices per harmonic")?;
    }
    Ok(blocks)
}
