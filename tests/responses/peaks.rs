//! Peaks of every measure, against maxima of solutions at single frequencies, which know no peaks.

use crate::common::chains::{chain, duffing};
use crate::common::models::{self, unit_chain};
use crate::common::random::{signed, unit};
use crate::common::{at_dof, harmonics, omega_range};
use hbvib::{Branch, Component, ForcedOptions, Hooks, Measure, Model, Response, SolverOptions, forced_response};
use num_complex::Complex64;

fn solver() -> SolverOptions {
    harmonics(7)
}

fn solve(model: &Model, (start, stop): (f64, f64), responses: &[Response<'_>], step_max: f64) -> Branch {
    let solver = SolverOptions { step_max, ..solver() };
    let range = ForcedOptions {
        responses,
        ..omega_range(start, stop)
    };
    forced_response(model, &solver, &range, &mut Hooks::default()).unwrap()
}

/// The responses at one frequency, from the motion of a point nearby.
fn at(model: &Model, omega: f64, near: &[num_complex::Complex64], responses: &[Response<'_>]) -> Vec<f64> {
    let range = ForcedOptions {
        guess: Some(near),
        responses,
        ..omega_range(omega, omega)
    };
    let found = forced_response(model, &solver(), &range, &mut Hooks::default()).unwrap();
    found.responses().iter().map(|r| r.values()[0]).collect()
}

/// Checks each peak of each response: no solution beside it is higher, and it is as high as the parabola through its neighbours.
fn check_peaks(model: &Model, branch: &Branch, responses: &[Response<'_>]) -> usize {
    let mut checked = 0;
    for (r, found) in branch.responses().iter().enumerate() {
        for peak in found.peaks() {
            let mut x = vec![num_complex::Complex64::ZERO; (branch.harmonics() + 1) * branch.ndof()];
            branch.harmonics_at(peak.point, &mut x).unwrap();
            let value = |omega: f64| at(model, omega, &x, responses)[r];
            let here = value(peak.omega);
            // The least step that tells more than rounding.
            let steps = [1e-7, 1e-6, 1e-5, 1e-4].map(|share| share * peak.omega);
            let falls = |step: &f64| [-step, *step].map(|by| value(peak.omega + by));
            let tells = |step: &&f64| falls(step).iter().all(|there| here - there > 1e-11 * here);
            let step = *steps.iter().find(tells).expect("a maximum");
            let [below, above] = falls(&step);
            assert!(
                (here - peak.amplitude).abs() < 1e-9 * here,
                "{:?}: {here} {}",
                responses[r],
                peak.amplitude
            );
            assert!(
                below <= here * (1.0 + 1e-12) && above <= here * (1.0 + 1e-12),
                "{:?} {below} {here} {above}",
                responses[r]
            );
            let bend = below - 2.0 * here + above;
            let shift = 0.5 * step * (below - above) / bend;
            // Where a contact begins to slip the curve has a corner, on both sides of which it falls in proportion.
            let [before, after] = [-0.1, 0.1].map(|share| value(peak.omega + share * step) - here);
            let is_corner = before < 0.05 * (below - here) || after < 0.05 * (above - here);
            assert!(
                shift.abs() < 0.02 * step || is_corner,
                "{:?}: a peak at {} is off by {shift:e}",
                responses[r],
                peak.omega
            );
            checked += 1;
        }
    }
    checked
}

const KINDS: [Measure; 5] = [
    Measure::Fundamental,
    Measure::Harmonic(3),
    Measure::Peak,
    Measure::Rms,
    Measure::Range,
];

#[test]
fn superharmonic_resonances_are_peaks_of_the_measures_that_feel_them() {
    // x″ + 0.06 x′ + x + 0.3 x³ = 0.6 cos ωt: a third of the resonance lies at 0.36 to 0.4.
    let model = duffing(0.06, 0.3, 0.6);
    let responses = KINDS.map(|measure| Response {
        measure,
        dofs: &[0],
        ..Response::default()
    });
    let branch = solve(&model, (0.3, 0.6), &responses, 0.0);
    let fine = solve(&model, (0.3, 0.6), &responses, 2e-3);
    let count = |branch: &Branch| branch.responses().iter().map(|r| r.peaks().len()).collect::<Vec<_>>();
    assert_eq!(count(&branch), count(&fine));
    assert!(branch.responses()[1].peaks().len() == 1 && branch.responses()[2].peaks().len() == 1);
    assert!(check_peaks(&model, &branch, &responses) >= 4);
    for (a, b) in branch.responses().iter().zip(fine.responses()) {
        for (a, b) in a.peaks().iter().zip(b.peaks()) {
            assert!((a.omega / b.omega - 1.0).abs() < 1e-9 && (a.amplitude / b.amplitude - 1.0).abs() < 1e-9);
        }
    }
}

#[test]
fn peaks_of_every_measure_of_a_chain_with_friction_are_maxima() {
    let model = chain(6, 0.0);
    let mut responses = Vec::new();
    for measure in KINDS {
        for component in [Component::Displacement, Component::Acceleration] {
            for dofs in [&[0][..], &[3]] {
                responses.push(Response {
                    measure,
                    dofs,
                    component,
                    ..Response::default()
                });
            }
        }
    }
    let branch = solve(&model, (0.3, 1.0), &responses, 0.0);
    assert!(check_peaks(&model, &branch, &responses) > 15);
    // A dense sweep has the same peaks; a bump of 1e-4 beside the onset of a slip may lie within a step.
    let fine = solve(&model, (0.3, 1.0), &responses, 4e-3);
    let (mut all, mut more, mut corners) = (0, 0, 0);
    for ((a, b), response) in branch.responses().iter().zip(fine.responses()).zip(&responses) {
        for peak in a.peaks() {
            let distance = |b: &hbvib::Special| (peak.omega / b.omega - 1.0).abs();
            let same = b
                .peaks()
                .iter()
                .min_by(|x, y| distance(x).total_cmp(&distance(y)))
                .unwrap();
            // At a corner the derivative jumps, and its zero is less well defined.
            assert!(distance(same) < 1e-5, "{response:?}: {} {}", peak.omega, same.omega);
            assert!((peak.amplitude / same.amplitude - 1.0).abs() < 1e-7, "{response:?}");
            let is_exact = (peak.amplitude / same.amplitude - 1.0).abs() < 1e-9;
            corners += usize::from(distance(same) >= 1e-8 || !is_exact);
        }
        all += a.peaks().len();
        more += b.peaks().len() - a.peaks().len();
    }
    assert!(
        20 * more <= all && 20 * corners <= all,
        "{more} more, {corners} of {all}"
    );
}

#[test]
fn a_linear_structure_has_the_peaks_of_each_degree_of_freedom() {
    let model = chain(6, f64::INFINITY);
    let dofs: Vec<[usize; 1]> = (0..6).map(|dof| [dof]).collect();
    let responses: Vec<Response<'_>> = dofs
        .iter()
        .map(|dofs| Response {
            dofs,
            ..Response::default()
        })
        .collect();
    let branch = solve(&model, (0.1, 2.5), &responses, 0.0);
    for (dof, found) in branch.responses().iter().enumerate() {
        let alone = at_dof(dof, solver());
        let range = omega_range(0.1, 2.5);
        let alone = forced_response(&model, &alone, &range, &mut Hooks::default()).unwrap();
        assert_eq!(found.peaks().len(), alone.peaks().len(), "degree of freedom {dof}");
        for (a, b) in found.peaks().iter().zip(alone.peaks()) {
            assert!(
                (a.omega / b.omega - 1.0).abs() < 1e-10,
                "{dof}: {} {}",
                a.omega,
                b.omega
            );
            assert!((a.amplitude / b.amplitude - 1.0).abs() < 1e-10, "{dof}");
        }
    }
}

/// An uneven chain between walls with hardly any damping: masses, springs, and the factor of its stiffness damping.
struct Uneven {
    masses: Vec<f64>,
    springs: Vec<f64>,
    beta: f64,
}

impl Uneven {
    fn drawn(n: usize, state: &mut u64) -> Self {
        let mut around = |spread: f64| (spread * signed(state)).exp();
        let masses = (0..n).map(|_| around(0.7)).collect();
        let springs = (0..=n).map(|_| around(1.0)).collect();
        let beta = 10_f64.powf(-5.0 + 2.0 * signed(state));
        Self { masses, springs, beta }
    }

    fn model(&self) -> Model {
        let mut model = models::chain(&self.masses, &self.springs)
            .rayleigh(0.0, self.beta)
            .build();
        model.add_force(0, 1, 1.0.into()).unwrap();
        model
    }

    /// The motion under a load, by elimination from the first mass to the last.
    fn solved(&self, omega: f64, mut load: Vec<Complex64>) -> Vec<Complex64> {
        let n = self.masses.len();
        let stiff = Complex64::new(1.0, omega * self.beta);
        let mut pivots = vec![Complex64::ZERO; n];
        for i in 0..n {
            pivots[i] = stiff * (self.springs[i] + self.springs[i + 1]) - omega * omega * self.masses[i];
            if i > 0 {
                let factor = -stiff * self.springs[i] / pivots[i - 1];
                pivots[i] += factor * stiff * self.springs[i];
                let before = load[i - 1];
                load[i] -= factor * before;
            }
        }
        for i in (0..n).rev() {
            let beyond = if i + 1 < n {
                stiff * self.springs[i + 1] * load[i + 1]
            } else {
                Complex64::ZERO
            };
            load[i] = (load[i] + beyond) / pivots[i];
        }
        load
    }

    /// d|x|/dω of a mass under a force of 1 on the first.
    fn growth(&self, omega: f64, mass: usize) -> f64 {
        let n = self.masses.len();
        let mut force = vec![Complex64::ZERO; n];
        force[0] = 1.0.into();
        let x = self.solved(omega, force);
        // Z x′ = −Z′ x with Z′ = −2 ω M + i β K.
        let at = |i: usize| if i < n { x[i] } else { Complex64::ZERO };
        let load = (0..n).map(|i| {
            let before = if i > 0 { x[i - 1] } else { Complex64::ZERO };
            let spring = self.springs[i] * (x[i] - before) + self.springs[i + 1] * (x[i] - at(i + 1));
            2.0 * omega * self.masses[i] * x[i] - Complex64::new(0.0, self.beta) * spring
        });
        let slope = self.solved(omega, load.collect());
        (x[mass].conj() * slope[mass]).re / x[mass].norm()
    }
}

/// Far from every resonance a response has broad maxima beside its zeros, which steps between resonances would pass.
#[test]
fn broad_maxima_between_resonances_are_peaks() {
    let mut state = 11;
    let mut broad = 0;
    for case in 0..40 {
        let chain = Uneven::drawn([12, 33, 60, 90][case % 4], &mut state);
        let mass = (unit(&mut state) * 6.0) as usize;
        let range = (0.3, 2.0);
        let options = at_dof(mass, solver());
        let sweep = omega_range(range.0, range.1);
        let branch = forced_response(&chain.model(), &options, &sweep, &mut Hooks::default()).unwrap();
        let found: Vec<f64> = branch.peaks().iter().map(|peak| peak.omega).collect();
        for omega in &found {
            let beside = [1.0 - 1e-7, 1.0 + 1e-7].map(|factor| chain.growth(factor * omega, mass));
            assert!(beside[0] > 0.0 && beside[1] < 0.0, "{case}: {omega} is no maximum");
        }
        let places: Vec<f64> = (0..=3000)
            .map(|i| range.0 + (range.1 - range.0) * f64::from(i) / 3000.0)
            .collect();
        for pair in places.windows(2) {
            if chain.growth(pair[0], mass) > 0.0 && chain.growth(pair[1], mass) <= 0.0 {
                let is_found = found.iter().any(|omega| (pair[0]..=pair[1]).contains(omega));
                assert!(is_found, "{case}: no peak between {} and {}", pair[0], pair[1]);
                broad += 1;
            }
        }
    }
    assert!(broad > 400, "{broad}");
}

/// A chain of 120 masses between walls, whose modes are sines: with a damping ratio that all modes share the response is a sum in closed
/// form. Within the range lie 56 resonances; with 1 % of damping some are no maxima, and others next to a minimum.
#[test]
fn a_long_chain_has_the_peaks_of_its_closed_form_and_no_others() {
    const N: usize = 120;
    let (force, response) = (0, N / 2 + 3);
    let angle = |k: usize| std::f64::consts::PI * k as f64 / (N + 1) as f64;
    let frequency = |k: usize| 2.0 * (0.5 * angle(k)).sin();
    let modes: Vec<(f64, f64)> = (1..=N)
        .map(|k| {
            let shape = |i: usize| (angle(k) * (i + 1) as f64).sin();
            (frequency(k), 2.0 / (N + 1) as f64 * shape(force) * shape(response))
        })
        .collect();
    let range = (0.5 * frequency(1), 0.5 * (frequency(56) + frequency(57)));
    for (ratio, count) in [(1e-2, 41), (1e-3, 56), (1e-4, 56), (1e-5, 56), (1e-6, 56), (1e-7, 56)] {
        // The amplitude, and ½ d|x|²/dω.
        let exact = |omega: f64| {
            let (mut x, mut d_x) = (Complex64::ZERO, Complex64::ZERO);
            for &(own, weight) in &modes {
                let d = Complex64::new((own - omega) * (own + omega), 2.0 * ratio * own * omega);
                let d_d = Complex64::new(-2.0 * omega, 2.0 * ratio * own);
                x += weight / d;
                d_x -= weight * d_d / (d * d);
            }
            (x.norm(), (x.conj() * d_x).re)
        };
        let mut places: Vec<f64> = (0..=4000)
            .map(|i| range.0 + (range.1 - range.0) * f64::from(i) / 4000.0)
            .collect();
        for &(own, _) in &modes[..57] {
            places.extend((-60..=60).map(|i| own * (1.0 + ratio * (0.15 * f64::from(i)).sinh())));
        }
        places.retain(|omega| (range.0..=range.1).contains(omega));
        places.sort_by(f64::total_cmp);
        let mut known = Vec::new();
        for pair in places.windows(2) {
            let (mut low, mut high) = (pair[0], pair[1]);
            if exact(low).1 > 0.0 && exact(high).1 <= 0.0 {
                while high - low > 4.0 * f64::EPSILON * high {
                    let middle = 0.5 * (low + high);
                    if exact(middle).1 > 0.0 {
                        low = middle;
                    } else {
                        high = middle;
                    }
                }
                known.push((low, exact(low).0));
            }
        }
        assert_eq!(known.len(), count, "{ratio}");
        let mut model = unit_chain(N).build();
        model.set_modal_damping(&[ratio; N]).unwrap();
        model.add_force(force, 1, 1.0.into()).unwrap();
        let options = at_dof(response, solver());
        let sweep = omega_range(range.0, range.1);
        let branch = forced_response(&model, &options, &sweep, &mut Hooks::default()).unwrap();
        assert_eq!(branch.peaks().len(), count, "{ratio}");
        for (found, (omega, amplitude)) in branch.peaks().iter().zip(known) {
            let off = (
                (found.omega / omega - 1.0).abs(),
                (found.amplitude / amplitude - 1.0).abs(),
            );
            assert!(off.0 < 1e-9 && off.1 < 1e-9, "{ratio}: {omega} {off:?}");
        }
    }
}
