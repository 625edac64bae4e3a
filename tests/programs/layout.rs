//! The structs of the interface have one layout in Rust, C, C++, Fortran and Python: size of each struct,
//! offset and size of each field.

#![cfg(target_os = "linux")]

use crate::common::programs::{library, printed, python, root, run, soname};
use hbvib::capi::contact_results::hbvib_contact_summary;
use hbvib::capi::contact_types::hbvib_contact;
use hbvib::capi::energy::hbvib_energy;
use hbvib::capi::jacobian::hbvib_jacobian_gap;
use hbvib::capi::mode::hbvib_mode_options;
use hbvib::capi::mode_results::{hbvib_mode_info, hbvib_mode_point};
use hbvib::capi::results::hbvib_reduction;
use hbvib::capi::synthesis::hbvib_synthesis_options;
use hbvib::capi::time::{hbvib_time_info, hbvib_time_options};
use hbvib::capi::types::{
    hbvib_forced_options, hbvib_hooks, hbvib_matrix, hbvib_progress, hbvib_solver_options, hbvib_view,
};
use hbvib::capi::user_force::{hbvib_force_call, hbvib_user_force};
use hbvib::capi::verify::{hbvib_verification, hbvib_verify_options};
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Size of what a function borrows from a struct.
const fn size_behind<T, F>(_: fn(&T) -> &F) -> usize {
    size_of::<F>()
}

macro_rules! layout {
    ($($name:ident { $($field:ident),* })*) => {{
        let mut lines = String::new();
        $(
            writeln!(lines, "{} sizeof 0 {}", stringify!($name), size_of::<$name>()).unwrap();
            $(
                let size = size_behind(|s: &$name| &s.$field);
                let offset = std::mem::offset_of!($name, $field);
                writeln!(lines, "{} {} {offset} {size}", stringify!($name), stringify!($field)).unwrap();
            )*
        )*
        lines
    }};
}

/// Lines "struct field offset size", in the order of the header.
fn in_rust() -> String {
    layout! {
        hbvib_matrix { struct_size, storage, scalar, part, rows, cols, ld, values, col_ptr, row_idx, index_base, reserved }
        hbvib_contact { struct_size, kind, dof_a, dof_b, sector_offset, kt, kn, mu, preload, gap, cubic, velocity, normal, tangent }
        hbvib_force_call { struct_size, reserved, omega, samples, n, states, u, v, z0, f, df_du, df_dv, z, dz_dz, dz_du_before, dz_du, dz_dv_before, dz_dv, dz_domega, df_dz }
        hbvib_user_force { struct_size, uses_velocity, is_odd, reserved, dofs, n, states, samples, force, user }
        hbvib_jacobian_gap { struct_size, tangent, gap, sample, row, column, given, difference }
        hbvib_solver_options { struct_size, num_threads, tolerance, harmonics, max_harmonics, samples, step, step_min, step_max, tol_residual, max_newton, max_points, response_dof, keep_even_harmonics, estimate_error }
        hbvib_forced_options { struct_size, reserved, omega_start, omega_stop, at, at_len, guess, guess_len }
        hbvib_progress { struct_size, newton_iterations, point, parameter, amplitude, residual, step, fraction_done }
        hbvib_hooks { struct_size, log_level, user, progress, log, cancel }
        hbvib_mode_options { struct_size, damping_form, log10_start, log10_stop, diameter, mode_index, near_omega, shape, shape_len, amplitude_contact, at, at_len, reference_dof }
        hbvib_view { struct_size, scalar, rank, reserved, data, shape, stride }
        hbvib_reduction { struct_size, reserved, sectors, degrees_of_freedom, coordinates, contacts, never_slipping, inert, harmonics_asked, harmonics_carried, unknowns, response_dof, mean_carried, even_removed, held_by_contacts }
        hbvib_energy { struct_size, reserved, twice_mean_kinetic, kinetic_mean, kinetic_peak, potential_mean, potential_peak, wheel_kinetic_mean, wheel_kinetic_peak, wheel_potential_mean, wheel_potential_peak, structural_loss, friction_loss }
        hbvib_contact_summary { struct_size, reserved, work, slip_share, open_share, half_range, motion_min, motion_max, load_min, load_max, directions, all_min, all_max }
        hbvib_mode_point { struct_size, reserved, log10_amplitude, omega, damping_ratio, modal_amplitude, energy, fundamental_share, friction_loss, structural_loss, energy_damping_ratio, assurance }
        hbvib_mode_info { struct_size, multiple, mode_index, multiplicity, reference_dof, engine_order, amplitude_contact, omega, linear_up_to }
        hbvib_synthesis_options { struct_size, model_damping, force_factor, damping_ratio }
        hbvib_time_options { struct_size, method, omega, harmonics, samples, tolerance, max_periods, start, start_len }
        hbvib_time_info { struct_size, reserved, period, residual, periods, events }
        hbvib_verify_options { struct_size, method, tolerance, max_periods, same_within }
        hbvib_verification { struct_size, same_solution, marched, reserved, harmonic, response, response_error, motion_error, above, distance, peak, peak_error, residual, periods, events }
    }
}

