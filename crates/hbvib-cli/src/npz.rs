//! Arrays in one NPZ file: a ZIP archive of NPY files, stored without compression.

use flate2::Crc;
use num_complex::Complex64;
use std::io::{self, Write};

/// An archive that is written array by array.
pub struct Npz<W: Write> {
    out: W,
    written: u32,
    directory: Vec<u8>,
    entries: u16,
}

/// Largest archive without extensions of ZIP.
const LARGEST: u64 = u32::MAX as u64;

impl<W: Write> Npz<W> {
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
    /// Those of writing, and an archive of 4 GiB.
    pub fn real(&mut self, name: &str, shape: &[usize], values: &[f64]) -> io::Result<()> {
        self.add(name, "<f8", shape, values.iter().copied())
    }

    /// Adds an array of complex numbers.
    ///
    /// # Errors
    /// As [`Self::real`].
    pub fn complex(&mut self, name: &str, shape: &[usize], values: &[Complex64]) -> io::Result<()> {
        self.add(name, "<c16", shape, values.iter().flat_map(|z| [z.re, z.im]))
    }

    fn add(&mut self, name: &str, kind: &str, shape: &[usize], values: impl Iterator<Item = f64>) -> io::Result<()> {
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
        for value in values {
            body.extend(value.to_le_bytes());
        }
        let mut sum = Crc::new();
        sum.update(&body);
        let file = format!("{name}.npy");
        if body.len() as u64 + u64::from(self.written) > LARGEST {
            return Err(io::Error::other("more than 4 GiB do not fit into one NPZ file"));
        }
        let size = (body.len() as u32).to_le_bytes();
        // Version, flags, method, time and date, check sum, sizes, lengths of name and extra field.
        let mut common = vec![20, 0, 0, 0, 0, 0, 0, 0, 0x21, 0];
        common.extend(sum.sum().to_le_bytes());
        common.extend(size);
        common.extend(size);
        common.extend((file.len() as u16).to_le_bytes());
        common.extend([0, 0]);
        self.directory.extend(b"PK\x01\x02\x14\x00");
        self.directory.extend(&common);
        self.directory.extend([0; 10]);
        self.directory.extend(self.written.to_le_bytes());
        self.directory.extend(file.as_bytes());
        self.entries += 1;
        for part in [&b"PK\x03\x04"[..], &common, file.as_bytes(), &body] {
            self.out.write_all(part)?;
            self.written += part.len() as u32;
        }
        Ok(())
    }

    /// Writes the directory.
    ///
    /// # Errors
    /// Those of writing.
    pub fn finish(mut self) -> io::Result<()> {
        let mut end = b"PK\x05\x06\x00\x00\x00\x00".to_vec();
        end.extend(self.entries.to_le_bytes());
        end.extend(self.entries.to_le_bytes());
        end.extend((self.directory.len() as u32).to_le_bytes());
        end.extend(self.written.to_le_bytes());
        end.extend([0, 0]);
        self.out.write_all(&self.directory)?;
        self.out.write_all(&end)?;
        self.out.flush()
    }
}
