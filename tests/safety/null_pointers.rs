//! NULL for each pointer of each exported function, one at a time: a program that is generated from the header calls them.
//! A pointer that the documentation does not call optional is refused with its number; one that is optional does no harm.

use crate::common::programs::{root, run};
use crate::programs::{compile, workshop};
use std::fmt::Write as _;
use std::fs;
use std::process::Command;

/// Functions without a pointer, and the callers of which cannot be wrong by one.
const WITHOUT_POINTERS: usize = 5;

/// Values of numbers in the calls: function (or all), parameter, value. The first that fits.
const NUMBERS: &[(&str, &str, &str)] = &[
    ("hbvib_last_error_copy", "len", "16"),
    ("hbvib_cancel", "value", "0"),
    ("hbvib_model_load", "length", "64"),
    ("hbvib_model_save", "capacity", "8192"),
    ("hbvib_model_add_polynomial", "n_dofs", "2"),
    ("hbvib_model_add_polynomial", "n_terms", "2"),
    ("hbvib_model_add_stiffness_tensors", "n", "2"),
    ("hbvib_model_add_table", "n", "2"),
    ("hbvib_model_add_patch", "n", "1"),
    ("hbvib_branch_harmonics", "x_len", "12"),
    ("hbvib_branch_harmonics_with_hooks", "x_len", "12"),
    ("hbvib_forced_residual", "jac_len", "3600"),
    ("hbvib_forced_residual_with_hooks", "jac_len", "3600"),
    ("hbvib_contact_evaluate", "jac_len", "16"),
    ("hbvib_contact_evaluate_with_hooks", "jac_len", "16"),
    ("hbvib_contact_evaluate", "harmonics", "1"),
    ("hbvib_contact_evaluate_with_hooks", "harmonics", "1"),
    ("hbvib_check_jacobian", "amplitude_len", "1"),
    ("hbvib_index_from_one", "index", "1"),
    ("hbvib_branch_slip_fraction", "shares_len", "1"),
    ("hbvib_time_response", "harmonics_len", "30"),
    ("hbvib_time_response", "samples_len", "192"),
    ("hbvib_verify", "harmonics_len", "12"),
    ("hbvib_verify", "errors_len", "4"),
    ("hbvib_sensitivity", "derivatives_len", "1"),
    ("hbvib_response_sensitivity", "derivatives_len", "1"),
    ("hbvib_fit", "data_len", "1"),
    ("hbvib_fit", "residuals_len", "0"),
    ("hbvib_fit_profile", "data_len", "1"),
    ("hbvib_fit_profile", "values_len", "1"),
    ("hbvib_fit_profile", "rise", "1"),
    ("hbvib_model_matrix", "block", "0"),
    ("hbvib_campbell_crossings", "engine_order", "1"),
    ("hbvib_cyclic_set_aero", "n_dofs", "1"),
    ("hbvib_cyclic_set_aero", "n_offsets", "1"),
    ("hbvib_wheel_mistune", "n_dofs", "1"),
    ("hbvib_wheel_blade_modes", "n_dofs", "2"),
    ("hbvib_wheel_blade_modes", "modes", "1"),
    ("hbvib_wheel_blade_modes", "families", "1"),
    ("hbvib_wheel_blade_modes", "n_points", "1"),
    ("hbvib_wheel_blade_modes", "weights_len", "64"),
    ("hbvib_wheel_identify", "n_dofs", "1"),
    ("hbvib_wheel_identify", "n_points", "1"),
    ("hbvib_wheel_identify", "n_modes", "1"),
    ("hbvib_wheel_identify", "sectors", "1"),
    ("", "n", "2"),
    ("", "n_dof", "3"),
    ("", "ndof", "3"),
    ("", "ndof_sector", "3"),
    ("", "sectors", "5"),
    ("", "count", "1"),
    ("", "designs", "1"),
    ("", "elements", "4"),
    ("", "n_spring", "2"),
    ("", "n_damper", "2"),
    ("", "capacity", "512"),
    ("", "states_capacity", "4"),
    ("hbvib_static_history", "steps", "1"),
    ("", "classes_len", "8"),
    ("", "multipliers_len", "8"),
    ("", "x_len", "30"),
    ("", "r_len", "30"),
    ("", "d_omega_len", "30"),
    ("", "motion_len", "2"),
    ("", "force_len", "2"),
    ("", "omega", "1.2"),
    ("", "wanted", "0"),
];

