//! Every derivative of the equations of a nonlinear mode against finite differences, at random states
//! of a sector without mirror symmetry: these are identities, no solution is needed.

use crate::common::depth::some_of;
use crate::common::harmonics;
use crate::common::mode_cases::{N, Skewed};
use crate::common::rotating::{rotate, speeds};
use crate::common::stencil::{Checked, Stencil, config};
use hbvib::internals::Condensed;
use hbvib::internals::Jacobian;
use hbvib::internals::StaticState;
use hbvib::internals::StaticTangents;
use hbvib::internals::{Epmc, Gauge, LinearMode};
use hbvib::internals::{Path, PathHomotopy};
use hbvib::internals::{Problem, Residual};
use hbvib::{Constant, Contact, ContactKind, DampingForm, Interrupt, SolverOptions, Speed, Table};
use num_complex::Complex64;
use proptest::prelude::*;

/// Size of the entries of a matrix.
fn size(a: &[f64]) -> f64 {
    a.iter().fold(1.0, |m, x| m.max(x.abs()))
}

/// Jacobian, derivative by the parameter and observed amplitude at (u, p).
fn check_problem(problem: &mut dyn Problem, u: &[f64], p: f64, direction: &[f64]) -> Checked {
    let n = u.len();
    let mut out = Residual::new(n).unwrap();
    problem.evaluate(u, p, &mut out).unwrap();
    let (mut jacobian, mut active) = (vec![0.0; n * n], vec![true; n]);
    problem.fill(&mut jacobian, &mut active).unwrap();
    let d_parameter = out.d_parameter.clone();
    let scale = size(&jacobian).max(size(&d_parameter)) * size(u);
    for (c, column) in jacobian.chunks_exact(n).enumerate() {
        let stencil = Stencil::of(1e-6, |h| {
            let mut u = u.to_vec();
            u[c] += h;
            problem.evaluate(&u, p, &mut out).unwrap();
            out.values.clone()
        });
        stencil.check(&format!("column {c} of {n}"), column, scale)?;
    }
    let stencil = Stencil::of(1e-6, |h| {
        problem.evaluate(u, p + h, &mut out).unwrap();
        out.values.clone()
    });
    stencil.check("derivative by the parameter", &d_parameter, scale)?;
    problem.evaluate(u, p, &mut out).unwrap();
    let (_, dz) = problem.observe(u, direction);
    let stencil = Stencil::of(1e-6, |h| {
        let moved: Vec<f64> = u.iter().zip(direction).map(|(u, d)| u + h * d).collect();
        problem.evaluate(&moved, p + h * direction[n], &mut out).unwrap();
        let (z, _) = problem.observe(&moved, direction);
        vec![z.re, z.im]
    });
    stencil.check("observed amplitude", &[dz.re, dz.im], size(direction))
}

/// The data that vary from case to case.
#[derive(Debug)]
struct Case {
    numbers: Vec<f64>,
    engine_order: i64,
    highest: usize,
    form: DampingForm,
    by_contact: Option<usize>,
    with_damping: bool,
    keep_even: bool,
    log10: f64,
    homotopy: bool,
    speed: Speed,
}

/// A mode about a static state, which need not be one of equilibrium for its derivatives.
#[derive(Debug)]
struct Loaded {
    numbers: Vec<f64>,
    engine_order: i64,
    highest: usize,
    in_plane: bool,
    log10: f64,
    /// Share of the laws along the path from their tangents; the scale of the laws along the other path.
    share: f64,
    speed: Speed,
}

impl Loaded {
    fn check(&self) -> Checked {
        let mut next = self.numbers.iter().copied().cycle();
        let mut real = move || next.next().unwrap_or(0.0);
        let mut skewed = Skewed::new(self.engine_order);
        skewed.sectors = 5;
        skewed.contacts[0] = if self.in_plane {
            Contact::friction_3d([Some(0), Some(1), Some(2)], [None; 3], (1.0, 1.3), 0.4, 1.0)
        } else {
            Contact::friction_2d([Some(0), Some(2)], [None; 2], (1.0, 1.3), 0.4, 1.0)
        };
        skewed.contacts.push(
            Contact::unilateral(Some(1), None, 2.0, 0.1)
                .with(Constant::Preload, 0.4)
                .unwrap(),
        );
        skewed.contacts.push(Contact::cubic(2, None, 0.5, 1.5));
        let table = Table::new(&[-0.9, -0.3, 0.2, 0.8], &[-0.9, -0.15, 0.1, 1.1]).unwrap();
        skewed
            .contacts
            .push(Contact::between(1, None, ContactKind::Table(table)));
        let mut model = skewed.model(true);
        model.set_modal_damping(&[0.02, 0.01]).unwrap();
        rotate(&mut model, self.speed, false, &mut real);
        let model = model;
        let mut tangents = StaticTangents::new(model.contacts().len()).unwrap();
        for (id, contact) in model.contacts().iter().enumerate() {
            let d = contact.directions();
            let tangent: Vec<f64> = (0..d * d).map(|_| real()).collect();
            tangents.set(id, &tangent).unwrap();
        }
        let linear = LinearMode {
            omega: 2.0 + real(),
            damping: 0.05 * real(),
            shape: (0..N).map(|_| Complex64::new(real(), real())).collect(),
            rest: StaticState {
                motion: (0..12).map(|_| 0.4 * real()).collect(),
                structure: vec![0.0; N],
                tangents,
            },
        };
        let gauge = Gauge {
            contact: None,
            reference_dof: self.highest % N,
        };
        let form = (DampingForm::Mass, true);
        let (condensed, _) = Condensed::for_mode(
            &model,
            &harmonics(self.highest),
            form,
            &linear.shape,
            &Interrupt::none(),
        )
        .unwrap();
        prop_assert!(condensed.set().has_mean());
        let mut rest = linear.clone();
        rest.rest.motion.truncate(condensed.coordinates());
        let interrupt = Interrupt::none();
        let mut problem = Epmc::new(&condensed, &gauge, &rest, 0, &interrupt).unwrap();
        let n = problem.size();
        let mut u: Vec<f64> = (0..n).map(|_| 2.0 * real()).collect();
        for v in &mut u[n - 2..] {
            *v *= 0.3;
        }
        let direction: Vec<f64> = (0..=n).map(|_| real()).collect();
        let p = self.log10 - condensed.length().log10();
        for (path, at) in [(Path::FromTangents, self.share), (Path::ScaledLaws, 2.0 * self.share)] {
            let homotopy = PathHomotopy::between((0.0, 1.0), &mut problem, path, p);
            let mut along = homotopy.problem;
            check_problem(&mut *along, &u, at, &direction)?;
        }
        check_problem(&mut problem, &u, p, &direction)
    }
}

