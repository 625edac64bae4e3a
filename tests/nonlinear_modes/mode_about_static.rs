//! Nonlinear modes about the static state of pressed contacts against forced responses: an undamped structure under
//! its constant forces and the force that does the work of the artificial damping answers with the mode itself.

use crate::common::mode_cases::{N, Skewed, damping, follow, harmonic, only};
use crate::common::models::{dense, oscillator};
use crate::common::refusal::refused;
use crate::common::{self, Wheel, all_harmonics, amplitude_range, harmonics, omega_range, phase, relative_gap};
use hbvib::internals::linear_modes;
use hbvib::{
    Branch, Constant, Contact, ForcedOptions, Hooks, Interrupt, LinearContacts, MatrixKind, MatrixView, ModeChoice,
    ModeGuess, ModeOptions, Model, SolverOptions, Speed, Status, forced_response, nonlinear_mode,
};
use nalgebra::{DMatrix, DVector};
use num_complex::Complex64;

/// Forces per harmonic.
pub type Forces = Vec<(usize, DVector<Complex64>)>;

/// F_h = 2Dω·(ihω) M X_h at a point of the mode.
pub fn balancing(branch: &Branch, point: usize, mass: impl Fn(usize) -> DMatrix<Complex64>) -> Forces {
    let (omega, d) = (branch.omega()[point], damping(branch)[point]);
    let force = |&h: &usize| {
        let x = harmonic(branch, point, h);
        (h, mass(h) * x * (Complex64::I * (2.0 * d * h as f64 * omega * omega)))
    };
    let carried = branch.carried_at(point).unwrap().iter();
    carried.filter(|h| **h > 0).map(force).collect()
}

/// The answer of a model, which has its constant forces, to more forces at one frequency, from a guess.
pub fn answer(
    model: &Model,
    solver: &SolverOptions,
    omega: f64,
    forces: &Forces,
    guess: &[Complex64],
) -> Vec<Complex64> {
    let mut model = model.try_clone().unwrap();
    for (h, force) in forces {
        for (dof, f) in force.iter().enumerate() {
            model.add_force(dof, *h, *f).unwrap();
        }
    }
    let range = ForcedOptions {
        guess: Some(guess),
        ..omega_range(omega, omega)
    };
    let answer = forced_response(&model, solver, &range, &mut Hooks::default()).unwrap();
    assert_eq!(answer.status(), Status::Ok);
    all_harmonics(&answer, 0)
}

/// Three masses, of which the first touches the ground along t1 and n or along t1, t2 and n.
pub fn pressed(contacts: &[Contact], constant: [f64; 3]) -> Model {
    const STIFFNESS: [f64; 9] = [2.0, -0.4, 0.3, -0.4, 3.0, -0.5, 0.3, -0.5, 2.5];
    const MASS: [f64; 9] = [1.0, 0.0, 0.0, 0.0, 1.4, 0.0, 0.0, 0.0, 0.8];
    dense(&MASS, &STIFFNESS)
        .contacts(contacts)
        .forces(constant.into_iter().enumerate().map(|(dof, f)| (dof, 0, f)))
        .build()
}

pub fn mass_of_three(_: usize) -> DMatrix<Complex64> {
    DMatrix::from_diagonal(&DVector::from_column_slice(&[1.0, 1.4, 0.8].map(Complex64::from)))
}

/// Largest gap, in the vibration alone and in all harmonics, over the points that slip or lift off.
fn worst(model: &Model, solver: &SolverOptions, branch: &Branch) -> (f64, usize) {
    let (mut worst, mut compared) = (0.0_f64, 0);
    let linear_up_to = branch.mode().unwrap().linear_up_to;
    for point in (0..branch.points()).step_by(4) {
        let p = branch.mode_at(point).unwrap().log10_amplitude;
        // Without damping the resonance of the linear mode is unbounded.
        if p <= linear_up_to + 0.05 || common::slip(branch, point) <= 0.01 {
            continue;
        }
        let guess = all_harmonics(branch, point);
        let forces = balancing(branch, point, mass_of_three);
        let found = answer(model, solver, branch.omega()[point], &forces, &guess);
        worst = worst.max(relative_gap(&found, &guess));
        worst = worst.max(relative_gap(&found[3..], &guess[3..]));
        compared += 1;
    }
    (worst, compared)
}

