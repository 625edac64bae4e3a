//! The C interface, from C: compiles the programs in tests/c_abi and examples/c against the header
//! and the shared library, and runs them. The C programs print nothing unless a check fails, so
//! that a single byte on their standard output or error would be the library's.

#![cfg(target_os = "linux")]

mod common;

use common::{data, number};
use hbvib::analysis::forced_response;
use hbvib::contact::Contact;
use hbvib::hooks::Hooks;
use hbvib::linalg::matrix_view::{MatrixView, Part};
use hbvib::model::Model;
use hbvib::model::structure::MatrixKind;
use hbvib::options::{ForcedOptions, SolverOptions};
use num_complex::Complex64;
use serde_json::Value;
use std::collections::BTreeSet;
use std::f64::consts::PI;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::{env, fs};

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// The shared library that cargo has built for this very test.
fn library() -> PathBuf {
    let folder = env::current_exe().unwrap();
    let folder = folder.parent().unwrap();
    let name = "libhbvib.so";
    let found = [folder.join(name), folder.parent().unwrap().join(name)]
        .into_iter()
        .find(|path| path.is_file());
    found.unwrap_or_else(|| panic!("{name} is neither in {} nor above it", folder.display()))
}

fn soname() -> String {
    format!(
        "libhbvib.so.{}.{}",
        env!("CARGO_PKG_VERSION_MAJOR"),
        env!("CARGO_PKG_VERSION_MINOR")
    )
}

/// A folder of the test's own with the library under the names that linker and loader look for.
fn workshop(test: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("c_abi").join(test);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    for name in ["libhbvib.so".to_owned(), soname()] {
        std::os::unix::fs::symlink(library(), folder.join(name)).unwrap();
    }
    folder
}

fn run(command: &mut Command) -> Output {
    // Cargo's search path has the library of the last `cargo build`, which may be an older one.
    let output = command.env_remove("LD_LIBRARY_PATH").output().unwrap_or_else(|error| {
        panic!("{command:?} could not be started: {error}. The C interface is NOT tested without it; install gcc and binutils")
    });
    let text = String::from_utf8_lossy(&output.stderr);
    assert!(
        output.status.success(),
        "{command:?} failed, {}:\n{text}",
        output.status
    );
    output
}

/// Compiles a C file with warnings denied, and links it with the library and the libraries of
/// libc.
fn compile(source: &str, folder: &Path, options: &[&str]) -> PathBuf {
    let program = folder.join(Path::new(source).file_stem().unwrap());
    let mut cc = Command::new("cc");
    cc.args(["-g", "-Wall", "-Wextra", "-pedantic", "-Werror", "-Iinclude"])
        .args(options)
        .arg(source)
        .arg(format!("-L{}", folder.display()))
        .arg(format!("-Wl,-rpath,{}", folder.display()))
        .args(["-lhbvib", "-lm", "-lpthread", "-ldl", "-o"])
        .arg(&program)
        .current_dir(root());
    run(&mut cc);
    program
}

/// Runs a program of tests/c_abi, which must be silent.
fn silent(name: &str, arguments: impl Fn(&Path) -> Vec<PathBuf>) {
    let folder = workshop(name);
    let program = compile(
        &format!("tests/c_abi/{name}.c"),
        &folder,
        &["-std=c99", "-D_GNU_SOURCE"],
    );
    let output = run(Command::new(program)
        .args(arguments(&folder))
        .env("RUST_BACKTRACE", "1")
        .current_dir(&folder));
    assert_eq!(
        String::from_utf8_lossy(&output.stdout),
        "",
        "{name} wrote to its standard output"
    );
    assert_eq!(
        String::from_utf8_lossy(&output.stderr),
        "",
        "{name} wrote to its standard error"
    );
}

#[test]
fn bad_pointers_sizes_and_buffers_are_refused() {
    silent("bad_pointers", |_| vec![]);
}

#[test]
fn bad_matrices_and_contacts_are_refused() {
    silent("bad_values", |_| vec![]);
}

#[test]
fn bad_options_and_ranges_are_refused() {
    silent("bad_options", |_| vec![]);
}

#[test]
fn sizes_are_told_and_indices_may_count_from_one() {
    silent("counting", |_| vec![]);
}

#[test]
fn results_are_what_they_say() {
    silent("results", |_| vec![]);
}

#[test]
fn nonlinear_modes_are_those_of_the_reference() {
    let reference = &data("nnm_base.json")["H"]["3"];
    let table = reference["table"].as_array().unwrap();
    let rows = [0, table.len() / 2].map(|i| &table[i]);
    let mut numbers: Vec<&Value> = rows.iter().flat_map(|r| [&r["alpha"], &r["omega"], &r["D"]]).collect();
    numbers.push(&reference["D_max"]["D"]);
    silent("mode", |_| {
        numbers.iter().map(|v| number(v).to_string().into()).collect()
    });
}

