//! The tabulated spring: force against displacement, straight between the points and beyond them
//! along the first and the last of these lines.
//!
//! The law has no memory. Its pieces end where the motion passes the displacement of an inner
//! point, once at most from one turning point to the next, so that Fourier integrals are exact as they
//! are for a unilateral spring, the table of two lines.

use crate::byte_stream::{ByteReader, ByteWriter};
use crate::contact::forms::constants::LawData;
use crate::contact::forms::contact_state::State;
use crate::contact::forms::law::{ContactLaw, EventLaw, Form, Law, LawInTime, PiecewiseLinear};
use crate::contact::forms::linearisation::Range;
use crate::contact::forms::onset::Onset;
use crate::contact::forms::piece::Piece;
use crate::contact::forms::time_piece::{Instant, Mode, TimePiece, Zeros, margin_of_level};
use crate::error::{Result, fail, try_push};
use crate::fourier::HarmonicSet;
use crate::fourier::{Extremum, VALUES_OF_A_CROSSING, crossing};
use crate::interrupt::Interrupt;
use num_complex::Complex64;
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

/// Share of the sizes that are subtracted up to which a difference counts as rounding.
/// Kind: rounding.
const TABLE_ROUNDING: f64 = 8.0 * f64::EPSILON;

/// A line f = slope·x + offset, from the displacement `from` on.
#[derive(Clone, Copy, Debug)]
struct Line {
    from: f64,
    slope: f64,
    offset: f64,
    /// Offsets up to this are rounding.
    noise: f64,
}

/// A tabulated spring. Copies share the table.
#[derive(Clone, Debug)]
pub struct Table {
    /// In the caller's units; the first begins nowhere.
    lines: Arc<Vec<Line>>,
    /// Unit of length in the caller's.
    length: f64,
}

impl Table {
    /// Number of the law in saved models.
    /// Kind: fixed.
    pub(super) const TABLE_NUMBER: u8 = 6;

    /// The spring through points (displacement, force), at least two, of ascending displacement.
    ///
    /// # Errors
    /// `Dimension`, `NotFinite` or `Argument`, naming the point; `OutOfMemory`.
    pub fn new(displacements: &[f64], forces: &[f64]) -> Result<Self> {
        let n = displacements.len();
        if n != forces.len() {
            return fail!(Dimension, "a table of {n} displacements and {} forces", forces.len());
        }
        if n < 2 {
            return fail!(Dimension, "a table of {n} points, needs at least 2");
        }
        for (name, values) in [("displacement", displacements), ("force", forces)] {
            if let Some(at) = values.iter().position(|x| !x.is_finite()) {
                return fail!(
                    NotFinite,
                    "{name}[{at}] of the table is {}, needs a finite number",
                    values[at]
                );
            }
        }
        let mut lines = Vec::new();
        for (k, (x, f)) in displacements.windows(2).zip(forces.windows(2)).enumerate() {
            if x[1] <= x[0] {
                return fail!(
                    Argument,
                    "displacement[{}] = {} of the table does not exceed displacement[{k}] = {}; sort the points",
                    k + 1,
                    x[1],
                    x[0]
                );
            }
            let slope = (f[1] - f[0]) / (x[1] - x[0]);
            // From the point nearer to zero displacement the error of the slope matters least.
            let near = usize::from(x[1].abs() < x[0].abs());
            let offset = f[near] - slope * x[near];
            if !(slope.is_finite() && offset.is_finite()) {
                return fail!(
                    NotFinite,
                    "the slope of the table from point {k} to point {} is {slope}, needs a finite number",
                    k + 1
                );
            }
            // Points on a line through the origin make one, in spite of the rounding of the division.
            let noise = TABLE_ROUNDING * (f[0].abs().max(f[1].abs()) + slope.abs() * x[near].abs());
            let line = Line {
                from: if k == 0 { f64::NEG_INFINITY } else { x[0] },
                slope,
                offset: if offset.abs() <= noise { 0.0 } else { offset },
                noise,
            };
            try_push(&mut lines, line, "a table")?;
        }
        Ok(Self {
            lines: Arc::new(lines),
            length: 1.0,
        })
    }

