//! Real pairs of matrices pass `check --strict` without a warning, and each damage to one of them is refused or told: cut, exchanged,
//! shuffled, of another model, scaled, with a row removed, an entry of the wrong sign, and so on.

use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Entries of one triangle: row, column from 0, and value.
type Entries = Vec<(usize, usize, f64)>;

/// A pair of matrices with the rows' names.
#[derive(Clone)]
struct Pair {
    stiffness: Entries,
    mass: Entries,
    /// Node and direction of each row; empty for files without names.
    dofs: Vec<(i64, i64)>,
    rows: [usize; 2],
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Format {
    MatrixMarket,
    CalculiX,
    Abaqus,
}

fn data() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data")
}

fn numbers(line: &str) -> Option<(usize, usize, f64)> {
    let mut words = line.split_whitespace();
    let index = |word: Option<&str>| word?.parse::<usize>().ok();
    Some((
        index(words.next())? - 1,
        index(words.next())? - 1,
        words.next()?.parse().ok()?,
    ))
}

fn entries(path: &Path, skipped: usize) -> Entries {
    let text = std::fs::read_to_string(path).unwrap();
    text.lines()
        .skip(skipped)
        .filter_map(numbers)
        .map(|(i, j, v)| (i.max(j), i.min(j), v))
        .collect()
}

fn of_calculix(name: &str) -> Pair {
    let at = |extension: &str| data().join(name).with_extension(extension);
    let dofs: Vec<(i64, i64)> = std::fs::read_to_string(at("dof"))
        .unwrap()
        .lines()
        .map(|line| line.trim().split_once('.').unwrap())
        .map(|(node, direction)| (node.parse().unwrap(), direction.parse().unwrap()))
        .collect();
    let n = dofs.len();
    Pair {
        stiffness: entries(&at("sti"), 0),
        mass: entries(&at("mas"), 0),
        dofs,
        rows: [n, n],
    }
}

fn of_sector() -> Pair {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/data/boundary_sector");
    Pair {
        stiffness: entries(&folder.join("sector_K.mtx"), 3),
        mass: entries(&folder.join("sector_M.mtx"), 3),
        dofs: Vec::new(),
        rows: [108, 108],
    }
}

/// Texts of stiffness, mass, and names of rows.
fn texts(pair: &Pair, format: Format) -> [String; 3] {
    let matrix = |entries: &Entries, rows: usize| {
        let mut text = String::new();
        if format == Format::MatrixMarket {
            let _ = writeln!(
                text,
                "%%MatrixMarket matrix coordinate real symmetric\n{rows} {rows} {}",
                entries.len()
            );
        }
        for (i, j, v) in entries {
            let _ = match format {
                Format::MatrixMarket => writeln!(text, "{} {} {v:e}", i + 1, j + 1),
                Format::CalculiX => writeln!(text, "{} {} {v:e}", j + 1, i + 1),
                Format::Abaqus => {
                    let (a, b) = (pair.dofs[*i], pair.dofs[*j]);
                    writeln!(text, "{},{}, {},{}, {v:e}", a.0, a.1, b.0, b.1)
                }
            };
        }
        text
    };
    let mut names = String::new();
    for (node, direction) in &pair.dofs {
        let _ = writeln!(names, "{node}.{direction}");
    }
    [
        matrix(&pair.stiffness, pair.rows[0]),
        matrix(&pair.mass, pair.rows[1]),
        names,
    ]
}

