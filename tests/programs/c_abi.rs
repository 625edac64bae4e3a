//! The C interface, from C: compiles the programs in tests/c_abi and examples/c against the header
//! and the shared library, and runs them. The C programs print nothing unless a check fails, so
//! that a single byte on their standard output or error would be the library's.

#![cfg(target_os = "linux")]

use crate::common::programs::{library, root, run, soname};
use crate::common::{data, number};
use serde_json::Value;
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// A folder of the test's own with the library under the names that linker and loader look for.
fn workshop(test: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("c_abi").join(test);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    for name in ["libhbvib.so".to_owned(), soname()] {
        std::os::unix::fs::symlink(library(), folder.join(name)).unwrap();
    }
    folder
}

/// Compiles a C file with warnings denied, and links it with the library and the libraries of
/// libc.
fn compile(source: &str, folder: &Path, options: &[&str]) -> PathBuf {
    let program = folder.join(Path::new(source).file_stem().unwrap());
    let mut cc = Command::new("cc");
    cc.args(["-g", "-Wall", "-Wextra", "-pedantic", "-Werror", "-Iinclude"])
        .args(options)
        .arg(source)
        .arg(format!("-L{}", folder.display()))
        .arg(format!("-Wl,-rpath,{}", folder.display()))
        .args(["-lhbvib", "-lm", "-lpthread", "-ldl", "-o"])
        .arg(&program)
        .current_dir(root());
    run(&mut cc);
    program
}

/// Runs a program of tests/c_abi, which must be silent.
fn silent(name: &str, arguments: impl Fn(&Path) -> Vec<PathBuf>) {
    let folder = workshop(name);
    let program = compile(
        &format!("tests/c_abi/{name}.c"),
        &folder,
        &["-std=c99", "-D_GNU_SOURCE"],
    );
    let output = run(Command::new(program)
        .args(arguments(&folder))
        .env("RUST_BACKTRACE", "1")
        .current_dir(&folder));
    assert_eq!(
        String::from_utf8_lossy(&output.stdout),
        "",
        "{name} wrote to its standard output"
    );
    assert_eq!(
        String::from_utf8_lossy(&output.stderr),
        "",
        "{name} wrote to its standard error"
    );
}

#[test]
fn bad_pointers_sizes_and_buffers_are_refused() {
    silent("bad_pointers", |_| vec![]);
}

#[test]
fn bad_matrices_and_contacts_are_refused() {
    silent("bad_values", |_| vec![]);
}

#[test]
fn extreme_models_have_an_answer_or_a_status() {
    silent("extremes", |_| vec![]);
}

#[test]
fn unusual_input_has_the_result_that_it_says() {
    silent("unusual", |_| vec![]);
}

#[test]
fn bad_options_and_ranges_are_refused() {
    silent("bad_options", |_| vec![]);
}

#[test]
fn sizes_are_counted_and_indices_may_count_from_one() {
    silent("counting", |_| vec![]);
}

#[test]
fn models_are_read_back_as_they_were_given() {
    silent("contents", |_| vec![]);
}

#[test]
fn both_senses_of_a_nodal_diameter_are_solved() {
    silent("senses", |_| vec![]);
}

#[test]
fn aerodynamic_influence_acts_and_is_checked() {
    silent("aero", |_| vec![]);
}

#[test]
fn the_wheel_of_a_cyclic_model_has_its_pattern() {
    silent("mistuned", |_| vec![]);
}

#[test]
fn results_are_what_they_say() {
    silent("results", |_| vec![]);
}

#[test]
fn a_sector_from_its_faces_is_a_ring_of_known_frequencies() {
    silent("sector", |_| vec![]);
}

#[test]
fn nonlinear_modes_are_those_of_the_reference() {
    let reference = &data("nnm_base.json")["H"]["3"];
    let table = reference["table"].as_array().unwrap();
    let rows = [0, table.len() / 2].map(|i| &table[i]);
    let mut numbers: Vec<&Value> = rows.iter().flat_map(|r| [&r["alpha"], &r["omega"], &r["D"]]).collect();
    numbers.push(&reference["D_max"]["D"]);
    silent("mode", |_| {
        numbers.iter().map(|v| number(v).to_string().into()).collect()
    });
}

#[test]
fn bad_options_and_models_of_a_mode_are_refused() {
    silent("bad_modes", |_| vec![]);
}

#[test]
fn responses_are_synthesised_from_modes() {
    silent("synthesis", |_| vec![]);
}

#[test]
fn responses_in_time_are_the_truth_of_the_reference() {
    let td = &data("point_F5_208p85.json")["td"];
    let tip = &td["X"]["1"][0];
    let numbers = [&td["f_Hz"], &tip[0], &tip[1]];
    silent("time", |_| {
        numbers.iter().map(|v| number(v).to_string().into()).collect()
    });
}

