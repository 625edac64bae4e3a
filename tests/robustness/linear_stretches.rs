//! Sweeps while every contact is linear: peaks against the closed form of modal superposition, at any damping.

use crate::common::models::chain_stiffness;
use crate::common::peers::structure;
use crate::common::{at_dof, harmonics, sweep};
use crate::random_problems::random::Random;
use core::ops::Range;
use hbvib::internals::eigen;
use hbvib::{Branch, Contact, Interrupt, Model, SolverOptions, Status};
use nalgebra::DMatrix;
use num_complex::Complex64;

/// A structure of equal modal damping ratios, by its modes.
struct Modal {
    omega: Vec<f64>,
    /// Response per unit force: product of the shapes at the response and at the force.
    residues: Vec<f64>,
    damping: f64,
}

impl Modal {
    /// X and dX/dω at ω = ω_j + d; the offset keeps the digits near a resonance.
    fn at(&self, j: usize, d: f64) -> (Complex64, Complex64) {
        let own = self.omega[j];
        let omega = own + d;
        let (mut x, mut slope) = (Complex64::ZERO, Complex64::ZERO);
        for (r, (&w, residue)) in self.omega.iter().zip(&self.residues).enumerate() {
            let real = if r == j {
                -d * (2.0 * own + d)
            } else {
                (w - omega) * (w + omega)
            };
            let z = Complex64::new(real, 2.0 * self.damping * w * omega);
            x += residue / z;
            slope -= residue / (z * z) * Complex64::new(-2.0 * omega, 2.0 * self.damping * w);
        }
        (x, slope)
    }

    fn growth(&self, j: usize, d: f64) -> f64 {
        let (x, slope) = self.at(j, d);
        (x.conj() * slope).re
    }

    /// All maxima of |X| within a range: of dense points around each mode, by bisection.
    fn peaks(&self, (low, high): (f64, f64)) -> Vec<(f64, f64)> {
        let mut found = Vec::new();
        for (j, &w) in self.omega.iter().enumerate() {
            let middle = |other: Option<&f64>, end: f64| other.map_or(end, |o| 0.5 * (o + w));
            let from = middle(j.checked_sub(1).map(|i| &self.omega[i]), low).max(low) - w;
            let to = middle(self.omega.get(j + 1), high).min(high) - w;
            let mut offsets = vec![from, to];
            let sigma = self.damping * w;
            for k in 0..600 {
                let log = sigma * 1e-2 * (w / sigma * 1e3).powf(f64::from(k) / 600.0);
                let line = sigma * 4.0 * f64::from(k) / 600.0;
                offsets.extend([log, -log, line, -line]);
            }
            offsets.retain(|&d| d >= from && d <= to);
            offsets.sort_by(f64::total_cmp);
            for pair in offsets.windows(2) {
                let (mut a, mut b) = (pair[0], pair[1]);
                if self.growth(j, a) > 0.0 && self.growth(j, b) <= 0.0 {
                    for _ in 0..200 {
                        let c = 0.5 * (a + b);
                        if self.growth(j, c) > 0.0 {
                            a = c;
                        } else {
                            b = c;
                        }
                    }
                    found.push((w + a, self.at(j, a).0.norm()));
                }
            }
        }
        found
    }
}

/// A model of given modes with random shapes.
fn of_modes(omega: &[f64], damping: f64, random: &mut Random) -> (Model, Modal, usize) {
    let n = omega.len();
    let q = DMatrix::from_fn(n, n, |_, _| random.within(-1.0, 1.0)).qr().q();
    let with = |f: &dyn Fn(f64) -> f64| {
        &q * DMatrix::from_fn(n, n, |i, j| if i == j { f(omega[i]) } else { 0.0 }) * q.transpose()
    };
    let (stiffness, c) = (with(&|w| w * w), with(&|w| 2.0 * damping * w));
    let mass = DMatrix::<f64>::identity(n, n);
    let (a, b) = (random.below(n), random.below(n));
    let mut model = structure(mass.as_slice(), c.as_slice(), stiffness.as_slice());
    model.add_force(a, 1, 1.0.into()).unwrap();
    let residues = (0..n).map(|r| q[(a, r)] * q[(b, r)]).collect();
    let modal = Modal {
        omega: omega.to_vec(),
        residues,
        damping,
    };
    (model, modal, b)
}

