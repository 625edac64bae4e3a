//! Files of NetCDF in the classic format with 64-bit offsets (CDF-2), which need no library: a header, variables, and records of the
//! variables along an unlimited dimension.

use crate::texts::outcome::Outcome;
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::Path;

/// Length of the unlimited dimension in the header.
pub const UNLIMITED: usize = 0;

/// Most bytes of a variable, or of one record of it, in this format.
const MOST: u64 = u32::MAX as u64 - 3;

/// Dimensions, attributes and variables of a file, without the numbers.
#[derive(Default)]
pub struct Dataset {
    dimensions: Vec<(String, usize)>,
    attributes: Vec<(String, String)>,
    variables: Vec<Variable>,
}

/// A variable of a file.
struct Variable {
    name: String,
    dimensions: Vec<usize>,
    kind: Kind,
    attributes: Vec<(String, String)>,
}

/// Kind of the numbers of a variable.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    Text = 2,
    Integer = 4,
    Real = 6,
}

/// Numbers of a variable, or of one record of it.
pub enum Numbers {
    Text(Vec<u8>),
    Integers(Vec<i32>),
    Reals(Vec<f64>),
}

impl Numbers {
    fn bytes(&self) -> Vec<u8> {
        match self {
            Self::Text(text) => text.clone(),
            Self::Integers(all) => all.iter().flat_map(|n| n.to_be_bytes()).collect(),
            Self::Reals(all) => all.iter().flat_map(|x| x.to_be_bytes()).collect(),
        }
    }
}

/// Returns the numbers of a variable, of a record where it has records.
pub type Fill<'a> = &'a mut dyn FnMut(usize, Option<usize>) -> Outcome<Numbers>;

impl Dataset {
    /// Adds a dimension, and returns its number.
    pub fn dimension(&mut self, name: &str, length: usize) -> usize {
        self.dimensions.push((name.to_owned(), length));
        self.dimensions.len() - 1
    }

    /// Adds an attribute of the file.
    pub fn attribute(&mut self, name: &str, value: &str) {
        self.attributes.push((name.to_owned(), value.to_owned()));
    }

    /// Adds a variable over dimensions, the unlimited one first, and returns its number.
    pub fn variable(&mut self, name: &str, kind: Kind, dimensions: &[usize], attributes: &[(&str, &str)]) -> usize {
        self.variables.push(Variable {
            name: name.to_owned(),
            dimensions: dimensions.to_vec(),
            kind,
            attributes: attributes
                .iter()
                .map(|(name, value)| (name.to_string(), value.to_string()))
                .collect(),
        });
        self.variables.len() - 1
    }

    fn is_record(&self, variable: &Variable) -> bool {
        variable
            .dimensions
            .first()
            .is_some_and(|d| self.dimensions[*d].1 == UNLIMITED)
    }

    /// Bytes of a variable, or of one record of it, with the zeros that fill up four.
    fn size(&self, variable: &Variable) -> Outcome<u64> {
        let width = match variable.kind {
            Kind::Text => 1,
            Kind::Integer => 4,
            Kind::Real => 8,
        };
        let lengths = variable.dimensions.iter().map(|d| self.dimensions[*d].1 as u64);
        let size = lengths.filter(|length| *length != UNLIMITED as u64).product::<u64>() * width;
        if size > MOST {
            return Err(format!(
                "{} has {size} bytes a point, and the format holds {MOST}: npz has no such limit",
                variable.name
            ));
        }
        Ok(size.next_multiple_of(4))
    }

    /// Writes the file with its numbers.
    ///
    /// # Errors
    /// A variable that is too large; those of the system and of `fill`; another number of values than the variable has.
    pub fn write(&self, path: &Path, records: usize, fill: Fill<'_>) -> Outcome<()> {
        let said = |e: std::io::Error| e.to_string();
        let mut sizes = Vec::new();
        for variable in &self.variables {
            sizes.push(self.size(variable)?);
        }
        // The length of the header does not depend on the offsets in it.
        let start = self.header(records, &sizes, &vec![0; sizes.len()]).len() as u64;
        let mut begins = vec![0; sizes.len()];
        let mut at = start;
        let of = |record: bool| (0..sizes.len()).filter(move |v| self.is_record(&self.variables[*v]) == record);
        for v in of(false).chain(of(true)) {
            begins[v] = at;
            at += sizes[v];
        }
        let mut out = BufWriter::new(File::create(path).map_err(said)?);
        out.write_all(&self.header(records, &sizes, &begins)).map_err(said)?;
        let mut put = |v: usize, record: Option<usize>| -> Outcome<()> {
            let mut bytes = fill(v, record)?.bytes();
            bytes.resize(bytes.len().next_multiple_of(4), 0);
            if bytes.len() as u64 != sizes[v] {
                return Err(format!(
                    "{} has {} bytes, needs {}",
                    self.variables[v].name,
                    bytes.len(),
                    sizes[v]
                ));
            }
            out.write_all(&bytes).map_err(said)
        };
        for v in of(false) {
            put(v, None)?;
        }
        for record in 0..records {
            for v in of(true) {
                put(v, Some(record))?;
            }
        }
        out.flush().map_err(said)
    }

