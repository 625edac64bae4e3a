//! Energies and losses of a point: against closed forms, against the time signals of the whole
//! wheel, and against the work of the forces.

mod common;

use common::{BASE, Blisk, SECTORS, Wheel, all_harmonics, harmonics, phase, slip, solve_at};
use hbvib::branch::{Branch, Energy};
use hbvib::contact::Contact;
use hbvib::error::Status;
use hbvib::linalg::matrix_view::{MatrixView, Part};
use hbvib::model::Model;
use hbvib::model::structure::MatrixKind;
use hbvib::options::SolverOptions;
use num_complex::Complex64;
use std::f64::consts::{PI, TAU};

fn close(name: &str, found: f64, expected: f64, tolerance: f64) {
    let error = (found - expected).abs() / expected.abs();
    println!("{name}: {found:e}, error {error:.1e}");
    assert!(error < tolerance, "{name}: {found:e}, needs {expected:e}: {error:.1e}");
}

/// Solved as far as rounding allows.
fn exactly(highest: usize) -> SolverOptions {
    SolverOptions {
        tol_residual: 1e-14,
        ..harmonics(highest)
    }
}

fn energy(branch: &Branch) -> Energy {
    branch.energy_at(0).unwrap()
}

/// Largest value of a function of the phase of the fundamental, to rounding.
fn maximum(f: impl Fn(f64) -> f64) -> f64 {
    let n = 2000;
    let width = TAU / f64::from(n);
    let best = (0..n).map(|j| f64::from(j) * width);
    let best = best.max_by(|a, b| f(*a).total_cmp(&f(*b))).unwrap();
    let (mut low, mut high) = (best - width, best + width);
    for _ in 0..80 {
        let (a, b) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
        if f(a) < f(b) { low = a } else { high = b }
    }
    f(0.5 * (low + high))
}

/// Mean over a period of a trigonometric polynomial of less than 200 harmonics.
fn mean(f: impl Fn(f64) -> f64) -> f64 {
    (0..200).map(|j| f(TAU * f64::from(j) / 200.0)).sum::<f64>() / 200.0
}

/// Work per cycle of the forces (degree of freedom, harmonic, value) on the motion of a point.
fn work(branch: &Branch, forces: &[(usize, usize, Complex64)]) -> f64 {
    let x = all_harmonics(branch, 0);
    let n = branch.ndof();
    let part = |&(dof, h, f): &(usize, usize, Complex64)| PI * h as f64 * (f * x[h * n + dof].conj()).im;
    forces.iter().map(part).sum()
}

/// A mass on a spring, M = 2 and K = 8.
fn mass_on_spring() -> Model {
    let mut model = Model::new(1).unwrap();
    model
        .set_matrix(MatrixKind::Mass, &MatrixView::dense(1, &[2.0]))
        .unwrap();
    model
        .set_matrix(MatrixKind::Stiffness, &MatrixView::dense(1, &[8.0]))
        .unwrap();
    model
}

#[test]
fn a_mass_on_a_spring_has_the_energies_of_the_textbook() {
    let mut model = mass_on_spring();
    model.add_force(0, 1, Complex64::new(0.3, -0.4)).unwrap();
    for omega in [0.7, 1.5, 3.1] {
        let x = 0.5 / (8.0 - 2.0 * omega * omega);
        let (kinetic, potential) = (omega * omega * x * x, 4.0 * x * x);
        let e = energy(&solve_at(&model, &harmonics(3), omega));
        close("T", e.twice_mean_kinetic, kinetic, 1e-13);
        close("kinetic, mean", e.kinetic_mean, 0.5 * kinetic, 1e-13);
        close("kinetic, peak", e.kinetic_peak, kinetic, 1e-13);
        close("potential, mean", e.potential_mean, 0.5 * potential, 1e-13);
        close("potential, peak", e.potential_peak, potential, 1e-13);
        assert!(e.structural_loss.abs() < 1e-15 * potential && e.friction_loss == 0.0);
        // The wheel of a plain structure is the structure.
        assert_eq!(
            [
                e.wheel_kinetic_mean,
                e.wheel_kinetic_peak,
                e.wheel_potential_mean,
                e.wheel_potential_peak
            ],
            [e.kinetic_mean, e.kinetic_peak, e.potential_mean, e.potential_peak]
        );
    }
}

