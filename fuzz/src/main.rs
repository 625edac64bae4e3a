//! Mutations of good input without a guide: bytes, bits, numbers, lines and parts are changed, removed, repeated and
//! exchanged. Run in this folder as: mutate <seed> <executions a target> [target]. Prints counts; a panic or an
//! execution of more than a second ends it. As: mutate corpus <folder>, it writes the good input to a folder for each target.

use hbvib::{Contact, MatrixKind, MatrixView, Model, Part, Storage, Values};
use std::fs;
use std::path::Path;
use std::process::ExitCode;
use std::time::Instant;

struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15); // splitmix64
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    fn below(&mut self, n: usize) -> usize {
        (self.next() % n.max(1) as u64) as usize
    }
}

/// Words that stand for the ends of ranges, or mean something to a reader.
const WORDS: [&[u8]; 14] = [
    b"-1",
    b"0",
    b"1e308",
    b"nan",
    b"99999999999999999999",
    b"2147483648",
    b"\n",
    b"\r\n",
    b",",
    b"=",
    b"[[contact]]",
    b"*",
    b"%",
    b"\"",
];

/// Changes input in one to four places.
fn mutate(data: &mut Vec<u8>, other: &[u8], random: &mut Random) {
    for _ in 0..=random.below(4) {
        let at = random.below(data.len() + 1).min(data.len());
        let len = random.below(16).min(data.len() - at);
        match random.below(9) {
            0 if at < data.len() => data[at] ^= 1 << random.below(8),
            1 if at < data.len() => data[at] = random.next() as u8,
            2 => drop(data.drain(at..at + len)),
            3 => {
                let part = data[at..at + len].to_vec();
                let to = random.below(data.len() + 1).min(data.len());
                drop(data.splice(to..to, part));
            }
            4 => data.truncate(at),
            5 => {
                let word = WORDS[random.below(WORDS.len())];
                drop(data.splice(at..at + len, word.iter().copied()));
            }
            6 if at + 8 <= data.len() => {
                let extreme = [
                    0,
                    1,
                    u64::MAX,
                    1 << 63,
                    1 << 32,
                    f64::NAN.to_bits(),
                    1e300_f64.to_bits(),
                ];
                data[at..at + 8].copy_from_slice(&extreme[random.below(7)].to_le_bytes());
            }
            7 => {
                let from = random.below(other.len() + 1).min(other.len());
                let part = &other[from..(from + random.below(64)).min(other.len())];
                drop(data.splice(at..at + len, part.iter().copied()));
            }
            _ => {
                // The line at this place, once more or away.
                let begin = data[..at].iter().rposition(|&b| b == b'\n').map_or(0, |i| i + 1);
                let end = data[at..]
                    .iter()
                    .position(|&b| b == b'\n')
                    .map_or(data.len(), |i| at + i + 1);
                if random.below(2) == 0 {
                    drop(data.drain(begin..end));
                } else {
                    let line = data[begin..end].to_vec();
                    drop(data.splice(end..end, line));
                }
            }
        }
        data.truncate(1 << 14);
    }
}

/// A saved model with matrices, contacts and forces.
fn model(sectors: usize) -> Vec<u8> {
    let values = [2.0, -1.0, 0.0, -1.0, 2.0, -1.0, 0.0, -1.0, 2.0];
    let view = |values| MatrixView {
        rows: 3,
        cols: 3,
        storage: Storage::ColMajor { ld: 3 },
        values: Values::Real(values),
        part: Part::Full,
        index_base: 0,
    };
    let mut model = if sectors > 1 {
        Model::cyclic(3, sectors)
    } else {
        Model::new(3)
    }
    .expect("a model");
    for kind in [MatrixKind::Mass, MatrixKind::Stiffness, MatrixKind::Damping] {
        model.set_matrix(kind, &view(&values)).expect("a matrix");
    }
    model
        .add_contact(&Contact::jenkins(0, Some(1), 1.0, 0.3, 2.0))
        .expect("a contact");
    model
        .add_contact(&Contact::unilateral(Some(2), None, 1.0, 0.1))
        .expect("a contact");
    model
        .add_force(0, 1, num_complex::Complex64::new(1.0, 0.5))
        .expect("a force");
    model.save().expect("bytes")
}

/// All files below a folder whose names end so, none above 16 kB.
fn files(folder: &Path, endings: &[&str]) -> Vec<Vec<u8>> {
    let mut found = Vec::new();
    let Ok(entries) = fs::read_dir(folder) else {
        return found;
    };
    let mut paths: Vec<_> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
    paths.sort();
    for path in paths {
        if path.is_dir() {
            found.extend(files(&path, endings));
        } else if endings.iter().any(|ending| path.to_string_lossy().ends_with(ending))
            && let Ok(bytes) = fs::read(&path)
            && bytes.len() <= 1 << 14
        {
            found.push(bytes);
        }
    }
    found
}

