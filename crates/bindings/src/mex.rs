//! MATLAB and GNU Octave: tables of constants and structs, and one caller per function, of the gateway matlab/hbvib_mex.c.

use crate::declarations::{Base, Declarations, Function, Result, Struct, Variable};
use std::fmt::Write as _;

/// Functions that the gateway leaves out: they hand over memory or callbacks, which it does itself or which MATLAB has not.
const LEFT_OUT: [&str; 3] = ["hbvib_last_error_copy", "hbvib_cancel", "hbvib_model_add_user_force"];

/// The generated part of the gateway.
pub fn gateway(all: &Declarations) -> Result<String> {
    let mut text = String::from("static const Constant CONSTANTS[] = {\n");
    for (name, value, _) in all.enums.iter().flat_map(|e| &e.members) {
        writeln!(text, "  {{\"{}\", {value}}},", name.trim_start_matches("HBVIB_")).unwrap();
    }
    text += "};\n\n";
    let passed: Vec<_> = all.structs.iter().filter(|s| is_passed(all, s)).collect();
    for s in &passed {
        writeln!(text, "static const Struct {};", table(&s.name)).unwrap();
    }
    for s in &passed {
        text += &structure(all, s)?;
    }
    let called: Vec<_> = all.functions.iter().filter(|f| !is_left_out(f)).collect();
    for f in &called {
        text += &caller(all, f)?;
    }
    text += "\nstatic const Function FUNCTIONS[] = {\n";
    for f in &called {
        let short = f.name.trim_start_matches("hbvib_");
        writeln!(text, "  {{\"{short}\", call_{short}, {}}},", inputs(all, f)?).unwrap();
    }
    text += "};\n";
    Ok(text)
}

/// The functions that fill a struct are called by the gateway itself.
fn is_left_out(f: &Function) -> bool {
    LEFT_OUT.contains(&f.name.as_str()) || f.name.ends_with("_init")
}

/// Whether a struct is filled or read by the caller; hooks are the gateway's own, and a view becomes an array.
fn is_passed(all: &Declarations, s: &Struct) -> bool {
    let own = matches!(s.name.as_str(), "hbvib_hooks" | "hbvib_view" | "hbvib_user_force");
    !own && all.function(&format!("{}_init", s.name)).is_some()
}

/// The name of the table of a struct.
fn table(name: &str) -> String {
    name.trim_start_matches("hbvib_").to_uppercase() + "_STRUCT"
}

/// Whether an array of doubles has pairs (re, im).
fn is_complex(v: &Variable) -> bool {
    let pairs = v.doc.contains("complex") && !v.doc.contains("each is two doubles if complex");
    v.kind.base == Base::Double && v.kind.pointers == 1 && pairs
}

fn structure(all: &Declarations, s: &Struct) -> Result<String> {
    let short = s.name.trim_start_matches("hbvib_");
    let mut text = format!("static const Field {short}_fields[] = {{\n");
    for field in &s.fields {
        if matches!(field.name.as_str(), "struct_size" | "reserved") {
            continue;
        }
        let (kind, nested) = match (all.resolved(&field.kind.base), field.kind.pointers) {
            (Base::Int32, 0) => ("INT32", None),
            (Base::Int64, 0) => ("INT64", None),
            (Base::Double, 0) => ("DOUBLE", None),
            (Base::Double, 1) if is_complex(field) => ("COMPLEXES", None),
            (Base::Double, 1) => ("DOUBLES", None),
            (Base::Int64, 1) => ("INT64S", None),
            (Base::Named(name), 1) if !all.is_opaque(&field.kind.base) => ("STRUCTS", Some(table(name))),
            _ => return Err(format!("{}.{}: no kind for MATLAB", s.name, field.name)),
        };
        let nested = nested.map_or("NULL".to_owned(), |name| format!("&{name}"));
        let count = field.kind.array.unwrap_or(1);
        let name = &field.name;
        writeln!(
            text,
            "  {{\"{name}\", {kind}, offsetof({}, {name}), {count}, {nested}}},",
            s.name
        )
        .unwrap();
    }
    writeln!(
        text,
        "}};\nstatic hbvib_status {short}_fill(void *s) {{ return {0}_init(s, sizeof({0})); }}",
        s.name
    )
    .unwrap();
    let count = format!("sizeof {short}_fields / sizeof *{short}_fields");
    writeln!(
        text,
        "static const Struct {} = {{\"{short}\", sizeof({}), {short}_fields, {count}, {short}_fill}};\n",
        table(&s.name),
        s.name
    )
    .unwrap();
    Ok(text)
}