impl Case {
    fn check(&self) -> Checked {
        let mut next = self.numbers.iter().copied().cycle();
        let mut real = move || next.next().unwrap_or(0.0);
        let mut skewed = Skewed::new(self.engine_order);
        skewed.sectors = 5;
        // Two laws on one coordinate add up.
        skewed.contacts.push(
            skewed.contacts[1]
                .clone()
                .with(Constant::Kt, 0.7)
                .unwrap()
                .with(Constant::Preload, 0.2)
                .unwrap(),
        );
        skewed.contacts.push(Contact::jenkins(1, None, 1.0, 0.4, 0.3));
        let in_plane = Contact::friction_3d([Some(0), Some(2), None], [None; 3], (0.8, 0.0), 0.4, 0.5);
        skewed.contacts.push(in_plane);
        let mut model = skewed.model(self.with_damping);
        if self.with_damping {
            model.set_rayleigh(0.02, 0.01).unwrap();
            model.set_modal_damping(&[0.02, 0.01]).unwrap();
        }
        rotate(&mut model, self.speed, false, &mut real);
        let linear = LinearMode {
            omega: 2.0 + real(),
            damping: 0.05 * real(),
            shape: (0..N).map(|_| Complex64::new(real(), real())).collect(),
            rest: StaticState::default(),
        };
        let contact = self.by_contact.map(|id| {
            let c = &skewed.contacts[id];
            model.structure().contact_row(c, 0, 1)
        });
        let gauge = Gauge {
            contact,
            reference_dof: self.highest % N,
        };
        let solver = SolverOptions {
            keep_even_harmonics: self.keep_even,
            ..harmonics(self.highest)
        };
        let (condensed, _) =
            Condensed::for_mode(&model, &solver, (self.form, false), &linear.shape, &Interrupt::none()).unwrap();
        assert_eq!(condensed.set().has_mean(), self.keep_even);
        let play = model
            .contacts()
            .iter()
            .map(|c| c.slip_limit() / c.constant(Constant::Kt) / condensed.length())
            .fold(f64::INFINITY, f64::min);
        let interrupt = Interrupt::none();
        let mut problem = Epmc::new(&condensed, &gauge, &linear, 0, &interrupt).unwrap();
        let n = problem.size();
        // Motions of a few times the least play at amplitude 10^p.
        let p = play.log10() + self.log10;
        let mut u: Vec<f64> = (0..n).map(|_| 4.0 * real()).collect();
        for v in &mut u[n - 2..] {
            *v *= 0.3;
        }
        let direction: Vec<f64> = (0..=n).map(|_| real()).collect();
        if self.homotopy {
            let large: Vec<f64> = u.iter().map(|u| 1e3 * u).collect();
            let homotopy = problem.homotopy(p, &large).unwrap();
            prop_assert!(homotopy.is_some());
            if let Some(mut homotopy) = homotopy {
                check_problem(&mut *homotopy.problem, &u, 2.0 * self.log10.abs(), &direction)?;
            }
        }
        check_problem(&mut problem, &u, p, &direction)
    }
}

proptest! {
    #![proptest_config(config(some_of(30, 120)))]

    #[test]
    fn the_derivatives_of_the_equations_of_a_mode_about_a_static_state(
        numbers in prop::collection::vec(-1.0..1.0_f64, 89),
        engine_order in -7_i64..=7,
        highest in 1_usize..=4,
        in_plane in any::<bool>(),
        log10 in -1.0..0.5_f64,
        share in 0.0..1.0_f64,
        speed in speeds(),
    ) {
        Loaded { numbers, engine_order, highest, in_plane, log10, share, speed }.check()?;
    }

    #[test]
    fn the_derivatives_of_the_equations_of_a_mode(
        numbers in prop::collection::vec(-1.0..1.0_f64, 89),
        engine_order in -7_i64..=7,
        highest in 1_usize..=5,
        stiffness_form in any::<bool>(),
        by_contact in prop::option::of(0_usize..4),
        with_damping in any::<bool>(),
        keep_even in any::<bool>(),
        log10 in -0.5..0.5_f64,
        homotopy in any::<bool>(),
        speed in speeds(),
    ) {
        let form = if stiffness_form { DampingForm::Stiffness } else { DampingForm::Mass };
        Case {
            numbers, engine_order, highest, form, by_contact, with_damping, keep_even, log10, homotopy, speed,
        }
        .check()?;
    }
}
