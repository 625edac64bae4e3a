//! Malformed matrices and tables of the finite-element example: each is refused by a sentence that
//! names the file and the line or the entry, and nothing is written.

use crate::flags::Flags;
use crate::matrix_market;
use crate::sector::{Sector, Size};
use crate::single;
use std::ffi::OsString;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

fn text_error(text: &str) -> String {
    matrix_market::parse(Path::new("k.mtx"), text.as_bytes()).unwrap_err()
}

/// A file with the right header for `body`.
fn real(symmetry: &str, body: &str) -> String {
    format!("%%MatrixMarket matrix coordinate real {symmetry}\n% a comment\n\n{body}")
}

#[test]
fn a_correct_file_is_read_whatever_its_blanks() {
    let text = "%%matrixmarket MATRIX coordinate Real general\r\n%\n\n 2 3\t2 \n\n2 3 -1.5e-3\n  1 1 +2.\n\n";
    let matrix = matrix_market::parse(Path::new("k.mtx"), text.as_bytes()).unwrap();
    assert_eq!((matrix.rows, matrix.cols, matrix.symmetric), (2, 3, false));
}

#[test]
fn malformed_matrices_are_refused_by_line() {
    let cases = [
        (String::new(), 1, "empty"),
        ("1 2 3\n".into(), 1, "%%MatrixMarket"),
        (
            "%%MatrixMarket matrix coordinate pattern general\n1 1 1\n1 1\n".into(),
            1,
            "'pattern'",
        ),
        (
            "%%MatrixMarket matrix coordinate complex general\n1 1 1\n1 1 1 0\n".into(),
            1,
            "'complex'",
        ),
        (
            "%%MatrixMarket matrix array real general\n1 1\n1\n".into(),
            1,
            "'array'",
        ),
        (
            "%%MatrixMarket vector coordinate real general\n1 1 0\n".into(),
            1,
            "'vector'",
        ),
        (real("hermitian", "1 1 0\n"), 1, "'hermitian'"),
        (real("general", ""), 3, "size line"),
        (real("general", "2 2\n"), 4, "rows columns entries"),
        (real("general", "2 0 0\n"), 4, "number of columns is '0'"),
        (real("general", "2 99999999999 0\n"), 4, "number of columns"),
        (real("general", "2 2 -1\n"), 4, "'-1'"),
        (real("symmetric", "2 3 0\n"), 4, "2 x 3"),
        (real("general", "2 2 1\n3 1 1.0\n"), 5, "row is '3'"),
        (real("general", "2 2 1\n0 1 1.0\n"), 5, "row is '0'"),
        (real("general", "2 2 1\n1 3 1.0\n"), 5, "column is '3'"),
        (real("general", "2 2 1\n1 -2 1.0\n"), 5, "column is '-2'"),
        (real("general", "12 12 1\n11 1.5\n"), 5, "'11 1.5'"),
        (real("general", "2 2 1\n1 1 1.0 0.0\n"), 5, "row column value"),
        (real("general", "2 2 1\n1 1 1.0x\n"), 5, "'1.0x'"),
        (real("general", "2 2 1\n1 1 NaN\n"), 5, "(1, 1) is NaN"),
        (real("general", "2 2 1\n1 1 -inf\n"), 5, "(1, 1) is -inf"),
        (real("general", "2 2 1\n1 1 1e999\n"), 5, "(1, 1) is 1e999"),
        (real("general", "2 2 2\n1 1 1.0\n"), 5, "1 of the 2 entries"),
        (
            real("general", "2 2 1\n1 1 1.0\n\n2 2 1.0\n"),
            7,
            "one more entry than the 1",
        ),
        (real("general", "2 2 2\n1 2 1.0\n1 2 1.0\n"), 6, "line 5 already"),
        (real("symmetric", "2 2 1\n1 2 1.0\n"), 5, "above the diagonal"),
    ];
    for (text, line, part) in cases {
        let error = text_error(&text);
        assert!(error.starts_with(&format!("k.mtx, line {line}: ")), "{text:?}: {error}");
        assert!(error.contains(part), "{text:?}: {error}");
    }
    let error = matrix_market::parse(Path::new("k.mtx"), &b"%%MatrixMarket \xff\n"[..]).unwrap_err();
    assert!(error.starts_with("k.mtx, line 1: cannot be read"), "{error}");
}

/// A folder of its own for one test.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    folder
}

fn gzip(text: &str) -> Vec<u8> {
    let mut encoder = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
    encoder.write_all(text.as_bytes()).unwrap();
    encoder.finish().unwrap()
}

const HEADER: &str = "pair,rom_rim_r,rom_rim_theta,rom_rim_z,rom_ring_r,rom_ring_theta,rom_ring_z,\
                      theta_rad,z_m,kt_N_per_m,kn_N_per_m,mu,N0_uniform_N";
