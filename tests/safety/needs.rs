//! Evaluations at a given motion need no more bytes than the header tells, and are refused before they ask for more than
//! a limit.

use crate::common::programs::run;
use crate::programs::{compile, failing_malloc, workshop};
use std::process::Command;

#[test]
fn an_evaluation_needs_no_more_than_is_told() {
    let folder = workshop("needs");
    let preloaded = failing_malloc(&folder);
    let program = compile("needs", &folder, &["-Wno-unused-function", preloaded.to_str().unwrap()]);
    let output = run(Command::new(program).env("LD_PRELOAD", &preloaded));
    let text = String::from_utf8(output.stdout).unwrap();
    println!("{text}");
    assert!(text.ends_with(" 0 failures\n"), "{text}");
}
