//! Forced responses and modes of a sector with faces against the same sector from K₀ and K₁.

use crate::boundary_sector::{BoundarySector, N, dofs};
use crate::common::models::{Structure, sector_of_faces};
use crate::common::refusal::refused;
use crate::common::{
    all_harmonics, amplitude_range, at_dof, harmonics, omega_range, relative_gap, slip, solve_at, sweep,
};
use hbvib::{
    Contact, ContactState, Hooks, LinearContacts, MatrixKind, MatrixView, ModeChoice, ModeOptions, Model, Part,
    SectorFrame, SolverOptions, Status, VerifyOptions, forced_residual, forced_response, nonlinear_mode, verify,
};
use nalgebra::DMatrix;
use num_complex::Complex64;
use std::f64::consts::TAU;

/// The cylindrical sector and its independent degrees of freedom in the order of the test.
pub struct Pair {
    pub sector: BoundarySector,
    pub origin: Vec<usize>,
}

impl Pair {
    pub fn new() -> Self {
        let sector = BoundarySector::read(SectorFrame::Cylindrical);
        let (right, clamped) = (dofs(&sector.right), dofs(&sector.clamped));
        let origin = (0..sector.ndof()).filter(|d| !right.contains(d) && !clamped.contains(d));
        Self {
            origin: origin.collect(),
            sector,
        }
    }

    pub fn number(&self, dof: usize) -> usize {
        self.origin.iter().position(|&d| d == dof).unwrap()
    }

    /// The sector from K₀ and K₁, built by T₀ and T₁.
    pub fn reference(&self, engine_order: i64) -> Model {
        let (n, given) = (self.origin.len(), self.sector.ndof());
        let mut t = [DMatrix::<f64>::zeros(given, n), DMatrix::zeros(given, n)];
        for (j, &dof) in self.origin.iter().enumerate() {
            t[0][(dof, j)] = 1.0;
        }
        for (l, r) in dofs(&self.sector.left).into_iter().zip(dofs(&self.sector.right)) {
            if let Some(j) = self.origin.iter().position(|&d| d == l) {
                t[1][(r, j)] = 1.0;
            }
        }
        let mut model = Model::cyclic(n, N).unwrap();
        model.set_wave(engine_order);
        for (kind, a) in [
            (MatrixKind::Stiffness, &self.sector.k),
            (MatrixKind::Mass, &self.sector.m),
        ] {
            let own = t[0].transpose() * a * &t[0] + t[1].transpose() * a * &t[1];
            let next = t[0].transpose() * a * &t[1];
            model.set_matrix(kind, &MatrixView::dense(n, own.as_slice())).unwrap();
            model
                .set_coupling(kind, &MatrixView::dense(n, next.as_slice()))
                .unwrap();
        }
        model
    }
}

const SLIP: f64 = 20.0;

pub fn jenkins(a: usize, b: usize, sector_offset: i64) -> Contact {
    Contact {
        sector_offset,
        ..Contact::jenkins(a, Some(b), 2e7, 1.0, SLIP)
    }
}

/// A node on the free part of the right face, pair and component.
pub const PAIR: usize = 7;

