//! Numbers as bytes, little-endian: a writer that counts what does not fit, and a reader that never reads beyond its
//! bytes and lets nothing be allocated that they cannot fill.

use crate::error::{Error, Result, Status, fail};

/// Writes into a buffer. Bytes that do not fit are counted, not written.
pub struct ByteWriter<'a> {
    out: &'a mut [u8],
    at: usize,
    /// The digest of the bytes that were written, where it is wanted.
    digest: Option<u64>,
}

/// An odd number without pattern: 2⁶⁴ over the golden ratio (Knuth, The Art of Computer Programming 3, 6.4).
/// Kind: fixed.
const BYTE_STREAM_GOLDEN: u64 = 0x9E37_79B9_7F4A_7C15;

impl<'a> ByteWriter<'a> {
    /// A writer from the begin of a buffer.
    pub fn new(out: &'a mut [u8]) -> Self {
        Self {
            out,
            at: 0,
            digest: None,
        }
    }

    /// A writer that keeps a digest of what is written instead of the bytes.
    pub fn digesting() -> Self {
        Self {
            out: &mut [],
            at: 0,
            digest: Some(0),
        }
    }

    /// The digest: equal for equal bytes, and by chance alone for others. It is not safe against those who seek them.
    pub fn digest(&self) -> u64 {
        self.digest.unwrap_or(0)
    }

    /// Bytes written or counted.
    pub fn position(&self) -> usize {
        self.at
    }

    /// Appends bytes.
    pub fn bytes(&mut self, bytes: &[u8]) {
        let end = self.at.saturating_add(bytes.len());
        if let Some(place) = self.out.get_mut(self.at..end) {
            place.copy_from_slice(bytes);
        }
        self.at = end;
        if let Some(digest) = &mut self.digest {
            for chunk in bytes.chunks(8) {
                let mut eight = [0; 8];
                eight[..chunk.len()].copy_from_slice(chunk);
                let mixed = (*digest ^ u64::from_le_bytes(eight)).wrapping_mul(BYTE_STREAM_GOLDEN);
                *digest = (mixed ^ (mixed >> 29)).wrapping_add(chunk.len() as u64);
            }
        }
    }

    /// Appends one byte.
    pub fn u8(&mut self, value: u8) {
        self.bytes(&[value]);
    }

    /// Appends a truth value.
    pub fn bool(&mut self, value: bool) {
        self.u8(value.into());
    }

    /// Appends a number of 32 bits.
    pub fn u32(&mut self, value: u32) {
        self.bytes(&value.to_le_bytes());
    }

    /// Appends a signed number of 64 bits.
    pub fn i64(&mut self, value: i64) {
        self.bytes(&value.to_le_bytes());
    }

    /// Appends a count or index.
    pub fn count(&mut self, value: usize) {
        self.bytes(&(value as u64).to_le_bytes());
    }

    /// Appends a count or index that may be missing.
    pub fn optional(&mut self, value: Option<usize>) {
        self.i64(value.map_or(-1, |value| value as i64));
    }

    /// Appends the bits of a number.
    pub fn f64(&mut self, value: f64) {
        self.bytes(&value.to_bits().to_le_bytes());
    }
}

/// Reads what a [`ByteWriter`] wrote.
#[derive(Clone, Copy, Debug)]
pub struct ByteReader<'a> {
    left: &'a [u8],
    length: usize,
}

impl<'a> ByteReader<'a> {
    /// A reader from the begin of some bytes.
    #[must_use]
    pub fn new(bytes: &'a [u8]) -> Self {
        Self {
            left: bytes,
            length: bytes.len(),
        }
    }

    /// Number of bytes read.
    pub fn position(&self) -> usize {
        self.length - self.left.len()
    }

    /// Bytes that are left.
    pub fn left(&self) -> usize {
        self.left.len()
    }

    /// The error of an entry that cannot have been written.
    pub fn damaged(&self, what: &str) -> Error {
        Error::new(
            Status::Argument,
            format_args!("damaged before byte {}: {what}", self.position()),
        )
    }

