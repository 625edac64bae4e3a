//! Tests of corners of branches.

use super::Continuation;
use crate::continuation::corrector::{Corrector, Outcome};
use crate::continuation::step_control::StepControl;
use crate::continuation::{Advance, Metric, Point, Settings};
use crate::error::Result;
use crate::interrupt::Interrupt;
use crate::linalg::newton::linear_system::Jacobian;
use crate::problem::{Homotopy, InitialGuess, Problem, Residual};
use num_complex::Complex64;

/// A motion z driven by the parameter p against a stop at 0, with the impulse q = k max(z, 0)^(3/2) of a short
/// contact: z + c q = p. Beyond the stop the branch goes along (0, 1, c) in (z, q, p), but for z = (q/k)^(2/3).
struct Grazing {
    stiffness: f64,
    compliance: f64,
    rate: f64,
}

impl Jacobian for Grazing {
    fn size(&self) -> usize {
        2
    }

    fn fill(&mut self, matrix: &mut [f64], active: &mut [bool]) -> Result<()> {
        active.fill(true);
        matrix.copy_from_slice(&[1.0, -self.rate, self.compliance, 1.0]);
        Ok(())
    }
}

impl Problem for Grazing {
    fn evaluate(&mut self, u: &[f64], p: f64, out: &mut Residual) -> Result<()> {
        let depth = u[0].max(0.0);
        self.rate = 1.5 * self.stiffness * depth.sqrt();
        out.values.copy_from_slice(&[
            u[0] + self.compliance * u[1] - p,
            u[1] - self.stiffness * depth.powf(1.5),
        ]);
        out.d_parameter.copy_from_slice(&[-1.0, 0.0]);
        out.scale = 1.0;
        Ok(())
    }

    fn observe(&self, _u: &[f64], _direction: &[f64]) -> (Complex64, Complex64) {
        (Complex64::ZERO, Complex64::ZERO)
    }

    fn initial_guess(&mut self, _kind: InitialGuess, _p: f64, _u: &mut [f64]) -> Result<bool> {
        Ok(false)
    }

    fn homotopy(&mut self, _p: f64, _u: &[f64]) -> Result<Option<Homotopy<'_>>> {
        Ok(None)
    }
}

/// The point at which the branch leaves the range from −1 to 1, and whether that is the end of the range.
fn followed(stiffness: f64, compliance: f64) -> (Point, bool) {
    let mut problem = Grazing {
        stiffness,
        compliance,
        rate: 0.0,
    };
    let settings = Settings {
        start: -1.0,
        end: 1.0,
        tolerance: 1e-12,
        max_iterations: 25,
        steps: StepControl::new(0.0, 0.0, 0.0),
    };
    let (mut v, none) = (vec![-1.0, 0.0, -1.0], Interrupt::none());
    let mut corrector = Corrector::new(2, 1e-12, 25).unwrap();
    let metric = Metric::along(1.0, &settings);
    let first = corrector.correct(&mut problem, &mut v, &[0.0, 0.0, 1.0], metric, false, &none);
    let Outcome::Converged(first) = first.unwrap() else {
        panic!("no first point");
    };
    let mut branch = Continuation::new(settings, Point::new(v, first, 0.0)).unwrap();
    for _ in 0..1000 {
        match branch.advance(&mut problem, &none).unwrap() {
            Advance::Accepted { last: false, .. } => {}
            Advance::Accepted { point, last: true } => return (point, true),
            Advance::LeftAtStart { point } => return (point, false),
            Advance::Stopped(status) => panic!("{stiffness:e}, {compliance}: {status:?}"),
        }
    }
    panic!("{stiffness:e}, {compliance}: more than 1000 points");
}

#[test]
fn a_branch_turns_where_a_stiff_contact_closes_and_pulls_it_back() {
    for stiffness in [1e2, 1e4, 1e6, 1e8, 1e10] {
        for compliance in [-2.0, -1.0, -0.5, 0.5, 1.0, 2.0] {
            let (point, at_end) = followed(stiffness, compliance);
            let [z, q, p] = point.v[..] else { unreachable!() };
            // Where the contact pulls the motion towards itself, the branch turns back at once.
            assert_eq!(at_end, compliance > 0.0, "{stiffness:e}, {compliance}");
            let depth = (q / stiffness).powf(2.0 / 3.0);
            assert!((z - depth).abs() < 1e-9, "{stiffness:e}, {compliance}: {z}, {depth}");
            assert!((z + compliance * q - p).abs() < 1e-9, "{stiffness:e}, {compliance}");
        }
    }
}
