//! Multipliers of one period from the map of a lapse, and the reason of those that are known beforehand.
//!
//! Known perturbations span an invariant subspace: reflections that carry it to the first coordinates leave the other
//! multipliers in the remaining block. A slider that has slipped forgets where it was; the map then has a null space,
//! which is split off by factorisations that reveal the rank, again and again until nothing is left of it. Its
//! multipliers are exact zeros, which an eigensolver would find as roots of round-off.

use crate::error::{Result, check_memory, try_copy, try_push};
use crate::interrupt::Interrupt;
use crate::linalg::dense::eigenvalues;
use crate::linalg::dense::general_eigen;
use crate::linalg::libraries::{ColPivQR, ComplexField, DMatrix, DVector};
use crate::model::matrices::structure::Structure;
use crate::results::{Multiplier, MultiplierClass};
use crate::stability::perturbations::Perturbations;
use crate::time_integration::System;
use num_complex::Complex64;

const CONTEXT: &str = "the Floquet multipliers";

/// Square matrices that the eigenvalues of a map need at a time.
/// Kind: fixed.
const MULTIPLIERS_COPIES: usize = 8;

/// Share of the largest pivot below which a direction of the map is round-off.
/// Kind: rounding.
const MULTIPLIERS_ROUNDING: f64 = 1e-12;

/// Modulus over a period below which the multiplier of a slider is zero to rounding: while another one remembers, what
/// a slider has forgotten is not an exact null space.
/// Kind: rounding.
const FORGOTTEN: f64 = f64::EPSILON;

/// Lapses of a period for each slider that moves from which a root of round-off vanishes. Chosen: round-off squared.
/// Kind: rounding.
const LAPSES_FOR_EACH_SLIDER: usize = 2;

/// Largest residual of a known perturbation, relative to it; above it is not invariant after all.
/// Kind: rounding.
const INVARIANT: f64 = 1e-6;

/// Facts about the motion from which some multipliers are known.
pub(crate) struct Known<'a> {
    /// Function that tells whether the slider of an element of the structure in time moves.
    pub moved: &'a dyn Fn(usize) -> bool,
    /// Rates (x′, v′, w′) of all sectors at the beginning of an autonomous motion; `None` for a driven one.
    pub rates: Option<(&'a [f64], &'a [f64], &'a [f64])>,
}

/// The multipliers of a block, whose perturbations were carried through a lapse.
pub(crate) fn multipliers_of(
    structure: &Structure,
    system: &System<'_>,
    block: &Perturbations<'_>,
    known: &Known<'_>,
) -> Result<Vec<Multiplier>> {
    let (n, states) = (block.ring.order, block.ring.states());
    let stuck = block.stuck_sliders(known.moved);
    let kept: Vec<usize> = (0..states)
        .filter(|&i| i < 2 * n || !stuck.contains(&(i - 2 * n)))
        .collect();
    let square = kept.len().saturating_mul(kept.len());
    check_memory::<Complex64>(square.saturating_mul(MULTIPLIERS_COPIES), CONTEXT)?;
    // Velocities are divided by ω, which gives them the unit of displacements.
    let unit = |i: usize| if (n..2 * n).contains(&i) { system.omega } else { 1.0 };
    let mut sources = Vec::new();
    for &i in &kept {
        let (from, factor) = block.source(structure, system, i);
        try_push(&mut sources, (from, factor / unit(i)), CONTEXT)?;
    }
    let map = DMatrix::from_fn(kept.len(), kept.len(), |i, j| {
        let ((from, factor), j) = (sources[i], kept[j]);
        block.carried(from, j) * (factor * unit(j))
    });
    let keep = |v: &DVector<Complex64>| DVector::from_fn(kept.len(), |i, _| v[kept[i]] / unit(kept[i]));
    let mut directions = Vec::new();
    for column in block.unstrained(&stuck)?.column_iter() {
        try_push(&mut directions, keep(&column.into_owned()), CONTEXT)?;
    }
    let mut rigid = directions.len();
    if !is_invariant(&map, &directions) {
        directions.clear();
        rigid = 0;
    }
    let mut trivial = 0;
    if let Some(rates) = known.rates.filter(|_| block.closure().has_wave) {
        let rate = keep(&block.rate(rates));
        try_push(&mut directions, rate, CONTEXT)?;
        trivial = 1;
    }
    // The lapses of a period turn the wheel by `follower` sectors each, which passes the ring some whole times.
    let lapses = system.wave.sectors;
    let passed = system.wave.follower * lapses / block.closure().sectors;
    let turn = block.closure().factor(structure, passed).conj();
    let counts = Counts {
        stuck: stuck.len(),
        rigid,
        trivial,
        moving: kept.len() - 2 * n,
    };
    let map = without(map, directions);
    classified(
        map,
        &counts,
        lapses,
        turn,
        block.closure().has_conjugate,
        system.interrupt,
    )
}

/// Number of multipliers that are known beforehand, by reason; and number of sliders that move.
pub(crate) struct Counts {
    pub stuck: usize,
    pub rigid: usize,
    pub trivial: usize,
    pub moving: usize,
}