/// A pointer whose default is refused for another reason: function, parameter.
const DEFAULT_REFUSED: &[(&str, &str)] = &[
    // The default tolerance is above 0.
    ("hbvib_parameter_response", "solver"),
];

struct Parameter {
    kind: String,
    name: String,
}

impl Parameter {
    fn is_pointer(&self) -> bool {
        self.kind.ends_with('*')
    }
}

struct Function {
    returns: String,
    name: String,
    parameters: Vec<Parameter>,
    documentation: String,
}

impl Function {
    /// Whether the documentation lets a pointer be NULL: its paragraph says so, or a sentence that names it.
    fn is_optional(&self, parameter: &str) -> bool {
        let mut inside = false;
        for line in self.documentation.lines() {
            let text = line.trim_start_matches("///");
            // A parameter, or several, begins after one blank, what goes on below it after many.
            if !text.starts_with("   ") {
                let names = text.trim_start().split("  ").next().unwrap_or("");
                inside = names.split(", ").any(|name| name == parameter);
            }
            if inside && (text.contains("NULL")) {
                return true;
            }
        }
        false
    }
}

fn begins_a_function(line: &str) -> bool {
    let named = line.contains(" hbvib_") || line.contains(" *hbvib_");
    named && line.contains('(') && line.starts_with(char::is_alphabetic) && !line.starts_with("typedef")
}

/// The functions of the header with their documentation.
fn functions(header: &str) -> Vec<Function> {
    let mut found: Vec<Function> = Vec::new();
    let (mut documentation, mut declaration) = (String::new(), String::new());
    for line in header.lines() {
        if line.starts_with("///") {
            documentation.push_str(line);
            documentation.push('\n');
        } else if declaration.is_empty() && !begins_a_function(line) {
            if !line.starts_with("HBVIB_NODISCARD") {
                documentation.clear();
            }
        } else {
            declaration.push_str(line);
            declaration.push(' ');
            if line.ends_with(");") {
                found.extend(function(&declaration, &documentation));
                documentation.clear();
                declaration.clear();
            } else if line.ends_with(['{', ';']) || line.starts_with('}') {
                documentation.clear();
                declaration.clear();
            }
        }
    }
    // "Arguments as for" another function: its documentation.
    for k in 0..found.len() {
        let referred = found[k].documentation.lines().find_map(|line| {
            let name = line.split_once("Arguments")?.1.split_once("as for ")?.1;
            found
                .iter()
                .find(|function| function.name == name.trim_end_matches('.'))
        });
        let referred = referred.map(|function| function.documentation.clone());
        found[k].documentation.extend(referred);
    }
    found
}

fn function(declaration: &str, documentation: &str) -> Option<Function> {
    let (before, after) = declaration.split_once('(')?;
    let (inside, _) = after.rsplit_once(')')?;
    let name = before.rsplit([' ', '*']).next()?;
    let parameters = inside.split(',').map(str::trim).filter(|p| *p != "void").map(|p| {
        let at = p.rfind([' ', '*']).unwrap() + 1;
        Parameter {
            kind: p[..at].trim().to_owned(),
            name: p[at..].to_owned(),
        }
    });
    Some(Function {
        returns: before[..before.len() - name.len()].trim().to_owned(),
        name: name.to_owned(),
        parameters: parameters.collect(),
        documentation: documentation.to_owned(),
    })
}

