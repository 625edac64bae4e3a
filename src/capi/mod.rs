//! The C interface: `include/hbvib.h` is generated from this module.
//!
//! [`boundary`] keeps panics in and errors out, `handles` turns objects into numbers that cannot
//! be mistaken, [`types`] holds the constants and structs of the header, `sized` the
//! rules by which structs cross; the functions themselves
//! are grouped by object. Nothing is computed here. The comments on exported items are written for
//! the reader of the header.

#![allow(unsafe_code)]
// The comments become those of a C header, whose contract ("Conventions") stands at its top.
#![allow(clippy::missing_safety_doc, clippy::doc_markdown)]

mod arithmetic;
pub mod boundary;
pub mod contact;
pub mod contact_results;
pub mod contact_types;
pub mod counting;
pub mod elements;
pub mod energy;
mod handles;
pub mod jacobian;
pub mod matrix;
pub mod mode;
pub mod mode_results;
pub mod model;
pub mod patch;
pub mod residual;
pub mod results;
mod sized;
pub mod solve;
pub mod special;
pub mod synthesis;
pub mod tables;
pub mod time;
mod told;
pub mod types;
pub mod user_force;
pub mod verify;
