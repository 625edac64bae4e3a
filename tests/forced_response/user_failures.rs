//! Callbacks that fail within a solve: what can be tried again is, what cannot ends the branch with the
//! points found, and no number that is not finite comes out.

use crate::common::models::oscillator;
use crate::common::{amplitude_range, harmonics, omega_range};
use hbvib::{
    Branch, Call, Contact, ContactKind, Hooks, Model, Result, Status, User, UserForce, forced_response, nonlinear_mode,
};
use num_complex::Complex64;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Event at the k-th call.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Failure {
    Code(i32),
    Force(f64),
    Tangent(f64),
}

/// f = u³ and v/10, which fails at call `at` (from 0), from there on if `forever`, and where |u| exceeds
/// `cutoff`.
struct Frail {
    calls: AtomicUsize,
    at: usize,
    forever: bool,
    failure: Failure,
    cutoff: f64,
}

impl Frail {
    fn new(at: usize, forever: bool, failure: Failure) -> Self {
        Self {
            calls: AtomicUsize::new(0),
            at,
            forever,
            failure,
            cutoff: f64::INFINITY,
        }
    }
}

impl UserForce for Frail {
    fn evaluate(&self, call: &mut Call<'_>) -> i32 {
        let number = self.calls.fetch_add(1, Ordering::Relaxed);
        let mut far = false;
        for j in 0..call.samples {
            let (u, v) = (call.u[j], call.v[j]);
            assert!(u.is_finite() && v.is_finite());
            far |= u.abs() > self.cutoff;
            call.f[j] = u * u * u + 0.1 * v;
            call.df_du[j] = 3.0 * u * u;
            call.df_dv[j] = 0.1;
        }
        if far || number == self.at || (self.forever && number > self.at) {
            match self.failure {
                Failure::Code(code) => return code,
                Failure::Force(f) => call.f[3] = f,
                Failure::Tangent(t) => call.df_du[3] = t,
            }
        }
        0
    }
}

fn model(force: Arc<Frail>) -> Model {
    let law = User {
        odd: true,
        ..User::new(force, 1, 0).unwrap()
    };
    let contact = Contact::over(vec![0], ContactKind::User(law));
    oscillator(1.0, 1.0).force(0, 1, 0.2).contact(&contact).build()
}

fn respond(force: &Arc<Frail>) -> Result<Branch> {
    let solver = harmonics(3);
    let range = omega_range(0.5, 2.0);
    forced_response(&model(force.clone()), &solver, &range, &mut Hooks::default())
}

fn mode(force: &Arc<Frail>) -> Result<Branch> {
    let solver = harmonics(3);
    let range = amplitude_range(-2.0, 0.0);
    nonlinear_mode(&model(force.clone()), &solver, &range, &mut Hooks::default())
}

type Analysis = fn(&Arc<Frail>) -> Result<Branch>;

/// Everything that a branch has must be finite.
fn is_finite(branch: &Branch) -> bool {
    let values = [branch.omega(), branch.amplitude(), branch.residual()];
    values.iter().all(|v| v.iter().all(|x| x.is_finite()))
}

#[test]
fn a_failure_that_another_motion_may_not_meet_is_overcome_wherever_it_happens() {
    for (name, analysis) in [("response", respond as Analysis), ("mode", mode)] {
        let sound = Arc::new(Frail::new(usize::MAX, false, Failure::Code(1)));
        let whole = analysis(&sound).unwrap();
        let calls = sound.calls.load(Ordering::Relaxed);
        assert_eq!(whole.status(), Status::Ok);
        let last = |branch: &Branch| branch.amplitude()[branch.points() - 1];
        let (mut overcome, mut stopped, mut failed) = (0, 0, 0);
        for at in (0..calls).step_by(1 + calls / 150) {
            for failure in [
                Failure::Code(4),
                Failure::Force(f64::NAN),
                Failure::Tangent(f64::INFINITY),
            ] {
                let frail = Arc::new(Frail::new(at, false, failure));
                match analysis(&frail) {
                    Ok(branch) if branch.status() == Status::Ok => {
                        overcome += 1;
                        assert!(is_finite(&branch));
                        assert!(
                            (last(&branch) / last(&whole) - 1.0).abs() < 1e-7,
                            "call {at}, {failure:?}"
                        );
                    }
                    // Where a point was being stored, nothing else can be tried.
                    Ok(branch) => {
                        stopped += 1;
                        assert_eq!(branch.status(), Status::StoppedCallback, "call {at}, {failure:?}");
                        let reason = branch.reason().unwrap();
                        assert!(reason.status == Status::Callback && reason.message().starts_with("contact 0: "));
                        assert!(is_finite(&branch) && branch.points() > 0);
                    }
                    Err(e) => {
                        failed += 1;
                        assert_eq!(e.status, Status::Callback, "call {at}, {failure:?}: {e}");
                    }
                }
            }
        }
        println!("{name}: {calls} calls; overcome {overcome}, stopped {stopped}, failed {failed}");
        assert!(name == "mode" || failed == 0);
        assert!(overcome > 3 * (stopped + failed));
    }
}

