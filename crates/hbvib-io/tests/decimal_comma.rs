//! A C program whose locale has a decimal comma reads the numbers of one without it, and gets the same sentences.

#![cfg(target_os = "linux")]

#[path = "../../../tests/common/decimal_comma.rs"]
mod decimal_comma;

use std::path::Path;
use std::process::Command;

/// Prints the bits of all values of a file, and the sentence for a file that is none; in a locale, if one is named.
const PROGRAM: &str = r#"
#include "hbvib_io.h"
#include <locale.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

int main(int argc, char **argv)
{
    hbvib_io_file *file = NULL;
    hbvib_io_matrix k;
    char half[8];
    int i;
    if (argc > 1 && setlocale(LC_ALL, argv[1]) == NULL) return 1;
    snprintf(half, sizeof half, "%.1f", 0.5);
    if (strcmp(half, argc > 1 ? "0,5" : "0.5") != 0) return 2;
    if (hbvib_io_read("symmetric.mtx", &file) != 0 || hbvib_io_matrix_of(file, HBVIB_IO_STIFFNESS, &k) != 0) return 3;
    for (i = 0; i < (int)k.entries; i++) {
        uint64_t bits;
        memcpy(&bits, &k.values[i], sizeof bits);
        printf("%llx\n", (unsigned long long)bits);
    }
    hbvib_io_free(file);
    if (hbvib_io_read("make.py", &file) == 0) return 4;
    puts(hbvib_io_last_error());
    return 0;
}
"#;

#[test]
fn a_decimal_comma_changes_no_number_that_is_read() {
    let folder = std::env::temp_dir().join(format!("hbvib_io_comma_{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let (source, program) = (folder.join("comma.c"), folder.join("comma"));
    std::fs::write(&source, PROGRAM).unwrap();
    let own = Path::new(env!("CARGO_MANIFEST_DIR"));
    // The shared library lies beside this program.
    let deps = std::env::current_exe().unwrap().parent().unwrap().display().to_string();
    let compiled = Command::new("cc")
        .args(["-std=c99", "-Wall", "-Wextra", "-pedantic", "-Werror", "-o"])
        .args([&program, &source])
        .arg(format!("-I{}", own.join("../../include").display()))
        .args([format!("-L{deps}"), format!("-Wl,-rpath,{deps}"), "-lhbvib_io".into()])
        .status()
        .unwrap();
    assert!(compiled.success());
    let locales = decimal_comma::locale(&folder);
    let texts = [&[][..], &[decimal_comma::NAME]].map(|arguments| {
        let output = Command::new(&program)
            .args(arguments)
            .current_dir(own.join("tests/data"))
            .env("LOCPATH", &locales)
            .output()
            .unwrap();
        assert!(output.status.success(), "{output:?}");
        String::from_utf8(output.stdout).unwrap()
    });
    assert_eq!(texts[0], texts[1]);
    assert!(
        texts[0].lines().count() > 4 && texts[0].contains("make.py, line"),
        "{}",
        texts[0]
    );
    std::fs::remove_dir_all(folder).unwrap();
}
