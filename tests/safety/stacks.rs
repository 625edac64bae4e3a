//! 128 KiB of stack suffice for every analysis, shown by threads that have no more.

use crate::common::programs::run;
use crate::programs::{compile, workshop};
use std::process::Command;

#[test]
fn every_analysis_runs_on_a_stack_of_128_kib() {
    let folder = workshop("stacks");
    let program = compile("stacks", &folder, &[]);
    let output = run(Command::new(program).arg((128 << 10).to_string()));
    let text = String::from_utf8(output.stdout).unwrap();
    println!("{text}");
    assert!(
        text.lines().count() > 20 && text.contains("of 131072 bytes at most"),
        "{text}"
    );
}
