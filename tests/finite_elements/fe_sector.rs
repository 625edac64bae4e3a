//! A real finite-element sector against independent reference values: natural frequencies and the
//! forced response with 60 friction contacts.

use crate::response::{Range, Response};
use crate::sector;
use crate::sector::{Interface, Sector, Size, natural_frequencies};
use hbvib::{ContactState, SolverOptions};
use num_complex::Complex64;
use serde_json::Value;
use std::f64::consts::TAU;
use std::path::Path;

fn root() -> &'static Path {
    crate::common::programs::root()
}

fn data(name: &str) -> Value {
    let path = root().join("tests/data/fe").join(name);
    serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
}

fn sector(size: Size) -> Sector {
    Sector::read(&root().join("examples/data/fe"), size).unwrap()
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap()
}

fn complex(value: &Value) -> Complex64 {
    Complex64::new(number(&value[0]), number(&value[1]))
}

/// Frequencies below this belong to a ring that floats, or nearly so.
const NEARLY_RIGID: f64 = 10.0;

/// Compares the eight lowest natural frequencies of every nodal diameter in one state of the
/// contacts. Rigid motions of the ring are zeros of the full sector; the basis of the reduced one
/// does not hold them exactly, and makes them slow motions.
fn compare_frequencies(sector: &Sector, interface: Interface, state: ContactState, key: &str) {
    let reference = &data("linear.json")[sector.size.name()][key];
    let model = sector.model(interface).unwrap();
    let diameters = reference.as_array().unwrap();
    assert_eq!(diameters.len(), sector::SECTORS / 2 + 1);
    let mut worst = 0.0_f64;
    for (diameter, expected) in diameters.iter().enumerate() {
        let expected: Vec<f64> = expected.as_array().unwrap().iter().map(number).collect();
        let found = natural_frequencies(&model, diameter as i64, state, expected.len()).unwrap();
        assert_eq!(found.len(), expected.len());
        let slow = &data("near_rigid.json")[sector.size.name()][key][diameter.to_string()];
        for (i, (omega, f)) in found.iter().zip(expected).enumerate() {
            let found = omega / TAU;
            if f < NEARLY_RIGID {
                // Rounding of a stiff matrix is an error of ω², of either sign: 1e-4 here, where the stiffest mode has 1e13.
                let f = slow.get(i).map_or(f, number);
                let error = (found * found - f * f).abs();
                assert!(
                    error < 1e-5,
                    "{key}, diameter {diameter}: ring at {found} Hz, needs {f}"
                );
            } else {
                let error = (found / f - 1.0).abs();
                assert!(error < 1e-8, "{key}, diameter {diameter}: {found} Hz, needs {f}");
                worst = worst.max(error);
            }
        }
    }
    println!("{} {key}: worst relative error {worst:.1e}", sector.size.name());
}

fn compare_all_frequencies(size: Size) {
    let sector = sector(size);
    compare_frequencies(&sector, Interface::Absent, ContactState::Free, "no_contact");
    compare_frequencies(&sector, Interface::Springs, ContactState::Free, "slip_kn_only");
    compare_frequencies(&sector, Interface::Friction2d, ContactState::Stuck, "stuck");
}

#[test]
fn natural_frequencies_of_the_reduced_sector_agree() {
    compare_all_frequencies(Size::Reduced);
}

#[test]
#[ignore = "a quarter of a minute long; tests/deep.sh runs it, and the reduced sector is above"]
fn natural_frequencies_of_the_full_sector_agree() {
    compare_all_frequencies(Size::Full);
}

fn options(harmonics: usize) -> SolverOptions {
    crate::common::harmonics(harmonics)
}

fn follow(sector: &Sector, force: f64, harmonics: usize, range: &Range) -> Response {
    let model = sector.forced(force).unwrap();
    Response::follow(&model, &options(harmonics), range, &[sector.size.tip()], |_| {}).unwrap()
}