    /// Reads a table.
    ///
    /// # Errors
    /// `Argument` for bytes that are none; `OutOfMemory`.
    pub(crate) fn load_from(input: &mut ByteReader<'_>) -> Result<Self> {
        let length = input.finite()?;
        let mut lines: Vec<Line> = Vec::new();
        for _ in 0..input.entries(32)? {
            let line = Line {
                from: input.f64()?,
                slope: input.finite()?,
                offset: input.finite()?,
                noise: input.finite()?,
            };
            let follows = match lines.last() {
                None => line.from == f64::NEG_INFINITY,
                Some(last) => line.from.is_finite() && line.from > last.from,
            };
            if !follows {
                return Err(input.damaged("displacements of a table do not ascend"));
            }
            try_push(&mut lines, line, "a table")?;
        }
        if lines.is_empty() || length <= 0.0 {
            return Err(input.damaged("a table has no lines"));
        }
        Ok(Self {
            lines: Arc::new(lines),
            length,
        })
    }

    /// The law in units of `length` of its present unit: x = length·x̂, f = length·f̂.
    #[must_use]
    pub fn in_units(&self, length: f64) -> Self {
        Self {
            lines: Arc::clone(&self.lines),
            length: self.length * length,
        }
    }

    /// Force at a displacement.
    #[must_use]
    pub fn force(&self, x: f64) -> f64 {
        let line = &self.lines[self.line_from(x)];
        line.slope * x + self.scaled(line.offset)
    }

    /// Stiffness at small motion: the slope at zero displacement, the mean of both where it is that
    /// of a point.
    #[must_use]
    pub fn slope_at_rest(&self) -> f64 {
        0.5 * (self.lines[self.line_from(0.0)].slope + self.lines[self.line_below(0.0)].slope)
    }

    /// Stiffness of the largest modulus.
    #[must_use]
    pub fn largest_stiffness(&self) -> f64 {
        self.lines.iter().fold(0.0, |m, line| m.max(line.slope.abs()))
    }

    /// A length or force in the law's units.
    fn scaled(&self, x: f64) -> f64 {
        x / self.length
    }

    /// Displacements of the inner points.
    fn levels(&self) -> impl Iterator<Item = f64> + '_ {
        self.lines[1..].iter().map(|line| self.scaled(line.from))
    }

    /// Slope and offset of a line.
    fn line(&self, number: usize) -> (f64, f64) {
        let line = &self.lines[number];
        (line.slope, self.scaled(line.offset))
    }

    /// Displacement at which a line takes over from the one before; `None` for the first, and beyond the
    /// last.
    fn level(&self, number: usize) -> Option<f64> {
        let line = self.lines.get(number).filter(|_| number > 0);
        line.map(|line| self.scaled(line.from))
    }

    /// Number of the line at x, the later one of two that meet there.
    fn line_from(&self, x: f64) -> usize {
        self.lines[1..].partition_point(|line| self.scaled(line.from) <= x)
    }

    /// Line at x, the earlier one of two that meet there.
    fn line_below(&self, x: f64) -> usize {
        self.lines[1..].partition_point(|line| self.scaled(line.from) < x)
    }

    /// A lone piece through the origin means that the contact is at rest, of the stiffness that it has
    /// there. A motion that stays on another line whose continuation meets the origin is not; its
    /// piece is cut in two.
    fn part_from_rest(&self, pieces: &mut Vec<Piece>) {
        let [only] = pieces[..] else { return };
        let at_rest_slope = only.slope.to_bits() == self.slope_at_rest().to_bits();
        if only.offset == 0.0 && !at_rest_slope {
            let middle = (0.5 * (only.start + only.end)).ceil().min(only.end);
            pieces[0].end = middle;
            pieces.push(Piece { start: middle, ..only });
        }
    }

    fn push(&self, start: f64, end: f64, line: usize, pieces: &mut Vec<Piece>) {
        if end <= start {
            return;
        }
        let line = &self.lines[line];
        pieces.push(Piece {
            start,
            end,
            slope: line.slope,
            anchor: None,
            offset: self.scaled(line.offset),
        });
    }
}

