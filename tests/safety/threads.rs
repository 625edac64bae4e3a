//! Threads that share models have the bits of one thread, while others cancel their calls and try to change the models.

use crate::common::programs::run;
use crate::programs::{compile, workshop};
use std::process::Command;

#[test]
fn threads_that_share_models_have_the_bits_of_one() {
    let folder = workshop("threads");
    let program = compile("threads", &folder, &["-Wno-unused-function"]);
    let output = run(Command::new(program).args(["4", "10"]));
    let text = String::from_utf8(output.stdout).unwrap();
    println!("{text}");
    assert!(text.ends_with(" 0 failures\n"), "{text}");
}
