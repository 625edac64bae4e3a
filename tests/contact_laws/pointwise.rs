//! Laws without memory: derivatives, units and symmetries of polynomials, regularised friction and
//! callbacks, against finite differences and dense sampling.

use crate::common::pointwise::{
    coupled, dense, evaluate, evaluate_at, gap, largest, mixed, motion, pendulum, quintic, refused, sets, suits, term,
    van_der_pol,
};
use crate::common::stencil::Stencil;
use hbvib::internals::HarmonicSet;
use hbvib::internals::Memoryless;
use hbvib::internals::MemorylessEvaluator;
use hbvib::internals::TanhFriction;
use hbvib::{Polynomial, Status, User};
use std::f64::consts::TAU;

/// Every kind of law, with motions and velocities, odd and not.
fn laws() -> Vec<(&'static str, Box<dyn Memoryless>)> {
    vec![
        ("van der Pol", Box::new(van_der_pol())),
        ("quintic", Box::new(quintic())),
        ("coupled", Box::new(coupled())),
        ("mixed", Box::new(mixed())),
        ("tanh", Box::new(TanhFriction::new(0.7, 0.4).unwrap())),
        ("callback", Box::new(pendulum().1)),
    ]
}

#[test]
fn jacobian_and_slope_by_frequency_are_those_of_finite_differences() {
    let omega = 1.3;
    for (name, law) in laws() {
        for (which, set) in sets(5).iter().enumerate().filter(|(_, set)| suits(&*law, set)) {
            let x = motion(set, law.directions(), which);
            let out = evaluate(&*law, set, omega, &x);
            let scale = largest(&out.jacobian).max(largest(&out.force));
            for (c, column) in out.jacobian.chunks_exact(x.len()).enumerate() {
                let stencil = Stencil::of(1e-6, |h| {
                    let mut moved = x.clone();
                    moved[c] += h;
                    evaluate(&*law, set, omega, &moved).force
                });
                stencil.check(name, column, scale).unwrap();
            }
            let stencil = Stencil::of(1e-6, |h| evaluate(&*law, set, omega + h, &x).force);
            stencil.check(name, &out.by_omega, scale).unwrap();
            if !law.uses_velocity() {
                assert!(largest(&out.by_omega) == 0.0);
            }
            // The offset closes F = J·X + offset.
            for (i, (f, o)) in out.force.iter().zip(&out.offset).enumerate() {
                let product: f64 = x
                    .iter()
                    .enumerate()
                    .map(|(c, value)| out.jacobian[c * x.len() + i] * value)
                    .sum();
                assert!((f - o - product).abs() < 1e-13 * scale * x.len() as f64);
            }
        }
    }
}

#[test]
fn half_a_turn_serves_odd_motions() {
    let odd = HarmonicSet::excited(&[1], 7, true, true, false).unwrap();
    let all = HarmonicSet::all(7).unwrap();
    for law in [
        &van_der_pol() as &dyn Memoryless,
        &quintic(),
        &TanhFriction::new(0.7, 0.4).unwrap(),
    ] {
        let x = motion(&odd, 1, 4);
        let mut spread = vec![0.0; all.packed_len()];
        for (i, &h) in odd.numbers().iter().enumerate() {
            all.set(&mut spread, h, odd.get(&x, i));
        }
        let (half, whole) = (evaluate(law, &odd, 1.2, &x), evaluate(law, &all, 1.2, &spread));
        for (i, &h) in odd.numbers().iter().enumerate() {
            assert!((odd.get(&half.force, i) - all.get(&whole.force, h)).norm() < 1e-13);
            assert!((odd.get(&half.by_omega, i) - all.get(&whole.by_omega, h)).norm() < 1e-13);
        }
        for h in [0, 2, 4, 6] {
            assert!(all.get(&whole.force, h).norm() < 1e-13);
        }
    }
}

#[test]
fn velocities_count_the_harmonics_of_omega_and_not_of_the_common_divisor() {
    // c·v on harmonic 3 is 3iωc·X, in a set of the multiples of 3 as well.
    let law = Polynomial::scalar(&[], &[0.4]).unwrap();
    for set in [
        HarmonicSet::excited(&[3], 9, true, true, false).unwrap(),
        HarmonicSet::all(4).unwrap(),
    ] {
        let x = motion(&set, 1, 1);
        let found = evaluate(&law, &set, 1.7, &x).force;
        for (i, &h) in set.numbers().iter().enumerate() {
            let expected = num_complex::Complex64::I * (h as f64 * 1.7 * 0.4) * set.get(&x, i);
            assert!((set.get(&found, i) - expected).norm() < 1e-14);
        }
    }
}

#[test]
fn regularised_friction_is_that_of_dense_sampling_as_exactly_as_its_samples_promise() {
    let omega = 1.1;
    for set in sets(5) {
        let x = motion(&set, 1, 7);
        let limit = 0.7;
        let speed: f64 = 0.5;
        let expected = dense(&set, 1, omega, &x, |_, v| vec![limit * (v[0] / speed).tanh()]);
        let error = |samples: usize| {
            let law = TanhFriction::new(limit, speed).unwrap();
            gap(&evaluate_at(samples, &law, &set, omega, &x).force, &expected)
        };
        println!(
            "tanh: automatic samples {:.1e}, 4096 samples {:.1e}",
            error(0),
            error(4096)
        );
        assert!(error(0) < 1e-7 && error(4096) < 1e-13);
    }
    // One harmonic of velocity V: the error of N samples falls as e^{−(N−H)δ}, sinh δ = πv₀/(2V).
    let set = HarmonicSet::excited(&[1], 1, true, true, false).unwrap();
    let x = [0.3, -0.8];
    let speed: f64 = 0.05;
    let reference = dense(&set, 1, omega, &x, |_, v| vec![(v[0] / speed).tanh()]);
    let delta = (TAU / 4.0 * speed / (omega * f64::hypot(x[0], x[1]))).asinh();
    for n in [64, 128, 256] {
        let law = TanhFriction::new(1.0, speed).unwrap();
        let error = gap(&evaluate_at(n, &law, &set, omega, &x).force, &reference);
        let bound = (-(n as f64 - 1.0) * delta).exp();
        println!("tanh, {n} samples: error {error:.2e}, e^(-(N-H)delta) {bound:.2e}");
        assert!(error < 10.0 * bound + 1e-13, "{n}: {error:e} {bound:e}");
    }
}

