//! Arranges the C items that cbindgen writes in the order of `include/hbvib.h`: section by section, and inside a
//! section in the order in which its source files declare them.
//!
//! build.rs includes this file; therefore it uses the standard library alone.

/// A section of the header: title, one line about it, and its files in src/capi.
pub struct Section {
    title: &'static str,
    about: &'static str,
    files: &'static [&'static str],
}

/// The sections in the order of the header.
pub const SECTIONS: [Section; 13] = [
    Section {
        title: "Version and errors",
        about: "the version in use, status codes, the sentence behind a status",
        files: &["version_and_errors"],
    },
    Section {
        title: "Matrices",
        about: "views of dense and sparse matrices of the caller",
        files: &["structures/matrices"],
    },
    Section {
        title: "Model",
        about: "structures, their matrices, springs and forces",
        files: &[
            "structures/model",
            "structures/model_damping",
            "structures/model_rotation",
            "structures/model_contents",
            "structures/model_saved",
        ],
    },
    Section {
        title: "Cyclic structures",
        about: "sectors, their faces and couplings, diameters, engine order, aerodynamics",
        files: &[
            "structures/cyclic",
            "structures/cyclic_aero",
            "structures/cyclic_faces",
            "structures/cyclic_wheel",
        ],
    },
    Section {
        title: "Contacts",
        about: "friction, unilateral contacts, nonlinear springs and dampers, patches",
        files: &[
            "contact_calls/contacts",
            "contact_calls/contacts_batch",
            "contact_calls/contacts_springs",
            "contact_calls/contacts_patch",
            "contact_calls/contacts_damper",
            "contact_calls/contacts_described",
        ],
    },
    Section {
        title: "Laws of the caller",
        about: "forces computed by a callback, and the check of their derivatives",
        files: &["contact_calls/caller_laws", "contact_calls/caller_laws_check"],
    },
    Section {
        title: "Solve",
        about: "options, progress and cancellation, forced responses",
        files: &[
            "solving/solve_options",
            "solving/solve_hooks",
            "solving/solve_responses",
            "solving/solve",
            "solving/solutions",
        ],
    },
    Section {
        title: "Results",
        about: "curve, fields, harmonics, special points, energies, contacts of a branch",
        files: &[
            "reading/results",
            "reading/results_special_points",
            "reading/results_responses",
            "reading/results_reduction",
            "reading/results_energy",
            "reading/results_contacts",
        ],
    },
    Section {
        title: "Modes",
        about: "linear and nonlinear modes, responses synthesised from them",
        files: &[
            "mode_calls/modes_linear",
            "mode_calls/modes_damped",
            "mode_calls/modes_interference",
            "mode_calls/modes",
            "mode_calls/modes_results",
            "mode_calls/modes_synthesis",
        ],
    },
    Section {
        title: "Time",
        about: "integration in time, and points of a branch compared with it",
        files: &[
            "time_calls/time",
            "time_calls/time_sweep",
            "time_calls/time_run_up",
            "time_calls/campbell_response",
            "time_calls/time_verify",
        ],
    },
    Section {
        title: "Stability",
        about: "Floquet multipliers of points, bifurcations, limit cycles",
        files: &[
            "time_calls/stability",
            "time_calls/stability_kick",
            "time_calls/stability_lists",
        ],
    },
    Section {
        title: "Design studies",
        about: "parameters of a model, derivatives of results by them, responses over them",
        files: &[
            "design/sensitivities",
            "design/complex_sensitivities",
            "design/parameter_responses",
            "design/parameter_optima",
            "design/batch",
            "design/wheel_peaks",
            "design/wheel_identify",
            "structures/wheel_blade_modes",
            "design/band",
            "design/band_curves",
            "mode_calls/mode_bands",
            "solving/static_history",
            "design/life",
            "design/fit_data",
            "design/fit",
            "design/fit_profile",
        ],
    },
    Section {
        title: "Low level",
        about: "one contact law, the residual at a given motion, indices from 1",
        files: &["solving/low_level"],
    },
];