#[test]
fn points_checked_in_time_have_the_errors_of_the_reference() {
    let point = data("point_F5_208p85.json");
    let tip = &point["td"]["X"]["1"][0];
    let error = &point["hbm"]["hbm_exactN"]["9"]["rel_err_b2_vs_td"];
    let numbers = [&point["td"]["f_Hz"], &tip[0], &tip[1], error];
    silent("verify", |_| {
        numbers.iter().map(|v| number(v).to_string().into()).collect()
    });
}

#[test]
fn multipliers_of_points_are_those_of_the_reference() {
    silent("floquet", |_| vec![]);
}

#[test]
fn derivatives_by_parameters_are_computed_and_refused() {
    silent("sensitivity", |_| vec![]);
}

#[test]
fn parameters_are_fitted_to_data_and_predicted() {
    silent("fit", |_| vec![]);
}

#[test]
fn residual_forces_have_their_freedom_and_band() {
    silent("band", |_| vec![]);
    silent("life", |_| vec![]);
    silent("run_up", |_| vec![]);
    silent("slow_flow", |_| vec![]);
}

#[test]
fn a_damper_under_platforms_is_added_and_checked() {
    silent("damper", |_| vec![]);
}

#[test]
fn many_contacts_and_springs_are_added_at_once() {
    silent("tables", |_| vec![]);
}

#[test]
fn modes_about_the_static_state_and_damping_are_those_of_closed_forms() {
    silent("modes_and_damping", |_| vec![]);
}

#[test]
fn rotation_and_damping_are_those_of_closed_forms() {
    silent("rotation", |_| vec![]);
}

#[test]
fn responses_are_those_of_other_calls() {
    silent("responses", |_| vec![]);
}

#[test]
fn batches_find_the_peaks_of_designs() {
    silent("batch", |_| vec![]);
}

#[test]
fn models_are_saved_and_loaded() {
    silent("saved", |_| vec![]);
}

#[test]
fn laws_elements_and_patches_are_those_of_closed_forms() {
    silent("laws", |_| vec![]);
}

#[test]
fn bad_laws_elements_and_patches_are_refused() {
    silent("bad_laws", |_| vec![]);
}

#[test]
fn handles_cannot_be_mistaken() {
    silent("handles", |_| vec![]);
}

#[test]
fn hooks_cancel_and_threads_share_a_model() {
    silent("callbacks", |_| vec![]);
}

#[test]
fn phases_are_reported_and_long_functions_can_be_stopped() {
    silent("phases", |_| vec![]);
}

#[test]
fn forces_of_the_caller_may_fail_and_call_the_library() {
    silent("user_force", |_| vec![]);
}

#[test]
fn the_library_is_a_guest_in_its_process() {
    silent("process", |folder| {
        let copy = folder.join("copy.so");
        fs::copy(library(), &copy).unwrap();
        vec![copy]
    });
}

/// The words after a label in what a program printed, as numbers.
fn numbers_after(text: &str, label: &str) -> Vec<Vec<f64>> {
    let lines = text.lines().filter_map(|line| line.strip_prefix(label));
    lines
        .map(|line| line.split([' ', ',']).filter_map(|word| word.parse().ok()).collect())
        .collect()
}

#[test]
fn the_c_example_of_a_force_of_its_own_balances_its_work() {
    let folder = workshop("user_force_example");
    let program = compile("examples/c/user_force.c", &folder, &["-std=c99"]);
    let output = run(&mut Command::new(program));
    let text = String::from_utf8(output.stdout).unwrap();
    let response = numbers_after(&text, "response:");
    let peak = &numbers_after(&text, "peak:")[0];
    let largest = response.iter().fold(0.0_f64, |m, row| m.max(row[1]));
    assert!(
        response.len() > 20 && peak[1] >= largest && peak[1] < 1.05 * largest,
        "{text}"
    );
    assert!(peak[0] > 1.0 && peak[0] < 1.6_f64.sqrt(), "{text}");
    let work = &numbers_after(&text, "work:")[0];
    let (given, taken) = (work[0], work[1] + work[2]);
    assert!(work[2] > work[1] && (given / taken - 1.0).abs() < 1e-3, "{text}");
    // The force of a Bouc-Wen element is bounded by k/(beta + gamma).
    let forces = numbers_after(&text, "loop:");
    assert!(
        forces.len() == 32 && forces.iter().all(|row| row[1].abs() < 0.6 / 6.0),
        "{text}"
    );
}

#[test]
fn the_header_compiles_in_every_dialect() {
    for (compiler, language, dialects) in [
        ("cc", "c", &["c99", "c11", "c17"][..]),
        ("c++", "c++", &["c++11", "c++14", "c++17", "c++20"]),
    ] {
        for dialect in dialects {
            run(Command::new(compiler)
                .args([
                    "-Wall",
                    "-Wextra",
                    "-Wpedantic",
                    "-Werror",
                    "-fsyntax-only",
                    "-Iinclude",
                ])
                .args([&format!("-std={dialect}"), "-x", language, "tests/c_abi/header.c"])
                .current_dir(root()));
        }
    }
}

