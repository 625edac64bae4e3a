//! Python: enumerations, tables of structs and functions, and the types of `lib` in the module hbvib.

use crate::declarations::{Base, Declarations, Enum, Function, Result, Type, sentence};
use std::fmt::Write as _;

const COLUMNS: usize = 120;

/// The generated part of the module.
pub fn module(all: &Declarations) -> Result<String> {
    let mut text = public_names(all);
    for e in &all.enums {
        text += &enumeration(all, e);
    }
    let [major, minor, _] = all.version;
    writeln!(
        text,
        "\n_VERSION = ({major}, {minor})  # of the library that this module was written for\n"
    )
    .unwrap();
    text +=
        "# Structs in the order of the header: \"type names, array[length] ...; ...\" for each.\n_STRUCTS = \"\"\"\n";
    for s in &all.structs {
        let mut groups: Vec<(String, Vec<String>)> = Vec::new();
        for field in &s.fields {
            let kind = field_type(all, &field.kind);
            let name = match field.kind.array {
                Some(n) => format!("{}[{n}]", field.name),
                None => field.name.clone(),
            };
            match groups.last_mut() {
                Some((last, names)) if *last == kind => names.push(name),
                _ => groups.push((kind, vec![name])),
            }
        }
        let groups: Vec<_> = groups
            .iter()
            .map(|(kind, names)| format!("{kind} {}", names.join(" ")))
            .collect();
        text += &wrapped(&format!("{}: {}", short(&s.name), groups.join("; ")), "    ");
    }
    text += "\"\"\"\n\n";
    text += "# Types of callbacks, in the kinds of functions.\n_CALLBACKS = {\n";
    for c in &all.callbacks {
        let mut kinds = Vec::new();
        for a in &c.arguments {
            let is_text = a.kind.base == Base::Char && a.kind.pointers == 1;
            kinds.push(if is_text {
                "text".into()
            } else {
                argument(all, &a.kind)?
            });
        }
        writeln!(
            text,
            "    \"{}\": \"{} -> {}\",",
            short(&c.name),
            kinds.join(" "),
            result(all, c)?
        )
        .unwrap();
    }
    text += "}\n\n";
    text += "# Functions in the order of the header: kinds of the arguments, and of a result that is no status. A kind is i int32,\n\
             # l int64, d double, z size_t, p a pointer to numbers, text or a handle, h a handle; or a struct.\n\
             _FUNCTIONS = \"\"\"\n";
    for f in &all.functions {
        let mut line = format!("{}:", short(&f.name));
        for a in &f.arguments {
            write!(
                line,
                " {}",
                argument(all, &a.kind).map_err(|e| format!("{}: {e}", f.name))?
            )
            .unwrap();
        }
        if !is_status(f) {
            write!(line, " -> {}", result(all, f)?).unwrap();
        }
        text += &wrapped(&line, "    ");
    }
    text += "\"\"\"\n\n";
    text += "if TYPE_CHECKING:\n\n    class _Library(ctypes.CDLL):\n        \"\"\"The functions of hbvib.h.\"\"\"\n\n";
    for f in &all.functions {
        text += &stub(all, f)?;
    }
    Ok(text)
}

/// The list of what the module shows: the enumerations, and constants of enumerations with one member.
fn public_names(all: &Declarations) -> String {
    let names = all.enums.iter().map(|e| match &e.members[..] {
        [(name, ..)] => format!("\"{}\"", name.trim_start_matches("HBVIB_")),
        _ => format!("\"{}\"", class_name(short(&e.name))),
    });
    let names: Vec<_> = names.collect();
    wrapped(&format!("__all__ = [{}]", names.join(", ")), "    ")
}

/// A name without its prefix.
pub fn short(name: &str) -> &str {
    name.trim_start_matches("hbvib_")
}

/// A class; a constant if there is only one member.
fn enumeration(all: &Declarations, e: &Enum) -> String {
    let mut text = String::new();
    if let [(name, value, doc)] = &e.members[..] {
        let name = name.trim_start_matches("HBVIB_");
        write!(text, "\n\n{name} = {value}  #: {}\n", sentence(doc)).unwrap();
        return text;
    }
    let name = short(&e.name);
    let base = if name.ends_with("_flag") { "IntFlag" } else { "IntEnum" };
    write!(
        text,
        "\n\nclass {}(enum.{base}):\n    \"\"\"{}\n\n{}    \"\"\"\n",
        class_name(name),
        sentence(&e.doc),
        members(all, e)
    )
    .unwrap();
    let prefix = common_prefix(e);
    for (name, value, _) in &e.members {
        writeln!(text, "    {} = {value}", &name[prefix..]).unwrap();
    }
    text
}

