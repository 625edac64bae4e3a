//! Writes Nastran bulk data with DMIG, in fields of sixteen columns, with the names that EXTSEOUT gives: KAAX, MAAX, BAAX, K4AAX.
//! Numbers have ten to twelve digits.

use crate::Result;
use crate::columns::Columns;
use crate::error::Error;
use crate::matrix::{Dof, Matrices, Matrix, Symmetry};
use crate::number_text::fitted;
use crate::output_file::{OutputFile, order};
use std::path::Path;

/// Writes the matrices of one model as bulk data. Rows without nodes are scalar points from 1.
///
/// # Errors
/// Nodes or directions that Nastran does not have, no matrix, matrices of different sizes, numbers that are not finite; the reason
/// of the system.
pub fn write_dmig(path: &Path, matrices: &Matrices) -> Result<()> {
    let n = order(path, matrices)?;
    let points: Vec<Dof> = if matrices.dofs.is_empty() {
        (1..=n as i64).map(|point| (point, 0)).collect()
    } else {
        matrices.dofs.clone()
    };
    let is_point = |(node, direction): &Dof| (1..=99_999_999).contains(node) && (0..=6).contains(direction);
    if let Some((node, direction)) = points.iter().find(|dof| !is_point(dof)) {
        let reason =
            format!("node {node}, direction {direction}: DMIG needs nodes from 1 to 99999999 and directions 0 to 6");
        return Err(Error::new(path, 0, reason));
    }
    let mut sorted = points.clone();
    sorted.sort_unstable();
    if let Some(two) = sorted.windows(2).find(|two| two[0] == two[1]) {
        let reason = format!("two rows are node {}, direction {}: DMIG needs one", two[0].0, two[0].1);
        return Err(Error::new(path, 0, reason));
    }
    let mut file = OutputFile::create(path)?;
    for (kind, matrix) in matrices.named() {
        let name = match kind {
            "stiffness" => "KAAX",
            "mass" => "MAAX",
            "damping" => "BAAX",
            _ => "K4AAX",
        };
        one(&mut file, name, matrix, &points)?;
    }
    file.finish()
}

fn one(file: &mut OutputFile, name: &str, matrix: &Matrix, points: &[Dof]) -> Result<()> {
    // A symmetric matrix has one triangle; Nastran knows no other relation of mirror images.
    let whole = Columns::whole(matrix);
    let symmetric = matrix.symmetry == Symmetry::Symmetric || whole.is_symmetric();
    let form = if symmetric { 6 } else { 1 };
    let kind = if matrix.is_complex { 4 } else { 2 };
    file.put(format!("DMIG    {name:<8}{:<8}{form:<8}{kind:<8}0\n", 0))?;
    for (j, (node, direction)) in points.iter().enumerate() {
        let entries = || {
            let all = whole.column(j).iter();
            all.filter(|entry| !symmetric || entry.0 as usize >= j)
        };
        if entries().next().is_none() {
            continue;
        }
        file.put(format!("DMIG*   {name:<16}{node:>16}{direction:>16}\n"))?;
        for &(i, re, im) in entries() {
            let (node, direction) = points[i as usize];
            let value = fitted(re, 16, 'D');
            file.put(format!("*       {node:>16}{direction:>16}{value:>16}"))?;
            if matrix.is_complex {
                file.put(format!("{:>16}", fitted(im, 16, 'D')))?;
            }
            file.put("\n")?;
        }
    }
    Ok(())
}
