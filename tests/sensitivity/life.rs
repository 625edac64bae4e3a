//! Wear over a life: closed forms, stored rows of another code, and the classical Runge-Kutta method on loads with the works that
//! summaries of contacts tell.

use crate::common::models::{self, free_end, oscillator};
use crate::common::{at_dof, data, number, omega_range};
use hbvib::{
    BestLoad, Constant, Contact, Duty, Error, Hooks, Life, LifeEventKind, LifeFollow, LifeOptions, Model,
    SolverOptions, Status, Wear, best_load_for_life, forced_response, life,
};
use std::f64::consts::PI;

fn solver(harmonics: usize) -> SolverOptions {
    crate::common::harmonics(harmonics)
}

fn run(model: &Model, harmonics: usize, options: &LifeOptions<'_>) -> Result<Life, Error> {
    life(model, &solver(harmonics), options, &mut Hooks::default())
}

fn at(omega: f64) -> [Duty; 1] {
    [Duty {
        omega,
        force: 1.0,
        share: 1.0,
    }]
}

fn close(name: &str, found: f64, wanted: f64, tolerance: f64) {
    let error = (found - wanted).abs() / wanted.abs();
    assert!(
        error <= tolerance,
        "{name}: {found} is not {wanted} (error {error:.3e}, allowed {tolerance:e})"
    );
}

/// Masses 1 in a row from the ground, springs 1, damping 0.05 of K, and friction on each.
fn chain(loads: &[f64]) -> Model {
    let n = loads.len();
    let sliders = loads.iter().enumerate();
    models::chain(&vec![1.0; n], &free_end(n, 1.0))
        .rayleigh(0.0, 0.05)
        .contacts(sliders.map(|(i, load)| Contact::jenkins(i, None, 1.0, 0.3, *load)))
        .force(n - 1, 1, 0.3)
        .build()
}

fn wear(rates: &[f64]) -> Vec<Wear> {
    let contacts = rates.iter().enumerate();
    contacts
        .map(|(contact, rate)| Wear {
            contact,
            rate: *rate,
            area: 1.0,
        })
        .collect()
}

/// Works of all contacts, and whether each slips, at a frequency or at the highest peak.
fn works(model: &Model, loads: &[f64], harmonics: usize, range: (f64, f64)) -> (Vec<f64>, f64) {
    let mut model = model.try_clone().unwrap();
    for (contact, load) in loads.iter().enumerate() {
        model.set_preload(contact, load.max(0.0)).unwrap();
    }
    let options = omega_range(range.0, range.1);
    let solver = at_dof(model.ndof() - 1, solver(harmonics));
    let branch = forced_response(&model, &solver, &options, &mut Hooks::default()).unwrap();
    let (point, amplitude) = if range.0 < range.1 {
        let highest = branch.peaks().iter().max_by(|a, b| a.amplitude.total_cmp(&b.amplitude));
        let peak = highest.unwrap();
        (peak.point, peak.amplitude)
    } else {
        (0, branch.amplitude()[0])
    };
    let of = |contact| branch.contact_summary(point, contact).unwrap().work;
    ((0..loads.len()).map(of).collect(), amplitude)
}

/// The classical method of fourth order for the loads.
fn by_runge_kutta(
    model: &Model,
    (rates, stiffness): (&[f64], &[f64]),
    harmonics: usize,
    range: (f64, f64),
    (cycles, steps): (f64, usize),
) -> Vec<f64> {
    let n = rates.len();
    let slope = |loads: &[f64]| -> Vec<f64> {
        let (works, _) = works(model, loads, harmonics, range);
        let row = |i: usize| (0..n).map(|j| -stiffness[j * n + i] * rates[j] * works[j]).sum();
        (0..n).map(row).collect()
    };
    let step = cycles / steps as f64;
    let mut loads: Vec<f64> = model.contacts().iter().map(|c| c.constant(Constant::Preload)).collect();
    let moved = |loads: &[f64], by: f64, slope: &[f64]| -> Vec<f64> {
        loads.iter().zip(slope).map(|(n, s)| n + by * s).collect()
    };
    for _ in 0..steps {
        let a = slope(&loads);
        let b = slope(&moved(&loads, 0.5 * step, &a));
        let c = slope(&moved(&loads, 0.5 * step, &b));
        let d = slope(&moved(&loads, step, &c));
        for i in 0..n {
            loads[i] += step / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]);
        }
    }
    loads
}

