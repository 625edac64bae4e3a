//! Figures of stored responses: their points, axes, harmonics and labels, and files that have none of these.

use std::path::Path;
use std::process::{Command, Output};

fn plot(folder: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_hbvib"));
    command
        .arg("plot")
        .args(arguments)
        .current_dir(folder)
        .output()
        .unwrap()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// Corners of the longest line of a figure.
fn longest(svg: &str) -> Vec<(f64, f64)> {
    let lines = svg.split("<polyline").skip(1).map(|part| {
        let points = part.split("points=\"").nth(1).unwrap().split('"').next().unwrap();
        let pairs = points.split_whitespace().map(|pair| pair.split_once(',').unwrap());
        pairs
            .map(|(x, y)| (x.parse().unwrap(), y.parse().unwrap()))
            .collect::<Vec<(f64, f64)>>()
    });
    lines.max_by_key(Vec::len).unwrap()
}

#[test]
fn a_stored_response_is_drawn_on_either_axis() {
    let job = format!(
        "{}[[contact]]\nkind = 'jenkins'\na = [2]\nb = [3]\nkt = 5e7\nmu = 0.3\npreload = 488.5\n[[force]]\ndof = 0\nvalue = 5.0\n\
         [[response]]\ndofs = [0]\n[[response]]\ndofs = [3]\nmeasure = 'peak'\n[forced]\nfrom_hz = 205.0\nto_hz = 212.0\nharmonics = 3\n\
         [output]\nnpz = 'a.npz'\ncsv = 'a.csv'\n",
        crate::common::ring_damper()
    );
    let (output, folder) = crate::common::hbvib("run", ("plots", "response"), &job);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let drawn = |arguments: &[&str]| -> String {
        let output = plot(&folder, &[&["a.npz", "--output", "a.svg"], arguments].concat());
        assert!(output.status.success(), "{arguments:?}: {}", text(&output.stderr));
        assert_eq!(text(&output.stdout), "wrote a.svg\n");
        std::fs::read_to_string(folder.join("a.svg")).unwrap()
    };
    let table = std::fs::read_to_string(folder.join("a.csv")).unwrap();
    let rows: Vec<Vec<f64>> = table
        .lines()
        .skip(1)
        .map(|row| row.split(',').map(|x| x.parse().unwrap()).collect())
        .collect();
    // A line of plotters is one of its points; heights are linear in the amplitude, or in its logarithm.
    for (arguments, of) in [(&[][..], (|a| a) as fn(f64) -> f64), (&["--log-y"], f64::log10)] {
        let svg = drawn(&[arguments, &["--unit", "mm", "--title", "ring damper"]].concat());
        for words in ["frequency, Hz", "amplitude, mm", "ring damper"] {
            assert!(svg.contains(words), "{words}");
        }
        let line = longest(&svg);
        assert_eq!(line.len(), rows.len());
        let last = rows.len() - 1;
        let highest = (0..rows.len())
            .max_by(|i, j| rows[*i][1].total_cmp(&rows[*j][1]))
            .unwrap();
        let share = |i: usize| (line[i].1 - line[0].1) / (line[highest].1 - line[0].1);
        let expected = |i: usize| (of(rows[i][1]) - of(rows[0][1])) / (of(rows[highest][1]) - of(rows[0][1]));
        for i in [last / 4, last / 2, last] {
            // Pixels are whole.
            assert!(
                (share(i) - expected(i)).abs() < 0.01,
                "{arguments:?}: {} {}",
                share(i),
                expected(i)
            );
        }
    }
    assert!(drawn(&["--markers"]).matches("<circle").count() > rows.len());
    let svg = drawn(&["--dof", "0"]);
    assert!(svg.contains("harmonic 1") && svg.contains("harmonic 3") && !svg.contains("harmonic 2"));
    assert!(!drawn(&["--dof", "0", "--harmonic", "1"]).contains("harmonic 3"));
    assert!(drawn(&["--slip"]).contains("slip fraction"));
    drawn(&["--response", "1", "--log-x"]);
    std::fs::copy(folder.join("a.npz"), folder.join("b.npz")).unwrap();
    let svg = drawn(&["b.npz"]);
    assert!(
        svg.lines().filter(|line| matches!(line.trim(), "a" | "b")).count() == 2,
        "no legend"
    );
    let output = plot(&folder, &["a.npz", "--output", "a.png"]);
    assert!(output.status.success() && std::fs::read(folder.join("a.png")).unwrap().starts_with(b"\x89PNG"));
    std::fs::write(folder.join("bad.npz"), "no archive").unwrap();
    for (arguments, words) in [
        (&["a.npz", "--dof", "4"][..], "needs --dof 0 to 3"),
        (&["a.npz", "--response", "2"], "has 2 responses"),
        (&["a.npz", "--damping"], "no nonlinear mode"),
        (&["a.npz", "--harmonic", "1"], "--dof"),
        (&["bad.npz"], "bad.npz"),
        (&["none.npz"], "none.npz"),
        (&[], "<RESPONSE.NPZ>"),
    ] {
        let output = plot(&folder, arguments);
        let errors = text(&output.stderr);
        assert!(
            output.status.code() == Some(1) && errors.contains(words),
            "{arguments:?}: {errors}"
        );
    }
}

/// Node and direction name a degree of freedom in files, in figures and to `plot`.
#[test]
fn nodes_have_their_names_in_files_and_figures() {
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/block");
    let names = std::fs::read_to_string(data.with_extension("dof")).unwrap();
    let names: Vec<&str> = names.split_whitespace().collect();
    let last = names[names.len() - 1];
    let job = format!(
        "model.matrices = '{}.sti'\nmodel.rayleigh = [0.0, 1e-7]\n[[force]]\ndof = '{last}'\nvalue = 1.0\n\
         [forced]\nfrom_hz = 100.0\nto_hz = 110.0\nharmonics = 1\nresponse_dof = '{last}'\n\
         [output]\nnpz = 'a.npz'\nfigure = 'a.svg'\nunits.length = 'mm'\n",
        data.display()
    );
    let (output, folder) = crate::common::hbvib("run", ("plots", "names"), &job);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let told = format!("response degree of freedom {} ({last})\n", names.len() - 1);
    assert!(text(&output.stdout).contains(&told), "{}", text(&output.stdout));
    let figure = std::fs::read_to_string(folder.join("a.svg")).unwrap();
    assert!(figure.contains(&format!("amplitude of {last}, mm")));
    let arrays = hbvib_io::read_number_arrays(&folder.join("a.npz")).unwrap();
    let dofs = arrays.iter().find(|array| array.name == "dofs").unwrap();
    let rows: Vec<String> = dofs
        .real
        .chunks(2)
        .map(|row| format!("{}.{}", row[0], row[1]))
        .collect();
    assert_eq!(rows, names);
    let drawn = |dof: &str| {
        let output = plot(&folder, &["a.npz", "--dof", dof, "--output", "b.svg"]);
        assert!(output.status.success(), "{}", text(&output.stderr));
        std::fs::read_to_string(folder.join("b.svg")).unwrap()
    };
    let (by_name, by_number) = (drawn(last), drawn(&(names.len() - 1).to_string()));
    assert_eq!(longest(&by_name), longest(&by_number));
    assert!(by_name.contains(&format!("amplitude of {last}")) && by_name != drawn(names[0]));
    for (dof, words) in [
        ("987.1", "--dof 987.1: the file has no such node and direction"),
        ("tip", "--dof tip, needs a number from 0, or node and direction as 12.3"),
    ] {
        let errors = text(&plot(&folder, &["a.npz", "--dof", dof]).stderr);
        assert!(errors.contains(words), "{errors}");
    }
}

/// A reader that has enough closes the pipe.
#[test]
#[cfg(unix)]
fn a_closed_pipe_is_no_error() {
    let mut command = Command::new("sh");
    command
        .args(["-c", "\"$HBVIB\" schema | true"])
        .env("HBVIB", env!("CARGO_BIN_EXE_hbvib"));
    let output = command.output().unwrap();
    assert!(
        output.status.success() && output.stderr.is_empty(),
        "{}",
        text(&output.stderr)
    );
}
