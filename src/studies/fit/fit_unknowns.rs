//! Unknowns of a fit: parameters of the model with start, bounds, prior, scale and ties.

use crate::error::{Result, fail, try_push, try_vec};
use crate::model::Model;
use crate::model::matrices::speed::Speed;
use crate::sensitivity::Parameter;
use core::fmt;

const CONTEXT: &str = "the unknowns of a fit";

/// Scale in which an unknown is changed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Scale {
    /// Logarithm, for stiffnesses, friction, loads and factors that start above 0; otherwise the value itself.
    #[default]
    Automatic,
    /// The value itself.
    Linear,
    /// Logarithm of the value, which therefore stays above 0.
    Log,
}

/// A parameter as an unknown of a fit.
#[derive(Clone, Copy, Debug, Default)]
pub struct Unknown {
    /// Value at the start of the search; `None`: the value that the model has.
    pub start: Option<f64>,
    /// Smallest value allowed. If it equals the largest one, the parameter is fixed.
    pub lower: Option<f64>,
    /// Largest value allowed.
    pub upper: Option<f64>,
    /// Prior knowledge of the parameter beside the data: mean and standard deviation.
    pub prior: Option<(f64, f64)>,
    /// Scale in which the parameter is changed.
    pub scale: Scale,
    /// Index of an earlier parameter whose value this one follows, in the ratio of their starts.
    pub tied_to: Option<usize>,
    /// Index of the only data set that has this parameter, as each test has its own residual state; `None`: all sets
    /// have it.
    pub data_set: Option<usize>,
}

/// A parameter to be printed in words.
pub(super) struct Named<'a>(pub &'a Parameter<'a>);

impl fmt::Display for Named<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            Parameter::Force => write!(f, "the factor of the forces"),
            Parameter::Contact { constant, contact } => match contact {
                Some(id) => write!(f, "{} of contact {id}", constant.name()),
                None => write!(f, "{} of all contacts", constant.name()),
            },
            Parameter::Direction { which, .. } => write!(f, "the coefficient of a {} matrix", which.name()),
            Parameter::Factor { which } => write!(f, "the factor of the {} matrix", which.name()),
            Parameter::Speed => write!(f, "the speed"),
        }
    }
}

/// The value of a parameter in the model.
fn present(model: &Model, parameter: &Parameter<'_>) -> f64 {
    match parameter {
        Parameter::Force | Parameter::Factor { .. } => 1.0,
        Parameter::Direction { .. } => 0.0,
        Parameter::Speed => match model.speed() {
            Speed::Fixed(speed) | Speed::PerOmega(speed) => speed,
        },
        Parameter::Contact { constant, contact } => {
            let of = |c: &&crate::contact::Contact| c.by_constant(*constant).is_some();
            let mut all = model.contacts().iter();
            let first = contact.map_or_else(|| all.find(of), |id| model.contacts().get(id));
            first.map_or(0.0, |contact| contact.constant(*constant))
        }
    }
}

/// Whether a parameter has no meaning below 0.
fn is_positive(parameter: &Parameter<'_>) -> bool {
    match parameter {
        Parameter::Force | Parameter::Factor { .. } => true,
        Parameter::Contact { constant, .. } => !constant.has_any_sign(),
        Parameter::Direction { .. } | Parameter::Speed => false,
    }
}

/// Dependence of one parameter on the free unknowns.
#[derive(Clone, Copy, Debug)]
struct Entry {
    /// Index of the free unknown; `None`: the parameter is fixed.
    free: Option<usize>,
    /// Value over that of the free unknown; for a fixed parameter the value itself.
    ratio: f64,
}

/// An unknown that the search may change.
#[derive(Clone, Copy, Debug)]
pub(super) struct Free {
    /// Index of its parameter.
    pub parameter: usize,
    pub is_log: bool,
    /// Bounds of the unknown, in its scale.
    pub lower: f64,
    pub upper: f64,
    /// Start of the unknown, in its scale.
    pub start: f64,
    /// Mean and standard deviation of its prior, for the value itself.
    pub prior: Option<(f64, f64)>,
}

/// The free unknowns of a fit, and the dependence of all parameters on them.
#[derive(Debug)]
pub(super) struct Unknowns {
    entries: Vec<Entry>,
    pub free: Vec<Free>,
    /// For each parameter, the data set that alone has it; `None`: all sets have it.
    pub scopes: Vec<Option<usize>>,
}