#[test]
fn a_pressed_structure_under_its_balancing_force_answers_with_the_mode() {
    let (t, n) = (Some(0), Some(1));
    let in_line = |mu, preload| Contact::friction_2d([t, n], [None; 2], (1.0, 0.8), mu, preload);
    let in_plane = |preload| Contact::friction_3d([t, Some(2), n], [None; 3], (1.0, 0.8), 0.4, preload);
    let stop = Contact::unilateral(Some(2), None, 1.5, -0.2);
    let cubic = Contact::cubic(2, None, 0.2, 0.3);
    let cases: [(&str, Vec<Contact>, [f64; 3], usize); 7] = [
        ("friction in line", vec![in_line(0.3, 1.0)], [0.0; 3], 0),
        ("constant forces", vec![in_line(0.3, 1.0)], [0.1, -0.3, 0.2], 1),
        (
            "pressed by a force over a gap",
            vec![in_line(0.3, 0.0).with(Constant::Gap, 0.2).unwrap()],
            [0.1, -2.0, 0.0],
            0,
        ),
        ("statically slipping", vec![in_line(0.3, 0.5)], [2.0, 0.0, 0.0], 0),
        ("friction in a plane", vec![in_plane(0.8)], [0.2, 0.0, -0.1], 0),
        ("with a stop", vec![in_line(0.4, 1.0), stop], [0.0, 0.0, 0.1], 2),
        (
            "with a cubic spring",
            vec![Contact::jenkins(0, None, 1.0, 0.3, 1.0), cubic],
            [0.1, 0.0, 0.4],
            0,
        ),
    ];
    for (name, contacts, constant, index) in cases {
        let model = pressed(&contacts, constant);
        for h in [1, 3, 8] {
            let range = ModeOptions {
                choice: ModeChoice::Index(index),
                ..amplitude_range(-2.0, 0.8)
            };
            let branch = follow(&model, &harmonics(h), &range);
            let (gap, compared) = worst(&model, &harmonics(h), &branch);
            println!("{name}, H = {h}: {gap:.1e} at {compared} points");
            assert!(
                gap < 1e-9 && compared >= 4,
                "{name}, H = {h}: {gap:e}, {compared} points"
            );
        }
    }
}

#[test]
fn a_small_vibration_about_a_large_static_motion_is_linear_and_has_a_known_error() {
    // The static forces are 10^4 to 10^6 times those of the vibration, and so is their rounding.
    for (n, preload) in [(20, 1.0), (60, 10.0), (60, 100.0), (130, 1.0)] {
        let (mut k, mut m) = (vec![0.0; n * n], vec![0.0; n * n]);
        for i in 0..n {
            k[i * (n + 1)] = if i + 1 < n { 2.02 } else { 1.02 };
            m[i * (n + 1)] = 1.0;
            if i > 0 {
                k[i * n + i - 1] = -1.0;
                k[(i - 1) * n + i] = -1.0;
            }
        }
        let at = [Some(n / 2), Some(n / 2 + 1)];
        let model = dense(&m, &k)
            .rayleigh(0.003, 0.002)
            .contact(Contact::friction_2d(at, [None; 2], (0.3, 0.3), 0.3, preload))
            .build();
        let range = amplitude_range(-3.0, -1.0);
        let mode = nonlinear_mode(&model, &SolverOptions::default(), &range, &mut Hooks::default()).unwrap();
        assert_eq!(mode.status(), Status::Ok, "{n}, {preload}");
        let linear = mode.omega()[0];
        for point in 0..mode.points() {
            let error = mode.error_estimate()[point];
            assert!(error <= 1e-9, "{n}, {preload}, point {point}: {error:e}");
            assert!(
                (mode.omega()[point] / linear - 1.0).abs() < 1e-9,
                "{n}, {preload}, {point}"
            );
        }
        let last = mode.harmonics_used()[mode.points() - 1];
        assert!(last <= 3.0, "{n}, {preload}: {last} harmonics");
    }
}

/// A sector without mirror symmetry, pressed to the ground and to the next sector.
pub fn pressed_sector(engine_order: i64) -> Skewed {
    let mut skewed = Skewed::new(engine_order);
    skewed.sectors = 5;
    let mut across = Contact::friction_2d([Some(2), Some(1)], [Some(0), Some(1)], (1.5, 1.0), 0.4, 0.6);
    across.sector_offset = 1;
    skewed.contacts = vec![
        across,
        Contact::friction_2d([Some(0), Some(2)], [None; 2], (1.0, 1.2), 0.3, 0.9),
    ];
    skewed
}

