//! Fit of a job: parameters from data of tests, as a report, tables and a figure.

use crate::building::built::Built;
use crate::building::solver::solver;
use crate::job_file::job::Job;
use crate::job_file::job_fit::{FitPart, UnknownPart};
use crate::outputs::files::Files;
use crate::outputs::line_chart::{Chart, Line};
use crate::studies::fit_files::Data;
use crate::studies::map::Written;
use crate::studies::varied::{Keys, Varied};
use crate::texts::outcome::Outcome;
use hbvib::{Fit, FitOptions, Hooks, Loss, Status, Suspicion, Unknown, fit};
use serde_json::json;
use std::f64::consts::TAU;
use std::fmt::Write;
use std::fs;

/// Refuses what cannot be computed.
///
/// # Errors
/// A sentence.
pub fn check(job: &Job, part: &FitPart, built: &Built) -> Outcome<()> {
    varied(part, built)?;
    data(job, built)?;
    solver((part.harmonics, part.tolerance), part.response_dof.as_ref(), built)
        .map(|_| ())
        .map_err(|e| format!("[fit]: {e}"))
}

fn varied(part: &FitPart, built: &Built) -> Outcome<Vec<Varied>> {
    if part.parameter.is_empty() {
        return Err("[fit]: names no unknown: needs [[fit.parameter]]".into());
    }
    let one = |(i, part): (usize, &UnknownPart)| {
        let keys = Keys {
            parameter: part.parameter,
            contact: part.contact,
            dofs: &part.dofs,
        };
        Varied::new(&keys, built).map_err(|e| format!("[[fit.parameter]] {}: {e}", i + 1))
    };
    part.parameter.iter().enumerate().map(one).collect()
}

fn data(job: &Job, built: &Built) -> Outcome<Vec<Data>> {
    if job.data.is_empty() {
        return Err("[fit]: there are no data: needs [[data]]".into());
    }
    let one = |(i, part)| Data::read(part, built, &job.folder).map_err(|e| format!("[[data]] {}: {e}", i + 1));
    job.data.iter().enumerate().map(one).collect()
}

/// Computes and writes the fit.
///
/// # Errors
/// A sentence.
pub fn write(
    job: &Job,
    part: &FitPart,
    built: &Built,
    hooks: &mut Hooks<'_>,
    files: &mut Files<'_>,
) -> Outcome<Written> {
    let said = |e: &dyn std::fmt::Display| format!("[fit]: {e}");
    let varied = varied(part, built)?;
    let data = data(job, built)?;
    let solver = solver((part.harmonics, part.tolerance), part.response_dof.as_ref(), built).map_err(|e| said(&e))?;
    let parameters: Vec<_> = varied.iter().map(Varied::parameter).collect();
    let unknown = |part: &UnknownPart| Unknown {
        start: part.start,
        lower: part.lower,
        upper: part.upper,
        prior: part.prior.map(|[mean, sigma]| (mean, sigma)),
        tied_to: part.tied_to,
        data_set: part.data_set,
        ..Unknown::default()
    };
    let unknowns: Vec<_> = part.parameter.iter().map(unknown).collect();
    let sets: Vec<_> = data.iter().map(Data::set).collect();
    let defaults = FitOptions::default();
    let options = FitOptions {
        loss: part.huber.map_or(Loss::Square, Loss::Huber),
        starts: part.starts.unwrap_or(defaults.starts),
        scale_covariance: part.scale_covariance,
        ..defaults
    };
    let found = fit(&built.model, (&parameters, &unknowns), &sets, &solver, &options, hooks).map_err(|e| said(&e))?;
    let named = |(one, of): (&Varied, &UnknownPart)| match of.data_set {
        Some(set) => format!("{} of data set {}", one.label(), set + 1),
        None => one.label().to_owned(),
    };
    let names: Vec<String> = varied.iter().zip(&part.parameter).map(named).collect();
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    let text = report(&found, &names);
    files.write(part.report.as_deref(), &|path| {
        fs::write(path, &text).map_err(|e| e.to_string())
    });
    files.write(part.csv.as_deref(), &|path| {
        fs::write(path, table(&found, &data)).map_err(|e| e.to_string())
    });
    files.write(part.json.as_deref(), &|path| {
        let text = serde_json::to_string_pretty(&numbers(&found, &names)).map_err(|e| e.to_string())?;
        fs::write(path, text + "\n").map_err(|e| e.to_string())
    });
    files.write(part.figure.as_deref(), &|path| chart(&found, &data).write(path));
    files.write(part.residual_figure.as_deref(), &|path| {
        residual_chart(&found, &data).write(path)
    });
    Ok((text, found.status != Status::Ok))
}

/// Standard deviation of a parameter.
fn deviation(found: &Fit, k: usize) -> f64 {
    found.covariance[k * found.theta.len() + k].sqrt()
}

fn correlation(found: &Fit, i: usize, j: usize) -> f64 {
    found.covariance[i * found.theta.len() + j] / (deviation(found, i) * deviation(found, j))
}