#[test]
fn contacts_inside_and_across_the_faces_give_the_response_of_the_sector_from_its_blocks() {
    let pair = Pair::new();
    for engine_order in [3, -2] {
        let (mut model, mut reference) = (pair.sector.model(engine_order), pair.reference(engine_order));
        let (left, right) = (dofs(&pair.sector.left), dofs(&pair.sector.right));
        let (l, r) = (left[3 * PAIR + 1], right[3 * PAIR + 1]);
        let (blade, disk, tip) = (3 * 32 + 1, 3 * 27 + 1, 106);
        let lag = model.structure().phase(1, 1);
        // Inside; from a right node to the blade; between the blades of neighbours.
        for contact in [jenkins(disk, blade, 0), jenkins(r, blade, 0), jenkins(tip, blade, 1)] {
            model.add_contact(&contact).unwrap();
        }
        let n = |dof| pair.number(dof);
        for contact in [
            jenkins(n(disk), n(blade), 0),
            jenkins(n(l), n(blade), -1),
            jenkins(n(tip), n(blade), 1),
        ] {
            reference.add_contact(&contact).unwrap();
        }
        let force = Complex64::new(40.0, 25.0);
        model.add_force(tip, 1, 60.0.into()).unwrap();
        model.add_force(r, 1, force).unwrap();
        model.add_force(0, 1, force).unwrap();
        reference.add_force(n(tip), 1, 60.0.into()).unwrap();
        // The right node of the sector before is the left one of this.
        reference.add_force(n(l), 1, force * lag.conj()).unwrap();
        for (model, beta) in [(&mut model, 2e-6), (&mut reference, 2e-6)] {
            model.set_rayleigh(0.0, beta).unwrap();
        }
        let natural = reference.linear_modes(3, ContactState::Stuck).unwrap().omega[0];
        for ratio in [0.93, 0.985, 1.02] {
            let solver = at_dof(r, harmonics(5));
            let branch = solve_at(&model, &solver, ratio * natural);
            let expected = solve_at(&reference, &harmonics(5), ratio * natural);
            let (x, y) = (all_harmonics(&branch, 0), all_harmonics(&expected, 0));
            let (given, own) = (pair.sector.ndof(), pair.origin.len());
            assert_eq!(x.len(), 6 * given);
            let kept: Vec<Complex64> = (0..6)
                .flat_map(|h| pair.origin.iter().map(move |d| h * given + d))
                .map(|at| x[at])
                .collect();
            let gap = relative_gap(&kept, &y);
            println!(
                "EO {engine_order}: {:.1} Hz, slip {:.2}, gap {gap:.1e}",
                ratio * natural / TAU,
                slip(&branch, 0)
            );
            assert!(gap < 1e-9, "{gap}");
            let image = lag * y[own + n(l)];
            assert!((branch.response_at(0).unwrap()[0] - image).norm() < 1e-9 * image.norm());
            assert!((x[given + r] - image).norm() < 1e-9 * image.norm());
            assert!(x[given] == Complex64::ZERO, "fixed");
            let history = branch.time_history(0, r, 8).unwrap();
            let sum: f64 = (0..6).map(|h| x[h * given + r].re).sum();
            assert!((history[0] - sum).abs() < 1e-9 * image.norm());
        }
    }
}

#[test]
fn a_fixed_degree_of_freedom_has_no_response() {
    let (model, _) = lumped(1);
    let solver = at_dof(3, harmonics(3));
    let range = omega_range(0.8, 1.0);
    let words = ["response_dof = 3 is fixed"];
    refused(
        forced_response(&model, &solver, &range, &mut Hooks::default()),
        Status::Argument,
        &words,
    );
    let mode = ModeOptions {
        reference_dof: Some(2),
        ..amplitude_range(-2.0, 0.0)
    };
    let words = ["reference_dof = 2 lies on the right face"];
    refused(
        nonlinear_mode(&model, &harmonics(3), &mode, &mut Hooks::default()),
        Status::Argument,
        &words,
    );
}

/// Harmonic balance against time integration, with its samples on the right face.
#[test]
fn the_response_in_time_agrees_on_the_right_face() {
    let (model, right) = lumped(1);
    let solver = at_dof(right, harmonics(21));
    let branch = solve_at(&model, &solver, 0.9);
    let options = VerifyOptions::default();
    let found = verify(&model, &branch, 0, &options, &mut Hooks::default()).unwrap();
    println!("distance {:.1e}, response {:.1e}", found.distance, found.response_error);
    assert!(found.same && found.response_error < 1e-4, "{}", found.response_error);
    let mut guess = vec![Complex64::ZERO; 22 * model.ndof()];
    branch.harmonics_at(0, &mut guess).unwrap();
    let mut r = guess.clone();
    forced_residual(&model, &solver, 0.9, &guess, &mut r, None, None).unwrap();
    let worst = r.iter().fold(0.0_f64, |m, z| m.max(z.norm()));
    assert!(worst < 1e-8, "{worst}");
}

