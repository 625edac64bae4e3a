//! Static steps of finite-element programs: contacts at rest, prestressed matrices.

pub(crate) mod calculix_results;
pub(crate) mod calculix_run;
pub(crate) mod ccx_deck;
pub(crate) mod prestress;
pub(crate) mod prestress_decks;
pub(crate) mod static_contacts;
pub(crate) mod static_states;
