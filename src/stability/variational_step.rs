//! One perturbation (δx, δv, δw) between two events, where its equations have constant coefficients or those of smooth
//! laws along the motion.
//!
//! M δẍ + C δẋ + K δx + Rᴴ(S R δx − kt δw) = 0 with the slopes S of the contacts, and δw constant. With constant
//! coefficients the Taylor series is summed, on parts so short that no term is far larger than the result. With smooth
//! laws the perturbation takes the implicit step of the motion, with the tangents at its nodes.

use crate::error::{Result, Status, fail, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::lu::Lu;
use crate::stability::ring::{Ring, along, pull};
use crate::time_integration::{Collocation, Interval, STAGES};
use num_complex::Complex64;

const CONTEXT: &str = "a step of a perturbation";

/// Share of the largest term at which the series is cut off.
const CUT: f64 = 1e-17;

/// Terms of a series.
const MOST_TERMS: usize = 200;

/// Largest ratio of a term to the result: so many digits are lost.
const LARGEST_TERM: f64 = 100.0;

/// Size of a term from which on the next ones may overflow.
const OVERFLOW: f64 = 1e200;

/// Parts of an interval, beyond which the structure is too stiff.
const MOST_PARTS: usize = 1 << 20;

/// Memory of the steps of one ring.
pub(super) struct VariationalStep {
    /// Three neighbouring terms of the series.
    terms: [Vec<Complex64>; 3],
    x: Vec<Complex64>,
    v: Vec<Complex64>,
    /// Largest length of a part so far found short enough; 0: none was tried.
    part: f64,
    /// Equations of an implicit step, where a law is smooth.
    implicit: Option<Implicit>,
}

struct Implicit {
    lu: Lu<Complex64>,
    accelerations: Vec<Complex64>,
}

impl VariationalStep {
    /// Memory for steps of `ring`; `smooth`: some law has no events.
    pub fn new(ring: &Ring, smooth: bool) -> Result<Self> {
        let zeros = || try_vec(ring.order, Complex64::ZERO, CONTEXT);
        let all = ring.order.saturating_mul(STAGES);
        let implicit = Implicit {
            lu: Lu::new(if smooth { all } else { 0 }, 1)?,
            accelerations: try_vec(if smooth { all } else { 0 }, Complex64::ZERO, CONTEXT)?,
        };
        Ok(Self {
            terms: [zeros()?, zeros()?, zeros()?],
            x: zeros()?,
            v: zeros()?,
            part: f64::INFINITY,
            implicit: smooth.then_some(implicit),
        })
    }

    /// Prepares the steps of all perturbations over an interval.
    pub fn prepare(&mut self, ring: &Ring, interval: &Interval<'_>, interrupt: &Interrupt<'_>) -> Result<()> {
        match (&mut self.implicit, &interval.collocation) {
            (Some(implicit), Some(step)) => implicit.factor(ring, interval, step, interrupt),
            _ => Ok(()),
        }
    }

    /// Carries one perturbation, (δx, δv, δw) in `z`, over the interval.
    pub fn carry(
        &mut self,
        ring: &mut Ring,
        interval: &Interval<'_>,
        z: &mut [Complex64],
        interrupt: &Interrupt<'_>,
    ) -> Result<()> {
        if let (Some(implicit), Some(step)) = (&mut self.implicit, &interval.collocation) {
            implicit.carry(ring, interval, step, z, &mut self.x);
            return Ok(());
        }
        let mut done = 0.0;
        let mut tries = 0;
        while done < interval.length {
            let rest = interval.length - done;
            let h = self.part.min(rest);
            if self.series(ring, interval, h, z, interrupt)? {
                done = if h < rest { done + h } else { interval.length };
            } else {
                self.part = 0.5 * h;
                tries += 1;
                if tries > MOST_PARTS {
                    return fail!(NoConvergence, "perturbations grow beyond all bounds");
                }
            }
        }
        Ok(())
    }

    /// One part by the Taylor series; `false`: it is too long, and nothing has changed.
    fn series(
        &mut self,
        ring: &mut Ring,
        interval: &Interval<'_>,
        h: f64,
        z: &mut [Complex64],
        interrupt: &Interrupt<'_>,
    ) -> Result<bool> {
        let n = ring.order;
        let (motion, w) = z.split_at_mut(2 * n);
        let (x0, v0) = motion.split_at_mut(n);
        self.x.copy_from_slice(x0);
        self.v.copy_from_slice(v0);
        let [this, next, new] = &mut self.terms;
        this.copy_from_slice(x0);
        for ((next, v), x) in next.iter_mut().zip(v0.iter()).zip(self.x.iter_mut()) {
            *next = h * v;
            *x += *next;
        }
        let size = |x: &[Complex64]| x.iter().fold(0.0_f64, |m, c| m.max(c.norm_sqr())).sqrt();
        let begin = size(this).max(size(next));
        let (mut largest, mut small) = (begin, 0);
        for k in 0..MOST_TERMS {
            interrupt.check_before((ring.stiffness.values.len() + ring.damping.values.len() + n) as u64)?;
            new.fill(Complex64::ZERO);
            ring.stiffness.multiply_add(-Complex64::ONE, this, new);
            ring.damping.multiply_add((-((k + 1) as f64) / h).into(), next, new);
            for element in &ring.elements {
                let piece = &interval.pieces[element.source];
                let mut y = [Complex64::ZERO; 2];
                for (y, row) in y.iter_mut().zip(&element.rows) {
                    *y = along(row, this);
                }
                for (i, (row, slope)) in element.rows.iter().zip(&piece.slope).enumerate() {
                    let mut force = slope[0] * y[0] + slope[1] * y[1];
                    if let (0, 0, Some(slider)) = (k, i, element.slider) {
                        force -= piece.memory * w[slider];
                    }
                    if force != Complex64::ZERO {
                        pull(row, force, new);
                    }
                }
            }
            // A part that is too long overflows.
            if !new.iter().all(|a| a.norm() < OVERFLOW) {
                return Ok(false);
            }
            ring.accelerate(new, interrupt)?;
            let scale = h * h / ((k + 1) * (k + 2)) as f64;
            let mut term = 0.0_f64;
            for ((new, x), v) in new.iter_mut().zip(&mut self.x).zip(&mut self.v) {
                *new *= scale;
                *x += *new;
                *v += (k + 2) as f64 / h * *new;
                term = term.max((k + 2) as f64 * new.norm());
            }
            largest = largest.max(term);
            if !term.is_finite() {
                return Ok(false);
            }
            small = if term <= CUT * largest { small + 1 } else { 0 };
            if small == 2 {
                let end = size(&self.x).max(h * size(&self.v)).max(begin);
                if largest > LARGEST_TERM * end {
                    return Ok(false);
                }
                x0.copy_from_slice(&self.x);
                v0.copy_from_slice(&self.v);
                return Ok(true);
            }
            core::mem::swap(this, next);
            core::mem::swap(next, new);
        }
        Ok(false)
    }
}

impl Implicit {
    /// The matrix δᵢⱼM + h aᵢⱼCᵢ + h² (A²)ᵢⱼKᵢ of the accelerations at the nodes.
    fn factor(
        &mut self,
        ring: &Ring,
        interval: &Interval<'_>,
        step: &Collocation<'_>,
        interrupt: &Interrupt<'_>,
    ) -> Result<()> {
        let n = ring.order;
        let all = n * STAGES;
        let h = step.step;
        let matrix = self.lu.matrix();
        matrix.fill(Complex64::ZERO);
        for i in 0..STAGES {
            interrupt.check()?;
            for c in 0..n {
                for (r, m) in ring.mass.column(c) {
                    matrix[(i * n + c) * all + i * n + r] += m;
                }
            }
            for j in 0..STAGES {
                let (once, twice) = (h * step.tables.once[i][j], h * h * step.tables.twice[i][j]);
                let mut add = |r: usize, c: usize, value: Complex64| matrix[(j * n + c) * all + i * n + r] += value;
                for c in 0..n {
                    for (r, d) in ring.damping.column(c) {
                        add(r, c, once * d);
                    }
                    for (r, k) in ring.stiffness.column(c) {
                        add(r, c, twice * k);
                    }
                }
                each_tangent(ring, interval, step, i, |r, c, by_x, by_v| {
                    add(r, c, twice * by_x + once * by_v);
                });
            }
        }
        match self.lu.factor(interrupt) {
            Err(e) if e.status == Status::Singular => fail!(
                NoConvergence,
                "an implicit step of the perturbations has no solution; use a smaller tolerance"
            ),
            other => other,
        }
    }

    fn carry(
        &mut self,
        ring: &Ring,
        interval: &Interval<'_>,
        step: &Collocation<'_>,
        z: &mut [Complex64],
        at_node: &mut [Complex64],
    ) {
        let n = ring.order;
        let (motion, w) = z.split_at_mut(2 * n);
        let (x, v) = motion.split_at_mut(n);
        let h = step.step;
        for i in 0..STAGES {
            let c = step.tables.nodes[i];
            for ((at, x), v) in at_node.iter_mut().zip(x.iter()).zip(v.iter()) {
                *at = x + c * h * v;
            }
            let r = &mut self.accelerations[i * n..(i + 1) * n];
            r.fill(Complex64::ZERO);
            ring.damping.multiply_add(-Complex64::ONE, v, r);
            ring.stiffness.multiply_add(-Complex64::ONE, at_node, r);
            for element in &ring.elements {
                let piece = &interval.pieces[element.source];
                if let (Some(slider), Some(row)) = (element.slider, element.rows.first()) {
                    pull(row, -piece.memory * w[slider], r);
                }
            }
            each_tangent(ring, interval, step, i, |to, from, by_x, by_v| {
                r[to] -= by_x * at_node[from] + by_v * v[from];
            });
        }
        self.lu.solve(&mut self.accelerations);
        let (p, q) = step.tables.weights(step.theta);
        for d in 0..n {
            let (mut once, mut twice) = (Complex64::ZERO, Complex64::ZERO);
            for j in 0..STAGES {
                once += p[j] * self.accelerations[j * n + d];
                twice += q[j] * self.accelerations[j * n + d];
            }
            x[d] += h * (step.theta * v[d] + h * twice);
            v[d] += h * once;
        }
    }
}

/// Visits the tangents of all contacts at a node: (degree of freedom of the force, that of the motion, ∂f/∂x, ∂f/∂v).
fn each_tangent(
    ring: &Ring,
    interval: &Interval<'_>,
    step: &Collocation<'_>,
    node: usize,
    mut visit: impl FnMut(usize, usize, Complex64, Complex64),
) {
    for element in &ring.elements {
        let d = element.rows.len();
        let (by_x, by_v) = if element.smooth {
            step.smooth.tangents(node, element.source, d)
        } else {
            (&[][..], &[][..])
        };
        let piece = &interval.pieces[element.source];
        for (i, to) in element.rows.iter().enumerate() {
            for (j, from) in element.rows.iter().enumerate() {
                let slope = match (piece.slope.get(i), element.smooth) {
                    (Some(slopes), false) => slopes.get(j).copied().unwrap_or(0.0),
                    _ => by_x.get(i * d + j).copied().unwrap_or(0.0),
                };
                let damping = by_v.get(i * d + j).copied().unwrap_or(0.0);
                if slope == 0.0 && damping == 0.0 {
                    continue;
                }
                for &(r, a) in to.iter().flatten() {
                    for &(c, b) in from.iter().flatten() {
                        visit(r, c, a.conj() * b * slope, a.conj() * b * damping);
                    }
                }
            }
        }
    }
}
