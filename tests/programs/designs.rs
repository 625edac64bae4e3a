//! The examples that spread designs over processes: on local ones they find the peaks of one process bit for bit, also
//! where a worker is killed, and a second start does what is missing.

#![cfg(target_os = "linux")]

use crate::common::programs::{printed, root, run};
use crate::languages::{copied, make, script, workshop};
use std::fs;
use std::path::Path;
use std::process::Command;

/// The saved ring damper under 5 N.
pub fn saved_model(folder: &Path) {
    let program = "import sys; sys.path.insert(0, sys.argv[1]); from ring_damper import ring_damper; \
                   ring_damper(5).save('model.hbvib')";
    run(script(Path::new("-c"))
        .arg(program)
        .arg(root().join("examples/python"))
        .current_dir(folder));
}

/// A program of the MPI example on local processes, in the folder of results.
fn on_processes(folder: &Path, count: &str, program: &str, results: &str, most: Option<&str>) -> String {
    let mut command = Command::new("mpirun");
    command
        .args(["--oversubscribe", "-n", count])
        .arg(folder.join(program))
        .args(["model.hbvib", results])
        .args(most)
        // In containers, too.
        .env("OMPI_ALLOW_RUN_AS_ROOT", "1")
        .env("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1")
        .env("OMPI_MCA_btl", "self,vader,tcp")
        .env("OMPI_MCA_btl_vader_single_copy_mechanism", "none")
        .current_dir(folder);
    printed(&mut command)
}

#[test]
fn mpi_processes_divide_designs_and_a_second_start_does_the_rest() {
    let folder = copied("examples/mpi", "mpi");
    make(&folder);
    saved_model(&folder);
    for results in ["one", "two", "other"] {
        fs::create_dir(folder.join(results)).unwrap();
    }
    let whole = on_processes(&folder, "1", "designs", "one", None);
    assert_eq!(whole.lines().count(), 97, "{whole}");
    // The line of N₀ = 100 N and kt = 5e7 N/m is that of the reference.
    let line: Vec<f64> = whole
        .lines()
        .nth(3)
        .unwrap()
        .split_whitespace()
        .map(|word| word.parse().unwrap())
        .collect();
    assert!((line[2] / 207.845_047_9 - 1.0).abs() < 1e-9 && (line[3] / 4.886_556_792e-3 - 1.0).abs() < 1e-8);

    // Stopped after a part, damaged, and finished by the program of the other language.
    assert_eq!(on_processes(&folder, "2", "designs", "two", Some("4")), "");
    fs::write(folder.join("two/chunk_001.bin"), "half a chunk").unwrap();
    let file = folder.join("two/chunk_002.bin");
    let before = fs::metadata(&file).unwrap().modified().unwrap();
    assert_eq!(on_processes(&folder, "2", "designs_fortran", "two", None), whole);
    assert_eq!(
        fs::metadata(&file).unwrap().modified().unwrap(),
        before,
        "a chunk was done twice"
    );
    assert_eq!(on_processes(&folder, "2", "designs_fortran", "other", None), whole);
    for chunk in 0..12 {
        let name = format!("chunk_{chunk:03}.bin");
        let bits = |results: &str| fs::read(folder.join(results).join(&name)).unwrap();
        assert!(bits("one") == bits("two") && bits("one") == bits("other"), "{name}");
    }
}

#[test]
fn dask_workers_divide_designs_and_those_of_a_killed_one_are_done_again() {
    let folder = workshop("dask");
    let study = |name: &str, flags: &[&str]| {
        run(script(&root().join("examples/python/designs_dask.py"))
            .args(["--designs", "64", "--csv", name])
            .args(flags)
            .current_dir(&folder));
        fs::read_to_string(folder.join(name)).unwrap()
    };
    let one = study("one.csv", &["--workers", "1"]);
    assert_eq!(one.lines().count(), 65);
    assert!(one.lines().skip(1).all(|line| line.ends_with(",0")), "{one}");
    assert_eq!(study("killed.csv", &["--workers", "2", "--kill"]), one);
}