/// A mass so heavy that friction does not change its motion A: N = N*/(1 + (N*/N₀ − 1) e^{rn}), N* = kt A/μ, r = 4cμA with the loss c of
/// load per work.
#[test]
fn wear_under_a_given_motion_is_the_logistic_curve() {
    let (kt, mu, load, c, amplitude) = (2.0, 0.3, 1.7, 0.02, 0.9);
    let model = oscillator(1e12, 1e8)
        .slider(0, kt, mu, load)
        .force(0, 1, (1e8 - 1e12) * amplitude)
        .build();
    let end = kt * amplitude / mu;
    let exact = |n: f64| end / (1.0 + (end / load - 1.0) * (4.0 * c * mu * amplitude * n).exp());
    let cycles = [0.0, 3.0, 10.0, 31.0, 100.0, 200.0];
    let mut errors = Vec::new();
    for tolerance in [1e-3, 1e-5, 1e-7, 1e-9, 1e-10] {
        let options = LifeOptions {
            wear: &wear(&[c]),
            stiffness: &[1.0],
            follow: LifeFollow::Duties(&at(1.0)),
            cycles: &cycles,
            tolerance,
            ..LifeOptions::default()
        };
        let found = run(&model, 5, &options).unwrap();
        assert_eq!(found.status, Status::Ok);
        let error = found.points.iter().map(|p| (p.loads[0] - exact(p.cycles)).abs() / load);
        let error = error.fold(0.0_f64, f64::max);
        assert!(error <= 20.0 * tolerance, "error {error:e} at {tolerance:e}");
        errors.push((found.steps, error));
        for p in &found.points {
            let load = exact(p.cycles);
            let work = 4.0 * mu * load * (amplitude - mu * load / kt);
            assert!(
                (p.works[0] - work).abs() <= 1e3 * tolerance * work,
                "{} cycles",
                p.cycles
            );
        }
    }
    let (steps, last) = errors[errors.len() - 1];
    assert!(last <= 1e-8, "{last:e}");
    // Of the fourth order: errors fall at least as the third power of the number of steps, apart from luck of single ones.
    let (few, first) = errors[1];
    let order = (first / last).ln() / (steps as f64 / few as f64).ln();
    assert!(order > 3.0, "order {order}: {errors:?}");
}

#[test]
fn wear_of_an_oscillator_is_that_of_stored_rows() {
    let rows = data("wear_of_one_contact.json");
    let model = oscillator(1.0, 1.0)
        .damping(&[0.05])
        .slider(0, 1.0, 0.3, 0.6)
        .force(0, 1, 0.3)
        .build();
    for harmonics in [1, 9, 31] {
        let row = &rows[format!("b_H{harmonics}").as_str()];
        let list = |name: &str| -> Vec<f64> { row[name].as_array().unwrap().iter().map(number).collect() };
        let (cycles, loads, amplitudes) = (list("n"), list("N"), list("amplitude"));
        for (tolerance, allowed, most) in [(1e-8, 1e-6, usize::MAX), (1e-4, 1e-3, 30)] {
            let options = LifeOptions {
                wear: &wear(&[0.05]),
                stiffness: &[1.0],
                follow: LifeFollow::Duties(&at(1.1)),
                cycles: &cycles,
                tolerance,
                ..LifeOptions::default()
            };
            let found = run(&model, harmonics, &options).unwrap();
            assert_eq!(found.status, Status::Ok);
            assert_eq!(found.points.len(), cycles.len());
            for (i, point) in found.points.iter().enumerate() {
                let name = format!("H {harmonics}, {} cycles", cycles[i]);
                close(&name, point.loads[0], loads[i], allowed);
                close(&name, point.amplitude, amplitudes[i], allowed);
            }
            assert!(found.solutions <= most, "{} steady solutions", found.solutions);
        }
    }
}

