//! Runs of CalculiX.

use crate::texts::outcome::Outcome;
use std::fs;
use std::io::ErrorKind;
use std::path::Path;
use std::process::Command;

/// Has CalculiX make a file from a deck, unless the file is there and the deck is the same; tells whether it was run.
///
/// # Errors
/// A sentence: the program is missing, or says that it failed.
pub fn made(program: &str, (deck, text): (&Path, &str), wanted: &Path) -> Outcome<bool> {
    if wanted.is_file() && fs::read_to_string(deck).is_ok_and(|there| there == text) {
        return Ok(false);
    }
    let _ = fs::remove_file(wanted);
    fs::write(deck, text).map_err(|e| format!("{}: cannot be written: {e}", deck.display()))?;
    let job = deck.file_stem().unwrap_or_default().to_string_lossy();
    let folder = deck.parent().filter(|folder| !folder.as_os_str().is_empty());
    let output = Command::new(program)
        .arg(&*job)
        .current_dir(folder.unwrap_or(Path::new(".")))
        .output();
    let output = output.map_err(|e| match e.kind() {
        ErrorKind::NotFound => format!(
            "{program} is not found (CalculiX; Debian: apt-get install calculix-ccx; --ccx names it): wrote {}; make {} with another \
             computer or program and run this command again",
            deck.display(),
            wanted.display()
        ),
        _ => format!("{program}: {e}"),
    })?;
    if !output.status.success() || !wanted.is_file() {
        let said = String::from_utf8_lossy(&output.stdout);
        let reasons: Vec<&str> = said
            .lines()
            .filter(|line| line.to_ascii_uppercase().contains("ERROR"))
            .collect();
        // A file of a failed run is none that is there.
        let _ = fs::remove_file(wanted);
        return Err(format!(
            "{program} {job} made no {}: {}",
            wanted.display(),
            reasons.join("; ")
        ));
    }
    Ok(true)
}
