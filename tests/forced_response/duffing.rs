//! Duffing's oscillator, a mass on a cubic spring, forced: with one harmonic against the closed form
//! of its describing function, with many against the motion marched in time.

use crate::common::models::{oscillator, unit_chain};
use crate::common::{self, harmonics, relative_gap, solve_at, sweep};
use hbvib::internals::HarmonicBalance;
use hbvib::internals::{Condensed, Reference};
use hbvib::internals::{InitialGuess, Problem};
use hbvib::{Contact, ContactState, Interrupt, Model, forced_residual};
use num_complex::Complex64;
use std::f64::consts::TAU;

/// ẍ + c ẋ + (k + kt) x + k3 x³ = F cos ωt
#[derive(Clone, Copy, Debug)]
struct Duffing {
    c: f64,
    k: f64,
    kt: f64,
    k3: f64,
    force: f64,
}

const HARDENING: Duffing = Duffing {
    c: 0.1,
    k: 0.6,
    kt: 0.4,
    k3: 0.5,
    force: 0.25,
};

const SOFTENING: Duffing = Duffing {
    c: 0.05,
    k: 0.6,
    kt: 0.4,
    k3: -0.2,
    force: 0.06,
};

/// The contact has no stiffness at small motion.
const PURE: Duffing = Duffing {
    k: 1.0,
    kt: 0.0,
    ..HARDENING
};

/// Nothing but the cubic spring holds the mass.
const FLOATING: Duffing = Duffing {
    k: 0.0,
    kt: 0.0,
    ..HARDENING
};

impl Duffing {
    fn model(&self) -> Model {
        oscillator(1.0, self.k)
            .damping(&[self.c])
            .contact(Contact::cubic(0, None, self.kt, self.k3))
            .force(0, 1, self.force)
            .build()
    }

    /// Detuning k + kt − ω² + ¾ k3 s of one harmonic, s = |X|².
    fn detuning(&self, omega: f64, s: f64) -> f64 {
        self.k + self.kt - omega * omega + 0.75 * self.k3 * s
    }

    /// |(detuning + icω) X|² − F²
    fn surplus(&self, omega: f64, s: f64) -> f64 {
        s * (self.detuning(omega, s).powi(2) + (self.c * omega).powi(2)) - self.force.powi(2)
    }

    /// All amplitudes of one harmonic, ascending: roots of a cubic equation for s, bracketed and
    /// halved.
    fn amplitudes(&self, omega: f64) -> Vec<f64> {
        let n = 100_000;
        let largest = (self.force / (self.c * omega)).powi(2) * 1.01;
        let s = |j: usize| largest * j as f64 / n as f64;
        let mut found = Vec::new();
        for j in 0..n {
            let (mut a, mut b) = (s(j), s(j + 1));
            if (self.surplus(omega, a) < 0.0) == (self.surplus(omega, b) < 0.0) {
                continue;
            }
            for _ in 0..200 {
                let middle = 0.5 * (a + b);
                if (self.surplus(omega, a) < 0.0) == (self.surplus(omega, middle) < 0.0) {
                    a = middle;
                } else {
                    b = middle;
                }
            }
            found.push(a.sqrt());
        }
        found
    }

    fn acceleration(&self, force: f64, x: f64, v: f64) -> f64 {
        force - self.c * v - (self.k + self.kt) * x - self.k3 * x * x * x
    }

