//! A job that compares its peak with integration in time: with enough harmonics both are the same, and with few, which
//! miss the resonances of the light ring among the high ones, the peak is further away.

use std::process::Output;

fn printed(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}

/// Runs the ring damper with a number of harmonics.
fn run(name: &str, harmonics: usize, more: &str) -> (Output, String) {
    let job = format!(
        "{}[[contact]]\nkind = 'jenkins'\na = [2]\nb = [3]\nkt = 5e7\nmu = 0.3\npreload = 488.5454178539233\n\
         [[force]]\ndof = 0\nvalue = 5.0\n[[force]]\ndof = 1\nvalue = 5.0\n\
         [forced]\nfrom_hz = 207.0\nto_hz = 211.0\nharmonics = {harmonics}\n\
         [verify]\ncsv = 'verify.csv'\n{more}\n",
        crate::common::ring_damper()
    );
    let (output, folder) = crate::common::hbvib("run", ("verify", name), &job);
    let csv = std::fs::read_to_string(folder.join("verify.csv")).unwrap_or_default();
    (output, csv)
}

/// The columns of the one row.
fn row(csv: &str) -> Vec<f64> {
    assert_eq!(csv.lines().count(), 2, "{csv}");
    csv.lines()
        .nth(1)
        .unwrap()
        .split(',')
        .map(|x| x.parse().unwrap())
        .collect()
}

#[test]
fn the_peak_is_the_motion_that_time_integration_finds() {
    let (output, csv) = run("many", 127, "points = 'highest_peak'");
    let text = printed(&output.stdout);
    assert!(output.status.success(), "{text}{}", printed(&output.stderr));
    assert!(text.contains("verify") && text.contains(" same:"), "{text}");
    let many = row(&csv);
    assert!(
        (many[2] - 1.0).abs() < 1e-12 && many[3] < 1e-5 && many[6] < 1e-5,
        "{csv}"
    );
    let (output, csv) = run("few", 9, "");
    let few = row(&csv);
    assert!(output.status.success() && few[3] > 1e-2 && few[3] < 0.1, "{csv}");
    let (output, _) = run("strict", 1, "same_within = 1e-9");
    assert_eq!(output.status.code(), Some(3));
    assert!(printed(&output.stdout).contains("another solution"));
}

#[test]
fn points_that_are_not_there_are_an_error() {
    let (output, _) = run("none", 1, "points = 'requested'");
    assert_eq!(output.status.code(), Some(1));
    assert!(printed(&output.stderr).contains("none of the named points"));
}
