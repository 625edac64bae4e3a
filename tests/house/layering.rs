//! The rooms of the library and of the numerics below, which the compiler keeps apart as crates: imports go downwards only, files do not import each other in circles, names say what they
//! hold, and nothing but the registry knows the contact laws by name.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// Layer of each room of the crate. Within a layer rooms do not know each other unless listed in [`SAME_LAYER`].
const LAYERS: [(&str, u8); 27] = [
    ("shortage", 0),
    ("error", 0),
    ("byte_stream", 0),
    ("interrupt", 0),
    ("roots", 0),
    ("hooks", 0),
    ("linalg", 1),
    ("fourier", 1),
    ("options", 1),
    ("model", 2),
    ("contact", 2),
    ("aft", 3),
    ("condense", 3),
    ("problem", 4),
    ("continuation", 5),
    ("results", 6),
    ("time_integration", 6),
    ("stability", 7),
    ("sensitivity", 7),
    ("harmonics", 7),
    ("tracing", 8),
    ("analysis", 9),
    ("at_a_point", 10),
    ("studies", 11),
    ("capi", 12),
    ("internals", 13),
    ("lib", 14),
];

/// Imports inside one layer, (from, to): errors and interrupts read the note of a shortage of memory, interrupts and streams of bytes
/// report errors, options name a measure of Fourier series, hooks hold an interrupt, transforms are products of vectors, a
/// model has contacts, and a response that is followed over a parameter has an error.
const SAME_LAYER: [(&str, &str); 10] = [
    ("error", "shortage"),
    ("interrupt", "shortage"),
    ("byte_stream", "error"),
    ("options", "fourier"),
    ("interrupt", "error"),
    ("hooks", "error"),
    ("hooks", "interrupt"),
    ("fourier", "linalg"),
    ("model", "contact"),
    ("sensitivity", "harmonics"),
];

/// Rooms that may import nothing but these, whatever their layer: the continuation never sees a model or a contact, and
/// the C boundary holds no numerics.
const ONLY: [(&str, &[&str]); 2] = [
    ("continuation", &["problem", "linalg", "roots", "error", "interrupt"]),
    (
        "capi",
        &[
            "analysis",
            "at_a_point",
            "studies",
            "sensitivity",
            "model",
            "results",
            "contact",
            "options",
            "hooks",
            "interrupt",
            "error",
            "shortage",
            "linalg",
            "fourier",
        ],
    ),
];

/// Rooms that know contact laws by their traits alone.
const WITHOUT_LAWS: [&str; 5] = ["aft", "time_integration", "results", "harmonics", "problem"];

/// Identifiers that the glossary has replaced.
const REPLACED: [&str; 10] = [
    "rung", "shelf", "keeper", "astray", "roster", "lifted", "faded", "Marched", "Pieces", "Placed",
];

fn layer(room: &str) -> Option<u8> {
    LAYERS.iter().find(|(name, _)| *name == room).map(|(_, layer)| *layer)
}

fn allowed(from: &str, to: &str) -> bool {
    if from == to {
        return true;
    }
    if let Some((_, list)) = ONLY.iter().find(|(name, _)| *name == from) {
        return list.contains(&to);
    }
    let (Some(a), Some(b)) = (layer(from), layer(to)) else {
        return false;
    };
    b < a || SAME_LAYER.contains(&(from, to))
}

/// The source files by the path of their module: `aft::spectral`, and `aft` for its mod.rs.
struct Tree {
    files: BTreeMap<String, String>,
}

impl Tree {
    fn read() -> Self {
        let root = crate::root();
        let crates = [root.join("src"), root.join("crates/numerics/src")];
        let mut tree = Self::of(&crates, &[]);
        // The library re-exports the rooms of the crate below under their own names.
        let own = code(&fs::read_to_string(crates[0].join("lib.rs")).unwrap());
        tree.files.insert("lib".to_owned(), own);
        assert!(tree.files.len() > 100);
        tree
    }