    /// Harmonics 0 ..= `highest` of the motion after `periods`, marched from near a motion by the
    /// classical Runge–Kutta method.
    fn marched(&self, omega: f64, near: &[Complex64], periods: usize) -> Vec<Complex64> {
        // The error is of fourth order in the step.
        let steps = (TAU / omega / 1.5e-3) as usize;
        let h = TAU / omega / steps as f64;
        let force = |half_steps: usize| self.force * (TAU * half_steps as f64 / (2 * steps) as f64).cos();
        // The start is off by some percent, so that it is this marching that finds the motion.
        let mut x: f64 = 1.03 * near.iter().map(|z| z.re).sum::<f64>();
        let mut v: f64 = near.iter().enumerate().map(|(p, z)| -(p as f64) * omega * z.im).sum();
        let mut sums = vec![Complex64::ZERO; near.len()];
        for period in 0..=periods {
            for j in 0..steps {
                if period == periods {
                    let tau = TAU * j as f64 / steps as f64;
                    for (p, sum) in sums.iter_mut().enumerate() {
                        let weight = if p == 0 { 1.0 } else { 2.0 };
                        *sum += weight / steps as f64 * x * Complex64::cis(-(p as f64) * tau);
                    }
                }
                let (f0, f1, f2) = (force(2 * j), force(2 * j + 1), force(2 * j + 2));
                let (v1, a1) = (v, self.acceleration(f0, x, v));
                let (v2, a2) = (
                    v + 0.5 * h * a1,
                    self.acceleration(f1, x + 0.5 * h * v1, v + 0.5 * h * a1),
                );
                let (v3, a3) = (
                    v + 0.5 * h * a2,
                    self.acceleration(f1, x + 0.5 * h * v2, v + 0.5 * h * a2),
                );
                let (v4, a4) = (v + h * a3, self.acceleration(f2, x + h * v3, v + h * a3));
                x += h / 6.0 * (v1 + 2.0 * v2 + 2.0 * v3 + v4);
                v += h / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
            }
        }
        sums
    }
}

/// Below, between and above the folds.
const CASES: [(Duffing, [f64; 3]); 4] = [
    (HARDENING, [0.6, 1.3, 2.2]),
    (SOFTENING, [0.6, 0.875, 1.4]),
    (PURE, [0.6, 1.3, 2.2]),
    (FLOATING, [0.2, 0.9, 2.0]),
];

#[test]
fn one_harmonic_solves_the_cubic_equation_of_the_describing_function() {
    for (duffing, wanted) in CASES {
        for (from, to) in [(wanted[0], wanted[2]), (wanted[2], wanted[0])] {
            let branch = sweep(&duffing.model(), &harmonics(1), from, to, &wanted);
            let size = duffing.force.powi(2);
            for (&omega, a) in branch.omega().iter().zip(branch.amplitude()) {
                let surplus = duffing.surplus(omega, a * a);
                // The residual's tolerance bounds the motion, whose error the slope magnifies.
                assert!(surplus.abs() < 1e-8 * size, "{duffing:?}, {omega}: {surplus:e}");
            }
            for (i, &omega) in wanted.iter().enumerate() {
                let mut found: Vec<f64> = branch.at(i).iter().map(|s| s.amplitude).collect();
                found.sort_by(f64::total_cmp);
                let expected = duffing.amplitudes(omega);
                assert_eq!(found.len(), expected.len(), "{duffing:?} at {omega}: {found:?}");
                assert_eq!(found.len(), if i == 1 { 3 } else { 1 });
                for (a, b) in found.iter().zip(&expected) {
                    assert!((a / b - 1.0).abs() < 1e-12, "{duffing:?} at {omega}: {a} {b}");
                }
            }
            assert_eq!(branch.folds().len(), 2, "{duffing:?}");
            for fold in branch.folds() {
                // The surplus is stationary in s.
                let s = fold.amplitude.powi(2);
                let detuning = duffing.detuning(fold.omega, s);
                let terms = [
                    detuning.powi(2),
                    (duffing.c * fold.omega).powi(2),
                    1.5 * duffing.k3 * s * detuning,
                ];
                let scale = terms.iter().fold(0.0_f64, |m, t| m.max(t.abs()));
                assert!(terms.iter().sum::<f64>().abs() < 1e-6 * scale, "{duffing:?}: {fold:?}");
            }
        }
    }
}

#[test]
fn units_of_length_do_not_matter() {
    let answer = |duffing: Duffing| solve_at(&duffing.model(), &harmonics(7), 1.05).amplitude()[0];
    let expected = answer(HARDENING);
    for length in [1e-9, 1e-3, 1e12] {
        let scaled = Duffing {
            k3: HARDENING.k3 / (length * length),
            force: HARDENING.force * length,
            ..HARDENING
        };
        assert!((answer(scaled) / length / expected - 1.0).abs() < 1e-10);
    }
}

