//! One mass with a stop: always closed, never closed, and sometimes, which has several solutions.

use super::Case;
use super::one_mass::{EVERY_H, at, by_default, structure};
use crate::common::{harmonics, sweep};
use hbvib::{Branch, Contact, Model, SolverOptions, Status};

/// f = kn·max(x − gap, 0).
fn stopped(case: &Case) -> Model {
    let mut model = structure(case);
    let stop = Contact::unilateral(None, Some(0), case.number("kn"), case.number("gap"));
    model.add_contact(&stop).unwrap();
    model.add_force(0, 1, case.number("F").into()).unwrap();
    model
}

pub fn preloaded(case: &Case) {
    let (model, w) = (stopped(case), case.number("w"));
    let (wanted, mean) = (case.wanted("absx1"), case.wanted("x0"));
    for h in EVERY_H {
        let x = at(&model, w, h);
        case.meets("|X_1|", h, x[1].norm(), wanted);
        case.meets("X_0", h, x[0].re, mean);
        case.meets("|X_1|, independent solution", h, x[1].norm(), case.wanted("HB"));
        case.meets("X_0, independent solution", h, x[0].re, case.wanted("HBx0"));
    }
    let x = by_default(&model, w);
    case.near("|X_1|", x[1].norm(), wanted);
    case.near("X_0", x[0].re, mean);
}

pub fn never_closed(case: &Case) {
    let (model, w) = (stopped(case), case.number("w"));
    let wanted = case.wanted("absx1");
    for h in EVERY_H {
        let x = at(&model, w, h);
        case.meets("|X_1|", h, x[1].norm(), wanted);
        case.meets("|X_1|, independent solution", h, x[1].norm(), case.wanted("HB"));
        let others = x.iter().enumerate().all(|(h, x)| h == 1 || x.norm() < 1e-15);
        case.holds("no other harmonic moves", others);
    }
    case.near("|X_1|", by_default(&model, w)[1].norm(), wanted);
}

/// Smallest and largest amplitude of the solutions at the wanted frequency, and how many there are.
fn solutions(branch: &Branch) -> (f64, f64, usize) {
    let found = branch.at(0).iter().map(|s| s.amplitude);
    let least = found.clone().fold(f64::INFINITY, f64::min);
    (least, found.fold(0.0, f64::max), branch.at(0).len())
}

pub fn coexisting(case: &Case) {
    let (model, w, h) = (stopped(case), case.number("w"), case.harmonics());
    case.meets("frequency of the stored solutions", h, w, case.wanted("w"));
    let wanted = |way: &str, name: &str| crate::common::number(case.reference(&[way, name]));
    let range = super::list(case.reference(&["bistable_range_sweep_005"]));
    for (way, from, to) in [("up", 0.9, 1.5), ("down", 1.5, 0.9)] {
        for (default, solver) in [(false, harmonics(h)), (true, SolverOptions::default())] {
            let branch = sweep(&model, &solver, from, to, &[w]);
            case.status(&format!("sweep {way}"), branch.status(), Status::Ok);
            let (least, most, count) = solutions(&branch);
            case.holds(&format!("three solutions at {w}, found {count}"), count == 3);
            if default {
                case.near(
                    &format!("sweep {way}, the larger |X_1|"),
                    most,
                    wanted("up", "absx1_time"),
                );
                case.near(
                    &format!("sweep {way}, the smaller |X_1|"),
                    least,
                    wanted("down", "absx1_time"),
                );
                continue;
            }
            case.meets(
                &format!("sweep {way}, the larger |X_1|"),
                h,
                most,
                wanted("up", "absx1_HB15"),
            );
            case.meets(
                &format!("sweep {way}, the smaller |X_1|"),
                h,
                least,
                wanted("down", "absx1_HB15"),
            );
            case.meets(
                &format!("sweep {way}, the larger in time"),
                h,
                most,
                wanted("up", "absx1_time"),
            );
            case.meets(
                &format!("sweep {way}, the smaller in time"),
                h,
                least,
                wanted("down", "absx1_time"),
            );
            // Sweeps in time by steps of 0.05 found two solutions from the first to the last of these.
            let mut folds: Vec<f64> = branch.folds().iter().map(|f| f.omega).collect();
            folds.sort_by(f64::total_cmp);
            let inside = |fold: f64, bound: f64, outer: f64| (fold - bound) * (fold - bound - outer) <= 0.0;
            case.holds(
                &format!("sweep {way}, folds {folds:?} about the range {range:?}"),
                folds.len() == 2 && inside(folds[0], range[0], -0.05) && inside(folds[1], range[1], 0.05),
            );
        }
    }
    // Each of the two answers a cold start at this frequency, which has to be one of them.
    let x = at(&model, w, h)[1].norm();
    let (low, high) = (wanted("down", "absx1_HB15"), wanted("up", "absx1_HB15"));
    case.line(&format!("a cold start finds {x}"));
    let middle = sweep(&model, &harmonics(h), 0.9, 1.5, &[w]);
    let near = |a: f64| (x / a - 1.0).abs() < case.rel_tol;
    let any = middle.at(0).iter().any(|s| near(s.amplitude));
    case.holds(
        "a cold start finds one of the solutions of the branch",
        any || near(low) || near(high),
    );
    case.tells_of_the_reference(&["up.period_err", "up.mu", "down.period_err", "down.mu"]);
}
