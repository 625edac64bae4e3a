//! The band of damping ratio and frequency of a nonlinear mode at an amplitude: a wedge damper, whose contact with the platform sticks.
//! Its least damping is that of the linear structure with stuck contacts, from its eigenvalues; no state that is placed lies outside.

use crate::common::models::{Structure, damper_face, oscillator};
use crate::common::{amplitude_range, harmonics};
use hbvib::{
    Hooks, LinearContacts, ModeBandOf, ModeOptions, Model, SolverOptions, damped_modes, mode_band, nonlinear_mode,
};

/// The wedge damper, its contact with the platform as equal parts.
fn wedge(parts: usize) -> Model {
    let share = 1.0 / parts as f64;
    Structure::plain(3)
        .diagonals([&[1.0, 0.01, 0.01], &[0.04, 0.004, 0.004], &[1.0, 1e-3, 1e-3]])
        .contact(damper_face([1, 2], -1.0, Some(0), [1.0, 1.5, 0.15]))
        .contacts(vec![damper_face([1, 2], 1.0, None, [share, 1.5 * share, 0.6]); parts])
        .force(2, 0, 1.0)
        .build()
}

fn range(amplitude: f64) -> ModeOptions<'static> {
    amplitude_range(amplitude.log10(), amplitude.log10() + 0.05)
}

/// Frequency and damping ratio of the mode at an amplitude with sliders at places.
fn placed(model: &Model, sliders: &[(usize, usize)], places: &[f64], amplitude: f64) -> [f64; 2] {
    let mut model = model.try_clone().unwrap();
    for (slider, place) in sliders.iter().zip(places) {
        model.set_slider(slider.0, slider.1, *place).unwrap();
    }
    let solver = SolverOptions {
        max_points: 1,
        ..harmonics(7)
    };
    let branch = nonlinear_mode(&model, &solver, &range(amplitude), &mut Hooks::default()).unwrap();
    [branch.omega()[0], branch.mode_at(0).unwrap().damping_ratio]
}

#[test]
fn the_damping_of_a_mode_reaches_from_the_stuck_structure_to_much_slip() {
    let amplitude = 0.3;
    let model = wedge(1);
    let mode = nonlinear_mode(&model, &harmonics(7), &range(amplitude), &mut Hooks::default()).unwrap();
    let found = [ModeBandOf::Damping, ModeBandOf::Omega].map(|of| {
        let hooks = &mut Hooks::default();
        mode_band(&model, &mode, 0, (of, &[]), &harmonics(7), &range(amplitude), hooks).unwrap()
    });
    let [damping, omega] = &found;
    println!("{:?} {:?}, {} solved", damping.lower, damping.upper, damping.solved);
    assert!(found.iter().all(|band| band.is_complete && band.sliders == [(1, 0)]));
    let stuck = damped_modes(&model, 0, LinearContacts::Static, 3, &mut Hooks::default()).unwrap();
    let mut eigenvalues = stuck.eigenvalue.iter();
    let linear = eigenvalues
        .find(|z| (z.norm() / damping.lower.omega - 1.0).abs() < 0.01)
        .unwrap();
    assert!((damping.lower.damping_ratio / (-linear.re / linear.norm()) - 1.0).abs() < 1e-3);
    assert!(
        damping.upper.damping_ratio > 2.5 * damping.lower.damping_ratio && omega.upper.omega > 1.03 * omega.lower.omega
    );
    for i in 0..40 {
        let place = 0.05 * f64::from(i) - 0.2;
        let [frequency, ratio] = placed(&model, &damping.sliders, &[place], amplitude);
        assert!(
            ratio > damping.lower.damping_ratio - 1e-9 && ratio < damping.upper.damping_ratio + 1e-9,
            "{place}"
        );
        assert!(
            frequency > omega.lower.omega - 1e-9 && frequency < omega.upper.omega + 1e-9,
            "{place}"
        );
    }
    for end in [&damping.lower, &damping.upper, &omega.lower, &omega.upper] {
        let [frequency, ratio] = placed(&model, &damping.sliders, &end.places, amplitude);
        assert!((frequency - end.omega).abs() < 1e-10 && (ratio - end.damping_ratio).abs() < 1e-10);
    }
}

#[test]
fn two_contacts_that_share_a_face_have_the_band_of_the_mode_with_one() {
    let amplitude = 0.3;
    let ends = [1, 2].map(|parts| {
        let model = wedge(parts);
        let mode = nonlinear_mode(&model, &harmonics(7), &range(amplitude), &mut Hooks::default()).unwrap();
        let hooks = &mut Hooks::default();
        let options = range(amplitude);
        let found = mode_band(
            &model,
            &mode,
            0,
            (ModeBandOf::Damping, &[]),
            &harmonics(7),
            &options,
            hooks,
        )
        .unwrap();
        assert_eq!(found.sliders.len(), parts);
        println!("{} solved", found.solved);
        [found.lower.damping_ratio, found.upper.damping_ratio]
    });
    assert!((ends[0][0] / ends[1][0] - 1.0).abs() < 1e-6 && (ends[0][1] / ends[1][1] - 1.0).abs() < 1e-6);
}

#[test]
fn a_mode_without_a_slider_that_sticks_has_no_band() {
    let model = oscillator(1.0, 1.0).damping(&[0.02]).slider(0, 1.0, 0.3, 1.0).build();
    let mode = nonlinear_mode(&model, &harmonics(3), &range(2.0), &mut Hooks::default()).unwrap();
    let of = |point, contacts: &[usize]| {
        let hooks = &mut Hooks::default();
        mode_band(
            &model,
            &mode,
            point,
            (ModeBandOf::Damping, contacts),
            &harmonics(3),
            &range(2.0),
            hooks,
        )
    };
    let found = of(0, &[]).unwrap();
    assert!(found.sliders.is_empty() && found.solved == 0);
    let own = mode.mode_at(0).unwrap().damping_ratio;
    assert_eq!(found.lower.damping_ratio.to_bits(), own.to_bits());
    assert!(of(99, &[]).unwrap_err().to_string().contains("point = 99"));
    assert!(of(0, &[1]).unwrap_err().to_string().contains("contacts has 1"));
}
