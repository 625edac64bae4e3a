//! Whether a basis is worth its columns, which its first blocks, that do not suffice, cannot tell: a basis needs about two columns for each
//! natural frequency up to the highest one that it serves. These are counted by one factorisation, whose size tells what factors at
//! each frequency would take instead.

use crate::condense::HarmonicBlock;
use crate::condense::on_a_basis::wave_matrices::Factors;
use crate::condense::tuned_wheel::tuned_plan::TunedPlan;
use crate::error::Result;
use crate::linalg::factors::cholesky::entries_by_degrees;
use crate::linalg::factors::inertia::Below;
use crate::linalg::sparse_storage::sparse::Csc;

/// Usual columns of a basis per input, and besides.
/// Kind: tuned; measured on: not recorded.
pub(crate) const USUAL_COLUMNS: (usize, usize) = (5, 10);

/// Columns of a basis beyond those for each natural frequency up to the highest.
/// Kind: tuned; measured on: 2.0 to 2.4 on chains of 1,500 and 3,000
/// masses and grids of 1,444 and 2,916 with 1 to 30 contacts.
const OF_RESONANCE: usize = 2;

/// Work of a basis over the cube of its columns, and of complex LU factors over the entries of L, in that of n⁻¹ entries².
/// Kind: tuned; measured on: times of the same models.
const OF_COLUMNS: f64 = 2.5;
const OF_ENTRIES: f64 = 6.0;

/// Work of all modes over n³, and of all poles over their order³, in the same.
/// Kind: tuned; measured on: times of grids of 608 to 2,000, and of chains of 60.
const WORK_OF_ALL_MODES: f64 = 0.2;
const WORK_OF_ALL_POLES: f64 = 2.0;

/// Work, as order³ of a real matrix, up to which poles are computed: the QR iteration takes less than a second, in which nothing
/// can stop it.
/// Kind: cap.
pub(crate) const MOST_POLE_WORK: f64 = 900.0 * 900.0 * 900.0;

/// Columns of contacts whose table takes as long as its factors; and work of a sum over modes over its multiplications, in the same.
/// Kind: tuned; measured on: chains of 300 to 620 with 1, 8, 30 and 100 contacts and 1 to 31 harmonics.
const COLUMNS_OF_FACTORS: f64 = 20.0;
const WORK_OF_A_SUM: f64 = 0.026;

/// Factorisations of each harmonic along a range, of 150 points or so, and at one frequency. Usual sweeps have 30 to 300.
/// Kind: tuned; measured on: not recorded.
const ALONG_RANGE: f64 = 600.0;
const AT_ONE: f64 = 5.0;

/// Points of a range with few resonances, and those that each resonance adds.
/// Kind: tuned; measured on: chains of 250 to 600 with up to 170 resonances.
const POINTS_ALONG_RANGE: f64 = 150.0;
const POINTS_OF_RESONANCE: usize = 8;

/// Numbers that decide whether a basis is larger than its first blocks with gain.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Outlook {
    /// Forces that it serves.
    pub inputs: usize,
    /// Others beside them in the first block.
    pub beside: usize,
    /// Most columns that it may have.
    pub most: usize,
}

/// Whether a basis of a structure of `n` degrees of freedom is larger than its first blocks with gain, by the count `below` of
/// natural frequencies up to the highest one that it serves: its columns suffice, and take less time than the `factors`.
pub(crate) fn is_worth_its_columns(outlook: Outlook, factors: &Factors, below: Below, n: usize) -> bool {
    let columns = outlook.columns(below);
    if columns > outlook.most {
        return false;
    }
    if factors.beside_modes {
        return true;
    }
    let of_one = of_factors(below.entries, n);
    let times = if factors.along_range { ALONG_RANGE } else { AT_ONE };
    OF_COLUMNS * (columns as f64).powi(3) <= times * factors.harmonics as f64 * of_one
}

impl Outlook {
    /// Columns that a basis needs, by the count of natural frequencies up to the highest one that it serves.
    fn columns(self, below: Below) -> usize {
        let (per_input, besides) = USUAL_COLUMNS;
        OF_RESONANCE * below.count + per_input * self.inputs + besides + self.beside
    }
}

