//! Shared code of the tests of laws without memory: motions, laws, one evaluation, dense sampling.

use hbvib::internals::Evaluation;
use hbvib::internals::HarmonicSet;
use hbvib::internals::Memoryless;
use hbvib::internals::MemorylessEvaluator;
use hbvib::internals::Samples;
use hbvib::{Call, Error, Interrupt, Monomial, Polynomial, Status, User, UserForce};
use std::f64::consts::TAU;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

/// A packed motion of `directions` signals with many harmonics, in numbers of size 1.
pub fn motion(set: &HarmonicSet, directions: usize, seed: usize) -> Vec<f64> {
    let m = set.packed_len();
    (0..directions * m)
        .map(|i| ((i * 37 + seed * 11 + 5) as f64 * 0.61).sin() / (1.0 + 0.2 * (i % m) as f64))
        .collect()
}

/// Odd, full and sparse sets of harmonics up to `highest`.
pub fn sets(highest: usize) -> [HarmonicSet; 4] {
    let excited = |forced: &[usize], odd| HarmonicSet::excited(forced, highest, true, odd, false).unwrap();
    [
        excited(&[1], true),
        excited(&[1], false),
        excited(&[3], true),
        HarmonicSet::all(highest).unwrap(),
    ]
}

pub fn evaluate(law: &dyn Memoryless, set: &HarmonicSet, omega: f64, motion: &[f64]) -> Evaluation {
    evaluate_at(0, law, set, omega, motion)
}

/// The same with a requested number of samples.
pub fn evaluate_at(
    requested: usize,
    law: &dyn Memoryless,
    set: &HarmonicSet,
    omega: f64,
    motion: &[f64],
) -> Evaluation {
    evaluate_with(law.samples(set.highest_reduced(), requested), law, set, omega, motion)
}

/// The same with exactly this number of samples.
pub fn evaluate_with(
    samples: usize,
    law: &dyn Memoryless,
    set: &HarmonicSet,
    omega: f64,
    motion: &[f64],
) -> Evaluation {
    let mut out = Evaluation::new(set, law.directions()).unwrap();
    let mut evaluator = MemorylessEvaluator::new(set, law, samples).unwrap();
    evaluator
        .evaluate(law, set, (omega, motion), &mut out, &Interrupt::none())
        .unwrap();
    out
}

pub fn largest(x: &[f64]) -> f64 {
    x.iter().fold(0.0, |m, x| m.max(x.abs()))
}

pub fn gap(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    let difference: Vec<f64> = a.iter().zip(b).map(|(a, b)| a - b).collect();
    largest(&difference) / largest(b).max(f64::MIN_POSITIVE)
}

/// Forces and tangents of `law` at one time.
pub fn at_one_time(law: &dyn Memoryless, omega: f64, u: &[f64], v: &[f64]) -> Vec<f64> {
    let d = law.directions();
    let (mut f, mut du, mut dv) = (vec![0.0; d], vec![0.0; d * d], vec![0.0; d * d]);
    let feels = law.uses_velocity();
    let out = Samples {
        f: &mut f,
        df_du: &mut du,
        df_dv: if feels { &mut dv } else { &mut [] },
        scratch: &mut vec![0.0; 2 * d],
    };
    law.evaluate(omega, 1, u, if feels { v } else { &[] }, out).unwrap();
    f
}

/// Packed harmonics of the force g(u, v) by 2¹⁶ samples.
pub fn dense(
    set: &HarmonicSet,
    directions: usize,
    omega: f64,
    motion: &[f64],
    g: impl Fn(&[f64], &[f64]) -> Vec<f64>,
) -> Vec<f64> {
    let (n, m) = (1 << 16, set.packed_len());
    let mut row = vec![0.0; m];
    let mut sums = vec![0.0; motion.len()];
    let rate: Vec<f64> = (0..directions * m)
        .map(|i| {
            // ωih·X in packed form: (Re, Im) becomes ωh·(−Im, Re).
            let (base, at) = (i - i % m, i % m);
            let mean = usize::from(set.has_mean());
            if at < mean {
                return 0.0;
            }
            let rate = omega * set.numbers()[(at - mean) / 2 + mean] as f64;
            if (at - mean) % 2 == 0 {
                -rate * motion[base + at + 1]
            } else {
                rate * motion[base + at - 1]
            }
        })
        .collect();
    for j in 0..n {
        set.basis(TAU * f64::from(j) / f64::from(n), &mut row);
        let value = |x: &[f64]| row.iter().zip(x).map(|(c, x)| c * x).sum::<f64>();
        let u: Vec<f64> = motion.chunks_exact(m).map(value).collect();
        let v: Vec<f64> = rate.chunks_exact(m).map(value).collect();
        for (sums, f) in sums.chunks_exact_mut(m).zip(g(&u, &v)) {
            for (i, (s, c)) in sums.iter_mut().zip(&row).enumerate() {
                let weight = if set.has_mean() && i == 0 { 1.0 } else { 2.0 };
                *s += weight * f * c / f64::from(n);
            }
        }
    }
    sums
}

