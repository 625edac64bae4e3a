//! Findings of the checks of matrices: facts, warnings, and cases that are counted.

/// Report on the matrices of a model.
#[derive(Clone, Debug, Default)]
pub struct Report {
    /// Totals: sizes, mass along each direction, supports.
    pub facts: Vec<String>,
    /// Values that a structure does not have, or seldom has.
    pub warnings: Vec<String>,
    /// Mass of the structure along x, y and z; empty where the directions of rows are not known.
    pub total_mass: Vec<f64>,
}

/// Counts cases, and keeps the first.
#[derive(Default)]
pub(crate) struct Cases {
    count: usize,
    first: Option<String>,
}

impl Cases {
    pub fn add(&mut self, name: impl FnOnce() -> String) {
        self.count += 1;
        self.first.get_or_insert_with(name);
    }

    /// Number of cases.
    pub fn count(&self) -> usize {
        self.count
    }

    /// A sentence from the number of cases and the first one.
    pub fn told(self, to: &mut Vec<String>, sentence: impl FnOnce(usize, &str) -> String) {
        if let Some(first) = self.first {
            to.push(sentence(self.count, &first));
        }
    }
}
