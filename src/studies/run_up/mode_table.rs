//! A nonlinear mode as a table over its amplitude: an oscillator, and the motions of what is observed and of contacts.

use crate::analysis::synthesis::{Load, Refinement, State, form};
use crate::error::{Result, fail, try_copy, try_push, try_vec};
use crate::interrupt::{Interrupt, Phase};
use crate::linalg::inner;
use crate::linalg::sparse_storage::sparse::Csc;
use crate::model::Model;
use crate::model::matrices::structure::MatrixKind;
use crate::results::Branch;
use crate::studies::run_up::other_modes::OtherModes;
use crate::time_integration::Element;
use num_complex::Complex64;
use std::cmp::Ordering;

const CONTEXT: &str = "the table of a mode";

/// Numbers of a node: ω₀², rate-independent loss, viscous damping, and the force, real and imaginary.
/// Kind: fixed.
const NUMBERS: usize = 5;

/// Difference of a node from the line between its neighbours, relative to ω₀², 2Dω₀² or the force, at which no node is put between.
/// Chosen: it is about the error of the slow flow alone at slow rates, 1e-5 to 1e-4 on the stored runs; not measured by itself.
/// Kind: tuned; measured on: nothing, it is chosen.
const MODE_TABLE_LINE: f64 = 1e-4;

/// Halvings of the distance between two stored points of the mode.
/// Kind: cap.
const MODE_TABLE_HALVINGS: usize = 6;

/// The mode as an oscillator at one amplitude: q″ + c q′ + (ω₀² + i·loss + ic(W − ω₀)) q = force.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Oscillator {
    /// Squared natural frequency ω₀².
    pub square: f64,
    /// Rate-independent loss term, loss factor times stiffness: 2Dω₀² − cω₀ of friction.
    pub loss: f64,
    /// Viscous damping c over the modal mass.
    pub viscous: f64,
    /// Modal force u₁ᴴ F with the mass-normalised fundamental u₁.
    pub force: Complex64,
}

impl Oscillator {
    /// Dynamic stiffness at angular frequency W.
    pub fn stiffness(&self, omega: f64) -> Complex64 {
        Complex64::new(self.square - omega * omega, self.viscous * omega + self.loss)
    }

    /// Decay rate Dω₀ of the free vibration.
    pub fn decay(&self) -> f64 {
        0.5 * (self.viscous + self.loss / self.square.max(f64::MIN_POSITIVE).sqrt())
    }
}

/// A mode over the logarithm of its modal amplitude.
pub(crate) struct ModeTable {
    /// Number of harmonics, the mean included.
    pub harmonics: usize,
    /// Number of relative motions of contacts that are kept.
    rows: usize,
    /// Logarithm ln a of the modal amplitude at each node.
    ln: Vec<f64>,
    numbers: Vec<[f64; NUMBERS]>,
    /// Work of the forces on the whole mode over the modal amplitude, u₁ᴴ F, at each node.
    whole_forces: Vec<Complex64>,
    slopes: Vec<[f64; NUMBERS]>,
    /// Motions at each node: observed displacement, then relative motions, `harmonics` coefficients each; all but the
    /// mean are divided by a.
    motions: Vec<Complex64>,
    /// Whether the first node lies in the linear range.
    is_linear_below: bool,
    /// Whether the amplitude of the mode falls beyond the last node.
    turns: bool,
}

/// Position of an amplitude in the table: index of the node below it, and share of the way to the next one.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Place {
    node: usize,
    share: f64,
    /// The modal amplitude itself.
    amplitude: f64,
}

impl Place {
    /// The modal amplitude at this position.
    pub fn amplitude(&self) -> f64 {
        self.amplitude
    }
}

/// Data of one node before it is stored.
struct Node {
    log10: f64,
    amplitude: f64,
    numbers: [f64; NUMBERS],
    whole_force: Complex64,
    fundamental: Vec<Complex64>,
    motions: Vec<Complex64>,
}

