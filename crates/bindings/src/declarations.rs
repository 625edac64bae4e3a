//! Reads the declarations of `include/hbvib.h`: exactly the C that the header uses. Anything else is an error with
//! its text, so that nothing is omitted silently.

/// A scalar type of C or a name.
#[derive(Clone, Debug, PartialEq)]
pub enum Base {
    Void,
    Char,
    Int32,
    Uint32,
    Int64,
    Size,
    Double,
    /// A struct, an opaque type, an alias or a callback.
    Named(String),
}

/// The type of a field, an argument or a result.
#[derive(Clone, Debug, PartialEq)]
pub struct Type {
    pub base: Base,
    pub is_const: bool,
    /// Number of stars after the base.
    pub pointers: usize,
    /// Length of a field that is an array.
    pub array: Option<usize>,
}

impl Type {
    /// Whether it is a value of this base.
    pub fn is(&self, base: &Base) -> bool {
        self.base == *base && self.pointers == 0
    }
}

/// A field of a struct or an argument of a function.
#[derive(Clone, Debug, PartialEq)]
pub struct Variable {
    pub name: String,
    pub kind: Type,
    /// Its description, joined to one line.
    pub doc: String,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Enum {
    pub name: String,
    pub doc: String,
    /// Name, value and description.
    pub members: Vec<(String, i64, String)>,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Struct {
    pub name: String,
    pub doc: String,
    pub fields: Vec<Variable>,
}

/// A function, or the type of a callback.
#[derive(Clone, Debug, PartialEq)]
pub struct Function {
    pub name: String,
    pub doc: String,
    pub result: Type,
    pub arguments: Vec<Variable>,
}

/// All declarations, each list in the order of the header.
#[derive(Debug, Default)]
pub struct Declarations {
    /// Major, minor, patch.
    pub version: [i64; 3],
    pub enums: Vec<Enum>,
    pub opaque: Vec<String>,
    /// Other names of int32_t.
    pub aliases: Vec<String>,
    pub structs: Vec<Struct>,
    pub callbacks: Vec<Function>,
    pub functions: Vec<Function>,
}

pub type Result<T> = std::result::Result<T, String>;

impl Declarations {
    pub fn parse(header: &str) -> Result<Self> {
        let mut found = Self::default();
        let mut doc = Vec::new();
        let mut lines = header.lines();
        while let Some(line) = lines.next() {
            if line.starts_with("/*") {
                let mut end = line;
                while !end.contains("*/") {
                    end = lines.next().ok_or("a comment does not end")?;
                }
            } else if let Some(text) = line.strip_prefix("///") {
                doc.push(text.trim());
            } else if line.starts_with('#') {
                found.version_of(line)?;
                if line.ends_with('\\') {
                    lines.next();
                }
            } else if matches!(line, "HBVIB_NODISCARD" | "" | "extern \"C\" {" | "} /* extern \"C\" */") {
                if line.is_empty() && !doc.is_empty() {
                    return Err(format!("a comment belongs to no item: {}", doc.join(" ")));
                }
            } else {
                let mut item = line.to_owned();
                while !ends(&item) {
                    item.push('\n');
                    item += lines.next().ok_or_else(|| format!("an item does not end: {item}"))?;
                }
                let doc = std::mem::take(&mut doc);
                found.item(&item, &doc).map_err(|error| format!("{error} in\n{item}"))?;
            }
        }
        found.inherit()?;
        Ok(found)
    }

    #[cfg(test)]
    pub fn structure(&self, name: &str) -> Option<&Struct> {
        self.structs.iter().find(|s| s.name == name)
    }

    pub fn function(&self, name: &str) -> Option<&Function> {
        self.functions.iter().find(|f| f.name == name)
    }

    pub fn is_opaque(&self, base: &Base) -> bool {
        matches!(base, Base::Named(name) if self.opaque.contains(name))
    }

    /// The base with names of int32_t resolved.
    pub fn resolved<'a>(&self, base: &'a Base) -> &'a Base {
        match base {
            Base::Named(name) if self.aliases.contains(name) => &Base::Int32,
            base => base,
        }
    }

    fn version_of(&mut self, line: &str) -> Result<()> {
        for (place, part) in ["MAJOR ", "MINOR ", "PATCH "].iter().enumerate() {
            if let Some(number) = line
                .strip_prefix("#define HBVIB_VERSION_")
                .and_then(|rest| rest.strip_prefix(part))
            {
                self.version[place] = number.parse().map_err(|_| format!("no number in {line}"))?;
            }
        }
        Ok(())
    }

