//! A bordered matrix by its parts.

/// The parts of the matrix [J·u, r·p; row].
#[derive(Clone, Copy)]
pub struct Parts<'a> {
    /// J, column-major.
    pub jacobian: &'a [f64],
    /// r
    pub column: &'a [f64],
    /// For each unknown: its column of J differs from that of the identity.
    pub active: &'a [bool],
    /// Scales of the unknowns and of the parameter: u and p.
    pub scales: (f64, f64),
    /// The row.
    pub row: &'a [f64],
}
