//! One forced response, complete or refused, at a few named degrees of freedom, and its JSON.
#![allow(dead_code, reason = "each example uses a part of this module")]

use std::error::Error;
use std::f64::consts::TAU;
use std::time::{Duration, Instant};

use hbvib::{Branch, ForcedOptions, Hooks, Model, Progress, SolverOptions, Status, forced_response};
use num_complex::Complex64;
use serde_json::{Map, Value};

use crate::json::number;

/// A range of frequency, and frequencies within it at which every solution is listed, in Hz.
#[derive(Clone, Debug, Default)]
pub struct Range {
    /// First frequency.
    pub from: f64,
    /// Last frequency; it may lie below the first.
    pub to: f64,
    /// Frequencies at which every solution is listed, in this order.
    pub at: Vec<f64>,
}

/// Every carried harmonic: its number, and `X_p` of each reported degree of freedom.
pub type Harmonics = Vec<(usize, Vec<Complex64>)>;

/// A solution: motion of sector 1, x(t) = Re Σ `X_p` exp(i p ω t).
#[derive(Clone, Debug)]
pub struct Point {
    /// Number of the point in the branch.
    pub number: usize,
    /// Frequency of the force, Hz.
    pub frequency: f64,
    /// Motion in each carried harmonic.
    pub harmonics: Harmonics,
    /// Estimated relative error of `X_1` of the first reported degree of freedom, if a tolerance chose the
    /// harmonics; not finite if it is unknown.
    pub error: Option<f64>,
}

impl Point {
    /// `X_1` of the first reported degree of freedom.
    pub fn fundamental(&self) -> Complex64 {
        let first = self.harmonics.iter().find(|h| h.0 == 1);
        first.map_or(Complex64::ZERO, |h| h.1[0])
    }

    /// Absolute value of the fundamental.
    pub fn amplitude(&self) -> f64 {
        self.fundamental().norm()
    }
}

/// A response over the whole of a range.
#[derive(Debug)]
pub struct Response {
    /// The curve from exactly the first frequency to exactly the last.
    pub points: Vec<Point>,
    /// The point of largest amplitude, possibly an end of the range.
    pub peak: Point,
    /// Every solution at the requested frequencies, in the requested order.
    pub at: Vec<Point>,
    /// Whether rounding kept the residual of a point above the tolerance of the solver.
    pub stalled: bool,
    /// Whether some point exceeds the tolerance.
    pub missed: bool,
    /// All that the library returned.
    pub branch: Branch,
    /// Time of the parts of the computation.
    pub times: Times,
}

/// Time of the parts of a response.
#[derive(Clone, Copy, Debug, Default)]
pub struct Times {
    /// Condensation and the first point.
    pub first_point: Duration,
    /// The points after the first, with the peaks and the requested frequencies.
    pub curve: Duration,
    /// Recovery of the motion from that of the contacts.
    pub recovery: Duration,
}

impl Response {
    /// Follows the response of a model and reports the completed share of the range. The first of the degrees of
    /// freedom `reported` is the response degree of freedom: its fundamental defines the peak.
    ///
    /// # Errors
    ///
    /// If the model or an option is refused, or the response could not be followed to its end.
    pub fn follow(
        model: &Model,
        solver: &SolverOptions,
        range: &Range,
        reported: &[usize],
        mut progress: impl FnMut(f64),
    ) -> Result<Self, Box<dyn Error>> {
        let solver = SolverOptions {
            response_dof: reported.first().copied(),
            ..*solver
        };
        let at: Vec<f64> = range.at.iter().map(|f| f * TAU).collect();
        let options = ForcedOptions {
            omega_start: range.from * TAU,
            omega_stop: range.to * TAU,
            at: &at,
            guess: None,
            responses: &[],
            together: false,
            ..ForcedOptions::default()
        };
        let begin = Instant::now();
        let mut first = None;
        let mut report = |state: &Progress| {
            first.get_or_insert_with(|| begin.elapsed());
            progress(state.fraction_done);
            false
        };
        let mut hooks = Hooks {
            progress: Some(&mut report),
            ..Hooks::default()
        };
        let branch = forced_response(model, &solver, &options, &mut hooks)?;
        let end = branch.omega().last().copied().unwrap_or(f64::NAN);
        if end.to_bits() != options.omega_stop.to_bits() {
            let reason = branch.status().name().to_string_lossy();
            return Err(format!(
                "the response ends at {} Hz ({reason}), before {} Hz",
                end / TAU,
                range.to
            )
            .into());
        }
        let solved = begin.elapsed();
        let mut response = Self::collect(branch, range, reported)?;
        if solver.tolerance == 0.0 {
            response.forget_errors();
        }
        let first_point = first.unwrap_or(solved);
        response.times = Times {
            first_point,
            curve: solved.saturating_sub(first_point),
            recovery: begin.elapsed().saturating_sub(solved),
        };
        Ok(response)
    }