/// Three masses per sector, the last of them the first of the next sector; another one is fixed.
fn lumped(engine_order: i64) -> (Model, usize) {
    use hbvib::SectorDescription;
    let model = Model::sector(&SectorDescription {
        engine_order,
        components: 1,
        fixed: &[3],
        ..sector_of_faces(4, 6, [&[Some(0)], &[Some(2)]])
    })
    .unwrap();
    let dense = |entries: &[(usize, usize, f64)]| {
        let mut a = vec![0.0; 16];
        for &(i, j, v) in entries {
            a[4 * i + j] += v;
        }
        a
    };
    let springs = |list: &[(usize, usize, f64)]| {
        let terms = list
            .iter()
            .flat_map(|&(i, j, k)| [(i, i, k), (j, j, k), (i, j, -k), (j, i, -k)]);
        dense(&terms.collect::<Vec<_>>())
    };
    let k = springs(&[(0, 1, 1.0), (1, 2, 0.7), (0, 3, 0.5), (1, 3, 0.2)]);
    let c = springs(&[(0, 1, 0.03), (1, 2, 0.02)]);
    let m = dense(&[(0, 0, 0.8), (1, 1, 0.5), (2, 2, 0.4), (3, 3, 1.0)]);
    let across = Contact {
        sector_offset: 1,
        ..Contact::jenkins(1, Some(1), 0.5, 1.0, 0.2)
    };
    let model = Structure::on(4, model)
        .matrices([&m, &c, &k])
        .contact(Contact::jenkins(1, Some(2), 1.0, 1.0, 0.1))
        .contact(across)
        .force(2, 1, Complex64::new(0.3, 0.1))
        .build();
    (model, 2)
}

#[test]
fn the_residual_and_its_jacobian_keep_the_numbering_of_the_sector() {
    let (model, _) = lumped(2);
    let (solver, n) = (harmonics(2), 3 * 4);
    let mut x: Vec<Complex64> = (0..n)
        .map(|i| Complex64::new((i * 7 % 5) as f64 - 2.0, (i * 3 % 7) as f64 - 3.0) * 0.2)
        .collect();
    let order = 2 * n;
    let mut jacobian = vec![0.0; order * order];
    let mut r = vec![Complex64::ZERO; n];
    forced_residual(&model, &solver, 1.1, &x, &mut r, Some(&mut jacobian), None).unwrap();
    let step = 1e-6;
    for column in 0..order {
        let mut at = |sign: f64| {
            let kept = x[column / 2];
            let change = if column % 2 == 0 { Complex64::ONE } else { Complex64::I };
            x[column / 2] += change * (sign * step);
            let mut r = vec![Complex64::ZERO; n];
            forced_residual(&model, &solver, 1.1, &x, &mut r, None, None).unwrap();
            x[column / 2] = kept;
            r
        };
        let (plus, minus) = (at(1.0), at(-1.0));
        for row in 0..n {
            let d = (plus[row] - minus[row]) / (2.0 * step);
            let own = &jacobian[column * order + 2 * row..][..2];
            assert!(
                (d - Complex64::new(own[0], own[1])).norm() < 1e-6,
                "row {row}, column {column}"
            );
        }
    }
}

