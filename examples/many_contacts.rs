//! Cost of a Newton iteration with many contacts in three directions.
//!
//! A clamped plate of bricks rubs with its whole underside on a lining: 200 contacts of friction in a plane with
//! separation, 600 relative motions, 6600 real unknowns at H = 5. At one frequency Newton's method starts from the
//! linear solution, and every iteration is shown with the time of its parts: contact laws, assembly (the coupling
//! of their Jacobians by the flexibility of the plate), factorisation, and the solution for the step. `-- --help`
//! lists the flags.

use std::error::Error;
use std::f64::consts::TAU;
use std::io::Write;
use std::process::ExitCode;
use std::time::{Duration, Instant};

use hbvib::{Interrupt, SolverOptions};

use hbvib::internals::Bordered;
use hbvib::internals::Condensed;
use hbvib::internals::ContactForces;
use hbvib::internals::HarmonicBalance;
use hbvib::internals::Jacobian;
use hbvib::internals::norm;
use hbvib::internals::{InitialGuess, Problem, Residual};

use beam::{Beam, Z};
use flags::{Flag, Flags};

#[path = "friction_patch/beam.rs"]
mod beam;
#[path = "friction_patch/brick.rs"]
mod brick;
#[path = "support/flags.rs"]
mod flags;

const FLAGS: [Flag; 6] = [
    Flag::new("--rows", "N", "contacts along the plate, one element each (20)"),
    Flag::new("--across", "N", "contacts across, one element less (10)"),
    Flag::new("--harmonics", "H", "highest harmonic number (5)"),
    Flag::new("--force", "N", "amplitude of the vibrating force (20)"),
    Flag::new("--hz", "f", "frequency (600)"),
    Flag::new("--help", "", "show this text"),
];

/// Largest number of Newton iterations.
const ITERATIONS: usize = 12;

/// Relative residual at which the iteration ends.
const TOLERANCE: f64 = 1e-10;

/// Vertical share of the force, large enough for parts of the plate to lift off.
const LIFT: f64 = 0.5;

struct Request {
    plate: Beam,
    solver: SolverOptions,
    force: f64,
    omega: f64,
}

impl Request {
    fn new(flags: &Flags) -> Result<Self, String> {
        let count = |name: &str, least: usize, otherwise: usize| -> Result<usize, String> {
            let needs = format!("an integer of at least {least}");
            Ok(flags.value(name, &needs, |n: &usize| *n >= least)?.unwrap_or(otherwise))
        };
        let (rows, across) = (count("--rows", 1, 20)?, count("--across", 2, 10)?);
        let solver = SolverOptions {
            harmonics: count("--harmonics", 1, 5)?,
            tolerance: 0.0,
            ..SolverOptions::default()
        };
        solver.check().map_err(|e| e.to_string())?;
        Ok(Self {
            plate: Beam {
                size: [0.3, 0.008, 0.15],
                elements: [rows, 1, across - 1],
                rows: [1, rows],
                pressure: 5e3,
                load: 50.0,
                ..Beam::default()
            },
            solver,
            force: flags.amount("--force")?.unwrap_or(20.0),
            omega: TAU * flags.positive("--hz")?.unwrap_or(600.0),
        })
    }

