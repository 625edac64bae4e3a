//! Matrices under the loads of a static step of CalculiX: natural frequencies are those of CalculiX with the same stresses, contacts have
//! its pressures and gaps, and the stiffness over speed is that between two speeds.

use crate::common::{command, empty_folder, printed, root, run};
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;

fn done(arguments: &[&str], folder: &Path) -> String {
    run(env!("CARGO_BIN_EXE_hbvib"), arguments, folder)
}

/// Frequencies by diameter, without contacts and with stuck ones.
fn modes(job: &str, folder: &Path) -> BTreeMap<usize, Vec<[f64; 2]>> {
    let mut found: BTreeMap<usize, Vec<[f64; 2]>> = BTreeMap::new();
    for line in done(&["modes", job], folder).lines().skip(1) {
        let row: Vec<f64> = line.split(',').map(|word| word.parse().unwrap()).collect();
        found.entry(row[0] as usize).or_default().push([row[2], row[3]]);
    }
    found
}

/// Frequencies that CalculiX prints, with the numbers before them.
fn of_calculix(file: &Path) -> Vec<(Vec<usize>, f64)> {
    let text = std::fs::read_to_string(file).unwrap();
    let rows = text.lines().map(|line| line.split_whitespace().collect::<Vec<_>>());
    let found = rows.filter_map(|row| {
        let numbers: Vec<usize> = row.iter().map_while(|word| word.parse().ok()).collect();
        let values = &row[numbers.len()..];
        let is_one = !numbers.is_empty() && values.len() == 4 && values.iter().all(|word| word.contains("E+"));
        is_one.then(|| (numbers, values[2].parse().unwrap()))
    });
    found.collect()
}

fn wheel(name: &str) -> std::path::PathBuf {
    let folder = empty_folder("prestressed_models", name);
    for file in ["mesh.py", "rotating.inp", "rotating.toml"] {
        std::fs::copy(root().join("examples/jobs/cover_plate").join(file), folder.join(file)).unwrap();
    }
    // Fewer elements and sectors than in the example.
    for (file, changes) in [
        (
            "mesh.py",
            &[
                ("[0.0, 0.01, 0.02]", "[0.0, 0.02]"),
                ("bodies[0][10, j, 4]", "bodies[0][10, j, 2]"),
                ("SECTORS = 24", "SECTORS = 8"),
            ][..],
        ),
        ("rotating.inp", &[("N=24", "N=8")]),
        ("rotating.toml", &[("sectors = 24", "sectors = 8")]),
    ] {
        let mut text = std::fs::read_to_string(folder.join(file)).unwrap();
        for (from, to) in changes {
            assert!(text.contains(from), "{file} lacks {from}");
            text = text.replace(from, to);
        }
        std::fs::write(folder.join(file), text).unwrap();
    }
    run("python3", &["mesh.py"], &folder);
    folder
}

#[test]
fn a_rotating_wheel_has_the_frequencies_of_calculix_under_the_same_stresses() {
    let folder = wheel("wheel");
    run("ccx", &["rotating"], &folder);
    let text = done(&["prestress", "rotating.inp"], &folder);
    assert!(text.contains("made rotating_prestressed.sti"), "{text}");
    let faces = "[model.faces]\nleft = 'LEFT'\nright = 'RIGHT'\n";
    let job = format!(
        "[model]\nmatrices = 'rotating_prestressed.sti'\nmesh = 'rotating.inp'\nprestressed = true\nsectors = 8\nengine_order = 3\n{faces}"
    );
    std::fs::write(folder.join("stressed.toml"), &job).unwrap();
    let own = modes("stressed.toml", &folder);
    let theirs = of_calculix(&folder.join("rotating.dat"));
    assert_eq!(theirs.len(), 50);
    for (numbers, hertz) in theirs {
        let [diameter, mode] = numbers[..] else {
            panic!("{numbers:?}")
        };
        let gap = own[&diameter][(mode - 1) / 2][0] / hertz - 1.0;
        assert!(gap.abs() < 6e-7, "diameter {diameter}, mode {mode}: {gap:e}");
    }
    let text = done(&["check", "--strict", "stressed.toml"], &folder);
    assert!(!text.contains("warning"), "{text}");
    // Rotations meet forces of the stresses, which the key tells.
    std::fs::write(folder.join("stressed.toml"), job.replace("prestressed = true\n", "")).unwrap();
    let errors = printed(&command(&["check", "--strict", "stressed.toml"], &folder).stderr);
    assert!(errors.contains("which --strict refuses"), "{errors}");
    // Another speed between two others: the stiffness is that of the squares but for changes of the shape.
    for (speed, file) in [("600", "at_600.sti"), ("1200", "at_1200.sti")] {
        done(
            &["prestress", "rotating.inp", "--speed", speed, "--output", file],
            &folder,
        );
    }
    let between = modes("rotating.toml", &folder);
    let mut worst = 0.0_f64;
    for (diameter, all) in &own {
        for (a, b) in all.iter().zip(&between[diameter]) {
            worst = worst.max((a[0] / b[0] - 1.0).abs());
        }
    }
    assert!(worst < 1e-5, "{worst:e}");
    mistakes(&folder);
}

