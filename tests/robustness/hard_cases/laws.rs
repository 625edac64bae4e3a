//! A law on a prescribed motion, through the function of the C interface.

use super::Case;
use crate::common::friction;
use hbvib::capi::{hbvib_contact, hbvib_contact_evaluate, hbvib_contact_init, hbvib_contact_kind};
use std::mem::MaybeUninit;
use std::ptr;

/// A description with the constants (kt, kn, mu, preload).
fn described(kind: hbvib_contact_kind, [kt, kn, mu, preload]: [f64; 4]) -> hbvib_contact {
    let mut c = MaybeUninit::uninit();
    let status = unsafe { hbvib_contact_init(c.as_mut_ptr(), size_of::<hbvib_contact>()) };
    assert_eq!(status, 0);
    // Initialised by the call.
    let c: hbvib_contact = unsafe { c.assume_init() };
    hbvib_contact {
        kind: kind as i32,
        kt,
        kn,
        mu,
        preload,
        ..c
    }
}

pub fn jenkins(kt: f64, limit: f64) -> hbvib_contact {
    described(hbvib_contact_kind::HBVIB_JENKINS, [kt, 0.0, 1.0, limit])
}

/// Force and Jacobian, column-major, of a law on a motion of (re, im) pairs.
pub fn evaluated(c: &hbvib_contact, harmonics: usize, samples: usize, motion: &[f64]) -> (Vec<f64>, Vec<f64>) {
    let n = motion.len();
    let mut force = vec![f64::NAN; n];
    let mut jacobian = vec![f64::NAN; n * n];
    let status = unsafe {
        hbvib_contact_evaluate(
            ptr::from_ref(c),
            harmonics as i64,
            samples as i64,
            1.0,
            motion.as_ptr(),
            n as i64 / 2,
            force.as_mut_ptr(),
            n as i64 / 2,
            jacobian.as_mut_ptr(),
            (n * n) as i64,
        )
    };
    assert_eq!(status, 0);
    (force, jacobian)
}

/// Complex pairs of [a0, a1, b1, …], X = a − ib, times a sign.
fn pairs(coefficients: &[f64], sign: f64) -> Vec<f64> {
    let mut pairs = vec![sign * coefficients[0], 0.0];
    for ab in coefficients[1..].chunks_exact(2) {
        pairs.extend([sign * ab[0], -sign * ab[1]]);
    }
    pairs
}

fn norm(x: &[f64]) -> f64 {
    x.iter().fold(0.0, |m: f64, x| m.hypot(*x))
}

fn relative(a: &[f64], b: &[f64]) -> f64 {
    let difference: Vec<f64> = a.iter().zip(b).map(|(a, b)| a - b).collect();
    norm(&difference) / norm(b)
}

pub fn few_samples(case: &Case) {
    let law = jenkins(case.number("k"), case.number("fc"));
    let motion = pairs(&case.numbers("motion"), 1.0);
    let h = motion.len() / 2 - 1;
    let wanted = pairs(&super::list(case.reference(&["F_exact"])), 1.0);
    let (exact, _) = evaluated(&law, h, 0, &motion);
    case.within("exact force", Some(h), relative(&exact, &wanted), 0.0, case.rel_tol);
    case.within(
        "exact force, largest component",
        Some(h),
        largest_gap(&exact, &wanted),
        0.0,
        case.rel_tol,
    );
    // The reference sampled in its own way: the errors are of one order, which is all that they tell. That a solver's
    // check of sampling tells this order too is a test of its own.
    let mut sampled = vec![(1 << 20, case.wanted("check_N2^20"))];
    for n in case.numbers("N") {
        sampled.push((n as usize, case.wanted(&format!("relerr_N{n}"))));
    }
    for (n, wanted) in sampled {
        let error = relative(&evaluated(&law, h, n, &motion).0, &exact);
        case.holds(
            &format!("{n} samples are {error:.1e} off, as the reference's {wanted:.1e} by a factor of 5"),
            (error / wanted).ln().abs() < 5.0_f64.ln(),
        );
    }
}

fn largest_gap(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).fold(0.0, |m, (a, b)| f64::max(m, (a - b).abs()))
}

