//! Memory by requests that can fail, and numbers of vertices in 32 bits.

use core::fmt;

/// A request for memory failed; everything that the call had is freed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct OutOfMemory;

impl fmt::Display for OutOfMemory {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("out of memory for an order of elimination")
    }
}

impl core::error::Error for OutOfMemory {}

/// Outcome of what needs memory alone.
pub(crate) type Result<T> = core::result::Result<T, OutOfMemory>;

/// Number of a vertex: 32 bits are half the memory of a graph.
pub(crate) type Vertex = u32;

/// Number of a vertex in 32 bits.
#[inline]
pub(crate) fn narrow(vertex: usize) -> Vertex {
    vertex as Vertex
}

/// Number of a vertex as `usize`.
#[inline]
pub(crate) fn wide(vertex: Vertex) -> usize {
    vertex as usize
}

/// An empty array with room for so many values.
pub(crate) fn try_room<T>(len: usize) -> Result<Vec<T>> {
    let mut values = Vec::new();
    values.try_reserve_exact(len).map_err(|_| OutOfMemory)?;
    Ok(values)
}

/// An array of one value many times.
pub(crate) fn try_vec<T: Clone>(len: usize, value: T) -> Result<Vec<T>> {
    let mut values = try_room(len)?;
    values.resize(len, value);
    Ok(values)
}

/// Appends a value.
pub(crate) fn try_push<T>(values: &mut Vec<T>, value: T) -> Result<()> {
    values.try_reserve(1).map_err(|_| OutOfMemory)?;
    values.push(value);
    Ok(())
}
