//! Crates that the library is built from are those that docs/dependencies.md lists, and all licences are permissive.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::process::Command;

/// Crates beside the library itself, versions of the same one counted apart.
const PACKAGES: usize = 52;

/// Licences that ask for no more than their text. An expression with OR needs one of them, with AND all.
const PERMISSIVE: [&str; 9] = [
    "MIT",
    "Apache-2.0",
    "Apache-2.0 WITH LLVM-exception",
    "0BSD",
    "BSD-2-Clause",
    "BSD-3-Clause",
    "Unicode-3.0",
    "Unlicense",
    "Zlib",
];

/// Lines of `cargo tree` in a format, each once. All that a build needs is there since this test was built.
fn tree(format: &str, edges: &str) -> BTreeSet<String> {
    let output = Command::new(env!("CARGO"))
        .args(["tree", "-p", "hbvib", "--offline", "--no-dedupe", "--prefix", "none"])
        .args(["-e", edges, "-f", format])
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8(output.stdout).unwrap();
    text.lines().map(str::to_owned).collect()
}

fn is_permissive(licence: &str) -> bool {
    let licence = licence.replace('/', " OR ");
    licence.split(" AND ").all(|part| {
        let part = part.trim_matches(['(', ')']);
        part.split(" OR ").any(|name| PERMISSIVE.contains(&name.trim()))
    })
}

/// Names in backquotes of the first column of the table.
fn listed() -> BTreeSet<String> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/dependencies.md");
    let text = fs::read_to_string(path).unwrap();
    let columns = text
        .lines()
        .filter_map(|line| line.strip_prefix("| `")?.split('|').next());
    columns
        .flat_map(|column| column.split(['`', ' ']))
        .filter(|name| !name.is_empty())
        .map(str::to_owned)
        .collect()
}

#[test]
fn the_documentation_lists_all_crates_of_the_library() {
    let packages = tree("{p}", "normal");
    let mut names: BTreeSet<String> = packages
        .iter()
        .filter_map(|package| package.split(' ').next().map(str::to_owned))
        .collect();
    names.remove("hbvib");
    assert_eq!(names, listed(), "docs/dependencies.md (right) and cargo tree (left)");
    assert_eq!(
        packages.len() - 1,
        PACKAGES,
        "the number of packages changed: {packages:?}"
    );
}

#[test]
fn all_licences_are_permissive() {
    for line in tree("{p}|{l}", "normal,build,dev") {
        let (package, licence) = line.split_once('|').unwrap();
        assert!(is_permissive(licence), "{package} has the licence {licence:?}");
    }
    assert!(!is_permissive("GPL-3.0-only") && !is_permissive("MIT AND LGPL-2.1") && !is_permissive(""));
}
