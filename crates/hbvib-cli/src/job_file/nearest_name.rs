//! The nearest known name of an unknown one.

/// The nearest of the names that a message of serde lists.
pub fn hint(message: &str) -> String {
    let mut names = message.split('`').skip(1).step_by(2);
    let Some(unknown) = names.next().filter(|_| message.starts_with("unknown")) else {
        return String::new();
    };
    match names.min_by_key(|name| distance(unknown, name)) {
        Some(nearest) if distance(unknown, nearest) <= unknown.len().max(3) / 2 + 1 => {
            format!("\ndid you mean `{nearest}`?")
        }
        _ => String::new(),
    }
}

/// Edits between two words (Levenshtein).
fn distance(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, x) in a.chars().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, y) in b.iter().enumerate() {
            let replaced = diagonal + usize::from(x != *y);
            diagonal = row[j + 1];
            row[j + 1] = replaced.min(row[j] + 1).min(diagonal + 1);
        }
    }
    row[b.len()]
}

#[cfg(test)]
mod tests {
    use super::{distance, hint};

    #[test]
    fn the_nearest_name_is_found() {
        assert_eq!(distance("kitten", "sitting"), 3);
        assert_eq!(distance("", "abc"), 3);
        assert!(hint("unknown field `stifness`, expected one of `mass`, `stiffness`").contains("`stiffness`"));
        assert!(hint("missing field `model`").is_empty());
    }
}
