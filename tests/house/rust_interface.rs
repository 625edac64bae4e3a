//! The public Rust interface (docs/rust-api.txt) names public types only: a user can name all that it takes and returns.

use std::collections::BTreeSet;

/// Words that begin with a capital.
fn types(text: &str) -> impl Iterator<Item = &str> {
    text.split(|c: char| !(c.is_alphanumeric() || c == '_'))
        .filter(|word| word.starts_with(|c: char| c.is_ascii_uppercase()))
}

/// Types of the standard library and of num-complex, a constant, and a comment of rustdoc.
const FOREIGN: [&str; 23] = [
    "Self",
    "Option",
    "Result",
    "Vec",
    "Into",
    "Arc",
    "Fn",
    "FnMut",
    "Complex64",
    "Complex",
    "String",
    "Iterator",
    "Item",
    "ExactSizeIterator",
    "Sync",
    "Send",
    "CStr",
    "Arguments",
    "Cow",
    "Error",
    "Debug",
    "ALL",
    "Required",
];

#[test]
fn methods_of_the_public_interface_name_public_types_only() {
    let list = std::fs::read_to_string(crate::root().join("docs/rust-api.txt")).unwrap();
    let declared: BTreeSet<&str> = ["pub struct ", "pub enum ", "pub trait ", "pub type "]
        .iter()
        .flat_map(|kind| list.split(kind).skip(1).filter_map(|rest| types(rest).next()))
        .collect();
    assert!(declared.len() > 60, "{declared:?}");
    for line in list.lines().filter(|line| line.contains("fn ")) {
        for name in types(line) {
            assert!(
                declared.contains(name) || FOREIGN.contains(&name),
                "{name} is not public, but in: {line}"
            );
        }
    }
}
