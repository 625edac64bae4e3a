//! Universal files give nodes, elements, shapes and functions as pyuff and others write them, and a sentence where they are damaged.

use hbvib_io::{UniversalNode, read, read_universal};
use std::path::{Path, PathBuf};

fn data() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/shapes.uff")
}

fn near(found: f64, expected: f64, tolerance: f64) -> bool {
    (found - expected).abs() <= tolerance * expected.abs()
}

/// Numbers that `make.py` gave to pyuff, which writes five digits of shapes, twelve of functions, and all of coordinates.
#[test]
fn files_of_pyuff_are_read() {
    let all = read_universal(&data()).unwrap();
    assert_eq!((&all.name[..], &all.others[..]), ("wheel", &[][..]));
    let node = |number, position| UniversalNode { number, position };
    assert_eq!(
        all.nodes,
        [
            node(1, [0.0, -2.0, 3e-3]),
            node(7, [1.5, 0.25, -1.0]),
            node(12, [1.0 / 3.0, -2.0 / 7.0, 1e-10 / 3.0]),
            node(13, [-1.0 / 3.0, 2.0 / 7.0, 0.0]),
        ]
    );
    assert_eq!(all.lines, [[1, 7, 0, 12]]);
    let [shape] = &all.shapes[..] else {
        panic!("{}", all.shapes.len())
    };
    assert_eq!(
        (shape.analysis, &shape.integers[..], &shape.reals[..]),
        (2, &[1, 4][..], &[123.45, 2.0, 0.01, 0.0][..])
    );
    assert_eq!(
        (&shape.nodes[..], shape.per_node, shape.values.len()),
        (&[1, 7][..], 6, 12)
    );
    assert!(near(shape.values[0].0, 0.189_053_381_793_533_07, 1e-5));
    assert!(near(shape.values[7].0, -2.441_467_382_639_855_6, 1e-5) && shape.values[7].1 == 0.0);
    let y = [
        (-0.169_760_497_723_135_42, 1.801_420_858_449_332_8),
        (0.868_460_211_211_510_2, -0.764_464_115_720_399_3),
        (-1.129_715_961_780_754_8, -1.079_060_459_136_942_4),
        (-0.421_858_826_178_316_2, -0.563_287_198_504_037_9),
        (0.242_938_853_098_735_2, 0.969_272_201_138_162_8),
    ];
    let [text, binary, uneven] = &all.functions[..] else {
        panic!("{}", all.functions.len())
    };
    for (function, tolerance) in [(text, 1e-11), (binary, 0.0)] {
        assert_eq!(
            (function.kind, function.response, function.reference),
            (4, (7, 3), (1, -2))
        );
        assert_eq!(function.abscissa, [0.0, 0.5, 1.0, 1.5, 2.0]);
        for (found, expected) in function.values.iter().zip(y) {
            assert!(
                near(found.0, expected.0, tolerance) && near(found.1, expected.1, tolerance),
                "{found:?} {expected:?}"
            );
        }
    }
    assert_eq!((uneven.kind, &uneven.abscissa[..]), (1, &[0.0, 0.1, 0.3, 0.7, 2.0][..]));
    assert!(
        uneven
            .values
            .iter()
            .zip(y)
            .all(|(found, y)| near(found.0, y.0, 1e-11) && found.1 == 0.0)
    );
}

struct Written(PathBuf);

impl Written {
    fn new(name: &str, bytes: &[u8]) -> Self {
        let path = std::env::temp_dir().join(format!("hbvib_io_uff_{}_{name}", std::process::id()));
        std::fs::write(&path, bytes).unwrap();
        Self(path)
    }
}

impl Drop for Written {
    fn drop(&mut self) {
        let _ = std::fs::remove_file(&self.0);
    }
}