#[test]
fn the_header_has_the_version_of_the_crate() {
    let header = fs::read_to_string(root().join("include/hbvib.h")).unwrap();
    for (name, value) in [
        ("MAJOR", env!("CARGO_PKG_VERSION_MAJOR")),
        ("MINOR", env!("CARGO_PKG_VERSION_MINOR")),
        ("PATCH", env!("CARGO_PKG_VERSION_PATCH")),
    ] {
        let line = format!("#define HBVIB_VERSION_{name} {value}\n");
        assert!(header.contains(&line), "the header lacks {line:?}");
    }
}

/// The program in the comment at the top of the header.
fn example(header: &str) -> String {
    let comment = header.split("*/").next().unwrap();
    let lines = comment.lines().skip_while(|line| !line.contains("#include"));
    lines
        .take_while(|line| *line != " *")
        .map(|line| line.trim_start_matches(" *").to_owned() + "\n")
        .collect()
}

#[test]
fn the_example_of_the_header_runs() {
    let header = fs::read_to_string(root().join("include/hbvib.h")).unwrap();
    let text = example(&header);
    assert_eq!(text.lines().count(), 15, "{text}");
    let folder = workshop("header_example");
    let source = folder.join("header_example.c");
    fs::write(&source, text).unwrap();
    let program = compile(source.to_str().unwrap(), &folder, &["-std=c99"]);
    let output = run(&mut Command::new(program));
    let text = String::from_utf8(output.stdout).unwrap();
    let (amplitude, omega) = text.trim().split_once(" at ").unwrap();
    let [amplitude, omega] = [amplitude, omega].map(|word| word.parse::<f64>().unwrap());
    // Between the resonance with a contact that slides and that with one that sticks.
    assert!(omega > 1.0 && omega < 2.0_f64.sqrt() && amplitude > 0.5, "{text}");
}

#[test]
fn no_line_of_the_header_is_longer_than_100_columns() {
    let header = fs::read_to_string(root().join("include/hbvib.h")).unwrap();
    let long: Vec<_> = header.lines().filter(|line| line.chars().count() > 100).collect();
    assert!(long.is_empty(), "{}", long.join("\n"));
}

#[test]
fn every_struct_of_the_caller_stands_beside_its_init_function() {
    let header = fs::read_to_string(root().join("include/hbvib.h")).unwrap();
    let mut structs = 0;
    for (body, rest) in header
        .split("typedef struct {\n")
        .skip(1)
        .map(|text| text.split_once("\n} ").unwrap())
    {
        let name = rest.split(';').next().unwrap();
        // The library alone fills a struct whose size it states.
        if body.contains("as the library knows it") {
            assert!(!header.contains(&format!("{name}_init(")), "{name}");
            continue;
        }
        let next = rest
            .lines()
            .skip(1)
            .find(|line| !line.is_empty() && !line.starts_with("///") && *line != "HBVIB_NODISCARD");
        let init = format!("hbvib_status {name}_init({name} *");
        assert!(
            next.is_some_and(|line| line.starts_with(&init)),
            "after {name} stands {next:?}"
        );
        structs += 1;
    }
    assert!(structs > 15, "only {structs} structs were seen");
}

/// Names in `text` that begin with hbvib_ and are followed by an opening parenthesis.
fn called(text: &str) -> BTreeSet<&str> {
    let is_name = |c: char| c.is_ascii_alphanumeric() || c == '_';
    text.split('(')
        .map(|before| before.trim_end_matches(is_name).len())
        .zip(text.split('('))
        .map(|(at, before)| &before[at..])
        .filter(|name| name.starts_with("hbvib_"))
        .collect()
}

#[test]
fn only_the_functions_of_the_header_are_exported_and_each_is_tested() {
    let listed = fs::read_to_string(root().join("tests/c_abi/symbols.txt")).unwrap();
    let listed: BTreeSet<&str> = listed.lines().collect();

    let output = run(Command::new("nm").args(["-D", "--defined-only"]).arg(library()));
    let text = String::from_utf8(output.stdout).unwrap();
    let exported: BTreeSet<&str> = text.lines().filter_map(|line| line.split_whitespace().last()).collect();
    assert_eq!(exported, listed, "exported symbols and tests/c_abi/symbols.txt differ");

    let header = fs::read_to_string(root().join("include/hbvib.h")).unwrap();
    let code: String = header
        .lines()
        .filter(|line| !line.trim_start().starts_with("//"))
        .collect();
    assert_eq!(called(&code), listed, "the header and tests/c_abi/symbols.txt differ");

    let mut tests = String::new();
    for entry in fs::read_dir(root().join("tests/c_abi")).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|e| e == "c" || e == "h") {
            tests += &fs::read_to_string(path).unwrap();
        }
    }
    let tested = called(&tests);
    let missing: Vec<_> = listed.iter().filter(|name| !tested.contains(**name)).collect();
    assert!(missing.is_empty(), "no C test calls {missing:?}");
}

#[test]
fn the_library_knows_its_name() {
    let output = run(Command::new("readelf").args(["-d"]).arg(library()));
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(
        text.contains(&format!("[{}]", soname())),
        "no SONAME {} in\n{text}",
        soname()
    );
}
