//! Designs whose parameters change, and their results: shared by the tests of derivatives.

use crate::common::{BETA, Blisk, SECTORS, harmonics, omega_range};
use hbvib::{
    Branch, Constant, Contact, Hooks, MatrixKind, MatrixView, ModeOptions, Model, Parameter, Part, Quantity, Reason,
    SolverOptions, Speed, forced_response, nonlinear_mode, sensitivity,
};
use num_complex::Complex64;

/// A model as the numbers that it is made of.
#[derive(Clone, Debug)]
pub struct Design {
    pub ndof: usize,
    pub sectors: usize,
    pub engine_order: i64,
    /// Mass, damping and stiffness, column-major.
    pub matrices: [Vec<f64>; 3],
    /// Couplings to the next sector; empty: none.
    pub couplings: [Vec<f64>; 3],
    pub rayleigh: (f64, f64),
    pub loss_factor: f64,
    /// Gyroscopic matrix and K₁; empty: none.
    pub rotating: [Vec<f64>; 2],
    pub speed: f64,
    /// Normal loads N₀ + cΩ² as (contact, N₀, c).
    pub speed_loads: Vec<(usize, f64, f64)>,
    pub contacts: Vec<Contact>,
    pub forces: Vec<(usize, usize, Complex64)>,
}

/// A parameter of a design.
#[derive(Clone, Debug)]
pub enum Change {
    Force,
    Contact(Constant, Option<usize>),
    Direction(MatrixKind, Vec<f64>),
    Factor(MatrixKind),
    Speed,
}

const KINDS: [MatrixKind; 3] = [MatrixKind::Mass, MatrixKind::Damping, MatrixKind::Stiffness];

impl Design {
    /// A plain structure with these matrices.
    pub fn plain(ndof: usize, matrices: [Vec<f64>; 3]) -> Self {
        Self {
            ndof,
            sectors: 1,
            engine_order: 0,
            matrices,
            couplings: Default::default(),
            rayleigh: (0.0, 0.0),
            loss_factor: 0.0,
            rotating: Default::default(),
            speed: 0.0,
            speed_loads: Vec::new(),
            contacts: Vec::new(),
            forces: Vec::new(),
        }
    }

    /// The sector of the ring damper under a normal load.
    pub fn ring_damper(case: &Blisk, preload: f64) -> Self {
        let a = case.matrices();
        Self {
            sectors: SECTORS,
            engine_order: case.engine_order,
            couplings: [Vec::new(), Vec::new(), a.next],
            rayleigh: (0.0, BETA),
            contacts: vec![case.contact().with(Constant::Preload, preload).unwrap()],
            forces: [0, 1].map(|dof| (dof, 1, case.force.into())).to_vec(),
            ..Self::plain(a.n, [a.mass, vec![0.0; a.n * a.n], a.own])
        }
    }

    pub fn model(&self) -> Model {
        let n = self.ndof;
        let mut model = Model::cyclic(n, self.sectors).unwrap();
        let view = |a| MatrixView::dense(n, a).part(Part::Full);
        for (i, kind) in KINDS.into_iter().enumerate() {
            model.set_matrix(kind, &view(&self.matrices[i])).unwrap();
            if !self.couplings[i].is_empty() {
                model.set_coupling(kind, &view(&self.couplings[i])).unwrap();
            }
        }
        for (kind, a) in [MatrixKind::Gyroscopic, MatrixKind::StiffnessSpeed2]
            .into_iter()
            .zip(&self.rotating)
        {
            if !a.is_empty() {
                model.set_matrix(kind, &view(a)).unwrap();
            }
        }
        model.set_rayleigh(self.rayleigh.0, self.rayleigh.1).unwrap();
        model.set_loss_factor(self.loss_factor).unwrap();
        model.set_wave(self.engine_order);
        for contact in &self.contacts {
            model.add_contact(contact).unwrap();
        }
        model.set_speed(Speed::Fixed(self.speed)).unwrap();
        for &(id, preload, per_speed2) in &self.speed_loads {
            model.set_preload_at_speed(id, preload, per_speed2).unwrap();
        }
        for &(dof, harmonic, value) in &self.forces {
            model.add_force(dof, harmonic, value).unwrap();
        }
        model
    }

    /// The design with a parameter increased by `step` of its scale, and this step in the unit of the parameter.
    pub fn changed(&self, change: &Change, step: f64) -> (Self, f64) {
        let mut new = self.clone();
        let index = |kind: &MatrixKind| KINDS.iter().position(|k| k == kind).unwrap();
        let step = match change {
            Change::Force => {
                for force in &mut new.forces {
                    force.2 *= 1.0 + step;
                }
                step
            }
            Change::Contact(constant, contact) => {
                let with = new.contacts.len();
                let range = contact.map_or(0..with, |c| c..c + 1);
                let scale = new.contacts[range.start].constant(*constant).abs();
                let step = step * if scale == 0.0 { 0.01 } else { scale };
                for contact in &mut new.contacts[range] {
                    if contact.by_constant(*constant).is_some() {
                        contact.set(*constant, contact.constant(*constant) + step).unwrap();
                    }
                }
                step
            }
            Change::Direction(kind, direction) => {
                for (a, d) in new.matrices[index(kind)].iter_mut().zip(direction) {
                    *a += step * d;
                }
                step
            }
            Change::Factor(kind) => {
                let i = index(kind);
                for a in new.matrices[i].iter_mut().chain(&mut new.couplings[i]) {
                    *a *= 1.0 + step;
                }
                if *kind == MatrixKind::Damping {
                    new.rayleigh.0 *= 1.0 + step;
                    new.rayleigh.1 *= 1.0 + step;
                }
                step
            }
            Change::Speed => {
                let step = step * new.speed.abs().max(0.1);
                new.speed += step;
                step
            }
        };
        (new, step)
    }
}

