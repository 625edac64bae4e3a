//! Strict reader of real MatrixMarket coordinate files, plain or gzipped.
//!
//! Every error names the file and the line. The format is that of Boisvert, Pozo and Remington, NISTIR 5935 (1996),
//! with two restrictions that usual files satisfy: each entry has a line of its own, and none may be given twice.
#![allow(dead_code, reason = "each example uses a part of this module")]

use std::fs::File;
use std::io::{BufRead, BufReader};
use std::path::Path;
use std::str::FromStr;

use flate2::bufread::MultiGzDecoder;
use hbvib::internals::MAX_DOF;
use hbvib::{MatrixView, Part, Storage, Values};

/// A sparse matrix in compressed columns; all indices count from 1, as in the file.
#[derive(Clone, Debug)]
pub struct Matrix {
    /// Number of rows.
    pub rows: usize,
    /// Number of columns.
    pub cols: usize,
    /// Whether the entries are the lower triangle of a symmetric matrix.
    pub symmetric: bool,
    col_ptr: Vec<i64>,
    row_idx: Vec<i64>,
    values: Vec<f64>,
}

impl Matrix {
    /// The matrix as a view for the library. A `general` file is passed as [`Part::Full`], so that the symmetry of
    /// a block that must be symmetric is checked.
    pub fn view(&self) -> MatrixView<'_> {
        MatrixView {
            rows: self.rows,
            cols: self.cols,
            storage: Storage::Csc {
                col_ptr: &self.col_ptr,
                row_idx: &self.row_idx,
            },
            values: Values::Real(&self.values),
            part: if self.symmetric { Part::Lower } else { Part::Full },
            index_base: 1,
        }
    }
}

/// Reads a file; one whose name ends in `.gz` is decompressed.
///
/// # Errors
///
/// A sentence naming the file, the line and the defect.
pub fn read(path: &Path) -> Result<Matrix, String> {
    let file = File::open(path).map_err(|e| format!("{}: cannot be opened: {e}", path.display()))?;
    let file = BufReader::new(file);
    if path.extension().is_some_and(|e| e.eq_ignore_ascii_case("gz")) {
        parse(path, BufReader::new(MultiGzDecoder::new(file)))
    } else {
        parse(path, file)
    }
}

/// Reads the text; `path` only names it in errors.
///
/// # Errors
///
/// As [`read`].
pub fn parse(path: &Path, text: impl BufRead) -> Result<Matrix, String> {
    let mut lines = Lines {
        path,
        text,
        line: String::new(),
        number: 0,
    };
    let symmetric = header(&mut lines)?;
    let (rows, cols, count) = size(&mut lines, symmetric)?;

    let mut entries: Vec<Entry> = Vec::new();
    while lines.next()? {
        let words = lines.words();
        if words.is_empty() {
            continue;
        }
        if entries.len() == count {
            return Err(lines.wrong(&format!("one more entry than the {count} that the size line announces")));
        }
        let [row, col, value] = words[..] else {
            return Err(lines.wrong(&format!("needs 'row column value', found '{}'", words.join(" "))));
        };
        let entry = Entry {
            col: lines.index("column", col, cols)?,
            row: lines.index("row", row, rows)?,
            value: lines.number::<f64>("a number", value)?,
            line: lines.number,
        };
        if !entry.value.is_finite() {
            return Err(lines.wrong(&format!("entry ({row}, {col}) is {value}, needs a finite number")));
        }
        if symmetric && entry.row < entry.col {
            return Err(lines.wrong(&format!(
                "entry ({row}, {col}) lies above the diagonal; a symmetric file holds the lower triangle"
            )));
        }
        entries.push(entry);
    }
    if entries.len() < count {
        let found = entries.len();
        return Err(lines.wrong(&format!(
            "the file ends after {found} of the {count} entries that the size line announces"
        )));
    }
    compress(path, rows, cols, symmetric, entries)
}

struct Entry {
    col: usize,
    row: usize,
    value: f64,
    line: usize,
}

