//! The responses that a forced response watches, as they are read at its points.

use crate::continuation::PointAt;
use crate::error::{Error, Result, try_push};
use crate::options::Response;
use crate::problem::gauges::Seen;
use crate::problem::harmonic_balance::HarmonicBalance;
use crate::results::SeenWithError;
use num_complex::Complex64;
use std::hash::{DefaultHasher, Hasher as _};

const CONTEXT: &str = "the responses";

/// Points whose readings are kept: the ends of a step, and the peaks between them.
/// Kind: cap.
const MOST_RECENT: usize = 64;

/// Key of a point: a hash of its unknowns and tangent, and its resolution. Solutions at one frequency may differ in
/// any unknown; some, as the mean of a sector, are zero in all.
type Key = (u64, usize);

/// Requested responses of a run, with their values at recent points.
pub(crate) struct WatchedResponses<'a> {
    /// The requested responses.
    pub list: &'a [Response<'a>],
    /// Whether the tolerance holds for the norm of all responses.
    pub together: bool,
    /// Values of the responses at the point recorded last, with their errors.
    pub seen: Vec<SeenWithError>,
    /// Values of the responses at the point whose error is estimated, in the caller's unit.
    pub watched: Vec<Complex64>,
    /// Points that were read recently, the last one first.
    recent: Vec<(Key, Vec<Seen>)>,
}

fn key((point, resolution): PointAt<'_>) -> Key {
    let mut hasher = DefaultHasher::new();
    for value in point.v.iter().chain(&point.tangent) {
        hasher.write_u64(value.to_bits());
    }
    (hasher.finish(), resolution)
}

impl<'a> WatchedResponses<'a> {
    /// The responses of `list`, none of them read yet.
    pub fn new(list: &'a [Response<'a>], together: bool) -> Self {
        Self {
            list,
            together,
            seen: Vec::new(),
            watched: Vec::new(),
            recent: Vec::new(),
        }
    }

    /// Whether the first response is the amplitude that every forced response observes.
    pub fn is_observed(&self) -> bool {
        self.list.first().is_some_and(Response::is_plain)
    }

    /// Reads the responses at a point whose error is estimated; `length` is the unit of the problem.
    pub fn read(&mut self, problem: &mut HarmonicBalance<'_>, at: PointAt<'_>, length: f64) -> Result<()> {
        let mut watched = core::mem::take(&mut self.watched);
        watched.clear();
        if !self.list.is_empty() {
            for seen in self.read_at(problem, at)? {
                try_push(&mut watched, seen.observed().0 * length, CONTEXT)?;
            }
        }
        self.watched = watched;
        Ok(())
    }

    /// Reads the responses at a point to record; `errors` are their errors, if known.
    pub fn see(&mut self, problem: &mut HarmonicBalance<'_>, at: PointAt<'_>, errors: &[f64]) -> Result<()> {
        self.seen.clear();
        if self.list.is_empty() {
            return Ok(());
        }
        let mut found = Vec::new();
        for (r, seen) in self.read_at(problem, at)?.iter().enumerate() {
            let error = errors.get(r).copied().unwrap_or(f64::NAN);
            try_push(&mut found, SeenWithError { seen: *seen, error }, CONTEXT)?;
        }
        self.seen = found;
        Ok(())
    }

    /// Values of all responses at a point, possibly from an earlier reading.
    pub fn read_at(&mut self, problem: &mut HarmonicBalance<'_>, at: PointAt<'_>) -> Result<&[Seen]> {
        let wanted = key(at);
        if let Some(known) = self.recent.iter().position(|(key, _)| *key == wanted) {
            self.recent[..=known].rotate_right(1);
            return Ok(&self.recent[0].1);
        }
        let mut seen = if self.recent.len() < MOST_RECENT {
            Vec::new()
        } else {
            self.recent.pop().map_or_else(Vec::new, |(_, seen)| seen)
        };
        problem.see_all(&at.0.v, &at.0.tangent, &mut seen)?;
        self.recent.try_reserve(1).map_err(|_| Error::out_of_memory(CONTEXT))?;
        self.recent.insert(0, (wanted, seen));
        Ok(&self.recent[0].1)
    }

    /// Whether the responses at a point were read recently.
    pub fn has_read(&self, at: PointAt<'_>) -> bool {
        let wanted = key(at);
        self.recent.iter().any(|(key, _)| *key == wanted)
    }
}
