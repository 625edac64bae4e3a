//! Derivatives of the harmonics of friction in a plane by the motion, followed along the path of the force; the equations are in
//! [`crate::aft::plane_friction`].

use crate::aft::evaluation::Evaluation;
use crate::aft::jacobian_block::pack;
use crate::aft::piecewise_exact::transform;
use crate::aft::plane_friction::slip_session::{SlipSession, add, differentiate};
use crate::contact::forms::contact_state::State;
use crate::contact::forms::law::PlaneFriction;
use crate::contact::forms::plane_path::{PlaneForce, PlanePath, PlanePiece, Repetition, SlipPanel};
use crate::contact::forms::radau::RADAU_STAGES;
use crate::error::{Result, try_vec};
use crate::fourier::{HarmonicSet, jet};
use crate::interrupt::Interrupt;
use num_complex::Complex64;

const CONTEXT: &str = "the derivatives of friction in a plane";

/// Quantity whose derivative is carried from piece to piece.
#[derive(Clone, Copy, PartialEq)]
enum Carried {
    /// No quantity: there is no force.
    Nothing,
    /// f − u of a stick, in `rows`.
    Anchor,
    /// Angle θ of the slip direction, in `angle`.
    Angle,
}

/// Memory of the derivatives: by the packed motions, then by both components of the force at the start.
pub(super) struct PlaneSensitivity {
    set: HarmonicSet,
    directions: usize,
    carried: Carried,
    rows: [Vec<f64>; 2],
    angle: Vec<f64>,
    transform: Vec<Complex64>,
    g: Vec<f64>,
    /// Fourier basis and its derivative at one time.
    basis: Vec<f64>,
    slope: Vec<f64>,
    /// Derivatives of the slip angle at the start of the panels in `session`.
    first_angle: Vec<f64>,
    session: SlipSession,
    /// Columns of the Jacobian by the two components of the force at the start.
    by_start: Vec<f64>,
}

impl PlaneSensitivity {
    pub fn new(set: &HarmonicSet, directions: usize) -> Result<Self> {
        let m = set.packed_len();
        let memory = |size: usize| try_vec(size, 0.0, CONTEXT);
        let all = m.saturating_mul(directions).saturating_add(2);
        Ok(Self {
            set: set.try_clone()?,
            directions,
            carried: Carried::Nothing,
            rows: [memory(all)?, memory(all)?],
            angle: memory(all)?,
            transform: try_vec(2 * set.highest_reduced() + 1, Complex64::ZERO, CONTEXT)?,
            g: memory(m)?,
            basis: memory(m)?,
            slope: memory(m)?,
            first_angle: memory(all)?,
            session: SlipSession::new(set, directions)?,
            by_start: memory(4 * m)?,
        })
    }

    /// Adds the derivatives beyond the Toeplitz blocks to the Jacobian in `out`.
    pub fn add_to(
        &mut self,
        law: &dyn PlaneFriction,
        path: &mut PlanePath,
        out: &mut Evaluation,
        interrupt: &Interrupt<'_>,
    ) -> Result<()> {
        let Some((first, last)) = path.pieces.first().zip(path.pieces.last()) else {
            return Ok(());
        };
        let (start, end) = (first.start, last.end);
        self.by_start.fill(0.0);
        self.begin(law, path, start);
        let m = self.set.packed_len();
        for piece in &path.pieces {
            interrupt.check_before((self.directions * RADAU_STAGES * m * m) as u64)?;
            let PlaneForce::Slip(panel) = &piece.force else {
                self.add_session(out, interrupt)?;
                if piece.state() == State::Open {
                    self.carried = Carried::Nothing;
                } else {
                    self.begin_stick(law, path, piece);
                    self.add_stick(path.turn, piece, out);
                }
                continue;
            };
            if self.session.is_full() {
                self.add_session(out, interrupt)?;
            }
            self.begin_slip(law, path, piece, panel);
            if self.session.is_empty() {
                self.first_angle.copy_from_slice(&self.angle);
            }
            self.session
                .add(law, path, (piece, panel), &mut self.angle, interrupt)?;
        }
        self.add_session(out, interrupt)?;
        if matches!(path.repetition, Repetition::Returns) {
            self.close(law, path, end, out);
        }
        Ok(())
    }

