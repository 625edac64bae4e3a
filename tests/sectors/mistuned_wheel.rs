//! The whole wheel of a cyclic model, tuned and mistuned: a bladed disk of 24 sectors with a friction ring. Against the
//! wave of the sector, another harmonic balance of the wheel, its integration in time, and clamped blades.

use crate::common::models::Structure;
use crate::common::refusal::refused;
use crate::common::{all_harmonics, at_dof, harmonics, omega_range, relative_gap, slip, solve_at, sweep};
use hbvib::internals::Block;
use hbvib::{
    BladeProperty, Contact, ContactState, ForcedOptions, Hooks, MatrixKind, MatrixView, Mistuning, Model, Response,
    SolverOptions, Spring, Status, forced_response, wheel_peaks,
};
use num_complex::Complex64;
use std::f64::consts::TAU;

const N: usize = 24;
const BLADE: f64 = 2e6;
const PRELOAD: f64 = 488.545_417_853_923_3;

/// Blade tip, blade root, disk and ring.
fn sector(force: f64) -> Model {
    let (root, disk, ground, ring) = (1e6, 5e7, 6e5, 2e7);
    let mut k = [0.0; 16];
    let mut spring = |a: usize, b: usize, v: f64| {
        for (i, j, sign) in [(a, a, 1.0), (b, b, 1.0), (a, b, -1.0), (b, a, -1.0)] {
            k[4 * i + j] += sign * v;
        }
    };
    spring(0, 1, BLADE);
    spring(1, 2, root);
    k[10] += ground + 2.0 * disk;
    k[15] += 2.0 * ring;
    let diagonal = |d: [f64; 4]| -> Vec<f64> { (0..16).map(|i| if i % 5 == 0 { d[i / 5] } else { 0.0 }).collect() };
    let mass = diagonal([0.2, 0.3, 1.2, 0.03]);
    let next = diagonal([0.0, 0.0, -disk, -ring]);
    let mut model = Structure::cyclic(4, N)
        .mass(&mass)
        .stiffness(&k)
        .next(MatrixKind::Stiffness, &next)
        .rayleigh(0.0, 1.5e-6)
        .wave(2)
        .contact(Contact::jenkins(2, Some(3), 5e7, 0.3, PRELOAD))
        .build();
    for dof in [0, 1] {
        model.add_force(dof, 1, force.into()).unwrap();
    }
    model
}

const SEED_2: [f64; N] = [
    0.001_887, -0.006_683, -0.005_363, -0.029_783, 0.021_278, 0.013_386, -0.004_307, 0.008_927, 0.002_996, -0.007_057,
    0.011_38, -0.004_128, -0.004_348, -0.009_926, 0.005_088, -0.001_584, 0.006_175, -0.0077, 0.001_137, -0.011_132,
    0.009_741, 0.001_874, 0.003_59, 0.004_553,
];

fn blades(delta: &[f64], force: f64) -> Model {
    let sector = sector(force);
    let mut wheel = sector.wheel().unwrap();
    let stiffness = Mistuning::Blade(BladeProperty::Stiffness, &[0]);
    wheel.mistune(&sector, &stiffness, delta).unwrap();
    wheel
}

/// Motions of the sectors one after another, in each harmonic, from the wave.
fn around(sector: &Model, harmonics: usize, x: &[Complex64]) -> Vec<Complex64> {
    let mut all = Vec::new();
    for h in 0..=harmonics {
        for s in 0..N {
            let lag = sector.structure().phase(h, s as i64);
            all.extend(x[4 * h..4 * h + 4].iter().map(|x| lag * x));
        }
    }
    all
}

#[test]
fn a_wheel_without_mistuning_moves_as_the_wave_of_its_sector() {
    for order in [2, -5] {
        let mut sector = sector(30.0);
        sector.set_wave(order);
        sector.add_force(0, 3, Complex64::new(0.4, 0.3)).unwrap();
        // Between the blades of neighbours, over the end of the ring of sectors too.
        let between = Contact {
            sector_offset: -1,
            ..Contact::jenkins(0, Some(1), 2e5, 0.3, 50.0)
        };
        sector.add_contact(&between).unwrap();
        let spring = Spring {
            dof_a: Some(0),
            dof_b: Some(0),
            sector_offset: 1,
            stiffness: 1e4,
        };
        sector.add_spring(&spring).unwrap();
        let wheel = blades_of(&sector, &[0.0; N]);
        let omega = TAU * 209.0;
        let (wave, whole) = (
            solve_at(&sector, &harmonics(5), omega),
            solve_at(&wheel, &harmonics(5), omega),
        );
        let gap = relative_gap(&all_harmonics(&whole, 0), &around(&sector, 5, &all_harmonics(&wave, 0)));
        println!("EO {order}: slip {:.3}, gap {gap:.1e}", slip(&wave, 0));
        assert!(slip(&wave, 0) > 0.0 && gap < 1e-12, "{gap}");
    }
}

