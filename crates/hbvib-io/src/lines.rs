//! The lines of a text file with their numbers; gzipped files are unpacked as they are read.

use crate::Result;
use crate::error::Error;
use flate2::read::MultiGzDecoder;
use std::fmt::Display;
use std::fs::File;
use std::io::{BufRead, BufReader, Read};
use std::path::{Path, PathBuf};

/// Longest accepted line in bytes; no format has longer ones.
const LONGEST: u64 = 1 << 16;

/// First bytes of a gzipped file.
const GZIP: [u8; 2] = [0x1f, 0x8b];

/// Mark that some editors put before UTF-8 text.
const BYTE_ORDER_MARK: [u8; 3] = [0xef, 0xbb, 0xbf];

/// The sign of a file that may be cut off within its last number. Programs end the last line of their files.
const CUT_NUMBER: &str = "the file ends with a number and without an end of its line: its last digits may be cut off";

/// Whether a number touches the end of a line that is no comment of Matrix Market, Abaqus or Nastran.
fn ends_with_a_number(line: &str) -> bool {
    let comment = line.trim_start().starts_with('%') || line.starts_with("**") || line.contains('$');
    !comment && line.ends_with(|c: char| c.is_ascii_digit() || c == '.')
}

/// A text file, read line by line.
pub(crate) struct Lines {
    path: PathBuf,
    reader: Box<dyn BufRead>,
    length: u64,
    number: usize,
    line: String,
    again: bool,
    /// The last line that was read has no end, and ends with a number.
    open_number: bool,
    /// The last line that was read has no end.
    unended: bool,
}

impl Lines {
    /// Opens a file.
    ///
    /// # Errors
    /// The reason of the system.
    pub fn open(path: &Path) -> Result<Self> {
        let failed = |error: std::io::Error| Error::new(path, 0, format_args!("cannot be read: {error}"));
        let mut file = BufReader::new(File::open(path).map_err(failed)?);
        let length = file.get_ref().metadata().map_err(failed)?.len();
        let gzipped = file.fill_buf().map_err(failed)?.starts_with(&GZIP);
        let reader: Box<dyn BufRead> = if gzipped {
            Box::new(BufReader::new(MultiGzDecoder::new(file)))
        } else {
            Box::new(file)
        };
        Ok(Self {
            path: path.to_owned(),
            reader,
            // Text of numbers shrinks to a third or less, seldom to a tenth.
            length: if gzipped { length.saturating_mul(16) } else { length },
            number: 0,
            line: String::new(),
            again: false,
            open_number: false,
            unended: false,
        })
    }

    /// Bytes of the file, of its text if it is gzipped.
    pub fn length(&self) -> usize {
        usize::try_from(self.length).unwrap_or(usize::MAX)
    }

    /// Reads the next line; `false` at the end.
    ///
    /// # Errors
    /// A line that is too long or is no text.
    pub fn advance(&mut self) -> Result<bool> {
        if core::mem::take(&mut self.again) {
            return Ok(true);
        }
        let mut bytes = core::mem::take(&mut self.line).into_bytes();
        bytes.clear();
        self.number += 1;
        let mut limited = (&mut self.reader).take(LONGEST);
        match limited.read_until(b'\n', &mut bytes) {
            Ok(0) => {
                self.number -= 1;
                return Ok(false);
            }
            Ok(count) if count as u64 == LONGEST => return self.fail("longer than 65536 characters"),
            Ok(_) => {}
            Err(error) => return self.fail(format_args!("cannot be read: {error}")),
        }
        self.unended = bytes.last() != Some(&b'\n');
        while matches!(bytes.last(), Some(b'\n' | b'\r')) {
            bytes.pop();
        }
        if self.number == 1 && bytes.starts_with(&BYTE_ORDER_MARK) {
            bytes.drain(..BYTE_ORDER_MARK.len());
        }
        match String::from_utf8(bytes) {
            Ok(line) if !line.contains(|c: char| c.is_control() && c != '\t') => {
                self.open_number = self.unended && ends_with_a_number(&line);
                self.line = line;
                Ok(true)
            }
            _ => self.fail("holds bytes that are no text"),
        }
    }

    /// Reads the next line, which must be there.
    ///
    /// # Errors
    /// As [`Self::advance`], and for the end of the file.
    pub fn expect(&mut self, needed: &str) -> Result<()> {
        if self.advance()? {
            return Ok(());
        }
        self.number += 1;
        self.fail(format_args!("the file ends where {needed} is needed"))
    }

    /// Lets [`Self::advance`] return the present line once more.
    pub fn repeat(&mut self) {
        self.again = true;
    }

    /// The present line.
    pub fn text(&self) -> &str {
        &self.line
    }

    /// Whether the present line is the last of a file that does not end it.
    pub fn is_unended(&self) -> bool {
        self.unended
    }

    /// Refuses a file of a format that does not count its numbers where [`Self::cut_number`] has a sentence: nothing tells a whole
    /// file from one that is cut off.
    ///
    /// # Errors
    /// The line and reason.
    pub fn refuse_cut_number(&self) -> Result<()> {
        if self.open_number {
            return self.fail(format_args!("{CUT_NUMBER}; end the line if the file is whole"));
        }
        Ok(())
    }

    /// A sentence about a file whose last number may lack digits: the file ends with it, without the end of the line.
    pub fn cut_number(&self) -> Option<String> {
        self.open_number.then(|| {
            format!(
                "{}, line {}: {CUT_NUMBER}; end the line if the file is whole",
                self.path.display(),
                self.number
            )
        })
    }

    /// Number of the present line, from 1.
    pub fn number(&self) -> usize {
        self.number
    }

    /// An error at a line that was read before.
    ///
    /// # Errors
    /// Always.
    pub fn fail_at<T>(&self, line: usize, reason: impl Display) -> Result<T> {
        Err(Error::new(&self.path, line, reason))
    }

    /// An error at the present line.
    ///
    /// # Errors
    /// Always.
    pub fn fail<T>(&self, reason: impl Display) -> Result<T> {
        Err(Error::new(&self.path, self.number, reason))
    }
}
