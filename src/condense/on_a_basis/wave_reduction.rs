//! The structure of each wave on a block Krylov basis: from what the model has kept, or prepared.
//!
//! One definite factorisation of K + σM serves all frequencies of a nodal diameter. The basis holds the motions under unit
//! forces at every contact, spring and excited degree of freedom and at the response; since springs and contacts act
//! through these, it does not depend on their constants.

use crate::condense::HarmonicBlock;
use crate::condense::blocks::contact_classes::ContactClasses;
use crate::condense::by_modes::wave_cache::{ALL_UP_TO, are_all_modes_wanted};
use crate::condense::on_a_basis::basis_outlook::{SweepTables, USUAL_COLUMNS};
use crate::condense::on_a_basis::certificate::{Certificate, certificate, is_sampled};
use crate::condense::on_a_basis::krylov_wave::{MOST_BLOCKS, MOST_COLUMNS, prepare};
use crate::condense::on_a_basis::reduced_block::reduced_block;
use crate::condense::on_a_basis::wave_matrices::{Factors, WaveMatrices};
use crate::error::{Result, Status, fail, try_copy, try_push, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::iterative::block_krylov::SparseVector;
use crate::model::Model;
use crate::model::few_motions::reduced_wave::{ReducedView, ReducedWave, WaveKey};
use crate::model::matrices::sector_motion::MOTION_TERMS;
use crate::model::matrices::speed::Speed;
use crate::model::matrices::spring::Row;
use crate::model::matrices::structure::MatrixKind;
use crate::model::matrices::wave::Wave;
use crate::options::Range;
use crate::options::{Flexibility, SolverOptions};
use num_complex::Complex64;
use std::fmt::Arguments;
use std::sync::Arc;

const CONTEXT: &str = "the reduced structure";

/// Degrees of freedom up to which results have all digits: a basis errs by its certificate.
/// Kind: tuned; measured on: not recorded.
pub(crate) const EXACT_UP_TO: usize = 100;

/// Certificate of a basis in place of all modes: the error that is allowed to a sum over these.
/// Kind: rounding.
const OF_ALL_MODES: f64 = 1e-11;

/// Degrees of freedom over columns of the first block, below which the usual basis is larger than it may be.
/// Kind: tuned; measured on: not recorded.
const WAVE_REDUCTION_SHARE: usize = SHARE_OF_BASIS * USUAL_COLUMNS.0;

/// The same over all columns: a sweep past more resonances than that is left to all modes, or to factors.
/// Kind: tuned; measured on: not recorded.
const SHARE_OF_BASIS: usize = 3;

/// Work of all modes over n³, and of a basis over the harmonics and the cube of its usual columns, in flops of one speed: by times of
/// chains of 101 to 600 degrees of freedom with 1 to 10 contacts.
/// Kind: tuned; measured on: times of chains.
const OF_MODES: f64 = 20.0;
const OF_POLES: f64 = 200.0;
const OF_BASIS: f64 = 480.0;

/// Degrees of freedom up to which a structure whose basis does not hold is treated directly.
/// Kind: tuned; measured on: not recorded.
const WAVE_REDUCTION_DIRECT_UP_TO: usize = 20_000;

/// Error with rounding, as the certificate tells it, beyond which a basis is not used in place of factors, and beyond which it is not used
/// at all: stiffness of a penalty is lost in the soft motions of the basis, while factors keep them.
/// Kind: rounding.
const ROUNDED_BASIS: f64 = 1e-5;
const USELESS_BASIS: f64 = 1e-2;

/// Forces on more degrees of freedom than this in one harmonic count as one vector.
/// Kind: tuned; measured on: not recorded.
const SEPARATE_FORCES: usize = 8;

/// The model and the motions that a reduction must represent.
pub(crate) struct Request<'a> {
    pub model: &'a Model,
    pub options: &'a SolverOptions,
    pub numbers: &'a [usize],
    pub contacts: (&'a ContactClasses, &'a [(usize, usize)]),
    pub sweep: Range,
    /// Loss factor η of the whole stiffness; `None` where a complex stiffness has another form.
    pub loss_factor: Option<f64>,
}

