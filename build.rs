//! With the feature `bindings`, writes the C header.

#[cfg(feature = "bindings")]
use std::{env, fs, path::PathBuf};

#[cfg(feature = "bindings")]
#[path = "crates/bindings/src/header.rs"]
mod header;

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    #[cfg(feature = "bindings")]
    write_header();
}

/// Writes include/hbvib.h from src/capi, where its text has changed.
#[cfg(feature = "bindings")]
fn write_header() {
    let root = PathBuf::from(variable("CARGO_MANIFEST_DIR"));
    for path in [
        "cbindgen.toml",
        "src/capi",
        "include/hbvib.h",
        "crates/bindings/src/header.rs",
        "crates/bindings/src/prologue.h",
    ] {
        println!("cargo::rerun-if-changed={path}");
    }
    let mut builder =
        cbindgen::Builder::new().with_config(cbindgen::Config::from_file(root.join("cbindgen.toml")).unwrap());
    let mut sources = Vec::new();
    for name in header::files() {
        let path = root.join(format!("src/capi/{name}.rs"));
        sources.push(fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display())));
        builder = builder.with_src(path);
    }
    let mut items = Vec::new();
    builder.generate().unwrap().write(&mut items);
    let version = ["MAJOR", "MINOR", "PATCH"].map(|part| variable(&format!("CARGO_PKG_VERSION_{part}")));
    let text = header::assemble(&String::from_utf8(items).unwrap(), &sources, &version).unwrap();
    let path = root.join("include/hbvib.h");
    if fs::read_to_string(&path).ok().as_ref() != Some(&text) {
        fs::write(path, text).unwrap();
    }
}

#[cfg(feature = "bindings")]
fn variable(name: &str) -> String {
    env::var(name).unwrap_or_default()
}
