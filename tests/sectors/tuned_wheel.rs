//! Large wheels as tuned ones plus terms of low rank: against factors of all sectors, and refused where differences have no low rank.

use crate::boundary_sector::{BoundarySector, N};
use crate::common::{all_harmonics, harmonics, omega_range, relative_gap, slip};
use crate::sector_contacts::jenkins;
use hbvib::internals::FlexibilityWay;
use hbvib::{
    BladeProperty, Branch, ContactState, Flexibility, ForcedOptions, Hooks, MatrixKind, MatrixView, Mistuning, Model,
    Response, SectorFrame, SolverOptions, forced_response,
};

const DELTA: [f64; N] = [
    0.011, -0.023, 0.004, 0.017, -0.009, 0.021, -0.014, 0.002, -0.019, 0.008, 0.013, -0.011,
];
const TIP: usize = 106;

fn sector() -> Model {
    let mut sector = BoundarySector::read(SectorFrame::Cylindrical).model(3);
    for contact in [jenkins(3 * 27 + 1, 3 * 32 + 1, 0), jenkins(3 * 28 + 1, 3 * 33 + 1, 0)] {
        sector.add_contact(&contact).unwrap();
    }
    sector.add_force(TIP, 1, 1500.0.into()).unwrap();
    sector.set_rayleigh(0.0, 2e-6).unwrap();
    sector
}

/// A wheel with 24 contacts; `blade` are the degrees of freedom that differ.
fn wheel(blade: &[usize]) -> (Model, f64) {
    let sector = sector();
    let omega = sector.linear_modes(3, ContactState::Stuck).unwrap().omega[0];
    let mut wheel = sector.wheel().unwrap();
    for property in [BladeProperty::Frequency, BladeProperty::Mass] {
        wheel
            .mistune(&sector, &Mistuning::Blade(property, blade), &DELTA)
            .unwrap();
    }
    let n = sector.ndof();
    let mut between = vec![0.0; n * n];
    for (i, j, v) in [
        (TIP, TIP, 1.0),
        (TIP - 1, TIP - 1, 1.0),
        (TIP, TIP - 1, -1.0),
        (TIP - 1, TIP, -1.0),
    ] {
        between[j * n + i] = 1e5 * v;
    }
    let view = MatrixView::dense(n, &between);
    let turned: Vec<f64> = DELTA.iter().rev().copied().collect();
    wheel
        .mistune(&sector, &Mistuning::Matrix(MatrixKind::Stiffness, &view), &turned)
        .unwrap();
    (wheel, omega)
}

fn solve(model: &Model, flexibility: Flexibility, (from, to): (f64, f64), highest: usize) -> Branch {
    let solver = SolverOptions {
        flexibility,
        response_dof: Some(TIP),
        ..harmonics(highest)
    };
    let blades = [0, 5].map(|s| Response {
        dofs: &[[TIP], [5 * 108 + TIP]][s / 5],
        ..Response::default()
    });
    let range = ForcedOptions {
        responses: &blades,
        ..omega_range(from, to)
    };
    forced_response(model, &solver, &range, &mut Hooks::default()).unwrap()
}

fn reduction(branch: &Branch) -> FlexibilityWay {
    branch.reduction().flexibility_way
}

#[test]
fn a_mistuned_wheel_is_that_of_factors_of_all_sectors() {
    let (model, omega) = wheel(&[TIP, TIP - 3]);
    let at = (0.985 * omega, 0.987 * omega);
    let both = |range, harmonics| {
        [Flexibility::Automatic, Flexibility::Direct].map(|way| solve(&model, way, range, harmonics))
    };
    let [found, known] = both(at, 3);
    let gap = relative_gap(&all_harmonics(&found, 0), &all_harmonics(&known, 0));
    println!("slip {:.2}, gap {gap:.1e}", slip(&found, 0));
    assert!(slip(&found, 0) > 0.0 && gap < 1e-10, "{gap}");
    // Along a sweep, with the derivatives that lead it, stretches where all contacts stick, and peaks of several blades.
    let [found, known] = both((0.97 * omega, 1.01 * omega), 1);
    assert_eq!(reduction(&found), FlexibilityWay::TunedWheel);
    assert_ne!(reduction(&known), FlexibilityWay::TunedWheel);
    assert_eq!(found.points(), known.points());
    for (found, known) in found.responses().iter().zip(known.responses()) {
        assert_eq!(found.peaks().len(), known.peaks().len());
        for (peak, known) in found.peaks().iter().zip(known.peaks()) {
            let gap = (peak.amplitude / known.amplitude - 1.0).abs();
            assert!(gap < 1e-9, "{gap:e}");
        }
    }
    assert!(found.responses().iter().any(|found| !found.peaks().is_empty()));
}

#[test]
fn a_wheel_whose_blades_differ_in_all_motions_is_left_to_other_ways() {
    let blade: Vec<usize> = (0..108).collect();
    let (mut model, omega) = wheel(&[TIP]);
    let sector = sector();
    // A mass on each degree of freedom of its own.
    for &dof in blade
        .iter()
        .skip(40)
        .step_by(1)
        .filter(|dof| sector.structure().degrees().image(**dof).0 == 0)
    {
        let delta: Vec<f64> = DELTA.iter().map(|d| d * (1.0 + (dof as f64).sin())).collect();
        let one = Mistuning::Blade(BladeProperty::Mass, core::slice::from_ref(&blade[dof]));
        model.mistune(&sector, &one, &delta).unwrap();
    }
    let range = (0.985 * omega, 0.99 * omega);
    let [found, known] = [Flexibility::Automatic, Flexibility::Direct].map(|way| solve(&model, way, range, 1));
    assert_ne!(reduction(&found), FlexibilityWay::TunedWheel);
    let gap = relative_gap(&all_harmonics(&found, 0), &all_harmonics(&known, 0));
    assert!(gap < 1e-9, "{gap}");
}