#[test]
fn a_callback_that_gives_up_ends_the_branch_with_its_points_and_its_code() {
    for (name, analysis) in [("response", respond as Analysis), ("mode", mode)] {
        let sound = Arc::new(Frail::new(usize::MAX, false, Failure::Code(1)));
        let whole = analysis(&sound).unwrap();
        let calls = sound.calls.load(Ordering::Relaxed);
        let (mut kept, mut without) = (0, 0);
        for at in (0..calls).step_by(1 + calls / 150) {
            let frail = Arc::new(Frail::new(at, false, Failure::Code(-7)));
            match analysis(&frail) {
                Ok(branch) => {
                    kept += 1;
                    assert_eq!(branch.status(), Status::StoppedCallback, "call {at}");
                    let reason = branch.reason().unwrap();
                    assert!(
                        reason.callback == -7 && reason.message().contains("contact 0: the force callback returned -7")
                    );
                    let n = branch.points();
                    assert!(n > 0 && branch.omega() == &whole.omega()[..n]);
                    assert_eq!(branch.amplitude(), &whole.amplitude()[..n]);
                    assert_eq!(branch.slip_fraction().len(), n);
                    // It is never called again.
                    assert_eq!(frail.calls.load(Ordering::Relaxed), at + 1);
                }
                Err(e) => {
                    without += 1;
                    assert!(
                        e.status == Status::Callback && e.callback == -7 && !e.recoverable,
                        "{e}"
                    );
                    assert_eq!(frail.calls.load(Ordering::Relaxed), at + 1);
                }
            }
        }
        println!("{name}: {kept} branches with points, {without} without");
        assert!(kept > 10 && without > 0);
    }
}

#[test]
fn a_failure_that_stays_ends_in_bounded_time_with_its_reason() {
    for analysis in [respond as Analysis, mode] {
        for failure in [Failure::Code(5), Failure::Force(f64::NAN), Failure::Tangent(f64::NAN)] {
            // From the first call on there is no point.
            let e = analysis(&Arc::new(Frail::new(0, true, failure))).unwrap_err();
            assert_eq!(e.status, Status::Callback, "{e}");
            let word = match failure {
                Failure::Code(_) => "returned 5",
                Failure::Force(_) => "f[3,0] = NaN",
                Failure::Tangent(_) => "df_du[3,0,0] = NaN",
            };
            assert!(e.message().contains(word), "{e}");
            // Beyond a motion that the force does not know, the branch ends just before.
            let frail = Arc::new(Frail {
                cutoff: 0.5,
                ..Frail::new(usize::MAX, false, failure)
            });
            let branch = analysis(&frail).unwrap();
            let largest = branch.amplitude().iter().fold(0.0_f64, |m, a| m.max(*a));
            println!(
                "{failure:?}: {} points up to {largest}, {} calls: {}",
                branch.points(),
                frail.calls.load(Ordering::Relaxed),
                branch.reason().unwrap()
            );
            assert_eq!(branch.status(), Status::StoppedCallback);
            assert!(branch.reason().unwrap().message().contains(&word[word.len() - 4..]));
            assert!(largest > 0.4 && largest < 0.51 && is_finite(&branch));
        }
    }
}

#[test]
fn results_ask_the_callback_again_and_keep_its_code() {
    let frail = Arc::new(Frail::new(usize::MAX, false, Failure::Code(-9)));
    let branch = respond(&frail).unwrap();
    let calls = frail.calls.load(Ordering::Relaxed);
    let mut x = vec![Complex64::ZERO; 4];
    branch.harmonics_at(3, &mut x).unwrap();
    assert!(frail.calls.load(Ordering::Relaxed) > calls);
    assert!((x[1].norm() / branch.amplitude()[3] - 1.0).abs() < 1e-8);

    let frail = Arc::new(Frail::new(calls, true, Failure::Code(-9)));
    let branch = respond(&frail).unwrap();
    let kept = x.clone();
    let e = branch.harmonics_at(3, &mut x).unwrap_err();
    assert!(e.status == Status::Callback && e.callback == -9 && x == kept);
}
