//! Programs that use all of the interface in C++, Fortran and Python as the language itself would be used, with warnings
//! as errors.

#![cfg(target_os = "linux")]

use crate::common::programs::{printed, root, run, two_at_a_time};
use crate::languages::{compiled, copied, files, fortran_module, pkg_config, script, workshop};
use std::path::{Path, PathBuf};
use std::process::Command;

/// Warnings are errors in everything that is compiled for a test.
const STRICT: [&str; 4] = ["-Wall", "-Wextra", "-pedantic", "-Werror"];

/// Sources of tests/languages/NAME with an extension.
fn tests_in(language: &str, extension: &str) -> Vec<PathBuf> {
    let mut found = files(&root().join("tests/languages").join(language));
    found.retain(|path| path.extension().is_some_and(|e| e == extension));
    assert!(!found.is_empty(), "no test in {language}");
    found
}

fn stem(path: &Path) -> &str {
    path.file_stem().and_then(|stem| stem.to_str()).unwrap()
}

/// Copies of the C++ tests in a folder, beside a precompiled header of what they share, whose parsing takes most of the time.
fn cpp_sources(standard: &str, options: &[&str]) -> (PathBuf, Vec<PathBuf>) {
    let folder = copied("tests/languages/cpp", &format!("cpp_tests/{standard}"));
    run(Command::new("c++")
        .args(options)
        .args(pkg_config(&["--cflags"]))
        .args(["-x", "c++-header", "common.hpp", "-o", "common.hpp.gch"])
        .current_dir(&folder));
    let mut sources = files(&folder);
    sources.retain(|path| path.extension().is_some_and(|e| e == "cpp"));
    assert!(!sources.is_empty(), "no test in C++");
    (folder, sources)
}

/// Options for the C++ tests. A precompiled header that does not fit would be an error as well.
fn cpp_options(standard: &str) -> Vec<String> {
    let eigen = printed(Command::new("pkg-config").args(["--cflags-only-I", "eigen3"]));
    let eigen = eigen.trim().replace("-I", "-isystem");
    let standard = format!("-std={standard}");
    let own = [
        "-Wshadow",
        "-Wconversion",
        "-Winvalid-pch",
        "-pthread",
        &eigen,
        &standard,
    ];
    STRICT.iter().chain(&own).map(|&option| option.to_owned()).collect()
}

#[test]
fn cpp_feels_native() {
    let options = cpp_options("c++17");
    let options: Vec<&str> = options.iter().map(String::as_str).collect();
    let (folder, sources) = cpp_sources("c++17", &options);
    two_at_a_time(&sources, |source| {
        run(&mut compiled(
            "c++",
            &options,
            std::slice::from_ref(source),
            &folder,
            stem(source),
        ));
    });
}

#[test]
#[ignore = "compiles all programs once more; tests/deep.sh runs it"]
fn cpp_is_cpp_20_as_well() {
    let options = cpp_options("c++20");
    let options: Vec<&str> = options.iter().map(String::as_str).collect();
    let (_, sources) = cpp_sources("c++20", &options);
    two_at_a_time(&sources, |source| {
        let mut command = Command::new("c++");
        command.args(&options).args(pkg_config(&["--cflags"]));
        run(command.arg("-fsyntax-only").arg(source));
    });
}

#[test]
fn fortran_feels_native() {
    let common = root().join("tests/languages/fortran/common.f90");
    let options = [
        &STRICT[..],
        &["-std=f2018", "-fopenmp", "-ffpe-trap=invalid,zero,overflow"],
    ]
    .concat();
    // The modules are compiled once.
    let modules = workshop("fortran_tests/modules");
    let mut command = Command::new("gfortran");
    command.args(&options).arg("-c").args([fortran_module(), common]);
    run(command.current_dir(&modules));
    let place = format!("-I{}", modules.display());
    let options = [&options[..], &[&place]].concat();
    let names = [
        "aero",
        "all_solutions",
        "batch",
        "guard",
        "misuse",
        "modes_and_damping",
        "physics",
        "saved",
        "senses",
        "statuses",
        "threads",
        "wear_and_passages",
    ];
    two_at_a_time(&names, |name| {
        let folder = workshop(&format!("fortran_tests/{name}"));
        let source = root().join(format!("tests/languages/fortran/{name}.f90"));
        let sources = [modules.join("hbvib.o"), modules.join("common.o"), source];
        run(&mut compiled("gfortran", &options, &sources, &folder, name));
    });
    // A status that nobody receives ends the program.
    let folder = workshop("fortran_tests/stops");
    let source = root().join("tests/languages/fortran/stops.f90");
    let output = compiled("gfortran", &STRICT, &[fortran_module(), source], &folder, "stops")
        .output()
        .unwrap();
    let text = String::from_utf8_lossy(&output.stderr);
    assert!(
        output.status.code() == Some(1) && output.stdout.is_empty() && text.contains("HBVIB_E_INDEX: dof = 3"),
        "{text}"
    );
    // Numbers in single precision are an error of the compiler's, each of them.
    let folder = workshop("fortran_tests/wrong_kind");
    let output = Command::new("gfortran")
        .args(["-std=f2018", "-fsyntax-only"])
        .args([fortran_module(), root().join("tests/languages/fortran/wrong_kind.f90")])
        .current_dir(&folder)
        .output()
        .unwrap();
    let text = String::from_utf8_lossy(&output.stderr);
    assert_eq!(text.matches("Error:").count(), 4, "{text}");
}

#[test]
fn python_feels_native() {
    let folder = workshop("python_tests");
    let mut scripts = tests_in("python", "py");
    scripts.retain(|path| stem(path).starts_with("test_"));
    two_at_a_time(&scripts, |path| {
        run(script(path).current_dir(&folder));
    });
}
