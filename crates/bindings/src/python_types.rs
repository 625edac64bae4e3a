//! Python: options as typed dictionaries with the defaults of the library, results as named tuples.

use crate::declarations::{Base, Declarations, Result, Struct, Variable};
use crate::layout::{Defaults, Layout};
use crate::python::{class_name, in_python, short, wrapped};
use crate::python_examples::example;
use std::fmt::Write as _;

/// Structs of options, and the fields that the methods of the module have as arguments of their own.
const OPTIONS: [(&str, &[&str]); 6] = [
    ("hbvib_solver_options", &[]),
    (
        "hbvib_time_options",
        &[
            "method",
            "omega",
            "harmonics",
            "samples",
            "start",
            "start_len",
            "places",
            "places_len",
        ],
    ),
    ("hbvib_verify_options", &["method"]),
    ("hbvib_floquet_options", &["waves", "refine"]),
    ("hbvib_synthesis_options", &[]),
    ("hbvib_contact", &["kind", "dof_a", "dof_b"]),
];

/// Structs of results, and the names of their classes where those are not their own.
const RESULTS: [(&str, &str); 12] = [
    ("hbvib_energy", "Energy"),
    ("hbvib_contact_summary", "ContactSummary"),
    ("hbvib_mode_point", "ModePoint"),
    ("hbvib_mode_info", "ModeInfo"),
    ("hbvib_reduction", "Reduction"),
    ("hbvib_descent", "Descent"),
    ("hbvib_searched", "Searched"),
    ("hbvib_kick", "Kick"),
    ("hbvib_best_load", "BestLoad"),
    ("hbvib_jacobian_gap", "JacobianGap"),
    ("hbvib_time_info", "TimeInfo"),
    ("hbvib_verification", "VerificationInfo"),
];

/// Fields that the module gives and takes in another type than C's.
const TYPES: [(&str, &str, &str); 10] = [
    (
        "hbvib_solver_options",
        "flexibility",
        "Union[Flexibility, Literal[\"automatic\", \"direct\", \"krylov\"], int]",
    ),
    (
        "hbvib_solver_options",
        "stability",
        "Union[Stability, Literal[\"none\", \"wave\", \"wheel\"], int]",
    ),
    ("hbvib_mode_info", "multiple", "ModeMultiple"),
    ("hbvib_jacobian_gap", "tangent", "Tangent"),
    ("hbvib_reduction", "mean_carried", "bool"),
    ("hbvib_reduction", "even_removed", "bool"),
    ("hbvib_reduction", "flexibility_way", "FlexibilityWay"),
    ("hbvib_verification", "same_solution", "bool"),
    ("hbvib_verification", "marched", "bool"),
    ("hbvib_kick", "verified", "bool"),
];

/// The generated part of the module of types.
pub fn module(all: &Declarations, defaults: &Defaults) -> Result<String> {
    let taken = OPTIONS.iter().map(|(name, _)| options_class(name));
    let names: Vec<_> = taken
        .chain(RESULTS.iter().map(|(_, class)| (*class).to_owned()))
        .map(|name| format!("\"{name}\""))
        .collect();
    let mut text = wrapped(&format!("__all__ = [{}]", names.join(", ")), "    ");
    for (name, hidden) in OPTIONS {
        text += &options(all, structure(all, name)?, hidden, defaults)?;
    }
    for (name, class) in RESULTS {
        text += &results(all, structure(all, name)?, class)?;
    }
    Ok(text)
}

fn structure<'a>(all: &'a Declarations, name: &str) -> Result<&'a Struct> {
    all.structs
        .iter()
        .find(|s| s.name == name)
        .ok_or_else(|| format!("no struct {name}"))
}

fn is_shown(field: &Variable, hidden: &[&str]) -> bool {
    !matches!(field.name.as_str(), "struct_size" | "reserved") && !hidden.contains(&field.name.as_str())
}

/// The name of a class of options.
fn options_class(name: &str) -> String {
    match name {
        "hbvib_contact" => "ContactConstants".to_owned(),
        _ => class_name(short(name)),
    }
}

