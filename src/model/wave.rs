//! A wave on the structure, by harmonic or by nodal diameter.

/// A wave on the structure, which determines the phase of a sector offset and the stiffness matrix.
#[derive(Clone, Copy, Debug)]
pub enum Wave {
    /// Harmonic of the engine-order wave.
    Harmonic(usize),
    /// Nodal diameter, sector s + 1 lagging.
    Diameter(usize),
}
