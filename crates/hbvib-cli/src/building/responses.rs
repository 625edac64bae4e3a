//! The responses that a job watches: from its tables to the library, and what the summary tells of them.

use crate::building::built::Built;
use crate::job_file::job::Job;
use crate::job_file::job_response::ComponentName;
use crate::job_file::job_response::MeasureName;
use crate::job_file::job_response::ResponsePart;
use crate::outputs::curve::Curve;
use crate::texts::counted::counted;
use crate::texts::outcome::Outcome;
use hbvib::{Component, Measure, Response};
use std::f64::consts::TAU;
use std::fmt::Write as _;

/// Degrees of freedom of each response.
///
/// # Errors
/// A sentence: an unknown degree of freedom, a harmonic without its measure or the other way round.
pub fn dofs(parts: &[ResponsePart], built: &Built) -> Outcome<Vec<Vec<usize>>> {
    let of_part = |(i, part): (usize, &ResponsePart)| -> Outcome<Vec<usize>> {
        if part.harmonic.is_some() != (part.measure == MeasureName::Harmonic) {
            return Err(format!(
                "[[response]] {i}: harmonic goes with measure = \"harmonic\", and that needs it"
            ));
        }
        let named = part.dofs.iter().map(|name| built.nodes.dof(name));
        let found: Result<Vec<usize>, String> = named.collect();
        found.map_err(|e| format!("[[response]] {i}: dofs: {e}"))
    };
    parts.iter().enumerate().map(of_part).collect()
}

/// The responses, with their degrees of freedom.
pub fn responses<'a>(parts: &'a [ResponsePart], dofs: &'a [Vec<usize>]) -> Vec<Response<'a>> {
    let one = |(part, dofs): (&'a ResponsePart, &'a Vec<usize>)| Response {
        measure: match part.measure {
            MeasureName::Fundamental => Measure::Fundamental,
            MeasureName::Harmonic => Measure::Harmonic(part.harmonic.unwrap_or(1)),
            MeasureName::Peak => Measure::Peak,
            MeasureName::Rms => Measure::Rms,
            MeasureName::Range => Measure::Range,
        },
        dofs,
        weights: &part.weights,
        sector: part.sector,
        component: match part.component {
            ComponentName::Displacement => Component::Displacement,
            ComponentName::Velocity => Component::Velocity,
            ComponentName::Acceleration => Component::Acceleration,
        },
    };
    parts.iter().zip(dofs).map(one).collect()
}

/// The amplitude of a job's points and its unit, where the job names that of length: the first response or, without any, the
/// fundamental of the response degree of freedom.
pub fn amplitude(job: &Job) -> (String, Option<String>) {
    let length = job.output.units.length.as_deref();
    let parts = job.forced.as_ref().map_or(&[][..], |_| &job.response);
    let Some(first) = parts.first() else {
        return (
            "amplitude of the response degree of freedom".into(),
            length.map(str::to_owned),
        );
    };
    let (component, by_time) = match first.component {
        ComponentName::Displacement => ("displacement", ""),
        ComponentName::Velocity => ("velocity", "/s"),
        ComponentName::Acceleration => ("acceleration", "/s2"),
    };
    let measure = match first.measure {
        MeasureName::Fundamental => "amplitude of the fundamental".to_owned(),
        MeasureName::Harmonic => format!("amplitude of harmonic {}", first.harmonic.unwrap_or(1)),
        MeasureName::Peak => "largest value over a period".to_owned(),
        MeasureName::Rms => "root mean square".to_owned(),
        MeasureName::Range => "largest less smallest value over a period".to_owned(),
    };
    let name = format!("{measure} of the {component} of response 0");
    (name, length.map(|length| format!("{length}{by_time}")))
}

/// The highest peak of each response, a line each.
pub fn summary(curve: &Curve<'_>) -> String {
    let peaks = curve.response_peaks();
    let mut text = String::new();
    for r in 0..curve.branch.responses().len() {
        let of = || peaks.iter().filter(|row| row[0] as usize == r);
        let _ = match of().max_by(|a, b| a[2].total_cmp(&b[2])) {
            Some([_, omega, amplitude]) => writeln!(
                text,
                "response {r}: {}, the highest {amplitude:.6e} at {:.6} Hz",
                counted(of().count(), "peak"),
                omega / TAU
            ),
            None => writeln!(text, "response {r}: no peak"),
        };
    }
    text
}
