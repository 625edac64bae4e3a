//! Commands of the README and the book: every block of shell is run, page by page, in a folder that looks like the checkout,
//! and every output, job, manifest and CMake project that a page shows is that of a run.

#![cfg(target_os = "linux")]

use crate::book::first_response;
use crate::common::markdown::{Fence, fences, pages, read};
use crate::common::programs::{library, printed, python, root, run, two_at_a_time};
use crate::designs::saved_model;
use crate::languages::{prefix, without_network, workshop};
use std::fmt::Write;
use std::fs;
use std::os::unix::fs::{PermissionsExt, symlink};
use std::path::{Path, PathBuf};
use std::process::Command;

/// Lines that are too long for a test, or need what is not there yet, with what is run in their place.
const IN_PLACE_OF: [(&str, &str); 7] = [
    // The profile compiles everything once more; the package is that of the checkout.
    ("cargo run --profile quick", "cargo run --release"),
    ("python -m hbvib demo ", "PYTHONPATH=include python -m hbvib demo "),
    // This test is one of them.
    ("sh tests/run.sh", "test -f tests/run.sh"),
    // 10,000 designs take half a minute.
    ("ring_damper -- --study", "ring_damper -- --study --grid 4"),
    // tests/languages/python/test_gallery.py draws all figures.
    ("gallery.py figures", "gallery.py figures hysteresis"),
    // The crate of a user would compile the library with its own options: its manifest is resolved, and
    // book::the_rust_programs_run compiles and runs the program.
    (
        "cargo run --release\n",
        "(cd rust/first && $REAL_CARGO metadata --offline --format-version 1 >metadata.json)\n",
    ),
    // wheel::the_wheel_brings_its_library builds and installs a wheel; only its name differs.
    ("pip install hbvib-", "test -n hbvib-"),
];

/// Files of programs by the language of their blocks: the first block of a page is the program that its commands compile.
const FIRST: [(&str, &str); 4] = [("c", "c"), ("cpp", "cpp"), ("fortran", "f90"), ("python", "py")];

/// Blocks of a language with their pages.
fn blocks(language: &str) -> Vec<(PathBuf, Fence)> {
    let mut found = Vec::new();
    for page in pages() {
        let own = fences(&read(&page))
            .into_iter()
            .filter(|fence| fence.language == language);
        found.extend(own.map(|fence| (page.clone(), fence)));
    }
    assert!(!found.is_empty(), "no block of {language}");
    found
}

/// The first block of a language on a page.
fn first_of(page: &Path, language: &str) -> Option<String> {
    let mut all = fences(&read(page)).into_iter();
    all.find(|fence| fence.language == language).map(|fence| fence.text)
}

/// A command of the session.
fn put(folder: &Path, name: &str, text: &str) {
    let path = folder.join("bin").join(name);
    fs::write(&path, format!("#!/bin/sh\n{text}\n")).unwrap();
    fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).unwrap();
}

/// A folder as the checkout of a user, with the programs that commands of a page compile, and a Python without network.
/// Cargo builds the real checkout, where everything is compiled.
fn checkout(page: &Path) -> PathBuf {
    let name = page.with_extension("").display().to_string().replace('/', "_");
    let folder = workshop(&format!("sessions/{name}"));
    fs::create_dir(folder.join("bin")).unwrap();
    for entry in fs::read_dir(root()).unwrap() {
        let name = entry.unwrap().file_name();
        let own = name.to_str().unwrap_or(".");
        if !own.starts_with('.') && !["target", "examples"].contains(&own) {
            symlink(root().join(own), folder.join(own)).unwrap();
        }
    }
    run(Command::new("cp").arg("-r").arg(root().join("examples")).arg(&folder));
    for (language, extension) in FIRST {
        if let Some(text) = first_of(page, language) {
            fs::write(folder.join(format!("first.{extension}")), text).unwrap();
        }
    }
    let (root, cargo, python) = (root().display(), env!("CARGO"), python());
    let (home, python) = (std::env::var("HOME").unwrap_or_default(), python.display());
    let (real, manifest) = (format!("HOME='{home}' exec '{cargo}'"), format!("'{root}/Cargo.toml'"));
    put(
        &folder,
        "cargo",
        &format!(
            "if [ \"$1\" = install ]; then cd '{root}' && {real} \"$@\"; fi\n\
             verb=$1; shift; {real} \"$verb\" --manifest-path {manifest} \"$@\""
        ),
    );
    let packages = "PYTHONPATH=\"${PYTHONPATH:-$HOME/site}\"";
    put(&folder, "python", &format!("{packages} exec '{python}' \"$@\""));
    let offline = "--quiet --no-deps --no-build-isolation --no-index --root-user-action=ignore --target \"$HOME/site\"";
    let install = format!("exec '{python}' -m pip install --disable-pip-version-check {offline} .");
    put(
        &folder,
        "pip",
        &format!("[ \"$*\" = 'install .' ] && cd '{root}' && {install}"),
    );
    folder
}

