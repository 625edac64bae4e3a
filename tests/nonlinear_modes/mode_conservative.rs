//! Nonlinear modes of conservative systems: masses on cubic springs against elliptic integrals and
//! against time integration.

use crate::common::models::dense;
use crate::common::{amplitude_range, data, harmonics, number};
use hbvib::{Branch, Contact, Hooks, ModeChoice, ModeGuess, ModeOptions, Model, SolverOptions, Status, nonlinear_mode};
use num_complex::Complex64;

fn follow(model: &Model, solver: &SolverOptions, range: &ModeOptions) -> Branch {
    let branch = nonlinear_mode(model, solver, range, &mut Hooks::default()).unwrap();
    assert_eq!(branch.status(), Status::Ok);
    branch
}

fn all_harmonics(branch: &Branch, point: usize) -> Vec<Complex64> {
    let mut x = vec![Complex64::ZERO; (branch.harmonics() + 1) * branch.ndof()];
    branch.harmonics_at(point, &mut x).unwrap();
    x
}

/// x″ + x + x³ = 0 against the truth, which is known to 25 digits.
#[test]
fn the_duffing_backbone_converges_to_the_elliptic_integrals() {
    let reference = data("duffing.json");
    let points = reference["cases"][0]["points"].as_array().unwrap();
    let mut model = dense(&[1.0], &[1.0]).build();
    model.add_contact(&Contact::cubic(0, None, 0.0, 1.0)).unwrap();
    let at: Vec<f64> = points.iter().map(|p| number(&p["X_odd"]["1"]).log10()).collect();
    let mut errors = Vec::new();
    for h in [1, 3, 5, 7, 9, 15, 31] {
        let range = ModeOptions {
            at: &at,
            ..amplitude_range(-3.0, 1.5)
        };
        let branch = follow(&model, &harmonics(h), &range);
        let mut worst = 0.0_f64;
        for (i, p) in points.iter().enumerate() {
            let [found] = branch.at(i) else {
                panic!("{:?}", branch.at(i))
            };
            let mode = branch.mode_at(found.point).unwrap();
            assert!(mode.damping_ratio.abs() < 1e-13, "{}", mode.damping_ratio);
            let error = (found.omega / number(&p["omega"]) - 1.0).abs();
            worst = worst.max(error);
            let energy = branch.energy_at(found.point).unwrap();
            if h == 31 {
                let total = number(&p["energy"]);
                let x = all_harmonics(&branch, found.point);
                for (k, v) in p["X_odd"].as_object().unwrap() {
                    let k: usize = k.parse().unwrap();
                    assert!(
                        (x[k].re - number(v)).abs() < 1e-12 * number(&p["A"]),
                        "harmonic {k}: {} {}",
                        x[k],
                        v
                    );
                }
                assert!((energy.kinetic_peak / total - 1.0).abs() < 1e-12);
            }
        }
        println!("H {h}: {} points, worst {worst:e}", branch.points());
        errors.push(worst);
    }
    // Six decades of accuracy from H = 1 to 9, then rounding: the coefficients fall geometrically.
    for (error, bound) in errors.iter().zip([3e-2, 3e-4, 2e-6, 1e-8, 1e-10, 1e-13, 1e-13]) {
        assert!(*error < bound, "{errors:?}");
    }
    assert!(errors[0] > 1e-2, "one harmonic cannot be exact");
}

/// Two equal masses on equal springs, coupled: in phase and out of phase each moves like one Duffing
/// oscillator, whatever the amplitude.
#[test]
fn both_modes_of_a_symmetric_pair_are_duffing_oscillators() {
    let reference = data("duffing.json");
    let points = reference["cases"][0]["points"].as_array().unwrap();
    // In phase ω₀² = k and γ = c; out of phase ω₀² = k + 2κ and γ = c + 8·(coupling's γ): all are 1.
    for (index, k, coupling, c, c_coupling) in [(0, 1.0, 0.7, 1.0, 0.3), (1, 0.4, 0.3, 0.2, 0.1)] {
        let own = k + coupling;
        let mut model = dense(&[1.0, 0.0, 0.0, 1.0], &[own, -coupling, -coupling, own]).build();
        for dof in [0, 1] {
            model.add_contact(&Contact::cubic(dof, None, 0.0, c)).unwrap();
        }
        model.add_contact(&Contact::cubic(0, Some(1), 0.0, c_coupling)).unwrap();
        let at: Vec<f64> = points
            .iter()
            .map(|p| (number(&p["X_odd"]["1"]) * 2f64.sqrt()).log10())
            .collect();
        let range = ModeOptions {
            choice: ModeChoice::Index(index),
            at: &at,
            ..amplitude_range(-3.0, 1.5)
        };
        let branch = follow(&model, &harmonics(31), &range);
        for (i, p) in points.iter().enumerate() {
            let [found] = branch.at(i) else {
                panic!("{:?}", branch.at(i))
            };
            assert!((found.omega / number(&p["omega"]) - 1.0).abs() < 1e-13);
            let x = all_harmonics(&branch, found.point);
            let sign = if index == 0 { 1.0 } else { -1.0 };
            for (a, b) in x.iter().zip(&x[1..]).step_by(2) {
                assert!((a - sign * b).norm() < 1e-13 * number(&p["A"]));
            }
        }
    }
}

