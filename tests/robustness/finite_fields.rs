//! Every stored number of a branch is finite, however the solve ends: without damping, with absurd units, with steps
//! that cannot be kept. Only error estimates may be NaN, where they are unknown.

use crate::common::models::{self, dense};
use crate::common::{amplitude_range, harmonics, omega_range};
use crate::random_problems::random::Random;
use hbvib::{
    Branch, Contact, ForcedOptions, Hooks, ModeField, ModeOptions, Model, Progress, SolverOptions, Status,
    forced_response, nonlinear_mode,
};
use num_complex::Complex64;

/// A chain of one to four masses with up to two contacts of any law, often undamped, in random units.
fn model(random: &mut Random) -> Model {
    let n = 1 + random.below(4);
    let (k, length) = (random.decade(-20.0, 20.0), random.decade(-20.0, 20.0));
    let force = k * length;
    let mut model = models::chain(&vec![k; n], &vec![k; n + 1]).build();
    if random.happens(0.5) {
        model.set_rayleigh(0.0, random.decade(-12.0, -1.0)).unwrap();
    }
    for _ in 0..random.below(3) {
        let a = random.below(n);
        let kt = k * random.decade(-3.0, 8.0);
        let contact = match random.below(4) {
            0 => Contact::jenkins(a, None, kt, 1.0, force * random.decade(-3.0, 2.0)),
            1 => Contact::unilateral(Some(a), None, kt, length * random.within(-0.5, 1.0)),
            2 => Contact::cubic(a, None, 0.0, kt / length / length * random.within(-1.0, 1.0)),
            _ => Contact::regularised(
                a,
                None,
                1.0,
                force * random.decade(-3.0, 1.0),
                length * random.decade(-3.0, 0.0),
            ),
        };
        model.add_contact(&contact).unwrap();
    }
    model
        .add_force(0, 1, (force * random.decade(-2.0, 2.0)).into())
        .unwrap();
    model
}

fn all_finite(name: &str, branch: &Branch) {
    let finite = |field: &str, values: &[f64]| {
        let bad = values.iter().position(|v| !v.is_finite());
        assert!(
            bad.is_none(),
            "{name}: {field} of point {bad:?} of {}: {:?}",
            values.len(),
            branch.status()
        );
    };
    finite("omega", branch.omega());
    finite("amplitude", branch.amplitude());
    finite("residual", branch.residual());
    finite("iterations", branch.newton_iterations());
    finite("harmonics", branch.harmonics_used());
    finite("slip", branch.slip_fraction());
    // Unknown errors are NaN, and infinite ones do not exist.
    for errors in [
        branch.error_estimate(),
        branch.damping_error_estimate(),
        branch.sampling_error(),
    ] {
        assert!(errors.iter().all(|e| !e.is_infinite()), "{name}: errors {errors:?}");
    }
    for field in [
        ModeField::DampingRatio,
        ModeField::Energy,
        ModeField::FrictionLoss,
        ModeField::Log10Amplitude,
        ModeField::ModalAmplitude,
        ModeField::StructuralLoss,
        ModeField::Assurance,
        ModeField::FundamentalShare,
    ] {
        finite("mode", branch.mode_field(field).unwrap_or(&[]));
    }
    if let Some(mode) = branch.mode() {
        finite("linear mode", &[mode.omega]);
        // Minus infinity where a law is never linear.
        assert!(
            !mode.linear_up_to.is_nan() && mode.linear_up_to < f64::INFINITY,
            "{name}"
        );
    }
    for special in branch.peaks().iter().chain(branch.folds()).chain(branch.at(0)) {
        finite("special point", &[special.omega, special.amplitude]);
    }
    let mut x = vec![Complex64::ZERO; (branch.harmonics() + 1) * branch.ndof()];
    for point in (0..branch.stored()).step_by(5) {
        branch.harmonics_at(point, &mut x).unwrap();
        assert!(x.iter().all(|z| z.is_finite()), "{name}: harmonics of point {point}");
        let response = branch.response_at(point).unwrap();
        assert!(
            response.iter().all(|z| z.is_finite()),
            "{name}: response of point {point}"
        );
        finite("slip of a point", branch.slip_fraction_at(point).unwrap());
        finite("frequency of a point", &[branch.omega_at(point).unwrap()]);
        let energy = format!("{:?}", branch.energy_at(point).unwrap());
        assert!(!energy.contains("inf") && !energy.contains("NaN"), "{name}: {energy}");
        finite("motion in time", &branch.time_history(point, 0, 8).unwrap());
        for contact in 0..branch.contacts() {
            let summary = branch.contact_summary(point, contact).unwrap();
            finite("work", &[summary.work, summary.slip_share, summary.open_share]);
            finite("ranges", &summary.half_range);
            finite("motions", &[summary.motion_min, summary.motion_max].concat());
            // The infinite preload of a contact that never slips is reported as it is.
            assert!(summary.load_min >= 0.0 && summary.load_max >= 0.0, "{name}");
        }
        for error in [branch.error_estimate_at(point), branch.damping_error_estimate_at(point)] {
            assert!(!error.unwrap().is_infinite(), "{name}: error of point {point}");
        }
    }
}

