//! A job with `[[response]]`: its table and summary have the responses of the library, and mistakes are told.

use crate::common::{hbvib, ring_damper};

/// A job on the ring damper, with further tables and an analysis.
fn job(responses: &str, analysis: &str) -> String {
    format!(
        "{}[[contact]]\nkind = 'jenkins'\na = [2]\nb = [3]\nkt = 5e7\nmu = 0.3\npreload = 488.5\n\
         [[force]]\ndof = 0\nvalue = 5.0\n{responses}\n{analysis}\n[output]\ncsv = 'response.csv'\nnpz = 'response.npz'\n",
        ring_damper()
    )
}

const SWEEP: &str = "[forced]\nfrom_hz = 207.0\nto_hz = 211.0\nharmonics = 5";

#[test]
fn responses_are_columns_and_lines_of_the_summary() {
    let two = "[[response]]\ndofs = [0]\n[[response]]\ndofs = [0, 1]\nweights = [1.0, -1.0]\nmeasure = 'rms'\ncomponent = 'velocity'\nsector = 3";
    let (output, folder) = hbvib("run", ("response_tables", "two"), &job(two, SWEEP));
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(
        output.status.success(),
        "{text}{}",
        String::from_utf8_lossy(&output.stderr)
    );
    let csv = std::fs::read_to_string(folder.join("response.csv")).unwrap();
    let head: Vec<&str> = csv.lines().next().unwrap().split(',').collect();
    assert_eq!(head[head.len() - 2..], ["response_0", "response_1"]);
    for line in csv.lines().skip(1) {
        let row: Vec<f64> = line.split(',').map(|x| x.parse().unwrap()).collect();
        // The first one leads; a motion in one harmonic has the RMS ω|X|/√2, and more with several.
        assert!((row[1] - row[row.len() - 2]).abs() <= 1e-12 * row[1]);
        assert!(row[row.len() - 1] > 0.0);
    }
    // The highest peak of each, that of the first as the peak of the branch.
    let peak = text.lines().find(|line| line.starts_with("peak")).unwrap();
    let numbers: Vec<&str> = peak.split_whitespace().collect();
    let first = text.lines().find(|line| line.starts_with("response 0:")).unwrap();
    assert!(first.contains(numbers[1]) && first.contains(numbers[3]), "{text}");
    assert!(
        text.lines()
            .any(|line| line.starts_with("response 1: 1 peak, the highest")),
        "{text}"
    );
}

/// A response that hardly moves needs its own harmonics, unless the norm of all is what counts.
#[test]
fn a_tolerance_for_all_together_needs_fewer_harmonics() {
    let two = "[[response]]\ndofs = [2]\n[[response]]\ndofs = [2]\nmeasure = 'harmonic'\nharmonic = 7";
    let run = |name: &str, more: &str| {
        let analysis = format!("[forced]\nfrom_hz = 207.0\nto_hz = 211.0\ntolerance = 1e-3\n{more}");
        let (output, folder) = hbvib("run", ("response_tables", name), &job(two, &analysis));
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        let csv = std::fs::read_to_string(folder.join("response.csv")).unwrap();
        let place = csv
            .lines()
            .next()
            .unwrap()
            .split(',')
            .position(|word| word.contains("harmonics"));
        let place = place.unwrap_or_else(|| panic!("{}", csv.lines().next().unwrap()));
        let of = |line: &str| line.split(',').nth(place).unwrap().parse::<f64>().unwrap();
        csv.lines().skip(1).map(of).fold(0.0, f64::max)
    };
    let (each, all) = (run("each", ""), run("together", "together = true"));
    assert!(each > all, "{each} and {all}");
}

#[test]
fn mistakes_in_responses_are_told() {
    for (name, responses, analysis, words) in [
        (
            "together",
            "",
            "[forced]\nfrom_hz = 207.0\nto_hz = 211.0\ntogether = true",
            "together needs [[response]]",
        ),
        (
            "measure",
            "[[response]]\ndofs = [0]\nmeasure = 'loudest'",
            SWEEP,
            "loudest",
        ),
        (
            "harmonic",
            "[[response]]\ndofs = [0]\nharmonic = 3",
            SWEEP,
            "harmonic goes with measure",
        ),
        ("dof", "[[response]]\ndofs = [4]", SWEEP, "dofs"),
        (
            "weights",
            "[[response]]\ndofs = [0]\nweights = [1.0, 2.0]",
            SWEEP,
            "responses[0]: weights has 2 numbers",
        ),
        (
            "analysis",
            "[[response]]\ndofs = [0]",
            "[mode]\nlog10_from = -6\nlog10_to = -3",
            "[[response]] needs [forced]",
        ),
    ] {
        let (output, folder) = hbvib("run", ("response_tables", name), &job(responses, analysis));
        let errors = String::from_utf8(output.stderr).unwrap();
        assert!(!output.status.success() && errors.contains(words), "{name}: {errors}");
        assert!(!folder.join("response.csv").exists(), "{name}");
    }
}
