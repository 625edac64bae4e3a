//! Fortran: constants, types and raw interfaces of the module hbvib, and the layouts for its test.

use crate::declarations::{Base, Declarations, Function, Result, Struct, Type, Variable, sentence};
use crate::layout::{Defaults, Layout, Place};
use std::fmt::Write as _;

/// Columns of free source form, without the continuation sign.
const COLUMNS: usize = 130;

/// Fortran ignores case: types with the names of constants are renamed.
const RENAMED: [(&str, &str); 1] = [("hbvib_energy", "hbvib_energies")];

/// Defaults that differ from those in C, because indices count from 1, or a name replaces a number.
const OWN_DEFAULTS: [(&str, &str, &str); 7] = [
    ("hbvib_matrix", "index_base", "1"),
    ("hbvib_mode_options", "mode_index", "1"),
    ("hbvib_mode_options", "diameter", "HBVIB_DIAMETER_OF_ENGINE_ORDER"),
    ("hbvib_contact", "dof_a", "HBVIB_GROUND"),
    ("hbvib_contact", "dof_b", "HBVIB_GROUND"),
    ("hbvib_contact", "rotation", "HBVIB_GROUND"),
    ("hbvib_damper_face", "dofs", "HBVIB_GROUND"),
];

/// The generated part of the module.
pub fn module(all: &Declarations, defaults: &Defaults) -> Result<String> {
    let mut text = String::new();
    for e in &all.enums {
        let constants: Vec<_> = e
            .members
            .iter()
            .map(|(name, value, _)| format!("{name} = {value}"))
            .collect();
        writeln!(text, "   ! {}", e.name).unwrap();
        text += &wrapped(3, "integer(c_int32_t), parameter, public :: ", &constants);
    }
    let [major, minor, patch] = all.version;
    text +=
        "   ! Version of the library that this module was written for; hbvib_version() is that of the one in use.\n";
    text += &wrapped(
        3,
        "integer(c_int32_t), parameter, public :: ",
        &[
            format!("HBVIB_VERSION_MAJOR = {major}"),
            format!("HBVIB_VERSION_MINOR = {minor}"),
            format!("HBVIB_VERSION_PATCH = {patch}"),
            format!("HBVIB_VERSION_NUMBER = {}", major * 65536 + minor * 256 + patch),
        ],
    );
    for s in &all.structs {
        text.push('\n');
        text += &structure(all, s, &defaults[&s.name])?;
    }
    text += "\n   abstract interface\n";
    text += &procedures(all, &all.callbacks)?;
    text += "   end interface\n\n";
    text += "   ! The functions of hbvib.h by their C names. Arguments that may be NULL there are optional here.\n";
    text += "   interface\n";
    text += &procedures(all, &all.functions)?;
    text += "   end interface\n";
    Ok(text)
}

fn structure(all: &Declarations, s: &Struct, bytes: &[u8]) -> Result<String> {
    let name = type_name(all, &s.name)?;
    let layout = Layout::of(all, s)?;
    let mut text = comment(3, sentence(&s.doc));
    writeln!(text, "   type, bind(c) :: {name}").unwrap();
    let fields = s.fields.iter().zip(&layout.places).map(|(field, place)| {
        let (kind, components) = field_type(all, field);
        let known = OWN_DEFAULTS.iter().find(|(of, f, _)| *of == s.name && *f == field.name);
        let default = match known {
            Some((.., value)) => (*value).to_owned(),
            None => default(all, &field.kind, place, bytes).map_err(|e| format!("{}.{}: {e}", s.name, field.name))?,
        };
        let shape = components.map_or(String::new(), |n| format!("({n})"));
        Ok((kind, format!("{}{shape} = {default}", field.name)))
    });
    text += &grouped(6, &fields.collect::<Result<Vec<_>>>()?);
    writeln!(text, "   end type {name}").unwrap();
    Ok(text)
}

/// The Fortran type of a field, and its length if it is an array there.
fn field_type(all: &Declarations, field: &Variable) -> (&'static str, Option<usize>) {
    let kind = &field.kind;
    if kind.pointers > 0 {
        return ("type(c_ptr)", kind.array);
    }
    match all.resolved(&kind.base) {
        // One complex number.
        Base::Double if kind.array == Some(2) && field.doc.contains("(re, im)") => ("complex(c_double_complex)", None),
        Base::Named(_) => ("type(c_funptr)", kind.array),
        base => (value_type(base), kind.array),
    }
}

