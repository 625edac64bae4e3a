//! Writes a superelement as `*USER ELEMENT` with `*MATRIX`, in the form that `*SUBSTRUCTURE MATRIX OUTPUT` of CalculiX and Abaqus has:
//! nodes and directions of the rows, then lower triangles row by row. Numbers have at most twenty characters, as Abaqus reads
//! them, which are thirteen to fifteen digits.

use crate::Result;
use crate::columns::Columns;
use crate::error::Error;
use crate::matrix::{Dof, Matrices};
use crate::number_text::fitted;
use crate::output_file::{OutputFile, order};
use std::path::Path;

/// Most characters of a number.
const WIDTH: usize = 20;

/// Numbers, or nodes, of a line.
const PER_LINE: usize = 4;

/// Writes stiffness and mass of one model. Rows without nodes are direction 1 of nodes from 1.
///
/// # Errors
/// Damping, which the format does not have; complex numbers; no matrix, matrices of different sizes, numbers that are not finite; the
/// reason of the system.
pub fn write_user_element(path: &Path, matrices: &Matrices) -> Result<()> {
    let n = order(path, matrices)?;
    if matrices.damping.is_some() || matrices.structural.is_some() {
        let reason = "*MATRIX holds stiffness and mass alone: leave damping out, or write OP4, DMIG or .npz";
        return Err(Error::new(path, 0, reason));
    }
    let dofs: Vec<Dof> = if matrices.dofs.is_empty() {
        (1..=n as i64).map(|node| (node, 1)).collect()
    } else {
        matrices.dofs.clone()
    };
    if let Some((node, _)) = dofs.iter().find(|(_, direction)| *direction < 1) {
        return Err(Error::new(
            path,
            0,
            format!("node {node} has no direction: *USER ELEMENT needs one from 1"),
        ));
    }
    let given = [("STIFFNESS", &matrices.stiffness), ("MASS", &matrices.mass)];
    let given: Vec<_> = given
        .into_iter()
        .filter_map(|(name, a)| a.as_ref().map(|a| (name, a)))
        .collect();
    if given.iter().any(|(_, a)| a.is_complex) {
        return Err(Error::new(
            path,
            0,
            "*MATRIX holds real numbers alone: write OP4, DMIG or .npz",
        ));
    }
    let columns: Vec<(&str, Columns)> = given.iter().map(|(name, a)| (*name, Columns::whole(a))).collect();
    let symmetric = columns.iter().all(|(_, columns)| columns.is_symmetric());
    let places = places(&dofs);
    let mut file = OutputFile::create(path)?;
    let unsymmetric = if symmetric { "" } else { ",UNSYMM" };
    file.put(format!(
        "**\n** SUPERELEMENT\n*USER ELEMENT,NODES={:>10},LINEAR{unsymmetric}\n** ELEMENT NODES\n",
        places.len()
    ))?;
    for nodes in places.chunks(10) {
        let nodes: Vec<String> = nodes.iter().map(|(node, _)| format!("{node:>10},")).collect();
        file.put(format!("**{}\n", nodes.concat()))?;
    }
    for (position, (_, directions)) in places.iter().enumerate() {
        let same = position > 0 && places[position - 1].1 == *directions;
        if same {
            continue;
        }
        let directions: Vec<String> = directions.iter().map(|d| format!("{d:>10}")).collect();
        let list = directions.join(",");
        file.put(match position {
            0 => format!("{list}\n"),
            _ => format!("{:>10},{list}\n", position + 1),
        })?;
    }
    for (name, columns) in &columns {
        file.put(format!("*MATRIX,TYPE={name}\n"))?;
        for j in 0..n {
            let mut column = vec![0.0; if symmetric { j + 1 } else { n }];
            for &(i, value, _) in columns.column(j) {
                if let Some(place) = column.get_mut(i as usize) {
                    *place = value;
                }
            }
            for line in column.chunks(PER_LINE) {
                let line: Vec<String> = line
                    .iter()
                    .map(|v| format!("{:>WIDTH$},", fitted(*v, WIDTH, 'E')))
                    .collect();
                file.put(line.concat() + "\n")?;
            }
        }
    }
    file.finish()
}

/// Nodes one after another with the directions of each: rows of one node that follow each other are one place.
fn places(dofs: &[Dof]) -> Vec<(i64, Vec<i64>)> {
    let mut all: Vec<(i64, Vec<i64>)> = Vec::new();
    for &(node, direction) in dofs {
        match all.last_mut() {
            // Directions of a place ascend.
            Some((last, directions)) if *last == node && directions.last().is_some_and(|d| *d < direction) => {
                directions.push(direction);
            }
            _ => all.push((node, vec![direction])),
        }
    }
    all
}
