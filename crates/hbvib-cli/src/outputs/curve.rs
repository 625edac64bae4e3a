//! The points of a run, with those of the run before from which it went on.

use crate::outputs::stored_response::Stored;
use hbvib::{Branch, ModePoint, ResponseSeries};
use num_complex::Complex64;

/// The stored points of the run before, and how many of them are kept.
pub struct Before {
    pub stored: Stored,
    pub kept: usize,
    /// Number in the job of each request of the run that goes on.
    pub requests: Vec<usize>,
}

/// Points in the order of the curve.
pub struct Curve<'a> {
    before: Option<&'a Before>,
    pub branch: &'a Branch,
}

impl<'a> Curve<'a> {
    /// The points of a branch after those of the run before.
    pub fn new(branch: &'a Branch, before: Option<&'a Before>) -> Self {
        Self { before, branch }
    }

    /// Points of the run before.
    pub fn kept(&self) -> usize {
        self.before.map_or(0, |before| before.kept)
    }

    /// Number of points.
    pub fn points(&self) -> usize {
        self.kept() + self.branch.points()
    }

    fn joined(&self, stored: impl Fn(&Stored) -> &Vec<f64>, own: &[f64]) -> Vec<f64> {
        let mut all = Vec::with_capacity(self.points());
        if let Some(before) = self.before {
            let stored = stored(&before.stored);
            // A column that the run before did not have.
            all.extend((0..before.kept).map(|p| stored.get(p).copied().unwrap_or(f64::NAN)));
        }
        all.extend(&own[..own.len().min(self.branch.points())]);
        all
    }

    pub fn omega(&self) -> Vec<f64> {
        self.joined(|stored| &stored.omega, self.branch.omega())
    }

    pub fn amplitude(&self) -> Vec<f64> {
        self.joined(|stored| &stored.amplitude, self.branch.amplitude())
    }

    pub fn residual(&self) -> Vec<f64> {
        self.joined(|stored| &stored.residual, self.branch.residual())
    }

    pub fn harmonics_used(&self) -> Vec<f64> {
        self.joined(|stored| &stored.harmonics_used, self.branch.harmonics_used())
    }

    pub fn floquet_radius(&self) -> Vec<f64> {
        self.joined(|stored| &stored.floquet_radius, self.branch.floquet_radius())
    }

    pub fn unstable_directions(&self) -> Vec<f64> {
        self.joined(|stored| &stored.unstable_directions, self.branch.unstable_directions())
    }

    /// Number of free sliders at each point.
    pub fn free_sliders(&self) -> Vec<f64> {
        self.joined(|stored| &stored.free_sliders, self.branch.free_sliders())
    }

    /// Derivatives of the amplitude at a point by the places of sliders, two for each contact; empty where they are not known.
    pub fn by_place(&self, point: usize) -> &[f64] {
        match self.before {
            Some(before) if point < before.kept => {
                let n = 2 * before.stored.contacts;
                before.stored.by_place.get(point * n..(point + 1) * n).unwrap_or(&[])
            }
            _ => {
                let own = self.branch.d_amplitude_by_place_at(point - self.kept());
                own.map_or(&[], <[[f64; 2]]>::as_flattened)
            }
        }
    }

    /// Slip fraction of each contact at a point; empty where it is not known.
    pub fn slip(&self, point: usize) -> &[f64] {
        match self.before {
            Some(before) if point < before.kept => {
                let n = before.stored.contacts;
                before.stored.slip.get(point * n..(point + 1) * n).unwrap_or(&[])
            }
            _ => self.branch.slip_fraction_at(point - self.kept()).unwrap_or(&[]),
        }
    }

    /// Values of a response, or its errors.
    pub fn response(&self, r: usize, errors: bool) -> Vec<f64> {
        let of: &ResponseSeries = &self.branch.responses()[r];
        let mut all = Vec::new();
        if let Some(before) = self.before {
            let n = before.stored.omega.len();
            let stored = if errors {
                &before.stored.response_errors
            } else {
                &before.stored.responses
            };
            all.extend((0..before.kept).map(|p| stored.get(r * n + p).copied().unwrap_or(f64::NAN)));
        }
        let own = if errors { of.errors() } else { of.values() };
        all.extend(&own[..own.len().min(self.branch.points())]);
        all
    }

