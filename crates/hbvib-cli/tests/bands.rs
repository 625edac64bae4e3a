//! A job with `[band]`: the curves are those of the library's own calls, in the table and the figure, and what cannot be computed is
//! refused with the place in the job.

use std::fmt::Write;
use std::fs;

/// A wedge damper between a platform and a blade, and a part of the job.
fn run(name: &str, part: &str) -> (std::process::Output, std::path::PathBuf) {
    let matrices = crate::common::empty_folder("bands", &format!("{name}_matrices"));
    let mut job = String::new();
    for (key, blade, damper) in [("mass", 1.0, 0.01), ("damping", 0.04, 0.004), ("stiffness", 1.0, 1e-3)] {
        let path = matrices.join(format!("{key}.mtx"));
        let text = format!(
            "%%MatrixMarket matrix coordinate real symmetric\n3 3 3\n1 1 {blade}\n2 2 {damper}\n3 3 {damper}\n"
        );
        fs::write(&path, text).unwrap();
        let _ = writeln!(job, "model.{key} = '{}'", path.display());
    }
    for (blade, normal, tangent, mu) in [
        (-1, "[1, -1, 0]", "[1, 1, 0]", 0.6),
        (0, "[-1, -1, 0]", "[-1, 1, 0]", 0.15),
    ] {
        let _ = write!(
            job,
            "[[contact]]\nkind = 'friction_2d'\na = [1, 2, -1]\nb = [{blade}, -1, -1]\nkt = 1.0\nkn = 1.5\nmu = {mu}\n\
             normal = {normal}\ntangent = {tangent}\n"
        );
    }
    job += "[[force]]\ndof = 2\nharmonic = 0\nvalue = 1.0\n[[force]]\ndof = 0\nvalue = 0.02\n";
    crate::common::hbvib("run", ("bands", name), &(job + part))
}

#[test]
fn a_band_has_its_curves_and_that_of_the_peak() {
    let part = "[band]\nfrom_hz = 0.196\nto_hz = 0.2005\nharmonics = 5\ncsv = 'band.csv'\nfigure = 'band.svg'\n";
    let (output, folder) = run("curves", part);
    let (text, errors) = (
        crate::common::printed(&output.stdout),
        crate::common::printed(&output.stderr),
    );
    assert!(output.status.success(), "{text}{errors}");
    assert!(
        text.contains("1 slider free") && text.contains("band of it from 1.7"),
        "{text}"
    );
    let csv = fs::read_to_string(folder.join("band.csv")).unwrap();
    let mut lines = csv.lines();
    assert_eq!(lines.next(), Some("hz,amplitude,lower,upper,free_sliders"));
    let rows: Vec<Vec<f64>> = lines
        .map(|line| line.split(',').map(|x| x.parse().unwrap()).collect())
        .collect();
    assert!(rows.len() > 5);
    for row in &rows {
        let [_, amplitude, lower, upper, sliders] = row[..] else {
            panic!("{row:?}")
        };
        assert!(lower <= amplitude * (1.0 + 1e-9) && amplitude <= upper * (1.0 + 1e-9));
        assert!((sliders - 1.0).abs() < 0.1 && upper > 1.05 * lower, "{row:?}");
    }
    let figure = fs::read_to_string(folder.join("band.svg")).unwrap();
    assert!(figure.contains("<polygon") && figure.contains("residual forces"));
}

#[test]
fn a_band_that_cannot_be_computed_is_refused_by_its_part() {
    let (output, _) = run(
        "starts",
        "[band]\nfrom_hz = 0.19\nto_hz = 0.2\nharmonics = 3\nstarts = 0\n",
    );
    assert!(!output.status.success());
    assert!(crate::common::printed(&output.stderr).contains("[band]: starts = 0"));
}

#[test]
fn the_wedge_dampers_of_the_examples_are_checked() {
    let job = crate::common::root().join("examples/jobs/wedge_damper/job.toml");
    let output = crate::common::command(&["check", job.to_str().unwrap()], &crate::common::root());
    assert!(output.status.success(), "{}", crate::common::printed(&output.stderr));
}
