//! The readers from C and from Python, by the header and the module that users have.

#![cfg(target_os = "linux")]

use std::path::{Path, PathBuf};
use std::process::Command;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// The folder of the shared library: that of this program.
fn library() -> PathBuf {
    let deps = std::env::current_exe().unwrap().parent().unwrap().to_owned();
    deps.join("libhbvib_io.so")
}

fn printed(command: &mut Command) -> String {
    let output = command.output().unwrap();
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{command:?}: {errors}");
    String::from_utf8(output.stdout).unwrap()
}

#[test]
fn a_c_program_reads_a_job_and_gets_a_sentence_for_a_file_that_is_not_there() {
    let folder = std::env::temp_dir().join(format!("hbvib_io_c_{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let source = folder.join("io.c");
    std::fs::write(
        &source,
        r#"
#include "hbvib_io.h"
#include <stdio.h>
#include <string.h>

int main(int argc, char **argv)
{
    hbvib_io_file *file = NULL;
    hbvib_io_matrix k, c;
    int64_t dofs[48];
    if (argc != 2 || hbvib_io_read(argv[1], &file) != 0) return 1;
    if (hbvib_io_matrix_of(file, HBVIB_IO_STIFFNESS, &k) != 0) return 2;
    if (hbvib_io_matrix_of(file, HBVIB_IO_DAMPING, &c) != 1) return 3;
    if (hbvib_io_matrix_of(file, 7, &c) != -1 || !strstr(hbvib_io_last_error(), "which")) return 4;
    if (hbvib_io_dofs(file) != 24 || hbvib_io_dof_table(file, dofs) != 0) return 5;
    printf("%d %d %d %d, %.13e at %u %u of %d.%d\n", (int)k.rows, (int)k.columns, (int)k.symmetry, (int)k.is_complex,
           k.values[1], k.row[1], k.column[1], (int)dofs[2], (int)dofs[3]);
    hbvib_io_free(file);
    hbvib_io_free(NULL);
    file = NULL;
    if (hbvib_io_read("/nowhere/k.mtx", &file) != -1 || file != NULL) return 6;
    if (!strstr(hbvib_io_last_error(), "/nowhere/k.mtx: cannot be read")) return 7;
    if (hbvib_io_read(NULL, &file) != -1 || hbvib_io_dofs(NULL) != -1) return 8;
    if (hbvib_io_read_files(NULL, NULL, NULL, NULL, NULL, &file) != -1 || file != NULL) return 9;
    if (hbvib_io_read_files(argv[1], NULL, NULL, NULL, NULL, &file) != 0) return 10;
    if (!strstr(hbvib_io_report_line(file, 0, 0), "stiffness: 24 x 24")) return 11;
    if (hbvib_io_report_line(file, 1, 0) != NULL || hbvib_io_report_line(file, 0, 1000) != NULL) return 12;
    if (hbvib_io_report_line(file, 0, -1) != NULL || hbvib_io_report_line(NULL, 0, 0) != NULL) return 13;
    if (hbvib_io_matrix_of(file, HBVIB_IO_STRUCTURAL, &c) != 1) return 14;
    hbvib_io_free(file);
    return 0;
}
"#,
    )
    .unwrap();
    let program = folder.join("io");
    let library = library();
    let place = library.parent().unwrap().display();
    printed(
        Command::new("cc")
            .args(["-std=c99", "-Wall", "-Wextra", "-pedantic", "-Werror", "-o"])
            .arg(&program)
            .arg(&source)
            .arg(format!("-I{}", root().join("include").display()))
            .args([format!("-L{place}"), format!("-Wl,-rpath,{place}"), "-lhbvib_io".into()]),
    );
    let job = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/sector.mas");
    let text = printed(Command::new(program).arg(job));
    assert_eq!(text, "24 24 1 0, -2.7921933406855e+07 at 0 1 of 3.2\n");
    std::fs::remove_dir_all(folder).unwrap();
}

#[test]
fn python_gets_scipy_matrices() {
    let program = r#"
import importlib.util, json, os, sys
import numpy as np
import scipy.io
# The file alone: the package would load the other library.
place = importlib.util.spec_from_file_location("hbvib_io", os.path.join(os.environ["HBVIB_INCLUDE"], "hbvib/io.py"))
hbvib_io = importlib.util.module_from_spec(place)
place.loader.exec_module(hbvib_io)
values = json.load(open("values.json"))
for name in ("general.mtx", "symmetric.mtx.gz", "hermitian.mtx", "complex.mtx", "skew.mtx", "rectangular.mtx", "array.mtx",
             "general.rua", "symmetric.rsa", "dense.op4", "sparse.op4", "wheel_STIF1.mtx", "wheel_coordinate.mtx"):
    found = hbvib_io.read(name)
    expected = np.array(values[name]["re"]) + 1j * np.array(values[name]["im"])
    assert np.allclose(found.stiffness.toarray(), expected, rtol=1e-14, atol=0), name
    assert (found.mass is not None) == name.endswith("op4"), name
    if name.endswith("mtx") and name[:5] != "wheel":
        assert (found.stiffness.toarray() == np.asarray(getattr(m := scipy.io.mmread(name), "toarray", lambda: m)())).all(), name
stiffness, mass, damping, dofs = hbvib_io.read("sector.sti")
assert stiffness.shape == mass.shape == (24, 24) and damping is None and dofs[1].tolist() == [3, 2]
assert abs(stiffness - stiffness.T).max() == 0
try:
    hbvib_io.read("make.py")
except hbvib_io.ReadError as error:
    assert "make.py, line" in str(error), error
else:
    raise AssertionError("read a program")
print("ok")
"#;
    let own = root().join(".venv/bin/python");
    let python = if own.exists() { own } else { "python3".into() };
    let text = printed(
        Command::new(python)
            .args(["-c", program])
            .current_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data"))
            .env("PYTHONDONTWRITEBYTECODE", "1")
            .env("HBVIB_IO_LIBRARY", library())
            .env("HBVIB_INCLUDE", root().join("include").canonicalize().unwrap()),
    );
    assert_eq!(text, "ok\n");
}
