//! The numbers by which the library decides: docs/thresholds.md lists them from their declarations. Each has a name of its own and a
//! comment that ends with its kind.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};

/// The kinds, in the order of the page, and their meanings.
const KINDS: [(&str, &str); 5] = [
    (
        "tuned",
        "chosen for speed or robustness, by measurements: others would do",
    ),
    (
        "rounding",
        "the digits of a number, or an accuracy far below any that a caller asks",
    ),
    ("cap", "bounds work, memory or size; met where something fails"),
    (
        "block",
        "things done at once or between two checks of a stop, and operations counted for these",
    ),
    (
        "fixed",
        "follows from mathematics, the method, a format or the interface",
    ),
];

/// Remark of a tuned number whose measurement nobody knows.
const NOT_RECORDED: &str = "not recorded";

const INTRODUCTION: &str = "\
# Thresholds

Named numbers of the library, by the folders of `src/`, `crates/numerics/src/` and `crates/dissection/src/`, without the C interface. Each
row is made from the declaration and its comment, whose last sentence is the kind: `Kind: cap.`, or with a remark `Kind: cap; two or three
suffice.` A tuned number says on what it was measured: `Kind: tuned; measured on: chains of 100 to 600 masses.` A test fails where the page
is out of date, a name stands for two numbers or a kind is missing; CONTRIBUTING.md has the command that writes the page.

`tests/ledger` changes tuned numbers by a half and by two, and compares answers and work of stored cases.
";

/// A named number, or several in a tuple or a list.
struct Threshold {
    name: String,
    value: String,
    /// Its documentation without the kind, or that of the constant above it in one block.
    meaning: String,
    /// Kind and the remark behind it; empty where there is none.
    kind: (String, String),
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

/// Types of numbers, and of what is made of numbers that decide.
const NUMBERS: [&str; 9] = ["f64", "f32", "usize", "u8", "u32", "u64", "i32", "Effort", "Duration"];

/// Whether a type has numbers alone: `f64`, `(usize, f64)`, `[f64; 3]`.
fn is_numeric(kind: &str) -> bool {
    let words = kind.split(|c: char| !c.is_ascii_alphanumeric());
    let mut words = words.filter(|word| !word.is_empty() && word.parse::<usize>().is_err());
    kind != "[u8; 8]" && words.all(|word| NUMBERS.contains(&word))
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

/// A comment without its sentence on the kind, the kind, and the remark of that sentence.
fn kind_of(comment: &str) -> (String, String, String) {
    let Some((meaning, rest)) = comment.split_once("Kind: ") else {
        return (comment.to_owned(), String::new(), String::new());
    };
    let end = rest.find(". ").unwrap_or(rest.len().saturating_sub(1));
    let (sentence, after) = (&rest[..end], rest[end..].trim_start_matches('.'));
    let (kind, remark) = sentence.split_once("; ").unwrap_or((sentence, ""));
    let meaning = format!("{}{after}", meaning.trim_end());
    (meaning, kind.to_owned(), remark.to_owned())
}

fn thresholds() -> Vec<Threshold> {
    let crates = ["src", "crates/numerics/src", "crates/dissection/src"].map(|folder| root().join(folder));
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
                let (meaning, kind, remark) = kind_of(comment.trim());
                found.push(Threshold {
                    name: name.to_owned(),
                    value,
                    meaning: meaning.replace('|', "\\|"),
                    kind: (kind, remark.replace('|', "\\|")),
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

/// Number of thresholds of a kind.
fn count(all: &[Threshold], kind: &str) -> usize {
    all.iter().filter(|row| row.kind.0 == kind).count()
}

fn page() -> String {
    let all = thresholds();
    let mut text = format!("{INTRODUCTION}\n| kind | meaning | numbers |\n|---|---|---|\n");
    for (kind, meaning) in KINDS {
        writeln!(text, "| {kind} | {meaning} | {} |", count(&all, kind)).unwrap();
    }
    let unknown = all.iter().filter(|row| row.kind.1.ends_with(NOT_RECORDED)).count();
    writeln!(
        text,
        "\nIt is {NOT_RECORDED} on what {unknown} of the tuned numbers were measured."
    )
    .unwrap();
    let mut rooms: BTreeMap<String, Vec<Threshold>> = BTreeMap::new();
    for threshold in all {
        let room = threshold.file.split(['/', '.']).next().unwrap().to_owned();
        rooms.entry(room).or_default().push(threshold);
    }
    for (room, list) in rooms {
        write!(
            text,
            "\n## {room}\n\n| name | value | kind | meaning | file |\n|---|---|---|---|---|\n"
        )
        .unwrap();
        for row in list {
            let Threshold {
                name,
                value,
                meaning,
                kind: (kind, remark),
                file,
            } = row;
            let remark = if remark.is_empty() || remark.ends_with(NOT_RECORDED) {
                String::new()
            } else {
                format!("; {remark}")
            };
            writeln!(text, "| `{name}` | `{value}` | {kind}{remark} | {meaning} | `{file}` |").unwrap();
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
fn every_threshold_has_a_kind_and_a_tuned_one_says_on_what_it_was_measured() {
    for Threshold { name, kind, file, .. } in thresholds() {
        let (kind, remark) = (kind.0.as_str(), kind.1.as_str());
        let known = KINDS.iter().any(|(known, _)| *known == kind);
        assert!(
            known,
            "{name} in {file}: end its comment with `Kind: cap.`, or another kind of docs/thresholds.md, not {kind:?}"
        );
        let measured = remark.strip_prefix("measured on: ").is_some_and(|on| !on.is_empty());
        assert!(
            kind != "tuned" || measured,
            "{name} in {file}: a tuned number is `Kind: tuned; measured on: …`, at least `{NOT_RECORDED}`"
        );
    }
}

#[test]
fn a_name_stands_for_one_number() {
    let mut files: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    let mut twice = Vec::new();
    for row in thresholds() {
        let places = files.entry(row.name.clone()).or_default();
        if !places.insert(row.file.clone()) || places.len() > 1 {
            twice.push(format!("{} in {places:?}", row.name));
        }
    }
    assert!(twice.is_empty(), "names that stand for several numbers: {twice:?}");
}

#[test]
fn the_kind_is_the_last_sentence_of_a_comment() {
    let of = |comment| {
        let (meaning, kind, remark) = kind_of(comment);
        [meaning, kind, remark]
    };
    assert_eq!(of("Most steps. Kind: cap."), ["Most steps.", "cap", ""]);
    assert_eq!(
        of("Share. Kind: tuned; measured on: 2.0 to 2.4 on chains."),
        ["Share.", "tuned", "measured on: 2.0 to 2.4 on chains"]
    );
    assert_eq!(
        of("Start. Kind: cap; one or two. It ends."),
        ["Start. It ends.", "cap", "one or two"]
    );
    assert_eq!(of("No kind."), ["No kind.", "", ""]);
}
