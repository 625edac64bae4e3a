//! The layout of the structs of the header, and their defaults as the library fills them.

use crate::declarations::{Base, Declarations, Result, Struct, Type};
use std::collections::HashMap;

/// Position of a field.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    pub offset: usize,
    /// Bytes of one entry, and number of entries.
    pub size: usize,
    pub count: usize,
}

/// The layout of a struct in C.
#[derive(Clone, Debug, PartialEq)]
pub struct Layout {
    pub size: usize,
    pub places: Vec<Place>,
}

impl Layout {
    pub fn of(all: &Declarations, s: &Struct) -> Result<Self> {
        let mut places = Vec::new();
        let mut end = 0_usize;
        let mut align = 1;
        for field in &s.fields {
            let size = size(all, &field.kind).map_err(|error| format!("{}.{}: {error}", s.name, field.name))?;
            let count = field.kind.array.unwrap_or(1);
            let offset = end.next_multiple_of(size);
            if offset != end {
                return Err(format!("{}: hidden padding before {}", s.name, field.name));
            }
            places.push(Place { offset, size, count });
            end = offset + size * count;
            align = align.max(size);
        }
        if !end.is_multiple_of(align) {
            return Err(format!("{}: hidden padding at the end", s.name));
        }
        Ok(Self { size: end, places })
    }
}

fn size(all: &Declarations, kind: &Type) -> Result<usize> {
    if kind.pointers > 0 {
        return Ok(8);
    }
    match all.resolved(&kind.base) {
        Base::Int32 | Base::Uint32 => Ok(4),
        Base::Int64 | Base::Size | Base::Double => Ok(8),
        Base::Named(name) if all.callbacks.iter().any(|c| c.name == *name) => Ok(8),
        other => Err(format!("{other:?} cannot be a field")),
    }
}

/// The bytes of each struct after its `_init` function; zeros and its size if it has none.
pub type Defaults = HashMap<String, Vec<u8>>;

/// Whether the caller fills a struct, by its `_init` function. The library alone writes the others.
pub fn is_filled_by_caller(all: &Declarations, s: &Struct) -> bool {
    all.function(&format!("{}_init", s.name)).is_some()
}

/// The defaults, from `init`, which calls the function of a name with a struct and its size.
pub fn defaults(all: &Declarations, init: impl Fn(&str, &mut [u8]) -> Result<()>) -> Result<Defaults> {
    let mut found = Defaults::new();
    for s in &all.structs {
        let layout = Layout::of(all, s)?;
        let mut bytes = vec![0; layout.size];
        bytes[..4].copy_from_slice(&u32::try_from(layout.size).map_err(|e| e.to_string())?.to_ne_bytes());
        if is_filled_by_caller(all, s) {
            init(&format!("{}_init", s.name), &mut bytes)?;
        }
        found.insert(s.name.clone(), bytes);
    }
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn one(fields: &str) -> Result<Layout> {
        let all = Declarations::parse(&format!(
            "typedef int32_t (*hbvib_fn)(void *user);\ntypedef struct {{\n{fields}}} hbvib_s;\n"
        ))?;
        Layout::of(&all, &all.structs[0])
    }

    #[test]
    fn offsets_follow_from_sizes() {
        let layout = one("  uint32_t a;\n  int32_t b;\n  int64_t c[3];\n  hbvib_fn f;\n  void *p;\n").unwrap();
        let offsets: Vec<_> = layout.places.iter().map(|place| place.offset).collect();
        assert_eq!((layout.size, offsets), (48, vec![0, 4, 8, 32, 40]));
    }

    #[test]
    fn hidden_padding_is_refused() {
        assert!(one("  int32_t a;\n  double b;\n").unwrap_err().contains("before b"));
        assert!(one("  double a;\n  int32_t b;\n").unwrap_err().contains("at the end"));
    }

    #[test]
    fn structs_without_init_function_have_their_size_and_zeros() {
        let all = Declarations::parse("typedef struct {\n  uint32_t struct_size;\n  int32_t a;\n} hbvib_s;\n").unwrap();
        let found = defaults(&all, |_, _| Err("not to be called".into())).unwrap();
        assert_eq!(found["hbvib_s"], [8_u32.to_ne_bytes(), [0; 4]].concat());
    }
}