/// Three contacts, elastic coupling of their normals, at a frequency and at the peak that is followed.
#[test]
fn wear_of_coupled_contacts_is_that_of_runge_kutta() {
    let loads = [0.5, 0.8, 1.1];
    let model = chain(&loads);
    let rates = [0.05, 0.02, 0.08];
    let stiffness = [1.0, -0.2, 0.0, -0.2, 1.2, -0.3, 0.0, -0.3, 0.9];
    for range in [(0.82, 0.82), (0.6, 1.1)] {
        let wanted = by_runge_kutta(&model, (&rates, &stiffness), 7, range, (6.0, 30));
        let duties = at(range.0);
        let options = LifeOptions {
            wear: &wear(&rates),
            stiffness: &stiffness,
            follow: if range.0 < range.1 {
                LifeFollow::Peak {
                    omega_start: range.0,
                    omega_stop: range.1,
                }
            } else {
                LifeFollow::Duties(&duties)
            },
            cycles: &[0.0, 6.0],
            tolerance: 1e-7,
            ..LifeOptions::default()
        };
        let solver = at_dof(2, solver(7));
        let found = life(&model, &solver, &options, &mut Hooks::default()).unwrap();
        assert_eq!(found.status, Status::Ok, "{:?}", found.reason);
        let end = &found.points[1];
        for (found, wanted) in end.loads.iter().zip(&wanted) {
            close(&format!("load in {range:?}"), *found, *wanted, 2e-6);
        }
        let (_, amplitude) = works(&model, &end.loads, 7, range);
        close("amplitude", end.amplitude, amplitude, 1e-9);
    }
}

/// A contact that sticks begins to slip as another one wears away: the step ends there, and the loads are those of many short steps.
#[test]
fn steps_end_where_a_contact_begins_to_slip() {
    let model = chain(&[1.6, 0.3]);
    let rates = [0.1, 0.1]; // the second one wears, and the motion grows
    let stiffness = [1.0, 0.0, 0.0, 1.0];
    let duties = at(0.62);
    let options = LifeOptions {
        wear: &wear(&rates),
        stiffness: &stiffness,
        follow: LifeFollow::Duties(&duties),
        cycles: &[0.0, 20.0],
        tolerance: 1e-6,
        ..LifeOptions::default()
    };
    let found = run(&model, 5, &options).unwrap();
    assert_eq!(found.status, Status::Ok, "{:?}", found.reason);
    let slips: Vec<_> = found.events.iter().filter(|e| e.kind == LifeEventKind::Slips).collect();
    assert_eq!(slips.len(), 1, "{:?}", found.events);
    assert_eq!(slips[0].contact, Some(0));
    let n = slips[0].cycles;
    assert!(n > 0.0 && n < 20.0);
    let begin = |n: f64| {
        let options = LifeOptions {
            cycles: &[n],
            ..options
        };
        run(&model, 5, &options).unwrap().points[0].works[0]
    };
    assert_eq!(begin(n * (1.0 - 1e-4)).to_bits(), 0);
    assert!(begin(n * (1.0 + 1e-4)) > 0.0);
    let wanted = by_runge_kutta(&model, (&rates, &stiffness), 5, (0.62, 0.62), (20.0, 200));
    for (found, wanted) in found.points[1].loads.iter().zip(&wanted) {
        close("load", *found, *wanted, 1e-4);
    }
}

/// A life: its name, loads when new, rates of wear, stiffness of the loads, the vibrations, and the last cycle.
type Case<'a> = (&'a str, &'a [f64], &'a [f64], &'a [f64], LifeFollow<'a>, f64);