impl Change {
    /// First step of the differences. A change of the structure shifts its narrow resonances.
    fn first_step(&self) -> f64 {
        match self {
            Self::Factor(MatrixKind::Mass | MatrixKind::Stiffness) => 1e-5,
            Self::Direction(..) => 1.0,
            _ => 3e-4,
        }
    }

    pub fn parameter<'a>(&'a self, design: &Design) -> Parameter<'a> {
        match self {
            Self::Force => Parameter::Force,
            Self::Contact(constant, contact) => Parameter::Contact {
                constant: *constant,
                contact: *contact,
            },
            Self::Direction(which, a) => Parameter::Direction {
                which: *which,
                direction: MatrixView::dense(design.ndof, a),
            },
            Self::Factor(which) => Parameter::Factor { which: *which },
            Self::Speed => Parameter::Speed,
        }
    }
}

/// Results of a design, and how they are found.
#[derive(Clone, Copy, Debug)]
pub enum Results {
    /// Amplitude at a frequency.
    At(f64),
    /// Amplitude and frequency of the highest peak in a range.
    Peak(f64, f64),
    /// Frequency and damping ratio of a nonlinear mode at its last amplitude.
    Mode(ModeOptions<'static>),
}

/// Options for solutions to the last digits.
pub fn tight(highest: usize) -> SolverOptions {
    SolverOptions {
        tol_residual: 1e-12,
        response_dof: Some(0),
        ..harmonics(highest)
    }
}

impl Results {
    /// The branch with the results, their point, and their values.
    pub fn solve(self, model: &Model, solver: &SolverOptions) -> (Branch, usize, Vec<(Quantity, f64)>) {
        let hooks = &mut Hooks::default();
        let (omega_start, omega_stop) = match self {
            Self::At(omega) => (omega, omega),
            Self::Peak(from, to) => (from, to),
            Self::Mode(options) => {
                let branch = nonlinear_mode(model, solver, &options, hooks).unwrap();
                let last = branch.points() - 1;
                let values = vec![
                    (Quantity::ModeOmega, branch.omega()[last]),
                    (Quantity::ModeDamping, branch.mode_at(last).unwrap().damping_ratio),
                ];
                return (branch, last, values);
            }
        };
        let range = omega_range(omega_start, omega_stop);
        let branch = forced_response(model, solver, &range, hooks).unwrap();
        if let Self::At(_) = self {
            let value = branch.amplitude()[0];
            return (branch, 0, vec![(Quantity::Amplitude, value)]);
        }
        let highest = branch.peaks().iter().max_by(|a, b| a.amplitude.total_cmp(&b.amplitude));
        let peak = *highest.expect("a peak");
        let values = vec![
            (Quantity::PeakAmplitude, peak.amplitude),
            (Quantity::PeakOmega, peak.omega),
        ];
        (branch, peak.point, values)
    }

    /// The same results, in a range near those found.
    fn near(self, values: &[(Quantity, f64)]) -> Self {
        match self {
            Self::Peak(from, to) => {
                let omega = values[1].1;
                Self::Peak(from.max(0.99 * omega), to.min(1.01 * omega))
            }
            other => other,
        }
    }
}

/// Asserts that the derivatives of the results by all `changes` are those of differences, to `tolerance`. Returns the
/// largest relative gap.
pub fn check(design: &Design, results: Results, highest: usize, changes: &[Change], tolerance: f64) -> f64 {
    let solver = tight(highest);
    let model = design.model();
    let (branch, point, values) = results.solve(&model, &solver);
    let parameters: Vec<Parameter<'_>> = changes.iter().map(|c| c.parameter(design)).collect();
    let derivatives = |(quantity, _): &(Quantity, f64)| {
        let found = sensitivity(&model, &branch, point, &parameters, *quantity).unwrap();
        assert!(found.reasons.iter().all(|r| *r == Reason::Exists), "{found:?}");
        found.values
    };
    let found: Vec<Vec<f64>> = values.iter().map(derivatives).collect();
    let near = results.near(&values);
    let mut worst = 0.0_f64;
    for (i, change) in changes.iter().enumerate() {
        let difference = |h: f64| -> Vec<f64> {
            let at = |h: f64| {
                let (design, step) = design.changed(change, h);
                (near.solve(&design.model(), &solver).2, step)
            };
            let ((above, up), (below, down)) = (at(h), at(-h));
            let pairs = above.iter().zip(&below);
            pairs.map(|(a, b)| (a.1 - b.1) / (up - down)).collect()
        };
        let mut gap = f64::INFINITY;
        let mut h = change.first_step();
        // Where a solution has a kink nearby, differences need smaller steps.
        for _ in 0..3 {
            let (far, close) = (difference(2.0 * h), difference(h));
            let mut largest = 0.0_f64;
            for (k, (_, value)) in values.iter().enumerate() {
                let expected = (4.0 * close[k] - far[k]) / 3.0;
                // Rounding of the differences: a solution has about 12 digits.
                let noise = 1e-12 * value.abs() / (h * step_scale(design, change));
                let size = expected.abs() + noise / tolerance;
                largest = largest.max((found[k][i] - expected).abs() / size);
            }
            gap = gap.min(largest);
            if gap < tolerance {
                break;
            }
            h /= 8.0;
        }
        worst = worst.max(gap);
        assert!(
            gap < tolerance,
            "{change:?} of {results:?} at H = {highest}: gap {gap:.1e}"
        );
    }
    worst
}

/// Size of a step of 1 in the unit of the parameter.
fn step_scale(design: &Design, change: &Change) -> f64 {
    design.changed(change, 1e-3).1 / 1e-3
}