#[test]
fn bad_options_and_models_of_a_mode_are_refused() {
    silent("bad_modes", |_| vec![]);
}

#[test]
fn responses_are_synthesised_from_modes() {
    silent("synthesis", |_| vec![]);
}

#[test]
fn responses_in_time_are_the_truth_of_the_reference() {
    let td = &data("point_F5_208p85.json")["td"];
    let tip = &td["X"]["1"][0];
    let numbers = [&td["f_Hz"], &tip[0], &tip[1]];
    silent("time", |_| {
        numbers.iter().map(|v| number(v).to_string().into()).collect()
    });
}

#[test]
fn many_contacts_and_springs_are_added_at_once() {
    silent("tables", |_| vec![]);
}

#[test]
fn laws_elements_and_patches_are_those_of_closed_forms() {
    silent("laws", |_| vec![]);
}

#[test]
fn bad_laws_elements_and_patches_are_refused() {
    silent("bad_laws", |_| vec![]);
}

#[test]
fn handles_cannot_be_mistaken() {
    silent("handles", |_| vec![]);
}

#[test]
fn hooks_cancel_and_threads_share_a_model() {
    silent("callbacks", |_| vec![]);
}

#[test]
fn forces_of_the_host_may_fail_and_call_the_library() {
    silent("user_force", |_| vec![]);
}

#[test]
fn the_library_is_a_guest_in_its_process() {
    silent("process", |folder| {
        let copy = folder.join("copy.so");
        fs::copy(library(), &copy).unwrap();
        vec![copy]
    });
}

#[test]
fn the_c_example_finds_the_peak_that_rust_finds() {
    let folder = workshop("ring_damper");
    let program = compile("examples/c/ring_damper.c", &folder, &["-std=c99"]);
    let output = run(&mut Command::new(program));
    let text = String::from_utf8(output.stdout).unwrap();
    let numbers: Vec<f64> = text.split_whitespace().filter_map(|word| word.parse().ok()).collect();
    let [frequency, amplitude] = numbers[..] else {
        panic!("the example printed {text:?}");
    };

    let mut model = Model::cyclic(4, 24).unwrap();
    let diagonal = |d: [f64; 4]| {
        let mut a = [0.0; 16];
        for (i, x) in d.into_iter().enumerate() {
            a[5 * i] = x;
        }
        a
    };
    let mut k = diagonal([2e6, 3e6, 101.6e6, 4e7]);
    for (i, j, x) in [(0, 1, -2e6), (1, 2, -1e6)] {
        k[4 * i + j] = x;
        k[4 * j + i] = x;
    }
    let next = diagonal([0.0, 0.0, -5e7, -2e7]);
    let mass = diagonal([0.2, 0.3, 1.2, 0.03]);
    model
        .set_matrix(MatrixKind::Mass, &MatrixView::dense(4, &mass))
        .unwrap();
    model
        .set_matrix(MatrixKind::Stiffness, &MatrixView::dense(4, &k))
        .unwrap();
    let next = MatrixView::dense(4, &next).part(Part::General);
    model.set_coupling(MatrixKind::Stiffness, &next).unwrap();
    model.set_rayleigh(0.0, 1.5e-6).unwrap();
    model.set_wave(2);
    for dof in [0, 1] {
        model.add_force(dof, 1, Complex64::new(5.0, 0.0)).unwrap();
    }
    let spin: f64 = 3000.0 * 2.0 * PI / 60.0;
    let preload = 0.03 * 0.165 * spin * spin;
    model
        .add_contact(&Contact::jenkins(2, Some(3), 5e7, 0.3, preload))
        .unwrap();
    let solver = SolverOptions {
        response_dof: Some(0),
        ..SolverOptions::default()
    };
    let range = ForcedOptions {
        omega_start: 2.0 * PI * 207.0,
        omega_stop: 2.0 * PI * 211.0,
        ..ForcedOptions::default()
    };
    let branch = forced_response(&model, &solver, &range, &mut Hooks::default()).unwrap();
    let peak = branch
        .peaks()
        .iter()
        .max_by(|a, b| a.amplitude.total_cmp(&b.amplitude))
        .unwrap();
    let near = |a: f64, b: f64| (a - b).abs() <= 1e-12 * b.abs();
    assert!(
        near(frequency, peak.omega / (2.0 * PI)),
        "{frequency} Hz, Rust: {peak:?}"
    );
    assert!(near(amplitude, peak.amplitude), "{amplitude} m, Rust: {peak:?}");
}

