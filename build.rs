//! Writes the C header and names the shared library.
fn main() {}
