//! Harmonics from a tolerance: the true error of every point against it, and what the branch tells of itself.

use crate::common::depth::{some_of, thorough};
use crate::common::mode_cases as modes;
use crate::common::models::{self, free_end};
use crate::common::{
    self, B2, BASE, Blisk, all_harmonics, amplitude_range, at_dof, data, harmonics, omega_range, one_mass,
    relative_gap, slip, solve_at, sweep,
};
use hbvib::{
    Branch, Contact, ContactState, ForcedOptions, Hooks, ModeOptions, Model, SolverOptions, Status, SynthesisOptions,
    forced_response, synthesise,
};
use num_complex::Complex64;
use std::f64::consts::TAU;

fn within(tolerance: f64) -> SolverOptions {
    SolverOptions {
        tolerance,
        response_dof: Some(0),
        ..SolverOptions::default()
    }
}

/// The solution with many harmonics at a stored point, which it starts from.
fn truth_of(model: &Model, branch: &Branch, point: usize, highest: usize) -> Branch {
    let omega = branch.omega_at(point).unwrap();
    let mut guess = all_harmonics(branch, point);
    guess.resize((highest + 1) * model.ndof(), Complex64::ZERO);
    let range = ForcedOptions {
        guess: Some(&guess),
        ..omega_range(omega, omega)
    };
    let solver = at_dof(branch.response_dof(), harmonics(highest));
    forced_response(model, &solver, &range, &mut Hooks::default()).unwrap()
}

fn fundamental(branch: &Branch, point: usize) -> Complex64 {
    let i = branch.carried_at(point).unwrap().iter().position(|&h| h > 0).unwrap();
    branch.response_at(point).unwrap()[i]
}

/// True errors over the tolerance of the points of whole responses.
#[derive(Default)]
struct Account {
    ratios: Vec<f64>,
    /// Points whose estimate is above the tolerance or unknown.
    flagged: usize,
    /// Estimates that were made.
    estimates: f64,
    /// Stored points that are not linear.
    nonlinear: usize,
}

impl Account {
    /// Follows a response and compares up to `count` of its stored points with the truth.
    fn add(&mut self, model: &Model, range: (f64, f64), tolerance: f64, (count, truth): (usize, usize)) -> Branch {
        self.add_with(model, &within(tolerance), range, (count, truth))
    }

    fn add_with(
        &mut self,
        model: &Model,
        solver: &SolverOptions,
        (from, to): (f64, f64),
        (count, truth): (usize, usize),
    ) -> Branch {
        let tolerance = solver.tolerance;
        let branch = sweep(model, solver, from, to, &[0.5 * (from + to)]);
        assert_eq!(branch.omega().first(), Some(&from));
        assert_eq!(branch.omega().last(), Some(&to));
        let all: Vec<usize> = (0..branch.stored()).collect();
        // At a fold the solution at a fixed frequency is not isolated.
        let fold = |&k: &usize| branch.folds().iter().any(|f| f.point == k);
        let all: Vec<usize> = all.into_iter().filter(|k| !fold(k)).collect();
        let bad = |&k: &usize| branch.error_estimate_at(k).is_none_or(|e| e.is_nan() || e > tolerance);
        let flagged = all.iter().copied().filter(bad).count();
        assert_eq!(flagged > 0, branch.status() == Status::StoppedMaxHarmonics);
        self.flagged += flagged;
        let every = all.len().div_ceil(count).max(1);
        for k in all.iter().copied().filter(|k| !bad(k)).step_by(every) {
            let exact = fundamental(&truth_of(model, &branch, k, truth), 0);
            let error = (fundamental(&branch, k) - exact).norm() / exact.norm();
            self.ratios.push(error / tolerance);
        }
        self.estimates += branch.estimates() as f64;
        let nonlinear = |&k: &usize| branch.error_estimate_at(k).is_some_and(|e| e > 0.0);
        self.nonlinear += all.iter().copied().filter(nonlinear).count();
        branch
    }

    /// Nearly all below the tolerance, and none far above.
    fn check(&self, name: &str) {
        let above = self.ratios.iter().filter(|&&r| r > 1.0).count();
        let worst = self.ratios.iter().fold(0.0, |m: f64, r| m.max(*r));
        println!(
            "{name}: {} points, {above} above the tolerance, worst {worst:.2} times it, {} flagged, {:.2} estimates a point",
            self.ratios.len(),
            self.flagged,
            self.estimates / self.nonlinear as f64
        );
        assert!(100 * above <= self.ratios.len(), "{name}: {above} above");
        assert!(worst < 1.5, "{name}: {worst}");
    }
}