/// A crate of a user beside the library, with the manifest that the book shows.
fn user_crate(folder: &Path) {
    let (_, manifest) = blocks("toml")
        .into_iter()
        .find(|(_, fence)| fence.text.contains("[dependencies]"))
        .unwrap();
    let place = folder.join("rust/first");
    fs::create_dir_all(place.join("src")).unwrap();
    symlink(root(), folder.join("rust/hbvib")).unwrap();
    let head = "[workspace]\n[package]\nname = \"first\"\nversion = \"0.1.0\"\nedition = \"2024\"\n";
    fs::write(place.join("Cargo.toml"), format!("{head}{}", manifest.text)).unwrap();
    fs::write(place.join("src/main.rs"), "fn main() {}\n").unwrap();
}

/// Runs commands as a user who is in `folder`, and gives what they print.
fn typed(folder: &Path, commands: &str) -> String {
    let path = std::env::var("PATH").unwrap_or_default();
    let target = Path::new(env!("CARGO_TARGET_TMPDIR")).parent().unwrap();
    let mut command = Command::new("sh");
    without_network(&mut command)
        .args(["-e", "-c", commands])
        .env("HOME", folder)
        .env("PATH", format!("{}:{path}", folder.join("bin").display()))
        .env("CARGO", folder.join("bin/cargo"))
        .env("REAL_CARGO", env!("CARGO"))
        .env("CARGO_INSTALL_ROOT", folder)
        .env("CARGO_TARGET_DIR", target)
        .env("HBVIB_LIBRARY", library())
        .env("MPLBACKEND", "Agg")
        .env("PYTHONDONTWRITEBYTECODE", "1")
        .env_remove("CARGO_MANIFEST_DIR")
        // MPI in containers and on few processors.
        .env("OMPI_ALLOW_RUN_AS_ROOT", "1")
        .env("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1")
        .env("OMPI_MCA_rmaps_base_oversubscribe", "1")
        .env("OMPI_MCA_btl", "self,vader,tcp")
        .env("OMPI_MCA_btl_vader_single_copy_mechanism", "none")
        .current_dir(folder);
    printed(&mut command)
}

/// Numbers in some text.
fn numbers(text: &str) -> Vec<f64> {
    let words = text.split(|c: char| c.is_whitespace() || c == ',');
    words.filter_map(|word| word.parse().ok()).collect()
}

/// Whether some line is the one that a page shows: the same words, and numbers that differ in their last digits at most.
fn shows(text: &str, shown: &str) -> bool {
    let words = |line: &str| -> Vec<String> { line.split_whitespace().map(str::to_owned).collect() };
    let wanted = words(shown);
    text.lines().map(words).any(|line| {
        line.len() == wanted.len()
            && line
                .iter()
                .zip(&wanted)
                .all(|(a, b)| match (a.parse::<f64>(), b.parse::<f64>()) {
                    (Ok(a), Ok(b)) => (a - b).abs() <= 1e-4 * b.abs(),
                    _ => a == b,
                })
    })
}

