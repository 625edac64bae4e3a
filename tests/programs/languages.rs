//! The steps of users of C, C++, Fortran and Python: install, move the prefix, build against it, load it. All
//! programs are built in folders of their own against a prefix that was moved after its installation,
//! never against the checkout.

#![cfg(target_os = "linux")]

use crate::common::programs::{printed, python, root, run, soname};
use crate::common::{self, BASE, Blisk, at_dof, data, harmonics, number, omega_range};
use hbvib::{Hooks, forced_response};
use std::collections::BTreeSet;
use std::f64::consts::TAU;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::OnceLock;

pub const VERSION: &str = env!("CARGO_PKG_VERSION");

/// An empty folder.
pub fn workshop(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("languages").join(name);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    folder
}

/// A folder with a copy of a folder's files.
pub fn copied(from: &str, name: &str) -> PathBuf {
    let folder = workshop(name);
    for path in files(&root().join(from)) {
        fs::copy(&path, folder.join(path.file_name().unwrap())).unwrap();
    }
    folder
}

/// Files of a folder, sorted.
pub fn files(folder: &Path) -> Vec<PathBuf> {
    let mut found: Vec<_> = fs::read_dir(folder)
        .unwrap_or_else(|error| panic!("{}: {error}", folder.display()))
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.is_file())
        .collect();
    found.sort();
    found
}

/// Where install.sh was told to install: nothing is there any more.
fn first_place() -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join("languages/first")
}

/// A command whose cargo is that of the test. It must not reach for the network: all that a build needs is there since
/// the test itself was built.
pub fn without_network(command: &mut Command) -> &mut Command {
    command.env("CARGO", env!("CARGO")).env("CARGO_NET_OFFLINE", "true")
}

/// An installation that was moved.
pub fn prefix() -> &'static Path {
    static PREFIX: OnceLock<PathBuf> = OnceLock::new();
    PREFIX.get_or_init(|| {
        let folder = workshop("first");
        run(without_network(&mut Command::new("sh"))
            .arg("examples/install.sh")
            .arg(&folder)
            .current_dir(root()));
        let moved = workshop("moved").join("prefix");
        fs::rename(folder, &moved).unwrap();
        moved
    })
}

pub fn pkg_config(arguments: &[&str]) -> Vec<String> {
    let text = printed(
        Command::new("pkg-config")
            .args(arguments)
            .arg("hbvib")
            .env("PKG_CONFIG_PATH", prefix().join("lib/pkgconfig")),
    );
    text.split_whitespace().map(str::to_owned).collect()
}

/// Files that a program needs besides its own sources to be linked with the shared library.
fn linked() -> Vec<String> {
    let mut flags = pkg_config(&["--cflags", "--libs"]);
    flags.push("-lm".to_owned());
    flags
}

/// A program compiled in `folder` from some sources.
pub fn compiled(compiler: &str, options: &[&str], sources: &[PathBuf], folder: &Path, name: &str) -> Command {
    let program = folder.join(name);
    run(Command::new(compiler)
        .args(options)
        .args(sources)
        .arg("-o")
        .arg(&program)
        .args(linked())
        .current_dir(folder));
    Command::new(program)
}

pub fn fortran_module() -> PathBuf {
    PathBuf::from(&pkg_config(&["--variable=fortran_module"])[0])
}

/// Python with the module of the prefix, which must find the library beside it by itself.
pub fn script(path: &Path) -> Command {
    let mut command = Command::new(python());
    command
        .arg(path)
        .env("PYTHONPATH", &pkg_config(&["--variable=python_path"])[0])
        .env("PYTHONDONTWRITEBYTECODE", "1")
        .env("MPLBACKEND", "Agg")
        .env_remove("HBVIB_LIBRARY");
    command
}

pub fn make(folder: &Path) {
    run(Command::new("make")
        .arg(format!("PKG_CONFIG_PATH={}", prefix().join("lib/pkgconfig").display()))
        .current_dir(folder));
}