/// Fractional parts that are evenly spread in four dimensions.
fn spread(k: usize, dimension: i32) -> f64 {
    let root = 1.167_303_978_261_418_7_f64;
    (0.5 + (k + 1) as f64 * root.powi(-dimension)).fract()
}

/// The k-th blisk and a range round its free and stuck resonance.
fn blisk(k: usize) -> (Model, (f64, f64)) {
    let between = |(low, high): (f64, f64), dimension| low + (high - low) * spread(k, dimension);
    let blisk = Blisk {
        ring_mass: Some(between((0.01, 0.06), 1)),
        rpm: between((1000.0, 6000.0), 2),
        engine_order: 1 + (4.0 * spread(k, 3)) as i64,
        force: 50f64.powf(spread(k, 4)),
        ..BASE
    };
    let model = blisk.sector();
    let of = |state| model.linear_modes(blisk.engine_order, state).unwrap().omega[0];
    let (free, stuck) = (of(ContactState::Free), of(ContactState::Stuck));
    (model, (free - 0.3 * (stuck - free), stuck + 0.3 * (stuck - free)))
}

const TOLERANCES: [f64; 4] = [1e-2, 1e-3, 1e-4, 1e-6];

fn check_blisks(cases: core::ops::Range<usize>, points: usize) {
    for tolerance in TOLERANCES {
        let mut account = Account::default();
        for k in cases.clone() {
            let (model, range) = blisk(k);
            account.add(&model, range, tolerance, (points, 511));
        }
        account.check(&format!("blisk, {tolerance:.0e}"));
        assert_eq!(account.flagged, 0);
    }
}

#[test]
fn every_point_of_the_blisk_is_within_the_tolerance() {
    check_blisks(0..3, 12);
}

#[test]
#[ignore = "minutes"]
fn every_point_of_many_blisks_is_within_the_tolerance() {
    check_blisks(0..40, 40);
}

#[test]
fn every_point_of_small_systems_is_within_the_tolerance() {
    for (name, contact, force, range) in [
        ("Duffing", Contact::cubic(0, None, 0.0, 0.1), 0.18, (0.2, 1.6)),
        ("gap", Contact::unilateral(Some(0), None, 5.0, 0.2), 0.1, (0.6, 1.9)),
        ("Jenkins", Contact::jenkins(0, None, 1.0, 0.5, 0.6), 0.4, (0.3, 1.6)),
        (
            "stiff Jenkins",
            Contact::jenkins(0, None, 1e3, 0.5, 0.6),
            0.5,
            (0.4, 1.6),
        ),
    ] {
        let model = one_mass(0.05, &contact, force);
        // The second and the last one, or all.
        for tolerance in TOLERANCES.into_iter().skip(some_of(1, 0)).step_by(some_of(2, 1)) {
            let mut account = Account::default();
            let branch = account.add(&model, range, tolerance, (25, 511));
            let used = branch.harmonics_used();
            let (least, most) = used.iter().fold((f64::MAX, 0.0_f64), |(a, b), &h| (a.min(h), b.max(h)));
            account.check(&format!("{name}, {tolerance:.0e}, H = {least} to {most}"));
            assert_eq!(account.flagged, 0);
        }
    }
}

#[test]
fn a_tolerance_of_1e_6_finds_the_motion_in_time() {
    let point = data("point_F5_208p85.json");
    let model = BASE.sector();
    let branch = solve_at(&model, &within(1e-6), TAU * 208.85);
    let exact = common::complex(&point["td"]["X"]["1"][0]);
    let gap = (fundamental(&branch, 0) - exact).norm() / exact.norm();
    println!("{gap:.1e} with H = {}", branch.harmonics_used()[0]);
    assert_eq!(branch.status(), Status::Ok);
    assert!(gap < 1e-6, "{gap}");
}

#[test]
fn what_sticks_has_one_harmonic_and_no_error() {
    let (model, range) = blisk(0);
    let branch = sweep(&model, &within(1e-4), range.0, range.1, &[]);
    let mut stuck = 0;
    for k in 0..branch.stored() {
        if slip(&branch, k) == 0.0 {
            assert_eq!(branch.error_estimate_at(k), Some(0.0));
            assert_eq!(branch.carried_at(k), Some(&[1][..]));
            stuck += 1;
        }
    }
    assert!(stuck > 5 && stuck < branch.points());
    let linear = BASE.sector_without_contact();
    let branch = sweep(&linear, &within(1e-4), range.0, range.1, &[]);
    assert!(branch.error_estimate().iter().all(|&e| e == 0.0));
    assert_eq!(branch.harmonics_used(), vec![1.0; branch.points()]);
}

