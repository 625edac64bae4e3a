//! A locale with a decimal comma, for programs that must not mind it.

use std::path::{Path, PathBuf};
use std::process::Command;

/// Name of the locale.
pub const NAME: &str = "de_DE.UTF-8";

/// Makes the locale in a folder; the loader of locales finds it there by the variable `LOCPATH`.
pub fn locale(folder: &Path) -> PathBuf {
    let path = folder.join("locales");
    std::fs::create_dir_all(&path).unwrap();
    let made = Command::new("localedef")
        .args(["--no-archive", "-i", "de_DE", "-f", "UTF-8"])
        .arg(path.join(NAME))
        .output()
        .unwrap_or_else(|e| panic!("localedef: {e} (Debian: apt-get install locales)"));
    let complaint = String::from_utf8_lossy(&made.stderr);
    assert!(
        path.join(NAME).join("LC_NUMERIC").exists(),
        "{complaint} (Debian: apt-get install locales)"
    );
    path
}
