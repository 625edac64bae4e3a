//! The Jenkins law on prescribed motions: closed forms (the truth), a play operator marched in
//! time here (the truth up to its step), and the mean of a slider that was never dragged.

use crate::common::{data, largest, number, relative_gap};
use hbvib::{Contact, contact_evaluate};
use num_complex::Complex64;
use std::f64::consts::{PI, TAU};

const KT: f64 = 5e7;
const LIMIT: f64 = 146.563_625_356_177;
/// Motion at which the slider starts to slip.
const PLAY: f64 = LIMIT / KT;

fn contact() -> Contact {
    Contact::jenkins(0, None, KT, 1.0, LIMIT)
}

fn force(motion: &[Complex64], samples: usize) -> Vec<Complex64> {
    let mut f = vec![Complex64::ZERO; motion.len()];
    contact_evaluate(&contact(), motion.len() - 1, samples, 1.0, motion, &mut f, None).unwrap();
    f
}

/// Work per period that the force does on the motion: π Σ h Im(F_h conj X_h).
fn work(motion: &[Complex64], force: &[Complex64]) -> f64 {
    let terms = motion.iter().zip(force).enumerate();
    terms.map(|(h, (x, f))| PI * h as f64 * (f * x.conj()).im).sum()
}

/// Motions with many turning points, in units of the play, by the number of their highest harmonic.
fn rich_motion(highest: usize, size: f64, seed: usize) -> Vec<Complex64> {
    (0..=highest)
        .map(|h| {
            let angle = (seed * 31 + h * 17) as f64 * 0.61;
            let modulus = size * PLAY / (1.0 + 0.6 * h as f64);
            if h == 0 {
                (modulus * angle.sin()).into()
            } else {
                modulus * Complex64::cis(angle)
            }
        })
        .collect()
}

fn value(motion: &[Complex64], tau: f64) -> f64 {
    let terms = motion.iter().enumerate();
    terms.map(|(h, x)| (x * Complex64::cis(h as f64 * tau)).re).sum()
}

/// A slider marched over two periods from rest, f = k(x − z): force coefficients up to the highest
/// harmonic of the motion, and the energy lost to friction, both of the second period.
fn marched(motion: &[Complex64], samples: usize) -> (Vec<Complex64>, f64) {
    let mut slider = 0.0;
    let mut lost = 0.0;
    let mut sums = vec![Complex64::ZERO; motion.len()];
    for j in 0..2 * samples {
        let tau = TAU * (j % samples) as f64 / samples as f64;
        let x = value(motion, tau);
        let before: f64 = slider;
        slider = slider.clamp(x - PLAY, x + PLAY);
        if j < samples {
            continue;
        }
        lost += LIMIT * (slider - before).abs();
        let f = KT * (x - slider);
        for (h, sum) in sums.iter_mut().enumerate() {
            let weight = if h == 0 { 1.0 } else { 2.0 };
            *sum += weight / samples as f64 * f * Complex64::cis(-(h as f64) * tau);
        }
    }
    (sums, lost)
}

#[test]
fn stiffness_loss_and_dissipation_agree_with_their_closed_forms() {
    let reference = data("closed_forms.json");
    let mut worst = 0.0_f64;
    for row in reference["table"].as_array().unwrap() {
        let a = number(&row["a"]);
        // Any phase of the motion gives the same complex stiffness.
        for phase in [0.0, 1.3] {
            let motion = [Complex64::ZERO, Complex64::from_polar(a * PLAY, phase)];
            let f = force(&motion, 0);
            let stiffness = f[1] / motion[1] / KT;
            let expected = Complex64::new(number(&row["k_eq_over_kt"]), number(&row["loss_over_kt"]));
            let error = (stiffness - expected).norm() / expected.norm();
            assert!(error < 1e-12, "amplitude {a}: {error:.1e}");
            assert!(f[0].norm() < 1e-12 * LIMIT);
            let dissipated = work(&motion, &f) / (KT * PLAY * PLAY);
            let stored = number(&row["E_diss_over_kt_delta2"]);
            // Near onset the loss is a small difference of large terms: measure by the elastic energy.
            assert!((dissipated - stored).abs() < 1e-12 * stored.max(a * a));
            worst = worst.max(error);
        }
    }
    println!("largest relative error of the complex stiffness {worst:.1e}");
}

#[test]
fn below_the_slip_limit_the_force_is_the_spring() {
    let motion = [Complex64::ZERO, Complex64::from_polar(0.999 * PLAY, 0.4)];
    let f = force(&motion, 0);
    assert!((f[1] - KT * motion[1]).norm() < 1e-14 * LIMIT);
    assert!(work(&motion, &[Complex64::ZERO, KT * motion[1]]).abs() < 1e-12 * LIMIT * PLAY);
}

#[test]
fn exact_events_agree_with_many_samples_of_the_same_law() {
    for (highest, size) in [(1, 3.0), (3, 2.0), (5, 8.0), (9, 4.0), (9, 40.0), (45, 6.0)] {
        for seed in 0..4 {
            let motion = rich_motion(highest, size, seed);
            let exact = force(&motion, 0);
            let sampled = force(&motion, 1 << 18);
            let gap = relative_gap(&sampled, &exact);
            // The sampled force is O(N⁻²) accurate: 1.5e-11 times the square of the highest
            // harmonic that a force with corners carries.
            assert!(gap < 2e-8, "H = {highest}, size {size}: {gap:.1e}");
        }
    }
}

