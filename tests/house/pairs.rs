//! Parameters that are pairs: a caller reads them without names, so that a struct is better where a pair recurs. Their number may fall only.

use std::fs;
use std::path::Path;

/// Most parameters of functions of the library, without the C interface and unit tests, whose type is a tuple.
const MOST_PAIRS: usize = 392;

/// The number is lowered when it has fallen by so many: branches under way may have some of them.
const SLACK: usize = 20;

/// Parts of a text between commas that stand in no bracket.
fn parts(text: &str) -> Vec<&str> {
    let (mut found, mut depth, mut start, mut before) = (Vec::new(), 0_i32, 0, ' ');
    for (at, c) in text.char_indices() {
        match c {
            '(' | '[' | '{' | '<' => depth += 1,
            ')' | ']' | '}' => depth -= 1,
            '>' if before != '-' => depth -= 1,
            ',' if depth == 0 => {
                found.push(text[start..at].trim());
                start = at + 1;
            }
            _ => {}
        }
        before = c;
    }
    found.push(text[start..].trim());
    found
}

/// The text inside the round brackets with which a text begins.
fn bracketed(text: &str) -> &str {
    let mut depth = 0_i32;
    for (at, c) in text.char_indices() {
        depth += i32::from(c == '(') - i32::from(c == ')');
        if depth == 0 {
            return &text[1..at];
        }
    }
    text
}

/// The type of a parameter as it is written after its pattern.
fn type_of(parameter: &str) -> &str {
    let mut depth = 0_i32;
    for (at, c) in parameter.char_indices() {
        match c {
            '(' | '[' | '{' | '<' => depth += 1,
            ')' | ']' | '}' | '>' => depth -= 1,
            ':' if depth == 0 => return parameter[at + 1..].trim(),
            _ => {}
        }
    }
    ""
}

/// Number of parameters of the functions of a file whose type is a tuple.
fn pairs(source: &str) -> usize {
    let own: String = source
        .lines()
        .take_while(|line| *line != "#[cfg(test)]")
        .map(|line| line.split("//").next().unwrap_or("").to_owned() + "\n")
        .collect();
    let mut found = 0;
    for (at, _) in own.match_indices("fn ") {
        let rest = &own[at + 3..];
        let name = rest.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(0);
        if name == 0 || own[..at].ends_with(|c: char| c.is_alphanumeric() || c == '_') {
            continue;
        }
        // Bounds of a generic parameter may have brackets of their own.
        let mut depth = 0_i32;
        let open = rest.char_indices().skip(name).find(|(_, c)| {
            depth += i32::from(*c == '<') - i32::from(*c == '>');
            *c == '(' && depth == 0
        });
        if let Some((open, _)) = open {
            let parameters = parts(bracketed(&rest[open..]));
            found += parameters.iter().filter(|p| type_of(p).starts_with('(')).count();
        }
    }
    found
}

fn all(folder: &Path) -> usize {
    let mut found = 0;
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            found += if path.ends_with("capi") { 0 } else { all(&path) };
        } else if path.extension().is_some_and(|end| end == "rs") && !path.to_string_lossy().ends_with("_tests.rs") {
            found += pairs(&fs::read_to_string(path).unwrap());
        }
    }
    found
}

#[test]
fn parameters_that_are_pairs_become_fewer() {
    let found: usize = ["src", "crates/numerics/src"]
        .iter()
        .map(|folder| all(&crate::root().join(folder)))
        .sum();
    assert!(
        found <= MOST_PAIRS,
        "{found} parameters are tuples, at most {MOST_PAIRS} were: name the parts by a struct, or pass them one by one"
    );
    assert!(
        found + SLACK > MOST_PAIRS,
        "{found} parameters are tuples: lower MOST_PAIRS from {MOST_PAIRS}"
    );
}

#[test]
fn pairs_are_counted_in_every_form() {
    assert_eq!(
        pairs("fn one((a, b): (f64, f64), c: &[(usize, f64)]) -> (f64, f64) {}"),
        1
    );
    assert_eq!(
        pairs(
            "    pub fn two<'a>(\n        &self,\n        at: (usize, usize),\n        mut by: (&'a [f64], f64),\n    ) {}"
        ),
        2
    );
    assert_eq!(
        pairs("fn three<F: Fn(f64) -> (f64, f64)>(f: F, x: f64) {}\n// fn four(a: (f64, f64)) {}"),
        0
    );
    assert_eq!(pairs("#[cfg(test)]\nfn five(a: (f64, f64)) {}"), 0);
}
