//! Products with the Jacobian of a nonlinear mode.

use crate::problem::epmc::Epmc;
use crate::problem::parametric_problem::put;

impl Epmc<'_> {
    /// out = J d at the point evaluated last.
    pub(super) fn multiply(&mut self, d: &[f64], out: &mut [f64]) {
        let n = d.len();
        let set = self.condensed.set();
        let (m, harmonics, coordinates) = (set.packed_len(), set.numbers().len(), self.condensed.coordinates());
        let (motion, frequency, damping) = (&d[..n - 2], d[n - 2], d[n - 1]);
        for (out, (by_omega, by_damping)) in out.iter_mut().zip(self.by_omega.iter().zip(&self.by_damping)) {
            *out = by_omega * frequency + by_damping * damping;
        }
        for (out, d) in out.iter_mut().zip(motion) {
            *out += d;
        }
        let (fundamental, has_mean) = (set.fundamental(), set.has_mean());
        for c in 0..coordinates {
            let change = &mut self.change[..];
            self.forces.change(motion, c, change);
            for row in 0..coordinates {
                let g = &self.flexibility[(c * coordinates + row) * harmonics..][..harmonics];
                for (i, g) in g.iter().enumerate() {
                    let at = row * m + set.offset(i);
                    put(out, at, has_mean && i == 0, g * set.get(change, i));
                }
            }
            if has_mean {
                out[c * m] += self.forces.mean_floor(c) * motion[c * m];
            }
            let z = set.get(change, fundamental);
            for (out, g) in out[n - 2..].iter_mut().zip(self.gauge_rows[c]) {
                *out += (g * z).re;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::condense::Condensed;
    use crate::condense::test_chains::{N, chain, structure};
    use crate::contact::Contact;
    use crate::interrupt::Interrupt;
    use crate::linalg::linear_system::Jacobian;
    use crate::options::{DampingForm, SolverOptions};
    use crate::problem::epmc::{Epmc, Gauge, LinearMode};
    use crate::problem::static_state::StaticState;
    use crate::problem::{Problem, Residual};
    use num_complex::Complex64;

    #[test]
    fn products_are_those_with_the_matrix() {
        let interrupt = Interrupt::none();
        let options = SolverOptions {
            harmonics: 5,
            ..SolverOptions::default()
        };
        let shape: Vec<Complex64> = (0..N).map(|i| Complex64::new(1.0 + i as f64, 0.3)).collect();
        for (several, stop) in [(false, false), (true, false), (true, true)] {
            let mut model = if several {
                chain(1, (0.0, 2e-3))
            } else {
                structure(1, (0.0, 2e-3))
            };
            if !several {
                model.add_contact(&Contact::jenkins(1, Some(4), 9.0, 0.3, 1.0)).unwrap();
            }
            if stop {
                // The mean is carried.
                model
                    .add_contact(&Contact::unilateral(Some(5), None, 4.0, 0.1))
                    .unwrap();
            }
            let form = (DampingForm::Mass, false);
            let (condensed, _) = Condensed::for_mode(&model, &options, form, &shape, &interrupt).unwrap();
            let gauge = Gauge {
                contact: None,
                reference_dof: 0,
            };
            let linear = LinearMode {
                omega: 0.7,
                damping: 1e-3,
                shape: shape.clone(),
                rest: StaticState::default(),
            };
            let mut problem = Epmc::new(&condensed, &gauge, &linear, 0, &interrupt).unwrap();
            let n = problem.size();
            let (mut matrix, mut active) = (vec![0.0; n * n], vec![true; n]);
            let (mut out, mut at) = (vec![0.0; n], Residual::new(n).unwrap());
            for k in 0..40 {
                // From motions that stick to such that slip.
                let size = 1e-2 * 1.3_f64.powi(k);
                let wave = |i: usize, shift: f64| ((i * 7 + k as usize) as f64 * 0.7 + shift).sin();
                let mut u: Vec<f64> = (0..n).map(|i| size * wave(i, 0.0)).collect();
                Epmc::set_frequency_and_damping(&linear, (0.6 + 0.01 * f64::from(k), 2e-3), &mut u);
                problem.evaluate(&u, 0.0, &mut at).unwrap();
                problem.fill(&mut matrix, &mut active).unwrap();
                let d: Vec<f64> = (0..n).map(|i| wave(i * i, 0.4)).collect();
                assert!(problem.multiply_here(&d, &mut out).unwrap());
                for (row, found) in out.iter().enumerate() {
                    let terms = (0..n).map(|j| matrix[j * n + row] * d[j]);
                    let size: f64 = terms.clone().map(f64::abs).sum();
                    let expected: f64 = terms.sum();
                    assert!(
                        (found - expected).abs() <= 1e-11 * size,
                        "{k}, {row}: {found} {expected}"
                    );
                }
            }
        }
    }
}