/// Output of `check --strict`, and whether it passed.
fn checked(name: &str, format: Format, texts: &[String; 3], expected: &str) -> (bool, String) {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("mutations").join(name);
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    let write = |name: &str, text: &str| std::fs::write(folder.join(name), text).unwrap();
    let files = match format {
        Format::MatrixMarket => ["k.mtx", "m.mtx"],
        Format::CalculiX => ["job.sti", "job.mas"],
        Format::Abaqus => ["job_STIF1.mtx", "job_MASS1.mtx"],
    };
    write(files[0], &texts[0]);
    write(files[1], &texts[1]);
    let model = if format == Format::CalculiX {
        write("job.dof", &texts[2]);
        "matrices = 'job.sti'\n".into()
    } else {
        format!("stiffness = '{}'\nmass = '{}'\n", files[0], files[1])
    };
    write(
        "job.toml",
        &format!("[model]\n{model}{expected}\n[[force]]\ndof = 0\nvalue = 1.0\n[forced]\nfrom_hz = 1.0\nto_hz = 2.0\n"),
    );
    let output = Command::new(env!("CARGO_BIN_EXE_hbvib"))
        .args(["check", "--strict"])
        .arg(folder.join("job.toml"))
        .output()
        .unwrap();
    let text = String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr);
    (output.status.success(), text)
}

/// Numbers without structure.
struct Random(u64);

impl Random {
    fn below(&mut self, n: usize) -> usize {
        // xorshift (Marsaglia 2003, doi:10.18637/jss.v008.i14)
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 % n as u64) as usize
    }

    fn order(&mut self, n: usize) -> Vec<usize> {
        let mut order: Vec<usize> = (0..n).collect();
        for i in (1..n).rev() {
            order.swap(i, self.below(i + 1));
        }
        order
    }

    /// An entry off the diagonal that is no rounding, of a row that is not next to a support: forces there are those of the
    /// support, which no file has.
    fn off_diagonal(&mut self, entries: &Entries, is_held: &[bool]) -> usize {
        let largest = entries
            .iter()
            .filter(|e| e.0 != e.1)
            .fold(0.0_f64, |m, e| m.max(e.2.abs()));
        loop {
            let k = self.below(entries.len());
            let (i, j, v) = entries[k];
            if i != j && v.abs() > 1e-3 * largest && !(is_held[i] && is_held[j]) {
                return k;
            }
        }
    }

    fn diagonal(&mut self, entries: &Entries) -> usize {
        loop {
            let k = self.below(entries.len());
            if entries[k].0 == entries[k].1 {
                return k;
            }
        }
    }
}

fn permuted(entries: &Entries, to: impl Fn(usize) -> usize) -> Entries {
    entries
        .iter()
        .map(|&(i, j, v)| (to(i).max(to(j)), to(i).min(to(j)), v))
        .collect()
}

fn swapped(entries: &Entries, a: usize, b: usize) -> Entries {
    permuted(entries, |i| {
        if i == a {
            b
        } else if i == b {
            a
        } else {
            i
        }
    })
}

fn without_row(entries: &Entries, row: usize) -> Entries {
    let kept = entries.iter().filter(|e| e.0 != row && e.1 != row);
    kept.map(|&(i, j, v)| (i - usize::from(i > row), j - usize::from(j > row), v))
        .collect()
}

/// Rows in which a translation meets force.
fn held(pair: &Pair) -> Vec<bool> {
    let mut force = vec![[0.0; 3]; pair.rows[0]];
    let mut size = vec![0.0_f64; pair.rows[0]];
    for &(i, j, v) in &pair.stiffness {
        let both = [(i, j), (j, i)];
        for &(row, column) in &both[..if i == j { 1 } else { 2 }] {
            force[row][column % 3] += v;
            size[row] = size[row].max(v.abs());
        }
    }
    let is_held = |(force, size): (&[f64; 3], &f64)| force.iter().any(|f| f.abs() > 1e-6 * size);
    force.iter().zip(&size).map(is_held).collect()
}

