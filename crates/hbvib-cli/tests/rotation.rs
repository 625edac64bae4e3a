//! Jobs with every key of damping and rotation: their results are those of the same model built in Rust, and each key
//! has an effect.

use hbvib::{
    Contact, ForcedOptions, Hooks, LinearContacts, MatrixKind, MatrixView, ModeOptions, Model, SolverOptions, Speed,
    campbell, forced_response, nonlinear_mode,
};
use num_complex::Complex64;
use std::f64::consts::TAU;
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};

const N: usize = 4;
const RPM: f64 = TAU / 60.0;

/// A matrix of the model: its key in a job, its kind, its own numbers and those to the next sector, by rows.
struct Given {
    key: &'static str,
    kind: MatrixKind,
    own: [f64; 16],
    next: Option<[f64; 16]>,
}

const SOFTENING: [f64; 16] = [
    -0.2, 0.05, 0.0, 0.0, 0.05, -0.1, 0.0, 0.0, 0.0, 0.0, 0.15, 0.02, 0.0, 0.0, 0.02, -0.05,
];

fn given() -> Vec<Given> {
    vec![
        Given {
            key: "mass",
            kind: MatrixKind::Mass,
            own: [
                1.0, 0.0, 0.0, 0.0, 0.0, 1.1, 0.0, 0.0, 0.0, 0.0, 0.6, 0.1, 0.0, 0.0, 0.1, 0.7,
            ],
            next: Some([
                0.0, 0.02, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.01, 0.0, 0.0, 0.0, 0.0, 0.0,
            ]),
        },
        Given {
            key: "stiffness",
            kind: MatrixKind::Stiffness,
            own: [
                3.0, -1.0, 0.2, 0.0, -1.0, 4.0, -0.5, 0.1, 0.2, -0.5, 5.0, -1.0, 0.0, 0.1, -1.0, 3.5,
            ],
            next: Some([
                -0.3, 0.1, 0.0, 0.0, 0.0, -0.2, 0.05, 0.0, 0.0, 0.0, -0.1, 0.0, 0.02, 0.0, 0.0, -0.25,
            ]),
        },
        Given {
            key: "damping",
            kind: MatrixKind::Damping,
            own: [
                0.02, 0.0, 0.0, 0.0, 0.0, 0.03, 0.0, 0.0, 0.0, 0.0, 0.02, 0.0, 0.0, 0.0, 0.0, 0.01,
            ],
            next: None,
        },
        Given {
            key: "structural",
            kind: MatrixKind::Structural,
            own: [
                0.05, 0.01, 0.0, 0.0, 0.01, 0.04, 0.0, 0.0, 0.0, 0.0, 0.06, 0.0, 0.0, 0.0, 0.0, 0.03,
            ],
            next: None,
        },
        Given {
            key: "gyroscopic",
            kind: MatrixKind::Gyroscopic,
            own: [
                0.0, 0.5, 0.0, -0.2, -0.5, 0.0, 0.3, 0.0, 0.0, -0.3, 0.0, 0.4, 0.2, 0.0, -0.4, 0.0,
            ],
            next: Some([
                0.05, 0.1, 0.0, 0.0, -0.02, 0.0, 0.0, 0.03, 0.0, 0.0, 0.04, 0.0, 0.0, 0.0, 0.01, 0.0,
            ]),
        },
        Given {
            key: "stiffness_speed2",
            kind: MatrixKind::StiffnessSpeed2,
            own: SOFTENING,
            next: Some(SOFTENING.map(|k| 0.2 * k)),
        },
    ]
}

fn matrix_market(path: &Path, a: &[f64; 16]) {
    let entries: Vec<String> = (0..16)
        .filter(|&i| a[i] != 0.0)
        .map(|i| format!("{} {} {:?}", i / N + 1, i % N + 1, a[i]))
        .collect();
    let head = "%%MatrixMarket matrix coordinate real general";
    let text = format!("{head}\n{N} {N} {}\n{}\n", entries.len(), entries.join("\n"));
    fs::write(path, text).unwrap();
}

/// By columns.
fn columns(a: &[f64; 16]) -> [f64; 16] {
    std::array::from_fn(|i| a[i % N * N + i / N])
}

/// A structure of one sector or a wheel under one load at rest or at speed.
#[derive(Clone, Copy)]
struct Case {
    sectors: usize,
    speed: Speed,
    /// A constant force beside the vibrating ones.
    constant: f64,
}

