//! Residual states of a job: places of sliders by themselves, from a file, a load history and a vibration; the bands of the frequency of a
//! peak and of a nonlinear mode. Each result is that of the library's own calls.

use crate::bands::run;
use crate::common::printed;
use hbvib::{
    BandOf, BandOptions, Contact, ForcedOptions, Frame, Hooks, LoadHistory, MatrixKind, MatrixView, ModeBandOf,
    ModeOptions, Model, SolverOptions, SteadyMethod, TimeOptions, band, forced_response, freedom, mode_band,
    nonlinear_mode, static_history, time_response,
};
use std::f64::consts::TAU;
use std::fs;
use std::path::Path;

/// The wedge damper of the jobs.
fn wedge() -> Model {
    let mut model = Model::new(3).unwrap();
    for (kind, blade, damper) in [
        (MatrixKind::Mass, 1.0, 0.01),
        (MatrixKind::Damping, 0.04, 0.004),
        (MatrixKind::Stiffness, 1.0, 1e-3),
    ] {
        let full = [blade, 0.0, 0.0, 0.0, damper, 0.0, 0.0, 0.0, damper];
        model.set_matrix(kind, &MatrixView::dense(3, &full)).unwrap();
    }
    for (blade, normal, tangent, mu) in [
        (None, [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], 0.6),
        (Some(0), [-1.0, -1.0, 0.0], [-1.0, 1.0, 0.0], 0.15),
    ] {
        let contact = Contact {
            dof_a: [Some(1), Some(2), None],
            dof_b: [blade, None, None],
            frame: Some(Frame::new(normal, Some(tangent)).unwrap()),
            ..Contact::friction_2d([None; 2], [None; 2], (1.0, 1.5), mu, 0.0)
        };
        model.add_contact(&contact).unwrap();
    }
    model.add_force(2, 0, 1.0.into()).unwrap();
    model.add_force(0, 1, 0.02.into()).unwrap();
    model
}

fn fixed(harmonics: usize) -> SolverOptions {
    SolverOptions {
        harmonics,
        tolerance: 0.0,
        ..SolverOptions::default()
    }
}

fn range() -> ForcedOptions<'static> {
    ForcedOptions {
        omega_start: TAU * 0.196,
        omega_stop: TAU * 0.2005,
        ..ForcedOptions::default()
    }
}

const FORCED: &str = "[forced]\nfrom_hz = 0.196\nto_hz = 0.2005\nharmonics = 5\nfreedom = true\n[output]\ncsv = 'response.csv'\nnpz = 'response.npz'\n";

/// Rows of a table without its heading.
fn rows(path: &Path) -> Vec<Vec<f64>> {
    let text = fs::read_to_string(path).unwrap();
    let number = |x: &str| x.parse().unwrap_or(f64::NAN);
    text.lines()
        .skip(1)
        .map(|line| line.split(',').map(number).collect())
        .collect()
}

/// Runs a job that works.
fn works(name: &str, part: &str) -> (String, std::path::PathBuf) {
    let (output, folder) = run(name, part);
    let text = printed(&output.stdout);
    assert!(output.status.success(), "{text}{}", printed(&output.stderr));
    (text, folder)
}

#[test]
fn a_slider_of_a_job_and_its_freedom_are_those_of_the_library() {
    let part = "[residual]\nplaces_npz = 'places.npz'\n[[residual.slider]]\ncontact = '1'\nplace = [0.4]\n";
    let (text, folder) = works("slider", &format!("{part}{FORCED}"));
    assert!(
        text.contains("sliders of 1 contact are placed") && text.contains("with free sliders"),
        "{text}"
    );
    let mut model = wedge();
    model.set_slider(0, 0, 0.4).unwrap();
    let branch = forced_response(&model, &fixed(5), &range(), &mut Hooks::default()).unwrap();
    let table = rows(&folder.join("response.csv"));
    assert_eq!(table.len(), branch.points());
    for (point, row) in table.iter().enumerate() {
        assert!((row[1] / branch.amplitude()[point] - 1.0).abs() < 1e-12);
        let free = freedom(&model, &branch, point).unwrap();
        assert!((row[4] - free.len() as f64).abs() < 1e-12);
        let own = free.first().map_or(0.0, |one| one.derivative);
        assert!(
            (row[5] - own).abs() < 1e-9 && (row[6] - own).abs() < 1e-9,
            "{row:?} {own}"
        );
    }
    let arrays = fs::read(folder.join("response.npz")).unwrap();
    let has = |name: &str| arrays.windows(name.len()).any(|part| part == name.as_bytes());
    assert!(has("free_sliders.npy") && has("d_amplitude_by_place.npy"));
    // The same from the file.
    let again = format!("[residual]\nnpz = '{}'\n{FORCED}", folder.join("places.npz").display());
    let (_, other) = works("slider_again", &again);
    assert_eq!(rows(&other.join("response.csv"))[3][1].to_bits(), table[3][1].to_bits());
}

