//! Random sequences of calls with good and extreme values do no harm; a third of the solves and more have a result. For hours:
//! compile tests/safety/random_calls.c as this test does, and run it with a seed and a time in seconds.

use crate::common::programs::run;
use crate::programs::{compile, failing_malloc, workshop};
use std::process::Command;

/// Runs the calls of a seed for some seconds of processor time; the last line of the program counts them.
fn calls(test: &str, seed: usize, seconds: usize) {
    let folder = workshop(test);
    let preloaded = failing_malloc(&folder);
    let program = compile("random_calls", &folder, &[preloaded.to_str().unwrap()]);
    let output = run(Command::new(program)
        .args([seed.to_string(), seconds.to_string()])
        .env("LD_PRELOAD", &preloaded));
    let text = String::from_utf8(output.stdout).unwrap();
    println!("{text}");
    assert!(text.lines().last().unwrap().ends_with(" 0 failures"), "{text}");
}

#[test]
fn random_calls_do_no_harm() {
    for seed in 1..=3 {
        calls("random_calls", seed, 2);
    }
}

#[test]
#[ignore = "takes ten minutes"]
fn many_random_calls_do_no_harm() {
    for seed in 1000..1010 {
        calls("many_random_calls", seed, 60);
    }
}
