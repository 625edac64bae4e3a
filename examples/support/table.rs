//! Strict reader of tables of comma-separated numbers with one line of column names.
#![allow(dead_code, reason = "each example uses a part of this module")]

use std::fs;
use std::path::{Path, PathBuf};

/// A table whose cells are still text.
#[derive(Clone, Debug)]
pub struct Table {
    path: PathBuf,
    columns: Vec<String>,
    rows: Vec<Row>,
}

#[derive(Clone, Debug)]
struct Row {
    line: usize,
    cells: Vec<String>,
}

impl Table {
    /// Reads a file; blank lines are skipped.
    ///
    /// # Errors
    ///
    /// A sentence naming the file and the line.
    pub fn read(path: &Path) -> Result<Self, String> {
        let text = fs::read_to_string(path).map_err(|e| format!("{}: cannot be read: {e}", path.display()))?;
        let cells = |line: &str| line.split(',').map(|cell| cell.trim().to_owned()).collect::<Vec<_>>();
        let mut lines = text.lines().enumerate().filter(|l| !l.1.trim().is_empty());
        let Some((_, header)) = lines.next() else {
            return Err(format!("{}, line 1: the file is empty", path.display()));
        };
        let columns = cells(header);
        let mut rows = Vec::new();
        for (i, text) in lines {
            let row = Row {
                line: i + 1,
                cells: cells(text),
            };
            if row.cells.len() != columns.len() {
                return Err(format!(
                    "{}, line {}: has {} cells, needs {} as in the line of column names",
                    path.display(),
                    row.line,
                    row.cells.len(),
                    columns.len()
                ));
            }
            rows.push(row);
        }
        if rows.is_empty() {
            return Err(format!("{}: has no rows below its column names", path.display()));
        }
        let path = path.to_owned();
        Ok(Self { path, columns, rows })
    }

    /// Number of rows.
    pub fn len(&self) -> usize {
        self.rows.len()
    }

    /// A cell as a finite number.
    ///
    /// # Errors
    ///
    /// A sentence naming the file, the line and the column.
    pub fn number(&self, row: usize, column: &str) -> Result<f64, String> {
        let cell = self.cell(row, column)?;
        match cell.parse::<f64>() {
            Ok(number) if number.is_finite() => Ok(number),
            _ => Err(self.wrong(row, &format!("column {column} is '{cell}', needs a finite number"))),
        }
    }

    /// A cell as an index in 0 .. `count`.
    ///
    /// # Errors
    ///
    /// As [`Self::number`].
    pub fn index(&self, row: usize, column: &str, count: usize) -> Result<usize, String> {
        let cell = self.cell(row, column)?;
        match cell.parse() {
            Ok(index) if index < count => Ok(index),
            _ => Err(self.wrong(
                row,
                &format!("column {column} is '{cell}', needs an index 0 .. {}", count - 1),
            )),
        }
    }

    /// The sentence for a defect in a row.
    pub fn wrong(&self, row: usize, what: &str) -> String {
        format!("{}, line {}: {what}", self.path.display(), self.rows[row].line)
    }

    fn cell(&self, row: usize, column: &str) -> Result<&str, String> {
        match self.columns.iter().position(|c| c == column) {
            Some(i) => Ok(&self.rows[row].cells[i]),
            None => Err(format!("{}, line 1: has no column {column}", self.path.display())),
        }
    }
}