    fn run(&self, screen: &mut impl Write) -> Result<(), Box<dyn Error>> {
        let model = self.plate.forced(self.force, LIFT)?;
        let omega = self.omega;
        let condensed = Condensed::new(&model, &self.solver, omega, &Interrupt::none())?;
        let response = self.plate.tips()[0] + Z;
        let begin = Instant::now();
        let interrupt = Interrupt::none();
        let mut problem = HarmonicBalance::new(&condensed, response, omega.into(), 0, None, &interrupt)?;
        let mut forces = ContactForces::new(&condensed, 0, &interrupt)?;
        let n = problem.size();
        let mut u = vec![0.0; n];
        let mut at = Residual::new(n)?;
        let (mut jacobian, mut active) = (vec![0.0; n * n], vec![true; n]);
        let mut lu = Bordered::new(n)?;
        let mut row = vec![0.0; n + 1];
        row[n] = 1.0;
        let mut step = vec![0.0; n + 1];
        // The flexibility at this frequency is evaluated once: it stays the same here.
        problem.initial_guess(InitialGuess::Reference, omega, &mut u)?;
        writeln!(
            screen,
            "{} degrees of freedom, {} contacts, {} relative motions, {n} unknowns at H = {}\n\
             flexibility at one frequency and memory: {:.3} s\n\n\
             \x20 it   residual  slip  solved for      laws  assembly    factor     solve  [s]",
            condensed.ndof(),
            condensed.contacts(),
            condensed.coordinates(),
            self.solver.harmonics,
            begin.elapsed().as_secs_f64(),
        )?;
        let mut total = [Duration::ZERO; 4];
        let mut iterations = 0;
        for k in 0..ITERATIONS {
            let (laws, done) = timed(|| forces.evaluate(&u, omega));
            done?;
            let (evaluation, done) = timed(|| {
                let done = problem.evaluate(&u, omega, &mut at);
                problem.fill(&mut jacobian, &mut active)?;
                done
            });
            done?;
            let residual = norm(&at.values) / at.scale;
            let slip = problem.slip_fractions().iter().filter(|s| **s > 0.0).count();
            let solved_for = active.iter().filter(|a| **a).count();
            let (factor, done) = timed(|| {
                lu.factor(
                    &jacobian,
                    &at.d_parameter,
                    &active,
                    (1.0, omega),
                    &row,
                    &Interrupt::none(),
                )
            });
            done?;
            for (s, r) in step.iter_mut().zip(&at.values) {
                *s = -r;
            }
            step[n] = 0.0;
            let (solve, ()) = timed(|| lu.solve(&mut step));
            for (u, s) in u.iter_mut().zip(&step) {
                *u += s;
            }
            let parts = [laws, evaluation.saturating_sub(laws), factor, solve];
            write!(screen, "{k:>4}  {residual:>9.2e}  {slip:>4}  {solved_for:>10}")?;
            for (sum, part) in total.iter_mut().zip(parts) {
                *sum += part;
                write!(screen, "{:>10.4}", part.as_secs_f64())?;
            }
            writeln!(screen)?;
            iterations += 1;
            if residual <= TOLERANCE {
                break;
            }
        }
        let whole: f64 = total.iter().map(Duration::as_secs_f64).sum();
        write!(screen, "\n{:.3} s an iteration:", whole / f64::from(iterations))?;
        for (part, time) in ["laws", "assembly", "factorisation", "solution"].iter().zip(total) {
            write!(screen, " {part} {:.1} %", 100.0 * time.as_secs_f64() / whole)?;
        }
        writeln!(screen)?;
        Ok(())
    }
}

fn timed<T>(work: impl FnOnce() -> T) -> (Duration, T) {
    let begin = Instant::now();
    let result = work();
    (begin.elapsed(), result)
}

fn main() -> ExitCode {
    let flags = Flags::read(std::env::args_os().skip(1), &FLAGS);
    let request = match flags.and_then(|f| Request::new(&f).map(|r| (f.has("--help"), r))) {
        Ok(request) => request,
        Err(message) => {
            eprintln!("many_contacts: {message}\n(--help lists the flags)");
            return ExitCode::from(2);
        }
    };
    let mut screen = std::io::stdout().lock();
    let done = if request.0 {
        write!(
            screen,
            "Cost of a Newton iteration with many contacts.\n\n{}",
            flags::table(&FLAGS)
        )
        .map_err(Into::into)
    } else {
        request.1.run(&mut screen)
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("many_contacts: {error}");
            ExitCode::FAILURE
        }
    }
}
