//! A job with `[band]`: the curves are those of the library's own calls, in the table and the figure, and what cannot be computed is
//! refused with the place in the job.

use std::fmt::Write;
use std::fs;

/// A wedge damper between a platform and a blade, and a part of the job.
pub fn run(name: &str, part: &str) -> (std::process::Output, std::path::PathBuf) {
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

/// A blade with a damper under its platform from geometry.
const DAMPER: &str = "
[[damper]]
name = 'wedge'
mass = 0.01
radius = 0.05
length = 0.2
orbit = 25
support = [1e-3, 1e-4]
support_damping = [4e-3, 1e-5]

[[damper.face]]
dofs = [-1, -1, -1]
angle = -0.7853981633974483
kt = 1.0
kn = 1.5
mu = 0.6

[[damper.face]]
dofs = [0, -1, -1]
angle = 0.7853981633974483
kt = 1.0
kn = 1.5
mu = 0.15

[[force]]
dof = 0
value = 0.02

[forced]
from_hz = 0.19
to_hz = 0.21
harmonics = 5
response_dof = 0

[output]
csv = 'response.csv'
npz = 'response.npz'
slip_csv = 'slip.csv'
";

fn blade(name: &str, more: &str) -> (std::process::Output, std::path::PathBuf) {
    let matrices = crate::common::empty_folder("bands", &format!("{name}_matrices"));
    let mut job = String::from("model.speed = 2.0\n");
    for (key, value) in [("mass", 1.0), ("stiffness", 1.0), ("damping", 0.04)] {
        let path = matrices.join(format!("{key}.mtx"));
        let text = format!("%%MatrixMarket matrix coordinate real symmetric\n1 1 1\n1 1 {value}\n");
        fs::write(&path, text).unwrap();
        let _ = writeln!(job, "model.{key} = '{}'", path.display());
    }
    crate::common::hbvib("run", ("bands", name), &(job + more))
}

#[test]
fn a_damper_of_a_job_is_that_of_the_library() {
    let (output, folder) = blade("damper", DAMPER);
    let (text, errors) = (
        crate::common::printed(&output.stdout),
        crate::common::printed(&output.stderr),
    );
    assert!(output.status.success(), "{text}{errors}");
    assert!(
        text.contains("from 4 degrees of freedom") && text.contains("of 2 contacts"),
        "{text}"
    );

    let mut model = hbvib::Model::new(1).unwrap();
    for (kind, value) in [
        (hbvib::MatrixKind::Mass, 1.0),
        (hbvib::MatrixKind::Stiffness, 1.0),
        (hbvib::MatrixKind::Damping, 0.04),
    ] {
        model.set_matrix(kind, &hbvib::MatrixView::dense(1, &[value])).unwrap();
    }
    let face = hbvib::DamperFace {
        angle: -std::f64::consts::FRAC_PI_4,
        stiffness: [1.0, 1.5],
        mu: 0.6,
        ..hbvib::DamperFace::default()
    };
    let faces = [
        face,
        hbvib::DamperFace {
            dofs: [Some(0), None, None],
            angle: -face.angle,
            mu: 0.15,
            ..face
        },
    ];
    let damper = hbvib::Damper {
        mass: 0.01,
        radius: 0.05,
        length: 0.2,
        orbit: 25.0,
        support: [1e-3, 1e-4],
        support_damping: [4e-3, 1e-5],
        faces: &faces,
        ..hbvib::Damper::default()
    };
    model.add_damper(&damper).unwrap();
    model.set_speed(hbvib::Speed::Fixed(2.0)).unwrap();
    model.add_force(0, 1, 0.02.into()).unwrap();
    let solver = hbvib::SolverOptions {
        harmonics: 5,
        tolerance: 0.0,
        response_dof: Some(0),
        ..hbvib::SolverOptions::default()
    };
    let range = hbvib::ForcedOptions {
        omega_start: 0.19 * std::f64::consts::TAU,
        omega_stop: 0.21 * std::f64::consts::TAU,
        ..hbvib::ForcedOptions::default()
    };
    let branch = hbvib::forced_response(&model, &solver, &range, &mut hbvib::Hooks::default()).unwrap();
    let peak = branch.peaks()[0].amplitude;
    let rest = text.split("peak ").nth(1).unwrap();
    let found: f64 = rest.split_whitespace().nth(2).unwrap().parse().unwrap();
    assert!((found / peak - 1.0).abs() < 1e-5, "{found} {peak}");
    let slip = fs::read_to_string(folder.join("slip.csv")).unwrap();
    assert!(slip.lines().next().unwrap().contains("wedge[0]"), "{slip}");
}

#[test]
fn dampers_that_cannot_be_added_are_refused_by_their_face() {
    for (from, to, words) in [
        (
            "dofs = [0, -1, -1]",
            "dofs = [0, -1]",
            "[[damper]] 1: face[1]: dofs has 2 entries",
        ),
        ("dofs = [0, -1, -1]", "dofs = [7, -1, -1]", "[[damper]] 1"),
        ("dofs = [0, -1, -1]", "dofs = ['12.1', -1, -1]", "face[1]: dofs[0]"),
        ("mass = 0.01", "mass = 0.0", "mass = 0"),
        ("orbit = 25", "orbits = 25", "orbit"),
    ] {
        let (output, _) = blade("refused_damper", &DAMPER.replace(from, to));
        let errors = crate::common::printed(&output.stderr);
        assert!(!output.status.success() && errors.contains(words), "{errors}");
    }
}