#[test]
fn a_load_history_and_a_vibration_leave_their_places() {
    let (text, folder) = works(
        "history",
        "[residual]\nfactors = [1, 2, 0.5, 1]\ncsv = 'history.csv'\nplaces_npz = 'places.npz'\n",
    );
    assert!(text.contains("4 static steps"), "{text}");
    let mut model = wedge();
    let history = LoadHistory {
        factors: &[1.0, 2.0, 0.5, 1.0],
        speeds: &[],
    };
    let steps = static_history(&model, &SolverOptions::default(), &history, &hbvib::Interrupt::none()).unwrap();
    let table = rows(&folder.join("history.csv"));
    assert_eq!(table.len(), 8);
    for (row, (step, contact)) in table.iter().zip((0..4).flat_map(|step| [(step, 0), (step, 1)])) {
        assert!((row[4] - steps[step].places[contact][0]).abs() < 1e-14);
        assert!(
            (row[6] - steps[step].forces[contact][0]).abs() < 1e-14
                && (row[8] - steps[step].forces[contact][2]).abs() < 1e-14
        );
    }
    assert!(steps[3].places.iter().flatten().any(|place| place.abs() > 1e-3));

    let (text, folder) = works(
        "vibration",
        "[residual]\nvibration_hz = [0.19, 0.2]\nplaces_npz = 'places.npz'\n",
    );
    assert!(text.contains("vibration at 0.2 Hz"), "{text}");
    let mut last = Vec::new();
    for hz in [0.19, 0.2] {
        let options = TimeOptions {
            omega: TAU * hz,
            method: SteadyMethod::Marching,
            start: (!last.is_empty()).then_some(&last[..]),
            ..TimeOptions::default()
        };
        let found = time_response(&model, &options, &mut Hooks::default()).unwrap();
        for (contact, place) in found.places.iter().enumerate() {
            model.set_slider(contact, 0, *place).unwrap();
        }
        last = found.harmonics;
    }
    let stored = hbvib_io::read_number_arrays(&folder.join("places.npz")).unwrap();
    assert_eq!(stored[0].shape, [2, 2]);
    for (contact, place) in stored[0].real.chunks_exact(2).enumerate() {
        assert!((place[0] - model.contacts()[contact].slider()[0]).abs() < 1e-14);
    }
}

#[test]
fn the_end_of_a_band_is_a_state_that_another_job_verifies() {
    let part = "[band]\nof = ['peak_amplitude', 'peak_hz']\ncontacts = [0]\nfrom_hz = 0.196\nto_hz = 0.2005\nharmonics = 15\n\
                ends_csv = 'ends.csv'\nupper_npz = 'upper.npz'\n";
    let (text, folder) = works("ends", part);
    let model = wedge();
    let branch = forced_response(&model, &fixed(15), &range(), &mut Hooks::default()).unwrap();
    let peak = branch.peaks()[0].point;
    let of = |of| {
        let options = BandOptions {
            of,
            contacts: &[0],
            ..BandOptions::default()
        };
        band(&model, &branch, peak, &fixed(15), &options, &mut Hooks::default()).unwrap()
    };
    let (amplitude, frequency) = (of(BandOf::PeakAmplitude), of(BandOf::PeakOmega));
    let ends = [&amplitude.lower, &amplitude.upper, &frequency.lower, &frequency.upper];
    let table = rows(&folder.join("ends.csv"));
    assert_eq!(table.len(), 4);
    for (row, end) in table.iter().zip(ends) {
        assert!(
            (row[2] * TAU / end.omega - 1.0).abs() < 1e-12 && (row[6] - end.places[0]).abs() < 1e-12,
            "{row:?}"
        );
    }
    assert!(text.contains("band of its frequency"), "{text}");
    let verified = format!(
        "[residual]\nnpz = '{}'\n[forced]\nfrom_hz = 0.196\nto_hz = 0.2025\nharmonics = 15\n[verify]\n",
        folder.join("upper.npz").display()
    );
    let (text, _) = works("ends_verified", &verified);
    let peak: f64 = text
        .split("peak ")
        .nth(1)
        .unwrap()
        .split_whitespace()
        .nth(2)
        .unwrap()
        .parse()
        .unwrap();
    assert!((peak / amplitude.upper.value - 1.0).abs() < 1e-5, "{text}");
}

