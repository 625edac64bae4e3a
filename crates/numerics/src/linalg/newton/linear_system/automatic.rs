//! The backend that suits the matrix at hand: direct where few columns differ from those of the identity, iterative
//! where many do and the problem has products with its Jacobian.
//!
//! The factors of a direct solution cost as the cube of the columns, those of an iterative one little more than its
//! block of the strongly coupled unknowns.

use crate::error::{Result, boxed};
use crate::interrupt::Interrupt;
use crate::linalg::newton::linear_system::dense::DenseSystem;
use crate::linalg::newton::linear_system::krylov::{KrylovSystem, Lengths};
use crate::linalg::newton::linear_system::{Border, Jacobian, LinearSystem};

/// Columns up to which a direct solution is quicker.
/// Kind: tuned; measured on: not recorded.
const AUTOMATIC_DIRECT_UP_TO: usize = 240;

/// The same where the last numbers of a group couple as much as the first.
/// Kind: tuned; measured on: not recorded.
const DIRECT_IF_COUPLED: usize = 1200;

/// Unknowns of the factored block, unless the first numbers of the groups are more.
/// Kind: tuned; measured on: not recorded.
pub const FACTORED_BLOCK: usize = 200;

/// Most products of an iteration.
/// Kind: cap.
const AUTOMATIC_MOST_PRODUCTS: usize = 240;

/// Least relative residual that is asked of an iteration: a tangent of this error predicts as well.
/// Kind: tuned; measured on: not recorded.
const FINEST: f64 = 1e-10;

/// Updates for which the solution is direct after an iteration that did not converge.
/// Kind: tuned; measured on: not recorded.
const AUTOMATIC_PATIENCE: usize = 16;

/// A bordered system that is solved directly or by iteration.
pub struct AutomaticSystem {
    n: usize,
    dense: Option<Box<DenseSystem>>,
    krylov: Option<Box<KrylovSystem>>,
    /// Whether the matrix of the last update is solved by iteration.
    iterates: bool,
    /// Which backend holds factors: the iterative one if `true`, the dense one if `false`; `None`: neither.
    factored: Option<bool>,
    /// Number of further updates for which no iteration is tried.
    direct: usize,
}

impl AutomaticSystem {
    /// Memory for `n` unknowns and one parameter; for larger systems it is allocated at the first use.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(n: usize) -> Result<Self> {
        let dense = if n <= AUTOMATIC_DIRECT_UP_TO {
            Some(boxed(|| DenseSystem::new(n))?)
        } else {
            None
        };
        Ok(Self {
            n,
            dense,
            krylov: None,
            iterates: false,
            factored: None,
            direct: 0,
        })
    }

    /// Whether the matrix of the last update is solved by factors of the whole matrix.
    #[must_use]
    pub fn is_direct(&self) -> bool {
        !self.iterates
    }

    /// Lengths of the groups and of their parts, where an iteration is quicker; else `None`.
    fn lengths(&self, jacobian: &mut dyn Jacobian) -> Option<Lengths> {
        if self.direct > 0 || self.n <= AUTOMATIC_DIRECT_UP_TO {
            return None;
        }
        let operator = jacobian.matrix_free()?;
        let group = operator.group();
        let direct_up_to = if operator.couples_all() {
            DIRECT_IF_COUPLED
        } else {
            AUTOMATIC_DIRECT_UP_TO
        };
        if operator.ring().is_some() {
            return (operator.coupled() > direct_up_to).then_some(Lengths::of_ring(group));
        }
        // The mean is one number, each harmonic a pair.
        let first = group % 2 + 2;
        let behind = operator.behind();
        let groups = (self.n - behind) / group.max(1);
        let pairs = (FACTORED_BLOCK / groups.max(1)).saturating_sub(group % 2) / 2;
        let part = first.max(group % 2 + 2 * pairs);
        let lengths = Lengths {
            group,
            part,
            middle: group,
            behind,
        };
        (part < group && operator.coupled() > direct_up_to).then_some(lengths)
    }

    fn attainable(&self, tolerance: f64) -> f64 {
        if self.iterates {
            tolerance.max(FINEST)
        } else {
            tolerance
        }
    }

    fn backend(&mut self) -> Result<&mut dyn LinearSystem> {
        if self.iterates
            && let Some(krylov) = &mut self.krylov
        {
            return Ok(&mut **krylov);
        }
        if self.dense.is_none() {
            self.dense = Some(boxed(|| DenseSystem::new(self.n))?);
        }
        match &mut self.dense {
            Some(dense) => Ok(&mut **dense),
            None => crate::error::fail!(Internal, "no linear system was made"),
        }
    }
}

