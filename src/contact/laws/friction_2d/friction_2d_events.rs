//! Friction in time: elastic Coulomb friction along x under a constant load, or under the load
//! N = max(n₀ − kn·y, 0) of a normal motion y, on which it acts as −N.
//!
//! With the slider at w and the stretch e = x − w of its spring the force is f = kt·e. It sticks, w at rest,
//! while |f| ≤ μN; slips with f = ±μN; is open without force, the slider moving along, while N = 0. Slip of
//! the sign σ lasts while the slider moves that way, σ·kt·x′ − μN′ ≥ 0 with N′ = −kn·y′. At closing f begins
//! from zero, sticking if and only if kt·|x′| ≤ μ·|N′|: the limit then grows faster than the force.
//!
//! Sensitivities follow the slider. δw = 0 while it sticks. In slip and while open its place follows from the
//! motion, δw = δx + a·δy with a = σ·μkn/kt and a = 0. A closing at the time r leaves it at w = x(r); with y(r) given
//! the time moves by δr = −δy/y′, so that a = −x′/y′ (the rate of w jumps there, unlike that of the motion).

use crate::contact::forms::law::{EventLaw, SliderLaw};
use crate::contact::forms::time_piece::{Instant, Mode, TimePiece, Zeros};

/// Constants of a slider.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Slider {
    /// kt > 0
    kt: f64,
    /// Half the play at y = 0, μn₀/kt; negative with a gap.
    play: f64,
    /// Decrease of the play by y, μkn/kt.
    fall: f64,
    /// kn; 0 for a constant load.
    kn: f64,
    /// The y at which the contact opens, n₀/kn; infinite under a constant load.
    opening: f64,
    /// The slider's place before any motion.
    start: f64,
}

impl Slider {
    /// The same with the slider at a place before any motion.
    pub(crate) fn starting_at(self, start: f64) -> Self {
        Self { start, ..self }
    }

    /// Under the constant load of a Jenkins contact.
    pub(crate) fn under_constant_load(kt: f64, slip_limit: f64) -> Self {
        Self {
            kt,
            play: slip_limit / kt,
            fall: 0.0,
            kn: 0.0,
            opening: f64::INFINITY,
            start: 0.0,
        }
    }

    /// Under a load that varies, n₀ − kn·y.
    pub(crate) fn under_varying_load(kt: f64, kn: f64, mu: f64, load: f64) -> Self {
        Self {
            kt,
            play: mu * load / kt,
            fall: mu * kn / kt,
            kn,
            opening: load / kn,
            start: 0.0,
        }
    }

    /// Largest stretch at a normal motion.
    fn range(&self, y: f64) -> f64 {
        if self.kn == 0.0 {
            self.play
        } else {
            self.fall * (self.opening - y).max(0.0)
        }
    }

    /// Speed of a slider that slips with the sign σ, in its direction.
    fn speed(&self, sign: f64, rate: [f64; 2]) -> f64 {
        sign * rate[0] + self.fall * rate[1]
    }
}

impl SliderLaw for Slider {
    fn start(&self) -> f64 {
        self.start
    }

    fn drag(&self, [x, y]: [f64; 2], w: f64) -> f64 {
        let range = self.range(y);
        w.max(x - range).min(x + range)
    }

    fn stretch(&self, mode: Mode, growth: f64, y: f64, e: &mut f64) {
        match mode {
            Mode::Stick => *e += growth,
            Mode::Slip(sign) => *e = sign * self.range(y),
            _ => *e = 0.0,
        }
    }

    fn follows(&self, mode: Mode, after: Mode, rate: [f64; 2]) -> f64 {
        match (mode, after) {
            (Mode::Slip(sign), _) => sign * self.fall,
            (Mode::Open, Mode::Stick) if rate[1] != 0.0 => -rate[0] / rate[1],
            _ => 0.0,
        }
    }
}

