//! Motion in time of a block on modes, from event to event of its sliders.
//!
//! Between events the equations are linear with constant coefficients, and a step is the Taylor series of their solution. Relative
//! motions and slider forces are polynomials of the same variable, so that events are their exact roots.
//!
//! A slider that begins to slip changes the speeds of others at once, through what the modes leave out. One that is turned around
//! by it stops there, and another one may follow; one change at a time leads to the unique end (Murty 1974,
//! doi:10.1016/0024-3795(74)90001-5).

use crate::contact::time_piece::Grazing;
use crate::error::{Result, fail, try_copy, try_push, try_vec};
use crate::interrupt::Phase;
use crate::stability::slider_motion::{Change, Path, SliderMotion, SliderState};
use crate::stability::slipping::Slipping;
use crate::time_integration::{DEGREE, first_fall};
use nalgebra::{DMatrix, DVector};
use num_complex::Complex64;

const CONTEXT: &str = "the motion on modes";

/// Terms of a step.
const SLIDER_LAPSE_TERMS: usize = 16;

/// Share of the largest term below which the last two terms of a step must be.
const SLIDER_LAPSE_NEGLIGIBLE: f64 = 1e-17;

/// Share of a step within which events count as simultaneous.
const SLIDER_LAPSE_SIMULTANEOUS: f64 = 1e-13;

/// Events at one time, per contact, before the integration stops with an error.
const SLIDER_LAPSE_AT_ONCE: usize = 20;

/// Steps of a lapse before the integration stops with an error.
const SLIDER_LAPSE_MOST_STEPS: usize = 2_000_000;

/// Speed of a slider that begins to move, relative to its play times ω, below which the event is touched rather than passed.
const SLIDER_LAPSE_GRAZING: f64 = 3e-6;

/// Rounding of a slider's place at the begin of a lapse, relative to the motion.
const SLIDER_LAPSE_BEGIN: f64 = 1e-14;

/// Relative size below which the begin of a margin is rounding.
const SLIDER_LAPSE_ROUNDING: f64 = 1e-12;

/// Memory of one lapse.
struct Lapse<'m, 'a> {
    motion: &'m SliderMotion<'a>,
    /// Sign of the slip of each contact; 0: it sticks.
    sign: Vec<f64>,
    slipping: Slipping<f64>,
    /// G_LS p_S − limits, G p_S and Rᴴ p_S, until a contact changes.
    held: [DVector<f64>; 3],
    /// Coefficients of coordinates, of the forces of slipping sliders, and of relative motions, one column a power.
    q: DMatrix<f64>,
    p: DMatrix<f64>,
    r: DMatrix<f64>,
    length: f64,
    /// Length of the step to try next.
    trial: f64,
    /// Zeros by construction of the margins at the begin of the step.
    zeros: Vec<usize>,
}