impl Case {
    /// Lines of the job but for its analyses, in tables that can be left out one by one.
    fn lines(self, name: &str) -> (Vec<String>, Vec<String>) {
        let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR"))
            .join("rotation_files")
            .join(name);
        fs::create_dir_all(&folder).unwrap();
        let mut model = Vec::new();
        for given in given() {
            let mut place = |key: &str, a: &[f64; 16]| {
                let path = folder.join(format!("{key}.mtx"));
                matrix_market(&path, a);
                model.push(format!("{key} = '{}'", path.display()));
            };
            place(given.key, &given.own);
            if let Some(next) = given.next.filter(|_| self.sectors > 1) {
                place(&format!("coupling_{}", given.key), &next);
            }
        }
        model.push("rayleigh = [0.01, 0.02]".into());
        model.push("loss_factor = 0.03".into());
        model.push("modal_damping = [0.02, 0.01]".into());
        match self.speed {
            Speed::Fixed(speed) => model.push(format!("speed = {speed:?}")),
            Speed::PerOmega(p) => model.push(format!("speed_per_omega = {p:?}")),
        }
        if self.sectors > 1 {
            model.push(format!("sectors = {}", self.sectors));
            model.push("engine_order = 2".into());
        }
        let mut rest = vec![
            "[[contact]]\nkind = 'jenkins'\na = [0]\nb = [1]\nkt = 2.0\nmu = 0.4\npreload = 0.1\nper_speed2 = 0.3"
                .into(),
            "[[contact]]\nkind = 'unilateral'\na = [2]\nkn = 1.5\ngap = 0.1\nper_speed2 = 0.2".into(),
            "[[force]]\ndof = 0\nvalue = [0.8, 0.3]".into(),
            "[[unbalance]]\ndof_x = 1\ndof_y = 3\nm_e = 0.3\nphase = 0.7".into(),
        ];
        if self.constant != 0.0 {
            rest.push(format!("[[force]]\ndof = 2\nharmonic = 0\nvalue = {:?}", self.constant));
        }
        (model, rest)
    }

    fn model(self) -> Model {
        let mut model = Model::cyclic(N, self.sectors).unwrap();
        for given in given() {
            let own = columns(&given.own);
            model.set_matrix(given.kind, &MatrixView::dense(N, &own)).unwrap();
            if let Some(next) = given.next.filter(|_| self.sectors > 1) {
                let next = columns(&next);
                model.set_coupling(given.kind, &MatrixView::dense(N, &next)).unwrap();
            }
        }
        if self.sectors > 1 {
            model.set_wave(2);
        }
        model.set_rayleigh(0.01, 0.02).unwrap();
        model.set_loss_factor(0.03).unwrap();
        model.set_modal_damping(&[0.02, 0.01]).unwrap();
        let friction = Contact::jenkins(0, Some(1), 2.0, 0.4, 0.1);
        let friction = model.add_contact(&friction).unwrap();
        model.set_preload_at_speed(friction, 0.1, 0.3).unwrap();
        let stop = model
            .add_contact(&Contact::unilateral(Some(2), None, 1.5, 0.1))
            .unwrap();
        model.set_preload_at_speed(stop, 0.0, 0.2).unwrap();
        model.add_force(0, 1, Complex64::new(0.8, 0.3)).unwrap();
        model.add_unbalance(1, 3, 0.3, 0.7).unwrap();
        if self.constant != 0.0 {
            model.add_force(2, 0, self.constant.into()).unwrap();
        }
        model.set_speed(self.speed).unwrap();
        model
    }
}

/// Columns of the tables that a job wrote.
fn run(name: &str, job: &str, csv: &str) -> Vec<Vec<f64>> {
    let (output, folder) = crate::common::hbvib("run", ("rotation", name), job);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = fs::read_to_string(folder.join(csv)).unwrap();
    let row = |line: &str| line.split(',').map(|x| x.parse().unwrap()).collect();
    text.lines().skip(1).map(row).collect()
}

fn job((model, rest): &(Vec<String>, Vec<String>), analysis: &str) -> String {
    format!("[model]\n{}\n{}\n{analysis}", model.join("\n"), rest.join("\n"))
}

fn solver(harmonics: usize) -> SolverOptions {
    SolverOptions {
        harmonics,
        tolerance: 0.0,
        response_dof: Some(1),
        ..SolverOptions::default()
    }
}

/// Response of degree of freedom 1 at one frequency.
fn amplitude(model: &Model, omega: f64) -> f64 {
    let range = ForcedOptions {
        omega_start: omega,
        omega_stop: omega,
        ..ForcedOptions::default()
    };
    forced_response(model, &solver(5), &range, &mut Hooks::default())
        .unwrap()
        .amplitude()[0]
}

