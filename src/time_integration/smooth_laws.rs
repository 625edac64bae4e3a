//! Smooth laws at the nodes of an implicit step: their forces, and their tangents by motions and velocities.
//!
//! A law is evaluated at one time as at the samples of a period in harmonic balance.

use crate::contact::forms::samples::Samples;
use crate::error::{Result, try_vec};
use crate::time_integration::event_law::along;
use crate::time_integration::unrolled_structure::System;

const CONTEXT: &str = "the contacts at a time";

/// Smooth laws at the nodes of a step, with their memory.
pub(crate) struct Smooth {
    /// Index of each element's first tangent among those of a node.
    starts: Vec<usize>,
    /// Tangents by motions, d × d, and by velocities, d × d, of every element; node after node.
    tangents: Vec<f64>,
    /// Number of tangents per node.
    per_node: usize,
    /// Relative motions, velocities and forces of one element; and memory for the law.
    u: Vec<f64>,
    v: Vec<f64>,
    f: Vec<f64>,
    scratch: Vec<f64>,
}

impl Smooth {
    /// Memory for `nodes` times.
    pub fn new(system: &System<'_>, nodes: usize) -> Result<Self> {
        let mut starts = try_vec(system.elements.len(), 0, CONTEXT)?;
        let (mut per_node, mut most) = (0_usize, 0);
        for (start, e) in starts.iter_mut().zip(&system.elements) {
            *start = per_node;
            if e.smooth().is_some() {
                let d = e.rows.len();
                most = most.max(d);
                per_node = per_node.saturating_add(d.saturating_mul(d).saturating_mul(2));
            }
        }
        Ok(Self {
            starts,
            tangents: try_vec(per_node.saturating_mul(nodes), 0.0, CONTEXT)?,
            per_node,
            u: try_vec(most, 0.0, CONTEXT)?,
            v: try_vec(most, 0.0, CONTEXT)?,
            f: try_vec(most, 0.0, CONTEXT)?,
            scratch: try_vec(2 * most, 0.0, CONTEXT)?,
        })
    }

    /// r ← r + Rᵀ f(R x, R v) at a node; the tangents are stored.
    ///
    /// # Errors
    /// Those of a callback.
    pub fn evaluate(&mut self, system: &System<'_>, node: usize, x: &[f64], v: &[f64], r: &mut [f64]) -> Result<()> {
        let tangents = &mut self.tangents[node * self.per_node..(node + 1) * self.per_node];
        tangents.fill(0.0);
        for (e, &start) in system.elements.iter().zip(&self.starts) {
            let Some(law) = e.smooth() else { continue };
            let d = e.rows.len();
            for ((u, w), row) in self.u.iter_mut().zip(&mut self.v).zip(&e.rows) {
                (*u, *w) = (along(row, x), along(row, v));
            }
            let speeds = if law.uses_velocity() { d } else { 0 };
            self.f.fill(0.0);
            self.scratch.fill(0.0);
            let (df_du, df_dv) = tangents[start..start + 2 * d * d].split_at_mut(d * d);
            let out = Samples {
                f: &mut self.f[..d],
                df_du,
                df_dv: &mut df_dv[..speeds * d],
                scratch: &mut self.scratch[..2 * d],
            };
            law.evaluate(system.omega, 1, &self.u[..d], &self.v[..speeds], out)?;
            for (row, f) in e.rows.iter().zip(&self.f) {
                for &(dof, a) in row.iter().flatten() {
                    r[dof] += a * f;
                }
            }
        }
        Ok(())
    }

    /// Copies the tangents of the first node to all.
    pub fn repeat(&mut self) {
        let mut nodes = self.tangents.chunks_exact_mut(self.per_node.max(1));
        if let Some(first) = nodes.next() {
            for node in nodes {
                node.copy_from_slice(first);
            }
        }
    }

    /// Tangents of a smooth element at a node by its motions and by its velocities, d × d each.
    pub fn tangents(&self, node: usize, element: usize, motions: usize) -> (&[f64], &[f64]) {
        let square = motions * motions;
        let at = node * self.per_node + self.starts[element];
        let both = self.tangents.get(at..at + 2 * square).unwrap_or(&[]);
        both.split_at(both.len() / 2)
    }

    /// Visits the nonzero tangents of a node: degree of freedom of the force, degree of freedom of the motion, ∂f/∂x,
    /// ∂f/∂v.
    pub fn each(&self, system: &System<'_>, node: usize, mut visit: impl FnMut(usize, usize, f64, f64)) {
        for (e, &start) in system.elements.iter().zip(&self.starts) {
            if e.smooth().is_none() {
                continue;
            }
            let d = e.rows.len();
            let at = node * self.per_node + start;
            for (i, to) in e.rows.iter().enumerate() {
                for (j, from) in e.rows.iter().enumerate() {
                    let by_x = self.tangents[at + i * d + j];
                    let by_v = self.tangents[at + (d + i) * d + j];
                    if by_x == 0.0 && by_v == 0.0 {
                        continue;
                    }
                    for &(r, a) in to.iter().flatten() {
                        for &(c, b) in from.iter().flatten() {
                            visit(r, c, a * b * by_x, a * b * by_v);
                        }
                    }
                }
            }
        }
    }
}