#[test]
fn a_pressed_sector_vibrates_as_the_wheel_does_about_the_mean_of_diameter_0() {
    for engine_order in [1, 2, -2, 5] {
        let skewed = pressed_sector(engine_order);
        let mut model = skewed.model(false);
        model.add_force(0, 0, 0.3.into()).unwrap();
        model.add_force(2, 0, (-0.2).into()).unwrap();
        let range = amplitude_range(-1.5, 1.0);
        let solver = harmonics(5);
        let branch = follow(&model, &solver, &range);
        let wheel = wheel_of(&skewed, 5);
        let spread = |x: &[Complex64]| -> Vec<Complex64> {
            let mut all = Vec::new();
            for (h, block) in x.chunks_exact(N).enumerate() {
                for s in 0..5 {
                    all.extend(block.iter().map(|z| z * phase(h, engine_order, s, 5)));
                }
            }
            all
        };
        let (mut gap, mut compared) = (0.0_f64, 0);
        for point in (0..branch.points()).step_by(6) {
            if common::slip(&branch, point) <= 0.02 {
                continue;
            }
            let guess = spread(&all_harmonics(&branch, point));
            let forces = balancing(&branch, point, |h| skewed.matrices(h).mass);
            let all: Forces = forces
                .into_iter()
                .map(|(h, f)| {
                    let turned = (0..5).flat_map(|s| {
                        let turn = phase(h, engine_order, s, 5);
                        f.iter().map(move |z| z * turn).collect::<Vec<_>>()
                    });
                    (h, DVector::from_iterator(5 * N, turned))
                })
                .collect();
            let found = answer(&wheel.model, &solver, branch.omega()[point], &all, &guess);
            gap = gap.max(relative_gap(&found, &guess));
            compared += 1;
        }
        println!("EO {engine_order}: {gap:.1e} at {compared} points");
        assert!(
            gap < 1e-9 && compared >= 3,
            "EO {engine_order}: {gap:e}, {compared} points"
        );
    }
}

/// The wheel of a sector with the constant forces of the test.
fn wheel_of(skewed: &Skewed, sectors: usize) -> Wheel {
    let mut wheel = Wheel::new(N, sectors);
    Skewed::place_in(&mut wheel);
    for contact in &skewed.contacts {
        wheel.add_contact(contact);
    }
    wheel.add_force(0, 0, 0.3.into(), 0);
    wheel.add_force(2, 0, (-0.2).into(), 0);
    wheel
}

/// Two masses that gyroscopic forces couple, the first pressed to a stop.
fn whirling(speed: Speed) -> Model {
    dense(&[1.0, 0.0, 0.0, 1.3], &[2.0, 0.3, 0.3, 3.0])
        .set(MatrixKind::Gyroscopic, &[0.0, 0.6, -0.6, 0.0])
        .contact(
            Contact::unilateral(Some(0), None, 1.5, 0.0)
                .with(Constant::Preload, 0.4)
                .unwrap(),
        )
        .force(1, 0, 0.2)
        .speed(speed)
        .build()
}

#[test]
fn gyroscopic_forces_at_a_tied_speed_leave_the_static_state_alone() {
    const PER_OMEGA: f64 = 0.5;
    let at = [-1.5, -0.5, 0.0, 0.3];
    let mode = |model: &Model, at: &[f64]| {
        let range = ModeOptions {
            at,
            reference_dof: Some(0),
            ..amplitude_range(-2.0, 0.5)
        };
        follow(model, &harmonics(7), &range)
    };
    let tied = mode(&whirling(Speed::PerOmega(PER_OMEGA)), &at);
    let linear = |model: &Model| {
        let modes = linear_modes(model, 0, LinearContacts::Static, 1, &Interrupt::none());
        modes.unwrap().omega[0]
    };
    let lowest = linear(&whirling(Speed::PerOmega(PER_OMEGA)));
    assert!((linear(&whirling(Speed::Fixed(PER_OMEGA * lowest))) / lowest - 1.0).abs() < 1e-12);
    for (i, log10) in at.into_iter().enumerate() {
        let (omega, _, point) = only(&tied, i);
        let fixed = mode(&whirling(Speed::Fixed(PER_OMEGA * omega)), &[log10]);
        let (known, _, known_point) = only(&fixed, 0);
        assert!((omega / known - 1.0).abs() < 1e-9, "{omega} {known}");
        let gap = relative_gap(&all_harmonics(&tied, point), &all_harmonics(&fixed, known_point));
        assert!(gap < 1e-9, "{gap}");
    }
}