    /// Sets the derivatives of the force at the start of the turn.
    fn begin(&mut self, law: &dyn PlaneFriction, path: &PlanePath, start: f64) {
        let m = self.set.packed_len();
        let (kt, [_, by_y]) = (law.stiffness(), law.limit());
        self.carried = Carried::Anchor;
        for row in &mut self.rows {
            row.fill(0.0);
        }
        match &path.repetition {
            Repetition::FromNothing => self.carried = Carried::Nothing,
            Repetition::Returns => {
                self.set.basis(start, &mut self.basis);
                let unit = self.directions * m;
                for (i, row) in self.rows.iter_mut().enumerate() {
                    add(&mut row[i * m..], -kt, &self.basis);
                    row[unit + i] = 1.0;
                }
            }
            // f − u = −w
            Repetition::Rests(holds) => {
                for hold in holds.iter().flatten() {
                    self.set.basis(hold.tau, &mut self.basis);
                    differentiate(&self.set, &self.basis, &mut self.slope);
                    for (i, row) in self.rows.iter_mut().enumerate() {
                        for k in 0..2 {
                            add(&mut row[k * m..], -kt * hold.by_pull[i][k], &self.basis);
                        }
                        if self.directions == 3 {
                            add(&mut row[2 * m..], -by_y * hold.by_limit[i], &self.basis);
                        }
                        let Some(drift) = &hold.drift else {
                            continue;
                        };
                        for k in 0..2 {
                            add(&mut row[k * m..], -kt * drift.place[i] * drift.by_pull[k], &self.basis);
                            add(&mut row[k * m..], -kt * drift.place[i] * drift.by_rate[k], &self.slope);
                        }
                        if self.directions == 3 {
                            add(
                                &mut row[2 * m..],
                                -by_y * drift.place[i] * drift.by_limit_rate,
                                &self.slope,
                            );
                        }
                    }
                }
            }
        }
    }

    /// Sets the derivatives of f − u at the beginning of a stick, which keep their values during it.
    fn begin_stick(&mut self, law: &dyn PlaneFriction, path: &PlanePath, piece: &PlanePiece) {
        let m = self.set.packed_len();
        let (kt, [_, by_y]) = (law.stiffness(), law.limit());
        if self.carried == Carried::Anchor {
            return;
        }
        let here = path.at(piece.start);
        self.set.basis(piece.start, &mut self.basis);
        if self.carried == Carried::Angle {
            // The end of slip: δf = R n δθ + e δR.
            let PlaneForce::Stick { force, .. } = piece.force else {
                return;
            };
            let size = force[0].hypot(force[1]);
            let turned = [-force[1], force[0]];
            for (i, row) in self.rows.iter_mut().enumerate() {
                for (r, a) in row.iter_mut().zip(&self.angle) {
                    *r = turned[i] * a;
                }
                if self.directions == 3 && size > 0.0 {
                    add(&mut row[2 * m..], by_y * force[i] / size, &self.basis);
                }
            }
        } else {
            for (i, row) in self.rows.iter_mut().enumerate() {
                row.fill(0.0);
                if piece.closes && here.limit_rate > 0.0 {
                    add(&mut row[2 * m..], by_y * here.rate[i] / here.limit_rate, &self.basis);
                }
            }
        }
        for (i, row) in self.rows.iter_mut().enumerate() {
            add(&mut row[i * m..], -kt, &self.basis);
        }
        self.carried = Carried::Anchor;
    }

    /// Sets the derivatives of the slip angle at the beginning of slip.
    fn begin_slip(&mut self, law: &dyn PlaneFriction, path: &PlanePath, piece: &PlanePiece, panel: &SlipPanel) {
        let m = self.set.packed_len();
        let (kt, [_, by_y]) = (law.stiffness(), law.limit());
        if self.carried == Carried::Angle {
            return;
        }
        let here = path.at(piece.start);
        let (sin, cos) = panel.angle.sin_cos();
        let normal = [-sin, cos];
        self.set.basis(piece.start, &mut self.basis);
        if self.carried == Carried::Anchor {
            // An onset: δθ = n·δf/R.
            let inverse = here.limit.recip();
            for (k, a) in self.angle.iter_mut().enumerate() {
                *a = inverse * (normal[0] * self.rows[0][k] + normal[1] * self.rows[1][k]);
            }
            for (i, n) in normal.into_iter().enumerate() {
                add(&mut self.angle[i * m..], inverse * kt * n, &self.basis);
            }
        } else {
            self.angle.fill(0.0);
            let speed = here.rate[0].hypot(here.rate[1]);
            if piece.closes && speed > 0.0 && here.limit_rate > 0.0 {
                differentiate(&self.set, &self.basis, &mut self.slope);
                let second = [0, 1].map(|i| jet(&self.set, path.motion.signal(i), piece.start).ddx);
                let turns = (normal[0] * second[0] + normal[1] * second[1]) / speed;
                for (i, n) in normal.into_iter().enumerate() {
                    add(&mut self.angle[i * m..], kt * n / speed, &self.slope);
                }
                let by_limit = -turns / (here.limit_rate + speed);
                add(&mut self.angle[2 * m..], by_y * by_limit, &self.basis);
            }
        }
        self.carried = Carried::Angle;
    }