const CASES: [(&str, Case); 4] = [
    (
        "fixed",
        Case {
            sectors: 1,
            speed: Speed::Fixed(0.8),
            constant: 0.0,
        },
    ),
    (
        "tied",
        Case {
            sectors: 1,
            speed: Speed::PerOmega(0.5),
            constant: 0.0,
        },
    ),
    (
        "wheel",
        Case {
            sectors: 12,
            speed: Speed::Fixed(0.8),
            constant: 0.0,
        },
    ),
    (
        "tied_wheel",
        Case {
            sectors: 12,
            speed: Speed::PerOmega(-0.5),
            constant: 0.2,
        },
    ),
];

#[test]
fn responses_of_jobs_with_every_key_are_those_of_the_model_in_rust() {
    for (name, case) in CASES {
        let (from, to) = (1.2 / TAU, 2.0 / TAU);
        let analysis = format!(
            "[forced]\nfrom_hz = {from:?}\nto_hz = {to:?}\nharmonics = 5\nresponse_dof = 1\n[output]\ncsv = 'a.csv'\n"
        );
        let rows = run(name, &job(&case.lines(name), &analysis), "a.csv");
        assert!(rows.len() >= 10, "{name}: {} points", rows.len());
        let model = case.model();
        let mut worst = 0.0_f64;
        for row in rows.iter().step_by(3) {
            worst = worst.max((row[1] / amplitude(&model, TAU * row[0]) - 1.0).abs());
        }
        println!("{name}: {} points, off by {worst:.1e}", rows.len());
        assert!(worst < 1e-8, "{name}: {worst:e}");
    }
}

#[test]
fn each_key_of_a_job_has_its_effect() {
    let at = 1.7 / TAU;
    let analysis = format!(
        "[forced]\nfrom_hz = {at:?}\nto_hz = {at:?}\nharmonics = 5\nresponse_dof = 1\n[output]\ncsv = 'a.csv'\n"
    );
    for (name, case) in [CASES[1], CASES[2]] {
        let whole = case.lines(&format!("effect_{name}"));
        let with = |lines: &(Vec<String>, Vec<String>)| run("one_key", &job(lines, &analysis), "a.csv")[0][1];
        let all = with(&whole);
        let mut left_out = Vec::new();
        for (i, line) in whole.0.iter().enumerate() {
            let key = line.split(' ').next().unwrap();
            // Without these there is no such model.
            if !["mass", "stiffness", "sectors"].contains(&key) {
                let mut lines = whole.clone();
                lines.0.remove(i);
                left_out.push((key.to_owned(), lines));
            }
        }
        for key in ["per_speed2", "phase"] {
            for table in 0..whole.1.len() {
                let kept: Vec<&str> = whole.1[table].lines().filter(|line| !line.starts_with(key)).collect();
                if kept.len() < whole.1[table].lines().count() {
                    let mut lines = whole.clone();
                    lines.1[table] = kept.join("\n");
                    left_out.push((format!("{key} of table {table}"), lines));
                }
            }
        }
        let unbalance = whole
            .1
            .iter()
            .position(|table| table.starts_with("[[unbalance]]"))
            .unwrap();
        let mut lines = whole.clone();
        lines.1.remove(unbalance);
        left_out.push(("unbalance".to_owned(), lines));
        let mut told = String::new();
        for (key, lines) in left_out {
            let change = (with(&lines) / all - 1.0).abs();
            let _ = write!(told, " {key} {change:.0e}");
            assert!(change > 1e-5, "{name}: {key} changes the response by {change:e}");
        }
        println!("{name}:{told}");
    }
}

#[test]
fn campbell_diagrams_of_jobs_are_those_of_the_model_in_rust() {
    for (name, case) in [CASES[0], CASES[2]] {
        for (state, contacts) in [
            ("free", LinearContacts::Free),
            ("stuck", LinearContacts::Stuck),
            ("static", LinearContacts::Static),
        ] {
            let diameter = if case.sectors > 1 { 2 } else { 0 };
            let (from, to) = (0.1 / RPM, 1.3 / RPM);
            let analysis = format!(
                "[campbell]\nfrom_rpm = {from:?}\nto_rpm = {to:?}\npoints = 7\ncount = 4\ncontacts = '{state}'\n\
                 diameter = {diameter}\nengine_orders = [1, 2]\ncsv = 'c.csv'\n"
            );
            let own = format!("campbell_{name}");
            let rows = run(&own, &job(&case.lines(&own), &analysis), "c.csv");
            let speeds: Vec<f64> = (0..7).map(|i| 0.1 + 0.2 * f64::from(i)).collect();
            let at = (diameter, contacts, N);
            let found = campbell(&case.model(), &speeds, at, &[1, 2], &mut Hooks::default()).unwrap();
            assert_eq!(rows.len(), found.omega.len());
            for (i, row) in rows.iter().enumerate() {
                assert!((row[0] * RPM / speeds[i / N] - 1.0).abs() < 1e-9);
                assert!(
                    (row[2] * TAU / found.omega[i] - 1.0).abs() < 1e-9,
                    "{name}, {state}: row {i}"
                );
                assert!(
                    (row[3] / found.damping_ratio[i] - 1.0).abs() < 1e-9,
                    "{name}, {state}: row {i}"
                );
                assert!((row[4] - found.direction[i] as f64).abs() < 0.5);
            }
        }
    }
}

