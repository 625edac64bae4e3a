//! The model of a job with what its files tell of it.

use crate::meshes::node_table::Nodes;
use crate::texts::counted::counted;
use crate::texts::events;
use crate::texts::outcome::Outcome;
use hbvib::Model;
use hbvib_io::Report;
use std::ops::Range;

/// Numbers of the model's contacts for each entry of the job: its name, and a range.
pub type Names = Vec<(String, Range<usize>)>;

/// The model of a job.
pub struct Built {
    pub model: Model,
    /// Names of its contacts.
    pub names: Names,
    pub nodes: Nodes,
    /// Area of each contact, where the job gives areas.
    pub areas: Vec<Option<f64>>,
    /// Left and right node of each pair of the faces, and the distance of the right one from the image of the left one.
    pub face_pairs: Vec<(i64, i64, f64)>,
    /// Degrees of freedom of both faces.
    pub face_dofs: Vec<usize>,
    /// Degrees of freedom that do not move.
    pub fixed: Vec<usize>,
    /// Real part of the diagonal of the stiffness.
    pub stiffness_diagonal: Vec<f64>,
    /// Mass that moves with each row in a translation along its direction; empty without names of nodes.
    pub moved_mass: Vec<f64>,
    /// Report on the matrices, with what was taken as fixed or counted once.
    pub report: Report,
}

impl Built {
    /// Name of each contact: that of its entry, with the number of the pair where there are several.
    pub fn labels(&self) -> Vec<String> {
        let of = |(name, range): &(String, Range<usize>)| -> Vec<String> {
            match range.len() {
                1 => vec![name.clone()],
                pairs => (0..pairs).map(|pair| format!("{name}[{pair}]")).collect(),
            }
        };
        self.names.iter().flat_map(of).collect()
    }

    /// Tells the warnings.
    ///
    /// # Errors
    /// A sentence with their number, where they are refused.
    pub fn warn(&self, strict: bool) -> Outcome<()> {
        let warnings = &self.report.warnings;
        for warning in warnings {
            events::warning(warning);
        }
        if strict && !warnings.is_empty() {
            return Err(format!(
                "{}, which --strict refuses",
                counted(warnings.len(), "warning")
            ));
        }
        Ok(())
    }
}