#[test]
fn units_of_length_do_not_matter_and_those_of_an_eased_law_are_smaller() {
    let length = 1.0 / 256.0;
    let set = HarmonicSet::all(5).unwrap();
    let easing = |law: &dyn Fn(f64) -> Box<dyn Memoryless>| {
        let d = law(1.0).directions();
        let x = motion(&set, d, 3);
        let scaled: Vec<f64> = x.iter().map(|x| length * x).collect();
        let (mut expected, found) = (
            evaluate(&*law(1.0), &set, 0.9, &scaled),
            evaluate(&*law(length), &set, 0.9, &x),
        );
        for f in &mut expected.force {
            *f /= length;
        }
        assert!(gap(&found.force, &expected.force) < 1e-14);
        assert!(gap(&found.jacobian, &expected.jacobian) < 1e-14);
        // dF/d(ln s) of s·f(x/s) is the offset.
        let h = 1e-5;
        let at = |s: f64| evaluate(&*law(1.0 / s), &set, 0.9, &x);
        let (above, below, here) = (at(f64::exp(h)).force, at(f64::exp(-h)).force, at(1.0));
        for ((offset, a), b) in here.offset.iter().zip(&above).zip(&below) {
            assert!((offset - (a - b) / (2.0 * h)).abs() < 1e-7 * largest(&here.jacobian));
        }
    };
    for law in [van_der_pol(), quintic(), coupled(), mixed()] {
        easing(&|l| Box::new(law.in_units(l)));
    }
    let friction = TanhFriction::new(0.7, 0.4).unwrap();
    easing(&|l| Box::new(friction.in_units(l)));
    let (_, user) = pendulum();
    easing(&|l| Box::new(user.in_units(l)));
}

#[test]
fn bad_constants_are_refused_by_name() {
    let good = term(0, 1.0, &[1, 0], &[]);
    for (bad, status, words) in [
        (term(2, 1.0, &[1, 0], &[]), Status::Index, "direction = 2"),
        (term(0, f64::NAN, &[1, 0], &[]), Status::NotFinite, "coefficient = NaN"),
        (
            term(0, 1.0, &[1], &[]),
            Status::Dimension,
            "1 exponents of displacements",
        ),
        (
            term(0, 1.0, &[1, 0], &[1, 1, 1]),
            Status::Dimension,
            "3 exponents of velocities",
        ),
        (
            term(0, 1.0, &[1, 16], &[]),
            Status::Argument,
            "exponent 1 of displacements = 16",
        ),
        (term(0, 1.0, &[0, 0], &[]), Status::Argument, "constant force"),
        (term(0, 1.0, &[], &[]), Status::Argument, "constant force"),
    ] {
        refused(&Polynomial::new(2, &[good, bad]), status, &["monomial 1", words]);
    }
    refused(&Polynomial::new(0, &[]), Status::Argument, &["directions = 0"]);
    let huge = term(0, f64::MAX, &[1, 0], &[]);
    refused(&Polynomial::new(2, &[huge, huge]), Status::NotFinite, &["inf"]);
    refused(
        &Polynomial::tensors(2, &[], &[0.0; 7], &[]),
        Status::Dimension,
        &["quadratic", "2^3"],
    );
    let mut cubic = [0.0; 16];
    cubic[9] = f64::INFINITY;
    refused(
        &Polynomial::tensors(2, &[], &[], &cubic),
        Status::NotFinite,
        &["cubic", "entry 9", "row 1", "inf"],
    );
    refused(
        &Polynomial::scalar(&[1.0, f64::NAN], &[]),
        Status::NotFinite,
        &["spring[1] is NaN"],
    );
    refused(
        &Polynomial::scalar(&[], &[0.0; 16]),
        Status::Argument,
        &["damper", "16"],
    );
    refused(&TanhFriction::new(1.0, 0.0), Status::Argument, &["velocity = 0"]);
    refused(&TanhFriction::new(-1.0, 1.0), Status::Argument, &["limit = -1"]);
    refused(&TanhFriction::new(f64::NAN, 1.0), Status::NotFinite, &["limit = NaN"]);
    refused(&TanhFriction::new(1e300, 1e-300), Status::NotFinite, &["inf"]);
    let (force, _) = pendulum();
    refused(&User::new(force.clone(), 0, 0), Status::Argument, &["directions = 0"]);
    let few = User::new(force, 2, 8).unwrap();
    let set = HarmonicSet::all(4).unwrap();
    refused(
        &MemorylessEvaluator::new(&set, &few, few.samples(4, 0)),
        Status::Argument,
        &["samples = 8", "at least 9"],
    );
    for samples in [usize::MAX, usize::MAX / 2, 1 << 58] {
        let many = User { samples, ..few.clone() };
        refused(
            &MemorylessEvaluator::new(&set, &many, samples),
            Status::OutOfMemory,
            &["samples"],
        );
    }
}
