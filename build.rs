//! Writes the C header and names the shared library.

use std::env;
use std::fs;
use std::path::{Path, PathBuf};

/// The files with exported items, in the order of the header.
const SOURCES: &[&str] = &[
    "types",
    "boundary",
    "matrix",
    "model",
    "counting",
    "contact_types",
    "contact",
    "tables",
    "user_force",
    "jacobian",
    "elements",
    "patch",
    "solve",
    "mode",
    "results",
    "special",
    "energy",
    "contact_results",
    "mode_results",
    "synthesis",
    "residual",
    "time",
    "verify",
];

fn main() {
    for path in ["build.rs", "cbindgen.toml", "Cargo.toml", "src/capi", "include/hbvib.h"] {
        println!("cargo::rerun-if-changed={path}");
    }
    write_header();
    name_library();
}

/// A user's build must not fail because a header cannot be written (the sources may lie in a
/// read-only place), so every trouble here is a warning.
fn write_header() {
    let root = PathBuf::from(variable("CARGO_MANIFEST_DIR"));
    let header = root.join("include/hbvib.h");
    let text = match header_text(&root) {
        Ok(text) => text,
        Err(error) => {
            println!("cargo::warning=include/hbvib.h was not checked: {error}");
            return;
        }
    };
    if fs::read(&header).is_ok_and(|old| old == text) {
        return;
    }
    let written = fs::create_dir_all(root.join("include")).and_then(|()| fs::write(&header, text));
    if let Err(error) = written {
        println!("cargo::warning=include/hbvib.h is out of date and cannot be written: {error}");
    }
}

fn header_text(root: &Path) -> Result<Vec<u8>, Box<dyn std::error::Error>> {
    let mut config = cbindgen::Config::from_file(root.join("cbindgen.toml"))?;
    config.after_includes = Some(format!(
        "\n#define HBVIB_VERSION_MAJOR {}\n#define HBVIB_VERSION_MINOR {}\n#define HBVIB_VERSION_PATCH {}\n\n\
         /// A flag that another thread or a signal handler may set while a call runs.\n\
         typedef volatile int32_t hbvib_cancel_flag;",
        variable("CARGO_PKG_VERSION_MAJOR"),
        variable("CARGO_PKG_VERSION_MINOR"),
        variable("CARGO_PKG_VERSION_PATCH"),
    ));
    let mut builder = cbindgen::Builder::new().with_config(config);
    for name in SOURCES {
        builder = builder.with_src(root.join(format!("src/capi/{name}.rs")));
    }
    let mut text = Vec::new();
    builder.generate()?.write(&mut text);
    Ok(text)
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
                // A missing link is told by the loader; it is no reason to fail here.
                let _ = std::os::unix::fs::symlink("libhbvib.so", link);
            }
        }
    }
}

fn variable(name: &str) -> String {
    env::var(name).unwrap_or_default()
}
