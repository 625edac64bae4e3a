//! Orders of elimination of sparse symmetric matrices by nested dissection (George 1973, doi:10.1137/0710032).
//!
//! A few vertices of the graph of a matrix, a separator, divide it into two parts; these are eliminated first, each in the same
//! way, and the separator last. On meshes of n nodes the factors have O(n log n) entries in a plane and O(n^(4/3)) in space, and on
//! large meshes far fewer than by minimum degrees.
//!
//! The caller answers as a [`Host`]: it may stop the work, and orders the small pieces. Memory is requested in a way that can fail,
//! no thread is started, and equal patterns have equal orders.
//!
//! ```
//! use hbvib_dissection::{Host, OutOfMemory, order};
//!
//! /// Never stops; eliminates pieces from the first vertex to the last.
//! struct Plain;
//!
//! impl Host for Plain {
//!     type Error = OutOfMemory;
//!     fn before(&self, _operations: u64) -> Result<(), OutOfMemory> {
//!         Ok(())
//!     }
//!     fn positions(&self, starts: &[usize], _later: &[usize]) -> Result<Vec<usize>, OutOfMemory> {
//!         Ok((0..starts.len() - 1).collect())
//!     }
//! }
//!
//! // The lower triangle of a tridiagonal matrix of 1,000 rows: a path, whose middle is eliminated last.
//! let n = 1_000;
//! let starts: Vec<usize> = (0..=n).map(|j| (2 * j).min(2 * n - 1)).collect();
//! let rows: Vec<usize> = (0..n).flat_map(|j| j..(j + 2).min(n)).collect();
//! let rows_in_order = order(&starts, &rows, &Plain).unwrap();
//! assert!((400..600).contains(&rows_in_order[n - 1]));
//! ```

#![forbid(unsafe_code)]

mod graph;
mod memory;
mod nested_dissection;
mod separator;

pub use memory::OutOfMemory;
pub use nested_dissection::{Host, order};
