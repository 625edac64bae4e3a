//! The error that a synthesised resonance tells, against the peak of a computed sweep, for pressed and unpressed
//! contacts: a resonance without a flag is right within 1 %.

use crate::common::mode_cases::follow;
use crate::common::models::{coupled, dense};
use crate::common::{amplitude_range, at_dof, harmonics, sweep};
use hbvib::{
    Constant, Contact, Hooks, MatrixKind, ModeChoice, ModeOptions, Model, SolverOptions, SynthesisOptions,
    SynthesisPoint, nonlinear_mode, synthesise,
};

/// Three masses in a chain under a force on one of them.
fn chain(beta: f64, contacts: &[Contact], constant: f64, (dof, force): (usize, f64)) -> Model {
    const STIFFNESS: [f64; 9] = [2.0, -0.7, 0.0, -0.7, 2.6, -0.5, 0.0, -0.5, 3.1];
    let mass = [1.0, 0.0, 0.0, 0.0, 1.3, 0.0, 0.0, 0.0, 0.8];
    dense(&mass, &STIFFNESS)
        .rayleigh(0.0, beta)
        .contacts(contacts)
        .force(1, 0, constant)
        .force(dof, 1, force)
        .build()
}

fn cases() -> Vec<(&'static str, Vec<Contact>, f64)> {
    let stop = |preload, gap| {
        Contact::unilateral(Some(1), None, 1.5, gap)
            .with(Constant::Preload, preload)
            .unwrap()
    };
    let rubbing = Contact::friction_2d([Some(0), Some(1)], [None; 2], (0.8, 0.9), 0.4, 0.6);
    vec![
        ("stop with a gap", vec![stop(0.0, 0.3)], 0.0),
        ("pressed stop", vec![stop(0.3, 0.0)], 0.0),
        ("pressed by a force", vec![stop(0.0, 0.1)], -0.6),
        ("Jenkins", vec![Contact::jenkins(0, None, 0.8, 0.4, 0.6)], 0.0),
        (
            "Jenkins under a force",
            vec![Contact::jenkins(1, None, 0.8, 0.4, 0.6)],
            0.1,
        ),
        ("pressed friction", vec![rubbing.clone()], 0.0),
        ("pressed friction and a stop", vec![rubbing, stop(0.0, 0.4)], -0.1),
        (
            "cubic spring under a force",
            vec![Contact::cubic(1, None, 0.0, 0.2)],
            0.5,
        ),
    ]
}

/// Amplitude of the computed peak nearest to a resonance. A curve that hangs over has its peak on a branch that begins on
/// the far side of the linear resonance.
fn computed_peak(model: &Model, solver: &SolverOptions, at: &SynthesisPoint, linear: f64) -> Option<f64> {
    let width = 3.0 * at.damping_ratio * at.omega;
    let (low, high) = (at.omega.min(linear) - width, at.omega.max(linear) + width);
    let ranges = [
        (at.omega - width, at.omega + width),
        (0.8 * low, high),
        (1.2 * high, low),
    ];
    for (from, to) in ranges {
        let swept = sweep(model, solver, from, to, &[]);
        let near = swept.peaks().iter().filter(|p| (p.omega - at.omega).abs() < width);
        let nearest = near.min_by(|a, b| (a.omega - at.omega).abs().total_cmp(&(b.omega - at.omega).abs()));
        if let Some(nearest) = nearest {
            return Some(nearest.amplitude);
        }
    }
    None
}