/// Frequency and damping of a nonlinear mode do not depend on how the sector is given.
#[test]
fn a_nonlinear_mode_is_that_of_the_sector_from_its_blocks() {
    let (model, right) = lumped(1);
    let across = |a: usize, b: usize, kt: f64, limit: f64| Contact {
        sector_offset: 1,
        ..Contact::jenkins(a, Some(b), kt, 1.0, limit)
    };
    let reference = Structure::cyclic(2, 6)
        .wave(1)
        .matrices([
            &[1.2, 0.0, 0.0, 0.5],
            &[0.05, -0.03, -0.03, 0.05],
            &[2.2, -1.0, -1.0, 1.9],
        ])
        .next(MatrixKind::Mass, &[0.0; 4])
        .next(MatrixKind::Damping, &[0.0, -0.02, 0.0, 0.0])
        .next(MatrixKind::Stiffness, &[0.0, -0.7, 0.0, 0.0])
        .contact(across(1, 0, 1.0, 0.1))
        .contact(across(1, 1, 0.5, 0.2))
        .build();
    let mode = |model: &Model, response_dof| {
        let solver = SolverOptions {
            response_dof,
            ..harmonics(3)
        };
        let range = ModeOptions {
            choice: ModeChoice::Index(1),
            ..amplitude_range(-2.0, 0.5)
        };
        nonlinear_mode(model, &solver, &range, &mut Hooks::default()).unwrap()
    };
    let (own, other) = (mode(&model, Some(right)), mode(&reference, Some(0)));
    assert_eq!(own.points(), other.points());
    for (a, b) in own.omega().iter().zip(other.omega()) {
        assert!((a / b - 1.0).abs() < 1e-9);
    }
    for point in [0, own.points() - 1] {
        let [a, b] = [&own, &other].map(|branch| branch.response_at(point).unwrap()[0].norm());
        assert!((a / b - 1.0).abs() < 1e-8, "{a} {b}");
    }
}

/// Exchanged faces with the other sense are the same wheel, run through by a wave of the other sense.
#[test]
fn exchanged_faces_are_the_same_wheel_under_the_other_engine_order() {
    let cartesian = BoundarySector::read(SectorFrame::Cartesian);
    let cylindrical = BoundarySector::read(SectorFrame::Cylindrical);
    let omega = TAU * 1400.0;
    let tip = |sector: &BoundarySector, engine_order, exchanged: bool, forward| {
        let mut model = sector
            .try_model(engine_order, |s| {
                s.forward = forward;
                if exchanged {
                    (s.left, s.right) = (s.right, s.left);
                }
            })
            .unwrap();
        model.set_rayleigh(0.0, 2e-6).unwrap();
        model.add_contact(&jenkins(3 * 34 + 2, 3 * 32 + 2, 1)).unwrap();
        model.add_force(3 * 33, 1, 100.0.into()).unwrap();
        model.add_force(3 * 20 + 2, 1, Complex64::new(0.0, 70.0)).unwrap();
        let branch = sweep(&model, &harmonics(3), omega, omega, &[]);
        all_harmonics(&branch, 0)[model.ndof() + 106]
    };
    // The contact reaches into the sector that follows, the one before after the exchange: left out of this comparison.
    let own = tip(&cylindrical, 2, false, true);
    let swapped = tip(&cylindrical, 2, true, true);
    assert!(
        (own - swapped).norm() > 1e-3 * own.norm(),
        "an asymmetric blade: {own} {swapped}"
    );
    let linear = |sector: &BoundarySector, engine_order, exchanged: bool| {
        let mut model = sector
            .try_model(engine_order, |s| {
                if exchanged {
                    (s.left, s.right, s.forward) = (s.right, s.left, false);
                }
            })
            .unwrap();
        model.set_rayleigh(0.0, 2e-6).unwrap();
        model.add_contact(&jenkins(3 * 34 + 2, 3 * 32 + 2, 0)).unwrap();
        model.add_force(3 * 33, 1, 100.0.into()).unwrap();
        all_harmonics(&solve_at(&model, &harmonics(3), omega), 0)
    };
    let gap = relative_gap(&linear(&cartesian, 2, false), &linear(&cartesian, -2, true));
    println!("exchanged faces: gap {gap:.1e}");
    assert!(gap < 1e-9, "{gap}");
    assert!(relative_gap(&linear(&cartesian, 2, false), &linear(&cartesian, 2, true)) > 1e-3);
}

