//! The events of a mass that slides under a force, one after the other, as [`super::SlidingMass`] has them.

use crate::fourier::{Extremum, HarmonicSet, crossing, integral, jet};
use crate::roots::safe_newton;
use std::f64::consts::{PI, TAU};

/// The begin of a stick, sign 0, or of a slip in the sense of its sign, where the mass has no velocity; the force follows after a delay.
#[derive(Clone, Copy, Debug)]
pub(super) struct Event {
    pub(super) tau: f64,
    pub(super) sign: f64,
    pub(super) delay: f64,
}

impl Event {
    /// Without a delay.
    pub(super) const fn at(tau: f64, sign: f64) -> Self {
        Self { tau, sign, delay: 0.0 }
    }

    /// The time from which the force is that of the event.
    pub(super) fn begin(&self) -> f64 {
        self.tau + self.delay
    }
}

/// A time on a motion of odd harmonics, and the turning point before it, counted on beyond half a turn.
pub(super) struct SlideWalk<'a> {
    pub(super) set: &'a HarmonicSet,
    pub(super) motion: &'a [f64],
    pub(super) extrema: &'a [Extremum],
    pub(super) at: usize,
    pub(super) range: f64,
    pub(super) late: f64,
}

impl SlideWalk<'_> {
    pub(super) fn x(&self, tau: f64) -> f64 {
        jet(self.set, self.motion, tau).x
    }

    /// The k-th turning point; each half turn has the same ones with opposite sign.
    fn extremum(&self, k: usize) -> Extremum {
        let (turns, k) = (k / self.extrema.len(), k % self.extrema.len());
        let Extremum { tau, x } = self.extrema[k];
        Extremum {
            tau: tau + turns as f64 * PI,
            x: if turns.is_multiple_of(2) { x } else { -x },
        }
    }

    fn crossing(&self, (a, xa): (f64, f64), b: Extremum, level: f64) -> f64 {
        crossing(self.set, self.motion, a, b.tau, xa, b.x, level)
    }

    /// The next begin of a slip after a stick from a time on; `None` where there is none.
    fn onset(&mut self, from: f64) -> Option<Event> {
        let (mut a, mut xa) = (from, self.x(from));
        for _ in 0..2 * self.extrema.len() + 2 {
            let end = self.extremum(self.at + 1);
            if end.x.abs() > self.range {
                let sign = end.x.signum();
                let is_within = sign * xa < self.range && end.tau > a;
                let tau = if is_within {
                    self.crossing((a, xa), end, sign * self.range)
                } else {
                    a
                };
                return Some(Event::at(tau, sign));
            }
            (a, xa) = (end.tau, end.x);
            self.at += 1;
        }
        None
    }

    /// The end of a slip.
    fn slip_end(&mut self, slip: Event) -> f64 {
        let (s, from) = (slip.sign, integral(self.set, self.motion, slip.tau));
        let excess = |x: f64| s * x - self.range;
        let momentum = |tau: f64| {
            let by_motion = s * (integral(self.set, self.motion, tau) - from);
            by_motion - self.range * (tau - slip.tau - 2.0 * slip.delay)
        };
        let root = |a: f64, b: f64, at_b: f64| {
            safe_newton(a, b, momentum(a).max(f64::MIN_POSITIVE), at_b, |tau| {
                (momentum(tau), excess(self.x(tau)))
            })
        };
        let (mut a, mut xa) = (slip.tau, self.x(slip.tau));
        // It begins at the limit but for rounding, or after a delay within it.
        let mut above = slip.delay == 0.0 || excess(xa) > 0.0;
        for step in 0..4 * self.extrema.len() + 4 {
            let end = self.extremum(self.at + step + 1);
            let stays_above = excess(end.x) > 0.0;
            let passes = above != stays_above && excess(xa) * excess(end.x) < 0.0 && end.tau > a;
            let middle = if passes {
                self.crossing((a, xa), end, s * self.range)
            } else {
                a
            };
            // The part on which the momentum falls.
            let falls = match (above, stays_above) {
                (true, true) => None,
                (true, false) => Some((middle, end.tau)),
                (false, true) => Some((a, middle)),
                (false, false) => Some((a, end.tau)),
            };
            if let Some((a, b)) = falls.filter(|(a, b)| b > a)
                && let at_b = momentum(b)
                && at_b <= 0.0
            {
                let tau = root(a, b, at_b);
                self.at += step;
                return tau;
            }
            (a, xa, above) = (end.tau, end.x, stays_above);
        }
        a
    }

    /// The event after another one; `None` where the mass sticks for ever.
    pub(super) fn next(&mut self, event: Event) -> Option<Event> {
        if event.sign == 0.0 {
            return self.onset(event.tau);
        }
        let tau = self.slip_end(event);
        let back = -event.sign * self.x(tau) / self.range;
        let delay = self.late * lateness(back)[0];
        let goes_back = back > 1.0 || delay > 0.0;
        Some(Event {
            tau,
            sign: if goes_back { -event.sign } else { 0.0 },
            delay,
        })
    }

    /// A begin of a slip as if the mass had stuck before; `None` where it never slips.
    pub(super) fn first_onset(&mut self) -> Option<Event> {
        let goes_beyond = |k: &usize| {
            let (a, b) = (self.extremum(*k).x, self.extremum(k + 1).x);
            b.abs() > self.range && b.signum() * a <= self.range
        };
        self.at = (0..self.extrema.len()).find(goes_beyond)?;
        let (a, b) = (self.extremum(self.at), self.extremum(self.at + 1));
        let sign = b.x.signum();
        Some(Event::at(self.crossing((a.tau, a.x), b, sign * self.range), sign))
    }

    /// The begin of a slip, counted with its turning point, moved by a step in time; `None` where no slip begins, and no change.
    pub(super) fn moved_begin(&mut self, (slip, at): (Event, usize), step: f64) -> Option<Event> {
        // A turn later, so that there are turning points before.
        let tau = slip.tau + TAU + step;
        let stays = core::mem::replace(&mut self.at, at + 2 * self.extrema.len());
        self.go_to(tau);
        let back = slip.sign * self.x(tau) / self.range;
        if back > 1.0 {
            let delay = self.late * lateness(back)[0];
            return Some(Event { tau, delay, ..slip });
        }
        self.at = stays;
        None
    }

    /// The same event one or more turns before.
    pub(super) fn rebased(&mut self, event: Event) -> Event {
        let turn = 2 * self.extrema.len();
        let turns = self.at / turn;
        self.at -= turns * turn;
        Event {
            tau: event.tau - turns as f64 * TAU,
            ..event
        }
    }

    /// Selects the turning point before a time.
    fn go_to(&mut self, tau: f64) {
        while self.at > 0 && self.extremum(self.at).tau > tau {
            self.at -= 1;
        }
        while self.extremum(self.at + 1).tau <= tau {
            self.at += 1;
        }
    }

    /// ∂τ of the end of a slip by that of its begin.
    pub(super) fn moved(&self, slip: Event, end: f64) -> f64 {
        let excess = |tau| self.x(tau) - slip.sign * self.range;
        excess(slip.tau) / excess(end)
    }
}

/// g of a force r times the limit, see the head of this file, and a part of it below 1/2; with its derivative.
pub(super) fn lateness(r: f64) -> [f64; 2] {
    if r <= 0.0 {
        return [0.0; 2];
    }
    let angle = ((r - 1.0) / (r + 1.0)).clamp(-1.0, 1.0).acos();
    let whole = (0.5 * ((r + 1.0) * angle.sin() - (r - 1.0) * angle)).max(0.0);
    let slope = 0.5 * (angle.sin() - angle);
    let x = (2.0 * r).min(1.0);
    let share = x * x * (3.0 - 2.0 * x);
    let rise = if x < 1.0 { 12.0 * x * (1.0 - x) } else { 0.0 };
    [whole * share, slope * share + whole * rise]
}
