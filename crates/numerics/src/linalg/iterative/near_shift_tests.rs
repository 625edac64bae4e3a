//! Tests of the search next to a shift.

use super::*;
use std::f64::consts::PI;

/// Chains of unit masses and springs between walls with damping αM, each frequency as often as there are chains.
struct Chains {
    matrices: [Csc; 3],
    values: Vec<Complex64>,
}

fn chains(length: usize, copies: usize, alpha: f64) -> Chains {
    let n = length * copies;
    let (mut k, mut values) = (Vec::new(), Vec::new());
    for i in 0..n {
        k.push((i, i, Complex64::from(2.0)));
        if (i + 1) % length != 0 {
            k.extend([(i, i + 1, -Complex64::ONE), (i + 1, i, -Complex64::ONE)]);
        }
        let omega = 2.0 * (0.5 * PI * (i % length + 1) as f64 / (length + 1) as f64).sin();
        let root = Complex64::from(0.25 * alpha * alpha - omega * omega).sqrt();
        values.extend([root, -root].map(|root| root - 0.5 * alpha));
    }
    let diagonal = |c: f64| Csc::from_triplets(n, n, (0..n).map(|i| (i, i, c.into())).collect()).unwrap();
    Chains {
        matrices: [diagonal(1.0), diagonal(alpha), Csc::from_triplets(n, n, k).unwrap()],
        values,
    }
}

impl Chains {
    /// Searches and compares with all that are within the radius of the answer, each as often as it occurs.
    fn check(&self, shift: Complex64, goal: Goal) -> Near {
        let none = Interrupt::none();
        let [mass, damping, stiffness] = &self.matrices;
        let mut search = NearShift::new([mass, damping, stiffness], shift, &none).unwrap();
        let near = search.search(goal).unwrap();
        let within = |value: &&Complex64| (**value - shift).norm() < near.radius;
        let mut exact: Vec<Complex64> = self.values.iter().filter(within).copied().collect();
        let found = near.pairs.iter().map(|pair| &pair.0).filter(within);
        for value in found.clone() {
            let at = exact.iter().position(|exact| (exact - value).norm() < 1e-9);
            exact.swap_remove(at.unwrap_or_else(|| panic!("{value} is none, or occurs less often")));
        }
        assert!(exact.is_empty(), "missing: {exact:?}");
        near
    }
}

#[test]
fn the_nearest_are_found_each_as_often_as_it_occurs() {
    for (length, copies) in [(120, 1), (30, 3), (8, 6)] {
        let chains = chains(length, copies, 0.02);
        for count in [1, 16] {
            let near = chains.check(Complex64::new(0.01, 0.2), Goal::Nearest(count));
            assert!(near.pairs.len() >= count);
        }
    }
}

#[test]
fn a_disc_holds_all_or_tells_that_they_are_too_many() {
    let chains = chains(50, 2, 0.5);
    // Real eigenvalues of overdamped modes beside vibrations.
    let near = chains.check(Complex64::new(-0.3, 0.2), Goal::Within(0.4, 80));
    assert!(near.radius >= 0.4 * (1.0 - 1e-8) && !near.pairs.is_empty());
    let empty = chains.check(Complex64::new(-3.0, 0.5), Goal::Within(1.0, 40));
    assert!(empty.radius >= 1.0 - 1e-8);
    let many = chains.check(Complex64::new(-0.2, 1.0), Goal::Within(1.2, 10));
    assert_eq!(many.radius, 0.0);
}

#[test]
fn a_search_for_more_goes_on_from_those_found() {
    let chains = chains(30, 1, 0.1);
    let none = Interrupt::none();
    let [mass, damping, stiffness] = &chains.matrices;
    let mut search = NearShift::new([mass, damping, stiffness], Complex64::new(0.02, 0.3), &none).unwrap();
    let few = search.search(Goal::Nearest(5)).unwrap();
    let more = search.search(Goal::Nearest(20)).unwrap();
    assert!(more.radius > few.radius && more.pairs.len() >= 20);
    let all = search.search(Goal::Nearest(60)).unwrap();
    assert_eq!((all.pairs.len(), all.radius), (60, f64::INFINITY));
}
