//! Checks of a refused call.

use crate::common::{BASE, all_harmonics, harmonics, solve_at};
use hbvib::{Model, Result, Status};
use std::f64::consts::TAU;

/// A frequency at which the base case slips.
pub const OMEGA: f64 = TAU * 208.85;

/// Asserts the status and that the sentence contains every one of `words`.
#[allow(clippy::needless_pass_by_value)]
pub fn refused<T>(result: Result<T>, status: Status, words: &[&str]) {
    let Err(error) = result else {
        panic!("accepted, needs {status:?} naming {words:?}");
    };
    assert_eq!(error.status, status, "{error}");
    for word in words {
        assert!(error.message().contains(word), "{error}: does not say {word}");
    }
}

/// Runs `attempts` on the blisk and checks that its results are unchanged.
pub fn unharmed(attempts: impl FnOnce(&mut Model)) {
    let mut model = BASE.sector();
    let answer = |model: &Model| all_harmonics(&solve_at(model, &harmonics(5), OMEGA), 0);
    let before = answer(&model);
    attempts(&mut model);
    assert!(answer(&model) == before, "the model has changed");
}
