//! Matrices in relative coordinates: motions of nodes are replaced by their motions relative to weighted sums of motions of others, so that a
//! contact of several weighted degrees of freedom is one of a single one with the ground.

use crate::matrix::{Dof, Matrix, Symmetry};
use crate::surface_contacts::SurfaceContact;
use std::collections::HashMap;
use std::ops::{AddAssign, Mul};

/// The change of coordinates u = T q: equal, but for rows of nodes with a contact, u_i = q_i + Σ w_j q_j.
#[derive(Clone, Debug)]
pub struct RelativeCoordinates {
    /// Row of a relative motion, with the rows and weights that are added to it.
    rows: HashMap<u32, Vec<(u32, f64)>>,
    order: usize,
}

impl RelativeCoordinates {
    /// Coordinates for contacts; directions 1 to 3 of each of their nodes that has a row become relative.
    ///
    /// # Errors
    /// A sentence: a node of the first side that another contact has on its second side, a node with a direction that the other side
    /// lacks, a node twice.
    pub fn new(dofs: &[Dof], contacts: &[SurfaceContact]) -> Result<Self, String> {
        let places: HashMap<Dof, u32> = dofs.iter().zip(0..).map(|(dof, place)| (*dof, place)).collect();
        if places.len() != dofs.len() {
            return Err("nodes have several rows of one direction".into());
        }
        let mut rows = HashMap::new();
        for contact in contacts {
            for direction in 1..=3 {
                let Some(&row) = places.get(&(contact.node, direction)) else {
                    continue;
                };
                let mut weights = Vec::new();
                for &(node, weight) in &contact.others {
                    let Some(&other) = places.get(&(node, direction)) else {
                        return Err(format!(
                            "node {node} has no row of direction {direction}, which node {} has",
                            contact.node
                        ));
                    };
                    weights.push((other, weight));
                }
                if rows.insert(row, weights).is_some() {
                    return Err(format!("node {} has two contacts, needs one", contact.node));
                }
            }
        }
        let both = rows.values().flatten().find(|(other, _)| rows.contains_key(other));
        if let Some((row, _)) = both {
            let (node, _) = dofs[*row as usize];
            return Err(format!(
                "node {node} is on the first side of one contact and on the second side of another"
            ));
        }
        Ok(Self {
            rows,
            order: dofs.len(),
        })
    }

    /// Coordinates from the rows and weights of coordinates that are added to the coordinate of each row, of `order` rows; they may be
    /// relative themselves.
    ///
    /// # Errors
    /// A sentence: a row beyond the order.
    pub fn composed(order: usize, rows: HashMap<u32, Vec<(u32, f64)>>) -> Result<Self, String> {
        let others = rows.values().flatten().map(|(other, _)| other);
        match rows.keys().chain(others).find(|row| **row as usize >= order) {
            Some(row) => Err(format!("row {row} of {order}")),
            None => Ok(Self { rows, order }),
        }
    }

    /// All rows that are relative motions, with the rows and weights that are added to each.
    #[must_use]
    pub fn rows(&self) -> &HashMap<u32, Vec<(u32, f64)>> {
        &self.rows
    }

    /// Whether a row is a relative motion.
    #[must_use]
    pub fn is_relative(&self, row: usize) -> bool {
        self.rows.contains_key(&(row as u32))
    }

    /// Rows and weights whose motions are added to that of a row; none for a row that is not relative.
    #[must_use]
    pub fn weights(&self, row: usize) -> &[(u32, f64)] {
        self.rows.get(&(row as u32)).map_or(&[], Vec::as_slice)
    }

    /// Motions u = T q of all rows from relative ones, in place; real or complex.
    pub fn recover<T: Copy + AddAssign + Mul<f64, Output = T>>(&self, q: &mut [T]) {
        // Coordinates that are added may be relative: all sums come before the first change.
        let parts = self
            .rows
            .iter()
            .flat_map(|(row, weights)| weights.iter().map(move |(j, w)| (*row, *j, *w)));
        let sums: Vec<(u32, T)> = parts.map(|(row, j, w)| (row, q[j as usize] * w)).collect();
        for (row, part) in sums {
            q[row as usize] += part;
        }
    }

    /// Forces Tᵀ f on the coordinates from those on rows, in place.
    pub fn project(&self, f: &mut [f64]) {
        let forces: Vec<(&Vec<(u32, f64)>, f64)> = self.rows.iter().map(|(row, all)| (all, f[*row as usize])).collect();
        for (weights, force) in forces {
            for (j, w) in weights {
                f[*j as usize] += w * force;
            }
        }
    }

    /// Tᵀ A T of one matrix.
    ///
    /// # Errors
    /// A sentence: a matrix of another order.
    pub fn matrix(&self, a: &Matrix) -> Result<Matrix, String> {
        if (a.rows, a.columns) != (self.order, self.order) {
            return Err(format!(
                "a matrix of {} x {}, needs {} rows and columns",
                a.rows, a.columns, self.order
            ));
        }
        let parts = if a.is_complex { 2 } else { 1 };
        let mut sums: HashMap<(u32, u32), (f64, f64)> = HashMap::new();
        let itself = |row: u32| core::iter::once((row, 1.0));
        let spread = |row: u32| itself(row).chain(self.rows.get(&row).into_iter().flatten().copied());
        let mut add = |i: u32, j: u32, value: (f64, f64)| {
            for (row, v) in spread(i) {
                for (column, w) in spread(j) {
                    // Of two mirror images one is kept.
                    if a.symmetry == Symmetry::General || row >= column {
                        let sum = sums.entry((row, column)).or_default();
                        *sum = (sum.0 + v * w * value.0, sum.1 + v * w * value.1);
                    }
                }
            }
        };
        let mut found = Matrix::empty((a.rows, a.columns), a.symmetry, a.is_complex);
        for (k, value) in a.values.chunks_exact(parts).enumerate() {
            let (i, j, value) = (a.row[k], a.column[k], (value[0], value.get(1).copied().unwrap_or(0.0)));
            if !self.rows.contains_key(&i) && !self.rows.contains_key(&j) {
                // Most entries of a model stay as they are.
                if !found.add(i, j, value) {
                    return Err("no memory for the entries".into());
                }
                continue;
            }
            add(i, j, value);
            if i != j {
                match a.symmetry {
                    Symmetry::General => {}
                    Symmetry::Symmetric => add(j, i, value),
                    Symmetry::Hermitian => add(j, i, (value.0, -value.1)),
                    Symmetry::Skew => add(j, i, (-value.0, -value.1)),
                }
            }
        }
        let mut entries: Vec<((u32, u32), (f64, f64))> = sums.into_iter().collect();
        entries.sort_unstable_by_key(|(place, _)| *place);
        for ((row, column), value) in entries {
            if !found.add(row, column, value) {
                return Err("no memory for the entries".into());
            }
        }
        Ok(found.finished())
    }
}
