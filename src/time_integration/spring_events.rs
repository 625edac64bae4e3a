//! Springs without memory that are linear between events: the unilateral one, open or closed, and the
//! table, on one of its lines.

use crate::contact::Contact;
use crate::contact::laws::table::Table;
use crate::time_integration::contacts_in_time::{Events, Instant, Mode, Piece, Zeros};

/// A unilateral spring along its one motion, f = kn·(x + clearance) where that is negative.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stop {
    kn: f64,
    clearance: f64,
}

impl Stop {
    /// That of a unilateral spring, or of the normal motion of friction.
    pub fn of(c: &Contact) -> Self {
        Self {
            kn: c.kn,
            clearance: c.clearance(),
        }
    }
}

/// slope·x + offset from the motion x on.
fn line(slope: f64, force: f64, motion: [f64; 2]) -> Piece {
    Piece {
        slope: [[slope, 0.0], [0.0, 0.0]],
        force: [force, 0.0],
        origin: motion,
        memory: 0.0,
    }
}

/// How far the motion is beyond a level in the direction of the sign.
fn beyond(sign: f64, level: f64, x: &[f64], margin: &mut [f64]) {
    for (m, x) in margin.iter_mut().zip(x) {
        *m = sign * x;
    }
    margin[0] = sign * (x[0] - level);
}

impl Events for Stop {
    fn begin(&self, at: &Instant, _e: &mut f64) -> (Mode, Option<Mode>) {
        let closed = at.motion[0] < -self.clearance;
        (if closed { Mode::Closed } else { Mode::Open }, None)
    }

    fn piece(&self, mode: Mode, motion: [f64; 2], _e: f64) -> Piece {
        if mode == Mode::Closed {
            line(self.kn, self.kn * (motion[0] + self.clearance), motion)
        } else {
            line(0.0, 0.0, motion)
        }
    }

    fn margins(&self, _mode: Mode) -> usize {
        1
    }

    /// The distance while it is open, the compression while closed.
    fn margin(&self, mode: Mode, _which: usize, _e: f64, x: &[f64], _y: &[f64], margin: &mut [f64]) {
        let sign = if mode == Mode::Closed { -1.0 } else { 1.0 };
        beyond(sign, -self.clearance, x, margin);
    }

    fn leave(&self, mode: Mode, _which: usize, _at: &Instant, _e: &mut f64) -> (Mode, Zeros) {
        let after = if mode == Mode::Closed { Mode::Open } else { Mode::Closed };
        (after, [1, 0, 0])
    }
}

impl Events for Table {
    fn begin(&self, at: &Instant, _e: &mut f64) -> (Mode, Option<Mode>) {
        (Mode::Line(self.line_from(at.motion[0])), None)
    }

    fn piece(&self, mode: Mode, motion: [f64; 2], _e: f64) -> Piece {
        let Mode::Line(k) = mode else {
            return Piece::default();
        };
        let (slope, offset) = self.line(k);
        line(slope, slope * motion[0] + offset, motion)
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
                beyond(sign, level, x, margin);
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
