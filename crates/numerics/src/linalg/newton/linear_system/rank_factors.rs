//! Factors of a matrix that is solved quickly but for terms of low rank: a preconditioner where many contacts slip.
//!
//! With J = D + G U Vᵀ the matrix C = I + Vᵀ D⁻¹ G U has the order of the rank alone, and
//!
//! > J⁻¹ = D⁻¹ (1 − G U C⁻¹ Vᵀ D⁻¹),  det J = det D · det C.
//!
//! A contact that slips for a part of the period loses its stiffness there: its Jacobian differs from the stuck one by a matrix
//! whose rank grows with that part and hardly with the harmonics. So does that of one which sticks for a part of the period from that of
//! one which slides. The iteration finds what the terms leave.

use crate::error::{Result, Status, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::factors::lu::Lu;
use crate::linalg::newton::linear_system::crosses::Crosses;
use crate::linalg::newton::linear_system::eliminated_border::EliminatedBorder;
use crate::linalg::newton::linear_system::{Border, Forces};

const CONTEXT: &str = "the linear system of low rank";

/// Products that a matrix takes with waves where sectors differ in a share u of the contact Jacobian, for steps, tests of steps and
/// tangents: this number over (1 − u)², at most so many.
/// Kind: tuned; measured on: wheels of 24 sectors, which take 6 products for four digits at 0.13, 13 at 0.4 and 80 at 0.8, for ten
/// digits twice as many; a matrix has two or three solutions, of an estimate two.
const PRODUCTS_OF_WAVES: f64 = 13.0;
const MOST_PRODUCTS_OF_WAVES: f64 = 150.0;

/// Vectors of a basis that such a product is made orthogonal to, on average.
/// Kind: tuned; measured on: wheels of 24 sectors.
const BASIS_OF_WAVES: usize = 40;

/// Share of the contact Jacobian below which waves serve better, whatever the rank.
/// Kind: tuned; measured on: wheels of 24 sectors.
const ALIKE_SECTORS: f64 = 0.3;

/// Products that a matrix takes with factors of a block and of pairs, for steps, tests of steps and tangents.
/// Kind: tuned; measured on: a finite-element sector with 60 contacts with 3 to 83 harmonics, 30 to 300 products.
const PRODUCTS_OF_PAIRS: f64 = 150.0;

/// Multiplications of factors that take the time of one of a product.
/// Kind: tuned; measured on: matrices of order 200 to 1,000.
const OF_CORE: f64 = 0.2;

/// Multiplications that other factors take for the same.
enum Beside {
    /// One product with factors of the waves of a wheel.
    Waves { of_product: f64 },
    /// All products of a matrix with factors of a block and of pairs.
    Pairs { of_matrix: f64 },
}

/// Factors of the core matrix C, with memory.
pub(super) struct RankFactors {
    crosses: Crosses,
    lu: Option<Lu<f64>>,
    /// Length of each group.
    group: usize,
    beside: Beside,
    x: Vec<f64>,
    u: Vec<f64>,
    border: EliminatedBorder,
}

impl RankFactors {
    /// Memory for `n` unknowns in `sectors` sectors.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(n: usize, group: usize, sectors: usize) -> Result<Self> {
        Ok(Self {
            crosses: Crosses::default(),
            lu: None,
            group,
            // The product itself, its waves and their transforms, and its orthogonalisation.
            beside: Beside::Waves {
                of_product: n as f64 * (4 * (n / sectors.max(1)) + 4 * sectors + 4 * BASIS_OF_WAVES) as f64,
            },
            x: Vec::new(),
            u: Vec::new(),
            border: EliminatedBorder::new(n)?,
        })
    }

    /// Memory for `n` unknowns in groups that are no sectors.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn beside_pairs(n: usize, group: usize) -> Result<Self> {
        let groups = n / group.max(1);
        Ok(Self {
            // The flexibility, the pairs and the laws, and the orthogonalisation.
            beside: Beside::Pairs {
                of_matrix: PRODUCTS_OF_PAIRS * n as f64 * (4 * groups + group + 2 * BASIS_OF_WAVES) as f64,
            },
            ..Self::new(n, group, 1)?
        })
    }

    /// Factors a Jacobian; `false` where other factors are better.
    ///
    /// # Errors
    /// `OutOfMemory`; `StoppedByCaller`.
    pub fn factor(&mut self, forces: &mut dyn Forces, interrupt: &Interrupt<'_>) -> Result<bool> {
        let n = forces.groups() * self.group;
        let most = match self.beside {
            Beside::Waves { of_product } => {
                let unlikeness = forces.unlikeness()?;
                if unlikeness < ALIKE_SECTORS {
                    return Ok(false);
                }
                let products = (PRODUCTS_OF_WAVES / (1.0 - unlikeness).powi(2)).min(MOST_PRODUCTS_OF_WAVES);
                self.most(1.0, products * of_product, n)
            }
            Beside::Pairs { of_matrix } => self.most(OF_CORE, of_matrix, n),
        };
        if !forces.begin(interrupt)? {
            return Ok(false);
        }
        let Some(rank) = self.crosses.find(forces, self.group, most)? else {
            return Ok(false);
        };
        if self.u.is_empty() {
            self.u = try_vec(forces.groups() * self.group, 0.0, CONTEXT)?;
        }
        let known = self.lu.take().filter(|_| rank <= self.x.len());
        let lu = if let Some(known) = known {
            known
        } else {
            // A quarter more for the ranks of the next points.
            let order = rank + rank / 4;
            self.x = try_vec(order, 0.0, CONTEXT)?;
            Lu::new(order, 1)?
        };
        let lu = self.lu.insert(lu);
        lu.set_order(rank);
        self.crosses.fill_core(forces, self.group, &mut self.u, lu.matrix())?;
        match lu.factor(interrupt) {
            Err(e) if e.status == Status::Singular => Ok(false),
            factored => factored.map(|()| true),
        }
    }

    /// Highest rank at which the core matrix takes no more than these multiplications, each of its factors counted as so many.
    fn most(&self, of_factors: f64, multiplications: f64, n: usize) -> usize {
        let of_rank = |rank: usize| (rank * rank) as f64 * (of_factors * rank as f64 / 3.0 + self.group as f64);
        (1..n).take_while(|rank| of_rank(*rank) <= multiplications).count()
    }

    /// Takes over the border of the bordered matrix.
    ///
    /// # Errors
    /// Those of the forces.
    pub fn set_border(&mut self, forces: &mut dyn Forces, border: Border<'_>) -> Result<()> {
        let mut column = self.border.column(border);
        let solved = self.solve_inner(forces, &mut column);
        self.border.set(border, column);
        solved
    }

    /// v ← M⁻¹ v with M = [J s_u, r s_p; tᵀ].
    ///
    /// # Errors
    /// Those of the forces.
    pub fn solve(&mut self, forces: &mut dyn Forces, v: &mut [f64]) -> Result<()> {
        let n = v.len() - 1;
        self.solve_inner(forces, &mut v[..n])?;
        self.border.solve(v);
        Ok(())
    }

    /// u ← J⁻¹ u.
    fn solve_inner(&mut self, forces: &mut dyn Forces, u: &mut [f64]) -> Result<()> {
        let Some(lu) = &self.lu else { return Ok(()) };
        let x = &mut self.x[..lu.order()];
        forces.divide(u);
        self.crosses.reduce(self.group, u, x);
        lu.solve(x);
        // u is D⁻¹ u already.
        self.crosses.expand(self.group, x, &mut self.u);
        forces.subtract_response(&self.u, u)
    }

    /// Whether det M is positive.
    pub fn is_positive(&self) -> bool {
        let core = self.lu.as_ref().is_none_or(Lu::is_positive);
        core == self.border.keeps_sign()
    }
}