/// A complex shape, elements, and a binary function in single precision with the highest byte first and uneven times.
#[test]
fn elements_complex_shapes_and_uneven_binary_functions_are_read() {
    let mut bytes = b"    -1\n  2412\n         3        21         1         1         7         2\n         0         1         1\n\
        \x20        1         7\n         4       111         1         1         7         4\n         1         7         8         9\n\
        \x20   -1\n    -1\n    55\nshape\n\n\n\n\n         1         3         2         8         5         3\n\
        \x20        2         6         1         5\n -1.00000E+00 2.00000E+02 1.00000E+00 0.00000E+00 0.00000E+00 0.00000E+00\n\
        \x20        9\n 1.00000E+00-2.00000E+00 3.00000E+00 4.00000E+00-5.00000E+00-6.00000E-03\n    -1\n\
        \x20   -1\n  1234\nsomething else\n    -1\n    -1\n    58b     2     2          11          24     0     0           0           0\n"
        .to_vec();
    for line in ["a", "b", "c", "d", "e"] {
        bytes.extend(format!("{line}\n").bytes());
    }
    bytes.extend(
        format!(
            "{:5}{:10}{:5}{:10} {:10}{:10}{:4} {:10}{:10}{:4}\n",
            1, 1, 1, 0, "", 8, 1, "A B", 9, 2
        )
        .bytes(),
    );
    bytes.extend(b"         2         3         0  0.00000E+00  0.00000E+00  0.00000E+00\n1\n1\n1\n1\n");
    for number in [0.5_f32, 1.25, 0.75, -2.5, 2.0, 0.0] {
        bytes.extend(number.to_be_bytes());
    }
    bytes.extend(b"\n    -1\n");
    let file = Written::new("more.unv", &bytes);
    let all = read_universal(&file.0).unwrap();
    let elements: Vec<(i64, i64, &[i64])> = all.elements.iter().map(|e| (e.number, e.kind, &e.nodes[..])).collect();
    assert_eq!(elements, [(3, 21, &[1, 7][..]), (4, 111, &[1, 7, 8, 9][..])]);
    assert_eq!(all.shapes[0].values, [(1.0, -2.0), (3.0, 4.0), (-5.0, -6e-3)]);
    assert_eq!((&all.shapes[0].text[0][..], all.shapes[0].reals[1]), ("shape", 200.0));
    assert_eq!(all.others, [1234]);
    let function = &all.functions[0];
    assert_eq!((function.response, function.reference), ((8, 1), (9, 2)));
    assert_eq!(function.abscissa, [0.5, 0.75, 2.0]);
    assert_eq!(function.values, [(1.25, 0.0), (-2.5, 0.0), (0.0, 0.0)]);
}

#[test]
fn damaged_files_are_refused_by_line() {
    let good = std::fs::read(data()).unwrap();
    let text = String::from_utf8_lossy(&good).into_owned();
    let first = text.split("    -1\n    -1\n    58b").next().unwrap();
    for (what, text, words) in [
        ("empty", String::new(), "no data set"),
        ("no mark", "  2411\n".to_owned(), "-1 before each data set"),
        ("cut", first.to_owned(), "ends within a data set"),
        (
            "short",
            first.replace("  3.3333333333333331e-01 ", "  ") + "    -1\n",
            "more numbers than 3 coordinates",
        ),
        (
            "a word",
            first.replace("3.3333333333333331e-01", "three") + "    -1\n",
            "\"three\"",
        ),
        (
            "nan",
            first.replace("3.3333333333333331e-01", "nan") + "    -1\n",
            "finite",
        ),
        (
            "a type",
            first.replace(
                "         2         8         2         6",
                "         2         8         9         6",
            ),
            "type 9",
        ),
        (
            "a count",
            first.replace("1         4         1\n", "1  99999999         1\n"),
            "99999999 nodes",
        ),
    ] {
        let file = Written::new("damaged.uff", text.as_bytes());
        let sentence = read_universal(&file.0).unwrap_err().to_string();
        let line = text.is_empty() || sentence.contains(", line ");
        assert!(sentence.contains(words) && line, "{what}: {sentence}");
    }
    // Where a matrix is wanted the format is named.
    let sentence = read(&data()).unwrap_err().to_string();
    assert!(
        sentence.contains("universal file") && sentence.contains("OP4"),
        "{sentence}"
    );
}
