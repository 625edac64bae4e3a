//! Callbacks of the caller as laws: what they are asked, what they may answer.

use crate::common::pointwise::{Pendulum, dense, evaluate, gap, motion, pendulum, refused};
use hbvib::internals::Evaluation;
use hbvib::internals::HarmonicSet;
use hbvib::internals::Memoryless;
use hbvib::internals::MemorylessEvaluator;
use hbvib::internals::automatic_samples;
use hbvib::{Call, Interrupt, Polynomial, Status, User, UserForce};
use std::sync::Arc;
use std::sync::atomic::Ordering;

#[test]
fn a_callback_gives_the_harmonics_of_dense_sampling_and_is_called_once_per_period() {
    let (force, law) = pendulum();
    let set = HarmonicSet::all(4).unwrap();
    let x = motion(&set, 2, 1);
    let omega = 0.7;
    let mut out = Evaluation::new(&set, 2).unwrap();
    let mut evaluator = MemorylessEvaluator::new(&set, &law, law.samples(set.highest_reduced(), 0)).unwrap();
    for _ in 0..3 {
        evaluator
            .evaluate(&law, &set, (omega, &x), &mut out, &Interrupt::none())
            .unwrap();
    }
    assert_eq!(force.calls.load(Ordering::Relaxed), 3);
    let many = User {
        samples: 1024,
        ..law.clone()
    };
    let expected = dense(&set, 2, omega, &x, |u, v| Pendulum::force(u, v).to_vec());
    let (few, many) = (
        gap(&out.force, &expected),
        gap(&evaluate(&many, &set, omega, &x).force, &expected),
    );
    println!(
        "callback: {} samples {few:.1e}, 1024 samples {many:.1e}",
        law.samples(4, 0)
    );
    assert!(few < 1e-4 && many < 1e-13);
    assert_eq!([0, 1, 4, 5, 7].map(automatic_samples), [64, 64, 64, 128, 128]);
}

/// A spring u + u³, which feels no velocity.
struct Hardening;

impl UserForce for Hardening {
    fn evaluate(&self, call: &mut Call<'_>) -> i32 {
        assert!(call.v.is_empty() && call.df_dv.is_empty());
        // The whole period, whatever the symmetry.
        assert!(call.samples >= 64 && call.u.len() == call.samples);
        for ((f, df), u) in call.f.iter_mut().zip(&mut *call.df_du).zip(call.u) {
            *f = u + u * u * u;
            *df = 1.0 + 3.0 * u * u;
        }
        0
    }
}

#[test]
fn a_callback_that_is_a_polynomial_gives_its_harmonics() {
    let polynomial = Polynomial::scalar(&[1.0, 0.0, 1.0], &[]).unwrap();
    let law = User {
        velocity: false,
        odd: true,
        ..User::new(Arc::new(Hardening), 1, 0).unwrap()
    };
    for length in [1.0, 0.25] {
        let (law, polynomial) = (law.in_units(length), polynomial.in_units(length));
        for set in [
            HarmonicSet::excited(&[1], 7, true, true, false).unwrap(),
            HarmonicSet::excited(&[3], 63, true, true, false).unwrap(),
            HarmonicSet::all(7).unwrap(),
            HarmonicSet::all(0).unwrap(),
            HarmonicSet::excited(&[], 3, true, true, false).unwrap(),
        ] {
            let x = motion(&set, 1, 2);
            let (found, expected) = (evaluate(&law, &set, 1.0, &x), evaluate(&polynomial, &set, 1.0, &x));
            for (a, b) in [(&found.force, &expected.force), (&found.jacobian, &expected.jacobian)] {
                assert!(
                    gap(a, b) < 1e-14,
                    "{} harmonics: {:.1e}",
                    set.numbers().len(),
                    gap(a, b)
                );
            }
        }
    }
    let nowhere = User { directions: 0, ..law };
    let refusal = MemorylessEvaluator::new(&HarmonicSet::all(1).unwrap(), &nowhere, 64);
    refused(&refusal, Status::Argument, &["directions = 0"]);
}

/// A callback that fails as it is told.
#[derive(Clone, Copy)]
struct Failing {
    code: i32,
    force: f64,
    slope: f64,
    writes: bool,
}

impl UserForce for Failing {
    fn evaluate(&self, call: &mut Call<'_>) -> i32 {
        if self.writes {
            call.f.fill(0.0);
            call.f[2 * 5 + 1] = self.force;
            call.df_dv[4 * 7 + 2] = self.slope;
        }
        self.code
    }
}

#[test]
fn failures_of_a_callback_keep_its_code_and_name_the_place() {
    let set = HarmonicSet::all(2).unwrap();
    let x = motion(&set, 2, 1);
    let fine = Failing {
        code: 0,
        force: 1.0,
        slope: 1.0,
        writes: true,
    };
    let answer = |force: Failing, x: &[f64]| {
        let law = User::new(Arc::new(force), 2, 0).unwrap();
        let mut out = Evaluation::new(&set, 2).unwrap();
        let mut evaluator = MemorylessEvaluator::new(&set, &law, law.samples(set.highest_reduced(), 0)).unwrap();
        evaluator
            .evaluate(&law, &set, (1.0, x), &mut out, &Interrupt::none())
            .map(|()| out)
    };
    let error = |force: Failing| answer(force, &x).expect_err("a failure");
    let e = error(Failing { code: 7, ..fine });
    assert!(e.status == Status::Callback && e.callback == 7 && e.recoverable, "{e}");
    assert!(e.message().contains("returned 7"));
    let e = error(Failing { code: -3, ..fine });
    assert!(
        e.status == Status::Callback && e.callback == -3 && !e.recoverable,
        "{e}"
    );
    // Text before the sentence leaves the code alone.
    let e = e.at(format_args!("contact 2"));
    assert!(e.callback == -3 && e.message().contains("contact 2: the force callback returned -3"));
    for (failing, place) in [
        (
            Failing {
                force: f64::NAN,
                ..fine
            },
            "f[5,1] = NaN",
        ),
        (
            Failing {
                force: f64::NEG_INFINITY,
                ..fine
            },
            "f[5,1] = -inf",
        ),
        (
            Failing {
                slope: f64::NAN,
                ..fine
            },
            "df_dv[7,1,0] = NaN",
        ),
        (Failing { writes: false, ..fine }, "f[0,0] = NaN"),
    ] {
        let e = error(failing);
        assert!(e.status == Status::Callback && e.callback == 0 && e.recoverable);
        assert!(e.message().contains(place), "{e}");
    }
    // A motion that is no number is not the callback's fault, and it never sees it.
    let mut lost = x.clone();
    lost[3] = f64::NAN;
    let e = answer(Failing { code: -1, ..fine }, &lost).expect_err("no motion");
    assert!(e.status == Status::NotFinite && e.callback == 0 && e.recoverable, "{e}");
    assert!(answer(fine, &x).is_ok());
}
