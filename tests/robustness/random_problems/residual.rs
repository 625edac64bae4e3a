//! The residual of harmonic balance by sampling in time, nothing of it by the library.

use super::problem::Case;
use num_complex::Complex64;
use std::f64::consts::TAU;

/// Most samples of a period; all numbers of samples are powers of two.
pub const MOST: usize = 1 << 16;

/// Samples that are tried before.
const FIRST: usize = 1 << 10;

/// A residual relative to the forces, and what is known of it.
#[derive(Clone, Copy, Debug)]
pub struct Residual {
    /// ‖R‖/‖F‖ at the last number of samples.
    pub size: f64,
    /// Its change from half as many samples, likewise; 0 where that was not needed.
    pub change: f64,
    /// ‖contact forces‖/‖F‖.
    pub contacts: f64,
}

impl Residual {
    /// The residual at a solution: with few samples first, with more as long as it is above `bound`.
    pub fn of(case: &Case, x: &[Complex64], bound: f64) -> Self {
        let force = case.force();
        let mut samples = FIRST;
        loop {
            let (r, contacts) = sampled(case, x, samples);
            let size = norm(&r) / force;
            let mut found = Self {
                size,
                change: 0.0,
                contacts: contacts / force,
            };
            if size <= bound {
                return found;
            }
            if samples == MOST {
                let (half, _) = sampled(case, x, samples / 2);
                let difference: Vec<Complex64> = r.iter().zip(&half).map(|(a, b)| a - b).collect();
                found.change = norm(&difference) / force;
                return found;
            }
            samples *= 4;
        }
    }
}

fn norm(x: &[Complex64]) -> f64 {
    x.iter().map(Complex64::norm_sqr).sum::<f64>().sqrt()
}

/// R_h = (K + ihω C − h²ω² M) x_h + f_h − F_h with f from so many samples; the norm of all f_h.
fn sampled(case: &Case, x: &[Complex64], samples: usize) -> (Vec<Complex64>, f64) {
    let n = case.n;
    let count = x.len() / n;
    let mut r = vec![Complex64::ZERO; x.len()];
    for h in 0..count {
        let hw = h as f64 * case.omega;
        for i in 0..n {
            for j in 0..n {
                let at = i * n + j;
                let z = Complex64::new(case.stiffness[at] - hw * hw * case.mass[at], hw * case.damping[at]);
                r[h * n + i] += z * x[h * n + j];
            }
        }
    }
    for &(dof, h, value) in &case.forces {
        r[h * n + dof] -= if h == 0 { value.re.into() } else { value };
    }
    let turn: Vec<Complex64> = (0..samples)
        .map(|j| Complex64::cis(TAU * j as f64 / samples as f64))
        .collect();
    let mut contacts = 0.0;
    for assembled in &case.contacts {
        let d = assembled.law.directions();
        let (mut u, mut v, mut f) = (vec![0.0; d * samples], vec![0.0; d * samples], vec![0.0; d * samples]);
        for (k, [a, b]) in assembled.sides.iter().enumerate() {
            let y = relative(x, n, [*a, *b]);
            for j in 0..samples {
                u[j * d + k] = y[0].re;
                for (h, y) in y.iter().enumerate().skip(1) {
                    let term = y * turn[(h * j) & (samples - 1)];
                    u[j * d + k] += term.re;
                    v[j * d + k] -= h as f64 * case.omega * term.im;
                }
            }
        }
        assembled.law.march(&u, &v, &mut f);
        for (k, [a, b]) in assembled.sides.iter().enumerate() {
            for h in 0..count {
                let mut sum = Complex64::ZERO;
                for j in 0..samples {
                    sum += f[j * d + k] * turn[(h * j) & (samples - 1)].conj();
                }
                sum *= if h == 0 { 1.0 } else { 2.0 } / samples as f64;
                contacts += sum.norm_sqr();
                for (side, sign) in [(a, 1.0), (b, -1.0)] {
                    if let Some(dof) = side {
                        r[h * n + dof] += sign * sum;
                    }
                }
            }
        }
    }
    (r, contacts.sqrt())
}

/// Harmonics of a relative motion.
fn relative(x: &[Complex64], n: usize, [a, b]: [Option<usize>; 2]) -> Vec<Complex64> {
    let part = |side: Option<usize>, x: &[Complex64]| side.map_or(Complex64::ZERO, |dof| x[dof]);
    x.chunks_exact(n).map(|x| part(a, x) - part(b, x)).collect()
}
