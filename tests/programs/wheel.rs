//! The Python wheel and the source distribution: they have all that a user needs, and the library is found.

#![cfg(target_os = "linux")]

use super::languages::{VERSION, check_table, files, script, without_network, workshop};
use crate::common::programs::{printed, python, root, run};
use std::fs;
use std::path::Path;
use std::process::Command;

#[test]
fn the_source_distribution_has_all_that_builds_the_wheel() {
    let folder = workshop("sdist");
    run(without_network(&mut Command::new(python()))
        .args(["-m", "hatchling", "build", "--target", "sdist", "--directory"])
        .arg(&folder)
        .current_dir(root()));
    let archive = folder.join(format!("hbvib-{VERSION}.tar.gz"));
    run(Command::new("tar").arg("xzf").arg(&archive).current_dir(&folder));
    let unpacked = folder.join(format!("hbvib-{VERSION}"));
    for path in files(&root().join("include/hbvib"))
        .iter()
        .chain(&files(&root().join("include")))
    {
        let own = path.strip_prefix(root()).unwrap();
        assert!(
            unpacked.join(own).is_file(),
            "the source distribution has no {}",
            own.display()
        );
    }
    // Cargo finds all members and targets.
    run(without_network(&mut Command::new(env!("CARGO")))
        .args(["metadata", "--offline", "--no-deps", "--format-version", "1"])
        .current_dir(&unpacked));
    for file in [
        "src/lib.rs",
        "crates/hbvib-c/src/lib.rs",
        "crates/hbvib-io/src/lib.rs",
        "docs/statuses.md",
    ] {
        assert!(unpacked.join(file).is_file(), "the source distribution has no {file}");
    }
}

/// The reader of files is an attribute of the package, and its example gives what it says.
const READER: &str = "import doctest, hbvib; failed, tried = doctest.testmod(hbvib.io); assert tried > 4 and not failed; \
                      print(hbvib.lib._name)";

#[test]
fn the_wheel_brings_its_library() {
    let folder = workshop("wheel");
    // The build backend is that of the Python of the tests; pip's own folder for it would be filled from the network.
    let pip = |verb: &str| {
        let mut command = Command::new(python());
        without_network(&mut command)
            .args(["-m", "pip", verb, "--quiet", "--disable-pip-version-check"])
            .args(["--no-deps", "--no-index"])
            .current_dir(&folder);
        command
    };
    run(pip("wheel").arg("--no-build-isolation").arg(root()));
    let wheel = files(&folder).pop().unwrap();
    assert!(
        wheel.to_str().unwrap().contains(&format!("hbvib-{VERSION}-py3-none-")),
        "{}",
        wheel.display()
    );
    run(pip("install")
        .args(["--root-user-action=ignore", "--target", "site"])
        .arg(wheel));
    let installed = folder.join("site/hbvib");
    for file in [
        "libhbvib.so",
        "libhbvib_io.so",
        "io.py",
        "py.typed",
        "include/hbvib.h",
        "include/hbvib_plain.h",
        "include/hbvib_io.h",
    ] {
        assert!(installed.join(file).is_file(), "the wheel has no {file}");
    }
    assert!(folder.join(format!("site/hbvib-{VERSION}.dist-info")).is_dir());
    let places = fs::read_dir(folder.join("site")).unwrap().count();
    assert_eq!(places, 2, "the wheel has more than the package");
    let text = printed(
        script(&root().join("examples/python/ring_damper.py"))
            .env("PYTHONPATH", folder.join("site"))
            .current_dir(&folder),
    );
    check_table("the wheel", &text);
    let reported = printed(
        Command::new(python())
            .args(["-c", READER])
            .env("PYTHONPATH", folder.join("site"))
            .env_remove("HBVIB_LIBRARY"),
    );
    assert_eq!(Path::new(reported.trim()), installed.join("libhbvib.so"));
}
