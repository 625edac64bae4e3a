//! `--mode` of the example `ring_damper` as a user runs it: its JSON against reference data, and its
//! refusals.

use std::f64::consts::{PI, TAU};
use std::fs;
use std::path::Path;

use crate::common::example::{DOFS, folder, run};
use crate::common::{BASE, Blisk, complex, data, number};
use num_complex::Complex64;
use serde_json::Value;

/// Masses in the order of the degrees of freedom, that of the ring as in the base case.
const MASSES: [f64; 4] = [0.2, 0.3, 1.2, 0.03];

/// The mode that the flags describe.
fn mode(folder: &Path, flags: &str) -> Value {
    let all = ["--mode", "--json", "mode.json"]
        .into_iter()
        .chain(flags.split_whitespace());
    let output = run(folder, &all.collect::<Vec<_>>());
    assert!(
        output.status.success(),
        "{flags}: {}",
        String::from_utf8_lossy(&output.stderr)
    );
    serde_json::from_str(&fs::read_to_string(folder.join("mode.json")).unwrap()).unwrap()
}

fn list<'a>(mode: &'a Value, name: &str) -> &'a [Value] {
    mode[name].as_array().unwrap()
}

fn get(point: &Value, name: &str) -> f64 {
    number(&point[name])
}

/// Slip limit over contact stiffness in the base case.
fn delta() -> f64 {
    Blisk::mu() * BASE.preload() / BASE.kt()
}

fn motion(point: &Value, dof: &str, harmonic: &str) -> Complex64 {
    complex(&point["harmonics"][dof][harmonic])
}

/// Checks layout and numbers of a point of the base case's structure against its harmonics.
/// `relative` is the error of motions that rounding leaves where disk and ring move nearly alike.
fn check_point(point: &Value, carried: &[&str], relative: f64) {
    assert_eq!(point.as_object().unwrap().len(), 7);
    assert_eq!(point["harmonics"].as_object().unwrap().len(), DOFS.len());
    let omega = TAU * get(point, "frequency_hz");
    let (mut square, mut energy) = (0.0, 0.0);
    for (dof, mass) in DOFS.into_iter().zip(MASSES) {
        let of_dof = point["harmonics"][dof].as_object().unwrap();
        assert_eq!(of_dof.len(), carried.len());
        for p in carried {
            let size = mass * motion(point, dof, p).norm_sqr();
            energy += 0.5 * (p.parse::<f64>().unwrap() * omega).powi(2) * size;
            square += if *p == "1" { size } else { 0.0 };
        }
    }
    // A mode that hardly works on the contact is recovered from a tiny force: rounding grows 1e5 times.
    assert!((get(point, "modal_amplitude") / square.sqrt() - 1.0).abs() < 1e-10);
    assert!((get(point, "energy_j") / energy - 1.0).abs() < 1e-10);
    let slip = (motion(point, "d", "1") - motion(point, "r", "1")).norm() / delta();
    assert!((slip / get(point, "slip") - 1.0).abs() < relative, "{slip}");
}