fn compress(path: &Path, rows: usize, cols: usize, symmetric: bool, mut entries: Vec<Entry>) -> Result<Matrix, String> {
    entries.sort_unstable_by_key(|e| (e.col, e.row, e.line));
    let same = |pair: &&[Entry]| (pair[0].col, pair[0].row) == (pair[1].col, pair[1].row);
    if let Some([first, again]) = entries.windows(2).find(same) {
        return Err(format!(
            "{}, line {}: entry ({}, {}) was given in line {} already",
            path.display(),
            again.line,
            again.row,
            again.col,
            first.line
        ));
    }
    let mut col_ptr = vec![0; cols + 1];
    col_ptr[0] = 1;
    for entry in &entries {
        col_ptr[entry.col] += 1;
    }
    for col in 0..cols {
        col_ptr[col + 1] += col_ptr[col];
    }
    Ok(Matrix {
        rows,
        cols,
        symmetric,
        col_ptr,
        row_idx: entries.iter().map(|e| e.row as i64).collect(),
        values: entries.iter().map(|e| e.value).collect(),
    })
}

/// Reads the first line; `true` if the matrix is symmetric.
fn header<R: BufRead>(lines: &mut Lines<'_, R>) -> Result<bool, String> {
    if !lines.next()? {
        return Err(lines.wrong("the file is empty"));
    }
    let text = lines.line.to_ascii_lowercase();
    let words: Vec<&str> = text.split_ascii_whitespace().collect();
    let ["%%matrixmarket", object, format, field, symmetry] = words[..] else {
        return Err(lines.wrong("needs '%%MatrixMarket matrix coordinate real general' (or symmetric)"));
    };
    for (what, found, read) in [
        ("object", object, "matrix"),
        ("format", format, "coordinate"),
        ("type of entries", field, "real"),
    ] {
        if found != read {
            return Err(lines.wrong(&format!("the {what} is '{found}', needs '{read}'")));
        }
    }
    match symmetry {
        "general" => Ok(false),
        "symmetric" => Ok(true),
        other => Err(lines.wrong(&format!("the symmetry is '{other}', needs 'general' or 'symmetric'"))),
    }
}

/// Reads the line after the comments: rows, columns, number of entries.
fn size<R: BufRead>(lines: &mut Lines<'_, R>, symmetric: bool) -> Result<(usize, usize, usize), String> {
    while lines.next()? {
        let words = lines.words();
        if words.is_empty() || words[0].starts_with('%') {
            continue;
        }
        let [rows, cols, count] = words[..] else {
            return Err(lines.wrong(&format!("needs 'rows columns entries', found '{}'", words.join(" "))));
        };
        let rows = lines.index("number of rows", rows, MAX_DOF)?;
        let cols = lines.index("number of columns", cols, MAX_DOF)?;
        let count = lines.number("a number of entries", count)?;
        if symmetric && rows != cols {
            return Err(lines.wrong(&format!("a symmetric matrix is square, but this is {rows} x {cols}")));
        }
        return Ok((rows, cols, count));
    }
    Err(lines.wrong("the file ends before its size line"))
}

/// The lines of a file with their numbers.
struct Lines<'a, R> {
    path: &'a Path,
    text: R,
    line: String,
    number: usize,
}

impl<R: BufRead> Lines<'_, R> {
    /// Goes to the next line; `false` at the end of the file.
    fn next(&mut self) -> Result<bool, String> {
        self.line.clear();
        match self.text.read_line(&mut self.line) {
            Ok(0) => Ok(false),
            Ok(_) => {
                self.number += 1;
                Ok(true)
            }
            Err(e) => {
                self.number += 1;
                Err(self.wrong(&format!("cannot be read: {e}")))
            }
        }
    }

    fn words(&self) -> Vec<&str> {
        self.line.split_ascii_whitespace().collect()
    }

    fn number<T: FromStr>(&self, needs: &str, word: &str) -> Result<T, String> {
        word.parse()
            .map_err(|_| self.wrong(&format!("'{word}' is not {needs}")))
    }

    fn index(&self, what: &str, word: &str, last: usize) -> Result<usize, String> {
        match word.parse() {
            Ok(index) if (1..=last).contains(&index) => Ok(index),
            _ => Err(self.wrong(&format!("{what} is '{word}', needs 1 .. {last}"))),
        }
    }

    fn wrong(&self, what: &str) -> String {
        format!("{}, line {}: {what}", self.path.display(), self.number.max(1))
    }
}
