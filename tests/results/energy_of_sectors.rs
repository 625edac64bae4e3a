//! Energies of one sector and of the wheel: against the time signals of all sectors, the wheel as a
//! plain structure, and the work of the forces.

use crate::common::energy::{close, energy, exactly, maximum, mean, work};
use crate::common::models::Structure;
use crate::common::{BASE, Blisk, SECTORS, Wheel, all_harmonics, harmonics, phase, slip, solve_at};
use hbvib::{Branch, Contact, Energy, MatrixKind, Model, SolverOptions};
use num_complex::Complex64;
use std::f64::consts::TAU;

/// Order of the made-up sector.
const N: usize = 2;

/// A sector without mirror symmetry, with a mean and even harmonics, a contact that slips and one
/// to the next sector that never does.
#[derive(Clone, Copy)]
struct Skewed {
    engine_order: i64,
    damped: bool,
}

const SKEWED: Skewed = Skewed {
    engine_order: 2,
    damped: true,
};
const MASS: [f64; 4] = [1.0, 0.1, 0.1, 1.5];
const MASS_NEXT: [f64; 4] = [0.02, 0.03, -0.05, 0.01];
const STIFFNESS: [f64; 4] = [6.0, -1.5, -1.5, 5.0];
/// Column-major: [i + 2 j] couples i of a sector to j of the next.
const STIFFNESS_NEXT: [f64; 4] = [-0.6, 0.2, -0.7, -0.4];
const DAMPING: [f64; 4] = [0.05, 0.01, 0.01, 0.06];
const DAMPING_NEXT: [f64; 4] = [0.004, -0.01, 0.006, 0.003];
const DAMPING_PREVIOUS: [f64; 4] = [0.002, 0.008, -0.005, 0.001];
/// Stiffness of the contact that never slips, from degree of freedom 1 to 0 of the next sector.
const TIE: f64 = 0.9;
const FORCES: [(usize, usize, Complex64); 4] = [
    (0, 1, Complex64::new(1.0, 0.3)),
    (1, 1, Complex64::new(-0.4, 0.8)),
    (1, 2, Complex64::new(0.2, 0.1)),
    (1, 0, Complex64::new(0.5, 0.0)),
];

impl Skewed {
    fn contacts(self) -> [Contact; 2] {
        let mut tie = Contact::jenkins(1, Some(0), TIE, 0.4, f64::INFINITY);
        tie.sector_offset = 1;
        // Undamped cases stick.
        let preload = if self.damped { 0.4 } else { 1e6 };
        [Contact::jenkins(0, Some(1), 2.0, 0.3, preload), tie]
    }

    fn sector(self) -> Model {
        let mut sector = Structure::cyclic(N, SECTORS)
            .mass(&MASS)
            .next(MatrixKind::Mass, &MASS_NEXT)
            .stiffness(&STIFFNESS)
            .next(MatrixKind::Stiffness, &STIFFNESS_NEXT);
        if self.damped {
            sector = sector
                .damping(&DAMPING)
                .next(MatrixKind::Damping, &DAMPING_NEXT)
                .previous(MatrixKind::Damping, &DAMPING_PREVIOUS);
        }
        sector
            .wave(self.engine_order)
            .contacts(self.contacts())
            .forces(FORCES)
            .build()
    }

    fn full_wheel(self) -> Model {
        let mut full_wheel = Wheel::new(N, SECTORS);
        full_wheel.set(MatrixKind::Mass, &MASS, Some(&MASS_NEXT), None);
        full_wheel.set(MatrixKind::Stiffness, &STIFFNESS, Some(&STIFFNESS_NEXT), None);
        full_wheel.set(
            MatrixKind::Damping,
            &DAMPING,
            Some(&DAMPING_NEXT),
            Some(&DAMPING_PREVIOUS),
        );
        for contact in self.contacts() {
            full_wheel.add_contact(&contact);
        }
        for (dof, h, value) in FORCES {
            full_wheel.add_force(dof, h, value, self.engine_order);
        }
        full_wheel.model
    }
}

