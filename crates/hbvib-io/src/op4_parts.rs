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

    /// The matrices by kind. Nastran writes a zero of order 1 for a matrix that a superelement does not have.
    ///
    /// # Errors
    /// A sentence: no matrix of a known name, two of one kind.
    pub fn finished(self) -> Result<Matrices, String> {
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