    /// The files of these folders but those whose modules are left out.
    fn of(crates: &[PathBuf], without: &[&str]) -> Self {
        let mut found = Vec::new();
        for folder in crates {
            sources(folder, &mut found);
        }
        // Unit tests in a file of their own see as much as those that close a file.
        found.retain(|path| {
            !path
                .file_stem()
                .is_some_and(|stem| stem.to_string_lossy().ends_with("_tests"))
        });
        let files = found.iter().map(|path| {
            let own = crates.iter().find_map(|folder| path.strip_prefix(folder).ok());
            let module = module_of(own.unwrap());
            (module, code(&fs::read_to_string(path).unwrap()))
        });
        let kept = files.filter(|(module, _)| !without.contains(&module.as_str()));
        Self { files: kept.collect() }
    }

    /// The file that a path names: its longest prefix that is a file, through the re-exports of that file.
    fn resolve(&self, path: &str) -> Option<String> {
        let segments: Vec<&str> = path.split("::").collect();
        for n in (1..=segments.len()).rev() {
            let module = segments[..n].join("::");
            let Some(text) = self.files.get(&module) else { continue };
            let Some(item) = segments.get(n) else {
                return Some(module);
            };
            for (public, import) in imports(text) {
                if public && import.rsplit("::").next() == Some(*item) {
                    let target = absolute(&module, &import);
                    if target != path {
                        return self.resolve(&target).or(Some(module));
                    }
                }
            }
            return Some(module);
        }
        None
    }

    /// The other files that a file imports from.
    fn imported(&self, module: &str) -> BTreeSet<String> {
        let text = &self.files[module];
        let mut found = BTreeSet::new();
        for path in named(text).iter().map(|path| absolute(module, path)) {
            found.extend(self.resolve(&path).filter(|target| target != module));
        }
        found
    }
}

fn sources(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            sources(&path, found);
        } else if path.extension().is_some_and(|e| e == "rs") {
            found.push(path);
        }
    }
}

fn module_of(path: &Path) -> String {
    let mut parts: Vec<_> = path
        .with_extension("")
        .iter()
        .map(|p| p.to_str().unwrap().to_owned())
        .collect();
    if parts.last().is_some_and(|last| last == "mod") {
        parts.pop();
    }
    parts.join("::")
}

/// The code of a file: no comments, and nothing from its unit tests on, which close every file.
fn code(text: &str) -> String {
    text.lines()
        .take_while(|line| line.trim() != "#[cfg(test)]")
        .map(|line| line.split("//").next().unwrap_or(""))
        .collect::<Vec<_>>()
        .join("\n")
}

/// The paths of a use tree.
fn expand(tree: &str) -> Vec<String> {
    let tree = tree.trim();
    let Some(open) = tree.find('{') else {
        let path = tree.split(" as ").next().unwrap_or(tree).trim();
        return vec![path.trim_end_matches("::self").to_owned()];
    };
    let (prefix, list) = (&tree[..open], &tree[open + 1..tree.rfind('}').unwrap()]);
    let (mut found, mut depth, mut start) = (Vec::new(), 0, 0);
    for (i, c) in list.char_indices().chain([(list.len(), ',')]) {
        match c {
            '{' => depth += 1,
            '}' => depth -= 1,
            ',' if depth == 0 => {
                if !list[start..i].trim().is_empty() {
                    found.extend(expand(&format!("{prefix}{}", list[start..i].trim())));
                }
                start = i + 1;
            }
            _ => {}
        }
    }
    found
}

/// The imports of a file: whether each is a re-export, and its path.
fn imports(code: &str) -> Vec<(bool, String)> {
    let mut found = Vec::new();
    let mut begin = 0;
    for line in code.split_inclusive('\n') {
        let statement = &code[begin..];
        begin += line.len();
        let statement = statement.trim_start();
        for (public, keyword) in [
            (false, "use "),
            (true, "pub use "),
            (true, "pub(crate) use "),
            (true, "pub(super) use "),
        ] {
            if let Some(tree) = statement.strip_prefix(keyword).filter(|_| !line.trim().is_empty()) {
                let tree = tree.split(';').next().unwrap_or(tree);
                found.extend(expand(tree).into_iter().map(|path| (public, path)));
            }
        }
    }
    found
}

