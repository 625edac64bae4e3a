//! Near-rigid contacts that really slip, with a tolerance, against integration in time from event to event
//! (relative error below 1e-8; rigid Coulomb friction from a separate program, which 2e6 and 4e8 meet within 4e-5).

use crate::common::models::{Structure, dense, unit_chain};
use crate::common::{all_harmonics, amplitude_range, at_dof, harmonics, omega_range, sweep};
use hbvib::{
    Branch, Contact, ContactState, Hooks, MatrixKind, MatrixView, Model, SolverOptions, Status, VerifyOptions,
    forced_response, nonlinear_mode, verify,
};
use num_complex::Complex64;

const MASSES: usize = 8;

fn solver() -> SolverOptions {
    at_dof(0, SolverOptions::default())
}

/// Eight masses 1 between springs 1, held at both ends, with a slider of stiffness `kt` at the fifth.
fn chain(kt: f64) -> Model {
    unit_chain(MASSES)
        .rayleigh(0.02, 0.0)
        .slider(4, kt, 0.3, 1.0)
        .force(0, 1, 0.2)
        .build()
}

fn fundamental(branch: &Branch, point: usize) -> Complex64 {
    let mut x = vec![Complex64::ZERO; (branch.harmonics() + 1) * MASSES];
    branch.harmonics_at(point, &mut x).unwrap();
    x[MASSES]
}

/// Frequency, and the fundamental of the first mass with kt = 3e4 and of rigid friction.
const IN_TIME: [(f64, [f64; 2], [f64; 2]); 6] = [
    (0.55, [0.447_888_817, -0.048_134_908], [0.447_875_105, -0.048_128_599]),
    (0.565, [0.442_824_802, -0.151_274_543], [0.442_854_383, -0.151_222_216]),
    (0.605, [0.411_752_919, -0.323_261_827], [0.411_814_054, -0.323_240_826]),
    (0.62, [0.215_612_352, -0.390_626_962], [0.215_679_151, -0.390_667_713]),
    (0.665, [0.042_595_499, -0.543_098_003], [0.042_632_108, -0.543_261_528]),
    (1.15, [0.304_294_226, -0.309_169_812], [0.304_322_254, -0.309_104_565]),
];

#[test]
fn single_frequencies_with_real_slip_are_within_the_tolerance() {
    for (omega, stiff, rigid) in IN_TIME {
        for (kt, [re, im]) in [(3e4, stiff), (2e6, rigid), (4e8, rigid), (f64::INFINITY, rigid)] {
            let branch = sweep(&chain(kt), &solver(), omega, omega, &[]);
            let name = format!("kt {kt:e}, {omega}");
            assert_eq!(branch.status(), Status::Ok, "{name}");
            let exact = Complex64::new(re, im);
            let error = (fundamental(&branch, 0) - exact).norm() / exact.norm();
            let estimate = branch.error_estimate()[0];
            println!(
                "{name}: H {}, error {error:.1e}, estimate {estimate:.1e}",
                branch.harmonics()
            );
            assert!(error <= 1e-3, "{name}: {error:e}");
            // Estimates were 1e-8 and less beside errors of 1e-4.
            assert!(
                error <= 1e-4 + 4.0 * estimate,
                "{name}: {error:e}, estimated {estimate:e}"
            );
        }
    }
}

#[test]
fn a_sweep_through_the_onset_of_slip_takes_few_harmonics() {
    for kt in [3e4, 2e6, 4e8, f64::INFINITY] {
        let branch = sweep(&chain(kt), &solver(), 0.3, 0.5505, &[0.55]);
        assert_eq!(branch.status(), Status::Ok, "{kt:e}");
        assert!(branch.harmonics() <= 63 && branch.points() < 200, "{kt:e}");
        let exact = Complex64::new(0.447_875_105, -0.048_128_599);
        let point = branch.at(0)[0].point;
        let error = (fundamental(&branch, point) - exact).norm() / exact.norm();
        assert!(error <= 1e-3, "{kt:e}: {error:e}");
    }
}