/// Largest gap after one period of the motion that starts like a stored point, relative to its
/// state, by Runge and Kutta's method: x₁″ + 2x₁ − x₂ + x₁³/2 = 0, x₂″ + 2x₂ − x₁ = 0.
fn gap_after_a_period(branch: &Branch, point: usize, omega: f64) -> f64 {
    let mut start = [0.0; 4];
    for (h, x) in all_harmonics(branch, point).chunks_exact(2).enumerate() {
        for dof in [0, 1] {
            start[dof] += x[dof].re;
            start[2 + dof] -= h as f64 * omega * x[dof].im;
        }
    }
    let rate = |s: [f64; 4]| [s[2], s[3], -2.0 * s[0] + s[1] - 0.5 * s[0].powi(3), s[0] - 2.0 * s[1]];
    let steps = 40_000;
    let dt = std::f64::consts::TAU / omega / f64::from(steps);
    let along = |s: [f64; 4], k: [f64; 4], f: f64| std::array::from_fn(|i| s[i] + f * k[i]);
    let mut s = start;
    let mut size = 0.0_f64;
    for _ in 0..steps {
        let k1 = rate(s);
        let k2 = rate(along(s, k1, 0.5 * dt));
        let k3 = rate(along(s, k2, 0.5 * dt));
        let k4 = rate(along(s, k3, dt));
        s = std::array::from_fn(|i| s[i] + dt / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]));
        size = size.max(s.iter().fold(0.0, |m, v| m.max(v.abs())));
    }
    s.iter().zip(start).fold(0.0_f64, |m, (a, b)| m.max((a - b).abs())) / size
}

/// The in-phase mode of this pair runs into a 3:1 resonance with the other one (Kerschen et al. 2009,
/// doi:10.1016/j.ymssp.2008.04.002): its amplitude turns, and along the tongue the third harmonic
/// takes over until the fundamental is gone.
#[test]
fn an_internal_resonance_is_followed_round_its_fold() {
    let mut model = dense(&[1.0, 0.0, 0.0, 1.0], &[2.0, -1.0, -1.0, 2.0]).build();
    model.add_contact(&Contact::cubic(0, None, 0.0, 0.5)).unwrap();
    let range = amplitude_range(-2.0, 3.0);
    let branch = nonlinear_mode(&model, &harmonics(63), &range, &mut Hooks::default()).unwrap();
    assert_eq!(branch.status(), Status::StoppedLeftRange);
    assert_eq!(branch.folds().len(), 1);
    let shares: Vec<f64> = (0..branch.points())
        .map(|k| branch.mode_at(k).unwrap().fundamental_share)
        .collect();
    assert!(shares[0] > 1.0 - 1e-6 && shares[shares.len() - 1] < 1e-4, "{shares:?}");
    // The orbit is that of the differential equation all along the way.
    for point in (0..branch.points()).step_by(5) {
        let gap = gap_after_a_period(&branch, point, branch.omega()[point]);
        assert!(gap < 1e-8, "point {point}: {gap:e}");
    }
}

