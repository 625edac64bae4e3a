//! A peak followed over the normal load has the optimum of a separate computation, the same curve up and down, and
//! derivatives that are its own slope.

use crate::common::BASE;
use crate::design::{Design, Results, tight};
use hbvib::{Constant, Follow, Hooks, Parameter, ParameterResponse, Status, parameter_response};
use std::f64::consts::TAU;

const PRELOAD: Parameter<'static> = Parameter::Contact {
    constant: Constant::Preload,
    contact: Some(0),
};

fn tracked(range: (f64, f64), at: &[f64], follow: Follow) -> ParameterResponse {
    let model = Design::ring_damper(&BASE, 300.0).model();
    let found = parameter_response(&model, &tight(9), PRELOAD, range, at, follow, &mut Hooks::default()).unwrap();
    assert_eq!(found.status, Status::Ok, "after {:?}", found.points.last());
    found
}

#[test]
fn peak_over_the_normal_load_has_the_optimum_of_the_reference() {
    let at = [300.0, 800.0];
    let up = tracked((100.0, 1200.0), &at, Follow::Peak(208.0 * TAU));
    println!("{} points, optima {:?}", up.points.len(), up.optima);
    let (optimum, is_maximum) = up.optima[0];
    assert!(up.optima.len() == 1 && !is_maximum);
    assert!((optimum.parameter / 482.852_251 - 1.0).abs() < 1e-5, "{optimum:?}");
    assert!((optimum.omega / TAU / 208.796_528 - 1.0).abs() < 1e-8, "{optimum:?}");
    assert!((optimum.amplitude / 1.415_704_171_8e-3 - 1.0).abs() < 1e-8, "{optimum:?}");
    let down = tracked((1200.0, 100.0), &at, Follow::Peak(209.5 * TAU));
    let other = down.optima[0].0;
    assert!((other.parameter / optimum.parameter - 1.0).abs() < 1e-5);
    for (i, (frequency, amplitude, slope)) in [
        (208.097_030_8, 1.934_880_980e-3, -8.294_694_705e-6),
        (209.376_838_4, 1.706_910_530e-3, 1.262_963_439e-6),
    ]
    .into_iter()
    .enumerate()
    {
        for curve in [&up, &down] {
            let [point] = curve.at[i][..] else { panic!("{:?}", curve.at[i]) };
            assert!((point.omega / TAU / frequency - 1.0).abs() < 1e-8, "{point:?}");
            assert!((point.amplitude / amplitude - 1.0).abs() < 1e-8, "{point:?}");
            assert!((point.d_amplitude / slope - 1.0).abs() < 1e-6, "{point:?}");
        }
    }
}

#[test]
fn response_at_a_fixed_frequency_has_its_maximum_where_the_peak_rises() {
    let found = tracked((100.0, 1200.0), &[608.0], Follow::Omega(208.85 * TAU));
    println!("{} points, optima {:?}", found.points.len(), found.optima);
    let maxima = found.optima.iter().filter(|(_, is_maximum)| *is_maximum);
    assert!(maxima.clone().any(|(point, _)| (point.parameter / 608.0 - 1.0).abs() < 0.01));
    let model = Design::ring_damper(&BASE, 608.0).model();
    let alone = Results::At(208.85 * TAU).solve(&model, &tight(9)).2[0].1;
    assert!((found.at[0][0].amplitude / alone - 1.0).abs() < 1e-9);
}