/// Law, motion in (re, im) pairs and H of a case of friction under a load that varies. The reference has the closing
/// Y and the normal force N; the library the separation −Y and the force −N.
fn described_friction(case: &Case) -> (hbvib_contact, Vec<f64>, usize) {
    assert_eq!(case.param("layout").as_str(), Some("[a0,a1,b1,...]"));
    let constants = ["kt", "kn", "mu", "n0"].map(|name| case.number(name));
    let law = described(hbvib_contact_kind::HBVIB_FRICTION_2D, constants);
    let motion = [pairs(&case.numbers("X"), 1.0), pairs(&case.numbers("Y"), -1.0)].concat();
    let h = motion.len() / 4 - 1;
    (law, motion, h)
}

/// Largest difference of the Jacobian from central differences of the exact force.
fn against_differences(law: &hbvib_contact, h: usize, motion: &[f64], jacobian: &[f64]) -> f64 {
    let n = motion.len();
    let mut worst = 0.0_f64;
    let step = 1e-5;
    for j in 0..n {
        let at = |step: f64| {
            let mut moved = motion.to_vec();
            moved[j] += step;
            evaluated(law, h, 0, &moved).0
        };
        // Richardson's extrapolation of two central differences: an error of order step⁴.
        let (near, far) = ((at(step), at(-step)), (at(2.0 * step), at(-2.0 * step)));
        for i in 0..n {
            let d1 = (near.0[i] - near.1[i]) / (2.0 * step);
            let d2 = (far.0[i] - far.1[i]) / (4.0 * step);
            worst = worst.max(((4.0 * d1 - d2) / 3.0 - jacobian[j * n + i]).abs());
        }
    }
    worst
}

pub fn separation(case: &Case) {
    let (law, motion, h) = described_friction(case);
    let wanted = [
        pairs(&super::list(case.reference(&["Ft"])), 1.0),
        pairs(&super::list(case.reference(&["Fn"])), -1.0),
    ]
    .concat();
    let (force, jacobian) = evaluated(&law, h, 0, &motion);
    case.within(
        "exact force, largest component",
        Some(h),
        largest_gap(&force, &wanted),
        0.0,
        case.rel_tol,
    );
    let gap = against_differences(&law, h, &motion, &jacobian);
    case.within("Jacobian against differences", Some(h), gap, 0.0, 1e-9);
    exact_whatever_the_samples(case, &law, h, &motion);
    // A plain march over samples converges to it as fast as the reference's did.
    let (df, dj) = march(case, 1 << 18);
    case.within("2^18 samples, force", Some(h), df, case.wanted("plain_2p18_dF"), 0.1);
    case.within("2^18 samples, Jacobian", Some(h), dj, case.wanted("plain_2p18_dJ"), 1.0);
}

/// The law has its events exactly; a number of samples changes nothing.
fn exact_whatever_the_samples(case: &Case, law: &hbvib_contact, h: usize, motion: &[f64]) {
    let exact = evaluated(law, h, 0, motion);
    case.holds(
        "a number of samples changes nothing",
        evaluated(law, h, 64, motion) == exact,
    );
}

/// How far a march over n samples is from the exact force, and its derivative from that of the tangential force.
fn march(case: &Case, samples: usize) -> (f64, f64) {
    let constants = ["kt", "kn", "mu", "n0"].map(|name| case.number(name));
    let (law, set, motion) = friction::case(constants, &case.numbers("X"), &case.numbers("Y"));
    let exact = friction::evaluate(&law, &set, &motion);
    let march = friction::March {
        law: &law,
        set: &set,
        samples,
        located: false,
    };
    let mut jacobian = vec![0.0; exact.jacobian.len()];
    let force = march.run(&motion, Some(&mut jacobian));
    let m = set.packed_len();
    let tangential = jacobian.chunks(2 * m).zip(exact.jacobian.chunks(2 * m));
    let dj = tangential.fold(0.0, |worst, (a, b)| f64::max(worst, largest_gap(&a[..m], &b[..m])));
    (largest_gap(&force, &exact.force), dj)
}

pub fn sticking_at_closing(case: &Case) {
    let (law, motion, h) = described_friction(case);
    let (_, jacobian) = evaluated(&law, h, 0, &motion);
    let gap = against_differences(&law, h, &motion, &jacobian);
    case.within("exact Jacobian against differences", Some(h), gap, 0.0, case.rel_tol);
    exact_whatever_the_samples(case, &law, h, &motion);
    // The case warns: the tangents of samples do not see the closing move, however many they are.
    for n in [1 << 10, 1 << 14, 1 << 18] {
        let (df, dj) = march(case, n);
        case.holds(&format!("{n} samples: force {df:.1e}, Jacobian {dj:.1e} off"), dj > 0.1);
    }
}