/// At an accuracy of 1e-4 a life takes at most thirty steady vibrations, also where a contact begins to slip, and with three contacts;
/// loads and amplitudes keep it at all times.
///
/// Sixty cycles in the peak, until all loads are worn off, have a kink at 22 cycles, a jump to another peak at 33.8, and an amplitude that
/// grows by sixty times in ten cycles. Steps of the fifth order in their error with lengths that are chosen without a mistake are 16 on the
/// smooth parts alone, and the place of the jump takes ten halvings more. So thirty cannot be had there; up to 33 cycles they can.
#[test]
fn a_life_takes_thirty_vibrations() {
    let duties = at(0.62);
    let coupled = [1.0, -0.2, 0.0, -0.2, 1.2, -0.3, 0.0, -0.3, 0.9];
    let peak = LifeFollow::Peak {
        omega_start: 0.6,
        omega_stop: 1.1,
    };
    let steady = at(0.82);
    let separate = [1.0, 0.0, 0.0, 1.0];
    let cases: [Case<'_>; 5] = [
        (
            "an event",
            &[1.6, 0.3],
            &[0.1, 0.1],
            &separate,
            LifeFollow::Duties(&duties),
            20.0,
        ),
        (
            "three contacts",
            &[0.5, 0.8, 1.1],
            &[0.05, 0.02, 0.08],
            &coupled,
            LifeFollow::Duties(&steady),
            60.0,
        ),
        (
            "in the peak",
            &[0.5, 0.8, 1.1],
            &[0.05, 0.02, 0.08],
            &coupled,
            peak,
            6.0,
        ),
        (
            "in the peak up to its jump",
            &[0.5, 0.8, 1.1],
            &[0.05, 0.02, 0.08],
            &coupled,
            peak,
            33.0,
        ),
        (
            "in the peak for long",
            &[0.5, 0.8, 1.1],
            &[0.05, 0.02, 0.08],
            &coupled,
            peak,
            60.0,
        ),
    ];
    for (name, loads, rates, stiffness, follow, end) in cases {
        let model = chain(loads);
        let cycles: Vec<f64> = (0..=40).map(|i| end * f64::from(i) / 40.0).collect();
        let run_at = |tolerance: f64| {
            let options = LifeOptions {
                wear: &wear(rates),
                stiffness,
                follow,
                cycles: &cycles,
                tolerance,
                ..LifeOptions::default()
            };
            let solver = at_dof(loads.len() - 1, solver(5));
            life(&model, &solver, &options, &mut Hooks::default()).unwrap()
        };
        let (found, exact) = (run_at(1e-4), run_at(1e-8));
        assert_eq!(exact.status, Status::Ok, "{:?}", exact.reason);
        let unit = loads.iter().fold(0.0_f64, |most, n| most.max(*n));
        let mut error = 0.0_f64;
        for (a, b) in found.points.iter().zip(&exact.points) {
            error = error.max((a.amplitude / b.amplitude - 1.0).abs());
            for (a, b) in a.loads.iter().zip(&b.loads) {
                error = error.max((a - b).abs() / unit);
            }
        }
        println!(
            "{name}: {} vibrations in {} steps, error {error:.1e}, events {:?}",
            found.solutions, found.steps, found.events
        );
        let (most, allowed) = match name {
            "in the peak up to its jump" => (30, 5e-3),
            "in the peak for long" => (70, 1e-2),
            _ => (30, 1e-4),
        };
        assert!(error < allowed, "{name}: {error:e}");
        assert!(found.solutions <= most, "{name}: {} vibrations", found.solutions);
    }
}

#[test]
fn a_life_goes_on_from_its_depths_and_tells_its_limit() {
    let model = chain(&[0.6]);
    let duties = at(0.9);
    let options = LifeOptions {
        wear: &wear(&[0.05]),
        stiffness: &[1.0],
        follow: LifeFollow::Duties(&duties),
        cycles: &[4.0, 10.0],
        tolerance: 1e-8,
        ..LifeOptions::default()
    };
    let whole = run(&model, 5, &options).unwrap();
    let first = run(
        &model,
        5,
        &LifeOptions {
            cycles: &[4.0],
            ..options
        },
    )
    .unwrap();
    let second = LifeOptions {
        cycles: &[6.0],
        worn: first.depths(),
        ..options
    };
    let second = run(&model, 5, &second).unwrap();
    close("depth", second.points[0].depths[0], whole.points[1].depths[0], 1e-7);
    let middle = whole.points[0].amplitude;
    let told = run(
        &model,
        5,
        &LifeOptions {
            limit: middle,
            ..options
        },
    )
    .unwrap();
    assert_eq!(told.events.len(), 1, "{:?}", told.events);
    close("cycles of the limit", told.events[0].cycles, 4.0, 1e-3);
    // Stuck, nothing wears.
    let stuck = run(&chain(&[60.0]), 5, &options).unwrap();
    assert_eq!(stuck.points[1].depths, [0.0]);
}

/// The best load for eight cycles of a life at the peak, and the largest amplitude of such a life with a factor.
fn best_of(wear: &[Wear]) -> (BestLoad, impl Fn(f64) -> f64 + '_) {
    let options = LifeOptions {
        wear,
        stiffness: &[1.0],
        follow: LifeFollow::Peak {
            omega_start: 0.6,
            omega_stop: 2.0,
        },
        cycles: &[8.0],
        tolerance: 1e-6,
        ..LifeOptions::default()
    };
    let hooks = &mut Hooks::default();
    let best = best_load_for_life(&chain(&[1.0]), &solver(3), &options, (0.2, 3.0), hooks).unwrap();
    let largest = move |factor: f64| run(&chain(&[factor]), 3, &options).unwrap().largest.0;
    (best, largest)
}

