//! One sector under an engine order equals the full wheel: the same-H solution of the same physics
//! as a plain structure, in every harmonic, degree of freedom and sector.

use crate::common::models::Structure;
use crate::common::{
    BASE, Blisk, SECTORS, Wheel, all_harmonics, harmonics, largest, phase, relative_gap, slip, solve_at,
};
use hbvib::{Contact, MatrixKind, MatrixView, Model, Part};
use num_complex::Complex64;
use std::f64::consts::TAU;

/// Harmonics of the whole wheel from those of its first sector.
fn spread(x: &[Complex64], n: usize, sectors: usize, engine_order: i64) -> Vec<Complex64> {
    let mut full_wheel = Vec::new();
    for (h, block) in x.chunks_exact(n).enumerate() {
        for s in 0..sectors {
            full_wheel.extend(block.iter().map(|z| z * phase(h, engine_order, s, sectors)));
        }
    }
    full_wheel
}

/// Solves both and returns the largest relative difference and the slip share of the sector.
fn gap(sector: &Model, full_wheel: &Model, highest: usize, omega: f64) -> (f64, f64) {
    let n = sector.ndof();
    let sectors = sector.structure().sectors();
    let engine_order = sector.structure().engine_order();
    let a = solve_at(sector, &harmonics(highest), omega);
    let b = solve_at(full_wheel, &harmonics(highest), omega);
    let expected = spread(&all_harmonics(&a, 0), n, sectors, engine_order);
    let found = all_harmonics(&b, 0);
    // The wheel has each contact once per sector, one kind after the other.
    for (i, share) in b.slip_fraction().iter().enumerate() {
        assert!((share - a.slip_fraction()[i / sectors]).abs() < 1e-6);
    }
    (relative_gap(&found, &expected), slip(&a, 0))
}

#[test]
fn the_blisk_sector_equals_the_wheel_of_96_degrees_of_freedom() {
    // Frequencies on the flanks and near the top of the first family's resonance.
    for (engine_order, force, hz) in [
        (1, 5.0, [183.7, 186.0, 191.5]),
        (2, 5.0, [208.0, 208.85, 210.0]),
        (3, 5.0, [212.2, 212.4, 213.0]),
        (12, 5.0, [215.1, 215.106, 215.2]),
        (0, 20.0, [90.8, 91.0, 91.12]),
    ] {
        let case = Blisk {
            engine_order,
            force,
            ..BASE
        };
        let (sector, full_wheel) = (case.sector(), case.full_wheel());
        assert_eq!(full_wheel.ndof(), 96);
        assert_eq!(full_wheel.contacts().len(), 24);
        let mut most = 0.0_f64;
        for f in hz {
            let (error, share) = gap(&sector, &full_wheel, 7, TAU * f);
            println!("EO {engine_order}, {f} Hz: {error:.1e}, slipping {share:.3} of the period");
            assert!(error < 1e-9);
            most = most.max(share);
        }
        assert!(most > 0.0, "EO {engine_order}: nothing slips");
    }
}

/// Order of the made-up sector.
const N: usize = 3;

/// A sector without mirror symmetry: its coupling blocks are not symmetric, one contact stays in
/// the sector and one reaches into the next.
struct Skewed {
    engine_order: i64,
    /// Constant force on the last degree of freedom.
    constant: f64,
    /// Couplings without symmetry in damping, as of gyroscopic or aerodynamic forces.
    general: bool,
    contacts: [Contact; 2],
}

