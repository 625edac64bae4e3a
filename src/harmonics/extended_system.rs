//! The extended problem, with more harmonics than the point, and the linear system of its Newton steps.

use crate::error::{Result, Status, try_vec};
use crate::harmonics::estimate::CONTEXT;
use crate::harmonics::work::{Sizes, Work};
use crate::interrupt::Interrupt;
use crate::linalg::newton::linear_system::krylov::{KrylovSystem, Lengths};
use crate::linalg::newton::linear_system::{Border, LinearSystem};
use crate::linalg::norm;
use crate::problem::newton_products::{PackedHarmonics, packed_up_to};
use crate::problem::{Problem, Residual};

/// Residual of steps that are found by iteration over that of the point: a hundredth of the share that decides; and the same
/// for a point that was extended before, whose further change is a part of the whole.
/// Kind: tuned; measured on: not recorded.
const EXTENDED_SYSTEM_TOLERANCE: f64 = 1e-3;
const OF_EXTENDED: f64 = 1e-2;

/// Largest residual of a step over that of its start.
/// Kind: tuned; measured on: not recorded.
const EXTENDED_SYSTEM_COARSEST: f64 = 0.1;

/// Unknowns of a whole wheel from which its waves are factored instead of a block: with fewer the block is the cheaper one.
/// Kind: tuned; measured on: not recorded.
const WAVES_FROM: usize = 480;

/// Unknowns up to which factoring the whole matrix is faster than iterating with factors of the compliant harmonics.
/// Kind: tuned; measured on: not recorded.
const EXTENDED_SYSTEM_DENSE_UP_TO: usize = 24;

/// Most products of an iteration.
/// Kind: cap.
const EXTENDED_SYSTEM_MOST_PRODUCTS: usize = 240;

/// The carried harmonics that an iterative linear system factors.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Factored {
    /// Number of the lowest carried harmonics that are factored as one block.
    pub block: usize,
    /// Number of the carried harmonics up to which the others are factored one by one, with the mean stiffness of the
    /// contacts.
    pub each: usize,
}

/// A problem R(Z) = 0 at a fixed parameter, with the backend that solves its linear equations.
pub(super) struct ExtendedSystem<P> {
    pub problem: P,
    parameter: f64,
    pub at: Residual,
    system: Box<dyn LinearSystem>,
    /// Harmonics that the linear system factors; and the number of sectors of a wheel, where it factors waves.
    factored: Factored,
    sectors: Option<usize>,
    /// Whether some iteration did not converge within [`EXTENDED_SYSTEM_MOST_PRODUCTS`] products.
    pub stalled: bool,
    /// Whether the equations are monotone, as those of exchanged motions are, see
    /// [`crate::condense::blocks::exchange`].
    pub is_monotone: bool,
    /// Size of residual down to which steps are solved.
    goal: f64,
    sizes: Sizes,
    work: Work,
    vectors: ExtendedVectors,
}

/// Memory of a step.
pub(super) struct ExtendedVectors {
    /// Border of a fixed parameter: no column, and the row (0, …, 0, 1).
    column: Vec<f64>,
    row: Vec<f64>,
    b: Vec<f64>,
}

impl<P: Problem> ExtendedSystem<P> {
    /// A problem of these sizes at a parameter value with the dense backend, and the work that it may take.
    #[cfg(test)]
    pub fn dense(problem: P, parameter: f64, sizes: Sizes, work: Work) -> Result<Self> {
        let system = Box::new(crate::linalg::newton::linear_system::dense::DenseSystem::new(
            problem.size(),
        )?);
        let harmonics = usize::MAX;
        let factored = Factored {
            block: harmonics,
            each: harmonics,
        };
        Self::new(problem, parameter, (system, factored), (sizes, work))
    }

