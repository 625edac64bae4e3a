//! Energies and works of nonlinear modes about the static state: potential energy counted from there, kinetic energy
//! and works per cycle, against sums over samples of the motions of all sectors and a slider marched along.

use crate::common::energy::{close, exactly};
use crate::common::mode_cases::{N, Skewed, damping, follow, wave};
use crate::common::models::dense;
use crate::common::{all_harmonics, amplitude_range, phase};
use crate::mode_about_static::pressed_sector;
use hbvib::{Branch, Constant, Contact, Energy, MatrixKind, ModeField, Speed, Spring};
use nalgebra::{DMatrix, DVector};
use num_complex::Complex64;
use std::f64::consts::TAU;

/// Samples of a period.
const SAMPLES: usize = 1 << 16;

/// A wheel of sectors with contacts of friction in one direction under a load that varies.
struct Wheel {
    sectors: usize,
    engine_order: i64,
    /// Own and next blocks of mass, stiffness with springs and terms of the speed, viscous and structural damping.
    mass: [DMatrix<f64>; 2],
    stiffness: [DMatrix<f64>; 2],
    damping: [DMatrix<f64>; 2],
    structural: [DMatrix<f64>; 2],
    contacts: Vec<Contact>,
    constant: DVector<f64>,
}

/// Sums over the period.
#[derive(Default)]
struct Sums {
    potential: (f64, f64),
    kinetic: (f64, f64),
    wheel_potential: (f64, f64),
    wheel_kinetic: (f64, f64),
    friction: f64,
    structural: f64,
}

fn count((mean, peak): &mut (f64, f64), value: f64) {
    *mean += value / SAMPLES as f64;
    *peak = peak.max(value);
}

impl Wheel {
    fn order(&self) -> usize {
        self.constant.len()
    }

    /// A x in sector s.
    fn product([own, next]: &[DMatrix<f64>; 2], x: &[DVector<f64>], s: usize) -> DVector<f64> {
        let n = x.len();
        own * &x[s] + next * &x[(s + 1) % n] + next.transpose() * &x[(s + n - 1) % n]
    }

    /// The row of a place of a contact in the fundamental of the constant motion, in which all sectors move alike.
    fn row(&self, contact: &Contact, place: usize) -> DVector<f64> {
        let mut row = DVector::zeros(self.order());
        if let Some(a) = contact.dof_a[place] {
            row[a] += 1.0;
        }
        if let Some(b) = contact.dof_b[place] {
            row[b] -= 1.0;
        }
        row
    }

    /// The static state with all contacts pressed and stuck, which is checked.
    fn at_rest(&self) -> DVector<f64> {
        let [own, next] = &self.stiffness;
        let (mut k, mut force) = (own + next + next.transpose(), self.constant.clone());
        for contact in &self.contacts {
            let [t, n] = [0, 2].map(|place| self.row(contact, place));
            k += &t * t.transpose() * contact.constant(Constant::Kt)
                + &n * n.transpose() * contact.constant(Constant::Kn);
            force += n * contact.constant(Constant::Preload);
        }
        let x = k.lu().solve(&force).unwrap();
        for contact in &self.contacts {
            let [t, n] = [0, 2].map(|place| self.row(contact, place).dot(&x));
            let load = contact.constant(Constant::Preload) - contact.constant(Constant::Kn) * n;
            assert!(
                load > 0.0 && contact.constant(Constant::Kt) * t.abs() < contact.constant(Constant::Mu) * load,
                "slips at rest"
            );
        }
        x
    }

    /// Motions of the sectors at a phase, their velocities, and the forces of structural damping.
    fn motions(&self, x: &[Complex64], omega: f64, tau: f64) -> [Vec<DVector<f64>>; 3] {
        let n = self.order();
        let mut found = [0, 1, 2].map(|_| vec![DVector::zeros(n); self.sectors]);
        let [at, rates, turned] = &mut found;
        for (h, block) in x.chunks_exact(n).enumerate() {
            let sectors = at.iter_mut().zip(rates.iter_mut()).zip(turned.iter_mut());
            for (s, ((at, rate), turned)) in sectors.enumerate() {
                let turn = phase(h, self.engine_order, s, self.sectors) * Complex64::cis(h as f64 * tau);
                for (i, z) in block.iter().enumerate() {
                    let z = z * turn;
                    at[i] += z.re;
                    rate[i] -= omega * h as f64 * z.im;
                    // i times the harmonics above 0, which structural damping takes.
                    turned[i] -= if h == 0 { 0.0 } else { z.im };
                }
            }
        }
        found
    }