/// The words after a label in what a program printed, as numbers.
fn numbers_after(text: &str, label: &str) -> Vec<Vec<f64>> {
    let lines = text.lines().filter_map(|line| line.strip_prefix(label));
    lines
        .map(|line| line.split([' ', ',']).filter_map(|word| word.parse().ok()).collect())
        .collect()
}

#[test]
fn the_c_example_of_a_force_of_its_own_balances_its_work() {
    let folder = workshop("user_force_example");
    let program = compile("examples/c/user_force.c", &folder, &["-std=c99"]);
    let output = run(&mut Command::new(program));
    let text = String::from_utf8(output.stdout).unwrap();
    let response = numbers_after(&text, "response:");
    let peak = &numbers_after(&text, "peak:")[0];
    let largest = response.iter().fold(0.0_f64, |m, row| m.max(row[1]));
    assert!(
        response.len() > 20 && peak[1] >= largest && peak[1] < 1.05 * largest,
        "{text}"
    );
    assert!(peak[0] > 1.0 && peak[0] < 1.6_f64.sqrt(), "{text}");
    let work = &numbers_after(&text, "work:")[0];
    let (given, taken) = (work[0], work[1] + work[2]);
    assert!(work[2] > work[1] && (given / taken - 1.0).abs() < 1e-3, "{text}");
    // The force of a Bouc-Wen element is bounded by k/(beta + gamma).
    let forces = numbers_after(&text, "loop:");
    assert!(
        forces.len() == 32 && forces.iter().all(|row| row[1].abs() < 0.6 / 6.0),
        "{text}"
    );
}

#[test]
fn the_header_compiles_in_every_dialect() {
    for (compiler, language, dialects) in [
        ("cc", "c", &["c99", "c11", "c17"][..]),
        ("c++", "c++", &["c++11", "c++14", "c++17", "c++20"]),
    ] {
        for dialect in dialects {
            run(Command::new(compiler)
                .args([
                    "-Wall",
                    "-Wextra",
                    "-Wpedantic",
                    "-Werror",
                    "-fsyntax-only",
                    "-Iinclude",
                ])
                .args([&format!("-std={dialect}"), "-x", language, "tests/c_abi/header.c"])
                .current_dir(root()));
        }
    }
}

#[test]
fn the_header_has_the_version_of_the_crate() {
    let header = fs::read_to_string(root().join("include/hbvib.h")).unwrap();
    for (name, value) in [
        ("MAJOR", env!("CARGO_PKG_VERSION_MAJOR")),
        ("MINOR", env!("CARGO_PKG_VERSION_MINOR")),
        ("PATCH", env!("CARGO_PKG_VERSION_PATCH")),
    ] {
        let line = format!("#define HBVIB_VERSION_{name} {value}\n");
        assert!(header.contains(&line), "the header lacks {line:?}");
    }
}

/// Names in `text` that begin with hbvib_ and are followed by an opening parenthesis.
fn called(text: &str) -> BTreeSet<&str> {
    let is_name = |c: char| c.is_ascii_alphanumeric() || c == '_';
    text.split('(')
        .map(|before| before.trim_end_matches(is_name).len())
        .zip(text.split('('))
        .map(|(at, before)| &before[at..])
        .filter(|name| name.starts_with("hbvib_"))
        .collect()
}

#[test]
fn only_the_functions_of_the_header_are_exported_and_each_is_tested() {
    let listed = fs::read_to_string(root().join("tests/c_abi/symbols.txt")).unwrap();
    let listed: BTreeSet<&str> = listed.lines().collect();

    let output = run(Command::new("nm").args(["-D", "--defined-only"]).arg(library()));
    let text = String::from_utf8(output.stdout).unwrap();
    let exported: BTreeSet<&str> = text.lines().filter_map(|line| line.split_whitespace().last()).collect();
    assert_eq!(exported, listed, "exported symbols and tests/c_abi/symbols.txt differ");

    let header = fs::read_to_string(root().join("include/hbvib.h")).unwrap();
    let code: String = header
        .lines()
        .filter(|line| !line.trim_start().starts_with("//"))
        .collect();
    assert_eq!(called(&code), listed, "the header and tests/c_abi/symbols.txt differ");

    let mut tests = String::new();
    for entry in fs::read_dir(root().join("tests/c_abi")).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|e| e == "c" || e == "h") {
            tests += &fs::read_to_string(path).unwrap();
        }
    }
    let tested = called(&tests);
    let missing: Vec<_> = listed.iter().filter(|name| !tested.contains(**name)).collect();
    assert!(missing.is_empty(), "no C test calls {missing:?}");
}

#[test]
fn the_library_knows_its_name() {
    let output = run(Command::new("readelf").args(["-d"]).arg(library()));
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(
        text.contains(&format!("[{}]", soname())),
        "no SONAME {} in\n{text}",
        soname()
    );
}