/// Computes nodes of the table.
struct Maker<'a> {
    refinement: Refinement<'a>,
    model: &'a Model,
    load: &'a Load,
    others: &'a OtherModes,
    viscous: Option<Csc>,
    dof: usize,
    elements: &'a [Element],
    harmonics: usize,
    interrupt: &'a Interrupt<'a>,
}

impl ModeTable {
    /// The table of a mode under the forces of `load`, with the displacement of `dof` and the motions of `elements`.
    ///
    /// # Errors
    /// `Argument` where less than two amplitudes rise along the mode; `OutOfMemory`; those of callbacks; `StoppedByCaller`.
    pub fn new(
        branch: &Branch,
        model: &Model,
        (load, others): (&Load, &OtherModes),
        (dof, elements): (usize, &[Element]),
        interrupt: &Interrupt<'_>,
    ) -> Result<Self> {
        let Some(data) = branch.mode_data() else {
            return fail!(Unsupported, "the branch is a forced response, needs a nonlinear mode");
        };
        let points = branch.points();
        // Damping that the mode has or that is added to it follows the velocity.
        let damped = points > 0 && data.point(points - 1).is_some_and(|p| p.structural_loss > 0.0);
        let viscous = if damped || load.damping.is_some() {
            Some(model.structure().wave_matrix(MatrixKind::Damping, 1)?)
        } else {
            None
        };
        let mut maker = Maker {
            refinement: Refinement::new(branch, data, load, interrupt)?,
            model,
            load,
            others,
            viscous,
            dof,
            elements,
            harmonics: branch.harmonics() + 1,
            interrupt,
        };
        let linear = data.info.linear_up_to;
        let mut nodes: Vec<Node> = Vec::new();
        let mut turns = false;
        for k in 0..points.saturating_sub(1) {
            interrupt.part(Phase::Results, k, points)?;
            let at = |i: usize| data.point(i).map_or(f64::NAN, |p| p.log10_amplitude);
            let (low, high) = (at(k), at(k + 1));
            // A NaN ends the table too.
            if high.partial_cmp(&low) != Some(Ordering::Greater) {
                turns = true;
                break;
            }
            if nodes.is_empty() {
                let Some(first) = maker.node(k, low)? else { break };
                try_push(&mut nodes, first, CONTEXT)?;
            }
            // A node stands where the contacts begin to slip.
            let onset = (linear > low && linear < high).then_some(linear);
            for end in [onset, Some(high)].into_iter().flatten() {
                let Some(last) = maker.node(k, end)? else { break };
                if end > linear {
                    maker.between(k, &mut nodes, last)?;
                } else {
                    try_push(&mut nodes, last, CONTEXT)?;
                }
            }
        }
        // The amplitude falls beyond a fold.
        let rising = nodes.windows(2).take_while(|n| n[1].amplitude > n[0].amplitude).count();
        turns |= rising + 1 < nodes.len();
        nodes.truncate(rising + 1);
        if nodes.len() < 2 {
            return fail!(Argument, "the mode has less than two rising amplitudes");
        }
        let mut table = Self::of(nodes, &maker, linear)?;
        table.turns = turns;
        Ok(table)
    }