    /// Energies and works at a point: potential energy from the static state on.
    fn sums(&self, x: &[Complex64], omega: f64, rest: &DVector<f64>) -> Sums {
        let mut sums = Sums::default();
        let dt = TAU / omega / SAMPLES as f64;
        for j in 0..SAMPLES {
            let [at, rates, turned] = self.motions(x, omega, TAU * j as f64 / SAMPLES as f64);
            let vibration: Vec<DVector<f64>> = at.iter().map(|x| x - rest).collect();
            let loss = |s: usize| {
                let force = Self::product(&self.damping, &rates, s) + Self::product(&self.structural, &turned, s);
                rates[s].dot(&force)
            };
            sums.structural += loss(0) * dt;
            let potential = |s: usize| 0.5 * vibration[s].dot(&Self::product(&self.stiffness, &vibration, s));
            let kinetic = |s: usize| 0.5 * rates[s].dot(&Self::product(&self.mass, &rates, s));
            count(&mut sums.potential, potential(0));
            count(&mut sums.kinetic, kinetic(0));
            count(&mut sums.wheel_potential, (0..self.sectors).map(potential).sum());
            count(&mut sums.wheel_kinetic, (0..self.sectors).map(kinetic).sum());
        }
        sums.friction = self.friction_work(x);
        sums
    }

    /// Harmonics of the motion of a over b at a place of a contact.
    fn between(&self, x: &[Complex64], contact: &Contact, place: usize) -> Vec<Complex64> {
        let motion = |(h, block): (usize, &[Complex64])| {
            let turn = phase(h, self.engine_order * contact.sector_offset, 1, self.sectors);
            let [a, b] = [contact.dof_a, contact.dof_b].map(|side| side[place].map_or(Complex64::ZERO, |d| block[d]));
            a - turn * b
        };
        x.chunks_exact(self.order()).enumerate().map(motion).collect()
    }

    /// Work of the contacts of a sector per cycle: ∮ f dy over the sides of fine polygons.
    fn friction_work(&self, x: &[Complex64]) -> f64 {
        const FINE: usize = 1 << 19;
        let mut work = 0.0;
        for contact in &self.contacts {
            let motions = [0, 2].map(|place| self.between(x, contact, place));
            let at = |x: &[Complex64], turn: Complex64| x.iter().rev().fold(Complex64::ZERO, |s, z| s * turn + z).re;
            let mut slider = 0.0;
            let mut before: Option<[f64; 4]> = None;
            // In the first period the slider finds its place.
            for j in 0..=2 * FINE {
                let turn = Complex64::cis(TAU * (j % FINE) as f64 / FINE as f64);
                let [y, n] = [0, 1].map(|i| at(&motions[i], turn));
                let load = (contact.constant(Constant::Preload) - contact.constant(Constant::Kn) * n).max(0.0);
                let f = (contact.constant(Constant::Kt) * (y - slider)).clamp(
                    -contact.constant(Constant::Mu) * load,
                    contact.constant(Constant::Mu) * load,
                );
                slider = y - f / contact.constant(Constant::Kt);
                if let Some([y0, n0, f0, load0]) = before.filter(|_| j > FINE) {
                    work += 0.5 * (f + f0) * (y - y0) - 0.5 * (load + load0) * (n - n0);
                }
                before = Some([y, n, f, load]);
            }
        }
        work
    }

    /// Compares some points of a mode that slip.
    fn compare(&self, branch: &Branch, step: usize) {
        let rest = self.at_rest();
        let first = all_harmonics(branch, 0);
        let gap = (0..self.order()).fold(0.0_f64, |m, i| m.max((first[i].re - rest[i]).abs()));
        assert!(gap < 1e-10, "static state off by {gap:e}");
        let energies = branch.mode_field(ModeField::Energy).unwrap();
        let mut compared = 0;
        for point in (0..branch.points()).step_by(step) {
            if crate::common::slip(branch, point) < 0.02 {
                continue;
            }
            compared += 1;
            let (omega, d) = (branch.omega()[point], damping(branch)[point]);
            println!("log10 a = {}", branch.mode_at(point).unwrap().log10_amplitude);
            let x = all_harmonics(branch, point);
            let sums = self.sums(&x, omega, &rest);
            let found: Energy = branch.energy_at(point).unwrap();
            close("kinetic, mean", found.kinetic_mean, sums.kinetic.0, 1e-11);
            close("HBVIB_ENERGY", energies[point], 2.0 * sums.kinetic.0, 1e-11);
            close("potential, mean", found.potential_mean, sums.potential.0, 1e-9);
            close("wheel, kinetic", found.wheel_kinetic_mean, sums.wheel_kinetic.0, 1e-11);
            close(
                "wheel, potential",
                found.wheel_potential_mean,
                sums.wheel_potential.0,
                1e-9,
            );
            // The largest sample is off by the curvature times half a step squared.
            close("kinetic, peak", found.kinetic_peak, sums.kinetic.1, 1e-6);
            close("potential, peak", found.potential_peak, sums.potential.1, 1e-6);
            close(
                "wheel, kinetic peak",
                found.wheel_kinetic_peak,
                sums.wheel_kinetic.1,
                1e-6,
            );
            close(
                "wheel, potential peak",
                found.wheel_potential_peak,
                sums.wheel_potential.1,
                1e-6,
            );
            close("structural loss", found.structural_loss, sums.structural, 1e-9);
            close("friction loss", found.friction_loss, sums.friction, 1e-8);
            let told = branch.mode_at(point).unwrap();
            assert!((told.friction_loss / found.friction_loss - 1.0).abs() < 1e-12);
            assert!((told.structural_loss / found.structural_loss - 1.0).abs() < 1e-12);
            let losses = sums.friction + sums.structural;
            close("D from the works", losses / (4.0 * TAU * sums.kinetic.0), d, 1e-8);
        }
        assert!(compared >= 3, "{compared}");
    }
}