#[test]
fn without_damping_the_cubic_term_alone_bounds_the_linear_resonance() {
    for duffing in [HARDENING, PURE] {
        let undamped = Duffing { c: 0.0, ..duffing };
        let branch = solve_at(&undamped.model(), &harmonics(1), 1.0);
        let expected = (undamped.force / (0.75 * undamped.k3)).cbrt();
        assert!((branch.amplitude()[0] / expected - 1.0).abs() < 1e-12);
    }
}

#[test]
fn from_a_cold_start_the_other_side_of_the_resonance_is_reached() {
    // The linear oscillator answers on one side of its resonance, the nonlinear one has a solution
    // on the other side alone: the homotopy must pass the peak, at an amplitude of 1/c.
    for (k3, omega) in [(1.0, 1.1), (-1.0, 0.9), (1e4, 1.7), (-1e3, 0.5)] {
        for c in [0.1, 1e-2, 1e-3] {
            for (k, kt) in [(1.0, 0.0), (0.5, 0.5), (0.0, 1.0)] {
                let duffing = Duffing {
                    c,
                    k,
                    kt,
                    k3,
                    force: 0.3,
                };
                for highest in [1, 9] {
                    let branch = solve_at(&duffing.model(), &harmonics(highest), omega);
                    let a = branch.amplitude()[0];
                    if highest == 1 {
                        let terms = a * a * duffing.detuning(omega, a * a).powi(2) + duffing.force.powi(2);
                        assert!(duffing.surplus(omega, a * a).abs() < 1e-8 * terms, "{duffing:?}: {a}");
                    }
                }
            }
        }
    }
}

#[test]
fn many_harmonics_give_the_motion_that_marching_in_time_finds() {
    let highest = 31;
    for (duffing, wanted) in CASES {
        let model = duffing.model();
        let branch = sweep(&model, &harmonics(highest), wanted[0], wanted[2], &wanted);
        assert!(branch.folds().len() >= 2);
        for (i, &omega) in wanted.iter().enumerate() {
            let mut found = branch.at(i).to_vec();
            found.sort_by(|a, b| a.amplitude.total_cmp(&b.amplitude));
            // The middle one of three is unstable.
            let stable: Vec<_> = found.iter().step_by(2).collect();
            for special in stable {
                let mut x = vec![Complex64::ZERO; highest + 1];
                branch.harmonics_at(special.point, &mut x).unwrap();
                // e^{−ct/2} has fallen below 1e-40; where the spring is soft at rest, one of the two
                // decays is slower than that and the other quicker.
                let periods = (200.0 / duffing.c * omega / TAU) as usize + 1;
                let gap = relative_gap(&x, &duffing.marched(omega, &x, periods));
                println!("{duffing:?} at {omega}: {gap:.1e}");
                assert!(gap < 1e-9, "{duffing:?} at {omega}, {}: {gap:.1e}", special.amplitude);
            }
        }
    }
}

#[test]
fn a_static_load_bends_the_spring_as_its_cubic_equation_says() {
    for duffing in [HARDENING, PURE, FLOATING] {
        let mut model = duffing.model();
        model.clear_forces();
        let load = 20.0;
        model.add_force(0, 0, load.into()).unwrap();
        let result = solve_static(&model);
        if duffing.k == 0.0 {
            assert!(result.is_some(), "the cubic spring alone carries the load");
        }
        let x = result.unwrap();
        let force = (duffing.k + duffing.kt) * x + duffing.k3 * x.powi(3);
        assert!((force / load - 1.0).abs() < 1e-11, "{duffing:?}: {force}");
    }
}

fn solve_static(model: &Model) -> Option<f64> {
    let branch = solve_at(model, &harmonics(3), 1.0);
    let mut x = vec![Complex64::ZERO; 4];
    branch.harmonics_at(0, &mut x).ok()?;
    Some(x[0].re)
}

