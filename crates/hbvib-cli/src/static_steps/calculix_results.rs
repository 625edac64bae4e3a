//! Results that CalculiX prints: vectors of nodes in `.dat`, fields of nodes in `.frd`.

use crate::texts::outcome::Outcome;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// Columns of a node and of a value in `.frd`.
const NODE: core::ops::Range<usize> = 3..13;
const VALUE: usize = 12;

/// Displacements of a set of nodes at the last time that a `.dat` file has.
///
/// # Errors
/// A sentence: no such table, a line that is not understood.
pub fn displacements(path: &Path, set: &str) -> Outcome<BTreeMap<i64, [f64; 3]>> {
    let said = |e: String| format!("{}: {e}", path.display());
    let text = fs::read_to_string(path).map_err(|e| said(format!("cannot be read: {e}")))?;
    let mut found = BTreeMap::new();
    let mut inside = false;
    for (k, line) in text.lines().enumerate() {
        let words: Vec<&str> = line.split_whitespace().collect();
        if line.trim_start().starts_with("displacements (") {
            let of = words
                .iter()
                .position(|word| *word == "set")
                .and_then(|at| words.get(at + 1));
            inside = of.is_some_and(|of| of.eq_ignore_ascii_case(set));
            if inside {
                found.clear();
            }
        } else if inside && !words.is_empty() {
            let numbers: Option<Vec<f64>> = words[1..].iter().map(|word| number(word)).collect();
            match (words[0].parse::<i64>(), numbers.as_deref()) {
                (Ok(node), Some(&[x, y, z])) => {
                    found.insert(node, [x, y, z]);
                }
                // Another table begins.
                _ if words[0].parse::<i64>().is_err() => inside = false,
                _ => return Err(said(format!("line {}: needs a node and three displacements", k + 1))),
            }
        }
    }
    if found.is_empty() {
        return Err(said(format!("has no displacements of the set {set}")));
    }
    Ok(found)
}

/// A field of nodes: names of its components, and their values at each node.
#[derive(Debug, Default, PartialEq)]
pub struct Field {
    pub components: Vec<String>,
    pub values: BTreeMap<i64, Vec<f64>>,
}

/// The last field of a name in a `.frd` file with text.
///
/// # Errors
/// A sentence: no such field, a binary file, a line that is not understood.
pub fn field(path: &Path, name: &str) -> Outcome<Field> {
    let said = |e: String| format!("{}: {e}", path.display());
    let bytes = fs::read(path).map_err(|e| said(format!("cannot be read: {e}")))?;
    let Ok(text) = String::from_utf8(bytes) else {
        return Err(said(
            "is binary; CalculiX writes text with *NODE FILE and *CONTACT FILE".into(),
        ));
    };
    let mut found: Option<Field> = None;
    let mut open: Option<Field> = None;
    let mut last = None;
    let mut names = Vec::new();
    for (k, line) in text.lines().enumerate() {
        let unclear = || said(format!("line {}: {:?} is no value of a field", k + 1, line.trim_end()));
        let word = line.split_whitespace().nth(1).unwrap_or("");
        match line.split_whitespace().next().unwrap_or("") {
            "-4" => {
                names.push(word.to_owned());
                last = None;
                open = (word.eq_ignore_ascii_case(name)).then(Field::default);
            }
            "-5" => {
                // Components that are computed from others have a fifth number.
                let derived = line.split_whitespace().nth(6).is_some_and(|of| of != "0");
                if let Some(open) = open.as_mut().filter(|_| !derived) {
                    open.components.push(word.to_uppercase());
                }
            }
            "-3" => {
                if let Some(field) = open.take() {
                    found = Some(field);
                }
            }
            start if open.is_some() && (start.starts_with("-1") || start.starts_with("-2")) => {
                let field = open.as_mut().ok_or_else(unclear)?;
                if start.starts_with("-1") {
                    let node = line.get(NODE).and_then(|node| node.trim().parse::<i64>().ok());
                    last = Some(node.ok_or_else(unclear)?);
                }
                let of = field.values.entry(last.ok_or_else(unclear)?).or_default();
                let mut rest = line.get(NODE.end..).ok_or_else(unclear)?;
                while !rest.trim().is_empty() {
                    let cut = VALUE.min(rest.len());
                    let value = rest.get(..cut).and_then(|value| number(value.trim()));
                    of.push(value.ok_or_else(unclear)?);
                    rest = rest.get(cut..).unwrap_or("");
                }
            }
            _ => {}
        }
    }
    names.dedup();
    found.ok_or_else(|| {
        said(format!(
            "has no field {name}, but {}",
            if names.is_empty() {
                "none".into()
            } else {
                names.join(", ")
            }
        ))
    })
}

/// First value of each node in the last contact table of a `.dat` file whose title begins with these words.
///
/// # Errors
/// A sentence: no such table, a table of points of faces, a line that is not understood.
pub fn contact_table(path: &Path, title: &str) -> Outcome<BTreeMap<i64, f64>> {
    let said = |e: String| format!("{}: {e}", path.display());
    let text = fs::read_to_string(path).map_err(|e| said(format!("cannot be read: {e}")))?;
    let mut found = None;
    let mut inside = false;
    for (k, line) in text.lines().enumerate() {
        let bare = line.trim();
        if bare.is_empty() {
            continue;
        }
        if bare.starts_with(|c: char| c.is_ascii_alphabetic()) {
            inside = bare.starts_with(title);
            if inside {
                if !bare.contains("slave node") {
                    return Err(said(format!(
                        "line {}: the table has points of faces; *CONTACT FILE with CDIS, CSTR writes nodes to .frd",
                        k + 1
                    )));
                }
                found = Some(BTreeMap::new());
            }
        } else if let Some(found) = found.as_mut().filter(|_| inside) {
            let mut words = bare.split_whitespace();
            let node = words.next().and_then(|word| word.parse::<i64>().ok());
            let pair = node.zip(words.next().and_then(number));
            let (node, value) = pair.ok_or_else(|| said(format!("line {}: needs a node and its values", k + 1)))?;
            found.insert(node, value);
        }
    }
    found.ok_or_else(|| said(format!("has no table \"{title}\" (*CONTACT PRINT with CDIS, CSTR)")))
}

/// A finite number.
fn number(word: &str) -> Option<f64> {
    word.parse().ok().filter(|value: &f64| value.is_finite())
}