    fn of(mut nodes: Vec<Node>, maker: &Maker<'_>, linear: f64) -> Result<Self> {
        let rows = maker.elements.iter().map(|e| e.rows.len()).sum();
        let harmonics = maker.harmonics;
        let mut table = Self {
            harmonics,
            rows,
            ln: Vec::new(),
            numbers: Vec::new(),
            whole_forces: Vec::new(),
            slopes: Vec::new(),
            motions: Vec::new(),
            is_linear_below: nodes[0].log10 <= linear,
            turns: false,
        };
        // The phase of the mode along the amplitude: u₁ᴴ M du₁/da = 0.
        let mass = maker.model.structure().wave_matrix(MatrixKind::Mass, 1)?;
        let (mut angle, mut weighted) = (
            0.0,
            try_vec(mass.col_ptr.len().saturating_sub(1), Complex64::ZERO, CONTEXT)?,
        );
        for (k, node) in nodes.iter_mut().enumerate() {
            if k > 0 {
                let s = inner(&node.fundamental, &weighted);
                if s.norm() > 0.0 {
                    angle += s.arg();
                }
            }
            weighted.fill(Complex64::ZERO);
            for (j, x) in node.fundamental.iter().enumerate() {
                for (i, v) in mass.column(j) {
                    weighted[i] += v * x;
                }
            }
            // Each node is turned against its own phase alone, so that products stay those of stored vectors.
            let turn = Complex64::cis(angle);
            for motion in node.motions.chunks_exact_mut(harmonics) {
                let mut power = Complex64::ONE;
                for (h, x) in motion.iter_mut().enumerate() {
                    *x *= power / if h == 0 { 1.0 } else { node.amplitude };
                    power *= turn;
                }
            }
            let force = Complex64::new(node.numbers[3], node.numbers[4]) * turn.conj();
            (node.numbers[3], node.numbers[4]) = (force.re, force.im);
            try_push(&mut table.whole_forces, node.whole_force * turn.conj(), CONTEXT)?;
            try_push(&mut table.ln, node.amplitude.ln(), CONTEXT)?;
            try_push(&mut table.numbers, node.numbers, CONTEXT)?;
            crate::error::try_extend(&mut table.motions, &node.motions, CONTEXT)?;
        }
        table.slopes = monotone_slopes(&table.ln, &table.numbers)?;
        Ok(table)
    }

    /// The table with the force u₁ᴴ F on the whole nonlinear mode in place of that along its linear shape. The other modes then act on
    /// this one by its shape u₁ alone, so that a slow flow needs no forces of contacts from their motions.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn under_whole_force(&self) -> Result<Self> {
        let mut numbers = try_copy(&self.numbers, CONTEXT)?;
        for (numbers, force) in numbers.iter_mut().zip(&self.whole_forces) {
            (numbers[3], numbers[4]) = (force.re, force.im);
        }
        Ok(Self {
            harmonics: self.harmonics,
            rows: self.rows,
            ln: try_copy(&self.ln, CONTEXT)?,
            slopes: monotone_slopes(&self.ln, &numbers)?,
            numbers,
            whole_forces: try_copy(&self.whole_forces, CONTEXT)?,
            motions: try_copy(&self.motions, CONTEXT)?,
            is_linear_below: self.is_linear_below,
            turns: self.turns,
        })
    }

    /// Least and largest modal amplitude of the nodes.
    pub fn range(&self) -> (f64, f64) {
        (self.ln[0].exp(), self.ln[self.ln.len() - 1].exp())
    }

    /// Modal amplitudes of the nodes.
    pub fn amplitudes(&self) -> impl Iterator<Item = f64> + '_ {
        self.ln.iter().map(|ln| ln.exp())
    }

    /// Sentence on the course of the mode beyond the last node.
    pub fn what_goes_further(&self) -> &'static str {
        if self.turns {
            "a mode whose amplitude has a fold there does not describe larger motions: integrate them with a time sweep"
        } else {
            "compute it to a larger amplitude"
        }
    }

    /// Finds the position of an amplitude, searching from the one found last.
    ///
    /// # Errors
    /// `Argument` beyond the amplitudes of the mode.
    pub fn find(&self, amplitude: f64, last: &mut Place) -> Result<()> {
        let (ln, top) = (amplitude.ln(), self.ln.len() - 1);
        let mut node = last.node.min(top - 1);
        if ln < self.ln[0] {
            if !self.is_linear_below && amplitude > 0.0 && ln < self.ln[0] - 1e-9 {
                return fail!(
                    Argument,
                    "the modal amplitude falls to {amplitude:.3e}, the mode begins at {:.3e} above its linear range; compute it from a smaller \
                     amplitude on",
                    self.range().0
                );
            }
            *last = Place {
                node: 0,
                share: 0.0,
                amplitude,
            };
            return Ok(());
        }
        if ln.is_nan() || ln > self.ln[top] + 1e-12 {
            return fail!(
                Argument,
                "the modal amplitude reaches {amplitude:.3e}, the mode {} {:.3e}; {}",
                if self.turns { "turns back at" } else { "ends at" },
                self.range().1,
                self.what_goes_further()
            );
        }
        while node > 0 && ln < self.ln[node] {
            node -= 1;
        }
        while node + 1 < top && ln > self.ln[node + 1] {
            node += 1;
        }
        *last = Place {
            node,
            share: (ln - self.ln[node]) / (self.ln[node + 1] - self.ln[node]),
            amplitude,
        };
        Ok(())
    }

    /// The oscillator at a position of the table, by monotone cubics.
    pub fn oscillator(&self, at: &Place) -> Oscillator {
        let (k, s) = (at.node, at.share);
        let h = self.ln[k + 1] - self.ln[k];
        let (a, b) = (1.0 - s, s);
        let (value_a, value_b) = (a * a * (1.0 + 2.0 * s), b * b * (3.0 - 2.0 * s));
        let (slope_a, slope_b) = (h * s * a * a, -h * a * b * b);
        let mut n = [0.0; NUMBERS];
        for (i, n) in n.iter_mut().enumerate() {
            *n = value_a * self.numbers[k][i]
                + value_b * self.numbers[k + 1][i]
                + slope_a * self.slopes[k][i]
                + slope_b * self.slopes[k + 1][i];
        }
        Oscillator {
            square: n[0],
            loss: n[1],
            viscous: n[2],
            force: Complex64::new(n[3], n[4]),
        }
    }

    /// Coefficient h of a motion at a position of the table; motion 0 is the observed one, the relative motions
    /// follow.
    pub fn coefficient(&self, at: &Place, motion: usize, h: usize) -> Complex64 {
        let stride = (1 + self.rows) * self.harmonics;
        let i = at.node * stride + motion * self.harmonics + h;
        let unit = if h == 0 { 1.0 } else { at.amplitude };
        (self.motions[i] * (1.0 - at.share) + self.motions[i + stride] * at.share) * unit
    }

    /// Value of a motion and its derivative by the phase; `powers` are the powers of e^(i·phase).
    pub fn value(&self, at: &Place, motion: usize, powers: &[Complex64]) -> (f64, f64) {
        let (mut x, mut slope) = (0.0, 0.0);
        for (h, power) in powers.iter().enumerate() {
            let term = self.coefficient(at, motion, h) * power;
            x += term.re;
            slope -= h as f64 * term.im;
        }
        (x, slope)
    }
}