/// A damped chain held by cubic springs, by friction and by both, with more unknowns than make the
/// library look from the stuck structure.
fn chain(contacts: impl Fn(&mut Model, usize)) -> Model {
    unit_chain(24)
        .with(|model| (0..24).for_each(|i| contacts(model, i)))
        .rayleigh(0.0, 0.02)
        .force(0, 1, 3.0)
        .build()
}

#[test]
fn with_many_contacts_the_stuck_start_is_the_structure_on_linear_springs() {
    let start = |k3: f64| {
        let model = chain(|model, i| {
            model.add_contact(&Contact::cubic(i, None, 0.5, k3)).unwrap();
        });
        (
            Condensed::new(&model, &harmonics(5), 0.8, &Interrupt::none()).unwrap(),
            model,
        )
    };
    let (condensed, _) = start(0.3);
    assert_eq!(condensed.reference(), Reference::Stuck);
    let interrupt = Interrupt::none();
    let mut problem = HarmonicBalance::new(&condensed, 0, (0.8, 0.8).into(), 0, None, &interrupt).unwrap();
    let mut u = vec![0.0; problem.unknowns()];
    assert!(problem.initial_guess(InitialGuess::Stuck, 0.8, &mut u).unwrap());
    let (linear, model) = start(0.0);
    assert_eq!((linear.coordinates(), condensed.coordinates()), (0, 24));
    let branch = solve_at(&model, &harmonics(5), 0.8);
    let mut x = vec![Complex64::ZERO; 6 * 24];
    branch.harmonics_at(0, &mut x).unwrap();
    let set = condensed.set();
    let m = set.packed_len();
    let found: Vec<Complex64> = (0..24)
        .map(|c| set.get(&u[c * m..(c + 1) * m], 0) * condensed.length())
        .collect();
    assert!(relative_gap(&found, &x[24..48]) < 1e-12);
}

#[test]
fn friction_and_cubic_springs_side_by_side_balance_all_forces() {
    let model = chain(|model, i| {
        if i % 3 != 0 {
            model.add_contact(&Contact::jenkins(i, None, 0.5, 0.5, 0.2)).unwrap();
        }
        if i % 3 != 1 {
            let k3 = if i % 2 == 0 { 0.4 } else { -0.02 };
            model.add_contact(&Contact::cubic(i, None, 0.1, k3)).unwrap();
        }
    });
    let solver = harmonics(5);
    let branch = solve_at(&model, &solver, 0.8);
    let mut x = vec![Complex64::ZERO; 6 * 24];
    branch.harmonics_at(0, &mut x).unwrap();
    let mut r = x.clone();
    forced_residual(&model, &solver, 0.8, &x, &mut r, None, None).unwrap();
    assert!(common::largest(&r) < 1e-9 * 3.0, "{:e}", common::largest(&r));
    assert!(common::slip(&branch, 0) > 0.1);
    let reduction = branch.reduction();
    assert!(reduction.even_removed && reduction.inert == 0 && reduction.never_slipping == 0);
}

#[test]
fn at_small_motion_a_cubic_spring_is_its_linear_term() {
    let frequency = |contact: Option<Contact>, state| {
        let mut model = Duffing { k: 2.0, ..HARDENING }.model();
        if let Some(contact) = contact {
            model.add_contact(&contact).unwrap();
        }
        model.linear_modes(0, state).unwrap().omega[0]
    };
    let close = |a: f64, b: f64| (a / b - 1.0).abs() < 1e-14;
    assert!(close(frequency(None, ContactState::Free), 2.0_f64.sqrt()));
    assert!(close(frequency(None, ContactState::Stuck), 2.4_f64.sqrt()));
    for (contact, stiffness) in [
        (Contact::cubic(0, None, 1.1, 0.0), 3.5),
        (Contact::cubic(0, None, 0.0, -3.0), 2.4),
        (Contact::jenkins(0, None, 1.0, 0.3, 0.0), 2.4),
    ] {
        assert!(close(
            frequency(Some(contact), ContactState::Stuck),
            f64::sqrt(stiffness)
        ));
    }
}
