//! The example `flutter` as a user runs it: limit cycles begin where the flow overcomes the damping of the structure, the
//! smaller ones attract, and the two meet.

use std::f64::consts::TAU;
use std::fs;
use std::process::Command;

use crate::common::example::{built, folder};

/// β of the damping βK, s.
const BETA: f64 = 1.5e-6;

#[test]
fn the_smaller_limit_cycles_attract_until_they_meet_the_larger_ones() {
    let folder = folder("flutter");
    let output = Command::new(built("flutter"))
        .current_dir(&folder)
        .env_remove("CARGO_MANIFEST_DIR")
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let file = |suffix: &str| fs::read(folder.join("target/flutter/limit_cycles").with_extension(suffix)).unwrap();
    assert!(file("svg").starts_with(b"<svg") && file("png").starts_with(b"\x89PNG"));
    let text = String::from_utf8(file("csv")).unwrap();
    let rows: Vec<Vec<f64>> = text
        .lines()
        .skip(1)
        .map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect())
        .collect();
    assert_eq!(text.lines().next().unwrap().split(',').count(), 6);
    assert_eq!(rows.len(), 16);
    let screen = String::from_utf8(output.stdout).unwrap();
    assert_eq!(screen.matches(" unstable").count(), 8, "{screen}");
    assert_eq!(screen.matches("  stable").count(), 8, "{screen}");
    let side = |smaller: bool| -> Vec<&Vec<f64>> { rows.iter().filter(|row| (row[3] > 0.0) == smaller).collect() };
    let (smaller, larger) = (side(true), side(false));
    for (small, large) in smaller.iter().zip(&larger) {
        let [aero, frequency, tip] = [small[0], small[1], small[2]];
        assert_eq!(aero.to_bits(), large[0].to_bits());
        // The flow drives more than the structure dissipates: ωβ/2 for damping βK.
        assert!(-aero / 100.0 > 0.5 * BETA * TAU * frequency);
        assert!(tip < large[2] && frequency > large[1], "slip softens");
        assert!(small[4] < 1.0 && small[5] == 0.0, "the smaller one attracts");
        assert!(large[4] > 1.0 && large[5] > 0.0, "the larger one repels");
    }
    // A stronger flow: the smaller cycle grows, the larger one shrinks.
    let monotonic = |list: &[&Vec<f64>], sign: f64| list.windows(2).all(|pair| sign * (pair[1][2] - pair[0][2]) > 0.0);
    assert!(monotonic(&smaller, 1.0) && monotonic(&larger, -1.0));
    let gap = |k: usize| larger[k][2] / smaller[k][2];
    assert!(gap(0) > 40.0 && gap(7) < 1.3, "{} {}", gap(0), gap(7));
}
