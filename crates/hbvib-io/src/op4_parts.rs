//! Matrices of an OP4 file by their names, as Nastran gives them: KAA, MGG, BXX, K4XX, ...

use crate::matrix::{Matrices, Matrix};

/// Kind of a matrix.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Stiffness,
    Mass,
    Damping,
    /// Structural damping, the sum of the elements' stiffnesses times their loss factors.
    Structural,
}

/// First letters of matrices that recover results of an external superelement, and have the first letter of a mass.
const RECOVERY: [&str; 8] = ["MUG", "MES", "MEE", "MEF", "MGP", "MKN", "MQG", "MQM"];

/// The matrices of a file so far.
#[derive(Default)]
pub(crate) struct Parts {
    found: Vec<(Kind, String, Matrix)>,
    others: Vec<String>,
}

fn kind(name: &str) -> Option<Kind> {
    match name.as_bytes().first()? {
        b'K' if name.starts_with("K4") => Some(Kind::Structural),
        b'K' => Some(Kind::Stiffness),
        b'M' if RECOVERY.iter().any(|head| name.starts_with(head)) => None,
        b'M' => Some(Kind::Mass),
        b'B' => Some(Kind::Damping),
        _ => None,
    }
}

impl Parts {
    /// Takes a matrix.
    pub fn take(&mut self, name: String, matrix: Matrix) {
        match kind(&name) {
            Some(kind) => self.found.push((kind, name, matrix)),
            None => self.others.push(name),
        }
    }

    /// Lists a matrix that is of no use.
    pub fn leave_out(&mut self, name: String) {
        self.others.push(name);
    }

    /// Keeps the matrices of one set where a file has several of a kind: those of EXTSEOUT, or else those without a boundary.
    fn one_set(&mut self) {
        let repeated = (0..self.found.len()).any(|i| self.found[..i].iter().any(|other| other.0 == self.found[i].0));
        if !repeated {
            return;
        }
        for ending in ["AAX", "AA", "XX"] {
            let within = |name: &str| name.ends_with(ending);
            if self
                .found
                .iter()
                .any(|(kind, name, _)| *kind == Kind::Stiffness && within(name))
            {
                let (kept, left): (Vec<_>, Vec<_>) = core::mem::take(&mut self.found)
                    .into_iter()
                    .partition(|one| within(&one.1));
                self.others.extend(left.into_iter().map(|(_, name, _)| name));
                self.found = kept;
                return;
            }
        }
    }

    /// The matrices by kind. Nastran writes a zero of order 1 for a matrix that a superelement does not have.
    ///
    /// # Errors
    /// A sentence: no matrix of a known name, two of one kind.
    pub fn finished(mut self) -> Result<Matrices, String> {
        self.one_set();
        let largest = self.found.iter().map(|(.., matrix)| matrix.rows).max().unwrap_or(0);
        let mut all = Matrices {
            others: self.others,
            ..Matrices::default()
        };
        let mut names: Vec<(Kind, String)> = Vec::new();
        for (kind, name, matrix) in self.found {
            if matrix.rows == 1 && largest > 1 && matrix.entries() == 0 {
                all.others.push(name);
                continue;
            }
            if let Some((_, first)) = names.iter().find(|(other, _)| *other == kind) {
                return Err(format!(
                    "{first} and {name} are both a matrix of {}: needs one of each kind in a file",
                    match kind {
                        Kind::Stiffness => "stiffness (K...)",
                        Kind::Mass => "mass (M...)",
                        Kind::Damping => "damping (B...)",
                        Kind::Structural => "structural damping (K4...)",
                    }
                ));
            }
            let place = match kind {
                Kind::Stiffness => &mut all.stiffness,
                Kind::Mass => &mut all.mass,
                Kind::Damping => &mut all.damping,
                Kind::Structural => &mut all.structural,
            };
            *place = Some(matrix);
            names.push((kind, name));
        }
        if names.is_empty() {
            return Err(format!(
                "no matrix whose name begins with K, M or B; the file has {}",
                if all.others.is_empty() {
                    "none".into()
                } else {
                    all.others.join(", ")
                }
            ));
        }
        Ok(all)
    }
}
