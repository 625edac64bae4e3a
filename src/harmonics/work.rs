//! Work of an estimate in operations and bytes, counted before it is spent, and the most that an estimate may take: a
//! multiple of the solution of the point itself.
//!
//! Only the leading terms count. An operation is one of a simple loop; those of a factorisation in blocks are five
//! times as fast, and each direction of a contact law takes thousands.

use crate::aft::Evaluator;
use crate::condense::Condensed;
use crate::condense::blocks::memory_limit::within;
use crate::error::Result;
use crate::harmonics::cutoff_harmonic::affordable;
use crate::harmonics::estimate::{MOST_EXTENDED, extended_options};
use crate::options::SolverOptions;

/// Least number of Newton iterations that the first point of a branch counts, which may become harder.
/// Kind: tuned; measured on: not recorded.
pub(super) const OF_A_START: usize = 40;

/// The same for a point at a single frequency, and after an estimate of it that told nothing.
/// Kind: tuned; measured on: not recorded.
pub(super) const OF_A_POINT: (usize, usize) = (32, 16);

/// Newton iterations of an extension.
/// Kind: tuned; measured on: not recorded.
const EXTENSION: f64 = 12.0;

/// Work of an estimate as a multiple of that of such a point.
/// Kind: tuned; measured on: not recorded.
const WORK_MULTIPLE: f64 = 8.0;

/// Operations that every estimate may take: about as many as the set-up of a small model.
/// Kind: tuned; measured on: not recorded.
const WORK_LEAST: f64 = 6e6;

/// Evaluations, each with a product, for which the work of an estimate must suffice.
/// Kind: tuned; measured on: not recorded.
pub(super) const EVALUATIONS_OF_ESTIMATE: f64 = 6.0;

/// Share of the work that is small.
/// Kind: tuned; measured on: not recorded.
const WORK_SMALL: f64 = 0.25;

/// Bytes that every estimate may take, and as a multiple of those of the point.
/// Kind: tuned; measured on: not recorded.
const BYTES: (f64, f64) = (100e6, 4.0);

/// Bytes of a sample and direction of a law.
/// Kind: tuned; measured on: not recorded.
const OF_A_SAMPLE: f64 = 300.0;

/// Tables of the flexibility, per harmonic, whose time the preparation and the solution of such a point take.
/// Kind: tuned; measured on: not recorded.
const WORK_TABLES: f64 = 6.0;

/// Unknowns of a structure that one of them couples with in the factors.
/// Kind: tuned; measured on: not recorded.
const WORK_WIDTH: f64 = 300.0;

/// Operations of a law for each direction, for each number of its motion, and for each number of its Jacobian.
/// Kind: tuned; measured on: not recorded.
const OF_LAW: (f64, f64, f64) = (8e3, 3e2, 12.0);

/// Operations for each sample and number of a packed signal.
/// Kind: tuned; measured on: not recorded.
const OF_SAMPLE: f64 = 4.0;

/// Operations for each unknown by which a vector is made orthogonal to those before.
/// Kind: tuned; measured on: not recorded.
const BASIS: f64 = 100.0;

/// Operations of a simple loop that take the time of one of a factorisation.
/// Kind: tuned; measured on: not recorded.
const OF_FACTORS: f64 = 0.2;

/// Sizes of a problem from which its work follows.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sizes {
    /// Number of relative coordinates.
    coordinates: f64,
    /// Number of carried harmonics.
    harmonics: f64,
    /// Length of a packed signal.
    packed: f64,
    /// Number of blocks ∂f/∂y of all laws; and number of directions.
    blocks: f64,
    directions: f64,
    /// Operations for the sampled laws in one evaluation.
    sampling: f64,
    /// Numbers in the tables of a sampled law.
    tables: f64,
    /// Operations of the flexibility of the structure in one harmonic at one frequency.
    flexibility: f64,
}

impl Sizes {
    /// The sizes of a condensed model whose laws are sampled `samples` times, 0: evaluated exactly.
    pub fn new(condensed: &Condensed, samples: usize) -> Self {
        let highest = condensed.set().numbers().last().copied().unwrap_or(0);
        Self::extended(condensed, highest, samples)
    }

