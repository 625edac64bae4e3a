//! A job with `[study]`: the peak of the ring damper over the normal load has the optimum of the reference, in the summary,
//! the table and the figure.

fn run(name: &str, study: &str) -> (std::process::Output, std::path::PathBuf) {
    let job = format!(
        "{}[[contact]]\nkind = 'jenkins'\na = [2]\nb = [3]\nkt = 5e7\nmu = 0.3\npreload = 300.0\n\
         [[force]]\ndof = 0\nvalue = 5.0\n[[force]]\ndof = 1\nvalue = 5.0\n[study]\n{study}\n",
        crate::common::ring_damper()
    );
    crate::common::hbvib("run", ("study", name), &job)
}

#[test]
fn peak_over_the_normal_load_has_its_optimum() {
    let (output, folder) = run(
        "peak",
        "parameter = 'preload'\nfrom = 300\nto = 800\nnear_hz = 208.1\nharmonics = 9\nresponse_dof = 0\n\
         csv = 'study.csv'\nfigure = 'study.svg'",
    );
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(text.contains("minimum of amplitude 1.415704e-3 at 4.82852"), "{text}");
    assert!(text.contains("208.796528 Hz"), "{text}");
    let csv = std::fs::read_to_string(folder.join("study.csv")).unwrap();
    let first: Vec<f64> = csv
        .lines()
        .nth(1)
        .unwrap()
        .split(',')
        .map(|cell| cell.parse().unwrap())
        .collect();
    for (found, known) in first
        .iter()
        .zip([300.0, 208.097_030_8, 1.934_880_98e-3, -8.294_694_7e-6, 9.0])
    {
        assert!((found / known - 1.0).abs() < 1e-6, "{found} {known}");
    }
    assert!(
        std::fs::read_to_string(folder.join("study.svg"))
            .unwrap()
            .starts_with("<svg")
    );
}

#[test]
fn largest_damping_does_not_depend_on_the_normal_load() {
    let (output, folder) = run(
        "damping",
        "parameter = 'preload'\nfrom = 300\nto = 500\nnear_hz = 209.9\nfollow = 'mode_max_damping'\nharmonics = 3\n\
         csv = 'study.csv'",
    );
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let csv = std::fs::read_to_string(folder.join("study.csv")).unwrap();
    let column: Vec<f64> = csv
        .lines()
        .skip(1)
        .map(|l| l.split(',').nth(2).unwrap().parse().unwrap())
        .collect();
    assert!(csv.starts_with("parameter,hz,damping_ratio,derivative"));
    assert!(
        column.len() > 3 && column.iter().all(|d| (d / column[0] - 1.0).abs() < 1e-8),
        "{column:?}"
    );
}

#[test]
fn contact_of_a_factor_and_a_range_without_peak_are_refused() {
    for (name, study, sentence) in [
        (
            "factor",
            "parameter = 'mass'\ncontact = 0\nfrom = 1\nto = 2\nnear_hz = 208",
            "needs a constant of a contact",
        ),
        (
            "far",
            "parameter = 'preload'\nfrom = 300\nto = 800\nnear_hz = 20",
            "has no peak",
        ),
    ] {
        let (output, _) = run(name, study);
        let text = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(
            !output.status.success() && text.contains("[study]") && text.contains(sentence),
            "{text}"
        );
    }
}