impl LawData for Table {
    fn number(&self) -> u8 {
        Self::TABLE_NUMBER
    }

    fn save_to(&self, out: &mut ByteWriter<'_>) -> Result<()> {
        out.f64(self.length);
        out.count(self.lines.len());
        for line in self.lines.iter() {
            for value in [line.from, line.slope, line.offset, line.noise] {
                out.f64(value);
            }
        }
        Ok(())
    }
}

impl ContactLaw for Table {
    fn name(&self) -> &'static str {
        "table"
    }

    fn stiffness_at_small_motion(&self, _k: usize, _l: usize) -> f64 {
        self.slope_at_rest()
    }

    fn stiffness(&self, _k: usize) -> f64 {
        self.largest_stiffness()
    }

    fn is_per_area(&self) -> bool {
        false
    }

    fn is_preloaded(&self) -> bool {
        self.force(0.0) != 0.0
    }

    fn law(&self, length: f64) -> Result<Arc<dyn Law>> {
        Ok(Arc::new(self.in_units(length)))
    }

    fn in_time(&self) -> Result<LawInTime> {
        Ok(LawInTime::events(self.clone()))
    }
}

impl Law for Table {
    /// Whether f(−x) = −f(x), to rounding. f(x) + f(−x) is made of straight lines that meet at the
    /// inner points and their mirror images, so it vanishes if it does there, at zero and in slope
    /// at the ends.
    fn is_odd(&self) -> bool {
        let (first, last) = (&self.lines[0], &self.lines[self.lines.len() - 1]);
        let odd_at = |x: f64| {
            let (a, b) = (&self.lines[self.line_from(x)], &self.lines[self.line_from(-x)]);
            let sum = (a.slope - b.slope) * x + self.scaled(a.offset + b.offset);
            let size = (a.slope.abs() + b.slope.abs()) * x.abs() + (a.noise + b.noise) / (TABLE_ROUNDING * self.length);
            sum.abs() <= TABLE_ROUNDING * size
        };
        let ends = (first.slope - last.slope).abs() <= TABLE_ROUNDING * first.slope.abs().max(last.slope.abs());
        ends && odd_at(0.0) && self.levels().all(odd_at)
    }

    fn form(&self) -> Form<'_> {
        Form::PiecewiseLinear(self)
    }

    /// From this scale on the motion stays on the line at rest.
    fn linearisation_scale(&self, ranges: &[Range], _reference: f64) -> f64 {
        let nearest = self.levels().fold(f64::INFINITY, |near, x| near.min(x.abs()));
        ranges[0].size() / nearest
    }

    fn onset(&self, rest: &[f64], motion: &[Complex64]) -> Onset {
        let nearest = self
            .levels()
            .fold(f64::INFINITY, |near, x| near.min((x - rest[0]).abs()));
        Onset {
            linear: if motion[0].norm() == 0.0 {
                f64::INFINITY
            } else {
                nearest / motion[0].norm()
            },
            ..Onset::NEVER
        }
    }
}

