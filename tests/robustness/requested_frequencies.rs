//! Solutions at requested frequencies: each within a covered range has one, though a step went over a bulge or two folds there.

use crate::common::models::dense;
use crate::common::{all_harmonics, at_dof, harmonics, sweep};
use hbvib::{Contact, Model, Status};

/// Three masses with two stops that are open at rest, and a loss factor.
fn model() -> Model {
    let mass = [1.378_955_821_346_372, 0.990_483_258_024_492_3, 1.147_031_839_863_461_6];
    let (first, second) = (-1.681_768_222_660_135_1, -1.781_283_606_205_911_4);
    let own = [3.640_300_548_877_61, 3.463_051_828_866_046_6, 3.045_414_799_541_367];
    let m = [mass[0], 0.0, 0.0, 0.0, mass[1], 0.0, 0.0, 0.0, mass[2]];
    let k = [own[0], first, 0.0, first, own[1], second, 0.0, second, own[2]];
    let mut model = dense(&m, &k).loss_factor(0.005).build();
    for dof in [0, 1] {
        model
            .add_contact(&Contact::unilateral(Some(dof), None, 0.5, 0.3))
            .unwrap();
    }
    model.add_force(2, 1, 0.3.into()).unwrap();
    model
}

/// A downward sweep had no solution at the last of these, where single frequencies have 0.533 674 45.
#[test]
fn every_requested_frequency_has_a_solution() {
    let solver = at_dof(2, harmonics(5));
    let (model, lost) = (model(), 0.817_294_558_272_533_3);
    let mut at: Vec<f64> = (0..60).map(|i| 0.74 + 0.03 * f64::from(i)).collect();
    at.push(lost);
    for (from, to) in [
        (2.536_732_129_651_715_4, 0.727_392_120_624_784_2),
        (0.727_392, 2.536_732),
    ] {
        let branch = sweep(&model, &solver, from, to, &at);
        assert_eq!(branch.status(), Status::Ok);
        for (i, omega) in at.iter().enumerate() {
            let inside = (*omega - from) * (*omega - to) <= 0.0;
            let found = branch.at(i);
            assert!(!inside || !found.is_empty(), "{omega} from {from}");
            for point in found {
                assert!((branch.omega_at(point.point).unwrap() - omega).abs() < 1e-12);
            }
        }
        let alone = sweep(&model, &solver, lost, lost, &[]).amplitude()[0];
        assert!((alone - 0.533_674_45).abs() < 1e-8, "{alone}");
        // The fundamental of the last degree of freedom.
        let amplitude = |point: usize| all_harmonics(&branch, point)[3 + 2].norm();
        let mut gaps = branch
            .at(at.len() - 1)
            .iter()
            .map(|p| (amplitude(p.point) - alone).abs());
        assert!(from < to || gaps.any(|gap| gap < 1e-8), "{from}");
    }
}