const ROW: &str = "0,0,1,2,3,4,5,0.1,0.02,1e8,2e8,0.3,10";

/// A small sector of six degrees of freedom that is read without complaint.
fn small_sector(name: &str) -> PathBuf {
    let folder = folder(name);
    let diagonal = |value: f64| {
        let entries: Vec<String> = (1..=6).map(|i| format!("{i} {i} {value}\n")).collect();
        real("symmetric", &format!("6 6 6\n{}", entries.concat()))
    };
    let coupling = |value: f64| real("general", &format!("6 6 2\n1 2 {value}\n4 3 {value}\n"));
    for (part, text) in [
        ("K0", diagonal(1e6)),
        ("K1", coupling(-1e4)),
        ("M0", diagonal(1.0)),
        ("M1", coupling(1e-3)),
    ] {
        write_part(&folder, part, &text);
    }
    fs::write(folder.join("contacts.csv"), format!("{HEADER}\n{ROW}\n")).unwrap();
    folder
}

fn write_part(folder: &Path, part: &str, text: &str) {
    fs::write(folder.join(format!("rom_{part}.mtx.gz")), gzip(text)).unwrap();
}

fn sector_error(folder: &Path) -> String {
    Sector::read(folder, Size::Reduced).unwrap_err()
}

#[test]
fn blocks_that_do_not_fit_the_model_are_refused_by_file_and_entry() {
    let folder = small_sector("fe_blocks");
    assert_eq!(Sector::read(&folder, Size::Reduced).unwrap().ndof(), 6);
    for (part, text, expected) in [
        ("K1", real("general", "5 6 0\n"), "stiffness is 5 x 6, needs 6 x 6"),
        ("M0", real("symmetric", "7 7 0\n"), "mass is 7 x 7, needs 6 x 6"),
        ("K0", real("general", "6 6 2\n1 1 1.0\n3 2 5.0\n"), "stiffness[3,2]"),
        ("M0", real("general", "6 6 2\n1 1 1.0\n1 4 5.0\n"), "one triangle"),
        ("M0", real("symmetric", "6 6 1\n3 3 -1.0\n"), "mass[3,3] = -1"),
    ] {
        let folder = small_sector("fe_blocks");
        write_part(&folder, part, &text);
        let error = sector_error(&folder);
        assert!(error.contains(&format!("rom_{part}.mtx.gz: ")), "{error}");
        assert!(error.contains(expected), "{error}");
    }
}

#[test]
fn missing_and_damaged_files_are_refused_by_name() {
    let folder = small_sector("fe_damaged");
    let path = folder.join("rom_M1.mtx.gz");
    let whole = fs::read(&path).unwrap();
    let with = |bytes: &[u8]| {
        fs::write(&path, bytes).unwrap();
        let error = sector_error(&folder);
        assert!(error.contains("rom_M1.mtx.gz, line "), "{error}");
        error
    };
    assert!(with(b"").contains("line 1"));
    assert!(with(b"%%MatrixMarket matrix coordinate real general\n").contains("cannot be read"));
    assert!(with(&whole[..whole.len() / 2]).contains("cannot be read"));
    assert!(with(&whole[..whole.len() - 4]).contains("cannot be read"));
    let mut wrong_sum = whole.clone();
    let at = wrong_sum.len() - 6;
    wrong_sum[at] ^= 1;
    assert!(with(&wrong_sum).contains("cannot be read"));
    assert!(with(&gzip("")).contains("the file is empty"));
    fs::write(&path, &whole).unwrap();
    assert!(Sector::read(&folder, Size::Reduced).is_ok());
    fs::remove_file(&path).unwrap();
    let error = sector_error(&folder);
    assert!(error.contains("rom_M1.mtx.gz: cannot be opened"), "{error}");
}

#[test]
fn malformed_tables_are_refused_by_line_and_column() {
    let folder = small_sector("fe_tables");
    let change = |column: &str, value: &str| {
        let at = HEADER.split(',').position(|c| c == column).unwrap();
        let mut cells: Vec<&str> = ROW.split(',').collect();
        cells[at] = value;
        format!("{HEADER}\n{ROW}\n{}\n", cells.join(","))
    };
    for (text, expected) in [
        (String::new(), ", line 1: the file is empty"),
        (format!("{HEADER}\n"), "no rows"),
        (
            format!("{}\n{ROW}\n", HEADER.replace("mu", "nu")),
            ", line 1: has no column mu",
        ),
        (format!("{HEADER}\n{ROW}\n1,2\n"), ", line 3: has 2 cells, needs 13"),
        (change("kt_N_per_m", "x"), ", line 3: column kt_N_per_m is 'x'"),
        (change("mu", "NaN"), ", line 3: column mu is 'NaN'"),
        (change("mu", "-0.3"), ", line 3: contact: mu = -0.3"),
        (change("N0_uniform_N", "inf"), ", line 3: column N0_uniform_N is 'inf'"),
        (change("kn_N_per_m", ""), ", line 3: column kn_N_per_m is ''"),
        (
            change("rom_ring_z", "6"),
            ", line 3: column rom_ring_z is '6', needs an index 0 .. 5",
        ),
        (change("rom_rim_r", "-1"), ", line 3: column rom_rim_r is '-1'"),
        (
            change("rom_rim_theta", "1.0"),
            ", line 3: column rom_rim_theta is '1.0'",
        ),
        (
            change("rom_ring_theta", "1"),
            ", line 3: rim and ring are both degree of freedom 1",
        ),
    ] {
        fs::write(folder.join("contacts.csv"), &text).unwrap();
        let error = sector_error(&folder);
        assert!(
            error.contains(&format!("contacts.csv{expected}")) || error.contains(expected),
            "{error}"
        );
        assert!(error.contains("contacts.csv"), "{error}");
    }
    fs::remove_file(folder.join("contacts.csv")).unwrap();
    assert!(sector_error(&folder).contains("contacts.csv: cannot be read"));
}

