//! An oscillator of mass 1 with a stop, under preload, a constant force and a gap: its period and fundamental against
//! amplitude in closed form, since it is linear on either side of the point of contact.

use crate::common::mode_cases::{follow, only};
use crate::common::models::oscillator;
use crate::common::{all_harmonics, amplitude_range, harmonics};
use hbvib::{Constant, Contact, ModeOptions, Model, SolverOptions};
use std::f64::consts::PI;

/// ẍ + kx = F + max(kn(−x − c), 0).
#[derive(Clone, Copy, Debug)]
struct Stop {
    k: f64,
    kn: f64,
    preload: f64,
    gap: f64,
    force: f64,
}

impl Stop {
    /// c
    fn clearance(&self) -> f64 {
        self.gap - self.preload / self.kn
    }

    fn model(&self) -> Model {
        let stop = Contact::unilateral(Some(0), None, self.kn, self.gap)
            .with(Constant::Preload, self.preload)
            .unwrap();
        oscillator(1.0, self.k).contact(&stop).force(0, 0, self.force).build()
    }

    /// Equilibria of the open and of the closed oscillator.
    fn centres(&self) -> (f64, f64) {
        (
            self.force / self.k,
            (self.force - self.kn * self.clearance()) / (self.k + self.kn),
        )
    }

    fn at_rest(&self) -> f64 {
        let (open, closed) = self.centres();
        if open >= -self.clearance() { open } else { closed }
    }

    /// Frequency and fundamental of the motion whose largest displacement is `most`.
    fn motion(&self, most: f64) -> (f64, f64) {
        let (open, closed) = self.centres();
        let (w1, w2) = (self.k.sqrt(), (self.k + self.kn).sqrt());
        let level = -self.clearance();
        let first = most - open;
        if most <= level {
            return (w2, (most - closed).abs());
        }
        if open - first >= level {
            return (w1, first);
        }
        // From the largest displacement to contact, then to the least.
        let t1 = ((level - open) / first).acos() / w1;
        let speed = first * w1 * (w1 * t1).sin();
        let second = (level - closed).hypot(speed / w2);
        let phase = (speed / w2).atan2(level - closed);
        let t2 = (PI - phase) / w2;
        let w = PI / (t1 + t2);
        // ∫ cos(q t + p) dt
        let integral = |q: f64, p: f64, a: f64, b: f64| {
            if q.abs() > 1e-12 {
                ((q * b + p).sin() - (q * a + p).sin()) / q
            } else {
                (b - a) * p.cos()
            }
        };
        let part = |centre: f64, size: f64, own: f64, p: f64, a: f64, b: f64| {
            centre * integral(w, 0.0, a, b) + 0.5 * size * (integral(own + w, p, a, b) + integral(own - w, p, a, b))
        };
        let sum = part(open, first, w1, 0.0, 0.0, t1) + part(closed, second, w2, phase - w2 * t1, t1, t1 + t2);
        (w, 2.0 * w / PI * sum)
    }

    /// Frequency at the fundamental amplitude a, by bisection.
    fn omega(&self, a: f64) -> f64 {
        let (mut low, mut high) = (self.at_rest(), self.at_rest() + 4.0 * a + self.clearance().abs());
        while self.motion(high).1 < a {
            high += high - low;
        }
        for _ in 0..200 {
            let middle = 0.5 * (low + high);
            if self.motion(middle).1 < a {
                low = middle;
            } else {
                high = middle;
            }
        }
        self.motion(high).0
    }
}

const CASES: [Stop; 7] = [
    Stop {
        k: 1.0,
        kn: 2.0,
        preload: 0.5,
        gap: 0.0,
        force: 0.0,
    },
    Stop {
        k: 1.0,
        kn: 2.0,
        preload: 0.0,
        gap: 0.5,
        force: 0.0,
    },
    Stop {
        k: 1.0,
        kn: 2.0,
        preload: 0.0,
        gap: 0.5,
        force: -2.0,
    },
    Stop {
        k: 1.0,
        kn: 2.0,
        preload: 0.3,
        gap: 0.2,
        force: -1.0,
    },
    Stop {
        k: 3.0,
        kn: 0.7,
        preload: 0.3,
        gap: 0.0,
        force: 0.5,
    },
    // Large and small numbers, as in N and m.
    Stop {
        k: 4e8,
        kn: 9e8,
        preload: 2e3,
        gap: 0.0,
        force: 150.0,
    },
    Stop {
        k: 4e8,
        kn: 9e8,
        preload: 0.0,
        gap: 1e-6,
        force: -2e3,
    },
];

/// A length near which the stop opens or closes.
fn unit(stop: &Stop) -> f64 {
    (stop.at_rest() + stop.clearance()).abs()
}

