//! Peaks of a batch, whose designs are followed in long steps, against fine sweeps: chains with light damping and sliders, several
//! resonances in the range, the highest of which may be any.

use crate::common::friction::Random;
use crate::common::models;
use crate::common::{at_dof, harmonics, omega_range};
use hbvib::{BatchOptions, Contact, Hooks, Model, Parameter, SolverOptions, Status, batch, forced_response};

fn between(random: &mut Random, low: f64, high: f64) -> f64 {
    low + 0.5 * (high - low) * (random.next() + 1.0)
}

fn below(random: &mut Random, count: usize) -> usize {
    between(random, 0.0, count as f64) as usize
}

fn power_of_ten(random: &mut Random, low: f64, high: f64) -> f64 {
    10_f64.powf(between(random, low, high))
}

/// A chain of 2 to 6 masses with 1 to 3 sliders against the ground.
fn chain(random: &mut Random) -> Model {
    let n = 2 + below(random, 5);
    let draw = |_| (between(random, 0.5, 2.0), between(random, 0.5, 2.0));
    let (mut springs, mass): (Vec<_>, Vec<_>) = (0..n).map(draw).unzip();
    springs.push(0.0);
    let mut model = models::chain(&mass, &springs)
        .rayleigh(0.0, power_of_ten(random, -3.8, -1.4))
        .build();
    let force = power_of_ten(random, -1.0, 0.5);
    for _ in 0..=below(random, 3) {
        let kt = power_of_ten(random, -1.0, 1.0);
        let limit = force * power_of_ten(random, -1.0, 1.0);
        let contact = Contact::jenkins(below(random, n), None, kt, 1.0, limit);
        model.add_contact(&contact).unwrap();
    }
    model.add_force(below(random, n), 1, force.into()).unwrap();
    model
}

#[test]
fn highest_peaks_of_light_chains_are_those_of_fine_sweeps() {
    let random = &mut Random(7);
    let mut slipping = 0;
    for k in 0..60 {
        let model = chain(random);
        let (low, high) = (between(random, 0.05, 0.3), between(random, 2.0, 3.2));
        let solver = at_dof(below(random, model.ndof()), harmonics([1, 3, 5][k % 3]));
        let options = BatchOptions {
            omega_start: low,
            omega_stop: high,
            ..BatchOptions::default()
        };
        let found = batch(
            &model,
            &solver,
            &options,
            (&[Parameter::Force], &[1.0]),
            &mut Hooks::default(),
        )
        .unwrap();
        let found = &found.peaks()[0];
        let fine = SolverOptions {
            step_max: 4e-3,
            ..solver
        };
        let range = omega_range(low, high);
        let branch = forced_response(&model, &fine, &range, &mut Hooks::default()).unwrap();
        assert_eq!((found.status, branch.status()), (Status::Ok, Status::Ok), "{k}");
        let highest = branch
            .peaks()
            .iter()
            .max_by(|a, b| a.amplitude.total_cmp(&b.amplitude))
            .unwrap();
        assert!(
            (found.amplitude / highest.amplitude - 1.0).abs() < 1e-8,
            "{k}: {found:?}, {highest:?}"
        );
        assert!(
            (found.omega / highest.omega - 1.0).abs() < 1e-7,
            "{k}: {found:?}, {highest:?}"
        );
        assert!(found.points < branch.points(), "{k}");
        slipping += usize::from(branch.slip_fraction().iter().any(|share| *share > 0.1));
    }
    assert!(slipping > 40, "{slipping}");
}
