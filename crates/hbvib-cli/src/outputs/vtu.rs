//! One VTU file of ParaView: an unstructured grid with values at its points, binary numbers as text of base 64.

use crate::texts::outcome::Outcome;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

/// A grid with its values.
#[derive(Default)]
pub struct Grid {
    /// Positions, three numbers a point.
    pub points: Vec<f64>,
    pub cells: Vec<Cell>,
    arrays: String,
}

/// A cell: its type in VTK and its points.
#[derive(Clone)]
pub struct Cell {
    pub kind: u8,
    pub points: Vec<usize>,
}

impl Grid {
    /// Adds numbers at each point, `components` of them.
    pub fn reals(&mut self, name: &str, components: usize, values: &[f64]) {
        let bytes: Vec<u8> = values.iter().flat_map(|v| v.to_le_bytes()).collect();
        array(&mut self.arrays, "Float64", (name, components), &bytes);
    }

    /// Adds a whole number at each point.
    pub fn integers(&mut self, name: &str, values: impl Iterator<Item = i64>) {
        let bytes: Vec<u8> = values.flat_map(i64::to_le_bytes).collect();
        array(&mut self.arrays, "Int64", (name, 1), &bytes);
    }

    /// Writes the file.
    ///
    /// # Errors
    /// That of the system.
    pub fn write(&self, path: &Path) -> Outcome<()> {
        let mut text = String::from(
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" \
             header_type=\"UInt64\">\n<UnstructuredGrid>\n",
        );
        let _ = writeln!(
            text,
            "<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n<Points>",
            self.points.len() / 3,
            self.cells.len()
        );
        let bytes: Vec<u8> = self.points.iter().flat_map(|v| v.to_le_bytes()).collect();
        array(&mut text, "Float64", ("Points", 3), &bytes);
        text += "</Points>\n<Cells>\n";
        let all = self.cells.iter().flat_map(|cell| &cell.points);
        let bytes: Vec<u8> = all.flat_map(|p| (*p as i64).to_le_bytes()).collect();
        array(&mut text, "Int64", ("connectivity", 1), &bytes);
        let mut end = 0_i64;
        let offsets = self.cells.iter().flat_map(|cell| {
            end += cell.points.len() as i64;
            end.to_le_bytes()
        });
        array(&mut text, "Int64", ("offsets", 1), &offsets.collect::<Vec<u8>>());
        let kinds: Vec<u8> = self.cells.iter().map(|cell| cell.kind).collect();
        array(&mut text, "UInt8", ("types", 1), &kinds);
        text += "</Cells>\n<PointData>\n";
        text += &self.arrays;
        text += "</PointData>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
        fs::write(path, text).map_err(|e| e.to_string())
    }

    /// Removes the values, and keeps points and cells.
    pub fn clear(&mut self) {
        self.arrays.clear();
    }
}

fn array(text: &mut String, kind: &str, (name, components): (&str, usize), bytes: &[u8]) {
    let name = escaped(name);
    // One number a point is the default, and readers then have vectors instead of one column.
    let components = match components {
        1 => String::new(),
        several => format!(" NumberOfComponents=\"{several}\""),
    };
    let _ = writeln!(
        text,
        "<DataArray type=\"{kind}\" Name=\"{name}\"{components} format=\"binary\">"
    );
    let mut all = (bytes.len() as u64).to_le_bytes().to_vec();
    all.extend(bytes);
    base64(text, &all);
    *text += "\n</DataArray>\n";
}

/// Bytes as text of base 64 (RFC 4648).
fn base64(text: &mut String, bytes: &[u8]) {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    text.reserve(bytes.len() / 3 * 4 + 4);
    for three in bytes.chunks(3) {
        let at = |i: usize| u32::from(three.get(i).copied().unwrap_or(0));
        let all = at(0) << 16 | at(1) << 8 | at(2);
        for i in 0..4 {
            let digit = DIGITS[(all >> (18 - 6 * i) & 63) as usize];
            text.push(if i <= three.len() { char::from(digit) } else { '=' });
        }
    }
}

/// Text between marks and quotes of XML and HTML.
pub fn escaped(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
        .replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::base64;

    /// The examples of RFC 4648.
    #[test]
    fn bytes_are_text_of_base_64() {
        for (bytes, expected) in [
            ("", ""),
            ("f", "Zg=="),
            ("fo", "Zm8="),
            ("foo", "Zm9v"),
            ("foob", "Zm9vYg=="),
            ("fooba", "Zm9vYmE="),
            ("foobar", "Zm9vYmFy"),
        ] {
            let mut text = String::new();
            base64(&mut text, bytes.as_bytes());
            assert_eq!(text, expected);
        }
    }
}
