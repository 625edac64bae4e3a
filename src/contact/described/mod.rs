//! Contacts as the caller describes them, one by one or many at once: by [`patch`]es and [`iwan`] joints.

mod constructors;
mod contact_checks;
pub mod description;
pub mod iwan;
pub mod patch;
pub mod relative_motion;
pub mod rigid_point;
pub(crate) mod saved_contact;
