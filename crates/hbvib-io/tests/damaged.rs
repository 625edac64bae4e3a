//! Twenty damaged files of each format: a sentence with the line, no panic, no memory beyond ten times the file.

mod counting;

use counting::{MOST, USED};
use hbvib_io::read;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::Ordering;

/// One test at a time: the counts are those of the process.
static ALONE: Mutex<()> = Mutex::new(());

fn data(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data").join(name)
}

/// Buffers of readers and lines, which do not grow with the file.
const BUFFERS: usize = 128 << 10;

/// Where a format has its parts, in lines from 0.
struct Format {
    file: &'static str,
    /// A line with the size of the matrix, and the position of a count in it.
    head: Option<(usize, usize)>,
    /// A line with a value, its last word.
    value: usize,
    /// A line that begins with an index.
    index: usize,
    /// Data end with the last line, so that one more is too many.
    ends: bool,
    /// The fewest lines of a whole file are all of them: none may be missing at the end.
    counted: bool,
}

const FORMATS: [Format; 7] = [
    Format {
        file: "symmetric.mtx",
        head: Some((2, 2)),
        value: 8,
        index: 8,
        ends: true,
        counted: true,
    },
    Format {
        file: "complex.mtx",
        head: Some((2, 2)),
        value: 8,
        index: 8,
        ends: true,
        counted: true,
    },
    Format {
        file: "wheel_STIF1.mtx",
        head: None,
        value: 8,
        index: 8,
        ends: false,
        counted: false,
    },
    Format {
        file: "sector.sti",
        head: None,
        value: 8,
        index: 8,
        ends: false,
        counted: false,
    },
    Format {
        file: "general.rua",
        head: Some((2, 1)),
        value: 12,
        index: 5,
        ends: true,
        counted: true,
    },
    Format {
        file: "dense.op4",
        head: Some((0, 1)),
        value: 2,
        index: 1,
        ends: false,
        counted: true,
    },
    Format {
        file: "sparse.op4",
        head: Some((0, 1)),
        value: 3,
        index: 1,
        ends: false,
        counted: true,
    },
];

/// A line whose word at a position is another one of the same width.
fn replaced(line: &str, position: usize, word: &str) -> String {
    let starts: Vec<usize> = line
        .char_indices()
        .filter(|&(i, c)| !c.is_whitespace() && (i == 0 || line.as_bytes()[i - 1].is_ascii_whitespace()))
        .map(|(i, _)| i)
        .collect();
    let start = starts[position];
    let end = line[start..].find([' ', ',']).map_or(line.len(), |at| start + at);
    let room = line[..end].trim_end().len();
    let width = room - line[..start].trim_end().len();
    format!(
        "{}{word:>width$}{}",
        &line[..start.saturating_sub(width - (room - start))],
        &line[end..]
    )
}

/// The last number of a line replaced, in its place.
fn last(line: &str, word: &str) -> String {
    // Numbers may touch each other in fixed fields: the last sign that no exponent has begins the last one.
    let bytes = line.as_bytes();
    let start = (1..line.len())
        .rev()
        .find(|&i| {
            let sign = bytes[i] == b'-' && !bytes[i - 1].eq_ignore_ascii_case(&b'e');
            sign || bytes[i - 1] == b' ' || bytes[i - 1] == b','
        })
        .unwrap_or(0);
    let width = line.len() - start;
    format!("{}{word:>width$}", &line[..start])
}

/// The damaged texts, each with its damage.
fn damaged(format: &Format, text: &str) -> Vec<(String, Vec<u8>)> {
    let lines: Vec<&str> = text.lines().collect();
    let with = |at: usize, line: String| {
        let mut all: Vec<String> = lines.iter().map(|line| (*line).to_owned()).collect();
        all[at] = line;
        (all.join("\n") + "\n").into_bytes()
    };
    let mut all = Vec::new();
    let mut add = |what: &str, bytes: Vec<u8>| all.push((what.to_owned(), bytes));
    let (value, index) = (lines[format.value], lines[format.index]);
    add("empty", Vec::new());
    for word in [
        "nan", "NaN", "inf", "-inf", "1e999", "1..5", "1e", "0x1p3", "twelve", "1.0e+",
    ] {
        add(&format!("value {word}"), with(format.value, last(value, word)));
    }
    let first = |word: &str| match index
        .find([' ', ','].as_slice())
        .filter(|at| *at > 0 && !index.starts_with(' '))
    {
        Some(end) => format!("{word}{}", &index[end..]),
        None => replaced(index, 0, word),
    };
    for word in ["0", "-1", "999", "1.5", "q"] {
        let bytes = match format.file {
            // Any node number is a node.
            "wheel_STIF1.mtx" if matches!(word, "0" | "-1" | "999") => with(
                format.index,
                format!("10,{word}0, 10,1, 1.0\n").replace("10,", if word == "999" { "10,1.5," } else { "10,-" }),
            ),
            _ => with(format.index, first(word)),
        };
        add(&format!("index {word}"), bytes);
    }
    add(
        "a zero byte",
        with(format.value, value.replacen('e', "\0", 1).replacen('E', "\0", 1)),
    );
    let mut bytes = with(format.value, value.to_owned());
    let at = bytes.len() / 2;
    bytes[at] = 0xff;
    add("no UTF-8", bytes);
    add("a line that never ends", with(format.value, "1".repeat(70_000)));
    add(
        "words for numbers",
        with(format.index, "lorem ipsum dolor sit amet consectetur".into()),
    );
    add("a keyword", with(format.index, "*MATRIX ASSEMBLE, STIFFNESS=K".into()));
    if format.counted {
        for share in [1, 3, 5] {
            let cut = lines[..lines.len() * share / 7].join("\n") + "\n";
            add(&format!("cut after {share} of 7"), cut.into_bytes());
        }
        add(
            "the last line missing",
            (lines[..lines.len() - 1].join("\n") + "\n").into_bytes(),
        );
    }
    if let Some((line, word)) = format.head {
        for huge in ["99999999", "-3", "x"] {
            add(&format!("count {huge}"), with(line, replaced(lines[line], word, huge)));
        }
    }
    if format.ends {
        add("one line more", format!("{text}{}\n", lines[format.value]).into_bytes());
    }
    all
}