/// Runs the program's one-response mode; what it wrote to the file.
fn respond(arguments: &[&str], json: &Path) -> Result<Option<String>, String> {
    let _ = fs::remove_file(json);
    let mut all: Vec<OsString> = arguments.iter().map(OsString::from).collect();
    all.extend(["--json".into(), json.into()]);
    let flags = Flags::read(all, &single::FLAGS)?;
    let request = single::Request::new(&flags, Path::new("does not exist"))?;
    let mut screen = Vec::new();
    request.run(&mut screen).map_err(|e| e.to_string())?;
    Ok(fs::read_to_string(json).ok())
}

#[test]
fn wrong_flags_and_data_write_nothing() {
    let folder = small_sector("fe_flags");
    let json = folder.join("response.json");
    let data = folder.to_str().unwrap();
    for (arguments, expected) in [
        (vec!["--force"], "--force"),
        (vec!["--force", "-1"], "--force -1"),
        (vec!["--force", "nan"], "--force nan"),
        (vec!["--model", "coarse"], "--model coarse"),
        (vec!["--harmonics", "0"], "--harmonics 0"),
        (vec!["--harmonics", "1.5"], "--harmonics 1.5"),
        (vec!["--from", "0"], "--from 0"),
        (vec!["--from", "560"], "--from"),
        (vec!["--at-hz", "511.9"], "--at-hz 511.9"),
        (vec!["--at-hz", "520", "--at-hz", "inf"], "--at-hz inf"),
        (vec!["--speed", "3000"], "--speed"),
        (vec!["530"], "530"),
        (vec!["--force", "1", "--force", "2"], "twice"),
        (vec!["--from", "520", "--to", "521"], "does not exist"),
        // Six degrees of freedom have no blade tip.
        (vec!["--data", data], "dof = 181"),
    ] {
        let error = respond(&arguments, &json).unwrap_err();
        assert!(error.contains(expected), "{arguments:?}: {error}");
        assert!(!json.exists(), "{arguments:?}");
        assert_eq!(fs::read_dir(&folder).unwrap().count(), 5, "{arguments:?}");
    }
}

#[test]
fn the_file_holds_exactly_what_was_asked_for() {
    let folder = folder("fe_json");
    let data = crate::common::programs::root().join("examples/data/fe");
    let data = data.to_str().unwrap();
    let arguments = "--force 0.2 --harmonics 3 --from 531 --to 529.9 --at-hz 530 --at-hz 530.7";
    let mut arguments: Vec<&str> = arguments.split(' ').collect();
    arguments.extend(["--data", data]);
    let text = respond(&arguments, &folder.join("response.json")).unwrap().unwrap();
    let value: serde_json::Value = serde_json::from_str(&text).unwrap();
    let frequency = |point: &serde_json::Value| point["frequency_hz"].as_f64().unwrap().to_bits();
    let points = value["points"].as_array().unwrap();
    assert_eq!(frequency(&points[0]), 531.0_f64.to_bits());
    assert_eq!(frequency(points.last().unwrap()), 529.9_f64.to_bits());
    let at = value["at"].as_array().unwrap();
    assert_eq!(
        at.iter().map(frequency).collect::<Vec<_>>(),
        [530.0, 530.7].map(f64::to_bits)
    );
    let amplitude = |p: &serde_json::Value| p["amplitude_tip_m"].as_f64().unwrap();
    for p in points.iter().chain(at) {
        assert!(amplitude(p) <= amplitude(&value["peak"]));
        let tip = p["harmonics"]["tip"].as_object().unwrap();
        assert_eq!(tip.keys().collect::<Vec<_>>(), ["1", "3"]);
        let part = |i: usize| tip["1"][i].as_f64().unwrap();
        assert!((part(0).hypot(part(1)) / amplitude(p) - 1.0).abs() < 1e-15);
    }
}
