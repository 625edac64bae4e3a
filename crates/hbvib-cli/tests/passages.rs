//! Lives, run-ups and missions of a job: tables, figures, and refusals.

use crate::common::{command, empty_folder, hbvib, printed, ring_damper};
use std::fs;

fn rows(text: &str) -> Vec<Vec<f64>> {
    let cells = |line: &str| line.split(',').map(|x| x.parse().unwrap()).collect();
    text.lines().skip(1).map(cells).collect()
}

#[test]
fn a_mission_of_a_wheel_passes_its_resonance_twice() {
    let job = format!(
        "{}[[contact]]\nkind = 'jenkins'\na = [2]\nb = [3]\nkt = 5e7\nmu = 0.3\npreload = 488.5454178539233\n\
         [[force]]\ndof = 0\nvalue = 5.0\n[[force]]\ndof = 1\nvalue = 5.0\n[mission]\n\
         mode = {{ log10_from = -6.0, log10_to = -2.0, harmonics = 3, response_dof = 0 }}\n\
         seconds = [0, 600, 1200]\nrpm = [6200, 6330, 6200]\nengine_order = 2\nedges = [1e-4, 1e-3]\nstresses = [1e4]\n\
         woehler = {{ stress = 1.0, cycles = 2e6, slope = 5.0 }}\ncsv = 'm.csv'\nspectrum_csv = 's.csv'\nfigure = 'm.svg'\n",
        ring_damper()
    );
    let (output, folder) = hbvib("run", ("passages", "wheel"), &job);
    let text = printed(&output.stdout);
    assert!(output.status.success(), "{text}{}", printed(&output.stderr));
    assert!(
        text.contains("mission: 2 passages") && text.contains("sum of Miner of stress 0"),
        "{text}"
    );
    let passages = rows(&fs::read_to_string(folder.join("m.csv")).unwrap());
    assert_eq!(passages.len(), 2);
    for row in &passages {
        // So slow a passage is nearly steady.
        assert!((row[4] - 1.0).abs() < 0.05 && row[5] > 10.0, "{row:?}");
    }
    let cycles: f64 = rows(&fs::read_to_string(folder.join("s.csv")).unwrap())
        .iter()
        .map(|row| row[2])
        .sum();
    let all = 2.0 * 6265.0 / 60.0 * 1200.0;
    assert!((cycles / all - 1.0).abs() < 1e-9, "{cycles} is not {all}");
    assert!(fs::read_to_string(folder.join("m.svg")).unwrap().contains("<polyline"));
}

#[test]
fn a_run_up_of_a_plain_model_stays_below_its_resonance() {
    let folder = empty_folder("passages", "plain");
    for (name, value) in [("k", 3947.84), ("m", 1.0), ("c", 1.2566)] {
        let text = format!("%%MatrixMarket matrix array real general\n1 1\n{value}\n");
        fs::write(folder.join(format!("{name}.mtx")), text).unwrap();
    }
    let job = "[model]\nstiffness = 'k.mtx'\nmass = 'm.mtx'\ndamping = 'c.mtx'\n[[contact]]\nkind = 'jenkins'\na = [0]\nkt = 790.0\n\
               mu = 0.1\npreload = 4000.0\n[[force]]\ndof = 0\nvalue = 480.0\n[run_up]\nfrom_hz = 8.0\nto_hz = 13.0\nhz_per_s = 0.6\n\
               mode = { log10_from = -2.0, log10_to = 0.8, harmonics = 3 }\ncsv = 'u.csv'\nfigure = 'u.svg'\n";
    fs::write(folder.join("job.toml"), job).unwrap();
    let output = command(&["run", "job.toml"], &folder);
    let text = printed(&output.stdout);
    assert!(output.status.success(), "{text}{}", printed(&output.stderr));
    assert!(
        text.contains("run-up: ") && text.contains(" of the steady resonance"),
        "{text}"
    );
    let turns = rows(&fs::read_to_string(folder.join("u.csv")).unwrap());
    assert_eq!(turns.len(), 88);
    assert!(fs::read_to_string(folder.join("u.svg")).unwrap().contains("<polyline"));
    // The same model wears at one frequency.
    let (model, _) = job.split_once("[run_up]").unwrap();
    let life = format!(
        "{model}[life]\ncontacts = [0]\nrate = 0.01\nstiffness = 100.0\ncycles = [0, 5]\nhz = 10.5\nharmonics = 3\ncsv = 'l.csv'\n\
         figure = 'l.svg'\n"
    );
    fs::write(folder.join("job.toml"), &life).unwrap();
    let output = command(&["run", "job.toml"], &folder);
    let text = printed(&output.stdout);
    assert!(output.status.success(), "{text}{}", printed(&output.stderr));
    assert!(text.contains("life of 1 contact"), "{text}");
    let states = rows(&fs::read_to_string(folder.join("l.csv")).unwrap());
    assert!(
        states.len() == 2 && (states[0][4] - 4000.0).abs() < 1e-9 && states[1][4] < 4000.0 && states[1][3] > 0.0,
        "{states:?}"
    );
    // N = N₀ − S h
    assert!((states[1][4] - (4000.0 - 100.0 * states[1][3])).abs() < 1e-6);
    assert!(fs::read_to_string(folder.join("l.svg")).unwrap().contains("<polyline"));
    // A contact without a name has its number from 1; the life is the same to the bit.
    fs::write(
        folder.join("job.toml"),
        life.replace("contacts = [0]", "contacts = ['1']")
            .replace("l.csv", "n.csv"),
    )
    .unwrap();
    let output = command(&["run", "job.toml"], &folder);
    assert!(output.status.success(), "{}", printed(&output.stderr));
    let by_name = fs::read_to_string(folder.join("n.csv")).unwrap();
    assert_eq!(by_name, fs::read_to_string(folder.join("l.csv")).unwrap());
    for (contacts, words) in [
        ("['blade']", "\"blade\" is none of 1"),
        ("[1]", "1, but the model has 1 contact"),
    ] {
        fs::write(
            folder.join("job.toml"),
            life.replace("contacts = [0]", &format!("contacts = {contacts}")),
        )
        .unwrap();
        let output = command(&["run", "job.toml"], &folder);
        assert!(
            !output.status.success() && printed(&output.stderr).contains(words),
            "{}",
            printed(&output.stderr)
        );
    }
    fs::write(folder.join("job.toml"), life.replace("hz = 10.5", "from_hz = 10.5")).unwrap();
    let output = command(&["run", "job.toml"], &folder);
    assert!(!output.status.success() && printed(&output.stderr).contains("[life]"));
    fs::write(folder.join("job.toml"), job.replace("hz_per_s = 0.6", "hz_per_s = 0.0")).unwrap();
    let output = command(&["run", "job.toml"], &folder);
    assert!(!output.status.success() && printed(&output.stderr).contains("[run_up]: rate = 0"));
}