/// The paths of the crate that a file names, in imports and elsewhere.
fn named(code: &str) -> Vec<String> {
    let mut found: Vec<String> = imports(code).into_iter().map(|(_, path)| path).collect();
    for prefix in ["crate::", "super::"] {
        for (at, _) in code.match_indices(prefix) {
            if code[..at].ends_with(|c: char| c.is_alphanumeric() || c == '_' || c == ':') {
                continue;
            }
            let rest = &code[at..];
            let end = rest.find(|c: char| !(c.is_alphanumeric() || c == '_' || c == ':'));
            let (path, after) = rest.split_at(end.unwrap_or(rest.len()));
            // The list of an import was expanded above.
            if after.starts_with('{') && path.ends_with("::") {
                continue;
            }
            let path = path.trim_end_matches(':');
            // Macros of the error module are exported at the root.
            found.push(path.replace("crate::fail", "crate::error::fail"));
        }
    }
    found
}

/// A path from the root of the crate; paths of other crates come out as they are.
fn absolute(module: &str, path: &str) -> String {
    if let Some(rest) = path.strip_prefix("crate::") {
        return rest.to_owned();
    }
    let mut here: Vec<&str> = module.split("::").filter(|part| !part.is_empty()).collect();
    let mut rest = path;
    let mut relative = false;
    while let Some(above) = rest.strip_prefix("super::") {
        here.pop();
        rest = above;
        relative = true;
    }
    if relative || path.starts_with("self::") {
        here.push(rest.trim_start_matches("self::"));
        return here.join("::");
    }
    // A path that begins with a child of this module, or with another crate.
    format!("{module}::{path}")
}

fn words(code: &str) -> impl Iterator<Item = &str> {
    code.split(|c: char| !(c.is_alphanumeric() || c == '_'))
}

fn room(module: &str) -> &str {
    module.split("::").next().unwrap_or(module)
}