impl Request<'_> {
    fn is_forced(&self) -> bool {
        self.options.flexibility == Flexibility::Krylov
    }

    fn ndof(&self) -> usize {
        self.model.structure().ndof()
    }
}

/// A wave with the carried harmonics that belong to it.
struct Group {
    key: WaveKey,
    /// Index among the carried harmonics, and whether the matrices of this harmonic are the conjugate ones.
    members: Vec<(usize, bool)>,
    inputs: Vec<SparseVector>,
}

/// The blocks of all carried harmonics on the bases of their waves, and the largest certificate; `None` where the direct
/// way is taken.
///
/// # Errors
/// `Unsupported` where a basis was requested for a structure without one; `OutOfMemory`; `StoppedByCaller`.
pub(crate) fn reduced_blocks(
    request: &Request<'_>,
    kappa: impl Fn(usize, usize) -> Complex64,
    interrupt: &Interrupt<'_>,
) -> Result<Option<(Vec<HarmonicBlock>, f64)>> {
    let (model, options) = (request.model, request.options);
    let (n, forced) = (request.ndof(), request.is_forced());
    if options.flexibility == Flexibility::Direct || (!forced && n <= EXACT_UP_TO) {
        return Ok(None);
    }
    let structure = model.structure();
    // A basis knows mass, viscous damping, stiffness and its loss factor, and forces of one size.
    if structure.has_structural_matrix()
        || request.loss_factor.is_none()
        || (structure.is_rotating() && !may_rotate(request))
        || structure.has_aero()
        || model.excitation().has_unbalance()
    {
        return declined(forced);
    }
    let most = if forced { usize::MAX } else { n / WAVE_REDUCTION_SHARE };
    let Some(groups) = groups(request, most, interrupt)? else {
        return Ok(None);
    };
    if groups.iter().any(|group| group.inputs.is_empty()) || !(forced || pays(request, &groups, interrupt)?) {
        return Ok(None);
    }
    let mut views = try_vec(request.numbers.len(), None, CONTEXT)?;
    let mut worst = Certificate::default();
    for group in &groups {
        let is_optional = !forced && n <= WAVE_REDUCTION_DIRECT_UP_TO;
        let (wave, error) = match wave_of(request, group, &kappa, interrupt) {
            Ok(Some(found)) => found,
            Ok(None) => return declined(forced),
            Err(e) if is_optional && e.status == Status::NoConvergence => return Ok(None),
            Err(e) if e.status == Status::NoConvergence => return spoilt(format_args!("{}", e.message())),
            Err(e) => return Err(e),
        };
        worst = worst.max(error);
        if is_optional && (error.basis > limit(request) || error.total > ROUNDED_BASIS || error.total.is_nan()) {
            return Ok(None);
        }
        // NaN is no certificate either.
        if error.total.is_nan() || error.total > USELESS_BASIS {
            return spoilt(format_args!(
                "its motions err by {:e}, rounding included, needs at most {USELESS_BASIS}",
                error.total
            ));
        }
        for &(i, conjugated) in &group.members {
            let wave = Arc::clone(&wave);
            views[i] = Some(ReducedView { wave, conjugated });
        }
    }
    let order = views
        .iter()
        .flatten()
        .map(|view| view.pencil().order())
        .max()
        .unwrap_or(0);
    let loss = request.loss_factor.unwrap_or(0.0);
    let mut blocks = Vec::new();
    for (view, &number) in views.into_iter().flatten().zip(request.numbers) {
        let block = reduced_block(
            model,
            number,
            request.contacts,
            |c| kappa(c, number),
            (view, order, loss),
        )?;
        try_push(&mut blocks, block, CONTEXT)?;
    }
    Ok(Some((blocks, worst.total)))
}