impl Maker<'_> {
    /// The node at an amplitude between points k and k + 1; `None` where the mode is not found at this amplitude.
    fn node(&mut self, k: usize, log10: f64) -> Result<Option<Node>> {
        self.interrupt.check()?;
        let Some(state) = self.refinement.state_at(k, log10)? else {
            return Ok(None);
        };
        let all = self.refinement.harmonics(&state, Complex64::ONE)?;
        let ndof = self.model.ndof();
        let degrees = self.model.structure().degrees();
        let own = degrees.independent();
        let count = (all.len() / ndof).min(self.harmonics);
        let mut independent = try_vec(count * own, Complex64::ZERO, CONTEXT)?;
        for (x, all) in independent.chunks_exact_mut(own).zip(all.chunks_exact(ndof)) {
            degrees.restrict(all, x);
        }
        let rows: usize = self.elements.iter().map(|e| e.rows.len()).sum();
        let mut motions = try_vec((1 + rows) * self.harmonics, Complex64::ZERO, CONTEXT)?;
        for h in 0..count {
            motions[h] = all[h * ndof + self.dof];
        }
        let lists = self.elements.iter().flat_map(|e| &e.rows);
        for (motion, row) in motions.chunks_exact_mut(self.harmonics).skip(1).zip(lists) {
            for (h, x) in independent.chunks_exact(own).enumerate() {
                motion[h] = row.iter().flatten().map(|&(dof, a)| x[dof] * a).sum();
            }
        }
        let mut fundamental = try_vec(own, Complex64::ZERO, CONTEXT)?;
        fundamental.copy_from_slice(&independent[own..2 * own]);
        let numbers = self.numbers(&state, &fundamental);
        Ok(Some(Node {
            log10,
            amplitude: state.square.sqrt(),
            numbers,
            whole_force: state.work / state.square.sqrt(),
            fundamental,
            motions,
        }))
    }

    fn numbers(&self, state: &State, x: &[Complex64]) -> [f64; NUMBERS] {
        let mut viscous = 2.0 * self.load.ratio * state.omega;
        if let Some(c) = &self.viscous {
            viscous += form(c, x) / state.square;
        }
        // With the other modes beside it, the mode takes the force along its own linear shape.
        let amplitude = state.square.sqrt();
        let force = match &self.others.own {
            Some((weighted, force)) if !self.others.is_empty() => inner(x, weighted) * force / amplitude,
            _ => state.work / amplitude,
        };
        [
            state.omega * state.omega,
            2.0 * state.damping * state.omega * state.omega - viscous * state.omega,
            viscous,
            force.re,
            force.im,
        ]
    }

    /// Appends `last` to the nodes, after those between it and the last one of the list that interpolation needs.
    fn between(&mut self, k: usize, nodes: &mut Vec<Node>, last: Node) -> Result<()> {
        let mut open: Vec<(Node, usize)> = Vec::new();
        try_push(&mut open, (last, 0), CONTEXT)?;
        while let Some((end, depth)) = open.pop() {
            let Some(begin) = nodes.last() else { break };
            let middle = if depth < MODE_TABLE_HALVINGS {
                let log10 = 0.5 * (begin.log10 + end.log10);
                self.node(k, log10)?
            } else {
                None
            };
            let begin = &nodes[nodes.len() - 1];
            match middle {
                Some(middle) if !on_line(begin, &middle, &end) => {
                    try_push(&mut open, (end, depth + 1), CONTEXT)?;
                    try_push(&mut open, (middle, depth + 1), CONTEXT)?;
                }
                Some(middle) => {
                    try_push(nodes, middle, CONTEXT)?;
                    try_push(nodes, end, CONTEXT)?;
                }
                None => try_push(nodes, end, CONTEXT)?,
            }
        }
        Ok(())
    }
}

