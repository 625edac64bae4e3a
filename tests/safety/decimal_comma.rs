//! A caller whose locale has a decimal comma gets the same results, saved models and sentences, and its locale stays.

use crate::common::decimal_comma::{NAME, locale};
use crate::common::programs::run;
use crate::programs::{compile, workshop};
use std::process::Command;

#[test]
fn a_decimal_comma_changes_nothing() {
    let folder = workshop("decimal_comma");
    let program = compile("decimal_comma", &folder, &["-Wno-unused-function"]);
    let output = run(Command::new(program).arg(NAME).env("LOCPATH", locale(&folder)));
    assert_eq!(
        String::from_utf8_lossy(&output.stdout),
        "the same with a decimal comma\n"
    );
}
