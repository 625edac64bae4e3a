//! The beam on a friction lining of the example: its mesh against beam theory, its linear limit, and the
//! work of its contacts.

use crate::beam::{Beam, STEEL, Y, Z};
use crate::brick;
use crate::common::{at_dof, harmonics, omega_range};
use hbvib::internals::HarmonicBalance;
use hbvib::internals::Jacobian;
use hbvib::internals::{Condensed, Reference};
use hbvib::internals::{InitialGuess, Problem, Residual};
use hbvib::{Branch, ContactState, Hooks, Interrupt, Model, forced_response};
use num_complex::Complex64;
use std::f64::consts::TAU;

const LIFT: f64 = 0.1;

/// A coarser mesh, for speed.
fn small() -> Beam {
    Beam {
        elements: [8, 1, 2],
        rows: [6, 8],
        ..Beam::default()
    }
}

fn follow(beam: &Beam, model: &Model, harmonics: usize, from: f64, to: f64) -> Branch {
    let solver = at_dof(beam.tips()[0] + Z, crate::common::harmonics(harmonics));
    let range = omega_range(TAU * from, TAU * to);
    forced_response(model, &solver, &range, &mut Hooks::default()).unwrap()
}

fn fundamental(branch: &Branch, point: usize) -> Vec<Complex64> {
    let n = branch.ndof();
    let mut all = vec![Complex64::ZERO; (branch.harmonics() + 1) * n];
    branch.harmonics_at(point, &mut all).unwrap();
    all[n..2 * n].to_vec()
}

/// Under a pure strain of each kind a brick has the energy of the continuum, whatever its edges.
#[test]
fn a_brick_has_the_energy_of_uniform_strain_and_none_of_rigid_motion() {
    let size = [0.3, 0.2, 0.7];
    let stiffness = brick::stiffness(size, &STEEL);
    let shear = STEEL.young / (2.0 * (1.0 + STEEL.poisson));
    let along = STEEL.young * (1.0 - STEEL.poisson) / ((1.0 + STEEL.poisson) * (1.0 - 2.0 * STEEL.poisson));
    let volume: f64 = size.iter().product();
    let energy = |gradient: [[f64; 3]; 3]| {
        let u: Vec<f64> = (0..24)
            .map(|d| {
                let (c, k) = (d / 3, d % 3);
                (0..3).map(|e| gradient[k][e] * (c >> e & 1) as f64 * size[e]).sum()
            })
            .collect();
        let row = |i: usize| -> f64 { stiffness[i].iter().zip(&u).map(|(k, u)| k * u).sum() };
        (0..24).map(|i| u[i] * row(i)).sum::<f64>()
    };
    for k in 0..3 {
        let l = (k + 1) % 3;
        let mut gradient = [[0.0; 3]; 3];
        gradient[k][k] = 1.0;
        assert!((energy(gradient) / (along * volume) - 1.0).abs() < 1e-12);
        gradient[k] = [0.0; 3];
        gradient[k][l] = 1.0;
        assert!((energy(gradient) / (shear * volume) - 1.0).abs() < 1e-12);
        gradient[l][k] = -1.0;
        assert!(energy(gradient).abs() < 1e-12 * shear * volume, "a turn");
    }
    let mass = brick::mass(size, &STEEL);
    let whole: f64 = mass.iter().flatten().sum();
    assert!((whole / (3.0 * STEEL.density * volume) - 1.0).abs() < 1e-12);
}

/// (λ₁²/2π)·√(EI/ρA)/L² with λ₁ = 1.8751 for bending upwards and across; the beam is slender (10 to 1
/// across), shear and the clamp's hindered contraction are each below a percent.
#[test]
fn the_free_beam_bends_as_beam_theory_says() {
    let beam = Beam::default();
    let modes = beam
        .structure()
        .unwrap()
        .lowest_modes(0, ContactState::Free, 2)
        .unwrap();
    for (omega, thickness) in modes.omega.iter().zip([beam.size[1], beam.size[2]]) {
        let speed = (STEEL.young / STEEL.density).sqrt();
        let expected = 1.875_104_f64.powi(2) * speed * thickness / 12.0_f64.sqrt() / beam.size[0].powi(2);
        println!("{} Hz, beam theory {} Hz", omega / TAU, expected / TAU);
        assert!((omega / expected - 1.0).abs() < 0.015);
    }
}

