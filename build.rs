//! Names the shared library; with the feature `bindings` also writes the C header.

use std::env;
use std::fs;
use std::path::PathBuf;

#[cfg(feature = "bindings")]
#[path = "crates/bindings/src/header.rs"]
mod header;

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    #[cfg(feature = "bindings")]
    write_header();
    name_library();
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

/// Gives an ELF library its SONAME, and the link of that name which the loader looks for when the
/// library is used from this checkout. cargo-c does both by itself.
fn name_library() {
    let elf = matches!(
        variable("CARGO_CFG_TARGET_OS").as_str(),
        "linux" | "android" | "freebsd" | "netbsd" | "openbsd" | "dragonfly"
    );
    if !elf || env::var_os("CARGO_FEATURE_CAPI").is_some() {
        return;
    }
    // Before 1.0 every minor version may change the interface.
    let major = variable("CARGO_PKG_VERSION_MAJOR");
    let minor = variable("CARGO_PKG_VERSION_MINOR");
    let soname = format!("libhbvib.so.{major}.{minor}");
    println!("cargo::rustc-cdylib-link-arg=-Wl,-soname,{soname}");

    #[cfg(unix)]
    {
        let out = PathBuf::from(variable("OUT_DIR"));
        let root = variable("CARGO_MANIFEST_DIR");
        // OUT_DIR is <target>/<profile>/build/<package>/out.
        if let (true, Some(profile)) = (out.starts_with(root), out.ancestors().nth(3)) {
            let link = profile.join(&soname);
            if fs::symlink_metadata(&link).is_err() {
                // The loader reports a missing link; it is no reason to fail here.
                let _ = std::os::unix::fs::symlink("libhbvib.so", link);
            }
        }
    }
}

fn variable(name: &str) -> String {
    env::var(name).unwrap_or_default()
}