/// Whether gyroscopic forces are a damping matrix that a basis knows: the speed is fixed and stiffens nothing. Up to the size of all
/// modes their poles, or factors, take less time, and beside modal damping factors with a term of low rank.
fn may_rotate(request: &Request<'_>) -> bool {
    let structure = request.model.structure();
    matches!(structure.speed, Speed::Fixed(_))
        && !structure.has(MatrixKind::StiffnessSpeed2)
        && !structure.has_modal_damping()
        && (request.is_forced() || (request.ndof() > ALL_UP_TO && !request.sweep.is_single()))
}

/// Refuses a basis that rounding spoils.
fn spoilt<T>(reason: Arguments<'_>) -> Result<T> {
    fail!(
        NoConvergence,
        "flexibility on a basis: {reason}; take flexibility = direct, or a narrower range. Where some stiffness is far above that of the \
         structure, as of a penalty, make what it connects one degree of freedom"
    )
}

/// Largest allowed error by motions that a basis lacks. Where all modes are an alternative, the basis must be as
/// exact as they are.
fn limit(request: &Request<'_>) -> f64 {
    let asked = request.options.certificate;
    if request.is_forced() || request.ndof() > ALL_UP_TO {
        asked
    } else {
        asked.min(OF_ALL_MODES)
    }
}

/// Whether a basis takes less time than all modes, where these are possible. Estimates of errors need so many
/// harmonics that they take the modes.
fn pays(request: &Request<'_>, groups: &[Group], interrupt: &Interrupt<'_>) -> Result<bool> {
    let n = request.ndof();
    let is_estimated = request.options.tolerance > 0.0 && !request.sweep.is_single();
    if n > ALL_UP_TO {
        let tables = SweepTables {
            harmonics: request.numbers.len(),
            contacts: request.contacts.1.len(),
            damped_modes: 0,
            resonances: 0,
        };
        return Ok(!is_estimated || !are_all_modes_wanted(request.model, tables, interrupt)?);
    }
    let (per_input, besides) = USUAL_COLUMNS;
    let columns = |group: &Group| (per_input * group.inputs.len() + besides) as f64;
    let of_group = |group: &Group| group.members.len() as f64 * columns(group).powi(3);
    let of_basis = OF_BASIS * groups.iter().map(of_group).sum::<f64>();
    // The alternative to modal damping, whose matrix is full, are poles.
    let is_modal = request.model.structure().has_modal_damping();
    let of_sum = if is_modal { OF_POLES } else { OF_MODES };
    let of_sum = of_sum * groups.len() as f64 * (n as f64).powi(3);
    Ok(request.options.tolerance == 0.0 && !request.sweep.is_single() && of_basis < of_sum)
}

fn declined<T>(forced: bool) -> Result<Option<T>> {
    if !forced {
        return Ok(None);
    }
    fail!(
        Unsupported,
        "flexibility = krylov needs Hermitian stiffness and mass, a mass by which K + shift M is positive definite, and neither \
         structural matrix, aerodynamic influence, unbalance, a speed tied to the frequency nor one that stiffens"
    )
}

