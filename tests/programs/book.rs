//! The README and the book in docs/: every program in them is compiled and runs, every page is in the table of
//! contents, every link leads somewhere, every status is explained, every name of the interface exists.

#![cfg(target_os = "linux")]

use crate::common::markdown::{Fence, fences, headings, links, pages, read};
use crate::common::models::oscillator;
use crate::common::omega_range;
use crate::common::programs::{library, printed, python, root, run, soname};
use hbvib::{Hooks, SolverOptions, Status, forced_response};
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

/// Languages of which every block is a complete program.
const PROGRAMS: [&str; 5] = ["c", "cpp", "fortran", "python", "rust"];

/// Languages of blocks that `book_sessions` runs or compares; tests/peers/pyharm.py runs the program of pyHarm, tests/octave.sh
/// those of MATLAB.
const OTHERS: [&str; 8] = ["sh", "cmake", "toml", "output", "pycon", "inp", "pyharm", "matlab"];

/// Longest formula or drawing in lines.
const FORMULA_LINES: usize = 3;

/// Longest line of prose.
const PROSE_WIDTH: usize = 140;

/// Longest README.
const README_LINES: usize = 120;

/// An empty folder with the library under the names that linker and loader look for.
fn workshop(language: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("book").join(language);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    for name in ["libhbvib.so".to_owned(), soname()] {
        std::os::unix::fs::symlink(library(), folder.join(name)).unwrap();
    }
    folder
}

/// Compiles the source file of a program with warnings as errors.
fn compiled(compiler: &str, options: &[&str], sources: &[PathBuf], folder: &Path) -> Command {
    let program = sources.last().unwrap().with_extension("program");
    run(Command::new(compiler)
        .args(["-Wall", "-Wextra", "-pedantic", "-Werror"])
        .args(options)
        .args(sources)
        .arg(format!("-I{}", root().join("include").display()))
        .arg(format!("-L{}", folder.display()))
        .arg(format!("-Wl,-rpath,{}", folder.display()))
        .args(["-lhbvib", "-lm", "-o"])
        .arg(&program)
        .current_dir(folder));
    Command::new(program)
}

/// Compiles a Rust program against the very library under test, without cargo.
fn compiled_rust(source: &Path, folder: &Path) -> Command {
    let own = Path::new(env!("CARGO")).with_file_name("rustc");
    let program = source.with_extension("program");
    let rlib = library().with_extension("rlib");
    let dependencies = rlib.parent().unwrap().join("deps");
    run(Command::new(if own.is_file() { own } else { "rustc".into() })
        .args(["--edition", "2024", "-Dwarnings", "-L"])
        .arg(format!("dependency={}", dependencies.display()))
        .arg("--extern")
        .arg(format!("hbvib={}", rlib.display()))
        .arg(source)
        .arg("-o")
        .arg(&program)
        .current_dir(folder));
    Command::new(program)
}

/// A program ready to run.
fn prepared(fence: &Fence, number: usize, folder: &Path) -> Command {
    let extension = match fence.language.as_str() {
        "fortran" => "f90",
        "python" => "py",
        "rust" => "rs",
        same => same,
    };
    let place = folder.join(format!("{number}"));
    fs::create_dir_all(&place).unwrap();
    let source = place.join(format!("program.{extension}"));
    fs::write(&source, &fence.text).unwrap();
    match fence.language.as_str() {
        "c" => compiled("cc", &["-std=c99"], &[source], folder),
        "cpp" => compiled("c++", &["-std=c++17"], &[source], folder),
        "fortran" => compiled("gfortran", &[], &[root().join("include/hbvib.f90"), source], folder),
        "rust" => compiled_rust(&source, folder),
        _ => {
            let mut command = Command::new(python());
            command
                .arg(source)
                .env("PYTHONPATH", root().join("include"))
                .env("PYTHONDONTWRITEBYTECODE", "1")
                .env("MPLBACKEND", "Agg")
                .env("HBVIB_LIBRARY", library());
            command
        }
    }
}