fn value_type(base: &Base) -> &'static str {
    match base {
        Base::Int32 | Base::Uint32 => "integer(c_int32_t)",
        Base::Int64 => "integer(c_int64_t)",
        Base::Size => "integer(c_size_t)",
        Base::Double => "real(c_double)",
        Base::Char => "character(kind=c_char)",
        Base::Void | Base::Named(_) => "type(c_ptr)",
    }
}

/// The default of a field from the bytes of its struct: one value for all entries of an array where they are equal,
/// else a list of them.
fn default(all: &Declarations, kind: &Type, place: &Place, bytes: &[u8]) -> Result<String> {
    let entry = |i: usize| {
        let start = place.offset + i * place.size;
        &bytes[start..start + place.size]
    };
    if (1..place.count).all(|i| entry(i) == entry(0)) {
        return constant(all, kind, entry(0));
    }
    let entries: Result<Vec<String>> = (0..place.count).map(|i| constant(all, kind, entry(i))).collect();
    Ok(format!("[{}]", entries?.join(", ")))
}

/// A constant from its bytes.
fn constant(all: &Declarations, kind: &Type, bytes: &[u8]) -> Result<String> {
    let whole = match *bytes {
        [a, b, c, d] => i64::from(i32::from_ne_bytes([a, b, c, d])),
        [a, b, c, d, e, f, g, h] => i64::from_ne_bytes([a, b, c, d, e, f, g, h]),
        _ => return Err("neither 4 nor 8 bytes".into()),
    };
    let is_pointer = kind.pointers > 0;
    match all.resolved(&kind.base) {
        base if is_pointer || matches!(base, Base::Named(_)) => {
            if whole != 0 {
                return Err("a pointer that is not NULL".into());
            }
            Ok(if is_pointer { "c_null_ptr" } else { "c_null_funptr" }.into())
        }
        Base::Double => Ok(real(f64::from_bits(whole.cast_unsigned()))),
        _ => Ok(whole.to_string()),
    }
}

/// A real constant, written exactly.
fn real(value: f64) -> String {
    if value.fract() == 0.0 && value.abs() < 1e6 {
        return format!("{value}");
    }
    let (plain, exponent) = (format!("{value}"), format!("{value:e}"));
    format!(
        "{}_c_double",
        if plain.len() < exponent.len() { plain } else { exponent }
    )
}

fn procedures(all: &Declarations, functions: &[Function]) -> Result<String> {
    let mut text = String::new();
    for (i, f) in functions.iter().enumerate() {
        if i > 0 {
            text.push('\n');
        }
        let is_callback = all.callbacks.iter().any(|c| c.name == f.name);
        if is_callback {
            text += &comment(6, sentence(&f.doc));
        }
        text += &procedure(all, f, is_callback)?;
    }
    Ok(text)
}

fn procedure(all: &Declarations, f: &Function, is_callback: bool) -> Result<String> {
    let names: Vec<_> = f.arguments.iter().map(|a| a.name.clone()).collect();
    let is_void = f.result.is(&Base::Void);
    let word = if is_void { "subroutine" } else { "function" };
    let result = match &f.result {
        kind if kind.is(&Base::Void) => "",
        kind if kind.is(&Base::Named("hbvib_status".into())) => "status",
        _ => "answer",
    };
    let mut head = names.clone();
    let end = if is_void {
        ") bind(c)".into()
    } else {
        format!(") bind(c) result({result})")
    };
    match head.last_mut() {
        Some(last) => *last += &end,
        None => head.push(end),
    }
    let mut text = wrapped(6, &format!("{word} {}(", f.name), &head);
    text += "         import\n";
    let mut lines = Vec::new();
    for a in &f.arguments {
        lines.push(argument(all, f, a, is_callback)?);
    }
    if !is_void {
        let kind = if f.result.pointers > 0 {
            "type(c_ptr)"
        } else {
            value_type(all.resolved(&f.result.base))
        };
        lines.push((kind.into(), result.to_owned()));
    }
    text += &grouped(9, &lines);
    writeln!(text, "      end {word} {}", f.name).unwrap();
    Ok(text)
}