fn mistakes(folder: &Path) {
    let job = std::fs::read_to_string(folder.join("rotating.toml")).unwrap();
    for (from, to, words) in [
        ("speed = 600.0", "speed = -1200.0", "needs two of other magnitudes"),
        ("at_600.sti", "none.sti", "none."),
        ("\nspeed = 1000.0", "", "needs the speed of the model"),
        (
            "\nspeed = 1000.0",
            "\nspeed = 1.0\nstiffness_speed2 = 'a.mtx'",
            "takes the place of stiffness_speed2",
        ),
        (
            "[[model.at_speed]]\nspeed = 1200.0\nmatrices = \"at_1200.sti\"\n",
            "",
            "has 1 speeds, needs two",
        ),
    ] {
        assert!(job.contains(from), "{from}");
        std::fs::write(folder.join("wrong.toml"), job.replace(from, to)).unwrap();
        let errors = printed(&command(&["check", "wrong.toml"], folder).stderr);
        assert!(
            errors.contains("[[model.at_speed]]: ") && errors.contains(words),
            "{errors}"
        );
    }
    let deck = std::fs::read_to_string(folder.join("rotating.inp")).unwrap();
    for (from, to, more, words) in [
        ("*STATIC", "*DYNAMIC", &[][..], "has no step with *STATIC"),
        ("CENTRIF", "GRAV", &["--speed", "1"], "has no CENTRIF load"),
        (
            "*BOUNDARY",
            "*TRANSFORM, NSET=ALL\n1,0,0,0,1,0\n*BOUNDARY",
            &[],
            "has *TRANSFORM",
        ),
        (
            "*BOUNDARY",
            "*EQUATION\n2\n1, 1, 1., 2, 1, -1.\n*BOUNDARY",
            &[],
            "has *EQUATION",
        ),
        (
            "*STEP, NLGEOM",
            "*STEP, NLGEOM\n*STATIC\n*END STEP\n*STEP",
            &[],
            "has several *STATIC steps",
        ),
        (
            "CENTRIF",
            "CENTRIF",
            &["--nodes", "RIM"],
            "--nodes RIM: there is no such set",
        ),
        (
            "CENTRIF",
            "CENTRIF",
            &["--output", "a.mtx"],
            "needs a name that ends with .sti",
        ),
        (
            "CENTRIF",
            "CENTRIF",
            &["--ccx", "no_such_program", "--output", "b.sti"],
            "no_such_program is not found",
        ),
        ("CENTRIF", "NONSENSE", &["--output", "c.sti"], "made no c_static.dat"),
    ] {
        std::fs::write(folder.join("wrong.inp"), deck.replacen(from, to, 1)).unwrap();
        let errors = printed(&command(&[&["prestress", "wrong.inp"], more].concat(), folder).stderr);
        assert!(errors.contains(words), "{errors}");
    }
}