/// Longest line of the header.
const COLUMNS: usize = 100;

/// The files in src/capi that declare items, without extension, in the order of the header.
pub fn files() -> impl Iterator<Item = &'static str> {
    SECTIONS.iter().flat_map(|section| section.files).copied()
}

/// The header, from the items as cbindgen writes them, the texts of [`files`], and the three numbers of the version.
/// An error names an item without a place, or a line that is too long.
pub fn assemble(items: &str, sources: &[String], version: &[String; 3]) -> Result<String, String> {
    let mut blocks = blocks(items)?;
    let mut text = prologue(version);
    let mut sources = sources.iter();
    for section in &SECTIONS {
        text += &banner(section);
        for file in section.files {
            let source = sources.next().ok_or_else(|| format!("no text of {file}.rs"))?;
            for name in declared(source) {
                let place = blocks.iter().position(|(known, _)| known == name);
                let place = place.ok_or_else(|| format!("{file}.rs: cbindgen wrote no {name}"))?;
                text += &marked(&blocks.remove(place).1);
                text.push('\n');
            }
        }
    }
    if let Some((name, _)) = blocks.first() {
        return Err(format!("{name} is declared in no file of a section"));
    }
    text += "#ifdef __cplusplus\n} /* extern \"C\" */\n#endif\n\n#endif /* HBVIB_H */\n";
    let long = text.lines().find(|line| line.chars().count() > COLUMNS);
    long.map_or(Ok(text.clone()), |line| {
        Err(format!("longer than {COLUMNS} columns: {line}"))
    })
}

/// The item with the mark of a status that must not be ignored, if it is a function that returns one. Nothing can be done
/// about a failure of the functions that free.
fn marked(block: &str) -> String {
    let lines = block.lines().map(|line| {
        let is_status = line.starts_with("hbvib_status ") && line.contains('(') && !line.contains("_free(");
        format!("{}{line}\n", if is_status { "HBVIB_NODISCARD\n" } else { "" })
    });
    lines.collect()
}

fn prologue(version: &[String; 3]) -> String {
    let mut text = include_str!("prologue.h").to_owned();
    for (place, number) in ["@MAJOR@", "@MINOR@", "@PATCH@"].iter().zip(version) {
        text = text.replace(place, number);
    }
    let line = |section: &Section| format!(" *   {:<19} {}\n", section.title, section.about);
    text.replace(" *   @CONTENTS@\n", &SECTIONS.iter().map(line).collect::<String>()) + "\n"
}

fn banner(section: &Section) -> String {
    let rule = "=".repeat(COLUMNS - 6);
    format!("/* {rule}\n * {}: {}\n * {rule} */\n\n", section.title, section.about)
}

/// Name and text of each item; cbindgen separates items by empty lines.
fn blocks(items: &str) -> Result<Vec<(String, String)>, String> {
    items
        .split("\n\n")
        .map(str::trim)
        .filter(|block| !block.is_empty())
        .map(|block| {
            let name = defined(block).ok_or_else(|| format!("no name in:\n{block}"))?;
            let mut block = block.to_owned() + "\n";
            if name == "hbvib_cancel_flag" {
                // Rust has no volatile type.
                block = block.replace("typedef int32_t", "typedef volatile int32_t");
            }
            Ok((name.to_owned(), block))
        })
        .collect()
}