#[test]
fn every_stored_number_is_finite() {
    let (mut branches, mut points) = (0, 0);
    for case in 0..300 {
        let random = &mut Random::of(16, case);
        let model = model(random);
        let solver = SolverOptions {
            max_points: 150,
            step_max: [0.0, 1.0, 1e6][random.below(3)],
            step_min: [0.0, 1e-3][random.below(2)],
            max_newton: [20, 2, 200][random.below(3)],
            ..harmonics([1, 3, 7][random.below(3)])
        };
        let center = random.decade(-1.0, 0.7);
        let range = omega_range(center, center * random.decade(-1.0, 1.0));
        let mode = amplitude_range(random.within(-25.0, 0.0), random.within(0.0, 25.0));
        let hooks = &mut Hooks::default();
        let found = [
            forced_response(&model, &solver, &range, hooks),
            nonlinear_mode(&model, &solver, &mode, hooks),
        ];
        for branch in found.iter().flatten() {
            all_finite(&format!("case {case}"), branch);
            branches += 1;
            points += branch.points();
        }
    }
    println!("{branches} branches, {points} points");
    assert!(branches > 300);
}

/// Branches that end in every way: with a tolerance that is met or missed, stopped by the caller before and after the
/// first point, by the number of points, by the step, without a force, without a bound.
#[test]
fn every_kind_of_branch_is_finite_outside_of_unknown_errors() {
    let chain = |damping: f64, force: f64, contact: &Contact| {
        dense(&[1.0, 0.0, 0.0, 1.0], &[2.0, -1.0, -1.0, 2.0])
            .rayleigh(0.0, damping)
            .contact(contact)
            .force(0, 1, force)
            .build()
    };
    let friction = Contact::jenkins(1, None, 0.5, 1.0, 0.1);
    let stop = Contact::unilateral(Some(1), None, 0.5, 0.2);
    let plane = Contact::friction_3d([Some(0), Some(1), None], [None; 3], (0.5, 0.0), 1.0, 0.1);
    let far = Contact::jenkins(1, None, 0.5, 1.0, f64::INFINITY);
    let (plain, fixed) = (
        SolverOptions::default(),
        SolverOptions {
            tolerance: 0.0,
            ..SolverOptions::default()
        },
    );
    let few = SolverOptions {
        max_harmonics: 1,
        ..plain
    };
    let short = SolverOptions {
        max_points: 5,
        estimate_error: true,
        ..fixed
    };
    let none = Contact::jenkins(1, None, 0.5, 1.0, 0.0);
    let one = SolverOptions { harmonics: 1, ..fixed };
    let mut statuses = Vec::new();
    for (name, model, solver, stop_after) in [
        ("tolerance", chain(0.01, 0.1, &friction), plain, usize::MAX),
        ("few harmonics", chain(0.01, 0.1, &friction), few, usize::MAX),
        ("a stop behind a gap", chain(0.01, 0.1, &stop), plain, usize::MAX),
        ("friction in a plane", chain(0.01, 0.1, &plane), plain, usize::MAX),
        ("few points", chain(0.01, 0.1, &friction), short, usize::MAX),
        ("beyond the capacity", chain(0.0, 1.0, &friction), one, usize::MAX),
        ("no force", chain(0.01, 0.0, &friction), plain, usize::MAX),
        ("sticks for ever", chain(0.01, 0.1, &far), fixed, usize::MAX),
        ("no bound", chain(0.0, 0.1, &none), one, usize::MAX),
        ("stopped at a point", chain(0.01, 0.1, &friction), plain, 3),
        ("stopped at once", chain(0.01, 0.1, &friction), plain, 0),
    ] {
        let at = [0.97];
        let range = ForcedOptions {
            at: &at,
            ..omega_range(0.7, 2.0)
        };
        let cancelled = || stop_after == 0;
        let mut progress = |p: &Progress| p.point >= stop_after;
        let mut hooks = Hooks {
            progress: Some(&mut progress),
            cancelled: Some(&cancelled),
            ..Hooks::default()
        };
        let forced = forced_response(&model, &solver, &range, &mut hooks);
        let mode = ModeOptions {
            at: &[0.1],
            ..amplitude_range(-2.0, 1.0)
        };
        let mode = nonlinear_mode(&model, &solver, &mode, &mut hooks);
        for branch in [forced, mode].iter().flatten() {
            all_finite(name, branch);
            if branch.status() == Status::Ok && solver.tolerance > 0.0 {
                assert!(branch.error_estimate().iter().all(|e| e.is_finite()), "{name}");
            }
            if !statuses.contains(&branch.status()) {
                statuses.push(branch.status());
            }
        }
    }
    println!("{statuses:?}");
    assert!(statuses.len() >= 6);
}
