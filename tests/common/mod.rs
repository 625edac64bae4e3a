//! Shared code of the integration tests: the paper's blisk as one sector and as the full wheel, reference data, and
//! single points of the forced response.

// Each test crate uses its own part of this module.
#![allow(dead_code)]

pub mod chains;
pub mod decimal_comma;
pub mod depth;
pub mod energy;
pub mod example;
pub mod friction;
pub mod laws;
pub mod laws_in_time;
pub mod markdown;
pub mod mode_cases;
pub mod models;
pub mod modes;
pub mod options;
pub mod peers;
pub mod plane;
pub mod plane_step;
pub mod pointwise;
pub mod programs;
pub mod random;
pub mod refusal;
pub mod rest;
pub mod rotating;
pub mod stencil;
pub mod stopping;

#[allow(unused_imports, reason = "each test crate uses its own part")]
pub use options::{amplitude_range, at_dof, harmonics, omega_range};

use crate::common::models::{Structure, oscillator};
use hbvib::{
    Branch, Contact, ForcedOptions, Hooks, MatrixKind, MatrixView, Model, Part, SolverOptions, forced_response,
};
use num_complex::Complex64;
use serde_json::Value;
use std::f64::consts::TAU;
use std::time::{Duration, Instant};

/// Degrees of freedom of a sector with its ring, in the order of the reference data.
pub const B2: usize = 0;
/// Inner blade mass.
pub const B1: usize = 1;
/// Disk.
pub const D: usize = 2;
/// Ring.
pub const R: usize = 3;
/// Degrees of freedom of a sector.
pub const NDOF: usize = 4;
/// Sectors of the blisk.
pub const SECTORS: usize = 24;

/// Reads a JSON file of `tests/data`.
pub fn data(name: &str) -> Value {
    let path = crate::common::programs::root().join("tests/data").join(name);
    let text = std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    serde_json::from_str(&text).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}

/// A number; long decimals are written as a string.
pub fn number(v: &Value) -> f64 {
    match v {
        Value::String(s) => s.parse().expect("a decimal number"),
        v => v.as_f64().unwrap_or_else(|| panic!("{v} is not a number")),
    }
}

/// A complex number [re, im, …].
pub fn complex(v: &Value) -> Complex64 {
    Complex64::new(number(&v[0]), number(&v[1]))
}

/// The blisk of `model.json` with the parameters that its studies change. Fields are in SI units.
#[derive(Clone, Copy, Debug)]
pub struct Blisk {
    /// Ring mass per sector; `None`: no ring.
    pub ring_mass: Option<f64>,
    pub rpm: f64,
    pub engine_order: i64,
    /// Force amplitude on each of the two blade masses.
    pub force: f64,
    /// Unit of mass, of length and of force in SI units.
    pub units: (f64, f64, f64),
    /// Factor on force and normal load.
    pub load_factor: f64,
}

/// The base case: 30 g, 3000 rpm, engine order 2, 5 N.
pub const BASE: Blisk = Blisk {
    ring_mass: Some(0.03),
    rpm: 3000.0,
    engine_order: 2,
    force: 5.0,
    units: (1.0, 1.0, 1.0),
    load_factor: 1.0,
};

/// Radius of the ring, which the reference data determine.
const RADIUS: f64 = 0.165;
/// Factor of the stiffness-proportional damping, a time: no unit of mass or length changes it.
pub const BETA: f64 = 1.5e-6;

/// Matrices of one sector, column-major, n = 4 (3 without ring).
pub struct SectorMatrices {
    pub n: usize,
    pub mass: Vec<f64>,
    pub own: Vec<f64>,
    pub next: Vec<f64>,
}