/// The whole response with its peak and five fixed frequencies against the reference.
fn compare_response(force: f64, force_key: &str, harmonics: usize, key: &str) {
    let reference = &data("reference.json")["results"]["rom"][key][force_key];
    let fixed = reference["points"].as_array().unwrap();
    let range = Range {
        from: 512.0,
        to: 548.0,
        at: fixed.iter().map(|p| number(&p["freq_Hz"])).collect(),
    };
    let response = follow(&sector(Size::Reduced), force, harmonics, &range);
    assert_eq!(response.at.len(), fixed.len());
    let mut worst = 0.0_f64;
    for (point, expected) in response.at.iter().zip(fixed) {
        assert_eq!(point.harmonics.len(), harmonics.div_ceil(2));
        let x1 = complex(&expected["tip_theta_h1"]);
        let error = (point.fundamental() - x1).norm() / x1.norm();
        let found = point.fundamental();
        assert!(error < 1e-7, "{} Hz: {found}, needs {x1}: {error:.1e}", point.frequency);
        worst = worst.max(error);
        if harmonics == 3 {
            let x3 = complex(&expected["tip_theta_h3"]);
            let error = (point.harmonics[1].1[0] - x3).norm();
            assert!(error < 1e-7 * x1.norm(), "{} Hz: third harmonic", point.frequency);
        }
    }
    let amplitude = number(&reference["peak_amp_m"]);
    let error = (response.peak.amplitude() / amplitude - 1.0).abs();
    assert!(
        error < 1e-6,
        "peak {:e}, needs {amplitude:e}",
        response.peak.amplitude()
    );
    // The curve is flat at its peak, so the frequency of the reference is less exact there.
    let frequency = number(&reference["peak_freq_Hz"]);
    assert!((response.peak.frequency / frequency - 1.0).abs() < 1e-6);
    println!(
        "{force} N, {key}: fixed frequencies {worst:.1e}, peak {error:.1e}; {} points, {} iterations, {:?}",
        response.points.len(),
        response.iterations(),
        response.times
    );
}

#[test]
fn reduced_sector_at_a_fifth_of_a_newton_with_the_fundamental() {
    compare_response(0.2, "0.2", 1, "H1");
}

#[test]
fn reduced_sector_at_a_fifth_of_a_newton_with_two_harmonics() {
    compare_response(0.2, "0.2", 3, "H1_3");
}

#[test]
fn reduced_sector_at_two_newtons_with_the_fundamental() {
    compare_response(2.0, "2.0", 1, "H1");
}

#[test]
fn reduced_sector_at_two_newtons_with_two_harmonics() {
    compare_response(2.0, "2.0", 3, "H1_3");
}

/// The engine order of the files, where the next sector leads, is 21; here it lags, so it is 3. A
/// reader who takes 21 for the library's sign runs the wave backwards: 21 is −3. The linear response
/// at the forced degree of freedom itself would not show it (the matrices of the two waves are each
/// other's transposes, with the same diagonal of the inverse), nor do natural frequencies. Friction
/// does: the contacts move differently in the two waves, and the tip feels it.
#[test]
fn a_wave_of_the_wrong_sign_is_seen() {
    let sector = sector(Size::Reduced);
    let stuck = sector.model(Interface::Friction2d).unwrap();
    let backward = sector::SECTORS - sector::ENGINE_ORDER as usize;
    assert_eq!(
        stuck.structure().fold(backward as i64),
        (sector::ENGINE_ORDER as usize, true)
    );

    let reference = &data("reference.json")["results"]["rom"]["H1_3"]["0.2"]["points"][2];
    let frequency = number(&reference["freq_Hz"]);
    let range = Range {
        from: frequency,
        to: frequency,
        at: Vec::new(),
    };
    let expected = complex(&reference["tip_theta_h1"]);
    let error = |engine_order: i64| {
        let mut model = sector.forced(0.2).unwrap();
        model.set_wave(engine_order);
        let tip = [sector.size.tip()];
        let response = Response::follow(&model, &options(3), &range, &tip, |_| {}).unwrap();
        (response.peak.fundamental() - expected).norm() / expected.norm()
    };
    assert!(error(sector::ENGINE_ORDER) < 1e-7);
    assert!(error(backward as i64) > 1e-3);
    assert!(error(-sector::ENGINE_ORDER) > 1e-3);
}

fn peaks_agree_at(force: f64) {
    let range = Range {
        from: 524.0,
        to: 534.0,
        at: Vec::new(),
    };
    let (reduced, full) = (sector(Size::Reduced), sector(Size::Full));
    let of_reduced = follow(&reduced, force, 3, &range);
    let of_full = follow(&full, force, 3, &range);
    let ratio = of_full.peak.amplitude() / of_reduced.peak.amplitude();
    println!("{force} N: full over reduced {:e}; {:?}", ratio - 1.0, of_full.times);
    assert!((ratio - 1.0).abs() < 1e-4);
}

#[test]
#[ignore = "a minute long; tests/deep.sh runs it"]
fn peaks_of_the_full_and_the_reduced_sector_agree_at_a_fifth_of_a_newton() {
    peaks_agree_at(0.2);
}

#[test]
#[ignore = "half a minute long; tests/deep.sh runs it"]
fn peaks_of_the_full_and_the_reduced_sector_agree_at_two_newtons() {
    peaks_agree_at(2.0);
}
