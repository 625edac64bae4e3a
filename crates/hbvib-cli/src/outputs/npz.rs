//! Arrays in one NPZ file: a ZIP archive of NPY files, stored without compression, with the extensions of ZIP for more than
//! 4 GiB. Arrays are written part by part, so that none is in memory twice.

use flate2::Crc;
use num_complex::Complex64;
use std::io::{self, Seek, SeekFrom, Write};

/// An archive that is written array by array.
pub struct Npz<W: Write + Seek> {
    out: W,
    written: u64,
    directory: Vec<u8>,
    entries: u64,
}

/// Takes a number of an array.
type Put<'a, T> = &'a mut dyn FnMut(T) -> io::Result<()>;

/// Passes all numbers of an array.
type Fill<'a, T> = &'a mut dyn FnMut(Put<'_, T>) -> io::Result<()>;

/// Takes a part of a complex array.
type PutComplex<'a> = &'a mut dyn FnMut(&[Complex64]) -> io::Result<()>;

/// Passes a complex array in parts.
type FillComplex<'a> = &'a mut dyn FnMut(PutComplex<'_>) -> io::Result<()>;

/// Sizes from this on are in the extra field of ZIP64.
const LARGE: u64 = u32::MAX as u64;

/// Bytes between two writes.
const CHUNK: usize = 1 << 16;

impl<W: Write + Seek> Npz<W> {
    pub fn new(out: W) -> Self {
        Self {
            out,
            written: 0,
            directory: Vec::new(),
            entries: 0,
        }
    }

    /// Adds an array of real numbers.
    ///
    /// # Errors
    /// Those of writing; another number of values than the shape has.
    pub fn real(&mut self, name: &str, shape: &[usize], values: &[f64]) -> io::Result<()> {
        self.add(name, ("<f8", 8), shape, &mut |put| {
            values.iter().try_for_each(|v| put(*v))
        })
    }

    /// Adds an array of complex numbers, which `fill` passes in any number of parts.
    ///
    /// # Errors
    /// As [`Self::real`]; those of `fill`.
    pub fn complex(&mut self, name: &str, shape: &[usize], fill: FillComplex<'_>) -> io::Result<()> {
        self.add(name, ("<c16", 16), shape, &mut |put| {
            fill(&mut |part| part.iter().try_for_each(|z| put(z.re).and_then(|()| put(z.im))))
        })
    }

    fn add(&mut self, name: &str, (kind, size): (&str, u64), shape: &[usize], fill: Fill<'_, f64>) -> io::Result<()> {
        let lengths: Vec<String> = shape.iter().map(|n| format!("{n},")).collect();
        let mut head = format!(
            "{{'descr': '{kind}', 'fortran_order': False, 'shape': ({}), }}",
            lengths.join(" ")
        );
        while (10 + head.len() + 1) % 64 != 0 {
            head.push(' ');
        }
        head.push('\n');
        let mut body = b"\x93NUMPY\x01\x00".to_vec();
        body.extend((head.len() as u16).to_le_bytes());
        body.extend(head.as_bytes());
        let length = shape.iter().map(|n| *n as u64).product::<u64>() * size + body.len() as u64;
        let file = format!("{name}.npy");
        // The check sum is written again when all values are known.
        let start = self.written;
        let local = local_head(&file, 0, length);
        self.put(&local)?;
        let mut sum = Crc::new();
        let mut count = 0;
        fill(&mut |value| {
            body.extend(value.to_le_bytes());
            if body.len() >= CHUNK {
                sum.update(&body);
                count += body.len() as u64;
                self.put(&body)?;
                body.clear();
            }
            Ok(())
        })?;
        sum.update(&body);
        count += body.len() as u64;
        self.put(&body)?;
        if count != length {
            return Err(io::Error::other(format!("{name} has {count} bytes, needs {length}")));
        }
        self.out.seek(SeekFrom::Start(start))?;
        self.out.write_all(&local_head(&file, sum.sum(), length))?;
        self.out.seek(SeekFrom::Start(self.written))?;
        self.directory.extend(directory_head(&file, sum.sum(), length, start));
        self.entries += 1;
        Ok(())
    }

    fn put(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.out.write_all(bytes)?;
        self.written += bytes.len() as u64;
        Ok(())
    }

    /// Writes the directory.
    ///
    /// # Errors
    /// Those of writing.
    pub fn finish(mut self) -> io::Result<()> {
        let (start, size) = (self.written, self.directory.len() as u64);
        let directory = core::mem::take(&mut self.directory);
        self.put(&directory)?;
        if start >= LARGE {
            let end = self.written;
            let mut large = b"PK\x06\x06".to_vec();
            large.extend(44_u64.to_le_bytes());
            large.extend([45, 0, 45, 0, 0, 0, 0, 0, 0, 0, 0, 0]);
            for number in [self.entries, self.entries, size, start] {
                large.extend(number.to_le_bytes());
            }
            large.extend(b"PK\x06\x07\x00\x00\x00\x00");
            large.extend(end.to_le_bytes());
            large.extend(1_u32.to_le_bytes());
            self.put(&large)?;
        }
        let mut end = b"PK\x05\x06\x00\x00\x00\x00".to_vec();
        end.extend((self.entries as u16).to_le_bytes());
        end.extend((self.entries as u16).to_le_bytes());
        end.extend((size as u32).to_le_bytes());
        end.extend((start.min(LARGE) as u32).to_le_bytes());
        end.extend([0, 0]);
        self.put(&end)?;
        self.out.flush()
    }
}

/// Version, flags, method, time and date, check sum, sizes, lengths of the name and of the extra field.
fn common(file: &str, sum: u32, length: u64, extra: u16) -> Vec<u8> {
    let version = if extra > 0 { 45 } else { 20 };
    let mut common = vec![version, 0, 0, 0, 0, 0, 0, 0, 0x21, 0];
    common.extend(sum.to_le_bytes());
    let size = (if extra > 0 { LARGE } else { length } as u32).to_le_bytes();
    common.extend(size);
    common.extend(size);
    common.extend((file.len() as u16).to_le_bytes());
    common.extend(extra.to_le_bytes());
    common
}

fn local_head(file: &str, sum: u32, length: u64) -> Vec<u8> {
    let large = length >= LARGE;
    let mut head = b"PK\x03\x04".to_vec();
    head.extend(common(file, sum, length, if large { 20 } else { 0 }));
    head.extend(file.as_bytes());
    if large {
        head.extend([1, 0, 16, 0]);
        head.extend(length.to_le_bytes());
        head.extend(length.to_le_bytes());
    }
    head
}

fn directory_head(file: &str, sum: u32, length: u64, start: u64) -> Vec<u8> {
    let large = length >= LARGE || start >= LARGE;
    let mut head = b"PK\x01\x02\x2d\x00".to_vec();
    head.extend(common(file, sum, length, if large { 28 } else { 0 }));
    head.extend([0; 10]);
    head.extend((if large { LARGE } else { start } as u32).to_le_bytes());
    head.extend(file.as_bytes());
    if large {
        head.extend([1, 0, 24, 0]);
        for number in [length, length, start] {
            head.extend(number.to_le_bytes());
        }
    }
    head
}

#[cfg(test)]
mod tests {
    use super::Npz;
    use num_complex::Complex64;
    use std::fs::File;
    use std::io::{self, Seek, SeekFrom, Write};
    use std::process::Command;

    /// A file in which zeros take no room.
    struct Sparse(File);

    impl Write for Sparse {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            if bytes.iter().all(|b| *b == 0) {
                self.0.seek(SeekFrom::Current(bytes.len() as i64))?;
                return Ok(bytes.len());
            }
            self.0.write(bytes)
        }

        fn flush(&mut self) -> io::Result<()> {
            self.0.flush()
        }
    }

    impl Seek for Sparse {
        fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
            self.0.seek(to)
        }
    }

    fn read_by_numpy(large: usize) {
        let path = std::env::temp_dir().join(format!("hbvib_{}_{large}.npz", std::process::id()));
        let mut npz = Npz::new(Sparse(File::create(&path).unwrap()));
        npz.real("first", &[2, 1], &[1.5, -2.0]).unwrap();
        let part = vec![Complex64::ZERO; 1 << 16];
        npz.complex("large", &[large, 1 << 16], &mut |put| {
            (1..large).try_for_each(|_| put(&part))?;
            let mut last = part.clone();
            last[7] = Complex64::new(3.0, 4.0);
            put(&last)
        })
        .unwrap();
        npz.real("last", &[1], &[0.25]).unwrap();
        npz.finish().unwrap();
        let program = "import sys, zipfile, numpy as np\nfile = np.load(sys.argv[1], allow_pickle=False)\n\
                       assert file['first'].tolist() == [[1.5], [-2.0]] and file['last'].tolist() == [0.25]\n\
                       x = file['large']\nassert x.shape == (int(sys.argv[2]), 65536) and x[-1, 7] == 3 + 4j and x[0, 7] == 0\n\
                       assert zipfile.ZipFile(sys.argv[1]).testzip() is None";
        let python = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../.venv/bin/python");
        let output = Command::new(if python.exists() { python } else { "python3".into() })
            .args(["-c", program])
            .arg(&path)
            .arg(large.to_string())
            .output()
            .unwrap();
        std::fs::remove_file(&path).unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    }

    #[test]
    fn an_archive_is_read_by_numpy() {
        read_by_numpy(3);
    }

    #[test]
    #[ignore = "numpy reads more than 4 GiB"]
    fn an_archive_of_more_than_four_gibibytes_is_read_by_numpy() {
        read_by_numpy(4200);
    }
}
