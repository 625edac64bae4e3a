//! Files as other programs write them are read right, or refused by a sentence with the format: see `oddities.py`.

#![cfg(target_os = "linux")]

use std::path::Path;
use std::process::Command;

#[test]
fn files_of_other_programs_are_read_right_or_their_format_is_named() {
    let own = Path::new(env!("CARGO_MANIFEST_DIR"));
    let root = own.join("../..");
    let python = root.join(".venv/bin/python");
    let deps = std::env::current_exe().unwrap().parent().unwrap().to_owned();
    let output = Command::new(if python.exists() { python } else { "python3".into() })
        .arg(own.join("tests/oddities.py"))
        .env("PYTHONDONTWRITEBYTECODE", "1")
        .env("PYTHONWARNINGS", "ignore")
        .env("HBVIB_IO_LIBRARY", deps.join("libhbvib_io.so"))
        .env("HBVIB_INCLUDE", root.join("include").canonicalize().unwrap())
        .output()
        .unwrap();
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    assert_eq!(text, "ok\n", "{}", String::from_utf8_lossy(&output.stderr));
}
