//! The matrices of a wave of this blisk are real, those of the wave that travels the other way are the same, and contacts across
//! sectors tell the two apart: harmonics 7 to 11 travel backward. An estimate that takes one for the other has no end of harmonics.

use crate::common::{BASE, R, harmonics, sweep};
use hbvib::{Contact, SolverOptions, Status};
use std::f64::consts::TAU;

#[test]
fn estimates_of_waves_in_both_directions_are_near_the_true_error() {
    let mut model = BASE.sector();
    let across = Contact {
        sector_offset: 1,
        ..Contact::jenkins(R, Some(R), 2e7, 0.3, 10.0)
    };
    model.add_contact(&across).unwrap();
    let (start, end) = (TAU * 207.0, TAU * 211.0);
    let at: Vec<f64> = (1..8).map(|i| start + (end - start) * f64::from(i) / 8.0).collect();
    let solver = SolverOptions {
        tolerance: 1e-3,
        response_dof: Some(0),
        ..SolverOptions::default()
    };
    let branch = sweep(&model, &solver, start, end, &at);
    let truth = sweep(&model, &harmonics(151), start, end, &at);
    assert_eq!(branch.status(), Status::Ok);
    let most = branch.harmonics_used().iter().fold(0.0_f64, |m, &h| m.max(h));
    assert!(most < 100.0, "{most} harmonics");
    for (i, omega) in at.iter().enumerate() {
        let ([found], [wanted]) = (branch.at(i), truth.at(i)) else {
            panic!("not one solution at {omega}");
        };
        let error = (found.amplitude / wanted.amplitude - 1.0).abs();
        assert!(error < 1e-3, "{error:e} at {omega}");
    }
}