    fn item(&mut self, item: &str, doc: &[&str]) -> Result<()> {
        let text = doc.join(" ").trim().to_owned();
        if let Some(body) = item.strip_prefix("typedef enum {\n") {
            let (body, name) = body.rsplit_once("\n} ").ok_or("no name")?;
            let members = members(body, |code| {
                let (name, value) = code.trim_end_matches(',').split_once(" = ").ok_or("no value")?;
                Ok((name.to_owned(), value.parse().map_err(|_| "no number")?))
            })?;
            self.enums.push(Enum {
                name: name.trim_end_matches(';').to_owned(),
                doc: text,
                members: members
                    .into_iter()
                    .map(|((name, value), doc)| (name, value, doc))
                    .collect(),
            });
        } else if let Some(body) = item.strip_prefix("typedef struct {\n") {
            let (body, name) = body.rsplit_once("\n} ").ok_or("no name")?;
            let fields = members(body, |code| variable(code.strip_suffix(';').ok_or("no semicolon")?))?;
            self.structs.push(Struct {
                name: name.trim_end_matches(';').to_owned(),
                doc: text,
                fields: fields
                    .into_iter()
                    .map(|(field, doc)| Variable { doc, ..field })
                    .collect(),
            });
        } else if let Some(rest) = item.strip_prefix("typedef struct ") {
            let (name, same) = rest.trim_end_matches(';').split_once(' ').ok_or("no name")?;
            if name != same {
                return Err("an opaque type of two names".into());
            }
            self.opaque.push(name.to_owned());
        } else if let Some(rest) = item.strip_prefix("typedef ") {
            match rest.split_once("(*") {
                Some((result, rest)) => {
                    let (name, arguments) = rest.split_once(")(").ok_or("no arguments")?;
                    self.callbacks.push(function(name, result, arguments, doc, text)?);
                }
                None => match rest.trim_end_matches(';').rsplit_once(' ') {
                    Some(("int32_t" | "volatile int32_t", name)) => self.aliases.push(name.to_owned()),
                    _ => return Err("only int32_t may have another name".into()),
                },
            }
        } else {
            let item = match item.strip_prefix("HBVIB_DEPRECATED(") {
                Some(rest) => rest.split_once(")\n").ok_or("no function")?.1,
                None => item,
            };
            let (head, arguments) = item.split_once('(').ok_or("no arguments")?;
            let start = head.rfind([' ', '*']).ok_or("no result")? + 1;
            self.functions
                .push(function(&head[start..], &head[..start], arguments, doc, text)?);
        }
        Ok(())
    }

    /// Copies the descriptions that a function shares with another: "Arguments ... as for hbvib_...".
    fn inherit(&mut self) -> Result<()> {
        for i in 0..self.functions.len() {
            let function = &self.functions[i];
            let other = function
                .doc
                .split_once("Arguments")
                .and_then(|(_, rest)| rest.split_once(" as for "))
                .map(|(_, rest)| word(rest).to_owned());
            let other = other.and_then(|name| self.function(&name).cloned());
            for argument in &mut self.functions[i].arguments {
                if argument.doc.is_empty()
                    && let Some(known) = other
                        .as_ref()
                        .and_then(|f| f.arguments.iter().find(|a| a.name == argument.name))
                {
                    argument.doc.clone_from(&known.doc);
                }
            }
        }
        // Bindings depend on these descriptions.
        for function in &self.functions {
            for argument in &function.arguments {
                let handle = argument.kind.pointers == 1 && self.is_opaque(&argument.kind.base);
                if argument.doc.is_empty() && argument.kind.pointers > 0 && !handle {
                    return Err(format!("{}: no description of {}", function.name, argument.name));
                }
            }
        }
        Ok(())
    }
}

/// First sentence of a description.
pub fn sentence(doc: &str) -> &str {
    let mut points = doc.match_indices('.').map(|(i, _)| i);
    let end = points.find(|&i| {
        let rest = &doc[i + 1..];
        // The points of "0 .. 3" do not end a sentence.
        (rest.is_empty() || rest.starts_with(' ')) && !doc[..i].ends_with(['.', ' '])
    });
    &doc[..end.map_or(doc.len(), |i| i + 1)]
}

fn word(text: &str) -> &str {
    let end = text.find(|c: char| !(c.is_ascii_alphanumeric() || c == '_'));
    &text[..end.unwrap_or(text.len())]
}