impl SliderMotion<'_> {
    /// Integrates a state over a lapse.
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
            let (theta, changing) = lapse.next_event(state)?;
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
                at_once + changing.len()
            };
            if at_once > SLIDER_LAPSE_AT_ONCE * (1 + self.ring.all()) {
                return fail!(NoConvergence, "contacts change without end at time {t} of the period");
            }
            if !changing.is_empty() {
                lapse.switch(&changing, theta, state, &mut path)?;
            }
            t = if changing.is_empty() && theta >= 1.0 && lapse.length >= self.lapse - t {
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
        let ring = motion.ring;
        let (order, all) = (ring.order(), ring.all());
        let none = || DVector::zeros(0);
        let mut lapse = Self {
            motion,
            sign: try_vec(all, 0.0, CONTEXT)?,
            slipping: Slipping::new(ring, Vec::new())?,
            held: [none(), none(), none()],
            q: DMatrix::zeros(order, SLIDER_LAPSE_TERMS + 1),
            p: DMatrix::zeros(0, SLIDER_LAPSE_TERMS + 1),
            r: DMatrix::zeros(all, SLIDER_LAPSE_TERMS + 1),
            length: 0.0,
            trial: 0.05 * motion.lapse,
            zeros: try_vec(all, 0, CONTEXT)?,
        };
        // Contacts at or beyond their limits slip; their release moves others.
        for _ in 0..=all {
            motion.interrupt.check()?;
            lapse.hold(state);
            lapse.relative_at_begin(state);
            let mut more = false;
            for e in 0..all {
                let (r, w) = (lapse.r[(e, 0)], state.w[e]);
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

    /// The equations of the contacts that slip now.
    fn release(&mut self) -> Result<()> {
        let mut list = Vec::new();
        for (e, sign) in self.sign.iter().enumerate() {
            if *sign != 0.0 {
                try_push(&mut list, e, CONTEXT)?;
            }
        }
        self.slipping = Slipping::new(self.motion.ring, list)?;
        self.p = DMatrix::zeros(self.slipping.list.len(), SLIDER_LAPSE_TERMS + 1);
        Ok(())
    }

    /// Forces of the sliders at rest.
    fn hold(&mut self, state: &SliderState) {
        let ring = self.motion.ring;
        let resting = |e: usize| {
            if self.sign[e] == 0.0 {
                ring.stiffness[e] * state.w[e]
            } else {
                0.0
            }
        };
        let held = DVector::from_fn(ring.all(), |e, _| resting(e));
        let relative = &ring.residual * &held;
        let list = &self.slipping.list;
        let limits = DVector::from_fn(list.len(), |i, _| {
            let e = list[i];
            relative[e] - self.sign[e] * self.motion.play[e]
        });
        self.held = [limits, relative, ring.rows.tr_mul(&held)];
    }

    /// Relative motions and forces of slipping sliders at the time 0 of a lapse.
    fn relative_at_begin(&mut self, state: &SliderState) {
        let mut forced = DVector::zeros(self.motion.ring.all());
        for force in &self.motion.forces {
            for (to, value) in forced.iter_mut().zip(&force.relative) {
                *to += value.re;
            }
        }
        self.term(0, &state.q, &forced);
    }

    /// Term k of the forces of slipping sliders and of relative motions, from that of the coordinates.
    fn term(&mut self, k: usize, q: &DVector<f64>, forced: &DVector<f64>) {
        let ring = self.motion.ring;
        let list = &self.slipping.list;
        let mut given = DVector::from_fn(list.len(), |i, _| forced[list[i]]);
        let mut r = &ring.rows * q + forced;
        if k == 0 {
            given += &self.held[0];
            r += &self.held[1];
        }
        let p = &self.slipping.rows * q + &self.slipping.inverse * given;
        for (i, &e) in list.iter().enumerate() {
            r.axpy(p[i], &ring.residual.column(e), 1.0);
        }
        self.p.set_column(k, &p);
        self.r.set_column(k, &r);
    }

    /// Fills the polynomials of a step from time t over at most `longest`.
    fn step(&mut self, state: &SliderState, t: f64, longest: f64) -> Result<()> {
        let motion = self.motion;
        let ring = motion.ring;
        let (order, all) = (ring.order(), ring.all());
        let h = self.trial.min(longest);
        self.hold(state);
        let mut turning: Vec<Complex64> = try_vec(motion.forces.len(), Complex64::ZERO, CONTEXT)?;
        for (turning, force) in turning.iter_mut().zip(&motion.forces) {
            *turning = Complex64::cis(force.harmonic as f64 * motion.omega * t);
        }
        self.q.set_column(0, &state.q);
        self.q.set_column(1, &(&state.v * h));
        for k in 0..=SLIDER_LAPSE_TERMS {
            let work = 2 * (order * (order + all) + all * self.slipping.list.len());
            motion.interrupt.check_before(work as u64)?;
            let mut forced = DVector::zeros(all);
            let mut load = DVector::zeros(order);
            for (turning, force) in turning.iter_mut().zip(&motion.forces) {
                for (to, value) in forced.iter_mut().zip(&force.relative) {
                    *to += (value * *turning).re;
                }
                for (to, value) in load.iter_mut().zip(&force.modal) {
                    *to += (value * *turning).re;
                }
                *turning *= Complex64::I * (force.harmonic as f64 * motion.omega * h / (k + 1) as f64);
            }
            let this = self.q.column(k).into_owned();
            self.term(k, &this, &forced);
            if k + 2 > SLIDER_LAPSE_TERMS {
                continue;
            }
            // (k + 1)(k + 2) x_{k+2} = h² (F_k + Rᴴ p_k − Ω² x_k) − (k + 1) h C x_{k+1}
            for (i, &e) in self.slipping.list.iter().enumerate() {
                let p = self.p[(i, k)];
                for (j, load) in load.iter_mut().enumerate() {
                    *load += ring.rows[(e, j)] * p;
                }
            }
            if k == 0 {
                load += &self.held[2];
            }
            for (j, load) in load.iter_mut().enumerate() {
                *load -= ring.square[j] * this[j];
            }
            let next = self.q.column(k + 1);
            let rate = -((k + 1) as f64) / h;
            match &ring.own_damping {
                Some(own) => {
                    for (j, load) in load.iter_mut().enumerate() {
                        *load += rate * own[j] * next[j];
                    }
                }
                None => load.gemv(rate, &ring.damping, &next, 1.0),
            }
            load *= h * h / ((k + 1) * (k + 2)) as f64;
            self.q.set_column(k + 2, &load);
        }
        self.length = h;
        let ratio = self.ratio()?;
        let shortened = h < self.trial && ratio >= 1.0;
        self.trial = (h * ratio.min(2.0)).max(if shortened { self.trial } else { 0.0 });
        if ratio < 1.0 {
            let mut power = 1.0;
            for k in 1..=SLIDER_LAPSE_TERMS {
                power *= ratio;
                for values in [&mut self.q, &mut self.p, &mut self.r] {
                    values.column_mut(k).scale_mut(power);
                }
            }
            self.length *= ratio;
        }
        Ok(())
    }

    /// Factor on the length at which the last two terms are negligible.
    fn ratio(&self) -> Result<f64> {
        let size = |k: usize| self.q.column(k).amax();
        // The largest term falls with a low power of the length.
        let largest = size(0).max(size(1)).max(size(2));
        let mut ratio = f64::INFINITY;
        for k in [SLIDER_LAPSE_TERMS - 1, SLIDER_LAPSE_TERMS] {
            let last = size(k);
            if !last.is_finite() || !largest.is_finite() {
                return fail!(NoBoundedSolution, "the motion in time grows beyond all bounds");
            }
            if last > 0.0 {
                ratio = ratio.min((SLIDER_LAPSE_NEGLIGIBLE * largest / last).powf(1.0 / k as f64));
            }
        }
        Ok(ratio)
    }

    /// The first θ at which a contact changes, 1 if none does, and those that do.
    fn next_event(&self, state: &SliderState) -> Result<(f64, Vec<usize>)> {
        let mut falls: Vec<(f64, usize)> = Vec::new();
        let mut margin = [0.0; DEGREE + 1];
        let margin = &mut margin[..=SLIDER_LAPSE_TERMS];
        for (e, &sign) in self.sign.iter().enumerate() {
            let mut first: Option<f64> = None;
            if sign == 0.0 {
                let stretch = self.r[(e, 0)] - state.w[e];
                for side in [1.0, -1.0] {
                    for (k, m) in margin.iter_mut().enumerate().skip(1) {
                        *m = -side * self.r[(e, k)];
                    }
                    margin[0] = self.motion.play[e] - side * stretch;
                    let zeros = if margin[0] <= 0.5 * self.motion.play[e] {
                        self.zeros[e]
                    } else {
                        0
                    };
                    if let Some(theta) = first_fall(margin, zeros) {
                        first = Some(first.map_or(theta, |before| before.min(theta)));
                    }
                }
            } else {
                for (k, m) in margin.iter_mut().enumerate().take(SLIDER_LAPSE_TERMS) {
                    *m = sign * (k + 1) as f64 * self.r[(e, k + 1)];
                }
                margin[SLIDER_LAPSE_TERMS] = 0.0;
                let size: f64 = margin.iter().map(|m| m.abs()).sum();
                // A change of another contact has turned its speed around.
                let turned = margin[0] < -SLIDER_LAPSE_ROUNDING * size;
                first = if turned { Some(0.0) } else { first_fall(margin, 0) };
            }
            if let Some(theta) = first {
                try_push(&mut falls, (theta, e), CONTEXT)?;
            }
        }
        let until = falls.iter().fold(f64::INFINITY, |m, (theta, _)| m.min(*theta));
        let mut changing = Vec::new();
        for (theta, e) in falls {
            if theta <= until + SLIDER_LAPSE_SIMULTANEOUS && theta <= 1.0 {
                try_push(&mut changing, e, CONTEXT)?;
            }
        }
        // Where changes follow from changes, one at a time leads to their end.
        if until == 0.0 {
            changing.truncate(1);
        }
        Ok((until.min(1.0), changing))
    }

    fn advance(&mut self, theta: f64, state: &mut SliderState) {
        state.q.fill(0.0);
        state.v.fill(0.0);
        for k in (0..=SLIDER_LAPSE_TERMS).rev() {
            for ((x, v), c) in state.q.iter_mut().zip(state.v.iter_mut()).zip(self.q.column(k).iter()) {
                *v = *v * theta + *x;
                *x = *x * theta + c;
            }
        }
        state.v /= self.length;
        self.zeros.fill(0);
    }

    /// Place of a slipping slider at θ: r − (± limit)/kt.
    fn place(&self, e: usize, theta: f64) -> f64 {
        let r = self.r.row(e).iter().rev().fold(0.0, |sum, c| sum * theta + c);
        r - self.sign[e] * self.motion.play[e]
    }

    /// Changes contacts at θ of the last step.
    fn switch(&mut self, changing: &[usize], theta: f64, state: &mut SliderState, path: &mut Path) -> Result<()> {
        for &e in changing {
            let slips = self.sign[e] == 0.0;
            let rate = self.rate(e, theta);
            let mut speed = 0.0;
            if slips {
                self.sign[e] = self.stretch(e, theta, state).signum();
                path.moved[e] = true;
                if theta > 0.0 {
                    speed = rate;
                }
                if (rate * self.sign[e]).abs() <= SLIDER_LAPSE_GRAZING * self.motion.omega * self.motion.play[e] {
                    path.grazing.get_or_insert((e, Grazing::SlipLimit));
                }
            } else {
                state.w[e] = self.place(e, theta);
                // Its speed is zero, unless another contact has turned it around.
                let size: f64 = self.r.row(e).iter().skip(1).map(|r| r.abs()).sum::<f64>() / self.length;
                let is_turned = rate.abs() > SLIDER_LAPSE_ROUNDING.sqrt() * size;
                self.zeros[e] = if is_turned { 1 } else { 2 };
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
            self.slipping.change(self.motion.ring, e, slips)?;
        }
        self.p = DMatrix::zeros(self.slipping.list.len(), SLIDER_LAPSE_TERMS + 1);
        Ok(())
    }

    /// x′ of a contact at θ.
    fn rate(&self, e: usize, theta: f64) -> f64 {
        let terms = (1..=SLIDER_LAPSE_TERMS).rev();
        terms.fold(0.0, |sum, k| sum * theta + k as f64 * self.r[(e, k)]) / self.length
    }

    fn stretch(&self, e: usize, theta: f64, state: &SliderState) -> f64 {
        self.r.row(e).iter().rev().fold(0.0, |sum, c| sum * theta + c) - state.w[e]
    }
}