/// All that is told of a point with its own harmonics is what the same number of harmonics gives.
#[test]
fn each_point_is_the_solution_with_its_own_harmonics() {
    let (model, range) = blisk(0);
    let branch = sweep(&model, &within(1e-3), range.0, range.1, &[]);
    let used = branch.harmonics_used();
    assert!(used.contains(&1.0) && used.iter().any(|&h| h > 9.0));
    assert_eq!(branch.harmonics(), used.iter().fold(0, |m, &h| m.max(h as usize)));
    assert_eq!(branch.reduction().harmonics_asked, branch.harmonics());
    for k in (0..branch.stored()).step_by(7) {
        let highest = *branch.carried_at(k).unwrap().last().unwrap();
        let same = truth_of(&model, &branch, k, highest);
        let (x, mut y) = (all_harmonics(&branch, k), all_harmonics(&same, 0));
        y.resize(x.len(), Complex64::ZERO);
        assert!(relative_gap(&x, &y) < 1e-8, "point {k}: {}", relative_gap(&x, &y));
        let (a, b) = (branch.energy_at(k).unwrap(), same.energy_at(0).unwrap());
        let gap = |a: f64, b: f64| (a - b).abs() / b.abs();
        assert!(gap(a.kinetic_mean, b.kinetic_mean) < 1e-7 && gap(a.kinetic_peak, b.kinetic_peak) < 1e-7);
        let (a, b) = (
            branch.contact_summary(k, 0).unwrap(),
            same.contact_summary(0, 0).unwrap(),
        );
        assert!(gap(a.half_range[0], b.half_range[0]) < 1e-7);
        assert!((a.work - b.work).abs() <= 1e-6 * b.work.abs());
        let loops = branch.contact_loop(k, 0, 64).unwrap();
        let other = same.contact_loop(0, 0, 64).unwrap();
        let size = loops.motion.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        assert!(
            loops
                .motion
                .iter()
                .zip(&other.motion)
                .all(|(a, b)| (a - b).abs() < 1e-7 * size)
        );
        assert!((slip(&branch, k) - slip(&same, 0)).abs() < 1e-6);
    }
}

/// Peaks, folds and wanted frequencies are those of a branch with many harmonics everywhere.
#[test]
fn peaks_and_wanted_frequencies_are_those_of_many_harmonics() {
    let (model, range) = blisk(2);
    let tolerance = 1e-4;
    let at: Vec<f64> = (1..8)
        .map(|i| range.0 + (range.1 - range.0) * f64::from(i) / 8.0)
        .collect();
    let branch = sweep(&model, &within(tolerance), range.0, range.1, &at);
    let truth = sweep(&model, &harmonics(255), range.0, range.1, &at);
    assert_eq!(branch.peaks().len(), truth.peaks().len());
    assert_eq!(branch.folds().len(), truth.folds().len());
    for (found, wanted) in branch.peaks().iter().zip(truth.peaks()) {
        assert!((found.amplitude / wanted.amplitude - 1.0).abs() < tolerance);
    }
    for i in 0..at.len() {
        assert_eq!(branch.at(i).len(), truth.at(i).len());
        for (found, wanted) in branch.at(i).iter().zip(truth.at(i)) {
            let (x, y) = (fundamental(&branch, found.point), fundamental(&truth, wanted.point));
            assert!(
                (x - y).norm() < tolerance * y.norm(),
                "{} at {}",
                (x - y).norm() / y.norm(),
                found.omega
            );
        }
    }
}

/// However the harmonics change between two points, what lies between them is found, and found once.
#[test]
fn every_wanted_frequency_is_found_once_where_the_harmonics_change() {
    let (model, range) = blisk(1);
    for tolerance in [1e-2, 1e-4] {
        let curve = sweep(&model, &within(tolerance), range.0, range.1, &[]);
        assert_eq!(curve.folds().len(), 0);
        let beside = |w: &f64| [w * (1.0 - 1e-7), w * (1.0 + 1e-7)];
        let at: Vec<f64> = curve.omega()[1..curve.points() - 1].iter().flat_map(beside).collect();
        let branch = sweep(&model, &within(tolerance), range.0, range.1, &at);
        for (i, wanted) in at.iter().enumerate() {
            assert_eq!(branch.at(i).len(), 1, "{tolerance:.0e}, {wanted}");
        }
    }
}