/// Whether the braces and parentheses of an item are closed and its semicolon is there.
fn ends(item: &str) -> bool {
    let code = item.lines().filter(|line| !line.trim_start().starts_with("//"));
    let mut depth = 0;
    let mut last = ' ';
    for c in code.flat_map(str::chars) {
        match c {
            '{' | '(' => depth += 1,
            '}' | ')' => depth -= 1,
            _ => {}
        }
        last = c;
    }
    depth == 0 && last == ';'
}

/// Members of a struct or an enum, each with its description.
fn members<T>(body: &str, read: impl Fn(&str) -> Result<T>) -> Result<Vec<(T, String)>> {
    let mut found = Vec::new();
    let mut doc: Vec<&str> = Vec::new();
    for line in body.lines().map(str::trim) {
        if let Some(text) = line.strip_prefix("///") {
            doc.push(text.trim());
        } else {
            let doc = std::mem::take(&mut doc).join(" ");
            found.push((read(line).map_err(|error| format!("{error}: {line}"))?, doc));
        }
    }
    Ok(found)
}

fn function(name: &str, result: &str, arguments: &str, doc: &[&str], text: String) -> Result<Function> {
    let arguments = arguments.strip_suffix(");").ok_or("no end of the arguments")?;
    let mut found = Vec::new();
    if arguments != "void" {
        for argument in arguments.split(',') {
            let argument = variable(argument.trim())?;
            let doc = described(doc, &argument.name);
            found.push(Variable { doc, ..argument });
        }
    }
    Ok(Function {
        name: name.to_owned(),
        doc: text,
        result: kind(result.trim())?.0,
        arguments: found,
    })
}

/// The lines of a comment about an argument: "name  text", "a, b  text"; continuation lines are indented.
fn described(doc: &[&str], name: &str) -> String {
    let mut lines = doc.iter();
    let names = |line: &str| {
        line.split_once("  ")
            .map(|(names, text)| (names.to_owned(), text.trim().to_owned()))
    };
    while let Some(line) = lines.next() {
        if let Some((known, text)) = names(line)
            && known.split(", ").any(|known| known == name)
        {
            let more = lines.take_while(|line| names(line).is_none() && !ends_arguments(line));
            return std::iter::once(text)
                .chain(more.map(|&line| line.to_owned()))
                .collect::<Vec<_>>()
                .join(" ");
        }
    }
    String::new()
}

/// Whether a line of a comment follows the list of arguments.
fn ends_arguments(line: &str) -> bool {
    ["Errors", "Returns", "HBVIB_", "A positive", "Threads", "Where"]
        .iter()
        .any(|start| line.starts_with(start))
}

fn variable(code: &str) -> Result<Variable> {
    let (code, array) = match code.strip_suffix(']').map(|rest| rest.split_once('[')) {
        Some(Some((code, length))) => (code, Some(length.parse().map_err(|_| "no length")?)),
        Some(None) => return Err("no array".into()),
        None => (code, None),
    };
    let start = code.rfind([' ', '*']).ok_or("no type")? + 1;
    let name = &code[start..];
    let (mut kind, rest) = kind(code[..start].trim())?;
    if !rest.is_empty() || name.is_empty() || word(name) != name {
        return Err("not a type and a name".into());
    }
    kind.array = array;
    Ok(Variable {
        name: name.to_owned(),
        kind,
        doc: String::new(),
    })
}