impl PiecewiseLinear for Table {
    fn pieces(
        &self,
        set: &HarmonicSet,
        motion: &[f64],
        turning_points: &[Extremum],
        pieces: &mut Vec<Piece>,
        interrupt: &Interrupt<'_>,
    ) -> Result<()> {
        let turn = if set.is_odd() { PI } else { TAU };
        let Some(first) = turning_points.first() else {
            let rest = if set.has_mean() { motion[0] } else { 0.0 };
            self.push(0.0, turn, self.line_from(rest), pieces);
            self.part_from_rest(pieces);
            return Ok(());
        };
        // The turn ends as it begins, with opposite sign half a turn later.
        let end = Extremum {
            tau: first.tau + turn,
            x: if set.is_odd() { -first.x } else { first.x },
        };
        let mut start = first.tau;
        let mut current = None;
        for (from, to) in turning_points.iter().zip(turning_points[1..].iter().chain(Some(&end))) {
            let rises = to.x > from.x;
            // Levels that are just touched at a turning point are not passed.
            let (leaves, reaches) = if rises {
                (self.line_from(from.x), self.line_below(to.x))
            } else {
                (self.line_below(from.x), self.line_from(to.x))
            };
            let mut line = *current.get_or_insert(leaves);
            let mut passed = *from;
            while line != reaches {
                let next = if reaches > line { line + 1 } else { line - 1 };
                let level = self.scaled(self.lines[line.max(next)].from);
                let ahead = (level - passed.x) * (to.x - level) > 0.0;
                let tau = if ahead {
                    interrupt.check_before((VALUES_OF_A_CROSSING * motion.len()) as u64)?;
                    crossing(set, motion, passed.tau, to.tau, passed.x, to.x, level)
                } else {
                    passed.tau
                };
                self.push(start, tau, line, pieces);
                start = tau.max(start);
                passed = Extremum { tau: start, x: level };
                line = next;
            }
            current = Some(line);
        }
        if let Some(line) = current {
            self.push(start, end.tau, line, pieces);
        }
        self.part_from_rest(pieces);
        Ok(())
    }

    fn sampled_pieces(&self, samples: &[f64], pieces: &mut Vec<Piece>) {
        let Some(first) = samples.first() else { return };
        let (mut start, mut line) = (0, self.line_from(*first));
        for (j, x) in samples.iter().enumerate().skip(1) {
            let next = self.line_from(*x);
            if next != line {
                self.push(start as f64, j as f64, line, pieces);
                (start, line) = (j, next);
            }
        }
        self.push(start as f64, samples.len() as f64, line, pieces);
        self.part_from_rest(pieces);
    }

    fn most_pieces(&self, highest: usize) -> usize {
        let passages = highest.saturating_mul(2);
        passages.saturating_mul(self.lines.len() - 1).saturating_add(2)
    }

    /// A table has no states.
    fn state(&self, _piece: &Piece) -> State {
        State::Stick
    }

    fn at(&self, x: f64) -> Option<(f64, State)> {
        Some((self.force(x), State::Stick))
    }
}

/// On one of the lines.
impl EventLaw for Table {
    fn begin(&self, at: &Instant, _e: &mut f64) -> (Mode, Option<Mode>) {
        (Mode::Line(self.line_from(at.motion[0])), None)
    }

    fn piece(&self, mode: Mode, motion: [f64; 2], _e: f64) -> TimePiece {
        let Mode::Line(k) = mode else {
            return TimePiece::default();
        };
        let (slope, offset) = self.line(k);
        TimePiece::line(slope, slope * motion[0] + offset, motion)
    }

    fn margins(&self, _mode: Mode) -> usize {
        2
    }

    /// To the upper and to the lower end of the line; the first and the last line have no end outwards.
    fn margin(&self, mode: Mode, which: usize, _e: f64, x: &[f64], _y: &[f64], margin: &mut [f64]) {
        margin.fill(0.0);
        margin[0] = 1.0;
        if let Mode::Line(k) = mode {
            let (number, sign) = if which == 0 { (k + 1, -1.0) } else { (k, 1.0) };
            if let Some(level) = self.level(number) {
                margin_of_level(sign, level, x, margin);
            }
        }
    }

    fn leave(&self, mode: Mode, which: usize, _at: &Instant, _e: &mut f64) -> (Mode, Zeros) {
        match (mode, which) {
            (Mode::Line(k), 0) => (Mode::Line(k + 1), [0, 1, 0]),
            (Mode::Line(k), _) => (Mode::Line(k.saturating_sub(1)), [1, 0, 0]),
            _ => (mode, [0; 3]),
        }
    }
}