impl Blisk {
    pub fn matrices(&self) -> SectorMatrices {
        let model = data("model.json");
        let (mass_unit, length_unit, force_unit) = self.units;
        let k = |name: &str| number(&model["stiffness_N_per_m"][name]) * length_unit / force_unit;
        let m = |name: &str| number(&model["masses_kg"][name]) / mass_unit;
        let n = if self.ring_mass.is_some() { NDOF } else { NDOF - 1 };
        let mut a = SectorMatrices {
            n,
            mass: vec![0.0; n * n],
            own: vec![0.0; n * n],
            next: vec![0.0; n * n],
        };
        for (dof, mass) in [(B2, m("Mb2")), (B1, m("Mb1")), (D, m("Md"))] {
            a.mass[dof * n + dof] = mass;
        }
        for (p, q, k) in [(B2, B1, k("Kb2")), (B1, D, k("Kb1"))] {
            a.own[p * n + p] += k;
            a.own[q * n + q] += k;
            a.own[q * n + p] -= k;
            a.own[p * n + q] -= k;
        }
        a.own[D * n + D] += k("KG") + 2.0 * k("Kd");
        a.next[D * n + D] -= k("Kd");
        if let Some(ring) = self.ring_mass {
            a.mass[R * n + R] = ring / mass_unit;
            a.own[R * n + R] += 2.0 * k("Kr");
            a.next[R * n + R] -= k("Kr");
        }
        a
    }

    /// The tangential stiffness of the contact.
    pub fn kt(&self) -> f64 {
        number(&data("model.json")["stiffness_N_per_m"]["kt"]) * self.units.1 / self.units.2
    }

    /// Friction coefficient.
    pub fn mu() -> f64 {
        number(&data("model.json")["mu"])
    }

    /// Normal load of the ring, from its mass and the stated speed.
    pub fn preload(&self) -> f64 {
        let speed = self.rpm * TAU / 60.0;
        self.load_factor * self.ring_mass.unwrap_or(0.0) * RADIUS * speed * speed / self.units.2
    }

    fn force_value(&self) -> f64 {
        self.load_factor * self.force / self.units.2
    }

    /// The contact between disk and ring.
    pub fn contact(&self) -> Contact {
        Contact::jenkins(D, Some(R), self.kt(), Self::mu(), self.preload())
    }

    /// One sector under the engine order, without contact.
    pub fn sector_without_contact(&self) -> Model {
        let a = self.matrices();
        let mut model = Structure::cyclic(a.n, SECTORS)
            .mass(&a.mass)
            .stiffness(&a.own)
            .next(MatrixKind::Stiffness, &a.next)
            .rayleigh(0.0, BETA)
            .wave(self.engine_order)
            .build();
        for dof in [B2, B1] {
            model.add_force(dof, 1, self.force_value().into()).unwrap();
        }
        model
    }

    /// One sector under the engine order.
    pub fn sector(&self) -> Model {
        let mut model = self.sector_without_contact();
        if self.ring_mass.is_some() {
            model.add_contact(&self.contact()).unwrap();
        }
        model
    }

    /// The same physics as a plain structure of all sectors, sector after sector.
    pub fn full_wheel(&self) -> Model {
        let a = self.matrices();
        let mut full_wheel = Wheel::new(a.n, SECTORS);
        full_wheel.set(MatrixKind::Mass, &a.mass, None, None);
        full_wheel.set(MatrixKind::Stiffness, &a.own, Some(&a.next), None);
        full_wheel.model.set_rayleigh(0.0, BETA).unwrap();
        full_wheel.add_contact(&self.contact());
        for dof in [B2, B1] {
            full_wheel.add_force(dof, 1, self.force_value().into(), self.engine_order);
        }
        full_wheel.model
    }
}

/// A plain structure of `sectors` equal sectors of `n` degrees of freedom each.
pub struct Wheel {
    pub n: usize,
    pub sectors: usize,
    pub model: Model,
}

impl Wheel {
    pub fn new(n: usize, sectors: usize) -> Self {
        Self {
            n,
            sectors,
            model: Model::new(n * sectors).unwrap(),
        }
    }

    /// Places the blocks of a sector, of its coupling to the next sector and to the previous one
    /// (`None`: the transpose of the former) all around the wheel.
    pub fn set(&mut self, which: MatrixKind, own: &[f64], next: Option<&[f64]>, previous: Option<&[f64]>) {
        let (n, order) = (self.n, self.n * self.sectors);
        let mut a = vec![0.0; order * order];
        for s in 0..self.sectors {
            let (after, before) = ((s + 1) % self.sectors, (s + self.sectors - 1) % self.sectors);
            for i in 0..n {
                for j in 0..n {
                    let mut place = |column: usize, v: f64| a[(column * n + j) * order + s * n + i] += v;
                    place(s, own[j * n + i]);
                    if let Some(next) = next {
                        place(after, next[j * n + i]);
                        place(before, previous.map_or(next[i * n + j], |p| p[j * n + i]));
                    }
                }
            }
        }
        let part = if previous.is_some() { Part::General } else { Part::Full };
        self.model
            .set_matrix(which, &MatrixView::dense(order, &a).part(part))
            .unwrap();
    }

