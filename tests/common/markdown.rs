//! The README and the pages of the book in the form that tests read: blocks of code, links, headings.

use crate::common::programs::root;
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// A block of code.
pub struct Fence {
    /// The word after its fence.
    pub language: String,
    /// Line of its fence, from 1.
    pub line: usize,
    pub text: String,
}

/// A link to a file or address.
pub struct Link {
    pub target: String,
    /// Line, from 1.
    pub line: usize,
}

/// README.md and all pages in docs, by their paths from the checkout, sorted.
pub fn pages() -> Vec<PathBuf> {
    let mut found = vec![PathBuf::from("README.md")];
    gather(Path::new("docs"), &mut found);
    found.sort();
    found
}

fn gather(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(root().join(folder)).unwrap() {
        let path = folder.join(entry.unwrap().file_name());
        if root().join(&path).is_dir() {
            gather(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "md") {
            found.push(path);
        }
    }
}

/// The text of a file of the checkout.
pub fn read(path: &Path) -> String {
    fs::read_to_string(root().join(path)).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// The blocks of code of a page.
pub fn fences(text: &str) -> Vec<Fence> {
    let mut found: Vec<Fence> = Vec::new();
    let mut inside = false;
    for (i, line) in text.lines().enumerate() {
        if let Some(language) = line.strip_prefix("```") {
            if !inside {
                found.push(Fence {
                    language: language.trim().to_owned(),
                    line: i + 1,
                    text: String::new(),
                });
            }
            inside = !inside;
        } else if inside {
            let fence = found.last_mut().unwrap();
            fence.text.push_str(line);
            fence.text.push('\n');
        }
    }
    assert!(!inside, "the last block of code has no end");
    found
}

/// The lines outside blocks of code with their numbers, without code within a line.
fn prose(text: &str) -> Vec<(usize, String)> {
    let mut inside = false;
    let mut found = Vec::new();
    for (i, line) in text.lines().enumerate() {
        if line.starts_with("```") {
            inside = !inside;
        } else if !inside {
            // Odd parts are between backticks.
            let parts = line.split('`').enumerate();
            let words: Vec<&str> = parts.map(|(k, part)| if k % 2 == 0 { part } else { "" }).collect();
            found.push((i + 1, words.join("`")));
        }
    }
    found
}

/// The links of a page, images included.
pub fn links(text: &str) -> Vec<Link> {
    let mut found = Vec::new();
    for (line, words) in prose(text) {
        for part in words.split("](").skip(1) {
            found.push(Link {
                target: part.split(')').next().unwrap().to_owned(),
                line,
            });
        }
    }
    found
}

/// The anchors of a page's headings: letters, digits, hyphens and underscores in lower case, spaces as hyphens.
pub fn headings(text: &str) -> BTreeSet<String> {
    let mut inside = false;
    let mut found = BTreeSet::new();
    for line in text.lines() {
        inside ^= line.starts_with("```");
        let title = line.trim_start_matches('#');
        if !inside && title.len() < line.len() && title.starts_with(' ') {
            let kept = title.trim().chars().filter_map(|c| match c {
                ' ' => Some('-'),
                '-' | '_' => Some(c),
                c if c.is_alphanumeric() => Some(c.to_ascii_lowercase()),
                _ => None,
            });
            found.insert(kept.collect());
        }
    }
    found
}