/// Harmonics change on the way, and the branch neither turns round nor walks back and forth.
#[test]
fn branches_are_followed_to_their_ends_in_both_directions() {
    for (name, contact) in [
        ("Jenkins", Contact::jenkins(0, None, 1.0, 0.5, 0.6)),
        ("stiff Jenkins", Contact::jenkins(0, None, 1e3, 0.5, 0.6)),
        ("gap", Contact::unilateral(Some(0), None, 5.0, 0.2)),
    ] {
        for (number, damping) in [0.03, 0.1].into_iter().enumerate() {
            let mut model = one_mass(damping, &contact, 0.3);
            model.add_force(0, 2, 0.3.into()).unwrap();
            // Upwards with little damping, downwards with much; all four where that is asked for.
            let both = [(0.4, 1.8), (1.8, 0.4)].into_iter().enumerate();
            for (_, (from, to)) in both.filter(|(direction, _)| thorough() || *direction == number) {
                for tolerance in [1e-2, 1e-3] {
                    let branch = sweep(&model, &within(tolerance), from, to, &[]);
                    let case = format!("{name}, damping {damping}, {from} to {to}, {tolerance:.0e}");
                    assert_eq!(branch.status(), Status::Ok, "{case}");
                    let omega = branch.omega();
                    let turns = omega.windows(3).filter(|w| (w[1] - w[0]) * (w[2] - w[1]) < 0.0).count();
                    assert!(turns <= branch.folds().len(), "{case}: {turns} turns");
                }
            }
        }
    }
}

/// At a fold no number of harmonics makes the solution at its frequency sure: none is asked for.
#[test]
fn folds_do_not_ask_for_harmonics() {
    for (name, contact, force, range) in [
        ("Duffing", Contact::cubic(0, None, 0.0, 0.1), 0.18, (0.5, 1.6)),
        ("gap", Contact::unilateral(Some(0), None, 5.0, 0.2), 0.1, (0.6, 1.9)),
    ] {
        let model = one_mass(0.05, &contact, force);
        for tolerance in TOLERANCES {
            for harmonics in [1, 3, 9] {
                let solver = SolverOptions {
                    harmonics,
                    ..within(tolerance)
                };
                let branch = sweep(&model, &solver, range.0, range.1, &[]);
                assert_eq!(branch.status(), Status::Ok, "{name}, {tolerance:.0e}");
                assert_eq!(branch.folds().len(), 2, "{name}, {tolerance:.0e}");
                let used = branch.harmonics_used().iter().fold(0.0_f64, |m, &h| m.max(h));
                for fold in branch.folds() {
                    let highest = *branch.carried_at(fold.point).unwrap().last().unwrap();
                    assert!(highest as f64 <= used, "{name}, {tolerance:.0e}: {highest} of {used}");
                    assert!(branch.error_estimate_at(fold.point).unwrap().is_nan());
                }
            }
        }
    }
}

#[test]
fn harmonics_that_do_not_suffice_are_told_and_every_point_is_kept() {
    let (model, range) = blisk(1);
    let solver = SolverOptions {
        max_harmonics: 15,
        ..within(1e-4)
    };
    let branch = sweep(&model, &solver, range.0, range.1, &[]);
    assert_eq!(branch.status(), Status::StoppedMaxHarmonics);
    assert_eq!(branch.omega().last(), Some(&range.1));
    assert_eq!(branch.harmonics(), 15);
    let missed = branch.error_estimate().iter().filter(|&&e| e > 1e-4).count();
    assert!(missed > 10);
    assert!(branch.residual().iter().all(|&r| r < 1e-9));
}

#[test]
fn max_harmonics_below_the_forcing_is_refused() {
    let mut model = BASE.sector();
    model.add_force(B2, 7, Complex64::ONE).unwrap();
    let solver = SolverOptions {
        max_harmonics: 5,
        ..within(1e-3)
    };
    let range = omega_range(1300.0, 1310.0);
    let e = forced_response(&model, &solver, &range, &mut Hooks::default()).unwrap_err();
    assert_eq!(e.status, Status::Argument);
    let text = e.to_string();
    assert!(
        text.contains("harmonic 7") && text.contains("max_harmonics = 5"),
        "{text}"
    );
}

/// A first guess has as many harmonics as the options name.
#[test]
fn a_guess_starts_a_response_with_a_tolerance() {
    let model = BASE.sector();
    let first = solve_at(&model, &within(1e-3), 1312.0);
    let guess = all_harmonics(&first, 0);
    let range = ForcedOptions {
        guess: Some(&guess),
        ..omega_range(1312.0, 1312.0)
    };
    let solver = SolverOptions {
        harmonics: first.harmonics(),
        ..within(1e-3)
    };
    let again = forced_response(&model, &solver, &range, &mut Hooks::default()).unwrap();
    let gap = (fundamental(&again, 0) - fundamental(&first, 0)).norm();
    assert!(gap < 1e-3 * fundamental(&first, 0).norm());
    assert!(again.newton_iterations()[0] <= 3.0);
}

