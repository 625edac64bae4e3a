//! A job with `stability`: a Duffing oscillator is unstable between its folds, in the table, the summary and the figure.

use std::f64::consts::TAU;
use std::path::{Path, PathBuf};

/// Folds of ẍ + 0.1 ẋ + x + 0.1 x³ = 0.18 cos ωt.
const FOLDS: [f64; 2] = [1.103_377_837_7, 1.100_155_035_1];

/// A file of a matrix of one entry 1.
fn one() -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("one.mtx");
    std::fs::write(
        &path,
        "%%MatrixMarket matrix coordinate real symmetric\n1 1 1\n1 1 1.0\n",
    )
    .unwrap();
    path
}

fn run(name: &str, stability: &str) -> (std::process::Output, PathBuf) {
    let one = one().display().to_string();
    let job = format!(
        "model.stiffness = '{one}'\nmodel.mass = '{one}'\nmodel.rayleigh = [0.1, 0.0]\n\
         [[contact]]\nkind = 'cubic'\na = [0]\ncubic = 0.1\n[[force]]\ndof = 0\nvalue = 0.18\n\
         [forced]\nfrom_hz = {}\nto_hz = {}\nharmonics = 9\n{stability}\n\
         [output]\ncsv = 'response.csv'\nfigure = 'response.svg'\n",
        0.9 / TAU,
        1.3 / TAU
    );
    crate::common::hbvib("run", ("stability", name), &job)
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}

#[test]
fn the_motion_between_the_folds_is_unstable_in_every_output() {
    let (output, folder) = run("wave", "stability = 'wave'");
    let screen = text(&output.stdout);
    assert!(output.status.success(), "{screen}{}", text(&output.stderr));
    let csv = std::fs::read_to_string(folder.join("response.csv")).unwrap();
    let mut lines = csv.lines();
    assert!(lines.next().unwrap().ends_with(",floquet_radius,unstable_directions"));
    let rows: Vec<Vec<f64>> = lines
        .map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect())
        .collect();
    let runs_back =
        |i: usize| i > 0 && i + 1 < rows.len() && rows[i - 1][0] > rows[i][0] && rows[i][0] > rows[i + 1][0];
    let mut unstable = 0;
    for (i, row) in rows.iter().enumerate() {
        let (radius, count) = (row[4], row[5]);
        assert_eq!(count > 0.0, radius > 1.0, "{row:?}");
        assert!(!runs_back(i) || (count > 0.5 && count < 1.5), "{row:?}");
        unstable += usize::from(count > 0.0);
        // Elsewhere the motion is stable, with the product of its multipliers that of the damping.
        assert!(count == 0.0 || row[0] * TAU < FOLDS[0] + 1e-6 && row[0] * TAU > FOLDS[1] - 1e-6);
        assert!(radius >= (-0.05 / row[0]).exp() - 1e-9);
    }
    assert!(unstable > 0);
    assert!(
        screen.contains(&format!("{unstable} points unstable, stability unknown at 0")),
        "{screen}"
    );
    let folds = screen.lines().filter(|line| line.starts_with("fold")).count();
    assert_eq!(folds, 2, "{screen}");

    let (plain, without) = run("none", "");
    assert!(plain.status.success() && !text(&plain.stdout).contains("unstable"));
    let strokes = |folder: &Path| {
        let svg = std::fs::read_to_string(folder.join("response.svg")).unwrap();
        svg.matches("<polyline").count()
    };
    assert!(strokes(&folder) > strokes(&without) + 3, "dashes");
    // A structure that is no sector has no wheel.
    let (wheel, _) = run("wheel", "stability = 'wheel'");
    let told = text(&wheel.stderr);
    assert!(!wheel.status.success() && told.contains("stability"), "{told}");
}

#[test]
fn other_words_are_refused() {
    let (output, _) = run("other", "stability = 'all'");
    let words = text(&output.stderr);
    assert!(
        !output.status.success() && words.contains("wave") && words.contains("wheel"),
        "{words}"
    );
}
