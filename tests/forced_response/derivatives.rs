//! Every derivative of the equations against finite differences on random models: Jacobian, frequency
//! derivative, homotopy, observed amplitude, cyclic phases. These are identities of the same-H
//! equations; no solution is needed.

use crate::common;
use crate::common::rotating::{rotate, speeds};
use crate::common::stencil::{Checked, Stencil, config, pairs, parts};
use hbvib::internals::Condensed;
use hbvib::internals::HarmonicBalance;
use hbvib::internals::Role;
use hbvib::internals::{InitialGuess, Problem, Residual};
use hbvib::{
    Constant, Contact, ContactKind, Interrupt, MatrixKind, MatrixView, Model, Part, Speed, Table, forced_residual,
};
use num_complex::Complex64;
use proptest::prelude::*;

/// Degrees of freedom and sectors of the random models.
const N: usize = 3;
const SECTORS: usize = 5;

/// Deals out random numbers in −1 .. 1, over and over.
struct Feed<'a> {
    numbers: &'a [f64],
    next: usize,
}

impl Feed<'_> {
    fn real(&mut self) -> f64 {
        self.next += 1;
        // Each round through the numbers is scaled differently, so that no two arrays are equal.
        let round = 1.0 + (self.next / self.numbers.len()) as f64;
        self.numbers[self.next % self.numbers.len()] * round.sqrt().fract().max(0.3)
    }

    fn complex(&mut self) -> Complex64 {
        Complex64::new(self.real(), self.real())
    }

    fn block(&mut self, size: f64) -> Vec<f64> {
        (0..N * N).map(|_| size * self.real()).collect()
    }

    fn complex_block(&mut self, size: f64) -> Vec<Complex64> {
        (0..N * N).map(|_| size * self.complex()).collect()
    }
}