/// ½ s·(A s) of one sector, where its neighbours move too: s holds the previous, this and the next.
fn quadratic(own: &[f64], next: &[f64], s: &[Vec<f64>; 3]) -> f64 {
    let n = s[1].len();
    let mut sum = 0.0;
    for i in 0..n {
        for j in 0..n {
            let force = own[j * n + i] * s[1][j] + next[j * n + i] * s[2][j] + next[i * n + j] * s[0][j];
            sum += 0.5 * s[1][i] * force;
        }
    }
    sum
}

/// The energies as they must be: of the time signals of one sector and its neighbours.
struct Signals<'a> {
    branch: &'a Branch,
    x: Vec<Complex64>,
    engine_order: i64,
    mass: (&'a [f64], &'a [f64]),
    stiffness: (&'a [f64], &'a [f64]),
}

impl Signals<'_> {
    /// Motion, or velocity, of a sector.
    fn at(&self, sector: usize, velocity: bool, t: f64) -> Vec<f64> {
        let n = self.branch.ndof();
        let mut s = vec![0.0; n];
        for (h, x) in self.x.chunks_exact(n).enumerate() {
            let mut turn = Complex64::cis(h as f64 * t) * phase(h, self.engine_order, sector, SECTORS);
            if velocity {
                turn *= Complex64::new(0.0, h as f64 * self.branch.omega()[0]);
            }
            for (s, x) in s.iter_mut().zip(x) {
                *s += (x * turn).re;
            }
        }
        s
    }

    fn energy(&self, sector: usize, kinetic: bool, t: f64) -> f64 {
        let s = [SECTORS - 1, 0, 1].map(|o| self.at((sector + o) % SECTORS, kinetic, t));
        let (own, next) = if kinetic { self.mass } else { self.stiffness };
        quadratic(own, next, &s)
    }

    fn check(&self, e: &Energy) {
        for (kinetic, name, found) in [
            (
                true,
                "kinetic",
                [
                    e.kinetic_mean,
                    e.kinetic_peak,
                    e.wheel_kinetic_mean,
                    e.wheel_kinetic_peak,
                ],
            ),
            (
                false,
                "potential",
                [
                    e.potential_mean,
                    e.potential_peak,
                    e.wheel_potential_mean,
                    e.wheel_potential_peak,
                ],
            ),
        ] {
            let sector = |t: f64| self.energy(0, kinetic, t);
            let full_wheel = |t: f64| (0..SECTORS).map(|s| self.energy(s, kinetic, t)).sum::<f64>();
            let expected = [mean(sector), maximum(sector), mean(full_wheel), maximum(full_wheel)];
            for (of, (found, expected)) in ["sector, mean", "sector, peak", "wheel, mean", "wheel, peak"]
                .iter()
                .zip(found.into_iter().zip(expected))
            {
                close(&format!("{name} of the {of}"), found, expected, 1e-12);
            }
        }
        assert_eq!(e.twice_mean_kinetic.to_bits(), (2.0 * e.kinetic_mean).to_bits());
    }
}

#[test]
fn a_skewed_sector_without_damping_takes_nothing_while_it_sticks() {
    let branch = solve_at(
        &Skewed {
            damped: false,
            ..SKEWED
        }
        .sector(),
        &harmonics(3),
        1.3,
    );
    let e = energy(&branch);
    println!("{e:?}");
    assert!(slip(&branch, 0) == 0.0 && e.potential_mean > 0.0);
    // The matrices that a wave sees are Hermitian up to their own rounding.
    assert!(e.structural_loss.abs() < 1e-14 * e.potential_mean);
    assert!(e.friction_loss.abs() < 1e-14 * e.potential_mean);
}