impl Unknowns {
    /// Checks the `unknowns`, one for each of the `parameters`, and lists the free ones. A start that is not given is
    /// the value in `model`.
    ///
    /// # Errors
    /// `Dimension`, `Argument` or `NotFinite`, naming the unknown; `OutOfMemory`.
    pub fn new(
        model: &Model,
        (parameters, unknowns): (&[Parameter<'_>], &[Unknown]),
        data_sets: usize,
    ) -> Result<Self> {
        if unknowns.len() != parameters.len() {
            return fail!(
                Dimension,
                "{} unknowns for {} parameters",
                unknowns.len(),
                parameters.len()
            );
        }
        let mut found = Self {
            entries: Vec::new(),
            free: Vec::new(),
            scopes: Vec::new(),
        };
        let mut starts: Vec<f64> = Vec::new();
        for (i, (parameter, unknown)) in parameters.iter().zip(unknowns).enumerate() {
            if let Some(set) = unknown.data_set.filter(|set| *set >= data_sets) {
                return fail!(
                    Argument,
                    "unknown {i}, {}: data_set = {set}, needs a number below {data_sets}, that of the data sets",
                    Named(parameter)
                );
            }
            let is_apart = |j: usize| match (unknown.data_set, unknowns[j].data_set) {
                (Some(a), Some(b)) => a != b,
                _ => false,
            };
            if let Some(j) = (0..i).find(|&j| parameter.sets_the_same_as(&parameters[j]) && !is_apart(j)) {
                return fail!(
                    Argument,
                    "unknown {i}: {} is that of unknown {j} already",
                    Named(parameter)
                );
            }
            let start = unknown.start.unwrap_or_else(|| present(model, parameter));
            try_push(&mut starts, start, CONTEXT)?;
            let entry = found
                .entry(parameter, unknown, i, start, &starts)
                .map_err(|e| e.at(format_args!("unknown {i}, {}", Named(parameter))))?;
            try_push(&mut found.entries, entry, CONTEXT)?;
            try_push(&mut found.scopes, unknown.data_set, CONTEXT)?;
        }
        Ok(found)
    }

    fn entry(
        &mut self,
        parameter: &Parameter<'_>,
        unknown: &Unknown,
        i: usize,
        start: f64,
        starts: &[f64],
    ) -> Result<Entry> {
        if let Some(leader) = unknown.tied_to {
            let Some(entry) = self.entries.get(leader).copied() else {
                return fail!(Argument, "tied_to = {leader}, needs the number of an earlier unknown");
            };
            if starts[leader] == 0.0 {
                return fail!(Argument, "tied_to = {leader}, whose start is 0; needs another one");
            }
            let ratio = start / starts[leader] * entry.ratio;
            return Ok(Entry { ratio, ..entry });
        }
        let positive = is_positive(parameter);
        let least = if positive { 0.0 } else { f64::NEG_INFINITY };
        let (lower, upper) = (unknown.lower.unwrap_or(least), unknown.upper.unwrap_or(f64::INFINITY));
        if !start.is_finite() {
            return fail!(NotFinite, "start = {start}, needs a finite number");
        }
        if !(lower <= start && start <= upper) {
            return fail!(Argument, "start = {start}, needs a number within {lower} .. {upper}");
        }
        if positive && lower < 0.0 {
            return fail!(Argument, "lower = {lower}, needs a number >= 0");
        }
        if let Some((mean, sigma)) = unknown.prior
            && !(mean.is_finite() && sigma > 0.0 && sigma.is_finite())
        {
            return fail!(
                Argument,
                "prior = {mean} +- {sigma}, needs finite numbers, the second > 0"
            );
        }
        if lower >= upper {
            return Ok(Entry {
                free: None,
                ratio: start,
            });
        }
        let is_log = match unknown.scale {
            Scale::Automatic => positive && start > 0.0,
            Scale::Linear => false,
            Scale::Log if start > 0.0 && lower >= 0.0 => true,
            Scale::Log => return fail!(Argument, "start = {start}, needs a number > 0 on a logarithmic scale"),
        };
        let scaled = |x: f64| if is_log { x.ln() } else { x };
        let free = Free {
            parameter: i,
            is_log,
            lower: scaled(lower),
            upper: scaled(upper),
            start: scaled(start),
            prior: unknown.prior,
        };
        try_push(&mut self.free, free, CONTEXT)?;
        Ok(Entry {
            free: Some(self.free.len() - 1),
            ratio: 1.0,
        })
    }

    /// Number of parameters of the fit.
    pub fn parameters(&self) -> usize {
        self.entries.len()
    }

    /// Value of the k-th free unknown from its scaled number z.
    pub fn value(&self, k: usize, z: f64) -> f64 {
        if self.free[k].is_log { z.exp() } else { z }
    }

    /// Values of all parameters from the scaled free unknowns.
    pub fn theta(&self, z: &[f64]) -> Result<Vec<f64>> {
        let mut theta = try_vec(self.entries.len(), 0.0, CONTEXT)?;
        for (to, entry) in theta.iter_mut().zip(&self.entries) {
            *to = entry.free.map_or(1.0, |k| self.value(k, z[k])) * entry.ratio;
        }
        Ok(theta)
    }

    /// Index of the free unknown on which a parameter depends, and derivative of its value by the scaled unknown;
    /// `None` for a fixed parameter.
    pub fn slope(&self, parameter: usize, z: &[f64]) -> Option<(usize, f64)> {
        let entry = self.entries[parameter];
        let k = entry.free?;
        let own = if self.free[k].is_log { z[k].exp() } else { 1.0 };
        Some((k, own * entry.ratio))
    }
}