const MASS: [f64; 9] = [1.0, 0.1, 0.0, 0.1, 1.5, 0.0, 0.0, 0.0, 0.7];
const MASS_NEXT: [f64; 9] = [0.02, 0.0, 0.05, 0.0, 0.01, 0.0, -0.03, 0.0, 0.0];
const STIFFNESS: [f64; 9] = [9.0, -2.0, -1.0, -2.0, 8.0, -1.5, -1.0, -1.5, 7.0];
/// Column-major: [i + 3 j] couples i of a sector to j of the next.
const STIFFNESS_NEXT: [f64; 9] = [-0.8, 0.1, -0.9, 0.4, -0.5, 0.0, -0.2, 0.7, -0.6];
const DAMPING: [f64; 9] = [0.05, 0.0, 0.01, 0.0, 0.06, 0.0, 0.01, 0.0, 0.04];
const DAMPING_NEXT: [f64; 9] = [0.004, 0.01, 0.0, -0.003, 0.0, 0.006, 0.0, 0.002, 0.001];
const DAMPING_PREVIOUS: [f64; 9] = [0.002, 0.0, 0.005, 0.0, 0.003, -0.007, 0.001, 0.0, 0.0];

impl Skewed {
    fn new(engine_order: i64) -> Self {
        let mut across = Contact::jenkins(2, Some(0), 3.0, 0.4, 0.5);
        across.sector_offset = 1;
        Self {
            engine_order,
            constant: 0.0,
            general: false,
            contacts: [Contact::jenkins(0, Some(1), 2.0, 0.3, 0.4), across],
        }
    }

    fn forces(&self) -> Vec<(usize, usize, Complex64)> {
        let mut forces = vec![(0, 1, Complex64::new(1.0, 0.3)), (1, 1, Complex64::new(-0.4, 0.8))];
        if self.constant != 0.0 {
            forces.push((2, 0, self.constant.into()));
        }
        forces
    }

    fn sector(&self) -> Model {
        let mut sector = Structure::cyclic(N, SECTORS)
            .matrices([&MASS, &DAMPING, &STIFFNESS])
            .next(MatrixKind::Mass, &MASS_NEXT)
            .next(MatrixKind::Stiffness, &STIFFNESS_NEXT)
            .next(MatrixKind::Damping, &DAMPING_NEXT);
        if self.general {
            sector = sector.previous(MatrixKind::Damping, &DAMPING_PREVIOUS);
        }
        sector.with(|model| self.load(model)).build()
    }

    /// Everything but the matrices.
    fn load(&self, model: &mut Model) {
        model.set_wave(self.engine_order);
        for contact in &self.contacts {
            model.add_contact(contact).unwrap();
        }
        for (dof, harmonic, value) in self.forces() {
            model.add_force(dof, harmonic, value).unwrap();
        }
    }

    fn full_wheel(&self) -> Model {
        let mut full_wheel = Wheel::new(N, SECTORS);
        full_wheel.set(MatrixKind::Mass, &MASS, Some(&MASS_NEXT), None);
        full_wheel.set(MatrixKind::Stiffness, &STIFFNESS, Some(&STIFFNESS_NEXT), None);
        let previous = self.general.then_some(&DAMPING_PREVIOUS[..]);
        full_wheel.set(MatrixKind::Damping, &DAMPING, Some(&DAMPING_NEXT), previous);
        for contact in &self.contacts {
            full_wheel.add_contact(contact);
        }
        for (dof, harmonic, value) in self.forces() {
            full_wheel.add_force(dof, harmonic, value, self.engine_order);
        }
        full_wheel.model
    }

    fn check(&self, highest: usize) {
        let (sector, full_wheel) = (self.sector(), self.full_wheel());
        for omega in [1.4, 2.3, 3.1] {
            let (error, share) = gap(&sector, &full_wheel, highest, omega);
            println!(
                "EO {}, angular frequency {omega}: {error:.1e}, slipping {share:.3} of the period",
                self.engine_order
            );
            assert!(error < 1e-9, "EO {}, {omega}: {error:.1e}", self.engine_order);
            assert!(share > 0.0);
        }
    }
}

#[test]
fn contacts_across_sectors_equal_the_wheel_for_waves_of_either_sense() {
    // Of engine orders 4 and 8 the third harmonic moves sectors in opposition and alike: its matrices are real.
    for engine_order in [2, 22, -2, 5, 0, 12, 26, 4, 8] {
        Skewed::new(engine_order).check(7);
    }
}