/// Damaged pairs by name.
fn damaged(pair: &Pair, random: &mut Random) -> Vec<(String, Pair)> {
    let n = pair.rows[0];
    let is_held = held(pair);
    let mut all = Vec::new();
    let mut add = |name: &str, change: &mut dyn FnMut(&mut Pair)| {
        let mut other = pair.clone();
        change(&mut other);
        all.push((name.to_owned(), other));
    };
    add("exchanged", &mut |p| std::mem::swap(&mut p.stiffness, &mut p.mass));
    add("negative mass", &mut |p| p.mass.iter_mut().for_each(|e| e.2 = -e.2));
    add("negative stiffness", &mut |p| {
        p.stiffness.iter_mut().for_each(|e| e.2 = -e.2);
    });
    for round in 0..3 {
        // Two nodes, and a direction of each. Rows of one direction of nodes with the same neighbours keep all rigid motions and
        // all couplings of nodes when they are exchanged, and no check can tell.
        let neighbours = |a: usize| -> BTreeSet<usize> {
            let touching = pair
                .mass
                .iter()
                .filter(|e| e.2 != 0.0 && (e.0 / 3 == a || e.1 / 3 == a));
            touching.flat_map(|e| [e.0 / 3, e.1 / 3]).collect()
        };
        let a = random.below(n / 3);
        let b = loop {
            let b = random.below(n / 3);
            if neighbours(a) != neighbours(b) {
                break b;
            }
        };
        let (d, e) = (random.below(3), random.below(3));
        for (of, is_mass) in [("stiffness", false), ("mass", true)] {
            let mut change = |what: &str, change: &mut dyn FnMut(&mut Entries)| {
                add(&format!("{of} {what} {round}"), &mut |p| {
                    change(if is_mass { &mut p.mass } else { &mut p.stiffness });
                });
            };
            change("rows swapped", &mut |m| *m = swapped(m, 3 * a + d, 3 * b + e));
            change("rows of one direction swapped", &mut |m| {
                *m = swapped(m, 3 * a + d, 3 * b + d);
            });
            let order = random.order(n);
            change("shuffled", &mut |m| *m = permuted(m, |i| order[i]));
            let (off, on) = (
                random.off_diagonal(if is_mass { &pair.mass } else { &pair.stiffness }, &is_held),
                random.diagonal(if is_mass { &pair.mass } else { &pair.stiffness }),
            );
            change("sign off the diagonal", &mut |m| m[off].2 = -m[off].2);
            change("sign on the diagonal", &mut |m| m[on].2 = -m[on].2);
            change("entry missing", &mut |m| {
                m.remove(off);
            });
            change("diagonal missing", &mut |m| {
                m.remove(on);
            });
            change("entry times ten", &mut |m| m[off].2 *= 10.0);
            change("entry twice", &mut |m| m.push(m[off]));
            change("cut", &mut |m| m.truncate(m.len() * (3 + round) / 7));
        }
    }
    add("row of the stiffness removed", &mut |p| {
        p.stiffness = without_row(&p.stiffness, 7);
        p.rows[0] = n - 1;
    });
    add("row of the mass removed", &mut |p| {
        p.mass = without_row(&p.mass, 7);
        p.rows[1] = n - 1;
    });
    add("row of the stiffness empty", &mut |p| {
        p.stiffness.retain(|e| e.0 != 7 && e.1 != 7);
    });
    add("row of the mass empty", &mut |p| {
        p.mass.retain(|e| e.0 != 7 && e.1 != 7);
    });
    if !pair.dofs.is_empty() {
        add("names reversed", &mut |p| p.dofs.reverse());
        let order = random.order(n);
        add("names shuffled", &mut |p| {
            p.dofs = order.iter().map(|&i| p.dofs[i]).collect();
        });
        add("two names swapped", &mut |p| p.dofs.swap(4, 13));
        add("a name missing", &mut |p| {
            p.dofs.remove(5);
        });
    }
    all
}

/// Total mass and first frequency that a check tells.
fn told(text: &str) -> (f64, f64) {
    let number = |start: &str, end: &str| -> f64 {
        let from = text.find(start).unwrap() + start.len();
        let to = text[from..].find(end).unwrap();
        text[from..from + to].parse().unwrap()
    };
    (number("three rows: ", " along x"), number("without contacts: ", ","))
}