/// A class of options: each with its meaning and default in the text, as editors and `help` show it.
fn options(all: &Declarations, s: &Struct, hidden: &[&str], defaults: &Defaults) -> Result<String> {
    let class = options_class(&s.name);
    let layout = Layout::of(all, s)?;
    let bytes = defaults
        .get(&s.name)
        .ok_or_else(|| format!("no defaults of {}", s.name))?;
    let mut docs = String::new();
    let mut fields = String::new();
    for (field, place) in s.fields.iter().zip(&layout.places) {
        if !is_shown(field, hidden) {
            continue;
        }
        let at = |i: usize| &bytes[place.offset + i * place.size..][..place.size];
        let value = match (all.resolved(&field.kind.base), place.count) {
            (Base::Double, 1) => format!("{:?}", f64::from_ne_bytes(eight(at(0))?)),
            (Base::Double, n) => {
                let numbers: Result<Vec<_>> = (0..n)
                    .map(|i| Ok(format!("{:?}", f64::from_ne_bytes(eight(at(i))?))))
                    .collect();
                format!("({})", numbers?.join(", "))
            }
            (Base::Int64, n) if n > 1 => {
                let numbers: Result<Vec<_>> = (0..n)
                    .map(|i| Ok(i64::from_ne_bytes(eight(at(i))?).to_string()))
                    .collect();
                format!("({})", numbers?.join(", "))
            }
            (Base::Int64, 1) => i64::from_ne_bytes(eight(at(0))?).to_string(),
            (Base::Int32, 1) => i32::from_ne_bytes(at(0).try_into().map_err(|_| "four bytes")?).to_string(),
            _ => return Err(format!("{}.{}: no option of Python", s.name, field.name)),
        };
        let doc = in_python(all, &field.doc);
        docs += &wrapped(&format!("    {}   {doc} Default: {value}.", field.name), "        ");
        writeln!(fields, "    {}: {}", field.name, kind(all, s, field)?).unwrap();
    }
    Ok(format!(
        "\n\nclass {class}(TypedDict, total=False):\n    \"\"\"{}\n\n{docs}\n{}    \"\"\"\n{fields}",
        in_python(all, &first_sentence(&s.doc)),
        example(&class)?
    ))
}

/// A class of results.
fn results(all: &Declarations, s: &Struct, class: &str) -> Result<String> {
    let mut docs = String::new();
    let mut fields = String::new();
    for field in s.fields.iter().filter(|field| is_shown(field, &[])) {
        docs += &wrapped(
            &format!("    {}   {}", field.name, in_python(all, &field.doc)),
            "        ",
        );
        writeln!(fields, "    {}: {}", field.name, kind(all, s, field)?).unwrap();
    }
    Ok(format!(
        "\n\nclass {class}(NamedTuple):\n    \"\"\"{}\n\n{docs}\n{}    \"\"\"\n{fields}",
        in_python(all, &first_sentence(&s.doc)),
        example(class)?
    ))
}

fn eight(bytes: &[u8]) -> Result<[u8; 8]> {
    bytes.try_into().map_err(|_| "a field has not eight bytes".into())
}

/// The description of a struct without the sentence about its `_init` function.
fn first_sentence(doc: &str) -> String {
    crate::declarations::sentence(doc).to_owned()
}

/// The type of a field in Python.
fn kind(all: &Declarations, s: &Struct, field: &Variable) -> Result<String> {
    if let Some((.., known)) = TYPES
        .iter()
        .find(|(name, own, _)| *name == s.name && *own == field.name)
    {
        return Ok((*known).to_owned());
    }
    if s.name == "hbvib_verification" && field.name == "response" {
        return Ok("complex".to_owned());
    }
    let base = match all.resolved(&field.kind.base) {
        Base::Double => "float",
        Base::Int32 | Base::Int64 => "int",
        other => return Err(format!("{}.{}: {other:?} has no type in Python", s.name, field.name)),
    };
    Ok(match field.kind.array {
        None => base.to_owned(),
        Some(n) => format!("Tuple[{}]", vec![base; n].join(", ")),
    })
}