/// Members of an enumeration with their meaning, and how a number becomes one, as `help` shows them.
fn members(all: &Declarations, e: &Enum) -> String {
    let prefix = common_prefix(e);
    let mut text = String::new();
    for (name, _, doc) in &e.members {
        let line = format!("    {}   {}", &name[prefix..], in_python(all, sentence(doc)));
        text += &wrapped(line.trim_end(), "        ");
    }
    let (name, value, _) = &e.members[0];
    let (class, member) = (class_name(short(&e.name)), &name[prefix..]);
    let example = format!("    >>> import hbvib\n    >>> hbvib.{class}({value})\n    <{class}.{member}: {value}>\n");
    format!("{text}\n{example}")
}

/// The class of hbvib_status_code is Status, that of hbvib_log_level LogLevel.
pub fn class_name(name: &str) -> String {
    let name = name.strip_suffix("_code").unwrap_or(name);
    let words = name.split('_').map(|word| word[..1].to_ascii_uppercase() + &word[1..]);
    words.collect()
}

/// Length of the common start of all members, up to an underscore.
pub fn common_prefix(e: &Enum) -> usize {
    let first = &e.members[0].0;
    let ends = first.match_indices('_').map(|(i, _)| i + 1);
    let common = ends.take_while(|&end| e.members.iter().all(|(name, ..)| name.starts_with(&first[..end])));
    common.last().unwrap_or(0)
}

/// The kind of a field in the table of structs.
fn field_type(all: &Declarations, kind: &Type) -> String {
    if kind.pointers > 0 {
        return "pointer".into();
    }
    match all.resolved(&kind.base) {
        Base::Uint32 => "uint32".into(),
        Base::Int32 => "int32".into(),
        Base::Int64 => "int64".into(),
        Base::Named(name) => short(name).into(),
        _ => "double".into(),
    }
}

/// The kind of an argument in the table of functions.
fn argument(all: &Declarations, kind: &Type) -> Result<String> {
    Ok(match (all.resolved(&kind.base), kind.pointers) {
        (Base::Int32, 0) => "i".into(),
        (Base::Int64, 0) => "l".into(),
        (Base::Double, 0) => "d".into(),
        (Base::Size, 0) => "z".into(),
        (base, 1) if all.is_opaque(base) => "h".into(),
        (Base::Named(name), 1) => short(name).into(),
        (_, 1 | 2) => "p".into(),
        _ => return Err(format!("no kind for {kind:?}")),
    })
}

fn is_status(f: &Function) -> bool {
    f.result.is(&Base::Named("hbvib_status".into()))
}

/// The kind of a result that is no status.
fn result(all: &Declarations, f: &Function) -> Result<&'static str> {
    Ok(match (all.resolved(&f.result.base), f.result.pointers) {
        (Base::Char, 1) => "text",
        (Base::Uint32, 0) => "uint32",
        (Base::Int32, 0) => "int32",
        (Base::Int64, 0) => "int64",
        (Base::Size, 0) => "size",
        (Base::Void, 0) => "none",
        _ => return Err(format!("{}: no kind for the result", f.name)),
    })
}

/// A method in the form that type checkers read.
fn stub(all: &Declarations, f: &Function) -> Result<String> {
    let mut arguments = vec!["self".to_owned()];
    for a in &f.arguments {
        let kind = match argument(all, &a.kind)?.as_str() {
            "i" | "l" | "z" => "int",
            "d" => "float",
            _ => "Any",
        };
        arguments.push(format!("{}: {kind}", a.name));
    }
    for word in ["from", "in", "is", "lambda", "global", "class", "def"] {
        if f.arguments.iter().any(|a| a.name == word) {
            return Err(format!("{}: {word} is a word of Python", f.name));
        }
    }
    let result = if !is_status(f) && result(all, f)? == "text" {
        "bytes"
    } else {
        "int"
    };
    // Lines may be broken only inside the parentheses.
    let end = format!(") -> {result}: ...").replace(' ', "\0");
    let line = format!("        def {}({}{end}", f.name, arguments.join(", "));
    Ok(wrapped(&line, "            ").replace('\0', " "))
}

/// A description in which constants have their names in Python: HBVIB_JENKINS is ContactKind.JENKINS.
pub fn in_python(all: &Declarations, doc: &str) -> String {
    let mut text = String::new();
    let mut word = String::new();
    for c in doc.chars().chain(['\n']) {
        if c.is_ascii_alphanumeric() || c == '_' {
            word.push(c);
            continue;
        }
        text += &renamed(all, &word).unwrap_or_else(|| word.clone());
        word.clear();
        text.push(c);
    }
    text.trim_end().replace('\\', "\\\\")
}

