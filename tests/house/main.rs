//! The sources themselves: what may import what, and the index of the tests.

mod index;
mod language;
mod layering;
mod python;
mod rust_interface;
mod supply;
mod thresholds;