    /// A point of a nonlinear mode, which has no run before.
    pub fn mode_at(&self, point: usize) -> Option<ModePoint> {
        self.branch.mode_at(point)
    }

    /// Angular frequency and amplitude of the peaks, or of the folds.
    pub fn special(&self, folds: bool) -> Vec<[f64; 2]> {
        let own = if folds {
            self.branch.folds()
        } else {
            self.branch.peaks()
        };
        let mut all = self.before.map_or(Vec::new(), |before| {
            let stored = if folds {
                &before.stored.folds
            } else {
                &before.stored.peaks
            };
            stored.iter().filter(|at| before.has(**at)).copied().collect()
        });
        all.extend(own.iter().map(|s| [s.omega, s.amplitude]));
        all
    }

    /// Number of the request, angular frequency and amplitude of each solution at a requested frequency.
    pub fn requested(&self) -> Vec<[f64; 3]> {
        let mut all = self.before.map_or(Vec::new(), |before| {
            let stored = before.stored.requested.iter();
            stored.filter(|at| before.has([at[1], at[2]])).copied().collect()
        });
        let number = |i: usize| self.before.map_or(Some(i), |before| before.requests.get(i).copied());
        for (i, number) in (0..).map_while(|i| Some((i, number(i)?))) {
            let found = self.branch.at(i);
            if self.before.is_none() && found.is_empty() {
                break;
            }
            all.extend(found.iter().map(|s| [number as f64, s.omega, s.amplitude]));
        }
        all.sort_by(|a, b| a[0].total_cmp(&b[0]));
        all
    }

    /// Number of the response, angular frequency and amplitude of the peaks of responses.
    pub fn response_peaks(&self) -> Vec<[f64; 3]> {
        let mut all = self.before.map_or(Vec::new(), |before| {
            let stored = before.stored.response_peaks.iter();
            stored.filter(|at| before.has_frequency(at[1])).copied().collect()
        });
        let responses = self.branch.responses().iter().enumerate();
        all.extend(responses.flat_map(|(r, of)| of.peaks().iter().map(move |p| [r as f64, p.omega, p.amplitude])));
        all
    }

    /// Highest number of harmonics of a point, plus one.
    pub fn rows(&self) -> usize {
        let before = self.before.map_or(0, |before| before.stored.rows);
        before.max(self.branch.harmonics() + 1)
    }

    /// All harmonics of a point, [`Self::rows`] of them.
    ///
    /// # Errors
    /// Those of the library.
    pub fn harmonics_at(&self, point: usize, x: &mut Vec<Complex64>) -> Result<(), String> {
        let ndof = self.branch.ndof();
        x.clear();
        match self.before {
            Some(before) if point < before.kept => x.extend(before.stored.harmonics_at(point)),
            _ => {
                x.resize((self.branch.harmonics() + 1) * ndof, Complex64::ZERO);
                self.branch
                    .harmonics_at(point - self.kept(), x)
                    .map_err(|e| e.to_string())?;
            }
        }
        x.resize(self.rows() * ndof, Complex64::ZERO);
        Ok(())
    }
}

impl Before {
    /// Whether a special point lies on the kept part: beside two neighbours, of which one is not lower, nor one higher.
    fn has(&self, [omega, amplitude]: [f64; 2]) -> bool {
        let (w, a) = (&self.stored.omega, &self.stored.amplitude);
        // The neighbours between which it lies, by the length of the way over it.
        let (range, height) = (span(w), span(a));
        let at = |p: usize| ((w[p] - omega) / range).hypot((a[p] - amplitude) / height);
        let nearest = (1..w.len()).min_by(|p, q| {
            let way = |p: usize| at(p) + at(p - 1) - ((w[p] - w[p - 1]) / range).hypot((a[p] - a[p - 1]) / height);
            way(*p).total_cmp(&way(*q))
        });
        nearest.is_some_and(|p| p <= self.kept)
    }

    /// Whether a frequency lies on the kept part.
    fn has_frequency(&self, omega: f64) -> bool {
        let w = &self.stored.omega[..(self.kept + 1).min(self.stored.omega.len())];
        w.windows(2)
            .any(|two| (two[0].min(two[1])..=two[0].max(two[1])).contains(&omega))
    }
}

fn span(values: &[f64]) -> f64 {
    let (low, high) = values
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(*x), h.max(*x)));
    (high - low).max(f64::MIN_POSITIVE)
}