    fn header(&self, records: usize, sizes: &[u64], begins: &[u64]) -> Vec<u8> {
        const DIMENSION: u32 = 10;
        const VARIABLE: u32 = 11;
        let mut out = b"CDF\x02".to_vec();
        number(&mut out, records as u32);
        list(&mut out, DIMENSION, self.dimensions.len());
        for (name, length) in &self.dimensions {
            text(&mut out, name);
            number(&mut out, *length as u32);
        }
        attributes(&mut out, &self.attributes);
        list(&mut out, VARIABLE, self.variables.len());
        for ((variable, size), begin) in self.variables.iter().zip(sizes).zip(begins) {
            text(&mut out, &variable.name);
            number(&mut out, variable.dimensions.len() as u32);
            for dimension in &variable.dimensions {
                number(&mut out, *dimension as u32);
            }
            attributes(&mut out, &variable.attributes);
            number(&mut out, variable.kind as u32);
            number(&mut out, *size as u32);
            out.extend(begin.to_be_bytes());
        }
        out
    }
}

fn number(out: &mut Vec<u8>, n: u32) {
    out.extend(n.to_be_bytes());
}

/// The tag and the length of a list; zeros for an empty one.
fn list(out: &mut Vec<u8>, tag: u32, length: usize) {
    number(out, if length == 0 { 0 } else { tag });
    number(out, length as u32);
}

fn text(out: &mut Vec<u8>, text: &str) {
    number(out, text.len() as u32);
    out.extend(text.as_bytes());
    out.resize(out.len().next_multiple_of(4), 0);
}

fn attributes(out: &mut Vec<u8>, all: &[(String, String)]) {
    const ATTRIBUTE: u32 = 12;
    list(out, ATTRIBUTE, all.len());
    for (name, value) in all {
        text(out, name);
        number(out, Kind::Text as u32);
        text(out, value);
    }
}

#[cfg(test)]
mod tests {
    use super::{Dataset, Kind, Numbers, UNLIMITED};

    /// The smallest file by hand, from the specification of the format.
    #[test]
    fn a_file_has_the_bytes_of_the_specification() {
        let mut data = Dataset::default();
        let t = data.dimension("t", UNLIMITED);
        data.variable("x", Kind::Real, &[t], &[("u", "m")]);
        let path = std::env::temp_dir().join(format!("hbvib_netcdf_{}.nc", std::process::id()));
        data.write(&path, 2, &mut |_, record| {
            Ok(Numbers::Reals(vec![record.map_or(-1.0, |r| r as f64)]))
        })
        .unwrap();
        let bytes = std::fs::read(&path).unwrap();
        std::fs::remove_file(&path).unwrap();
        let mut expected = b"CDF\x02".to_vec();
        let four = |n: u32| n.to_be_bytes();
        for n in [2, 10, 1, 1] {
            expected.extend(four(n));
        }
        expected.extend(b"t\0\0\0");
        for n in [0, 0, 0, 11, 1, 1] {
            expected.extend(four(n));
        }
        expected.extend(b"x\0\0\0");
        for n in [1, 0, 12, 1, 1] {
            expected.extend(four(n));
        }
        expected.extend(b"u\0\0\0");
        for n in [2, 1] {
            expected.extend(four(n));
        }
        expected.extend(b"m\0\0\0");
        for n in [6, 8] {
            expected.extend(four(n));
        }
        let begin = expected.len() as u64 + 8;
        expected.extend(begin.to_be_bytes());
        expected.extend(0.0_f64.to_be_bytes());
        expected.extend(1.0_f64.to_be_bytes());
        assert_eq!(bytes, expected);
    }
}
