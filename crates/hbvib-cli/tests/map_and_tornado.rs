//! Jobs with `[map]` and `[tornado]`: peaks and changes are those of the library's own calls, in tables, NPZ and figures, and
//! what cannot be computed is refused with the place in the job.

use hbvib::{
    BatchOptions, Constant, Contact, ForcedOptions, Hooks, MatrixKind, MatrixView, Model, Parameter, Part, Quantity,
    SolverOptions, Speed, Storage, Values, batch, forced_response, sensitivity,
};
use std::f64::consts::TAU;
use std::fs;
use std::path::Path;
use std::process::Output;

const SPEED: f64 = 200.0;
const PER_SPEED2: f64 = 5e-3;

/// The ring damper with a normal load of 100 N + 5 g m Ω².
fn run(verb: &str, name: &str, parts: &str) -> (Output, std::path::PathBuf) {
    let job = format!(
        "{}model.speed = {SPEED}\n[[contact]]\nkind = 'jenkins'\na = [2]\nb = [3]\nkt = 5e7\nmu = 0.3\npreload = 100.0\n\
         per_speed2 = {PER_SPEED2}\n[[force]]\ndof = 0\nvalue = 5.0\n[[force]]\ndof = 1\nvalue = 5.0\n{parts}\n",
        crate::common::ring_damper()
    );
    crate::common::hbvib(verb, ("map_and_tornado", name), &job)
}

/// The same by the library.
fn model() -> Model {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/jobs/ring_damper");
    let mut model = Model::cyclic(4, 24).unwrap();
    model.set_wave(2);
    for (file, kind, coupling) in [
        ("stiffness.mtx", MatrixKind::Stiffness, false),
        ("mass.mtx", MatrixKind::Mass, false),
        ("coupling.mtx", MatrixKind::Stiffness, true),
    ] {
        let found = hbvib_io::read(&folder.join(file)).unwrap();
        let a = [found.stiffness, found.mass, found.damping]
            .into_iter()
            .flatten()
            .next()
            .unwrap();
        let mut dense = [0.0; 16];
        for ((&i, &j), &v) in a.row.iter().zip(&a.column).zip(&a.values) {
            dense[4 * j as usize + i as usize] = v;
            if a.symmetry == hbvib_io::Symmetry::Symmetric {
                dense[4 * i as usize + j as usize] = v;
            }
        }
        let view = MatrixView::dense(4, &dense);
        if coupling {
            model.set_coupling(kind, &view).unwrap();
        } else {
            model.set_matrix(kind, &view).unwrap();
        }
    }
    model.set_rayleigh(0.0, 1.5e-6).unwrap();
    let id = model
        .add_contact(&Contact::jenkins(2, Some(3), 5e7, 0.3, 100.0))
        .unwrap();
    model.set_preload_at_speed(id, 100.0, PER_SPEED2).unwrap();
    for dof in [0, 1] {
        model.add_force(dof, 1, 5.0.into()).unwrap();
    }
    model.set_speed(Speed::Fixed(SPEED)).unwrap();
    model
}

fn solver() -> SolverOptions {
    SolverOptions {
        harmonics: 9,
        tolerance: 0.0,
        response_dof: Some(0),
        ..SolverOptions::default()
    }
}

/// The mass of the ring, which is degree of freedom 3.
fn ring() -> Parameter<'static> {
    Parameter::Direction {
        which: MatrixKind::Mass,
        direction: MatrixView {
            rows: 4,
            cols: 4,
            storage: Storage::Csc {
                col_ptr: &[0, 0, 0, 0, 1],
                row_idx: &[3],
            },
            values: Values::Real(&[1.0]),
            part: Part::Full,
            index_base: 0,
        },
    }
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

fn table(path: &Path) -> Vec<Vec<String>> {
    let text = fs::read_to_string(path).unwrap();
    text.lines()
        .skip(1)
        .map(|line| line.split(',').map(str::to_owned).collect())
        .collect()
}

fn number(cell: &str) -> f64 {
    cell.parse().unwrap()
}