/// Type and attributes of an argument, and the argument.
fn argument(all: &Declarations, f: &Function, a: &Variable, is_callback: bool) -> Result<(String, String)> {
    let kind = &a.kind;
    let base = all.resolved(&kind.base);
    let name = &a.name;
    let value = |kind: &str| Ok((format!("{kind}, value"), name.clone()));
    let optional = if a.doc.contains("NULL") { ", optional" } else { "" };
    let intent = if kind.is_const { "in" } else { "inout" };
    match (base, kind.pointers) {
        (base, 0) => value(value_type(base)),
        (Base::Void, 1) => value("type(c_ptr)"),
        // Text that the library passes to a callback.
        (Base::Char, 1) if is_callback => value("type(c_ptr)"),
        (base, 1) if all.is_opaque(base) => value("type(c_ptr)"),
        (base, 2) if all.is_opaque(base) => Ok(("type(c_ptr), intent(inout)".into(), name.clone())),
        (Base::Named(of), 1) => {
            let shape = if a.doc.contains("array of") { "(*)" } else { "" };
            Ok((
                format!("type({}), intent({intent}){optional}", type_name(all, of)?),
                format!("{name}{shape}"),
            ))
        }
        (base, 1) => {
            let is_complex = *base == Base::Double && a.doc.contains("complex");
            let of = if is_complex {
                "complex(c_double_complex)"
            } else {
                value_type(base)
            };
            // A scalar receives one number.
            let is_one = *base == Base::Int64 && !kind.is_const && !a.doc.contains("numbers");
            let shape = if is_one { "" } else { "(*)" };
            Ok((format!("{of}, intent({intent}){optional}"), format!("{name}{shape}")))
        }
        _ => Err(format!("{}: no type for {name}", f.name)),
    }
}

/// The name of a struct; an error if it is that of a constant in other case.
fn type_name<'a>(all: &Declarations, name: &'a str) -> Result<&'a str> {
    if let Some((_, other)) = RENAMED.iter().find(|(known, _)| *known == name) {
        return Ok(other);
    }
    let mut constants = all.enums.iter().flat_map(|e| &e.members);
    if constants.any(|(constant, ..)| constant.eq_ignore_ascii_case(name)) {
        return Err(format!(
            "Fortran needs another name for {name}, which is that of a constant"
        ));
    }
    Ok(name)
}

/// Declarations, with neighbours of one type in one statement.
fn grouped<K: AsRef<str>>(indent: usize, items: &[(K, String)]) -> String {
    let mut text = String::new();
    let mut rest = items;
    while let Some((kind, _)) = rest.first() {
        let kind = kind.as_ref();
        let n = rest.iter().take_while(|(k, _)| k.as_ref() == kind).count();
        let names: Vec<_> = rest[..n].iter().map(|(_, name)| name.clone()).collect();
        text += &wrapped(indent, &format!("{kind} :: "), &names);
        rest = &rest[n..];
    }
    text
}

/// A statement with a list; a long one is continued on further lines.
fn wrapped(indent: usize, start: &str, items: &[String]) -> String {
    let mut text = format!("{:indent$}{start}", "");
    let mut column = text.len();
    for (i, item) in items.iter().enumerate() {
        let last = i + 1 == items.len();
        let comma = if last { "" } else { "," };
        if i > 0 {
            if column + 1 + item.len() + comma.len() > COLUMNS - 2 {
                write!(text, " &\n{:1$}", "", indent + 3).unwrap();
                column = indent + 3;
            } else {
                text.push(' ');
                column += 1;
            }
        }
        text += item;
        text += comma;
        column += item.len() + comma.len();
    }
    text + "\n"
}

fn comment(indent: usize, sentence: &str) -> String {
    let mut text = String::new();
    let mut line = format!("{:indent$}!>", "");
    for word in sentence.split(' ') {
        if line.len() + 1 + word.len() > COLUMNS {
            text += &line;
            text.push('\n');
            line = format!("{:indent$}!>", "");
        }
        line.push(' ');
        line += word;
    }
    text + &line + "\n"
}