#[test]
fn a_contact_to_the_previous_sector_equals_the_wheel() {
    for engine_order in [2, 22] {
        let mut skewed = Skewed::new(engine_order);
        skewed.contacts[1].sector_offset = -1;
        skewed.check(5);
        // Side b may also lie several sectors away, on the same degree of freedom as side a.
        skewed.contacts[1].dof_b = skewed.contacts[1].dof_a;
        skewed.contacts[1].sector_offset = 3;
        skewed.check(5);
    }
}

#[test]
fn a_mean_and_even_harmonics_equal_the_wheel() {
    for engine_order in [2, 22] {
        let skewed = Skewed {
            constant: 0.6,
            ..Skewed::new(engine_order)
        };
        skewed.check(4);
    }
}

#[test]
fn damping_without_symmetry_equals_the_wheel() {
    for engine_order in [2, 22] {
        let skewed = Skewed {
            general: true,
            ..Skewed::new(engine_order)
        };
        skewed.check(5);
    }
}

#[test]
fn a_wrong_sense_of_the_wave_would_show() {
    let x = |engine_order| {
        let branch = solve_at(&Skewed::new(engine_order).sector(), &harmonics(7), 2.3);
        all_harmonics(&branch, 0)
    };
    let (forward, backward) = (x(2), x(22));
    let moduli = |x: &[Complex64]| -> Vec<Complex64> { x.iter().map(|z| z.norm().into()).collect() };
    let difference = relative_gap(&moduli(&backward), &moduli(&forward));
    println!("EO 2 and 22 differ by {difference:.2}");
    assert!(difference > 0.01);
    // The same engine order counted differently is the same wave.
    assert!(relative_gap(&x(-2), &backward) < 1e-12);
    assert!(relative_gap(&x(26), &forward) < 1e-12);
}

#[test]
fn matrices_per_nodal_diameter_equal_sector_blocks() {
    for (engine_order, constant) in [(2, 0.0), (22, 0.0), (-5, 0.0), (7, 0.6)] {
        let skewed = Skewed {
            general: true,
            constant,
            ..Skewed::new(engine_order)
        };
        let mut model = Model::cyclic(N, SECTORS).unwrap();
        for diameter in 0..=SECTORS / 2 {
            let lag = Complex64::cis(-TAU * diameter as f64 / SECTORS as f64);
            let wave = |own: &[f64], next: &[f64], previous: Option<&[f64]>| {
                let mut a = vec![Complex64::ZERO; N * N];
                for i in 0..N {
                    for j in 0..N {
                        let back = previous.map_or(next[i * N + j], |p| p[j * N + i]);
                        a[j * N + i] = own[j * N + i] + lag * next[j * N + i] + lag.conj() * back;
                    }
                }
                a
            };
            let mass = wave(&MASS, &MASS_NEXT, None);
            let stiffness = wave(&STIFFNESS, &STIFFNESS_NEXT, None);
            let damping = wave(&DAMPING, &DAMPING_NEXT, Some(&DAMPING_PREVIOUS));
            for (which, a, part) in [
                (MatrixKind::Mass, &mass, Part::Full),
                (MatrixKind::Stiffness, &stiffness, Part::Full),
                (MatrixKind::Damping, &damping, Part::General),
            ] {
                let view = MatrixView::dense_complex(N, a).part(part);
                model.set_diameter(which, diameter as i64, &view).unwrap();
            }
        }
        skewed.load(&mut model);
        let highest = if constant == 0.0 { 7 } else { 4 };
        let blocks = solve_at(&skewed.sector(), &harmonics(highest), 2.3);
        let diameters = solve_at(&model, &harmonics(highest), 2.3);
        assert!(slip(&blocks, 0) > 0.0);
        let error = relative_gap(&all_harmonics(&diameters, 0), &all_harmonics(&blocks, 0));
        println!("EO {engine_order}: {error:.1e}");
        assert!(error < 1e-11);
        assert!(largest(&all_harmonics(&blocks, 0)) > 0.0);
    }
}