/// The force does the work that damping and contact take, and the loop of the contact is that of its law.
#[test]
fn energies_and_loops_are_those_of_the_motion_of_the_contact() {
    let (omega, limit) = (0.605, 0.3);
    let branch = sweep(&chain(2e6), &solver(), omega, omega, &[]);
    let energy = branch.energy_at(0).unwrap();
    let work = -std::f64::consts::PI * 0.2 * fundamental(&branch, 0).im;
    let taken = energy.structural_loss + energy.friction_loss;
    assert!((taken / work - 1.0).abs() < 1e-8, "{taken} for {work}");
    let summary = branch.contact_summary(0, 0).unwrap();
    assert!((summary.work / energy.friction_loss - 1.0).abs() < 1e-8);
    assert!(summary.slip_share > 0.1 && summary.slip_share < 1.0);
    let n = 400;
    let found = branch.contact_loop(0, 0, n).unwrap();
    assert!(found.force.iter().all(|f| f.abs() <= limit * (1.0 + 1e-12)));
    // The loop of a rigid slider: work of the force along the motion, sample by sample.
    let around = (0..n).map(|j| {
        let (next, before) = (found.motion[(j + 1) % n], found.motion[j]);
        0.5 * (found.force[j] + found.force[(j + 1) % n]) * (next - before)
    });
    let around: f64 = around.sum();
    assert!(
        (around / summary.work - 1.0).abs() < 0.02,
        "{around} for {}",
        summary.work
    );
    // Where it sticks it rests, but for what the harmonics leave out.
    let largest = found.motion.iter().fold(0.0_f64, |m, y| m.max(y.abs()));
    assert!((largest / summary.half_range[0] - 1.0).abs() < 0.01);
}

/// Sweeps over both resonances end within few points and harmonics, and have the motion that an integration in time has.
#[test]
fn sweeps_over_resonances_with_slip_take_few_harmonics() {
    for kt in [3e4, 2e6, 4e8, f64::INFINITY] {
        for (start, stop) in [(0.5, 0.75), (1.05, 1.3)] {
            let inside: Vec<_> = IN_TIME.iter().filter(|row| row.0 > start && row.0 < stop).collect();
            let requested: Vec<f64> = inside.iter().map(|row| row.0).collect();
            let branch = sweep(&chain(kt), &solver(), start, stop, &requested);
            let name = format!("{kt:e} from {start}");
            assert_eq!(branch.status(), Status::Ok, "{name}");
            assert!(branch.harmonics() <= 63 && branch.points() < 200, "{name}");
            for (i, row) in inside.into_iter().enumerate() {
                let point = branch.at(i)[0].point;
                let [re, im] = if kt == 3e4 { row.1 } else { row.2 };
                let exact = Complex64::new(re, im);
                let error = (fundamental(&branch, point) - exact).norm() / exact.norm();
                assert!(error <= 1e-3, "{name}, {}: {error:e}", row.0);
            }
        }
    }
}

/// Frequency, and the fundamental of the first mass with kt = 3e4.
const LATE: [(f64, [f64; 2]); 6] = [
    (0.6, [0.417_548_703, -0.296_924_206]),
    (1.12, [0.359_005_968, -0.201_153_385]),
    (1.2, [0.143_403_266, -0.440_125_646]),
    (1.22, [0.042_545_741, -0.468_350_689]),
    (1.24, [-0.100_635_849, -0.454_948_491]),
    (1.26, [-0.290_541_127, -0.218_502_332]),
];

/// Forces are late by the frequency of a point, and not by that of the middle of a range: where slip reverses, a stick that rings at
/// the harmonic 145 moves the response by 1 % from that with rigid friction. Numbers by a program that integrates in time.
#[test]
fn forces_are_late_by_the_frequency_of_the_point() {
    let rows = LATE;
    let requested: Vec<f64> = rows.iter().map(|row| row.0).collect();
    let branch = sweep(&chain(3e4), &solver(), 0.4, 1.3, &requested);
    assert_eq!(branch.status(), Status::Ok);
    for (i, (omega, [re, im])) in rows.into_iter().enumerate() {
        // All are found: a slip all the time was taken for a linear contact, where those of 1.22 and 1.24 were lost.
        let point = branch.at(i)[0].point;
        let exact = Complex64::new(re, im);
        let error = (fundamental(&branch, point) - exact).norm() / exact.norm();
        let estimate = branch.error_estimate_at(point).unwrap();
        println!("{omega}: error {error:.1e}, estimate {estimate:.1e}");
        assert!(
            error <= 6e-4 && error <= 1e-4 + 2.0 * estimate,
            "{omega}: {error:e}, {estimate:e}"
        );
    }
}