#[test]
fn a_map_has_the_peaks_of_a_batch() {
    let (output, folder) = run(
        "run",
        "map",
        "[map]\nfrom_hz = 200\nto_hz = 215\nharmonics = 9\nresponse_dof = 0\nthreads = 2\n\
         csv = 'map.csv'\nnpz = 'map.npz'\nfigure = 'map.svg'\n\
         [map.x]\nparameter = 'mass'\ndofs = [3]\nfrom = -0.02\nto = 0.02\npoints = 3\n\
         [map.y]\nparameter = 'speed'\nfrom = 150\nto = 450\npoints = 4",
    );
    assert!(output.status.success(), "{}", text(&output.stderr));
    let said = text(&output.stdout);
    assert!(
        said.contains("map of 12 peaks, 12 complete") && said.contains("least peak"),
        "{said}"
    );
    let designs: Vec<f64> = [-0.02, 0.0, 0.02]
        .into_iter()
        .flat_map(|mass| {
            [150.0, 250.0, 350.0, 450.0]
                .into_iter()
                .flat_map(move |speed| [mass, speed])
        })
        .collect();
    let options = BatchOptions {
        omega_start: 200.0 * TAU,
        omega_stop: 215.0 * TAU,
        ..BatchOptions::default()
    };
    let parameters = [ring(), Parameter::Speed];
    let found = batch(
        &model(),
        &solver(),
        &options,
        (&parameters, &designs),
        &mut Hooks::default(),
    )
    .unwrap();
    let rows = table(&folder.join("map.csv"));
    assert_eq!(rows.len(), 12);
    for ((row, design), peak) in rows.iter().zip(designs.chunks_exact(2)).zip(found.peaks()) {
        assert!((number(&row[0]) - design[0]).abs() < 1e-15 && (number(&row[1]) - design[1]).abs() < 1e-12);
        assert_eq!(row[4], "HBVIB_OK");
        assert!((number(&row[2]) / (peak.omega / TAU) - 1.0).abs() < 1e-12, "{row:?}");
        assert!(
            (number(&row[3]) / peak.amplitude - 1.0).abs() < 1e-10,
            "{row:?} {}",
            peak.amplitude
        );
    }
    // Peaks differ by more than the comparison allows.
    assert!((number(&rows[0][3]) / number(&rows[11][3]) - 1.0).abs() > 1e-2);
    let archive = fs::read(folder.join("map.npz")).unwrap();
    let amplitudes: Vec<u8> = rows.iter().flat_map(|row| number(&row[3]).to_le_bytes()).collect();
    assert!(archive.starts_with(b"PK") && archive.windows(amplitudes.len()).any(|part| part == amplitudes));
    assert!(archive.windows(14).any(|part| part == b"'shape': (3, 4"));
    assert!(fs::read_to_string(folder.join("map.svg")).unwrap().starts_with("<svg"));
}

#[test]
fn designs_without_a_peak_are_told_with_their_status() {
    let (output, folder) = run(
        "run",
        "no_peak",
        "[map]\nfrom_hz = 300\nto_hz = 310\nharmonics = 1\ncsv = 'map.csv'\nfigure = 'map.png'\n\
         [map.x]\nparameter = 'kt'\nfrom = 1e7\nto = 5e7\npoints = 2\n\
         [map.y]\nparameter = 'force'\nfrom = 1\nto = 2\npoints = 2",
    );
    assert!(output.status.success(), "{}", text(&output.stderr));
    let said = text(&output.stdout);
    assert!(
        said.contains("0 complete") && said.contains("HBVIB_STOPPED_NO_PEAK at kt"),
        "{said}"
    );
    let rows = table(&folder.join("map.csv"));
    assert!(
        rows.iter()
            .all(|row| row[3] == "NaN" && row[4] == "HBVIB_STOPPED_NO_PEAK"),
        "{rows:?}"
    );
}

#[test]
fn a_tornado_has_the_sensitivities_of_the_highest_peak() {
    let (output, folder) = run(
        "run",
        "tornado",
        "[tornado]\nfrom_hz = 200\nto_hz = 215\nharmonics = 9\nresponse_dof = 0\n\
         csv = 'tornado.csv'\nfigure = 'tornado.svg'\n\
         [[tornado.parameter]]\nparameter = 'force'\n\
         [[tornado.parameter]]\nparameter = 'preload'\ncontact = 0\nspread = 0.2\n\
         [[tornado.parameter]]\nparameter = 'mass'\ndofs = [3]\nvalue = 0.03\nname = 'ring mass'\n\
         [[tornado.parameter]]\nparameter = 'speed'\nspread = -0.05\n\
         [[tornado.parameter]]\nparameter = 'stiffness'\nspread = 0.01",
    );
    assert!(output.status.success(), "{}", text(&output.stderr));
    let model = model();
    let range = ForcedOptions {
        omega_start: 200.0 * TAU,
        omega_stop: 215.0 * TAU,
        ..ForcedOptions::default()
    };
    let branch = forced_response(&model, &solver(), &range, &mut Hooks::default()).unwrap();
    let peak = *branch
        .peaks()
        .iter()
        .max_by(|a, b| a.amplitude.total_cmp(&b.amplitude))
        .unwrap();
    let preload = Parameter::Contact {
        constant: Constant::Preload,
        contact: Some(0),
    };
    let stiffness = Parameter::Factor {
        which: MatrixKind::Stiffness,
    };
    let given = [
        ("\"force\"", Parameter::Force, 1.0, 0.1),
        ("\"preload of contact 0\"", preload, 100.0, 0.2),
        ("\"ring mass\"", ring(), 0.03, 0.1),
        ("\"speed\"", Parameter::Speed, SPEED, -0.05),
        ("\"stiffness\"", stiffness, 1.0, 0.01),
    ];
    let parameters = given.map(|(_, parameter, ..)| parameter);
    let of = |quantity| {
        sensitivity(&model, &branch, peak.point, &parameters, quantity)
            .unwrap()
            .values
    };
    let (amplitude, omega) = (of(Quantity::PeakAmplitude), of(Quantity::PeakOmega));
    let rows = table(&folder.join("tornado.csv"));
    assert_eq!(rows.len(), given.len());
    for (i, (name, _, value, spread)) in given.into_iter().enumerate() {
        let row = rows.iter().find(|row| row[0] == name).unwrap();
        let change = spread * value;
        for (cell, exact) in row[1..].iter().zip([
            value,
            spread,
            change * amplitude[i] / peak.amplitude,
            change * omega[i] / peak.omega,
            amplitude[i],
            omega[i] / TAU,
        ]) {
            let (found, scale) = (number(cell), exact.abs().max(1e-12));
            assert!((found - exact).abs() < 1e-9 * scale, "{name}: {found} {exact}");
        }
    }
    let sizes: Vec<f64> = rows.iter().map(|row| number(&row[3]).abs()).collect();
    assert!(sizes.is_sorted_by(|a, b| a >= b), "{sizes:?}");
    assert!(text(&output.stdout).contains("by 5 quantities"));
    let figure = fs::read_to_string(folder.join("tornado.svg")).unwrap();
    assert!(figure.starts_with("<svg") && figure.contains("ring mass"));
}

