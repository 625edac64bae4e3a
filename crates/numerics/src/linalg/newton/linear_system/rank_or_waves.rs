//! Factors that serve an iteration in place of a block and of pairs: terms of low rank, or the waves of a wheel.

use crate::error::Result;
use crate::interrupt::Interrupt;
use crate::linalg::newton::linear_system::rank_factors::RankFactors;
use crate::linalg::newton::linear_system::sector_waves::RingFactors;
use crate::linalg::newton::linear_system::{Border, MatrixFree, Ring};

/// Most factorisations by other factors after terms of low rank that were too many.
/// Kind: cap.
const MOST_LEFT_OUT: usize = 16;

/// Factors of the terms of low rank, and of the waves of a wheel.
pub(super) struct RankOrWaves {
    waves: Option<RingFactors>,
    rank: RankFactors,
    by_rank: bool,
    /// Factorisations until the terms are looked for again, and how many were left out before the last search.
    left: usize,
    wait: usize,
}

impl RankOrWaves {
    /// Memory for `n` unknowns in the sectors of a wheel.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn of_wheel(n: usize, group: usize, ring: Ring<'_>) -> Result<Self> {
        Ok(Self {
            waves: Some(RingFactors::new(n, group, ring)?),
            rank: RankFactors::new(n, group, ring.sectors)?,
            by_rank: false,
            left: 0,
            wait: 0,
        })
    }

    /// Memory for `n` unknowns in groups.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn of_groups(n: usize, group: usize) -> Result<Self> {
        Ok(Self {
            waves: None,
            rank: RankFactors::beside_pairs(n, group)?,
            by_rank: false,
            left: 0,
            wait: 0,
        })
    }

    /// Whether these factors serve, as of the last call of [`Self::factor`]; else block and pairs do.
    pub fn serve(&self) -> bool {
        self.by_rank || self.waves.is_some()
    }

    /// Factors a Jacobian; returns [`Self::serve`].
    ///
    /// # Errors
    /// Those of the factors.
    pub fn factor(&mut self, operator: &mut dyn MatrixFree, interrupt: &Interrupt<'_>) -> Result<bool> {
        self.by_rank = false;
        if self.left > 0 {
            self.left -= 1;
        } else if let Some(forces) = operator.forces() {
            self.by_rank = self.rank.factor(forces, interrupt)?;
            // A wheel tells by its sectors where to look.
            self.wait = if self.by_rank || self.waves.is_some() {
                0
            } else {
                (2 * self.wait).clamp(1, MOST_LEFT_OUT)
            };
            self.left = self.wait;
        }
        if let Some(waves) = self.waves.as_mut().filter(|_| !self.by_rank) {
            waves.factor(operator, interrupt)?;
        }
        Ok(self.serve())
    }

    /// Takes over the border of the bordered matrix.
    ///
    /// # Errors
    /// Those of the factors.
    pub fn set_border(&mut self, operator: &mut dyn MatrixFree, border: Border<'_>) -> Result<()> {
        match (operator.forces().filter(|_| self.by_rank), &mut self.waves) {
            (Some(forces), _) => self.rank.set_border(forces, border),
            (None, Some(waves)) => {
                waves.set_border(border);
                Ok(())
            }
            (None, None) => Ok(()),
        }
    }

    /// v ← M⁻¹ v.
    ///
    /// # Errors
    /// Those of the factors.
    pub fn solve(&mut self, operator: &mut dyn MatrixFree, v: &mut [f64]) -> Result<()> {
        match (operator.forces().filter(|_| self.by_rank), &mut self.waves) {
            (Some(forces), _) => self.rank.solve(forces, v),
            (None, Some(waves)) => {
                waves.solve(v);
                Ok(())
            }
            (None, None) => Ok(()),
        }
    }

    /// Whether det M is positive.
    pub fn is_positive(&self) -> bool {
        match &self.waves {
            Some(waves) if !self.by_rank => waves.is_positive(),
            _ => self.rank.is_positive(),
        }
    }
}
