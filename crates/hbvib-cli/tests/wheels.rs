//! A job with `[wheel]`: the largest blade is that of another harmonic balance, and what cannot be computed is refused with the place in
//! the job.

use std::fs;

/// Pattern of 24 sectors whose largest blade is number 3.
const PATTERN: &str = "[0.001887, -0.006683, -0.005363, -0.029783, 0.021278, 0.013386, -0.004307, 0.008927, 0.002996, -0.007057, \
    0.01138, -0.004128, -0.004348, -0.009926, 0.005088, -0.001584, 0.006175, -0.0077, 0.001137, -0.011132, 0.009741, 0.001874, 0.00359, \
    0.004553]";

/// The job of the example with a ring damper under a force of 1 N, with another analysis.
fn run(name: &str, part: &str) -> (std::process::Output, std::path::PathBuf) {
    let example = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/jobs/ring_damper/");
    let text = fs::read_to_string(format!("{example}job.toml")).unwrap();
    let (model, _) = text.split_once("[forced]").unwrap();
    let mut job = model.replace("value = 5.0", "value = 1.0");
    for matrix in ["stiffness", "mass", "coupling"] {
        job = job.replace(&format!("\"{matrix}.mtx\""), &format!("'{example}{matrix}.mtx'"));
    }
    crate::common::hbvib("run", ("wheels", name), &(job + part))
}

#[test]
fn a_wheel_has_its_largest_blade_and_amplification() {
    let part = format!(
        "[wheel]\ndofs = [0]\npattern = {PATTERN}\nfrom_hz = 209.0\nto_hz = 211.0\nharmonics = 3\nresponse_dof = 0\ncsv = 'wheel.csv'\n\
         figure = 'wheel.svg'\n"
    );
    let (output, folder) = run("largest", &part);
    let (text, errors) = (
        crate::common::printed(&output.stdout),
        crate::common::printed(&output.stderr),
    );
    assert!(output.status.success(), "{text}{errors}");
    assert!(text.contains("wheel of 24 blades: blade 3 is the largest"), "{text}");
    assert!(text.contains("amplification 1.0932"), "{text}");
    let csv = fs::read_to_string(folder.join("wheel.csv")).unwrap();
    let mut lines = csv.lines();
    assert_eq!(lines.next(), Some("blade,hz,amplitude,error,amplification"));
    let rows: Vec<Vec<f64>> = lines
        .map(|line| line.split(',').map(|x| x.parse().unwrap()).collect())
        .collect();
    assert_eq!(rows.len(), 24);
    assert!((rows[3][2] / 8.280_100_222_407_677e-4 - 1.0).abs() < 1e-9);
    assert!(rows.iter().all(|row| row[2] <= rows[3][2]));
    let figure = fs::read_to_string(folder.join("wheel.svg")).unwrap();
    assert!(figure.contains("<polyline") && figure.contains("blades of the wheel"));
}