#[test]
fn the_installation_is_complete_and_may_be_moved() {
    let lib = prefix().join("lib");
    let target = |name: &str| fs::read_link(lib.join(name)).unwrap();
    assert_eq!(target("libhbvib.so"), Path::new(&soname()));
    assert_eq!(target(&soname()), PathBuf::from(format!("libhbvib.so.{VERSION}")));
    for path in [
        "lib/libhbvib.a",
        "lib/libhbvib_io.so",
        "include/hbvib.h",
        "include/hbvib_io.h",
        "include/hbvib.hpp",
        "include/hbvib.f90",
        "share/hbvib/hbvib/__init__.py",
        "share/hbvib/hbvib/py.typed",
    ] {
        let installed = prefix().join(path);
        assert!(installed.is_file(), "{path} was not installed");
        let rest = path.strip_prefix("share/hbvib/").or(path.strip_prefix("include/"));
        let own = root().join("include").join(rest.unwrap_or(path));
        assert!(
            !own.is_file() || fs::read(own).unwrap() == fs::read(&installed).unwrap(),
            "{path} is not that of the checkout"
        );
    }

    assert!(!first_place().exists());
    for folder in ["lib/pkgconfig", "lib/cmake/hbvib"] {
        for path in files(&prefix().join(folder)) {
            let text = fs::read_to_string(&path).unwrap();
            let place = first_place();
            assert!(
                !text.contains(place.to_str().unwrap()),
                "{} knows where it was installed",
                path.display()
            );
            assert!(!text.contains('@'), "{} is a template still", path.display());
        }
    }
}

/// Runs install.sh in a folder of the test's own.
fn install(folder: &Path, prefix: &str, destination: Option<&Path>) -> Output {
    let mut command = Command::new("sh");
    without_network(&mut command)
        .arg(root().join("examples/install.sh"))
        .arg(prefix)
        .env_remove("DESTDIR")
        .current_dir(folder);
    if let Some(destination) = destination {
        command.env("DESTDIR", destination);
    }
    command.output().unwrap()
}

#[test]
fn prefixes_may_be_relative_spaced_staged_and_used_again() {
    let folder = workshop("prefixes");
    let stage = folder.join("stage");
    let installs = |prefix: &str, destination: Option<&Path>| {
        let output = install(&folder, prefix, destination);
        assert!(
            output.status.success(),
            "install.sh {prefix} failed: {}",
            String::from_utf8_lossy(&output.stderr)
        );
    };
    installs("relative", None);
    installs("relative", None);
    assert!(folder.join("relative/lib/libhbvib.so").is_file());
    installs("with space", None);
    assert!(folder.join("with space/share/hbvib/hbvib/__init__.py").is_file());
    installs("/opt/hbvib", Some(&stage));
    assert!(stage.join("opt/hbvib/include/hbvib.h").is_file() && !Path::new("/opt/hbvib").exists());
    let is_refused = |prefix: &str, destination: Option<&Path>| !install(&folder, prefix, destination).status.success();
    assert!(is_refused("relative", Some(&stage)) && is_refused("", None));
    // Three static libraries, which nobody reads again.
    fs::remove_dir_all(&folder).unwrap();
}

#[test]
fn the_installed_library_shows_only_its_functions_and_needs_only_libc() {
    let library = prefix().join("lib/libhbvib.so");
    let text = printed(Command::new("nm").args(["-D", "--defined-only"]).arg(&library));
    let exported: BTreeSet<&str> = text.lines().filter_map(|line| line.split_whitespace().last()).collect();
    let listed = fs::read_to_string(root().join("tests/c_abi/symbols.txt")).unwrap();
    assert_eq!(exported, listed.lines().collect());

    let text = printed(Command::new("readelf").arg("-d").arg(&library));
    assert!(
        text.contains(&format!("SONAME)             Library soname: [{}]", soname())),
        "{text}"
    );
    for line in text.lines().filter(|line| line.contains("(NEEDED)")) {
        // The loader itself is part of libc; thread-local variables need it.
        let known = ["[libc.so.6]", "[libm.so.6]", "[libgcc_s.so.1]", "[ld-linux-"];
        assert!(known.iter().any(|name| line.contains(name)), "{line}");
    }
    assert!(!text.contains("RPATH") && !text.contains("RUNPATH"), "{text}");

    // The pages tell its size.
    let size = fs::metadata(&library).unwrap().len() as f64 / 1e6;
    for (page, words) in [("README.md", "it has "), ("docs/linking.md", "stripped library is ")] {
        let page = fs::read_to_string(root().join(page)).unwrap();
        let after = page
            .split(words)
            .find_map(|rest| rest.split_once(" MB")?.0.parse::<f64>().ok());
        assert!(
            after.is_some_and(|told| (told - size).abs() < 1.0),
            "{after:?} MB in the text, {size} MB"
        );
    }
}

