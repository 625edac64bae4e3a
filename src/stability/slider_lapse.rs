//! Motion in time of a block on modes, from event to event of its sliders.
//!
//! Between events the equations are linear with constant coefficients, and a step is the Taylor series of their solution. Relative
//! motions and slider forces are polynomials of the same variable, so that events are their exact roots.
//!
//! A slider that begins to slip changes the speeds of others at once, through what the modes leave out. One that is turned around
//! by it stops there, and another one may follow; one change at a time leads to the unique end (Murty 1974,
//! doi:10.1016/0024-3795(74)90001-5).

use crate::contact::forms::time_piece::Grazing;
use crate::error::{Result, fail, try_copy, try_push, try_vec};
use crate::interrupt::Phase;
use crate::stability::slider_motion::{Change, Path, SliderMotion, SliderState};
use crate::stability::slider_step::{Lapse, SLIDER_STEP_TERMS};
use crate::stability::slipping::Slipping;
use crate::time_integration::{DEGREE, GRAZING_SPEED, first_fall};

const CONTEXT: &str = "the motion on modes";

/// Share of a step within which events count as simultaneous.
/// Kind: rounding.
const SLIDER_LAPSE_SIMULTANEOUS: f64 = 1e-13;

/// Events at one time, per contact, before the integration stops with an error.
/// Kind: cap.
const SLIDER_LAPSE_AT_ONCE: usize = 20;

/// Steps of a lapse before the integration stops with an error.
/// Kind: cap.
const SLIDER_LAPSE_MOST_STEPS: usize = 2_000_000;

/// Rounding of a slider's place at the begin of a lapse, relative to the motion.
/// Kind: rounding.
const SLIDER_LAPSE_BEGIN: f64 = 1e-14;

/// Relative size below which the begin of a margin is rounding.
/// Kind: rounding.
const SLIDER_LAPSE_ROUNDING: f64 = 1e-12;

impl SliderMotion<'_> {
    /// Integrates a state over a lapse, and returns the changes on its path.
    ///
    /// # Errors
    /// `NoConvergence` for contacts that change without end, or too many steps; `Unsupported` where nothing but slipping
    /// contacts holds a motion; `OutOfMemory`; `StoppedByCaller`.
    pub fn run(&self, state: &mut SliderState) -> Result<Path> {
        let mut lapse = Lapse::new(self, state)?;
        let mut path = Path {
            first: try_copy(&lapse.slipping.list, CONTEXT)?,
            moved: try_vec(self.ring.all(), false, CONTEXT)?,
            ..Path::default()
        };
        for &e in &path.first {
            path.moved[e] = true;
        }
        let (mut t, mut steps, mut at_once) = (0.0, 0, 0);
        while t < self.lapse {
            self.interrupt
                .phase(Phase::TimeIntegration, 0.1 * (10.0 * t / self.lapse).floor())?;
            steps += 1;
            if steps > SLIDER_LAPSE_MOST_STEPS {
                return fail!(
                    NoConvergence,
                    "a period takes more than {SLIDER_LAPSE_MOST_STEPS} time steps"
                );
            }
            lapse.step(state, t, self.lapse - t)?;
            let theta = lapse.next_event(state)?;
            let passed = theta * lapse.length;
            if theta > 0.0 {
                lapse.advance(theta, state);
                for (to, values) in [(&mut path.largest.0, &state.q), (&mut path.largest.1, &state.v)] {
                    *to = values.iter().fold(*to, |m, x| m.max(x.abs()));
                }
            }
            path.rest += passed;
            at_once = if passed > 1e-15 * self.lapse {
                0
            } else {
                at_once + lapse.events.changing.len()
            };
            if at_once > SLIDER_LAPSE_AT_ONCE * (1 + self.ring.all()) {
                return fail!(NoConvergence, "contacts change without end at time {t} of the period");
            }
            lapse.switch(theta, state, &mut path)?;
            t = if lapse.events.changing.is_empty() && theta >= 1.0 && lapse.length >= self.lapse - t {
                self.lapse
            } else {
                t + passed
            };
        }
        // The last step ended the lapse.
        for &e in &lapse.slipping.list {
            state.w[e] = lapse.place(e, 1.0);
        }
        Ok(path)
    }
}

impl<'m, 'a> Lapse<'m, 'a> {
    fn new(motion: &'m SliderMotion<'a>, state: &SliderState) -> Result<Self> {
        let all = motion.ring.all();
        let mut lapse = Self::stuck(motion)?;
        // Contacts at or beyond their limits slip; their release moves others.
        for _ in 0..=all {
            motion.interrupt.check()?;
            lapse.relative_at_begin(state)?;
            let mut more = false;
            for e in 0..all {
                let (r, w) = (lapse.powers.r[(e, 0)], state.w[e]);
                let rounding = SLIDER_LAPSE_BEGIN * (r.abs() + w.abs() + motion.play[e]);
                let stretch = r - w;
                if lapse.sign[e] == 0.0 && stretch.abs() >= motion.play[e] - rounding {
                    lapse.sign[e] = stretch.signum();
                    more = true;
                }
            }
            if !more {
                break;
            }
            lapse.release()?;
        }
        Ok(lapse)
    }

