//! Derivatives of the force harmonics of friction in a plane over the panels of one slip, by the motion and by the angle at its start.
//!
//! On one panel, with the nodes j, the Runge–Kutta matrix A, D = −e·u′/R and the derivatives Eⱼ of θ′ by the motion,
//!
//! > δθ = s δθ₀ + G E δX,  s = (1 − hAD)⁻¹ 1,  G = (1 − hAD)⁻¹ hA,  δF = V δθ,
//!
//! with the quadrature V of R n δθ. The angle at the end is that of the last node. Backwards through the panels, λ = V s + λ₊ s_last
//! collects the weight of the angle at the start of a panel in all that follows, so that the contributions of all panels to the
//! Jacobian are one product of matrices, and the angle at the start of the first adds λ ⊗ δθ₀.

use crate::contact::forms::law::PlaneFriction;
use crate::contact::forms::plane_path::{PlanePath, PlanePiece, SlipPanel};
use crate::contact::forms::radau::RADAU_STAGES;
use crate::error::{Result, try_vec};
use crate::fourier::HarmonicSet;
use crate::interrupt::Interrupt;
use crate::linalg::add_outer_products_to;
use crate::linalg::factors::lu::Lu;

/// Products between two checks of a stop.
/// Kind: block.
const SLIP_SESSION_BETWEEN_CHECKS: usize = 10_000_000;

/// Panels that are collected before they are added.
/// Kind: block.
const PANELS: usize = 16;

const CONTEXT: &str = "the derivatives of friction in a plane";

/// The last row of G, and the last number of s, of a panel.
type AtEnd = ([f64; RADAU_STAGES], f64);

/// Successive panels of one slip.
pub(super) struct SlipSession {
    set: HarmonicSet,
    directions: usize,
    panels: usize,
    /// Weights V G, column after column, 2m numbers for each node.
    weights: Vec<f64>,
    /// Derivatives E of the rates θ′, row after row, d·m numbers for each node.
    rates: Vec<f64>,
    /// Sensitivities V s by the angle at the start, of each panel.
    by_angle: Vec<f64>,
    at_end: [AtEnd; PANELS],
    /// Row λ: derivative of the remaining force harmonics by the angle.
    behind: Vec<f64>,
    basis: Vec<f64>,
    slope: Vec<f64>,
    lu: Lu<f64>,
}

impl SlipSession {
    pub fn new(set: &HarmonicSet, directions: usize) -> Result<Self> {
        let m = set.packed_len();
        let memory = |size: usize| try_vec(size, 0.0, CONTEXT);
        let nodes = PANELS * RADAU_STAGES;
        let (weights, rates) = (memory(2 * m * nodes)?, memory(directions * m * nodes)?);
        // The first product of a thread asks for memory; those of an iteration must not.
        let order = directions * m;
        add_outer_products_to(
            (&weights, 2 * m),
            (&rates, order, order),
            order,
            &mut memory(order.saturating_mul(order))?,
        );
        Ok(Self {
            set: set.try_clone()?,
            directions,
            panels: 0,
            weights,
            rates,
            by_angle: memory(2 * m * PANELS)?,
            at_end: [([0.0; RADAU_STAGES], 0.0); PANELS],
            behind: memory(2 * m)?,
            basis: memory(m)?,
            slope: memory(m)?,
            lu: Lu::new(RADAU_STAGES, 1)?,
        })
    }

    pub fn is_empty(&self) -> bool {
        self.panels == 0
    }

    pub fn is_full(&self) -> bool {
        self.panels == PANELS
    }

    pub fn clear(&mut self) {
        self.panels = 0;
    }

