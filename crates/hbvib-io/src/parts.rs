//! The matrices of one model from several files: rows are brought to one order by node and direction, and sizes compared.

use crate::Result;
use crate::error::Error;
use crate::matrix::{Dof, Matrices, Matrix};
use crate::read::read;
use std::collections::HashMap;
use std::path::Path;

/// Files of one model. A file under the name of its matrix holds that one alone, and goes before `matrices`.
#[derive(Clone, Copy, Debug, Default)]
pub struct Files<'a> {
    /// One file that holds several matrices.
    pub matrices: Option<&'a Path>,
    /// K
    pub stiffness: Option<&'a Path>,
    /// M
    pub mass: Option<&'a Path>,
    /// C
    pub damping: Option<&'a Path>,
    /// D of structural damping iD
    pub structural: Option<&'a Path>,
}

/// Reads the matrices of one model.
///
/// Where both files name nodes and directions, rows are those of the file that has more of them: rows that the other one lacks
/// are zero, as those of nodes without mass in Abaqus.
///
/// # Errors
/// File, line and reason; files with degrees of freedom of their own; matrices of different sizes, each with its file.
pub fn read_files(files: &Files<'_>) -> Result<Matrices> {
    let mut all = Held::default();
    if let Some(path) = files.matrices {
        let found = read(path)?;
        all.dofs = found.dofs;
        all.others = found.others;
        all.doubts = found.doubts;
        let kinds = [found.stiffness, found.mass, found.damping, found.structural];
        for (kind, matrix) in kinds.into_iter().enumerate() {
            all.places[kind] = matrix.map(|matrix| (matrix, path));
        }
    }
    let named = [files.stiffness, files.mass, files.damping, files.structural];
    for (kind, path) in named.into_iter().enumerate() {
        if let Some(path) = path {
            let (matrix, dofs, doubts) = single(path)?;
            all.doubts.extend(doubts);
            all.places[kind] = None;
            all.add(kind, (matrix, dofs), path)?;
        }
    }
    all.check_sizes()?;
    let [stiffness, mass, damping, structural] = all.places.map(|place| place.map(|(matrix, _)| matrix));
    Ok(Matrices {
        stiffness,
        mass,
        damping,
        structural,
        dofs: all.dofs,
        others: all.others,
        doubts: all.doubts,
    })
}

/// Names of matrices in the order of [`Held::places`].
const NAMES: [&str; 4] = ["stiffness", "mass", "damping", "structural"];

#[derive(Default)]
struct Held<'a> {
    places: [Option<(Matrix, &'a Path)>; 4],
    dofs: Vec<Dof>,
    others: Vec<String>,
    doubts: Vec<String>,
}

/// The only matrix of a file, its degrees of freedom and doubts.
fn single(path: &Path) -> Result<(Matrix, Vec<Dof>, Vec<String>)> {
    let found = read(path)?;
    let held: Vec<&str> = found.named().map(|(name, _)| name).collect();
    if held.len() != 1 {
        let reason = format!("holds several matrices ({}); name it as `matrices`", held.join(", "));
        return Err(Error::new(path, 0, reason));
    }
    let matrix = [found.stiffness, found.mass, found.damping, found.structural];
    match matrix.into_iter().flatten().next() {
        Some(matrix) => Ok((matrix, found.dofs, found.doubts)),
        None => Err(Error::new(path, 0, "holds no matrix")),
    }
}

impl<'a> Held<'a> {
    fn add(&mut self, kind: usize, (mut matrix, dofs): (Matrix, Vec<Dof>), path: &'a Path) -> Result<()> {
        if self.dofs.is_empty() {
            self.dofs = dofs;
        } else if dofs.is_empty() {
            self.by_label(&mut matrix);
        } else if dofs != self.dofs {
            let (own, common) = (table(&dofs), table(&self.dofs));
            if let Some(missing) = dofs.iter().find(|dof| !common.contains_key(dof)) {
                if let Some(other) = self.dofs.iter().find(|dof| !own.contains_key(dof)) {
                    return Err(Error::new(
                        path,
                        0,
                        format!(
                            "names other nodes and directions than the matrices before it: {} is new, and {} is missing",
                            dof_name(*missing),
                            dof_name(*other)
                        ),
                    ));
                }
                // The new file has more rows: those before get them.
                for place in self.places.iter_mut().flatten() {
                    reorder(&mut place.0, &self.dofs, &own);
                }
                self.dofs = dofs;
            } else {
                reorder(&mut matrix, &dofs, &common);
            }
        }
        self.places[kind] = Some((matrix, path));
        Ok(())
    }

    /// Rows whose numbers are labels without a direction, as those of the matrices before are: a mass without internal nodes has no
    /// label below zero that would show it.
    fn by_label(&self, matrix: &mut Matrix) {
        let labelled = self.dofs.iter().all(|(_, direction)| *direction == 0);
        if !labelled || matrix.rows == self.dofs.len() {
            return;
        }
        let common = table(&self.dofs);
        let label = |at: u32| (i64::from(at) + 1, 0);
        if matrix
            .row
            .iter()
            .chain(&matrix.column)
            .all(|at| common.contains_key(&label(*at)))
        {
            let dofs: Vec<Dof> = (0..matrix.rows).map(|at| label(at as u32)).collect();
            reorder(matrix, &dofs, &common);
        }
    }

    fn check_sizes(&self) -> Result<()> {
        let mut first: Option<(usize, &Matrix, &Path)> = None;
        for (kind, place) in self.places.iter().enumerate() {
            let Some((matrix, path)) = place else { continue };
            let Some((other, reference, before)) = first else {
                first = Some((kind, matrix, path));
                continue;
            };
            if (matrix.rows, matrix.columns) != (reference.rows, reference.columns) {
                return Err(Error::new(
                    path,
                    0,
                    format!(
                        "{} is {} x {}, but {} in {} is {} x {}: needs matrices of one size",
                        NAMES[kind],
                        matrix.rows,
                        matrix.columns,
                        NAMES[other],
                        before.display(),
                        reference.rows,
                        reference.columns
                    ),
                ));
            }
        }
        Ok(())
    }
}

/// A degree of freedom in a sentence.
pub(crate) fn dof_name((node, direction): Dof) -> String {
    match direction {
        0 => format!("node {node}"),
        direction => format!("{node}.{direction}"),
    }
}

fn table(dofs: &[Dof]) -> HashMap<Dof, u32> {
    dofs.iter().enumerate().map(|(i, dof)| (*dof, i as u32)).collect()
}

/// Moves rows and columns to their numbers in a table that has all of them.
fn reorder(matrix: &mut Matrix, dofs: &[Dof], to: &HashMap<Dof, u32>) {
    for at in matrix.row.iter_mut().chain(&mut matrix.column) {
        *at = dofs
            .get(*at as usize)
            .and_then(|dof| to.get(dof))
            .copied()
            .unwrap_or(*at);
    }
    matrix.rows = to.len();
    matrix.columns = to.len();
}
