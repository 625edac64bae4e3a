//! The residual of a single relative motion, of which most models of one contact consist: with one coordinate most of the time
//! would be spent around loops of length one.

use crate::condense::by_factors::flexibility::Table;
use crate::fourier::HarmonicSet;
use crate::problem::parametric_problem::Residual;
use crate::problem::residual_scale::Squares;
use num_complex::Complex64;

/// Force of the contact at one motion.
pub(super) struct SingleForce<'a> {
    /// Packed contact force and its derivative by ω.
    pub force: &'a [f64],
    pub by_omega: &'a [f64],
    /// Whether the force is κ y, so that nothing couples back.
    pub is_inactive: bool,
    /// Rounding error of the contact force.
    pub rounding: f64,
}

/// Residual R = y − y_lin + G w and slope ∂R/∂ω = −∂y_lin + ∂G w + G ∂f/∂ω with w = f − κ y, and their scales;
/// `kappa` returns κ of each carried harmonic.
pub(super) fn balance(
    (set, tables): (&HarmonicSet, &[Table]),
    u: &[f64],
    by: &SingleForce<'_>,
    kappa: impl Fn(usize) -> Complex64,
    out: &mut Residual,
) {
    let mean = usize::from(set.has_mean());
    let mut linear = Squares::default();
    let mut rounding = 0.0;
    let lost = by.rounding * by.rounding;
    if let (Some(table), 1) = (tables.first(), mean) {
        let ([g, .., y_lin, _], [d_g, .., d_y_lin, _]) = (&table.value[..], &table.slope[..]) else {
            return;
        };
        linear.mean = y_lin.norm_sqr();
        let (mut value, mut along) = (u[0] - y_lin.re, -d_y_lin.re);
        if !by.is_inactive {
            let w = Complex64::new(by.force[0], 0.0) - kappa(0) * u[0];
            value += (g * w).re;
            along += (d_g * w + g * by.by_omega[0]).re;
            rounding += lost * g.norm_sqr();
        }
        (out.values[0], out.d_parameter[0]) = (value, along);
    }
    let [y, force, by_omega] = [u, by.force, by.by_omega].map(|packed| packed[mean..].as_chunks::<2>().0.iter());
    let [values, slopes] =
        [&mut out.values, &mut out.d_parameter].map(|packed| packed[mean..].as_chunks_mut::<2>().0.iter_mut());
    let numbers = y.zip(force).zip(by_omega).zip(values.zip(slopes));
    for ((((y, f), f_omega), (value, along)), (i, table)) in numbers.zip(tables.iter().enumerate().skip(mean)) {
        let ([g, _, y_lin, _], [d_g, _, d_y_lin, _]) = (&table.value[..], &table.slope[..]) else {
            return;
        };
        linear.vibration += y_lin.norm_sqr();
        let y = Complex64::new(y[0], y[1]);
        let (mut r, mut d) = (y - y_lin, -d_y_lin);
        if !by.is_inactive {
            let w = Complex64::new(f[0], f[1]) - kappa(i) * y;
            r += g * w;
            d += d_g * w + g * Complex64::new(f_omega[0], f_omega[1]);
            rounding += lost * g.norm_sqr();
        }
        (*value, *along) = ([r.re, r.im], [d.re, d.im]);
    }
    out.scale = Squares::of(set, u).size(linear);
    out.rounding = f64::sqrt(rounding);
}

#[cfg(test)]
mod tests {
    use crate::condense::Condensed;
    use crate::condense::test_chains::structure;
    use crate::contact::Contact;
    use crate::interrupt::Interrupt;
    use crate::linalg::newton::linear_system::Jacobian;
    use crate::options::SolverOptions;
    use crate::problem::harmonic_balance::HarmonicBalance;
    use crate::problem::parametric_problem::{Problem, Residual};

    #[test]
    fn the_residual_of_one_motion_is_that_of_any_number() {
        let interrupt = Interrupt::none();
        for (preload, gap) in [(false, false), (true, false), (false, true)] {
            let mut model = structure(1, (0.0, 1e-3));
            let contact = if gap {
                Contact::unilateral(Some(1), Some(4), 9.0, 0.2)
            } else {
                Contact::jenkins(1, Some(4), 9.0, 0.3, 1.0)
            };
            model.add_contact(&contact).unwrap();
            if preload {
                model.add_force(3, 0, 0.1.into()).unwrap();
            }
            let options = SolverOptions {
                harmonics: 5,
                ..SolverOptions::default()
            };
            let condensed = Condensed::new(&model, &options, (0.3, 2.0), &interrupt).unwrap();
            let mut problem = HarmonicBalance::new(&condensed, 8, (0.3, 2.0).into(), 0, None, &interrupt).unwrap();
            let n = problem.size();
            let make = || Residual::new(n).unwrap();
            let (mut quick, mut slow) = (make(), make());
            for k in 0..60 {
                // From motions that stick to such that slip or lift off.
                let size = 1e-3 * 1.3_f64.powi(k);
                let u: Vec<f64> = (0..n)
                    .map(|i| size * ((i * 7 + k as usize) as f64 * 0.7).sin())
                    .collect();
                problem.evaluate(&u, 0.4 + 0.02 * f64::from(k), &mut quick).unwrap();
                problem.balance(&u, None, &mut slow).unwrap();
                assert_eq!(quick.scale.to_bits(), slow.scale.to_bits());
                assert!((quick.rounding - slow.rounding).abs() <= 1e-15 * slow.rounding);
                for (a, b) in [(&quick.values, &slow.values), (&quick.d_parameter, &slow.d_parameter)] {
                    let largest = b.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
                    assert!(largest > 0.0);
                    for (a, b) in a.iter().zip(b) {
                        assert!((a - b).abs() <= 1e-14 * largest, "{a} {b}");
                    }
                }
            }
        }
    }
}