/// The curve goes on above the tongue, at amplitudes that the curve from small ones never reaches. A guess leads there: the second
/// mass moves nearly alone at a = 100, and the first follows it by the balance of one harmonic, ¾·0.5 x³ + (2 − ω²) x = a.
#[test]
fn the_curve_above_the_tongue_is_reached_by_a_guess() {
    let mut model = dense(&[1.0, 0.0, 0.0, 1.0], &[2.0, -1.0, -1.0, 2.0]).build();
    model.add_contact(&Contact::cubic(0, None, 0.0, 0.5)).unwrap();
    let below = amplitude_range(-2.0, 3.0);
    let lower = nonlinear_mode(&model, &harmonics(15), &below, &mut Hooks::default()).unwrap();
    let amplitude = |branch: &Branch, point: usize| branch.mode_at(point).unwrap().log10_amplitude;
    let largest = (0..lower.points())
        .map(|p| amplitude(&lower, p))
        .fold(f64::NEG_INFINITY, f64::max);
    let mut motion = vec![Complex64::new(0.0, 0.0); 2 * 2];
    (motion[2], motion[3]) = (6.0.into(), 100.0.into());
    let above = ModeOptions {
        guess: Some(ModeGuess {
            omega: 1.39,
            motion: &motion,
            damping_ratio: 0.0,
        }),
        ..amplitude_range(2.0, 3.0)
    };
    let upper = nonlinear_mode(&model, &harmonics(63), &above, &mut Hooks::default()).unwrap();
    println!(
        "10^{largest:.3} below, 10^{:.3} above at {:.6}",
        amplitude(&upper, 0),
        upper.omega()[0]
    );
    assert!(largest < 1.9 && (amplitude(&upper, 0) - 2.0).abs() < 1e-9);
    // The begin of the curve, before it turns as well.
    for point in (0..28).step_by(4) {
        let gap = gap_after_a_period(&upper, point, upper.omega()[point]);
        assert!(gap < 1e-8, "point {point}: {gap:e}");
    }
}

/// The same curve without a guess: the tongue of the lower one ends where the fundamental vanishes, and from there the other phase leads
/// up. A broken symmetry of the lower curve, a 2:1 resonance, is found on the way.
#[test]
fn the_curve_above_the_tongue_is_reached_by_switching() {
    let mut model = dense(&[1.0, 0.0, 0.0, 1.0], &[2.0, -1.0, -1.0, 2.0]).build();
    model.add_contact(&Contact::cubic(0, None, 0.0, 0.5)).unwrap();
    let range = ModeOptions {
        at: &[2.0],
        branches: 1,
        branch_depth: 1,
        ..amplitude_range(0.0, 2.2)
    };
    let lower = nonlinear_mode(&model, &harmonics(31), &range, &mut Hooks::default()).unwrap();
    let order = |branch: &Branch| branch.descent().unwrap().internal_resonance;
    let upper = lower.children().iter().find(|child| order(child) == 3).unwrap();
    let mut motion = vec![Complex64::new(0.0, 0.0); 2 * 2];
    (motion[2], motion[3]) = (6.0.into(), 100.0.into());
    let guess = ModeGuess {
        omega: 1.39,
        motion: &motion,
        damping_ratio: 0.0,
    };
    let above = ModeOptions {
        log10_start: 2.0,
        guess: Some(guess),
        ..ModeOptions {
            branches: 0,
            branch_depth: 0,
            at: &[],
            ..range
        }
    };
    let guessed = nonlinear_mode(&model, &harmonics(31), &above, &mut Hooks::default()).unwrap();
    let found = upper.at(0);
    println!("{} {found:?} {}", lower.children().len(), guessed.omega()[0]);
    assert!(
        found
            .iter()
            .any(|point| (point.omega / guessed.omega()[0] - 1.0).abs() < 1e-9)
    );
    for child in lower.children() {
        for point in (0..child.points()).step_by(child.points() / 4) {
            let gap = gap_after_a_period(child, point, child.omega()[point]);
            assert!(gap < 1e-5, "point {point}: {gap:e}");
        }
    }
    // Symmetric motions of the lower curve have no even harmonics, those that branch off at its branch points have.
    let even = |branch: &Branch, point| all_harmonics(branch, point)[4].norm();
    let bifurcations = lower.bifurcations().unwrap();
    assert_eq!(bifurcations.len(), 2);
    let broken = lower.children().iter().find(|child| order(child) == 0).unwrap();
    assert!(even(broken, broken.points() / 2) > 1e-2);
    let searched = lower.searched().unwrap();
    assert_eq!((searched.bifurcations, searched.lost), (3, 0));
}

/// The other mode stiffens without bound, and is the truth at every amplitude as well.
#[test]
fn a_mode_that_is_no_similar_one_is_an_orbit_of_the_equations() {
    let mut model = dense(&[1.0, 0.0, 0.0, 1.0], &[2.0, -1.0, -1.0, 2.0]).build();
    model.add_contact(&Contact::cubic(0, None, 0.0, 0.5)).unwrap();
    let range = ModeOptions {
        choice: ModeChoice::Near(1.7),
        ..amplitude_range(-3.0, 2.0)
    };
    let mut last = f64::INFINITY;
    for h in [3, 9, 31] {
        let branch = follow(&model, &harmonics(h), &range);
        let worst = (0..branch.points()).step_by(4).fold(0.0_f64, |m, point| {
            m.max(gap_after_a_period(&branch, point, branch.omega()[point]))
        });
        assert!(worst < 0.1 * last, "H = {h}: {worst:e}");
        last = worst;
    }
    assert!(last < 1e-9, "{last:e}");
}
