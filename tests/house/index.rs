//! The index of the tests, tests/README.md, is made from the first sentences of their files and is current, and every
//! file of a crate is part of it.

use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};

const INTRODUCTION: &str = "\
# Tests

`sh tests/run.sh` runs them and the unit tests inside the libraries, installs what they need, and lists at the end how long each step took;
`sh tests/deep.sh` runs those that take minutes, and all cases of those that take some (`HBVIB_THOROUGH`, [common/depth.rs](common/depth.rs)).
The files are grouped into a few crates, so that the library is linked a few times only: `cargo test --release --test contact_laws` runs one
crate, and `cargo test --release --test contact_laws friction` what has this word in its name.

A new test is a file in the folder of its crate, named by its claim and declared in the `main.rs` there. This index is made from
the first sentence of each file: `HBVIB_WRITE_INDEX=1 cargo test --release --test house` writes it, and without the variable that test fails
where it is out of date.

The tests are a package of their own, which is compiled with little optimisation, the library with all of it. Unit tests see what is
private, so they are compiled with the sources of the library; the packages in [units](units) do that without optimisation:
`cargo test --release -p hbvib-unit-tests`, and `-p hbvib-numerics-unit-tests` for the numerics.

Models come from [common/models.rs](common/models.rs): an oscillator, chains, plates, a rotor, sectors and structures of any matrices, each
built in one expression; options come from [common/options.rs](common/options.rs). A private builder is for what these cannot say.

Beside the crates: [common](common) holds what they share, [data](data) reference values, [c_abi](c_abi) and
[languages](languages) the programs in C, C++, Fortran and Python that `programs` builds and runs, and
[stored_results](stored_results) a program that prints results to the last bit, to compare two builds. [ledger](ledger) changes each
tuned number by a half and by two, and compares answers and cost.

Times fail no test. `cargo bench` has them as multiples of a factorisation, and ends with 1 where a row is more than 1.3 times as slow
as its stored ratio in `benches/work`.
";

/// Files in Rust of a folder, sorted.
fn sources(folder: &Path) -> Vec<PathBuf> {
    let mut found: Vec<PathBuf> = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|e| e == "rs"))
        .collect();
    found.sort();
    found
}

fn name(path: &Path) -> &str {
    path.file_stem().and_then(|stem| stem.to_str()).unwrap()
}

/// The folders that are crates, sorted.
fn crates() -> Vec<PathBuf> {
    let mut found: Vec<PathBuf> = fs::read_dir(tests())
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.join("main.rs").is_file())
        .collect();
    found.sort();
    found
}

fn tests() -> PathBuf {
    crate::root().join("tests")
}

/// The first sentence of the documentation of a file.
fn first_sentence(path: &Path) -> String {
    let text = fs::read_to_string(path).unwrap();
    let lines = text.lines().map_while(|line| line.strip_prefix("//!"));
    let words: Vec<&str> = lines
        .take_while(|line| !line.trim().is_empty())
        .flat_map(str::split_whitespace)
        .collect();
    let paragraph = words.join(" ");
    assert!(!paragraph.is_empty(), "{} does not say what it tests", path.display());
    match paragraph.find(". ") {
        Some(end) => paragraph[..=end].to_owned(),
        None => paragraph,
    }
}

fn index() -> String {
    let mut text = INTRODUCTION.to_owned();
    let manifest = fs::read_to_string(tests().join("Cargo.toml")).unwrap();
    for folder in crates() {
        let line = format!("path = \"{}/main.rs\"", name(&folder));
        assert!(
            manifest.contains(&line),
            "tests/Cargo.toml lacks {line}: its tests would not run"
        );
        let main = folder.join("main.rs");
        let title = name(&folder);
        write!(text, "\n## {title}\n\n{}\n\n", first_sentence(&main)).unwrap();
        for path in sources(&folder).iter().filter(|path| **path != main) {
            let file = name(path);
            writeln!(text, "- [{file}]({title}/{file}.rs): {}", first_sentence(path)).unwrap();
        }
    }
    text.push_str("\n## Crates of one file\n\n");
    for path in sources(&tests()) {
        let file = name(&path);
        writeln!(text, "- [{file}]({file}.rs): {}", first_sentence(&path)).unwrap();
    }
    text
}

#[test]
fn the_index_is_current() {
    let (path, text) = (tests().join("README.md"), index());
    if std::env::var_os("HBVIB_WRITE_INDEX").is_some() {
        fs::write(&path, &text).unwrap();
    }
    assert!(
        fs::read_to_string(&path).is_ok_and(|old| old == text),
        "tests/README.md is out of date: HBVIB_WRITE_INDEX=1 cargo test --release --test house writes it"
    );
}

#[test]
fn every_file_of_a_crate_is_part_of_it() {
    for folder in crates() {
        let main = folder.join("main.rs");
        let declared = fs::read_to_string(&main).unwrap();
        for path in sources(&folder).iter().filter(|path| **path != main) {
            let line = format!("mod {};", name(path));
            assert!(
                declared.lines().any(|l| l == line),
                "{} lacks \"{line}\": its tests would not run",
                main.display()
            );
        }
    }
}
