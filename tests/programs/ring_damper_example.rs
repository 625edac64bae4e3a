//! The example `ring_damper` as a user runs it: its JSON, its refusals and its figures.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use crate::common::example::{DOFS, folder, run};
use serde_json::Value;

fn response(folder: &Path, flags: &[&str]) -> Value {
    let output = run(folder, &[flags, &["--json", "response.json"]].concat());
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let left: Vec<_> = fs::read_dir(folder).unwrap().map(|e| e.unwrap().file_name()).collect();
    assert_eq!(left, ["response.json"], "the file alone, no temporary beside it");
    serde_json::from_str(&fs::read_to_string(folder.join("response.json")).unwrap()).unwrap()
}

fn frequency(point: &Value) -> f64 {
    point["frequency_hz"].as_f64().unwrap()
}

fn amplitude(point: &Value) -> f64 {
    point["amplitude_b2_m"].as_f64().unwrap()
}

/// Checks that two points are one solution at one frequency. Each may have been solved on its own, so
/// their motions agree to rounding and not to the last bit.
fn check_same(a: &Value, b: &Value) {
    assert_eq!(frequency(a).to_bits(), frequency(b).to_bits());
    for dof in DOFS {
        let (x, y) = (&a["harmonics"][dof], &b["harmonics"][dof]);
        assert_eq!(x.as_object().unwrap().len(), y.as_object().unwrap().len());
        for (p, pair) in x.as_object().unwrap() {
            for part in 0..2 {
                let difference = pair[part].as_f64().unwrap() - y[p][part].as_f64().unwrap();
                assert!(difference.abs() < 1e-12 * amplitude(a), "{dof} {p}: {difference}");
            }
        }
    }
}

/// Checks the layout of a point against the harmonics that it should carry.
fn check_point(point: &Value, carried: &[&str]) {
    assert_eq!(point.as_object().unwrap().len(), 3);
    let harmonics = point["harmonics"].as_object().unwrap();
    assert_eq!(harmonics.len(), DOFS.len());
    for dof in DOFS {
        let of_dof = harmonics[dof].as_object().unwrap();
        let mut numbers: Vec<&str> = of_dof.keys().map(String::as_str).collect();
        numbers.sort_by_key(|p| p.parse::<usize>().unwrap());
        assert_eq!(numbers, carried);
        assert!(
            of_dof
                .values()
                .all(|x| x.as_array().unwrap().iter().filter(|v| v.is_f64()).count() == 2)
        );
    }
    let first = &harmonics["b2"]["1"];
    let size = first[0].as_f64().unwrap().hypot(first[1].as_f64().unwrap());
    assert!((size - amplitude(point)).abs() <= 1e-15 * size);
}

#[test]
fn json_has_the_points_the_peak_and_the_solutions_asked_for_in_order() {
    // The ends and the frequencies asked for do not survive Hz to rad/s and back by chance.
    let flags = "--harmonics 5 --from 207.3 --to 210.7 --at-hz 209.9 --at-hz 208.1 --at-hz 209.9 --at-hz 207.3";
    let flags: Vec<&str> = flags.split(' ').collect();
    let value = response(&folder("json"), &flags);
    assert_eq!(value.as_object().unwrap().len(), 3);
    let points = value["points"].as_array().unwrap();
    let at = value["at"].as_array().unwrap();
    let peak = &value["peak"];
    for point in points.iter().chain(at).chain([peak]) {
        check_point(point, &["1", "3", "5"]);
        assert!(amplitude(point) <= amplitude(peak));
    }
    assert_eq!(frequency(&points[0]).to_bits(), 207.3_f64.to_bits());
    assert_eq!(frequency(&points[points.len() - 1]).to_bits(), 210.7_f64.to_bits());
    let order: Vec<f64> = at.iter().map(frequency).collect();
    assert_eq!(order, [209.9, 208.1, 209.9, 207.3]);
    check_same(&at[0], &at[2]);
    check_same(&at[3], &points[0]);
    assert!(frequency(peak) > 207.3 && frequency(peak) < 210.7);
}

