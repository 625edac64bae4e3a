//! Hysteresis loops and slip fractions of a job, against the closed form of a Jenkins contact under a sine.

use std::f64::consts::{PI, TAU};
use std::path::{Path, PathBuf};
use std::process::Output;

const KT: f64 = 5e7;
const LIMIT: f64 = 0.3 * 488.0;

/// Runs the ring damper with one harmonic, with more contacts and outputs.
fn run(name: &str, contacts: &str, outputs: &str) -> (Output, PathBuf) {
    let job = format!(
        "{}[[contact]]\nname = 'ring'\nkind = 'jenkins'\na = [2]\nb = [3]\nkt = {KT:?}\nmu = 0.3\npreload = 488.0\n{contacts}\n\
         [[force]]\ndof = 0\nvalue = 5.0\n[[force]]\ndof = 1\nvalue = 5.0\n\
         [forced]\nfrom_hz = 207.0\nto_hz = 211.0\nharmonics = 1\n\
         [output]\ncsv = 'response.csv'\n{outputs}\n",
        crate::common::ring_damper()
    );
    crate::common::hbvib("run", ("contact_outputs", name), &job)
}

fn errors(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

fn read(path: &Path) -> Vec<Vec<String>> {
    let text = std::fs::read_to_string(path).unwrap();
    text.lines()
        .map(|row| row.split(',').map(String::from).collect())
        .collect()
}

fn number(word: &str) -> f64 {
    word.parse().unwrap()
}

#[test]
fn the_loop_is_that_of_a_jenkins_contact_under_a_sine() {
    let times = 20_000;
    let (output, folder) = run(
        "loop",
        "",
        &format!(
            "slip_csv = 'slip.csv'\nslip_figure = 'slip.svg'\n\
             [[output.hysteresis]]\ncontact = 'ring'\nsamples = {times}\ncsv = 'loop.csv'\nfigure = 'loop.svg'"
        ),
    );
    assert!(output.status.success(), "{}", errors(&output));
    let table = read(&folder.join("loop.csv"));
    assert_eq!(table[0], ["frequency_hz", "angle", "motion_0", "force_0", "state"]);
    let rows = &table[1..];
    assert_eq!(rows.len(), times);
    let motion: Vec<f64> = rows.iter().map(|row| number(&row[2])).collect();
    let force: Vec<f64> = rows.iter().map(|row| number(&row[3])).collect();
    let x = motion.iter().fold(0.0_f64, |x, y| x.max(y.abs()));
    assert!(x > 1.2 * LIMIT / KT, "the contact must slip: {x}");
    // Area of the loop by trapezia: 4 limit (X − limit/kt). Forces act against the motion.
    let area: f64 = (0..times)
        .map(|i| {
            let j = (i + 1) % times;
            0.5 * (force[i] + force[j]) * (motion[j] - motion[i])
        })
        .sum();
    let work = 4.0 * LIMIT * (x - LIMIT / KT);
    assert!((area.abs() / work - 1.0).abs() < 1e-4, "{area} {work}");
    // The contact sticks from a reversal over the angle θ with X (1 − cos θ) = 2 limit/kt.
    let slipping = rows.iter().filter(|row| row[4] == "slip").count() as f64 / times as f64;
    let share = 1.0 - (1.0 - 2.0 * LIMIT / (KT * x)).acos() / PI;
    assert!((slipping - share).abs() < 1e-3, "{slipping} {share}");
    for (row, f) in rows.iter().zip(&force) {
        assert!(f.abs() <= LIMIT * (1.0 + 1e-9));
        assert!(row[4] != "slip" || (f.abs() / LIMIT - 1.0).abs() < 1e-9);
    }
    assert!((number(&rows[times / 4][1]) - TAU / 4.0).abs() < 1e-12);

    // The slip map has the curve's points, and that share at its highest one.
    let (curve, slip) = (read(&folder.join("response.csv")), read(&folder.join("slip.csv")));
    assert_eq!(slip[0], ["frequency_hz", "\"ring\""]);
    assert_eq!(curve.len(), slip.len());
    let mut highest = (0.0, 0.0);
    for (point, row) in curve[1..].iter().zip(&slip[1..]) {
        assert_eq!(point[0], row[0]);
        assert!((number(&point[2]) - number(&row[1])).abs() < 1e-6);
        let amplitude = number(&point[1]);
        if amplitude > highest.0 {
            highest = (amplitude, number(&row[1]));
        }
    }
    assert!((highest.1 - share).abs() < 0.02, "{highest:?} {share}");
    let figure = |name: &str| std::fs::read_to_string(folder.join(name)).unwrap();
    let (one, map) = (figure("loop.svg"), figure("slip.svg"));
    assert!(one.starts_with("<svg") && one.contains("contact ring") && one.contains("<polyline"));
    assert!(map.starts_with("<svg") && map.contains("frequency, Hz") && map.matches("<rect").count() > 3);
}

#[test]
fn several_points_and_pairs_have_their_own_rows_and_columns() {
    let more = "[[contact]]\nkind = 'jenkins'\na = [0, 1]\nb = [1, 2]\nkt = 1e4\nmu = 0.3\npreload = 1e4\n";
    let outputs = "slip_csv = 'slip.csv'\nslip_figure = 'slip.svg'\n\
                   [[output.hysteresis]]\ncontact = '2'\npair = 1\npoints = 'peaks'\nsamples = 8\ncsv = 'loop.csv'";
    let (output, folder) = run("pairs", more, outputs);
    assert!(output.status.success(), "{}", errors(&output));
    assert_eq!(
        read(&folder.join("slip.csv"))[0],
        ["frequency_hz", "\"ring\"", "\"2[0]\"", "\"2[1]\""]
    );
    let map = std::fs::read_to_string(folder.join("slip.svg")).unwrap();
    for label in ["ring", "2[0]", "2[1]"] {
        assert_eq!(map.lines().filter(|line| line.trim() == label).count(), 1, "{label}");
    }
    let table = read(&folder.join("loop.csv"));
    assert!(table.len() > 1 && (table.len() - 1).is_multiple_of(8));
    // It never slips: f = −kt x or kt x at each time.
    for row in &table[1..] {
        assert!((number(&row[3]).abs() - 1e4 * number(&row[2]).abs()).abs() < 1e-9 * LIMIT);
        assert_eq!(row[4], "stick");
    }
}

#[test]
fn contacts_that_the_job_does_not_have_are_named() {
    let loops = |words: &str| format!("[[output.hysteresis]]\n{words}\ncsv = 'loop.csv'");
    let twice = "[[contact]]\nname = 'ring'\nkind = 'jenkins'\na = [0]\nb = [1]\nkt = 1e4\nmu = 0.3\npreload = 1.0\n";
    for (name, contacts, outputs, words) in [
        (
            "name",
            "",
            loops("contact = 'rim'"),
            "contact = \"rim\" is none of ring",
        ),
        (
            "pair",
            "",
            loops("contact = 'ring'\npair = 1"),
            "pair = 1, needs 0 .. 1",
        ),
        ("twice", twice, String::new(), "[[contact]] 2: name = \"ring\""),
        ("times", "", loops("contact = 'ring'\nsamples = 0"), "contact \"ring\""),
    ] {
        let (output, _) = run(name, contacts, &outputs);
        assert_eq!(output.status.code(), Some(1), "{name}");
        assert!(errors(&output).contains(words), "{name}: {}", errors(&output));
    }
}
