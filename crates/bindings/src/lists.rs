//! Lists for the tests: symbols, and fields of structs in Rust.

use crate::declarations::Declarations;
use std::fmt::Write as _;

/// The functions by name, one per line.
pub fn symbols(all: &Declarations) -> String {
    let mut names: Vec<_> = all.functions.iter().map(|f| f.name.as_str()).collect();
    names.sort_unstable();
    names.join("\n") + "\n"
}

/// Structs with their fields, for the macro of tests/programs/layout.rs.
pub fn layouts(all: &Declarations) -> String {
    let mut text = String::new();
    for s in &all.structs {
        let fields: Vec<_> = s.fields.iter().map(|field| field.name.as_str()).collect();
        writeln!(text, "        {} {{ {} }}", s.name, fields.join(", ")).unwrap();
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn symbols_are_sorted_and_structs_in_the_order_of_the_header() {
        let header =
            "void hbvib_b(void);\n\nvoid hbvib_a(void);\n\ntypedef struct {\n  int32_t b;\n  int32_t a;\n} hbvib_s;\n";
        let all = Declarations::parse(header).unwrap();
        assert_eq!(symbols(&all), "hbvib_a\nhbvib_b\n");
        assert_eq!(layouts(&all), "        hbvib_s { b, a }\n");
    }
}
