//! A nonlinear mode of one sector equals that of the full wheel, and does not depend on the sense of
//! the wave where the sector is symmetric. Same-H solutions of the same physics.

use crate::common::mode_cases::{damped, damping, delta, follow, only};
use crate::common::{
    self, B2, BASE, Blisk, NDOF, SECTORS, all_harmonics, amplitude_range, harmonics, phase, relative_gap,
};
use hbvib::internals::Multiple;
use hbvib::{Branch, DampingForm, ModeChoice, ModeOptions, Model};
use num_complex::Complex64;

/// Amplitudes of the sector at which both are compared, over that of the onset.
const TIMES: [f64; 7] = [0.5, 1.1, 2.0, 10.0, 100.0, 1e3, 1e4];

fn full_wheel(case: &Blisk, beta: f64) -> Model {
    let mut model = case.full_wheel();
    model.set_rayleigh(0.0, beta).unwrap();
    model
}

/// log₁₀ of the sector's modal amplitude at which slip begins.
fn onset(case: &Blisk, family: usize) -> f64 {
    let start = case.sector().select_mode(ModeChoice::Index(family)).unwrap();
    (delta(case) / (start.shape[common::D] - start.shape[common::R]).norm()).log10()
}

/// Solutions at TIMES the onset, whose log₁₀ is given.
fn run(model: &Model, h: usize, choice: ModeChoice, onset: f64, form: DampingForm) -> Branch {
    let at = TIMES.map(|t| onset + t.log10());
    let range = ModeOptions {
        choice,
        at: &at,
        damping_form: form,
        reference_dof: Some(B2),
        ..amplitude_range(onset - 1.0, onset + 4.5)
    };
    follow(model, &harmonics(h), &range)
}

/// Harmonics of the whole wheel from those of its first sector.
fn spread(x: &[Complex64], engine_order: i64) -> Vec<Complex64> {
    let mut full_wheel = Vec::new();
    for (h, block) in x.chunks_exact(NDOF).enumerate() {
        for s in 0..SECTORS {
            full_wheel.extend(block.iter().map(|z| z * phase(h, engine_order, s, SECTORS)));
        }
    }
    full_wheel
}

/// Largest errors of ω, of D relative to its maximum and of the harmonics.
fn compare(sector: &Branch, full_wheel: &Branch, engine_order: i64) -> (f64, f64, f64) {
    let most = damping(sector).iter().fold(0.0_f64, |m, &d| m.max(d));
    let mut worst = (0.0_f64, 0.0_f64, 0.0_f64);
    for (i, times) in TIMES.iter().enumerate() {
        let ((w, d, p), (ww, dw, pw)) = (only(sector, i), only(full_wheel, i));
        let errors = (
            (ww / w - 1.0).abs(),
            (dw - d).abs() / most,
            relative_gap(
                &all_harmonics(full_wheel, pw),
                &spread(&all_harmonics(sector, p), engine_order),
            ),
        );
        println!(
            "  {times} times the onset: ω {:.1e}, D {:.1e}, x {:.1e}",
            errors.0, errors.1, errors.2
        );
        worst = (worst.0.max(errors.0), worst.1.max(errors.1), worst.2.max(errors.2));
    }
    worst
}

/// log₁₀ of the amplitude of the wheel over that of the sector.
fn all_sectors() -> f64 {
    0.5 * (SECTORS as f64).log10()
}

#[test]
fn at_nodal_diameter_0_the_sector_equals_the_wheel() {
    let case = Blisk {
        engine_order: 0,
        ..BASE
    };
    for form in [DampingForm::Mass, DampingForm::Stiffness] {
        for (family, beta, h) in [(0, 0.0, 3), (1, common::BETA, 3), (0, 0.0, 1)] {
            let onset = onset(&case, family);
            let sector = run(&damped(&case, beta), h, ModeChoice::Index(family), onset, form);
            // All sectors move alike: the mode of the wheel is named by its frequency.
            let near = ModeChoice::Near(sector.mode().unwrap().omega);
            let full_wheel = run(&full_wheel(&case, beta), h, near, onset + all_sectors(), form);
            assert_eq!(full_wheel.mode().unwrap().multiplicity, 1);
            let worst = compare(&sector, &full_wheel, 0);
            println!("{form:?}, family {family}, β = {beta:e}, H = {h}: {worst:?}");
            assert!(worst.0 < 1e-9 && worst.1 < 1e-9 && worst.2 < 1e-9);
        }
    }
}

#[test]
fn at_nodal_diameter_2_the_double_mode_of_the_wheel_is_followed_as_the_travelling_wave() {
    for (beta, h) in [(0.0, 1), (common::BETA, 1), (0.0, 3)] {
        let onset = onset(&BASE, 0);
        let sector = run(&damped(&BASE, beta), h, ModeChoice::Index(0), onset, DampingForm::Mass);
        let near = ModeChoice::Near(sector.mode().unwrap().omega);
        let full_wheel = run(
            &full_wheel(&BASE, beta),
            h,
            near,
            onset + all_sectors(),
            DampingForm::Mass,
        );
        let info = full_wheel.mode().unwrap();
        assert_eq!((info.multiplicity, info.multiple), (2, Multiple::TravellingWave));
        let worst = compare(&sector, &full_wheel, 2);
        println!("β = {beta:e}, H = {h}: {worst:?}");
        assert!(worst.0 < 1e-9 && worst.1 < 1e-9 && worst.2 < 1e-7);
    }
}

#[test]
fn a_symmetric_sector_has_the_same_mode_for_waves_of_either_sense() {
    for (forward, backward) in [(2, 22), (2, -2), (2, 26), (1, 23), (11, 13)] {
        let run = |engine_order| {
            let case = Blisk { engine_order, ..BASE };
            let onset = onset(&case, 0);
            run(&damped(&case, 0.0), 7, ModeChoice::Index(0), onset, DampingForm::Mass)
        };
        let (a, b) = (run(forward), run(backward));
        let moduli = |x: Vec<Complex64>| -> Vec<Complex64> { x.iter().map(|z| z.norm().into()).collect() };
        let mut worst = (0.0_f64, 0.0_f64, 0.0_f64);
        for i in 0..TIMES.len() {
            let ((wa, da, pa), (wb, db, pb)) = (only(&a, i), only(&b, i));
            worst.0 = worst.0.max((wb / wa - 1.0).abs());
            worst.1 = worst.1.max((db - da).abs());
            let gap = relative_gap(&moduli(all_harmonics(&b, pb)), &moduli(all_harmonics(&a, pa)));
            worst.2 = worst.2.max(gap);
        }
        println!("EO {forward} and {backward}: {worst:?}");
        assert!(worst.0 < 1e-11 && worst.1 < 1e-11 && worst.2 < 1e-9);
    }
}

#[test]
fn the_diameter_asked_for_is_the_forward_wave_whatever_the_model_s_engine_order() {
    let case = |engine_order| Blisk { engine_order, ..BASE };
    for diameter in [0, 2, 7, 12] {
        let onset = onset(&case(diameter), 0);
        let own = run(
            &damped(&case(diameter), 0.0),
            5,
            ModeChoice::Index(0),
            onset,
            DampingForm::Mass,
        );
        let range = ModeOptions {
            diameter: Some(diameter),
            reference_dof: Some(B2),
            ..amplitude_range(onset - 1.0, onset + 4.5)
        };
        let asked = follow(&damped(&case(5), 0.0), &harmonics(5), &range);
        assert!(damping(&asked).iter().any(|&d| d > 1e-5));
        assert!(own.omega() == asked.omega() && damping(&own) == damping(&asked));
    }
}