/// A mass on a spring 1 under the force cos ωt with rigid friction that slips without a stop: Den Hartog, Trans. ASME APM-53-9 (1931),
/// has its largest motion √(V² − (fc U)²), V = 1/(1 − r²), U = sin(π/r)/(r(1 + cos(π/r))) with r = ω. The harmonics of the
/// motion fall as H⁻³, and those that are left out sum up to H⁻² where slip reverses.
#[test]
fn a_mass_on_a_rigid_slider_moves_as_in_closed_form() {
    let limit = 0.3;
    let mut model = Model::new(1).unwrap();
    for kind in [MatrixKind::Mass, MatrixKind::Stiffness] {
        model.set_matrix(kind, &MatrixView::dense(1, &[1.0])).unwrap();
    }
    let rigid = Contact::jenkins(0, None, f64::INFINITY, 1.0, limit);
    model.add_contact(&rigid).unwrap();
    model.add_force(0, 1, 1.0.into()).unwrap();
    for r in [0.6_f64, 0.8, 1.3, 1.7] {
        let (sin, cos) = (std::f64::consts::PI / r).sin_cos();
        let (v, u) = (1.0 / (1.0 - r * r), sin / (r * (1.0 + cos)));
        let exact = (v * v - (limit * u).powi(2)).sqrt();
        for highest in [31, 127] {
            let branch = sweep(&model, &harmonics(highest), r, r, &[]);
            let x = all_harmonics(&branch, 0);
            let at = |k: usize| -> f64 {
                let turn = |(h, x): (usize, &Complex64)| (x * Complex64::cis(k as f64 * 1e-3 * h as f64)).re;
                x.iter().enumerate().map(turn).sum()
            };
            let largest = (0..6284).map(at).fold(0.0, f64::max);
            let error = (largest / exact - 1.0).abs();
            println!("{r}, H {highest}: {error:.1e}");
            assert!(error <= 0.3 / (highest as f64).powi(2), "{r}, {highest}: {error:e}");
        }
    }
}

/// The limit of ever stiffer sliders, with one or two of them and at the sizes of each way to the flexibility.
#[test]
fn a_rigid_slider_is_the_limit_of_stiff_ones() {
    for n in [6, 101, 200, 700] {
        for count in [1, 2] {
            let solved = |kt: f64| {
                let own: Vec<f64> = (0..n * n).map(|i| f64::from(u8::from(i % (n + 1) == 0))).collect();
                let spring = |i: usize| match (i / n).abs_diff(i % n) {
                    0 => 2.0,
                    1 => -1.0,
                    _ => 0.0,
                };
                let stiffness: Vec<f64> = (0..n * n).map(spring).collect();
                let mut model = dense(&own, &stiffness).rayleigh(0.02, 1e-3).build();
                for k in 0..count {
                    let contact = Contact::jenkins(n / 2 + 2 * k, None, kt, 0.3, 0.5);
                    model.add_contact(&contact).unwrap();
                }
                model.add_force(n / 2 - 3, 1, 0.6.into()).unwrap();
                let solver = SolverOptions {
                    response_dof: Some(n / 2 - 2),
                    tolerance: 1e-2,
                    ..SolverOptions::default()
                };
                let branch = sweep(&model, &solver, 0.31, 0.33, &[]);
                assert_eq!(branch.status(), Status::Ok, "{n}, {kt:e}");
                assert!(branch.slip_fraction()[0] > 0.0, "{n}, {kt:e}");
                (branch.amplitude()[0], branch.amplitude()[branch.points() - 1])
            };
            let (rigid, stiff) = (solved(f64::INFINITY), solved(1e9));
            let gap = (rigid.0 / stiff.0 - 1.0).abs().max((rigid.1 / stiff.1 - 1.0).abs());
            assert!(gap < 1e-7, "{n} masses, {count} sliders: {gap:e}");
        }
    }
}

/// Analyses without these equations refuse a rigid slider by name, natural modes hold it.
#[test]
fn a_rigid_slider_is_refused_elsewhere() {
    let model = chain(f64::INFINITY);
    let range = omega_range(0.5, 0.6);
    let refused = |text: String| assert!(text.contains("contact 0") && text.contains("kt = inf"), "{text}");
    let fixed = SolverOptions {
        samples: 64,
        ..harmonics(3)
    };
    let found = forced_response(&model, &fixed, &range, &mut Hooks::default());
    refused(found.err().unwrap().to_string());
    let mode_range = amplitude_range(-2.0, 0.0);
    let mode = nonlinear_mode(&model, &harmonics(3), &mode_range, &mut Hooks::default());
    refused(mode.err().unwrap().to_string());
    let branch = sweep(&model, &harmonics(15), 0.6, 0.6, &[]);
    let in_time = verify(&model, &branch, 0, &VerifyOptions::default(), &mut Hooks::default());
    refused(in_time.err().unwrap().to_string());
    let mut two = model.clone();
    two.add_contact(&Contact::jenkins(4, None, 1.0, 0.3, 1.0)).unwrap();
    let found = forced_response(&two, &harmonics(3), &range, &mut Hooks::default());
    refused(found.err().unwrap().to_string());
    let mut tied = model.clone();
    let infinite = Contact::jenkins(1, None, f64::INFINITY, 0.3, f64::INFINITY);
    assert!(
        tied.add_contact(&infinite)
            .unwrap_err()
            .to_string()
            .contains("kt = inf")
    );
    // A mass that is held leaves chains of four and three.
    let modes = model.lowest_modes(0, ContactState::Stuck, 2).unwrap();
    let held = |n: usize| 2.0 * (std::f64::consts::PI / (2.0 * (n + 1) as f64)).sin();
    for (found, exact) in modes.omega.iter().zip([held(4), held(3)]) {
        assert!((found / exact - 1.0).abs() < 1e-7, "{found} for {exact}");
    }
}

