//! The verb `plot`: figures of stored responses.

use crate::outputs::line_chart::{Chart, Line};
use crate::outputs::stored_response::Stored;
use crate::print;
use crate::texts::arguments::PlotArguments;
use crate::texts::events;
use crate::texts::outcome::Outcome;
use std::f64::consts::TAU;

/// Draws the responses of one file or several.
///
/// # Errors
/// A sentence.
pub fn plot(of: &PlotArguments) -> Outcome<u8> {
    let mut lines = Vec::new();
    let mut is_mode = false;
    for path in &of.responses {
        let stored = Stored::read(path)?;
        is_mode |= !stored.damping_ratio.is_empty();
        let said = |e: String| format!("{}: {e}", path.display());
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        lines.extend(of_file(of, &stored, &name).map_err(said)?);
    }
    let unit = of.unit.as_ref().map_or(String::new(), |unit| format!(", {unit}"));
    let y_label = match (&of.damping, &of.slip, &of.dof) {
        (true, ..) => "damping ratio".to_owned(),
        (_, true, _) => "slip fraction, largest of all contacts".to_owned(),
        (.., Some(dof)) if dof.contains('.') => format!("amplitude of {dof}{unit}"),
        (.., Some(dof)) => format!("amplitude of degree of freedom {dof}{unit}"),
        _ => format!("amplitude{unit}"),
    };
    let chart = Chart {
        title: of.title.clone().unwrap_or_default(),
        x_label: if is_mode && of.damping {
            "log10 of the modal amplitude".into()
        } else {
            "frequency, Hz".into()
        },
        y_label,
        log_x: of.log_x,
        log_y: of.log_y,
        markers: of.markers,
        lines,
    };
    chart
        .write(&of.output)
        .map_err(|e| format!("{}: cannot be written: {e}", of.output.display()))?;
    events::wrote(&of.output);
    print(&format!("wrote {}\n", of.output.display()))?;
    Ok(0)
}

/// The lines of one file: one, or one for each harmonic of a degree of freedom.
fn of_file(of: &PlotArguments, stored: &Stored, name: &str) -> Outcome<Vec<Line>> {
    let hertz: Vec<f64> = stored.omega.iter().map(|w| w / TAU).collect();
    let line = |name: String, values: &[f64], marked: &[[f64; 2]]| Line {
        name,
        points: hertz.iter().copied().zip(values.iter().copied()).collect(),
        marked: marked.iter().map(|[w, a]| (w / TAU, *a)).collect(),
    };
    if of.damping {
        if stored.damping_ratio.is_empty() {
            return Err("has no damping ratio: it is that of no nonlinear mode".into());
        }
        let points = stored
            .log10_amplitude
            .iter()
            .copied()
            .zip(stored.damping_ratio.iter().copied());
        return Ok(vec![Line {
            name: name.to_owned(),
            points: points.collect(),
            marked: Vec::new(),
        }]);
    }
    if of.slip {
        if stored.contacts == 0 {
            return Err("has no contact".into());
        }
        let rows = stored.slip.chunks_exact(stored.contacts);
        let largest: Vec<f64> = rows.map(|row| row.iter().copied().fold(0.0, f64::max)).collect();
        return Ok(vec![line(name.to_owned(), &largest, &[])]);
    }
    if let Some(r) = of.response {
        let n = stored.omega.len();
        let values = stored.responses.get(r * n..(r + 1) * n);
        let values = values.ok_or_else(|| format!("has {} responses, needs --response {r}", stored.responses()))?;
        let peaks = stored.response_peaks.iter().filter(|row| row[0] as usize == r);
        let peaks: Vec<[f64; 2]> = peaks.map(|row| [row[1], row[2]]).collect();
        return Ok(vec![line(format!("{name}, response {r}"), values, &peaks)]);
    }
    let Some(dof) = &of.dof else {
        return Ok(vec![line(name.to_owned(), &stored.amplitude, &stored.peaks)]);
    };
    let dof = stored.dof(dof)?;
    let mut lines = Vec::new();
    for h in 0..stored.rows {
        let values: Vec<f64> = (0..hertz.len())
            .map(|p| stored.harmonics_at(p)[h * stored.ndof + dof].norm())
            .collect();
        let wanted = of.harmonic.is_none_or(|one| one == h);
        if wanted && values.iter().any(|v| *v > 0.0) {
            lines.push(line(format!("{name}, harmonic {h}"), &values, &[]));
        }
    }
    if lines.is_empty() {
        return Err("has no motion there".into());
    }
    Ok(lines)
}