#[test]
fn reversals_about_to_be_born_are_not_missed() {
    // Near b = 1/9 the crest of cos τ − b cos(3τ + φ) splits, and up to three turning points lie within a
    // small part of the shortest wave. Missing two of them makes the force jump.
    for phase in [-0.06, -0.02, 0.0, 0.003, 0.0494, 0.1] {
        for excess in [-1e-3, 1e-6, 1e-4, 1e-3, 4e-3, 0.0165, 0.05] {
            for turn in 0..24 {
                // In every position relative to any grid of times.
                let shift = f64::from(turn) * TAU / 24.0 / 24.0;
                let b = 1.0 / 9.0 + excess;
                let mut motion = vec![Complex64::ZERO; 4];
                motion[1] = 120.0 * PLAY * Complex64::cis(shift);
                motion[3] = -120.0 * PLAY * b * Complex64::cis(3.0 * shift + phase);
                let gap = relative_gap(&force(&motion, 1 << 13), &force(&motion, 0));
                // The sampled force is exact to about 1e-5 here, a missed pair costs 1e-3.
                assert!(gap < 3e-5, "excess {excess}, phase {phase}, shift {shift}: {gap:.1e}");
            }
        }
    }
}

#[test]
fn a_motion_near_the_end_of_the_number_range_ends_too() {
    // The search for turning points must end, with any answer.
    for size in [1e290, 1e305, 1e308] {
        let mut motion = vec![Complex64::new(size, -size); 10];
        motion[0] = 0.0.into();
        assert_eq!(force(&motion, 0).len(), 10);
    }
}

#[test]
fn exact_events_agree_with_a_slider_marched_in_time() {
    for (highest, size) in [(1, 3.0), (5, 8.0), (9, 4.0)] {
        for seed in 0..3 {
            let motion = rich_motion(highest, size, seed);
            let exact = force(&motion, 0);
            let (marched, lost) = marched(&motion, 1 << 16);
            let gap = relative_gap(&marched, &exact);
            assert!(gap < 1e-6, "H = {highest}, size {size}: {gap:.1e}");
            // All work that the force does is lost in the slider, none is stored over a period.
            let work = work(&motion, &exact);
            assert!((work - lost).abs() < 1e-6 * lost, "work {work}, lost {lost}");
            assert!(lost > 0.0);
        }
    }
}

#[test]
fn sampling_near_nyquist_is_not_what_exact_events_do() {
    // Coefficients listed as a₀, a₁, b₁, …: X = a − ib.
    let case = data("sampling_near_nyquist.json");
    let listed: Vec<f64> = case["reference"]["F_exact"]
        .as_array()
        .unwrap()
        .iter()
        .map(number)
        .collect();
    let expected: Vec<Complex64> = (0..=7)
        .map(|h| match h {
            0 => listed[0].into(),
            h => Complex64::new(listed[2 * h - 1], -listed[2 * h]),
        })
        .collect();
    let mut motion = vec![Complex64::ZERO; 8];
    motion[1] = 1.0.into();
    motion[3] = Complex64::new(0.3, 0.2);
    motion[7] = 0.05.into();
    let contact = Contact::jenkins(0, None, 1.0, 1.0, 0.3);
    let evaluate = |samples: usize| {
        let mut f = vec![Complex64::ZERO; 8];
        contact_evaluate(&contact, 7, samples, 1.0, &motion, &mut f, None).unwrap();
        f
    };
    let gap = relative_gap(&evaluate(0), &expected);
    println!("exact events: {gap:.1e}");
    assert!(gap < 1e-10);
    for samples in [16, 32, 128, 1024] {
        let stored = number(&case["reference"][format!("relerr_N{samples}")]);
        let aliased = relative_gap(&evaluate(samples), &expected);
        println!("{samples} samples: {aliased:.1e}, stored {stored:.1e}");
        assert!(aliased < 3.0 * stored);
    }
}

#[test]
fn a_constant_motion_drags_the_virgin_slider_to_its_limit_and_no_further() {
    for (x, expected) in [(0.4, 0.4), (-0.7, -0.7), (1.0, 1.0), (3.0, 1.0), (-50.0, -1.0)] {
        let motion = [(x * PLAY).into(), Complex64::ZERO];
        let f = force(&motion, 0);
        assert!((f[0].re - expected * LIMIT).abs() < 1e-14 * LIMIT, "{x}");
        assert!(f[1].norm() < 1e-14 * LIMIT);
    }
}

#[test]
fn an_oscillation_that_sticks_about_a_large_mean_touches_the_limit_once() {
    let a = 0.3;
    for sign in [1.0, -1.0] {
        let motion = [(sign * 5.0 * PLAY).into(), Complex64::from_polar(a * PLAY, 0.7)];
        for samples in [0, 1 << 14] {
            let f = force(&motion, samples);
            // The spring's force, shifted so that its extreme is the limit.
            assert!((f[1] - KT * motion[1]).norm() < 1e-9 * LIMIT);
            assert!((f[0].re - sign * LIMIT * (1.0 - a)).abs() < 1e-7 * LIMIT);
        }
    }
}

#[test]
fn a_slider_that_slips_both_ways_forgets_the_mean() {
    let swing = Complex64::from_polar(2.5 * PLAY, 0.2);
    let centred = force(&[Complex64::ZERO, swing], 0);
    for mean in [0.3, -7.0, 1e3] {
        let f = force(&[(mean * PLAY).into(), swing], 0);
        assert!((f[1] - centred[1]).norm() < 1e-12 * mean.abs().max(1.0) * largest(&centred));
        assert!(f[0].norm() < 1e-12 * mean.abs().max(1.0) * LIMIT);
    }
}