/// Value that a call passes for a parameter that is not NULL.
fn value(function: &Function, number: usize) -> String {
    let Parameter { kind, name } = &function.parameters[number];
    let plain = kind.trim_start_matches("const ");
    let of_a_mode = ["mode_point", "mode_info", "synthesis", "limit_cycles"];
    match plain {
        "hbvib_model *" if function.name.starts_with("hbvib_cyclic") => "wheel".to_owned(),
        "hbvib_model *" => "model".to_owned(),
        "hbvib_branch *" if of_a_mode.iter().any(|word| function.name.contains(word)) => "backbone".to_owned(),
        "hbvib_branch *" => "branch".to_owned(),
        "hbvib_batch *" => "batch".to_owned(),
        "hbvib_model **" => "&new_model".to_owned(),
        "hbvib_branch **" => "&new_branch".to_owned(),
        "hbvib_batch **" => "&new_batch".to_owned(),
        "hbvib_cancel_flag *" => "&flag".to_owned(),
        _ if kind.ends_with('*') && plain.starts_with("hbvib_") => {
            let role = if kind.starts_with("const") { "an" } else { "out" };
            format!("&{role}_{}", plain.trim_end_matches(" *"))
        }
        _ if kind.ends_with('*') => format!("(void *)buffers[{number}]"),
        "size_t" if function.name.ends_with("_init") => {
            format!("sizeof({})", function.parameters[0].kind.trim_end_matches(" *"))
        }
        _ => NUMBERS
            .iter()
            .find(|(of, number, _)| (of.is_empty() || *of == function.name) && number == name)
            .map_or("0", |(_, _, value)| value)
            .to_owned(),
    }
}

/// The calls of a function, one a pointer.
fn calls(function: &Function, source: &mut String) -> usize {
    let mut count = 0;
    for (k, parameter) in function.parameters.iter().enumerate() {
        if !parameter.is_pointer() {
            continue;
        }
        let values: Vec<String> = (0..function.parameters.len())
            .map(|other| {
                if other == k {
                    format!("({})NULL", function.parameters[k].kind)
                } else {
                    value(function, other)
                }
            })
            .collect();
        // The free functions accept NULL, and the copy of the last error returns a size.
        let handle = parameter.kind.trim_start_matches("const ").ends_with("hbvib_model *")
            || parameter.kind.ends_with("hbvib_branch *")
            || parameter.kind.ends_with("hbvib_batch *");
        let accepted = function.returns == "size_t"
            || function.name.ends_with("_free")
            || DEFAULT_REFUSED.contains(&(function.name.as_str(), parameter.name.as_str()))
            || !handle && function.is_optional(&parameter.name);
        writeln!(
            source,
            "    try((int64_t){}({}), {}, {}, {}, \"{}, {}\");",
            function.name,
            values.join(", "),
            i32::from(accepted),
            i32::from(handle),
            k + 1,
            function.name,
            parameter.name
        )
        .unwrap();
        count += 1;
    }
    count
}

#[test]
fn null_for_any_pointer_of_any_function_is_refused_or_does_no_harm() {
    let header = fs::read_to_string(root().join("include/hbvib.h")).unwrap();
    let listed = fs::read_to_string(root().join("tests/c_abi/symbols.txt")).unwrap();
    let all = functions(&header);
    let mut names: Vec<&str> = all.iter().map(|function| function.name.as_str()).collect();
    names.sort_unstable();
    assert_eq!(
        names,
        listed.lines().collect::<Vec<_>>(),
        "the header was not read as it is meant"
    );
    let (mut source, mut pointers, mut without) = (String::new(), 0, 0);
    let mut structs: Vec<&str> = all
        .iter()
        .filter(|function| function.name.ends_with("_init"))
        .map(|function| function.parameters[0].kind.trim_end_matches(" *"))
        .collect();
    structs.sort_unstable();
    for name in &structs {
        writeln!(source, "static {name} an_{name}, out_{name};").unwrap();
    }
    writeln!(source, "static void fill(void)\n{{").unwrap();
    for name in &structs {
        for role in ["an", "out"] {
            let call = format!("{name}_init(&{role}_{name}, sizeof {role}_{name})");
            writeln!(source, "    if ({call} != HBVIB_OK) abort();").unwrap();
        }
    }
    writeln!(source, "}}\nstatic void all(void)\n{{").unwrap();
    for function in &all {
        let count = calls(function, &mut source);
        pointers += count;
        without += usize::from(count == 0);
    }
    source.push_str("}\n");
    assert_eq!(without, WITHOUT_POINTERS);
    let folder = workshop("null_pointers");
    fs::write(folder.join("calls.h"), source).unwrap();
    let program = compile(
        "null_pointers",
        &folder,
        &["-Wno-unused-function", &format!("-I{}", folder.display())],
    );
    let output = run(&mut Command::new(program));
    let text = String::from_utf8(output.stdout).unwrap();
    println!("{pointers} pointers of {} functions: {text}", all.len());
    assert!(
        text.starts_with(&format!("{pointers} calls")) && text.ends_with(" 0 failures\n"),
        "{text}"
    );
}