#[test]
fn static_and_several_harmonic_motions_add_up_in_the_peak() {
    // All harmonics are positive at t = 0, where the motion x₀ + x₁ + x₂ is largest.
    let mut model = mass_on_spring();
    let omega = 0.4;
    let forces = [0.5, 1.0, 0.2];
    for (h, f) in forces.into_iter().enumerate() {
        model.add_force(0, h, f.into()).unwrap();
    }
    let x = [0.0, 1.0, 2.0].map(|h: f64| forces[h as usize] / (8.0 - 2.0 * (h * omega).powi(2)));
    let e = energy(&solve_at(&model, &harmonics(2), omega));
    let squares = x[1] * x[1] + x[2] * x[2];
    close(
        "potential, mean",
        e.potential_mean,
        4.0 * x[0] * x[0] + 2.0 * squares,
        1e-13,
    );
    close(
        "potential, peak",
        e.potential_peak,
        4.0 * (x[0] + x[1] + x[2]).powi(2),
        1e-13,
    );
    let t = omega * omega * (x[1] * x[1] + 4.0 * x[2] * x[2]);
    close("T", e.twice_mean_kinetic, t, 1e-13);
    let velocity = |t: f64| omega * (x[1] * t.sin() + 2.0 * x[2] * (2.0 * t).sin());
    close("kinetic, peak", e.kinetic_peak, maximum(|t| velocity(t).powi(2)), 1e-13);
}

#[test]
fn a_static_motion_has_its_strain_energy_alone() {
    let mut model = mass_on_spring();
    model.add_force(0, 0, 4.0.into()).unwrap();
    let e = energy(&solve_at(&model, &harmonics(0), 1.0));
    let expected = Energy {
        potential_mean: 1.0,
        potential_peak: 1.0,
        wheel_potential_mean: 1.0,
        wheel_potential_peak: 1.0,
        ..Energy::default()
    };
    assert_eq!(e, expected);
}

#[test]
fn a_slipping_contact_takes_four_limits_times_the_slip() {
    // W = 4 fc (A − fc/k), A half the range of a relative motion that reverses twice.
    for highest in [1, 3, 9] {
        let mut model = mass_on_spring();
        let (stiffness, limit) = (5.0, 0.3 * 0.7);
        model
            .add_contact(&Contact::jenkins(0, None, stiffness, 0.3, 0.7))
            .unwrap();
        // A second contact on the same motion.
        model.add_contact(&Contact::jenkins(0, None, 1.0, 0.3, 0.1)).unwrap();
        model.add_force(0, 1, Complex64::new(0.3, 0.9)).unwrap();
        let branch = solve_at(&model, &harmonics(highest), 2.1);
        assert!(slip(&branch, 0) > 0.2 && slip(&branch, 0) < 1.0);
        let x = all_harmonics(&branch, 0);
        let motion = |t: f64| {
            (0..)
                .zip(&x)
                .map(|(h, x)| (x * Complex64::cis(f64::from(h) * t)).re)
                .sum()
        };
        let a = maximum(motion);
        let expected = 4.0 * limit * (a - limit / stiffness) + 4.0 * 0.03 * (a - 0.03);
        close(
            &format!("H = {highest}, loss"),
            energy(&branch).friction_loss,
            expected,
            1e-12,
        );
    }
}

#[test]
fn a_stuck_contact_and_a_structure_without_damping_take_nothing() {
    let mut blisk = BASE.sector();
    blisk.set_rayleigh(0.0, 0.0).unwrap();
    blisk.set_preload(0, 1e9).unwrap();
    for model in [
        blisk,
        Skewed {
            damped: false,
            ..SKEWED
        }
        .sector(),
    ] {
        let branch = solve_at(&model, &harmonics(3), 1.3);
        let e = energy(&branch);
        println!("{e:?}");
        assert!(slip(&branch, 0) == 0.0 && e.potential_mean > 0.0);
        assert!(e.structural_loss.abs() < 1e-22 * e.potential_mean);
        assert!(e.friction_loss.abs() < 1e-13 * e.potential_mean);
    }
}

