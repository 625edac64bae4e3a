//! Options without sense: every call ends within a number of evaluations that its bounds give.

use crate::common::{harmonics, omega_range};
use hbvib::{
    Call, Contact, ContactKind, ForcedOptions, Hooks, MatrixKind, MatrixView, Model, Result, SolverOptions, User,
    UserForce, forced_response,
};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

/// A hardening spring that counts how often it is asked.
#[derive(Default)]
struct Counted(AtomicUsize);

impl UserForce for Counted {
    fn evaluate(&self, call: &mut Call<'_>) -> i32 {
        self.0.fetch_add(1, Ordering::Relaxed);
        for j in 0..call.samples {
            let u = call.u[j];
            call.f[j] = u + u * u * u;
            call.df_du[j] = 1.0 + 3.0 * u * u;
        }
        0
    }
}

/// One mass under the counting spring and friction, driven in the harmonics given.
fn model(spring: &Arc<Counted>, driven: &[usize]) -> Result<Model> {
    let mut model = Model::new(1)?;
    for (which, value) in [
        (MatrixKind::Mass, 1.0),
        (MatrixKind::Damping, 0.02),
        (MatrixKind::Stiffness, 1.0),
    ] {
        model.set_matrix(which, &MatrixView::dense(1, &[value]))?;
    }
    model.add_contact(&Contact::jenkins(0, None, 5.0, 1.0, 0.3))?;
    let law = User::new(Arc::clone(spring) as Arc<dyn UserForce>, 1, 0)?;
    model.add_contact(&Contact::between(0, None, ContactKind::User(law)))?;
    for &harmonic in driven {
        model.add_force(0, harmonic, 0.5.into())?;
    }
    Ok(model)
}

/// Points that all homotopies of a start may take.
const HOMOTOPIES: usize = 4 * 1_000;

/// Corrections for one point: the steps shrink by 0.4 at least from the largest to the smallest, with three
/// more at those that count as corners, and the special points beside it.
const CORRECTIONS: usize = 400;

/// Evaluations of a Newton iteration: the dampings 1, 1/2 … 1/1024, and one more.
const DAMPINGS: usize = 12;

/// Name, options, range of frequency and driven harmonics.
type Absurd = (&'static str, SolverOptions, (f64, f64), Vec<usize>);

fn absurdities() -> Vec<Absurd> {
    let base = || SolverOptions {
        max_points: 60,
        ..harmonics(3)
    };
    let steps = |step: f64| SolverOptions {
        step,
        step_min: step,
        step_max: step,
        ..base()
    };
    let wide = (1e-8, 1e8);
    vec![
        (
            "residual of 1e-300",
            SolverOptions {
                tol_residual: 1e-300,
                ..base()
            },
            (0.5, 3.0),
            vec![1],
        ),
        (
            "residual of 1e-300 in any number of iterations",
            SolverOptions {
                tol_residual: 1e-300,
                max_newton: 3000,
                ..base()
            },
            (0.5, 3.0),
            vec![1],
        ),
        (
            "residual of 0.99",
            SolverOptions {
                tol_residual: 0.99,
                ..base()
            },
            (0.5, 3.0),
            vec![1],
        ),
        ("steps of 1e-12", steps(1e-12), (0.5, 3.0), vec![1]),
        ("steps of 1e-300", steps(1e-300), (0.5, 3.0), vec![1]),
        ("steps of 10", steps(10.0), (0.5, 3.0), vec![1]),
        ("steps of 1e300", steps(1e300), (0.5, 3.0), vec![1]),
        (
            "one iteration",
            SolverOptions {
                max_newton: 1,
                ..base()
            },
            (0.5, 3.0),
            vec![1],
        ),
        (
            "one point",
            SolverOptions {
                max_points: 1,
                ..base()
            },
            (0.5, 3.0),
            vec![1],
        ),
        ("sixteen decades up", base(), wide, vec![1]),
        ("sixteen decades down", base(), (wide.1, wide.0), vec![1]),
        ("a range of nothing", base(), (1.0, 1.0 + f64::EPSILON), vec![1]),
        ("the smallest frequencies", base(), (f64::MIN_POSITIVE, 1e-300), vec![1]),
        ("the largest frequencies", base(), (1e150, 1e154), vec![1]),
        (
            "harmonics 40 and 41",
            SolverOptions {
                harmonics: 41,
                ..base()
            },
            (0.02, 0.1),
            vec![40, 41],
        ),
        (
            "samples at Nyquist",
            SolverOptions { samples: 7, ..base() },
            (0.5, 3.0),
            vec![1],
        ),
    ]
}

#[test]
fn absurd_options_end_within_their_bounds() {
    for (name, solver, (from, to), driven) in absurdities() {
        let spring = Arc::new(Counted::default());
        let range = ForcedOptions {
            at: &[0.5 * (from + to)],
            ..omega_range(from, to)
        };
        let found = model(&spring, &driven).and_then(|m| forced_response(&m, &solver, &range, &mut Hooks::default()));
        let asked = spring.0.load(Ordering::Relaxed);
        let bound = (HOMOTOPIES + solver.max_points) * CORRECTIONS * (solver.max_newton + 1) * DAMPINGS;
        let reported = match &found {
            Ok(branch) => format!("{:?}, {} points", branch.status(), branch.points()),
            Err(e) => format!("{:?}: {}", e.status, e.message()),
        };
        println!("{name}: {asked} evaluations; {reported}");
        assert!(asked <= bound, "{name}: {asked} evaluations, at most {bound}");
        assert!(found.is_ok_and(|branch| branch.points() <= solver.max_points) || !reported.is_empty());
    }
}
