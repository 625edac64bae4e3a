//! The responses that a forced response watches, as they are read at its points.

use crate::continuation::PointAt;
use crate::error::{Result, try_push};
use crate::options::Response;
use crate::problem::gauges::Seen;
use crate::problem::harmonic_balance::HarmonicBalance;
use crate::results::SeenWithError;
use num_complex::Complex64;

const CONTEXT: &str = "the responses";

/// A point by its frequency, its first unknown and its resolution.
type Key = (u64, u64, usize);

/// Responses of a run, and what they are at the last points.
pub(super) struct WatchedResponses<'a> {
    /// The responses that were asked for.
    pub list: &'a [Response<'a>],
    /// What they are at the point recorded last.
    pub seen: Vec<SeenWithError>,
    /// Their values at the point that is estimated, in the caller's unit.
    pub watched: Vec<Complex64>,
    /// The last two points that were recorded.
    recent: [Option<(Key, Vec<Seen>)>; 2],
    memory: Vec<Seen>,
}

fn key((point, resolution): PointAt<'_>) -> Key {
    let first = point.v.first().copied().unwrap_or(0.0);
    (point.parameter().to_bits(), first.to_bits(), resolution)
}

impl<'a> WatchedResponses<'a> {
    /// Nothing read yet.
    pub fn new(list: &'a [Response<'a>]) -> Self {
        Self {
            list,
            seen: Vec::new(),
            watched: Vec::new(),
            recent: [None, None],
            memory: Vec::new(),
        }
    }

    /// Whether the first response is the amplitude that every forced response observes.
    pub fn is_observed(&self) -> bool {
        self.list.first().is_some_and(Response::is_plain)
    }

    /// Reads the values at a point whose error is estimated, in a unit of this length.
    pub fn read(
        &mut self,
        problem: &mut HarmonicBalance<'_>,
        point: &[f64],
        tangent: &[f64],
        length: f64,
    ) -> Result<()> {
        problem.see_all(point, tangent, &mut self.memory)?;
        self.watched.clear();
        for seen in &self.memory {
            try_push(&mut self.watched, seen.observed().0 * length, CONTEXT)?;
        }
        Ok(())
    }

    /// Reads a point that is recorded, with the errors of the responses there, if they are known.
    pub fn see(&mut self, problem: &mut HarmonicBalance<'_>, at: PointAt<'_>, errors: &[f64]) -> Result<()> {
        self.seen.clear();
        if self.list.is_empty() {
            return Ok(());
        }
        problem.see_all(&at.0.v, &at.0.tangent, &mut self.memory)?;
        let mut kept = Vec::new();
        for (r, seen) in self.memory.iter().enumerate() {
            let error = errors.get(r).copied().unwrap_or(f64::NAN);
            try_push(&mut self.seen, SeenWithError { seen: *seen, error }, CONTEXT)?;
            try_push(&mut kept, *seen, CONTEXT)?;
        }
        self.recent.swap(0, 1);
        self.recent[1] = Some((key(at), kept));
        Ok(())
    }

    /// A response and its derivative along the tangent of a point that was recorded lately.
    pub fn recent(&self, response: usize, at: PointAt<'_>) -> Option<(Complex64, Complex64)> {
        let wanted = key(at);
        let mut recent = self.recent.iter().flatten();
        let (_, seen) = recent.find(|(key, _)| *key == wanted)?;
        seen.get(response).map(Seen::observed)
    }
}
