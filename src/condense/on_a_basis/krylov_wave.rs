//! The basis of one wave: its matrices, its factor, and blocks until the certificate is met.

use crate::condense::blocks::memory_limit::within;
use crate::condense::by_modes::few_directions::FewDirections;
use crate::condense::on_a_basis::basis_outlook::{Outlook, is_worth_its_columns, paying_columns};
use crate::condense::on_a_basis::certificate::Certificate;
use crate::condense::on_a_basis::residual_directions::residual_directions;
use crate::condense::on_a_basis::sampled_motions::Samples;
use crate::condense::on_a_basis::wave_matrices::{Assembled, Damping, WaveMatrices};
use crate::error::{Result, fail, try_copy, try_push, try_vec};
use crate::interrupt::{Interrupt, Phase};
use crate::linalg::dense::hermitian;
use crate::linalg::factors::cholesky::Cholesky;
use crate::linalg::iterative::block_krylov::{BlockKrylov, SparseVector};
use crate::linalg::sparse_storage::row_index::Row;
use crate::linalg::sparse_storage::sparse::{Columns, Csc};
use crate::linalg::sparse_storage::triangle::{Entry, Triangle};
use crate::model::few_motions::reduced_wave::{Basis, ReducedPencil, ReducedWave, Remainder, WaveDamping};
use crate::model::few_motions::stuck_shapes::FREE_SHIFT;
use crate::model::matrices::wave_matrix::WaveMatrix;
use num_complex::Complex64;
use std::sync::Arc;

const CONTEXT: &str = "the reduced structure";

/// Motions of the lowest frequencies whose products are computed in twice the precision. Rounding counts by the ratio of the
/// largest stiffness to that of a motion, which is far smaller in the others.
/// Kind: tuned; measured on: not recorded.
const SOFTEST: usize = 16;

/// Those among them by which the rounding of solutions is measured.
/// Kind: tuned; measured on: not recorded.
const PROBES: usize = 3;

/// Shift σ over the square of the lowest frequency of the sweep. It makes a structure that can move freely definite, and is
/// so small that the basis finds the modes near the sweep first.
/// Kind: tuned; measured on: not recorded.
const SHIFT: f64 = 0.01;

/// Factor between shifts of an indefinite stiffness, and the number that are tried.
/// Kind: tuned; measured on: not recorded.
const RAISED: f64 = 100.0;
/// Shifts of an indefinite stiffness that are tried.
/// Kind: cap.
const KRYLOV_WAVE_ATTEMPTS: usize = 5;

/// Most columns of a basis, and most blocks where one block has many.
/// Kind: cap.
pub(crate) const MOST_COLUMNS: usize = 600;
pub(crate) const MOST_BLOCKS: usize = 12;

/// Columns of a basis over those that are added before its next certificate, which costs as much as some of its factorisations.
/// Kind: tuned; measured on: not recorded.
const GROWTH_OF_BASIS: usize = 5;

/// Candidates of a block from which it takes those alone that the residuals need, and the order of the basis over the columns that it takes
/// at least, since the residuals of one frequency are known.
/// Kind: tuned; measured on: not recorded.
const CHOSEN_FROM: usize = 32;
const LEAST_GROWTH: usize = 16;

/// Ratio of certificates from which the candidates of the next block are chosen by residuals.
/// Kind: tuned; measured on: not recorded.
const LEAST_GAIN: f64 = 3.0;

/// Blocks that memory is counted and reserved for.
/// Kind: tuned; measured on: not recorded.
const USUAL_BLOCKS: usize = 7;