/// A chain of 3 to 7 masses, in most cases with a contact that sticks, and its modal data.
fn chain(number: u64, damping: f64) -> (Model, Modal, usize) {
    let mut random = Random::of(27, number);
    let n = 3 + random.below(5);
    let springs: Vec<f64> = (0..=n).map(|_| random.decade(-0.5, 0.5)).collect();
    let mass = DMatrix::from_fn(n, n, |i, j| if i == j { random.decade(-0.3, 0.3) } else { 0.0 });
    let stiffness = DMatrix::from_vec(n, n, chain_stiffness(&springs));
    let contact = random.happens(0.7).then(|| (random.below(n), random.decade(-0.5, 0.5)));
    let mut stuck = stiffness.clone();
    if let Some((dof, kt)) = contact {
        stuck[(dof, dof)] += kt;
    }
    let pairs = eigen::generalised(
        &stuck.map(Complex64::from),
        &mass.map(Complex64::from),
        &Interrupt::none(),
    )
    .unwrap();
    let omega: Vec<f64> = pairs.values.iter().map(|x| x.sqrt()).collect();
    let shapes = pairs.vectors.map(|x| x.re);
    let momenta = &mass * &shapes;
    let of_modes = DMatrix::from_fn(n, n, |i, j| if i == j { 2.0 * damping * omega[i] } else { 0.0 });
    let c = &momenta * of_modes * momenta.transpose();
    let mut model = structure(mass.as_slice(), c.as_slice(), stiffness.as_slice());
    if let Some((dof, kt)) = contact {
        model.add_contact(&Contact::jenkins(dof, None, kt, 1.0, 1e12)).unwrap();
    }
    let (a, b) = (random.below(n), random.below(n));
    model.add_force(a, 1, 1.0.into()).unwrap();
    let residues = (0..n).map(|r| shapes[(a, r)] * shapes[(b, r)]).collect();
    (
        model,
        Modal {
            omega,
            residues,
            damping,
        },
        b,
    )
}

/// Checks a sweep over a range against the closed form; returns the number of peaks and their worst errors.
fn check(
    name: &str,
    branch: &Branch,
    modal: &Modal,
    (from, to): (f64, f64),
    tolerance: (f64, f64),
) -> (usize, f64, f64) {
    assert_eq!(branch.status(), Status::Ok, "{name}");
    let omega = branch.omega();
    let sense = (to - from).signum();
    assert!(
        omega.windows(2).all(|w| sense * (w[1] - w[0]) > 0.0),
        "{name}: frequency turns"
    );
    let ends = [omega[0], omega[omega.len() - 1]].map(f64::to_bits);
    assert_eq!(ends, [from, to].map(f64::to_bits), "{name}");
    let most = 40 + 20 * modal.omega.len();
    assert!(omega.len() <= most, "{name}: {} points", omega.len());
    let peaks = modal.peaks((from.min(to), from.max(to)));
    let highest = peaks.iter().fold(0.0, |m: f64, p| m.max(p.1));
    let (mut count, mut worst) = (0, (0.0_f64, 0.0_f64));
    for (at, amplitude) in peaks.into_iter().filter(|p| p.1 > 0.05 * highest) {
        let near = |a: &&hbvib::Special, b: &&hbvib::Special| (a.omega - at).abs().total_cmp(&(b.omega - at).abs());
        let found = branch
            .peaks()
            .iter()
            .min_by(near)
            .unwrap_or_else(|| panic!("{name}: no peak"));
        let gaps = (
            (found.omega / at - 1.0).abs(),
            (found.amplitude / amplitude - 1.0).abs(),
        );
        assert!(
            gaps.0 <= tolerance.0 && gaps.1 <= tolerance.1,
            "{name}: peak at {at}: {gaps:?}"
        );
        worst = (worst.0.max(gaps.0), worst.1.max(gaps.1));
        count += 1;
    }
    (count, worst.0, worst.1)
}

/// Sweeps chains up and down at damping ratios from 1e-2 to 1e-7, by the tolerance.
fn sweep_chains(numbers: Range<u64>) {
    for exponent in 2..=7 {
        let damping = 10.0_f64.powi(-exponent);
        let (mut count, mut worst, mut points) = (0, (0.0_f64, 0.0_f64), 0.0_f64);
        for number in numbers.clone() {
            let (model, modal, response) = chain(number, damping);
            let range = (0.6 * modal.omega[0], 1.2 * modal.omega[modal.omega.len() - 1]);
            let solver = at_dof(response, SolverOptions::default());
            for (from, to) in [range, (range.1, range.0)] {
                let branch = sweep(&model, &solver, from, to, &[]);
                let name = format!("chain {number}, damping {damping}, from {from}");
                let found = check(&name, &branch, &modal, (from, to), (1e-9, 1e-9));
                count += found.0;
                worst = (worst.0.max(found.1), worst.1.max(found.2));
                points = points.max((branch.points() as f64 - 40.0) / modal.omega.len() as f64);
            }
        }
        println!(
            "damping {damping:.0e}: {count} peaks, frequency to {:.1e}, amplitude to {:.1e}; 40 + {points:.1} points a mode",
            worst.0, worst.1
        );
    }
}

