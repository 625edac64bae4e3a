//! What a lift asks of the extended problem, by a dense matrix or, where harmonics at the end hardly couple, by an
//! iteration that has the dense matrix of the others.

use crate::error::{Result, Status, try_vec};
use crate::error_estimate::estimate::CONTEXT;
use crate::linalg::bordered::Bordered;
use crate::linalg::gmres::gmres;
use crate::problem::harmonic_balance::{HarmonicBalance, packed_up_to};
use crate::problem::{Linearisation, Problem};

/// Relative residual of a step that is found by iteration: a hundredth of what decides.
const TOLERANCE: f64 = 1e-3;

/// Unknowns up to which a factorisation of all of them is quicker.
const WHOLE_UP_TO: usize = 100;

/// Most products of an iteration.
const MOST_PRODUCTS: usize = 80;

/// A extended problem R(Z) = 0.
pub(super) trait System {
    /// Evaluates R; `false` where that failed and may succeed elsewhere.
    fn evaluate(&mut self, z: &[f64]) -> Result<bool>;

    /// Keeps Newton's matrix at the point evaluated last, until the next call; `false` where it is singular.
    fn factor(&mut self) -> Result<bool>;

    /// −J⁻¹R with the matrix kept last and R as evaluated last; `false` where none was found.
    fn step(&mut self, step: &mut [f64]) -> Result<bool>;
}

/// LU factors of a matrix of which columns may be those of the identity.
struct Dense {
    matrix: Bordered,
    row: Vec<f64>,
    column: Vec<f64>,
    b: Vec<f64>,
}

impl Dense {
    fn new(n: usize) -> Result<Self> {
        let mut dense = Self {
            matrix: Bordered::new(n)?,
            row: try_vec(n + 1, 0.0, CONTEXT)?,
            column: try_vec(n, 0.0, CONTEXT)?,
            b: try_vec(n + 1, 0.0, CONTEXT)?,
        };
        dense.row[n] = 1.0;
        Ok(dense)
    }

    fn factor(&mut self, jacobian: &[f64], active: &[bool]) -> Result<bool> {
        let factored = self
            .matrix
            .factor(jacobian, &self.column, active, (1.0, 1.0), &self.row);
        match factored {
            Err(e) if e.status == Status::Singular => Ok(false),
            factored => factored.map(|()| true),
        }
    }

    /// Solves in place for the n numbers of `b`.
    fn solve(&mut self, b: impl Iterator<Item = f64>) -> &[f64] {
        for (to, from) in self.b.iter_mut().zip(b.chain(core::iter::once(0.0))) {
            *to = from;
        }
        self.matrix.solve(&mut self.b);
        &self.b[..self.column.len()]
    }
}

/// A problem with its dense matrix.
pub(super) struct Whole<'p, P> {
    pub problem: &'p mut P,
    p: f64,
    pub at: Linearisation,
    dense: Dense,
}

impl<'p, P: Problem> Whole<'p, P> {
    /// The problem at a parameter value.
    pub fn new(problem: &'p mut P, p: f64) -> Result<Self> {
        let n = problem.size();
        Ok(Self {
            p,
            at: Linearisation::new(n)?,
            dense: Dense::new(n)?,
            problem,
        })
    }
}

impl<P: Problem> System for Whole<'_, P> {
    fn evaluate(&mut self, z: &[f64]) -> Result<bool> {
        evaluates(self.problem.evaluate(z, self.p, &mut self.at), &self.at)
    }

    fn factor(&mut self) -> Result<bool> {
        self.dense.factor(&self.at.jacobian, &self.at.active)
    }

    fn step(&mut self, step: &mut [f64]) -> Result<bool> {
        step.copy_from_slice(self.dense.solve(self.at.residual.iter().map(|r| -r)));
        Ok(true)
    }
}

/// A forced response with the dense matrix between its first harmonics, the core, in which the structure gives. The
/// others are found by an iteration, which the core preconditions.
pub(super) struct Core<'a> {
    pub problem: HarmonicBalance<'a>,
    omega: f64,
    harmonics: usize,
    /// Numbers of one signal, in all and in the core.
    lengths: (usize, usize),
    pub at: Linearisation,
    dense: Dense,
    matrix: Vec<f64>,
    active: Vec<bool>,
    jacobians: Vec<f64>,
    /// Whether the contact Jacobians of the matrix that was kept are still those of the problem.
    fresh: bool,
    change: Vec<f64>,
    product: Vec<f64>,
}

