//! Motion of the mesh in VTU, UFF, NetCDF and .frd: other programs read the harmonics of the run back; jobs that cannot have them are
//! refused before anything is computed.

use crate::common::{printed, root, run};
use std::path::Path;

#[test]
fn other_programs_read_the_motion_of_the_wheel() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("motion_outputs");
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    let example = root().join("examples/jobs/cover_plate");
    for file in ["mesh.py", "matrices.inp"] {
        std::fs::copy(example.join(file), folder.join(file)).unwrap();
    }
    run("python3", &["mesh.py"], &folder);
    run("ccx", &["matrices"], &folder);
    let job = std::fs::read_to_string(example.join("job.toml")).unwrap();
    let job = job.replace("to_hz = 1020\n", "to_hz = 1020\nat_hz = [927.0, 939.0]\n");
    let job = job
        .replace("report = \"report.html\"", "# report")
        .replace("vtu = \"motion.pvd\"", "# vtu");
    let more = "vtu = 'motion.pvd'\nuff = 'response.uff'\nnetcdf = 'response.nc'\nfrd = 'response.frd'\n\
                [output.motion]\npoints = 'requested'\nphases = 8\nwheel = true\n[output.units]\nlength = 'm'\n\
                [[output.hysteresis]]\ncontact = 'rim'\npair = 1\npoints = 'requested'\nsamples = 8\ncsv = 'loop.csv'\n";
    std::fs::write(folder.join("job.toml"), job + more).unwrap();
    let text = run(env!("CARGO_BIN_EXE_hbvib"), &["run", "job.toml"], &folder);
    for name in ["motion.pvd", "response.uff", "response.nc", "response.frd"] {
        assert!(text.contains(&format!("wrote {name}\n")), "{text}");
    }
    // Files of the series are not named one by one.
    assert!(!text.contains(".vtu"), "{text}");
    // Side a of the second pair.
    let mesh = std::fs::read_to_string(folder.join("mesh.inp")).unwrap();
    let set = mesh.split("PLATE_RIM\n").nth(1).unwrap();
    let nodes: Vec<&str> = set.split([',', ' ', '\n']).filter(|word| !word.is_empty()).collect();
    std::fs::write(folder.join("rim.txt"), nodes[1]).unwrap();
    let own = root().join(".venv/bin/python");
    let python = if own.exists() { own } else { "python3".into() };
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/read_outputs.py");
    let read = run(python, &[script.to_str().unwrap(), folder.to_str().unwrap()], &folder);
    assert_eq!(read.trim(), "all read");
}

#[test]
fn jobs_without_a_mesh_are_refused_before_they_run() {
    let job = |output: &str| {
        format!(
            "{}[[force]]\ndof = 0\nvalue = 5.0\n[forced]\nfrom_hz = 207.0\nto_hz = 211.0\nharmonics = 1\n[output]\n{output}\n",
            crate::common::ring_damper()
        )
    };
    for (name, output, words) in [
        ("vtu", "vtu = 'a.pvd'", "[output], vtu: the matrices name no nodes"),
        ("frd", "frd = 'a.frd'", "[output], frd: the matrices name no nodes"),
        ("phases", "motion.phases = 0", "phases = 0"),
        ("wheel", "motion.wheel = true", "needs a sector with [model.faces]"),
        ("points", "motion.points = 'some'", "unknown variant `some`"),
    ] {
        let (output, folder) = crate::common::hbvib("run", ("motion_outputs_refused", name), &job(output));
        let errors = printed(&output.stderr);
        assert!(
            output.status.code() == Some(1) && errors.contains(words),
            "{name}: {errors}"
        );
        assert_eq!(std::fs::read_dir(folder).unwrap().count(), 1, "{name}");
    }
    // Rows without names have numbers in NetCDF, and one response in UFF.
    let (output, folder) = crate::common::hbvib(
        "run",
        ("motion_outputs_refused", "rows"),
        &job("netcdf = 'a.nc'\nuff = 'a.uff'"),
    );
    assert!(output.status.success(), "{}", printed(&output.stderr));
    let netcdf = std::fs::read(folder.join("a.nc")).unwrap();
    assert!(netcdf.starts_with(b"CDF\x02") && netcdf.windows(3).any(|word| word == b"dof"));
    let uff = std::fs::read_to_string(folder.join("a.uff")).unwrap();
    assert_eq!(
        (uff.matches("\n    58\n").count(), uff.matches("\n    55\n").count()),
        (1, 0)
    );
}
