//! Readers of matrices that finite-element programs write: Matrix Market (also gzipped), Abaqus `*MATRIX GENERATE`,
//! CalculiX matrix storage, Harwell-Boeing text, Nastran OP4.
//!
//! All of them are strict: a line that is not understood is an error that names file, line and reason; NaN and infinite
//! entries are refused; sizes are compared with the length of the file before memory is requested for them.

#![warn(unsafe_code)]

mod abaqus;
mod calculix;
#[allow(unsafe_code, reason = "the C interface")]
mod capi;
mod consistency;
mod directions;
mod error;
mod harwell_boeing;
mod lines;
mod matrix;
mod matrix_market;
mod nodes;
mod numbers;
mod op4;
mod op4_binary;
mod op4_parts;
mod parts;
mod read;
mod rotations;
mod rows;
mod unreadable;

pub use consistency::{Report, report, report_with};
pub use error::Error;
pub use matrix::{Dof, Matrices, Matrix, Symmetry};
pub use parts::{Files, read_files};
pub use read::read;

/// Result with the crate's [`Error`].
pub type Result<T> = core::result::Result<T, Error>;