/// The most columns of a basis under general damping that take no longer than factors of `n` degrees of freedom: a frequency takes a sum
/// over the poles of the basis, once computed, where these are few enough, or dense factors. None where it needs more.
pub(crate) fn paying_columns(outlook: Outlook, factors: &Factors, below: Below, n: usize) -> usize {
    // A sample of one frequency takes the factors that it would replace.
    if !factors.along_range {
        return 0;
    }
    let of_one = of_factors(below.entries, n);
    let of_poles = ALONG_RANGE * factors.harmonics as f64 * of_one / WORK_OF_ALL_POLES;
    let by_poles = 0.5 * of_poles.min(MOST_POLE_WORK).cbrt();
    // A dense triangle of order r has r²/2 entries.
    let by_dense_factors = (4.0 * of_one).cbrt();
    let most = by_poles.max(by_dense_factors) as usize;
    if outlook.columns(below) > most { 0 } else { most }
}

/// Work of complex LU factors of order n whose triangle has `entries` entries.
fn of_factors(entries: usize, n: usize) -> f64 {
    let entries = entries as f64;
    OF_ENTRIES * entries + entries * entries / n as f64
}

/// The tables of flexibility that a sweep makes at each frequency.
#[derive(Clone, Copy)]
pub(crate) struct SweepTables {
    pub harmonics: usize,
    /// Relative motions of contacts that each table has.
    pub contacts: usize,
    /// Modes whose damping is a term beside the factors, which takes a solution for each.
    pub damped_modes: usize,
    /// Resonances that the sweep is known to pass.
    pub resonances: usize,
}

/// Whether all modes of a matrix with this pattern, and tables by them, take less time than tables by its factors along a range.
pub(crate) fn are_all_modes_quicker(pattern: &Csc, tables: SweepTables) -> Result<bool> {
    let n = pattern.cols as f64;
    are_sums_quicker(pattern, WORK_OF_ALL_MODES * n.powi(3), n, tables)
}

/// The same for all poles, whose work is that of so many multiplications of a real matrix, its order³.
pub(crate) fn are_all_poles_quicker(pattern: &Csc, work: f64, tables: SweepTables) -> Result<bool> {
    are_sums_quicker(pattern, WORK_OF_ALL_POLES * work, 2.0 * pattern.cols as f64, tables)
}

/// Whether sums over so many terms, which take the work `once`, take less than factors.
fn are_sums_quicker(pattern: &Csc, once: f64, terms: f64, tables: SweepTables) -> Result<bool> {
    let columns = tables.contacts as f64;
    let of_factors = of_factors(entries_by_degrees(pattern)?, pattern.cols);
    let solved = columns + tables.damped_modes as f64;
    let by_factors = of_factors * (1.0 + solved / COLUMNS_OF_FACTORS);
    let by_sums = WORK_OF_A_SUM * columns * columns * terms;
    let points = POINTS_ALONG_RANGE + (POINTS_OF_RESONANCE * tables.resonances) as f64;
    let count = ALONG_RANGE / POINTS_ALONG_RANGE * points * tables.harmonics as f64;
    Ok(once + count * by_sums <= count * by_factors)
}

/// Whether tables of a wheel's flexibility take less time from the waves of the tuned wheel than by factors of all sectors, by their
/// multiplications.
pub(crate) fn is_tuned_quicker(plan: &TunedPlan, blocks: &[HarmonicBlock]) -> Result<bool> {
    let Some(first) = blocks.first() else { return Ok(false) };
    let (sectors, n) = (plan.basis.sectors, plan.basis.order);
    let outputs = first.motions.rows.len() + 1;
    let of_wave = entries_by_degrees(&plan.ring(0).wave()?)?;
    let columns = (sectors * (outputs.div_ceil(sectors) + plan.basis.rank)) as f64;
    let (terms, outputs) = ((sectors * plan.basis.rank) as f64, outputs as f64);
    let of_tuned = (sectors / 2 + 1) as f64 * of_factors(of_wave, n)
        + columns * 2.0 * of_wave as f64
        + terms.powi(3) / 3.0
        + outputs * terms * (outputs + terms);
    let of_plain = |entries: usize| of_factors(entries, sectors * n) + 2.0 * entries as f64 * outputs;
    // The factors have the entries of the matrix at least, which are counted quickly.
    if of_tuned <= of_plain(first.matrices.reference.values.len() / 2) {
        return Ok(true);
    }
    Ok(of_tuned <= of_plain(entries_by_degrees(&first.matrices.reference)?))
}
