//! A job with `[solutions]`: a mass against a stop moves with the double period beyond a frequency, in the table, the summary and the
//! figure.

use std::f64::consts::TAU;
use std::path::Path;

#[test]
fn the_motion_of_the_double_period_is_in_every_output() {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("one_for_solutions.mtx");
    std::fs::write(
        &path,
        "%%MatrixMarket matrix coordinate real symmetric\n1 1 1\n1 1 1.0\n",
    )
    .unwrap();
    let one = path.display().to_string();
    let job = format!(
        "model.stiffness = '{one}'\nmodel.mass = '{one}'\nmodel.rayleigh = [0.05, 0.0]\n\
         [[contact]]\nkind = 'unilateral'\na = [0]\nkn = 10\n[[force]]\ndof = 0\nvalue = 1\n\
         [forced]\nfrom_hz = {}\nto_hz = {}\nharmonics = 15\n\
         [solutions]\nbranches = 1\ndepth = 1\ncsv = 'all.csv'\nfigure = 'all.svg'\n",
        2.3 / TAU,
        2.45 / TAU
    );
    let (output, folder) = crate::common::hbvib("run", ("solutions", "doubled"), &job);
    let screen = String::from_utf8_lossy(&output.stdout);
    assert!(
        output.status.success(),
        "{screen}{}",
        String::from_utf8_lossy(&output.stderr)
    );
    assert!(screen.contains("branch 1 of 0: double period"), "{screen}");
    assert!(
        screen.contains("sought from 1 bifurcation (0 without a branch, 0 left)"),
        "{screen}"
    );
    let csv = std::fs::read_to_string(folder.join("all.csv")).unwrap();
    let child: Vec<Vec<f64>> = csv
        .lines()
        .skip(1)
        .map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect())
        .filter(|row: &Vec<f64>| row[0] > 0.5)
        .collect();
    assert!(child.len() > 3);
    for row in &child {
        assert!((row[2] - 2.0).abs() < 0.5 && row[6] < 0.5, "{row:?}");
        // From the doubling at 2.3594 on, in frequencies of the force.
        assert!(row[3] * TAU > 2.358 && row[3] * TAU < 2.45 + 1e-9, "{row:?}");
    }
    let svg = std::fs::read_to_string(folder.join("all.svg")).unwrap();
    assert!(svg.matches("<polyline").count() > 4);
}