    /// The sizes of the model with the harmonics up to `highest`.
    pub fn extended(condensed: &Condensed, highest: usize, samples: usize) -> Self {
        let set = condensed.set();
        let (base, step) = (set.base(), set.base() * set.stride());
        let mean = usize::from(set.has_mean());
        let pairs = if highest < base { 0 } else { (highest - base) / step + 1 };
        let packed = (2 * pairs + mean) as f64;
        let (mut blocks, mut directions, mut sampled, mut tables) = (0.0, 0.0, 0.0, 0.0_f64);
        for assembled in condensed.laws() {
            let d = assembled.coordinates.len() as f64;
            let sampling = (samples, condensed.refinement());
            let count = Evaluator::samples_of(&*assembled.law, highest / base, sampling) as f64;
            blocks += d * d;
            directions += d;
            sampled += d * d * count;
            tables = tables.max(d * count);
        }
        let (ndof, coordinates) = (condensed.ndof() as f64, condensed.coordinates() as f64);
        let width = ndof.min(WORK_WIDTH);
        Self {
            coordinates,
            harmonics: (pairs + mean) as f64,
            packed,
            blocks,
            directions,
            sampling: OF_SAMPLE * sampled * packed,
            tables: tables * packed,
            flexibility: OF_FACTORS * ndof * width * (8.0 / 3.0 * width + 8.0 * coordinates),
        }
    }

    /// Returns the sizes for a flexibility that is computed from modes.
    pub fn with_modes(mut self, condensed: &Condensed) -> Self {
        let outputs = self.coordinates + 1.0;
        self.flexibility = OF_FACTORS * 8.0 * condensed.ndof() as f64 * outputs * outputs;
        self
    }

    /// Length of a packed signal.
    pub fn packed(&self) -> f64 {
        self.packed
    }

    /// Number of carried harmonics.
    pub fn harmonics(&self) -> usize {
        self.harmonics as usize
    }

    /// Number of unknowns in the block of the first `packed` numbers of each coordinate.
    pub fn order(&self, packed: f64) -> f64 {
        self.coordinates * packed
    }

    /// Number of unknowns of the whole problem.
    pub fn unknowns(&self) -> f64 {
        self.coordinates * self.packed
    }

    /// Operations of one evaluation of the residual with the contact Jacobians.
    pub fn evaluation(&self) -> f64 {
        let (direction, number, of_jacobian) = OF_LAW;
        self.directions * (direction + number * self.packed)
            + of_jacobian * self.blocks * self.packed * self.packed
            + self.sampling
            + 8.0 * self.coordinates * self.coordinates * self.harmonics
    }

    /// Operations to factor the block of the first `packed` numbers of each coordinate, and `pairs` pairs of numbers
    /// one by one.
    pub fn factors(&self, packed: f64, pairs: f64) -> f64 {
        let order = self.coordinates * packed;
        let fill = 8.0 * self.blocks * self.coordinates * packed * packed;
        fill + OF_FACTORS * 2.0 / 3.0 * order.powi(3) + 8.0 / 3.0 * pairs * self.coordinates.powi(3)
    }

    /// Operations of the factors of the waves of a wheel: half as many complex matrices of the order of a sector as it has sectors.
    pub fn factors_of_waves(&self, sectors: usize) -> f64 {
        let (sectors, order) = (sectors as f64, self.unknowns() / sectors as f64);
        let fill = 8.0 * self.blocks * self.packed * self.packed + 8.0 * sectors * order * order;
        fill + OF_FACTORS * 0.5 * sectors * 8.0 / 3.0 * order.powi(3)
    }

    /// Operations of one product of an iteration preconditioned by the waves of a wheel.
    pub fn product_of_waves(&self, sectors: usize) -> f64 {
        let (sectors, order) = (sectors as f64, self.unknowns() / sectors as f64);
        self.product(0.0, 0.0) + 0.5 * sectors * 8.0 * order * order + 8.0 * sectors * self.unknowns()
    }

    /// Operations of one product of an iteration preconditioned by a block and single pairs, as counted by `factors`.
    pub fn product(&self, packed: f64, pairs: f64) -> f64 {
        let order = self.coordinates * packed;
        let couple = 8.0 * self.coordinates * self.coordinates * (self.harmonics + pairs);
        2.0 * self.blocks * self.packed * self.packed + couple + 2.0 * order * order + BASIS * self.unknowns()
    }

    /// Operations of the flexibility in all harmonics at a frequency.
    pub fn flexibility(&self) -> f64 {
        self.harmonics * self.flexibility
    }

    /// Operations of one Newton iteration with the whole matrix.
    fn iteration(&self) -> f64 {
        self.evaluation() + self.factors(self.packed, 0.0)
    }

    /// Whether several Newton iterations with the whole matrix cost no more than any estimate may, or a small part of
    /// the work.
    pub fn is_cheap(&self, work: &Work) -> bool {
        EXTENSION * self.iteration() <= WORK_LEAST.max(WORK_SMALL * work.operations)
    }

