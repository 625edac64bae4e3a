//! One mass whose contact is nearly rigid, barely slips, or alone bounds the motion.

use super::Case;
use super::one_mass::{at, by_default, rubbing};
use crate::common::omega_range;
use hbvib::{Hooks, forced_response};

pub fn nearly_rigid(case: &Case) {
    let model = rubbing(case, case.number("fc"), &[(1, case.number("F"))]);
    let w = case.number("w");
    let truth = case.wanted("time_exact");
    for h in [15, 31, 63] {
        let found = at(&model, w, h)[1].norm();
        let wanted = case.wanted(&format!("HB_H{h}"));
        if case.reference(&[&format!("ok{h}")]).as_bool().unwrap() {
            case.meets("|X_1|", h, found, wanted);
        } else {
            // The reference did not converge there and is none; the library has an answer.
            case.line(&format!(
                "H {h}: the reference, {wanted}, had not converged; found {found}"
            ));
        }
        // By H = 63 truncation is within the case's tolerance, before that within 1 %.
        let bound = if h == case.harmonics() { case.rel_tol } else { 1e-2 };
        case.within("|X_1| against time", Some(h), found, truth, bound);
    }
    case.near("|X_1|", by_default(&model, w)[1].norm(), truth);
    case.tells_of_the_reference(&["period_err"]);
}

pub fn grazing(case: &Case) {
    let stuck = case.wanted("absx1_stuck");
    let share = case.number("share_of_stuck");
    let w = case.number("w");
    let model = rubbing(case, case.number("kt") * stuck * share, &[(1, case.number("F"))]);
    let h = case.harmonics();
    let deviation = |h: usize| at(&model, w, h)[1].norm() / stuck - 1.0;
    let found = deviation(h);
    let wanted = case.wanted("rel_dev");
    case.meets("|X_1|", h, stuck * (1.0 + found), stuck * (1.0 + wanted));
    case.meets("|X_1| against the stuck response", h, stuck * (1.0 + found), stuck);
    // The deviation itself, whose digits are those of the response less seven, is that of 31 harmonics.
    case.line(&format!(
        "H {h}: relative deviation from the stuck response {found:.9e}"
    ));
    case.within(
        "relative deviation from the stuck response",
        Some(31),
        deviation(31),
        wanted,
        1e-7,
    );
    // Newton's method does not flip between stick and slip, and the response goes on without a jump.
    let mut last = 0.0;
    for excess in [1e-12, 1e-10, 1e-8, 1e-6, 1e-4, 1e-2] {
        let model = rubbing(
            case,
            case.number("kt") * stuck * (1.0 - excess),
            &[(1, case.number("F"))],
        );
        let range = omega_range(w, w);
        let branch = forced_response(&model, &crate::common::harmonics(h), &range, &mut Hooks::default()).unwrap();
        let deviation = (branch.amplitude()[0] / stuck - 1.0).abs();
        case.holds(
            &format!(
                "limit {excess:e} below the stuck force: {} iterations, deviation {deviation:.1e}",
                branch.newton_iterations()[0]
            ),
            branch.newton_iterations()[0] <= 6.0 && deviation >= last && deviation <= excess + 1e-14,
        );
        last = deviation;
    }
    case.near(
        "|X_1| against its limit, the stuck response",
        by_default(&model, w)[1].norm(),
        stuck,
    );
}

pub fn undamped_resonance(case: &Case) {
    let model = rubbing(case, case.number("fc"), &[(1, case.number("F"))]);
    let (h, w) = (case.harmonics(), case.number("w"));
    let x = at(&model, w, h)[1].norm();
    case.meets("|X_1|", h, x, case.wanted("absx1_HB31"));
    let truth = case.wanted("absx1_time");
    case.within("|X_1| against time", Some(h), x, truth, 1e-6);
    case.near("|X_1|", by_default(&model, w)[1].norm(), truth);
}