/// A chain of 40 masses with ten friction contacts to the ground, near its first resonance.
fn chain() -> (Model, (f64, f64)) {
    let n = 40;
    let model = models::chain(&vec![1.0; n], &free_end(n, 1.0))
        .rayleigh(0.0, 0.05)
        .contacts((0..10).map(|i| Contact::jenkins(4 * i + 3, None, 0.05, 0.5, 0.4)))
        .force(n - 1, 1, 0.2)
        .build();
    let first = model.linear_modes(0, ContactState::Stuck).unwrap().omega[0];
    (model, (0.8 * first, 1.1 * first))
}

#[test]
fn every_point_with_ten_contacts_is_within_the_tolerance() {
    let (model, range) = chain();
    for tolerance in [1e-2, 1e-3] {
        let mut account = Account::default();
        let solver = at_dof(39, within(tolerance));
        let branch = account.add_with(&model, &solver, range, (8, 63));
        account.check(&format!(
            "ten contacts, {tolerance:.0e}, H up to {}",
            branch.harmonics()
        ));
        assert_eq!(account.flagged, 0);
    }
}

/// Frequency and damping ratio of a mode: errors against many harmonics, the latter over the largest.
#[test]
fn nonlinear_modes_are_within_the_tolerance() {
    let model = BASE.sector();
    let onset = modes::follow(
        &model,
        &harmonics(1),
        &ModeOptions {
            log10_start: -7.0,
            log10_stop: -6.0,
            ..ModeOptions::default()
        },
    );
    let onset = onset.mode().unwrap().linear_up_to;
    let at: Vec<f64> = (0..12).map(|i| onset + 0.05 + 0.17 * f64::from(i)).collect();
    let range = ModeOptions {
        at: &at,
        ..amplitude_range(onset - 0.5, onset + 2.1)
    };
    let truth = modes::follow(&model, &harmonics(255), &range);
    let largest = modes::damping(&truth).iter().fold(0.0_f64, |m, d| m.max(*d));
    for tolerance in [1e-2, 1e-3, 1e-4] {
        let branch = modes::follow(&model, &within(tolerance), &range);
        let mut worst = (0.0_f64, 0.0_f64);
        for i in 0..at.len() {
            let (a, b) = (modes::only(&branch, i), modes::only(&truth, i));
            worst.0 = worst.0.max((a.0 - b.0).abs() / b.0);
            worst.1 = worst.1.max((a.1 - b.1).abs() / largest);
        }
        let used = branch.harmonics_used();
        let most = used.iter().fold(0.0_f64, |m, &h| m.max(h));
        println!(
            "{tolerance:.0e}: frequency {:.1e}, damping {:.1e}, H up to {most}, {} points",
            worst.0,
            worst.1,
            branch.points()
        );
        assert!(worst.0 < tolerance && worst.1 < tolerance);
        let slip = branch.slip_fraction();
        let stuck = slip.iter().zip(used).filter(|(s, _)| **s == 0.0);
        assert!(stuck.clone().count() > 3 && stuck.clone().all(|(_, &h)| h < 1.5));
        let errors = branch.error_estimate().iter().zip(branch.damping_error_estimate());
        assert!(
            errors
                .clone()
                .all(|(f, d)| *f <= tolerance && *d <= tolerance * largest)
        );
    }
}

/// Responses synthesised from a mode whose points carry different harmonics.
#[test]
fn a_mode_with_a_tolerance_gives_the_resonances_of_the_response() {
    let model = BASE.sector();
    let range = amplitude_range(-6.5, -2.0);
    let peak = |solver: &SolverOptions| {
        let branch = modes::follow(&model, solver, &range);
        let made = synthesise(&branch, &model, &SynthesisOptions::default()).unwrap();
        assert_eq!(made.peaks.len(), 1);
        (made.peaks[0].at.omega, made.peaks[0].at.response.norm())
    };
    let (found, wanted) = (peak(&within(1e-4)), peak(&harmonics(127)));
    assert!((found.0 / wanted.0 - 1.0).abs() < 1e-5);
    assert!((found.1 / wanted.1 - 1.0).abs() < 1e-3, "{} {}", found.1, wanted.1);
}