#[test]
fn the_work_of_the_forces_is_what_damping_and_friction_take_from_a_skewed_sector() {
    for engine_order in [2, 22, 5, 12, 0] {
        for samples in [0, 512] {
            let case = Skewed { engine_order, ..SKEWED };
            let options = SolverOptions { samples, ..exactly(4) };
            let branch = solve_at(&case.sector(), &options, 1.9);
            assert!(slip(&branch, 0) > 0.0);
            let e = energy(&branch);
            let name = format!("EO {engine_order}, {samples} samples");
            close(&name, e.structural_loss + e.friction_loss, work(&branch, &FORCES), 1e-9);
            assert!(e.friction_loss > 0.0);
        }
    }
}

#[test]
fn means_and_peaks_are_those_of_the_time_signals_of_all_sectors() {
    let mut own = STIFFNESS;
    let mut next = STIFFNESS_NEXT;
    own[0] += TIE;
    own[3] += TIE;
    next[1] -= TIE;
    for engine_order in [2, 22, 5, 6, 8, 12, 0] {
        let branch = solve_at(&Skewed { engine_order, ..SKEWED }.sector(), &harmonics(4), 1.9);
        assert!(slip(&branch, 0) > 0.0);
        println!("EO {engine_order}");
        let signals = Signals {
            branch: &branch,
            x: all_harmonics(&branch, 0),
            engine_order,
            mass: (&MASS, &MASS_NEXT),
            stiffness: (&own, &next),
        };
        signals.check(&energy(&branch));
    }
    // The blisk at a highest harmonic whose squares bring all sectors into step (12·2 = 24).
    let branch = solve_at(&BASE.sector(), &harmonics(7), TAU * 208.85);
    let a = BASE.matrices();
    let none = vec![0.0; a.n * a.n];
    let signals = Signals {
        branch: &branch,
        x: all_harmonics(&branch, 0),
        engine_order: BASE.engine_order,
        mass: (&a.mass, &none),
        stiffness: (&a.own, &a.next),
    };
    let e = energy(&branch);
    signals.check(&e);
    assert!(e.wheel_potential_peak > e.wheel_potential_mean);
}

#[test]
fn a_sector_tells_what_the_whole_wheel_has() {
    let blisk = |engine_order| Blisk { engine_order, ..BASE };
    let skewed = |engine_order| Skewed { engine_order, ..SKEWED };
    let cases = [
        (blisk(2).sector(), blisk(2).full_wheel(), 7, TAU * 208.85),
        (blisk(3).sector(), blisk(3).full_wheel(), 9, TAU * 212.4),
        (skewed(2).sector(), skewed(2).full_wheel(), 4, 1.9),
        (skewed(-2).sector(), skewed(-2).full_wheel(), 4, 1.9),
        (skewed(12).sector(), skewed(12).full_wheel(), 4, 1.9),
        (skewed(0).sector(), skewed(0).full_wheel(), 4, 1.9),
    ];
    for (sector, full_wheel, highest, omega) in cases {
        let branch = solve_at(&sector, &exactly(highest), omega);
        assert!(slip(&branch, 0) > 0.0);
        let a = energy(&branch);
        let b = energy(&solve_at(&full_wheel, &exactly(highest), omega));
        let n = SECTORS as f64;
        println!("EO {}", sector.structure().engine_order());
        for (name, sector, full_wheel) in [
            ("kinetic, mean", a.wheel_kinetic_mean, b.kinetic_mean),
            ("kinetic, peak", a.wheel_kinetic_peak, b.kinetic_peak),
            ("potential, mean", a.wheel_potential_mean, b.potential_mean),
            ("potential, peak", a.wheel_potential_peak, b.potential_peak),
            ("kinetic, mean of a sector", n * a.kinetic_mean, b.kinetic_mean),
            ("potential, mean of a sector", n * a.potential_mean, b.potential_mean),
            ("T", n * a.twice_mean_kinetic, b.twice_mean_kinetic),
            ("structural loss", n * a.structural_loss, b.structural_loss),
            ("friction loss", n * a.friction_loss, b.friction_loss),
        ] {
            close(name, sector, full_wheel, 1e-11);
        }
    }
}