/// The sentences of `hbvib check` are those of `hbvib run`.
#[test]
fn what_cannot_be_computed_is_refused_with_its_place() {
    let map = |x: &str, y: &str| {
        format!("[map]\nfrom_hz = 200\nto_hz = 215\n[map.x]\nfrom = 1\nto = 2\n{x}\n[map.y]\nfrom = 1\nto = 2\n{y}")
    };
    let tornado = |one: &str| format!("[tornado]\nfrom_hz = 200\nto_hz = 215\n[[tornado.parameter]]\n{one}");
    let (kt, mass) = ("parameter = 'kt'", "parameter = 'mass'");
    for (name, parts, sentence) in [
        ("key", map("parametr = 'kt'", mass), "`parameter`"),
        (
            "map_key",
            map(kt, mass).replace("to_hz", "thread = 1\nto_hz"),
            "`threads`",
        ),
        ("kind", map("parameter = 'preloads'", mass), "preload"),
        ("same", map(kt, kt), "[map]: x and y both change kt"),
        (
            "contact",
            map("parameter = 'kt'\ncontact = 3", mass),
            "[map.x]: kt of contact 3",
        ),
        ("constant", map(kt, "parameter = 'kn'"), "[map.y]: kn: no contact"),
        (
            "of_mass",
            map(kt, "parameter = 'mass'\ncontact = 0"),
            "[map.y]: contact needs a constant",
        ),
        (
            "dofs",
            map("parameter = 'kt'\ndofs = [1]", mass),
            "[map.x]: dofs needs mass",
        ),
        ("dof", map(kt, "parameter = 'mass'\ndofs = [4]"), "[map.y]: dofs: 4"),
        (
            "twice",
            map(kt, "parameter = 'mass'\ndofs = [1, 1]"),
            "dofs: 1 is named twice",
        ),
        (
            "points",
            map("parameter = 'kt'\npoints = 1", mass),
            "[map.x]: from = 1, to = 2, points = 1",
        ),
        (
            "falling",
            map(kt, mass).replacen("to = 2", "to = 1", 1),
            "needs rising numbers",
        ),
        (
            "many",
            map("parameter = 'kt'\npoints = 9999999", mass),
            "at most 10000000",
        ),
        (
            "spread",
            tornado("parameter = 'kt'\nspread = 0"),
            "[[tornado.parameter]] 1: spread = 0",
        ),
        ("value", tornado("parameter = 'mass'\ndofs = [3]"), "name a value"),
        (
            "gap",
            tornado("parameter = 'gap'"),
            "[[tornado.parameter]] 1: gap: no contact",
        ),
        (
            "none",
            "[tornado]\nfrom_hz = 200\nto_hz = 215\nparameter = []".into(),
            "names no quantity",
        ),
    ] {
        for verb in ["check", "run"] {
            let (output, _) = run(verb, name, &parts);
            let said = text(&output.stderr);
            assert!(
                output.status.code() == Some(1) && said.contains(sentence),
                "{name}, {verb}: {said}"
            );
        }
    }
    let (output, _) = run("run", "far", &tornado("parameter = 'kt'").replace("215", "201"));
    assert!(
        text(&output.stderr).contains("[tornado]: the response has no peak"),
        "{}",
        text(&output.stderr)
    );
}