#[test]
fn damaged_files_are_refused_by_line_without_memory() {
    let _alone = ALONE.lock();
    let folder = std::env::temp_dir().join(format!("hbvib_io_damaged_{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    for name in ["sector.dof", "sector.mas"] {
        std::fs::copy(data(name), folder.join(name)).unwrap();
    }
    for format in &FORMATS {
        let text = std::fs::read_to_string(data(format.file)).unwrap();
        let path = folder.join(format.file);
        let cases = damaged(format, &text);
        assert!(cases.len() >= 20, "{}: {} cases", format.file, cases.len());
        for (damage, bytes) in cases {
            std::fs::write(&path, &bytes).unwrap();
            let before = USED.load(Ordering::Relaxed);
            MOST.store(before, Ordering::Relaxed);
            let outcome = read(&path);
            let memory = MOST.load(Ordering::Relaxed) - before;
            let Err(error) = outcome else {
                panic!("{}, {damage}: accepted", format.file);
            };
            let sentence = error.to_string();
            assert!(sentence.contains(", line "), "{}, {damage}: {sentence}", format.file);
            assert!(
                memory <= 10 * bytes.len() + BUFFERS,
                "{}, {damage}: {memory} bytes",
                format.file
            );
        }
    }
    std::fs::remove_dir_all(folder).unwrap();
}

/// Sizes that no file can hold, before memory is requested.
#[test]
fn sizes_beyond_the_file_are_refused() {
    let _alone = ALONE.lock();
    let path = std::env::temp_dir().join(format!("hbvib_io_sizes_{}.mtx", std::process::id()));
    for size in [
        "99999999999999999999 1 1",
        "4294967297 4294967297 1",
        "2147483647 2147483647 1",
        "10 10 1000000000000",
        "10 10 18446744073709551615",
    ] {
        std::fs::write(
            &path,
            format!("%%MatrixMarket matrix coordinate real general\n{size}\n1 1 1.0\n"),
        )
        .unwrap();
        MOST.store(USED.load(Ordering::Relaxed), Ordering::Relaxed);
        let before = USED.load(Ordering::Relaxed);
        let sentence = read(&path).unwrap_err().to_string();
        assert!(sentence.contains("line 2"), "{sentence}");
        assert!(MOST.load(Ordering::Relaxed) - before < BUFFERS);
    }
    std::fs::remove_file(path).unwrap();
}

/// A diagonal that its symmetry forbids, with the line; zeros are harmless.
#[test]
fn a_diagonal_against_the_symmetry_is_refused() {
    let _alone = ALONE.lock();
    let path = std::env::temp_dir().join(format!("hbvib_io_diagonal_{}.mtx", std::process::id()));
    for (banner, entry, refused) in [
        (
            "coordinate real skew-symmetric",
            "2 2 1.5",
            Some("1.5 on the diagonal of a skew-symmetric"),
        ),
        (
            "coordinate complex skew-symmetric",
            "2 2 0 -3",
            Some("on the diagonal of a skew-symmetric"),
        ),
        (
            "coordinate complex hermitian",
            "2 2 1 0.5",
            Some("an imaginary part of 0.5"),
        ),
        ("coordinate real skew-symmetric", "2 2 0", None),
        ("coordinate complex hermitian", "2 2 1 0", None),
    ] {
        let imaginary = if banner.contains("complex") { " 0" } else { "" };
        std::fs::write(
            &path,
            format!("%%MatrixMarket matrix {banner}\n2 2 2\n2 1 1{imaginary}\n{entry}\n"),
        )
        .unwrap();
        match (read(&path), refused) {
            (Ok(_), None) => {}
            (Err(e), Some(words)) => {
                let sentence = e.to_string();
                assert!(sentence.contains(words) && sentence.contains("line 4"), "{sentence}");
            }
            (found, _) => panic!("{banner}, {entry}: {}", found.is_ok()),
        }
    }
    std::fs::remove_file(path).unwrap();
}

#[cfg(not(feature = "hdf5"))]
#[test]
fn a_matlab_file_of_version_7_3_names_the_feature_that_reads_it() {
    let message = read(&data("version73.mat")).unwrap_err().to_string();
    assert!(message.contains("7.3") && message.contains("feature hdf5"), "{message}");
}
