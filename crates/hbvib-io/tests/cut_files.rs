//! Text files that end within a line: refused, doubted in the report, or with the numbers of the whole lines before; and numbers of DMIG
//! at wrong places.

use hbvib_io::{Format, Matrices, Matrix, Symmetry, read, report, write};
use std::path::{Path, PathBuf};

fn folder(name: &str) -> PathBuf {
    // In memory if the system has that.
    let memory = Path::new("/dev/shm");
    let place = if memory.is_dir() {
        memory.to_owned()
    } else {
        std::env::temp_dir()
    };
    let folder = place.join(format!("hbvib_io_{name}_{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

fn triangle(shift: f64, is_complex: bool) -> Matrix {
    let real = [4.0 + shift, -1.0, 4.0, -1.0 / 3.0, 4.0];
    Matrix {
        rows: 3,
        columns: 3,
        symmetry: Symmetry::Symmetric,
        row: vec![0, 1, 1, 2, 2],
        column: vec![0, 0, 1, 1, 2],
        values: if is_complex {
            real.iter().flat_map(|v| [*v, 0.03 * v]).collect()
        } else {
            real.to_vec()
        },
        is_complex,
    }
}

/// Matrices as they were read, for comparisons to the last bit.
fn numbers(found: &Matrices) -> String {
    format!("{:?}", (&found.stiffness, &found.mass, &found.dofs))
}

/// Whether a file of these bytes is read, and its numbers, and whether the report warns of its end.
fn outcome(path: &Path, bytes: &[u8]) -> Option<(String, bool)> {
    std::fs::write(path, bytes).unwrap();
    let found = read(path).ok()?;
    let warned = report(&found).warnings.iter().any(|w| w.contains("may be cut off"));
    Some((numbers(&found), warned))
}

#[test]
fn a_file_cut_within_a_line_is_refused_or_doubted_or_has_the_lines_before() {
    let folder = folder("cut_within");
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data");
    let mut originals = Vec::new();
    let both = |is_complex| Matrices {
        stiffness: Some(triangle(0.5, is_complex)),
        mass: Some(triangle(100.0, false)),
        dofs: vec![(1, 1), (1, 2), (4, 1)],
        ..Matrices::default()
    };
    let one = Matrices {
        mass: None,
        ..both(false)
    };
    for (name, model, format) in [
        ("a.op4", &both(true), Format::Op4Text),
        ("b.pch", &both(false), Format::Dmig),
        ("c.pch", &both(true), Format::Dmig),
        ("d.inp", &both(false), Format::UserElement),
        ("e.mtx", &one, Format::MatrixMarket),
    ] {
        let path = folder.join(name);
        write(&path, model, format).unwrap();
        originals.push((path.clone(), std::fs::read(&path).unwrap()));
    }
    for name in ["general.rua", "wheel_STIF1.mtx", "complex.mtx"] {
        originals.push((folder.join(name), std::fs::read(data.join(name)).unwrap()));
    }
    for (path, whole) in originals {
        let (mut refused, mut warned, mut lines) = (0, 0, 0);
        let mut before = None;
        for end in 0..whole.len() {
            let cut = outcome(&path, &whole[..end]);
            if end == 0 || whole[end - 1] == b'\n' {
                before = cut;
                continue;
            }
            match (&cut, &before) {
                (None, _) => refused += 1,
                (Some((_, true)), _) => warned += 1,
                (Some((found, false)), Some((lines_before, _))) if found == lines_before => lines += 1,
                (Some((found, false)), _) => {
                    // No digit of the line is missing, and a blank, a comma or a full field tells it.
                    let rest = whole[end..].iter().position(|byte| *byte == b'\n').unwrap();
                    let line = outcome(&path, &whole[..=end + rest]);
                    let digits = whole[end..end + rest].iter().any(u8::is_ascii_digit);
                    let is_whole = line.is_some_and(|(numbers, _)| &numbers == found);
                    assert!(is_whole && !digits, "{path:?} cut at {end}: {found}");
                }
            }
        }
        assert!(
            refused > 0 && refused + warned + lines > whole.len() / 2,
            "{path:?}: {refused} {warned} {lines}"
        );
        // The whole file without the end of its last line, as some programs write it, is read where the numbers are counted.
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        let trimmed = whole.strip_suffix(b"\n").unwrap();
        let unended = outcome(&path, trimmed).map(|(_, warned)| warned);
        let told = outcome(&path, &whole).unwrap().1;
        assert!(!told, "{name}: the whole file is doubted");
        match &name[..] {
            "e.mtx" | "complex.mtx" | "general.rua" => assert_eq!(unended, Some(true), "{name}"),
            "wheel_STIF1.mtx" => assert_eq!(unended, None, "{name}"),
            // A comma follows the last number, or its field is full.
            "d.inp" | "c.pch" => assert_eq!(unended, Some(false), "{name}"),
            _ => {}
        }
    }
    std::fs::remove_dir_all(folder).unwrap();
}

fn entry(kind: u8) -> String {
    format!("{:<8}{:<8}{:>8}{:>8}{kind:>8}{:>8}\n", "DMIG", "KAAX", 0, 6, 0)
}

fn column(node: i64) -> String {
    format!("{:<8}{:<16}{node:>16}{:>16}\n", "DMIG*", "KAAX", 1)
}

fn row(node: i64, numbers: &[&str]) -> String {
    let mut line = format!("{:<8}{node:>16}{:>16}", "*", 1);
    for number in numbers {
        line += &format!("{number:>16}");
    }
    line + "\n"
}

/// The stiffness of a file of DMIG with two rows, or the sentence of its refusal.
fn read_as(text: &str) -> Result<Matrix, String> {
    let folder = folder("dmig");
    let path = folder.join("k.pch");
    std::fs::write(&path, text).unwrap();
    let found = read(&path).map_err(|e| e.to_string());
    let _ = std::fs::remove_dir_all(folder);
    found.map(|found| found.stiffness.unwrap())
}

#[test]
fn numbers_of_dmig_are_refused_at_wrong_places() {
    let second = column(2) + &row(2, &["3."]);
    let with = |line: String| entry(2) + &column(1) + &row(1, &["2."]) + &line + &second;
    assert_eq!(read_as(&with(row(2, &["-1."]))).unwrap().values, [2.0, -1.0, 3.0]);
    for (text, words) in [
        (with(row(2, &[])), "line 4: value is missing"),
        (with(row(2, &["", "-1."])), "line 4: an imaginary part of -1 in KAAX"),
        (
            with(row(2, &["-1.", "-0.02"])),
            "line 4: an imaginary part of -0.02 in KAAX",
        ),
        (
            with(format!("{:<8}{:>16}{:>16}\n", "*", "", "2")),
            "line 4: row is missing",
        ),
        (
            entry(4) + &column(1) + &row(1, &[]) + &second,
            "line 3: value is missing",
        ),
        (entry(2) + &row(1, &["2."]), "line 2: rows before their column"),
        (entry(2) + &column(1) + &second, "line 2: a column of KAAX without rows"),
        (entry(2) + &second + &column(1), "line 4: a column of KAAX without rows"),
        (
            entry(2) + "DMIG,KAAX,1,1,1,1,2.\n",
            "line 2: field 5 of a column is \"1\"",
        ),
        (
            entry(2) + "DMIG,KAAX,1,1,,1,1,2.5",
            "line 2: the file ends with a number",
        ),
        (entry(3) + "DMIG,KAAX,1,1,,1,1,2.5", "line 2: the file ends before"),
    ] {
        let sentence = read_as(&text).unwrap_err();
        assert!(sentence.contains(words), "{words}: {sentence}");
    }
    // A zero imaginary part of a real matrix says nothing else; blank parts of a complex number are zeros.
    assert_eq!(read_as(&with(row(2, &["-1.", "0."]))).unwrap().values, [2.0, -1.0, 3.0]);
    let parts = entry(4) + &column(1) + &row(1, &["2."]) + &row(2, &["", "0.5"]) + &second;
    assert_eq!(read_as(&parts).unwrap().values, [2.0, 0.0, 0.0, 0.5, 3.0, 0.0]);
}

#[test]
fn a_hermitian_matrix_with_loss_on_its_diagonal_is_refused() {
    let folder = folder("hermitian");
    let path = folder.join("k.mtx");
    let banner = "%%MatrixMarket matrix coordinate complex";
    let entries = "2 2 3\n1 1 2 0.04\n2 1 -1 -0.02\n2 2 3 0.06\n";
    std::fs::write(&path, format!("{banner} hermitian\n{entries}")).unwrap();
    let sentence = read(&path).unwrap_err().to_string();
    assert!(sentence.contains("line 3") && sentence.contains("0.04"), "{sentence}");
    std::fs::write(&path, format!("{banner} symmetric\n{entries}")).unwrap();
    assert_eq!(read(&path).unwrap().stiffness.unwrap().values[1], 0.04);
    std::fs::remove_dir_all(folder).unwrap();
}
