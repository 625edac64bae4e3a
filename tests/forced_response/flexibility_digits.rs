//! Digits of the flexibility: against numbers that were computed with 60 digits (`tests/reference/flexibility_digits.py`), along sweeps
//! and at single frequencies, at resonances and beside them, of a chain with a penalty among its springs and of pairs of modes that are
//! one mode at an exceptional point, alone and in a structure of 60 whose flexibility is a sum over poles elsewhere.

use crate::common::{data, number};
use hbvib::{ForcedOptions, Hooks, MatrixKind, MatrixView, Model, SolverOptions, Speed, Status, forced_response};
use num_complex::Complex64;
use serde_json::Value;

/// Error of an entry of G over the largest entry of its column.
const OF_PENALTY: f64 = 1e-12;
const OF_PAIR: f64 = 1e-10;

/// Frequencies in the file, and entries of G at each.
struct Digits {
    omega: Vec<f64>,
    entries: Vec<Vec<Complex64>>,
}

impl Digits {
    fn of(case: &Value) -> Self {
        let entry = |pair: &Value| Complex64::new(number(&pair[0]), number(&pair[1]));
        let entries = |list: &Value| list.as_array().unwrap().iter().map(entry).collect();
        Self {
            omega: case["omega"].as_array().unwrap().iter().map(number).collect(),
            entries: case["g"].as_array().unwrap().iter().map(entries).collect(),
        }
    }

    /// Largest error of the ports (response, force) of a structure, along a sweep or frequency after frequency.
    fn worst(&self, ports: &[(usize, usize)], sweeps: bool, model: impl Fn(usize) -> Model) -> f64 {
        let mut worst = 0.0_f64;
        for (q, &(response, force)) in ports.iter().enumerate() {
            let model = model(force);
            let n = model.ndof();
            let scale = |k: usize| {
                let of_column = ports.iter().zip(&self.entries[k]).filter(|(port, _)| port.1 == force);
                of_column.map(|(_, g)| g.norm()).fold(0.0, f64::max)
            };
            // Motion as it is recovered, and amplitude as it was found.
            let found = |(start, stop): (f64, f64), at: &[f64]| -> Vec<(Complex64, f64)> {
                let solver = SolverOptions {
                    harmonics: 1,
                    tolerance: 0.0,
                    response_dof: Some(response),
                    max_points: 100_000,
                    ..SolverOptions::default()
                };
                let range = ForcedOptions {
                    omega_start: start,
                    omega_stop: stop,
                    at,
                    ..ForcedOptions::default()
                };
                let branch = forced_response(&model, &solver, &range, &mut Hooks::default()).unwrap();
                assert_eq!(branch.status(), Status::Ok);
                let mut motion = vec![Complex64::ZERO; (branch.harmonics() + 1) * n];
                let mut points: Vec<(usize, f64)> = Vec::new();
                for k in 0..at.len() {
                    let special = branch.at(k)[0];
                    points.push((special.point, special.amplitude));
                }
                if at.is_empty() {
                    points.push((0, branch.amplitude()[0]));
                }
                let mut read = |(point, amplitude)| {
                    branch.harmonics_at(point, &mut motion).unwrap();
                    (motion[n + response], amplitude)
                };
                points.into_iter().map(&mut read).collect()
            };
            let values = if sweeps {
                found((self.omega[0], *self.omega.last().unwrap()), &self.omega)
            } else {
                self.omega
                    .iter()
                    .flat_map(|&omega| found((omega, omega), &[]))
                    .collect()
            };
            for (k, (motion, amplitude)) in values.iter().enumerate() {
                let exact = self.entries[k][q];
                let error = (motion - exact).norm().max((amplitude - exact.norm()).abs());
                worst = worst.max(error / scale(k));
            }
        }
        worst
    }
}

fn model(n: usize, force: usize, entry: impl Fn(MatrixKind, usize, usize) -> f64) -> Model {
    let mut model = Model::new(n).unwrap();
    for kind in [
        MatrixKind::Mass,
        MatrixKind::Damping,
        MatrixKind::Stiffness,
        MatrixKind::Gyroscopic,
    ] {
        let values: Vec<f64> = (0..n * n).map(|k| entry(kind, k % n, k / n)).collect();
        if values.iter().any(|x| *x != 0.0) {
            model.set_matrix(kind, &MatrixView::dense(n, &values)).unwrap();
        }
    }
    model.set_speed(Speed::Fixed(1.0)).unwrap();
    model.add_force(force, 1, Complex64::ONE).unwrap();
    model
}

