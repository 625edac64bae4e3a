//! Natural frequencies, forced responses and maps of the slip, each as CSV, SVG and PNG, with short
//! tables on the screen.

use std::error::Error;
use std::f64::consts::TAU;
use std::io::Write;
use std::path::Path;
use std::time::{Duration, Instant};

use hbvib::{ContactState, SolverOptions};

use crate::cost;
use crate::csv::write_csv;
use crate::plot::{Figure, Series, Style};
use crate::progress::Bar;
use crate::response::{Range, Response};
use crate::sector::{Interface, SECTORS, Sector, Size, natural_frequencies};
use crate::single::RANGE;
use crate::stability;

type Outcome = Result<(), Box<dyn Error>>;

/// Number of lowest modes of each nodal diameter in the diagram.
const MODES: usize = 6;
const FORCES: [f64; 2] = [0.2, 2.0];
/// Highest harmonic of the responses; the even ones vanish.
const HARMONICS: [usize; 2] = [1, 3];
/// Largest step along a curve, small enough for it to be drawn smoothly.
const SMOOTH: f64 = 0.02;

/// Computes and writes everything for the reduced sector.
///
/// # Errors
///
/// If the data cannot be read, a response cannot be computed or a file cannot be written.
pub fn run(data: &Path, folder: &Path, screen: &mut impl Write) -> Outcome {
    let begin = Instant::now();
    let sector = Sector::read(data, Size::Reduced)?;
    let read = begin.elapsed();
    diameters(&sector, folder, screen)?;
    responses(&sector, read, folder, screen)?;
    writeln!(screen, "\nCSV, SVG and PNG are in {}", folder.display())?;
    Ok(())
}

/// Natural frequencies against nodal diameter, without contact and with every contact stuck.
fn diameters(sector: &Sector, folder: &Path, screen: &mut impl Write) -> Outcome {
    let states = [
        ("no contact", Interface::Absent, ContactState::Free, Style::Markers),
        ("stuck", Interface::Friction2d, ContactState::Stuck, Style::Line),
    ];
    let highest = SECTORS as i64 / 2;
    let mut bar = Bar::new("natural frequencies", (states.len() as i64 * (highest + 1)) as u64);
    let mut columns = Vec::new();
    let mut series = Vec::new();
    for (label, interface, state, style) in states {
        let model = sector.model(interface)?;
        let mut of_diameter = Vec::new();
        for diameter in 0..=highest {
            let omega = natural_frequencies(&model, diameter, state, MODES)?;
            of_diameter.push(omega.iter().map(|w| w / TAU).collect::<Vec<_>>());
            let done = columns.len() as i64 * (highest + 1) + diameter + 1;
            bar.set(done as f64 / (states.len() as i64 * (highest + 1)) as f64);
        }
        for mode in 0..MODES {
            let family = of_diameter.iter().enumerate();
            let points = family.map(|(d, f)| (d as f64, f[mode])).collect();
            series.push(Series::new(label, style, points));
        }
        columns.push(of_diameter);
    }
    bar.finish();

    writeln!(
        screen,
        "\nNatural frequencies [Hz], lowest {MODES}: no contact, then stuck"
    )?;
    let mut header = vec!["nodal_diameter".to_owned()];
    for state in ["free", "stuck"] {
        header.extend((1..=MODES).map(|mode| format!("{state}_{mode}_Hz")));
    }
    let mut rows = Vec::new();
    for diameter in 0..=highest {
        let frequencies = columns.iter().flat_map(|c| c[diameter as usize].iter().copied());
        let row: Vec<f64> = std::iter::once(diameter as f64).chain(frequencies).collect();
        write!(screen, "{diameter:>4}")?;
        for (i, f) in row[1..].iter().enumerate() {
            write!(screen, "{}{f:>9.2}", if i == MODES { "  |" } else { "" })?;
        }
        writeln!(screen)?;
        rows.push(row);
    }
    let header: Vec<&str> = header.iter().map(String::as_str).collect();
    write_csv(folder.join("nodal_diameters.csv"), &header, &rows)?;
    let figure = Figure {
        title: "Natural frequencies of the sector".into(),
        x_label: "Nodal diameter".into(),
        y_label: "Frequency [Hz]".into(),
        y_range: Some((0.0, 3500.0)),
        series,
        ..Figure::default()
    };
    figure.save(&folder.join("nodal_diameters"))
}

