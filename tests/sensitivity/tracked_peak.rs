//! A peak followed over the normal load has the optimum of a separate computation, the same curve up and down, and
//! derivatives that are its own slope.

use crate::common::{BASE, all_harmonics, relative_gap};
use crate::design::{Design, Results, tight};
use hbvib::{
    Branch, Constant, Follow, Hooks, Parameter, ParameterRange, Quantity, Status, parameter_response, sensitivity,
};
use std::f64::consts::TAU;

const PRELOAD: Parameter<'static> = Parameter::Contact {
    constant: Constant::Preload,
    contact: Some(0),
};

fn tracked((start, stop): (f64, f64), at: &[f64], follow: Follow) -> Branch {
    let model = Design::ring_damper(&BASE, 300.0).model();
    let range = ParameterRange {
        start,
        stop,
        at,
        follow,
        response: None,
    };
    let found = parameter_response(&model, &tight(9), PRELOAD, &range, &mut Hooks::default()).unwrap();
    assert_eq!(
        found.status(),
        Status::Ok,
        "after {:?}",
        found.parameter().unwrap().last()
    );
    assert_eq!(found.parameter().unwrap()[0].to_bits(), start.to_bits());
    assert_eq!(found.parameter().unwrap().last().unwrap().to_bits(), stop.to_bits());
    found
}

#[test]
fn peak_over_the_normal_load_has_the_optimum_of_the_reference() {
    let at = [300.0, 800.0];
    let up = tracked((100.0, 1200.0), &at, Follow::Peak(208.0 * TAU));
    println!("{} points, optima {:?}", up.points(), up.optima());
    let [optimum] = up.optima()[..] else {
        panic!("{:?}", up.optima())
    };
    assert!(!optimum.is_maximum);
    assert!((optimum.parameter / 482.852_251 - 1.0).abs() < 1e-5, "{optimum:?}");
    assert!((optimum.omega / TAU / 208.796_528 - 1.0).abs() < 1e-8, "{optimum:?}");
    assert!(
        (optimum.amplitude / 1.415_704_171_8e-3 - 1.0).abs() < 1e-8,
        "{optimum:?}"
    );
    let down = tracked((1200.0, 100.0), &at, Follow::Peak(209.5 * TAU));
    assert!((down.optima()[0].parameter / optimum.parameter - 1.0).abs() < 1e-5);
    for (i, (frequency, amplitude, slope)) in [
        (208.097_030_8, 1.934_880_980e-3, -8.294_694_705e-6),
        (209.376_838_4, 1.706_910_530e-3, 1.262_963_439e-6),
    ]
    .into_iter()
    .enumerate()
    {
        for curve in [&up, &down] {
            let [point] = curve.at(i)[..] else {
                panic!("{:?}", curve.at(i))
            };
            assert!((point.omega / TAU / frequency - 1.0).abs() < 1e-8, "{point:?}");
            assert!((point.amplitude / amplitude - 1.0).abs() < 1e-8, "{point:?}");
            let (parameter, derivative) = curve.parameter_at(point.point).unwrap();
            assert_eq!(parameter.to_bits(), at[i].to_bits());
            assert!((derivative / slope - 1.0).abs() < 1e-6, "{derivative}");
        }
    }
}

#[test]
fn response_at_a_fixed_frequency_has_its_maximum_where_the_peak_rises() {
    let found = tracked((100.0, 1200.0), &[608.0], Follow::Omega(208.85 * TAU));
    println!("{} points, optima {:?}", found.points(), found.optima());
    let near = |p: f64| (p / 608.0 - 1.0).abs() < 0.01;
    assert!(found.optima().iter().any(|o| o.is_maximum && near(o.parameter)));
    let model = Design::ring_damper(&BASE, 608.0).model();
    let (branch, point, values) = Results::At(208.85 * TAU).solve(&model, &tight(9));
    let own = found.at(0)[0];
    assert!((own.amplitude / values[0].1 - 1.0).abs() < 1e-9);
    let gap = relative_gap(&all_harmonics(&found, own.point), &all_harmonics(&branch, point));
    assert!(gap < 1e-9, "{gap}");
    let parameters = [Parameter::Force];
    let refused = sensitivity(&model, &found, own.point, &parameters, Quantity::Amplitude).unwrap_err();
    assert!(refused.to_string().contains("model of its own"), "{refused}");
}