#[test]
fn header_library_and_packages_have_the_version_of_the_crate() {
    assert_eq!(pkg_config(&["--modversion"]), [VERSION]);
    let folder = workshop("version");
    let source = folder.join("version.c");
    fs::write(
        &source,
        "#include \"hbvib.h\"\n#include <stdio.h>\nint main(void) {\n\
         printf(\"%d.%d.%d %s %u\\n\", HBVIB_VERSION_MAJOR, HBVIB_VERSION_MINOR, HBVIB_VERSION_PATCH,\n\
         hbvib_version_string(), (unsigned)hbvib_version()); return 0; }\n",
    )
    .unwrap();
    let reported = printed(&mut compiled("cc", &[], &[source], &folder, "version"));
    let number = VERSION
        .split('.')
        .fold(0, |n, part| n * 256 + part.parse::<u32>().unwrap());
    assert_eq!(reported, format!("{VERSION} {VERSION} {number}\n"));

    // The modules say for which library they were written.
    let parts: Vec<&str> = VERSION.split('.').collect();
    let module = fs::read_to_string(fortran_module()).unwrap();
    for (name, part) in ["MAJOR", "MINOR", "PATCH"].iter().zip(&parts) {
        let constant = format!("HBVIB_VERSION_{name} = {part}");
        let after = module
            .split(&constant)
            .nth(1)
            .unwrap_or_else(|| panic!("hbvib.f90 lacks {constant}"));
        assert!(
            !after.starts_with(|c: char| c.is_ascii_digit()),
            "hbvib.f90: {constant}"
        );
    }
    let reported = printed(script(Path::new("-c")).arg("import hbvib; print(hbvib.__version__)"));
    assert_eq!(reported.trim(), VERSION);

    let abi = VERSION.rsplit_once('.').unwrap().0;
    for (wanted, fits) in [
        ("", true),
        (abi, true),
        (VERSION, true),
        ("0.0", false),
        ("99.0", false),
    ] {
        let project = format!(
            "cmake_minimum_required(VERSION 3.16)\nproject(version NONE)\nfind_package(hbvib {wanted} QUIET CONFIG)\n\
             if(NOT hbvib_FOUND STREQUAL \"{}\")\nmessage(FATAL_ERROR \"found: ${{hbvib_FOUND}}\")\nendif()\n",
            i32::from(fits)
        );
        let folder = workshop("cmake_version");
        fs::write(folder.join("CMakeLists.txt"), project).unwrap();
        run(Command::new("cmake")
            .args(["-S", ".", "-B", "build"])
            .arg(format!("-DCMAKE_PREFIX_PATH={}", prefix().display()))
            .current_dir(&folder));
    }
}

/// The table that the examples print, from Rust.
fn table() -> Vec<[f64; 3]> {
    let solver = at_dof(common::B2, harmonics(63));
    let range = omega_range(TAU * 207.0, TAU * 211.0);
    [1.0, 5.0, 20.0]
        .map(|force| {
            let model = Blisk { force, ..BASE }.sector();
            let branch = forced_response(&model, &solver, &range, &mut Hooks::default()).unwrap();
            let peaks = branch.peaks();
            let peak = peaks.iter().max_by(|a, b| a.amplitude.total_cmp(&b.amplitude)).unwrap();
            [force, peak.omega / TAU, peak.amplitude]
        })
        .to_vec()
}

/// Checks what a caller printed: the numbers that Rust finds, and the peaks of a time integration by
/// another program, from which H = 63 differs by 2e-5.
pub fn check_table(caller: &str, text: &str) {
    let rows: Vec<Vec<f64>> = text
        .lines()
        .skip(1)
        .map(|line| line.split_whitespace().map(|word| word.parse().unwrap()).collect())
        .collect();
    let rust = table();
    assert_eq!(rows.len(), rust.len(), "{caller} printed\n{text}");
    let truth = &data("frf_base.json")["peaks"];
    for (row, own) in rows.iter().zip(&rust) {
        for (a, b) in row.iter().zip(own) {
            assert!((a - b).abs() <= 1e-12 * b.abs(), "{caller}: {row:?}, Rust {own:?}");
        }
        let peak = &truth[format!("F{}", own[0])]["peak_td"];
        for (a, b, accuracy) in [
            (row[1], number(&peak["f_Hz"]), 1e-6),
            (row[2], number(&peak["amp_b2_fund_m"]), 3e-5),
        ] {
            assert!((a / b - 1.0).abs() < accuracy, "{caller}: {a}, in time {b}");
        }
    }
}

