//! Contacts in three rooms: [`forms`], the parts that laws are made of; [`laws`], one file or folder each; and [`described`], contacts as
//! the caller gives them.

pub mod described;
pub mod forms;
pub mod laws;

pub use described::description::Contact;
pub use described::{description, iwan, patch, relative_motion, rigid_point};
pub use forms::constants::Role;
pub use forms::law::{Form, Law};
pub use forms::{
    constants, contact_state, coupled_search, force_derivative, law, linearisation, march, onset, piece, plane_path,
    radau, samples, time_piece,
};
pub use laws::ContactKind;