    fn new(
        problem: P,
        parameter: f64,
        (system, factored): (Box<dyn LinearSystem>, Factored),
        (sizes, work): (Sizes, Work),
    ) -> Result<Self> {
        let n = problem.size();
        let mut row = try_vec(n + 1, 0.0, CONTEXT)?;
        row[n] = 1.0;
        Ok(Self {
            problem,
            parameter,
            at: Residual::new(n)?,
            system,
            factored,
            sectors: None,
            stalled: false,
            is_monotone: false,
            goal: 0.0,
            sizes,
            work,
            vectors: ExtendedVectors {
                column: try_vec(n, 0.0, CONTEXT)?,
                row,
                b: try_vec(n + 1, 0.0, CONTEXT)?,
            },
        })
    }

    /// Evaluates R; `false` where that failed and may succeed elsewhere, or the work does not suffice.
    pub fn evaluate(&mut self, z: &[f64]) -> Result<bool> {
        if !self.work.spend(self.sizes.evaluation()) {
            return Ok(false);
        }
        match self.problem.evaluate(z, self.parameter, &mut self.at) {
            Err(e) if e.recoverable || e.status == Status::Singular => Ok(false),
            evaluated => evaluated.map(|()| self.at.values.iter().all(|r| r.is_finite())),
        }
    }

    /// Factors Newton's matrix at the point evaluated last; `false` where it is singular, or the work does not
    /// suffice.
    pub fn factor(&mut self, interrupt: &Interrupt<'_>) -> Result<bool> {
        let (packed, pairs) = self.factored_numbers();
        let operations = match self.sectors {
            Some(sectors) => self.sizes.factors_of_waves(sectors),
            None => self.sizes.factors(packed, pairs),
        };
        if !self.work.spend(operations) {
            return Ok(false);
        }
        let border = Border {
            column: &self.vectors.column,
            scales: (1.0, 1.0),
            row: &self.vectors.row,
        };
        self.system.update(&mut self.problem, border, interrupt)?;
        match self.system.factor(&mut self.problem, interrupt) {
            Err(e) if e.status == Status::Singular => Ok(false),
            factored => factored.map(|()| true),
        }
    }

    /// Takes the residual evaluated last as that of the point, with which later steps are compared: each is smaller,
    /// and needs fewer digits.
    pub fn measure_by_point(&mut self, extended_before: bool) {
        let share = if extended_before {
            OF_EXTENDED
        } else {
            EXTENDED_SYSTEM_TOLERANCE
        };
        self.goal = share * self.residual();
    }

    /// ‖R‖ as evaluated last.
    pub fn residual(&self) -> f64 {
        norm(&self.at.values)
    }

    /// −J⁻¹R with the matrix factored last and R as evaluated last, found roughly or to the digits that count; `false` where the
    /// iteration did not converge with the work that is left.
    pub fn step(&mut self, step: &mut [f64], roughly: bool, interrupt: &Interrupt<'_>) -> Result<bool> {
        // Where a step takes few products, digits that are left out save little.
        let tolerance = if !self.iterates_long() {
            EXTENDED_SYSTEM_TOLERANCE
        } else if roughly {
            EXTENDED_SYSTEM_COARSEST
        } else {
            (self.goal / self.residual()).clamp(EXTENDED_SYSTEM_TOLERANCE, EXTENDED_SYSTEM_COARSEST)
        };
        let n = step.len();
        let each = self.of_product();
        let most = (self.work.left() / each) as usize;
        self.system.limit_products(most.min(EXTENDED_SYSTEM_MOST_PRODUCTS));
        for (b, r) in self.vectors.b.iter_mut().zip(&self.at.values) {
            *b = -r;
        }
        self.vectors.b[n] = 0.0;
        let solved = self
            .system
            .solve(&mut self.problem, tolerance, &mut self.vectors.b, interrupt)?;
        self.stalled |= !solved && most >= EXTENDED_SYSTEM_MOST_PRODUCTS;
        step.copy_from_slice(&self.vectors.b[..n]);
        Ok(self.work.spend(each * self.system.products() as f64) && solved)
    }