/// A product of powers.
pub fn term<'a>(direction: usize, coefficient: f64, displacements: &'a [u32], velocities: &'a [u32]) -> Monomial<'a> {
    Monomial {
        direction,
        coefficient,
        displacements,
        velocities,
    }
}

pub fn van_der_pol() -> Polynomial {
    Polynomial::new(
        1,
        &[
            term(0, -0.4, &[], &[1]),
            term(0, 0.7, &[2], &[1]),
            term(0, 0.2, &[1], &[]),
        ],
    )
    .unwrap()
}

pub fn quintic() -> Polynomial {
    Polynomial::scalar(&[0.3, 0.0, -0.5, 0.0, 0.8], &[0.05, 0.0, 0.02]).unwrap()
}

pub fn tensor(len: usize, seed: usize) -> Vec<f64> {
    (0..len).map(|i| ((i * 53 + seed) as f64 * 0.37).sin()).collect()
}

/// Coupled stiffness of three directions, without symmetry.
pub fn coupled() -> Polynomial {
    Polynomial::tensors(3, &tensor(9, 1), &tensor(27, 2), &tensor(81, 3)).unwrap()
}

/// A mixture of motions and velocities of both directions.
pub fn mixed() -> Polynomial {
    Polynomial::new(
        2,
        &[
            term(0, 0.8, &[1, 2], &[0, 1]),
            term(0, -0.3, &[0, 0], &[2, 0]),
            term(1, 0.6, &[3, 0], &[]),
            term(1, 0.5, &[0, 1], &[1, 1]),
        ],
    )
    .unwrap()
}

/// A force of two directions that is no polynomial: a pendulum with a fluid's drag, in a field.
pub struct Pendulum {
    pub calls: AtomicUsize,
}

impl Pendulum {
    pub fn force(u: &[f64], v: &[f64]) -> [f64; 2] {
        let drag = (0.1 + v[0] * v[0] + v[1] * v[1]).sqrt();
        [u[0].sin() + 0.2 * drag * v[0], u[1].tanh() * u[0] + 0.2 * drag * v[1]]
    }
}

impl UserForce for Pendulum {
    fn evaluate(&self, call: &mut Call<'_>) -> i32 {
        self.calls.fetch_add(1, Ordering::Relaxed);
        for j in 0..call.samples {
            let (u, v) = (&call.u[2 * j..2 * j + 2], &call.v[2 * j..2 * j + 2]);
            call.f[2 * j..2 * j + 2].copy_from_slice(&Self::force(u, v));
            let drag = (0.1 + v[0] * v[0] + v[1] * v[1]).sqrt();
            let tanh = u[1].tanh();
            call.df_du[4 * j..4 * j + 4].copy_from_slice(&[u[0].cos(), 0.0, tanh, u[0] * (1.0 - tanh * tanh)]);
            let dv = |a: usize, b: usize| 0.2 * (f64::from(u8::from(a == b)) * drag + v[a] * v[b] / drag);
            call.df_dv[4 * j..4 * j + 4].copy_from_slice(&[dv(0, 0), dv(0, 1), dv(1, 0), dv(1, 1)]);
        }
        0
    }
}

pub fn pendulum() -> (Arc<Pendulum>, User) {
    let force = Arc::new(Pendulum {
        calls: AtomicUsize::new(0),
    });
    let user = User::new(force.clone(), 2, 0).unwrap();
    (force, user)
}

/// Whether `set` carries every harmonic that the law excites.
pub fn suits(law: &dyn Memoryless, set: &HarmonicSet) -> bool {
    law.is_odd() || !set.is_odd()
}

pub fn refused(result: &Result<impl Sized, Error>, status: Status, words: &[&str]) {
    let Err(error) = result else {
        panic!("{words:?} was taken")
    };
    assert_eq!(error.status, status, "{error}");
    for word in words {
        assert!(error.message().contains(word), "{error} does not say {word}");
    }
}