/// The subroutines of tests/languages/fortran/layout.f90, one per struct, and their calls.
pub fn layouts(all: &Declarations) -> Result<(String, String)> {
    let (mut calls, mut bodies) = (String::new(), String::new());
    for s in &all.structs {
        let short = s.name.trim_start_matches("hbvib_");
        writeln!(calls, "   call {short}()").unwrap();
        writeln!(bodies, "   subroutine {short}()").unwrap();
        writeln!(bodies, "      type({}), target :: s", type_name(all, &s.name)?).unwrap();
        writeln!(bodies, "      call whole('{}', c_sizeof(s))", s.name).unwrap();
        for field in &s.fields {
            let name = &field.name;
            writeln!(
                bodies,
                "      call field('{name}', c_loc(s), c_loc(s%{name}), c_sizeof(s%{name}))"
            )
            .unwrap();
        }
        writeln!(bodies, "   end subroutine {short}\n").unwrap();
    }
    Ok((calls, bodies))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::layout::defaults;

    const HEADER: &str = "typedef int32_t hbvib_status;\n\n\
        typedef enum {\n  HBVIB_GROUND = -1,\n  HBVIB_ENERGY = 3,\n} hbvib_dof;\n\n\
        typedef struct hbvib_model hbvib_model;\n\n\
        /// A view of numbers. Fill it.\ntypedef struct {\n  uint32_t struct_size;\n  int32_t rank;\n  double tol;\n  \
        const double *data;\n  int64_t shape[3];\n  /// (re, im).\n  double x[2];\n  hbvib_fn call;\n} hbvib_view;\n\n\
        /// Called often. Quickly.\ntypedef int32_t (*hbvib_fn)(void *user, const hbvib_view *view, const char *text);\n\n\
        hbvib_status hbvib_view_init(int64_t a);\n\n\
        /// Does.\n///\n/// x      complex numbers, or NULL.\n/// y      real.\n/// count  how many.\n/// point  receives numbers.\n\
        /// out    the model.\n/// view   it; may be NULL.\n\
        hbvib_status hbvib_do(const hbvib_model *model, const double *x, double *y, int64_t n, int64_t m, int64_t *count, \
        int64_t *point, hbvib_model **out, hbvib_view *view);\n\n\
        const char *hbvib_name(void);\n";

    fn all() -> Declarations {
        Declarations::parse(HEADER).unwrap()
    }

    fn text() -> String {
        let all = all();
        let fill = |_: &str, bytes: &mut [u8]| {
            bytes[4..8].copy_from_slice(&(-1_i32).to_ne_bytes());
            bytes[8..16].copy_from_slice(&1e-11_f64.to_ne_bytes());
            for i in 0..3 {
                bytes[24 + 8 * i..32 + 8 * i].copy_from_slice(&1_i64.to_ne_bytes());
            }
            Ok(())
        };
        module(&all, &defaults(&all, fill).unwrap()).unwrap()
    }

    #[test]
    fn types_have_the_defaults_of_the_library() {
        let text = text();
        for line in [
            "   !> A view of numbers.\n   type, bind(c) :: hbvib_view\n",
            "      integer(c_int32_t) :: struct_size = 72, rank = -1\n",
            "      real(c_double) :: tol = 1e-11_c_double\n",
            "      type(c_ptr) :: data = c_null_ptr\n",
            "      integer(c_int64_t) :: shape(3) = 1\n",
            "      complex(c_double_complex) :: x = 0\n",
            "      type(c_funptr) :: call = c_null_funptr\n",
        ] {
            assert!(text.contains(line), "no {line} in\n{text}");
        }
    }

    #[test]
    fn interfaces_say_what_may_be_absent_complex_or_an_array() {
        let text = text();
        for line in [
            "function hbvib_do(model, x, y, n, m, count, point, out, view) bind(c) result(status)\n         import\n",
            "         type(c_ptr), value :: model\n",
            "         complex(c_double_complex), intent(in), optional :: x(*)\n",
            "         real(c_double), intent(inout) :: y(*)\n",
            "         integer(c_int64_t), value :: n, m\n",
            "         integer(c_int64_t), intent(inout) :: count, point(*)\n",
            "         type(c_ptr), intent(inout) :: out\n",
            "         type(hbvib_view), intent(inout), optional :: view\n",
            "         integer(c_int32_t) :: status\n      end function hbvib_do\n",
            "      !> Called often.\n      function hbvib_fn(user, view, text) bind(c) result(answer)\n",
            "         type(hbvib_view), intent(in) :: view\n         type(c_ptr), value :: text\n",
            "      function hbvib_name() bind(c) result(answer)\n         import\n         type(c_ptr) :: answer\n",
        ] {
            assert!(text.contains(line), "no {line} in\n{text}");
        }
    }

    #[test]
    fn a_type_with_the_name_of_a_constant_needs_another() {
        let all = all();
        assert_eq!(type_name(&all, "hbvib_energy"), Ok("hbvib_energies"));
        assert!(type_name(&all, "hbvib_ground").is_err());
    }

    #[test]
    fn long_lists_are_continued() {
        let names: Vec<_> = (0..40).map(|i| format!("name_{i}")).collect();
        let text = wrapped(3, "call f(", &names);
        assert!(text.lines().count() > 1 && text.lines().all(|line| line.len() <= COLUMNS));
    }

    #[test]
    fn numbers_are_written_exactly() {
        assert_eq!(
            [0.0, 1.0, 0.1, 1e-3, 1e-10].map(real),
            ["0", "1", "0.1_c_double", "1e-3_c_double", "1e-10_c_double"]
        );
    }
}
