//! Two equal masses that nothing couples have two modes of one frequency, and nonlinear modes in any phase to each other: solutions
//! lie in a continuum. Each mass then vibrates as it would alone, whose mode is an isolated one.

use crate::common::mode_cases::{follow, only};
use crate::common::models::{dense, diagonal};
use crate::common::{amplitude_range, harmonics};
use hbvib::{Contact, ModeChoice, ModeOptions, Model, SolverOptions};
use num_complex::Complex64;

/// Masses on springs of their own; those behind the first `sliders` have a spring more in place of their slider.
fn masses(n: usize, sliders: usize, (k, kt, limit): (f64, f64, f64)) -> Model {
    let springs: Vec<f64> = (0..n).map(|i| if i < sliders { k } else { k + kt }).collect();
    dense(&diagonal(&vec![1.0; n]), &diagonal(&springs))
        .contacts((0..sliders).map(|i| Contact::jenkins(i, None, kt, 1.0, limit)))
        .build()
}

/// Amplitudes asked for, over that at which a mass alone begins to slip.
const TIMES: [f64; 5] = [0.5, 1.1, 1.7, 2.9, 5.8];

const FAMILY: [(f64, f64); 4] = [(1.0, 1.0), (1.0, 0.3), (2.0, 3.0), (1.0, 10.0)];
const LIMITS: [f64; 6] = [1.0, 0.8125, 0.7, 0.5, 0.31, 1.3];

/// A mode of these masses with its frequencies and damping ratios at the amplitudes, those of one mass times `factor`.
fn mode(
    model: &Model,
    shape: Option<&[Complex64]>,
    solver: &SolverOptions,
    onset: f64,
    factor: f64,
) -> Vec<(f64, f64)> {
    let at = TIMES.map(|t| (t * onset * factor).log10());
    let range = ModeOptions {
        choice: shape.map_or(ModeChoice::Index(0), ModeChoice::Shape),
        at: &at,
        ..amplitude_range((0.1 * onset * factor).log10(), (6.0 * onset * factor).log10())
    };
    let branch = follow(model, solver, &range);
    (0..at.len())
        .map(|i| {
            let (omega, damping, _) = only(&branch, i);
            (omega, damping)
        })
        .collect()
}

#[test]
fn each_of_two_equal_masses_vibrates_as_it_would_alone() {
    let (one, i) = (Complex64::ONE, Complex64::I);
    let root = 2f64.sqrt();
    let zero = Complex64::ZERO;
    let shapes: [(Option<[Complex64; 2]>, f64); 6] = [
        // By default both move, a quarter of a period apart.
        (None, root),
        (Some([one, zero]), 1.0),
        (Some([zero, one]), 1.0),
        (Some([one, one]), root),
        (Some([one, -one]), root),
        (Some([one, i]), root),
    ];
    for ((k, kt), limit) in FAMILY.into_iter().flat_map(|f| LIMITS.map(|limit| (f, limit))) {
        let numbers = (k, kt, limit);
        let (alone, pair) = (masses(1, 1, numbers), masses(2, 2, numbers));
        let expected = mode(&alone, None, &harmonics(9), limit / kt, 1.0);
        for (shape, factor) in &shapes {
            let found = mode(
                &pair,
                shape.as_ref().map(|s| &s[..]),
                &harmonics(9),
                limit / kt,
                *factor,
            );
            for (a, b) in found.iter().zip(&expected) {
                let off = (a.0 / b.0 - 1.0).abs().max((a.1 - b.1).abs());
                assert!(off < 1e-8, "{numbers:?}, {shape:?}: {a:?} {b:?}");
            }
            // With harmonics that a tolerance chooses.
            mode(
                &pair,
                shape.as_ref().map(|s| &s[..]),
                &SolverOptions::default(),
                limit / kt,
                *factor,
            );
        }
    }
}

/// The mass without a slider comes to rest where the other one slips.
#[test]
fn a_mass_that_slips_leaves_its_equal_behind() {
    let shapes: [Option<[Complex64; 2]>; 3] = [None, Some([1.0.into(), 0.0.into()]), Some([1.0.into(), 1.0.into()])];
    for ((k, kt), limit) in FAMILY.into_iter().flat_map(|f| LIMITS.map(|limit| (f, limit))) {
        let numbers = (k, kt, limit);
        let expected = mode(&masses(1, 1, numbers), None, &harmonics(9), limit / kt, 1.0);
        for shape in &shapes {
            let shape = shape.as_ref().map(|s| &s[..]);
            let found = mode(&masses(2, 1, numbers), shape, &harmonics(9), limit / kt, 1.0);
            // The last of the amplitudes lie beyond the onset of slip of each shape.
            for (a, b) in found.iter().zip(&expected).skip(2) {
                let off = (a.0 / b.0 - 1.0).abs().max((a.1 - b.1).abs());
                assert!(off < 1e-8, "{numbers:?}, {shape:?}: {a:?} {b:?}");
            }
        }
    }
}