    /// J⁻¹b with the matrix factored last; `false` where the iteration did not converge with the work that is left.
    pub fn solve_for(&mut self, b: &[f64], x: &mut [f64], interrupt: &Interrupt<'_>) -> Result<bool> {
        let n = x.len();
        let each = self.of_product();
        self.system
            .limit_products(((self.work.left() / each) as usize).min(EXTENDED_SYSTEM_MOST_PRODUCTS));
        self.vectors.b[..n].copy_from_slice(b);
        self.vectors.b[n] = 0.0;
        let solved = self.system.solve(
            &mut self.problem,
            EXTENDED_SYSTEM_COARSEST,
            &mut self.vectors.b,
            interrupt,
        )?;
        x.copy_from_slice(&self.vectors.b[..n]);
        Ok(self.work.spend(each * self.system.products() as f64) && solved)
    }

    /// Whether solutions take many products, because the factored block does not hold all compliant harmonics.
    pub fn iterates_long(&self) -> bool {
        self.sectors.is_none() && self.factored.each > self.factored.block
    }

    /// Number of operations of one product with the Jacobian.
    fn of_product(&self) -> f64 {
        let (packed, pairs) = self.factored_numbers();
        match self.sectors {
            Some(sectors) => self.sizes.product_of_waves(sectors),
            None => self.sizes.product(packed, pairs),
        }
    }

    /// Number of bytes that the system needs.
    pub fn bytes(&self) -> f64 {
        let (packed, pairs) = self.factored_numbers();
        self.sizes.bytes(packed, pairs)
    }

    /// Remaining work of the estimate.
    pub fn work(&self) -> Work {
        self.work
    }

    /// Numbers of a packed signal in the factored block; and pairs of numbers that are factored one by one.
    fn factored_numbers(&self) -> (f64, f64) {
        let pairs = self.factored.each.saturating_sub(self.factored.block);
        (self.sizes.packed().min(2.0 * self.factored.block as f64), pairs as f64)
    }
}

impl<P: PackedHarmonics> ExtendedSystem<P> {
    /// A problem of the given sizes at a parameter value, solved by iteration, with the work that it may take.
    pub fn iterative(problem: P, parameter: f64, factored: Factored, (sizes, work): (Sizes, Work)) -> Result<Self> {
        let factored = factored_of(&problem, factored);
        let (system, sectors) = krylov(&problem, factored)?;
        let mut made = Self::new(problem, parameter, (Box::new(system), factored), (sizes, work))?;
        made.sectors = sectors;
        Ok(made)
    }

    /// Selects another parameter value, the harmonics that are factored, and the work for this point.
    pub fn set_point(&mut self, parameter: f64, factored: Factored, work: Work) -> Result<()> {
        self.parameter = parameter;
        self.work = work;
        let factored = factored_of(&self.problem, factored);
        if factored != self.factored {
            let (system, sectors) = krylov(&self.problem, factored)?;
            (self.system, self.sectors) = (Box::new(system), sectors);
            self.factored = factored;
        }
        Ok(())
    }
}

/// Harmonics to factor: all in one block for a small problem, else as given.
fn factored_of(problem: &impl PackedHarmonics, factored: Factored) -> Factored {
    let whole = problem.harmonics().numbers().len();
    if problem.size() <= EXTENDED_SYSTEM_DENSE_UP_TO {
        Factored {
            block: whole,
            each: whole,
        }
    } else {
        factored
    }
}

/// The iterative linear system; and the number of sectors of a wheel where it factors waves, unless one block of all
/// harmonics is requested.
fn krylov(problem: &impl PackedHarmonics, factored: Factored) -> Result<(KrylovSystem, Option<usize>)> {
    let set = problem.harmonics();
    let part = packed_up_to(set, factored.block);
    let group = set.packed_len();
    if let Some(ring) = problem.ring().filter(|_| part < group && problem.size() >= WAVES_FROM) {
        let system = KrylovSystem::of_ring(problem.size(), (group, ring), EXTENDED_SYSTEM_MOST_PRODUCTS)?;
        return Ok((system, Some(ring.sectors)));
    }
    let lengths = Lengths {
        group,
        part,
        middle: packed_up_to(set, factored.each).max(part),
        behind: problem.behind(),
    };
    Ok((
        KrylovSystem::new(problem.size(), lengths, EXTENDED_SYSTEM_MOST_PRODUCTS)?,
        None,
    ))
}