/// The model with a loss factor, then with the same loss as complex symmetric stiffness in several parts.
fn with_loss(base: &Model, stiffness: &[f64]) -> [Model; 4] {
    const ETA: f64 = 0.05;
    let lossy: Vec<Complex64> = stiffness.iter().map(|k| k * Complex64::new(1.0, ETA)).collect();
    let parts = [Part::Symmetric, Part::SymmetricUpper, Part::General].map(Some);
    [None, parts[0], parts[1], parts[2]].map(|part| {
        let mut model = base.try_clone().unwrap();
        match part {
            None => model.set_loss_factor(ETA).unwrap(),
            Some(part) => {
                let view = MatrixView::dense_complex(base.ndof(), &lossy).part(part);
                model.set_matrix(MatrixKind::Stiffness, &view).unwrap();
            }
        }
        model
    })
}

#[test]
fn a_complex_symmetric_stiffness_with_faces_has_the_modes_of_the_loss_factor() {
    let sector = BoundarySector::read(SectorFrame::Cylindrical);
    let mut base = sector.model(-2);
    base.add_contact(&jenkins(3 * 27 + 1, 3 * 32 + 1, 0)).unwrap();
    // Symmetric to the last bit, so that each part is the same matrix.
    let k = (&sector.k + sector.k.transpose()) * 0.5;
    base.set_matrix(MatrixKind::Stiffness, &MatrixView::dense(k.nrows(), k.as_slice()))
        .unwrap();
    let [known, rest @ ..] = with_loss(&base, k.as_slice());
    let linear = |model: &Model| model.lowest_modes(2, ContactState::Stuck, 4).unwrap().omega;
    let damped = |model: &Model| {
        let found = hbvib::damped_modes(model, 2, LinearContacts::Stuck, 4, &mut Hooks::default()).unwrap();
        found.eigenvalue
    };
    let expected = (linear(&known), damped(&known));
    for model in rest {
        for (a, b) in linear(&model).iter().zip(&expected.0) {
            assert!((a / b - 1.0).abs() < 1e-12, "{a} {b}");
        }
        for (a, b) in damped(&model).iter().zip(&expected.1) {
            assert!((a - b).norm() < 1e-12 * b.norm(), "{a} {b}");
        }
    }
    let (base, _) = lumped(-2);
    let stiffness = [
        1.5, -1.0, 0.0, -0.5, -1.0, 1.9, -0.7, -0.2, 0.0, -0.7, 0.7, 0.0, -0.5, -0.2, 0.0, 0.7,
    ];
    let mode = |model: &Model| {
        let at = [-0.5, -0.2];
        let range = ModeOptions {
            at: &at,
            ..amplitude_range(-2.0, 0.0)
        };
        let branch = nonlinear_mode(model, &harmonics(3), &range, &mut Hooks::default()).unwrap();
        assert_eq!(branch.status(), Status::Ok);
        [0, 1].map(|i| {
            let special = branch.at(i)[0];
            (
                special.omega,
                branch.mode_at(special.point).unwrap().damping_ratio,
                slip(&branch, special.point),
            )
        })
    };
    let [known, rest @ ..] = with_loss(&base, &stiffness);
    let expected = mode(&known);
    assert!(expected.iter().all(|point| point.2 > 0.01), "{expected:?}");
    for model in rest {
        for ((omega, d, _), (known_omega, known_d, _)) in mode(&model).into_iter().zip(expected) {
            assert!((omega / known_omega - 1.0).abs() < 1e-12, "{omega} {known_omega}");
            assert!((d / known_d - 1.0).abs() < 1e-12, "{d} {known_d}");
        }
    }
}
