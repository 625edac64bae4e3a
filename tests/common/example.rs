//! Builds examples, and runs `ring_damper` as a user does.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::OnceLock;

use serde_json::Value;

/// Names of the degrees of freedom in the files that it writes.
pub const DOFS: [&str; 4] = ["b2", "b1", "d", "r"];

/// An example, built into the target folder of this test; cargo says where it lies.
pub fn built(name: &str) -> PathBuf {
    let target = Path::new(env!("CARGO_TARGET_TMPDIR")).parent().unwrap();
    let output = Command::new(env!("CARGO"))
        .args(["build", "--release", "--example", name, "--message-format", "json"])
        .arg("--manifest-path")
        .arg(crate::common::programs::root().join("Cargo.toml"))
        .arg("--target-dir")
        .arg(target)
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let messages = String::from_utf8(output.stdout).unwrap();
    let mut built = messages.lines().filter_map(|line| {
        let message: Value = serde_json::from_str(line).ok()?;
        let named = message["target"]["name"] == name;
        named
            .then(|| message["executable"].as_str().map(PathBuf::from))
            .flatten()
    });
    built.next_back().unwrap()
}

/// The example `ring_damper`, built once.
fn program() -> &'static Path {
    static PROGRAM: OnceLock<PathBuf> = OnceLock::new();
    PROGRAM.get_or_init(|| built("ring_damper"))
}

/// An empty folder of its own for one test.
pub fn folder(name: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("ring_damper_{name}"));
    if path.exists() {
        fs::remove_dir_all(&path).unwrap();
    }
    fs::create_dir_all(&path).unwrap();
    path
}

/// Runs the example in a folder.
pub fn run(folder: &Path, flags: &[&str]) -> Output {
    let mut command = Command::new(program());
    command.current_dir(folder).args(flags);
    // Outside of `cargo run` the program writes below the current folder.
    command.env_remove("CARGO_MANIFEST_DIR").output().unwrap()
}
