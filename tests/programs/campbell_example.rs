//! The example `campbell` as a user runs it: engine orders meet the modes where the frequencies over speed say, and the
//! modes over nodal diameter are those of the reference data, stiffened by the rotation.

use std::f64::consts::TAU;
use std::fs;
use std::process::Command;

use crate::common::example::{built, folder};
use crate::common::{data, number};

#[test]
fn engine_orders_meet_the_modes_of_the_rotating_disk() {
    let folder = folder("campbell");
    let output = Command::new(built("campbell"))
        .current_dir(&folder)
        .env_remove("CARGO_MANIFEST_DIR")
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let target = folder.join("target/campbell");
    for name in ["campbell", "interference"] {
        let file = |suffix: &str| fs::read(target.join(name).with_extension(suffix)).unwrap();
        assert!(file("svg").starts_with(b"<svg") && file("png").starts_with(b"\x89PNG"));
    }
    let rows = |name: &str| -> Vec<Vec<f64>> {
        let text = fs::read_to_string(target.join(name)).unwrap();
        let cells = |line: &str| line.split(',').map(|cell| cell.parse().unwrap()).collect();
        text.lines().skip(1).map(cells).collect()
    };
    let stuck = data("nf_nd.json")["ring_stuck"]["30g"].clone();
    let curves = rows("campbell.csv");
    assert_eq!((curves.len(), curves[0].len()), (46, 4));
    for (k, hertz) in curves[0][1..].iter().enumerate() {
        let known = number(&stuck["2"]["f"][k]);
        // Damping of 0.3 % lowers a frequency by half of its square.
        assert!((hertz / known - 1.0).abs() < 1e-5, "mode {k} at rest: {hertz} {known}");
    }
    assert!(
        curves.windows(2).all(|pair| (1..4).all(|k| pair[1][k] > pair[0][k])),
        "rotation stiffens"
    );
    // Each crossing on the screen lies on its ray and between two points of its curve.
    let screen = String::from_utf8(output.stdout).unwrap();
    let crossings: Vec<[f64; 3]> = screen
        .lines()
        .filter(|line| line.trim_start().starts_with("EO"))
        .map(|line| {
            let words: Vec<&str> = line.split_whitespace().collect();
            [words[1], words[3], words[5]].map(|word| word.parse().unwrap())
        })
        .collect();
    assert!(crossings.len() >= 3, "{screen}");
    for [order, rpm, hertz] in &crossings {
        assert!((order * rpm / 60.0 / hertz - 1.0).abs() < 1e-6);
        let near = curves.windows(2).any(|pair| {
            pair[0][0] <= *rpm && *rpm <= pair[1][0] && (1..4).any(|k| pair[0][k] <= *hertz && *hertz <= pair[1][k])
        });
        assert!(near, "EO {order} at {rpm} rpm, {hertz} Hz");
    }
    // The waves of the second figure at the speed of the first crossing of EO 2.
    let [_, rpm, hertz] = *crossings.iter().find(|c| (c[0] - 2.0).abs() < 0.5).unwrap();
    let waves = rows("interference.csv");
    assert_eq!(waves.len(), 13 * 3);
    let of_two = waves
        .iter()
        .find(|row| (row[0] - 2.0).abs() < 0.5 && (row[2] / hertz - 1.0).abs() < 1e-6);
    assert!(of_two.is_some(), "{hertz} Hz at {rpm} rpm, {} rad/s", rpm * TAU / 60.0);
}