#[test]
fn the_error_of_a_synthesised_resonance_is_that_against_the_computed_peak() {
    let (mut valid, mut flagged, mut worst) = (0, 0, (0.0_f64, 0.0_f64));
    for (name, contacts, constant) in cases() {
        for (beta, force) in [(0.003, 0.02), (0.01, 0.1), (0.05, 0.5)] {
            let model = chain(beta, &contacts, constant, (0, force));
            let range = amplitude_range(-3.0, 1.5);
            let mut errors = Vec::new();
            // The default response degree of freedom is the one that moves most; the forced one is another.
            for response_dof in [None, Some(0), Some(2)] {
                let solver = SolverOptions {
                    response_dof,
                    ..harmonics(5)
                };
                let branch = follow(&model, &solver, &range);
                let found = synthesise(&branch, &model, &SynthesisOptions::default()).unwrap();
                for peak in &found.peaks {
                    let validity = peak.validity;
                    if validity.inaccurate() || validity.another_mode() || validity.internal_resonance() || !peak.rising
                    {
                        flagged += 1;
                        continue;
                    }
                    valid += 1;
                    let sought = at_dof(branch.response_dof(), solver);
                    let computed = computed_peak(&model, &sought, &peak.at, branch.mode().unwrap().omega);
                    let nearest = computed
                        .unwrap_or_else(|| panic!("{name}, β = {beta}, {force}: no peak near {}", peak.at.omega));
                    let error = peak.at.response.norm() / nearest - 1.0;
                    worst.0 = worst.0.max(error.abs());
                    worst.1 = worst.1.max((error - validity.error).abs());
                    errors.push(error.abs());
                }
            }
            println!("{name}, β = {beta}, {force}: {errors:?}");
            if let [default, others @ ..] = &errors[..]
                && others.len() == 2
            {
                let most = others.iter().fold(0.0_f64, |m, e| m.max(*e));
                assert!(
                    *default < 2.0 * most + 1e-4,
                    "{name}: the default degree of freedom has {default:e}"
                );
            }
        }
    }
    println!(
        "{valid} valid, {flagged} flagged: error {:.1e}, told to {:.1e}",
        worst.0, worst.1
    );
    assert!(valid >= 30 && worst.0 < 0.01 && worst.1 < 1e-5);
}

/// Four masses whose dampings make their resonances overlap at the first one, with a slider that sticks: the computed resonance is the
/// nearest one, not that of another mode.
#[test]
fn the_error_of_overlapping_modes_is_that_against_the_nearest_peak() {
    let mass = [0.67, 1.97, 0.99, 1.9];
    let stiffness = [
        [1.61, -1.06, 0.0, 0.0],
        [-1.06, 2.32, -1.26, 0.0],
        [0.0, -1.26, 4.14, -2.88],
        [0.0, 0.0, -2.88, 2.88],
    ]
    .concat();
    let mut compared = 0;
    for loss in [0.03, 0.07, 0.1176, 0.15] {
        let diagonal: Vec<f64> = (0..16).map(|k| if k % 5 == 0 { mass[k / 5] } else { 0.0 }).collect();
        let structural: Vec<f64> = stiffness.iter().map(|k| loss * k).collect();
        let model = dense(&diagonal, &stiffness)
            .set(MatrixKind::Structural, &structural)
            .slider(2, 0.3, 0.3, 1e3)
            .force(1, 1, 1.0)
            .build();
        let solver = at_dof(0, harmonics(1));
        let swept = sweep(&model, &solver, 0.1, 4.0, &[]);
        for mode in 0..3 {
            let range = ModeOptions {
                choice: ModeChoice::Index(mode),
                ..amplitude_range(-1.0, 1.5)
            };
            let branch = follow(&model, &solver, &range);
            let found = synthesise(&branch, &model, &SynthesisOptions::default()).unwrap();
            for peak in &found.peaks {
                let distance = |omega: f64| (omega - peak.at.omega).abs();
                let near = swept
                    .peaks()
                    .iter()
                    .min_by(|a, b| distance(a.omega).total_cmp(&distance(b.omega)));
                let Some(near) = near.filter(|p| distance(p.omega) < peak.at.damping_ratio * peak.at.omega) else {
                    continue;
                };
                let right = peak.at.response.norm() / near.amplitude - 1.0;
                println!("{loss} {mode} {} {right} {}", peak.at.omega, peak.validity.error);
                assert!((peak.validity.error - right).abs() < 1e-6);
                compared += 1;
            }
        }
    }
    assert!(compared >= 6, "{compared}");
}