fn blades_of(sector: &Model, delta: &[f64]) -> Model {
    let mut wheel = sector.wheel().unwrap();
    for what in [
        Mistuning::Blade(BladeProperty::Frequency, &[0, 1]),
        Mistuning::Blade(BladeProperty::Mass, &[0]),
        Mistuning::Blade(BladeProperty::Damping, &[0]),
        Mistuning::Preload(None),
        Mistuning::Force,
    ] {
        wheel.mistune(sector, &what, delta).unwrap();
    }
    wheel
}

#[test]
fn a_pattern_shifted_by_sectors_shifts_the_blades() {
    const SHIFT: usize = 7;
    let sector = sector(5.0);
    let mut shifted = SEED_2;
    shifted.rotate_right(SHIFT);
    let omega = TAU * 208.9;
    let [x, y] = [SEED_2, shifted].map(|delta| {
        let branch = solve_at(&blades_of(&sector, &delta), &harmonics(3), omega);
        assert!(slip(&branch, 0) > 0.0);
        all_harmonics(&branch, 0)
    });
    // The shifted wheel is the same one that starts later.
    let mut expected = Vec::new();
    for h in 0..=3 {
        for s in 0..N {
            let from = (s + N - SHIFT) % N;
            let lag = sector.structure().phase(h, SHIFT as i64);
            expected.extend((0..4).map(|i| lag * x[4 * (N * h + from) + i]));
        }
    }
    let gap = relative_gap(&y, &expected);
    println!("shifted: {gap:.1e}");
    assert!(gap < 1e-11, "{gap}");
}

/// Blade 3 is the largest of this pattern; peaks of harmonics 1 and 3 by another harmonic balance of 24 contacts.
#[test]
fn the_largest_peak_of_a_mistuned_wheel_is_that_of_another_harmonic_balance() {
    for (force, frequency, amplitude) in [
        (1.0, 209.955_323_852_347_56, 8.280_100_222_407_677e-4),
        (5.0, 208.825_082_002_718_94, 1.501_565_473_174_983_4e-3),
    ] {
        let solver = at_dof(12, harmonics(3));
        let branch = sweep(
            &blades(&SEED_2, force),
            &solver,
            TAU * (frequency - 0.4),
            TAU * (frequency + 0.4),
            &[],
        );
        let peaks = branch.peaks();
        let peak = peaks.iter().max_by(|a, b| a.amplitude.total_cmp(&b.amplitude)).unwrap();
        let gap = (peak.amplitude / amplitude - 1.0).abs();
        let off = (peak.omega / (TAU * frequency) - 1.0).abs();
        println!("{force} N: amplitude {gap:.1e}, frequency {off:.1e}");
        assert!(gap < 1e-9 && off < 1e-8, "{gap} {off}");
    }
}

/// All blades in one call: the largest is blade 3, with the same peak; the tuned wheel has equal ones.
#[test]
fn all_blades_have_their_peaks_and_the_largest_is_that_of_another_harmonic_balance() {
    let amplitude = 8.280_100_222_407_677e-4;
    let sector = sector(1.0);
    let range = omega_range(TAU * 208.5, TAU * 211.5);
    let blade = Response {
        dofs: &[0],
        ..Response::default()
    };
    let peaks =
        |wheel: &Model| wheel_peaks(wheel, &sector, &blade, &harmonics(3), &range, &mut Hooks::default()).unwrap();
    let found = peaks(&blades(&SEED_2, 1.0));
    let gap = (found.blades[3].amplitude / amplitude - 1.0).abs();
    println!("{gap:.1e}, amplification {}", found.amplification());
    assert!(found.largest == Some(3) && gap < 1e-9);
    // That of wheel_worst.json.
    assert!((found.tuned.amplitude / 7.574_043_561_303_725e-4 - 1.0).abs() < 1e-9);
    let tuned = peaks(&sector.wheel().unwrap());
    for one in &tuned.blades {
        assert!((one.amplitude / tuned.tuned.amplitude - 1.0).abs() < 1e-9);
    }
    let other = Model::new(5).unwrap();
    let refusal = wheel_peaks(&other, &sector, &blade, &harmonics(3), &range, &mut Hooks::default());
    refused(refusal, Status::Dimension, &["needs the wheel"]);
}