/// Off the resonance; at it the rounding of the mesh's stiffness, 1e5 times that of the mode and magnified
/// by the resonance, is all that is seen.
#[test]
fn under_a_high_pressure_a_small_vibration_is_that_of_the_stuck_linear_beam() {
    let beam = Beam {
        pressure: 4e5,
        load: 400.0,
        ..small()
    };
    let force = 0.3;
    let model = beam.forced(force, LIFT).unwrap();
    let linear = beam.linear(true, force, LIFT).unwrap();
    let resonance = model.lowest_modes(0, ContactState::Stuck, 1).unwrap().omega[0] / TAU;
    for (share, tolerance) in [(0.2, 1e-10), (0.9, 1e-10), (1.0, 1e-8), (1.1, 1e-10), (1.6, 1e-10)] {
        let hz = share * resonance;
        let found = follow(&beam, &model, 2, hz, hz);
        let expected = fundamental(&follow(&beam, &linear, 1, hz, hz), 0);
        let size = expected.iter().fold(0.0_f64, |m, z| m.max(z.norm()));
        let motion = fundamental(&found, 0);
        let gaps = motion.iter().zip(&expected).map(|(x, y)| (x - y).norm() / size);
        let gap = gaps.fold(0.0, f64::max);
        println!("{hz} Hz: {gap:.1e}");
        assert!(gap < tolerance);
        assert!(found.slip_fraction_at(0).unwrap().iter().all(|s| *s == 0.0));
    }
}

#[test]
fn the_work_of_the_force_is_lost_in_the_beam_and_the_contacts() {
    let beam = small();
    let force = 6.0;
    let branch = follow(&beam, &beam.forced(force, LIFT).unwrap(), 3, 400.0, 450.0);
    let peak = branch
        .peaks()
        .iter()
        .max_by(|a, b| a.amplitude.total_cmp(&b.amplitude))
        .unwrap();
    let given = beam.work_of_force(&fundamental(&branch, peak.point), force, LIFT);
    let energy = branch.energy_at(peak.point).unwrap();
    let contacts: Vec<_> = (0..branch.contacts())
        .map(|c| branch.contact_summary(peak.point, c).unwrap())
        .collect();
    let lost: f64 = contacts.iter().map(|c| c.work).sum();
    println!(
        "{:.3} Hz: given {given:e}, beam {:e}, contacts {lost:e}; open {:?}",
        peak.omega / TAU,
        energy.structural_loss,
        contacts.iter().map(|c| c.open_share).collect::<Vec<_>>()
    );
    assert!(lost > 0.3 * given && energy.structural_loss > 0.03 * given);
    assert!((energy.friction_loss + energy.structural_loss - given).abs() < 1e-8 * given);
    // Each contact by itself, from its loop: as good as the samples.
    assert!((lost + energy.structural_loss - given).abs() < 1e-6 * given);
    assert!(contacts.iter().all(|c| c.work >= 0.0 && c.slip_share > 0.0));
    assert!(contacts.iter().any(|c| c.load_max > 1.01 * c.load_min));
}

