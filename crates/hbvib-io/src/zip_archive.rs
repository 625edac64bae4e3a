//! Files in a ZIP archive, stored or deflated, as NumPy writes them.

use crate::bytes_read::at;
use flate2::Crc;
use flate2::read::DeflateDecoder;
use std::io::Read;

/// Deflated bytes grow at most by this factor.
const MOST: usize = 1032;

/// A file of an archive.
pub(crate) struct Member {
    pub name: String,
    method: u64,
    sum: u64,
    packed: usize,
    size: usize,
    offset: usize,
}

type Told<T> = std::result::Result<T, String>;

/// The files of an archive.
///
/// # Errors
/// A sentence.
pub(crate) fn members(bytes: &[u8]) -> Told<Vec<Member>> {
    let damaged = |place: usize| format!("the ZIP archive is cut off or damaged at byte {place}");
    let short = |place, size| at(bytes, place, size, true).ok_or_else(|| damaged(place));
    // The end has 22 bytes and a comment of at most 65535.
    let first = bytes.len().saturating_sub(22 + 65_535);
    let end = (first..bytes.len().saturating_sub(21))
        .rev()
        .find(|&place| bytes[place..].starts_with(b"PK\x05\x06"))
        .ok_or("the ZIP archive is cut off: its directory is missing")?;
    let mut count = short(end + 10, 2)?;
    let mut place = short(end + 16, 4)?;
    // Larger archives have a second end before the first one.
    if (count == 0xffff || place == 0xffff_ffff)
        && let Some(locator) = end.checked_sub(20).filter(|l| bytes[*l..].starts_with(b"PK\x06\x07"))
    {
        let end = short(locator + 8, 8)? as usize;
        count = short(end.saturating_add(32), 8)?;
        place = short(end.saturating_add(48), 8)?;
    }
    let mut place = usize::try_from(place).map_err(|_| damaged(end))?;
    let mut all = Vec::new();
    for _ in 0..count {
        if !bytes.get(place..).is_some_and(|rest| rest.starts_with(b"PK\x01\x02")) {
            return Err(damaged(place));
        }
        let field = |offset: usize, size: usize| short(place + offset, size);
        let (name, extra, comment) = (field(28, 2)? as usize, field(30, 2)? as usize, field(32, 2)? as usize);
        let text = bytes.get(place + 46..place + 46 + name).ok_or_else(|| damaged(place))?;
        let extra_at = place + 46 + name;
        let mut sizes = [field(24, 4)?, field(20, 4)?, field(42, 4)?];
        large_sizes(
            bytes.get(extra_at..extra_at + extra).ok_or_else(|| damaged(place))?,
            &mut sizes,
        );
        let [size, packed, offset] = sizes.map(|n| usize::try_from(n).unwrap_or(usize::MAX));
        all.push(Member {
            name: String::from_utf8_lossy(text).into_owned(),
            method: field(10, 2)?,
            sum: field(16, 4)?,
            packed,
            size,
            offset,
        });
        place = extra_at + extra + comment;
    }
    Ok(all)
}

/// Takes the sizes that do not fit in four bytes from the field of the kind 1.
fn large_sizes(mut extra: &[u8], sizes: &mut [u64; 3]) {
    while let (Some(kind), Some(length)) = (at(extra, 0, 2, true), at(extra, 2, 2, true)) {
        let end = extra.len().min(4 + length as usize);
        if kind == 1 {
            let mut place = 4;
            for size in sizes.iter_mut().filter(|size| **size == 0xffff_ffff) {
                if let Some(large) = at(&extra[..end], place, 8, true) {
                    *size = large;
                }
                place += 8;
            }
            return;
        }
        extra = &extra[end..];
    }
}

impl Member {
    /// The bytes of a file. Their number is compared with that of the archive before memory is requested.
    ///
    /// # Errors
    /// A sentence.
    pub fn content(&self, bytes: &[u8]) -> Told<Vec<u8>> {
        let name = &self.name;
        let cut = || format!("{name}: the ZIP archive is cut off or damaged at byte {}", self.offset);
        let head = bytes
            .get(self.offset..)
            .filter(|rest| rest.starts_with(b"PK\x03\x04"))
            .ok_or_else(cut)?;
        let (name_length, extra) = (at(head, 26, 2, true), at(head, 28, 2, true));
        let start = 30 + name_length.ok_or_else(cut)? as usize + extra.ok_or_else(cut)? as usize;
        let end = start.checked_add(self.packed).ok_or_else(cut)?;
        let body = head.get(start..end).ok_or_else(cut)?;
        let most = match self.method {
            0 => self.packed,
            8 => self.packed.saturating_mul(MOST),
            other => {
                return Err(format!(
                    "{name}: compressed by method {other}, needs 0 (stored) or 8 (deflate)"
                ));
            }
        };
        if self.size > most {
            return Err(format!(
                "{name}: {} bytes out of {} packed ones",
                self.size, self.packed
            ));
        }
        let mut all = Vec::new();
        if self.method == 0 {
            all.extend_from_slice(body);
        } else {
            DeflateDecoder::new(body)
                .take(self.size as u64 + 1)
                .read_to_end(&mut all)
                .map_err(|error| format!("{name}: cannot be unpacked: {error}"))?;
        }
        let mut sum = Crc::new();
        sum.update(&all);
        if all.len() != self.size || u64::from(sum.sum()) != self.sum {
            return Err(format!(
                "{name}: its bytes do not have the length or the check sum of the archive"
            ));
        }
        Ok(all)
    }
}