/// A type and the rest of the code after it.
fn kind(code: &str) -> Result<(Type, &str)> {
    let (is_const, code) = match code.strip_prefix("const ") {
        Some(rest) => (true, rest),
        None => (false, code),
    };
    let name = word(code);
    let rest = code[name.len()..].trim_start();
    let pointers = rest.len() - rest.trim_start_matches('*').len();
    let base = match name {
        "" => return Err("no type".into()),
        "void" => Base::Void,
        "char" => Base::Char,
        "int32_t" => Base::Int32,
        "uint32_t" => Base::Uint32,
        "int64_t" => Base::Int64,
        "size_t" => Base::Size,
        "double" => Base::Double,
        name if name.starts_with("hbvib_") => Base::Named(name.to_owned()),
        other => return Err(format!("the type {other} is not known")),
    };
    let kind = Type {
        base,
        is_const,
        pointers,
        array: None,
    };
    Ok((kind, rest[pointers..].trim_start()))
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEADER: &str = r#"/* A comment
 * of two lines. */
#ifndef HBVIB_H
#define HBVIB_VERSION_MAJOR 0
#define HBVIB_VERSION_MINOR 7
#define HBVIB_VERSION_PATCH 1
#define HBVIB_VERSION_NUMBER \
  (HBVIB_VERSION_MAJOR * 65536)
extern "C" {
#endif

/// A status.
typedef int32_t hbvib_status;

/// Kinds.
typedef enum {
  /// The first. And more.
  HBVIB_ONE = 1,
  HBVIB_E_TWO = -2,
} hbvib_kind;

typedef struct hbvib_model hbvib_model;

/// Numbers 0 .. 3 of it. Fill it.
typedef struct {
  /// Bytes.
  uint32_t struct_size;
  /// Axes
  /// of three.
  int64_t dof[3];
  const double *values;
  hbvib_fn call;
} hbvib_view;

typedef int32_t (*hbvib_fn)(void *user, const hbvib_view *view);

typedef volatile int32_t hbvib_flag;

/// Does it.
///
/// a, out  both, where
///         NULL is none.
/// n       complex numbers.
/// Errors: HBVIB_E_NULL.
hbvib_status hbvib_do(const hbvib_model *model,
                      const double *a,
                      hbvib_model **out,
                      int64_t n);

/// Again. Arguments and errors as for hbvib_do.
const char *hbvib_again(const double *a);

uint32_t hbvib_version(void);

} /* extern "C" */
"#;

    fn parsed() -> Declarations {
        Declarations::parse(HEADER).unwrap()
    }

    #[test]
    fn every_kind_of_item_is_read() {
        let d = parsed();
        assert_eq!(d.version, [0, 7, 1]);
        assert_eq!(d.aliases, ["hbvib_status", "hbvib_flag"]);
        assert_eq!(d.opaque, ["hbvib_model"]);
        assert_eq!(d.enums[0].doc, "Kinds.");
        let two = ("HBVIB_E_TWO".to_owned(), -2, String::new());
        assert_eq!(d.enums[0].members[1], two);
        let view = d.structure("hbvib_view").unwrap();
        assert_eq!(view.fields[1].kind.array, Some(3));
        assert_eq!(view.fields[1].doc, "Axes of three.");
        assert!(view.fields[2].kind.is_const && view.fields[2].kind.pointers == 1);
        assert_eq!(view.fields[3].kind.base, Base::Named("hbvib_fn".into()));
        assert_eq!(d.callbacks[0].arguments[1].name, "view");
        assert_eq!(d.functions.len(), 3);
        assert!(d.functions[2].arguments.is_empty() && d.functions[2].result.is(&Base::Uint32));
        assert_eq!(d.functions[1].result.base, Base::Char);
    }

    #[test]
    fn arguments_have_the_words_of_the_comment() {
        let d = parsed();
        let docs: Vec<_> = d.functions[0].arguments.iter().map(|a| a.doc.as_str()).collect();
        let both = "both, where NULL is none.";
        assert_eq!(docs, ["", both, both, "complex numbers."]);
        assert_eq!(d.functions[0].arguments[2].kind.pointers, 2);
        assert_eq!(d.functions[1].arguments[0].doc, both);
    }

    #[test]
    fn a_sentence_ends_at_its_point() {
        assert_eq!(sentence("Numbers 0 .. 3 of it. Fill it."), "Numbers 0 .. 3 of it.");
        assert_eq!(sentence("Damping x'. More"), "Damping x'.");
        assert_eq!(sentence("No end"), "No end");
    }

    #[test]
    fn other_c_is_refused() {
        for (item, error) in [
            ("float hbvib_f(void);\n", "the type float is not known"),
            ("int64_t hbvib_f(int64_t);\n", "no type"),
            ("hbvib_status hbvib_f(double *x);\n", "no description of x"),
            ("typedef int64_t hbvib_long;\n", "only int32_t"),
            (
                "typedef struct {\n  int32_t a : 3;\n} hbvib_s;\n",
                "not a type and a name",
            ),
            ("typedef struct {\n  int32_t a[n];\n} hbvib_s;\n", "no length"),
            ("typedef enum {\n  HBVIB_A,\n} hbvib_e;\n", "no value"),
            ("hbvib_status hbvib_f(void)", "does not end"),
            ("/// Lost.\n\n", "belongs to no item"),
        ] {
            let found = Declarations::parse(item).unwrap_err();
            assert!(found.contains(error), "{item}: {found}");
        }
    }
}
