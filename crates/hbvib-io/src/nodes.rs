//! Rows of nodes: which of them are x, y and z of one node.

use crate::matrix::Dof;
use crate::rows::Rows;
use std::collections::HashMap;

/// Rows along x, y and z of each node.
pub(crate) struct Nodes {
    /// Number and rows of the nodes that have all three.
    pub full: Vec<(i64, [usize; 3])>,
    /// Node, from 0 in [`Self::full`], and direction, 0 to 2, of each row.
    pub place: Vec<Option<(usize, usize)>>,
    /// Every row belongs to a node with three rows.
    pub all_full: bool,
    /// Numbers are those of the files, not a guess.
    pub named: bool,
}

/// Share of coupled rows, and of equal directions, that show x, y, z of one node after another.
const SHOWS: f64 = 0.6;

impl Nodes {
    /// The nodes that the files name; without names three rows of each node, if the mass shows that.
    pub fn of(dofs: &[Dof], mass: Option<&Rows>, n: usize) -> Option<Self> {
        if dofs.iter().any(|(_, direction)| (1..=3).contains(direction)) {
            // A node with several rows of a direction, as of an expanded beam, is none of these.
            let mut rows: HashMap<i64, ([Option<usize>; 3], bool)> = HashMap::new();
            let mut inner = 0;
            for (i, &(node, direction)) in dofs.iter().enumerate() {
                if let direction @ 1..=3 = direction {
                    let (places, repeated) = rows.entry(node).or_default();
                    *repeated |= places[direction as usize - 1].replace(i).is_some();
                    inner += 1;
                }
            }
            let mut full: Vec<(i64, [usize; 3])> = Vec::new();
            for (node, rows) in &rows {
                if let ([Some(x), Some(y), Some(z)], false) = *rows {
                    full.push((*node, [x, y, z]));
                }
            }
            full.sort_unstable();
            let all_full = inner == n && 3 * full.len() == n;
            return Some(Self::placed(full, n, all_full, true)).filter(|nodes| !nodes.full.is_empty());
        }
        let mass = mass?;
        if !dofs.is_empty() || n < 9 || !n.is_multiple_of(3) {
            return None;
        }
        let full = (0..n / 3).map(|k| (k as i64, [3 * k, 3 * k + 1, 3 * k + 2])).collect();
        let guess = Self::placed(full, n, true, false);
        let (mut same, mut equal, mut all, mut pairs) = (0_usize, 0_usize, 0_usize, 0_usize);
        for i in 0..n {
            for (j, v) in mass.row(i).filter(|(j, v)| *j != i && *v != 0.0) {
                all += 1;
                if i % 3 != j % 3 {
                    continue;
                }
                same += 1;
                if i % 3 == 0 {
                    pairs += 1;
                    let near = |k: usize| (mass.get(i + k, j + k) - v).abs() <= 1e-6 * v.abs();
                    equal += usize::from(near(1) && near(2));
                }
            }
        }
        let shows = pairs > 0 && same as f64 >= SHOWS * all as f64 && equal as f64 >= SHOWS * pairs as f64;
        shows.then_some(guess)
    }

    fn placed(full: Vec<(i64, [usize; 3])>, n: usize, all_full: bool, named: bool) -> Self {
        let mut place = vec![None; n];
        for (k, (_, rows)) in full.iter().enumerate() {
            for (d, &i) in rows.iter().enumerate() {
                place[i] = Some((k, d));
            }
        }
        Self {
            full,
            place,
            all_full,
            named,
        }
    }

    /// A row in a sentence.
    pub fn name(&self, k: usize) -> String {
        let (number, rows) = self.full[k];
        if self.named {
            format!("node {number}")
        } else {
            format!("the node of rows {} to {}", rows[0], rows[2])
        }
    }

    /// Nodes that a node is coupled with, itself included.
    pub fn coupled(&self, a: &Rows, k: usize) -> Vec<usize> {
        self.coupled_to(a, &self.full[k].1)
    }

    /// Nodes that some rows are coupled with.
    pub fn coupled_to(&self, a: &Rows, rows: &[usize]) -> Vec<usize> {
        let mut all: Vec<usize> = rows
            .iter()
            .flat_map(|&i| a.row(i).filter(|(_, v)| *v != 0.0))
            .filter_map(|(j, _)| self.place[j].map(|(node, _)| node))
            .collect();
        all.sort_unstable();
        all.dedup();
        all
    }

    /// The 3 × 3 block between two nodes.
    pub fn block(&self, a: &Rows, k: usize, l: usize) -> [[f64; 3]; 3] {
        self.full[k].1.map(|i| self.full[l].1.map(|j| a.get(i, j)))
    }
}

/// Position of a node by its number.
pub(crate) type Positions<'a> = &'a dyn Fn(i64) -> Option<[f64; 3]>;