/// Contacts that stick and stay closed leave Newton's equations with all their directions, though a load
/// rests in them; the matrix is the derivative of the residual all the same, column by column.
#[test]
fn closed_contacts_that_stick_drop_out_and_the_jacobian_is_that_of_differences() {
    let beam = small();
    let model = beam.forced(6.0, LIFT).unwrap();
    let omega = TAU * 300.0;
    let solver = harmonics(3);
    let condensed = Condensed::new(&model, &solver, omega, &Interrupt::none()).unwrap();
    assert_eq!(condensed.reference(), Reference::Stuck);
    let interrupt = Interrupt::none();
    let mut problem = HarmonicBalance::new(&condensed, beam.tips()[0] + Z, omega.into(), 0, None, &interrupt).unwrap();
    let n = problem.size();
    let m = n / condensed.coordinates();
    let mut u = vec![0.0; n];
    assert!(problem.initial_guess(InitialGuess::Reference, omega, &mut u).unwrap());
    // The vibration of the last contacts, but not their mean, grows until they slip.
    let contacts = condensed.contacts();
    for law in &condensed.laws()[contacts - 3..] {
        for c in &law.coordinates {
            u[c * m + 1..(c + 1) * m].iter_mut().for_each(|x| *x *= 5.0);
        }
    }
    let mut at = Residual::new(n).unwrap();
    problem.evaluate(&u, omega, &mut at).unwrap();
    let (mut jacobian, mut active) = (vec![0.0; n * n], vec![true; n]);
    problem.fill(&mut jacobian, &mut active).unwrap();
    let slipping = problem.slip_fractions().iter().filter(|s| **s > 0.0).count();
    let solved_for = active.iter().filter(|a| **a).count();
    println!("{slipping} of {contacts} contacts slip, {solved_for} of {n} unknowns are solved for");
    assert!(slipping > 0 && slipping < contacts && solved_for >= 3 * m * slipping && solved_for < n);
    let largest = u.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    let step = 1e-6 * largest;
    let (mut low, mut high) = (Residual::new(n).unwrap(), Residual::new(n).unwrap());
    for k in 0..n {
        let mut v = u.clone();
        v[k] = u[k] - step;
        problem.evaluate(&v, omega, &mut low).unwrap();
        v[k] = u[k] + step;
        problem.evaluate(&v, omega, &mut high).unwrap();
        let column = &jacobian[k * n..(k + 1) * n];
        let size = column.iter().fold(1.0_f64, |m, x| m.max(x.abs()));
        for (r, j) in column.iter().enumerate() {
            // Newton's matrix alone has the floor of 1e-8 on the means of contacts that slip.
            let difference = (high.values[r] - low.values[r]) / (2.0 * step);
            assert!(
                (difference - j).abs() < 3e-6 * size,
                "column {k}, row {r}: {j}, {difference}"
            );
        }
        assert!(
            active[k]
                || column
                    .iter()
                    .enumerate()
                    .all(|(r, x)| x.to_bits() == f64::from(u8::from(r == k)).to_bits())
        );
    }
}

/// State of the lining at rest: approach of the ground and constant load, against the stiffness of
/// the beam on its normal springs alone.
#[test]
fn without_vibration_the_lining_carries_what_statics_says() {
    let beam = Beam {
        pressure: 2e5,
        load: 200.0,
        ..small()
    };
    // The force vibrates at 1 Hz, far below all resonances, and is nothing beside the constant ones.
    let model = beam.forced(1e-9, LIFT).unwrap();
    let branch = follow(&beam, &model, 1, 1.0, 1.0);
    let mut all = vec![Complex64::ZERO; 2 * branch.ndof()];
    branch.harmonics_at(0, &mut all).unwrap();
    // The same as a linear system: springs, and the pressure as a force on the underside.
    let mut linear = beam.sprung(true).unwrap();
    let whole: f64 = beam.spots().iter().map(|s| s.area).sum();
    let up = 3 * (beam.elements[2] + 1);
    for spot in beam.spots() {
        let pressed = beam.pressure * spot.area;
        linear.add_force(spot.dof + Y, 0, pressed.into()).unwrap();
        let load = -beam.load * spot.area / whole;
        linear.add_force(spot.dof + up + Y, 0, load.into()).unwrap();
    }
    let expected = follow(&beam, &linear, 0, 1.0, 1.0);
    let mut static_motion = vec![Complex64::ZERO; beam.ndof()];
    expected.harmonics_at(0, &mut static_motion).unwrap();
    let size = static_motion.iter().fold(0.0_f64, |m, z| m.max(z.norm()));
    for (x, y) in all.iter().zip(&static_motion) {
        assert!((x - y).norm() < 1e-10 * size);
    }
    for (contact, spot) in beam.spots().iter().enumerate() {
        let found = branch.contact_summary(0, contact).unwrap();
        let load = spot.area * (beam.pressure - beam.stiffness.1 * static_motion[spot.dof + Y].re);
        assert!((found.load_min / load - 1.0).abs() < 1e-6 && found.open_share == 0.0);
    }
}