fn run(name: &str, pair: &Pair, format: Format) {
    let mesh = if pair.dofs.is_empty() {
        String::new()
    } else {
        format!("mesh = '{}'\n", data().join(name).with_extension("inp").display())
    };
    let (passed, text) = checked(name, format, &texts(pair, format), &mesh);
    assert!(passed && !text.contains("warning"), "{name}: {text}");
    let (mass, hertz) = told(&text);
    // Of a free sector the first frequency is rounding.
    let first = if hertz > 1.0 {
        format!(", first_hz = {hertz}")
    } else {
        String::new()
    };
    let expected = format!("{mesh}expected = {{ total_mass = {mass}{first} }}");
    let (passed, text) = checked(name, format, &texts(pair, format), &expected);
    assert!(passed, "{name}: {text}");
    let mut random = Random(0x9e37_79b9_7f4a_7c15);
    let mut silent = Vec::new();
    let mut count = 0;
    let mut judge = |damage: &str, texts: &[String; 3], expected: &str| {
        count += 1;
        let (passed, text) = checked(name, format, texts, expected);
        if passed {
            silent.push(damage.to_owned());
        } else {
            assert!(
                text.contains("warning: ") || text.contains("hbvib: "),
                "{damage}: {text}"
            );
            assert!(!text.contains("panicked"), "{damage}: {text}");
        }
    };
    for (damage, other) in damaged(pair, &mut random) {
        if format == Format::Abaqus && (damage == "a name missing" || other.rows != pair.rows) {
            continue;
        }
        let texts_of = texts(&other, format);
        judge(&damage, &texts_of, &mesh);
    }
    let scaled = |k: f64, m: f64| {
        let mut other = pair.clone();
        other.stiffness.iter_mut().for_each(|e| e.2 *= k);
        other.mass.iter_mut().for_each(|e| e.2 *= m);
        texts(&other, format)
    };
    judge("mass in grams", &scaled(1.0, 1e3), &expected);
    judge(
        "mass in tonnes and stiffness per millimetre",
        &scaled(1e-3, 1e-3),
        &expected,
    );
    if hertz > 1.0 {
        judge("stiffness per millimetre", &scaled(1e-3, 1.0), &expected);
    }
    if format == Format::MatrixMarket {
        let mut without = texts(pair, format);
        without[0] = without[0][without[0].find('\n').unwrap() + 1..].to_string();
        judge("no banner", &without, &mesh);
    }
    let mut words = texts(pair, format);
    words[1] = words[1].replacen("e-", "e+", 1).replacen('5', "x", 1);
    judge("letters", &words, &mesh);
    assert!(
        count >= 10 && silent.is_empty(),
        "{name}: {} of {count} pass: {silent:?}",
        silent.len()
    );
    println!("{name}: {count} damages, all told");
}

#[test]
fn damage_to_a_sector_in_matrix_market_files_is_told() {
    run("sector", &of_sector(), Format::MatrixMarket);
}

#[test]
fn damage_to_a_beam_of_bricks_in_calculix_files_is_told() {
    run("beam", &of_calculix("beam"), Format::CalculiX);
}

#[test]
fn damage_to_a_block_of_tetrahedra_in_abaqus_files_is_told() {
    run("block", &of_calculix("block"), Format::Abaqus);
}

#[test]
fn the_mass_of_another_model_of_as_many_rows_is_told() {
    let mut pair = of_calculix("block");
    pair.mass = entries(&data().join("block_other.mas"), 0);
    for (name, format) in [("other_calculix", Format::CalculiX), ("other_abaqus", Format::Abaqus)] {
        let (passed, text) = checked(name, format, &texts(&pair, format), "");
        assert!(!passed && text.contains("warning: "), "{text}");
    }
}
