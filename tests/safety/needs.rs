//! Evaluations at a given motion need no more bytes than the header tells, and are refused before they ask for more than
//! a limit; analyses of a wheel of very many sectors stop at once, and take no memory for its sectors; a thread keeps little.

use crate::common::programs::run;
use crate::programs::{compile, failing_malloc, workshop};
use std::process::Command;

fn has_no_failures(name: &str) {
    let folder = workshop(name);
    let preloaded = failing_malloc(&folder);
    let program = compile(name, &folder, &["-Wno-unused-function", preloaded.to_str().unwrap()]);
    let output = run(Command::new(program).env("LD_PRELOAD", &preloaded));
    let text = String::from_utf8(output.stdout).unwrap();
    println!("{text}");
    assert!(text.ends_with(" 0 failures\n"), "{text}");
}

#[test]
fn an_evaluation_needs_no_more_than_is_told() {
    has_no_failures("needs");
}

#[test]
fn a_wheel_of_very_many_sectors_stops_at_once_and_takes_no_memory_for_them() {
    has_no_failures("large_wheel");
}

#[test]
fn a_thread_keeps_four_mebibytes_until_it_ends() {
    has_no_failures("kept_by_a_thread");
}
