//! The beam and the sector stop at any time of each analysis: setup, condensation, first point, branch, estimates, modes.

use crate::beam::{Beam, Z};
use crate::common::stopping::{Analysis, Lateness, of_branch, of_call};
use crate::common::{amplitude_range, at_dof, harmonics, omega_range};
use crate::sector::{ENGINE_ORDER, Sector, Size};
use hbvib::{ContactState, Hooks, ModeChoice, ModeOptions, Model, SolverOptions, forced_response, nonlinear_mode};

/// The analyses of a model around its first resonance in a pattern of some nodal diameters.
fn analyses(model: &Model, response: usize, diameter: i64) -> Vec<Analysis<'_>> {
    let first = model.lowest_modes(diameter, ContactState::Stuck, 1).unwrap().omega[0];
    let fixed = at_dof(response, harmonics(3));
    let automatic = SolverOptions {
        tolerance: 1e-2,
        ..fixed
    };
    let range = omega_range(0.97 * first, 1.03 * first);
    let forced = move |solver: SolverOptions| {
        move |hooks: &mut Hooks<'_>| of_branch(forced_response(model, &solver, &range, hooks))
    };
    let shape = ModeOptions {
        choice: ModeChoice::Index(0),
        ..amplitude_range(-6.0, -2.0)
    };
    let mut all: Vec<Analysis<'_>> = vec![
        ("forced, fixed H", Box::new(forced(fixed))),
        ("forced, tolerance", Box::new(forced(automatic))),
        (
            "linear modes",
            Box::new(move |hooks| {
                let interrupt = hooks.interrupt();
                of_call(model.lowest_modes_with(diameter, ContactState::Stuck, 20, &interrupt))
            }),
        ),
    ];
    // Diameter 0 stands for the beam, whose modes other tests stop.
    if diameter > 0 {
        all.push((
            "nonlinear mode",
            Box::new(move |hooks| of_branch(nonlinear_mode(model, &fixed, &shape, hooks))),
        ));
    }
    all
}

#[test]
#[ignore = "minutes: limits on times, for tests/deep.sh"]
fn finite_element_models_return_within_a_tenth_of_a_second() {
    let mut state = 0xfe;
    let mut all = Lateness::default();
    let beam = Beam::default();
    let model = beam.forced(6.0, 0.1).unwrap();
    for analysis in analyses(&model, beam.tips()[0] + Z, 0) {
        all.add("beam", &analysis, 4, &mut state);
    }
    let folder = crate::common::programs::root().join("examples/data/fe");
    for (name, size) in [("reduced", Size::Reduced), ("sector", Size::Full)] {
        let sector = Sector::read(&folder, size).unwrap();
        let model = sector.forced(2.0).unwrap();
        for analysis in analyses(&model, size.tip(), ENGINE_ORDER) {
            all.add(name, &analysis, 3, &mut state);
        }
    }
    all.check();
}
