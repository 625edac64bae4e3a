//! Harmonics of the response degree of freedom near the point evaluated last: Newton's last step, to the solution that is
//! recorded, is not followed by an evaluation.
//!
//! With the change (δ, δω) from the point evaluated last,
//!
//! > x = x_lin − Σ_c g_c (f_c − κ_c y_c),  f(y, ω) ≈ f + J δ + ∂f/∂ω δω,  g(ω) ≈ g + ∂g δω
//!
//! errs by the square of the change.

use crate::problem::harmonic_balance::HarmonicBalance;
use num_complex::Complex64;

impl HarmonicBalance<'_> {
    /// Harmonics of the response degree of freedom, in the order in which they are carried.
    pub fn response(&mut self, u: &[f64], omega: f64, x: &mut [Complex64]) {
        let (condensed, forces, tables) = (self.condensed, &self.forces, &self.tables);
        let set = condensed.set();
        let coordinates = condensed.coordinates();
        let outputs = coordinates + 1;
        let along = omega - tables.frequency().unwrap_or(omega);
        for ((change, u), here) in self.products.change.iter_mut().zip(u).zip(forces.motion()) {
            *change = u - here;
        }
        // At one frequency tables may have no slopes.
        let moved = |value: Complex64, slope: Complex64| if along == 0.0 { value } else { value + slope * along };
        for (x, table) in x.iter_mut().zip(tables.current()) {
            let excited = coordinates * outputs + coordinates;
            *x = moved(table.value[excited], table.slope[excited]);
        }
        let m = set.packed_len();
        for c in (0..coordinates).filter(|&c| !forces.is_inactive(c)) {
            forces.behind((&self.products.change, along), c, &mut self.memory.change);
            let at = c * outputs + coordinates;
            for (i, (x, table)) in x.iter_mut().zip(tables.current()).enumerate() {
                let w = set.get(&self.memory.change, i) - condensed.kappa(c, i) * set.get_at(u, c * m, i);
                *x -= moved(table.value[at], table.slope[at]) * w;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::condense::Condensed;
    use crate::condense::test_chains::chain;
    use crate::interrupt::Interrupt;
    use crate::options::SolverOptions;
    use crate::problem::{Problem, Residual};

    #[test]
    fn the_response_beside_an_evaluation_errs_by_the_square_of_the_distance() {
        let interrupt = Interrupt::none();
        let (model, range) = (chain(1, (0.0, 2e-3)), (0.1, 0.6));
        let options = SolverOptions {
            harmonics: 5,
            ..SolverOptions::default()
        };
        let condensed = Condensed::new(&model, &options, range, &interrupt).unwrap();
        let mut problem = HarmonicBalance::new(&condensed, 8, range.into(), 0, None, &interrupt).unwrap();
        let n = problem.unknowns();
        let mut at = Residual::new(n).unwrap();
        let mut compared = 0;
        for k in 0..40_usize {
            let omega = 0.1 + 0.012 * k as f64;
            let number = |i: usize, salt: usize| ((i * 13 + k * 7 + salt) as f64 * 0.37).sin();
            let u: Vec<f64> = (0..n).map(|i| 0.2 * (1 + k % 8) as f64 * number(i, 0)).collect();
            let mut response_from = |distance: f64| {
                let near: Vec<f64> = (0..n).map(|i| u[i] + distance * number(i, 5)).collect();
                problem.evaluate(&near, omega * (1.0 + distance), &mut at).unwrap();
                let mut x = vec![Complex64::ZERO; condensed.blocks().len()];
                problem.response(&u, omega, &mut x);
                x
            };
            let exact = response_from(0.0);
            let error = |x: &[Complex64]| {
                x.iter()
                    .zip(&exact)
                    .map(|(a, b)| (a - b).norm_sqr())
                    .sum::<f64>()
                    .sqrt()
            };
            let [far, near] = [1e-3, 1e-5].map(|distance| error(&response_from(distance)));
            assert!(far > 0.0);
            // A contact that begins to slip leaves the power 3/2.
            assert!(near < 2e-3 * far, "{k}: {near}, {far}");
            compared += usize::from(near < 2e-4 * far);
        }
        assert!(compared > 30, "{compared}");
    }
}
