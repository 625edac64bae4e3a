//! Tables of numbers as comma-separated values.
#![allow(dead_code, reason = "each example uses a part of this module")]

use std::error::Error;
use std::fs;
use std::io::{BufWriter, Write};
use std::path::Path;

/// Writes a header line and one line per row, each number with 17 significant digits, so that it can be read back
/// exactly. The folder is created if it is missing.
///
/// # Errors
///
/// If a row does not have the number of columns of the header, or the file cannot be written.
pub fn write_csv(path: impl AsRef<Path>, header: &[&str], rows: &[Vec<f64>]) -> Result<(), Box<dyn Error>> {
    let path = path.as_ref();
    if let Some(row) = rows.iter().position(|row| row.len() != header.len()) {
        return Err(format!("row {row} of {} does not match the header", path.display()).into());
    }
    if let Some(folder) = path.parent() {
        fs::create_dir_all(folder)?;
    }
    let mut file = BufWriter::new(fs::File::create(path)?);
    writeln!(file, "{}", header.join(","))?;
    for row in rows {
        let cells: Vec<String> = row.iter().map(|value| format!("{value:.16e}")).collect();
        writeln!(file, "{}", cells.join(","))?;
    }
    Ok(file.flush()?)
}
