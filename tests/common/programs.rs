//! Shared code of the tests of other languages: the checkout, the library under test, programs that must succeed.

use std::env;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicUsize, Ordering};

/// The path of the checkout, which this package lies in.
pub fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap()
}

/// The folder of the profile with which cargo has built this test.
fn built() -> PathBuf {
    let program = env::current_exe().unwrap();
    let deps = program.parent().unwrap();
    deps.parent().unwrap().to_owned()
}

/// The shared library of the sources that this test was built from. Cargo builds it with the test's own crate, so that
/// it is linked alone here, or is there already.
pub fn library() -> PathBuf {
    static LIBRARY: OnceLock<PathBuf> = OnceLock::new();
    LIBRARY
        .get_or_init(|| {
            let folder = built();
            let mut command = Command::new(env!("CARGO"));
            command.args(["build", "--quiet", "--lib", "--target-dir"]);
            command.arg(folder.parent().unwrap()).current_dir(root());
            if folder.ends_with("release") {
                command.arg("--release");
            }
            // All that a build needs is there since the test itself was built.
            run(command.env("CARGO_NET_OFFLINE", "true"));
            folder.join("libhbvib.so")
        })
        .clone()
}

/// The name by which the loader knows the library.
pub fn soname() -> String {
    format!(
        "libhbvib.so.{}.{}",
        env!("CARGO_PKG_VERSION_MAJOR"),
        env!("CARGO_PKG_VERSION_MINOR")
    )
}

/// Runs a program that must succeed.
pub fn run(command: &mut Command) -> Output {
    // Cargo's search path contains the library of the last `cargo build`, which may be an older one.
    let output = command.env_remove("LD_LIBRARY_PATH").output().unwrap_or_else(|error| {
        panic!("{command:?} could not be started: {error}. It is NOT tested without it; sh tests/run.sh installs it")
    });
    assert!(
        output.status.success(),
        "{command:?} failed, {}:\n{}{}",
        output.status,
        String::from_utf8_lossy(&output.stdout),
        String::from_utf8_lossy(&output.stderr)
    );
    output
}

/// Output of a program, which must succeed.
pub fn printed(command: &mut Command) -> String {
    String::from_utf8(run(command).stdout).unwrap()
}

/// The Python of the tests: that of the virtual environment that tests/run.sh creates if the system has no numpy.
pub fn python() -> PathBuf {
    let own = root().join(".venv/bin/python");
    if own.is_file() { own } else { "python3".into() }
}

/// Does some work for each of many things, on two threads, so that a test of many programs is not the only one at the end.
pub fn two_at_a_time<T: Sync>(things: &[T], work: impl Fn(&T) + Sync) {
    let next = AtomicUsize::new(0);
    std::thread::scope(|scope| {
        for _ in 0..2 {
            scope.spawn(|| {
                while let Some(thing) = things.get(next.fetch_add(1, Ordering::Relaxed)) {
                    work(thing);
                }
            });
        }
    });
}