#[test]
fn the_work_of_the_forces_is_what_damping_and_friction_take() {
    let force: Complex64 = BASE.force.into();
    for highest in [1, 3, 9] {
        for hz in [208.0, 208.85, 210.0] {
            let branch = solve_at(&BASE.sector(), &exactly(highest), TAU * hz);
            assert!(slip(&branch, 0) > 0.0);
            let e = energy(&branch);
            let expected = work(&branch, &[(0, 1, force), (1, 1, force)]);
            close(
                &format!("H = {highest}, {hz} Hz"),
                e.structural_loss + e.friction_loss,
                expected,
                1e-9,
            );
            assert!(e.structural_loss > 0.0 && e.friction_loss > 0.0);
        }
    }
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
fn stiffness_without_symmetry_works_on_the_structure() {
    // A follower force feeds the motion: the loss of the structure is negative.
    let mut model = Model::new(2).unwrap();
    let dense = |a| MatrixView::dense(2, a);
    model
        .set_matrix(MatrixKind::Mass, &dense(&[1.0, 0.0, 0.0, 1.0]))
        .unwrap();
    let follower = [4.0, 0.5, -0.5, 4.0];
    model
        .set_matrix(MatrixKind::Stiffness, &dense(&follower).part(Part::General))
        .unwrap();
    model.add_contact(&Contact::jenkins(0, None, 2.0, 0.5, 0.4)).unwrap();
    // The force turns with the motion that the follower force feeds, or against it.
    let mut signs = [0.0; 2];
    for (sign, quarter) in signs.iter_mut().zip([Complex64::I, -Complex64::I]) {
        let forces = [(0, 1, Complex64::ONE), (1, 1, quarter)];
        model.clear_forces();
        for (dof, h, value) in forces {
            model.add_force(dof, h, value).unwrap();
        }
        let branch = solve_at(&model, &exactly(5), 1.2);
        assert!(slip(&branch, 0) > 0.0);
        let e = energy(&branch);
        close(
            "work",
            e.structural_loss + e.friction_loss,
            work(&branch, &forces),
            1e-9,
        );
        *sign = e.structural_loss.signum();
    }
    assert!(signs[0] * signs[1] < 0.0);
}

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
        let mut model = Model::cyclic(N, SECTORS).unwrap();
        let dense = |a| MatrixView::dense(N, a);
        for (which, own, next) in [
            (MatrixKind::Mass, &MASS, &MASS_NEXT),
            (MatrixKind::Stiffness, &STIFFNESS, &STIFFNESS_NEXT),
        ] {
            model.set_matrix(which, &dense(own)).unwrap();
            model.set_coupling(which, &dense(next)).unwrap();
        }
        if self.damped {
            let which = MatrixKind::Damping;
            model.set_matrix(which, &dense(&DAMPING)).unwrap();
            model.set_coupling(which, &dense(&DAMPING_NEXT)).unwrap();
            model.set_coupling_previous(which, &dense(&DAMPING_PREVIOUS)).unwrap();
        }
        model.set_wave(self.engine_order);
        for contact in self.contacts() {
            model.add_contact(&contact).unwrap();
        }
        for (dof, h, value) in FORCES {
            model.add_force(dof, h, value).unwrap();
        }
        model
    }

    fn wheel(self) -> Model {
        let mut wheel = Wheel::new(N, SECTORS);
        wheel.set(MatrixKind::Mass, &MASS, Some(&MASS_NEXT), None);
        wheel.set(MatrixKind::Stiffness, &STIFFNESS, Some(&STIFFNESS_NEXT), None);
        wheel.set(
            MatrixKind::Damping,
            &DAMPING,
            Some(&DAMPING_NEXT),
            Some(&DAMPING_PREVIOUS),
        );
        for contact in self.contacts() {
            wheel.add_contact(&contact);
        }
        for (dof, h, value) in FORCES {
            wheel.add_force(dof, h, value, self.engine_order);
        }
        wheel.model
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

/// What the energies must be: of the time signals of one sector and its neighbours.
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
            let wheel = |t: f64| (0..SECTORS).map(|s| self.energy(s, kinetic, t)).sum::<f64>();
            let expected = [mean(sector), maximum(sector), mean(wheel), maximum(wheel)];
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
        (blisk(2).sector(), blisk(2).wheel(), 7, TAU * 208.85),
        (blisk(3).sector(), blisk(3).wheel(), 9, TAU * 212.4),
        (skewed(2).sector(), skewed(2).wheel(), 4, 1.9),
        (skewed(-2).sector(), skewed(-2).wheel(), 4, 1.9),
        (skewed(12).sector(), skewed(12).wheel(), 4, 1.9),
        (skewed(0).sector(), skewed(0).wheel(), 4, 1.9),
    ];
    for (sector, wheel, highest, omega) in cases {
        let branch = solve_at(&sector, &exactly(highest), omega);
        assert!(slip(&branch, 0) > 0.0);
        let a = energy(&branch);
        let b = energy(&solve_at(&wheel, &exactly(highest), omega));
        let n = SECTORS as f64;
        println!("EO {}", sector.structure().engine_order());
        for (name, sector, wheel) in [
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
            close(name, sector, wheel, 1e-11);
        }
    }
}

#[test]
fn energies_come_in_the_units_of_the_caller() {
    // Tonnes, millimetres and newtons: energies in millijoules.
    let small = Blisk {
        units: (1e3, 1e-3, 1.0),
        ..BASE
    };
    let omega = TAU * 208.85;
    let a = energy(&solve_at(&BASE.sector(), &exactly(5), omega));
    let b = energy(&solve_at(&small.sector(), &exactly(5), omega));
    for (name, si, millijoules) in [
        ("T", a.twice_mean_kinetic, b.twice_mean_kinetic),
        ("kinetic", a.kinetic_peak, b.kinetic_peak),
        ("potential", a.wheel_potential_peak, b.wheel_potential_peak),
        ("structural loss", a.structural_loss, b.structural_loss),
        ("friction loss", a.friction_loss, b.friction_loss),
    ] {
        close(name, 1e-3 * millijoules, si, 1e-11);
    }
}

#[test]
fn a_point_that_is_not_stored_is_refused() {
    let branch = solve_at(&BASE.sector(), &harmonics(1), 1300.0);
    let error = branch.energy_at(branch.stored()).unwrap_err();
    assert_eq!(error.status, Status::Index);
}