/// Against a scan of lives at many factors.
#[test]
fn the_best_load_for_a_life_is_that_of_a_scan() {
    let wear = wear(&[0.02]);
    let (best, largest) = best_of(&wear);
    let scanned = (0..25).map(|i| best.factor * (0.9 + 0.2 * f64::from(i) / 24.0));
    let least = scanned.map(&largest).fold(f64::INFINITY, f64::min);
    assert!(best.amplitude <= least * (1.0 + 1e-6), "{best:?} against {least}");
    close("its amplitude", largest(best.factor), best.amplitude, 1e-9);
    // The new and the worn machine vibrate alike.
    close("both ends", best.new, best.worn, 1e-5);
}

/// A search that keeps nothing has an error, no status of a partial result; it names the factor and the range.
#[test]
fn a_search_of_loads_without_a_peak_is_an_error() {
    let model = chain(&[1.0]);
    let options = LifeOptions {
        wear: &wear(&[0.02]),
        stiffness: &[1.0],
        follow: LifeFollow::Peak {
            omega_start: 10.0,
            omega_stop: 11.0,
        },
        cycles: &[8.0],
        ..LifeOptions::default()
    };
    let error = best_load_for_life(&model, &solver(3), &options, (0.2, 3.0), &mut Hooks::default()).unwrap_err();
    assert_eq!(error.status, Status::NoConvergence);
    let sentence = error.to_string();
    assert!(
        sentence.contains("with the factor 0.2")
            && sentence.contains("no peak within omega = 10 .. 11: widen the range"),
        "{sentence}"
    );
    // A life that does not come to its end within its steps is none, either.
    let short = LifeOptions {
        follow: LifeFollow::Peak {
            omega_start: 0.6,
            omega_stop: 2.0,
        },
        most_steps: 1,
        ..options
    };
    let error = best_load_for_life(&model, &solver(3), &short, (0.2, 3.0), &mut Hooks::default()).unwrap_err();
    assert_eq!(error.status, Status::NoConvergence);
    assert!(error.to_string().contains("1 steps"), "{error}");
}

/// Against two hundred lives: none is better, and the best of them lies next to the factor found, a part of 1e-4 beside it.
#[test]
#[ignore = "two hundred lives; tests/deep.sh runs it"]
fn the_best_load_for_a_life_is_that_of_two_hundred_lives() {
    let wear = wear(&[0.02]);
    let (best, largest) = best_of(&wear);
    // A hundred over the whole range, and a hundred next to the best one, 1e-4 from each other.
    let wide: Vec<f64> = (0..100)
        .map(|i| largest(0.2 * 15.0_f64.powf(f64::from(i) / 99.0)))
        .collect();
    let near: Vec<(f64, f64)> = (0..100)
        .map(|i| best.factor * (1.0 + 1e-4 * (f64::from(i) - 49.5)))
        .map(|factor| (factor, largest(factor)))
        .collect();
    let least = near
        .iter()
        .fold(near[0], |least, one| if one.1 < least.1 { *one } else { least });
    println!(
        "{best:?}, {least:?}, {:?}",
        wide.iter().fold(f64::INFINITY, |a, b| a.min(*b))
    );
    assert!(
        wide.iter()
            .chain(near.iter().map(|one| &one.1))
            .all(|a| best.amplitude <= a * (1.0 + 1e-6))
    );
    assert!((least.0 / best.factor - 1.0).abs() <= 1e-4, "{least:?} {best:?}");
    assert!((least.1 / best.amplitude - 1.0).abs() <= 1e-4, "{least:?} {best:?}");
}

