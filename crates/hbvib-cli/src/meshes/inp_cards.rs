//! Decks of Abaqus and CalculiX as cards: a keyword with its options, and the lines below it. Files that a deck includes are read.

use crate::texts::outcome::Outcome;
use std::fs;
use std::path::Path;

/// Depth up to which files include others.
const DEEPEST: usize = 10;

/// A keyword with its options and its lines.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Card {
    /// Name of the keyword in capital letters, without its star.
    pub keyword: String,
    /// All of its line.
    pub head: String,
    pub lines: Vec<String>,
}

impl Card {
    /// Value of an option, or an empty one for a switch.
    pub fn option(&self, name: &str) -> Option<&str> {
        self.head.split(',').skip(1).find_map(|option| {
            let (key, value) = option.split_once('=').unwrap_or((option, ""));
            key.trim().eq_ignore_ascii_case(name).then(|| value.trim())
        })
    }

    /// The card as text.
    pub fn text(&self) -> String {
        let lines = self.lines.iter().map(|line| format!("{line}\n"));
        core::iter::once(format!("{}\n", self.head)).chain(lines).collect()
    }
}

/// Lines of a deck with those of the files that it includes; comments are left out.
///
/// # Errors
/// A sentence: a file that cannot be read, files that include each other.
pub fn expanded(path: &Path) -> Outcome<String> {
    let mut text = String::new();
    expand(path, 0, &mut text)?;
    Ok(text)
}

fn expand(path: &Path, depth: usize, text: &mut String) -> Outcome<()> {
    let said = |e: &dyn core::fmt::Display| format!("{}: {e}", path.display());
    let own = fs::read_to_string(path).map_err(|e| said(&format!("cannot be read: {e}")))?;
    for line in own.lines() {
        let bare = line.trim();
        if bare.starts_with("**") {
            // The number of a line stays that of the file.
            *text += "\n";
            continue;
        }
        let is_include = bare
            .get(..8)
            .is_some_and(|start| start.eq_ignore_ascii_case("*INCLUDE"));
        if !is_include {
            *text += line;
            *text += "\n";
            continue;
        }
        let named = bare.split_once('=').map(|(_, name)| name.trim().trim_matches('"'));
        let name = named.ok_or_else(|| said(&format!("{bare:?} names no file")))?;
        if depth == DEEPEST {
            return Err(said(&format!("{bare:?}: more than {DEEPEST} files include each other")));
        }
        expand(&path.parent().unwrap_or(Path::new("")).join(name), depth + 1, text)?;
    }
    Ok(())
}

/// The cards of a deck.
///
/// # Errors
/// A sentence: a line before the first keyword.
pub fn cards(text: &str) -> Outcome<Vec<Card>> {
    let mut all: Vec<Card> = Vec::new();
    let mut goes_on = false;
    for line in text.lines() {
        let bare = line.trim();
        if bare.is_empty() {
            continue;
        }
        match all.last_mut() {
            Some(card) if goes_on => {
                card.head += " ";
                card.head += bare;
                goes_on = bare.ends_with(',');
            }
            _ if bare.starts_with('*') => {
                let word = bare.split(',').next().unwrap_or("").trim_start_matches('*').trim();
                all.push(Card {
                    keyword: word.split_whitespace().collect::<Vec<_>>().join(" ").to_uppercase(),
                    head: bare.to_owned(),
                    lines: Vec::new(),
                });
                goes_on = bare.ends_with(',');
            }
            Some(card) => card.lines.push(bare.to_owned()),
            None => return Err(format!("{bare:?} comes before the first keyword")),
        }
    }
    Ok(all)
}

#[cfg(test)]
mod tests {
    use super::{cards, expanded};

    #[test]
    fn a_deck_is_cards_with_the_files_that_it_includes() {
        let folder = std::env::temp_dir().join(format!("hbvib_cards_{}", std::process::id()));
        std::fs::create_dir_all(folder.join("sub")).unwrap();
        let write = |name: &str, text: &str| std::fs::write(folder.join(name), text).unwrap();
        write("a.inp", "** a comment\n*include, INPUT=sub/b.inp\n*End  Step\n");
        write(
            "sub/b.inp",
            "*Node, NSET=all\n1, 0, 0, 0\n\n*TIE, NAME=w,\n CYCLIC SYMMETRY\nLF, RF\n",
        );
        let all = cards(&expanded(&folder.join("a.inp")).unwrap()).unwrap();
        let words: Vec<(&str, usize)> = all
            .iter()
            .map(|card| (card.keyword.as_str(), card.lines.len()))
            .collect();
        assert_eq!(words, [("NODE", 1), ("TIE", 1), ("END STEP", 0)]);
        assert_eq!(
            (
                all[0].option("nset"),
                all[1].option("cyclic symmetry"),
                all[1].option("n")
            ),
            (Some("all"), Some(""), None)
        );
        assert_eq!(all[1].text(), "*TIE, NAME=w, CYCLIC SYMMETRY\nLF, RF\n");
        write("a.inp", "*INCLUDE, INPUT=a.inp\n");
        assert!(
            expanded(&folder.join("a.inp"))
                .unwrap_err()
                .contains("include each other")
        );
        write("a.inp", "*INCLUDE\n");
        assert!(expanded(&folder.join("a.inp")).unwrap_err().contains("names no file"));
        write("a.inp", "*INCLUDE, INPUT=none.inp\n");
        assert!(
            expanded(&folder.join("a.inp"))
                .unwrap_err()
                .contains("none.inp: cannot be read")
        );
        assert!(cards("1, 2\n").unwrap_err().contains("before the first keyword"));
        std::fs::remove_dir_all(&folder).unwrap();
    }
}
