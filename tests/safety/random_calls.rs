//! Random sequences of calls with good and extreme values do no harm, report nothing after a stop, and each takes no more than its
//! predicted memory; a third of the solves and more have a result. For hours:
//! compile tests/safety/random_calls.c as this test does, and run it with a seed and a time in seconds.

use crate::common::programs::{run, two_at_a_time};
use crate::programs::{compile, failing_malloc, workshop};
use std::process::Command;

/// Seconds of processor time after which a call is stopped.
const STOPPED_AFTER: f64 = 0.04;

/// Runs the calls of a seed for some seconds of processor time, at most so many; the last line of the program counts them.
fn calls(test: &str, seed: usize, seconds: usize, most: usize) {
    let folder = workshop(test);
    let preloaded = failing_malloc(&folder);
    let program = compile("random_calls", &folder, &[preloaded.to_str().unwrap()]);
    let output = run(Command::new(program)
        .args([seed, seconds, most].map(|number| number.to_string()))
        .arg(STOPPED_AFTER.to_string())
        .env("LD_PRELOAD", &preloaded));
    let text = String::from_utf8(output.stdout).unwrap();
    println!("{text}");
    assert!(text.lines().last().unwrap().ends_with(" 0 failures"), "{text}");
}

#[test]
fn random_calls_do_no_harm() {
    // `a_million_random_calls_do_no_harm` goes on where this ends.
    two_at_a_time(&[1, 2], |&seed| {
        calls(&format!("random_calls_{seed}"), seed, 8, usize::MAX >> 1);
    });
}

#[test]
#[ignore = "takes half an hour"]
fn a_million_random_calls_do_no_harm() {
    calls("many_random_calls", 1000, 1_000_000, 1_000_000);
}
