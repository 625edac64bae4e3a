//! Contacts: what a caller says of them, and the laws that they obey.

mod constructors;
mod contact_checks;
pub mod contact_state;
mod description;
pub mod hysteretic_law;
pub mod law;
pub mod laws;
pub mod memoryless_law;
pub mod patch;
pub mod relative_motion;

pub use description::{Contact, ContactKind, Role};
pub use law::{Form, Law, Piece};