/// Frequencies, amplitudes and resonance of the mass with a friction contact, the first program of every language.
pub fn first_response() -> &'static [f64] {
    static NUMBERS: OnceLock<Vec<f64>> = OnceLock::new();
    NUMBERS.get_or_init(|| {
        let model = oscillator(1.0, 1.0)
            .rayleigh(0.0, 0.02)
            .slider(0, 1.0, 0.3, 1.0)
            .force(0, 1, 0.2)
            .build();
        let range = omega_range(0.8, 1.6);
        let branch = forced_response(&model, &SolverOptions::default(), &range, &mut Hooks::default()).unwrap();
        let rows = branch.omega().iter().zip(branch.amplitude());
        let mut numbers: Vec<f64> = rows.flat_map(|(&omega, &amplitude)| [omega, amplitude]).collect();
        numbers.push(branch.peaks()[0].omega);
        numbers
    })
}

/// Runs all programs of a language. Those that print a resonance print the first response.
fn all_run(language: &str) {
    let folder = workshop(language);
    let mut first = BTreeSet::new();
    for (number, (page, fence)) in programs_of(language).iter().enumerate() {
        let place = format!("{}:{}", page.display(), fence.line);
        println!("{place}");
        let text = printed(prepared(fence, number, &folder).current_dir(&folder));
        if !text.contains("resonance at") {
            continue;
        }
        first.insert(page.clone());
        let numbers: Vec<f64> = text.split_whitespace().filter_map(|word| word.parse().ok()).collect();
        let expected = first_response();
        assert_eq!(numbers.len(), expected.len(), "{place} printed\n{text}");
        for (a, b) in numbers.iter().zip(expected) {
            assert!((a - b).abs() <= 1e-5 * b.abs(), "{place} printed {a}, not {b}");
        }
    }
    let page = PathBuf::from("docs/first-response.md");
    assert!(
        first.contains(&page),
        "{} lacks the first program in {language}",
        page.display()
    );
}

fn programs_of(language: &str) -> Vec<(PathBuf, Fence)> {
    let mut found = Vec::new();
    for page in pages() {
        for fence in fences(&read(&page)) {
            if fence.language == language {
                found.push((page.clone(), fence));
            }
        }
    }
    found
}

#[test]
fn the_c_programs_run() {
    all_run("c");
}

#[test]
fn the_cpp_programs_run() {
    all_run("cpp");
}

#[test]
fn the_fortran_programs_run() {
    all_run("fortran");
}

#[test]
fn the_python_programs_run() {
    all_run("python");
}

#[test]
fn the_rust_programs_run() {
    all_run("rust");
}

#[test]
fn the_readme_has_a_program_and_is_short() {
    let text = read(Path::new("README.md"));
    let lines = text.lines().count();
    assert!(
        lines <= README_LINES,
        "README.md has {lines} lines, needs at most {README_LINES}"
    );
    assert!(fences(&text).iter().any(|f| PROGRAMS.contains(&f.language.as_str())));
}

/// A block is a program, a command or an output, and a test runs it; or else a formula or a drawing, which has a sign that no
/// program has.
#[test]
fn every_block_is_run_or_a_formula() {
    for page in pages() {
        for fence in fences(&read(&page)) {
            let place = format!("{}:{}", page.display(), fence.line);
            let run = PROGRAMS.iter().chain(&OTHERS).any(|name| *name == fence.language);
            assert!(
                run || fence.language == "text",
                "{place}: a block of '{}', needs one of {PROGRAMS:?} or {OTHERS:?}, which are run, or text",
                fence.language
            );
            let formula = fence.text.lines().count() <= FORMULA_LINES && !fence.text.is_ascii();
            assert!(
                run || formula,
                "{place}: text is for formulas, {OTHERS:?} for what programs read and print"
            );
        }
    }
}

