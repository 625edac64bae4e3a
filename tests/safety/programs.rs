//! C programs of this folder, linked with the shared library.

use crate::common::programs::{library, root, run, soname};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// A folder of the test's own with the library under the names that linker and loader look for.
pub fn workshop(test: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("safety").join(test);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    for name in ["libhbvib.so".to_owned(), soname()] {
        std::os::unix::fs::symlink(library(), folder.join(name)).unwrap();
    }
    folder
}

/// Compiles a source of this folder with warnings denied, and links it with the library.
pub fn compile(name: &str, folder: &Path, options: &[&str]) -> PathBuf {
    let found = format!("-L{}", folder.display());
    let loaded = format!("-Wl,-rpath,{}", folder.display());
    let linked = [found.as_str(), loaded.as_str(), "-lhbvib"];
    compile_alone(name, folder, &[options, &linked].concat())
}

/// The same without the library.
pub fn compile_alone(name: &str, folder: &Path, options: &[&str]) -> PathBuf {
    let program = folder.join(name);
    run(Command::new("cc")
        .args([
            "-g",
            "-O1",
            "-std=gnu99",
            "-Wall",
            "-Wextra",
            "-pedantic",
            "-Werror",
            "-Iinclude",
        ])
        .arg(format!("tests/safety/{name}.c"))
        .args(options)
        .args(["-lm", "-lpthread", "-ldl", "-o"])
        .arg(&program)
        .current_dir(root()));
    program
}

/// The malloc that fails when told, as a library to be preloaded; programs that control it are linked with it.
pub fn failing_malloc(folder: &Path) -> PathBuf {
    let library = folder.join("libfailing_malloc.so");
    run(Command::new("cc")
        .args(["-O2", "-std=gnu99", "-fPIC", "-shared", "-Wall", "-Wextra", "-Werror"])
        .args(["tests/safety/failing_malloc.c", "-o"])
        .arg(&library)
        .current_dir(root()));
    library
}
