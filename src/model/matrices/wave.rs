//! A wave on the structure, by harmonic or by nodal diameter.

/// A wave on the structure, which determines the phase of a sector offset and the stiffness matrix.
#[derive(Clone, Copy, Debug)]
pub enum Wave {
    /// Harmonic of the engine-order wave.
    Harmonic(usize),
    /// Signed nodal diameter d, modulo N: sector s + 1 lags by 2πd/N, so that a negative one travels the other way.
    Diameter(i64),
}
