//! Crates that the library is built from are those that docs/dependencies.md lists, and all licences are permissive.

use std::collections::BTreeSet;
use std::fs;
use std::process::Command;

/// Crates beside the library itself, versions of the same one counted apart.
const PACKAGES: usize = 52;

/// Licences that deny.toml allows: they ask for no more than their text. An expression with OR needs one of them, with AND all.
fn permissive() -> Vec<String> {
    let path = crate::root().join("deny.toml");
    let text = fs::read_to_string(path).unwrap();
    let list = text.split("\nallow = [").nth(1).and_then(|rest| rest.split(']').next());
    let names = list
        .expect("deny.toml has a list of licences")
        .split('"')
        .skip(1)
        .step_by(2);
    names.map(str::to_owned).collect()
}

/// Lines of `cargo tree` in a format, each once. All that a build needs is there since this test was built.
fn tree(format: &str, edges: &str) -> BTreeSet<String> {
    let output = Command::new(env!("CARGO"))
        .args(["tree", "-p", "hbvib", "--offline", "--no-dedupe", "--prefix", "none"])
        .args(["-e", edges, "-f", format])
        .current_dir(crate::root())
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8(output.stdout).unwrap();
    text.lines().map(str::to_owned).collect()
}

fn is_permissive(licence: &str, allowed: &[String]) -> bool {
    let licence = licence.replace('/', " OR ");
    licence.split(" AND ").all(|part| {
        let part = part.trim_matches(['(', ')']);
        part.split(" OR ")
            .any(|name| allowed.iter().any(|one| one == name.trim()))
    })
}

/// Names in backquotes of the first column of the table.
fn listed() -> BTreeSet<String> {
    let path = crate::root().join("docs/dependencies.md");
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
    for own in ["hbvib", "hbvib-numerics", "hbvib-dissection"] {
        names.remove(own);
    }
    assert_eq!(names, listed(), "docs/dependencies.md (right) and cargo tree (left)");
    assert_eq!(
        packages.len() - 3,
        PACKAGES,
        "the number of packages changed: {packages:?}"
    );
}

#[test]
fn all_licences_are_permissive() {
    let allowed = permissive();
    assert!(allowed.iter().all(|name| !name.contains("GPL")), "{allowed:?}");
    for line in tree("{p}|{l}", "normal,build,dev") {
        let (package, licence) = line.split_once('|').unwrap();
        assert!(
            is_permissive(licence, &allowed),
            "{package} has the licence {licence:?}"
        );
    }
    let refused = ["GPL-3.0-only", "MIT AND LGPL-2.1", ""];
    assert!(refused.iter().all(|name| !is_permissive(name, &allowed)));
}
