//! The extended problem, with more harmonics than the point, and the linear system of its Newton steps.

use crate::error::{Result, Status, try_vec};
use crate::error_estimate::estimate::CONTEXT;
use crate::linalg::linear_system::dense::DenseSystem;
use crate::linalg::linear_system::krylov::KrylovSystem;
use crate::linalg::linear_system::{Border, LinearSystem};
use crate::problem::harmonic_balance::HarmonicBalance;
use crate::problem::newton_products::packed_up_to;
use crate::problem::{Problem, Residual};

/// Relative residual of a step that is found by iteration: a hundredth of the share that decides.
const TOLERANCE: f64 = 1e-3;

/// Unknowns up to which factoring the whole matrix is faster.
const DENSE_UP_TO: usize = 100;

/// Most products of an iteration.
const MOST_PRODUCTS: usize = 80;

/// A problem R(Z) = 0 at a fixed parameter, with the backend that solves its linear equations.
pub(super) struct ExtendedSystem<P> {
    pub problem: P,
    parameter: f64,
    pub at: Residual,
    system: Box<dyn LinearSystem>,
    /// Carried harmonics in the block that is factored; 0 if the whole matrix is.
    harmonics: usize,
    /// Border of a fixed parameter: no column, and the row (0, …, 0, 1).
    column: Vec<f64>,
    row: Vec<f64>,
    b: Vec<f64>,
}

impl<P: Problem> ExtendedSystem<P> {
    /// A problem at a parameter value with the dense backend.
    pub fn dense(problem: P, parameter: f64) -> Result<Self> {
        let system = Box::new(DenseSystem::new(problem.size())?);
        Self::new(problem, parameter, system)
    }

    fn new(problem: P, parameter: f64, system: Box<dyn LinearSystem>) -> Result<Self> {
        let n = problem.size();
        let mut row = try_vec(n + 1, 0.0, CONTEXT)?;
        row[n] = 1.0;
        Ok(Self {
            problem,
            parameter,
            at: Residual::new(n)?,
            system,
            harmonics: 0,
            column: try_vec(n, 0.0, CONTEXT)?,
            row,
            b: try_vec(n + 1, 0.0, CONTEXT)?,
        })
    }

    /// Evaluates R; `false` where that failed and may succeed elsewhere.
    pub fn evaluate(&mut self, z: &[f64]) -> Result<bool> {
        match self.problem.evaluate(z, self.parameter, &mut self.at) {
            Err(e) if e.recoverable || e.status == Status::Singular => Ok(false),
            evaluated => evaluated.map(|()| self.at.values.iter().all(|r| r.is_finite())),
        }
    }

    /// Factors Newton's matrix at the point evaluated last; `false` where it is singular.
    pub fn factor(&mut self) -> Result<bool> {
        let border = Border {
            column: &self.column,
            scales: (1.0, 1.0),
            row: &self.row,
        };
        self.system.update(&mut self.problem, border)?;
        match self.system.factor() {
            Err(e) if e.status == Status::Singular => Ok(false),
            factored => factored.map(|()| true),
        }
    }

    /// −J⁻¹R with the matrix factored last and R as evaluated last; `false` where the iteration did not converge.
    pub fn step(&mut self, step: &mut [f64]) -> Result<bool> {
        let n = step.len();
        for (b, r) in self.b.iter_mut().zip(&self.at.values) {
            *b = -r;
        }
        self.b[n] = 0.0;
        let solved = self.system.solve(&mut self.problem, &mut self.b)?;
        step.copy_from_slice(&self.b[..n]);
        Ok(solved)
    }
}

impl<'a> ExtendedSystem<HarmonicBalance<'a>> {
    /// A forced response at an angular frequency. The first `harmonics` carried ones, in which the structure is
    /// compliant, form the block that is factored; the others are found by iteration.
    pub fn iterative(problem: HarmonicBalance<'a>, omega: f64, harmonics: usize) -> Result<Self> {
        let harmonics = block_of(&problem, harmonics);
        let system = krylov(&problem, harmonics)?;
        let mut extended = Self::new(problem, omega, Box::new(system))?;
        extended.harmonics = harmonics;
        Ok(extended)
    }

    /// Selects another frequency, and the number of carried harmonics in the block.
    pub fn set_point(&mut self, omega: f64, harmonics: usize) -> Result<()> {
        self.parameter = omega;
        let harmonics = block_of(&self.problem, harmonics);
        if harmonics != self.harmonics {
            self.system = Box::new(krylov(&self.problem, harmonics)?);
            self.harmonics = harmonics;
        }
        Ok(())
    }
}

/// Carried harmonics in the block; all of them for a small problem.
fn block_of(problem: &HarmonicBalance<'_>, harmonics: usize) -> usize {
    let whole = problem.set().numbers().len();
    if problem.unknowns() <= DENSE_UP_TO {
        whole
    } else {
        harmonics
    }
}

fn krylov(problem: &HarmonicBalance<'_>, harmonics: usize) -> Result<KrylovSystem> {
    let set = problem.set();
    let lengths = (set.packed_len(), packed_up_to(set, harmonics));
    KrylovSystem::new(problem.unknowns(), lengths, TOLERANCE, MOST_PRODUCTS)
}