/// Prepares a basis for a wave with the forces `inputs` until its certificate is below `limit` or it has `most`
/// columns; `None` where the wave has no definite matrix. `error` computes the certificate up to a given number, and
/// the residuals where it exceeds that.
pub(crate) fn prepare(
    matrices: &WaveMatrices<'_>,
    inputs: Vec<SparseVector>,
    (limit, most): (f64, usize),
    error: impl Fn(&Arc<ReducedWave>, f64, &mut Vec<Complex64>) -> Result<Certificate>,
    interrupt: &Interrupt<'_>,
) -> Result<Option<(Arc<ReducedWave>, Certificate)>> {
    let Some(assembled) = matrices.assembled(interrupt)? else {
        return Ok(None);
    };
    let mut real = assembled.stiffness.is_real() && assembled.mass.is_real();
    real &= inputs.iter().flatten().all(|(_, z)| z.im == 0.0);
    real &= match &assembled.damping {
        Damping::Proportional(..) => true,
        Damping::Few(few) => few.is_real(),
        Damping::General(c) => c.is_real(),
    };
    if real {
        build::<f64>(
            matrices,
            assembled,
            inputs,
            (limit, most),
            error,
            (Basis::Real, Basis::into_real),
            interrupt,
        )
    } else {
        build::<Complex64>(
            matrices,
            assembled,
            inputs,
            (limit, most),
            error,
            (Basis::Complex, Basis::into_complex),
            interrupt,
        )
    }
}

/// Two functions: one makes a basis of its columns, the other takes the columns back.
type Wrapping<T> = (fn(Vec<T>) -> Basis, fn(Basis) -> Vec<T>);

fn build<T: Entry>(
    matrices: &WaveMatrices<'_>,
    assembled: Assembled<'_>,
    inputs: Vec<SparseVector>,
    (limit, most): (f64, usize),
    error: impl Fn(&Arc<ReducedWave>, f64, &mut Vec<Complex64>) -> Result<Certificate>,
    (basis, back): Wrapping<T>,
    interrupt: &Interrupt<'_>,
) -> Result<Option<(Arc<ReducedWave>, Certificate)>> {
    let mut samples = match matrices.sampled_with {
        Some(loss_factor) => Samples::new(&assembled, loss_factor, inputs.len())?,
        None => None,
    };
    let Some((mut krylov, prepared)) = started::<T>(matrices, assembled, &inputs, interrupt)? else {
        return Ok(None);
    };
    let beside = prepared.directions().len();
    let mut first = Vec::new();
    for input in prepared.directions().iter().chain(&inputs) {
        try_push(&mut first, try_copy(input, CONTEXT)?, CONTEXT)?;
    }
    krylov.start(&first, USUAL_BLOCKS, interrupt)?;
    drop(first);
    let mut wave = ReducedWave {
        key: matrices.key,
        inputs,
        pencil: pencil(&krylov, &prepared, interrupt)?,
        basis: basis(krylov.take_basis()),
        n: prepared.n,
        refused_up_to: 0,
    };
    let mut residuals = Vec::new();
    let (mut before, mut idle) = (f64::INFINITY, 0);
    // The most columns that are worth more blocks, once that is known.
    let mut paying = None;
    loop {
        interrupt.part(Phase::Condensation, wave.pencil.order(), most)?;
        // The certificate uses the basis for the rows of the contacts.
        let shared = Arc::new(wave);
        residuals.clear();
        let found = error(&shared, limit, &mut residuals)?;
        wave = match Arc::try_unwrap(shared) {
            Ok(wave) => wave,
            Err(_) => return fail!(Internal, "a basis in preparation is shared"),
        };
        let order = wave.pencil.order();
        let room = |paying: Option<usize>| most.min(paying.unwrap_or(most));
        let next = match &samples {
            Some(_) => wave.inputs.len(),
            None => krylov.next_columns(),
        };
        let full = order + next > room(paying) || next == 0;
        // Rounding is no reason for a larger basis.
        krylov.give_basis(back(wave.basis));
        let mut complete = found.basis <= limit || full;
        if !complete && paying.is_none() {
            let outlook = Outlook {
                inputs: wave.inputs.len(),
                beside,
                most,
            };
            let columns = worth_columns(&mut krylov, matrices, outlook, &prepared, interrupt)?;
            paying = Some(columns);
            complete = order + next > columns;
        }
        // Directions of residuals that have not helped twice, as at two frequencies, leave the choice to all candidates.
        idle = if found.basis > before / LEAST_GAIN { idle + 1 } else { 0 };
        if idle > 1 {
            residuals.clear();
        }
        before = found.basis;
        // Where images and basis are the same space there is nothing to add.
        let has_grown = match &mut samples {
            _ if complete => false,
            Some(samples) => match samples.motions(found.sample, &wave.inputs, interrupt)? {
                Some(motions) => krylov.add(motions, interrupt)?,
                None => false,
            },
            None => grown(&mut krylov, room(paying), (&residuals, limit), interrupt)?,
        };
        if !has_grown {
            // Samples of a single frequency end with it, and those of another one go on.
            let is_refused = found.basis > limit && (complete || samples.is_none());
            wave.refused_up_to = if is_refused { most } else { 0 };
            wave.pencil = exact_pencil(&mut krylov, &prepared, interrupt)?;
            let mut columns = krylov.take_basis();
            columns.shrink_to_fit();
            wave.basis = basis(columns);
            let shared = Arc::new(wave);
            let found = error(&shared, f64::INFINITY, &mut residuals)?;
            return Ok(Some((shared, found)));
        }
        wave.pencil = pencil(&krylov, &prepared, interrupt)?;
        wave.basis = basis(krylov.take_basis());
    }
}