    /// Adds a panel, and carries the derivatives of the angle to its end.
    pub fn add(
        &mut self,
        law: &dyn PlaneFriction,
        path: &PlanePath,
        (piece, panel): (&PlanePiece, &SlipPanel),
        angle: &mut [f64],
        interrupt: &Interrupt<'_>,
    ) -> Result<()> {
        let (m, d) = (self.set.packed_len(), self.directions);
        let (kt, [_, by_y]) = (law.stiffness(), law.limit());
        let length = piece.end - piece.start;
        let integrals = &path.tables.integrals;
        let (g, s) = self.stages(panel, length, integrals, interrupt)?;
        let k = self.panels;
        self.panels += 1;
        self.at_end[k] = (core::array::from_fn(|l| g[l][RADAU_STAGES - 1]), s[RADAU_STAGES - 1]);
        let weights = &mut self.weights[k * 2 * m * RADAU_STAGES..(k + 1) * 2 * m * RADAU_STAGES];
        let by_angle = &mut self.by_angle[k * 2 * m..(k + 1) * 2 * m];
        let rates = &mut self.rates[k * d * m * RADAU_STAGES..(k + 1) * d * m * RADAU_STAGES];
        weights.fill(0.0);
        by_angle.fill(0.0);
        let mean = usize::from(self.set.has_mean());
        for (j, rate) in rates.chunks_exact_mut(d * m).enumerate() {
            self.set
                .basis(piece.start + length * path.tables.nodes[j], &mut self.basis);
            differentiate(&self.set, &self.basis, &mut self.slope);
            let [cos, sin] = panel.directions[j];
            let inverse = panel.limits[j].recip();
            let by_motion = [
                -sin * kt * inverse,
                cos * kt * inverse,
                -panel.across[j] * inverse * inverse * by_y,
            ];
            for (i, (part, factor)) in rate.chunks_exact_mut(m).zip(by_motion).enumerate() {
                let signal = if i < 2 { &self.slope } else { &self.basis };
                for (r, b) in part.iter_mut().zip(signal) {
                    *r = factor * b;
                }
            }
            // Twice the mean of a signal times its basis; once for the mean itself.
            let weight = 2.0 * integrals[RADAU_STAGES - 1][j] * length / path.turn * panel.limits[j];
            self.basis[..mean].fill(0.5);
            let normal = [-sin * weight, cos * weight];
            for (l, column) in weights.chunks_exact_mut(2 * m).enumerate() {
                for (part, n) in column.chunks_exact_mut(m).zip(normal) {
                    add(part, n * g[l][j], &self.basis);
                }
            }
            for (part, n) in by_angle.chunks_exact_mut(m).zip(normal) {
                add(part, n * s[j], &self.basis);
            }
        }
        let (row, whole) = self.at_end[k];
        for a in angle.iter_mut() {
            *a *= whole;
        }
        for (factor, rate) in row.into_iter().zip(rates.chunks_exact(d * m)) {
            add(angle, factor, rate);
        }
        Ok(())
    }

    /// Solves for G, column after column, and s of a panel.
    fn stages(
        &mut self,
        panel: &SlipPanel,
        length: f64,
        integrals: &[[f64; RADAU_STAGES]; RADAU_STAGES],
        interrupt: &Interrupt<'_>,
    ) -> Result<([[f64; RADAU_STAGES]; RADAU_STAGES], [f64; RADAU_STAGES])> {
        let matrix = self.lu.matrix();
        for j in 0..RADAU_STAGES {
            let slope = -length * panel.along[j] / panel.limits[j];
            for i in 0..RADAU_STAGES {
                matrix[j * RADAU_STAGES + i] = f64::from(u8::from(i == j)) - slope * integrals[i][j];
            }
        }
        self.lu.factor(interrupt)?;
        let mut g: [[f64; RADAU_STAGES]; RADAU_STAGES] =
            core::array::from_fn(|l| core::array::from_fn(|i| length * integrals[i][l]));
        let mut s = [1.0; RADAU_STAGES];
        for column in &mut g {
            self.lu.solve(column);
        }
        self.lu.solve(&mut s);
        Ok((g, s))
    }

    /// Adds the panels to a Jacobian over all motions, and returns λ, the derivative by the angle at the start.
    pub fn add_to(&mut self, jacobian: &mut [f64], interrupt: &Interrupt<'_>) -> Result<&[f64]> {
        let (m, d) = (self.set.packed_len(), self.directions);
        self.behind.fill(0.0);
        for k in (0..self.panels).rev() {
            let (row, whole) = self.at_end[k];
            let weights = &mut self.weights[k * 2 * m * RADAU_STAGES..(k + 1) * 2 * m * RADAU_STAGES];
            for (column, factor) in weights.chunks_exact_mut((2 * m).max(1)).zip(row) {
                add(column, factor, &self.behind);
            }
            for (behind, by) in self.behind.iter_mut().zip(&self.by_angle[k * 2 * m..]) {
                *behind = by + whole * *behind;
            }
        }
        let nodes = self.panels * RADAU_STAGES;
        let rates = &self.rates[..d * m * nodes];
        // So many columns that a stop waits for about a hundredth of a second.
        let columns = (SLIP_SESSION_BETWEEN_CHECKS / (2 * m * nodes).max(1)).max(1);
        for first in (0..d * m).step_by(columns) {
            let count = columns.min(d * m - first);
            interrupt.check_before((2 * m * nodes * count) as u64)?;
            add_outer_products_to(
                (&self.weights[..2 * m * nodes], 2 * m),
                (&rates[first..], count, d * m),
                d * m,
                &mut jacobian[first * d * m..],
            );
        }
        Ok(&self.behind)
    }
}

/// out ← out + factor·x over the length of x.
pub(super) fn add(out: &mut [f64], factor: f64, x: &[f64]) {
    for (o, x) in out.iter_mut().zip(x) {
        *o += factor * x;
    }
}

/// Derivative of the Fourier basis (cos pτ, −sin pτ) by τ.
pub(super) fn differentiate(set: &HarmonicSet, basis: &[f64], slope: &mut [f64]) {
    let mean = usize::from(set.has_mean());
    slope[..mean].fill(0.0);
    for (k, (pair, s)) in basis[mean..]
        .chunks_exact(2)
        .zip(slope[mean..].chunks_exact_mut(2))
        .enumerate()
    {
        let p = set.reduced(k) as f64;
        s[0] = p * pair[1];
        s[1] = -p * pair[0];
    }
}