/// Runs the blocks of shell on a page, one after another, and compares what they print with what the page shows.
fn page_runs(page: &Path) {
    let folder = checkout(page);
    if page.ends_with("many-designs.md") {
        symlink(prefix(), folder.join("hbvib")).unwrap();
        saved_model(&folder);
    }
    let mut commands = String::new();
    for fence in fences(&read(page)).iter().filter(|fence| fence.language == "sh") {
        let mut text = fence.text.replace("PREFIX", prefix().to_str().unwrap());
        for (line, other) in IN_PLACE_OF {
            text = text.replace(line, other);
        }
        if text.contains("rust/first") {
            user_crate(&folder);
        }
        // A program that was compiled runs.
        writeln!(commands, "{text}if [ -x first ]; then ./first; rm first; fi").unwrap();
    }
    let text = typed(&folder, &commands);
    for fence in fences(&read(page)) {
        let place = format!("{}:{}", page.display(), fence.line);
        match fence.language.as_str() {
            "output" => {
                for line in fence.text.lines().filter(|line| *line != "...") {
                    assert!(
                        shows(&text, line),
                        "{place}: no line of the output is\n{line}\nbut\n{text}"
                    );
                }
            }
            "pycon" => {
                fs::write(folder.join("wheel/shown.txt"), &fence.text).unwrap();
                typed(&folder.join("wheel"), "../bin/python -m doctest shown.txt");
            }
            _ => {}
        }
    }
    // The first response is that of Rust, in every language.
    let resonance = *first_response().last().unwrap();
    let found: Vec<f64> = text
        .lines()
        .filter(|line| line.contains("resonance at"))
        .flat_map(numbers)
        .collect();
    assert!(found.iter().all(|a| (a / resonance - 1.0).abs() < 1e-5), "{found:?}");
    if page.ends_with("first-response.md") {
        assert_eq!(found.len(), FIRST.len(), "{text}");
    }
}

#[test]
fn commands_of_every_page_run() {
    let mut found: Vec<PathBuf> = blocks("sh").into_iter().map(|(page, _)| page).collect();
    found.dedup();
    two_at_a_time(&found, |page| page_runs(page));
}

#[test]
fn outputs_stand_on_pages_whose_commands_run() {
    for language in ["output", "pycon"] {
        for (page, fence) in blocks(language) {
            let place = format!("{}:{}", page.display(), fence.line);
            assert!(first_of(&page, "sh").is_some(), "{place}: no command prints it");
        }
    }
}

/// Writes two bricks that face each other, their matrices by CalculiX, and a field of their contact.
fn two_blocks(folder: &Path) {
    let mut text = String::from("*NODE\n");
    for (k, z) in [0.0, 1.0, 1.0001, 2.0].into_iter().enumerate() {
        for (i, (x, y)) in [(0, 0), (1, 0), (1, 1), (0, 1)].into_iter().enumerate() {
            writeln!(text, "{}, {x}, {y}, {z}", 4 * k + i + 1).unwrap();
        }
    }
    text += "*ELEMENT, TYPE=C3D8, ELSET=SOLID\n1, 1,2,3,4,5,6,7,8\n2, 9,10,11,12,13,14,15,16\n\
             *NSET, NSET=FOOT\n1,2,3,4,13,14,15,16\n*NSET, NSET=RIM\n5,6,7,8\n*NSET, NSET=RIM_FILLET\n6,7\n*NSET, NSET=RING\n9,10,11,12\n";
    fs::write(folder.join("blocks.inp"), text).unwrap();
    let mut field =
        String::from(" -4  CONTACT     2    1\n -5  COPEN       1    4    1    1\n -5  CPRESS      1    4    1    2\n");
    for node in 9..=12 {
        writeln!(field, " -1{node:>10}-1.00000E-06 2.00000E+05").unwrap();
    }
    fs::write(folder.join("static.frd"), field + " -3\n").unwrap();
    let mut command = Command::new(env!("CARGO"));
    let arguments = ["run", "--quiet", "--release", "-p", "hbvib-cli", "--manifest-path"];
    run(without_network(&mut command)
        .args(arguments)
        .arg(root().join("Cargo.toml"))
        .args([
            "--",
            "init",
            "--mesh",
            "blocks.inp",
            "--fixed",
            "FOOT",
            "--output",
            "first.toml",
        ])
        .current_dir(folder));
}

