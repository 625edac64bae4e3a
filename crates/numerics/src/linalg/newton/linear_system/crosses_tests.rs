//! Terms of low rank, and the factors made of them, against the whole matrix.

use super::{Crosses, LEFT_BY_CROSSES};
use crate::error::Result;
use crate::interrupt::Interrupt;
use crate::linalg::newton::linear_system::dense::DenseSystem;
use crate::linalg::newton::linear_system::rank_factors::RankFactors;
use crate::linalg::newton::linear_system::{Border, Forces, Jacobian, LinearSystem};

/// Groups of M numbers, whose forces depend on their own motion and that of the next group by few terms.
struct Structure {
    n: usize,
    unlikeness: f64,
    flexibility: Vec<f64>,
    diagonal: Vec<f64>,
    /// Blocks of the own motion and of the next one, column-major.
    blocks: Vec<[Vec<f64>; 2]>,
}

const M: usize = 11;
const GROUPS: usize = 7;

fn number(k: usize) -> f64 {
    ((k * k % 1009) as f64 * 0.37 + k as f64).sin()
}

impl Structure {
    /// Forces of these ranks, and numbers that are no term of size `noise`.
    fn new(ranks: [usize; GROUPS], noise: f64) -> Self {
        let n = M * GROUPS;
        let block = |c: usize, motion: usize| -> Vec<f64> {
            let term = |i: usize, j: usize, a: usize| {
                let of_column = 50 * c + 20 * motion + j;
                number(1000 * a + 50 * c + i) * number(3000 + 1000 * a + of_column)
            };
            let entry = |k: usize| {
                let (i, j) = (k % M, k / M);
                let own: f64 = (0..ranks[c]).map(|a| term(i, j, a)).sum();
                own + noise * number(7 * k + c + motion) * f64::from(u8::from(ranks[c] > 0))
            };
            (0..M * M).map(entry).collect()
        };
        Self {
            n,
            unlikeness: 1.0,
            flexibility: (0..n * n).map(|k| 0.11 * number(k)).collect(),
            diagonal: (0..n).map(|k| 1.0 + 0.2 * number(k).abs()).collect(),
            blocks: (0..GROUPS).map(|c| [block(c, 0), block(c, 1)]).collect(),
        }
    }

    /// F d
    fn force(&self, d: &[f64]) -> Vec<f64> {
        let mut f = vec![0.0; self.n];
        for (c, blocks) in self.blocks.iter().enumerate() {
            for (by, block) in [c, (c + 1) % GROUPS].into_iter().zip(blocks) {
                for (k, a) in block.iter().enumerate() {
                    f[c * M + k % M] += a * d[by * M + k / M];
                }
            }
        }
        f
    }

    /// G w
    fn response(&self, w: &[f64]) -> Vec<f64> {
        let mut u = vec![0.0; self.n];
        for (k, g) in self.flexibility.iter().enumerate() {
            u[k % self.n] += g * w[k / self.n];
        }
        u
    }
}

impl Forces for Structure {
    fn groups(&self) -> usize {
        GROUPS
    }

    fn unlikeness(&mut self) -> Result<f64> {
        Ok(self.unlikeness)
    }

    fn rows(&mut self, force: usize, rows: &mut Vec<f64>, motions: &mut Vec<usize>) -> Result<f64> {
        *rows = self.blocks[force].concat();
        motions.extend([force, (force + 1) % GROUPS]);
        Ok(1.0)
    }

    fn response_of(&mut self, force: usize, w: &[f64], u: &mut [f64]) -> Result<()> {
        let mut all = vec![0.0; self.n];
        all[force * M..(force + 1) * M].copy_from_slice(w);
        u.copy_from_slice(&self.response(&all));
        self.divide(u);
        Ok(())
    }

    fn subtract_response(&mut self, w: &[f64], u: &mut [f64]) -> Result<()> {
        let mut response = self.response(w);
        self.divide(&mut response);
        u.iter_mut().zip(response).for_each(|(u, r)| *u -= r);
        Ok(())
    }

    fn divide(&mut self, u: &mut [f64]) {
        u.iter_mut().zip(&self.diagonal).for_each(|(u, d)| *u /= d);
    }
}

impl Jacobian for Structure {
    fn size(&self) -> usize {
        self.n
    }