/// Lines of prose end before they are hard to read in an editor; code has a fence, which tests find.
#[test]
fn prose_is_wrapped_and_code_has_a_fence() {
    let mut all = pages();
    all.extend(["CHANGELOG.md", "CONTRIBUTING.md"].map(PathBuf::from));
    for page in all {
        let text = read(&page);
        let (mut fenced, mut before) = (false, "");
        for (i, line) in text.lines().enumerate() {
            fenced ^= line.starts_with("```");
            let (place, length) = (format!("{}:{}", page.display(), i + 1), line.chars().count());
            let long = !fenced && !line.starts_with('|') && length > PROSE_WIDTH;
            assert!(!long, "{place} has {length} characters, needs at most {PROSE_WIDTH}");
            let indented = !fenced && before.trim().is_empty() && line.starts_with("    ");
            assert!(!indented, "{place}: code without a fence, which no test runs");
            before = line;
        }
    }
}

#[test]
fn the_table_of_contents_lists_every_page_once() {
    let summary = Path::new("docs/SUMMARY.md");
    let listed: Vec<PathBuf> = links(&read(summary))
        .into_iter()
        .map(|link| Path::new("docs").join(link.target))
        .collect();
    let unique: BTreeSet<&PathBuf> = listed.iter().collect();
    assert_eq!(unique.len(), listed.len(), "docs/SUMMARY.md lists a page twice");
    let written = pages();
    let written: BTreeSet<&PathBuf> = written
        .iter()
        .filter(|page| page.starts_with("docs") && *page != summary)
        .collect();
    assert_eq!(unique, written, "listed in docs/SUMMARY.md (left), in docs (right)");
}

#[test]
fn every_link_leads_somewhere() {
    for page in pages() {
        for link in links(&read(&page)) {
            if link.target.contains("://") {
                continue;
            }
            let place = format!("{}:{}: {}", page.display(), link.line, link.target);
            let (path, anchor) = link.target.split_once('#').unwrap_or((&link.target, ""));
            let target = if path.is_empty() {
                page.clone()
            } else {
                page.parent().unwrap().join(path)
            };
            assert!(root().join(&target).exists(), "{place} does not exist");
            assert!(
                anchor.is_empty() || headings(&read(&target)).contains(anchor),
                "{place}: no such heading"
            );
        }
    }
}

/// The names in some text that begin as given.
fn names<'a>(text: &'a str, prefix: &str) -> BTreeSet<&'a str> {
    text.split(|c: char| !(c.is_ascii_alphanumeric() || c == '_'))
        .filter(|word| word.starts_with(prefix) && !word.ends_with('_'))
        .collect()
}

#[test]
fn the_page_on_statuses_explains_every_one() {
    let header = read(Path::new("include/hbvib.h"));
    let page = read(Path::new("docs/statuses.md"));
    let mut all: BTreeSet<&str> = names(&header, "HBVIB_E_");
    all.extend(names(&header, "HBVIB_STOPPED_"));
    let known: Vec<_> = Status::ALL
        .iter()
        .map(|status| status.name().to_str().unwrap())
        .collect();
    all.extend(known);
    assert!(all.len() > 20, "{all:?}");
    for name in all {
        assert!(page.contains(&format!("`{name}`")), "docs/statuses.md lacks {name}");
    }
}

#[test]
fn every_name_of_the_interface_exists() {
    let mut interface = String::new();
    for path in [
        "include/hbvib.h",
        "include/hbvib.hpp",
        "include/hbvib.f90",
        "include/hbvib/_c.py",
        "include/hbvib/_library.py",
        "include/hbvib/_types.py",
        "include/hbvib_io.h",
        "include/hbvib/io.py",
        "examples/install/hbvib-config.cmake",
        "matlab/hbvib_mex.c",
        "matlab/hbvib_install.m",
    ] {
        interface += &read(Path::new(path));
    }
    // The header for foreign calls declares the same names; its own is that of its file.
    interface += " hbvib_plain ";
    for page in pages() {
        let text = read(&page);
        for prefix in ["hbvib_", "HBVIB_"] {
            let known = names(&interface, prefix);
            for name in names(&text, prefix) {
                assert!(known.contains(name), "{}: {name} is not in include/", page.display());
            }
        }
    }
}