/// The multipliers of a period with their reasons, from the map of a lapse without the known directions. A period has
/// `lapses` lapses, and the power of the map must be multiplied by `turn`.
pub(crate) fn classified(
    map: DMatrix<Complex64>,
    counts: &Counts,
    lapses: usize,
    turn: Complex64,
    has_conjugate: bool,
    interrupt: &Interrupt<'_>,
) -> Result<Vec<Multiplier>> {
    // Factors and copies of the map.
    check_memory::<Complex64>(map.len().saturating_mul(MULTIPLIERS_COPIES), CONTEXT)?;
    let moving = counts.moving;
    let (values, zeros) = if map.iter().all(|z| z.im == 0.0) {
        let (rest, zeros) = without_zeros(map.map(|z| z.re), moving, lapses, interrupt)?;
        (real_eigenvalues(&rest, interrupt)?, zeros)
    } else {
        let (rest, zeros) = without_zeros(map, moving, lapses, interrupt)?;
        (general_eigen::values(rest.as_slice(), rest.nrows(), interrupt)?, zeros)
    };
    let mut found = Vec::new();
    let mut add = |count: usize, value: Complex64, class| {
        (0..count).try_for_each(|_| try_push(&mut found, Multiplier { value, class }, CONTEXT))
    };
    add(counts.stuck, Complex64::ONE, MultiplierClass::NeutralStuck)?;
    add(counts.rigid, Complex64::ONE, MultiplierClass::NeutralRigid)?;
    add(counts.trivial, Complex64::ONE, MultiplierClass::Trivial)?;
    add(zeros.min(moving), Complex64::ZERO, MultiplierClass::Memory)?;
    add(zeros.saturating_sub(moving), Complex64::ZERO, MultiplierClass::Ordinary)?;
    let mut memories = moving.saturating_sub(zeros);
    for value in values {
        let value = value.powu(lapses as u32) * turn;
        if value.norm() <= FORGOTTEN && memories > 0 {
            memories -= 1;
            add(1, value, MultiplierClass::Memory)?;
        } else {
            add(1, value, MultiplierClass::Ordinary)?;
        }
    }
    if has_conjugate {
        for i in 0..found.len() {
            let Multiplier { value, class } = found[i];
            let value = value.conj();
            try_push(&mut found, Multiplier { value, class }, CONTEXT)?;
        }
    }
    Ok(found)
}

/// Whether the map leaves the span of the directions invariant; these are orthogonal up to their sliders.
fn is_invariant(map: &DMatrix<Complex64>, directions: &[DVector<Complex64>]) -> bool {
    if directions.is_empty() {
        return true;
    }
    let basis = DMatrix::from_columns(directions).qr().q();
    let image = map * &basis;
    let rest = &image - &basis * (basis.adjoint() * &image);
    rest.norm() <= INVARIANT * image.norm()
}

/// The map without an invariant subspace, by reflections that turn this subspace to the first coordinates.
fn without(mut map: DMatrix<Complex64>, mut directions: Vec<DVector<Complex64>>) -> DMatrix<Complex64> {
    let count = directions.len();
    for k in 0..count {
        let mut mirror = directions[k].clone();
        mirror.rows_mut(0, k).fill(Complex64::ZERO);
        let length = mirror.norm();
        if length == 0.0 {
            continue;
        }
        let head = mirror[k];
        let turn = if head == Complex64::ZERO {
            Complex64::ONE
        } else {
            head / head.norm()
        };
        mirror[k] += turn * length;
        let square = mirror.norm_squared();
        for direction in directions.iter_mut().skip(k) {
            let along = mirror.dotc(direction) * (2.0 / square);
            direction.axpy(-along, &mirror, Complex64::ONE);
        }
        let row = mirror.adjoint() * &map;
        map -= (&mirror * row).scale(2.0 / square);
        let column = &map * &mirror;
        map -= (column * mirror.adjoint()).scale(2.0 / square);
    }
    map.view((count, count), (map.nrows() - count, map.nrows() - count))
        .into_owned()
}

/// Removes zero columns with their rows, each of which has a zero multiplier, and returns their number: sliders that
/// slip at the beginning of the lapse.
fn without_zero_columns<T: ComplexField<RealField = f64>>(map: &mut DMatrix<T>) -> usize {
    let mut zeros = 0;
    while let Some(j) = (0..map.ncols()).find(|&j| map.column(j).iter().all(T::is_zero)) {
        *map = core::mem::replace(map, DMatrix::zeros(0, 0))
            .remove_column(j)
            .remove_row(j);
        zeros += 1;
    }
    zeros
}

/// The map on its lasting range, and the number of its zero multipliers; zeros that need no care remain. For k
/// sliders that forget within a lapse, an eigensolver finds numbers no larger than the k-th root of round-off, which
/// vanish as powers of many lapses.
fn without_zeros<T: ComplexField<RealField = f64>>(
    mut map: DMatrix<T>,
    moving: usize,
    lapses: usize,
    interrupt: &Interrupt<'_>,
) -> Result<(DMatrix<T>, usize)> {
    let mut zeros = without_zero_columns(&mut map);
    if lapses >= LAPSES_FOR_EACH_SLIDER * moving.saturating_sub(zeros) {
        return Ok((map, zeros));
    }
    loop {
        interrupt.check()?;
        let order = map.nrows();
        if order == 0 {
            return Ok((map, zeros));
        }
        let factors = ColPivQR::new(map.clone());
        let r = factors.r();
        let first = r[(0, 0)].clone().modulus();
        let rank = (0..order)
            .take_while(|&i| r[(i, i)].clone().modulus() > MULTIPLIERS_ROUNDING * first)
            .count();
        if rank == order {
            return Ok((map, zeros));
        }
        let q = factors.q();
        map = (q.adjoint() * map * q).view((0, 0), (rank, rank)).into_owned();
        zeros += order - rank;
    }
}

fn real_eigenvalues(map: &DMatrix<f64>, interrupt: &Interrupt<'_>) -> Result<Vec<Complex64>> {
    let mut found = Vec::new();
    let mut copy = try_copy(map.as_slice(), CONTEXT)?;
    eigenvalues::of_real(&mut copy, map.nrows(), interrupt, |value| {
        try_push(&mut found, value, CONTEXT)
    })?;
    Ok(found)
}