#[test]
fn a_pattern_of_frequencies_moves_those_of_clamped_blades_by_its_factors() {
    let sector = sector(1.0);
    let mut wheel = sector.wheel().unwrap();
    let frequency = Mistuning::Blade(BladeProperty::Frequency, &[0, 1]);
    wheel.mistune(&sector, &frequency, &SEED_2).unwrap();
    let others: Vec<usize> = (0..4 * N).filter(|dof| dof % 4 > 1).collect();
    // Contacts between fixed sides are refused.
    let mut bare = Model::new(4 * N).unwrap();
    for kind in [MatrixKind::Mass, MatrixKind::Stiffness] {
        let mut all = vec![0.0; 16 * N * N];
        let a = wheel.block(kind, Block::Own).unwrap().unwrap();
        for j in 0..4 * N {
            a.column(j).for_each(|(i, v)| all[4 * N * j + i] = v.re);
        }
        bare.set_matrix(kind, &MatrixView::dense(4 * N, &all)).unwrap();
    }
    bare.fix(&others).unwrap();
    let found = bare.linear_modes(0, ContactState::Free).unwrap().omega;
    // Both frequencies of a clamped blade in closed form: masses 0.2 and 0.3 on springs of 2e6 and 1e6.
    let (a, b, c) = (BLADE / 0.2, (BLADE + 1e6) / 0.3, BLADE * BLADE / 0.06);
    let split = ((a - b) * (a - b) / 4.0 + c).sqrt();
    let mut expected: Vec<f64> = [-split, split]
        .into_iter()
        .flat_map(|split| SEED_2.map(|d| (1.0 + d) * (f64::midpoint(a, b) + split).sqrt()))
        .collect();
    expected.sort_by(f64::total_cmp);
    assert_eq!(found.len(), expected.len());
    for (found, expected) in found.iter().zip(&expected) {
        assert!((found / expected - 1.0).abs() < 1e-11, "{found} {expected}");
    }
}

#[test]
fn a_blade_has_the_stiffness_of_its_spring_and_its_damping() {
    let sector = sector(5.0);
    let direction = |v: f64| {
        let mut d = [0.0; 16];
        (d[0], d[1], d[4], d[5]) = (v, -v, -v, v);
        d
    };
    let omega = TAU * 209.1;
    for (property, kind, value) in [
        (BladeProperty::Stiffness, MatrixKind::Stiffness, BLADE),
        (BladeProperty::Damping, MatrixKind::Damping, 1.5e-6 * BLADE),
    ] {
        let scaled = SEED_2.map(|d| 10.0 * d);
        let matrix = direction(value);
        let view = MatrixView::dense(4, &matrix);
        let [x, y] = [Mistuning::Blade(property, &[0]), Mistuning::Matrix(kind, &view)].map(|what| {
            let mut wheel = sector.wheel().unwrap();
            wheel.mistune(&sector, &what, &scaled).unwrap();
            all_harmonics(&solve_at(&wheel, &harmonics(3), omega), 0)
        });
        let tuned = all_harmonics(&solve_at(&sector.wheel().unwrap(), &harmonics(3), omega), 0);
        assert!(relative_gap(&x, &y) < 1e-11 && relative_gap(&x, &tuned) > 1e-4);
    }
}

#[test]
fn wheels_that_cannot_be_made_are_refused_by_name() {
    let sector = sector(1.0);
    refused(
        Model::new(2).unwrap().wheel(),
        Status::Unsupported,
        &["plain structure"],
    );
    let mut wheel = sector.wheel().unwrap();
    let mut refusal = |what: Mistuning<'_>, delta: &[f64], status, words: &[&str]| {
        refused(wheel.mistune(&sector, &what, delta), status, words);
    };
    let zero = [0.0; N];
    refusal(Mistuning::Force, &zero[1..], Status::Dimension, &["23", "24"]);
    refusal(Mistuning::Force, &[f64::NAN; N], Status::NotFinite, &["delta[0]"]);
    refusal(Mistuning::Preload(Some(1)), &zero, Status::Index, &["contact id = 1"]);
    refusal(Mistuning::Preload(None), &[-2.0; N], Status::Argument, &["preload"]);
    let stiffness = BladeProperty::Stiffness;
    refusal(
        Mistuning::Blade(stiffness, &[0, 0]),
        &zero,
        Status::Argument,
        &["dofs[1] = 0", "twice"],
    );
    refusal(
        Mistuning::Blade(stiffness, &[4]),
        &zero,
        Status::Index,
        &["dofs[0] = 4"],
    );
    refusal(Mistuning::Blade(stiffness, &[]), &zero, Status::Argument, &["blade"]);
    // A per cent in place of a share.
    let mut per_cent = zero;
    per_cent[3] = -2.0;
    for property in [
        BladeProperty::Stiffness,
        BladeProperty::Frequency,
        BladeProperty::Mass,
        BladeProperty::Damping,
    ] {
        let words = &["delta[3] = -2", "at least -1"];
        refusal(Mistuning::Blade(property, &[0]), &per_cent, Status::Argument, words);
    }
}