/// The name that an item of C defines.
fn defined(block: &str) -> Option<&str> {
    let start = block.lines().find(|line| !line.starts_with("//"))?;
    let code = &block[start.as_ptr() as usize - block.as_ptr() as usize..];
    let (before, name_last) = match code.split_once("(*") {
        // typedef int32_t (*name)(...);
        Some((_, rest)) if code.starts_with("typedef") && !code.contains('{') => (rest.split(')').next()?, true),
        // typedef ... name;   typedef struct {...} name;
        _ if code.starts_with("typedef") => (code.strip_suffix(';')?, true),
        // type name(...);
        _ => (code.split('(').next()?, false),
    };
    let name = before
        .rsplit(|c: char| !(c.is_ascii_alphanumeric() || c == '_'))
        .next()?;
    (name.starts_with("hbvib_") && (name_last || code.ends_with(");"))).then_some(name)
}

/// Names of the C items that a source file declares, in its order.
fn declared(source: &str) -> impl Iterator<Item = &str> {
    source.lines().filter_map(|line| {
        let line = line.strip_prefix("pub ")?;
        let line = line.strip_prefix("unsafe ").unwrap_or(line);
        let line = line.strip_prefix("extern \"C\" ").unwrap_or(line);
        let (kind, rest) = line.split_once(' ')?;
        let name = rest.split(|c: char| !(c.is_ascii_alphanumeric() || c == '_')).next()?;
        (matches!(kind, "fn" | "struct" | "enum" | "type") && name.starts_with("hbvib_")).then_some(name)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const ITEMS: &str = "/// Two.\ntypedef struct {\n  int32_t a;\n} hbvib_two;\n\ntypedef struct hbvib_one hbvib_one;\n\n\
                         typedef int32_t hbvib_cancel_flag;\n\n\
                         typedef int32_t (*hbvib_fn)(void *user, const hbvib_two *two);\n\n\
                         /// Does.\nhbvib_status hbvib_do(const hbvib_two *two,\n                      int64_t n);\n";

    fn version() -> [String; 3] {
        ["1", "2", "3"].map(str::to_owned)
    }

    /// Sources with these items in the first file.
    fn sources(first: &str) -> Vec<String> {
        let mut sources = vec![String::new(); files().count()];
        first.clone_into(&mut sources[0]);
        sources
    }

    #[test]
    fn items_are_known_by_name() {
        let names: Vec<_> = blocks(ITEMS).unwrap().into_iter().map(|(name, _)| name).collect();
        assert_eq!(
            names,
            ["hbvib_two", "hbvib_one", "hbvib_cancel_flag", "hbvib_fn", "hbvib_do"]
        );
        assert!(blocks("typedef int32_t other;").is_err());
        assert!(blocks("hbvib_status hbvib_do(int32_t a)").is_err());
    }

    #[test]
    fn the_order_is_that_of_the_sources() {
        let first = "pub unsafe extern \"C\" fn hbvib_do(\n) {}\npub struct hbvib_one(());\npub(super) fn hbvib_not() {}\n\
                     pub type hbvib_fn = i32;\npub struct hbvib_two {\npub type hbvib_cancel_flag = i32;\n";
        let text = assemble(ITEMS, &sources(first), &version()).unwrap();
        let places = [
            "* Version and errors:",
            "hbvib_do(const",
            "} hbvib_two;",
            "typedef volatile int32_t hbvib_cancel_flag;",
            "* Matrices:",
        ];
        let places = places.map(|part| text.find(part).unwrap_or_else(|| panic!("no {part} in\n{text}")));
        assert!(places.is_sorted(), "{places:?}");
        assert!(text.contains("#define HBVIB_VERSION_PATCH 3\n"));
    }

    #[test]
    fn items_without_a_place_and_long_lines_are_errors() {
        let error = |items, first: &str| assemble(items, &sources(first), &version()).unwrap_err();
        assert!(error("", "pub fn hbvib_do() {}").contains("cbindgen wrote no hbvib_do"));
        assert!(error("void hbvib_do(void);", "").contains("hbvib_do is declared in no file"));
        let long = format!("/// {}\nvoid hbvib_do(void);", "long ".repeat(20));
        assert!(error(&long, "pub fn hbvib_do() {}").contains("longer than 100 columns"));
    }
}
