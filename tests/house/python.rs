//! The Python package: modules of one idea each, none longer than 400 lines but the generated tables, imported without circles.

use std::collections::BTreeMap;
use std::fs;

/// Modules by hand: name and text.
fn modules() -> BTreeMap<String, String> {
    let mut found = BTreeMap::new();
    for entry in fs::read_dir(crate::root().join("include/hbvib")).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|end| end == "py") {
            let text = fs::read_to_string(&path).unwrap();
            found.insert(path.file_stem().unwrap().to_str().unwrap().to_owned(), text);
        }
    }
    assert!(found.len() > 20, "{:?}", found.keys());
    found
}

#[test]
fn modules_of_python_are_short_and_begin_with_their_idea() {
    for (name, text) in modules() {
        let lines = text.lines().count();
        let generated = text.contains("# BEGIN GENERATED");
        assert!(generated || lines <= 400, "include/hbvib/{name}.py has {lines} lines");
        assert!(
            text.starts_with("\"\"\""),
            "include/hbvib/{name}.py does not say what it holds"
        );
    }
}

/// Modules that a module imports when it is loaded, not inside a function or for type checkers alone.
fn imports(text: &str) -> Vec<&str> {
    text.lines()
        .filter_map(|line| line.strip_prefix("from ._")?.split_once(" import"))
        .map(|(name, _)| name)
        .collect()
}

#[test]
fn modules_of_python_do_not_import_each_other_in_circles() {
    let mut left: BTreeMap<String, Vec<String>> = modules()
        .into_iter()
        .map(|(name, text)| (name, imports(&text).iter().map(|&other| format!("_{other}")).collect()))
        .collect();
    while !left.is_empty() {
        let free: Vec<String> = left
            .iter()
            .filter(|(_, needs)| needs.iter().all(|other| !left.contains_key(other)))
            .map(|(name, _)| name.clone())
            .collect();
        assert!(!free.is_empty(), "a circle among {:?}", left.keys());
        for name in free {
            left.remove(&name);
        }
    }
}
