//! Tests of predictions.

use super::*;
use crate::continuation::curvature_circle::CurvatureCircle;

/// A point of a curve whose stored tangent has the length of the derivative.
fn point(v: [f64; 3], tangent: [f64; 3]) -> Point {
    Point {
        v: v.to_vec(),
        tangent: tangent.to_vec(),
        amplitude: Complex64::new(v[0], 0.0),
        slope: Complex64::new(tangent[0], 0.0),
        residual: 0.0,
        iterations: 0,
        step: 0.0,
        stalled: false,
        positive: true,
    }
}

/// The prediction by the circle of the newest points.
fn by_circle<'p>(here: &'p Point, before: &'p [Point], metric: Metric) -> Predictor<'p> {
    let own = (here, before.first());
    let circle = CurvatureCircle::new(own.0, own.1, metric);
    let points = core::iter::once(here).chain(before);
    let places: Vec<_> = points.map(|point| circle.place(own, point)).collect();
    Predictor::by_circle(here, before, &places, metric)
}

fn on_circle(angle: f64) -> Point {
    let (sine, cosine) = angle.sin_cos();
    point([2.0 * cosine, 2.0 * sine, 0.0], [-3.0 * sine, 3.0 * cosine, 0.0])
}

/// A curve in space whose curvature varies.
fn on_curve(t: f64) -> Point {
    point(
        [t.sin(), 0.7 * t, 0.3 * (2.0 * t).cos()],
        [t.cos(), 0.7, -0.6 * (2.0 * t).sin()],
    )
}

/// Distance between the curve and its prediction one step beyond 0.4, from points at uneven distances.
fn error(curve: fn(f64) -> Point, step: f64, count: usize) -> f64 {
    let metric = Metric { u: 1.0, p: 1.0 };
    let here = curve(0.4);
    let before = [1.0, 2.2, 3.1, 4.0].map(|steps| curve(0.4 - steps * step));
    let predictor = by_circle(&here, &before, metric);
    assert_eq!(predictor.count(), MOST_POINTS);
    let mut v = [0.0; 3];
    let weights = predictor.weights(step, count);
    predictor.place(&weights, &mut v);
    assert!((predictor.amplitude(&weights).re - v[0]).abs() < 1e-14);
    // The nearest point of the curve, by Newton's method.
    let mut t = 0.4;
    for _ in 0..50 {
        let at = curve(t);
        let (mut along, mut square) = (0.0, 0.0);
        for ((x, at), tangent) in v.iter().zip(&at.v).zip(&at.tangent) {
            along += (x - at) * tangent;
            square += tangent * tangent;
        }
        t += along / square;
    }
    let nearest = curve(t).v;
    (0..3).map(|i| (v[i] - nearest[i]).powi(2)).sum::<f64>().sqrt()
}

#[test]
fn curves_are_predicted_with_the_order_of_the_points() {
    // Steps so long that the errors are far above rounding, which more points of a circle would not leave.
    let curves: [fn(f64) -> Point; 2] = [on_circle, on_curve];
    let steps = [&[0.05, 0.1, 0.1, 0.2, 0.2][..], &[0.02, 0.02, 0.03, 0.03, 0.05]];
    for (curve, steps) in curves.into_iter().zip(steps) {
        for (count, &step) in (1..).zip(steps) {
            let order = (error(curve, step, count) / error(curve, 0.5 * step, count)).log2();
            assert!(order > 2.0 * count as f64 - 0.8, "{order} with {count} points");
        }
    }
}

#[test]
fn a_circle_is_predicted_along_its_arc() {
    let metric = Metric { u: 1.0, p: 1.0 };
    let before = [on_circle(0.2), on_circle(-0.1)];
    let here = on_circle(0.4);
    let (mut v, truth) = ([0.0; 3], on_circle(0.5).v);
    for predictor in [
        by_circle(&here, &before, metric),
        Predictor::by_arcs(&here, &before, metric),
    ] {
        for (place, angle) in predictor.places[..3].iter().zip([0.0, -0.2, -0.5]) {
            assert!((place - 2.0 * angle).abs() < 1e-14, "{place}");
        }
        predictor.place(&predictor.weights(0.2, 3), &mut v);
        assert!((v[0] - truth[0]).hypot(v[1] - truth[1]) < 2e-6);
    }
}

#[test]
fn coinciding_points_count_once_and_those_of_another_direction_not() {
    let metric = Metric { u: 1.0, p: 1.0 };
    let here = on_circle(1.0);
    let mut reversed = on_circle(0.9);
    reversed.reverse();
    for before in [on_circle(1.0), reversed, on_circle(1.2)] {
        assert_eq!(by_circle(&here, &[before], metric).count(), 1);
    }
    let same = [on_circle(1.0)];
    for before in [&[][..], &same] {
        assert_eq!(by_circle(&here, before, metric).count(), 1);
        assert_eq!(Predictor::by_arcs(&here, before, metric).count(), 1);
    }
}