#[test]
fn a_static_state_that_changes_with_a_tied_speed_is_refused_by_the_analysis_that_needs_it() {
    let words = ["static state", "stiffness_speed2", "set a fixed speed"];
    let changed: [fn(&mut Model); 3] = [
        |model| {
            let softening = [-0.1, 0.0, 0.0, 0.0];
            let view = MatrixView::dense(2, &softening);
            model.set_matrix(MatrixKind::StiffnessSpeed2, &view).unwrap();
        },
        |model| model.set_preload_at_speed(0, 0.4, 0.1).unwrap(),
        |model| model.set_preload_at_speed(0, 0.0, 0.1).unwrap(),
    ];
    for change in changed {
        let mut model = whirling(Speed::PerOmega(0.5));
        change(&mut model);
        let range = amplitude_range(-2.0, 0.5);
        let mode = nonlinear_mode(&model, &harmonics(3), &range, &mut Hooks::default());
        refused(mode, Status::Unsupported, &[&words[..], &["a nonlinear mode"]].concat());
        let linear = linear_modes(&model, 0, LinearContacts::Static, 1, &Interrupt::none());
        refused(linear, Status::Unsupported, &[&words[..], &["linear modes"]].concat());
        model.set_speed(Speed::Fixed(0.5)).unwrap();
        linear_modes(&model, 0, LinearContacts::Static, 1, &Interrupt::none()).unwrap();
    }
}

#[test]
fn the_onset_of_slip_counts_from_the_load_that_the_contact_carries_at_rest() {
    // m = k = kt = 1: a constant force of 0.2 leaves 0.1 in the contact, whose limit is 0.3. It slips when the amplitude
    // exceeds (0.3 − 0.1)/kt = 0.2; then it sticks again about a lower load, until the range 2a kt exceeds 2 · 0.3.
    let model = oscillator(1.0, 1.0).slider(0, 1.0, 0.3, 1.0).force(0, 0, 0.2).build();
    let range = amplitude_range(-2.0, 0.5);
    let branch = follow(&model, &harmonics(5), &range);
    let mode = branch.mode().unwrap();
    let (linear_up_to, slip_from) = (mode.linear_up_to, mode.slip_from);
    // The linear stretch ends 1e-9 below the onset.
    assert!((linear_up_to - 0.2_f64.log10()).abs() < 1.1e-9, "{linear_up_to}");
    // The onset of slip is located to 1e-7.
    assert!((slip_from - 0.3_f64.log10()).abs() < 2e-7, "{slip_from}");
}

/// A mode about a static state goes on from a point of itself, given as a guess, to the same points.
#[test]
fn a_mode_about_a_static_state_starts_from_a_guess() {
    let stop = Contact::unilateral(Some(1), None, 2.0, 0.1);
    for (name, contact, h) in [
        ("slider", Contact::jenkins(0, None, 1.0, 0.3, 1.0), 5),
        ("stop", stop, 7),
    ] {
        let model = pressed(&[contact], [0.1, 0.2, 0.0]);
        let range = amplitude_range(-2.0, 0.8);
        let whole = follow(&model, &harmonics(h), &range);
        let from = whole.points() / 2;
        let motion = all_harmonics(&whole, from);
        let (log10_start, omega) = (whole.mode_at(from).unwrap().log10_amplitude, whole.omega()[from]);
        let range = ModeOptions {
            log10_start,
            guess: Some(ModeGuess {
                omega,
                motion: &motion,
                damping_ratio: damping(&whole)[from],
            }),
            ..range
        };
        let part = follow(&model, &harmonics(h), &range);
        assert!((part.omega()[0] / omega - 1.0).abs() < 1e-10, "{name}");
        let ends = [&whole, &part].map(|branch| branch.omega()[branch.points() - 1]);
        assert!((ends[1] / ends[0] - 1.0).abs() < 1e-8, "{name}: {ends:?}");
    }
}
