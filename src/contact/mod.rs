//! Contacts in three rooms: [`forms`], the parts that laws are made of; [`laws`], one file or folder each; and [`described`], contacts as
//! the caller gives them.

pub mod described;
pub mod forms;
pub mod laws;

pub use described::description::Contact;
pub use forms::constants::Role;
pub use forms::law::{Form, Law};
pub use laws::ContactKind;
