//! A step of the motion of a block on modes: the Taylor series of its solution while no contact changes.
//!
//! Coordinates, forces of slipping sliders and relative motions are polynomials of θ, the share of the step.

use crate::error::{Result, fail, try_room, try_vec};
use crate::linalg::dense::fallible_matrix::{zero_vector, zeros};
use crate::linalg::libraries::{DMatrix, DVector};
use crate::stability::slider_motion::{SliderMotion, SliderState};
use crate::stability::slipping::Slipping;
use num_complex::Complex64;

const CONTEXT: &str = "the motion on modes";

/// Terms of a step.
/// Kind: tuned; measured on: not recorded.
pub(super) const SLIDER_STEP_TERMS: usize = 16;

/// Share of the largest term below which the last two terms of a step must be.
/// Kind: rounding.
const SLIDER_STEP_NEGLIGIBLE: f64 = 1e-17;

/// Memory of one lapse, with the states of the contacts.
pub(super) struct Lapse<'m, 'a> {
    pub motion: &'m SliderMotion<'a>,
    /// Sign of the slip of each contact; 0: it sticks.
    pub sign: Vec<f64>,
    pub slipping: Slipping<f64>,
    /// Forces p_S of sticking sliders with G p_S and Rᴴ p_S, constant until a contact changes.
    held: [DVector<f64>; 3],
    pub powers: Powers,
    pub length: f64,
    /// Length of the step to try next.
    trial: f64,
    pub events: StepEvents,
    terms: Terms,
}

/// Series of a step in powers of its share.
pub(super) struct Powers {
    /// Coefficients of coordinates, of the forces of slipping sliders, and of relative motions, one column a power. Forces have room
    /// for all contacts, and those of the list come first.
    q: DMatrix<f64>,
    p: DMatrix<f64>,
    pub r: DMatrix<f64>,
}

/// Events within the step tried last.
pub(super) struct StepEvents {
    /// Zeros by construction of the margins at the begin of the step.
    pub zeros: Vec<usize>,
    /// Contacts that reach an event within the step, with the share of the step; and those that change first.
    pub falls: Vec<(f64, usize)>,
    pub changing: Vec<usize>,
}

/// Memory of the terms of a series.
pub(super) struct Terms {
    /// e^{ihωt} of each force and its derivatives; a term of the forces on relative motions, on the slipping contacts of the list, and on
    /// coordinates; and a term of the coordinates.
    turning: Vec<Complex64>,
    forced: DVector<f64>,
    given: DVector<f64>,
    load: DVector<f64>,
    term: DVector<f64>,
}

impl<'m, 'a> Lapse<'m, 'a> {
    /// Memory for a motion, with all contacts sticking.
    pub fn stuck(motion: &'m SliderMotion<'a>) -> Result<Self> {
        let ring = motion.ring;
        let (order, all) = (ring.order(), ring.all());
        Ok(Self {
            motion,
            sign: try_vec(all, 0.0, CONTEXT)?,
            slipping: Slipping::new(ring, Vec::new(), motion.interrupt)?,
            held: [
                zero_vector(all, CONTEXT)?,
                zero_vector(all, CONTEXT)?,
                zero_vector(order, CONTEXT)?,
            ],
            powers: Powers {
                q: zeros(order, SLIDER_STEP_TERMS + 1, CONTEXT)?,
                p: zeros(all, SLIDER_STEP_TERMS + 1, CONTEXT)?,
                r: zeros(all, SLIDER_STEP_TERMS + 1, CONTEXT)?,
            },
            length: 0.0,
            trial: 0.05 * motion.lapse,
            events: StepEvents {
                zeros: try_vec(all, 0, CONTEXT)?,
                falls: try_room(all, CONTEXT)?,
                changing: try_room(all, CONTEXT)?,
            },
            terms: Terms {
                turning: try_vec(motion.forces.len(), Complex64::ZERO, CONTEXT)?,
                forced: zero_vector(all, CONTEXT)?,
                given: zero_vector(all, CONTEXT)?,
                load: zero_vector(order, CONTEXT)?,
                term: zero_vector(order, CONTEXT)?,
            },
        })
    }

