//! Documentation in the sources: no sentence begins with What or Of, but with the thing or the action.

use std::fs;
use std::path::Path;

/// Openings of sentences that are not used.
const OPENINGS: [&str; 2] = ["What ", "Of "];

/// The sentences of a text, roughly: what follows a full stop, a question mark or an empty line.
fn begins_wrongly(text: &str) -> Option<&str> {
    let starts = std::iter::once(0)
        .chain(text.match_indices(". ").map(|(at, mark)| at + mark.len()))
        .chain(text.match_indices("? ").map(|(at, mark)| at + mark.len()))
        .chain(text.match_indices("\n\n").map(|(at, mark)| at + mark.len()));
    starts
        .map(|at| &text[at..])
        .find(|rest| OPENINGS.iter().any(|opening| rest.starts_with(opening)))
}

/// Blocks of documentation of a file, a line of each without its marks; a paragraph is one line.
fn documentation(source: &str) -> Vec<String> {
    let mut blocks = vec![String::new()];
    for line in source.lines() {
        let line = line.trim_start();
        match line.strip_prefix("///").or(line.strip_prefix("//!")) {
            Some(text) => {
                let block = blocks.last_mut().unwrap();
                let text = text.trim();
                block.push_str(if text.is_empty() { "\n\n" } else { text });
                if !text.is_empty() {
                    block.push(' ');
                }
            }
            None => blocks.push(String::new()),
        }
    }
    blocks.retain(|block| !block.is_empty());
    blocks
}

fn check(folder: &Path, files: &mut usize) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            check(&path, files);
        } else if path.extension().is_some_and(|end| end == "rs") {
            *files += 1;
            for block in documentation(&fs::read_to_string(&path).unwrap()) {
                if let Some(rest) = begins_wrongly(&block) {
                    panic!(
                        "{}: begin with the thing or the action: {}",
                        path.display(),
                        rest.chars().take(60).collect::<String>()
                    );
                }
            }
        }
    }
}

#[test]
fn sentences_of_the_documentation_begin_with_the_thing() {
    let mut files = 0;
    for folder in ["src", "crates", "tests", "examples"] {
        check(&crate::root().join(folder), &mut files);
    }
    assert!(files > 300, "{files}");
}

#[test]
fn wrong_openings_are_found_wherever_a_sentence_begins() {
    let found = |source: &str| {
        documentation(source)
            .iter()
            .any(|block| begins_wrongly(block).is_some())
    };
    let [what, of] = OPENINGS.map(str::trim);
    assert!(found(&format!("/// {what} a call returns.")));
    assert!(found(&format!("    /// A number. {of}\n    /// the caller.")));
    assert!(found(&format!("//! A title\n//!\n//! {what} follows.")));
    assert!(!found(&format!(
        "// {what} a comment says.\n/// A part {of}\n/// Oftentimes."
    )));
}
