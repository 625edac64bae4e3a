//! Colours of the curves of a chart.

use plotters::style::{BLACK, RGBColor};

use super::{Series, Style};

/// Colours of Okabe and Ito, without those too pale for a thin line on white.
const DISTINCT: [RGBColor; 6] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(230, 159, 0),
    RGBColor(86, 180, 233),
];

/// Anchors of a map from dark to light, which also shows the order to the colour-blind.
const SEQUENTIAL: [(f64, f64, f64); 5] = [
    (8.0, 8.0, 80.0),
    (92.0, 10.0, 165.0),
    (178.0, 42.0, 140.0),
    (228.0, 100.0, 90.0),
    (245.0, 170.0, 45.0),
];

/// The distinct labels of the series in order, each with its colour.
pub(super) fn legend(series: &[Series]) -> Vec<(&str, RGBColor)> {
    let mut labels: Vec<&str> = Vec::new();
    for one in series {
        if !labels.contains(&one.label.as_str()) {
            labels.push(&one.label);
        }
    }
    let is_dashed = |label: &str| {
        let mut same = series.iter().filter(|s| s.label == label);
        same.all(|s| matches!(s.style, Style::Dashed | Style::Rings))
    };
    let dashed: Vec<&str> = labels.iter().copied().filter(|l| is_dashed(l)).collect();
    let reference = dashed.first().filter(|_| dashed.len() == 1 && labels.len() > 1);
    let count = labels.len() - usize::from(reference.is_some());
    let mut used = 0;
    let mut color = |label: &str| {
        if reference.is_some_and(|r| *r == label) {
            return BLACK;
        }
        used += 1;
        match DISTINCT.get(used - 1) {
            Some(color) if count <= DISTINCT.len() => *color,
            _ => sequential(used - 1, count),
        }
    };
    labels.into_iter().map(|l| (l, color(l))).collect()
}

/// The colour number `index` of `count` along the sequential map.
#[allow(
    clippy::cast_precision_loss,
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss
)]
fn sequential(index: usize, count: usize) -> RGBColor {
    let at = index as f64 / (count - 1).max(1) as f64 * (SEQUENTIAL.len() - 1) as f64;
    let from = (at as usize).min(SEQUENTIAL.len() - 2);
    let (a, b, part) = (SEQUENTIAL[from], SEQUENTIAL[from + 1], at - from as f64);
    let mix = |u: f64, v: f64| (u + part * (v - u)).round() as u8;
    RGBColor(mix(a.0, b.0), mix(a.1, b.1), mix(a.2, b.2))
}