    fn collect(branch: Branch, range: &Range, reported: &[usize]) -> Result<Self, Box<dyn Error>> {
        // The conversion from Hz to rad/s and back may change the last digit: given frequencies are kept exactly.
        let given = |omega: f64| {
            let mut known = [range.from, range.to].into_iter();
            let found = known.find(|f| (f * TAU).to_bits() == omega.to_bits());
            found.unwrap_or(omega / TAU)
        };
        let curve = branch.omega().iter().enumerate();
        let points: Vec<Point> = curve
            .map(|(i, &omega)| point(&branch, i, given(omega), reported))
            .collect::<Result<_, _>>()?;
        let mut at = Vec::new();
        for (i, &frequency) in range.at.iter().enumerate() {
            if branch.at(i).is_empty() {
                return Err(format!("no solution was found at {frequency} Hz").into());
            }
            for special in branch.at(i) {
                at.push(point(&branch, special.point, frequency, reported)?);
            }
        }
        let maxima = branch.peaks().iter();
        let maxima: Vec<Point> = maxima
            .map(|p| point(&branch, p.point, given(p.omega), reported))
            .collect::<Result<_, _>>()?;
        let all = maxima.iter().chain(&points).chain(&at);
        let peak = all.reduce(|best, p| if p.amplitude() > best.amplitude() { p } else { best });
        let peak = peak.ok_or("the response has no points")?.clone();
        Ok(Self {
            points,
            peak,
            at,
            stalled: branch.status() == Status::StoppedStalled,
            missed: branch.status() == Status::StoppedMaxHarmonics,
            branch,
            times: Times::default(),
        })
    }

    fn forget_errors(&mut self) {
        let points = self.points.iter_mut().chain(&mut self.at);
        for point in points.chain(core::iter::once(&mut self.peak)) {
            point.error = None;
        }
    }

    /// Newton iterations of the points on the curve, without those of peaks and requested frequencies.
    pub fn iterations(&self) -> usize {
        self.branch.newton_iterations().iter().sum::<f64>() as usize
    }

    /// The response as JSON; `amplitude` names the amplitude, `names` the reported degrees of freedom.
    ///
    /// # Errors
    ///
    /// If a number is not finite.
    pub fn to_json(&self, amplitude: &str, names: &[&str]) -> Result<Value, Box<dyn Error>> {
        let one = |point: &Point| point_to_json(point, amplitude, names);
        let list = |points: &[Point]| points.iter().map(one).collect::<Result<Vec<_>, _>>();
        let mut object = Map::new();
        object.insert("points".into(), list(&self.points)?.into());
        object.insert("peak".into(), one(&self.peak)?);
        object.insert("at".into(), list(&self.at)?.into());
        Ok(object.into())
    }
}

fn point(branch: &Branch, number: usize, frequency: f64, reported: &[usize]) -> Result<Point, Box<dyn Error>> {
    let carried = branch.carried_at(number).unwrap_or(&[]).iter().copied();
    let harmonics = match branch.response_at(number) {
        // The motion of the response degree of freedom is stored; others are recovered with the whole structure.
        Some(response) if reported == [branch.response_dof()] => {
            carried.zip(response.iter().map(|&x| vec![x])).collect()
        }
        _ => harmonics(branch, number, reported)?,
    };
    Ok(Point {
        number,
        frequency,
        harmonics,
        error: branch.error_estimate_at(number),
    })
}

/// The motion at a point of a branch.
///
/// # Errors
///
/// If the library refuses the point.
pub fn harmonics(branch: &Branch, number: usize, reported: &[usize]) -> Result<Harmonics, Box<dyn Error>> {
    let n = branch.ndof();
    let mut all = vec![Complex64::ZERO; (branch.harmonics() + 1) * n];
    branch.harmonics_at(number, &mut all)?;
    let of = |p: usize| reported.iter().map(|dof| all[p * n + dof]).collect();
    Ok(branch
        .carried_at(number)
        .unwrap_or(&[])
        .iter()
        .map(|&p| (p, of(p)))
        .collect())
}

fn point_to_json(point: &Point, amplitude: &str, names: &[&str]) -> Result<Value, Box<dyn Error>> {
    let mut object = Map::new();
    object.insert("frequency_hz".into(), number(point.frequency)?);
    object.insert(amplitude.into(), number(point.amplitude())?);
    object.insert("harmonics".into(), harmonics_to_json(&point.harmonics, names)?);
    if let Some(error) = point.error {
        object.insert("error_estimate".into(), error_to_json(error));
        object.insert("harmonics_used".into(), highest(&point.harmonics).into());
    }
    Ok(object.into())
}

/// The highest carried harmonic number.
pub fn highest(harmonics: &Harmonics) -> usize {
    harmonics.last().map_or(0, |h| h.0)
}

/// An error, null if it is unknown.
pub fn error_to_json(error: f64) -> Value {
    serde_json::Number::from_f64(error).map_or(Value::Null, Value::Number)
}

/// Real and imaginary part of each harmonic of each degree of freedom, by their names.
///
/// # Errors
///
/// If a number is not finite.
pub fn harmonics_to_json(carried: &[(usize, Vec<Complex64>)], names: &[&str]) -> Result<Value, Box<dyn Error>> {
    let mut harmonics = Map::new();
    for (dof, &name) in names.iter().enumerate() {
        let mut of_dof = Map::new();
        for (p, x) in carried {
            let pair = vec![number(x[dof].re)?, number(x[dof].im)?];
            of_dof.insert(p.to_string(), pair.into());
        }
        harmonics.insert(name.into(), of_dof.into());
    }
    Ok(harmonics.into())
}
