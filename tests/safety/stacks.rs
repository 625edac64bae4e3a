//! 256 KiB of stack suffice for every analysis, 128 KiB for each of small models, and 64 KiB for building these, their forced
//! responses and their modes, shown by threads that have no more.

use crate::common::programs::run;
use crate::programs::{compile, workshop};
use std::process::Command;

/// Runs analyses on a stack of some bytes; the program prints the use of each.
fn runs(test: &str, bytes: usize, which: &[&str], least: usize) {
    let folder = workshop(test);
    let program = compile("stacks", &folder, &[]);
    let output = run(Command::new(program).arg(bytes.to_string()).args(which));
    let text = String::from_utf8(output.stdout).unwrap();
    println!("{text}");
    let last = format!("of {bytes} bytes at most\n");
    assert!(text.lines().count() > least && text.ends_with(&last), "{text}");
}

#[test]
fn every_analysis_runs_on_a_stack_of_128_kib() {
    runs("stacks", 128 << 10, &[], 20);
}

#[test]
fn large_chains_are_solved_on_a_stack_of_256_kib() {
    runs("large_stacks", 256 << 10, &["large"], 20);
}

#[test]
fn small_models_are_solved_on_a_stack_of_64_kib() {
    runs("small_stacks", 64 << 10, &["small"], 70);
}