/// The most columns with which more blocks are worth it, which one factorisation tells: none, any number, or those that pay under general
/// damping, whose frequencies are dearer. It takes the memory of the factor of the basis, which is
/// made again. Any number where the natural frequencies cannot be counted.
fn worth_columns<T: Entry>(
    krylov: &mut BlockKrylov<T>,
    matrices: &WaveMatrices<'_>,
    outlook: Outlook,
    prepared: &Prepared,
    interrupt: &Interrupt<'_>,
) -> Result<usize> {
    let Some(factors) = &matrices.instead_of else {
        return Ok(usize::MAX);
    };
    let below = {
        let shifted = krylov.shifted(-factors.highest * factors.highest, interrupt)?;
        krylov.factor().negative_pivots(&shifted, interrupt)?
    };
    let a = krylov.shifted(prepared.shift, interrupt)?;
    krylov.factor().make_again(&a, interrupt)?;
    let Some(below) = below else {
        return Ok(usize::MAX);
    };
    Ok(match &prepared.damping {
        _ if !is_worth_its_columns(outlook, factors, below, prepared.n) => 0,
        OfWave::General => paying_columns(outlook, factors, below, prepared.n),
        _ => usize::MAX,
    })
}

/// Adds blocks until the basis has grown enough for another certificate; `false` where nothing is left to add. A
/// block of many candidates is limited to those that the residuals need to be below `limit`.
fn grown<T: Entry>(
    krylov: &mut BlockKrylov<T>,
    most: usize,
    (residuals, limit): (&[Complex64], f64),
    interrupt: &Interrupt<'_>,
) -> Result<bool> {
    let enough = krylov.order() + krylov.order() / GROWTH_OF_BASIS;
    let candidates = krylov.next_columns();
    if krylov.can_choose() && candidates >= CHOSEN_FROM && krylov.order() + candidates >= enough {
        let least = krylov.order() / LEAST_GROWTH;
        let choice = residual_directions::<T>(krylov.gram(), residuals, (limit, least), interrupt)?;
        if let Some(choice) = choice
            && krylov.grow_by(&choice, interrupt)?
        {
            return Ok(true);
        }
    }
    let mut has_grown = false;
    while krylov.grow(interrupt)? {
        has_grown = true;
        let next = krylov.next_columns();
        if krylov.order() >= enough || next == 0 || krylov.order() + next > most {
            break;
        }
    }
    Ok(has_grown)
}

