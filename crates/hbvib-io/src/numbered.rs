//! Numbers of degrees of freedom in the order in which a file names them first.

use crate::Result;
use crate::lines::Lines;
use crate::matrix::Dof;
use std::collections::HashMap;

/// Degrees of freedom by number, and numbers by degree of freedom.
#[derive(Default)]
pub(crate) struct Numbered {
    dofs: Vec<Dof>,
    numbers: HashMap<Dof, u32>,
}

impl Numbered {
    /// The number of a degree of freedom, a new one if it has none.
    ///
    /// # Errors
    /// Memory.
    pub fn number(&mut self, lines: &Lines, dof: Dof) -> Result<u32> {
        if let Some(number) = self.numbers.get(&dof) {
            return Ok(*number);
        }
        if self.dofs.try_reserve(1).is_err() || self.numbers.try_reserve(1).is_err() {
            return lines.fail("no memory for the degrees of freedom");
        }
        let number = self.dofs.len() as u32;
        self.numbers.insert(dof, number);
        self.dofs.push(dof);
        Ok(number)
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.dofs.len()
    }

    /// Those that are used, sorted by node and direction, and the place of each number among them.
    pub fn sorted(self, used: &[bool]) -> (Vec<Dof>, Vec<u32>) {
        let mut order: Vec<u32> = (0..self.dofs.len() as u32).filter(|i| used[*i as usize]).collect();
        order.sort_by_key(|&i| self.dofs[i as usize]);
        let mut places = vec![0; self.dofs.len()];
        for (to, &from) in order.iter().enumerate() {
            places[from as usize] = to as u32;
        }
        (order.into_iter().map(|i| self.dofs[i as usize]).collect(), places)
    }
}
