//! Memory over the life of a process: unloading the library leaves nothing behind, and creating, solving and freeing does
//! not grow.

use crate::common::programs::{library, run};
use crate::programs::{compile, compile_alone, failing_malloc, workshop};
use std::process::Command;

#[test]
fn unloading_leaves_nothing_behind() {
    let folder = workshop("unloading");
    let preloaded = failing_malloc(&folder);
    let program = compile_alone("unloading", &folder, &[preloaded.to_str().unwrap()]);
    let output = run(Command::new(program)
        .arg(library())
        .arg("50")
        .env("LD_PRELOAD", &preloaded));
    assert_eq!(String::from_utf8_lossy(&output.stdout), "0 blocks after 50 times\n");
}

/// Growth of the resident memory over the last nine tenths of some cycles, in bytes.
fn growth(test: &str, times: usize) -> i64 {
    let folder = workshop(test);
    let program = compile("cycles", &folder, &[]);
    let output = run(Command::new(program).arg(times.to_string()));
    let text = String::from_utf8(output.stdout).unwrap();
    let numbers: Vec<i64> = text.split_whitespace().map(|n| n.parse().unwrap()).collect();
    println!(
        "{times} cycles: {} bytes resident after a tenth of them, {} at the end",
        numbers[0], numbers[1]
    );
    numbers[1] - numbers[0]
}

#[test]
fn a_thousand_cycles_do_not_grow() {
    assert!(growth("cycles", 1000) < 1 << 20);
}

#[test]
#[ignore = "takes minutes"]
fn a_hundred_thousand_cycles_do_not_grow() {
    assert!(growth("many_cycles", 100_000) < 1 << 20);
}

#[test]
fn calls_at_the_end_of_a_process_have_the_results_of_earlier_ones() {
    let folder = workshop("late_calls");
    let program = compile("late_calls", &folder, &["-Wno-unused-function"]);
    let output = run(&mut Command::new(program));
    assert_eq!(
        String::from_utf8_lossy(&output.stdout),
        "the same in atexit\nthe same in a destructor\n"
    );
}