#[test]
fn bad_options_are_named() {
    let model = chain(&[1.0]);
    let duties = at(0.9);
    let options = LifeOptions {
        wear: &wear(&[0.02]),
        stiffness: &[1.0],
        follow: LifeFollow::Duties(&duties),
        cycles: &[8.0],
        ..LifeOptions::default()
    };
    let refused = |options: &LifeOptions<'_>, status: Status, words: &str| {
        let error = run(&model, 3, options).unwrap_err();
        assert_eq!(error.status, status, "{error}");
        assert!(error.to_string().contains(words), "{error}");
    };
    let other = Wear {
        contact: 1,
        ..options.wear[0]
    };
    refused(
        &LifeOptions {
            wear: &[other],
            ..options
        },
        Status::Index,
        "contact = 1",
    );
    refused(
        &LifeOptions {
            stiffness: &[],
            ..options
        },
        Status::Argument,
        "no normal stiffness",
    );
    refused(
        &LifeOptions {
            stiffness: &[1.0, 2.0],
            ..options
        },
        Status::Dimension,
        "1 x 1",
    );
    refused(
        &LifeOptions {
            cycles: &[2.0, 1.0],
            ..options
        },
        Status::Argument,
        "cycles[1] = 1",
    );
    refused(
        &LifeOptions {
            tolerance: 1.0,
            ..options
        },
        Status::Argument,
        "tolerance = 1",
    );
    for (limit, words) in [
        (-1.0, "limit = -1.0, needs a finite amplitude"),
        (f64::NAN, "limit = NaN"),
    ] {
        refused(&LifeOptions { limit, ..options }, Status::Argument, words);
    }
    refused(
        &LifeOptions {
            worn: &[-1.0],
            ..options
        },
        Status::Argument,
        "worn[0] = -1",
    );
    let none = LifeFollow::Duties(&[]);
    refused(
        &LifeOptions {
            follow: none,
            ..options
        },
        Status::Dimension,
        "duties",
    );
    let nowhere = LifeFollow::Peak {
        omega_start: 10.0,
        omega_stop: 11.0,
    };
    refused(
        &LifeOptions {
            follow: nowhere,
            ..options
        },
        Status::StoppedNoPeak,
        "no peak",
    );
}

/// A static stiffness is symmetric and takes energy: what is not is refused, rounding and a semidefinite one apart.
#[test]
fn a_stiffness_that_is_none_is_refused() {
    let model = chain(&[1.0, 1.0]);
    let duties = at(0.9);
    let with = |stiffness: &[f64]| {
        let options = LifeOptions {
            wear: &wear(&[0.02, 0.02]),
            stiffness,
            follow: LifeFollow::Duties(&duties),
            cycles: &[0.1],
            ..LifeOptions::default()
        };
        run(&model, 3, &options)
    };
    for (stiffness, words) in [
        ([1.0, 0.2, 0.1, 1.0], "stiffness[0,1] = 0.1, but stiffness[1,0] = 0.2"),
        ([1.0, 2.0, 2.0, 1.0], "pivot 1"),
        ([0.0, 0.5, 0.5, 1.0], "pivot 0"),
        ([1.0, 0.0, 0.0, -1.0], "pivot 1"),
    ] {
        let error = with(&stiffness).unwrap_err();
        assert_eq!(error.status, Status::Argument, "{error}");
        assert!(error.to_string().contains(words), "{error}");
    }
    for stiffness in [
        [1.0, 1.0, 1.0, 1.0],
        [0.0, 0.0, 0.0, 1.0],
        [1e9, 0.3e9 + 1e-3, 0.3e9, 1e9],
        [1.0, -1.0, -1.0, 1.0],
    ] {
        let scaled = stiffness.map(|s| s / 1e9);
        assert!(with(&scaled).is_ok(), "{:?}", with(&scaled).err());
    }
}