/// All blades of a pattern of 2 % at 208.8 Hz under 5 N, integrated in time from event to event.
#[test]
fn all_blades_of_a_mistuned_wheel_are_those_of_time_integration_within_the_tolerance() {
    let delta = [
        -0.001_873, 0.029_291, 0.018_418, 0.004_45, -0.026_29, -0.035_543, 0.0225, 0.015_718, -0.037_078, 0.011_988,
        -0.044_441, 0.018_957, 0.013_438, 0.018_359, -0.008_012, 0.013_208, -0.004_63, -0.026_145, 0.010_543, 0.009_25,
        0.003_484, 0.005_044, -0.011_094, 0.000_459,
    ];
    let wheel = blades(&delta, 5.0);
    let tips: Vec<[usize; 1]> = (0..N).map(|s| [4 * s]).collect();
    let responses: Vec<Response<'_>> = tips
        .iter()
        .map(|dofs| Response {
            dofs,
            ..Response::default()
        })
        .collect();
    let solver = SolverOptions {
        tolerance: 1e-3,
        ..SolverOptions::default()
    };
    let range = ForcedOptions {
        responses: &responses,
        ..omega_range(TAU * 208.8, TAU * 208.8)
    };
    let branch = forced_response(&wheel, &solver, &range, &mut Hooks::default()).unwrap();
    let x = all_harmonics(&branch, 0);
    for (blade, re, im) in TIME {
        let expected = Complex64::new(re, im);
        let gap = (x[4 * N + 4 * blade] - expected).norm() / expected.norm();
        println!("blade {blade}: {gap:.1e}, H = {}", branch.harmonics());
        assert!(gap < 1e-3, "{gap}");
    }
}

/// Blade and its first harmonic.
const TIME: [(usize, f64, f64); 24] = [
    (0, 3.049_363_247_951e-5, -1.457_474_430_525e-3),
    (1, -5.784_904_963_373e-4, -1.243_764_125_058e-3),
    (2, -1.050_661_976_127e-3, -7.787_673_703_369e-4),
    (3, -1.263_944_064_232e-3, -9.047_209_090_536e-5),
    (4, -1.177_080_012_665e-3, 6.728_721_958_066e-4),
    (5, -7.153_593_964_756e-4, 1.274_196_317_248e-3),
    (6, -3.586_373_891_929e-5, 1.378_336_625_401e-3),
    (7, 6.002_278_675_287e-4, 1.242_631_347_290e-3),
    (8, 1.167_797_908_083e-3, 8.270_295_585_785e-4),
    (9, 1.250_212_870_746e-3, 6.877_437_479_490e-5),
    (10, 1.194_475_673_982e-3, -7.140_608_160_831e-4),
    (11, 6.234_104_195_233e-4, -1.175_116_625_655e-3),
    (12, 2.666_533_310_712e-6, -1.411_372_399_861e-3),
    (13, -6.176_207_031_450e-4, -1.256_739_336_628e-3),
    (14, -1.114_970_595_672e-3, -8.086_891_646_922e-4),
    (15, -1.244_279_958_851e-3, -8.855_444_174_824e-5),
    (16, -1.113_403_834_292e-3, 6.517_733_921_490e-4),
    (17, -6.753_344_782_805e-4, 1.264_070_905_428e-3),
    (18, -1.573_128_988_533e-5, 1.421_356_898_899e-3),
    (19, 6.128_771_717_078e-4, 1.273_030_294_488e-3),
    (20, 1.084_415_594_766e-3, 7.873_063_274_544e-4),
    (21, 1.258_102_189_244e-3, 7.879_461_321_484e-5),
    (22, 1.130_544_219_227e-3, -6.686_115_980_723e-4),
    (23, 6.577_333_762_156e-4, -1.216_709_886_522e-3),
];
