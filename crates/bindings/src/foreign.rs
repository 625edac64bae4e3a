//! For foreign-function interfaces of other languages: a header without preprocessor, and a table of the structs.

use crate::declarations::{Base, Declarations, Function, Result, Type, Variable};
use crate::layout::{Defaults, Layout};
use std::fmt::Write as _;

/// The declarations of hbvib.h as plain C99 without directives and comments, as programs that parse C read them.
pub fn plain_header(all: &Declarations) -> String {
    let mut text = String::from(
        "typedef signed int int32_t;\ntypedef unsigned int uint32_t;\ntypedef signed long long int64_t;\n\
         typedef unsigned long long size_t;\n",
    );
    for name in &all.aliases {
        // One of them is volatile in C, which the size does not show.
        writeln!(text, "typedef int32_t {name};").unwrap();
    }
    for name in &all.opaque {
        writeln!(text, "typedef struct {name} {name};").unwrap();
    }
    for e in &all.enums {
        let members: Vec<_> = e
            .members
            .iter()
            .map(|(name, value, _)| format!("  {name} = {value}"))
            .collect();
        writeln!(text, "typedef enum {{\n{}\n}} {};", members.join(",\n"), e.name).unwrap();
    }
    // A callback may take a pointer to a struct that has it as a field.
    for s in &all.structs {
        writeln!(text, "typedef struct {0} {0};", s.name).unwrap();
    }
    for c in &all.callbacks {
        writeln!(
            text,
            "typedef {}(*{})({});",
            declared(&c.result, ""),
            c.name,
            arguments(c)
        )
        .unwrap();
    }
    for s in &all.structs {
        writeln!(text, "struct {} {{", s.name).unwrap();
        for field in &s.fields {
            writeln!(text, "  {};", variable(field)).unwrap();
        }
        text += "};\n";
    }
    for f in &all.functions {
        writeln!(text, "{}({});", declared(&f.result, &f.name), arguments(f)).unwrap();
    }
    text
}

fn arguments(f: &Function) -> String {
    if f.arguments.is_empty() {
        return "void".into();
    }
    let list: Vec<_> = f.arguments.iter().map(variable).collect();
    list.join(", ")
}

fn variable(v: &Variable) -> String {
    match v.kind.array {
        Some(n) => format!("{}[{n}]", declared(&v.kind, &v.name)),
        None => declared(&v.kind, &v.name),
    }
}

fn declared(kind: &Type, name: &str) -> String {
    let constant = if kind.is_const { "const " } else { "" };
    format!("{constant}{} {}{name}", base(&kind.base), "*".repeat(kind.pointers))
}

fn base(base: &Base) -> &str {
    match base {
        Base::Void => "void",
        Base::Char => "char",
        Base::Int32 => "int32_t",
        Base::Uint32 => "uint32_t",
        Base::Int64 => "int64_t",
        Base::Size => "size_t",
        Base::Double => "double",
        Base::Named(name) => name,
    }
}

/// Tables of the structs in Markdown: type, offset and default of each field.
pub fn tables(all: &Declarations, defaults: &Defaults) -> Result<String> {
    let mut text = String::new();
    for s in &all.structs {
        let layout = Layout::of(all, s)?;
        let bytes = defaults
            .get(&s.name)
            .ok_or_else(|| format!("no defaults of {}", s.name))?;
        write!(
            text,
            "\n### {} ({} bytes)\n\n| offset | bytes | type | field | default |\n|---|---|---|---|---|\n",
            s.name, layout.size
        )
        .unwrap();
        for (field, place) in s.fields.iter().zip(&layout.places) {
            let array = field.kind.array.map_or(String::new(), |n| format!("[{n}]"));
            let entry = &bytes[place.offset..place.offset + place.size];
            writeln!(
                text,
                "| {} | {} | `{}{array}` | `{}` | {} |",
                place.offset,
                place.size * place.count,
                declared(&field.kind, "").trim_end(),
                field.name,
                value(all.resolved(&field.kind.base), &field.kind, entry)?
            )
            .unwrap();
        }
    }
    Ok(text)
}

/// The first entry of a field as a number; a pointer is NULL.
fn value(base: &Base, kind: &Type, bytes: &[u8]) -> Result<String> {
    let error = |_| format!("a field of {} bytes", bytes.len());
    if kind.pointers > 0 || matches!(base, Base::Named(_)) {
        return Ok("NULL".into());
    }
    Ok(match base {
        Base::Double => format!("{:?}", f64::from_ne_bytes(bytes.try_into().map_err(error)?)),
        Base::Int64 | Base::Size => i64::from_ne_bytes(bytes.try_into().map_err(error)?).to_string(),
        Base::Uint32 => u32::from_ne_bytes(bytes.try_into().map_err(error)?).to_string(),
        _ => i32::from_ne_bytes(bytes.try_into().map_err(error)?).to_string(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEADER: &str = "typedef int32_t hbvib_status;\n\ntypedef struct hbvib_model hbvib_model;\n\n\
        typedef int32_t (*hbvib_fn)(void *user);\n\n\
        typedef struct {\n  uint32_t struct_size;\n  int32_t a;\n  double x[3];\n  hbvib_fn call;\n} hbvib_view;\n\n\
        /// Does.\n///\n/// v, n  all.\nhbvib_status hbvib_do(const hbvib_view *v, int64_t n);\n\n\
        uint32_t hbvib_version(void);\n";

    #[test]
    fn the_plain_header_has_every_declaration() {
        let text = plain_header(&Declarations::parse(HEADER).unwrap());
        for line in [
            "typedef int32_t hbvib_status;",
            "typedef struct hbvib_model hbvib_model;",
            "typedef int32_t (*hbvib_fn)(void *user);",
            "struct hbvib_view {\n  uint32_t struct_size;\n  int32_t a;\n  double x[3];\n  hbvib_fn call;\n};",
            "hbvib_status hbvib_do(const hbvib_view *v, int64_t n);",
            "uint32_t hbvib_version(void);",
        ] {
            assert!(text.contains(line), "no {line} in\n{text}");
        }
    }

    #[test]
    fn tables_have_offsets_and_defaults() {
        let all = Declarations::parse(HEADER).unwrap();
        let mut bytes = vec![0; 40];
        bytes[0] = 40;
        bytes[8..16].copy_from_slice(&0.5_f64.to_ne_bytes());
        let text = tables(&all, &Defaults::from([("hbvib_view".to_owned(), bytes)])).unwrap();
        assert!(text.contains("### hbvib_view (40 bytes)"), "{text}");
        assert!(text.contains("| 8 | 24 | `double[3]` | `x` | 0.5 |"), "{text}");
        assert!(text.contains("| 32 | 8 | `hbvib_fn` | `call` | NULL |"), "{text}");
    }
}