    fn fill(&mut self, matrix: &mut [f64], active: &mut [bool]) -> Result<()> {
        for (k, column) in matrix.chunks_exact_mut(self.n).enumerate() {
            let mut d = vec![0.0; self.n];
            d[k] = 1.0;
            column.copy_from_slice(&self.response(&self.force(&d)));
            column[k] += self.diagonal[k];
        }
        active.fill(true);
        Ok(())
    }
}

#[test]
fn crosses_are_the_terms_of_the_forces_and_no_more() {
    let ranks = [3, 0, 1, 5, 2, 0, 4];
    for (noise, most) in [(0.0, 15), (1e-5, 15), (1e-5, 14)] {
        let mut structure = Structure::new(ranks, noise);
        let mut crosses = Crosses::default();
        let found = crosses.find(&mut structure, M, most).unwrap();
        assert_eq!(found, (most == 15).then_some(15), "{noise}");
        if found.is_none() {
            continue;
        }
        let d: Vec<f64> = (0..structure.n).map(|k| number(5 * k + 2)).collect();
        let (mut x, mut f) = (vec![1.0; 15], vec![1.0; structure.n]);
        crosses.reduce(M, &d, &mut x);
        crosses.expand(M, &x, &mut f);
        let exact = structure.force(&d);
        let gap = f.iter().zip(&exact).fold(0.0_f64, |m, (f, e)| m.max((f - e).abs()));
        let bound = if noise == 0.0 { 1e-12 } else { LEFT_BY_CROSSES };
        assert!(gap < bound && (noise == 0.0 || gap > 1e-7), "{gap}");
    }
}

#[test]
fn factors_of_the_terms_are_those_of_the_whole_matrix() {
    let none = Interrupt::none();
    // Both signs of the determinant: that of the row turns it.
    let mut signs = [false; 2];
    for ranks in [[3, 0, 1, 5, 2, 0, 4], [1, 2, 0, 0, 1, 0, 0], [0; GROUPS]] {
        let mut structure = Structure::new(ranks, 0.0);
        let n = structure.n;
        let column: Vec<f64> = (0..n).map(|k| (k as f64 * 0.9).cos()).collect();
        for sign in [1.0, -1.0] {
            let row: Vec<f64> = (0..=n).map(|k| sign * (k as f64 * 0.7 + 0.2).sin()).collect();
            let border = Border {
                column: &column,
                scales: (0.7, 3.0),
                row: &row,
            };
            let b: Vec<f64> = (0..=n).map(|k| (k as f64 * 2.1).sin() + 1.0).collect();
            let (mut x, mut y) = (b.clone(), b);
            let mut dense = DenseSystem::new(n).unwrap();
            dense.update(&mut structure, border, &none).unwrap();
            dense.factor(&mut structure, &none).unwrap();
            assert!(dense.solve(&mut structure, 1e-12, &mut y, &none).unwrap());
            let mut factors = RankFactors::new(n, M, GROUPS).unwrap();
            assert!(factors.factor(&mut structure, &none).unwrap());
            factors.set_border(&mut structure, border).unwrap();
            factors.solve(&mut structure, &mut x).unwrap();
            let size = y.iter().fold(0.0_f64, |m, y| m.max(y.abs()));
            let gap = x.iter().zip(&y).fold(0.0_f64, |m, (x, y)| m.max((x - y).abs())) / size;
            assert!(gap < 1e-9, "{gap}");
            assert_eq!(factors.is_positive(), dense.is_positive());
            signs[usize::from(dense.is_positive())] = true;
        }
    }
    assert_eq!(signs, [true; 2]);
}

#[test]
fn sectors_that_are_alike_and_numbers_that_are_none_are_left_to_waves() {
    let none = Interrupt::none();
    let mut structure = Structure::new([1; GROUPS], 0.0);
    let mut factors = RankFactors::new(structure.n, M, GROUPS).unwrap();
    structure.unlikeness = 0.1;
    assert!(!factors.factor(&mut structure, &none).unwrap());
    structure.unlikeness = 0.9;
    assert!(factors.factor(&mut structure, &none).unwrap());
    for broken in [f64::NAN, f64::INFINITY] {
        structure.blocks[3][1][5] = broken;
        assert!(!factors.factor(&mut structure, &none).unwrap());
    }
}
