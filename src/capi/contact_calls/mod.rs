//! Contacts and laws of the caller.

pub(crate) mod caller_laws;
pub(crate) mod caller_laws_check;
pub(crate) mod contacts;
pub(crate) mod contacts_batch;
pub(crate) mod contacts_damper;
pub(crate) mod contacts_described;
pub(crate) mod contacts_patch;
pub(crate) mod contacts_springs;

pub use caller_laws::*;
pub use caller_laws_check::*;
pub use contacts::*;
pub use contacts_batch::*;
pub use contacts_damper::*;
pub use contacts_described::*;
pub use contacts_patch::*;
pub use contacts_springs::*;