#[test]
fn a_downward_sweep_finds_the_same_response() {
    let up = response(&folder("up"), &["--from", "207", "--to", "211", "--at-hz", "208.5"]);
    let down = response(&folder("down"), &["--from", "211", "--to", "207", "--at-hz", "208.5"]);
    let points = down["points"].as_array().unwrap();
    assert_eq!(
        (frequency(&points[0]), frequency(&points[points.len() - 1])),
        (211.0, 207.0)
    );
    for (a, b) in [(&up["peak"], &down["peak"]), (&up["at"][0], &down["at"][0])] {
        assert!((amplitude(a) / amplitude(b) - 1.0).abs() < 1e-10);
        assert!((frequency(a) / frequency(b) - 1.0).abs() < 1e-9);
    }
}

#[test]
fn the_peak_is_an_end_of_the_range_if_the_response_is_largest_there() {
    let value = response(&folder("end"), &["--from", "207", "--to", "208"]);
    let last = value["points"].as_array().unwrap().last().unwrap();
    check_same(&value["peak"], last);
    let single = response(&folder("single"), &["--from", "208", "--to", "208", "--at-hz", "208"]);
    assert_eq!(single["points"].as_array().unwrap().len(), 1);
    check_same(&single["at"][0], &single["peak"]);
}

#[test]
fn every_flag_changes_the_response() {
    let folder = folder("flags");
    let range = ["--from", "209", "--to", "209"];
    let base = response(&folder, &range);
    let explicit = "--force 5 --ring-mass 0.03 --rpm 3000 --engine-order 2 --kt 5e7 --beta 1.5e-6 --harmonics 9";
    let explicit: Vec<&str> = explicit.split(' ').chain(range).collect();
    assert_eq!(response(&folder, &explicit), base, "the defaults are the base case");
    let changes = "--force 6,--ring-mass 0.04,--rpm 2999.5,--engine-order 3,--kt 4e7,--beta 1e-6,--tip-only,\
                   --harmonics 7,--samples 64";
    for change in changes.split(',') {
        let flags: Vec<&str> = change.split(' ').chain(range).collect();
        assert_ne!(response(&folder, &flags)["peak"], base["peak"], "{change}");
    }
    // On 24 sectors these are waves of the same shape.
    for order in ["-2", "22", "26"] {
        let same = response(&folder, &[&["--engine-order", order], &range[..]].concat());
        assert!((amplitude(&same["peak"]) / amplitude(&base["peak"]) - 1.0).abs() < 1e-10);
    }
}

#[test]
fn a_tolerance_chooses_the_harmonics_of_each_point_and_tells_the_error() {
    let flags = "--tolerance 1e-3 --from 205.5 --to 211 --at-hz 208.85 --at-hz 205.5";
    let flags: Vec<&str> = flags.split(' ').collect();
    let value = response(&folder("tolerance"), &flags);
    let at = value["at"].as_array().unwrap();
    let (mut least, mut most) = (usize::MAX, 0);
    for point in value["points"]
        .as_array()
        .unwrap()
        .iter()
        .chain(at)
        .chain([&value["peak"]])
    {
        let error = point["error_estimate"].as_f64().unwrap();
        let used = point["harmonics_used"].as_u64().unwrap() as usize;
        let numbers: Vec<usize> = point["harmonics"]["b2"]
            .as_object()
            .unwrap()
            .keys()
            .map(|h| h.parse().unwrap())
            .collect();
        assert_eq!(numbers.iter().max(), Some(&used));
        assert!(error < 1e-3 && (error > 0.0 || used == 1));
        (least, most) = (least.min(used), most.max(used));
    }
    assert!(least == 1 && most > 9);
    // In time it is 1.361714297e-3 m at 208.85 Hz.
    assert!((amplitude(&at[0]) / 1.361_714_297e-3 - 1.0).abs() < 1e-3);
    let fixed = response(&folder("fixed"), &["--from", "208", "--to", "208"]);
    assert!(fixed["points"][0].get("error_estimate").is_none());
}