#[cfg(test)]
mod tests {
    use super::{EXTENDED_SYSTEM_DENSE_UP_TO, ExtendedSystem, Factored};
    use crate::condense::Condensed;
    use crate::contact::Contact;
    use crate::harmonics::work::{Sizes, Work};
    use crate::interrupt::Interrupt;
    use crate::linalg::newton::linear_system::{Jacobian, MatrixFree};
    use crate::linalg::norm;
    use crate::linalg::sparse_storage::matrix_view::MatrixView;
    use crate::model::Model;
    use crate::model::matrices::structure::MatrixKind;
    use crate::options::SolverOptions;
    use crate::problem::harmonic_balance::HarmonicBalance;

    /// A mass that strikes a stop, with harmonics up to 31: those above the third are weak.
    #[test]
    fn steps_by_iteration_are_those_by_factors_of_the_whole_matrix() {
        let mut model = Model::new(1).unwrap();
        for (kind, value) in [
            (MatrixKind::Mass, 1.0),
            (MatrixKind::Damping, 0.05),
            (MatrixKind::Stiffness, 1.0),
        ] {
            model.set_matrix(kind, &MatrixView::dense(1, &[value])).unwrap();
        }
        model
            .add_contact(&Contact::unilateral(None, Some(0), 5.0, 0.2))
            .unwrap();
        model.add_force(0, 1, 0.1.into()).unwrap();
        let (omega, none) = (1.2, Interrupt::none());
        let options = SolverOptions {
            harmonics: 31,
            ..SolverOptions::default()
        };
        let condensed = Condensed::new(&model, &options, omega, &none).unwrap();
        let problem = || HarmonicBalance::new(&condensed, 0, (omega, omega).into(), 0, None, &none).unwrap();
        let sizes = Sizes::new(&condensed, 0);
        let work = Work::of_point(&sizes, 40, 0);
        let bounded = |enough| work.highest((&condensed, enough), &options, 1.0, Sizes::evaluation);
        let most = bounded(usize::MAX);
        assert!(most > 63 && [31, 63, most, most + 1].map(bounded) == [31, 63, most, most]);
        let n = condensed.unknowns();
        assert!(n > EXTENDED_SYSTEM_DENSE_UP_TO);
        let few = Factored { block: 4, each: 4 };
        let mut whole = ExtendedSystem::dense(problem(), omega, sizes, work).unwrap();
        let mut part = ExtendedSystem::iterative(problem(), omega, few, (sizes, work)).unwrap();
        // Motions of three harmonics that touch the stop for a short and for a long time.
        for amplitude in [0.25, 0.6, 2.0] {
            let mut z = vec![0.0; n];
            z[..7].copy_from_slice(&[-0.1, 1.0, 0.3, 0.2, -0.1, 0.05, 0.1].map(|x| x * amplitude));
            let steps = [&mut whole, &mut part].map(|system| {
                let mut step = vec![0.0; n];
                assert!(system.evaluate(&z).unwrap() && system.factor(&none).unwrap());
                assert!(system.step(&mut step, false, &none).unwrap());
                step
            });
            // A block of all harmonics is filled as the whole matrix, which has fewer operations.
            let (m, mut active) = (condensed.set().packed_len(), vec![true; n]);
            let [mut filled, mut block] = [0; 2].map(|_| vec![0.0; n * n]);
            part.problem.fill(&mut filled, &mut active).unwrap();
            part.problem.fill_block(m, &mut block, &mut active).unwrap();
            let scale = norm(&filled);
            assert!(filled.iter().zip(&block).all(|(a, b)| (a - b).abs() <= 1e-13 * scale));
            let [a, b] = &steps;
            let off: Vec<f64> = a.iter().zip(b).map(|(a, b)| a - b).collect();
            assert!(norm(&off) <= 1e-2 * norm(a), "{amplitude}: {:e}", norm(&off) / norm(a));
        }
    }
}
