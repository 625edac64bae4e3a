//! A real finite-element sector against independent reference values: natural frequencies and the
//! forced response with 60 friction contacts.

#[path = "../examples/support/json.rs"]
mod json;
#[path = "../examples/support/matrix_market.rs"]
mod matrix_market;
#[path = "../examples/support/response.rs"]
mod response;
#[path = "../examples/fe_sector/sector.rs"]
mod sector;
#[path = "../examples/support/table.rs"]
mod table;

use hbvib::model::linear_modes::ContactState;
use hbvib::options::SolverOptions;
use num_complex::Complex64;
use response::{Range, Response};
use sector::{Interface, Sector, Size, natural_frequencies};
use serde_json::Value;
use std::f64::consts::TAU;
use std::path::Path;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
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

/// Compares the eight lowest natural frequencies of every nodal diameter in one state of the
/// contacts; a stored zero is a rigid motion of the ring.
fn compare_frequencies(sector: &Sector, interface: Interface, state: ContactState, key: &str) {
    let reference = &data("linear.json")[sector.size.name()][key];
    let model = sector.model(interface).unwrap();
    let diameters = reference.as_array().unwrap();
    assert_eq!(diameters.len(), sector::SECTORS / 2 + 1);
    let mut worst = 0.0_f64;
    for (diameter, expected) in diameters.iter().enumerate() {
        let expected: Vec<f64> = expected.as_array().unwrap().iter().map(number).collect();
        let found = natural_frequencies(&model, diameter, state, expected.len()).unwrap();
        assert_eq!(found.len(), expected.len());
        for (omega, f) in found.iter().zip(expected) {
            let found = omega / TAU;
            if std::env::var("SHOW").is_ok() && (f < 20.0 || (found / f - 1.0).abs() > 1e-9) {
                println!(
                    "{} {key} {diameter}: {found} ref {f} rel {:.1e}",
                    sector.size.name(),
                    found / f - 1.0
                );
                continue;
            }
            if f == 0.0 {
                assert!(found < 1e-3, "{key}, diameter {diameter}: rigid motion at {found} Hz");
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
    compare_frequencies(&sector, Interface::Friction, ContactState::Stuck, "stuck");
}

#[test]
fn natural_frequencies_of_the_reduced_sector_agree() {
    compare_all_frequencies(Size::Reduced);
}

#[test]
fn natural_frequencies_of_the_full_sector_agree() {
    compare_all_frequencies(Size::Full);
}

fn options(harmonics: usize) -> SolverOptions {
    SolverOptions {
        harmonics,
        ..SolverOptions::default()
    }
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
