//! Events that are followed from those of a neighbouring motion against events that are isolated anew: forces and
//! Jacobians along random paths.

use crate::common::friction::Random;
use hbvib::aft::{Evaluation, Evaluator};
use hbvib::contact::Law;
use hbvib::contact::laws::jenkins::Jenkins;
use hbvib::contact::laws::unilateral::Unilateral;
use hbvib::fourier::HarmonicSet;
use hbvib::interrupt::Interrupt;

/// Largest difference of two lists, relative to the larger of a number and the largest entry.
fn gap(a: &[f64], b: &[f64], least: f64) -> f64 {
    let size = b.iter().fold(least, |s, x| s.max(x.abs()));
    a.iter().zip(b).fold(0.0, |s: f64, (x, y)| s.max((x - y).abs())) / size
}

#[test]
fn forces_of_followed_events_are_those_of_isolated_ones() {
    let none = Interrupt::none();
    let mut random = Random(11);
    let laws: [(&dyn Law, bool); 3] = [
        (
            &Jenkins {
                stiffness: 1.0,
                limit: 0.2,
            },
            true,
        ),
        (
            &Jenkins {
                stiffness: 50.0,
                limit: 0.2,
            },
            true,
        ),
        (
            &Unilateral {
                stiffness: 3.0,
                gap: 0.1,
            },
            false,
        ),
    ];
    let (mut worst_force, mut worst_jacobian, mut slips) = (0.0_f64, 0.0_f64, [0; 2]);
    for (law, odd_law) in laws {
        for (highest, odd) in [
            (1, true),
            (3, true),
            (9, true),
            (31, true),
            (2, false),
            (9, false),
            (31, false),
        ] {
            if odd && !odd_law {
                continue;
            }
            let set = HarmonicSet::excited(&[1], highest, true, odd, false).unwrap();
            let mut followed = Evaluator::new(&set, 0, std::iter::once(law)).unwrap();
            followed.reserve_followed(&set, 2).unwrap();
            let mut isolated = Evaluator::new(&set, 0, std::iter::once(law)).unwrap();
            let (mut a, mut b) = (Evaluation::new(&set, 1).unwrap(), Evaluation::new(&set, 1).unwrap());
            // Two coordinates, whose motions take turns.
            let paths: Vec<[Vec<f64>; 2]> = (0..2)
                .map(|_| [random.signal(&set, 0.5), random.signal(&set, 0.5)])
                .collect();
            let mut share = 0.0;
            for step in [1e-9, 1e-6, 1e-4, 1e-3, 1e-2, 3e-2, 0.1, 0.3] {
                for _ in 0..8 {
                    share += step;
                    for (k, [from, to]) in paths.iter().enumerate() {
                        let motion: Vec<f64> = from.iter().zip(to).map(|(x, y)| x + share * (y - x)).collect();
                        followed.prepare_followed(&set, &motion, k, &none).unwrap();
                        followed.evaluate(law, &set, &motion, 1.0, &mut a, &none).unwrap();
                        isolated.prepare(&set, &motion, &none).unwrap();
                        isolated.evaluate(law, &set, &motion, 1.0, &mut b, &none).unwrap();
                        worst_force = worst_force.max(gap(&a.force, &b.force, 0.2));
                        worst_jacobian = worst_jacobian.max(gap(&a.jacobian, &b.jacobian, 1.0));
                        assert_eq!(a.stuck, b.stuck);
                        slips[usize::from(a.slip_fraction > 0.0)] += 1;
                    }
                }
            }
        }
    }
    assert!(slips[0] > 100 && slips[1] > 100, "{slips:?}");
    assert!(worst_force < 1e-13, "{worst_force:e}");
    // A turning point moves by rounding over x″.
    assert!(worst_jacobian < 1e-11, "{worst_jacobian:e}");
}