const M: [f64; 9] = [1.0, 0.1, 0.0, 0.1, 1.4, 0.0, 0.0, 0.0, 0.8];
const C: [f64; 9] = [0.01, 0.0, 0.002, 0.0, 0.02, 0.0, 0.002, 0.0, 0.01];
const K: [f64; 9] = [2.0, -0.4, 0.3, -0.4, 3.0, -0.5, 0.3, -0.5, 2.5];
const K1: [f64; 9] = [-0.2, 0.0, 0.0, 0.0, 0.3, 0.1, 0.0, 0.1, -0.1];
const G: [f64; 9] = [0.0, 0.3, -0.1, -0.3, 0.0, 0.2, 0.1, -0.2, 0.0];

#[test]
fn energies_of_a_pressed_structure_count_from_its_static_state() {
    const SPEED: f64 = 0.7;
    const ETA: f64 = 0.01;
    const CONSTANT: [f64; 3] = [0.1, -0.3, 0.2];
    let contact = Contact::friction_2d([Some(0), Some(1)], [None; 2], (1.0, 0.8), 0.3, 1.0);
    let mut model = dense(&M, &K)
        .damping(&C)
        .set(MatrixKind::StiffnessSpeed2, &K1)
        .set(MatrixKind::Gyroscopic, &G)
        .speed(Speed::Fixed(SPEED))
        .loss_factor(ETA)
        .build();
    let spring = Spring {
        dof_a: Some(2),
        dof_b: Some(0),
        sector_offset: 0,
        stiffness: 0.6,
    };
    model.add_spring(&spring).unwrap();
    model.add_contact(&contact).unwrap();
    for (dof, f) in CONSTANT.into_iter().enumerate() {
        model.add_force(dof, 0, f.into()).unwrap();
    }
    let matrix = |a: &[f64; 9]| DMatrix::from_column_slice(N, N, a);
    let alone = |a: DMatrix<f64>| [a, DMatrix::zeros(N, N)];
    let across = DVector::from_column_slice(&[-1.0, 0.0, 1.0]);
    let wheel = Wheel {
        sectors: 1,
        engine_order: 0,
        mass: alone(matrix(&M)),
        stiffness: alone(matrix(&K) + matrix(&K1) * (SPEED * SPEED) + &across * across.transpose() * 0.6),
        damping: alone(matrix(&C)),
        // The spring has no loss, nor has the stiffness at speed.
        structural: alone(matrix(&K) * ETA),
        contacts: vec![contact],
        constant: DVector::from_column_slice(&CONSTANT),
    };
    let range = amplitude_range(-2.0, 0.8);
    wheel.compare(&follow(&model, &exactly(5), &range), 8);
}

#[test]
fn energies_of_a_pressed_sector_and_of_its_wheel_count_from_the_static_state() {
    let skewed: Skewed = pressed_sector(2);
    let mut model = skewed.model(true);
    let constant = [0.3, 0.0, -0.2];
    for (dof, f) in constant.into_iter().enumerate() {
        model.add_force(dof, 0, f.into()).unwrap();
    }
    // Own and next blocks from the matrices of the waves: A(φ) = A₀ + A₁ e^{−iφ} + A₁ᵀ e^{iφ}.
    let blocks = |of: &dyn Fn(usize) -> DMatrix<Complex64>| {
        let of_wave: Vec<DMatrix<Complex64>> = (0..5).map(of).collect();
        let part = |offset: i64| {
            let mut sum = DMatrix::<Complex64>::zeros(N, N);
            for (h, a) in of_wave.iter().enumerate() {
                sum += a * phase(h, 2, 1, 5).powi(-(offset as i32)) * Complex64::from(0.2);
            }
            sum.map(|z| z.re)
        };
        [part(0), part(1)]
    };
    let wheel = Wheel {
        sectors: 5,
        engine_order: 2,
        mass: blocks(&|h| skewed.matrices(h).mass),
        stiffness: blocks(&|h| skewed.matrices(h).stiffness),
        damping: blocks(&|h| skewed.matrices(h).damping),
        structural: [DMatrix::zeros(N, N), DMatrix::zeros(N, N)],
        contacts: skewed.contacts.clone(),
        constant: DVector::from_column_slice(&constant),
    };
    let [own, next] = &wheel.stiffness;
    let again = wave(N, own.as_slice(), next.as_slice(), phase(1, 2, 1, 5));
    assert!((again - skewed.matrices(1).stiffness).camax() < 1e-13);
    let range = amplitude_range(-1.5, 1.0);
    wheel.compare(&follow(&model, &exactly(5), &range), 12);
}
