//! The sources themselves: what may import what, and the index of the tests.

mod index;
mod language;
mod layering;
mod pairs;
mod python;
mod rust_interface;
mod sizes;
mod supply;
mod thresholds;

/// The path of the checkout, which this package lies in.
fn root() -> &'static std::path::Path {
    std::path::Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap()
}