    /// The next bytes.
    ///
    /// # Errors
    /// `Argument` where they end before.
    pub fn bytes(&mut self, count: usize) -> Result<&'a [u8]> {
        match self.left.split_at_checked(count) {
            Some((head, rest)) => {
                self.left = rest;
                Ok(head)
            }
            None => fail!(
                Argument,
                "damaged: {count} bytes are needed at byte {}, but {} are left",
                self.position(),
                self.left.len()
            ),
        }
    }

    fn array<const N: usize>(&mut self) -> Result<[u8; N]> {
        let mut array = [0; N];
        array.copy_from_slice(self.bytes(N)?);
        Ok(array)
    }

    /// The next byte.
    ///
    /// # Errors
    /// As [`Self::bytes`].
    pub fn u8(&mut self) -> Result<u8> {
        Ok(self.array::<1>()?[0])
    }

    /// A truth value.
    ///
    /// # Errors
    /// As [`Self::bytes`]; `Argument` for a byte that is neither 0 nor 1.
    pub fn bool(&mut self) -> Result<bool> {
        match self.u8()? {
            0 => Ok(false),
            1 => Ok(true),
            _ => Err(self.damaged("a truth value is neither 0 nor 1")),
        }
    }

    /// A number of 32 bits.
    ///
    /// # Errors
    /// As [`Self::bytes`].
    pub fn u32(&mut self) -> Result<u32> {
        Ok(u32::from_le_bytes(self.array()?))
    }

    /// A signed number of 64 bits.
    ///
    /// # Errors
    /// As [`Self::bytes`].
    pub fn i64(&mut self) -> Result<i64> {
        Ok(i64::from_le_bytes(self.array()?))
    }

    /// A count or index.
    ///
    /// # Errors
    /// As [`Self::bytes`]; `Argument` for one that this machine cannot hold.
    pub fn count(&mut self) -> Result<usize> {
        let value = u64::from_le_bytes(self.array()?);
        usize::try_from(value).map_err(|_| self.damaged("a count is too large"))
    }

    /// A count of entries of at least `size` bytes each, which must be left: memory may be reserved for them.
    ///
    /// # Errors
    /// As [`Self::bytes`].
    pub fn entries(&mut self, size: usize) -> Result<usize> {
        let count = self.count()?;
        if count
            .checked_mul(size.max(1))
            .is_none_or(|bytes| bytes > self.left.len())
        {
            return Err(self.damaged("more entries are announced than bytes are left"));
        }
        Ok(count)
    }

    /// A count or index that may be missing.
    ///
    /// # Errors
    /// As [`Self::bytes`]; `Argument` for a negative one other than −1.
    pub fn optional(&mut self) -> Result<Option<usize>> {
        match self.i64()? {
            -1 => Ok(None),
            value => usize::try_from(value)
                .map(Some)
                .map_err(|_| self.damaged("an index is negative")),
        }
    }

    /// A number, whatever it is.
    ///
    /// # Errors
    /// As [`Self::bytes`].
    pub fn f64(&mut self) -> Result<f64> {
        Ok(f64::from_bits(u64::from_le_bytes(self.array()?)))
    }

    /// A finite number.
    ///
    /// # Errors
    /// As [`Self::bytes`]; `Argument` for another one.
    pub fn finite(&mut self) -> Result<f64> {
        let value = self.f64()?;
        if value.is_finite() {
            return Ok(value);
        }
        Err(self.damaged("a number is not finite"))
    }
}

/// Generator x⁶⁴ + … of ECMA-182, bits reflected.
/// Kind: fixed.
const GENERATOR: u64 = 0xC96C_5795_D787_0F42;

/// Remainders of all bytes.
/// Kind: fixed.
const REMAINDERS: [u64; 256] = {
    let mut table = [0; 256];
    let mut byte = 0;
    while byte < 256 {
        let mut remainder = byte as u64;
        let mut bit = 0;
        while bit < 8 {
            remainder = (remainder >> 1) ^ if remainder & 1 == 1 { GENERATOR } else { 0 };
            bit += 1;
        }
        table[byte] = remainder;
        byte += 1;
    }
    table
};

/// Cyclic redundancy check of 64 bits (ECMA-182 as in the format xz): it finds every change within 64 neighbouring bits,
/// others but for a share of 2⁻⁶⁴.
pub fn checksum(bytes: &[u8]) -> u64 {
    !bytes.iter().fold(!0, |remainder: u64, &byte| {
        (remainder >> 8) ^ REMAINDERS[((remainder ^ u64::from(byte)) & 0xFF) as usize]
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_checksum_has_its_published_value() {
        assert_eq!(checksum(b"123456789"), 0x995D_C9BB_DF19_39FA);
    }

    #[test]
    fn a_reader_stays_within_its_bytes() {
        let mut bytes = [0; 40];
        let mut out = ByteWriter::new(&mut bytes);
        out.count(3);
        out.optional(None);
        out.f64(f64::NAN);
        out.count(usize::MAX);
        out.f64(1.0);
        out.f64(2.0);
        assert_eq!(out.position(), 48);
        let mut input = ByteReader::new(&bytes);
        assert_eq!(input.count().unwrap(), 3);
        assert_eq!(input.optional().unwrap(), None);
        assert!(input.finite().unwrap_err().to_string().contains("before byte 24"));
        assert!(input.entries(8).is_err());
        assert_eq!(input.f64().unwrap().to_bits(), 1.0_f64.to_bits());
        assert!(input.f64().unwrap_err().to_string().contains("0 are left"));
    }
}