impl LinearSystem for AutomaticSystem {
    fn update(&mut self, jacobian: &mut dyn Jacobian, border: Border<'_>, interrupt: &Interrupt<'_>) -> Result<()> {
        let lengths = self.lengths(jacobian);
        self.direct = self.direct.saturating_sub(1);
        self.iterates = lengths.is_some();
        if let (Some(lengths), None) = (lengths, &self.krylov) {
            let operator = jacobian.matrix_free();
            let ring = operator.as_ref().and_then(|operator| operator.ring());
            self.krylov = Some(boxed(|| match ring {
                Some(ring) => KrylovSystem::of_ring(self.n, (lengths.group, ring), AUTOMATIC_MOST_PRODUCTS),
                None => KrylovSystem::new(self.n, lengths, AUTOMATIC_MOST_PRODUCTS),
            })?);
        }
        self.backend()?.update(jacobian, border, interrupt)
    }

    fn factor(&mut self, jacobian: &mut dyn Jacobian, interrupt: &Interrupt<'_>) -> Result<()> {
        self.factored = None;
        self.backend()?.factor(jacobian, interrupt)?;
        self.factored = Some(self.iterates);
        Ok(())
    }

    fn solve(
        &mut self,
        jacobian: &mut dyn Jacobian,
        tolerance: f64,
        b: &mut [f64],
        interrupt: &Interrupt<'_>,
    ) -> Result<bool> {
        let tolerance = self.attainable(tolerance);
        self.backend()?.solve(jacobian, tolerance, b, interrupt)
    }

    fn apply(&mut self, jacobian: &mut dyn Jacobian, x: &[f64], out: &mut [f64]) -> Result<()> {
        self.backend()?.apply(jacobian, x, out)
    }

    fn apply_last(&mut self, weights: [f64; 3], x: &[f64], out: &mut [f64]) -> bool {
        let dense = self.dense.as_mut().filter(|_| !self.iterates);
        dense.is_some_and(|dense| dense.apply_last(weights, x, out))
    }

    fn solve_by_earlier_factors(
        &mut self,
        jacobian: &mut dyn Jacobian,
        tolerance: f64,
        b: &mut [f64],
        interrupt: &Interrupt<'_>,
    ) -> Result<bool> {
        if self.factored != Some(self.iterates) {
            return Ok(false);
        }
        let tolerance = self.attainable(tolerance);
        self.backend()?
            .solve_by_earlier_factors(jacobian, tolerance, b, interrupt)
    }

    fn products(&self) -> usize {
        let krylov = self.krylov.as_ref().filter(|_| self.iterates);
        krylov.map_or(0, |krylov| krylov.products())
    }

    fn solve_directly(&mut self) -> bool {
        if !self.iterates {
            return false;
        }
        self.direct = AUTOMATIC_PATIENCE;
        true
    }

    fn is_positive(&self) -> bool {
        let backends = (self.iterates, &self.krylov, &self.dense);
        match backends {
            (true, Some(krylov), _) => krylov.is_positive(),
            (_, _, Some(dense)) => dense.is_positive(),
            _ => true,
        }
    }
}