#[test]
fn every_peak_of_a_linear_response_is_found_at_any_damping() {
    sweep_chains(0..3);
}

#[test]
#[ignore = "minutes"]
fn every_peak_of_many_linear_responses_is_found_at_any_damping() {
    sweep_chains(0..50);
}

#[test]
fn close_and_many_resonances_are_all_found() {
    let mut random = Random::of(28, 0);
    for (count, gap) in [(2, 1e-4), (5, 1e-4), (80, 1e-2)] {
        for damping in [1e-2_f64, 1e-4, 1e-6] {
            let omega: Vec<f64> = (0..count).map(|i| 1.0 + gap * f64::from(i)).collect();
            let (model, modal, response) = of_modes(&omega, damping, &mut random);
            let solver = at_dof(response, harmonics(3));
            let range = (0.9, 1.1 + gap * f64::from(count));
            let branch = sweep(&model, &solver, range.0, range.1, &[]);
            // The matrices are products of rotations: the modes that they stand for are off by their rounding.
            let rounding = 1e-13 * f64::from(count) / damping;
            let tolerance = (1e-9, f64::max(1e-9, rounding));
            let found = check(
                &format!("{count} modes, gap {gap}, damping {damping}"),
                &branch,
                &modal,
                range,
                tolerance,
            );
            println!(
                "{count} modes, gap {gap}, damping {damping}: {found:?}, {} points",
                branch.points()
            );
        }
    }
}

/// One mass on a spring with a contact that slips above a small motion.
fn at_the_tip(damping: f64, limit: f64) -> Model {
    let mut model = structure(&[1.0], &[2.0 * damping], &[0.5]);
    model.add_contact(&Contact::jenkins(0, None, 0.5, 1.0, limit)).unwrap();
    model.add_force(0, 1, 1.0.into()).unwrap();
    model
}

#[test]
fn slip_that_begins_only_at_the_tip_of_a_resonance_is_not_stepped_over() {
    for damping in [1e-2_f64, 1e-4, 1e-6] {
        // Stuck, the mass moves by 1/(2ζ) at its resonance; it begins to slip at 0.999 and at 0.9 of that.
        for share in [0.5, 0.9, 0.999, 0.99999] {
            let top = 0.5 / damping / (1.0 - damping * damping).sqrt();
            let model = at_the_tip(damping, 0.5 * share * top);
            for (from, to) in [(0.4, 1.7), (1.7, 0.4)] {
                let branch = sweep(&model, &SolverOptions::default(), from, to, &[]);
                let name = format!("damping {damping}, share {share}, from {from}");
                assert_eq!(branch.status(), Status::Ok, "{name}");
                // Closed form of the onsets: |X|² = (share top)².
                let onset = |sense: f64| {
                    let square = damping * damping;
                    let root = 2.0 * damping * ((1.0 - square) * (1.0 / (share * share) - 1.0)).sqrt();
                    (1.0 - 2.0 * square + sense * root).sqrt()
                };
                let slips: Vec<usize> = (0..branch.points())
                    .filter(|&i| branch.slip_fraction_at(i).is_some_and(|s| s[0] > 0.0))
                    .collect();
                assert!(!slips.is_empty(), "{name}: no slip");
                let exact = onset(if from < to { -1.0 } else { 1.0 });
                // Near the tip the onset is as ill-conditioned as a double root.
                let near = 1e-11_f64.max(1e-13 / (1.0 - share).sqrt());
                // At the recorded onset slip may have begun by rounding.
                let gaps = [slips[0] - 1, slips[0]].map(|i| (branch.omega()[i] / exact - 1.0).abs());
                assert!(gaps[0].min(gaps[1]) <= near, "{name}: onset off by {gaps:?}");
                let turns = branch
                    .omega()
                    .windows(3)
                    .filter(|w| (w[1] - w[0]) * (w[2] - w[1]) < 0.0);
                assert_eq!(turns.count(), branch.folds().len(), "{name}");
            }
        }
    }
}