    /// Computes the forces of the sticking sliders.
    fn hold(&mut self, state: &SliderState) -> Result<()> {
        let ring = self.motion.ring;
        let all = ring.all();
        self.motion
            .interrupt
            .check_before((2 * all * (all + ring.order())) as u64)?;
        let [held, relative, modal] = &mut self.held;
        for (e, held) in held.iter_mut().enumerate() {
            *held = if self.sign[e] == 0.0 {
                ring.stiffness[e] * state.w[e]
            } else {
                0.0
            };
        }
        relative.gemv(1.0, &ring.residual, held, 0.0);
        modal.gemv_tr(1.0, &ring.rows, held, 0.0);
        Ok(())
    }

    /// Computes relative motions and forces of slipping sliders at the beginning of a lapse.
    pub fn relative_at_begin(&mut self, state: &SliderState) -> Result<()> {
        self.hold(state)?;
        self.terms.forced.fill(0.0);
        for force in &self.motion.forces {
            for (to, value) in self.terms.forced.iter_mut().zip(&force.relative) {
                *to += value.re;
            }
        }
        self.terms.term.copy_from(&state.q);
        self.follow(0);
        Ok(())
    }

    /// Computes term k of the forces of slipping sliders and of relative motions, from the same term of the
    /// coordinates.
    fn follow(&mut self, k: usize) {
        let ring = self.motion.ring;
        let list = &self.slipping.list;
        let mut r = self.powers.r.column_mut(k);
        r.copy_from(&self.terms.forced);
        r.gemv(1.0, &ring.rows, &self.terms.term, 1.0);
        let mut given = self.terms.given.rows_mut(0, list.len());
        for (given, &e) in given.iter_mut().zip(list) {
            *given = self.terms.forced[e];
            if k == 0 {
                *given += self.held[1][e] - self.sign[e] * self.motion.play[e];
            }
        }
        if k == 0 {
            r += &self.held[1];
        }
        let mut p = self.powers.p.view_mut((0, k), (list.len(), 1));
        let mut p = p.column_mut(0);
        p.gemv(1.0, &self.slipping.rows, &self.terms.term, 0.0);
        p.gemv(1.0, &self.slipping.inverse, &given, 1.0);
        for (&p, &e) in p.iter().zip(list) {
            r.axpy(p, &ring.residual.column(e), 1.0);
        }
    }

