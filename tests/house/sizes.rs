//! Types hold what belongs together: at most twelve fields, and methods in at most three files. Those that are larger are listed with
//! their size, which may fall only.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// Most fields of a type.
const FIELDS: usize = 12;

/// Most files with methods of a type.
const FILES: usize = 3;

/// Records with one field for each of a C struct, which users read or fill.
const RECORDS: [&str; 5] = ["SolverOptions", "Fit", "Verification", "Reduction", "Searched"];

/// Types with more fields, and their number.
const WIDE: [(&str, usize); 0] = [];

/// Types whose methods stand in more files, and their number.
const SPREAD: [(&str, usize); 0] = [];

fn sources(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            if !path.ends_with("capi") {
                sources(&path, found);
            }
        } else if path.extension().is_some_and(|e| e == "rs") && !path.to_string_lossy().ends_with("_tests.rs") {
            found.push(path);
        }
    }
}

/// The name that begins a text.
fn name(text: &str) -> &str {
    let end = text
        .find(|c: char| !c.is_alphanumeric() && c != '_')
        .unwrap_or(text.len());
    &text[..end]
}

/// A line without the visibility that it begins with.
fn without_visibility(line: &str) -> &str {
    let Some(rest) = line.strip_prefix("pub") else {
        return line;
    };
    match rest.strip_prefix('(') {
        Some(inside) => inside.split_once(") ").map_or(line, |(_, rest)| rest),
        None => rest.strip_prefix(' ').unwrap_or(line),
    }
}

/// Fields of each struct of a text as rustfmt writes it.
fn fields(text: &str) -> Vec<(String, usize)> {
    let mut found = Vec::new();
    let mut inside: Option<(String, usize)> = None;
    for line in text.lines() {
        if let Some((_, count)) = &mut inside {
            let is_field = line.strip_prefix("    ").is_some_and(|rest| {
                let rest = without_visibility(rest);
                let own = name(rest);
                !own.is_empty() && rest[own.len()..].starts_with(':') && !rest[own.len()..].starts_with("::")
            });
            *count += usize::from(is_field);
            if line == "}" {
                found.extend(inside.take());
            }
        } else if let Some(rest) = without_visibility(line).strip_prefix("struct ")
            && line.ends_with('{')
        {
            inside = Some((name(rest).to_owned(), 0));
        }
    }
    found
}

/// The types to which a text adds methods of their own.
fn extended(text: &str) -> BTreeSet<String> {
    let own = |line: &str| {
        let mut rest = line.strip_prefix("impl")?;
        if rest.starts_with('<') {
            rest = &rest[rest.find("> ")? + 1..];
        }
        let rest = rest.strip_prefix(' ')?;
        (line.ends_with('{') && !rest.contains(" for ")).then(|| name(rest).to_owned())
    };
    text.lines().filter_map(own).collect()
}

fn all() -> Vec<(PathBuf, String)> {
    let mut found = Vec::new();
    for folder in ["src", "crates/numerics/src", "crates/dissection/src"] {
        sources(&crate::root().join(folder), &mut found);
    }
    assert!(found.len() > 300);
    found
        .into_iter()
        .map(|path| (path.clone(), fs::read_to_string(path).unwrap()))
        .collect()
}

#[test]
fn types_have_few_fields() {
    let wide: BTreeMap<String, usize> = all()
        .iter()
        .flat_map(|(_, text)| fields(text))
        .filter(|(name, count)| *count > FIELDS && !RECORDS.contains(&name.as_str()))
        .collect();
    let known = WIDE.map(|(name, count)| (name.to_owned(), count)).into();
    assert_eq!(
        wide, known,
        "group the fields by what belongs together, or take out of the list what became smaller"
    );
}

#[test]
fn methods_of_a_type_stand_in_few_files() {
    let mut files: BTreeMap<String, usize> = BTreeMap::new();
    for (_, text) in all() {
        for name in extended(&text) {
            *files.entry(name).or_default() += 1;
        }
    }
    files.retain(|_, count| *count > FILES);
    let known = SPREAD.map(|(name, count)| (name.to_owned(), count)).into();
    assert_eq!(
        files, known,
        "make a function of a method, or take out of the list what became smaller"
    );
}

#[test]
fn fields_and_methods_are_counted() {
    let text = "pub(crate) struct Two<'a> {\n    /// One.\n    pub one: &'a [f64],\n    two: Vec<(usize, f64)>,\n}\n\nimpl<'a> Two<'a> {\n}\n\nimpl Clone for Two<'_> {\n}\n";
    assert_eq!(fields(text), [("Two".to_owned(), 2)]);
    assert_eq!(extended(text), BTreeSet::from(["Two".to_owned()]));
}
