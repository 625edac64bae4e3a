//! Perturbations (δx, δv, δw) between two events, where their equations have constant coefficients or those of smooth
//! laws along the motion, several at a time.
//!
//! With constant coefficients the Taylor series is summed, on parts so short that no term is far larger than the
//! result. With smooth laws a perturbation takes the implicit step of the motion, with the tangents at its nodes.

use crate::error::{Result, Status, fail, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::factors::lu::Lu;
use crate::time_integration::gauss::GAUSS_STAGES;
use crate::time_integration::perturbation_products::Products;
use crate::time_integration::variation::{Collocation, Interval};
use crate::time_integration::variational_equations::{
    Number, Numbers, VARIATIONAL_EQUATIONS_LANES, VariationalEquations,
};
use num_complex::Complex64;

const CONTEXT: &str = "a step of perturbations";

/// Share of the largest term at which the series is cut off.
/// Kind: rounding.
const CUT: f64 = 1e-17;

/// Terms of a series.
/// Kind: cap.
const VARIATIONAL_STEP_MOST_TERMS: usize = 200;

/// Largest ratio of a term to the result: so many digits are lost.
/// Kind: tuned; measured on: not recorded.
const LARGEST_TERM: f64 = 100.0;

/// Size of a term from which on the next ones may overflow.
/// Kind: rounding.
const VARIATIONAL_STEP_OVERFLOW: f64 = 1e200;

/// Parts of an interval, beyond which the structure is too stiff.
/// Kind: cap.
const MOST_PARTS: usize = 1 << 20;

/// Steps of perturbations, with their memory.
pub(super) struct VariationalStep<T> {
    /// The matrices of an interval; `None` where a law is smooth.
    products: Option<Products>,
    /// Three neighbouring terms of the series.
    terms: [Vec<Numbers>; 3],
    /// Perturbations at the beginning of a part; and sums of their series.
    begin: [Vec<Numbers>; 2],
    sums: [Vec<Numbers>; 2],
    sliders: Vec<Numbers>,
    /// Largest length of a part that was short enough so far.
    part: f64,
    /// Equations of an implicit step, where a law is smooth; else `None`.
    implicit: Option<Implicit<T>>,
}

struct Implicit<T> {
    lu: Lu<T>,
    accelerations: Vec<T>,
    at_node: Vec<T>,
}

impl<T: Number> VariationalStep<T> {
    /// Memory for steps of `equations`; `smooth`: some law has no events.
    pub fn new(equations: &VariationalEquations<T>, smooth: bool) -> Result<Self> {
        let (products, implicit) = if smooth {
            (None, Some(Implicit::new(equations.order)?))
        } else {
            (Some(Products::new(equations)?), None)
        };
        let n = products.as_ref().map_or(0, Products::order);
        let zeros = |n: usize| try_vec(n, [0.0; VARIATIONAL_EQUATIONS_LANES], CONTEXT);
        Ok(Self {
            terms: [zeros(n)?, zeros(n)?, zeros(n)?],
            begin: [zeros(n)?, zeros(n)?],
            sums: [zeros(n)?, zeros(n)?],
            sliders: zeros(parts::<T>() * equations.sliders)?,
            part: f64::INFINITY,
            products,
            implicit,
        })
    }

    /// Carries perturbations, columns (δx, δv, δw), over the interval.
    pub fn carry(
        &mut self,
        equations: &mut VariationalEquations<T>,
        interval: &Interval<'_>,
        columns: &mut [T],
        interrupt: &Interrupt<'_>,
    ) -> Result<()> {
        let states = equations.states();
        if let (Some(implicit), Some(step)) = (&mut self.implicit, &interval.collocation) {
            implicit.factor(equations, interval, step, interrupt)?;
            // Every stage of every column meets all elements.
            let operations = GAUSS_STAGES as u64 * equations.operations() / VARIATIONAL_EQUATIONS_LANES as u64;
            for column in columns.chunks_exact_mut(states.max(1)) {
                interrupt.check_before(operations)?;
                implicit.carry(equations, interval, step, column);
            }
            return Ok(());
        }
        let Some(products) = &mut self.products else {
            return Ok(());
        };
        products.set(&equations.elements, interval.pieces, equations.sliders)?;
        let n = equations.order;
        for columns in columns.chunks_mut(VARIATIONAL_EQUATIONS_LANES * states.max(1)) {
            self.load(equations, columns);
            self.through(equations, interval.length, interrupt)?;
            for (k, column) in columns.chunks_exact_mut(states).enumerate() {
                let (x, v) = column.split_at_mut(n);
                for (to, from) in [(x, &self.begin[0]), (v, &self.begin[1])] {
                    for (i, to) in to.iter_mut().enumerate().take(n) {
                        let im = from.get(n + i).map_or(0.0, |lanes| lanes[k]);
                        *to = T::of(Complex64::new(from[i][k], im));
                    }
                }
            }
        }
        Ok(())
    }

    /// Loads perturbations as lanes, real parts before imaginary ones; missing ones are zero.
    fn load(&mut self, equations: &VariationalEquations<T>, columns: &[T]) {
        let (n, states, sliders) = (equations.order, equations.states(), equations.sliders);
        let [x, v] = &mut self.begin;
        for (lanes, first, count) in [(x, 0, n), (v, n, n), (&mut self.sliders, 2 * n, sliders)] {
            for (i, lanes) in lanes.iter_mut().enumerate() {
                *lanes = [0.0; VARIATIONAL_EQUATIONS_LANES];
                let (within, part) = (i % count, i / count);
                for (lane, column) in lanes.iter_mut().zip(columns.chunks_exact(states)) {
                    let z = column[first + within].complex();
                    *lane = if part == 0 { z.re } else { z.im };
                }
            }
        }
    }

    fn through(
        &mut self,
        equations: &mut VariationalEquations<T>,
        length: f64,
        interrupt: &Interrupt<'_>,
    ) -> Result<()> {
        let mut done = 0.0;
        let mut tries = 0;
        while done < length {
            let rest = length - done;
            // Equal parts: a short last one would cost as many terms.
            let parts = (rest / self.part).ceil().max(1.0);
            let h = rest / parts;
            if self.series(equations, h, interrupt)? {
                done = if parts > 1.0 { done + h } else { length };
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

    /// Carries the perturbations over one part by the Taylor series; `false` if it is too long, and nothing has
    /// changed.
    fn series(&mut self, equations: &mut VariationalEquations<T>, h: f64, interrupt: &Interrupt<'_>) -> Result<bool> {
        let Some(products) = &self.products else {
            return Ok(true);
        };
        let operations = equations.operations();
        let [x0, v0] = &mut self.begin;
        let [x, v] = &mut self.sums;
        let [this, next, new] = &mut self.terms;
        x.copy_from_slice(x0);
        v.copy_from_slice(v0);
        this.copy_from_slice(x0);
        for ((next, v), x) in next.iter_mut().zip(v0.iter()).zip(x.iter_mut()) {
            for ((next, v), x) in next.iter_mut().zip(v).zip(x) {
                *next = v * h;
                *x += *next;
            }
        }
        let begin = larger(sizes(this, 1.0), sizes(next, 1.0));
        let (mut largest, mut small) = (begin, 0);
        for k in 0..VARIATIONAL_STEP_MOST_TERMS {
            interrupt.check_before(operations)?;
            products.multiply(this, ((k + 1) as f64 / h, next), new);
            if k == 0 {
                products.add_memory(&self.sliders, new);
            }
            if !equations.has_diagonal_mass() {
                // A part that is too long overflows; factors of a mass matrix take finite numbers only.
                if !sizes(new, 1.0).iter().all(|a| *a < VARIATIONAL_STEP_OVERFLOW) {
                    return Ok(false);
                }
                equations.accelerate(new, interrupt)?;
            }
            let scale = h * h / ((k + 1) * (k + 2)) as f64;
            let rate = (k + 2) as f64 / h;
            let mut term = products.add_term(new, x, v, scale, rate);
            for term in &mut term {
                *term *= (k + 2) as f64;
            }
            if !term.iter().copied().all(f64::is_finite) {
                return Ok(false);
            }
            largest = larger(largest, term);
            small = if below(&term, CUT, &largest) { small + 1 } else { 0 };
            if small == 2 {
                let end = larger(begin, larger(sizes(x, 1.0), sizes(v, h)));
                if !below(&largest, LARGEST_TERM, &end) {
                    return Ok(false);
                }
                core::mem::swap(x0, x);
                core::mem::swap(v0, v);
                return Ok(true);
            }
            core::mem::swap(this, next);
            core::mem::swap(next, new);
        }
        Ok(false)
    }
}

/// Number of real numbers that make up one number: 1 or 2.
fn parts<T: Number>() -> usize {
    if T::IS_COMPLEX { 2 } else { 1 }
}

/// Largest modulus of each lane, times a factor.
fn sizes(x: &[Numbers], factor: f64) -> Numbers {
    let mut largest = [0.0_f64; VARIATIONAL_EQUATIONS_LANES];
    for x in x {
        for (m, x) in largest.iter_mut().zip(x) {
            let size = x.abs();
            // Stays NaN once it is.
            *m = if size <= *m || m.is_nan() { *m } else { size };
        }
    }
    largest.map(|m| m * factor)
}

/// The larger one in each lane.
fn larger(mut a: Numbers, b: Numbers) -> Numbers {
    for (a, b) in a.iter_mut().zip(b) {
        *a = a.max(b);
    }
    a
}

/// Whether a ≤ factor·b in each lane.
fn below(a: &Numbers, factor: f64, b: &Numbers) -> bool {
    a.iter().zip(b).all(|(a, b)| *a <= factor * b)
}

impl<T: Number> Implicit<T> {
    fn new(order: usize) -> Result<Self> {
        let all = order.saturating_mul(GAUSS_STAGES);
        Ok(Self {
            lu: Lu::new(all, 1)?,
            accelerations: try_vec(all, T::NONE, CONTEXT)?,
            at_node: try_vec(order, T::NONE, CONTEXT)?,
        })
    }

    /// Factors the matrix δᵢⱼM + h aᵢⱼCᵢ + h² (A²)ᵢⱼKᵢ of the accelerations at the nodes.
    fn factor(
        &mut self,
        equations: &VariationalEquations<T>,
        interval: &Interval<'_>,
        step: &Collocation<'_>,
        interrupt: &Interrupt<'_>,
    ) -> Result<()> {
        let n = equations.order;
        let all = n * GAUSS_STAGES;
        let h = step.step;
        let matrix = self.lu.matrix();
        matrix.fill(T::NONE);
        for i in 0..GAUSS_STAGES {
            interrupt.check()?;
            for (r, c, m) in equations.mass.each() {
                matrix[(i * n + c) * all + i * n + r] += m;
            }
            for j in 0..GAUSS_STAGES {
                let (once, twice) = (h * step.tables.once[i][j], h * h * step.tables.twice[i][j]);
                let mut add = |r: usize, c: usize, value: T| matrix[(j * n + c) * all + i * n + r] += value;
                for (r, c, d) in equations.damping.each() {
                    add(r, c, d.scaled(once));
                }
                for (r, c, k) in equations.stiffness.each() {
                    add(r, c, k.scaled(twice));
                }
                each_tangent(equations, interval, step, i, |r, c, by_x, by_v| {
                    add(r, c, by_x.scaled(twice) + by_v.scaled(once));
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
        equations: &VariationalEquations<T>,
        interval: &Interval<'_>,
        step: &Collocation<'_>,
        z: &mut [T],
    ) {
        let n = equations.order;
        let (motion, w) = z.split_at_mut(2 * n);
        let (x, v) = motion.split_at_mut(n);
        let h = step.step;
        for i in 0..GAUSS_STAGES {
            let c = step.tables.nodes[i];
            for ((at, x), v) in self.at_node.iter_mut().zip(x.iter()).zip(v.iter()) {
                *at = *x + v.scaled(c * h);
            }
            let at_node = &self.at_node;
            let r = &mut self.accelerations[i * n..(i + 1) * n];
            r.fill(T::NONE);
            for (to, from, d) in equations.damping.each() {
                r[to] -= d * v[from];
            }
            for (to, from, k) in equations.stiffness.each() {
                r[to] -= k * at_node[from];
            }
            for element in &equations.elements {
                let piece = &interval.pieces[element.source];
                if let (Some(slider), Some(row)) = (element.slider, element.rows.first()) {
                    let force = w[slider].scaled(piece.memory);
                    for &(dof, a) in row.iter().flatten() {
                        r[dof] += a.conjugate() * force;
                    }
                }
            }
            each_tangent(equations, interval, step, i, |to, from, by_x, by_v| {
                r[to] -= by_x * at_node[from] + by_v * v[from];
            });
        }
        self.lu.solve(&mut self.accelerations);
        let (p, q) = step.tables.weights(step.theta);
        for d in 0..n {
            let (mut once, mut twice) = (T::NONE, T::NONE);
            for j in 0..GAUSS_STAGES {
                let a = self.accelerations[j * n + d];
                once += a.scaled(p[j]);
                twice += a.scaled(q[j]);
            }
            x[d] += (v[d].scaled(step.theta) + twice.scaled(h)).scaled(h);
            v[d] += once.scaled(h);
        }
    }
}

/// Visits the tangents of all contacts at a node: degree of freedom of the force, degree of freedom of the motion,
/// ∂f/∂x, ∂f/∂v.
fn each_tangent<T: Number>(
    equations: &VariationalEquations<T>,
    interval: &Interval<'_>,
    step: &Collocation<'_>,
    node: usize,
    mut visit: impl FnMut(usize, usize, T, T),
) {
    for element in &equations.elements {
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
                        let both = a.conjugate() * b;
                        visit(r, c, both.scaled(slope), both.scaled(damping));
                    }
                }
            }
        }
    }
}
