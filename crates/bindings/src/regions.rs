//! Generated parts of files that are otherwise written by hand.

use crate::declarations::Result;

const BEGIN: &str = "BEGIN GENERATED";
const END: &str = "END GENERATED";

/// A file split at its markers.
#[derive(Debug)]
pub struct Regions<'a> {
    /// The text written by hand, markers included: one more than there are generated parts.
    by_hand: Vec<&'a str>,
}

impl<'a> Regions<'a> {
    pub fn of(text: &'a str) -> Result<Self> {
        let mut by_hand = Vec::new();
        let mut start = 0;
        let mut at = 0;
        let mut inside = false;
        for line in text.split_inclusive('\n') {
            match (line.contains(BEGIN), line.contains(END)) {
                (true, false) if !inside => {
                    by_hand.push(&text[start..at + line.len()]);
                    inside = true;
                }
                (false, true) if inside => {
                    start = at;
                    inside = false;
                }
                (false, false) => {}
                _ => return Err(format!("a marker out of place: {}", line.trim())),
            }
            at += line.len();
        }
        if inside {
            return Err(format!("no {END} at the end"));
        }
        by_hand.push(&text[start..]);
        Ok(Self { by_hand })
    }

    /// The file with these generated parts, in their order.
    pub fn filled(&self, parts: &[String]) -> Result<String> {
        let (known, given) = (self.by_hand.len() - 1, parts.len());
        if known != given {
            return Err(format!("has {known} generated parts, needs {given}"));
        }
        let mut text = String::new();
        for (i, by_hand) in self.by_hand.iter().enumerate() {
            text += by_hand;
            if let Some(part) = parts.get(i) {
                text += part;
            }
        }
        Ok(text)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "a\n! BEGIN GENERATED x\nold\n! END GENERATED\nb\n# BEGIN GENERATED\n# END GENERATED\nc\n";

    #[test]
    fn only_what_lies_between_markers_changes() {
        let parts = ["new\n".to_owned(), "more\n".to_owned()];
        let new = Regions::of(TEXT).unwrap().filled(&parts).unwrap();
        assert_eq!(
            new,
            "a\n! BEGIN GENERATED x\nnew\n! END GENERATED\nb\n# BEGIN GENERATED\nmore\n# END GENERATED\nc\n"
        );
        assert_eq!(Regions::of(&new).unwrap().filled(&parts).unwrap(), new);
    }

    #[test]
    fn markers_out_of_place_and_other_numbers_of_parts_are_errors() {
        assert!(Regions::of("! END GENERATED\n").is_err());
        assert!(Regions::of("! BEGIN GENERATED\n! BEGIN GENERATED\n").is_err());
        assert!(Regions::of("! BEGIN GENERATED\n").is_err());
        assert!(Regions::of(TEXT).unwrap().filled(&[String::new()]).is_err());
    }
}
