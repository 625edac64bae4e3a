//! The numbers by which the library decides are listed in docs/thresholds.md, from their declarations, and names that stand for several
//! values become fewer.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};

/// Names that stand for several values today. A new constant has a name of its own; the number only falls.
const SHARED_NAMES: usize = 26;

const INTRODUCTION: &str = "\
# Thresholds

Named numbers of the library, by the folders of `src/` and `crates/numerics/src/`, without the C interface: tolerances, limits of work,
sizes of blocks, and numbers that were tuned. Each row is made from the declaration and its comment. A test fails where the page
is out of date; CONTRIBUTING.md has the command that writes it.
";

/// A named number, or several in a tuple or a list.
struct Threshold {
    name: String,
    value: String,
    /// Its documentation, or that of the constant above it in one block.
    meaning: String,
    /// File from `src/`.
    file: String,
}

fn root() -> &'static Path {
    crate::root()
}

/// Files in Rust below a folder, but for the C interface and files of unit tests.
fn sources(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().and_then(|name| name.to_str()).unwrap_or("");
        if path.is_dir() {
            if name != "capi" {
                sources(&path, found);
            }
        } else if path.extension().is_some_and(|of| of == "rs") && !name.ends_with("_tests.rs") {
            found.push(path);
        }
    }
}

/// Whether a type has numbers alone: `f64`, `(usize, f64)`, `[f64; 3]`.
fn is_numeric(kind: &str) -> bool {
    let words = kind.split(|c: char| !c.is_ascii_alphanumeric());
    let mut words = words.filter(|word| !word.is_empty() && word.parse::<usize>().is_err());
    kind != "[u8; 8]" && words.all(|word| ["f64", "f32", "usize", "u8", "u32", "u64", "i32"].contains(&word))
}

/// Name, type and value of the constant that a text begins with; its visibility stands before it.
fn declared(text: &str) -> Option<(&str, &str, String)> {
    let start = text.find("const ").filter(|at| *at == 0 || text.starts_with("pub"))?;
    let (name, rest) = text[start + 6..].split_once(": ")?;
    let (kind, rest) = rest.split_once(" = ")?;
    // A semicolon inside brackets belongs to the value.
    let mut depth = 0;
    let end = rest.find(|c| {
        depth += i32::from("([{".contains(c)) - i32::from(")]}".contains(c));
        c == ';' && depth == 0
    })?;
    let value = rest[..end].split_whitespace().collect::<Vec<_>>().join(" ");
    let upper = name
        .chars()
        .all(|c| c.is_ascii_uppercase() || c.is_ascii_digit() || c == '_');
    (upper && name != "_" && is_numeric(kind)).then_some((name, kind, value))
}

fn thresholds() -> Vec<Threshold> {
    let crates = [root().join("src"), root().join("crates/numerics/src")];
    let mut paths = Vec::new();
    for folder in &crates {
        sources(folder, &mut paths);
    }
    let mut found = Vec::new();
    for path in paths {
        let text = fs::read_to_string(&path).unwrap();
        let text = text.split("\n#[cfg(test)]\nmod ").next().unwrap();
        let own = crates.iter().find_map(|folder| path.strip_prefix(folder).ok());
        let file = own.unwrap().display().to_string();
        let (mut comment, mut at) = (String::new(), 0);
        for line in text.split_inclusive('\n') {
            let code = line.trim();
            if let Some(words) = code.strip_prefix("///") {
                comment += words;
            } else if let Some((name, _, value)) = declared(text[at..].trim_start()).filter(|_| code.contains("const "))
            {
                found.push(Threshold {
                    name: name.to_owned(),
                    value,
                    meaning: comment.trim().replace('|', "\\|"),
                    file: file.clone(),
                });
                // One comment may stand above a block of constants.
                at += line.len();
                if !text[at..].trim_start_matches(' ').starts_with("///") {
                    continue;
                }
                comment.clear();
                continue;
            } else if !code.starts_with("#[") {
                comment.clear();
            }
            at += line.len();
        }
    }
    found
}

fn page() -> String {
    let mut rooms: BTreeMap<String, Vec<Threshold>> = BTreeMap::new();
    for threshold in thresholds() {
        let room = threshold.file.split(['/', '.']).next().unwrap().to_owned();
        rooms.entry(room).or_default().push(threshold);
    }
    let mut text = INTRODUCTION.to_owned();
    for (room, list) in rooms {
        write!(
            text,
            "\n## {room}\n\n| name | value | meaning | file |\n|---|---|---|---|\n"
        )
        .unwrap();
        for row in list {
            let Threshold {
                name,
                value,
                meaning,
                file,
            } = row;
            writeln!(text, "| `{name}` | `{value}` | {meaning} | `{file}` |").unwrap();
        }
    }
    text
}

#[test]
fn the_page_of_thresholds_is_current() {
    let (path, text) = (root().join("docs/thresholds.md"), page());
    if std::env::var_os("HBVIB_WRITE_INDEX").is_some() {
        fs::write(&path, &text).unwrap();
    }
    assert!(
        fs::read_to_string(&path).is_ok_and(|old| old == text),
        "docs/thresholds.md is out of date: HBVIB_WRITE_INDEX=1 cargo test --release --test house thresholds writes it"
    );
}

#[test]
fn every_threshold_has_a_meaning() {
    let silent = thresholds().into_iter().filter(|row| row.meaning.is_empty());
    let silent: Vec<String> = silent.map(|row| format!("{} in {}", row.name, row.file)).collect();
    assert!(silent.is_empty(), "constants without a comment: {silent:?}");
}

#[test]
fn names_that_stand_for_several_values_become_fewer() {
    let mut values: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for row in thresholds() {
        values.entry(row.name).or_default().insert(row.value);
    }
    let shared: Vec<&String> = values
        .iter()
        .filter(|(_, all)| all.len() > 1)
        .map(|(name, _)| name)
        .collect();
    let count = shared.len();
    assert!(
        count <= SHARED_NAMES,
        "{count} names stand for several values, were {SHARED_NAMES}: {shared:?}"
    );
    assert!(
        count == SHARED_NAMES,
        "{count} names stand for several values: SHARED_NAMES may fall to that"
    );
}