/// A Hermitian (symmetric, for real parts alone) matrix with a strong diagonal.
fn hermitian(a: &[Complex64], diagonal: f64) -> Vec<Complex64> {
    let mut b = vec![Complex64::ZERO; N * N];
    for i in 0..N {
        for j in 0..N {
            b[j * N + i] = 0.5 * (a[j * N + i] + a[i * N + j].conj());
        }
        b[i * N + i] += diagonal;
    }
    b
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Shape {
    /// Plain, general real C and K.
    General,
    /// Plain, general complex C and K.
    GeneralComplex,
    /// Plain, complex Hermitian M, C, K.
    Hermitian,
    /// Sectors coupled to the next and the previous one, a contact across.
    Cyclic,
    /// The same with Hermitian matrices per nodal diameter.
    PerDiameter,
}

impl Shape {
    fn sectors(self) -> usize {
        match self {
            Self::Cyclic | Self::PerDiameter => SECTORS,
            Self::General | Self::GeneralComplex | Self::Hermitian => 1,
        }
    }
}

fn random_model(shape: Shape, speed: Speed, engine_order: i64, feed: &mut Feed<'_>) -> Model {
    let mut model = Model::cyclic(N, shape.sectors()).unwrap();
    let symmetric: Vec<Complex64> = feed.block(0.2).into_iter().map(Complex64::from).collect();
    let mass: Vec<f64> = hermitian(&symmetric, 1.0).iter().map(|z| z.re).collect();
    if shape != Shape::PerDiameter {
        model
            .set_matrix(MatrixKind::Mass, &MatrixView::dense(N, &mass))
            .unwrap();
    }
    for (which, diagonal) in [(MatrixKind::Damping, 0.5), (MatrixKind::Stiffness, 8.0)] {
        match shape {
            Shape::General | Shape::Cyclic => {
                let mut a = feed.block(1.0);
                for i in 0..N {
                    a[i * N + i] += diagonal;
                }
                let view = MatrixView::dense(N, &a).part(Part::General);
                model.set_matrix(which, &view).unwrap();
            }
            Shape::GeneralComplex => {
                let mut a = feed.complex_block(1.0);
                for i in 0..N {
                    a[i * N + i] += diagonal;
                }
                let view = MatrixView::dense_complex(N, &a).part(Part::General);
                model.set_matrix(which, &view).unwrap();
            }
            Shape::Hermitian => {
                let a = hermitian(&feed.complex_block(1.0), diagonal);
                model.set_matrix(which, &MatrixView::dense_complex(N, &a)).unwrap();
            }
            Shape::PerDiameter => {
                for diameter in 0..=SECTORS / 2 {
                    let a = hermitian(&feed.complex_block(1.0), diagonal);
                    let view = MatrixView::dense_complex(N, &a);
                    model.set_diameter(which, diameter as i64, &view).unwrap();
                }
            }
        }
    }
    if shape == Shape::PerDiameter {
        for diameter in 0..=SECTORS / 2 {
            let mass = hermitian(&feed.complex_block(0.2), 1.0);
            let view = MatrixView::dense_complex(N, &mass);
            model.set_diameter(MatrixKind::Mass, diameter as i64, &view).unwrap();
        }
    }
    if shape == Shape::Hermitian {
        let mass = hermitian(&feed.complex_block(0.2), 1.0);
        model
            .set_matrix(MatrixKind::Mass, &MatrixView::dense_complex(N, &mass))
            .unwrap();
    }
    if shape == Shape::Cyclic {
        for which in [MatrixKind::Mass, MatrixKind::Damping, MatrixKind::Stiffness] {
            let next = feed.block(0.1);
            model.set_coupling(which, &MatrixView::dense(N, &next)).unwrap();
            if which != MatrixKind::Mass {
                let previous = feed.block(0.1);
                model
                    .set_coupling_previous(which, &MatrixView::dense(N, &previous))
                    .unwrap();
            }
        }
    }
    if shape.sectors() > 1 {
        model.set_wave(engine_order);
    }
    model.set_rayleigh(0.02, 0.01).unwrap();
    let table = Table::new(&[-0.9, -0.3, 0.2, 0.8], &[-0.9, -0.15, 0.1, 1.1]).unwrap();
    let mut across = Contact::jenkins(2, Some(0), 1.5, 0.5, 0.2 + 0.1 * feed.real());
    across.sector_offset = i64::from(shape.sectors() > 1);
    for contact in [
        Contact::jenkins(0, Some(1), 2.0, 0.5, 0.3 + 0.2 * feed.real()),
        across.clone(),
        // Two laws on one coordinate add up.
        across
            .with(Constant::Kt, 0.7)
            .unwrap()
            .with(Constant::Preload, 0.1)
            .unwrap(),
        Contact::jenkins(1, None, 1.0, 0.4, 0.5),
        Contact::cubic(1, Some(2), 0.8, 3.0 * feed.real()),
        // A stop.
        Contact::unilateral(Some(0), Some(2), 1.3, 0.3 + 0.1 * feed.real()),
        // Friction and a cubic spring side by side.
        Contact::cubic(0, Some(1), 0.5, 2.0),
        // Friction in a plane.
        Contact::friction_3d([Some(0), Some(2), None], [Some(1), None, None], (0.9, 0.0), 0.5, 0.6),
        Contact::between(2, None, ContactKind::Table(table)),
    ] {
        model.add_contact(&contact).unwrap();
    }
    for dof in 0..N {
        let value = feed.complex();
        model.add_force(dof, 1, value).unwrap();
    }
    // Modes need Hermitian matrices.
    if matches!(shape, Shape::Hermitian | Shape::PerDiameter) {
        model.set_modal_damping(&[0.02, 0.01, 0.03]).unwrap();
    }
    rotate(&mut model, speed, shape == Shape::PerDiameter, || feed.real());
    model
}

fn shapes() -> impl Strategy<Value = Shape> {
    prop::sample::select(vec![
        Shape::General,
        Shape::GeneralComplex,
        Shape::Hermitian,
        Shape::Cyclic,
        Shape::PerDiameter,
    ])
}

fn numbers() -> impl Strategy<Value = Vec<f64>> {
    prop::collection::vec(-1.0..1.0_f64, 97)
}

/// Residual as pairs.
fn residual(model: &Model, highest: usize, omega: f64, x: &[f64]) -> Vec<f64> {
    let mut r = vec![Complex64::ZERO; x.len() / 2];
    let solver = common::harmonics(highest);
    forced_residual(model, &solver, omega, &pairs(x), &mut r, None, None).unwrap();
    parts(&r)
}

/// Size of the entries of a matrix.
fn size(a: &[f64]) -> f64 {
    a.iter().fold(1.0, |m, x| m.max(x.abs()))
}

proptest! {
    #![proptest_config(config(60))]

    #[test]
    fn the_jacobian_and_frequency_derivative_of_the_whole_residual(
        numbers in numbers(),
        shape in shapes(),
        speed in speeds(),
        engine_order in -7_i64..=7,
        highest in 1_usize..=4,
        omega in 0.5..4.0_f64,
    ) {
        let mut feed = Feed { numbers: &numbers, next: 0 };
        let model = random_model(shape, speed, engine_order, &mut feed);
        let count = (highest + 1) * N;
        let x: Vec<Complex64> = (0..count).map(|_| feed.complex()).collect();
        let order = 2 * count;
        let mut r = vec![Complex64::ZERO; count];
        let mut jacobian = vec![0.0; order * order];
        let mut d_omega = vec![Complex64::ZERO; count];
        let solver = common::harmonics(highest);
        forced_residual(&model, &solver, omega, &x, &mut r, Some(&mut jacobian), Some(&mut d_omega)).unwrap();
        let x = parts(&x);
        let scale = size(&jacobian);
        for (c, column) in jacobian.chunks_exact(order).enumerate() {
            let stencil = Stencil::of(1e-6, |h| {
                let mut moved = x.clone();
                moved[c] += h;
                residual(&model, highest, omega, &moved)
            });
            stencil.check("Jacobian of the residual", column, scale)?;
        }
        let d_omega = parts(&d_omega);
        if matches!(speed, Speed::PerOmega(_)) {
            // The load of a slider is tied to the frequency, too.
            let stencil = Stencil::of(1e-6, |h| residual(&model, highest, omega + h, &x));
            return stencil.check("frequency derivative", &d_omega, size(&d_omega).max(scale));
        }
        let stencil = Stencil::of(1e-4, |h| residual(&model, highest, omega + h, &x));
        // A parabola in ω: central differences are exact up to round-off.
        for (i, d) in d_omega.iter().enumerate() {
            let central = (stencil.above[i] - stencil.below[i]) / (2.0 * stencil.h);
            prop_assert!((d - central).abs() < 1e-10 * size(&d_omega).max(scale), "{d:e} {central:e}");
        }
    }
}

/// A condensed problem at a random point, with a random direction (parameter last).
struct Condensation {
    u: Vec<f64>,
    p: f64,
    direction: Vec<f64>,
}

/// All derivatives of the problem as it stands: R by u and p, and the observed amplitude.
fn check_problem(problem: &mut dyn Problem, at: &Condensation, play: f64) -> Checked {
    let n = at.u.len();
    let mut out = Residual::new(n).unwrap();
    problem.evaluate(&at.u, at.p, &mut out).unwrap();
    let (mut jacobian, mut active) = (vec![0.0; n * n], vec![true; n]);
    problem.fill(&mut jacobian, &mut active).unwrap();
    let d_parameter = out.d_parameter.clone();
    let (_, dz) = problem.observe(&at.u, &at.direction);
    let scale = size(&jacobian);
    // Everything is measured in units of the play, the length at which the laws change.
    for (c, column) in jacobian.chunks_exact(n).enumerate() {
        let stencil = Stencil::of(1e-6 * play, |h| {
            let mut u = at.u.clone();
            u[c] += h;
            problem.evaluate(&u, at.p, &mut out).unwrap();
            out.values.clone()
        });
        stencil.check("condensed Jacobian", column, scale)?;
    }
    let stencil = Stencil::of(1e-6, |h| {
        problem.evaluate(&at.u, at.p + h, &mut out).unwrap();
        out.values.clone()
    });
    let largest = at.u.iter().fold(play, |m, x| m.max(x.abs()));
    stencil.check("derivative by the parameter", &d_parameter, scale * largest)?;
    let stencil = Stencil::of(1e-6, |h| {
        let u: Vec<f64> = at.u.iter().zip(&at.direction).map(|(u, d)| u + h * d).collect();
        let p = at.p + h * at.direction[n];
        problem.evaluate(&u, p, &mut out).unwrap();
        let (z, _) = problem.observe(&u, &at.direction);
        vec![z.re, z.im]
    });
    stencil.check("observed amplitude", &[dz.re, dz.im], scale * largest)
}

/// The model condensed, at a motion of a few times the play of its contacts.
fn condensed_case(
    model: &Model,
    highest: usize,
    omega: f64,
    keep_even: bool,
    feed: &mut Feed<'_>,
) -> (Condensed, f64, Vec<f64>, Vec<f64>) {
    let solver = hbvib::SolverOptions {
        keep_even_harmonics: keep_even,
        ..common::harmonics(highest)
    };
    let condensed = Condensed::new(model, &solver, omega, &Interrupt::none()).unwrap();
    let play = model
        .contacts()
        .iter()
        .filter(|contact| contact.role() == Role::Active)
        .map(|contact| match &contact.kind {
            ContactKind::Jenkins(_) | ContactKind::Friction3d(_) => {
                contact.slip_limit() / contact.constant(Constant::Kt)
            }
            // Its inner points.
            ContactKind::Table(_) => 0.2,
            // The cubic term equals the linear one.
            ContactKind::Cubic(_) => (contact.constant(Constant::Kt) / contact.constant(Constant::Cubic).abs()).sqrt(),
            _ => contact.constant(Constant::Gap).abs(),
        })
        .fold(f64::INFINITY, f64::min)
        / condensed.length();
    let n = condensed.coordinates() * condensed.set().packed_len();
    let u = (0..n).map(|_| 4.0 * play * feed.real()).collect();
    let mut direction: Vec<f64> = (0..n).map(|_| play * feed.real()).collect();
    direction.push(feed.real());
    (condensed, play, u, direction)
}

proptest! {
    #![proptest_config(config(80))]

    #[test]
    fn the_derivatives_of_the_condensed_problem(
        numbers in numbers(),
        shape in shapes(),
        speed in speeds(),
        engine_order in -7_i64..=7,
        highest in 1_usize..=5,
        omega in 0.5..4.0_f64,
        keep_even in any::<bool>(),
        response in 0_usize..N,
    ) {
        let mut feed = Feed { numbers: &numbers, next: 0 };
        let model = random_model(shape, speed, engine_order, &mut feed);
        let (condensed, play, u, direction) = condensed_case(&model, highest, omega, keep_even, &mut feed);
        let interrupt = Interrupt::none();
        let mut problem = HarmonicBalance::new(&condensed, response, (1.0, 1.0).into(), 0, None, &interrupt).unwrap();
        check_problem(&mut problem, &Condensation { u, p: omega, direction }, play)?;
    }

    #[test]
    fn the_derivatives_of_the_homotopies_in_amplitude_and_in_load(
        numbers in numbers(),
        shape in shapes(),
        speed in speeds(),
        engine_order in -7_i64..=7,
        highest in 1_usize..=5,
        omega in 0.5..4.0_f64,
        keep_even in any::<bool>(),
        share in 0.0..1.0_f64,
        preloaded in any::<bool>(),
    ) {
        let mut feed = Feed { numbers: &numbers, next: 0 };
        let mut model = random_model(shape, speed, engine_order, &mut feed);
        if preloaded {
            model.add_contact(&Contact::unilateral(None, Some(1), 0.9, -0.2)).unwrap();
        }
        let (condensed, play, u, direction) = condensed_case(&model, highest, omega, keep_even, &mut feed);
        let interrupt = Interrupt::none();
        let mut problem = HarmonicBalance::new(&condensed, 0, (1.0, 1.0).into(), 0, None, &interrupt).unwrap();
        let mut stuck = vec![0.0; u.len()];
        prop_assert!(problem.initial_guess(InitialGuess::Stuck, omega, &mut stuck).unwrap() != preloaded);
        // The stuck motion must slip for a homotopy to exist; a larger one always does.
        for x in &mut stuck {
            *x *= 1e3;
        }
        let Some(mut homotopy) = problem.homotopy(omega, &stuck).unwrap() else {
            return Err(TestCaseError::fail("no homotopy"));
        };
        // Limits from those given to ten times that, or vibrating forces from none to those given.
        let p = if preloaded { share } else { share * 10.0_f64.ln() };
        prop_assert_eq!(homotopy.end > 0.5, preloaded);
        check_problem(&mut *homotopy.problem, &Condensation { u, p, direction }, play)?;
    }
}
