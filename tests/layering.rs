//! The way of the data has one direction: a file imports from lower layers or from its own module
//! only.

use std::fs;
use std::path::{Path, PathBuf};

/// Layer of each module of the crate. Within a layer modules do not know each other unless listed
/// in [`SAME_LAYER`].
const LAYERS: [(&str, u8); 18] = [
    ("error", 0),
    ("options", 0),
    ("hooks", 0),
    ("linalg", 1),
    ("harmonics", 1),
    ("fourier", 1),
    ("model", 2),
    ("contact", 2),
    ("aft", 3),
    ("condense", 3),
    ("problem", 4),
    ("continuation", 5),
    ("postprocess", 6),
    ("branch", 6),
    ("error_estimate", 6),
    ("time_response", 6),
    ("analysis", 7),
    ("capi", 8),
];

/// Imports inside one layer, (who, whom): options check their numbers with the error type, a
/// series is packed as its harmonics say, a model has contacts, a branch tells what follows from a
/// point.
const SAME_LAYER: [(&str, &str); 5] = [
    ("options", "error"),
    ("hooks", "error"),
    ("fourier", "harmonics"),
    ("model", "contact"),
    ("branch", "postprocess"),
];

/// Modules that may import nothing but these, whatever their layer: the continuation never sees a
/// model or a contact, and the C boundary holds no numerics.
const ONLY: [(&str, &[&str]); 2] = [
    ("continuation", &["problem", "linalg", "error", "hooks"]),
    (
        "capi",
        &[
            "analysis", "model", "branch", "contact", "options", "hooks", "error", "linalg",
        ],
    ),
];

fn layer(module: &str) -> Option<u8> {
    LAYERS.iter().find(|(name, _)| *name == module).map(|(_, layer)| *layer)
}

fn allowed(from: &str, to: &str) -> bool {
    if from == to {
        return true;
    }
    if let Some((_, list)) = ONLY.iter().find(|(name, _)| *name == from) {
        return list.contains(&to);
    }
    let (Some(a), Some(b)) = (layer(from), layer(to)) else {
        return false;
    };
    b < a || SAME_LAYER.contains(&(from, to))
}

fn sources(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            sources(&path, found);
        } else if path.extension().is_some_and(|e| e == "rs") {
            found.push(path);
        }
    }
}

/// The code of a file: no comments, and nothing from its unit tests on, which close every file.
fn code(text: &str) -> String {
    text.lines()
        .take_while(|line| line.trim() != "#[cfg(test)]")
        .map(|line| line.split("//").next().unwrap_or(""))
        .collect::<Vec<_>>()
        .join("\n")
}

fn word(text: &str) -> &str {
    let end = text
        .find(|c: char| !(c.is_alphanumeric() || c == '_'))
        .unwrap_or(text.len());
    &text[..end]
}

/// Modules of the crate that a piece of code names after `prefix`, a brace list included.
fn named_after(code: &str, prefix: &str) -> Vec<String> {
    let mut found = Vec::new();
    for (at, _) in code.match_indices(prefix) {
        // `$crate::` and `::std` style paths are no matter; `mycrate::` is another name.
        if code[..at].ends_with(|c: char| c.is_alphanumeric() || c == '_') {
            continue;
        }
        let rest = &code[at + prefix.len()..];
        if let Some(list) = rest.strip_prefix('{') {
            let mut depth = 0;
            let mut start = 0;
            for (i, c) in list.char_indices() {
                match c {
                    '{' => depth += 1,
                    '}' | ',' if depth == 0 => {
                        found.push(word(list[start..i].trim()).to_owned());
                        start = i + 1;
                        if c == '}' {
                            break;
                        }
                    }
                    '}' => depth -= 1,
                    _ => {}
                }
            }
        } else {
            found.push(word(rest).to_owned());
        }
    }
    found.retain(|name| !name.is_empty());
    found
}

/// The module of a file, and the modules of the crate that it imports.
fn imports(root: &Path, path: &Path, text: &str) -> (String, Vec<String>) {
    let inside = path.strip_prefix(root).unwrap();
    let parts: Vec<&str> = inside.iter().map(|p| p.to_str().unwrap()).collect();
    let module = parts[0].trim_end_matches(".rs").to_owned();
    let code = code(text);
    let mut found = named_after(&code, "crate::");
    // Enough `super::` to leave a module reach the root of the crate.
    let depth = if parts.len() == 1 || parts[parts.len() - 1] == "mod.rs" {
        parts.len().saturating_sub(1).max(1)
    } else {
        parts.len()
    };
    found.extend(named_after(&code, &"super::".repeat(depth)));
    (module, found)
}

#[test]
fn every_file_imports_from_lower_layers_or_its_own_module_only() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut files = Vec::new();
    sources(&root, &mut files);
    assert!(files.len() > 20);
    let mut wrong = Vec::new();
    let mut arrows = 0;
    for path in files {
        let text = fs::read_to_string(&path).unwrap();
        let (module, found) = imports(&root, &path, &text);
        if module == "lib" {
            continue;
        }
        assert!(
            layer(&module).is_some(),
            "{}: name the layer of {module}",
            path.display()
        );
        for target in found {
            // Macros of the error module are exported at the root.
            let target = if target == "fail" { "error".to_owned() } else { target };
            arrows += 1;
            if !allowed(&module, &target) {
                wrong.push(format!("{}: {module} imports {target}", path.display()));
            }
        }
    }
    assert!(arrows > 50, "only {arrows} imports were seen");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn unsafe_code_lives_at_the_c_boundary_only() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut files = Vec::new();
    sources(&root, &mut files);
    for path in files {
        let inside = path.strip_prefix(&root).unwrap();
        if inside.starts_with("capi") {
            continue;
        }
        let code = code(&fs::read_to_string(&path).unwrap());
        let uses = code.split(|c: char| !(c.is_alphanumeric() || c == '_'));
        assert!(!uses.into_iter().any(|w| w == "unsafe"), "{}", path.display());
    }
}

#[test]
fn imports_are_found_in_every_form_that_the_language_has() {
    let root = Path::new("/src");
    let of = |path: &str, text: &str| imports(root, &root.join(path), text).1;
    assert_eq!(of("aft/exact.rs", "use crate::contact::{Law, Piece};"), ["contact"]);
    assert_eq!(of("aft/exact.rs", "let x = crate::model::Model::new(1);"), ["model"]);
    assert_eq!(
        of(
            "aft/mod.rs",
            "use crate::{error::{fail, Result}, harmonics, linalg::norm};"
        ),
        ["error", "harmonics", "linalg"]
    );
    assert_eq!(of("aft/exact.rs", "use super::super::model::Model;"), ["model"]);
    assert_eq!(of("aft/mod.rs", "use super::model::Model;"), ["model"]);
    assert_eq!(of("aft/exact.rs", "use super::Assembly;"), Vec::<String>::new());
    assert_eq!(
        of("aft/mod.rs", "// crate::model\n#[cfg(test)]\nuse crate::model;"),
        Vec::<String>::new()
    );
}

#[test]
fn an_arrow_against_the_way_is_refused() {
    assert!(allowed("analysis", "continuation"));
    assert!(allowed("model", "contact"));
    assert!(!allowed("contact", "model"));
    assert!(!allowed("continuation", "model"));
    assert!(!allowed("continuation", "contact"));
    assert!(!allowed("linalg", "problem"));
    assert!(!allowed("capi", "continuation"));
    assert!(!allowed("branch", "unheard_of"));
}
