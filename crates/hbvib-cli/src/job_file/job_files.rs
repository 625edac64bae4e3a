//! Files that a job names: none is written over one that it reads, nor over another one that it writes.

use std::path::{Path, PathBuf};
use toml::{Table, Value};

/// Keys of files that are written, and ends of such keys.
const WRITTEN: [&str; 9] = ["csv", "npz", "figure", "vtu", "uff", "netcdf", "frd", "report", "json"];

/// A path in a job: its key with those of its tables, the value, and the file that it names.
struct Named {
    key: String,
    value: String,
    file: PathBuf,
    is_written: bool,
}

/// Refuses a job that writes a file over one that it reads, or over another that it writes. `path` is that of the job.
///
/// # Errors
/// A sentence that names both keys.
pub fn check_files(text: &str, path: &Path, folder: &Path) -> Result<(), String> {
    let Ok(table) = text.parse::<Table>() else {
        return Ok(());
    };
    let mut named = vec![Named {
        key: "the job itself".to_owned(),
        value: path.display().to_string(),
        file: place(path),
        is_written: false,
    }];
    collect("", &Value::Table(table), folder, &mut named);
    for (i, out) in named.iter().enumerate().filter(|(_, one)| one.is_written) {
        for other in named[..i]
            .iter()
            .chain(named[i + 1..].iter().filter(|one| !one.is_written))
        {
            let may_continue = other.key == "restart.from" && out.key == "output.npz";
            if other.file == out.file && !may_continue {
                let does = if other.is_written { "written" } else { "read" };
                return Err(format!(
                    "{} = {:?} would replace a file that is {does} by {}; name another file",
                    out.key, out.value, other.key
                ));
            }
        }
    }
    Ok(())
}

/// Adds the paths of a value: those that are written, and those of files that are there.
fn collect(key: &str, value: &Value, folder: &Path, named: &mut Vec<Named>) {
    let of = |name: &str| {
        if key.is_empty() {
            name.to_owned()
        } else {
            format!("{key}.{name}")
        }
    };
    match value {
        Value::Table(table) => table
            .iter()
            .for_each(|(name, value)| collect(&of(name), value, folder, named)),
        Value::Array(all) => all.iter().for_each(|value| collect(key, value, folder, named)),
        Value::String(text) => {
            let own = key.rsplit('.').next().unwrap_or(key);
            let ends = |name: &&str| own == *name || own.strip_suffix(name).is_some_and(|rest| rest.ends_with('_'));
            // The places of sliders from which a job begins.
            let is_written = WRITTEN.iter().any(ends) && key != "residual.npz";
            let file = folder.join(text);
            if is_written || file.is_file() {
                named.push(Named {
                    key: key.to_owned(),
                    value: text.clone(),
                    file: place(&file),
                    is_written,
                });
            }
        }
        _ => {}
    }
}

/// The file that a path names: a link is followed, and a folder written in another way is the same.
fn place(path: &Path) -> PathBuf {
    if let Ok(place) = path.canonicalize() {
        return place;
    }
    let folder = path.parent().map(|folder| {
        if folder.as_os_str().is_empty() {
            Path::new(".")
        } else {
            folder
        }
    });
    match (folder.and_then(|folder| folder.canonicalize().ok()), path.file_name()) {
        (Some(folder), Some(name)) => folder.join(name),
        _ => path
            .components()
            .filter(|part| *part != std::path::Component::CurDir)
            .collect(),
    }
}