/// A ring of 24 blades, each with a rigid slider to the next one, under an engine order.
fn blades(engine_order: i64, kt: f64, preload: f64) -> Model {
    let mut model = Structure::cyclic(2, 24)
        .mass(&[1.0, 0.0, 0.0, 1.5])
        .stiffness(&[1.0, -1.0, -1.0, 5.0])
        .next(MatrixKind::Stiffness, &[0.0, 0.0, 0.0, -1.0])
        .wave(engine_order)
        .rayleigh(0.0, 0.02)
        .build();
    if kt > 0.0 {
        let mut contact = Contact::jenkins(0, Some(0), kt, 0.4, preload);
        contact.sector_offset = 1;
        model.add_contact(&contact).unwrap();
    }
    model.add_force(1, 1, 0.5.into()).unwrap();
    model
}

/// Blades that move alike in a harmonic, h EO = 0 mod 24, do not move their contact there, so that any force that sticks would do: the
/// equation was singular.
#[test]
fn rigid_sliders_between_blades_that_move_alike_have_a_solution() {
    let solver = at_dof(1, harmonics(9));
    let solved = |model: &Model| {
        let branch = sweep(model, &solver, 1.3, 2.6, &[1.7]);
        assert_eq!(branch.status(), Status::Ok);
        // The first harmonic that is carried is the fundamental.
        let amplitude = |point: usize| branch.response_at(point).unwrap()[0].norm();
        [0, branch.at(0)[0].point, branch.points() - 1].map(amplitude)
    };
    let equal = |found: [f64; 3], wanted: [f64; 3], name: &str| {
        for (found, wanted) in found.iter().zip(&wanted) {
            assert!((found / wanted - 1.0).abs() < 1e-6, "{name}: {found} for {wanted}");
        }
    };
    // Under engine order 0 no contact moves, whatever its load.
    let free = solved(&blades(0, 0.0, 0.0));
    equal(solved(&blades(0, f64::INFINITY, 0.5)), free, "engine order 0");
    // Under engine order 8 harmonics 3 and 9 do not move it; one that sticks for ever is a tie.
    let tied = solved(&blades(8, 1e9, f64::INFINITY));
    equal(solved(&blades(8, f64::INFINITY, 3e2)), tied, "stuck");
    for preload in [0.05, 0.5, 1.2] {
        solved(&blades(8, f64::INFINITY, preload));
    }
}

/// A rigid slider beside another nonlinear contact, against an integration in time with kt = 1e5, where the difference of the two is 1e-4.
#[test]
fn a_rigid_slider_beside_other_contacts_is_right_in_time() {
    let beside = [
        ("cubic", Contact::cubic(2, None, 0.0, 0.5), 0.605),
        ("gap", Contact::unilateral(Some(2), None, 5.0, 0.2), 0.605),
        ("Jenkins", Contact::jenkins(2, None, 2.0, 0.3, 0.5), 0.665),
    ];
    for (name, contact, omega) in beside {
        let with = |kt: f64| {
            let mut model = chain(kt);
            model.add_contact(&contact).unwrap();
            model
        };
        let rigid = sweep(&with(f64::INFINITY), &solver(), omega, omega, &[]);
        assert_eq!(rigid.status(), Status::Ok, "{name}, {omega}");
        let model = with(1e5);
        let plain = sweep(&model, &at_dof(0, harmonics(31)), omega, omega, &[]);
        let in_time = verify(&model, &plain, 0, &VerifyOptions::default(), &mut Hooks::default()).unwrap();
        assert!(in_time.same, "{name}, {omega}");
        let error = (fundamental(&rigid, 0) - in_time.response).norm() / in_time.response.norm();
        let estimate = rigid.error_estimate()[0];
        println!("{name}, {omega}: error {error:.1e}, estimate {estimate:.1e}");
        assert!(error <= 1e-4 + estimate, "{name}, {omega}: {error:e}, {estimate:e}");
    }
}
