//! Writes everything that follows from the C declarations in src/capi. One command, for developers and for CI:
//!
//! ```text
//! cargo run -p hbvib-bindings
//! ```
//!
//! It first runs cargo to check the library with its feature `bindings`, whose build script writes `include/hbvib.h`,
//! and to build the library without it, as users do. Then it reads the header and, from the shared library, the
//! defaults of its structs, and writes the generated parts of the Fortran and Python modules and of the tests. These
//! parts are between the lines `BEGIN GENERATED` and `END GENERATED`; the rest of these files is written by hand.
//!
//! `cargo run -p hbvib-bindings -- from-header` takes the header as it is, where a build with the feature `bindings` has just written it.
//!
//! `cargo run -p hbvib-bindings -- rust-api` documents the library and lists its public Rust interface in `docs/rust-api.txt`.

mod declarations;
mod foreign;
mod fortran;
// build.rs of the library uses this module; its tests run here.
#[cfg(test)]
mod header;
mod julia;
mod layout;
#[cfg(unix)]
mod library;
mod lists;
mod mex;
mod python;
mod python_examples;
mod python_types;
mod regions;
mod rust_api;

use declarations::{Declarations, Result};
use regions::Regions;
use std::env;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

fn main() {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let written = match &arguments[..] {
        [] => write_header().and_then(|()| write()),
        [one] if one == "from-header" => write(),
        [one] if one == "rust-api" => write_rust_api(),
        _ => Err("needs no argument, or one of from-header and rust-api".into()),
    };
    if let Err(error) = written {
        eprintln!("error: {error}");
        std::process::exit(1);
    }
}

/// The checkout.
fn checkout() -> &'static Path {
    let own = Path::new(env!("CARGO_MANIFEST_DIR"));
    own.ancestors().nth(2).unwrap_or(Path::new(""))
}

/// Writes the list of the public Rust interface.
fn write_rust_api() -> Result<()> {
    let root = checkout();
    // Pages of items that are gone would stay.
    let pages = target()?.join("doc/hbvib");
    if pages.exists() {
        fs::remove_dir_all(&pages).map_err(|error| format!("{}: {error}", pages.display()))?;
    }
    // With the features of the lints, which have checked all that these pages need: macros whose features differ would have it checked anew.
    cargo(
        root,
        &[
            "doc",
            "--release",
            "--workspace",
            "--no-deps",
            "--features",
            "hbvib/bindings",
        ],
    )?;
    let path = root.join("docs/rust-api.txt");
    let old = fs::read_to_string(&path).unwrap_or_default();
    replace(&path, &old, &rust_api::list(&pages)?)
}

/// Writes the header, by the build script of the library.
fn write_header() -> Result<()> {
    let check = ["check", "--release", "-p", "hbvib", "--lib", "--features", "bindings"];
    cargo(checkout(), &check)
}

/// Writes what follows from the header.
fn write() -> Result<()> {
    let root = checkout();
    cargo(root, &["build", "--release", "--lib"])?;
    let all = Declarations::parse(&read(&root.join("include/hbvib.h"))?)?;
    let defaults = defaults(&all)?;
    let (calls, layouts) = fortran::layouts(&all)?;
    let parts = [
        ("include/hbvib.f90", vec![fortran::module(&all, &defaults)?]),
        ("include/hbvib/_c.py", vec![python::module(&all)?]),
        ("include/hbvib/_types.py", vec![python_types::module(&all, &defaults)?]),
        ("include/hbvib_plain.h", vec![foreign::plain_header(&all)]),
        ("packaging/julia/src/raw.jl", vec![julia::raw(&all)?]),
        ("matlab/hbvib_mex.c", vec![mex::gateway(&all)?]),
        ("docs/foreign-calls.md", vec![foreign::tables(&all, &defaults)?]),
        ("tests/programs/layout.rs", vec![lists::layouts(&all)]),
        ("tests/languages/fortran/layout.f90", vec![calls, layouts]),
    ];
    for (path, texts) in parts {
        let path = root.join(path);
        let old = read(&path)?;
        let new = Regions::of(&old)
            .and_then(|regions| regions.filled(&texts))
            .map_err(|error| format!("{}: {error}", path.display()))?;
        replace(&path, &old, &new)?;
    }
    let path = root.join("tests/c_abi/symbols.txt");
    let old = fs::read_to_string(&path).unwrap_or_default();
    replace(&path, &old, &lists::symbols(&all))
}

/// Runs cargo in the checkout.
fn cargo(root: &Path, arguments: &[&str]) -> Result<()> {
    let program = env::var_os("CARGO").unwrap_or("cargo".into());
    let status = Command::new(program).args(arguments).current_dir(root).status();
    match status {
        Ok(status) if status.success() => Ok(()),
        Ok(status) => Err(format!("cargo {} failed, {status}", arguments.join(" "))),
        Err(error) => Err(format!("cargo: {error}")),
    }
}

fn read(path: &Path) -> Result<String> {
    fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()))
}

fn replace(path: &Path, old: &str, new: &str) -> Result<()> {
    if old == new {
        return Ok(());
    }
    println!("writing {}", path.display());
    fs::write(path, new).map_err(|error| format!("{}: {error}", path.display()))
}

#[cfg(unix)]
fn defaults(all: &Declarations) -> Result<layout::Defaults> {
    let path = shared_library()?;
    let library = library::Library::open(&path)?;
    layout::defaults(all, |name, bytes| library.init(name, bytes))
}

#[cfg(not(unix))]
fn defaults(_: &Declarations) -> Result<layout::Defaults> {
    Err("the library is loaded by dlopen, which this system does not have".into())
}

/// The folder of builds, which holds that of this program.
fn target() -> Result<PathBuf> {
    let program = env::current_exe().map_err(|error| error.to_string())?;
    Ok(program.ancestors().nth(2).unwrap_or(Path::new(".")).to_owned())
}

/// The shared library in the folder of release builds, beside that of this program.
#[cfg(unix)]
fn shared_library() -> Result<PathBuf> {
    let target = target()?;
    let name = if cfg!(target_os = "macos") {
        "libhbvib.dylib"
    } else {
        "libhbvib.so"
    };
    Ok(target.join("release").join(name))
}