/// A spring that softens beside a slider that wears, with one harmonic: the describing functions of both tell the load at which the motion
/// of small amplitude ends. The life tells a jump there, and goes on with the other motion.
#[test]
fn a_life_tells_where_its_motion_ends_at_a_fold() {
    let (kt, mu, load, omega, damping, bend, force) = (0.3, 0.3, 0.35, 0.85, 0.05, -0.1, 0.25);
    let model = oscillator(1.0, 1.0)
        .damping(&[damping])
        .slider(0, kt, mu, load)
        .contact(Contact::cubic(0, None, 0.0, bend))
        .force(0, 1, force)
        .build();
    // Force that a steady amplitude needs.
    let needed = |a: f64, n: f64| {
        let slip = mu * n / kt;
        let (stiffness, loss) = if a > slip {
            let angle = (1.0 - 2.0 * slip / a).acos();
            let work = 4.0 * mu * n * (a - slip);
            (kt / PI * (angle - 0.5 * (2.0 * angle).sin()), work / (PI * a * a))
        } else {
            (kt, 0.0)
        };
        a * (1.0 + 0.75 * bend * a * a + stiffness - omega * omega).hypot(damping * omega + loss)
    };
    // The small motion is there as long as its largest force is more than that of the model.
    let top = |n: f64| (1..=20_000).map(|i| needed(1e-4 * f64::from(i), n)).fold(0.0, f64::max);
    let (mut low, mut high) = (0.0, load);
    assert!(top(low) < force && top(high) > force);
    while high - low > 1e-7 {
        let middle = 0.5 * (low + high);
        if top(middle) > force {
            high = middle;
        } else {
            low = middle;
        }
    }
    let cycles: Vec<f64> = (0..=400).map(f64::from).collect();
    let (duties, rate) = (at(omega), 0.05);
    let mut last = None;
    for tolerance in [1e-4, 1e-6] {
        let options = LifeOptions {
            wear: &wear(&[rate]),
            stiffness: &[1.0],
            follow: LifeFollow::Duties(&duties),
            cycles: &cycles,
            tolerance,
            ..LifeOptions::default()
        };
        let found = run(&model, 1, &options).unwrap();
        assert_eq!(found.status, Status::Ok, "{:?}", found.reason);
        let jumps: Vec<_> = found.events.iter().filter(|e| e.kind == LifeEventKind::Jumps).collect();
        println!("{:?}, {} vibrations, load {low}", found.events, found.solutions);
        assert_eq!(jumps.len(), 1, "{:?}", found.events);
        let n = jumps[0].cycles;
        let (before, after): (Vec<_>, Vec<_>) = found.points.iter().partition(|p| p.cycles <= n);
        // The load there, along the straight line beside it.
        let end = before[before.len() - 1];
        let reached = end.loads[0] - (n - end.cycles) * rate * end.works[0];
        close("load of the fold", reached, low, 0.02);
        assert!(before.iter().all(|p| p.loads[0] >= low * (1.0 - 1e-3)) && after[0].loads[0] < low);
        for p in &found.points {
            close("force of the amplitude", needed(p.amplitude, p.loads[0]), force, 1e-2);
        }
        assert!(after.iter().all(|p| p.amplitude > 1.5 * end.amplitude));
        assert!(last.is_none_or(|other: f64| (other - n).abs() < 2e-2), "{last:?} {n}");
        last = Some(n);
    }
}

/// A peak that meets a minimum: the life tells the jump to the other one. A sweep under the loads next to it has both peaks, or one.
#[test]
fn a_life_tells_where_its_peak_vanishes() {
    let model = chain(&[0.5, 0.8, 1.1]);
    let cycles = [30.0, 33.0, 33.7, 33.85, 36.0];
    let options = LifeOptions {
        wear: &wear(&[0.05, 0.02, 0.08]),
        stiffness: &[1.0, -0.2, 0.0, -0.2, 1.2, -0.3, 0.0, -0.3, 0.9],
        follow: LifeFollow::Peak {
            omega_start: 0.6,
            omega_stop: 1.1,
        },
        cycles: &cycles,
        tolerance: 1e-6,
        ..LifeOptions::default()
    };
    let solver = at_dof(2, solver(5));
    let found = life(&model, &solver, &options, &mut Hooks::default()).unwrap();
    assert_eq!(found.status, Status::Ok, "{:?}", found.reason);
    println!("{:?}, {} vibrations", found.events, found.solutions);
    let jumps: Vec<_> = found.events.iter().filter(|e| e.kind == LifeEventKind::Jumps).collect();
    assert_eq!(jumps.len(), 1, "{:?}", found.events);
    assert!((33.7..33.85).contains(&jumps[0].cycles), "{}", jumps[0].cycles);
    for (point, is_there) in found.points[2..4].iter().zip([true, false]) {
        let mut model = model.try_clone().unwrap();
        for (contact, load) in point.loads.iter().enumerate() {
            model.set_preload(contact, *load).unwrap();
        }
        let sweep = omega_range(0.63, 0.67);
        let branch = forced_response(&model, &solver, &sweep, &mut Hooks::default()).unwrap();
        assert_eq!(!branch.peaks().is_empty(), is_there, "{:?}", branch.peaks());
    }
}
