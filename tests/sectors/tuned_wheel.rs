//! Large wheels as tuned ones plus terms of low rank: against factors of all sectors, and refused where differences have no low rank.

use crate::boundary_sector::{BoundarySector, N};
use crate::common::{all_harmonics, harmonics, relative_gap, slip};
use crate::sector_contacts::jenkins;
use hbvib::analysis::forced_response;
use hbvib::condense::FlexibilityWay;
use hbvib::hooks::Hooks;
use hbvib::linalg::matrix_view::MatrixView;
use hbvib::model::Model;
use hbvib::model::linear_modes::ContactState;
use hbvib::model::mistuning::{BladeProperty, Mistuning};
use hbvib::model::sector_faces::SectorFrame;
use hbvib::model::structure::MatrixKind;
use hbvib::options::{Flexibility, ForcedOptions, Response, SolverOptions};
use hbvib::results::Branch;

const DELTA: [f64; N] = [
    0.011, -0.023, 0.004, 0.017, -0.009, 0.021, -0.014, 0.002, -0.019, 0.008, 0.013, -0.011,
];
const TIP: usize = 106;

/// A wheel of 1,080 independent degrees of freedom with 24 contacts; `blade` are the degrees of freedom that differ.
fn wheel(blade: &[usize]) -> (Model, f64) {
    let mut sector = BoundarySector::read(SectorFrame::Cylindrical).model(3);
    for contact in [jenkins(3 * 27 + 1, 3 * 32 + 1, 0), jenkins(3 * 28 + 1, 3 * 33 + 1, 0)] {
        sector.add_contact(&contact).unwrap();
    }
    sector.add_force(TIP, 1, 1500.0.into()).unwrap();
    sector.set_rayleigh(0.0, 2e-6).unwrap();
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

fn solve(model: &Model, flexibility: Flexibility, (from, to): (f64, f64), tolerance: f64) -> Branch {
    let solver = SolverOptions {
        flexibility,
        tolerance,
        ..harmonics(3)
    };
    let blades = [0, 5].map(|s| Response {
        dofs: &[[TIP], [5 * 108 + TIP]][s / 5],
        ..Response::default()
    });
    let range = ForcedOptions {
        omega_start: from,
        omega_stop: to,
        responses: &blades,
        ..ForcedOptions::default()
    };
    forced_response(model, &solver, &range, &mut Hooks::default()).unwrap()
}

#[test]
fn a_mistuned_wheel_is_that_of_factors_of_all_sectors() {
    let (model, omega) = wheel(&[TIP, TIP - 3]);
    let at = (0.985 * omega, 0.985 * omega);
    let (found, known) = (
        solve(&model, Flexibility::Automatic, at, 0.0),
        solve(&model, Flexibility::Direct, at, 0.0),
    );
    let gap = relative_gap(&all_harmonics(&found, 0), &all_harmonics(&known, 0));
    println!("slip {:.2}, gap {gap:.1e}", slip(&found, 0));
    assert!(slip(&found, 0) > 0.0 && gap < 1e-10, "{gap}");
}
