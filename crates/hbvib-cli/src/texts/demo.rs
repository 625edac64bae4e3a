//! The command `demo`: a small job with its matrices, written, run and shown.

use crate::texts::outcome::Outcome;
use crate::{print, run_job};
use std::fs;
use std::io::ErrorKind;
use std::path::Path;
use std::process::{Command, Stdio};

/// The files, the job first.
const FILES: [(&str, &str); 4] = [
    ("job.toml", include_str!("demo/job.toml")),
    (
        "stiffness.mtx",
        include_str!("../../../../examples/jobs/ring_damper/stiffness.mtx"),
    ),
    (
        "mass.mtx",
        include_str!("../../../../examples/jobs/ring_damper/mass.mtx"),
    ),
    (
        "coupling.mtx",
        include_str!("../../../../examples/jobs/ring_damper/coupling.mtx"),
    ),
];

/// Writes the files into a new folder, made with the folders above it, runs the job, and opens its report where that is asked for;
/// returns the exit code.
///
/// # Errors
/// A sentence where the folder is there already or cannot be written.
pub fn demo(folder: &Path, open: bool) -> Outcome<u8> {
    let place = folder.display();
    if let Some(above) = folder.parent() {
        fs::create_dir_all(above).map_err(|e| format!("{}: no folder can be made there: {e}", above.display()))?;
    }
    fs::create_dir(folder).map_err(|e| match e.kind() {
        ErrorKind::AlreadyExists => {
            format!("{place} is there already, and a demo overwrites nothing: name another folder")
        }
        _ => format!("{place}: no folder can be made there: {e}"),
    })?;
    for (name, text) in FILES {
        fs::write(folder.join(name), text).map_err(|e| format!("{}: {e}", folder.join(name).display()))?;
    }
    let code = run_job::run(&folder.join(FILES[0].0), false)?;
    let report = folder.join("report.html");
    print(&format!(
        "\n{} has figures and tables; hbvib run {} runs the job again\n",
        report.display(),
        folder.join(FILES[0].0).display()
    ))?;
    if open {
        shown(&report)?;
    }
    Ok(code)
}

/// Opens a page with the program that the desktop has for it.
fn shown(page: &Path) -> Outcome<()> {
    let program = if cfg!(target_os = "macos") {
        "open"
    } else if cfg!(windows) {
        "explorer"
    } else {
        "xdg-open"
    };
    let mut command = Command::new(program);
    command
        .arg(page)
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null());
    command
        .spawn()
        .map(drop)
        .map_err(|e| format!("{program} {}: {e}; the report is there all the same", page.display()))
}