#[test]
fn jobs_and_manifests_of_the_book_are_read() {
    for (page, fence) in blocks("toml") {
        let place = format!("{}:{}", page.display(), fence.line);
        let folder = workshop(&format!("jobs/{}_{}", page.file_stem().unwrap().display(), fence.line));
        let data = root().join("crates/hbvib-io/tests/data");
        let own = root().join("examples/jobs/cover_plate/job.toml");
        let (verb, text) = if fence.text.contains("[dependencies]") {
            // commands_of_every_page_run resolves this manifest.
            continue;
        } else if page.ends_with("from-fe-to-response.md") {
            // This one runs with the commands of its page.
            let job = fs::read_to_string(own).unwrap();
            assert!(job.ends_with(&fence.text), "{place} is not the job of the example");
            continue;
        } else if page.ends_with("prestress.md") && fence.text.starts_with("[model]") {
            // This one runs with the commands of its page, too.
            let job = fs::read_to_string(root().join("examples/jobs/cover_plate/rotating.toml")).unwrap();
            assert!(job.ends_with(&fence.text), "{place} is not the job of the example");
            continue;
        } else if fence.text.contains("[contact.surfaces]") {
            two_blocks(&folder);
            let model = "[model]\nmatrices = 'blocks_matrices.sti'\nmesh = 'blocks.inp'\nabsent = 'fixed'\n";
            (
                "check",
                format!("{model}{}[forced]\nfrom_hz = 1.0\nto_hz = 2.0\n", fence.text),
            )
        } else if fence.text.lines().any(|line| line == "[model]") {
            for file in ["stiffness.mtx", "mass.mtx", "coupling.mtx"] {
                fs::copy(root().join("examples/jobs/ring_damper").join(file), folder.join(file)).unwrap();
            }
            ("run", fence.text)
        } else {
            for extension in ["sti", "mas", "dof", "inp"] {
                let file = data.join("sector").with_extension(extension);
                fs::copy(file, folder.join("wheel").with_extension(extension)).unwrap();
            }
            fs::write(folder.join("test.csv"), "hz, re, im\n1.0, 0.1, -0.2\n").unwrap();
            // The nodes of these data lie further apart.
            let part = fence.text.replace("largest_distance = 1e-3", "largest_distance = 10.0");
            let range = "[forced]\nfrom_hz = 1.0\nto_hz = 2.0\n";
            ("check", format!("[model]\nmatrices = 'wheel.sti'\n{part}{range}"))
        };
        println!("{place}");
        fs::write(folder.join("job.toml"), &text).unwrap();
        let mut command = Command::new(env!("CARGO"));
        let arguments = ["run", "--quiet", "--release", "-p", "hbvib-cli", "--", verb];
        run(without_network(&mut command)
            .args(arguments)
            .arg(folder.join("job.toml"))
            .current_dir(root()));
        for line in text.lines().filter(|_| verb == "run") {
            // Every file that it names is written.
            if let Some((key, file)) = line.split_once(" = \"") {
                let file = file.split('"').next().unwrap();
                let written = key == "csv" || key == "npz" || key.ends_with("figure") || key.ends_with("_csv");
                assert!(
                    !written || folder.join(file).is_file(),
                    "{place}: {file} was not written"
                );
            }
        }
    }
}

#[test]
fn inputs_of_other_programs_are_those_of_the_examples() {
    let own = ["matrices.inp", "rotating.inp"]
        .map(|file| fs::read_to_string(root().join("examples/jobs/cover_plate").join(file)).unwrap());
    for (page, fence) in blocks("inp") {
        assert!(
            own.iter().any(|own| own.contains(&fence.text)),
            "{}:{} is not in matrices.inp or rotating.inp",
            page.display(),
            fence.line
        );
    }
}

#[test]
fn cmake_projects_of_the_book_build_and_run() {
    for (page, fence) in blocks("cmake") {
        let folder = workshop(&format!("cmake_projects/{}", fence.line));
        fs::write(folder.join("CMakeLists.txt"), &fence.text).unwrap();
        fs::write(folder.join("first.cpp"), first_of(&page, "cpp").unwrap()).unwrap();
        run(Command::new("cmake")
            .args(["-S", ".", "-B", "build"])
            .arg(format!("-DCMAKE_PREFIX_PATH={}", prefix().display()))
            .current_dir(&folder));
        run(Command::new("cmake").args(["--build", "build"]).current_dir(&folder));
        run(&mut Command::new(folder.join("build/first")));
    }
}
