//! Every stored number of a branch is finite, however the solve ends: without damping, with absurd units, with steps
//! that cannot be kept. Only error estimates may be NaN, where they are unknown.

use crate::random_problems::random::Random;
use hbvib::analysis::{forced_response, nonlinear_mode};
use hbvib::contact::Contact;
use hbvib::hooks::Hooks;
use hbvib::linalg::matrix_view::MatrixView;
use hbvib::model::Model;
use hbvib::model::structure::MatrixKind;
use hbvib::options::{ForcedOptions, ModeOptions, SolverOptions};
use hbvib::results::Branch;
use hbvib::results::mode_branch::ModeField;
use num_complex::Complex64;

/// A chain of one to four masses with up to two contacts of any law, often undamped, in random units.
fn model(random: &mut Random) -> Model {
    let n = 1 + random.below(4);
    let (k, length) = (random.decade(-20.0, 20.0), random.decade(-20.0, 20.0));
    let force = k * length;
    let (mut stiffness, mut mass) = (vec![0.0; n * n], vec![0.0; n * n]);
    for i in 0..n {
        stiffness[i * n + i] = 2.0 * k;
        mass[i * n + i] = k;
        if i > 0 {
            stiffness[i * n + i - 1] = -k;
            stiffness[(i - 1) * n + i] = -k;
        }
    }
    let mut model = Model::new(n).unwrap();
    model
        .set_matrix(MatrixKind::Mass, &MatrixView::dense(n, &mass))
        .unwrap();
    model
        .set_matrix(MatrixKind::Stiffness, &MatrixView::dense(n, &stiffness))
        .unwrap();
    if random.happens(0.5) {
        model.set_rayleigh(0.0, random.decade(-12.0, -1.0)).unwrap();
    }
    for _ in 0..random.below(3) {
        let a = random.below(n);
        let kt = k * random.decade(-3.0, 8.0);
        let contact = match random.below(4) {
            0 => Contact::jenkins(a, None, kt, 1.0, force * random.decade(-3.0, 2.0)),
            1 => Contact::unilateral(Some(a), None, kt, length * random.within(-0.5, 1.0)),
            2 => Contact::cubic(a, None, 0.0, kt / length / length * random.within(-1.0, 1.0)),
            _ => Contact::regularised(
                a,
                None,
                1.0,
                force * random.decade(-3.0, 1.0),
                length * random.decade(-3.0, 0.0),
            ),
        };
        model.add_contact(&contact).unwrap();
    }
    model
        .add_force(0, 1, (force * random.decade(-2.0, 2.0)).into())
        .unwrap();
    model
}

fn all_finite(name: &str, branch: &Branch) {
    let finite = |field: &str, values: &[f64]| {
        let bad = values.iter().position(|v| !v.is_finite());
        assert!(
            bad.is_none(),
            "{name}: {field} of point {bad:?} of {}: {:?}",
            values.len(),
            branch.status()
        );
    };
    finite("omega", branch.omega());
    finite("amplitude", branch.amplitude());
    finite("residual", branch.residual());
    finite("iterations", branch.newton_iterations());
    finite("harmonics", branch.harmonics_used());
    finite("slip", branch.slip_fraction());
    for field in [
        ModeField::DampingRatio,
        ModeField::Energy,
        ModeField::FrictionLoss,
        ModeField::Log10Amplitude,
    ] {
        finite("mode", branch.mode_field(field).unwrap_or(&[]));
    }
    for special in branch.peaks().iter().chain(branch.folds()) {
        finite("special point", &[special.omega, special.amplitude]);
    }
    let stored = branch.points() + branch.peaks().len() + branch.folds().len();
    let mut x = vec![Complex64::ZERO; (branch.harmonics() + 1) * branch.ndof()];
    for point in (0..stored).step_by(5) {
        branch.harmonics_at(point, &mut x).unwrap();
        assert!(x.iter().all(|z| z.is_finite()), "{name}: harmonics of point {point}");
    }
}

#[test]
fn every_stored_number_is_finite() {
    let (mut branches, mut points) = (0, 0);
    for case in 0..300 {
        let random = &mut Random::of(16, case);
        let model = model(random);
        let solver = SolverOptions {
            harmonics: [1, 3, 7][random.below(3)],
            tolerance: 0.0,
            max_points: 150,
            step_max: [0.0, 1.0, 1e6][random.below(3)],
            step_min: [0.0, 1e-3][random.below(2)],
            max_newton: [20, 2, 200][random.below(3)],
            ..SolverOptions::default()
        };
        let center = random.decade(-1.0, 0.7);
        let range = ForcedOptions {
            omega_start: center,
            omega_stop: center * random.decade(-1.0, 1.0),
            ..ForcedOptions::default()
        };
        let mode = ModeOptions {
            log10_start: random.within(-25.0, 0.0),
            log10_stop: random.within(0.0, 25.0),
            ..ModeOptions::default()
        };
        let hooks = &mut Hooks::default();
        let found = [
            forced_response(&model, &solver, &range, hooks),
            nonlinear_mode(&model, &solver, &mode, hooks),
        ];
        for branch in found.iter().flatten() {
            all_finite(&format!("case {case}"), branch);
            branches += 1;
            points += branch.points();
        }
    }
    println!("{branches} branches, {points} points");
    assert!(branches > 300);
}