/// Structs of the header with their fields.
fn structs(header: &str) -> Vec<(String, Vec<String>)> {
    let mut found = Vec::new();
    let mut fields: Option<Vec<String>> = None;
    for line in header.lines() {
        let code = line.trim();
        if code == "typedef struct {" {
            fields = Some(Vec::new());
        } else if let Some(name) = code.strip_prefix("} ").and_then(|rest| rest.strip_suffix(';')) {
            if let Some(fields) = fields.take() {
                found.push((name.to_owned(), fields));
            }
        } else if let (Some(fields), false) = (&mut fields, code.starts_with("//")) {
            // "int64_t dof_a[3];", "void (*log)(void *user, …);"
            let declared = code.split_once("(*").map_or_else(
                || {
                    code.trim_end_matches(';')
                        .split('[')
                        .next()
                        .and_then(|d| d.rsplit([' ', '*']).next())
                },
                |(_, rest)| rest.split(')').next(),
            );
            fields.extend(declared.filter(|name| !name.is_empty()).map(str::to_owned));
        }
    }
    found
}

fn workshop() -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("layout");
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    for name in ["libhbvib.so".to_owned(), soname()] {
        std::os::unix::fs::symlink(library(), folder.join(name)).unwrap();
    }
    folder
}

/// A program that prints the layout, in the words that C and C++ share.
fn in_c(structs: &[(String, Vec<String>)]) -> String {
    let mut text = String::from("#include \"hbvib.h\"\n#include <stddef.h>\n#include <stdio.h>\nint main(void) {\n");
    for (name, fields) in structs {
        writeln!(text, "{{ {name} s; printf(\"{name} sizeof 0 %d\\n\", (int)sizeof s);").unwrap();
        for field in fields {
            writeln!(
                text,
                "printf(\"{name} {field} %d %d\\n\", (int)offsetof({name}, {field}), (int)sizeof s.{field});"
            )
            .unwrap();
        }
        text += "}\n";
    }
    text + "return 0; }\n"
}

#[test]
fn structs_have_one_layout_in_five_languages() {
    let header = fs::read_to_string(root().join("include/hbvib.h")).unwrap();
    let structs = structs(&header);
    let rust = in_rust();
    let fields: usize = structs.iter().map(|(_, fields)| fields.len()).sum();
    assert_eq!(
        rust.lines().count(),
        structs.len() + fields,
        "a field is missing in this test"
    );

    let folder = workshop();
    let source = folder.join("layout.c");
    fs::write(&source, in_c(&structs)).unwrap();
    for (compiler, language) in [("cc", "c"), ("c++", "c++")] {
        let program = folder.join(language);
        run(Command::new(compiler)
            .args(["-Iinclude", "-x", language])
            .arg(&source)
            .arg("-o")
            .arg(&program)
            .current_dir(root()));
        assert_eq!(printed(&mut Command::new(program)), rust, "{language} and Rust");
    }

    let program = folder.join("fortran");
    run(Command::new("gfortran")
        .args(["include/hbvib.f90", "tests/languages/fortran/layout.f90", "-J"])
        .arg(&folder)
        .arg(format!("-L{}", folder.display()))
        .arg(format!("-Wl,-rpath,{}", folder.display()))
        .args(["-lhbvib", "-o"])
        .arg(&program)
        .current_dir(root()));
    assert_eq!(printed(&mut Command::new(program)), rust, "Fortran and Rust");

    let mut script = Command::new(python());
    script
        .arg("tests/languages/python/layout.py")
        .env("PYTHONPATH", "include")
        .env("PYTHONDONTWRITEBYTECODE", "1")
        .env("HBVIB_LIBRARY", library())
        .current_dir(root());
    assert_eq!(printed(&mut script), rust, "Python and Rust");
}