#[test]
fn the_phase_reference_does_not_change_a_resonance() {
    let (_, contacts, constant) = cases().remove(5);
    let model = chain(0.01, &contacts, constant, (0, 0.1));
    let mut found = Vec::new();
    for reference_dof in [None, Some(0), Some(1), Some(2)] {
        let range = ModeOptions {
            reference_dof,
            ..amplitude_range(-3.0, 1.5)
        };
        let solver = at_dof(0, harmonics(5));
        let branch = follow(&model, &solver, &range);
        let peak = synthesise(&branch, &model, &SynthesisOptions::default()).unwrap().peaks[0];
        found.push((peak.at.response.norm(), peak.at.omega, peak.validity.error));
    }
    for peak in &found {
        assert!((peak.0 / found[0].0 - 1.0).abs() < 1e-8 && (peak.1 / found[0].1 - 1.0).abs() < 1e-9);
        assert!((peak.2 - found[0].2).abs() < 1e-8);
    }
}

/// Random numbers in 0 .. 1.
struct Random(u64);

impl Random {
    fn unit(&mut self) -> f64 {
        // xorshift64*, Vigna 2016, doi:10.1145/2845077
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        (self.0.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    fn below(&mut self, n: usize) -> usize {
        (self.unit() * n as f64) as usize
    }
}

/// One to four masses on springs, with one or two contacts, half of them under loads at rest.
fn random_chain(random: &mut Random) -> Model {
    let n = 1 + random.below(4);
    let (mut mass, mut ground, mut between) = (vec![], vec![], vec![]);
    for i in 0..n {
        mass.push(random.within(0.5, 1.5));
        ground.push(random.within(0.6, 1.8));
        if i > 0 {
            between.push(random.within(0.3, 1.2));
        }
    }
    let mut model = coupled(&mass, &ground, &between)
        .rayleigh(0.0, 10_f64.powf(random.within(-2.7, -1.3)))
        .build();
    let loaded = random.unit() < 0.5;
    for _ in 0..=random.below(2) {
        let (dof, k) = (random.below(n), random.within(0.3, 1.5));
        let preload = random.within(0.2, 0.8);
        let contact = match random.below(4) {
            0 => Contact::jenkins(dof, None, k, 0.4, preload),
            1 => Contact::cubic(dof, None, 0.0, 0.2 * k),
            2 if n > 1 => {
                let normal = (dof + 1) % n;
                Contact::friction_2d([Some(dof), Some(normal)], [None; 2], (k, k), 0.4, preload)
            }
            _ => Contact::unilateral(Some(dof), None, k, if loaded { 0.0 } else { preload })
                .with(Constant::Preload, if loaded { preload } else { 0.0 })
                .unwrap(),
        };
        model.add_contact(&contact).unwrap();
    }
    if loaded {
        model
            .add_force(random.below(n), 0, random.within(-0.3, 0.3).into())
            .unwrap();
    }
    let force = 10_f64.powf(random.within(-2.0, -0.5));
    model.add_force(random.below(n), 1, force.into()).unwrap();
    model
}

#[test]
fn resonances_of_random_chains_without_a_flag_are_those_of_the_computed_peaks() {
    let mut random = Random(0x9E37_79B9_7F4A_7C15);
    let (mut valid, mut flagged, mut failed, mut worst) = (0, 0, 0, 0.0_f64);
    for number in 0..120 {
        let model = random_chain(&mut random);
        let range = amplitude_range(-3.0, 1.0);
        let mode = nonlinear_mode(&model, &harmonics(5), &range, &mut Hooks::default());
        let Ok(branch) = mode else {
            failed += 1;
            continue;
        };
        for peak in &synthesise(&branch, &model, &SynthesisOptions::default()).unwrap().peaks {
            let validity = peak.validity;
            if validity.inaccurate() || validity.another_mode() || validity.internal_resonance() || !peak.rising {
                flagged += 1;
                continue;
            }
            valid += 1;
            let solver = at_dof(branch.response_dof(), harmonics(5));
            let Some(computed) = computed_peak(&model, &solver, &peak.at, branch.mode().unwrap().omega) else {
                panic!("chain {number}: no peak near {}", peak.at.omega)
            };
            let least = (peak.at.response.norm() / computed - 1.0).abs();
            println!("chain {number}: {least:.1e}");
            assert!(least < 0.01, "chain {number}: {least:e}");
            worst = worst.max(least);
        }
    }
    println!("{valid} valid, {flagged} flagged, {failed} without a mode; error at most {worst:.1e}");
    assert!(valid >= 60, "{valid} of {flagged}");
}