impl<'a> Core<'a> {
    /// Memory for a problem, without a core.
    pub fn new(problem: HarmonicBalance<'a>) -> Result<Self> {
        let n = problem.size();
        Ok(Self {
            omega: 0.0,
            harmonics: 0,
            lengths: (problem.set().packed_len(), 0),
            at: Linearisation::without_jacobian(n)?,
            dense: Dense::new(0)?,
            matrix: Vec::new(),
            active: Vec::new(),
            jacobians: Vec::new(),
            fresh: false,
            change: try_vec(n, 0.0, CONTEXT)?,
            product: try_vec(n, 0.0, CONTEXT)?,
            problem,
        })
    }

    /// Goes to a frequency, and to a number of carried harmonics in the core.
    pub fn aim(&mut self, omega: f64, harmonics: usize) -> Result<()> {
        self.omega = omega;
        let n = self.problem.size();
        let set = self.problem.set();
        let harmonics = if n <= WHOLE_UP_TO {
            set.numbers().len()
        } else {
            harmonics
        };
        if harmonics == self.harmonics {
            return Ok(());
        }
        self.lengths.1 = packed_up_to(set, harmonics);
        let order = n / self.lengths.0.max(1) * self.lengths.1;
        self.dense = Dense::new(order)?;
        self.matrix = try_vec(order.saturating_mul(order), 0.0, CONTEXT)?;
        self.active = try_vec(order, true, CONTEXT)?;
        self.harmonics = harmonics;
        Ok(())
    }
}

/// v ← M⁻¹ v, with the matrix M of the core, and the identity beyond.
fn precondition(dense: &mut Dense, (all, part): (usize, usize), v: &mut [f64]) {
    let inner = v.chunks_exact(all).flat_map(|y| y[..part].iter().copied());
    let solved = dense.solve(inner);
    for (to, from) in v.chunks_exact_mut(all).zip(solved.chunks_exact(part)) {
        to[..part].copy_from_slice(from);
    }
}

impl System for Core<'_> {
    fn evaluate(&mut self, z: &[f64]) -> Result<bool> {
        if self.fresh {
            // The matrix that was kept needs them on.
            self.problem.forces().copy_jacobians(&mut self.jacobians)?;
            self.fresh = false;
        }
        evaluates(self.problem.evaluate_residual(z, self.omega, &mut self.at), &self.at)
    }

    fn factor(&mut self) -> Result<bool> {
        self.fresh = self.lengths.0 != self.lengths.1;
        self.problem
            .core(self.harmonics, &mut self.product, &mut self.matrix, &mut self.active);
        self.dense.factor(&self.matrix, &self.active)
    }

    fn step(&mut self, step: &mut [f64]) -> Result<bool> {
        for (s, r) in step.iter_mut().zip(&self.at.residual) {
            *s = -r;
        }
        if self.lengths.0 == self.lengths.1 {
            precondition(&mut self.dense, self.lengths, step);
            return Ok(true);
        }
        let (dense, change, product) = (&mut self.dense, &mut self.change, &mut self.product);
        let lengths = self.lengths;
        // The step belongs to the matrix that was kept, not to the motion evaluated last.
        let fresh = self.fresh;
        if !fresh {
            self.problem.forces().swap_jacobians(&mut self.jacobians);
        }
        let problem = &self.problem;
        let solved = gmres(step, TOLERANCE, MOST_PRODUCTS, |v, out| {
            product.copy_from_slice(v);
            precondition(dense, lengths, product);
            problem.multiply(product, change, out);
            Ok(())
        });
        if !fresh {
            self.problem.forces().swap_jacobians(&mut self.jacobians);
        }
        if !solved? {
            return Ok(false);
        }
        precondition(&mut self.dense, lengths, step);
        Ok(true)
    }
}

/// Whether an evaluation succeeded; `false` where another motion may not meet its failure.
fn evaluates(outcome: Result<()>, at: &Linearisation) -> Result<bool> {
    match outcome {
        Err(e) if e.recoverable || e.status == Status::Singular => Ok(false),
        evaluated => evaluated.map(|()| at.residual.iter().all(|r| r.is_finite())),
    }
}