fn on_line(a: &Node, middle: &Node, b: &Node) -> bool {
    let s = (middle.amplitude.ln() - a.amplitude.ln()) / (b.amplitude.ln() - a.amplitude.ln());
    let n = &middle.numbers;
    let total = (n[1] + n[2] * n[0].max(0.0).sqrt()).abs();
    let force = n[3].hypot(n[4]);
    let allowed = [total, total, total, force, force];
    (0..NUMBERS).all(|i| {
        let line = (1.0 - s) * a.numbers[i] + s * b.numbers[i];
        let unit = if i == 2 { n[0].max(0.0).sqrt() } else { 1.0 };
        unit * (n[i] - line).abs() <= MODE_TABLE_LINE * allowed[i]
    })
}

/// Slopes of cubics that are monotone where the values are (Fritsch & Butland 1984, doi:10.1137/0905021).
fn monotone_slopes(x: &[f64], y: &[[f64; NUMBERS]]) -> Result<Vec<[f64; NUMBERS]>> {
    let n = x.len();
    let mut slopes = try_vec(n, [0.0; NUMBERS], CONTEXT)?;
    for i in 0..NUMBERS {
        let secant = |k: usize| (y[k + 1][i] - y[k][i]) / (x[k + 1] - x[k]);
        slopes[0][i] = secant(0);
        slopes[n - 1][i] = secant(n - 2);
        for k in 1..n - 1 {
            let (left, right) = (secant(k - 1), secant(k));
            if left * right > 0.0 {
                let (h, g) = (x[k] - x[k - 1], x[k + 1] - x[k]);
                let (w, v) = (2.0 * g + h, g + 2.0 * h);
                slopes[k][i] = (w + v) / (w / left + v / right);
            }
        }
    }
    Ok(slopes)
}
