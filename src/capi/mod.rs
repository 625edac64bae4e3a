//! The C interface: `include/hbvib.h` is generated from this module, and the declarations of the other languages from
//! the header (`crates/bindings`).
//!
//! Infrastructure stands in `crossing`: `boundary` turns panics and errors into statuses, `handles` turns objects into numbers
//! that cannot be confused, `versioned_struct` has the rules by which structs cross the boundary, `arrays`, `indices` and
//! `stored_point` check the pointers and numbers of the caller, `reserve` is the allocator, `thread_memory` what a thread
//! keeps, `thread_start` how one is started, `process` is for fork and unloading, `float_environment` separates the settings
//! of the floating-point unit. The other rooms hold the sections of the header (`crates/bindings/src/header.rs` has their
//! order), and a file lists its items in the order of the header. No file here contains numerics.
//!
//! The doc comments of exported items are written for the reader of the header, and the generator reads four words
//! in the description of a pointer: an argument that may be `NULL` states that, an array of `complex` numbers too,
//! an `int64_t` array that a function fills receives `numbers`, and several structs are an `array of` them.

#![allow(unsafe_code)]
// The comments become those of a C header, whose contract ("Conventions") is at its top.
#![allow(clippy::missing_safety_doc, clippy::doc_markdown)]

mod contact_calls;
mod crossing;
mod design;
mod mode_calls;
mod reading;
mod solving;
mod structures;
mod time_calls;
mod version_and_errors;

pub use contact_calls::*;
pub use crossing::{process, reserve, thread_memory, thread_start};
pub use design::*;
pub use mode_calls::*;
pub use reading::*;
pub use solving::*;
pub use structures::*;
pub use time_calls::*;
pub use version_and_errors::*;
