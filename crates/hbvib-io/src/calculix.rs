//! Matrices that CalculiX writes with `SOLVER=MATRIXSTORAGE`: `job.sti` (stiffness) and `job.mas` (mass), the upper
//! triangle as row, column and value, and `job.dof` with the degrees of freedom as node.direction.

use crate::Result;
use crate::error::Error;
use crate::lines::Lines;
use crate::matrix::{Dof, Matrices, Matrix, Symmetry};
use crate::numbers::{index, real, whole};
use std::path::Path;

/// Extensions of the files of a job.
pub(crate) const EXTENSIONS: [&str; 3] = ["sti", "mas", "dof"];

/// All matrices of a job, of which `path` names one file.
///
/// # Errors
/// The line and reason; a job without degrees of freedom.
pub(crate) fn matrices(path: &Path) -> Result<Matrices> {
    let [stiffness, mass, dof] = EXTENSIONS.map(|extension| path.with_extension(extension));
    if !dof.exists() {
        return Err(Error::new(
            &dof,
            0,
            "is missing; it lists the degrees of freedom of the matrices",
        ));
    }
    let dofs = dofs(&mut Lines::open(&dof)?)?;
    let read = |path: &Path| -> Result<Option<Matrix>> {
        if path.exists() {
            matrix(&mut Lines::open(path)?, dofs.len()).map(Some)
        } else {
            Ok(None)
        }
    };
    Ok(Matrices {
        stiffness: read(&stiffness)?,
        mass: read(&mass)?,
        dofs,
        ..Matrices::default()
    })
}

fn dofs(lines: &mut Lines) -> Result<Vec<Dof>> {
    let mut dofs: Vec<Dof> = Vec::new();
    while lines.advance()? {
        let line = lines.text().trim();
        let Some((node, direction)) = line.split_once('.') else {
            return lines.fail(format_args!("{line:?}, needs node.direction"));
        };
        let dof = (
            whole(lines, Some(node), "node")?,
            whole(lines, Some(direction), "direction")?,
        );
        if dof.0 < 1 || dof.1 < 0 {
            return lines.fail(format_args!("{line:?}, needs a node from 1 and a direction from 0"));
        }
        if dofs.try_reserve(1).is_err() {
            return lines.fail("no memory for the degrees of freedom");
        }
        dofs.push(dof);
    }
    lines.refuse_cut_number()?;
    if dofs.is_empty() {
        lines.expect("a degree of freedom")?;
    }
    Ok(dofs)
}

fn matrix(lines: &mut Lines, n: usize) -> Result<Matrix> {
    let likely = lines.length() / 16;
    let mut matrix = Matrix::new(lines, (n, n), Symmetry::Symmetric, (likely, false))?;
    while lines.advance()? {
        let mut words = lines.text().split_whitespace();
        let row = index(lines, words.next(), n, "row")?;
        let column = index(lines, words.next(), n, "column")?;
        let value = real(lines, words.next(), "value")?;
        if let Some(word) = words.next() {
            return lines.fail(format_args!("{word:?} is one word too many"));
        }
        if row > column {
            return lines.fail("an entry below the diagonal, needs the upper triangle");
        }
        matrix.push(lines, row, column, (value, 0.0))?;
    }
    lines.refuse_cut_number()?;
    if matrix.entries() == 0 {
        lines.expect("an entry")?;
    }
    Ok(matrix.finished())
}