#[test]
fn numbers_have_17_digits() {
    let folder = folder("digits");
    response(&folder, &["--from", "208", "--to", "208"]);
    let text = fs::read_to_string(folder.join("response.json")).unwrap();
    let mut seen = 0;
    for number in text.split(|c: char| !c.is_ascii_alphanumeric() && !".-+".contains(c)) {
        if let Some((digits, _)) = number.split_once('e').filter(|_| number.parse::<f64>().is_ok()) {
            assert_eq!(digits.chars().filter(char::is_ascii_digit).count(), 17, "{number}");
            seen += 1;
        }
    }
    assert!(seen > 2 * DOFS.len());
}

#[test]
fn bad_flags_are_named_and_nothing_is_written() {
    let folder = folder("refused");
    let bad = [
        ("--forze", "--forze 5"),
        ("extra", "extra"),
        ("--force", "--force"),
        ("--force", "--force --rpm 3000"),
        ("--force", "--force five"),
        ("--force", "--force -1"),
        ("--force", "--force 1 --force 2"),
        ("--ring-mass", "--ring-mass nan"),
        ("--rpm", "--rpm inf"),
        ("--kt", "--kt 1e999"),
        ("--beta", "--beta 1,5"),
        ("--engine-order", "--engine-order 1.5"),
        ("--harmonics", "--harmonics 0"),
        ("--harmonics", "--harmonics 99999999999"),
        ("--samples", "--harmonics 9 --samples 18"),
        ("--tolerance", "--tolerance 0"),
        ("--tolerance", "--tolerance -1e-3"),
        ("--tolerance", "--tolerance nan"),
        ("--tolerance", "--tolerance 1"),
        ("--tolerance", "--tolerance 1e-3 --harmonics 9"),
        ("--max-harmonics", "--max-harmonics 9"),
        ("--max-harmonics", "--tolerance 1e-3 --max-harmonics 0"),
        ("--from", "--from 0"),
        ("--from", "--from 300"),
        ("--to", "--to -1"),
        ("--at-hz", "--at-hz 300"),
        ("--at-hz", "--at-hz 208 --at-hz"),
        ("yes", "--tip-only yes"),
        ("--mode", "--family 1"),
        ("--at-slip", "--force 5 --at-slip 2"),
    ];
    for (name, flags) in bad {
        let mut all = vec!["--json", "response.json"];
        all.extend(flags.split(' '));
        let output = run(&folder, &all);
        let message = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{flags}: {message}");
        assert!(message.contains(name), "{flags}: {message}");
        assert_eq!(fs::read_dir(&folder).unwrap().count(), 0, "{flags}");
    }
}

#[test]
fn a_failure_keeps_the_file_that_was_there() {
    let folder = folder("failed");
    let file = folder.join("response.json");
    fs::write(&file, "before").unwrap();
    // A ring without mass and without stiffness against its own motion has no unique position.
    let flags = "--ring-mass 0 --engine-order 0 --from 90 --to 92 --json response.json";
    let output = run(&folder, &flags.split(' ').collect::<Vec<_>>());
    assert_eq!(output.status.code(), Some(1));
    assert!(!output.stderr.is_empty());
    assert_eq!(fs::read_to_string(&file).unwrap(), "before");
    let output = run(&folder, &["--json", "missing/response.json"]);
    assert_eq!(output.status.code(), Some(1));
    assert_eq!(fs::read_dir(&folder).unwrap().count(), 1);
}

/// Largest amplitude and its frequency for each value of a study, from the data of its figure.
fn peaks(file: &Path) -> BTreeMap<u64, (f64, f64)> {
    let mut peaks: BTreeMap<u64, (f64, f64)> = BTreeMap::new();
    for line in fs::read_to_string(file).unwrap().lines().skip(1) {
        let row: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
        // Positive numbers are ordered like their bits.
        let peak = peaks.entry(row[0].to_bits()).or_insert((0.0, 0.0));
        if row[2] > peak.1 {
            *peak = (row[1], row[2]);
        }
    }
    peaks
}

