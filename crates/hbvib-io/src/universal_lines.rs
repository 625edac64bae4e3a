//! The lines and bytes of a universal file, with numbers that may touch each other.

use crate::Result;
use crate::bytes_read::whole_file;
use crate::error::Error;
use std::fmt::Display;
use std::path::{Path, PathBuf};

/// A file and the place that is reached.
pub(crate) struct UniversalLines {
    path: PathBuf,
    bytes: Vec<u8>,
    at: usize,
    number: usize,
}

/// The mark before and after a data set.
pub(crate) const MARK: &str = "-1";

impl UniversalLines {
    pub fn open(path: &Path) -> Result<Self> {
        Ok(Self {
            path: path.to_owned(),
            bytes: whole_file(path)?,
            at: 0,
            number: 0,
        })
    }

    /// Bytes of the file.
    pub fn length(&self) -> usize {
        self.bytes.len()
    }

    /// The next line; `None` at the end.
    pub fn next(&mut self) -> Option<String> {
        let rest = self.bytes.get(self.at..).filter(|rest| !rest.is_empty())?;
        let length = rest.iter().position(|byte| *byte == b'\n').unwrap_or(rest.len());
        let line = String::from_utf8_lossy(&rest[..length]);
        let line = line.trim_end_matches('\r').to_owned();
        self.at += length + 1;
        self.number += 1;
        Some(line)
    }

    /// The next line, which must be there and must not be the end of the data set.
    ///
    /// # Errors
    /// The end of the file or of the data set.
    pub fn expect(&mut self, needed: &str) -> Result<String> {
        match self.next() {
            Some(line) if line.trim() != MARK => Ok(line),
            _ => self.fail(format_args!("the data set ends where {needed} is needed")),
        }
    }

    /// The next line of a list, `None` at the end of the data set.
    ///
    /// # Errors
    /// The end of the file.
    pub fn item(&mut self) -> Result<Option<String>> {
        match self.next() {
            Some(line) if line.trim() == MARK => Ok(None),
            Some(line) => Ok(Some(line)),
            None => self.fail("the file ends within a data set, needs a line with -1"),
        }
    }

    /// So many bytes after the present line, and moves to the line after them.
    ///
    /// # Errors
    /// The end of the file.
    pub fn take_bytes(&mut self, count: usize) -> Result<Vec<u8>> {
        let end = self.at.saturating_add(count);
        let Some(bytes) = self.bytes.get(self.at..end) else {
            return self.fail(format_args!(
                "{count} bytes are announced, and the file ends before them"
            ));
        };
        let bytes = bytes.to_vec();
        self.at = end;
        if self.bytes.get(end) == Some(&b'\r') {
            self.at += 1;
        }
        if self.bytes.get(self.at) == Some(&b'\n') {
            self.at += 1;
        }
        Ok(bytes)
    }

    /// Whether the end of a data set follows so many bytes.
    pub fn mark_follows(&self, count: usize) -> bool {
        let rest = self.bytes.get(self.at.saturating_add(count)..).unwrap_or(&[]);
        let start = &rest[..rest.len().min(16)];
        let text = start.trim_ascii_start();
        text.starts_with(MARK.as_bytes()) && text.get(MARK.len()).is_none_or(u8::is_ascii_whitespace)
    }

    /// So many numbers on as many lines as they need.
    ///
    /// # Errors
    /// The line: no number, or more numbers than needed; the end of the data set.
    pub fn reals(&mut self, count: usize, what: &str) -> Result<Vec<f64>> {
        // A number takes at least two bytes.
        if count > self.length() {
            return self.fail(format_args!("{count} {what} in a file of {} bytes", self.length()));
        }
        let mut all = Vec::new();
        while all.len() < count {
            let line = self.expect(what)?;
            for word in words(&line) {
                let plain = word.replace(['D', 'd'], "e");
                match plain.parse::<f64>() {
                    Ok(value) if value.is_finite() => all.push(value),
                    _ => return self.fail(format_args!("{word:?} needs to be a finite number")),
                }
            }
        }
        if all.len() > count {
            return self.fail(format_args!("more numbers than {count} {what}"));
        }
        Ok(all)
    }

    /// So many whole numbers on as many lines as they need.
    ///
    /// # Errors
    /// As [`Self::reals`].
    pub fn integers(&mut self, count: usize, what: &str) -> Result<Vec<i64>> {
        let mut all = Vec::new();
        while all.len() < count {
            let line = self.expect(what)?;
            all.extend(self.of_line(&line, what)?);
        }
        if all.len() > count {
            return self.fail(format_args!("more numbers than {count} {what}"));
        }
        Ok(all)
    }

    /// The whole numbers of a line.
    ///
    /// # Errors
    /// The line: no whole number.
    pub fn of_line(&self, line: &str, what: &str) -> Result<Vec<i64>> {
        let mut all = Vec::new();
        for word in line.split_whitespace() {
            match word.parse() {
                Ok(number) => all.push(number),
                Err(_) => return self.fail(format_args!("{what}: {word:?} needs to be a whole number")),
            }
        }
        Ok(all)
    }

    /// An error at the present line.
    ///
    /// # Errors
    /// Always.
    pub fn fail<T>(&self, reason: impl Display) -> Result<T> {
        Err(Error::new(
            &self.path,
            self.number,
            format_args!("universal file: {reason}"),
        ))
    }
}

/// The numbers of a line: a sign that does not follow the letter of an exponent begins one.
fn words(line: &str) -> Vec<&str> {
    let mut all = Vec::new();
    for word in line.split_whitespace() {
        let bytes = word.as_bytes();
        let mut start = 0;
        for i in 1..bytes.len() {
            let sign = matches!(bytes[i], b'+' | b'-');
            if sign && word.is_char_boundary(i) && !bytes[i - 1].is_ascii_alphabetic() {
                all.push(&word[start..i]);
                start = i;
            }
        }
        all.push(&word[start..]);
    }
    all
}