/// How the gateway passes an argument.
enum Passed {
    /// Read by this expression before the call.
    Input(String),
    /// An input with the number of entries of an array, which is an output after the call, and the call that makes it one.
    Array(&'static str, &'static str, &'static str),
    /// One whole number that is an output.
    One,
    Handle,
    Structure(String),
    View,
}

fn passed(all: &Declarations, f: &Function, a: &Variable) -> Result<Passed> {
    let kind = &a.kind;
    let name = &a.name;
    let input = |reader: &str| Ok(Passed::Input(format!("{reader}(a, \"{name}\")")));
    match (all.resolved(&kind.base), kind.pointers, kind.is_const) {
        (Base::Int32, 0, _) => input("(int32_t)whole32"),
        (Base::Int64, 0, _) => input("whole"),
        (Base::Size, 0, _) => input("(size_t)whole"),
        (Base::Double, 0, _) => input("real"),
        (base, 1, _) if all.is_opaque(base) => input("handle"),
        (base, 2, false) if all.is_opaque(base) => Ok(Passed::Handle),
        (Base::Named(of), 1, true) if of == "hbvib_hooks" => input("hooks"),
        (Base::Named(of), 1, false) if of == "hbvib_view" => Ok(Passed::View),
        (Base::Named(of), 1, true) => Ok(Passed::Input(format!("structs(a, \"{name}\", &{})", table(of)))),
        (Base::Named(of), 1, false) => Ok(Passed::Structure(of.clone())),
        (Base::Char, 1, true) => input("text"),
        (Base::Void, 1, true) => input("bytes"),
        (Base::Void, 1, false) => Ok(Passed::Array("uint8_t", "1", "give_bytes")),
        (Base::Double, 1, true) if is_complex(a) => input("complexes"),
        (Base::Double, 1, true) => input("reals"),
        (Base::Int64, 1, true) => input("wholes"),
        (Base::Int32, 1, true) => input("wholes32"),
        (Base::Double, 1, false) if is_complex(a) => Ok(Passed::Array("double", "2", "give_complexes")),
        (Base::Double, 1, false) => Ok(Passed::Array("double", "1", "give_reals")),
        (Base::Int64, 1, false) if a.doc.contains("numbers") => Ok(Passed::Array("int64_t", "1", "give_wholes")),
        (Base::Int64, 1, false) => Ok(Passed::One),
        (Base::Int32, 1, false) => Ok(Passed::Array("int32_t", "1", "give_wholes32")),
        _ => Err(format!("{}: no kind for MATLAB for {name}", f.name)),
    }
}

/// The number of inputs of a function.
fn inputs(all: &Declarations, f: &Function) -> Result<usize> {
    let mut count = 0;
    for a in &f.arguments {
        count += usize::from(matches!(passed(all, f, a)?, Passed::Input(_) | Passed::Array(..)));
    }
    Ok(count)
}

/// The C function that reads the inputs, calls, and gives the outputs in the order of the arguments, then the result.
fn caller(all: &Declarations, f: &Function) -> Result<String> {
    let short = f.name.trim_start_matches("hbvib_");
    let (mut before, mut given, mut after) = (String::new(), Vec::new(), String::new());
    for a in &f.arguments {
        let v = format!("{}_", a.name);
        match passed(all, f, a)? {
            Passed::Input(reader) => {
                let of = declared(a);
                writeln!(before, "  {of}{v} = {reader};").unwrap();
                given.push(v);
            }
            Passed::Array(of, width, giver) => {
                writeln!(before, "  int64_t {v}n = room(a, \"{}\");", a.name).unwrap();
                writeln!(before, "  {of} *{v} = array({v}n, {width} * sizeof({of}));").unwrap();
                writeln!(after, "  {giver}(a, {v}, {v}n);").unwrap();
                given.push(v);
            }
            Passed::One => {
                writeln!(before, "  int64_t {v} = 0;").unwrap();
                writeln!(after, "  give_number(a, (double){v});").unwrap();
                given.push(format!("&{v}"));
            }
            Passed::Handle => {
                let kind = f_base(a).trim_start_matches("hbvib_");
                writeln!(before, "  {} *{v} = NULL;", f_base(a)).unwrap();
                writeln!(after, "  give_{kind}(a, {v});").unwrap();
                given.push(format!("&{v}"));
            }
            Passed::Structure(of) => {
                writeln!(before, "  {of} {v};\n  {of}_init(&{v}, sizeof {v});").unwrap();
                writeln!(after, "  give_struct(a, &{v}, &{});", table(&of)).unwrap();
                given.push(format!("&{v}"));
            }
            Passed::View => {
                writeln!(before, "  hbvib_view {v};\n  hbvib_view_init(&{v}, sizeof {v});").unwrap();
                writeln!(after, "  give_view(a, &{v});").unwrap();
                given.push(format!("&{v}"));
            }
        }
    }
    let call = format!("{}({})", f.name, given.join(", "));
    let is_status = f.result.is(&Base::Named("hbvib_status".into()));
    let mut text = format!("static void call_{short}(Call *a) {{\n{before}");
    if is_status {
        writeln!(
            text,
            "  hbvib_status status_ = {call};\n{after}  finish(a, status_);\n}}\n"
        )
        .unwrap();
    } else if f.result.pointers > 0 {
        writeln!(text, "  give_text(a, {call});\n}}\n").unwrap();
    } else {
        writeln!(
            text,
            "  double result_ = (double){call};\n  give_count(a, result_);\n}}\n"
        )
        .unwrap();
    }
    Ok(text)
}

fn f_base(a: &Variable) -> &str {
    match &a.kind.base {
        Base::Named(name) => name,
        _ => "void",
    }
}

/// The declaration of a variable for an input, without its name.
fn declared(a: &Variable) -> String {
    let base = match &a.kind.base {
        Base::Void => "void",
        Base::Char => "char",
        Base::Int32 => "int32_t",
        Base::Uint32 => "uint32_t",
        Base::Int64 => "int64_t",
        Base::Size => "size_t",
        Base::Double => "double",
        Base::Named(name) => name,
    };
    match (a.kind.pointers, a.kind.is_const) {
        (0, _) => format!("{base} "),
        (_, true) => format!("const {base} *"),
        (_, false) => format!("{base} *"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEADER: &str = "typedef int32_t hbvib_status;\n\ntypedef enum {\n  HBVIB_MASS = 0,\n} hbvib_kind;\n\n\
        typedef struct hbvib_model hbvib_model;\n\n\
        typedef struct {\n  uint32_t struct_size;\n  int32_t kind;\n  double axis[3];\n  /// Complex, ndof complex numbers.\n  \
        const double *shape;\n  int64_t shape_len;\n} hbvib_way;\n\n\
        /// Fills.\n///\n/// w  it.\nhbvib_status hbvib_way_init(hbvib_way *w, size_t size_of_w);\n\n\
        /// Does.\n///\n/// way    it.\n/// x      receives complex numbers.\n/// count  how many.\n/// out    the model.\n\
        hbvib_status hbvib_do(const hbvib_model *model, const hbvib_way *way, int64_t n, double *x, int64_t *count, \
        hbvib_model **out);\n\nint64_t hbvib_count(const hbvib_model *model);\n";

    #[test]
    fn every_function_reads_its_inputs_and_gives_its_outputs() {
        let text = gateway(&Declarations::parse(HEADER).unwrap()).unwrap();
        for part in [
            "  {\"MASS\", 0},\n",
            "  {\"shape\", COMPLEXES, offsetof(hbvib_way, shape), 1, NULL},\n",
            "  const hbvib_model *model_ = handle(a, \"model\");\n",
            "  const hbvib_way *way_ = structs(a, \"way\", &WAY_STRUCT);\n",
            "  double *x_ = array(x_n, 2 * sizeof(double));\n",
            "hbvib_do(model_, way_, n_, x_, &count_, &out_);\n",
            "  {\"do\", call_do, 4},\n  {\"count\", call_count, 1},\n",
        ] {
            assert!(text.contains(part), "no {part} in\n{text}");
        }
        assert!(!text.contains("call_way_init"));
    }
}