#[test]
fn the_band_of_a_mode_is_that_of_the_library() {
    let part = "[mode_band]\nmode = { log10_from = -0.6, log10_to = -0.5, harmonics = 5 }\npoints = 2\ncsv = 'band.csv'\n\
                figure = 'band.svg'\n";
    let (text, folder) = works("of_mode", part);
    assert!(text.contains("mode band: 2 of 2 amplitudes"), "{text}");
    let model = wedge();
    let at = [-0.6, -0.5];
    let range = ModeOptions {
        log10_start: -0.6,
        log10_stop: -0.5,
        at: &at,
        ..ModeOptions::default()
    };
    let mode = nonlinear_mode(&model, &fixed(5), &range, &mut Hooks::default()).unwrap();
    for (i, row) in rows(&folder.join("band.csv")).iter().enumerate() {
        let point = mode.at(i)[0].point;
        let wanted = (ModeBandOf::Damping, &[][..]);
        let found = mode_band(&model, &mode, point, wanted, &fixed(5), &range, &mut Hooks::default()).unwrap();
        assert!(
            (row[2] / found.lower.damping_ratio - 1.0).abs() < 1e-9
                && (row[3] / found.upper.damping_ratio - 1.0).abs() < 1e-9
        );
        assert!(
            row[2] <= row[1] && row[1] <= row[3] && row[5] <= row[4] && row[4] <= row[6],
            "{row:?}"
        );
    }
    assert!(
        fs::read_to_string(folder.join("band.svg"))
            .unwrap()
            .contains("<polygon")
    );
}

#[test]
fn residual_states_that_are_none_are_refused() {
    for (part, words) in [
        (
            "[[residual.slider]]\ncontact = 'x'\nplace = [1.0]\n",
            "contact = \"x\" is none of 1, 2",
        ),
        (
            "[[residual.slider]]\ncontact = '1'\nplace = []\n",
            "place has 0 numbers, needs 1 or 2",
        ),
        (
            "[[residual.slider]]\ncontact = '1'\npair = 1\nplace = [0.1]\n",
            "pair = 1, needs 0 .. 1",
        ),
        ("[[residual.slider]]\ncontact = '1'\nplace = [0.1, 0.2]\n", "slider 1"),
        ("[residual]\nnpz = 'none.npz'\n", "none.npz"),
        (
            "[residual]\nfactors = [1]\nspeeds = [1, 2]\n",
            "[residual]: 1 factors and 2 speeds",
        ),
        ("[residual]\nvibration_hz = [0]\n", "vibration_hz has 0"),
        ("[residual]\ncsv = 'x.csv'\n", "csv has the steps of a load history"),
        (
            "[band]\nfrom_hz = 0.19\nto_hz = 0.2\nof = ['peak_hz']\ncsv = 'x.csv'\n",
            "csv needs amplitude in of",
        ),
        ("[band]\nfrom_hz = 0.19\nto_hz = 0.2\nof = []\n", "of is empty"),
        (
            "[band]\nfrom_hz = 0.19\nto_hz = 0.2\ncontacts = [2]\n",
            "[band] contacts: 2, but the model has 2 contacts",
        ),
        (
            "[mode_band]\nmode = { log10_from = -1.0, log10_to = 0.0 }\npoints = 1\n",
            "points = 1, needs at least 2",
        ),
        (
            "[mode_band]\nmode = { log10_from = -1.0, log10_to = 0.0 }\ncontacts = [9]\n",
            "[mode_band] contacts: 9",
        ),
    ] {
        let (output, _) = run("refused_state", part);
        let errors = printed(&output.stderr);
        assert!(!output.status.success() && errors.contains(words), "{part}: {errors}");
    }
}