#[test]
fn every_file_imports_from_lower_layers_or_its_own_room_only() {
    let tree = Tree::read();
    let mut wrong = Vec::new();
    let mut arrows = 0;
    for module in tree.files.keys().filter(|module| *module != "lib") {
        let from = room(module);
        assert!(layer(from).is_some(), "name the layer of {from}");
        for target in tree.imported(module) {
            arrows += 1;
            if !allowed(from, room(&target)) {
                wrong.push(format!("{module} imports {target}"));
            }
        }
    }
    assert!(arrows > 500, "only {arrows} imports were seen");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn files_do_not_import_each_other_in_circles() {
    assert_no_circles(&Tree::read());
    // Programs and readers stand beside the library, each a tree of its own.
    for folder in ["crates/hbvib-cli/src", "crates/hbvib-io/src", "crates/bindings/src"] {
        assert_no_circles(&Tree::of(&[crate::root().join(folder)], &["main", "lib"]));
    }
}

/// Files that nothing imports, and that import nothing, are taken away until circles are left.
fn assert_no_circles(tree: &Tree) {
    let mut left: BTreeMap<String, BTreeSet<String>> = tree
        .files
        .keys()
        .map(|module| (module.clone(), tree.imported(module)))
        .collect();
    // Files that import nothing left, and files that nothing left imports, lie on no circle.
    loop {
        let targets: BTreeSet<String> = left.values().flatten().cloned().collect();
        let free: Vec<String> = left
            .iter()
            .filter(|(module, to)| !targets.contains(*module) || !to.iter().any(|target| left.contains_key(target)))
            .map(|(module, _)| module.clone())
            .collect();
        if free.is_empty() {
            break;
        }
        for module in free {
            left.remove(&module);
        }
    }
    for to in left.values_mut() {
        to.retain(|target| tree.files.contains_key(target));
    }
    assert!(left.is_empty(), "files in circles: {left:#?}");
}

#[test]
fn rooms_above_the_contacts_import_no_law() {
    let tree = Tree::read();
    for (module, text) in &tree.files {
        if WITHOUT_LAWS.contains(&room(module)) {
            let law = tree
                .imported(module)
                .into_iter()
                .find(|target| target.starts_with("contact::laws::"));
            assert_eq!(law, None, "{module}");
        }
        let names_a_kind = text.contains("ContactKind::");
        assert!(
            !names_a_kind || ["contact", "capi"].contains(&room(module)),
            "{module} names a kind of contact"
        );
    }
}

#[test]
fn no_two_files_have_one_name() {
    let tree = Tree::read();
    let mut seen: BTreeMap<&str, &str> = BTreeMap::new();
    for module in tree.files.keys().filter(|module| room(module) != "capi") {
        let Some((_, name)) = module.rsplit_once("::") else {
            continue;
        };
        if let Some(other) = seen.insert(name, module) {
            // A folder's mod.rs has the name of the folder.
            let both = format!("{other} and {module}");
            let is_folder = |m: &str| tree.files.keys().any(|file| file.starts_with(&format!("{m}::")));
            assert!(is_folder(other) || is_folder(module), "{both}");
        }
    }
}

#[test]
fn words_that_the_glossary_replaced_stay_out() {
    for (module, text) in Tree::read().files {
        for word in words(&text) {
            assert!(!REPLACED.contains(&word) && word != "at_rest", "{module}: {word}");
        }
    }
}

#[test]
fn unsafe_code_lives_at_the_c_boundary_only() {
    for (module, text) in Tree::read().files {
        if room(&module) != "capi" {
            assert!(!words(&text).any(|word| word == "unsafe"), "{module}");
        }
    }
}

#[test]
fn imports_are_found_in_every_form_that_the_language_has() {
    let paths = |code: &str| -> Vec<String> { imports(code).into_iter().map(|(_, path)| path).collect() };
    assert_eq!(
        paths("use crate::contact::{Law, Piece};"),
        ["crate::contact::Law", "crate::contact::Piece"]
    );
    assert_eq!(
        paths("use crate::{error::{Result, fail}, linalg::norm};\npub(crate) use lu::Lu as L;"),
        [
            "crate::error::Result",
            "crate::error::fail",
            "crate::linalg::norm",
            "lu::Lu"
        ]
    );
    assert_eq!(
        imports("pub use branch::Branch;"),
        [(true, "branch::Branch".to_owned())]
    );
    assert_eq!(
        named("let x = crate::model::Model::new(1);"),
        ["crate::model::Model::new"]
    );
    assert_eq!(absolute("a::b", "super::c::D"), "a::c::D");
    assert_eq!(absolute("a", "b::C"), "a::b::C");
    assert_eq!(code("// crate::model\nx\n#[cfg(test)]\nuse crate::model;"), "\nx");
}

#[test]
fn re_exports_lead_to_the_file_behind_them() {
    let tree = Tree::read();
    assert_eq!(
        tree.resolve("condense::Condensed").as_deref(),
        Some("condense::blocks::condensed")
    );
    assert_eq!(
        tree.resolve("problem::Problem").as_deref(),
        Some("problem::parametric_problem")
    );
    assert_eq!(
        tree.resolve("linalg::factors::lu::Lu").as_deref(),
        Some("linalg::factors::lu")
    );
}

#[test]
fn an_arrow_against_the_way_is_refused() {
    assert!(allowed("analysis", "continuation"));
    assert!(allowed("model", "contact"));
    assert!(!allowed("contact", "model"));
    assert!(!allowed("continuation", "model"));
    assert!(!allowed("continuation", "contact"));
    assert!(!allowed("linalg", "problem"));
    assert!(!allowed("capi", "continuation"));
    assert!(!allowed("results", "unheard_of"));
}
