//! Errors: a sentence with file, line and reason.

use std::fmt;
use std::path::Path;

/// Reason why a file was not read.
#[derive(Debug)]
pub struct Error {
    sentence: String,
}

impl Error {
    pub(crate) fn new(path: &Path, line: usize, reason: impl fmt::Display) -> Self {
        let path = path.display();
        Self {
            sentence: match line {
                0 => format!("{path}: {reason}"),
                line => format!("{path}, line {line}: {reason}"),
            },
        }
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.sentence)
    }
}

impl std::error::Error for Error {}
