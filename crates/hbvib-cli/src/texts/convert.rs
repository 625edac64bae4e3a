//! The verb `convert`: matrix files between formats.

use crate::print;
use crate::texts::arguments::ConvertArguments;
use crate::texts::events;
use crate::texts::outcome::Outcome;
use hbvib_io::{Files, Format};
use std::fmt::Write;

/// Reads the files and writes them in another format.
///
/// # Errors
/// A sentence.
pub fn convert(of: &ConvertArguments) -> Outcome<u8> {
    let format = format_of(of.format.as_deref(), &of.output)?;
    let found = hbvib_io::read_files(&Files {
        matrices: of.matrices.as_deref(),
        stiffness: of.stiffness.as_deref(),
        mass: of.mass.as_deref(),
        damping: of.damping.as_deref(),
        structural: of.structural.as_deref(),
    })
    .map_err(|e| e.to_string())?;
    let report = hbvib_io::report(&found);
    for warning in &report.warnings {
        events::warning(warning);
    }
    if of.output.exists() && !of.overwrite {
        return Err(format!("{} is there: --overwrite replaces it", of.output.display()));
    }
    let written = hbvib_io::write(&of.output, &found, format).map_err(|e| e.to_string())?;
    let mut text = String::new();
    for fact in &report.facts {
        let _ = writeln!(text, "{fact}");
    }
    for path in written {
        events::wrote(&path);
        let _ = writeln!(text, "wrote {}", path.display());
    }
    print(&text)?;
    Ok(0)
}

/// The format of a name, or that of the file.
///
/// # Errors
/// A sentence with the formats that are known.
pub fn format_of(name: Option<&str>, path: &std::path::Path) -> Outcome<Format> {
    let known = || Format::NAMES.map(|(name, _)| name).join(", ");
    match name {
        Some(name) => {
            let found = Format::NAMES.into_iter().find(|(known, _)| *known == name);
            found
                .map(|(_, format)| format)
                .ok_or_else(|| format!("--format {name} is none of {}", known()))
        }
        None => Format::of_path(path).ok_or_else(|| {
            format!(
                "{}: the name tells no format; --format is one of {}",
                path.display(),
                known()
            )
        }),
    }
}