    /// Bytes of the contact Jacobians, with their copies, of the tables of samples, and of the factors.
    pub fn bytes(&self, packed: f64, pairs: f64) -> f64 {
        let order = self.coordinates * packed;
        let jacobians = 3.0 * self.blocks * self.packed * self.packed;
        8.0 * (jacobians + 2.0 * self.tables + 2.0 * order * order + 2.0 * pairs * self.coordinates * self.coordinates)
    }
}

/// Bytes that the equations of a point need with the harmonics up to `highest` if Newton's matrix is factored
/// directly: those of [`Sizes::bytes`], the Jacobian of the law with the most directions with its derivatives, and
/// the samples of a law at two numbers of them.
fn bytes_of_point(condensed: &Condensed, highest: usize, samples: usize) -> usize {
    let sizes = Sizes::extended(condensed, highest, samples);
    let sampling = (samples, condensed.refinement());
    let mut largest = 0.0_f64;
    for assembled in condensed.laws() {
        let d = assembled.coordinates.len() as f64;
        let own = Evaluator::samples_of(&*assembled.law, highest / condensed.set().base(), sampling);
        // Those requested have memory for laws that are evaluated exactly, too.
        let count = own.max(samples) as f64;
        largest = largest.max(8.0 * (1.0 + d) * (d * sizes.packed).powi(2) + OF_A_SAMPLE * d * count);
    }
    (sizes.bytes(sizes.packed, 0.0) + largest) as usize
}

/// Whether a `limit` of bytes (0: none) allows the equations of a point with the harmonics up to `highest`.
pub(crate) fn is_allowed(limit: usize, condensed: &Condensed, highest: usize, samples: usize) -> bool {
    limit == 0 || bytes_of_point(condensed, highest, samples) <= limit
}

/// Refuses the equations of a point that would exceed a `limit` of bytes (0: none).
///
/// # Errors
/// `OutOfMemory` with the need and the limit.
pub(crate) fn allow_point(limit: usize, condensed: &Condensed, highest: usize, samples: usize) -> Result<()> {
    within(limit, bytes_of_point(condensed, highest, samples))
}

/// Operations and bytes that an estimate may still use.
#[derive(Clone, Copy, Debug)]
pub(super) struct Work {
    operations: f64,
    bytes: f64,
}

impl Work {
    /// The work allowed for a point of these sizes whose solution without a neighbour takes `iterations` Newton
    /// iterations, with at most `limit` bytes (0: no limit).
    pub fn of_point(point: &Sizes, iterations: usize, limit: usize) -> Self {
        let limit = if limit == 0 { f64::INFINITY } else { limit as f64 };
        Self {
            operations: WORK_LEAST
                + WORK_MULTIPLE * (iterations as f64 * point.iteration() + WORK_TABLES * point.flexibility()),
            bytes: (BYTES.0 + BYTES.1 * point.bytes(point.packed, 0.0)).min(limit),
        }
    }

    /// Reduces the remaining operations to at most the given number.
    pub fn limit(&mut self, operations: f64) {
        self.operations = self.operations.min(operations);
    }

    /// Whether a problem of so many `bytes` is within the limit.
    pub fn fits(&self, bytes: f64) -> bool {
        bytes <= self.bytes
    }

    /// The highest harmonic to which a point can be extended such that the work suffices for `times` the operations; `enough`
    /// where that is no higher.
    pub fn highest(
        &self,
        (point, enough): (&Condensed, usize),
        options: &SolverOptions,
        times: f64,
        operations: impl Fn(&Sizes) -> f64,
    ) -> usize {
        let base = point.set().base();
        let fits = |highest: usize| {
            let sizes = Sizes::extended(point, highest, extended_options(options, highest).samples);
            self.fits(2.0 * sizes.bytes(0.0, 0.0))
                && sizes.flexibility() + times * operations(&sizes) <= self.operations
        };
        let (mut low, mut high) = (0, affordable(point, MOST_EXTENDED) / base);
        if enough <= high.saturating_mul(base) && fits(enough) {
            return enough;
        }
        while high > low {
            let middle = low + (high - low).div_ceil(2);
            if fits(middle * base) {
                low = middle;
            } else {
                high = middle - 1;
            }
        }
        low * base
    }

    /// Subtracts operations from the rest; `false`, and no change, where fewer are left.
    pub fn spend(&mut self, operations: f64) -> bool {
        let affordable = operations <= self.operations;
        if affordable {
            self.operations -= operations;
        }
        affordable
    }

    /// Number of operations left.
    pub fn left(&self) -> f64 {
        self.operations
    }
}
