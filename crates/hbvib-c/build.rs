//! Names the shared library.

use std::env;
use std::fs;
use std::path::PathBuf;

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    name_library();
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
        let member = PathBuf::from(variable("CARGO_MANIFEST_DIR"));
        let root = member.ancestors().nth(2).unwrap_or(&member);
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