/// Data of the matrices that a basis keeps.
struct Prepared {
    shift: f64,
    damping: OfWave,
    n: usize,
}

/// Form of the damping: proportional, with few directions, or general; the basis itself stores a general matrix.
enum OfWave {
    Proportional(f64, f64),
    Few(FewDirections),
    General,
}

impl Prepared {
    /// Forces in the first block of the basis beside the inputs.
    fn directions(&self) -> &[SparseVector] {
        match &self.damping {
            OfWave::Few(few) => &few.directions,
            _ => &[],
        }
    }
}

/// K and M during the construction. Matrices of the model become triangles once the factor exists, in the memory that
/// its preparation frees; matrices made for the wave are freed before.
enum Operators<'a, T> {
    Kept([WaveMatrix<'a>; 2]),
    Triangles([Triangle<T>; 2]),
}

impl<'a, T: Entry> Operators<'a, T> {
    fn new(matrices: [WaveMatrix<'a>; 2], interrupt: &Interrupt<'_>) -> Result<Self> {
        let kept = Self::Kept(matrices);
        if let Self::Kept([WaveMatrix::Kept(_), WaveMatrix::Kept(_)]) = &kept {
            return Ok(kept);
        }
        kept.triangles(interrupt).map(Self::Triangles)
    }

    fn triangles(self, interrupt: &Interrupt<'_>) -> Result<[Triangle<T>; 2]> {
        let matrices = match self {
            Self::Kept(matrices) => matrices,
            Self::Triangles(triangles) => return Ok(triangles),
        };
        let triangle = |a: WaveMatrix<'_>| Triangle::sum(&a, (0.0, &Csc::zero(a.columns())?), interrupt);
        let [stiffness, mass] = matrices;
        Ok([triangle(stiffness)?, triangle(mass)?])
    }
}

/// Makes the factor of K + σM at the first shift that makes it definite. The assembled matrices are freed before, and
/// assembled again for another shift.
fn started<T: Entry>(
    matrices: &WaveMatrices<'_>,
    assembled: Assembled<'_>,
    inputs: &[SparseVector],
    interrupt: &Interrupt<'_>,
) -> Result<Option<(BlockKrylov<T>, Prepared)>> {
    let mut next = Some(assembled);
    let mut shift = SHIFT * matrices.frequency * matrices.frequency;
    for _ in 0..KRYLOV_WAVE_ATTEMPTS {
        let ready = match next.take() {
            Some(ready) => Some(ready),
            None => matrices.assembled(interrupt)?,
        };
        let Some(Assembled {
            stiffness,
            mass,
            damping,
        }) = ready
        else {
            return Ok(None);
        };
        let n = stiffness.columns();
        let trace = |a: &WaveMatrix<'_>| (0..n).map(|j| a.get(j, j).re).sum::<f64>();
        let heavy = trace(&mass);
        if heavy <= 0.0 {
            return Ok(None);
        }
        if shift <= 0.0 {
            shift = FREE_SHIFT * trace(&stiffness).abs() / heavy;
        }
        let a = Triangle::<T>::sum(&stiffness, (shift, &mass), interrupt)?;
        let operators = Operators::<T>::new([stiffness, mass], interrupt)?;
        let directions = match &damping {
            Damping::Few(few) => few.directions.len(),
            _ => 0,
        };
        let block = (inputs.len() + directions) * n * size_of::<T>();
        let beside = (USUAL_BLOCKS + 3) * block
            + 3 * a.values.len() * (size_of::<T>() + size_of::<Row>())
            + matrices.model.kept().bytes();
        let allow = |factor: usize| within(matrices.memory_limit, factor + beside);
        let Some(factor) = Cholesky::new(&a, allow, interrupt)? else {
            shift *= RAISED;
            continue;
        };
        let (damping, general) = match damping {
            Damping::Proportional(alpha, beta) => (OfWave::Proportional(alpha, beta), None),
            Damping::Few(few) => (OfWave::Few(few), None),
            Damping::General(c) => (OfWave::General, Some(c)),
        };
        let prepared = Prepared { shift, damping, n };
        drop(a);
        let [stiffness, mass] = operators.triangles(interrupt)?;
        let matrices = (stiffness, shift, mass);
        return Ok(Some((BlockKrylov::new(factor, matrices, general), prepared)));
    }
    Ok(None)
}

/// The matrices on the basis, with the basis rotated so that the mass is diagonal.
fn pencil<T: Entry>(krylov: &BlockKrylov<T>, prepared: &Prepared, interrupt: &Interrupt<'_>) -> Result<ReducedPencil> {
    let (values, rotation) = modes(krylov, interrupt)?;
    of_rotation(krylov, prepared, (values, rotation), (0.0, 0.0), interrupt)
}

/// Computes μ and the rotation of the basis that makes the mass diagonal.
fn modes<T: Entry>(krylov: &BlockKrylov<T>, interrupt: &Interrupt<'_>) -> Result<(Vec<f64>, Vec<Complex64>)> {
    let order = krylov.order();
    let mut mass = try_copy(krylov.reduced(0), CONTEXT)?;
    for j in 0..order {
        for i in 0..j {
            let mean = 0.5 * (mass[j * order + i] + mass[i * order + j].conj());
            mass[j * order + i] = mean;
            mass[i * order + j] = mean.conj();
        }
    }
    hermitian::eigen(&mut mass, order, interrupt)
}

fn of_rotation<T: Entry>(
    krylov: &BlockKrylov<T>,
    prepared: &Prepared,
    (values, rotation): (Vec<f64>, Vec<Complex64>),
    (solutions, products): (f64, f64),
    interrupt: &Interrupt<'_>,
) -> Result<ReducedPencil> {
    let order = krylov.order();
    let damping = match &prepared.damping {
        OfWave::Proportional(alpha, beta) => WaveDamping::Proportional(*alpha, *beta),
        OfWave::General => WaveDamping::General(rotated(krylov.reduced(1), &rotation, order)?, None),
        OfWave::Few(few) => {
            let rest = few.on_basis(&krylov.seen_by(&few.directions)?, order, interrupt)?;
            let mut whole = rotated(&rest, &rotation, order)?;
            let (alpha, beta) = few.proportional;
            for (k, mu) in values.iter().enumerate() {
                whole[k * order + k] += alpha * mu + beta * (1.0 - prepared.shift * mu);
            }
            WaveDamping::General(whole, Some(few.proportional))
        }
    };
    Ok(ReducedPencil {
        shift: prepared.shift,
        values,
        rotation,
        damping,
        remainder: Remainder {
            last: krylov.last(),
            gram: try_copy(krylov.gram(), CONTEXT)?,
            solutions,
            products,
        },
    })
}

/// The reduced matrices, as `pencil` makes them, without the rounding of products with A = K + σM in the softest
/// motions. With their Gram matrix G in the inner product of A, G = L Lᴴ, the basis V Q L⁻ᴴ is orthonormal, and one
/// more rotation makes the mass diagonal again.
fn exact_pencil<T: Entry>(
    krylov: &mut BlockKrylov<T>,
    prepared: &Prepared,
    interrupt: &Interrupt<'_>,
) -> Result<ReducedPencil> {
    let (values, rotation) = modes(krylov, interrupt)?;
    let order = values.len();
    let mut ranked: Vec<usize> = Vec::new();
    for k in 0..order {
        try_push(&mut ranked, k, CONTEXT)?;
    }
    ranked.sort_unstable_by(|&a, &b| values[b].total_cmp(&values[a]));
    // The first motion that is left as it is shows what rounding leaves.
    ranked.truncate(SOFTEST + 1);
    let mut soft = Vec::new();
    for &k in &ranked {
        for &z in &rotation[k * order..(k + 1) * order] {
            try_push(&mut soft, z, CONTEXT)?;
        }
    }
    let products = rotated_back(&krylov.products(&soft, interrupt)?, &rotation, order)?;
    let mut l = try_vec(order * order, Complex64::ZERO, CONTEXT)?;
    for k in 0..order {
        l[k * order + k] = Complex64::ONE;
    }
    let mut left = f64::EPSILON;
    for (at, (&k, column)) in ranked.iter().zip(products.chunks_exact(order.max(1))).enumerate() {
        if at == SOFTEST {
            let others = column.iter().enumerate().filter(|(i, _)| !ranked[..at].contains(i));
            let gap = others.map(|(i, z)| (z - f64::from(u8::from(i == k))).norm_sqr());
            left = left.max(gap.sum::<f64>().sqrt());
            break;
        }
        for (i, &z) in column.iter().enumerate() {
            l[k * order + i] = z;
            l[i * order + k] = z.conj();
        }
        l[k * order + k] = column[k].re.into();
    }
    soft.truncate(PROBES.min(ranked.len()) * order);
    for k in 0..order {
        try_push(&mut soft, if k % 2 == 0 { 1.0 } else { -1.0 }.into(), CONTEXT)?;
    }
    let solutions = krylov.rounding_of_solutions(&soft, interrupt)?;
    if !hermitian::cholesky(&mut l, order, interrupt)? {
        return of_rotation(krylov, prepared, (values, rotation), (solutions, 1.0), interrupt);
    }
    // L⁻¹ diag(μ) L⁻ᴴ
    let mut mass = try_vec(order * order, Complex64::ZERO, CONTEXT)?;
    for (k, mu) in values.iter().enumerate() {
        mass[k * order + k] = (*mu).into();
    }
    for _ in 0..2 {
        hermitian::solve_triangular(&l, order, false, &mut mass, interrupt)?;
        hermitian::adjoint_in_place(&mut mass, order);
    }
    let (values, mut turn) = hermitian::eigen(&mut mass, order, interrupt)?;
    hermitian::solve_triangular(&l, order, true, &mut turn, interrupt)?;
    let mut new = try_vec(order * order, Complex64::ZERO, CONTEXT)?;
    for (to, turn) in new.chunks_exact_mut(order.max(1)).zip(turn.chunks_exact(order.max(1))) {
        for (q, z) in rotation.chunks_exact(order.max(1)).zip(turn) {
            for (to, q) in to.iter_mut().zip(q) {
                *to += q * z;
            }
        }
    }
    of_rotation(krylov, prepared, (values, new), (solutions, left), interrupt)
}

/// Qᴴ x for each column of coordinates.
fn rotated_back(x: &[Complex64], q: &[Complex64], n: usize) -> Result<Vec<Complex64>> {
    let mut found = try_vec(x.len(), Complex64::ZERO, CONTEXT)?;
    for (to, x) in found.chunks_exact_mut(n.max(1)).zip(x.chunks_exact(n.max(1))) {
        for (to, q) in to.iter_mut().zip(q.chunks_exact(n.max(1))) {
            *to = crate::linalg::inner(q, x);
        }
    }
    Ok(found)
}

/// Qᴴ C Q, column after column.
fn rotated(c: &[Complex64], q: &[Complex64], n: usize) -> Result<Vec<Complex64>> {
    let mut product = try_vec(n * n, Complex64::ZERO, CONTEXT)?;
    for (to, q) in product.chunks_exact_mut(n.max(1)).zip(q.chunks_exact(n.max(1))) {
        for (c, q) in c.chunks_exact(n).zip(q) {
            for (to, c) in to.iter_mut().zip(c) {
                *to += c * q;
            }
        }
    }
    let mut found = try_vec(n * n, Complex64::ZERO, CONTEXT)?;
    for (to, p) in found.chunks_exact_mut(n.max(1)).zip(product.chunks_exact(n.max(1))) {
        to.copy_from_slice(&rotated_back(p, q, n)?);
    }
    Ok(found)
}