#[test]
fn penalties_of_any_size_leave_twelve_digits_at_and_beside_resonances() {
    let file = data("flexibility_digits.json");
    let whole = |x: &Value| number(x) as usize;
    let (n, link, alpha) = (whole(&file["masses"]), whole(&file["link"]), number(&file["alpha"]));
    let ports: Vec<(usize, usize)> = file["ports"]
        .as_array()
        .unwrap()
        .iter()
        .map(|p| (whole(&p[0]), whole(&p[1])))
        .collect();
    for case in file["penalties"].as_array().unwrap() {
        let penalty = number(&case["penalty"]);
        let spring = |i: usize| if i == link + 1 { penalty } else { 1.0 };
        let digits = Digits::of(case);
        for sweeps in [false, true] {
            let worst = digits.worst(&ports, sweeps, |force| {
                let mut chain = model(n, force, |kind, i, j| match (kind, i.abs_diff(j)) {
                    (MatrixKind::Mass, 0) => 1.0,
                    (MatrixKind::Stiffness, 0) => spring(i) + spring(i + 1),
                    (MatrixKind::Stiffness, 1) => -spring(i.max(j)),
                    _ => 0.0,
                });
                chain.set_rayleigh(alpha, 0.0).unwrap();
                chain
            });
            assert!(worst < OF_PENALTY, "penalty {penalty:e}, sweep {sweeps}: {worst:e}");
        }
    }
}

#[test]
fn two_modes_that_are_one_leave_ten_digits() {
    let file = data("flexibility_digits.json");
    let (damped, whirl) = (&file["damped_pair"], &file["gyroscopic_pair"]);
    let (spring, dashpot, other) = (
        number(&damped["spring"]),
        number(&damped["dashpot"]),
        number(&damped["other"]),
    );
    let of_damped = |kind: MatrixKind, i: usize, j: usize| match (kind, i, j) {
        (MatrixKind::Mass, 0, 0) | (MatrixKind::Mass, 1, 1) => 1.0,
        (MatrixKind::Stiffness, 0, 0) => 1.0 + spring,
        (MatrixKind::Stiffness, 1, 1) => other,
        (MatrixKind::Stiffness, ..) => -spring,
        (MatrixKind::Damping, 1, 1) => dashpot,
        _ => 0.0,
    };
    let gyroscopic = number(&whirl["gyroscopic"]);
    let of_whirl = |kind: MatrixKind, i: usize, j: usize| match (kind, i, j) {
        (MatrixKind::Mass | MatrixKind::Stiffness, 0, 0) | (MatrixKind::Mass | MatrixKind::Stiffness, 1, 1) => 1.0,
        (MatrixKind::Damping, 0, 0) => 2.0 * gyroscopic,
        (MatrixKind::Gyroscopic, 0, 1) => gyroscopic,
        (MatrixKind::Gyroscopic, 1, 0) => -gyroscopic,
        _ => 0.0,
    };
    let ports = [(0, 0), (0, 1), (1, 0), (1, 1)];
    let pairs: [(&Value, &dyn Fn(MatrixKind, usize, usize) -> f64); 2] = [(damped, &of_damped), (whirl, &of_whirl)];
    for (which, (case, entry)) in pairs.into_iter().enumerate() {
        let digits = Digits::of(case);
        // The others move by themselves, far above the pair.
        for n in [2, 60] {
            let with_others = |kind: MatrixKind, i: usize, j: usize| match (i < 2 && j < 2, i == j, kind) {
                (true, ..) => entry(kind, i, j),
                (_, true, MatrixKind::Mass) => 1.0,
                (_, true, MatrixKind::Stiffness) => 30.0 + i as f64,
                (_, true, MatrixKind::Damping) => 0.01 * i as f64,
                _ => 0.0,
            };
            for sweeps in [false, true] {
                let worst = digits.worst(&ports, sweeps, |force| model(n, force, with_others));
                assert!(worst < OF_PAIR, "pair {which} of {n}, sweep {sweeps}: {worst:e}");
            }
        }
    }
}
