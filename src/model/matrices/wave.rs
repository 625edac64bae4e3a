//! A wave on the structure, by harmonic or by nodal diameter.

/// A wave on the structure. It determines the phase between sectors, and the stiffness matrix.
#[derive(Clone, Copy, Debug)]
pub enum Wave {
    /// The wave of this harmonic under the engine order.
    Harmonic(usize),
    /// The wave of a signed nodal diameter d, modulo N: sector s + 1 lags by 2πd/N, so that a negative d travels the
    /// other way.
    Diameter(i64),
}