/// The first pattern is that of the other harmonic balance; the second is the first, turned by two sectors; the third is tuned.
#[test]
fn many_patterns_have_their_largest_blades_and_their_distribution() {
    let numbers: Vec<f64> = PATTERN
        .trim_matches(['[', ']'])
        .split(',')
        .map(|x| x.trim().parse().unwrap())
        .collect();
    let line = |shift: usize, factor: f64| {
        let turned = (0..24).map(|s| format!("{}", factor * numbers[(s + 24 - shift) % 24]));
        turned.collect::<Vec<_>>().join(" ")
    };
    let file = std::env::temp_dir().join(format!("hbvib_patterns_{}.csv", std::process::id()));
    let text = format!(
        "# three wheels\n{}\n\n{}\n{}\n",
        line(0, 1.0),
        line(2, 1.0),
        line(0, 0.0)
    );
    fs::write(&file, text.replace(' ', ", ")).unwrap();
    let part = format!(
        "[wheel]\ndofs = [0]\npatterns = '{}'\nfrom_hz = 209.0\nto_hz = 211.0\nharmonics = 3\nresponse_dof = 0\n\
         patterns_csv = 'patterns.csv'\npatterns_figure = 'patterns.svg'\n",
        file.display()
    );
    let (output, folder) = run("patterns", &part);
    let (text, errors) = (
        crate::common::printed(&output.stdout),
        crate::common::printed(&output.stderr),
    );
    assert!(output.status.success(), "{text}{errors}");
    assert!(
        text.contains("3 patterns: the largest amplification is 1.0932"),
        "{text}"
    );
    let csv = fs::read_to_string(folder.join("patterns.csv")).unwrap();
    let rows: Vec<Vec<f64>> = csv
        .lines()
        .skip(1)
        .map(|line| line.split(',').map(|x| x.parse().unwrap()).collect())
        .collect();
    assert_eq!(rows.iter().map(|row| row[1] as usize).collect::<Vec<_>>()[..2], [3, 5]);
    assert!((rows[0][3] / 8.280_100_222_407_677e-4 - 1.0).abs() < 1e-9);
    assert!((rows[1][3] / rows[0][3] - 1.0).abs() < 1e-9);
    assert!((rows[2][4] - 1.0).abs() < 1e-9);
    let figure = fs::read_to_string(folder.join("patterns.svg")).unwrap();
    assert!(figure.contains("<polyline") && figure.contains("share of the patterns"));

    // Files of one pattern have no content beside many.
    for key in ["csv = 'blades.csv'", "figure = 'blades.svg'"] {
        let (output, folder) = run("patterns_and_blades", &format!("{part}{key}\n"));
        let errors = crate::common::printed(&output.stderr);
        assert!(!output.status.success() && errors.contains("patterns_csv"), "{errors}");
        assert!(!folder.join("patterns.csv").exists());
    }
    fs::write(&file, "0.1 0.2\n").unwrap();
    let (output, _) = run("short_patterns", &part);
    let errors = crate::common::printed(&output.stderr);
    assert!(
        !output.status.success() && errors.contains("pattern 0") && errors.contains("24"),
        "{errors}"
    );
    fs::write(&file, "0.1 x\n").unwrap();
    let (output, _) = run("wrong_patterns", &part);
    let errors = crate::common::printed(&output.stderr);
    assert!(!output.status.success() && errors.contains("line 1: x"), "{errors}");
    fs::remove_file(&file).unwrap();
}

#[test]
fn a_wheel_that_cannot_be_made_is_refused_by_its_part() {
    for (name, keys, words) in [
        ("length", "dofs = [0]\npattern = [0.1]", "[wheel]"),
        ("dofs", &format!("dofs = [9]\npattern = {PATTERN}"), "9"),
        ("kind", "kind = 'colour'\npattern = [0.1]", "colour"),
    ] {
        let (output, _) = run(name, &format!("[wheel]\n{keys}\nfrom_hz = 209.0\nto_hz = 211.0\n"));
        assert!(!output.status.success());
        let errors = crate::common::printed(&output.stderr);
        assert!(errors.contains(words), "{errors}");
    }
}

/// The highest peak lies at 209.96 Hz: a range that ends before it tells so, for one wheel and for many.
#[test]
fn a_peak_beyond_the_range_is_told_and_not_counted() {
    let range = "from_hz = 209.0\nto_hz = 209.7\nharmonics = 3\nresponse_dof = 0\n";
    let (output, _) = run("beyond", &format!("[wheel]\ndofs = [0]\npattern = {PATTERN}\n{range}"));
    let text = crate::common::printed(&output.stdout) + &crate::common::printed(&output.stderr);
    assert!(!output.status.success(), "{text}");
    assert!(
        text.contains("the highest peak lies beyond an end of 209 to 209.7 Hz: at 209.7"),
        "{text}"
    );
    // The tuned wheel has its peak within 209.5 to 211 Hz, and one of much softer blades below.
    let file = std::env::temp_dir().join(format!("hbvib_beyond_{}.csv", std::process::id()));
    fs::write(&file, format!("{}\n{}\n", "0 ".repeat(24), "-0.3 ".repeat(24))).unwrap();
    let part = format!(
        "[wheel]\ndofs = [0]\npatterns = '{}'\nfrom_hz = 209.0\nto_hz = 211.0\nharmonics = 3\nresponse_dof = 0\n\
         patterns_csv = 'patterns.csv'\n",
        file.display()
    );
    let (output, folder) = run("patterns_beyond", &part);
    let text = crate::common::printed(&output.stdout) + &crate::common::printed(&output.stderr);
    assert!(
        !output.status.success() && text.contains("1 of 2 patterns have their highest peak beyond"),
        "{text}"
    );
    assert!(text.contains("the largest amplification is 1.0000"), "{text}");
    let csv = fs::read_to_string(folder.join("patterns.csv")).unwrap();
    assert!(csv.lines().nth(2).unwrap().contains("NaN"), "{csv}");
    fs::remove_file(&file).unwrap();
}
