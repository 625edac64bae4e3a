//! Numerics under hbvib: linear algebra, real Fourier series, errors with fallible memory, and the interrupt that every
//! long loop asks. Nothing here knows a model, a contact or a branch.
//!
//! Rooms, from the lowest: [`shortage`] (the note of a request that was served from a reserve), [`error`] (statuses, sentences,
//! vectors that report a shortage), [`interrupt`], [`roots`] (and minima of functions of one variable), [`linalg`],
//! [`fourier`]. The interface is that of the crate hbvib, which
//! re-exports what its users need; this crate follows it without notice.

#![deny(unsafe_code)]

pub mod error;
pub mod fourier;
pub mod interrupt;
pub mod linalg;
pub mod roots;
pub mod shortage;
