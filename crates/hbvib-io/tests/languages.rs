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
    let job = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/sector.mas");
    let (folder, text) = c_program("read", READS, &[job.as_os_str()]);
    assert_eq!(text, "24 24 1 0, -2.7921933406855e+07 at 0 1 of 3.2\n");
    std::fs::remove_dir_all(folder).unwrap();
}

/// Compiles a program in C against the library, and runs it in a folder.
fn c_program(name: &str, text: &str, arguments: &[&std::ffi::OsStr]) -> (PathBuf, String) {
    let folder = std::env::temp_dir().join(format!("hbvib_io_{name}_{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    std::fs::write(folder.join("io.c"), text).unwrap();
    let library = library();
    let place = library.parent().unwrap().display();
    printed(
        Command::new("cc")
            .args([
                "-std=c99",
                "-Wall",
                "-Wextra",
                "-pedantic",
                "-Werror",
                "-o",
                "io",
                "io.c",
            ])
            .current_dir(&folder)
            .arg(format!(
                "-I{}",
                root().join("include").canonicalize().unwrap().display()
            ))
            .args([format!("-L{place}"), format!("-Wl,-rpath,{place}"), "-lhbvib_io".into()]),
    );
    // Cargo names other folders in which an older library may lie.
    let mut program = Command::new(folder.join("io"));
    let text = printed(
        program
            .args(arguments)
            .current_dir(&folder)
            .env("LD_LIBRARY_PATH", library.parent().unwrap()),
    );
    (folder, text)
}

const READS: &str = r#"
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
"#;

#[test]
fn a_c_program_writes_a_superelement_and_results() {
    let (folder, _) = c_program("write", WRITES, &[]);
    for name in ["model.op4", "model.pch", "model.npz"] {
        let found = hbvib_io::read(&folder.join(name)).unwrap();
        let full = |a: &hbvib_io::Matrix| {
            let mut full = [[0.0; 2]; 2];
            for ((i, j), v) in a.row.iter().zip(&a.column).zip(&a.values) {
                full[*i as usize][*j as usize] += v;
                if i != j && a.symmetry == hbvib_io::Symmetry::Symmetric {
                    full[*j as usize][*i as usize] += v;
                }
            }
            full
        };
        assert_eq!(
            found.stiffness.as_ref().map(full),
            Some([[2.0, -1.0], [-1.0, 2.5]]),
            "{name}"
        );
        assert_eq!(found.mass.as_ref().map(full), Some([[1.0, 0.0], [0.0, 3.0]]), "{name}");
        if name != "model.op4" {
            assert_eq!(found.dofs, [(4, 1), (7, 3)], "{name}");
        }
    }
    let results = hbvib_io::read_universal(&folder.join("results.uff")).unwrap();
    assert_eq!(
        (results.nodes.len(), results.nodes[1].number, results.nodes[1].position),
        (2, 7, [0.5, 0.25, 1e-3])
    );
    let shape = &results.shapes[0];
    assert_eq!((&shape.nodes[..], shape.reals[0], shape.per_node), (&[7][..], 12.5, 3));
    assert_eq!(shape.values, [(1.0, 2.0), (3.0, 4.0), (5.0, -6.5)]);
    let function = &results.functions[0];
    assert_eq!((function.response, &function.abscissa[..]), ((7, 3), &[10.0, 20.0][..]));
    assert_eq!(
        (&function.values[..], &function.text[0][..]),
        (&[(1.0, 0.0), (0.25, -1.0)][..], "tip?    -1")
    );
    std::fs::remove_dir_all(folder).unwrap();
}

const WRITES: &str = r#"
#include "hbvib_io.h"
#include <math.h>
#include <stddef.h>
#include <string.h>

#define NEEDS(x) if (!(x)) return __LINE__
#define REFUSED(x, word) if ((x) != -1 || !strstr(hbvib_io_last_error(), word)) return __LINE__

int main(void)
{
    const uint32_t row[] = {0, 1, 1}, column[] = {0, 0, 1};
    const double values[] = {2.0, -1.0, 2.5}, masses[] = {1.0, 3.0}, bad[] = {1.0, NAN};
    const int64_t dofs[] = {4, 1, 7, 3}, nodes[] = {4, 7};
    const double at[] = {0, 0, 0, 0.5, 0.25, 1e-3}, motion[] = {1, 2, 3, 4, 5, -6.5};
    const double hertz[] = {10, 20}, response[] = {1, 0, 0.25, -1};
    const uint32_t diagonal[] = {0, 1};
    hbvib_io_matrix k = {2, 2, 3, 0, HBVIB_IO_SYMMETRIC, NULL, NULL, NULL};
    hbvib_io_matrix m = {2, 2, 2, 0, HBVIB_IO_SYMMETRIC, NULL, NULL, NULL};
    hbvib_io_file *file = NULL;
    hbvib_io_results *results = NULL;
    REFUSED(hbvib_io_new(NULL), "out is NULL");
    NEEDS(hbvib_io_new(&file) == 0 && file);
    REFUSED(hbvib_io_set_matrix(file, HBVIB_IO_STIFFNESS, &k), "NULL");
    k.row = row; k.column = column; k.values = values;
    m.row = m.column = diagonal; m.values = masses;
    REFUSED(hbvib_io_set_matrix(file, 9, &k), "which needs");
    REFUSED(hbvib_io_set_matrix(NULL, 2, &k), "NULL");
    k.rows = 1;
    REFUSED(hbvib_io_set_matrix(file, HBVIB_IO_STIFFNESS, &k), "outside");
    k.rows = -1;
    REFUSED(hbvib_io_set_matrix(file, HBVIB_IO_STIFFNESS, &k), "out of range");
    k.rows = 2; k.symmetry = 4;
    REFUSED(hbvib_io_set_matrix(file, HBVIB_IO_STIFFNESS, &k), "symmetry");
    k.symmetry = HBVIB_IO_SYMMETRIC;
    m.values = bad;
    REFUSED(hbvib_io_set_matrix(file, HBVIB_IO_MASS, &m), "finite");
    m.values = masses;
    NEEDS(hbvib_io_set_matrix(file, HBVIB_IO_STIFFNESS, &k) == 0);
    NEEDS(hbvib_io_set_matrix(file, HBVIB_IO_MASS, &m) == 0);
    REFUSED(hbvib_io_set_dofs(file, 2, NULL), "table is NULL");
    REFUSED(hbvib_io_set_dofs(file, -2, dofs), "out of range");
    REFUSED(hbvib_io_set_dofs(NULL, 2, dofs), "file is NULL");
    NEEDS(hbvib_io_set_dofs(file, 2, dofs) == 0);
    NEEDS(hbvib_io_write(file, "model.op4", "op4-binary") == 0);
    NEEDS(hbvib_io_write(file, "model.pch", NULL) == 0);
    NEEDS(hbvib_io_write(file, "model.npz", NULL) == 0);
    REFUSED(hbvib_io_write(file, "model.xyz", NULL), "one of op4");
    REFUSED(hbvib_io_write(file, "model.npz", "op5"), "one of op4");
    REFUSED(hbvib_io_write(file, "/nowhere/model.npz", NULL), "cannot be written");
    REFUSED(hbvib_io_write(file, NULL, NULL), "path is NULL");
    REFUSED(hbvib_io_write(NULL, "model.npz", NULL), "file is NULL");
    hbvib_io_free(file);
    REFUSED(hbvib_io_results_new(2, nodes, at, NULL), "out is NULL");
    REFUSED(hbvib_io_results_new(2, NULL, at, &results), "nodes is NULL");
    REFUSED(hbvib_io_results_new(-1, nodes, at, &results), "out of range");
    NEEDS(hbvib_io_results_new(2, nodes, at, &results) == 0);
    REFUSED(hbvib_io_results_add_shape(NULL, "", 1.0, 1, nodes, motion), "results is NULL");
    REFUSED(hbvib_io_results_add_shape(results, "", 1.0, 1, nodes, NULL), "values is NULL");
    REFUSED(hbvib_io_results_add_shape(results, "", 1.0, -1, nodes, motion), "out of range");
    NEEDS(hbvib_io_results_add_shape(results, NULL, 12.5, 1, nodes + 1, motion) == 0);
    REFUSED(hbvib_io_results_add_function(NULL, "", 7, 3, 2, hertz, response), "results is NULL");
    REFUSED(hbvib_io_results_add_function(results, "", 7, 3, 2, NULL, response), "NULL");
    REFUSED(hbvib_io_results_add_function(results, "", 7, 3, -2, hertz, response), "out of range");
    NEEDS(hbvib_io_results_add_function(results, "tip\n    -1", 7, 3, 2, hertz, response) == 0);
    REFUSED(hbvib_io_results_write(NULL, "results.uff"), "results is NULL");
    REFUSED(hbvib_io_results_write(results, NULL), "path is NULL");
    NEEDS(hbvib_io_results_write(results, "results.uff") == 0);
    NEEDS(hbvib_io_results_add_function(results, NULL, 7, 3, 2, bad, response) == 0);
    REFUSED(hbvib_io_results_write(results, "bad.uff"), "finite");
    hbvib_io_results_free(results);
    hbvib_io_results_free(NULL);
    return 0;
}
"#;

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
import tempfile
with tempfile.TemporaryDirectory() as folder:
    at = os.path.join(folder, "a.")
    for end, form in (("op4", None), ("op4", "op4-binary"), ("npz", None), ("pch", None), ("inp", None)):
        hbvib_io.write(at + end, stiffness=stiffness, mass=mass.toarray(), dofs=dofs, format=form)
        found = hbvib_io.read(at + end)
        assert abs(found.stiffness - stiffness).max() <= 1e-8 * abs(stiffness).max() and found.mass.shape == (24, 24), end
    loss = np.array([[1, 2j], [2, 3.5]])
    hbvib_io.write(at + "npz", stiffness=np.eye(2), structural=loss)
    assert (hbvib_io.read(at + "npz").structural.toarray() == loss).all()
    for wrong in (dict(), dict(stiffness=np.eye(2), mass=np.eye(3)), dict(stiffness=[[np.nan]]), dict(stiffness=np.eye(2), dofs=[1])):
        try:
            hbvib_io.write(at + "op4", **wrong)
        except hbvib_io.WriteError:
            continue
        raise AssertionError(wrong)
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