    /// Sets up the equations of the contacts that slip at present.
    fn release(&mut self) -> Result<()> {
        let mut list = Vec::new();
        for (e, sign) in self.sign.iter().enumerate() {
            if *sign != 0.0 {
                try_push(&mut list, e, CONTEXT)?;
            }
        }
        self.slipping = Slipping::new(self.motion.ring, list, self.motion.interrupt)?;
        Ok(())
    }

    /// The first share θ of the step at which a contact changes its state, 1 if none does; lists the contacts that
    /// change.
    fn next_event(&mut self, state: &SliderState) -> Result<f64> {
        self.events.falls.clear();
        self.events.changing.clear();
        let mut margin = [0.0; DEGREE + 1];
        let margin = &mut margin[..=SLIDER_STEP_TERMS];
        for (e, &sign) in self.sign.iter().enumerate() {
            let mut first: Option<f64> = None;
            if sign == 0.0 {
                let stretch = self.powers.r[(e, 0)] - state.w[e];
                for side in [1.0, -1.0] {
                    for (k, m) in margin.iter_mut().enumerate().skip(1) {
                        *m = -side * self.powers.r[(e, k)];
                    }
                    margin[0] = self.motion.play[e] - side * stretch;
                    let zeros = if margin[0] <= 0.5 * self.motion.play[e] {
                        self.events.zeros[e]
                    } else {
                        0
                    };
                    if let Some(theta) = first_fall(margin, zeros) {
                        first = Some(first.map_or(theta, |before| before.min(theta)));
                    }
                }
            } else {
                for (k, m) in margin.iter_mut().enumerate().take(SLIDER_STEP_TERMS) {
                    *m = sign * (k + 1) as f64 * self.powers.r[(e, k + 1)];
                }
                margin[SLIDER_STEP_TERMS] = 0.0;
                let size: f64 = margin.iter().map(|m| m.abs()).sum();
                // A change of another contact has turned its speed around.
                let turned = margin[0] < -SLIDER_LAPSE_ROUNDING * size;
                first = if turned { Some(0.0) } else { first_fall(margin, 0) };
            }
            if let Some(theta) = first {
                try_push(&mut self.events.falls, (theta, e), CONTEXT)?;
            }
        }
        let until = self
            .events
            .falls
            .iter()
            .fold(f64::INFINITY, |m, (theta, _)| m.min(*theta));
        for &(theta, e) in &self.events.falls {
            if theta <= until + SLIDER_LAPSE_SIMULTANEOUS && theta <= 1.0 {
                try_push(&mut self.events.changing, e, CONTEXT)?;
            }
        }
        // Where changes follow from changes, one at a time leads to their end.
        if until == 0.0 {
            self.events.changing.truncate(1);
        }
        Ok(until.min(1.0))
    }

    /// Changes the states of contacts at θ of the last step.
    fn switch(&mut self, theta: f64, state: &mut SliderState, path: &mut Path) -> Result<()> {
        for at in 0..self.events.changing.len() {
            let e = self.events.changing[at];
            let slips = self.sign[e] == 0.0;
            let rate = self.rate(e, theta);
            let mut speed = 0.0;
            if slips {
                self.sign[e] = self.stretch(e, theta, state).signum();
                path.moved[e] = true;
                if theta > 0.0 {
                    speed = rate;
                }
                if (rate * self.sign[e]).abs() <= GRAZING_SPEED * self.motion.omega * self.motion.play[e] {
                    path.grazing.get_or_insert((e, Grazing::SlipLimit));
                }
            } else {
                state.w[e] = self.place(e, theta);
                // Its speed is zero, unless another contact has turned it around.
                let size: f64 = self.powers.r.row(e).iter().skip(1).map(|r| r.abs()).sum::<f64>() / self.length;
                let is_turned = rate.abs() > SLIDER_LAPSE_ROUNDING.sqrt() * size;
                self.events.zeros[e] = if is_turned { 1 } else { 2 };
                if is_turned && theta == 0.0 {
                    speed = rate;
                }
                self.sign[e] = 0.0;
            }
            let change = Change {
                after: core::mem::take(&mut path.rest),
                contact: e,
                slips,
                speed,
            };
            try_push(&mut path.changes, change, CONTEXT)?;
            self.slipping
                .change(self.motion.ring, e, slips, self.motion.interrupt)?;
        }
        Ok(())
    }
}
