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
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(group).join(name);
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    let path = folder.join("job.toml");
    std::fs::write(&path, job).unwrap();
    let command = Command::new(env!("CARGO_BIN_EXE_hbvib")).arg(verb).arg(&path).output();
    (command.unwrap(), folder)
}
