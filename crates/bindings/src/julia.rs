//! Julia: constants, structs and functions of the header by their C names.

use crate::declarations::{Base, Declarations, Result, Type, sentence};
use std::fmt::Write as _;

/// Names that Julia keeps for itself.
const RESERVED: [&str; 2] = ["function", "end"];

/// The generated part of the module.
pub fn raw(all: &Declarations) -> Result<String> {
    let mut text = String::new();
    for (name, value, _) in all.enums.iter().flat_map(|e| &e.members) {
        writeln!(text, "const {name} = Int32({value})").unwrap();
    }
    for s in &all.structs {
        writeln!(text, "\n\"{}\"\nstruct {}", escaped(sentence(&s.doc)), s.name).unwrap();
        for field in &s.fields {
            let kind = value_type(all, &field.kind).map_err(|e| format!("{}.{}: {e}", s.name, field.name))?;
            let kind = match field.kind.array {
                Some(n) => format!("NTuple{{{n}, {kind}}}"),
                None => kind,
            };
            writeln!(text, "    {}::{kind}", field.name).unwrap();
        }
        text += "end\n";
        if all.function(&format!("{}_init", s.name)).is_some() {
            writeln!(text, "{0}() = initialised({0}, dlsym_(:{0}_init))", s.name).unwrap();
        }
    }
    text.push('\n');
    for f in &all.functions {
        let mut names = Vec::new();
        let mut kinds = Vec::new();
        for a in &f.arguments {
            if RESERVED.contains(&a.name.as_str()) {
                return Err(format!("{}: {} is a word of Julia", f.name, a.name));
            }
            names.push(a.name.clone());
            kinds.push(value_type(all, &a.kind).map_err(|e| format!("{}: {e}", f.name))?);
        }
        let result = value_type(all, &f.result)?;
        let kinds = if kinds.len() == 1 {
            format!("({},)", kinds[0])
        } else {
            format!("({})", kinds.join(", "))
        };
        let passed: Vec<&str> = [kinds.as_str()]
            .into_iter()
            .chain(names.iter().map(String::as_str))
            .collect();
        writeln!(text, "\"{}\"", escaped(sentence(&f.doc))).unwrap();
        writeln!(
            text,
            "{0}({1}) = ccall(dlsym_(:{0}), {result}, {2})",
            f.name,
            names.join(", "),
            passed.join(", ")
        )
        .unwrap();
    }
    Ok(text)
}

/// A description within quotation marks.
fn escaped(doc: &str) -> String {
    doc.replace('\\', "\\\\").replace('"', "\\\"").replace('$', "\\$")
}

/// The type of a field, an argument or a result.
fn value_type(all: &Declarations, kind: &Type) -> Result<String> {
    let base = match all.resolved(&kind.base) {
        Base::Void if kind.pointers == 0 => "Cvoid",
        Base::Void => "Cvoid",
        Base::Char if kind.pointers == 1 && kind.is_const => return Ok("Cstring".to_owned()),
        Base::Char => "UInt8",
        Base::Int32 => "Int32",
        Base::Uint32 => "UInt32",
        Base::Int64 => "Int64",
        Base::Size => "Csize_t",
        Base::Double => "Float64",
        base if all.is_opaque(base) => "Cvoid",
        Base::Named(name) if all.callbacks.iter().any(|c| c.name == *name) => "Ptr{Cvoid}",
        Base::Named(name) if all.structs.iter().any(|s| s.name == *name) => name,
        Base::Named(name) => return Err(format!("no type of Julia for {name}")),
    };
    Ok((0..kind.pointers).fold(base.to_owned(), |inner, _| format!("Ptr{{{inner}}}")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_types_and_pointers_are_those_of_c() {
        let header = "typedef int32_t hbvib_status;\n\ntypedef struct hbvib_model hbvib_model;\n\n\
            /// Views. They are of all.\ntypedef struct {\n  uint32_t struct_size;\n  double axis[3];\n  const double *data;\n} hbvib_view;\n\n\
            /// Does.\n///\n/// v, out  all.\nhbvib_status hbvib_do(const hbvib_model *model, const hbvib_view *v, hbvib_model **out);\n\n\
            /// Name.\nconst char *hbvib_name(hbvib_status status);\n";
        let text = raw(&Declarations::parse(header).unwrap()).unwrap();
        for part in [
            "\"Views.\"\nstruct hbvib_view\n    struct_size::UInt32\n    axis::NTuple{3, Float64}\n    data::Ptr{Float64}\nend\n",
            "hbvib_do(model, v, out) = ccall(dlsym_(:hbvib_do), Int32, (Ptr{Cvoid}, Ptr{hbvib_view}, Ptr{Ptr{Cvoid}}), model, v, out)",
            "hbvib_name(status) = ccall(dlsym_(:hbvib_name), Cstring, (Int32,), status)",
        ] {
            assert!(text.contains(part), "no {part} in\n{text}");
        }
    }
}
