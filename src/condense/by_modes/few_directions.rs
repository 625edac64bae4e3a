//! Damping of few directions beside αM + βK, as of dashpots at some nodes or ratios of some modes:
//!
//! > C = αM + βK + R,  R = L Lᴴ
//!
//! by Cholesky's method with pivots where R is positive semidefinite (Harbrecht, Peters & Schneider 2012,
//! doi:10.1016/j.apnum.2011.10.001), else R = D S Dᴴ with the unit vectors D of its rows and columns. A basis that begins with A⁻¹D
//! holds A⁻¹R x for any x, so that images of R need no columns of their own.

use crate::error::{Result, try_copy, try_push, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::dense::complex_products;
use crate::linalg::iterative::block_krylov::SparseVector;
use crate::linalg::sparse_storage::sparse::Csc;
use num_complex::Complex64;

const CONTEXT: &str = "the directions of the damping";

/// Degrees of freedom over directions, and the most directions: a basis begins with them and has a few hundred columns, and the term of a
/// sum over modes costs their cube.
/// Kind: cap.
const DEGREES_PER_DIRECTION: usize = 6;
const MOST_DIRECTIONS: usize = 200;

/// Entry of R over the sum of its terms that is rounding.
/// Kind: rounding.
const OF_ROUNDING: f64 = 1e-12;

/// Part of a diagonal entry that is left of it, beyond which a direction is none of rounding.
/// Kind: rounding.
const LEFT_OF_ENTRY: f64 = 4e-12;

/// Difference of products with R and L Lᴴ, relative to the diagonal, beyond which R is not of this form.
/// Kind: rounding.
const NOT_SEMIDEFINITE: f64 = 1e-10;

/// Size of αM + βK over that of C, in a diagonal entry, beyond which R cancels it.
/// Kind: tuned; measured on: not recorded.
const CANCELS: f64 = 100.0;

/// Share of the terms of a diagonal entry of R below which it has few digits.
/// Kind: tuned; measured on: not recorded.
const SMALL_SHARE: f64 = 1e-3;

/// Columns from whose entries α and β are taken.
/// Kind: tuned; measured on: not recorded.
const SAMPLED_COLUMNS: usize = 8;

/// Damping split as αM + βK + R, with R = D S Dᴴ of few directions D.
pub(crate) struct FewDirections {
    pub proportional: (f64, f64),
    /// Directions: the columns of D, over the degrees of freedom.
    pub directions: Vec<SparseVector>,
    /// S of R = D S Dᴴ, column after column; `None` where S is the identity.
    pub middle: Option<Vec<Complex64>>,
}

/// Splits damping C, all matrices on one pattern, into αM + βK and few directions; `None` where it has many. The α
/// and β tried first are the `given` ones, then those by which most entries of C − αM − βK vanish.
pub(crate) fn few_directions(
    pattern: &Csc,
    matrices: [&[Complex64]; 3],
    given: (f64, f64),
    interrupt: &Interrupt<'_>,
) -> Result<Option<FewDirections>> {
    let most = (pattern.cols / DEGREES_PER_DIRECTION).min(MOST_DIRECTIONS);
    for candidate in [Some(given), sampled(pattern, matrices, interrupt)?] {
        let Some(proportional) = candidate else { continue };
        let rest = Rest::new(pattern, matrices, proportional)?;
        if rest.cancels() {
            continue;
        }
        if let Some((directions, middle)) = rest.directions(most, interrupt)? {
            return Ok(Some(FewDirections {
                proportional,
                directions,
                middle,
            }));
        }
    }
    Ok(None)
}

impl FewDirections {
    /// Whether R is real.
    pub fn is_real(&self) -> bool {
        let entries = self.directions.iter().flatten().map(|(_, z)| z);
        entries.chain(self.middle.iter().flatten()).all(|z| z.im == 0.0)
    }

    /// VᴴRV for a basis V, where `seen` holds the rows DᴴV, one number for each direction in each of `order` columns.
    pub fn on_basis(&self, seen: &[Complex64], order: usize, interrupt: &Interrupt<'_>) -> Result<Vec<Complex64>> {
        let count = self.directions.len();
        let mut weighted = try_copy(seen, CONTEXT)?;
        if let Some(middle) = &self.middle {
            complex_products::multiply(middle, seen, &mut weighted, count);
        }
        let mut found = try_vec(order * order, Complex64::ZERO, CONTEXT)?;
        interrupt.check_before((8 * order * order * count) as u64)?;
        complex_products::multiply_adjoint(seen, &weighted, &mut found, count);
        Ok(found)
    }
}

/// One entry c − αm − βk of C − αM − βK, set to zero where it is rounding.
fn remainder([m, k, c]: [Complex64; 3], (alpha, beta): (f64, f64)) -> Complex64 {
    let (of_mass, of_stiffness) = (alpha * m, beta * k);
    let r = c - of_mass - of_stiffness;
    if r.norm() <= OF_ROUNDING * (c.norm() + of_mass.norm() + of_stiffness.norm()) {
        Complex64::ZERO
    } else {
        r
    }
}

/// Finds α and β by which most entries of C − αM − βK vanish. Candidates are the pairs that fit a diagonal entry and
/// the largest other entry of some column.
fn sampled(pattern: &Csc, [m, k, c]: [&[Complex64]; 3], interrupt: &Interrupt<'_>) -> Result<Option<(f64, f64)>> {
    let n = pattern.cols;
    let step = n.div_ceil(SAMPLED_COLUMNS).max(1);
    let (mut best, mut fewest) = (None, c.len());
    for j in (0..n).step_by(step) {
        interrupt.check_before(10 * c.len() as u64)?;
        let entries = pattern.col_ptr[j]..pattern.col_ptr[j + 1];
        let own = entries.clone().find(|&at| pattern.row_idx[at] == j);
        let beside = entries.filter(|&at| pattern.row_idx[at] != j);
        let beside = beside.max_by(|&a, &b| k[a].norm_sqr().total_cmp(&k[b].norm_sqr()));
        let (Some(own), Some(beside)) = (own, beside) else {
            continue;
        };
        let determinant = m[own] * k[beside] - m[beside] * k[own];
        let alpha = (c[own] * k[beside] - c[beside] * k[own]) / determinant;
        let beta = (m[own] * c[beside] - m[beside] * c[own]) / determinant;
        let found = (alpha.re, beta.re);
        if !(found.0.is_finite() && found.1.is_finite()) {
            continue;
        }
        let left = |at: &usize| remainder([m[*at], k[*at], c[*at]], found) != Complex64::ZERO;
        let count = (0..c.len()).filter(left).count();
        if count < fewest {
            (best, fewest) = (Some(found), count);
        }
    }
    Ok(best)
}

/// Directions D and middle matrix S of R = D S Dᴴ.
type Product = (Vec<SparseVector>, Option<Vec<Complex64>>);

/// R = C − αM − βK on the rows and columns in which it has entries.
struct Rest<'a> {
    pattern: &'a Csc,
    matrices: [&'a [Complex64]; 3],
    proportional: (f64, f64),
    /// Degrees of freedom in which R has entries; and the position of each degree of freedom among them.
    touched: Vec<usize>,
    place: Vec<usize>,
}

impl<'a> Rest<'a> {
    fn new(pattern: &'a Csc, matrices: [&'a [Complex64]; 3], proportional: (f64, f64)) -> Result<Self> {
        let n = pattern.cols;
        let mut rest = Self {
            pattern,
            matrices,
            proportional,
            touched: Vec::new(),
            place: try_vec(n, usize::MAX, CONTEXT)?,
        };
        let mut place = try_vec(n, usize::MAX, CONTEXT)?;
        for j in 0..n {
            for (i, _) in rest.of_degree(j) {
                place[i] = 0;
                place[j] = 0;
            }
        }
        for (j, place) in place.iter_mut().enumerate().filter(|(_, place)| **place == 0) {
            *place = rest.touched.len();
            try_push(&mut rest.touched, j, CONTEXT)?;
        }
        rest.place = place;
        Ok(rest)
    }

    /// Whether R takes away what αM + βK adds to a diagonal entry, as where a stiff link has no damping: the sum would have lost the
    /// digits of C.
    fn cancels(&self) -> bool {
        let ([m, k, c], (alpha, beta)) = (self.matrices, self.proportional);
        let own = (0..self.touched.len()).filter_map(|p| self.diagonal(p));
        own.into_iter()
            .any(|at| (alpha * m[at] + beta * k[at]).norm() > CANCELS * c[at].norm())
    }

    /// Position in the pattern of the diagonal entry of the p-th degree of freedom in which R has entries.
    fn diagonal(&self, p: usize) -> Option<usize> {
        let (pattern, j) = (self.pattern, self.touched[p]);
        (pattern.col_ptr[j]..pattern.col_ptr[j + 1]).find(|&at| pattern.row_idx[at] == j)
    }

    /// Rows and values of R in the column of a degree of freedom.
    fn of_degree(&self, j: usize) -> impl Iterator<Item = (usize, Complex64)> + '_ {
        let [m, k, c] = self.matrices;
        let entries = self.pattern.col_ptr[j]..self.pattern.col_ptr[j + 1];
        let value = move |at: usize| remainder([m[at], k[at], c[at]], self.proportional);
        let all = entries.map(move |at| (self.pattern.row_idx[at], value(at)));
        all.filter(|(_, r)| *r != Complex64::ZERO)
    }

    /// Rows and values of R in the column of the p-th degree of freedom in which R has entries.
    fn column(&self, p: usize) -> impl Iterator<Item = (usize, Complex64)> + '_ {
        self.of_degree(self.touched[p]).map(|(i, r)| (self.place[i], r))
    }

    /// The columns of L, or unit vectors where R is not semidefinite; `None` where there would be more than `most`.
    fn directions(&self, most: usize, interrupt: &Interrupt<'_>) -> Result<Option<Product>> {
        let mut found = Vec::new();
        if let Some(factor) = self.semidefinite_factor(most, interrupt)? {
            for column in factor {
                let mut direction = Vec::new();
                for (&dof, z) in self.touched.iter().zip(column).filter(|(_, z)| *z != Complex64::ZERO) {
                    try_push(&mut direction, (dof, z), CONTEXT)?;
                }
                try_push(&mut found, direction, CONTEXT)?;
            }
            return Ok(Some((found, None)));
        }
        let count = self.touched.len();
        if count > most {
            return Ok(None);
        }
        let mut middle = try_vec(count * count, Complex64::ZERO, CONTEXT)?;
        for (p, &dof) in self.touched.iter().enumerate() {
            let mut direction = Vec::new();
            try_push(&mut direction, (dof, Complex64::ONE), CONTEXT)?;
            try_push(&mut found, direction, CONTEXT)?;
            for (i, r) in self.column(p) {
                middle[p * count + i] = r;
            }
        }
        Ok(Some((found, Some(middle))))
    }

    /// Sum of the moduli of the terms c, αm and βk of the diagonal entry of the p-th degree of freedom in which R has
    /// entries.
    fn terms(&self, p: usize) -> f64 {
        let ([m, k, c], (alpha, beta)) = (self.matrices, self.proportional);
        self.diagonal(p)
            .map_or(0.0, |at| c[at].norm() + (alpha * m[at]).norm() + (beta * k[at]).norm())
    }

    /// The columns of L with R = L Lᴴ; `None` where there would be more than `most`, or R is not semidefinite. Pivots
    /// are compared after division by their diagonal entries, so that units do not matter, or by the share of their
    /// terms in which R has no digits.
    fn semidefinite_factor(&self, most: usize, interrupt: &Interrupt<'_>) -> Result<Option<Vec<Vec<Complex64>>>> {
        let n = self.touched.len();
        let (mut own, mut left) = (try_vec(n, 0.0_f64, CONTEXT)?, try_vec(n, 0.0_f64, CONTEXT)?);
        for (j, (own, left)) in own.iter_mut().zip(&mut left).enumerate() {
            let r = self.column(j).find(|(i, _)| *i == j).map_or(0.0, |(_, r)| r.re);
            *own = r.max(SMALL_SHARE * self.terms(j));
            if r < 0.0 || *own == 0.0 {
                return Ok(None);
            }
            *left = r / *own;
        }
        let mut factor: Vec<Vec<Complex64>> = Vec::new();
        loop {
            let pivot = (0..n).max_by(|&a, &b| left[a].total_cmp(&left[b]));
            let Some(p) = pivot.filter(|&p| left[p] > LEFT_OF_ENTRY) else {
                break;
            };
            if factor.len() == most {
                return Ok(None);
            }
            interrupt.check_before(8 * (n * (factor.len() + 1)) as u64)?;
            let mut column = try_vec(n, Complex64::ZERO, CONTEXT)?;
            for (i, r) in self.column(p) {
                column[i] = r;
            }
            for known in factor.iter().filter(|known| known[p] != Complex64::ZERO) {
                let share = known[p].conj();
                for (to, z) in column.iter_mut().zip(known) {
                    *to -= z * share;
                }
            }
            let scale = (left[p] * own[p]).sqrt().recip();
            for ((z, left), own) in column.iter_mut().zip(&mut left).zip(&own) {
                *z *= scale;
                *left -= z.norm_sqr() / own;
            }
            left[p] = 0.0;
            try_push(&mut factor, column, CONTEXT)?;
        }
        Ok(self.is_product(&factor, &own, interrupt)?.then_some(factor))
    }

    /// Whether R = L Lᴴ, checked by the products of both with one motion, scaled by the diagonal entries.
    fn is_product(&self, factor: &[Vec<Complex64>], own: &[f64], interrupt: &Interrupt<'_>) -> Result<bool> {
        let n = self.touched.len();
        let motion = |j: usize| Complex64::cis(1.7 * (j as f64) + 0.3) / own[j].sqrt();
        let mut off = try_vec(n, Complex64::ZERO, CONTEXT)?;
        for j in 0..n {
            interrupt.check_before(8 * n as u64)?;
            for (i, r) in self.column(j) {
                off[i] += r * motion(j);
            }
        }
        for column in factor {
            let along: Complex64 = column.iter().enumerate().map(|(j, z)| z.conj() * motion(j)).sum();
            for (off, z) in off.iter_mut().zip(column) {
                *off -= z * along;
            }
        }
        Ok(off
            .iter()
            .zip(own)
            .all(|(off, own)| off.norm() <= NOT_SEMIDEFINITE * own.sqrt()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// M = 2, K of a chain of springs of 3 and C = αM + βK + R on one pattern of all entries.
    fn matrices(n: usize, (alpha, beta): (f64, f64), r: impl Fn(usize, usize) -> f64) -> (Csc, [Vec<Complex64>; 3]) {
        let entry = |i: usize, j: usize| [6.0, -3.0].get(i.abs_diff(j)).copied().unwrap_or(0.0);
        let all = |value: &dyn Fn(usize, usize) -> f64| -> Vec<Complex64> {
            let places = (0..n * n).map(|at| (at % n, at / n));
            places.map(|(i, j)| value(i, j).into()).collect()
        };
        let mass = |i: usize, j: usize| if i == j { 2.0 } else { 0.0 };
        let damping = |i: usize, j: usize| alpha * mass(i, j) + beta * entry(i, j) + r(i, j);
        let triplets = (0..n * n).map(|at| (at % n, at / n, Complex64::ONE)).collect();
        let pattern = Csc::from_triplets(n, n, triplets).unwrap();
        (pattern, [all(&mass), all(&entry), all(&damping)])
    }

    fn found(n: usize, given: (f64, f64), known: (f64, f64), r: impl Fn(usize, usize) -> f64) -> Option<FewDirections> {
        let (pattern, [m, k, c]) = matrices(n, given, r);
        few_directions(&pattern, [&m, &k, &c], known, &Interrupt::none()).unwrap()
    }

    #[test]
    fn dashpots_are_found_beside_proportional_damping_that_nobody_told() {
        // A dashpot to ground at 4 and one between 9 and 17: two directions.
        let r = |i: usize, j: usize| match (i, j) {
            (4, 4) => 0.3,
            (9, 9) | (17, 17) => 0.2,
            (9, 17) | (17, 9) => -0.2,
            _ => 0.0,
        };
        let few = found(30, (0.02, 1e-3), (0.0, 0.0), r).unwrap();
        assert!((few.proportional.0 - 0.02).abs() < 1e-14 && (few.proportional.1 - 1e-3).abs() < 1e-15);
        assert_eq!(few.directions.len(), 2);
        for direction in &few.directions {
            let places: Vec<usize> = direction.iter().map(|(i, _)| *i).collect();
            assert!(places == [4] || places == [9, 17], "{places:?}");
        }
    }

    #[test]
    fn damping_of_some_modes_has_as_many_directions() {
        let (n, modes) = (40, 5);
        let shape = |r: usize, i: usize| (0.3 * (r + 1) as f64 * (i + 1) as f64).sin();
        let r = |i: usize, j: usize| {
            (0..modes)
                .map(|k| 0.1 * (k + 1) as f64 * shape(k, i) * shape(k, j))
                .sum()
        };
        let few = found(n, (0.1, 0.0), (0.1, 0.0), r).unwrap();
        assert_eq!(few.directions.len(), modes);
        assert_eq!(few.proportional, (0.1, 0.0));
    }

    #[test]
    fn gyroscopic_terms_and_negative_dampers_take_unit_vectors() {
        for sign in [1.0, -1.0] {
            let r = |i: usize, j: usize| match (i, j) {
                (3, 8) => 0.5,
                (8, 3) => -0.5 * sign,
                (3, 3) => -0.1,
                _ => 0.0,
            };
            let few = found(24, (0.0, 1e-2), (0.0, 1e-2), r).unwrap();
            assert_eq!(few.directions.len(), 2);
            assert!(few.directions.iter().all(|d| d.len() == 1 && [3, 8].contains(&d[0].0)));
        }
    }

    #[test]
    fn many_directions_are_none() {
        let r = |i: usize, j: usize| if i == j { 0.1 + 0.01 * i as f64 } else { 0.0 };
        assert!(found(24, (0.0, 1e-2), (0.0, 1e-2), r).is_none());
    }
}