/// Output of a program that fits a joint to a file of responses.
fn fitted(mut program: Command) -> String {
    printed(program.arg(root().join("examples/data/joint.csv")))
}

#[test]
fn five_languages_print_one_table() {
    let folder = copied("examples/c", "c");
    make(&folder);
    let c = printed(&mut Command::new(folder.join("ring_damper")));
    check_table("C", &c);
    let fit = fitted(Command::new(folder.join("fit_joint")));
    let chi2 = fit
        .lines()
        .nth(4)
        .and_then(|line| line.split_whitespace().nth(1))
        .unwrap_or("");
    let wanted = number(&data("identify.json")["fit"]["chi2"]);
    assert!((chi2.parse::<f64>().unwrap() / wanted - 1.0).abs() < 1e-12, "{fit}");

    let stat = folder.join("static");
    run(Command::new("cc")
        .arg("ring_damper.c")
        .args(pkg_config(&["--cflags"]))
        .args(pkg_config(&["--variable=static_library"]))
        .args(["-lgcc_s", "-lutil", "-lrt", "-lpthread", "-lm", "-ldl", "-o"])
        .arg(&stat)
        .current_dir(&folder));
    let needed = printed(Command::new("readelf").arg("-d").arg(&stat));
    assert!(!needed.contains("libhbvib"), "{needed}");
    assert_eq!(printed(&mut Command::new(stat)), c, "C with the static library");

    let folder = copied("examples/cpp", "cpp");
    cmake(&folder);
    let cpp = printed(&mut Command::new(folder.join("build/ring_damper")));
    assert_eq!(cpp, c, "C++ and C");
    assert_eq!(
        fitted(Command::new(folder.join("build/fit_joint"))),
        fit,
        "a fit in C++ and C"
    );

    let folder = copied("examples/fortran", "fortran");
    make(&folder);
    let fortran = printed(&mut Command::new(folder.join("ring_damper")));
    assert_eq!(fortran, c, "Fortran and C");
    assert_eq!(
        fitted(Command::new(folder.join("fit_joint"))),
        fit,
        "a fit in Fortran and C"
    );

    let folder = copied("examples/fortran", "fortran_cmake");
    fs::write(
        folder.join("CMakeLists.txt"),
        "cmake_minimum_required(VERSION 3.16)\nproject(one Fortran)\nfind_package(hbvib REQUIRED)\n\
         add_executable(ring_damper ring_damper.f90 ${hbvib_FORTRAN_MODULE})\n\
         add_executable(alone ring_damper.f90 ${hbvib_FORTRAN_MODULE})\n\
         set_target_properties(alone PROPERTIES Fortran_MODULE_DIRECTORY modules_of_alone)\n\
         target_link_libraries(ring_damper PRIVATE hbvib::hbvib)\n\
         target_link_libraries(alone PRIVATE hbvib::static)\n",
    )
    .unwrap();
    cmake(&folder);
    for program in ["ring_damper", "alone"] {
        let text = printed(&mut Command::new(folder.join("build").join(program)));
        assert_eq!(text, c, "Fortran by CMake and C");
    }

    let folder = copied("examples/python", "python");
    let text = printed(
        script(&folder.join("ring_damper.py"))
            .args(["--figures", "figures"])
            .current_dir(&folder),
    );
    assert_eq!(text, c, "Python and C");
    assert_eq!(
        fitted(script(&folder.join("fit_joint.py"))),
        fit,
        "a fit in Python and C"
    );
    let figures = files(&folder.join("figures"));
    assert!(!figures.is_empty());
    for path in figures {
        // A figure with curves in it, not an empty frame.
        assert!(fs::metadata(&path).unwrap().len() > 10_000, "{}", path.display());
    }
}

fn cmake(folder: &Path) {
    run(Command::new("cmake")
        .args(["-S", ".", "-B", "build", "-DCMAKE_BUILD_TYPE=Release"])
        .arg(format!("-DCMAKE_PREFIX_PATH={}", prefix().display()))
        .current_dir(folder));
    run(Command::new("cmake").args(["--build", "build"]).current_dir(folder));
}