/// The reduced wave of a group with its certificate, kept by the model or prepared here; `None` where it has no
/// definite matrix.
fn wave_of(
    request: &Request<'_>,
    group: &Group,
    kappa: &impl Fn(usize, usize) -> Complex64,
    interrupt: &Interrupt<'_>,
) -> Result<Option<(Arc<ReducedWave>, Certificate)>> {
    let limit = limit(request);
    let most = MOST_COLUMNS.max(MOST_BLOCKS * group.inputs.len());
    let most = if request.is_forced() {
        most
    } else {
        most.min(request.ndof() / SHARE_OF_BASIS)
    };
    let error = |wave: &Arc<ReducedWave>, enough: f64, residuals: &mut Vec<Complex64>| {
        certificate_of(request, group, (wave, enough), kappa, residuals, interrupt)
    };
    let mut inputs = Vec::new();
    for input in &group.inputs {
        interrupt.check_before(100)?;
        try_push(&mut inputs, try_copy(input, CONTEXT)?, CONTEXT)?;
    }
    let kept = request.model.kept().find(group.key);
    if let Some(wave) = &kept {
        let mut holds_all = true;
        for input in &inputs {
            interrupt.check_before(wave.inputs.len() as u64)?;
            holds_all &= wave.inputs.contains(input);
            if !holds_all {
                break;
            }
        }
        if holds_all {
            let error = error(wave, f64::INFINITY, &mut Vec::new())?;
            if error.basis <= limit || wave.refused_up_to >= most {
                return Ok(Some((Arc::clone(wave), error)));
            }
        }
        // The new basis serves earlier calls, too.
        for input in &wave.inputs {
            interrupt.check_before(inputs.len() as u64)?;
            if !inputs.contains(input) {
                try_push(&mut inputs, try_copy(input, CONTEXT)?, CONTEXT)?;
            }
        }
    }
    drop(kept);
    let (first, conjugated) = group.members[0];
    let matrices = WaveMatrices {
        model: request.model,
        number: request.numbers[first],
        conjugated,
        key: group.key,
        frequency: reference_frequency(request, group),
        instead_of: instead_of(request, group),
        memory_limit: request.options.memory_limit,
        sampled_with: (request.ndof() <= WAVE_REDUCTION_DIRECT_UP_TO).then(|| request.loss_factor.unwrap_or(0.0)),
    };
    let Some((wave, error)) = prepare(&matrices, inputs, (limit, most), error, interrupt)? else {
        return Ok(None);
    };
    request.model.kept().keep(&wave)?;
    Ok(Some((wave, error)))
}

/// Lowest angular frequency above zero at which the wave is needed.
fn reference_frequency(request: &Request<'_>, group: &Group) -> f64 {
    let numbers = group
        .members
        .iter()
        .map(|&(i, _)| request.numbers[i])
        .filter(|&h| h > 0);
    let lowest = numbers.min().unwrap_or(1);
    request.sweep.of_harmonic(lowest)[1]
}

/// Size and use of the factors that the basis of a wave competes with, up to a size where factors are too slow; where all modes are
/// possible, the size of the basis alone decides whether it is given up.
fn instead_of(request: &Request<'_>, group: &Group) -> Option<Factors> {
    let n = request.ndof();
    if request.is_forced() || n > WAVE_REDUCTION_DIRECT_UP_TO {
        return None;
    }
    let numbers = group.members.iter().map(|&(i, _)| request.numbers[i]);
    let highest = numbers.max().unwrap_or(0);
    Some(Factors {
        highest: request.sweep.of_harmonic(highest)[2],
        harmonics: group.members.len(),
        along_range: !request.sweep.is_single(),
        beside_modes: n <= ALL_UP_TO,
    })
}

/// Largest certificate over the harmonics of a group; a lower bound where it exceeds `enough`, with the `residuals`
/// at that frequency.
fn certificate_of(
    request: &Request<'_>,
    group: &Group,
    (wave, enough): (&Arc<ReducedWave>, f64),
    kappa: &impl Fn(usize, usize) -> Complex64,
    residuals: &mut Vec<Complex64>,
    interrupt: &Interrupt<'_>,
) -> Result<Certificate> {
    let mut worst = Certificate::default();
    // The highest harmonic needs the largest basis.
    for &(i, conjugated) in group.members.iter().rev() {
        let view = ReducedView {
            wave: Arc::clone(wave),
            conjugated,
        };
        // A second sample of one frequency adds nothing, so that the worst of all harmonics has the next one.
        if worst.basis > enough && !(request.sweep.is_single() && is_sampled(&view)) {
            break;
        }
        let number = request.numbers[i];
        let at = (view.clone(), 0, request.loss_factor.unwrap_or(0.0));
        let block = reduced_block(request.model, number, request.contacts, |c| kappa(c, number), at)?;
        worst = worst.max(certificate(
            (&block, &view),
            loss_factor(request, number),
            &group.inputs,
            (request.sweep, enough),
            residuals,
            interrupt,
        )?);
    }
    Ok(worst)
}

