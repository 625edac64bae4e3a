//! Results of a point: energies, losses, loops, states and ranges of contacts.

#[path = "../common/mod.rs"]
mod common;

mod contact_inside;
mod contact_loops;
mod contact_states;
mod energy;
mod energy_of_sectors;
mod long_loops;