/// Responses to every force with every number of harmonics.
fn responses(sector: &Sector, read: Duration, folder: &Path, screen: &mut impl Write) -> Outcome {
    let range = Range {
        from: RANGE.0,
        to: RANGE.1,
        at: Vec::new(),
    };
    let mut series = Vec::new();
    let mut rows = Vec::new();
    for force in FORCES {
        let model = sector.forced(force)?;
        for harmonics in HARMONICS {
            let solver = SolverOptions {
                harmonics,
                step_max: SMOOTH,
                tolerance: 0.0,
                ..SolverOptions::default()
            };
            let mut bar = Bar::new(format!("response to {force} N, H = {harmonics}"), 100);
            let tip = [sector.size.tip()];
            let response = Response::follow(&model, &solver, &range, &tip, |share| bar.set(share))?;
            bar.finish();
            let carried = if harmonics == 1 { "1" } else { "1 and 3" };
            let peak = &response.peak;
            writeln!(
                screen,
                "\nResponse to {force} N, harmonics {carried}: {} points, peak {:.6e} m at {:.6} Hz",
                response.points.len(),
                peak.amplitude(),
                peak.frequency
            )?;
            cost::show(screen, read, &model, &response)?;
            for p in &response.points {
                let x = p.fundamental();
                rows.push(vec![force, harmonics as f64, p.frequency, p.amplitude(), x.re, x.im]);
            }
            let curve = response.points.iter();
            let points: Vec<_> = curve.map(|p| (p.frequency, p.amplitude() / force * 1e6)).collect();
            let label = format!("{force} N, h = {carried}");
            if harmonics == 1 {
                series.push(Series::new(label, Style::Dashed, points));
            } else {
                series.extend(stability::series(&label, &points, &stability::between_folds(&response)));
            }
            if harmonics == 3 {
                slip_map(sector, &response, force, folder, screen)?;
            }
        }
    }
    let header = [
        "force_N",
        "harmonics",
        "frequency_Hz",
        "amplitude_m",
        "x1_re_m",
        "x1_im_m",
    ];
    write_csv(folder.join("response.csv"), &header, &rows)?;
    let figure = Figure {
        title: "Response of the blade tip, over the force".into(),
        x_label: "Frequency [Hz]".into(),
        y_label: "Amplitude over force [µm/N]".into(),
        log_y: true,
        series,
        ..Figure::default()
    };
    figure.save(&folder.join("response"))
}

/// Map of the slip in the contact at the peak of a response.
fn slip_map(sector: &Sector, response: &Response, force: f64, folder: &Path, screen: &mut impl Write) -> Outcome {
    let shares = response
        .branch
        .slip_fraction_at(response.peak.number)
        .ok_or("the peak has no state of the contacts")?;
    // Contacts 2p and 2p + 1 are pair p along θ and along z.
    let along = |pair: usize, direction: usize| shares[2 * pair + direction];
    let mut order: Vec<usize> = (0..sector.pairs.len()).collect();
    // The mesh generator places the nodes of a row within a small tolerance of a plane.
    let plane = |p: usize| (1e4 * sector.pairs[p].z).round();
    order.sort_by(|&i, &j| {
        let rows = plane(j).total_cmp(&plane(i));
        rows.then(sector.pairs[i].theta.total_cmp(&sector.pairs[j].theta))
    });
    let mut rows = Vec::new();
    for &p in &order {
        let pair = &sector.pairs[p];
        rows.push(vec![p as f64, pair.theta, pair.z, along(p, 0), along(p, 1)]);
    }
    let header = ["pair", "theta_rad", "z_m", "slip_share_theta", "slip_share_z"];
    write_csv(folder.join(format!("slip_{force}N.csv")), &header, &rows)?;

    for (direction, name) in ["theta", "z"].into_iter().enumerate() {
        let sign = ["θ", "z"][direction];
        writeln!(
            screen,
            "  share of the period [%] that the pairs slip along {sign} at the peak; columns around the wheel"
        )?;
        for (i, &p) in order.iter().enumerate() {
            if i == 0 || plane(p) < plane(order[i - 1]) {
                let z = 0.1 * plane(p);
                write!(screen, "{}    z {z:>4.1} mm", if i == 0 { "" } else { "\n" })?;
            }
            write!(screen, "{:>6.1}", 100.0 * along(p, direction))?;
        }
        writeln!(screen)?;
        let series = CLASSES.iter().map(|(label, low, high)| {
            let inside = order.iter().filter(|&&p| {
                let share = along(p, direction);
                share > *low && share <= *high
            });
            let points = inside.map(|&p| (sector.pairs[p].theta.to_degrees(), 1e3 * sector.pairs[p].z));
            Series::new(*label, Style::Markers, points.collect())
        });
        let figure = Figure {
            title: format!("Slip along {sign} at the peak of the response to {force} N"),
            x_label: "Position around the wheel [°]".into(),
            y_label: "Position along the axis [mm]".into(),
            legend_title: "Share of the period".into(),
            series: series.collect(),
            ..Figure::default()
        };
        figure.save(&folder.join(format!("slip_{force}N_{name}")))?;
    }
    Ok(())
}

/// Classes of the maps: label, above, up to. More than six, so that their colours form a scale.
const CLASSES: [(&str, f64, f64); 7] = [
    ("0 (sticks)", -1.0, 0.0),
    ("up to 20 %", 0.0, 0.2),
    ("20 to 40 %", 0.2, 0.4),
    ("40 to 60 %", 0.4, 0.6),
    ("60 to 80 %", 0.6, 0.8),
    ("80 to 90 %", 0.8, 0.9),
    ("above 90 %", 0.9, 1.0),
];