#[test]
fn pressed_modes_of_jobs_are_those_of_the_model_in_rust() {
    for (name, sectors) in [("pressed", 1), ("pressed_wheel", 12)] {
        let case = Case {
            sectors,
            speed: Speed::Fixed(0.8),
            constant: -0.5,
        };
        let analysis = "[mode]\nindex = 0\nlog10_from = -2\nlog10_to = 0.3\nharmonics = 5\nresponse_dof = 1\n[output]\ncsv = 'm.csv'\n";
        let rows = run(name, &job(&case.lines(name), analysis), "m.csv");
        let at: Vec<f64> = rows.iter().step_by(4).map(|row| row[4]).collect();
        let range = ModeOptions {
            log10_start: -2.0,
            log10_stop: 0.3,
            at: &at,
            ..ModeOptions::default()
        };
        let branch = nonlinear_mode(&case.model(), &solver(5), &range, &mut Hooks::default()).unwrap();
        assert!(branch.mode().unwrap().lift_off_from.is_finite(), "nothing presses");
        let mut worst = (0.0_f64, 0.0_f64);
        for (i, row) in rows.iter().step_by(4).enumerate() {
            let [found] = branch.at(i) else {
                panic!("{} solutions at {}", branch.at(i).len(), row[4])
            };
            worst.0 = worst.0.max((TAU * row[0] / found.omega - 1.0).abs());
            let d = branch.mode_at(found.point).unwrap().damping_ratio;
            worst.1 = worst.1.max((row[5] / d - 1.0).abs());
        }
        println!("{name}: {} points, ω {:.1e}, D {:.1e}", rows.len(), worst.0, worst.1);
        assert!(rows.len() > 20 && worst.0 < 1e-9 && worst.1 < 1e-7, "{name}: {worst:?}");
    }
}

#[test]
fn jobs_with_wrong_damping_or_rotation_are_refused_in_words() {
    let analysis = "[forced]\nfrom_hz = 0.2\nto_hz = 0.3\nharmonics = 3\n";
    let whole = CASES[0].1.lines("wrong");
    let with = |from: &str, to: &str| {
        let text = job(&whole, analysis);
        assert!(text.contains(from), "{from}");
        text.replace(from, to)
    };
    let symmetric = whole.0.iter().find(|line| line.starts_with("stiffness =")).unwrap();
    let symmetric = symmetric.split(" = ").nth(1).unwrap();
    let gyroscopic = whole.0.iter().find(|line| line.starts_with("gyroscopic")).unwrap();
    for (job, words) in [
        (
            with("loss_factor = 0.03", "loss_factor = -0.03"),
            vec!["loss_factor = -0.03", ">= 0"],
        ),
        (
            with("[0.02, 0.01]", "[0.02, -0.01]"),
            vec!["modal_damping", "ratios[1] = -0.01"],
        ),
        (with("speed = 0.8", "speed = nan"), vec!["speed = NaN"]),
        (
            with("speed = 0.8", "speed = 0.8\nspeed_per_omega = 0.5"),
            vec!["speed and speed_per_omega", "one of them"],
        ),
        (
            with(gyroscopic, &format!("gyroscopic = {symmetric}")),
            vec!["skew-symmetric"],
        ),
        (with("dof_x = 1", "dof_x = 3"), vec!["[[unbalance]] 1", "both 3"]),
        (with("dof_x = 1", "dof_x = 4"), vec!["[[unbalance]] 1", "dof_x = 4"]),
        (with("m_e = 0.3", "m_e = nan"), vec!["[[unbalance]] 1", "m_e = NaN"]),
        (with("per_speed2 = 0.3", "per_speed2 = nan"), vec!["per_speed2 = NaN"]),
        (with("loss_factor", "los_factor"), vec!["los_factor", "loss_factor"]),
        (
            with("harmonics = 3\n", "harmonics = 3\n[verify]\npoints = 'peaks'\n"),
            vec!["no causal law", "viscous equivalent"],
        ),
    ] {
        let (output, _) = crate::common::hbvib("run", ("rotation", "wrong"), &job);
        let text = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(1), "{words:?}: {text}");
        for word in words {
            assert!(text.contains(word), "{text} does not say {word}");
        }
    }
}