    /// Repeats a sector's contact in every sector.
    pub fn add_contact(&mut self, contact: &Contact) {
        for s in 0..self.sectors {
            let other = (s as i64 + contact.sector_offset).rem_euclid(self.sectors as i64) as usize;
            self.model
                .add_contact(&Contact {
                    dof_a: contact.dof_a.map(|a| a.map(|d| s * self.n + d)),
                    dof_b: contact.dof_b.map(|b| b.map(|d| other * self.n + d)),
                    sector_offset: 0,
                    ..contact.clone()
                })
                .unwrap();
        }
    }

    /// A force in every sector, each sector lagging behind the one before by 2π·EO/N per harmonic.
    pub fn add_force(&mut self, dof: usize, harmonic: usize, value: Complex64, engine_order: i64) {
        for s in 0..self.sectors {
            let lag = phase(harmonic, engine_order, s, self.sectors);
            self.model.add_force(s * self.n + dof, harmonic, value * lag).unwrap();
        }
    }
}

/// e^{−ihφs}, φ = 2π·EO/N: motion of sector 1 + s over that of sector 1.
pub fn phase(harmonic: usize, engine_order: i64, s: usize, sectors: usize) -> Complex64 {
    let turns = (harmonic as i64 * engine_order * s as i64).rem_euclid(sectors as i64);
    if turns == 0 {
        return Complex64::ONE;
    }
    Complex64::cis(-TAU * turns as f64 / sectors as f64)
}

/// Solves at one angular frequency.
pub fn solve_at(model: &Model, solver: &SolverOptions, omega: f64) -> Branch {
    sweep(model, solver, omega, omega, &[])
}

/// Follows the response from one angular frequency to another.
pub fn sweep(model: &Model, solver: &SolverOptions, from: f64, to: f64, at: &[f64]) -> Branch {
    let range = ForcedOptions {
        omega_start: from,
        omega_stop: to,
        at,
        guess: None,
        responses: &[],
        together: false,
        ..ForcedOptions::default()
    };
    forced_response(model, solver, &range, &mut Hooks::default()).unwrap()
}

/// Harmonics 0 ..= H of all degrees of freedom at a stored point, harmonic by harmonic.
pub fn all_harmonics(branch: &Branch, point: usize) -> Vec<Complex64> {
    let mut x = vec![Complex64::ZERO; (branch.harmonics() + 1) * branch.ndof()];
    branch.harmonics_at(point, &mut x).unwrap();
    x
}

/// Largest modulus.
pub fn largest(x: &[Complex64]) -> f64 {
    x.iter().fold(0.0, |m, z| m.max(z.norm()))
}

/// Largest difference relative to the largest entry of `b`.
pub fn relative_gap(a: &[Complex64], b: &[Complex64]) -> f64 {
    assert_eq!(a.len(), b.len());
    let difference: Vec<Complex64> = a.iter().zip(b).map(|(a, b)| a - b).collect();
    largest(&difference) / largest(b)
}

/// Highest slip share of a stored point.
pub fn slip(branch: &Branch, point: usize) -> f64 {
    branch
        .slip_fraction_at(point)
        .unwrap()
        .iter()
        .fold(0.0, |m, &x| m.max(x))
}

/// One mass with a contact, m = k = 1.
pub fn one_mass(damping: f64, contact: &Contact, force: f64) -> Model {
    oscillator(1.0, 1.0)
        .damping(&[damping])
        .contact(contact)
        .force(0, 1, force)
        .build()
}

/// Processor time of this thread where the system reports it (Linux), else the time of a clock: a busy machine then
/// counts as a slow one.
pub fn processor_time(begin: Instant) -> Duration {
    let stat = std::fs::read_to_string("/proc/thread-self/schedstat").ok();
    let busy = stat.and_then(|text| text.split_whitespace().next()?.parse().ok());
    busy.map_or_else(|| begin.elapsed(), Duration::from_nanos)
}