impl EventLaw for Slider {
    fn begin(&self, at: &Instant, e: &mut f64) -> (Mode, Option<Mode>) {
        let [_, y] = at.motion;
        if y >= self.opening && (y > self.opening || at.rate[1] >= 0.0) {
            *e = 0.0;
            return (Mode::Open, Some(Mode::Open));
        }
        let range = self.range(y);
        // At the time of closing both limits are zero, and the motion gives the sign.
        let sign = if range == 0.0 { at.rate[0] } else { *e }.signum();
        let (at_limit, beyond) = (e.abs() >= range, e.abs() > range);
        if at_limit {
            *e = sign * range;
        }
        let slip = Mode::Slip(sign);
        if at_limit && self.speed(sign, at.rate) > 0.0 {
            (slip, Some(slip))
        } else {
            (Mode::Stick, beyond.then_some(slip))
        }
    }

    fn piece(&self, mode: Mode, motion: [f64; 2], e: f64) -> TimePiece {
        let mut piece = TimePiece {
            origin: motion,
            ..TimePiece::default()
        };
        if mode == Mode::Open {
            return piece;
        }
        if self.kn > 0.0 {
            piece.force[1] = self.kn * (motion[1] - self.opening);
            piece.slope[1][1] = self.kn;
        }
        if let Mode::Slip(sign) = mode {
            piece.force[0] = sign * self.kt * self.range(motion[1]);
            piece.slope[0][1] = -sign * self.kt * self.fall;
        } else {
            piece.force[0] = self.kt * e;
            piece.slope[0][0] = self.kt;
            piece.memory = self.kt;
        }
        piece
    }

    /// Those of friction, then the load where it varies.
    fn margins(&self, mode: Mode) -> usize {
        let load = usize::from(self.kn > 0.0);
        match mode {
            Mode::Stick => 2 + load,
            Mode::Slip(_) => 1 + load,
            _ => load,
        }
    }

    /// To the limit in the positive and the negative direction while it sticks, the speed of the slider
    /// while it slips, then the depth n₀/kn − y; its negative while open.
    fn margin(&self, mode: Mode, which: usize, e: f64, x: &[f64], y: &[f64], margin: &mut [f64]) {
        match (mode, which) {
            (Mode::Stick, 0 | 1) => {
                let sign = if which == 0 { 1.0 } else { -1.0 };
                for ((m, x), y) in margin.iter_mut().zip(x).zip(y) {
                    *m = -sign * x - self.fall * y;
                }
                margin[0] = self.range(y[0]) - sign * e;
            }
            (Mode::Slip(sign), 0) => {
                margin.fill(0.0);
                for k in 1..margin.len() {
                    margin[k - 1] = k as f64 * self.speed(sign, [x[k], y[k]]);
                }
            }
            _ => {
                let sign = if mode == Mode::Open { 1.0 } else { -1.0 };
                for (m, y) in margin.iter_mut().zip(y) {
                    *m = sign * y;
                }
                margin[0] -= sign * self.opening;
            }
        }
    }

    /// Slip ends where the slider's speed does, so that the stretch stands at the limit with slope zero. At
    /// closing both limits begin with the force.
    fn leave(&self, mode: Mode, which: usize, at: &Instant, e: &mut f64) -> (Mode, Zeros) {
        let range = self.range(at.motion[1]);
        match (mode, which) {
            (Mode::Stick, 0 | 1) => {
                let sign = if which == 0 { 1.0 } else { -1.0 };
                *e = sign * range;
                (Mode::Slip(sign), [0; 3])
            }
            (Mode::Slip(sign), 0) => {
                *e = sign * range;
                (Mode::Stick, if sign > 0.0 { [2, 0, 0] } else { [0, 2, 0] })
            }
            (Mode::Open, _) => {
                *e = 0.0;
                if at.rate[0].abs() <= self.fall * at.rate[1].abs() {
                    (Mode::Stick, [1, 1, 1])
                } else {
                    (Mode::Slip(at.rate[0].signum()), [0, 1, 0])
                }
            }
            _ => {
                *e = 0.0;
                (Mode::Open, [1, 0, 0])
            }
        }
    }

    fn slider(&self) -> Option<&dyn SliderLaw> {
        Some(self)
    }
}