#[test]
fn frequency_damping_and_energy_agree_with_the_reference() {
    let reference = &data("nnm_base.json")["H"]["7"];
    let table = reference["table"].as_array().unwrap();
    let rows = || table.iter().rev();
    // Rust writes the shortest decimals that are read back to the same number.
    let at: Vec<String> = rows().map(|row| format!("--at-slip {}", number(&row["a"]))).collect();
    let mode = mode(&folder("mode"), &format!("--harmonics 7 {}", at.join(" ")));
    assert_eq!(mode.as_object().unwrap().len(), 3);
    let points = list(&mode, "backbone");
    assert_eq!(get(&points[0], "slip").to_bits(), 0.5_f64.to_bits());
    assert_eq!(get(&points[points.len() - 1], "slip").to_bits(), 1e4_f64.to_bits());

    let peak = &mode["max_damping"];
    for point in points.iter().chain(list(&mode, "at")).chain([peak]) {
        check_point(point, &["1", "3", "5", "7"], 1e-11);
        let damping = get(point, "damping_ratio");
        let balance = get(point, "dissipation_j") / (4.0 * PI * get(point, "energy_j"));
        assert!((damping - balance).abs() < 1e-9 * get(peak, "damping_ratio"));
        assert!(damping <= get(peak, "damping_ratio"));
        if get(point, "slip") <= 1.0 {
            assert_eq!((damping, get(point, "dissipation_j")), (0.0, 0.0));
        }
    }

    let largest = &reference["D_max"];
    let length = delta();
    let compare = |point: &Value, row: &Value| {
        let near = |name: &str, value: f64, error: f64| {
            let found = get(point, name);
            assert!(
                (found / value - 1.0).abs() < error,
                "{name} {found} {value} at {}",
                row["a"]
            );
        };
        near("frequency_hz", number(&row["f_Hz"]), 1e-9);
        near("modal_amplitude", number(&row["alpha"]) * length, 1e-9);
        near("energy_j", number(&row["E2T"]) * length * length, 1e-9);
        let error = get(point, "damping_ratio") - number(&row["D"]);
        assert!(error.abs() < 1e-7 * number(&largest["D"]), "{error}");
        let loss = get(point, "dissipation_j") / (length * length) - number(&row["E_diss"]);
        assert!(loss.abs() < 1e-7 * number(&row["E_diss"]), "{loss}");
    };
    assert_eq!(list(&mode, "at").len(), table.len());
    for (point, row) in list(&mode, "at").iter().zip(rows()) {
        assert_eq!(get(point, "slip").to_bits(), number(&row["a"]).to_bits());
        compare(point, row);
    }
    assert!((get(peak, "damping_ratio") / number(&largest["D"]) - 1.0).abs() < 1e-9);
    // Where a curve is flat, its place is known to half of the digits.
    assert!((get(peak, "slip") / number(&largest["a"]) - 1.0).abs() < 1e-6);
}

#[test]
fn a_tolerance_chooses_the_harmonics_of_each_point_of_a_mode_and_tells_the_errors() {
    let value = mode(&folder("tolerance"), "--tolerance 1e-3 --at-slip 0.5 --at-slip 5");
    let points = value["backbone"].as_array().unwrap();
    let at = value["at"].as_array().unwrap();
    let mut most = 0;
    for point in points.iter().chain(at).chain([&value["max_damping"]]) {
        let used = point["harmonics_used"].as_u64().unwrap();
        let (f, d) = (
            number(&point["error_estimate_frequency"]),
            number(&point["error_estimate_damping"]),
        );
        assert!(f < 1e-3 && d < 1e-3);
        assert!(number(&point["slip"]) > 1.0 || (used == 1 && f == 0.0 && d == 0.0));
        most = most.max(used);
    }
    assert!(most > 9);
}

#[test]
fn the_ends_the_stuck_range_and_repeated_slips_are_exact() {
    let folder = folder("mode_ends");
    let all = mode(
        &folder,
        "--from-slip 0.1 --to-slip 3e3 --at-slip 1 --at-slip 0.3 --at-slip 1 --at-slip 3000 --at-slip 0.1",
    );
    let slips: Vec<f64> = list(&all, "at").iter().map(|q| get(q, "slip")).collect();
    assert_eq!(slips, [1.0, 0.3, 1.0, 3000.0, 0.1]);
    let frequency = get(&all["backbone"][0], "frequency_hz");
    for i in [0, 1, 2, 4] {
        let point = &all["at"][i];
        assert!((get(point, "frequency_hz") / frequency - 1.0).abs() < 1e-12);
        assert!(get(point, "damping_ratio").abs() < 1e-12);
    }
    let last = list(&all, "backbone").last().unwrap();
    assert!((get(&all["at"][3], "frequency_hz") / get(last, "frequency_hz") - 1.0).abs() < 1e-12);

    let sliding = mode(&folder, "--from-slip 50 --to-slip 70");
    assert_eq!(sliding["max_damping"], Value::Null, "damping falls all the way");
    let points = list(&sliding, "backbone");
    assert_eq!(
        (get(&points[0], "slip"), get(points.last().unwrap(), "slip")),
        (50.0, 70.0)
    );
    let stuck = mode(&folder, "--from-slip 1e-9 --to-slip 1");
    assert_eq!(stuck["max_damping"], Value::Null);
    assert!(list(&stuck, "backbone").iter().all(|q| get(q, "damping_ratio") == 0.0));
}

