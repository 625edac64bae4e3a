//! Crates of the command have permissive licences, those of its tests included, and the arguments brought no more than they need.

use std::collections::BTreeSet;
use std::process::Command;

/// Licences that ask for no more than their text. An expression with OR needs one of them, with AND all.
const PERMISSIVE: [&str; 8] = [
    "MIT",
    "Apache-2.0",
    "0BSD",
    "BSD-2-Clause",
    "BSD-3-Clause",
    "Unicode-3.0",
    "Unlicense",
    "Zlib",
];

/// Name and licence of each crate. All that a build needs is there since this test was built.
fn crates(edges: &str) -> BTreeSet<(String, String)> {
    let output = Command::new(env!("CARGO"))
        .args([
            "tree",
            "-p",
            "hbvib-cli",
            "--offline",
            "--no-dedupe",
            "--prefix",
            "none",
        ])
        .args(["-e", edges, "-f", "{p}|{l}"])
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8(output.stdout).unwrap();
    let pairs = text.lines().map(|line| line.split_once('|').unwrap());
    pairs
        .map(|(package, licence)| (package.split(' ').next().unwrap().to_owned(), licence.to_owned()))
        .collect()
}

fn is_permissive(licence: &str) -> bool {
    licence.replace('/', " OR ").split(" AND ").all(|part| {
        let part = part.trim_matches(['(', ')']);
        part.split(" OR ").any(|name| PERMISSIVE.contains(&name.trim()))
    })
}

#[test]
fn all_crates_of_the_command_are_permissive() {
    let all = crates("normal,build,dev");
    assert!(all.len() > 60, "{}", all.len());
    for (package, licence) in &all {
        assert!(is_permissive(licence), "{package} has the licence {licence:?}");
    }
    assert!(!is_permissive("MPL-2.0") && !is_permissive("MIT AND LGPL-2.1"));
    let names: BTreeSet<String> = crates("normal").into_iter().map(|(name, _)| name).collect();
    for (name, expected) in [
        ("clap", true),
        ("clap_complete", true),
        ("clap_mangen", true),
        ("anstream", false),
        ("terminal_size", false),
    ] {
        assert_eq!(names.contains(name), expected, "{name}");
    }
}
