//! Programs of users: the C interface, five languages, layouts, the README and the book, and the examples.

#[path = "../common/mod.rs"]
mod common;

mod book;
mod book_sessions;
mod c_abi;
mod campbell_example;
mod designs;
mod flutter_example;
mod languages;
mod layout;
mod native;
mod ring_damper_example;
mod ring_damper_mode;
mod wheel;
