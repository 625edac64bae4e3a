//! Files that the command writes. Each is written under a temporary name beside its own and then renamed, so that a file is
//! whole or not there; one that fails costs no other.

use crate::job_file::job::Job;
use crate::texts::events;
use crate::texts::outcome::Outcome;
use std::fmt::Write as _;
use std::fs::{self, File};
use std::io::{self, Write};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};

/// Files of a job: what was written, and what was not.
pub struct Files<'a> {
    job: &'a Job,
    told: usize,
    written: Vec<PathBuf>,
    failures: Vec<String>,
}

impl<'a> Files<'a> {
    /// None yet.
    pub fn of(job: &'a Job) -> Self {
        Self {
            job,
            told: 0,
            written: Vec::new(),
            failures: Vec::new(),
        }
    }

    /// Writes a file that the job names, relative to its folder; folders that are not there are made. Returns whether it was
    /// written. A failure is told at once, and kept.
    pub fn write(&mut self, path: Option<&Path>, write: &dyn Fn(&Path) -> Outcome<()>) -> bool {
        let Some(path) = path else { return false };
        let path = self.job.path(path);
        match save(&path, write) {
            Ok(()) => {
                events::wrote(&path);
                self.written.push(path);
                true
            }
            Err(e) => {
                self.fail(format!("{}: cannot be written: {e}", path.display()));
                false
            }
        }
    }

    /// Writes a file of a series, whose list is named instead of each of them.
    pub fn write_part(&mut self, path: &Path, write: &dyn Fn(&Path) -> Outcome<()>) {
        let count = self.written.len();
        self.write(Some(path), write);
        self.written.truncate(count);
    }

    /// Tells an output that could not be made.
    pub fn fail(&mut self, sentence: String) {
        events::error(&sentence);
        self.failures.push(sentence);
    }

    /// Prints text and the names of the files that were written since the last call.
    pub fn tell(&mut self, text: &str) {
        let mut all = text.to_owned();
        for path in &self.written[self.told..] {
            let _ = writeln!(all, "wrote {}", path.display());
        }
        self.told = self.written.len();
        if let Err(e) = io::stdout().write_all(all.as_bytes()) {
            // A reader that is gone, as of `hbvib run | head`, costs no file.
            if !self.failures.iter().any(|f| f.starts_with(STANDARD_OUTPUT)) {
                self.fail(format!("{STANDARD_OUTPUT}: {e}"));
            }
        }
    }

    /// Whether all outputs were made.
    pub fn complete(&self) -> bool {
        self.failures.is_empty()
    }
}

const STANDARD_OUTPUT: &str = "standard output";

/// Writes a file under a temporary name, which keeps the extension, and renames it.
///
/// # Errors
/// A sentence; the file that was there before is then unchanged.
fn save(path: &Path, write: &dyn Fn(&Path) -> Outcome<()>) -> Outcome<()> {
    if let Some(folder) = path.parent() {
        fs::create_dir_all(folder).map_err(|e| format!("{}: cannot be made: {e}", folder.display()))?;
    }
    // A pipe or a device is written as it is, and a link is followed.
    let place = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    if fs::metadata(&place).is_ok_and(|found| !found.is_file()) {
        return guarded(&place, write);
    }
    let temporary = temporary_name(&place)?;
    let outcome = guarded(&temporary, write)
        .and_then(|()| {
            File::open(&temporary)
                .and_then(|file| file.sync_all())
                .map_err(|e| e.to_string())
        })
        .and_then(|()| fs::rename(&temporary, &place).map_err(|e| e.to_string()));
    if outcome.is_err() {
        let _ = fs::remove_file(&temporary);
    }
    outcome
}

/// A panic, as of the library that draws, costs the file alone.
fn guarded(path: &Path, write: &dyn Fn(&Path) -> Outcome<()>) -> Outcome<()> {
    catch_unwind(AssertUnwindSafe(|| write(path))).unwrap_or_else(|_| Err("internal error".into()))
}

fn temporary_name(path: &Path) -> Outcome<PathBuf> {
    let name = path.file_stem().ok_or("names no file")?.to_string_lossy();
    let extension = path
        .extension()
        .map_or(String::new(), |e| format!(".{}", e.to_string_lossy()));
    Ok(path.with_file_name(format!(".{name}.{}.part{extension}", std::process::id())))
}

#[cfg(test)]
mod tests {
    use super::{save, temporary_name};
    use std::fs;
    use std::path::Path;

    #[test]
    fn a_file_that_fails_leaves_the_old_one_and_nothing_else() {
        let folder = std::env::temp_dir().join(format!("hbvib_save_{}", std::process::id()));
        let path = folder.join("new/one.svg");
        save(&path, &|path| fs::write(path, "first").map_err(|e| e.to_string())).unwrap();
        let broken = |path: &Path| -> Result<(), String> {
            assert_eq!(path.extension(), Some("svg".as_ref()));
            fs::write(path, "half").map_err(|e| e.to_string())?;
            Err("no room".into())
        };
        assert_eq!(save(&path, &broken), Err("no room".into()));
        assert_eq!(fs::read_to_string(&path).unwrap(), "first");
        assert_eq!(fs::read_dir(folder.join("new")).unwrap().count(), 1);
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn a_temporary_name_keeps_folder_and_extension() {
        let name = temporary_name(Path::new("a/b.c/d")).unwrap();
        assert!(name.starts_with("a/b.c") && name.extension() == Some("part".as_ref()));
        assert!(temporary_name(Path::new("..")).is_err());
    }
}