#[test]
fn a_stop_under_constant_loads_has_the_period_of_the_closed_form() {
    for stop in CASES {
        let unit = unit(&stop);
        let at = [0.3, 0.9, 1.1, 1.5, 3.0, 10.0, 80.0].map(|t| (t * unit).log10());
        let range = ModeOptions {
            at: &at,
            ..amplitude_range(unit.log10() - 1.0, unit.log10() + 2.0)
        };
        let branch = follow(&stop.model(), &harmonics(63), &range);
        let info = branch.mode().unwrap();
        assert!((10f64.powf(info.linear_up_to) / unit - 1.0).abs() < 1e-8, "{stop:?}");
        assert!(info.slip_from.is_infinite() && info.slip_from > 0.0);
        if stop.at_rest() < -stop.clearance() {
            assert!((10f64.powf(info.lift_off_from) / unit - 1.0).abs() < 1e-12, "{stop:?}");
        } else {
            assert!(info.lift_off_from.is_infinite() && info.lift_off_from > 0.0);
        }
        let mut worst = 0.0_f64;
        for (i, a) in at.iter().enumerate() {
            let (omega, damping, _) = only(&branch, i);
            worst = worst.max((omega / stop.omega(10f64.powf(*a)) - 1.0).abs());
            assert!(damping.abs() < 1e-12);
        }
        println!("{stop:?}: {worst:.1e}");
        assert!(worst < 1e-9);
    }
}

#[test]
fn a_stop_that_touches_without_a_load_has_one_frequency_at_every_amplitude() {
    for (k, kn, h, tolerance) in [
        (1.0, 2.0, 63, 1e-9),
        (2e7, 4e7, 63, 1e-9),
        (1.0, 50.0, 101, 1e-9),
        (1.0, 50.0, 9, 2e-4),
    ] {
        let stop = Stop {
            k,
            kn,
            preload: 0.0,
            gap: 0.0,
            force: 0.0,
        };
        let range = amplitude_range(if h > 100 { 2.0 } else { -8.0 }, 3.0);
        let branch = follow(&stop.model(), &harmonics(h), &range);
        let info = branch.mode().unwrap();
        for never in [info.linear_up_to, info.lift_off_from] {
            assert!(never.is_infinite() && never < 0.0);
        }
        let (w1, w2) = (k.sqrt(), (k + kn).sqrt());
        let exact = 2.0 * w1 * w2 / (w1 + w2);
        let first = branch.omega()[0];
        let spread = branch
            .omega()
            .iter()
            .fold(0.0_f64, |m, w| m.max((w / first - 1.0).abs()));
        println!(
            "k = {k}, kn = {kn}, H = {h}: {:.1e}, spread {spread:.1e}",
            first / exact - 1.0
        );
        assert!((first / exact - 1.0).abs() < tolerance && spread < 1e-10);
    }
}

#[test]
fn the_default_options_end_within_their_tolerance() {
    for stop in CASES {
        let unit = unit(&stop);
        let range = amplitude_range(unit.log10() - 1.0, unit.log10() + 2.0);
        let branch = follow(&stop.model(), &SolverOptions::default(), &range);
        let tolerance = SolverOptions::default().tolerance;
        for (point, omega) in branch.omega().iter().enumerate() {
            let exact = stop.omega(branch.mode_at(point).unwrap().modal_amplitude);
            assert!((omega / exact - 1.0).abs() < tolerance, "{stop:?}, point {point}");
        }
    }
}

#[test]
fn motions_are_total_and_potential_energy_counts_from_the_static_state() {
    let stop = CASES[3];
    let unit = unit(&stop);
    let range = amplitude_range(unit.log10() - 1.0, unit.log10() + 1.0);
    let branch = follow(&stop.model(), &harmonics(31), &range);
    let x = all_harmonics(&branch, 0);
    let energy = branch.energy_at(0).unwrap();
    let a = x[1].norm();
    assert!((x[0].re - stop.at_rest()).abs() < 1e-12 && (branch.response_at(0).unwrap()[0] - x[0]).norm() < 1e-12);
    assert!((energy.potential_mean / (0.25 * stop.k * a * a) - 1.0).abs() < 1e-10);
    assert!((energy.potential_peak / (0.5 * stop.k * a * a) - 1.0).abs() < 1e-10);
    // The mean of a lifted contact moves away from the static state.
    let last = all_harmonics(&branch, branch.points() - 1);
    assert!(last[0].re > stop.at_rest() + 0.1 * last[1].norm());
    let (vibrating, sum) = (&last[1..], |f: &dyn Fn(f64) -> f64| -> f64 {
        last[1..].iter().map(|z| f(z.norm_sqr())).sum()
    });
    let mean = last[0].re - stop.at_rest();
    let strain = 0.5 * stop.k * (mean * mean + 0.5 * sum(&|s| s));
    let found = branch.energy_at(branch.points() - 1).unwrap().potential_mean;
    assert!((found / strain - 1.0).abs() < 1e-10, "{} harmonics", vibrating.len());
}
