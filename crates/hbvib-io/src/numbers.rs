//! Numbers in text, as Fortran and C write them.

use crate::Result;
use crate::lines::Lines;

/// A whole number.
///
/// # Errors
/// Names the word and `what` it should be.
pub(crate) fn whole(lines: &Lines, word: Option<&str>, what: &str) -> Result<i64> {
    let Some(word) = word.map(str::trim).filter(|word| !word.is_empty()) else {
        return lines.fail(format_args!("{what} is missing"));
    };
    match word.parse() {
        Ok(value) => Ok(value),
        Err(_) => lines.fail(format_args!("{what} is {word:?}, needs a whole number")),
    }
}

/// A count or size, at least 0.
///
/// # Errors
/// As [`whole`].
pub(crate) fn count(lines: &Lines, word: Option<&str>, what: &str) -> Result<usize> {
    let value = whole(lines, word, what)?;
    match usize::try_from(value) {
        Ok(value) => Ok(value),
        Err(_) => lines.fail(format_args!("{what} = {value}, needs a number >= 0")),
    }
}

/// An index from 1 to `size`, returned from 0.
///
/// # Errors
/// As [`whole`].
pub(crate) fn index(lines: &Lines, word: Option<&str>, size: usize, what: &str) -> Result<u32> {
    let value = whole(lines, word, what)?;
    match usize::try_from(value) {
        Ok(value) if (1..=size).contains(&value) => Ok((value - 1) as u32),
        _ => lines.fail(format_args!("{what} = {value}, needs 1 .. {size}")),
    }
}

/// A finite real number; Fortran's exponents D and Q, and exponents without a letter, are read.
///
/// # Errors
/// Names the word and `what` it should be.
pub(crate) fn real(lines: &Lines, word: Option<&str>, what: &str) -> Result<f64> {
    let Some(word) = word.map(str::trim).filter(|word| !word.is_empty()) else {
        return lines.fail(format_args!("{what} is missing"));
    };
    match parsed(word) {
        Some(value) if value.is_finite() => Ok(value),
        Some(value) => lines.fail(format_args!("{what} is {value}, needs a finite number")),
        None => lines.fail(format_args!("{what} is {word:?}, needs a number")),
    }
}

fn parsed(word: &str) -> Option<f64> {
    if let Ok(value) = word.parse() {
        return Some(value);
    }
    // 1.5D+03, 1.5Q3 and 1.5+103.
    let mut plain = [0_u8; 64];
    let mut length = 0;
    let mut push = |byte: u8| {
        plain.get_mut(length).map(|place| {
            *place = byte;
            length += 1;
        })
    };
    let mut exponent = false;
    let bytes = word.as_bytes();
    for (i, &byte) in bytes.iter().enumerate() {
        match byte {
            b'D' | b'd' | b'Q' | b'q' if !exponent => {
                exponent = true;
                push(b'e')?;
            }
            b'E' | b'e' => {
                exponent = true;
                push(byte)?;
            }
            b'+' | b'-' if i > 0 && !exponent && (bytes[i - 1].is_ascii_digit() || bytes[i - 1] == b'.') => {
                exponent = true;
                push(b'e')?;
                push(byte)?;
            }
            _ => push(byte)?,
        }
    }
    core::str::from_utf8(&plain[..length]).ok()?.parse().ok()
}