/// Loss factor η in harmonic `number`: 0 in the mean.
fn loss_factor(request: &Request<'_>, number: usize) -> f64 {
    if number == 0 {
        0.0
    } else {
        request.loss_factor.unwrap_or(0.0)
    }
}

/// The waves of the carried harmonics, with the force vectors that each basis must hold; `None` where one needs more
/// than `most`.
fn groups(request: &Request<'_>, most: usize, interrupt: &Interrupt<'_>) -> Result<Option<Vec<Group>>> {
    let structure = request.model.structure();
    let mut groups: Vec<Group> = Vec::new();
    for (i, &number) in request.numbers.iter().enumerate() {
        let (key, conjugated) = structure.wave_key(number);
        let known = groups.iter().position(|group| group.key == key);
        let at = known.unwrap_or(groups.len());
        if known.is_none() {
            let new = Group {
                key,
                members: Vec::new(),
                inputs: Vec::new(),
            };
            try_push(&mut groups, new, CONTEXT)?;
        }
        let group = &mut groups[at];
        try_push(&mut group.members, (i, conjugated), CONTEXT)?;
        for mut input in inputs(request, number, interrupt)? {
            interrupt.check_before(group.inputs.len() as u64)?;
            if conjugated {
                for (_, z) in &mut input {
                    *z = z.conj();
                }
            }
            if !input.is_empty() && !group.inputs.contains(&input) {
                try_push(&mut group.inputs, input, CONTEXT)?;
                if group.inputs.len() > most {
                    return Ok(None);
                }
            }
        }
    }
    Ok(Some(groups))
}

/// The force vectors of one harmonic: contacts and springs, excitation, and the response.
fn inputs(request: &Request<'_>, number: usize, interrupt: &Interrupt<'_>) -> Result<Vec<SparseVector>> {
    let model = request.model;
    let structure = model.structure();
    let mut found = Vec::new();
    let mut add = |row: &Row| -> Result<()> {
        let mut input = Vec::new();
        for (p, z) in row.iter().flatten().filter(|(_, z)| *z != Complex64::ZERO) {
            try_push(&mut input, (*p, z.conj()), CONTEXT)?;
        }
        try_push(&mut found, input, CONTEXT)
    };
    for contact in model.contacts() {
        interrupt.check_before(100)?;
        for k in 0..contact.directions() {
            add(&structure.contact_row(contact, k, number))?;
        }
    }
    for spring in model.springs() {
        add(&structure.row(&structure.spring_motion(spring), Wave::Harmonic(number)))?;
    }
    let excited = model.excitation().forces().iter();
    let mut dofs: Vec<usize> = Vec::new();
    for force in excited.filter(|f| f.harmonic == number && f.value != Complex64::ZERO) {
        if !dofs.contains(&force.dof) {
            try_push(&mut dofs, force.dof, CONTEXT)?;
        }
    }
    let many = dofs.len() > SEPARATE_FORCES;
    if many {
        dofs.clear();
    }
    if let Some(dof) = request.options.response_dof
        && !dofs.contains(&dof)
    {
        try_push(&mut dofs, dof, CONTEXT)?;
    }
    for dof in dofs {
        let (sector, terms) = structure.degrees().image(dof);
        let turn = structure.phase(number, sector);
        let mut row = [None; MOTION_TERMS];
        for (entry, (p, c)) in row.iter_mut().zip(terms) {
            *entry = Some((p, turn * c));
        }
        add(&row)?;
    }
    if many {
        let mut force = try_vec(structure.ndof(), Complex64::ZERO, CONTEXT)?;
        let size = model.excitation().largest(request.sweep.start);
        model.add_forces_to(number, 1.0 / size, &mut force);
        let mut input = Vec::new();
        for (p, z) in force.iter().enumerate().filter(|(_, z)| **z != Complex64::ZERO) {
            try_push(&mut input, (p, *z), CONTEXT)?;
        }
        try_push(&mut found, input, CONTEXT)?;
    }
    Ok(found)
}
