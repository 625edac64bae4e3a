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

/// The opposed mode of two equal masses on hardening springs has two localised ones beside it, in a job with `[mode]`.
#[test]
fn curves_that_branch_off_from_a_mode_are_in_every_output() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let (mass, stiffness) = (folder.join("two_masses.mtx"), folder.join("two_springs.mtx"));
    for (path, rows) in [
        (&mass, "2 2 2\n1 1 1.0\n2 2 1.0\n"),
        (&stiffness, "2 2 3\n1 1 1.1\n2 1 -0.1\n2 2 1.1\n"),
    ] {
        std::fs::write(path, format!("%%MatrixMarket matrix coordinate real symmetric\n{rows}")).unwrap();
    }
    let contact = |dof| format!("[[contact]]\nkind = 'cubic'\na = [{dof}]\ncubic = 1\n");
    let job = format!(
        "model.stiffness = '{}'\nmodel.mass = '{}'\n{}{}\
         [mode]\nindex = 1\nlog10_from = -1\nlog10_to = 0.5\nharmonics = 3\n\
         [solutions]\ncsv = 'all.csv'\nfigure = 'all.svg'\n",
        stiffness.display(),
        mass.display(),
        contact(0),
        contact(1)
    );
    let (output, folder) = crate::common::hbvib("run", ("solutions", "of_mode"), &job);
    let screen = String::from_utf8_lossy(&output.stdout);
    assert!(
        output.status.success(),
        "{screen}{}",
        String::from_utf8_lossy(&output.stderr)
    );
    for number in [1, 2] {
        assert!(
            screen.contains(&format!("branch {number} of 0: branch point")),
            "{screen}"
        );
    }
    assert!(
        screen.contains("sought from 1 bifurcation (0 without a branch, 0 left)"),
        "{screen}"
    );
    let csv = std::fs::read_to_string(folder.join("all.csv")).unwrap();
    assert!(csv.lines().any(|line| line.starts_with("2,0,1,")));
    assert!(folder.join("all.svg").exists());
}

/// Between the folds of a hardening spring both stable motions have a kick across the unstable one, that which the library finds; without a
/// frequency the job is refused.
#[test]
fn the_kicks_between_two_motions_are_those_of_the_library() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let (one, damping) = (folder.join("one_for_kicks.mtx"), folder.join("damping_for_kicks.mtx"));
    for (path, value) in [(&one, "1.0"), (&damping, "0.05")] {
        let text = format!("%%MatrixMarket matrix coordinate real symmetric\n1 1 1\n1 1 {value}\n");
        std::fs::write(path, text).unwrap();
    }
    let job = |more: &str| {
        format!(
            "model.stiffness = '{0}'\nmodel.mass = '{0}'\nmodel.damping = '{1}'\n\
             [[contact]]\nkind = 'cubic'\na = [0]\ncubic = 0.3\n[[force]]\ndof = 0\nvalue = 0.2\n\
             [forced]\nfrom_hz = {2}\nto_hz = {3}\nharmonics = 9\n{more}",
            one.display(),
            damping.display(),
            0.8 / TAU,
            2.2 / TAU
        )
    };
    let whole = format!(
        "at_hz = [{}]\n[solutions]\nkick = {{ dof = 0, csv = 'kicks.csv' }}\n",
        1.5 / TAU
    );
    let (output, folder) = crate::common::hbvib("run", ("solutions", "kicks"), &job(&whole));
    let screen = String::from_utf8_lossy(&output.stdout);
    let failure = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{screen}{failure}");
    let csv = std::fs::read_to_string(folder.join("kicks.csv")).unwrap();
    let rows: Vec<Vec<f64>> = csv
        .lines()
        .skip(1)
        .map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect())
        .collect();
    // Two stable motions, one saddle between them.
    assert_eq!(rows.len(), 2, "{csv}\n{screen}");
    let mut model = hbvib::Model::new(1).unwrap();
    for (kind, value) in [
        (hbvib::MatrixKind::Mass, 1.0),
        (hbvib::MatrixKind::Damping, 0.05),
        (hbvib::MatrixKind::Stiffness, 1.0),
    ] {
        model.set_matrix(kind, &hbvib::MatrixView::dense(1, &[value])).unwrap();
    }
    model.add_contact(&hbvib::Contact::cubic(0, None, 0.0, 0.3)).unwrap();
    model.add_force(0, 1, 0.2.into()).unwrap();
    let solver = hbvib::SolverOptions {
        harmonics: 9,
        tolerance: 0.0,
        stability: Some(hbvib::Waves::Wave),
        ..hbvib::SolverOptions::default()
    };
    let at = [1.5];
    let range = hbvib::ForcedOptions {
        omega_start: 0.8,
        omega_stop: 2.2,
        at: &at,
        ..hbvib::ForcedOptions::default()
    };
    let hooks = &mut hbvib::Hooks::default();
    let branch = hbvib::forced_response(&model, &solver, &range, hooks).unwrap();
    // Between the folds the middle one of three motions is the saddle.
    let mut motions = branch.at(0).to_vec();
    motions.sort_by(|a, b| a.amplitude.total_cmp(&b.amplitude));
    let [_, saddle, _] = motions[..] else {
        panic!("{motions:?}")
    };
    for row in &rows {
        let from = branch
            .at(0)
            .iter()
            .find(|s| (s.amplitude / row[2] - 1.0).abs() < 1e-6)
            .unwrap();
        let places = ((&branch, from.point), (&branch, saddle.point));
        let kick = hbvib::smallest_kick(&model, places.0, places.1, (0, 16), hooks).unwrap();
        assert!((row[4] / saddle.amplitude - 1.0).abs() < 1e-6, "{row:?}");
        // The mirror image half a period later is as small.
        assert!(
            (row[5].abs() / kick.impulse.abs() - 1.0).abs() < 1e-3,
            "{row:?} {kick:?}"
        );
        assert!(row[12] > 0.5 && row[6].abs() < row[5].abs(), "{row:?}");
    }
    assert_eq!(screen.matches("leads across").count(), 2, "{screen}");
    let without = "[solutions]\nkick = { dof = 0 }\n".to_owned();
    for (name, part, words) in [
        ("kicks_nowhere", without, "needs at_hz"),
        (
            "kicks_outside",
            whole.replace("dof = 0", "dof = 7"),
            "dof = 7, needs 0 .. 1",
        ),
    ] {
        let (output, _) = crate::common::hbvib("run", ("solutions", name), &job(&part));
        let failure = String::from_utf8_lossy(&output.stderr);
        assert!(!output.status.success() && failure.contains(words), "{failure}");
    }
}