fn renamed(all: &Declarations, word: &str) -> Option<String> {
    if let Some(e) = all.enums.iter().find(|e| e.name == *word) {
        return Some(class_name(short(&e.name)));
    }
    let e = all
        .enums
        .iter()
        .find(|e| e.members.iter().any(|(name, ..)| name == word))?;
    if let [(name, ..)] = &e.members[..] {
        return Some(name.trim_start_matches("HBVIB_").to_owned());
    }
    Some(format!("{}.{}", class_name(short(&e.name)), &word[common_prefix(e)..]))
}

/// A line, broken at spaces; continuation lines begin with `indent`.
pub fn wrapped(line: &str, indent: &str) -> String {
    let mut text = String::new();
    let mut rest = line.to_owned();
    while rest.len() > COLUMNS {
        let start = rest.len() - rest.trim_start().len();
        let Some(end) = rest[start + 1..=COLUMNS].rfind(' ').map(|i| start + 1 + i) else {
            break;
        };
        text += &rest[..end];
        text.push('\n');
        rest = format!("{indent}{}", &rest[end + 1..]);
    }
    text + &rest + "\n"
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEADER: &str = "typedef int32_t hbvib_status;\n\n\
        /// States. They are of contacts.\ntypedef enum {\n  /// It sticks.\n  HBVIB_STATE_STICK = 0,\n  HBVIB_STATE_SLIP = 1,\n} hbvib_state;\n\n\
        /// Outcomes.\ntypedef enum {\n  HBVIB_OK = 0,\n  HBVIB_E_NULL = -1,\n} hbvib_status_code;\n\n\
        /// Bits.\ntypedef enum {\n  HBVIB_BITS_A = 1,\n  HBVIB_BITS_B = 2,\n} hbvib_some_flag;\n\n\
        typedef enum {\n  /// Below. All.\n  HBVIB_GROUND = -1,\n} hbvib_dof;\n\n\
        typedef struct hbvib_model hbvib_model;\n\n\
        typedef struct {\n  uint32_t struct_size;\n  int32_t a;\n  int32_t b;\n  double x[3];\n  hbvib_fn call;\n  \
        void *user;\n} hbvib_view;\n\n\
        typedef int32_t (*hbvib_fn)(void *user);\n\n\
        /// Does.\n///\n/// v, x, out  all.\n\
        hbvib_status hbvib_do(hbvib_model *model, int32_t i, const hbvib_view *v, double *x, hbvib_model **out);\n\n\
        const char *hbvib_name(hbvib_status status);\n";

    #[test]
    fn enumerations_lose_the_prefix_that_their_members_share() {
        let text = module(&Declarations::parse(HEADER).unwrap()).unwrap();
        for part in [
            "class State(enum.IntEnum):\n    \"\"\"States.\n\n    STICK   It sticks.\n    SLIP\n\n    >>> import hbvib\n    \
             >>> hbvib.State(0)\n    <State.STICK: 0>\n    \"\"\"\n    STICK = 0\n    SLIP = 1",
            "    \"\"\"\n    OK = 0\n    E_NULL = -1",
            "class SomeFlag(enum.IntFlag):",
            "\nGROUND = -1  #: Below.\n",
        ] {
            assert!(text.contains(part), "no {part} in\n{text}");
        }
    }

    #[test]
    fn tables_and_types_have_every_struct_and_function() {
        let text = module(&Declarations::parse(HEADER).unwrap()).unwrap();
        for part in [
            "\nview: uint32 struct_size; int32 a b; double x[3]; fn call; pointer user\n",
            "\ndo: h i view p p\n",
            "\nname: i -> text\n",
            "        def hbvib_do(self, model: Any, i: int, v: Any, x: Any, out: Any) -> int: ...\n",
            "        def hbvib_name(self, status: int) -> bytes: ...\n",
        ] {
            assert!(text.contains(part), "no {part} in\n{text}");
        }
    }

    #[test]
    fn lines_are_broken_at_spaces() {
        let text = wrapped(&format!("    {}", "word ".repeat(60).trim_end()), "      ");
        assert!(
            text.lines().count() == 3 && text.lines().all(|line| line.len() <= COLUMNS),
            "{text}"
        );
    }

    #[test]
    fn constants_have_their_names_in_python() {
        let header = "/// States.\ntypedef enum {\n  /// It sticks.\n  HBVIB_STATE_STICK = 0,\n  /// It slips.\n  \
                      HBVIB_STATE_SLIP = 1,\n} hbvib_state;\n";
        let all = Declarations::parse(header).unwrap();
        assert_eq!(
            in_python(&all, "As HBVIB_STATE_SLIP, of hbvib_state."),
            "As State.SLIP, of State."
        );
    }
}