    /// Fills the polynomials of a step from time t over at most `longest`.
    pub fn step(&mut self, state: &SliderState, t: f64, longest: f64) -> Result<()> {
        let motion = self.motion;
        let ring = motion.ring;
        let (order, all) = (ring.order(), ring.all());
        let h = self.trial.min(longest);
        self.hold(state)?;
        for (turning, force) in self.terms.turning.iter_mut().zip(&motion.forces) {
            *turning = Complex64::cis(force.harmonic as f64 * motion.omega * t);
        }
        self.powers.q.set_column(0, &state.q);
        self.powers.q.column_mut(1).axpy(h, &state.v, 0.0);
        for k in 0..=SLIDER_STEP_TERMS {
            let work = 2 * (order * (order + all) + all * self.slipping.list.len());
            motion.interrupt.check_before(work as u64)?;
            self.terms.forced.fill(0.0);
            self.terms.load.fill(0.0);
            for (turning, force) in self.terms.turning.iter_mut().zip(&motion.forces) {
                for (to, value) in self.terms.forced.iter_mut().zip(&force.relative) {
                    *to += (value * *turning).re;
                }
                for (to, value) in self.terms.load.iter_mut().zip(&force.modal) {
                    *to += (value * *turning).re;
                }
                *turning *= Complex64::I * (force.harmonic as f64 * motion.omega * h / (k + 1) as f64);
            }
            self.terms.term.copy_from(&self.powers.q.column(k));
            self.follow(k);
            if k + 2 > SLIDER_STEP_TERMS {
                continue;
            }
            let load = &mut self.terms.load;
            // (k + 1)(k + 2) x_{k+2} = h² (F_k + Rᴴ p_k − Ω² x_k) − (k + 1) h C x_{k+1}
            for (i, &e) in self.slipping.list.iter().enumerate() {
                let p = self.powers.p[(i, k)];
                for (j, load) in load.iter_mut().enumerate() {
                    *load += ring.rows[(e, j)] * p;
                }
            }
            if k == 0 {
                *load += &self.held[2];
            }
            for (j, load) in load.iter_mut().enumerate() {
                *load -= ring.square[j] * self.terms.term[j];
            }
            let next = self.powers.q.column(k + 1);
            let rate = -((k + 1) as f64) / h;
            match &ring.own_damping {
                Some(own) => {
                    for (j, load) in load.iter_mut().enumerate() {
                        *load += rate * own[j] * next[j];
                    }
                }
                None => load.gemv(rate, &ring.damping, &next, 1.0),
            }
            *load *= h * h / ((k + 1) * (k + 2)) as f64;
            self.powers.q.column_mut(k + 2).copy_from(load);
        }
        self.length = h;
        let ratio = self.ratio()?;
        let shortened = h < self.trial && ratio >= 1.0;
        self.trial = (h * ratio.min(2.0)).max(if shortened { self.trial } else { 0.0 });
        if ratio < 1.0 {
            let mut power = 1.0;
            for k in 1..=SLIDER_STEP_TERMS {
                power *= ratio;
                for values in [&mut self.powers.q, &mut self.powers.p, &mut self.powers.r] {
                    values.column_mut(k).scale_mut(power);
                }
            }
            self.length *= ratio;
        }
        Ok(())
    }

    /// Factor on the length of the step at which its last two terms are negligible.
    fn ratio(&self) -> Result<f64> {
        let size = |k: usize| self.powers.q.column(k).amax();
        // The largest term falls with a low power of the length.
        let largest = size(0).max(size(1)).max(size(2));
        let mut ratio = f64::INFINITY;
        for k in [SLIDER_STEP_TERMS - 1, SLIDER_STEP_TERMS] {
            let last = size(k);
            if !last.is_finite() || !largest.is_finite() {
                return fail!(NoBoundedSolution, "the motion in time grows beyond all bounds");
            }
            if last > 0.0 {
                ratio = ratio.min((SLIDER_STEP_NEGLIGIBLE * largest / last).powf(1.0 / k as f64));
            }
        }
        Ok(ratio)
    }

    /// Moves the state to the share θ of the step.
    pub fn advance(&mut self, theta: f64, state: &mut SliderState) {
        state.q.fill(0.0);
        state.v.fill(0.0);
        for k in (0..=SLIDER_STEP_TERMS).rev() {
            for ((x, v), c) in state
                .q
                .iter_mut()
                .zip(state.v.iter_mut())
                .zip(self.powers.q.column(k).iter())
            {
                *v = *v * theta + *x;
                *x = *x * theta + c;
            }
        }
        state.v /= self.length;
        self.events.zeros.fill(0);
    }

    /// Place of a slipping slider at θ: r − (± limit)/kt.
    pub fn place(&self, e: usize, theta: f64) -> f64 {
        let r = self.powers.r.row(e).iter().rev().fold(0.0, |sum, c| sum * theta + c);
        r - self.sign[e] * self.motion.play[e]
    }

    /// Rate x′ of a contact's relative motion at θ.
    pub fn rate(&self, e: usize, theta: f64) -> f64 {
        let terms = (1..=SLIDER_STEP_TERMS).rev();
        terms.fold(0.0, |sum, k| sum * theta + k as f64 * self.powers.r[(e, k)]) / self.length
    }

    /// Stretch r − w of a contact's spring at θ.
    pub fn stretch(&self, e: usize, theta: f64, state: &SliderState) -> f64 {
        self.powers.r.row(e).iter().rev().fold(0.0, |sum, c| sum * theta + c) - state.w[e]
    }
}