fn report(found: &Fit, names: &[&str]) -> String {
    let width = names.iter().map(|name| name.chars().count()).max().unwrap_or(0).max(9);
    let mut text = format!(
        "{:width$} {:>14} {:>12}  correlations\n",
        "parameter", "value", "deviation"
    );
    for (i, name) in names.iter().enumerate() {
        let _ = write!(
            text,
            "{name:width$} {:>14.6e} {:>12.3e} ",
            found.theta[i],
            deviation(found, i)
        );
        for j in 0..names.len() {
            let _ = write!(text, " {:>6.3}", correlation(found, i, j));
        }
        text += if found.at_bound[i] { "  at a bound\n" } else { "\n" };
    }
    let _ = writeln!(
        text,
        "chi2 {:.6e} on {} degrees of freedom, {} data; AIC {:.6e}, BIC {:.6e}",
        found.chi2,
        found.degrees_of_freedom,
        found.data,
        found.aic(),
        found.bic()
    );
    let slipping = found.slips.iter().filter(|slips| **slips).count();
    let _ = writeln!(
        text,
        "{} iterations from {} starts; {slipping} of {} contacts slip",
        found.iterations,
        found.starts,
        found.slips.len()
    );
    if found.harmonic_error.is_finite() {
        let _ = writeln!(
            text,
            "errors by harmonics are below {:.2e} standard deviations",
            found.harmonic_error
        );
    }
    if found.suspicion != Suspicion::None {
        let _ = writeln!(text, "warning: {}", found.suspicion.sentence());
    }
    if found.status != Status::Ok {
        let _ = writeln!(text, "the search ended early: {}", found.status.sentence());
    }
    text
}

fn table(found: &Fit, data: &[Data]) -> String {
    let mut text = String::from("set,x,first,second,model_first,model_second,residual_first,residual_second\n");
    let mut numbers = found.values.chunks_exact(2).zip(found.residuals.chunks_exact(2));
    for (number, set) in data.iter().enumerate() {
        for (x, z) in set.x.iter().zip(&set.value) {
            let Some((value, residual)) = numbers.next() else { break };
            let _ = writeln!(
                text,
                "{},{x:.16e},{:.16e},{:.16e},{:.16e},{:.16e},{:.6e},{:.6e}",
                number + 1,
                z.re,
                z.im,
                value[0],
                value[1],
                residual[0],
                residual[1]
            );
        }
    }
    text
}

fn numbers(found: &Fit, names: &[&str]) -> serde_json::Value {
    let p = names.len();
    let rows: Vec<&[f64]> = found.covariance.chunks_exact(p.max(1)).collect();
    let deviations: Vec<f64> = (0..p).map(|k| deviation(found, k)).collect();
    json!({
        "parameters": names,
        "theta": found.theta,
        "deviation": deviations,
        "covariance": rows,
        "at_bound": found.at_bound,
        "chi2": found.chi2,
        "degrees_of_freedom": found.degrees_of_freedom,
        "data": found.data,
        "aic": found.aic(),
        "bic": found.bic(),
        "condition": found.condition,
        "iterations": found.iterations,
        "starts": found.starts,
        "harmonic_error": found.harmonic_error.is_finite().then_some(found.harmonic_error),
        "suspicion": found.suspicion.sentence(),
        "finished": found.status == Status::Ok,
    })
}

/// Data as marks on the lines of the model: responses and amplitudes over the frequency; without any, frequencies of backbones over the
/// modal amplitude.
fn chart(found: &Fit, data: &[Data]) -> Chart {
    let responses = lines(found, data, |set, x, [first, second]| {
        Some((x / TAU, set.size(first, second)?))
    });
    if !responses.is_empty() {
        return Chart {
            title: "fit: lines of the model, marks of the data".into(),
            x_label: "frequency, Hz".into(),
            y_label: "amplitude".into(),
            log_x: false,
            log_y: true,
            markers: false,
            lines: responses,
        };
    }
    Chart {
        title: "fit: lines of the model, marks of the data".into(),
        x_label: "log10 of the modal amplitude".into(),
        y_label: "frequency, Hz".into(),
        log_x: false,
        log_y: false,
        markers: false,
        lines: lines(found, data, |set, x, [first, _]| {
            set.is_backbone().then_some((x, first / TAU))
        }),
    }
}

/// A line for each set that `place` has points of, in the order of their abscissas.
fn lines(found: &Fit, data: &[Data], place: impl Fn(&Data, f64, [f64; 2]) -> Option<(f64, f64)>) -> Vec<Line> {
    let mut values = found.values.chunks_exact(2);
    let mut lines = Vec::new();
    for (number, set) in data.iter().enumerate() {
        let mut line = Line {
            name: format!("data set {}", number + 1),
            points: Vec::new(),
            marked: Vec::new(),
        };
        for (x, z) in set.x.iter().zip(&set.value) {
            let Some(value) = values.next() else { break };
            line.points.extend(place(set, *x, [value[0], value[1]]));
            line.marked.extend(place(set, *x, [z.re, z.im]));
        }
        line.points.sort_by(|a, b| a.0.total_cmp(&b.0));
        if !line.points.is_empty() {
            lines.push(line);
        }
    }
    lines
}

/// Residuals in standard deviations as marks, datum after datum, between lines at two of them, within which 95 of a hundred lie.
fn residual_chart(found: &Fit, data: &[Data]) -> Chart {
    let mut residuals = found.residuals.chunks_exact(2);
    let mut lines = Vec::new();
    let mut number = 0.0;
    for (i, set) in data.iter().enumerate() {
        let mut line = Line {
            name: format!("data set {}", i + 1),
            points: Vec::new(),
            marked: Vec::new(),
        };
        for residual in residuals.by_ref().take(set.x.len()) {
            number += 1.0;
            let own = residual.iter().zip(set.counts()).filter(|(_, counts)| *counts);
            line.marked.extend(own.map(|(r, _)| (number, *r)));
        }
        lines.push(line);
    }
    for (name, height) in [("2 deviations", 2.0), ("-2 deviations", -2.0)] {
        lines.push(Line {
            name: name.into(),
            points: vec![(0.0, height), (number + 1.0, height)],
            marked: Vec::new(),
        });
    }
    Chart {
        title: "fit: residuals in standard deviations".into(),
        x_label: "number of the datum".into(),
        y_label: "(model - datum) / deviation".into(),
        log_x: false,
        log_y: false,
        markers: false,
        lines,
    }
}
