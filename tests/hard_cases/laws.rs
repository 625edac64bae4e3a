//! A law on a prescribed motion, through the function of the C interface.

use super::Case;
use hbvib::capi::contact::{hbvib_contact_evaluate, hbvib_contact_init};
use hbvib::capi::contact_types::{hbvib_contact, hbvib_contact_kind};
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
    let dense = relative(&evaluated(&law, h, 1 << 20, &motion).0, &exact);
    case.within("2^20 samples", Some(h), dense, case.wanted("check_N2^20"), 0.5);
    for n in case.numbers("N") {
        let error = relative(&evaluated(&law, h, n as usize, &motion).0, &exact);
        let wanted = case.wanted(&format!("relerr_N{n}"));
        case.within(&format!("error of {n} samples"), Some(h), error, wanted, 0.5);
    }
}

fn largest_gap(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).fold(0.0, |m, (a, b)| f64::max(m, (a - b).abs()))
}

/// Law, motion in (re, im) pairs and H of a case of friction under a load that varies. The reference has the closing
/// Y and the normal force N; the library the separation −Y and the force −N.
fn friction(case: &Case) -> (hbvib_contact, Vec<f64>, usize) {
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
    let (law, motion, h) = friction(case);
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
    let (dense, dense_jacobian) = evaluated(&law, h, 1 << 18, &motion);
    // A sampled law of its own kind: the distances are those of the order of the reference's samples, no more.
    let (of_force, of_jacobian) = (case.wanted("plain_2p18_dF"), case.wanted("plain_2p18_dJ"));
    let (df, dj) = (largest_gap(&dense, &force), largest_gap(&dense_jacobian, &jacobian));
    case.line(&format!(
        "2^18 samples differ by {df:.1e} and {dj:.1e}, those of the reference by {of_force:.1e} and {of_jacobian:.1e}"
    ));
    case.holds(
        "2^18 samples are within 1e-5 of the force, 1e-4 of the Jacobian",
        df < 1e-5 && dj < 1e-4,
    );
}

pub fn sticking_at_closing(case: &Case) {
    let (law, motion, h) = friction(case);
    let (_, jacobian) = evaluated(&law, h, 0, &motion);
    let gap = against_differences(&law, h, &motion, &jacobian);
    case.within("exact Jacobian against differences", Some(h), gap, 0.0, case.rel_tol);
    let samples = [1 << 10, 1 << 14, 1 << 18];
    for n in samples {
        let (_, sampled) = evaluated(&law, h, n, &motion);
        case.line(&format!(
            "{n} samples: their Jacobian is {:.1e} off",
            largest_gap(&sampled, &jacobian)
        ));
    }
}
