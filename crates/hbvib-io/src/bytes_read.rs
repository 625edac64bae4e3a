//! Numbers in bytes of either order, and whole binary files.

use crate::Result;
use crate::error::Error;
use std::path::Path;

/// Reads a whole file.
///
/// # Errors
/// The reason of the system.
pub(crate) fn whole_file(path: &Path) -> Result<Vec<u8>> {
    std::fs::read(path).map_err(|error| Error::new(path, 0, format_args!("cannot be read: {error}")))
}

/// An unsigned number of up to eight bytes.
pub(crate) fn unsigned(bytes: &[u8], little: bool) -> u64 {
    let add = |sum: u64, byte: &u8| (sum << 8) | u64::from(*byte);
    if little {
        bytes.iter().rev().fold(0, add)
    } else {
        bytes.iter().fold(0, add)
    }
}

/// A number of so many bytes at a place; `None` beyond the end.
pub(crate) fn at(bytes: &[u8], place: usize, size: usize, little: bool) -> Option<u64> {
    let end = place.checked_add(size)?;
    bytes.get(place..end).map(|part| unsigned(part, little))
}

/// Types of numbers in arrays.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    Signed(usize),
    Unsigned(usize),
    Real(usize),
    Complex(usize),
}

impl Kind {
    /// Bytes of a number.
    pub fn size(self) -> usize {
        match self {
            Self::Signed(size) | Self::Unsigned(size) | Self::Real(size) | Self::Complex(size) => size,
        }
    }

    /// A number from its bytes, real and imaginary part.
    pub fn value(self, bytes: &[u8], little: bool) -> (f64, f64) {
        let real = |bytes: &[u8]| {
            let bits = unsigned(bytes, little);
            if bytes.len() == 4 {
                f64::from(f32::from_bits(bits as u32))
            } else {
                f64::from_bits(bits)
            }
        };
        match self {
            Self::Real(_) => (real(bytes), 0.0),
            Self::Complex(size) => (real(&bytes[..size / 2]), real(&bytes[size / 2..])),
            Self::Signed(_) => (self.integer(bytes, little).unwrap_or(0) as f64, 0.0),
            Self::Unsigned(_) => (unsigned(bytes, little) as f64, 0.0),
        }
    }

    /// A whole number; `None` for others, and for those that a signed one cannot hold.
    pub fn integer(self, bytes: &[u8], little: bool) -> Option<i64> {
        let bits = unsigned(bytes, little);
        match self {
            Self::Unsigned(_) => i64::try_from(bits).ok(),
            Self::Signed(size) => {
                let unused = 64 - 8 * size as u32;
                Some((bits << unused).cast_signed() >> unused)
            }
            Self::Real(_) => {
                let (value, _) = self.value(bytes, little);
                (value.fract() == 0.0 && value.abs() < 9e15).then_some(value as i64)
            }
            Self::Complex(_) => None,
        }
    }
}