/// Superelements of a small job in the formats of a name that are written.
fn written(ending: &str) -> Vec<Vec<u8>> {
    let job = Path::new("../crates/hbvib-io/tests/data/sector.sti");
    let found = hbvib_io::read(job).expect("a job");
    let formats = hbvib_io::Format::NAMES;
    let path = std::env::temp_dir().join(format!("hbvib-fuzz-{}{ending}", std::process::id()));
    let own = formats
        .into_iter()
        .filter(|(_, format)| hbvib_io::Format::of_path(&path) == Some(*format));
    let mut all = Vec::new();
    for (_, format) in own {
        for path in hbvib_io::write(&path, &found, format).expect("files") {
            all.push(fs::read(&path).expect("a file"));
            let _ = fs::remove_file(path);
        }
    }
    all.retain(|bytes| bytes.len() <= 1 << 14);
    all
}

type Target = (&'static str, fn(&[u8]) -> bool, Vec<Vec<u8>>);

fn targets() -> Vec<Target> {
    let data = Path::new("../crates/hbvib-io/tests/data");
    let mut element_files = Vec::new();
    let endings = [
        ".mtx",
        ".op4",
        "a",
        "STIF1.mtx",
        ".gz",
        ".npz",
        ".mat",
        ".full",
        ".pch",
        ".inp",
        ".uff",
    ];
    for (format, ending) in endings.iter().enumerate() {
        let mut found = files(data, &[ending]);
        found.extend(written(ending));
        for mut bytes in found {
            bytes.insert(0, format as u8);
            element_files.push(bytes);
        }
    }
    let of_job =
        ["dof", "sti", "mas"].map(|extension| fs::read(data.join(format!("sector.{extension}"))).expect("a file"));
    element_files.push([&[hbvib_fuzz::NAMES.len() as u8], &of_job.join(&0)[..]].concat());
    let mut jobs = files(Path::new("../examples/jobs"), &[".toml", ".inp"]);
    jobs.extend(files(data, &[".inp"]));
    let matrices = (0..40_u8)
        .map(|k| vec![k, k / 3, k / 5, k / 2, 7, 0, 9, 1, 2, 3, 1, 2, 3, 64, 80, 64])
        .collect();
    vec![
        ("matrix", hbvib_fuzz::matrix, matrices),
        ("saved_model", hbvib_fuzz::saved_model, vec![model(1), model(5)]),
        ("job", hbvib_fuzz::job, jobs),
        ("element_files", hbvib_fuzz::element_files, element_files),
    ]
}

/// Writes the input of each target to a folder of its name.
fn write_corpus(folder: &Path) -> std::io::Result<()> {
    for (name, _, seeds) in targets() {
        let folder = folder.join(name);
        fs::create_dir_all(&folder)?;
        for (number, bytes) in seeds.iter().enumerate() {
            fs::write(folder.join(format!("seed_{number}")), bytes)?;
        }
    }
    Ok(())
}

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().collect();
    if let [_, what, folder] = &arguments[..]
        && what == "corpus"
    {
        return match write_corpus(Path::new(folder)) {
            Ok(()) => ExitCode::SUCCESS,
            Err(e) => {
                eprintln!("{folder}: {e}");
                ExitCode::FAILURE
            }
        };
    }
    let [seed, executions] = [1, 2].map(|k| arguments.get(k).and_then(|number| number.parse::<u64>().ok()));
    let (Some(seed), Some(executions)) = (seed, executions) else {
        eprintln!("usage: mutate <seed> <executions a target> [target], or mutate corpus <folder>");
        return ExitCode::FAILURE;
    };
    for (name, run, seeds) in targets() {
        if arguments.get(3).is_some_and(|only| only != name) {
            continue;
        }
        assert!(
            !seeds.is_empty(),
            "{name} has no input to begin with; run it in the folder fuzz"
        );
        let mut random = Random(seed);
        let (mut accepted, mut longest) = (0_u64, 0.0_f64);
        // Accepted input is changed further.
        let mut kept = seeds.clone();
        for _ in 0..executions {
            let from = random.below(kept.len());
            let other = random.below(seeds.len());
            let mut data = kept[from].clone();
            mutate(&mut data, &seeds[other], &mut random);
            let begin = Instant::now();
            let is_accepted = run(&data);
            longest = longest.max(begin.elapsed().as_secs_f64());
            if longest > 1.0 {
                fs::write("slow_input", &data).expect("a file");
                eprintln!("{name}: an input took {longest:.1} s, see slow_input");
                return ExitCode::FAILURE;
            }
            accepted += u64::from(is_accepted);
            if is_accepted && random.below(20) == 0 {
                if kept.len() < 1000 {
                    kept.push(data);
                } else {
                    let place = seeds.len() + random.below(kept.len() - seeds.len());
                    kept[place] = data;
                }
            }
        }
        println!("{name}: {executions} inputs, {accepted} accepted, {longest:.3} s the longest");
    }
    ExitCode::SUCCESS
}
