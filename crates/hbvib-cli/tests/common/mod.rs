//! Jobs on the ring damper, and the command that runs them.
#![allow(dead_code, reason = "each test uses a part of this module")]

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// The model of the ring damper without its contact and forces.
pub fn ring_damper() -> String {
    let files = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/jobs/ring_damper");
    let files = files.display();
    format!(
        "model.stiffness = '{files}/stiffness.mtx'\nmodel.mass = '{files}/mass.mtx'\n\
         model.coupling_stiffness = '{files}/coupling.mtx'\nmodel.rayleigh = [0.0, 1.5e-6]\n\
         model.sectors = 24\nmodel.engine_order = 2\n"
    )
}

/// Writes a job to an empty folder and runs a command on it; the folder holds what it wrote.
pub fn hbvib(verb: &str, (group, name): (&str, &str), job: &str) -> (Output, PathBuf) {
    let folder = empty_folder(group, name);
    let path = folder.join("job.toml");
    std::fs::write(&path, job).unwrap();
    let command = Command::new(env!("CARGO_BIN_EXE_hbvib")).arg(verb).arg(&path).output();
    (command.unwrap(), folder)
}

/// The folder of the repository.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Text that a program printed.
pub fn printed(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// An empty folder of a test.
pub fn empty_folder(group: &str, name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(group).join(name);
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

/// Runs the command in a folder.
pub fn command(arguments: &[&str], folder: &Path) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_hbvib"));
    command.args(arguments).current_dir(folder).output().unwrap()
}

/// Runs a program of others in a folder; returns what it printed.
pub fn run(program: impl AsRef<std::ffi::OsStr>, arguments: &[&str], folder: &Path) -> String {
    let mut command = Command::new(program);
    let output = command.args(arguments).current_dir(folder).output();
    let output = output.unwrap_or_else(|e| panic!("{command:?}: {e}; sh tests/run.sh installs what is needed"));
    let text = printed(&output.stdout);
    assert!(
        output.status.success(),
        "{command:?}: {text}{}",
        printed(&output.stderr)
    );
    text
}