#[test]
fn every_flag_changes_the_mode() {
    let folder = folder("mode_flags");
    let base = mode(&folder, "--at-slip 20");
    let explicit = "--diameter 2 --family 1 --ring-mass 0.03 --rpm 3000 --kt 5e7 --beta 0 --harmonics 9 \
                    --mode-damping mass --from-slip 0.5 --to-slip 1e4 --at-slip 20";
    assert_eq!(mode(&folder, explicit), base, "the defaults are the base case");
    for change in [
        "--diameter 3",
        "--family 2",
        "--ring-mass 0.04",
        "--rpm 2999.5",
        "--kt 4e7",
        "--beta 1e-6",
        "--harmonics 7",
        "--mode-damping stiffness",
        "--samples 64",
    ] {
        let changed = mode(&folder, &format!("--at-slip 20 {change}"));
        assert_ne!(changed["at"], base["at"], "{change}");
    }
}

#[test]
fn both_forms_of_damping_agree_where_they_should() {
    let folder = folder("mode_forms");
    let flags = "--harmonics 1 --beta 1.5e-6 --at-slip 0.5 --at-slip 20";
    let (mass, stiffness) = (
        mode(&folder, flags),
        mode(&folder, &format!("{flags} --mode-damping stiffness")),
    );
    // Both take out the structure's damping, of stiffness type: exactly by zeta = beta in the stuck range.
    let (a, b) = (&mass["at"][0], &stiffness["at"][0]);
    let exact = 0.5 * 1.5e-6 * TAU * get(b, "frequency_hz");
    assert!((get(b, "damping_ratio") / exact - 1.0).abs() < 1e-12);
    assert!((get(a, "damping_ratio") / exact - 1.0).abs() < 0.01);
    // The mode is damped lightly, so the form matters little.
    let ratio = get(&stiffness["max_damping"], "damping_ratio") / get(&mass["max_damping"], "damping_ratio");
    assert!((1e-6..0.01).contains(&(ratio - 1.0).abs()), "{ratio}");
}

#[test]
fn all_families_run_from_stuck_to_sliding() {
    let folder = folder("mode_families");
    for diameter in [0, 2, 3, 12] {
        let mut last = 0.0;
        for family in 1..=4 {
            let flags = format!("--diameter {diameter} --family {family} --from-slip 0.9 --to-slip 1e3 --at-slip 10");
            let mode = mode(&folder, &flags);
            let points = list(&mode, "backbone");
            let stuck = get(&points[0], "frequency_hz");
            assert!(stuck > last, "families rise");
            last = stuck;
            assert!(get(points.last().unwrap(), "slip").to_bits() == 1e3_f64.to_bits());
            for point in list(&mode, "at") {
                // The lower modes of diameter 0 carry the ring along: it floats.
                check_point(point, &["1", "3", "5", "7", "9"], 1e-8);
            }
        }
    }
}

#[test]
fn bad_flags_are_named_and_nothing_is_written() {
    let folder = folder("mode_refused");
    for (name, flags) in [
        ("--family", "--family 0"),
        ("--family", "--family 5"),
        ("--family", "--family 1.0"),
        ("--diameter", "--diameter 13"),
        ("--diameter", "--diameter -1"),
        ("--mode-damping", "--mode-damping Mass"),
        ("--ring-mass", "--ring-mass 0"),
        ("--rpm", "--rpm 0"),
        ("--kt", "--kt 0"),
        ("--kt", "--kt inf"),
        ("--beta", "--beta -1e-6"),
        ("--from-slip", "--from-slip 0"),
        ("--from-slip", "--from-slip 1e4"),
        ("--from-slip", "--from-slip 5 --to-slip 5"),
        ("--from-slip", "--from-slip 7 --to-slip 3"),
        ("--to-slip", "--to-slip nan"),
        ("--to-slip", "--to-slip 1e300"),
        ("--at-slip", "--at-slip 0.4"),
        ("--at-slip", "--at-slip 2e4"),
        ("--at-slip", "--at-slip 2 --at-slip"),
        ("--harmonics", "--harmonics 0"),
        ("--samples", "--samples 18"),
        ("--force", "--force 5"),
        ("--engine-order", "--engine-order 2"),
        ("--tip-only", "--tip-only"),
        ("--from", "--from 207"),
        ("--at-hz", "--at-hz 208"),
        ("--mode", "--mode"),
    ] {
        let all = ["--mode", "--json", "mode.json"].into_iter().chain(flags.split(' '));
        let output = run(&folder, &all.collect::<Vec<_>>());
        let message = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{flags}: {message}");
        assert!(message.contains(name), "{flags}: {message}");
        assert_eq!(fs::read_dir(&folder).unwrap().count(), 0, "{flags}");
    }
}
