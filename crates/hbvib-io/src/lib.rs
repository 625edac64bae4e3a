//! Readers of matrices that finite-element programs write: Matrix Market (also gzipped), Abaqus `*MATRIX GENERATE`,
//! CalculiX matrix storage, superelements as `*USER ELEMENT`, Harwell-Boeing text, Nastran OP4 and DMIG, NumPy and scipy;
//! and writers of superelements.
//!
//! All of them are strict: a line that is not understood is an error that names file, line and reason; NaN and infinite
//! entries are refused; sizes are compared with the length of the file before memory is requested for them.

#![warn(unsafe_code)]

mod abaqus;
mod ansys_full;
mod bytes_read;
mod calculix;
#[allow(unsafe_code, reason = "the C interface")]
mod capi;
#[allow(unsafe_code, reason = "the C interface")]
mod capi_write;
mod columns;
mod consistency;
mod consistency_report;
mod directions;
mod dmig;
mod error;
mod face_overlap;
mod face_search;
mod face_shapes;
mod harwell_boeing;
mod lines;
mod matlab;
#[cfg(feature = "hdf5")]
mod matlab_hdf5;
mod matrix;
mod matrix_market;
mod named_matrices;
mod nodes;
mod npy;
mod number_array;
mod number_arrays;
mod number_text;
mod numbered;
mod numbers;
mod numpy_archive;
mod op4;
mod op4_binary;
mod op4_parts;
mod output_file;
mod parts;
mod projected_points;
mod read;
mod relative_coordinates;
mod rotations;
mod rows;
mod solid_faces;
mod surface;
mod surface_contacts;
mod universal;
mod universal_data;
mod universal_lines;
mod unreadable;
mod user_element;
mod vectors;
mod write;
mod write_dmig;
mod write_market;
mod write_npz;
mod write_op4;
mod write_universal;
mod write_user_element;
mod zip_archive;

pub use consistency::{report, report_stressed, report_with};
pub use consistency_report::Report;
pub use error::Error;
pub use matrix::{Dof, Matrices, Matrix, Symmetry};
pub use number_array::NumberArray;
pub use number_arrays::read_number_arrays;
pub use parts::{Files, read_files};
pub use projected_points::{ProjectedPoint, projected_points};
pub use read::read;
pub use relative_coordinates::RelativeCoordinates;
pub use solid_faces::{bodies, faces_of_set, outer_faces};
pub use surface::{NodalAreas, Surface};
pub use surface_contacts::{SurfaceContact, node_contacts, surface_contacts};
pub use universal::{Universal, UniversalElement, UniversalNode, read_universal};
pub use universal_data::{Function, Shape};
pub use write::{Format, write};
pub use write_dmig::write_dmig;
pub use write_market::write_matrix_market;
pub use write_npz::{write_npz, write_scipy_npz};
pub use write_op4::{Op4Form, write_op4};
pub use write_universal::write_universal;
pub use write_user_element::write_user_element;

/// Result with the crate's [`Error`].
pub type Result<T> = core::result::Result<T, Error>;
