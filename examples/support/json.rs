//! JSON files whose numbers have 17 significant digits, written completely or not at all.
#![allow(dead_code, reason = "each example uses a part of this module")]

use std::error::Error;
use std::ffi::OsString;
use std::fs::{self, File};
use std::io::{self, BufWriter, ErrorKind, Write};
use std::path::{Path, PathBuf};

use serde_json::{Number, Value};

/// A finite number; JSON has no others.
///
/// # Errors
///
/// If the number is not finite.
pub fn number(value: f64) -> Result<Value, Box<dyn Error>> {
    let number = Number::from_f64(value).ok_or_else(|| format!("{value} cannot be written as JSON"))?;
    Ok(Value::Number(number))
}

/// Writes a value as `serde_json` does, but floating-point numbers with 17 significant digits: they can be read
/// back exactly, and every number shows its precision.
fn write_value(writer: &mut impl Write, value: &Value) -> io::Result<()> {
    match value {
        Value::Number(number) if number.is_f64() => match number.as_f64() {
            Some(number) => write!(writer, "{number:.16e}"),
            None => Err(ErrorKind::InvalidData.into()),
        },
        Value::Array(values) => {
            write!(writer, "[")?;
            for (i, value) in values.iter().enumerate() {
                write!(writer, "{}", if i > 0 { "," } else { "" })?;
                write_value(writer, value)?;
            }
            write!(writer, "]")
        }
        Value::Object(values) => {
            write!(writer, "{{")?;
            for (i, (name, value)) in values.iter().enumerate() {
                write!(
                    writer,
                    "{}{}:",
                    if i > 0 { "," } else { "" },
                    Value::from(name.as_str())
                )?;
                write_value(writer, value)?;
            }
            write!(writer, "}}")
        }
        other => write!(writer, "{other}"),
    }
}

/// Writes a value and a line end to a file. A regular file is replaced in one step once the text is complete, so
/// that a failure leaves the previous file, or none.
///
/// # Errors
///
/// If the file cannot be written.
pub fn write_json(path: &Path, value: &Value) -> Result<(), Box<dyn Error>> {
    let failed = |e: io::Error| format!("{} cannot be written: {e}", path.display());
    match fs::metadata(path) {
        // A pipe or device receives the text itself; a file in its place would destroy it.
        Ok(there) if !there.is_file() => {
            let file = File::options().write(true).open(path).map_err(failed)?;
            write_text(file, value).map_err(failed)?;
            Ok(())
        }
        // A symbolic link is kept; the file to which it points is replaced.
        Ok(_) => Ok(replace(&fs::canonicalize(path).map_err(failed)?, value).map_err(failed)?),
        Err(e) if e.kind() == ErrorKind::NotFound => Ok(replace(path, value).map_err(failed)?),
        Err(e) => Err(failed(e).into()),
    }
}

fn write_text(file: File, value: &Value) -> io::Result<File> {
    let mut writer = BufWriter::new(file);
    write_value(&mut writer, value)?;
    writeln!(writer)?;
    writer.into_inner().map_err(io::IntoInnerError::into_error)
}

fn replace(path: &Path, value: &Value) -> io::Result<()> {
    let name = path.file_name().ok_or(ErrorKind::InvalidInput)?;
    let mut temporary = OsString::from(".");
    temporary.push(name);
    temporary.push(format!(".{}.part", std::process::id()));
    let temporary: PathBuf = path.with_file_name(temporary);
    let file = File::options().write(true).create_new(true).open(&temporary)?;
    let done = write_text(file, value)
        .and_then(|file| file.sync_all())
        .and_then(|()| fs::rename(&temporary, path));
    if done.is_err() {
        // The first failure is reported.
        let _ = fs::remove_file(&temporary);
    }
    done
}
