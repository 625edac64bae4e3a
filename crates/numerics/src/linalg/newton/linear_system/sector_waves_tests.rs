//! Wheels of unequal sectors against the factors of the whole matrix.

use crate::error::Result;
use crate::interrupt::Interrupt;
use crate::linalg::newton::linear_system::automatic::AutomaticSystem;
use crate::linalg::newton::linear_system::dense::DenseSystem;
use crate::linalg::newton::linear_system::{Border, Jacobian, LinearSystem, MatrixFree, Ring};
use core::f64::consts::TAU;
use num_complex::Complex64;

/// Sectors of two groups of a mean and two pairs; blocks of equal sectors in their own time, and what each sector has besides.
struct Wheel {
    sectors: usize,
    lags: Vec<Complex64>,
    matrix: Vec<f64>,
    blocks: Vec<Vec<f64>>,
}

const GROUP: usize = 5;
const ORDER: usize = 2 * GROUP;

impl Wheel {
    fn new(sectors: usize, unequal: f64) -> Self {
        let lags = [3.0, 9.0].map(|h| Complex64::cis(-TAU * h / sectors as f64)).to_vec();
        let blocks: Vec<Vec<f64>> = (0..sectors)
            .map(|d| {
                let size = 0.3 / (1.0 + d.min(sectors - d) as f64).powi(2);
                let noise = |k: usize| size * (0.37 * k as f64 + d as f64).sin();
                let unit = |k: usize| f64::from(u8::from(d == 0 && k % (ORDER + 1) == 0));
                (0..ORDER * ORDER).map(|k| unit(k) + noise(k)).collect()
            })
            .collect();
        let n = sectors * ORDER;
        let mut matrix = vec![0.0; n * n];
        let turned = |s: usize, q: usize, back: bool| -> Vec<f64> {
            let mut x = vec![0.0; ORDER];
            x[q] = 1.0;
            turn_all(&lags, s, back, &mut x);
            x
        };
        for s in 0..sectors {
            for q in 0..ORDER {
                let x = turned(s, q, true);
                for d in 0..sectors {
                    let mut y = vec![0.0; ORDER];
                    for (column, x) in blocks[d].chunks_exact(ORDER).zip(&x) {
                        for (y, a) in y.iter_mut().zip(column) {
                            *y += a * x;
                        }
                    }
                    let to = (s + d) % sectors;
                    turn_all(&lags, to, false, &mut y);
                    for (r, y) in y.iter().enumerate() {
                        let own = unequal * (1.3 * (s * ORDER + r + 7 * q) as f64).sin() * f64::from(u8::from(d == 0));
                        matrix[(s * ORDER + q) * n + to * ORDER + r] = y + own;
                    }
                }
            }
        }
        Self {
            sectors,
            lags,
            matrix,
            blocks,
        }
    }
}

fn turn_all(lags: &[Complex64], s: usize, back: bool, x: &mut [f64]) {
    for group in x.chunks_exact_mut(GROUP) {
        for (pair, lag) in group[1..].chunks_exact_mut(2).zip(lags) {
            let turn = lag.powi(s as i32);
            let z = if back { turn.conj() } else { turn } * Complex64::new(pair[0], pair[1]);
            (pair[0], pair[1]) = (z.re, z.im);
        }
    }
}

impl Jacobian for Wheel {
    fn size(&self) -> usize {
        self.sectors * ORDER
    }

    fn fill(&mut self, matrix: &mut [f64], active: &mut [bool]) -> Result<()> {
        matrix.copy_from_slice(&self.matrix);
        active.fill(true);
        Ok(())
    }

    fn matrix_free(&mut self) -> Option<&mut dyn MatrixFree> {
        Some(self)
    }
}

impl MatrixFree for Wheel {
    fn group(&self) -> usize {
        GROUP
    }

    fn coupled(&self) -> usize {
        self.size()
    }

    fn fill_block(&mut self, _part: usize, _matrix: &mut [f64], _active: &mut [bool]) -> Result<()> {
        unreachable!("a ring has no block")
    }

    fn fill_pair(&mut self, _at: usize, _matrix: &mut [Complex64]) {
        unreachable!("a ring has no pairs")
    }

    fn ring(&self) -> Option<Ring<'_>> {
        Some(Ring {
            sectors: self.sectors,
            lags: &self.lags,
        })
    }

    fn fill_ring(&mut self, wave: usize, matrix: &mut [Complex64]) -> Result<()> {
        matrix.fill(Complex64::ZERO);
        for (d, block) in self.blocks.iter().enumerate() {
            let root = Complex64::cis(-TAU * (wave * d) as f64 / self.sectors as f64);
            for (to, a) in matrix.iter_mut().zip(block) {
                *to += root * a;
            }
        }
        Ok(())
    }

    fn keep(&mut self) -> Result<()> {
        Ok(())
    }

    fn multiply(&mut self, d: &[f64], out: &mut [f64]) -> Result<()> {
        out.fill(0.0);
        for (column, d) in self.matrix.chunks_exact(d.len()).zip(d) {
            for (out, a) in out.iter_mut().zip(column) {
                *out += a * d;
            }
        }
        Ok(())
    }
}

#[test]
fn a_wheel_of_unequal_sectors_is_solved_as_the_whole_matrix() {
    let none = Interrupt::none();
    // Even and odd numbers of sectors, equal ones and others.
    for (sectors, unequal) in [(26, 0.0), (27, 0.0), (26, 0.05), (27, 0.05)] {
        let mut wheel = Wheel::new(sectors, unequal);
        let n = wheel.size();
        let column: Vec<f64> = (0..n).map(|k| (k as f64 * 0.9).cos()).collect();
        for sign in [1.0, -1.0] {
            let row: Vec<f64> = (0..=n).map(|k| sign * (k as f64 * 0.7 + 0.2).sin()).collect();
            let b: Vec<f64> = (0..=n).map(|k| (k as f64 * 2.1).sin() + 1.0).collect();
            let border = Border {
                column: &column,
                scales: (0.7, 3.0),
                row: &row,
            };
            let (mut ring, mut dense) = (AutomaticSystem::new(n).unwrap(), DenseSystem::new(n).unwrap());
            let (mut x, mut y) = (b.clone(), b.clone());
            for (system, x) in [(&mut ring as &mut dyn LinearSystem, &mut x), (&mut dense, &mut y)] {
                system.update(&mut wheel, border, &none).unwrap();
                system.factor(&mut wheel, &none).unwrap();
                assert!(system.solve(&mut wheel, 1e-10, x, &none).unwrap());
            }
            assert!(!ring.is_direct());
            let products = ring.products();
            let size = y.iter().fold(0.0_f64, |m, y| m.max(y.abs()));
            let gap = x.iter().zip(&y).fold(0.0_f64, |m, (x, y)| m.max((x - y).abs())) / size;
            println!("{sectors} sectors, {unequal}: {products} products, gap {gap:.1e}");
            assert!(gap < 1e-8, "{gap}");
            assert!(products <= if unequal == 0.0 { 2 } else { 40 }, "{products}");
            assert_eq!(ring.is_positive(), dense.is_positive());
        }
    }
}
