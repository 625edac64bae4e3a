//! Contacts: their description by the caller, and the laws that they obey.

pub mod constants;
mod constructors;
mod contact_checks;
pub mod contact_state;
pub mod coupled_search;
mod description;
pub mod force_derivative;
pub mod law;
pub mod laws;
pub mod linearisation;
pub mod march;
pub mod onset;
pub mod patch;
pub mod piece;
pub mod plane_path;
pub mod radau;
pub mod relative_motion;
pub mod rigid_point;
pub mod samples;
mod saved_contact;
pub mod time_piece;

pub use constants::Role;
pub use description::Contact;
pub use law::{Form, Law};
pub use laws::registry::ContactKind;