    /// Adds the product g ⊗ δ(f − u) of a stick to the Jacobian.
    fn add_stick(&mut self, turn: f64, piece: &PlanePiece, out: &mut Evaluation) {
        let m = self.set.packed_len();
        transform([piece.start, piece.end], turn.recip(), turn, &mut self.transform);
        pack(&self.set, &self.transform, &mut self.g);
        let order = self.directions * m;
        for k in 0..order + 2 {
            let column = if k < order {
                &mut out.jacobian[k * order..][..2 * m]
            } else {
                &mut self.by_start[(k - order) * 2 * m..][..2 * m]
            };
            for (part, row) in column.chunks_exact_mut(m.max(1)).zip(&self.rows) {
                add(part, row[k], &self.g);
            }
        }
    }

    /// Adds the collected panels of slip to the Jacobian.
    fn add_session(&mut self, out: &mut Evaluation, interrupt: &Interrupt<'_>) -> Result<()> {
        if self.session.is_empty() {
            return Ok(());
        }
        let m = self.set.packed_len();
        let order = self.directions * m;
        let by_first = self.session.add_to(&mut out.jacobian, interrupt)?;
        for (k, angle) in self.first_angle.iter().enumerate() {
            let column = if k < order {
                &mut out.jacobian[k * order..][..2 * m]
            } else {
                &mut self.by_start[(k - order) * 2 * m..][..2 * m]
            };
            add(column, *angle, by_first);
        }
        self.session.clear();
        Ok(())
    }

    /// Adds the effect of the force at the start, which returns at the end of the turn.
    fn close(&mut self, law: &dyn PlaneFriction, path: &PlanePath, end: f64, out: &mut Evaluation) {
        let m = self.set.packed_len();
        let (kt, [_, by_y]) = (law.stiffness(), law.limit());
        let order = self.directions * m;
        self.set.basis(end, &mut self.basis);
        if self.carried == Carried::Angle {
            let Some(PlaneForce::Slip(panel)) = path.pieces.last().map(|piece| piece.force) else {
                return;
            };
            let limit = path.at(end).limit;
            let (sin, cos) = panel.end().sin_cos();
            for (row, (n, e)) in self.rows.iter_mut().zip([(-sin, cos), (cos, sin)]) {
                for (r, a) in row.iter_mut().zip(&self.angle) {
                    *r = limit * n * a;
                }
                if self.directions == 3 {
                    add(&mut row[2 * m..], by_y * e, &self.basis);
                }
            }
        } else {
            for (i, row) in self.rows.iter_mut().enumerate() {
                add(&mut row[i * m..], kt, &self.basis);
            }
        }
        let sign = path.sign();
        let [x, y] = &self.rows;
        // (1 − Φ) δz = Φ_X δX
        let phi = [x, y].map(|row| [sign * row[order], sign * row[order + 1]]);
        let a = [[1.0 - phi[0][0], -phi[0][1]], [-phi[1][0], 1.0 - phi[1][1]]];
        let det = a[0][0] * a[1][1] - a[0][1] * a[1][0];
        // Where the force at the start is kept in part, slip has just ended: that part does not move.
        if det == 0.0 {
            return;
        }
        let (first, second) = self.by_start.split_at(2 * m);
        for k in 0..order {
            let right = [sign * x[k], sign * y[k]];
            let z = [
                (a[1][1] * right[0] - a[0][1] * right[1]) / det,
                (a[0][0] * right[1] - a[1][0] * right[0]) / det,
            ];
            let column = &mut out.jacobian[k * order..][..2 * m];
            add(column, z[0], first);
            add(column, z[1], second);
        }
    }
}
