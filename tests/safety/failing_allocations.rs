//! A failing request for memory is HBVIB_E_OUT_OF_MEMORY, wherever it fails: no process ends, nothing leaks, no result
//! changes, and the model solves again to the same bits. Each request fails once alone, and once with all later ones.

use crate::common::programs::run;
use crate::programs::{compile, failing_malloc, workshop};
use std::process::Command;

/// Lets the first and then about one in `share` of all requests fail; the last line of the program counts them.
fn failing(test: &str, share: usize) -> String {
    let folder = workshop(test);
    let preloaded = failing_malloc(&folder);
    let program = compile("failing_allocations", &folder, &[preloaded.to_str().unwrap()]);
    let output = run(Command::new(program)
        .arg(share.to_string())
        .env("LD_PRELOAD", &preloaded)
        .env("RUST_BACKTRACE", "0"));
    let text = String::from_utf8(output.stdout).unwrap();
    println!("{text}");
    text.lines().last().unwrap().to_owned()
}

/// The number before a word in a line of counts.
fn count(line: &str, word: &str) -> usize {
    let (before, _) = line.split_once(word).unwrap();
    before
        .split([' ', ','])
        .rfind(|part| !part.is_empty())
        .unwrap()
        .parse()
        .unwrap()
}

#[test]
fn the_first_failing_requests_of_each_analysis_and_some_later_ones_are_refused() {
    let line = failing("shallow", 400);
    assert!(count(&line, " failing requests") >= 1500, "{line}");
    assert!(count(&line, " refused") > count(&line, " without effect"), "{line}");
    assert_eq!((count(&line, " deaths"), count(&line, " others")), (0, 0), "{line}");
}

#[test]
#[ignore = "takes half an hour"]
fn every_failing_request_is_refused_or_without_effect() {
    let line = failing("deep", 1);
    assert!(count(&line, " failing requests") > 250_000, "{line}");
    assert_eq!((count(&line, " deaths"), count(&line, " others")), (0, 0), "{line}");
}
