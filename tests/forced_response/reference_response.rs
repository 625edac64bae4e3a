//! Forced response of the paper's blisk against stored same-H solutions: peaks and a curve.

use crate::common::{BASE, Blisk, NDOF, all_harmonics, complex, data, harmonics, number, sweep};
use hbvib::Status;
use std::f64::consts::TAU;

fn highest_peak(branch: &hbvib::Branch) -> hbvib::Special {
    let peaks = branch.peaks();
    assert!(!peaks.is_empty());
    peaks
        .iter()
        .copied()
        .reduce(|a, b| if b.amplitude > a.amplitude { b } else { a })
        .unwrap()
}

#[test]
fn peaks_agree_with_the_same_h_solution() {
    let reference = data("frf_base.json");
    for case in reference["peaks"].as_object().unwrap().values() {
        let model = Blisk {
            force: number(&case["F_N"]),
            ..BASE
        }
        .sector();
        for (highest, stored) in case["peak_hbm"].as_object().unwrap() {
            let branch = sweep(
                &model,
                &harmonics(highest.parse().unwrap()),
                TAU * 205.0,
                TAU * 213.0,
                &[],
            );
            assert_eq!(branch.status(), Status::Ok);
            let peak = highest_peak(&branch);
            let f = peak.omega / TAU;
            let (f_stored, amplitude) = (number(&stored["f_Hz"]), number(&stored["amp_b2_fund_m"]));
            println!(
                "F = {} N, H = {highest}: {} points, amplitude off by {:.1e}, frequency by {:.1e} Hz",
                case["F_N"],
                branch.points(),
                peak.amplitude / amplitude - 1.0,
                f - f_stored
            );
            assert!((peak.amplitude / amplitude - 1.0).abs() < 1e-7);
            // The reference gives its peak frequencies to about 1e-4 Hz.
            assert!((f - f_stored).abs() < 5e-4);
        }
    }
}

#[test]
fn the_peak_is_a_maximum_of_the_response_to_1e_9() {
    // Same-H check of the library against itself: solutions to either side of the refined peak.
    // Around a maximum |X| falls by half of curvature·offset²; the two sides must agree to what a
    // frequency error of 1e-9 allows.
    let model = BASE.sector();
    let options = harmonics(7);
    let (from, to) = (TAU * 205.0, TAU * 213.0);
    let peak = highest_peak(&sweep(&model, &options, from, to, &[]));
    let offset = 1e-4 * peak.omega;
    let sides = sweep(&model, &options, from, to, &[peak.omega - offset, peak.omega + offset]);
    let drop: Vec<f64> = (0..2).map(|i| peak.amplitude - sides.at(i)[0].amplitude).collect();
    assert!(drop[0] > 0.0 && drop[1] > 0.0);
    // With curvature c the drops are c(offset ± error)²: their difference gives the error, up to
    // the third derivative, which halving the offset shows to be the larger part.
    let half = sweep(
        &model,
        &options,
        from,
        to,
        &[peak.omega - 0.5 * offset, peak.omega + 0.5 * offset],
    );
    let small: Vec<f64> = (0..2).map(|i| peak.amplitude - half.at(i)[0].amplitude).collect();
    let asymmetry = |d: &[f64], offset: f64| (d[1] - d[0]) / (d[1] + d[0]) * offset / 2.0;
    // asymmetry = error + third·offset²: extrapolate to offset 0.
    let (wide, near) = (asymmetry(&drop, offset), asymmetry(&small, 0.5 * offset));
    let error = near + (near - wide) / 3.0;
    println!("peak frequency off by {:.1e} relative", error / peak.omega);
    assert!(error.abs() < 1e-8 * peak.omega);
}

#[test]
fn the_curve_at_5_n_agrees_with_the_same_h_solution() {
    let reference = data("frf_base.json");
    let points = reference["curve_F5"]["points"].as_array().unwrap();
    let at: Vec<f64> = points.iter().map(|p| TAU * number(&p["f_Hz"])).collect();
    let model = BASE.sector();
    let mut worst = 0.0_f64;
    for highest in ["1", "3", "5", "7", "15", "31"] {
        let h: usize = highest.parse().unwrap();
        let branch = sweep(&model, &harmonics(h), TAU * 207.0, TAU * 211.0, &at);
        for (i, p) in points.iter().enumerate() {
            let expected = complex(&p["hbm"][highest]);
            let found = branch.at(i);
            assert_eq!(found.len(), 1, "H = {h}, {} Hz", p["f_Hz"]);
            assert_eq!(found[0].omega.to_bits(), at[i].to_bits());
            let amplitude = (found[0].amplitude / expected.norm() - 1.0).abs();
            assert!(amplitude < 1e-7, "H = {h}, {} Hz: {amplitude:.1e}", p["f_Hz"]);
            let x = all_harmonics(&branch, found[0].point)[NDOF];
            let whole = (x - expected).norm() / expected.norm();
            assert!(whole < 1e-7, "H = {h}, {} Hz: {whole:.1e} with phase", p["f_Hz"]);
            worst = worst.max(whole);
        }
    }
    println!("largest relative error of X_1(b2): {worst:.1e}");
}

#[test]
fn many_harmonics_approach_the_true_peaks() {
    let reference = data("frf_base.json");
    for (case, bound) in [("F1", 2e-3), ("F5", 1e-2), ("F20", 1e-3)] {
        let stored = &reference["peaks"][case];
        let model = Blisk {
            force: number(&stored["F_N"]),
            ..BASE
        }
        .sector();
        let truth = number(&stored["peak_td"]["amp_b2_fund_m"]);
        let error = |h: usize| {
            let branch = sweep(&model, &harmonics(h), TAU * 207.0, TAU * 211.0, &[]);
            (highest_peak(&branch).amplitude / truth - 1.0).abs()
        };
        let (few, many) = (error(7), error(63));
        println!("{case}: error of the peak against the truth: H = 7 {few:.1e}, H = 63 {many:.1e}");
        // The error falls with H, though not steadily; the bounds are a tenth of what H = 3 has.
        assert!(many < bound);
    }
}