/// Two blocks pressed on each other by CalculiX, the upper one inclined so that pressures differ: 2 against 3 bricks.
fn blocks() -> String {
    let (mut nodes, mut elements) = (Vec::new(), Vec::new());
    let mut sets = [
        ("TOP", Vec::new()),
        ("BOTTOM", Vec::new()),
        ("FOOT", Vec::new()),
        ("HEAD", Vec::new()),
    ];
    for (n, [from, to], [low, high], slope) in [(2, [0.0, 1.0], [0.0, 1.0], 0.0), (3, [0.1, 0.9], [1.0, 1.5], 0.00005)]
    {
        let first = nodes.len();
        let number = |i: usize, j: usize, k: usize| first + 1 + i + (n + 1) * (j + (n + 1) * k);
        let at = |i: usize| from + (to - from) * i as f64 / n as f64;
        for k in 0..2 {
            for j in 0..=n {
                for i in 0..=n {
                    let z = if k == 0 { low + slope * at(i) } else { high };
                    nodes.push([at(i), at(j), z]);
                    let upper = usize::from(first > 0);
                    let set = [[2, 0], [1, 3]][upper][k];
                    sets[set].1.push(number(i, j, k));
                }
            }
        }
        for j in 0..n {
            for i in 0..n {
                let layer = |k| {
                    [
                        number(i, j, k),
                        number(i + 1, j, k),
                        number(i + 1, j + 1, k),
                        number(i, j + 1, k),
                    ]
                };
                elements.push([layer(0), layer(1)].concat());
            }
        }
    }
    let mut text = String::from("*NODE, NSET=ALL\n");
    for (i, [x, y, z]) in nodes.iter().enumerate() {
        let _ = writeln!(text, "{}, {x:.9}, {y:.9}, {z:.9}", i + 1);
    }
    text += "*ELEMENT, TYPE=C3D8, ELSET=SOLID\n";
    for (i, element) in elements.iter().enumerate() {
        let words: Vec<String> = element.iter().map(usize::to_string).collect();
        let _ = writeln!(text, "{}, {}", i + 1, words.join(", "));
    }
    for (name, nodes) in &sets {
        let words: Vec<String> = nodes.iter().map(|node| format!("{node},\n")).collect();
        let _ = write!(text, "*NSET, NSET={name}\n{}", words.concat());
    }
    text + "*ELSET, ELSET=UNDER, GENERATE\n1, 4\n*ELSET, ELSET=OVER, GENERATE\n5, 13\n\
            *SURFACE, NAME=FACE, TYPE=ELEMENT\nUNDER, S2\n*SURFACE, NAME=OTHER, TYPE=ELEMENT\nOVER, S1\n\
            *MATERIAL, NAME=M\n*ELASTIC\n1e5, 0.3\n*DENSITY\n1e-3\n*SOLID SECTION, ELSET=SOLID, MATERIAL=M\n\
            *SURFACE INTERACTION, NAME=I\n*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n1e7, 1.\n\
            *CONTACT PAIR, INTERACTION=I, TYPE=NODE TO SURFACE\nOTHER, FACE\n*BOUNDARY\nFOOT, 1, 3\nHEAD, 1, 2\n\
            *STEP, NLGEOM\n*STATIC\n*BOUNDARY\nHEAD, 3, 3, -0.0001\n*CONTACT FILE\nCDIS, CSTR\n*CONTACT PRINT\nCDIS, CSTR\n\
            *NODE PRINT, NSET=FOOT, TOTALS=ONLY\nRF\n*END STEP\n"
}