#[test]
fn figures_show_stuck_softening_and_sliding_and_the_best_damper() {
    let folder = folder("figures");
    let output = run(&folder, &[]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let figures = folder.join("target/ring_damper");
    for number in 4..=9 {
        let file = |suffix| fs::read(figures.join(format!("figure{number}.{suffix}"))).unwrap();
        assert!(file("svg").starts_with(b"<svg"));
        assert!(file("png").starts_with(b"\x89PNG"));
        assert!(file("csv").len() > 500);
    }

    let force: Vec<(f64, f64, f64)> = peaks(&figures.join("figure5.csv"))
        .into_iter()
        .map(|(force, (frequency, amplitude))| (f64::from_bits(force), frequency, amplitude / f64::from_bits(force)))
        .collect();
    assert_eq!((force[0].0, force[force.len() - 1].0), (0.1, 100.0));
    let (stuck, sliding) = (force[0], force[force.len() - 1]);
    for &(_, frequency, receptance) in force.iter().filter(|f| f.0 <= 0.5) {
        assert!((frequency - stuck.1).abs() < 1e-9 && (receptance / stuck.2 - 1.0).abs() < 1e-9);
    }
    // The figures' points lie closer than this.
    let spacing = 0.03;
    assert!(
        force.windows(2).all(|pair| pair[1].1 <= pair[0].1 + spacing),
        "softening"
    );
    let width = stuck.1 - sliding.1;
    let moved = |f: &&(f64, f64, f64)| f.0 > 0.5 && f.0 < 50.0;
    assert!(
        force.iter().filter(moved).all(|f| f.2 < stuck.2.min(sliding.2)),
        "damping"
    );
    for &(_, frequency, receptance) in force.iter().filter(|f| f.0 >= 50.0) {
        assert!((frequency - sliding.1).abs() < 0.02 * width && (receptance / sliding.2 - 1.0).abs() < 0.1);
    }

    for (number, best) in [(6, 30.0_f64), (7, 3000.0)] {
        let peaks = peaks(&figures.join(format!("figure{number}.csv")));
        assert_eq!(peaks.len(), 6);
        let least = peaks.iter().min_by(|a, b| a.1.1.total_cmp(&b.1.1)).unwrap();
        assert_eq!(*least.0, best.to_bits());
    }
}

#[test]
fn study_finds_the_best_load_and_its_sensitivities() {
    let folder = folder("study");
    let output = run(&folder, &["--study", "--grid", "3"]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let figures = folder.join("target/ring_damper");
    for stem in ["study_load", "study_load_derivative", "study_map", "study_tornado"] {
        for (suffix, begin) in [("svg", &b"<svg"[..]), ("png", b"\x89PNG")] {
            let file = fs::read(figures.join(format!("{stem}.{suffix}"))).unwrap();
            assert!(file.starts_with(begin), "{stem}.{suffix}");
        }
    }
    let screen = String::from_utf8(output.stdout).unwrap();
    // The best load at nine harmonics, and 5 % below with those of the tolerance.
    assert!(
        screen.contains("482.852") && screen.contains("208.796528") && screen.contains("1.415704"),
        "{screen}"
    );
    assert!(screen.contains("457.9") && screen.contains("9 designs"), "{screen}");
    let effects: BTreeMap<String, f64> = fs::read_to_string(figures.join("study_tornado.csv"))
        .unwrap()
        .lines()
        .skip(1)
        .map(|line| {
            let cells: Vec<&str> = line.split(',').collect();
            (cells[0].to_owned(), cells[1].parse().unwrap())
        })
        .collect();
    assert_eq!(effects.len(), 8);
    // Force and normal load together scale the motion; the load is the best one.
    assert!(
        (effects["force"] + effects["normal load"] - 10.0).abs() < 1e-6,
        "{effects:?}"
    );
    assert!(effects["normal load"].abs() < 0.01);
    assert!((effects["friction coefficient"] - effects["normal load"]).abs() < 1e-9);

    for (flags, sentence) in [
        (&["--study", "--grid", "1"][..], "--grid 1: needs 2 to 1000"),
        (&["--study", "--kt", "1e7"], "--kt cannot be given with --study"),
        (&["--grid", "4"], "--grid belongs to a study"),
    ] {
        let refused = run(&folder, flags);
        assert_eq!(refused.status.code(), Some(2));
        assert!(String::from_utf8_lossy(&refused.stderr).contains(sentence));
    }
}