#[test]
fn contacts_have_the_forces_of_the_static_step_and_its_stiffness() {
    let folder = empty_folder("prestressed_models", "blocks");
    let released = "*STEP, PERTURBATION\n*BOUNDARY, OP=NEW\nFOOT, 1, 3\nHEAD, 1, 3\n*FREQUENCY\n8\n*END STEP\n";
    std::fs::write(folder.join("blocks.inp"), blocks() + released).unwrap();
    run("ccx", &["blocks"], &folder);
    done(&["prestress", "blocks.inp"], &folder);
    let job = |file: &str, law: &str| {
        format!(
            "[model]\nmatrices = 'blocks_prestressed.sti'\nmesh = 'blocks.inp'\nprestressed = true\nabsent = 'fixed'\n\
             [[contact]]\n{law}\nkn = 1e7\n[contact.static]\nfile = '{file}'\n[contact.surfaces]\na = 'BOTTOM'\nb = 'TOP'\n\
             largest_distance = 0.01\n"
        )
    };
    let write = |name: &str, text: &str| std::fs::write(folder.join(name), text).unwrap();
    write("job.toml", &job("blocks_prestressed_static.frd", "kind = 'unilateral'"));
    let report: serde_json::Value = serde_json::from_str(&done(&["check", "--json", "job.toml"], &folder)).unwrap();
    // The reaction at the foot, within the change of areas: nothing gives way.
    let text = std::fs::read_to_string(folder.join("blocks_prestressed_static.dat")).unwrap();
    let total = text
        .lines()
        .skip_while(|line| !line.contains("total force"))
        .nth(2)
        .unwrap();
    let reaction: f64 = total.split_whitespace().nth(2).unwrap().parse().unwrap();
    let pairs = report["contacts"][0]["pairs"].as_array().unwrap();
    let force: f64 = pairs.iter().map(|pair| pair["normal_force"].as_f64().unwrap()).sum();
    assert!((force / reaction - 1.0).abs() < 5e-4, "{force} and {reaction}");
    assert!(pairs.len() == 16 && pairs.iter().all(|pair| pair["closed"] == true));
    // Stuck contacts are the penalty springs of CalculiX, whose motion is followed here from the shape before the load.
    let theirs = of_calculix(&folder.join("blocks.dat"));
    let own = modes("job.toml", &folder);
    assert_eq!(theirs.len(), 8);
    for ((numbers, hertz), [free, stuck]) in theirs.iter().zip(&own[&0]) {
        assert!(
            (stuck / hertz - 1.0).abs() < 5e-4,
            "mode {numbers:?}: {stuck} and {hertz}"
        );
        assert!(free < stuck);
    }
    // The same by the printed tables, and by a table of forces.
    let forces = |job: &str| -> String {
        let text = done(&["check", job], &folder);
        text.lines()
            .find(|line| line.starts_with("contact 1:"))
            .unwrap()
            .to_owned()
    };
    let expected = forces("job.toml");
    write("job.toml", &job("blocks_prestressed_static.dat", "kind = 'unilateral'"));
    assert_eq!(forces("job.toml")[..90], expected[..90]);
    write("table.csv", "node,force,gap\n19,0,1e-4\n20,2.5,0\n21,0.5,0\n");
    let left_out = job("table.csv", "kind = 'friction_3d'\nkt = 1e6\nmu = 0.3")
        .replace("[contact.surf", "missing = 'left_out'\n[contact.surf");
    write("job.toml", &left_out);
    let text = forces("job.toml");
    assert!(
        text.contains("contact 1: 3 pairs") && text.contains("3.0000e0 in all") && text.contains("2 closed, 1 open"),
        "{text}"
    );
    for (text, words) in [
        (left_out.replace("missing = 'left_out'\n", ""), "has no contact at node"),
        // The values are those of the nodes of BOTTOM, which is side b now.
        (
            left_out.replace("a = 'BOTTOM'\nb = 'TOP'", "a = 'TOP'\nb = 'BOTTOM'"),
            "looks up the nodes of side a alone",
        ),
        (
            left_out.replace("kt =", "preload = 1.0\nkt ="),
            "static takes the place of preload",
        ),
        (
            left_out.replace("table.csv", "blocks.inp"),
            "needs .frd (*CONTACT FILE)",
        ),
        (left_out.replace("table.csv", "mesh.frd"), "mesh.frd: cannot be read"),
    ] {
        write("job.toml", &text);
        let errors = printed(&command(&["check", "job.toml"], &folder).stderr);
        assert!(errors.contains(words), "{errors}");
    }
    // A single pair by node and direction, held by its force.
    write("table.csv", "node;pressure\n20;7\n");
    let listed = left_out.replace("missing = 'left_out'\n", "").replace(
        "kind = 'friction_3d'\nkt = 1e6\nmu = 0.3",
        "kind = 'unilateral'\na = ['20.3']",
    );
    let listed = &listed[..listed.find("[contact.surfaces]").unwrap()];
    write("job.toml", listed);
    let errors = printed(&command(&["check", "job.toml"], &folder).stderr);
    assert!(errors.contains("pressures need areas"), "{errors}");
    write("table.csv", "node;force\n20;7\n");
    assert!(forces("job.toml").contains("7.0000e0 in all"), "{}", forces("job.toml"));
}
